# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Filters in paraview.simple: menus, the clock, states, and chains. What they compute is tested in C++."""

import os
import tempfile
import unittest

from paraview import servermanager, smstate
from paraview.simple import (
    Contour, CreateView, Delete, FindSource, FVMHeatFilter, GetActiveViewOrCreate, GetAnimationScene,
    HarmonicMapFilter, IntrinsicTVFilter, LoadState, OutputPort, PointSource, ResetSession, SaveState,
    Show, SurfaceDirectionFieldFilter, TuringTextureFilter,
)
from plugin_testing import errors_of, menu, read_sphere, root_mean_square, values


class TestSimple(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name

    def setUp(self):
        self.sphere = read_sphere(self.path("sphere.vtp"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def test_first_apply_removes_most_of_the_noise(self):
        heat = FVMHeatFilter(self.sphere)
        self.assertEqual(heat.InputArray[1], "noisy")
        clean = values(self.sphere, "clean")
        before = root_mean_square(values(self.sphere, "noisy"), clean)
        after = root_mean_square(values(heat, "noisyDiffused"), clean)
        self.assertGreater(before, 0.15)
        self.assertLess(after, before / 2)

    def test_words_that_a_menu_does_not_have_are_errors(self):
        heat = FVMHeatFilter(self.sphere, Mode="SteadyState")
        self.assertEqual(heat.Mode, "SteadyState")
        with self.assertRaises(ValueError):
            heat.Mode = "Steady"

    def test_menus_list_only_arrays_that_fit(self):
        heat = FVMHeatFilter(self.sphere)
        scalars = {"POINTS " + name for name in ("clean", "noisy", "damaged", "hole", "poles")}
        vectors = {"POINTS Normals", "POINTS east"}
        self.assertEqual(
            menu(heat, "InputArray"), scalars | vectors | {"POINTS pair", "CELLS odd", "CELLS up"})
        self.assertEqual(menu(heat, "MaskArray"), scalars | {"CELLS odd"})
        self.assertEqual(menu(heat, "FixedArray"), scalars | {"CELLS odd"})
        self.assertEqual(menu(heat, "DirectionArray"), vectors | {"CELLS up"})
        self.assertEqual(menu(HarmonicMapFilter(self.sphere), "InputArray"),
                         vectors | {"POINTS pair", "CELLS up"})

    def test_optional_arrays_are_not_set_by_default_and_an_empty_name_is_the_active_array(self):
        heat = FVMHeatFilter(self.sphere)
        for array in (heat.MaskArray, heat.DirectionArray, heat.FixedArray):
            self.assertEqual(array[1], "")
        self.assertEqual(TuringTextureFilter(self.sphere).InputArray[1], "")
        heat.InputArray = ["POINTS", ""]
        self.assertIsNotNone(values(heat, "noisyDiffused"))

    def test_the_panel_offers_the_properties_of_cells_for_cell_data_only(self):
        heat = FVMHeatFilter(self.sphere, InputArray=["POINTS", "noisy"])
        for key in ("ResultOnCells", "KeepCellDetail"):
            hints = heat.SMProxy.GetProperty(key).GetHints()
            decorator = hints.FindNestedElementByName("PropertyWidgetDecorator")
            self.assertEqual(decorator.GetAttribute("property"), "InputArray")
            index = int(decorator.GetAttribute("index"))
            shown = decorator.GetAttribute("value")
            for association, expected in (("POINTS", False), ("CELLS", True)):
                heat.InputArray = [association, "noisy" if association == "POINTS" else "odd"]
                element = heat.SMProxy.GetProperty("InputArray").GetElement(index)
                self.assertEqual(element == shown, expected, (key, association))

    def test_information_properties_report_the_units(self):
        noisy = values(self.sphere, "noisy")
        for filter, unit in ((FVMHeatFilter(self.sphere), lambda h, r: h * h),
                             (IntrinsicTVFilter(self.sphere), lambda h, r: h * r)):
            filter.UpdatePipeline()
            filter.SMProxy.UpdatePropertyInformation()
            h, r = map(filter.GetPropertyValue, ("MeanEdgeLength", "ValueRange"))
            self.assertAlmostEqual(r, max(noisy) - min(noisy))
            self.assertAlmostEqual(filter.GetPropertyValue("TimeUnit"), unit(h, r))

    def test_shading_shows_harmonic_normals_at_once(self):
        harmonic = HarmonicMapFilter(self.sphere)
        self.assertEqual(harmonic.InputArray[1], "")
        view = CreateView("RenderView")
        self.addCleanup(Delete, view)
        display = Show(harmonic, view)
        self.assertEqual(display.SelectNormalArray, "NormalsHarmonic")

    def test_clock_plays_seeks_and_reverses(self):
        # The same solver for all, since Automatic depends on the number of steps.
        heat = FVMHeatFilter(
            self.sphere, GenerateTimeSteps=1, NumberOfTimeSteps=6, OutputInterval=2,
            TimeStep=0.5, Solver="Direct")
        heat.UpdatePipelineInformation()
        self.assertEqual(list(heat.TimestepValues), [0.0, 1.0, 2.0, 3.0])
        self.addCleanup(ResetSession)  # resets the clock
        view = GetActiveViewOrCreate("RenderView")
        self.addCleanup(Delete, view)
        Show(heat, view)
        scene = GetAnimationScene()
        scene.UpdateAnimationUsingDataTimeSteps()
        self.assertEqual(list(scene.TimeKeeper.TimestepValues), [0.0, 1.0, 2.0, 3.0])
        frames = {}
        for time in (0.0, 3.0, 1.0, 2.0):
            scene.AnimationTime = time
            frames[time] = values(heat, "noisyDiffused")
            reference = FVMHeatFilter(
                self.sphere, TimeStep=0.5, NumberOfTimeSteps=int(2 * time), Solver="Direct")
            # Not assertEqual, which takes minutes to show the difference of two long lists.
            self.assertTrue(frames[time] == values(reference, "noisyDiffused"))
        self.assertTrue(frames[0.0] == values(self.sphere, "noisy"))
        for move, time in (
            (scene.GoToFirst, 0.0), (scene.Play, 3.0), (scene.GoToPrevious, 2.0),
            (scene.GoToPrevious, 1.0), (scene.GoToNext, 2.0), (scene.GoToLast, 3.0),
        ):
            move()
            self.assertEqual(scene.TimeKeeper.Time, time)
            self.assertTrue(values(heat, "noisyDiffused") == frames[time])

    def test_downstream_filters_follow_the_clock(self):
        heat = FVMHeatFilter(self.sphere, GenerateTimeSteps=1)
        heat.UpdatePipeline(0.0)
        contour = Contour(Input=heat, ContourBy=["POINTS", "noisyDiffused"], Isosurfaces=[0.0])
        lengths = {}
        for time in (0.0, 10.0, 0.0):
            contour.UpdatePipeline(time)
            lengths.setdefault(time, set()).add(servermanager.Fetch(contour).GetNumberOfPoints())
        self.assertEqual([len(lengths[0.0]), len(lengths[10.0])], [1, 1])
        self.assertGreater(min(lengths[0.0]), max(lengths[10.0]))

    def test_a_wrong_array_is_an_error_that_names_the_property_until_it_is_corrected(self):
        for name, wrong, right in (
            ("InputArray", ["POINTS", "nothing"], ["POINTS", "noisy"]),
            ("InputArray", ["POINTS", "names"], ["POINTS", "noisy"]),
            ("MaskArray", ["POINTS", "pair"], ["POINTS", ""]),
            ("DirectionArray", ["CELLS", "nothing"], ["CELLS", "up"]),
        ):
            heat = FVMHeatFilter(self.sphere)
            errors = errors_of(heat)
            setattr(heat, name, wrong)
            heat.UpdatePipeline()
            self.assertEqual(len(errors), 1, errors)
            self.assertIn(name, errors[0])
            errors.clear()
            setattr(heat, name, right)
            self.assertIsNotNone(values(heat, "noisyDiffused"))
            self.assertEqual(errors, [])

    def test_an_input_without_polygons_is_an_error(self):
        points = PointSource(NumberOfPoints=5)
        heat = FVMHeatFilter(points)
        errors = errors_of(heat)
        heat.UpdatePipeline()
        self.assertEqual(len(errors), 1)
        self.assertEqual(heat.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints(), 5)

    def test_filters_chain(self):
        """A direction field directs the heat filter, whose result the others take."""
        field = SurfaceDirectionFieldFilter(self.sphere, Method="Hints", DirectionArray=["CELLS", "up"])
        heat = FVMHeatFilter(
            field, InputArray=["POINTS", "noisy"], DirectionArray=["CELLS", "Direction"],
            AcrossDiffusivity=0.1)
        tv = IntrinsicTVFilter(OutputPort(heat, "Surface"), InputArray=["POINTS", "noisyDiffused"])
        harmonic = HarmonicMapFilter(tv)
        for name in ("noisyDiffused", "noisyDiffusedTV", "NormalsHarmonic"):
            self.assertIsNotNone(values(harmonic, name), name)
        self.assertIsNotNone(servermanager.Fetch(harmonic).GetCellData().GetArray("Direction"))

    def check_state(self, name, save, load):
        heat = FVMHeatFilter(
            self.sphere, registrationName="Heat", InputArray=["POINTS", "damaged"],
            MaskArray=["POINTS", "hole"], DirectionArray=["CELLS", "up"], AlongDiffusivity=3,
            FidelityWeight=0.5, InitialFill="Noise", RandomSeed=3, GenerateTimeSteps=1,
            Solver="ConjugateGradient", ResultArrayName="result", TimeIntegrator="FirstOrder")
        self.addCleanup(ResetSession)
        heat.UpdatePipeline(4.0)
        before = values(heat, "result")
        save(self.path(name))
        ResetSession()
        self.assertIsNone(FindSource("Heat"))
        load(self.path(name))
        heat = FindSource("Heat")
        heat.UpdatePipeline(4.0)
        self.assertTrue(values(heat, "result") == before)
        self.assertEqual(heat.InitialFill, "Noise")
        self.assertEqual(list(heat.DirectionArray), ["CELLS", "up"])

    def test_state_file_gives_the_same_result(self):
        self.check_state("heat.pvsm", SaveState, LoadState)

    def test_python_state_gives_the_same_result(self):
        def save(path):
            with open(path, "w") as script:
                script.write(smstate.get_state())

        def load(path):
            with open(path) as script:
                exec(script.read(), {"__name__": "state"})

        self.check_state("heat.py", save, load)


if __name__ == "__main__":
    unittest.main(verbosity=2)
