# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The matrices of surfaces and their eigenmodes. Those of scipy.sparse run where scipy is."""

import doctest
import importlib
import importlib.util
import sys
import unittest

import numpy as np

import surfacediffusion as sd

HAS_SCIPY = importlib.util.find_spec("scipy") is not None


def strip(columns, rows, length, width):
    """A flat strip of right-angled triangles with alternating diagonals."""
    x, y = np.meshgrid(np.linspace(0, length, columns + 1), np.linspace(0, width, rows + 1))
    points = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    i, j = np.meshgrid(np.arange(columns), np.arange(rows))
    a = (j * (columns + 1) + i).ravel()
    b, c, d = a + 1, a + columns + 1, a + columns + 2
    even = ((i + j) % 2 == 0).ravel()[:, None]
    first = np.where(even, np.stack([a, b, d], 1), np.stack([a, b, c], 1))
    second = np.where(even, np.stack([a, d, c], 1), np.stack([b, d, c], 1))
    return points, np.concatenate([first, second])


def irregular(seed=0):
    """A flat strip with moved inner points, turned in space, and a point that no face uses."""
    points, faces = strip(14, 9, 3.0, 2.0)
    inner = (points[:, 0] > 0.01) & (points[:, 0] < 2.99) & (points[:, 1] > 0.01) & (
        points[:, 1] < 1.99)
    rng = np.random.default_rng(seed)
    points[inner, :2] += rng.uniform(-0.06, 0.06, (inner.sum(), 2))
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    order = rng.permutation(len(points))
    place = np.argsort(order)
    return np.concatenate([points[order] @ axes.T, [[9.0, 9.0, 9.0]]]), place[faces], axes


@unittest.skipIf(HAS_SCIPY, "scipy is installed")
class WithoutScipy(unittest.TestCase):
    def test_matrices_say_what_is_missing(self):
        for function in (sd.mass_matrix, sd.stiffness_matrix, sd.gradient_matrix):
            message = (f"^{function.__name__}\\(\\) returns a matrix of scipy.sparse, but scipy is "
                       "not installed; pip install scipy$")
            with self.assertRaisesRegex(ImportError, message):
                function(sd.sphere(1))
        with self.assertRaisesRegex(ImportError, r"^Resampler.weights\(\) returns a matrix of scipy.sparse"):
            sd.Resampler(sd.sphere(1), sd.sphere(1)).weights


@unittest.skipUnless(HAS_SCIPY, "scipy is not installed")
class Matrices(unittest.TestCase):
    def test_examples_in_docstrings_hold(self):
        results = doctest.testmod(importlib.import_module("surfacediffusion._operators"))
        self.assertEqual(results.failed, 0)
        self.assertGreater(results.attempted, 10)

    def test_masses_are_a_third_of_the_triangles(self):
        points, faces, _ = irregular()
        a, b, c = (points[faces[:, k]] for k in range(3))
        areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        expected = np.bincount(faces.ravel(), np.repeat(areas / 3, 3), len(points))
        found = sd.mass_matrix((points, faces))
        self.assertEqual(found.format, "csr")
        np.testing.assert_allclose(found.toarray(), np.diag(expected), rtol=0, atol=1e-15)
        given = np.linspace(1.0, 2.0, len(points))
        found = sd.mass_matrix(sd.Surface(points, faces, areas=given)).diagonal()
        np.testing.assert_allclose(found[:-1], given[:-1], rtol=1e-14)
        self.assertEqual(found[-1], 0.0)

    def test_gradients_of_linear_functions_are_exact(self):
        points, faces, axes = irregular()
        values = points @ [1.0, -2.0, 3.0]
        gradients = (sd.gradient_matrix((points, faces)) @ values).reshape(-1, 3)
        normal = axes[:, 2]
        expected = np.array([1.0, -2.0, 3.0])
        expected = expected - normal * (normal @ expected)
        np.testing.assert_allclose(gradients, np.tile(expected, (len(faces), 1)), atol=1e-12)
        gradients = sd.gradient_matrix(sd.sphere(2)) @ np.full(162, 7.0)
        self.assertLess(np.abs(gradients).max(), 1e-12)

    def test_stiffness_is_the_integral_of_squared_gradients(self):
        import scipy.sparse as sparse
        rng = np.random.default_rng(3)
        for points, faces in (irregular()[:2], (sd.sphere(2, 5.0).points, sd.sphere(2).triangles)):
            a, b, c = (points[faces[:, k]] for k in range(3))
            areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
            gradient = sd.gradient_matrix((points, faces))
            roots = rng.normal(size=(len(faces), 3, 3))
            tensors = roots @ roots.transpose(0, 2, 1)
            numbers = rng.uniform(0.0, 3.0, len(faces))
            one = np.tile(np.eye(3), (len(faces), 1, 1))
            for given, blocks in ((None, one), (tensors, tensors),
                                  (numbers, numbers[:, None, None] * np.eye(3))):
                weights = sparse.block_diag(list(areas[:, None, None] * blocks))
                expected = (gradient.T @ weights @ gradient).toarray()
                found = sd.stiffness_matrix((points, faces), diffusivity=given)
                self.assertEqual(found.format, "csr")
                np.testing.assert_allclose(found.toarray(), expected, rtol=0,
                                           atol=1e-13 * np.abs(expected).max())
                self.assertLess(np.abs(found - found.T).max(), 1e-15 * np.abs(expected).max())

    def test_intrinsic_delaunay_has_no_positive_weights_inside_and_keeps_linear_functions(self):
        points, faces = strip(10, 4, 1.0, 3.0)
        points = points @ np.array([[1.0, 0.0, 0.0], [0.4, 0.3, 0.0], [0.0, 0.0, 1.0]])  # a shear
        plain = sd.stiffness_matrix((points, faces)).toarray()
        flipped = sd.stiffness_matrix((points, faces), intrinsic_delaunay=True).toarray()
        edges = np.sort(np.asarray(faces)[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        unique, count = np.unique(edges, axis=0, return_counts=True)
        inside = np.ones(len(points), dtype=bool)
        inside[unique[count == 1].ravel()] = False
        off = ~np.eye(len(points), dtype=bool) & (inside[:, None] | inside)
        self.assertGreater(plain[off].max(), 0.1)
        self.assertLess(flipped[off].max(), 1e-12)
        for matrix in (plain, flipped):
            self.assertLess(np.abs(matrix @ (points @ [1.0, 2.0, 3.0]))[inside].max(), 1e-12)

    def test_masked_parts_have_no_entries(self):
        points, faces, _ = irregular()
        mask = points[:, 0] > np.median(points[:, 0])
        kept = faces[~mask[faces].any(axis=1)]
        for function in (sd.mass_matrix, sd.stiffness_matrix):
            expected = function((points, kept)).toarray()
            np.testing.assert_allclose(
                function((points, faces), mask=mask).toarray(), expected, rtol=0, atol=1e-14)
            on_faces = mask[faces].any(axis=1)
            np.testing.assert_allclose(
                function((points, faces), mask=on_faces).toarray(), expected, rtol=0, atol=1e-14)
            np.testing.assert_array_equal(function((points, faces), roi=~mask).toarray(),
                                          function((points, faces), mask=mask).toarray())
        with self.assertRaisesRegex(ValueError, "mask and roi are both given"):
            sd.mass_matrix((points, faces), mask=mask, roi=mask)
        gradient = sd.gradient_matrix((points, faces), mask=mask)
        self.assertEqual(gradient.shape, (3 * len(faces), len(points)))
        used = np.diff(gradient.indptr).reshape(-1, 3)
        np.testing.assert_array_equal(used, 3 * np.repeat(~on_faces[:, None], 3, axis=1))

    def test_rows_of_resampling_sum_to_1_and_are_applied(self):
        fine, coarse = sd.sphere(4), sd.Surface(sd.sphere(3).points[:, [1, 2, 0]] * [1, 1, -1], sd.sphere(3).triangles)
        resampler = sd.Resampler(fine, coarse)
        weights = resampler.weights
        self.assertEqual(weights.shape, (coarse.n_points, fine.n_points))
        np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-14)
        self.assertTrue((np.diff(weights.tocsc().indptr) > 0).all())  # each point of the source counts
        values = np.column_stack([fine.points, np.prod(fine.points, axis=1)])
        np.testing.assert_allclose(weights @ values, resampler(values), atol=1e-14)
        weights.data[:] = 0.0
        self.assertGreater(resampler.weights.data.min(), 0.0)

    def test_scipy_finds_the_same_modes(self):
        from scipy.sparse.linalg import eigsh
        surface = sd.sphere(3, 10.0)
        mass, stiffness = sd.mass_matrix(surface), sd.stiffness_matrix(surface)
        expected = eigsh(stiffness.tocsc(), 25, mass.tocsc(), sigma=-0.01)[0]
        found = sd.eigenmodes(surface, 25)
        np.testing.assert_allclose(found.eigenvalues, expected, rtol=0, atol=1e-11)
        gram = found.modes.T @ (mass @ found.modes)
        np.testing.assert_allclose(gram, np.eye(25), rtol=0, atol=1e-12)
        residual = stiffness @ found.modes - (mass @ found.modes) * found.eigenvalues
        self.assertLess(np.abs(residual).max(), 1e-7)


class Modes(unittest.TestCase):
    def test_diffusivity_stretches_the_strip(self):
        points, faces = strip(60, 30, 2.0, 1.0)
        along = np.diag([4.0, 1.0, 1.0])
        found = sd.eigenmodes((points, faces), 3, diffusivity=np.tile(along, (len(faces), 1, 1)))
        # 4 (pi / 2)^2 and pi^2: the same
        np.testing.assert_allclose(found.eigenvalues[1:], np.pi**2, rtol=2e-3)

    def test_parts_have_a_zero_each_and_masked_points_none(self):
        points, faces = strip(40, 20, 2.0, 1.0)
        mask = np.abs(points[:, 0] - 1.0) < 0.01
        found = sd.eigenmodes((points, faces), 5, mask=mask)
        self.assertEqual(found.eigenvalues[:2].tolist(), [0.0, 0.0])
        self.assertGreater(found.eigenvalues[2], 1.0)
        self.assertFalse(found.modes[mask].any())
        np.testing.assert_array_equal(sd.eigenmodes((points, faces), 5, roi=~mask).modes, found.modes)
        left = points[:, 0] < 1.0
        for mode in found.modes.T:
            self.assertFalse(mode[left].any() and mode[~left].any())

    def test_bad_input_names_what_is_allowed(self):
        surface = sd.sphere(1)
        tensor = np.tile(np.eye(3), (80, 1, 1))
        tensor[7, 0, 0] = -1.0
        skew = np.tile(np.eye(3), (80, 1, 1))
        skew[3, 0, 1] = 1.0
        bad = {
            "n is 0; allowed: 1 to 42, the points with a triangle": dict(n=0),
            "n is 43; allowed: 1 to 42": dict(n=43),
            "n is 2.0; allowed": dict(n=2.0),
            r"mask has shape \(3,\); allowed: \(42,\), one flag per point, or \(80,\)": dict(
                n=2, mask=np.zeros(3)),
            r"diffusivity has shape \(3,\); allowed: \(80,\), one number per face": dict(
                n=2, diffusivity=np.ones(3)),
            "diffusivity is .* in row 7; allowed: finite numbers": dict(n=2, diffusivity=tensor),
            "diffusivity is .* in row 3; allowed: finite numbers": dict(n=2, diffusivity=skew),
            "intrinsic_delaunay is 2; allowed: True or False": dict(n=2, intrinsic_delaunay=2),
            "allowed: one of them": dict(
                n=2, intrinsic_delaunay=True, diffusivity=np.ones(80)),
        }
        for message, keywords in bad.items():
            with self.assertRaisesRegex(ValueError, message):
                sd.eigenmodes(surface, **keywords)
        with self.assertRaisesRegex(ValueError, "no triangle of the surface is left; allowed: one"):
            sd.eigenmodes(surface, 1, mask=np.ones(42))


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
