# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Values that go from sphere to sphere. TestOperators.py tests the weights as a matrix of scipy.sparse."""

import pickle
import unittest
import warnings

import numpy as np

from surfacediffusion import Resampler, Surface, SurfaceDiffusionWarning, on_faces, resample, sphere


def turn(points, angle=0.7):
    """Rotated about a skew axis."""
    axis = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
    across = np.cross(axis, points)
    return points + np.sin(angle) * across + (1.0 - np.cos(angle)) * np.cross(axis, across)


FINE = sphere(5)
COARSE = Surface(100.0 * turn(sphere(4).points), sphere(4).triangles)
RNG = np.random.default_rng(5)


def smooth(surface):
    """A harmonic of degree 3 and the coordinates."""
    x, y, z = (surface.points / np.linalg.norm(surface.points, axis=1)[:, None]).T
    return np.stack([x * y * z, x, y, z], axis=1)


class Means(unittest.TestCase):
    def test_smooth_data_have_an_error_of_second_order(self):
        errors = {}
        for method in ("Barycentric", "AdaptiveBarycentricArea"):
            for level in (3, 4, 5):
                source, target = sphere(level), Surface(turn(sphere(4).points), sphere(4).triangles)
                error = resample(source, target, smooth(source), method) - smooth(target)
                errors[method, level] = np.sqrt(np.mean(error**2))
        for level in (3, 4):
            self.assertGreater(errors["Barycentric", level] / errors["Barycentric", level + 1], 3.7)
        # Gathered means have the width of the target's triangles.
        self.assertLess(errors["AdaptiveBarycentricArea", 5], 0.003)
        self.assertLess(errors["AdaptiveBarycentricArea", 3], 0.006)

    def test_the_integral_is_kept_to_a_thousandth_and_all_values_count(self):
        noise = RNG.normal(1.0, 1.0, FINE.n_points)
        found = resample(FINE, COARSE, noise)
        before, after = FINE.vertex_areas @ noise / FINE.area, COARSE.vertex_areas @ found / COARSE.area
        self.assertLess(abs(after - before), 2e-3)
        for row in (0, 17, 5000):
            one = np.eye(1, FINE.n_points, row)[0]
            self.assertGreater(resample(FINE, COARSE, one).max(), 0.0)
        missed = sum(resample(FINE, COARSE, np.eye(FINE.n_points)[:, ::20], "Barycentric").max(axis=0) == 0.0)
        self.assertGreater(missed, 100)

    def test_a_sphere_of_another_radius_and_order_gives_the_same_values(self):
        values = RNG.normal(size=(FINE.n_points, 2))
        order = RNG.permutation(FINE.n_points)
        number = np.argsort(order)
        shuffled = Surface(7.5 * FINE.points[order], number[FINE.triangles])
        np.testing.assert_allclose(resample(shuffled, COARSE, values[order]), resample(FINE, COARSE, values),
                                   atol=1e-12)
        np.testing.assert_array_equal(resample(FINE, shuffled, values), values[order])

    def test_areas_are_weights(self):
        areas = RNG.uniform(1.0, 3.0, FINE.n_points)
        values = RNG.normal(size=FINE.n_points)
        given = resample(FINE, COARSE, values, source_areas=areas, target_areas=COARSE.vertex_areas)
        own = resample(Surface(FINE.points, FINE.triangles, areas), COARSE, values)
        np.testing.assert_array_equal(given, own)
        # Gathered rows are means by area.
        up = np.where(np.arange(FINE.n_points) % 2 == 0, 1000.0, 1.0)
        halves = np.where(np.arange(FINE.n_points) % 2 == 0, 1.0, 0.0)
        self.assertGreater(resample(FINE, COARSE, halves, source_areas=up).mean(), 0.98)
        self.assertLess(abs(resample(FINE, COARSE, halves).mean() - 0.5), 0.05)

    def test_many_columns_are_those_one_by_one(self):
        resampler = Resampler(COARSE, FINE)
        values = RNG.normal(size=(COARSE.n_points, 37))
        values[RNG.random(values.shape) < 0.3] = np.nan
        found = resampler(values)
        for k in (0, 15, 16, 36):
            np.testing.assert_array_equal(found[:, k], resampler(values[:, k]))
        np.testing.assert_array_equal(found, pickle.loads(pickle.dumps(resampler))(values))

    def test_missing_values_and_masks_take_no_part(self):
        values = smooth(FINE)[:, 1]
        mask = FINE.points[:, 2] > 0.3
        holes = np.where(mask, np.nan, values)
        found = resample(FINE, COARSE, holes)
        for other in (resample(FINE, COARSE, values, mask=mask), resample(FINE, COARSE, values, roi=~mask),
                      resample(FINE, COARSE, np.ma.array(values, mask=mask))):
            np.testing.assert_allclose(other, found, atol=1e-14)
        height = COARSE.points[:, 2] / 100.0
        self.assertTrue(np.isnan(found[height > 0.4]).all())
        near = height < 0.2
        np.testing.assert_allclose(found[near], resample(FINE, COARSE, values)[near], atol=1e-14)
        self.assertLess(np.nanmax(abs(found - smooth(COARSE)[:, 1])), 0.05)
        # A mask of faces leaves out the points that have no other face.
        of_faces = mask[FINE.triangles].any(axis=1)
        left = np.zeros(FINE.n_points, bool)
        left[FINE.triangles[~of_faces]] = True
        np.testing.assert_array_equal(resample(FINE, COARSE, values, mask=on_faces(of_faces)),
                                      resample(FINE, COARSE, values, mask=~left))


class Labels(unittest.TestCase):
    def test_integers_and_bools_are_labels_of_the_same_type(self):
        octants = (FINE.points > 0) @ [1, 2, 4] - 3
        expected = (COARSE.points > 0) @ [1, 2, 4] - 3
        far = abs(COARSE.points).min(axis=1) > 8.0
        for dtype in (np.int16, np.int64):
            found = resample(FINE, COARSE, octants.astype(dtype))
            self.assertEqual(found.dtype, dtype)
            np.testing.assert_array_equal(found[far], expected[far])
            self.assertLess(np.mean(found != expected), 0.02)
        found = resample(FINE, COARSE, FINE.points > 0)
        self.assertEqual(found.dtype, bool)
        self.assertEqual(found.shape, (COARSE.n_points, 3))
        np.testing.assert_array_equal(resample(FINE, COARSE, octants.astype(float), labels=True),
                                      resample(FINE, COARSE, octants))
        means = resample(FINE, COARSE, octants, labels=False)
        self.assertEqual(means.dtype, np.float64)
        self.assertGreater(np.count_nonzero(means % 1), 100)

    def test_nothing_known_is_0_of_integers_and_nan_of_others(self):
        labels = np.full(FINE.n_points, 5)
        mask = FINE.points[:, 2] > 0
        found = resample(FINE, COARSE, labels, mask=mask)
        self.assertEqual(set(found), {0, 5})
        masked = resample(FINE, COARSE, np.ma.array(labels, mask=mask))
        np.testing.assert_array_equal(np.nan_to_num(masked), found)
        self.assertTrue(np.isnan(masked).any())


class Errors(unittest.TestCase):
    def refused(self, message, *arguments, **keywords):
        with self.assertRaisesRegex(ValueError, message):
            resample(*arguments, **keywords)

    def test_wrong_inputs_are_named_with_what_is_allowed(self):
        values = np.ones(FINE.n_points)
        flat = Surface(FINE.points * [1, 1, 0.9], FINE.triangles)
        self.refused(r"^source has points 0.9 to 1 from the origin; allowed: a sphere about the origin", flat,
                     COARSE, values)
        for size in (1e160, 1e-170):
            self.refused("^source has points .* from the origin; allowed: a sphere .* radii from 1e-150 to 1e150",
                         Surface(size * FINE.points, FINE.triangles), COARSE, values)
        self.refused("^target has points .* from the origin; allowed: a sphere", FINE,
                     Surface(FINE.points + [5, 0, 0], FINE.triangles), values)
        self.refused(r"^values has shape \(3,\); allowed: \(10242,\) or \(10242, k\)", FINE, COARSE, [1, 2, 3])
        self.refused("^values is infinite in row 7; allowed: finite", FINE, COARSE,
                     np.where(np.arange(len(values)) == 7, -np.inf, values))
        self.refused("^method is 'Nearest'; allowed: Barycentric, AdaptiveBarycentricArea", FINE, COARSE, values,
                     "Nearest")
        self.refused(r"^method is \['Barycentric'\]; allowed: Barycentric", FINE, COARSE, values, ["Barycentric"])
        self.refused(r"^source_areas has shape \(2562,\); allowed: \(10242,\)", FINE, COARSE, values,
                     source_areas=COARSE.vertex_areas)
        self.refused("^target_areas has 0.0 at point 3; allowed: finite numbers above 0", FINE, COARSE, values,
                     target_areas=np.where(np.arange(COARSE.n_points) == 3, 0.0, 1.0))
        self.refused("^mask leaves all points out; allowed: one or more", FINE, COARSE, values, mask=values)
        self.refused("^mask and roi are both given", FINE, COARSE, values, mask=1 - values, roi=values)
        self.refused("^values has the label 9007199254740994; allowed: -2", FINE, COARSE,
                     np.full(FINE.n_points, 2**53 + 2))
        self.refused("^labels is 'yes'; allowed: True, False or None", FINE, COARSE, values, labels="yes")
        self.refused("^surface is 3; allowed: a Surface", FINE, 3, values)

    def test_points_without_face_have_no_value(self):
        points = np.vstack([COARSE.points, [[0, 0, 0], [0, 0, 50]]])
        target = Surface(points, COARSE.triangles)
        values = smooth(FINE)
        with self.assertWarnsRegex(SurfaceDiffusionWarning, "^target has 2 points without a face"):
            found = resample(FINE, target, values)
        self.assertTrue(np.isnan(found[-2:]).all())
        np.testing.assert_array_equal(found[:-2], resample(FINE, COARSE, values))
        # As points of the source they change nothing, wherever they are.
        source = Surface(np.vstack([FINE.points, [[0, 0, 0], [9, 9, 9]]]), FINE.triangles)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for method in ("Barycentric", "AdaptiveBarycentricArea"):
                for ball in (COARSE, sphere(6)):
                    other = resample(source, ball, np.vstack([values, [[7] * 4, [8] * 4]]), method)
                    np.testing.assert_array_equal(other, resample(FINE, ball, values, method))

    def test_progress_is_reported_and_its_exception_ends_the_search(self):
        fractions = []
        Resampler(sphere(6), sphere(7), progress=fractions.append)
        self.assertEqual((fractions, fractions[-1]), (sorted(fractions), 1.0))
        self.assertGreater(len(fractions), 2)

        def stop(fraction):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            Resampler(sphere(6), sphere(7), progress=stop)


if __name__ == "__main__":
    unittest.main(verbosity=2)
