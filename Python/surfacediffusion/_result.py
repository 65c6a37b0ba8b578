# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The results of runs."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ._surface import Surface


__all__ = [
    "ArrayResult", "ConductionVelocity", "CurvatureResult", "DerivativesResult", "DiffusionResult",
    "EdgeResult", "HarmonicMapResult", "HelmholtzParts", "InterpolationResult", "LeaveOneOut",
    "MeshDenoisingResult", "ModelResult", "RegionBoundary", "Result", "SegmentationResult",
    "TensorDiffusionResult", "TextureResult",
]


#: Of the normal distribution: so many deviations on each side hold 90 %.
BAND_90 = 1.6448536269514722


class ArrayResult:
    """A result of more than one array. It stands for its main array, which ``numpy.asarray(result)`` is:
    functions of numpy take it, and it has the array's `shape`, `dtype`, length and elements."""

    #: The attribute that is the main array.
    MAIN: ClassVar[str] = "values"
    #: The outputs that `values` are the columns of; none: the result of the data.
    VALUES: ClassVar[tuple[str, ...]] = ()

    def __array__(self, dtype: Any = None, copy: Any = None) -> NDArray[Any]:
        main: NDArray[Any] = getattr(self, self.MAIN)
        array = main if dtype is None else main.astype(dtype, copy=False)
        return array.copy() if copy else array

    def __array_function__(self, function: Any, types: Any, arguments: Any, keywords: Any) -> Any:
        # Some functions of numpy would call a method of their name, and a result may have an array
        # with it, such as `mean`.
        def stand_for(given: Any) -> Any:
            if isinstance(given, (list, tuple)) and not hasattr(given, "_fields"):
                return type(given)(map(stand_for, given))
            return np.asarray(given) if isinstance(given, ArrayResult) else given

        return function(*map(stand_for, arguments),
                        **{name: stand_for(given) for name, given in keywords.items()})

    @property
    def shape(self) -> tuple[int, ...]:
        """That of the main array."""
        return self.__array__().shape

    @property
    def dtype(self) -> np.dtype[Any]:
        """That of the main array."""
        return self.__array__().dtype

    def __len__(self) -> int:
        return len(self.__array__())

    def __getitem__(self, key: Any) -> Any:
        return self.__array__()[key]


@dataclass(frozen=True)
class ModelResult(ArrayResult):
    """The result of a model. ``numpy.asarray(result)`` is `values`.

    Attributes
    ----------
    values : ndarray
        The result at the points, or at the faces if the data are on faces and `result_on_faces` is
        on, with as many dimensions as the input.
    warnings : list of str
        Everything that was also given as a Python warning.
    mean_edge_length : float
        h, in coordinate units.
    value_range : float
        R, in array units.
    number_of_unused_points : int
        The points that no triangle uses and that keep their values, without those that the mask
        excludes.
    number_of_iterations : int
        The iterations of all solves together; 0 for direct solvers.
    """

    values: NDArray[Any]
    warnings: list[str] = field(repr=False)
    mean_edge_length: float = field(repr=False)
    value_range: float = field(repr=False)
    number_of_unused_points: int = field(repr=False)
    number_of_iterations: int = field(repr=False)


@dataclass(frozen=True)
class Result(ModelResult):
    """A state of a run in time steps: a :class:`ModelResult` with

    Attributes
    ----------
    step : int
        The number of time steps done.
    time : float
        The time of the state, in the unit of `time_step`.
    times : ndarray, shape (step + 1,)
        The time of each step, the initial state first.
    history : dict of ndarray, shape (step + 1,)
        One column per name: ``"Time"``; ``"Total_0"``, ... (the integral of each component over the
        surface, sum of A_i u_i, in coordinate and array units); ``"Energy"``; ``"Iterations"``,
        ``"Residual"`` and ``"Seconds"`` of each step; for textures ``"Clamped"``; for minimisers of
        total variation ``"ErrorBound"``, a bound of the RMS error of the values.
    time_unit : float
        The unit of times in coordinate and array units; 1 if times are absolute.
    """

    step: int
    time: float
    history: dict[str, NDArray[Any]] = field(repr=False)
    time_unit: float = field(repr=False)

    @property
    def times(self) -> NDArray[np.float64]:
        """The time of each step."""
        return self.history["Time"]

    @property
    def residual(self) -> float:
        """The largest relative residual of a solve."""
        return float(self.history["Residual"].max())


@dataclass(frozen=True)
class DiffusionResult(Result):
    """A state of :func:`heat` or :func:`intrinsic_tv`: a :class:`Result` with

    Attributes
    ----------
    effective_fidelity_weight : float
        The lambda of the run, found if ``automatic_fidelity=True``, in the unit of
        `fidelity_weight`.
    coherence : ndarray
        With a `period` of :func:`heat` the lengths of the unit vectors that stand for the data, after
        diffusion: 1 where they agree, 0 where they cancel. No row otherwise.
    """

    effective_fidelity_weight: float = 0.0
    coherence: NDArray[np.float64] = field(default_factory=lambda: np.empty(0), repr=False)


@dataclass(frozen=True)
class TensorDiffusionResult(Result):
    """A state of :func:`tensor_diffusion`: a :class:`Result` with

    Attributes
    ----------
    axes : ndarray, shape (m, 3)
        With ``diffusion_axes=True`` the direction of the strongest diffusion in each face, a unit
        vector whose sign has no meaning, or zero where diffusion is isotropic. No row otherwise.
    """

    axes: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 3)), repr=False)


@dataclass(frozen=True)
class HarmonicMapResult(Result):
    """A state of :func:`harmonic_map`: a :class:`Result` whose `values` are unit vectors, with

    Attributes
    ----------
    points : ndarray, shape (n, 3)
        The points; moved if ``move_vertices=True``.
    mean_displacement : float
    maximum_displacement : float
        Of the moved points, in coordinate units.
    volume_before : float
    volume_after : float
        The enclosed volumes, in coordinate units; of no meaning for open surfaces.
    """

    points: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 3)), repr=False)
    mean_displacement: float = 0.0
    maximum_displacement: float = 0.0
    volume_before: float = field(default=0.0, repr=False)
    volume_after: float = field(default=0.0, repr=False)


@dataclass(frozen=True)
class CurvatureResult(ArrayResult):
    """The result of :func:`curvature`. ``numpy.asarray(result)`` is `mean`.

    Attributes
    ----------
    mean : ndarray, shape (n,)
        H, half the sum of the principal curvatures, in 1 / (unit of the coordinates). Positive where
        the surface bends away from its normals. Like the others 0 at points without a face.
    gaussian : ndarray, shape (n,)
        K, the product of the principal curvatures.
    principal : ndarray, shape (n, 2)
        The larger and the smaller principal curvature.
    shape_index : ndarray, shape (n,)
        2/pi atan((k1 + k2)/(k1 - k2)): 1 on caps, 1/2 on ridges, 0 on saddles and planes, -1/2 in
        ruts, -1 in cups.
    curvedness : ndarray, shape (n,)
        sqrt((k1^2 + k2^2)/2).
    mean_edge_length : float
        h, in coordinate units.
    warnings : list of str
        Everything that was also given as a Python warning.
    """

    MAIN: ClassVar[str] = "mean"

    mean: NDArray[np.float64] = field(repr=False)
    gaussian: NDArray[np.float64] = field(repr=False)
    principal: NDArray[np.float64] = field(repr=False)
    shape_index: NDArray[np.float64] = field(repr=False)
    curvedness: NDArray[np.float64] = field(repr=False)
    mean_edge_length: float
    warnings: list[str] = field(repr=False)


@dataclass(frozen=True)
class DerivativesResult(ArrayResult):
    """The derivatives of PyVista meshes, and of :func:`derivatives` with the old switch
    ``full_output=True``. ``numpy.asarray(result)`` is `values`.

    Attributes
    ----------
    values : ndarray
        What :func:`derivatives` returns.
    speed : ndarray, shape (n,) or (n, k), or None
        The lengths of the conduction velocities, in the unit of the coordinates per unit of time.
    mean_edge_length : float
        h, in coordinate units.
    warnings : list of str
        Everything that was also given as a Python warning.
    """

    values: NDArray[np.float64] = field(repr=False)
    speed: NDArray[np.float64] | None = field(repr=False)
    mean_edge_length: float
    warnings: list[str] = field(repr=False)


class HelmholtzParts(NamedTuple):
    """Vectors on a surface as the sum of a gradient, a curl and a part that is neither."""

    gradient_potential: NDArray[np.float64]  #: phi, (n,), in the unit of the vectors times that of the coordinates
    curl_potential: NDArray[np.float64]  #: psi, (n,)
    gradient_part: NDArray[np.float64]  #: grad(phi), (n, 3)
    curl_part: NDArray[np.float64]  #: n x grad(psi), (n, 3)
    harmonic_part: NDArray[np.float64]  #: the rest, (n, 3)


class _Velocity(NamedTuple):
    velocity: NDArray[np.float64]
    speed: NDArray[np.float64]


class ConductionVelocity(_Velocity):
    """The velocity of a wave on a surface, and its length, the speed: a pair."""

    velocity: NDArray[np.float64]  #: (n, 3), in the tangent planes
    speed: NDArray[np.float64]  #: (n,)
    direction: NDArray[np.float64]  #: (n, 3), the unit vector of the velocity; 0 where this is 0
    collision: NDArray[np.bool_]  #: (n,), where fronts meet, and the direction turns within an edge
    focus: NDArray[np.bool_]  #: (n,), where fronts begin, likewise
    #: (n,), a band that holds 90 % of speeds, with `error`. NaN at collisions and foci; the upper bound is
    #: infinite where the times may be constant.
    speed_lower: NDArray[np.float64] | None = None
    speed_upper: NDArray[np.float64] | None = None


@dataclass(frozen=True)
class MeshDenoisingResult(ArrayResult):
    """The result of :func:`denoise_mesh`. ``numpy.asarray(result)`` is `points`.

    Attributes
    ----------
    points : ndarray, shape (n, 3)
        The denoised points.
    noise_level : float
        The standard deviation of the noise along the normal, given or estimated, in coordinate
        units; the root mean square over the points if connected components differ.
    correlation_length : float
        The length over which the noise was correlated, as that of depth cameras is, in coordinate
        units. 0 if no correlated noise was found.
    surface_type : str
        The kind of surface, given or found: "CAD" or "Organic". "Automatic" if no noise was found, or
        if connected components are of different kinds.
    mean_displacement : float
    maximum_displacement : float
        Of the points, in coordinate units.
    volume_before : float
    volume_after : float
        The enclosed volumes, in coordinate units, signed by the orientation; 0 for surfaces that
        are not closed or not consistently oriented.
    mean_edge_length : float
        h of the given surface, in coordinate units.
    warnings : list of str
        Everything that was also given as a Python warning.
    """

    MAIN: ClassVar[str] = "points"

    points: NDArray[np.float64] = field(repr=False)
    noise_level: float
    correlation_length: float
    surface_type: str
    mean_displacement: float
    maximum_displacement: float
    volume_before: float = field(repr=False)
    volume_after: float = field(repr=False)
    mean_edge_length: float = field(repr=False)
    warnings: list[str] = field(repr=False)


@dataclass(frozen=True)
class EdgeResult(Result):
    """A state of :func:`mumford_shah`: a :class:`Result` whose `values` are smooth between edges,
    with

    Attributes
    ----------
    edges : ndarray, shape (n,)
        1 - v: 1 on edges, 0 far from them.
    curves : list of ndarray, shape (k, 3)
        The edges, one array of points per edge between its ends and junctions, along the ridge of
        `edges`. A closed curve repeats its first point.
    effective_edge_threshold : float
    effective_smoothing_length : float
        Those of the run, given or found by ``automatic_threshold=True``, in the units of
        `edge_threshold` and `smoothing_length`, on the connected component with the most points.
    estimated_noise_level : float
        The standard deviation of the noise that `automatic_threshold` used; 0 without it.
    """

    edges: NDArray[Any] = field(default_factory=lambda: np.empty(0), repr=False)
    curves: list[NDArray[np.float64]] = field(default_factory=list, repr=False)
    effective_edge_threshold: float = 0.0
    effective_smoothing_length: float = 0.0
    estimated_noise_level: float = 0.0

    @property
    def edge_length(self) -> float:
        """The length of all curves, in coordinate units."""
        steps = [np.diff(curve, axis=0) for curve in self.curves]
        return float(sum(np.linalg.norm(step, axis=1).sum() for step in steps))


@dataclass(frozen=True)
class TextureResult(Result):
    """A state of :func:`turing_texture`: a :class:`Result` whose `values` (n, 2) are the
    concentrations u1 and u2, with

    Attributes
    ----------
    texture : ndarray, shape (n,)
        The concentration of `texture_chemical`, stretched to [0, 1] between its 1st and 99th
        percentile.
    colors : ndarray of uint8, shape (n, 3), or None
        The texture between `low_color` and `high_color`, if ``color_output=True``.
    wavelength : float
        The fastest-growing wavelength of the kinetics, in coordinate units; 0 if none grows.
    wavelength_growth_rate : float
        The growth rate of that wavelength.
    diffusion_rate_factor : float
        The factor by which `feature_size` has scaled the diffusion rates.
    coarse_start_vertices : int
        The vertices of the coarser mesh on which the pattern grew, see `coarse_start_size`; 0 if it
        grew on the surface.
    surface : Surface
        The surface that the values belong to: the given one, or one with shorter edges, see `refine_to`.
    """

    VALUES: ClassVar[tuple[str, ...]] = ("u1", "u2")

    texture: NDArray[Any] = field(default_factory=lambda: np.empty(0), repr=False)
    colors: NDArray[np.uint8] | None = field(default=None, repr=False)
    wavelength: float = 0.0
    wavelength_growth_rate: float = field(default=0.0, repr=False)
    diffusion_rate_factor: float = field(default=1.0, repr=False)
    coarse_start_vertices: int = field(default=0, repr=False)
    surface: Surface | None = field(default=None, repr=False)


@dataclass(frozen=True)
class RegionBoundary:
    """A curve between two regions.

    Attributes
    ----------
    regions : tuple of int
        The two labels, ascending.
    points : ndarray, shape (p, 3)
        The curve as a polyline that cuts triangles; a closed one ends where it starts.
    length : float
    """

    regions: tuple[int, int]
    points: NDArray[np.float64] = field(repr=False)
    length: float


class LeaveOneOut(NamedTuple):
    """What a result without each of the given values says of it."""

    residuals: NDArray[np.float64]  #: the value minus that result
    errors: NDArray[np.float64]  #: the standard errors of these


@dataclass(frozen=True)
class InterpolationResult(ModelResult):
    """The result of :func:`interpolate`: a :class:`ModelResult` whose `values` are those of the smooth
    function at the points, with

    Attributes
    ----------
    error : ndarray
        With ``compute_error=True`` the standard error of each of the values. No row otherwise.
    slope_error : ndarray
        Likewise, but not with ``exact=True``, that of the derivative of `values` in a direction, in their
        unit over that of the coordinates: :func:`conduction_velocity` takes it.
    smoothing : ndarray, shape (k,)
        mu of each component, found or given, in the unit of `smoothing`; 0 if the values hold. Of
        several connected parts, each of which has its own, that of the part with the most values.
    score : ndarray, shape (k,)
        Of generalised cross-validation.
    misfit : ndarray, shape (k,)
        The root of the weighted mean square of the differences from the given values.
    degrees_of_freedom : ndarray, shape (k,)
        The trace of the matrix that takes the given values to the fitted ones.
    noise_level : ndarray, shape (k,)
        The standard deviation of values with weight 1, given or estimated; of several connected parts
        the root of its mean square.
    lower, upper : ndarray
        With ``compute_error=True`` the band of 1.645 standard errors around the values, which holds 90 %.
    outliers : ndarray of bool, with a row per given value
        With ``robust=True``: True for values that the others contradict, and that were left out.
    residuals : ndarray, likewise
        With ``robust=True`` or ``leave_one_out=True`` the given values minus the result there; NaN where
        no value counts.
    leave_one_out : LeaveOneOut
        With ``leave_one_out=True`` the pair of the residuals of the results without each value, at the same
        mu, and of their standard errors, NaN for outliers.
    distance_to_data : ndarray, shape (n,)
        The distance of each point along the surface from the nearest value that was used, see
        :func:`distance`; found when it is asked for.
    number_of_values : int
        The values that were used.
    number_of_far_values : int
        Those that were left out, farther from the surface than `maximum_distance`.
    median_distance, largest_distance : float
        Of the points with values from the surface, in the unit of the coordinates.
    """

    error: NDArray[np.float64] = field(default_factory=lambda: np.empty(0), repr=False)
    slope_error: NDArray[np.float64] = field(default_factory=lambda: np.empty(0), repr=False)
    smoothing: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    score: NDArray[np.float64] = field(default_factory=lambda: np.empty(0), repr=False)
    misfit: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    degrees_of_freedom: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    noise_level: NDArray[np.float64] = field(default_factory=lambda: np.empty(0), repr=False)
    outliers: NDArray[np.bool_] = field(default_factory=lambda: np.empty(0, dtype=bool), repr=False)
    residuals: NDArray[np.float64] = field(default_factory=lambda: np.empty(0), repr=False)
    leave_one_out: LeaveOneOut = field(
        default_factory=lambda: LeaveOneOut(np.empty(0), np.empty(0)), repr=False)
    number_of_values: int = 0
    number_of_far_values: int = 0
    median_distance: float = 0.0
    largest_distance: float = 0.0
    _places: Any = field(default=None, repr=False)  # the surface and the places of the values

    @functools.cached_property
    def distance_to_data(self) -> NDArray[np.float64]:
        from ._distance import distance

        return distance(*self._places)

    @property
    def lower(self) -> NDArray[np.float64]:
        return self.values - BAND_90 * self.error

    @property
    def upper(self) -> NDArray[np.float64]:
        return self.values + BAND_90 * self.error


@dataclass(frozen=True)
class SegmentationResult(ModelResult):
    """The result of :func:`segment`: a :class:`ModelResult` whose `values` (n,) are the labels 1 to K
    of the points, 0 at points that take no part, with

    Attributes
    ----------
    probabilities : ndarray, shape (n, K)
        u of the relaxed problem.
    means : ndarray, shape (K, k)
        The means c of the regions, given or found; shape (K, 0) with given data terms. NaN for
        regions that are not used, since there are fewer different values.
    areas : ndarray, shape (K,)
    boundary_lengths : ndarray, shape (K,)
        Of the regions within `boundaries`.
    components : ndarray of int, shape (K,)
        The number of connected components of each region.
    boundaries : list of RegionBoundary
        The curves on which the two largest of the probabilities are equal.
    gap : float
        The certified relative duality gap of the probabilities.
    label_gap : float
        That of the labels as functions on the mesh, whose boundaries are too long by a tenth.
    number_of_alternations : int
        The number of minimisations; more than 1 if the means were found.
    effective_fidelity_weight : float
        The lambda of the run, found if ``automatic_fidelity=True``, in the unit of
        `fidelity_weight`.
    """

    VALUES: ClassVar[tuple[str, ...]] = ("RegionId",)

    probabilities: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 0)), repr=False)
    means: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 0)))
    areas: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    boundary_lengths: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    components: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    boundaries: list[RegionBoundary] = field(default_factory=list, repr=False)
    gap: float = 0.0
    label_gap: float = field(default=0.0, repr=False)
    number_of_alternations: int = field(default=0, repr=False)
    effective_fidelity_weight: float = 0.0
