# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Distances along surfaces, and the arrival times of fronts."""

from __future__ import annotations

import hashlib
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._operators import import_sparse
from ._refinement import MAXIMUM_TRIANGLES, take_along
from ._run import Progress, ProgressReporter, warn, warn_of_seams
from ._settings import check_positive, shorten
from ._surface import (
    Surface, SurfaceLike, as_directions, as_flags, as_numbers, as_surface, find_mask, find_place,
)

__all__ = ["NearestSources", "distance", "distances", "nearest_sources"]


class NearestSources(NamedTuple):
    """Distances from the nearest of several sources, and which one that is."""

    distance: NDArray[np.float64]  #: (n,), in the unit of the coordinates, or of time
    source: NDArray[np.int64]  #: (n,), the row of `sources`; -1 where the distance is infinite


def distance(
    surface: SurfaceLike,
    sources: ArrayLike,
    *,
    start: ArrayLike | None = None,
    speed: ArrayLike | None = None,
    directions: ArrayLike | None = None,
    along_speed: float = 1.0,
    across_speed: float = 1.0,
    mask: ArrayLike | None = None,
    method: str = "Eikonal",
    progress: Progress = None,
    refine_to: float = 0.0,
    maximum_number_of_triangles: int = MAXIMUM_TRIANGLES,
) -> NDArray[np.float64]:
    """The distance along a surface from the nearest source, or with `speed` the time at which
    fronts from the sources arrive: |grad T| = 1 / speed, T = `start` at the sources. With directions
    e1, and e2 across them in the tangent plane, grad T . D grad T = 1 with
    D = speed^2 (along_speed^2 e1 e1^T + across_speed^2 e2 e2^T).

    Fast marching on the triangles, which lays out the way from the source in the plane of each
    triangle: distances in a plane are exact, and those of an icosphere of 10,242 points have a mean
    error of 0.06 to 0.09 % of the largest one. Without speeds the triangles are those of the intrinsic
    Delaunay triangulation. The method Heat has smooth level sets and, on the same sphere, an error of
    0.31 %.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface. Fronts go over edges of any number of faces, and not beyond boundaries.
    sources : int, array_like of shape (k,) or (k, 3), or tuple (faces, barycentric)
        Points of the surface, by their rows; or coordinates, (k, 3), which stand for the nearest
        places of the surface; or places in triangles, by the rows of these faces, (k,), and
        barycentric coordinates, (k, 3).
    start : array_like, shape (k,), optional
        The times at the sources, by default 0.
    speed : array_like, shape (m,) or (n,), optional
        The speed of fronts on each face, in the unit of the coordinates per unit of time, finite
        and 0 or more, or at each point: on a face that of its points on average. Faces of speed 0
        are barriers.
    directions : array_like, shape (n, 3) or (m, 3), optional
        Directions e1 at points or on faces, of any length and sign; zero or NaN is none, and fronts
        have the geometric mean of both speeds there.
    along_speed, across_speed : float, above 0, default 1
        Factors of the speed along the directions and across them.
    mask : array_like, shape (n,) or (m,), optional
        Nonzero leaves a point with its faces, or a face, out: a barrier, too.
    method : str
        "Eikonal", fast marching, or "Heat", the heat method with the step 1.1 h^2, where h is the mean
        edge length, without `start` and speeds.
    progress : bool or callable, optional
        As for :func:`heat`.
    refine_to : float, 0 or more, in coordinates, default 0
        Edges that are longer are bisected first: the result belongs to the points of
        ``refine(surface, refine_to).surface``, which begin with the given ones. 0: the surface stays as
        it is.
    maximum_number_of_triangles : int, 1 or more, default 4000000
        Refinement stops before there are more, with a warning.

    Returns
    -------
    ndarray of float64, shape (n,)
        inf at points that no front reaches: on parts of the surface without source, and outside.

    Raises
    ------
    ValueError
        Without sources, and if one is a point that no face uses or that is masked, or a place on a
        face that is masked or a barrier; with the method Heat and `start` or speeds.

    References
    ----------
    R. Kimmel, J. A. Sethian, Computing geodesic paths on manifolds, PNAS 95, 1998, 8431-8435.
    M. Novotni, R. Klein, Computing geodesic distances on triangular meshes, WSCG 2002.
    K. Crane, C. Weischedel, M. Wardetzky, Geodesics in heat, ACM Trans. Graph. 32(5), 2013.

    Examples
    --------
    >>> from surfacediffusion import distance
    >>> kite = ([[0, 0, 0], [1, -3, 0], [2, 0, 0], [1, 3, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> distance(kite, 1).round(3)
    array([3.162, 0.   , 3.162, 6.   ])
    """
    if method not in ("Eikonal", "Heat"):
        raise ValueError(f"method is {shorten(method)}; allowed: Eikonal, Heat")
    speeds = _Speeds(speed, directions, along_speed, across_speed)
    if method == "Eikonal":
        return _march(surface, sources, start, speeds, mask, False, progress, refine_to,
                      maximum_number_of_triangles).distance
    for name, given in (("start", start), ("speed", speed), ("directions", directions),
                        ("along_speed", None if along_speed == 1.0 else along_speed),
                        ("across_speed", None if across_speed == 1.0 else across_speed)):
        if given is not None:
            raise ValueError(f"method is Heat; allowed: Eikonal together with {name}")
    surface, fronts, given = _prepare(
        surface, sources, speeds, mask, refine_to, maximum_number_of_triangles)
    with surface._lock, ProgressReporter(progress) as reporter:
        found: NDArray[np.float64] = fronts.by_heat(*given, reporter.callable)
        reporter.finish_part()
    return found


def nearest_sources(
    surface: SurfaceLike,
    sources: ArrayLike,
    *,
    start: ArrayLike | None = None,
    speed: ArrayLike | None = None,
    directions: ArrayLike | None = None,
    along_speed: float = 1.0,
    across_speed: float = 1.0,
    mask: ArrayLike | None = None,
    progress: Progress = None,
    refine_to: float = 0.0,
    maximum_number_of_triangles: int = MAXIMUM_TRIANGLES,
) -> NearestSources:
    """The distance from the nearest source, and the row of this source. Fronts of the sources do not
    mix: the distance is the smallest of those by :func:`distance` from each source alone. From all
    sources together, as along a line of points, that function has plane fronts.

    Parameters
    ----------
    surface, sources, start, speed, directions, along_speed, across_speed, mask, progress, refine_to, \
maximum_number_of_triangles
        As for :func:`distance`.

    Returns
    -------
    NearestSources
        `distance` (n,) and `source` (n,); of equally near sources, the first one.

    Examples
    --------
    >>> from surfacediffusion import nearest_sources
    >>> strip = ([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]],
    ...          [[0, 1, 4, 3], [1, 2, 5, 4]])
    >>> nearest_sources(strip, [0, 5]).source
    array([0, 0, 1, 0, 1, 1])
    """
    return _march(surface, sources, start, _Speeds(speed, directions, along_speed, across_speed), mask,
                  True, progress, refine_to, maximum_number_of_triangles)


class _Speeds(NamedTuple):
    """The arguments of speeds as they are given."""

    speed: Any = None
    directions: Any = None
    along: Any = 1.0
    across: Any = 1.0


def _march(
    surface: SurfaceLike, sources: Any, start: Any, speeds: _Speeds, mask: Any, apart: bool,
    progress: Progress, refine_to: float, limit: int
) -> NearestSources:
    _, fronts, (rows, barycentric) = _prepare(surface, sources, speeds, mask, refine_to, limit)
    times = np.zeros(len(rows)) if start is None else np.asarray(
        as_numbers("start", start), dtype=np.float64).reshape(-1)
    if times.shape != rows.shape or not np.isfinite(times).all():
        raise ValueError(f"start is {shorten(start)}; allowed: {len(rows)} finite numbers, one per "
                         "source")
    with ProgressReporter(progress) as reporter:
        found, source = fronts.from_all(
            rows, barycentric, np.ascontiguousarray(times), apart, reporter.callable)
        reporter.finish_part()
    return NearestSources(found, source.astype(np.int64))


def distances(
    surface: SurfaceLike,
    sources: ArrayLike | None = None,
    *,
    cutoff: float = np.inf,
    speed: ArrayLike | None = None,
    directions: ArrayLike | None = None,
    along_speed: float = 1.0,
    across_speed: float = 1.0,
    mask: ArrayLike | None = None,
    progress: Progress = None,
) -> Any:
    """The distances from each of several points to all points that are no farther than `cutoff`, by
    the method of :func:`distance`. The memory is that of the result.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface.
    sources : array_like of int, shape (k,), optional
        Points of the surface, by their rows; by default all points that faces use.
    cutoff : float, above 0
        In the unit of the coordinates, or of time.
    speed, directions, along_speed, across_speed, mask, progress
        As for :func:`distance`.

    Returns
    -------
    scipy.sparse.csr_array, shape (k, n)
        One row per source. Entries that are not stored are farther than `cutoff`, or not reached;
        the distance 0 of the source from itself is stored.

    Raises
    ------
    ImportError
        If scipy is not installed.

    Examples
    --------
    >>> from surfacediffusion import distances, sphere
    >>> near = distances(sphere(4, radius=100.0), [0, 7], cutoff=10.0)
    >>> near.shape, bool(near.data.max() <= 10.0)
    ((2, 2562), True)
    """
    sparse = import_sparse("distances")
    surface = as_surface(surface)
    if isinstance(cutoff, bool) or not isinstance(
            cutoff, (int, float, np.number)) or not cutoff > 0.0:
        raise ValueError(f"cutoff is {shorten(cutoff)}; allowed: numbers above 0")
    if sources is None:
        marked = as_flags("mask", mask)
        faces = surface.triangles
        if marked is not None and len(marked) == surface.n_points:
            faces = faces[(marked[faces] == 0).all(axis=1)]
        sources = np.unique(faces)
    rows = _as_rows(surface, sources)
    fronts = _make_fronts(surface, _Speeds(speed, directions, along_speed, across_speed), mask)
    _require_points(fronts, rows)
    with ProgressReporter(progress) as reporter:
        entries = fronts.from_each(rows, float(cutoff), reporter.callable)
        reporter.finish_part()
    return sparse.csr_array(entries, shape=(len(rows), surface.n_points))


def _prepare(
    surface: SurfaceLike, sources: Any, speeds: _Speeds, mask: Any, refine_to: float, limit: int
) -> tuple[Surface, Any, tuple[NDArray[np.int64], NDArray[np.float64] | None]]:
    """The surface, refined if that is asked for, the fronts on it, and the sources: rows of points, or of
    triangles with barycentric coordinates."""
    given = as_surface(surface)
    rows: NDArray[np.int64] | None = None
    barycentric: NDArray[np.float64] | None = None
    places: NDArray[np.float64] | None = None
    if isinstance(sources, tuple) and len(sources) == 2 and _count_axes(sources[1]) == 2:
        rows, barycentric = _as_places_in_triangles(given, *sources)
    elif _count_axes(sources) == 2:
        places = np.ascontiguousarray(as_numbers("sources", sources), dtype=np.float64)
        if places.shape[1] != 3 or len(places) == 0 or not np.isfinite(places).all():
            raise ValueError(f"sources is {shorten(sources)}; allowed: finite coordinates, (k, 3)")
    else:
        rows = _as_rows(given, sources)
    surface, carried, _ = take_along(given, "distance", refine_to, limit, {
        "mask": mask, "speed": speeds.speed, "directions": speeds.directions})
    fronts = _make_fronts(surface, speeds._replace(speed=carried["speed"],
                                                   directions=carried["directions"]), carried["mask"])
    if barycentric is not None and surface is not given:  # other triangles, in the same planes
        places = np.einsum("ki,kij->kj", barycentric, given.points[given.triangles[rows]])
    if places is not None:
        rows, flat, farness = fronts.project(places, None)
        if farness:
            warn([farness])
        barycentric = flat.reshape(-1, 3)
        if (rows < 0).any():
            raise ValueError(f"sources has {places[rows < 0][0].tolist()}, which is nearest to a face "
                             "that is masked or a barrier; allowed: places near others")
    assert rows is not None
    if barycentric is None:
        _require_points(fronts, rows)
    else:
        for k, row in enumerate(rows):
            if not fronts.has_triangle(int(row)):
                raise ValueError(f"sources has in row {k} a face that is masked, or a barrier, or has no "
                                 "area; allowed: other faces")
    return surface, fronts, (rows, barycentric)


def _count_axes(values: Any) -> int:
    try:
        return np.ndim(values)
    except ValueError:  # rows of different lengths
        return 0


def _as_rows(surface: Surface, sources: Any) -> NDArray[np.int64]:
    rows = np.atleast_1d(as_numbers("sources", sources))
    if rows.ndim != 1 or rows.size == 0 or rows.dtype.kind not in "iu":
        raise ValueError(f"sources is {shorten(sources)}; allowed: rows of points, one or more "
                         "integers; coordinates, (k, 3); or faces with barycentric coordinates")
    outside = (rows < 0) | (rows >= surface.n_points)
    if outside.any():
        raise ValueError(f"sources has {rows[outside][0]}; allowed: 0 to {surface.n_points - 1}, the "
                         "rows of points")
    return np.ascontiguousarray(rows, dtype=np.int64)


def _as_places_in_triangles(
    surface: Surface, faces: Any, barycentric: Any
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Rows of surface.triangles, and barycentric coordinates."""
    rows = np.atleast_1d(as_numbers("sources[0]", faces))
    if rows.ndim != 1 or rows.size == 0 or rows.dtype.kind not in "iu":
        raise ValueError(f"sources[0] is {shorten(faces)}; allowed: rows of faces, one or more integers")
    outside = (rows < 0) | (rows >= surface.n_faces)
    if outside.any():
        raise ValueError(f"sources[0] has {rows[outside][0]}; allowed: 0 to {surface.n_faces - 1}, the "
                         "rows of faces")
    weights = np.ascontiguousarray(as_numbers("sources[1]", barycentric), dtype=np.float64)
    if weights.shape != (len(rows), 3):
        raise ValueError(f"sources[1] has shape {weights.shape}; allowed: ({len(rows)}, 3), one row per "
                         "face")
    bad = ~((weights >= 0.0).all(axis=1) & (np.abs(weights.sum(axis=1) - 1.0) <= 1e-6))
    if bad.any():
        row = int(np.argmax(bad))
        raise ValueError(f"sources[1] is {weights[row].tolist()} in row {row}; allowed: three numbers, 0 "
                         "or more, whose sum is 1")
    sizes = np.diff(surface._offsets)
    polygons = sizes[rows] != 3
    if polygons.any():
        raise ValueError(f"sources[0] has face {rows[polygons][0]} with {sizes[rows[polygons][0]]} points; "
                         "allowed: triangles, or coordinates in place of faces")
    first = np.concatenate([[0], np.cumsum(sizes - 2)])
    return np.ascontiguousarray(first[rows], dtype=np.int64), weights


def _make_fronts(surface: Surface, speeds: _Speeds, mask: Any) -> Any:
    """The fronts on a surface, and the factors of the heat method, which it keeps for other sources."""
    sizes = (surface.n_points, surface.n_faces)
    flags, on_faces = find_mask(mask, sizes)
    for name, factor in (("along_speed", speeds.along), ("across_speed", speeds.across)):
        check_positive(name, factor)
    directions, directions_on_faces = None, False
    if speeds.directions is not None:
        directions, directions_on_faces = as_directions("directions", speeds.directions, sizes)
    elif speeds.along != speeds.across:
        raise ValueError(f"along_speed is {speeds.along} and across_speed is {speeds.across} but "
                         "directions is not set; allowed: equal values, or directions")
    slowness = _as_slowness(surface, speeds.speed)
    contents = hashlib.blake2b(repr((speeds.along, speeds.across, directions_on_faces)).encode())
    for array in (flags, slowness, directions):
        contents.update(b"-" if array is None else repr(array.shape).encode() + array.tobytes())
    with surface._lock:
        version, fronts = surface._runs.get("distance", (b"", None))
        if version != contents.digest():
            fronts = _core.Distances(surface._core, flags, on_faces, slowness, directions,
                                     directions_on_faces, float(speeds.along), float(speeds.across), None)
            surface._runs["distance"] = contents.digest(), fronts
    warn_of_seams(fronts, "no way leads from one to the other")
    return fronts


def _require_points(fronts: Any, rows: NDArray[np.int64]) -> None:
    for row in rows:
        if not fronts.has_point(int(row)):
            raise ValueError(f"sources has point {row}, which no face uses that is not masked and "
                             "has an area; allowed: points of the surface")


def _as_slowness(surface: Surface, speed: Any) -> NDArray[np.float64] | None:
    """1 / speed of each face; None stays."""
    if speed is None:
        return None
    array = np.asarray(as_numbers("speed", speed), dtype=np.float64)
    on_faces = find_place("speed", speed, (surface.n_points, surface.n_faces), "number", False)
    bad = ~(np.isfinite(array) & (array >= 0.0))
    if bad.any():
        row = int(np.argmax(bad))
        raise ValueError(f"speed is {array[row]} in row {row}; allowed: finite numbers, 0 or more")
    if not on_faces:
        sums = np.add.reduceat(array[surface._connectivity], surface._offsets[:-1])
        array = sums / np.diff(surface._offsets)
    with np.errstate(divide="ignore"):
        slowness: NDArray[np.float64] = 1.0 / array
    return slowness
