# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A surface with data, and decompositions of it into pieces for several processes."""

import math

import numpy as np
from partitions import number_cells, part_of
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData


def polydata(points, triangles):
    data = vtkPolyData()
    array = vtkPoints()
    array.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    data.SetPoints(array)
    cells = np.hstack([np.full((len(triangles), 1), 3), triangles]).astype(np.int64).ravel()
    polygons = vtkCellArray()
    polygons.ImportLegacyFormat(numpy_to_vtkIdTypeArray(cells, deep=True))
    data.SetPolys(polygons)
    return data


def add(attributes, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    attributes.AddArray(array)
    return array


def make_surface(around=44, along=20):
    """A bumpy closed tube, cut open on one side, with data."""
    i, j = np.meshgrid(np.arange(around), np.arange(along), indexing="ij")
    a = 2 * math.pi * i.ravel() / around
    b = 2 * math.pi * j.ravel() / along
    r = 1.0 + 0.15 * np.cos(3 * a) * np.sin(2 * b)
    points = np.stack([(3 + r * np.cos(b)) * np.cos(a), (3 + r * np.cos(b)) * np.sin(a),
                       r * np.sin(b)], axis=1)
    number = lambda i, j: (i % around) * along + j % along
    triangles = []
    for k in range(around):
        for m in range(along):
            if k > 3 or m > 5:  # a hole
                q = (number(k, m), number(k + 1, m), number(k + 1, m + 1), number(k, m + 1))
                triangles += [(q[0], q[1], q[2]), (q[0], q[2], q[3])]
    used, numbers = np.unique(np.array(triangles), return_inverse=True)
    triangles, points, a = numbers.reshape(-1, 3), points[used], a[used]
    data = polydata(points, triangles)
    x, y, z = points.T
    noise = np.random.RandomState(1).uniform(-0.2, 0.2, len(points))
    hole = (x > 3.2).astype(np.uint8)
    of_points = data.GetPointData()
    of_points.SetScalars(add(of_points, "f", np.sign(z) + 0.3 * x + noise))
    add(of_points, "colors", (127 + 100 * np.stack([np.sin(x), np.cos(y), noise], 1)).astype(np.uint8))
    add(of_points, "hole", hole)
    add(of_points, "damaged", np.where(hole, np.nan, np.sign(z) + 0.3 * x + noise))
    add(of_points, "ends", (np.abs(z) > 1.0).astype(np.uint8))
    add(of_points, "vectors", np.stack([np.cos(a) + noise, np.sin(a), noise], 1))
    centres = points[triangles].mean(axis=1)
    add(data.GetCellData(), "around",
        np.stack([-centres[:, 1], centres[:, 0], 0 * centres[:, 0]], 1))
    add(data.GetCellData(), "rates", np.outer(1 + 0.2 * np.sin(centres[:, 0]), [21, 21, 2.6, 2.6]))
    add(data.GetCellData(), "speed", 1.0 + 0.5 * np.cos(2.0 * centres[:, 0]))
    add(of_points, "number", np.arange(len(points)).astype(np.int64))
    return data


def split(data, count, how):
    """Decompositions of a surface: slabs, random cells, an empty piece, all cells in one piece."""
    number = data.GetNumberOfCells()
    if how == "random":
        owner = np.random.RandomState(2).randint(0, count, number)
    elif how == "last":
        owner = np.full(number, count - 1)
    else:
        full = count - 1 if how == "empty" and count > 1 else count
        owner = number_cells(data) * full // number
    return [part_of(data, owner == p) for p in range(count)]
