# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Random fields on surfaces, and what they share with surrogates of maps and filters by scale."""

from __future__ import annotations

import hashlib
from typing import Any, Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._fans import fans
from ._run import Progress, ProgressReporter, check_parts, part_of, warn
from ._settings import as_integer, as_number, as_switch, convert_all, shorten, spell
from ._surface import (
    Surface, SurfaceLike, as_flags, as_numbers, as_surface, find_mask, find_place, left_out, place, require_shape,
)

__all__ = ["random_field"]

#: The largest number of fields of random_field(); those of surrogates begin above.
STREAM = 1 << 40

#: How many times the smallest range the largest one may be.
_RANGES = 10.0


def random_field(
    surface: SurfaceLike,
    n: int = 1,
    *,
    fwhm: float | None = None,
    range: ArrayLike | None = None,
    nu: float = 1,
    seed: int = 0,
    first: int = 0,
    on_faces: bool = False,
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
    range : float or array_like of shape (n,), above 0, in coordinates
        The range of Matern's correlation, in place of `fwhm`: a number, or one per point, with which
        kappa differs from place to place. The largest one is at most 10 times the smallest.
    nu : float, above 0 and up to 4, default 1
        The smoothness of Matern's correlation: fields have derivatives of orders below nu. With 0.5 it is
        exp(-kappa r).
    seed : int of 64 bits, default 0
        Of the random numbers, which are functions of the seed, the number of the field, and the
        coordinates of the point: the same fields for any numbering of the points. Surfaces with the same
        coordinates, such as both hemispheres' spheres, need different seeds for different fields.
    first : int, 0 or more, default 0
        The number of the first field: fields 10 to 19 are ``random_field(surface, 10, first=10)``, or
        columns of more, bit by bit.
    on_faces : bool, default False
        Whether the fields are at the middles of the faces, the means of their corners: those of the surface
        whose faces are cut into triangles about them.
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
    ndarray, shape (points, n), or (faces, n)
        NaN at points that are left out, and at those without a face that is left; or at faces.

    Notes
    -----
    exp(-t L) is a polynomial of degree 10 in one step of backward Euler, whose factor serves all
    fields, to 2e-5. The standard deviation at every point is that of the discrete field to 4e-4, by
    selected inversion. With nu other than 1 and 3, or with ranges that differ, fields are sums of up to 14
    solves with a factor each, and their covariance is that of the discrete field within 0.5 % of the
    variance. 1,000 fields on 32,492 points take a few seconds, and the memory of the result.

    References
    ----------
    F. Lindgren, H. Rue, J. Lindstrom, An explicit link between Gaussian fields and Gaussian Markov
    random fields, J. R. Statist. Soc. B 73, 2011, 423-498. D. Bolin, K. Kirchner, The rational SPDE approach
    for Gaussian random fields with general smoothness, J. Comput. Graph. Stat. 29, 2020, 274-285. K. Takahashi,
    J. Fagan, M. Chin, Formation of a sparse bus impedance matrix, PICA 1973.

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
    nu = as_number("nu", nu)
    if nu > 4.0:
        raise ValueError(f"nu is {nu:g}; allowed: numbers above 0, up to 4")
    if fwhm is not None and nu != 1:
        raise ValueError(f"nu is {nu:g}; allowed: 1, or range in place of fwhm")
    n = as_count("n", n, 1)
    first = as_count("first", first, 0)
    seed = as_integer("seed", seed, -2**63, 2**63 - 1, "whole numbers of 64 bits")
    normalize = as_switch("normalize", normalize)
    merging = convert_all("random_field", {"merge_coincident_points": merge_coincident_points,
                                           "merge_tolerance": merge_tolerance})
    for problem in _core.find_problems("random_field", merging, None):
        raise ValueError(spell("random_field", problem, {}))
    (name, width), = widths
    on_faces = as_switch("on_faces", on_faces)
    lengths = _as_lengths(name, width, surface)
    outside, drawn = left_out(mask, roi, surface), surface
    if on_faces:
        fan = fans(surface)
        drawn, outside = fan.surface, fan.left_out(outside)
        lengths = np.concatenate([lengths, fan.means(lengths)]) if lengths.ndim else lengths
    fields = make_fields(drawn, outside, *merging.values())
    used = lengths[fields.areas() > 0.0] if lengths.ndim else lengths
    warn_of_edges(name, float(np.min(used)), fields)
    if np.max(used) > _RANGES * np.min(used):
        raise ValueError(f"{name} is from {np.min(used):g} to {np.max(used):g}; allowed: a largest one of at most "
                         f"{_RANGES:g} times the smallest")
    result = np.empty((drawn.n_points, n))
    with surface._lock, ProgressReporter(progress) as reporter:
        draw_fields(fields, lengths, 0.0 if fwhm is not None else nu, seed, first, normalize, result,
                    reporter.callable)
        reporter.finish_part()
    return result[surface.n_points:] if on_faces else result


def _as_lengths(name: str, width: Any, surface: Surface) -> NDArray[np.float64]:
    """The range of each point, or one number for all."""
    if name == "fwhm" or np.ndim(width) == 0:
        return np.array(as_number(name, width))
    lengths = np.array(as_numbers(name, width), dtype=np.float64)
    require_shape(name, lengths, lengths.shape == (surface.n_points,),
                  f"a number, or ({surface.n_points},), one per point")
    bad = ~(np.isfinite(lengths) & (lengths > 0.0))
    if bad.any():
        row = int(np.argmax(bad))
        raise ValueError(f"{name} is {lengths[row]} in row {row}; allowed: finite numbers above 0")
    return lengths


def draw_fields(fields: Any, width: Any, nu: float, seed: int, first: int, normalize: bool,
                result: NDArray[np.float64], progress: Callable[[float], Any] | None, shares: bool = False) -> None:
    """Write fields to the columns of `result`. width: also an array, of Matern's range at each point."""
    half = [part_of(progress, done, 0.5) for done in (0.0, 0.5)]
    prepare_fields(fields, width, nu, normalize, half[0], shares)
    warn_of_solves(fields.draw(seed, first, result, half[1]))


def prepare_fields(fields: Any, width: Any, nu: float, normalize: bool, progress: Callable[[float], Any] | None,
                   shares: bool = False) -> None:
    """Take the covariance of fields."""
    fields.prepare(float(np.min(width)), nu, normalize, progress, shares, width if np.ndim(width) else None)


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
    marked = np.array(flags != 0)
    of_points, masked = (marked, np.array(missing)) if of_faces else (np.array(missing), marked)
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


def as_count(name: str, value: Any, smallest: int) -> int:
    return as_integer(name, value, smallest, STREAM // 2 - 1, f"whole numbers, {smallest} or more, below 2^39")
