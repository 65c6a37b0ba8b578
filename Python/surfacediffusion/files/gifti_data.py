# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Data in GIFTI files. A column is (number of the array, number of its column or None)."""
from __future__ import annotations

import copy
import io
import os
import re

import numpy as np

from .content import import_reader

_SURFACE_INTENTS = (1008, 1009)  # NIFTI_INTENT_POINTSET, NIFTI_INTENT_TRIANGLE
_LABEL_INTENT = 1002
_INDEX_INTENT = 2002  # NIFTI_INTENT_NODE_INDEX
_ASCII, _BASE64_GZIP, _EXTERNAL = 1, 3, 4
_ROWS_FIRST = 1
_INT32, _FLOAT32 = 8, 16


def read_image(content):
    """The image. Arrays may be in another file of the same folder, as SPM and CAT write them; they
    are written into the file itself."""
    import_reader("nibabel.gifti", content)
    from nibabel.gifti.parse_gifti_fast import GiftiImageParser

    class Parser(GiftiImageParser):
        def StartElementHandler(self, name, attrs):
            if name == "DataArray":
                _check_dimensions(attrs)
                if attrs.get("Encoding") == "ExternalFileBinary":
                    self.check_file(attrs.get("ExternalFileName", ""))
            super().StartElementHandler(name, attrs)

        @staticmethod
        def check_file(other):
            if os.path.basename(other) != other:
                raise content.error(f"data in the file {other}; allowed: in the folder of the GIFTI "
                                    "file")
            if not os.path.isfile(os.path.join(os.path.dirname(file.name), other)):
                raise content.error(f"there is no file {other} with its data in the same folder")

        def EndElementHandler(self, name):
            super().EndElementHandler(name)
            if name == "DataArray":
                columns.keep(self.img.darrays[-1], getattr(self, "expected_numDA", 0))

    columns = _Columns()
    parser = Parser()
    if content.partial:
        file = open(os.path.abspath(content.path), "rb")
    else:
        file = io.BytesIO(content.bytes)
        file.name = os.path.abspath(content.path)  # in whose folder the parser looks
    with file:
        parser.parse(fptr=file)
    for array in parser.img.darrays:
        if array.encoding == _EXTERNAL:
            array.data = np.array(array.data)
        if array.encoding in (_ASCII, _EXTERNAL):  # nibabel writes text with six digits, and by rows always
            array.encoding, array.ind_ord = _BASE64_GZIP, _ROWS_FIRST
        array.ext_fname, array.ext_offset = "", 0  # or a name that nothing reads
        # Other types are read, but GIFTI has three, and nibabel writes no others.
        kind = array.data.dtype.kind if array.data is not None else ""
        if kind == "f":
            array.datatype = _FLOAT32
        elif kind in "iu" and kind and array.data.dtype != np.uint8 and (
                array.data.size == 0 or -2**31 <= array.data.min() <= array.data.max() < 2**31):
            array.datatype = _INT32
    return parser.img


class _Columns:
    """The arrays of single precision, one number per vertex, as rows of one block: many of them are in memory
    once."""

    def __init__(self):
        self.block = None
        self.count = 0

    def keep(self, array, expected):
        """expected: the number of arrays, as the file has it."""
        data = array.data
        if data is None or data.ndim != 1 or data.dtype != np.float32 or array.encoding == _EXTERNAL:
            return
        if self.block is None and 1 < expected < 1 << 24 and data.size:
            try:
                self.block = np.empty((expected, len(data)), np.float32)
            except MemoryError:
                return
        if self.block is not None and self.count < len(self.block) and len(data) == self.block.shape[1]:
            self.block[self.count] = data
            array.data = self.block[self.count]
            self.count += 1


def stacked(arrays):
    """The arrays of one length as columns; without a copy if they are the rows of a block."""
    block = arrays[0].base
    if isinstance(block, np.ndarray) and block.ndim == 2 and len(arrays) <= len(block) and all(
            array.base is block and array.ctypes.data == row.ctypes.data for array, row in zip(arrays, block)):
        return block[:len(arrays)].T
    return np.column_stack(arrays)


def _check_dimensions(attributes):
    """nibabel counts to any number."""
    count = attributes.get("Dimensionality", "0")
    sizes = [attributes.get(f"Dim{i}", "") for i in range(int(count) if re.fullmatch("[1-6]", count) else 0)]
    if not sizes or not all(re.fullmatch(r"\d{1,15}", size) for size in sizes):
        raise ValueError(f"an array of Dimensionality {count[:20]!r} with sizes {', '.join(sizes)[:60] or 'none'}"
                         "; allowed: 1 to 6, and a size for each")


def read(content):
    """The image, its columns, the vertices that their rows belong to (None: all in order), and the
    structure of the brain that it belongs to."""
    image = read_image(content)
    columns, vertices = [], None
    for i, array in enumerate(image.darrays):
        if array.intent in _SURFACE_INTENTS:
            continue
        if array.data is None or array.data.ndim > 2:
            raise ValueError(f"array {i + 1} is not of one or two dimensions")
        if array.intent == _INDEX_INTENT:
            if vertices is not None:
                raise content.error("several arrays of numbers of vertices; allowed: one")
            vertices = array.data.ravel()
        elif array.data.ndim == 1:
            columns.append((i, None))
        else:
            columns.extend((i, j) for j in range(array.data.shape[1]))
    if not columns and image.darrays:
        raise content.error("a GIFTI surface, which has no data at vertices; allowed: "
                            ".func.gii, .shape.gii, .label.gii")
    if vertices is not None:
        if vertices.dtype.kind not in "iu" or len(np.unique(vertices)) != len(vertices):
            raise content.error("NIFTI_INTENT_NODE_INDEX has a vertex twice, or numbers with a "
                                "fraction; allowed: each vertex at most once")
        vertices = vertices.astype(np.int64)
    return image, columns, vertices, image.meta.get("AnatomicalStructurePrimary") or ""


def column(image, place):
    i, j = place
    data = image.darrays[i].data
    return data if j is None else data[:, j]


def name(image, place):
    i, j = place
    text = image.darrays[i].meta.get("Name") or ""
    return text if j is None else f"{text}[{j}]"


def has_labels(image):
    return any(array.intent == _LABEL_INTENT for array in image.darrays)


def label_names(image):
    """{number: name} of the table of labels."""
    return image.labeltable.get_labels_as_dict() if has_labels(image) else {}


def write(image, places, values):
    """The parts of a file with these columns of the image alone, and new values in them."""
    from nibabel import gifti

    written = {i for i, _ in places}.union(i for i, array in enumerate(image.darrays) if array.intent == _INDEX_INTENT)
    changed = copy.copy(image)
    changed.darrays = []
    begin, end, _ = changed.to_bytes().rpartition(b"</GIFTI>")
    yield begin.replace(b'NumberOfDataArrays="0"', b'NumberOfDataArrays="%d"' % len(written), 1)
    for array in _changed_arrays(image, places, values):
        content = gifti.GiftiImage(darrays=[array]).to_bytes()
        yield content[content.index(b"<DataArray"):content.rindex(b"</GIFTI>")]
    yield end


def _changed_arrays(image, places, values):
    """Each array of write()."""
    columns = {}
    for c, (i, _) in enumerate(places):
        columns.setdefault(i, []).append(c)
    for i, array in enumerate(image.darrays):
        chosen = columns.get(i)
        if array.intent == _INDEX_INTENT:
            yield array
        if not chosen:
            continue
        array = copy.copy(array)
        are_labels = array.intent == _LABEL_INTENT
        data = np.asarray(values)[:, chosen].astype(np.int32 if are_labels else np.float32)
        array.data = data[:, 0] if image.darrays[i].data.ndim == 1 else data
        array.dims = list(array.data.shape)
        array.datatype = _INT32 if are_labels else _FLOAT32
        yield array


def without_numbers(image, places):
    """The image and its columns for data at all vertices, without numbers of those that have some."""
    kept = [i for i, array in enumerate(image.darrays) if array.intent != _INDEX_INTENT]
    changed = copy.copy(image)
    changed.darrays = [image.darrays[i] for i in kept]
    return changed, [(kept.index(i), j) for i, j in places]


def new(surface, names):
    """An image for new columns on a surface, and its columns."""
    from nibabel import gifti

    meta = {"AnatomicalStructurePrimary": surface.structure} if surface.structure else {}
    arrays = [
        gifti.GiftiDataArray(np.zeros(1, dtype=np.float32), intent="NIFTI_INTENT_NONE",
                             datatype="NIFTI_TYPE_FLOAT32", meta={"Name": text})
        for text in names]
    image = gifti.GiftiImage(darrays=arrays, meta=gifti.GiftiMetaData(meta))
    return image, [(i, None) for i in range(len(names))]
