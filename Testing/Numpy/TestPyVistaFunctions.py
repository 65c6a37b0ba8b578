# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The functions for PyVista meshes, with any VTK."""

import inspect
import sys
import unittest

try:
    import pyvista
except ImportError:
    print("PyVista is not available")
    sys.exit(77)

import numpy as np

import surfacediffusion as sd
from surfacediffusion.pyvista import (
    curvature, denoise_mesh, derivatives, direction_field, distance, geodesic_disk, geodesic_path,
    harmonic_map, heat, interpolate, intrinsic_tv, mumford_shah, path_through, random_field, relief,
    scale_filter, segment, surrogates, tensor_diffusion, turing_texture,
)


def noisy_sphere(center=(0.0, 0.0, 0.0)):
    mesh = pyvista.Icosphere(nsub=3, center=center)
    z = mesh.points[:, 2] - center[2]
    mesh["f"] = z + np.random.default_rng(1).normal(scale=0.1, size=mesh.n_points)
    mesh["hole"] = (z > 0.4).astype(np.uint8)
    return mesh


def as_surface(mesh):
    return sd.Surface(mesh.points, mesh.faces.reshape(-1, 4)[:, 1:])


def quad_torus(spare):
    """A closed torus of as many quadrilaterals as points, and `spare` points more that no cell uses. Its
    cell arrays are no means of point arrays."""
    columns, rows = 20, 12
    j, i = np.divmod(np.arange(columns * rows), columns)
    u, v = 2 * np.pi * i / columns, 2 * np.pi * j / rows
    points = np.column_stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)])
    right, up = (i + 1) % columns, (j + 1) % rows
    faces = np.column_stack([columns * j + i, columns * j + right, columns * up + right, columns * up + i])
    mesh = pyvista.PolyData.from_regular_faces(np.vstack([points, np.zeros((spare, 3))]), faces)
    mesh.point_data["p"] = mesh.points[:, 0] * mesh.points[:, 2]
    mesh.point_data["marks"] = (np.arange(mesh.n_points) % 240 < 60).astype(float)
    mesh.cell_data["part"] = np.roll(np.arange(240) < 60, 30).astype(float)
    mesh.cell_data["c"] = mesh.cell_centers().points[:, 1]
    mesh.cell_data["speed"] = 1.0 + mesh.cell_data["part"]
    mesh.cell_data["labels"] = np.where(np.arange(240) < 20, 1, 2 * (np.arange(240) >= 220))
    mesh.cell_data["around"] = np.cross([0.0, 0.0, 1.0], mesh.cell_centers().points)
    mesh.cell_data["few"] = np.where(np.arange(240) % 7 == 0, mesh.cell_data["c"], np.nan)
    return mesh


class AsManyPointsAsCells(unittest.TestCase):
    def assert_arrays_stay_at_their_places(self, function, *arguments, **keywords):
        found, expected = (function(quad_torus(spare), *arguments, **keywords) for spare in (0, 1))
        np.testing.assert_allclose(found.points, expected.points[:240], atol=1e-9)
        self.assertEqual(found.point_data.keys(), expected.point_data.keys())
        self.assertEqual(found.cell_data.keys(), expected.cell_data.keys())
        for name, values in found.point_data.items():
            np.testing.assert_allclose(values, expected.point_data[name][:240], atol=1e-9, err_msg=name)
        for name, values in found.cell_data.items():
            np.testing.assert_allclose(values, expected.cell_data[name], atol=1e-9, err_msg=name)

    def test_arrays_of_models_stay_at_their_places(self):
        for keywords in ({"mask": "part"}, {"roi": "part"}, {"fixed": "part"},
                         {"fidelity": "part", "fidelity_weight": 1.0},
                         {"direction": "around", "along_diffusivity": 5.0}):
            with self.subTest(**keywords):
                self.assert_arrays_stay_at_their_places(heat, "p", time_step=1.0, **keywords)
        for keywords in ({"mask": "marks"}, {"roi": "marks"}, {"fixed": "marks"}):
            with self.subTest(**keywords):
                self.assert_arrays_stay_at_their_places(heat, "c", time_step=1.0, **keywords)
        for function, array in ((intrinsic_tv, "p"), (mumford_shah, "p"), (tensor_diffusion, "p"),
                                (harmonic_map, "around"), (turing_texture, None)):
            with self.subTest(function=function.__name__):
                self.assert_arrays_stay_at_their_places(
                    function, array, mask="marks" if array == "around" else "part", number_of_time_steps=2)

    def test_arrays_of_other_functions_stay_at_their_places(self):
        for function, arguments, keywords in (
                (segment, ("p",), {"seeds": "labels"}),
                (segment, ("p",), {"mask": "part"}),
                (segment, ("c",), {"fidelity": "marks"}),
                (interpolate, ("p",), {"mask": "part", "smoothing": 0.1}),
                (interpolate, ("few",), {"roi": "marks", "smoothing": 0.1}),
                (interpolate, ("p",), {"fidelity": "part", "smoothing": 0.1}),
                (interpolate, ("p",), {"direction": "around", "along_diffusivity": 5.0, "smoothing": 0.1}),
                (denoise_mesh, (), {"fixed": "part", "noise_level": 0.05}),
                (relief, ("marks", 0.1), {"mask": "part"}),
                (curvature, (), {"mask": "part"}),
                (curvature, (), {"roi": "part"}),
                (derivatives, ("p",), {"mask": "part"}),
                (direction_field, ("around",), {"method": "Hints"}),
                (distance, ([100],), {"speed": "speed"}),
                (distance, ([200],), {"mask": "part"}),
                (distance, ([100],), {"direction": "around", "along_speed": 3.0}),
                (distance, ([100],), {"direction": "around", "along_speed": "speed", "across_speed": 2.0}),
                (random_field, (), {"fwhm": 1.5, "mask": "part"}),
                (scale_filter, ("p",), {"wavelength": 3.0, "mask": "part"}),
                (surrogates, ("p", 3), {"roi": "part"})):
            with self.subTest(function=function.__name__, **keywords):
                self.assert_arrays_stay_at_their_places(function, *arguments, **keywords)

    def test_missing_values_are_left_out_beside_a_mask_of_cells(self):
        def filtered(mesh, _=None):
            mesh.point_data["p"][3] = np.nan
            return scale_filter(mesh, "p", wavelength=3.0, mask="part")

        self.assert_arrays_stay_at_their_places(filtered)


class Meshes(unittest.TestCase):
    def test_heat_is_that_of_the_arrays(self):
        mesh = noisy_sphere()
        before = mesh.active_scalars_name
        smooth = heat(mesh, "f", fwhm=0.4)
        self.assertIsInstance(smooth, pyvista.PolyData)
        np.testing.assert_array_equal(
            smooth["fDiffused"], sd.heat(as_surface(mesh), mesh["f"], fwhm=0.4))
        self.assertEqual(smooth.active_scalars_name, "fDiffused")
        self.assertNotIn("fDiffused", mesh.array_names)
        self.assertEqual(mesh.active_scalars_name, before)

    def test_refinement_takes_data_along_and_is_that_of_the_arrays(self):
        mesh = pyvista.Icosphere(nsub=1).compute_normals(split_vertices=False)
        mesh["f"] = mesh.points[:, 2]
        mesh["label"] = np.arange(mesh.n_points)
        mesh.cell_data["c"] = np.arange(mesh.n_cells) ** 2
        smooth = heat(mesh, "f", fwhm=0.4, RefineTo=0.2)
        fine = sd.refine(as_surface(mesh), 0.2)
        self.assertGreater(smooth.n_cells, 4 * mesh.n_cells)
        np.testing.assert_array_equal(
            smooth["fDiffused"], sd.heat(as_surface(mesh), mesh["f"], fwhm=0.4, refine_to=0.2))
        np.testing.assert_array_equal(smooth["label"], fine.at_points(mesh["label"]))
        np.testing.assert_array_equal(smooth.cell_data["vtkOriginalCellIds"], fine.faces)
        np.testing.assert_array_equal(smooth.cell_data["c"], fine.faces.astype(int) ** 2)
        self.assertEqual(smooth.point_data.active_normals_name, "Normals")
        self.assertEqual(smooth.active_scalars_name, "fDiffused")
        pair = pyvista.MultiBlock([mesh, None, pyvista.Icosphere(nsub=2)])
        with self.assertWarnsRegex(sd.SurfaceDiffusionWarning, "edges were bisected, to [0-9]+ triangles"):
            textures = turing_texture(pair, feature_size=0.5, number_of_time_steps=2)
        self.assertGreater(textures[0].n_points, mesh.n_points)
        self.assertEqual(len(textures[2]["Texture"]), textures[2].n_points)
        raised = relief(textures[0], "Texture", 0.01, refine_to=0.03)
        self.assertEqual(len(raised["ReliefHeight"]), raised.n_points)
        self.assertGreater(raised.n_points, textures[0].n_points)

    def test_heat_without_a_width_is_the_error_of_the_arrays(self):
        mesh = noisy_sphere()
        for keywords in ({}, {"times": [0, 1]}, {"fwhm": 0}, {"number_of_time_steps": 3}):
            with self.assertRaisesRegex(ValueError, "has no width; allowed: one of fwhm"):
                heat(mesh, "f", **keywords)
        for keywords in ({"TimeStep": 1.0}, {"Mode": "SteadyState"}, {"FWHM": 0.1}):
            self.assertIn("fDiffused", heat(mesh, "f", **keywords).array_names)

    def test_region_of_interest_is_that_of_the_arrays(self):
        mesh = noisy_sphere()
        mesh["roi"] = np.where(mesh["hole"] == 0, 1.0, np.nan)
        mesh.cell_data["faces"] = (mesh.cell_centers().points[:, 0] > 0.2).astype(int)
        for name in ("roi", "faces"):
            roi = mesh.point_data[name] if name == "roi" else mesh.cell_data[name]
            inside = heat(mesh, "f", roi=name, fwhm=0.4)["fDiffused"]
            np.testing.assert_array_equal(
                inside, sd.heat(as_surface(mesh), mesh["f"], roi=roi, fwhm=0.4))
        outside = mesh["hole"] != 0
        for function, name in ((intrinsic_tv, "fTV"), (tensor_diffusion, "fBeltrami"),
                               (mumford_shah, "fMumfordShah")):
            found = function(mesh, "f", roi="roi", number_of_time_steps=1)[name]
            np.testing.assert_array_equal(found[outside], mesh["f"][outside])
            self.assertFalse((found == mesh["f"]).all())
        np.testing.assert_array_equal(segment(mesh, "f", roi="roi")["RegionId"] == 0, outside)
        mesh["all"] = np.ones(mesh.n_points)
        np.testing.assert_array_equal(heat(mesh, "f", roi="all", fwhm=0.4)["fDiffused"],
                                      heat(mesh, "f", fwhm=0.4)["fDiffused"])
        mesh["none"] = np.zeros(mesh.n_points)
        for keywords, words in (({"mask": "hole"}, "mask and roi are both given"),
                                ({"MaskMode": "Inpaint"}, "mask_mode is 'Inpaint' with roi"),
                                ({"roi": "none"}, "roi is 0 everywhere"),
                                ({"roi": "nothing"}, "roi is 'nothing'; allowed: point or cell")):
            with self.assertRaisesRegex(ValueError, words):
                heat(mesh, "f", fwhm=0.4, **{"roi": "roi", **keywords})

    def test_data_are_by_default_the_active_scalars_of_the_mesh(self):
        mesh = pyvista.Icosphere(nsub=3)
        mesh.clear_data()
        mesh.point_data["p"], mesh.cell_data["c"] = mesh.points[:, 0], mesh.cell_centers().points[:, 2]
        mesh.point_data["both"], mesh.cell_data["both"] = mesh["p"] ** 2, mesh["c"] ** 2
        calls = ((heat, {"fwhm": 0.3}), (intrinsic_tv, {"number_of_time_steps": 1}),
                 (tensor_diffusion, {"number_of_time_steps": 1}),
                 (mumford_shah, {"number_of_time_steps": 1}), (segment, {}),
                 (interpolate, {"smoothing": 0.1}), (derivatives, {"quantity": "Laplacian"}))
        ends = ("Diffused", "TV", "Beltrami", "MumfordShah", "Segmented", "Interpolated", "Laplacian")
        for active, place in (("c", "cell"), ("p", "point"), ("both", "cell"), ("both", "point")):
            mesh.set_active_scalars(active, preference=place)
            for (function, keywords), end in zip(calls, ends):
                with self.subTest(function=function.__name__, active=active, place=place):
                    found = function(mesh, **keywords)
                    data = mesh.cell_data if place == "cell" else mesh.point_data
                    alone = pyvista.PolyData(mesh.points, mesh.faces)
                    (alone.cell_data if place == "cell" else alone.point_data)[active] = data[active]
                    np.testing.assert_array_equal(
                        found[active + end], function(alone, active, **keywords)[active + end])
                    self.assertEqual(set(found.array_names) & {name + end for name in ("p", "c", "both")},
                                     {active + end})
        mesh.set_active_scalars("p")
        for function, keywords, end in ((scale_filter, {"wavelength": 1.0}, "Filtered"),
                                        (surrogates, {"n": 2}, "Surrogates")):
            self.assertIn("p" + end, function(mesh, **keywords).array_names)
        mesh.set_active_scalars("c")
        self.assertIn("cDiffused", heat(mesh, fwhm=0.3, refine_to=0.15).array_names)
        self.assertIn("cDiffused", heat(pyvista.MultiBlock([mesh]), fwhm=0.3)[0].array_names)
        self.assertIn("cFiltered", scale_filter(mesh, wavelength=1.0).cell_data)

    def test_the_array_of_a_result_is_the_data_of_the_next_function(self):
        mesh = pyvista.Icosphere(nsub=3)
        mesh.clear_data()
        mesh.point_data["p"], mesh.cell_data["c"] = mesh.points[:, 0], mesh.cell_centers().points[:, 2]
        twice = heat(heat(mesh, "c", fwhm=0.3), fwhm=0.3)
        self.assertIn("cDiffusedDiffused", twice.cell_data)
        of_points = derivatives(mesh, "p", quantity="Laplacian")
        self.assertIn("pLaplacianDiffused", heat(of_points, fwhm=0.3).point_data)
        of_cells = derivatives(mesh, "p", quantity="Laplacian", result_on_faces=True)
        self.assertIn("pLaplacianDiffused", heat(of_cells, fwhm=0.3).cell_data)

    def test_both_spellings_of_keywords(self):
        mesh = noisy_sphere()
        np.testing.assert_array_equal(
            heat(mesh, "f", FWHM=0.4, NumberOfTimeSteps=3)["fDiffused"],
            heat(mesh, "f", fwhm=0.4, number_of_time_steps=3)["fDiffused"])
        self.assertIn("g", heat(mesh, "f", fwhm=0.4, ResultArrayName="g").array_names)

    def test_results_are_named_and_returned(self):
        mesh = noisy_sphere()
        named = mumford_shah(mesh, "f", number_of_time_steps=1, result_array_name="g")
        self.assertLessEqual({"g", "gEdges"}, set(named.array_names))
        self.assertNotIn("Edges", named.array_names)
        regions, report = segment(mesh, "f", mask="hole", return_result=True)
        np.testing.assert_array_equal(regions["RegionId"], report.values)
        self.assertIn("myShapeIndex", curvature(mesh, result_array_name="my").array_names)
        curved, report = curvature(mesh, FWHM=0.2, return_result=True)
        np.testing.assert_array_equal(curved["PrincipalCurvatures"], report.principal)
        self.assertEqual(random_field(mesh, range=0.9, result_array_name="my")["myRandomField"].shape,
                         (mesh.n_points,))

    def test_fields_scales_and_surrogates_at_cells_are_those_of_the_arrays(self):
        mesh = pyvista.Icosphere(nsub=3)
        surface = as_surface(mesh)
        mesh.cell_data["c"] = sd.random_field(surface, fwhm=0.7, on_faces=True)[:, 0]
        mesh.cell_data["part"] = (mesh.cell_centers().points[:, 2] > 0.3).astype(np.uint8)
        masked = {"mask": sd.on_faces(mesh.cell_data["part"])}
        for found, name, expected in (
                (scale_filter(mesh, "c", wavelength=1.5, mask="part"), "cFiltered",
                 sd.scale_filter(surface, mesh["c"], 1.5, **masked)),
                (surrogates(mesh, "c", 3, mask="part"), "cSurrogates", sd.surrogates(surface, mesh["c"], 3, **masked).values),
                (random_field(mesh, 2, range=0.9, nu=1.5, on_faces=True), "RandomField",
                 sd.random_field(surface, 2, range=0.9, nu=1.5, on_faces=True))):
            np.testing.assert_array_equal(found.cell_data[name], expected)
            self.assertEqual(found.active_scalars_info.association, pyvista.FieldAssociation.CELL)
        mesh.point_data["range"] = 0.6 + 0.3 * mesh.points[:, 0]
        np.testing.assert_array_equal(random_field(mesh, range="range")["RandomField"],
                                      sd.random_field(surface, range=mesh.point_data["range"])[:, 0])
        # A line among the cells, which is no face.
        lined = pyvista.PolyData(mesh.points, faces=mesh.faces, lines=np.array([2, 0, 1]))
        lined.cell_data["c"] = np.arange(float(lined.n_cells))
        found = scale_filter(lined, "c", wavelength=1.5)["cFiltered"]
        self.assertEqual(np.isnan(found).sum(), 1)

    def test_blocks_without_the_array_stay(self):
        ball, bare = noisy_sphere(), pyvista.Icosphere(nsub=3)
        blocks = derivatives(pyvista.MultiBlock([ball, bare]), "f", quantity="Laplacian")
        self.assertIn("fLaplacian", blocks[0].point_data)
        self.assertNotIn("fLaplacian", blocks[1].point_data)
        with self.assertRaisesRegex(ValueError, "array is 'w'; allowed: point or cell arrays"):
            derivatives(ball, "w")

    def test_distance_from_arrays_points_and_data_sets(self):
        ball = pyvista.Icosphere(nsub=4)
        surface = as_surface(ball)
        ball["label"] = np.where(np.arange(ball.n_points) == 3, 5, 2 * (np.arange(ball.n_points) == 40))
        ball["v"] = np.full(ball.n_points, 0.5)
        found = distance(ball, "label")
        self.assertEqual(found.point_data.active_scalars_name, "Distance")
        np.testing.assert_array_equal(found["Distance"], sd.distance(surface, [3, 40]))
        nearest = sd.nearest_sources(surface, [3, 40]).source
        np.testing.assert_array_equal(found["NearestSource"], np.array([5, 2])[nearest])
        found = distance(ball, [40, 3], method="Heat", result_array_name="my")
        np.testing.assert_array_equal(
            found["myDistance"], sd.distance(surface, [40, 3], method="Heat"))
        np.testing.assert_array_equal(found["myNearestSource"], np.array([3, 40])[nearest])
        places = pyvista.PolyData(1.2 * ball.points[[7, 90]])
        blocks = distance(pyvista.MultiBlock([ball, None, ball.copy()]), places, speed="v")
        np.testing.assert_allclose(
            blocks[2]["ArrivalTime"], sd.distance(surface, [7, 90], speed=ball["v"]), atol=1e-6)
        self.assertEqual(set(blocks[0]["NearestSource"]), {0, 1})
        two = ball.merge(ball.translate((5, 0, 0), inplace=False))
        apart = distance(two, 3)
        self.assertEqual(np.isinf(apart["Distance"]).sum(), ball.n_points)
        self.assertEqual(set(apart["NearestSource"]), {3, -1})
        with self.assertRaisesRegex(ValueError, "sources is 'none'; allowed: point arrays"):
            distance(ball, "none")
        for sources in ([40, 3, 41], np.isin(np.arange(ball.n_points), [40, 3, 41])):
            fine = distance(ball, sources, refine_to=0.05)
            expected = sd.nearest_sources(surface, sources, refine_to=0.05)
            np.testing.assert_array_equal(fine["Distance"], expected.distance)

    def test_paths_and_disks_are_polylines(self):
        ball = pyvista.Icosphere(nsub=4)
        surface = as_surface(ball)
        drawn, path = geodesic_path(ball, 5, [0, 0, 2]), sd.geodesic_path(surface, 5, [0, 0, 2])
        self.assertEqual((drawn.n_lines, drawn.n_points), (1, len(path.points)))
        np.testing.assert_array_equal(drawn.field_data["Length"], [path.length])
        np.testing.assert_array_equal(drawn.field_data["Cells"], path.faces)
        np.testing.assert_allclose(drawn.compute_cell_sizes()["Length"], path.length, rtol=1e-6)
        around = path_through(ball, pyvista.PolyData(ball.points[[3, 50, 700]]), closed=True)
        want = sd.path_through(surface, ball.points[[3, 50, 700]], True).length
        np.testing.assert_allclose(around.field_data["Length"], want, rtol=1e-9)
        disk = geodesic_disk(ball, 9, 0.4)
        self.assertEqual(disk.n_lines, 1)
        np.testing.assert_array_equal(disk.field_data["Area"], [sd.geodesic_disk(surface, 9, 0.4).area])
        self.assertEqual(geodesic_disk(ball, 9, 9.0).n_points, 0)
        self.assertEqual(geodesic_path(ball, 5, 5).n_points, 1)
        ball["cap"] = (ball.points[:, 2] > 0.5).astype(float)
        np.testing.assert_array_equal(
            distance(ball, "cap", signed=True)["Distance"] < 0, ball["cap"] > 0)
        with self.assertRaisesRegex(ValueError, "the mesh has 2 blocks .*allowed: one"):
            geodesic_path(pyvista.MultiBlock([ball, ball.copy()]), 0, 1)

    def test_fields_and_scales_are_those_of_the_arrays(self):
        ball = noisy_sphere()
        surface = as_surface(ball)
        found = scale_filter(ball, "f", wavelength=1.5, order=2)
        np.testing.assert_array_equal(
            found["fFiltered"], sd.scale_filter(surface, ball["f"], 1.5, order=2))
        ball["width"] = 1.0 + np.abs(ball.points[:, 0])
        np.testing.assert_array_equal(scale_filter(ball, "f", wavelength="width")["fFiltered"],
                                      sd.scale_filter(surface, ball["f"], ball["width"]))
        null = surrogates(ball, "f", 3, seed=2)
        np.testing.assert_array_equal(null["fSurrogates"], sd.surrogates(surface, ball["f"], 3, seed=2).values)
        blocks = random_field(pyvista.MultiBlock([ball, None, noisy_sphere((3, 0, 0))]), fwhm=0.6)
        self.assertIn("RandomField", blocks[2].point_data)
        with self.assertRaisesRegex(ValueError, "array is 'none'; allowed: point or cell arrays"):
            scale_filter(ball, "none", wavelength=1.0)
        with self.assertRaisesRegex(ValueError, "fwhm and range are not given"):
            random_field(ball)

    def test_regions_of_interest_are_the_opposite_of_masks(self):
        ball = pyvista.Icosphere(nsub=3)
        ball["z"], ball["inside"] = ball.points[:, 2], ball.points[:, 0] > -0.3
        ball["outside"] = ~ball["inside"]
        for function, array in ((curvature, "MeanCurvature"), (derivatives, "zGradient")):
            values = ("z",) if function is derivatives else ()
            np.testing.assert_array_equal(function(ball, *values, roi="inside")[array],
                                          function(ball, *values, mask="outside")[array])
            with self.assertRaisesRegex(ValueError, "mask and roi are both given"):
                function(ball, *values, roi="inside", mask="outside")

    def test_meshes_are_denoised_block_by_block(self):
        ball = pyvista.Icosphere(nsub=4)
        noise = np.random.default_rng(5).normal(scale=0.005, size=(ball.n_points, 1))
        mesh = pyvista.PolyData(ball.points * (1 + noise).astype(np.float32), ball.faces)
        mesh.point_data["n"] = np.array(mesh.points)
        mesh.point_data.active_normals_name = "n"
        mesh["north"] = (mesh.points[:, 2] > 0.3).astype(np.uint8)
        mesh.cell_data["ofCells"] = np.array(mesh.face_normals)
        mesh.cell_data.active_normals_name = "ofCells"
        before = np.array(mesh.points)
        blocks = pyvista.MultiBlock([mesh, None, mesh.scale(10.0, inplace=False)])
        denoised, reports = denoise_mesh(blocks, fixed="north", return_result=True)
        self.assertEqual(len(reports), 2)
        self.assertAlmostEqual(reports[1].noise_level / reports[0].noise_level, 10.0, delta=0.01)
        np.testing.assert_array_equal(mesh.points, before)
        moved = denoised[0]
        self.assertEqual(moved.points.dtype, before.dtype)
        north = mesh["north"] != 0
        np.testing.assert_array_equal(moved.points[north], before[north])
        self.assertEqual(moved.point_data.active_normals_name, "n")
        radial = moved.points / np.linalg.norm(moved.points, axis=1, keepdims=True)
        cosines = np.einsum("ij,ij->i", moved["n"], radial)[~north]
        # The triangles of PyVista 0.44's icosphere face inwards.
        self.assertGreater((np.sign(cosines[0]) * cosines).min(), 0.97)
        np.testing.assert_array_equal(mesh["n"], before)
        # Normals, of points and of cells, are those of the moved points, on their former side.
        found = moved.cell_data["ofCells"]
        self.assertEqual((moved.cell_data.active_normals_name, moved["n"].dtype), ("ofCells", mesh["n"].dtype))
        self.assertGreater(np.abs(found - mesh.cell_data["ofCells"]).max(), 0.01)
        a, b, c = moved.points[moved.regular_faces].transpose(1, 0, 2)
        np.testing.assert_allclose(np.einsum("ij,ij->i", found, np.cross(b - a, c - a)),
                                   2 * moved.compute_cell_sizes()["Area"], rtol=1e-4)
        np.testing.assert_allclose(np.linalg.norm(moved["n"], axis=1), 1.0, atol=1e-6)
        self.assertIn("ofCells", mesh.cell_data)
        self.assertLess(np.linalg.norm(moved.points, axis=1)[~north].std(), 0.003)
        np.testing.assert_allclose(before + moved["Displacement"], moved.points, atol=1e-7)
        np.testing.assert_allclose(moved.points, sd.denoise_mesh(as_surface(mesh), fixed=north),
                                   atol=1e-7)

    def test_relief_moves_the_points_of_each_block(self):
        ball = pyvista.PolyData(10 * sd.sphere(4).points, np.insert(sd.sphere(4).triangles, 0, 3, axis=1))
        ball["v"] = 0.5 + 0.5 * np.sign(ball.points[:, 2])
        ball.cell_data["c"] = np.arange(ball.n_cells)
        ball.cell_data["south"] = (ball.cell_centers().points[:, 2] < 0).astype(np.uint8)
        blocks, reports = relief(pyvista.MultiBlock([ball, None, ball.scale(2.0, inplace=False)]), "v",
                                 0.5, base=0.1, mask="south", return_result=True)
        self.assertEqual([report.open_edges for report in reports], [0, 0])
        for block, size in ((blocks[0], 10), (blocks[2], 20)):
            radius = np.linalg.norm(block.points, axis=1)
            north = block.points[:, 2] > 0.2 * size
            np.testing.assert_allclose(radius[north], size + 0.6, atol=1e-2)
            np.testing.assert_allclose(radius[block.points[:, 2] < -1e-6], size, rtol=1e-6)
            np.testing.assert_array_equal(block["ReliefHeight"][north], 0.6)
        expected = sd.relief(as_surface(ball), ball["v"], 0.5, levels="Two", flank=1.0)
        inwards = ball.copy()
        inwards.faces = np.insert(sd.sphere(4).triangles[:, ::-1], 0, 3, axis=1).ravel()
        for mesh in (ball, inwards):
            raised = relief(mesh, "v", 0.5, levels="Two", flank=1.0)
            np.testing.assert_allclose(raised.points, expected.surface.points, atol=1e-5)
            self.assertGreater(raised.volume, ball.volume)
            np.testing.assert_array_equal(raised["c"], ball["c"])
        with self.assertRaisesRegex(ValueError, "array is 'none'; allowed: point arrays"):
            relief(ball, "none", 1.0)

    def test_blocks_are_segmented_one_by_one(self):
        mesh = noisy_sphere()
        mesh["terms"] = np.stack([mesh.points[:, 0], -mesh.points[:, 0]], axis=1)
        mesh["w"] = np.where(mesh.points[:, 1] > 0.5, 0.0, 1.0)
        blocks = pyvista.MultiBlock([mesh, mesh.scale(2.0, inplace=False)])
        regions, reports = segment(blocks, terms="terms", fidelity="w", return_result=True)
        self.assertEqual(len(reports), 2)
        for block in regions:
            self.assertNotIn("fSegmented", block.array_names)
            np.testing.assert_array_equal(
                block["RegionId"][np.abs(mesh.points[:, 0]) > 0.2],
                np.where(mesh.points[:, 0] > 0.2, 2, 1)[np.abs(mesh.points[:, 0]) > 0.2])
        self.assertAlmostEqual(reports[1].areas[0] / reports[0].areas[0], 4.0, places=6)
        with self.assertRaisesRegex(ValueError, "array is None"):
            segment(pyvista.Sphere())

    def test_values_at_points_are_interpolated_as_those_of_arrays(self):
        mesh = noisy_sphere()
        probes = pyvista.PolyData(1.1 * mesh.points[::9])
        probes["t"] = mesh.points[::9, 2].astype(float)
        probes["w"] = np.where(np.arange(probes.n_points) % 4 == 0, 0.0, 1.0)
        probes.set_active_scalars("t")
        result = interpolate(mesh, points=probes, fidelity="w", compute_error=True)
        expected = sd.interpolate(as_surface(mesh), probes["t"], probes.points, fidelity=probes["w"],
                                  compute_error=True)
        np.testing.assert_array_equal(result["tInterpolated"], expected.values)
        np.testing.assert_array_equal(result["tError"], expected.error)
        self.assertEqual(result.point_data.active_scalars_name, "tInterpolated")
        self.assertNotIn("tInterpolated", mesh.array_names)
        probes["other"] = 2.0 * probes["t"]
        named = interpolate(mesh, "other", points=probes, exact=True, compute_error=True, result_array_name="u")
        self.assertIn("uError", named.point_data)
        np.testing.assert_allclose(
            named["u"], 2.0 * interpolate(mesh, "t", points=probes, exact=True)["tInterpolated"], atol=1e-12)
        blocks, reports = interpolate(pyvista.MultiBlock([mesh, None, mesh.scale(1.2, inplace=False)]),
                                      points=probes, array="t", return_result=True)
        self.assertEqual([report.number_of_values for report in reports], [probes.n_points] * 2)
        np.testing.assert_array_equal(blocks[2]["tInterpolated"], reports[1].values)
        for message, options in (
                ("array is 'none'; allowed: point arrays of points, 't', 'w', 'other'", {"array": "none"}),
                ("fidelity is 'hole'; allowed: point arrays of points", {"array": "t", "fidelity": "hole"})):
            with self.assertRaisesRegex(ValueError, message):
                interpolate(mesh, points=probes, **options)
        with self.assertRaisesRegex(ValueError, "array is None, and there are no active scalars"):
            interpolate(mesh, points=pyvista.PolyData(mesh.points[:5]))

    def test_times_and_history(self):
        mesh = noisy_sphere()
        states, results = heat(mesh, "f", time_step=1.0, times=[3.0, 0.0, 1.5, 99.0],
                               return_result=True)
        np.testing.assert_array_equal(states[1]["fDiffused"], mesh["f"])
        for state, steps in zip(states, (3, 0, 1, 10)):
            np.testing.assert_array_equal(
                state["fDiffused"],
                heat(mesh, "f", time_step=1.0, number_of_time_steps=steps)["fDiffused"])
        self.assertEqual([result.step for result in results], [3, 0, 1, 10])
        _, result = heat(mesh, "f", time_step=1, return_result=True)
        self.assertTrue((np.diff(result.history["Energy"]) < 0).all())
        with self.assertWarnsRegex(DeprecationWarning, r"^full_output of heat\(\) is deprecated: it is "
                                                       "return_result$"):
            _, again = heat(mesh, "f", time_step=1, full_output=True)
        np.testing.assert_array_equal(again.history["Energy"], result.history["Energy"])

    def test_blocks_share_their_units_and_empty_ones_pass(self):
        far = noisy_sphere(center=(5.0, 0.0, 0.0))
        blocks = pyvista.MultiBlock({"a": noisy_sphere(), "none": None, "empty": pyvista.PolyData(),
                                     "nested": pyvista.MultiBlock({"b": far}),
                                     "bare": pyvista.Plane()})
        blocks["a"].points *= 2.0
        output, results = heat(blocks, "f", time_step=1, return_result=True)
        self.assertEqual(list(output.keys()), list(blocks.keys()))
        self.assertEqual(len(results), 2)
        self.assertEqual(results[0].mean_edge_length, results[1].mean_edge_length)
        self.assertIn("fDiffused", output["nested"]["b"].array_names)
        self.assertNotIn("fDiffused", output["bare"].array_names)
        self.assertEqual(output["empty"].n_points, 0)
        self.assertIsNone(output["none"])
        self.assertNotIn("fDiffused", blocks["a"].array_names)

    def test_polygons_strips_lines_and_hidden_cells(self):
        quads = pyvista.Plane(i_resolution=8, j_resolution=6)
        quads["f"] = np.sin(5 * quads.points[:, 0])
        smooth = heat(quads, "f", fwhm=0.2)
        np.testing.assert_array_equal(
            smooth["fDiffused"], sd.heat(sd.Surface(quads.points, quads.regular_faces), quads["f"],
                                         fwhm=0.2))
        triangles = quads.triangulate()
        strips = triangles.strip()
        self.assertGreater(strips.n_strips, 0)
        np.testing.assert_allclose(heat(strips, "f", fwhm=0.2)["fDiffused"],
                                   heat(triangles, "f", fwhm=0.2)["fDiffused"], rtol=0, atol=1e-9)
        with self.assertRaisesRegex(TypeError, "strips.*mesh.triangulate"):
            direction_field(strips)
        mixed = pyvista.PolyData(
            np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0.5, 0.0]]),
            faces=[4, 0, 1, 2, 3, 3, 1, 4, 2], lines=[2, 0, 4], verts=[1, 3])
        field = direction_field(mixed, method="Smooth")["Direction"]
        np.testing.assert_allclose(np.linalg.norm(field, axis=1), [0, 0, 1, 1])
        quads.cell_data["vtkGhostType"] = np.where(np.arange(48) < 24, 0, 32).astype(np.uint8)
        hidden = heat(quads, "f", fwhm=0.2)
        np.testing.assert_array_equal(hidden["fDiffused"][-9:], quads["f"][-9:])
        of_points = quads.copy()
        of_points.point_data["vtkGhostType"] = np.where(np.arange(63) < 36, 0, 2).astype(np.uint8)
        of_points.cell_data.remove("vtkGhostType")
        np.testing.assert_array_equal(heat(of_points, "f", fwhm=0.2)["fDiffused"], hidden["fDiffused"])

    @unittest.skipUnless(hasattr(pyvista, "register_dataset_accessor"), "needs PyVista 0.48")
    def test_functions_are_methods_of_meshes(self):
        mesh = noisy_sphere()
        np.testing.assert_array_equal(mesh.diffusion.heat("f", fwhm=0.4)["fDiffused"],
                                      heat(mesh, "f", fwhm=0.4)["fDiffused"])
        self.assertIn("fDiffused", pyvista.MultiBlock([mesh]).diffusion.heat("f", fwhm=1)[0].array_names)

    def test_signatures_have_the_keywords_of_the_arrays(self):
        import surfacediffusion as sd
        from surfacediffusion import pyvista as functions

        for name in sd._functions.__all__:
            own = inspect.signature(getattr(functions, name)).parameters
            settings = sd._settings.settings_of(name)
            self.assertGreater(len(settings), 1, name)
            for keyword in settings:
                self.assertEqual(
                    own[keyword].default,
                    inspect.signature(getattr(sd, name)).parameters[keyword].default, keyword)
            method = inspect.signature(getattr(functions._Accessor, name)).parameters
            self.assertEqual(list(method)[1:], list(own)[1:], name)

    def test_answers_to_other_data(self):
        mesh = noisy_sphere()
        for other in (pyvista.ImageData(dimensions=(3, 3, 3)),
                      mesh.cast_to_unstructured_grid(),
                      pyvista.MultiBlock([mesh, mesh.cast_to_unstructured_grid()])):
            with self.assertRaisesRegex(TypeError, "allowed: pyvista.PolyData.*extract_surface"):
                heat(other, "f", fwhm=1)
        with self.assertRaisesRegex(TypeError, "the mesh is a (pyvista_)?ndarray; allowed: pyvista.PolyData"):
            heat(np.asarray(mesh.points), "f", fwhm=1)
        with self.assertRaisesRegex(ValueError, "array is 'g'; allowed: point or cell arrays, 'f', 'hole'"):
            heat(mesh, "g", fwhm=1)
        with self.assertRaisesRegex(ValueError, "mask is 'h'; allowed: point or cell arrays, 'f', 'hole'"):
            heat(mesh, "f", mask="h", fwhm=1)
        with self.assertRaisesRegex(ValueError, "the mesh is empty"):
            heat(pyvista.PolyData(), "f", fwhm=1)
        with self.assertRaisesRegex(ValueError, "the mesh has no polygons"):
            heat(pyvista.Line(), "f", fwhm=1)
        with self.assertRaisesRegex(ValueError, "fwhm is -1; allowed: finite numbers, 0 or more"):
            heat(mesh, "f", fwhm=-1)
        with self.assertRaisesRegex(ValueError, "direction is not set"):
            heat(mesh, "f", time_step=1, along_diffusivity=2)
        with self.assertRaisesRegex(TypeError, "no keyword 'fhwm'; did you mean 'fwhm'"):
            heat(mesh, "f", fhwm=1)
        for time in ("end", -1, float("nan")):
            with self.assertRaisesRegex(ValueError, f"times has {time!r}; allowed: numbers, 0 or more"):
                heat(mesh, "f", fwhm=1, times=[0, time])
        with self.assertRaisesRegex(ValueError, "times is 3.0; allowed: a list of numbers"):
            heat(mesh, "f", fwhm=1, times=3.0)
        for other in (mesh["f"], ["f"]):
            for function, keywords in ((heat, {"fwhm": 1}), (segment, {}), (interpolate, {}),
                                       (derivatives, {}), (harmonic_map, {})):
                with self.assertRaisesRegex(ValueError, "array is .*; allowed: the name of an array"):
                    function(mesh, other, **keywords)
            with self.assertRaisesRegex(ValueError, "mask is .*; allowed: the name of an array"):
                heat(mesh, "f", fwhm=1, mask=other)
        with self.assertRaisesRegex(ValueError, "points is array.*; allowed: a data set with point arrays"):
            interpolate(mesh, "f", points=np.asarray(mesh.points))
        mesh["nowhere"] = np.zeros(mesh.n_points)
        with self.assertRaisesRegex(ValueError, "sources is 'nowhere', which is 0 at all points; allowed: "):
            distance(mesh, "nowhere")
        bad = mesh.copy()
        bad["f"][3] = np.inf
        with self.assertRaisesRegex(ValueError, "array is infinite at point 3"):
            heat(bad, "f", fwhm=1)


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv)
