# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A file series of data on one surface, filtered time by time, and the times of a run."""

import os
import tempfile
import unittest

from paraview import servermanager
from paraview.simple import (
    Calculator, FVMHeatFilter, GetAnimationScene, IntrinsicTVFilter, MumfordShahFilter,
    SaveData, Sphere, XMLPolyDataReader)
from plugin_testing import errors_of, values


class TestTimeSeries(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        sphere = Sphere(ThetaResolution=24, PhiResolution=24)
        cls.files = []
        for i in range(3):
            data = Calculator(sphere, ResultArrayName="wave",
                              Function=f"cos(8*coordsX + {i}) + {i}*sin(30*coordsY)")
            cls.files.append(os.path.join(cls.folder, f"map_{i}.vtp"))
            SaveData(cls.files[-1], data, DataMode="Binary")  # as in write_sphere()
        cls.series = XMLPolyDataReader(FileName=cls.files)

    def check(self, make):
        """Each time of the series equals a run on its file alone, in any order of times."""
        filtered = make(self.series)
        filtered.UpdatePipelineInformation()
        self.assertEqual(list(filtered.TimestepValues), [0.0, 1.0, 2.0])
        found = {}
        for time in (0, 2, 1, 0):
            filtered.UpdatePipeline(float(time))
            array = next(a for a in filtered.PointData.keys() if a not in ("wave", "Normals"))
            alone = make(XMLPolyDataReader(FileName=[self.files[time]]))
            alone.UpdatePipeline()
            found[time] = values(filtered, array)
            self.assertEqual(found[time], values(alone, array), time)
        self.assertNotEqual(found[0], found[1])
        self.assertNotEqual(found[1], found[2])

    def test_each_time_equals_a_run_on_its_file_alone(self):
        self.check(lambda source: FVMHeatFilter(
            source, InputArray=["POINTS", "wave"], FWHM=0.1, GenerateTimeSteps=0))
        self.check(lambda source: IntrinsicTVFilter(
            source, InputArray=["POINTS", "wave"], GenerateTimeSteps=0))

    def test_the_filtered_series_is_written_with_its_times(self):
        heat = FVMHeatFilter(self.series, InputArray=["POINTS", "wave"], FWHM=0.1)
        path = os.path.join(self.folder, "smooth.pvd")
        SaveData(path, heat, WriteTimeSteps=1, DataMode="Binary")
        with open(path) as file:
            index = file.read()
        for time in range(3):
            self.assertIn(f'timestep="{time}"', index)
        written = sorted(os.listdir(os.path.join(self.folder, "smooth")))
        self.assertEqual(len(written), 3)
        for time, file in enumerate(written):
            again = XMLPolyDataReader(FileName=[os.path.join(self.folder, "smooth", file)])
            heat.UpdatePipeline(float(time))
            self.assertEqual(len(values(heat, "waveDiffused")), 530)
            self.assertEqual(values(again, "waveDiffused"), values(heat, "waveDiffused"))


class TestTimesOfARun(unittest.TestCase):
    def test_a_run_that_ends_early_publishes_the_steps_that_it_has(self):
        sphere = Sphere(ThetaResolution=24, PhiResolution=24)
        halves = Calculator(sphere, ResultArrayName="f", Function="coordsZ > 0.1")
        edges = MumfordShahFilter(halves, InputArray=["POINTS", "f"], GenerateTimeSteps=1)
        edges.UpdatePipeline()
        history = servermanager.Fetch(edges, idx=1)
        self.assertLess(history.GetNumberOfRows(), 200)
        edges.UpdatePipelineInformation()
        times = list(edges.TimestepValues)
        self.assertEqual(len(times), history.GetNumberOfRows())
        final = values(edges, "fMumfordShah")
        edges.UpdatePipeline(0.0)
        self.assertNotEqual(values(edges, "fMumfordShah"), final)
        edges.UpdatePipeline(times[-1])
        self.assertEqual(values(edges, "fMumfordShah"), final)
        scene = GetAnimationScene()
        scene.UpdateAnimationUsingDataTimeSteps()
        self.assertEqual(list(scene.TimeKeeper.TimestepValues), times)

    def test_one_error_of_a_refused_filter_is_that_of_all_times(self):
        data = Calculator(Sphere(), ResultArrayName="f", Function="coordsZ")
        heat = FVMHeatFilter(data, GenerateTimeSteps=1, NumberOfThreads=-1)
        errors = errors_of(heat)
        for time in (0.0, 1.0, 2.0):
            heat.UpdatePipeline(time)
        self.assertEqual(len(errors), 1, errors)
        data.Function = "coordsX"
        heat.UpdatePipeline(1.0)
        self.assertEqual(len(errors), 2, errors)


if __name__ == "__main__":
    unittest.main(verbosity=2)
