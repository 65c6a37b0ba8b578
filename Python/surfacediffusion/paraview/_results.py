# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The outputs of the filters: arrays, moved points, tables and curves. The rules are those of the classes
in C++, Filters/Conversion/ResultWriter.cxx."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import (
    VTK_FLOAT, VTK_UNSIGNED_CHAR, vtkDoubleArray, vtkFloatArray, vtkIntArray, vtkPoints,
    vtkTypeInt64Array, vtkUnsignedCharArray,
)
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkDataSetAttributes, vtkPolyData

from ._fields import Fields
from ._normals import update_normals
from ._surfaces import Block

_TYPES: dict[str, Any] = {"double": np.float64, "integer": np.int32, "byte": np.uint8}


@dataclass
class Output:
    """An entry of the list of a run, with its values."""

    entry: dict[str, Any]
    values: NDArray[Any]

    @property
    def name(self) -> str:
        return str(self.entry["name"])

    @property
    def place(self) -> str:
        return str(self.entry["place"])


_CLASSES: dict[str, Any] = {
    "float64": vtkDoubleArray, "float32": vtkFloatArray, "int32": vtkIntArray, "int64": vtkTypeInt64Array,
    "uint8": vtkUnsignedCharArray,
}


def make_array(name: str, values: NDArray[Any], array_class: Any = None) -> Any:
    """An array with a copy of the values, (n,) or (n, k), of the class of their type unless one is given."""
    array = (array_class or _CLASSES[values.dtype.name])()
    array.SetName(name)
    array.SetNumberOfComponents(1 if values.ndim == 1 else values.shape[1])
    array.SetNumberOfTuples(len(values))
    if values.size:
        vtk_to_numpy(array)[:] = values
    return array


def read_outputs(
    entries: list[dict[str, Any]], write: Callable[[int, Any, Any], None], fields: Fields, block: Block,
    result_type: Any,
) -> list[Output]:
    """Return the outputs of a run on one block. write: its function of the number of an output, an array,
    and the input. result_type: of the result of the data."""
    types = {**_TYPES, "data": result_type,
             "real": np.float32 if result_type == np.float32 else np.float64}
    rows = {"points": block.input.GetNumberOfPoints(), "faces": block.input.GetNumberOfCells()}
    outputs = []
    for number, entry in enumerate(entries):
        columns = entry["columns"]
        if entry["kind"] == "data" and fields.data.values is not None and entry["place"] in rows:
            columns = fields.data.values.GetNumberOfComponents()  # with alpha
        kind = entry["kind"] if entry["place"] in rows or entry["kind"] != "data" else "double"
        values = np.empty((rows.get(entry["place"], entry["rows"]), columns), dtype=types[kind])
        write(number, values, fields.core)
        outputs.append(Output(entry, values))
    return outputs


def write_outputs(
    outputs: list[Output], fields: Fields, data: Any, block: Block, prefix: str,
) -> list[str]:
    """Add arrays to the output of a block, and move its points. Return the names of other arrays of the
    input that were replaced. data: the array that gives results their name and that a result of this name
    replaces, or None. prefix: ResultArrayName."""
    before = vtkPolyData()
    before.ShallowCopy(block.output)
    replaced = []
    for output in outputs:
        if output.place not in ("points", "faces") or output.entry["columns"] == 0:
            continue
        if output.entry["role"] == "coordinates":
            _move(output.values, before, block.output)
            continue
        is_result, is_beside = output.entry["is_result"], output.entry["is_beside_result"]
        of_data = is_result or (is_beside and not prefix)
        data_name = (data.GetName() if data is not None else "") or output.entry["data_name"]
        name = prefix if is_result and prefix else (data_name if of_data else prefix) + output.name
        values = output.values
        array = make_array(name, values[:, 0] if values.shape[1] == 1 else values)
        if output.entry["kind"] == "data" and fields.data.values is not None:
            copy_component_names(fields.data.values, array)
        on_cells = output.place == "faces"
        attributes = block.output.GetCellData() if on_cells else block.output.GetPointData()
        former = attributes.GetAbstractArray(name)
        if former is not None:
            if former is not (data if name == prefix else None):
                replaced.append(name)
            attributes.RemoveArray(name)
        attributes.AddArray(array)
        if on_cells and is_result:
            block.cell_result = name
        if output.entry["role"]:
            attributes.SetActiveAttribute(name, _role(output, fields, array))
    return replaced


def copy_component_names(source: Any, array: Any) -> None:
    for k in range(source.GetNumberOfComponents()):
        name = source.GetComponentName(k)
        if name:
            array.SetComponentName(k, name)


def _role(output: Output, fields: Fields, array: Any) -> int:
    """The vectors of a result are vectors in space, which colours and pairs are not."""
    if output.entry["role"] == "scalars":
        return int(vtkDataSetAttributes.SCALARS)
    if fields.result_is_normals:
        return int(vtkDataSetAttributes.NORMALS)  # only these: ParaView shades with no vectors
    data = fields.data.values
    is_color = data is not None and output.entry["kind"] == "data" and data.GetDataType() == VTK_UNSIGNED_CHAR
    in_space = array.GetNumberOfComponents() == 3 and not is_color
    return int(vtkDataSetAttributes.VECTORS if in_space else vtkDataSetAttributes.SCALARS)


def _move(places: NDArray[np.float64], before: Any, after: Any) -> None:
    single = before.GetPoints().GetDataType() == VTK_FLOAT
    points = vtkPoints()
    points.SetData(make_array("Points", places.astype(np.float32 if single else np.float64)))
    after.SetPoints(points)
    update_normals(before, after)


@dataclass
class _Column:
    """The rows of an output of all blocks, one after the other."""

    values: list[NDArray[Any]]
    kind: str
    width: int
    rows: int

    def pad(self, rows: int) -> None:
        if rows > self.rows:
            self.values.append(np.full((rows - self.rows, self.width), np.nan))
            self.rows = rows

    def write(self, name: str) -> Any:
        values = np.vstack(self.values) if self.values else np.empty((0, self.width))
        with np.errstate(invalid="ignore"):
            typed = values.astype(_TYPES.get(self.kind, np.float64))
        return make_array(name, typed[:, 0] if self.width == 1 else typed)


def _join(blocks: list[list[Output]], place: str) -> tuple[dict[str, _Column], NDArray[np.int32]]:
    """The outputs of a place, in the order of their first appearance, and the block of each row. Where a
    block has no output of a name there is NaN."""
    columns: dict[str, _Column] = {}
    rows = 0
    owners: list[int] = []
    for number, outputs in enumerate(blocks):
        before = rows
        for output in outputs:
            if output.place != place or "corners" in output.entry:
                continue
            rows = before + len(output.values)
            width = output.values.shape[1]
            column = columns.setdefault(output.name, _Column([], output.entry["kind"], width, 0))
            column.pad(before)
            column.values.append(output.values.astype(np.float64))
            column.rows = rows
        owners += [number] * (rows - before)
        for column in columns.values():
            column.pad(rows)
    return columns, np.array(owners, dtype=np.int32)


def write_columns(blocks: list[list[Output]], table: Any) -> bool:
    """Fill a table with the columns among the outputs. False if there are none."""
    columns, owners = _join(blocks, "column")
    if not columns:
        return False
    table.AddColumn(make_array("Block", owners))
    for name, column in columns.items():
        table.AddColumn(column.write(name))
    return True


def write_history(history: dict[str, list[float]], table: Any) -> None:
    """Fill a table with a row per step."""
    count = len(history["Time"])
    table.AddColumn(make_array("Step", np.arange(count, dtype=np.int32)))
    names = [name for name in history if name not in ("Clamped", "ErrorBound")]
    for name in names + [name for name in ("ErrorBound", "Clamped") if name in history]:
        whole = name in ("Iterations", "Clamped")
        table.AddColumn(make_array(name, np.array(history[name], dtype=np.int32 if whole else np.float64)))


def write_curves(blocks: list[list[Output]], prefix: str, curves: Any) -> None:
    """Fill polydata with the curves among the outputs."""
    coordinates, connectivity, offsets = [np.empty((0, 3))], [], [0]
    first = 0
    for outputs in blocks:
        for output in outputs:
            if "corners" not in output.entry:
                continue
            corners = np.array(output.entry["corners"], dtype=np.int64)
            offsets += [offsets[-1] + end for end in output.entry["begin"][1:]]
            connectivity.append(first + corners)
            coordinates.append(output.values)
            first += len(output.values)
    points = vtkPoints()
    points.SetData(make_array("Points", np.vstack(coordinates)))
    lines = vtkCellArray()
    lines.SetData(
        make_array("", np.array(offsets, dtype=np.int64)),
        make_array("", np.concatenate(connectivity + [np.empty(0, dtype=np.int64)])))
    curves.SetPoints(points)
    curves.SetLines(lines)
    for name, column in _join(blocks, "curve points")[0].items():
        curves.GetPointData().AddArray(column.write(prefix + name))
    columns, owners = _join(blocks, "curves")
    for name, column in columns.items():
        curves.GetCellData().AddArray(column.write(name))
    curves.GetCellData().AddArray(make_array("Block", owners))
