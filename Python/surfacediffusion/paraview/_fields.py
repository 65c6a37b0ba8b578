# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The input arrays of the filters: how they are chosen, and what the numerics take."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import VTK_DOUBLE, VTK_FLOAT, vtkDataArray
from vtkmodules.vtkCommonDataModel import vtkCellTypes, vtkDataObject, vtkDataSetAttributes, vtkPointSet

from .._polydata import SurfaceError, hidden_points, places_of, to_numpy
from .._run import Given, make_core
from .._surface import data_components
from ._surfaces import BETWEEN, GIVEN_CELL, Block

#: The attribute of Fields that has the array of an index; 7 has terms of data in place of data.
BY_INDEX = ("data", "mask", "direction", "fixed", "rates", "fidelity", "seeds", "data", "speeds",
            "start_times")
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


@dataclass
class Fields:
    """The input arrays of a filter on one block, and the problems with them."""

    data: Array = field(default_factory=Array)
    mask: Array = field(default_factory=Array)
    direction: Array = field(default_factory=Array)
    fixed: Array = field(default_factory=Array)
    rates: Array = field(default_factory=Array)
    fidelity: Array = field(default_factory=Array)
    seeds: Array = field(default_factory=Array)
    speeds: Array = field(default_factory=Array)
    start_times: Array = field(default_factory=Array)
    global_ids: Any = None
    data_are_terms: bool = False
    data_are_computed: bool = False  #: normals
    result_is_normals: bool = False
    alpha_is_data: bool = False
    samples: Any = None  #: places, values, weights and name of values that need not be at points of the surface
    sources: Any = None  #: places of points, ends of lines, and which points are hidden
    absent: dict[int, tuple[str, str]] = field(default_factory=dict)  #: index: label, problem
    problems: list[str] = field(default_factory=list)
    given: Any = None

    def name(self, attribute: str = "data") -> str:
        array = getattr(self, attribute).values
        return "" if array is None else array.GetName() or ""


def find_array(choice: Choice, index: int, name: str, components: int, block: Any, fields: Fields) -> Array:
    """The array that was chosen, if a block has it. Appends problems."""
    if not choice.is_set and index != 0:
        return Array()
    label = f'{name} "{choice.name}"' if choice.name else name
    if choice.association not in (POINTS, CELLS, POINTS_THEN_CELLS):
        fields.problems.append(
            f"{label} has association {choice.association}; allowed: points (0) or cells (1)")
        return Array()
    found, on_cells = choice.locate(block)
    if not isinstance(found, vtkDataArray):
        problem = (_describe_absence(choice, block) if found is None else
                   f"is a {found.GetClassName()}; allowed: numeric arrays")
        fields.absent[index] = (label, f"{label} {problem}")
        return Array()
    tuples = block.GetNumberOfCells() if on_cells else block.GetNumberOfPoints()
    size = found.GetNumberOfComponents()
    if found.GetNumberOfTuples() != tuples:
        fields.problems.append(f"{label} has {found.GetNumberOfTuples()} tuples; allowed: {tuples}, one per "
                               + ("cell" if on_cells else "point"))
        return Array()
    if size < 1 if components == ANY else size != components:
        unset = "" if choice.name else "is not set, and the active array " + (
            f'"{found.GetName()}" ' if found.GetName() else "")
        fields.problems.append(f"{label} {unset}has {size} components; allowed: "
                               + ("1 or more" if components == ANY else str(components)))
        return Array()
    return Array(found, on_cells)


def _describe_absence(choice: Choice, block: Any) -> str:
    on_points, on_cells = choice.association != CELLS, choice.association != POINTS
    kind = "point or cell" if on_points and on_cells else "cell" if on_cells else "point"
    if not choice.name:
        attribute = vtkDataSetAttributes.GetAttributeTypeAsString(
            choice.attribute or vtkDataSetAttributes.SCALARS)
        return (f"is not set and the input has no active {kind} {attribute}; choose a {kind} array")
    text = f"is not among the {kind} arrays of the input; choose one of them"
    if not on_cells and block.GetCellData().HasArray(choice.name):
        return text + ", or association 1 for the cell array of this name"
    if not on_points and block.GetPointData().HasArray(choice.name):
        return text + ", or association 0 for the point array of this name"
    return text


def find_disagreement(choices: dict[int, Choice], blocks: list[Block]) -> str:
    """The error if an array differs from piece to piece of a surface, otherwise empty."""
    known: dict[tuple[int, int], str] = {}
    for block in blocks:
        for index, choice in sorted(choices.items()):
            found, on_cells = choice.locate(block.input) if choice.is_set else (None, False)
            if not isinstance(found, vtkDataArray) or block.input.GetNumberOfPoints() == 0:
                continue
            size = found.GetNumberOfComponents()
            kind = "" if index in FLAGS else f"{found.GetDataTypeAsString()}, "
            text = (f'"{found.GetName() or ""}" ({kind}{size} '
                    f'component{"" if size == 1 else "s"}, on {"cells" if on_cells else "points"})')
            first = known.setdefault((block.surface, index), text)
            if first != text:
                return (f"the pieces of the input have different arrays, {first} and {text}; allowed: one "
                        "name, type, number of components and place in all pieces")
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
            warnings.append(f"{label} counts as not set on {list_blocks(blocks[index])}, without such a "
                            "numeric array")
    return problems, warnings


def list_blocks(names: list[str]) -> str:
    """Data of thousands of blocks would make messages of thousands of names."""
    text = ("block " if len(names) == 1 else "blocks ") + ", ".join(names[:8])
    return text if len(names) <= 8 else f"{text} and {len(names) - 8} more"


def join_sentences(found: list[tuple[str, str]], blocks: int) -> list[str]:
    """Sentences about blocks, each once with the names of its blocks, unless it is about all of them.
    found: pairs of sentence and block."""
    names: dict[str, list[str]] = {}
    for sentence, name in found:
        known = names.setdefault(sentence, [])
        if not known or known[-1] != name:
            known.append(name)
    return [sentence if len(known) == blocks or not known[0] else f"{list_blocks(known)}: {sentence}"
            for sentence, known in names.items()]


def read_fields(fields: Fields, block: Block) -> None:
    """What the numerics take. Raises SurfaceError on values that are not allowed."""
    arrays = {name: (convert(found.values), found.on_cells) for name, convert, found in (
        ("data", _as_data, fields.data), ("mask", _as_flags, fields.mask), ("fixed", _as_flags, fields.fixed),
        ("directions", _as_numbers, fields.direction), ("fidelity", _as_numbers, fields.fidelity),
        ("seeds", _as_numbers, fields.seeds))}
    arrays["rates"] = _as_numbers(fields.rates.values), False
    data, on_cells = arrays["data"]
    if fields.alpha_is_data and data is not None:
        data = data.astype(np.float64)
        arrays["data"] = data, on_cells
    integers = data is not None and fields.data.values.GetDataType() not in (VTK_FLOAT, VTK_DOUBLE)
    fields.given = Given(make_core(block.core, arrays, fields.data_are_terms), data, integers, {
        "points": block.input.GetNumberOfPoints(), "faces": block.input.GetNumberOfCells()})
    core = fields.given.core
    core.set_names(fields.name(), block.name, fields.name("direction"), fields.name("seeds"))
    if fields.samples is not None:
        core.set_samples(*fields.samples)
    if fields.sources is not None:
        core.set_sources(*fields.sources)
    speeds, times = _as_numbers(fields.speeds.values), _as_numbers(fields.start_times.values)
    if speeds is not None:
        core.set_speeds(speeds, fields.speeds.on_cells)
    if times is not None:
        core.set_start_times(times)
    between = block.input.GetPointData().GetArray(BETWEEN)
    given = block.input.GetCellData().GetArray(GIVEN_CELL)
    if between is not None and given is not None:
        core.set_measured(to_numpy(between), to_numpy(given).astype(np.int64))
    if fields.global_ids is not None:
        ids, count = fields.global_ids, block.input.GetNumberOfPoints()
        if ids.GetNumberOfTuples() != count:
            raise SurfaceError(f"the input's array \"{ids.GetName()}\" has {ids.GetNumberOfTuples()} "
                               f"tuples; allowed: {count}, one per point")
        core.set_ids(to_numpy(ids).astype(np.int64))


def _as_data(array: Any) -> NDArray[Any] | None:
    if array is None:
        return None
    values = to_numpy(array)
    kept = values.dtype in (np.float32, np.float64, np.uint8)
    return np.ascontiguousarray(
        values.reshape(len(values), -1), dtype=values.dtype if kept else np.float64)


def _as_numbers(array: Any) -> NDArray[np.float64] | None:
    return None if array is None else np.ascontiguousarray(to_numpy(array), dtype=np.float64)


def _as_flags(array: Any) -> NDArray[np.uint8] | None:
    return None if array is None else np.ascontiguousarray(to_numpy(array) != 0, dtype=np.uint8)


_POINT_SET = ("; allowed: a vtkPointSet, such as vtkPolyData (for a table, apply Table To Points, which is "
              "vtkTableToPolyData)")


def read_samples(data: Any, value_name: str, weight_name: str) -> tuple[Any, list[str]]:
    """The values of the second input of an interpolation, and problems with it."""
    if not isinstance(data, vtkPointSet):
        return None, [f"the points with values are a {data.GetClassName()}" + _POINT_SET]
    hidden = _hidden(data)
    if hidden.all():
        return None, ["the second input, the points with values, has " + (
            f"{len(hidden)} hidden points; allowed: 1 or more that are not hidden" if len(hidden) else
            "0 points; allowed: 1 or more")]
    problems: list[str] = []

    def find(name: str, label: str) -> Any:
        attributes = data.GetPointData()
        found = attributes.GetAbstractArray(name) if name else attributes.GetScalars()
        label = f'{label} "{name}"' if name else label
        if found is None:
            problems.append(label + (
                " is not among the point arrays of the points with values; choose one of them" if name else
                " is not set and the points with values have no active scalars; choose an array"))
        elif not isinstance(found, vtkDataArray):
            problems.append(f"{label} is a {found.GetClassName()}; allowed: numeric arrays")
        else:
            return found
        return None

    values = find(value_name, "PointValueArray")
    weights = find(weight_name, "PointWeightArray") if weight_name else None
    if weights is not None and weights.GetNumberOfComponents() != 1:
        problems.append(f"PointWeightArray has {weights.GetNumberOfComponents()} components; allowed: 1")
    if problems:
        return None, problems
    given: Any = _as_data(values)
    given = np.array(given[:, :data_components(given)], dtype=np.float64, order="C")
    places, factors = places_of(data), _as_numbers(weights)
    if hidden.any():  # hidden points have no value
        places[hidden], given[hidden] = 0.0, np.nan
        factors = None if factors is None else np.where(hidden, 0.0, factors)
    return (places, given, factors, values.GetName() or ""), []


def read_sources(data: Any) -> tuple[Any, list[str]]:
    """The points and lines of the second input of distances, and problems with it."""
    if not isinstance(data, vtkPointSet):
        return None, [f"the second input, the sources, is a {data.GetClassName()}" + _POINT_SET]
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
        return None, ["the second input, the sources, has " + (
            f"{len(hidden)} hidden points; allowed: 1 or more points or lines that are not hidden"
            if len(hidden) else "0 points; allowed: 1 or more points or lines")]
    return (places_of(data), np.array(segments, dtype=np.int64), hidden.astype(np.uint8)), []


def _hidden(data: Any) -> NDArray[np.bool_]:
    """Which points are hidden."""
    flags = hidden_points(data)
    return np.zeros(data.GetNumberOfPoints(), dtype=bool) if flags is None else flags != 0
