# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Two other programs judge parts: manifold3d takes every solid that bodies() calls closed and oriented, with its
volume, and trimesh calls watertight what bodies() calls closed and manifold."""

import tempfile
import unittest
import warnings
from pathlib import Path

import manifold3d
import numpy as np
import trimesh

import parts_to_print as parts
import surfacediffusion as sd
from surfacediffusion.command import main
from surfacediffusion.files import read_surface
from surfacediffusion.files.export import export

BOX, ROD, GEAR, BALL, TUBE = parts.box(), parts.rod(), parts.gear(), parts.ball(), parts.tube()
SMALL = parts.box((8, 8, 8), (8, 8, 8))
#: Part, and whether it is a solid after welding.
PARTS = {
    **{name: (part, True) for name, part in (("box", BOX), ("rod", ROD), ("gear", GEAR), ("ball", BALL), ("tube", TUBE))},
    **{f"{name} rounded apart": (parts.rounded_apart(part), True)
       for name, part in (("box", BOX), ("rod", ROD), ("gear", GEAR), ("ball", BALL), ("tube", TUBE))},
    **{f"{name} with T-junctions": (parts.with_t_junctions(part), True)
       for name, part in (("box", BOX), ("rod", ROD), ("gear", GEAR), ("ball", BALL), ("tube", TUBE))},
    **{f"{name} with repeated facets": (parts.with_repeats(part), True)
       for name, part in (("box", BOX), ("rod", ROD), ("gear", GEAR), ("ball", BALL))},
    **{f"{name} with opposite facets": (parts.with_repeats(part, opposite=True), True)
       for name, part in (("box", BOX), ("rod", ROD), ("gear", GEAR), ("ball", BALL))},
    **{f"{name} with facets of no area": (parts.with_flat_facets(part), True)
       for name, part in (("box", BOX), ("rod", ROD), ("gear", GEAR))},
    "box twice": (parts.with_repeats(BOX, 12), True),
    "soup of everything": (parts.rounded_apart(parts.with_repeats(parts.with_t_junctions(GEAR, 9), 9), 1e-7), True),
    "hollow": (parts.hollow(BOX, SMALL), True),
    "hollow ball, rounded apart": (parts.rounded_apart(parts.hollow(BALL, parts.ball(5))), True),
    "ball in a hollow box": (parts.together(parts.hollow(BOX, SMALL), parts.ball(3, (12, 12, 12))), True),
    "apart": (parts.together(BOX, parts.rod(place=(60, 0, 0))), True),
    "overlapping": (parts.together(BOX, parts.box(place=(12, 5, 3))), True),
    "stacked": (parts.stacked(), True),
    "inside out": (parts.inside_out(GEAR), True),
    "one facet turned": ((BOX[0], np.vstack([BOX[1][:1, ::-1], BOX[1][1:]])), True),
    "far away": ((BOX[0] + 1e4, BOX[1]), True),
    "in metres": ((1e-3 * TUBE[0], TUBE[1]), True),
    "without a facet": ((BOX[0], BOX[1][1:]), False),
    "with a fin": ((np.vstack([BOX[0], [[30, 30, 30]]]), np.vstack([BOX[1], [[5, 7, 8]]])), False),
    "with a wall inside": ((BOX[0], np.vstack([BOX[1], [[0, 1, 7], [0, 7, 6]]])), False),
    "boxes with a common edge": (parts.together(BOX, parts.box(place=(24, 24, 0))), None),
}


def judge(test, points, triangles):
    """Whether both programs agree with bodies(), which is returned."""
    found = sd.bodies((points, triangles))
    watertight = trimesh.Trimesh(points, triangles, process=False).is_watertight
    test.assertEqual(watertight, found.open_edges == 0 and found.non_manifold_edges == 0)
    solid = manifold3d.Manifold(manifold3d.Mesh64(
        np.array(points, dtype=np.float64, order="C"), np.array(triangles, dtype=np.uint64, order="C")))
    accepted = solid.status() == manifold3d.Error.NoError and not solid.is_empty()
    if found.open_edges == 0 and found.misoriented_edges == 0:
        test.assertTrue(accepted, solid.status())
        volume = sum(body.volume for body in found.table)
        test.assertGreater(volume, 0)
        test.assertAlmostEqual(solid.volume() / volume, 1, delta=1e-9)
    elif found.open_edges:
        test.assertFalse(accepted)
    return found


class Judges(unittest.TestCase):
    def test_there_are_more_than_forty_parts(self):
        self.assertGreaterEqual(len(PARTS), 40)

    def test_agree_on_parts_that_are_read_from_stl_and_welded(self):
        for name, (part, is_solid) in PARTS.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                export(Path(folder, "part.stl"), *parts.soup(part))
                given = read_surface(Path(folder, "part.stl"), weld=False)
                welded = sd.weld((given.points, given.faces)).surface
                fine = sd.refine(welded, np.linalg.norm(np.ptp(part[0], axis=0)) / 20).surface
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    result = sd.relief(fine, np.zeros(fine.n_points), 0.0).surface  # oriented outwards
                found = judge(self, result.points, result.triangles)
                if is_solid is not None:
                    closed = (found.open_edges, found.non_manifold_edges, found.misoriented_edges) == (0, 0, 0)
                    self.assertEqual(closed, is_solid)

    def test_agree_on_what_the_command_writes(self):
        for name in ("box", "rod rounded apart", "gear with T-junctions", "ball with opposite facets", "hollow",
                     "apart", "one facet turned", "without a facet"):
            for output in ("out.stl", "out.3mf", "out.ply") if name == "hollow" else ("out.stl",):
                with self.subTest(name, output=output), tempfile.TemporaryDirectory() as folder:
                    part, out = Path(folder, "part.stl"), Path(folder, output)
                    export(part, *parts.soup(PARTS[name][0]))
                    self.assertEqual(main(["texture", str(part), "8mm", str(out), "--relief", "0.4mm", "--steps", "30",
                                           "--quiet"]), 0)
                    written = read_surface(out, weld=False)
                    found = judge(self, written.points, written.faces)
                    self.assertEqual(found.open_edges == 0, name != "without a facet")
                    self.assertEqual((found.non_manifold_edges, found.misoriented_edges), (0, 0))

    def test_agree_on_the_solids_of_two_colours(self):
        flat = ["--keep-flat", "angle -z 10", "--overhang", "30", "--flank", "0.3mm", "--seed", "3"]  # it has pinches
        for name, size, more in (("hollow", "8mm", []), ("gear", "8mm", []), ("gear", "5mm", flat)):
            with self.subTest(name, size=size), tempfile.TemporaryDirectory() as folder:
                part, out, plain = (Path(folder, file) for file in ("part.ply", "out.3mf", "plain.ply"))
                export(part, *PARTS[name][0])
                line = ["texture", str(part), size, str(out), "--relief", "0.4mm", "--steps", "300", "--quiet", *more]
                self.assertEqual(main([*line, "--two-colour"]), 0)
                self.assertEqual(main([*line[:3], str(plain), *line[4:]]), 0)
                written = read_surface(out)
                sums = []
                for i in range(2):
                    found = judge(self, written.points, written.faces[written.image.of_face == i])
                    self.assertEqual((found.open_edges, found.non_manifold_edges, found.misoriented_edges), (0, 0, 0))
                    sums.append(sum(body.volume for body in found.table))
                whole = read_surface(plain)
                expected = sum(body.volume for body in sd.bodies((whole.points, whole.faces)).table)
                self.assertGreater(sums[1], 0)
                self.assertAlmostEqual(sum(sums) / expected, 1, delta=1e-7)


if __name__ == "__main__":
    unittest.main()
