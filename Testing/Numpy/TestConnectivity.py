# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Faces as files of meshes of oceans have them: padded rows, points from 1, longitudes and latitudes."""

import pickle
import unittest

import numpy as np

from surfacediffusion import Surface, heat, sphere

BALL = sphere(2)
COUNT = BALL.n_points


def dual(level=3):
    """The hexagons and pentagons around the points of an icosphere: corners (m, 3), and a list of polygons."""
    ball = sphere(level)
    corners = ball.points[ball.triangles].sum(axis=1)
    corners /= np.linalg.norm(corners, axis=1)[:, None]
    around = [[] for _ in range(ball.n_points)]
    for row, triangle in enumerate(ball.triangles):
        for point in triangle:
            around[point].append(row)
    polygons = []
    for point, rows in enumerate(around):
        normal = ball.points[point]
        first = corners[rows[0]] - normal
        u = first - (first @ normal) * normal
        v = np.cross(normal, u)
        sides = corners[rows]
        polygons.append(np.array(rows)[np.argsort(np.arctan2(sides @ v, sides @ u))])
    return corners, polygons


CORNERS, POLYGONS = dual()
WIDE = max(map(len, POLYGONS)) + 1


def padded(fill, start=0, dtype=np.int64):
    rows = np.full((len(POLYGONS), WIDE), fill, dtype)
    for row, polygon in zip(rows, POLYGONS):
        row[:len(polygon)] = polygon + start
    return rows


class Padding(unittest.TestCase):
    def assert_same(self, *faces, **keywords):
        found = Surface(CORNERS, *faces, **keywords)
        expected = Surface(CORNERS, POLYGONS)
        np.testing.assert_array_equal(found._connectivity, expected._connectivity)
        np.testing.assert_array_equal(found._offsets, expected._offsets)
        np.testing.assert_array_equal(found.triangles, expected.triangles)
        return found

    def test_fill_values_of_files_are_found(self):
        self.assertEqual({len(polygon) for polygon in POLYGONS}, {5, 6})
        for fill, dtype in ((-1, np.int32), (-9999, np.int64), (-2**31, np.int32), (-2**63, np.int64),
                            (2**63 - 1, np.int64), (999999, np.int32), (2**32 - 1, np.uint32),
                            (2**64 - 1, np.uint64), (-2147483647, ">i4"), (np.nan, np.float64), (np.nan, np.float32)):
            for start in (0, 1):
                with self.subTest(fill=fill, start=start):
                    self.assert_same(padded(fill, start, dtype))
                    self.assert_same(padded(fill, start, dtype), start_index=start)

    def test_numbers_from_1_may_be_filled_with_0(self):
        self.assert_same(padded(0, 1))
        self.assert_same(padded(0, 1), start_index=1)

    def test_another_fill_value_is_given(self):
        fill = len(CORNERS) + 5
        self.assert_same(padded(fill), fill_value=fill)
        self.assert_same(padded(-1), fill_value=-1, start_index=0)
        self.assert_same(padded(fill, 1, float), fill_value=fill, start_index=1)
        with self.assertRaisesRegex(ValueError, f"faces has {fill} in row 0"):
            Surface(CORNERS, padded(fill))

    def test_masked_arrays_and_variables_are_taken(self):
        self.assert_same(np.ma.masked_equal(padded(77777), 77777))

        class Variable:  # as xarray.DataArray, whose iteration gives others
            def __array__(self, dtype=None, copy=None):
                return padded(np.nan, 1, float)

            def __iter__(self):
                raise AssertionError

        self.assert_same(Variable())

    def test_rows_of_one_length_may_be_floats(self):
        found = Surface(BALL.points, BALL.triangles.astype(float))
        np.testing.assert_array_equal(found.faces, BALL.faces)

    def test_padded_surfaces_are_pickled_and_have_data_on_faces(self):
        surface = self.assert_same(padded(-1, 1))
        values = np.random.default_rng(3).normal(size=len(POLYGONS))
        expected = heat(Surface(CORNERS, POLYGONS), values, fwhm=0.3)
        np.testing.assert_array_equal(heat(surface, values, fwhm=0.3), expected)
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(surface)).triangles, surface.triangles)


class StartIndex(unittest.TestCase):
    def test_numbers_to_n_count_from_1(self):
        for faces in (BALL.triangles + 1, (BALL.triangles + 1).tolist()):
            np.testing.assert_array_equal(Surface(BALL.points, faces).triangles, BALL.triangles)

    def test_numbers_that_do_not_tell_count_from_0_unless_said(self):
        some = BALL.triangles[(BALL.triangles > 0).all(axis=1)]  # no face has the first point
        points = np.vstack([BALL.points, [[0, 0, 0]]])  # nor the last
        np.testing.assert_array_equal(Surface(points, some).triangles, some)
        np.testing.assert_array_equal(Surface(points, some, start_index=1).triangles, some - 1)
        np.testing.assert_array_equal(Surface(BALL.points, some, start_index=0).triangles, some)


class Geography(unittest.TestCase):
    def test_longitudes_and_latitudes_are_places_on_the_sphere(self):
        x, y, z = BALL.points.T
        lon, lat = np.arctan2(y, x), np.arcsin(z)
        for turns in (0, 1):
            found = Surface.from_lonlat(np.degrees(lon) + 360 * turns, np.degrees(lat), BALL.triangles)
            np.testing.assert_allclose(found.points, 6371.0 * BALL.points, atol=1e-9)
        found = Surface.from_lonlat(lon, lat, BALL.triangles + 1, radius=2.0, degrees=False, start_index=1,
                                    areas=BALL.vertex_areas)
        np.testing.assert_allclose(found.points, 2.0 * BALL.points, atol=1e-12)
        np.testing.assert_array_equal(found.vertex_areas, BALL.vertex_areas)

    def test_single_precision_reaches_the_poles(self):
        lat = np.array([np.pi / 2, 0.0, 0.0], np.float32)  # above pi / 2 in double precision
        found = Surface.from_lonlat([0.0, 0.0, 1.0], lat, [[0, 1, 2]], degrees=False)
        self.assertLess(np.hypot(*found.points[0, :2]), 1e-3)
        self.assertAlmostEqual(found.area / 6371.0**2, 0.5 * np.linalg.norm(np.cross(*np.diff(
            found.points / 6371.0, axis=0))), places=12)


if __name__ == "__main__":
    unittest.main()
