# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The harmonic map filter in Python."""

import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersSources import vtkSphereSource

from vtkSurfaceDiffusion import vtkHarmonicMapFilter


def noisy_sphere():
    """A unit sphere and its normals, exact and with noise; the noisy ones are active."""
    source = vtkSphereSource()
    source.SetRadius(1.0)
    source.SetThetaResolution(48)
    source.SetPhiResolution(48)
    source.GenerateNormalsOff()
    source.Update()
    surface = source.GetOutput()
    exact = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    noise = np.random.default_rng(1).normal(scale=0.2, size=exact.shape)
    array = numpy_to_vtk(exact + noise, deep=True)
    array.SetName("n")
    surface.GetPointData().SetNormals(array)
    return surface, exact


def angles(a, b):
    """The angles between two arrays of unit vectors, row by row, in degrees."""
    lengths = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    return np.degrees(np.arccos(np.clip((a * b).sum(axis=1) / lengths, -1.0, 1.0)))


class TestHarmonicMapFilter(unittest.TestCase):
    def test_noise_is_removed_from_the_normals(self):
        surface, exact = noisy_sphere()
        filter = vtkHarmonicMapFilter()
        filter.SetInputData(surface)
        filter.SetTimeStep(0.05)
        filter.SetNumberOfTimeSteps(10)
        filter.Update()
        normals = vtk_to_numpy(filter.GetOutput().GetPointData().GetNormals())
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-12)
        before = angles(vtk_to_numpy(surface.GetPointData().GetNormals()), exact).mean()
        self.assertGreater(before, 10.0)
        self.assertLess(angles(normals, exact).mean(), 0.35 * before)
        energy = vtk_to_numpy(filter.GetOutputDataObject(1).GetColumnByName("Energy"))
        self.assertTrue((np.diff(energy) <= 0).all())

    def test_the_papers_scheme_is_one_call(self):
        filter = vtkHarmonicMapFilter()
        filter.SetInputData(noisy_sphere()[0])
        filter.SetExponent(2.0)
        filter.SetTimeStep(0.1)
        filter.SetNumberOfTimeSteps(10)
        filter.UsePaperScheme()
        self.assertEqual(filter.GetSchemeAsString(), "ExplicitReaction")
        filter.Update()
        self.assertIsNotNone(filter.GetOutput().GetPointData().GetArray("nHarmonic"))

    def test_moving_vertices_denoises_a_sphere(self):
        surface, exact = noisy_sphere()
        surface.GetPointData().Initialize()  # the normals of the noisy surface are computed
        points = vtk_to_numpy(surface.GetPoints().GetData())
        points += np.random.default_rng(2).normal(scale=0.01, size=points.shape)
        filter = vtkHarmonicMapFilter()
        filter.SetInputData(surface)
        filter.SetTimeStep(0.1)
        filter.SetNumberOfTimeSteps(10)
        filter.MoveVerticesOn()
        filter.Update()
        moved = vtk_to_numpy(filter.GetOutput().GetPoints().GetData())
        self.assertLess(np.linalg.norm(moved, axis=1).std(), np.linalg.norm(points, axis=1).std())
        self.assertGreater(filter.GetMaximumDisplacement(), filter.GetMeanDisplacement())
        self.assertAlmostEqual(filter.GetVolumeAfter() / filter.GetVolumeBefore(), 1.0, 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
