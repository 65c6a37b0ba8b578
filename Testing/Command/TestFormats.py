# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Variants of the formats that other programs write: they are read rightly or refused in one line, and
never silently read wrongly."""

import gzip
import os
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np
import samples
from samples import COLOURS, FACES, HAS_VTK, N, NOISE, POINTS, SMOOTH, gifti, nib, run

from surfacediffusion.files import FileError, read_data, read_surface


class FormatTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def write(self, name, content):
        Path(name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def refused(self, expected, *arguments):
        code, _, error = run(*arguments)
        self.assertEqual((code, error.count("\n")), (2, 1), error)
        self.assertRegex(error, expected)

    def succeed(self, *arguments):
        code, out, error = run(*arguments)
        self.assertEqual((code, error), (0, ""))
        return out


def write_nifti(path, values, shape):
    nib.save(nib.Nifti1Image(np.asarray(values, np.float32).reshape(shape, order="F"), np.eye(4)),
             str(path))
    return path


class OneOpening(FormatTest):
    """A file is read once, whether it is compressed, a pipe or neither."""

    def files(self):
        yield samples.write_surface("a.surf.gii")
        yield samples.write_surface("lh.white")
        yield self.write("a.off", samples.off_text())
        yield self.write("a.obj", samples.obj_text())
        yield self.write("a.ply", samples.ply_bytes())
        yield self.write("a.stl", samples.stl_bytes())
        yield samples.write_gifti("a.func.gii", {"one": NOISE})
        yield samples.write_cifti("a.dscalar.nii", [np.append(NOISE, SMOOTH)])
        yield samples.write_curv("lh.thickness")
        yield samples.write_mgh("a.mgh", NOISE)
        yield write_nifti("a.nii", NOISE, (N, 1, 1))
        yield samples.write_label("a.label", [1, 2, 7], [1, 2, 3])
        yield samples.write_annot("lh.annot", np.arange(N) % 3, ["unknown", "one", "two"])
        np.save("a.npy", NOISE)
        yield "a.npy"
        yield self.write("a.txt", "\n".join(map(str, NOISE)))
        if HAS_VTK:
            yield samples.write_vtk("a.vtk")
            yield samples.write_vtk("a.vtp")

    def content(self, path):
        found = []
        for read in (read_surface, read_data):
            try:
                found.append(read(path))
            except FileError:
                found.append(None)
        return found

    def compare(self, path, other):
        for expected, found in zip(self.content(path), other):
            self.assertEqual(expected is None, found is None, path)
            if hasattr(expected, "points"):
                np.testing.assert_array_equal(found.points, expected.points, path)
                np.testing.assert_array_equal(found.faces, expected.faces, path)
            elif expected is not None:
                for a, b in zip(expected.parts, found.parts):
                    np.testing.assert_array_equal(a.values, b.values, path)

    def test_gzip_of_every_format_has_the_same_content(self):
        for path in self.files():
            with self.subTest(path):
                self.write("packed.gz", gzip.compress(Path(path).read_bytes()))
                self.compare(path, self.content("packed.gz"))

    def test_pipes_of_every_format_have_the_same_content(self):
        for path in self.files():
            with self.subTest(path):
                found = []
                for read in (read_surface, read_data):
                    with self.pipe(path) as name:
                        try:
                            found.append(read(name))
                        except FileError:
                            found.append(None)
                self.compare(path, found)

    def pipe(self, path):
        """A pipe of the file's content as <(cat path) of a shell gives it."""
        reader, writer = os.pipe()

        def feed():
            with open(writer, "wb") as file:
                file.write(Path(path).read_bytes())

        thread = threading.Thread(target=feed)
        thread.start()

        class Pipe:
            def __enter__(self):
                return f"/dev/fd/{reader}"

            def __exit__(self, *_):
                thread.join()
                os.close(reader)

        return Pipe()

    def test_info_reads_a_pipe_that_holds_a_surface_and_data(self):
        self.write("a.ply", samples.ply_bytes())
        with self.pipe("a.ply") as name:
            out = self.succeed("info", name)
        self.assertIn(f"{N} points", out)
        self.assertIn("red", out)


class NumbersOfVertices(FormatTest):
    """Values go to the vertices that the file names, or are refused."""

    def setUp(self):
        super().setUp()
        samples.write_surface("lh.surf.gii")
        self.order = np.random.default_rng(5).permutation(N)

    def sparse(self, name, *indices, values=None):
        arrays = [gifti.GiftiDataArray(np.asarray(i, np.int32), "NIFTI_INTENT_NODE_INDEX",
                                       "NIFTI_TYPE_INT32") for i in indices]
        arrays.append(gifti.GiftiDataArray(
            (NOISE[indices[0]] if values is None else values).astype(np.float32),
            "NIFTI_INTENT_SHAPE", "NIFTI_TYPE_FLOAT32"))
        nib.save(gifti.GiftiImage(darrays=arrays), name)
        return name

    def test_node_index_of_gifti_is_the_vertex_of_each_value(self):
        samples.write_gifti("all.shape.gii", {"one": NOISE})
        self.succeed("smooth", "lh.surf.gii", "all.shape.gii", 5, "expected.shape.gii")
        self.sparse("some.shape.gii", self.order)
        self.succeed("smooth", "lh.surf.gii", "some.shape.gii", 5, "found.shape.gii")
        expected = read_data("expected.shape.gii").parts[0].values
        found = nib.load("found.shape.gii")
        self.assertEqual([array.intent for array in found.darrays], [2002, 2005])
        np.testing.assert_array_equal(found.darrays[0].data, self.order)
        np.testing.assert_array_equal(found.darrays[1].data, expected[self.order, 0])

    def test_a_part_of_the_vertices_is_smoothed_as_a_region(self):
        part = np.random.default_rng(5).permutation(np.flatnonzero(POINTS[:, 2] > -6))
        self.sparse("some.shape.gii", part)
        samples.write_label("some.label", part, np.ones(len(part)))
        samples.write_gifti("all.shape.gii", {"one": NOISE})
        self.succeed("smooth", "lh.surf.gii", "some.shape.gii", 5, "found.shape.gii")
        self.succeed("smooth", "lh.surf.gii", "all.shape.gii", 5, "expected.shape.gii", "--roi",
                     "some.label")
        np.testing.assert_array_equal(read_data("found.shape.gii").parts[0].values,
                                      read_data("expected.shape.gii").parts[0].values[part])

    def test_wrong_numbers_of_vertices_are_refused(self):
        command = ["smooth", "lh.surf.gii", "x.gii", 5, "out.gii"]
        self.sparse("x.gii", [1, 2, 2])
        self.refused("NODE_INDEX has a vertex twice", *command)
        self.sparse("x.gii", [1, 2, 3], values=np.ones(2))
        self.refused("3 numbers of vertices for 2 values; allowed: one per value", *command)
        self.sparse("x.gii", [1, 2, 3], [1, 2, 3])
        self.refused("several arrays of numbers of vertices", *command)

    def test_numbers_beyond_the_surface_are_refused(self):
        self.sparse("x.gii", [1, 2, N], values=np.ones(3))
        self.refused(f"vertices 1 to {N}, but lh.surf.gii has points 0 to {N - 1}",
                     "smooth", "lh.surf.gii", "x.gii", 5, "out.gii")

    def test_an_stl_takes_no_data_at_vertices_but_at_faces(self):
        self.write("a.stl", samples.stl_bytes())
        np.save("v.npy", NOISE)
        np.save("f.npy", POINTS[FACES].mean(axis=1)[:, 2])
        for arguments in (["smooth", "a.stl", "v.npy", 5, "o.npy"],
                          ["smooth", "a.stl", "f.npy", 5, "o.npy", "--faces", "--roi", "v.npy"],
                          ["denoise-mesh", "a.stl", "b.stl", "--fixed", "v.npy"],
                          ["texture", "a.stl", 5, "o.npy"]):
            with self.subTest(arguments):
                self.refused("STL file numbers no vertices|values per column", *arguments)
        self.succeed("smooth", "a.stl", "f.npy", 5, "o.npy", "--faces")
        self.succeed("smooth", "lh.surf.gii", "f.npy", 5, "p.npy", "--faces")
        np.testing.assert_allclose(np.load("o.npy"), np.load("p.npy"), atol=1e-5)


class NumberPerLine(FormatTest):
    """Maps as text."""

    def setUp(self):
        super().setUp()
        samples.write_surface("lh.surf.gii")
        np.save("a.npy", NOISE)
        self.succeed("smooth", "lh.surf.gii", "a.npy", 5, "expected.npy")
        self.expected = np.load("expected.npy")

    def test_lines_are_values_and_comments_stay(self):
        numbers = [str(number) for number in NOISE.tolist()]
        numbers[3] = f"  {numbers[3]} # a vertex\xe9"
        lines = ["# mm", "", *numbers, "# the end"]
        self.write("a.txt", "\r\n".join(lines).encode("latin-1"))
        self.succeed("smooth", "lh.surf.gii", "a.txt", 5, "b.txt")
        written = Path("b.txt").read_bytes().decode("latin-1").split("\r\n")
        self.assertEqual((written[:2], written[-1]), (lines[:2], lines[-1]))
        self.assertRegex(written[5], "^  [0-9.]+ # a vertex\xe9$")
        np.testing.assert_allclose(read_data("b.txt").parts[0].values[:, 0], self.expected, rtol=1e-6)

    def test_an_output_is_text_by_its_name(self):
        self.succeed("smooth", "lh.surf.gii", "a.npy", 5, "b.txt")
        np.testing.assert_array_equal(np.loadtxt("b.txt", dtype=np.float32), self.expected)
        self.succeed("smooth", "lh.surf.gii", "b.txt", 5, "c.shape.gii")
        self.succeed("smooth", "lh.surf.gii", "expected.npy", 5, "c.npy")
        np.testing.assert_allclose(read_data("c.shape.gii").parts[0].values[:, 0], np.load("c.npy"), rtol=1e-6)
        np.save("two.npy", np.column_stack([SMOOTH, NOISE]))
        self.succeed("smooth", "lh.surf.gii", "two.npy", 5, "b.txt", "--column", 2)
        np.testing.assert_array_equal(np.loadtxt("b.txt", dtype=np.float32), self.expected)
        self.succeed("distance", "lh.surf.gii", "d.txt", "--from", 0)
        self.assertEqual(np.loadtxt("d.txt").shape, (N,))

    def test_values_at_faces_and_missing_ones(self):
        values = POINTS[FACES].mean(axis=1)[:, 2]
        values[7] = np.nan
        self.write("f.txt", "".join(f"{z}\n" for z in values))
        self.succeed("inpaint", "lh.surf.gii", "f.txt", "o.txt", "--faces")
        found = np.loadtxt("o.txt")
        self.assertTrue(np.isfinite(found).all())
        np.testing.assert_array_equal(np.delete(found, 7), np.delete(values, 7))

    def test_interpolate_takes_a_number_per_vertex(self):
        self.write("a.txt", "".join(f"{z if i % 4 == 0 else 'nan'}\n" for i, z in enumerate(SMOOTH)))
        np.save("a.npy", np.where(np.arange(N) % 4 == 0, SMOOTH, np.nan))
        for name in ("a.txt", "a.npy"):
            self.succeed("interpolate", "lh.surf.gii", name, name.replace("a", "out", 1), "--exact")
        np.testing.assert_allclose(np.loadtxt("out.txt"), np.load("out.npy"), rtol=1e-6)


class Names(FormatTest):
    def test_a_series_is_not_written_under_the_name_of_scalars_nor_these_under_its_name(self):
        samples.write_surface("l.surf.gii")
        samples.write_surface("r.surf.gii", structure="CortexRight")
        surfaces = ["--left", "l.surf.gii", "--right", "r.surf.gii"]
        rows = np.random.default_rng(1).normal(size=(2, 2 * N))
        samples.write_cifti("a.dtseries.nii", rows, series=True)
        samples.write_cifti("a.dscalar.nii", rows)
        for data, out in (("dtseries", "dscalar"), ("dscalar", "dtseries"), ("dscalar", "dlabel"),
                          ("dscalar", "pscalar")):
            self.refused(rf"o.{out}.nii: named .{out}.nii, but it is written as .{data}.nii",
                         "smooth", f"a.{data}.nii", 5, f"o.{out}.nii", *surfaces)
            self.assertFalse(Path(f"o.{out}.nii").exists())
        for name in ("o.dtseries.nii", "o.nii"):
            self.succeed("smooth", "a.dtseries.nii", 5, name, *surfaces)

    def test_a_write_protected_output_is_kept(self):
        samples.write_surface("lh.surf.gii")
        samples.write_gifti("a.shape.gii", {"one": NOISE})
        self.write("out.shape.gii", "kept")
        os.chmod("out.shape.gii", 0o444)
        self.refused("out.shape.gii: cannot be written: the file there is write-protected",
                     "smooth", "lh.surf.gii", "a.shape.gii", 5, "out.shape.gii")
        self.assertEqual(Path("out.shape.gii").read_text(), "kept")

    def test_structures_other_than_cortex_are_named(self):
        samples.write_surface("l.surf.gii")
        from nibabel import cifti2

        models = cifti2.BrainModelAxis.from_surface(np.arange(N), N, "HIPPOCAMPUS_LEFT")
        image = cifti2.Cifti2Image(NOISE[None], cifti2.Cifti2Header.from_axes(
            (cifti2.ScalarAxis(["a"]), models)))
        nib.save(image, "a.dscalar.nii")
        self.refused("has data of HippocampusLeft; add --surface HIPPOCAMPUS_LEFT FILE", "smooth",
                     "a.dscalar.nii", 5, "b.dscalar.nii", "--left", "l.surf.gii")


def stl_text(points=POINTS, faces=FACES, end="endsolid a part\n", word="solid"):
    lines = [f"{word} a part"]
    for face in faces:
        lines += ["  facet normal 0 0 0", "    outer loop"]
        lines += [f"      vertex {x!r} {y!r} {z!r}" for x, y, z in points[face].tolist()]
        lines += ["    endloop", "  endfacet"]
    return "\n".join(lines) + "\n" + end


class STL(FormatTest):
    def check(self, path):
        surface = read_surface(path)
        np.testing.assert_allclose(surface.points[surface.faces], POINTS[FACES], atol=1e-5)
        return surface

    def test_text_stays_text_and_has_the_normals_of_its_triangles(self):
        for word in ("solid", "SOLID"):
            surface = self.check(self.write("a.stl", stl_text(word=word)))
            surface.save("b.stl", surface.points * 2)
            lines = Path("b.stl").read_text().splitlines()
            self.assertEqual(lines[0], f"{word} a part")
            normals = np.array([line.split()[2:] for line in lines if "facet normal" in line], float)
            corners = POINTS[FACES]
            expected = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            expected /= np.linalg.norm(expected, axis=1)[:, None]
            np.testing.assert_allclose(normals, expected, atol=1e-6)
            again = read_surface("b.stl")
            np.testing.assert_allclose(again.points, 2 * surface.points)

    def test_binary_files_keep_header_and_attributes(self):
        content = bytearray(samples.stl_bytes())
        content[84 + 48:84 + 50] = b"\x07\x08"
        surface = self.check(self.write("a.stl", bytes(content)))
        surface.save("b.stl", surface.points * 2)
        found = Path("b.stl").read_bytes()
        self.assertEqual((len(found), found[:84], found[132:134]),
                         (len(content), content[:84], b"\x07\x08"))

    def test_bytes_after_the_triangles_are_allowed(self):
        self.check(self.write("a.stl", samples.stl_bytes() + b"made by a scanner"))

    def test_text_that_ends_early_is_refused(self):
        text = stl_text()
        for part in (text[:len(text) // 2], stl_text(end=""),
                     text[:text.index("endfacet") + len("endfacet\n")]):
            self.refused("a.stl: damaged STL file: (the end is missing|.*coordinates|.*vertices)",
                         "info", self.write("a.stl", part))

    def test_text_gives_no_warning(self):
        large = POINTS * 1e5
        self.succeed("info", self.write("a.stl", stl_text(large)))


class Normals(FormatTest):
    """The normals of a file are those of the points that it has."""

    def setUp(self):
        super().setUp()
        self.noisy = POINTS * (1 + np.random.default_rng(9).normal(0, 0.05, (N, 1)))

    def expected(self, path):
        from surfacediffusion import Surface

        surface = read_surface(path)
        given = Surface(surface.points, surface.faces)
        self.assertGreater(np.abs(np.asarray(surface.points) - self.noisy).max(), 0.1)
        return given._point_normals(), given._face_normals()

    def run_both(self, name, done):
        for command in (["denoise-mesh", name, "new." + name, "--noise", "0.5"],
                        ["normals", name, "new." + name, "--move"]):
            out = self.succeed(*command)
            self.assertTrue((f", normals {done}," in out) == bool(done), out)
            yield Path("new." + name)

    def test_one_normal_per_vertex_of_obj_is_computed_again(self):
        lines = ["# a mesh"]
        for i, (x, y, z) in enumerate(self.noisy.tolist()):
            lines += [f"v {x} {y} {z}", f"vn {i} 0 0"]
        lines += ["f " + " ".join(f"{c + 1}//{c + 1}" for c in face) for face in FACES]
        self.write("a.obj", "\n".join(lines) + "\n")
        for path in self.run_both("a.obj", "computed again"):
            found = [line.split()[1:] for line in path.read_text().splitlines() if "vn" in line]
            np.testing.assert_allclose(np.array(found, float), self.expected(path)[0], atol=1e-6)
            self.assertEqual(path.read_text().splitlines()[-len(FACES):], lines[-len(FACES):])

    def test_normals_of_corners_of_obj_are_left_out(self):
        self.write("a.obj", samples.obj_text(self.noisy) + "f 1//1 2//1 3//1 # 1/1/1\n")
        for path in self.run_both("a.obj", "left out"):
            lines = path.read_text().splitlines()
            self.assertFalse([line for line in lines if line.startswith("vn")])
            self.assertIn("vt 0 0", lines)
            self.assertEqual(lines[-1], "f 1 2 3 # 1/1/1")
            self.assertEqual(lines[-2], " ".join(["f", *(f"{c + 1}/1" for c in FACES[-1])]))

    def test_normals_of_ply_are_computed_again(self):
        header = (f"ply\nformat ascii 1.0\nelement vertex {N}\n" + "".join(
            f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
            + f"element face {len(FACES)}\nproperty list uchar int vertex_indices\nend_header\n")
        rows = [" ".join(map(str, [*point, 1, 0, 0])) for point in self.noisy.tolist()]
        rows += [f"3 {a} {b} {c}" for a, b, c in FACES.tolist()]
        self.write("a.ply", header + "\n".join(rows) + "\n")
        for path in self.run_both("a.ply", "computed again"):
            data = read_data(path)
            self.assertEqual(data.names, ["nx", "ny", "nz"])
            np.testing.assert_allclose(data.parts[0].values, self.expected(path)[0], atol=1e-6)

    def test_normals_of_gifti_are_computed_again(self):
        samples.write_surface("a.surf.gii", self.noisy, FACES)
        image = nib.load("a.surf.gii")
        unit = np.tile(np.float32([0.6, 0, 0.8]), (N, 1))
        for vectors in (unit, 3 * unit):  # normals, and vectors that are none
            image.add_gifti_data_array(gifti.GiftiDataArray(vectors, "NIFTI_INTENT_VECTOR", "NIFTI_TYPE_FLOAT32"))
        nib.save(image, "a.surf.gii")
        for path in self.run_both("a.surf.gii", "computed again"):
            normals, others = nib.load(path).get_arrays_from_intent("NIFTI_INTENT_VECTOR")
            np.testing.assert_allclose(normals.data, self.expected(path)[0], atol=1e-6)
            np.testing.assert_array_equal(others.data, 3 * unit)
        samples.write_surface("b.surf.gii", self.noisy, FACES)
        for _ in self.run_both("b.surf.gii", ""):
            pass

    def test_normals_of_off_are_computed_again(self):
        lines = ["NOFF", f"{N} {len(FACES)} 0"]
        lines += [f"{x} {y} {z} 1 0 0 # {i}" for i, (x, y, z) in enumerate(self.noisy.tolist())]
        lines += [f"3 {a} {b} {c}" for a, b, c in FACES.tolist()]
        self.write("a.off", "\n".join(lines) + "\n")
        for path in self.run_both("a.off", "computed again"):
            found = [line.split() for line in path.read_text().splitlines()[2:N + 2]]
            np.testing.assert_allclose(np.array([row[3:6] for row in found], float),
                                       self.expected(path)[0], atol=1e-6)
            self.assertEqual(found[7][6:], ["#", "7"])

    @unittest.skipUnless(HAS_VTK, "needs vtk")
    def test_normals_of_vtk_are_computed_again(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy

        from surfacediffusion.files import vtk_files

        for name in ("a.vtp", "a.vtk"):
            samples.write_vtk(name, self.noisy)
            image = read_surface(name).image
            for data, count in ((image.GetPointData(), N), (image.GetCellData(), len(FACES))):
                from vtkmodules.util.numpy_support import numpy_to_vtk

                old = numpy_to_vtk(np.tile(np.float32([1, 0, 0]), (count, 1)), deep=True)
                old.SetName("Normals")
                data.SetNormals(old)
            self.write(name, vtk_files.write(name[2:], image))
            for path in self.run_both(name, "computed again"):
                mesh = read_surface(path).image
                for data, expected in zip((mesh.GetPointData(), mesh.GetCellData()),
                                          self.expected(path)):
                    np.testing.assert_allclose(vtk_to_numpy(data.GetArray("Normals")), expected,
                                               atol=1e-6)

    def test_files_without_normals_say_nothing_of_them(self):
        self.write("a.off", samples.off_text(self.noisy))
        for path in self.run_both("a.off", ""):
            self.assertEqual(read_surface(path).kind, "off")


class PLY(FormatTest):
    """Each case is written as text and in both binary orders; the mesh is that of samples."""

    #: (name, elements): an element is (name, rows, properties); a property is (its lines, format, values
    #: of a row), of a list the format is "B" + that of its values.
    def cases(self):
        vertex = ("vertex", N, [("float x", "f"), ("float y", "f"), ("float z", "f")],
                  POINTS.astype(np.float32).tolist())
        triangles = [[row.tolist()] for row in FACES]
        corners = ("list uchar int vertex_indices", "Bi")
        faces = ("face", len(FACES), [corners], triangles)
        yield "plain", [vertex, faces]
        colours = [(f"uchar {name}", "B") for name in ("red", "green", "blue")]
        yield "face colours", [vertex, ("face", len(FACES), [corners, *colours],
                                        [[*row, 1, 2, 3] for row in triangles])]
        yield "a property before the list", [vertex, ("face", len(FACES), [("uint8 flags", "B"), corners],
                                                      [[5, *row] for row in triangles])]
        yield "texture coordinates of corners", [vertex, (
            "face", len(FACES), [corners, ("list uchar float texcoord", "Bf"), ("int texnumber", "i")],
            [[*row, [0, 0.5, 0.25, 1, 0, 0], -1] for row in triangles])]
        yield "edges", [vertex, faces, (
            "edge", 2, [("int vertex1", "i"), ("int vertex2", "i"), ("uchar red", "B")],
            [[0, 1, 255], [1, 2, 0]])]
        yield "a camera before the vertices", [
            ("camera", 1, [("float view_px", "f"), ("double focal", "d")], [[0.5, 2]]), vertex, faces]
        yield "colours before the coordinates", [
            ("vertex", N, [*colours, ("double x", "d"), ("double y", "d"), ("double z", "d")],
             [[*c, *p] for c, p in zip(COLOURS.tolist(), POINTS.tolist())]), faces]
        yield "another name and types", [vertex, (
            "face", len(FACES), [("list ushort uint32 vertex_index", "HI")], triangles)]

    def build(self, elements, order):
        name = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
        header = f"ply\nformat {name} 1.0\ncomment TextureFile Ålesund.png\nobj_info a scan\n"
        body = b""
        for element, count, properties, rows in elements:
            header += f"element {element} {count}\ncomment of {element}\n"
            header += "".join(f"property {words}\n" for words, _ in properties)
            for row in rows:
                words, packed = [], b""
                for (_, form), value in zip(properties, row):
                    if isinstance(value, list):
                        words += [len(value), *value]
                        packed += struct.pack(order + form[0] + f"{len(value)}{form[1]}", len(value),
                                              *value)
                    else:
                        words.append(value)
                        packed += struct.pack(order + form, value)
                body += packed if order else (" ".join(map(str, words)) + "\n").encode()
        return header.encode() + b"end_header\n" + body

    def test_variants_are_read_and_everything_but_points_is_written_as_it_was(self):
        for name, elements in self.cases():
            for order in ("", "<", ">"):
                with self.subTest(name, order=order):
                    content = self.build(elements, order)
                    surface = read_surface(self.write("a.ply", content))
                    np.testing.assert_allclose(surface.points, POINTS, atol=1e-6)
                    np.testing.assert_array_equal(surface.faces, FACES)
                    surface.save("same.ply", surface.points)
                    surface.save("moved.ply", 2 * surface.points)
                    same = Path("same.ply").read_bytes()
                    self.assertEqual(len(same) if order else 0, len(content) if order else 0)
                    if order:
                        self.assertEqual(same, content)
                    head, tail = content.split(b"end_header\n")[0], content[-300:]
                    moved = Path("moved.ply").read_bytes()
                    self.assertTrue(moved.startswith(head) and (name == "plain" or moved.endswith(tail)))
                    again = read_surface("moved.ply")
                    np.testing.assert_allclose(again.points, 2 * surface.points)
                    np.testing.assert_array_equal(again.faces, FACES)

    @unittest.skipUnless(HAS_VTK, "needs vtk")
    def test_other_readers_find_the_written_points_and_faces(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOPLY import vtkPLYReader

        for name, elements in self.cases():
            # VTK divides vertices where corners have texture coordinates, and crashes at elements before
            # the vertices.
            for order in ("", "<", ">") if "camera" not in name and "corners" not in name else ():
                read_surface(self.write("a.ply", self.build(elements, order))).save("b.ply", 2 * POINTS)
                reader = vtkPLYReader()
                reader.SetFileName("b.ply")
                reader.Update()
                mesh = reader.GetOutput()
                with self.subTest(name, order=order):
                    np.testing.assert_allclose(vtk_to_numpy(mesh.GetPoints().GetData()), 2 * POINTS,
                                               atol=1e-5)
                    np.testing.assert_array_equal(
                        vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3), FACES)

    def test_faces_of_several_sizes(self):
        for order in ("", "<", ">"):
            elements = [("vertex", 5, [("float x", "f"), ("float y", "f"), ("float z", "f")],
                         [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]]),
                        ("face", 2, [("list uchar int vertex_indices", "Bi")],
                         [[[0, 1, 2, 3]], [[1, 4, 2]]])]
            surface = read_surface(self.write("a.ply", self.build(elements, order)))
            self.assertEqual(surface.faces, [[0, 1, 2, 3], [1, 4, 2]])

    def test_strips_of_triangles_have_one_orientation(self):
        points = [[i // 2, i % 2, 0] for i in range(6)]
        for order in ("", "<", ">"):
            elements = [("vertex", 6, [("float x", "f"), ("float y", "f"), ("float z", "f")], points),
                        ("tristrips", 1, [("list int int vertex_indices", "ii")],
                         [[[0, 2, 1, 3, -1, 2, 4, 3, 5]]])]
            surface = read_surface(self.write("a.ply", self.build(elements, order)))
            corners = np.asarray(points, float)[surface.faces]
            areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
            np.testing.assert_array_equal(areas, [1, 1, 1, 1])

    def test_data_are_written_in_place_and_twice_the_same(self):
        for order in ("", "<", ">"):
            elements = dict(self.cases())["colours before the coordinates"]
            data = read_data(self.write("a.ply", self.build(elements, order)))
            np.testing.assert_array_equal(data.parts[0].values, COLOURS)
            for name in ("b.ply", "c.ply"):
                data.save(name, [255 - COLOURS])
            self.assertEqual(Path("b.ply").read_bytes(), Path("c.ply").read_bytes())
            again = read_data("b.ply")
            self.assertEqual(again.names, ["red", "green", "blue"])
            np.testing.assert_array_equal(again.parts[0].values, 255 - COLOURS)
            self.assertEqual(b"format ascii" in Path("b.ply").read_bytes(), not order)

    def test_words_of_other_columns_stay_as_they_are(self):
        text = self.build(dict(self.cases())["colours before the coordinates"], "").decode()
        rows = text.split("\n")
        first = rows.index("end_header") + 1
        rows[first] = "1 2 3 0.10 1e1 -0.000"
        data = read_data(self.write("a.ply", "\n".join(rows)))
        data.save("b.ply", [np.full((N, 1), 7)], [1])
        self.assertEqual(Path("b.ply").read_text().split("\n")[first], "1 7 3 0.10 1e1 -0.000")

    def test_new_columns_come_after_the_others(self):
        for order in ("", "<", ">"):
            elements = dict(self.cases())["edges"]
            self.write("a.ply", self.build(elements, order))
            self.succeed("texture", "a.ply", 20, "b.ply")
            found = read_data("b.ply")
            self.assertEqual(found.names, ["Texture"])
            self.assertEqual(found.parts[0].values.max(), 1)
            np.testing.assert_array_equal(read_surface("b.ply").faces, FACES)
            self.assertIn("comment of edge", Path("b.ply").read_bytes().decode("latin-1"))

    def test_damaged_headers_are_one_line(self):
        good = self.build(dict(self.cases())["plain"], "<")
        for old, new, expected in (
                (b"element vertex 162", b"element vertex 999999999999", "ends within the element vertex"),
                (b"element face 320", b"element face 99999999999", "ends within the element face"),
                (b"element face 320", b"element face x", "allowed: element, its name and number"),
                (b"property float x", b"property half x", "allowed: property, its type and name"),
                (b"property float x", b"property float a", "the vertices have no property x"),
                (b"list uchar", b"list float", "the length of vertex_indices is float"),
                (b"binary_little_endian", b"binary", "allowed: ascii, binary_little_endian")):
            self.write("a.ply", good.replace(old, new))
            self.refused("a.ply: damaged PLY file: .*" + expected, "denoise-mesh", "a.ply", "b.ply")


class GIFTI(FormatTest):
    def external(self, name, other):
        """A surface and a map whose arrays are in the file `other`, as CAT writes them."""
        arrays, offset, body = [], 0, b""
        for values, intent, kind in ((POINTS.astype("<f4"), "NIFTI_INTENT_POINTSET", "FLOAT32"),
                                     (FACES.astype("<i4"), "NIFTI_INTENT_TRIANGLE", "INT32"),
                                     (NOISE.astype("<f4"), "NIFTI_INTENT_SHAPE", "FLOAT32")):
            sizes = " ".join(f'Dim{i}="{n}"' for i, n in enumerate(values.shape))
            arrays.append(
                f'<DataArray Intent="{intent}" DataType="NIFTI_TYPE_{kind}" '
                f'ArrayIndexingOrder="RowMajorOrder" Dimensionality="{values.ndim}" {sizes} '
                'Encoding="ExternalFileBinary" Endian="LittleEndian" '
                f'ExternalFileName="{other}" ExternalFileOffset="{offset}"><Data></Data></DataArray>')
            body += values.tobytes()
            offset = len(body)
        self.write(name, '<?xml version="1.0"?>\n<GIFTI Version="1.0" NumberOfDataArrays="3">'
                   + "".join(arrays) + "</GIFTI>\n")
        return body

    @unittest.skipIf("libasan" in os.environ.get("LD_PRELOAD", ""), "the sanitizer keeps freed memory")
    def test_many_maps_are_in_memory_twice_at_most(self):
        values = np.random.default_rng(2).normal(size=(2562, 5000)).astype(np.float32)
        samples.write_surface("a.surf.gii", *samples.sphere(4))
        for name, columns in (("one", values.T[:1]), ("a", values.T)):
            samples.write_gifti(f"{name}.func.gii", {f"map {i}": column for i, column in enumerate(columns)})
        code = ("import resource; from surfacediffusion.command import main, stages\n"
                "stages.PANEL = 1 << 18; peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n"
                "run = lambda name: main(['smooth', 'a.surf.gii', name, '10', 'b.func.gii', '--quiet'])\n"
                "run('one.func.gii'); before = peak(); run('a.func.gii'); print(peak() - before)")
        done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
        self.assertLess(1024 * int(done.stdout), 2.0 * values.nbytes)
        data = read_data("a.func.gii")
        np.testing.assert_array_equal(data.parts[0].values, values)
        data.save("b.func.gii", [values])
        self.assertEqual(Path("a.func.gii").read_bytes(), Path("b.func.gii").read_bytes())

    def test_data_in_a_file_beside_it(self):
        for folder in (".", "sub"):
            Path(folder).mkdir(exist_ok=True)
            body = self.external(f"{folder}/a.gii", "a.dat")
            self.write(f"{folder}/a.dat", body)
            surface, data = read_surface(f"{folder}/a.gii"), read_data(f"{folder}/a.gii")
            np.testing.assert_array_equal(surface.points, POINTS.astype(np.float32))
            np.testing.assert_array_equal(surface.faces, FACES)
            np.testing.assert_array_equal(data.parts[0].values[:, 0], NOISE)
        surface.save("b.gii", 2 * surface.points)
        self.succeed("smooth", "b.gii", "a.gii", 10, "c.gii")
        os.unlink("a.dat")
        self.write("a.dat", b"short")
        np.testing.assert_array_equal(read_surface("b.gii").points, 2 * surface.points)
        self.assertEqual(len(read_data("c.gii").parts[0].values), N)
        self.refused("a.gii: damaged GIFTI file", "info", "a.gii")
        os.unlink("a.dat")
        self.refused("a.gii: there is no file a.dat with its data in the same folder", "info", "a.gii")

    def test_files_of_other_folders_are_not_read(self):
        for other in ("/etc/passwd", "../a.dat", "sub/a.dat"):
            self.external("a.gii", other)
            self.refused(f"a.gii: data in the file {other}; allowed: in the folder", "info", "a.gii")

    def test_a_long_comment_or_a_byte_order_mark_may_come_first(self):
        samples.write_surface("a.surf.gii")
        text = Path("a.surf.gii").read_bytes()
        start = text.index(b"<GIFTI")
        comment = b"<!-- " + b"x" * 10000 + b" <VTKFile> -->\n"
        for content in (b"\xef\xbb\xbf" + text, text[:start] + comment + text[start:]):
            surface = read_surface(self.write("b.gii", content))
            np.testing.assert_array_equal(surface.faces, FACES)


class Text(FormatTest):
    def check(self, path):
        surface = read_surface(path)
        np.testing.assert_allclose(surface.points, POINTS)
        np.testing.assert_array_equal(surface.faces, FACES)
        kind = surface.kind
        surface.save("moved." + kind, surface.points * 2)
        again = read_surface("moved." + kind)
        np.testing.assert_allclose(again.points, 2 * POINTS)
        np.testing.assert_array_equal(again.faces, FACES)
        return Path("moved." + kind).read_bytes()

    def test_utf_8_is_kept(self):
        word = "made in Ålesund \x85 \x0b\x0c\x1c\u2028 by Å"
        text = samples.off_text().replace("a comment", word)
        self.assertIn(word.encode(), self.check(self.write("a.off", text)))
        text = samples.obj_text().replace("a comment", word).replace("vt 0 0", f"g {word}\nvt 0 0")
        self.assertEqual(self.check(self.write("a.obj", text)).count(word.encode()), 2)
        samples.write_label("a.label", [3, 7], [1, 2])
        label = Path("a.label").read_text().replace("test", word)
        data = read_data(self.write("a.label", label))
        data.save("b.label", [data.parts[0].values + 1])
        self.assertIn(word.encode(), Path("b.label").read_bytes())
        np.testing.assert_array_equal(read_data("b.label").parts[0].values[:, 0], [2, 3])

    def test_obj_with_a_long_comment(self):
        text = "# " + "made by a scanner " * 10 + "\n"
        self.check(self.write("a.obj", text * 100 + samples.obj_text()))

    def test_obj_with_groups_and_continued_lines(self):
        lines = samples.obj_text().splitlines()
        lines.insert(1, "# C:\\scans\\")  # a comment does not go on
        lines = [line.replace(" ", " \\\n  ", 2) if i % 7 == 2 else line
                 for i, line in enumerate(lines)]
        lines[100:100] = ["g one two", "usemtl skin", "s 1", "o part", ""]
        for end in ("\n", "\r\n"):
            found = self.check(self.write("a.obj", end.join(lines).replace("\n  ", end + "  ") + end))
            self.assertIn(b"usemtl skin", found)

    def off(self, words, lines):
        return self.write("a.off", words + "\n" + "\n".join(lines) + "\n")

    def test_off_with_several_vertices_in_a_line_and_faces_over_lines(self):
        flat = [f"{v!r}" for v in POINTS.ravel().tolist()]
        vertices = [" ".join(flat[i:i + 12]) for i in range(0, len(flat), 12)]
        faces = [f"3 {a}\n{b} {c}" for a, b, c in FACES.tolist()]
        self.check(self.off(f"OFF {N} {len(FACES)} 0", vertices + faces))
        coloured = [" ".join(flat[i:i + 3] + ["1 0 0 1"]) for i in range(0, len(flat), 3)]
        self.check(self.off(f"COFF\n{N} {len(FACES)} 0", [" ".join(coloured[:9])] + coloured[9:]
                            + [face + " 255 0 0" for face in faces]))

    def test_off_with_the_counts_at_its_name(self):
        text = samples.off_text().replace("OFF # a comment\n", "OFF")
        self.assertRegex(text, r"^OFF162 ")
        self.check(self.write("a.off", text))

    def test_vertices_without_the_announced_normals_are_refused(self):
        self.refused("a.off: damaged OFF file: a vertex does not have three coordinates, or a normal",
                     "denoise-mesh", self.write("a.off", samples.off_text().replace("OFF", "NOFF")), "b.off")
        self.refused("a.off: damaged OFF file: a vertex does not have three coordinates", "info",
                     self.write("a.off", "OFF\n3 1 0\n0 0\n1 0\n0 1\n3 0 1 2\n"))

    def test_off_of_other_dimensions_is_refused_by_name(self):
        for name in ("4OFF", "nOFF", "STCN4OFF", "4nOFF"):
            self.refused(f"{name}: vertices with other than three coordinates; allowed: OFF", "info",
                         self.write("a.off", samples.off_text().replace("OFF", name)))
        for name in ("COFF", "NOFF", "STOFF", "CNOFF"):
            extra = {"COFF": " 1 0 0 1", "NOFF": " 0 0 1", "STOFF": " 0 1"}.get(name, " 0 0 1 1 1 1 1")
            lines = samples.off_text().replace("OFF # a comment", name).splitlines()
            lines[2:N + 2] = [line + extra for line in lines[2:N + 2]]
            self.check(self.write("a.off", "\n".join(lines) + "\n"))


class Atlases(FormatTest):
    """--roi takes one label of an atlas."""

    def setUp(self):
        super().setUp()
        self.labels = np.where(POINTS[:, 2] > 5, 2, np.where(POINTS[:, 2] > -6, 1, 0))
        names = ["unknown", "precentral", "Ålesund:1"]
        samples.write_surface("lh.white")
        samples.write_curv("lh.thickness", NOISE)
        samples.write_annot("lh.aparc.annot", self.labels, names)
        image = gifti.GiftiImage(darrays=[gifti.GiftiDataArray(
            self.labels.astype(np.int32), "NIFTI_INTENT_LABEL", "NIFTI_TYPE_INT32")])
        for key, name in enumerate(names):
            label = gifti.GiftiLabel(key)
            label.label = name
            image.labeltable.labels.append(label)
        nib.save(image, "a.label.gii")
        samples.write_curv("one.roi", self.labels == 1)

    def smooth(self, roi, out):
        self.succeed("smooth", "lh.white", "lh.thickness", 5, out, "--roi", roi)
        return Path(out).read_bytes()

    def test_by_name_and_by_number(self):
        expected = self.smooth("one.roi", "lh.a")
        self.assertTrue((read_data("lh.a").parts[0].values[self.labels != 1] == 0).all())
        for roi in ("lh.aparc.annot:precentral", "lh.aparc.annot:1", "a.label.gii:precentral",
                    "a.label.gii:1"):
            self.assertEqual(self.smooth(roi, "lh.b"), expected)
        self.assertNotEqual(self.smooth("a.label.gii:2", "lh.b"), expected)
        self.assertEqual(self.smooth("a.label.gii:Ålesund:1", "lh.b"),
                         self.smooth("a.label.gii:2", "lh.c"))

    def test_an_atlas_of_cifti(self):
        from nibabel import cifti2

        models = (cifti2.BrainModelAxis.from_surface(np.arange(N), N, "CORTEX_LEFT")
                  + cifti2.BrainModelAxis.from_surface(np.arange(N), N, "CORTEX_RIGHT"))
        axis = cifti2.LabelAxis(["map"], [{0: ("none", (0, 0, 0, 0)), 1: ("one", (1, 0, 0, 1)),
                                          2: ("two", (0, 1, 0, 1))}])
        nib.save(cifti2.Cifti2Image(np.tile(self.labels, 2)[None].astype(np.float32),
                                    cifti2.Cifti2Header.from_axes((axis, models))), "a.dlabel.nii")
        samples.write_surface("l.gii")
        samples.write_surface("r.gii", structure="CortexRight")
        samples.write_cifti("a.dscalar.nii", [np.tile(NOISE, 2)])
        self.succeed("smooth", "a.dscalar.nii", 5, "b.dscalar.nii", "--left", "l.gii", "--right",
                     "r.gii", "--roi", "a.dlabel.nii:one")
        found = read_data("b.dscalar.nii").parts[1].values[:, 0]
        np.testing.assert_array_equal(found != 0, self.labels == 1)

    def test_unknown_labels_are_listed(self):
        command = ["smooth", "lh.white", "lh.thickness", 5, "lh.out", "--roi"]
        listed = "allowed: .*0 unknown, 1 precentral, 2"
        self.refused("no label 'postcentral'; " + listed, *command, "lh.aparc.annot:postcentral")
        self.refused("an atlas without a label; " + listed, *command, "lh.aparc.annot")
        self.refused("no label '9'", *command, "a.label.gii:9")
        self.refused("values, which have no label 'a'; allowed: an atlas", *command, "one.roi:a")
        self.refused("labels, which have no mean", "smooth", "lh.white", "lh.aparc.annot", 5, "lh.out")
        with self.assertRaisesRegex(FileError, "a.npy: values cannot be written as FreeSurfer annot"):
            read_data("lh.aparc.annot").save("a.npy", [NOISE[:, None]])

    def test_a_name_may_hold_a_colon_and_a_file_as_well(self):
        os.rename("a.label.gii", "a:b.label.gii")
        samples.write_curv("c:d", self.labels == 1)
        self.assertEqual(self.smooth("a:b.label.gii:1", "lh.a"), self.smooth("c:d", "lh.b"))


class Volumes(FormatTest):
    """One voxel per vertex, as FS-FAST writes overlays."""

    def test_nifti_of_one_and_several_columns(self):
        samples.write_surface("lh.white")
        both = np.column_stack([NOISE, SMOOTH])
        for name, values, shape in (("a.nii.gz", NOISE, (N, 1, 1)), ("a.nii", both, (N, 1, 1, 2)),
                                    ("b.nii.gz", NOISE, (N // 6, 1, 6))):
            write_nifti(name, values, shape)
            found = read_data(name)
            np.testing.assert_array_equal(found.parts[0].values, np.reshape(values, (N, -1)))
            self.succeed("smooth", "lh.white", name, 5, "out." + name)
            np.save("a.npy", values)
            self.succeed("smooth", "lh.white", "a.npy", 5, "out.npy")
            self.assertEqual(nib.load("out." + name).shape, shape)
            np.testing.assert_array_equal(read_data("out." + name).parts[0].values,
                                          np.load("out.npy").reshape(N, -1))

    def test_scaled_integers(self):
        image = nib.Nifti1Image(np.arange(N, dtype=np.int16).reshape(N, 1, 1), np.eye(4))
        image.header.set_slope_inter(0.5, 10)
        nib.save(image, "a.nii.gz")
        values = np.asarray(nib.load("a.nii.gz").dataobj).ravel()
        data = read_data("a.nii.gz")
        np.testing.assert_allclose(data.parts[0].values[:, 0], values)
        data.save("b.nii.gz", [data.parts[0].values + 0.25])
        np.testing.assert_allclose(nib.load("b.nii.gz").get_fdata().ravel(), values + 0.25)

    def test_more_vertices_than_a_short_integer_holds(self):
        values = np.arange(40000, dtype=np.float32)
        for name, shape in (("a.nii.gz", (40000, 1, 1)), ("b.nii.gz", (20000, 1, 2))):
            write_nifti(name, values, shape)
            data = read_data(name)
            np.testing.assert_array_equal(data.parts[0].values[:, 0], values)
            data.save("c.nii.gz", [data.parts[0].values])
            np.testing.assert_array_equal(read_data("c.nii.gz").parts[0].values[:, 0], values)

    def test_mgh_divided_by_a_factor(self):
        nib.save(nib.freesurfer.MGHImage(NOISE.reshape((N // 6, 1, 6), order="F"), np.eye(4)), "a.mgz")
        np.testing.assert_array_equal(read_data("a.mgz").parts[0].values[:, 0], NOISE)

    def test_volumes_are_refused(self):
        nib.save(nib.Nifti2Image(np.zeros((3, 4, 5)), np.eye(4)), "v.nii")
        self.refused("v.nii: a volume of 3 x 4 x 5 voxels; allowed: n x 1 x 1", "info", "v.nii")


if __name__ == "__main__":
    unittest.main()
