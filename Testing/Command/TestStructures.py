# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""CIFTI files with structures beside the cortex, and the areas of the vertices of each."""

import shutil
import subprocess
import unittest
from pathlib import Path

import nibabel as nib
import numpy as np
import samples
from nibabel import cifti2
from samples import FACES, N, POINTS, run
from TestWorkbench import WorkbenchTest
from TestWorkbenchCifti import load, places, save, voxels

from surfacediffusion import Surface, heat
from surfacediffusion.files import read_data
from surfacediffusion.files.cifti import open_cifti, structure_of_word, word_of_structure
from surfacediffusion.files.content import read_content

FINE, FINE_FACES = samples.sphere(4, 30.0)
SOME = np.flatnonzero(POINTS[:, 2] > -5)  #: the vertices of the dentate in the file
SURFACES = ("--left l.surf.gii --surface HIPPOCAMPUS_LEFT h.surf.gii "
            "--surface HIPPOCAMPUS_DENTATE_RIGHT d.surf.gii").split()


def as_workbench_2_writes(path, rows, models):
    """HIPPOCAMPUS_DENTATE_RIGHT, which nibabel does not know, in place of OTHER."""
    save("plain.dscalar.nii", rows, models)
    content = Path("plain.dscalar.nii").read_bytes()
    old, new = b"CIFTI_STRUCTURE_OTHER", b"CIFTI_STRUCTURE_HIPPOCAMPUS_DENTATE_RIGHT"
    # The description grows into its padding, or by whole blocks.
    start = content.index(b"<?xml") if b"<?xml" in content else content.index(b"<CIFTI")
    header = bytearray(content[:start])
    size = int.from_bytes(header[start - 8:start - 4], "little")
    text = content[start:start + size - 8].rstrip(b"\0").replace(old, new)
    text += b"\0" * (-(len(text) + 8) % 16)
    offset = int(np.frombuffer(content[168:176], "<i8")[0])
    moved = len(text) + 8 - size
    header[168:176] = np.int64(offset + moved).tobytes()
    header[start - 8:start - 4] = np.int32(len(text) + 8).tobytes()
    Path(path).write_bytes(bytes(header) + text + content[start + size - 8:])


class Structures(WorkbenchTest):
    def setUp(self):
        super().setUp()
        self.models = (cifti2.BrainModelAxis.from_surface(np.arange(N), N, "CORTEX_LEFT")
                       + cifti2.BrainModelAxis.from_surface(np.arange(len(FINE)), len(FINE), "HIPPOCAMPUS_LEFT")
                       + cifti2.BrainModelAxis.from_surface(SOME, N, "OTHER") + voxels())
        self.rows = np.random.default_rng(3).normal(3, 1, (2, len(self.models))).astype(np.float32)
        as_workbench_2_writes("a.dscalar.nii", self.rows, self.models)
        samples.write_surface("l.surf.gii")
        samples.write_surface("h.surf.gii", FINE, FINE_FACES, "HippocampusLeft")
        samples.write_surface("d.surf.gii", 2 * POINTS, FACES, "")
        self.areas = {"l": np.random.default_rng(1).uniform(20, 40, N), "h": np.full(len(FINE), 9.0),
                      "d": np.random.default_rng(2).uniform(60, 90, N)}
        for name, structure in (("l", "CortexLeft"), ("h", "HippocampusLeft"), ("d", "")):
            samples.write_gifti(f"{name}.shape.gii", {"area": self.areas[name]}, structure)

    def expected(self, areas=(None, None, None)):
        found = self.rows.copy()
        place = places(self.models)
        for name, points, faces, vertices, area in (("CORTEX_LEFT", POINTS, FACES, np.arange(N), areas[0]),
                                                    ("HIPPOCAMPUS_LEFT", FINE, FINE_FACES, np.arange(len(FINE)),
                                                     areas[1]),
                                                    ("OTHER", 2 * POINTS, FACES, SOME, areas[2])):
            full = np.zeros((len(points), 2))
            full[vertices] = self.rows[:, place[name]].T
            outside = np.ones(len(points), bool)
            outside[vertices] = False
            found[:, place[name]] = heat(Surface(points, faces, area), full, fwhm=14.0, mask_mode="Exclude",
                                         number_of_time_steps=1, mask=outside if outside.any() else None)[vertices].T
        return found

    def smooth(self, *words):
        code, _, error = run("smooth", "a.dscalar.nii", 14, "b.dscalar.nii", "--surface-only", *SURFACES, *words)
        self.assertEqual((code, error), (0, ""))
        return load("b.dscalar.nii")

    def test_each_is_smoothed_on_its_own_surface(self):
        np.testing.assert_allclose(self.smooth(), self.expected(), atol=1e-5)
        names = [entry.name for entry in open_cifti(read_content("b.dscalar.nii")).structures]
        self.assertEqual(names[:3], ["CortexLeft", "HippocampusLeft", "HippocampusDentateRight"])
        self.succeed("cifti-smoothing", "a.dscalar.nii", 14, 0, "COLUMN", "c.dscalar.nii", "-fwhm", "-left-surface",
                     "l.surf.gii", *[word.replace("--", "-") for word in SURFACES[2:]])
        np.testing.assert_array_equal(load("c.dscalar.nii"), load("b.dscalar.nii"))

    def test_areas_are_given_for_each(self):
        areas = "--areas l.shape.gii --areas h.shape.gii --areas HIPPOCAMPUS_DENTATE_RIGHT d.shape.gii".split()
        found = self.smooth(*areas)
        np.testing.assert_allclose(found, self.expected([self.areas[name] for name in "lhd"]), atol=1e-5)
        self.assertGreater(abs(found - self.expected()).max(), 0.05)
        models = self.models[self.models.surface_mask]
        save("areas.dscalar.nii", [np.concatenate([self.areas["l"], self.areas["h"], self.areas["d"][SOME]])], models)
        self.succeed("cifti-smoothing", "a.dscalar.nii", 14, 0, "COLUMN", "c.dscalar.nii", "-fwhm", "-left-surface",
                     "l.surf.gii", "-left-corrected-areas", "l.shape.gii",
                     *[word.replace("--", "-") for word in SURFACES[2:]], "-corrected-areas", "h.shape.gii",
                     "-corrected-areas", "HIPPOCAMPUS_DENTATE_RIGHT", "d.shape.gii")
        np.testing.assert_array_equal(load("c.dscalar.nii"), found)

    def test_what_is_missing_or_given_twice_is_named(self):
        self.assertIn("Other", [e.name for e in open_cifti(read_content("plain.dscalar.nii")).structures])
        for words, message in (
                ("--left l.surf.gii", "a.dscalar.nii has data of HippocampusLeft and HippocampusDentateRight; add "
                 "--surface HIPPOCAMPUS_LEFT FILE --surface HIPPOCAMPUS_DENTATE_RIGHT FILE"),
                (f"{' '.join(SURFACES)} --areas l.shape.gii", "allowed: for none or all: add --areas "
                 "HIPPOCAMPUS_LEFT FILE --areas HIPPOCAMPUS_DENTATE_RIGHT FILE"),
                (f"{' '.join(SURFACES)} --areas l.shape.gii --areas CORTEX_LEFT l.shape.gii",
                 "--areas l.shape.gii: areas of a surface that has some"),
                (f"{' '.join(SURFACES)} --surface CORTEX_LEFT l.surf.gii", "--surface CORTEX_LEFT and another surface"),
                (" ".join(SURFACES).replace("d.surf", "h.surf"), "--surface HIPPOCAMPUS_DENTATE_RIGHT: for "
                 "HippocampusDentateRight, but h.surf.gii is of HippocampusLeft; allowed: the same hemisphere"),
                (" ".join(SURFACES).replace("d.surf", "h.surf") + " --any-hemisphere", f"a.dscalar.nii: {N} "
                 f"values per column, but h.surf.gii has {len(FINE)} points"),
                (f"{' '.join(SURFACES)} --areas THALAMUS_LEFT l.shape.gii", "areas of ThalamusLeft; allowed: of "
                 "CortexLeft, HippocampusLeft, HippocampusDentateRight, by --areas STRUCTURE FILE")):
            code, _, error = run("smooth", "a.dscalar.nii", 14, "o.dscalar.nii", *words.split())
            self.assertEqual((code, error.count("\n")), (2, 1), error)
            self.assertIn(message, error)

    def test_words_of_structures_are_those_of_workbench(self):
        for word in ("CORTEX_LEFT", "HIPPOCAMPUS_DENTATE_RIGHT", "OTHER", "DIENCEPHALON_VENTRAL_LEFT", "CEREBELLUM"):
            self.assertEqual(word_of_structure(structure_of_word(word)), word)


@unittest.skipUnless(shutil.which("wb_command"), "needs Connectome Workbench")
class AreasOfWorkbench(WorkbenchTest):
    def test_each_hemisphere_has_its_corrected_areas(self):
        points, faces = samples.sphere(5, 50.0)
        rng = np.random.default_rng(4)
        models = (cifti2.BrainModelAxis.from_surface(np.arange(len(points)), len(points), "CORTEX_LEFT")
                  + cifti2.BrainModelAxis.from_surface(np.arange(len(points)), len(points), "CORTEX_RIGHT"))
        rows = np.concatenate([heat((points, faces), rng.normal(size=(len(points), 2)), fwhm=10) for _ in "LR"]).T
        save("a.dscalar.nii", rows, models)
        words = []
        for side, factor in (("left", 1.4), ("right", 2.0)):
            samples.write_surface(f"{side}.surf.gii", points, faces, "Cortex" + side.capitalize())
            areas = Surface(points, faces).vertex_areas * factor * (1 + 0.2 * points[:, 2] / 50)
            samples.write_gifti(f"{side}.shape.gii", {"area": areas}, "Cortex" + side.capitalize())
            words += [f"-{side}-surface", f"{side}.surf.gii", f"-{side}-corrected-areas", f"{side}.shape.gii"]
        kernel = ["a.dscalar.nii", "8", "0", "COLUMN"]
        subprocess.run(["wb_command", "-cifti-smoothing", *kernel, "wb.dscalar.nii", "-fwhm", *words], check=True)
        self.succeed("-cifti-smoothing", *kernel, "ours.dscalar.nii", "-fwhm", *words)
        ours, theirs = load("ours.dscalar.nii"), load("wb.dscalar.nii")
        self.succeed("smooth", "a.dscalar.nii", 8, "plain.dscalar.nii", "--left", "left.surf.gii", "--right",
                     "right.surf.gii")
        for place in places(models).values():
            for a, b, plain in zip(ours[:, place], theirs[:, place], load("plain.dscalar.nii")[:, place]):
                self.assertLess(np.sqrt(np.mean((a - b)**2)) / b.std(), 0.02)
                self.assertGreater(np.sqrt(np.mean((plain - b)**2)) / b.std(), 0.03)

    def test_a_hippocampus_has_the_map_of_its_metric(self):
        points, faces = samples.sphere(5, 25.0)
        samples.write_surface("h.surf.gii", points * [1, 0.5, 0.4], faces, "HippocampusLeft")
        field = heat((points * [1, 0.5, 0.4], faces), np.random.default_rng(4).normal(size=len(points)), fwhm=6)
        samples.write_gifti("h.func.gii", {"one": field}, "HippocampusLeft")
        save("h.dscalar.nii", [field], cifti2.BrainModelAxis.from_surface(
            np.arange(len(points)), len(points), "HIPPOCAMPUS_LEFT"))
        subprocess.run(["wb_command", "-metric-smoothing", "h.surf.gii", "h.func.gii", "4", "wb.func.gii", "-fwhm"],
                       check=True)
        self.succeed("smooth", "h.dscalar.nii", 4, "o.dscalar.nii", "--surface", "HIPPOCAMPUS_LEFT", "h.surf.gii")
        theirs = read_data("wb.func.gii").parts[0].values[:, 0]
        self.assertLess(np.sqrt(np.mean((load("o.dscalar.nii")[0] - theirs)**2)), 0.03 * theirs.std())
        self.assertEqual(nib.load("o.dscalar.nii").header.get_axis(1), nib.load("h.dscalar.nii").header.get_axis(1))


if __name__ == "__main__":
    unittest.main(verbosity=2)
