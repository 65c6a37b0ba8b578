# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`texture` on parts as users bring them: rounded, cracked, repeated, of several bodies and objects, with faces to
leave flat, for a printer, in two colours."""

import json
import os
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

import numpy as np
from samples import run

sys.path.append(str(Path(__file__).parents[1] / "Numpy"))
import parts_to_print as parts  # noqa: E402

import surfacediffusion as sd  # noqa: E402
from surfacediffusion.files import read_surface  # noqa: E402
from surfacediffusion.files.export import export  # noqa: E402
from surfacediffusion.files.threemf import Objects, read  # noqa: E402

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"


def archive(model, name="3D/3dmodel.model", more=()):
    with zipfile.ZipFile("made.3mf", "w", zipfile.ZIP_DEFLATED) as file:
        for path, text in ((name, model), *more):
            file.writestr(path, text)
    return "made.3mf"


def mesh(part):
    points, faces = part
    return ("<mesh><vertices>" + "".join('<vertex x="{}" y="{}" z="{}"/>'.format(*row) for row in points.tolist())
            + "</vertices><triangles>" + "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*row)
                                                 for row in faces.tolist()) + "</triangles></mesh>")


class CommandTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def texture(self, part, output, *more, size="8mm", relief="0.4mm", warning="^$"):
        """The report of a run on a part or a file."""
        if not isinstance(part, str):
            export("part.stl", *parts.soup(part))
            part = "part.stl"
        raised = [f"--relief={relief}"] if relief else []
        code, out, error = run("texture", part, size, output, "--steps", "40", "--json", *raised, *more)
        self.assertEqual(code, 0, error)
        self.assertRegex(error, warning)
        return json.loads(out)

    def refused(self, pattern, *line):
        code, out, error = run("texture", *line)
        self.assertEqual((code, out), (2, ""), error)
        self.assertRegex(error, f"^surfacediffusion.*: {pattern}.*\n$")


class Solids(CommandTest):
    def check_closed(self, report, bodies=1):
        for name, count in (("closed", "open_edges"), ("manifold", "non_manifold_edges"),
                            ("oriented", "misoriented_edges")):
            self.assertIs(report[name], True)
            self.assertEqual(report[count], 0)
        self.assertEqual([body["closed"] for body in report["bodies"]], [True] * bodies)

    def test_the_report_is_that_of_the_file(self):
        report = self.texture(parts.box(), "out.stl")
        self.check_closed(report)
        written = read_surface("out.stl", weld=False)
        (body,) = report["bodies"]
        self.assertEqual((body["triangles"], report["triangles"]), (len(written.faces),) * 2)
        self.assertAlmostEqual(body["volume"] / parts.volume(written.points, written.faces), 1, delta=1e-12)
        self.assertEqual((report["welded"], report["split"], report["duplicates"], report["overlaps"]), (0, 0, 0, 0))

    def test_bad_facets_give_the_part_of_good_ones(self):
        export("part.ply", *parts.gear())
        clean = self.texture("part.ply", "clean.ply")["bodies"][0]["volume"]
        for part, counts, share in (  # other triangulations have other patterns
                (parts.rounded_apart(parts.gear()), {"welded": 480}, 1e-3),
                (parts.with_repeats(parts.gear(), opposite=True), {"duplicates": 7}, 1e-9),
                (parts.with_flat_facets(parts.gear()), {"split": 4, "zero_area": 4}, 1e-3)):
            with self.subTest(counts):
                export("part.ply", *part)
                report = self.texture("part.ply", "out.ply", warning="--weld 0 turns it off")
                self.check_closed(report)
                found = {name: report[name] for name in ("welded", "split", "duplicates", "zero_area")}
                if "welded" in counts:
                    counts["welded"] = found["welded"]
                    self.assertGreater(found["welded"], 400)
                self.assertEqual(found, {"welded": 0, "split": 0, "duplicates": 0, "zero_area": 0, **counts})
                self.assertAlmostEqual(report["bodies"][0]["volume"] / clean, 1, delta=share)

    def test_weld_0_leaves_the_gaps_and_a_length_closes_wider_ones(self):
        rough = parts.rounded_apart(parts.box(), 1e-6)
        report = self.texture(rough, "out.stl", "--weld", "0", warning="open edges, where there is no relief")
        self.assertFalse(report["closed"])
        self.assertGreater(report["open_edges"], 30)
        wide = parts.rounded_apart(parts.box(), 1e-3)
        self.assertFalse(self.texture(wide, "out.stl", warning="open edges")["closed"])
        self.check_closed(self.texture(wide, "out.stl", "--weld", "0.2mm", warning="are welded"))

    def test_cavities_belong_to_their_body_and_bodies_apart_are_objects(self):
        hollow = parts.hollow(parts.box(), parts.box((10, 10, 10), (7, 7, 7)))
        report = self.texture(parts.together(hollow, parts.rod(8, 8, 24, (50, 0, 0))), "out.3mf")
        self.check_closed(report, 2)
        self.assertGreater(report["bodies"][0]["volume"], 24**3 - 1000)
        self.assertEqual(report["objects"], ["part 1", "part 2"])
        written = read_surface("out.3mf")
        self.assertEqual(written.image.names, ["part 1", "part 2"])
        inside = (np.abs(written.points - 12) < 6).all(axis=1)
        self.assertGreater(inside.sum(), 100)  # the cavity is smaller by its relief
        self.assertLess(np.abs(written.points[inside] - 12).max(), 5 + 1e-9)

    def test_bodies_that_overlap_are_counted(self):
        report = self.texture(parts.together(parts.box(), parts.box(place=(12, 5, 3))), "out.stl",
                              warning="pairs of bodies that overlap: 1; slicers unite them")
        self.assertEqual((report["overlaps"], len(report["bodies"])), (1, 2))
        self.check_closed(report, 2)


class ThreeMf(CommandTest):
    def test_objects_units_names_and_transforms_are_read(self):
        item = '<item objectid="{}" transform="{}"/>'.format
        model = (f'<?xml version="1.0"?><model unit="inch" xmlns="{CORE}"><resources>'
                 f'<object id="1" name="a &amp; b">{mesh(parts.box((1, 1, 1)))}</object>'
                 f'<object id="2">{mesh(parts.box((1, 2, 3)))}</object>'
                 '<object id="3" name="both"><components><component objectid="1"/>'
                 '<component objectid="2" transform="2 0 0 0 1 0 0 0 1 5 0 0"/></components></object></resources><build>'
                 + item(1, "1 0 0 0 1 0 0 0 1 10 0 0") + item(3, "0 1 0 -1 0 0 0 0 1 0 0 7")
                 + item(1, "-1 0 0 0 1 0 0 0 1 0 0 0") + "</build></model>")
        surface = read_surface(archive(model))
        self.assertEqual((surface.kind, surface.image.unit, surface.image.names), ("3mf", "in", ["a & b", "both", "a & b"]))
        found = sd.bodies((surface.points, surface.faces))
        np.testing.assert_allclose([body.volume for body in found.table], [1, 1, 12, 1])
        self.assertEqual(np.bincount(surface.image.of_face).tolist(), [12, 24, 12])
        np.testing.assert_allclose(surface.points[:8].min(axis=0), [10, 0, 0])
        np.testing.assert_allclose(np.ptp(surface.points[16:24], axis=0), [2, 2, 3])
        np.testing.assert_allclose(surface.points[16:24].min(axis=0), [-2, 5, 7])

    def test_come_back_as_they_were_written(self):
        part = parts.together(parts.box(), parts.gear())
        of_face = np.repeat([0, 1], [12, len(part[1]) - 12])
        colors = np.random.default_rng(1).integers(0, 256, (len(part[1]), 3, 3), np.uint8)
        objects = Objects("cm", ["<a>", "b \"c\""], of_face, colors)
        export("a.3mf", *part, objects=objects)
        surface = read_surface("a.3mf")
        np.testing.assert_allclose(surface.points[surface.faces], part[0][part[1]], rtol=1e-8, atol=1e-8)
        self.assertEqual((surface.image.names, surface.image.unit), (objects.names, "cm"))
        np.testing.assert_array_equal(surface.image.of_face, of_face)
        np.testing.assert_array_equal(surface.image.colors, colors)
        surface.save("b.3mf", surface.points)
        self.assertEqual(Path("b.3mf").read_bytes(), Path("a.3mf").read_bytes())
        code, out, error = run("refine", "a.3mf", "4", "fine.3mf")
        self.assertEqual((code, error), (0, ""))
        fine = read_surface("fine.3mf").image
        self.assertEqual((fine.names, fine.unit), (objects.names, "cm"))

    def test_texture_keeps_objects_and_their_unit(self):
        model = (f'<model unit="inch" xmlns="{CORE}"><resources><object id="7" name="foot">{mesh(parts.box((1, 1, 1)))}'
                 '</object></resources><build><item objectid="7"/><item objectid="7" '
                 'transform="1 0 0 0 1 0 0 0 1 1 0 0"/></build></model>')
        report = self.texture(archive(model), "out.3mf", relief="0.3mm")  # they touch, and stay two
        self.assertEqual((report["unit"], report["objects"], len(report["bodies"])), ("in", ["foot 1", "foot 2"], 2))
        self.assertAlmostEqual(read_surface("out.3mf").points[:, 2].max(), 1 + 0.3 / 25.4, delta=1e-6)
        self.refused("--unit is mm, but the unit of made.3mf is in; allowed: in, or none", "made.3mf", "8mm", "o.stl",
                     "--relief", "0.3mm", "--unit", "mm")

    def test_without_relief_the_pattern_is_colour(self):
        self.texture(parts.box(), "out.3mf", relief="")
        colors = read_surface("out.3mf").image.colors
        self.assertEqual((colors.min(), colors.max()), (0, 255))

    def test_files_that_are_no_models_are_refused_in_one_line(self):
        cube = f'<object id="1">{mesh(parts.box())}</object>'
        nested = "".join(f'<object id="{i}"><components>' + f'<component objectid="{i - 1}"/>' * 20
                         + "</components></object>" for i in range(2, 9))
        head = f'<model xmlns="{CORE}"><resources>'
        for text, pattern in (
                ('<!DOCTYPE m [<!ENTITY a "b">]>' + head + cube + '</resources><build><item objectid="1"/></build></model>',
                 "document type declaration; allowed: none"),
                (head + cube + "</resources><build/></model>", "its build has no mesh"),
                (head + cube + '</resources><build><item objectid="9"/></build></model>', "there is no object '9'"),
                (head + cube + nested + '</resources><build><item objectid="8"/></build></model>', "too many others"),
                (head + '<object id="1"><components><component objectid="1"/></components></object></resources><build>'
                 '<item objectid="1"/></build></model>', "too many others"),
                (head + cube.replace('v1="0"', 'v1="8"') + '</resources><build><item objectid="1"/></build></model>',
                 "a face refers to point 8; allowed: 0 to 7"),
                (head + cube + '</resources><build><item objectid="1" transform="1 2"/></build></model>',
                 "a transform has 2 numbers; allowed: 12")):
            with self.subTest(pattern):
                code, _, error = run("info", archive(text))
                self.assertEqual(code, 2)
                self.assertRegex(error, f"^surfacediffusion: made.3mf: damaged 3MF file: .*{pattern}.*\n$")

    def test_models_in_several_parts_are_read(self):
        inner = f'<model xmlns="{CORE}"><resources><object id="1">{mesh(parts.box())}</object></resources></model>'
        outer = (f'<model xmlns="{CORE}" xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06">'
                 '<resources><object id="2" name="x"><components><component p:path="/3D/Objects/a.model" objectid="1"/>'
                 '</components></object></resources><build><item objectid="2"/></build></model>')
        points, faces, objects = read(Path(archive(outer, more=[("3D/Objects/a.model", inner)])).read_bytes())
        self.assertEqual((len(points), len(faces), objects.names), (8, 12, ["x"]))


class Choices(CommandTest):
    def test_keep_flat_below_a_height_has_a_border_of_the_given_width(self):
        self.texture(parts.box(), "out.ply", "--keep-flat", "below-z 6mm", "--border", "4mm", "--flank", "0mm")
        points = read_surface("out.ply").points
        out = np.maximum(np.maximum(-points, points - 24)[:, :2].max(axis=1), 0)
        low, high = points[:, 2] <= 6, points[:, 2] >= 10
        self.assertEqual(out[low].max(), 0)
        self.assertGreater(low.sum(), 100)
        self.assertAlmostEqual(out[high].max(), 0.4, delta=1e-9)
        x = (points[~low & ~high, 2] - 6) / 4
        self.assertLess((out[~low & ~high] - 0.4 * x * x * (3 - 2 * x)).max(), 1e-9)
        self.assertAlmostEqual(out[(points[:, 2] > 9) & ~high].max(), 0.4, delta=0.07)

    def test_keep_flat_by_angle_box_and_labels(self):
        export("part.ply", *parts.box())
        np.save("labels.npy", np.array([0.0, 1, 0, 1, 0, 1, 0, 1]))  # x = 24
        moved = {}
        for region in ("angle x 10", "box 23.9mm -1mm -1mm 25mm 25mm 25mm", "labels labels.npy", "angle -z 1"):
            self.texture("part.ply", "out.ply", "--keep-flat", region)
            moved[region] = read_surface("out.ply").points
            axis, side = (2, 0) if "-z" in region else (0, 24)
            self.assertEqual(np.abs(moved[region][:, axis] - side).min(), 0)
            beyond = moved[region][:, axis].max() if side else -moved[region][:, axis].min()
            self.assertAlmostEqual(beyond, side, delta=1e-9)
            self.assertAlmostEqual(-moved[region][:, 1].min(), 0.4, delta=1e-6)
        np.testing.assert_array_equal(moved["angle x 10"], moved["labels labels.npy"])
        self.refused("--keep-flat labels labels.npy has 8 rows; allowed: 9[0-9], .*or 1[0-9]+, one per face",
                     self.gear(), "8mm", "o.ply", "--relief", "0.4mm", "--keep-flat", "labels labels.npy")

    def gear(self):
        export("gear.ply", *parts.gear())
        return "gear.ply"

    def test_min_wall_says_where_the_part_is_thin(self):
        slab = parts.box((24, 24, 2))
        report = self.texture(slab, "out.stl", "--min-wall", "1.8mm", relief="-0.15mm",
                              warning="the wall is thinner than --min-wall 1.8 mm at [0-9]+ points, and 1.[0-9]+ mm at ")
        self.assertGreater(report["smallest_wall"], 1.7 - 1e-6)  # carved from both sides
        self.assertLess(report["smallest_wall"], 1.8)
        self.assertGreater(report["thin_points"], 0)
        self.assertTrue((np.abs(np.array(report["thinnest_at"]) - [12, 12, 1]) <= [12, 12, 1]).all())
        report = self.texture(slab, "out.stl", "--min-wall", "1.6mm", relief="-0.15mm")
        self.assertEqual(report["thin_points"], 0)

    def test_printer_gives_the_length_of_edges_and_says_what_the_file_has(self):
        export("part.stl", *parts.box((8, 8, 8)))
        code, out, error = run("texture", "part.stl", "4mm", "out.stl", "--relief", "0.2mm", "--printer", "0.4mm",
                               "--steps", "20")
        self.assertEqual((code, error), (0, ""))
        said = out.splitlines()[0]
        self.assertRegex(said, "^out.stl: [0-9]+ triangles with edges of at most 0.[34][0-9]* mm, about [0-9.]+ MB$")
        surface = read_surface("out.stl")
        self.assertIn(f": {len(surface.faces)} triangles", said)
        size = Path("out.stl").stat().st_size / 1e6
        self.assertAlmostEqual(float(said.split()[-2]) / size, 1, delta=0.02)
        self.refused("--printer is 0.01 mm, for which .* needs more than 4000000 triangles; allowed: 0.0[0-9]+ mm or "
                     "more, or --maximum-triangles [0-9]+", "part.stl", "4mm", "o.stl", "--relief", "0.2mm", "--printer",
                     "0.01mm")

    def test_two_colour_is_refused_where_it_has_no_meaning(self):
        export("part.stl", *parts.box())
        for more, pattern in ((["o.stl", "--relief", "0.4mm"], "o.stl: --two-colour makes two materials, .*allowed: .3mf"),
                              (["o.3mf", "--relief=-0.4mm"], "--two-colour raises .*; allowed: --relief above 0"),
                              (["o.3mf"], "--two-colour without --relief; allowed: both")):
            self.refused(pattern, "part.stl", "8mm", *more, "--two-colour")
        for text in ("below-z", "below-z 6furlongs", "angle w 30", "angle z 181", "box 1 2 3", "sideways 3"):
            self.refused("argument --keep-flat: is '.*'; allowed: \"below-z HEIGHT\", ", "part.stl", "8mm", "o.stl", "--relief",
                         "0.4mm", "--keep-flat", text)
        self.refused("--border is that of --keep-flat, which is not given; allowed: both", "part.stl", "8mm", "o.stl",
                     "--relief", "0.4mm", "--border", "4mm")


if __name__ == "__main__":
    unittest.main()
