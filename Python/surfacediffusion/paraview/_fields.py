# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The input arrays of the filters: how they are chosen, and what the numerics take."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import VTK_DOUBLE, VTK_FLOAT, vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkCellTypes, vtkDataObject, vtkDataSetAttributes, vtkPointSet

from .. import _core
from .._polydata import SurfaceError, hidden_points, places_of, say, to_numpy
from .._run import Given, make_core
from .._surface import data_components
from ._surfaces import BETWEEN, GIVEN_CELL, Block

#: What the array of an index is for the extension; 7 has terms of data in place of data.
BY_INDEX = ("data", "mask", "directions", "fixed", "rates", "fidelity", "seeds", "data", "speeds",
            "start_times", "slope_errors", "along_speeds", "across_speeds")
FLAGS = (1, 3)  #: the indices of arrays of flags, whose type has no meaning
POINTS, CELLS, POINTS_THEN_CELLS = 0, 1, vtkDataObject.FIELD_ASSOCIATION_POINTS_THEN_CELLS
ANY = 0  #: number of components
_LINES = (3, 4)  #: types of cells: line, polyline


@dataclass(frozen=True)
class Choice:
    """The array that SetInputArrayToProcess() chose: by its name, or as an active attribute."""

    association: int = POINTS
    name: str | None = None
    attribute: int | None = None

    @property
    def is_set(self) -> bool:
        return bool(self.name) or (self.name is None and self.attribute is not None)

    def find_in(self, attributes: Any) -> Any:
        if self.name:
            return attributes.GetAbstractArray(self.name)
        return attributes.GetAbstractAttribute(self.attribute or vtkDataSetAttributes.SCALARS)

    def locate(self, block: Any) -> tuple[Any, bool]:
        """The array, or None, and whether it is on cells."""
        found = None if self.association == CELLS else self.find_in(block.GetPointData())
        if found is not None or self.association == POINTS:
            return found, False
        return self.find_in(block.GetCellData()), True


@dataclass
class Array:
    """An array of a block; values: None if there is none."""

    values: Any = None
    on_cells: bool = False

    @property
    def name(self) -> str:
        return "" if self.values is None else self.values.GetName() or ""


@dataclass
class Fields:
    """The input arrays of a filter on one block, and the problems with them."""

    arrays: dict[str, Array] = field(default_factory=dict)  #: by what they are for the extension
    global_ids: Any = None
    data_are_terms: bool = False
    data_are_computed: bool = False  #: normals
    result_is_normals: bool = False
    alpha_is_data: bool = False
    samples: Any = None  #: places, values, weights and name of values that need not be at points of the surface
    sources: Any = None  #: places of points, ends of lines, and which points are hidden
    path_points: Any = None  #: the same, from which paths lead
    absent: dict[int, tuple[str, str]] = field(default_factory=dict)  #: index: label, problem
    problems: list[str] = field(default_factory=list)
    given: Any = None

    def __getitem__(self, kind: str) -> Array:
        return self.arrays.get(kind, Array())

    @property
    def data(self) -> Array:
        return self["data"]


def find_array(choice: Choice, index: int, name: str, components: int, block: Any, fields: Fields) -> Array:
    """The array that was chosen, if a block has it. Appends problems."""
    if not choice.is_set and index != 0:
        return Array()
    label = f'{name} "{choice.name}"' if choice.name else name
    if choice.association not in (POINTS, CELLS, POINTS_THEN_CELLS):
        fields.problems.append(say("Association", label, choice.association))
        return Array()
    found, on_cells = choice.locate(block)
    if not isinstance(found, vtkDataArray):
        problem = (_describe_absence(choice, label, block) if found is None else
                   say("Class", label, found.GetClassName()))
        fields.absent[index] = (label, problem)
        return Array()
    tuples = block.GetNumberOfCells() if on_cells else block.GetNumberOfPoints()
    size = found.GetNumberOfComponents()
    if found.GetNumberOfTuples() != tuples:
        fields.problems.append(say("Tuples", label, found.GetNumberOfTuples(), tuples,
                                   "cell" if on_cells else "point"))
        return Array()
    if size < 1 if components == ANY else size != components:
        if not choice.name:
            label += " is not set, and the active array" + (f' "{found.GetName()}"' if found.GetName() else "")
        fields.problems.append(say("Components", label, size, "1 or more" if components == ANY else components))
        return Array()
    return Array(found, on_cells)


def _describe_absence(choice: Choice, label: str, block: Any) -> str:
    on_points, on_cells = choice.association != CELLS, choice.association != POINTS
    if choice.name:
        others = block.GetCellData() if on_points else block.GetPointData()
        return _core.say_absent(label, "", on_points, on_cells, bool(others.HasArray(choice.name)))
    attribute = choice.attribute or vtkDataSetAttributes.SCALARS
    name = vtkDataSetAttributes.GetAttributeTypeAsString(attribute)
    return _core.say_absent(label, name, on_points, on_cells, False)


def find_disagreement(choices: dict[int, Choice], blocks: list[Block]) -> str:
    """The error if an array differs from piece to piece of a surface, otherwise empty."""
    known: dict[tuple[int, int], str] = {}
    for block in blocks:
        for index, choice in sorted(choices.items()):
            found, on_cells = choice.locate(block.input) if choice.is_set else (None, False)
            if not isinstance(found, vtkDataArray) or block.input.GetNumberOfPoints() == 0:
                continue
            text = _core.describe_array(
                found.GetName() or "", "" if index in FLAGS else found.GetDataTypeAsString(),
                found.GetNumberOfComponents(), on_cells)
            first = known.setdefault((block.surface, index), text)
            if first != text:
                return say("Unlike", first, text)
    return ""


def settle_absence(fields: list[Fields], names: list[str]) -> tuple[list[str], list[str]]:
    """Problems with arrays that no block has, and warnings about those that some do not have."""
    blocks: dict[int, list[str]] = {}
    texts: dict[int, tuple[str, str]] = {}
    for of_block, name in zip(fields, names):
        for index, text in of_block.absent.items():
            blocks.setdefault(index, []).append(name)
            texts.setdefault(index, text)
    problems, warnings = [], []
    for index in sorted(blocks):
        label, problem = texts[index]
        if len(blocks[index]) == len(fields):
            problems.append(problem)
        else:
            warnings.append(say("SomeBlocks", label, _core.list_blocks(blocks[index])))
    return problems, warnings


def read_fields(fields: Fields, block: Block) -> None:
    """What the numerics take. Raises SurfaceError on values that are not allowed."""
    given, count = block.input, block.input.GetNumberOfPoints()
    arrays = {kind: (_CONVERTERS.get(kind, _as_numbers)(found.values), found.on_cells, found.name)
              for kind, found in fields.arrays.items()}
    data, *place = arrays.get("data", (None,))
    if fields.alpha_is_data and data is not None:
        data = data.astype(np.float64)
        arrays["data"] = data, *place
    if given.GetPointData().HasArray(BETWEEN) and given.GetCellData().HasArray(GIVEN_CELL):
        arrays["between"] = to_numpy(given.GetPointData().GetArray(BETWEEN)), False, ""
        arrays["given_faces"] = _as_integers(given.GetCellData().GetArray(GIVEN_CELL)), True, ""
    if fields.global_ids is not None:
        ids = fields.global_ids
        if ids.GetNumberOfTuples() != count:
            raise SurfaceError(say("Tuples", f"the input's array \"{ids.GetName()}\"", ids.GetNumberOfTuples(),
                                   count, "point"))
        arrays["ids"] = _as_integers(ids), False, ""
    integers = data is not None and fields.data.values.GetDataType() not in (VTK_FLOAT, VTK_DOUBLE)
    core = make_core(block.core, arrays, fields.data_are_terms, block.name)
    fields.given = Given(core, data, integers, {"points": count, "faces": given.GetNumberOfCells()})
    if fields.samples is not None:
        core.set_samples(*fields.samples)
    if fields.sources is not None:
        core.set_sources(*fields.sources)
    if fields.path_points is not None:
        places, _, hidden = fields.path_points
        core.set_path_points(places, hidden)


def _as_data(array: Any) -> NDArray[Any] | None:
    if array is None:
        return None
    values = to_numpy(array)
    kept = values.dtype in (np.float32, np.float64, np.uint8)
    return np.ascontiguousarray(
        values.reshape(len(values), -1), dtype=values.dtype if kept else np.float64)


def _as_numbers(array: Any) -> NDArray[np.float64] | None:
    return None if array is None else np.ascontiguousarray(to_numpy(array), dtype=np.float64)


def _as_integers(array: Any) -> NDArray[np.int64]:
    return to_numpy(array).astype(np.int64)


def _as_flags(array: Any) -> NDArray[np.uint8] | None:
    return None if array is None else np.ascontiguousarray(to_numpy(array) != 0, dtype=np.uint8)


_CONVERTERS: dict[str, Callable[[Any], Any]] = {"data": _as_data, "mask": _as_flags, "fixed": _as_flags}


def read_samples(data: Any, value_name: str, weight_name: str) -> tuple[Any, list[str]]:
    """The values of the second input of an interpolation, and problems with it."""
    if not isinstance(data, vtkPointSet):
        return None, [say("NoPointSet", "the points with values are", data.GetClassName())]
    hidden = _hidden(data)
    if hidden.all():
        return None, [say("HiddenPoints" if len(hidden) else "NoPoints", "the second input, the points with values",
                          len(hidden), "")]
    problems: list[str] = []

    def find(name: str, label: str) -> Any:
        attributes = data.GetPointData()
        found = attributes.GetAbstractArray(name) if name else attributes.GetScalars()
        label = f'{label} "{name}"' if name else label
        if found is None:
            problems.append(say("NotAmongPoints" if name else "NoScalarsOfPoints", label))
        elif not isinstance(found, vtkDataArray):
            problems.append(say("Class", label, found.GetClassName()))
        else:
            return found
        return None

    values = find(value_name, "PointValueArray")
    weights = find(weight_name, "PointWeightArray") if weight_name else None
    if weights is not None and weights.GetNumberOfComponents() != 1:
        problems.append(say("Components", "PointWeightArray", weights.GetNumberOfComponents(), 1))
    if problems:
        return None, problems
    given: Any = _as_data(values)
    given = np.array(given[:, :data_components(given)], dtype=np.float64, order="C")
    places, factors = places_of(data), _as_numbers(weights)
    if hidden.any():  # hidden points have no value
        places[hidden], given[hidden] = 0.0, np.nan
        factors = None if factors is None else np.where(hidden, 0.0, factors)
    return (places, given, factors, values.GetName() or ""), []


def read_sources(data: Any, name: str) -> tuple[Any, list[str]]:
    """The points and lines of an input of distances, and problems with it."""
    if not isinstance(data, vtkPointSet):
        return None, [say("NoPointSet", name + ", is", data.GetClassName())]
    hidden = _hidden(data)
    of_points = hidden.copy()
    flags = data.GetCellGhostArray()
    has_flags = flags is not None and flags.GetNumberOfTuples() == data.GetNumberOfCells()
    segments: list[int] = []
    kinds = vtkCellTypes()
    data.GetCellTypes(kinds)
    if any(kinds.IsType(kind) for kind in _LINES):
        for cell in range(data.GetNumberOfCells()):
            if data.GetCellType(cell) in _LINES:
                ids = data.GetCell(cell).GetPointIds()
                corners = [ids.GetId(k) for k in range(ids.GetNumberOfIds())]
                if of_points[corners].any() or (
                        has_flags and flags.GetValue(cell) & vtkDataSetAttributes.HIDDENCELL):
                    hidden[corners] = True
                else:
                    segments += [end for pair in zip(corners, corners[1:]) for end in pair]
    hidden[segments] = False  # also of a hidden line
    if hidden.all():
        return None, [say("HiddenPoints" if len(hidden) else "NoPoints", name, len(hidden), " points or lines")]
    return (places_of(data), np.array(segments, dtype=np.int64), hidden.astype(np.uint8)), []


def _hidden(data: Any) -> NDArray[np.bool_]:
    """Which points are hidden."""
    flags = hidden_points(data)
    return np.zeros(data.GetNumberOfPoints(), dtype=bool) if flags is None else flags != 0
