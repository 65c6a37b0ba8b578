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
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkPolyData

from . import _core, _functions
from ._distance import nearest_sources as _nearest_sources
from ._fields import random_field as _random_field
from ._models import ARRAYS, Output, as_mask, find_outputs, make_result, take_data
from ._paths import geodesic_disk as _geodesic_disk
from ._paths import geodesic_path as _geodesic_path
from ._paths import path_through as _path_through
from ._polydata import (
    ABSENT, attribute_of, cell_flags, move_points, name_of, read_cells, refined_polydata, turn_polygons,
)
from ._refinement import (
    ESTIMATING, ROLES, RefinedSurface, interpolate_points, keywords_of, refine_as_asked,
)
from ._result import (
    DiffusionResult, EdgeResult, HarmonicMapResult, Result, TensorDiffusionResult, TextureResult,
)
from ._run import Input, Progress, Runner, find_result_type, take_old_switch
from ._scales import scale_filter as _scale_filter
from ._settings import settings_of, shorten
from ._shape import relief as _relief
from ._surface import Surface, place
from ._surrogates import surrogates as _surrogates

__all__: list[str] = []
__all__ += [*_functions.__all__, "distance", "geodesic_disk", "geodesic_path", "path_through", "random_field",
            "relief", "scale_filter", "surrogates"]


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

    def read(block: _Block) -> dict[str, Any]:
        name, given = ("values", array) if terms is None else ("terms", terms)
        return {name: block.find_whole(given, "array" if terms is None else "terms"),
                **block.find_all(seeds=seeds, mask=mask, roi=roi, fidelity=fidelity)}

    return _on_each("segment", mesh, read, return_result, progress, properties)


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
    results are the arrays <array>Interpolated (active) and, with compute_error=True, <array>Error and
    <array>SlopeError.
    Each block of a MultiBlock takes all points. return_result: if True, the function returns a pair: the
    mesh, and the InterpolationResult, of a MultiBlock the list of them.
    """
    if points is not None and not hasattr(points, "point_data"):
        raise ValueError(f"points is {shorten(points)}; allowed: a data set with point arrays")

    def read(block: _Block) -> dict[str, Any]:
        found = {"directions": block.find("direction", direction), **block.find_all(mask=mask, roi=roi)}
        if points is None:
            return {"values": block.find_whole(array), "_refined": block.refined, **found,
                    "fidelity": block.find("fidelity", fidelity)}
        name = points.point_data.active_scalars_name if array is None else array
        if name is None:
            raise ValueError("array is None, and there are no active scalars; allowed: the name of an array")
        for argument, given in (("array", name), ("fidelity", fidelity)):
            if given is not None and not (isinstance(given, str) and given in points.point_data):
                raise ValueError(f"{argument} is {shorten(given)}; allowed: point arrays of points, "
                                 + (", ".join(map(repr, points.point_data.keys()))
                                    or "of which there are none"))
        block.name = name
        return {"values": np.asarray(points.point_data[name]), "points": np.asarray(points.points), **found,
                "fidelity": None if fidelity is None else np.asarray(points.point_data[fidelity])}

    return _on_each("interpolate", mesh, read, return_result, progress, properties)


def denoise_mesh(
    mesh: Any, *, fixed: str | None = None, creases: str | None = None, return_result: bool = False,
    progress: Progress = False, **properties: Any,
) -> Any:
    """Remove the noise of the points of the mesh, and keep its sharp edges.

    fixed: point or cell array; points, and the points of cells, with a nonzero value stay. creases: cell
    array of labels, between which edges stay, or point array, nonzero at their points. The method
    and all other keywords are described in help(surfacediffusion.denoise_mesh). The result has moved
    points and the point array Displacement (n, 3); normals are computed again, and tangents are dropped.
    Each block of a MultiBlock has its own noise level. return_result:
    if True, the function returns a pair: the mesh, and the MeshDenoisingResult, of a MultiBlock the
    list of them.
    """
    return _on_each("denoise_mesh", mesh, lambda block: block.find_all(fixed=fixed, creases=creases),
                    return_result, progress, properties)


def relief(
    mesh: Any, array: str, height: float, *, mask: str | None = None, return_result: bool = False,
    progress: Progress = False, **properties: Any,
) -> Any:
    """Raise or carve values on the mesh as relief, for printing.

    array: point array (n,) of the values, usually Texture of turing_texture(). mask: point or cell
    array; points, and the points of cells, with a nonzero value have no relief. The method and all other
    keywords are described in help(surfacediffusion.relief). The result has moved points and the point
    array ReliefHeight (n,), the heights that were used; polygons are oriented outwards.
    Normals are computed again, and tangents are dropped. return_result: if True, the function returns a
    pair: the mesh, and the ReliefResult, of a MultiBlock the list of them.
    """

    def read(block: _Block) -> dict[str, Any]:
        return {"values": block.find("array", array, faces=False), "height": height,
                **block.find_all(mask=mask)}

    return _on_each("relief", mesh, read, return_result, progress, properties)


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
    return _on_each("curvature", mesh, lambda block: block.find_all(mask=mask, roi=roi), return_result, progress,
                    properties)


def distance(
    mesh: Any, sources: Any, *, speed: str | None = None, direction: str | None = None,
    along_speed: float | str = 1.0, across_speed: float | str = 1.0, mask: str | None = None,
    roi: str | None = None, method: str = "Automatic", progress: Progress = False,
    result_array_name: str | None = None, **properties: Any,
) -> Any:
    """Compute the distance along the mesh from the nearest source, or with speeds the time at which
    fronts arrive.

    sources: the name of a point array, whose nonzero points are the sources; or numbers of points; or a
    data set or an array (k, 3), whose points stand for the nearest places of the mesh, in each block of a
    MultiBlock. With signed=True they are a region, or places along a closed curve. speed: point or cell
    array. direction: point or cell array with three components, for along_speed and across_speed, numbers
    or names of point or cell arrays. mask, roi: point or cell array; points and cells with a nonzero value,
    or with 0, are left out. All other keywords are those of surfacediffusion.distance. The results are the
    point arrays Distance, with speeds ArrivalTime, which becomes active, and NearestSource: the value of the
    array at the nearest source, or the number of the point. Points that no way reaches have inf, and 0 or
    -1. The field array EffectiveMethod says which method was taken. result_array_name is the prefix of the
    names.
    """
    blocks = _find_surfaces(mesh, "distance", properties)
    given = getattr(sources, "points", sources)
    for block in blocks:
        arrays = {"directions": block.find("direction", direction), "along_speed": along_speed,
                  "across_speed": across_speed, **block.find_all(speed=speed, mask=mask, roi=roi)}
        arrays.update(block.find_all(
            **{name: value for name, value in arrays.items() if isinstance(value, str)}))
        rows = given
        if isinstance(sources, str):
            marks = np.asarray(block.find("sources", sources, faces=False))
            rows = np.flatnonzero(np.nan_to_num(marks))
            if rows.size == 0:
                raise ValueError(f"sources is {shorten(sources)}, which is 0 at all points; allowed: point "
                                 "arrays that are nonzero at the sources")
            names, nowhere = marks[rows], 0
        else:
            numbers = np.arange(len(given) if np.ndim(given) else 1)
            is_rows = np.ndim(given) < 2 and np.asarray(given).dtype != bool
            names, nowhere = np.atleast_1d(given) if is_rows else numbers, -1
            if block.refined is not None and np.ndim(given) < 2:  # between two sources is one
                marks = np.zeros(block.origin.n_points, dtype=np.int64)
                marks[given] = np.arange(1, 1 + np.count_nonzero(given)) if not is_rows else 1 + numbers
                marks = block.refined.at_points(marks)
                rows = np.flatnonzero(marks)
                names = names[marks[rows] - 1] if is_rows else marks[rows] - 1
        found = _nearest_sources(
            block.surface, rows, method=method, progress=progress, **arrays, **properties)
        prefix = result_array_name or ""
        name = prefix + found._name
        block.mesh.point_data[name] = found.distance
        block.mesh.point_data[prefix + "NearestSource"] = np.where(
            found.source < 0, nowhere, names[found.source])
        block.mesh.field_data[prefix + "EffectiveMethod"] = [found.method]
        block.mesh.set_active_scalars(name, "point")
    return _rebuild(mesh, iter(blocks))


def geodesic_path(
    mesh: Any, start: Any, end: Any, *, mask: str | None = None, roi: str | None = None,
    progress: Progress = False, **merging: Any,
) -> pyvista.PolyData:
    """Find the shortest path between two places of the mesh, of one surface.

    start, end: the number of a point, or a tuple (face, three barycentric coordinates), or three coordinates.
    mask, roi: point or cell array; points and cells with a nonzero value, or with 0, are left out. All other
    keywords are those of surfacediffusion.geodesic_path. The result is a polyline with the field arrays
    Length and Cells, the cell of the mesh that each of its segments lies in.
    """
    block, path = _on_one(_geodesic_path, mesh, (start, end), mask, roi, progress, merging)
    return _draw_path(block, path)


def path_through(
    mesh: Any, points: Any, closed: bool = False, *, mask: str | None = None, roi: str | None = None,
    progress: Progress = False, **merging: Any,
) -> pyvista.PolyData:
    """Find the shortest paths from each of several places of the mesh to the next, as one.

    points: numbers of points, or coordinates (k, 3), or a data set whose points these are, or a sequence of
    places. closed: whether the path leads back to the first place. All other keywords and the result are
    those of geodesic_path().
    """
    given = getattr(points, "points", points)
    block, path = _on_one(_path_through, mesh, (given, closed), mask, roi, progress, merging)
    return _draw_path(block, path)


def geodesic_disk(
    mesh: Any, center: Any, radius: float, *, mask: str | None = None, roi: str | None = None,
    progress: Progress = False, **merging: Any,
) -> pyvista.PolyData:
    """Find the part of the mesh, of one surface, within a distance of a place.

    center: a place as for geodesic_path(). All other keywords are those of surfacediffusion.geodesic_disk. The
    result has a polyline along each curve of the boundary, and the field array Area.
    """
    _, disk = _on_one(_geodesic_disk, mesh, (center, radius), mask, roi, progress, merging)
    curves = _draw_curves(disk.boundary)
    curves.field_data["Area"] = [disk.area]
    return curves


def random_field(
    mesh: Any, n: int = 1, *, fwhm: float | None = None, range: float | str | None = None,
    nu: float = 1, seed: int = 0, on_faces: bool = False, normalize: bool = True, mask: str | None = None, roi: str | None = None,
    progress: Progress = False, result_array_name: str | None = None, **merging: Any,
) -> Any:
    """Draw Gaussian random fields of mean 0 and variance 1 on the mesh.

    mask, roi: point or cell array; points and cells with a nonzero value, or with 0, are left out. range: a
    number, or a point array. All other keywords are those of surfacediffusion.random_field. The result is the
    point array RandomField, or the cell array with on_faces, with a component per field, which becomes active, and NaN at points that are left out. result_array_name is the
    prefix of its name.
    """

    def draw(block: _Block) -> tuple[str, NDArray[Any]]:
        block.on_faces = on_faces
        ranges = block.find("range", range, faces=False) if isinstance(range, str) else range
        return "RandomField", _random_field(
            block.surface, n, fwhm=fwhm, range=ranges, nu=nu, seed=seed, on_faces=on_faces, normalize=normalize,
            progress=progress, **block.find_all(mask=mask, roi=roi), **merging)

    return _add_columns(mesh, draw, result_array_name, is_prefix=True)


def surrogates(
    mesh: Any, array: str | None = None, n: int = 1000, *, seed: int = 0, mask: str | None = None,
    roi: str | None = None, progress: Progress = False, result_array_name: str | None = None,
) -> Any:
    """Draw surrogates of a map: random maps with its values and its smoothness.

    array: point or cell array with one component; default: the active scalars. mask, roi: point or cell array;
    points and cells with a nonzero value, or with 0, are left out. All other keywords are those of
    surfacediffusion.surrogates. The result is an array at the same place with a component per surrogate, which becomes
    active: that of the map's name followed by Surrogates, or result_array_name.
    """

    def draw(block: _Block) -> tuple[str, NDArray[Any]]:
        values = block.find_whole(array)
        found = _surrogates(block.surface, values, n, on_faces=block.on_faces, seed=seed, progress=progress,
                            **block.find_all(mask=mask, roi=roi))
        return block.name + "Surrogates", found.values

    return _add_columns(mesh, draw, result_array_name)


def scale_filter(
    mesh: Any, array: str | None = None, *, wavelength: float | str, order: int = 1,
    mask: str | None = None, roi: str | None = None, progress: Progress = False,
    result_array_name: str | None = None,
) -> Any:
    """Filter data by scale: a third is left of waves of the wavelength, more of longer ones.

    array: point or cell array; default: the active scalars. wavelength: a number, or a point array. mask, roi: point
    or cell array; points and cells with a nonzero value, or with 0, are left out. The order is that of
    surfacediffusion.scale_filter. The result has the name of the array followed by Filtered, or
    result_array_name, and becomes active.
    """
    def filter_values(block: _Block) -> tuple[str, NDArray[Any]]:
        values, lengths = block.find_whole(array), wavelength
        if isinstance(wavelength, str):
            lengths = block.find("wavelength", wavelength, faces=False)
        return block.name + "Filtered", _scale_filter(
            block.surface, values, lengths, order=order, on_faces=block.on_faces, progress=progress,
            **block.find_all(mask=mask, roi=roi))

    return _add_columns(mesh, filter_values, result_array_name)


def _add_columns(
    mesh: Any, find: Callable[[_Block], tuple[str, NDArray[Any]]], name: str | None, is_prefix: bool = False
) -> Any:
    """Add an array to each surface, at points or cells as its data are, without a second dimension if it has one
    column, and make it active; cells that are no faces have NaN. find: its usual name and its values. name: in
    place of that name, or before it."""
    blocks = _find_surfaces(mesh, "", {})
    for block in blocks:
        usual, values = find(block)
        given = (name or "") + usual if is_prefix else name or usual
        values = values[:, 0] if values.ndim == 2 and values.shape[1] == 1 else values
        if block.on_faces:
            cells = np.full((block.mesh.n_cells, *values.shape[1:]), np.nan)
            cells[block.face_cells] = values
            block.mesh.cell_data[given] = cells
        else:
            block.mesh.point_data[given] = values
        block.mesh.set_active_scalars(given, "cell" if block.on_faces else "point")
    return _rebuild(mesh, iter(blocks))


def derivatives(
    mesh: Any, array: str | None = None, *, mask: str | None = None, roi: str | None = None,
    error: str | None = None, return_result: bool = False, progress: Progress = False, **properties: Any,
) -> Any:
    """Compute derivatives of data on the mesh.

    array: point or cell array; default: the active scalars. Blocks without it pass through, if others
    have it. mask, roi: point or cell array; points and cells with a nonzero value, or with 0, are left
    out. error: point array of the standard errors of slopes of times, tSlopeError of interpolate() with
    compute_error=True, for quantity="ConductionVelocity". All other keywords are those of
    surfacediffusion.derivatives. The result has the name of the array followed
    by the quantity, for instance tGradient, or result_array_name; velocities have their lengths in
    tSpeed, and with error the bounds of a band that holds 90 % of them in tSpeedLower and tSpeedUpper. return_result: if True, the function returns a pair: the mesh, and the DerivativesResult, of
    a MultiBlock the list of them.
    """
    def has(leaf: Any) -> bool:
        return _has(leaf, leaf.active_scalars_name if array is None else array)

    def read(block: _Block) -> dict[str, Any] | None:
        if not has(block.origin) and any(map(has, _find_polydata(mesh))):
            return None
        return {"values": block.find_data(array), **block.find_all(mask=mask, roi=roi),
                "_slope_error": block.find("error", error, faces=False)}

    return _on_each("derivatives", mesh, read, return_result, progress, properties)


def direction_field(
    mesh: Any, hints: str | None = None, *, progress: Progress = False, **properties: Any
) -> Any:
    """Compute a line field on the mesh.

    hints: point or cell array (n, 3) or (m, 3) of directions, for method="Hints". All other keywords
    are those of surfacediffusion.direction_field. The result is the cell array Direction (m, 3):
    unit vectors whose sign has no meaning, zero in cells that have no direction.
    """

    def read(block: _Block) -> dict[str, Any]:
        if block.has_strips:
            raise TypeError("the mesh has triangle strips, which have no single direction; allowed: "
                            "polygons, for example mesh.triangulate()")
        return block.find_all(hints=hints)

    return _on_each("direction_field", mesh, read, False, progress, properties)


_RESULTS = {"harmonic_map": HarmonicMapResult, "mumford_shah": EdgeResult,
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
        self.refined: RefinedSurface | None = None  #: that has made the mesh from the input
        self.name = ""  #: of the data, if they are an array of the mesh or of samples
        self.on_faces = False  #: the data are a cell array
        self.computed = False  #: the data are computed normals

    def find(self, argument: str, name: str | None, points: bool = True, faces: bool = True) -> Any:
        """An array by name, as Placed; None stays."""
        if name is None:
            return None
        if not isinstance(name, str):
            raise ValueError(f"{argument} is {shorten(name)}; allowed: the name of an array")
        if points and name in self.mesh.point_data:
            if self.refined is not None and argument in ROLES and name in self.origin.point_data:
                given = np.asarray(self.origin.point_data[name])
                return place(interpolate_points(given, self.refined.parents, ROLES[argument]), False)
            return place(self.mesh.point_data[name], False)
        if faces and name in self.mesh.cell_data:
            return place(np.asarray(self.mesh.cell_data[name])[self.face_cells], True)
        names = (self.mesh.point_data.keys() if points else []) + (
            self.mesh.cell_data.keys() if faces else [])
        where = " or ".join(["point"] * points + ["cell"] * faces)
        listed = ", ".join(repr(other) for other in names) or "of which there are none"
        raise ValueError(f"{argument} is {shorten(name)}; allowed: {where} arrays, {listed}")

    def find_all(self, **names: str | None) -> dict[str, Any]:
        """Point or cell arrays by the names of arguments."""
        return {argument: self.find(argument, name) for argument, name in names.items()}

    def find_data(self, name: str | None, faces: bool = True, argument: str = "array") -> Any:
        """The data, as Placed: the array of this name, or the active scalars. Name and place are kept."""
        on_cells = False
        if name is None:
            active = self.mesh.active_scalars_info
            name, on_cells = active.name, active.association == pyvista.FieldAssociation.CELL
            if name is None:
                raise ValueError("array is None and the mesh has no active scalars; allowed: the name of an "
                                 "array")
        values = self.find(argument, name, points=not (faces and on_cells), faces=faces)
        self.name, self.on_faces = name, bool(values.on_faces)
        return values

    def find_whole(self, name: str | None, argument: str = "array") -> Any:
        """Data of which a cell has its own."""
        values = self.find_data(name, argument=argument)
        if self.on_faces and self.has_strips:
            raise ValueError(f"{argument} is {shorten(self.name)}, a cell array of triangle strips; allowed: "
                             "polygons, for example mesh.triangulate()")
        return values

    def add(self, output: Output, name: str) -> None:
        """Add an output as an array, and make it active if it has a role. Cells that are no faces keep the
        value of data of this type, or have 0."""
        rows = output.rows[:, 0] if output.rows.shape[1] == 1 else output.rows
        on_faces = output.place == "faces"
        given, made = ((mesh.cell_data if on_faces else mesh.point_data) for mesh in (self.input, self.mesh))
        array = given.VTKObject.GetAbstractArray(self.name) if self.name else None
        if on_faces:
            cells = (np.array(given[self.name], dtype=rows.dtype)
                     if output.kind == "data" and array is not None else
                     np.zeros((self.mesh.n_cells, *rows.shape[1:]), dtype=rows.dtype))
            cells[self.face_cells] = rows
            rows = cells
        made[name] = rows
        if not output.role:
            return
        of_normals = self.computed or self.name == given.active_normals_name
        of_bytes = array is not None and array.GetDataType() == VTK_UNSIGNED_CHAR
        role = attribute_of(output, of_normals, of_bytes)
        if role == vtkDataSetAttributes.NORMALS:
            made.VTKObject.SetActiveNormals(name)
            return
        activate = (self.mesh.set_active_vectors if role == vtkDataSetAttributes.VECTORS else
                    self.mesh.set_active_scalars)
        activate(name, preference="cell" if on_faces else "point")

    def write(self, outputs: list[Output], prefix: str | None) -> None:
        """Add the outputs to the mesh."""
        for output in outputs:
            if output.role == "coordinates":
                before = vtkPolyData()
                before.ShallowCopy(self.input)
                before.SetPolys(self.mesh.GetPolys())  # which may be turned
                move_points(output.rows, before, self.mesh)
            elif output.place in ("points", "faces") and output.entry["columns"]:
                self.add(output, name_of(output, self.name, prefix or ""))

    def with_edges(self, fine: RefinedSurface) -> _Block:
        """The block with the triangles of a finer surface in place of its faces, and with its data."""
        mesh = pyvista.PolyData()
        mesh.ShallowCopy(refined_polydata(self.input, fine.surface.points, fine.surface.triangles,
                                          self.face_cells[fine.faces], fine.parents, {}))
        mesh.copy_meta_from(self.input)
        block = _Block(mesh)
        block.origin, block.refined = self.origin, fine
        return block

    def fresh(self) -> _Block:
        """The same surface, with a mesh for other results."""
        block = object.__new__(_Block)
        block.__dict__.update(self.__dict__, mesh=self.input.copy(deep=False))
        return block


def _find_polydata(mesh: Any) -> Iterator[pyvista.PolyData]:
    """The mesh, or the blocks of a MultiBlock at any depth, without those that are None. TypeError
    with the remedy if there is anything other than a surface."""
    if isinstance(mesh, pyvista.MultiBlock):
        for block in mesh:
            if block is not None:
                yield from _find_polydata(block)
    elif isinstance(mesh, pyvista.PolyData):
        yield mesh
    else:
        remedy = "; mesh.extract_surface() gives its surface" if hasattr(
            mesh, "extract_surface") else ""
        raise TypeError(f"the mesh is a {type(mesh).__name__}; allowed: pyvista.PolyData, or a "
                        f"pyvista.MultiBlock of it{remedy}")


def _find_faces(mesh: pyvista.PolyData) -> tuple[Any, NDArray[np.int64]]:
    """The polygons, and strips as triangles, without hidden and ghost cells; the cell of each."""
    corners, offsets, cells = read_cells(mesh).without_strips()
    sizes, flags = np.diff(offsets), cell_flags(mesh)
    kept = sizes > 2
    if flags is not None:
        kept &= (flags[cells] & ABSENT) == 0
    if len(np.unique(sizes)) == 1 and sizes[0] > 2:
        return corners.reshape(-1, sizes[0])[kept], cells[kept]
    faces = np.split(corners, offsets[1:-1])
    return [faces[i] for i in np.flatnonzero(kept)], cells[kept]


def _has(mesh: Any, name: Any) -> bool:
    """Whether there is a point or cell array of this name."""
    return isinstance(name, str) and (name in mesh.point_data or name in mesh.cell_data)


def _find_surfaces(mesh: Any, function: str, keywords: dict[str, Any]) -> list[_Block]:
    """The surfaces of a mesh, without empty blocks. Keywords of refinement are used and removed."""
    refine_to, limit = (keywords.pop(new.name, new.default) for new in keywords_of(function))
    leaves = list(_find_polydata(mesh))
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


def _on_one(
    function: Callable[..., Any], mesh: Any, places: Sequence[Any], mask: str | None, roi: str | None,
    progress: Progress, merging: dict[str, Any],
) -> tuple[_Block, Any]:
    """The only surface of a mesh, and what a function finds on it."""
    blocks = [block for block in map(_Block, _find_polydata(mesh)) if not block.empty]
    if len(blocks) != 1:
        raise ValueError(f"the mesh has {len(blocks)} blocks with polygons or strips; allowed: one")
    given = blocks[0].find_all(mask=mask, roi=roi)
    return blocks[0], function(blocks[0].surface, *places, progress=progress, **given, **merging)


def _draw_curves(curves: Sequence[NDArray[Any]]) -> pyvista.PolyData:
    """A polyline for each of them; a vertex for a single point."""
    if sum(map(len, curves)) < 2:
        return pyvista.PolyData(np.reshape(curves, (-1, 3))) if curves else pyvista.PolyData()
    first = np.cumsum([0, *map(len, curves)])
    lines = [np.concatenate([[len(curve)], begin + np.arange(len(curve))])
             for begin, curve in zip(first, curves)]
    return pyvista.PolyData(np.concatenate(curves), lines=np.concatenate(lines))


def _draw_path(block: _Block, path: Any) -> pyvista.PolyData:
    drawn = _draw_curves([path.points])
    drawn.field_data["Length"] = [path.length]
    drawn.field_data["Cells"] = np.asarray(block.face_cells)[path.faces]
    return drawn


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


def _on_each(
    name: str, mesh: Any, read: Callable[[_Block], dict[str, Any] | None], return_result: bool,
    progress: Progress, properties: dict[str, Any],
) -> Any:
    """Call a function without times on each surface. read: the arguments of a surface; None: it passes."""
    function = _relief if name == "relief" else getattr(_functions, name)
    properties, result_name = _keywords(name, properties)
    blocks, results = _find_surfaces(mesh, name, properties), []
    for block in blocks:
        arguments = read(block)
        if arguments is None:
            continue
        outputs: list[Output] = []
        result = function(block.surface, progress=progress, _outputs=outputs, **arguments, **properties)
        results.append(result)
        if name == "relief":
            turned = (result.surface.triangles != block.surface.triangles).any(axis=1)
            turn_polygons(block.mesh, block.face_cells[block.surface._core.faces()[turned]])
        block.write(outputs, result_name)
    return _built(mesh, blocks, results, return_result)


def _prepare(
    function: str, block: _Block, array: str | None, names: Sequence[str | None],
    properties: dict[str, Any],
) -> Input:
    """The input of a block."""
    mask, roi, direction, fixed, rates, fidelity = names
    if function == "harmonic_map":
        name = block.mesh.point_data.active_normals_name if array is None else array
        values = None if name is None else block.find_whole(name)
        block.name, block.computed = name or "Normals", name is None
    elif function == "turing_texture":
        values = block.find("initial", array, faces=False)
    else:
        values = block.find_whole(array)
    data, on_faces, integers = take_data(function, block.surface, values, name=block.name)
    marks = block.find_all(mask=mask, roi=roi, fixed=fixed, fidelity=fidelity)
    marks["mask"] = as_mask(marks["mask"], marks.pop("roi"), block.surface, properties)
    return Input(
        block.surface, data, data_on_faces=on_faces, directions=block.find("direction", direction),
        directions_name="direction", integers=integers, rates=block.find("rates", rates, points=False),
        refined=block.refined if function in ESTIMATING else None, **marks)


def _run(
    function: str, mesh: Any, array: str | None, names: Sequence[str | None],
    times: Sequence[float] | None, return_result: bool, progress: Progress, properties: dict[str, Any],
) -> Any:
    properties, result_name = _keywords(function, properties)
    if times is not None and not isinstance(times, Iterable):
        raise ValueError(f"times is {shorten(times)}; allowed: a list of numbers")
    dtype = properties.pop("dtype", None)
    blocks, inputs, failures = [], [], []
    for block in _find_surfaces(mesh, function, properties):
        try:
            given = _prepare(function, block, array, names, properties)
            find_result_type(given.data, dtype)
            blocks.append(block)
            inputs.append(given)
        except ValueError as error:
            if _has(block.mesh, array):
                raise
            failures.append(error)
    runner = Runner(function, properties, {
        **ARRAYS, "DirectionArray": "direction",
        "InputArray": "initial" if function == "turing_texture" else "array"})
    if not blocks:
        raise failures[0]
    run = _core.ModelRun(function)

    def build(state: list[dict[str, Any]]) -> tuple[Any, Any]:
        results: list[Result] = []
        written = [block.fresh() for block in blocks]
        for number, (block, given) in enumerate(zip(written, inputs)):
            outputs = find_outputs(run, number, given, dtype, runner.call)
            block.write(outputs, result_name)
            results.append(make_result(
                _RESULTS.get(function, DiffusionResult), outputs, state[number], block.surface))
        whole = _rebuild(mesh, iter(written))
        return whole, results if isinstance(mesh, pyvista.MultiBlock) else results[0]

    if times is None:
        output, reports = runner.finish(run, inputs, build, progress)
        return (output, reports) if return_result else output
    runner.start(run, inputs)
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
