# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What ParaView adds to the filters: menus of arrays, progress and abort, and series that are written. What
they compute is tested in C++."""

import os
import tempfile
import time
import unittest

from paraview import servermanager
from paraview.simple import (
    Calculator, FVMHeatFilter, HarmonicMapFilter, SaveData, Sphere, TuringTextureFilter, XMLPolyDataReader,
)
from plugin_testing import menu, read_sphere, values


class TestSimple(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.sphere = read_sphere(os.path.join(cls.folder, "sphere.vtp"))

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

    def test_progress_reaches_the_status_bar_and_abort_the_filter(self):
        heat = FVMHeatFilter(self.sphere, NumberOfTimeSteps=20)
        algorithm = heat.GetClientSideObject()
        handler = servermanager.ActiveConnection.Session.GetProgressHandler()
        # The handler passes on one report per interval. A report takes longer than this on any
        # machine.
        interval = handler.GetProgressInterval()
        self.addCleanup(handler.SetProgressInterval, interval)
        handler.SetProgressInterval(0.01)
        slow = algorithm.AddObserver("ProgressEvent", lambda _object, _event: time.sleep(0.02))
        self.addCleanup(algorithm.RemoveObserver, slow)
        seen = []

        def look(_object, _event):
            seen.append(handler.GetLastProgress())

        tag = handler.AddObserver("ProgressEvent", look)
        self.addCleanup(handler.RemoveObserver, tag)
        heat.UpdatePipeline()
        self.assertGreaterEqual(len(set(seen)), 3)
        self.assertEqual(seen, sorted(seen))
        complete = values(heat, "noisyDiffused")

        def abort(_object, _event):
            if algorithm.GetProgress() > 0.2:
                algorithm.SetAbortExecute(1)

        tag = algorithm.AddObserver("ProgressEvent", abort)
        heat.TimeStep = 2
        heat.UpdatePipeline()
        self.assertIsNone(values(heat, "noisyDiffused"))
        algorithm.RemoveObserver(tag)
        algorithm.SetAbortExecute(0)
        heat.TimeStep = 1
        self.assertTrue(values(heat, "noisyDiffused") == complete)

    def test_a_filtered_series_has_each_file_as_if_alone_and_is_written_with_its_times(self):
        sphere = Sphere(ThetaResolution=24, PhiResolution=24)
        files = [os.path.join(self.folder, "map_%d.vtp" % i) for i in range(3)]
        for i, file in enumerate(files):
            SaveData(file, Calculator(sphere, ResultArrayName="wave", Function=f"cos(8*coordsX + {i})"),
                     DataMode="Binary")  # as in write_sphere()
        heat = FVMHeatFilter(XMLPolyDataReader(FileName=files), InputArray=["POINTS", "wave"], FWHM=0.1)
        path = os.path.join(self.folder, "smooth.pvd")
        SaveData(path, heat, WriteTimeSteps=1, DataMode="Binary")
        with open(path) as file:
            index = file.read()
        written = sorted(os.listdir(os.path.join(self.folder, "smooth")))
        self.assertEqual(len(written), 3)
        found = []
        for i, name in enumerate(written):
            self.assertIn(f'timestep="{i}"', index)
            again = XMLPolyDataReader(FileName=[os.path.join(self.folder, "smooth", name)])
            found.append(values(again, "waveDiffused"))
            alone = XMLPolyDataReader(FileName=[files[i]])
            self.assertTrue(found[i] == values(FVMHeatFilter(alone, InputArray=["POINTS", "wave"], FWHM=0.1),
                                               "waveDiffused"))
        self.assertEqual(len(set(map(tuple, found))), 3)


if __name__ == "__main__":
    unittest.main(verbosity=2)
