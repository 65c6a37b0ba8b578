# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The classes in VTK's pipeline from Python: chains, composite data, both outputs, progress, abort, and
memory. vtk_wheel.py runs these tests with the vtk of PyPI, too."""

import unittest

import numpy as np
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkFiltersCore import vtkElevationFilter, vtkPolyDataNormals
from vtkmodules.vtkFiltersSources import vtkSphereSource

from vtkSurfaceDiffusion import vtkFVMHeatFilter, vtkIntrinsicTVFilter, vtkSurfaceReliefFilter


def elevation(resolution=16, **keys):
    """A sphere with the point array Elevation, its height."""
    sphere = vtkSphereSource()
    sphere.SetThetaResolution(resolution)
    sphere.SetPhiResolution(resolution)
    for key, value in keys.items():
        getattr(sphere, "Set" + key)(value)
    heights = vtkElevationFilter()
    heights.SetInputConnection(sphere.GetOutputPort())
    return heights


def values(data, name="ElevationDiffused"):
    return vtk_to_numpy(data.GetPointData().GetArray(name))


class TestPipeline(unittest.TestCase):
    def test_a_chain_between_filters_of_vtk(self):
        source = elevation(Radius=1.0)
        heat, total_variation, relief, normals = (
            vtkFVMHeatFilter(), vtkIntrinsicTVFilter(), vtkSurfaceReliefFilter(), vtkPolyDataNormals())
        relief.SetInputArrayToProcess(0, 0, 0, 0, "ElevationDiffusedTV")
        chain = [source, heat, total_variation, relief, normals]
        for first, second in zip(chain, chain[1:]):
            second.SetInputConnection(first.GetOutputPort())
        heat.GenerateTimeStepsOn()
        normals.UpdateInformation()
        times = normals.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
        self.assertEqual(times, tuple(range(11)))
        heights = {}
        for time in (10, 0, 10):
            normals.UpdateTimeStep(time)
            heights.setdefault(time, []).append(values(normals.GetOutput(), "ReliefHeight").copy())
        np.testing.assert_array_equal(*heights[10])
        self.assertGreater(np.abs(heights[10][0] - heights[0][0]).max(), 0)
        before = normals.GetOutput().GetLength()
        source.GetInputAlgorithm().SetRadius(2.0)
        normals.UpdateTimeStep(10)
        self.assertGreater(normals.GetOutput().GetLength(), 1.5 * before)

    def test_blocks_are_as_each_alone(self):
        parts, blocks = [elevation(12), elevation(20, Center=(3, 0, 0))], vtkMultiBlockDataSet()
        for number, part in enumerate(parts):
            part.Update()
            blocks.SetBlock(number, part.GetOutput())
        together = vtkFVMHeatFilter()
        together.SetUnitsToAbsolute()
        together.SetTimeStep(0.01)
        together.SetInputDataObject(blocks)
        together.Update()
        for number, part in enumerate(parts):
            alone = vtkFVMHeatFilter()
            alone.SetUnitsToAbsolute()
            alone.SetTimeStep(0.01)
            alone.SetInputConnection(part.GetOutputPort())
            alone.Update()
            np.testing.assert_array_equal(
                values(together.GetOutputDataObject(0).GetBlock(number)), values(alone.GetOutput()))

    def test_the_history_goes_with_the_first_output(self):
        source, heat = elevation(), vtkFVMHeatFilter()
        heat.SetInputConnection(source.GetOutputPort())
        heat.Update()
        self.assertTrue(heat.GetOutputDataObject(1).IsA("vtkTable"))
        history = WrapDataObject(heat.GetOutputDataObject(1)).RowData
        np.testing.assert_array_equal(history["Step"], np.arange(11))
        self.assertTrue((np.diff(history["Energy"]) < 0).all())
        np.testing.assert_allclose(history["Total_0"], history["Total_0"][0], rtol=1e-12)

    def test_progress_and_abort(self):
        source, heat = elevation(64), vtkFVMHeatFilter()
        heat.SetInputConnection(source.GetOutputPort())
        heat.SetNumberOfTimeSteps(40)
        seen = []
        heat.AddObserver(vtkCommand.ProgressEvent, lambda caller, _: seen.append(caller.GetProgress()))
        heat.Update()
        self.assertGreaterEqual(len(seen), 10)
        self.assertEqual(sorted(seen), seen)
        self.assertEqual(seen[-1], 1.0)
        complete = values(heat.GetOutput()).copy()

        def stop(caller, _):
            if caller.GetProgress() > 0.3:
                caller.SetAbortExecute(1)

        tag = heat.AddObserver(vtkCommand.ProgressEvent, stop)
        heat.SetTimeStep(2.0)
        heat.Update()
        self.assertIsNone(heat.GetOutput().GetPointData().GetArray("ElevationDiffused"))
        self.assertIsNotNone(heat.GetOutput().GetPointData().GetArray("Elevation"))
        heat.RemoveObserver(tag)
        heat.SetAbortExecute(0)
        heat.SetTimeStep(1.0)
        heat.Update()
        np.testing.assert_array_equal(values(heat.GetOutput()), complete)

    def test_updates_leave_no_memory_behind(self):
        def resident():
            with open("/proc/self/statm") as pages:
                return int(pages.read().split()[1]) * 4096

        def updates(number):
            for i in range(number):
                source = elevation(24, Radius=1 + i % 7)
                heat, total_variation = vtkFVMHeatFilter(), vtkIntrinsicTVFilter()
                heat.SetNumberOfTimeSteps(2)
                total_variation.SetNumberOfTimeSteps(1)
                heat.SetInputConnection(source.GetOutputPort())
                total_variation.SetInputConnection(heat.GetOutputPort())
                heat.AddObserver(vtkCommand.ProgressEvent, lambda *_: None)
                total_variation.Update()

        updates(200)
        before = resident()
        updates(1000)
        # An update's input has 27 kB, its outputs and operators ten times as much.
        self.assertLess(resident() - before, 4e6)


if __name__ == "__main__":
    unittest.main(verbosity=2)
