# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The update of all filters: from a request of the pipeline to the outputs, with progress, aborts, errors
and warnings. It is the update of vtkSurfaceFilter, in one process."""

from __future__ import annotations

import functools
from typing import Any, Callable, Iterable

from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkCommand, vtkOutputWindow
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSetAttributes, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkParallelCore import vtkMultiProcessController

from .. import _core
from .._models import Output
from .._polydata import ABSENT, SurfaceError, cell_flags, say, spell
from .._refinement import mean_edge_length
from ._fields import BY_INDEX, FLAGS, Choice, Fields, find_array, find_disagreement, read_fields
from ._pieces import Stitched, scatter_results, stitch_pieces
from ._refinement import Refinement
from ._results import write_outputs
from ._surfaces import Block, Parts, Shapes, copy_structure, hash_arrays

#: Properties that are no settings of the extension, with their defaults.
_OWN: dict[str, Any] = {
    "RefineTo": 0.0, "MaximumNumberOfTriangles": 4000000, "NumberOfThreads": 0, "SeamTolerance": -1.0,
    "ResultArrayName": "", "OutputPrecision": 2, "UseAsNormals": 1, "PointValueArray": "",
    "PointWeightArray": ""}

#: Read-only values before the first update; those that are not listed are 0.
_NUMBERS: dict[str, float] = {"TimeUnit": 1.0, "DiffusionRateFactor": 1.0}


_MISSING = object()


class _Aborted(Exception):
    """The user has asked for the end of an update."""


@functools.lru_cache(maxsize=None)
def list_settings(model: str) -> dict[str, dict[str, Any]]:
    """The settings of a model, by name."""
    return {entry["name"]: entry for entry in _core.list_settings(model)}


def _is_hidden(data: Any) -> bool:
    """Whether no polygon or strip takes part, by its flags."""
    flags = cell_flags(data, True)
    first = data.GetNumberOfVerts() + data.GetNumberOfLines()
    return flags is not None and bool(((flags[first:] & ABSENT) != 0).all())


def _has_polygons(block: Block) -> bool:
    return bool(block.input.GetNumberOfPoints() > 0
                and block.input.GetNumberOfPolys() + block.input.GetNumberOfStrips() > 0)


class SurfaceFilter(VTKPythonAlgorithmBase):  # type: ignore[misc]
    """A filter on surfaces, whose model is that of a function of this package."""

    # From the proxy:
    MODEL = ""
    ARRAYS: dict[int, tuple[str, int]] = {}  #: index: property, number of components
    OUTPUTS: tuple[str, ...] = ("vtkDataObject", "vtkTable", "vtkPolyData")  #: as many as it has
    RESULT_NAME = ""

    POINT_INPUTS = 0  #: the number of optional inputs, which are points
    RUN: Any = None  #: the class of its runs
    NAMED_AFTER = ""  #: the array of the fields that results are named after
    MAY_REFINE_AUTOMATICALLY = False  #: whether RefineTo may be -1
    #: Of arrays where points are added between two, by their index.
    ROLES = {1: _core.PointRole.Mask, 3: _core.PointRole.Mark, 5: _core.PointRole.Weight, 6: _core.PointRole.Mark}
    DEFAULT_CHOICE: Choice | None = None

    def __init__(self) -> None:
        VTKPythonAlgorithmBase.__init__(
            self, nInputPorts=1 + self.POINT_INPUTS, nOutputPorts=len(self.OUTPUTS))
        self.settings: dict[str, Any] = {}
        self.own = {**_OWN, "ResultArrayName": self.RESULT_NAME}
        self.choices: dict[int, Choice] = {}
        self.shapes = Shapes()
        self._run = self.RUN(self.MODEL)
        self._numbers: dict[str, Any] = {}
        self._reported: list[str] = []
        self._warnings: list[str] = []  # of this class, in the present update
        self._of_surfaces: list[str] = []
        self._quiet = 0  # no observer
        self._failed_with: list[Any] = []  # the state of an update that has failed
        choice = self.DEFAULT_CHOICE
        if choice is not None:
            self.SetInputArrayToProcess(
                0, 0, 0, choice.association, choice.attribute if choice.name is None else choice.name)

    # Properties --------------------------------------------------------------------------------

    def assign(self, name: str, values: tuple[Any, ...]) -> None:
        """Set a property. ParaView gives None for an empty string, and one number or several."""
        given: Any = values[0] if len(values) == 1 else list(values)
        if name in _OWN:
            target, value = self.own, type(_OWN[name])("" if given is None else given)
        else:
            kind = list_settings(self.MODEL)[name]["kind"]
            converters: dict[str, Callable[[Any], Any]] = {
                "switch": lambda x: bool(int(x)), "number": float,
                "numbers": lambda x: [float(each) for each in x]}
            target, value = self.settings, converters.get(kind, int)(given)
        if target.get(name, _MISSING) != value:
            target[name] = value
            self.Modified()

    def find_number(self, name: str) -> Any:
        """Return a read-only value of the last update."""
        rows = self._numbers.get(name)
        return rows[0][0] if rows else _NUMBERS.get(name, 0.0)

    # VTK's overloads have other names, which no caller uses.
    def SetInputArrayToProcess(  # type: ignore[override]
            self, index: int, _port: int, _connection: int, association: int, name: Any,
            *_component: Any) -> None:
        """Choose an array by its name, or as an active attribute by its number."""
        # ParaView looks there for arrays that it should convert.
        VTKPythonAlgorithmBase.SetInputArrayToProcess(
            self, index, _port, _connection, association, "" if name is None else name)
        choice = Choice(association, None if isinstance(name, int) else name or "",
                        name if isinstance(name, int) else None)
        if self.choices.get(index) != choice:
            self.choices[index] = choice
            self.Modified()

    # Pipeline ----------------------------------------------------------------------------------

    def FillInputPortInformation(self, port: int, info: Any) -> int:
        # Other data are an error, whose message says what to do. That of the executive does not.
        key = vtkAlgorithm.INPUT_REQUIRED_DATA_TYPE()
        if port == 0:
            info.Set(key, "vtkCompositeDataSet")
            info.Append(key, "vtkPolyData")
        else:
            info.Set(vtkAlgorithm.INPUT_IS_OPTIONAL(), 1)
            info.Set(key, "vtkPointSet")
        info.Append(key, "vtkDataObject")
        return 1

    def FillOutputPortInformation(self, port: int, info: Any) -> int:
        info.Set(vtkDataObject.DATA_TYPE_NAME(), self.OUTPUTS[port])
        return 1

    def RequestDataObject(self, _request: Any, inputs: Any, outputs: Any) -> int:
        given, output = self._find_input(inputs, 0), outputs.GetInformationObject(0)
        made = output.Get(vtkDataObject.DATA_OBJECT())
        if given is None:
            if made is None:
                output.Set(vtkDataObject.DATA_OBJECT(), vtkPolyData())
        elif made is None or made.GetClassName() != given.GetClassName():
            output.Set(vtkDataObject.DATA_OBJECT(), given.NewInstance())
        return 1

    def RequestData(self, request: Any, inputs: Any, outputs: Any) -> int:
        made = [self.GetOutputData(outputs, port) for port in range(len(self.OUTPUTS))]
        for extra in made[1:]:
            extra.Initialize()
        parts = copy_structure(self._find_input(inputs, 0), made[0])
        if self._failed_with and self._failed_with == self._find_state(inputs, parts):  # at another time
            self._quiet_executive()
            return 0
        self.shapes.begin_update()
        refinement = Refinement(self.shapes)
        threads = _core.number_of_threads()
        self._warnings, self._of_surfaces, self._numbers = [], [], {}
        failure = ""
        completed = False
        try:
            if self.own["NumberOfThreads"] > 0:
                _core.set_number_of_threads(self.own["NumberOfThreads"])
            failure = self._update(request, parts, refinement, inputs, outputs, made)
            completed = not failure
        except _Aborted:
            pass  # The output is the unchanged input. Completed parts of the run are kept.
        except MemoryError:
            failure = "the memory does not suffice"
        except Exception as error:  # also one that nobody has foreseen: the outputs must be restored
            known = isinstance(error, (RuntimeError, ValueError, SurfaceError))
            failure = str(error) if known else f"{type(error).__name__}: {error}"
        finally:
            if _core.number_of_threads() != threads:
                _core.set_number_of_threads(threads)
        if not completed:
            for block in parts.blocks:
                block.output.ShallowCopy(block.input)
            refinement.undo()
            for extra in made[1:]:
                extra.Initialize()
        if self.GetReleaseDataFlag() or vtkDataObject.GetGlobalReleaseDataFlag():
            self.ReleaseCache()
        self._failed_with = self._find_state(inputs, parts) if failure else []
        if failure:
            self._report_error(failure)
            return 0
        return 1

    def _find_state(self, inputs: Any, parts: Parts) -> list[Any]:
        """The contents of the surfaces and the surface that each is a piece of, and when the filter and its
        further inputs were modified. (ParaView copies the input for each time.)"""
        state: list[Any] = [self.GetMTime()]
        for port in range(1, len(inputs)):
            further = self._find_input(inputs, port)
            state.append(0 if further is None else further.GetMTime())
        for block in parts.blocks:
            data = block.input
            arrays = [data.GetPoints().GetData() if data.GetPoints() else None]
            for cells in (data.GetPolys(), data.GetStrips()):
                arrays += [cells.GetOffsetsArray(), cells.GetConnectivityArray()]
            for attributes in (data.GetPointData(), data.GetCellData()):
                numbers = range(attributes.GetNumberOfArrays())
                arrays += [attributes.GetArray(i) for i in numbers]
                state += [(attributes.GetArrayName(i), attributes.IsArrayAnAttribute(i)) for i in numbers]
            state += [block.surface, hash_arrays(arrays)]
        return state

    def ReleaseCache(self) -> None:
        """Free what is kept from one update to the next."""
        self.shapes = Shapes()
        self._run.clear()

    @staticmethod
    def _find_input(inputs: Any, port: int) -> Any:
        if port >= len(inputs) or inputs[port].GetNumberOfInformationObjects() == 0:
            return None
        return inputs[port].GetInformationObject(0).Get(vtkDataObject.DATA_OBJECT())

    # Update ------------------------------------------------------------------------------------

    def _update(
        self, request: Any, parts: Parts, refinement: Refinement, inputs: Any, outputs: Any, made: list[Any]
    ) -> str:
        """Update the outputs. Return the text of an error, or an empty one."""
        controller = vtkMultiProcessController.GetGlobalController()
        if controller is not None and controller.GetNumberOfProcesses() > 1:
            return "ParaView runs in several processes; allowed: one (the plugin in C++ works in several)"
        if parts.in_pieces:
            disagreement = find_disagreement(self.choices, parts.blocks)
            if disagreement:
                return disagreement
        problems = self._check_own()
        given = [block for block in parts.blocks if _has_polygons(block)]
        if given and not problems:
            others = [block for block in parts.blocks if not _has_polygons(block)]
            self._refine(given, refinement, others)
        stitched = self._stitch(parts.blocks) if parts.in_pieces else []
        blocks = [surface.block for surface in stitched] if stitched else parts.blocks
        blocks = self._select(blocks, parts, problems)
        # Problems of the arrays are reported with those of the settings.
        self.begin(inputs)
        problems += [spell(words) for words in _core.find_problems(self.MODEL, self.settings, None)]
        found = self._find_all(blocks, problems)
        if problems:
            return "; ".join(sorted(set(problems)))
        self._run.update([fields.given.core for _, fields in found], self.settings, self.progress)
        self.seek(request, outputs)
        self.progress(0.95)  # the last chance to abort
        results, replaced = [], []
        for number, (block, fields) in enumerate(found):
            results.append(self.read_outputs(number, block, fields))
            data = fields[self.NAMED_AFTER].values
            replaced += write_outputs(results[-1], fields, data, block, self.own["ResultArrayName"])
        replaced += self.write_tables([block for block, _ in found], results, made)
        self._numbers = self._run.numbers()
        for surface in stitched:
            scatter_results(surface)
            self.complete_pieces(surface)
        if replaced:
            names = ", ".join(f'"{name}"' for name in sorted(set(replaced)))
            self._warnings.insert(0, say("Replaced", names))
        self._warnings += self._of_surfaces
        self._report_warnings([spell(words) for words in self._run.new_warnings()])
        self.UpdateProgress(1.0)
        return ""

    def begin(self, inputs: Any) -> None:
        """Read the points of the second input, which all blocks share."""
        data = self._find_input(inputs, 1)
        self.has_points = data is not None
        nothing: tuple[Any, list[str]] = (None, [])
        self.points, self.problems_of_points = nothing if data is None else self.read_points(data)

    def read_points(self, data: Any) -> tuple[Any, list[str]]:
        """Return what the model takes of a second input, None if that is not valid, and the problems."""
        raise NotImplementedError

    def find_fields(self, block: Block, fields: Fields) -> bool:
        """Find the arrays of a block. Return False if it takes no part."""
        self.find_arrays(block, fields, sorted(self.ARRAYS))
        return fields.data.values is not None or 0 not in self.ARRAYS

    def seek(self, request: Any, outputs: Any) -> None:
        """Go to the step that is asked for."""

    def read_outputs(self, number: int, block: Block, fields: Fields) -> list[Output]:
        """Return the outputs of the run on a block."""
        raise NotImplementedError

    def write_tables(self, blocks: list[Block], results: list[list[Output]], made: list[Any]) -> list[str]:
        """Fill the further outputs. Return the names of arrays that were replaced."""
        return []

    def _check_own(self) -> list[str]:
        own = self.own
        return [spell(words) for words in _core.check_surface_properties(
            own["SeamTolerance"], own["RefineTo"], self.MAY_REFINE_AUTOMATICALLY,
            own["MaximumNumberOfTriangles"], own["NumberOfThreads"])]

    def _select(self, blocks: list[Block], parts: Parts, problems: list[str]) -> list[Block]:
        """Return the blocks with polygons."""
        with_points = [block for block in blocks if block.input.GetNumberOfPoints() > 0]
        selected = [block for block in with_points if _has_polygons(block)]
        if not with_points and parts.other_types:
            problems.append(say("NoSurface", "the blocks are" if parts.is_composite else "the input is",
                                parts.other_types))
        elif not selected:
            problems.append(say("NoPolygons" if with_points else "Empty"))
        self._of_surfaces += _core.join_sentences(
            [(say("Hidden"), block.name)
             for block in selected if _is_hidden(block.input)], len(selected))
        return selected

    def _stitch(self, pieces: list[Block]) -> list[Stitched]:
        """The surfaces of the pieces, with the arrays that the filter may read."""
        choices = self.choices.values()
        attributes: set[int] = {
            vtkDataSetAttributes.SCALARS, vtkDataSetAttributes.VECTORS, vtkDataSetAttributes.NORMALS}
        attributes |= {choice.attribute for choice in choices if choice.attribute is not None}
        names: dict[str, bool] = {}
        for index, choice in self.choices.items():
            if choice.name:
                names[choice.name] = names.get(choice.name, True) and index in FLAGS
        return stitch_pieces(pieces, self.own["SeamTolerance"], names, attributes)

    def complete_pieces(self, surface: Stitched) -> None:
        """Change results of the pieces of a surface that are not those of the surface."""

    def find_refinement(self, mean: float) -> tuple[float, str]:
        """Return the length above which edges are bisected, 0 for none, and the reason to report. mean: the
        mean edge length, if RefineTo is -1."""
        return max(0.0, self.own["RefineTo"]), ""

    def _refine(self, blocks: list[Block], refinement: Refinement, others: list[Block]) -> None:
        automatic = self.own["RefineTo"] == -1.0
        length, reason = self.find_refinement(mean_edge_length(
            [self.shapes.find(block).core for block in blocks]) if automatic else 0.0)
        limit = self.own["MaximumNumberOfTriangles"]
        if not length > 0.0:
            return
        roles = {name: role for k, role in self.ROLES.items()
                 if k in self.choices and (name := self.choices[k].name) is not None}
        refinement.bisect(blocks, length, limit, lambda _: self.progress(0.0), others, roles)
        if refinement.longest > 0.0:
            self._of_surfaces.append(say("Stopped", refinement.longest, length, limit))
        if refinement.triangles and reason:
            self._of_surfaces.append(say("Bisected", refinement.triangles, reason))

    def _find_all(self, blocks: list[Block], problems: list[str]) -> list[tuple[Block, Fields]]:
        """Return the blocks that take part, with their arrays. Append problems."""
        raise NotImplementedError

    def find_arrays(self, block: Block, fields: Fields, indices: Iterable[int]) -> None:
        for index in indices:
            choice = self.choices.get(index, Choice())
            name = "creases" if self.ARRAYS[index][0] == "CreaseArray" else BY_INDEX[index]
            fields.arrays[name] = find_array(choice, index, *self.ARRAYS[index], block.input, fields)

    def check(self, found: list[tuple[Block, Fields]], problems: list[str]) -> None:
        """Append the problems of the settings with the arrays of each block."""
        sentences = []
        for block, fields in found:
            self.shapes.find(block)
            read_fields(fields, block)
            sentences += [(spell(words), block.name) for words in
                          _core.find_problems(self.MODEL, self.settings, fields.given.core)]
        problems += _core.join_sentences(sentences, len(found))

    # Reports -----------------------------------------------------------------------------------

    def progress(self, fraction: float) -> None:
        """Report the fraction done. Raises _Aborted."""
        self.UpdateProgress(fraction)
        aborted = bool(self.GetAbortExecute())
        if not aborted and hasattr(self, "CheckAbort"):
            aborted = bool(self.CheckAbort())
            if hasattr(self, "SetAbortOutput"):
                self.SetAbortOutput(False)  # the executive would empty the output
        if aborted:
            raise _Aborted

    def _report_error(self, text: str) -> None:
        self._quiet_executive()
        self._report("ErrorEvent", text, vtkOutputWindow.GetInstance().DisplayErrorText)

    def _report_warnings(self, of_run: list[str]) -> None:
        """Report, as one warning, those of the run and those of this class that did not hold before."""
        new = of_run + [text for text in self._warnings if text not in self._reported]
        self._reported = self._warnings
        if new:
            text = "; ".join(dict.fromkeys(new))
            self._report("WarningEvent", text, vtkOutputWindow.GetInstance().DisplayWarningText)

    def _report(self, event: str, text: str, display: Callable[[str], None]) -> None:
        kind = "ERROR" if event == "ErrorEvent" else "Warning"
        message = f"{kind}: In {type(self).__name__} ({id(self):#x}): {text}\n\n"
        if self.HasObserver(event):
            self.InvokeEvent(event, message)
        else:
            display(message)

    def _quiet_executive(self) -> None:
        """Leave out the next error of the executive, that the filter has failed: the filter has said why."""
        executive = self.GetExecutive()

        def forget(_object: Any, _event: str, text: str) -> None:
            executive.RemoveObserver(self._quiet)
            if "returned failure for request" not in text:
                vtkOutputWindow.GetInstance().DisplayErrorText(text)

        forget.CallDataType = "string0"  # type: ignore[attr-defined]
        executive.RemoveObserver(self._quiet)
        self._quiet = executive.AddObserver(vtkCommand.ErrorEvent, forget)
