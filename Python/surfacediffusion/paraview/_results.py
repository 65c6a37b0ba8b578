# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The outputs of the filters: arrays, moved points, tables and curves. The rules are those of the classes
in C++, Filters/Conversion/ResultWriter.cxx."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

from .._models import Output
from .._polydata import attribute_of, copy_component_names, make_array, move_points, name_of
from ._fields import Fields
from ._surfaces import Block


def write_outputs(
    outputs: list[Output], fields: Fields, data: Any, block: Block, prefix: str,
) -> list[str]:
    """Add arrays to the output of a block, and move its points. Return the names of other arrays of the
    input that were replaced. data: the array that gives results their name and that a result of this name
    replaces, or None. prefix: ResultArrayName."""
    before = vtkPolyData()
    before.ShallowCopy(block.output)
    replaced = []
    given = fields.data.values
    data_name = "" if data is None else data.GetName() or ""
    for output in outputs:
        if output.place not in ("points", "faces") or output.entry["columns"] == 0:
            continue
        if output.role == "coordinates":
            move_points(output.rows, before, block.output)
            continue
        name = name_of(output, data_name or output.entry["data_name"], prefix)
        array = make_array(name, output.rows)
        if output.kind == "data" and given is not None:
            copy_component_names(given, array)
        on_cells = output.place == "faces"
        attributes = block.output.GetCellData() if on_cells else block.output.GetPointData()
        former = attributes.GetAbstractArray(name)
        if former is not None:
            if former is not (data if name == prefix else None):
                replaced.append(name)
            attributes.RemoveArray(name)
        attributes.AddArray(array)
        if on_cells and output.is_result:
            block.cell_result = name
        if output.role:
            of_bytes = given is not None and given.GetDataType() == VTK_UNSIGNED_CHAR
            attributes.SetActiveAttribute(name, attribute_of(output, fields.result_is_normals, of_bytes))
    return replaced


def _join(blocks: list[list[Output]], place: str) -> tuple[dict[str, NDArray[Any]], NDArray[np.int32]]:
    """The outputs of a place, in the order of their first appearance, and the block of each row. Where a
    block has no output of a name there is NaN."""
    found = [[output for output in outputs if output.place == place and "corners" not in output.entry]
             for outputs in blocks]
    owners = np.repeat(np.arange(len(blocks), dtype=np.int32),
                       [max((len(output.rows) for output in outputs), default=0) for outputs in found])
    columns: dict[str, NDArray[Any]] = {}
    types: dict[str, Any] = {}
    for number, outputs in enumerate(found):
        begin = np.searchsorted(owners, number)
        for output in outputs:
            types.setdefault(output.name, {"integer": np.int32, "byte": np.uint8}.get(output.kind, np.float64))
            column = columns.setdefault(output.name, np.full((len(owners), output.rows.shape[1]), np.nan))
            column[begin:begin + len(output.rows)] = output.rows
    with np.errstate(invalid="ignore"):
        return {name: column.astype(types[name]) for name, column in columns.items()}, owners


def write_columns(blocks: list[list[Output]], table: Any) -> bool:
    """Fill a table with the columns among the outputs. False if there are none."""
    columns, owners = _join(blocks, "column")
    if not columns:
        return False
    table.AddColumn(make_array("Block", owners))
    for name, column in columns.items():
        table.AddColumn(make_array(name, column))
    return True


def write_history(history: dict[str, list[float]], table: Any) -> None:
    """Fill a table with a row per step."""
    count = len(history["Time"])
    table.AddColumn(make_array("Step", np.arange(count, dtype=np.int32)))
    for name in sorted(history, key=lambda name: {"ErrorBound": 1, "Clamped": 2}.get(name, 0)):
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
            coordinates.append(output.rows)
            first += len(output.rows)
    points = vtkPoints()
    points.SetData(make_array("Points", np.vstack(coordinates)))
    lines = vtkCellArray()
    lines.SetData(
        make_array("", np.array(offsets, dtype=np.int64)),
        make_array("", np.concatenate(connectivity + [np.empty(0, dtype=np.int64)])))
    curves.SetPoints(points)
    curves.SetLines(lines)
    for name, column in _join(blocks, "curve points")[0].items():
        curves.GetPointData().AddArray(make_array(prefix + name, column))
    columns, owners = _join(blocks, "curves")
    for name, column in columns.items():
        curves.GetCellData().AddArray(make_array(name, column))
    curves.GetCellData().AddArray(make_array("Block", owners))
