# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Every word of the command, with no more than it must have, on coarse and odd surfaces."""

import pathlib
import sys
import tempfile
import unittest

import numpy as np
from samples import off_text, run

from surfacediffusion.command.arguments import SAME_WORDS, make_parser

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "Numpy"))
from TestCoarse import SURFACES  # noqa: E402

#: v.npy: a value at each point; some.npy: at two of three; many.npy: ten.
WORDS = {
    "smooth": "s.off v.npy 0.3 out.npy", "denoise": "s.off v.npy out.npy", "denoise-mesh": "s.off out.off",
    "inpaint": "s.off some.npy out.npy", "interpolate": "s.off some.npy out.npy",
    "enhance": "s.off v.npy out.npy", "edges": "s.off v.npy out.npy", "segment": "s.off v.npy out.npy",
    "refine": "s.off 0.3 out.off", "texture": "s.off 0.9 out.off", "directions": "s.off out.npy",
    "curvature": "s.off out.npy", "derivatives": "s.off v.npy out.npy", "distance": "s.off out.npy --from 0",
    "path": "s.off out.npy --from 0 --to 1",
    "normals": "s.off out.npy", "fwhm": "s.off many.npy", "scale-filter": "s.off v.npy 0.3 out.npy",
    "spectrum": "s.off v.npy 0.3 3", "random-field": "s.off out.npy --fwhm 0.3",
    "surrogates": "s.off v.npy out.npy", "resample": "s.off s.off v.npy out.npy", "info": "s.off v.npy"}
#: Words of other programs, and that without files.
OTHERS = {word[1:] for word in SAME_WORDS} | {"doctor"}


class CoarseFiles(unittest.TestCase):
    def test_every_word_has_a_result_or_says_what_is_allowed(self):
        words = set(make_parser()._subparsers._group_actions[0].choices)
        self.assertEqual(words, {*WORDS} | OTHERS)
        random = np.random.default_rng(5)
        for name, points, faces in SURFACES:
            if name not in ("Octahedron", "ExtrudedL", "PlaneOf7", "ThreeSheets", "MoebiusStrip"):
                continue
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                values = random.normal(size=len(points))
                (folder / "s.off").write_text(off_text(points, faces))
                np.save(folder / "v.npy", values)
                np.save(folder / "some.npy", np.where(np.arange(len(points)) % 3 == 1, np.nan, values))
                np.save(folder / "many.npy", random.normal(size=(len(points), 10)))
                for word, text in WORDS.items():
                    with self.subTest(surface=name, word=word):
                        files = [folder / part if "." in part and part[0].isalpha() else part
                                 for part in text.split()]
                        code, _, said = run(word, *files)
                        if code != 0:
                            self.assertIn(code, (1, 2), said)
                            self.assertRegex(said.splitlines()[-1], "allowed:|--")
                        out = folder / "out.npy"
                        if out.exists():
                            self.assertTrue(np.isfinite(np.load(out)).all() or said)
                            out.unlink()


if __name__ == "__main__":
    unittest.main(verbosity=2)
