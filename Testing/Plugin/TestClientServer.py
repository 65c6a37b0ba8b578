# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The filters on a pvserver with the plugin give the same results as in this process."""

import os
import re
import subprocess
import unittest

from paraview import simple
from paraview.simple import Clean, Connect, Disconnect, FVMHeatFilter, LoadPlugin, Sphere
from plugin_testing import differences, filter_names, noisy, results

PVSERVER = os.environ["SURFACEDIFFUSION_PVSERVER"]
PLUGIN = os.path.join(os.environ["PV_PLUGIN_PATH"], "SurfaceDiffusion.so")


def every_result():
    """What each filter adds to a sphere, by default, and the heat filter at a time, from the process
    in which they run now."""
    data = noisy(Clean(Sphere(ThetaResolution=64, PhiResolution=64)))
    found = {name: results(getattr(simple, name)(data)) for name in filter_names()}
    heat = FVMHeatFilter(data, GenerateTimeSteps=1)
    heat.UpdatePipeline(4.0)
    found["heat at 4"] = results(heat)
    found["times"] = {"times": list(heat.TimestepValues)}
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
        here = every_result()
        port = next(
            int(match.group(1))
            for match in (re.search(r"connection\(s\): .*:(\d+)", line) for line in self.server.stdout)
            if match)
        self.assertIsNotNone(Connect("localhost", port))
        self.addCleanup(Disconnect)
        LoadPlugin(PLUGIN, remote=True, ns=vars(simple))
        there = every_result()
        for name, expected in here.items():
            self.assertEqual(differences(there[name], expected), [], name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
