# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""vtkPolyData as arrays, and results as its arrays and points, for PyVista and ParaView. The rules are those
of the classes in C++, Filters/Conversion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import (
    VTK_FLOAT, vtkDataArray, vtkDoubleArray, vtkFloatArray, vtkIdTypeArray, vtkIntArray, vtkPoints,
    vtkTypeInt64Array, vtkUnsignedCharArray,
)
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSetAttributes, vtkPolyData

from . import _core
from ._models import Output
from ._refinement import interpolate_points
from ._surface import sum_vectors, unit_normals

HIDDEN_CELL = 32  #: the bit of cells in vtkGhostType
ABSENT = 1 | HIDDEN_CELL  #: duplicate or hidden
_HIDDEN_POINT = 2  #: the bit of points


class SurfaceError(Exception):
    """An error that the filter reports."""


def spell(words: list[Any]) -> str:
    """A sentence of the numerics in the words of VTK and ParaView."""
    return "".join(word[1] for word in words)


def say(name: str, *parts: Any) -> str:
    """The sentence of this name in the table of Filters/Run/InputSentences.cxx."""
    return spell(_core.say(name, *parts))


# Arrays ----------------------------------------------------------------------------------------


def to_numpy(array: Any) -> NDArray[Any]:
    """The values of a vtkDataArray: (n,) or (n, k)."""
    try:
        return np.asarray(vtk_to_numpy(array))
    except (AssertionError, KeyError, TypeError, ValueError):  # bits, and arrays without a buffer
        copy = vtkDoubleArray()
        copy.DeepCopy(array)
        return np.asarray(vtk_to_numpy(copy))


_CLASSES: dict[str, Any] = {
    "float64": vtkDoubleArray, "float32": vtkFloatArray, "int32": vtkIntArray, "int64": vtkTypeInt64Array,
    "uint8": vtkUnsignedCharArray,
}


def make_array(name: str, values: NDArray[Any], array_class: Any = None) -> Any:
    """An array with a copy of the values, (n,) or (n, k), of the class of their type unless one is given."""
    array = (array_class or _CLASSES[values.dtype.name])()
    array.SetName(name)
    array.SetNumberOfComponents(1 if values.ndim == 1 else values.shape[1])
    array.SetNumberOfTuples(len(values))
    if values.size:
        made = vtk_to_numpy(array)
        made[:] = values.reshape(made.shape)
    return array


def places_of(data: Any) -> NDArray[np.float64]:
    """The points (n, 3)."""
    if data.GetNumberOfPoints() == 0:
        return np.empty((0, 3))
    return to_numpy(data.GetPoints().GetData()).astype(np.float64, order="C")


def copy_component_names(source: Any, array: Any) -> None:
    for k in range(source.GetNumberOfComponents()):
        name = source.GetComponentName(k)
        if name:
            array.SetComponentName(k, name)


# Cells -----------------------------------------------------------------------------------------


def polygons_of(array: Any) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The points of all cells of a vtkCellArray in a row, and where each cell begins."""
    if array is None or array.GetNumberOfCells() == 0:
        return np.empty(0, dtype=np.int64), np.zeros(1, dtype=np.int64)
    return (to_numpy(array.GetConnectivityArray()).astype(np.int64),
            to_numpy(array.GetOffsetsArray()).astype(np.int64))


def hidden_points(data: Any) -> NDArray[np.uint8] | None:
    """Nonzero for hidden points; None if there are none."""
    flags = data.GetPointGhostArray()
    if flags is None or flags.GetNumberOfTuples() != data.GetNumberOfPoints():
        return None
    hidden = (to_numpy(flags) & _HIDDEN_POINT) != 0
    return np.ascontiguousarray(hidden, dtype=np.uint8) if hidden.any() else None


def cell_flags(data: Any, of_piece: bool = False) -> NDArray[np.uint8] | None:
    """vtkGhostType of the cells, where cells of hidden points are hidden; None if there are none. of_piece:
    whether an array that has not one tuple per cell is ignored, as it is in pieces, instead of an error."""
    given, count = data.GetCellGhostArray(), data.GetNumberOfCells()
    if of_piece and given is not None and given.GetNumberOfTuples() != count:
        given = None
    if given is not None and given.GetNumberOfTuples() != count:
        raise SurfaceError(say("Tuples", f"the input's array \"{given.GetName()}\"", given.GetNumberOfTuples(),
                               count, "cell"))
    hidden = hidden_points(data)
    if given is None and hidden is None:
        return None
    flags = (np.zeros(count, dtype=np.uint8) if given is None else to_numpy(given).copy())
    if hidden is not None:
        first = 0
        for array in (data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips()):
            corners, offsets = polygons_of(array)
            inside = (corners >= 0) & (corners < len(hidden))
            is_hidden = np.zeros(len(corners), dtype=bool)
            is_hidden[inside] = hidden[corners[inside]] != 0
            cell = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
            flags[first + np.unique(cell[is_hidden])] |= HIDDEN_CELL
            first += len(offsets) - 1
    return flags


@dataclass
class Cells:
    """Polygons and strips, polygons first."""

    corners: NDArray[np.int64]
    offsets: NDArray[np.int64]
    is_strip: NDArray[np.bool_]
    first: int = 0  #: the number of vertices and lines, which come before

    @property
    def count(self) -> int:
        return len(self.is_strip)

    @property
    def owners(self) -> NDArray[np.int64]:
        """The cell of each corner."""
        return np.repeat(np.arange(self.count), np.diff(self.offsets))

    def check(self, points: int) -> None:
        """Raise SurfaceError on cells with points that do not exist."""
        outside = (self.corners < 0) | (self.corners >= points)
        if outside.any():
            at = int(np.argmax(outside))
            raise SurfaceError(say("CellPoint", self.first + self.owners[at], self.corners[at], points))

    def without_strips(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """The corners of the polygons and of the triangles of strips, where each begins, and its cell."""
        sizes = np.diff(self.offsets)
        count = np.where(self.is_strip, np.maximum(0, sizes - 2), 0)
        strips = np.repeat(np.arange(self.count), count)
        i = np.arange(len(strips)) - np.repeat(np.cumsum(count) - count, count)
        rows = np.stack([i, i + 1 + i % 2, i + 2 - i % 2], axis=1) + self.offsets[strips, None]
        polygons = np.flatnonzero(~self.is_strip)
        ends = np.cumsum(np.append(sizes[polygons], np.full(len(strips), 3)))
        return (np.append(self.corners[:self.offsets[len(polygons)]], self.corners[rows]),
                np.append(0, ends).astype(np.int64), self.first + np.append(polygons, strips))


def read_cells(data: Any) -> Cells:
    (polygons, begin), (strips, begin_strips) = map(polygons_of, (data.GetPolys(), data.GetStrips()))
    return Cells(np.append(polygons, strips), np.append(begin, begin_strips[1:] + len(polygons)),
                 np.repeat([False, True], [len(begin) - 1, len(begin_strips) - 1]),
                 data.GetNumberOfVerts() + data.GetNumberOfLines())


def turn_polygons(surface: Any, cells: Any) -> None:
    """Reverse those of these cells that are polygons."""
    first = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
    polygons = vtkCellArray()
    polygons.DeepCopy(surface.GetPolys())
    for cell in np.unique(cells).tolist():
        if 0 <= cell - first < surface.GetNumberOfPolys():
            polygons.ReverseCellAtId(cell - first)
    surface.SetPolys(polygons)


# Results ---------------------------------------------------------------------------------------


def name_of(output: Output, data_name: str, prefix: str) -> str:
    """The name of an array with an output. prefix: ResultArrayName."""
    if output.is_result and prefix:
        return prefix
    of_data = output.is_result or (output.is_beside_result and not prefix)
    return (data_name if of_data else prefix) + output.name


def attribute_of(output: Output, is_normals: bool, of_bytes: bool) -> int:
    """The role of an output that has one. The vectors of a result are vectors in space, which colours and
    pairs are not. is_normals: whether these are in place of normals; of_bytes: whether the data are bytes."""
    if output.role == "scalars":
        return int(vtkDataSetAttributes.SCALARS)
    if is_normals:
        return int(vtkDataSetAttributes.NORMALS)  # only these: ParaView shades with no vectors
    in_space = output.rows.shape[1] == 3 and not (output.kind == "data" and of_bytes)
    return int(vtkDataSetAttributes.VECTORS if in_space else vtkDataSetAttributes.SCALARS)


def make_points(places: NDArray[Any], like: Any) -> Any:
    """vtkPoints in the precision of others."""
    single = like.GetDataType() == VTK_FLOAT
    points = vtkPoints()
    points.SetData(make_array("Points", places.astype(np.float32 if single else np.float64)))
    return points


def move_points(places: NDArray[np.float64], before: Any, after: Any) -> None:
    """Give a surface, which was a copy of `before`, moved points, with the normals of these."""
    after.SetPoints(make_points(places, before.GetPoints()))
    update_normals(before, after)


def refined_polydata(
    given: Any, points: NDArray[Any], triangles: NDArray[Any], cells: NDArray[Any], parents: NDArray[Any],
    roles: dict[str, Any],
) -> Any:
    """A surface with finer triangles in place of its polygons and strips, and with its arrays. cells: of the
    triangles; parents: of new points; roles: of arrays where points are added, by the names of arrays."""
    surface = vtkPolyData()
    surface.SetPoints(make_points(points, given.GetPoints()))
    surface.SetVerts(given.GetVerts())
    surface.SetLines(given.GetLines())
    triangles = triangles.astype(np.int64)
    polygons = vtkCellArray()
    polygons.SetData(make_array("", 3 * np.arange(len(triangles) + 1)), make_array("", triangles.ravel()))
    surface.SetPolys(polygons)
    surface.GetFieldData().ShallowCopy(given.GetFieldData())
    copy_arrays(given.GetPointData(), surface.GetPointData(), given.GetNumberOfPoints(),
                lambda values, name: interpolate_points(values, parents, roles.get(name or "", _core.PointRole.Data)),
                parents.min(axis=1), keeps=True)
    others = given.GetNumberOfVerts() + given.GetNumberOfLines()
    ids = np.concatenate([np.arange(others), cells]).astype(np.int64)
    copy_arrays(given.GetCellData(), surface.GetCellData(), given.GetNumberOfCells(),
                lambda values, _: values[ids], ids)
    surface.GetCellData().AddArray(make_array("vtkOriginalCellIds", ids, vtkIdTypeArray))
    return surface


def copy_arrays(
    given: Any, made: Any, count: int, make: Callable[[NDArray[Any], str | None], NDArray[Any]],
    rows: NDArray[Any], keeps: bool = False
) -> None:
    """Add the arrays of `given` with a tuple for each of `count` points or cells, but global ids, and keep
    their roles. make: the values from those of an array of a name. rows: of arrays that are no numbers, the
    tuples to copy. keeps: all tuples come first."""
    for number in range(given.GetNumberOfArrays()):
        array, role = given.GetAbstractArray(number), given.IsArrayAnAttribute(number)
        if role == vtkDataSetAttributes.GLOBALIDS or array.GetNumberOfTuples() != count:
            continue
        new = array.NewInstance()
        if isinstance(array, vtkDataArray):
            new.DeepCopy(numpy_to_vtk(make(to_numpy(array), array.GetName())))
        else:
            _copy_tuples(array, new, rows, keeps)
        new.SetName(array.GetName())
        copy_component_names(array, new)
        added = made.AddArray(new)
        if role >= 0:
            made.SetActiveAttribute(added, role)


def _copy_tuples(array: Any, new: Any, rows: NDArray[Any], keeps: bool) -> None:
    """Copy tuples of an array of texts and the like. keeps: all tuples come first, and a row may be a new
    one."""
    new.SetNumberOfComponents(array.GetNumberOfComponents())
    count = array.GetNumberOfTuples() if keeps else 0
    new.SetNumberOfTuples(count + len(rows))
    if keeps:
        new.InsertTuples(0, count, 0, array)
    for i, row in enumerate(rows.tolist()):
        new.InsertTuple(count + i, row, new if keeps else array)


# Normals ---------------------------------------------------------------------------------------


def compute_point_normals(data: Any) -> Any:
    """A vtkFloatArray with the normalised sums of the unit normals of the cells at each point."""
    array = numpy_to_vtk(_normals_of_points(data).astype(np.float32), deep=True)
    array.SetName("Normals")
    return array


def update_normals(before: Any, after: Any) -> None:
    """Compute the normals of a surface whose points have moved again, and drop its tangents."""
    for given, made, count, find in (
            (before.GetPointData(), after.GetPointData(), after.GetNumberOfPoints(), _normals_of_points),
            (before.GetCellData(), after.GetCellData(), after.GetNumberOfCells(), _normals_of_cells)):
        for array, kind, is_active in _drop(given, made):
            if (kind == "normals" and isinstance(array, vtkDataArray) and array.GetNumberOfComponents() == 3
                    and array.GetNumberOfTuples() == count):
                index = made.AddArray(_moved(array, find(before), find(after)))
                if is_active:
                    made.SetActiveAttribute(index, made.NORMALS)


def drop_normals(before: Any, after: Any) -> None:
    """Drop the normals and tangents that a surface with other points still has from the one before."""
    _drop(before.GetPointData(), after.GetPointData())
    _drop(before.GetCellData(), after.GetCellData())


def _drop(given: Any, made: Any) -> list[tuple[Any, str, bool]]:
    """Drop the normals and tangents of `given` that `made` has, too: of each the array, its kind, and whether
    it was the active normals. (Arrays of newer VTK are compared by their elements.)"""
    dropped = []
    for array in [given.GetAbstractArray(a) for a in range(given.GetNumberOfArrays())]:
        kind, indices = _kind(array, given), range(made.GetNumberOfArrays())
        index = next((a for a in indices if kind and made.GetAbstractArray(a) is array), None)
        if index is not None:
            dropped.append((array, kind, made.GetNormals() is array))
            made.RemoveArray(index)
    return dropped


def _kind(array: Any, attributes: Any) -> str:
    if array is attributes.GetNormals() or array.GetName() == "Normals":
        return "normals"
    return "tangents" if array is attributes.GetTangents() or array.GetName() == "Tangents" else ""


def _moved(given: Any, before: NDArray[np.float64], after: NDArray[np.float64]) -> Any:
    """The normals in the type of the given ones. They point to the same side, and tuples that have no
    normal are copied."""
    values = to_numpy(given).astype(np.float64)
    side = -1.0 if np.sum(values * before) < 0.0 else 1.0
    has_normal = np.any(after != 0.0, axis=1)
    values[has_normal] = side * after[has_normal]
    moved = given.NewInstance()
    moved.DeepCopy(numpy_to_vtk(values))  # which converts to its type
    moved.SetName(given.GetName())
    return moved


def _normals_of_points(data: Any) -> NDArray[np.float64]:
    """Hidden cells do not count."""
    connectivity, offsets, cells, normals = _find_polygons(data)
    flags = cell_flags(data)
    if flags is not None:
        normals[(flags[cells] & HIDDEN_CELL) != 0] = 0.0
    return sum_vectors(connectivity, np.repeat(normals, np.diff(offsets), axis=0), data.GetNumberOfPoints())


def _normals_of_cells(data: Any) -> NDArray[np.float64]:
    """Zero for cells that are no polygons."""
    _, _, cells, normals = _find_polygons(data)
    return sum_vectors(cells, normals, data.GetNumberOfCells())


def _find_polygons(
    data: Any
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Corners, offsets, cells and normals of polygons and the triangles of strips. Others than these and
    those with points that do not exist are an error, which is reported later."""
    corners, offsets, cells = read_cells(data).without_strips()
    sizes = np.diff(offsets)
    is_bad = (corners < 0) | (corners >= data.GetNumberOfPoints())
    kept = sizes >= 3
    kept[np.repeat(np.arange(len(sizes)), sizes)[is_bad]] = False
    corners, offsets = corners[np.repeat(kept, sizes)], np.append(0, np.cumsum(sizes[kept]))
    return corners, offsets, cells[kept], unit_normals(_moderate_points(data), corners, offsets)


def _moderate_points(data: Any) -> NDArray[np.float64]:
    """The points, in coordinates whose squares a float can hold."""
    points = places_of(data)
    bounds = data.GetBounds()
    extent = max(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4])
    if extent > 0.0 and not 1e-15 <= extent <= 1e15:
        points = points / extent - np.array([bounds[0], bounds[2], bounds[4]]) / extent
    return points
