# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Bisection of the long edges of ParaView's surfaces before an update. The rules are those of the classes in
C++, Filters/Conversion/PieceRefinement.cxx."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import VTK_ID_TYPE, vtkDataArray, vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSetAttributes, vtkPolyData

from .. import _core
from .._refinement import edge_lengths
from ._results import _as_int64, _copy_component_names, make_array
from ._surfaces import Block, read_surface, to_numpy


def mean_edge_length(blocks: list[Block]) -> float:
    """Of the distinct edges of each block; 0 if there is none."""
    lengths = [np.empty(0)]
    for block in blocks:
        if block.core is None:
            read_surface(block)
        points = to_numpy(block.input.GetPoints().GetData()).astype(np.float64)
        lengths.append(edge_lengths(points, block.core.triangles()))
    return float(np.concatenate(lengths).mean()) if sum(map(len, lengths)) else 0.0


class Refinement:
    """The refined surfaces of an update, which replace its blocks."""

    def __init__(self) -> None:
        self.longest = 0.0  #: edge that is left where the limit was reached; 0: nowhere
        self.triangles = 0  #: of the blocks that were replaced
        self._before: list[tuple[Block, Any]] = []

    def bisect(
        self, blocks: list[Block], length: float, limit: int, progress: Callable[[float], Any]
    ) -> None:
        """Bisect the edges that are longer, until a block would have more triangles than the limit."""
        found = self._bisect_all(blocks, length, limit, progress)
        if self.longest > 0.0 and len(blocks) > 1:
            found = self._bisect_all(blocks, self.longest, limit, progress)  # alike in every block
        for block, refined in zip(blocks, found):
            if len(refined["parents"]):
                surface = _make_surface(block, refined)
                self._before.append((block, block.input))
                self.triangles += len(refined["triangles"])
                block.output.ShallowCopy(surface)
                block.input, block.core = surface, None

    def _bisect_all(
        self, blocks: list[Block], length: float, limit: int, progress: Callable[[float], Any]
    ) -> list[dict[str, Any]]:
        found = []
        for block in blocks:
            if block.core is None:
                read_surface(block)
            found.append(_core.refine(block.core, length, limit, progress))
        if not self.longest:
            self.longest = max([refined["longest_edge"] for refined in found if refined["limit_reached"]],
                               default=0.0)
        return found

    def undo(self) -> None:
        """Make the outputs copies of the inputs that were replaced."""
        for block, before in self._before:
            block.output.ShallowCopy(before)


def _make_surface(block: Block, refined: dict[str, Any]) -> Any:
    given = block.input
    surface = vtkPolyData()
    single = given.GetPoints().GetDataType() == 10
    points = vtkPoints()
    points.SetData(make_array("Points", refined["points"].astype(np.float32 if single else np.float64)))
    surface.SetPoints(points)
    surface.SetVerts(given.GetVerts())
    surface.SetLines(given.GetLines())
    triangles = refined["triangles"]
    polygons = vtkCellArray()
    polygons.SetData(_as_int64(3 * np.arange(len(triangles) + 1)), _as_int64(triangles.ravel()))
    surface.SetPolys(polygons)
    surface.GetFieldData().ShallowCopy(given.GetFieldData())
    _interpolate(given.GetPointData(), surface.GetPointData(), refined["parents"])
    others = given.GetNumberOfVerts() + given.GetNumberOfLines()
    ids = np.concatenate([np.arange(others), refined["faces"].ravel()]).astype(np.int64)
    cells = surface.GetCellData()
    cells.CopyGlobalIdsOff()
    cells.CopyAllocate(given.GetCellData(), len(ids))
    before, after = vtkIdList(), vtkIdList()
    before.SetNumberOfIds(len(ids))
    after.SetNumberOfIds(len(ids))
    for cell, original in enumerate(ids.tolist()):
        before.SetId(cell, original)
        after.SetId(cell, cell)
    cells.CopyData(given.GetCellData(), before, after)
    cells.AddArray(make_array("vtkOriginalCellIds", ids, VTK_ID_TYPE))
    return surface


def _interpolate(given: Any, made: Any, parents: NDArray[Any]) -> None:
    """Arrays are linear along the edges, except that integers of one component, which are labels and marks,
    become the smaller of two."""
    for number in range(given.GetNumberOfArrays()):
        array, role = given.GetAbstractArray(number), given.IsArrayAnAttribute(number)
        if role == vtkDataSetAttributes.GLOBALIDS:
            continue
        added = made.AddArray(_interpolated(array, parents))
        if role >= 0:
            made.SetActiveAttribute(added, role)


def _interpolated(array: Any, parents: NDArray[Any]) -> Any:
    count = array.GetNumberOfTuples()
    new = array.NewInstance()
    new.SetName(array.GetName())
    new.SetNumberOfComponents(array.GetNumberOfComponents())
    _copy_component_names(array, new)
    if not isinstance(array, vtkDataArray):
        new.SetNumberOfTuples(count + len(parents))
        new.InsertTuples(0, count, 0, array)
        for i, parent in enumerate(parents.min(axis=1).tolist()):
            new.InsertTuple(count + i, parent, new)
        return new
    values = to_numpy(array)
    values = values.reshape(count, -1)
    whole = np.vstack([values, np.empty((len(parents), values.shape[1]), dtype=values.dtype)])
    rounds = values.dtype.kind != "f"
    # A parent may be a new point, so that generations follow one another.
    begin = 0
    while begin < len(parents):
        known = count + begin
        ready = (parents[begin:] < known).all(axis=1)
        end = len(parents) if ready.all() else begin + max(1, int(np.argmin(ready)))
        a, b = whole[parents[begin:end, 0]], whole[parents[begin:end, 1]]
        if rounds and values.shape[1] == 1:
            found = np.minimum(a, b)
        else:
            found = 0.5 * a.astype(np.float64) + 0.5 * b.astype(np.float64)
            found = np.floor(found + 0.5) if rounds else found
        whole[known:count + end] = found.astype(values.dtype)
        begin = end
    typed = make_array(array.GetName() or "", whole if whole.shape[1] > 1 else whole[:, 0])
    new.DeepCopy(typed)
    new.SetName(array.GetName())
    _copy_component_names(array, new)
    return new
