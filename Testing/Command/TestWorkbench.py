# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`surfacediffusion metric-smoothing` and `wb_command -metric-smoothing` with the same words give the
same maps, to 3 % of their standard deviation. The comparison needs Connectome Workbench (Debian:
connectome-workbench) and the wheel of brainspace in SURFACEDIFFUSION_BRAIN_DIR."""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import samples
from samples import N, NOISE, POINTS, SMOOTH, run
from TestBrains import CONTE, unpack, wheel

from surfacediffusion import heat
from surfacediffusion.files import read_data, read_surface


class WorkbenchTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def succeed(self, *arguments):
        code, out, error = run(*arguments)
        self.assertEqual((code, error), (0, ""))
        return out


class Words(WorkbenchTest):
    def setUp(self):
        super().setUp()
        samples.write_surface("lh.surf.gii")
        samples.write_gifti("lh.func.gii", {"one": NOISE, "two": SMOOTH})
        samples.write_gifti("roi.func.gii", {"roi": POINTS[:, 2] > -6})

    def test_the_kernel_is_sigma_unless_fwhm_is_said(self):
        words = "-roi roi.func.gii -fix-zeros -column two"
        for own, workbench in (("2 x.func.gii --sigma", "2 y.func.gii"),
                               ("5 x.func.gii", "5 y.func.gii -fwhm")):
            self.succeed(*f"smooth lh.surf.gii lh.func.gii {own} {words}".split())
            self.succeed(*f"metric-smoothing lh.surf.gii lh.func.gii {workbench} {words}".split())
            self.assertEqual(Path("x.func.gii").read_bytes(), Path("y.func.gii").read_bytes())

    def test_the_summary_names_both_widths_and_the_unit_if_it_is_known(self):
        out = self.succeed("metric-smoothing", "lh.surf.gii", "lh.func.gii", 10, "o.func.gii")
        self.assertIn("2 columns, FWHM 23.5 mm (sigma 10), ", out)
        out = self.succeed("smooth", "lh.surf.gii", "lh.func.gii", 10, "o.func.gii")
        self.assertIn("2 columns, FWHM 10 mm (sigma 4.25), ", out)
        Path("a.off").write_text(samples.off_text())
        out = self.succeed("smooth", "a.off", "lh.func.gii", 10, "o.func.gii", "--sigma")
        self.assertIn("2 columns, FWHM 23.5 (sigma 10), ", out)

    def test_words_without_a_meaning_here_are_refused(self):
        code, _, error = run("metric-smoothing", "lh.surf.gii", "lh.func.gii", 2, "o.func.gii", "-method",
                             "GEO_GAUSS")
        self.assertEqual((code, error.count("\n")), (2, 1), error)
        self.assertIn("GEO_GAUSS", error)

    def test_each_column_may_have_its_region(self):
        samples.write_gifti("two.func.gii", {"up": POINTS[:, 2] > -6, "down": POINTS[:, 2] < 6})
        samples.write_gifti("down.func.gii", {"down": POINTS[:, 2] < 6})
        words = "metric-smoothing lh.surf.gii lh.func.gii 2"
        self.succeed(*f"{words} both.func.gii -roi two.func.gii -match-columns".split())
        found = read_data("both.func.gii").parts[0].values
        for i, (name, roi) in enumerate((("one", "roi"), ("two", "down"))):
            self.succeed(*f"{words} single.func.gii -roi {roi}.func.gii -column {name}".split())
            single = read_data("single.func.gii").parts[0].values[:, 0]
            np.testing.assert_allclose(found[:, i], single, atol=1e-6)
        code, _, error = run(*f"{words} o.func.gii -roi roi.func.gii -match-columns".split())
        self.assertEqual(code, 2)
        self.assertIn("roi.func.gii has 1 columns, but lh.func.gii has 2", error)


def heat_on_the_sphere(points, faces, values, fwhm):
    """The heat equation itself on the unit sphere, by Legendre polynomials, at some of the points."""
    rows = np.arange(0, len(points), 40)
    x = np.clip(points[rows] @ points.T, -1, 1)
    time = fwhm**2 / (16 * np.log(2))
    kernel, before, polynomial = np.zeros_like(x), np.zeros_like(x), np.ones_like(x)
    for k in range(int(7 / np.sqrt(time))):
        kernel += (2 * k + 1) * np.exp(-time * k * (k + 1)) * polynomial
        before, polynomial = polynomial, ((2 * k + 1) * x * polynomial - k * before) / (k + 1)
    corners = points[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    kernel *= np.bincount(faces.ravel(), np.repeat(np.linalg.norm(normals, axis=1), 3), len(points))
    return kernel @ values / kernel.sum(axis=1)[:, None], rows


@unittest.skipUnless(shutil.which("wb_command"), "needs Connectome Workbench")
class SameMaps(WorkbenchTest):
    def compare(self, surface, data, *words, share=0.03):
        subprocess.run(["wb_command", "-metric-smoothing", surface, data, words[0], "wb.func.gii",
                        *words[1:]], check=True)
        code, _, error = run("metric-smoothing", surface, data, words[0], "ours.func.gii", *words[1:])
        self.assertEqual(code, 0, error)
        ours, theirs = (read_data(name).parts[0].values for name in ("ours.func.gii", "wb.func.gii"))
        self.assertEqual(ours.shape, theirs.shape)
        region = np.ones(len(ours), bool)
        if "-roi" in words:
            region = read_data(words[words.index("-roi") + 1]).parts[0].values[:, 0] > 0
            np.testing.assert_array_equal(ours[~region], theirs[~region])
        for a, b in zip(ours[region].T, theirs[region].T):
            self.assertLess(np.sqrt(np.mean((a - b)**2)), share * b.std(), words)
        return ours, theirs

    def test_on_a_sphere(self):
        points, faces = samples.sphere(5, 50.0)
        samples.write_surface("fine.surf.gii", points, faces)
        # Noise with the smoothness of a map; Workbench's kernel is too narrow for white noise.
        noise = heat((points, faces), np.random.default_rng(2).normal(3, 1, (len(points), 2)), fwhm=8)
        samples.write_gifti("noise.func.gii", {"one": noise[:, 0], "two": noise[:, 1]})
        samples.write_gifti("roi.func.gii", {"roi": points[:, 0] > -20})
        ours, theirs = self.compare("fine.surf.gii", "noise.func.gii", "4")
        exact, rows = heat_on_the_sphere(points / 50.0, faces, noise, 4 * np.sqrt(8 * np.log(2)) / 50.0)
        for k in range(2):
            errors = [np.sqrt(np.mean((maps[rows, k] - exact[:, k])**2)) / exact[:, k].std()
                      for maps in (ours, theirs)]
            self.assertLess(errors[0], 0.003)
            self.assertGreater(errors[1], 0.02)  # most of the difference is that of Workbench's kernel
        self.compare("fine.surf.gii", "noise.func.gii", "8", "-fwhm")
        self.compare("fine.surf.gii", "noise.func.gii", "4", "-roi", "roi.func.gii", "-column", "2",
                     share=0.04)

    @unittest.skipUnless(wheel("brainspace"), "needs the wheel of brainspace")
    def test_on_a_cortex_with_its_wall_left_out(self):
        surface = read_surface(unpack("brainspace", CONTE + "surfaces/conte69_32k_lh.gii"))
        samples.write_surface("lh.surf.gii", surface.points, surface.faces)
        cortex = np.loadtxt(unpack("brainspace", CONTE + "surfaces/conte69_32k_lh_mask.csv")) > 0
        thickness = np.loadtxt(unpack("brainspace", CONTE + "matrices/main_group/"
                                      "conte69_32k_thickness.csv"))[:len(cortex)]
        holes = np.where(np.random.default_rng(3).random(len(cortex)) < 0.1, 0, thickness)
        samples.write_gifti("thick.func.gii", {"thickness": thickness})
        samples.write_gifti("holes.func.gii", {"thickness": holes})
        samples.write_gifti("roi.func.gii", {"cortex": cortex})
        for words in (["4"], ["10", "-fwhm"]):
            self.compare("lh.surf.gii", "thick.func.gii", *words, "-roi", "roi.func.gii")
        self.compare("lh.surf.gii", "holes.func.gii", "4", "-fix-zeros", "-roi", "roi.func.gii")


if __name__ == "__main__":
    unittest.main()
