# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The functions on the coarse and odd surfaces of Testing/Surfaces, beside dense linear algebra."""

import pathlib
import unittest
import warnings

import numpy as np

import surfacediffusion as sd


def read_surfaces():
    """Name, points and triangles of each surface."""
    path = pathlib.Path(__file__).resolve().parents[1] / "Surfaces/coarse.txt"
    lines = iter(line for line in path.read_text().splitlines() if not line.startswith("#"))
    for line in lines:
        name, points, triangles = line.split()
        yield (name, np.array([next(lines).split() for _ in range(int(points))], float),
               np.array([next(lines).split() for _ in range(int(triangles))], int))


SURFACES = list(read_surfaces())


def dense_matrices(points, triangles):
    """Lumped masses and the cotan stiffness matrix, term by term."""
    masses, stiffness = np.zeros(len(points)), np.zeros((len(points), len(points)))
    for corners in triangles:
        for a in range(3):
            i, j, k = corners[a], corners[(a + 1) % 3], corners[(a + 2) % 3]
            u, v = points[j] - points[i], points[k] - points[i]
            double_area = np.linalg.norm(np.cross(u, v))
            masses[i] += double_area / 6.0
            weight = 0.5 * np.dot(u, v) / double_area
            stiffness[[j, k], [j, k]] += weight
            stiffness[[j, k], [k, j]] -= weight
    return masses, stiffness


def turn(points):
    """Rotated about a skew axis."""
    axis, angle = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0), 1.0
    across = np.cross(axis, points)
    return points + np.sin(angle) * across + (1.0 - np.cos(angle)) * np.cross(axis, across)


class CoarseSurfaces(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore")
        self.random = np.random.default_rng(3)
        self.assertGreater(len(SURFACES), 40)

    def each(self):
        for name, points, triangles in SURFACES:
            with self.subTest(surface=name):
                yield name, points, triangles, self.random.normal(size=len(points))

    def test_heat_takes_the_step_of_dense_matrices(self):
        for _, points, triangles, values in self.each():
            masses, stiffness = dense_matrices(points, triangles)
            found = sd.heat((points, triangles), values, time_step=0.7, number_of_time_steps=1,
                            time_integrator="FirstOrder", units="Absolute", tolerance=1e-13)
            want = np.linalg.solve(np.diag(masses) + 0.7 * stiffness, masses * values)
            np.testing.assert_allclose(found, want, atol=1e-9 * np.abs(values).max())

    def test_eigenmodes_are_those_of_dense_matrices(self):
        for _, points, triangles, _ in self.each():
            masses, stiffness = dense_matrices(points, triangles)
            scale = 1.0 / np.sqrt(masses)
            want = np.linalg.eigvalsh(stiffness * scale[:, None] * scale)
            count = min(len(points) - 1, 6)
            found, _ = sd.eigenmodes((points, triangles), count)
            np.testing.assert_allclose(found, want[:count], atol=1e-8 * want[-1])

    def test_distances_are_symmetric_and_those_of_edges_in_tetrahedra(self):
        for name, points, triangles, _ in self.each():
            surface = sd.Surface(points, triangles)
            found = np.array([sd.distance(surface, i) for i in range(min(len(points), 12))])
            square = found[:, : len(found)]
            finite = np.isfinite(square)
            self.assertTrue((finite == finite.T).all())
            np.testing.assert_allclose(square[finite], square.T[finite], rtol=0,
                                       atol=1e-10 * square[finite].max())
            straight = np.linalg.norm(points[: len(found), None] - points, axis=2)
            self.assertTrue((found >= straight * (1.0 - 1e-12)).all())
            if name.startswith("Tetrahedron"):
                np.testing.assert_allclose(found, straight, atol=1e-12 * straight.max())
            if name.startswith("HullOf") and name.endswith("Sphere"):
                self.assertLess(found.max(), np.pi)  # an inscribed polyhedron is inside the sphere

    def test_curvature_is_invariant_and_positive_on_convex_solids(self):
        for name, points, triangles, _ in self.each():
            found = sd.curvature((points, triangles)).mean
            turned = sd.curvature((1e-3 * turn(points), triangles)).mean
            np.testing.assert_allclose(1e-3 * turned, found, atol=1e-8 * np.abs(found).max())
            if name.startswith(("HullOf", "Octahedron", "Cube")):
                self.assertGreater(found.min(), 0.0)

    def test_nothing_moves_without_noise_or_steps(self):
        for name, points, triangles, _ in self.each():
            np.testing.assert_array_equal(
                np.asarray(sd.denoise_mesh((points, triangles)).points), points)
            moved = sd.harmonic_map((points, triangles), move_vertices=True, number_of_time_steps=0)
            np.testing.assert_array_equal(np.asarray(moved.points), points)

    def test_interpolation_does_not_depend_on_rotation_and_unit(self):
        for _, points, triangles, values in self.each():
            known = np.where(np.arange(len(points)) % 3 == 1, np.nan, values)
            found = sd.interpolate((points, triangles), known)
            turned = sd.interpolate((1e3 * turn(points), triangles), known)
            np.testing.assert_allclose(turned, found, atol=1e-6 * np.abs(values).max())


if __name__ == "__main__":
    unittest.main()
