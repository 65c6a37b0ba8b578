# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Bisection of the long edges of ParaView's surfaces before an update. The rules are those of the classes in
C++, Filters/Conversion/PieceRefinement.cxx."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import VTK_FLOAT, vtkDataArray, vtkIdTypeArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSetAttributes, vtkPolyData

from .. import _core
from .._refinement import interpolate_points
from ._results import copy_component_names, make_array
from ._surfaces import BETWEEN, GIVEN_CELL, Block, Shapes, to_numpy


class Refinement:
    """The refined surfaces of an update, which replace its blocks."""

    def __init__(self, shapes: Shapes) -> None:
        self.longest = 0.0  #: edge that is left where the limit was reached; 0: nowhere
        self.triangles = 0  #: of the blocks that were replaced
        self._shapes = shapes
        self._before: list[tuple[Block, Any]] = []

    def bisect(
        self, blocks: list[Block], length: float, limit: int, progress: Callable[[float], Any],
        others: list[Block], rules: dict[str, str],
    ) -> None:
        """Bisect the edges that are longer, until a block would have more triangles than the limit. others:
        blocks without polygons, which are pieces of surfaces, too. rules: by the names of arrays."""
        found = self._bisect_all(blocks, length, limit, progress)
        self.longest = max([refined["longest_edge"] for refined in found if refined["limit_reached"]],
                           default=0.0)
        if self.longest > 0.0 and len(blocks) > 1:
            found = self._bisect_all(blocks, self.longest, limit, progress)  # alike in every block
        cells = 0
        for block, refined in [*zip(blocks, found), *((block, None) for block in others)]:
            before = block.input
            self._before.append((block, before))
            if refined is not None and len(refined["parents"]):
                block.input = _make_surface(before, refined, rules)
                self.triangles += len(refined["triangles"])
                block.output.ShallowCopy(block.input)
                given = to_numpy(block.input.GetCellData().GetArray("vtkOriginalCellIds"))
                block.shape = None
                self._shapes.find(block)
            else:
                block.input = vtkPolyData()
                block.input.ShallowCopy(before)
                given = np.arange(before.GetNumberOfCells())
            between = np.arange(block.input.GetNumberOfPoints()) >= before.GetNumberOfPoints()
            block.input.GetPointData().AddArray(make_array(BETWEEN, between.astype(np.uint8)))
            block.input.GetCellData().AddArray(make_array(GIVEN_CELL, (cells + given).astype(np.int64)))
            cells += before.GetNumberOfCells()

    def _bisect_all(
        self, blocks: list[Block], length: float, limit: int, progress: Callable[[float], Any]
    ) -> list[dict[str, Any]]:
        found = []
        for block in blocks:
            shape = self._shapes.find(block)
            if (length, limit) not in shape.refined:
                refined = _core.refine(shape.core, length, limit, progress)
                shape.refined = {(length, limit): refined}
            found.append(shape.refined[length, limit])
        return found

    def undo(self) -> None:
        """Make the outputs copies of the inputs that were replaced."""
        for block, before in self._before:
            block.output.ShallowCopy(before)


def _make_surface(given: Any, refined: dict[str, Any], rules: dict[str, str]) -> Any:
    parents = refined["parents"]
    surface = vtkPolyData()
    single = given.GetPoints().GetDataType() == VTK_FLOAT
    points = vtkPoints()
    points.SetData(make_array("Points", refined["points"].astype(np.float32 if single else np.float64)))
    surface.SetPoints(points)
    surface.SetVerts(given.GetVerts())
    surface.SetLines(given.GetLines())
    triangles = refined["triangles"].astype(np.int64)
    polygons = vtkCellArray()
    polygons.SetData(make_array("", 3 * np.arange(len(triangles) + 1)), make_array("", triangles.ravel()))
    surface.SetPolys(polygons)
    surface.GetFieldData().ShallowCopy(given.GetFieldData())
    _copy_arrays(given.GetPointData(), surface.GetPointData(), given.GetNumberOfPoints(),
                 lambda values, name: interpolate_points(values, parents, rules.get(name or "")),
                 parents.min(axis=1))
    others = given.GetNumberOfVerts() + given.GetNumberOfLines()
    ids = np.concatenate([np.arange(others), refined["faces"].ravel()]).astype(np.int64)
    _copy_arrays(given.GetCellData(), surface.GetCellData(), given.GetNumberOfCells(),
                 lambda values, _: values[ids], ids)
    surface.GetCellData().AddArray(make_array("vtkOriginalCellIds", ids, vtkIdTypeArray))
    return surface


def _copy_arrays(
    given: Any, made: Any, count: int, make: Callable[[NDArray[Any], str | None], NDArray[Any]],
    rows: NDArray[Any]
) -> None:
    """Add the arrays of `given` with a tuple for each of `count` points or cells, but global ids, and keep
    their roles. make: the values from those of an array of a name. rows: of arrays that are no numbers, the
    tuples to copy; those of points come after all that there are."""
    for number in range(given.GetNumberOfArrays()):
        array, role = given.GetAbstractArray(number), given.IsArrayAnAttribute(number)
        if role == vtkDataSetAttributes.GLOBALIDS or array.GetNumberOfTuples() != count:
            continue
        new = array.NewInstance()
        if isinstance(array, vtkDataArray):
            new.DeepCopy(numpy_to_vtk(make(to_numpy(array), array.GetName())))
        else:
            _copy_tuples(array, new, rows, keeps=given.IsA("vtkPointData"))
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
