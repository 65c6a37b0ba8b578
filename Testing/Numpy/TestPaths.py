# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Shortest paths, disks and signed distances."""

import unittest

import numpy as np

import surfacediffusion as sd

#: The room of 30 x 12 x 12 of the spider and the fly.
ROOM = sd.Surface([[x, y, z] for z in (0, 12) for y in (0, 12) for x in (0, 30)],
                  [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]])


def grid(n):
    """The unit square of n x n quadrilaterals."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    first = (np.arange(n) + (n + 1) * np.arange(n)[:, None]).ravel()
    return (np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()]),
            np.column_stack([first, first + 1, first + n + 2, first + n + 1]))


def rough_ball(seed=0):
    ball = sd.sphere(3)
    noise = np.random.default_rng(seed).uniform(0.8, 1.2, ball.n_points)
    return sd.Surface(ball.points * noise[:, None], ball.faces)


def drawn(points):
    return np.linalg.norm(np.diff(points, axis=0), axis=1).sum()


class Paths(unittest.TestCase):
    def assert_lies_in(self, surface, path):
        """Each segment lies in its face: a triangle, or a planar polygon."""
        self.assertEqual(path.points.shape, (len(path.faces) + 1, 3))
        for k, face in enumerate(path.faces):
            corners = surface.points[np.atleast_1d(surface.faces[face])]
            normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            normal /= np.linalg.norm(normal)
            for x in path.points[k:k + 2]:
                self.assertLess(abs((x - corners[0]) @ normal), 1e-10)
                sides = np.cross(np.roll(corners, -1, axis=0) - corners, x - corners) @ normal
                self.assertGreater(sides.min(), -1e-10)

    def test_paths_are_as_long_as_the_exact_distance(self):
        for surface in (ROOM, rough_ball(), sd.sphere(3)):
            random = np.random.default_rng(1)
            for start in random.integers(surface.n_points, size=4):
                exact = sd.distance(surface, start, method="Exact")
                for end in random.integers(surface.n_points, size=6):
                    path = sd.geodesic_path(surface, start, end)
                    self.assertAlmostEqual(path.length, exact[end], delta=1e-12 * exact.max())
                    self.assertAlmostEqual(drawn(path.points), path.length, delta=1e-11 * exact.max())
                    np.testing.assert_allclose(path.points[[0, -1]], surface.points[[start, end]], atol=1e-12)
                    self.assert_lies_in(surface, path)

    def test_places_are_rows_or_lie_in_triangles_or_are_coordinates(self):
        triangles = sd.Surface(ROOM.points, ROOM.triangles)
        at = (3, [0.25, 0.5, 0.25])
        x = at[1] @ triangles.points[triangles.triangles[3]]
        want = sd.distance(triangles, ([3], [at[1]]), method="Exact")[6]
        for start in (at, (np.int64(3), np.array(at[1])), x, x.tolist()):
            for end in (6, np.int32(6), np.array(6), ROOM.points[6]):
                path = sd.geodesic_path(triangles, start, end)
                self.assertAlmostEqual(path.length, want, delta=1e-12)
                np.testing.assert_allclose(path.points[0], x, atol=1e-12)

    def test_of_a_place_from_itself_and_within_a_face(self):
        for place in (5, [10.0, 3.0, 0.0], [0.0, 0.0, 4.0]):
            path = sd.geodesic_path(ROOM, place, place)
            self.assertEqual((path.points.shape, path.length, path.faces.shape), ((1, 3), 0.0, (0,)))
        path = sd.geodesic_path(ROOM, [10, 1, 0], [13, 1, 0])
        self.assertAlmostEqual(path.length, 3.0, delta=1e-12)
        self.assertEqual(set(path.faces), {0})

    def test_paths_go_around_holes_and_masks(self):
        points, faces = grid(20)
        centres = points[faces].mean(axis=1)[:, :2]
        hole = np.abs(centres - 0.5).max(axis=1) < 0.25
        corner = np.hypot(0.25, 0.25)  # from the middle of a side to the corner of the hole
        for surface, mask in (((points, faces[~hole]), None), ((points, faces), sd.on_faces(hole))):
            path = sd.geodesic_path(surface, [0.0, 0.5, 0.0], [1.0, 0.5, 0.0], mask=mask)
            self.assertAlmostEqual(path.length, 0.5 + 2 * corner, delta=1e-12)
        self.assertAlmostEqual(
            sd.geodesic_path((points, faces), [0.0, 0.5, 0.0], [1.0, 0.5, 0.0]).length, 1.0, delta=1e-12)
        with self.assertRaisesRegex(ValueError, "^start is on no triangle that takes part.* mask .*allowed: "):
            sd.geodesic_path((points, faces), [0.5, 0.5, 0.0], 0, mask=sd.on_faces(hole))

    def test_what_cannot_be_reached_says_what_to_do(self):
        points, faces = grid(2)
        apart = (np.vstack([points, points + [1, 0, 0]]), np.vstack([faces, faces + len(points)]))
        with self.assertRaisesRegex(
                ValueError, "^no path leads from start to end: .*; allowed: .*merge_coincident_points"):
            sd.geodesic_path(apart, 0, 11)
        path = sd.geodesic_path(apart, 0, 11, merge_coincident_points=True)
        self.assertAlmostEqual(path.length, 2.0, delta=1e-12)
        self.assertEqual(set(path.faces), {0, 1, 4, 5})

    def test_places_that_are_not_allowed_are_named(self):
        for place, message in ((8, "start has 8; allowed: 0 to 7"), (1.5, "start is 1.5; allowed: "),
                               ([0, 1], r"start is \[0, 1\]; allowed: "), ("a", "start has elements of type"),
                               ((0, [0.5, 0.5, 0.5]), "start.1. is .*allowed: three numbers"),
                               ((0, [0.5, 0.5]), r"start is \(0, .*; allowed: a row of points"),
                               ((9, [1, 0, 0]), "start.0. has 9; allowed: 0 to 5"),
                               ((0, [1, 0, 0]), "start.0. has face 0 with 4 points; allowed: triangles"),
                               ([0, np.nan, 0], "start is .*allowed: ")):
            with self.assertRaisesRegex(ValueError, message):
                sd.geodesic_path(ROOM, place, 0)
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "^1 of 1 points that are given is farther") as one:
            sd.geodesic_path(ROOM, 0, [60, 0, 0])
        self.assertNotIn("maximum_distance", str(one.warning))
        with self.assertRaisesRegex(ValueError, r"points\[1\] has 99; allowed: 0 to 7"):
            sd.path_through(ROOM, [0, 99])
        for points in ([], np.zeros((0, 3)), 5):
            with self.assertRaisesRegex(ValueError, "points is .*allowed: "):
                sd.path_through(ROOM, points)

    def test_through_several_places(self):
        rows = [0, 3, 6, 5]
        legs = [sd.geodesic_path(ROOM, a, b) for a, b in zip(rows, rows[1:] + rows[:1])]
        for closed, count in ((False, 3), (True, 4)):
            path = sd.path_through(ROOM, rows, closed)
            self.assertAlmostEqual(path.length, sum(leg.length for leg in legs[:count]), delta=1e-11)
            np.testing.assert_array_equal(path.faces, np.concatenate([leg.faces for leg in legs[:count]]))
            self.assert_lies_in(ROOM, path)
            same = sd.path_through(ROOM, ROOM.points[rows], closed)
            self.assertAlmostEqual(same.length, path.length, delta=1e-11)
        mixed = sd.path_through(ROOM, [0, ROOM.points[3], 6, np.array([30.0, 0.0, 12.0])])
        self.assertAlmostEqual(mixed.length, sd.path_through(ROOM, rows).length, delta=1e-11)
        triangles = sd.Surface(ROOM.points, ROOM.triangles)
        first = (np.array([0, 4]), np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]))
        ends = [triangles.triangles[0][0], triangles.triangles[4][1]]
        self.assertAlmostEqual(sd.path_through(triangles, first).length,
                               sd.path_through(triangles, ends).length, delta=1e-11)
        self.assertEqual(sd.path_through(ROOM, [4]).length, 0.0)


class Disks(unittest.TestCase):
    def test_at_a_corner_of_a_cube_it_is_three_quarters(self):
        disk = sd.geodesic_disk(ROOM, 0, 5.0)
        self.assertAlmostEqual(disk.area, 0.75 * np.pi * 25, delta=0.1)
        whole = sd.geodesic_disk(ROOM, 0, 100.0)
        self.assertAlmostEqual(whole.area, 2 * (12 * 12 + 2 * 12 * 30), delta=1e-9)
        self.assertEqual(whole.boundary, [])

    def test_the_radius_is_above_0(self):
        for radius in (0.0, -1.0, np.inf, np.nan):
            with self.assertRaisesRegex(ValueError, "radius is .*allowed: "):
                sd.geodesic_disk(ROOM, 0, radius)


class SignedDistances(unittest.TestCase):
    def setUp(self):
        self.ball = sd.sphere(4)
        self.latitude = np.arcsin(np.clip(self.ball.points[:, 2], -1, 1))

    def assert_near(self, found, right, mean, largest):
        errors = np.abs(found - right) / np.abs(right).max()
        self.assertLess(errors.mean(), mean)
        self.assertLess(errors.max(), largest)

    def test_to_a_region_is_below_0_within(self):
        inside = self.latitude > 0.4
        for method in ("Exact", "Eikonal", "Heat"):
            found = sd.distance(self.ball, inside, signed=True, method=method)
            np.testing.assert_array_equal(found < 0, inside)
            self.assert_near(found, 0.4 - self.latitude, 0.007, 0.03)
        coarse = sd.sphere(3)  # 642 points
        errors = []
        for seed in range(20):
            random = np.random.default_rng(seed)
            axis, least = random.normal(size=3), random.uniform(-0.9, 0.9)
            latitude = np.arcsin(np.clip(coarse.points @ axis / np.linalg.norm(axis), -1, 1))
            found = sd.distance(coarse, latitude > least, signed=True)
            errors.append(np.abs(found - (least - latitude)) / np.abs(least - latitude).max())
        print(f"642 points: mean {np.mean(errors):.4f}, largest {np.max(errors):.4f}")
        self.assertLess(np.mean(errors), 0.01)
        self.assertLess(np.max(errors), 0.03)
        nearest = sd.nearest_sources(self.ball, np.flatnonzero(inside), signed=True)
        self.assertTrue(((0 <= nearest.source) & (nearest.source < inside.sum())).all())
        near = np.linalg.norm(self.ball.points - self.ball.points[inside][nearest.source], axis=1)
        edge = 0.08  # the points named are those of the region beside the boundary
        self.assertTrue((near[~inside] < nearest.distance[~inside] + edge).all())

    def test_to_a_curve_is_below_0_on_the_smaller_side(self):
        angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
        for latitude, sign in ((0.6, 1.0), (-0.3, -1.0)):
            curve = np.column_stack([np.cos(latitude) * np.cos(angles), np.cos(latitude) * np.sin(angles),
                                     np.full(60, np.sin(latitude))])
            found = sd.distance(self.ball, curve, signed=True)
            self.assert_near(found, sign * (latitude - self.latitude), 0.003, 0.006)
            again = sd.distance(self.ball, np.roll(curve[::-1], 7, axis=0), signed=True)
            np.testing.assert_allclose(again, found, atol=1e-9)

    def test_it_needs_a_region_or_a_curve_with_two_sides(self):
        with self.assertRaisesRegex(ValueError, "has no boundary.*allowed together with signed"):
            sd.distance(self.ball, np.ones(self.ball.n_points, bool), signed=True)
        with self.assertRaisesRegex(ValueError, "sources is .*allowed with signed=True"):
            sd.distance(self.ball, ([0], [[1, 0, 0]]), signed=True)
        with self.assertRaisesRegex(ValueError, "sources is .*allowed with signed=True"):
            sd.distance(self.ball, self.ball.points[:2], signed=True)
        with self.assertRaisesRegex(ValueError, "signed is True; allowed: False together with speeds"):
            sd.distance(self.ball, self.latitude > 0, signed=True, speed=np.ones(self.ball.n_points))
        around, across = np.meshgrid(np.arange(24), np.arange(12))
        u, v = 2 * np.pi * around.ravel() / 24, 2 * np.pi * across.ravel() / 12
        points = np.column_stack([(2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)])
        i, j = around.ravel(), across.ravel()
        row = lambda i, j: i % 24 + 24 * (j % 12)
        faces = np.column_stack([row(i, j), row(i + 1, j), row(i + 1, j + 1), row(i, j + 1)])
        tube = points[row(0, np.arange(12))]
        with self.assertRaisesRegex(ValueError, "do not divide the surface into two sides"):
            sd.distance((points, faces), tube, signed=True)


if __name__ == "__main__":
    unittest.main()
