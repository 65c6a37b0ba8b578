# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Faces of a part that stay flat: --keep-flat, and the border beside them."""
from __future__ import annotations

import argparse

import numpy as np

from .. import distance
from ..files import read_data
from . import inputs, values

ALLOWED = ('"below-z HEIGHT", "angle AXIS DEGREES" with an axis of x, y, z, -x, -y, -z, "box X0 Y0 Z0 X1 Y1 Z1" or '
           '"labels FILE"')
_AXES = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1), "-x": (-1, 0, 0), "-y": (0, -1, 0), "-z": (0, 0, -1)}


def region(text):
    """The kind of a region and its numbers, of the command line."""
    kind, *words = text.split()
    try:
        if kind == "labels" and len(words) >= 1:
            return kind, text.split(None, 1)[1]
        if kind == "angle" and len(words) == 2 and words[0].lower() in _AXES and 0 <= float(words[1]) <= 180:
            return kind, (_AXES[words[0].lower()], float(words[1]))
        if (kind, len(words)) in (("below-z", 1), ("box", 6)):
            return kind, [values.length(word) for word in words]
    except (ValueError, argparse.ArgumentTypeError):
        pass
    raise argparse.ArgumentTypeError(f"is {text!r}; allowed: {ALLOWED}")


def parts_of_relief(regions, border, given, fine, faces, in_unit):
    """Per point of the refined surface, the part of the relief that it keeps: 0 in the regions, and growing
    smoothly to 1 at a distance of `border` from them. faces: of the SurfaceFile `given`, per triangle. in_unit():
    a length of the command line in the unit of the coordinates."""
    part = np.ones(fine.n_points)
    for kind, numbers in regions:
        if kind == "below-z":
            away = fine.points[:, 2] - in_unit(numbers[0])
        elif kind == "box":
            low, high = np.sort(np.reshape([in_unit(length) for length in numbers], (2, 3)), axis=0)
            away = np.linalg.norm(np.maximum(0, np.maximum(low - fine.points, fine.points - high)), axis=1)
        else:
            flat = _facing(fine, *numbers) if kind == "angle" else _labelled(numbers, given, faces)
            away = _from_triangles(fine, flat, border)
        # Exact numbers of the region and the border are in it up to round-off.
        x = np.clip(away / border, 0, 1) if border else (away > 1e-9 * np.ptp(fine.points)).astype(float)
        part = np.minimum(part, x * x * (3 - 2 * x))
    return part


def _facing(surface, axis, degrees):
    """Triangles whose normals are at most so many degrees from the axis."""
    return surface._face_normals() @ np.asarray(axis, float) >= np.cos(np.radians(degrees)) - 1e-9


def _labelled(path, given, faces):
    """Triangles of faces of the file that are labelled, or have labels at all corners."""
    table = read_data(path).parts[0].values
    surface = given.solver
    if table.shape[0] not in (len(given.points), surface.n_faces):
        raise inputs.ArgumentProblem(
            f"--keep-flat labels {path} has {table.shape[0]} rows; allowed: {len(given.points)}, one per vertex of "
            f"{given.path}, or {surface.n_faces}, one per face")
    marked = np.nan_to_num(table[:, 0].astype(float)) != 0
    if len(marked) != surface.n_faces:
        marked = np.array([marked[np.asarray(face)].all() for face in given.faces])
    return marked[faces]


def _from_triangles(surface, flat, border):
    """The distance along the surface from these triangles."""
    if not flat.any():
        return np.full(surface.n_points, np.inf)
    sources = np.zeros(surface.n_points, dtype=bool)
    sources[surface.triangles[flat]] = True
    return np.asarray(distance(surface, sources, method="Eikonal")) if border else (~sources).astype(float)
