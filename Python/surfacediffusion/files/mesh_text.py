# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""OFF and OBJ files. Both are lines of text, and are read here because meshio accepts only some of
them: OFF without comments and colours, OBJ with as many texture coordinates as vertices."""
from __future__ import annotations

import re

import numpy as np


def _numbers(text, what):
    try:
        return np.array(text, dtype=float)
    except ValueError as error:
        raise ValueError(f"{what}: {error}") from None


def _faces(polygons):
    """(m, 3) int for triangles, otherwise a list of polygons."""
    if polygons and all(len(polygon) == 3 for polygon in polygons):
        return np.array(polygons, dtype=np.int64)
    return polygons


def _off_lines(data):
    """(number of the line, words without comment) of each line that has words."""
    for number, line in enumerate(data.decode("latin-1").splitlines()):
        words = line.split("#", 1)[0].split()
        if words:
            yield number, words


def read_off(data: bytes):
    lines = list(_off_lines(data))
    layout = _off_layout(lines)
    points, faces = layout["points"], layout["faces"]
    coordinates = _numbers([lines[i][1][:3] for i in points], "a vertex")
    if len(points) and (coordinates.ndim != 2 or coordinates.shape[1] != 3):
        raise ValueError("a vertex does not have three coordinates")
    polygons = []
    for i in faces:
        words = lines[i][1]
        size = int(words[0])
        if size < 3 or len(words) <= size:
            raise ValueError(f"line {lines[i][0] + 1} is no face: {' '.join(words)[:40]}")
        polygons.append([int(word) for word in words[1:size + 1]])
    return coordinates.reshape(-1, 3), _faces(polygons)


def _off_layout(lines):
    """Which of the lines hold points and faces. The counts may follow OFF on its line."""
    words = lines[0][1][1:]
    first = 1
    if not words:
        if len(lines) < 2:
            raise ValueError("the counts of vertices and faces are missing")
        words = lines[1][1]
        first = 2
    if words[0].upper() == "BINARY":
        raise ValueError("binary OFF; allowed: text")
    vertices, polygons = int(words[0]), int(words[1])
    if len(lines) < first + vertices + polygons:
        raise ValueError(f"{vertices} vertices and {polygons} faces are announced, but "
                         f"{len(lines) - first} lines follow")
    middle = first + vertices
    return {"points": range(first, middle), "faces": range(middle, middle + polygons)}


def read_obj(data: bytes):
    points, polygons = [], []
    for number, line in enumerate(data.decode("latin-1").splitlines(), start=1):
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            if len(words) < 4:
                raise ValueError(f"line {number} is no vertex: {line[:40]}")
            points.append(words[1:4])
        elif words[0] == "f":
            if len(words) < 4:
                raise ValueError(f"line {number} is no face: {line[:40]}")
            corners = [int(word.split("/")[0]) for word in words[1:]]
            if 0 in corners:
                raise ValueError(f"line {number}: numbers of vertices start at 1")
            # Negative numbers count from the last vertex so far.
            polygons.append([c - 1 if c > 0 else len(points) + c for c in corners])
    return _numbers(points, "a vertex").reshape(-1, 3), _faces(polygons)


READERS = {"off": read_off, "obj": read_obj}


def replace_points(content, points) -> bytes:
    """The same file with other coordinates: colours, comments and faces stay as they are."""
    text = content.bytes.decode("latin-1").splitlines(keepends=True)
    if content.kind == "off":
        lines = list(_off_lines(content.bytes))
        numbers = [lines[i][0] for i in _off_layout(lines)["points"]]
        pattern = re.compile(r"^(\s*)\S+\s+\S+\s+\S+")
    else:
        numbers = [i for i, line in enumerate(text) if line.split()[:1] == ["v"]]
        pattern = re.compile(r"^(\s*v\s+)\S+\s+\S+\s+\S+")
    for number, (x, y, z) in zip(numbers, np.asarray(points, dtype=float).tolist()):
        text[number] = pattern.sub(rf"\g<1>{x!r} {y!r} {z!r}", text[number], count=1)
    return "".join(text).encode("latin-1")
