# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A state in Python makes filters again with all inputs, and with the same results."""

import unittest

from paraview import servermanager, simple, smstate
from plugin_testing import values

POINT_INPUTS = {"SurfaceDistanceFilter": ["Sources", "PathPoints"],
                "SurfaceInterpolationFilter": ["PointsWithValues"]}
RESULTS = {"SurfaceDistanceFilter": "Distance", "SurfaceInterpolationFilter": "heightInterpolated"}


class TestPythonStates(unittest.TestCase):
    def test_states_have_the_further_inputs(self):
        surface = simple.Sphere(registrationName="surface", ThetaResolution=20, PhiResolution=20)
        points = simple.Calculator(
            registrationName="points", Function="coordsX + 2*coordsZ", ResultArrayName="height",
            Input=simple.Line(registrationName="line", Point1=[0.1, 0.2, -0.4], Resolution=9))
        for name, inputs in POINT_INPUTS.items():
            getattr(simple, name)(registrationName=name, Input=surface, **dict.fromkeys(inputs, points))
        expected = {name: values(simple.FindSource(name), RESULTS[name]) for name in RESULTS}
        state = smstate.get_state()
        for source in list(simple.GetSources().values()):
            simple.Delete(source)
        self.assertEqual(len(simple.GetSources()), 0)
        exec(compile(state, "state.py", "exec"), {})
        for name, result in RESULTS.items():
            found = values(simple.FindSource(name), result)
            self.assertGreater(len(set(found)), 10)
            self.assertEqual(found, expected[name], name)
        paths = servermanager.Fetch(simple.FindSource("SurfaceDistanceFilter"), idx=1)
        self.assertEqual(paths.GetNumberOfLines(), 10)


if __name__ == "__main__":
    unittest.main()
