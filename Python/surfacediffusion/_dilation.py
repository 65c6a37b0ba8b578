# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Dilation as Connectome Workbench does it: places near others get their values, the nearest one or a mean."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray

from ._distance import find_each, nearest_sources
from ._surface import Surface

#: Distances that are held together
_PANEL = 1 << 22


@dataclass
class Dilation:
    """distance: up to which values reach; next neighbours do in any case. exponent: weights are areas, or
    volumes, divided by distance^exponent; None: the nearest value. dimension: 2, of surfaces, or 3."""

    distance: float
    exponent: float | None
    dimension: int

    @property
    def ratio(self) -> float:
        """Values count that are at most this many times as far as the nearest one: beyond, all together weigh
        less than a fiftieth."""
        assert self.exponent is not None
        beyond = self.exponent - self.dimension
        return max(1.1, 49.0 ** (1.0 / beyond)) if beyond > 0.0 else np.inf

    def fill(self, result: NDArray[Any], rows: NDArray[Any], first: NDArray[Any], sources: NDArray[Any],
             count: int, measure: Callable[[NDArray[Any], float], tuple[NDArray[Any], ...]],
             sizes: NDArray[Any]) -> None:
        """Write the values of `rows`, whose nearest known rows are `sources`, at the distances `first`.
        measure(rows, cutoff): the distances of known rows from each, as counts per row, columns, and data.
        count: of known rows."""
        if self.exponent is None:
            result[rows] = result[sources]
            return
        order = np.argsort(first)
        step = max(1, _PANEL // max(count, 1))
        new = np.empty((len(rows), result.shape[1]))
        for start in range(0, len(rows), step):
            part = order[start:start + step]
            counts, columns, lengths = measure(rows[part], self.ratio * float(first[part].max()) * (1.0 + 1e-9))
            of_row = np.repeat(np.arange(len(part)), counts)
            near = lengths <= (self.ratio * first[part])[of_row]
            of_row, columns, lengths = of_row[near], columns[near], lengths[near]
            weights = sizes[columns] * (first[part][of_row] / lengths) ** self.exponent
            total = np.bincount(of_row, weights, len(part))
            for k in range(result.shape[1]):
                new[part, k] = np.bincount(of_row, weights * result[columns, k], len(part)) / total
        result[rows] = new


def dilate(surface: Surface, values: NDArray[Any], how: Dilation, mask: Any = None,
           sources: Any = True) -> NDArray[Any]:
    """The values (n, k), in whose columns NaN is at the same points, with values of others there, or 0. mask (n,):
    neither changed nor read. sources (n,): of which values are read."""
    outside = np.zeros(len(values), bool) if mask is None else np.asarray(mask, bool)
    missing = np.isnan(values).any(axis=1) & ~outside
    known = ~(missing | outside) & sources
    if not known.any():
        raise ValueError("there is no value to fill in others from; allowed: one that is neither 0 nor missing")
    whole = surface._triangle_areas()
    areas = surface.vertex_areas
    speed = None
    if not np.allclose(areas, whole):  # lengths grow with the root of the area
        speed = np.sqrt(np.divide(whole, areas, out=np.ones_like(whole), where=areas > 0.0))
    nearest = nearest_sources(surface, known, speed=speed)
    first = nearest.distance
    marked = np.zeros(len(values), bool)  # has a known neighbour
    marked[surface.triangles[known[surface.triangles].any(axis=1)]] = True
    rows = np.flatnonzero(missing & np.isfinite(first) & ((first <= how.distance) | marked))

    def measure(some: NDArray[Any], cutoff: float) -> tuple[NDArray[Any], ...]:
        lengths, columns, starts = find_each(surface, some, cutoff, {}, None, mask=None, roi=None, speed=speed,
                                             directions=None)
        kept = known[columns] & (lengths > 0.0)
        of_row = np.repeat(np.arange(len(some)), np.diff(starts))[kept]
        return np.bincount(of_row, minlength=len(some)), columns[kept], lengths[kept]

    result = np.array(values)
    result[missing] = 0.0
    how.fill(result, rows, first[rows], nearest.source[rows], int(known.sum()), measure, areas)
    return result


class VoxelDilator:
    """voxels, affine: as of VoxelSmoother."""

    def __init__(self, voxels: NDArray[Any], affine: NDArray[Any], how: Dilation) -> None:
        axes = np.asarray(affine, dtype=float)[:3, :3]
        self._places = np.asarray(voxels) @ axes.T
        self._spacing = float(np.linalg.norm(axes, axis=0).max())
        self._how = how

    def __call__(self, values: NDArray[Any], known: NDArray[np.bool_]) -> NDArray[Any]:
        """The values (v, k), where not known (v,) with those of others, or 0."""
        sources, rows = np.flatnonzero(known), np.flatnonzero(~known)
        step = max(1, _PANEL // max(len(sources), 1))
        parts = (self._lengths(rows[i:i + step], sources) for i in range(0, len(rows), step))  # one at a time
        nearest = [(part.argmin(axis=1), part.min(axis=1)) for part in parts]
        result = np.array(values)
        result[rows] = 0.0
        if not len(rows):
            return result
        which, first = (np.concatenate(found) for found in zip(*nearest))
        near = first <= max(self._how.distance, self._spacing * (1.0 + 1e-6))

        def measure(some: NDArray[Any], cutoff: float) -> tuple[NDArray[Any], ...]:
            lengths = self._lengths(some, sources)
            kept = lengths <= cutoff
            return kept.sum(axis=1), sources[np.nonzero(kept)[1]], lengths[kept]

        self._how.fill(result, rows[near], first[near], sources[which[near]], len(sources), measure,
                       np.ones(len(values)))
        return result

    def _lengths(self, rows: NDArray[Any], sources: NDArray[Any]) -> NDArray[np.float64]:
        squares = sum((self._places[rows, i][:, None] - self._places[sources, i]) ** 2 for i in range(3))
        return np.sqrt(squares)
