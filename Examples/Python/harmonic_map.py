# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Denoise the normals of a surface: figure 7 of the paper.

    harmonic_map.py [surface.off or .vtp ...]

The normals diffuse as unit vectors by the harmonic map flow

    u_t = div(g grad u) + u g |grad u|^2,   u(0) = the noisy normals,   g = |grad u|^(p - 2).

Exponent p = 2 smooths evenly; p = 1 preserves creases, as the mouth and the eyes show. Only the
normals change, and with them the shading; the points do not move. For each exponent the program
draws and reports the time with the smallest median error. It writes one picture per surface,
harmonic_map_<name>.png.

Without arguments it takes a head and a camel of libcgal-demo from the folder
SURFACEDIFFUSION_MESH_DIR, or a generated surface if that is not set.

Try next: SetExponent(1.5), between the two; UsePaperScheme(), which looks the same but whose energy
may increase; MoveVerticesOn() on a surface with noisy points, which denoises the surface itself.
"""
import os
import sys
from pathlib import Path

import numpy as np
from pictures import Panel, display_missing, save_picture
from surface_data import array_of, pebble, points_of, read_mesh, with_arrays
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals

from vtkSurfaceDiffusion import vtkHarmonicMapFilter

# For each surface: view direction, up direction, and the ball that the close-up shows: its centre
# as fractions of the bounding box and its radius as a fraction of the longest side.
VIEWS = {
    "mannequin-devil": ((0.25, -1, 0), (0, 0, 1), (0.5, 0.1, 0.5), 0.2),
    "camel": ((1, 0, 0.1), (0, 1, 0), (0.5, 0.87, 0.86), 0.16),
}
ANY_VIEW = ((0.3, 0.2, 1), (0, 1, 0), (0.5, 0.6, 0.9), 0.25)
CLAY = (196, 184, 168)
NOISE = 0.2  # standard deviation of each component: about 14 degrees


def normals_of(surface):
    maker = vtkPolyDataNormals()
    maker.SetInputData(surface)
    maker.SplittingOff()
    maker.Update()
    return vtk_to_numpy(maker.GetOutput().GetPointData().GetNormals()).astype(float)


def shaded_by(surface, normals):
    """The surface in one colour, with the given normals."""
    colour = np.tile(np.uint8(CLAY), (surface.GetNumberOfPoints(), 1))
    shaded = with_arrays(surface, Normals=normals, colour=colour)
    shaded.GetPointData().SetActiveNormals("Normals")
    return shaded


def errors(normals, clean):
    """The angles between two arrays of unit vectors, in degrees."""
    return np.degrees(np.arccos(np.clip((normals * clean).sum(axis=1), -1, 1)))


def regularised(surface, exponent, clean):
    """The normals with the smallest median error, their time, and the run time in seconds."""
    harmonic = vtkHarmonicMapFilter()
    harmonic.SetInputData(surface)
    harmonic.SetExponent(exponent)
    harmonic.SetTimeStep(0.02)
    harmonic.SetNumberOfTimeSteps(20)
    harmonic.GenerateTimeStepsOn()
    harmonic.UpdateInformation()
    information = harmonic.GetOutputInformation(0)
    best = None
    for time in information.Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()):
        harmonic.UpdateTimeStep(time)
        normals = array_of(harmonic.GetOutput(), "NormalsHarmonic").copy()
        error = np.median(errors(normals, clean))
        if best is None or error < best[0]:
            best = (error, normals, time)
    history = harmonic.GetOutputDataObject(1)
    seconds = vtk_to_numpy(history.GetColumnByName("Seconds")).sum()
    return best[1], best[2], seconds


def draw(surface, name):
    clean = normals_of(surface)
    noisy = clean + np.random.default_rng(1).normal(0, NOISE, clean.shape)
    noisy /= np.linalg.norm(noisy, axis=1, keepdims=True)
    print(f"{name}: {surface.GetNumberOfPoints()} vertices; angle errors in degrees")
    view, up, middle, radius = VIEWS.get(name, ANY_VIEW)
    low, high = points_of(surface).min(axis=0), points_of(surface).max(axis=0)
    ball = (low + np.array(middle) * (high - low), radius * (high - low).max())

    columns = [("noisy", noisy, 0, 0)]
    for p in (2, 1):
        columns.append((f"p = {p}", *regularised(shaded_by(surface, noisy), p, clean)))
    panels = []
    for title, normals, time, seconds in columns:
        error = errors(normals, clean)
        print(f"  {title:6} mean {error.mean():5.2f}, median {np.median(error):5.2f}, "
              f"largest {error.max():5.1f}, time {time:.2f} h^p, "
              f"20 steps in {seconds:.2f} s")
        panels.append(Panel(shaded_by(surface, normals), "colour", title,
                            f"mean error {error.mean():.1f} degrees", view, up))
    for panel in panels[:3]:
        panels.append(Panel(panel.surface, "colour", "", "", view, up, ball=ball))
    if display_missing():
        print("  no picture: there is no display")
    else:
        save_picture(f"harmonic_map_{name}.png", panels, 3, (360, 360))


def main():
    folder = os.environ.get("SURFACEDIFFUSION_MESH_DIR")
    files = sys.argv[1:] or (
        [Path(folder) / f"{name}.off" for name in ("mannequin-devil", "camel")] if folder else [])
    for file in files:
        draw(read_mesh(file), Path(file).stem)
    if not files:
        draw(pebble(), "pebble")


if __name__ == "__main__":
    main()
