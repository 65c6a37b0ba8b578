# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Many files in one command, smoothing up to a smoothness, and the cortex label of FreeSurfer."""

import json
import os
import subprocess
import sys
import unittest
from pathlib import Path

import numpy as np
import samples
from samples import N, NOISE, POINTS, run
from TestWorkbench import WorkbenchTest

from surfacediffusion import estimate_fwhm, heat, smooth_to_fwhm
from surfacediffusion.files import read_data

FINE = samples.sphere(5, 50.0)


class ManyFiles(WorkbenchTest):
    names = [f"sub-{i}.func.gii" for i in range(5)]

    def setUp(self):
        super().setUp()
        samples.write_surface("lh.surf.gii")
        samples.write_gifti("roi.func.gii", {"roi": POINTS[:, 2] > -6})
        rng = np.random.default_rng(1)
        for name in self.names:
            samples.write_gifti(name, {"map": rng.normal(size=N)})
        os.mkdir("out")

    def test_each_has_the_result_of_a_command_of_its_own(self):
        words = ["--roi", "roi.func.gii"]
        for jobs in (1, 2):
            code, out, error = self.batch(*words, "--jobs", jobs)
            self.assertEqual((code, error), (0, ""))
            self.assertEqual([line.split(":")[0] for line in out.splitlines()],
                             [f"out/{name}" for name in self.names])
            for name in self.names:
                self.succeed("smooth", "lh.surf.gii", name, 5, "one.func.gii", *words)
                self.assertEqual(Path("one.func.gii").read_bytes(), Path("out", name).read_bytes())
                os.remove(f"out/{name}")

    def batch(self, *words):
        """In a process of its own, since others are started from it."""
        done = subprocess.run([sys.executable, "-m", "surfacediffusion.command", "smooth", "lh.surf.gii",
                               *self.names, "5", "out", *map(str, words)], capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    def test_the_surface_has_one_factor(self):
        from surfacediffusion import _surface

        made = []
        create = _surface.Surface.__init__

        def count(self, *arguments):
            made.append(arguments)
            create(self, *arguments)

        _surface.Surface.__init__ = count
        try:
            self.succeed("smooth", "lh.surf.gii", *self.names, 5, "out")
        finally:
            _surface.Surface.__init__ = create
        self.assertEqual(len(made), 1)

    def test_the_report_has_an_entry_per_file(self):
        for jobs in (1, 3):
            code, out, _ = self.batch("--json", "--jobs", jobs)
            report = json.loads(out)
            self.assertEqual([entry["data"] for entry in report["files"]], self.names)
            self.assertEqual([entry["fwhm"] for entry in report["files"]], [5] * 5)
            self.assertGreater(report["seconds"]["compute"]["cpu"], 0)

    def test_mistakes_are_one_line(self):
        os.mkdir("other")
        Path("other", self.names[0]).write_bytes(Path(self.names[0]).read_bytes())
        for words, expected in (
                ([*self.names, 5, "none"], "OUTPUT is none, for 5 files; allowed: a folder"),
                ([self.names[0], f"other/{self.names[0]}", 5, "out"], "DATA has several files named sub-0"),
                ([*self.names, 5, "."], "sub-0.func.gii would be replaced by its result")):
            code, _, error = run("smooth", "lh.surf.gii", *words)
            self.assertEqual((code, error.count("\n")), (2, 1), error)
            self.assertIn(expected, error)
        Path(self.names[3]).write_text("broken")
        for jobs in (1, 2):
            code, _, error = self.batch("--jobs", jobs)
            self.assertEqual((code, error.count("\n")), (2, 1), error)
            self.assertIn("sub-3.func.gii: a file of unknown kind", error)


class ToSmoothness(WorkbenchTest):
    def setUp(self):
        super().setUp()
        self.surface = samples.write_surface("lh.surf.gii", *FINE)
        noise = np.random.default_rng(2).normal(size=(len(FINE[0]), 8))
        self.maps = heat(FINE, noise, fwhm=6).astype(np.float32)
        np.save("maps.npy", self.maps)

    def test_the_result_has_the_smoothness(self):
        out = self.succeed("smooth", "lh.surf.gii", "maps.npy", 12, "out.npy", "--to-fwhm")
        self.assertIn("smoothed to FWHM 12 mm", out)
        found = np.load("out.npy")
        residuals = found - found.mean(axis=1, keepdims=True)
        self.assertAlmostEqual(estimate_fwhm(FINE, residuals).pooled / 12, 1, delta=0.01)
        points = np.asarray(FINE[0], np.float32)
        np.testing.assert_allclose(found, smooth_to_fwhm((points, FINE[1]), self.maps, 12), atol=1e-5)

    def test_the_noise_may_be_in_another_file(self):
        np.save("signal.npy", np.column_stack([FINE[0][:, 0]] * 2).astype(np.float32))
        inside = FINE[0][:, 2] > 0
        samples.write_gifti("roi.func.gii", {"roi": inside})
        self.succeed("smooth", "lh.surf.gii", "signal.npy", 12, "out.npy", "--to-fwhm", "--residuals",
                     "maps.npy", "--roi", "roi.func.gii")
        points = np.asarray(FINE[0], np.float32)
        expected = smooth_to_fwhm((points, FINE[1]), np.load("signal.npy"), 12, residuals=self.maps,
                                  roi=inside)
        np.testing.assert_allclose(np.load("out.npy")[inside], expected[inside], atol=1e-3)

    def test_what_cannot_be_reached_is_an_error(self):
        for words, expected in (
                ([3, "out.npy", "--to-fwhm"], "the noise has a smoothness of"),
                ([12, "out.npy", "--residuals", "maps.npy"], "--residuals without --to-fwhm"),
                ([12, "out.npy", "--to-fwhm", "--faces"], "--faces with --to-fwhm")):
            code, _, error = run("smooth", "lh.surf.gii", "maps.npy", *words)
            self.assertEqual((code, error.count("\n")), (2, 1), error)
            self.assertIn(expected, error)


class Cortex(WorkbenchTest):
    def test_the_label_of_the_subject_is_the_region(self):
        os.makedirs("bert/surf")
        os.makedirs("bert/label")
        samples.write_surface("bert/surf/lh.white")
        samples.write_curv("bert/surf/lh.thickness", NOISE)
        code, _, error = run("smooth", "bert/surf/lh.white", "bert/surf/lh.thickness", 5, "a", "--cortex")
        self.assertEqual((code, error.count("\n")), (2, 1), error)
        self.assertIn("no lh.cortex.label in ../label", error)
        cortex = np.flatnonzero(POINTS[:, 2] > -6)
        samples.write_label("bert/label/lh.cortex.label", cortex, np.zeros(len(cortex)))
        for command in (["smooth", "bert/surf/lh.white", "bert/surf/lh.thickness", 5],
                        ["denoise", "bert/surf/lh.white", "bert/surf/lh.thickness"]):
            self.succeed(*command, "a", "--cortex")
            self.succeed(*command, "b", "--roi", "bert/label/lh.cortex.label")
            self.assertEqual(Path("a").read_bytes(), Path("b").read_bytes())
            found = read_data("a").parts[0].values[:, 0]
            np.testing.assert_array_equal(found == 0, POINTS[:, 2] <= -6)


if __name__ == "__main__":
    unittest.main(verbosity=2)
