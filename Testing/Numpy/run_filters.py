# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run the VTK filters on arrays from files, for TestSameBits.py, in a Python with VTK:

    run_filters.py <folder>

The folder has cases.json, a list of [filter, properties, {array name: index}], and one case<i>.npz
per case, with points, faces and the arrays. Results are written to result<i>.npz."""

import json
import pathlib
import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkIdTypeArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataObject, vtkPolyData

import vtkSurfaceDiffusion


def make_polydata(points, faces, sizes):
    coordinates = vtkPoints()
    coordinates.SetData(numpy_to_vtk(points, deep=True))
    cells = vtkCellArray()
    begin = 0
    for size in sizes:
        ids = vtkIdList()
        for point in faces[begin : begin + size]:
            ids.InsertNextId(int(point))
        cells.InsertNextCell(ids)
        begin += size
    polydata = vtkPolyData()
    polydata.SetPoints(coordinates)
    polydata.SetPolys(cells)
    return polydata


def run(name, properties, indices, arrays):
    polydata = make_polydata(arrays["points"], arrays["faces"], arrays["sizes"])
    algorithm = getattr(vtkSurfaceDiffusion, name)()
    for array_name, index in indices.items():
        array = numpy_to_vtk(np.ascontiguousarray(arrays[array_name]), deep=True)
        array.SetName(array_name)
        on_cells = len(arrays[array_name]) == len(arrays["sizes"])
        data = polydata.GetCellData() if on_cells else polydata.GetPointData()
        data.AddArray(array)
        association = (vtkDataObject.FIELD_ASSOCIATION_CELLS if on_cells
                       else vtkDataObject.FIELD_ASSOCIATION_POINTS)
        algorithm.SetInputArrayToProcess(index, 0, 0, association, array_name)
    for key, value in properties.items():
        if isinstance(value, str):
            getattr(algorithm, f"Set{key}To{value}")()
        elif isinstance(value, list):
            for each in value:
                getattr(algorithm, f"Add{key}")(each)
        else:
            getattr(algorithm, f"Set{key}")(value)
    algorithm.SetInputData(polydata)
    algorithm.Update()
    output = algorithm.GetOutputDataObject(0)
    padded = vtkIdTypeArray()
    output.GetPolys().ExportLegacyFormat(padded)
    results = {"points": vtk_to_numpy(output.GetPoints().GetData()), "polygons": vtk_to_numpy(padded)}
    results["active"] = np.array([
        f"{place} {kind} {data.GetAbstractAttribute(kind).GetName()}"
        for place, data in enumerate((output.GetPointData(), output.GetCellData())) for kind in range(3)
        if data.GetAbstractAttribute(kind)], dtype=str)
    for data in (output.GetPointData(), output.GetCellData()):
        for i in range(data.GetNumberOfArrays()):
            if data.GetArrayName(i) not in indices:
                results[data.GetArrayName(i)] = vtk_to_numpy(data.GetArray(i))
    if algorithm.GetNumberOfOutputPorts() > 1 and algorithm.GetOutputDataObject(1).IsA("vtkTable"):
        table = algorithm.GetOutputDataObject(1)
        for i in range(table.GetNumberOfColumns()):
            if table.GetColumnName(i) != "Seconds":
                results["history " + table.GetColumnName(i)] = vtk_to_numpy(table.GetColumn(i))
    return results


folder = pathlib.Path(sys.argv[1])
for number, case in enumerate(json.loads((folder / "cases.json").read_text())):
    with np.load(folder / f"case{number}.npz") as case_arrays:
        np.savez(folder / f"result{number}.npz", **run(*case, case_arrays))
