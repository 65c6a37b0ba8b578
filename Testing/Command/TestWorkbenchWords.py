# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Commands with Workbench's names and arguments beside wb_command: gradients, curvatures, distances from a
vertex, areas of vertices, the smoothness of columns, and dilation."""

import re
import shutil
import subprocess
import unittest

import numpy as np
import samples
from nibabel import cifti2
from samples import run
from TestWorkbench import WorkbenchTest

from surfacediffusion import Surface, heat
from surfacediffusion.files import read_data
from surfacediffusion.files.cifti import open_cifti
from surfacediffusion.files.content import read_content

POINTS, FACES = samples.sphere(5, 50.0)
POINTS = POINTS * [1.0, 0.8, 0.7]


def columns(path):
    """Of all vertices and voxels."""
    if path.endswith(".nii"):
        return np.asarray(open_cifti(read_content(path)).values).T.astype(float)
    return read_data(path).parts[0].values.astype(float)


class WordsTest(WorkbenchTest):
    def setUp(self):
        super().setUp()
        samples.write_surface("a.surf.gii", POINTS, FACES)
        self.maps = heat((POINTS, FACES), np.random.default_rng(1).normal(size=(len(POINTS), 3)), fwhm=10)
        samples.write_gifti("a.func.gii", {name: self.maps[:, k] for k, name in enumerate("xyz")})
        samples.write_gifti("roi.func.gii", {"roi": POINTS[:, 0] > -10})
        self.areas = Surface(POINTS, FACES).vertex_areas
        samples.write_gifti("areas.func.gii", {"areas": 1.44 * self.areas})

    def write_cifti(self, name, values, holes=0.0):
        """Columns on a part of the surface and among two structures of voxels, some of which are 0."""
        inside = np.flatnonzero(POINTS[:, 2] > -25)
        grid = np.indices((14, 14, 14))
        ball = np.linalg.norm(grid.T - [6, 6, 6], axis=-1) < 5
        axis = cifti2.BrainModelAxis.from_surface(inside, len(POINTS), "CORTEX_LEFT")
        for mask, structure in ((ball, "THALAMUS_LEFT"), (grid[0] > 11, "BRAIN_STEM")):
            axis += cifti2.BrainModelAxis.from_mask(mask, structure, affine=np.diag([2, 2.2, 1.9, 1]))
        rng = np.random.default_rng(2)
        rows = np.concatenate([values[inside].T, rng.normal(3, 1, (values.shape[1], len(axis) - len(inside)))], axis=1)
        rows[:, rng.random(len(axis)) < holes] = 0
        cifti2.Cifti2Image(rows.astype(np.float32), cifti2.Cifti2Header.from_axes(
            (cifti2.ScalarAxis(list("xyz")[:len(rows)]), axis))).to_filename(name)


@unittest.skipUnless(shutil.which("wb_command"), "needs Connectome Workbench")
class SameAsWorkbench(WordsTest):
    def both(self, line, *outputs):
        """The columns of outputs, named @ in the line, of this command and of Workbench."""
        found = []
        for name in ("ours", "theirs"):
            words = line.replace("@", name).split()
            if name == "ours":
                self.succeed(*words)
            else:
                subprocess.run(["wb_command", *words], check=True, stdout=subprocess.DEVNULL)
            found.append([columns(output.replace("@", name)) for output in outputs])
        return zip(*found)

    def close(self, ours, theirs, share):
        self.assertEqual(ours.shape, theirs.shape)
        self.assertLess((np.sqrt(np.mean((ours - theirs)**2, axis=0)) / theirs.std(axis=0)).max(), share)

    def test_areas(self):
        for ours, theirs in self.both("-surface-vertex-areas a.surf.gii @.func.gii", "@.func.gii"):
            np.testing.assert_allclose(ours, theirs, rtol=1e-5)

    def test_curvatures_with_their_signs(self):
        for ours, theirs in self.both("-surface-curvature a.surf.gii -mean @m.func.gii -gauss @g.func.gii",
                                      "@m.func.gii", "@g.func.gii"):
            self.assertTrue((ours > 0).all())
            self.close(ours, theirs, 0.03)

    def test_distances_from_a_vertex(self):
        for words, factor in (("-limit 30", 1.0), ("", 1.0), ("-corrected-areas areas.func.gii", 1.2)):
            for ours, theirs in self.both(f"-surface-geodesic-distance a.surf.gii 17 @.func.gii {words}",
                                          "@.func.gii"):
                both = (ours > 5 * factor) & (theirs > 5 * factor)
                self.assertGreater(both.sum(), 500)
                ratio = theirs[both] / ours[both]
                self.assertLess(abs(ratio.mean() - 1.015), 0.02)
                self.assertGreater(ratio.min(), 0.98)
                self.assertLess(ratio.max(), 1.08)
                self.assertLess(abs((ours == -1).sum() - (theirs == -1).sum()), 60)
                self.assertEqual((ours == -1).any(), "-limit" in words)

    def test_gradients_and_their_vectors(self):
        for words in ("", "-presmooth 4 -fwhm -roi roi.func.gii", "-presmooth 3 -column 2"):
            line = f"-metric-gradient a.surf.gii a.func.gii @.func.gii -vectors @v.func.gii {words}"
            for ours, theirs in self.both(line, "@.func.gii", "@v.func.gii"):
                self.close(ours, theirs, 0.08)
                if "-roi" in words:
                    np.testing.assert_array_equal(ours[POINTS[:, 0] <= -10], 0)

    def test_smoothness_of_columns_and_of_the_file(self):
        for words in ("", "-column y", "-whole-file", "-whole-file -demean", "-roi roi.func.gii"):
            line = f"-metric-estimate-fwhm a.surf.gii a.func.gii {words}".split()
            theirs = subprocess.run(["wb_command", *line], check=True, capture_output=True, text=True).stdout
            ours = self.succeed(*line)
            texts = [re.sub(r"[\d.]+$", "", text.rstrip(), flags=re.M) for text in (ours, theirs)]
            self.assertEqual(*texts)
            numbers = [[float(x) for x in re.findall(r"FWHM: ([\d.]+)", text)] for text in (ours, theirs)]
            np.testing.assert_allclose(*numbers, rtol=0.05)

    def test_smoothness_of_structures(self):
        self.write_cifti("a.dscalar.nii", self.maps)
        self.succeed("cifti-smoothing", "a.dscalar.nii", 4, 7, "COLUMN", "s.dscalar.nii", "-fwhm", "-left-surface",
                     "a.surf.gii")
        for words in ("", "-whole-file -demean", "-merged-volume", "-column 2"):
            line = f"-cifti-estimate-fwhm s.dscalar.nii -surface CORTEX_LEFT a.surf.gii {words}".split()
            theirs = subprocess.run(["wb_command", *line], check=True, capture_output=True, text=True).stdout
            ours = self.succeed(*line)
            number = r"(?<=[ ])-?[\d.]+(?!:)"
            self.assertEqual(*(re.sub(number, "", text).split() for text in (ours, theirs)))
            found, expected = (np.array(re.findall(number, text), float) for text in (ours, theirs))
            np.testing.assert_allclose(found, expected, rtol=0.07)
            self.assertGreater((abs(found / expected - 1) < 1e-3).sum(), len(found) / 2)  # those of voxels

    def test_dilation(self):
        holes = 3 + self.maps
        holes[(POINTS[:, 0] > 30) | (np.arange(len(POINTS)) % 13 == 0)] = 0
        samples.write_gifti("holes.func.gii", {name: holes[:, k] for k, name in enumerate("xyz")})
        samples.write_gifti("bad.func.gii", {"bad": POINTS[:, 1] > 20})
        for words, share in (("", 1e-3), ("-nearest", 5e-3), ("-exponent 3 -column 2", 0.01),
                             ("-bad-vertex-roi bad.func.gii -data-roi roi.func.gii", 0.01),
                             ("-corrected-areas areas.func.gii", 1e-3)):
            line = f"-metric-dilate holes.func.gii a.surf.gii 8.3 @.func.gii {words}"
            for ours, theirs in self.both(line, "@.func.gii"):
                same = (ours == 0) == (theirs == 0)
                self.assertLess((~same).sum(), 60 * same.shape[1])  # at the end of the distance
                self.close(np.where(same, ours, theirs), theirs, share)

    def test_dilation_of_structures(self):
        self.write_cifti("a.dscalar.nii", 3 + self.maps, holes=0.4)
        self.write_cifti("bad.dscalar.nii", 1 + np.zeros((len(POINTS), 1)), holes=0.8)
        for words in ("", "-merged-volume", "-bad-brainordinate-roi bad.dscalar.nii"):
            line = f"-cifti-dilate a.dscalar.nii COLUMN 6 5 @.dscalar.nii -left-surface a.surf.gii {words}"
            for ours, theirs in self.both(line, "@.dscalar.nii"):
                self.close(ours, theirs, 2e-3)
        line = "-cifti-dilate a.dscalar.nii COLUMN 6 5 @.dscalar.nii -left-surface a.surf.gii -nearest"
        for ours, theirs in self.both(line, "@.dscalar.nii"):
            self.assertLess((abs(ours - theirs) > 1e-5).any(axis=1).mean(), 0.02)  # several are the nearest


class Words(WordsTest):
    def test_what_is_not_allowed_is_one_line(self):
        for line, message in (
                ("-surface-curvature a.surf.gii", "-mean and -gauss are missing; allowed: one of them, or both"),
                ("-surface-geodesic-distance a.surf.gii 20000 o.func.gii", "VERTEX is 20000; allowed: 0 to 10241"),
                ("-metric-estimate-fwhm a.surf.gii a.func.gii -demean", "-demean without -whole-file"),
                ("-metric-gradient a.surf.gii a.func.gii o.func.gii -vectors o.func.gii",
                 "o.func.gii is OUTPUT and -vectors; allowed: different files"),
                ("-metric-dilate a.func.gii a.surf.gii 10 o.func.gii -nearest -exponent 3",
                 "not allowed with argument"),
                ("-cifti-dilate a.func.gii COLUMN 10 8 o.dscalar.nii", "a GIFTI file; allowed: CIFTI")):
            code, _, error = run(*line.split())
            self.assertEqual((code, error.count("\n")), (2, 1), error)
            self.assertIn(message, error)

    def test_missing_values_have_no_gradient_and_do_not_spread(self):
        holes = np.where(POINTS[:, 2] > 20, np.nan, self.maps[:, 0])
        samples.write_gifti("holes.func.gii", {"x": holes})
        self.succeed("-metric-gradient", "a.surf.gii", "holes.func.gii", "o.func.gii")
        found = columns("o.func.gii")[:, 0]
        self.assertTrue(np.isfinite(found[POINTS[:, 2] < 10]).all())


if __name__ == "__main__":
    unittest.main(verbosity=2)
