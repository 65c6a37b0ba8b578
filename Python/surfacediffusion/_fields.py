# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Random fields on surfaces, and surrogates of maps: random maps with the values and the smoothness of
a given one."""

from __future__ import annotations

import hashlib
import math
from statistics import NormalDist
from typing import Any, Callable, NamedTuple, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._run import Progress, ProgressReporter, check_parts, part_of, warn
from ._settings import as_integer, as_number, as_switch, convert_all, shorten, spell
from ._surface import (
    Surface, SurfaceLike, as_data, as_flags, as_surface, find_mask, find_place, left_out, place, require_shape,
)

__all__ = ["Surrogates", "random_field", "surrogates"]

#: Fields with which the variances of scales are measured: the most, drawn at once, and the least.
_SAMPLE, _FEWEST = 64, 8

#: Independent parts in all fields of a width, from which on fewer fields will do: variances within 5 %.
_PARTS = 1024

#: Numbers in maps that are filtered together: 64 MB.
_LARGEST = 1 << 23

#: The numbers of the fields of one width of surrogates begin at a multiple of this, above those of
#: random_field(), and those of the sample halfway to the next multiple.
_STREAM = 1 << 40


def random_field(
    surface: SurfaceLike,
    n: int = 1,
    *,
    fwhm: float | None = None,
    range: float | None = None,
    nu: int = 1,
    seed: int = 0,
    first: int = 0,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    normalize: bool = True,
    merge_coincident_points: bool = False,
    merge_tolerance: float = 0.0,
    progress: Progress = None,
) -> NDArray[np.float64]:
    """Draw Gaussian random fields on a surface, of mean 0 and variance 1.

    With the matrices M of :func:`mass_matrix` and K of :func:`stiffness_matrix`, L = M^-1 K, and white
    noise W, independent at the points with variances 1 / A_i of their control areas, they are

        exp(-t L) W,  t = fwhm^2 / (16 ln 2), or
        (kappa^2 + L)^(-(nu + 1) / 2) W,  kappa = sqrt(8 nu) / range,

    divided by their standard deviations. On the plane the correlation at distance r is
    exp(-2 ln 2 r^2 / fwhm^2), as after a Gaussian kernel of this width, or Matern's
    (kappa r)^nu K_nu(kappa r) / (2^(nu - 1) Gamma(nu)), which is 0.14 at the range.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface. A Surface keeps the factors for further fields of the same kind.
    n : int, 1 or more, default 1
        The number of fields.
    fwhm : float, above 0, in coordinates
        Full width at half maximum of the kernel. One of `fwhm` and `range` is given. Below two edges the
        mesh does not resolve it, and a warning says so.
    range : float, above 0, in coordinates
        The range of Matern's correlation, in place of `fwhm`.
    nu : {1, 3}, default 1
        The smoothness of Matern's correlation: fields have nu - 1 derivatives.
    seed : int of 64 bits, default 0
        Of the random numbers, which are functions of the seed, the number of the field, and the
        coordinates of the point: the same fields for any numbering of the points. Surfaces with the same
        coordinates, such as both hemispheres' spheres, need different seeds for different fields.
    first : int, 0 or more, default 0
        The number of the first field: fields 10 to 19 are ``random_field(surface, 10, first=10)``, or
        columns of more, bit by bit.
    mask : array_like, shape (n,) or (m,), optional
        Nonzero leaves a point with its faces, or a face, out.
    roi : array_like, shape (n,) or (m,), optional
        The region of interest, the opposite of a mask and in place of one.
    normalize : bool, default True
        Whether the variance is 1 at every point. Otherwise fields are divided by the standard
        deviation on the plane, and have more variance near the boundary of the surface (twice as much
        on a straight one), and where the surface is small beside the correlation.
    merge_coincident_points : bool, default False
        Whether points within `merge_tolerance`, default 0, of each other are one point of the surface.
    progress : bool or callable, optional
        As for :func:`heat`.

    Returns
    -------
    ndarray, shape (points, n)
        NaN at points that are left out, and at those without a face that is left.

    Notes
    -----
    exp(-t L) is a polynomial of degree 10 in one step of backward Euler, whose factor serves all
    fields, to 2e-5. The standard deviation at every point is that of the discrete field to 4e-4, by
    selected inversion. 1,000 fields on 32,492 points take a few seconds, and the memory of the result.

    References
    ----------
    F. Lindgren, H. Rue, J. Lindstrom, An explicit link between Gaussian fields and Gaussian Markov
    random fields, J. R. Statist. Soc. B 73, 2011, 423-498. K. Takahashi, J. Fagan, M. Chin, Formation
    of a sparse bus impedance matrix, PICA 1973.

    Examples
    --------
    >>> from surfacediffusion import estimate_fwhm, random_field, sphere
    >>> surface = sphere(5, radius=100.0)
    >>> fields = random_field(surface, 20, fwhm=20.0)
    >>> bool(abs(fields.std() - 1) < 0.03)
    True
    >>> bool(abs(estimate_fwhm(surface, fields).pooled / 20 - 1) < 0.03)
    True
    """
    surface = as_surface(surface)
    widths = [(name, width) for name, width in (("fwhm", fwhm), ("range", range)) if width is not None]
    if len(widths) != 1:
        found = "both given" if widths else "not given"
        raise ValueError(f"fwhm and range are {found}; allowed: one of them")
    (name, width), = widths
    width = as_number(name, width)
    if isinstance(nu, bool) or not isinstance(nu, (int, np.integer)) or nu not in (1, 3):
        raise ValueError(f"nu is {shorten(nu)}; allowed: 1 and 3")
    if fwhm is not None and nu != 1:
        raise ValueError(f"nu is {shorten(nu)}; allowed: 1, or range in place of fwhm")
    n = _as_count("n", n, 1)
    first = _as_count("first", first, 0)
    seed = as_integer("seed", seed, -2**63, 2**63 - 1, "whole numbers of 64 bits")
    normalize = as_switch("normalize", normalize)
    merging = convert_all("random_field", {"merge_coincident_points": merge_coincident_points,
                                           "merge_tolerance": merge_tolerance})
    for problem in _core.find_problems("random_field", merging, None):
        raise ValueError(spell("random_field", problem, {}))
    fields = make_fields(surface, left_out(mask, roi, surface), *merging.values())
    warn_of_edges(name, width, fields)
    result = np.empty((surface.n_points, n))
    with surface._lock, ProgressReporter(progress) as reporter:
        _draw(fields, width, 0 if fwhm is not None else int(nu), seed, first, normalize, result,
              reporter.callable)
        reporter.finish_part()
    return result


class Surrogates(NamedTuple):
    """Surrogates of a map, and the model of its smoothness."""

    values: NDArray[np.float64]  #: (points, n), one surrogate per column
    fwhm: NDArray[np.float64]  #: (k,), the widths of the model, in coordinates; 0: without correlation
    variances: NDArray[np.float64]  #: (k,), the share of each width in the variance of the normal scores


def surrogates(
    surface: SurfaceLike,
    values: ArrayLike,
    n: int = 1000,
    *,
    seed: int = 0,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    progress: Progress = None,
) -> Surrogates:
    """Draw surrogates of a map: random maps that have its values, each as often, and its smoothness, but
    nothing else in common with it. The correlations of another map with them are the distribution
    without a relation, which neighbours that are alike make wider than that of independent values.

    The normal scores of the map are taken as a sum of random fields of widths 2 h, 4 h, ... up to
    three times the root of the area, and of values without correlation. The variances of these are
    found such that, on average, the sum has the variances of the map between scales, as
    :func:`spectrum` measures them, by nonnegative least squares. A surrogate is such a sum, whose
    values are replaced by those of the map by their ranks.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface, or one hemisphere of a brain.
    values : array_like, shape (n,)
        The map, at points. NaN, such as in the medial wall, is left out, and is NaN in the surrogates.
    n : int, 1 or more, default 1000
        The number of surrogates.
    seed : int, default 0
        Of the random numbers. Surrogates of different maps that enter one test need different seeds.
    mask : array_like, shape (n,) or (m,), optional
        Nonzero leaves a point with its faces, or a face, out.
    roi : array_like, shape (n,) or (m,), optional
        The region of interest, the opposite of a mask and in place of one.
    progress : bool or callable, optional
        As for :func:`heat`.

    Returns
    -------
    Surrogates
        `values` (points, n), and the model: `fwhm` (k,) and `variances` (k,). Points without a face that
        is left, of points with known values, are NaN, too, and their values are not in the surrogates.

    Notes
    -----
    In simulations with 1,000 pairs of independent maps on a sphere (Gaussian of FWHM 0.6 of the radius,
    Matern's with range 0.8, a mixture of two widths with noise), tests at 5 % by 99 surrogates have found
    5.8, 5.7 and 6.5 % of the pairs to be related, and those with the true model 5.1, 4.8 and 6.0 %. Maps that
    are as smooth as the surface is large have few independent parts, and no model can be found well: on a
    cap of a sphere whose root of the area is 2 radii, 9 to 10 % at FWHM 1 and 1.6 of the radius.

    The surface stays as it is and no matrix of distances is made: time and memory grow with the number
    of points.

    References
    ----------
    J. Burt, M. Helmer, M. Shinn, A. Anticevic, J. Murray, Generative modeling of brain maps with
    spatial autocorrelation, NeuroImage 220, 2020, where maps are compared by variograms.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import random_field, sphere, surrogates
    >>> surface = sphere(4, radius=100.0)
    >>> x, y = random_field(surface, 2, fwhm=60.0).T
    >>> null = surrogates(surface, x, 199).values
    >>> found = abs(np.corrcoef(x, y)[0, 1])
    >>> smaller = [abs(np.corrcoef(s, y)[0, 1]) < found for s in null.T]
    >>> bool(1 - np.mean(smaller) > 0.05)  # not significant
    True
    >>> bool((np.sort(null[:, 0]) == np.sort(x)).all())
    True
    """
    surface = as_surface(surface)
    array = as_data("values", values, surface.n_points)
    require_shape("values", values, array.shape[1] == 1, f"({surface.n_points},), one map")
    given = array[:, 0].astype(np.float64)
    check_finite("values", given)
    if np.isnan(given).all():
        raise ValueError("values has no known value: it is NaN everywhere; allowed: maps with known values")
    n = _as_count("n", n, 1)
    seed = as_integer("seed", seed, -2**63, 2**63 - 1, "whole numbers of 64 bits")
    fields = make_fields(surface, leave_out_missing(surface, left_out(mask, roi, surface), given))
    areas = fields.areas()
    known = areas > 0.0
    if len(np.unique(given[known])) < 2:
        raise ValueError("values is constant; allowed: values that differ")
    model = _Model(fields, areas, seed)
    with surface._lock, ProgressReporter(progress, 2 * len(model.widths)) as reporter:
        variances = model.fit(_normal_scores(given, known), reporter)
        result = model.draw(variances, n, reporter)
    ordered = np.sort(given[known])
    rows = np.flatnonzero(known)
    for k in np.arange(n):
        result[rows[np.argsort(result[rows, k], kind="stable")], k] = ordered
    result[~known] = np.nan
    shares = variances * model.totals
    return Surrogates(result, np.array(model.widths), shares / shares.sum())


class _Model:
    """Sums of random fields of several widths, the last of which has no correlation."""

    def __init__(self, fields: Any, areas: NDArray[np.float64], seed: int) -> None:
        self._fields, self._areas, self._seed = fields, areas, seed
        h = fields.mean_edge_length()
        size = math.sqrt(areas.sum()) * fields.length_unit()
        self.widths = [2.0 * h]
        while 2.0 * self.widths[-1] < 3.0 * size:  # the trends of maps that are smoother than the surface
            self.widths.append(2.0 * self.widths[-1])
        self._wavelengths = [3.0 * h]
        while self._wavelengths[-1] < size:
            self._wavelengths.append(2.0 * self._wavelengths[-1])
        parts = [(size / width) ** 2 for width in self.widths]
        self._samples = [int(min(_SAMPLE, max(_FEWEST, _PARTS / count))) for count in parts] + [_FEWEST]
        self.widths.append(0.0)
        self.totals = np.ones(len(self.widths))

    def fit(self, scores: NDArray[np.float64], reporter: ProgressReporter) -> NDArray[np.float64]:
        """The variances of the fields."""
        found, maps = [], [scores[:, None]]
        for k in np.arange(len(self.widths)):
            maps.append(self._draw(k, _STREAM // 2, np.empty((len(self._areas), self._samples[k])),
                                   reporter.callable))
            # Maps of several widths share the factors of the filters, as memory allows.
            if k + 1 == len(self.widths) or sum(m.size for m in maps) > _LARGEST:
                found.append(self._bands(np.hstack(maps)))
                maps = []
            reporter.finish_part()
        self._fields.end_sharing()
        variances = np.hstack(found)
        wanted = variances[:, 0]
        # Errors count relative to the root of the variance of their band.
        weights = 1.0 / np.sqrt(np.maximum(wanted, 1e-6 * wanted.sum()))
        parts = np.split(variances[:, 1:], np.cumsum(self._samples)[:-1], axis=1)
        bands = np.column_stack([part.mean(axis=1) for part in parts])
        self.totals = bands.sum(axis=0)  # of fields of variance 1, without their mean
        return solve_nonnegative(bands * weights[:, None], wanted * weights)

    def draw(
        self, variances: NDArray[np.float64], n: int, reporter: ProgressReporter
    ) -> NDArray[np.float64]:
        """Sums of n fields of each width, of which those with a variance are needed."""
        total = np.zeros((len(self._areas), n))
        for k in np.arange(len(self.widths)):
            for first in np.arange(0, n if variances[k] > 0.0 else 0, _SAMPLE):
                part = np.empty((len(self._areas), min(_SAMPLE, n - int(first))))
                share = part_of(reporter.callable, first / n, part.shape[1] / n)
                total[:, first:first + part.shape[1]] += math.sqrt(variances[k]) * self._draw(
                    k, int(first), part, share)
            reporter.finish_part()
        return total

    def _draw(
        self, k: int, first: int, result: NDArray[np.float64], progress: Callable[[float], Any] | None
    ) -> NDArray[np.float64]:
        _draw(self._fields, self.widths[k], 0, self._seed, (int(k) + 1) * _STREAM + first, True, result, progress,
              shares=True)
        return result

    def _bands(self, maps: NDArray[np.float64]) -> NDArray[np.float64]:
        """The variances between the wavelengths, (bands, columns)."""
        return find_bands(self._fields, self._areas, maps, self._wavelengths, 1, None)


def _draw(fields: Any, width: float, nu: int, seed: int, first: int, normalize: bool,
          result: NDArray[np.float64], progress: Callable[[float], Any] | None, shares: bool = False) -> None:
    """Write fields to the columns of `result`."""
    half = [part_of(progress, done, 0.5) for done in (0.0, 0.5)]
    fields.prepare(width, nu, normalize, half[0], shares)
    warn_of_solves(fields.draw(seed, first, result, half[1]))


def _normal_scores(given: NDArray[np.float64], known: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The quantiles of the normal distribution of the ranks, equal ones for equal values; 0 at points
    that are not known."""
    _, inverse, counts = np.unique(given[known], return_inverse=True, return_counts=True)
    ends = np.cumsum(counts)
    shares = (ends - 0.5 * counts) / ends[-1]
    quantile = NormalDist().inv_cdf
    scores = np.zeros(len(given))
    scores[known] = np.array([quantile(share) for share in shares])[inverse.reshape(-1)]
    return scores


def solve_nonnegative(matrix: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """x >= 0 with the smallest |matrix x - b| (C. Lawson, R. Hanson, Solving least squares problems,
    1974, chapter 23). At least one x is above 0 for nonnegative, nonzero entries."""
    n = matrix.shape[1]
    x = np.zeros(n)
    free = np.zeros(n, dtype=bool)
    scale = np.abs(matrix).sum(axis=0).max() * np.abs(b).max()
    for _ in np.arange(10 * n):
        slope = np.where(free, 0.0, matrix.T @ (b - matrix @ x))
        if slope.max() <= 1e-12 * scale:
            break
        free[np.argmax(slope)] = True
        while True:
            solved = np.zeros(n)
            solved[free] = np.linalg.lstsq(matrix[:, free], b, rcond=None)[0]
            below = free & (solved <= 0.0)
            if not below.any():
                break
            step = (x[below] / (x[below] - solved[below])).min()
            x += step * (solved - x)
            free &= x > 1e-14 * x.max()
            x[~free] = 0.0
        x = solved
    return x


def make_fields(surface: Surface, mask: Any, merges: bool = False, tolerance: float = 0.0) -> Any:
    """The operators of random fields and scales, which a surface keeps for the last mask."""
    flags, on_faces = find_mask(mask, (surface.n_points, surface.n_faces))
    marks = b"" if flags is None else bytes([on_faces]) + flags.tobytes()
    version = hashlib.blake2b(marks).digest(), merges, tolerance
    with surface._lock:
        known, fields = surface._runs.get("fields", (None, None))
        if version != known:
            fields = _core.SurfaceFields(surface._core, flags, on_faces, merges, tolerance, None)
            surface._runs["fields"] = version, fields
    check_parts(fields)
    return fields


def leave_out_missing(
    surface: Surface, mask: Any, values: NDArray[np.float64], of_faces: bool = False
) -> Any:
    """The mask that leaves out points, or faces, with NaN in any column, too."""
    missing = np.isnan(values) if values.ndim == 1 else np.isnan(values).any(axis=1)
    if not missing.any():
        return mask
    flags = as_flags("mask", mask)
    if flags is None:
        return place(missing, of_faces)
    sizes = (surface.n_points, surface.n_faces)
    masks_faces = find_place("mask", mask, sizes, "flag", False)
    if masks_faces == of_faces:
        return place(missing | (flags != 0), of_faces)
    faces = np.repeat(np.arange(surface.n_faces), np.diff(surface._offsets))
    of_points, masked = (flags != 0, missing) if of_faces else (missing, flags != 0)
    masked[faces[of_points[surface._connectivity]]] = True
    return place(masked, True)


def areas_of(fields: Any, of_faces: bool) -> NDArray[np.float64]:
    """The areas of points or faces; 0 for those that take no part."""
    areas: NDArray[np.float64] = fields.face_areas() if of_faces else fields.areas()
    return areas


def filter_scales(fields: Any, of_faces: bool, *arguments: Any) -> float:
    """Filter the data of points or faces in place; the largest residual above the tolerance."""
    filter_them = fields.filter_scales_of_faces if of_faces else fields.filter_scales
    missed: float = filter_them(*arguments)
    return missed


def find_bands(
    fields: Any, areas: NDArray[np.float64], maps: NDArray[np.float64],
    wavelengths: Sequence[float], order: int, progress: Callable[[float], Any] | None,
    of_faces: bool = False,
) -> NDArray[np.float64]:
    """The variance of each column between successive wavelengths: (wavelengths + 1, columns). areas: of
    points, or of faces."""
    known = areas > 0.0
    centred = np.where(known[:, None], maps, 0.0)
    centred -= (areas @ centred) / areas.sum()
    kept = [areas @ centred**2 / areas.sum()]
    for number, wavelength in enumerate(wavelengths):
        filtered = centred.copy()
        share = part_of(progress, number / len(wavelengths), 1.0 / len(wavelengths))
        lengths = np.full(len(fields.areas()), float(wavelength))
        warn_of_solves(filter_scales(fields, of_faces, filtered, lengths, order, share))
        filtered[~known] = 0.0
        kept.append(areas @ filtered**2 / areas.sum())
    return np.array([*(kept[k] - kept[k + 1] for k in np.arange(len(wavelengths))), kept[-1]])


def check_finite(name: str, values: NDArray[np.float64]) -> None:
    if np.isinf(values).any():
        row = int(np.argmax(np.isinf(values).reshape(len(values), -1).any(axis=1)))
        raise ValueError(f"{name} is infinite in row {row}; allowed: finite values and NaN")


def warn_of_edges(name: str, length: float, fields: Any) -> None:
    """Below two edges the mesh decides. Beyond a million, or a millionth, nothing is left of one."""
    h = fields.mean_edge_length()
    if not 1e-6 * h <= length <= 1e6 * h:
        raise ValueError(f"{name} is {length:g}; allowed: {1e-6 * h:g} to {1e6 * h:g}, a millionth to a "
                         "million of the mean length of edges")
    if length < 2.0 * h:
        warn([spell("random_field", _core.say("Unresolved", name, length, h), {})])


def warn_of_solves(residual: float) -> None:
    if residual > 0.0:
        warn([spell("random_field", _core.say("Missed", residual), {})])


def _as_count(name: str, value: Any, smallest: int) -> int:
    return as_integer(name, value, smallest, _STREAM // 2 - 1, f"whole numbers, {smallest} or more, below 2^39")
