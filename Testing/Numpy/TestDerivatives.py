# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""curvature, and derivatives with its short forms."""

import threading
import types
import unittest
import warnings

import numpy as np

import surfacediffusion as sd


def plate(n=12):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0)))
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    faces = np.column_stack([first, first + 1, first + n + 2, first + n + 1])
    return sd.Surface(np.column_stack([x, y, 0 * x]), faces)


class Curvature(unittest.TestCase):
    def test_takes_any_surface(self):
        surface = sd.sphere(3)
        expected = sd.curvature(surface, fwhm=0.4).mean
        for other in ((surface.points, surface.triangles),
                      types.SimpleNamespace(vertices=surface.points, faces=surface.triangles),
                      types.SimpleNamespace(coordinates=surface.points, faces=surface.triangles)):
            np.testing.assert_array_equal(sd.curvature(other, fwhm=0.4).mean, expected)

    def test_warns_of_turned_faces(self):
        surface = sd.sphere(3)
        faces = surface.triangles.copy()
        faces[5] = faces[5][::-1]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            found = sd.curvature((surface.points, faces))
        self.assertEqual(len(caught), 1)
        self.assertIn("1 triangles have another orientation", str(caught[0].message))
        np.testing.assert_allclose(found.mean, sd.curvature(surface).mean, atol=1e-12)


class Derivatives(unittest.TestCase):
    def test_short_forms_are_derivatives(self):
        surface = sd.sphere(4)
        z = surface.points[:, 2]
        spin = np.cross([0, 0, 1], surface.points)
        for found, quantity, data in (
            (sd.gradient(surface, z), "gradient", z), (sd.laplacian(surface, z), "laplacian", z),
            (sd.divergence(surface, spin), "divergence", spin), (sd.curl(surface, spin), "curl", spin),
            (sd.conduction_velocity(surface, z).velocity, "conduction_velocity", z),
        ):
            np.testing.assert_array_equal(found, sd.derivatives(surface, data, quantity=quantity))

    def test_agree_with_the_matrices(self):
        try:
            import scipy  # noqa: F401
        except ImportError:
            self.skipTest("scipy is not installed")
        surface = sd.sphere(4)
        values = np.sin(3 * surface.points[:, 0]) + surface.points[:, 1]
        of_faces = sd.gradient(surface, values, result_on_faces=True)
        np.testing.assert_allclose(
            of_faces.ravel(), sd.gradient_matrix(surface) @ values, atol=1e-12)
        expected = -(sd.stiffness_matrix(surface) @ values) / sd.mass_matrix(surface).diagonal()
        np.testing.assert_allclose(sd.laplacian(surface, values), expected, atol=1e-9)

    def test_columns_and_shapes(self):
        surface = plate()
        x, y, _ = surface.points.T
        found = sd.gradient(surface, np.column_stack([x, 3 * y]))
        np.testing.assert_allclose(found, [[1, 0, 0, 0, 3, 0]] * len(x), atol=1e-12)
        many = np.outer(x, np.arange(1, 41))  # more columns than are smoothed at once
        found = sd.gradient(surface, many, smoothing_fwhm=4)
        np.testing.assert_allclose(found[:, 0::3], [np.arange(1, 41)] * len(x), rtol=1e-8)
        one = sd.gradient(surface, many[:, 35], smoothing_fwhm=4)
        np.testing.assert_allclose(found[:, 105:108], one, atol=1e-8)
        self.assertEqual(sd.laplacian(surface, x, result_on_faces=True).shape, (surface.n_faces,))
        np.testing.assert_allclose(sd.laplacian(surface, x * x + y * y), 4.0, atol=1e-9)
        vectors = np.column_stack([x, -y, 0 * x, y, x, 0 * x])
        np.testing.assert_allclose(sd.divergence(surface, vectors), 0.0, atol=1e-12)
        np.testing.assert_allclose(sd.curl(surface, vectors), 0.0, atol=1e-12)

    def test_velocity_is_0_where_times_do_not_change(self):
        surface = plate()
        found = sd.conduction_velocity(surface, np.full(surface.n_points, 3.0))
        np.testing.assert_array_equal(found.velocity, 0.0)
        np.testing.assert_array_equal(found.speed, 0.0)

    def test_collisions_and_foci_are_marked(self):
        x, y = (a.ravel() for a in np.meshgrid(np.arange(61.0), np.arange(61.0)))
        corner = np.arange(61 * 61).reshape(61, 61)[:-1, :-1].ravel()
        plane = sd.Surface(np.c_[x, y, 0.0 * x], np.vstack([np.c_[corner, corner + 1, corner + 62],
                                                            np.c_[corner, corner + 62, corner + 61]]))
        from_left, from_right = np.hypot(x - 10, y - 30), np.hypot(x - 50, y - 30)
        found = sd.conduction_velocity(plane, np.minimum(from_left, from_right) / 0.6)
        nearest = np.minimum(from_left, from_right)
        self.assertTrue(found.focus[nearest == 0].all() and not found.focus[nearest > 4].any())
        self.assertTrue(found.collision[x == 30].all() and not found.collision[(abs(x - 30) > 2)].any())
        free = ~found.collision & ~found.focus
        np.testing.assert_array_equal(np.isnan(found.speed), ~free)
        np.testing.assert_array_equal(found.velocity[~free], 0.0)
        np.testing.assert_allclose(found.speed[free & (nearest > 4)], 0.6, rtol=0.03)
        np.testing.assert_allclose(np.linalg.norm(found.direction, axis=1)[free], 1.0, atol=1e-9)

    def test_says_what_is_not_allowed(self):
        surface = plate()
        x = surface.points[:, 0]
        for call, text in (
            (lambda: sd.curl(surface, x), "vectors has 1 components; allowed with quantity"),
            (lambda: sd.divergence(surface, np.zeros((len(x), 2, 3))),
             f"vectors has shape ({len(x)}, 2, 3); allowed: ({len(x)}, 3) or ({len(x)}, 3 k), one row"),
            (lambda: sd.gradient(surface, x[:5]), "values has shape (5,); allowed: "),
            (lambda: sd.gradient(surface, x, smoothing_fwhm=-1), "smoothing_fwhm is -1"),
            (lambda: sd.gradient(surface, np.where(x == 3, np.inf, x)), "values is infinite at point 3"),
            (lambda: sd.derivatives(surface, x, quantity="Slope"), "quantity is 'Slope'"),
            (lambda: sd.derivatives(surface, x, full_output=2), "full_output is 2; allowed: "),
            (lambda: sd.curvature(surface, fwhm=-2), "fwhm is -2"),
            (lambda: sd.curvature(surface, mask=x[:7]), "mask has shape (7,); allowed: "),
        ):
            with self.subTest(text), self.assertRaises(ValueError) as caught:
                call()
            with self.subTest(text):
                self.assertIn(text, str(caught.exception))
                self.assertEqual(len(str(caught.exception).splitlines()), 1)

    def test_can_be_stopped_and_used_by_threads(self):
        surface = sd.sphere(5)
        values = surface.points[:, 0]
        expected = sd.laplacian(surface, values, smoothing_fwhm=0.2)

        class Stop(Exception):
            pass

        def stop(fraction):
            if fraction > 0.5:
                raise Stop

        with self.assertRaises(Stop):
            sd.laplacian(surface, values, smoothing_fwhm=0.3, progress=stop)
        with self.assertRaises(Stop):
            sd.curvature(surface, fwhm=0.3, progress=stop)
        found = [None] * 4

        def work(i):
            found[i] = sd.laplacian(surface, values, smoothing_fwhm=0.2)

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for other in found:
            np.testing.assert_array_equal(other, expected)


if __name__ == "__main__":
    unittest.main(verbosity=2)
