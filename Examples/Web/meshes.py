# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of the page: from the bytes of dropped files, and as files to download."""
import contextlib
import gzip
import io
import os
import re
import tempfile
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

import surfacediffusion as sd
from surfacediffusion.files import FileError, new_data, read_data, read_surface, vtk_files
from surfacediffusion.files.data import NO_VERTICES
from surfacediffusion.files.export import export

FORMATS = ("OFF, OBJ, PLY, STL, VTK, VTP, GIFTI and FreeSurfer for surfaces; the same, CIFTI apart, "
           "and MGH and NPY for values at their points")
COLOURS = {"red", "green", "blue", "alpha"}
HEIGHT = "Height (z)"


@dataclass
class Mesh:
    """A surface and the arrays (n,) or (n, k) at its points. file: the surface's file, and origins: for
    arrays of files, their data and the numbers of their columns."""

    name: str
    surface: sd.Surface
    arrays: dict = field(default_factory=dict)
    file: Any = None
    origins: dict = field(default_factory=dict)

    @property
    def diagonal(self):
        points = self.surface.points
        return float(np.linalg.norm(points.max(axis=0) - points.min(axis=0)))

    @property
    def unit(self):
        """Of the coordinates: formats of neuroimaging have millimetres, the others do not say."""
        return "mm" if self.file is not None and self.file.kind in ("gifti", "freesurfer") else ""

    def unit_of(self, name):
        """Of an array; empty if it is not known."""
        is_length = name == HEIGHT or "thickness" in name.lower() or "sulc" in name.lower()
        return self.unit if is_length else ""


def example():
    """A rough pebble with noisy stripes, so that there is something to see at once."""
    ball = sd.sphere(5)
    x, y, z = ball.points.T
    random = np.random.default_rng(0)
    radius = 10 + np.sin(3 * x) * np.cos(2 * y) + 1.5 * y * z + random.normal(scale=0.03, size=x.size)
    stripes = np.digitize(np.sin(4 * x + 2 * y * z) + 0.6 * z, (-0.4, 0.5)).astype(float)
    surface = sd.Surface(radius[:, None] * ball.points, ball.triangles)
    return Mesh("pebble (example)", surface, {
        "Stripes with noise": stripes + random.normal(scale=0.2, size=x.size), "Stripes": stripes})


def read_mesh(files, megabytes):
    """The mesh of dropped files [(name, bytes)]: one with a surface, others with values at its points.
    All of them together, decompressed, may have so many megabytes. FileError with one line for the page
    if there is a problem."""
    room = megabytes * 2**20
    for _, content in files:
        room -= size_of(content, room)
        if room < 0:
            raise FileError(f"the files have more than {megabytes:g} MB, decompressed; allowed: "
                            f"{megabytes:g} MB")
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for number, (name, content) in enumerate(files):
            # A folder each: FreeSurfer's readers look at names, and two files may have one name.
            path = Path(folder, str(number), plain_name(name))
            path.parent.mkdir()
            path.write_bytes(content)
            paths.append(path)
        try:
            return _read(paths)
        except FileError as problem:
            text = str(problem)
            for path in paths:
                text = text.replace(str(path), path.name)
            raise FileError(text) from None


def plain_name(name):
    """A name within any folder, of one that the browser sends: the end of it, which says the format."""
    name = re.sub(r"[\x00-\x1f]", "_", name.replace("\\", "/").rsplit("/", 1)[-1])
    name = name.encode("utf-8", "ignore")[-120:].decode("utf-8", "ignore")
    return name if name.strip(". ") else "file"


def size_of(content, limit):
    """The size of a file in bytes, decompressed if it is one of gzip: nothing is decompressed far
    beyond the limit, and nothing is kept."""
    size = len(content)
    if content[:2] == b"\x1f\x8b":
        with contextlib.suppress(OSError, EOFError, zlib.error):  # the reader says what is wrong
            with gzip.open(io.BytesIO(content)) as file:
                decompressed = 0
                while decompressed <= limit and (chunk := file.read(1 << 20)):
                    decompressed += len(chunk)
                    size = max(size, decompressed)
    return size


def _read(paths):
    surface, problems, others = None, [], []
    for path in paths:
        try:
            if surface is None:
                surface = read_surface(path)
                with_surface = path
                continue
        except FileError as problem:
            problems.append(str(problem))
        others.append(path)
    if surface is None:
        raise FileError("; ".join(problems) or "no file")
    mesh = Mesh(with_surface.name, sd.Surface(surface.points, surface.faces), file=surface)
    _add_arrays(mesh, with_surface, optional=True)
    for path in others:
        _add_arrays(mesh, path, optional=False)
    mesh.arrays.setdefault(HEIGHT, mesh.surface.points[:, 2].copy())
    return mesh


def _add_arrays(mesh, path, optional):
    """Add the arrays of a file; columns of one name are components of one array."""
    try:
        data = read_data(path)
    except FileError:
        if optional:
            return
        raise
    values, n = data.parts[0].values, mesh.surface.n_points
    if mesh.file.kind == "stl":
        raise FileError(f"{path}: {NO_VERTICES}")
    if data.parts[0].vertices is not None and not (data.parts[0].vertices < n).all():
        raise FileError(f"{path}: vertices up to {data.parts[0].vertices.max()}; allowed: below {n}, the "
                        f"number of points of {mesh.name}")
    if data.parts[0].vertices is None and len(values) != n:
        raise FileError(f"{path}: {len(values)} values; allowed: {n}, one per point of {mesh.name}")
    if data.parts[0].vertices is not None:
        full = np.full((n, values.shape[1]), np.nan)
        full[data.parts[0].vertices] = values
        values = full
    if {"red", "green", "blue"} <= set(data.names):  # PLY
        data.names = ["Colour" if name in COLOURS else name for name in data.names]
    for name in dict.fromkeys(data.names):
        columns = [i for i, other in enumerate(data.names) if other == name]
        array = values[:, columns]
        name = name.rsplit("/", 1)[-1]  # GIFTI may name the file that the values come from
        if name.isdigit() or not name or data.kind == "curv":  # columns without a name
            name = path.name if len(data.names) == 1 else f"{path.name} {name}"
        mesh.arrays[name] = array[:, 0] if array.shape[1] == 1 else _as_colours(array)
        mesh.origins[name] = data, columns


def _as_colours(array):
    """Three or four columns of integers from 0 to 255 as uint8, all other arrays as they are."""
    if array.shape[1] in (3, 4) and array.max() > 1 and (array == array.astype(np.uint8)).all():
        return array.astype(np.uint8)
    return array


def as_polydata(points, triangles, arrays=None, cell_arrays=None):
    """vtkPolyData with these arrays at points and cells."""
    surface, coordinates, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    coordinates.SetData(numpy_to_vtk(np.ascontiguousarray(points, np.float32), deep=True))
    cells.SetData(
        numpy_to_vtkIdTypeArray(np.arange(0, 3 * len(triangles) + 1, 3, dtype=np.int64), deep=True),
        numpy_to_vtkIdTypeArray(np.ascontiguousarray(triangles, np.int64).ravel(), deep=True))
    surface.SetPoints(coordinates)
    surface.SetPolys(cells)
    for target, given in ((surface.GetPointData(), arrays), (surface.GetCellData(), cell_arrays)):
        for name, values in (given or {}).items():
            array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName(name)
            target.AddArray(array)
    return surface


def result_names(mesh, outcome, array):
    """The names of the files that the result can be downloaded as. The first has the format of the file
    that was dropped, if it can hold the result; the last is a VTP file, which holds everything."""
    names = []
    if outcome.triangles is not None:
        names += ["result.stl", "result.3mf", "result.obj", "result.ply"]
    elif outcome.points is not None:
        if mesh.file is not None:
            names.append(_result_name(mesh.file.path))
    elif array in mesh.origins and _same_shape(outcome.shown, mesh.arrays[array]):
        names.append(_result_name(mesh.origins[array][0].path))
    elif mesh.unit and outcome.shown is not None and np.ndim(outcome.shown) == 1:
        names.append("result.func.gii" if mesh.file.kind == "gifti" else "result.mgh")
    return [*names, "result.vtp"]


def _same_shape(a, b):
    return a is not None and np.shape(a) == np.shape(b)


def _result_name(path):
    """"lh.thickness_result" or "thickness_result.shape.gii" for a file of that name."""
    name = os.path.basename(path)
    for ending in (".gii", ".nii", ".off", ".obj", ".ply", ".stl", ".vtk", ".vtp", ".npy", ".mgh", ".mgz"):
        stem, found, rest = name.partition(ending)
        if found and rest in ("", ".gz"):
            stem, kind = os.path.splitext(stem)
            return f"{stem}_result{kind}{ending}{rest}"
    return f"{name}_result"


def result_file(mesh, outcome, array, name):
    """The bytes of one of the files of result_names(): the name comes from the browser, which may send any."""
    if name not in result_names(mesh, outcome, array):
        raise FileError(f"{name[:80]!r}; allowed: {', '.join(result_names(mesh, outcome, array))}")
    if name == "result.vtp":
        return vtp_file(mesh, outcome)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, name)
        if outcome.triangles is not None:
            shades = np.rint(255 * outcome.shown).astype(np.uint8)
            export(path, outcome.points, outcome.triangles, np.repeat(shades[:, None], 3, axis=1))
            return path.read_bytes()
        if outcome.points is not None:
            mesh.file.save(path, outcome.points)
            return path.read_bytes()
        values = np.reshape(outcome.shown, (len(outcome.shown), -1))
        if array in mesh.origins:
            data, columns = mesh.origins[array]
            vertices = data.parts[0].vertices
            data.save(path, [values if vertices is None else values[vertices]], columns)
        else:
            new_data(mesh.file, path, list(outcome.arrays)[:1]).save(path, [values])
        return path.read_bytes()


def vtp_file(mesh, outcome):
    """The bytes of a VTP file with the input's arrays and those of the outcome."""
    if outcome.triangles is not None:
        return vtk_files.write("vtp", as_polydata(outcome.points, outcome.triangles, outcome.arrays))
    points = mesh.surface.points if outcome.points is None else outcome.points
    cell_arrays = outcome.cell_arrays if len(mesh.surface.triangles) == mesh.surface.n_faces else {}
    return vtk_files.write("vtp", as_polydata(points, mesh.surface.triangles, {**mesh.arrays, **outcome.arrays},
                                              cell_arrays))
