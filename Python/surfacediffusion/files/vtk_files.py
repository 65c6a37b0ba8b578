# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Polydata of VTK, legacy and XML, through VTK's own readers: meshio does not read polydata. The
package vtk is imported for such files only."""
from __future__ import annotations

import numpy as np

from .content import import_reader


def read(content):
    """The vtkPolyData of the file."""
    core = import_reader("vtkmodules.vtkCommonCore", content)
    if content.kind == "vtp":
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader as Reader

        if b"PolyData" not in content.bytes[:4096]:
            raise content.error("a VTK XML file of another type; allowed: PolyData")
    else:
        from vtkmodules.vtkIOLegacy import vtkPolyDataReader as Reader

    # Errors of readers and of their parsers go to the output window, and to a log on standard error.
    before = core.vtkOutputWindow.GetInstance()
    verbosity = core.vtkLogger.GetCurrentVerbosityCutoff()
    window = core.vtkStringOutputWindow()
    core.vtkOutputWindow.SetInstance(window)
    core.vtkLogger.SetStderrVerbosity(core.vtkLogger.VERBOSITY_OFF)
    try:
        reader = Reader()
        reader.SetFileName(content.path)
        if content.kind == "vtk":
            reader.ReadAllScalarsOn()
            reader.ReadAllVectorsOn()
            reader.ReadAllNormalsOn()
            reader.ReadAllFieldsOn()
            reader.ReadAllColorScalarsOn()
        reader.Update()
        problems = window.GetOutput()
    finally:
        core.vtkOutputWindow.SetInstance(before)
        core.vtkLogger.SetStderrVerbosity(verbosity)
    if problems:
        raise ValueError(problems)
    return reader.GetOutput()


def points_and_faces(mesh):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    if mesh.GetNumberOfPoints() == 0:
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
    if mesh.GetNumberOfStrips():
        raise ValueError("triangle strips; allowed: polygons")
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


def write(kind, mesh, points=None, point_data=None, cell_data=None) -> bytes:
    """The mesh with other points, and with more or other arrays at its points or cells."""
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
