# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Refinement, relief, and textures on parts of few triangles."""

import unittest
import warnings

import numpy as np

import surfacediffusion as sd

SIDES = np.array([40.0, 30.0, 20.0])


def box(sides=SIDES):
    """12 triangles, oriented outwards."""
    points = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) * sides
    squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return sd.Surface(points, [t for a, b, c, d in squares for t in ((a, b, c), (a, c, d))])


def area(surface):
    return surface._triangle_areas().sum()


def volume(surface):
    a, b, c = (surface.points[surface.triangles[:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def count_open_edges(surface):
    t = surface.triangles
    edges = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    return int((np.unique(edges, axis=0, return_counts=True)[1] != 2).sum())


def wavelength(surface, values, chosen):
    """Of the wave with the same gradients, in the mean square over these triangles."""
    t = surface.triangles[chosen]
    a, b, c = (surface.points[t[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    doubled = np.linalg.norm(normal, axis=1)
    u = (values - values.mean())[t]
    gradient = (u[:, [0]] * (c - b) + u[:, [1]] * (a - c) + u[:, [2]] * (b - a)) / doubled[:, None]
    squares = (u**2).sum(axis=1) / 12 + u.sum(axis=1) ** 2 / 12
    return 2 * np.pi * np.sqrt((squares @ doubled) / ((gradient**2).sum(axis=1) @ doubled))


class Refine(unittest.TestCase):
    def test_a_box_keeps_its_shape(self):
        fine = sd.refine(box(), 2.0)
        self.assertLessEqual(fine.longest_edge, 2.0)
        self.assertFalse(fine.limit_reached)
        self.assertAlmostEqual(area(fine.surface) / 5200, 1, delta=1e-13)
        self.assertAlmostEqual(volume(fine.surface) / 24000, 1, delta=1e-13)
        self.assertEqual(count_open_edges(fine.surface), 0)
        on_side = np.isclose(fine.surface.points, 0) | np.isclose(fine.surface.points, SIDES)
        self.assertTrue(on_side.any(axis=1).all())

    def test_data_are_interpolated_and_inherited(self):
        part = box()
        fine = sd.refine(part, 1.5)
        np.testing.assert_array_equal(fine.at_points(part.points), fine.surface.points)
        np.testing.assert_array_equal(fine.at_points(part.points[:, 0]), fine.surface.points[:, 0])
        self.assertEqual(fine.at_points(np.ones(8, dtype=np.float32)).dtype, np.float32)
        normals = fine.at_faces(part._face_normals()[0])
        np.testing.assert_allclose(normals, fine.surface._face_normals()[0], atol=1e-12)

    def test_polygons_have_one_number_each(self):
        square = sd.Surface([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]],
                            [[0, 1, 2, 3], [1, 4, 2]])
        fine = sd.refine(square, 0.2)
        areas = np.bincount(fine.faces, np.linalg.norm(np.cross(
            *(fine.surface.points[fine.surface.triangles[:, i]]
              - fine.surface.points[fine.surface.triangles[:, 0]] for i in (1, 2))), axis=1) / 2)
        np.testing.assert_allclose(areas, [1, 0.5])

    def test_the_limit_is_said(self):
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning,
                                   "stopped at [0-9]+ triangles with edges of up to .*longer than 0.01"):
            fine = sd.refine(box(), 0.01, maximum_triangles=1000)
        self.assertTrue(fine.limit_reached)
        self.assertLessEqual(fine.surface.n_faces, 1000)

    def test_bad_input_is_one_line(self):
        fine = sd.refine(box(), 9.0)
        for call, pattern in (
                (lambda: sd.refine(box(), 0), "length is 0; allowed: finite numbers above 0"),
                (lambda: sd.refine(box(), "a"), "length is 'a'; allowed: .*"),
                (lambda: sd.refine(box(), np.nan), "length is nan; allowed: .*"),
                (lambda: sd.refine(box(), 1, maximum_triangles=0), "maximum_triangles is 0; allowed: .*"),
                (lambda: sd.refine(5, 1), "surface is 5; allowed: .*"),
                (lambda: fine.at_points(np.ones(3)), r"values has shape \(3,\); allowed: \(8,\).*"),
                (lambda: fine.at_faces(np.ones(3)), r"values has shape \(3,\); allowed: .*")):
            with self.subTest(pattern), self.assertRaisesRegex(ValueError, f"^{pattern}$"):
                call()

    def test_progress_can_end_it(self):
        class Enough(Exception):
            pass

        def stop(fraction):
            raise Enough

        with self.assertRaises(Enough):
            sd.refine(box(), 0.05, progress=stop)


class Texture(unittest.TestCase):
    def test_a_box_of_12_triangles_gets_one_pattern_across_its_edges(self):
        result = sd.turing_texture(box(2 * SIDES), feature_size=5.0, refine_to="Automatic",
                                   diffusion_rate1=2.6 * 18, number_of_time_steps=300)
        surface = result.surface
        self.assertEqual(result.texture.shape, (surface.n_points,))
        self.assertAlmostEqual(result.wavelength, 5.0, delta=0.05)
        centers = surface.points[surface.triangles].mean(axis=1)
        away = np.sort(np.minimum(centers, 2 * SIDES - centers), axis=1)[:, 1]
        u1 = result.values[:, 0].astype(float)
        faces = wavelength(surface, u1, away > 5.0)
        edges = wavelength(surface, u1, away < 2.5)
        self.assertAlmostEqual(edges / faces, 1, delta=0.05)

    def test_arrays_of_the_given_surface_are_refused(self):
        with self.assertRaisesRegex(ValueError, "^mask and refine_to are both given; allowed: .*$"):
            sd.turing_texture(box(), refine_to=3.0, mask=np.zeros(8))
        with self.assertRaisesRegex(ValueError, "^feature_size is 0.0; allowed: .*$"):
            sd.turing_texture(box(), refine_to="Automatic")
        with self.assertRaisesRegex(ValueError, "^refine_to is 'fine'; allowed: .*$"):
            sd.turing_texture(box(), refine_to="fine")


class Relief(unittest.TestCase):
    def test_of_constant_height_on_a_box_is_a_box(self):
        fine = sd.refine(box(), 2.0).surface
        result = sd.relief(fine, np.ones(fine.n_points), 0.3, base=0.1)
        expected = np.prod(SIDES + 2 * 0.4)
        self.assertAlmostEqual(volume(result.surface) / expected, 1, delta=1e-12)
        self.assertAlmostEqual(result.volume_change / (expected - 24000), 1, delta=1e-9)
        self.assertAlmostEqual(result.smallest_wall, 20.8, delta=1e-9)
        self.assertEqual((result.open_edges, result.crossing_triangles, result.lowered_points),
                         (0, 0, 0))
        self.assertEqual(result.warnings, [])

    def test_masks_keep_points_where_they_are(self):
        fine = sd.refine(box(), 2.0).surface
        ones = np.ones(fine.n_points)
        bottom = fine.points[:, 2] == 0
        below = fine.points[fine.triangles].max(axis=1)[:, 2] == 0
        for options in ({"mask": bottom}, {"mask": below}, {"overhang": 45.0}):
            points = sd.relief(fine, ones, 0.3, **options).surface.points
            np.testing.assert_array_equal(points[bottom], fine.points[bottom], str(options))
            self.assertAlmostEqual(points[:, 2].max(), 20.3, delta=1e-12)
        up = sd.relief(fine, ones, 0.3, overhang=0, up=(0, 0, -1)).surface.points
        self.assertAlmostEqual(up[:, 2].max(), 20.0, delta=1e-12)
        self.assertAlmostEqual(up[:, 2].min(), -0.3, delta=1e-12)

    def test_two_levels_have_two_heights(self):
        fine = sd.refine(box(), 1.0).surface
        values = 0.5 + 0.5 * np.sin(fine.points[:, 0]) * np.cos(fine.points[:, 1])
        heights = sd.relief(fine, values, 0.2, base=-0.1, levels="Two").heights
        inner = np.sort(np.minimum(fine.points, SIDES - fine.points), axis=1)[:, 1] > 0.5
        np.testing.assert_allclose(np.unique(np.abs(heights[inner & (values != 0.5)]).round(12)), 0.1)
        sloped = sd.relief(fine, values, 0.2, base=-0.1, levels="two", flank=0.8).heights
        self.assertGreater((np.abs(sloped[inner]) < 0.09).sum(), 100)

    def test_defects_are_counted_in_one_line_and_the_relief_is_made(self):
        part = box()
        opened = sd.refine((part.points, part.triangles[2:]), 2.0).surface
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "the surface has [0-9]+ open edges"):
            result = sd.relief(opened, np.ones(opened.n_points), 0.1)
        self.assertEqual(result.open_edges, count_open_edges(opened))
        self.assertGreater(result.heights.max(), 0.09)
        two = sd.refine((np.vstack([part.points, part.points + [25.3, 13.7, 9.1]]),
                         np.vstack([part.triangles, part.triangles + 8])), 2.0).surface
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning,
                                   "the surface crosses itself at [0-9]+ triangles"):
            result = sd.relief(two, np.ones(two.n_points), 0.1)
        self.assertGreater(result.crossing_triangles_before, 0)
        self.assertGreater(result.volume_change, 0)

    def test_above_the_wall_it_is_lowered_and_said(self):
        plate = sd.refine(box((20.0, 20.0, 1.0)), 1.0).surface
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "lowered by more than half"):
            result = sd.relief(plate, np.ones(plate.n_points), -0.9)
        self.assertEqual(result.crossing_triangles, 0)
        self.assertAlmostEqual(result.smallest_wall, 0.5, delta=1e-6)

    def test_has_the_same_bits_again(self):
        fine = sd.refine(box(), 2.0).surface
        values = np.random.default_rng(0).random(fine.n_points)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            first, second = (sd.relief(fine, values, 3.0).surface.points for _ in range(2))
        np.testing.assert_array_equal(first, second)

    def test_bad_input_is_one_line(self):
        ones = np.ones(8)
        for call, pattern in (
                (lambda: sd.relief(box(), np.ones(5), 1), r"values has shape \(5,\); allowed: .*"),
                (lambda: sd.relief(box(), ones * np.nan, 1), "values is nan at point 0; allowed: .*"),
                (lambda: sd.relief(box(), ones, np.inf), "height is inf; allowed: finite numbers"),
                (lambda: sd.relief(box(), ones * 1e10, 1e300), "height is 1e[+]300, which .*; allowed: .*"),
                (lambda: sd.relief(box(), ones, 1, levels="Three"), "levels is 'Three'; allowed: .*"),
                (lambda: sd.relief(box(), ones, 1, flank=-1), "flank is -1; allowed: .*"),
                (lambda: sd.relief(box(), ones, 1, mask=np.ones(3)), r"mask has shape \(3,\); .*"),
                (lambda: sd.relief(box(), ones, 1, overhang=100), "overhang is 100; allowed: .*"),
                (lambda: sd.relief(box(), ones, 1, overhang=1, up=(0, 0, 0)), r"up is \(0, 0, 0\); .*")):
            with self.subTest(pattern), self.assertRaisesRegex(ValueError, f"^{pattern}$"):
                call()


if __name__ == "__main__":
    unittest.main()
