# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""CIFTI files: maps or time points, in rows, of vertices of surfaces and of voxels. A file on disk is read
and written by structures and a few rows at a time, since time series are larger than memory."""
from __future__ import annotations

import contextlib
import gzip
import io
import os
import re
import shutil
import tempfile
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from .content import Content, FileError, import_reader, is_compressed, reading, silent_log
from .content import writing_atomically

_EXTENSION = 32  # the code of the description of a CIFTI matrix in a NIfTI file


@dataclass
class Structure:
    """The columns of a CIFTI matrix that belong to one structure of the brain.

    name      "CortexLeft", "ThalamusRight", ...
    place     the slice of these columns
    vertices  (v,) the numbers of vertices; None for voxels
    size      number of vertices of the surface
    voxels    (v, 3) the indices of voxels; None for vertices
    affine    (4, 4) from indices to coordinates in mm
    """

    name: str
    place: slice
    vertices: np.ndarray | None = None
    size: int | None = None
    voxels: np.ndarray | None = None
    affine: np.ndarray | None = None


@dataclass
class CiftiFile:
    """A file that is open for reading.

    names   of the rows, which are the columns of other formats
    rows    "dscalar", "dtseries" or "dlabel", as its name should say
    label_names  {number: name} of the labels of the first row
    """

    content: Content
    image: Any
    structures: list[Structure]
    names: list[str]
    rows: str
    label_names: dict[int, str]

    @property
    def values(self):
        """The rows; slices of it are read from the file."""
        return self.image.dataobj

    def read(self, rows, places):
        """Some rows, a list of increasing numbers, at some columns, a list of slices: an array (r, v) of
        floats. In the file, the rows of a column are neighbours."""
        first, last = rows[0], rows[-1] + 1
        with reading(self.content):
            parts = [np.asarray(self.values[first:last, place]) for place in places]
        if last - first > len(rows):
            parts = [part[np.array(rows) - first] for part in parts]
        values = parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1)
        if values.dtype.kind not in "fiub":
            raise FileError(f"{self.content.path}: values of type {values.dtype}; allowed: real numbers")
        kept = values.dtype.kind == "f" and values.dtype.itemsize <= 4
        return values.astype(np.float32 if kept else np.float64, copy=False)

    @contextlib.contextmanager
    def writing(self, path, rows):
        """A function write(first, places, values) for an output that has these rows of the file with its
        metadata: values (r, v) of its rows from `first` on, at the slices `places` of its columns. The
        output is there when the context ends."""
        with silent_log():
            header = self._header(rows)
        offset, shape = 0, header.get_data_shape()[-2:]
        dtype = header.get_data_dtype()
        with writing_atomically(path) as temporary:
            with open(temporary, "wb") as file:
                header.write_to(file)
                offset = int(header["vox_offset"])
                _allocate(file, offset + shape[0] * shape[1] * dtype.itemsize)

            def write(first, places, values):
                # A map for each call, since its pages count as memory of this process.
                matrix = np.memmap(temporary, dtype, "r+", offset, shape[::-1])
                at = 0
                for place in places:
                    count = place.stop - place.start
                    matrix[place, first:first + len(values)] = values[:, at:at + count].T
                    at += count

            yield write
            if is_compressed(path):
                _compress(temporary)

    def _header(self, rows):
        """The header of the NIfTI file, with the description of rows and columns as its extension."""
        from nibabel import cifti2
        from nibabel.nifti1 import Nifti1Extension, Nifti1Extensions

        header = self.image.header
        if rows != list(range(len(self.names))):
            axes = [header.get_axis(i) for i in range(2)]
            if isinstance(axes[0], cifti2.SeriesAxis):
                first = self._choose_times(axes[0], rows)
            else:
                first = cifti2.ScalarAxis(axes[0].name[rows], axes[0].meta[rows])
            metadata = header.matrix.metadata
            volume = _transformation(header)
            header = cifti2.Cifti2Header.from_axes((first, axes[1]))
            header.matrix.metadata = metadata
            if volume is not None:
                _transformation(header).meter_exponent = volume.meter_exponent
        shape = header.matrix.get_data_shape()
        image = cifti2.Cifti2Image(np.broadcast_to(np.float32(0), shape), header, self.image.nifti_header)
        image.nifti_header.set_data_dtype(np.float32)
        image.update_headers()
        new = image.nifti_header.copy()
        new["vox_offset"] = 0  # to be found from the size of the extensions
        new["scl_slope"], new["scl_inter"] = 1, 0
        if new["qform_code"] == 0:
            new["pixdim"][:4] = 1
        new.extensions = Nifti1Extensions(
            extension for extension in new.extensions if extension.get_code() != _EXTENSION)
        new.extensions.append(Nifti1Extension(_EXTENSION, header.to_xml()))
        return new

    def _choose_times(self, axis, rows):
        """The times of some rows of a series."""
        strides = set(np.diff(rows)) or {1}
        if len(strides) > 1 or min(strides) < 1:
            chosen = ", ".join(str(row + 1) for row in rows)
            raise FileError(f"{self.content.path}: the columns {chosen} of a time series; allowed: "
                            "columns at equal intervals, or all")
        return type(axis)(axis.start + rows[0] * axis.step, axis.step * min(strides), len(rows),
                          axis.unit)


def _add_structures(cifti2):
    """Those that Workbench 2 has and nibabel 5.4 does not know."""
    known = cifti2.CIFTI_BRAIN_STRUCTURES
    for side in ("LEFT", "RIGHT"):
        name = f"CIFTI_STRUCTURE_HIPPOCAMPUS_DENTATE_{side}"
        if name not in known:
            known.add_codes([(-1000 - len(side), name, "HippocampusDentate" + side.capitalize())])


def structure_of_word(word):
    """"CortexLeft" of Workbench's CORTEX_LEFT, and of the name in CIFTI files."""
    return "".join(part.capitalize() for part in word.replace("CIFTI_STRUCTURE_", "").split("_"))


def word_of_structure(name):
    """Workbench's word of a structure."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).upper()


def open_cifti(content) -> CiftiFile:
    """Read the description of a file; of a file on disk, no values yet."""
    cifti2 = import_reader("nibabel.cifti2", content)
    _add_structures(cifti2)
    from nibabel.fileholders import FileHolder

    with reading(content):
        holder = (FileHolder(content.path) if content.partial
                  else FileHolder(fileobj=io.BytesIO(content.bytes)))
        with warnings.catch_warnings():  # of the shape, which is checked below
            warnings.simplefilter("ignore")
            # Rows are read instead of mapped, since mapped ones stay in memory.
            image = cifti2.Cifti2Image.from_file_map({"image": holder}, mmap=False)
        axes = [image.header.get_axis(i) for i in range(image.ndim)]
        if len(axes) != 2 or not isinstance(axes[1], cifti2.BrainModelAxis) or not isinstance(
                axes[0], (cifti2.ScalarAxis, cifti2.SeriesAxis, cifti2.LabelAxis)):
            kinds = " by ".join(type(axis).__name__.replace("Axis", "") for axis in axes)
            raise content.error(f"a CIFTI file of {kinds}; allowed: dscalar, dtseries")
        stored, described = image.dataobj, image.header.matrix.get_data_shape()
        if tuple(stored.shape) != tuple(described):
            raise ValueError(f"a matrix of {' x '.join(map(str, stored.shape))} values, described as "
                             f"{' x '.join(map(str, described))}")
        needed = stored.offset + int(np.prod(stored.shape)) * stored.dtype.itemsize
        size = os.path.getsize(content.path) if content.partial else len(content.bytes)
        if size < needed:
            raise ValueError(f"{size} bytes, of {needed} that its header announces")
        unit = _millimetres(image.header)
        structures = [_structure(axes[1], unit, *entry) for entry in axes[1].iter_structures()]
    series = isinstance(axes[0], cifti2.SeriesAxis)
    labels = isinstance(axes[0], cifti2.LabelAxis)
    names = [str(i + 1) for i in range(len(axes[0]))] if series else [str(n) for n in axes[0].name]
    label_names = {key: name for key, (name, _) in axes[0].label[0].items()} if labels else {}
    return CiftiFile(content, image, structures, names,
                     "dtseries" if series else "dlabel" if labels else "dscalar", label_names)


def _compress(path):
    with tempfile.TemporaryFile() as plain:
        with open(path, "rb") as file:
            shutil.copyfileobj(file, plain)
        plain.seek(0)
        with gzip.GzipFile(path, "wb", 1, mtime=0) as file:
            shutil.copyfileobj(plain, file)


def _allocate(file, size):
    """Makes the file as large, with OSError if the disk is full: a map of a file that has no space ends the
    process."""
    file.flush()
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file.fileno(), 0, size)
        return
    zeros = bytes(1 << 20)
    for start in range(file.tell(), size, len(zeros)):
        file.write(zeros[:size - start])


def _transformation(header):
    """Of the indices of voxels to coordinates; None without voxels."""
    volume = header.matrix.get_index_map(1).volume
    return None if volume is None else volume.transformation_matrix_voxel_indices_ijk_to_xyz


def _millimetres(header):
    """The unit of coordinates, which nibabel leaves out."""
    volume = _transformation(header)
    return 1.0 if volume is None or volume.meter_exponent is None else 10.0 ** (volume.meter_exponent + 3)


def _structure(axis, unit, name, block, model):
    """"CortexLeft" for CIFTI_STRUCTURE_CORTEX_LEFT, as GIFTI has it."""
    place = slice(*block.indices(len(axis))[:2])
    structure = Structure(structure_of_word(name), place)
    if model.volume_mask.any():
        structure.voxels, structure.affine = np.asarray(model.voxel), np.array(model.affine, dtype=float)
        structure.affine[:3] *= unit
    else:
        structure.vertices, structure.size = np.asarray(model.vertex), int(axis.nvertices[name])
    return structure
