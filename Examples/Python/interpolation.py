#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Interpolate values at a few points of a surface, and show where the result is uncertain.

    interpolation.py [--quick]

The program draws a row for each of two uses:

- activation times of a heart-like surface at 150 electrodes beside it, with errors of 3 ms, none of
  them on one side;
- the temperature of the sea at 300 buoys, with errors of 1 degree, none of them in one ocean.

Each row shows the values, their harmonic interpolation (the steady state of linear diffusion, which has
a spike at each value), the spline with the smoothing that cross-validation finds, its standard error,
and the truth. The program fails unless the spline has at most two thirds of the error of harmonic
interpolation where there are values, and unless the standard error is largest where there are none. It
writes interpolation.png. --quick: coarser surfaces, on which the spikes of harmonic interpolation are
lower, so that the spline has to have at most 0.8 of its error.

Try next: ExactOn(), which follows the noise, and SetCorrelationLength().
"""
import argparse
import sys

import numpy as np
from pictures import Panel, colour_table, display_missing, save_picture
from segmentation import coastlines, icosphere, inside
from surface_data import array_of, make_surface, points_of, triangles_of, with_arrays
from mumford_shah import coloured, with_marks
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData
from vtkmodules.vtkFiltersSources import vtkSphereSource

from vtkSurfaceDiffusion import vtkFVMHeatFilter, vtkSurfaceInterpolationFilter

RAINBOW = [(0.70, 0.10, 0.15), (0.95, 0.55, 0.20), (0.98, 0.90, 0.45), (0.55, 0.80, 0.45),
           (0.25, 0.60, 0.75), (0.25, 0.25, 0.60)]
WARM = [(0.23, 0.30, 0.75), (0.55, 0.70, 0.98), (0.87, 0.87, 0.87), (0.96, 0.60, 0.47),
        (0.71, 0.02, 0.15)]
ERROR = [(1.0, 1.0, 0.9), (0.98, 0.75, 0.40), (0.85, 0.30, 0.20), (0.35, 0.05, 0.15)]
LAND = 0.75


# ---- the filters ---------------------------------------------------------------------------------

def spline(surface, places, values):
    """The values of the spline and their standard errors."""
    given = vtkPolyData()
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(places), deep=True))
    given.SetPoints(points)
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName("value")
    given.GetPointData().SetScalars(array)
    model = vtkSurfaceInterpolationFilter()
    model.SetInputData(surface)
    model.SetInputData(1, given)
    model.ComputeErrorOn()
    model.Update()
    output = model.GetOutput()
    return array_of(output, "valueInterpolated").copy(), array_of(output, "valueError").copy()


def harmonic(surface, known, values):
    """The harmonic function with these values at points of the surface."""
    data = np.full(len(points_of(surface)), np.nan)
    data[known] = values
    model = vtkFVMHeatFilter()
    model.SetInputData(with_arrays(surface, sparse=data))
    model.SetInputArrayToProcess(0, 0, 0, 0, "sparse")
    model.SetModeToSteadyState()
    model.HoldKnownValuesOn()
    model.Update()
    return array_of(model.GetOutput(), "sparseDiffused").copy()


def nearest(surface, places):
    points = points_of(surface)
    return np.array([((points - place) ** 2).sum(axis=1).argmin() for place in places])


# ---- pictures ------------------------------------------------------------------------------------

def shades(values, low, high, colours):
    table = colour_table(0, 1, colours)
    ramp = np.array([table.GetTableValue(i)[:3] for i in range(256)])
    return ramp[np.uint8(255 * np.clip((values - low) / (high - low), 0, 1))]


def bytes_of(colours):
    return np.uint8(np.clip(colours * 255 + 0.5, 0, 255))


def balls(surface, places, colours, size):
    """The grey surface with a coloured ball at each place."""
    grey = bytes_of(np.full((len(points_of(surface)), 3), LAND))
    both = vtkAppendPolyData()
    both.AddInputData(with_arrays(surface, shown=grey))
    for place, colour in zip(places, colours):
        ball = vtkSphereSource()
        ball.SetCenter(place)
        ball.SetRadius(size)
        ball.SetThetaResolution(12)
        ball.SetPhiResolution(8)
        ball.Update()
        count = ball.GetOutput().GetNumberOfPoints()
        both.AddInputData(with_arrays(make_surface(points_of(ball.GetOutput()),
                                                   triangles_of(ball.GetOutput())),
                                      shown=np.tile(bytes_of(colour), (count, 1))))
    both.Update()
    return both.GetOutput()


def row(surface, truth, known, places, values, seen, unit, colours, look, size, share, whole=None):
    """Panels of one use. seen: points among values; share: of the error of harmonic interpolation, which
    the spline has at most; whole: the surface to draw, and its points' numbers
    in `surface` (-1: land)."""
    smooth, error = spline(surface, places, values)
    spiky = harmonic(surface, known, values)
    found = {name: np.sqrt(np.nanmean((field - truth)[seen] ** 2))  # NaN: a lake without values
             for name, field in (("harmonic", spiky), ("spline", smooth))}
    unseen = np.nanmedian(error[~seen]) / np.nanmedian(error[seen])
    print(f"  error {found['harmonic']:.2f} {unit} harmonic, {found['spline']:.2f} {unit} spline; the "
          f"standard error is {unseen:.1f} times as large where there are no values")
    assert found["spline"] < share * found["harmonic"], found
    assert unseen > 1.5, unseen
    low, high = truth.min(), truth.max()
    drawn, number = (surface, np.arange(len(truth))) if whole is None else whole

    def panel(field, title, text, limits=(low, high), table=colours):
        shade = np.full((len(number), 3), LAND)
        known = np.isfinite(np.append(field, np.nan)[number])
        shade[known] = shades(np.nan_to_num(field), *limits, table)[number[known]]
        return Panel(coloured(drawn, shade), "shown", title, text, **look)

    return [
        Panel(balls(drawn, places, shades(values, low, high, colours), size), "shown",
              f"{len(values)} values", "with errors", **look),
        panel(spiky, "harmonic", f"error {found['harmonic']:.1f} {unit}"),
        panel(smooth, "spline", f"error {found['spline']:.1f} {unit}"),
        panel(error, "standard error", f"0 to {np.nanmax(error):.1f} {unit}", (0, np.nanmax(error)), ERROR),
        panel(truth, "truth", "")]


def largest_share(quick):
    return 0.8 if quick else 2 / 3


def draw_heart(quick):
    ball = icosphere(4 if quick else 5)
    x, y, z = points_of(ball).astype(float).T
    radius = 25 * (1 + 0.15 * np.sin(2 * x + 1) * np.cos(2 * y))
    points = radius[:, None] * np.column_stack([1.1 * x, 0.9 * y, z])
    surface = make_surface(points, triangles_of(ball))
    start = np.array([0.3, 0.5, 0.8]) / np.linalg.norm([0.3, 0.5, 0.8])
    truth = 30 * np.arccos(np.clip(np.column_stack([x, y, z]) @ start, -1, 1)) * (1 + 0.2 * x)
    seen = x < 0.45
    random = np.random.default_rng(2)
    known = random.choice(np.flatnonzero(seen), 150, replace=False)
    places = points[known] * (1 + random.uniform(0, 0.03, size=(150, 1)))
    values = truth[known] + random.normal(scale=3.0, size=150)
    print(f"heart: {len(points)} vertices")
    return row(surface, truth, known, places, values, seen, "ms", RAINBOW,
               dict(view=(0.7, 1.0, 0.5), up=(0, 0, 1)), 0.9, largest_share(quick))


def draw_sea(quick):
    sphere = icosphere(5 if quick else 6)
    points = points_of(sphere).astype(float)
    land = np.zeros(len(points), bool)
    for polygon in coastlines():
        land |= inside(polygon, points)
    faces = triangles_of(sphere)
    faces = faces[~land[faces].any(axis=1)]
    used = np.unique(faces)
    number = np.full(len(points), -1)
    number[used] = np.arange(used.size)
    surface = make_surface(points[used], number[faces])
    x, y, z = points[used].T
    truth = 30 * (1 - z**2) - 2 + 3 * y * (3 * x**2 - y**2)
    seen = ~((z < 0.1) & (x < 0) & (np.abs(np.degrees(np.arctan2(y, x))) > 120))  # the South Pacific
    random = np.random.default_rng(0)
    main = np.flatnonzero(seen)
    known = random.choice(main, 300, replace=False)
    values = truth[known] + random.normal(scale=1.0, size=300)
    print(f"sea: {len(used)} vertices")
    return row(surface, truth, known, points[used][known], values, seen, "degrees", WARM,
               dict(view=(-1.0, 0.25, 0.05), up=(0, 0, 1)), 0.02, largest_share(quick),
               (sphere, number))


def main():
    parser = argparse.ArgumentParser(description="Interpolates values at a few points.")
    parser.add_argument("--quick", action="store_true", help="smaller surfaces")
    quick = parser.parse_args().quick
    panels = draw_heart(quick) + draw_sea(quick)
    if display_missing():
        print("no picture: there is no display")
    else:
        save_picture("interpolation.png", panels, 5, (280, 265))


if __name__ == "__main__":
    try:
        main()
    except AssertionError as problem:
        sys.exit(f"interpolation.py: {problem}")
