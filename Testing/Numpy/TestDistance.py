# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Distances along surfaces. The matrix of scipy.sparse is tested where scipy is."""

import doctest
import importlib
import importlib.util
import sys
import unittest
import warnings

import numpy as np

import surfacediffusion as sd

HAS_SCIPY = importlib.util.find_spec("scipy") is not None

KITE = ([[0, 0, 0], [1, -3, 0], [2, 0, 0], [1, 3, 0]], [[0, 1, 2], [0, 2, 3]])


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

    def test_nearest_source_is_that_of_the_smallest_distance(self):
        surface = sd.sphere(4)
        sources = np.array([3, 99, 1234, 2000])
        found = sd.nearest_sources(surface, sources)
        alone = np.stack([sd.distance(surface, int(source)) for source in sources])
        np.testing.assert_array_equal(found.source, alone.argmin(axis=0))
        np.testing.assert_array_equal(found.distance, alone.min(axis=0))
        later = sd.nearest_sources(surface, sources, start=[0.0, 9.0, 9.0, 9.0])
        self.assertTrue((later.source == 0).all())
        fronts = sd.distance(surface, 3, method="Eikonal")
        np.testing.assert_allclose(later.distance, fronts, atol=1e-12)

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

    def test_speeds_along_and_across_fibres_may_be_arrays(self):
        points, faces = grid(40)
        surface = (points, np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]]))
        m, ones = len(surface[1]), np.ones(len(surface[1]))
        fibre = np.array([np.cos(0.6), np.sin(0.6), 0.0])
        fibres, place = np.tile(fibre, (m, 1)), np.array([[0.51, 0.47, 0.0]])
        offset = points - place
        across = np.array([-fibre[1], fibre[0], 0.0])
        exact = np.hypot(offset @ fibre / 0.6, offset @ across / 0.3)
        numbers = sd.distance(surface, place, directions=fibres, along_speed=0.6, across_speed=0.3)
        np.testing.assert_allclose(numbers, exact, rtol=1e-12)
        for along, across in ((0.6 * ones, 0.3 * ones), (0.6, 0.3 * ones), (0.6 * ones, 0.3)):
            given = {"directions": fibres, "along_speed": along, "across_speed": across}
            np.testing.assert_array_equal(sd.distance(surface, place, **given), numbers)
        fine = sd.distance(surface, place, refine_to=0.02, **given)
        np.testing.assert_allclose(fine[:len(points)], exact, rtol=1e-10)
        # a line of block, but for a gap: fronts go around its end
        x, y = points[surface[1]].mean(axis=1)[:, :2].T
        fibres = np.tile([0.0, 1.0, 0.0], (m, 1))
        speed = np.where((np.abs(x - 0.5125) < 0.0125) & (y > 0.25), 0.0, 1.0)
        target = int(np.argmin(np.linalg.norm(points - [0.8, 0.75, 0.0], axis=1)))
        found = sd.distance(surface, [[0.2, 0.75, 0.0]], directions=fibres, along_speed=speed, across_speed=speed / 2)
        around = np.hypot(0.5, 0.6) + 0.05 + np.hypot(0.5, 0.55)
        self.assertAlmostEqual(found[target], around, 12)
        speed[np.abs(x - 0.5125) < 0.0125] = 0.0
        closed = sd.distance(surface, [[0.2, 0.75, 0.0]], directions=fibres, along_speed=speed, across_speed=speed)
        np.testing.assert_array_equal(np.isinf(closed), points[:, 0] > 0.52)

    def test_places_are_within_triangles(self):
        points, faces = grid(12)
        triangles = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
        barycentric = np.array([[0.2, 0.5, 0.3], [1.0, 0.0, 0.0]])
        places = np.einsum("ki,kij->kj", barycentric, points[triangles[[40, 7]]])
        exact = np.linalg.norm(points[:, None] - places, axis=2)
        for sources in (places, places + [0, 0, 0.3]):
            for surface in ((points, triangles), (points, faces)):
                found = sd.nearest_sources(surface, sources)
                np.testing.assert_allclose(found.distance, exact.min(axis=1), atol=1e-12)
                near = np.take_along_axis(exact, found.source[:, None], axis=1)[:, 0]
                np.testing.assert_allclose(near, exact.min(axis=1), atol=1e-12)
        inside = ([40, 7], barycentric)
        found = sd.nearest_sources((points, triangles), inside)
        np.testing.assert_allclose(found.distance, exact.min(axis=1), atol=1e-12)
        later = sd.nearest_sources((points, triangles), inside, start=[0.5, 0.0])
        np.testing.assert_allclose(later.distance, (exact + [0.5, 0.0]).min(axis=1), atol=1e-12)
        fine = sd.refine((points, triangles), 0.05).surface
        found = sd.nearest_sources((points, triangles), inside, refine_to=0.05)
        np.testing.assert_allclose(
            found.distance, np.linalg.norm(fine.points[:, None] - places, axis=2).min(axis=1), atol=1e-12)
        ball = sd.sphere(4, 50.0)
        place = np.array([[0.3, -0.7, 0.5]]) * 80
        circles = 50.0 * np.arccos(np.clip(
            ball.points / 50.0 @ place[0] / np.linalg.norm(place), -1.0, 1.0))
        for method in ("Eikonal", "Heat"):
            errors = np.abs(sd.distance(ball, place, method=method) - circles)
            self.assertLess(errors.mean(), 0.005 * 50.0 * np.pi)

    @unittest.skipUnless(HAS_SCIPY, "scipy is not installed")
    def test_rows_of_the_matrix_take_directions(self):
        surface = sd.sphere(3)
        east = np.cross([0.0, 0.0, 1.0], surface.points)
        found = sd.distances(surface, [7, 90], directions=east, along_speed=4.0)
        for row, source in zip(found.toarray(), (7, 90)):
            np.testing.assert_array_equal(
                row, sd.distance(surface, source, directions=east, along_speed=4.0))
        found_of_arrays = sd.distances(surface, [7, 90], directions=east, along_speed=np.full(1280, 4.0))
        np.testing.assert_array_equal(found_of_arrays.toarray(), found.toarray())

    def test_surfaces_keep_factors_for_other_sources_and_not_for_other_masks(self):
        surface, inside = sd.sphere(3), np.arange(642) < 600
        for method in ("Heat", "Eikonal"):
            alone = [sd.distance(sd.sphere(3), source, method=method) for source in (7, 90)]
            for source, expected in zip((7, 90), alone):
                np.testing.assert_array_equal(sd.distance(surface, source, method=method), expected)
            mask = ~inside
            masked = sd.distance(surface, 7, method=method, mask=mask)
            self.assertEqual(np.isinf(masked).sum(), 42)
            mask[:] = False  # edited in place
            np.testing.assert_array_equal(sd.distance(surface, 7, method=method, mask=mask), alone[0])
            np.testing.assert_array_equal(sd.distance(surface, 7, method=method), alone[0])

    def test_other_parts_are_infinitely_far(self):
        a, b = sd.sphere(1), sd.sphere(1)
        surface = (np.concatenate([a.points, b.points + 5.0]),
                   np.concatenate([a.triangles, b.triangles + 42]))
        found = sd.nearest_sources(surface, 0)
        self.assertTrue(np.isfinite(found.distance[:42]).all())
        self.assertTrue(np.isinf(found.distance[42:]).all())
        self.assertTrue((found.source[42:] == -1).all())

    def test_sources_in_another_unit_are_worth_a_warning(self):
        surface = sd.sphere(2)
        places = 1.01 * surface.points[[3, 80, 120]]
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            near = sd.distance(surface, places)
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning,
                                   "^3 of 3 points of the sources are .* their unit or origin may be another"):
            far = sd.distance(surface, 1000 * places)
        np.testing.assert_allclose(far, near, atol=1e-2)

    def test_each_source_counts_for_itself_with_every_method(self):
        points, faces = grid(24)
        sources = np.flatnonzero(np.abs(np.hypot(*(points[:, :2] - 0.5).T) - 0.4) < 0.02)
        exact = np.linalg.norm(points[:, None] - points[sources], axis=2).min(axis=1)
        for method, worst in (("Exact", 1e-12), ("Eikonal", 0.002)):
            for given in (sources, np.isin(np.arange(len(points)), sources)):
                found = sd.nearest_sources((points, faces), given, method=method)
                self.assertEqual(found.method, method)
                np.testing.assert_allclose(found.distance, exact, atol=worst)
                rows = found.source if given.dtype == bool else sources[found.source]
                np.testing.assert_allclose(
                    np.linalg.norm(points - points[rows], axis=1), exact, atol=worst)

    def test_automatic_says_which_method_it_took(self):
        surface = sd.sphere(3)
        self.assertEqual(sd.nearest_sources(surface, 3).method, "Exact")
        self.assertEqual(sd.nearest_sources(surface, 3, speed=np.ones(1280)).method, "Eikonal")
        self.assertEqual(sd.nearest_sources(surface, 3, start=[1.0]).method, "Eikonal")
        self.assertEqual(sd.nearest_sources(surface, 3, method="heat").method, "Heat")

    def test_sources_outside_do_not_count_and_regions_are_the_opposite_of_masks(self):
        surface = sd.sphere(3)
        north = surface.points[:, 2] > 0.0
        south = int(np.argmin(surface.points[:, 2]))
        top = int(np.argmax(surface.points[:, 2]))
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning,
                                   "^1 sources are on no triangle that takes part and do not count"):
            found = sd.nearest_sources(surface, [south, top], roi=north)
        np.testing.assert_array_equal(found.distance, sd.distance(surface, top, mask=~north))
        self.assertEqual(set(found.source), {-1, 1})

    def test_bad_input_names_what_is_allowed(self):
        surface = sd.sphere(1)
        bad = {
            r"sources is \[\]; allowed: rows of points, one or more": dict(sources=[]),
            "sources is 1.5; allowed": dict(sources=1.5),
            "sources has 42; allowed: 0 to 41": dict(sources=[1, 42]),
            "sources has -1; allowed: 0 to 41": dict(sources=-1),
            "^no source is on the surface: 1 are on no triangle that mask and speeds above 0 leave": dict(
                sources=3, mask=np.arange(42) == 3),
            r"sources is array\(\[False.*; allowed: 42 flags, one per point": dict(sources=np.zeros(42, bool)),
            r"sources is array\(\[ True.*; allowed: 42 flags, one per point": dict(sources=np.ones(41, bool)),
            "mask and roi are both given": dict(sources=3, mask=np.zeros(42), roi=np.ones(42)),
            "start is .* 2 finite numbers": dict(sources=[1, 2], start=[0.0, np.nan]),
            "start is .* 1 finite numbers": dict(sources=[1], start=[0.0, 1.0]),
            "speed is -1 at face 4; allowed: finite numbers, 0 or more": dict(
                sources=1, speed=np.where(np.arange(80) == 4, -1.0, 1.0)),
            "method is 'Dijkstra'; allowed: Heat, Eikonal, Exact, Automatic": dict(
                sources=1, method="Dijkstra"),
            "method is Heat; allowed: Eikonal or Automatic together with speed": dict(
                sources=1, method="Heat", speed=np.ones(80)),
            "method is Exact; allowed: Eikonal or Automatic together with start": dict(
                sources=1, method="exact", start=[1.0]),
            r"speed has shape \(5,\)": dict(sources=1, speed=np.ones(5)),
            r"sources is .*; allowed: finite coordinates, \(k, 3\)": dict(sources=[[0, 0, np.nan]]),
            r"sources is \[\[1\], \[2, 3\]\]; allowed": dict(sources=[[1], [2, 3]]),
            r"sources\[0\] has 80; allowed: 0 to 79": dict(sources=([80], [[1, 0, 0]])),
            r"sources\[1\] is .* in row 1; allowed: three": dict(
                sources=([3, 4], [[1, 0, 0], [0.5, 0.6, 0.1]])),
            r"sources\[1\] has shape \(1, 2\); allowed: \(1, 3\)": dict(sources=([3], [[1, 0]])),
            "^no source is on the surface": dict(sources=([3], [[1, 0, 0]]), mask=np.arange(80) == 3),
            "^no source is on the surface: 1 are on": dict(
                sources=surface.points[:1], speed=np.zeros(80)),
            "along_speed is 0; allowed: finite numbers above 0": dict(sources=1, along_speed=0),
            "along_speed is 2 and across_speed is 1 but directions is not set": dict(
                sources=1, along_speed=2),
            "along_speed is -1 at face 3; allowed: finite numbers, 0 or more": dict(
                sources=1, directions=np.ones((42, 3)), along_speed=np.where(np.arange(80) == 3, -1.0, 2.0)),
            r"across_speed has shape \(5,\); allowed: \(42,\)": dict(sources=1, across_speed=np.ones(5)),
            "across_speed is set but directions is not": dict(sources=1, across_speed=np.ones(80)),
            "method is Exact; allowed: Eikonal or Automatic together with across_speed": dict(
                sources=1, method="exact", directions=np.ones((42, 3)), across_speed=np.ones(80)),
            "directions is infinite at point 0": dict(
                sources=1, along_speed=2, directions=np.full((42, 3), np.inf)),
            "method is Heat; allowed: Eikonal or Automatic together with along_speed": dict(
                sources=1, method="Heat", across_speed=2.0),
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
        found = sd.distances(surface, np.arange(642), cutoff=6.0, method="Eikonal")
        self.assertEqual((found.shape, found.format), ((642, 642), "csr"))
        for source in (0, 5, 641):
            expected = sd.distance(surface, source, method="Eikonal")
            near = np.flatnonzero(expected <= 6.0)
            row = slice(found.indptr[source], found.indptr[source + 1])
            np.testing.assert_array_equal(found.indices[row], near)
            np.testing.assert_array_equal(found.data[row], expected[near])
        one = sd.distances(surface, [7])
        np.testing.assert_array_equal(one.toarray()[0], sd.distance(surface, 7))
        with self.assertRaisesRegex(ValueError, "cutoff is 0; allowed: numbers above 0"):
            sd.distances(surface, [7], cutoff=0)
        with self.assertRaisesRegex(ValueError, "method is Heat; allowed: other methods than the heat"):
            sd.distances(surface, [7], method="heat")

    def test_exact_distances_are_symmetric(self):
        points, faces = grid(6)
        points = np.concatenate([points * [1.0, 1.0, 0.0] + np.abs(points[:, :1] - 0.5) * [0, 0, 1.0],
                                 [[9.0, 9.0, 9.0]]])
        found = sd.distances((points, faces), method="Exact")
        self.assertEqual(found.shape, (50, 50))
        self.assertEqual(found.indptr[-1], 49 * 49)  # the row of the point without face is empty
        matrix = found.toarray()
        np.testing.assert_allclose(matrix, matrix.T, atol=1e-13)
        np.testing.assert_array_equal(sd.distances((points, faces), [7, 9], method="Exact").toarray(),
                                      matrix[[7, 9]])

    def test_eikonal_distances_are_symmetric_within_a_cutoff(self):
        ball = sd.sphere(3, 10.0)
        for keywords in ({}, {"speed": 1.0 + (ball.points[:, 2] > 3.0)}):
            rows = sd.distances(ball, np.arange(ball.n_points), cutoff=6.0, method="Eikonal", **keywords).toarray()
            self.assertGreater(abs(rows - rows.T).max(), 1e-3)
            found = sd.distances(ball, cutoff=6.0, method="Eikonal", **keywords)
            matrix = found.toarray()
            np.testing.assert_allclose(matrix, matrix.T, atol=1e-14)
            both = (rows > 0) & (rows.T > 0)
            np.testing.assert_allclose(matrix[both], ((rows + rows.T) / 2)[both], atol=1e-13)
            one = (rows > 0) ^ (rows.T > 0)
            np.testing.assert_allclose(matrix[one], (rows + rows.T)[one], atol=1e-13)
            self.assertEqual(found.nnz, ball.n_points + (both | one).sum())


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
