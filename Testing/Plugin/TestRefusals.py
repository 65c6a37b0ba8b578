# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A filter that refuses its settings says so in one line, executes once, and shows its input, until
something changes. The lines are those that a user of pvpython reads."""

import os
import subprocess
import sys
import unittest

from paraview import simple
from paraview.simple import (
    Calculator, Clean, Delete, GroupDatasets, Render, Show, Sphere, Transform)
from plugin_testing import filter_names


def use_a_refused_filter(name, source):
    """Applies a filter with a refused setting, draws it several times, asks for a time, and corrects it.
    Prints what happened, between the lines of ParaView."""
    filter = getattr(simple, name)(source)
    filter.NumberOfThreads = -1
    executions = []
    filter.SMProxy.GetClientSideObject().AddObserver("StartEvent", lambda *_: executions.append(1))
    filter.UpdatePipeline()
    display = Show(filter)
    for _ in range(3):
        Render()
    filter.UpdatePipeline(3.0)
    shown = display.GetClientSideObject().GetRenderedDataObject(0)
    points = shown.GetNumberOfPoints() if shown else 0
    print("refused: %d executions, %d points" % (len(executions), points))
    filter.NumberOfThreads = 0
    Render()
    print("corrected: %d executions" % len(executions))
    Delete(filter)


def use_all():
    sphere = Calculator(
        Clean(Sphere(ThetaResolution=16, PhiResolution=16)), Function="coordsX", ResultArrayName="f")
    blocks = GroupDatasets(Input=[sphere, Transform(sphere, Transform="Transform")])
    for name in filter_names():
        for kind, source in (("one surface", sphere), ("blocks", blocks)):
            print("filter: %s, %s" % (name, kind))
            sys.stdout.flush()
            use_a_refused_filter(name, source)
            sys.stdout.flush()


class TestRefusals(unittest.TestCase):
    def test_a_refusal_is_one_line_and_one_execution_and_shows_the_input(self):
        run = subprocess.run(
            [os.environ["SURFACEDIFFUSION_PVPYTHON"], os.path.abspath(__file__), "use"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(run.returncode, 0, run.stdout)
        parts = run.stdout.split("filter: ")[1:]
        self.assertEqual(len(parts), 2 * len(filter_names()))
        for part in parts:
            text, _, corrected = part.partition("refused: ")
            with self.subTest(text.splitlines()[0]):
                lines = [line for line in text.splitlines()[1:] if line.strip("\x1b[0m ")]
                self.assertEqual(len(lines), 1, text)
                self.assertIn("NumberOfThreads is -1; allowed: integers, 0 or more", lines[0])
                points = "452" if "blocks" in text.splitlines()[0] else "226"
                self.assertEqual(corrected.splitlines()[0], "1 executions, %s points" % points)
                self.assertIn("corrected: 2 executions", corrected)


if __name__ == "__main__":
    use_all() if sys.argv[1:] == ["use"] else unittest.main(verbosity=2)
