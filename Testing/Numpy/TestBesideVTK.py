# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The package surfacediffusion and the module vtkSurfaceDiffusion in one environment: the functions of
PyVista meshes give the bits of the classes."""

import subprocess
import sys
import unittest
import warnings

try:
    import pyvista
    import vtkSurfaceDiffusion
except ImportError as problem:
    print(f"skipped: {problem}")
    sys.exit(77)

import numpy as np

import filter_classes
import surfacediffusion as sd
import surfacediffusion.pyvista as functions

BOTH = """
import hashlib
import {0}
import {1}
import numpy as np
import pyvista
from surfacediffusion.pyvista import heat
mesh = pyvista.Icosphere(nsub=4)
mesh["f"] = np.sin(9 * mesh.points[:, 0])
filter = vtkSurfaceDiffusion.vtkFVMHeatFilter()
filter.SetInputDataObject(mesh)
filter.SetInputArrayToProcess(0, 0, 0, 0, "f")
filter.SetFWHM(0.3)
{2}
for array in arrays:
    print(hashlib.sha256(array.tobytes()).hexdigest())
"""
CLASSES = "filter.Update(); {} = pyvista.wrap(filter.GetOutput())['fDiffused']"
FUNCTIONS = "{} = heat(mesh, 'f', fwhm=0.3)['fDiffused']"

#: Index and keyword of each input array
INDEX = {"array": 0, "mask": 1, "direction": 2, "hints": 2, "fixed": 3, "rates": 4, "fidelity": 5,
         "seeds": 6, "terms": 7}


def rough_ball():
    """Quadrilaterals and triangles beside lines and vertices, noise, and arrays of many kinds."""
    random = np.random.default_rng(3)
    ball = pyvista.Sphere(radius=2.0, theta_resolution=24, phi_resolution=20)
    points = ball.points * random.normal(1.0, 0.01, (ball.n_points, 1)) * [1.0, 1.3, 0.8]
    triangles = ball.faces.reshape(-1, 4)[:, 1:]
    quads, rest, used = [], [], set()
    edges = {}
    for number, (a, b, c) in enumerate(triangles.tolist()):
        for start, end, opposite in ((a, b, c), (b, c, a), (c, a, b)):
            twin = edges.get((end, start))
            if twin and number % 4 == 0 and not used & {number, twin[0]}:
                used |= {number, twin[0]}
                quads += [4, start, twin[1], end, opposite]
            edges[start, end] = (number, opposite)
    for number, corners in enumerate(triangles.tolist()):
        if number not in used:
            rest += [3, *corners]
    mesh = pyvista.PolyData(points.astype(np.float32), faces=np.array(quads + rest),
                            lines=[3, 0, 5, 9], verts=[1, 7, 1, 8])
    n, m = mesh.n_points, mesh.n_cells
    x, y, z = mesh.points.T
    middle = mesh.cell_centers().points
    mesh["thickness"] = (np.sign(x) + 0.2 * random.normal(size=n)).astype(np.float32)
    mesh["bold"] = random.normal(size=(n, 5))
    mesh["paint"] = random.integers(0, 256, (n, 4), np.uint8)
    mesh["label"] = random.integers(-9, 9, n)
    mesh["torn"] = np.where(z > 1.2, np.nan, y)
    mesh["hole"] = (z > 1.0).astype(np.uint8)
    mesh["around"] = np.stack([-y, x, 0 * z], axis=1)
    mesh["seeds"] = np.where(z > 1.3, 2, 0)
    mesh["terms"] = random.normal(size=(n, 3))
    mesh.cell_data["pressure"] = middle[:, 0] + random.normal(size=m)
    mesh.cell_data["wall"] = random.integers(0, 256, (m, 3), np.uint8)
    mesh.cell_data["shut"] = (middle[:, 1] > 1.5).astype(np.int16)
    mesh.cell_data["flow"] = np.cross([0.0, 0.0, 1.0], middle)
    mesh.cell_data["rates"] = np.tile([21.0, 10.0, 2.6, 1.0], (m, 1))
    mesh.set_active_scalars("thickness")
    return mesh


#: With each kind of data; TestSameBits.py compares all functions.
CASES = [
    ("heat", {"array": "thickness"}, {"FWHM": 0.8}),
    ("heat", {"array": "bold", "mask": "hole"}, {"TimeStep": 2.0}),
    ("heat", {"array": "paint", "direction": "flow"}, {"TimeStep": 1.0, "AcrossDiffusivity": 0.1}),
    ("heat", {"array": "label", "fixed": "shut"}, {"FWHM": 0.5}),
    ("heat", {"array": "torn"}, {"Mode": "SteadyState", "HoldKnownValues": True}),
    ("heat", {"array": "pressure"}, {"FWHM": 0.8, "ResultOnCells": False}),
    ("heat", {"array": "pressure", "mask": "shut"},
     {"FWHM": 0.8, "MaskMode": "Exclude", "ResultArrayName": "inside"}),
    ("heat", {"array": "wall"}, {"TimeStep": 1.0}),
    ("harmonic_map", {}, {"MoveVertices": True}),
    ("segment", {"terms": "terms", "seeds": "seeds"}, {"NumberOfRegions": 3}),
    ("turing_texture", {"rates": "rates", "direction": "flow"}, {"NumberOfTimeSteps": 20, "ColorOutput": True}),
    ("direction_field", {"hints": "around"}, {"Method": "Hints"}),
]


def run_class(name, mesh, arrays, properties):
    """The output of the filter."""
    algorithm = getattr(vtkSurfaceDiffusion, name)()
    for keyword, array in arrays.items():
        algorithm.SetInputArrayToProcess(INDEX[keyword], 0, 0, int(array in mesh.cell_data), array)
    for key, value in properties.items():
        if isinstance(value, str) and not key.endswith("Name"):
            getattr(algorithm, f"Set{key}To{value}")()
        else:
            getattr(algorithm, f"Set{key}")(value)
    algorithm.SetInputDataObject(mesh)
    algorithm.Update()
    return pyvista.wrap(algorithm.GetOutputDataObject(0))


class BesideVTK(unittest.TestCase):
    def assert_same(self, found, expected):
        self.assertEqual(found.points.dtype, expected.points.dtype)
        np.testing.assert_array_equal(found.points, expected.points)
        np.testing.assert_array_equal(found.faces, expected.faces)
        for mine, theirs in ((found.point_data, expected.point_data),
                             (found.cell_data, expected.cell_data)):
            self.assertEqual(set(mine.keys()), set(theirs.keys()))
            for name in theirs.keys():
                self.assertEqual(mine[name].dtype, theirs[name].dtype, name)
                np.testing.assert_array_equal(mine[name], theirs[name], err_msg=name)
            for role in ("Scalars", "Vectors", "Normals"):
                self.assertEqual(getattr(mine, f"active_{role.lower()}_name"),
                                 getattr(theirs, f"active_{role.lower()}_name"), role)

    def test_functions_of_meshes_give_the_bits_of_the_classes(self):
        for function, arrays, properties in CASES:
            with self.subTest(function=function, arrays=arrays, properties=properties):
                mesh = rough_ball()
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", sd.SurfaceDiffusionWarning)
                    found = getattr(functions, function)(mesh, **arrays, **properties)
                name = filter_classes.CLASSES[function]
                self.assert_same(found, run_class(name, mesh, arrays, properties))

    def test_blocks_give_the_bits_of_the_classes(self):
        blocks = pyvista.MultiBlock([rough_ball(), None, rough_ball().scale(3.0, inplace=False)])
        for array in ("thickness", "pressure"):
            found = functions.heat(blocks, array, time_step=2.0)
            algorithm = vtkSurfaceDiffusion.vtkFVMHeatFilter()
            algorithm.SetInputDataObject(blocks)
            algorithm.SetInputArrayToProcess(0, 0, 0, int(array == "pressure"), array)
            algorithm.SetTimeStep(2.0)
            algorithm.Update()
            expected = pyvista.wrap(algorithm.GetOutputDataObject(0))
            self.assertIsNone(found[1])
            for block in (0, 2):
                self.assert_same(found[block], expected[block])

    def test_both_orders_of_import_give_the_same_results(self):
        outputs = set()
        for first, second in (("surfacediffusion", "vtkSurfaceDiffusion"),
                              ("vtkSurfaceDiffusion", "surfacediffusion")):
            for run in (CLASSES, FUNCTIONS), (FUNCTIONS, CLASSES):
                lines = [line.format(name) for line, name in zip(run, "ab")]
                code = BOTH.format(first, second, "\n".join(lines) + "\narrays = a, b")
                outputs.add(subprocess.run([sys.executable, "-c", code], check=True, text=True,
                                           capture_output=True).stdout)
        self.assertEqual(len(outputs), 1)
        self.assertEqual(len(set(outputs.pop().split())), 1)

    def test_classes_are_found_by_their_former_name_with_a_warning(self):
        with self.assertWarnsRegex(DeprecationWarning, "from vtkSurfaceDiffusion") as caught:
            from surfacediffusion import vtkFVMHeatFilter
        self.assertEqual(caught.filename, __file__)
        self.assertIs(vtkFVMHeatFilter, vtkSurfaceDiffusion.vtkFVMHeatFilter)
        with self.assertRaises(ImportError):
            from surfacediffusion import vtkNoSuchFilter  # noqa: F401


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv)
