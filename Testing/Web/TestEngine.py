# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The engine of the page in node: every model with the numbers of numpy, and every format of files as
Python reads it. Argument: engine.js."""
import gzip
import io
import json
import sys
import tempfile
import unittest
import warnings
import zipfile
from pathlib import Path

import nibabel
import numpy as np
import pyvista
import surfacediffusion.pyvista as functions
from engine import Engine, EngineError
from surfacediffusion import geodesic_path, sphere
from surfacediffusion.files import read_data, read_surface

SCRIPT = sys.argv.pop()


def make_mesh():
    """A sphere that is no sphere, with data."""
    ball = sphere(3, radius=10.0)
    points = ball.points * (1.0 + 0.2 * ball.points[:, :1] / 10.0) * [1.0, 1.2, 0.8]
    mesh = pyvista.PolyData.from_regular_faces(points, ball.triangles)
    random = np.random.default_rng(1)
    x = points / 10.0
    mesh["noisy"] = np.sign(x[:, 2]) + 0.1 * random.normal(size=len(x))
    mesh["smooth"] = np.sin(2.0 * x[:, 0]) + x[:, 1] ** 2
    mesh["vectors"] = x
    known = mesh["smooth"].copy()
    known[random.random(len(x)) < 0.7] = np.nan
    mesh["known"] = known
    mesh["mask"] = (x[:, 0] > 0.9).astype(float)
    mesh["fixed"] = (x[:, 1] > 1.0).astype(float)
    mesh["factors"] = 0.5 + random.random(len(x))
    mesh["marks"] = np.zeros(len(x))
    mesh["marks"][[3, 500]] = 1.0
    mesh["labels"] = np.zeros(len(x))
    mesh["labels"][[3, 500]] = 1, 2
    mesh["level"] = 0.5 + 0.5 * np.sin(3.0 * x[:, 0])
    mesh.cell_data["of_cells"] = random.normal(size=mesh.n_cells)
    return mesh


#: Model: the data, the arguments, and how far numbers may be from those of numpy, times their largest.
#: Minimisers stop at their tolerance, and textures amplify the last bit.
CASES = [
    ("heat", "noisy", {"fwhm": 3.0}, 1e-9),
    ("heat", "of_cells", {"fwhm": 3.0, "number_of_time_steps": 2}, 1e-9),
    ("heat", "known", {"fwhm": 3.0, "mask": "mask"}, 1e-9),
    ("heat", "noisy", {"fwhm": 3.0, "fixed": "fixed"}, 1e-9),
    ("heat", "noisy", {"mode": "SteadyState", "fidelity": "factors"}, 1e-7),
    ("heat", "noisy", {"fwhm": 3.0, "roi": "mask"}, 1e-9),
    ("curvature", None, {}, 1e-9),
    ("denoise_mesh", None, {"fixed": "fixed"}, 1e-6),
    ("derivatives", "smooth", {}, 1e-9),
    ("derivatives", "vectors", {"quantity": "divergence"}, 1e-9),
    ("derivatives", "smooth", {"quantity": "conduction_velocity", "error": "factors"}, 1e-9),
    ("direction_field", None, {}, 1e-6),
    ("distance", "marks", {}, 1e-9),
    ("distance", "marks", {"method": "heat"}, 1e-9),
    ("harmonic_map", None, {}, 1e-6),
    ("harmonic_map", "vectors", {"mask": "mask"}, 1e-6),
    ("intrinsic_tv", "noisy", {}, 1e-6),
    ("mumford_shah", "noisy", {}, 1e-5),
    ("interpolate", "known", {}, 1e-9),
    ("random_field", None, {"fwhm": 3.0, "seed": 7}, 1e-7),
    ("relief", "level", {"height": 0.3}, 1e-9),
    ("segment", "noisy", {}, 1e-5),
    ("segment", "noisy", {"seeds": "labels", "mask": "mask"}, 1e-5),
    ("segment", "noisy", {"means": [-1.0, 1.0]}, 1e-5),
    ("intrinsic_tv", "noisy", {"mode": "steady_state", "fidelity_weight": 3.0}, 1e-5),
    ("tensor_diffusion", "noisy", {"number_of_time_steps": 4}, 1e-6),
    ("turing_texture", None, {"number_of_time_steps": 40}, 1e-6),
    ("turing_texture", None, {"number_of_time_steps": 10, "feature_size": 5.0}, 1e-6),
    ("heat", "noisy", {"fwhm": 3.0, "refine_to": 1.2, "mask": "mask"}, 1e-9),
    ("heat", "of_cells", {"fwhm": 3.0, "refine_to": 1.2}, 1e-9),
    ("distance", "marks", {"refine_to": 1.2}, 1e-9),
    ("relief", "level", {"height": 0.3, "refine_to": 1.5}, 1e-9),
]


def call_of_numpy(model, mesh, data, given):
    """The mesh that the function for PyVista returns."""
    given = dict(given)
    names = {"sources": "array"} if model == "distance" else {}
    arguments = {names.get(word, word): value for word, value in given.items()}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        function = getattr(functions, model)
        return function(mesh, **arguments) if data is None else function(mesh, data, **arguments)


class EngineTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.engine = Engine(SCRIPT)
        cls.mesh = make_mesh()
        cls.content = bytes_of(cls.mesh, "surface.vtp")

    @classmethod
    def tearDownClass(cls):
        cls.engine.close()

    def open_mesh(self):
        return self.engine.open("surface.vtp", self.content)


class Models(EngineTest):
    def test_every_model_has_the_numbers_of_numpy(self):
        self.open_mesh()
        self.assertEqual({model for model, *_ in CASES}, set(self.engine.describe()))
        for model, data, given, tolerance in CASES:
            with self.subTest(model=model, data=data, **given):
                expected = call_of_numpy(model, self.mesh, data, given)
                found = self.engine.run(model, array=data, **given)
                self.assertTrue(found["arrays"])
                for entry in found["arrays"]:
                    of_place = expected.point_data if entry["association"] == "point" else expected.cell_data
                    self.assertIn(entry["name"], of_place.keys())
                    wanted = np.asarray(of_place[entry["name"]], float).reshape(-1, entry["components"])
                    values = self.engine.result(entry)
                    if model == "direction_field":  # of no sign
                        wanted = wanted * np.sign((values * wanted).sum(axis=1, keepdims=True))
                    self.check_close(values, wanted, tolerance, entry["name"])
                self.assertEqual(found["refined"], expected.n_cells != self.mesh.n_cells)
                if found["points"]:
                    moved = self.engine.call("resultPoints").reshape(-1, 3)
                    self.check_close(moved, np.asarray(expected.points), max(tolerance, 1e-7), "points")

    def check_close(self, found, wanted, tolerance, name):
        self.assertEqual(found.shape, wanted.shape, name)
        np.testing.assert_array_equal(np.isfinite(found), np.isfinite(wanted), name)
        finite = np.isfinite(wanted)
        scale = np.abs(wanted[finite]).max(initial=1e-30)
        self.assertLessEqual(np.abs(found - wanted)[finite].max(initial=0.0) / scale, tolerance, name)

    def test_settings_are_those_of_numpy(self):
        from surfacediffusion._settings import settings_of
        for name, model in self.engine.describe().items():
            known = settings_of(name)
            *settings, length, limit = model["settings"]
            self.assertEqual([length["name"], limit["name"]], ["refine_to", "maximum_number_of_triangles"])
            self.assertEqual([setting["name"] for setting in settings], list(known))
            for setting in settings:
                self.assertEqual(setting["property"], known[setting["name"]].name)
                self.assertEqual(setting["default"], known[setting["name"]].default)
                self.assertEqual(setting["unit"], known[setting["name"]].unit)

    def test_points_are_sources_seeds_and_values(self):
        self.open_mesh()
        self.engine.run("distance", sources=[3, 500])
        chosen = self.engine.call("resultArray", "Distance")
        self.engine.run("distance", array="marks")
        np.testing.assert_allclose(chosen, self.engine.call("resultArray", "Distance"), atol=1e-12)
        paths = self.engine.run("distance", sources=[500], path_points=[80, 3])["paths"]
        written = read_vtp(self.engine.call("writePaths", "p.vtp").tobytes())
        for row, start in enumerate((80, 3)):
            expected = geodesic_path((self.mesh.points, self.mesh.regular_faces), start, 500)
            self.assertEqual(paths[row]["start"], row)
            self.assertAlmostEqual(paths[row]["length"], expected.length, delta=1e-9)
            np.testing.assert_allclose(np.reshape(paths[row]["points"], (-1, 3)), expected.points, atol=1e-9)
            np.testing.assert_allclose(written.get_cell(row).points, expected.points, atol=1e-9)
        np.testing.assert_array_equal(written["Length"], [path["length"] for path in paths])
        self.assertEqual(self.engine.run("distance", sources=[500])["paths"], [])
        self.engine.run("segment", array="noisy", seeds={"points": [3, 500], "values": [1, 2]})
        rows = [3, 9, 80, 400]
        found = self.engine.run("interpolate", values={"points": rows, "values": [1.0, 2.0, 3.0, 4.0]}, exact=True)
        np.testing.assert_allclose(self.engine.result(found["arrays"][0])[rows, 0], [1, 2, 3, 4], atol=1e-9)

    def test_values_beside_the_surface_are_interpolated(self):
        from surfacediffusion import interpolate
        self.open_mesh()
        places = np.asarray(self.mesh.points)[::7] * 1.01
        values = np.cos(places[:, 0])
        rows = "".join(f"{x!r},{y!r},{z!r},{value!r}\n" for (x, y, z), value in zip(places.tolist(), values.tolist()))
        found = self.engine.open("places.csv", f"x,y,z,heights\n{rows}".encode())
        self.assertEqual([entry["name"] for entry in found["samples"]], ["heights"])
        result = self.engine.run("interpolate", array="heights")
        expected = interpolate((self.mesh.points, self.mesh.regular_faces), values, points=places)
        entry = next(entry for entry in result["arrays"] if entry["name"] == "heightsInterpolated")
        self.check_close(self.engine.result(entry)[:, 0], np.asarray(expected), 1e-9, "heights")

    def test_errors_are_sentences(self):
        self.open_mesh()
        for model, given, word in [
                ("heat", {"array": "noisy", "time_step": -1.0}, "TimeStep is -1; allowed: "),
                ("heat", {"array": "noisy", "time_step": "long"}, "time_step is \"long\"; allowed: a number"),
                ("heat", {"array": "noisy", "mode": "none"}, "allowed: TimeSteps, SteadyState"),
                ("heat", {"array": "none"}, "there is no array none"),
                ("heat", {"array": "noisy", "speeds": 1}, "no setting or input speeds"),
                ("heat", {}, "allowed"), ("cool", {}, "there is no model cool"),
                ("distance", {"sources": [10000000]}, "allowed: 0 to"),
                ("distance", {"sources": [3], "path_points": "of_cells"}, "allowed: one of points"),
                ("derivatives", {"array": "smooth", "error": "of_cells"}, "allowed: one of points"),
                ("curvature", {"refine_to": -1.0}, "RefineTo is -1; allowed: "),
                ("distance", {"sources": []}, "")]:
            with self.subTest(model=model, **given), self.assertRaises(EngineError) as raised:
                self.engine.run(model, **given)
            self.assertIn(word, str(raised.exception))
            self.assertNotIn("\n", str(raised.exception))
            self.assertNotIn("no Error", str(raised.exception))

    def test_progress_is_reported_and_a_run_is_cancelled(self):
        self.open_mesh()
        before = self.engine.calls
        self.engine.run("turing_texture", number_of_time_steps=20)
        self.assertGreater(self.engine.calls, before)
        with self.assertRaisesRegex(EngineError, "aborted"):
            self.engine.call("cancel", "turing_texture", "{}")
        self.engine.run("curvature")  # it lives


def read_vtp(data):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.vtp"
        path.write_bytes(data)
        return pyvista.read(path)


def bytes_of(mesh, name, **options):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        mesh.save(path, **options)
        return path.read_bytes()


def xml_of(mesh, mode, compressor=True, grid=False, encode=True):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter
    writer = (vtkXMLUnstructuredGridWriter if grid else vtkXMLPolyDataWriter)()
    writer.SetInputData(mesh.cast_to_unstructured_grid() if grid else mesh)
    getattr(writer, f"SetDataModeTo{mode}")()
    writer.SetEncodeAppendedData(encode)
    if not compressor:
        writer.SetCompressorTypeToNone()
    writer.SetHeaderTypeToUInt64() if grid else writer.SetHeaderTypeToUInt32()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "file"
        writer.SetFileName(str(path))
        writer.Write()
        return path.read_bytes()


def legacy_of(mesh, is_text, grid=False, version=42):
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter, vtkUnstructuredGridWriter
    writer = (vtkUnstructuredGridWriter if grid else vtkPolyDataWriter)()
    writer.SetInputData(mesh.cast_to_unstructured_grid() if grid else mesh)
    writer.SetFileType(1 if is_text else 2)
    writer.SetFileVersion(version)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "file.vtk"
        writer.SetFileName(str(path))
        writer.Write()
        return path.read_bytes()


def gifti_of(arrays, encoding):
    codes = {"NIFTI_INTENT_TRIANGLE": np.int32}
    image = nibabel.gifti.GiftiImage(darrays=[
        nibabel.gifti.GiftiDataArray(np.asarray(array, codes.get(intent, np.float32)), intent=intent,
                                     encoding=encoding, meta={"Name": name})
        for intent, name, array in arrays])
    return image.to_bytes()


def freesurfer_of(points, faces):
    with tempfile.TemporaryDirectory() as folder:
        nibabel.freesurfer.write_geometry(f"{folder}/a", points, faces)
        return Path(folder, "a").read_bytes()


def curv_of(values):
    with tempfile.TemporaryDirectory() as folder:
        nibabel.freesurfer.write_morph_data(f"{folder}/a", values)
        return Path(folder, "a").read_bytes()


def text_of(points, polygons, kind):
    rows = [" ".join(map(repr, map(float, row))) for row in points]
    if kind == "obj":
        faces = ["f " + " ".join(str(corner + 1) for corner in row) for row in polygons]
        return ("# a comment\n" + "".join(f"v {row}\n" for row in rows) + "\n".join(faces) + "\n").encode()
    faces = [" ".join(map(str, [len(row), *row])) for row in polygons]
    return ("\n".join([f"OFF\n{len(rows)} {len(faces)} 0", *rows, *faces]) + "\n").encode()


def rounded_stl_of(points, faces):
    """A binary STL file whose corners are rounded apart."""
    triangles = np.zeros(len(faces), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    corners = np.asarray(points)[faces]
    triangles["corners"] = corners + np.random.default_rng(2).normal(scale=3e-6, size=corners.shape)
    return bytes(80) + len(faces).to_bytes(4, "little") + triangles.tobytes()


def archive_of(points, faces):
    vertices = "".join(f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in points.tolist())
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces.tolist())
    text = (f'<?xml version="1.0"?><model unit="inch"><resources><object id="1"><mesh><vertices>{vertices}'
            f'</vertices><triangles>{triangles}</triangles></mesh></object></resources><build>'
            '<item objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/></build></model>')
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr("3D/3dmodel.model", text)
    return file.getvalue()


class Files(EngineTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        mesh, faces = cls.mesh, cls.mesh.regular_faces
        points = np.asarray(mesh.points)
        quads = [[0, 1, 3, 2], [2, 3, 5, 4], [4, 5, 6]]
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.1], [0, 2, 0], [1, 2, 0], [0.5, 3, 0.5]])
        surface = [("NIFTI_INTENT_POINTSET", "", points), ("NIFTI_INTENT_TRIANGLE", "", faces)]
        mixed = pyvista.PolyData(corners, faces=np.concatenate([[len(row), *row] for row in quads]))
        mixed["a b"] = corners[:, 0]
        mixed.cell_data["cells"] = np.arange(3.0)
        cls.mixed = mixed
        cls.files = {
            "text.stl": bytes_of(mesh, "a.stl", binary=False), "binary.stl": bytes_of(mesh, "a.stl"),
            "rounded.stl": rounded_stl_of(points, faces),
            "text.ply": bytes_of(mesh, "a.ply", binary=False), "binary.ply": bytes_of(mesh, "a.ply"),
            "mixed.ply": bytes_of(mixed, "a.ply"),
            "a.obj": text_of(points, faces, "obj"), "mixed.obj": text_of(corners, quads, "obj"),
            "a.off": text_of(points, faces, "off"), "mixed.off": text_of(corners, quads, "off"),
            "text.vtp": xml_of(mesh, "Ascii"), "base64.vtp": xml_of(mesh, "Binary", False),
            "zlib.vtp": xml_of(mesh, "Binary"), "appended.vtp": xml_of(mesh, "Appended", encode=False),
            "base64appended.vtp": xml_of(mesh, "Appended"),
            "rawappended.vtp": xml_of(mesh, "Appended", False, encode=False), "mixed.vtp": xml_of(mixed, "Binary"),
            "a.vtu": xml_of(mesh, "Appended", grid=True), "mixed.vtu": xml_of(mixed, "Ascii", grid=True),
            "text.vtk": legacy_of(mesh, True), "binary.vtk": legacy_of(mesh, False),
            "new.vtk": legacy_of(mesh, False, version=51), "mixed.vtk": legacy_of(mixed, True, version=51),
            "grid.vtk": legacy_of(mixed, False, grid=True),
            **{f"{code}.surf.gii": gifti_of(surface, code) for code in ("ASCII", "B64BIN", "B64GZ")},
            "a.surf.gii.gz": gzip.compress(gifti_of(surface, "B64GZ")),
            "lh.white": freesurfer_of(points, faces),
        }

    def test_surfaces_are_as_python_reads_them(self):
        for name, data in self.files.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                found = self.engine.open(name, data)
                path = Path(folder) / name
                path.write_bytes(data)
                expected = read_surface(path)
                np.testing.assert_array_equal(self.engine.points(), np.asarray(expected.points, float))
                if isinstance(expected.faces, np.ndarray):
                    np.testing.assert_array_equal(self.engine.triangles(), expected.faces)
                else:
                    sizes = [len(face) for face in expected.faces]
                    self.assertEqual({entry["corners"]: entry["count"] for entry in found["polygons"]},
                                     {size: sizes.count(size) for size in sizes})
                    np.testing.assert_array_equal(
                        self.engine.call("cellOfTriangle"), np.repeat(np.arange(len(sizes)), np.array(sizes) - 2))

    def test_arrays_of_vtk_files_are_read(self):
        for name in [name for name in self.files if name.endswith((".vtp", ".vtu", ".vtk"))]:
            with self.subTest(name):
                mesh = self.mixed if name.startswith(("mixed", "grid")) else self.mesh
                found = self.engine.open(name, self.files[name])
                self.assertEqual(sorted(entry["name"] for entry in found["arrays"]), sorted(mesh.array_names))
                for entry in found["arrays"]:
                    arrays = mesh.cell_data if entry["association"] == "cell" else mesh.point_data
                    values = self.engine.array(entry["name"], entry["association"], entry["components"])
                    expected = np.reshape(arrays[entry["name"]], values.shape)
                    if "text" not in name and name != "mixed.vtk":
                        np.testing.assert_array_equal(values, expected)
                    np.testing.assert_allclose(values, expected, rtol=1e-5, atol=1e-5)  # text is rounded

    def test_values_follow_a_surface(self):
        count = self.mesh.n_points
        values = self.mesh["smooth"].astype(np.float32)
        rows = "".join(f"{value!r},{2.0 * value!r}\n" for value in values.tolist())
        mgh = io.BytesIO()
        nibabel.MGHImage(values.reshape(-1, 1, 1), np.eye(4)).to_file_map(
            {"image": nibabel.FileHolder(fileobj=mgh)})
        self.engine.open("lh.white", self.files["lh.white"])
        for name, data, word in [
                ("lh.thickness", curv_of(values), "thickness"),
                ("a.func.gii", gifti_of([("NIFTI_INTENT_SHAPE", "depth", values)], "B64GZ"), "depth"),
                ("lh.sulc.mgh", mgh.getvalue(), "sulc"), ("lh.area.mgz", gzip.compress(mgh.getvalue()), "area"),
                ("a.csv", f"first,second\n{rows}".encode(), "first"),
                ("one.txt", "\n".join(map(repr, values.tolist())).encode(), "one")]:
            with self.subTest(name):
                found = self.engine.open(name, data)
                self.assertEqual(found["points"], count)
                self.assertIn(word, [entry["name"] for entry in found["arrays"]])
                np.testing.assert_array_equal(self.engine.array(word, "point")[:, 0], values)
        with self.assertRaisesRegex(EngineError, "allowed: 642"):
            self.engine.open("b.csv", b"1\n2\n3\n")

    def test_values_at_some_points_and_regions_follow_a_surface(self):
        count, inside = self.mesh.n_points, np.array([7, 3, 600])
        self.engine.open("lh.white", self.files["lh.white"])
        label = "#!ascii label, from subject x\n3\n" + "".join(f"{i} 0.5 1 2 {i / 4}\n" for i in inside)
        regions = np.arange(count) % 3
        with tempfile.TemporaryDirectory() as folder:
            nibabel.freesurfer.write_annot(f"{folder}/a", regions, np.array(
                [[255, 0, 0, 0], [0, 9, 0, 0], [5, 5, 200, 0]]), ["a", "b", "c"], fill_ctab=True)
            annotation = Path(folder, "a").read_bytes()
        some = gifti_of([("NIFTI_INTENT_NODE_INDEX", "", inside), ("NIFTI_INTENT_SHAPE", "depth", inside / 8)],
                        "B64GZ")
        marks, depths = np.zeros(count), np.full((2, count), np.nan)
        marks[inside], depths[0, inside], depths[1, inside] = 1, inside / 4, inside / 8
        for name, data, arrays in [
                ("lh.cortex.label", label.encode(), {"cortex": marks, "cortex value": depths[0]}),
                ("lh.aparc.annot", annotation, {"aparc": regions}), ("a.func.gii", some, {"depth": depths[1]})]:
            with self.subTest(name):
                self.engine.open(name, data)
                for array, expected in arrays.items():
                    np.testing.assert_array_equal(self.engine.array(array, "point")[:, 0], expected)
        with self.assertRaisesRegex(EngineError, "point 642; allowed: 0 to 642 - 1"):
            self.engine.open("lh.b.label", b"#!ascii\n1\n642 0 0 0 0\n")

    def test_texts_of_freesurfer_and_files_in_pieces_are_surfaces(self):
        self.engine.open("lh.white.asc", b"#!ascii version of lh.white\n3 1\n" + b"0 0 0 0\n0 1 0 0\n2 0.5 0 0\n0 2 1 0\n")
        self.assertEqual(self.engine.points().tolist(), [[0, 0, 0], [0, 1, 0], [2, 0.5, 0]])
        self.assertEqual(self.engine.triangles().tolist(), [[0, 2, 1]])
        piece = """<Piece NumberOfPoints="3" NumberOfPolys="1"><PointData>
            <DataArray type="Float64" Name="f" format="ascii">{0} 1 2</DataArray>{1}</PointData>
            <Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{0} 0 0 1 0 0 0 1 0</DataArray></Points>
            <Polys><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2</DataArray>
            <DataArray type="Int32" Name="offsets" format="ascii">3</DataArray></Polys></Piece>"""
        more = '<DataArray type="Float64" Name="g" format="ascii">1 1 1</DataArray>'
        found = self.engine.open("a.vtp", ('<VTKFile type="PolyData"><PolyData>' + piece.format(5, "")
                                           + piece.format(6, more) + "</PolyData></VTKFile>").encode())
        self.assertEqual(self.engine.triangles().tolist(), [[0, 1, 2], [3, 4, 5]])
        self.assertEqual(self.engine.points()[[0, 3], 0].tolist(), [5, 6])
        self.assertEqual(self.engine.array("f", "point")[:, 0].tolist(), [5, 1, 2, 6, 1, 2])
        self.assertEqual([array["name"] for array in found["arrays"]], ["f"])
        self.assertIn("2 pieces", found["warnings"][0])

    def test_3mf_has_places_and_units(self):
        points, faces = np.asarray(self.mesh.points), self.mesh.regular_faces
        found = self.engine.open("a.3mf", archive_of(points, faces))
        self.assertEqual(found["unit"], "in")
        np.testing.assert_array_equal(self.engine.points(), points + [5, 0, 0])
        np.testing.assert_array_equal(self.engine.triangles(), faces)

    def test_what_is_written_is_read(self):
        self.open_mesh()
        self.engine.run("heat", array="noisy", fwhm=3.0)
        result = self.engine.call("resultArray", "noisyDiffused")
        points, triangles = self.engine.points(), self.engine.triangles()
        for name in ("a.ply", "a.obj", "a.off", "a.vtp", "a.vtu", "a.vtk", "a.surf.gii", "lh.a", "a.stl", "a.3mf"):
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                self.open_mesh()
                self.engine.run("heat", array="noisy", fwhm=3.0)
                data = self.engine.write(name)
                again = self.engine.open(name, data)
                self.assertEqual(again["points"], len(points))
                if name == "a.3mf":
                    continue
                path = Path(folder) / name
                path.write_bytes(data)
                surface = read_surface(path)
                if name != "a.stl":
                    np.testing.assert_allclose(surface.points, points, rtol=1e-6)
                    np.testing.assert_array_equal(surface.faces, triangles)
                if name in ("a.ply", "a.vtp", "a.vtk"):
                    found = read_data(path)
                    column = found.names.index("noisyDiffused")
                    np.testing.assert_allclose(found.parts[0].values[:, column], result, rtol=1e-12)

    def test_a_relief_moves_the_points_that_are_written(self):
        self.open_mesh()
        self.engine.run("relief", array="level", height=0.3)
        moved = self.engine.call("resultPoints").reshape(-1, 3)
        self.engine.open("a.ply", self.engine.write("a.ply"))
        np.testing.assert_array_equal(self.engine.points(), moved)


    def test_a_pattern_is_written_as_colours_and_kept_for_a_relief(self):
        self.open_mesh()
        self.engine.run("turing_texture", number_of_time_steps=40, refine_to=2.0)
        pattern = self.engine.call("resultArray", "Texture")
        data = self.engine.write("a.ply")
        kept = self.engine.open("kept.vtp", self.engine.write("kept.vtp"))
        self.assertEqual(kept["points"], len(pattern))
        np.testing.assert_array_equal(self.engine.array("Texture", "point")[:, 0], pattern)
        self.assertEqual(self.engine.run("relief", array="Texture", height=0.1)["points"], True)
        self.engine.open("a.ply", data)
        grey = np.round(255 * (pattern - pattern.min()) / np.ptp(pattern))
        np.testing.assert_allclose(self.engine.array("RGB", "point", 3)[:, 0], grey, atol=1)


class WrongFiles(EngineTest):
    def refuse(self, name, data):
        with self.assertRaises(EngineError) as raised:
            self.engine.open(name, data)
        sentence = str(raised.exception)
        self.assertNotIn("\n", sentence)
        self.assertLess(len(sentence), 300)
        self.assertNotIn("no Error", sentence)
        self.assertNotIn("node has ended", sentence)

    def test_wrong_files_are_one_line(self):
        many = 10 ** 12
        for name, data in {
                "empty.stl": b"", "a.txt": b"hello", "a.pdf": b"%PDF-1.4\0\1\2", "a.zip": b"PK\3\4" + bytes(40),
                "a.off": f"OFF\n{many} {many} 0\n0 0 0\n".encode(), "b.off": b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n",
                "a.ply": f"ply\nformat ascii 1.0\nelement vertex {many}\nproperty float x\nend_header\n".encode(),
                "b.ply": b"ply\nformat binary_little_endian 1.0\nelement face 2\nproperty list uint int vertex_indices\n"
                         b"end_header\n\xff\xff\xff\xff",
                "a.obj": b"v 0 0 0\nv 1 0 0\nf 1 2 3\n", "nan.obj": b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                "a.vtk": f"# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\nPOINTS {many} float\n".encode(),
                "a.vtp": f'<VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="{many}"></Piece>'.encode(),
                "b.vtp": b"<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints='1'><Points><DataArray type='Float32'"
                         b" format='binary'>/////w==</DataArray>",
                "a.gii": f'<GIFTI><DataArray Intent="NIFTI_INTENT_SHAPE" DataType="NIFTI_TYPE_FLOAT32" Dim0="{many}" '
                         'Dimensionality="1" Encoding="GZipBase64Binary"><Data>eJw=</Data></DataArray>'.encode(),
                "lh.white": b"\xff\xff\xfe\n\n\x7f\xff\xff\xff\x7f\xff\xff\xff",
                "lh.thickness": b"\xff\xff\xff\x7f\xff\xff\xff\0\0\0\0\0\0\0\1",
                "a.gz": b"\x1f\x8b\x08\0\0\0\0\0\0\0\3\0" + bytes(4) + b"\xff\xff\xff\x7f",
                "a.stl": b"solid a\nfacet\nvertex 0 0\n"}.items():
            with self.subTest(name):
                self.refuse(name, data)
        self.open_mesh()  # it lives

    def test_truncated_files_are_one_line(self):
        mesh, points, faces = self.mesh, np.asarray(self.mesh.points), self.mesh.regular_faces
        surface = [("NIFTI_INTENT_POINTSET", "", points), ("NIFTI_INTENT_TRIANGLE", "", faces)]
        for name, data in {
                "a.stl": bytes_of(mesh, "a.stl"), "a.ply": bytes_of(mesh, "a.ply"), "a.vtp": self.content,
                "a.vtk": legacy_of(mesh, False), "b.vtp": xml_of(mesh, "Appended", encode=False),
                "a.gii": gifti_of(surface, "B64GZ"), "lh.white": freesurfer_of(points, faces),
                "a.3mf": archive_of(points, faces), "a.off": text_of(points, faces, "off"),
                "a.gii.gz": gzip.compress(gifti_of(surface, "B64GZ"))}.items():
            for share in (0.02, 0.3, 0.6, 0.95):
                with self.subTest(name, share=share):
                    self.refuse(name, data[:int(share * len(data))])
        self.open_mesh()

    def test_scripts_in_names_stay_text(self):
        mesh = self.mesh.copy()
        name = "<img src=x onerror=alert(1)>\"'\\"
        mesh[name] = np.asarray(mesh["smooth"])
        found = self.engine.open("a.vtk", legacy_of(mesh, False))
        self.assertIn(name, [entry["name"] for entry in found["arrays"]])
        found = self.engine.run("heat", array=name, fwhm=3.0)
        self.assertEqual(found["arrays"][0]["name"], name + "Diffused")


if __name__ == "__main__":
    unittest.main()
