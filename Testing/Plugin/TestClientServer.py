# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The filters on a pvserver with the plugin give the same results as in this process."""

import os
import re
import subprocess
import unittest

from paraview import servermanager
from paraview.simple import (
    Calculator, Clean, Connect, Disconnect, FVMHeatFilter, HarmonicMapFilter, IntrinsicTVFilter,
    LoadPlugin, Sphere, SurfaceDirectionFieldFilter, TuringTextureFilter,
)
from plugin_testing import values

PVSERVER = os.environ["SURFACEDIFFUSION_PVSERVER"]
PLUGIN = os.path.join(os.environ["PV_PLUGIN_PATH"], "SurfaceDiffusion.so")


def results():
    """The result of each filter on a sphere, from the process in which it runs now."""
    sphere = Clean(Sphere(ThetaResolution=16, PhiResolution=16))
    data = Calculator(sphere, Function="coordsZ + sin(40*coordsX)", ResultArrayName="f")
    turing = TuringTextureFilter(data, NumberOfTimeSteps=40)
    direction = SurfaceDirectionFieldFilter(data)
    heat = FVMHeatFilter(data, GenerateTimeSteps=1)
    heat.UpdatePipeline(4.0)
    found = {
        "heat at 4": values(heat, "fDiffused"),
        "tv": values(IntrinsicTVFilter(data), "fTV"),
        "harmonic": values(HarmonicMapFilter(data), "NormalsHarmonic"),
        "turing": values(turing, "u1"),
        "history": values(turing, "Energy", port=1),
        "times": list(heat.TimestepValues),
    }
    cells = servermanager.Fetch(direction).GetCellData().GetArray("Direction")
    found["direction"] = [cells.GetTuple(i) for i in range(cells.GetNumberOfTuples())]
    return found


class TestClientServer(unittest.TestCase):
    def setUp(self):
        environment = dict(os.environ)
        environment.pop("PV_PLUGIN_PATH")
        self.server = subprocess.Popen(
            [PVSERVER, "--server-port=0"], stdout=subprocess.PIPE, text=True, env=environment)
        self.addCleanup(self.stop)

    def stop(self):
        """Waits for the server, which ends when its client has disconnected."""
        try:
            self.server.communicate(timeout=10)
        except subprocess.TimeoutExpired:
            self.server.kill()
            self.server.communicate()

    def test_a_server_gives_the_same_bits(self):
        here = results()
        port = next(
            int(match.group(1))
            for match in (re.search(r"connection\(s\): .*:(\d+)", line) for line in self.server.stdout)
            if match)
        self.assertIsNotNone(Connect("localhost", port))
        self.addCleanup(Disconnect)
        LoadPlugin(PLUGIN, remote=True, ns=globals())
        there = results()
        for name, expected in here.items():
            self.assertIsNotNone(expected, name)
            self.assertEqual(there[name], expected, name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
