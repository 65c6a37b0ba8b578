# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""estimate_fwhm and smooth_to_fwhm on noise of known smoothness."""

import sys
import unittest
import warnings

import numpy as np

import surfacediffusion as sd

RADIUS = 100.0


def even_sphere():
    return sd.sphere(4, RADIUS)


def uneven_sphere():
    """A sphere with edges three times as long on one side as on the other."""
    points = sd.sphere(4, RADIUS).points + [0.0, 0.0, 45.0]
    points *= RADIUS / np.linalg.norm(points, axis=1)[:, None]
    return sd.Surface(points, sd.sphere(4).triangles)


def cube_of_26_points():
    """Each side has four squares of two triangles."""
    faces, numbers = [], {}

    def number(*place):
        return numbers.setdefault(place, len(numbers))

    for axis in range(3):
        for side in (0, 2):
            for i, j in np.ndindex(2, 2):
                square = [np.insert([i + a, j + b], axis, side) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                a, b, c, d = (number(*map(int, corner)) for corner in square)
                faces += [[a, b, c], [a, c, d]] if (side == 2) == (axis != 1) else [[c, b, a], [d, c, a]]
    return sd.Surface(np.array(list(numbers), float), np.array(faces))


def edge_length(surface):
    a, b = surface.triangles[:, 0], surface.triangles[:, 1]
    return np.linalg.norm(surface.points[a] - surface.points[b], axis=1).mean()


def gaussian_noise(surface, fwhm, columns=60, seed=1):
    """White noise after the Gaussian kernel of this width in arc length, which is exact and does not
    use the library."""
    points = surface.points / RADIUS
    distance = RADIUS * np.arccos(np.clip(points @ points.T, -1.0, 1.0))
    kernel = np.exp(-4.0 * np.log(2.0) * (distance / fwhm) ** 2)
    return kernel @ np.random.default_rng(seed).normal(size=(surface.n_points, columns))


def jittered_sphere():
    """A sphere whose points are displaced by up to a third of an edge."""
    even = even_sphere()
    points = even.points + 0.35 * edge_length(even) * np.random.default_rng(4).uniform(-1, 1, even.points.shape)
    return sd.Surface(points * RADIUS / np.linalg.norm(points, axis=1)[:, None], even.triangles)


def exact_noise(surface, fwhm, columns, seed=1):
    """Values of white noise after the heat equation on the sphere itself, whose covariance is a sum of
    Legendre polynomials."""
    points = surface.points / RADIUS
    x = np.clip(points @ points.T, -1.0, 1.0)
    time = (fwhm / RADIUS) ** 2 / (16 * np.log(2))
    covariance, before, polynomial = np.zeros_like(x), np.zeros_like(x), np.ones_like(x)
    for k in range(int(6 / np.sqrt(2 * time))):
        covariance += (2 * k + 1) * np.exp(-2 * time * k * (k + 1)) * polynomial
        before, polynomial = polynomial, ((2 * k + 1) * x * polynomial - k * before) / (k + 1)
    values, vectors = np.linalg.eigh(covariance)
    noise = np.random.default_rng(seed).normal(size=(surface.n_points, columns))
    return vectors @ (np.sqrt(np.maximum(values, 0))[:, None] * noise)


def white_noise(surface, columns, seed=2):
    """The variances are those of white noise, 1 over the areas of the points."""
    noise = np.random.default_rng(seed).normal(size=(surface.n_points, columns))
    return noise / np.sqrt(surface.vertex_areas)[:, None]


class Estimate(unittest.TestCase):
    def assert_within(self, found, wanted, share):
        self.assertLess(abs(found / wanted - 1.0), share, f"{found} in place of {wanted}")

    def test_width_of_gaussian_noise_is_found_within_three_percent(self):
        for surface in (even_sphere(), uneven_sphere()):
            for edges in (2, 3, 4, 6):
                width = edges * edge_length(surface)
                noise = gaussian_noise(surface, width)
                for demean in (True, False):
                    with self.subTest(edges=edges, demean=demean):
                        estimate = sd.estimate_fwhm(surface, noise, demean=demean)
                        self.assert_within(estimate.pooled, width, 0.03)

    def test_width_of_the_exact_field_is_found_within_three_percent_from_one_and_a_half_edges_on(self):
        surface = sd.sphere(3, RADIUS)
        for edges in (1.5, 2, 3, 4):
            width = edges * edge_length(surface)
            self.assert_within(sd.estimate_fwhm(surface, exact_noise(surface, width, 400)).pooled, width, 0.03)

    def test_width_of_noise_smoothed_by_heat_is_found_within_three_percent(self):
        surface = sd.sphere(5, RADIUS)
        noise = np.random.default_rng(2).normal(size=(surface.n_points, 40))
        for edges in (6, 8, 12):
            width = edges * edge_length(surface)
            estimate = sd.estimate_fwhm(surface, sd.heat(surface, noise, fwhm=width))
            self.assert_within(estimate.pooled, width, 0.03)

    def test_widths_of_correlated_noise_add_up_in_squares(self):
        surface = sd.sphere(4, RADIUS)
        h = edge_length(surface)
        correlated = gaussian_noise(surface, 4 * h, columns=100)
        for width in (4 * h, 5 * h):
            smooth = sd.heat(surface, correlated, fwhm=width)
            self.assert_within(
                sd.estimate_fwhm(surface, smooth).pooled, np.hypot(4 * h, width), 0.03)

    def test_columns_are_estimated_each_and_pooled(self):
        surface = even_sphere()
        h = edge_length(surface)
        narrow, wide = gaussian_noise(surface, 3 * h), gaussian_noise(surface, 6 * h)
        both = np.hstack([narrow, wide])
        estimate = sd.estimate_fwhm(surface, both)
        self.assertEqual(estimate.columns.shape, (120,))
        self.assert_within(estimate.columns[:60].mean(), 3 * h, 0.03)
        self.assert_within(estimate.columns[60:].mean(), 6 * h, 0.04)
        self.assertTrue(3 * h < estimate.pooled < 6 * h)
        alone = sd.estimate_fwhm(surface, both[:, 7])
        self.assertEqual(alone.columns[0], estimate.columns[7])
        self.assertAlmostEqual(alone.pooled, alone.columns[0])

    def test_scale_of_values_and_coordinates_does_not_matter(self):
        surface = even_sphere()
        noise = gaussian_noise(surface, 20.0, columns=3)
        width = sd.estimate_fwhm(surface, noise).pooled
        for scale in (1e-200, 1e200):
            self.assertAlmostEqual(sd.estimate_fwhm(surface, scale * noise).pooled, width)
        small = sd.Surface(1e-3 * surface.points, surface.triangles)
        self.assert_within(1e3 * sd.estimate_fwhm(small, noise).pooled, width, 1e-4)

    def test_variance_that_varies_over_the_surface_does_not_matter(self):
        surface = even_sphere()
        h = edge_length(surface)
        noise = gaussian_noise(surface, 4 * h)
        uneven = noise * (3.0 + 2.0 * surface.points[:, 2] / RADIUS)[:, None]
        self.assert_within(sd.estimate_fwhm(surface, uneven).pooled, 4 * h, 0.03)

    def test_given_areas_scale_the_lengths(self):
        surface = uneven_sphere()
        noise = gaussian_noise(surface, 20.0, columns=5)
        expected = sd.estimate_fwhm(surface, noise)
        average = sd.Surface(0.5 * surface.points, surface.triangles,
                             areas=surface.vertex_areas)
        self.assert_within(sd.estimate_fwhm(average, noise).pooled, expected.pooled, 1e-4)

    def test_missing_points_and_masked_points_are_left_out(self):
        surface = even_sphere()
        h = edge_length(surface)
        noise = gaussian_noise(surface, 4 * h)
        wall = surface.points[:, 2] < 0.0
        with_nan = np.where(wall[:, None], np.nan, noise)
        masked = sd.estimate_fwhm(surface, np.where(wall[:, None], 7.0, noise), mask=wall)
        self.assertEqual(sd.estimate_fwhm(surface, with_nan).pooled, masked.pooled)
        self.assert_within(masked.pooled, 4 * h, 0.03)

    def test_width_rises_with_that_of_the_noise_and_is_infinite_with_a_warning_above_the_surface(self):
        cube = cube_of_26_points()
        noise = np.random.default_rng(3).normal(size=cube.n_points)
        h = edge_length(cube)
        modes = np.linspace(0.3, 6.0, 60)
        found = []
        for width in modes:
            with warnings.catch_warnings(record=True) as said:
                warnings.simplefilter("always")
                found.append(sd.estimate_fwhm(cube, sd.heat(
                    cube, noise, time_step=(width * h) ** 2 / (16 * np.log(2)), units="Absolute",
                    time_integrator="Exponential", number_of_time_steps=1)).pooled)
            self.assertEqual(np.isinf(found[-1]), any("as smooth as the surface" in str(w.message) for w in said))
        self.assertTrue((np.diff([f for f in found if np.isfinite(f)]) > 0).all())
        self.assertTrue(np.isinf(found[-1]))
        self.assertTrue((np.diff(np.isinf(found).astype(int)) >= 0).all())
        widest = max(f for f in found if np.isfinite(f))
        for asked in (0.5 * widest, 0.9 * widest):
            smooth = sd.smooth_to_fwhm(cube, noise, asked)
            self.assertLess(abs(sd.estimate_fwhm(cube, smooth).pooled / asked - 1), 0.006)

    def test_white_noise_has_a_width_below_an_edge_and_a_constant_an_infinite_one(self):
        surface = even_sphere()
        white = np.random.default_rng(1).normal(size=(surface.n_points, 50))
        self.assertLess(sd.estimate_fwhm(surface, white).pooled, 0.7 * edge_length(surface))
        self.assertEqual(sd.estimate_fwhm(surface, np.ones(surface.n_points)).pooled, np.inf)


class Realised(unittest.TestCase):
    def test_time_steps_keep_the_lumped_mass_matrix(self):
        surface = jittered_sphere()
        noise = white_noise(surface, 3)
        width = 3 * edge_length(surface)
        steps = {"time_step": width**2 / (16 * np.log(2)), "units": "Absolute", "number_of_time_steps": 1,
                 "time_integrator": "Exponential"}
        np.testing.assert_array_equal(
            sd.heat(surface, noise, **steps), sd.heat(surface, noise, mass_matrix="Lumped", **steps))
        for mass_matrix in ("Lumped", "Mixed"):
            np.testing.assert_allclose(
                sd.heat(surface, noise, mass_matrix=mass_matrix, **steps),
                sd.heat(surface, noise, fwhm=width, number_of_time_steps=1, mass_matrix=mass_matrix),
                rtol=0, atol=1e-12 * np.abs(noise).max())

    def test_widths_below_one_and_a_half_edges_are_one_warning_with_the_next_step(self):
        surface = even_sphere()
        noise = white_noise(surface, 40)
        for edges, count in ((1.45, 1), (1.0, 1), (1.55, 0)):
            with warnings.catch_warnings(record=True) as said:
                warnings.simplefilter("always")
                sd.heat(surface, noise, fwhm=edges * edge_length(surface))
            self.assertEqual(len(said), count, [str(w.message) for w in said])
            for warning in said:
                self.assertRegex(str(warning.message), r"fwhm is .*smooth_to_fwhm\(\), --to-fwhm")


class SmoothTo(unittest.TestCase):
    def setUp(self):
        self.surface = sd.sphere(4, RADIUS)
        self.h = edge_length(self.surface)

    def reach(self, values, width, **keywords):
        smooth = sd.smooth_to_fwhm(self.surface, values, width, **keywords)
        self.assertEqual(smooth.shape, np.shape(values))
        return smooth

    def test_white_noise_reaches_the_width(self):
        noise = np.random.default_rng(3).normal(size=(self.surface.n_points, 30))
        for edges in (2.5, 4, 6):
            smooth = self.reach(noise, edges * self.h, residuals=noise)
            found = sd.estimate_fwhm(self.surface, smooth).pooled
            self.assertLess(abs(found / (edges * self.h) - 1.0), 0.01)

    def test_correlated_noise_is_smoothed_by_the_rest(self):
        noise = gaussian_noise(self.surface, 4 * self.h, columns=100)
        smooth = self.reach(noise, 6 * self.h, residuals=noise)
        self.assertLess(abs(sd.estimate_fwhm(self.surface, smooth).pooled / (6 * self.h) - 1), 0.01)
        rest = sd.heat(self.surface, noise, fwhm=np.sqrt(36 - 16) * self.h)
        self.assertLess(np.std(smooth - rest) / np.std(rest), 0.05)

    def test_noise_with_long_tails_reaches_the_width(self):
        # Two kinds of noise together: its correlation is no Gaussian.
        noise = (gaussian_noise(self.surface, 2 * self.h, seed=4)
                 + 0.3 * gaussian_noise(self.surface, 6 * self.h, seed=5))
        smooth = self.reach(noise, 5 * self.h, residuals=noise)
        self.assertLess(abs(sd.estimate_fwhm(self.surface, smooth).pooled / (5 * self.h) - 1), 0.01)

    def test_widths_above_the_surface_name_the_largest_that_is_reached(self):
        noise = np.random.default_rng(3).normal(size=(self.surface.n_points, 5))
        for width in (20.0, 200.0):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                with self.assertRaisesRegex(ValueError, "but smoothing reaches [0-9.]+; allowed"):
                    sd.smooth_to_fwhm(self.surface, noise, width * RADIUS)

    def test_width_just_above_that_of_the_noise_is_reached_without_a_warning(self):
        # The width that is added is far below an edge, and the caller has not given it.
        noise = gaussian_noise(self.surface, 3 * self.h)
        found = sd.estimate_fwhm(self.surface, noise).pooled
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            smooth = sd.smooth_to_fwhm(self.surface, noise, 1.00001 * found, residuals=noise)
        self.assertLess(np.abs(smooth - noise).max(), 0.01 * np.abs(noise).max())

    def test_series_is_measured_without_its_mean(self):
        signal = 100.0 * self.surface.points[:, [2]] / RADIUS
        noise = gaussian_noise(self.surface, 3 * self.h)
        noise /= noise.std()
        smooth = self.reach(signal + noise, 6 * self.h)
        residuals = smooth - smooth.mean(axis=1, keepdims=True)
        self.assertLess(
            abs(sd.estimate_fwhm(self.surface, residuals).pooled / (6 * self.h) - 1), 0.01)

    def test_values_outside_the_region_stay(self):
        wall = self.surface.points[:, 2] < -30.0
        noise = gaussian_noise(self.surface, 3 * self.h, columns=20)
        smooth = self.reach(noise, 5 * self.h, residuals=noise, mask=wall)
        np.testing.assert_array_equal(smooth[wall], noise[wall])
        found = sd.estimate_fwhm(self.surface, smooth, mask=wall).pooled
        self.assertLess(abs(found / (5 * self.h) - 1), 0.01)

    def test_single_map_and_type(self):
        noise = gaussian_noise(self.surface, 3 * self.h, columns=1)[:, 0].astype(np.float32)
        smooth = self.reach(noise, 5 * self.h)
        self.assertEqual(smooth.dtype, np.float32)
        self.assertLess(abs(sd.estimate_fwhm(self.surface, smooth).pooled / (5 * self.h) - 1), 0.01)


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv)
