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
        normals = fine.at_faces(part._face_normals())
        np.testing.assert_allclose(normals, fine.surface._face_normals(), atol=1e-12)

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
                                   "stopped at edges of [0-9.]+, longer than 0.01, because "
                                   "maximum_number_of_triangles is 1000"):
            fine = sd.refine(box(), 0.01, maximum_number_of_triangles=1000)
        self.assertTrue(fine.limit_reached)
        self.assertLessEqual(fine.surface.n_faces, 1000)

    def test_bad_input_is_one_line(self):
        fine = sd.refine(box(), 9.0)
        for call, pattern in (
                (lambda: sd.refine(box(), 0), "length is 0; allowed: finite numbers above 0"),
                (lambda: sd.refine(box(), "a"), "length is 'a'; allowed: .*"),
                (lambda: sd.refine(box(), np.nan), "length is nan; allowed: .*"),
                (lambda: sd.refine(box(), 1, maximum_number_of_triangles=0),
                 "maximum_number_of_triangles is 0; allowed: .*"),
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
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "edges were bisected, to [0-9]+ triangles, "
                                   "because feature_size is 5, only [0-9.]+ mean edge lengths"):
            result = sd.turing_texture(box(2 * SIDES), feature_size=5.0, diffusion_rate1=2.6 * 18,
                                       number_of_time_steps=300)
        surface = result.surface
        self.assertEqual(result.texture.shape, (surface.n_points,))
        self.assertAlmostEqual(result.wavelength, 5.0, delta=0.05)
        centers = surface.points[surface.triangles].mean(axis=1)
        away = np.sort(np.minimum(centers, 2 * SIDES - centers), axis=1)[:, 1]
        u1 = result.values[:, 0].astype(float)
        faces = wavelength(surface, u1, away > 5.0)
        edges = wavelength(surface, u1, away < 2.5)
        self.assertAlmostEqual(edges / faces, 1, delta=0.05)

    def test_needles_do_not_change_the_wavelength_of_a_coarse_start(self):
        angle = np.pi * np.arange(60) / 30
        ring = 15 * np.column_stack([np.cos(angle), np.sin(angle), np.zeros(60)])
        i, k = np.arange(60), np.arange(1, 59)
        j, first = (i + 1) % 60, np.zeros(58, dtype=int)
        faces = np.vstack([np.stack([i, j, 60 + j], axis=1), np.stack([i, 60 + j, 60 + i], axis=1),
                           np.stack([first, k + 1, k], axis=1), np.stack([first + 60, 60 + k, 61 + k], axis=1)])
        rod = sd.refine((np.vstack([ring, ring + [0, 0, 20]]), faces), 0.6).surface
        found = [wavelength(rod, sd.turing_texture(
            rod, feature_size=4.0, diffusion_rate1=2.6 * 18, refine_to=0, coarse_start_size=size, stop_tolerance=0.02,
            number_of_time_steps=600).values[:, 0], slice(None)) for size in (1, 0)]
        for length in found:
            self.assertAlmostEqual(4.0 / length, 1, delta=0.1)
        self.assertAlmostEqual(found[0] / found[1], 1, delta=0.05)

    def test_fine_surfaces_and_0_keep_the_edges(self):
        ball = sd.sphere(3)
        for options in ({"feature_size": 2.0}, {"feature_size": 0.3, "refine_to": 0}, {}):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                result = sd.turing_texture(ball, number_of_time_steps=2, **options)
            self.assertIs(result.surface, ball, options)

    def test_features_larger_than_the_part_are_said(self):
        part = box()  # 53.85 from corner to corner
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "feature_size is 60, but the surface is 53.85"
                                   ".* from corner to corner: it has no room for a pattern"):
            sd.turing_texture(part, feature_size=60.0, refine_to=8.0, number_of_time_steps=2)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            sd.turing_texture(part, feature_size=50.0, refine_to=8.0, number_of_time_steps=2)

    def test_bad_lengths_are_one_line(self):
        for options, pattern in (
                ({"refine_to": "fine"}, "refine_to is 'fine'; allowed: .*"),
                ({"refine_to": -2}, "refine_to is -2; allowed: finite numbers of at least 0"),
                ({"refine_to": 3.0, "mask": np.zeros(9)}, r"mask has shape \(9,\); allowed: one row per "
                 "point, of which there are 8, or per face, 12"),
                ({"feature_size": "5"}, "feature_size is '5'; allowed: .*")):
            with self.subTest(pattern), self.assertRaisesRegex(ValueError, f"^{pattern}$"):
                sd.turing_texture(box(), **options)


class RefineTo(unittest.TestCase):
    """refine_to of a function is refine() before it, and data go along."""

    def setUp(self):
        self.ball = sd.sphere(1)
        self.fine = sd.refine(self.ball, 0.25)
        self.z = self.ball.points[:, 2]

    def check(self, function, **arrays):
        """arrays: of the points or faces of the ball."""
        options = {name: arrays.pop(name) for name in list(arrays) if np.ndim(arrays[name]) == 0}
        carried = {name: (self.fine.at_faces if len(array) == self.ball.n_faces
                          else self.fine.at_points)(array) for name, array in arrays.items()}
        if len(arrays.get("mask", ())) == self.ball.n_points:  # between a masked point and another one: masked
            carried["mask"] = ~self.fine.at_points(arrays["mask"] == 0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = function(self.ball, refine_to=0.25, **arrays, **options)
            expected = function(self.fine.surface, **carried, **options)
        if isinstance(expected, sd.ReliefResult):
            found, expected = found.heights, expected.heights
        found, expected = np.asarray(found), np.asarray(expected)
        np.testing.assert_array_equal(found, expected)
        self.assertIn(len(found), (self.fine.surface.n_points, self.fine.surface.n_faces))

    def test_holds_for_every_function(self):
        z, up = self.z, np.tile([0.0, 0.0, 1.0], (80, 1))
        mask, faces = (z > 0.9).astype(int), np.arange(80.0)
        steps = {"number_of_time_steps": 2}
        cases = {
            "heat": dict(values=z, fwhm=0.5, mask=mask, directions=up, fixed=z < -0.8),
            "intrinsic_tv": dict(values=faces, fidelity_weight=3, **steps),
            "tensor_diffusion": dict(values=z, **steps), "mumford_shah": dict(values=z, edge_threshold=0.3, **steps),
            "harmonic_map": dict(vectors=self.ball.points, **steps),
            "turing_texture": dict(initial=np.column_stack([4 + z, 4 - z]), **steps),
            "segment": dict(values=z), "curvature": dict(mask=mask), "direction_field": {"method": "Smooth"},
            "derivatives": dict(values=z, quantity="Laplacian"),
            "denoise_mesh": {}}
        self.assertEqual({*cases, "interpolate"}, set(sd._functions.__all__))
        others = {"gradient": dict(values=z), "relief": dict(values=z, height=0.1),
                  "distance": dict(sources=3, mask=mask, speed=1 + faces)}
        for name, arrays in {**cases, **others}.items():
            with self.subTest(name):
                self.check(getattr(sd, name), **arrays)

    def test_regions_of_interest_reach_to_the_points_that_a_mask_leaves(self):
        z = self.z
        found = sd.heat(self.ball, z, fwhm=0.5, roi=z > 0, refine_to=0.25)
        same = sd.heat(self.ball, z, fwhm=0.5, mask=(z <= 0).astype(int), mask_mode="Exclude", refine_to=0.25)
        np.testing.assert_array_equal(found, same)

    def test_masked_values_reach_no_point_beside_them(self):
        ball = sd.sphere(2)
        mask = ball.points[:, 2] > 0.8
        values = np.where(mask, 1e6, ball.points[:, 0])
        fine = sd.refine(ball, 0.1)
        for mode in ("Inpaint", "Exclude"):
            found = sd.heat(ball, values, mask=mask.astype(int), mask_mode=mode, fwhm=0.3, refine_to=0.1)
            outside = fine.at_points(~mask)
            self.assertLess(np.abs(found[outside]).max(), 1.0)

    def test_values_at_other_places_stay(self):
        places = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]])
        found = sd.interpolate(self.ball, [1.0, 2.0, 3.0, 4.0], places, refine_to=0.25, exact=True)
        expected = sd.interpolate(self.fine.surface, [1.0, 2.0, 3.0, 4.0], places, exact=True)
        np.testing.assert_array_equal(found.values, expected.values)

    def test_labels_and_colours_keep_their_type(self):
        labels = self.fine.at_points(np.arange(42))
        self.assertEqual(labels.dtype.kind, "i")
        np.testing.assert_array_equal(labels[42:], labels[self.fine.parents].min(axis=1))
        colours = np.random.default_rng(0).integers(0, 256, (42, 3), dtype=np.uint8)
        found = self.fine.at_points(colours)
        self.assertEqual(found.dtype, np.uint8)
        np.testing.assert_array_equal(
            found[42:], (found[self.fine.parents].astype(int).sum(axis=1) + 1) // 2)

    def test_is_refused_with_areas(self):
        surface = sd.Surface(self.ball.points, self.ball.triangles, areas=np.ones(42))
        with self.assertRaisesRegex(ValueError, "^length is 0.25, but areas are given .*; allowed: .*$"):
            sd.refine(surface, 0.25)
        with self.assertRaisesRegex(ValueError, "^refine_to is 0.25, but areas are given .*; allowed: .*$"):
            sd.heat(surface, self.z, fwhm=0.5, refine_to=0.25)


class Relief(unittest.TestCase):
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

    def test_points_of_no_face_have_no_height(self):
        fine = sd.refine(box(), 4.0).surface
        surface = sd.Surface(np.vstack([fine.points, [[0, 0, 50.0]]]), fine.triangles)
        result = sd.relief(surface, np.ones(surface.n_points), 0.3, base=0.1)
        self.assertEqual((result.heights[-1], result.lowered_points), (0, 0))
        np.testing.assert_array_equal(result.surface.points[-1], [0, 0, 50])

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
                (lambda: sd.relief(box(), ones, 1, overhang=1, up=(0, 0, 0)), "up is 0; allowed: three .*"),
                (lambda: sd.relief(box(), ones, 1, up=(0, 1)), "up has 2 components; allowed: three .*"),
                (lambda: sd.relief(box(), np.ones((8, 2)), 1), "values has 2 components; allowed: 1")):
            with self.subTest(pattern), self.assertRaisesRegex(ValueError, f"^{pattern}$"):
                call()


if __name__ == "__main__":
    unittest.main()
