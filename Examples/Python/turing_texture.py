# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Grow textures on surfaces: figure 8 of the paper.

    turing_texture.py [surface.off or .vtp | --quick]

Two chemicals react and diffuse, u1 much faster than u2, and a pattern grows out of noise:

    du1/dt = D1 Lap u1 + F(u1, u2),   F = 16 - u1 u2,
    du2/dt = D2 Lap u2 + G(u1, u2),   G = u1 u2 - u2 - 12.

Lap is the Laplace-Beltrami operator, and the pictures show u1. FeatureSize sets the wavelength of
the pattern, and the ratio D1/D2 sets its kind: 5 gives spots, 18 a labyrinth, 30 a net. If D2 is
larger along a direction than across it, stripes follow the direction, here the smoothed direction
of maximum curvature. For each texture the program prints the number of connected components of {u1
> median} and their Euler number (components minus holes).

Without arguments it takes scans of libcgal-demo from the folder SURFACEDIFFUSION_MESH_DIR, or a
generated surface if that is not set. --quick: a small generated one. It writes turing_texture.png.

Try next: SetKineticsToGrayScott() and the others, with AutomaticTimeStepOn(); rates per cell (input
array 4), which let spots grow along the body; GenerateTimeStepsOn(), which makes all times of the
run available.
"""
import os
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pictures import Panel, display_missing, save_picture
from surface_data import (
    array_of, mean_edge_length, pebble, points_of, read_mesh, refined, triangles_of)
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject

from vtkSurfaceDiffusion import vtkSurfaceDirectionFieldFilter, vtkTuringTextureFilter

try:
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
except ImportError:
    print("turing_texture.py needs scipy (Debian: python3-scipy)")
    sys.exit(77)


@dataclass
class Texture:
    title: str
    ratio: float        # D1/D2, across the direction if there is one
    low: tuple          # colours
    high: tuple
    mesh: str
    view: tuple
    up: tuple
    stripes: bool = False


TEXTURES = [
    Texture("spots", 5, (0.93, 0.80, 0.55), (0.30, 0.16, 0.07), "bunny00", (0, 0, 1), (0, 1, 0)),
    Texture("labyrinth", 18, (0.13, 0.24, 0.33), (0.87, 0.90, 0.80), "refined_elephant",
            (0.4, 0.25, 1), (0, 1, 0)),
    Texture("net", 30, (0.95, 0.93, 0.86), (0.62, 0.25, 0.16), "bear", (0, 0, 1), (0, 1, 0)),
    Texture("stripes", 8, (0.96, 0.95, 0.92), (0.10, 0.10, 0.11), "camel", (1, 0.1, 0.3), (0, 1, 0),
            stripes=True),
]
VERTICES = 40_000


def grown(surface, texture, size):
    """The texture with this wavelength, the number of steps, and their run time in seconds."""
    turing = vtkTuringTextureFilter()
    turing.SetInputData(surface)
    turing.SetFeatureSize(size)
    turing.SetDiffusionRate1(2.6 * texture.ratio)
    if texture.stripes:
        field = vtkSurfaceDirectionFieldFilter()
        field.SetInputData(surface)
        field.SetMethodToCurvatureAligned()
        field.SetPrincipalDirectionToMaximum()
        field.SetSmoothingLength(size)
        field.SetHintWeight(0.0005)
        turing.SetInputConnection(field.GetOutputPort())
        turing.SetInputArrayToProcess(
            2, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "Direction")
        turing.SetDiffusionRate2(2 * 2.6)
        turing.SetDiffusionRateAcross2(2.6)
    turing.SetTimeStep(1 / 8)
    turing.SetNumberOfTimeSteps(800)
    turing.SetStopTolerance(0.03)  # until the pattern is stationary
    turing.ColorOutputOn()
    turing.SetLowColor(texture.low)
    turing.SetHighColor(texture.high)
    turing.Update()
    history = turing.GetOutputDataObject(1)
    steps = history.GetNumberOfRows() - 1
    seconds = vtk_to_numpy(history.GetColumnByName("Seconds"))
    return turing.GetOutput(), steps, seconds.sum()


def components_and_euler_number(surface, inside):
    """Both numbers of the part of the surface that the vertices inside span."""
    faces = triangles_of(surface)
    pairs = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = np.unique(np.sort(pairs, axis=1), axis=0)
    joined = edges[inside[edges].all(axis=1)]
    graph = coo_matrix((np.ones(len(joined)), joined.T), shape=(len(inside), len(inside)))
    components = len(np.unique(connected_components(graph)[1][inside]))
    euler = inside.sum() - len(joined) + inside[faces].all(axis=1).sum()
    return components, euler


def main():
    quick = sys.argv[1:] == ["--quick"]
    folder = os.environ.get("SURFACEDIFFUSION_MESH_DIR")
    files = len(sys.argv) > 1 or folder
    panels = []
    for texture in TEXTURES:
        if quick:
            surface = pebble()
        elif len(sys.argv) > 1:
            surface = read_mesh(sys.argv[1])
        elif folder:
            surface = read_mesh(Path(folder) / f"{texture.mesh}.off")
        else:
            surface = pebble()
        if not quick:
            surface = refined(surface, VERTICES / 2 if files else VERTICES / 8)
        size = max(12 * mean_edge_length(surface), np.ptp(points_of(surface), axis=0).max() / 28)
        result, steps, seconds = grown(surface, texture, size)
        u1 = array_of(result, "u1")
        components, euler = components_and_euler_number(surface, u1 > np.median(u1))
        print(f"{texture.title:9} on {surface.GetNumberOfPoints()} vertices: {components} "
              f"components, Euler number {euler}; {steps} steps in {seconds:.1f} s")
        panels.append(Panel(result, "TextureColor", texture.title,
                            f"{components} component{'s' * (components != 1)}, "
                            f"Euler number {euler}",
                            texture.view, texture.up))
    if display_missing():
        print("no picture: there is no display")
    else:
        save_picture("turing_texture.png", panels, 4, (200, 200) if quick else (400, 400))


if __name__ == "__main__":
    main()
