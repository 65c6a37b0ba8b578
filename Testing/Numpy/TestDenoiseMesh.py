# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""denoise_mesh: noise is removed and reported, and everything else stays."""

import sys
import unittest
import warnings

import numpy as np

import surfacediffusion as sd


def noisy_sphere(amount=0.01, refinements=5):
    """Points of the unit sphere moved along its normals, and the same surface without noise."""
    clean = sd.sphere(refinements)
    noise = np.random.default_rng(3).normal(scale=amount, size=(clean.n_points, 1))
    return sd.Surface(clean.points * (1 + noise), clean.triangles), clean


def angles(points, other, triangles):
    """The angles between the normals of triangles with these points, in degrees."""
    def normals(of):
        a, b, c = of[triangles].swapaxes(0, 1)
        found = np.cross(b - a, c - a)
        return found / np.linalg.norm(found, axis=1, keepdims=True)

    cosines = (normals(points) * normals(other)).sum(axis=1)
    return np.degrees(np.arccos(np.clip(cosines, -1, 1)))


class DenoiseMesh(unittest.TestCase):
    def test_noise_of_a_sphere_is_removed_and_its_level_reported(self):
        noisy, clean = noisy_sphere()
        result = sd.denoise_mesh(noisy)
        radii = np.linalg.norm(result.points, axis=1)
        self.assertLess(radii.std(), 0.003)
        self.assertLess(abs(result.noise_level - 0.01), 0.0015)
        self.assertEqual(result.surface_type, "CAD")
        self.assertLess(angles(result.points, clean.points, clean.triangles).mean(),
                        0.3 * angles(noisy.points, clean.points, clean.triangles).mean())
        self.assertEqual(result.warnings, [])

    def test_creases_and_the_limit_hold(self):
        noisy, _ = noisy_sphere()
        upper = noisy.points[noisy.triangles].mean(axis=1)[:, 2] > 0
        sides = np.sort(np.concatenate([noisy.triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))]), axis=1)
        edges, inverse = np.unique(sides, axis=0, return_inverse=True)
        count = np.bincount(inverse.ravel(), weights=np.tile(upper, 3))
        rim = edges[count == 1]
        marks = np.isin(np.arange(noisy.n_points), rim)
        results = [sd.denoise_mesh(noisy, creases=creases).points for creases in (upper.astype(int), rim, marks)]
        for points in results:
            np.testing.assert_array_equal(points[marks], noisy.points[marks])
        self.assertTrue((results[0][~marks] != noisy.points[~marks]).any(axis=1).all())
        np.testing.assert_array_equal(results[1], results[2])
        limited = sd.denoise_mesh(noisy, displacement_limit=0.005)
        self.assertAlmostEqual(limited.maximum_displacement, 0.005, places=12)
        self.assertIn("points move as far as displacement_limit allows", " ".join(limited.warnings))
        held = sd.denoise_mesh(noisy, crease_angle=1e-6)
        np.testing.assert_allclose(held.points, noisy.points, atol=1e-12)
        with self.assertRaisesRegex(ValueError, "creases is .*; allowed: rows of points, 0 to"):
            sd.denoise_mesh(noisy, creases=[[0, noisy.n_points]])

    def test_coarse_shapes_stay_and_the_line_names_the_level(self):
        corners = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        squares = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        box = sd.Surface(np.array(corners, float), squares)
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "the surface has too few points on smooth faces "
                                   "to tell noise from shape, .* [(]to remove noise, set noise_level[)]"):
            result = sd.denoise_mesh(box)
        self.assertEqual(len(result.warnings), 1)
        np.testing.assert_array_equal(result.points, box.points)
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            changed = sd.denoise_mesh(box, noise_level=0.3)
        self.assertGreater(np.abs(changed.points - box.points).max(), 0)
        loss = 100 * (changed.volume_after / changed.volume_before - 1)
        self.assertIn(f"the volume of a part changes by {loss:.6g} %", " ".join(str(w.message) for w in found))
        noisy, _ = noisy_sphere(refinements=4)
        both = sd.Surface(np.vstack([noisy.points, box.points + 3]),
                          np.vstack([noisy.triangles, box.triangles + noisy.n_points]))
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "1 of 2 parts have too few points"):
            result = sd.denoise_mesh(both)
        np.testing.assert_array_equal(result.points[noisy.n_points:], box.points + 3)
        np.testing.assert_array_equal(result.points[:noisy.n_points], sd.denoise_mesh(noisy).points)

    def test_the_report_agrees_with_the_points(self):
        noisy, _ = noisy_sphere(refinements=4)
        result = sd.denoise_mesh(noisy)
        moved = np.linalg.norm(result.points - noisy.points, axis=1)
        self.assertAlmostEqual(result.maximum_displacement, moved.max(), delta=1e-12)
        self.assertAlmostEqual(result.mean_displacement, moved.mean(), delta=0.1 * moved.mean())

        def volume(points):
            a, b, c = points[noisy.triangles].swapaxes(0, 1)
            return (a * np.cross(b, c)).sum() / 6

        self.assertAlmostEqual(result.volume_before, volume(noisy.points), delta=1e-10)
        self.assertAlmostEqual(result.volume_after, volume(result.points), delta=1e-10)
        self.assertLess(abs(result.volume_after / result.volume_before - 1), 0.005)
        edges = noisy.points[noisy.triangles] - noisy.points[np.roll(noisy.triangles, 1, axis=1)]
        lengths = np.linalg.norm(edges, axis=2)
        self.assertAlmostEqual(result.mean_edge_length, lengths.mean(), delta=1e-12)
        np.testing.assert_array_equal(np.asarray(result), result.points)
        np.testing.assert_array_equal(np.asarray(result), sd.denoise_mesh(noisy))

    def test_an_open_surface_has_no_volume(self):
        noisy, _ = noisy_sphere(refinements=4)
        half = noisy.triangles[noisy.points[noisy.triangles].mean(axis=1)[:, 2] > 0]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            result = sd.denoise_mesh((noisy.points, half))
        self.assertEqual((result.volume_before, result.volume_after), (0.0, 0.0))
        unused = np.setdiff1d(np.arange(noisy.n_points), half)
        np.testing.assert_array_equal(result.points[unused], noisy.points[unused])

    def test_fixed_points_and_the_points_of_fixed_faces_stay(self):
        noisy, _ = noisy_sphere(refinements=4)
        north = noisy.points[:, 2] > 0.5
        points = sd.denoise_mesh(noisy, fixed=north)
        np.testing.assert_array_equal(points[north], noisy.points[north])
        self.assertGreater(np.linalg.norm(points - noisy.points, axis=1)[~north].mean(), 0.005)
        faces = north[noisy.triangles].any(axis=1)
        held = np.unique(noisy.triangles[faces])
        points = sd.denoise_mesh(noisy, fixed=faces)
        np.testing.assert_array_equal(points[held], noisy.points[held])

    def test_seams_come_apart_with_a_warning_unless_their_points_are_merged(self):
        noisy, _ = noisy_sphere(refinements=3)
        split = noisy.points[noisy.triangles].reshape(-1, 3)
        soup = sd.Surface(split, np.arange(len(split)).reshape(-1, 3))
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "come apart.*merge_coincident_points"):
            sd.denoise_mesh(soup)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            merged = sd.denoise_mesh(soup, merge_coincident_points=True)
        np.testing.assert_allclose(merged.points.reshape(-1, 3, 3),
                                   sd.denoise_mesh(noisy)[noisy.triangles], atol=1e-3)
        for corner in range(noisy.n_points):
            copies = merged[(noisy.triangles == corner).ravel()]
            self.assertLess(np.ptp(copies, axis=0).max(), 1e-14)

    def test_triangles_of_zero_area_are_a_warning(self):
        noisy, _ = noisy_sphere(refinements=3)
        triangles = np.concatenate([noisy.triangles, [[0, 0, 1]]])
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "1 triangles of zero area have no"):
            sd.denoise_mesh((noisy.points, triangles))

    def test_progress_rises_to_one_and_can_end_the_run(self):
        noisy, _ = noisy_sphere()
        found = []
        expected = sd.denoise_mesh(noisy, progress=found.append)
        self.assertEqual(found, sorted(found))
        self.assertEqual(found[-1], 1.0)

        class Enough(Exception):
            pass

        def stop(fraction):
            raise Enough

        with self.assertRaises(Enough):
            sd.denoise_mesh(noisy, progress=stop, noise_level=0.011)
        np.testing.assert_array_equal(sd.denoise_mesh(noisy), expected)


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv)
