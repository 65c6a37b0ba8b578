# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces in several pieces, as partitioned data sets have them: each is made one surface, whose points
and cells do not depend on the partition, and its results go back to the pieces. The rules are those of the
classes in C++, Filters/Distributed/PointIdentity.h and StitchedSurface.h."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import vtkDataArray, vtkDoubleArray, vtkPoints, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkBoundingBox, vtkCellArray, vtkDataSetAttributes, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData

from .. import _core
from .._polydata import (
    ABSENT, Cells, cell_flags, copy_arrays, copy_component_names, drop_normals, make_array, places_of,
    read_cells, to_numpy,
)
from ._surfaces import BETWEEN, GIVEN_CELL, Block

_DUPLICATE_POINT = 1  #: the bit in vtkGhostType
_GHOSTS = vtkDataSetAttributes.GhostArrayName()
_DEFAULT_TOLERANCE = 1e-6  #: in diagonals of the bounding box of all pieces
_REACH = 3.0  #: in tolerances: what a point matches depends on points within it (PointMatching.h)
_LARGE = 16  #: the most corners of cells that are sorted as one array, padded to the largest


@dataclass(eq=False)
class Piece:
    """A piece, and the way from the surface back to it."""

    block: Block
    places: NDArray[np.float64]
    cells: Cells
    is_absent: NDArray[np.bool_]  #: per polygon and strip: a ghost or hidden
    first: int  #: the row of its first point among those of all pieces
    points: NDArray[np.int64]  #: per point, the surface's point
    originals: NDArray[np.int64]  #: per polygon and strip, the surface's cell, or -1

    @property
    def rows(self) -> slice:
        return slice(self.first, self.first + len(self.places))


@dataclass
class Stitched:
    """A surface made from its pieces. block: its data, and a shallow copy for the results."""

    block: Block
    pieces: list[Piece]


def stitch_pieces(
    blocks: list[Block], tolerance: float, names: dict[str, bool], attributes: set[int]
) -> list[Stitched]:
    """Make the surfaces whose pieces are the blocks. names, attributes: of the arrays that are read, and
    whether they have flags alone, whose type has no meaning; all others are known by their names only."""
    pieces: list[Piece] = []
    for block in blocks:
        first = pieces[-1].rows.stop if pieces else 0
        nothing = np.empty(0, dtype=np.int64)
        cells, flags = read_cells(block.input), cell_flags(block.input, of_piece=True)
        absent = (np.zeros(cells.count, dtype=bool) if flags is None else (flags[cells.first:] & ABSENT) != 0)
        pieces.append(Piece(block, places_of(block.input), cells, absent, first, nothing, nothing))
    found = [_global_ids(piece.block.input) for piece in pieces]
    given = [ids for ids in found if ids is not None]
    by_id = len(given) == len(found)
    owners = _match(pieces, np.concatenate(given) if by_id else None, tolerance)
    numbers = np.concatenate(given if by_id else [_core.number_places(piece.places) for piece in pieces])
    by_surface: dict[int, list[Piece]] = {}
    for piece in pieces:
        by_surface.setdefault(piece.block.surface, []).append(piece)
    return [_stitch(by_surface[number], owners, numbers, by_id, names, attributes)
            for number in sorted(by_surface)]


def _global_ids(data: Any) -> NDArray[np.int64] | None:
    if data.GetNumberOfPoints() == 0:
        return np.empty(0, dtype=np.int64)
    ids = data.GetPointData().GetGlobalIds()
    if ids is None or ids.GetNumberOfComponents() != 1 or ids.GetNumberOfTuples() != data.GetNumberOfPoints():
        return None
    return to_numpy(ids).astype(np.int64)


# Points ----------------------------------------------------------------------------------------


def _match(pieces: list[Piece], ids: NDArray[np.int64] | None, tolerance: float) -> NDArray[np.int64]:
    """Per point of all pieces, the point that owns it."""
    boxes = [vtkBoundingBox(piece.block.input.GetBounds()) for piece in pieces]
    if tolerance < 0.0 or not math.isfinite(tolerance):
        everything = vtkBoundingBox()
        for box in boxes:
            everything.AddBox(box)
        tolerance = _DEFAULT_TOLERANCE * everything.GetDiagonalLength() if everything.IsValid() else 0.0
    for box in boxes:
        if box.IsValid():
            box.Inflate(_REACH * tolerance)
    valid = np.array([bool(box.IsValid()) for box in boxes])
    low, high = (np.array(ends).reshape(-1, 3) for ends in (
        [box.GetMinPoint() for box in boxes], [box.GetMaxPoint() for box in boxes]))
    of_piece = np.array([piece.block.surface for piece in pieces])
    near = []
    for number, piece in enumerate(pieces):
        inside = np.zeros(len(piece.places), dtype=bool)
        meets = valid & (of_piece == of_piece[number]) & (low <= high[number]).all(axis=1) & (
            high >= low[number]).all(axis=1)
        for other in np.flatnonzero(meets) if valid[number] else []:
            if other != number:
                inside |= ((piece.places >= low[other]) & (piece.places <= high[other])).all(axis=1)
        near.append(inside & np.isfinite(piece.places).all(axis=1))
    owners = np.arange(pieces[-1].rows.stop)
    candidates = np.flatnonzero(np.concatenate(near))
    if len(candidates):
        sizes = [len(piece.places) for piece in pieces]
        surfaces = np.repeat(of_piece, sizes)[candidates]
        numbers = np.repeat(np.arange(len(pieces)), sizes)[candidates]
        is_open, is_copy = (np.concatenate(kind).astype(np.uint8)[candidates] for kind in
                            zip(*(_flags(piece) for piece in pieces)))
        found = _core.match_points(
            surfaces, numbers, np.concatenate([piece.places for piece in pieces])[candidates], is_open,
            is_copy, None if ids is None else ids[candidates], tolerance)
        owners[candidates] = candidates[found]
    return owners


def _flags(piece: Piece) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which points are open, and which are copies, as in PointMatching.h."""
    cells, count = piece.cells, len(piece.places)
    is_bad = (cells.corners < 0) | (cells.corners >= count)  # an error, which is reported later
    kept = ~piece.is_absent
    kept[cells.owners[is_bad]] = False
    used = np.zeros(count, dtype=bool)
    used[cells.corners[kept[cells.owners]]] = True
    corners, offsets, owners = cells.without_strips()
    following = np.roll(corners, -1)
    full = np.flatnonzero(np.diff(offsets))
    following[offsets[full + 1] - 1] = corners[offsets[full]]
    edges = np.stack([corners, following], axis=1)[np.repeat(kept[owners - cells.first], np.diff(offsets))]
    ends = np.sort(edges, axis=1)
    keys, uses = np.unique(ends[:, 0] * count + ends[:, 1], return_counts=True)
    on_edge = np.zeros(count, dtype=bool)
    for side in np.divmod(keys[uses == 1], max(1, count)):
        on_edge[side] = True
    ghosts = piece.block.input.GetPointGhostArray()
    is_duplicate = np.zeros(count, dtype=bool)
    if ghosts is not None and ghosts.GetNumberOfTuples() == count:
        is_duplicate = (to_numpy(ghosts) & _DUPLICATE_POINT) != 0
    return ~used | on_edge, ~used | is_duplicate


# Surfaces --------------------------------------------------------------------------------------


def _stitch(pieces: list[Piece], owners: NDArray[np.int64], numbers: NDArray[np.int64], by_id: bool,
            names: dict[str, bool], attributes: set[int]) -> Stitched:
    rows = np.concatenate([np.arange(piece.rows.start, piece.rows.stop) for piece in pieces])
    sources = rows[owners[rows] == rows]
    sources = sources[np.argsort(numbers[sources], kind="stable")]
    point_of = np.full(len(owners), -1)
    point_of[sources] = np.arange(len(sources))
    for piece in pieces:
        piece.points = point_of[owners[piece.rows]]
    surface, everything = vtkPolyData(), _append(pieces, names, attributes)
    of_pieces = np.searchsorted(rows, sources)  # among the points of these pieces
    surface.SetPoints(vtkPoints())
    if len(sources):
        surface.GetPoints().SetData(make_array("Points", to_numpy(everything.GetPoints().GetData())[of_pieces]))
    copy_arrays(everything.GetPointData(), surface.GetPointData(), len(rows),
                lambda values, _: values[of_pieces], of_pieces)
    if by_id:  # numbers of places are for the order alone
        surface.GetPointData().SetGlobalIds(make_array("surface diffusion point id", numbers[sources]))
    cell_sources = _stitch_cells(pieces, surface)
    polygons_first = np.argsort(np.concatenate([piece.cells.is_strip for piece in pieces]), kind="stable")
    first = everything.GetNumberOfVerts() + everything.GetNumberOfLines()
    of_cells = first + np.argsort(polygons_first)[cell_sources]
    copy_arrays(everything.GetCellData(), surface.GetCellData(), everything.GetNumberOfCells(),
                lambda values, _: values[of_cells], of_cells)
    for piece in pieces:
        _keep_names(piece.block.input.GetPointData(), surface.GetPointData())
        _keep_names(piece.block.input.GetCellData(), surface.GetCellData())
    output = vtkPolyData()
    output.ShallowCopy(surface)
    return Stitched(Block(surface, output, pieces[0].block.name), pieces)


def _stitch_cells(pieces: list[Piece], surface: Any) -> NDArray[np.int64]:
    """Add the cells, apart from ghosts and hidden ones, ordered by their global ids and points. Return the
    row of each among the cells of all pieces."""
    corners, sizes = [], []
    for piece in pieces:
        is_good = (piece.cells.corners >= 0) & (piece.cells.corners < len(piece.places))
        mapped = np.full(len(is_good), -1)  # points that do not exist stay so, for the filter to report
        mapped[is_good] = piece.points[piece.cells.corners[is_good]]
        corners.append(mapped)
        sizes.append(np.diff(piece.cells.offsets))
    everything = Cells(
        np.concatenate(corners), np.append(0, np.cumsum(np.concatenate(sizes))),
        np.concatenate([piece.cells.is_strip for piece in pieces]))
    is_absent = np.concatenate([piece.is_absent for piece in pieces])
    order = _sort_cells(everything, _cell_ids(pieces))
    order = order[~is_absent[order]]
    original = np.full(everything.count, -1)
    original[order] = np.arange(len(order))
    if is_absent.any():  # a ghost gets the results of the cell with the same corners
        known: dict[tuple[int, ...], int] = {}
        rows = np.split(everything.corners, everything.offsets[1:-1])
        for number, cell in enumerate(order):
            known.setdefault(tuple(sorted(rows[cell])), number)
        for cell in np.flatnonzero(is_absent):
            original[cell] = known.get(tuple(sorted(rows[cell])), -1)
    begin = 0
    for piece in pieces:
        piece.originals = original[begin:begin + piece.cells.count]
        begin += piece.cells.count
    all_sizes = np.diff(everything.offsets)
    for is_strip, add in ((False, surface.SetPolys), (True, surface.SetStrips)):
        kept = order[everything.is_strip[order] == is_strip]
        offsets = np.append(0, np.cumsum(all_sizes[kept]))
        taken = np.arange(offsets[-1]) + np.repeat(everything.offsets[kept] - offsets[:-1], all_sizes[kept])
        cells = vtkCellArray()
        cells.SetData(make_array("", offsets), make_array("", everything.corners[taken]))
        add(cells)
    return order


def _cell_ids(pieces: list[Piece]) -> NDArray[np.int64]:
    """The global ids of polygons and strips; zeros unless all pieces with cells have them."""
    found = []
    for piece in pieces:
        ids, data = piece.block.input.GetCellData().GetGlobalIds(), piece.block.input
        if piece.cells.count and (ids is None or ids.GetNumberOfTuples() != data.GetNumberOfCells()):
            return np.zeros(sum(each.cells.count for each in pieces), dtype=np.int64)
        found.append(to_numpy(ids).astype(np.int64)[piece.cells.first:] if piece.cells.count else
                     np.empty(0, dtype=np.int64))
    return np.concatenate(found)


def _sort_cells(cells: Cells, ids: NDArray[np.int64]) -> NDArray[np.int64]:
    sizes = np.diff(cells.offsets)
    width = int(sizes.max(initial=0))
    if width > _LARGE:
        keys = [(strip, number, tuple(row.tolist())) for strip, number, row in
                zip(cells.is_strip.tolist(), ids.tolist(), np.split(cells.corners, cells.offsets[1:-1]))]
        return np.array(sorted(range(len(keys)), key=keys.__getitem__), dtype=np.int64)
    padded = np.full((cells.count, width), -2)  # a cell comes before longer ones that begin with its points
    padded[np.arange(width) < sizes[:, None]] = cells.corners
    return np.lexsort([*padded.T[::-1], ids, cells.is_strip])


# Arrays ----------------------------------------------------------------------------------------


def _append(pieces: list[Piece], names: dict[str, bool], attributes: set[int]) -> Any:
    """The pieces one after another, with the arrays that are read and that all of them have. Flags become
    numbers of one type."""
    append = vtkAppendPolyData()
    for piece in pieces:
        part = vtkPolyData()
        part.ShallowCopy(piece.block.input)
        for data, count in ((part.GetPointData(), part.GetNumberOfPoints()),
                            (part.GetCellData(), part.GetNumberOfCells())):
            data.SetActiveAttribute(-1, data.GLOBALIDS)  # those that are read are data
            active = [data.GetAbstractAttribute(kind) for kind in attributes]
            for a in range(data.GetNumberOfArrays())[::-1]:
                array = data.GetAbstractArray(a)
                name = array.GetName() or ""
                is_read = name in names or name in (BETWEEN, GIVEN_CELL) or any(array is each for each in active)
                if name == _GHOSTS or not is_read or array.GetNumberOfTuples() != count:
                    data.RemoveArray(a)
                elif names.get(name) and isinstance(array, vtkDataArray):
                    flags = vtkDoubleArray()
                    flags.DeepCopy(array)
                    data.AddArray(flags)
        append.AddInputData(part)
    append.Update()
    return append.GetOutput()


def _keep_names(given: Any, merged: Any) -> None:
    """Arrays that the surface does not have become arrays without tuples, so that a result that replaces one
    is noticed."""
    for a in range(given.GetNumberOfArrays()):
        name = given.GetAbstractArray(a).GetName()
        if name and name != _GHOSTS and not merged.HasArray(name):
            placeholder = vtkUnsignedCharArray()
            placeholder.SetName(name)
            merged.AddArray(placeholder)


# Results ---------------------------------------------------------------------------------------


def scatter_results(surface: Stitched) -> None:
    """Add the arrays and moved points of the output of a surface to the outputs of its pieces."""
    before, after = surface.block.input, surface.block.output
    for piece in surface.pieces:
        output = piece.block.output
        for given, made, of_piece, rows, first, count in (
                (before.GetPointData(), after.GetPointData(), output.GetPointData(), piece.points, 0,
                 len(piece.places)),
                (before.GetCellData(), after.GetCellData(), output.GetCellData(), piece.originals,
                 piece.cells.first, output.GetNumberOfCells())):
            for a in range(made.GetNumberOfArrays()):
                array = made.GetArray(a)
                if array is not None and given.GetArray(array.GetName()) is not array:
                    of_piece.RemoveArray(array.GetName())  # and its role, which it would keep
                    index = of_piece.AddArray(_restrict(array, rows, first, count))
                    if made.IsArrayAnAttribute(a) >= 0:
                        of_piece.SetActiveAttribute(index, made.IsArrayAnAttribute(a))
        if before.GetPoints() is not after.GetPoints():
            points = vtkPoints()
            points.SetData(_restrict(after.GetPoints().GetData(), piece.points, 0, len(piece.places)))
            output.SetPoints(points)
            drop_normals(piece.block.input, output)


def _restrict(array: Any, rows: NDArray[np.int64], first: int, count: int) -> Any:
    """Rows of an array from tuple `first` on; zeros elsewhere and where a row is -1."""
    values = to_numpy(array)
    part = np.zeros((count, *values.shape[1:]), dtype=values.dtype)
    known = np.flatnonzero(rows >= 0)
    part[first + known] = values[rows[known]]
    made = make_array(array.GetName(), part, type(array))
    copy_component_names(array, made)
    return made
