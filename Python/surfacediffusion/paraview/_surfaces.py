# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of ParaView's data as arrays: points, triangles and their cells."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import Any, Iterator

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonDataModel import (
    vtkCompositeDataSet, vtkMultiBlockDataSet, vtkPartitionedDataSet, vtkPartitionedDataSetCollection,
    vtkPolyData,
)

from .. import _core
from .._polydata import ABSENT, cell_flags, hidden_points, places_of, read_cells, to_numpy

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
    arrays = [data.GetPoints().GetData(), data.GetPointGhostArray(), data.GetCellGhostArray()]
    for cells in (data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips()):
        has_cells = cells is not None and cells.GetNumberOfCells() > 0
        arrays += [cells.GetConnectivityArray(), cells.GetOffsetsArray()] if has_cells else [None, None]
    return hash_arrays(arrays)


def hash_arrays(arrays: list[Any]) -> bytes:
    """A hash of the contents of arrays, of which each may be None."""
    found = hashlib.blake2b(digest_size=16)
    for array in arrays:
        values = None if array is None else to_numpy(array)
        found.update(b"-" if values is None else f"{values.dtype} {values.shape}".encode())
        if values is not None:
            found.update(np.ascontiguousarray(values).data.cast("B") if values.size else b"")
    return found.digest()


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
    points, given = places_of(data), read_cells(data)
    given.check(len(points))
    triangles, offsets, cells = given.without_strips()
    if not (np.diff(offsets) == 3).all():
        cut = _core.Surface(points, triangles, offsets)
        triangles, cells = cut.triangles().astype(np.int64).ravel(), cells[cut.faces()]
    flags, hidden = cell_flags(data), hidden_points(data)
    if flags is not None:
        kept = (flags[cells] & ABSENT) == 0
        triangles, cells = triangles.reshape(-1, 3)[kept].ravel(), cells[kept]
    return Shape(cells, _core.Surface(points, triangles, cells, data.GetNumberOfCells(), hidden))
