# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The intrinsic TV filter in Python."""

import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersSources import vtkSphereSource

from vtkSurfaceDiffusion import vtkIntrinsicTVFilter, vtkSurfaceDiffusionAlgorithm

FUNCTIONS = [
    "TotalVariation", "PeronaMalikExponential", "PeronaMalikRational", "Charbonnier", "Weickert",
    "Constant",
]


def sphere(function):
    """A sphere with the array f = function(points)."""
    source = vtkSphereSource()
    source.SetRadius(1.0)
    source.SetThetaResolution(40)
    source.SetPhiResolution(40)
    source.Update()
    surface = source.GetOutput()
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    array = numpy_to_vtk(function(points), deep=True)
    array.SetName("f")
    surface.GetPointData().SetScalars(array)
    return surface


def halves(points):
    return np.where(points[:, 0] > 0.1, 1.0, 0.0)


def noisy(points):
    return halves(points) + np.random.default_rng(1).normal(0.0, 0.25, len(points))


def result(filter):
    return vtk_to_numpy(filter.GetOutput().GetPointData().GetArray("fTV"))


def run(surface, **settings):
    filter = vtkIntrinsicTVFilter()
    filter.SetInputData(surface)
    for name, value in settings.items():
        getattr(filter, f"Set{name}To{value}" if isinstance(value, str) else f"Set{name}")(
            *([] if isinstance(value, str) else [value])
        )
    filter.Update()
    return filter


def error(filter, surface):
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    return np.sqrt(np.mean((result(filter) - halves(points)) ** 2))


class TestIntrinsicTVFilter(unittest.TestCase):
    def test_denoises_better_than_linear_diffusion_each_at_its_best(self):
        surface = sphere(noisy)
        tv = min(error(run(surface, FidelityWeight=k), surface) for k in (3.0, 6.0, 10.0))
        linear = min(
            error(run(surface, EdgeFunction="Constant", FidelityWeight=10.0**k), surface)
            for k in np.linspace(-2, 1, 13)
        )
        self.assertLess(tv, 0.6 * linear)

    def test_enums_have_numbers_setters_and_texts(self):
        filter = vtkIntrinsicTVFilter()
        for name, texts in {
            "Mode": ["TimeSteps", "SteadyState"],
            "EdgeFunction": FUNCTIONS,
            "AcrossEdgeFunction": ["Same"] + FUNCTIONS,
            "ChannelCoupling": ["PerChannel", "Joint"],
            "FidelityNorm": ["L2", "L1"],
            "Discretization": ["Linear", "CrouzeixRaviart"],
            "TimeIntegrator": ["FirstOrder", "SecondOrder", "Implicit"],
        }.items():
            for value, text in enumerate(texts):
                getattr(filter, f"Set{name}To{text}")()
                self.assertEqual(getattr(filter, f"Get{name}")(), value)
                self.assertEqual(getattr(filter, f"Get{name}AsString")(), text)
        self.assertEqual(vtkIntrinsicTVFilter.EDGE_FUNCTION_WEICKERT, 4)
        self.assertEqual(vtkIntrinsicTVFilter.ACROSS_EDGE_FUNCTION_CONSTANT, 6)

    def test_docstrings_give_formulas_units_and_defaults(self):
        text = " ".join(vtkIntrinsicTVFilter.__doc__.split())
        self.assertIn("u_t = div(", text)
        self.assertIn("h R", text)
        text = " ".join(vtkIntrinsicTVFilter.SetBeta.__doc__.split())
        self.assertIn("(R/h)^2", text)
        self.assertIn("Default: 1e-6", text)

    def test_every_edge_function_smooths_and_conserves(self):
        for function in FUNCTIONS:
            filter = run(
                sphere(noisy), EdgeFunction=function, FidelityWeight=0.0, EdgeThreshold=0.5
            )
            history = filter.GetOutputDataObject(1)
            total = vtk_to_numpy(history.GetColumnByName("Total_0"))
            np.testing.assert_allclose(total, total[0], rtol=1e-12)
            energy = vtk_to_numpy(history.GetColumnByName("Energy"))
            self.assertLess(energy[-1], 0.5 * energy[0], function)

    def test_steady_state_is_the_limit_of_implicit_steps(self):
        surface = sphere(noisy)
        steady = run(surface, Mode="SteadyState", StopTolerance=1e-6)
        steps = run(surface, TimeIntegrator="Implicit", TimeStep=10.0, StopTolerance=1e-6)
        np.testing.assert_allclose(result(steps), result(steady), atol=2e-3)

    def test_automatic_fidelity_finds_the_noise(self):
        surface = sphere(noisy)
        filter = run(surface, Mode="SteadyState", AutomaticFidelity=True)
        self.assertLess(error(filter, surface), 0.125)  # of 0.25
        given = vtk_to_numpy(surface.GetPointData().GetArray("f"))
        self.assertAlmostEqual(np.std(result(filter) - given), 0.25, delta=0.03)
        self.assertNotEqual(filter.GetEffectiveFidelityWeight(), 3.0)

    def test_nan_is_filled(self):
        def holed(points):
            values = halves(points)
            values[points[:, 2] > 0.9] = np.nan
            return values

        surface = sphere(holed)
        self.assertLess(error(run(surface, Mode="SteadyState", FidelityWeight=50.0), surface), 0.1)

    def test_invalid_settings_are_errors_that_name_them(self):
        filter = vtkIntrinsicTVFilter()
        filter.SetInputData(sphere(noisy))
        filter.SetModeToSteadyState()
        filter.SetEdgeFunctionToWeickert()
        messages = []

        def listen(_object, _event, text):
            messages.append(text)

        listen.CallDataType = "string0"
        filter.AddObserver("ErrorEvent", listen)
        filter.Update()
        self.assertEqual(len(messages), 1)
        self.assertIn("EdgeFunction is 4; allowed: 0 TotalVariation", messages[0])
        self.assertIsNone(filter.GetOutput().GetPointData().GetArray("fTV"))
        filter.SetModeToTimeSteps()
        filter.Update()
        self.assertIsNotNone(filter.GetOutput().GetPointData().GetArray("fTV"))

    def test_superclass_is_the_shared_one(self):
        self.assertTrue(issubclass(vtkIntrinsicTVFilter, vtkSurfaceDiffusionAlgorithm))


if __name__ == "__main__":
    unittest.main(verbosity=2)
