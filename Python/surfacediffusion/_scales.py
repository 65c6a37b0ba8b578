# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Filters of data by scale, and the variance between scales."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._fields import (
    areas_of, check_finite, filter_scales, find_bands, leave_out_missing, make_fields, warn_of_edges,
    warn_of_solves,
)
from ._run import Progress, ProgressReporter
from ._settings import as_integer, as_number, shorten
from ._surface import (
    Surface, SurfaceLike, as_data, as_numbers, as_surface, find_on_faces, left_out, require_shape,
)

__all__ = ["Spectrum", "scale_filter", "spectrum"]


def scale_filter(
    surface: SurfaceLike,
    values: ArrayLike,
    wavelength: ArrayLike,
    *,
    order: int = 1,
    on_faces: bool | None = None,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    progress: Progress = None,
) -> NDArray[np.float64]:
    """Filter data by scale: u with

        (1 + 2 (-Laplace / k^2)^order) u = values,  k = 2 pi / wavelength,

    which leaves a third of a wave of this length, nearly all of much longer ones, and little of shorter
    ones: of those of half the length 1/9 with order 1, and 1/33 with order 2.

    Constants and the integral over each connected part of the surface stay, and nothing flows across
    boundaries and parts that are left out. With the matrices M of :func:`mass_matrix` and K of
    :func:`stiffness_matrix` the operator is M + 2 K / k^2 for order 1, one step of backward Euler of
    2 / k^2. Order 2 is the real part of such a step of sqrt(2) i / k^2, by conjugate gradients to 1e-10; where
    these need many iterations, for wavelengths of more than some 50 edges and on needles, a polynomial of
    degree 26 in a step of sqrt(2) / k^2, exact to 2e-10.

    Data at faces go to the points and back, with their integral, and what points do not resolve of them is
    filtered by fluxes between faces. For smooth data this is of second order in the length of edges.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface.
    values : array_like, shape (n,) or (n, k), or (m,) or (m, k)
        Data at points, or at faces. Those with NaN are left out, as land is in the ocean. Columns with NaN at
        the same places, such as the months of a depth, share a matrix and its factor.
    wavelength : float or array_like of shape (n,), above 0, in coordinates
        The wavelength, of which 1/3 is left: a number, or one per point, with which -Laplace / k^2
        becomes -div(k^-2 grad). Below two edges the mesh does not resolve it, and a warning says so.
    order : {1, 2}, default 1
        The sharpness of the filter.
    on_faces : bool, optional
        Whether `values` are at faces. Default: whether there are as many as faces, and not as points.
    mask : array_like, shape (n,) or (m,), optional
        Nonzero leaves a point with its faces, or a face, out.
    roi : array_like, shape (n,) or (m,), optional
        The region of interest, the opposite of a mask and in place of one.
    progress : bool or callable, optional
        As for :func:`heat`.

    Returns
    -------
    ndarray of float64, the shape of values
        NaN at points that are left out, and at those without a face that is left; or at faces.

    References
    ----------
    K. Nowak, S. Danilov, V. Mueller, C. Liu, Implementation of implicit filters for spatial spectra
    extraction, Geosci. Model Dev. 18, 2025, 6541-6560.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import scale_filter, sphere
    >>> surface = sphere(5)
    >>> z = surface.points[:, 2]  # -Laplace z = 2 z
    >>> u = scale_filter(surface, z, wavelength=2 * np.pi)  # k = 1: z / 5
    >>> bool(abs(5 * u - z).max() < 1e-3)
    True
    """
    surface = as_surface(surface)
    of_faces = find_on_faces("values", values, surface, on_faces)
    data, result = _as_data(values, surface, of_faces)
    if isinstance(wavelength, (bool, np.bool_)):
        raise ValueError(f"wavelength is {wavelength}; allowed: finite numbers above 0")
    lengths = np.asarray(as_numbers("wavelength", wavelength), dtype=np.float64)
    require_shape("wavelength", lengths, lengths.shape in ((), (surface.n_points,)),
                  f"a number, or ({surface.n_points},), one per point")
    order = as_integer("order", order, 1, 2, "1 and 2")
    outside, groups = left_out(mask, roi, surface), _columns_by_missing(data)
    warned = False
    with ProgressReporter(progress, len(groups)) as reporter:
        for columns in groups:
            part = np.ascontiguousarray(data[:, columns])
            if np.isnan(part).all() and len(groups) > 1:
                result[:, columns] = np.nan  # such as the sea at a depth that it does not have
            else:
                fields = make_fields(surface, leave_out_missing(surface, outside, part, of_faces))
                known = _check_lengths(wavelength, lengths, fields, not warned)
                warned = True
                part[areas_of(fields, of_faces) == 0.0] = 0.0
                with surface._lock:
                    warn_of_solves(filter_scales(fields, of_faces, part, known, order, reporter.callable))
                result[:, columns] = part
            reporter.finish_part()
    return result.reshape(np.shape(values))


def _columns_by_missing(data: NDArray[np.float64]) -> list[NDArray[np.int64]]:
    """The columns that are missing at the same places."""
    missing = np.packbits(np.isnan(data), axis=0)
    _, group = np.unique(missing, axis=1, return_inverse=True)
    group = group.reshape(-1)
    return [np.flatnonzero(group == k) for k in np.arange(group.max() + 1)]


def _check_lengths(wavelength: ArrayLike, given: NDArray[np.float64], fields: Any, warns: bool) -> NDArray[np.float64]:
    """The wavelength of each point; 1 where no triangle takes part."""
    known = fields.areas() > 0.0
    lengths = np.array(np.broadcast_to(given, known.shape))
    bad = known & ~(np.isfinite(lengths) & (lengths > 0.0))
    if bad.any():
        row = int(np.argmax(bad))
        at = "" if np.ndim(wavelength) == 0 else f" in row {row}"
        raise ValueError(f"wavelength is {lengths[row]}{at}; allowed: finite numbers above 0")
    if warns:
        warn_of_edges("wavelength", float(lengths[known].min()), fields)
    lengths[~known] = 1.0
    return lengths


class Spectrum(NamedTuple):
    """The variance of data between successive wavelengths, by filters of :func:`scale_filter`."""

    wavelength: NDArray[np.float64]  #: (k,), ascending, in coordinates
    #: (k + 1,) or (k + 1, columns): below the first wavelength, between each and the next, above the last
    variance: NDArray[np.float64]


def spectrum(
    surface: SurfaceLike,
    values: ArrayLike,
    wavelengths: ArrayLike,
    *,
    order: int = 2,
    on_faces: bool | None = None,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    progress: Progress = None,
) -> Spectrum:
    """The variance of data between scales: what the filter of :func:`scale_filter` takes away of the
    variance by area as its wavelength grows from each of `wavelengths` to the next. The sum is the
    variance of the data.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface.
    values : array_like, shape (n,) or (n, k), or (m,) or (m, k)
        Data at points or at faces, from which the mean by area is subtracted. Those with NaN are left out.
    wavelengths : array_like, shape (k,), above 0 and ascending, in coordinates
        The bounds between the scales.
    order : {1, 2}, default 2
        The order of the filter, as for :func:`scale_filter`: 2 separates the scales better.
    on_faces, mask, roi, progress
        As for :func:`scale_filter`.

    Returns
    -------
    Spectrum
        `wavelength` (k,) and `variance` (k + 1,), or (k + 1, columns) for data with columns, in the unit
        of the data squared. Divided by the differences of the wave numbers 2 pi / wavelength, they are
        a spectral density.

    Examples
    --------
    >>> from surfacediffusion import random_field, spectrum, sphere
    >>> surface = sphere(5, radius=100.0)
    >>> field = random_field(surface, 1, fwhm=20.0)[:, 0]
    >>> found = spectrum(surface, field, [20.0, 40.0, 80.0, 160.0])
    >>> found.variance.shape, bool(abs(found.variance.sum() / field.var() - 1) < 0.02)
    ((5,), True)
    """
    surface = as_surface(surface)
    of_faces = find_on_faces("values", values, surface, on_faces)
    data, _ = _as_data(values, surface, of_faces)
    lengths = np.asarray(as_numbers("wavelengths", wavelengths), dtype=np.float64)
    if lengths.ndim != 1 or lengths.size == 0 or not (np.diff(lengths) > 0.0).all():
        raise ValueError(f"wavelengths is {shorten(wavelengths)}; allowed: one or more ascending numbers")
    for length in lengths:
        as_number("wavelengths", float(length))
    order = as_integer("order", order, 1, 2, "1 and 2")
    fields = make_fields(surface, leave_out_missing(surface, left_out(mask, roi, surface), data, of_faces))
    warn_of_edges("wavelengths", float(lengths[0]), fields)
    with surface._lock, ProgressReporter(progress) as reporter:
        bands = find_bands(fields, areas_of(fields, of_faces), data, lengths.tolist(), order,
                           reporter.callable, of_faces)
        reporter.finish_part()
    return Spectrum(lengths, bands if np.ndim(values) == 2 else bands[:, 0])


def _as_data(
    values: Any, surface: Surface, of_faces: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The data in double precision, with a row per point or face, and a copy to be changed."""
    rows, what = (surface.n_faces, "face") if of_faces else (surface.n_points, "point")
    data = np.asarray(as_data("values", values, rows, what), dtype=np.float64)
    check_finite("values", data)
    return data, np.array(data)
