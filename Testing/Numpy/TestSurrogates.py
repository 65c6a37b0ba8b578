# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surrogates of maps at points, at faces and of parcels."""

import sys
import unittest

import numpy as np

import surfacediffusion as sd

RADIUS = 100.0
BALL = sd.sphere(4, RADIUS)
CAP = BALL.points[:, 2] < -0.3 * RADIUS  #: outside of a surface with a boundary


def parcels_of(surface, count, seed=5):
    """Numbers from 1 of the nearest of random directions."""
    seeds = np.random.default_rng(seed).normal(size=(count, 3))
    return 1 + np.argmax(surface.points @ (seeds / np.linalg.norm(seeds, axis=1)[:, None]).T, axis=1)


def means(labels, fields):
    return np.stack([fields[labels == number].mean(axis=0) for number in np.unique(labels[labels != 0])])


class Surrogates(unittest.TestCase):
    def test_have_the_values_of_the_map_bit_by_bit(self):
        values = np.exp(sd.random_field(BALL, 1, fwhm=50.0, seed=3)[:, 0])
        values[::7] = 0.0  # ties
        values[CAP] = np.nan
        found = sd.surrogates(BALL, values, 5, seed=1)
        self.assertEqual(found.values.shape, (BALL.n_points, 5))
        for column in found.values.T:
            np.testing.assert_array_equal(np.isnan(column), np.isnan(values))
            np.testing.assert_array_equal(np.sort(column[~CAP]), np.sort(values[~CAP]))
            self.assertLess(abs(np.corrcoef(column[~CAP], values[~CAP])[0, 1]), 0.6)

    def test_have_the_smoothness_of_the_map(self):
        noise = np.random.default_rng(5).normal(size=BALL.n_points)
        for keywords, share in (({"fwhm": 40.0}, 0.0), ({"range": 90.0}, 0.0), ({"fwhm": 60.0}, 0.5)):
            field = sd.random_field(BALL, 1, seed=8, **keywords)[:, 0]
            values = np.sqrt(1.0 - share) * field + np.sqrt(share) * noise
            found = sd.surrogates(BALL, values, 100)
            bounds = [30.0, 60.0, 120.0]
            mine = sd.spectrum(BALL, values, bounds, order=1).variance
            theirs = sd.spectrum(BALL, found.values, bounds, order=1).variance
            spread = theirs.std(axis=1)
            self.assertTrue((np.abs(theirs.mean(axis=1) - mine) < spread + 0.05 * mine.sum()).all())
            self.assertAlmostEqual(found.variances[-1], share * noise.var() / values.var(), delta=0.1)
            self.assertAlmostEqual(found.variances.sum(), 1.0, delta=1e-12)
            self.assertEqual(found.fwhm[-1], 0.0)

    def test_unrelated_maps_are_found_related_as_often_as_the_level_says(self):
        surface = sd.sphere(2, RADIUS)
        first = sd.random_field(surface, 200, fwhm=60.0, seed=11)
        second = sd.random_field(surface, 200, fwhm=60.0, seed=12)
        hits = 0
        for k in range(200):
            null = sd.surrogates(surface, first[:, k], 99, seed=1000 + k).values
            found = abs(np.corrcoef(first[:, k], second[:, k])[0, 1])
            others = np.abs(np.corrcoef(null.T, second[:, k])[-1, :-1])
            hits += (1 + (others >= found).sum()) / 100 <= 0.05
        # 5 % of 200, whose standard deviation is 3.1. Permuted values find 60 % related.
        self.assertLessEqual(hits, 20)
        self.assertGreaterEqual(hits, 2)

    def test_maps_of_few_independent_parts_have_the_documented_share(self):
        surface = sd.sphere(2, RADIUS)
        mask = surface.points[:, 2] < 20.0
        first = sd.random_field(surface, 200, range=500.0, nu=3, mask=mask, seed=1)
        second = sd.random_field(surface, 200, range=500.0, nu=3, mask=mask, seed=2)
        known = np.isfinite(first[:, 0])
        hits = 0
        for k in range(200):
            null = sd.surrogates(surface, first[:, k], 99, seed=1000 + k, mask=mask).values[known]
            found = abs(np.corrcoef(first[known, k], second[known, k])[0, 1])
            hits += (1 + (np.abs(np.corrcoef(null.T, second[known, k])[-1, :-1]) >= found).sum()) / 100 <= 0.05
        self.assertLessEqual(hits, 30)  # 9 % of 200, and three standard deviations

    def test_have_nothing_in_common_with_fields_of_the_same_seed(self):
        for keywords in ({"fwhm": 15.0}, {"range": 20.0}):
            fields = sd.random_field(BALL, 3, **keywords)
            for k in range(3):
                found = sd.surrogates(BALL, fields[:, k], 5).values
                others = np.corrcoef(found.T, fields[:, k])[-1, :-1]
                self.assertLess(np.abs(others).max(), 0.3)

    def test_shares_are_those_of_the_variance(self):
        noise = np.random.default_rng(1).normal(size=BALL.n_points)
        height = BALL.points[:, 2] / BALL.points[:, 2].std()
        self.assertAlmostEqual(sd.surrogates(BALL, height + noise, 1).variances[-1], 0.5, delta=0.07)

    def test_at_faces_have_the_values_and_the_smoothness(self):
        field = sd.random_field(BALL, 1, fwhm=50.0, seed=2, on_faces=True)[:, 0]
        field[BALL.points[BALL.faces].mean(axis=1)[:, 2] < -40.0] = np.nan
        found = sd.surrogates(BALL, field, 60)
        self.assertEqual(found.values.shape, (BALL.n_faces, 60))
        known = np.isfinite(field)
        np.testing.assert_array_equal(np.isnan(found.values[:, 3]), ~known)
        np.testing.assert_array_equal(np.sort(found.values[known, 3]), np.sort(field[known]))
        bounds = [30.0, 60.0, 120.0]
        mine = sd.spectrum(BALL, field, bounds, order=1).variance
        theirs = sd.spectrum(BALL, found.values, bounds, order=1).variance
        self.assertTrue((np.abs(theirs.mean(axis=1) - mine) < theirs.std(axis=1) + 0.05 * mine.sum()).all())

    def test_hemispheres_are_independent_and_share_their_values(self):
        half = sd.sphere(3, RADIUS)
        x = sd.random_field(half, 2, fwhm=60.0)
        values = np.concatenate([x[:, 0], 3.0 + x[:, 1]])
        values[5] = np.nan
        for pair in ((half, half), [(half.points, half.faces), half]):
            found = sd.surrogates(pair, values, 200).values
            self.assertEqual(found.shape, (2 * half.n_points, 200))
            np.testing.assert_array_equal(np.sort(found[:, 7]), np.sort(values))
            left, right = found[:half.n_points], found[half.n_points:]
            same = [np.corrcoef(np.delete(a, 5), np.delete(b, 5))[0, 1] for a, b in zip(left.T, right.T)]
            self.assertLess(abs(np.mean(same)), 0.08)

    def test_what_is_not_allowed_is_named(self):
        values = BALL.points[:, 0]
        infinite = np.where(np.arange(BALL.n_points) == 4, np.inf, values)
        for pattern, arguments in (
                ("values is constant", (np.ones(BALL.n_points),)),
                ("values has shape .*; allowed: \\(2562,\\), one map", (BALL.points,)),
                ("values has shape", (values[1:],)),
                ("values is infinite in row 4", (infinite,)),
                ("values has no known value: it is NaN everywhere", (np.full(BALL.n_points, np.nan),)),
                ("n is 1.5; allowed", (values, 1.5))):
            with self.assertRaisesRegex(ValueError, pattern):
                sd.surrogates(BALL, *arguments)


class OfParcels(unittest.TestCase):
    labels = parcels_of(BALL, 80)

    def test_have_the_values_of_the_parcels_and_their_variogram(self):
        noise = np.random.default_rng(1).normal(size=(80, 30))
        for fields in (means(self.labels, sd.random_field(BALL, 30, fwhm=60.0)),
                       means(self.labels, sd.random_field(BALL, 30, range=150.0)) + 0.5 * noise, noise):
            centres = means(self.labels, BALL.points)
            r = np.linalg.norm(centres[:, None] - centres[None], axis=2)
            bins = [(r > low) & (r <= low + 30.0) for low in (10.0, 40.0, 70.0, 100.0)]

            def variogram(maps):
                maps = (maps - maps.mean(axis=0)) / maps.std(axis=0)
                return np.array([[np.mean((m[:, None] - m[None])[b]**2) / 2 for b in bins] for m in maps.T])

            theirs = np.mean([variogram(sd.surrogates(BALL, field, 20, labels=self.labels, seed=k).values).mean(axis=0)
                              for k, field in enumerate(fields.T)], axis=0)
            np.testing.assert_allclose(theirs, variogram(fields).mean(axis=0), atol=0.08)

    def test_numbers_may_have_gaps_and_parcels_no_value(self):
        labels = 10 * self.labels - 400
        labels[CAP] = 0
        numbers = np.unique(labels[labels != 0])
        values = means(labels, BALL.points[:, :1] ** 3)[:, 0]
        values[[2, 30]] = np.nan
        for options in ({}, {"roi": BALL.points[:, 2] > -60.0}):
            found = sd.surrogates(BALL, values, 9, labels=labels, **options)
            self.assertEqual(found.values.shape, (len(numbers), 9))
            np.testing.assert_array_equal(np.isnan(found.values).any(axis=1), np.isnan(values))
            known = np.isfinite(values)
            for column in found.values[known].T:
                np.testing.assert_array_equal(np.sort(column), np.sort(values[known]))
            self.assertAlmostEqual(found.variances.sum(), 1.0, delta=1e-12)
        again = sd.surrogates(BALL, values, 3, labels=labels.astype(float))
        np.testing.assert_array_equal(again.values, sd.surrogates(BALL, values, 9, labels=labels).values[:, :3])

    def test_hemispheres_have_parcels_of_their_own(self):
        half = sd.sphere(3, RADIUS)
        one = parcels_of(half, 40)
        labels = np.concatenate([one, one + 40])
        fields = sd.random_field(half, 2, fwhm=90.0)
        values = np.concatenate([means(one, fields[:, 0]), means(one, fields[:, 1])])
        found = sd.surrogates((half, half), values, 400, labels=labels).values
        self.assertEqual(found.shape, (80, 400))
        same = [np.corrcoef(column[:40], column[40:])[0, 1] for column in found.T]
        self.assertLess(abs(np.mean(same)), 0.08)
        with self.assertRaisesRegex(ValueError, r"values has shape \(80,\); allowed: \(40,\), one per number in "
                                    r"labels but 0 \(1, 2, 3, 4, ..., 40; those of two hemispheres differ\)"):
            sd.surrogates((half, half), values, 4, labels=np.concatenate([one, one]))

    def test_unrelated_maps_are_found_related_as_often_as_the_level_says(self):
        first, second = (means(self.labels, sd.random_field(BALL, 60, fwhm=80.0, seed=seed)) for seed in (11, 12))
        hits = 0
        for k in range(60):
            null = sd.surrogates(BALL, first[:, k], 99, labels=self.labels, seed=k).values
            found = np.abs(np.corrcoef(first[:, k], second.T)[0, 1:])
            others = np.abs(np.corrcoef(null.T, second.T)[:99, 99:])
            hits += ((1 + (others >= found).sum(axis=0)) / 100 <= 0.05).sum()
        self.assertLess(abs(hits / 3600 - 0.05), 0.02)

    def test_what_is_not_allowed_is_named(self):
        values = np.arange(80.0)
        for pattern, labels in ((r"labels has shape \(5,\); allowed: \(2562,\)", np.ones(5, int)),
                                ("labels has 0.5 in row 0; allowed: whole numbers", np.full(2562, 0.5)),
                                ("labels has nan in row 0", np.full(2562, np.nan)),
                                ("labels has 1 parcels; allowed: two numbers or more", np.ones(2562, int))):
            with self.assertRaisesRegex(ValueError, pattern):
                sd.surrogates(BALL, values, 3, labels=labels)
        with self.assertRaisesRegex(ValueError, "values is constant"):
            sd.surrogates(BALL, 0 * values, 3, labels=self.labels)


if __name__ == "__main__":
    sys.exit(unittest.main())
