# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The filters: how runs with and without time steps are computed, and what filters do that their proxies
do not say."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSetAttributes, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkDemandDrivenPipeline, vtkStreamingDemandDrivenPipeline

from .. import _core
from .._models import Output, find_outputs, read_outputs
from .._polydata import HIDDEN_CELL, cell_flags, compute_point_normals, make_array, say, to_numpy, turn_polygons
from ._algorithm import SurfaceFilter, list_settings
from ._fields import (
    CELLS, POINTS, POINTS_THEN_CELLS, Array, Choice, Fields, read_samples, read_sources, settle_absence,
)
from ._pieces import Stitched
from ._results import write_columns, write_curves, write_history
from ._surfaces import Block

_SCALARS = Choice(POINTS_THEN_CELLS, None, vtkDataSetAttributes.SCALARS)
_TIME = vtkStreamingDemandDrivenPipeline


class RunFilter(SurfaceFilter):
    """A filter without time steps."""

    RUN = _core.SurfaceRuns
    OUTPUTS = ("vtkDataObject", "vtkPolyData")

    def _find_all(self, blocks: list[Block], problems: list[str]) -> list[tuple[Block, Fields]]:
        if self.RESULT_NAME and not self.own["ResultArrayName"]:
            problems.append(say("NoName"))
        found, everything, sentences = [], [], []
        for block in blocks:
            fields = Fields()
            takes_part = self.find_fields(block, fields)
            sentences += [(text, block.name) for text in fields.problems]
            everything.append(fields)
            if takes_part:
                found.append((block, fields))
        problems += _core.join_sentences(sentences, len(blocks))
        absent, warnings = settle_absence(everything, [block.name for block in blocks])
        problems += absent
        self._warnings += warnings
        # An array that is not found would be reported as not set, too.
        if not absent and not sentences:
            self.check(found, problems)
        return found

    def read_outputs(self, number: int, block: Block, fields: Fields) -> list[Output]:
        turned = self._run.turned_triangles(number)
        if turned.size:
            turn_polygons(block.output, block.cells[turned])
        write = functools.partial(self._run.write, number)
        return read_outputs(self._run.outputs(number), write, fields.given, np.float64)


class ModelFilter(SurfaceFilter):
    """A filter of a model of arrays, which may have time steps."""

    RUN = _core.ModelRun
    NAMED_AFTER = "data"
    DEFAULT_CHOICE = _SCALARS

    def __init__(self) -> None:
        SurfaceFilter.__init__(self)
        self._length: tuple[Any, int] | None = None  # settings and last step of a run that ended early

    def _find_all(self, blocks: list[Block], problems: list[str]) -> list[tuple[Block, Fields]]:
        """Blocks without data pass through if at least one block has data."""
        precision = self.own["OutputPrecision"]
        if precision not in (0, 1, 2):
            problems.append(f"OutputPrecision is {precision}; allowed: 0 Single, 1 Double, 2 Input")
        found, without = [], []
        for block in blocks:
            fields = Fields()
            if self.find_fields(block, fields):
                fields.global_ids = block.input.GetPointData().GetGlobalIds()
                found.append((block, fields))
                continue
            texts = fields.problems + [problem for _, problem in fields.absent.values()]
            without += [(text, block.name) for text in texts]
        sentences = _core.join_sentences(without, len(blocks))
        if not found:
            problems += sentences
            return []
        self._warnings += [say("BlockPasses", text) for text in sentences]
        absent, warnings = settle_absence(
            [fields for _, fields in found], [block.name for block, _ in found])
        problems += absent
        self._warnings += warnings
        for block, fields in found:
            if 2 in fields.absent:  # where there is no direction, diffusion is isotropic
                fields.arrays["directions"] = Array(make_array("", np.zeros((block.input.GetNumberOfPoints(), 3))))
        of_blocks = [(text, block.name) for block, fields in found for text in fields.problems]
        problems += _core.join_sentences(of_blocks, len(found))
        if not absent:
            self.check([pair for pair in found if not pair[1].problems], problems)
        return found

    def seek(self, request: Any, outputs: Any) -> None:
        self._run.seek(self._choose_step(request, outputs), self.progress)

    def read_outputs(self, number: int, block: Block, fields: Fields) -> list[Output]:
        dtype = (np.float32, np.float64, None)[self.own["OutputPrecision"]]
        return find_outputs(self._run, number, fields.given, dtype)

    def write_tables(self, blocks: list[Block], results: list[list[Output]], made: list[Any]) -> list[str]:
        if not write_columns(results, made[1]):
            write_history(self._run.history(), made[1])
        if len(made) > 2:
            write_curves(results, self.own["ResultArrayName"], made[2])
        return self._write_weights(blocks, results)

    def complete_pieces(self, surface: Stitched) -> None:
        """Vertices, lines and hidden cells keep their value, as those of a surface in one piece do."""
        name = surface.block.cell_result
        for piece in surface.pieces if name else []:
            fields = Fields()
            self.find_fields(piece.block, fields)
            result = piece.block.output.GetCellData().GetArray(name)
            if not fields.data.on_cells or result is None or result is fields.data.values:
                continue
            flags = cell_flags(piece.block.input, of_piece=True)
            keeps = np.arange(result.GetNumberOfTuples()) < piece.cells.first
            if flags is not None:
                keeps |= (flags & HIDDEN_CELL) != 0
            to_numpy(result)[keeps] = to_numpy(fields.data.values)[keeps]

    def _write_weights(self, blocks: list[Block], results: list[list[Output]]) -> list[str]:
        """If blocks have different weights, which AutomaticFidelity finds, each has its own as field data."""
        weights = [next((float(output.rows[0, 0]) for output in outputs if output.place == "number"
                         and output.name == "EffectiveFidelityWeight"), 0.0) for outputs in results]
        name = self.own["ResultArrayName"] + "EffectiveFidelityWeight"
        replaced = []
        if any(weight != weights[0] for weight in weights):
            for block, weight in zip(blocks, weights):
                data = block.output.GetFieldData()
                replaced += [name] if data.HasArray(name) else []
                data.AddArray(make_array(name, np.array([weight])))
        return replaced

    # Time --------------------------------------------------------------------------------------

    def _key(self) -> Any:
        """The settings that the length of a run depends on."""
        entries = list_settings(self.MODEL)
        return {name: value for name, value in self.settings.items() if not entries[name]["is_of_output"]}

    def _last_step(self) -> int:
        """Of a run with these settings, if it is known; otherwise -1, all steps."""
        return self._length[1] if self._length is not None and self._length[0] == self._key() else -1

    def _publish(self, outputs: Any) -> bool:
        found = _core.find_times(self.MODEL, self.settings, self._last_step())
        if found is None:
            return False
        for port in range(outputs.GetNumberOfInformationObjects()):
            info, times = outputs.GetInformationObject(port), found["times"]
            info.Set(_TIME.TIME_STEPS(), times, len(times))
            info.Set(_TIME.TIME_RANGE(), [times[0], times[-1]], 2)
        return True

    def RequestInformation(self, request: Any, inputs: Any, outputs: Any) -> int:
        self._publish(outputs)
        return 1

    def RequestUpdateExtent(self, request: Any, inputs: Any, outputs: Any) -> int:
        if inputs[0].GetNumberOfInformationObjects() == 0 or not _core.find_times(self.MODEL, self.settings):
            return 1
        info = inputs[0].GetInformationObject(0)
        times = self._times_of(info)
        if times:
            info.Set(_TIME.UPDATE_TIME_STEP(), times[0])
        else:
            info.Remove(_TIME.UPDATE_TIME_STEP())
        return 1

    @staticmethod
    def _times_of(info: Any) -> list[float]:
        """The times of the input, or the first and the last one."""
        key = _TIME.TIME_STEPS()
        if not (info.Has(key) and info.Length(key) > 0):
            key = _TIME.TIME_RANGE()
        return list(info.Get(key)) if info.Has(key) else []

    def begin(self, inputs: Any) -> None:
        SurfaceFilter.begin(self, inputs)
        times = self._times_of(inputs[0].GetInformationObject(0))
        if times and times[0] != times[-1] and _core.find_times(self.MODEL, self.settings):
            self._warnings.append(say("Times", times[0], times[-1], times[0]))

    def _choose_step(self, request: Any, outputs: Any) -> int:
        """The step of the requested time; without one, the last."""
        found = _core.find_times(self.MODEL, self.settings, self._last_step())
        if found is None:
            return -1
        last = self._run.find_last_step(self.progress)
        if last != (self._last_step() if self._last_step() >= 0 else found["number_of_steps"]):
            self._length = (self._key(), last)
            self._publish(outputs)
            self.Modified()  # filters downstream, which have not seen these times
        port = request.Get(vtkDemandDrivenPipeline.FROM_OUTPUT_PORT()) if request.Has(
            vtkDemandDrivenPipeline.FROM_OUTPUT_PORT()) else 0
        info = outputs.GetInformationObject(max(0, port))
        step = last
        if info.Has(_TIME.UPDATE_TIME_STEP()):
            step = _core.find_step(self.MODEL, self.settings, info.Get(_TIME.UPDATE_TIME_STEP()), last)
        for each in range(outputs.GetNumberOfInformationObjects()):
            output = outputs.GetInformationObject(each).Get(vtkDataObject.DATA_OBJECT())
            output.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), step * found["time_step"])
        return int(step)


class HarmonicMap(ModelFilter):
    DEFAULT_CHOICE = Choice(POINTS, None, vtkDataSetAttributes.NORMALS)

    def find_fields(self, block: Block, fields: Fields) -> bool:
        """If no other array is chosen, a block is read as if it had normals in any case."""
        choice, given = self.choices[0], block.input
        with_normals = vtkPolyData()
        with_normals.ShallowCopy(given)
        by_other = choice.name is None and choice.attribute not in (None, vtkDataSetAttributes.NORMALS)
        if not choice.name and not by_other and choice.association != CELLS:
            normals = given.GetPointData().GetNormals()
            fields.data_are_computed = normals is None
            if normals is None:
                normals = compute_point_normals(given)
            with_normals.GetPointData().SetNormals(normals)
            with_normals.GetPointData().SetScalars(normals)  # an empty name means these
        if not ModelFilter.find_fields(self, Block(with_normals, None), fields):
            return False
        data = fields.data.values
        is_normals = fields.data_are_computed or data is given.GetPointData().GetNormals() or (
            data is given.GetCellData().GetNormals())
        fields.result_is_normals = bool(self.own["UseAsNormals"]) and is_normals
        if self.settings.get("MoveVertices") and not is_normals:
            fields.problems.append(say("NoNormals", fields.data.name))
        return True


class Texture(ModelFilter):
    DEFAULT_CHOICE = Choice(POINTS, "")
    MAY_REFINE_AUTOMATICALLY = True

    def __init__(self) -> None:
        ModelFilter.__init__(self)
        self.own["RefineTo"] = -1.0

    def find_number(self, name: str) -> Any:
        if name == "EffectiveTimeStep":
            return _core.find_time_step(self.MODEL, self.settings)
        return ModelFilter.find_number(self, name)

    def find_refinement(self, mean: float) -> tuple[float, str]:
        if self.own["RefineTo"] != -1.0:
            return ModelFilter.find_refinement(self, mean)
        size = self.settings.get("FeatureSize", 0.0)
        length = _core.edge_length_for_features(size, mean)
        return length, say("Features", float(size), size / mean) if length > 0.0 else ""

    def find_fields(self, block: Block, fields: Fields) -> bool:
        self.find_arrays(block, fields, range(0 if self.choices[0].is_set else 1, 5))
        if fields["rates"].values is not None and not fields["rates"].on_cells:
            fields.problems.append(say("PointRates"))
        return True  # an initial state is optional


class Segmentation(ModelFilter):
    def __init__(self) -> None:
        ModelFilter.__init__(self)
        self._means: dict[tuple[int, int], float] = {}

    def AddMean(self, region: float, component: float, value: float) -> None:
        self._means[int(region), int(component)] = float(value)
        self._pass_means()

    def RemoveAllMeans(self) -> None:
        self._means.clear()
        self._pass_means()

    def _pass_means(self) -> None:
        self.settings["Means"] = [value for _, value in sorted(self._means.items())]
        self.Modified()

    def find_fields(self, block: Block, fields: Fields) -> bool:
        self.find_arrays(block, fields, [7])
        fields.data_are_terms = fields.data.values is not None
        has_terms = fields.data_are_terms or fields.problems or fields.absent
        self.find_arrays(block, fields, [1, 5, 6] if has_terms else [0, 1, 5, 6])
        data = fields.data.values
        if data is not None and not fields.data_are_terms and not self.settings.get("AutomaticMeans", True):
            self._check_means(data, fields.problems)
        return data is not None

    def _check_means(self, data: Any, problems: list[str]) -> None:
        regions = self.settings.get("NumberOfRegions", 2)
        components = data.GetNumberOfComponents()
        components -= data.GetDataType() == VTK_UNSIGNED_CHAR and components in (2, 4)  # alpha
        for region, component in sorted(self._means):
            if not 1 <= region <= regions:
                problems.append(say("Region", region, regions))
            if not 0 <= component < components:
                problems.append(say("Component", component, components - 1))


class Interpolation(ModelFilter):
    POINT_INPUTS = 1

    def AddMissingValue(self, value: float) -> None:
        self._pass_missing([*self.settings.get("MissingValue", []), float(value)])

    def RemoveAllMissingValues(self) -> None:
        self._pass_missing([])

    def _pass_missing(self, numbers: list[float]) -> None:
        self.settings["MissingValue"] = numbers
        self.Modified()

    def read_points(self, data: Any) -> tuple[Any, list[str]]:
        return read_samples(data, self.own["PointValueArray"], self.own["PointWeightArray"])

    def find_fields(self, block: Block, fields: Fields) -> bool:
        fields.samples = self.points
        fields.problems += self.problems_of_points
        self.find_arrays(block, fields, [1, 2] if self.has_points else [0, 5, 1, 2])
        return fields.data.values is not None or fields.samples is not None


class Derivatives(RunFilter):
    DEFAULT_CHOICE = _SCALARS
    NAMED_AFTER = "data"

    def find_fields(self, block: Block, fields: Fields) -> bool:
        fields.alpha_is_data = True
        return RunFilter.find_fields(self, block, fields)


class DirectionField(RunFilter):
    NAMED_AFTER = "directions"
    _HINTS = 3  #: of Method

    def find_fields(self, block: Block, fields: Fields) -> bool:
        if self.settings.get("Method", 0) == self._HINTS:
            self.find_arrays(block, fields, [2])
        return True  # without hints, which is an error if they are needed


class Distance(RunFilter):
    POINT_INPUTS = 2
    ROLES = {**RunFilter.ROLES, 0: _core.PointRole.Mark}

    def begin(self, inputs: Any) -> None:
        RunFilter.begin(self, inputs)
        data = self._find_input(inputs, 2)
        nothing: tuple[Any, list[str]] = (None, [])
        self.path_points, problems = nothing if data is None else read_sources(
            data, "the third input, the path points")
        self.problems_of_points = self.problems_of_points + problems

    def read_points(self, data: Any) -> tuple[Any, list[str]]:
        return read_sources(data, "the second input, the sources")

    def write_tables(self, blocks: list[Block], results: list[list[Output]], made: list[Any]) -> list[str]:
        if self.path_points is not None:
            write_curves(results, self.own["ResultArrayName"], made[1])
        return []

    def find_fields(self, block: Block, fields: Fields) -> bool:
        fields.problems += self.problems_of_points
        fields.sources, fields.path_points = self.points, self.path_points
        self.find_arrays(block, fields, [1, 2, 8, 11, 12] if self.has_points else [0, 9, 1, 2, 8, 11, 12])
        for array, name in ((fields.data, "SourceArray"), (fields["start_times"], "SourceTimes")):
            if array.on_cells:
                fields.problems.append(say("CellArray", name))
        return fields.data.values is not None or fields.sources is not None


class RandomField(RunFilter):
    def find_fields(self, block: Block, fields: Fields) -> bool:
        fields.global_ids = block.input.GetPointData().GetGlobalIds()
        return RunFilter.find_fields(self, block, fields)


class Relief(RunFilter):
    DEFAULT_CHOICE = Choice(POINTS, "Texture")
    NAMED_AFTER = "data"

    def find_fields(self, block: Block, fields: Fields) -> bool:
        found = RunFilter.find_fields(self, block, fields)
        if fields.data.on_cells:
            fields.problems.append(say("CellArray", "InputArray"))
        return found


#: The classes of proxies that need more than RunFilter or ModelFilter.
CLASSES: dict[str, type[SurfaceFilter]] = {
    "HarmonicMapFilter": HarmonicMap, "SurfaceDerivativesFilter": Derivatives,
    "SurfaceDirectionFieldFilter": DirectionField, "SurfaceDistanceFilter": Distance,
    "SurfaceInterpolationFilter": Interpolation, "SurfaceRandomFieldFilter": RandomField,
    "SurfaceReliefFilter": Relief, "SurfaceSegmentationFilter": Segmentation,
    "TuringTextureFilter": Texture,
}
