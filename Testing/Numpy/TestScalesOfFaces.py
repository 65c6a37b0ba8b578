# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Filters by scale and spectra of data at triangles and at hexagons."""

import unittest

import numpy as np
from TestConnectivity import dual

from surfacediffusion import Surface, heat, on_faces, scale_filter, spectrum, sphere


def face_areas(surface):
    """Of the triangles that each face was cut into."""
    corners = surface.points[surface.triangles]
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.bincount(surface._core.faces(), np.linalg.norm(sides, axis=1) / 2, surface.n_faces)


def middles(surface):
    """The directions of the faces' centroids, where smooth values are the means over the faces."""
    corners = surface.points[surface.triangles]
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    moments = np.linalg.norm(sides, axis=1)[:, None] * corners.mean(axis=1)
    found = np.stack([np.bincount(surface._core.faces(), moment, surface.n_faces) for moment in moments.T], axis=1)
    return found / np.linalg.norm(found, axis=1)[:, None]


HEXAGONS = {level: Surface(*dual(level)) for level in (3, 4, 5, 6)}
TRIANGLES = {level: sphere(level) for level in (3, 4, 5)}
RNG = np.random.default_rng(8)


class Filter(unittest.TestCase):
    def test_harmonics_are_scaled_with_an_error_of_second_order(self):
        wave = 2.0
        for name, surfaces in (("triangles", TRIANGLES), ("hexagons", HEXAGONS)):
            for order in (1, 2):
                expected = 1.0 / (1.0 + 2.0 * (12.0 * (wave / (2 * np.pi))**2)**order)
                errors = []
                for surface in list(surfaces.values())[-3:]:
                    values = np.prod(middles(surface), axis=1)  # of degree 3
                    found = scale_filter(surface, values, wave, order=order)
                    errors.append(np.sqrt(np.mean((found - expected * values)**2) / np.mean(values**2)))
                with self.subTest(faces=name, order=order):
                    self.assertLess(errors[2], 5e-4)
                    self.assertGreater(errors[0] / errors[2], 13.0)  # 16 on even meshes
                    self.assertGreater(errors[1] / errors[2], 3.8)

    def test_constants_and_integrals_stay(self):
        for surface in (TRIANGLES[4], HEXAGONS[4]):
            areas = face_areas(surface)
            values = np.stack([np.full(surface.n_faces, 7.0), 3.0 + RNG.normal(size=surface.n_faces)], axis=1)
            for order in (1, 2):
                found = scale_filter(surface, values, 0.5, order=order)
                np.testing.assert_allclose(found[:, 0], 7.0, rtol=1e-12)
                self.assertLess(abs(areas @ (found - values)[:, 1]), 1e-12 * (areas @ abs(values[:, 1])))

    def test_noise_has_the_variance_of_the_filter(self):
        """Of white noise with a value per area a, the variance is the integral of the filter squared over
        the plane of wave numbers, a / (4 pi^2) pi k^2 / 2 for order 1."""
        for surface in (TRIANGLES[5], HEXAGONS[5]):
            area = face_areas(surface).mean()
            wave = 14.0 * np.sqrt(area)
            noise = RNG.normal(size=(surface.n_faces, 24))
            variance = np.mean(scale_filter(surface, noise, wave)**2)
            self.assertLess(abs(variance * 8 * np.pi / (area * (2 * np.pi / wave)**2) - 1), 0.12)

    def test_order_1_is_one_step_of_heat_at_faces(self):
        for surface in (TRIANGLES[4], HEXAGONS[3]):
            values = RNG.normal(size=(surface.n_faces, 2))
            wave = 0.6
            found = scale_filter(surface, values, wave)
            expected = heat(surface, values, time_step=2 * (wave / (2 * np.pi))**2, number_of_time_steps=1,
                            time_integrator="FirstOrder", units="Absolute", tolerance=1e-12)
            np.testing.assert_allclose(found, expected, atol=1e-3)

    def test_land_is_left_out_as_if_it_were_not_there(self):
        surface = HEXAGONS[4]
        land = middles(surface)[:, 2] > 0.4
        values = np.where(land, np.nan, RNG.normal(size=surface.n_faces))
        alone = Surface(surface.points, [face for face, is_land in zip(surface.faces, land) if not is_land])
        for order in (1, 2):
            found = scale_filter(surface, values, 0.7, order=order)
            np.testing.assert_array_equal(np.isnan(found), land)
            np.testing.assert_allclose(found[~land], scale_filter(alone, values[~land], 0.7, order=order),
                                       atol=1e-9)
            known = np.where(land, 5.0, values)
            for mask in (land, on_faces(land)):
                np.testing.assert_array_equal(found, scale_filter(surface, known, 0.7, order=order, mask=mask))
        # A masked point leaves its faces out.
        corners = np.zeros(surface.n_points, bool)
        corners[surface.faces[10]] = True
        found = scale_filter(surface, values, 0.7, mask=corners)
        touched = np.array([corners[face].any() for face in surface.faces])
        np.testing.assert_array_equal(np.isnan(found), land | touched)

    def test_the_place_is_told_where_the_numbers_do_not(self):
        tetrahedron = Surface([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]],
                              [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
        values = np.array([1.0, 2.0, 3.0, 5.0])
        of_points = scale_filter(tetrahedron, values, 8.0)
        of_faces = scale_filter(tetrahedron, values, 8.0, on_faces=True)
        np.testing.assert_array_equal(of_faces, scale_filter(tetrahedron, on_faces(values), 8.0))
        self.assertGreater(abs(of_faces - of_points).max(), 0.1)
        with self.assertRaisesRegex(ValueError, r"^values has shape \(3,\); allowed: .*one row per face"):
            scale_filter(tetrahedron, values[:3], 8.0)

    def test_wavelengths_may_differ_from_point_to_point(self):
        surface = TRIANGLES[4]
        values = RNG.normal(size=surface.n_faces)
        same = scale_filter(surface, values, np.full(surface.n_points, 0.8))
        np.testing.assert_allclose(same, scale_filter(surface, values, 0.8), atol=1e-12)
        wide = scale_filter(surface, values, np.where(surface.points[:, 2] > 0, 1.5, 0.4))
        north = middles(surface)[:, 2]
        self.assertLess(wide[north > 0.3].std(), 0.5 * wide[north < -0.3].std())


class Spectra(unittest.TestCase):
    def test_bands_sum_to_the_variance_and_hold_their_waves(self):
        for surface in (TRIANGLES[5], HEXAGONS[5]):
            areas = face_areas(surface)
            values = 4.0 + np.prod(middles(surface), axis=1)  # of the wavelength 2 pi / sqrt(12) = 1.8
            found = spectrum(surface, values, [0.45, 0.9, 3.6, 7.2])
            mean = areas @ values / areas.sum()
            self.assertAlmostEqual(found.variance.sum() / (areas @ (values - mean)**2 / areas.sum()), 1, places=10)
            self.assertEqual(found.variance.argmax(), 2)
            noisy = spectrum(surface, np.stack([values, RNG.normal(size=surface.n_faces)], axis=1), [0.45, 0.9])
            self.assertEqual(noisy.variance.shape, (3, 2))
            self.assertEqual(noisy.variance[:, 1].argmax(), 0)


if __name__ == "__main__":
    unittest.main()
