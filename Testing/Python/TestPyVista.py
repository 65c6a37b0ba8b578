# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The filters as functions of PyVista meshes."""

import sys
import unittest

try:
    import pyvista
except ImportError:
    print("PyVista is not available (SURFACEDIFFUSION_WHEEL_DIR)")
    sys.exit(77)

import numpy as np

from surfacediffusion import vtkFVMHeatFilter
from surfacediffusion.pyvista import (
    direction_field, harmonic_map, heat, intrinsic_tv, turing_texture,
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


if __name__ == "__main__":
    unittest.main()
