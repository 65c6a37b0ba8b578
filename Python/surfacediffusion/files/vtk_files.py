# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Polydata and unstructured grids of VTK, legacy and XML, through VTK's own readers. The package vtk is
imported for such files only."""
from __future__ import annotations

import contextlib
import re
from xml.sax.saxutils import escape

import numpy as np

from .content import import_reader, on_disk
from .vtk_checks import check_legacy, check_xml

#: The kinds of files of this module
KINDS = ("vtk", "vtp", "vtu")

#: Cells of a grid that are faces, and those that are points and lines
_FACES, _PIXEL, _THINNER = (5, 7, 8, 9), 8, (0, 1, 2, 3, 4, 21)


def read(content):
    """The vtkPolyData or vtkUnstructuredGrid of the file. Strips of triangles are triangles then."""
    import_reader("vtkmodules.vtkCommonCore", content)
    if content.kind == "vtk":
        mesh = _read(content, f"legacy {check_legacy(content.bytes)}", content.bytes)
    else:
        kind = check_xml(content.bytes, lambda kind, data: _read(content, kind, data))
        if kind not in ("PolyData", "UnstructuredGrid"):
            raise content.error(f"a VTK XML file of {kind or 'no type'}; allowed: PolyData, UnstructuredGrid")
        mesh = _read(content, kind, content.bytes)
    return _without_strips(mesh) if mesh.IsA("vtkPolyData") and mesh.GetNumberOfStrips() else mesh


def _read(content, kind, data):
    """The object of VTK that `data` are, in the format and of the type `kind`."""
    from vtkmodules import vtkCommonCore as core
    from vtkmodules import vtkIOLegacy, vtkIOXML

    reader = {"legacy polydata": vtkIOLegacy.vtkPolyDataReader,
              "legacy unstructured_grid": vtkIOLegacy.vtkUnstructuredGridReader,
              "PolyData": vtkIOXML.vtkXMLPolyDataReader,
              "UnstructuredGrid": vtkIOXML.vtkXMLUnstructuredGridReader}[kind]()
    # Errors of readers and of their parsers go to the output window, and to a log on standard error.
    before = core.vtkOutputWindow.GetInstance()
    verbosity = core.vtkLogger.GetCurrentVerbosityCutoff()
    window = core.vtkStringOutputWindow()
    core.vtkOutputWindow.SetInstance(window)
    core.vtkLogger.SetStderrVerbosity(core.vtkLogger.VERBOSITY_OFF)
    try:
        if content.kind == "vtk":
            reader.ReadAllScalarsOn()
            reader.ReadAllVectorsOn()
            reader.ReadAllNormalsOn()
            reader.ReadAllTensorsOn()
            reader.ReadAllTCoordsOn()
            reader.ReadAllFieldsOn()
            reader.ReadAllColorScalarsOn()
        with on_disk(data) as path:
            reader.SetFileName(path)
            reader.Update()
        problems = window.GetOutput()
    finally:
        core.vtkOutputWindow.SetInstance(before)
        core.vtkLogger.SetStderrVerbosity(verbosity)
    # "ERROR: In file, line n", then "class (address): text" or text. Truncated files give a generic
    # warning that begins with "Error"; other warnings are not in the way of the data.
    entries = re.split(r"(ERROR|(?:Generic )?Warning): In .*\s", problems)
    for level, text in zip(entries[1::2], entries[2::2]):
        text = re.sub(r"^\s*\w+ \(\w+\): ", "", text)
        if level == "ERROR" or text.startswith("Error"):
            raise ValueError(text.replace(path, content.path))
    return reader.GetOutput()


def _rows(cells):
    """The corners of each cell of a vtkCellArray: (m, k) if all have k, otherwise lists."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    offsets = vtk_to_numpy(cells.GetOffsetsArray()).astype(np.int64)
    corners = vtk_to_numpy(cells.GetConnectivityArray()).astype(np.int64)
    sizes = np.diff(offsets)
    if len(sizes) and (sizes < 0).any() or len(offsets) and not 0 <= offsets[-1] <= len(corners):
        raise ValueError(f"the offsets of cells do not ascend to {len(corners)}")
    if len(sizes) and (sizes == sizes[0]).all():
        return corners.reshape(len(sizes), -1)
    return [corners[a:b].tolist() for a, b in zip(offsets[:-1], offsets[1:])]


def _without_strips(mesh):
    """The triangles of strips as polygons, each with the data of its strip."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkIdList
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    changed, polygons, cells = vtkPolyData(), vtkCellArray(), vtkIdList()
    changed.ShallowCopy(mesh)
    polygons.DeepCopy(mesh.GetPolys())
    first = mesh.GetNumberOfCells() - mesh.GetNumberOfStrips()
    origins = list(range(first))
    for number, strip in enumerate(_rows(mesh.GetStrips())):
        for k in range(len(strip) - 2):
            polygons.InsertNextCell(3, [int(strip[k + 1 * (k % 2)]), int(strip[k + 1 - k % 2]), int(strip[k + 2])])
            origins.append(first + number)
    changed.SetPolys(polygons)
    changed.SetStrips(vtkCellArray())
    for origin in origins:
        cells.InsertNextId(origin)
    data = changed.GetCellData()
    for i in range(data.GetNumberOfArrays()):
        given = mesh.GetCellData().GetAbstractArray(i)
        array = given.NewInstance()
        array.SetName(given.GetName())
        array.SetNumberOfComponents(given.GetNumberOfComponents())
        array.SetNumberOfTuples(len(origins))
        given.GetTuples(cells, array)
        data.AddArray(array)  # in place of that of the same name
    return changed


def points_and_faces(mesh):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if mesh.GetNumberOfPoints() == 0:
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    if mesh.IsA("vtkPolyData"):
        return points, _rows(mesh.GetPolys())
    rows, types = _rows(mesh.GetCells()), _cell_types(mesh)
    others = set(types.tolist()) - {*_FACES, *_THINNER}
    if others:
        raise ValueError(f"cells of VTK's type {min(others)}; allowed: triangles (5), polygons (7), pixels (8) "
                         "and quadrilaterals (9), which ParaView's filter Extract Surface makes of others")
    if isinstance(rows, np.ndarray) and (types != _PIXEL).all():
        return points, rows[np.isin(types, _FACES)]
    faces = [list(rows[i]) for i in np.flatnonzero(np.isin(types, _FACES))]
    for i, kind in enumerate(types[np.isin(types, _FACES)]):
        if kind == _PIXEL:
            faces[i][2:] = faces[i][:1:-1]
    return points, faces


def _cell_types(grid):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if grid.GetNumberOfCells() == 0:
        return np.zeros(0, np.uint8)
    try:
        return vtk_to_numpy(grid.GetCellTypes())
    except TypeError:  # before VTK 9.6
        return vtk_to_numpy(grid.GetCellTypesArray())


def cells_of_faces(mesh):
    """The number of the cell that each face is."""
    if mesh.IsA("vtkPolyData"):
        return mesh.GetNumberOfVerts() + mesh.GetNumberOfLines() + np.arange(mesh.GetNumberOfPolys())
    return np.flatnonzero(np.isin(_cell_types(mesh), _FACES))


def at_cells(mesh, values):
    """A row for each cell: those of `values` at faces, 0 at vertices and lines."""
    rows = np.zeros((mesh.GetNumberOfCells(), *np.shape(values)[1:]), np.asarray(values).dtype)
    rows[cells_of_faces(mesh)] = values
    return rows


def arrays_of(data):
    """{name: array} of the numeric arrays among the attributes of points or cells."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    found = {}
    for i, array in enumerate(map(data.GetArray, range(data.GetNumberOfArrays()))):
        if array is not None:
            with contextlib.suppress(AssertionError):  # bits, before VTK 9.3
                found[array.GetName() or f"array{i}"] = vtk_to_numpy(array)
    return found


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

    changed = mesh.NewInstance()
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
    return _bytes_of(changed) if kind == "vtk" else _xml_of(changed)


def _bytes_of(mesh):
    from vtkmodules import vtkIOLegacy

    writer = (vtkIOLegacy.vtkPolyDataWriter() if mesh.IsA("vtkPolyData")
              else vtkIOLegacy.vtkUnstructuredGridWriter())
    writer.SetInputData(mesh)
    writer.WriteToOutputStringOn()
    writer.SetFileTypeToBinary()
    writer.Write()
    return writer.GetOutputStdString() if isinstance(
        writer.GetOutputStdString(), bytes) else bytes(writer.GetBinaryOutputString())


def _xml_of(mesh):
    from vtkmodules import vtkIOXML

    writer = (vtkIOXML.vtkXMLPolyDataWriter() if mesh.IsA("vtkPolyData")
              else vtkIOXML.vtkXMLUnstructuredGridWriter())
    writer.SetInputData(mesh)
    writer.WriteToOutputStringOn()
    writer.SetDataModeToBinary()  # which all versions of VTK and ParaView read
    writer.Write()
    text = writer.GetOutputString()
    # VTK writes names as they are, with signs that end an attribute or begin an entity.
    for name in _names(mesh):
        escaped = escape(name, {'"': "&quot;", "\n": "&#10;", "\t": "&#9;"})
        if escaped != name:
            text = text.replace(f'="{name}"', f'="{escaped}"')
    return text.encode()


def _names(mesh):
    """Those of all arrays and of their components."""
    for data in (mesh.GetPointData(), mesh.GetCellData(), mesh.GetFieldData()):
        for array in map(data.GetAbstractArray, range(data.GetNumberOfArrays())):
            for name in (array.GetName(), *map(array.GetComponentName, range(array.GetNumberOfComponents()))):
                yield name or ""
