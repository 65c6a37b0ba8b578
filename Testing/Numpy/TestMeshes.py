# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of nilearn, trimesh, LaPy and PyVista are taken as surfaces, and surface images of nilearn are
smoothed."""

import contextlib
import io
import os
import sys
import tempfile
import unittest
import warnings

import numpy as np

import surfacediffusion as sd
import surfacediffusion.files
from surfacediffusion import Surface, estimate_fwhm, estimate_fwhm_img, heat, smooth_img
from surfacediffusion._surface import as_surface

try:
    import lapy
    import nibabel as nib
    import pyvista
    import trimesh
    from nilearn.image import smooth_img as nilearn_smooth_img
    from nilearn.surface import InMemoryMesh, PolyMesh, SurfaceImage
except ImportError as missing:
    print(missing)
    sys.exit(77)  # skipped

SPHERE = sd.sphere(4, 50.0)
POINTS, FACES = np.asarray(SPHERE.points), np.asarray(SPHERE.triangles)
N = len(POINTS)
RNG = np.random.default_rng(1)
#: How smooth_img() calls heat()
ONE_STEP = {"time_integrator": "Exponential", "number_of_time_steps": 1}


class Meshes(unittest.TestCase):
    values = RNG.normal(size=N)
    expected = heat(SPHERE, values, fwhm=12)

    def check(self, mesh):
        np.testing.assert_array_equal(heat(mesh, self.values, fwhm=12), self.expected)
        noise = RNG.normal(size=(N, 3))
        self.assertEqual(estimate_fwhm(mesh, noise).pooled, estimate_fwhm(SPHERE, noise).pooled)

    def test_arrays(self):
        self.check((POINTS, FACES))
        self.check([POINTS.tolist(), FACES.tolist()])

    def test_nilearn(self):
        self.check(InMemoryMesh(POINTS, FACES))

    def test_trimesh(self):
        self.check(trimesh.Trimesh(POINTS, FACES, process=False))

    def test_lapy(self):
        self.check(lapy.TriaMesh(POINTS, FACES))

    def test_pyvista(self):
        self.check(pyvista.PolyData.from_regular_faces(POINTS, FACES))
        square = pyvista.Plane(i_resolution=3, j_resolution=2)
        self.assertEqual([len(face) for face in as_surface(square).faces], [4] * 6)
        mixed = pyvista.PolyData(np.eye(5, 3), [4, 0, 1, 2, 3, 3, 0, 1, 4])
        self.assertEqual([len(face) for face in as_surface(mixed).faces], [4, 3])
        with self.assertRaisesRegex(ValueError, "[0-9]+ triangle strips .* allowed: polygons"):
            as_surface(square.triangulate().strip())
        with self.assertRaisesRegex(ValueError, "surface is .* allowed: a Surface, a tuple"):
            as_surface("lh.white")

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "lh.white")
            nib.freesurfer.write_geometry(path, POINTS, FACES)
            surface = sd.files.read_surface(path)
            np.testing.assert_array_equal(
                heat(surface, self.values, fwhm=12),
                heat(Surface(surface.points, surface.faces), self.values, fwhm=12))


class Seams(unittest.TestCase):
    def test_operators_and_distances_warn_of_triangles_without_common_points(self):
        whole = sd.sphere(3)
        soup = Surface(whole.points[whole.triangles].reshape(-1, 3),
                       np.arange(3 * whole.n_faces).reshape(-1, 3))
        z = soup.points[:, 2]
        flow, path = " and nothing flows", ", across which no path leads"
        for call, what in ((lambda s: sd.eigenmodes(s, 2), flow),
                           (lambda s: sd.distance(s, [0]), path),
                           (lambda s: sd.nearest_sources(s, [0, 1]), path),
                           (lambda s: sd.random_field(s, 1, fwhm=0.5), flow),
                           (lambda s: sd.scale_filter(s, s.points[:, 2], 1.0), flow),
                           (lambda s: sd.spectrum(s, s.points[:, 2], [1.0]), flow)):
            with self.assertWarnsRegex(sd.SurfaceDiffusionWarning,
                                       f"^{len(z)} boundary points coincide with others{what}"):
                call(soup)
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                call(whole)

    def test_seams_up_to_round_off_are_named_with_their_width(self):
        u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 25), np.linspace(0, 2 * np.pi, 25), indexing="ij")
        radius = 3 + np.cos(v)
        points = np.stack([radius * np.cos(u), radius * np.sin(u), np.sin(v)], axis=-1).reshape(-1, 3)
        corner = (np.arange(24)[:, None] * 25 + np.arange(24)).ravel()
        faces = np.vstack([np.stack([corner, corner + 25, corner + 26], 1),
                           np.stack([corner, corner + 26, corner + 1], 1)])
        torus = Surface(points, faces)
        z = points[:, 2]
        for call in (lambda s: sd.eigenmodes(s, 2), lambda s: sd.random_field(s, 1, fwhm=0.5)):
            with self.assertWarnsRegex(sd.SurfaceDiffusionWarning,
                                       r"^96 boundary points coincide .* within \de-1\d of one another once"):
                call(torus)
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, r"^96 boundary points coincide .* set "
                                   r"merge_coincident_points, and merge_tolerance to \de-1\d\)"):
            sd.distance(torus, [0])
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, r"and merge_tolerance to \de-1\d\)") as caught:
            apart = heat(torus, z, fwhm=2)
        tolerance = float(str(caught.warning).split(" to ")[-1].rstrip(")"))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            joined = heat(torus, z, fwhm=2, merge_coincident_points=True, merge_tolerance=tolerance)
            found = sd.distance(torus, [0], merge_coincident_points=True, merge_tolerance=tolerance)
        np.testing.assert_array_equal(found.reshape(25, 25)[:, 0], found.reshape(25, 25)[:, -1])
        np.testing.assert_array_equal(joined.reshape(25, 25)[:, 0], joined.reshape(25, 25)[:, -1])
        self.assertGreater(np.abs(apart - joined).max(), 1e-3)

    def test_ends_of_edges_without_a_length_are_one_point(self):
        whole = sd.sphere(3)
        # As at a seam: some triangles of point 5 get a copy of it, and two slivers lie between.
        faces = whole.triangles.copy()
        n, point = whole.n_points, 5
        around = {face[(k + 1) % 3]: (row, face[(k + 2) % 3])
                  for row, face in enumerate(faces.tolist()) for k in range(3) if face[k] == point}
        first = min(around)
        row, middle = around[first]
        other, last = around[middle]
        for moved in (row, other):
            faces[moved][faces[moved] == point] = n
        faces = np.vstack([faces, [[point, n, first], [n, point, last]]])
        split = Surface(np.vstack([whole.points, whole.points[point] + [1e-16, 0, 0]]), faces)
        z = split.points[:, 2]
        for call in (lambda s: sd.eigenmodes(s, 6).modes[:, 0],
                     lambda s: sd.eigenmodes(s, 6).eigenvalues,
                     lambda s: sd.distance(s, [70]),
                     lambda s: sd.distance(s, [70], method="Heat"),
                     lambda s: sd.nearest_sources(s, [0, 70, 99])[0],
                     lambda s: sd.distances(s, [70, point]).toarray()[:, :n].T,
                     lambda s: sd.random_field(s, 1, fwhm=0.5),
                     lambda s: sd.scale_filter(s, z[:s.n_points], 1.0),
                     lambda s: heat(s, z[:s.n_points], fwhm=0.5),
                     lambda s: sd.curvature(s).mean):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                expected, found = np.asarray(call(whole)), np.asarray(call(split))
            np.testing.assert_allclose(found[:len(expected)], expected, rtol=1e-9, atol=1e-9)
            if len(found) > n:
                np.testing.assert_array_equal(found[n], found[point])
        near = sd.distances(split, [70], cutoff=2.0).toarray()[0]
        self.assertEqual(near[n], near[point])
        # Matrices keep a row for every point.
        self.assertGreater(sd.mass_matrix(split).diagonal().min(), 0)


class Images(unittest.TestCase):
    def setUp(self):
        self.mesh = PolyMesh(left=InMemoryMesh(POINTS, FACES), right=InMemoryMesh(POINTS * 0.9, FACES))
        self.data = {"left": RNG.normal(size=(N, 3)), "right": RNG.normal(size=(N, 3))}
        self.image = SurfaceImage(self.mesh, self.data)

    def part(self, image, name):
        return image.data.parts[name]

    def test_each_hemisphere_is_smoothed_on_its_mesh(self):
        before = {name: values.copy() for name, values in self.data.items()}
        smooth = smooth_img(self.image, 10)
        self.assertIsInstance(smooth, SurfaceImage)
        self.assertEqual(smooth.shape, self.image.shape)
        for name, scale in (("left", 1.0), ("right", 0.9)):
            expected = heat((POINTS * scale, FACES), before[name], fwhm=10, **ONE_STEP)
            np.testing.assert_array_equal(self.part(smooth, name), expected)
            np.testing.assert_array_equal(self.part(self.image, name), before[name])
            self.assertIs(smooth.mesh.parts[name], self.mesh.parts[name])

    def test_the_values_are_those_of_the_command(self):
        from surfacediffusion.command import main

        with tempfile.TemporaryDirectory() as folder:
            self.mesh.to_filename(os.path.join(folder, "mesh.gii"))
            surface = os.path.join(folder, "mesh_hemi-L.gii")
            np.save(os.path.join(folder, "a.npy"), self.data["left"])
            with contextlib.redirect_stdout(io.StringIO()):
                code = main(["smooth", surface, os.path.join(folder, "a.npy"), "10",
                             os.path.join(folder, "b.npy")])
            self.assertEqual(code, 0)
            found = np.load(os.path.join(folder, "b.npy"))
        # The file holds coordinates in single precision.
        np.testing.assert_allclose(self.part(smooth_img(self.image, 10), "left"), found, atol=1e-5)

    def test_a_mask_is_the_inside_and_missing_values_are_filled(self):
        inside = {"left": POINTS[:, 2] > -10, "right": POINTS[:, 0] > 0}
        mask = SurfaceImage(self.mesh, {k: v.astype(np.float32) for k, v in inside.items()})
        self.data["left"][::50, 1] = np.nan
        smooth = smooth_img(self.image, 10, mask_img=mask)
        for name, flags in inside.items():
            found = self.part(smooth, name)
            np.testing.assert_array_equal(found[~flags], 0)
            self.assertTrue(np.isfinite(found).all())
        expected = heat((POINTS, FACES), np.where(inside["left"], self.data["left"][:, 0], 0), fwhm=10,
                        roi=inside["left"], **ONE_STEP)
        np.testing.assert_allclose(self.part(smooth, "left")[:, 0], expected, atol=1e-12)

    def test_no_width_keeps_the_values_inside_the_mask_as_nilearn_does(self):
        self.data["left"][7, 1] = np.nan
        mask = SurfaceImage(self.mesh, {k: (POINTS[:, 2] > -10).astype(np.float32) for k in self.data})
        for fwhm in (0, 0.0, None):
            smooth = smooth_img(self.image, fwhm)
            masked = smooth_img(self.image, fwhm, mask_img=mask)
            theirs = nilearn_smooth_img(self.image, fwhm)
            for name, values in self.data.items():
                np.testing.assert_array_equal(self.part(smooth, name), values)
                np.testing.assert_array_equal(self.part(theirs, name), np.nan_to_num(values))
                self.assertFalse(np.shares_memory(self.part(smooth, name), values))
                expected = np.where(POINTS[:, 2:] > -10, values, 0)
                np.testing.assert_array_equal(self.part(masked, name), expected)

    def test_lists_types_and_one_dimension(self):
        flat = SurfaceImage(self.mesh, {k: v[:, 0].astype(np.float32) for k, v in self.data.items()})
        found = smooth_img([flat, self.image], 10)
        self.assertEqual(len(found), 2)
        self.assertEqual(self.part(found[0], "left").dtype, np.float32)
        np.testing.assert_allclose(np.ravel(self.part(found[0], "left")),
                                   self.part(found[1], "left")[:, 0], atol=1e-5)

    def test_smoothness_is_that_of_each_mesh(self):
        smooth = smooth_img(self.image, 15)
        found = estimate_fwhm_img(smooth)
        self.assertEqual(sorted(found), ["left", "right"])
        self.assertEqual(found["left"].pooled,
                         estimate_fwhm((POINTS, FACES), self.part(smooth, "left")).pooled)
        for estimate in found.values():
            self.assertAlmostEqual(estimate.pooled / 15, 1, delta=0.1)

    def test_what_is_no_image_or_no_width_is_an_error(self):
        for image in (self.mesh, "image.gii", None):
            with self.assertRaisesRegex(ValueError, "img is .*; allowed: a SurfaceImage of nilearn"):
                smooth_img(image, 10)
        for fwhm in (-1, False, np.nan, np.inf, [10]):
            with self.assertRaisesRegex(ValueError, "fwhm is .*; allowed: finite numbers, 0 or more, or None"):
                smooth_img(self.image, fwhm)
        with self.assertRaisesRegex(ValueError, "mask_img is .*; allowed: a SurfaceImage"):
            smooth_img(self.image, 10, mask_img=self.data)


if __name__ == "__main__":
    unittest.main(verbosity=2)
