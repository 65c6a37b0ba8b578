# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Data in the formats of FreeSurfer: curv, mgh and NIfTI, label, annot."""
from __future__ import annotations

import warnings

import numpy as np

from .content import import_reader, on_disk

# ---- curv: a big-endian header of 15 bytes, then one float per vertex ----------------------------

def read_curv(content):
    """The values (n,) and the number of faces that the header names."""
    vertices, faces, per_vertex = np.frombuffer(content.bytes, ">i4", 3, offset=3).tolist()
    found = (len(content.bytes) - 15) // 4
    if per_vertex != 1:
        raise content.error(f"a curv file with {per_vertex} values per vertex; allowed: 1")
    if vertices != found:
        raise content.error(f"the header announces {vertices} values, the file holds {found}")
    return np.frombuffer(content.bytes, ">f4", vertices, offset=15).astype(np.float32), faces


def write_curv(values, faces):
    values = np.asarray(values)[:, 0].astype(">f4")
    header = np.array([len(values), faces, 1], dtype=">i4")
    return b"\xff\xff\xff" + header.tobytes() + values.tobytes()


def new_curv(surface, names):
    return len(surface.faces)


# ---- mgh and NIfTI: volumes with one voxel per vertex ---------------------------------------------

def read_volume(content):
    """The values (n, k) and the image."""
    if content.kind == "mgh":
        image = import_reader("nibabel.freesurfer", content).MGHImage.from_bytes(content.bytes)
    else:
        nibabel = import_reader("nibabel", content)
        single = content.bytes[344:346] == b"n+"
        image = (nibabel.Nifti1Image if single else nibabel.Nifti2Image).from_bytes(content.bytes)
    values = np.asanyarray(image.dataobj)
    shape = (*values.shape, 1, 1)
    # FreeSurfer divides long lines of voxels by a factor of their number, as 27307 x 1 x 6.
    if shape[1] != 1 and sorted(shape[:3])[:2] != [1, 1] or len(values.shape) > 4:
        raise content.error(f"a volume of {' x '.join(map(str, values.shape))} voxels; allowed: "
                            "n x 1 x 1 values")
    columns = shape[3]
    values = values.reshape((-1, columns), order="F")
    return values.astype(values.dtype.newbyteorder("="), copy=False), image


def write_volume(values, image):
    values = np.asarray(values, dtype=np.float32)
    shape = list(image.shape[:3])
    if values.shape[1] > 1 or len(image.shape) > 3:
        shape.append(values.shape[1])
    header = image.header.copy()
    header.set_data_dtype(np.float32)
    if hasattr(header, "set_slope_inter"):
        header.set_slope_inter(1, 0)
    with warnings.catch_warnings():  # of long lines of voxels, which the input has, too
        warnings.simplefilter("ignore")
        return type(image)(values.reshape(shape, order="F"), image.affine, header).to_bytes()


def new_mgh(surface, names):
    from nibabel import freesurfer

    return freesurfer.MGHImage(np.zeros((len(surface.points), 1, 1), np.float32), np.eye(4))


def resized_mgh(image, count):
    """An image with as many columns for another number of vertices."""
    shape = (count, 1, 1) + tuple(image.shape[3:4])
    header = image.header.copy()
    header.set_data_dtype(np.float32)
    return type(image)(np.zeros(shape, np.float32), image.affine, header)


# ---- label: lines of "vertex x y z value" --------------------------------------------------------

def read_label(content):
    """The numbers of the vertices (v,), their values (v,), and the lines of the file."""
    lines = [line.decode("latin-1") for line in content.bytes.splitlines()]
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


# ---- annot: a label per vertex, and a table of their names and colours ----------------------------

def read_annot(content):
    """The number of the label of each vertex (n,), -1 for none, and {number: name}."""
    freesurfer = import_reader("nibabel.freesurfer", content)
    with on_disk(content.bytes) as path:
        labels, _, names = freesurfer.read_annot(path)
    return labels.astype(np.int64), {i: name.decode("utf-8", "replace")
                                     for i, name in enumerate(names)}
