# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""New files of a surface, for printers and viewers: STL, 3MF, OBJ, OFF and PLY. The same surface gives the
same bytes."""
from __future__ import annotations

import io
import os
import zipfile

import numpy as np

from .content import FileError, check_range, write_atomically

#: The units of coordinates, in millimetres, and their names in 3MF.
UNITS = {"um": (0.001, "micron"), "mm": (1.0, "millimeter"), "cm": (10.0, "centimeter"),
         "m": (1000.0, "meter"), "in": (25.4, "inch")}

#: Of STL's coordinates, over the size of the part, from corner to corner; at the origin it is below 1e-7.
LARGEST_STEP = 1e-5

_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def kind_of_export(path):
    """"stl", "3mf", "obj", "off" or "ply" by the name; None for others."""
    kind = os.path.splitext(os.fspath(path).lower())[1][1:]
    return kind if kind in _WRITERS else None


def export(path, points, triangles, colors=None, unit="mm"):
    """Write a surface in the format that the name says. colors: (n, 3) of uint8, which STL has not.
    unit: of the coordinates, for 3MF; the other formats have none."""
    kind = kind_of_export(path)
    if kind is None:
        raise FileError(f"{path}: the name announces no format of surfaces; allowed: "
                        + ", ".join("." + known for known in _WRITERS))
    check_range(path, kind, [points], "coordinate")
    write_atomically(path, _WRITERS[kind](np.asarray(points, dtype=float),
                                          np.asarray(triangles), colors, unit))


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


def _stl(points, triangles, colors, unit):
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    rows = np.zeros(len(triangles), _TRIANGLE)
    rows["normal"] = np.divide(normals, lengths[:, None], out=normals, where=lengths[:, None] > 0)
    rows["corners"] = corners
    return b"surfacediffusion".ljust(80) + np.uint32(len(rows)).tobytes() + rows.tobytes()


def _obj(points, triangles, colors, unit):
    if colors is None:
        vertices = _lines("v %.9g %.9g %.9g", points)
    else:
        vertices = _lines("v %.9g %.9g %.9g %.4g %.4g %.4g", np.hstack([points, colors / 255]))
    return (vertices + _lines("f %d %d %d", triangles + 1)).encode()


def _off(points, triangles, colors, unit):
    if colors is None:
        head, vertices = "OFF", _lines("%.9g %.9g %.9g", points)
    else:
        head, vertices = "COFF", _lines("%.9g %.9g %.9g %d %d %d 255", np.hstack([points, colors]))
    return (f"{head}\n{len(points)} {len(triangles)} 0\n" + vertices + _lines("3 %d %d %d", triangles)).encode()


def _ply(points, triangles, colors, unit):
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


_CONTENT_TYPES = """<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">\
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>\
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>\
</Types>
"""
_RELATIONSHIPS = """<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">\
<Relationship Id="rel0" Target="/3D/3dmodel.model" \
Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"""
_MODEL = """<?xml version="1.0" encoding="UTF-8"?>
<model unit="{unit}" xml:lang="en-US" \
xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources><object id="1" type="model"><mesh>
<vertices>
{vertices}</vertices>
<triangles>
{triangles}</triangles>
</mesh></object></resources>
<build><item objectid="1"/></build>
</model>
"""


def _3mf(points, triangles, colors, unit):
    distinct = ((triangles[:, 0] != triangles[:, 1]) & (triangles[:, 1] != triangles[:, 2])
                & (triangles[:, 2] != triangles[:, 0]))  # the format allows no others
    model = _MODEL.format(
        unit=UNITS[unit][1], vertices=_lines('<vertex x="%.9g" y="%.9g" z="%.9g"/>', points),
        triangles=_lines('<triangle v1="%d" v2="%d" v3="%d"/>', triangles[distinct]))
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=4) as archive:
        for name, text in (("[Content_Types].xml", _CONTENT_TYPES), ("_rels/.rels", _RELATIONSHIPS),
                           ("3D/3dmodel.model", model)):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))  # not the time of writing
            entry.compress_type, entry.create_system = zipfile.ZIP_DEFLATED, 3
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, text)
    return file.getvalue()


def _lines(template, rows):
    return "".join(map((template + "\n").__mod__, map(tuple, rows.tolist())))


_WRITERS = {"stl": _stl, "3mf": _3mf, "obj": _obj, "off": _off, "ply": _ply}
