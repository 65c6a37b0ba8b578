# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Values that go from the vertices of one sphere to those of another."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._operators import import_sparse
from ._run import Progress, ProgressReporter, warn
from ._settings import as_switch, shorten
from ._surface import (
    Surface, SurfaceLike, as_numbers, as_surface, check_areas, find_mask, left_out, require_shape,
)

__all__ = ["Resampler", "resample"]

_METHODS = ("Barycentric", "AdaptiveBarycentricArea")

#: The radii of a sphere in a file differ by round-off of single precision, those of other surfaces by much more.
_SPHERE = 0.01


class Resampler:
    """The weights by which values at the points of a sphere become values at the points of another one.

    They are found once, for any number of calls with the values. See :func:`resample`.

    Parameters
    ----------
    source, target : Surface or tuple (points, faces)
        Two spheres about the origin, in register: a place on the brain has the same direction from the
        origin on both. Their radii may differ.
    method : {"AdaptiveBarycentricArea", "Barycentric"}, or in snake_case
        AdaptiveBarycentricArea, Workbench's ADAP_BARY_AREA: each value of the source is used, however
        coarse the target is, with the area of its point. Barycentric: the linear interpolation in the
        triangle of the source that a point of the target lies in. A coarse target misses values between
        its points.
    source_areas, target_areas : array_like, shapes (n,) and (p,), above 0, optional
        The areas of the points on the brain, such as ``Surface(midthickness).vertex_areas``, or the mean
        of those of all subjects for group data. By default `vertex_areas` of `source` and `target`.
        Multiples of them give the same weights. Not used by Barycentric.
    mask : array_like, shape (n,) or (m,), optional
        Nonzero leaves a point of the source, or a face and the points that only such faces have, out.
    roi : array_like, shape (n,) or (m,), optional
        The region of interest, the opposite of a mask and in place of one: zero and NaN are left out.
    progress : bool or callable, optional
        As for :func:`heat`.

    Examples
    --------
    >>> from surfacediffusion import Resampler, sphere
    >>> fine, coarse = sphere(5), sphere(3, radius=100.0)
    >>> to_coarse = Resampler(fine, coarse)
    >>> to_coarse
    <Resampler: AdaptiveBarycentricArea, 10242 points to 642 points>
    >>> z = to_coarse(fine.points[:, 2])
    >>> bool(abs(z - coarse.points[:, 2] / 100.0).max() < 0.01)
    True
    """

    def __init__(
        self,
        source: SurfaceLike,
        target: SurfaceLike,
        method: str = "AdaptiveBarycentricArea",
        source_areas: ArrayLike | None = None,
        target_areas: ArrayLike | None = None,
        mask: ArrayLike | None = None,
        *,
        roi: ArrayLike | None = None,
        progress: Progress = None,
    ) -> None:
        source, target = as_surface(source), as_surface(target)
        self.method = _as_method(method)
        is_adaptive = self.method == "AdaptiveBarycentricArea"
        areas = [_find_areas(name, surface, given) for name, surface, given in (
            ("source", source, source_areas), ("target", target, target_areas))]
        flags = _find_left_out(source, mask, roi)
        without = np.count_nonzero(areas[1] == 0.0)
        if without and is_adaptive:
            warn([f"target has {without} points without a face of some area, which have no value; method "
                  "Barycentric has one"])
        self._shape = target.n_points, source.n_points
        with ProgressReporter(progress) as reporter:
            self._csr = _core.resampling_weights(
                is_adaptive, source._core, areas[0], target._core, areas[1], flags, reporter.callable)
            reporter.finish_part()

    def __repr__(self) -> str:
        return f"<Resampler: {self.method}, {self._shape[1]} points to {self._shape[0]} points>"

    @property
    def weights(self) -> Any:
        """The weights, scipy.sparse.csr_array of shape (p, n): rows sum to 1, or are empty where no point of
        the source is left. ImportError if scipy is not installed."""
        return import_sparse("Resampler.weights").csr_array(self._csr, shape=self._shape, copy=True)

    def __call__(self, values: ArrayLike, *, labels: bool | None = None) -> NDArray[Any]:
        """The values at the target: see :func:`resample`.

        Parameters
        ----------
        values : array_like, shape (n,) or (n, k)
        labels : bool, optional

        Returns
        -------
        ndarray, shape (p,) or (p, k)
        """
        array = as_numbers("values", values)
        n = self._shape[1]
        require_shape("values", array, array.ndim in (1, 2) and len(array) == n and array.size > 0,
                      f"({n},) or ({n}, k), one row per point of the source")
        if np.isinf(array).any():
            row = int(np.argmax(np.isinf(array.reshape(n, -1)).any(axis=1)))
            raise ValueError(f"values is infinite in row {row}; allowed: finite values, or NaN for missing")
        are_labels = np.asarray(np.ma.getdata(values)).dtype.kind in "biu"  # masked ones are NaN in `array`
        if labels is not None:
            are_labels = as_switch("labels", labels, "True, False or None")
        keeps_single = array.dtype == np.float32 and not are_labels
        columns = np.ascontiguousarray(array.reshape(n, -1), dtype=np.float32 if keeps_single else np.float64)
        found = np.empty((self._shape[0], columns.shape[1]), dtype=columns.dtype)
        if are_labels:
            _check_labels(array, columns)
        _core.resample(*self._csr, columns, found, are_labels)
        if are_labels:
            found = _in_type(found, array.dtype)
        return found.reshape(self._shape[:1] + array.shape[1:])


def resample(
    source: SurfaceLike,
    target: SurfaceLike,
    values: ArrayLike,
    method: str = "AdaptiveBarycentricArea",
    source_areas: ArrayLike | None = None,
    target_areas: ArrayLike | None = None,
    mask: ArrayLike | None = None,
    *,
    roi: ArrayLike | None = None,
    labels: bool | None = None,
    progress: Progress = None,
) -> NDArray[Any]:
    """Take values from the points of a sphere to the points of another one, as Workbench's
    ``-metric-resample`` and ``-label-resample`` do between fsaverage and fsLR. For many calls with one
    pair of spheres, keep a :class:`Resampler`.

    With the barycentric coordinates F_ts of target point t in the triangles of the source, G_ts of source
    point s in those of the target, and areas A, the weights of AdaptiveBarycentricArea are

        W_ts = A_s B_ts A_t / sum over t' of B_t's A_t',

    where row t of B is that of F if G_ts is 0 wherever F_ts is 0, and that of G otherwise. They keep the
    integral, sum over t of W_ts = A_s. Rows are divided by their sums at last, so that constants are
    exact; the mean by area then changes by a thousandth of the standard deviation.

    Parameters
    ----------
    source, target : Surface or tuple (points, faces)
        Two spheres about the origin, in register: a place on the brain has the same direction from the
        origin on both. Their radii may differ.
    values : array_like, shape (n,) or (n, k)
        Data at the points of the source. NaN is missing: the others are weighed by the same weights.
    method : {"AdaptiveBarycentricArea", "Barycentric"}, or in snake_case
    source_areas, target_areas : array_like, shapes (n,) and (p,), above 0, optional
    mask, roi, progress
        As for :class:`Resampler`.
    labels : bool, optional
        Whether values are labels: a point then has the label with the largest sum of weights, of equal
        sums the smallest label. By default, whether values are integers or bools.

    Returns
    -------
    ndarray, shape (p,) or (p, k)
        Of the type of labels, float32 for float32, and float64 for all others. NaN where no value
        has a weight, and 0 there for labels that are integers.

    Warns
    -----
    SurfaceDiffusionWarning
        Where points of the target have the area 0, and thus no value, since no face has them.

    References
    ----------
    D. Marcus et al., Informatics and data mining tools and strategies for the Human Connectome Project,
    Frontiers in Neuroinformatics 5, 2011.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import resample, sphere
    >>> source, target = sphere(4), sphere(5, radius=100.0)
    >>> resample(source, target, source.points).shape
    (10242, 3)
    >>> resample(source, target, source.points[:, 0] > 0)[:4]
    array([False,  True, False,  True])
    """
    return Resampler(source, target, method, source_areas, target_areas, mask, roi=roi,
                     progress=progress)(values, labels=labels)


def _as_method(method: Any) -> str:
    for word in _METHODS:
        if isinstance(method, str) and method in (word, _core.python_name(word)):
            return word
    raise ValueError(f"method is {shorten(method)}; allowed: {', '.join(_METHODS)}, or in snake_case")


def _find_areas(name: str, surface: Surface, given: Any) -> NDArray[np.float64]:
    """The areas of the points of a sphere, which is checked."""
    used = np.zeros(surface.n_points, dtype=bool)
    used[surface.triangles] = True
    points = surface.points[used]
    scale = np.abs(points).max() or 1.0
    radii = scale * np.linalg.norm(points / scale, axis=1)
    low, high = float(radii.min()), float(radii.max())
    if not (1e-150 < low <= high < 1e150 and high <= (1.0 + _SPHERE) * low):  # areas are squares
        raise ValueError(f"{name} has points {low:.4g} to {high:.4g} from the origin; allowed: a sphere about the "
                         f"origin, radii from 1e-150 to 1e150 that differ by {_SPHERE:.0%} at most, such as sphere.reg")
    areas = surface.vertex_areas if given is None else check_areas(f"{name}_areas", given, used)
    return np.where(used, areas, 0.0)


def _find_left_out(source: Surface, mask: Any, roi: Any) -> NDArray[np.uint8] | None:
    """The flags of the points that are left out."""
    flags, on_faces = find_mask(left_out(mask, roi, source), (source.n_points, source.n_faces))
    if flags is not None and on_faces:
        stays = np.repeat(flags == 0, np.diff(source._offsets))
        flags = np.ones(source.n_points, dtype=np.uint8)
        flags[source._connectivity[stays]] = 0
    if flags is not None and flags.all():
        raise ValueError(f"{'mask' if roi is None else 'roi'} leaves all points out; allowed: one or more that stay")
    return flags


def _check_labels(array: NDArray[Any], columns: NDArray[np.float64]) -> None:
    """Labels are compared in double precision, which has all integers to 2^53."""
    if array.dtype.kind in "iu" and (np.abs(columns) > 2.0**53).any():
        largest = array.flat[int(np.argmax(np.abs(columns)))]
        raise ValueError(f"values has the label {largest}; allowed: -2**53 to 2**53 = {2**53}")


def _in_type(found: NDArray[np.float64], dtype: Any) -> NDArray[Any]:
    """Labels in the type of the input; integers have no NaN."""
    return found.astype(dtype) if dtype.kind == "f" else np.nan_to_num(found).astype(dtype)
