# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The points of faces, from arrays and lists: rows of one length, polygons, and rows with padding."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._settings import as_integer, shorten

_ALLOWED = "allowed: an (m, 3) array of rows of points, or a list of polygons"

#: Values of netCDF files where there is none are negative, or at least this; UGRID's example has 999999.
_LEAST_FILL = 999999


def as_polygons(
    faces: Any, points: int, start_index: int | None = None, fill_value: int | None = None
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The points of all polygons in a row, from 0, and where each polygon begins. See :class:`Surface`."""
    if start_index is not None:
        as_integer("start_index", start_index, 0, 1, "0, 1 or None")
    if fill_value is not None:
        as_integer("fill_value", fill_value, -2**63, 2**64 - 1, "an integer of 64 bits, or None")
    if not isinstance(faces, (list, tuple)) and hasattr(faces, "__array__"):
        faces = np.ma.asanyarray(faces)  # a variable of xarray
    if isinstance(faces, np.ndarray) and faces.dtype != object:
        flat, sizes = _read_rows(faces, points, start_index, fill_value)
    else:
        flat, sizes = _read_list(faces)
    if start_index is None:
        # A point that there is not, and none that there only is from 0.
        start_index = int(flat.size > 0 and flat.min() == 1 and flat.max() == points)
    flat = flat - start_index
    offsets = np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(sizes, dtype=np.int64)])
    outside = (flat < 0) | (flat >= points)
    if outside.any():
        at = int(np.argmax(outside))
        face = int(np.searchsorted(offsets, at, side="right")) - 1
        raise ValueError(f"faces has {flat[at] + start_index} in row {face}; allowed: {start_index} to "
                         f"{points - 1 + start_index}, the rows of points")
    return np.ascontiguousarray(flat, dtype=np.int64), offsets


def _read_list(faces: Any) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The numbers of all polygons in a row, and of how many each has."""
    try:
        rows = [np.asarray(face) for face in faces]
    except (TypeError, ValueError):
        raise ValueError(f"faces is {shorten(faces)}; {_ALLOWED}") from None
    for number, row in enumerate(rows):
        if row.ndim != 1 or row.size < 3:
            raise ValueError(f"faces has {shorten(faces[number])} in row {number}; "
                             "allowed: three or more rows of points")
    if not rows:
        raise ValueError(f"faces is empty; {_ALLOWED}")
    flat = np.concatenate(rows)
    if flat.dtype.kind not in "iu":
        raise ValueError(f"faces has elements of type {flat.dtype}; allowed: integers")
    return flat.astype(np.int64), np.array([row.size for row in rows], dtype=np.int64)


def _read_rows(
    array: NDArray[Any], points: int, start_index: int | None, fill_value: int | None
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The same of rows of one length, without their padding."""
    if array.ndim != 2 or array.shape[1] < 3:
        raise ValueError(f"faces has shape {array.shape}; {_ALLOWED}")
    if array.size == 0:
        raise ValueError(f"faces is empty; {_ALLOWED}")
    masked, array = np.ma.getmaskarray(array), np.ma.getdata(array)
    numbers, is_padding = _as_integers(array, masked)
    is_said = bool(is_padding.any())
    if fill_value is not None:
        is_padding |= array == fill_value
        is_said = True
    elif not is_said:
        is_padding = _find_padding(numbers, points, start_index)
    sizes = np.count_nonzero(~is_padding, axis=1)
    fits = ~(is_padding & (np.arange(array.shape[1]) < sizes[:, None])).any(axis=1) & (sizes >= 3)
    if is_said and not fits.all():
        row = int(np.argmin(fits))
        raise ValueError(f"faces has padding in row {row} before a point, or for all but {sizes[row]}; "
                         "allowed: at the ends of rows, after three points or more")
    if not fits.all():  # the numbers are no padding
        is_padding[:], sizes[:] = False, array.shape[1]
    _refuse_sizes_in_rows(numbers, sizes)
    return numbers[~is_padding], sizes


def _as_integers(array: NDArray[Any], masked: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Numbers, and where there are none: they are masked, or NaN of xarray, which decodes integers with a
    fill value as floats."""
    if array.dtype.kind not in "iuf":
        raise ValueError(f"faces has elements of type {array.dtype}; allowed: integers")
    if array.dtype.kind != "f":
        return array.astype(np.int64), masked
    without = masked | np.isnan(array)
    numbers = np.where(without, 0.0, array)
    broken = (numbers != np.rint(numbers)) | (np.abs(numbers) > 2.0**53)
    if broken.any():
        row, column = np.argwhere(broken)[0]
        raise ValueError(f"faces has {array[row, column]} in row {row}; allowed: integers, and NaN after "
                         "the last point of a row")
    return numbers.astype(np.int64), without


def _find_padding(
    numbers: NDArray[np.int64], points: int, start_index: int | None
) -> NDArray[np.bool_]:
    """Where one number stands that a fill value may be: below those of points, or far above. Numbers from 1
    may be filled with 0."""
    is_padding = (numbers < 0) | (numbers >= max(_LEAST_FILL, points + 1))
    if start_index == 1 or (start_index is None and numbers[~is_padding].max(initial=0) == points):
        is_padding |= numbers == 0
    found = numbers[is_padding]
    return is_padding & (found.size > 0 and bool((found == found[0]).all()))


def _refuse_sizes_in_rows(numbers: NDArray[np.int64], sizes: NDArray[np.int64]) -> None:
    corners = numbers.shape[1] - 1
    if corners >= 3 and (numbers[:, 0] == corners).all() and (sizes == corners + 1).all():
        raise ValueError(f"faces has shape {numbers.shape} and {corners} in the whole first column; "
                         f"allowed: faces[:, 1:] for faces of {corners} points, whose number comes "
                         f"first as in PyVista, or list(faces) for faces of {corners + 1} points that "
                         f"all begin with point {corners}")
