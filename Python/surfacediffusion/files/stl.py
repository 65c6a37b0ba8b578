# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""STL files, text and binary. Their triangles have no vertices in common: corners at the same place
become one vertex, whose number is in no file."""
from __future__ import annotations

import re

import numpy as np

_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_HEADER = 84  # 80 bytes of text and the number of triangles


def is_text(data):
    """Some binary files start with "solid", too; they have zeros."""
    return b"\0" not in data[:4096]


def read(data: bytes):
    """Points (n, 3) and faces (m, 3)."""
    corners = _read_text(data) if is_text(data) else _read_binary(data)["corners"]
    points, numbers = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return points, numbers.reshape(-1, 3).astype(np.int64)


def _read_binary(data):
    count = int.from_bytes(data[80:_HEADER], "little")
    return np.frombuffer(data, _TRIANGLE, count, _HEADER)


def _read_text(data):
    vertices, in_solid, in_facet = [], False, False
    for number, line in enumerate(data.splitlines(), start=1):
        words = line.split()
        key = words[0].lower() if words else b""
        if key == b"solid" or key == b"\xef\xbb\xbfsolid":
            in_solid = True
        elif key == b"facet":
            in_facet = True
        elif key == b"vertex":
            if len(words) != 4:
                raise ValueError(f"line {number}: a vertex does not have three coordinates")
            vertices.append(words[1:])
        elif key == b"endfacet":
            in_facet = False
            if len(vertices) % 3:
                raise ValueError(f"line {number}: a facet does not have three vertices")
        elif key == b"endsolid":
            in_solid = False
    if in_solid or in_facet or len(vertices) % 3:
        raise ValueError("the end is missing: there is no endsolid after the last solid")
    return np.array(vertices, dtype="S").astype(float).reshape(-1, 3, 3)


def write(data: bytes, points, faces, normals) -> bytes:
    """The same file with other points and the normals of its triangles."""
    corners = np.asarray(points)[faces]
    if not is_text(data):
        triangles = _read_binary(data).copy()
        triangles["corners"], triangles["normal"] = corners, normals
        return data[:_HEADER] + triangles.tobytes() + data[_HEADER + triangles.nbytes:]
    rows = {b"facet": iter(np.asarray(normals, float).tolist()),
            b"vertex": iter(corners.reshape(-1, 3).tolist())}
    lines = data.splitlines(keepends=True)
    for number, line in enumerate(lines):
        words = line.split()
        key = words[0].lower() if words else b""
        if key in rows:
            text = " ".join(map(repr, next(rows[key]))).encode()
            indent, end = re.match(rb"\s*", line)[0], re.search(rb"\s*$", line)[0]
            middle = b" " if key == b"vertex" else b" normal "
            lines[number] = indent + words[0] + middle + text + end
    return b"".join(lines)
