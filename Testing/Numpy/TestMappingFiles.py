# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The lines of Documentation/files.md read files in the formats of mapping systems."""
import os
import re
import tempfile
import unittest
from pathlib import Path

import numpy as np
import surfacediffusion as sd
from scipy.io import savemat

PAGE = Path(__file__).resolve().parents[2] / "Documentation" / "files.md"
POINTS, FACES = (lambda ball: (20.0 * ball.points, ball.triangles))(sd.sphere(3))
PLACES = 20.5 * np.column_stack([np.cos(np.arange(40)), np.sin(np.arange(40)), np.linspace(-0.9, 0.9, 40)])
PLACES[:, :2] *= np.sqrt(1.0 - np.linspace(-0.9, 0.9, 40) ** 2)[:, None]
TIMES = (PLACES[:, 2] + 25.0).round(1)
UNKNOWN = np.arange(40) % 8 == 3


def rows_of(array, template="{}"):
    return [template.format(*row) for row in array]


class ImportLines(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def run_block(self, part):
        """The variables of the block of the page that has the words."""
        blocks = [block for block in re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL) if part in block]
        self.assertEqual(len(blocks), 1)
        found = {}
        exec(blocks[0], found)  # pylint: disable=exec-used
        return found

    def assert_map(self, found, **keywords):
        np.testing.assert_allclose(found["points"], POINTS, atol=1e-4)
        np.testing.assert_array_equal(found["faces"], FACES)
        self.assert_values(found, (found["points"], found["faces"]), **keywords)

    def assert_values(self, found, surface, **keywords):
        np.testing.assert_allclose(found["places"], PLACES, atol=1e-4)
        result = sd.interpolate(surface, found["times"], found["places"], exact=True, **keywords)
        self.assertEqual(result.number_of_values, int((~UNKNOWN).sum()))
        expected = sd.interpolate((POINTS, FACES), TIMES[~UNKNOWN], PLACES[~UNKNOWN], exact=True)
        np.testing.assert_allclose(result.values, expected.values, atol=1e-2)

    def test_carto(self):
        times = np.where(UNKNOWN, -10000, TIMES)
        cut = np.vstack([np.c_[FACES, np.zeros((len(FACES), 4))], [0, 1, 2, 0, 0, 0, -1000000]])
        lines = ["#TriangulatedMeshVersion2.0", "; comment", "", "[GeneralAttributes]", "MeshID               = 3",
                 "NumVertex            = 642", "MeshName             = LA=1", "", "[VerticesSection]", ";  X  Y  Z"]
        lines += [f"{i}  =  {x:.4f} {y:.4f} {z:.4f}  0.0 0.0 1.0  0" for i, (x, y, z) in enumerate(POINTS)]
        lines += ["", "[TrianglesSection]", ";  Vertex0  Vertex1  Vertex2"]
        lines += [f"{i}  =  {int(row[0])} {int(row[1])} {int(row[2])}  0.0 0.0 1.0  {int(row[6])}"
                  for i, row in enumerate(cut)]
        lines += ["", "[VerticesColorsSection]", "; Unipolar Bipolar LAT", "0 = -10000 -10000 -10000", ""]
        Path("1-LA.mesh").write_text("\r\n".join(lines), encoding="latin-1")
        rows = [f"P\t1\t{i}\t0\t{x:.5f}\t{y:.5f}\t{z:.5f}\t0\t0\t0\t1.2\t0.3\t{time:g}\t0\t-1"
                for i, ((x, y, z), time) in enumerate(zip(PLACES, times))]
        Path("1-LA_car.txt").write_text("\n".join(["VERSION_4_0 1-LA", *rows]) + "\n")
        found = self.run_block("1-LA.mesh")
        self.assert_map(found, missing_value=-10000)
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "5 values of the points are -10000.*missing_value"):
            sd.interpolate((POINTS, FACES), found["times"], found["places"])

    def test_ensite(self):
        table = {"pt number:": np.arange(40), "utilized:": 1 - UNKNOWN, "surfPt x:": PLACES[:, 0],
                 "surfPt y:": PLACES[:, 1], "surfPt z:": PLACES[:, 2],
                 "rov LAT:": 1.5 + TIMES / 1000, "ref LAT:": np.full(40, 1.5)}
        for number, part in enumerate((slice(25), slice(25, 40)), 1):
            lines = ["St. Jude Medical. File Revision : 5.2.2", "Export from Study : x,", "Begin data"]
            lines += [",".join([name, *(f"{value:.7g}" for value in row[part])]) + "," for name, row in table.items()]
            Path(f"DxL_{number}.csv").write_text("\n".join(lines))
        found = self.run_block("DxL_*.csv")
        order = np.argsort(found["places"][:, 2])  # files come in any order
        self.assert_values({"places": found["places"][order], "times": found["times"][order]}, (POINTS, FACES))

    def test_openep(self):
        marks = np.where(UNKNOWN, 5000.0, 2 * TIMES + 500)  # outside of the window of interest
        savemat("openep.mat", {"userdata": {
            "surface": {"triRep": {"X": POINTS, "Triangulation": FACES + 1.0}, "act_bip": np.c_[POINTS[:, 2], POINTS[:, 0]]},
            "electric": {"egmSurfX": PLACES, "sampleFrequency": 2000.0,
                         "annotations": {"mapAnnot": marks, "referenceAnnot": np.full(40, 500.0),
                                         "woi": np.tile([-300.0, 300.0], (40, 1))}}}})
        found = self.run_block("openep.mat")
        self.assert_map(found)
        np.testing.assert_array_equal(found["activation"], POINTS[:, 2])

    def test_opencarp(self):
        fibres = np.roll(POINTS[FACES[:, 0]], 1, axis=1) / 20.0
        Path("atrium.pts").write_text("\n".join([str(len(POINTS)), *rows_of(1000 * POINTS, "{:.3f} {:.3f} {:.3f}")]))
        Path("atrium.elem").write_text("\n".join([str(len(FACES)), *rows_of(FACES, "Tr {} {} {} 7")]))
        Path("atrium.lon").write_text("\n".join(["1", *rows_of(fibres, "{:.6f} {:.6f} {:.6f}")]))
        found = self.run_block("atrium.pts")
        np.testing.assert_allclose(found["points"], POINTS, atol=1e-4)
        np.testing.assert_array_equal(found["faces"], FACES)
        times = sd.distance((found["points"], found["faces"]), [0], directions=found["directions"],
                            along_speed=0.6, across_speed=0.3)
        np.testing.assert_allclose(times, sd.distance((POINTS, FACES), [0], directions=fibres, along_speed=0.6,
                                                      across_speed=0.3), rtol=1e-3, atol=1e-2)


if __name__ == "__main__":
    unittest.main()
