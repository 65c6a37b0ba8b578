# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Distances along surfaces, and the arrival times of fronts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._functions import run_once
from ._models import ARRAYS
from ._operators import import_sparse
from ._refinement import MAXIMUM_TRIANGLES, interpolate_points, take_along
from ._run import Input, Progress, ProgressReporter, Runner, warn
from ._settings import as_number, as_switch, settings_of, shorten
from ._surface import Surface, SurfaceLike, as_factors, as_numbers, as_surface, find_place, left_out, require_shape

__all__ = ["NearestSources", "distance", "distances", "nearest_sources"]


class _Nearest(NamedTuple):
    distance: NDArray[np.float64]
    source: NDArray[np.int64]


class NearestSources(_Nearest):
    """Distances from the nearest of several sources, and which one that is: a pair."""

    distance: NDArray[np.float64]  #: (n,), in the unit of the coordinates, or of time
    source: NDArray[np.int64]  #: (n,), the row of `sources`; -1 where the distance is infinite
    method: str = ""  #: that found them: "Exact", "Eikonal" or "Heat"
    _name = ""  #: of the distances in VTK


def distance(
    surface: SurfaceLike,
    sources: ArrayLike,
    *,
    start: ArrayLike | None = None,
    speed: ArrayLike | None = None,
    directions: ArrayLike | None = None,
    along_speed: float | ArrayLike = 1.0,
    across_speed: float | ArrayLike = 1.0,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    method: str = "Automatic",
    maximum_distance: float = 0.0,
    signed: bool = False,
    merge_coincident_points: bool = False,
    merge_tolerance: float = 0.0,
    progress: Progress = None,
    refine_to: float = 0.0,
    maximum_number_of_triangles: int = MAXIMUM_TRIANGLES,
) -> NDArray[np.float64]:
    """The distance along a surface from the nearest source, or with `speed` the time at which
    fronts from the sources arrive: |grad T| = 1 / speed, T = `start` at the sources. With directions
    e1, and e2 across them in the tangent plane, grad T . D grad T = 1 with
    D = speed^2 (along_speed^2 e1 e1^T + across_speed^2 e2 e2^T).

    Each source counts for itself: the distance is the smallest of those from each alone. With speeds,
    points that are neighbours on the surface are one source, whose front is plane between them.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface. Ways go over edges of any number of faces, and not beyond boundaries.
    sources : int, array_like of shape (k,), (n,) or (k, 3), or tuple (faces, barycentric)
        Points of the surface, by their rows; or bool, True at the points that are sources; or
        coordinates, (k, 3), which stand for the nearest places of the surface; or places in triangles,
        by the rows of these faces, (k,), and barycentric coordinates, (k, 3). Those that no face uses,
        or that are masked or barriers, do not count, with a warning.
    start : array_like, shape (k,), optional
        The times at the sources, by default 0.
    speed : array_like, shape (m,) or (n,), optional
        The speed of fronts on each face, in the unit of the coordinates per unit of time, finite
        and 0 or more, or at each point: on a triangle that of its corners on average. Faces of speed 0
        are barriers.
    directions : array_like, shape (n, 3) or (m, 3), optional
        Directions e1 at points or on faces, of any length and sign; zero or NaN is none, and fronts
        have the geometric mean of both speeds there.
    along_speed, across_speed : float, above 0, or array_like, shape (m,) or (n,), 0 or more, default 1
        Factors of the speed along the directions and across them. Faces where both are 0, or one of
        them without a direction, are barriers. A factor below a thousandth of the other one counts as
        that: where only one of them is 0, fronts all but do not cross in its direction.
    mask : array_like, shape (n,) or (m,), optional
        Nonzero leaves a point with its faces, or a face, out: a barrier, too.
    roi : array_like, shape (n,) or (m,), optional
        The region of interest, the opposite of a mask and in place of one: zero and NaN are left out.
    method : {"Automatic", "Exact", "Eikonal", "Heat"}, or in snake_case
        Automatic: Exact where it takes at most a second, without speeds and start times, and Eikonal
        otherwise; :func:`nearest_sources` says which. Exact: the lengths of the shortest ways over the
        faces, to round-off. Eikonal: fast marching, which lays out the way from the source in the plane
        of each triangle, on the intrinsic Delaunay triangulation or, with speeds, on the faces; where
        faces are few, their edges are bisected for it. On an icosphere of 10,242 points the mean error
        is 0.06 to 0.09 % of the largest distance. Heat: the heat method with the step 1.1 h^2, where h
        is the mean edge length: smooth level sets, an error of 0.31 % on that sphere, and neither
        `start` nor speeds.
    maximum_distance : float, 0 or more, default 0
        Coordinates in `sources` that are farther from the surface do not count. 0: any distance.
    signed : bool, default False
        Whether the distance is below 0 on one side. Of a region, `sources` of type bool or rows of its
        points: that from its boundary, a smooth line between its points and those around it, below 0
        within.
        Of a closed curve, coordinates (k, 3): that from the shortest paths between one place and the
        next and back to the first, as of :func:`path_through`, below 0 on the side of the smaller area.
        Without speeds and start times.
    merge_coincident_points : bool, default False
        Whether points within `merge_tolerance`, default 0, of each other are one point of the surface.
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
        Without any source that counts; with the methods Heat and Exact and `start` or speeds; with
        `signed` and a curve that does not divide the surface into two sides.

    References
    ----------
    J. S. B. Mitchell, D. M. Mount, C. H. Papadimitriou, The discrete geodesic problem, SIAM J. Comput.
    16(4), 1987, 647-668.
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
    return nearest_sources(**locals()).distance


def nearest_sources(
    surface: SurfaceLike,
    sources: ArrayLike,
    *,
    start: ArrayLike | None = None,
    speed: ArrayLike | None = None,
    directions: ArrayLike | None = None,
    along_speed: float | ArrayLike = 1.0,
    across_speed: float | ArrayLike = 1.0,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    method: str = "Automatic",
    maximum_distance: float = 0.0,
    signed: bool = False,
    merge_coincident_points: bool = False,
    merge_tolerance: float = 0.0,
    progress: Progress = None,
    refine_to: float = 0.0,
    maximum_number_of_triangles: int = MAXIMUM_TRIANGLES,
) -> NearestSources:
    """The distance from the nearest source, and the row of this source.

    Parameters
    ----------
    surface, sources, start, speed, directions, along_speed, across_speed, mask, roi, method, \
maximum_distance, signed, merge_coincident_points, merge_tolerance, progress, refine_to, maximum_number_of_triangles
        As for :func:`distance`. With the method Heat, the sources are those of Automatic.

    Returns
    -------
    NearestSources
        `distance` (n,) and `source` (n,), a pair, and `method`, the one that found them. Of equally near
        sources, the first one. Of a bool array of sources, `source` is the point.

    Examples
    --------
    >>> from surfacediffusion import nearest_sources
    >>> strip = ([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]],
    ...          [[0, 1, 4, 3], [1, 2, 5, 4]])
    >>> nearest_sources(strip, [0, 5]).source
    array([0, 0, 1, 0, 1, 1])
    """
    given = as_surface(surface)
    marked, rows, places = _as_sources(given, sources)
    times = _as_times(start, len(rows if places is None else places))
    factors, arrays = _split_factors(along_speed=along_speed, across_speed=across_speed)
    surface, carried, fine = take_along(given, "distance", refine_to, maximum_number_of_triangles, {
        "mask": mask, "roi": roi, "speed": speed, "directions": directions, **arrays})
    names = rows if marked else np.arange(len(rows if places is None else places))
    if fine is not None and places is None:  # between two sources is one
        of_points = np.zeros((2, given.n_points))
        of_points[0, rows] = np.arange(1, len(rows) + 1)
        of_points[1, rows] = 0.0 if times is None else times
        marks = interpolate_points(of_points[0], fine.parents, _core.PointRole.Mark)[given.n_points:]
        added = np.flatnonzero(marks)
        names = np.append(names, names[marks[added].astype(int) - 1])
        if times is not None:
            times = np.append(times, fine.at_points(of_points[1])[given.n_points + added])
        rows = np.append(rows, given.n_points + added)
    elif fine is not None and rows is not None:  # other triangles, the same planes
        rows, places = None, np.einsum("ki,kij->kj", places, given.points[given.triangles[rows]])
    segments = None
    if as_switch("signed", signed) and places is not None:
        if rows is not None or len(places) < 3:
            raise ValueError(f"sources is {shorten(sources)}; allowed with signed=True: flags or rows of the "
                             "points of a region, or coordinates of three or more places along a closed curve")
        one = np.arange(len(places))
        segments = np.column_stack([one, np.roll(one, -1)]).reshape(-1)
    inputs = _make_input(surface, **carried)
    inputs.core.set_sources(places, segments, None, rows, times)
    outputs, _ = run_once("distance", inputs, {
        "method": method, **factors, "maximum_distance": maximum_distance, "signed": signed,
        "merge_coincident_points": merge_coincident_points, "merge_tolerance": merge_tolerance}, _ARRAYS, progress)
    found = {output.name: output.values for output in outputs}
    source = found["NearestSource"].astype(np.int64)
    source = np.where(source < 0, -1, names[source])
    name = "ArrivalTime" if "ArrivalTime" in found else "Distance"
    nearest = NearestSources(found[name], source)
    nearest._name = name
    nearest.method = settings_of("distance")["method"].words[int(found["EffectiveMethod"])]
    return nearest


def distances(
    surface: SurfaceLike,
    sources: ArrayLike | None = None,
    *,
    cutoff: float = np.inf,
    speed: ArrayLike | None = None,
    directions: ArrayLike | None = None,
    along_speed: float | ArrayLike = 1.0,
    across_speed: float | ArrayLike = 1.0,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    method: str = "Automatic",
    merge_coincident_points: bool = False,
    merge_tolerance: float = 0.0,
    progress: Progress = None,
) -> Any:
    """The distances from each of several points to all points that are no farther than `cutoff`. The
    memory is that of the result.

    The matrix from all points to all points is symmetric: to round-off with the method Exact. With Eikonal, by
    which a way and the way back have different errors, it has their means, or the one within the cutoff; rows of
    given sources have what was found from them.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface.
    sources : array_like of int, shape (k,), or of bool, shape (n,), optional
        Points of the surface, by their rows, or True at them; by default all points.
    cutoff : float, above 0
        In the unit of the coordinates, or of time.
    method : {"Automatic", "Exact", "Eikonal"}, or in snake_case
        As for :func:`distance`. Automatic: Exact where all rows together take at most a second.
    speed, directions, along_speed, across_speed, mask, roi, merge_coincident_points, merge_tolerance, \
progress
        As for :func:`distance`.

    Returns
    -------
    scipy.sparse.csr_array, shape (k, n)
        One row per source. Entries that are not stored are farther than `cutoff`, or not reached;
        the distance 0 of the source from itself is stored. Rows of points that no face uses are empty.

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
    cutoff = as_number("cutoff", cutoff, "numbers above 0", lambda number: number > 0.0)
    rows: Any = None
    if sources is not None:
        _, rows, places = _as_sources(surface, sources)
        if places is not None:
            raise ValueError(f"sources is {shorten(sources)}; allowed: rows of points, or flags")
    factors, arrays = _split_factors(along_speed=along_speed, across_speed=across_speed)
    entries = find_each(surface, rows, cutoff, {
        "method": method, **factors, "merge_coincident_points": merge_coincident_points,
        "merge_tolerance": merge_tolerance}, progress, mask=mask, roi=roi, speed=speed, directions=directions,
        **arrays)
    found = sparse.csr_array(entries, shape=(len(entries[2]) - 1, surface.n_points))
    return found if rows is not None else _means_with_transposed(found)


def find_each(surface: Surface, rows: Any, cutoff: float, properties: dict[str, Any], progress: Progress,
              **arrays: Any) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Data, columns and starts of rows of distances(), without scipy."""
    inputs = _make_input(surface, **arrays)
    runner = Runner("distance", properties, _ARRAYS)
    with surface._lock, ProgressReporter(progress) as reporter:
        run = surface._runs.setdefault("distance", _core.SurfaceRuns("distance"))
        entries: tuple[NDArray[Any], NDArray[Any], NDArray[Any]] = runner.call(
            run.find_each, inputs.core, runner.settings, rows, cutoff, reporter.callable)
        sentences = runner.warnings(run)
        reporter.finish_part()
    warn(sentences)
    return entries


def _means_with_transposed(matrix: Any) -> Any:
    """The means of the entries ij and ji, or the one of them that is stored, if they differ beyond round-off.
    Zeros stay stored."""
    if not matrix.nnz or abs(matrix - matrix.T).max() <= 1e-12 * matrix.data.max():
        return matrix
    counts = matrix.copy()
    counts.data = np.ones_like(matrix.data)
    counts = counts + counts.T
    one = matrix.copy()
    one.data = matrix.data + 1.0  # no zero, which a sum would forget
    total = (one + one.T).tocsr()
    counts = counts.tocsr()
    for sums in (total, counts):
        sums.sort_indices()
    total.data = total.data / counts.data - 1.0
    return total


#: The keywords of input arrays, by their names in messages.
_ARRAYS = {**ARRAYS, "SourceArray": "sources", "SourceTimes": "start", "SpeedArray": "speed",
           "AlongSpeedArray": "along_speed", "AcrossSpeedArray": "across_speed"}


def _split_factors(**given: Any) -> tuple[dict[str, Any], dict[str, Any]]:
    """The numbers, and the arrays."""
    arrays = {name: values for name, values in given.items() if _count_axes(values) > 0}
    return {name: value for name, value in given.items() if name not in arrays}, arrays


def _make_input(surface: Surface, *, mask: Any, roi: Any, directions: Any, **speeds: Any) -> Input:
    """speeds: speed, along_speed and across_speed, those that are arrays."""
    inputs = Input(surface, mask=left_out(mask, roi, surface), directions=directions)
    for name, values in speeds.items():
        if values is not None:
            on_faces = find_place(name, values, (surface.n_points, surface.n_faces), "number", False)
            inputs.core.set(name + "s", as_factors(name, values), on_faces)
    return inputs


def _as_times(start: Any, count: int) -> NDArray[np.float64] | None:
    if start is None:
        return None
    times = np.ascontiguousarray(as_numbers("start", start), dtype=np.float64).reshape(-1)
    if times.shape != (count,) or not np.isfinite(times).all():
        raise ValueError(f"start is {shorten(start)}; allowed: {count} finite numbers, one per source")
    return times


def _as_sources(surface: Surface, sources: Any) -> tuple[bool, Any, Any]:
    """Whether the sources are flags; rows of points, or of triangles with barycentric coordinates; or
    none, with coordinates."""
    if isinstance(sources, tuple) and len(sources) == 2 and _count_axes(sources[1]) == 2:
        return (False, *_as_places_in_triangles(surface, *sources))
    if _count_axes(sources) == 2:
        places = np.ascontiguousarray(as_numbers("sources", sources), dtype=np.float64)
        if places.shape[1] != 3 or len(places) == 0 or not np.isfinite(places).all():
            raise ValueError(f"sources is {shorten(sources)}; allowed: finite coordinates, (k, 3)")
        return False, None, places
    marks = np.asarray(sources) if _count_axes(sources) == 1 else None
    if marks is not None and marks.dtype == bool:
        if marks.shape != (surface.n_points,) or not marks.any():
            raise ValueError(f"sources is {shorten(sources)}; allowed: {surface.n_points} flags, one per "
                             "point, at least one of them True")
        return True, np.flatnonzero(marks), None
    return False, _as_rows("sources", sources, surface.n_points, "points", (
        "; flags, one per point; coordinates, (k, 3); or faces with barycentric coordinates")), None


def _count_axes(values: Any) -> int:
    try:
        return np.ndim(values)
    except ValueError:  # rows of different lengths
        return 0


def _as_rows(name: str, values: Any, count: int, what: str, also: str = "") -> NDArray[np.int64]:
    rows = np.atleast_1d(as_numbers(name, values))
    if rows.ndim != 1 or rows.size == 0 or rows.dtype.kind not in "iu":
        raise ValueError(f"{name} is {shorten(values)}; allowed: rows of {what}, one or more integers{also}")
    outside = (rows < 0) | (rows >= count)
    if outside.any():
        raise ValueError(f"{name} has {rows[outside][0]}; allowed: 0 to {count - 1}, the rows of {what}")
    return np.ascontiguousarray(rows, dtype=np.int64)


def _as_places_in_triangles(
    surface: Surface, faces: Any, barycentric: Any, name: str = "sources"
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Rows of surface.triangles, and barycentric coordinates."""
    rows = _as_rows(f"{name}[0]", faces, surface.n_faces, "faces")
    weights = np.ascontiguousarray(as_numbers(f"{name}[1]", barycentric), dtype=np.float64)
    require_shape(f"{name}[1]", weights, weights.shape == (len(rows), 3), f"({len(rows)}, 3), one row per face")
    bad = ~((weights >= 0.0).all(axis=1) & (np.abs(weights.sum(axis=1) - 1.0) <= 1e-6))
    if bad.any():
        row = int(np.argmax(bad))
        raise ValueError(f"{name}[1] is {weights[row].tolist()} in row {row}; allowed: three numbers, 0 "
                         "or more, whose sum is 1")
    sizes = np.diff(surface._offsets)
    polygons = sizes[rows] != 3
    if polygons.any():
        raise ValueError(f"{name}[0] has face {rows[polygons][0]} with {sizes[rows[polygons][0]]} points; "
                         "allowed: triangles, or coordinates in place of faces")
    first = np.concatenate([[0], np.cumsum(sizes - 2)])
    return np.ascontiguousarray(first[rows], dtype=np.int64), weights
