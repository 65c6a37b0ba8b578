# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Gaussian smoothing among the voxels of a region, as Connectome Workbench does it."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

_SIGMAS_PER_FWHM = 1.0 / np.sqrt(8.0 * np.log(2.0))

#: Workbench's kernel ends at this many sigmas along each axis.
_RANGE = 3.0

#: Values of boxes that are handled together: the memory does not grow with the number of columns.
_PANEL = 1 << 22


class VoxelSmoother:
    """The weighted mean over the voxels of a set, with the weights of a Gaussian of their distance.

    voxels  (v, 3) int, the indices of the voxels
    affine  (4, 4), from indices to coordinates
    fwhm    the full width at half maximum, in the unit of the coordinates

    The kernel is a product over the axes of the grid if these are perpendicular, else a ball; it ends at
    three sigmas and has at least the next neighbours. Voxels without a value take no part, and the
    weights of the others sum to 1.
    """

    def __init__(self, voxels: NDArray[Any], affine: NDArray[Any], fwhm: float) -> None:
        voxels = np.asarray(voxels, dtype=np.int64)
        low = voxels.min(axis=0)
        self._shape = tuple((voxels.max(axis=0) - low + 1).tolist())
        self._places = np.ravel_multi_index(tuple((voxels - low).T), self._shape)
        self._axes = np.asarray(affine, dtype=float)[:3, :3]
        self._sigma = fwhm * _SIGMAS_PER_FWHM
        lengths = np.linalg.norm(self._axes, axis=0)
        cosines = np.abs(self._axes.T @ self._axes / np.outer(lengths, lengths))
        self._separable = (cosines - np.eye(3)).max() < 1e-3
        self._matrices = [self._matrix(n, length) for n, length in zip(self._shape, lengths)]

    def _matrix(self, size: int, spacing: float) -> NDArray[np.float64]:
        """The weights between the voxels of a line."""
        steps = np.abs(np.arange(size)[:, None] - np.arange(size))
        reach = max(1.0, np.floor(_RANGE * self._sigma / spacing))
        weights = np.exp(-0.5 * (steps * spacing / self._sigma) ** 2)
        return np.where(steps <= reach, weights, 0.0)

    def __call__(self, values: NDArray[Any], known: NDArray[np.bool_]) -> NDArray[np.float64]:
        """The means (v, k). values: (v, k). known: (v,) bool; values at the others are not read. NaN
        where no known value is near."""
        weights = self._sum(known[:, None].astype(float))
        means = np.empty(values.shape)
        panel = max(1, _PANEL // int(np.prod(self._shape)))
        for first in range(0, values.shape[1], panel):
            chosen = np.where(known[:, None], values[:, first:first + panel], 0.0)
            means[:, first:first + panel] = self._sum(chosen)
        return np.divide(means, weights, out=np.full(means.shape, np.nan), where=weights > 0)

    def _sum(self, values: NDArray[Any]) -> NDArray[np.float64]:
        """The weighted sums (v, k) of values (v, k)."""
        k = values.shape[1]
        box = np.zeros((k, int(np.prod(self._shape))))
        box[:, self._places] = values.T
        box = box.reshape(k, *self._shape)
        box = self._sum_along_axes(box) if self._separable else self._sum_in_ball(box)
        return box.reshape(k, -1)[:, self._places].T

    def _sum_along_axes(self, box: NDArray[np.float64]) -> NDArray[np.float64]:
        a, b, c = self._matrices
        box = np.matmul(b, np.matmul(box, c))
        return np.matmul(a, box.reshape(len(box), len(a), -1)).reshape(box.shape)

    def _sum_in_ball(self, box: NDArray[np.float64]) -> NDArray[np.float64]:
        """For axes that are not perpendicular, whose kernel is no product."""
        reach = _RANGE * self._sigma
        heights = 1.0 / np.linalg.norm(np.linalg.inv(self._axes), axis=1)  # of planes of voxels
        steps = np.maximum(1, np.floor(reach / heights)).astype(int)
        steps = np.minimum(steps, np.array(self._shape) - 1)
        result = np.zeros_like(box)
        for offset in itertools.product(*(range(-n, n + 1) for n in steps)):
            distance = np.linalg.norm(self._axes @ offset)
            if distance > reach and any(offset):
                continue
            to = tuple(slice(max(0, -d), n - max(0, d)) for d, n in zip(offset, self._shape))
            of = tuple(slice(max(0, d), n - max(0, -d)) for d, n in zip(offset, self._shape))
            result[(slice(None), *to)] += np.exp(-0.5 * (distance / self._sigma) ** 2) * box[
                (slice(None), *of)]
        return result


def voxel_fwhm(voxels: NDArray[Any], affine: NDArray[Any], values: NDArray[Any]) -> NDArray[np.float64]:
    """The smoothness (3,) of all columns of values (v, k) along the axes of the grid, as a full width at half
    maximum, from the variance of differences between neighbours (S. Forman et al., Magnetic Resonance in Medicine
    33, 1995, 636-647). NaN of values without correlation. voxels, affine: as of VoxelSmoother."""
    voxels = np.asarray(voxels, dtype=np.int64)
    low = voxels.min(axis=0)
    shape = voxels.max(axis=0) - low + 2  # the last layer of each axis is empty
    rows = np.full(shape, -1)
    rows[tuple((voxels - low).T)] = np.arange(len(voxels))
    widths = np.linalg.norm(np.asarray(affine, dtype=float)[:3, :3], axis=0)
    for axis in range(3):
        ends = np.stack([rows, np.roll(rows, -1, axis)])
        a, b = ends[:, (ends >= 0).all(axis=0)]
        with np.errstate(invalid="ignore", divide="ignore"):
            widths[axis] *= np.sqrt(-2.0 * np.log(2.0) / np.log(
                1.0 - np.var(values[a] - values[b]) / (2.0 * np.var(values))))
    return widths
