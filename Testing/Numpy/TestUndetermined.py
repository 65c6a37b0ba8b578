# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Connected components without a known value: NaN or the input, label 0, and one warning."""

import sys
import unittest
import warnings

import numpy as np

import surfacediffusion as sd


def ring(offset, n=24, rows=7):
    """A closed band of triangles, and whether each point is in its upper half."""
    angle = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    points = np.array([(offset + np.cos(a), np.sin(a), 0.26 * r) for r in range(rows) for a in angle])
    faces = []
    for r in range(rows - 1):
        for i in range(n):
            a, b = r * n + i, r * n + (i + 1) % n
            faces += [(a, b, b + n), (a, b + n, a + n)]
    return points, np.array(faces)


FIRST, FACES = ring(0.0)
N = len(FIRST)
ALONE = sd.Surface(FIRST, FACES)
BOTH = sd.Surface(np.vstack([FIRST, 2.0 * ring(3.0)[0]]), np.vstack([FACES, FACES + N]))
VALUES = 100.0 + (FIRST[:, 2] > 0.7) + 0.1 * np.cos(37.0 * np.arange(N))
SECOND = np.repeat([False, True], N)


class Weights(unittest.TestCase):
    """Values of weight 0 are missing where they are no start of time steps."""

    def setUp(self):
        self.surface = sd.sphere(4)
        points = self.surface.points
        self.values = (points[:, 2] > 0) + 0.1 * np.random.default_rng(4).normal(size=len(points))
        self.weights = np.where(points[:, 0] > 0.7, 0.0, 1.0)

    def test_values_of_weight_zero_have_no_effect_on_a_minimum(self):
        corners = self.surface.triangles
        of_faces = self.values[corners].mean(axis=1), self.weights[corners].min(axis=1)
        for values, weights in ((self.values, self.weights), of_faces):
            for function, options in (
                    (sd.intrinsic_tv, dict(mode="SteadyState")), (sd.mumford_shah, {}), (sd.segment, {}),
                    (sd.heat, dict(mode="SteadyState", fidelity_weight=1.0))):
                results = [np.asarray(getattr(found, "values", found)) for found in (
                    function(self.surface, np.where(weights > 0, values, other), fidelity=weights, **options)
                    for other in (1.0, 1e3, np.nan))]
                for found in results[:2]:
                    np.testing.assert_array_equal(found, results[2])

    def test_weights_of_points_leave_faces_between_them_out(self):
        outside = (self.weights[self.surface.triangles] == 0).all(axis=1)
        values = self.values[self.surface.triangles].mean(axis=1)
        for function, options in ((sd.intrinsic_tv, dict(mode="SteadyState")), (sd.mumford_shah, {}),
                                  (sd.heat, dict(mode="SteadyState", fidelity_weight=1.0))):
            one, nan = (function(self.surface, np.where(outside, other, values), fidelity=self.weights, **options)
                        for other in (1e3, np.nan))
            np.testing.assert_array_equal(one, nan)

    def test_fixed_points_keep_their_values_among_faces_without_weight(self):
        faces = self.surface.triangles
        values = self.values[faces].mean(axis=1)
        point = int(np.argmax(self.surface.points[:, 0]))
        weights = np.where((faces == point).any(axis=1), 0.0, 1.0)
        far = int(np.argmin(self.surface.points[faces].mean(axis=1)[:, 0]))
        for function, options in ((sd.intrinsic_tv, dict(mode="SteadyState")), (sd.mumford_shah, {})):
            for weightless, fixed in ((weights, point), (np.where(np.arange(len(faces)) == far, 0.0, 1.0), far)):
                fixed = np.arange(self.surface.n_points) == fixed  # of a face of this number, too
                self.assertTrue(np.isfinite(
                    function(self.surface, values, fidelity=weightless, fixed=fixed, **options)).all())
            given = (np.where(np.arange(len(faces)) == far, other, values) for other in (1e6, 0.5))
            one, other = (function(self.surface, data, fidelity=weightless, fixed=fixed, **options)
                          for data in given)
            np.testing.assert_array_equal(np.delete(one, far), np.delete(other, far))

    def test_they_are_the_start_of_time_steps(self):
        options = dict(fidelity=self.weights, fidelity_weight=1.0, time_step=1.0)
        one, other = (sd.heat(self.surface, np.where(self.weights > 0, self.values, start), **options)
                      for start in (1.0, 2.0))
        self.assertGreater(np.abs(one - other)[self.weights == 0].min(), 0.1)

    def test_a_component_without_weight_is_undetermined(self):
        weights = np.where(SECOND, 0.0, 1.0)
        values = np.tile(VALUES, 2)
        found, texts = update(lambda: sd.segment(BOTH, values, fidelity=weights))
        expected, of_nan = update(lambda: sd.segment(BOTH, np.where(SECOND, np.nan, values)))
        np.testing.assert_array_equal(found.values, expected.values)
        self.assertTrue((found.values[N:] == 0).all())
        self.assertEqual(texts, of_nan)
        with self.assertRaisesRegex(ValueError, "values has no known value: it is NaN, of weight 0 or masked"):
            sd.segment(BOTH, values, fidelity=np.zeros(2 * N))


def update(work):
    """The result of work(), and its warnings."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        result = work()
    return result, [str(w.message) for w in found]


class Undetermined(unittest.TestCase):
    def test_many_columns_are_nan_in_all_of_them(self):
        values = np.tile(np.concatenate([VALUES, VALUES])[:, None], (1, 40))
        values[N:, 35] = np.nan
        result, found = update(lambda: sd.heat(BOTH, time_step=1.0, values=values))
        self.assertEqual(len(found), 1)
        self.assertTrue(np.isnan(result[N:]).all())
        np.testing.assert_allclose(result[:N, 3], sd.heat(ALONE, time_step=1.0, values=VALUES), atol=1e-6)

    def test_no_known_value_is_an_error(self):
        with self.assertRaisesRegex(ValueError, "values has no known value: .*"):
            sd.heat(BOTH, time_step=1.0, values=np.full(2 * N, np.nan))
        with self.assertRaisesRegex(ValueError, "values has no known value: .*"):
            sd.segment(BOTH, np.concatenate([VALUES, VALUES]), mask=np.ones(2 * N))


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv)
