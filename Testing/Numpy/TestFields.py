# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Random fields, surrogates of maps, and filters by scale."""

import doctest
import importlib
import sys
import unittest
import warnings

import numpy as np

import surfacediffusion as sd

RADIUS = 100.0
BALL = sd.sphere(4, RADIUS)
CAP = BALL.points[:, 2] < -0.3 * RADIUS  #: outside of a surface with a boundary


def warnings_of(function, *arguments, **keywords):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        result = function(*arguments, **keywords)
    return result, [str(warning.message) for warning in caught]


class RandomField(unittest.TestCase):
    def test_without_normalize_boundaries_have_twice_the_variance(self):
        fields = sd.random_field(BALL, 500, fwhm=30.0, mask=CAP, normalize=False)
        variances = np.mean(fields**2, axis=1)
        height = BALL.points[:, 2] / RADIUS
        rim = (height > -0.31) & (height < -0.25) & np.isfinite(variances)
        self.assertAlmostEqual(variances[rim].mean(), 2.0, delta=0.25)
        self.assertAlmostEqual(variances[height > 0.3].mean(), 1.0, delta=0.1)

    def test_width_is_that_of_estimate_fwhm(self):
        surface = sd.sphere(5, RADIUS)
        for fwhm in (30.0, 50.0):
            fields = sd.random_field(surface, 200, fwhm=fwhm)
            self.assertAlmostEqual(sd.estimate_fwhm(surface, fields).pooled / fwhm, 1.0, delta=0.02)

    def test_fields_are_those_of_their_numbers(self):
        many = sd.random_field(BALL, 40, fwhm=30.0)
        self.assertTrue(np.array_equal(many[:, 17:19], sd.random_field(BALL, 2, fwhm=30.0, first=17)))
        other = sd.random_field(BALL, 40, fwhm=30.0, seed=1)
        correlations = [np.corrcoef(a, b)[0, 1] for a, b in zip(many.T, other.T)]
        self.assertLess(abs(np.mean(correlations)), 0.1)
        before = sd.get_number_of_threads()
        try:
            sd.set_number_of_threads(3)
            again = sd.random_field((BALL.points, BALL.faces), 40, fwhm=30.0)
        finally:
            sd.set_number_of_threads(before)
        self.assertTrue(np.array_equal(many, again))

    def test_numbering_does_not_matter(self):
        order = np.random.default_rng(0).permutation(BALL.n_points)
        place = np.argsort(order)
        renumbered = sd.Surface(BALL.points[order], place[BALL.faces])
        for keywords in ({"fwhm": 30.0}, {"range": 60.0, "nu": 3}):
            fields = sd.random_field(BALL, 3, **keywords)
            np.testing.assert_allclose(
                sd.random_field(renumbered, 3, **keywords), fields[order], atol=1e-8)

    def test_units_and_offsets_do_not_matter(self):
        fields = sd.random_field(BALL, 2, fwhm=30.0)
        self.assertTrue(np.isfinite(fields).all())
        for factor in (1e-6, 1e6):
            scaled = sd.random_field((BALL.points * factor, BALL.faces), 50, fwhm=30.0 * factor)
            self.assertAlmostEqual(scaled.std(), 1.0, delta=0.03)

    def test_left_out_points_are_nan_and_roi_is_the_opposite(self):
        fields = sd.random_field(BALL, 2, fwhm=30.0, mask=CAP)
        np.testing.assert_array_equal(np.isnan(fields[:, 0]) | ~CAP, True)
        self.assertTrue(np.array_equal(
            fields, sd.random_field(BALL, 2, fwhm=30.0, roi=~CAP), equal_nan=True))
        lonely = sd.Surface(np.vstack([BALL.points, [[500.0, 0.0, 0.0]]]), BALL.faces)
        self.assertTrue(np.isnan(sd.random_field(lonely, 1, fwhm=30.0)[-1, 0]))

    def test_two_surfaces_of_other_sizes_have_variance_one_each(self):
        small = sd.sphere(2, 5.0)
        points = np.vstack([BALL.points, small.points + [300.0, 0.0, 0.0]])
        faces = np.vstack([BALL.faces, small.faces + BALL.n_points])
        fields = sd.random_field((points, faces), 500, fwhm=30.0)
        variances = np.mean(fields**2, axis=1)
        self.assertAlmostEqual(variances[:BALL.n_points].mean(), 1.0, delta=0.03)
        # The field is all but constant on the small one: one number of each field, +- 0.063.
        self.assertAlmostEqual(variances[BALL.n_points:].mean(), 1.0, delta=0.3)
        self.assertLess(fields[BALL.n_points:].std(axis=0).max(), 0.1)

    def test_a_width_below_two_edges_is_reported(self):
        fields, found = warnings_of(sd.random_field, BALL, 20, fwhm=1.0)
        self.assertEqual(len(found), 1)
        self.assertRegex(found[0], "^fwhm is 1, below two mean edges of 7.5")
        self.assertAlmostEqual(fields.std(), 1.0, delta=0.02)
        self.assertEqual(warnings_of(sd.random_field, BALL, 1, fwhm=20.0)[1], [])

    def test_what_is_not_allowed_is_named(self):
        for pattern, keywords in (
                ("fwhm and range are not given", {}),
                ("fwhm and range are both given", {"fwhm": 9.0, "range": 9.0}),
                ("fwhm is -1; allowed: finite numbers above 0", {"fwhm": -1}),
                ("range is nan; allowed", {"range": float("nan")}),
                ("nu is 5; allowed: numbers above 0, up to 4", {"range": 9.0, "nu": 5}),
                ("nu is 3; allowed: 1, or range", {"fwhm": 9.0, "nu": 3}),
                ("n is 0; allowed: whole numbers, 1 or more", {"fwhm": 9.0, "n": 0}),
                ("first is -1; allowed: whole numbers, 0 or more, below 2\\^39", {"fwhm": 9.0, "first": -1}),
                ("seed is 0.5; allowed: whole numbers", {"fwhm": 9.0, "seed": 0.5}),
                ("normalize is 1; allowed: True or False", {"fwhm": 9.0, "normalize": 1}),
                ("mask and roi are both given", {"fwhm": 9.0, "mask": CAP, "roi": CAP}),
                ("no triangle of the surface is left", {"fwhm": 9.0, "mask": CAP | True})):
            with self.assertRaisesRegex(ValueError, pattern):
                sd.random_field(BALL, **keywords)

    def test_a_callable_cannot_use_the_surface_whose_work_it_reports(self):
        surface = sd.sphere(6)
        with self.assertRaisesRegex(RuntimeError, "progress uses the surface whose work it reports"):
            sd.random_field(surface, 300, fwhm=0.2,
                            progress=lambda _: sd.random_field(surface, 1, fwhm=0.3))
        values = surface.points[:, 2]
        with self.assertRaisesRegex(RuntimeError, "progress uses the surface whose work it reports"):
            sd.heat(surface, values, fwhm=0.2, number_of_time_steps=100,
                    progress=lambda _: sd.heat(surface, values, fwhm=0.3))
        self.assertTrue(np.isfinite(sd.heat(surface, values, fwhm=0.3)).all())
        self.assertTrue(np.isfinite(sd.random_field(surface, 1, fwhm=0.3)).all())

    def test_parts_without_area_and_smaller_than_the_width_have_variance_one(self):
        for height, edge in ((1e-6, 1.0), (1e-5, 1e-5), (1e-2, 1e-2)):
            triangle = np.array([[0, 0, 0], [edge, 0, 0], [0.5 * edge, height, 0]]) + [300.0, 0.0, 0.0]
            points = np.vstack([BALL.points, triangle])
            faces = np.vstack([BALL.faces, np.arange(3) + BALL.n_points])
            for keywords in ({"fwhm": 30.0}, {"range": 60.0}):
                fields, _ = warnings_of(sd.random_field, (points, faces), 200, **keywords)
                self.assertAlmostEqual(np.sqrt(np.mean(fields[:-3]**2)), 1.0, delta=0.05)
                found = np.sqrt(np.mean(fields[-3:]**2))
                self.assertTrue(0.7 < found < 1.4, (height, edge, keywords, found))
        wide = sd.random_field(BALL, 300, fwhm=1e6)
        self.assertAlmostEqual(np.sqrt(np.mean(wide**2)), 1.0, delta=0.15)

    def test_given_areas_are_those_of_edges_and_widths(self):
        inflated = sd.Surface(BALL.points, BALL.faces, np.array(BALL.vertex_areas) * 1e4)
        field = sd.random_field(inflated, 1, fwhm=3000.0, seed=2)[:, 0]
        found = sd.surrogates(inflated, field, 3)
        self.assertLess(found.variances[-1], 0.1)
        with self.assertRaisesRegex(ValueError, "fwhm is 1e-07; allowed: "):
            sd.random_field(BALL, fwhm=1e-7)

    def test_a_callable_ends_the_work(self):
        fractions = []

        def stop(fraction):
            fractions.append(fraction)
            raise RuntimeError("enough")

        surface = sd.sphere(6)
        with self.assertRaisesRegex(RuntimeError, "enough"):
            sd.random_field(surface, 500, fwhm=0.2, progress=stop)
        self.assertLess(fractions[0], 0.9)
        self.assertTrue(np.isfinite(sd.random_field(surface, 1, fwhm=0.2)).all())


class MaternOfAnySmoothness(unittest.TestCase):
    def test_covariance_is_that_of_the_dense_operator(self):
        """Over many fields of two connected components of other sizes; exact in TestFields.cxx."""
        torus = sd.sphere(2, 30.0)
        points = np.vstack([sd.sphere(3, RADIUS).points, torus.points + [300.0, 0.0, 0.0]])
        faces = np.vstack([sd.sphere(3, RADIUS).faces, torus.faces + 642])
        surface = sd.Surface(points, faces)
        for nu in (0.5, 2.0, 3.3):
            fields = sd.random_field(surface, 2000, range=120.0, nu=nu, seed=4)
            np.testing.assert_allclose(np.mean(fields**2, axis=1), 1.0, atol=0.2)
            self.assertAlmostEqual(np.mean(fields**2), 1.0, delta=0.02)
            r = np.linalg.norm(points[0] - points, axis=1)
            near = np.argsort(r)[1:60]
            found = fields[near] @ fields[0] / 2000
            self.assertGreater(np.corrcoef(found, -r[near])[0, 1], 0.9)
            self.assertLess(np.abs(fields[642:] @ fields[0] / 2000).max(), 0.1)

    def test_smoother_fields_have_smaller_differences(self):
        rough = [np.var(np.diff(sd.random_field(BALL, 200, range=90.0, nu=nu)[BALL.faces[:, :2]], axis=1))
                 for nu in (0.25, 0.5, 1.0, 1.5, 2.5, 4.0)]
        self.assertTrue((np.diff(rough) < 0).all(), rough)

    def test_ranges_differ_from_place_to_place(self):
        north = BALL.points[:, 2] > 0
        for nu in (1, 1.5):
            fields = sd.random_field(BALL, 300, range=np.where(north, 150.0, 40.0), nu=nu)
            self.assertAlmostEqual(np.mean(fields**2), 1.0, delta=0.03)
            widths = [np.var(np.diff(fields[BALL.faces[inside[BALL.faces].all(axis=1)][:, :2]], axis=1))
                      for inside in (BALL.points[:, 2] > 30, BALL.points[:, 2] < -30)]
            self.assertGreater(widths[1], 5 * widths[0])
            np.testing.assert_allclose(
                sd.random_field(BALL, 3, range=np.full(BALL.n_points, 60.0), nu=nu),
                sd.random_field(BALL, 3, range=60.0, nu=nu), atol=5e-3)
        for pattern, ranges in (("range is from 1 to 50; allowed: a largest one of at most 10 times the smallest",
                                 np.where(north, 1.0, 50.0)),
                                ("range is nan in row 3", np.where(np.arange(2562) == 3, np.nan, 50.0)),
                                ("range has shape \\(5,\\); allowed: a number, or \\(2562,\\)", np.ones(5))):
            with self.assertRaisesRegex(ValueError, pattern), warnings.catch_warnings():
                warnings.simplefilter("ignore")
                sd.random_field(BALL, range=ranges)


class OnFaces(unittest.TestCase):
    def test_have_variance_one_and_the_correlation_of_points(self):
        surface = sd.sphere(3, RADIUS)
        squares = sd.Surface(*quads(24, 18))
        for keywords in ({"fwhm": 60.0}, {"range": 90.0, "nu": 1.5}):
            for mesh in (surface, squares):
                fields = sd.random_field(mesh, 1500, on_faces=True, **keywords)
                self.assertEqual(fields.shape, (mesh.n_faces, 1500))
                self.assertAlmostEqual(np.mean(fields**2), 1.0, delta=0.03)
                np.testing.assert_allclose(np.mean(fields**2, axis=1), 1.0, atol=0.25)
        fields = sd.random_field(surface, 1500, fwhm=60.0, on_faces=True)
        centres = surface.points[surface.faces].mean(axis=1)
        r = np.linalg.norm(centres - centres[0], axis=1)
        near = r < 60
        expected = np.exp(-2 * np.log(2) * (r[near] / 60.0)**2)
        np.testing.assert_allclose(fields[near] @ fields[0] / 1500, expected, atol=0.12)

    def test_masks_leave_whole_faces_out(self):
        surface = sd.sphere(3, RADIUS)
        for mask, outside in ((surface.points[:, 2] < 0, (surface.points[:, 2] < 0)[surface.faces].any(axis=1)),
                              (sd.on_faces(np.arange(surface.n_faces) % 7 == 0),
                               np.arange(surface.n_faces) % 7 == 0)):
            fields = sd.random_field(surface, 2, fwhm=60.0, on_faces=True, mask=mask)
            np.testing.assert_array_equal(np.isnan(fields[:, 0]), outside)


def quads(width, height):
    """A sheet of squares, 10 wide each, and a line of points of no square."""
    x, y = np.meshgrid(np.arange(width + 1), np.arange(height + 1))
    points = 10.0 * np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    first = (np.arange(height)[:, None] * (width + 1) + np.arange(width)).ravel()
    return points, np.stack([first, first + 1, first + width + 2, first + width + 1], axis=1)


class ScaleFilter(unittest.TestCase):
    def test_order_one_is_a_step_of_heat(self):
        values = sd.random_field(BALL, 3, fwhm=20.0)
        wavelength = 80.0
        step = 2.0 * (wavelength / (2.0 * np.pi)) ** 2
        expected = sd.heat(BALL, values, time_step=step, number_of_time_steps=1, units="absolute",
                           time_integrator="first_order", tolerance=1e-12)
        np.testing.assert_allclose(sd.scale_filter(BALL, values, wavelength), expected, atol=1e-9)

    def test_keeps_integrals_and_constants_and_leaves_land_out(self):
        values = sd.random_field(BALL, 1, fwhm=20.0)[:, 0] + 1e4
        areas = np.array(BALL.vertex_areas)
        for order in (1, 2):
            found = sd.scale_filter(BALL, values, 100.0, order=order)
            self.assertLess(abs(areas @ (found - values)), 1e-13 * areas.sum() * 1e4)
            land = np.where(CAP, np.nan, 7.0)
            found = sd.scale_filter(BALL, land, 100.0, order=order)
            np.testing.assert_array_equal(np.isnan(found), CAP)
            np.testing.assert_allclose(found[~CAP & np.isfinite(found)], 7.0, rtol=1e-14)

    def test_wavelengths_of_points_act_where_they_are(self):
        values = np.random.default_rng(2).normal(size=BALL.n_points)
        north = BALL.points[:, 2] > 0.0
        found = sd.scale_filter(BALL, values, np.where(north, 20.0, 200.0))
        self.assertGreater(found[BALL.points[:, 2] > 30].std(), 4 * found[BALL.points[:, 2] < -30].std())

    def test_masks_of_faces_join_missing_points(self):
        values = np.where(BALL.points[:, 0] > 90.0, np.nan, BALL.points[:, 1])
        centres = BALL.points[BALL.faces].mean(axis=1)
        found = sd.scale_filter(BALL, values, 60.0, mask=centres[:, 2] < -50.0)
        self.assertTrue(np.isnan(found[BALL.points[:, 0] > 90.0]).all())
        self.assertTrue(np.isnan(found[BALL.points[:, 2] < -60.0]).all())
        self.assertTrue(np.isfinite(found[(BALL.points[:, 0] < 80.0) & (BALL.points[:, 2] > -40.0)]).all())

    def test_spectrum_adds_up_and_finds_the_scale(self):
        surface = sd.sphere(5, RADIUS)
        l = 8  # a zonal harmonic, whose wavelength is 2 pi R / sqrt(l (l + 1))
        x = surface.points[:, 2] / RADIUS
        values = np.polynomial.legendre.legval(x, np.eye(l + 1)[l])
        wavelength = 2.0 * np.pi * RADIUS / np.sqrt(l * (l + 1))
        bounds = wavelength * 2.0 ** np.arange(-3.0, 4.0)
        found = sd.spectrum(surface, values, bounds)
        areas = np.array(surface.vertex_areas)
        variance = np.average((values - np.average(values, weights=areas))**2, weights=areas)
        self.assertAlmostEqual(found.variance.sum() / variance, 1.0, delta=1e-12)
        # With order 2 a wave of this length goes between half of it and itself: 1 / 1.125^2 - 1 / 9.
        self.assertAlmostEqual(found.variance[3] / variance, 1 / 1.125**2 - 1 / 9, delta=0.02)
        self.assertEqual(sd.spectrum(surface, np.column_stack([values, values]), bounds).variance.shape,
                         (8, 2))

    def test_what_is_not_allowed_is_named(self):
        values = BALL.points[:, 0]
        for pattern, arguments, keywords in (
                ("wavelength is 0.0; allowed: finite numbers above 0", (values, 0), {}),
                ("wavelength is nan in row 3", (values, np.where(np.arange(2562) == 3, np.nan, 9)), {}),
                ("wavelength has shape \\(2,\\)", (values, [1, 2]), {}),
                ("order is 3; allowed: 1 and 2", (values, 50.0), {"order": 3}),
                ("values has shape", (values[1:], 50.0), {})):
            with self.assertRaisesRegex(ValueError, pattern):
                sd.scale_filter(BALL, *arguments, **keywords)
        for wavelengths in ([2.0, 1.0], [], [[1.0]], [-1.0, 2.0], 5.0):
            with self.assertRaisesRegex(ValueError, "wavelengths is"):
                sd.spectrum(BALL, values, wavelengths)


class Examples(unittest.TestCase):
    def test_hold(self):
        for name in ("_fields", "_scales", "_surrogates"):
            module = importlib.import_module(f"surfacediffusion.{name}")
            result = doctest.testmod(module)
            self.assertEqual(result.failed, 0)
            self.assertGreater(result.attempted, 3)


if __name__ == "__main__":
    sys.exit(unittest.main())
