# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files as other programs write them, and as nobody should: what the user reads of them."""

import base64
import gzip
import itertools
import os
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest
import warnings
import xml.etree.ElementTree as tree
import zlib
from pathlib import Path
from unittest import mock

import numpy as np
import samples
from samples import FACES, N, NOISE, POINTS, SMOOTH, nib, run
from TestFormats import FormatTest, stl_text

from surfacediffusion.files import FileError, read_data, read_surface
from surfacediffusion.files.content import write_atomically

MEMORY = 4 << 30


class ForeignTest(FormatTest):
    def warned(self, expected, *arguments):
        code, out, error = run(*arguments)
        self.assertEqual((code, error.count("\n")), (0, 1), error)
        self.assertRegex(error, "warning: " + expected)
        return out

    def info(self, *names):
        """In a process that may crash, in little memory."""
        limit = f"import resource; resource.setrlimit(resource.RLIMIT_AS, ({MEMORY}, {MEMORY}))\n"
        if "libasan" in os.environ.get("LD_PRELOAD", ""):  # which reserves terabytes of addresses
            limit = ""
        code = limit + "import sys\nfrom surfacediffusion.command import main\n" \
            "sys.exit(main(['info', *sys.argv[1:]]))"
        done = subprocess.run([sys.executable, "-c", code, *names], capture_output=True, text=True, timeout=60,
                              env={**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        return done.returncode, done.stdout, done.stderr

    def refused_all(self, contents, expected):
        """Each of the files [(end of the name, content)] in one line."""
        names = [self.write(f"{i}{end}", content) for i, (end, content) in enumerate(contents)]
        code, out, error = self.info(*names)
        self.assertEqual((code, out), (2, ""), error)
        for name, line in itertools.zip_longest(names, error.splitlines()):
            self.assertRegex(line or "nothing", f"^surfacediffusion: {name}: {expected}")


class PLY(ForeignTest):
    def test_new_columns_have_names_that_are_read_again(self):
        self.write("a.ply", samples.ply_bytes())
        self.write("b.ply", samples.ply_bytes(binary=False))
        for name in ("a.ply", "b.ply"):
            self.succeed("random-field", name, "o.ply", "--fwhm", 8, "--count", 2)
            self.assertEqual(read_data("o.ply").names[-2:], ["field_1", "field_2"])
            self.succeed("derivatives", name, name, "o.ply", "--quantity", "gradient")
            self.assertIn("quality_z", read_data("o.ply").names)


class GIFTI(ForeignTest):
    def array(self, values, intent="NONE", kind="FLOAT32", order="RowMajorOrder", dimensions=None, other=""):
        sizes = " ".join(f'Dim{i}="{n}"' for i, n in enumerate(np.shape(values)))
        text = " ".join(map(str, np.ravel(values, "F" if order.startswith("Col") else "C").tolist()))
        return (f'<DataArray Intent="NIFTI_INTENT_{intent}" DataType="NIFTI_TYPE_{kind}" '
                f'ArrayIndexingOrder="{order}" Dimensionality="{dimensions or np.ndim(values)}" {sizes} '
                f'Encoding="ASCII" Endian="LittleEndian" '
                f'ExternalFileName="{other}" ExternalFileOffset=""><MetaData/><Data>{text}</Data></DataArray>')

    def gifti(self, name, *arrays):
        return self.write(name, f'<?xml version="1.0"?><GIFTI Version="1.0" NumberOfDataArrays="{len(arrays)}">'
                          "<MetaData/><LabelTable/>" + "".join(arrays) + "</GIFTI>")

    def surface(self, name, kinds=("FLOAT32", "INT32"), **options):
        return self.gifti(name, self.array(POINTS.astype("f4"), "POINTSET", kinds[0], **options),
                          self.array(FACES, "TRIANGLE", kinds[1], **options))

    def read(self, name):
        """The arrays of a file in base64, by the letter of the format: not with nibabel."""
        found = []
        for entry in tree.parse(name).getroot().iter("DataArray"):
            given = entry.attrib
            self.assertEqual((given["Encoding"], given["Endian"]), ("GZipBase64Binary", "LittleEndian"))
            self.assertEqual(given["ExternalFileName"], "")
            values = np.frombuffer(zlib.decompress(base64.b64decode(entry.find("Data").text)), {
                "NIFTI_TYPE_FLOAT32": "<f4", "NIFTI_TYPE_INT32": "<i4"}[given["DataType"]])
            shape = [int(given[f"Dim{i}"]) for i in range(int(given["Dimensionality"]))]
            found.append(values.reshape(shape, order="F" if given["ArrayIndexingOrder"].startswith("Col") else "C"))
        return found

    def test_text_in_columns_is_written_so_that_other_programs_read_it(self):
        for order in ("ColumnMajorOrder", "RowMajorOrder"):
            self.surface("s.surf.gii", order=order)
            values = np.tile(np.float32([1, 2, 3e-9, 4]), (N, 1))
            self.gifti("d.func.gii", self.array(values, order=order))
            self.succeed("smooth", "s.surf.gii", "d.func.gii", 5, "o.func.gii")
            np.testing.assert_allclose(self.read("o.func.gii")[0], values, rtol=1e-5)
            surface = read_surface("s.surf.gii")
            surface.save("o.surf.gii", 2 * surface.points)
            points, faces = self.read("o.surf.gii")
            np.testing.assert_array_equal(points, 2 * POINTS.astype("f4"))
            np.testing.assert_array_equal(faces, FACES)

    @unittest.skipUnless(shutil.which("wb_command"), "needs wb_command")
    def test_workbench_reads_what_was_text_in_columns(self):
        self.surface("s.surf.gii", order="ColumnMajorOrder")
        self.gifti("d.func.gii", self.array(np.tile(np.float32([1, 2, 3, 4]), (N, 1)), order="ColumnMajorOrder"))
        self.succeed("smooth", "s.surf.gii", "d.func.gii", 5, "o.func.gii")
        for word in ("MIN", "MAX"):
            done = subprocess.run(["wb_command", "-metric-stats", "o.func.gii", "-reduce", word],
                                  capture_output=True, text=True, check=True)
            np.testing.assert_allclose([float(x) for x in done.stdout.split()], [1, 2, 3, 4], rtol=1e-5)

    def test_types_that_gifti_has_not_are_read_and_written_as_those_that_it_has(self):
        for kinds in (("FLOAT64", "INT64"), ("FLOAT64", "UINT32"), ("FLOAT32", "INT16")):
            self.surface("s.surf.gii", kinds)
            self.gifti("d.func.gii", self.array(NOISE.astype(float), "SHAPE", kinds[0]))
            self.succeed("smooth", "s.surf.gii", "d.func.gii", 5, "o.func.gii")
            self.succeed("denoise-mesh", "s.surf.gii", "o.surf.gii", "--noise", 0.01)
            np.testing.assert_array_equal(self.read("o.surf.gii")[1], FACES)
            self.assertEqual(self.read("o.func.gii")[0].shape, (N,))

    def test_numbers_of_dimensions_that_no_array_has_are_one_line(self):
        contents = [Path(self.gifti("a.func.gii", self.array(SMOOTH, dimensions=dimensions))).read_bytes()
                    for dimensions in ("99999999999", "0", "-1", "2", "x", "1" * 5000)]
        self.refused_all([(".func.gii", content) for content in contents],
                         "damaged GIFTI file: an array of Dimensionality .*; allowed: 1 to 6, and a size for each")

    def test_a_name_of_another_file_counts_only_where_the_data_are_there(self):
        self.surface("s.surf.gii", other="/gone/x.dat")
        surface = read_surface("s.surf.gii")
        np.testing.assert_array_equal(surface.faces, FACES)
        surface.save("o.surf.gii", surface.points)
        np.testing.assert_array_equal(self.read("o.surf.gii")[1], FACES)


class CIFTI(ForeignTest):
    def setUp(self):
        super().setUp()
        samples.write_surface("l.surf.gii")
        samples.write_surface("r.surf.gii", structure="CortexRight")
        self.rows = np.append(np.tile(NOISE, 2), np.random.default_rng(3).normal(size=60))[None].repeat(2, axis=0)
        samples.write_cifti("a.dscalar.nii", self.rows, voxels=60)

    def smooth(self, name, *options):
        out = f"o.{name}"
        self.succeed("smooth", name, 6, out, "--left", "l.surf.gii", "--right", "r.surf.gii", *options)
        return nib.load(out)

    def test_a_matrix_of_another_size_than_its_description_is_one_line(self):
        content = Path("a.dscalar.nii").read_bytes()
        for place, number in ((5, 1), (5, 3), (6, 100), (6, 1000), (5, 0)):
            changed = bytearray(content)
            struct.pack_into("<q", changed, 16 + 8 * place, number)
            self.write("b.dscalar.nii", bytes(changed) + bytes(20000))
            self.refused("b.dscalar.nii: damaged CIFTI file: a matrix of .* values, described as 2 x 384", "info",
                         "b.dscalar.nii")
            self.refused("a matrix of", "smooth", "b.dscalar.nii", 6, "o.dscalar.nii", "--left", "l.surf.gii",
                         "--right", "r.surf.gii")

    def test_voxels_are_smoothed_alike_in_any_unit_and_keep_it(self):
        expected = np.asarray(self.smooth("a.dscalar.nii").dataobj)
        for exponent in (0, -2, -6):
            image = nib.load("a.dscalar.nii")
            volume = image.header.matrix.get_index_map(1).volume.transformation_matrix_voxel_indices_ijk_to_xyz
            volume.meter_exponent = exponent
            volume.matrix = np.diag([10.0 ** (-3 - exponent)] * 3 + [1])
            nib.save(image, "b.dscalar.nii")
            for options in ((), ("--column", 2)):
                new = self.smooth("b.dscalar.nii", *options)
                np.testing.assert_allclose(np.asarray(new.dataobj)[-1], expected[-1], rtol=1e-5)
                found = new.header.matrix.get_index_map(1).volume.transformation_matrix_voxel_indices_ijk_to_xyz
                self.assertEqual(found.meter_exponent, exponent)
                np.testing.assert_allclose(found.matrix, volume.matrix)

    def test_the_space_on_disk_is_there_before_values_are_written(self):
        from surfacediffusion.files.cifti import open_cifti
        from surfacediffusion.files.content import read_content

        samples.write_cifti("b.dtseries.nii", np.ones((4000, 2 * N)), series=True)
        file = open_cifti(read_content("b.dtseries.nii"))
        with file.writing("o.dtseries.nii", list(range(4000))) as write:
            (hidden,) = Path().glob(".o.dtseries.nii.*")
            found = hidden.stat()
            self.assertGreaterEqual(512 * found.st_blocks, found.st_size)
            self.assertGreater(found.st_size, 4 * 4000 * 2 * N)
            write(0, [slice(0, 2 * N)], np.ones((4000, 2 * N)))
        self.assertEqual(os.listdir().count("o.dtseries.nii"), 1)


class Signals(ForeignTest):
    def test_an_interruption_as_the_temporary_file_comes_to_be_leaves_none(self):
        created = os.open

        def create(*arguments):
            os.close(created(*arguments))
            self.assertEqual(len(os.listdir()), 1)
            raise KeyboardInterrupt

        with mock.patch("os.open", create), self.assertRaises(KeyboardInterrupt):
            write_atomically("a.txt", b"")
        self.assertEqual(os.listdir(), [])

    @unittest.skipUnless(hasattr(signal, "SIGHUP"), "needs signals")
    def test_a_run_that_is_ended_takes_its_temporary_file_away(self):
        samples.write_surface("l.surf.gii", *samples.sphere(5))
        samples.write_surface("r.surf.gii", *samples.sphere(5), structure="CortexRight")
        count = 10 * 4**5 + 2
        from nibabel import cifti2

        models = cifti2.BrainModelAxis.from_surface(np.arange(count), count, "CORTEX_LEFT") \
            + cifti2.BrainModelAxis.from_surface(np.arange(count), count, "CORTEX_RIGHT")
        image = cifti2.Cifti2Image(np.random.default_rng(0).normal(size=(2000, 2 * count)).astype(np.float32),
                                   cifti2.Cifti2Header.from_axes((cifti2.SeriesAxis(0, 1, 2000), models)))
        nib.save(image, "a.dtseries.nii")
        files = sorted(os.listdir())
        for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT):
            process = subprocess.Popen(
                [sys.executable, "-m", "surfacediffusion.command", "smooth", "a.dtseries.nii", "20",
                 "o.dtseries.nii", "--left", "l.surf.gii", "--right", "r.surf.gii"], stderr=subprocess.PIPE,
                text=True, env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1"))
            while process.poll() is None and not list(Path().glob(".o.*")):
                time.sleep(0.01)
            process.send_signal(number)
            _, error = process.communicate(timeout=120)
            self.assertEqual(process.returncode, 1, error)
            expected = "interrupted" if number == signal.SIGINT else f"ended by {number.name}"
            self.assertEqual(error, f"surfacediffusion: {expected}\n")
            self.assertEqual(sorted(os.listdir()), files)


class STL(ForeignTest):
    def rounded(self, points, faces, noise):
        corners = points[faces] + np.random.default_rng(5).uniform(-noise, noise, (len(faces), 3, 3))
        numbers = np.arange(3 * len(faces)).reshape(-1, 3)
        return self.write("part.stl", samples.stl_bytes(corners.reshape(-1, 3), numbers))

    def test_other_binary_files_are_none(self):
        content = b"MZ" + bytes(78) + struct.pack("<I", 1) + bytes(200)
        self.refused("x.mz3: a file of unknown kind that starts with b'MZ", "info", self.write("x.mz3", content))
        self.refused("x.mz3.gz: a file of unknown kind", "info", self.write("x.mz3.gz", gzip.compress(content)))

    def test_bytes_after_the_triangles_are_allowed_by_the_name_and_said(self):
        content = samples.stl_bytes() + b"made by a scanner"
        for name in ("a.stl", "A.STL"):
            self.warned(f"{name}: 17 bytes after the 320 triangles of its header are not read", "info",
                        self.write(name, content))
        self.refused("a file of unknown kind", "info", self.write("a", content))
        self.refused("a file of unknown kind", "info", self.write("short.stl", content[:-100]))

    def test_corners_that_are_rounded_apart_are_joined_and_it_is_said(self):
        for scale in (1e-3, 1, 1e3):
            points = scale * POINTS
            self.rounded(points, FACES, 1e-6 * scale)
            out = self.warned(r"part.stl: corners of facets up to \S+ apart, at open edges, are joined", "info",
                              "part.stl")
            self.assertIn(f"{N} points, 320 faces", out)
            for command in (["denoise-mesh", "part.stl", "o.stl"], ["refine", "part.stl", str(2 * scale), "o.ply"],
                            *[["texture", "part.stl", "5mm", "o.obj"]] * (scale == 1)):
                with self.subTest(command, scale=scale):
                    code, _, error = run(*command)
                    self.assertEqual(code, 0, error)
                    self.assertNotIn("boundary", error)
        surface = read_surface(self.write("a.stl", samples.stl_bytes()))
        expected = np.unique(POINTS.astype("f4"), axis=0)
        np.testing.assert_array_equal(surface.points, expected)

    def test_a_boundary_stays_and_no_triangle_is_lost(self):
        half = FACES[POINTS[FACES].mean(axis=1)[:, 2] > 0]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            surface = read_surface(self.rounded(POINTS, half, 1e-6))
        self.assertEqual(len(surface.points), len(np.unique(half)))
        far = np.concatenate([POINTS, 1e8 + POINTS[:3]])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            surface = read_surface(self.rounded(far, np.concatenate([half, [[N, N + 1, N + 2]]]), 1e-6))
        self.assertEqual(len(surface.points), len(np.unique(half)) + 3)
        thin = np.array([[0, 0, 0], [1, 0, 0], [1, 1e-6, 0], [0, 1e-6, 0], [0, 1, 0]], float)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            faces = np.array([[0, 1, 2], [0, 2, 3], [3, 2, 4]])
            surface = read_surface(self.write("a.stl", samples.stl_bytes(thin, faces)))
        self.assertEqual((len(surface.points), len(surface.faces)), (5, 3))


class FreeSurfer(ForeignTest):
    def test_old_surfaces_of_quadrangles_are_surfaces(self):
        def number(value):
            return struct.pack(">i", value)[1:]

        points = np.array([[x, y, 0] for x in range(4) for y in range(4)]) * 9
        quads = [[4 * i + j, 4 * i + 4 + j, 4 * i + 5 + j, 4 * i + 1 + j] for i in range(3) for j in range(3)]
        self.write("lh.orig", b"\xff\xff\xff" + number(16) + number(9) + (points * 100).astype(">i2").tobytes()
                   + b"".join(number(corner) for face in quads for corner in face))
        said = "lh.orig: quadrangles, which are read, and written, as two triangles each"
        self.assertIn("freesurfer, 16 points, 18 faces", self.warned(said, "info", "lh.orig"))
        np.save("v.npy", np.arange(16.0))
        self.warned(said, "smooth", "lh.orig", "v.npy", 18, "o.npy")
        self.assertIn("curv", self.succeed("info", samples.write_curv("lh.curv")))

    def test_surfaces_in_text_are_read_and_written(self):
        lines = ["#!ascii version of lh.white", f"{N} {len(FACES)}"]
        lines += [f"{x!r}  {y!r}  {z!r}  0" for x, y, z in POINTS.tolist()]
        lines += [f"{a} {b} {c} 0" for a, b, c in FACES]
        self.write("lh.asc", "\n".join(lines) + "\n")
        surface = read_surface("lh.asc")
        np.testing.assert_array_equal(surface.points, POINTS)
        np.testing.assert_array_equal(surface.faces, FACES)
        self.assertEqual(surface.structure, "CortexLeft")
        surface.save("lh.new.asc", 2 * surface.points)
        np.testing.assert_array_equal(read_surface("lh.new.asc").points, 2 * POINTS)
        self.assertEqual(Path("lh.new.asc").read_text().splitlines()[N + 2:], lines[N + 2:])
        self.succeed("distance", "lh.asc", "d.npy", "--from", 0)
        for part in (1, N // 2, N + 9):
            self.refused("lh.asc: damaged FreeSurfer asc file: ", "info",
                         self.write("lh.asc", "\n".join(lines[:part]) + "\n"))

    def test_the_other_hemisphere_is_an_error(self):
        samples.write_surface("rh.white")
        samples.write_curv("lh.thickness")
        message = "lh.thickness: data of the left hemisphere by its name, but rh.white is of CortexRight; allowed: the "
        self.refused(message + "same hemisphere, or any with --any-hemisphere", "smooth", "rh.white", "lh.thickness", 5,
                     "o.curv")
        self.refused(message, "distance", "rh.white", "lh.thickness", "d.npy")
        self.succeed("smooth", "rh.white", "lh.thickness", 5, "o.curv", "--any-hemisphere")
        samples.write_surface("lh.white")
        self.succeed("smooth", "lh.white", "lh.thickness", 5, "o.curv")
        samples.write_gifti("100307.R.thickness.32k_fs_LR.shape.gii", {"a": samples.NOISE}, "")
        samples.write_surface("sub-1_hemi-L_space-fsLR_midthickness.surf.gii", structure="")
        samples.write_surface("L.R.surf.gii", structure="")
        words = ["smooth", "L.R.surf.gii", "100307.R.thickness.32k_fs_LR.shape.gii", 5, "o.shape.gii"]
        self.succeed(*words)
        words[1] = "sub-1_hemi-L_space-fsLR_midthickness.surf.gii"
        self.refused("but sub-1_hemi-L_space-fsLR_midthickness.surf.gii is of the left hemisphere by its name", *words)
        words[1] = samples.write_surface("R.surf.gii", structure="HippocampusLeft")
        self.refused("data of the right hemisphere by its name, but R.surf.gii is of HippocampusLeft", *words)
        words[2] = samples.write_gifti("R.func.gii", {"a": samples.NOISE}, "CortexLeft")
        words[4] = "o.func.gii"
        self.refused("R.func.gii: data of CortexLeft, but R.surf.gii is of HippocampusLeft; allowed: the same "
                     "structure", *words, "--any-hemisphere")
        samples.write_cifti("a.dscalar.nii", [np.tile(samples.NOISE, 2)])
        words = ["smooth", "a.dscalar.nii", 5, "o.dscalar.nii", "--left", "rh.white", "--right", "lh.white"]
        self.refused("--left: for CortexLeft, but rh.white is of CortexRight; allowed: the same hemisphere", *words)
        self.succeed(*words, "--any-hemisphere")
        self.refused("--surface HIPPOCAMPUS_RIGHT: for HippocampusRight, but lh.white is of CortexLeft", *words[:4],
                     "--surface", "HIPPOCAMPUS_RIGHT", "lh.white")

    def test_spheres_and_surfaces_of_another_scale_are_a_warning(self):
        samples.write_gifti("L.shape.gii", {"a": samples.NOISE})
        ball, bumps = 10 * POINTS, 10 * POINTS * (1 + 0.02 * np.sin(POINTS[:, :1]))
        words = ["smooth", "x.surf.gii", "L.shape.gii", 50, "o.shape.gii"]
        for points, text in ((ball + 7, "x.surf.gii is a sphere of radius 100: lengths and areas"), (bumps, ""),
                             (8 * POINTS, ""),
                             (bumps / 1000, "x.surf.gii is 0.2 long, and a cortex in mm 20 to 500: lengths"),
                             (1000 * bumps, "x.surf.gii is 2e.05 long, and a cortex in mm 20 to 500")):
            samples.write_surface("x.surf.gii", points)
            words[3] = 0.5 * np.ptp(points)
            if text:
                self.warned(text, *words)
            else:
                self.succeed(*words)
        image = nib.load(samples.write_surface("x.surf.gii", ball))
        image.darrays[0].meta["GeometricType"] = "Anatomical"
        nib.save(image, "x.surf.gii")
        self.succeed(*words[:3], 50, "o.shape.gii")
        samples.write_surface("x.surf.gii", bumps / 1000, structure="")
        self.succeed(*words[:3], 0.05, "o.shape.gii")

    def test_lengths_on_shapes_that_are_none_of_the_brain_are_a_warning(self):
        samples.write_curv("lh.thickness")
        expected = "{} is {}: lengths and areas on it are not those of the brain; give an anatomical surface"
        for name, shape in (("lh.inflated", "inflated"), ("lh.sphere", "spherical"),
                            ("lh.sphere.reg", "spherical")):
            samples.write_surface(name)
            self.warned(expected.format(name, shape), "smooth", name, "lh.thickness", 5, "o.curv")
            self.warned(expected.format(name, shape), "distance", name, "o.curv", "--from", 0)
        for name, shape in (("L.sphere.32k_fs_LR.surf.gii", "spherical"),
                            ("sub-01_hemi-L_inflated.surf.gii", "inflated")):
            image = nib.load(samples.write_surface(name))
            image.darrays[0].meta.pop("GeometricType", None)
            nib.save(image, name)
            self.warned(expected.format(name, shape), "smooth", name, "lh.thickness", 5, "o.curv")
        for shape in ("Spherical", "Inflated", "Very_Inflated", "Flat"):
            image = nib.load(samples.write_surface("a.surf.gii"))
            image.darrays[0].meta["GeometricType"] = shape
            nib.save(image, "a.surf.gii")
            self.warned(expected.format("a.surf.gii", shape.lower().replace("_", " ")), "curvature", "a.surf.gii",
                        "o.npy", "--fwhm", 5)
            self.assertEqual(run("info", "a.surf.gii")[2], "")


class Sentences(ForeignTest):
    """What the user reads instead of what Python says."""

    def test_words_that_are_no_numbers(self):
        ply = samples.ply_bytes(binary=False)
        cases = [("a.stl", stl_text().replace("vertex ", "vertex blah", 1), "'blah.*' is no number"),
                 ("a.off", "OFF\n3 1 0\n0 0 0\n1 blah 0\n0 1 0\n3 0 1 2\n", "'blah' is no number"),
                 ("a.obj", samples.obj_text().replace("v ", "v blah ", 1), "'blah' is no number"),
                 ("a.ply", ply.replace(b"end_header\n", b"end_header\nblah "), "a line of"),
                 ("b.ply", ply.replace(b"\n3 ", b"\nblah "), "'blah' is no whole number"),
                 ("empty.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                  "property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n",
                  "0 points and 0 faces; allowed: at least one of each"),
                 ("a.label", "#!ascii label\nblah\n", "'blah' is no whole number"),
                 ("b.label", "#!ascii label\n", "it ends too early")]
        for name, content, expected in cases:
            with self.subTest(name):
                self.refused(f"{name}: .*{expected}", "info", self.write(name, content))
                error = run("info", name)[2]
                for word in ("np.", "b'", "literal", "reshape", "index out", "convert"):
                    self.assertNotIn(word, error)

        self.write("c.ply", ply.replace(b"\n3 0 ", b"\n3 99999999999999999999 "))
        with self.assertRaisesRegex(FileError, "c.ply: damaged PLY file: a number is too large"):
            read_surface("c.ply")

    def test_files_of_kinds_that_are_not_read(self):
        cases = [(name, b"PK\3\4" + bytes(100), r"an archive of files \(zip\) without the model of a 3MF file; allowed: ")
                 for name in ("part.3mf", "x.zip")]
        nib.save(nib.Nifti1Pair(np.zeros((5, 1, 1), "f4"), np.eye(4)), "a.img")
        nib.save(nib.AnalyzeImage(np.zeros((5, 1, 1), "f4"), np.eye(4)), "b.img")
        cases += [(name, Path(name).read_bytes(), "half of a pair of files .hdr and .img; allowed: .*NIfTI")
                  for name in ("a.img", "a.hdr", "b.img", "b.hdr")]
        for name, content, expected in cases:
            self.refused(f"{name}: {expected}", "info", self.write(name, content))

    def test_results_beyond_single_precision_are_refused_and_never_infinite(self):
        self.write("a.off", samples.off_text(3e37 * POINTS))
        for name in ("o.npy", "o.func.gii", "o.txt"):
            self.refused(rf"{name}: a value is \S+e\+38; allowed in .*: less than 3.4e38", "distance", "a.off",
                         name, "--from", 0)
        self.refused(r"o.stl: a coordinate is 3e\+39; allowed in STL: less than 3.4e38", "refine", self.write(
            "b.off", samples.off_text(3e38 * POINTS)), "1e40", "o.stl")
        surface = read_surface(samples.write_surface("a.surf.gii"))
        with self.assertRaisesRegex(FileError, r"b.surf.gii: a coordinate is 1e\+40; allowed in GIFTI: less than"):
            surface.save("b.surf.gii", 1e39 * POINTS)

    def test_info_tells_of_all_good_files_and_of_each_bad_one(self):
        samples.write_surface("a.surf.gii")
        self.write("b.off", "OFF\n0 0 0\n")
        self.write("c.bin", b"\1\2\3\4")
        self.write("d.off", samples.off_text())
        code, out, error = run("info", "a.surf.gii", "b.off", "c.bin", "d.off")
        self.assertEqual(code, 2)
        self.assertEqual([line.split(":")[0] for line in out.splitlines()], ["a.surf.gii", "d.off"])
        self.assertRegex(error, r"\Asurfacediffusion: b.off: .*\nsurfacediffusion: c.bin: .*\n\Z")

    def test_commands_of_workbench_are_answered_with_those_that_are_here(self):
        for word, here in (("-cifti-gradient", "derivatives"),
                           ("-label-resample", "resample")):
            self.refused(f"^surfacediffusion: {word} is a command of Workbench .*; allowed: surfacediffusion "
                         f"{here}, or -metric-smoothing, -cifti-smoothing, -metric-resample", word, "a", "b", "c")

    def test_the_advice_about_seams_works(self):
        corners = np.arange(3 * len(FACES)).reshape(-1, 3)
        self.write("seam.obj", samples.obj_text(POINTS[FACES].reshape(-1, 3), corners))
        np.save("v.npy", SMOOTH[FACES].ravel())
        for command in (["smooth", "seam.obj", "v.npy", 8, "o.npy"], ["curvature", "seam.obj", "o.npy"],
                        ["texture", "seam.obj", 20, "o.npy"], ["normals", "seam.obj", "o.npy"],
                        ["directions", "seam.obj", "o.npy"], ["derivatives", "seam.obj", "v.npy", "o.npy"],
                        ["interpolate", "seam.obj", "v.npy", "o.npy"], ["denoise-mesh", "seam.obj", "o.obj"]):
            with self.subTest(command):
                self.assertIn("coincide with others", run(*command)[2])
                self.assertRegex(run(*command)[2], "to join them, set --merge")
                code, _, error = run(*command, "--merge")
                self.assertEqual(code, 0, error)
                self.assertNotIn("coincide", error)
        self.refused("--merge for parts, whose vertices at the same place are one; allowed: for values", "texture",
                     "seam.obj", "20mm", "o.off", "--merge")

    def test_what_texture_allows_for_a_part_is_allowed(self):
        self.write("part.stl", samples.stl_bytes())
        self.refused("x.stl: without relief .*; allowed: --relief HEIGHT, or .3mf, .obj, .off or .ply", "texture",
                     "part.stl", "8mm", "x.stl")
        for name in ("x.3mf", "x.obj", "x.off", "x.ply"):
            self.succeed("texture", "part.stl", "8mm", name)
        self.succeed("texture", "part.stl", "8mm", "x.3mf", "--relief", "0.4mm")
        self.refused("part.stl: an STL file numbers no vertices, .*; allowed: a surface of another format",
                     "texture", "part.stl", "8mm", "x.npy")


if __name__ == "__main__":
    unittest.main(verbosity=2)
