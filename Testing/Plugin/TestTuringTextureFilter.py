# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The texture and direction field filters in paraview.simple."""

import os
import tempfile
import unittest

from paraview import servermanager
from paraview.simple import (
    Cylinder, FVMHeatFilter, GetAnimationScene, SurfaceDirectionFieldFilter, TuringTextureFilter,
    Triangulate)
from plugin_testing import errors_of, read_sphere, values


class TestTuringTextureFilter(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name

    def setUp(self):
        self.sphere = read_sphere(os.path.join(self.folder, "sphere.vtp"))

    def test_a_pattern_grows_on_a_surface_without_any_choice_of_arrays(self):
        texture = TuringTextureFilter(self.sphere, FeatureSize=0.6, NumberOfTimeSteps=160)
        self.assertEqual(texture.InputArray[1], "")
        u2 = values(texture, "u2")
        self.assertGreater(max(u2), 6.0)
        self.assertGreaterEqual(min(u2), 0.0)
        self.assertEqual(len(values(texture, "Clamped", port=1)), 161)
        texture.SMProxy.UpdatePropertyInformation()
        self.assertAlmostEqual(texture.GetPropertyValue("Wavelength"), 0.6)

    def test_the_clock_plays_its_growth(self):
        texture = TuringTextureFilter(
            self.sphere, NumberOfTimeSteps=16, GenerateTimeSteps=1, OutputInterval=4)
        self.assertEqual(list(texture.TimestepValues), [0.0, 0.25, 0.5, 0.75, 1.0])
        scene = GetAnimationScene()
        scene.UpdateAnimationUsingDataTimeSteps()
        self.assertEqual(scene.EndTime, 1.0)

    def test_an_initial_state_needs_two_components(self):
        texture = TuringTextureFilter(
            self.sphere, InputArray=["POINTS", "pair"], NumberOfTimeSteps=0)
        pair = servermanager.Fetch(self.sphere).GetPointData().GetArray("pair")
        self.assertEqual(values(texture, "u1")[5], pair.GetComponent(5, 0))
        self.assertEqual(values(texture, "u2")[5], pair.GetComponent(5, 1))

    def test_colours_are_added_on_request(self):
        texture = TuringTextureFilter(self.sphere, NumberOfTimeSteps=4, ColorOutput=1,
                                      LowColor=[0.0, 0.0, 0.0], HighColor=[1.0, 0.0, 0.0])
        colour = servermanager.Fetch(texture).GetPointData().GetArray("TextureColor")
        self.assertEqual(colour.GetRange(0), (0.0, 255.0))
        self.assertEqual(colour.GetRange(1), (0.0, 0.0))

    def test_every_kinetics_can_be_chosen_by_name(self):
        for kinetics in ("Turing", "Schnakenberg", "GrayScott", "Brusselator", "GiererMeinhardt",
                         "FitzHughNagumo"):
            texture = TuringTextureFilter(
                self.sphere, Kinetics=kinetics, AutomaticTimeStep=1, NumberOfTimeSteps=4)
            self.assertIsNotNone(values(texture, "u1"), kinetics)

    def test_an_invalid_rate_is_an_error_that_names_it(self):
        texture = TuringTextureFilter(self.sphere, DecayRate=-1.0)
        errors = errors_of(texture)
        texture.UpdatePipeline()
        self.assertEqual(len(set(errors)), 1)
        self.assertIn("DecayRate is -1", errors[0])

    def test_stripes_follow_a_direction_field(self):
        field = SurfaceDirectionFieldFilter(self.sphere, Method="Smooth")
        texture = TuringTextureFilter(
            field, DirectionArray=["CELLS", "Direction"], DiffusionRateAcross2=1.2,
            NumberOfTimeSteps=16)
        self.assertIsNotNone(values(texture, "u1"))

    def test_the_direction_field_filter_directs_the_heat_filter(self):
        cylinder = Triangulate(Cylinder(Resolution=24))
        field = SurfaceDirectionFieldFilter(cylinder, SmoothingLength=0.0)
        data = servermanager.Fetch(field).GetCellData()
        self.assertEqual(data.GetVectors().GetName(), "Direction")
        self.assertAlmostEqual(abs(data.GetArray("Direction").GetComponent(0, 1)), 1.0, 2)
        on_sphere = SurfaceDirectionFieldFilter(
            self.sphere, Method="Hints", DirectionArray=["CELLS", "up"])
        heat = FVMHeatFilter(
            on_sphere, InputArray=["POINTS", "noisy"], DirectionArray=["CELLS", "Direction"],
            AcrossDiffusivity=0.1)
        self.assertIsNotNone(values(heat, "noisyDiffused"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
