# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""3MF files: a zip archive with meshes of objects, which are placed to be printed. Each item of the build is an
object here, with the components that it is made of. A small file may name an object many times, or hold zeros
that unpack to any size: bytes, points and levels have bounds."""
from __future__ import annotations

import io
import posixpath
import zipfile
from array import array
from dataclasses import dataclass, field
from xml.parsers import expat
from xml.sax.saxutils import quoteattr

import numpy as np

#: The units of coordinates, in millimetres, and their names in 3MF.
UNITS = {"um": (0.001, "micron"), "mm": (1.0, "millimeter"), "cm": (10.0, "centimeter"),
         "m": (1000.0, "meter"), "in": (25.4, "inch")}

_MOST_BYTES = 2 << 30  # of XML
_MOST_POINTS = 20_000_000  # and triangles
_MOST_PLACED = 20_000  # objects and components
_LEVELS = 8
_CHUNK = 1 << 20
_MODEL = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"


@dataclass
class Objects:
    """What a 3MF file says of its parts. unit: a key of UNITS. names: of the objects; may be empty. of_face: (m,),
    the object of each triangle. colors: (m, 3, 3) of uint8, of the corners, or None."""

    unit: str
    names: list
    of_face: np.ndarray
    colors: np.ndarray | None = None
    colored: np.ndarray | None = None  # (m,), which triangles have them


@dataclass
class _Object:
    name: str = ""
    default: tuple = ("", "")  # group of colours and number of all triangles without their own
    points: array = field(default_factory=lambda: array("d"))
    corners: array = field(default_factory=lambda: array("q"))
    colors: list = field(default_factory=list)  # per triangle: group and three numbers
    components: list = field(default_factory=list)


class _Part:
    """One model of the archive: objects by id, groups of colours by id, items of the build."""

    def __init__(self, file, left):
        self.unit, self.objects, self.groups, self.items = "millimeter", {}, {}, []
        self._object = self._group = None
        parser = expat.ParserCreate(namespace_separator="}")
        parser.StartElementHandler, parser.EndElementHandler = self._start, self._end
        parser.StartDoctypeDeclHandler = self._refuse
        while chunk := file.read(_CHUNK):
            left[0] -= len(chunk)
            if left[0] < 0:
                raise ValueError(f"its models are larger than {_MOST_BYTES >> 30} GiB; allowed: less")
            parser.Parse(chunk)
        parser.Parse(b"", True)

    def _refuse(self, *_):
        raise ValueError("its model has a document type declaration; allowed: none, as 3MF says")

    def _end(self, name):
        if name.endswith("}object"):
            self._object = None

    def _start(self, name, values):
        kind = name.rsplit("}", 1)[-1]
        if kind == "vertex" and self._object is not None:
            self._object.points.extend((float(values["x"]), float(values["y"]), float(values["z"])))
        elif kind == "triangle" and self._object is not None:
            self._object.corners.extend((int(values["v1"]), int(values["v2"]), int(values["v3"])))
            first = values.get("p1")
            self._object.colors.append(None if first is None else (
                values.get("pid", self._object.default[0]), first, values.get("p2", first), values.get("p3", first)))
        elif kind == "model":
            self.unit = values.get("unit", "millimeter")
        elif kind == "object":
            self._object = self.objects[values["id"]] = _Object(
                values.get("name", ""), (values.get("pid", ""), values.get("pindex", "0")))
        elif kind in ("basematerials", "colorgroup"):
            self._group = self.groups[values["id"]] = []
        elif kind in ("base", "color") and self._group is not None:
            self._group.append(_color(values.get("displaycolor") or values.get("color") or ""))
        elif kind in ("component", "item"):
            path = next((value for key, value in values.items() if key.endswith("}path")), None)
            placed = (path, values["objectid"], _transform(values.get("transform")), values.get("partnumber", ""))
            (self.items if kind == "item" else self._object.components).append(placed)


def _color(text):
    try:
        return tuple(bytes.fromhex(text.lstrip("#")[:6])) if len(text) >= 7 else None
    except ValueError:
        return None


def _transform(text):
    """Rows of x, y, z and of the shift, by which points are multiplied from the left; None for none."""
    if not text:
        return None
    words = text.split()
    if len(words) != 12:
        raise ValueError(f"a transform has {len(words)} numbers; allowed: 12")
    return np.array(words, dtype=float).reshape(4, 3)


class _Reader:
    def __init__(self, data):
        self.archive = zipfile.ZipFile(io.BytesIO(data))
        self.parts, self.left = {}, [_MOST_BYTES]
        self.placed = self.count = self.size = 0
        self.points, self.corners, self.colors = [], [], []

    def part(self, path):
        name = path.lstrip("/")
        if name not in self.parts:
            try:
                with self.archive.open(name) as file:
                    self.parts[name] = _Part(file, self.left)
            except KeyError:
                raise ValueError(f"there is no {name} in the archive") from None
            except RuntimeError as error:  # encrypted
                raise ValueError(f"{name}: {error}") from None
        return self.parts[name]

    def root(self):
        """The model that the relationships of the archive name, or the first one."""
        names = self.archive.namelist()
        found = []
        if "_rels/.rels" in names:
            def start(name, values):
                if values.get("Type") == _MODEL:
                    found.append(values.get("Target", ""))
            parser = expat.ParserCreate()
            parser.StartElementHandler = start
            with self.archive.open("_rels/.rels") as file:
                parser.Parse(file.read(_CHUNK), True)
        found += [name for name in names if name.lower().endswith(".model")]
        if not found:
            raise ValueError("an archive of files without the model of a 3MF file")
        return posixpath.normpath(found[0]).lstrip("/")

    def place(self, path, key, transforms, level=0):
        """Append the triangles of an object and of its components."""
        part = self.part(path)
        if key not in part.objects:
            raise ValueError(f"there is no object {key!r}")
        thing = part.objects[key]
        self.placed += 1
        self.count += max(len(thing.points), len(thing.corners)) // 3
        if level > _LEVELS or self.placed > _MOST_PLACED or self.count > _MOST_POINTS:
            raise ValueError(f"its objects are made of too many others; allowed: {_MOST_POINTS:,} points in all")
        if thing.corners:
            self._add(part, thing, transforms)
        for other, name, transform, _ in thing.components:
            self.place(other or path, name, [transform, *transforms], level + 1)

    def _add(self, part, thing, transforms):
        points = np.array(thing.points, dtype=float).reshape(-1, 3)
        corners = np.array(thing.corners, dtype=np.int64).reshape(-1, 3)
        if corners.min() < 0 or corners.max() >= len(points):
            bad = corners.min() if corners.min() < 0 else corners.max()
            raise ValueError(f"a face refers to point {bad}; allowed: 0 to {len(points) - 1}")
        for transform in transforms:
            if transform is not None:
                points = points @ transform[:3] + transform[3]
                if np.linalg.det(transform[:3]) < 0:
                    corners = corners[:, [0, 2, 1]]
        self.corners.append(corners + self.size)
        self.points.append(points)
        self.size += len(points)
        self.colors.append([_colors_of(part, thing, entry) for entry in thing.colors])


def _colors_of(part, thing, entry):
    group, *numbers = entry or (thing.default[0], *[thing.default[1]] * 3)
    known = part.groups.get(group, ())
    found = [known[int(number)] if number.isdigit() and int(number) < len(known) else None for number in numbers]
    return None if None in found else found


def read(data: bytes):
    """Points (n, 3), faces (m, 3), and Objects. A point belongs to one object."""
    reader = _Reader(data)
    root = reader.root()
    model = reader.part(root)
    names, of_face = [], []
    for path, key, transform, number in model.items:
        before = len(reader.corners)
        reader.place(path or root, key, [transform])
        of_face.append(np.full(sum(map(len, reader.corners[before:])), len(names)))
        names.append(reader.part(path or root).objects[key].name or number)
    if not reader.corners:
        raise ValueError("its build has no mesh; allowed: at least one item")
    points = np.concatenate(reader.points)
    units = {name: key for key, (_, name) in UNITS.items()}
    if model.unit == "foot":
        points, units["foot"] = 12 * points, "in"
    if model.unit not in units:
        raise ValueError(f"its unit is {model.unit!r}; allowed: foot, " + ", ".join(units))
    flat = [color for colors in reader.colors for color in colors]
    colored = np.array([color is not None for color in flat])
    colors = np.array([color or [(0, 0, 0)] * 3 for color in flat], dtype=np.uint8) if colored.any() else None
    return points, np.concatenate(reader.corners), Objects(
        units[model.unit], names, np.concatenate(of_face), colors, colored if colored.any() else None)


# ---- writing -------------------------------------------------------------------------------------

_CONTENT_TYPES = """<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">\
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>\
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>\
</Types>
"""
_RELATIONSHIPS = f"""<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">\
<Relationship Id="rel0" Target="/3D/3dmodel.model" Type="{_MODEL}"/></Relationships>
"""
_START = """<?xml version="1.0" encoding="UTF-8"?>
<model unit="{unit}" xml:lang="en-US" \
xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" \
xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02">
<resources>"""


def write(points, triangles, objects, lines, materials=()) -> bytes:
    """objects: Objects; one without triangles is left out, and so are triangles with a point twice, which 3MF does
    not allow. lines(template, rows): text. materials: a name and a colour (3,) per object, or none."""
    distinct = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    text = [_START.format(unit=UNITS[objects.unit][1])]
    if materials:
        text += ['<basematerials id="1">', *(
            f'<base name={quoteattr(name)} displaycolor="#{bytes(color).hex().upper()}"/>'
            for name, color in materials), "</basematerials>"]
    elif objects.colors is not None:
        known, numbers = np.unique(objects.colors.reshape(-1, 3), axis=0, return_inverse=True)
        numbers = numbers.reshape(-1, 3)
        text += ['<m:colorgroup id="1">', *(f'<m:color color="#{bytes(color).hex().upper()}"/>'
                                            for color in known.astype(np.uint8)), "</m:colorgroup>"]
    items = []
    for i, name in enumerate(objects.names):
        chosen = np.flatnonzero(distinct & (objects.of_face == i))
        if not len(chosen):
            continue
        used, corners = np.unique(triangles[chosen], return_inverse=True)
        rows, template = corners.reshape(-1, 3), '<triangle v1="%d" v2="%d" v3="%d"/>'
        if not materials and objects.colors is not None:
            rows = np.hstack([rows, numbers[chosen]])
            template = '<triangle v1="%d" v2="%d" v3="%d" pid="1" p1="%d" p2="%d" p3="%d"/>'
        text += [f'<object id="{i + 2}" type="model"' + (f" name={quoteattr(name)}" if name else "")
                 + (f' pid="1" pindex="{i}"' if materials else "") + "><mesh>\n<vertices>\n",
                 lines('<vertex x="%g" y="%g" z="%g"/>', points[used]), "</vertices>\n<triangles>\n",
                 lines(template, rows), "</triangles>\n</mesh></object>"]
        items.append(f'<item objectid="{i + 2}"/>')
    text += ["</resources>\n<build>", *items, "</build>\n</model>\n"]
    return _archive("".join(text))


def _archive(model):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=4) as archive:
        for name, text in (("[Content_Types].xml", _CONTENT_TYPES), ("_rels/.rels", _RELATIONSHIPS),
                           ("3D/3dmodel.model", model)):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))  # not the time of writing
            entry.compress_type, entry.create_system = zipfile.ZIP_DEFLATED, 3
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, text)
    return file.getvalue()
