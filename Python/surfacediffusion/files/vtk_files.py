# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Polydata of VTK, legacy and XML, through VTK's own readers. The package vtk is imported for such files
only."""
from __future__ import annotations

import base64
import re

import numpy as np

from .content import import_reader, on_disk


def read(content):
    """The vtkPolyData of the file."""
    core = import_reader("vtkmodules.vtkCommonCore", content)
    if content.kind == "vtp":
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader as Reader

        if b"PolyData" not in content.bytes[:4096]:
            raise content.error("a VTK XML file of another type; allowed: PolyData")
        _check_sizes(content.bytes)
    else:
        from vtkmodules.vtkIOLegacy import vtkPolyDataReader as Reader

        _check_version(content.bytes)
    # Errors of readers and of their parsers go to the output window, and to a log on standard error.
    before = core.vtkOutputWindow.GetInstance()
    verbosity = core.vtkLogger.GetCurrentVerbosityCutoff()
    window = core.vtkStringOutputWindow()
    core.vtkOutputWindow.SetInstance(window)
    core.vtkLogger.SetStderrVerbosity(core.vtkLogger.VERBOSITY_OFF)
    try:
        reader = Reader()
        if content.kind == "vtk":
            reader.ReadAllScalarsOn()
            reader.ReadAllVectorsOn()
            reader.ReadAllNormalsOn()
            reader.ReadAllFieldsOn()
            reader.ReadAllColorScalarsOn()
        with on_disk(content) as path:
            reader.SetFileName(path)
            reader.Update()
        problems = window.GetOutput()
    finally:
        core.vtkOutputWindow.SetInstance(before)
        core.vtkLogger.SetStderrVerbosity(verbosity)
    # "ERROR: In file, line n", then "class (address): text" or text. Truncated files give a generic
    # warning that begins with "Error"; other warnings are not in the way of the data.
    entries = re.split(r"(ERROR|(?:Generic )?Warning): In .*\s", problems)
    for kind, text in zip(entries[1::2], entries[2::2]):
        text = re.sub(r"^\s*\w+ \(\w+\): ", "", text)
        if kind == "ERROR" or text.startswith("Error"):
            raise ValueError(text.replace(path, content.path))
    return reader.GetOutput()


def _check_version(data):
    """Raises ValueError if cells are not as the version in the first line has them: VTK would read beyond
    its memory."""
    version = re.match(rb"# vtk DataFile Version (\d)\.\d\s", data)
    if version is None:
        raise ValueError(f"the version in the first line is {data[23:33]!r}; allowed: 1.0 to 5.1")
    for cells in re.finditer(rb"\n(?:VERTICES|LINES|POLYGONS|TRIANGLE_STRIPS)[ \t]+\d+[ \t]+\d+\s*\n"
                             rb"(OFFSETS)?", data):
        if (cells[1] is not None) != (version[1] >= b"5"):
            raise ValueError(f"cells of another version than {version[1].decode()}, that of the first line")


def _check_sizes(data):
    """Raises ValueError if an array announces more bytes than the file can hold: VTK would allocate them,
    and end the process where it cannot."""
    root = re.search(rb"<VTKFile\b[^>]*>", data)
    if root is None:
        return
    number = np.dtype("u8" if b'"UInt64"' in root[0] else "u4").newbyteorder(
        ">" if b'"BigEndian"' in root[0] else "<")
    compressed = b"compressor=" in root[0]
    appended = re.search(rb"<AppendedData\b[^>]*>\s*_", data)
    for array in re.finditer(rb"<DataArray\b[^>]*>", data[:appended.start() if appended else None]):
        offset = re.search(rb'offset="\s*\+?(\d{1,18})', array[0])  # digits count up to another character
        if b'"binary"' in array[0]:
            start, raw = array.end(), False
        elif b'"appended"' in array[0] and offset and appended:
            start, raw = appended.end() + int(offset[1]), b'"raw"' in appended[0]
        else:
            continue
        count = number.itemsize * (2 if compressed else 1)
        start += 0 if raw else len(data[start:start + 100]) - len(data[start:start + 100].lstrip())
        head = data[start:start + (count if raw else (count + 2) // 3 * 4)]
        sizes = np.frombuffer((head if raw else base64.b64decode(head))[:count], number).tolist()
        # Blocks of a compressed array have a length each, and zlib packs a thousand bytes in one.
        if sizes and (sizes[0] > len(data) or np.prod(sizes, dtype=float) > 10000.0 * len(data)):
            raise ValueError(f"an array announces {' blocks of '.join(map(str, sizes))} bytes, the file has "
                             f"{len(data)}")


def points_and_faces(mesh):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if mesh.GetNumberOfPoints() == 0:
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    polygons = mesh.GetPolys()
    offsets = vtk_to_numpy(polygons.GetOffsetsArray())
    corners = vtk_to_numpy(polygons.GetConnectivityArray()).astype(np.int64)
    if len(offsets) > 1 and (np.diff(offsets) == 3).all():
        return points, corners.reshape(-1, 3)
    return points, [corners[a:b].tolist() for a, b in zip(offsets[:-1], offsets[1:])]


def arrays_of(data):
    """{name: array} of the numeric arrays among the attributes of points or cells."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    arrays = [data.GetArray(i) for i in range(data.GetNumberOfArrays())]
    return {array.GetName() or f"array{i}": vtk_to_numpy(array)
            for i, array in enumerate(arrays) if array is not None}


def numbers_of(data):
    """The names of arrays that number or mark points or cells: ids, whole numbers one after another in
    any order, and those of VTK itself."""
    ids = [array.GetName() for array in (data.GetGlobalIds(), data.GetPedigreeIds()) if array is not None]

    def numbers(name, values):
        return name.startswith("vtk") or (
            values.dtype.kind in "iu" and values.ndim == 1 and len(values) > 1
            and int(values.max()) - int(values.min()) == len(values) - 1
            and len(np.unique(values)) == len(values))

    return {*ids, *(name for name, values in arrays_of(data).items() if numbers(name, values))}


def normals_of(mesh, of_points, of_faces):
    """The arguments of write() that replace the normals among the arrays of points and cells, or remove
    those of cells if some of them are no faces."""
    found = {}
    for key, attributes, values in (("point_data", mesh.GetPointData(), of_points),
                                    ("cell_data", mesh.GetCellData(), of_faces)):
        array = attributes.GetNormals() or attributes.GetArray("Normals")
        found[key] = {}
        if array is not None and array.GetNumberOfTuples() == len(values):
            found[key] = {array.GetName(): values.astype(np.float32)}
        elif array is not None:
            found[key] = {array.GetName(): None}
    return found


def write(kind, mesh, points=None, point_data=None, cell_data=None) -> bytes:
    """The mesh with other points, and with more or other arrays at its points or cells; None removes an
    array."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    changed = vtkPolyData()
    changed.ShallowCopy(mesh)
    if points is not None:
        moved = vtkPoints()
        moved.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
        changed.SetPoints(moved)
    for attributes, arrays in ((changed.GetPointData(), point_data),
                               (changed.GetCellData(), cell_data)):
        for name, values in (arrays or {}).items():
            if values is None:
                attributes.RemoveArray(name)
                continue
            array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
            array.SetName(name)
            attributes.AddArray(array)
    writer = vtkXMLPolyDataWriter() if kind == "vtp" else vtkPolyDataWriter()
    writer.SetInputData(changed)
    writer.WriteToOutputStringOn()
    if kind == "vtp":
        writer.SetDataModeToBinary()
        writer.Write()
        return writer.GetOutputString().encode()
    writer.SetFileTypeToBinary()
    writer.Write()
    return writer.GetOutputStdString() if isinstance(
        writer.GetOutputStdString(), bytes) else bytes(writer.GetBinaryOutputString())
