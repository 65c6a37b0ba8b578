#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Smooth data on cells: values of a finite volume simulation on a torus of quadrilaterals.

    cell_data.py

The program smooths a pattern under noise on the cells by linear diffusion, and draws

- the noisy values;
- the result as it is by default: the mean over each cell of the smooth values at the points, and the
  detail that points do not resolve, which diffuses on the cells. No time steps return the data;
- the result with KeepCellDetail off, without the detail.

It checks that both keep the integral over the surface, and the errors. It writes cell_data.png.

Try next: ResultOnCellsOff(), which leaves the result on the points.
"""
import numpy as np
from pictures import Panel, colour_table, display_missing, save_picture
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

from vtkSurfaceDiffusion import vtkFVMHeatFilter

AROUND, ACROSS = 120, 48  # cells
RADIUS, TUBE = 1.0, 0.4
NOISE = 0.5
BLUE_TO_RED = [(0.13, 0.30, 0.55), (0.65, 0.80, 0.88), (0.97, 0.95, 0.90), (0.93, 0.66, 0.47),
               (0.62, 0.10, 0.14)]


def torus():
    """The points, the corners of the quadrilaterals, and the two angles of each cell's centre."""
    i, j = np.meshgrid(np.arange(AROUND), np.arange(ACROSS), indexing="ij")
    u, v = 2 * np.pi * i / AROUND, 2 * np.pi * j / ACROSS
    ring = RADIUS + TUBE * np.cos(v)
    points = np.stack([ring * np.cos(u), ring * np.sin(u), TUBE * np.sin(v)], axis=-1)

    def number(a, b):
        return (a % AROUND) * ACROSS + b % ACROSS

    corners = np.stack([number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)], -1)
    return (points.reshape(-1, 3), corners.reshape(-1, 4), (u + np.pi / AROUND).ravel(),
            (v + np.pi / ACROSS).ravel())


def polydata(points, corners):
    surface, coordinates, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    coordinates.SetData(numpy_to_vtk(points, deep=True))
    surface.SetPoints(coordinates)
    cells.SetData(corners.shape[1], numpy_to_vtk(corners.ravel().astype(np.int64), deep=True))
    surface.SetPolys(cells)
    return surface


def areas(points, corners):
    """Of the quadrilaterals, each as two triangles."""
    a, b, c, d = np.moveaxis(points[corners], 1, 0)
    return (np.linalg.norm(np.cross(b - a, c - a), axis=1)
            + np.linalg.norm(np.cross(c - a, d - a), axis=1)) / 2


def in_facets(points, corners, values):
    """A surface that shows one value per cell: every cell has points of its own."""
    facets = polydata(points[corners].reshape(-1, 3), np.arange(corners.size).reshape(-1, 4))
    array = numpy_to_vtk(np.repeat(values, 4), deep=True)
    array.SetName("values")
    facets.GetPointData().AddArray(array)
    return facets


def main():
    points, corners, u, v = torus()
    clean = np.sin(3 * u) * np.cos(v)
    noisy = clean + NOISE * np.random.default_rng(5).standard_normal(len(clean))
    surface = polydata(points, corners)
    array = numpy_to_vtk(noisy, deep=True)
    array.SetName("pressure")
    surface.GetCellData().SetScalars(array)

    def smooth(keep_detail):
        model = vtkFVMHeatFilter()
        model.SetInputData(surface)  # its active scalars are on cells
        model.SetFWHM(0.35)
        model.SetKeepCellDetail(keep_detail)
        model.Update()
        return vtk_to_numpy(model.GetOutput().GetCellData().GetArray("pressureDiffused")).copy()

    weights = areas(points, corners)
    integral = np.sum(weights * noisy)
    results = {"noisy values of cells": noisy, "with the detail of cells": smooth(True),
               "without the detail of cells": smooth(False)}
    table = colour_table(-1.2, 1.2, BLUE_TO_RED)
    panels, errors = [], []
    for title, values in results.items():
        error = np.sqrt(np.average((values - clean) ** 2, weights=weights))
        print(f"{title}: error {error:.3f}, integral {np.sum(weights * values):.12f}")
        assert abs(np.sum(weights * values) - integral) < 1e-10 * np.sum(weights)
        errors.append(error)
        panels.append(Panel(in_facets(points, corners, values), "values", title,
                            f"error {error:.2f}", view=(0.2, -0.7, 0.8), up=(0, 0, 1), table=table))
    assert max(errors[1:]) < 0.15
    if display_missing():
        print("no picture: there is no display")
    else:
        save_picture("cell_data.png", panels, 3, (420, 340))


if __name__ == "__main__":
    main()
