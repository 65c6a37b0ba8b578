# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The module vtkSurfaceDiffusion. What its classes compute is tested in C++; here are what the wrapping
adds, and claims about results of which C++ has a picture only."""

import os
import subprocess
import sys
import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkTriangleFilter
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkSphereSource

from vtkSurfaceDiffusion import (
    vtkFVMHeatFilter, vtkIntrinsicTVFilter, vtkSurfaceDiffusionAlgorithm, vtkTuringTextureFilter)


def sphere(function, resolution=24):
    """A unit sphere with the active array f = function(points)."""
    source = vtkSphereSource()
    source.SetRadius(1.0)
    source.SetThetaResolution(resolution)
    source.SetPhiResolution(resolution)
    source.Update()
    surface = source.GetOutput()
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    array = numpy_to_vtk(function(points), deep=True)
    array.SetName("f")
    surface.GetPointData().SetScalars(array)
    return surface


def noise(points):
    return np.random.default_rng(1).normal(size=len(points))


def halves(points):
    return np.where(points[:, 0] > 0.1, 1.0, 0.0)


def result(filter, name="fDiffused"):
    return vtk_to_numpy(filter.GetOutput().GetPointData().GetArray(name))


def plane(cells, size=8.0):
    source = vtkPlaneSource()
    source.SetPoint1(size, 0, 0)
    source.SetPoint2(0, size, 0)
    source.SetOrigin(0, 0, 0)
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


class TestModule(unittest.TestCase):
    def test_import_needs_no_other_module_first(self):
        code = "from vtkSurfaceDiffusion import vtkFVMHeatFilter; vtkFVMHeatFilter()"
        subprocess.run([sys.executable, "-c", code], check=True, env=os.environ)

    def test_superclass_is_abstract(self):
        self.assertTrue(issubclass(vtkFVMHeatFilter, vtkSurfaceDiffusionAlgorithm))
        with self.assertRaises(TypeError):
            vtkSurfaceDiffusionAlgorithm()

    def test_docstrings_give_formulas_units_and_defaults(self):
        def text(documented):  # the wrapper breaks lines anywhere
            return " ".join(documented.__doc__.split())

        self.assertIn("heat equation", text(vtkFVMHeatFilter))
        self.assertIn("Default: 1,", text(vtkFVMHeatFilter.SetTimeStep))
        self.assertIn("coordinate units", text(vtkFVMHeatFilter.SetFWHM))
        self.assertIn("u_t = div(", text(vtkIntrinsicTVFilter))
        self.assertIn("(R/h)^2", text(vtkIntrinsicTVFilter.SetBeta))
        self.assertIn("Default: 1e-6", text(vtkIntrinsicTVFilter.SetBeta))

    def test_observers_hear_errors_that_name_the_property(self):
        filter = vtkFVMHeatFilter()
        filter.SetInputData(sphere(noise))
        filter.SetTimeStep(-1)
        messages = []

        def listen(_object, _event, text):
            messages.append(text)

        listen.CallDataType = "string0"
        filter.AddObserver("ErrorEvent", listen)
        filter.Update()
        self.assertEqual(len(messages), 1)
        self.assertIn("TimeStep is -1; allowed: finite numbers above 0", messages[0])
        self.assertIsNone(filter.GetOutput().GetPointData().GetArray("fDiffused"))
        filter.SetTimeStep(1)
        filter.Update()
        self.assertIsNotNone(filter.GetOutput().GetPointData().GetArray("fDiffused"))

    def test_total_variation_denoises_patches_better_than_linear_diffusion_each_at_its_best(self):
        surface = sphere(lambda points: halves(points) + 0.25 * noise(points), 40)
        truth = halves(vtk_to_numpy(surface.GetPoints().GetData()).astype(float))

        def error(function, weight):
            filter = vtkIntrinsicTVFilter()
            filter.SetInputData(surface)
            filter.SetEdgeFunction(function)
            filter.SetFidelityWeight(weight)
            filter.Update()
            return np.sqrt(np.mean((result(filter, "fTV") - truth) ** 2))

        tv = min(error(vtkIntrinsicTVFilter.EDGE_FUNCTION_TOTAL_VARIATION, k) for k in (3.0, 6.0, 10.0))
        linear = min(error(vtkIntrinsicTVFilter.EDGE_FUNCTION_CONSTANT, 10.0**k)
                     for k in np.linspace(-2, 1, 13))
        self.assertLess(tv, 0.6 * linear)

    def test_the_ratio_of_the_rates_chooses_spots_labyrinths_or_nets(self):
        surface = plane(64)

        def number(ratio, seed=0):
            filter = vtkTuringTextureFilter()
            filter.SetInputData(surface)
            filter.SetFeatureSize(1.0)
            filter.SetDiffusionRate1(2.6 * ratio)
            filter.SetTimeStep(0.125)
            filter.SetNumberOfTimeSteps(360)
            filter.SetStopTolerance(0)
            filter.SetRandomSeed(seed)
            filter.Update()
            u1 = result(filter, "u1")
            return euler_number(surface, u1 > np.median(u1))

        spots = number(5.0)
        self.assertGreater(spots, 20)  # spots are components
        self.assertLess(sum(number(30.0, seed) for seed in range(5)), -16)  # a net has holes
        self.assertLess(abs(number(16.0)), 0.5 * spots)


if __name__ == "__main__":
    unittest.main(verbosity=2)
