# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The filters as functions of PyVista meshes."""

import sys
import unittest
import warnings

try:
    import pyvista
except ImportError:
    print("PyVista is not available (SURFACEDIFFUSION_WHEEL_DIR)")
    sys.exit(77)

import numpy as np

from surfacediffusion import vtkFVMHeatFilter
from surfacediffusion.pyvista import (
    direction_field, harmonic_map, heat, intrinsic_tv, mumford_shah, segment, turing_texture,
)


def noisy_sphere(center=(0.0, 0.0, 0.0)):
    mesh = pyvista.Icosphere(nsub=4, center=center)
    z = mesh.points[:, 2] - center[2]
    mesh["f"] = z + np.random.default_rng(1).normal(scale=0.1, size=mesh.n_points)
    mesh["hole"] = (z > 0.4).astype(np.uint8)
    return mesh


class TestPyVista(unittest.TestCase):
    def test_one_line_returns_a_polydata(self):
        mesh = noisy_sphere()
        smooth = heat(mesh, "f", FWHM=0.2)
        self.assertIsInstance(smooth, pyvista.PolyData)
        self.assertEqual(smooth.active_scalars_name, "fDiffused")
        self.assertLess(np.std(smooth["fDiffused"] - mesh.points[:, 2]), 0.1 / 3)
        self.assertNotIn("fDiffused", mesh.array_names)

    def test_a_function_gives_the_same_bits_as_its_class(self):
        mesh = noisy_sphere()
        filter = vtkFVMHeatFilter()
        filter.SetInputData(mesh)
        filter.SetInputArrayToProcess(0, 0, 0, 0, "f")
        filter.SetInputArrayToProcess(1, 0, 0, 0, "hole")
        filter.SetModeToSteadyState()
        filter.HoldKnownValuesOn()
        filter.SetResultArrayName("filled")
        filter.Update()
        filled = heat(
            mesh, "f", mask="hole", Mode="SteadyState", HoldKnownValues=True,
            ResultArrayName="filled")
        np.testing.assert_array_equal(
            filled["filled"], pyvista.wrap(filter.GetOutput())["filled"])

    def test_every_filter_has_a_function(self):
        mesh = noisy_sphere()
        self.assertIn("fTV", intrinsic_tv(mesh, "f", FidelityWeight=1).point_data)
        self.assertIn("NormalsHarmonic", harmonic_map(mesh).point_data)
        edges, report = mumford_shah(mesh, "f", full_output=True)
        self.assertIn("Edges", edges.point_data)
        self.assertEqual(report.curves.n_lines > 0, report.EdgeLength > 0)
        regions, report = segment(mesh, "f", means=[-1.0, 1.0], FidelityWeight=5, full_output=True)
        self.assertEqual(set(regions["RegionId"]), {1, 2})
        self.assertEqual(report.EffectiveFidelityWeight, 5)
        self.assertGreater(report.boundaries.n_lines, 0)
        self.assertNotEqual(
            segment(mesh, "f", full_output=True)[1].EffectiveFidelityWeight, 0.3)
        moved = harmonic_map(mesh, NumberOfTimeSteps=1, MoveVertices=True)
        self.assertFalse((moved.points == mesh.points).all())
        field = direction_field(mesh, Method="Smooth")
        self.assertIn("Direction", field.cell_data)
        stripes = turing_texture(field, direction="Direction", NumberOfTimeSteps=2)
        self.assertIn("Texture", stripes.point_data)
        along = heat(field, "f", direction="Direction", AcrossDiffusivity=0)
        self.assertFalse((along["fDiffused"] == heat(mesh, "f")["fDiffused"]).all())

    def test_blocks_are_processed(self):
        blocks = pyvista.MultiBlock([noisy_sphere(), noisy_sphere(center=(2.0, 0.0, 0.0))])
        smooth = heat(blocks, "f")
        self.assertIsInstance(smooth, pyvista.MultiBlock)
        for block in smooth:
            self.assertIn("fDiffused", block.point_data)

    def test_errors_name_the_property_or_array(self):
        mesh = noisy_sphere()
        with self.assertRaisesRegex(ValueError, "TimeStep is -1"):
            heat(mesh, "f", TimeStep=-1)
        with self.assertRaisesRegex(ValueError, "InputArray"):
            heat(mesh, "nothing")
        with self.assertRaisesRegex(TypeError, "no property Fwhm"):
            heat(mesh, "f", Fwhm=1)
        with self.assertRaisesRegex(TypeError, "no property Mode that can be 'Steady'"):
            heat(mesh, "f", Mode="Steady")


    def test_a_mesh_that_is_no_surface_is_a_type_error_with_the_remedy(self):
        grid = noisy_sphere().cast_to_unstructured_grid()
        for mesh in (grid, pyvista.MultiBlock([noisy_sphere(), grid]), pyvista.ImageData()):
            with self.assertRaisesRegex(TypeError, "extract_surface"):
                heat(mesh, "f")
        smooth = heat(grid.extract_surface(), "f")
        self.assertIn("fDiffused", smooth.point_data)

    def test_empty_blocks_are_kept(self):
        field = direction_field(noisy_sphere())
        blocks = pyvista.MultiBlock([None, pyvista.PolyData(), field])
        smooth = heat(blocks, "f", direction="Direction", AcrossDiffusivity=0)
        self.assertIsNone(smooth[0])
        self.assertEqual(smooth[1].n_points, 0)
        self.assertIn("fDiffused", smooth[2].point_data)

    def test_warnings_are_python_warnings(self):
        mesh = noisy_sphere()
        mesh["clean"] = np.zeros(mesh.n_points)
        with self.assertWarnsRegex(UserWarning, "^the mask changes nothing") as caught:
            heat(mesh, "f", mask="clean")
        self.assertEqual(caught.filename, __file__)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            heat(mesh, "f")

    def test_messages_begin_with_the_property(self):
        mesh = noisy_sphere()
        with self.assertRaisesRegex(ValueError, "^TimeStep is -1; allowed"):
            heat(mesh, "f", TimeStep=-1)

    def test_cell_arrays_are_data_too(self):
        mesh = noisy_sphere().point_data_to_cell_data()
        smooth = heat(mesh, "f")
        self.assertEqual(smooth.cell_data["fDiffused"].shape, mesh.cell_data["f"].shape)
        areas = mesh.compute_cell_sizes().cell_data["Area"]
        np.testing.assert_allclose(
            areas @ smooth.cell_data["fDiffused"], areas @ mesh.cell_data["f"], rtol=1e-12)
        self.assertIn("fDiffused", heat(mesh, "f", ResultOnCells=False).point_data)

    def test_times_give_a_mesh_each(self):
        mesh = noisy_sphere()
        states = heat(mesh, "f", times=[0, 2, 1, 10], Solver="Direct")
        np.testing.assert_array_equal(states[0]["fDiffused"], mesh["f"])
        for steps, state in ((2, states[1]), (1, states[2]), (10, states[3])):
            np.testing.assert_array_equal(
                state["fDiffused"],
                heat(mesh, "f", NumberOfTimeSteps=steps, Solver="Direct")["fDiffused"])

    def test_the_report_has_the_history_and_the_read_only_values(self):
        mesh = noisy_sphere()
        smooth, report = intrinsic_tv(mesh, "f", AutomaticFidelity=True, full_output=True)
        self.assertIn("fTV", smooth.point_data)
        self.assertGreater(report.EffectiveFidelityWeight, 0.0)
        self.assertGreater(report.MeanEdgeLength, 0.0)
        self.assertEqual(len(report.history["Energy"]), 11)
        np.testing.assert_allclose(report.history["Total_0"], report.history["Total_0"][0],
                                   atol=1e-10)
        states, report = turing_texture(
            mesh, times=[0, 0.125], full_output=True, NumberOfTimeSteps=4)
        self.assertEqual(len(states), 2)
        self.assertGreater(report.Wavelength, 0.0)
        _, report = direction_field(mesh, full_output=True)
        self.assertGreater(report.MeanEdgeLength, 0.0)
        self.assertFalse(hasattr(report, "history"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
