# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The smoothness of noise on surfaces, and smoothing up to a given smoothness."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._functions import heat
from ._run import find_result_type, warn
from ._settings import as_number, as_switch
from ._surface import Surface, SurfaceLike, as_data, as_flags, as_surface, data_components, left_out

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


def _fields(surface: Surface) -> Any:
    """The mesh of the whole surface, which the surface keeps."""
    fields = surface._runs.get("widths")
    if fields is None:
        fields = surface._runs["widths"] = _core.SurfaceFields(surface._core, None, False, False, 0.0, None)
    if not fields.number_of_vertices():
        raise ValueError("surface has no triangle of positive area; allowed: one or more")
    return fields


def _estimate(
    surface: SurfaceLike, residuals: ArrayLike, mask: Any, roi: Any, demean: bool
) -> tuple[FWHMEstimate, NDArray[np.float64]]:
    """The estimate, and for each column the largest width that it may have; 0 if it is constant."""
    surface = as_surface(surface)
    maps = as_data("residuals", residuals, surface.n_points)
    masked = as_flags("mask", left_out(mask, roi, surface, faces=False), surface.n_points)
    with surface._lock:
        fields = _fields(surface)
        widths = _core.NoiseWidth(fields, as_switch("demean", demean))
        for first in range(0, maps.shape[1], _PANEL):
            panel = np.array(maps[:, first : first + _PANEL], dtype=np.float64, order="C")
            if masked is not None:
                panel[masked != 0] = np.nan
            widths.add(fields, panel)
    unit = fields.length_unit()
    largest = unit * np.array(widths.largest_of_columns())
    if np.isnan(largest).any():
        raise ValueError(f"residuals has no known value in column {int(np.argmax(np.isnan(largest)))}; "
                         "allowed: finite values at some points of the surface")
    return FWHMEstimate(unit * widths.of_all(), unit * np.array(widths.of_columns())), largest


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

    found = measure(noise)
    if not found < fwhm:
        raise ValueError(f"fwhm is {fwhm:g}, but the noise has a smoothness of {found:.4g} already; "
                         "allowed: larger widths")
    fields = _fields(surface)
    area = float(fields.areas().sum()) * fields.length_unit() ** 2
    correction = _core.WidthCorrection(fwhm, found, area)
    for _ in range(40):
        width = correction.width()
        reached = measure(smooth(noise, width))
        if abs(reached / fwhm - 1.0) <= tolerance:
            return smooth(values, width, dtype=dtype)
        if not correction.take(reached):
            break
    raise ValueError(f"fwhm is {fwhm:g}, but smoothing reaches {correction.largest_reached():.4g}; allowed: "
                     "widths of several edges that are small against the surface")
