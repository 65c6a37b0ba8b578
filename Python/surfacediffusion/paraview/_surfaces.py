# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of ParaView's data as arrays: points, triangles and their cells."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import Any, Iterator

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkCommonDataModel import (
    vtkCompositeDataSet, vtkMultiBlockDataSet, vtkPartitionedDataSet, vtkPartitionedDataSetCollection,
    vtkPolyData,
)

from .. import _core

HIDDEN_CELL = 32  #: the bit of cells in vtkGhostType
ABSENT = 1 | HIDDEN_CELL  #: duplicate or hidden
_HIDDEN_POINT = 2  #: the bit of points


class SurfaceError(Exception):
    """An error that the filter reports."""


#: Arrays of the inputs during an update, not of their outputs: per point, 1 in the middle of an edge that was
#: bisected; per cell, the cell of the input that it was cut from, by a number of its own among all blocks.
BETWEEN, GIVEN_CELL = "surface diffusion between", "surface diffusion given cell"


@dataclass
class Shape:
    """The triangles of a surface, which depend on its points and cells alone."""

    cells: NDArray[np.int64]  #: per triangle, its cell
    core: Any  #: the surface of the extension
    refined: dict[tuple[float, int], dict[str, Any]] = field(default_factory=dict)  #: the last one


@dataclass
class Block:
    """A surface of the input, and its copy in the output. name: of a block of composite data."""

    input: Any
    output: Any
    name: str = ""
    surface: int = 0  #: blocks with the same number are pieces of one surface
    shape: Shape | None = None
    cell_result: str = ""  #: the array with the result on its cells

    @property
    def core(self) -> Any:
        assert self.shape is not None
        return self.shape.core

    @property
    def cells(self) -> NDArray[np.int64]:
        assert self.shape is not None
        return self.shape.cells


class Shapes:
    """The shapes of the last two updates, by the contents of points and cells, which are compared at every
    update, since arrays that were edited in place need not be marked as modified."""

    def __init__(self) -> None:
        self._used: dict[bytes, Shape] = {}
        self._former: dict[bytes, Shape] = {}

    def begin_update(self) -> None:
        self._former, self._used = self._used or self._former, {}

    def find(self, block: Block) -> Shape:
        """The shape of a block, which is read unless it is known. Raises SurfaceError on cells with points
        that do not exist."""
        if block.shape is not None:
            return block.shape  # of this update
        key = _contents(block.input)
        shape = self._used.get(key) or self._former.get(key) or _read_shape(block.input)
        self._used[key] = block.shape = shape
        return shape


def _contents(data: Any) -> bytes:
    """A hash of what a shape depends on."""
    found = hashlib.blake2b(digest_size=16)
    arrays = [data.GetPoints().GetData(), data.GetPointGhostArray(), data.GetCellGhostArray()]
    for cells in (data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips()):
        has_cells = cells is not None and cells.GetNumberOfCells() > 0
        arrays += [cells.GetConnectivityArray(), cells.GetOffsetsArray()] if has_cells else [None, None]
    for array in arrays:
        values = None if array is None else to_numpy(array)
        found.update(b"-" if values is None else f"{values.dtype} {values.shape}".encode())
        if values is not None:
            found.update(np.ascontiguousarray(values).data.cast("B") if values.size else b"")
    return found.digest()


def to_numpy(array: Any) -> NDArray[Any]:
    """The values of a vtkDataArray: (n,) or (n, k)."""
    try:
        return np.asarray(vtk_to_numpy(array))
    except (AssertionError, KeyError, TypeError, ValueError):  # bits, and arrays without a buffer
        copy = vtkDoubleArray()
        copy.DeepCopy(array)
        return np.asarray(vtk_to_numpy(copy))


@dataclass
class Parts:
    """The surfaces of an input."""

    blocks: list[Block]
    other_types: str = ""  #: the classes of leaves that are no polydata
    is_composite: bool = False
    in_pieces: bool = False  #: whether a surface has several pieces


def copy_structure(given: Any, output: Any) -> Parts:
    """Make the output a shallow copy of the input, blocks included, and list the surfaces."""
    parts = Parts([], is_composite=isinstance(given, vtkCompositeDataSet))
    if not parts.is_composite:
        output.ShallowCopy(given)
        if isinstance(given, vtkPolyData):
            parts.blocks.append(Block(given, output))
        else:
            parts.other_types = given.GetClassName()
        return parts
    output.CopyStructure(given)
    output.GetFieldData().ShallowCopy(given.GetFieldData())
    output.GetInformation().CopyEntry(given.GetInformation(), given.DATA_TIME_STEP())
    names = list(_names(given, "", ""))
    seen: set[int] = set()
    types: set[str] = set()
    iterator = given.NewIterator()
    number = 0
    while not iterator.IsDoneWithTraversal():
        leaf = iterator.GetCurrentDataObject()
        copy = leaf.NewInstance()
        copy.ShallowCopy(leaf)
        output.SetDataSet(iterator, copy)
        surface, name = names[number] if number < len(names) else (0, "")
        if isinstance(leaf, vtkPolyData) and leaf.GetNumberOfPoints() > 0:
            parts.in_pieces = parts.in_pieces or surface in seen
            seen.add(surface)
        if isinstance(leaf, vtkPolyData):
            parts.blocks.append(Block(leaf, copy, name, surface))
        else:
            types.add(leaf.GetClassName())
        number += 1
        iterator.GoToNextItem()
    parts.other_types = ", ".join(sorted(types))
    return parts


def _names(data: Any, name: str, path: str, counter: list[int] | None = None) -> Iterator[tuple[int, str]]:
    """The number and the name of the surface of each leaf that exists: the name of its block in quotation
    marks, or its indices. Partitions are pieces of one surface."""
    counter = [0] if counter is None else counter
    children: list[tuple[Any, Any]] = []
    if isinstance(data, vtkMultiBlockDataSet):
        children = [(data.GetBlock(b), data.GetMetaData(b) if data.HasMetaData(b) else None)
                    for b in range(data.GetNumberOfBlocks())]
    elif isinstance(data, vtkPartitionedDataSetCollection):
        children = [(data.GetPartitionedDataSet(m), data.GetMetaData(m) if data.HasMetaData(m) else None)
                    for m in range(data.GetNumberOfPartitionedDataSets())]
    else:
        label = f'"{name}"' if name else path
        leaves = ([data.GetPartitionAsDataObject(p) for p in range(data.GetNumberOfPartitions())]
                  if isinstance(data, vtkPartitionedDataSet) else [data])
        yield from ((counter[0], label) for leaf in leaves if leaf is not None)
        counter[0] += 1
        return
    for number, (child, information) in enumerate(children):
        key = vtkCompositeDataSet.NAME()
        found = information.Get(key) if information is not None and information.Has(key) else ""
        yield from _names(child, found or "", f"{path}/{number}" if path else str(number), counter)


def _read_shape(data: Any) -> Shape:
    points = to_numpy(data.GetPoints().GetData()).astype(np.float64, order="C")
    first = data.GetNumberOfVerts() + data.GetNumberOfLines()
    triangles, cells = _cut(data.GetPolys(), first, points)
    if data.GetNumberOfStrips():
        of_strips, cells_of_strips = cut_strips(
            data.GetStrips(), first + data.GetNumberOfPolys(), len(points))
        triangles, cells = np.vstack([triangles, of_strips]), np.append(cells, cells_of_strips)
    flags, hidden = cell_flags(data), hidden_points(data)
    if flags is not None:
        kept = (flags[cells] & ABSENT) == 0
        triangles, cells = triangles[kept], cells[kept]
    cells = np.ascontiguousarray(cells, dtype=np.int64)
    return Shape(cells, _core.Surface(
        points, np.ascontiguousarray(triangles, dtype=np.int64).ravel(), cells, data.GetNumberOfCells(),
        hidden))


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
        raise SurfaceError(f"the input's array \"{given.GetName()}\" has {given.GetNumberOfTuples()} "
                           f"tuples; allowed: {count}, one per cell")
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


def _check(corners: Any, offsets: Any, first: int, count: int) -> None:
    outside = (corners < 0) | (corners >= count)
    if outside.any():
        at = int(np.argmax(outside))
        cell = first + int(np.searchsorted(offsets, at, side="right")) - 1
        raise SurfaceError(f"cell {cell} of the input refers to point {corners[at]}, but there are {count} "
                           "points")


def _cut(array: Any, first: int, points: Any) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The triangles of polygons, in the order of their cells."""
    corners, offsets = polygons_of(array)
    _check(corners, offsets, first, len(points))
    if (np.diff(offsets) == 3).all():
        return corners.reshape(-1, 3), first + np.arange(len(offsets) - 1)
    cut = _core.Surface(points, corners, offsets)
    return cut.triangles().astype(np.int64), first + cut.faces()


def triangles_of_strip(corners: NDArray[np.int64]) -> NDArray[np.int64]:
    i = np.arange(max(0, len(corners) - 2))
    return corners[np.stack([i, i + 1 + i % 2, i + 2 - i % 2], axis=1)]


def cut_strips(array: Any, first: int, count: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    corners, offsets = polygons_of(array)
    _check(corners, offsets, first, count)
    triangles, cells = [np.empty((0, 3), dtype=np.int64)], [np.empty(0, dtype=np.int64)]
    for number in range(len(offsets) - 1):
        strip = corners[offsets[number]:offsets[number + 1]]
        triangles.append(triangles_of_strip(strip))
        cells.append(np.full(len(triangles[-1]), first + number))
    return np.vstack(triangles), np.concatenate(cells)
