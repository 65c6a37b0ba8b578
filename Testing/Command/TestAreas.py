# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Areas of vertices that are given in place of those of the triangles (Surface(..., areas=...))."""

import pickle
import unittest

import numpy as np
from samples import FACES, N, NOISE, POINTS

from surfacediffusion import Surface, heat, heat_steps
from surfacediffusion.command.areas import vertex_areas
from surfacediffusion.files import SurfaceFile

AREAS = vertex_areas(SurfaceFile("", "off", POINTS, FACES))
VALUES = NOISE.astype(float)
RANDOM = AREAS * np.random.default_rng(9).uniform(0.5, 2, N)


class Areas(unittest.TestCase):
    def test_those_of_the_triangles_change_nothing(self):
        np.testing.assert_allclose(heat(Surface(POINTS, FACES, AREAS), VALUES, fwhm=6),
                                   heat((POINTS, FACES), VALUES, fwhm=6), rtol=1e-12)

    def test_four_times_the_areas_are_twice_the_lengths(self):
        np.testing.assert_allclose(heat(Surface(POINTS, FACES, 4 * AREAS), VALUES, fwhm=6),
                                   heat((2 * POINTS, FACES), VALUES, fwhm=6), rtol=1e-10)

    def test_the_integral_over_these_areas_is_kept(self):
        for surface in (Surface(POINTS, FACES, RANDOM),
                        pickle.loads(pickle.dumps(Surface(POINTS, FACES, RANDOM)))):
            result = heat_steps(surface, VALUES, fwhm=6).last()
            self.assertAlmostEqual(RANDOM @ result.values, RANDOM @ VALUES, delta=1e-9)
            np.testing.assert_allclose(result.history["Total_0"], RANDOM @ VALUES, rtol=1e-12)

    def test_in_a_region_the_cells_keep_their_share(self):
        excluded = POINTS[:, 2] < 0
        options = {"mask": excluded, "mask_mode": "Exclude", "fwhm": 6}
        np.testing.assert_allclose(heat(Surface(POINTS, FACES, 4 * AREAS), VALUES, **options),
                                   heat((2 * POINTS, FACES), VALUES, **options), rtol=1e-10)

    def test_wrong_areas_are_errors(self):
        zero, nan = AREAS.copy(), AREAS.copy()
        zero[7], nan[7] = 0, np.nan
        for areas, message in ((AREAS[1:], r"areas has shape \(161,\); allowed: \(162,\)"),
                               (zero, "areas has 0.0 at point 7; allowed: finite numbers above 0"),
                               (nan, "areas has nan at point 7")):
            with self.assertRaisesRegex(ValueError, message):
                Surface(POINTS, FACES, areas)
        with self.assertRaisesRegex((ValueError, RuntimeError), "allowed: False on surfaces with given"):
            heat(Surface(POINTS, FACES, AREAS), VALUES, fwhm=6, intrinsic_delaunay=True)


if __name__ == "__main__":
    unittest.main(verbosity=2)
