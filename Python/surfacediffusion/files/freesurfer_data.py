# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Data in the formats of FreeSurfer: curv, mgh and label."""
from __future__ import annotations

import io

import numpy as np

from .content import import_reader

# ---- curv: a big-endian header of 15 bytes, then one float per vertex ----------------------------

def read_curv(content):
    """The values (n,) and the number of faces that the header names."""
    freesurfer = import_reader("nibabel.freesurfer", content)
    vertices, faces, per_vertex = np.frombuffer(content.bytes, ">i4", 3, offset=3).tolist()
    found = (len(content.bytes) - 15) // 4
    if per_vertex != 1:
        raise content.error(f"a curv file with {per_vertex} values per vertex; allowed: 1")
    if vertices != found:
        raise content.error(f"the header announces {vertices} values, the file holds {found}")
    return freesurfer.read_morph_data(content.path).astype(np.float32), faces


def write_curv(values, faces):
    from nibabel import freesurfer

    file = io.BytesIO()
    freesurfer.write_morph_data(file, np.asarray(values)[:, 0], fnum=faces)
    return file.getvalue()


def new_curv(surface, names):
    return len(surface.faces)


# ---- mgh -----------------------------------------------------------------------------------------

def read_mgh(content):
    """The values (n, k) and the image."""
    freesurfer = import_reader("nibabel.freesurfer", content)
    image = freesurfer.MGHImage.from_bytes(content.bytes)
    values = np.asanyarray(image.dataobj)
    shape = values.shape
    if sorted(shape[:3])[:2] != [1, 1]:
        raise content.error(f"a volume of {' x '.join(map(str, shape[:3]))} voxels; allowed: "
                            "n x 1 x 1 values")
    columns = shape[3] if len(shape) > 3 else 1
    values = values.reshape((max(shape[:3]), columns), order="F")
    return values.astype(values.dtype.newbyteorder("="), copy=False), image


def write_mgh(values, image):
    from nibabel import freesurfer

    values = np.asarray(values, dtype=np.float32)
    shape = list(image.shape[:3])
    if values.shape[1] > 1 or len(image.shape) > 3:
        shape.append(values.shape[1])
    header = image.header.copy()
    header.set_data_dtype(np.float32)
    return freesurfer.MGHImage(
        values.reshape(shape, order="F"), image.affine, header).to_bytes()


def new_mgh(surface, names):
    from nibabel import freesurfer

    return freesurfer.MGHImage(np.zeros((len(surface.points), 1, 1), np.float32), np.eye(4))


# ---- label: lines of "vertex x y z value" --------------------------------------------------------

def read_label(content):
    """The numbers of the vertices (v,), their values (v,), and the lines of the file."""
    lines = content.bytes.decode("latin-1").splitlines()
    count = int(lines[1])
    rows = lines[2:2 + count]
    if len(rows) != count:
        raise content.error(f"{count} vertices are announced, {len(rows)} lines follow")
    fields = [row.split() for row in rows]
    if any(len(words) != 5 for words in fields):
        raise ValueError("a line does not have five numbers")
    vertices = np.array([words[0] for words in fields], dtype=np.int64)
    values = np.array([words[4] for words in fields], dtype=float)
    if len(np.unique(vertices)) != count:
        raise content.error("a vertex is listed twice")
    return vertices, values, lines


def write_label(values, lines):
    new = lines[:2]
    for row, value in zip(lines[2:], np.asarray(values)[:, 0].tolist()):
        new.append(" ".join(row.split()[:4]) + f" {value:.10g}")
    return ("\n".join(new) + "\n").encode("latin-1")
