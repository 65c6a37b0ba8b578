#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Compute distances along a scan from two points, and the arrival times of a front with two speeds.

    distance.py [scan.off | --quick]

The program draws isolines of the distances along the edges of the scan (Dijkstra's algorithm, as
vtkDijkstraGraphGeodesicPath has it), by fast marching and by the heat method, and those of the arrival
times of a front that is four times as slow on one half. It fails unless the edges give the longest ways,
and prints the errors of all three on a sphere, where the distances are known. It writes distance.png.
--quick: a small generated surface.

Try next: a line or a region as sources, and the array NearestSource, which divides the scan.
"""
import os
import sys
from pathlib import Path

import numpy as np
from pictures import Panel, colour_table, display_missing, save_picture
from surface_data import (
    array_of, make_surface, pebble, points_of, read_mesh, refined, triangles_of, with_arrays,
)
from vtkmodules.vtkCommonCore import vtkDoubleArray
from vtkmodules.vtkFiltersModeling import vtkDijkstraGraphGeodesicPath
from vtkmodules.vtkFiltersSources import vtkPlatonicSolidSource

from vtkSurfaceDiffusion import vtkSurfaceDistanceFilter

BANDS = 32
RAMP = np.array([(0.99, 0.91, 0.70), (0.96, 0.65, 0.42), (0.85, 0.38, 0.40), (0.58, 0.24, 0.50),
                 (0.30, 0.20, 0.50)])


def bands(limit):
    """Colours from 0 to the limit in bands, every second one darker, whose borders are isolines."""
    places = np.linspace(0, len(RAMP) - 1, BANDS)
    colours = np.stack([np.interp(places, range(len(RAMP)), channel) for channel in RAMP.T], axis=1)
    colours[1::2] *= 0.6
    return colour_table(0, limit, [tuple(colour) for colour in colours], steps=BANDS)


def distances(surface, sources, method, speed=None):
    """Distances from points by their numbers, or arrival times with a speed per point."""
    marks = np.zeros(surface.GetNumberOfPoints())
    marks[list(sources)] = 1
    model = vtkSurfaceDistanceFilter()
    model.SetInputData(with_arrays(surface, source=marks, **({} if speed is None else {"speed": speed})))
    model.SetInputArrayToProcess(0, 0, 0, 0, "source")
    if speed is not None:
        model.SetInputArrayToProcess(8, 0, 0, 0, "speed")
    getattr(model, "SetMethodTo" + method)()
    model.Update()
    return array_of(model.GetOutput(), "Distance" if speed is None else "ArrivalTime").copy()


def edge_distances(surface, sources):
    """The shortest ways along edges."""
    found = np.full(surface.GetNumberOfPoints(), np.inf)
    for source in sources:
        path = vtkDijkstraGraphGeodesicPath()
        path.SetInputData(surface)
        path.SetStartVertex(int(source))
        path.SetEndVertex(int(source) - 1 if source else 1)
        path.StopWhenEndReachedOff()
        path.Update()
        weights = vtkDoubleArray()
        path.GetCumulativeWeights(weights)
        found = np.minimum(found, [weights.GetValue(i) for i in range(len(found))])
    return found


def print_errors_on_a_sphere(more_than):
    solid = vtkPlatonicSolidSource()
    solid.SetSolidTypeToIcosahedron()
    solid.Update()
    sphere = refined(solid.GetOutput(), more_than)
    points = points_of(sphere).astype(float)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    points, place = np.unique(points.round(12), axis=0, return_inverse=True)
    triangles = place.ravel()[triangles_of(sphere)]
    sphere = make_surface(points, triangles)
    exact = np.arccos(np.clip(points @ points[7], -1, 1))
    errors = [100 * abs(found - exact).mean() / np.pi for found in (
        edge_distances(sphere, [7]), distances(sphere, [7], "Heat"), distances(sphere, [7], "Eikonal"))]
    print(f"  sphere of {len(points)} points: mean errors " + ", ".join(
        f"{name} {error:.2f} %" for name, error in zip(("edges", "Heat", "Eikonal"), errors)))
    assert errors[0] > 5 * errors[1] > 5 * errors[2], errors


def draw(scan, name, view):
    points = points_of(scan)
    x = points - points.mean(axis=0)
    sources = [int(np.argmax(x @ direction)) for direction in ((0.3, 1.0, 0.5), (-0.4, -1.0, 0.6))]
    found = {"edges (Dijkstra)": edge_distances(scan, sources),
             "fast marching": distances(scan, sources, "Eikonal"),
             "heat method": distances(scan, sources, "Heat")}
    longest = np.max(found["fast marching"])
    excess = 100 * np.mean(found["edges (Dijkstra)"] - found["fast marching"]) / longest
    print(f"  {name}: ways along edges are longer by {excess:.1f} % of the largest distance on average, "
          f"the heat method differs by "
          f"{100 * np.mean(abs(found['heat method'] - found['fast marching'])) / longest:.2f} %")
    assert excess > 0
    panels = [Panel(with_arrays(scan, shown=values), "shown", title, name, view=view,
                    table=bands(longest))
              for title, values in found.items()]
    speed = np.where(x[:, 0] > 0, 1.0, 0.25)
    times = distances(scan, sources[:1], "Eikonal", speed)
    panels.append(Panel(with_arrays(scan, shown=times), "shown", "arrival times", "speed 1 and 1/4", view=view,
                        table=bands(np.percentile(times, 98))))
    return panels


def main():
    quick = sys.argv[1:] == ["--quick"]
    folder = os.environ.get("SURFACEDIFFUSION_MESH_DIR")
    if quick:
        name, scan, view = "pebble", pebble(), (0, 0, 1)
    elif len(sys.argv) > 1:
        name, scan, view = Path(sys.argv[1]).stem, read_mesh(Path(sys.argv[1])), (0, 0, 1)
    elif folder:
        name, scan, view = "bunny", read_mesh(Path(folder) / "bunny00.off"), (0, 0, 1)
    else:
        name, scan, view = "pebble", refined(pebble(), 5_000), (0, 0, 1)
    for size in (2_000,) if quick else (2_000, 10_000):
        print_errors_on_a_sphere(size)
    panels = draw(scan, name, view)
    if display_missing():
        print("  no picture: there is no display")
    else:
        save_picture("distance.png", panels, 4, (200, 200) if quick else (380, 360))


if __name__ == "__main__":
    main()
