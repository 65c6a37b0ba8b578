#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Draw the first ten modes of the Laplacian of a surface that are not constant.

    eigenmodes.py [surface.off or .vtp]

The modes are those of the package for numpy, which has to be installed for the same Python. The program
writes eigenmodes.png. It fails unless the modes are orthonormal.

Try next: more modes, whose waves become shorter, and a mask.
"""
import os
import sys
from pathlib import Path

import numpy as np
from pictures import COLD_TO_WARM, Panel, colour_table, display_missing, save_picture
from surface_data import pebble, points_of, read_mesh, refined, triangles_of, with_arrays

from surfacediffusion import Surface, eigenmodes


def main():
    folder = os.environ.get("SURFACEDIFFUSION_MESH_DIR")
    if len(sys.argv) > 1:
        surface, view = read_mesh(Path(sys.argv[1])), (0, 0, 1)
    elif folder:
        surface, view = read_mesh(Path(folder) / "fandisk_large.off"), (1, 0.6, 1)
    else:
        surface, view = refined(pebble(), 10_000), (0, 0, 1)
    mesh = Surface(points_of(surface), triangles_of(surface))
    found = eigenmodes(mesh, 11)
    corners = mesh.points[mesh.triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    masses = np.bincount(mesh.triangles.ravel(), np.repeat(areas / 6, 3), mesh.n_points)
    products = found.modes.T @ (masses[:, None] * found.modes)
    assert np.abs(products - np.eye(11)).max() < 1e-8, products
    size = np.sqrt(masses.sum())
    panels = []
    for k in range(1, 11):
        limit = np.abs(found.modes[:, k]).max()
        panels.append(Panel(
            with_arrays(surface, shown=found.modes[:, k]), "shown", f"mode {k}",
            f"wavelength {2 * np.pi / np.sqrt(found.eigenvalues[k]) / size:.2f} of the size", view=view,
            table=colour_table(-limit, limit, COLD_TO_WARM)))
    if display_missing():
        print("  no picture: there is no display")
    else:
        save_picture("eigenmodes.png", panels, 5, (300, 300))


if __name__ == "__main__":
    main()
