# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads and writes surfaces: read_surface() and SurfaceFile."""
from __future__ import annotations

import tempfile
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from . import mesh_text, meshio_files, vtk_files
from .content import check_output_name, import_reader, read_content, reading, write_atomically

KINDS = ("gifti", "freesurfer", "off", "obj", "ply", "stl", "vtk", "vtp")
ALLOWED = "GIFTI (.surf.gii), FreeSurfer, OFF, OBJ, PLY, STL, VTK polydata"


@dataclass
class SurfaceFile:
    """A surface and the file that it was read from.

    points     (n, 3) float
    faces      (m, 3) int, or a list of polygons
    structure  as GIFTI has it ("CortexLeft"); empty if unknown
    """

    path: str
    kind: str
    points: np.ndarray
    faces: Any
    structure: str = ""
    image: Any = field(default=None, repr=False)  # what the reader returned

    def save(self, path, points):
        """Write the surface with other points (n, 3) in the same format."""
        check_output_name(path, self.kind)
        points = np.asarray(points)
        if points.shape != self.points.shape:
            raise ValueError(f"points have shape {points.shape}; allowed: {self.points.shape}")
        write_atomically(path, _WRITERS[self.kind](self, points))


def read_surface(path) -> SurfaceFile:
    """Read a surface from a file of one of the formats in ALLOWED."""
    content = read_content(path)
    if content.kind == "curv" and _is_quad_surface(content):
        content.kind = "freesurfer"
    if content.kind not in KINDS:
        raise content.error(f"a {content.name} file, which has no surface; allowed: {ALLOWED}")
    with reading(content):
        surface = _READERS[content.kind](content)
        _check(content, surface)
    return surface


def _check(content, surface):
    points, faces = surface.points, surface.faces
    if len(points) == 0 or len(faces) == 0:
        raise content.error(f"the surface has {len(points)} points and {len(faces)} faces; "
                            "allowed: at least one of each")
    flat = faces if isinstance(faces, np.ndarray) else np.concatenate(
        [np.asarray(face, dtype=np.int64) for face in faces])
    low, high = flat.min(), flat.max()
    if low < 0 or high >= len(points):
        bad = low if low < 0 else high
        raise content.error(f"a face refers to point {bad}; allowed: 0 to {len(points) - 1}")
    if not np.isfinite(points).all():
        bad = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
        raise content.error(f"point {bad} is {points[bad].tolist()}; allowed: finite coordinates")


def _is_quad_surface(content):
    """Quadrangle surfaces have the magic number of curv files, but other sizes."""
    count = int.from_bytes(content.bytes[3:7], "big")
    return len(content.bytes) != 15 + 4 * count and len(content.bytes) > 15 + 4 * count


# ---- GIFTI ---------------------------------------------------------------------------------------

def _read_gifti(content):
    gifti = import_reader("nibabel.gifti", content)
    image = gifti.GiftiImage.from_bytes(content.bytes)
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
    array = surface.image.get_arrays_from_intent("NIFTI_INTENT_POINTSET")[0]
    before = array.data
    array.data = points.astype(before.dtype)
    try:
        return surface.image.to_bytes()
    finally:
        array.data = before


# ---- FreeSurfer ----------------------------------------------------------------------------------

def _read_freesurfer(content):
    freesurfer = import_reader("nibabel.freesurfer", content)
    # nibabel takes a path here, and warns about files without a footer, which are allowed.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        points, faces, info = freesurfer.read_geometry(content.path, read_metadata=True)
    return SurfaceFile(content.path, content.kind, points, faces.astype(np.int64),
                       _freesurfer_structure(content.path), info)


def _freesurfer_structure(path):
    name = path.replace("\\", "/").rsplit("/", maxsplit=1)[-1]
    return {"lh": "CortexLeft", "rh": "CortexRight"}.get(name.split(".")[0], "")


def _write_freesurfer(surface, points):
    from nibabel import freesurfer

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "surface"
        freesurfer.write_geometry(
            str(path), points, surface.faces, "created by surfacediffusion",
            surface.image or None)
        return path.read_bytes()


# ---- other meshes --------------------------------------------------------------------------------

def _read_text(content):
    points, faces = mesh_text.READERS[content.kind](content.bytes)
    return SurfaceFile(content.path, content.kind, points, faces, image=content)


def _write_text(surface, points):
    return mesh_text.replace_points(surface.image, points)


def _read_meshio(content):
    mesh = meshio_files.read(content)
    return SurfaceFile(content.path, content.kind, np.asarray(mesh.points),
                       meshio_files.faces_of(mesh), image=mesh)


def _write_meshio(surface, points):
    return meshio_files.write(surface.kind, surface.image, points=points)


def _read_vtk(content):
    mesh = vtk_files.read(content)
    points, faces = vtk_files.points_and_faces(mesh)
    return SurfaceFile(content.path, content.kind, points, faces, image=mesh)


def _write_vtk(surface, points):
    return vtk_files.write(surface.kind, surface.image, points=points)


_READERS = {"gifti": _read_gifti, "freesurfer": _read_freesurfer, "off": _read_text,
            "obj": _read_text, "ply": _read_meshio, "stl": _read_meshio, "vtk": _read_vtk,
            "vtp": _read_vtk}
_WRITERS = {"gifti": _write_gifti, "freesurfer": _write_freesurfer, "off": _write_text,
            "obj": _write_text, "ply": _write_meshio, "stl": _write_meshio, "vtk": _write_vtk,
            "vtp": _write_vtk}
