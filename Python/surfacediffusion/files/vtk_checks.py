# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What is checked of a file of VTK before VTK reads it. Its readers trust a file: they allocate what it
announces, and end the process where they cannot, and read beyond their memory where cells are not as they
are counted. The functions raise ValueError."""
from __future__ import annotations

import base64
import re
from xml.parsers import expat

import numpy as np

# ---- XML -----------------------------------------------------------------------------------------

#: The names of the cells of a piece
_CELLS = ("Verts", "Lines", "Strips", "Polys")

#: The bytes that a compressor makes of one byte at most
_EXPANSION = {"vtkZLibDataCompressor": 1100, "vtkLZ4DataCompressor": 260, "vtkLZMADataCompressor": 10000}


class _Xml:
    """Goes through the elements of a file. What its arrays announce is at most what its bytes can hold.

    type     "PolyData", ...
    offsets  of the cells, their attributes and text
    """

    def __init__(self, data):
        self.data, self.type, self.compressor = data, "", ""
        self.number = np.dtype("u4")  #: of the lengths before arrays
        self.announced, self.places, self.piece = 0, set(), {}
        self.parents, self.offsets, self.root = [], [], b""
        self.appended = re.search(rb"<AppendedData\b[^>]*>\s*_", data)
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler, self.parser.EndElementHandler = self._start, self._end
        try:
            # Raw bytes behind the mark are no XML.
            self.parser.Parse(data[:self.appended.end()] if self.appended else data, self.appended is None)
        except expat.ExpatError as error:
            raise ValueError(f"no XML: {error}") from None

    def _start(self, name, given):
        if name == "VTKFile":
            self.type, self.compressor = given.get("type", ""), given.get("compressor", "")
            self.root = self.data[self.parser.CurrentByteIndex:self._end_of_tag()]
            self.number = np.dtype("u8" if given.get("header_type") == "UInt64" else "u4").newbyteorder(
                ">" if given.get("byte_order") == "BigEndian" else "<")
        elif name == "Piece":
            self.piece = {key: _count(value, key) for key, value in given.items() if key.startswith("NumberOf")}
            for key, count in self.piece.items():
                self._announce(count, key)
        elif name in ("DataArray", "Array"):
            self._array(given)
        self.parents.append(name)

    def _end(self, name):
        self.parents.pop()
        if name == "DataArray" and self.offsets and self.offsets[-1][1] is None:
            given, _, start = self.offsets[-1]
            self.offsets[-1] = given, self.data[start:self.parser.CurrentByteIndex], start

    def _end_of_tag(self):
        """An attribute may hold the sign that ends the tag."""
        tag = re.compile(rb"<(?:[^\"'>]|\"[^\"]*\"|'[^']*')*>").match(self.data, self.parser.CurrentByteIndex)
        return tag.end() if tag else self.parser.CurrentByteIndex

    def _announce(self, count, what):
        self.announced += count
        if self.announced > self.room:
            raise ValueError(f"{what} announces {count} numbers, the file has {len(self.data)} bytes")

    @property
    def room(self):
        return len(self.data) * _EXPANSION.get(self.compressor, 1)

    def _array(self, given):
        parent, name = self.parents[-1] if self.parents else "", given.get("Name", "")
        components = _count(given.get("NumberOfComponents") or 3 ** (parent == "Points"), "NumberOfComponents")
        if parent in ("Points", "PointData"):
            tuples = self.piece.get("NumberOfPoints", 0)
        elif parent == "CellData":
            tuples = sum(self.piece.get("NumberOf" + cells, 0) for cells in (*_CELLS, "Cells"))
        elif parent in (*_CELLS, "Cells"):
            tuples = self.piece.get("NumberOf" + parent, 0) if name in ("offsets", "types") else 0
            if name == "offsets":
                self.offsets.append(({**given, "NumberOfTuples": tuples}, None, self._end_of_tag()))
            elif name not in ("types", "connectivity") and tuples:
                raise ValueError(f"cells with {name[:40]!r}, as volumes have; allowed: polygons")
        else:
            tuples = _count(given.get("NumberOfTuples") or 0, "NumberOfTuples")
        place = given.get("offset", "")
        if not place or place not in self.places:  # arrays may share their bytes
            bits = 1 if given.get("type") == "Bit" else 8
            self._announce(components * tuples * bits // 8, f"the array {name}")
        self.places.add(place)
        self._check_length(given.get("format", "ascii"), place)

    def _check_length(self, form, place):
        """The bytes that are announced before the bytes of an array."""
        if form == "binary":
            start, raw = self._end_of_tag(), False
        elif form == "appended" and self.appended:
            start, raw = self.appended.end() + _count(place, "offset"), b'"raw"' in self.appended[0]
        else:
            return
        sizes = self._lengths(start, raw, 3 if self.compressor else 1)
        if self.compressor and sizes:
            # Blocks of a compressed array have a length each but the last one, and lengths of their bytes.
            blocks, size, last = sizes
            packed = self._lengths(start, raw, 3 + blocks)[3:] if blocks <= len(self.data) else [len(self.data) + 1]
            if blocks * size > self.room or last > size * (blocks > 0) or sum(packed) > len(self.data):
                raise ValueError(f"an array announces {blocks} blocks of {size} bytes, the last of {last}, the "
                                 f"file has {len(self.data)}")
        elif sizes and sizes[0] > len(self.data):
            raise ValueError(f"an array announces {sizes[0]} bytes, the file has {len(self.data)}")

    def _lengths(self, start, raw, count):
        """So many numbers before an array; none if the file ends, which VTK says."""
        size = count * self.number.itemsize
        head = self.data[start:start + size]
        if not raw:
            digits = (size + 2) // 3 * 4
            head = base64.b64decode(re.sub(rb"\s", b"", self.data[start:start + digits + 200])[:digits])
        return np.frombuffer(head, self.number, count).tolist() if len(head) >= size else []

    def file_of_offsets(self):
        """A file without points and cells, whose arrays are the offsets of the cells of this one."""
        arrays = b""
        for given, text, _ in self.offsets:
            words = {key: str(given[key]) for key in ("type", "NumberOfTuples", "format", "offset") if key in given}
            if not all(re.fullmatch(r"[\w ]+", word) for word in words.values()):
                raise ValueError(f"offsets of cells described as {words}")
            attributes = " ".join(f'{key}="{word}"' for key, word in words.items())
            arrays += f'<DataArray Name="{len(arrays)}" {attributes}>'.encode() + (text or b"") + b"</DataArray>"
        kind, empty = self.type.encode(), b'<DataArray type="%s" Name="%s" %sformat="ascii"/>'
        piece = b'<Piece NumberOfPoints="0" NumberOfCells="0"><Points>' + empty % (
            b"Float32", b"Points", b'NumberOfComponents="3" ') + b"</Points>"
        if self.type == "UnstructuredGrid":
            piece += b"<Cells>" + b"".join(empty % (number, name, b"") for number, name in (
                (b"Int64", b"connectivity"), (b"Int64", b"offsets"), (b"UInt8", b"types"))) + b"</Cells>"
        return (self.root + b"<%s><FieldData>" % kind + arrays + b"</FieldData>" + piece + b"</Piece></%s>" % kind
                + (self.data[self.appended.start():] if self.appended else b"</VTKFile>"))


def _count(text, name):
    if not re.fullmatch(r"\s*\d{1,18}\s*", str(text)):
        raise ValueError(f"{name} is {str(text)[:40]!r}; allowed: a count")
    return int(text)


def check_xml(data, read):
    """The type of the data of a VTK XML file. read(type, bytes): the object of VTK that a file is."""
    found = _Xml(data)
    if found.type in ("PolyData", "UnstructuredGrid") and found.offsets:
        # VTK allocates as many corners as the last one says.
        fields = read(found.type, found.file_of_offsets()).GetFieldData()
        for array in map(fields.GetArray, range(fields.GetNumberOfArrays())):
            low, high = array.GetRange() if array is not None and array.GetNumberOfTuples() else (0, 0)
            if not 0 <= low <= high <= found.room:
                raise ValueError(f"the offsets of cells are {low:.10g} to {high:.10g}, the file has {len(data)} "
                                 "bytes")
    return found.type


# ---- legacy --------------------------------------------------------------------------------------

#: The bits of a number in a binary file
_BITS = {"bit": 1, "char": 8, "signed_char": 8, "unsigned_char": 8, "short": 16, "unsigned_short": 16, "int": 32,
         "unsigned_int": 32, "long": 64, "unsigned_long": 64, "long_long": 64, "unsigned_long_long": 64,
         "vtktypeint32": 32, "vtktypeint64": 64, "vtktypeuint64": 64, "vtkidtype": 32, "float": 32, "double": 64}

#: The numbers of a tuple of an attribute; of the others they stand in the file
_COMPONENTS = {"vectors": 3, "normals": 3, "tensors": 9, "tensors6": 6, "global_ids": 1, "pedigree_ids": 1,
               "edge_flags": 1}

_DATASETS = {"polydata": ("vertices", "lines", "polygons", "triangle_strips"), "unstructured_grid": ("cells",)}

_BLANK = np.isin(np.arange(256), list(b" \t\n\v\f\r"))
_OF_NUMBERS = _BLANK | np.isin(np.arange(256), list(b"0123456789+-.eEinfatyINFATY"))


class _Legacy:
    """Goes through the words and numbers of a file as VTK's reader does, and is stricter."""

    def __init__(self, data):
        self.data, self.bytes = data, np.frombuffer(data, np.uint8)
        head = re.match(rb"# vtk DataFile Version (\d)\.\d[ \t\r]*\n[^\n]*\n\s*(ascii|binary)\s+dataset\s+(\w+)",
                        data, re.IGNORECASE)
        if head is None:
            raise ValueError("it does not start with a version, 1.0 to 5.1, a title, ASCII or BINARY, and DATASET")
        self.has_offsets = head[1] >= b"5"
        self.is_text = head[2].lower() == b"ascii"
        self.type = head[3].decode("latin-1").lower()
        self.place, self.points, self.cells, self.starts = head.end(), 0, 0, None

    def read(self):
        if self.type not in _DATASETS:
            raise ValueError(f"DATASET {self.type.upper()}; allowed: "
                             + ", ".join(map(str.upper, _DATASETS)))
        tuples = None  # of attributes, which follow the geometry
        while word := self._word().lower():
            if word in ("point_data", "cell_data"):
                expected = self.points if word == "point_data" else self.cells
                tuples = self._count()
                if tuples != expected:
                    raise ValueError(f"{word.upper()} {tuples}; allowed: {expected}")
            elif word == "field":
                self._field()
            elif word == "metadata":
                self._metadata()
            elif tuples is not None:
                self._attribute(word, tuples)
            elif word == "points":
                self.points = self._count()
                self._skip(self.points, 3, self._word())
            elif word == "cell_types":
                self._skip(self._count(), 1, "int")
            elif word in _DATASETS[self.type]:
                self._cells(word)
            else:
                raise ValueError(f"{word[:40]!r} is no word of DATASET {self.type.upper()}")
        return self.type

    def _word(self):
        """The next one; empty at the end of the file."""
        found = re.compile(rb"\s*(\S{0,255})").match(self.data, self.place)
        self.place = found.end()
        return found[1].decode("latin-1")

    def _count(self):
        word = self._word()
        if not re.fullmatch(r"\d{1,18}", word):
            raise ValueError(f"{word[:40]!r}; allowed: a count")
        return int(word)

    def _numbers(self, count, kind):
        """The bytes of so many numbers, of which a description may follow."""
        bits = _BITS.get(kind.lower())
        if bits is None:
            raise ValueError(f"{kind[:40]!r}; allowed: a type of numbers, " + ", ".join(_BITS))
        if self.is_text:
            if self.starts is None:
                blank = _BLANK[self.bytes]
                self.starts = np.flatnonzero(~blank & np.concatenate([[True], blank[:-1]]))
            first = np.searchsorted(self.starts, self.place)
            if first + count > len(self.starts):
                raise ValueError(f"{count} numbers are announced, {len(self.starts) - first} words follow")
            end = int(self.starts[first + count]) if first + count < len(self.starts) else len(self.data)
            found = self.bytes[self.place:end]
            if not _OF_NUMBERS[found].all():
                raise ValueError(f"{count} numbers are announced, among which is a word")
        else:
            line = re.compile(rb"[ \t\r]*\n").match(self.data, self.place)
            start, size = line.end() if line else self.place, (count * bits + 7) // 8
            if line is None or start + size > len(self.data):
                raise ValueError(f"{size} bytes are announced, {len(self.data) - start} follow")
            end = start + size
            found = self.bytes[start:end]
        self.place = end
        return found.tobytes()

    def _skip(self, tuples, components, kind):
        count = tuples * components
        if kind.lower() == "string":
            self._strings(count)
        elif count:
            self._numbers(count, kind)
        following = self.place
        if self._word().lower() == "metadata":
            self._metadata(components)
        else:
            self.place = following

    def _strings(self, count):
        """Text has a line for each, binary files their lengths in as many bytes as two bits say."""
        line = re.compile(rb"[^\n]*\n")
        self.place = line.match(self.data, self.place).end() if count else self.place
        for _ in range(count):
            if self.is_text:
                size = len(line.match(self.data, self.place)[0])
            else:
                width = (8, 4, 2, 1)[self.data[self.place] >> 6]
                size = int.from_bytes(self.data[self.place:self.place + width], "big") & (1 << 8 * width - 2) - 1
                self.place += width
            self.place += size
            if self.place > len(self.data):
                raise ValueError("a string is longer than the file")

    def _metadata(self, components=1):
        """To an empty line; names of components have a line each, which may be empty."""
        line, names = re.compile(rb"[^\n]*\n?"), 0
        self.place = line.match(self.data, self.place).end()
        while self.place < len(self.data):
            text = line.match(self.data, self.place)
            self.place = text.end()
            if names:
                names -= 1
            elif text[0].lower().startswith(b"component_names"):
                names = components
            elif not text[0].strip():
                break

    def _field(self):
        self._word()
        for _ in range(self._count()):
            name = self._word()
            if name.lower() == "metadata":
                self._metadata()
                name = self._word()
            if name.lower() != "null_array":
                components, tuples = self._count(), self._count()
                self._skip(tuples, components, self._word())

    def _attribute(self, word, tuples):
        self._word()  # its name
        if word == "lookup_table":
            self._skip(self._count(), 4, "float" if self.is_text else "unsigned_char")
        elif word == "color_scalars":
            self._skip(tuples, self._count(), "float" if self.is_text else "unsigned_char")
        elif word == "texture_coordinates":
            components = self._count()
            self._skip(tuples, components, self._word())
        elif word == "scalars":
            kind, components = self._word(), 1
            following = self._word()
            if following.isdigit():
                components, following = int(following[:18]), self._word()
            if following.lower() != "lookup_table":
                raise ValueError(f"SCALARS without LOOKUP_TABLE, but {following[:40]!r}")
            self._word()
            self._skip(tuples, components, kind)
        elif word in _COMPONENTS:
            self._skip(tuples, _COMPONENTS[word], self._word())
        else:
            raise ValueError(f"{word[:40]!r} is no attribute of points or cells")

    def _integers(self, count, kind):
        if not re.fullmatch("int|long|long_long|vtktypeint(32|64)|vtkidtype", kind.lower()):
            raise ValueError(f"{kind[:40]!r}; allowed: a type of whole numbers")
        found, bits = self._numbers(count, kind) if count else b"", _BITS[kind.lower()]
        if self.is_text:
            return np.array(found.split(), "S").astype(np.int64)
        return np.frombuffer(found, f">i{bits // 8}").astype(np.int64)

    def _cells(self, word):
        """The corners of each cell are its own, and points of the file."""
        count, size = self._count(), self._count()
        if self.has_offsets and count:
            offsets = corners = None
            for name in ("offsets", "connectivity"):
                if self._word().lower() != name:
                    raise ValueError(f"{word.upper()} without {name.upper()}, as version 5 has")
                numbers = self._integers(count if name == "offsets" else size, self._word())
                offsets, corners = (numbers, None) if offsets is None else (offsets, numbers)
            if offsets[0] != 0 or offsets[-1] != size or (np.diff(offsets) < 0).any():
                raise ValueError(f"the OFFSETS of {word.upper()} do not ascend from 0 to {size}")
            self.cells += count - 1
        else:
            corners = _corners(self._integers(size, "int"), count, word.upper())
            self.cells += count
        if len(corners) and not 0 <= corners.min() <= corners.max() < self.points:
            bad = corners.max() if corners.min() >= 0 else corners.min()
            raise ValueError(f"{word.upper()} refer to point {bad}; allowed: 0 to {self.points - 1}")


def _corners(numbers, count, word):
    """Of cells, each of which is the number of its corners and these."""
    if count and len(numbers) % count == 0:
        rows = numbers.reshape(count, -1)
        if (rows[:, 0] == rows.shape[1] - 1).all():
            return rows[:, 1:]
    place, listed = 0, numbers.tolist()
    is_corner = np.ones(len(numbers), dtype=bool)
    for _ in range(count):
        if place >= len(listed) or not 0 <= listed[place] < len(listed) - place:
            raise ValueError(f"{word} {count} {len(numbers)}, but its cells have another number of corners")
        is_corner[place] = False
        place += 1 + listed[place]
    if place != len(listed):
        raise ValueError(f"{word} {count} {len(numbers)}, but its cells have {place} numbers")
    return numbers[is_corner]


def check_legacy(data):
    """The type of the data of a legacy VTK file: "polydata" or "unstructured_grid"."""
    return _Legacy(data).read()
