# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The functions on arrays give the bits of the VTK filters, which run in another Python:
SURFACEDIFFUSION_VTK_PYTHON, with the package for VTK in SURFACEDIFFUSION_VTK_PATH."""

import inspect
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy as np
import pyvista

import surfacediffusion as sd
import surfacediffusion.pyvista as of_meshes
from filter_classes import CLASSES
from surfacediffusion._settings import snake_case

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from kinds_of_run import kinds_of_run  # noqa: E402

VTK_PYTHON = os.environ.get("SURFACEDIFFUSION_VTK_PYTHON")
if not VTK_PYTHON:
    print("SURFACEDIFFUSION_VTK_PYTHON is not set")
    sys.exit(77)

#: Index of each input array of the filters.
INDEX = {"values": 0, "vectors": 0, "initial": 0, "mask": 1, "directions": 2, "hints": 2, "fixed": 3,
         "rates": 4, "fidelity": 5, "seeds": 6, "creases": 6, "terms": 7, "marked": 0, "speed": 8, "slope_error": 10,
         "along_speed": 11, "across_speed": 12}

#: The argument that is the array of a panel, other than values.
ARGUMENTS = {"MaskArray": "mask", "FidelityArray": "fidelity", "CreaseArray": "creases", "SpeedArray": "speed",
             "SourceArray": "marked", "SlopeErrorArray": "slope_error", "AlongSpeedArray": "along_speed",
             "AcrossSpeedArray": "across_speed"}

#: The arguments of the functions for PyVista meshes that have other names.
OF_MESHES = {"values": "array", "vectors": "array", "directions": "direction", "marked": "sources",
             "slope_error": "error"}

#: The functions without a filter of their own, and what holds them.
WITHOUT_FILTER = {
    **dict.fromkeys(("gradient", "divergence", "curl", "laplacian", "conduction_velocity", "helmholtz"),
                    "derivatives() with a quantity"),
    **dict.fromkeys(("nearest_sources", "distances"), "the run of distance()"),
    **dict.fromkeys(("estimate_fwhm", "smooth_to_fwhm", "surrogates", "spectrum"),
                    "statistics of arrays, which no other door has"),
    **dict.fromkeys(("estimate_fwhm_img", "smooth_img"), "functions above, for images of nilearn"),
    **dict.fromkeys(("mass_matrix", "stiffness_matrix", "gradient_matrix", "eigenmodes", "scale_filter"),
                    "matrices of Core, in coordinates"),
    **dict.fromkeys(("geodesic_path", "path_through", "geodesic_disk"), "places and lines, which Core finds"),
    "resample": "weights of Core, between two surfaces",
    **dict.fromkeys(("weld", "bodies"), "facets and solids of files, which Core finds"),
    **dict.fromkeys(("refine", "sphere", "on_faces", "on_points", "get_number_of_threads",
                     "set_number_of_threads"), "no computation on data"),
}


def rough_sphere():
    """A sphere with noise and a hole of polygons of three to six corners, some of which are not convex or
    turned; a second part, open and of quadrilaterals; and points of no face between."""
    random = np.random.default_rng(1)
    sphere = sd.sphere(3)
    points = sphere.points * random.normal(1.0, 0.006, size=(sphere.n_points, 1)) * [1.0, 1.2, 0.8]
    faces = sphere.triangles[sphere.points[sphere.triangles].mean(axis=1)[:, 2] < 0.9].tolist()
    of_edge = {edge: number for number, face in enumerate(faces) for edge in zip(face, face[1:] + face[:1])}
    merged = set()
    for number in range(0, len(faces), 7):
        polygon = faces[number]
        for _ in range(number // 7 % 4 if number not in merged else 0):
            for i, (start, end) in enumerate(zip(polygon, polygon[1:] + polygon[:1])):
                twin = of_edge.get((end, start), 0)
                added = {*faces[twin]} - {*polygon}
                if twin % 7 and twin not in merged and len(added) == 1:
                    polygon.insert(i + 1, *added)
                    merged.add(twin)
                    break
    faces = [face for number, face in enumerate(faces) if number not in merged]
    x, y = np.divmod(np.arange(30), 6)
    patch = np.column_stack([2.0 + 0.1 * x, 0.1 * y, 0.02 * random.normal(size=30)])
    faces = [face[::-1] if number % 97 == 9 else face for number, face in enumerate(faces)]
    corner = len(points) + np.flatnonzero((x < 4) & (y < 5))
    faces += np.stack([corner, corner + 6, corner + 7, corner + 1], axis=1).tolist()
    return np.vstack([points, patch]), faces


def keywords_of(function, properties):
    """The keywords of a function of arrays."""
    keywords = {snake_case(name): value for name, value in properties.items()}
    if function == "random_field":
        keywords["n"] = keywords.pop("number_of_fields", 1)
        covariance = keywords.pop("covariance", "")
        if covariance:
            keywords["nu"] = keywords.pop("smoothness", int(covariance[-1]) if covariance[-1].isdigit() else 1)
    return keywords


class SameBits(unittest.TestCase):
    def setUp(self):
        self.points, self.faces = rough_sphere()
        self.surface = sd.Surface(self.points, self.faces)
        self.random = np.random.default_rng(2)
        n, m = self.surface.n_points, self.surface.n_faces
        x, y, z = self.points.T
        self.values = np.sign(x) + 0.2 * self.random.normal(size=n)
        self.columns = self.random.normal(size=(n, 3))
        self.of_faces = self.random.normal(size=(m, 2))
        self.mask = ((x - 0.5) ** 2 + y**2 < 0.05).astype(np.uint8)
        self.around = np.stack([-y, x, 0 * z], axis=1)
        self.normals = self.points + 0.1 * self.random.normal(size=(n, 3))
        self.rates = np.tile([30.0, 20.0, 3.0, 2.0], (m, 1))
        corners = [np.asarray(face) for face in self.faces]
        self.around_of_faces = np.array([self.around[face].mean(axis=0) for face in corners])
        self.other_part = x > 1.9
        known = np.where(np.arange(n) % 29 == 3, 10.0 * y + self.random.normal(size=n), np.nan)
        self.fit = sd.interpolate(self.surface, known, compute_error=True)
        self.faces_of_other_part = np.array([self.other_part[face].all() for face in corners])

    def cases_of_kinds(self):
        """Every kind of run of the filters, as a function, arrays and properties."""
        n, m = len(self.points), len(self.faces)
        arrays = {"f": self.values, "rgb": self.random.integers(0, 256, (n, 3), np.uint8),
                  "e1": self.around + 0.3 * self.random.normal(size=(n, 3)), "mask": self.mask,
                  "weights": 0.25 * (np.arange(n) % 4), "sources": np.where(np.arange(n) % 211 == 10, np.arange(n), 0)}
        of_cells = {"c": np.exp(0.5 * self.of_faces[:, 0]), "weights": 0.25 * (np.arange(m) % 4)}
        functions = {class_name: function for function, class_name in CLASSES.items()}
        cases = []
        for _, class_name, values in kinds_of_run():
            function = functions[class_name]
            taken = inspect.signature(getattr(sd, function)).parameters
            data = next((name for name in ("values", "vectors") if name in taken), None)
            names = {**ARGUMENTS, "InputArray": data, "DirectionArray": "hints" if "hints" in taken else "directions"}
            given = {names[key]: (of_cells if value[1] else arrays)[value[0]]
                     for key, value in values.items() if isinstance(value, tuple)}
            if data == "values":
                given.setdefault("values", self.values)
            if "slope_error" in given:
                given.update(values=self.fit.values, slope_error=self.fit.slope_error)
            # Paths, gradients and normals are outputs of the filters alone.
            properties = {key: bool(value) if isinstance(getattr(taken.get(snake_case(key)), "default", None), bool)
                          else value for key, value in values.items()
                          if not isinstance(value, tuple) and key not in ("ComputeGradient", "PathPoints", "UseAsNormals")}
            if function == "heat" and "Mode" not in values:  # which has no step of its own
                properties["TimeStep"] = 1.0
            cases.append((function, given, properties))
        return cases

    def test_all_functions(self):
        x = self.points[:, 0]
        nan = np.where(self.mask != 0, np.nan, self.values)
        colours = self.random.integers(0, 256, (len(self.points), 4), np.uint8)
        bytes_of_faces = self.random.integers(0, 256, (len(self.faces), 4), np.uint8)
        positive = 1 + np.abs(self.values)
        unknown = np.where(self.other_part, np.nan, self.values)
        used = np.zeros(len(x), np.uint8)
        some = np.where(np.arange(len(x)) % 300 == 9, np.arange(len(x)), 0)
        used[np.concatenate([np.asarray(face) for face in self.faces])] = 1
        some_fixed = (x < -0.8).astype(np.uint8)
        weighted = {"mask": self.mask, "fixed": some_fixed, "directions": self.around,
                    "fidelity": 1.0 + self.points[:, 2] ** 2}
        cases = [
            *self.cases_of_kinds(),
            *((function, {data: self.columns, **weighted},
               {"AcrossDiffusivity": 0.3, "FidelityWeight": 1.5, "NumberOfTimeSteps": 2, **properties})
              for function, data, properties in (
                  ("heat", "values", {"TimeStep": 1.0}), ("intrinsic_tv", "values", {}),
                  ("tensor_diffusion", "values", {"MaskMode": "Exclude"}), ("harmonic_map", "vectors", {}),
                  ("mumford_shah", "values", {"AutomaticThreshold": False, "EdgeThreshold": 1.0}))),
            ("heat", {"values": self.values}, {"FWHM": 0.2}),
            ("heat", {"values": self.columns.astype(np.float32)}, {"FWHM": 0.1}),
            ("heat", {"values": colours}, {"TimeStep": 2.0, "TimeIntegrator": "FirstOrder"}),
            ("heat", {"values": nan}, {"FWHM": 0.2, "TimeIntegrator": "Exponential", "NumberOfTimeSteps": 1}),
            ("heat", {"values": nan}, {"FidelityWeight": 2.0, "InitialFill": "Noise", "TimeStep": 1.0,
                                       "RandomSeed": 3, "Solver": "ConjugateGradient"}),
            ("heat", {"values": self.values, "mask": self.mask, "fixed": (self.points[:, 0] > 1.0)
                      .astype(np.uint8)}, {"Mode": "SteadyState", "HoldKnownValues": True}),
            ("heat", {"values": self.columns, "directions": self.around},
             {"AcrossDiffusivity": 0.1, "Units": "Absolute", "TimeStep": 0.002}),
            ("heat", {"values": self.columns, "directions": self.around_of_faces},
             {"AcrossDiffusivity": 0.1, "TimeStep": 2.0}),
            *((function, {"values": self.of_faces, "mask": (self.of_faces[:, 0] > 1.5).astype(np.uint8)}, properties)
              for function, properties in (
                  ("heat", {"TimeStep": 1.0}), ("heat", {"TimeStep": 1.0, "KeepCellDetail": False}),
                  ("heat", {"TimeStep": 1.0, "ResultOnCells": False}),
                  ("heat", {"TimeStep": 1.0, "MaskMode": "Exclude"}), ("intrinsic_tv", {}),
                  ("mumford_shah", {"AutomaticThreshold": False, "EdgeThreshold": 0.4}),
                  ("segment", {"AutomaticFidelity": False, "FidelityWeight": 50.0, "StopTolerance": 0.1}))),
            ("intrinsic_tv", {"values": bytes_of_faces}, {"AutomaticFidelity": False}),
            ("intrinsic_tv", {"values": bytes_of_faces}, {"AutomaticFidelity": False, "ResultOnCells": False}),
            ("harmonic_map", {"vectors": bytes_of_faces}, {"NumberOfTimeSteps": 2}),
            # a part without a known value
            *((function, {"values": unknown}, properties) for function, properties in (
                ("heat", {"TimeStep": 1.0}), ("intrinsic_tv", {"Mode": "SteadyState", "AutomaticFidelity": False}),
                ("tensor_diffusion", {"NumberOfTimeSteps": 2}),
                ("mumford_shah", {"AutomaticThreshold": False, "EdgeThreshold": 1.0}), ("segment", {}))),
            ("heat", {"values": np.where(self.faces_of_other_part[:, None], np.nan, self.of_faces)}, {"TimeStep": 1.0}),
            *(("heat", {"values": (50 * positive).astype(dtype), "mask": self.other_part.astype(np.uint8)},
               {"TimeStep": 1.0}) for dtype in (np.float32, np.uint8, np.int32)),
            ("heat", {"values": self.around_of_faces},
             {"VectorType": "Tangent", "NormalPart": "Diffuse", "TimeStep": 1.0}),
            ("heat", {"values": self.values, **{name: array * 1.0 for name, array in weighted.items()}},
             {"TimeStep": 1.0, "FidelityWeight": 1.0, "RefineTo": 0.06}),
            ("intrinsic_tv", {"values": self.values}, {}),
            ("intrinsic_tv", {"values": colours, "mask": self.mask}, {"Mode": "SteadyState"}),
            ("intrinsic_tv", {"values": colours, "mask": self.mask},
             {"Mode": "SteadyState", "Regularizer": "TGV", "TGVLength": 3.0, "AutomaticFidelity": False}),
            ("intrinsic_tv", {"values": self.values},
             {"Mode": "SteadyState", "BlurFWHM": 0.2, "AutomaticBlurFidelity": False}),
            ("heat", {"values": self.columns},
             {"Mode": "SteadyState", "BlurFWHM": 0.2, "FidelityWeight": 9.0, "BlurSteps": 3}),
            ("intrinsic_tv", {"values": colours, "mask": self.mask},
             {"ColorModel": "ChromaticityBrightness", "ChromaticityWeight": 2.0, "AutomaticFidelity": False}),
            ("intrinsic_tv", {"values": self.columns},
             {"ColorModel": "ChromaticityBrightness", "LinearLight": True, "Mode": "SteadyState",
              "AutomaticFidelity": False}),
            ("mumford_shah", {"values": self.normals}, {"AutomaticThreshold": False, "EdgeThreshold": 0.4}),
            ("mumford_shah", {"values": self.normals[:, 0].astype(np.float32)}, {}),
            ("tensor_diffusion", {"values": self.values, "directions": self.around},
             {"Model": "CoherenceEnhancing", "AcrossDiffusivity": 0.5, "NumberOfTimeSteps": 2}),
            ("tensor_diffusion", {"values": colours, "fixed": self.mask},
             {"Model": "EdgeEnhancing", "FidelityWeight": 0.1, "DiffusionAxes": True}),
            ("tensor_diffusion", {"values": self.of_faces.astype(np.float32), "mask": self.mask},
             {"Model": "CoherenceEnhancing", "DiffusionAxes": True, "NumberOfTimeSteps": 2}),
            ("tensor_diffusion", {"values": self.of_faces},
             {"ResultOnCells": False, "NumberOfTimeSteps": 2}),
            ("segment", {"values": self.values, "mask": self.mask}, {}),
            ("segment", {"values": self.columns, "fidelity": 1.0 + self.points[:, 2] ** 2},
             {"NumberOfRegions": 3, "AutomaticFidelity": False, "FidelityWeight": 2.0}),
            ("segment", {"terms": self.columns, "seeds": np.where(self.mask, 2, 0)},
             {"NumberOfRegions": 3, "StopTolerance": 0.01}),
            ("segment", {"terms": self.columns[:, :2], "seeds": np.where(self.mask, 2.0, 0.0)}, {"RefineTo": 0.06}),
            ("interpolate", {"values": np.where(np.isnan(nan), -9999.0, nan)}, {"MissingValue": [1e30, -9999.0]}),
            ("interpolate", {"values": np.where(np.arange(len(nan)) % 40 == 0, nan, np.nan),
                             "fidelity": 1.0 + self.points[:, 2] ** 2},
             {"Exact": True, "CorrelationLength": 2.0}),
            ("interpolate", {"values": self.of_faces, "directions": self.around},
             {"AcrossDiffusivity": 0.2, "KeepRange": True}),
            ("harmonic_map", {"vectors": self.normals}, {"Exponent": 2.0}),
            ("harmonic_map", {"vectors": self.normals.astype(np.float32)}, {"LineField": True}),
            ("harmonic_map", {"vectors": colours[:, :3]}, {}),
            ("denoise_mesh", {"fixed": self.mask}, {}),
            ("denoise_mesh", {"creases": self.mask}, {"NoiseLevel": 0.01, "SurfaceType": "CAD"}),
            ("turing_texture", {}, {"NumberOfTimeSteps": 30, "RandomSeed": 4, "ColorOutput": True}),
            ("turing_texture", {"initial": np.abs(self.columns[:, :2]), "mask": self.mask, "fixed": some_fixed},
             {"NumberOfTimeSteps": 5}),
            ("turing_texture", {}, {"NumberOfTimeSteps": 20, "Kinetics": "GrayScott",
                                    "TimeIntegrator": "FirstOrder"}),
            ("turing_texture", {"rates": self.rates, "directions": self.around},
             {"NumberOfTimeSteps": 10}),
            ("turing_texture", {"initial": np.abs(self.columns[:, :2].astype(np.float32))},
             {"NumberOfTimeSteps": 10, "FeatureSize": 0.3}),
            ("derivatives", {"values": self.values, "mask": self.mask}, {"SmoothingFWHM": 0.3}),
            ("derivatives", {"values": self.normals}, {"Quantity": "Curl"}),
            ("derivatives", {"values": self.of_faces}, {"ResultOnCells": True}),
            ("derivatives", {"values": self.around_of_faces}, {"Quantity": "Helmholtz", "ResultOnCells": True}),
            ("derivatives", {"values": nan}, {"Quantity": "ConductionVelocity"}),
            ("random_field", {"mask": self.mask}, {"FWHM": 0.5, "NumberOfFields": 19, "RandomSeed": -4}),
            ("distance", {"marked": (self.values > 1.3) * used * np.arange(len(x))}, {}),
            ("distance", {"marked": (self.values > 1.3) * used * 1.0}, {"RefineTo": 0.06}),
            ("distance", {"marked": (self.points[:, 2] > 0.3) * used * np.arange(len(x))}, {"Signed": True}),
            ("distance", {"marked": (self.points[:, 2] > 0.3) * used, "mask": self.mask},
             {"Signed": True, "Method": "Eikonal"}),
            ("distance", {"marked": some, "speed": 1.0 + self.points[:, 2] ** 2}, {}),
            ("distance", {"marked": (np.arange(len(x)) == 70) * used, "mask": self.mask}, {"Method": "Eikonal"}),
            ("distance", {"marked": (np.arange(len(x)) % 400 == 7) * used,
                          "speed": np.where(self.of_faces[:, 0] > 1.5, 0.0, 1.0 + self.of_faces[:, 1] ** 2)},
             {"Method": "Eikonal"}),
            ("direction_field", {}, {"Method": "Smooth", "Angle": 30.0}),
            ("relief", {"values": x, "mask": (self.of_faces[:, 0] > 1.0).astype(np.uint8)},
             {"Height": 0.1, "Overhang": 30.0}),
        ]
        self.assert_rows_of_all_arguments(cases)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            listed = []
            flat = np.concatenate([np.asarray(face) for face in self.faces])
            sizes = np.array([len(face) for face in self.faces])
            for number, (function, arrays, properties) in enumerate(cases):
                np.savez(folder / f"case{number}.npz", points=self.points, faces=flat, sizes=sizes,
                         **arrays)
                listed.append([CLASSES[function], properties, {key: INDEX[key] for key in arrays}])
            (folder / "cases.json").write_text(json.dumps(listed))
            environment = dict(os.environ, PYTHONPATH=os.environ["SURFACEDIFFUSION_VTK_PATH"])
            script = pathlib.Path(__file__).with_name("run_filters.py")
            subprocess.run([VTK_PYTHON, script, folder], env=environment, check=True)
            for number, (function, arrays, properties) in enumerate(cases):
                with self.subTest(number=number, function=function, properties=properties):
                    with np.load(folder / f"result{number}.npz") as found:
                        expected = dict(found)
                    self.compare_meshes(function, arrays, properties, expected)
                    for name in ("active", "polygons", "vtkOriginalCellIds"):
                        expected.pop(name, None)
                    self.compare(function, arrays, properties, expected)

    def assert_rows_of_all_arguments(self, cases):
        """Every function has rows, and each array that it takes is given in one of them."""
        of_filters = {name.replace("_steps", "") for name in sd.__all__
                      if inspect.isfunction(getattr(sd, name)) and name not in WITHOUT_FILTER}
        self.assertEqual(of_filters, {function for function, _, _ in cases})
        for function in of_filters:
            taken = set(inspect.signature(getattr(sd, function)).parameters) & set(INDEX)
            given = set().union(*(arrays for name, arrays, _ in cases if name == function))
            with self.subTest(function=function):
                self.assertEqual(taken - given, set())

    def compare_meshes(self, function, arrays, properties, expected):
        """The arrays of PyVista meshes have the names, roles and bits of those of the filter."""
        mesh = pyvista.PolyData(self.points, np.concatenate([[len(face), *face] for face in self.faces]))
        for name, array in arrays.items():
            (mesh.cell_data if len(array) == len(self.faces) else mesh.point_data)[name] = array
        given = {OF_MESHES.get(name, name): name for name in arrays}
        given.update(keywords_of(function, properties))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = getattr(of_meshes, function)(mesh, **given)
        for name, array in expected.items():
            if name == "points":
                np.testing.assert_array_equal(array, found.points)
            elif name == "polygons":
                np.testing.assert_array_equal(array, found.faces)
            elif name == "active":
                for place, kind, active in map(str.split, array):
                    data = (found.GetPointData(), found.GetCellData())[int(place)]
                    self.assertEqual(data.GetAbstractAttribute(int(kind)).GetName(), active)
            elif not name.startswith("history"):
                np.testing.assert_array_equal(array, found[name], err_msg=name)

    def compare(self, function, arrays, properties, expected):
        if function == "distance":
            self.compare_distance(arrays, properties, expected)
            return
        if function == "random_field":
            self.compare_random_field(arrays, properties, expected)
            return
        keywords = keywords_of(function, properties)
        has_band = "slope_error" in arrays
        arrays = {name: array for name, array in arrays.items() if name != "slope_error"}
        if function in ("heat", "intrinsic_tv", "tensor_diffusion"):
            result = getattr(sd, f"{function}_steps")(self.surface, **arrays, **keywords).last()
        else:
            result = getattr(sd, function)(self.surface, **arrays, **keywords)
        if function == "direction_field":
            found = {"Direction": result}
        elif function == "curvature":
            found = {"MeanCurvature": result.mean, "GaussianCurvature": result.gaussian,
                     "PrincipalCurvatures": result.principal, "ShapeIndex": result.shape_index,
                     "Curvedness": result.curvedness}
        elif function == "derivatives":
            found = {"values" + properties.get("Quantity", "Gradient"): result}
            if properties.get("Quantity") == "Helmholtz":
                del keywords["quantity"]
                parts = sd.helmholtz(self.surface, arrays["values"], mask=arrays.get("mask"), **keywords)
                found = {"values" + part: array for part, array in zip(
                    ("GradientPotential", "CurlPotential", "GradientPart", "CurlPart", "HarmonicPart"), parts)}
            if properties.get("Quantity") == "ConductionVelocity":
                del keywords["quantity"]
                velocity = sd.conduction_velocity(
                    self.surface, arrays["values"], mask=arrays.get("mask"),
                    error=self.fit if has_band else None, **keywords)
                found["valuesSpeed"] = velocity.speed
                if has_band:
                    found["valuesSpeedLower"], found["valuesSpeedUpper"] = velocity.speed_lower, velocity.speed_upper
                for mark in ("Collision", "Focus"):  # NaN where no face is left
                    expected["values" + mark] = np.nan_to_num(expected["values" + mark]) > 0
                    found["values" + mark] = getattr(velocity, mark.lower())
        elif function == "relief":
            found = {"points": result.surface.points, "ReliefHeight": result.heights}
        elif function == "denoise_mesh":
            found = {"points": result.points, "Displacement": result.points - self.points}
        elif function == "turing_texture":
            found = {"u1": result.values[:, 0], "u2": result.values[:, 1], "Texture": result.texture}
            if result.colors is not None:
                found["TextureColor"] = result.colors
        else:
            suffix = {"heat": "Diffused", "intrinsic_tv": "TV", "harmonic_map": "Harmonic",
                      "interpolate": "Interpolated", "mumford_shah": "MumfordShah",
                      "segment": "Segmented",
                      "tensor_diffusion": {"CoherenceEnhancing": "Coherent",
                                           "EdgeEnhancing": "EdgeEnhanced"}.get(
                                               properties.get("Model"), "Beltrami")}[function]
            base = next((name for name in ("values", "vectors", "terms") if name in arrays), "Normals")
            found = {base + suffix: result.values}
        if function == "segment":
            found = self.regions(result, arrays)
            expected = {key: array for key, array in expected.items()
                        if key != "history Block" and not key.startswith("history Mean_")}
        if function == "interpolate":
            found.update({f"history {column}": getattr(result, snake_case(column)) for column in (
                "Smoothing", "Score", "Misfit", "DegreesOfFreedom", "NoiseLevel")})
            found["history Component"] = np.arange(len(result.smoothing))
            if properties.get("ComputeError"):
                found["valuesError"] = result.error
                found["valuesSlopeError"] = result.slope_error
            if properties.get("Robust"):
                found["valuesOutliers"] = result.outliers.astype(np.int32)
                found["valuesResiduals"] = result.residuals
                found["valuesLeaveOneOutResiduals"], found["valuesLeaveOneOutErrors"] = result.leave_one_out
            expected.pop("history Block")
        if "Period" in properties:
            found["valuesCoherence"] = result.coherence
        if function == "mumford_shah":
            found["Edges"] = result.edges
        if function == "tensor_diffusion" and properties.get("DiffusionAxes"):
            found["DiffusionAxes"] = result.axes
        if function == "harmonic_map":
            found["points"] = result.points
        if function not in ("curvature", "denoise_mesh", "derivatives", "direction_field", "interpolate",
                            "relief", "segment"):
            found.update({"history " + key: column for key, column in result.history.items()
                          if key != "Seconds"})
        self.assertEqual(set(expected) - {"points", "history Step"}, set(found) - {"points"})
        for key, array in found.items():
            if not key.startswith("history"):
                self.assertEqual(expected[key].dtype, array.dtype, key)
            np.testing.assert_array_equal(expected[key], array, err_msg=key)

    def compare_distance(self, arrays, properties, expected):
        rows = np.flatnonzero(arrays["marked"])
        given = {key: array for key, array in arrays.items() if key != "marked"}
        given.update(keywords_of("distance", properties))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # sources outside do not count
            found = sd.nearest_sources(self.surface, rows, **given)
            np.testing.assert_array_equal(sd.distance(self.surface, rows, **given), found.distance)
        has_speed = "speed" in given or "along_speed" in given
        np.testing.assert_array_equal(expected["ArrivalTime" if has_speed else "Distance"], found.distance)
        np.testing.assert_array_equal(
            expected["NearestSource"], np.where(found.source < 0, 0, arrays["marked"][rows][found.source]))

    def compare_random_field(self, arrays, properties, expected):
        found = sd.random_field(self.surface, **keywords_of("random_field", properties), **arrays)
        given = expected["RandomField"]
        np.testing.assert_array_equal(given.reshape(len(given), -1), found)

    def regions(self, result, arrays):
        found = {"RegionId": result.values, "RegionProbability": result.probabilities,
                 "history Region": np.arange(1, 1 + len(result.areas)),
                 "history Area": result.areas, "history BoundaryLength": result.boundary_lengths,
                 "history Components": result.components}
        if "values" in arrays:
            given = arrays["values"]
            means = result.means[result.values - 1].reshape(-1, *given.shape[1:])
            found["valuesSegmented"] = np.where(
                result.values.reshape(-1, *[1] * (given.ndim - 1)) == 0, given, means)
        return found


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv)
