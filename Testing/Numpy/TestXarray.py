# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Data of xarray, uxarray and xugrid by their attributes, and masks that differ by column."""

import sys
import unittest
import warnings
from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np
from TestConnectivity import dual

import surfacediffusion as sd
from surfacediffusion.xarray import scale_filter, surface_of

HEXAGONS = sd.Surface(*dual(3))
RNG = np.random.default_rng(4)
EARTH = 6371.0


@dataclass
class Array:
    """What a DataArray has of all that is used here."""

    values: np.ndarray
    dims: tuple
    attrs: dict = field(default_factory=dict)
    uxgrid: object = None

    @property
    def shape(self):
        return self.values.shape

    def copy(self, data):
        return replace(self, values=data)


def padded(surface, fill):
    found = np.full((surface.n_faces, 6), fill)
    for row, face in zip(found, surface.faces):
        row[:len(face)] = face
    return found


def degrees(points):
    x, y, z = (points / np.linalg.norm(points, axis=1)[:, None]).T
    return np.degrees(np.arctan2(y, x)), np.degrees(np.arcsin(z))


class ScaleFilter(unittest.TestCase):
    def test_other_dimensions_stay_where_they_are(self):
        values = RNG.normal(size=(2, HEXAGONS.n_faces, 3))
        found = scale_filter(Array(values, ("time", "face", "depth"), {"units": "K"}), 0.9, surface=HEXAGONS, order=2)
        self.assertEqual((found.dims, found.attrs, found.shape),
                         (("time", "face", "depth"), {"units": "K"}, values.shape))
        for time in range(2):
            for depth in range(3):
                np.testing.assert_allclose(found.values[time, :, depth],
                                           sd.scale_filter(HEXAGONS, values[time, :, depth], 0.9, order=2), atol=1e-12)

    def test_each_depth_has_its_land(self):
        height = np.stack([HEXAGONS.points[face].mean(axis=0)[2] for face in HEXAGONS.faces])
        values = RNG.normal(size=(4, HEXAGONS.n_faces, 3))
        for depth in range(3):
            values[:, height > 0.7 - 0.4 * depth, depth] = np.nan
        values[:, :, 2] = np.nan  # no sea
        found = scale_filter(Array(values, ("time", "n_face", "depth")), 0.9, surface=HEXAGONS).values
        np.testing.assert_array_equal(np.isnan(found), np.isnan(values))
        for depth in range(2):
            np.testing.assert_allclose(found[1, :, depth], sd.scale_filter(HEXAGONS, values[1, :, depth], 0.9),
                                       atol=1e-12)

    def test_undecoded_fill_values_are_land(self):
        values = RNG.normal(size=HEXAGONS.n_faces).astype(np.float32)
        values[:40] = np.nan
        filled = Array(np.nan_to_num(values, nan=-9999.9), ("n_face",))
        filled.attrs = {"units": "K", "_FillValue": np.float32(-9999.9)}
        np.testing.assert_array_equal(scale_filter(filled, 0.9, surface=HEXAGONS).values,
                                      scale_filter(Array(values, ("n_face",)), 0.9, surface=HEXAGONS).values)

    def test_grids_of_uxarray_and_xugrid(self):
        lon, lat = degrees(HEXAGONS.points)
        values = RNG.normal(size=HEXAGONS.n_faces)
        big = -np.iinfo(np.int64).max - 1
        grid = SimpleNamespace(node_lon=SimpleNamespace(values=lon), node_lat=SimpleNamespace(values=lat),
                               face_node_connectivity=SimpleNamespace(values=padded(HEXAGONS, big),
                                                                      attrs={"_FillValue": big}))
        expected = sd.scale_filter(sd.Surface.from_lonlat(lon, lat, HEXAGONS.faces), values, 5000.0)
        found = scale_filter(Array(values, ("n_face",), uxgrid=grid), 5000.0)
        np.testing.assert_allclose(found.values, expected, atol=1e-7)
        for geographic in (True, False):
            mesh = SimpleNamespace(node_x=lon, node_y=lat, face_node_connectivity=padded(HEXAGONS, -1), fill_value=-1,
                                   is_geographic=geographic)
            surface = surface_of(SimpleNamespace(ugrid=SimpleNamespace(grid=mesh)))
            self.assertEqual(surface.n_faces, HEXAGONS.n_faces)
            np.testing.assert_allclose(surface.points, EARTH * HEXAGONS.points if geographic else
                                       np.column_stack([lon, lat, 0 * lon]), atol=1e-8)

    def test_what_is_not_allowed_is_named(self):
        for array, options, pattern in (
                (Array(np.ones(7), ("x",)), {"surface": HEXAGONS}, "data has sizes x 7; allowed: a dimension of 642 "
                 "faces or 1280 points"),
                (Array(np.ones((642, 642)), ("a", "b")), {"surface": HEXAGONS}, "data has dimensions a and b of 642"),
                (Array(np.ones(642), ("a",)), {"surface": HEXAGONS, "dim": "b"}, "dim is 'b'; allowed: a"),
                (Array(np.ones(642), ("a",)), {}, "surface is not given, and 'Array' has none")):
            with self.assertRaisesRegex(ValueError, pattern):
                scale_filter(array, 0.9, **options)

    def test_data_array_of_xarray(self):
        import xarray

        given = xarray.DataArray(RNG.normal(size=(3, HEXAGONS.n_faces)), dims=("time", "face"), name="sst",
                                 coords={"time": [5, 6, 7], "lon": ("face", np.arange(642.0))}, attrs={"units": "K"})
        found = scale_filter(given, 0.9, surface=HEXAGONS)
        xarray.testing.assert_identical(found.copy(data=given.values), given)
        np.testing.assert_allclose(found.values.T, sd.scale_filter(HEXAGONS, given.values.T, 0.9), atol=1e-12)


class Columns(unittest.TestCase):
    def test_each_column_is_filtered_where_it_is_known(self):
        ball = sd.sphere(3)
        values = RNG.normal(size=(ball.n_points, 6))
        values[ball.points[:, 2] > 0.5, 1::2] = np.nan
        values[3, 4] = np.nan
        for keywords in ({}, {"order": 2, "mask": ball.points[:, 0] > 0.6}):
            found = sd.scale_filter(ball, values, 1.1, **keywords)
            for k, column in enumerate(values.T):
                np.testing.assert_allclose(found[:, k], sd.scale_filter(ball, column, 1.1, **keywords), atol=1e-12)

    def test_a_width_is_warned_of_once(self):
        ball = sd.sphere(3)
        values = RNG.normal(size=(ball.n_points, 3))
        values[np.arange(3), np.arange(3)] = np.nan
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            sd.scale_filter(ball, values, 0.05)
        self.assertEqual(len(caught), 1)


if __name__ == "__main__":
    sys.exit(unittest.main())
