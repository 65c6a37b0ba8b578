#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Denoise data on a mesh in PyVista, in one line.

    with_pyvista.py [mesh array]

heat(mesh, array, ...) takes a pyvista.PolyData and returns a new one, as intrinsic_tv(),
harmonic_map(), turing_texture() and direction_field() do. The program writes with_pyvista.png if
there is a display.

Try next: intrinsic_tv(mesh, name), which preserves the edges of the data; denoise_mesh(mesh),
which denoises the mesh itself. pip install ".[pyvista]" in a clone of the repository installs the package.
"""

import os
import sys

try:
    import pyvista
except ImportError:
    print("PyVista is not installed")
    sys.exit(77)

import numpy as np

from surfacediffusion.pyvista import heat

if len(sys.argv) > 2:
    mesh, name = pyvista.read(sys.argv[1]), sys.argv[2]
else:
    mesh, name = pyvista.Icosphere(nsub=5), "height"
    mesh[name] = mesh.points[:, 2] + np.random.default_rng(1).normal(scale=0.2, size=mesh.n_points)

smooth = heat(mesh, name, fwhm=0.1 * mesh.length)

result = smooth[name + "Diffused"]
print(f"{name}: standard deviation {mesh[name].std():.3f}, smoothed {result.std():.3f}")
if os.environ.get("DISPLAY"):
    plotter = pyvista.Plotter(shape=(1, 2), off_screen=True, window_size=(1000, 500))
    for column, (surface, array) in enumerate(((mesh, name), (smooth, name + "Diffused"))):
        plotter.subplot(0, column)
        plotter.add_mesh(surface, scalars=array, clim=mesh.get_data_range(name), copy_mesh=True)
    plotter.screenshot("with_pyvista.png")
