# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The tests that peers have of the same tasks hold for our functions. They are written from what
their tests assert: nilearn's of smooth_img() on surfaces (nilearn/image/tests/test_image.py) and
LaPy's of diffusion() and areas (lapy/utils/tests/test_heat.py and test_tria_mesh.py)."""

import unittest

import numpy as np
from samples import FACES, N, NOISE, POINTS

from surfacediffusion import Surface, heat, heat_steps
from surfacediffusion.command.areas import vertex_areas
from surfacediffusion.files import SurfaceFile

MAPS = np.random.default_rng(11).normal(size=(N, 3))


def smooth(values, fwhm=5, **options):
    return heat((POINTS, FACES), values, fwhm=fwhm, **options)


class Nilearn(unittest.TestCase):
    def test_nan_does_not_propagate(self):
        for count in (1, 40):
            values = NOISE.copy()
            values[:count] = np.nan
            self.assertTrue(np.isfinite(smooth(values)).all())

    def test_infinite_values_are_an_error_and_not_set_to_zero(self):
        # nilearn replaces them by 0, which is a value like any other and pulls down the mean.
        for value in (np.inf, -np.inf):
            values = NOISE.copy()
            values[1] = value
            with self.assertRaisesRegex(ValueError, "infinite"):
                smooth(values)

    def test_the_input_is_not_modified(self):
        values = NOISE.copy()
        values[0] = np.nan
        before = values.copy()
        smooth(values)
        np.testing.assert_array_equal(values, before)

    def test_no_steps_or_no_width_change_nothing(self):
        np.testing.assert_array_equal(smooth(NOISE, number_of_time_steps=0), NOISE)
        np.testing.assert_allclose(smooth(NOISE, fwhm=1e-6), NOISE, rtol=1e-6)

    def test_extremes_and_variance_become_smaller(self):
        found = smooth(NOISE)
        self.assertGreater(NOISE.max(), found.max())
        self.assertLess(NOISE.min(), found.min())
        self.assertGreater(NOISE.var(), found.var())

    def test_columns_give_the_result_of_single_maps(self):
        together = smooth(MAPS)
        self.assertEqual(together.shape, MAPS.shape)
        for i in range(MAPS.shape[1]):
            np.testing.assert_allclose(together[:, i], smooth(MAPS[:, i]), rtol=1e-12, atol=1e-14)

    def test_a_larger_width_smooths_more(self):
        variances = [smooth(NOISE, fwhm).var() for fwhm in (1, 2, 4, 8, 16)]
        self.assertEqual(variances, sorted(variances, reverse=True))

    def test_widths_that_are_no_scalar_are_errors(self):
        for fwhm in ((0, 1, 2), [0, 1, 2], np.asarray([1, 2])):
            with self.assertRaisesRegex((TypeError, ValueError), "fwhm"):
                smooth(NOISE, fwhm)


class LaPy(unittest.TestCase):
    def seed(self, *vertices):
        """Heat of amount 1 at each vertex, as a density."""
        values = np.zeros(N)
        values[list(vertices)] = 1 / self.areas[list(vertices)]
        return values

    def setUp(self):
        self.areas = vertex_areas(SurfaceFile("", "off", POINTS, FACES))

    def diffuse(self, values):
        """One step of backward Euler of one mean edge length squared, as LaPy's diffusion()."""
        return heat((POINTS, FACES), values, time_step=1, number_of_time_steps=1,
                    time_integrator="FirstOrder")

    def test_a_vector_gives_a_vector(self):
        self.assertEqual(self.diffuse(self.seed(0)).shape, (N,))
        self.assertEqual(self.diffuse(self.seed(0)[:, None]).shape, (N, 1))

    def test_each_column_is_that_of_a_single_call(self):
        seeds = [self.seed(*range(10)), self.seed(0), self.seed(1, 2)]
        together = self.diffuse(np.column_stack(seeds))
        self.assertEqual(together.shape, (N, 3))
        for i, seed in enumerate(seeds):
            np.testing.assert_allclose(together[:, i], self.diffuse(seed), rtol=1e-6, atol=1e-9)

    def test_the_system_is_that_of_linear_finite_elements(self):
        stiffness = np.zeros((N, N))
        for face in FACES:
            for k in range(3):
                i, j, o = face[k], face[(k + 1) % 3], face[(k + 2) % 3]
                a, b = POINTS[i] - POINTS[o], POINTS[j] - POINTS[o]
                cotangent = (a @ b) / np.linalg.norm(np.cross(a, b))
                stiffness[[i, j], [j, i]] -= cotangent / 2
                stiffness[[i, j], [i, j]] += cotangent / 2
        edges = np.unique(np.sort(np.concatenate(
            [FACES[:, [0, 1]], FACES[:, [1, 2]], FACES[:, [2, 0]]]), axis=1), axis=0)
        length = np.linalg.norm(POINTS[edges[:, 0]] - POINTS[edges[:, 1]], axis=1).mean()
        amounts = np.zeros(N)
        amounts[[3, 8]] = 1
        expected = np.linalg.solve(np.diag(self.areas) + length**2 * stiffness, amounts)
        np.testing.assert_allclose(self.diffuse(self.seed(3, 8)), expected, rtol=1e-9)

    def test_vertices_out_of_range_are_errors(self):
        faces = FACES.copy()
        faces[5, 1] = N
        with self.assertRaisesRegex(ValueError, f"{N} in row 5; allowed: 0 to {N - 1}"):
            Surface(POINTS, faces)

    def test_areas_of_a_cube(self):
        points = np.array([[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0], [0, 0, 1], [0, 1, 1],
                           [1, 1, 1], [1, 0, 1]], float)
        faces = np.array([[0, 1, 2], [2, 3, 0], [4, 5, 6], [6, 7, 4], [0, 4, 7], [7, 3, 0],
                          [0, 4, 5], [5, 1, 0], [1, 5, 6], [6, 2, 1], [3, 7, 6], [6, 2, 3]])
        areas = vertex_areas(SurfaceFile("", "off", points, faces))
        # Each triangle has the area 1/2, a third of which belongs to each of its vertices.
        np.testing.assert_allclose(areas, np.bincount(faces.ravel()) / 6)
        self.assertAlmostEqual(areas.sum(), 6)
        # The library's areas are the same: the integral in its history is that of 1.
        result = heat_steps((points, faces), np.ones(8), number_of_time_steps=1, time_step=1).last()
        np.testing.assert_allclose(result.history["Total_0"], 6)
        for i in range(8):
            one = np.arange(8) == i
            result = heat_steps((points, faces), one.astype(float), number_of_time_steps=0,
                                time_step=1).last()
            self.assertAlmostEqual(result.history["Total_0"][0], areas[i])


if __name__ == "__main__":
    unittest.main(verbosity=2)
