# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The harmonic map filter in paraview.simple."""

import os
import tempfile
import unittest

from paraview import servermanager
from paraview.simple import (
    Cone, CreateView, FVMHeatFilter, HarmonicMapFilter, OutputPort, Show, Sphere,
)
from plugin_testing import errors_of, menu, read_sphere, values


class TestHarmonicMapFilter(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name

    def setUp(self):
        self.sphere = read_sphere(os.path.join(self.folder, "sphere.vtp"))

    def test_the_normals_are_the_default(self):
        harmonic = HarmonicMapFilter(self.sphere)
        self.assertEqual(harmonic.InputArray[1], "")
        data = servermanager.Fetch(harmonic).GetPointData()
        self.assertEqual(data.GetNormals().GetName(), "NormalsHarmonic")

    def test_the_menu_lists_only_vectors(self):
        harmonic = HarmonicMapFilter(self.sphere)
        self.assertEqual(
            menu(harmonic, "InputArray"), {"POINTS Normals", "POINTS east", "POINTS pair", "CELLS up"})

    def test_shading_shows_the_result_at_once(self):
        harmonic = HarmonicMapFilter(self.sphere)
        display = Show(harmonic, CreateView("RenderView"))
        self.assertEqual(display.SelectNormalArray, "NormalsHarmonic")

    def test_a_surface_without_any_array_can_be_regularised(self):
        cone = Cone(Resolution=20)
        cone.UpdatePipeline()
        self.assertIsNone(cone.PointData.GetArray("Normals"))
        harmonic = HarmonicMapFilter(cone, TimeStep=0.05)
        data = servermanager.Fetch(harmonic).GetPointData()
        self.assertEqual(data.GetNormals().GetName(), "NormalsHarmonic")

    def test_energy_decreases_for_every_exponent(self):
        for exponent in (1.0, 1.5, 2.0):
            harmonic = HarmonicMapFilter(
                self.sphere, InputArray=["POINTS", "east"], Exponent=exponent, TimeStep=10.0)
            energy = values(harmonic, "Energy", port=1)
            self.assertEqual(len(energy), 4)
            self.assertTrue(all(b <= a for a, b in zip(energy, energy[1:])), energy)

    def test_vertices_move_on_request_and_displacements_are_reported(self):
        harmonic = HarmonicMapFilter(Sphere(ThetaResolution=40, PhiResolution=40))

        def reported(name):
            harmonic.UpdatePipeline()
            harmonic.SMProxy.UpdatePropertyInformation()
            return harmonic.GetPropertyValue(name)

        self.assertEqual(reported("MaximumDisplacement"), 0.0)
        harmonic.MoveVertices = 1
        self.assertGreater(reported("MaximumDisplacement"), reported("MeanDisplacement"))
        self.assertGreater(reported("MeanDisplacement"), 0.0)
        self.assertAlmostEqual(reported("VolumeAfter") / reported("VolumeBefore"), 1.0, 1)

    def test_a_scalar_is_an_error_that_names_it(self):
        harmonic = HarmonicMapFilter(self.sphere, InputArray=["POINTS", "noisy"])
        errors = errors_of(harmonic)
        harmonic.UpdatePipeline()
        self.assertEqual(len(set(errors)), 1)
        self.assertIn("noisy", errors[0])
        self.assertIn("2 or more", errors[0])

    def test_it_chains_with_the_other_filters(self):
        heat = FVMHeatFilter(self.sphere, InputArray=["POINTS", "noisy"])
        harmonic = HarmonicMapFilter(OutputPort(heat, 0), LineField=1, Scheme="MinimizingMovement")
        self.assertIsNotNone(values(harmonic, "NormalsHarmonic"))
        self.assertIsNotNone(values(harmonic, "noisyDiffused"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
