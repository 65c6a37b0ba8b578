# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""PLY and STL files through meshio."""
from __future__ import annotations

import copy
import io
import os
import re
import tempfile

import numpy as np

from .content import import_reader

# meshio's binary reader knows some types of PLY by one of their two names only, takes uchar for a
# signed type, and expects one of the two usual names of a face's list.
_PLY_TYPES = {b"char": b"int8", b"uchar": b"uint8", b"short": b"int16", b"ushort": b"uint16",
              b"float64": b"double"}


def read(content):
    import_reader("meshio", content)
    if content.kind == "ply":
        from meshio.ply._ply import read_buffer

        return read_buffer(io.BytesIO(_clean_ply_header(content.bytes)))
    from meshio import stl

    return stl.read(content.path)


def _clean_ply_header(data):
    end = re.search(rb"end_header\r?\n", data)
    if end is None:
        raise ValueError("the header has no end")
    lines = []
    for line in data[:end.end()].replace(b"\r\n", b"\n").splitlines():
        words = [_PLY_TYPES.get(word, word) for word in line.split()]
        if words[:2] == [b"property", b"list"] and words[-1:] == [b"vertex_index"]:
            words[-1] = b"vertex_indices"
        if words[:1] in ([b"comment"], [b"obj_info"]):
            continue
        lines.append(b" ".join(words) if words[:1] == [b"property"] else line)
    return b"\n".join(lines) + b"\n" + data[end.end():]


def faces_of(mesh):
    """(m, 3) int for triangles, otherwise a list of polygons."""
    blocks = [np.asarray(block.data) for block in mesh.cells
              if block.type in ("triangle", "quad", "polygon")]
    if all(block.shape[1] == 3 for block in blocks) and blocks:
        return np.concatenate(blocks).astype(np.int64)
    return [face for block in blocks for face in block.tolist()]


def write(kind, mesh, points=None, point_data=None) -> bytes:
    """The mesh with other points or other data at the points."""
    changed = copy.copy(mesh)
    if points is not None:
        changed.points = np.asarray(points, dtype=mesh.points.dtype)
    if point_data is not None:
        changed.point_data = point_data
    changed.points = _native(changed.points)
    changed.point_data = {name: _native(array) for name, array in changed.point_data.items()}
    for block in changed.cells:
        block.data = _native(block.data)
        if block.data.dtype == np.int64:
            block.data = block.data.astype(np.int32)  # PLY has no longer integers
    from meshio import ply, stl

    handle, path = tempfile.mkstemp(suffix="." + kind)
    os.close(handle)
    try:
        {"ply": ply, "stl": stl}[kind].write(path, changed, binary=True)
        with open(path, "rb") as file:
            return file.read()
    finally:
        os.unlink(path)


def _native(array):
    array = np.asarray(array)
    return array.astype(array.dtype.newbyteorder("="), copy=False)
