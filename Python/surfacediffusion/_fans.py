# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces with points at the middles of faces, and pairs of surfaces as one."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._surface import NAMES, Surface, as_flags, as_surface, find_place, place

__all__: list[str] = []


class Fans:
    """A surface whose faces are cut into a triangle per edge about their middles, the means of their corners,
    which are points of `surface` behind those of the given one."""

    surface: Surface

    def __init__(self, given: Surface) -> None:
        self._given = given
        self._face_of = np.repeat(np.arange(given.n_faces), np.diff(given._offsets))
        corners = given._connectivity
        following = np.roll(corners, -1)
        following[given._offsets[1:] - 1] = corners[given._offsets[:-1]]
        points = np.vstack([given.points, self.means(given.points)])
        triangles = np.stack([corners, following, given.n_points + self._face_of], axis=1)
        self.surface = Surface(points, triangles)
        if given.areas is not None:
            of_triangles = given._triangle_areas()
            factors = np.where(of_triangles > 0.0, given.areas / np.where(of_triangles > 0.0, of_triangles, 1.0), 1.0)
            factors = np.concatenate([factors, self.means(factors)])
            self.surface = Surface(points, triangles, factors * self.surface._triangle_areas())

    def means(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """The means of the values (n,) or (n, k) of points over the corners of each face."""
        given = self._given
        return np.add.reduceat(values[given._connectivity], given._offsets[:-1], axis=0) / np.diff(
            given._offsets).reshape((-1,) + (1,) * (values.ndim - 1))

    def left_out(self, mask: Any) -> Any:
        """The mask of these triangles: those of the faces that a mask of points or faces leaves out."""
        flags = as_flags("mask", mask)
        if flags is None:
            return None
        given = self._given
        outside = flags != 0
        if not find_place("mask", mask, (given.n_points, given.n_faces), "flag", False):
            outside = np.logical_or.reduceat(outside[given._connectivity], given._offsets[:-1])
        return place(outside[self._face_of], True)


def fans(surface: Surface) -> Fans:
    """The surface keeps them."""
    with surface._lock:
        if "fans" not in surface._runs:
            surface._runs["fans"] = Fans(surface)
        found: Fans = surface._runs["fans"]
    return found


def as_one_surface(surface: Any) -> Surface:
    """A surface, or a pair (left, right) as one, in which no point of one is near to one of the other."""
    if not (isinstance(surface, (tuple, list)) and len(surface) == 2 and all(map(_is_surface, surface))):
        return as_surface(surface)
    left, right = map(as_surface, surface)
    shift = np.zeros(3)
    shift[0] = 2.0 * (np.ptp(left.points[:, 0]) + np.ptp(right.points[:, 0])) + (
        left.points[:, 0].max() - right.points[:, 0].min())
    areas = None
    if left.areas is not None or right.areas is not None:
        areas = np.concatenate([left.vertex_areas, right.vertex_areas])
    faces = [*np.split(left._connectivity, left._offsets[1:-1]),
             *np.split(right._connectivity + left.n_points, right._offsets[1:-1])]
    if all(len(face) == 3 for face in faces):
        faces = np.array(faces)  # type: ignore[assignment]
    return Surface(np.vstack([left.points, right.points + shift]), faces, areas)


def _is_surface(item: Any) -> bool:
    """Whether this is one of a pair of surfaces, rather than the points or the faces of one."""
    if isinstance(item, (tuple, list)):
        return len(item) == 2 and np.ndim(item[0]) == 2
    return isinstance(item, Surface) or any(hasattr(item, points) and hasattr(item, faces) for points, faces in NAMES)
