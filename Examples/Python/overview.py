#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""One picture from each filter, before and after, on one surface.

    overview.py [surface.off or .vtp]

Each takes a few seconds. A new filter needs one function in FILTERS, which returns the panels before
and after. The program writes overview.png, and the time of each filter.
"""
import sys
import time

import numpy as np
import surface_data as data
import vtkSurfaceDiffusion as sd
from pictures import Panel, colour_table, display_missing, save_picture
from vtkmodules.vtkCommonDataModel import vtkDataObject

POINTS, CELLS = vtkDataObject.FIELD_ASSOCIATION_POINTS, vtkDataObject.FIELD_ASSOCIATION_CELLS
GREYS = [(0.12, 0.12, 0.14), (0.95, 0.95, 0.93)]
REGIONS = [(0.10, 0.45, 0.60), (0.95, 0.61, 0.15)]
EDGES = [(0.95, 0.95, 0.93), (0.75, 0.10, 0.12)]
VERTICES = 2_000


def run(filter_class, surface, array=None, mask=None, **properties):
    """The filter's output. Properties by their names in C++."""
    instance = filter_class()
    instance.SetInputData(surface)
    if array:
        instance.SetInputArrayToProcess(0, 0, 0, POINTS, array)
    if mask:
        instance.SetInputArrayToProcess(1, 0, 0, POINTS, mask)
    for name, value in properties.items():
        getattr(instance, f"Set{name}")(value)
    instance.Update()
    return instance.GetOutput()


def table_for(values, colours):
    return colour_table(*np.percentile(values, (2, 98)), colours)


def smoothed(surface):
    result = run(sd.vtkFVMHeatFilter, surface, "noisy", FWHM=5 * data.mean_edge_length(surface))
    return Panel(result, "noisy", "noise"), Panel(result, "noisyDiffused", "linear diffusion")


def denoised(surface):
    result = run(sd.vtkIntrinsicTVFilter, surface, "noisy", Mode=1, FidelityWeight=4)
    return Panel(result, "noisy", "noise"), Panel(result, "noisyTV", "total variation")


def inpainted(surface):
    missing = data.damage(surface, 0.15)
    torn = np.where(missing[:, None], np.uint8(255), data.array_of(surface, "clean"))
    surface = data.with_arrays(surface, missing=missing, torn=torn)
    result = run(sd.vtkFVMHeatFilter, surface, "torn", "missing", Mode=1, HoldKnownValues=True)
    return Panel(result, "torn", "missing data"), Panel(result, "tornDiffused", "inpainting")


def made_coherent(surface):
    result = run(sd.vtkTensorDiffusionFilter, surface, "lines", NumberOfTimeSteps=10, TimeStep=8, Model=1)
    table, name = colour_table(0, 1, GREYS), result.GetPointData().GetScalars().GetName()
    return (Panel(result, "lines", "noisy lines", table=table),
            Panel(result, name, "tensor diffusion", table=table))


def edged(surface):
    result = run(sd.vtkMumfordShahFilter, surface, "patches")
    return (Panel(result, "patches", "noisy patches", table=colour_table(-0.3, 1.3, REGIONS)),
            Panel(result, "Edges", "edges", table=colour_table(0, 1, EDGES)))


def divided(surface):
    result = run(sd.vtkSurfaceSegmentationFilter, surface, "patches")
    return (Panel(result, "patches", "noisy patches", table=colour_table(-0.3, 1.3, REGIONS)),
            Panel(result, "RegionId", "regions", table=colour_table(1, 2, REGIONS, steps=2)))


def grey(points, surface):
    """A grey surface with these points. It has no normals, so that pictures show those of its
    triangles."""
    return data.with_arrays(data.make_surface(points, data.triangles_of(surface)),
                            grey=np.full(points.shape, 210, np.uint8))


def rough(surface):
    points = data.points_of(surface)
    noise = np.random.default_rng(5).normal(size=points.shape)
    return grey(points + 0.12 * data.mean_edge_length(surface) * noise, surface)


def with_even_normals(surface):
    """Normals as colours: red, green and blue are x, y and z."""
    noisy = rough(surface)
    result = run(sd.vtkHarmonicMapFilter, noisy, TimeStep=0.05, NumberOfTimeSteps=10)
    before = run(sd.vtkHarmonicMapFilter, noisy, NumberOfTimeSteps=0)
    panels = []
    for found, title in ((before, "noisy normals"), (result, "harmonic map")):
        colours = 127.5 + 127.5 * data.array_of(found, "NormalsHarmonic")
        panels.append(Panel(data.with_arrays(surface, colours=colours.astype(np.uint8)), "colours",
                            title))
    return panels


def with_even_points(surface):
    noisy = rough(surface)
    result = run(sd.vtkSurfaceDenoisingFilter, noisy)
    return (Panel(noisy, "grey", "noisy points"),
            Panel(grey(data.points_of(result), surface), "grey", "surface denoising"))


def grown(surface):
    size = 8 * data.mean_edge_length(surface)
    random = np.random.default_rng(0).uniform(size=surface.GetNumberOfPoints())
    result = run(sd.vtkTuringTextureFilter, data.with_arrays(surface, random=random), FeatureSize=size)
    texture = data.array_of(result, "u1")
    return (Panel(result, "random", "noise", table=colour_table(0, 1, GREYS)),
            Panel(result, "u1", "texture", table=table_for(texture, GREYS)))


def directed(surface):
    random = np.random.default_rng(0).uniform(size=surface.GetNumberOfPoints())
    field = sd.vtkSurfaceDirectionFieldFilter()
    field.SetInputData(data.with_arrays(surface, random=random))
    field.SetMethodToCurvatureAligned()
    heat = sd.vtkFVMHeatFilter()
    heat.SetInputConnection(field.GetOutputPort())
    heat.SetInputArrayToProcess(0, 0, 0, POINTS, "random")
    heat.SetInputArrayToProcess(2, 0, 0, CELLS, "Direction")
    heat.SetAcrossDiffusivity(0.001)
    heat.SetTimeStep(10)
    heat.SetNumberOfTimeSteps(5)
    heat.Update()
    result = heat.GetOutput()
    smeared = data.array_of(result, "randomDiffused")
    return (Panel(result, "random", "noise", table=colour_table(0, 1, GREYS)),
            Panel(result, "randomDiffused", "direction field", table=table_for(smeared, GREYS)))


FILTERS = (smoothed, denoised, inpainted, made_coherent, edged, divided, with_even_normals,
           with_even_points, grown, directed)


def main():
    quick = len(sys.argv) < 2
    surface = data.pebble() if quick else data.refined(data.read_mesh(sys.argv[1]), VERTICES)
    random = np.random.default_rng(4)
    clean = data.stained_glass(surface)
    waves = data.waves(data.points_of(surface))
    patches = (waves > 0.3) + random.normal(scale=0.15, size=len(waves))
    lines = 0.5 + 0.5 * np.sin(6 * waves) + random.normal(scale=0.25, size=len(waves))
    surface = data.with_arrays(surface, clean=clean, noisy=data.with_noise(clean, 0.25),
                               patches=patches, lines=lines)
    pairs = []
    for make in FILTERS:
        start = time.process_time()
        pairs.append(make(surface))
        print(f"{pairs[-1][1].title:17} {time.process_time() - start:5.1f} s of processor time")
    for pair in pairs:
        for panel in pair:
            panel.view, panel.up = (0.35, 0.12, 1), (0, 1, 0)
    if display_missing():
        print("no picture: there is no display")
        return
    half = len(pairs) // 2
    rows = [[pair[when] for pair in part] for part in (pairs[:half], pairs[half:]) for when in (0, 1)]
    save_picture("overview.png", sum(rows, []), half, (190, 186))


if __name__ == "__main__":
    main()
