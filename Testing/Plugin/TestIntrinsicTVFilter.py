# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The intrinsic TV filter in paraview.simple."""

import os
import random
import tempfile
import unittest

from paraview import servermanager
from paraview.simple import FVMHeatFilter, IntrinsicTVFilter, OutputPort, XMLPolyDataReader
from paraview.vtk import vtkUnsignedCharArray
from plugin_testing import add_array, errors_of, read_sphere, root_mean_square, values
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter


def clean_color(point):
    """Two hues and a jump in brightness."""
    x, y, _ = point
    return (200, 90, 40) if x > 0.2 else (60, 120, 200 if y > 0 else 130)


class TestIntrinsicTVFilter(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name

    def setUp(self):
        self.sphere = read_sphere(os.path.join(self.folder, "sphere.vtp"))

    def colored_sphere(self):
        """A reader of a sphere with the colours `clean` and, active, `noisy`."""
        surface = servermanager.Fetch(self.sphere)
        noise = random.Random(2)
        clean = [clean_color(surface.GetPoint(i)) for i in range(surface.GetNumberOfPoints())]
        noisy = [
            tuple(min(255, max(0, round(value + noise.gauss(0, 50)))) for value in color)
            for color in clean
        ]
        data = surface.GetPointData()
        while data.GetNumberOfArrays():
            data.RemoveArray(0)
        add_array(data, "clean", clean, vtkUnsignedCharArray())
        data.SetScalars(add_array(data, "noisy", noisy, vtkUnsignedCharArray()))
        writer = vtkXMLPolyDataWriter()
        path = os.path.join(self.folder, "colors.vtp")
        writer.SetFileName(path)
        writer.SetInputData(surface)
        writer.SetDataModeToBinary()
        self.assertTrue(writer.Write())
        reader = XMLPolyDataReader(FileName=[path])
        reader.UpdatePipeline()
        return reader

    def test_first_apply_denoises_colors(self):
        colors = self.colored_sphere()
        tv = IntrinsicTVFilter(colors)
        self.assertEqual(tv.InputArray[1], "noisy")
        clean = values(colors, "clean")
        before = root_mean_square(values(colors, "noisy"), clean)
        after = root_mean_square(values(tv, "noisyTV"), clean)
        self.assertGreater(before, 40.0)
        self.assertLess(after, before / 3)
        # Three components of unsigned char keep their type.
        array = servermanager.Fetch(tv).GetPointData().GetArray("noisyTV")
        self.assertEqual(array.GetNumberOfComponents(), 3)
        self.assertEqual(array.GetDataTypeAsString(), "unsigned char")

    def test_enums_have_texts(self):
        tv = IntrinsicTVFilter(
            self.sphere, Mode="SteadyState", EdgeFunction="Charbonnier", FidelityNorm="L1",
            ChannelCoupling="PerChannel", Discretization="CrouzeixRaviart",
            TimeIntegrator="Implicit", AcrossEdgeFunction="Same")
        self.assertEqual(values(tv, "Step", port=1), [0, 1])
        with self.assertRaises(ValueError):
            tv.TimeIntegrator = "SecondOrder"

    def test_automatic_fidelity_reports_the_weight(self):
        tv = IntrinsicTVFilter(self.sphere, AutomaticFidelity=1, NoiseLevel=0.17)
        tv.UpdatePipeline()
        tv.SMProxy.UpdatePropertyInformation()
        self.assertGreater(tv.GetPropertyValue("EffectiveFidelityWeight"), 0.0)
        self.assertNotEqual(tv.GetPropertyValue("EffectiveFidelityWeight"), 3.0)

    def test_time_unit_is_h_times_r(self):
        tv = IntrinsicTVFilter(self.sphere)
        tv.UpdatePipeline()
        tv.SMProxy.UpdatePropertyInformation()
        h, r, unit = map(tv.GetPropertyValue, ("MeanEdgeLength", "ValueRange", "TimeUnit"))
        self.assertAlmostEqual(unit, h * r)

    def test_masked_points_are_filled_in_from_their_boundary(self):
        tv = IntrinsicTVFilter(
            self.sphere, InputArray=["POINTS", "damaged"], MaskArray=["POINTS", "hole"],
            HoldKnownValues=1, Mode="SteadyState")
        filled = values(tv, "damagedTV")
        hole = values(self.sphere, "hole")
        noisy = values(self.sphere, "noisy")
        self.assertTrue(all(f == n for f, n, h in zip(filled, noisy, hole) if not h))
        self.assertLess(max(abs(f) for f, h in zip(filled, hole) if h), 1.3)

    def test_an_across_edge_function_needs_a_direction(self):
        tv = IntrinsicTVFilter(self.sphere, AcrossEdgeFunction="Constant")
        errors = errors_of(tv)
        tv.UpdatePipeline()
        self.assertEqual(len(set(errors)), 1)
        self.assertIn("AcrossEdgeFunction", errors[0])
        tv.DirectionArray = ["CELLS", "up"]
        self.assertIsNotNone(values(tv, "noisyTV"))
        self.assertEqual(len(set(errors)), 1)

    def test_it_chains_with_the_other_filters(self):
        heat = FVMHeatFilter(self.sphere)
        tv = IntrinsicTVFilter(OutputPort(heat, 0))
        self.assertIsNotNone(values(tv, "noisyDiffusedTV"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
