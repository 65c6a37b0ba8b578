# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Shortest paths on surfaces, and disks within a distance."""

from __future__ import annotations

import numbers
from dataclasses import dataclass, field
from typing import Any, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._distance import _ARRAYS, _as_places_in_triangles, _as_rows, _count_axes, _make_input
from ._run import Progress, ProgressReporter, Runner, warn
from ._settings import as_number, as_switch, shorten
from ._surface import Surface, SurfaceLike, as_numbers, as_surface

__all__ = ["GeodesicDisk", "GeodesicPath", "geodesic_disk", "geodesic_path", "path_through"]


@dataclass(frozen=True, eq=False)
class GeodesicPath:
    """A path on a surface, straight in each triangle.

    Attributes
    ----------
    points : ndarray, shape (k, 3)
        Where it begins, crosses edges or goes through points of the surface, and ends.
    length : float
        In the unit of the coordinates.
    faces : ndarray of int, shape (k - 1,)
        The row of the face that each segment lies in.
    """

    points: NDArray[np.float64] = field(repr=False)
    length: float
    faces: NDArray[np.int64] = field(repr=False)


@dataclass(frozen=True, eq=False)
class GeodesicDisk:
    """The part of a surface within a distance of a place.

    Attributes
    ----------
    area : float
        In the square of the unit of the coordinates.
    boundary : list of ndarray, each of shape (k, 3)
        The curves at this distance. Closed ones end with the point that they begin with; others end at
        boundaries of the surface, or where three or more faces meet.
    """

    area: float
    boundary: list[NDArray[np.float64]] = field(repr=False)


def geodesic_path(
    surface: SurfaceLike,
    start: Any,
    end: Any,
    *,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    merge_coincident_points: bool = False,
    merge_tolerance: float = 0.0,
    progress: Progress = None,
) -> GeodesicPath:
    """The shortest path between two places of a surface, whose length is their exact distance: that of
    :func:`distance` with the method Exact.

    It is straight in each triangle and over edges, laid out in a plane, and goes through a point of the
    surface only where the angle on both sides is at least pi: at saddles, and at corners of the boundary,
    which it slides along. Of several shortest paths it is one.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface. Paths go over edges of any number of faces, and not beyond boundaries.
    start, end : int, tuple (face, barycentric) or array_like of shape (3,)
        A point of the surface, by its row; or a place in a triangle, by the row of this face and
        three barycentric coordinates; or coordinates, which stand for the nearest place of the surface.
    mask : array_like, shape (n,) or (m,), optional
        Nonzero leaves a point with its faces, or a face, out.
    roi : array_like, shape (n,) or (m,), optional
        The region of interest, the opposite of a mask and in place of one.
    merge_coincident_points, merge_tolerance
        As for :func:`distance`.
    progress : bool or callable, optional
        As for :func:`heat`.

    Returns
    -------
    GeodesicPath
        `points`, `length` and `faces`. Of a place from itself: one point, 0.0 and no face.

    Raises
    ------
    ValueError
        If no path leads from one to the other.

    Notes
    -----
    The time is that of the exact distances up to the length of the path: about a second where 100,000
    triangles are as near, and eight times as much for four times as many.

    References
    ----------
    J. S. B. Mitchell, D. M. Mount, C. H. Papadimitriou, The discrete geodesic problem, SIAM J. Comput.
    16(4), 1987, 647-668.

    Examples
    --------
    >>> from surfacediffusion import geodesic_path
    >>> step = ([[0, 0, 0], [0, 4, 0], [1, 0, 0], [1, 4, 0], [1, 0, 2], [1, 4, 2]],
    ...         [[0, 2, 3, 1], [2, 4, 5, 3]])
    >>> path = geodesic_path(step, 0, 5)
    >>> path.length, path.faces
    (5.0, array([0, 0, 1, 1]))
    >>> path.points[2].round(3)
    array([1.   , 1.333, 0.   ])
    """
    return _find_path(as_surface(surface), {"start": start, "end": end}, False, mask, roi,
                      merge_coincident_points, merge_tolerance, progress)


def path_through(
    surface: SurfaceLike,
    points: Any,
    closed: bool = False,
    *,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    merge_coincident_points: bool = False,
    merge_tolerance: float = 0.0,
    progress: Progress = None,
) -> GeodesicPath:
    """The shortest paths from each of several places of a surface to the next, as one.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface.
    points : array_like of int, shape (k,), or of shape (k, 3), or tuple (faces, barycentric), or sequence
        Points of the surface, by their rows; or coordinates, which stand for the nearest places of
        the surface; or places in triangles, (k,) and (k, 3); or a sequence of one place each as for
        :func:`geodesic_path`.
    closed : bool, default False
        Whether the path leads back to the first place.
    mask, roi, merge_coincident_points, merge_tolerance, progress
        As for :func:`geodesic_path`.

    Returns
    -------
    GeodesicPath
        `points`, `length` and `faces`. It may turn at the given places.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import path_through, sphere
    >>> equator = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
    >>> round(path_through(sphere(5), equator, closed=True).length / (2 * np.pi), 3)
    1.0
    """
    given = as_surface(surface)
    places = _list_places(given, points)
    if not places:
        raise ValueError("points is empty; allowed: one or more places")
    named = {f"points[{k}]": place for k, place in enumerate(places)}
    return _find_path(given, named, as_switch("closed", closed), mask, roi, merge_coincident_points,
                      merge_tolerance, progress)


def geodesic_disk(
    surface: SurfaceLike,
    center: Any,
    radius: float,
    *,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    merge_coincident_points: bool = False,
    merge_tolerance: float = 0.0,
    progress: Progress = None,
) -> GeodesicDisk:
    """The part of a surface whose exact distance from a place is at most a radius: its area and boundary.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface.
    center : int, tuple (face, barycentric) or array_like of shape (3,)
        A place, as for :func:`geodesic_path`.
    radius : float, above 0
        In the unit of the coordinates.
    mask, roi, merge_coincident_points, merge_tolerance, progress
        As for :func:`geodesic_path`.

    Returns
    -------
    GeodesicDisk
        `area` and `boundary`, to about 0.1 % of the area and of the radius on the faces as they are. A disk
        that covers all of its part of the surface has no boundary.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import geodesic_disk, sphere
    >>> disk = geodesic_disk(sphere(5), [0, 0, 1], 0.5)
    >>> round(disk.area / (2 * np.pi * (1 - np.cos(0.5))), 2), len(disk.boundary)
    (1.0, 1)
    """
    given = as_surface(surface)
    radius = as_number("radius", radius, "finite numbers above 0", lambda r: 0.0 < r < np.inf)
    places = _number_places(given, {"center": center})
    area, boundary = _call(given, "find_disk", places, radius, mask, roi, merge_coincident_points,
                           merge_tolerance, progress)
    return GeodesicDisk(area, boundary)


def _find_path(surface: Surface, places: dict[str, Any], closed: bool, *options: Any) -> GeodesicPath:
    points, faces, length = _call(surface, "find_path", _number_places(surface, places), closed, *options)
    return GeodesicPath(points, length, faces)


def _call(
    surface: Surface, method: str, places: tuple[Any, ...], argument: Any, mask: Any, roi: Any,
    merge_coincident_points: bool, merge_tolerance: float, progress: Progress,
) -> Any:
    inputs = _make_input(surface, mask=mask, roi=roi, speed=None, directions=None)
    runner = Runner("distance", {"merge_coincident_points": merge_coincident_points,
                                 "merge_tolerance": merge_tolerance}, _ARRAYS)
    with surface._lock, ProgressReporter(progress) as reporter:
        run = surface._runs.setdefault("distance", _core.SurfaceRuns("distance"))
        found = runner.call(getattr(run, method), inputs.core, runner.settings, *places, argument,
                            reporter.callable)
        sentences = runner.warnings(run)
        reporter.finish_part()
    warn(sentences)
    return found


def _number_places(surface: Surface, places: dict[str, Any]) -> tuple[Any, ...]:
    """The names, the rows of points and of triangles, -1 for none, and coordinates of places."""
    points = np.full(len(places), -1, dtype=np.int64)
    triangles, coordinates = points.copy(), np.zeros((len(places), 3))
    for k, (name, place) in enumerate(places.items()):
        allowed = (f"{name} is {shorten(place)}; allowed: a row of points, a tuple (face, three barycentric "
                   "coordinates), or three finite coordinates")
        if isinstance(place, numbers.Integral) or (isinstance(place, np.ndarray) and place.ndim == 0):
            points[k] = _as_rows(name, place, surface.n_points, "points")[0]
        elif isinstance(place, tuple) and len(place) == 2:
            if _count_axes(place[0]) or _count_axes(place[1]) != 1 or len(place[1]) != 3:
                raise ValueError(allowed)
            rows, weights = _as_places_in_triangles(surface, place[0], [place[1]], name)
            triangles[k], coordinates[k] = rows[0], weights[0]
        else:
            array = as_numbers(name, place)
            if array.shape != (3,) or not np.isfinite(array).all():
                raise ValueError(allowed)
            coordinates[k] = array
    return list(places), points, triangles, coordinates


def _list_places(surface: Surface, points: Any) -> Sequence[Any]:
    """Places one by one."""
    if isinstance(points, tuple) and len(points) == 2 and _count_axes(points[1]) == 2:
        rows, weights = points
        if _count_axes(rows) != 1 or len(rows) != len(weights):
            raise ValueError(f"points is {shorten(points)}; allowed: as many rows of faces as rows of "
                             "barycentric coordinates")
        return list(zip(np.asarray(rows), np.asarray(weights)))
    if isinstance(points, (str, bytes)) or not hasattr(points, "__len__"):
        raise ValueError(f"points is {shorten(points)}; allowed: a sequence of places")
    return list(points)
