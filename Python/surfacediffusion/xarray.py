# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Filters of data of xarray, uxarray and xugrid, which keep coordinates, attributes and other dimensions. None of
these packages is imported."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _scales
from ._settings import shorten
from ._surface import Surface, SurfaceLike, as_surface

__all__ = ["scale_filter", "surface_of"]

#: The largest block of values that is filtered at once, in bytes.
_BLOCK = 1 << 28


def surface_of(data: Any, radius: float = 6371.0) -> Surface:
    """The surface of data of uxarray (``.uxgrid``), or of xugrid (``.ugrid.grid``): longitudes and latitudes in
    degrees on a sphere, and projected coordinates of xugrid as they are.

    Parameters
    ----------
    data : UxDataArray or UgridDataArray
    radius : float, above 0, default 6371.0
        Of the sphere: that of the Earth in kilometres.
    """
    grid = getattr(data, "uxgrid", None)
    if grid is not None:
        return Surface.from_lonlat(grid.node_lon.values, grid.node_lat.values, grid.face_node_connectivity.values,
                                   radius, fill_value=int(grid.face_node_connectivity.attrs["_FillValue"]))
    grid = getattr(getattr(data, "ugrid", None), "grid", None)
    if grid is None:
        raise ValueError(f"surface is not given, and {shorten(type(data).__name__)} has none; allowed: data of "
                         "uxarray or xugrid, or surface=")
    faces = np.asarray(grid.face_node_connectivity)
    if getattr(grid, "is_geographic", False):
        return Surface.from_lonlat(grid.node_x, grid.node_y, faces, radius, fill_value=int(grid.fill_value))
    points = np.column_stack([grid.node_x, grid.node_y, np.zeros(len(grid.node_x))])
    return Surface(points, faces, fill_value=int(grid.fill_value))


def scale_filter(
    data: Any, wavelength: Any, *, surface: SurfaceLike | None = None, dim: str | None = None,
    radius: float = 6371.0, **others: Any,
) -> Any:
    """Filter data by scale, as :func:`surfacediffusion.scale_filter`, along the dimension of points or faces.

    Parameters
    ----------
    data : DataArray of xarray, UxDataArray, or UgridDataArray
        Values with a dimension of points or faces, and others such as time and depth. NaN is left out, as land
        is, at each of these for itself, and so is the attribute `_FillValue` or `missing_value`; values with
        NaN at the same places share a factor.
    wavelength : float or array_like of shape (points,), above 0
        In the unit of the surface: kilometres on the sphere of `surface_of`.
    surface : Surface or tuple (points, faces), optional
        Default: that of the data, by :func:`surface_of`, made again at each call.
    dim : str, optional
        The dimension of points or faces. Default: the only one with as many values as faces, else as points.
    radius : float, default 6371.0
        As for :func:`surface_of`.
    others
        `order`, `mask`, `roi` and `progress`, as for :func:`surfacediffusion.scale_filter`.

    Returns
    -------
    As `data`, with its dimensions, coordinates, name and attributes, in double precision.

    Examples
    --------
    >>> from surfacediffusion.xarray import scale_filter
    >>> smooth = scale_filter(sst, wavelength=500.0)                       # doctest: +SKIP
    """
    mesh = surface_of(data, radius) if surface is None else as_surface(surface)
    axis, on_faces = _find_axis(data, mesh, dim)
    values = np.moveaxis(np.asarray(data.values, dtype=np.float64), axis, 0)
    rows = values.shape[0]
    columns = values.reshape(rows, -1)
    attributes = getattr(data, "attrs", {})
    fills = [float(attributes[name]) for name in ("_FillValue", "missing_value") if name in attributes]
    columns = np.where(np.isin(columns, fills), np.nan, columns)  # of files that were read undecoded
    # Neighbours in order share their masks more often than others: of (time, depth) those of a depth.
    missing = np.packbits(np.isnan(columns), axis=0)
    order = np.lexsort(missing[::-1]) if np.isnan(columns).any() else np.arange(columns.shape[1])
    width = max(1, _BLOCK // (8 * rows))
    result = np.empty_like(columns)
    for first in np.arange(0, columns.shape[1], width):
        chosen = order[first:first + width]
        result[:, chosen] = _scales.scale_filter(
            mesh, np.ascontiguousarray(columns[:, chosen]), wavelength, on_faces=on_faces, **others)
    return data.copy(data=np.moveaxis(result.reshape(values.shape), 0, axis))


def _find_axis(data: Any, surface: Surface, dim: str | None) -> tuple[int, bool]:
    """The axis of the points or faces, and whether it is that of faces."""
    sizes = dict(zip(data.dims, data.shape))
    if dim is not None and dim not in sizes:
        raise ValueError(f"dim is {shorten(dim)}; allowed: {', '.join(map(str, sizes))}")
    for count, on_faces in ((surface.n_faces, True), (surface.n_points, False)):
        found = [name for name, size in sizes.items() if size == count and dim in (None, name)]
        if len(found) > 1:
            raise ValueError(f"data has dimensions {' and '.join(map(str, found))} of {count} values; allowed: "
                             "dim= one of them")
        if found:
            return list(sizes).index(found[0]), on_faces
    raise ValueError(f"data has sizes {', '.join(f'{name} {size}' for name, size in sizes.items())}; allowed: a "
                     f"dimension of {surface.n_faces} faces or {surface.n_points} points")
