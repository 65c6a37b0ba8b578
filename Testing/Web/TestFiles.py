# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Names of files that come from a browser, which may send anything: Examples/Web reads and writes in its
temporary folders alone. Argument: the folder of the application."""
import os
import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

try:
    import nibabel  # noqa: F401
    import vtkmodules  # noqa: F401

    import surfacediffusion as sd
except ImportError as problem:
    print(f"skipped: {problem} (.ci/fetch-test-data brings it)")
    sys.exit(77)

import numpy as np

sys.path.insert(0, str(Path(sys.argv.pop()).resolve()))
from meshes import read_mesh, result_file, result_names  # noqa: E402

from surfacediffusion.files import FileError  # noqa: E402


class TestFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        ball = sd.sphere(2)
        self.off = "\n".join([f"OFF\n{ball.n_points} {ball.n_faces} 0",
                              *(" ".join(map(repr, point)) for point in ball.points.tolist()),
                              *(f"3 {a} {b} {c}" for a, b, c in ball.triangles.tolist())]).encode()

    def bad_names(self):
        target = str(self.folder / "written.off")
        return [target, f"../../{target}", os.path.relpath(target, tempfile.gettempdir()), "..", ".", "", "a/b.off",
                "..\\b.off", "a\0.off", "x" * 10000, "x" * 10000 + ".off", "result.vtp/../a", "other.off"]

    def test_a_result_is_written_under_the_names_that_are_offered(self):
        mesh = read_mesh([("ball.off", self.off)], 1)
        outcome = SimpleNamespace(triangles=None, points=2 * mesh.surface.points, shown=None, arrays={},
                                  cell_arrays={})
        self.assertEqual(result_names(mesh, outcome, ""), ["ball_result.off", "result.vtp"])
        for name in result_names(mesh, outcome, ""):
            self.assertGreater(len(result_file(mesh, outcome, "", name)), 1000)
        for name in self.bad_names():
            with self.subTest(name[:80]), self.assertRaisesRegex(FileError, "allowed: ball_result.off, result.vtp"):
                result_file(mesh, outcome, "", name)
        self.assertEqual(os.listdir(self.folder), [])

    def test_a_dropped_file_may_have_any_name(self):
        before = set(os.listdir(tempfile.gettempdir()))
        for name in self.bad_names():
            with self.subTest(name[:80]):
                mesh = read_mesh([(name, self.off)], 1)
                self.assertEqual(mesh.surface.n_points, 162)
                outcome = SimpleNamespace(triangles=None, points=mesh.surface.points, shown=None, arrays={},
                                          cell_arrays={})
                for result in result_names(mesh, outcome, ""):
                    self.assertEqual(os.path.basename(result), result)
                    self.assertIn(b"VTKFile" if result.endswith("vtp") else b"OFF",
                                  result_file(mesh, outcome, "", result))
        self.assertEqual(os.listdir(self.folder), [])
        new = set(os.listdir(tempfile.gettempdir())) - before
        self.assertEqual([name for name in new if name.endswith(".off")], [])

    def test_names_of_arrays_may_have_any_signs(self):
        mesh = read_mesh([("ball.off", self.off)], 1)
        name = "p<0.05 & \"q\""
        mesh.arrays[name] = np.arange(162.0)
        outcome = SimpleNamespace(triangles=None, points=None, shown=mesh.arrays[name], arrays={}, cell_arrays={})
        again = read_mesh([("again.vtp", result_file(mesh, outcome, name, "result.vtp"))], 1)
        np.testing.assert_array_equal(again.arrays[name], mesh.arrays[name])


if __name__ == "__main__":
    unittest.main(verbosity=2)
