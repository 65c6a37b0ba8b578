# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Bisection of the long edges of ParaView's surfaces before an update. The rules are those of the classes in
C++, Filters/Conversion/PieceRefinement.cxx."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .. import _core
from .._polydata import make_array, refined_polydata, to_numpy
from ._surfaces import BETWEEN, GIVEN_CELL, Block, Shapes


class Refinement:
    """The refined surfaces of an update, which replace its blocks."""

    def __init__(self, shapes: Shapes) -> None:
        self.longest = 0.0  #: edge that is left where the limit was reached; 0: nowhere
        self.triangles = 0  #: of the blocks that were replaced
        self._shapes = shapes
        self._before: list[tuple[Block, Any]] = []

    def bisect(
        self, blocks: list[Block], length: float, limit: int, progress: Callable[[float], Any],
        others: list[Block], roles: dict[str, Any],
    ) -> None:
        """Bisect the edges that are longer, until a block would have more triangles than the limit. others:
        blocks without polygons, which are pieces of surfaces, too. roles: of arrays, by their names."""
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
                block.input = refined_polydata(before, refined["points"], refined["triangles"],
                                               refined["faces"], refined["parents"], roles)
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
