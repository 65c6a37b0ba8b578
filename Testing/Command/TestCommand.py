# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command gives the results of the functions, keeps what it is not asked to change, and says
what it did."""

import fcntl
import json
import os
import pty
import re
import struct
import subprocess
import sys
import tempfile
import termios
import unittest
from pathlib import Path

import numpy as np
import samples
from samples import COLOURS, FACES, HAS_VTK, N, NOISE, POINTS, SMOOTH, nib, run

from surfacediffusion import (
    Surface, denoise_mesh, distance, geodesic_path, get_number_of_threads, heat, interpolate, intrinsic_tv,
    nearest_sources, path_through, set_number_of_threads,
)
from surfacediffusion.command.areas import vertex_areas
from surfacediffusion.files import read_data, read_surface

INSIDE = POINTS[:, 2] > -6
#: How the commands that smooth call heat()
ONE_STEP = {"time_integrator": "Exponential", "number_of_time_steps": 1}


class CommandTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        samples.write_surface("lh.surf.gii")
        samples.write_gifti("lh.func.gii", {"one": NOISE, "two": SMOOTH})
        # The functions get the coordinates that the file has.
        self.surface = Surface(read_surface("lh.surf.gii").points, FACES)

    def succeed(self, line):
        code, out, error = run(*line.split())
        self.assertEqual((code, error), (0, ""), line)
        return out

    def report(self, line):
        return json.loads(self.succeed(line + " --json"))

    def column(self, path, column=0):
        return read_data(path).parts[0].values[:, column]


class Smooth(CommandTest):
    def test_words_of_workbench_are_understood(self):
        samples.write_gifti("roi.func.gii", {"roi": INSIDE})
        words = "-fwhm -roi roi.func.gii -fix-zeros -column two"
        self.succeed(f"smooth lh.surf.gii lh.func.gii 5 a.func.gii {words}")
        self.succeed("smooth --roi=roi.func.gii lh.surf.gii lh.func.gii --column 2 5 b.func.gii "
                     "--fix-zeros")
        self.assertEqual(Path("a.func.gii").read_bytes(), Path("b.func.gii").read_bytes())

    def test_the_dash_of_wb_command_may_stay(self):
        self.succeed("-metric-smoothing lh.surf.gii lh.func.gii 2 a.func.gii")
        self.succeed("metric-smoothing lh.surf.gii lh.func.gii 2 b.func.gii")
        self.assertEqual(Path("a.func.gii").read_bytes(), Path("b.func.gii").read_bytes())

    def test_sigma_is_a_standard_deviation(self):
        self.succeed("smooth lh.surf.gii lh.func.gii 2 a.func.gii --sigma")
        self.succeed(f"smooth lh.surf.gii lh.func.gii {2 * (8 * np.log(2))**0.5} b.func.gii")
        np.testing.assert_allclose(self.column("a.func.gii"), self.column("b.func.gii"), 1e-6)

    def test_nan_and_zeros_are_missing(self):
        holes = np.arange(N) % 5 == 0
        samples.write_gifti("nan.func.gii", {"one": np.where(holes, np.nan, SMOOTH)})
        samples.write_gifti("zero.func.gii", {"one": np.where(holes, 0, SMOOTH)})
        self.succeed("smooth lh.surf.gii nan.func.gii 5 a.func.gii")
        self.succeed("smooth lh.surf.gii zero.func.gii 5 b.func.gii --fix-zeros")
        self.succeed("smooth lh.surf.gii zero.func.gii 5 c.func.gii")
        full = heat(self.surface, SMOOTH, fwhm=5, **ONE_STEP)
        found = self.column("a.func.gii")
        np.testing.assert_array_equal(found, self.column("b.func.gii"))
        self.assertLess(np.abs(found - full).max(), 0.05)
        self.assertGreater(np.abs(self.column("c.func.gii") - full).max(), 0.2)

    def test_columns_may_miss_values_at_different_vertices(self):
        columns = {"one": NOISE.copy(), "two": SMOOTH.copy(), "three": NOISE.copy()}
        columns["one"][:9] = np.nan
        columns["two"][20:30] = np.nan
        samples.write_gifti("all.func.gii", columns)
        self.succeed("smooth lh.surf.gii all.func.gii 5 all.out.func.gii")
        for i, (name, values) in enumerate(columns.items()):
            samples.write_gifti("one.func.gii", {name: values})
            self.succeed("smooth lh.surf.gii one.func.gii 5 one.out.func.gii")
            np.testing.assert_array_equal(self.column("all.out.func.gii", i),
                                          self.column("one.out.func.gii"))

    def test_nothing_flows_across_the_boundary_of_the_region(self):
        samples.write_gifti("roi.func.gii", {"roi": INSIDE})
        wild = np.where(INSIDE, NOISE, 1e6)
        samples.write_gifti("wild.func.gii", {"one": wild})
        self.succeed("smooth lh.surf.gii lh.func.gii 5 a.func.gii --roi roi.func.gii --column 1")
        self.succeed("smooth lh.surf.gii wild.func.gii 5 b.func.gii --roi roi.func.gii")
        np.testing.assert_array_equal(self.column("a.func.gii"), self.column("b.func.gii"))
        np.testing.assert_array_equal(self.column("a.func.gii")[~INSIDE], 0)

    def test_a_region_may_be_a_freesurfer_label(self):
        samples.write_label("a.label", np.flatnonzero(INSIDE), np.zeros(INSIDE.sum()))
        samples.write_gifti("roi.func.gii", {"roi": INSIDE})
        self.succeed("smooth lh.surf.gii lh.func.gii 5 a.func.gii --roi a.label")
        self.succeed("smooth lh.surf.gii lh.func.gii 5 b.func.gii --roi roi.func.gii")
        self.assertEqual(Path("a.func.gii").read_bytes(), Path("b.func.gii").read_bytes())

    def test_values_of_a_label_are_smoothed_within_it(self):
        vertices = np.flatnonzero(INSIDE)
        samples.write_label("a.label", vertices, NOISE[vertices])
        self.succeed("smooth lh.surf.gii a.label 5 b.label")
        expected = heat(self.surface, np.where(INSIDE, NOISE, 0), mask=~INSIDE,
                        mask_mode="Exclude", fwhm=5, **ONE_STEP)
        np.testing.assert_allclose(self.column("b.label"), expected[vertices], atol=1e-5)

    def test_each_hemisphere_of_cifti_has_its_surface(self):
        samples.write_surface("rh.surf.gii", POINTS * 1.05, FACES, "CortexRight")
        left = np.flatnonzero(INSIDE)
        rows = np.stack([np.concatenate([NOISE[left], NOISE])] * 2)
        samples.write_cifti("a.dscalar.nii", rows, left=left)
        self.succeed("smooth --left lh.surf.gii --right rh.surf.gii a.dscalar.nii 5 b.dscalar.nii")
        found = np.asarray(nib.load("b.dscalar.nii").dataobj)
        expected = heat(self.surface, np.where(INSIDE, NOISE, 0), mask=~INSIDE,
                        mask_mode="Exclude", fwhm=5, **ONE_STEP)[left]
        np.testing.assert_array_equal(found[0, :len(left)], expected)
        right = Surface(read_surface("rh.surf.gii").points, FACES)
        expected = heat(right, NOISE, fwhm=5, **ONE_STEP)
        np.testing.assert_array_equal(found[1, len(left):], expected)

    def test_split_vertices_of_cifti_surfaces_are_joined_on_request(self):
        split = FACES.ravel()
        samples.write_surface("soup.surf.gii", POINTS[split], np.arange(len(split)).reshape(-1, 3))
        models = nib.cifti2.BrainModelAxis.from_surface(np.arange(len(split)), len(split), "CORTEX_LEFT")
        header = nib.cifti2.Cifti2Header.from_axes((nib.cifti2.ScalarAxis(["one"]), models))
        nib.save(nib.cifti2.Cifti2Image(NOISE[split][None], header), "soup.dscalar.nii")
        self.succeed("smooth soup.dscalar.nii 5 out.dscalar.nii --left soup.surf.gii --merge")
        self.succeed("smooth lh.surf.gii lh.func.gii 5 out.func.gii --column one")
        np.testing.assert_allclose(self.column("out.dscalar.nii"), self.column("out.func.gii")[split], atol=1e-5)

    def test_freesurfer_files(self):
        samples.write_surface("lh.white")
        samples.write_curv("lh.thickness", NOISE)
        samples.write_mgh("lh.mgz", NOISE)
        for name in ("lh.thickness", "lh.mgz"):
            self.succeed(f"smooth lh.white {name} 5 new.{name}")
        np.testing.assert_array_equal(self.column("new.lh.thickness"), self.column("new.lh.mgz"))
        # curv has no metadata, so the name of the output gives its format.
        for name, kind in (("new.mgh", "mgh"), ("new.shape.gii", "gifti"), ("new.npy", "npy")):
            self.succeed(f"smooth lh.white lh.thickness 5 {name}")
            self.assertEqual(read_data(name).kind, kind)
            np.testing.assert_array_equal(self.column(name), self.column("new.lh.thickness"))

    def test_given_areas_widen_or_narrow_the_kernel(self):
        areas = vertex_areas(read_surface("lh.surf.gii"))
        samples.write_gifti("areas.func.gii", {"areas": 4 * areas})
        samples.write_surface("large.surf.gii", 2 * POINTS)
        for word in ("--areas", "-corrected-areas"):
            self.succeed(f"smooth lh.surf.gii lh.func.gii 12 a.func.gii {word} areas.func.gii")
            self.succeed("smooth large.surf.gii lh.func.gii 12 b.func.gii")
            np.testing.assert_allclose(self.column("a.func.gii"), self.column("b.func.gii"), 1e-5)


class OtherCommands(CommandTest):
    def test_denoise_takes_channels_of_a_colour_together(self):
        Path("a.ply").write_bytes(samples.ply_bytes())
        self.succeed("denoise a.ply a.ply b.ply --weight 3")
        surface = Surface(read_surface("a.ply").points, FACES)
        colours = intrinsic_tv(surface, COLOURS.astype(float), fidelity_weight=3,
                               mode="SteadyState")
        quality = intrinsic_tv(surface, SMOOTH, fidelity_weight=3, mode="SteadyState")
        found = read_data("b.ply").parts[0].values
        np.testing.assert_array_equal(found[:, :3], np.clip(np.rint(colours), 0, 255))
        np.testing.assert_array_equal(found[:, 3], quality)

    def test_denoise_takes_models_of_colours(self):
        Path("a.ply").write_bytes(samples.ply_bytes())
        surface = Surface(read_surface("a.ply").points, FACES)
        for word, model in (("opponent", "Opponent"), ("chromaticity", "ChromaticityBrightness")):
            self.succeed(f"denoise a.ply a.ply b.ply --weight 3 --colors {word}")
            colours = intrinsic_tv(surface, COLOURS.astype(float), fidelity_weight=3,
                                   mode="SteadyState", mask_mode="Exclude", color_model=model)
            written = read_data("b.ply").parts[0].values[:, :3]
            np.testing.assert_allclose(written, np.clip(colours, 0, 255), atol=0.51)
        code, _, error = run("denoise", "lh.surf.gii", "lh.func.gii", "x.func.gii", "--weight", 3,
                             "--colors", "opponent")
        self.assertEqual(code, 0)
        self.assertIn("--colors is opponent, but lh.func.gii has no colours", error)

    def test_denoise_names_its_search_for_the_weight(self):
        samples.write_gifti("flat.func.gii", {"one": np.ones(N)})
        _, _, error = run("denoise", "lh.surf.gii", "flat.func.gii", "out.func.gii")
        self.assertIn("warning: the search for --weight finds no noise in the data", error)

    def test_denoise_removes_noise_and_keeps_an_edge(self):
        points, faces = samples.sphere(4)
        samples.write_surface("fine.surf.gii", points, faces)
        clean = np.where(points[:, 0] > 0, 1.0, -1.0)
        noisy = clean + np.random.default_rng(3).normal(0, 0.2, len(points))
        samples.write_gifti("noisy.func.gii", {"one": noisy})
        for option in ("", " --noise 0.2"):
            report = self.report("denoise fine.surf.gii noisy.func.gii out.func.gii" + option)
            self.assertGreater(report["fidelity_weights"][0], 0)
            left = np.abs(self.column("out.func.gii") - clean).mean()
            self.assertLess(left, 0.5 * np.abs(noisy - clean).mean())

    def test_inpaint_keeps_known_values_and_fills_the_others(self):
        holes = np.zeros(N, bool)
        holes[[3, 20, 77]] = True
        samples.write_gifti("holes.func.gii", {"one": np.where(holes, np.nan, SMOOTH)})
        samples.write_gifti("where.func.gii", {"one": holes})
        for model in ("heat", "tv"):
            self.succeed(f"inpaint lh.surf.gii holes.func.gii a.func.gii --model {model}")
            found = self.column("a.func.gii")
            np.testing.assert_array_equal(found[~holes], SMOOTH[~holes])
            self.assertLess(np.abs(found - SMOOTH).max(), 0.2)
            self.succeed("inpaint lh.surf.gii lh.func.gii b.func.gii --column two "
                         f"--missing where.func.gii --model {model}")
            np.testing.assert_array_equal(self.column("b.func.gii"), found)

    def test_data_at_faces_give_results_at_faces(self):
        centres = self.surface.points[FACES].mean(axis=1)
        noise = np.random.default_rng(10).normal(size=len(FACES))
        values = np.column_stack([np.sign(centres[:, 0]) + 0.2 * noise, noise])
        np.save("faces.npy", values)
        np.save("region.npy", centres[:, 2] > -6)
        report = self.report("smooth lh.surf.gii faces.npy 5 out.npy --faces --roi region.npy")
        inside = centres[:, 2] > -6
        expected = heat(self.surface, np.where(inside[:, None], values, 0), mask=~inside,
                        mask_mode="Exclude", fwhm=5, **ONE_STEP)
        np.testing.assert_array_equal(np.load("out.npy"), np.where(inside[:, None], expected, 0))
        self.assertEqual(report["columns"][0]["excluded"], (~inside).sum())
        report = self.report("smooth lh.surf.gii faces.npy 5 out.npy --faces")
        for row in report["columns"]:
            self.assertAlmostEqual(row["total_after"], row["total_before"], delta=1e-6)
        self.succeed("denoise lh.surf.gii faces.npy out.npy --faces --column 1")
        expected = intrinsic_tv(self.surface, values[:, 0], mode="SteadyState",
                                automatic_fidelity=True)
        np.testing.assert_array_equal(np.load("out.npy")[:, 0], expected)
        np.save("holes.npy", np.where(centres[:, 0] > 5, np.nan, centres[:, 2]))
        self.succeed("inpaint lh.surf.gii holes.npy out.npy --faces")
        known = centres[:, 0] <= 5
        np.testing.assert_array_equal(np.load("out.npy")[known], centres[known, 2])
        self.assertTrue(np.isfinite(np.load("out.npy")).all())

    @unittest.skipUnless(HAS_VTK, "needs VTK")
    def test_cell_arrays_of_vtk_files_are_data_at_faces(self):
        from surfacediffusion.files import vtk_files

        samples.write_vtk("a.vtp")
        noise = np.random.default_rng(10).normal(size=len(FACES))
        image = read_surface("a.vtp").image
        Path("b.vtp").write_bytes(vtk_files.write("vtp", image, cell_data={"g": noise, "h": noise}))
        self.succeed("smooth b.vtp b.vtp 5 c.vtp --faces --column g")
        before, after = read_data("b.vtp", True), read_data("c.vtp", True)
        self.assertEqual(after.names, ["g", "h"])
        np.testing.assert_array_equal(after.parts[0].values[:, 1], noise)
        expected = heat((POINTS, FACES), noise, fwhm=5, **ONE_STEP)
        np.testing.assert_allclose(after.parts[0].values[:, 0], expected, atol=1e-12)
        np.testing.assert_array_equal(read_data("c.vtp").parts[0].values,
                                      read_data("b.vtp").parts[0].values)
        self.assertEqual(len(before.parts[0].values), len(FACES))

    def test_inpaint_says_if_nothing_is_missing(self):
        code, _, error = run("inpaint", "lh.surf.gii", "lh.func.gii", "out.func.gii")
        self.assertEqual(code, 0)
        self.assertIn("lh.func.gii: nothing is missing", error)
        np.testing.assert_array_equal(self.column("out.func.gii"), NOISE)

    def test_enhance_smooths_noise_and_keeps_a_step(self):
        step = np.where(POINTS[:, 2] > 0.1 * np.ptp(POINTS[:, 2]), 1.0, 0.0)
        noisy = step + 0.1 * np.random.default_rng(0).standard_normal(len(step))
        samples.write_gifti("noisy.func.gii", {"one": noisy})
        for model in ("lines", "edges", "beltrami"):
            report = self.report(
                f"enhance lh.surf.gii noisy.func.gii out.func.gii --model {model} --time 4 --steps 4")
            self.assertEqual((report["model"], report["time"], report["steps"]), (model, 4.0, 4))
            found = self.column("out.func.gii")
            self.assertLess(np.abs(found - step).mean(), np.abs(noisy - step).mean(), model)
        code, _, error = run("enhance", "lh.surf.gii", "noisy.func.gii", "out.func.gii", "--model",
                             "edges", "--scale", "3")
        self.assertEqual(code, 2)
        self.assertIn("--scale is 3; allowed: with --model lines", error)

    def test_edges_are_written_as_a_map_and_as_curves(self):
        jump = np.where(POINTS[:, 2] > 0.1 * np.ptp(POINTS[:, 2]), 1.0, 0.0)
        samples.write_gifti("jump.func.gii", {"one": jump})
        code, _, error = run(*("edges lh.surf.gii jump.func.gii out.func.gii --map map.shape.gii "
                               "--curves curves.npy --threshold 0.3 --length 4 --width 1").split())
        self.assertEqual(code, 0, error)
        self.assertIn("% of the surface is an edge: edges are 3 --width wide", error)  # on few vertices
        edges = self.column("map.shape.gii")
        self.assertGreaterEqual(edges.min(), 0)
        self.assertGreater(edges.max(), 0.9)
        self.assertLess(np.abs(self.column("out.func.gii") - jump)[edges < 0.5].max(), 0.2)
        curves = np.load("curves.npy")
        self.assertEqual(curves.shape[1], 4)
        self.assertEqual(set(curves[:, 0]), {0})  # one closed curve
        np.testing.assert_array_equal(curves[0], curves[-1])

    def test_edges_refuse_other_formats_of_curves(self):
        code, _, error = run("edges", "lh.surf.gii", "lh.func.gii", "out.func.gii", "--curves",
                             "curves.func.gii")
        self.assertEqual(code, 2)
        self.assertIn("curves.func.gii: the name announces no format for curves", error)

    def test_interpolate_says_that_points_are_the_scanners(self):
        image = nib.load("lh.surf.gii")
        c_ras = [5.0, -18.0, 20.0]
        for axis, number in zip("RAS", c_ras):
            image.darrays[0].meta[f"VolGeomC_{axis}"] = str(number)
        nib.save(image, "tkr.surf.gii")
        nib.freesurfer.write_geometry("lh.white", *(array.data for array in image.darrays[:2]), volume_info={
            "head": [2, 0, 20], "valid": "1  # volume info valid", "filename": "orig.mgz", "volume": [256] * 3,
            "voxelsize": [1.0] * 3, "xras": [-1.0, 0.0, 0.0], "yras": [0.0, 0.0, -1.0], "zras": [0.0, 1.0, 0.0],
            "cras": c_ras})
        for offset in (np.zeros(3), c_ras):
            rows = [f"{x},{y},{z},{z}" for x, y, z in POINTS[::5] + offset]
            Path("values.csv").write_text("x,y,z,height\n" + "\n".join(rows) + "\n")
            for surface in ("tkr.surf.gii", "lh.white", "lh.surf.gii"):
                code, out, error = run("interpolate", surface, "values.csv", "out.shape.gii", "--exact", "--json")
                self.assertEqual(code, 0, error)
                text = "larger by its c_ras, (5, -18, 20): give --ras scanner"
                self.assertEqual(text in error, bool(np.any(offset)) and surface != "lh.surf.gii")
                self.assertEqual("a shift by (-5" in error, bool(np.any(offset)))
                self.assertGreater(json.loads(out)["largest_distance"], -1.0)
        for surface in ("tkr.surf.gii", "lh.white"):  # of which the values are those at the scanner's coordinates
            self.succeed(f"interpolate {surface} values.csv scanner.npy --exact --ras scanner")
            place = ",".join(map(str, POINTS[7] + c_ras))
            self.succeed(f"distance {surface} distance.npy --from {place} --ras scanner")
            self.assertEqual(np.argmin(np.load("distance.npy")), 7)
            self.succeed(f"path {surface} path.npy --from {place} --to 90 --ras scanner")
            np.testing.assert_allclose(np.load("path.npy")[[0, -1]], POINTS[[7, 90]], atol=1e-5)
            np.testing.assert_allclose(np.load("scanner.npy").ravel()[::5], POINTS[::5, 2] + 20, atol=1e-3)
        code, _, error = run(*"interpolate lh.surf.gii values.csv out.npy --ras scanner".split())
        self.assertEqual(code, 2)
        self.assertIn("--ras scanner with lh.surf.gii, which has no c_ras; allowed: surfaces of FreeSurfer", error)

    def test_transforms_of_gifti_to_the_scanner_are_applied(self):
        image = nib.load("lh.surf.gii")
        turn = np.array([[0, -2, 0, 5], [1, 0, 0, -7], [0, 0, 1, 3], [0, 0, 0, 1]], dtype=float)
        place = turn[:3, :3] @ POINTS[7] + turn[:3, 3]
        for space, transformed, xform, expected in ((0, 1, turn, place), (3, 1, turn, place), (1, 4, turn, POINTS[7])):
            image.darrays[0].coordsys = nib.gifti.GiftiCoordSystem(space, transformed, xform)
            nib.save(image, "turned.surf.gii")
            words = ",".join(map(str, expected))
            self.succeed(f"path turned.surf.gii path.npy --from={words} --to 90 --ras scanner")
            np.testing.assert_allclose(np.load("path.npy")[[0, -1]], POINTS[[7, 90]], atol=1e-5)
            self.succeed(f"distance turned.surf.gii distance.npy --from={words} --ras scanner")
            self.assertEqual(np.argmin(np.load("distance.npy")), 7)
        image.darrays[0].coordsys = nib.gifti.GiftiCoordSystem(0, 4, turn)
        nib.save(image, "turned.surf.gii")
        code, _, error = run(*"path turned.surf.gii p.npy --from 1,2,3 --to 90 --ras scanner".split())
        self.assertEqual(code, 2)
        self.assertIn("VolGeomC_S or a transform to NIFTI_XFORM_SCANNER_ANAT", error)

    def test_interpolate_takes_points_beside_the_surface(self):
        places = 1.05 * POINTS[::5]
        rows = [f"{x:.17g},{y:.17g},{z:.17g},{z:.17g}" for x, y, z in places]
        Path("values.csv").write_text("x,y,z,height\n" + "\n".join(rows) + "\n99,0,0,7\n")
        code, out, error = run(*"interpolate lh.surf.gii values.csv out.shape.gii --exact --within 2 "
                               "--error errors.npy --json".split())
        self.assertEqual(code, 0, error)
        self.assertIn("1 value is farther from the surface than", error)
        report = json.loads(out)
        self.assertEqual((report["values"], report["far_values"]), (len(places), 1))
        self.assertEqual(report["columns"][0]["name"], "height")
        self.assertLess(abs(self.column("out.shape.gii")[::5] - places[:, 2]).max(), 1e-4)
        expected = interpolate(self.surface, places[:, 2], places, exact=True).values
        np.testing.assert_allclose(self.column("out.shape.gii"), expected, rtol=1e-5, atol=1e-5)
        errors = np.load("errors.npy").ravel()
        self.assertGreater(errors.max(), 0.0)
        self.assertLess(errors[::5].max(), 0.2 * errors.max())

    def test_interpolate_finds_coordinates_by_their_names(self):
        places = POINTS[::5]
        for names in ("height,x,y,z", "height,Points:0,Points:1,Points:2", "height,X,Y,Z"):
            rows = [f"{z:.17g},{x:.17g},{y:.17g},{z:.17g}" for x, y, z in places]
            Path("values.csv").write_text(names + "\n" + "\n".join(rows) + "\n")
            report = self.report("interpolate lh.surf.gii values.csv out.shape.gii --exact")
            self.assertEqual([column["name"] for column in report["columns"]], ["height"])
            self.assertLess(abs(self.column("out.shape.gii")[::5] - places[:, 2]).max(), 1e-4)
        Path("values.csv").write_text("height,x,y,h\n1,0,0,10\n2,0,0,-10\n")
        code, _, error = run(*"interpolate lh.surf.gii values.csv out.shape.gii".split())
        self.assertEqual(code, 2)
        self.assertIn("the line of names has height, x, y, h; allowed: each of x, y, z once", error)

    def test_interpolate_names_what_is_wrong_with_a_table(self):
        for text, problem in (
                ("x y z t\n1 2 3\n", "line 2 has 3 numbers"), ("", "no row of numbers"),
                ("1 2 3 4\n1 2 3 x\n", "line 2 is '1 2 3 x'")):
            Path("bad.txt").write_text(text)
            code, _, error = run("interpolate", "lh.surf.gii", "bad.txt", "out.npy")
            self.assertEqual(code, 2)
            self.assertIn(problem, error)

    def test_segment_labels_the_sides_of_a_step(self):
        step = np.where(SMOOTH > SMOOTH.mean(), 5.0, 2.0)
        samples.write_gifti("step.func.gii", {"one": step})
        report = self.report(
            "segment lh.surf.gii step.func.gii labels.func.gii --means 5 2 --weight 10")
        np.testing.assert_array_equal(self.column("labels.func.gii"), np.where(step > 3, 1, 2))
        regions = report["segmentations"][0]["regions"]
        self.assertEqual([row["mean"] for row in regions], [[5.0], [2.0]])
        self.assertGreater(regions[0]["boundary_length"], 0)

    def test_texture_has_the_same_bits_for_the_same_seed(self):
        for name, seed in (("a", 1), ("b", 1), ("c", 2)):
            self.succeed(f"texture lh.surf.gii 20 {name}.shape.gii --seed {seed}")
        a, b, c = (self.column(f"{name}.shape.gii") for name in "abc")
        np.testing.assert_array_equal(a, b)
        self.assertGreater(np.abs(a - c).max(), 0.1)
        self.assertEqual((a.min(), a.max()), (0, 1))
        self.assertEqual(read_data("a.shape.gii").parts[0].structure, "CortexLeft")

    def test_values_at_some_vertices_stay_at_these(self):
        order = np.random.default_rng(5).permutation(N)
        arrays = [samples.gifti.GiftiDataArray(order.astype(np.int32), "NIFTI_INTENT_NODE_INDEX",
                                               "NIFTI_TYPE_INT32"),
                  samples.gifti.GiftiDataArray(NOISE[order], "NIFTI_INTENT_SHAPE", "NIFTI_TYPE_FLOAT32")]
        nib.save(samples.gifti.GiftiImage(darrays=arrays), "sparse.func.gii")
        np.save("noise.npy", NOISE)
        for name in ("sparse.func.gii", "noise.npy"):
            self.succeed(f"derivatives lh.surf.gii {name} {name}.npy")
        np.testing.assert_array_equal(np.load("sparse.func.gii.npy"), np.load("noise.npy.npy"))
        samples.write_label("a.label", [7, 3], [0, 0])
        self.succeed("distance lh.surf.gii a.label a.npy")
        self.succeed("distance lh.surf.gii b.npy --from 3 --from 7")
        np.testing.assert_array_equal(np.load("a.npy"), np.load("b.npy"))

    def test_places_far_from_the_surface_are_a_warning(self):
        self.succeed("distance lh.surf.gii a.npy --from 0.1,0,10.1")
        code, _, error = run("distance", "lh.surf.gii", "a.npy", "--from", "100,0,10100")
        self.assertEqual(code, 0)
        self.assertRegex(error, r"warning: 1 of 1 points of the sources is farther than \S+ from the surface, "
                                r"which is 34\S+ large; median distance 10090")

    def test_columns_have_names(self):
        axes = [f"{name} {axis}" for name in ("one", "two") for axis in "xyz"]
        for line, names in (
                ("curvature lh.surf.gii out.func.gii", ["mean", "gaussian", "k1", "k2", "shape_index", "curvedness"]),
                ("derivatives lh.surf.gii lh.func.gii out.func.gii", axes),
                ("derivatives lh.surf.gii vectors.func.gii out.func.gii --quantity curl", ["one x", "two x"]),
                ("random-field lh.surf.gii out.func.gii --fwhm 6 --count 2", ["field 1", "field 2"])):
            self.succeed(line)
            self.assertEqual(list(read_data("out.func.gii").names), names)
            Path("out.func.gii").replace("vectors.func.gii")

    def test_distance_from_a_region_and_from_places(self):
        regions = {"north": (POINTS[:, 2] > 8).astype(float),
                   "one": np.where(np.arange(N) == 7, np.nan, np.arange(N) == 11)}
        samples.write_gifti("regions.func.gii", regions)
        out = self.succeed("distance lh.surf.gii regions.func.gii out.func.gii")
        self.assertRegex(out, "^out.func.gii: 2 columns, ")
        data = read_data("out.func.gii")
        self.assertEqual(list(data.names), ["north", "one"])
        for values, rows in zip(data.parts[0].values.T, (np.flatnonzero(regions["north"]), [11])):
            np.testing.assert_allclose(values, distance(self.surface, rows), rtol=1e-6)
        place = ",".join(str(x) for x in 1.2 * POINTS[40])
        for method in ("heat", "eikonal"):
            report = self.report(f"distance lh.surf.gii out.npy --from 3 --from={place} --method {method}")
            expected = distance(self.surface, [3, 40], method=method.capitalize())
            np.testing.assert_allclose(np.load("out.npy").ravel(), expected, rtol=1e-6, atol=1e-6)
            self.assertEqual(report["columns"][0]["sources"], 2)
            self.assertEqual(report["columns"][0]["unreached"], 0)

    def test_nearest_sources_are_values_or_places(self):
        areas = np.where(POINTS[:, 2] > 8, 4, np.where(POINTS[:, 0] < -6, 7, 0))
        samples.write_gifti("areas.func.gii", {"areas": areas, "one": 3.0 * (np.arange(N) == 11)})
        self.succeed("distance lh.surf.gii areas.func.gii out.func.gii --nearest near.func.gii")
        near = read_data("near.func.gii").parts[0].values
        expected = nearest_sources(self.surface, np.flatnonzero(areas)).source
        np.testing.assert_array_equal(near[:, 0], areas[areas != 0][expected])
        self.assertEqual(set(near[:, 0]), {4, 7})
        self.assertEqual(set(near[:, 1]), {3})
        self.succeed("distance lh.surf.gii out.npy --from 40 --from 3 --nearest near.npy")
        expected = nearest_sources(self.surface, [40, 3]).source + 1
        np.testing.assert_array_equal(np.load("near.npy").ravel(), expected)

    def test_signed_distance_is_negative_in_the_region(self):
        region = POINTS[:, 2] > 4
        samples.write_gifti("region.func.gii", {"north": region.astype(float)})
        self.succeed("distance lh.surf.gii region.func.gii out.npy --signed")
        found = np.load("out.npy").ravel()
        np.testing.assert_allclose(found, distance(self.surface, region, signed=True), rtol=1e-6)
        self.assertTrue((found[region] <= 0).all() and (found[~region] >= 0).all() and found.min() < -5)

    def test_path_between_places(self):
        expected = path_through(self.surface, [3, POINTS[40], 7], closed=True)
        place = ",".join(map(repr, POINTS[40].tolist()))
        report = self.report(f"path lh.surf.gii path.npy --from 3 --by={place} --to 7 --closed")
        np.testing.assert_allclose(np.load("path.npy"), expected.points, atol=1e-5)
        self.assertAlmostEqual(report["length"], expected.length, places=4)
        out = self.succeed("path lh.surf.gii path.vtk --from 3 --to 7")
        self.assertRegex(out, "^path.vtk: length ")
        lines = Path("path.vtk").read_text().splitlines()
        expected = geodesic_path(self.surface, 3, 7).points
        count = len(expected)
        np.testing.assert_allclose([[float(x) for x in line.split()] for line in lines[5:5 + count]], expected,
                                   atol=1e-5)
        self.assertEqual(lines[4:5] + lines[5 + count:], [
            f"POINTS {count} double", f"LINES 1 {count + 1}", " ".join(map(str, [count, *range(count)]))])

    def test_distance_of_what_no_way_reaches_is_missing(self):
        samples.write_surface("two.surf.gii", np.vstack([POINTS, POINTS + 30]),
                              np.vstack([FACES, FACES + N]))
        report = self.report("distance two.surf.gii out.npy --from 5")
        found = np.load("out.npy").ravel()
        np.testing.assert_array_equal(np.isnan(found), np.arange(2 * N) >= N)
        self.assertEqual(report["columns"][0]["unreached"], N)

    def test_normals_of_a_sphere_and_a_denoised_sphere(self):
        self.succeed("normals lh.surf.gii out.func.gii")
        np.testing.assert_allclose(read_data("out.func.gii").parts[0].values, POINTS / 10,
                                   atol=0.02)
        points, faces = samples.sphere(3)
        noise = np.random.default_rng(6).normal(0, 0.01, (len(points), 1))
        samples.write_surface("noisy.surf.gii", points * (1 + noise), faces)
        report = self.report("normals noisy.surf.gii clean.surf.gii --move")
        radii = np.linalg.norm(read_surface("clean.surf.gii").points, axis=1)
        self.assertLess(radii.std(), 0.07)
        self.assertGreater(report["maximum_displacement"], 0)

    def test_denoise_mesh_writes_the_points_of_the_function(self):
        points, faces = samples.sphere(4)
        noise = np.random.default_rng(8).normal(0, 0.005, (len(points), 1))
        samples.write_surface("noisy.surf.gii", points * (1 + noise), faces)
        out = self.succeed("denoise-mesh noisy.surf.gii clean.surf.gii")
        self.assertRegex(out, r"^clean.surf.gii: CAD, noise 0\.0\d+, points moved by 0\.0\d+ on "
                              r"average, at most 0\.\d+, \d+\.\d\d s\n$")
        given, found = read_surface("noisy.surf.gii"), read_surface("clean.surf.gii")
        expected = denoise_mesh((given.points, given.faces))
        np.testing.assert_array_equal(found.points, expected.points.astype(found.points.dtype))
        np.testing.assert_array_equal(found.faces, given.faces)
        self.assertLess(np.linalg.norm(found.points, axis=1).std(), 0.03)  # 0.05 before
        report = self.report("denoise-mesh noisy.surf.gii clean.surf.gii")
        self.assertEqual(report["surface_type"], "CAD")
        for name in ("noise_level", "mean_displacement", "maximum_displacement", "volume_before",
                     "volume_after", "mean_edge_length"):
            self.assertEqual(report[name], getattr(expected, name), name)

    def test_denoise_mesh_of_a_scan_says_how_far_its_noise_is_correlated(self):
        """A depth image of the side of a ball, with noise as depth cameras have it."""
        y, x = np.mgrid[:70, :90].astype(float)
        depth = np.sqrt(150**2 - (x - 45) ** 2 - (y - 35) ** 2)
        noise = np.random.default_rng(10).normal(size=x.shape)
        kernel = np.exp(-np.arange(-6, 7)**2 / 4.0)
        for axis in (0, 1):
            noise = np.apply_along_axis(np.convolve, axis, noise, kernel, "same")
        noise *= 0.3 / noise.std()
        corner = np.arange(x.size).reshape(x.shape)
        a, b, c, d = (part.ravel() for part in (
            corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]))
        faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
        points = np.stack([x, y, depth + noise], axis=-1).reshape(-1, 3)
        Path("scan.off").write_text(samples.off_text(points, faces))
        code, out, error = run("denoise-mesh", "scan.off", "clean.off")
        self.assertEqual(code, 0, error)
        self.assertRegex(out, r"^clean.off: \w+, noise 0\.[23]\d*, correlated over [123]\.\d+, points moved")
        self.assertIn("warning: the noise is correlated over a length of", error)
        found = read_surface("clean.off")
        before, after = noise.ravel().std(), (found.points[:, 2] - depth.ravel()).std()
        self.assertLess(after, 0.8 * before)

    def test_denoise_mesh_takes_level_type_and_fixed_vertices(self):
        points, faces = samples.sphere(4)
        noise = np.random.default_rng(8).normal(0, 0.005, (len(points), 1))
        north = points[:, 2] > 3
        samples.write_surface("noisy.surf.gii", points * (1 + noise), faces)
        samples.write_gifti("north.func.gii", {"north": north})
        report = self.report("denoise-mesh noisy.surf.gii clean.surf.gii --noise 0.03 --type cad "
                             "--fixed north.func.gii")
        self.assertEqual((report["noise_level"], report["surface_type"]), (0.03, "CAD"))
        given, found = read_surface("noisy.surf.gii"), read_surface("clean.surf.gii")
        np.testing.assert_array_equal(found.points[north], given.points[north])
        expected = denoise_mesh((given.points, given.faces), noise_level=0.03, surface_type="CAD",
                                fixed=north)
        np.testing.assert_array_equal(found.points, expected.points.astype(found.points.dtype))

    def test_denoise_mesh_says_if_no_point_moves(self):
        points, faces = samples.sphere(4)
        samples.write_surface("clean.surf.gii", points, faces)
        for options, text in (("", "no noise was found, no point moved"),
                              ("--noise 1e-9", "no point moved")):
            code, out, error = run("denoise-mesh", "clean.surf.gii", "same.surf.gii", *options.split())
            self.assertEqual(code, 0)
            self.assertRegex(out, rf"^same.surf.gii: {text}, ")
            self.assertIn("so that no point moves", error)

    def test_denoise_mesh_merges_split_vertices(self):
        points, faces = samples.sphere(3)
        noisy = points * (1 + np.random.default_rng(9).normal(0, 0.02, (len(points), 1)))
        split = noisy[faces].reshape(-1, 3)
        samples.write_surface("soup.surf.gii", split, np.arange(len(split)).reshape(-1, 3))
        code, _, error = run("denoise-mesh", "soup.surf.gii", "apart.surf.gii")
        self.assertEqual(code, 0)
        self.assertIn("boundary points coincide with others and may come apart", error)
        self.succeed("denoise-mesh soup.surf.gii whole.surf.gii --merge")
        corners = read_surface("whole.surf.gii").points
        for vertex in range(len(points)):
            self.assertEqual(len(np.unique(corners[faces.ravel() == vertex], axis=0)), 1)

    def test_denoise_mesh_keeps_the_formats_of_meshes(self):
        points, faces = samples.sphere(3)
        noisy = points * (1 + np.random.default_rng(9).normal(0, 0.05, (len(points), 1)))
        Path("scan.ply").write_bytes(samples.ply_bytes(points=noisy, faces=faces))
        Path("scan.off").write_text(samples.off_text(noisy, faces))
        Path("scan.obj").write_text(samples.obj_text(noisy, faces))
        Path("scan.stl").write_bytes(samples.stl_bytes(points=noisy, faces=faces))
        for kind in ("ply", "off", "obj", "stl"):
            self.succeed(f"denoise-mesh scan.{kind} clean.{kind}")
            given, found = read_surface(f"scan.{kind}"), read_surface(f"clean.{kind}")
            self.assertEqual(found.kind, kind)
            expected = denoise_mesh((given.points, given.faces))
            self.assertGreater(np.abs(expected - given.points).max(), 0.1)
            corners = [np.asarray(points)[np.asarray(faces)] for points, faces in (
                (expected, given.faces), (found.points, found.faces))]
            np.testing.assert_allclose(*corners, atol=1e-5)
        # The colours of the vertices are those that they were.
        np.testing.assert_array_equal(read_data("clean.ply").parts[0].values,
                                      read_data("scan.ply").parts[0].values)

    def test_fwhm_of_smoothed_noise(self):
        samples.write_surface("fine.surf.gii", *samples.sphere(4))
        surface = Surface(read_surface("fine.surf.gii").points, samples.sphere(4)[1])
        noise = np.random.default_rng(7).normal(size=(surface.n_points, 20))
        samples.write_gifti("noise.func.gii", {
            str(i): column for i, column in enumerate(heat(surface, noise, fwhm=4).T)})
        report = self.report("fwhm fine.surf.gii noise.func.gii")
        self.assertEqual(len(report["surfaces"][0]["columns"]), 20)
        self.assertAlmostEqual(report["surfaces"][0]["pooled"], 4, delta=0.3)

    def test_info_counts(self):
        report = self.report("info lh.surf.gii lh.func.gii")
        surface, data = report["files"]
        self.assertEqual((surface["points"], surface["faces"]), (N, len(FACES)))
        self.assertAlmostEqual(surface["area"], 4 * np.pi * 100, delta=60)
        self.assertEqual([column["name"] for column in data["columns"]], ["one", "two"])
        self.assertAlmostEqual(data["columns"][0]["mean"], NOISE.mean(), delta=1e-5)

    def test_info_of_a_surface_beyond_the_range_of_numbers(self):
        Path("a.off").write_text(samples.off_text(POINTS * 1e200))
        out = self.succeed("info a.off")
        self.assertIn(f"{N} points, {len(FACES)} faces, area unknown, mean edge unknown", out)
        self.assertIsNone(self.report("info a.off")["files"][0]["area"])

    @unittest.skipUnless(HAS_VTK, "needs vtk")
    def test_vtk_files(self):
        samples.write_vtk("a.vtp", arrays={"f": NOISE.astype(float), "g": SMOOTH})
        self.succeed("smooth a.vtp a.vtp 5 b.vtp --column f")
        found = read_data("b.vtp")
        self.assertEqual(found.names, ["f", "g"])
        expected = heat((POINTS, FACES), NOISE.astype(float), fwhm=5, **ONE_STEP)
        np.testing.assert_array_equal(found.parts[0].values[:, 0], expected)
        np.testing.assert_array_equal(found.parts[0].values[:, 1], SMOOTH)
        self.succeed("directions a.vtp c.vtp --method Smooth")
        self.succeed("texture a.vtp 20 d.vtp")
        self.assertEqual(read_data("d.vtp").names, ["f", "g", "Texture"])


    @unittest.skipUnless(HAS_VTK, "needs vtk")
    def test_numbers_of_points_are_no_data_unless_they_are_chosen(self):
        order = np.random.default_rng(5).permutation(N) + 7
        samples.write_vtk("a.vtp", arrays={"f": NOISE, "ids": order, "vtkGhostType": np.zeros(N, np.uint8)})
        self.succeed("smooth a.vtp a.vtp 5 out.vtp")
        before, after = read_data("a.vtp"), read_data("out.vtp")
        self.assertEqual(before.names, ["f", "ids", "vtkGhostType"])
        np.testing.assert_array_equal(after.parts[0].values[:, 1:], before.parts[0].values[:, 1:])
        self.assertLess(after.parts[0].values[:, 0].std(), 0.5 * NOISE.std())
        self.succeed("smooth a.vtp a.vtp 5 out.vtp --column ids")
        self.assertLess(read_data("out.vtp").parts[0].values[:, 1].std(), 0.5 * order.std())
        samples.write_vtk("a.vtp", arrays={"ids": order})  # nothing else is there to smooth
        self.succeed("smooth a.vtp a.vtp 5 out.vtp")
        self.assertLess(read_data("out.vtp").parts[0].values[:, 0].std(), 0.5 * order.std())

    @unittest.skipUnless(HAS_VTK, "needs vtk")
    def test_a_vector_of_vtk_has_one_label_per_vertex(self):
        for kind in ("vtp", "vtk"):
            samples.write_vtk(f"a.{kind}", arrays={"v": COLOURS, "f": SMOOTH})
            self.succeed(f"segment a.{kind} a.{kind} out.{kind} --regions 3 --column v")
            data = read_data(f"out.{kind}")
            labels = data.parts[0].values[:, data.names.index("v")]
            self.assertEqual(sorted(data.names), ["f", "v"])
            self.assertEqual(set(labels), {1, 2, 3})
            np.testing.assert_array_equal(data.parts[0].values[:, data.names.index("f")], SMOOTH)

    @unittest.skipUnless(HAS_VTK, "needs vtk")
    def test_split_vertices_are_joined_on_request(self):
        samples.write_vtk("soup.vtp", POINTS[FACES].reshape(-1, 3), np.arange(FACES.size).reshape(-1, 3),
                          {"f": NOISE[FACES].reshape(-1)})
        samples.write_vtk("whole.vtp")
        for line in ("smooth {0} {0} 5 {1}", "denoise {0} {0} {1} --weight 2", "enhance {0} {0} {1}",
                     "edges {0} {0} {1} --threshold 1", "segment {0} {0} {1} --weight 10000"):
            self.succeed(line.format("whole.vtp", "expected.vtp"))
            self.succeed(line.format("soup.vtp", "out.vtp") + " --merge")
            found = read_data("out.vtp").parts[0].values
            np.testing.assert_allclose(found, read_data("expected.vtp").parts[0].values[FACES.reshape(-1)],
                                       atol=1e-5)

    @unittest.skipUnless(HAS_VTK, "needs vtk")
    def test_vertices_that_differ_by_round_off_are_joined_on_request(self):
        corners = POINTS[FACES].reshape(-1, 3)
        corners = corners + 1e-5 * np.random.default_rng(2).random(corners.shape)
        samples.write_vtk("soup.vtp", corners, np.arange(FACES.size).reshape(-1, 3),
                          {"f": NOISE[FACES].reshape(-1)})
        samples.write_vtk("whole.vtp")
        self.succeed("smooth whole.vtp whole.vtp 5 expected.vtp")
        code, _, error = run("smooth", "soup.vtp", "soup.vtp", 5, "out.vtp")
        self.assertEqual(code, 0)
        advice = re.search(r"\(to join them, set --merge, and --merge-tolerance to (\S+)\)", error)
        self.assertIsNotNone(advice, error)
        self.succeed(f"smooth soup.vtp soup.vtp 5 out.vtp --merge-tolerance {advice[1]}")
        np.testing.assert_allclose(read_data("out.vtp").parts[0].values,
                                   read_data("expected.vtp").parts[0].values[FACES.reshape(-1)], atol=1e-3)
        _, _, error = run("distance", "soup.vtp", "out.vtp", "--from", 0)
        self.assertIn("(ParaView's filter Clean joins them)", error)


class Reports(CommandTest):
    @unittest.skipUnless(HAS_VTK, "needs vtk")
    def test_settings_are_named_as_the_options_that_give_them(self):
        samples.write_vtk("soup.vtp", POINTS[FACES].reshape(-1, 3), np.arange(FACES.size).reshape(-1, 3),
                          {"f": np.ones(FACES.size), "noise_level": np.ones(FACES.size)})
        for command, expected in (
                (["smooth", "soup.vtp", "soup.vtp", 3, "out.vtp", "--column", "f"],
                 r"\(to join them, set --merge\)"),
                (["smooth", "soup.vtp", "soup.vtp", 3000, "out.vtp"], "FWHM is 3000"),
                (["curvature", "soup.vtp", "out.vtp", "--fwhm", 3000], "set --merge"),
                (["random-field", "soup.vtp", "out.vtp", "--fwhm", 5], "ParaView's filter Clean joins them"),
                (["distance", "soup.vtp", "out.vtp", "--from", 0], "ParaView's filter Clean joins them")):
            code, _, err = run(*command)
            self.assertEqual(code, 0, err)
            self.assertRegex(err, expected)
            self.assertNotRegex(err, "coincident_points|numpy")
        code, _, err = run("info", "noise_level.npy")
        self.assertEqual((code, "noise_level.npy" in err), (2, True), err)

    def test_json_has_times_widths_totals_and_warnings(self):
        report = self.report("smooth lh.surf.gii lh.func.gii 5 out.func.gii")
        self.assertEqual(set(report["seconds"]), {"read", "compute", "write"})
        self.assertEqual((report["command"], report["fwhm"], report["warnings"]),
                         ("smooth", 5.0, []))
        self.assertEqual([row["name"] for row in report["columns"]], ["one", "two"])

    def test_warnings_of_the_library_are_lines_and_in_the_report(self):
        samples.write_surface("extra.surf.gii", faces=np.vstack([FACES, [0, 0, 1]]))
        code, out, error = run("smooth", "extra.surf.gii", "lh.func.gii", 5, "out.func.gii",
                               "--json")
        self.assertEqual(code, 0)
        self.assertRegex(error, "^surfacediffusion: warning: .*triangles of zero area")
        self.assertEqual(len(json.loads(out)["warnings"]), 1)

    def test_errors_are_in_the_report(self):
        code, out, _ = run("smooth", "none", "lh.func.gii", 5, "out.func.gii", "--json")
        self.assertEqual(code, 2)
        self.assertIn("none: cannot be read", json.loads(out)["error"])

    def test_quiet_prints_nothing(self):
        self.assertEqual(self.succeed("smooth lh.surf.gii lh.func.gii 5 out.func.gii --quiet"), "")

    def test_what_cannot_be_printed_is_one_line(self):
        samples.write_gifti("größe\udcff.func.gii", {"one": NOISE})
        command = [sys.executable, "-m", "surfacediffusion", "info", "größe\udcff.func.gii"]
        for encoding, word in (("ascii:strict", b"gr\\xf6\\xdfe\\udcff"),
                               ("utf-8:strict", "größe\\udcff".encode())):
            done = subprocess.run(command, capture_output=True, env={**os.environ, "PYTHONIOENCODING": encoding})
            self.assertEqual((done.returncode, done.stderr), (0, b""))
            self.assertTrue(done.stdout.startswith(word), done.stdout)
        with open("/dev/full", "w") as full:
            done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE)
        self.assertEqual((done.returncode, done.stderr),
                         (1, b"surfacediffusion: standard output: cannot be written: No space left on device\n"))
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run(command, stdout=writer, stderr=subprocess.PIPE)
        os.close(writer)
        self.assertEqual((done.returncode, done.stderr), (1, b""))

    def test_threads_do_not_change_the_result(self):
        before = get_number_of_threads()
        try:
            self.succeed("smooth lh.surf.gii lh.func.gii 5 all.func.gii")
            self.succeed("smooth lh.surf.gii lh.func.gii 5 one.func.gii --threads 1")
            self.assertEqual(get_number_of_threads(), 1)
        finally:
            set_number_of_threads(before)
        one, every = (read_data(name).parts[0].values for name in ("one.func.gii", "all.func.gii"))
        np.testing.assert_array_equal(one, every)
        code, _, error = run("smooth", "lh.surf.gii", "lh.func.gii", 5, "x.func.gii", "--threads", "x")
        self.assertEqual(code, 2)
        self.assertIn("allowed: a whole number from 0 to 1024", error)

    def test_one_line_says_what_was_written(self):
        out = self.succeed("smooth lh.surf.gii lh.func.gii 5 out.func.gii")
        self.assertRegex(out, r"^out.func.gii: 2 columns, FWHM 5 mm \(sigma 2.12\), \d+\.\d\d s\n$")

    def test_help_of_every_command_shows_an_example(self):
        _, out, _ = run("--help")
        commands = ("smooth", "metric-smoothing", "denoise", "denoise-mesh", "inpaint", "interpolate", "segment",
                    "refine", "texture", "directions", "curvature", "derivatives", "distance", "normals", "fwhm",
                    "scale-filter", "spectrum", "random-field", "surrogates", "resample", "metric-resample", "info")
        for command in commands:
            self.assertIn(command, out)
            code, text, _ = run(command, "--help")
            self.assertEqual(code, 0)
            self.assertRegex(text, rf"Example:\n  surfacediffusion {command} ")

    def test_a_terminal_gets_a_progress_bar(self):
        try:
            import tqdm  # noqa: F401
        except ImportError:
            self.skipTest("needs tqdm")
        command = [sys.executable, "-m", "surfacediffusion.command", "smooth", "lh.surf.gii",
                   "lh.func.gii", "5", "out.func.gii"]
        master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=slave)
        os.set_blocking(master, False)
        self.assertIn(b"Smoothing:   0%|", os.read(master, 100000))
        os.close(slave)
        os.close(master)


if __name__ == "__main__":
    unittest.main(verbosity=2)
