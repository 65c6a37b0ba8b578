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
N, M = len(FIRST), len(FACES)
ALONE = sd.Surface(FIRST, FACES)
BOTH = sd.Surface(np.vstack([FIRST, 2.0 * ring(3.0)[0]]), np.vstack([FACES, FACES + N]))
VALUES = 100.0 + (FIRST[:, 2] > 0.7) + 0.1 * np.cos(37.0 * np.arange(N))
SECOND = np.repeat([False, True], N)


def update(work):
    """The result of work(), and its warnings."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        result = work()
    return result, [str(w.message) for w in found]


class Undetermined(unittest.TestCase):
    def check(self, result, found, first):
        self.assertEqual(len(found), 1)
        self.assertIn("1 connected component has no known value", found[0])
        np.testing.assert_allclose(result[:N], first, atol=2e-3)
        self.assertTrue(np.isnan(result[N:]).all())

    def test_functions_give_nan_there_and_elsewhere_what_they_give_alone(self):
        values = np.concatenate([VALUES, np.full(N, np.nan)])
        calls = [
            lambda s, v: sd.heat(s, v, time_step=1.0),
            lambda s, v: sd.heat(s, v, mode="SteadyState", automatic_fidelity=True),
            lambda s, v: sd.intrinsic_tv(s, v, mode="SteadyState"),
            lambda s, v: sd.tensor_diffusion(s, v),
            lambda s, v: sd.mumford_shah(s, v, edge_threshold=0.7).values,
        ]
        for call in calls:
            result, found = update(lambda: call(BOTH, values))
            first, _ = update(lambda: call(ALONE, VALUES))
            self.check(result, [text for text in found if "no known value" in text], first)

    def test_masked_floats_are_nan_and_masked_integers_stay(self):
        values = np.concatenate([VALUES, np.full(N, 7.0)])
        for dtype in (np.float32, np.float64):
            result, found = update(lambda: sd.heat(BOTH, time_step=1.0, values=values.astype(dtype), mask=SECOND))
            self.assertEqual(result.dtype, dtype)
            self.check(result, found, sd.heat(ALONE, time_step=1.0, values=VALUES.astype(dtype)))
        for dtype in (np.uint8, np.int16, np.int64):
            result, found = update(lambda: sd.heat(BOTH, time_step=1.0, values=values.astype(dtype), mask=SECOND))
            self.assertEqual(len(found), 1)
            self.assertTrue((result[N:] == 7).all())

    def test_many_columns_are_nan_in_all_of_them(self):
        values = np.tile(np.concatenate([VALUES, VALUES])[:, None], (1, 40))
        values[N:, 35] = np.nan
        result, found = update(lambda: sd.heat(BOTH, time_step=1.0, values=values))
        self.assertEqual(len(found), 1)
        self.assertTrue(np.isnan(result[N:]).all())
        np.testing.assert_allclose(result[:N, 3], sd.heat(ALONE, time_step=1.0, values=VALUES), atol=1e-6)

    def test_faces_of_the_component_are_nan(self):
        values = np.concatenate([np.cos(np.arange(M)), np.full(M, np.nan)])
        result, found = update(lambda: sd.heat(BOTH, time_step=1.0, values=values))
        self.assertEqual(len(found), 1)
        self.assertTrue((np.isnan(result) == np.isnan(values)).all())
        result, found = update(lambda: sd.heat(BOTH, time_step=1.0, values=values, result_on_faces=False))
        self.assertTrue((np.isnan(result) == SECOND).all())

    def test_labels_are_zero_without_boundaries(self):
        values = np.concatenate([VALUES, np.full(N, np.nan)])
        result, found = update(lambda: sd.segment(BOTH, values, fidelity_weight=5.0))
        self.assertTrue((result.values[N:] == 0).all())
        self.assertTrue((result.values[:N] > 0).all())
        self.assertTrue((result.probabilities[N:] == 0).all())
        self.assertGreater(len(result.boundaries), 0)
        self.assertLess(max(curve.points[:, 0].max() for curve in result.boundaries), 2.0)

    def test_no_known_value_is_an_error(self):
        with self.assertRaisesRegex(ValueError, "values has no known value: .*"):
            sd.heat(BOTH, time_step=1.0, values=np.full(2 * N, np.nan))
        with self.assertRaisesRegex(ValueError, "values has no known value: .*"):
            sd.segment(BOTH, np.concatenate([VALUES, VALUES]), mask=np.ones(2 * N))


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv)
