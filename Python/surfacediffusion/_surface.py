# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces, and the checks of arrays."""

from __future__ import annotations

import os
import threading
import weakref
from typing import Any, Protocol, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._connectivity import as_polygons
from ._settings import as_integer, as_number, as_switch, shorten

_NUMBERS = "biuf"  #: kinds of numpy types: bool, integer, unsigned integer, float


def as_numbers(name: str, values: Any) -> NDArray[Any]:
    """An array of numbers. Masked entries are NaN. ValueError if it is none."""
    try:
        if isinstance(values, np.ma.MaskedArray):
            return values.astype(float).filled(np.nan)
        array = np.asarray(values)
    except (ValueError, TypeError):
        raise ValueError(f"{name} is {shorten(values)}; allowed: an array of numbers") from None
    if array.dtype.kind not in _NUMBERS:
        raise ValueError(f"{name} has elements of type {array.dtype}; allowed: real numbers")
    return array


def require_shape(name: str, array: Any, fits: bool, allowed: str) -> None:
    """ValueError unless the shape of an array fits."""
    if not fits:
        raise ValueError(f"{name} has shape {np.shape(array)}; allowed: {allowed}")


class Placed(np.ndarray):  # type: ignore[type-arg,unused-ignore]  # numpy 1.21 takes no arguments
    """An array that is known to be on points or on faces, of which there may be as many. What is computed
    from it has no known place."""

    on_faces: bool | None = None


def place(array: Any, on_faces: bool) -> Placed:
    """The array at a known place."""
    placed = np.asarray(array).view(Placed)
    placed.on_faces = on_faces
    return placed


def on_points(array: ArrayLike) -> NDArray[Any]:
    """The same array, known to be on points.

    Arrays are on points or faces by their number of rows. Where a surface has as many points as faces,
    this and :func:`on_faces` say which, of directions, hints, masks, weights and speeds. What is
    computed from the array has no known place.

    Examples
    --------
    >>> from surfacediffusion import Surface, direction_field, on_faces
    >>> tetrahedron = Surface([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    ...                       [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    >>> hints = [[1, 0, 0]] + 3 * [[0, 0, 0]]
    >>> direction_field(tetrahedron, on_faces(hints), method="Hints").shape
    (4, 3)
    """
    return place(array, False)


def on_faces(array: ArrayLike) -> NDArray[Any]:
    """The same array, known to be on faces: see :func:`on_points`."""
    return place(array, True)


def known_place(values: Any) -> bool | None:
    """Whether values are on faces, if that is known."""
    return values.on_faces if isinstance(values, Placed) else None


def find_place(name: str, values: Any, sizes: tuple[int, int], what: str, on_faces: bool) -> bool:
    """Whether numbers in one dimension are on faces. sizes: the numbers of points and of faces.
    on_faces: the answer if these are equal and the values have no known place."""
    n, m = sizes
    shape = np.shape(values)
    require_shape(name, values, shape in ((n,), (m,)), f"({n},), one {what} per point, or ({m},), one per face")
    known = known_place(values)
    return (on_faces if known is None else known) if n == m else shape[0] == m


def as_directions(
    name: str, values: Any, sizes: tuple[int, int]
) -> tuple[NDArray[np.float64], bool]:
    """Directions on points or faces, and whether they are on faces: by their number unless known."""
    n, m = sizes
    array, on_faces = as_numbers(name, values), known_place(values)
    require_shape(name, array, array.shape in ((n, 3), (m, 3)),
                  f"({n}, 3), one row per point, or ({m}, 3), one row per face")
    if n == m and on_faces is None:
        raise ValueError(f"{name} has one row per point and per face, of which there are {n} each; "
                         f"allowed: on_points({name}) or on_faces({name})")
    return (np.ascontiguousarray(array, dtype=np.float64),
            array.shape[0] == m if on_faces is None else on_faces)


def as_flags(name: str, values: Any, points: int | None = None) -> NDArray[np.uint8] | None:
    """Flags, nonzero is set, one per point if their number is given; None stays."""
    if values is None:
        return None
    array = np.ma.getdata(as_numbers(name, values))
    require_shape(name, array, points is None or array.shape == (points,), f"({points},), one flag per point")
    return np.ascontiguousarray(array != 0, dtype=np.uint8)


def find_mask(mask: Any, sizes: tuple[int, int]) -> tuple[NDArray[np.uint8] | None, bool]:
    """The flags of a mask, and whether they are on faces. sizes: the numbers of points and of faces."""
    flags = as_flags("mask", mask)
    return flags, flags is not None and find_place("mask", mask, sizes, "flag", False)


def as_outside(roi: Any, *sizes: int) -> NDArray[np.bool_]:
    """The mask of the outside of a region of interest, which has one of these sizes, at its place."""
    array = np.ma.getdata(as_numbers("roi", roi))
    if array.shape not in [(size,) for size in sizes]:
        allowed = " or ".join(f"({size},)" for size in sizes)
        raise ValueError(f"roi has shape {array.shape}; allowed: {allowed}, one flag per point"
                         + (" or face" if len(sizes) > 1 else ""))
    if not ((array != 0) & ~np.isnan(array)).any():
        raise ValueError("roi is 0 everywhere; allowed: nonzero in the region of interest")
    outside: NDArray[np.bool_] = (array == 0) | np.isnan(array)
    known = known_place(roi)
    return outside if known is None else place(outside, known)


def left_out(mask: Any, roi: Any, surface: Surface, faces: bool = True) -> Any:
    """The mask, or that of the outside of the region of interest in place of one. faces: whether it may be
    on faces."""
    if roi is None:
        return mask
    if mask is not None:
        raise ValueError("mask and roi are both given; allowed: one of them")
    return as_outside(roi, surface.n_points, *[surface.n_faces] * faces)


def as_factors(name: str, values: Any) -> NDArray[np.float64] | None:
    """Numbers; None stays."""
    if values is None:
        return None
    return np.ascontiguousarray(as_numbers(name, values), dtype=np.float64)


def as_data(name: str, values: Any, points: int, row_name: str = "point") -> NDArray[Any]:
    """The data as float64, float32 or uint8, with one row per point (or face: `row_name`) and one
    column per component."""
    array = as_numbers(name, values)
    require_shape(name, array, array.ndim in (1, 2) and array.shape[0] == points and array.size > 0,
                  f"({points},) or ({points}, k), one row per {row_name}")
    kept = array.dtype.kind == "f" and array.dtype.itemsize == 4
    dtype: Any = np.float32 if kept else np.uint8 if array.dtype == np.uint8 else np.float64
    return np.ascontiguousarray(array.reshape(points, -1), dtype=dtype)


def find_on_faces(name: str, values: Any, surface: Surface, on_faces: bool | None) -> bool:
    """Whether data are on faces: as `on_faces` says, or if their number is that of the faces and not
    that of the points."""
    if on_faces is not None:
        return as_switch("on_faces", on_faces, "True, False or None")
    array, n, m = as_numbers(name, values), surface.n_points, surface.n_faces
    require_shape(name, array, array.ndim in (1, 2) and array.shape[0] in (n, m) and array.size > 0,
                  f"({n},) or ({n}, k), one row per point, or ({m},) or ({m}, k), one row per face")
    return bool(array.shape[0] != n or (n == m and known_place(values)))


def data_components(array: NDArray[Any]) -> int:
    """The number of components without the alpha of colours."""
    columns = int(array.shape[1])
    return columns - 1 if array.dtype == np.uint8 and columns in (2, 4) else columns


def check_areas(name: str, areas: Any, used: NDArray[np.bool_]) -> NDArray[np.float64]:
    """A copy of given areas of points. used: those that must be above 0."""
    given = np.array(as_numbers(name, areas), dtype=np.float64)
    require_shape(name, given, given.shape == used.shape, f"({len(used)},), one per point")
    wrong = used & ~(np.isfinite(given) & (given > 0))
    if wrong.any():
        row = int(np.argmax(wrong))
        raise ValueError(f"{name} has {given[row]} at point {row}; allowed: finite numbers above 0")
    return given


def _as_points(points: Any) -> NDArray[np.float64]:
    array = as_numbers("points", points)
    require_shape("points", array, array.shape[1:] == (3,) and len(array) > 0, "(n, 3) with n > 0")
    return np.array(array, dtype=np.float64, order="C")


_surfaces: weakref.WeakSet[Surface] = weakref.WeakSet()
_of_lost_threads: list[Any] = []  #: what they may have changed by half is neither used nor freed


def _renew_after_fork() -> None:
    """In a forked process, threads of the parent that were at work on a surface have left it locked."""
    for surface in list(_surfaces):
        if surface._lock.acquire(blocking=False):
            surface._lock.release()
            continue
        _of_lost_threads.append(surface._runs)
        surface._lock, surface._runs = threading.RLock(), {}


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_renew_after_fork)


class Surface:
    """A triangulated surface, which keeps its mesh, ordering and factors between calls.

    Functions take a surface as this, as a tuple (points, faces), or as a mesh of nilearn
    (``.coordinates``, ``.faces``), trimesh (``.vertices``, ``.faces``), LaPy (``.v``, ``.t``), PyVista or
    `surfacediffusion.files` (``.points``, ``.faces``). All but this are converted at each call.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Coordinates in any unit of length, all finite. They are copied.
    faces : array_like of int, shape (m, 3) or (m, k), or sequence of sequences
        Rows of `points` of each triangle or polygon. Quadrilaterals are cut along the
        shorter diagonal that lies inside, larger polygons by ear cutting. The surface may have
        several components, boundaries, edges with more than two triangles, and points without
        triangle. Rows of an array may be padded at their ends, as in files of UGRID: by -1 or another
        negative number, by a number of at least 999999 that is no point, by 0 if points count from 1, by
        NaN or masked entries, as xarray and netCDF4 read them, or by `fill_value`.
    areas : array_like, shape (n,), optional
        The areas of the points' control cells, above 0, in place of those of `faces` (a third of the
        triangles at each point). For an average of many surfaces, which is smaller than they are:
        the lumped mass matrix has these areas, so that widths are those on a surface with these
        areas and the angles of this one. Not with ``intrinsic_delaunay=True``.

    Examples
    --------
    >>> from surfacediffusion import Surface, heat
    >>> tetrahedron = Surface([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    ...                       [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> tetrahedron
    <Surface: 4 points, 4 faces>
    >>> heat(tetrahedron, [1.0, 0.0, 0.0, 0.0], mode="SteadyState").round(3)
    array([0.211, 0.211, 0.211, 0.211])
    """

    def __init__(
        self,
        points: ArrayLike,
        faces: ArrayLike | Sequence[Sequence[int]],
        areas: ArrayLike | None = None,
        *,
        start_index: int | None = None,
        fill_value: int | None = None,
    ) -> None:
        self._points = _as_points(points)
        self._connectivity, self._offsets = as_polygons(faces, self.n_points, start_index, fill_value)
        self._core = _core.Surface(self._points, self._connectivity, self._offsets)
        self._areas = None if areas is None else self._set_areas(areas)
        self._points.setflags(write=False)
        self._runs: dict[str, Any] = {}
        self._refined: dict[tuple[float, int], Any] = {}  # the last one
        self._lock = threading.RLock()  # of a run: one call at a time
        _surfaces.add(self)

    @classmethod
    def from_lonlat(
        cls,
        lon: ArrayLike,
        lat: ArrayLike,
        faces: ArrayLike | Sequence[Sequence[int]],
        radius: float = 6371.0,
        degrees: bool = True,
        *,
        areas: ArrayLike | None = None,
        start_index: int | None = None,
        fill_value: int | None = None,
    ) -> Surface:
        """A surface on the sphere, of longitudes and latitudes: of x = radius cos(lat) cos(lon),
        y = radius cos(lat) sin(lon), z = radius sin(lat).

        Parameters
        ----------
        lon, lat : array_like, shape (n,)
            Of the points, finite; latitudes from -90 to 90 degrees.
        faces, areas, start_index, fill_value
            As for :class:`Surface`.
        radius : float, above 0, default 6371.0
            Of the sphere: that of the Earth in kilometres, so that lengths are in kilometres.
        degrees : bool, default True
            Whether `lon` and `lat` are in degrees; otherwise in radians.

        Examples
        --------
        >>> from surfacediffusion import Surface
        >>> octant = Surface.from_lonlat([0, 90, 0], [0, 0, 90], [[0, 1, 2]])
        >>> octant.points.round(1)
        array([[6371.,    0.,    0.],
               [   0., 6371.,    0.],
               [   0.,    0., 6371.]])
        """
        angles = [as_numbers(name, angle).astype(np.float64) for name, angle in (("lon", lon), ("lat", lat))]
        require_shape("lon", lon, angles[0].ndim == 1 and angles[0].size > 0, "(n,) with n > 0")
        require_shape("lat", lat, angles[1].shape == angles[0].shape, f"{angles[0].shape}, that of lon")
        half = 90.0 if as_switch("degrees", degrees) else np.pi / 2
        for name, angle, wrong in (("lon", angles[0], ~np.isfinite(angles[0])),
                                   ("lat", angles[1], ~(np.abs(angles[1]) <= half * (1 + 1e-6)))):
            if wrong.any():
                point = int(np.argmax(wrong))
                allowed = f"{-half:.6g} to {half:.6g}, in {'degrees' if degrees else 'radians'}"
                raise ValueError(f"{name} has {angle[point]} at point {point}; allowed: "
                                 + (allowed if name == "lat" else "finite numbers"))
        phi, theta = np.radians(angles) if degrees else angles
        points = np.stack([np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), np.sin(theta)], axis=1)
        return cls(as_number("radius", radius) * points, faces, areas, start_index=start_index,
                   fill_value=fill_value)

    def _set_areas(self, areas: ArrayLike) -> NDArray[np.float64]:
        """Pass the areas on as factors of those of the triangles."""
        found = self._triangle_areas()
        used = found > 0
        given = check_areas("areas", areas, used)
        factors = np.ones(self.n_points)
        factors[used] = given[used] / found[used]
        self._core.set_area_factors(factors)
        return given

    def _areas_of_triangles(self) -> NDArray[np.float64]:
        a, b, c = (self._points[self.triangles[:, i]] for i in range(3))
        return np.asarray(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)

    def _triangle_areas(self, excluded: Any = None) -> NDArray[np.float64]:
        """A third of the triangles at each point (n,), without those of a point that is excluded."""
        triangles, area = self.triangles, self._areas_of_triangles()
        if excluded is not None:
            area[excluded[triangles].any(axis=1)] = 0.0
        return np.bincount(triangles.ravel(), np.repeat(area / 3, 3), self.n_points)

    @property
    def n_points(self) -> int:
        """The number n of points."""
        return int(self._points.shape[0])

    @property
    def n_faces(self) -> int:
        """The number m of faces."""
        return int(self._offsets.size - 1)

    @property
    def points(self) -> NDArray[np.float64]:
        """The coordinates (n, 3), read-only."""
        return self._points

    @property
    def areas(self) -> NDArray[np.float64] | None:
        """The given areas (n,); None for those of the triangles."""
        return self._areas

    @property
    def triangles(self) -> NDArray[np.int32]:
        """The triangles (t, 3) that the faces were cut into, read-only."""
        triangles: NDArray[np.int32] = self._core.triangles()
        return triangles

    @property
    def faces(self) -> NDArray[np.int64] | list[NDArray[np.int64]]:
        """The faces as given: an array (m, 3), read-only, if all are triangles, or else a list of
        arrays."""
        if (np.diff(self._offsets) == 3).all():
            triangles = self._connectivity.reshape(-1, 3)
            triangles.flags.writeable = False
            return triangles
        return np.split(self._connectivity, self._offsets[1:-1])

    @property
    def vertex_areas(self) -> NDArray[np.float64]:
        """The areas (n,) of the control cells of the points: the diagonal of the lumped mass matrix,
        also with ``intrinsic_delaunay=True``. A third of the triangles at each point, or as given by
        `areas`."""
        return self._triangle_areas() if self._areas is None else self._areas.copy()

    @property
    def area(self) -> float:
        """The area of the surface, the sum of `vertex_areas`."""
        return float(self.vertex_areas.sum())

    @property
    def normals(self) -> NDArray[np.float64]:
        """The normalised sums (n, 3) of the unit normals of the faces at each point; zero at points
        without face. Outward if faces are counter-clockwise as seen from outside."""
        normals = np.repeat(self._face_normals(), np.diff(self._offsets), axis=0)
        return sum_vectors(self._connectivity, normals, self.n_points)

    def __repr__(self) -> str:
        return f"<Surface: {self.n_points} points, {self.n_faces} faces>"

    def __reduce__(self) -> Any:
        return _restore, (self._points, self._connectivity, self._offsets, self._areas)

    def _point_normals(self) -> NDArray[np.float32]:
        """The normals of the points in single precision."""
        return self.normals.astype(np.float32)

    def _face_normals(self) -> NDArray[np.float64]:
        return unit_normals(self._points, self._connectivity, self._offsets)


def unit_normals(
    points: NDArray[np.float64], connectivity: NDArray[np.int64], offsets: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Unit normals of polygons by Newell's sum; zero for those without area."""
    sizes = np.diff(offsets)
    normals = np.zeros((len(sizes), 3))
    for size in np.unique(sizes):
        chosen = np.flatnonzero(sizes == size)
        rows = connectivity[offsets[chosen, None] + np.arange(size)]
        corners = points[rows]
        if size == 3:
            a, b = corners[:, 2] - corners[:, 1], corners[:, 0] - corners[:, 1]
            normals[chosen] = _cross(a, b)
            continue
        for i in range(size):
            at = corners[:, (i + 1) % size]
            normals[chosen] += _cross(corners[:, (i + 2) % size] - at, corners[:, i] - at)
    return normalize(normals)


def normalize(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """The vectors (n, 3), divided by their lengths in place; those of length 0 stay."""
    lengths = np.sqrt(vectors[:, 0] * vectors[:, 0] + vectors[:, 1] * vectors[:, 1]
                      + vectors[:, 2] * vectors[:, 2])
    vectors[lengths > 0] /= lengths[lengths > 0, None]
    return vectors


def sum_vectors(
    rows: NDArray[Any], vectors: NDArray[np.float64], count: int
) -> NDArray[np.float64]:
    """The normalised sums of vectors at each of `count` rows."""
    return normalize(np.stack([np.bincount(rows, column, count) for column in vectors.T], axis=1))


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.stack([a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1],
                     a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2],
                     a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]], axis=1)


def _restore(points: Any, connectivity: Any, offsets: Any, areas: Any = None) -> Surface:
    return Surface(points, np.split(connectivity, offsets[1:-1]), areas)


class _PointsAndFaces(Protocol):
    """PyVista's PolyData and SurfaceFile of surfacediffusion.files."""

    @property
    def points(self) -> Any: ...
    @property
    def faces(self) -> Any: ...


class _CoordinatesAndFaces(Protocol):
    """Meshes of nilearn."""

    @property
    def coordinates(self) -> Any: ...
    @property
    def faces(self) -> Any: ...


class _VerticesAndFaces(Protocol):
    """trimesh."""

    @property
    def vertices(self) -> Any: ...
    @property
    def faces(self) -> Any: ...


class _VerticesAndTriangles(Protocol):
    """TriaMesh of LaPy."""

    @property
    def v(self) -> Any: ...
    @property
    def t(self) -> Any: ...


SurfaceLike = Union[Surface, Tuple[ArrayLike, Any], _PointsAndFaces, _CoordinatesAndFaces,
                    _VerticesAndFaces, _VerticesAndTriangles]

#: The attributes by which packages name points and faces.
NAMES = (("points", "faces"), ("coordinates", "faces"), ("vertices", "faces"), ("v", "t"))


def as_surface(surface: Any) -> Surface:
    """A Surface, or one of a tuple (points, faces) or of a mesh of another package."""
    if isinstance(surface, Surface):
        return surface
    if isinstance(surface, (tuple, list)) and len(surface) == 2:
        return Surface(*surface)
    for points, faces in NAMES:
        if hasattr(surface, points) and hasattr(surface, faces):
            found = getattr(surface, faces)
            if np.ndim(found) == 1 and hasattr(surface, "n_strips"):
                found = _faces_of_vtk(surface)
            return Surface(getattr(surface, points), found)
    raise ValueError(f"surface is {shorten(surface)}; allowed: a Surface, a tuple (points, faces), or a "
                     "mesh of nilearn, trimesh, LaPy, PyVista or surfacediffusion.files")


def _faces_of_vtk(mesh: Any) -> Any:
    """Faces of PyVista: the number of corners before those of each face."""
    cells = np.asarray(mesh.faces)
    if mesh.n_strips or cells.size == 0:
        raise ValueError(f"surface is a mesh with {mesh.n_strips} triangle strips and "
                         f"{mesh.n_cells} cells; allowed: polygons (mesh.triangulate())")
    if cells.size % 4 == 0 and (cells[::4] == 3).all():
        return cells.reshape(-1, 4)[:, 1:]
    faces, at = [], 0
    while at < cells.size:
        faces.append(cells[at + 1:at + 1 + cells[at]])
        at += 1 + cells[at]
    return faces


def sphere(subdivisions: int = 4, radius: float = 1.0) -> Surface:
    """A sphere of 10 * 4**subdivisions + 2 points, for examples: a subdivided icosahedron.

    Parameters
    ----------
    subdivisions : int, 0 to 9
    radius : float, above 0

    Examples
    --------
    >>> from surfacediffusion import sphere
    >>> sphere(3)
    <Surface: 642 points, 1280 faces>
    """
    as_integer("subdivisions", subdivisions, 0, 9)
    as_number("radius", radius)
    g = (1.0 + 5.0**0.5) / 2.0
    points = np.array([[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g],
                       [0, -1, -g], [0, 1, -g], [g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]])
    faces = np.array([[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9],
                      [5, 11, 4], [11, 10, 2], [10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2],
                      [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10],
                      [8, 6, 7], [9, 8, 1]])
    for _ in range(subdivisions):
        edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        unique, inverse = np.unique(edges[:, 0] * len(points) + edges[:, 1], return_inverse=True)
        a, b, c = (len(points) + inverse.reshape(-1, 3)).T
        ends = np.divmod(unique, len(points))
        points = np.concatenate([points, points[ends[0]] + points[ends[1]]])
        points /= np.linalg.norm(points, axis=1)[:, None]
        i, j, k = faces.T
        faces = np.concatenate([np.stack(t, axis=1) for t in
                                ((i, a, c), (a, j, b), (c, b, k), (a, b, c))])
    points /= np.linalg.norm(points, axis=1)[:, None]
    return Surface(radius * points, faces)
