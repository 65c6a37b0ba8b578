# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""New files of a surface, for printers and viewers: STL, 3MF, OBJ, OFF and PLY. The same surface gives the
same bytes."""
from __future__ import annotations

import dataclasses
import os

import numpy as np

from . import threemf
from .content import FileError, check_range, write_atomically
from .threemf import UNITS, Objects

__all__ = ["UNITS", "export", "kind_of_export", "places_in_file"]

#: Of STL's coordinates, over the size of the part, from corner to corner; at the origin it is below 1e-7.
LARGEST_STEP = 1e-5

_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def kind_of_export(path):
    """"stl", "3mf", "obj", "off" or "ply" by the name; None for others."""
    kind = os.path.splitext(os.fspath(path).lower())[1][1:]
    return kind if kind in _WRITERS else None


def export(path, points, triangles, colors=None, unit="mm", objects=None, materials=()):
    """Write a surface in the format that the name says. colors: (n, 3) of uint8, which STL has not.
    Of 3MF, unit: of the coordinates; objects: Objects in place of one; materials: see threemf.write()."""
    kind = kind_of_export(path)
    if kind is None:
        raise FileError(f"{path}: the name announces no format of surfaces; allowed: "
                        + ", ".join("." + known for known in _WRITERS))
    check_range(path, kind, [points], "coordinate")
    more = (unit, objects, materials) if kind == "3mf" else ()
    write_atomically(path, _WRITERS[kind](np.asarray(points, dtype=float), np.asarray(triangles), colors, *more))


def places_in_file(path, points, say):
    """The points as the format of the file can hold them. STL has single precision, which takes what is small
    from parts that are far from the origin: they are moved there, and say() has a line about it."""
    points = np.asarray(points, dtype=float)
    if kind_of_export(path) != "stl":
        return points
    check_range(path, "stl", [points], "coordinate")
    low, high = points.min(axis=0), points.max(axis=0)
    step = float(np.spacing(np.float32(np.abs([low, high]).max())))
    if step <= LARGEST_STEP * np.linalg.norm(high - low):
        return points
    unit = 10.0 ** np.floor(np.log10(np.linalg.norm(high - low)))
    shift = unit * np.round(0.5 * (low + high) / unit)
    say(f"{path}: coordinates of up to {np.abs([low, high]).max():.6g} have steps of {step:.2g} in STL, so that "
        f"the part is moved by {' '.join(f'{-x:.10g}' for x in shift)} (PLY and OBJ keep its place)")
    return points - shift


def _stl(points, triangles, colors):
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    rows = np.zeros(len(triangles), _TRIANGLE)
    rows["normal"] = np.divide(normals, lengths[:, None], out=normals, where=lengths[:, None] > 0)
    rows["corners"] = corners
    return b"surfacediffusion".ljust(80) + np.uint32(len(rows)).tobytes() + rows.tobytes()


def _obj(points, triangles, colors):
    if colors is None:
        vertices = _lines("v %g %g %g", points)
    else:
        vertices = _lines("v %g %g %g %.4g %.4g %.4g", np.hstack([points, colors / 255]))
    return (vertices + _lines("f %d %d %d", triangles + 1)).encode()


def _off(points, triangles, colors):
    if colors is None:
        head, vertices = "OFF", _lines("%g %g %g", points)
    else:
        head, vertices = "COFF", _lines("%g %g %g %d %d %d 255", np.hstack([points, colors]))
    return (f"{head}\n{len(points)} {len(triangles)} 0\n" + vertices + _lines("3 %d %d %d", triangles)).encode()


def _ply(points, triangles, colors):
    properties = [(name, "<f8", "double") for name in "xyz"]
    if colors is not None:
        properties += [(name, "u1", "uchar") for name in ("red", "green", "blue")]
    vertices = np.empty(len(points), [(name, kind) for name, kind, _ in properties])
    for axis, name in enumerate("xyz"):
        vertices[name] = points[:, axis]
    for channel, name in enumerate(("red", "green", "blue") if colors is not None else ()):
        vertices[name] = colors[:, channel]
    faces = np.empty(len(triangles), [("size", "u1"), ("corners", "<i4", 3)])
    faces["size"], faces["corners"] = 3, triangles
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}",
              *(f"property {word} {name}" for name, _, word in properties),
              f"element face {len(triangles)}", "property list uchar int vertex_indices",
              "end_header", ""]
    return "\n".join(header).encode() + vertices.tobytes() + faces.tobytes()


def _3mf(points, triangles, colors, unit, objects, materials):
    objects = objects or Objects(unit, [""], np.zeros(len(triangles), dtype=int))
    if colors is not None:
        objects = dataclasses.replace(objects, colors=np.asarray(colors)[triangles])
    return threemf.write(points, triangles, objects, _lines, materials)


def _lines(template, rows):
    """Lines of numbers. %g are coordinates, with 9 digits of the size of the surface, wherever it is."""
    if rows.dtype.kind == "f":
        places = rows[:, :3]
        size, most = np.ptp(places, axis=0).max(initial=0), np.abs(places).max(initial=0)
        digits = 9 + (int(np.ceil(np.log10(most / size))) if 0 < size < most else 0)
        template = template.replace("%g", f"%.{min(digits, 17)}g")
    return "".join(map((template + "\n").__mod__, map(tuple, rows.tolist())))


_WRITERS = {"stl": _stl, "3mf": _3mf, "obj": _obj, "off": _off, "ply": _ply}
