# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""PLY files, text and binary, with any elements and properties. Writing replaces columns of the
element `vertex`; all other bytes of the file stay as they are: header, comments, order, faces."""
from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np

_TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
          "float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2",
          "uint16": "u2", "int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8"}
_NAMES = {"f4": "float", "f8": "double"}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


@dataclass
class Property:
    name: str
    type: np.dtype
    count: np.dtype | None = None  #: of the number of values of a list


@dataclass
class Element:
    name: str
    count: int
    properties: list[Property] = field(default_factory=list)


@dataclass
class Ply:
    """header: the lines with their ends; body: all other bytes; vertices: {name: column};
    span: the first and last byte of the vertices in the body, or line if it is text; faces: lists of
    vertices, or (m, k)."""

    header: list[bytes]
    body: bytes
    order: str  #: "<" or ">", empty for text
    elements: list[Element]
    vertices: dict[str, np.ndarray] = field(default_factory=dict)
    span: tuple[int, int] = (0, 0)
    faces: list = field(default_factory=list)

    @property
    def points(self):
        missing = [axis for axis in "xyz" if axis not in self.vertices]
        if missing:
            raise ValueError(f"the vertices have no property {missing[0]}")
        return np.column_stack([self.vertices[axis] for axis in "xyz"])

    def write(self, columns) -> bytes:
        """The file with these columns {name: values} of the vertices; new ones come last, and have names
        without spaces, which end a name in the header."""
        columns = {name if name in self.vertices else re.sub(r"\s+", "_", name.strip()) or "value": values
                   for name, values in columns.items()}
        new = [name for name in columns if name not in self.vertices]
        header = b"".join(self._header_with({name: columns[name] for name in new}))
        whole = {**self.vertices, **{name: np.asarray(v) for name, v in columns.items()}}
        if not self.order:
            lines = lines_of(self.body)
            end = b"\r\n" if b"\r\n" in self.header[0] else b"\n"
            start, stop = self.span
            rows = [line.split() for line in lines[start:stop]]
            names = list(self.vertices)
            for name, values in columns.items():
                words = values.astype(self._type(name, values)).astype("S").tolist()
                for row, word in zip(rows, words):
                    if name in new:
                        row.append(word)
                    else:
                        row[names.index(name)] = word
            lines[start:stop] = [b" ".join(row) for row in rows]
            return header + end.join(lines) + end
        kinds = [(name, np.dtype(self.order + self._type(name, values).str[1:]))
                 for name, values in whole.items()]
        rows = np.empty(len(next(iter(whole.values()))), dtype=kinds)
        for name, values in whole.items():
            rows[name] = values
        start, stop = self.span
        return header + self.body[:start] + rows.tobytes() + self.body[stop:]

    def _type(self, name, values):
        """That of the file; new columns are float, or double if they are."""
        if name in self.vertices:
            return self.vertices[name].dtype
        return np.dtype("f8" if values.dtype == np.float64 else "f4")

    def _header_with(self, columns):
        if not columns:
            return self.header
        lines = list(self.header)
        words = [line.split() for line in lines]
        place = next(i for i, w in enumerate(words) if w[:2] == [b"element", b"vertex"]) + 1
        while words[place][:1] in ([b"property"], [b"comment"], [b"obj_info"]):
            place += 1
        end = re.search(rb"\s*$", lines[0])[0]
        lines[place:place] = [
            f"property {_NAMES[self._type(name, values).str[1:]]} {name}".encode() + end
            for name, values in columns.items()]
        return lines


def read(data: bytes) -> Ply:
    ply = _read_header(data)
    reader = _BinaryReader(ply.body) if ply.order else _TextReader(ply.body)
    strips = []
    for element in ply.elements:
        if element.name == "vertex":
            if any(p.count is not None for p in element.properties):
                raise ValueError("the vertices have lists; allowed: numbers")
            start = reader.place
            ply.vertices = reader.numbers(element)
            ply.span = (start, reader.place)
            continue
        corners = next((p for p in element.properties if p.count is not None and p.name in (
            "vertex_indices", "vertex_index")), None)
        found = reader.lists(element, corners)
        if element.name == "face":
            ply.faces = found
        elif element.name == "tristrips":
            strips = found
    if len(strips):
        ply.faces = [*map(list, ply.faces), *_triangles_of(strips)]
    return ply


def _read_header(data):
    lines, place = [], 0
    while not lines or lines[-1].split() != [b"end_header"]:
        line = re.compile(rb"[^\r\n]*(\r\n|\n|\r)").match(data, place)
        if line is None or place > 1 << 20:
            raise ValueError("the header has no end")
        lines.append(line[0])
        place = line.end()
    order, elements = None, []
    for line in lines:
        words = line.decode("latin-1").split()
        if words[:1] == ["format"]:
            if len(words) < 2 or words[1] not in _ORDERS:
                raise ValueError(f"{' '.join(words)[:40]!r}; allowed: {', '.join(_ORDERS)}")
            order = _ORDERS[words[1]]
        elif words[:1] == ["element"]:
            if len(words) != 3 or not words[2].isdigit() or len(words[2]) > 15:
                raise ValueError(f"{' '.join(words)[:40]!r}; allowed: element, its name and number")
            elements.append(Element(words[1], int(words[2])))
        elif words[:1] == ["property"]:
            if not elements:
                raise ValueError("a property stands before all elements")
            elements[-1].properties.append(_read_property(words, order or "="))
    if order is None:
        raise ValueError("the header does not say the format")
    names = [element.name for element in elements]
    if names.count("vertex") != 1:
        raise ValueError(f"{names.count('vertex')} elements are named vertex; allowed: one")
    return Ply(lines, data[place:], order, elements)


def _read_property(words, order):
    is_list = words[1:2] == ["list"]
    types = words[2:4] if is_list else words[1:2]
    if len(words) != (5 if is_list else 3) or any(word not in _TYPES for word in types):
        raise ValueError(f"{' '.join(words)[:60]!r}; allowed: property, its type and name")
    kinds = [np.dtype(order + _TYPES[word]) for word in types]
    if is_list and kinds[0].kind == "f":
        raise ValueError(f"the length of {words[4]} is {types[0]}; allowed: an integer")
    return Property(words[-1], kinds[-1], kinds[0] if is_list else None)


def _triangles_of(strips):
    """Triangles of one orientation; -1 starts a new strip."""
    triangles = []
    for strip in strips:
        flip, row = False, []
        for vertex in np.asarray(strip).tolist():
            row = [] if vertex == -1 else [*row[-2:], vertex]
            flip = len(row) == 3 and not flip
            if len(row) == 3 and len(set(row)) == 3:
                triangles.append(row if flip else [row[1], row[0], row[2]])
    return triangles


class _BinaryReader:
    def __init__(self, body):
        self.body, self.place = body, 0

    def numbers(self, element):
        rows = self._rows(element, [(p.name, p.type) for p in element.properties])
        if rows is None:
            raise ValueError(f"the file ends within the element {element.name}")
        return {p.name: rows[p.name].astype(p.type.newbyteorder("=")) for p in element.properties}

    def _rows(self, element, kinds):
        """Rows of one size; None if the file has fewer bytes."""
        kind = np.dtype(kinds)
        if element.count * kind.itemsize > len(self.body) - self.place:
            return None
        rows = np.frombuffer(self.body, kind, element.count, self.place)
        self.place += element.count * kind.itemsize
        return rows

    def lists(self, element, wanted):
        """The lists of the property `wanted`, or none; the place is after the element."""
        if not element.properties:
            return []
        rows = self._equal_rows(element)
        if rows is None:
            return self._any_lists(element, wanted)
        numbers = [i for i, p in enumerate(element.properties) if p is wanted]
        return rows[str(numbers[0])].astype(np.int64) if numbers else []

    def _equal_rows(self, element):
        """Rows whose lists have the lengths that they have in the first row, as triangles have; None
        if there are others."""
        start, kinds = self.place, []
        for number, p in enumerate(element.properties):
            if p.count is None:
                kinds.append((str(number), p.type))
                continue
            place = start + np.dtype(kinds).itemsize
            if not element.count or place + p.count.itemsize > len(self.body):
                return None
            length = int(np.frombuffer(self.body, p.count, 1, place)[0])
            if not 0 <= length * p.type.itemsize <= len(self.body):
                return None
            kinds += [(f"length {number}", p.count), (str(number), p.type, (length,))]
        rows = self._rows(element, kinds)
        names = [name for name, *_ in kinds if name.startswith("length")]
        if rows is None or all((rows[name] == rows[name][0]).all() for name in names):
            return rows
        self.place = start
        return None

    def _any_lists(self, element, wanted):
        found = []
        for _ in range(element.count):
            for p in element.properties:
                length = 1
                if p.count is not None:
                    length = int(self._take(element, p.count, 1)[0])
                values = self._take(element, p.type, length)
                if p is wanted:
                    found.append(values.tolist())
        return found

    def _take(self, element, kind, count):
        if not 0 <= count * kind.itemsize <= len(self.body) - self.place:
            raise ValueError(f"the file ends within the element {element.name}")
        values = np.frombuffer(self.body, kind, count, self.place)
        self.place += values.nbytes
        return values


class _TextReader:
    """One row is one line."""

    def __init__(self, body):
        self.lines, self.place = lines_of(body), 0

    def _take(self, element):
        rows = self.lines[self.place:self.place + element.count]
        if len(rows) < element.count:
            raise ValueError(f"the file ends within the element {element.name}")
        self.place += element.count
        return [row.split() for row in rows]

    def numbers(self, element):
        rows = self._take(element)
        if any(len(row) != len(element.properties) for row in rows):
            raise ValueError(f"a line of the element {element.name} does not have "
                             f"{len(element.properties)} numbers")
        values = np.array([[float(word) for word in row] for row in rows]).reshape(
            len(rows), len(element.properties))
        return {p.name: _as_type(values[:, i], p) for i, p in enumerate(element.properties)}

    def lists(self, element, wanted):
        found = []
        for row in self._take(element):
            place = 0
            for p in element.properties:
                length = 1
                if p.count is not None and place < len(row):
                    length = int(row[place])
                    place += 1
                if not 0 <= length <= len(row) - place:
                    raise ValueError(f"a line of the element {element.name} is too short")
                if p is wanted:
                    found.append([int(word) for word in row[place:place + length]])
                place += length
        return found


def lines_of(body):
    return [line for line in body.splitlines() if line.strip()]


def _as_type(values, p):
    if p.type.kind in "iu":
        limits = np.iinfo(p.type)
        if not ((values >= limits.min) & (values <= limits.max)).all():
            raise ValueError(f"{p.name} has values beyond {limits.min} to {limits.max}")
    with np.errstate(over="ignore"):
        return values.astype(p.type.newbyteorder("="))
