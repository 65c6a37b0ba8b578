# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Each filter, applied at its defaults to the coarse and odd surfaces of Testing/Surfaces, says at most one
line, which is what a user of pvpython reads, and gives finite results unless the line says what to set."""

import os
import subprocess
import sys
import unittest

import numpy as np
from paraview import simple
from plugin_testing import add_array, filter_names, results
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Surfaces"))
from coarse import read_surfaces


def source_of(points, triangles):
    """A source of the surface with data on its points."""
    surface = vtkPolyData()
    surface.SetPoints(vtkPoints())
    surface.SetPolys(vtkCellArray())
    for point in points:
        surface.GetPoints().InsertNextPoint(point)
    for corners in triangles:
        surface.GetPolys().InsertNextCell(3, corners)
    length = np.ptp(points, axis=0).max()
    add_array(surface.GetPointData(), "f", [float(x) for x in np.sin(points @ [1.0, 2.0, 3.0] / length)])
    surface.GetPointData().SetActiveScalars("f")
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(surface)
    source.UpdatePipeline()
    return source


def apply_all():
    """Prints the name of each filter and surface, the lines of ParaView, and what was found."""
    for name, points, triangles in read_surfaces():
        source = source_of(points, triangles)
        for filter_name in filter_names():
            print("filter: %s of %s" % (filter_name, name))
            sys.stdout.flush()
            filter = getattr(simple, filter_name)(source)
            filter.UpdatePipeline()
            sys.stdout.flush()
            found = results(filter)
            wrong = [key for key, numbers in found.items() if not np.isfinite(numbers).all()]
            print("found: %d results, not finite: %s" % (len(found), wrong))
            simple.Delete(filter)


class TestCoarse(unittest.TestCase):
    def test_every_filter_says_at_most_one_line_and_gives_finite_results(self):
        run = subprocess.run(
            [os.environ["SURFACEDIFFUSION_PVPYTHON"], os.path.abspath(__file__), "apply"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(run.returncode, 0, run.stdout)
        parts = run.stdout.split("filter: ")[1:]
        self.assertEqual(len(parts), len(filter_names()) * len(list(read_surfaces())))
        for part in parts:
            said, _, found = part.partition("found: ")
            with self.subTest(said.splitlines()[0]):
                lines = [line for line in said.splitlines()[1:] if line.strip("\x1b[0m ")]
                self.assertLessEqual(len(lines), 1, said)
                if not lines:
                    self.assertIn("not finite: []", found)


if __name__ == "__main__":
    apply_all() if sys.argv[1:] == ["apply"] else unittest.main(verbosity=2)
