# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`texture` makes parts for printing: from STL to STL, 3MF, OBJ, OFF and PLY, in one line."""

import json
import os
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

import numpy as np
from samples import run

from surfacediffusion.files import read_surface
from surfacediffusion.files.export import export

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
SIDE = 24.0


def box(size=SIDE):
    points = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) * size
    squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return points, np.array([t for a, b, c, d in squares for t in ((a, b, c), (a, c, d))])


def volume(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def is_closed(triangles):
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    ways = {tuple(side) for side in sides.tolist()}
    return len(ways) == len(sides) and all((b, a) in ways for a, b in ways)


def read_3mf(path):
    """Points, triangles and the unit, by the parts of the package that name each other."""
    with zipfile.ZipFile(path) as archive:
        types = ElementTree.fromstring(archive.read("[Content_Types].xml"))
        known = {entry.get("Extension"): entry.get("ContentType") for entry in types}
        relation = ElementTree.fromstring(archive.read("_rels/.rels"))[0]
        assert relation.get("Type").endswith("/3dmodel"), relation.attrib
        target = relation.get("Target")
        assert known[target.split(".")[-1]].endswith("3dmodel+xml"), known
        model = ElementTree.fromstring(archive.read(target.lstrip("/")))
    (item,) = model.find(CORE + "build")
    (found,) = [entry for entry in model.find(CORE + "resources")
                if entry.get("id") == item.get("objectid")]
    mesh = found.find(CORE + "mesh")
    points = np.array([[float(v.get(k)) for k in "xyz"] for v in mesh.find(CORE + "vertices")])
    triangles = np.array([[int(t.get(k)) for k in ("v1", "v2", "v3")]
                          for t in mesh.find(CORE + "triangles")])
    return points, triangles, model.get("unit")


class Printing(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        export("part.stl", *box())

    def succeed(self, line, warning=""):
        code, out, error = run(*line.split())
        self.assertEqual(code, 0, error)
        self.assertRegex(error, warning or "^$")
        return out

    def test_one_line_makes_a_closed_part_with_relief(self):
        line = "texture part.stl 4mm out.stl --relief 0.4mm --pattern labyrinth"
        report = json.loads(self.succeed(line + " --json"))
        surface = read_surface("out.stl")
        self.assertTrue(is_closed(surface.faces))
        self.assertEqual(report["triangles"], len(surface.faces))
        self.assertEqual((report["open_edges"], report["crossing_triangles"]), (0, 0))
        found = volume(surface.points, surface.faces)
        self.assertAlmostEqual((found - SIDE**3) / report["volume_change"], 1, delta=1e-4)
        self.assertGreater(report["volume_change"], 0.3 * 0.4 * 6 * SIDE**2)
        self.assertLess(report["volume_change"], 0.8 * 0.4 * 6 * SIDE**2)
        self.assertAlmostEqual(surface.points.max(), SIDE + 0.4, delta=1e-5)
        self.assertGreaterEqual(surface.points.min(), -0.4 - 1e-5)
        first = Path("out.stl").read_bytes()
        out = self.succeed(line)
        self.assertRegex(out, "out.stl: [0-9]+ triangles, pattern of 4 mm, relief of 0.4 mm, "
                              "smallest wall [0-9.]+ mm, closed, manifold, ")
        self.assertEqual(Path("out.stl").read_bytes(), first)

    def test_all_formats_have_the_same_part(self):
        for name in ("out.stl", "out.3mf", "out.obj", "out.off", "out.ply"):
            self.succeed(f"texture part.stl 8mm {name} --relief 0.5mm --steps 40")
        points, triangles, unit = read_3mf("out.3mf")
        self.assertEqual(unit, "millimeter")
        self.assertTrue(is_closed(triangles))
        for name in ("out.stl", "out.obj", "out.off", "out.ply"):
            other = read_surface(name)
            self.assertEqual(len(other.faces), len(triangles))
            np.testing.assert_allclose(other.points[other.faces], points[triangles], atol=1e-5)
        shades = np.array([line.split()[4:] for line in Path("out.obj").read_text().splitlines()
                           if line.startswith("v ")], dtype=float)
        self.assertEqual(shades.shape, (len(points), 3))
        self.assertEqual((shades.min(), shades.max()), (0, 1))
        words = [line.split() for line in Path("out.off").read_text().splitlines()[2:2 + len(points)]]
        np.testing.assert_allclose(np.array(words, dtype=float)[:, 3:6] / 255, shades, atol=1e-4)

    def test_parts_far_from_the_origin_keep_their_relief_in_stl(self):
        for place in (5e5, 5.2e6):
            points, triangles = box()
            export("far.ply", points + place, triangles)
            out = self.succeed("texture far.ply 8mm far.stl --relief 0.4mm --steps 40",
                               "far.stl: coordinates of up to .* have steps of .* in STL, so that the part is "
                               "moved by -[0-9. -]*[(]PLY and OBJ keep its place[)]")
            self.assertIn("closed, manifold", out)
            self.succeed("texture far.ply 8mm there.ply --relief 0.4mm --steps 40")
            found, expected = read_surface("far.stl"), read_surface("there.ply")
            self.assertTrue(is_closed(found.faces))
            corners, there = found.points[found.faces], expected.points[expected.faces]
            shift = np.round((there - corners).mean(axis=(0, 1)))
            np.testing.assert_allclose(corners, there - shift, atol=1e-5)

    def test_repeated_triangles_count_once_and_shared_edges_are_not_manifold(self):
        points, triangles = box()
        export("twice.ply", points, np.vstack([triangles, triangles]))
        out = self.succeed("texture twice.ply 8mm out.stl --relief 0.4mm --steps 40",
                           "12 triangles left out, since others have the same corners")
        self.assertIn("closed, manifold", out)
        two = np.vstack([points, points + [SIDE, SIDE, 0]])  # they share an edge
        export("two.ply", two, np.vstack([triangles, triangles + len(points)]))
        out = self.succeed("texture two.ply 8mm out.stl --relief 0.4mm --steps 40",
                           "edges of more than two triangles, where there is no relief")
        self.assertRegex(out, "closed, [0-9]+ edges of more than two triangles")

    def test_refine_keeps_colours_and_says_what_it_drops(self):
        points, triangles = box()
        colors = np.arange(24, dtype=np.uint8).reshape(8, 3) * 10
        export("box.ply", points, triangles, colors)
        self.succeed("refine box.ply 3 fine.ply")
        fine = read_surface("fine.ply")
        found, others = fine.beside()
        self.assertEqual(others, [])
        np.testing.assert_array_equal(found[:8], colors)
        self.assertTrue(((found >= colors.min(axis=0)) & (found <= colors.max(axis=0))).all())
        self.succeed("refine box.ply 3 fine.stl",
                     "fine.stl has none of the colours of box.ply; --data takes data at the vertices along")
        Path("box.obj").write_text("mtllib a.mtl\nv 0 0 0\nv 9 0 0\nv 0 9 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                                   "usemtl red\nf 1/1 2/2 3/3\n")
        self.succeed("refine box.obj 3 fine.obj",
                     "fine.obj has none of the texture coordinates, materials of box.obj; --data takes ")
        Path("box.off").write_text("COFF\n3 1 0\n0 0 0 255 0 0 255\n9 0 0 0 255 0 255\n0 9 0 0 0 255 255\n3 0 1 2\n")
        self.succeed("refine box.off 3 fine.off", "fine.off has none of the colours of box.off")

    def test_refine_shortens_edges_and_takes_data_along(self):
        points, triangles = box()
        export("box.ply", points, triangles)
        np.save("x.npy", points[:, :1])
        out = self.succeed("refine box.ply 3 fine.ply --data x.npy fine.npy")
        self.assertRegex(out, r"^fine.ply: [0-9]+ triangles, edges of at most [0-9.]+, ")
        surface, found = read_surface("fine.ply"), np.load("fine.npy")
        self.assertTrue(is_closed(surface.faces))
        np.testing.assert_array_equal(found[:, 0], surface.points[:, 0])
        self.succeed("refine box.ply 3 fine.off")
        np.testing.assert_array_equal(read_surface("fine.off").points, surface.points)
        np.testing.assert_array_equal(read_surface("fine.off").faces, surface.faces)
        corners = surface.points[surface.faces]
        self.assertLessEqual(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(), 3)
        self.succeed("refine box.ply 0.1 few.stl --maximum-triangles 500",
                     "refinement stopped at edges of [0-9.]+, longer than 0.1, because "
                     "--maximum-triangles is 500")
        self.assertLessEqual(len(read_surface("few.stl").faces), 500)
        for line, pattern in (("box.ply 0 fine.ply", ".*"),
                              ("box.ply 1 fine.xyz", "fine.xyz: the name announces no format of surfaces.*"),
                              ("box.ply 1 fine.ply --data x.npy y.txt", "y.txt: the name announces no .*"),
                              ("box.ply 1 fine.ply --data part.stl y.npy", "part.stl: .*")):
            code, out, error = run("refine", *line.split())
            self.assertEqual((code, out), (2, ""), error)
            self.assertRegex(error, f"^surfacediffusion.*: {pattern}\n$")

    def test_units_are_converted(self):
        self.succeed("texture part.stl 8mm a.stl --relief 0.5mm --steps 20")
        self.succeed("texture part.stl 0.8cm b.stl --relief 500um --steps 20")
        self.assertEqual(Path("a.stl").read_bytes(), Path("b.stl").read_bytes())
        export("inches.stl", *box(SIDE / 32))
        self.succeed("texture inches.stl 0.25in c.3mf --relief 0.0127cm --unit in --steps 20")
        points, _, unit = read_3mf("c.3mf")
        self.assertEqual(unit, "inch")
        self.assertAlmostEqual(points.max(), SIDE / 32 + 0.005, delta=1e-5)
        self.succeed("texture part.stl 8 d.stl --relief 0.5 --steps 20",
                     "(?s)FEATURE_SIZE 8 has no unit: taken as 8 mm.*--relief 0.5 has no unit")
        self.assertEqual(Path("a.stl").read_bytes(), Path("d.stl").read_bytes())

    def test_a_part_that_is_finer_than_the_limit_stays_allowed(self):
        points, triangles = box()
        export("box.ply", points, triangles)
        self.succeed("refine box.ply 1 fine.ply")
        self.succeed("texture fine.ply 8mm out.stl --relief 0.5mm --steps 20 --maximum-triangles 100")
        self.assertEqual(len(read_surface("out.stl").faces), len(read_surface("fine.ply").faces))

    def test_the_limit_of_triangles_leaves_a_coarse_pattern_with_a_warning(self):
        self.succeed("texture part.stl 4mm out.obj --relief 0.4mm --steps 20 --maximum-triangles 20000",
                     "(?s)refinement stopped at edges of .* because --maximum-triangles is 20000")
        self.assertLessEqual(len(read_surface("out.obj").faces), 20000)

    def test_carving_levels_and_overhang(self):
        self.succeed("texture part.stl 8mm out.stl --relief=-0.5mm --flank 1mm --overhang 30 "
                     "--steps 60", "lowered by more than half of that at [0-9]+ of [0-9]+ points")
        surface = read_surface("out.stl")
        self.assertLess(volume(surface.points, surface.faces), SIDE**3)
        bottom = np.isclose(surface.points[:, 2], 0, atol=1e-6)
        self.assertGreater(bottom.sum(), 100)
        self.assertGreaterEqual(surface.points.min(), -1e-6)

    def test_without_relief_the_pattern_is_colour(self):
        self.succeed("texture part.stl 8mm out.obj --steps 40 --pattern spots")
        surface = read_surface("out.obj")
        self.assertAlmostEqual(volume(surface.points, surface.faces), SIDE**3, delta=1e-6)

    def test_bad_input_is_one_line(self):
        for line, pattern in (
                ("part.stl 60mm out.stl --relief 1mm",
                 "FEATURE_SIZE is 60 mm, but the part is 41.57 mm from corner to corner; allowed: .*"),
                ("part.stl 4mm out.stl", "out.stl: without relief nothing .*; allowed: --relief .*"),
                ("part.stl 4mm out.xyz --relief 1mm", "out.xyz: the name announces no format .*"),
                ("part.stl 4furlongs out.stl --relief 1mm", ".*'4furlongs'; allowed: a length above 0.*"),
                ("part.stl -4mm out.stl --relief 1mm", ".*"),
                ("part.stl 4mm out.stl --relief mm", ".*is 'mm'; allowed: a length.*"),
                ("part.stl 4mm out.stl --relief 1mm --overhang 91", ".*allowed: degrees from 0 to 90.*"),
                ("part.stl 4mm out.stl --relief 99mm",
                 "--relief is 99 mm, but the part is 41.57 mm .*; allowed: less")):
            with self.subTest(line):
                code, out, error = run("texture", *line.split())
                self.assertEqual((code, out), (2, ""), error)
                self.assertRegex(error, f"^surfacediffusion.*: {pattern}\n$")
        self.assertFalse(Path("out.stl").exists())


if __name__ == "__main__":
    unittest.main()
