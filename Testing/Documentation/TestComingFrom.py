# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""All lines of the page for users of other programs run, and those of Workbench give the same values."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "Testing/Command"))

try:
    import nibabel as nib
    import nilearn.image
    from nilearn.surface import InMemoryMesh, PolyMesh, SurfaceImage
except ImportError as missing:
    print(missing)
    sys.exit(77)  # skipped

import samples  # noqa: E402
from nibabel import cifti2  # noqa: E402
from samples import run  # noqa: E402

from surfacediffusion import heat  # noqa: E402
from surfacediffusion.files import read_data  # noqa: E402

PAGE = (ROOT / "Documentation/coming_from.md").read_text(encoding="utf-8")
POINTS, FACES = samples.sphere(5, 50.0)
N = len(POINTS)
RNG = np.random.default_rng(1)
TURN = np.linalg.qr(np.array([[2.0, 1.0, 0.0], [0.0, 2.0, 1.0], [1.0, 0.0, 2.0]]))[0]


def noise(count, fwhm=8):
    """Maps with the smoothness of brains' maps."""
    maps = heat((POINTS, FACES), RNG.normal(size=(N, count)), fwhm=fwhm)
    return (3 + maps / maps.std()).astype(np.float32)


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.M | re.S)


def write_cifti(path, rows, models, series):
    first = (cifti2.SeriesAxis(0, 0.72, len(rows), "SECOND") if series
             else cifti2.ScalarAxis(["map"] * len(rows)))
    nib.save(cifti2.Cifti2Image(rows, cifti2.Cifti2Header.from_axes((first, models))), path)


def write_files():
    cortex = POINTS[:, 0] > -35
    maps = noise(10)
    for side, name in (("L", "Left"), ("R", "Right")):
        samples.write_surface(f"{side}.midthickness.surf.gii", POINTS, FACES, f"Cortex{name}")
    samples.write_gifti("L.thickness.shape.gii", {"thickness": maps[:, 0]})
    other, faces = samples.sphere(4, 100.0)
    brain = 0.7 * other  # no sphere of registration, whose radius is 100 mm
    samples.write_surface("fsLR.L.sphere.surf.gii", other @ TURN, faces)
    samples.write_surface("fsLR.L.midthickness.surf.gii", brain @ TURN, faces)
    samples.write_surface("L.sphere.surf.gii", 2 * POINTS, FACES)
    samples.write_gifti("L.roi.shape.gii", {"roi": cortex})
    ball = np.linalg.norm(np.indices((20, 20, 20)).T - [9, 9, 9], axis=-1) < 7
    models = (cifti2.BrainModelAxis.from_surface(np.flatnonzero(cortex), N, "CORTEX_LEFT")
              + cifti2.BrainModelAxis.from_surface(np.flatnonzero(cortex), N, "CORTEX_RIGHT")
              + cifti2.BrainModelAxis.from_mask(ball, "THALAMUS_LEFT", affine=np.diag([2, 2, 2, 1])))
    rows = np.concatenate([maps[cortex, :3].T, maps[cortex, 3:6].T,
                           RNG.normal(3, 1, (3, ball.sum()))], axis=1)
    write_cifti("bold.dtseries.nii", rows.astype(np.float32), models, True)
    inside = np.concatenate([POINTS[cortex, 1] > 0] * 2 + [np.arange(ball.sum()) % 5 > 0])
    write_cifti("roi.dscalar.nii", inside[None].astype(np.float32), models, False)

    os.makedirs("bert/surf")
    os.makedirs("bert/label")
    os.mkdir("smoothed")
    os.makedirs("fsaverage5/surf")
    for name, points in (("lh.white", brain), ("lh.sphere.reg", other)):
        samples.write_surface(f"bert/surf/{name}", POINTS, FACES)
        samples.write_surface(f"fsaverage5/surf/{name}", points @ TURN, faces)
    nib.freesurfer.write_morph_data("bert/surf/lh.thickness", maps[:, 0], fnum=len(FACES))
    for name in ("sub-01.thickness.mgh", "sub-02.thickness.mgh"):
        samples.write_mgh(name, maps[:, 0])
    samples.write_mgh("residuals.mgh", maps - maps.mean(axis=1, keepdims=True))
    chosen = np.flatnonzero(cortex)
    lines = "".join(f"{v} 0 0 0 0\n" for v in chosen)
    Path("bert/label/lh.cortex.label").write_text(
        f"#!ascii label, from subject bert\n{len(chosen)}\n{lines}")
    samples.write_annot("bert/label/lh.aparc.annot", (POINTS[:, 2] > 0).astype(int),
                        ["unknown", "precentral"])

    samples.write_surface("lh.central.sub.gii", POINTS, FACES)
    nib.freesurfer.write_morph_data("lh.thickness.sub", maps[:, 0], fnum=len(FACES))
    samples.write_surface("lh.white.surf.gii", POINTS, FACES)
    samples.write_gifti("data.func.gii", {"data": maps[:, 0]})
    samples.write_gifti("residuals.func.gii", {str(i): maps[:, i] - 3 for i in range(10)})
    for name in ("data", "residuals"):
        os.rename(f"{name}.func.gii", f"{name}.gii.dset")


class ComingFrom(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def test_lines_of_the_shell(self):
        write_files()
        found = 0
        for block in blocks("sh"):
            theirs = None
            for line in block.splitlines():
                words = line.split()
                with self.subTest(line):
                    if words[0] == "wb_command":
                        if shutil.which("wb_command"):
                            subprocess.run(words, check=True, capture_output=True)
                            theirs = self.values(line)
                        continue
                    self.assertEqual(words[0], "surfacediffusion")
                    if "--jobs" in words:  # starts processes of its own
                        subprocess.run([sys.executable, "-m", "surfacediffusion.command", *words[1:]],
                                       check=True, capture_output=True)
                    else:
                        code, _, error = run(*words[1:])
                        self.assertEqual((code, error), (0, ""))
                    found += 1
                    if theirs is not None:
                        self.compare(self.values(line), theirs)
        self.assertGreater(found, 10)

    def values(self, line):
        """The columns of the output that a line names, by the parts of the brain."""
        path = re.search(r"\S*smooth\.\S+", line)[0]
        if path.endswith(".nii"):
            image = nib.load(path)
            values = np.asarray(image.dataobj)
            return [values[:, place].T for _, place, _ in image.header.get_axis(1).iter_structures()]
        return [part.values for part in read_data(path).parts]

    def compare(self, ours, theirs):
        self.assertEqual([a.shape for a in ours], [b.shape for b in theirs])
        for a, b in zip(ours, theirs):
            inside = (b != 0).any(axis=1)
            np.testing.assert_array_equal(a[~inside], 0)
            difference = np.sqrt(((a - b)[inside]**2).mean(axis=0)) / b[inside].std(axis=0)
            # Of which .027 is between Workbench and the heat equation (Testing/Command/TestWorkbench.py).
            self.assertLess(difference.max(), 0.04)

    def test_lines_of_python(self):
        maps = noise(2)
        mesh = PolyMesh(left=InMemoryMesh(POINTS, FACES), right=InMemoryMesh(POINTS, FACES))
        names = {"img": SurfaceImage(mesh, {"left": maps, "right": maps[::-1].copy()}),
                 "mask_img": SurfaceImage(mesh, {k: (POINTS[:, 0] > 0).astype(np.float32)
                                                 for k in ("left", "right")})}
        for block in blocks("python"):
            exec(compile(block, "coming_from.md", "exec"), names)
        theirs, ours = (names[name].data.parts["left"] for name in ("theirs", "ours"))
        self.assertGreater(np.corrcoef(theirs[:, 0], ours[:, 0])[0, 1], 0.97)
        np.testing.assert_array_equal(names["inside"].data.parts["left"][POINTS[:, 0] <= 0], 0)
        self.assertGreater(names["fwhm"], 8)


if __name__ == "__main__":
    unittest.main(verbosity=2)
