# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Find the edges of a painted surface, and smooth and inpaint the paint between them.

    mumford_shah.py [surface.off or .vtp]

The filter minimises the functional of Mumford and Shah in the approximation of Ambrosio and
Tortorelli: a colour u that is smooth between edges, and v, which is near 0 on edges. Its third
output has the edges as curves. The program paints a surface in patches, adds noise and scratches,
and draws two rows:

- the noisy paint, its edges (1 - v with the curves), and u beside the results of linear diffusion
  and of total variation, each with the fidelity weight of the largest PSNR;
- the scratched paint, filled in through its edges, beside linear diffusion and total variation.

Linear diffusion blurs the edges. Total variation is as close to the clean paint, but has no edges to
show. The program checks the gain of u, and that the curves are as long as the borders of the
patches. It writes mumford_shah.png. Without an argument it takes an elephant of libcgal-demo from the folder
SURFACEDIFFUSION_MESH_DIR, or a generated surface if that is not set.

Try next: AutomaticThresholdOn(), which finds both from the data; SetEdgeThreshold(0.4), which keeps fewer
edges; SetSmoothingLength(16), which smooths more.
"""
import os
import sys
from pathlib import Path

import numpy as np
from pictures import Panel, colour_table, display_missing, save_picture
from surface_data import (
    array_of, damage, mean_edge_length, pebble, points_of, read_mesh, refined, spread_points,
    triangles_of, with_arrays,
)
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkTubeFilter
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from vtkSurfaceDiffusion import vtkFVMHeatFilter, vtkIntrinsicTVFilter, vtkMumfordShahFilter

NOISE = 0.04  # standard deviation, of the range of the colours
VIEW = {"elephant": ((0.75, 0.12, 0.65), (0, 1, 0))}


def paint(surface, patches=12, seed=3):
    """Patches around centres, each of one colour, with a shade that varies slowly."""
    points = points_of(surface)
    centres = points[spread_points(points, patches)]
    patch = np.argmin(((points[:, None] - centres) ** 2).sum(axis=2), axis=1)
    palette = np.random.default_rng(seed).uniform(0.2, 0.8, (500, 3))
    colours = palette[spread_points(palette, patches)]  # as different as possible
    low, high = points.min(axis=0), points.max(axis=0)
    shade = 0.2 * np.sin(5 * (points - low) / (high - low).max()).mean(axis=1)
    return colours[patch] + shade[:, None], patch, centres


def border_length(surface, patch, centres):
    """The length of the borders between patches, where two centres are equally far."""
    points = points_of(surface)
    faces = triangles_of(surface)
    length = 0.0
    for face in faces[(patch[faces] != patch[faces][:, :1]).any(axis=1)]:
        crossings = []
        for i, j in ((face[a], face[(a + 1) % 3]) for a in range(3)):
            if patch[i] != patch[j]:
                # the difference of the squared distances is linear along an edge
                own, other = centres[patch[i]], centres[patch[j]]
                start, end = (((points[k] - own) ** 2).sum() - ((points[k] - other) ** 2).sum()
                              for k in (i, j))
                crossings.append(points[i] + start / (start - end) * (points[j] - points[i]))
        middle = np.mean(crossings, axis=0)
        length += sum(np.linalg.norm(crossing - middle) for crossing in crossings)
    return length


def psnr(values, clean):
    return -10 * np.log10(np.mean((values - clean) ** 2))


def result_of(model, surface, array, mask=None):
    model.SetInputData(surface)
    model.SetInputArrayToProcess(0, 0, 0, 0, array)
    if mask:
        model.SetInputArrayToProcess(1, 0, 0, 0, mask)
    model.Update()
    return array_of(model.GetOutput(), model.GetOutput().GetPointData().GetScalars().GetName())


def best(make, weights, surface, clean):
    """The result with the largest PSNR over the fidelity weights."""
    found = []
    for weight in weights:
        model = make()
        model.SetFidelityWeight(weight)
        values = result_of(model, surface, "noisy").copy()
        found.append((psnr(values, clean), values))
    return max(found, key=lambda pair: pair[0])[1]


def steady_heat():
    model = vtkFVMHeatFilter()
    model.SetModeToSteadyState()
    return model


def minimiser():
    model = vtkIntrinsicTVFilter()
    model.AutomaticFidelityOff()  # all weights are tried
    model.SetModeToSteadyState()
    model.SetStopTolerance(1e-2)
    return model


def edge_filter(threshold):
    model = vtkMumfordShahFilter()
    model.AutomaticThresholdOff()
    model.SetEdgeThreshold(threshold)
    return model


def with_curves(surface, values, curves, radius, ink=1.2):
    """The surface coloured by `values` with tubes of the value `ink` along the curves."""
    tubes = vtkTubeFilter()
    tubes.SetInputData(curves)
    tubes.SetRadius(radius)
    tubes.SetNumberOfSides(6)
    tubes.Update()
    return with_marks(surface, values, tubes.GetOutput(), ink)


def with_marks(surface, values, marks, ink):
    """The surface coloured by `values` with another one of the value `ink`."""
    parts = vtkAppendPolyData()
    on_marks = np.full((marks.GetNumberOfPoints(), *values.shape[1:]), ink, values.dtype)
    for part, shown in ((surface, values), (marks, on_marks)):
        bare = vtkPolyData()
        bare.CopyStructure(part)
        array = numpy_to_vtk(np.ascontiguousarray(shown), deep=True)
        array.SetName("shown")
        bare.GetPointData().AddArray(array)
        parts.AddInputData(bare)
    parts.Update()
    return parts.GetOutput()


def coloured(surface, values):
    return with_arrays(surface, shown=np.uint8(np.clip(values * 255 + 0.5, 0, 255)))


def draw(surface, name):
    clean, patch, centres = paint(surface)
    noisy = clean + np.random.default_rng(1).normal(0, NOISE * np.ptp(clean), clean.shape)
    scratched = damage(surface, 0.15, scratches=1, width=5) != 0
    surface = with_arrays(surface, clean=clean, noisy=noisy, hole=scratched.astype(np.uint8),
                          spoiled=np.where(scratched[:, None], 0.5, clean))
    view, up = VIEW.get(name, ((0.3, 0.2, 1), (0, 1, 0)))

    edges = edge_filter(0.25)
    u = result_of(edges, surface, "noisy").copy()
    curves = vtkPolyData()
    curves.DeepCopy(edges.GetOutputDataObject(2))
    v = array_of(edges.GetOutput(), "Edges").copy()
    linear = best(steady_heat, (3.0, 6.0, 12.0), surface, clean)
    tv = best(minimiser, (11.0, 16.0, 23.0), surface, clean)
    exact = border_length(surface, patch, centres)
    seconds = vtk_to_numpy(edges.GetOutputDataObject(1).GetColumnByName("Seconds")).sum()
    print(f"{name}: {surface.GetNumberOfPoints()} vertices, {curves.GetNumberOfLines()} edges of "
          f"length {edges.GetEdgeLength():.3f}; borders {exact:.3f}; {seconds:.1f} s")
    denoised = {"noisy": noisy, "edges": u, "linear": linear, "total variation": tv}
    levels = {title: psnr(values, clean) for title, values in denoised.items()}
    print("  denoised: " + ", ".join(f"{title} {dB:.1f} dB" for title, dB in levels.items()))

    hole = edge_filter(0.15)
    filled = {"edges": result_of(hole, surface, "spoiled", "hole").copy()}
    harmonic = steady_heat()
    harmonic.HoldKnownValuesOn()
    filled["linear"] = result_of(harmonic, surface, "spoiled", "hole").copy()
    held = minimiser()
    held.HoldKnownValuesOn()
    filled["total variation"] = result_of(held, surface, "spoiled", "hole").copy()
    inside = {title: psnr(values[scratched], clean[scratched]) for title, values in filled.items()}
    print("  inpainted: " + ", ".join(f"{title} {dB:.1f} dB" for title, dB in inside.items()))

    assert levels["edges"] > levels["noisy"] + 8 and levels["edges"] > levels["linear"] + 6, levels
    assert inside["edges"] > 27, inside
    return panels_of(surface, denoised, levels, filled, inside, with_curves(
        surface, v, curves, 0.6 * mean_edge_length(surface)), view, up), edges.GetEdgeLength() / exact


def panels_of(surface, denoised, levels, filled, inside, edges, view, up):
    table = colour_table(0, 1, [(0.97, 0.97, 0.95), (0.90, 0.55, 0.25)])
    table.UseAboveRangeColorOn()
    table.SetAboveRangeColor(0.1, 0.1, 0.15, 1)
    first = [("noisy", "noisy"), ("edges", "smooth between edges"), ("linear", "linear diffusion"),
             ("total variation", "total variation")]
    panels = [Panel(coloured(surface, denoised[key]), "shown", title, f"{levels[key]:.1f} dB", view,
                    up) for key, title in first]
    panels.insert(1, Panel(edges, "shown", "edges", "1 - v, and curves", view, up, table=table))
    panels.append(Panel(coloured(surface, array_of(surface, "clean")), "shown", "without noise", "",
                        view, up))
    panels.append(Panel(coloured(surface, array_of(surface, "spoiled")), "shown", "15 % missing", "",
                        view, up))
    for key, title in first[1:]:
        note = f"{inside[key]:.1f} dB at missing points"
        panels.append(Panel(coloured(surface, filled[key]), "shown",
                            title if key != "edges" else "filled in through edges", note, view, up))
    return panels


def main():
    folder = os.environ.get("SURFACEDIFFUSION_MESH_DIR")
    if len(sys.argv) > 1:
        name, surface = Path(sys.argv[1]).stem, read_mesh(Path(sys.argv[1]))
    elif folder:
        name = "elephant"
        surface = refined(read_mesh(Path(folder) / f"{name}.off"), 10_000)
    else:
        name, surface = "pebble", refined(pebble(), 10_000)
    panels, ratio = draw(surface, name)
    assert 0.9 < ratio < 1.1, ratio
    if display_missing():
        print("  no picture: there is no display")
    else:
        save_picture("mumford_shah.png", panels, 5, (320, 300))


if __name__ == "__main__":
    main()
