# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""weld() and bodies() on parts as users bring them, and relief on several bodies."""

import unittest
import warnings

import numpy as np

import parts_to_print as parts
import surfacediffusion as sd

CLEAN = {"box": parts.box(), "rod": parts.rod(), "gear": parts.gear(), "ball": parts.ball(), "tube": parts.tube()}


def defects(surface):
    found = sd.bodies(surface)
    return found.open_edges, found.non_manifold_edges, found.misoriented_edges


class Weld(unittest.TestCase):
    def test_corners_that_are_rounded_apart_are_joined(self):
        for name, part in CLEAN.items():
            for scale in (1e-3, 1, 1e4):
                with self.subTest(name, scale=scale):
                    rough = parts.rounded_apart((scale * part[0], part[1]))
                    found = sd.weld(rough)
                    self.assertEqual(defects(found.surface), (0, 0, 0))
                    self.assertEqual(found.surface.n_points, len(part[0]))
                    self.assertEqual((found.split, found.duplicates, found.flat), (0, 0, 0))
                    self.assertEqual(found.welded, 3 * len(part[1]) - len(part[0]))
                    size = scale * np.linalg.norm(np.ptp(part[0], axis=0))
                    self.assertLess(found.apart, 4e-6 * size)
                    away = [np.linalg.norm(scale * part[0] - place, axis=1).min() for place in found.surface.points]
                    self.assertLess(max(away), 2e-6 * size)
                    self.assertAlmostEqual(parts.volume(found.surface.points, found.surface.triangles)
                                           / parts.volume(*part) / scale**3, 1, delta=1e-5)
                    unwelded = sd.weld(rough, 0)
                    self.assertEqual(sd.bodies(unwelded.surface).open_edges, 3 * len(part[1]))

    def test_t_junctions_are_split(self):
        for name, part in CLEAN.items():
            for given in (parts.with_t_junctions(part), parts.soup(parts.with_t_junctions(part)),
                          parts.rounded_apart(parts.with_t_junctions(part), 1e-7)):
                with self.subTest(name, points=len(given[0])):
                    self.assertNotEqual(sd.bodies(sd.weld(given, 0).surface).open_edges, 0)
                    found = sd.weld(given)
                    self.assertEqual(found.split, 5)
                    self.assertEqual(defects(found.surface), (0, 0, 0))
                    self.assertEqual(found.surface.n_faces, len(part[1]) + 10)
                    self.assertAlmostEqual(parts.volume(found.surface.points, found.surface.triangles),
                                           parts.volume(*part), delta=1e-5 * parts.volume(*part))
                    np.testing.assert_array_equal(found.faces[:len(part[1])] < len(part[1]) + 5, True)

    def test_repeated_facets_count_once_whatever_their_orientation(self):
        for name, part in CLEAN.items():
            for opposite in (False, True):
                for given in (parts.with_repeats(part, opposite=opposite),
                              parts.soup(parts.with_repeats(part, opposite=opposite))):
                    with self.subTest(name, opposite=opposite, points=len(given[0])):
                        found = sd.weld(given)
                        self.assertEqual(found.duplicates, 7)
                        self.assertEqual(defects(found.surface), (0, 0, 0))
                        clean = sd.weld(part)
                        np.testing.assert_array_equal(found.surface.points, clean.surface.points)
                        np.testing.assert_array_equal(found.surface.triangles, clean.surface.triangles)
            twice = (part[0], np.vstack([part[1], part[1][:, ::-1]]))
            self.assertEqual(defects(sd.weld(twice).surface), (0, 0, 0))

    def test_an_inner_wall_of_two_facets_vanishes(self):
        found = sd.weld(parts.stacked())
        self.assertEqual((found.duplicates, defects(found.surface)), (4, (0, 0, 0)))
        self.assertEqual(len(sd.bodies(found.surface).table), 1)
        self.assertAlmostEqual(sd.bodies(found.surface).table[0].volume, 24.0**3, places=8)

    def test_facets_of_no_area_are_left_out_and_their_edges_split(self):
        for name, part in CLEAN.items():
            with self.subTest(name):
                given = parts.with_flat_facets(part)
                self.assertEqual(defects(given), (0, 0, 0))
                found = sd.weld(given)
                self.assertEqual((found.flat, found.split), (4, 4))
                self.assertEqual(defects(found.surface), (0, 0, 0))
                corners = found.surface.points[found.surface.triangles]
                normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
                self.assertGreater(np.linalg.norm(normals, axis=1).min(), 1e-3)
                self.assertEqual(sd.weld(given, 0).flat, 0)

    def test_open_surfaces_and_slits_that_are_wide_stay(self):
        points, faces = parts.box()
        found = sd.weld((points, faces[:10]))
        self.assertEqual((found.welded, found.split, sd.bodies(found.surface).open_edges), (0, 0, 4))
        slit = parts.together((points, faces[:6]), (points + [0, 0, 0.01], faces[6:]))
        self.assertGreater(sd.bodies(sd.weld(slit).surface).open_edges, 0)
        self.assertEqual(sd.bodies(sd.weld(slit, 0.02).surface).open_edges, 0)

    def test_the_numbering_of_points_and_the_place_do_not_matter(self):
        part = parts.with_repeats(parts.with_t_junctions(parts.gear()))
        first, other = sd.weld(part), sd.weld(parts.renumbered(part))
        np.testing.assert_array_equal(first.surface.points, other.surface.points)
        moved = sd.weld((part[0] + 2.0**20, part[1]))
        self.assertEqual((moved.split, defects(moved.surface)), (first.split, (0, 0, 0)))

    def test_quadrilaterals_are_cut_first_and_faces_are_theirs(self):
        square = sd.Surface([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
        found = sd.weld(square)
        self.assertEqual((found.surface.n_faces, found.faces.tolist()), (2, [0, 0]))

    def test_bad_input_is_one_line(self):
        for call, pattern in ((lambda: sd.weld(parts.box(), -1), "tolerance is -1; allowed: finite numbers of at least 0"),
                              (lambda: sd.weld(parts.box(), np.nan), "tolerance is nan; allowed: finite numbers"),
                              (lambda: sd.weld(([[0, 0, 0]] * 3, [[0, 1, 2]])), "1 faces, of which none has an area")):
            with self.assertRaisesRegex(ValueError, pattern):
                call()


class Bodies(unittest.TestCase):
    def test_volumes_areas_and_cavities(self):
        found = sd.bodies(parts.together(parts.box(), parts.inside_out(parts.box((10, 10, 10), (5, 5, 5))),
                                         parts.box((2, 2, 2), (6, 6, 6)), parts.box((3, 3, 3), (40, 0, 0))))
        self.assertEqual([(body.triangles, body.closed) for body in found.table], [(24, True), (12, True), (12, True)])
        np.testing.assert_allclose([body.volume for body in found.table], [24**3 - 1000, 8, 27], rtol=1e-12)
        np.testing.assert_allclose([body.area for body in found.table], [6 * 24**2 + 600, 24, 54], rtol=1e-12)
        self.assertEqual(found.overlaps, 0)
        self.assertFalse(found.inside.any())
        self.assertEqual(np.bincount(found.of_triangle).tolist(), [24, 12, 12])

    def test_bodies_that_overlap_are_counted_and_those_that_touch_are_not(self):
        for part, overlaps in ((parts.together(parts.box(), parts.box(place=(12, 5, 3))), 1),
                               (parts.together(parts.box(), parts.box((4, 4, 4), (3, 3, 3))), 1),
                               (parts.together(parts.box((30, 2, 2), (-15, 0, 0)), parts.box((2, 30, 2), (0, -15, 0.5)),
                                               parts.box((2, 2, 30), (0.5, 0.5, -15))), 3),
                               (parts.stacked(), 0), (parts.together(parts.box(), parts.box(place=(24, 24, 0))), 0),
                               (parts.together(parts.box(), parts.box((4, 4, 4), (24, 3, 3))), 0),
                               (parts.together(parts.ball(10), parts.ball(10, (20, 0, 0))), 0),
                               (parts.together(parts.ball(10), parts.ball(10, (19, 0, 0))), 1)):
            with self.subTest(len(part[0])):
                for scale, place in ((1, 0), (1e-3, 1), (1e3, -1e5)):
                    self.assertEqual(sd.bodies((scale * part[0] + place, part[1])).overlaps, overlaps)

    def test_closed_manifold_and_oriented_are_three_things(self):
        points, faces = parts.box()
        turned = np.vstack([faces[:1, ::-1], faces[1:]])
        self.assertEqual(defects((points, turned)), (0, 0, 3))
        self.assertEqual(defects((points, faces[1:])), (3, 0, 0))
        self.assertEqual(defects((points, np.vstack([faces, faces]))), (0, 18, 0))
        fin = np.vstack([points, [[30, 30, 30]]]), np.vstack([faces, [[5, 7, 8]]])
        self.assertEqual(defects(fin), (2, 1, 1))


class ReliefOnBodies(unittest.TestCase):
    def relief(self, part, height, length=2.0):
        fine = sd.refine(part, length).surface
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            result = sd.relief(fine, np.ones(fine.n_points), height)
        return fine, result, " ".join(str(one.message) for one in said)

    def test_goes_outwards_of_the_solid_on_shells_and_cavities(self):
        inner = parts.box((10, 10, 10), (7, 7, 7))
        for part in (parts.hollow(parts.box(), inner), parts.inside_out(parts.hollow(parts.box(), inner))):
            _, result, said = self.relief(part, 0.25)
            self.assertEqual(said, "")
            (body,) = sd.bodies(result.surface).table
            self.assertAlmostEqual(body.volume, 24.5**3 - 9.5**3, places=6)
            self.assertAlmostEqual(result.volume_change, 24.5**3 - 9.5**3 - 24**3 + 10**3, places=6)

    def test_bodies_apart_all_grow_whatever_their_orientation(self):
        for turn in (lambda part: part, parts.inside_out):
            _, result, said = self.relief(parts.together(parts.box(), turn(parts.box(place=(40, 0, 0)))), 0.25)
            self.assertEqual(said, "")
            np.testing.assert_allclose([body.volume for body in sd.bodies(result.surface).table], [24.5**3] * 2)

    def test_is_left_out_inside_another_body(self):
        fine, result, said = self.relief(parts.together(parts.box(), parts.box((10, 10, 10), (19, 7, 7))), 0.25, 1.0)
        self.assertIn("pairs of bodies that overlap: 1; slicers unite them", said)
        inside = sd.bodies(fine).inside
        x = fine.points
        np.testing.assert_array_equal(inside, ((x > 1e-3) & (x < 24 - 1e-3)).all(axis=1)
                                      | ((x > [19.001, 7.001, 7.001]) & (x < [28.999, 16.999, 16.999])).all(axis=1))
        self.assertGreater(inside.sum(), 100)
        self.assertEqual(np.abs(result.heights[inside]).max(), 0)
        self.assertEqual(result.heights[x[:, 0] == 29].min(), 0.25)


if __name__ == "__main__":
    unittest.main()
