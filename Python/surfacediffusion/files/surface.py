# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads and writes surfaces: read_surface() and SurfaceFile."""
from __future__ import annotations

import functools
import os
import re
import tempfile
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from . import export, gifti_data, mesh_text, ply, stl, threemf, vtk_files
from .content import Content, check_output_name, check_range, import_reader, on_disk, read_content, reading
from .content import write_atomically

ALLOWED = "GIFTI (.surf.gii), FreeSurfer, OFF, OBJ, PLY, STL, 3MF, VTK"

_SCANNER = 1  # NIFTI_XFORM_SCANNER_ANAT

#: What the names of FreeSurfer's files say
_SHAPES = {"inflated": "inflated", "sphere": "spherical", "flat": "flat"}


@dataclass
class SurfaceFile:
    """A surface and the file that it was read from.

    Attributes
    ----------
    path : str
    kind : str
        The format.
    points : ndarray, shape (n, 3)
    faces : ndarray, shape (m, 3), or list of polygons
    structure : str
        As GIFTI has it ("CortexLeft"); empty if unknown.
    any_hemisphere : bool
        Data of the other hemisphere are allowed.
    """

    path: str
    kind: str
    points: np.ndarray
    faces: Any
    structure: str = ""
    image: Any = field(default=None, repr=False)  # what the reader returned
    any_hemisphere: bool = False

    @property
    def geometry(self):
        """What the file or its name says of the shape: "anatomical", "inflated", "spherical", "flat", ...; empty
        if they say nothing."""
        if self.kind == "gifti":
            points = self.image.get_arrays_from_intent("NIFTI_INTENT_POINTSET")[0]
            given = (points.meta.get("GeometricType") or "").lower()
            if given not in ("", "unknown"):
                return given
        name = os.path.basename(self.path).lower()
        words = re.split("[._-]", name) if self.kind == "gifti" else (
            name.split(".") if self.kind in ("freesurfer", "asc") else [])
        found = [shape for word, shape in _SHAPES.items() if word in words[1:]]
        return found[0] if found else ""

    @functools.cached_property
    def solver(self):
        """The surface for functions of the package. It is made once, and keeps its factors."""
        from .._surface import Surface

        return Surface(self.points, self.faces)

    @property
    def center(self):
        """FreeSurfer's c_ras (3,), by which the scanner's coordinates of a point are larger than those of the
        surface; zeros if the file does not have it."""
        given = [0, 0, 0]
        if self.kind == "freesurfer":
            given = (self.image or {}).get("cras", given)
        elif self.kind == "gifti":
            meta = self.image.get_arrays_from_intent("NIFTI_INTENT_POINTSET")[0].meta
            given = [meta.get(f"VolGeomC_{axis}", 0) for axis in "RAS"]
        try:
            return np.array(given, dtype=float)
        except ValueError:
            return np.zeros(3)

    @property
    def to_scanner(self):
        """The matrix (4, 4) from the surface's coordinates to the scanner's; None if the file does not say it."""
        if self.kind == "gifti":
            system = self.image.get_arrays_from_intent("NIFTI_INTENT_POINTSET")[0].coordsys
            if system is not None and system.dataspace == _SCANNER:
                return np.eye(4)
            if system is not None and system.xformspace == _SCANNER and abs(np.linalg.det(system.xform)) > 0:
                return np.asarray(system.xform, dtype=float)
        if not self.center.any():
            return None
        matrix = np.eye(4)
        matrix[:3, 3] = self.center
        return matrix

    def beside(self):
        """The colours of the vertices (n, 3) of uint8, or None, and the names of what else the file has
        beside points, faces and normals."""
        return _BESIDE.get(self.kind, lambda image: (None, []))(self.image)

    def save(self, path, points):
        """Write the surface with other points (n, 3) in the same format. The normals in the file do
        not belong to these: returns "computed again" or "left out", or "" if it has none."""
        check_output_name(path, self.kind)
        points = np.asarray(points)
        if points.shape != self.points.shape:
            raise ValueError(f"points have shape {points.shape}; allowed: {self.points.shape}")
        check_range(path, self.kind, [points], "coordinate")
        _, write = _FORMATS[self.kind]
        data, normals = write(self, points)
        write_atomically(path, data)
        return normals


def read_surface(path, weld=True) -> SurfaceFile:
    """Read a surface from a file of one of the formats in ALLOWED, or from its Content. weld: whether corners of STL
    that are rounded apart become one."""
    content = path if isinstance(path, Content) else read_content(path)
    if content.kind not in _FORMATS:
        raise content.error(f"a {content.name} file, which has no surface; allowed: {ALLOWED}")
    with reading(content):
        read, _ = _FORMATS[content.kind]
        surface = _read_stl(content, weld) if content.kind == "stl" else read(content)
        surface.faces = _faces(surface.faces)
        _check(content, surface)
    return surface


def _faces(polygons):
    """(m, 3) int for triangles, otherwise a list of polygons."""
    if isinstance(polygons, np.ndarray):
        return polygons if polygons.shape[1:] == (3,) else polygons.tolist()
    if polygons and all(len(polygon) == 3 for polygon in polygons):
        return np.array(polygons, dtype=np.int64)
    return polygons


def _normals(points, faces):
    """Unit normals at the points and on the faces."""
    from .._surface import Surface

    surface = Surface(points, faces)
    return surface._point_normals(), surface._face_normals()


def _check(content, surface):
    points, faces = surface.points, surface.faces
    if len(points) == 0 or len(faces) == 0:
        raise content.error(f"the surface has {len(points)} points and {len(faces)} faces; "
                            "allowed: at least one of each")
    flat = faces if isinstance(faces, np.ndarray) else np.concatenate(
        [np.asarray(face, dtype=np.int64) for face in faces])
    if not isinstance(faces, np.ndarray) and min(map(len, faces)) < 3:
        raise content.error("a face has fewer than three points; allowed: polygons")
    low, high = flat.min(), flat.max()
    if low < 0 or high >= len(points):
        bad = low if low < 0 else high
        raise content.error(f"a face refers to point {bad}; allowed: 0 to {len(points) - 1}")
    if not np.isfinite(points).all():
        bad = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
        raise content.error(f"point {bad} is {points[bad].tolist()}; allowed: finite coordinates")


# ---- GIFTI ---------------------------------------------------------------------------------------

def _read_gifti(content):
    image = gifti_data.read_image(content)
    points = image.get_arrays_from_intent("NIFTI_INTENT_POINTSET")
    faces = image.get_arrays_from_intent("NIFTI_INTENT_TRIANGLE")
    if not points or not faces:
        intents = sorted({code_name(array.intent) for array in image.darrays})
        raise content.error(f"a GIFTI file with {', '.join(intents) or 'no arrays'} but no "
                            f"surface; allowed: {ALLOWED}")
    structure = points[0].meta.get("AnatomicalStructurePrimary") or image.meta.get(
        "AnatomicalStructurePrimary") or ""
    return SurfaceFile(content.path, content.kind, np.asarray(points[0].data),
                       np.asarray(faces[0].data), structure, image)


def code_name(intent):
    """"shape" for NIFTI_INTENT_SHAPE, and so on."""
    from nibabel.nifti1 import intent_codes

    return intent_codes.niistring[intent].replace("NIFTI_INTENT_", "").lower()


def _write_gifti(surface, points):
    changes = [(surface.image.get_arrays_from_intent("NIFTI_INTENT_POINTSET")[0], points)]
    for array in surface.image.get_arrays_from_intent("NIFTI_INTENT_VECTOR"):
        lengths = np.linalg.norm(array.data, axis=-1)
        if array.data.shape == points.shape and np.allclose(lengths, 1, atol=1e-3):  # other vectors stay
            changes.append((array, _normals(points, surface.faces)[0]))
    given = [array.data for array, _ in changes]
    try:
        for array, values in changes:
            array.data = values.astype(array.data.dtype)
        return surface.image.to_bytes(), "computed again" if len(changes) > 1 else ""
    finally:
        for (array, _), data in zip(changes, given):
            array.data = data


# ---- FreeSurfer ----------------------------------------------------------------------------------

def _read_freesurfer(content):
    freesurfer = import_reader("nibabel.freesurfer", content)
    if not content.bytes.startswith(b"\xff\xff\xfe"):
        warnings.warn(f"{content.path}: quadrangles, which are read, and written, as two triangles each",
                      stacklevel=4)
    # nibabel warns about files without a footer, which are allowed.
    with warnings.catch_warnings(), on_disk(content.bytes) as path:
        warnings.simplefilter("ignore")
        points, faces, info = freesurfer.read_geometry(path, read_metadata=True)
    return SurfaceFile(content.path, content.kind, points, faces.astype(np.int64),
                       structure_of_name(content.path), info)


def structure_of_name(path):
    """As FreeSurfer names files: "CortexLeft" of lh.white; empty for other names."""
    name = path.replace("\\", "/").rsplit("/", maxsplit=1)[-1]
    return {"lh": "CortexLeft", "rh": "CortexRight"}.get(name.split(".")[0], "")


def _write_freesurfer(surface, points):
    from nibabel import freesurfer

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "surface"
        freesurfer.write_geometry(
            str(path), points, surface.faces, "created by surfacediffusion",
            surface.image or None)
        return path.read_bytes(), ""


# ---- other meshes --------------------------------------------------------------------------------

def _read_text(content):
    read, _ = mesh_text.FORMATS[content.kind]
    points, faces = read(content.bytes)
    structure = structure_of_name(content.path) if content.kind == "asc" else ""
    return SurfaceFile(content.path, content.kind, points, faces, structure, content.bytes)


def _write_text(surface, points):
    normals, _ = _normals(points, surface.faces)
    _, write = mesh_text.FORMATS[surface.kind]
    return write(surface.image, points, normals)


def _read_ply(content):
    mesh = ply.read(content.bytes)
    return SurfaceFile(content.path, content.kind, mesh.points, mesh.faces, image=mesh)


def _write_ply(surface, points):
    columns = dict(zip("xyz", np.asarray(points).T))
    has_normals = {"nx", "ny", "nz"} <= set(surface.image.vertices)
    if has_normals:
        columns.update(zip(("nx", "ny", "nz"), _normals(points, surface.faces)[0].T))
    return surface.image.write(columns), "computed again" if has_normals else ""


def _read_stl(content, weld=True):
    points, faces = stl.read(content.bytes)
    if weld and np.isfinite(points).all():
        points, faces, apart = _join(points, faces)
        if apart:
            warnings.warn(f"{content.path}: corners of facets up to {apart:.2g} apart, at open edges, are joined, "
                          "since STL files are rounded", stacklevel=4)
    return SurfaceFile(content.path, content.kind, points, faces, image=content.bytes)


def _join(points, faces):
    """The same surface without the gaps of rounding between ends of open edges, and the largest."""
    from .. import _core
    from .._surface import Surface

    point_of, apart = _core.join_open_edges(Surface(points, faces)._core, None)
    kept, numbers = np.unique(point_of[faces], return_inverse=True)
    return (points[kept], numbers.reshape(-1, 3), apart) if apart else (points, faces, 0.0)


def _write_stl(surface, points):
    _, normals = _normals(points, surface.faces)
    return stl.write(surface.image, points, surface.faces, normals), "computed again"


def _read_3mf(content):
    points, faces, objects = threemf.read(content.bytes)
    return SurfaceFile(content.path, content.kind, points, faces, image=objects)


def _write_3mf(surface, points):
    return threemf.write(np.asarray(points, dtype=float), surface.faces, surface.image, export._lines), ""


def _read_vtk(content):
    mesh = vtk_files.read(content)
    points, faces = vtk_files.points_and_faces(mesh)
    return SurfaceFile(content.path, content.kind, points, faces, image=mesh)


def _write_vtk(surface, points):
    normals = vtk_files.normals_of(surface.image, *_normals(points, surface.faces))
    data = vtk_files.write(surface.kind, surface.image, points=points, **normals)
    found = [values for arrays in normals.values() for values in arrays.values()]
    return data, "" if not found else "left out" if found[-1] is None else "computed again"


# ---- what files have beside the surface ----------------------------------------------------------

def _beside_ply(mesh):
    names = [name for name in mesh.vertices if name not in ("x", "y", "z", "nx", "ny", "nz")]
    color = [name for name in ("red", "green", "blue") if mesh.vertices.get(name, np.empty(0)).dtype == np.uint8]
    colors = np.column_stack([mesh.vertices[name] for name in color]) if len(color) == 3 else None
    names = [name for name in names if colors is None or name not in color]
    for element in mesh.elements:
        if element.name in ("face", "tristrips"):
            names += [f"{p.name} of faces" for p in element.properties
                      if p.name not in ("vertex_indices", "vertex_index")]
        elif element.name != "vertex":
            names.append(element.name)
    return colors, names


def _beside_gifti(image):
    intents = [code_name(array.intent) for array in image.darrays]
    return None, [name for name in intents if name not in ("pointset", "triangle", "vector")]


def _beside_vtk(mesh):
    return None, [data.GetArrayName(i) or "an array" for data in (mesh.GetPointData(), mesh.GetCellData())
                  for i in range(data.GetNumberOfArrays()) if data.GetArray(i) != data.GetNormals()]


def _beside_3mf(objects):
    return None, ["colours of faces"] * (objects.colors is not None)


_BESIDE = {
    "3mf": _beside_3mf,
    "gifti": _beside_gifti, "ply": _beside_ply, "vtk": _beside_vtk, "vtp": _beside_vtk,
    "off": lambda data: (None, mesh_text.beside_off(data)),
    "obj": lambda data: (None, mesh_text.beside_obj(data)),
}

#: The reader and the writer of each kind of file.
_FORMATS = {
    "gifti": (_read_gifti, _write_gifti),
    "freesurfer": (_read_freesurfer, _write_freesurfer),
    "asc": (_read_text, _write_text),
    "off": (_read_text, _write_text),
    "obj": (_read_text, _write_text),
    "ply": (_read_ply, _write_ply),
    "stl": (_read_stl, _write_stl),
    "3mf": (_read_3mf, _write_3mf),
    "vtk": (_read_vtk, _write_vtk),
    "vtp": (_read_vtk, _write_vtk),
    "vtu": (_read_vtk, _write_vtk),
}
