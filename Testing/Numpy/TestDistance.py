# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Distances along surfaces. The matrix of scipy.sparse is tested where scipy is."""

import doctest
import importlib
import importlib.util
import sys
import unittest

import numpy as np

import surfacediffusion as sd

HAS_SCIPY = importlib.util.find_spec("scipy") is not None

KITE = ([[0, 0, 0], [1, -3, 0], [2, 0, 0], [1, 3, 0]], [[0, 1, 2], [0, 2, 3]])


def great_circles(surface, source):
    points = surface.points / np.linalg.norm(surface.points, axis=1)[:, None]
    return np.arccos(np.clip(points @ points[source], -1.0, 1.0))


def grid(n):
    """The unit square of n x n squares as polygons."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    points = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    i, j = np.meshgrid(np.arange(n), np.arange(n))
    a = (j * (n + 1) + i).ravel()
    return points, np.stack([a, a + 1, a + n + 2, a + n + 1], axis=1)


class Distance(unittest.TestCase):
    def test_kite_is_exact(self):
        np.testing.assert_allclose(sd.distance(KITE, 2), [2, 10**0.5, 0, 10**0.5], atol=1e-14)
        np.testing.assert_allclose(sd.distance(KITE, [1]), [10**0.5, 0, 10**0.5, 6], atol=1e-14)

    def test_sphere_has_great_circles(self):
        errors = []
        for level in (3, 5):
            surface = sd.sphere(level, 50.0)
            found = sd.distance(surface, 17) / 50.0
            errors.append(np.abs(found - great_circles(surface, 17)).mean())
        self.assertGreater(errors[0] / errors[1], 3.5)
        self.assertLess(errors[1], 0.005 * np.pi)

    def test_heat_is_near_great_circles_and_less_near_than_fronts(self):
        surface = sd.sphere(4, 50.0)
        exact = 50.0 * great_circles(surface, 17)
        heat = np.abs(sd.distance(surface, 17, method="Heat") - exact).mean()
        fronts = np.abs(sd.distance(surface, 17) - exact).mean()
        self.assertLess(heat, 0.005 * 50.0 * np.pi)
        self.assertLess(fronts, heat)
        masked = sd.distance(surface, 17, method="Heat", mask=surface.points[:, 2] < 0.0)
        np.testing.assert_array_equal(np.isinf(masked), surface.points[:, 2] < 0.0)

    def test_plane_is_exact_with_points_that_no_face_uses(self):
        points, faces = grid(12)
        points = np.concatenate([points, [[7.0, 7.0, 7.0]]])
        found = sd.distance((points, faces), 50)
        exact = np.linalg.norm(points - points[50], axis=1)
        np.testing.assert_allclose(found[:-1], exact[:-1], atol=1e-12)
        self.assertEqual(found[-1], np.inf)

    def test_nearest_source_is_that_of_the_smallest_distance(self):
        surface = sd.sphere(4)
        sources = np.array([3, 99, 1234, 2000])
        found = sd.nearest_sources(surface, sources)
        alone = np.stack([sd.distance(surface, int(source)) for source in sources])
        np.testing.assert_array_equal(found.source, alone.argmin(axis=0))
        np.testing.assert_array_equal(found.distance, alone.min(axis=0))
        later = sd.nearest_sources(surface, sources, start=[0.0, 9.0, 9.0, 9.0])
        self.assertTrue((later.source == 0).all())
        np.testing.assert_allclose(later.distance, alone[0], atol=1e-12)

    def test_speeds_on_faces_and_points_scale_times(self):
        surface = grid(10)
        plain = sd.distance(surface, 0, speed=np.ones(100))
        np.testing.assert_allclose(sd.distance(surface, 0), plain, atol=1e-12)
        np.testing.assert_allclose(sd.distance(surface, 0, speed=np.full(100, 0.25)), 4 * plain)
        np.testing.assert_allclose(sd.distance(surface, 0, speed=np.full(121, 2.0)), plain / 2)
        points, _ = surface
        speed = np.ones(100)
        speed[5::10] = 0.0  # the column of faces from x = 0.5 to 0.6
        found = sd.distance(surface, 0, speed=speed)
        self.assertTrue(np.isinf(found[points[:, 0] > 0.55]).all())
        self.assertTrue(np.isfinite(found[points[:, 0] < 0.55]).all())
        masked = sd.distance(surface, 0, mask=speed == 0)
        np.testing.assert_array_equal(np.isfinite(masked), np.isfinite(found))

    def test_other_parts_are_infinitely_far(self):
        a, b = sd.sphere(1), sd.sphere(1)
        surface = (np.concatenate([a.points, b.points + 5.0]),
                   np.concatenate([a.triangles, b.triangles + 42]))
        found = sd.nearest_sources(surface, 0)
        self.assertTrue(np.isfinite(found.distance[:42]).all())
        self.assertTrue(np.isinf(found.distance[42:]).all())
        self.assertTrue((found.source[42:] == -1).all())

    def test_bad_input_names_what_is_allowed(self):
        surface = sd.sphere(1)
        bad = {
            r"sources is \[\]; allowed: rows of points, one or more": dict(sources=[]),
            "sources is 1.5; allowed": dict(sources=1.5),
            "sources has 42; allowed: 0 to 41": dict(sources=[1, 42]),
            "sources has -1; allowed: 0 to 41": dict(sources=-1),
            "sources has point 3, which no face uses": dict(sources=3, mask=np.arange(42) == 3),
            "start is .* 2 finite numbers": dict(sources=[1, 2], start=[0.0, np.nan]),
            "start is .* 1 finite numbers": dict(sources=[1], start=[0.0, 1.0]),
            "speed is -1.0 in row 4; allowed: finite numbers, 0 or more": dict(
                sources=1, speed=np.where(np.arange(80) == 4, -1.0, 1.0)),
            "method is 'Dijkstra'; allowed: Eikonal, Heat": dict(sources=1, method="Dijkstra"),
            "method is Heat; allowed: Eikonal together with speed": dict(
                sources=1, method="Heat", speed=np.ones(80)),
            "method is Heat; allowed: Eikonal together with start": dict(
                sources=1, method="Heat", start=[1.0]),
            r"speed has shape \(5,\)": dict(sources=1, speed=np.ones(5)),
        }
        for message, keywords in bad.items():
            with self.assertRaisesRegex(ValueError, message):
                sd.distance(surface, **keywords)

    def test_examples_in_docstrings_hold(self):
        module = importlib.import_module("surfacediffusion._distance")
        finder, runner = doctest.DocTestFinder(), doctest.DocTestRunner()
        for example in finder.find(module):
            if HAS_SCIPY or not example.name.endswith(".distances"):
                runner.run(example)
        self.assertEqual(runner.summarize().failed, 0)
        self.assertGreaterEqual(runner.summarize().attempted, 6)


@unittest.skipUnless(HAS_SCIPY, "scipy is not installed")
class Matrix(unittest.TestCase):
    def test_rows_are_distances_up_to_the_cutoff(self):
        surface = sd.sphere(3, 10.0)
        found = sd.distances(surface, cutoff=6.0)
        self.assertEqual((found.shape, found.format), ((642, 642), "csr"))
        for source in (0, 5, 641):
            expected = sd.distance(surface, source)
            near = np.flatnonzero(expected <= 6.0)
            row = slice(found.indptr[source], found.indptr[source + 1])
            np.testing.assert_array_equal(found.indices[row], near)
            np.testing.assert_array_equal(found.data[row], expected[near])
        one = sd.distances(surface, [7])
        np.testing.assert_array_equal(one.toarray()[0], sd.distance(surface, 7))
        with self.assertRaisesRegex(ValueError, "cutoff is 0; allowed: numbers above 0"):
            sd.distances(surface, [7], cutoff=0)


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
