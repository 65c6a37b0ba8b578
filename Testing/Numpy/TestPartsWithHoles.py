# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Textures and relief on parts with holes, which come from STL files as triangles of their own."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

import surfacediffusion as sd
from surfacediffusion.files import read_surface
from surfacediffusion.files.export import export

AROUND = 32  #: points of a circle
THICKNESS = 8.0


def strips(rings):
    """The triangles between each ring of points and the next, the last one before the first."""
    found = []
    for a, b in zip(rings, rings[1:] + rings[:1]):
        c, d = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)
        found += [np.stack([a, c, d], axis=1), np.stack([a, d, b], axis=1)]
    return np.concatenate(found)


def tube(outer=20.0, inner=12.0, height=40.0):
    """A cylinder with a hole along its axis: needles over the whole height. Corners (m, 3, 3)."""
    angle = 2 * np.pi * np.arange(AROUND) / AROUND
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(AROUND)], axis=1)
    top = [0, 0, height]
    return strips([outer * ring, outer * ring + top, inner * ring + top, inner * ring])


def plate(half=20.0, radius=10.0):
    """Two squares side by side, each with a round hole: a plate of genus 2."""
    angle = 2 * np.pi * np.arange(AROUND) / AROUND
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(AROUND)], axis=1)
    square = half * circle / np.abs(circle).max(axis=1)[:, None]
    # Whole sides lie in planes.
    square = np.where(np.abs(np.abs(square) - half) < 1e-9 * half, np.sign(square) * half, square)
    top = [0, 0, THICKNESS]
    left = strips([square, square + top, radius * circle + top, radius * circle])
    left = left[~(left[:, :, 0] == half).all(axis=1)]  # the side where the other square begins
    right = left[:, ::-1] * [-1, 1, 1] + [2 * half, 0, 0]
    return np.concatenate([left, right])


def to_edges_of_plate(x, half=20.0, radius=10.0):
    """The distance from the nearest sharp edge of the plate."""
    z = np.minimum(x[:, 2], THICKNESS - x[:, 2])
    centre = np.where(x[:, 0] > half, 2 * half, 0.0)
    rim = np.min([x[:, 0] + half, 3 * half - x[:, 0], x[:, 1] + half, half - x[:, 1],
                  np.hypot(x[:, 0] - centre, x[:, 1]) - radius], axis=0)
    return np.maximum(z, rim)


def to_edges_of_tube(x, outer=20.0, inner=12.0, height=40.0):
    r = np.hypot(x[:, 0], x[:, 1])
    return np.maximum(np.minimum(x[:, 2], height - x[:, 2]), np.minimum(outer - r, r - inner))


#: The corners of the triangles, the distance from sharp edges, and the genus.
PARTS = {"tube": (tube(), to_edges_of_tube, 1), "plate": (plate(), to_edges_of_plate, 2)}


def from_stl(corners):
    """The part as a file of triangles gives it, with points at the same place joined."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "part.stl")
        export(file, corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
        given = read_surface(file)
        return sd.weld((given.points, given.faces)).surface


def edges_of(surface):
    t = surface.triangles
    sides = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    return np.unique(sides, axis=0, return_counts=True)


def volume(surface):
    a, b, c = (surface.points[surface.triangles[:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def integral(surface, values):
    return surface.vertex_areas @ values


def wavelength(surface, values, chosen):
    """Of the wave with the same gradients, in the mean square over these triangles."""
    t = surface.triangles[chosen]
    a, b, c = (surface.points[t[:, i]] for i in range(3))
    doubled = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    u = (values - values.mean())[t]
    gradient = (u[:, [0]] * (c - b) + u[:, [1]] * (a - c) + u[:, [2]] * (b - a)) / doubled[:, None]
    squares = (u**2).sum(axis=1) / 12 + u.sum(axis=1) ** 2 / 12
    return 2 * np.pi * np.sqrt((squares @ doubled) / ((gradient**2).sum(axis=1) @ doubled))


class PartsWithHoles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.textures = {name: sd.turing_texture(from_stl(corners), feature_size=7.0, refine_to=1.0,
                                                diffusion_rate1=2.6 * 18, number_of_time_steps=300)
                        for name, (corners, _, _) in PARTS.items()}

    def test_are_closed_after_welding_and_refinement(self):
        for name, (corners, _, genus) in PARTS.items():
            for surface in (from_stl(corners), self.textures[name].surface):
                edges, counts = edges_of(surface)
                self.assertEqual(set(counts), {2}, name)
                self.assertEqual(surface.n_points - len(edges) + surface.n_faces, 2 - 2 * genus)

    def test_have_one_pattern_across_their_edges(self):
        for name, (_, distance, _) in PARTS.items():
            texture = self.textures[name]
            surface = texture.surface
            centres = surface.points[surface.triangles].mean(axis=1)
            away = distance(centres)
            u1 = texture.values[:, 0]
            faces = wavelength(surface, u1, away > 2.0)
            edges = wavelength(surface, u1, away < 2.0)
            self.assertAlmostEqual(edges / faces, 1, delta=0.05, msg=name)

    def test_change_their_volume_by_the_integral_of_the_relief(self):
        for name, texture in self.textures.items():
            surface = texture.surface
            for height in (0.02, -0.02):
                result = sd.relief(surface, texture.texture, height)
                wanted = integral(surface, height * texture.texture)
                self.assertAlmostEqual(result.volume_change / wanted, 1, delta=0.01, msg=name)
                self.assertAlmostEqual(
                    (volume(result.surface) - volume(surface)) / wanted, 1, delta=0.01, msg=name)

    def test_are_closed_and_do_not_cross_themselves_at_a_tenth_of_the_thickness(self):
        for name, texture in self.textures.items():
            for height in (0.1 * THICKNESS, -0.1 * THICKNESS):
                result, again = (sd.relief(texture.surface, texture.texture, height, levels="Two",
                                           flank=0.8) for _ in range(2))
                self.assertEqual((result.open_edges, result.non_manifold_edges), (0, 0), name)
                self.assertEqual(result.crossing_triangles, 0, name)
                self.assertEqual(set(edges_of(result.surface)[1]), {2}, name)
                np.testing.assert_array_equal(result.surface.points, again.surface.points)


if __name__ == "__main__":
    unittest.main()
