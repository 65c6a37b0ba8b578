# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The functions of this package for PyVista meshes: each takes a mesh and returns a new one::

    from surfacediffusion.pyvista import heat

    smooth = heat(mesh, "thickness", fwhm=10)  # adds the point array "thicknessDiffused"
    states = heat(mesh, "thickness", time_step=1, times=[0, 1, 2, 4])  # a list of four meshes
    smooth, result = heat(mesh, "thickness", fwhm=10, return_result=True)
    result.history["Energy"]

With PyVista 0.48 or newer they are also methods, without an import: ``mesh.diffusion.heat("thickness",
fwhm=10)``. Any VTK will do, since no class of this package is compiled for one.

A mesh is a pyvista.PolyData with n points and m cells, or a pyvista.MultiBlock of such meshes, whose
blocks may be None or empty; its surfaces share their natural units, and blocks without the array
are returned as they are. The input is not modified. Arrays are passed by name:

array
    The data: point array (n,) or (n, k) of any numeric type, NaN is missing, or cell array with m rows,
    whose result is a cell array unless ``result_on_faces=False``; default: the active scalars,
    ``mesh.active_scalars_name``.
mask
    Point or cell array, nonzero is missing (or excluded with ``mask_mode="Exclude"``).
roi
    Point or cell array, the region of interest, nonzero is inside: the opposite of a mask with
    ``mask_mode="Exclude"``, and in place of one.
direction
    Point or cell array (n, 3) or (m, 3), the direction that along_diffusivity acts along.
fixed
    Point or cell array, nonzero holds the value fixed (Dirichlet condition).
fidelity
    Point or cell array, factors of fidelity_weight, 0 or more.

The functions of time take `times`, in the unit of time_step and in any order, and then return a list with
the mesh at each of them. Time 0 is the initial state; between two time steps, the mesh is that of the
earlier one. With ``return_result=True`` (but of direction_field) a function returns a pair: the mesh or the
list, and the result of the function on arrays, of a MultiBlock, or with times, the list of them. `progress`
is True or a callable, as for arrays. `result_array_name` stands in place of the default, and is the prefix
of the names of further arrays. All other keywords are those of the functions on arrays, also in the
spelling of VTK and ParaView: ``FWHM=10`` is ``fwhm=10``. In place of OutputPrecision there is dtype. As for
arrays, heat() needs a width: one of fwhm, time_step and mode. The results have the bits of the classes in
the module vtkSurfaceDiffusion.

Errors: TypeError if the mesh is not a surface, with the remedy; ValueError if an array or a keyword
is not allowed, with a message that names it, what was found and what is allowed.
"""

from __future__ import annotations

import functools
import inspect
import textwrap
from typing import Any, Callable, Iterable, Iterator, Sequence

import numpy as np
import pyvista
from numpy.typing import NDArray

from . import _core, _functions
from ._distance import nearest_sources as _nearest_sources
from ._fields import random_field as _random_field
from ._fields import surrogates as _surrogates
from ._functions import curvature as _curvature
from ._functions import denoise_mesh as _denoise_mesh
from ._functions import direction_field as _direction_field
from ._functions import (
    exclude_outside, find_derivatives, interpolate_with_outputs, left_out, segment_with_outputs,
)
from ._meshes import find_polydata
from ._models import (
    ARRAYS, Output, as_initial, as_vectors, check_colors, find_outputs, make_result,
)
from ._refinement import (
    ESTIMATING, RULES, RefinedSurface, interpolate_points, keywords_of, refine_as_asked,
)
from ._result import (
    DiffusionResult, EdgeResult, HarmonicMapResult, Result, SegmentationResult,
    TensorDiffusionResult, TextureResult,
)
from ._run import Input, Progress, Runner, find_result_type, take_old_switch
from ._scales import scale_filter as _scale_filter
from ._settings import settings_of, shorten
from ._shape import relief as _relief
from ._surface import Surface, as_data, as_outside, has_integers, place
from .paraview._surfaces import ABSENT, cell_flags, cut_strips, polygons_of

__all__: list[str] = []
__all__ += [*_functions.__all__, "distance", "random_field", "relief", "scale_filter", "surrogates"]


def _of_data(name: str, results: str) -> Callable[..., Any]:
    """The function of a model of data in time steps. results: sentences about them."""

    def function(
        mesh: Any, array: str | None = None, *, mask: str | None = None, roi: str | None = None,
        direction: str | None = None, fixed: str | None = None, fidelity: str | None = None,
        times: Sequence[float] | None = None, return_result: bool = False, progress: Progress = False,
        **properties: Any,
    ) -> Any:
        return _run(name, mesh, array, (mask, roi, direction, fixed, None, fidelity), times,
                    return_result, progress, properties)

    function.__name__ = function.__qualname__ = name
    summary = (getattr(_functions, name).__doc__ or "").partition("\n")[0]
    text = ("The arguments are described in help(surfacediffusion.pyvista), the equation and all other "
            f"keywords in help(surfacediffusion.{name}). {results}")
    function.__doc__ = f"{summary}\n\n{textwrap.fill(text, 98)}\n"
    return function


heat = _of_data("heat", "The result is the array <array>Diffused, with the shape of the data.")

intrinsic_tv = _of_data(
    "intrinsic_tv", "The result is the array <array>TV, with the shape of the data.")

harmonic_map = _of_data(
    "harmonic_map",
    "array: the vectors, a point or cell array with more than one component; default: the active "
    "normals, which are computed if there are none. The result is the array <array>Harmonic; "
    "NormalsHarmonic for computed normals. With move_vertices=True the points are moved.")

mumford_shah = _of_data(
    "mumford_shah",
    "The results are the arrays <array>MumfordShah, with the shape of the data, and Edges (n,). The "
    "curves along the edges are `curves` of the result that return_result=True returns, a list of "
    "arrays of points; pyvista.MultipleLines(curve) is a mesh of one.")

tensor_diffusion = _of_data(
    "tensor_diffusion",
    "The result is the array <array>Beltrami, <array>Coherent or <array>EdgeEnhanced, with the shape "
    "of the data; with diffusion_axes=True there is the cell array DiffusionAxes (m, 3), too.")


def turing_texture(
    mesh: Any, initial: str | None = None, *, mask: str | None = None, roi: str | None = None,
    direction: str | None = None, fixed: str | None = None, rates: str | None = None,
    times: Sequence[float] | None = None, return_result: bool = False, progress: Progress = False,
    **properties: Any,
) -> Any:
    """Grow a texture on the mesh by reaction and diffusion.

    initial: point array (n, 2), the initial state; default: the uniform steady state with noise.
    rates: cell array (m, 4). The other arguments are described in help(surfacediffusion.pyvista), the
    equation and all other keywords in help(surfacediffusion.turing_texture). The results are the
    point arrays u1, u2 and Texture (n,), and TextureColor (n, 3) with color_output=True.
    """
    return _run("turing_texture", mesh, initial, (mask, roi, direction, fixed, rates, None), times,
                return_result, progress, properties)


def segment(
    mesh: Any, array: str | None = None, *, terms: str | None = None, seeds: str | None = None,
    mask: str | None = None, roi: str | None = None, fidelity: str | None = None,
    return_result: bool = False, progress: Progress = False, **properties: Any,
) -> Any:
    """Divide the mesh into regions with short boundaries.

    array: the data; terms: array of K components of data terms in their place; seeds: array of labels
    that points or cells keep, 0 is free; fidelity: array of factors of the data terms, 0 is missing.
    All of them are on points or cells. The equation and all other keywords are described in
    help(surfacediffusion.segment). The blocks of a MultiBlock are segmented one by one, each with
    its own natural units. The results are the arrays RegionId (active), RegionProbability (n, K) and,
    with data, <array>Segmented: the mean of the region, or the data of points that take no part; of
    cells if the data are on cells. return_result: if True, the function returns a pair: the mesh, and the
    SegmentationResult, of a MultiBlock the list of them.
    """
    properties, result_name = _keywords("segment", properties)
    blocks, results = _find_surfaces(mesh, "segment", properties), []
    for block in blocks:
        data = (block.find_data(array, faces=True) if terms is None
                else block.find("terms", terms, faces=True))
        if data.on_faces and block.has_strips:
            raise ValueError("the data are a cell array of triangle strips; allowed: polygons, for "
                             "example mesh.triangulate()")
        marks = {argument: block.find(argument, given, faces=True) for argument, given in (
            ("seeds", seeds), ("mask", mask), ("roi", roi), ("fidelity", fidelity))}
        result, outputs = segment_with_outputs(
            block.surface, data if terms is None else None, None if terms is None else data, data.on_faces,
            progress=progress, properties=dict(properties), dtype=None, **marks)
        results.append(result)
        _write(block, outputs, result_name)
    return _built(mesh, blocks, results, return_result)


def interpolate(
    mesh: Any, array: str | None = None, *, points: Any = None, mask: str | None = None,
    roi: str | None = None, direction: str | None = None, fidelity: str | None = None,
    return_result: bool = False, progress: Progress = False, **properties: Any,
) -> Any:
    """Compute a smooth function on the mesh from values at a few points.

    array: the values, a point array of `points` or, without them, a point or cell array of the mesh
    with NaN where nothing is known; points: a data set whose points have the values, which count at
    the nearest points of the mesh; fidelity: array of weights of the values, such as 1/s^2, in the same
    place. The equation and all other keywords are described in help(surfacediffusion.interpolate). The
    results are the arrays <array>Interpolated (active) and, with compute_error=True, <array>Error.
    Each block of a MultiBlock takes all points. return_result: if True, the function returns a pair: the
    mesh, and the InterpolationResult, of a MultiBlock the list of them.
    """
    if points is not None and not hasattr(points, "point_data"):
        raise ValueError(f"points is {shorten(points)}; allowed: a data set with point arrays")
    properties, result_name = _keywords("interpolate", properties)
    blocks, results = _find_surfaces(mesh, "interpolate", properties), []
    for block in blocks:
        values, weights, places, on_faces = None, None, None, None
        if points is None:
            values = block.find_data(array, faces=True)
            on_faces = values.on_faces
            if on_faces and block.has_strips:
                raise ValueError(f"array is {shorten(block.name)}, a cell array of triangle strips; allowed: "
                                 "polygons, for example mesh.triangulate()")
            weights = block.find("fidelity", fidelity, faces=True)
        else:
            name = points.point_data.active_scalars_name if array is None else array
            if name is None:
                raise ValueError("array is None, and there are no active scalars; allowed: the name of an "
                                 "array")
            for argument, given in (("array", name), ("fidelity", fidelity)):
                if given is not None and not (isinstance(given, str) and given in points.point_data):
                    raise ValueError(f"{argument} is {shorten(given)}; allowed: point arrays of points, "
                                     + (", ".join(map(repr, points.point_data.keys()))
                                        or "of which there are none"))
            places = np.asarray(points.points)
            values = np.asarray(points.point_data[name])
            weights = None if fidelity is None else np.asarray(points.point_data[fidelity])
            block.name, block.computed = name, True
        result, outputs = interpolate_with_outputs(
            block.surface, values, places, on_faces, block.find("mask", mask, faces=True),
            block.find("roi", roi, faces=True), block.find("direction", direction, faces=True), weights,
            progress,
            {**properties, "_refined": block.refined}, None)
        results.append(result)
        _write(block, outputs, result_name)
    return _built(mesh, blocks, results, return_result)


def denoise_mesh(
    mesh: Any, *, fixed: str | None = None, return_result: bool = False, progress: Progress = False,
    **properties: Any,
) -> Any:
    """Remove the noise of the points of the mesh, and keep its sharp edges.

    fixed: point or cell array; points, and the points of cells, with a nonzero value stay. The method
    and all other keywords are described in help(surfacediffusion.denoise_mesh). The result has moved
    points and the point array Displacement (n, 3); active point normals are computed again, and cell
    normals and tangents are dropped. Each block of a MultiBlock has its own noise level. return_result:
    if True, the function returns a pair: the mesh, and the MeshDenoisingResult, of a MultiBlock the
    list of them.
    """
    properties, name = _keywords("denoise_mesh", properties)
    blocks, results = _find_surfaces(mesh, "denoise_mesh", properties), []
    for block in blocks:
        marks = block.find("fixed", fixed, faces=True)
        result = _denoise_mesh(block.surface, fixed=marks, progress=progress, **properties)
        results.append(result)
        block.add(name or "Displacement", result.points - block.surface.points, False)
        block.move(result.points)
        normals = block.mesh.point_data.active_normals_name
        if normals is not None and result.maximum_displacement > 0.0:
            moved = Surface(result.points, block.surface.triangles)
            block.mesh.point_data[normals] = moved._point_normals()
            block.mesh.GetPointData().SetActiveNormals(normals)
    return _built(mesh, blocks, results, return_result)


def relief(
    mesh: Any, array: str, height: float, *, mask: str | None = None, return_result: bool = False,
    progress: Progress = False, **properties: Any,
) -> Any:
    """Raise or carve values on the mesh as relief, for printing.

    array: point array (n,) of the values, usually Texture of turing_texture(). mask: point or cell
    array; points, and the points of cells, with a nonzero value have no relief. The method and all other
    keywords are described in help(surfacediffusion.relief). The result has moved points and the point
    array ReliefHeight (n,), the heights that were used; polygons are oriented outwards.
    Active point normals are computed again, and cell normals and tangents are dropped. return_result: if
    True, the function returns a pair: the mesh, and the ReliefResult, of a MultiBlock the list of them.
    """
    properties, name = _keywords("relief", properties)
    blocks, results = _find_surfaces(mesh, "relief", properties), []
    for block in blocks:
        values = block.find("array", array)
        marks = block.find("mask", mask, faces=True)
        result = _relief(block.surface, values, height, mask=marks, progress=progress, **properties)
        results.append(result)
        block.add(name or "ReliefHeight", result.heights, False)
        block.move(result.surface.points)
        turned = (result.surface.triangles != block.surface.triangles).any(axis=1)
        block.turn(block.surface._core.faces()[turned])
        normals = block.mesh.point_data.active_normals_name
        if normals is not None:
            block.mesh.point_data[normals] = result.surface._point_normals()
            block.mesh.GetPointData().SetActiveNormals(normals)
    return _built(mesh, blocks, results, return_result)


def curvature(
    mesh: Any, *, mask: str | None = None, roi: str | None = None, return_result: bool = False,
    progress: Progress = False, **properties: Any,
) -> Any:
    """Compute the curvature of the mesh at a given scale.

    mask, roi: point or cell array; points and cells with a nonzero value, or with 0, are left out, and
    the surface ends there. All other keywords are those of surfacediffusion.curvature. The results are the point
    arrays MeanCurvature, which becomes active, GaussianCurvature, PrincipalCurvatures, ShapeIndex and
    Curvedness; result_array_name is the prefix of their names. return_result: if True, the function
    returns a pair: the mesh, and the CurvatureResult, of a MultiBlock the list of them.
    """
    properties, prefix = _keywords("curvature", properties)
    blocks, results = _find_surfaces(mesh, "curvature", properties), []
    for block in blocks:
        marks = block.find_left_out(mask, roi)
        result = _curvature(block.surface, mask=marks, progress=progress, **properties)
        results.append(result)
        for name, values in (
            ("MeanCurvature", result.mean), ("GaussianCurvature", result.gaussian),
            ("PrincipalCurvatures", result.principal), ("ShapeIndex", result.shape_index),
            ("Curvedness", result.curvedness),
        ):
            block.add((prefix or "") + name, values, False)
        block.mesh.set_active_scalars((prefix or "") + "MeanCurvature", "point")
    return _built(mesh, blocks, results, return_result)


def distance(
    mesh: Any, sources: Any, *, speed: str | None = None, direction: str | None = None,
    along_speed: float = 1.0, across_speed: float = 1.0, mask: str | None = None, roi: str | None = None,
    method: str = "Automatic", progress: Progress = False, result_array_name: str | None = None,
    **properties: Any,
) -> Any:
    """Compute the distance along the mesh from the nearest source, or with speeds the time at which
    fronts arrive.

    sources: the name of a point array, whose nonzero points are the sources; or numbers of points; or a
    data set or an array (k, 3), whose points stand for the nearest places of the mesh, in each block of a
    MultiBlock. speed: point or cell array. direction: point or cell array with three components, for
    along_speed and across_speed. mask, roi: point or cell array; points and cells with a nonzero value,
    or with 0, are left out. All other keywords are those of surfacediffusion.distance. The results are the
    point arrays Distance, with speeds ArrivalTime, which becomes active, and NearestSource: the value of the
    array at the nearest source, or the number of the point. Points that no way reaches have inf, and 0 or
    -1. The field array EffectiveMethod says which method was taken. result_array_name is the prefix of the
    names.
    """
    blocks = _find_surfaces(mesh, "distance", properties)
    given = getattr(sources, "points", sources)
    for block in blocks:
        arrays = {"speed": block.find("speed", speed, faces=True),
                  "directions": block.find("direction", direction, faces=True),
                  "along_speed": along_speed, "across_speed": across_speed,
                  "mask": block.find_left_out(mask, roi)}
        rows = given
        if isinstance(sources, str):
            marks = np.asarray(block.find("sources", sources))
            rows = np.flatnonzero(np.nan_to_num(marks))
            if rows.size == 0:
                raise ValueError(f"sources is {shorten(sources)}, which is 0 at all points; allowed: point "
                                 "arrays that are nonzero at the sources")
            names, nowhere = marks[rows], 0
        else:
            numbers = np.arange(len(given) if np.ndim(given) else 1)
            is_rows = np.ndim(given) < 2 and np.asarray(given).dtype != bool
            names, nowhere = np.atleast_1d(given) if is_rows else numbers, -1
        found = _nearest_sources(
            block.surface, rows, method=method, progress=progress, **arrays, **properties)
        prefix = result_array_name or ""
        name = prefix + found._name
        block.add(name, found.distance, False)
        block.add(prefix + "NearestSource",
                  np.where(found.source < 0, nowhere, names[found.source]), False)
        block.mesh.field_data[prefix + "EffectiveMethod"] = [found.method]
        block.mesh.set_active_scalars(name, "point")
    return _rebuild(mesh, iter(blocks))


def random_field(
    mesh: Any, n: int = 1, *, fwhm: float | None = None, range: float | None = None, nu: int = 1,
    seed: int = 0, normalize: bool = True, mask: str | None = None, roi: str | None = None,
    progress: Progress = False, result_array_name: str | None = None, **merging: Any,
) -> Any:
    """Draw Gaussian random fields of mean 0 and variance 1 on the mesh.

    mask, roi: point or cell array; points and cells with a nonzero value, or with 0, are left out. All other
    keywords are those of surfacediffusion.random_field. The result is the point array RandomField, with a
    component per field, which becomes active, and NaN at points that are left out. result_array_name is the
    prefix of its name.
    """
    blocks = _find_surfaces(mesh, "random_field", {})
    name = (result_array_name or "") + "RandomField"
    for block in blocks:
        found = _random_field(
            block.surface, n, fwhm=fwhm, range=range, nu=nu, seed=seed, normalize=normalize,
            mask=block.find_left_out(mask, roi), progress=progress, **merging)
        _add_columns(block, name, found)
    return _rebuild(mesh, iter(blocks))


def surrogates(
    mesh: Any, array: str | None = None, n: int = 1000, *, seed: int = 0, mask: str | None = None,
    roi: str | None = None, progress: Progress = False, result_array_name: str | None = None,
) -> Any:
    """Draw surrogates of a map: random maps with its values and its smoothness.

    array: point array with one component; default: the active scalars. mask, roi: point or cell array;
    points and cells with a nonzero value, or with 0, are left out. All other keywords are those of
    surfacediffusion.surrogates. The result is a point array with a component per surrogate, which becomes
    active: that of the map's name followed by Surrogates, or result_array_name.
    """
    blocks = _find_surfaces(mesh, "surrogates", {})
    for block in blocks:
        values = block.find_data(array)
        found = _surrogates(block.surface, values, n, seed=seed, mask=block.find_left_out(mask, roi),
                            progress=progress)
        _add_columns(block, result_array_name or block.name + "Surrogates", found.values)
    return _rebuild(mesh, iter(blocks))


def scale_filter(
    mesh: Any, array: str | None = None, *, wavelength: float | str, order: int = 1,
    mask: str | None = None, roi: str | None = None, progress: Progress = False,
    result_array_name: str | None = None,
) -> Any:
    """Filter data by scale: a third is left of waves of the wavelength, more of longer ones.

    array: point array; default: the active scalars. wavelength: a number, or a point array. mask, roi: point
    or cell array; points and cells with a nonzero value, or with 0, are left out. The order is that of
    surfacediffusion.scale_filter. The result has the name of the array followed by Filtered, or
    result_array_name, and becomes active.
    """
    blocks = _find_surfaces(mesh, "scale_filter", {})
    for block in blocks:
        values = block.find_data(array)
        lengths = block.find("wavelength", wavelength) if isinstance(wavelength, str) else wavelength
        found = _scale_filter(block.surface, values, lengths, order=order,
                              mask=block.find_left_out(mask, roi), progress=progress)
        _add_columns(block, result_array_name or block.name + "Filtered", found)
    return _rebuild(mesh, iter(blocks))


def _add_columns(block: _Block, name: str, values: NDArray[Any]) -> None:
    """Add a point array, without a second dimension if it has one column, and make it active."""
    block.add(name, values[:, 0] if values.ndim == 2 and values.shape[1] == 1 else values, False)
    block.mesh.set_active_scalars(name, "point")


def derivatives(
    mesh: Any, array: str | None = None, *, mask: str | None = None, roi: str | None = None,
    return_result: bool = False, progress: Progress = False, **properties: Any,
) -> Any:
    """Compute derivatives of data on the mesh.

    array: point or cell array; default: the active scalars. Blocks without it pass through, if others
    have it. mask, roi: point or cell array; points and cells with a nonzero value, or with 0, are left
    out. All other keywords are those of surfacediffusion.derivatives. The result has the name of the array followed
    by the quantity, for instance tGradient, or result_array_name; velocities have their lengths in
    tSpeed. return_result: if True, the function returns a pair: the mesh, and the DerivativesResult, of
    a MultiBlock the list of them.
    """
    properties, given = _keywords("derivatives", properties)
    quantity = settings_of("derivatives")["quantity"]
    word = quantity.words[quantity.convert(properties.get("quantity", quantity.default))]
    blocks, results = _find_surfaces(mesh, "derivatives", properties), []
    known = [block.has(block.mesh.active_scalars_name if array is None else array) for block in blocks]
    for block, is_known in zip(blocks, known):
        if not is_known and any(known):
            continue
        values = block.find_data(array, faces=True)
        result = find_derivatives(block.surface, values, values.on_faces, block.find_left_out(mask, roi),
                                  None, progress, dict(properties))
        results.append(result)
        at_cells = bool(properties.get("result_on_faces", False))
        name = given or block.name + word
        block.add(name, result.values, at_cells)
        if result.speed is not None:
            block.add((given or block.name) + "Speed", result.speed, at_cells)
        is_vector = word in ("Gradient", "ConductionVelocity") and result.values.shape[1:] == (3,)
        activate = block.mesh.set_active_vectors if is_vector else block.mesh.set_active_scalars
        activate(name, preference="cell" if at_cells else "point")
    return _built(mesh, blocks, results, return_result)


def direction_field(
    mesh: Any, hints: str | None = None, *, progress: Progress = False, **properties: Any
) -> Any:
    """Compute a line field on the mesh.

    hints: point or cell array (n, 3) or (m, 3) of directions, for method="Hints". All other keywords
    are those of surfacediffusion.direction_field. The result is the cell array Direction (m, 3):
    unit vectors whose sign has no meaning, zero in cells that have no direction.
    """
    properties, name = _keywords("direction_field", properties)
    surfaces = _find_surfaces(mesh, "direction_field", properties)
    for block in surfaces:
        if block.has_strips:
            raise TypeError("the mesh has triangle strips, which have no single direction; allowed: "
                            "polygons, for example mesh.triangulate()")
        given = block.find("hints", hints, faces=True)
        field = _direction_field(block.surface, given, progress=progress, **properties)
        cells = np.zeros((block.mesh.n_cells, 3))
        cells[block.face_cells] = field
        block.mesh.cell_data[name or "Direction"] = cells
        block.mesh.GetCellData().SetActiveVectors(name or "Direction")
    return _rebuild(mesh, iter(surfaces))


_RESULTS = {"harmonic_map": HarmonicMapResult, "mumford_shah": EdgeResult, "segment": SegmentationResult,
            "tensor_diffusion": TensorDiffusionResult, "turing_texture": TextureResult}


class _Block:
    """One surface of the input, and the mesh of its results."""

    def __init__(self, mesh: pyvista.PolyData) -> None:
        self.origin = self.input = mesh  #: as given, and with shorter edges
        self.mesh = mesh.copy(deep=False)
        faces, self.face_cells = _find_faces(mesh)
        self.has_strips = len(mesh.strips) > 0
        self.empty = len(faces) == 0
        if not self.empty:
            self.surface = Surface(mesh.points, faces)
        self.given: Input | None = None
        self.refined: RefinedSurface | None = None  #: that has made the mesh from the input
        self.name = ""  #: of the data
        self.on_faces = False  #: the data are a cell array
        self.computed = False  #: the data are computed normals, of no array

    def find(self, argument: str, name: str | None, points: bool = True, faces: bool = False) -> Any:
        """An array by name, as Placed; None stays."""
        if name is None:
            return None
        if not isinstance(name, str):
            raise ValueError(f"{argument} is {shorten(name)}; allowed: the name of an array")
        if points and name in self.mesh.point_data:
            if self.refined is not None and argument in RULES and name in self.origin.point_data:
                given = np.asarray(self.origin.point_data[name])
                return place(interpolate_points(given, self.refined.parents, RULES[argument]), False)
            return place(self.mesh.point_data[name], False)
        if faces and name in self.mesh.cell_data:
            return place(np.asarray(self.mesh.cell_data[name])[self.face_cells], True)
        names = (self.mesh.point_data.keys() if points else []) + (
            self.mesh.cell_data.keys() if faces else [])
        where = " or ".join(["point"] * points + ["cell"] * faces)
        listed = ", ".join(repr(other) for other in names) or "of which there are none"
        raise ValueError(f"{argument} is {shorten(name)}; allowed: {where} arrays, {listed}")

    def find_data(self, name: str | None, faces: bool = False) -> Any:
        """The data, as Placed: the array of this name, or the active scalars. Name and place are kept."""
        on_cells = False
        if name is None:
            active = self.mesh.active_scalars_info
            name, on_cells = active.name, active.association == pyvista.FieldAssociation.CELL
            if name is None:
                raise ValueError("array is None and the mesh has no active scalars; allowed: the name of an "
                                 "array")
        values = self.find("array", name, points=not (faces and on_cells), faces=faces)
        self.name, self.on_faces = name, bool(values.on_faces)
        return values

    def has(self, name: Any) -> bool:
        """Whether there is a point or cell array of this name."""
        return isinstance(name, str) and (name in self.mesh.point_data or name in self.mesh.cell_data)

    def find_left_out(self, mask: str | None, roi: str | None) -> Any:
        """The mask, or that of what is outside of the region of interest."""
        return left_out(self.find("mask", mask, faces=True), self.find("roi", roi, faces=True),
                        self.surface)

    def add(self, name: str, values: NDArray[Any], on_faces: bool) -> None:
        """Add an array of points or, zero at cells that are no faces, of cells."""
        if not on_faces:
            self.mesh.point_data[name] = values
            return
        cells = np.zeros((self.mesh.n_cells, *values.shape[1:]), dtype=values.dtype)
        cells[self.face_cells] = values
        self.mesh.cell_data[name] = cells

    def move(self, points: NDArray[Any]) -> None:
        """Give the mesh points of its own, in the precision of the input's. The normals of its cells and
        its tangents, which were those of the former points, are dropped."""
        self.mesh.SetPoints(pyvista.vtk_points(points.astype(self.input.points.dtype)))
        cells, given = self.mesh.cell_data, self.input.cell_data
        for name in {given.active_normals_name, "Normals", "Tangents"} & set(given.keys()):
            cells.remove(name)
        if "Tangents" in self.input.point_data:
            self.mesh.point_data.remove("Tangents")

    def turn(self, faces: NDArray[Any]) -> None:
        """Reverse the polygons of these faces."""
        cells = np.unique(self.face_cells[faces]) - self.mesh.n_verts - self.mesh.n_lines
        polygons = type(self.mesh.GetPolys())()
        polygons.DeepCopy(self.mesh.GetPolys())
        for cell in cells[cells < polygons.GetNumberOfCells()].tolist():
            polygons.ReverseCellAtId(cell)
        self.mesh.SetPolys(polygons)

    def with_edges(self, fine: RefinedSurface) -> _Block:
        """The block with the triangles of a finer surface in place of its faces, and with its data."""
        given, cells = self.input, self.face_cells[fine.faces]
        mesh = pyvista.PolyData()
        mesh.SetPoints(pyvista.vtk_points(fine.surface.points.astype(given.points.dtype)))
        mesh.SetVerts(given.GetVerts())
        mesh.SetLines(given.GetLines())
        mesh.faces = np.insert(fine.surface.triangles, 0, 3, axis=1).ravel()
        cells = np.concatenate([np.arange(given.n_verts + given.n_lines), cells])
        for name, values in given.point_data.items():
            numbers = np.asarray(values)
            if numbers.dtype.kind in "biuf":
                mesh.point_data[name] = fine.at_points(numbers)
            else:
                mesh.point_data[name] = numbers[fine.at_points(np.arange(given.n_points))]
        for name, values in given.cell_data.items():
            mesh.cell_data[name] = np.asarray(values)[cells]
        mesh.cell_data["vtkOriginalCellIds"] = cells
        for data, attributes in ((given.GetPointData(), mesh.GetPointData()),
                                 (given.GetCellData(), mesh.GetCellData())):
            for kind in range(data.NUM_ATTRIBUTES):
                active = data.GetAbstractAttribute(kind)
                if active is not None:
                    attributes.SetActiveAttribute(active.GetName(), kind)
        mesh.copy_meta_from(given)
        mesh.field_data.update(given.field_data)
        block = _Block(mesh)
        block.origin, block.refined = self.origin, fine
        return block

    def fresh(self) -> _Block:
        """The same surface, with a mesh for other results."""
        block = object.__new__(_Block)
        block.__dict__.update(self.__dict__, mesh=self.input.copy(deep=False))
        return block


def _find_faces(mesh: pyvista.PolyData) -> tuple[Any, NDArray[np.int64]]:
    """The polygons, and strips as triangles, without hidden and ghost cells; the cell of each."""
    corners, offsets = polygons_of(mesh.GetPolys())
    sizes = np.diff(offsets)
    first = mesh.n_verts + mesh.n_lines
    triangles, of_strips = cut_strips(mesh.GetStrips(), first + len(sizes), mesh.n_points)
    is_regular = len(triangles) == 0 and len(np.unique(sizes)) == 1 and sizes[0] > 2
    faces: Any = (corners.reshape(-1, sizes[0]) if is_regular else
                  [*np.split(corners, offsets[1:-1])[:len(sizes)], *triangles])
    cells = np.append(first + np.arange(len(sizes)), of_strips)
    kept = np.append(sizes > 2, np.ones(len(of_strips), dtype=bool))
    flags = cell_flags(mesh)
    if flags is not None:
        kept &= (flags[cells] & ABSENT) == 0
    return faces[kept] if is_regular else [faces[i] for i in np.flatnonzero(kept)], cells[kept]


def _find_surfaces(mesh: Any, function: str, keywords: dict[str, Any]) -> list[_Block]:
    """The surfaces of a mesh, without empty blocks. Keywords of refinement are used and removed."""
    refine_to, limit = (keywords.pop(new.name, new.default) for new in keywords_of(function))
    leaves = list(find_polydata(mesh))
    blocks = [block for block in map(_Block, leaves) if not block.empty]
    if not any(leaf.n_points > 0 for leaf in leaves):
        raise ValueError("the mesh is empty; allowed: a surface of polygons or strips")
    if not blocks:
        raise ValueError("the mesh has no polygons or strips; allowed: a surface")
    refined = refine_as_asked([block.surface for block in blocks], function, refine_to, limit,
                              keywords.get("feature_size", 0.0))
    if refined is not None:
        blocks = [block.with_edges(fine) if len(fine.parents) else block
                  for block, fine in zip(blocks, refined)]
    return blocks


def _rebuild(mesh: Any, blocks: Iterator[_Block]) -> Any:
    """The input with the meshes of the blocks in their places."""
    following = next(blocks, None)

    def build(part: Any) -> Any:
        nonlocal following
        if isinstance(part, pyvista.MultiBlock):
            copy = part.copy(deep=False)
            for index in range(part.n_blocks):
                if part[index] is not None:
                    copy.replace(index, build(part[index]))
            return copy
        if following is not None and following.origin is part:
            built, following = following.mesh, next(blocks, None)
            return built
        return part.copy(deep=False)

    return build(mesh)


def _built(mesh: Any, blocks: list[_Block], results: list[Any], return_result: bool) -> Any:
    """What a function returns: the mesh, or the mesh with its result."""
    written = _rebuild(mesh, iter(blocks))
    if not return_result:
        return written
    return written, results if isinstance(mesh, pyvista.MultiBlock) else results[0]


def _keywords(function: str, properties: dict[str, Any]) -> tuple[dict[str, Any], str | None]:
    """The keywords, also in the spelling of VTK, and the name of the result."""
    names = {setting.name: setting.keyword for setting in settings_of(function).values()}
    names.update(ResultArrayName="result_array_name", RefineTo="refine_to",
                 MaximumNumberOfTriangles="maximum_number_of_triangles")
    found = {names.get(name, name): value for name, value in properties.items()}
    return found, found.pop("result_array_name", None)


def _prepare(
    function: str, block: _Block, array: str | None, names: Sequence[str | None],
    properties: dict[str, Any],
) -> None:
    """The input of a block."""
    mesh, surface = block.mesh, block.surface
    data: Any = None
    integers = False
    if function == "harmonic_map":
        name = mesh.point_data.active_normals_name if array is None else array
        vectors = None if name is None else block.find_data(name, faces=True)
        data = as_vectors(surface, vectors, properties, block.on_faces)
        integers = has_integers(vectors)
        block.name = name or "Normals"
        block.computed = name is None
    elif function == "turing_texture":
        data = as_initial(surface, block.find("initial", array))
    else:
        values = block.find_data(array, faces=True)
        data = as_data(block.name, values, surface.n_faces if block.on_faces else surface.n_points,
                       "face" if block.on_faces else "point")
        integers = has_integers(values)
    if block.on_faces and block.has_strips:
        raise ValueError(f"array is {shorten(block.name)}, a cell array of triangle strips; allowed: "
                         "polygons, for example mesh.triangulate()")
    mask, roi, direction, fixed, rates, fidelity = names
    marks = {argument: block.find(argument, given, faces=True)
             for argument, given in (("mask", mask), ("fixed", fixed), ("fidelity", fidelity))}
    if roi is not None:
        outside = as_outside(block.find("roi", roi, faces=True), surface.n_points, surface.n_faces)
        marks["mask"] = outside if outside.any() else None
    block.given = Input(
        surface, data, data_on_faces=block.on_faces,
        directions=block.find("direction", direction, faces=True), directions_name="direction",
        integers=integers, rates=block.find("rates", rates, points=False, faces=True),
        refined=block.refined if function in ESTIMATING else None, **marks)


def _write_result(block: _Block, output: Output, name: str) -> None:
    """Add an array in place of the data. Cells that are no faces keep the value of the data."""
    cells = block.input.cell_data
    source = cells if block.on_faces else block.input.point_data
    has_data = block.name in source and not block.computed
    shape = np.shape(source[block.name]) if has_data else output.values.shape
    values = output.values[:, 0] if len(shape) < output.values.ndim else output.values
    if output.place == "points":
        block.mesh.point_data[name] = values
        return
    whole = np.array(cells[block.name], dtype=values.dtype)
    whole[block.face_cells] = values
    block.mesh.cell_data[name] = whole


def _activate(block: _Block, output: Output, name: str) -> None:
    """Make the array of an output active, as its role says: vectors in place of the normals, given or
    computed, as normals."""
    on_faces = output.place == "faces"
    where: Any = "cell" if on_faces else "point"
    is_vector = output.role == "vectors"
    given = block.input.cell_data if on_faces else block.input.point_data
    if is_vector and (block.computed or block.name == given.active_normals_name):
        data = block.mesh.GetCellData() if on_faces else block.mesh.GetPointData()
        data.SetActiveNormals(name)
    elif is_vector and output.values.shape[1] == 3 and output.values.dtype != np.uint8:
        block.mesh.set_active_vectors(name, preference=where)
    elif output.role:
        block.mesh.set_active_scalars(name, preference=where)


def _write(block: _Block, outputs: list[Output], name: str | None) -> None:
    """Add the outputs to the mesh, and make those active that have a role."""
    for output in outputs:
        if output.place not in ("points", "faces"):
            continue
        if output.role == "coordinates":
            if not np.array_equal(output.values, block.surface.points):
                block.move(output.values)
            continue
        array = name or block.name + output.name
        if output.is_result:
            _write_result(block, output, array)
        elif output.is_beside_result:
            block.add(array, output.values, output.place == "faces")
        else:
            array = (name or "") + output.name
            block.add(array, output.values, output.place == "faces")
        _activate(block, output, array)


def _run(
    function: str, mesh: Any, array: str | None, names: Sequence[str | None],
    times: Sequence[float] | None, return_result: bool, progress: Progress, properties: dict[str, Any],
) -> Any:
    properties, result_name = _keywords(function, properties)
    if names[1] is not None:
        exclude_outside(names[0], properties)
    if times is not None and not isinstance(times, Iterable):
        raise ValueError(f"times is {shorten(times)}; allowed: a list of numbers")
    dtype = properties.pop("dtype", None)
    surfaces = _find_surfaces(mesh, function, properties)
    check_colors(properties)
    runner = Runner(function, properties, {
        **ARRAYS, "DirectionArray": "direction",
        "InputArray": "initial" if function == "turing_texture" else "array"})
    blocks, failures = [], []
    for block in surfaces:
        try:
            _prepare(function, block, array, names, properties)
            find_result_type(block.given.data if block.given else None, dtype)
            blocks.append(block)
        except ValueError as error:
            if block.has(array):
                raise
            failures.append(error)
    if not blocks:
        raise failures[0]
    inputs = [block.given for block in blocks if block.given]
    run = _core.ModelRun(function)

    def build(state: list[dict[str, Any]]) -> tuple[Any, Any]:
        results: list[Result] = []
        written = [block.fresh() for block in blocks]
        for number, block in enumerate(written):
            outputs = find_outputs(run, number, block.given, runner, dtype)
            _write(block, outputs, result_name)
            found = {"points": np.array(block.surface.points), **state[number]}
            results.append(make_result(_RESULTS.get(function, DiffusionResult), outputs, found))
        whole = _rebuild(mesh, iter(written))
        return whole, results if isinstance(mesh, pyvista.MultiBlock) else results[0]

    if times is None:
        output, reports = runner.finish(run, inputs, build, progress)
        return (output, reports) if return_result else output
    runner.call(run.update, [given.core for given in inputs], runner.settings, None)
    steps = [_find_step(time, run, runner) for time in times]
    ordered = sorted(set(steps))
    built = dict(zip(ordered, map(build, runner.visit(run, inputs, ordered, progress))))
    outputs = [built[step][0] for step in steps]
    return (outputs, [built[step][1] for step in steps]) if return_result else outputs


def _find_step(time: Any, run: Any, runner: Runner) -> int:
    """The last step at or before a time whose state is published."""
    if not isinstance(time, (int, float, np.number)) or not float(time) >= 0.0:
        raise ValueError(f"times has {shorten(time)}; allowed: numbers, 0 or more")
    return _core.find_step(runner.function, runner.settings, float(time), run.number_of_steps())


class _Accessor:
    """The functions of surfacediffusion.pyvista as methods of a mesh: mesh.diffusion.heat("f",
    fwhm=10) is heat(mesh, "f", fwhm=10)."""

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh


def _as_method(function: Callable[..., Any]) -> Callable[..., Any]:
    def method(self: _Accessor, *arguments: Any, **keywords: Any) -> Any:
        return function(self._mesh, *arguments, **keywords)

    method.__name__, method.__doc__ = function.__name__, function.__doc__
    signature = inspect.signature(function)
    this = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    method.__signature__ = signature.replace(  # type: ignore[attr-defined]
        parameters=[this, *list(signature.parameters.values())[1:]])
    return method


def _show_settings(name: str, function: Callable[..., Any]) -> None:
    """Give a function the signature with its settings, for editors and help()."""
    own = inspect.signature(function)
    settings = [parameter for keyword, parameter
                in inspect.signature(getattr(_functions, name)).parameters.items()
                if keyword in (*settings_of(name), *(new.name for new in keywords_of(name)))
                and keyword not in own.parameters]
    function.__signature__ = own.replace(parameters=[  # type: ignore[attr-defined]
        *(parameter for parameter in own.parameters.values()
          if parameter.kind is not inspect.Parameter.VAR_KEYWORD), *settings])


def _with_old_switch(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function, which takes return_result by its former name, full_output, too."""

    @functools.wraps(function)
    def call(*arguments: Any, **keywords: Any) -> Any:
        if "full_output" in keywords and "return_result" in inspect.signature(function).parameters:
            keywords["return_result"] = take_old_switch(
                keywords, function.__name__, "full_output", "it is return_result")
        return function(*arguments, **keywords)

    return call


for _name in __all__:
    if _name not in globals():  # a model without results of a special kind
        globals()[_name] = _of_data(_name, "The results have the names of those of the filter for VTK.")
    globals()[_name] = _with_old_switch(globals()[_name])
    if _name in _functions.__all__:
        _show_settings(_name, globals()[_name])
    setattr(_Accessor, _name, _as_method(globals()[_name]))

if hasattr(pyvista, "register_dataset_accessor"):
    for _class in (pyvista.PolyData, pyvista.MultiBlock):
        pyvista.register_dataset_accessor("diffusion", _class)(_Accessor)
