# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Normals of ParaView's surfaces: those of surfaces without any, and those of points that have moved. The
rules are those of the classes in C++, Filters/Conversion/PointNormals.cxx."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkDataArray

from .._surface import normalize, unit_normals
from ._surfaces import HIDDEN_CELL, cell_flags, polygons_of, to_numpy, triangles_of_strip


def compute_point_normals(data: Any) -> Any:
    """A vtkFloatArray with the normalised sums of the unit normals of the cells at each point."""
    array = numpy_to_vtk(_normals_of_points(data).astype(np.float32), deep=True)
    array.SetName("Normals")
    return array


def update_normals(before: Any, after: Any) -> None:
    """Compute the normals of a surface whose points have moved again, and drop its tangents."""
    for given, made, find in ((before.GetPointData(), after.GetPointData(), _normals_of_points),
                              (before.GetCellData(), after.GetCellData(), _normals_of_cells)):
        for array, kind in _find_normals(given, made):
            is_active = made.GetNormals() is array
            normals_before, normals_after = find(before), find(after)
            is_kept = (kind == "normals" and isinstance(array, vtkDataArray)
                       and array.GetNumberOfComponents() == 3
                       and array.GetNumberOfTuples() == len(normals_after))
            _remove(array, made)
            if is_kept:
                index = made.AddArray(_moved(array, normals_before, normals_after))
                if is_active:
                    made.SetActiveAttribute(index, made.NORMALS)


def drop_normals(before: Any, after: Any) -> None:
    """Drop the normals and tangents that a surface with other points still has from the one before."""
    for given, made in ((before.GetPointData(), after.GetPointData()),
                        (before.GetCellData(), after.GetCellData())):
        for array, _ in _find_normals(given, made):
            _remove(array, made)


def _list_arrays(attributes: Any) -> list[Any]:
    return [attributes.GetAbstractArray(a) for a in range(attributes.GetNumberOfArrays())]


def _find_normals(given: Any, made: Any) -> list[tuple[Any, str]]:
    """The normals and tangents of `given` that `made` has, too, and the kind of each."""
    kept = _list_arrays(made)
    found = [(array, _kind(array, given)) for array in _list_arrays(given) if array in kept]
    return [(array, kind) for array, kind in found if kind]


def _remove(array: Any, attributes: Any) -> None:
    attributes.RemoveArray(_list_arrays(attributes).index(array))


def _kind(array: Any, attributes: Any) -> str:
    if array is attributes.GetNormals() or array.GetName() == "Normals":
        return "normals"
    return "tangents" if array is attributes.GetTangents() or array.GetName() == "Tangents" else ""


def _moved(given: Any, before: NDArray[np.float64], after: NDArray[np.float64]) -> Any:
    """The normals in the type of the given ones. They point to the same side, and tuples that have no
    normal are copied."""
    values = to_numpy(given).astype(np.float64)
    side = -1.0 if np.sum(values * before) < 0.0 else 1.0
    has_normal = np.any(after != 0.0, axis=1)
    values[has_normal] = side * after[has_normal]
    moved = given.NewInstance()
    moved.DeepCopy(numpy_to_vtk(values))  # which converts to its type
    moved.SetName(given.GetName())
    return moved


def _normals_of_points(data: Any) -> NDArray[np.float64]:
    """Hidden cells do not count."""
    connectivity, offsets, cells = _polygons(data)
    normals = unit_normals(_moderate_points(data), connectivity, offsets)
    flags = cell_flags(data)
    if flags is not None:
        normals[(flags[cells] & HIDDEN_CELL) != 0] = 0.0
    sums = np.zeros((data.GetNumberOfPoints(), 3))
    for axis in range(3):
        weights = np.repeat(normals[:, axis], np.diff(offsets))
        sums[:, axis] = np.bincount(connectivity, weights, minlength=len(sums))
    return normalize(sums)


def _normals_of_cells(data: Any) -> NDArray[np.float64]:
    """Zero for cells that are no polygons."""
    connectivity, offsets, cells = _polygons(data)
    normals = unit_normals(_moderate_points(data), connectivity, offsets)
    sums = np.zeros((data.GetNumberOfCells(), 3))
    for axis in range(3):
        sums[:, axis] = np.bincount(cells, normals[:, axis], minlength=len(sums))
    return normalize(sums)


def _polygons(data: Any) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """The corners of all polygons and of the triangles of strips, where each begins, and its cell."""
    first = data.GetNumberOfVerts() + data.GetNumberOfLines()
    polygons, cells = [], []
    points = data.GetNumberOfPoints()
    for array, is_strip in ((data.GetPolys(), False), (data.GetStrips(), True)):
        connectivity, offsets = polygons_of(array)
        sizes = np.diff(offsets)
        bad = (connectivity < 0) | (connectivity >= points)
        if not is_strip and (sizes >= 3).all() and not bad.any():
            polygons.append((connectivity, sizes))
            cells.append(first + np.arange(len(sizes)))
        else:
            for number in range(len(sizes)):
                corners = connectivity[offsets[number]:offsets[number + 1]]
                if len(corners) < 3 or bad[offsets[number]:offsets[number + 1]].any():
                    continue  # an error, reported later with others of its kind
                rows = triangles_of_strip(corners) if is_strip else corners[None]
                polygons.append((rows.ravel(), np.full(len(rows), rows.shape[1])))
                cells.append(np.full(len(rows), first + number))
        first += len(sizes)
    sizes = np.concatenate([size for _, size in polygons] or [np.empty(0, dtype=np.int64)])
    return (np.concatenate([corners for corners, _ in polygons] or [np.empty(0, dtype=np.int64)]),
            np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64),
            np.concatenate(cells or [np.empty(0, dtype=np.int64)]).astype(np.int64))


def _moderate_points(data: Any) -> NDArray[np.float64]:
    """The points, in coordinates whose squares a float can hold."""
    points = to_numpy(data.GetPoints().GetData()).astype(np.float64)
    bounds = data.GetBounds()
    extent = max(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4])
    if extent > 0.0 and not 1e-15 <= extent <= 1e15:
        points = points / extent - np.array([bounds[0], bounds[2], bounds[4]]) / extent
    return points
