# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads and writes data at the vertices or faces of surfaces: read_data(), new_data() and Data."""
from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from . import freesurfer_data, gifti_data, ply, vtk_files
from .cifti import open_cifti
from .content import NAMES, Content, FileError, check_output_name, check_range, kind_of_name
from .content import read_content, reading, write_atomically

ALLOWED = ("GIFTI (.func.gii, .shape.gii, .label.gii), CIFTI (.dscalar.nii, .dtseries.nii), "
           "FreeSurfer (curv, .mgh, .mgz, .nii.gz, .label), PLY, VTK, NumPy (.npy), "
           "text with one number per line (.txt)")

NO_VERTICES = "an STL file numbers no vertices, so that values at vertices belong to none; allowed: "


@dataclass
class Part:
    """The values on one surface. Vertices are faces if the data are at faces.

    Attributes
    ----------
    values : ndarray, shape (v, k)
        One row per vertex that has data, one column per map.
    vertices : ndarray, shape (v,), or None
        The numbers of these vertices; None: all, in order.
    size : int or None
        The number of vertices of the surface; None if the file does not say.
    structure : str
        "CortexLeft", "CortexRight", ...; empty if the file does not say.
    """

    values: np.ndarray
    vertices: np.ndarray | None = None
    size: int | None = None
    structure: str = ""


@dataclass
class Data:
    """The data of a file.

    Attributes
    ----------
    path : str
    kind : str
        The format.
    names : list of str
        Of the k columns; columns of one array of VTK have one name.
    parts : list of Part
        One, or one per surface of a CIFTI file.
    labels : bool
        The values are numbers of labels, which have no mean. VTK files get one per vertex or face, as a
        32-bit integer.
    label_names : dict
        {number: name} of the labels of the first column.
    usual : sequence of int
        The columns to work on if nobody chooses (all but normals and the like).
    extra : str
        A remark about values that are carried over unchanged, or empty.
    on_faces : bool
        The values are at the faces.
    rows : str
        Of CIFTI, "dscalar" or "dtseries", as its name should say.
    """

    path: str
    kind: str
    names: list[str]
    parts: list[Part]
    labels: bool = False
    label_names: dict[int, str] = field(default_factory=dict)
    usual: Sequence[int] = ()
    extra: str = ""
    image: Any = None
    on_faces: bool = False
    rows: str = ""

    def check_name(self, path):
        """Raises FileError if the name of an output announces another format."""
        check_output_name(path, self.kind, self.rows)

    def save(self, path, values, columns=None):
        """Write other values in the same format, with the metadata of the file.

        Parameters
        ----------
        path : path-like
        values : list of array_like
            For each part, an array (v, number of columns).
        columns : list of int, optional
            The numbers of these columns; default: all. Files of meshes keep their other columns, other
            files then hold these alone.
        """
        known = _FORMATS.get(self.kind)
        if known is None or not (known.write or known.save):
            raise FileError(f"{path}: values cannot be written as {NAMES[self.kind]}, the format of "
                            f"{self.path}; allowed: formats of values")
        self.check_name(path)
        check_range(path, self.kind, values, "value")
        columns = list(range(len(self.names))) if columns is None else list(columns)
        for part, new in zip(self.parts, values):
            if np.shape(new) != (len(part.values), len(columns)):
                raise ValueError(f"values have shape {np.shape(new)}; allowed: "
                                 f"{(len(part.values), len(columns))}")
        if known.save is not None:
            known.save(path, self, values, columns)
        else:
            write_atomically(path, known.write(self, values, columns))


def data_for(surface, path, data, columns) -> Data:
    """Data for these columns of `data` at the vertices of another surface, zero at first: in its format and
    with its metadata, or in another format that the name of the output announces."""
    names, given = [data.names[c] for c in columns], data.parts[0]
    resize = _RESIZED.get(data.kind)
    if resize is None or kind_of_name(path) not in (None, data.kind):
        return new_data(surface, path, names)
    data.check_name(path)
    part = Part(np.zeros((len(surface.points), len(columns)), given.values.dtype), structure=given.structure)
    return replace(data, names=names, parts=[part], usual=range(len(columns)),
                   image=resize(data.image, surface, columns))


def read_data(path, on_faces=False) -> Data:
    """Read the data at vertices, or at faces, from a file of one of the formats in ALLOWED, or from its
    Content."""
    content = path if isinstance(path, Content) else read_content(path)
    known = _FORMATS.get(content.kind)
    if on_faces and not (known and known.on_faces):
        raise content.error(f"a {content.name} file, which has no data at faces; allowed: GIFTI, "
                            ".mgh, .mgz, .nii.gz, .npy, .txt, VTK")
    if known is None:
        raise content.error(f"a {content.name} file, which has no data at vertices; "
                            f"allowed: {ALLOWED}")
    with reading(content):
        data = (_read_vtk(content, on_faces) if content.kind in vtk_files.KINDS
                else known.read(content))
        data.on_faces = on_faces
        if not data.names or not data.parts:
            where = "faces" if on_faces else "vertices"
            raise content.error(f"no data at {where}; allowed: at least one column")
        for part in data.parts:
            if part.values.dtype.kind not in "fiub":
                raise content.error(f"values of type {part.values.dtype}; allowed: real numbers")
    if not data.usual:
        data.usual = range(len(data.names))
    return data


def new_data(surface, path, names) -> Data:
    """Data for columns that no file holds yet, zero at first, in the format that the name of the
    output announces; without an extension, FreeSurfer's curv for one column."""
    values = np.zeros((len(surface.points), len(names)), dtype=np.float32)
    if surface.kind == "stl":
        raise FileError(f"{surface.path}: {NO_VERTICES}a surface of another format")
    kind = kind_of_name(path)
    if kind is None and surface.kind == "freesurfer" and len(names) == 1:
        kind = "curv"
    if kind in ("ply", *vtk_files.KINDS) and kind == surface.kind:
        usual = list(range(len(names)))
        return Data(surface.path, kind, list(names), [Part(values)], usual=usual,
                    image=(surface.image, [(name, 0) for name in names]))
    make = _FORMATS[kind].new if kind in _FORMATS else None
    if make is None or (kind == "text" and len(names) > 1):
        allowed = ".func.gii, .shape.gii, .mgh, .mgz, .npy" + ", .txt" * (len(names) == 1)
        if surface.kind in ("ply", *vtk_files.KINDS):
            allowed += f", .{surface.kind} as the surface"
        raise FileError(f"{path}: the name announces no format for {len(names)} column(s) at "
                        f"vertices; allowed: {allowed}")
    return Data(surface.path, kind, list(names), [Part(values)], usual=range(len(names)),
                image=make(surface, names))


# ---- GIFTI ---------------------------------------------------------------------------------------

def _read_gifti(content):
    image, columns, vertices, structure = gifti_data.read(content)
    arrays = [gifti_data.column(image, column) for column in columns]
    lengths = sorted({len(array) for array in arrays})
    if len(lengths) > 1:
        raise content.error(f"arrays of {lengths[0]} and {lengths[-1]} values; allowed: one length")
    if vertices is not None and lengths and lengths[0] != len(vertices):
        raise content.error(f"{len(vertices)} numbers of vertices for {lengths[0]} values; allowed: one "
                            "per value")
    names = [gifti_data.name(image, column) for column in columns]
    return Data(content.path, content.kind, names,
                [Part(gifti_data.stacked(arrays), vertices, structure=structure)] if arrays else [],
                labels=gifti_data.has_labels(image), label_names=gifti_data.label_names(image),
                image=(image, columns))


def _write_gifti(data, values, columns):
    image, places = data.image
    return gifti_data.write(image, [places[i] for i in columns], values[0])


# ---- CIFTI ---------------------------------------------------------------------------------------

def _read_cifti(content):
    file = open_cifti(content)
    values = np.asanyarray(file.values)
    surfaces = [entry for entry in file.structures if entry.vertices is not None]
    parts = [Part(values[:, entry.place].T, entry.vertices, entry.size, entry.name) for entry in surfaces]
    voxels = sum(len(entry.voxels) for entry in file.structures if entry.voxels is not None)
    return Data(content.path, content.kind, file.names, parts, labels=file.rows == "dlabel",
                label_names=file.label_names, image=(file, values, surfaces), rows=file.rows,
                extra=f"{voxels} voxels are copied unchanged" if voxels else "")


def _save_cifti(path, data, values, columns):
    file, before, surfaces = data.image
    rows = np.array(before[columns], dtype=np.float32)
    for entry, new in zip(surfaces, values):
        rows[:, entry.place] = np.asarray(new).T
    with file.writing(path, columns) as write:
        write(0, [slice(0, rows.shape[1])], rows)


# ---- FreeSurfer and NumPy ------------------------------------------------------------------------

def _read_curv(content):
    values, faces = freesurfer_data.read_curv(content)
    return Data(content.path, content.kind, ["curv"], [Part(values[:, None])], image=faces)


def _write_curv(data, values, columns):
    return freesurfer_data.write_curv(values[0], data.image)


def _read_volume(content):
    values, image = freesurfer_data.read_volume(content)
    names = [str(i + 1) for i in range(values.shape[1])]
    return Data(content.path, content.kind, names, [Part(values)], image=image)


def _write_volume(data, values, columns):
    return freesurfer_data.write_volume(values[0], data.image)


def _read_label(content):
    vertices, values, lines = freesurfer_data.read_label(content)
    return Data(content.path, content.kind, ["label"], [Part(values[:, None], vertices)],
                image=lines)


def _write_label(data, values, columns):
    return freesurfer_data.write_label(values[0], data.image)


def _read_annot(content):
    labels, names = freesurfer_data.read_annot(content)
    return Data(content.path, content.kind, ["label"], [Part(labels[:, None])], labels=True,
                label_names=names)


def _read_npy(content):
    array = np.lib.format.read_array(io.BytesIO(content.bytes), allow_pickle=False)
    if array.ndim not in (1, 2):
        raise content.error(f"an array of shape {array.shape}; allowed: (n,) or (n, k)")
    values = array.reshape(len(array), 1) if array.ndim == 1 else array
    names = [str(i + 1) for i in range(values.shape[1])]
    return Data(content.path, content.kind, names, [Part(values)], image=array.ndim)


def _new_npy(surface, names):
    return 1 if len(names) == 1 else 2


def _write_npy(data, values, columns):
    array = np.asarray(values[0])
    if data.parts[0].values.dtype.kind == "f":
        array = array.astype(data.parts[0].values.dtype)
    file = io.BytesIO()
    np.lib.format.write_array(file, array[:, 0] if data.image == 1 else array, allow_pickle=False)
    return file.getvalue()


# ---- text: one number per line, and comments from # to the end of a line ----------------------------

_NUMBER = re.compile(r"\s*([^\s#]+)")


def _read_text(content):
    lines = [line.decode("latin-1") for line in
             content.bytes.removeprefix(b"\xef\xbb\xbf").splitlines(keepends=True)]
    values = []
    for number, line in enumerate(lines, start=1):
        text = line.split("#", 1)[0].strip()
        try:
            values += [float(text)] if text else []
        except ValueError:
            raise content.error(f"line {number} is {text[:40]!r}; allowed: one number per line, and comments "
                                "after #") from None
    return Data(content.path, content.kind, ["text"], [Part(np.array(values)[:, None])], image=lines)


def _new_text(surface, names):
    return ["0\n"] * len(surface.points)


def _write_text(data, values, columns):
    new = map(str, np.asarray(values[0])[:, 0])
    lines = [line[:found.start(1)] + next(new) + line[found.end(1):]
             if (found := _NUMBER.match(line)) else line for line in data.image]
    return "".join(lines).encode("latin-1")


# ---- meshes with data ----------------------------------------------------------------------------

# Vertex properties of PLY that are no data: normals, texture coordinates and opacity.
_NOT_DATA = {"nx", "ny", "nz", "s", "t", "u", "v", "texture_u", "texture_v", "alpha"}


def _mesh_data(content, mesh, arrays, usual_names):
    columns, places = [], []
    for name, array in arrays.items():
        for component in range(1 if array.ndim == 1 else array.shape[1]):
            columns.append(array if array.ndim == 1 else array[:, component])
            places.append((name, component))
    names = [name for name, _ in places]
    usual = [i for i, name in enumerate(names) if name in usual_names]
    parts = [Part(np.column_stack(columns))] if columns else []
    return Data(content.path, content.kind, names, parts, usual=usual, image=(mesh, places))


def _read_ply(content):
    mesh = ply.read(content.bytes)
    arrays = {name: column for name, column in mesh.vertices.items() if name not in {"x", "y", "z"}}
    return _mesh_data(content, mesh, arrays, set(arrays) - _NOT_DATA)


def _read_vtk(content, on_faces=False):
    mesh = vtk_files.read(content)
    if on_faces and len(vtk_files.cells_of_faces(mesh)) != mesh.GetNumberOfCells():
        raise content.error(f"{mesh.GetNumberOfCells()} cells, of which {len(vtk_files.cells_of_faces(mesh))} are "
                            "polygons; allowed for data at faces: polygons alone")
    attributes = mesh.GetCellData() if on_faces else mesh.GetPointData()
    arrays = vtk_files.arrays_of(attributes)
    active = attributes.GetScalars()
    usual = {active.GetName()} if active is not None else (
        set(arrays) - vtk_files.numbers_of(attributes) or set(arrays))  # numbers alone are data
    return _mesh_data(content, mesh, arrays, usual)


def _changed_arrays(data, values, columns, arrays):
    """The arrays of a mesh in which these columns have new values. Integers are rounded."""
    _, places = data.image
    changed = dict(arrays)
    for column, new in zip(columns, np.asarray(values[0]).T):
        name, component = places[column]
        before = np.array(changed[name]) if name in changed else np.array(new)
        if before.dtype.kind in "iu":
            limits = np.iinfo(before.dtype)
            new = np.clip(np.rint(new), limits.min, limits.max)
        if before.ndim == 1:
            before[:] = new
        else:
            before[:, component] = new
        changed[name] = before
    return changed


def _write_ply(data, values, columns):
    mesh = data.image[0]
    changed = _changed_arrays(data, values, columns, mesh.vertices)
    names = dict.fromkeys(data.image[1][column][0] for column in columns)
    return mesh.write({name: changed[name] for name in names})


def _write_vtk(data, values, columns):
    mesh = data.image[0]
    attributes = mesh.GetCellData() if data.on_faces else mesh.GetPointData()
    if data.labels:
        arrays = {data.names[column]: np.rint(new).astype(np.int32)
                  for column, new in zip(columns, np.asarray(values[0]).T)}
    else:
        arrays = _changed_arrays(data, values, columns, vtk_files.arrays_of(attributes))
    return vtk_files.write(data.kind, mesh,
                           **{"cell_data" if data.on_faces else "point_data": arrays})


@dataclass(frozen=True)
class _Format:
    """The functions that read, write and create files of one format; None: not supported."""

    read: Callable[[Content], Data]
    write: Callable[[Data, Any, list[int]], bytes | Iterable[bytes]] | None = None
    save: Callable[[Any, Data, Any, list[int]], None] | None = None  #: where memory is too small for that
    new: Callable[[Any, Sequence[str]], Any] | None = None
    on_faces: bool = False  #: files can have data at faces


_FORMATS = {
    "gifti": _Format(_read_gifti, _write_gifti, new=gifti_data.new, on_faces=True),
    "cifti": _Format(_read_cifti, save=_save_cifti),
    "curv": _Format(_read_curv, _write_curv, new=freesurfer_data.new_curv),
    "mgh": _Format(_read_volume, _write_volume, new=freesurfer_data.new_mgh, on_faces=True),
    "nifti": _Format(_read_volume, _write_volume, on_faces=True),
    "annot": _Format(_read_annot),
    "label": _Format(_read_label, _write_label),
    "npy": _Format(_read_npy, _write_npy, new=_new_npy, on_faces=True),
    "text": _Format(_read_text, _write_text, new=_new_text, on_faces=True),
    "ply": _Format(_read_ply, _write_ply),
    "vtk": _Format(_read_vtk, _write_vtk, on_faces=True),
    "vtp": _Format(_read_vtk, _write_vtk, on_faces=True),
    "vtu": _Format(_read_vtk, _write_vtk, on_faces=True),
}

#: What makes the image of a format one for some of its columns on another surface
_RESIZED: dict[str, Callable[[Any, Any, Sequence[int]], Any]] = {
    "gifti": lambda image, surface, columns: gifti_data.without_numbers(image[0], [image[1][c] for c in columns]),
    "curv": lambda image, surface, columns: len(surface.faces),
    "mgh": lambda image, surface, columns: freesurfer_data.resized_mgh(image, len(surface.points)),
    "npy": lambda image, surface, columns: image,
    "text": lambda image, surface, columns: _new_text(surface, columns),
}
