# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The heat filter in Python."""

import os
import subprocess
import sys
import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkObject
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkTable
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkFiltersSources import vtkSphereSource

from vtkSurfaceDiffusion import vtkFVMHeatFilter, vtkSurfaceDiffusionAlgorithm


def noisy_sphere():
    source = vtkSphereSource()
    source.SetThetaResolution(24)
    source.SetPhiResolution(24)
    source.Update()
    surface = source.GetOutput()
    values = np.random.default_rng(1).normal(size=surface.GetNumberOfPoints())
    array = numpy_to_vtk(values, deep=True)
    array.SetName("f")
    surface.GetPointData().SetScalars(array)
    return surface


def result(filter, name="fDiffused"):
    return vtk_to_numpy(filter.GetOutput().GetPointData().GetArray(name))


class TestHeatFilter(unittest.TestCase):
    def test_import_needs_no_other_module_first(self):
        code = "from vtkSurfaceDiffusion import vtkFVMHeatFilter; vtkFVMHeatFilter()"
        subprocess.run([sys.executable, "-c", code], check=True, env=os.environ)

    def test_smooths_and_conserves(self):
        filter = vtkFVMHeatFilter()
        filter.SetInputData(noisy_sphere())
        filter.SetTimeStep(2.0)
        filter.Update()
        before = vtk_to_numpy(noisy_sphere().GetPointData().GetArray("f"))
        self.assertLess(result(filter).std(), 0.5 * before.std())
        history = filter.GetOutputDataObject(1)
        self.assertIsInstance(history, vtkTable)
        self.assertEqual(history.GetNumberOfRows(), 11)
        total = vtk_to_numpy(history.GetColumnByName("Total_0"))
        np.testing.assert_allclose(total, total[0], atol=1e-12)
        energy = vtk_to_numpy(history.GetColumnByName("Energy"))
        self.assertTrue((np.diff(energy) < 0).all())

    def test_enums_have_numbers_setters_and_texts(self):
        filter = vtkFVMHeatFilter()
        for name, texts in {
            "Units": ["Natural", "Absolute"],
            "MaskMode": ["Inpaint", "Exclude"],
            "InitialFill": ["Input", "Mean", "Noise", "Harmonic"],
            "TimeIntegrator": ["FirstOrder", "SecondOrder"],
            "Solver": ["Automatic", "Direct", "ConjugateGradient"],
            "OutputPrecision": ["Single", "Double", "Input"],
            "Mode": ["TimeSteps", "SteadyState"],
        }.items():
            for value, text in enumerate(texts):
                getattr(filter, f"Set{name}To{text}")()
                self.assertEqual(getattr(filter, f"Get{name}")(), value)
                self.assertEqual(getattr(filter, f"Get{name}AsString")(), text)
                getattr(filter, f"Set{name}")(value)
                self.assertEqual(getattr(filter, f"Get{name}AsString")(), text)
        self.assertEqual(vtkFVMHeatFilter.INITIAL_FILL_NOISE, 2)
        self.assertEqual(vtkSurfaceDiffusionAlgorithm.SOLVER_DIRECT, 1)

    def test_docstrings_give_units_and_defaults(self):
        self.assertIn("heat equation", vtkFVMHeatFilter.__doc__)
        # The wrapper breaks lines anywhere.
        self.assertIn("Default: 1.", " ".join(vtkFVMHeatFilter.SetTimeStep.__doc__.split()))
        self.assertIn("coordinate units", " ".join(vtkFVMHeatFilter.SetFWHM.__doc__.split()))

    def test_times_can_be_asked_for_in_any_order(self):
        filter = vtkFVMHeatFilter()
        filter.SetInputData(noisy_sphere())
        filter.SetNumberOfTimeSteps(40)
        filter.GenerateTimeStepsOn()
        filter.UpdateInformation()
        times = filter.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
        self.assertEqual(len(times), 41)
        states = []
        for time in (40.0, 10.0, 40.0):
            filter.UpdateTimeStep(time)
            self.assertEqual(
                filter.GetOutput().GetInformation().Get(vtkDataObject.DATA_TIME_STEP()), time
            )
            states.append(result(filter).copy())
        np.testing.assert_array_equal(states[0], states[2])
        self.assertGreater(np.abs(states[0] - states[1]).max(), 0)

    def test_nan_is_filled(self):
        surface = noisy_sphere()
        values = vtk_to_numpy(surface.GetPointData().GetArray("f"))
        values[:] = 2.0
        values[5] = np.nan
        filter = vtkFVMHeatFilter()
        filter.SetInputData(surface)
        filter.Update()
        np.testing.assert_allclose(result(filter), 2.0, rtol=1e-12)

    def test_errors_name_the_property_and_leave_the_input(self):
        filter = vtkFVMHeatFilter()
        filter.SetInputData(noisy_sphere())
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

    def test_superclass_is_abstract(self):
        self.assertTrue(issubclass(vtkFVMHeatFilter, vtkSurfaceDiffusionAlgorithm))
        with self.assertRaises(TypeError):
            vtkSurfaceDiffusionAlgorithm()


if __name__ == "__main__":
    vtkObject.GlobalWarningDisplayOn()
    unittest.main(verbosity=2)
