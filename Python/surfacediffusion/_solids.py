# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Parts of files of facets as solids: points that are rounded apart are welded, and bodies are listed."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._settings import as_number
from ._surface import Surface, SurfaceLike, as_surface

__all__ = ["Bodies", "Body", "WeldedSurface", "bodies", "weld"]


@dataclass(frozen=True)
class WeldedSurface:
    """A surface with one point per place, and what was mended.

    Attributes
    ----------
    surface : Surface
        Its points are in the order of their coordinates.
    points : ndarray of int, shape (n,)
        The given point that each point is.
    faces : ndarray of int, shape (m,)
        The given face that each triangle lies in.
    tolerance : float
        The tolerance that was used, in coordinate units.
    welded : int
        The given points that became one with a point at another place.
    apart : float
        The largest distance of such two; 0 if there are none.
    split : int
        The vertices on an open edge that it was split at.
    duplicates : int
        The triangles left out because others have the same corners.
    flat : int
        The triangles left out because they have no area.
    """

    surface: Surface
    points: NDArray[np.int32] = field(repr=False)
    faces: NDArray[np.int32] = field(repr=False)
    tolerance: float
    welded: int
    apart: float
    split: int
    duplicates: int
    flat: int


def weld(surface: SurfaceLike, tolerance: float | None = None) -> WeldedSurface:
    """Join the facets of a part: what is rounded apart, T-junctions, and repeated facets.

    Points at one place become one. Of open edges, ends that are at most `tolerance` apart become one,
    and an edge with an end of another one on it is split there (T-junctions). Triangles with the same
    corners count once; as many of one orientation as of the other are an inner wall between two solids,
    of which none stays. Triangles of no area are left out.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface, without given `areas`. Polygons are cut into triangles first.
    tolerance : float, optional
        The distance to which points are joined, 0 or more, in the unit of the coordinates. By default
        1e-5 of the diagonal, and at most 1 % of the median length of open edges. 0 joins points at
        the same place alone, splits nothing, and keeps triangles of no area.

    Returns
    -------
    WeldedSurface
        The surface, and counts.

    Raises
    ------
    ValueError
        For a tolerance below 0, and if no triangle is left.

    Examples
    --------
    A square of two triangles beside one of three, whose side has a point on the middle of their edge:

    >>> from surfacediffusion import weld
    >>> points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0], [1, 0.5, 0]]
    >>> found = weld((points, [[0, 1, 2], [0, 2, 3], [1, 4, 6], [4, 5, 6], [6, 5, 2]]))
    >>> found.split, found.surface
    (1, <Surface: 7 points, 6 faces>)
    """
    surface = as_surface(surface)
    if surface.areas is not None:
        raise ValueError("areas are given for the points; allowed: surfaces without given areas")
    if tolerance is not None:
        tolerance = as_number("tolerance", tolerance, "finite numbers of at least 0",
                              lambda number: 0.0 <= number < np.inf)
    found = _core.weld(surface._core, tolerance)
    corners, of_point = found.pop("triangles"), found.pop("points")
    if not len(corners):
        raise ValueError(f"the surface has {surface.n_faces} faces, of which none has an area; "
                         "allowed: at least one with an area")
    used = np.unique(corners)
    used = used[np.lexsort((surface.points[used] + 0.0).T[::-1])]
    number = np.full(len(of_point), -1)
    number[used] = np.arange(len(used))
    return WeldedSurface(Surface(surface.points[used] + 0.0, number[corners]), used.astype(np.int32), **found)


@dataclass(frozen=True)
class Body:
    """A solid with its cavities.

    Attributes
    ----------
    triangles : int
    area, volume : float
        In squared and cubed coordinate units. The volume is less by that of the cavities, below 0 if
        the body is turned inside out, and means nothing if the body is not closed.
    closed : bool
        Whether it has no edge of one triangle.
    """

    triangles: int
    area: float
    volume: float
    closed: bool


@dataclass(frozen=True)
class Bodies:
    """The bodies of a surface.

    Attributes
    ----------
    table : list of Body
        In the order of their first triangles.
    of_triangle : ndarray of int, shape (m,)
        The body of each of `surface.triangles`; -1 for those with a point twice.
    inside : ndarray of bool, shape (n,)
        Points inside another closed body, by more than a millionth of the size of the surface.
    open_edges : int
        The edges of one triangle. 0: the surface is closed.
    non_manifold_edges : int
        The edges of three or more triangles. 0: it is manifold.
    misoriented_edges : int
        The edges that are not open, and that triangles do not pass as often one way as the other. 0: it
        is oriented.
    overlaps : int
        The pairs of closed bodies that have a part of space in common.
    """

    table: list[Body]
    of_triangle: NDArray[np.int32] = field(repr=False)
    inside: NDArray[np.bool_] = field(repr=False)
    open_edges: int
    non_manifold_edges: int
    misoriented_edges: int
    overlaps: int


def bodies(surface: SurfaceLike) -> Bodies:
    """The bodies of a surface, and whether it is closed, manifold and oriented, as printing wants it.

    A body is what edges connect. A closed part with normals that point inwards is a cavity, and belongs
    to the body around it. The volume of a body is the sum over its triangles abc of a . (b x c) / 6.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface as it is oriented. Triangles of different points meet nowhere: :func:`weld` joins
        points at the same place.

    Returns
    -------
    Bodies
        A table of the bodies, and counts of defects.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import bodies, sphere
    >>> ball, hollow = sphere(3, radius=2.0), sphere(3, radius=1.0)
    >>> shell = (np.vstack([ball.points, hollow.points]),
    ...          np.vstack([ball.triangles, hollow.triangles[:, ::-1] + ball.n_points]))
    >>> found = bodies(shell)
    >>> [(body.triangles, round(body.volume), body.closed) for body in found.table]
    [(2560, 29, True)]
    >>> found.open_edges, found.non_manifold_edges, found.misoriented_edges, found.overlaps
    (0, 0, 0, 0)
    """
    found = _core.find_bodies(as_surface(surface)._core)
    return Bodies([Body(*row) for row in found.pop("table")], inside=found.pop("inside").astype(bool), **found)
