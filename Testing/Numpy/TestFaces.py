# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Values, masks and the like of faces."""

import unittest

import numpy as np
from surfacediffusion import Surface, heat, intrinsic_tv, sphere


def quad_torus(n=24, m=16):
    """As many points as faces."""
    p, q = np.meshgrid(2 * np.pi * np.arange(n) / n, 2 * np.pi * np.arange(m) / m, indexing="ij")
    r = 2 + np.cos(q)
    points = np.stack([r * np.cos(p), r * np.sin(p), np.sin(q)], axis=-1).reshape(-1, 3)
    number = np.arange(n * m).reshape(n, m)
    east, north = np.roll(number, -1, 0), np.roll(number, -1, 1)
    both = np.roll(east, -1, 1)
    return Surface(points, np.stack([number, east, both, north], axis=-1).reshape(-1, 4))


class TestFaces(unittest.TestCase):
    def setUp(self):
        self.surface = sphere(4)
        self.noise = np.random.default_rng(0).normal(size=self.surface.n_faces)

    def test_numbers_of_points_before_those_of_each_face_are_asked_about(self):
        points = np.random.default_rng(1).normal(size=(20, 3))
        for count in (3, 4):
            padded = np.column_stack([np.full(5, count), np.arange(5 * count).reshape(5, count)])
            message = rf"^faces has shape \(5, {count + 1}\) and {count} in the whole first column; .*list\("
            with self.assertRaisesRegex(ValueError, message):
                Surface(points, padded)
            self.assertEqual(Surface(points, padded[:, 1:]).n_faces, 5)
            self.assertEqual(len(Surface(points, list(padded)).faces[0]), count + 1)

    def test_area_and_normals(self):
        ball = sphere(5, radius=2.0)
        self.assertAlmostEqual(ball.area, 16 * np.pi, delta=0.1)
        np.testing.assert_allclose(ball.normals, ball.points / 2, atol=5e-3)
        areas = np.full(ball.n_points, 0.5)
        self.assertEqual(Surface(ball.points, ball.faces, areas).area, ball.n_points / 2)

    def test_many_columns_are_those_of_single_runs(self):
        many = np.random.default_rng(1).normal(size=(self.surface.n_faces, 40))
        for on_faces in (True, False):
            # With larger tolerances "Automatic" may solve one column by another method.
            options = {"result_on_faces": on_faces, "time_step": 1, "tolerance": 1e-10}
            np.testing.assert_array_equal(heat(self.surface, many, **options)[:, 35],
                                          heat(self.surface, many[:, 35], **options))

    def test_equal_numbers_mean_points_unless_the_keyword_says_otherwise(self):
        torus = quad_torus()
        self.assertEqual(torus.n_points, torus.n_faces)
        values = np.random.default_rng(2).normal(size=torus.n_points)
        of_points = heat(torus, values, number_of_time_steps=1, time_step=1)
        of_faces = heat(torus, values, number_of_time_steps=1, on_faces=True, time_step=1)
        np.testing.assert_array_equal(
            of_points, heat(torus, values, number_of_time_steps=1, on_faces=False, time_step=1))
        self.assertGreater(np.abs(of_points - of_faces).max(), 0.1)
        mask = np.zeros(torus.n_points, bool)
        mask[[100, 101, 116, 117]] = True
        damaged = np.where(mask, 1e6, values)
        filled = heat(torus, damaged, mask=mask, on_faces=True, mode="SteadyState",
                      hold_known_values=True)
        np.testing.assert_array_equal(filled[~mask], values[~mask])
        self.assertLess(np.abs(filled[mask]).max(), 10.0)

    def test_masks_fixed_values_and_factors_are_on_points_or_faces(self):
        surface, values = self.surface, self.surface.points[:, 2]
        near = surface.points[:, 0] > 0.8
        of_faces = near[surface.triangles].any(axis=1)
        marked = np.zeros(surface.n_points, bool)
        marked[surface.triangles[of_faces]] = True
        np.testing.assert_array_equal(
            heat(surface, values, mask=of_faces, time_step=1),
            heat(surface, values, mask=marked, time_step=1))
        np.testing.assert_array_equal(
            heat(surface, values, fixed=of_faces, time_step=1),
            heat(surface, values, fixed=marked, time_step=1))
        np.testing.assert_array_equal(
            heat(surface, self.noise, mask=near, time_step=1),
            heat(surface, self.noise, mask=of_faces, time_step=1))
        heat(surface, values, fidelity=np.ones(surface.n_faces), fidelity_weight=1.0, time_step=1)
        excluded = heat(surface, self.noise, mask=of_faces, mask_mode="Exclude", time_step=1)
        np.testing.assert_array_equal(excluded[of_faces], self.noise[of_faces])
        self.assertGreater(np.abs(excluded - self.noise)[~of_faces].min(), 0.0)

    def test_weights_of_quadrilaterals_are_those_of_their_triangles(self):
        torus = quad_torus()
        random = np.random.default_rng(5)
        points = torus.points + random.uniform(-0.05, 0.05, torus.points.shape)
        quads, values = Surface(points, torus.faces[:-1]), points[:, 0]  # fewer faces than points
        triangles = Surface(points, quads.triangles)
        for weights in (random.integers(0, 2, quads.n_faces).astype(float),
                        np.where(np.arange(quads.n_faces) == 7, 1e6, 1.0)):
            for function, options in ((heat, dict(time_step=1)), (heat, dict(mode="SteadyState")),
                                      (intrinsic_tv, dict(mode="SteadyState"))):
                found, expected = (
                    function(surface, values, fidelity=w, fidelity_weight=1.0, on_faces=False, **options)
                    for surface, w in ((quads, weights), (triangles, np.repeat(weights, 2))))
                np.testing.assert_allclose(found, expected, atol=1e-9)

    def test_errors_name_faces(self):
        with self.assertRaisesRegex(ValueError, r"one row per point, or \(5120,\)"):
            heat(self.surface, np.zeros(7), time_step=1)
        with self.assertRaisesRegex(ValueError, "on_faces is 3; allowed: True, False or None"):
            heat(self.surface, self.noise, on_faces=3, time_step=1)
        with self.assertRaisesRegex(ValueError, "one row per face"):
            heat(self.surface, self.surface.points[:, 2], on_faces=True, time_step=1)
        with self.assertRaisesRegex(ValueError, r"mask has shape \(3,\); allowed: \(2562,\), one flag"):
            heat(self.surface, self.noise, mask=[0, 1, 0], time_step=1)
        infinite = np.where(np.arange(self.surface.n_faces) == 9, np.inf, self.noise)
        with self.assertRaisesRegex(ValueError, "values is infinite at face 9"):
            heat(self.surface, infinite, time_step=1)


if __name__ == "__main__":
    unittest.main()
