# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of every format: they are read as written, and the output has the format and the metadata
of the input."""

import gzip
import os
import stat
import tempfile
import unittest
from pathlib import Path

import numpy as np
import samples
from samples import COLOURS, FACES, HAS_VTK, N, NOISE, POINTS, SMOOTH, freesurfer, nib

from surfacediffusion.files import FileError, new_data, read_data, read_surface


class FileTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def path(self, name, content=None):
        path = self.folder / name
        if content is not None:
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path


class Surfaces(FileTest):
    def check(self, path, kind, tolerance=1e-5):
        """Read, and read again after the points were moved and saved."""
        surface = read_surface(path)
        self.assertEqual(surface.kind, kind)
        np.testing.assert_allclose(surface.points, POINTS, atol=tolerance)
        np.testing.assert_array_equal(surface.faces, FACES)
        saved = self.folder / ("moved" + "".join(Path(path).suffixes))
        surface.save(saved, surface.points * 2)
        again = read_surface(saved)
        self.assertEqual(again.kind, kind)
        np.testing.assert_allclose(again.points, 2 * POINTS, atol=2 * tolerance)
        np.testing.assert_array_equal(again.faces, FACES)
        return surface, saved

    def test_gifti_surfaces_keep_their_structure(self):
        for name in ("a.surf.gii", "a.surf.gii.gz"):
            surface, saved = self.check(samples.write_surface(self.path(name)), "gifti")
            self.assertEqual(surface.structure, "CortexLeft")
            self.assertEqual(read_surface(saved).structure, "CortexLeft")
            self.assertEqual(saved.read_bytes()[:2] == b"\x1f\x8b", name.endswith(".gz"))

    def test_freesurfer_surfaces_have_the_structure_of_their_name(self):
        surface, _ = self.check(samples.write_surface(self.path("rh.white")), "freesurfer")
        self.assertEqual(surface.structure, "CortexRight")

    def test_off_and_obj_keep_everything_but_coordinates(self):
        for kind, text in (("off", samples.off_text()), ("obj", samples.obj_text())):
            _, saved = self.check(self.path(f"a.{kind}", text), kind, 0)
            # The normal of all corners belongs to no vertex: see Normals in TestFormats.py.
            before = text.replace("vn 0 0 1\n", "").replace("/1/1", "/1").splitlines()
            after = saved.read_text().splitlines()
            self.assertEqual(len(before), len(after))
            self.assertEqual(before[0], after[0])
            self.assertEqual(before[-len(FACES):], after[-len(FACES):])

    def test_off_with_counts_on_the_first_line_and_polygons(self):
        text = "OFF 5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n4 0 1 2 3\n3 1 4 2\n"
        surface = read_surface(self.path("a.off", text))
        self.assertEqual(surface.faces, [[0, 1, 2, 3], [1, 4, 2]])

    def test_obj_with_negative_numbers_and_colours(self):
        text = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf -3 -2 -1\n"
        surface = read_surface(self.path("a.obj", text))
        np.testing.assert_array_equal(surface.faces, [[0, 1, 2]])

    def test_ply_of_both_encodings_and_both_names_of_the_faces(self):
        for binary in (True, False):
            for name in ("vertex_indices", "vertex_index"):
                self.check(self.path("a.ply", samples.ply_bytes(binary, name)), "ply")

    def test_stl(self):
        path = self.path("a.stl", samples.stl_bytes())
        surface = read_surface(path)
        self.assertEqual((len(surface.points), len(surface.faces)), (N, len(FACES)))
        surface.save(self.path("moved.stl"), 2 * surface.points)
        again = read_surface(self.path("moved.stl"))
        np.testing.assert_allclose(again.points[again.faces], 2 * surface.points[surface.faces])

    @unittest.skipUnless(HAS_VTK, "needs vtk")
    def test_vtk_legacy_and_xml(self):
        for kind in ("vtk", "vtp"):
            self.check(samples.write_vtk(self.path(f"a.{kind}")), kind, 1e-12)

    def test_the_content_counts_and_not_the_name(self):
        path = self.path("surface.txt", samples.off_text())
        self.assertEqual(read_surface(path).kind, "off")
        samples.write_surface(self.path("b.surf.gii"))
        self.path("b.surf.gii").rename(self.path("c.dat"))
        self.assertEqual(read_surface(self.path("c.dat")).kind, "gifti")


class DataFiles(FileTest):
    def check(self, path, kind, columns, name=None):
        """Read and save without and with a choice of columns."""
        data = read_data(path)
        self.assertEqual(data.kind, kind)
        np.testing.assert_array_equal(data.parts[0].values, np.column_stack(columns))
        saved = self.folder / (name or "saved" + "".join(Path(path).suffixes))
        data.save(saved, [part.values + 1 for part in data.parts])
        again = read_data(saved)
        np.testing.assert_array_equal(again.parts[0].values, data.parts[0].values + 1)
        self.assertEqual(again.names, data.names)
        return data, saved

    def test_gifti_keeps_metadata_and_names(self):
        for name in ("a.func.gii", "a.shape.gii", "a.func.gii.gz"):
            path = samples.write_gifti(self.path(name), {"one": SMOOTH, "two": NOISE})
            data, saved = self.check(path, "gifti", [SMOOTH, NOISE])
            self.assertEqual(data.parts[0].structure, "CortexLeft")
            before, after = nib.load(path), nib.load(saved)
            self.assertEqual(dict(before.meta), dict(after.meta))
            for a, b in zip(before.darrays, after.darrays):
                self.assertEqual((dict(a.meta), a.intent), (dict(b.meta), b.intent))

    def test_chosen_columns_alone_are_written(self):
        path = samples.write_gifti(self.path("a.func.gii"), {"one": SMOOTH, "two": NOISE})
        data = read_data(path)
        data.save(self.path("b.func.gii"), [NOISE[:, None]], [1])
        again = read_data(self.path("b.func.gii"))
        self.assertEqual(again.names, ["two"])
        np.testing.assert_array_equal(again.parts[0].values[:, 0], NOISE)

    def test_gifti_array_of_two_dimensions(self):
        values = np.column_stack([SMOOTH, NOISE])
        path = samples.write_gifti(self.path("a.func.gii"), {"both": values})
        _, saved = self.check(path, "gifti", [SMOOTH, NOISE])
        self.assertEqual(nib.load(saved).darrays[0].data.shape, (N, 2))

    def test_labels_are_recognised(self):
        path = samples.write_gifti(self.path("a.label.gii"), {"areas": np.arange(N)},
                                   intent="NIFTI_INTENT_LABEL")
        self.assertTrue(read_data(path).labels)

    def test_curv(self):
        path = samples.write_curv(self.path("lh.thickness"))
        _, saved = self.check(path, "curv", [SMOOTH], "lh.saved")
        self.assertEqual(saved.read_bytes()[:11], path.read_bytes()[:11])
        np.testing.assert_array_equal(freesurfer.read_morph_data(str(saved)), SMOOTH + 1)

    def test_mgh_and_mgz_keep_their_affine(self):
        for name in ("a.mgh", "a.mgz"):
            path = samples.write_mgh(self.path(name), np.column_stack([SMOOTH, NOISE]))
            _, saved = self.check(path, "mgh", [SMOOTH, NOISE])
            np.testing.assert_array_equal(nib.load(path).affine, nib.load(saved).affine)
            self.assertEqual(nib.load(saved).shape, (N, 1, 1, 2))

    def test_freesurfer_labels_keep_vertices_and_coordinates(self):
        path = samples.write_label(self.path("a.label"), [3, 7, 5], [0.5, 1.5, 2.5])
        data, saved = self.check(path, "label", [[0.5, 1.5, 2.5]])
        np.testing.assert_array_equal(data.parts[0].vertices, [3, 7, 5])
        self.assertEqual(saved.read_text().splitlines()[3].split()[:4],
                         path.read_text().splitlines()[3].split()[:4])

    def test_npy_keeps_shape_and_type(self):
        for values in (SMOOTH, np.column_stack([SMOOTH, NOISE]).astype(float)):
            np.save(self.path("a.npy"), values)
            _, saved = self.check(self.path("a.npy"), "npy", values.reshape(N, -1).T)
            self.assertEqual((np.load(saved).shape, np.load(saved).dtype),
                             (values.shape, values.dtype))

    def test_ply_colours_are_rounded_and_other_properties_kept(self):
        for binary in (True, False):
            path = self.path("a.ply", samples.ply_bytes(binary))
            data = read_data(path)
            self.assertEqual(data.names, ["red", "green", "blue", "quality"])
            np.testing.assert_array_equal(data.parts[0].values[:, :3], COLOURS)
            data.save(self.path("b.ply"), [COLOURS[:, :1] + 300.4], [0])
            again = read_data(self.path("b.ply")).parts[0].values
            np.testing.assert_array_equal(again[:, 0], 255)
            np.testing.assert_array_equal(again[:, 1:3], COLOURS[:, 1:])
            np.testing.assert_array_equal(again[:, 3], SMOOTH)
            np.testing.assert_array_equal(read_surface(self.path("b.ply")).faces, FACES)

    @unittest.skipUnless(HAS_VTK, "needs vtk")
    def test_vtk_arrays_of_several_components(self):
        for kind in ("vtk", "vtp"):
            arrays = {"f": NOISE, "rgb": COLOURS}
            path = samples.write_vtk(self.path(f"a.{kind}"), arrays=arrays)
            data = read_data(path)
            self.assertEqual(data.names, ["f", "rgb", "rgb", "rgb"])
            data.save(self.path(f"b.{kind}"), [np.zeros((N, 1))], [2])
            again = read_data(self.path(f"b.{kind}")).parts[0].values
            np.testing.assert_array_equal(again[:, 0], NOISE)
            np.testing.assert_array_equal(again[:, 1], COLOURS[:, 0])
            np.testing.assert_array_equal(again[:, 2], 0)

    def test_cifti_has_a_part_per_surface_and_copies_voxels(self):
        left = np.arange(10, N)
        rows = np.random.default_rng(3).normal(size=(2, N - 10 + N + 7)).astype(np.float32)
        for name, series in (("a.dscalar.nii", False), ("a.dtseries.nii", True)):
            path = samples.write_cifti(self.path(name), rows, series, 7, left)
            data = read_data(path)
            self.assertEqual([part.structure for part in data.parts],
                             ["CortexLeft", "CortexRight"])
            self.assertEqual([part.size for part in data.parts], [N, N])
            np.testing.assert_array_equal(data.parts[0].vertices, left)
            self.assertIn("7 voxels", data.extra)
            saved = self.path("saved." + name)
            data.save(saved, [part.values * 2 for part in data.parts])
            before, after = nib.load(path), nib.load(saved)
            factors = np.where(np.arange(rows.shape[1]) < rows.shape[1] - 7, 2, 1)
            np.testing.assert_array_equal(np.asarray(after.dataobj), rows * factors)
            for axis in (0, 1):
                self.assertEqual(before.header.get_axis(axis), after.header.get_axis(axis))
            self.assertEqual(dict(after.header.matrix.metadata), {"Study": "test"})

    def test_single_columns_of_cifti_keep_their_palette(self):
        rows = np.arange(4 * N, dtype=np.float32).reshape(2, 2 * N)
        data = read_data(samples.write_cifti(self.path("a.dscalar.nii"), rows))
        data.save(self.path("b.dscalar.nii"), [part.values[:, 1:] for part in data.parts], [1])
        axis = nib.load(self.path("b.dscalar.nii")).header.get_axis(0)
        self.assertEqual((list(axis.name), axis.meta[0]), (["map 1"], {"Palette": "palette 1"}))

    def test_columns_of_a_time_series_at_equal_intervals_keep_their_times(self):
        rows = np.arange(12 * N, dtype=np.float32).reshape(6, 2 * N)
        data = read_data(samples.write_cifti(self.path("a.dtseries.nii"), rows, series=True))
        for columns, start, step in (([1], 0.72, 0.72), ([1, 3, 5], 0.72, 1.44),
                                     ([2, 3], 1.44, 0.72)):
            data.save(self.path("b.dtseries.nii"),
                      [part.values[:, columns] for part in data.parts], columns)
            image = nib.load(self.path("b.dtseries.nii"))
            axis = image.header.get_axis(0)
            self.assertEqual((len(axis), axis.unit), (len(columns), "SECOND"))
            np.testing.assert_allclose([axis.start, axis.step], [start, step], rtol=1e-12)
            np.testing.assert_array_equal(np.asarray(image.dataobj), rows[columns])

    def test_new_columns_have_the_format_of_the_name(self):
        surface = read_surface(samples.write_surface(self.path("lh.surf.gii")))
        for name, kind in (("a.func.gii", "gifti"), ("a.mgz", "mgh"), ("a.npy", "npy")):
            new_data(surface, self.path(name), ["u"]).save(
                self.path(name), [SMOOTH[:, None]])
            again = read_data(self.path(name))
            self.assertEqual(again.kind, kind)
            np.testing.assert_array_equal(again.parts[0].values[:, 0], SMOOTH)
        self.assertEqual(read_data(self.path("a.func.gii")).parts[0].structure, "CortexLeft")
        with self.assertRaisesRegex(FileError, "a.off: the name announces no format"):
            new_data(surface, self.path("a.off"), ["u"])


class Writing(FileTest):
    def test_an_output_is_replaced_with_its_permissions_and_nothing_is_left(self):
        path = samples.write_curv(self.path("lh.curv"))
        os.chmod(path, 0o640)
        read_data(path).save(path, [NOISE[:, None]])
        self.assertEqual(stat.S_IMODE(path.stat().st_mode), 0o640)
        self.assertEqual(os.listdir(self.folder), ["lh.curv"])

    def test_links_are_followed(self):
        path = samples.write_curv(self.path("lh.curv"))
        self.path("link").symlink_to(path)
        read_data(path).save(self.path("link"), [NOISE[:, None]])
        self.assertTrue(self.path("link").is_symlink())
        np.testing.assert_array_equal(read_data(path).parts[0].values[:, 0], NOISE)

    def test_compression_follows_the_name(self):
        data = read_data(samples.write_gifti(self.path("a.func.gii"), {"one": SMOOTH}))
        data.save(self.path("b.func.gii.gz"), [SMOOTH[:, None]])
        self.assertIn(b"<GIFTI", gzip.decompress(self.path("b.func.gii.gz").read_bytes()))


if __name__ == "__main__":
    unittest.main(verbosity=2)
