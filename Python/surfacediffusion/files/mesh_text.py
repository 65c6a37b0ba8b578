# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""OFF and OBJ files and those of FreeSurfer named .asc, which are lines of text. Everything but coordinates
and normals is written as it was read. Lines are split as bytes: their text may be UTF-8 or anything else,
and str.splitlines() splits within some of its characters."""
from __future__ import annotations

import re

import numpy as np


def _numbers(text, what):
    try:
        return np.array(text, dtype=float)
    except ValueError as error:
        raise ValueError(f"{what}: {error}") from None


def _text_of(numbers):
    return " ".join(map(repr, numbers))


# ---- OFF -----------------------------------------------------------------------------------------

# ST: texture coordinates, C: colours, N: normals. Vertices of other dimensions are no surface.
_OFF = re.compile(r"(?:\ufeff|ï»¿)?(ST)?(C)?(N)?(4)?(n)?OFF(\d*)$")


class _Off:
    """The words of the vertices and faces. In most files each has a line of its own: its number is in
    vertex_lines. `lines` has (number, words without comment) of each line with words."""

    def __init__(self, data):
        self.text = [line.decode("latin-1") for line in data.splitlines(keepends=True)]
        self.lines = []
        for number, line in enumerate(self.text):
            words = line.split("#", 1)[0].split()
            if words:
                self.lines.append((number, words))
        self._read_header()
        try:
            self._read_lines()
        except ValueError as problem:
            try:
                self._read_words()
            except (IndexError, ValueError):
                raise problem from None

    def _read_header(self):
        name, *counts = self.lines[0][1]
        found = _OFF.match(name)
        if found is None:
            raise ValueError(f"it starts with {name[:20]!r}; allowed: OFF, COFF, NOFF, CNOFF, STOFF")
        if found[4] or found[5]:
            raise ValueError(f"{name}: vertices with other than three coordinates; allowed: OFF, COFF, "
                             "NOFF, CNOFF, STOFF")
        counts = [found[6]] * bool(found[6]) + counts  # "OFF8 6 12" is found in collections of meshes
        self.size = 3 + 3 * bool(found[3]) + 4 * bool(found[2]) + 2 * bool(found[1])
        self.has_normals = bool(found[3])
        self.first = 1
        if not counts:
            if len(self.lines) < 2:
                raise ValueError("the counts of vertices and faces are missing")
            counts, self.first = self.lines[1][1], 2
        if counts[0].upper() == "BINARY":
            raise ValueError("binary OFF; allowed: text")
        if len(counts) < 2:
            raise ValueError("the counts of vertices and faces are missing")
        self.counts = int(counts[0]), int(counts[1])
        if min(self.counts) < 0:
            raise ValueError(f"{self.counts[0]} vertices and {self.counts[1]} faces are announced")

    def _read_lines(self):
        vertices, faces = self.counts
        rows = self.lines[self.first:]
        if len(rows) < vertices + faces:
            raise ValueError(f"{vertices} vertices and {faces} faces are announced, but "
                             f"{len(rows)} lines follow")
        self.vertex_lines = [number for number, _ in rows[:vertices]]
        self.vertices = [words for _, words in rows[:vertices]]
        if any(len(words) < 3 + 3 * self.has_normals for words in self.vertices):
            raise ValueError("a vertex does not have three coordinates" + ", or a normal" * self.has_normals)
        self.points = _numbers([words[:3] for words in self.vertices], "a vertex")
        self.faces = []
        for number, words in rows[vertices:vertices + faces]:
            if not words[0].isdigit() or not 3 <= int(words[0]) < len(words):
                raise ValueError(f"line {number + 1} is no face: {' '.join(words)[:40]}")
            self.faces.append(words)

    def _read_words(self):
        """Several vertices in a line, or faces over several lines: only the last line of a face has
        an end that counts, after its colour."""
        vertices, faces = self.counts
        words = [(word, number) for number, line in self.lines[self.first:] for word in line]
        if len(words) < vertices * self.size + 4 * faces:
            raise ValueError("too few words")
        self.vertex_lines = None
        self.vertices = [[word for word, _ in words[i:i + self.size]]
                         for i in range(0, vertices * self.size, self.size)]
        self.points = _numbers([row[:3] for row in self.vertices], "a vertex")
        place, self.faces = vertices * self.size, []
        for _ in range(faces):
            end = place + 1 + int(words[place][0])
            if end < place + 4:
                raise ValueError("a face of fewer than three vertices")
            last = words[end - 1][1]
            while end < len(words) and words[end][1] == last:
                end += 1
            self.faces.append([word for word, _ in words[place:end]])
            place = end
        if place != len(words):
            raise ValueError("more words than faces have")

    def polygons(self):
        return [[int(word) for word in row[1:int(row[0]) + 1]] for row in self.faces]

    def write(self, points, normals):
        rows = []
        for i, words in enumerate(self.vertices):
            new = points[i] + (normals[i] if self.has_normals else [])
            rows.append((_text_of(new), words[len(new):]))
        if self.vertex_lines is None:
            head = self.text[:self.lines[self.first - 1][0] + 1]
            lines = [" ".join([text, *rest]) for text, rest in rows]
            lines += [" ".join(words) for words in self.faces]
            return "".join(head) + "\n".join(lines) + "\n"
        lines = list(self.text)
        for number, (text, _) in zip(self.vertex_lines, rows):
            before = re.match(r"\s*" + r"\S+\s+" * (text.count(" ")) + r"[^\s#]+", lines[number])[0]
            indent = re.match(r"\s*", before)[0]
            lines[number] = indent + text + lines[number][len(before):]
        return "".join(lines)


def read_off(data: bytes):
    off = _Off(data)
    return off.points.reshape(-1, 3), off.polygons()


def write_off(data: bytes, points, normals):
    """The file with other coordinates and normals, and what was done with its normals."""
    off = _Off(data)
    text = off.write(np.asarray(points, float).tolist(), np.asarray(normals, float).tolist())
    return text.encode("latin-1"), "computed again" if off.has_normals else ""


def beside_off(data: bytes):
    """What there is beside coordinates, faces and normals."""
    off = _Off(data)
    prefix = _OFF.match(off.lines[0][1][0])
    colored = any(len(words) > int(words[0]) + 1 for words in off.faces)
    return (["colours"] * bool(prefix[2]) + ["texture coordinates"] * bool(prefix[1])
            + ["colours of faces"] * colored)


# ---- OBJ -----------------------------------------------------------------------------------------

def _obj_lines(data):
    """(number, line) of each line; one that ends in a backslash goes on in the next line. Comments
    do not: a folder's name may end in one."""
    start, whole = 0, ""
    for number, line in enumerate(data.splitlines(keepends=True), start=1):
        text = line.decode("latin-1")
        start = start if whole else number
        if not (whole or text).lstrip().startswith("#") and text.rstrip().endswith("\\"):
            whole += text.rstrip()[:-1] + " "
            continue
        yield start, whole + text
        whole = ""
    if whole:
        yield start, whole + "\n"


def read_obj(data: bytes):
    points, polygons = [], []
    for number, line in _obj_lines(data):
        words = line.split("#", 1)[0].split()
        if not words:
            continue
        if words[0] == "v":
            if len(words) < 4:
                raise ValueError(f"line {number} is no vertex: {line.strip()[:40]}")
            points.append(words[1:4])
        elif words[0] == "f":
            if len(words) < 4:
                raise ValueError(f"line {number} is no face: {line.strip()[:40]}")
            corners = [int(word.split("/")[0]) for word in words[1:]]
            if 0 in corners:
                raise ValueError(f"line {number}: numbers of vertices start at 1")
            # Negative numbers count from the last vertex so far.
            polygons.append([c - 1 if c > 0 else len(points) + c for c in corners])
    return _numbers(points, "a vertex").reshape(-1, 3), polygons


def write_obj(data: bytes, points, normals):
    """The file with other coordinates, and what was done with its normals. If each vertex has the
    normal of its own number, these are replaced; other ones, which belong to corners, are left out."""
    lines = [line for _, line in _obj_lines(data)]
    keys = [line.split(None, 1)[0] if line.strip() else "" for line in lines]
    new = {"v": iter(np.asarray(points, float).tolist())}
    drop = False
    if "vn" in keys:
        drop = keys.count("vn") != keys.count("v") or any(
            _has_other_normals(line) for line, key in zip(lines, keys) if key == "f")
        new["vn"] = iter(np.asarray(normals, float).tolist())
    result = []
    for line, key in zip(lines, keys):
        if drop and key == "vn":
            continue
        if key in new:
            text = _text_of(next(new[key]))
            line = re.sub(r"^(\s*vn?\s+)\S+\s+\S+\s+[^\s#]+", rf"\g<1>{text}", line, count=1)
        elif drop and key == "f":
            corners, hash_sign, comment = line.partition("#")
            corners = re.sub(r"(?<=\s)(-?\d+)(/-?\d+|/)/-?\d+(?=\s|$)",
                             lambda found: found[1] + found[2].rstrip("/"), corners)
            line = corners + hash_sign + comment
        result.append(line)
    text = "".join(result).encode("latin-1")
    return text, "" if "vn" not in keys else "left out" if drop else "computed again"


def beside_obj(data: bytes):
    """What there is beside coordinates, faces and normals."""
    words = [line.split("#", 1)[0].split() for _, line in _obj_lines(data)]
    keys = {row[0] for row in words if row}
    return (["colours"] * any(row[0] == "v" and len(row) > 6 for row in words if row)
            + ["texture coordinates"] * ("vt" in keys) + ["materials"] * ("usemtl" in keys)
            + ["groups"] * bool(keys & {"g", "o"}) + ["lines"] * ("l" in keys))


def _has_other_normals(face):
    corners = [word.split("/") for word in face.split("#", 1)[0].split()[1:]]
    return any(len(corner) < 3 or corner[0] != corner[2] or corner[0].startswith("-")
               for corner in corners)


# ---- asc: a comment, the two counts, and lines of x y z flag and of a b c flag ------------------------

def _asc_lines(data):
    lines = [line.decode("latin-1") for line in data.splitlines(keepends=True)]
    vertices, faces = (int(word) for word in lines[1].split())
    if min(vertices, faces) < 0 or len(lines) < 2 + vertices + faces:
        raise ValueError(f"{vertices} vertices and {faces} faces are announced, but {len(lines) - 2} lines follow")
    return lines, vertices, faces


def read_asc(data: bytes):
    lines, vertices, faces = _asc_lines(data)
    points = _numbers([line.split()[:3] for line in lines[2:2 + vertices]], "a vertex").reshape(-1, 3)
    rows = [[int(word) for word in line.split()[:3]] for line in lines[2 + vertices:2 + vertices + faces]]
    return points, rows


def write_asc(data: bytes, points, normals):
    lines, vertices, _ = _asc_lines(data)
    for i, row in enumerate(np.asarray(points, float).tolist()):
        flag = re.search(r"[^\s]*\s*$", lines[2 + i])[0]
        lines[2 + i] = _text_of(row) + " " + flag
    return "".join(lines).encode("latin-1"), ""


#: The reader and the writer of each kind of file.
FORMATS = {"off": (read_off, write_off), "obj": (read_obj, write_obj), "asc": (read_asc, write_asc)}
