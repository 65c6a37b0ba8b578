# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surrogates of parcellated maps, which have a value per parcel of a surface."""

from __future__ import annotations

import hashlib
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._fields import STREAM, make_fields, prepare_fields, warn_of_solves
from ._ranks import check_known, check_varies, normal_scores, take_values
from ._run import Progress, ProgressReporter, part_of
from ._surface import Surface, as_numbers, require_shape

__all__: list[str] = []

#: Steps at most to the likeliest variances, the change at which they end, and the least share of the
#: variance without correlation, which keeps matrices regular.
_STEPS, _CHANGE, _LEAST = 300, 1e-3, 1e-6


class Parcels:
    """Values of parcels, their model, and sums of random fields over them."""

    def __init__(self, surface: Surface, values: ArrayLike, labels: ArrayLike, mask: Any) -> None:
        self._surface = surface
        numbers, self._parcel_of = _as_labels(labels, surface.n_points)
        self._given = np.array(as_numbers("values", values), dtype=np.float64)
        shown = ", ".join(map(str, numbers[:4])) + (f", ..., {numbers[-1]}" if len(numbers) > 4 else "")
        require_shape("values", values, self._given.shape == (len(numbers),),
                      f"({len(numbers)},), one per number in labels but 0 ({shown}; those of two hemispheres differ)")
        check_known("values", self._given)
        self._fields = make_fields(surface, mask)
        areas = np.where(self._parcel_of >= 0, self._fields.areas(), 0.0)
        sizes = np.bincount(np.maximum(self._parcel_of, 0), areas, len(numbers))
        self._known = np.isfinite(self._given) & (sizes > 0.0)
        check_varies("values", self._given[self._known])
        kept = np.flatnonzero(self._known)
        column = np.full(len(numbers), -1)
        column[kept] = np.arange(len(kept))
        inside = np.flatnonzero(areas > 0.0)
        inside = inside[column[self._parcel_of[inside]] >= 0]
        parcels = self._parcel_of[inside]
        #: (points, parcels): a field becomes its means over the parcels
        self._means = np.zeros((surface.n_points, len(kept)))
        self._means[inside, column[parcels]] = areas[inside] / sizes[parcels]
        unit, area = self._fields.length_unit(), self._fields.areas().sum()
        # From half of a parcel's size to the trends of maps that are smoother than the surface.
        self.widths = [max(2.0 * self._fields.mean_edge_length(), 0.5 * math.sqrt(sizes[kept].mean()) * unit)]
        while 2.0 * self.widths[-1] < 3.0 * math.sqrt(area) * unit:
            self.widths.append(2.0 * self.widths[-1])
        self.widths.append(0.0)

    def draw(
        self, n: int, seed: int, progress: Progress
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """The surrogates (k, n), the widths, and their shares of the variance."""
        covariances = self._find_covariances(progress)
        scores = normal_scores(self._given, self._known)[self._known]
        variances = fit_variances(covariances, scores)
        # Between parcels: a covariance that is the same for all pairs does not count.
        totals = np.array([np.mean(np.diag(part)) - part.mean() for part in covariances])
        shares = variances * totals
        values, vectors = np.linalg.eigh(np.tensordot(variances, covariances, 1))
        root = vectors * np.sqrt(np.maximum(values, 0.0))
        numbers = np.random.Generator(np.random.PCG64([seed % 2**64, STREAM]))
        found = np.full((len(self._given), n), np.nan)
        # One surrogate after the other: the first ones do not depend on how many there are.
        found[self._known] = root @ numbers.standard_normal((n, len(root))).T
        take_values(self._given[self._known], found, np.flatnonzero(self._known))
        return found, np.array(self.widths), shares / shares.sum()

    def _find_covariances(self, progress: Progress) -> NDArray[np.float64]:
        """The surface keeps the last ones."""
        version = hashlib.blake2b(self._parcel_of.tobytes() + self._known.tobytes()).digest()
        with self._surface._lock:
            fields, known, covariances = self._surface._runs.get("parcels", (None, None, None))
            if fields is not self._fields or known != version:
                with ProgressReporter(progress, len(self.widths)) as reporter:
                    covariances = self._covariances(reporter)
                self._surface._runs["parcels"] = self._fields, version, covariances
        return np.asarray(covariances)

    def _covariances(self, reporter: ProgressReporter) -> NDArray[np.float64]:
        """Of the means of fields of each width, and the identity: (widths, parcels, parcels)."""
        count = self._means.shape[1]
        found = np.empty((len(self.widths), count, count))
        found[-1] = np.eye(count)
        for k, width in enumerate(self.widths[:-1]):
            half = [part_of(reporter.callable, done, 0.5) for done in (0.0, 0.5)]
            prepare_fields(self._fields, width, 0.0, True, half[0], shares=True)
            root = self._means.copy()
            warn_of_solves(self._fields.apply_transposed(root, half[1]))
            root[np.isnan(root)] = 0.0
            found[k] = root.T @ root
            reporter.finish_part()
        self._fields.end_sharing()
        reporter.finish_part()
        return found


def _as_labels(labels: ArrayLike, points: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The numbers of the parcels, ascending, and the row of that of each point; -1 outside."""
    array = as_numbers("labels", labels)
    require_shape("labels", array, array.shape == (points,), f"({points},), one number per point")
    if not (np.isfinite(array) & (array == np.floor(array))).all():
        row = int(np.argmin(np.isfinite(array) & (array == np.floor(array))))
        raise ValueError(f"labels has {array[row]} in row {row}; allowed: whole numbers, 0 outside of all parcels")
    numbers, parcel_of = np.unique(array.astype(np.int64), return_inverse=True)
    parcel_of = parcel_of.reshape(-1)
    if 0 in numbers:
        outside = int(np.flatnonzero(numbers == 0)[0])
        parcel_of = np.where(parcel_of == outside, -1, parcel_of - (parcel_of > outside))
        numbers = numbers[numbers != 0]
    if len(numbers) < 2:
        raise ValueError(f"labels has {len(numbers)} parcels; allowed: two numbers or more beside 0")
    return numbers, parcel_of


def fit_variances(covariances: NDArray[np.float64], scores: NDArray[np.float64]) -> NDArray[np.float64]:
    """The variances v >= 0 for which the scores, but for their mean, are likeliest as normal values of the
    covariance sum_k v_k covariances[k], the last of which is the identity (restricted maximum likelihood;
    H. Zhou, L. Hu, J. Zhou, K. Lange, MM algorithms for variance components models, J. Comput. Graph. Stat.
    28, 2019)."""
    count = len(scores)
    # An orthonormal basis of what has the mean 0.
    contrasts = np.linalg.qr(np.column_stack([np.ones(count), np.eye(count)[:, 1:]]))[0][:, 1:]
    parts = contrasts.T @ covariances @ contrasts
    y = contrasts.T @ scores
    traces = np.trace(parts, axis1=1, axis2=2) / (count - 1)
    variance = y @ y / (count - 1)
    shares = np.full(len(parts), 1.0 / len(parts))
    scaled = parts / np.maximum(traces, 1e-300)[:, None, None]
    for _ in np.arange(_STEPS):
        inverse = np.linalg.inv(np.tensordot(shares, scaled, 1))
        z = inverse @ y / math.sqrt(variance)
        new = shares * np.sqrt((scaled @ z) @ z / np.maximum(np.einsum("ij,kij->k", inverse, scaled), 1e-300))
        new[-1] = max(new[-1], _LEAST)
        change = np.abs(new - shares).max() / new.max()
        shares = new
        if change < _CHANGE:
            break
    return np.asarray(variance * shares / np.maximum(traces, 1e-300))
