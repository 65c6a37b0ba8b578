# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Smooth functions through values at a few points, and one clear line on each kind of bad values."""

import sys
import unittest
import warnings

import numpy as np

import surfacediffusion as sd

BALL = sd.sphere(4)
N, M = BALL.n_points, len(BALL.triangles)


def field(points):
    """A smooth function on the unit sphere."""
    x, _, z = np.asarray(points).T
    return 3.0 + z * z + 0.5 * x


def places_around(count, radius=1.0):
    """Points on a spiral from pole to pole."""
    z = np.linspace(-0.98, 0.98, count)
    r, angle = np.sqrt(1 - z * z), 2.4 * np.arange(count)
    return radius * np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


def sparse(step, values=None):
    """The field at every step-th point of the ball, and NaN elsewhere."""
    values = field(BALL.points) if values is None else values
    return np.where(np.arange(len(values)) % step == 0, values, np.nan)


def interpolate(*arguments, **keywords):
    """The result and the warnings of interpolate()."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        result = sd.interpolate(*arguments, **keywords)
    return result, [str(warning.message) for warning in found]


class Values(unittest.TestCase):
    def test_nan_in_an_array_is_unknown(self):
        given = sparse(9)
        known = ~np.isnan(given)
        result, found = interpolate(BALL, given, exact=True, compute_error=True)
        self.assertEqual(found, [])
        self.assertEqual(result.values.shape, (N,))
        np.testing.assert_allclose(result.values[known], given[known], atol=1e-12)
        self.assertLess(np.abs(result.values - field(BALL.points)).max(), 0.03)
        self.assertEqual(result.number_of_values, known.sum())
        self.assertEqual((result.smoothing[0], result.degrees_of_freedom[0]), (0.0, known.sum()))
        self.assertEqual(result.error.shape, (N,))
        self.assertTrue((result.error[known] == 0.0).all())
        self.assertTrue((result.error[~known] > 0.0).all())

    def test_places_count_at_the_nearest_points_of_the_surface(self):
        places = places_around(80, 1.1)
        result, found = interpolate(BALL, field(places / 1.1), places, exact=True)
        self.assertEqual(found, [])
        self.assertLess(np.abs(result.values - field(BALL.points)).max(), 0.1)
        self.assertEqual(result.number_of_values, 80)
        at_points, _ = interpolate(BALL, field(BALL.points[::9]), BALL.points[::9], exact=True)
        of_array, _ = interpolate(BALL, sparse(9), exact=True)
        np.testing.assert_array_equal(at_points.values, of_array.values)

    def test_columns_have_the_bits_that_each_has_alone(self):
        places = places_around(60)
        values = np.stack([field(places), places[:, 1] ** 2], axis=1)
        both, _ = interpolate(BALL, values, places, compute_error=True)
        self.assertEqual((both.values.shape, both.error.shape), ((N, 2), (N, 2)))
        for column in (0, 1):
            alone, _ = interpolate(BALL, values[:, column], places, compute_error=True)
            self.assertEqual(alone.values.shape, (N,))
            np.testing.assert_array_equal(both.values[:, column], alone.values)
            np.testing.assert_array_equal(both.error[:, column], alone.error)
            self.assertEqual(both.smoothing[column], alone.smoothing[0])
        one, _ = interpolate(BALL, values[:, :1], places, compute_error=True)
        self.assertEqual((one.values.shape, one.error.shape), ((N, 1), (N, 1)))

    def test_values_of_faces_hold_on_faces(self):
        centres = BALL.points[BALL.triangles].mean(axis=1)
        given = sparse(11, field(centres))
        known = ~np.isnan(given)
        result, _ = interpolate(BALL, given, exact=True)
        self.assertEqual(result.values.shape, (M,))
        np.testing.assert_allclose(result.values[known], given[known], atol=1e-9)
        of_points, _ = interpolate(BALL, given, exact=True, result_on_faces=False)
        self.assertEqual(of_points.values.shape, (N,))


class Weights(unittest.TestCase):
    def test_weights_are_reciprocal_variances(self):
        # The same minimum: w and mu by the same factor, and two values for one of weight 2.
        places = places_around(40)
        values = field(places) + 0.1 * np.cos(37.0 * np.arange(40))
        plain, _ = interpolate(BALL, values, places, smoothing=0.5)
        scaled, _ = interpolate(BALL, values, places, fidelity=np.full(40, 4.0), smoothing=2.0)
        np.testing.assert_allclose(scaled.values, plain.values, atol=1e-9)
        heavy, _ = interpolate(BALL, values, places, fidelity=1.0 + (np.arange(40) == 7), smoothing=0.5)
        twice, found = interpolate(
            BALL, np.append(values, values[7]), np.vstack([places, places[7]]), smoothing=0.5)
        self.assertEqual(found, [])  # equal values contradict nothing
        np.testing.assert_allclose(twice.values, heavy.values, atol=1e-9)
        self.assertGreater(np.abs(heavy.values - plain.values).max(), 1e-4)

    def test_weight_zero_is_unknown(self):
        places = places_around(40)
        kept = np.arange(40) % 4 != 0
        some, _ = interpolate(BALL, field(places), places, fidelity=kept)
        few, _ = interpolate(BALL, field(places)[kept], places[kept])
        np.testing.assert_array_equal(some.values, few.values)
        self.assertEqual(some.number_of_values, 30)


class WrongValues(unittest.TestCase):
    def test_are_found_left_out_and_counted(self):
        places = places_around(80)
        values = field(places) + np.random.default_rng(0).normal(scale=0.02, size=80)
        wrong = np.isin(np.arange(80), (7, 30, 61))
        spoiled = values + 1.5 * wrong
        plain, found = interpolate(BALL, spoiled, places)
        self.assertRegex(found[0], r"^3 values are farther from the result than four standard deviations of the "
                                   r"others \(to leave outliers out, turn robust on\)$")
        result, found = interpolate(BALL, spoiled, places, robust=True, compute_error=True, leave_one_out=True)
        self.assertEqual(found, ["3 values are contradicted by others and left out"])
        np.testing.assert_array_equal(result.outliers, wrong)
        without = sd.interpolate(BALL, values[~wrong], places[~wrong])
        np.testing.assert_allclose(result.values, without.values, atol=1e-9)
        self.assertGreater(np.abs(plain.values - without.values).max(), 0.1)
        np.testing.assert_allclose(result.residuals[wrong], 1.5, atol=0.15)
        residuals, errors = result.leave_one_out
        self.assertTrue((np.abs(residuals[~wrong]) >= np.abs(result.residuals[~wrong])).all())
        np.testing.assert_array_equal(np.isnan(errors), wrong)
        np.testing.assert_allclose(result.upper - result.lower, 2 * 1.6449 * result.error, rtol=1e-4)

    def test_rows_are_those_of_the_data(self):
        data = sparse(9)
        result = sd.interpolate(BALL, np.column_stack([data, 2 * data]), robust=True)
        self.assertEqual(result.outliers.shape, (N, 2))
        np.testing.assert_array_equal(np.isnan(result.residuals[:, 0]), np.isnan(data))
        cells = sd.interpolate(BALL, np.where(np.arange(M) % 7 == 0, 1.0 + np.arange(M) % 2, np.nan), leave_one_out=True)
        self.assertEqual(cells.leave_one_out.residuals.shape, (M,))

    def test_distance_to_data_is_that_from_the_values_that_were_used(self):
        places = places_around(40)
        values = field(places)
        result = sd.interpolate(BALL, values, places)
        np.testing.assert_array_equal(result.distance_to_data, sd.distance(BALL, places))
        far = np.arange(40) % 3 == 1
        weights = 1.0 - (np.arange(40) % 3 == 2)
        result, _ = interpolate(BALL, values, places * (1.0 + far)[:, None], fidelity=weights, maximum_distance=0.5)
        np.testing.assert_array_equal(result.distance_to_data, sd.distance(BALL, places[::3]))
        spoiled = values + 2.0 * (np.arange(40) == 17)
        result, _ = interpolate(BALL, spoiled, places, robust=True)
        self.assertEqual(np.flatnonzero(result.outliers).tolist(), [17])
        np.testing.assert_array_equal(result.distance_to_data, sd.distance(BALL, np.delete(places, 17, axis=0)))
        # Of values at points and on faces, where a mask and a weight leave some out.
        of_points = sparse(5)
        known = np.flatnonzero(~np.isnan(of_points))
        result = sd.interpolate(BALL, of_points, mask=np.arange(N) == known[0],
                                fidelity=1.0 - (np.arange(N) == known[1]))
        np.testing.assert_array_equal(result.distance_to_data, sd.distance(BALL, known[2:]))
        of_faces = np.where(np.arange(M) % 7 == 0, 1.0 + np.arange(M) % 2, np.nan)
        result, _ = interpolate(BALL, of_faces, fidelity=1.0 * (np.arange(M) % 14 == 0))
        np.testing.assert_array_equal(
            result.distance_to_data, sd.distance(BALL, BALL.points[BALL.triangles[::14]].mean(axis=1)))


class MissingValues(unittest.TestCase):
    def test_numbers_that_stand_for_no_value_do_not_count(self):
        places = places_around(40)
        values = np.column_stack([field(places), 2.0 * field(places)])
        gone = np.isin(np.arange(40), (3, 17))
        expected, said = interpolate(BALL, values[~gone], places[~gone])
        for numbers in (-10000, [-10000.0], [-999, -10000], np.float32(-10000.1)):
            spoiled = values.copy()
            spoiled[3, 0], spoiled[17, 1] = np.ravel(numbers)[-1], np.float32(np.ravel(numbers)[-1])
            result, found = interpolate(BALL, spoiled, places, missing_value=numbers)
            self.assertEqual(found, said)
            self.assertEqual(result.number_of_values, 38)
            np.testing.assert_array_equal(result.values, expected.values)
        spoiled[3, 0] = -10000.0
        _, found = interpolate(BALL, spoiled[:, 0], places)
        self.assertIn("1 value of the points is -10000, far from all others, and taken for measured "
                      "(if it stands for no value, give it as missing_value)", found[0])

    def test_of_the_data_too_and_zero_is_one(self):
        data = sparse(9)
        plain, said = interpolate(BALL, data)
        for number in (0.0, 1e30, -9999.0):
            result, found = interpolate(BALL, np.where(np.isnan(data), number, data), missing_value=number)
            np.testing.assert_array_equal(result.values, plain.values)
            self.assertEqual(found, said)
        counts = np.where(np.isnan(data), -9999, np.rint(100 * data)).astype(np.int32)
        np.testing.assert_array_equal(sd.interpolate(BALL, counts, missing_value=-9999).values,
                                      sd.interpolate(BALL, np.where(counts == -9999, np.nan, counts)).values)

    def test_errors_name_what_is_allowed(self):
        for wrong in (np.inf, "none", [np.nan]):
            with self.assertRaisesRegex(ValueError, "^missing_value is .*; allowed: finite numbers$"):
                sd.interpolate(BALL, sparse(9), missing_value=wrong)
        with self.assertRaisesRegex(ValueError, "has no known value"):
            sd.interpolate(BALL, np.full(N, -1.0), missing_value=-1.0)


class Boundary(unittest.TestCase):
    def test_a_planar_wave_has_its_velocity_up_to_the_boundary(self):
        x, y = (a.ravel() for a in np.meshgrid(np.linspace(0.0, 60.0, 41), np.linspace(0.0, 60.0, 41)))
        corner = np.arange(41 * 41).reshape(41, 41)[:-1, :-1].ravel()
        plane = sd.Surface(np.c_[x, y, 0.0 * x], np.vstack([np.c_[corner, corner + 1, corner + 42],
                                                            np.c_[corner, corner + 42, corner + 41]]))
        random = np.random.default_rng(0)
        places = np.c_[random.uniform(0.0, 60.0, (60, 2)), np.zeros(60)]
        times = places[:, 0] / 0.6 + random.normal(size=60)
        near = np.minimum(np.minimum(x, 60.0 - x), np.minimum(y, 60.0 - y)) < 2.0
        speeds = {}
        for boundary in (None, "Natural"):
            result, found = interpolate(plane, times, places,
                                        **({"boundary": boundary} if boundary else {}))
            self.assertEqual(found, [])
            speed = sd.conduction_velocity(plane, result.values, smoothing_fwhm=8.0)[1]
            speeds[boundary] = speed[near].mean()
        self.assertAlmostEqual(speeds[None], 0.6, delta=0.012)
        result = sd.interpolate(plane, times, places, compute_error=True)
        found = sd.conduction_velocity(plane, result.values, error=result)
        self.assertGreater(((found.speed_lower <= 0.6) & (0.6 <= found.speed_upper)).mean(), 0.9)
        self.assertLess(np.median(found.speed_upper - found.speed_lower), 0.15)
        with self.assertRaisesRegex(ValueError, "error has no errors of slopes; allowed: the result of interpolate"):
            sd.conduction_velocity(plane, result.values, error=sd.interpolate(plane, times, places))
        with self.assertRaisesRegex(ValueError, "smoothing_fwhm is 8; allowed: 0 together with error"):
            sd.conduction_velocity(plane, result.values, error=result, smoothing_fwhm=8.0)
        with self.assertRaisesRegex(ValueError, "result_on_faces is True; allowed: False together with error"):
            sd.conduction_velocity(plane, result.values, error=result, result_on_faces=True)
        with self.assertRaisesRegex(ValueError, r"error has shape .*; allowed: \(\d+, 2\)"):
            sd.conduction_velocity(plane, np.c_[result.values, result.values], error=result)
        # The rule as numpy computes it.
        slow, half = 1.0 / found.speed, 1.645 * result.slope_error
        np.testing.assert_allclose(found.speed_lower, 1.0 / (slow + half), rtol=1e-4)
        np.testing.assert_allclose(1.0 / found.speed_upper, np.maximum(slow - half, 0.0), rtol=1e-3, atol=1e-12)
        self.assertGreater(speeds["Natural"], 0.7)
        # The smoothing of many values is not sure either.
        inside, widths = [], []
        for seed in range(12):
            random = np.random.default_rng(seed)
            angle, places = random.uniform(0.0, 6.3), np.c_[random.uniform(0.0, 60.0, (400, 2)), np.zeros(400)]
            times = places @ [np.cos(angle), np.sin(angle), 0.0] / 0.6 + random.normal(size=400)
            result, _ = interpolate(plane, times, places, compute_error=True)
            found = sd.conduction_velocity(plane, result.values, error=result)
            inside.append(((found.speed_lower <= 0.6) & (0.6 <= found.speed_upper)).mean())
            widths.append(np.median(found.speed_upper - found.speed_lower))
        print(f"400 electrodes: {np.mean(inside):.3f} inside, width {np.mean(widths):.4f}")
        self.assertGreater(np.mean(inside), 0.87)
        self.assertLess(np.mean(widths), 0.018)  # at most twice those of restricted maximum likelihood

    def test_automatic_is_natural_where_free_is_excluded(self):
        half = sd.Surface(BALL.points, BALL.triangles[BALL.points[BALL.triangles, 2].min(axis=1) > 0.0])
        known = np.where(np.arange(N) % 40 == 0, field(BALL.points), np.nan)
        for options in ({"intrinsic_delaunay": True}, {"along_diffusivity": 2.0, "across_diffusivity": 2.0}):
            found, natural = (interpolate(half, known, exact=True, boundary=boundary, **options)[0].values
                              for boundary in ("Automatic", "Natural"))
            np.testing.assert_array_equal(found, natural)

    def test_open_slopes_have_infinite_errors_and_one_line_says_so(self):
        strip = sd.Surface([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]],
                           [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]])
        result, found = interpolate(strip, [1.0, np.nan, 5.0] + [np.nan] * 3, exact=True, noise_level=1.0,
                                    compute_error=True)
        np.testing.assert_allclose(result.values, [1.0, 3.0, 5.0] * 2, atol=1e-4)
        np.testing.assert_array_equal(np.isinf(result.error), [False] * 3 + [True] * 3)
        self.assertIn("the values leave slopes open with boundary Free: the flattest result is taken, and "
                      "standard errors are infinite where slopes are open", found[0])


class BadValues(unittest.TestCase):
    def test_no_value_is_an_error(self):
        for message, arguments in (
                ("no value is known: the values at points are none; allowed: one or more",
                 ([], np.empty((0, 3)))),
                ("no value is known: the values at points are all NaN or of weight 0; allowed",
                 ([np.nan] * 4, places_around(4))),
                ("values has no known value", (np.full(N, np.nan),))):
            with self.assertRaisesRegex(ValueError, message):
                sd.interpolate(BALL, *arguments)

    def test_what_is_not_allowed_is_named(self):
        places = places_around(5)
        values = field(places)
        for message, arguments, options in (
                (r"points has shape \(5, 2\); allowed: \(p, 3\)", (values, places[:, :2]), {}),
                (r"values has shape \(4,\); allowed: \(5,\) or \(5, k\)", (values[:4], places), {}),
                (r"fidelity has shape \(2,\); allowed: \(5,\)", (values, places), {"fidelity": [1, 1]}),
                ("fidelity is -1.* at point 3 of the values; allowed: finite numbers, 0 or more",
                 (values, places), {"fidelity": [1, 1, 1, -1, 1]}),
                ("a value is infinite at point 2 of the values; allowed: finite values and NaN",
                 (np.where(np.arange(5) == 2, np.inf, values), places), {}),
                ("a coordinate is not finite at point 1 of the values; allowed: finite coordinates",
                 (values, np.where(np.arange(5)[:, None] == 1, np.nan, places)), {}),
                ("smoothing is 0; allowed: finite numbers above 0", (values, places), {"smoothing": 0}),
                ("noise_level is -1; allowed", (values, places), {"noise_level": -1}),
                ("correlation_length is -1; allowed", (values, places), {"correlation_length": -1}),
                ("along_diffusivity is 4 and across_diffusivity is 1 but directions is not set; allowed",
                 (values, places), {"along_diffusivity": 4}),
                ("boundary is Free but intrinsic_delaunay is True; allowed: False, or Natural",
                 (values, places), {"boundary": "Free", "intrinsic_delaunay": True})):
            with self.assertRaisesRegex(ValueError, message) as caught:
                sd.interpolate(BALL, *arguments, **options)
            self.assertNotIn("\n", str(caught.exception))


class Exact(unittest.TestCase):
    def test_more_values_than_corners_of_a_triangle_are_a_warning(self):
        surface = sd.sphere(2)
        corners = surface.points[surface.triangles[0]]
        shares = np.random.default_rng(0).dirichlet(np.ones(3), 6)
        values = np.arange(6.0) ** 2
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning,
                                   "do not hold exactly but to .*more values than corners.*turn exact off"):
            sd.interpolate(surface, values, shares @ corners, exact=True)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            sd.interpolate(surface, values[:3], shares[:3] @ corners, exact=True)


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv)
