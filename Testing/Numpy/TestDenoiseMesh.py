# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The arguments and reports of denoise_mesh. What it removes is tested in C++."""

import sys
import unittest
import warnings

import numpy as np

import surfacediffusion as sd


def noisy_sphere():
    """Points of the unit sphere moved along its normals."""
    clean = sd.sphere(4)
    noise = np.random.default_rng(3).normal(scale=0.01, size=(clean.n_points, 1))
    return sd.Surface(clean.points * (1 + noise), clean.triangles)


class DenoiseMesh(unittest.TestCase):
    def test_creases_and_the_limit_hold(self):
        noisy = noisy_sphere()
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
        box = sd.Surface([[x, y, z] for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)],
                         [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "the surface has too few points on smooth faces "
                                   "to tell noise from shape, .* [(]to remove noise, set noise_level[)]"):
            result = sd.denoise_mesh(box)
        self.assertEqual(len(result.warnings), 1)
        np.testing.assert_array_equal(result.points, box.points)
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "the volume of a part changes by"):
            changed = sd.denoise_mesh(box, noise_level=0.3)
        moved = np.linalg.norm(changed.points - box.points, axis=1)
        self.assertAlmostEqual(changed.maximum_displacement, moved.max(), delta=1e-12)
        self.assertAlmostEqual(changed.volume_before, 1.0, delta=1e-12)

    def test_fixed_points_and_the_points_of_fixed_faces_stay(self):
        noisy = noisy_sphere()
        north = noisy.points[:, 2] > 0.5
        points = sd.denoise_mesh(noisy, fixed=north)
        np.testing.assert_array_equal(points[north], noisy.points[north])
        self.assertGreater(np.linalg.norm(points - noisy.points, axis=1)[~north].mean(), 0.005)
        faces = north[noisy.triangles].any(axis=1)
        held = np.unique(noisy.triangles[faces])
        points = sd.denoise_mesh(noisy, fixed=faces)
        np.testing.assert_array_equal(points[held], noisy.points[held])

    def test_progress_rises_to_one_and_can_end_the_run(self):
        noisy = noisy_sphere()
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
