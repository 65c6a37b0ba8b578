# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The functions on the coarse and odd surfaces of Testing/Surfaces, beside dense linear algebra."""

import importlib.util
import inspect
import pathlib
import sys
import unittest
import warnings

import numpy as np

import surfacediffusion as sd

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "Surfaces"))
from coarse import read_surfaces

try:
    import pyvista

    import surfacediffusion.pyvista as of_meshes
except ImportError:
    of_meshes = None

#: Functions without a surface among their arguments, and those that need scipy where there is none.
OF_OTHERS = {"estimate_fwhm_img", "smooth_img", "get_number_of_threads", "set_number_of_threads", "sphere",
             "on_faces", "on_points"}
if not importlib.util.find_spec("scipy"):
    OF_OTHERS |= {"mass_matrix", "stiffness_matrix", "gradient_matrix", "distances"}
#: Where noise belongs to coordinates.
RANDOM = {"random_field", "surrogates", "segment", "turing_texture", "turing_texture_steps"}
#: Of functions that iterate until a tolerance, relative to the largest value.
TOLERANCES = dict.fromkeys(("intrinsic_tv", "intrinsic_tv_steps", "mumford_shah", "mumford_shah_steps"), 1e-3)
TOLERANCES["geodesic_disk"] = 3e-4  # of edges of the same length, round-off says which is bisected first
SURFACES = list(read_surfaces())


def dense_matrices(points, triangles):
    """Lumped masses and the cotan stiffness matrix, term by term."""
    masses, stiffness = np.zeros(len(points)), np.zeros((len(points), len(points)))
    for corners in triangles:
        for a in range(3):
            i, j, k = corners[a], corners[(a + 1) % 3], corners[(a + 2) % 3]
            u, v = points[j] - points[i], points[k] - points[i]
            double_area = np.linalg.norm(np.cross(u, v))
            masses[i] += double_area / 6.0
            weight = 0.5 * np.dot(u, v) / double_area
            stiffness[[j, k], [j, k]] += weight
            stiffness[[j, k], [k, j]] -= weight
    return masses, stiffness


def turn(points):
    """Rotated about a skew axis."""
    axis, angle = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0), 1.0
    across = np.cross(axis, points)
    return points + np.sin(angle) * across + (1.0 - np.cos(angle)) * np.cross(axis, across)


def arguments(function, name, values, vectors, length, target=None):
    """No more than a function must have."""
    given = {"values": values, "times": values, "vectors": vectors, "sources": 0, "n": 3,
             "residuals": np.outer(values, [1, 2, -3]) ** 2, "height": 0.03 * length, "length": length,
              "target": target, "wavelength": length, "wavelengths": [length, 3 * length], "fwhm": length,
              "start": 0, "end": len(values) - 1, "points": [0, len(values) // 2, len(values) - 1],
              "center": 0, "radius": length}
    more = {"heat": ["fwhm"], "heat_steps": ["fwhm"], "random_field": ["fwhm"], "segment": ["values"]}
    parameters = [*inspect.signature(function).parameters.values()][1:]
    found = {parameter.name: given[parameter.name] for parameter in parameters
             if parameter.default is parameter.empty or parameter.name in more.get(name, [])}
    if name == "interpolate":
        found["values"] = np.where(np.arange(len(values)) % 3 == 1, np.nan, values)
    return {**found, **({"number_of_time_steps": 2} if name.endswith("_steps") else {})}


def without_frame(result):
    """What does not change with a rotation."""
    if isinstance(result, sd.States):
        result = [*result][-1]
    if hasattr(result, "collision"):  # and there the speed is NaN
        result = np.where(result.collision | result.focus, 0.0, result.speed)
    if isinstance(result, sd.Bodies):
        result = np.array([(body.area, body.volume) for body in result.table])
    if isinstance(result, sd.WeldedSurface):
        result = np.sort(result.points)
    for name in ("longest_edge", "heights", "length", "area", "speed", "variance", "pooled", "mean", "values"):
        if not hasattr(result, "toarray") and not isinstance(result, np.ndarray):
            result = getattr(result, name, result)
    if isinstance(result, tuple):
        result = result[0]
    if hasattr(result, "toarray"):
        return (result.T @ result).toarray()
    result = np.asarray(result, float)
    return np.linalg.norm(result, axis=1) if result.ndim == 2 and result.shape[1] == 3 else result


class CoarseSurfaces(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("ignore")
        self.random = np.random.default_rng(3)
        self.assertGreater(len(SURFACES), 40)

    def each(self):
        for name, points, triangles in SURFACES:
            with self.subTest(surface=name):
                yield name, points, triangles, self.random.normal(size=len(points))

    def tried(self, call):
        """Its result and whether it warned; None where one line says what is allowed."""
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                result = call()
            except ValueError as error:
                self.assertRegex(str(error), "^.*(allowed:|set ).*$")
                return None, True
        return result, bool(caught)

    def assert_known(self, array, warned):
        self.assertFalse(np.isnan(array).any() and not warned)

    def test_all_functions_give_the_same_turned(self):
        functions = {name: getattr(sd, name) for name in sd.__all__
                     if inspect.isfunction(getattr(sd, name)) and name not in OF_OTHERS}
        for shape, points, triangles, values in self.each():
            vectors, length = self.random.normal(size=points.shape), 0.3 * np.ptp(points, axis=0).max()
            surfaces = [(sd.Surface(points, triangles), vectors),
                        (sd.Surface(turn(points), triangles), turn(vectors))]
            for name, function in functions.items():
                with self.subTest(function=name):
                    found = []
                    for surface, turned in surfaces:
                        keywords = arguments(function, name, values, turned, length, surface)
                        result, warned = self.tried(lambda: without_frame(function(surface, **keywords)))
                        found.append(result)
                        if result is not None:
                            self.assert_known(result, warned)
                    if name in RANDOM or found[0] is None:
                        continue
                    if name == "direction_field" and shape.startswith("Tetrahedron"):
                        continue  # round-off decides whether its smoothed curvature has a direction
                    finite = np.isfinite(found[0])
                    largest = np.abs(found[0][finite]).max(initial=0.0)
                    np.testing.assert_allclose(found[1], found[0], rtol=0,
                                               atol=TOLERANCES.get(name, 1e-6) * largest + 1e-12)

    @unittest.skipUnless(of_meshes, "needs PyVista")
    def test_functions_of_meshes_have_results(self):
        for _, points, triangles, values in self.each():
            length = 0.3 * np.ptp(points, axis=0).max()
            for name in of_meshes.__all__:
                with self.subTest(function=name):
                    mesh = pyvista.PolyData.from_regular_faces(points, triangles)
                    mesh["v"] = values
                    given = arguments(getattr(sd, name), name, values, values, length)
                    if given.pop("values", None) is not None:
                        given["array"] = "v"
                    result, warned = self.tried(lambda: getattr(of_meshes, name)(mesh, **given))
                    for data in (result.point_data, result.cell_data) if result is not None else ():
                        for array in data.values():
                            self.assert_known(np.asarray(array, float), warned)

    def test_heat_takes_the_step_of_dense_matrices(self):
        for _, points, triangles, values in self.each():
            masses, stiffness = dense_matrices(points, triangles)
            found = sd.heat((points, triangles), values, time_step=0.7, number_of_time_steps=1,
                            time_integrator="FirstOrder", units="Absolute", tolerance=1e-13)
            want = np.linalg.solve(np.diag(masses) + 0.7 * stiffness, masses * values)
            np.testing.assert_allclose(found, want, atol=1e-9 * np.abs(values).max())

    def test_distances_are_symmetric(self):
        for _, points, triangles, _ in self.each():
            surface, count = sd.Surface(points, triangles), min(len(points), 12)
            found = np.array([sd.distance(surface, i)[:count] for i in range(count)])
            np.testing.assert_allclose(found, found.T, rtol=0, atol=1e-10 * found[np.isfinite(found)].max())


if __name__ == "__main__":
    unittest.main()
