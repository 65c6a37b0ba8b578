# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""VTK joins the seams of parametric surfaces with triangles without area, whose orientations are random:
they must turn no others."""

import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonComputationalGeometry import vtkParametricTorus
from vtkmodules.vtkFiltersSources import vtkParametricFunctionSource

from vtkSurfaceDiffusion import (
    vtkSurfaceCurvatureFilter, vtkSurfaceDerivativesFilter, vtkSurfaceReliefFilter)


def torus():
    """Of the radii 1 and 0.5, with 1 and with a rotation about z at the points."""
    source = vtkParametricFunctionSource()
    source.SetParametricFunction(vtkParametricTorus())
    source.SetUResolution(60)
    source.SetVResolution(60)
    source.Update()
    surface = source.GetOutput()
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    turning = np.c_[-points[:, 1], points[:, 0], 0 * points[:, 0]]
    for name, values in (("one", np.ones(len(points))), ("turning", turning)):
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        surface.GetPointData().AddArray(array)
    return surface


class TestParametricSurfaces(unittest.TestCase):
    def setUp(self):
        self.surface = torus()
        self.warnings = []

    def result(self, filter_, name):
        filter_.SetInputData(self.surface)
        filter_.AddObserver("WarningEvent", lambda *_: self.warnings.append(1))
        filter_.Update()
        return vtk_to_numpy(filter_.GetOutput().GetPointData().GetArray(name))

    def test_mean_curvature_has_one_sign(self):
        mean = self.result(vtkSurfaceCurvatureFilter(), "MeanCurvature")
        self.assertGreater(mean.min(), 0.0)
        self.assertEqual(self.warnings, [])

    def test_curl_is_that_of_the_rotation(self):
        derivatives = vtkSurfaceDerivativesFilter()
        derivatives.SetInputArrayToProcess(0, 0, 0, 0, "turning")
        derivatives.SetQuantityToCurl()
        curl = self.result(derivatives, "turningCurl")
        z = vtk_to_numpy(self.surface.GetPoints().GetData())[:, 2]
        self.assertLess(np.abs(curl - 4.0 * z).max(), 0.2)

    def test_relief_rises_outwards(self):
        relief = vtkSurfaceReliefFilter()
        relief.SetInputArrayToProcess(0, 0, 0, 0, "one")
        relief.SetHeight(0.05)
        self.result(relief, "ReliefHeight")
        p = vtk_to_numpy(relief.GetOutput().GetPoints().GetData())
        self.assertGreater(np.hypot(np.hypot(p[:, 0], p[:, 1]) - 1.0, p[:, 2]).min(), 0.499)


if __name__ == "__main__":
    unittest.main()
