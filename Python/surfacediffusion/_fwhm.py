# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The smoothness of noise on surfaces, and smoothing up to a given smoothness."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._functions import heat
from ._run import find_result_type, warn
from ._settings import as_number, as_switch
from ._surface import Surface, SurfaceLike, as_data, as_flags, as_surface, data_components, left_out

#: exp(-d^2 / (4 sigma^2)) = exp(-d^2 * _RATE / FWHM^2), since FWHM^2 = 8 ln 2 sigma^2.
_RATE = 2.0 * np.log(2.0)

#: The square of the FWHM that takes half of the variance with the mean, over the area: 4 pi sigma^2 is
#: half of the area.
_HALF = np.log(2.0) / np.pi

#: Edges with equal shares of the weight have one length in the solve.
_BINS = 256

#: Columns that are handled together: the memory does not grow with their number.
_PANEL = 16


class FWHMEstimate(NamedTuple):
    """The smoothness of noise maps, as the full width at half maximum of a Gaussian kernel."""

    pooled: float  #: of all columns together, in coordinate units
    columns: NDArray[np.float64]  #: (k,), of each column alone, in coordinate units


def estimate_fwhm(
    surface: SurfaceLike,
    residuals: ArrayLike,
    *,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    demean: bool = True,
) -> FWHMEstimate:
    """Estimate the smoothness of noise: the FWHM of the Gaussian kernel that white noise has to be
    smoothed with to have the same correlation between neighbours.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface.
    residuals : array_like, shape (n,) or (n, k)
        Noise maps without signal, such as the residuals of a regression. NaN is missing.
    mask : array_like, shape (n,), optional
        Nonzero leaves a point out.
    roi : array_like, shape (n,), optional
        The region of interest, in place of `mask`: zero and NaN leave a point out.
    demean : bool, default True
        Whether the mean over the surface is first subtracted from each column. The part of the
        variance that is expected to go with it is taken into account.

    Returns
    -------
    FWHMEstimate
        `pooled` and `columns`, in the unit of the coordinates. 0 for maps without correlation
        between neighbours, inf for constant maps, and for those that are as smooth as the surface is
        large, with a warning: the equation below has no solution, which is at most half the root of
        the area.

    Notes
    -----
    For white noise after a Gaussian kernel of standard deviation sigma the correlation at distance d
    is rho(d) = exp(-d^2 / (4 sigma^2)). sigma is the solution of the moment equation

        sum_e w_e (s_i s_j - rho(d_e) (s_i^2 + s_j^2) / 2) = 0

    over the edges e = ij, of length d_e and weight w_e, the area of the triangles of the edge over
    d_e^2. If the mean is subtracted, which takes the part q = 4 pi sigma^2 / area of the variance,
    rho - q and 1 - q stand in place of rho and 1.

    For edges of one length d this is the estimator of Forman et al. (1995),
    FWHM = d sqrt(-2 ln 2 / ln(1 - V(ds) / (2 V(s)))), to whose family AFNI's SurfFWHM and Workbench's
    -metric-estimate-fwhm belong, too. Here each edge has its own length, and a variance that differs
    from place to place does not matter. As with any estimator of this kind, the width of noise whose
    correlation is not Gaussian is that of its shortest distances. Noise on vertices alone has a
    width of half an edge.

    References
    ----------
    S. D. Forman et al., Improved assessment of significant activation in functional magnetic
    resonance imaging (fMRI), Magnetic Resonance in Medicine 33, 1995, 636-647.
    D. J. Hagler Jr., A. P. Saygin, M. I. Sereno, Smoothing and cluster thresholding for cortical
    surface-based group analysis of fMRI data, NeuroImage 33, 2006, 1093-1103.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import estimate_fwhm, heat, sphere
    >>> surface = sphere(5, radius=100.0)
    >>> noise = np.random.default_rng(0).normal(size=(surface.n_points, 10))
    >>> estimate = estimate_fwhm(surface, heat(surface, noise, fwhm=20.0))
    >>> bool(abs(estimate.pooled / 20 - 1) < 0.03), estimate.columns.shape
    (True, (10,))
    """
    estimate, widest = _estimate(surface, residuals, mask, roi, demean)
    wide = [str(k) for k in np.flatnonzero(np.isinf(estimate.columns) & (widest > 0))]
    if wide:
        warn([f"residuals is as smooth as the surface is large in column{'s' if len(wide) > 1 else ''} "
              f"{', '.join(wide)}: its width is above {widest[int(wide[0])]:.4g}, and inf (take a larger "
              "surface, or maps of less smooth noise)"])
    return estimate


def _estimate(
    surface: SurfaceLike, residuals: ArrayLike, mask: Any, roi: Any, demean: bool
) -> tuple[FWHMEstimate, NDArray[np.float64]]:
    """The estimate, and for each column the largest width that it may have; 0 if it is constant."""
    surface = as_surface(surface)
    maps = as_data("residuals", residuals, surface.n_points)
    masked = as_flags("mask", left_out(mask, roi, surface, faces=False), surface.n_points)
    demean = as_switch("demean", demean)
    edges = _Edges(surface)
    products = np.zeros(maps.shape[1])  # of neighbours, per variance
    variances = np.zeros((maps.shape[1], len(edges.squares)))  # shares of the bins of edges
    areas = np.zeros(maps.shape[1])  # of the known part
    for first in range(0, maps.shape[1], _PANEL):
        panel = np.array(maps[:, first : first + _PANEL], dtype=np.float64)
        if masked is not None:
            panel[masked != 0] = np.nan
        known = np.isfinite(panel) & (edges.areas > 0)[:, None]
        for k in range(panel.shape[1]):
            s, chosen = panel[:, k], known[:, k]
            if not chosen.any():
                raise ValueError(f"residuals has no known value in column {first + k}; allowed: "
                                 "finite values at some points of the surface")
            areas[first + k] = edges.areas[chosen].sum()
            if demean:
                s = s - np.average(s[chosen], weights=edges.areas[chosen])
            scale = np.abs(s[chosen]).max()  # squares neither overflow nor vanish
            s = np.where(chosen, s / scale if scale > 0 else 0.0, 0.0)
            both = chosen[edges.ends[0]] & chosen[edges.ends[1]]
            a, b = s[edges.ends[0]], s[edges.ends[1]]
            weights = np.where(both, edges.weights, 0.0)
            local = 0.5 * weights * (a * a + b * b)
            total = local.sum()
            if total > 0:
                products[first + k] = (weights * a * b).sum() / total
                variances[first + k] = np.bincount(
                    edges.bins, local / total, minlength=len(edges.squares))
    if not demean:
        areas[:] = np.inf
    columns = np.array([_solve(p, v, edges.squares, a) for p, v, a in zip(products, variances, areas)])
    varying = variances.sum(axis=1) > 0  # constant columns say nothing of the others
    widest = np.where(varying, np.sqrt(_HALF * areas), 0.0)
    if not varying.any():
        return FWHMEstimate(float("inf"), columns), widest
    pooled = _solve(products[varying].mean(), variances[varying].mean(axis=0), edges.squares,
                    areas[varying].mean())
    return FWHMEstimate(pooled, columns), widest


class _Edges:
    """The edges of a surface, with weights and with their squared lengths in bins."""

    def __init__(self, surface: Surface) -> None:
        triangles, points = surface.triangles, surface.points
        area, self.areas = surface._areas_of_triangles(), surface._triangle_areas()
        ends = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        unique, inverse = np.unique(
            ends[:, 0].astype(np.int64) * surface.n_points + ends[:, 1], return_inverse=True)
        self.ends = np.divmod(unique, surface.n_points)
        squares = ((points[self.ends[0]] - points[self.ends[1]]) ** 2).sum(axis=1)
        if surface.areas is not None:  # lengths grow as the roots of areas
            factors = np.divide(surface.areas, self.areas, out=np.ones_like(self.areas),
                                where=self.areas > 0)
            squares *= 0.5 * (factors[self.ends[0]] + factors[self.ends[1]])
            area = area * factors[triangles].mean(axis=1)
            self.areas = self.areas * factors
        areas = np.bincount(inverse.ravel(), np.repeat(area, 3), len(unique))
        kept = (squares > 0) & (areas > 0)
        self.ends = (self.ends[0][kept], self.ends[1][kept])
        squares, areas = squares[kept], areas[kept]
        if squares.size == 0:
            raise ValueError("surface has no triangle of positive area; allowed: one or more")
        self.weights = areas / squares
        order = np.argsort(squares)
        share = np.cumsum(areas[order]) / areas.sum()
        self.bins = np.empty(len(order), dtype=np.int64)
        self.bins[order] = np.minimum(_BINS - 1, (share * _BINS).astype(np.int64))
        total = np.bincount(self.bins, self.weights, _BINS)
        mean = np.bincount(self.bins, self.weights * squares, _BINS)
        self.squares = np.divide(mean, total, out=np.zeros(_BINS), where=total > 0)


def _solve(
    product: float, variances: NDArray[np.float64], squares: NDArray[np.float64], area: float
) -> float:
    """The FWHM of noise whose neighbours have the correlation `product`. variances: the shares of
    edges with these squared lengths, which sum to 1."""
    if not variances.sum() > 0 or product >= 1.0:
        return float("inf")
    if product <= 0.0:
        return 0.0
    if not np.isfinite(area):
        return _invert(product, variances, squares)

    def excess(widths: NDArray[np.float64]) -> NDArray[np.float64]:
        expected = np.exp(-_RATE * squares / widths[:, None] ** 2) @ variances
        taken = 0.5 * widths**2 / (_HALF * area)  # the part of the variance that goes with the mean
        rising: NDArray[np.float64] = (expected - taken) / (1.0 - taken) - product
        return rising

    # It rises with the width until the mean takes half of the variance, or less on coarse surfaces.
    widths = np.sqrt(_HALF * area) * np.geomspace(1e-6, 1.0, 512)
    above = np.flatnonzero(excess(widths) > 0.0)
    if above.size == 0:
        return float("inf")
    low, high = float(widths[above[0] - 1]) if above[0] else 0.0, float(widths[above[0]])
    while low < 0.5 * (low + high) < high:
        middle = 0.5 * (low + high)
        if excess(np.array([middle]))[0] > 0.0:
            high = middle
        else:
            low = middle
    return high


def _invert(
    correlation: float, variances: NDArray[np.float64], squares: NDArray[np.float64]
) -> float:
    """The FWHM for which sum variances exp(-squares x) = correlation, with x = 2 ln 2 / FWHM^2."""
    x = 0.0
    for _ in range(100):  # Newton from the left of a convex, decreasing function: monotone
        terms = variances * np.exp(-squares * x)
        step = (terms.sum() - correlation) / (terms @ squares)
        x += step
        if step <= 1e-13 * x:
            break
    return float(np.sqrt(_RATE / x)) if x > 0 else float("inf")


def smooth_to_fwhm(
    surface: SurfaceLike,
    values: ArrayLike,
    fwhm: float,
    *,
    residuals: ArrayLike | None = None,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    demean: bool = True,
    tolerance: float = 0.005,
    dtype: Any = None,
) -> NDArray[Any]:
    """Smooth data until their noise has the given smoothness, so that data of different smoothness
    become alike.

    The noise is `residuals`; by default that of a series of columns is the series minus its mean
    over the columns, and that of a single column is the column itself. Its smoothness F0 is
    estimated as by :func:`estimate_fwhm`, pooled over columns. The data are smoothed by
    sqrt(fwhm^2 - F0^2), which is then corrected until the smoothness of the noise, smoothed alike,
    is `fwhm` to the tolerance (as AFNI's SurfSmooth does with -target_fwhm, by repetition).

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface.
    values : array_like, shape (n,) or (n, k)
        The data. NaN is missing.
    fwhm : float
        The wanted smoothness, in the unit of the coordinates, above that of the noise.
    residuals : array_like, shape (n,) or (n, j), optional
        The noise of the data.
    mask : array_like, shape (n,), optional
        Nonzero is outside the region of interest: not smoothed, and nothing flows across.
    roi : array_like, shape (n,), optional
        The region of interest, in place of `mask`: nonzero is inside.
    demean : bool, default True
        As for :func:`estimate_fwhm`.
    tolerance : float, from 1e-4 to 0.1, default 0.005
        The relative error of the smoothness.
    dtype : float32 or float64, optional
        As for :func:`heat`.

    Returns
    -------
    ndarray of the shape of `values`

    Raises
    ------
    ValueError
        If the noise is as smooth as wanted already, or after smoothing does not reach `fwhm`.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import estimate_fwhm, heat, smooth_to_fwhm, sphere
    >>> surface = sphere(5, radius=100.0)
    >>> noise = np.random.default_rng(0).normal(size=(surface.n_points, 10))
    >>> correlated = heat(surface, noise, fwhm=12.0)
    >>> smooth = smooth_to_fwhm(surface, correlated, 20.0)
    >>> noise = smooth - smooth.mean(axis=1, keepdims=True)
    >>> bool(abs(estimate_fwhm(surface, noise).pooled / 20 - 1) < 0.01)
    True
    """
    surface = as_surface(surface)
    as_number("fwhm", fwhm)
    as_number("tolerance", tolerance, "0.0001 to 0.1", lambda number: 1e-4 <= number <= 0.1)
    data = as_data("values", values, surface.n_points)
    mask = left_out(mask, roi, surface, faces=False)
    find_result_type(data, dtype)
    if residuals is None:
        noise = np.asarray(data, dtype=np.float64)
        if data_components(data) > 1:
            noise = noise - noise.mean(axis=1, keepdims=True)
    else:
        noise = np.asarray(as_data("residuals", residuals, surface.n_points), dtype=np.float64)

    def measure(maps: NDArray[Any]) -> float:
        return _estimate(surface, maps, mask, None, demean)[0].pooled

    def smooth(maps: Any, width: float, **keywords: Any) -> NDArray[Any]:
        # The time of heat's own `fwhm`, whose warnings would name a width that no caller has given.
        result: NDArray[Any] = heat(surface, maps, time_step=width * width / (16.0 * np.log(2.0)),
                                    units="Absolute", mask=mask, mask_mode="Exclude",
                                    time_integrator="Exponential", mass_matrix="Mixed",
                                    number_of_time_steps=1, **keywords)
        return result

    area = float(_Edges(surface).areas.sum())
    found = measure(noise)
    if not found < fwhm:
        raise ValueError(f"fwhm is {fwhm:g}, but the noise has a smoothness of {found:.4g} already; "
                         "allowed: larger widths")
    # Squares of widths add up: the correction is a secant step on squares.
    width = np.sqrt(fwhm**2 - found**2)
    before = (0.0, found**2)
    largest = found**2
    low, high = 0.0, np.inf  # squares of widths that reach less and more
    for _ in range(40):
        reached = measure(smooth(noise, width)) ** 2
        if abs(np.sqrt(reached) / fwhm - 1.0) <= tolerance:
            return smooth(values, width, dtype=dtype)
        low, high = (low, width**2) if reached > fwhm**2 else (width**2, high)
        step = fwhm**2 - reached
        if np.isfinite(reached):  # else the surface is smaller than the kernel
            largest = max(largest, reached)
            slope = (reached - before[1]) / (width**2 - before[0])
            step = step / slope if slope > 0.1 else step
            before = (width**2, reached)
        square = min(max(width**2 + step, 0.01 * width**2), 100.0 * width**2)
        square = square if low < square < high else 0.5 * (low + high)
        if not (low < square < high) or high - low < 1e-9 * low or square > 4.0 * _HALF * area:
            break
        width = np.sqrt(square)
    raise ValueError(f"fwhm is {fwhm:g}, but smoothing reaches {np.sqrt(largest):.4g}; allowed: "
                     "widths of several edges that are small against the surface")
