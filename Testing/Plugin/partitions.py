# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces in pieces: the partitions of one, with ghost cells, global ids, unused points and gaps as asked."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkIdTypeArray, vtkPoints
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray, vtkMultiBlockDataSet, vtkMultiPieceDataSet, vtkPartitionedDataSet, vtkPartitionedDataSetCollection,
    vtkPolyData,
)


def copy_of(data):
    copy = vtkPolyData()
    copy.DeepCopy(data)
    return copy


def number_cells(data):
    """Per cell, its number in space: the rank of the middle of its bounding box along x."""
    middle = []
    for cell in range(data.GetNumberOfCells()):
        bounds = data.GetCell(cell).GetBounds()
        middle.append(bounds[0] + bounds[1] + 1e-3 * (bounds[2] + bounds[3]))
    return np.argsort(np.argsort(middle, kind="stable"), kind="stable")


def give_ids(data, cells=False):
    """A copy with global ids, not in the order of the points, and also of the cells if asked."""
    copy = copy_of(data)
    for attributes, count in ((copy.GetPointData(), copy.GetNumberOfPoints()),
                              (copy.GetCellData(), copy.GetNumberOfCells() if cells else 0)):
        if count:
            ids = vtkIdTypeArray()
            ids.DeepCopy(numpy_to_vtk((7 * np.arange(count) % count + count).astype(np.int64)))
            ids.SetName("ids")
            attributes.SetGlobalIds(ids)
    return copy


def part_of(data, kept, ghosts=None, also=()):
    """The piece of some cells, kept[c], with its own points and arrays. ghosts: per cell, whether it is
    a copy of one of another piece. also: points that it has besides."""
    sizes, first = [], 0
    used = np.zeros(data.GetNumberOfPoints(), dtype=bool)
    lists = []
    for cells in (data.GetVerts(), data.GetLines(), data.GetPolys(), data.GetStrips()):
        of_kind = []
        for cell in range(cells.GetNumberOfCells()):
            points = vtkIdList()
            cells.GetCellAtId(cell, points)
            corners = [points.GetId(i) for i in range(points.GetNumberOfIds())]
            if kept[first + cell]:
                of_kind.append(corners)
                used[corners] = True
        lists.append(of_kind)
        first += cells.GetNumberOfCells()
        sizes.append(len(of_kind))
    used[list(also)] = True
    number = np.cumsum(used) - 1
    piece = vtkPolyData()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(vtk_to_numpy(data.GetPoints().GetData())[used], deep=True))
    piece.SetPoints(points)
    for of_kind, add in zip(lists, (piece.SetVerts, piece.SetLines, piece.SetPolys, piece.SetStrips)):
        cells = vtkCellArray()
        for corners in of_kind:
            cells.InsertNextCell(len(corners), number[corners].tolist())
        add(cells)
    for given, made, rows in ((data.GetPointData(), piece.GetPointData(), np.flatnonzero(used)),
                              (data.GetCellData(), piece.GetCellData(), np.flatnonzero(kept))):
        made.CopyAllOn()
        made.CopyAllocate(given, len(rows))
        for to, row in enumerate(rows.tolist()):
            made.CopyData(given, row, to)
    if ghosts is not None:
        flags = numpy_to_vtk(ghosts[kept].astype(np.uint8), deep=True)
        flags.SetName("vtkGhostType")
        piece.GetCellData().AddArray(flags)
    return piece


def split(data, count, how=""):
    """The pieces of a surface: slabs along x, or "random" cells, or slabs with "ghosts", with points "apart"
    by less than the tolerance, with an "array" that one piece does not have, with points that are
    "unused", with cells that are all "absent", or with "flags" of some cells only."""
    numbers = number_cells(data)
    owner = numbers * count // len(numbers)
    if how == "random":
        owner = np.random.default_rng(3).integers(0, count, len(numbers))
    pieces = []
    for p in range(count):
        kept = owner == p
        ghosts = None
        if how == "ghosts":
            ghosts = (~kept & (np.abs(numbers - (p + 0.5) * len(numbers) / count) < 0.6 * len(numbers) / count))
            kept = kept | ghosts
        pieces.append(part_of(data, kept, ghosts, (0, 40, 41) if how == "unused" else ()))
    if how == "apart":
        points = vtk_to_numpy(pieces[1].GetPoints().GetData())
        points += points.dtype.type(1e-7) * np.sin(np.arange(points.size, dtype=points.dtype)).reshape(-1, 3)
    if how == "absent":
        for piece in pieces:
            flags = numpy_to_vtk(np.full(piece.GetNumberOfCells(), 32, dtype=np.uint8), deep=True)
            flags.SetName("vtkGhostType")
            piece.GetCellData().AddArray(flags)
    if how == "flags":
        flags = numpy_to_vtk(np.ones(3, dtype=np.uint8), deep=True)
        flags.SetName("vtkGhostType")
        pieces[0].GetCellData().AddArray(flags)
    if how == "array":
        for attributes in (pieces[0].GetPointData(), pieces[-1].GetCellData()):
            attributes.RemoveArray("hole")
            attributes.RemoveArray("up")
    return pieces


def partitioned(pieces, data=None):
    data = data or vtkPartitionedDataSet()
    for number, piece in enumerate(pieces):
        data.SetPartition(number, piece)
    return data


def collection(lists):
    data = vtkPartitionedDataSetCollection()
    for number, pieces in enumerate(lists):
        data.SetPartitionedDataSet(number, partitioned(pieces))
    return data


def blocks(lists):
    data = vtkMultiBlockDataSet()
    for number, pieces in enumerate(lists):
        data.SetBlock(number, partitioned(pieces, vtkMultiPieceDataSet()))
    return data
