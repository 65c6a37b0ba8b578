# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The texture and direction field filters in Python."""

import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkFiltersCore import vtkTriangleFilter
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkSphereSource

from vtkSurfaceDiffusion import vtkSurfaceDirectionFieldFilter, vtkTuringTextureFilter


def plane(cells, size=8.0):
    source = vtkPlaneSource()
    source.SetOrigin(0, 0, 0)
    source.SetPoint1(size, 0, 0)
    source.SetPoint2(0, size, 0)
    source.SetResolution(cells, cells)
    triangles = vtkTriangleFilter()
    triangles.SetInputConnection(source.GetOutputPort())
    triangles.Update()
    return triangles.GetOutput()


def euler_number(surface, inside):
    """The Euler number, components minus holes, of the part that the vertices inside span."""
    faces = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    pairs = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = np.unique(np.sort(pairs, axis=1), axis=0)
    return inside.sum() - inside[edges].all(axis=1).sum() + inside[faces].all(axis=1).sum()


def texture(surface, **properties):
    """u1 of a texture with these properties."""
    filter = vtkTuringTextureFilter()
    filter.SetInputData(surface)
    for name, value in properties.items():
        getattr(filter, "Set" + name)(value)
    filter.Update()
    return vtk_to_numpy(filter.GetOutput().GetPointData().GetArray("u1"))


class TestTuringTextureFilter(unittest.TestCase):
    def test_the_ratio_of_the_rates_chooses_spots_labyrinths_or_nets(self):
        surface = plane(64)
        number = {}
        for ratio in (5.0, 16.0, 30.0):
            u1 = texture(surface, FeatureSize=1.0, DiffusionRate1=2.6 * ratio, TimeStep=0.125,
                         NumberOfTimeSteps=360, StopTolerance=0)
            number[ratio] = euler_number(surface, u1 > np.median(u1))
        self.assertGreater(number[5.0], 20)  # spots are components
        self.assertLess(number[30.0], -8)  # a net has holes
        self.assertLess(abs(number[16.0]), 0.5 * number[5.0])

    def test_stripes_follow_a_direction_given_as_an_array(self):
        surface = plane(48, 6.0)
        direction = np.tile([1.0, 1.0, 0.0], (surface.GetNumberOfCells(), 1))
        array = numpy_to_vtk(direction, deep=True)
        array.SetName("diagonal")
        surface.GetCellData().AddArray(array)
        filter = vtkTuringTextureFilter()
        filter.SetInputData(surface)
        filter.SetInputArrayToProcess(2, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "diagonal")
        filter.SetDiffusionRate2(5.8)
        filter.SetDiffusionRateAcross2(2.6)
        filter.SetNumberOfTimeSteps(240)
        filter.Update()
        points = filter.GetOutput().GetPointData()
        order = np.lexsort(vtk_to_numpy(surface.GetPoints().GetData())[:, :2].T)
        grid = vtk_to_numpy(points.GetArray("u1"))[order].reshape(49, 49)
        dy, dx = np.gradient(grid)
        along = ((dx + dy) ** 2).sum() / 2.0
        across = ((dx - dy) ** 2).sum() / 2.0
        self.assertGreater(across, 8.0 * along)

    def test_a_run_stops_when_the_pattern_is_stationary(self):
        filter = vtkTuringTextureFilter()
        filter.SetInputData(plane(24))
        filter.SetNumberOfTimeSteps(5000)
        filter.SetStopTolerance(0.05)
        filter.Update()
        history = filter.GetOutputDataObject(1)
        self.assertLess(history.GetNumberOfRows(), 2000)
        time = vtk_to_numpy(history.GetColumnByName("Time"))
        self.assertGreater(time[-1], 5.0)

    def test_a_smooth_field_covers_a_sphere(self):
        source = vtkSphereSource()
        source.SetThetaResolution(24)
        source.SetPhiResolution(24)
        filter = vtkSurfaceDirectionFieldFilter()
        filter.SetInputConnection(source.GetOutputPort())
        filter.SetMethodToSmooth()
        filter.Update()
        field = vtk_to_numpy(filter.GetOutput().GetCellData().GetArray("Direction"))
        np.testing.assert_allclose(np.linalg.norm(field, axis=1), 1.0, atol=1e-9)


if __name__ == "__main__":
    unittest.main(verbosity=2)
