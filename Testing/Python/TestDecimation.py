# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Parts with relief are closed after decimation, as Examples/Python/printing.py makes it."""

import sys
import unittest
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

from vtkSurfaceDiffusion import vtkSurfaceReliefFilter

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "Examples" / "Python"))
import printing  # noqa: E402


def with_waves(part, wavelength, height):
    """The part with waves along the axes as relief."""
    surface = vtkPolyData()
    surface.ShallowCopy(printing.joined(part))
    values = numpy_to_vtk(np.zeros(surface.GetNumberOfPoints()), deep=True)
    values.SetName("Texture")
    surface.GetPointData().AddArray(values)
    fine = vtkSurfaceReliefFilter()
    fine.SetInputData(surface)
    fine.SetHeight(0.0)
    fine.SetRefineTo(wavelength / 8)
    fine.Update()
    fine = fine.GetOutput()
    points = vtk_to_numpy(fine.GetPoints().GetData()).astype(float)
    waves = numpy_to_vtk(np.prod(np.sin(2 * np.pi / wavelength * points), axis=1), deep=True)
    waves.SetName("Texture")
    fine.GetPointData().AddArray(waves)
    relief = vtkSurfaceReliefFilter()
    relief.SetInputData(fine)
    relief.SetHeight(height)
    relief.Update()
    assert relief.GetOpenEdges() == relief.GetCrossingTriangles() == 0
    return relief.GetOutput()


class Decimation(unittest.TestCase):
    def test_leaves_closed_parts_closed(self):
        for part in (printing.bracket, printing.vase):
            surface = with_waves(part(), 15.0, 0.8)
            fewer = printing.decimated(surface)
            self.assertLess(fewer.GetNumberOfCells(), 0.21 * surface.GetNumberOfCells())
            self.assertEqual(printing.unpaired_edges(fewer), 0)

    def test_leaves_no_triangle_that_hangs_on_one_edge(self):
        corners = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3), (0, 1, 4)]  # the last one
        points = vtkPoints()
        for place in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, -1, 0)):
            points.InsertNextPoint(place)
        triangles = vtkCellArray()
        for triangle in corners:
            triangles.InsertNextCell(3, triangle)
        surface = vtkPolyData()
        surface.SetPoints(points)
        surface.SetPolys(triangles)
        self.assertEqual(printing.unpaired_edges(surface), 3)
        closed = printing.without_fins(surface)
        self.assertEqual(closed.GetNumberOfCells(), 4)
        self.assertEqual(printing.unpaired_edges(closed), 0)


if __name__ == "__main__":
    unittest.main()
