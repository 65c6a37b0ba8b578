# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""STL files, text and binary. Their triangles have no vertices in common: corners at the same place
become one vertex, whose number is in no file. Programs round the corners of neighbours apart: along open
edges, corners that are nearly at the same place become one vertex, too."""
from __future__ import annotations

import re

import numpy as np

_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_ROUNDING = 1e-5  # of the diagonal: corners that are no more apart are one vertex, or 1 % of open edges
_NEIGHBOURS = 200  # of a point along a line, on average, which bounds the search
_HEADER = 84  # 80 bytes of text and the number of triangles


def is_text(data):
    """Some binary files start with "solid", too; they have zeros."""
    return b"\0" not in data[:4096]


def read(data: bytes):
    """Points (n, 3), faces (m, 3), and by how much corners were apart that were joined, 0 for none."""
    corners = _read_text(data) if is_text(data) else _read_binary(data)["corners"]
    points, numbers = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return _join(points, numbers.reshape(-1, 3).astype(np.int64))


def _join(points, faces):
    """The same surface without the gaps of rounding between ends of open edges."""
    edges = _open_edges(faces)
    if not len(edges):
        return points, faces, 0.0
    with np.errstate(over="ignore", invalid="ignore"):
        # A facet far away makes the diagonal long, but not these edges.
        lengths = np.linalg.norm(np.diff(points[edges].astype(float), axis=1), axis=2)
        distance = min(_ROUNDING * np.linalg.norm(np.ptp(points.astype(float), axis=0)), 0.01 * np.median(lengths))
        pairs = _near_pairs(points, np.unique(edges), distance)
    pairs = pairs[~np.isin(_key(pairs), _key(_edges(faces)))]  # which would take a triangle's edge away
    vertex = np.arange(len(points))
    while len(pairs):
        vertex = np.arange(len(points))
        before = None
        while before is None or (before != vertex).any():  # the least number of those that are joined
            before = vertex.copy()
            np.minimum.at(vertex, pairs[:, 0], before[pairs[:, 1]])
            np.minimum.at(vertex, pairs[:, 1], before[pairs[:, 0]])
            vertex = vertex[vertex]
        new = vertex[faces]
        lost = (new == np.roll(new, 1, axis=1)).any(axis=1) & (faces != np.roll(faces, 1, axis=1)).all(axis=1)
        if not lost.any():
            break
        pairs = pairs[~np.isin(vertex[pairs[:, 0]], new[lost])]
    if not len(pairs):
        return points, faces, 0.0
    apart = np.linalg.norm(points[pairs[:, 0]].astype(float) - points[pairs[:, 1]], axis=1).max()
    kept, numbers = np.unique(vertex[faces], return_inverse=True)
    return points[kept], numbers.reshape(-1, 3).astype(np.int64), float(apart)


def _edges(faces):
    return np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)


def _key(edges):
    return edges[:, 0] << 32 | edges[:, 1]


def _open_edges(faces):
    edges = _edges(faces)
    _, first, counts = np.unique(_key(edges), return_index=True, return_counts=True)
    return edges[first[counts == 1]]


def _near_pairs(points, numbers, distance):
    """Pairs (p, 2) of these points, the lower number first, that are no more apart. They are sorted along a
    direction that no part is made along."""
    along = points[numbers].astype(float) @ [0.5773, 0.2113, 0.7887]
    order = np.argsort(along, kind="stable")
    numbers, along, found = numbers[order], along[order], [np.empty((0, 2), np.int64)]
    room = min(_NEIGHBOURS * len(numbers), 10_000_000)
    for step in range(1, len(numbers)):
        near = np.flatnonzero(along[step:] - along[:-step] <= distance)
        if not len(near):
            break
        room -= len(near)
        if room < 0:  # points so dense are not rounded ones
            return found[0]
        a, b = numbers[near], numbers[near + step]
        near = np.linalg.norm(points[a].astype(float) - points[b], axis=1) <= distance
        found.append(np.sort(np.column_stack([a[near], b[near]]), axis=1))
    return np.concatenate(found)


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
