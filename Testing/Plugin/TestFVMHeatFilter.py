# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The heat filter in paraview.simple."""

import os
import tempfile
import unittest

from paraview import servermanager, smstate
from paraview.simple import (
    Contour, Delete, FindSource, FVMHeatFilter, GetActiveViewOrCreate, GetAnimationScene,
    GroupDatasets, LoadState, OutputPort, PointSource, ResetSession, SaveState, Show,
)
from plugin_testing import errors_of, menu, read_sphere, root_mean_square, values


class TestFVMHeatFilter(unittest.TestCase):
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

    def test_the_active_scalars_are_the_default(self):
        heat = FVMHeatFilter(self.sphere, InputArray=["POINTS", ""])
        self.assertIsNotNone(values(heat, "noisyDiffused"))

    def test_enums_have_texts(self):
        heat = FVMHeatFilter(self.sphere, Mode="SteadyState", Units="Absolute")
        self.assertEqual(values(heat, "Step", port=1), [0, 1])
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

    def test_optional_arrays_are_not_set_by_default(self):
        heat = FVMHeatFilter(self.sphere)
        for array in (heat.MaskArray, heat.DirectionArray, heat.FixedArray):
            self.assertEqual(array[1], "")

    def test_cell_data_have_a_result_on_cells(self):
        heat = FVMHeatFilter(self.sphere, InputArray=["CELLS", "odd"])
        heat.UpdatePipeline()
        cells = heat.CellData
        self.assertIsNone(heat.PointData.GetArray("oddDiffused"))
        low, high = cells.GetArray("oddDiffused").GetRange()
        self.assertTrue(0.4 < low < high < 0.6, (low, high))
        heat.NumberOfTimeSteps = 0
        heat.UpdatePipeline()
        low, high = heat.CellData.GetArray("oddDiffused").GetRange()
        self.assertEqual((low, high), (0.0, 1.0))  # with the detail
        heat.KeepCellDetail = 0
        heat.UpdatePipeline()
        low, high = heat.CellData.GetArray("oddDiffused").GetRange()
        self.assertTrue(0.1 < low < high < 0.9, (low, high))
        heat.ResultOnCells = 0
        heat.UpdatePipeline()
        self.assertIsNotNone(heat.PointData.GetArray("oddDiffused"))
        self.assertIsNone(heat.CellData.GetArray("oddDiffused"))

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

    def test_masked_points_are_filled_in_from_their_boundary(self):
        heat = FVMHeatFilter(
            self.sphere, InputArray=["POINTS", "damaged"], MaskArray=["POINTS", "hole"],
            HoldKnownValues=1, Mode="SteadyState")
        filled = values(heat, "damagedDiffused")
        hole = values(self.sphere, "hole")
        noisy = values(self.sphere, "noisy")
        self.assertTrue(all(f == n for f, n, h in zip(filled, noisy, hole) if not h))
        self.assertLess(max(abs(f) for f, h in zip(filled, hole) if h), 1.3)

    def test_fixed_values_are_unchanged(self):
        heat = FVMHeatFilter(self.sphere, FixedArray=["POINTS", "poles"])
        before, after = values(self.sphere, "noisy"), values(heat, "noisyDiffused")
        changed = [p for b, a, p in zip(before, after, values(self.sphere, "poles")) if a != b]
        self.assertGreater(len(changed), 500)
        self.assertEqual(set(changed), {0.0})

    def test_direction_at_points_and_at_cells_smooths_along_it_only(self):
        """A function of z is constant around the axis, but not along the meridians."""
        change = {}
        for array in (["POINTS", "east"], ["CELLS", "up"]):
            heat = FVMHeatFilter(
            self.sphere, InputArray=["POINTS", "clean"], DirectionArray=array,
                AcrossDiffusivity=0, TimeStep=10)
            change[array[1]] = root_mean_square(
                values(heat, "cleanDiffused"), values(self.sphere, "clean"))
        self.assertLess(change["east"], 0.02)
        self.assertGreater(change["up"], 5 * change["east"])

    def test_second_output_is_the_history(self):
        heat = FVMHeatFilter(self.sphere, NumberOfTimeSteps=7)
        self.assertEqual(values(heat, "Step", port=1), list(range(8)))
        total = values(heat, "Total_0", port=1)
        self.assertAlmostEqual(total[-1], total[0], delta=1e-12)
        energy = values(heat, "Energy", port=1)
        self.assertEqual(energy, sorted(energy, reverse=True))
        self.assertEqual(OutputPort(heat, "History").Port, 1)

    def test_information_properties_report_the_units(self):
        heat = FVMHeatFilter(self.sphere)
        heat.UpdatePipeline()
        heat.SMProxy.UpdatePropertyInformation()
        h = heat.GetPropertyValue("MeanEdgeLength")
        noisy = values(self.sphere, "noisy")
        self.assertAlmostEqual(heat.GetPropertyValue("TimeUnit"), h * h)
        self.assertAlmostEqual(heat.GetPropertyValue("ValueRange"), max(noisy) - min(noisy))

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

    def check_refusal(self, word, right=None, **wrong):
        """The error contains the word, the input is unchanged, and valid settings work again. ParaView
        may ask for a failed update again, which then gives the same error."""
        heat = FVMHeatFilter(self.sphere)
        right = right or {name: heat.GetPropertyValue(name) for name in wrong}
        errors = errors_of(heat)
        for name, value in wrong.items():
            setattr(heat, name, value)
        heat.UpdatePipeline()
        self.assertEqual(len(set(errors)), 1, errors)
        self.assertIn(word, errors[0])
        # Filters behind it do not run, Fetch() included, but its own output is the input.
        arrays = heat.GetClientSideObject().GetOutputDataObject(0).GetPointData()
        self.assertFalse(arrays.HasArray("noisyDiffused"))
        noisy = arrays.GetArray("noisy")
        self.assertTrue([noisy.GetValue(i) for i in range(noisy.GetNumberOfTuples())]
                        == list(values(self.sphere, "noisy")))
        errors.clear()
        for name, value in right.items():
            setattr(heat, name, value)
        self.assertIsNotNone(values(heat, "noisyDiffused"))
        self.assertEqual(errors, [])

    def test_a_wrong_array_is_an_error(self):
        def check(name, wrong, right):
            self.check_refusal(name, right={name: right}, **{name: wrong})

        check("InputArray", ["POINTS", "nothing"], ["POINTS", "noisy"])
        check("InputArray", ["POINTS", "names"], ["POINTS", "noisy"])
        check("InputArray", ["CELLS", "nothing"], ["POINTS", "noisy"])
        check("MaskArray", ["POINTS", "pair"], ["POINTS", ""])
        check("FixedArray", ["POINTS", "east"], ["POINTS", ""])
        check("DirectionArray", ["CELLS", "nothing"], ["CELLS", "up"])
        check("DirectionArray", ["POINTS", "pair"], ["POINTS", "east"])
        self.check_refusal("DirectionArray", AlongDiffusivity=2.0)

    def test_an_invalid_number_is_an_error(self):
        self.check_refusal("TimeStep", TimeStep=0.0)
        self.check_refusal("TimeStep", TimeStep=float("nan"))
        self.check_refusal("NumberOfTimeSteps", NumberOfTimeSteps=-1)
        self.check_refusal("OutputInterval", OutputInterval=0)
        self.check_refusal("FidelityWeight", FidelityWeight=1.0, FWHM=0.1)

    def test_an_input_without_polygons_is_an_error(self):
        points = PointSource(NumberOfPoints=5)
        heat = FVMHeatFilter(points)
        errors = errors_of(heat)
        heat.UpdatePipeline()
        self.assertEqual(len(set(errors)), 1)
        self.assertEqual(heat.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints(), 5)

    def test_blocks_are_surfaces_of_their_own(self):
        other = read_sphere(self.path("other.vtp"), centre=(5.0, 0.0, 0.0))
        group = GroupDatasets(Input=[self.sphere, other])
        group.UpdatePipeline()
        heat = FVMHeatFilter(group)
        blocks = servermanager.Fetch(heat)
        self.assertTrue(blocks.IsA("vtkMultiBlockDataSet"))
        alone = values(FVMHeatFilter(self.sphere), "noisyDiffused")
        for i in range(2):
            array = blocks.GetBlock(i).GetPointData().GetArray("noisyDiffused")
            block = [array.GetValue(k) for k in range(array.GetNumberOfTuples())]
            self.assertLess(root_mean_square(block, alone), 1e-6)

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
