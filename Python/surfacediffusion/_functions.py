# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The models as functions of arrays. Their signatures and the parts of their docstrings that list
keywords are made from the settings that the C++ library declares."""

from __future__ import annotations

import functools
import inspect
import textwrap
from dataclasses import replace
from typing import Any, Callable, Mapping, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._models import ARRAYS, Output, as_mask, as_samples, find_outputs, make_result, read_outputs, take_data
from ._refinement import document_keywords, keywords_of, with_refinement
from ._result import (
    CurvatureResult, DerivativesResult, DiffusionResult, EdgeResult, HarmonicMapResult,
    InterpolationResult, MeshDenoisingResult, Result, SegmentationResult, TensorDiffusionResult,
    TextureResult,
)
from ._run import (
    Input, Progress, ProgressReporter, Runner, States, find_result_type, take_old_switch, warn,
)
from ._settings import settings_of, shorten, spell_documentation
from ._surface import Surface, SurfaceLike, as_numbers, as_surface, left_out, on_points, place, require_shape

__all__ = [
    "curvature", "denoise_mesh", "derivatives", "direction_field", "harmonic_map", "heat", "interpolate",
    "intrinsic_tv", "mumford_shah", "segment", "tensor_diffusion", "turing_texture",
]

#: The number of columns of data that a run holds in double precision, if they are independent.
PANEL = 32

F = TypeVar("F", bound=Callable[..., Any])

#: The documentation that functions share, by the name in braces.
SHARED = {
    "surface": """\
surface : Surface or tuple (points, faces)
    The surface. A :class:`Surface` keeps mesh, ordering and factors between calls.""",
    "mask": """\
mask : array_like, shape (n,) or (m,), optional
    Nonzero is missing, or excluded with ``mask_mode="Exclude"``: the opposite of `roi`. At points or
    faces, as `fixed` and `fidelity`: the points of a masked or fixed face are masked or fixed, and
    faces with a masked point are masked if the data are on faces.""",
    "roi": """\
roi : array_like, shape (n,) or (m,), optional
    The region of interest: nonzero is inside, as for nilearn, FSL and Workbench. Zero and NaN are
    outside: nothing flows across the boundary of the region, and values outside are not changed. It
    is ``mask=(roi == 0), mask_mode="Exclude"``, and is not given together with `mask`.""",
    "directions": """\
directions : array_like, shape (n, 3) or (m, 3), optional
    The direction e1 at each point or face, of any length and sign; zero or NaN is none. Where there
    are as many points as faces, :func:`on_faces` says which, and so does a result on faces.""",
    "left_out": """\
mask : array_like, shape (n,) or (m,), optional
    Nonzero leaves a point with its faces, or a face, out: the surface ends there.
roi : array_like, shape (n,) or (m,), optional
    The region of interest, the opposite of a mask and in place of one: zero and NaN are left out.""",
    "fixed": """\
fixed : array_like, shape (n,) or (m,), optional
    Nonzero holds the value (Dirichlet condition).""",
    "fidelity": """\
fidelity : array_like, shape (n,) or (m,), optional
    Factors w >= 0 of `fidelity_weight` at each point or face, such as 1/s^2 for noise of standard
    deviation s. Values of weight 0 are the start of time steps; elsewhere they are missing.""",
    "dtype": """\
dtype : float32 or float64, optional
    The type of the result; default: float32 for float32, uint8 for uint8 (rounded at the end),
    float64 for all other types.""",
    "progress": """\
progress : bool or callable, default False
    True: a bar (needs tqdm). A callable takes the fraction done; an exception that it raises
    ends the run.""",
    "values": """\
values : array_like, shape (n,) or (n, k), or (m,) or (m, k)
    The data f, one row per point or face. NaN in any component is missing; a connected component
    without a known value is NaN in the result, or as it was if the data are integers. uint8 with
    2 or 4 components is a colour with alpha, which is not changed. Data on faces are averaged at
    the points such that the integral is kept, and come back as the mean over each face; what the
    points do not resolve diffuses on the faces and is added. See `result_on_faces` and
    `keep_face_detail`.""",
    "on_faces": """\
on_faces : bool, optional
    Whether the data are on faces. Default: by their number of rows; on points if there are as many
    points as faces.""",
    "raises": """\
Raises
------
ValueError
    For settings and arrays that are not allowed; the message names the argument, what was found
    and what is allowed.
KeyboardInterrupt
    Within a block of work after Ctrl-C. The surface can be used again.""",
    "warns": """\
Warns
-----
SurfaceDiffusionWarning
    For degenerate triangles, solves above their tolerance, masks without effect.""",
}
SHARED["problems"] = SHARED["raises"] + "\n\n" + SHARED["warns"]
SHARED["diffusion"] = "\n".join(SHARED[name] for name in (
    "surface", "values", "on_faces", "mask", "roi", "directions", "fixed", "fidelity", "dtype", "progress"))


def _with_settings(function: F) -> F:
    """Give a function the signature and the documentation of its settings."""
    table = settings_of(function.__name__)
    parameters, entries = [], []
    for parameter in inspect.signature(function).parameters.values():
        if parameter.kind is not inspect.Parameter.VAR_KEYWORD:
            parameters.append(parameter)
    own = {parameter.name for parameter in parameters}
    for setting in table.values():
        if setting.keyword in own:
            continue
        kind = {"number": "float", "integer": "int", "switch": "bool",
                "numbers": "array_like"}.get(setting.kind, "")
        if setting.kind == "choice":
            words = dict.fromkeys(word for pair in setting.spellings.items() for word in pair)
            kind = "Literal[" + ", ".join(f'"{word}"' for word in words) + "]"
        parameters.append(inspect.Parameter(
            setting.keyword, inspect.Parameter.KEYWORD_ONLY, default=setting.default,
            annotation="ArrayLike" if kind == "array_like" else kind))
        allowed = "{" + setting.allowed + "} or in snake_case" if setting.kind == "choice" else kind
        if setting.kind in ("number", "integer"):
            allowed += ", " + setting.allowed
        unit = f", in {setting.unit}" if setting.unit else ""
        text = textwrap.fill(spell_documentation(function.__name__, setting.documentation, ARRAYS),
                             92, initial_indent="    ", subsequent_indent="    ",
                             break_on_hyphens=False)
        entries.append(f"{setting.keyword} : {allowed}{unit}, default {setting.default}\n{text}")
    parameters += keywords_of(function.__name__)
    entries.append(document_keywords(function.__name__))
    returned = inspect.signature(function).return_annotation
    function = with_refinement(function)
    function.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        parameters, return_annotation=returned)
    text = inspect.cleandoc(function.__doc__ or "")
    settings = "\n".join(["Other Parameters", "----------------", *entries])
    for name, part in {**SHARED, "settings": settings}.items():
        text = text.replace("{" + name + "}", part)
    function.__doc__ = text
    return function


def _find_form(properties: dict[str, Any], function: str) -> str:
    """How a function with time steps returns what it finds, which leaves the properties: "states" for
    <function>_steps(); with the old switches "states", or "result" in place of an array; otherwise ""."""
    form = "states" if properties.pop("_states", False) else ""
    instead = f"call {function}_steps()"
    if take_old_switch(properties, function, "steps", instead):
        form = "states"
    if function in _ARRAYS_ALONE and take_old_switch(
            properties, function, "full_output", f"{instead}.last()") and not form:
        form = "result"
    return form


#: The functions with time steps whose result is an array alone.
_ARRAYS_ALONE = ("heat", "intrinsic_tv", "tensor_diffusion")


def _run(
    name: str,
    given: Input,
    runner: Runner,
    make: Callable[[Any, dict[str, Any]], Any],
    form: str,
    progress: Progress,
    history: bool = True,
) -> Any:
    """The result, or the states. history: whether the result needs the energy and the totals of the
    states."""
    if form == "states":
        return States(name, runner, given, make, progress)
    with given.surface._lock:
        run = given.surface._runs.setdefault(name, _core.ModelRun(name))
        return runner.finish(run, [given], lambda found: make(run, found[0]), progress, history)


#: The arguments of functions of data in time steps beside the settings, with their types.
_ARGUMENTS = {
    "on_faces": "bool | None",
    **dict.fromkeys(("mask", "roi", "directions", "fixed", "fidelity", "rates"), "ArrayLike | None"),
    "dtype": "Any", "progress": "Progress"}


def _of_data(result_class: type[Result]) -> Callable[[F], F]:
    """Give a function of data in time steps, which has the surface and the data, its other arguments and
    its body."""

    def complete(function: F) -> F:
        own = inspect.signature(function)
        surface, data, properties = own.parameters.values()
        without = ("on_faces", "fidelity") if data.name == "initial" else ("rates",)
        signature = own.replace(parameters=[surface, data, *(
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, annotation=kind,
                              default=False if name == "progress" else None)
            for name, kind in _ARGUMENTS.items() if name not in without), properties])

        @functools.wraps(function)
        def run(*arguments: Any, **keywords: Any) -> Any:
            given = signature.bind(*arguments, **keywords)
            given.apply_defaults()
            named = dict(given.arguments)
            return _diffusion(function.__name__, data.name, result_class, named.pop("surface"),
                              named.pop(data.name), named.pop("properties", {}), **named)

        run.__signature__ = signature  # type: ignore[attr-defined]
        return run  # type: ignore[return-value]

    return complete


def _diffusion(
    name: str, data_name: str, result_class: type[Result], surface: Any, values: Any,
    properties: dict[str, Any], *, mask: Any, roi: Any, directions: Any, fixed: Any, dtype: Any,
    progress: Progress, on_faces: Any = None, fidelity: Any = None, rates: Any = None,
) -> Any:
    form = _find_form(properties, name)
    surface = as_surface(surface)
    data, on_faces, integers = take_data(name, surface, values, on_faces)
    find_result_type(data, dtype)
    given = Input(surface, data, data_on_faces=on_faces, mask=as_mask(mask, roi, surface, properties),
                  fixed=fixed, directions=directions, fidelity=fidelity, rates=rates, integers=integers,
                  refined=properties.pop("_refined", None))
    runner = Runner(name, properties, {**ARRAYS, "InputArray": data_name})

    def make(run: Any, found: dict[str, Any]) -> Any:
        result = make_result(result_class, find_outputs(run, 0, given, dtype, runner.call), found, surface)
        return replace(result, values=result.values[:, 0]) if np.ndim(values) == 1 else result

    is_array = name in _ARRAYS_ALONE and not form
    if is_array and data.shape[1] > PANEL and _core.has_independent_columns(name, runner.settings):
        stays = on_faces and runner.settings.get("ResultOnCells", True)
        rows = surface.n_faces if stays else surface.n_points
        output = np.empty((rows, data.shape[1]), dtype=find_result_type(data, dtype))
        with surface._lock:
            run = surface._runs.setdefault(name, _core.ModelRun(name))
            runner.finish_panels(run, given, output, PANEL, progress)
        return output
    result = _run(name, given, runner, make, form, progress, not is_array)
    return result.values if is_array else result


def _find(name: str, result_class: Any, given: Input, properties: dict[str, Any], progress: Progress) -> Any:
    """The result of a model of data without time steps. `_outputs`: a list that gets the outputs, which have
    the type of the data then."""
    listed = properties.pop("_outputs", None)
    runner = Runner(name, properties, ARRAYS)

    def make(run: Any, found: dict[str, Any]) -> Any:
        outputs = find_outputs(run, 0, given, np.float64 if listed is None else None, runner.call)
        if listed is not None:
            listed.extend(outputs)
        return make_result(result_class, outputs, found, given.surface)

    return _run(name, given, runner, make, "", progress)


def run_once(
    name: str, given: Input, properties: dict[str, Any], arrays: Mapping[str, str], progress: Progress
) -> tuple[list[Output], dict[str, Any]]:
    """The outputs of a computation without a model, and the attributes of its result. `_outputs`: a list that
    gets the outputs, too."""
    listed = properties.pop("_outputs", [])
    runner, surface = Runner(name, properties, arrays), given.surface
    with surface._lock, ProgressReporter(progress) as reporter:
        run = surface._runs.setdefault(name, _core.SurfaceRuns(name))
        runner.call(run.update, [given.core], runner.settings, reporter.callable)
        outputs = read_outputs(run.outputs(0), functools.partial(runner.call, run.write, 0), given)
        found = {"mean_edge_length": run.numbers()["MeanEdgeLength"][0][0], "warnings": runner.warnings(run),
                 "turned": run.turned_triangles(0), "walls": run.walls(0)}
        reporter.finish_part()  # last, because the callable may use the run
    warn(found["warnings"])
    listed.extend(outputs)
    return outputs, found


@_with_settings
@_of_data(DiffusionResult)
def heat(surface: SurfaceLike, values: ArrayLike, **properties: Any) -> NDArray[Any]:
    """Smooth, denoise or inpaint data on a surface by linear diffusion.

    Solves u_t = div(D grad u) + lambda chi (f - u), u(0) = f, with no flux across the boundary. D
    has the eigenvalues `along_diffusivity` and `across_diffusivity`, lambda is `fidelity_weight`,
    and chi is 1 where f is known and 0 where it is missing. With D = 1, div grad is the
    Laplace-Beltrami operator. The integral of u over the surface is conserved if lambda is 0.

    With ``mode="SteadyState"`` and `blur_fwhm` it restores data that were blurred on the surface: u
    minimises the integral of 1/2 D grad u . grad u + lambda/2 chi (H u - f)^2, where H is the blur.
    Then lambda is found as with `automatic_fidelity`, unless `fidelity_weight` is above 0.

    Parameters
    ----------
    {diffusion}

    {settings}

    Returns
    -------
    ndarray of the shape of `values`

    {problems}

    Notes
    -----
    The discretisation is the finite volume method of Wu, Deng and Chen (IEEE TVCG 14(3), 2008) with
    the lumped mass matrix and the cotan weights; with `fwhm` the mean of the lumped and the consistent
    mass matrix, so that white noise gets the width to 5 % from 2 mean edge lengths on. Times and weights
    are by default in natural units: lengths in the mean edge length h, values in their range R. `fwhm` is
    in coordinate units. One of
    `fwhm`, `time_step` and `mode` has to be given, since a default width would depend on the mesh; two
    of them are an error, and so are other settings of which one takes the place of another.

    `number_of_time_steps` is 10 by default, as in most models, which suits a look at the states on the
    way. With a `fwhm` the time integrator is Exponential, and for a single result
    ``number_of_time_steps=1`` is the fastest and nearly the most accurate, as ``surfacediffusion smooth``
    takes: it solves 6 systems in place of 60, and its error in time is 0.5 % (L2) for white noise of
    any width (1 % for data at faces). Values may leave the range of the data by 5e-4 of it, by up to 0.6 %
    of single peaks at widths of 1.5 edges, and by more at obtuse angles of boundaries. Another integrator
    with fewer than 4 steps misses the width, with a warning.

    Vectors of shape (n, 3) that lie in the surface, within 5 degrees on nine tenths of it, are diffused
    as tangent vectors, which is said in a warning: they are carried along the surface from point to point
    and stay in its plane (`vector_type`, which takes (n, 3k) for several; `vector_laplacian`,
    `normal_part`). Angles and other cyclic data need their `period`; the `coherence` of
    :func:`heat_steps` measures how well neighbouring data agree.

    More than 32 columns are solved 32 at a time, with the same bits, so that the memory for states
    in double precision does not grow with their number. This does not hold with `automatic_fidelity`,
    ``initial_fill="Noise"`` and :func:`heat_steps`, which need all columns at once.

    :func:`heat_steps` has the states on the way, and times, energies and totals.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import heat, heat_steps, sphere
    >>> surface = sphere(4, radius=100.0)
    >>> noise = np.random.default_rng(0).normal(size=surface.n_points)
    >>> smooth = heat(surface, noise, fwhm=30.0)
    >>> smooth.shape, bool(smooth.std() < 0.3 * noise.std())
    ((2562,), True)
    >>> result = heat_steps(surface, noise, fwhm=30.0).last()
    >>> bool(np.array_equal(result.values, smooth)), result.step
    (True, 10)
    >>> [state.step for state in heat_steps(surface, noise, fwhm=30.0, output_interval=4)]
    [0, 4, 8, 10]
    >>> wind = np.cross([0.0, 0.0, 1.0], surface.points / 100.0)
    >>> calm = heat(surface, wind, fwhm=100.0, vector_type="Tangent", vector_laplacian="Viscous")
    >>> bool(np.abs(calm - wind).max() < 1e-9)  # a rigid rotation has no viscous stress
    True
    >>> phase = np.degrees(np.arctan2(surface.points[:, 1], surface.points[:, 0])) % 360.0
    >>> bool(np.abs(heat(surface, (phase + 360.0), fwhm=30.0, period=360.0)
    ...             - heat(surface, phase, fwhm=30.0, period=360.0) - 360.0).max() < 1e-9)
    True
    >>> north = surface.points[:, 2] > 0.0
    >>> region = heat(surface, noise, fwhm=30.0, roi=north)
    >>> bool(np.array_equal(region[~north], noise[~north]))
    True
    """


@_with_settings
@_of_data(DiffusionResult)
def intrinsic_tv(surface: SurfaceLike, values: ArrayLike, **properties: Any) -> NDArray[Any]:
    """Denoise or inpaint data on a surface and preserve their edges.

    Solves u_t = div(g(abs(grad u)) grad u) + lambda chi (f - u), u(0) = f, by default with the g of
    total variation, 1/sqrt(abs(grad u)^2 + beta). With ``mode="SteadyState"`` it minimises the
    energy, integral of abs(grad u) + lambda/2 chi (f - u)^2. With ``regularizer="TGV"``, too, ramps
    and roofs keep their slopes, which total variation turns into stairs. With `blur_fwhm`, too, it restores data
    that were blurred on the surface: H u stands in place of u in the second term, where H is the
    blur. lambda is the one of the smallest estimated error (`automatic_fidelity`), unless `fidelity_weight` is
    given, the energy is not convex or `fidelity_norm` is "L1". `color_model` describes colours, three columns, by brightness and two axes of colour, or by
    brightness and chromaticity; both restore colours whose hue is noisy better than the default.

    Parameters
    ----------
    {diffusion}

    {settings}

    Returns
    -------
    ndarray of the shape of `values`

    {problems}

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import intrinsic_tv_steps, sphere
    >>> surface = sphere(4)
    >>> clean = np.sign(surface.points[:, 2])
    >>> noisy = clean + np.random.default_rng(0).normal(scale=0.3, size=clean.size)
    >>> result = intrinsic_tv_steps(surface, noisy, automatic_fidelity=True, mode="SteadyState").last()
    >>> bool(np.abs(result.values - clean).mean() < 0.5 * np.abs(noisy - clean).mean())
    True
    >>> bool(result.effective_fidelity_weight > 0)
    True
    """


@_with_settings
@_of_data(TensorDiffusionResult)
def tensor_diffusion(surface: SurfaceLike, values: ArrayLike, **properties: Any) -> NDArray[Any]:
    """Smooth data along their own edges or lines, with a diffusion tensor D that follows from them.

    Solves m u_t = div(D grad u) + lambda chi (f - u), u(0) = f. With T = sum over the components of
    grad u grad u^T:

    - ``model="Beltrami"`` (Sochen, Kimmel, Malladi 1998): D = sqrt(det G) G^-1, G = 1 + b^2 T, where
      b is `color_scale`. The area of b u as a surface over the surface never grows. m = sqrt(det G),
      or 1 with ``metric="Fixed"``, which conserves the integral of u. Edges of all components of a
      colour stay in one place. Steady states with fixed values are minimal surfaces.
    - ``model="CoherenceEnhancing"`` (Weickert 1999): D is `alpha` across lines, and up to 1 along
      them. The direction is that of the structure tensor, T of the data smoothed by `noise_scale`,
      smoothed by `integration_scale` with the parallel transport of the surface. Interrupted lines
      are closed.
    - ``model="EdgeEnhancing"`` (Weickert 1998): D is 1 along edges, and small across edges whose
      gradient is above `contrast`.

    Parameters
    ----------
    {surface}
    {values}
    {on_faces}
    {mask}
    {roi}
    directions : array_like, shape (n, 3) or (m, 3), optional
        The direction at each point or face that `along_diffusivity` and `across_diffusivity` refer
        to; zero or NaN is none. D has its own axes besides.
    {fixed}
    {fidelity}
    {dtype}
    {progress}

    {settings}

    Returns
    -------
    ndarray of the shape of `values`

    {problems}

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import sphere, tensor_diffusion
    >>> surface = sphere(4)
    >>> clean = np.sign(surface.points)
    >>> noisy = clean + np.random.default_rng(0).normal(scale=0.2, size=clean.shape)
    >>> smooth = tensor_diffusion(surface, noisy, model="Beltrami", number_of_time_steps=4)
    >>> bool(np.abs(smooth - clean).mean() < 0.6 * np.abs(noisy - clean).mean())
    True
    """


@_with_settings
@_of_data(EdgeResult)
def mumford_shah(surface: SurfaceLike, values: ArrayLike, **properties: Any) -> EdgeResult:
    """Find the edges of data on a surface, and smooth or inpaint the data between them.

    Minimises the functional of Mumford and Shah in the approximation of Ambrosio and Tortorelli
    (CPAM 43, 1990), over u, which is smooth between edges, and v, which is near 0 on them and 1
    elsewhere: the integral of lambda/2 chi abs(u - f)^2 + 1/2 (v^2 + kappa) abs(grad u)^2
    + beta (eps abs(grad v)^2 + (1 - v)^2/(4 eps)). chi is 1 where f is known and 0 where it is
    missing: there u and v are continued. The columns of the data have their edges in common.

    The coefficients are lambda = `fidelity_weight`/`smoothing_length`^2, eps = `edge_width`, kappa =
    1e-6 and beta = `edge_threshold`^2/(4 `smoothing_length`)/(1 + h/(4 eps)), so that a jump of
    `edge_threshold` costs as much as an edge as if it is smoothed. By default
    (`automatic_threshold`) both are found from the data, for each connected component, such that
    neither noise nor slopes become edges. The result is a local minimum.

    Parameters
    ----------
    {diffusion}

    {settings}

    Returns
    -------
    EdgeResult
        `values` are u, `edges` is 1 - v, and `curves` are the edges as polylines. If
        `edge_threshold` or `smoothing_length` is given, `automatic_threshold` is off unless it is
        given, too.

    {problems}

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import mumford_shah, sphere
    >>> surface = sphere(5)
    >>> clean = np.where(surface.points[:, 2] > 0.5, 1.0, 0.0)
    >>> noisy = clean + np.random.default_rng(0).normal(scale=0.04, size=clean.size)
    >>> result = mumford_shah(surface, noisy)
    >>> len(result.curves), round(float(result.edge_length / (2 * np.pi * np.sqrt(0.75))), 2)
    (1, 1.0)
    >>> bool(np.abs(result.values - clean).mean() < 0.2 * np.abs(noisy - clean).mean())
    True
    """


@_with_settings
@_of_data(HarmonicMapResult)
def harmonic_map(
    surface: SurfaceLike, vectors: ArrayLike | None = None, **properties: Any
) -> HarmonicMapResult:
    """Regularise normals or other unit vectors, or denoise the points of the surface.

    Solves u_t = div(g grad u) + u g abs(grad u)^2 + lambda chi (f - u), u(0) = f/abs(f), with
    g = (abs(grad u)^2 + beta)^((p - 2)/2), where p is `exponent`; abs(u) = 1 at every point.

    Parameters
    ----------
    {surface}
    vectors : array_like, shape (n, k) or (m, k) with k > 1, optional
        The vectors f at points or faces, which are normalised first. Zero and NaN are missing. Default: the normals of
        the points, in single precision.
    {on_faces}
    {mask}
    {roi}
    {directions}
    {fixed}
    {fidelity}
    {dtype}
    {progress}

    {settings}

    Returns
    -------
    HarmonicMapResult
        `values` are the vectors, `points` the points, moved if ``move_vertices=True``.

    {problems}

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import Surface, harmonic_map, sphere
    >>> clean = sphere(4)
    >>> noise = np.random.default_rng(0).normal(scale=0.01, size=(clean.n_points, 1))
    >>> noisy = Surface(clean.points * (1 + noise), clean.triangles)
    >>> points = harmonic_map(noisy, move_vertices=True).points
    >>> bool(np.linalg.norm(points, axis=1).std() < 0.5 * noise.std())
    True
    """


def _find_creases(surface: Surface, creases: Any) -> Any:
    """Labels of points or faces; edges, (k, 2), are those between the points that they have."""
    if creases is None or np.ndim(creases) != 2:
        return creases
    edges = as_numbers("creases", creases)
    require_shape("creases", edges, edges.shape[1] == 2, "(k, 2), the two points of each edge")
    if edges.dtype.kind not in "iu" or ((edges < 0) | (edges >= surface.n_points)).any():
        raise ValueError(f"creases is {shorten(creases)}; allowed: rows of points, 0 to {surface.n_points - 1}")
    marks = np.zeros(surface.n_points)
    marks[edges] = 1.0
    return on_points(marks)


@_with_settings
def denoise_mesh(
    surface: SurfaceLike,
    *,
    fixed: ArrayLike | None = None,
    creases: ArrayLike | None = None,
    progress: Progress = False,
    **properties: Any,
) -> MeshDenoisingResult:
    """Remove the noise of the points of a surface, and keep its sharp edges.

    Two steps alternate. With the normals n0_f, the areas a_f and the centroids c_f of the triangles of
    the present surface, the first finds regular normals n_f, the directions of

        a_f n0_f + sum_g a_g w_fg n0_g
        w_fg = exp(-abs(c_f - c_g)^2/(2 s^2) - abs(m_f - m_g)^2/(2 r^2))

    over the triangles g that share a point with f. The guide normals m make the weights small across
    sharp edges (Zhang, Deng, Zhang, Bouaziz, Liu, Guided Mesh Normal Filtering, CGF 34(7), 2015). Later
    iterations fit linear functions of the centroids with the same weights. The second step moves the
    points x, which were given as x0, by one step of conjugate gradients towards the minimum of

        sum_f 1/3 sum_{edges ij of f} (n_f . (x_i - x_j))^2 + sum_i l_i (N_i . (x_i - x0_i))^2

    and a term that keeps tangential displacements small. All weights follow from the noise level: l_i
    is proportional to the inverse of its square, and smaller for outliers. Where the displacements along
    the normals stay less alike at neighbours than independent noise after all steps, these have removed
    noise only, and are kept. Elsewhere steps end before they remove details. On CAD shapes the
    total generalised variation of the normals is minimised then (Liu, Li, Wang, Liu,
    Chen, TVCG 28(12), 2022). A surface counts as CAD if the displacements are as white as independent
    noise after this. Otherwise it is organic, and the result before is kept: details were lost.

    Connected components have levels, kinds and units of length of their own. Noise that cannot be
    distinguished from the shape stays unless `noise_level` is given: that of components with less than 200 points, and
    of those with more than a quarter of the edges within flat faces. A surface whose estimated noise is
    0 stays as it is. Faces may be oriented at random, and the numbering of points and faces
    does not matter. Single points farther than 5 radii of the ring of their neighbours from its middle are
    moved there first, and counted in a warning.

    Parameters
    ----------
    {surface}
    fixed : array_like, shape (n,) or (m,), optional
        Nonzero points, and the points of nonzero faces, stay where they are.
    creases : array_like of int, shape (m,), (n,) or (k, 2), optional
        Edges that stay as they are, and whose sides are smoothed apart: those between faces of different
        labels, such as those of the faces of a CAD model; between points of nonzero labels; or
        given by their two points.
    {progress}

    {settings}

    Returns
    -------
    MeshDenoisingResult
        With the `points`; those of no face stay. It has the noise level, the kind of surface,
        displacements, volumes and warnings, too, and stands for `points` where numpy takes an array.

    {raises}

    Warns
    -----
    SurfaceDiffusionWarning
        For triangles of zero area, for coincident points that may come apart, if no noise was found,
        if it is correlated over several edges or like the shape, if the volume of a
        closed component changes by more than 2 %, if points moved by more than 10 times its level,
        and if they moved by more in some places than in others, as noise that is everywhere the same does not.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import Surface, denoise_mesh, sphere
    >>> clean = sphere(4)
    >>> noise = np.random.default_rng(0).normal(scale=0.01, size=(clean.n_points, 1))
    >>> noisy = Surface(clean.points * (1 + noise), clean.triangles)
    >>> result = denoise_mesh(noisy)
    >>> bool(np.linalg.norm(result.points, axis=1).std() < 0.5 * noise.std())
    True
    >>> result.surface_type, bool(abs(result.noise_level - 0.01) < 0.002)
    ('CAD', True)
    """
    take_old_switch(properties, "denoise_mesh", "full_output", "the result is always returned")
    surface = as_surface(surface)
    outputs, found = run_once(
        "denoise_mesh",
        Input(surface, fixed=fixed, creases=_find_creases(surface, creases)), properties,
        {"FixedArray": "fixed", "CreaseArray": "creases"}, progress)
    result: MeshDenoisingResult = make_result(MeshDenoisingResult, outputs, found, surface)
    words = settings_of("denoise_mesh")["surface_type"].words
    return replace(result, surface_type=words[int(result.surface_type)])


@_with_settings
def segment(
    surface: SurfaceLike,
    values: ArrayLike | None = None,
    *,
    terms: ArrayLike | None = None,
    on_faces: bool | None = None,
    seeds: ArrayLike | None = None,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    fidelity: ArrayLike | None = None,
    progress: Progress = False,
    **properties: Any,
) -> SegmentationResult:
    """Divide a surface into regions with short boundaries.

    Minimises 1/2 sum_k int abs(grad u_k) + lambda sum_k int w u_k r_k over the probabilities u_k >= 0
    with sum 1 of K regions, the convex models of Chan and Vese (K = 2; Chan, Esedoglu, Nikolova
    2006) and of Potts. The data terms are r_k = abs(f - c_k)^2 with the means c_k, or given.

    Parameters
    ----------
    {surface}
    values : array_like, shape (n,) or (n, k), or (m,) or (m, k), optional
        The data f at points or faces. NaN in any component is missing.
    terms : array_like, shape (n, K) or (m, K), optional
        The data terms r_k in place of `values`. NaN in any component is missing.
    {on_faces}
    seeds : array_like of int, shape (n,) or (m,), optional
        Labels 1 to K that points or faces keep; 0: free. Points between faces of different labels
        are free.
    {mask}
    {roi}
    fidelity : array_like, shape (n,) or (m,), optional
        Factors w >= 0 of the data terms at each point or face, such as 1/s^2 for noise of standard
        deviation s; 0 is missing.
    {progress}

    {settings}

    Returns
    -------
    SegmentationResult
        `values` are the labels. If `means` or `fidelity_weight` are given, `automatic_means` or
        `automatic_fidelity` is off unless it is given, too.

    {problems}

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import segment, sphere
    >>> ball = sphere(5)
    >>> noise = np.random.default_rng(0).normal(scale=0.5, size=ball.n_points)
    >>> result = segment(ball, (ball.points[:, 2] > 0.5) + noise)
    >>> bool(abs(result.areas[1] - np.pi) < 0.05 * np.pi), len(result.boundaries)
    (True, 1)
    """
    surface = as_surface(surface)
    if (values is None) == (terms is None):
        alone = ", for seeds alone terms of 0, one column per region" if seeds is not None else ""
        raise ValueError("values and terms are " + ("both" if values is not None else "not") +
                         f" given; allowed: one of them{alone}")
    name, array = ("values", values) if terms is None else ("terms", terms)
    data, on_faces, integers = take_data("segment", surface, array, on_faces, name)
    given = Input(surface, data, data_on_faces=on_faces, mask=as_mask(mask, roi, surface, properties),
                  fidelity=fidelity, seeds=seeds, data_are_terms=terms is not None, integers=integers)
    return _find("segment", SegmentationResult, given, properties, progress)


@_with_settings
def interpolate(
    surface: SurfaceLike,
    values: ArrayLike,
    points: ArrayLike | None = None,
    *,
    on_faces: bool | None = None,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    directions: ArrayLike | None = None,
    fidelity: ArrayLike | None = None,
    progress: Progress = False,
    **properties: Any,
) -> InterpolationResult:
    """Compute a smooth function on a surface from values at a few points.

    Minimises 1/2 sum_i w_i abs(u(p_i) - d_i)^2 + mu/2 int (kappa^2 u - div(D grad u))^2 over functions
    u on the surface, a thin-plate spline with values d_i at points p_i. Unlike diffusion with held
    values, it converges as the mesh becomes finer.

    Parameters
    ----------
    {surface}
    values : array_like, shape (p,) or (p, k), or (n,) or (n, k), or (m,) or (m, k)
        The values d at `points` or, without them, at the points or faces of the surface. NaN in any
        component is unknown.
    points : array_like, shape (p, 3), optional
        Where the values are: the nearest points of the surface to these. Values far away are left out
        by `maximum_distance`.
    {on_faces}
    {mask}
    {roi}
    {directions}
    fidelity : array_like, one number per value, optional
        The weights w >= 0 of the values, such as 1/s^2 for standard deviations s, with
        ``noise_level=1``; 0 is unknown.
    {progress}

    {settings}

    Returns
    -------
    InterpolationResult
        If `smoothing` is given, `automatic_smoothing` is off unless it is given, too. Connected
        components of the surface without a value are NaN.

    {problems}

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import interpolate, sphere
    >>> ball = sphere(5)
    >>> places = np.random.default_rng(0).normal(size=(60, 3))
    >>> places /= np.linalg.norm(places, axis=1, keepdims=True)
    >>> result = interpolate(ball, places[:, 2] ** 2, places, exact=True)
    >>> bool(abs(result.values - ball.points[:, 2] ** 2).max() < 0.1), result.number_of_values
    (True, 60)
    """
    surface = as_surface(surface)
    refined = properties.pop("_refined", None)
    mask = as_mask(mask, roi, surface, properties)
    if points is None:
        data, on_faces, integers = take_data("interpolate", surface, values, on_faces)
        given = Input(surface, data, data_on_faces=on_faces, mask=mask, directions=directions,
                      fidelity=fidelity, integers=integers, refined=refined)
    else:
        given = Input(surface, mask=mask, directions=directions,
                      samples=as_samples(points, values, fidelity))
    result = _find("interpolate", InterpolationResult, given, properties, progress)
    used = np.array(surface._runs["interpolate"].numbers()["UsedRows"], dtype=np.int64).ravel()
    places = np.asarray(points, dtype=np.float64)[used] if points is not None else used if not on_faces else (
        np.array([surface.points[surface.faces[row]].mean(axis=0) for row in used]))
    shape = (-1,) if np.ndim(values) == 1 else (len(result.values), -1)
    return replace(result, values=result.values.reshape(shape),
                   error=result.error.reshape(shape) if result.error.size else result.error,
                   slope_error=result.slope_error.reshape(shape) if result.slope_error.size else result.slope_error,
                   outliers=result.outliers != 0, _places=(surface, places))


@_with_settings
@_of_data(TextureResult)
def turing_texture(
    surface: SurfaceLike, initial: ArrayLike | None = None, **properties: Any
) -> TextureResult:
    """Grow a texture on a surface by reaction and diffusion.

    Solves du1/dt = D1 Lap u1 + s F(u1, u2), du2/dt = D2 Lap u2 + s G(u1, u2), where Lap is the
    Laplace-Beltrami operator, `kinetics` selects F and G, and s is `reaction_rate`.

    Parameters
    ----------
    {surface}
    initial : array_like, shape (n, 2), optional
        The initial u1 and u2; default: the uniform steady state of the kinetics with noise.
    {mask}
    {roi}
    {directions}
    {fixed}
    rates : array_like, shape (m, 4), optional
        Per face, in place of `diffusion_rate1`, `diffusion_rate_across1`, `diffusion_rate2` and
        `diffusion_rate_across2`.
    {dtype}
    {progress}

    {settings}

    Returns
    -------
    TextureResult
        `values` are u1 and u2, `texture` is one of them stretched to [0, 1], `surface` is that of both.

    {problems}

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import sphere, turing_texture
    >>> result = turing_texture(sphere(4), feature_size=0.6, seed=1)
    >>> result.values.shape, float(result.texture.min()), float(result.texture.max())
    ((2562, 2), 0.0, 1.0)
    """


@_with_settings
def curvature(
    surface: SurfaceLike,
    *,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    progress: Progress = False,
    **properties: Any,
) -> CurvatureResult:
    """Compute the curvature of a surface at a given scale.

    The principal curvatures are the eigenvalues of the derivative of the unit normals in the tangent
    plane. They are positive where the surface bends away from its normals: a sphere of radius R whose
    faces are counter-clockwise from outside has 1/R. Faces with another orientation than their
    neighbours count as turned, so that signs follow the larger part of the area. On surfaces with one
    side, such as a Moebius strip, the mean has no sign, and is positive. Curvatures that the
    rounding of the coordinates may cause, of single precision if all coordinates are such numbers, are 0.

    With ``fwhm=0`` a quadratic polynomial is fitted to the points of at most two edges from each
    point. The error falls with the square of the length of the edges on even meshes, and with the
    length on others and at boundaries; noise of the points is amplified by 1/length^2. With a width,
    the derivative is the slope of the normals over the positions, by linear regression around each
    point, weighted with the Gaussian of this width on the surface. Spheres keep their curvature at
    any scale. At boundaries, both are one-sided.

    Parameters
    ----------
    {surface}
    {left_out}
    {progress}

    {settings}

    Returns
    -------
    CurvatureResult
        With `mean`, `gaussian`, `principal`, `shape_index` and `curvedness` at the points. Given
        areas of the surface are not used.

    {raises}

    Warns
    -----
    SurfaceDiffusionWarning
        For triangles of zero area, for coincident points that are not merged, and for faces that count
        as turned.

    References
    ----------
    S. Petitjean, A survey of methods for recovering quadrics in triangle meshes, ACM Comput. Surv. 34,
    2002. J. Koenderink, A. van Doorn, Surface shape and curvature scales, Image Vis. Comput. 10, 1992.

    Examples
    --------
    >>> from surfacediffusion import curvature, sphere
    >>> found = curvature(sphere(4, radius=2.0), fwhm=0.5)
    >>> round(float(found.mean.mean()), 2), round(float(found.gaussian.mean()), 2)
    (0.5, 0.25)
    >>> found.principal.shape, bool(found.shape_index.min() > 0.99)
    ((2562, 2), True)
    """
    surface = as_surface(surface)
    given = Input(surface, mask=left_out(mask, roi, surface))
    outputs, found = run_once("curvature", given, properties, {"MaskArray": "mask"}, progress)
    result: CurvatureResult = make_result(CurvatureResult, outputs, found, surface)
    return result


@_with_settings
def derivatives(
    surface: SurfaceLike,
    values: ArrayLike,
    *,
    on_faces: bool | None = None,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    progress: Progress = False,
    **properties: Any,
) -> NDArray[np.float64]:
    """Compute derivatives of data in the tangent planes of a surface.

    :func:`gradient`, :func:`divergence`, :func:`curl`, :func:`laplacian`, :func:`conduction_velocity`
    and :func:`helmholtz`, which has all parts, are this function with a `quantity`.

    On a triangle the gradient is that of the linear function; at a point it is the mean of those
    around it, weighted by area, in the tangent plane. The divergence d of vectors v at a point with
    the control area A and the basis function phi is

        A d = - sum over the triangles t of a_t v_t . grad phi + integral over the boundary of phi v . nu

    so that it integrates to the flux across the boundary, up to round-off. For it, vectors at points
    count by their parts across the normals of N. Max (J. Graphics Tools 4(2), 1999), which are those of spheres
    where points lie on one. The curl about the normals is the divergence of v x n, and the Laplacian
    inside that of the gradients on the triangles; at a boundary point it is that of the quadratic
    polynomial that fits the data of the points at most two edges from it, or NaN, with a warning, if
    these are too few. On planes all are exact for linear functions and fields, at the boundary, too. On
    surfaces with one side, such as a Moebius strip, the curl has no sign, and its magnitude is given.

    Parameters
    ----------
    {surface}
    values : array_like, shape (n,), (n, k), (m,) or (m, k)
        Data at points or faces: vectors in space of Divergence and Curl, k being a multiple of 3.
        NaN is missing: the triangles there take no part. Scalars at faces go to the points first, by
        linear functions that fit them around each point; vectors do so if they are smoothed.
    {on_faces}
    {left_out}
    {progress}

    {settings}

    Returns
    -------
    ndarray
        At the points, or with `result_on_faces` at the faces: (n, 3) gradients or velocities, (n, 3 k)
        of k components; (n,) divergences, curls or Laplacians, (n, k) of k vectors or components.
        Points and faces without a triangle that takes part have 0, or NaN if any data are missing.

    {raises}

    Warns
    -----
    SurfaceDiffusionWarning
        For triangles of zero area, for coincident points that are not merged, and for faces that count
        as turned.

    Examples
    --------
    >>> from surfacediffusion import derivatives, sphere
    >>> surface = sphere(5)
    >>> z = surface.points[:, 2]
    >>> laplacian = derivatives(surface, z, quantity="Laplacian")  # -2 z on the unit sphere
    >>> round(float(laplacian @ z / (z @ z)), 2)
    -2.0
    """
    whole = take_old_switch(properties, "derivatives", "full_output",
                            "the array is returned, and the speed by conduction_velocity()")
    surface = as_surface(surface)
    whole = whole or "_outputs" in properties
    name, slope_error = properties.pop("_name", "values"), properties.pop("_slope_error", None)
    if str(properties.get("quantity", "")).lower() in ("divergence", "curl", "helmholtz"):
        shape, n, m = np.shape(as_numbers(name, values)), surface.n_points, surface.n_faces
        require_shape(name, values, len(shape) in (1, 2) and shape[0] in (n, m), (
            f"({n}, 3) or ({n}, 3 k), one row of 1 or k vectors per point, or ({m}, 3) or ({m}, 3 k), one per face"))
    data, on_faces, _ = take_data("derivatives", surface, values, on_faces, name)
    data = data.astype(np.float64) if data.dtype == np.uint8 else data  # no colour, whose alpha is no data
    given = Input(surface, data, data_on_faces=on_faces, mask=left_out(mask, roi, surface))
    if slope_error is not None:
        allowed = (surface.n_points, *np.shape(values)[1:])
        require_shape("error", slope_error, slope_error.shape == allowed,
                      f"{allowed}, one per point and column of {name}")
        given.core.set("slope_errors", np.ascontiguousarray(slope_error, dtype=np.float64))
    words = {**ARRAYS, "InputArray": name, "SlopeErrorArray": "error"}
    outputs, found = run_once("derivatives", given, properties, words, progress)
    result = make_result(DerivativesResult, outputs, {"speed": None, **found}, surface)
    return result if whole else result.values


@_with_settings
def direction_field(
    surface: SurfaceLike,
    hints: ArrayLike | None = None,
    *,
    progress: Progress = False,
    **properties: Any,
) -> NDArray[np.float64]:
    """Compute a line field on a surface: principal curvature, the smoothest field, or from hints.

    Parameters
    ----------
    {surface}
    hints : array_like, shape (n, 3) or (m, 3), optional
        Directions at points or faces for ``method="Hints"``; zero or NaN is no hint. Where there are
        as many points as faces, :func:`on_faces` says which.
    {progress}

    {settings}

    Returns
    -------
    ndarray, shape (m, 3)
        Unit vectors in the faces, whose sign has no meaning; zero in faces without direction.

    {problems}

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import direction_field, sphere
    >>> field = direction_field(sphere(3), method="Smooth")
    >>> field.shape, bool(np.allclose(np.linalg.norm(field, axis=1), 1))
    ((1280, 3), True)
    """
    surface = as_surface(surface)
    method = properties.get("method", settings_of("direction_field")["method"].default)
    if hints is not None and method != "Hints":
        raise ValueError(f'hints is given but method is {method}; allowed: method="Hints", or no hints')
    given = Input(surface, directions=hints, directions_name="hints")
    ((output,), _) = run_once("direction_field", given, properties, {"DirectionArray": "hints"}, progress)
    return place(output.values, on_faces=True)
