#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Compute the curvature of a part with noise, at the scale of its mesh and at two larger ones.

    curvature.py [part.off]

The program moves the points of a part by noise of a tenth of the mean edge length, and draws the mean
curvature of the clean part, that of the noisy one at the scale of its mesh, and with a FWHM of 4 and of
8 edges. It fails unless the widths reduce the error. It writes curvature.png.

Try next: SetFWHM(0.0) on the clean part, and the other arrays, such as ShapeIndex.
"""
import os
import sys
from pathlib import Path

import numpy as np
from pictures import COLD_TO_WARM, Panel, colour_table, display_missing, save_picture
from surface_data import (
    array_of, make_surface, mean_edge_length, pebble, points_of, read_mesh, refined, triangles_of,
    with_arrays,
)

from vtkSurfaceDiffusion import vtkSurfaceCurvatureFilter


def mean_curvature(surface, fwhm=0.0):
    """H at the points, in 1/length."""
    model = vtkSurfaceCurvatureFilter()
    model.SetInputData(surface)
    model.SetFWHM(fwhm)
    model.Update()
    return array_of(model.GetOutput(), "MeanCurvature").copy()


def draw(part, name, view):
    h = mean_edge_length(part)
    random = np.random.default_rng(0)
    points = points_of(part)
    noisy = make_surface(points + random.normal(scale=0.1 * h, size=points.shape), triangles_of(part))
    clean = mean_curvature(part, 4 * h)
    if clean.mean() < 0:  # the triangles are clockwise from outside
        clean, sign = -clean, -1
    else:
        sign = 1
    limit = np.percentile(np.abs(clean), 97)
    table = colour_table(-limit, limit, COLD_TO_WARM)
    panels = [Panel(with_arrays(part, shown=clean), "shown", f"{name}, FWHM 4 h", "without noise",
                    view=view, table=table)]
    errors = []
    for width in (0, 4, 8):
        found = sign * mean_curvature(noisy, width * h)
        errors.append(np.median(np.abs(found - clean)) / limit)
        print(f"  FWHM {width} h: median error {100 * errors[-1]:.1f} % of the colour bar's end")
        panels.append(Panel(with_arrays(noisy, shown=found), "shown",
                            f"FWHM {width} h" if width else "scale of the mesh", "noise 0.1 h", view=view,
                            table=table))
    assert errors[1] < 0.5 * errors[0], errors
    return panels


def main():
    folder = os.environ.get("SURFACEDIFFUSION_MESH_DIR")
    if len(sys.argv) > 1:
        name, part, view = Path(sys.argv[1]).stem, read_mesh(Path(sys.argv[1])), (1, 0.6, 1)
    elif folder:
        name, view = "fandisk", (1, 0.6, 1)
        part = read_mesh(Path(folder) / "fandisk_large.off")
    else:
        name, part, view = "pebble", refined(pebble(), 10_000), (0, 0, 1)
    panels = draw(part, name, view)
    if display_missing():
        print("  no picture: there is no display")
    else:
        save_picture("curvature.png", panels, 4, (380, 360))


if __name__ == "__main__":
    main()
