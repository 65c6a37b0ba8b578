# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the library: from checked arrays to results, with warnings and progress."""

from __future__ import annotations

import sys
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Generic, Iterator, Mapping, TypeVar, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._settings import as_switch, convert_all, settings_of, shorten, spell
from ._surface import (
    Surface, as_directions, as_factors, as_flags, as_numbers, data_components, find_place,
    require_shape,
)

if TYPE_CHECKING:
    from ._refinement import RefinedSurface

Progress = Union[None, bool, Callable[[float], Any]]


class SurfaceDiffusionWarning(UserWarning):
    """The input was computed, but something in it may not be intended."""


def warn(sentences: list[str], category: type[Warning] = SurfaceDiffusionWarning) -> None:
    """One warning for all sentences, at the line that called this package."""
    if not sentences:
        return
    folder = str(Path(__file__).parent)
    level, frame = 1, sys._getframe(0)
    while frame is not None and frame.f_code.co_filename.startswith(folder):
        level, frame = level + 1, frame.f_back  # type: ignore[assignment]
    warnings.warn("; ".join(sentences), category, stacklevel=level)


def check_parts(built: Any) -> int:
    """The number of vertices. ValueError if there are none, and a warning if points of the boundary coincide:
    a surface whose triangles do not share them."""
    if built.number_of_vertices() == 0:
        raise ValueError("no triangle of the surface is left; allowed: one or more that are not masked "
                         "and have an area")
    warn_of_seams(built)
    return int(built.number_of_vertices())


def warn_of_seams(built: Any) -> None:
    """A warning if points of the boundary coincide."""
    count, distance = built.seams()
    if distance:
        how = f"points within {distance:g} of one another once, as scipy.spatial.cKDTree finds them"
    else:
        how = "points at one place once, as numpy.unique(points, axis=0, return_inverse=True) does"
    if count:
        warn([f"{count} boundary points coincide with others and nothing flows between them (to join them, "
              f"number {how})"])


def take_old_switch(
    properties: dict[str, Any], function: str, word: str, instead: str, default: bool = False
) -> bool:
    """The value of a switch of former versions, which leaves the properties with a warning."""
    if word not in properties:
        return default
    given = as_switch(word, properties.pop(word))
    warn([f"{word} of {function}() is deprecated: {instead}"], DeprecationWarning)
    return given


class ProgressReporter:
    """The callable for C++, and a bar that is closed at the end."""

    def __init__(self, progress: Progress, parts: int = 1) -> None:
        self._bar = None
        self._call: Callable[[float], Any] | None = None
        self._parts, self._part = parts, 0
        self._reached = 0.0
        if progress is True:
            try:
                from tqdm.auto import tqdm  # type: ignore[import-untyped,unused-ignore]
            except ImportError:
                raise ValueError("progress is True, but tqdm is not installed; allowed: a callable, "
                                 "or True after: pip install tqdm") from None
            self._bar = tqdm(total=1.0, bar_format="{percentage:3.0f}%|{bar}| {elapsed}")
            self._call = lambda fraction: self._bar.update(fraction - self._bar.n)
        elif callable(progress):
            self._call = progress
        elif progress not in (None, False):
            raise ValueError(f"progress is {shorten(progress)}; allowed: True, False or a callable "
                             "that takes the fraction done")

    @property
    def callable(self) -> Callable[[float], Any] | None:
        """For C++: called with the fraction of the present part."""
        if self._call is None:
            return None
        return lambda fraction: self._report((self._part + fraction) / self._parts)

    def finish_part(self) -> None:
        self._part += 1
        if self._call is not None:
            self._report(self._part / self._parts)

    def _report(self, fraction: float) -> Any:
        """Set-up may have reported more than the first part of the steps does."""
        assert self._call is not None
        self._reached = max(self._reached, fraction)
        return self._call(self._reached)

    def __enter__(self) -> ProgressReporter:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()


def part_of(
    progress: Callable[[float], Any] | None, start: float, share: float
) -> Callable[[float], Any] | None:
    """The callable for a part of the work, from the fraction `start` on; None stays."""
    if progress is None:
        return None
    return lambda fraction: progress(start + share * fraction)


def find_result_type(data: NDArray[Any] | None, dtype: Any) -> np.dtype[Any]:
    """The type of a result: that of the data, or float64 if there are none, unless `dtype` is
    given."""
    if dtype is None:
        return np.dtype(np.float64) if data is None else data.dtype
    try:
        found = np.dtype(dtype)
    except TypeError:
        found = np.dtype(object)
    if found not in (np.float32, np.float64):
        raise ValueError(f"dtype is {shorten(dtype)}; allowed: None, float32 or float64")
    return found


@dataclass
class Given:
    """What a run takes of a surface. data: as rows; integers: they were, so that results keep them where
    nothing determines a value, in place of NaN. sizes: the numbers of "points" and "faces"."""

    core: Any
    data: NDArray[Any] | None
    integers: bool
    sizes: dict[str, int]


def make_core(surface: Any, arrays: Mapping[str, Any], data_are_terms: bool = False, block: str = "") -> Any:
    """The arrays of a surface of the library as it takes them. arrays: by kind, None or an array, whether it
    is on faces and, for messages, its name. block: the name of the surface."""
    data = arrays.get("data", (None,))[0]
    core = _core.Fields(surface, 0 if data is None else data_components(data), data_are_terms, block)
    for kind, (array, *place) in arrays.items():
        if array is not None:
            core.set(kind, array, *place)
    return core


class Input(Given):
    """The input of a run on one surface. data_on_faces: where the data are. Directions, masks and the
    like are on points or faces by their number, unless they are Placed. samples: places, values and
    weights in place of data. refined: the refinement that has made the surface, between whose given
    points nothing was measured."""

    def __init__(
        self,
        surface: Surface,
        data: NDArray[Any] | None = None,
        *,
        data_on_faces: bool = False,
        mask: Any = None,
        fixed: Any = None,
        directions: Any = None,
        directions_name: str = "directions",
        rates: Any = None,
        fidelity: Any = None,
        seeds: Any = None,
        creases: Any = None,
        data_are_terms: bool = False,
        integers: bool = False,
        samples: tuple[NDArray[Any], NDArray[Any], NDArray[Any] | None] | None = None,
        refined: RefinedSurface | None = None,
    ) -> None:
        n, m = surface.n_points, surface.n_faces
        self.surface = surface
        arrays: dict[str, tuple[Any, bool]] = {"data": (data, data_on_faces)}
        if directions is not None:
            arrays["directions"] = as_directions(directions_name, directions, (n, m))
        if rates is not None:
            found = as_numbers("rates", rates)
            require_shape("rates", found, found.shape == (m, 4), f"({m}, 4), one row per face")
            arrays["rates"] = np.ascontiguousarray(found, dtype=np.float64), False
        for name, array, convert, what in (
                ("mask", mask, as_flags, "flag"), ("fixed", fixed, as_flags, "flag"),
                ("fidelity", fidelity, as_factors, "number"), ("seeds", seeds, as_factors, "label"),
                ("creases", creases, as_factors, "label")):
            if array is not None:
                arrays[name] = convert(name, array), find_place(name, array, (n, m), what, data_on_faces)
        if refined is not None:
            between = np.arange(n) >= n - len(refined.parents)
            arrays["between"] = between.astype(np.uint8), False
            arrays["given_faces"] = refined.faces.astype(np.int64), True
        super().__init__(make_core(surface._core, arrays, data_are_terms), data, integers,
                         {"points": n, "faces": m})
        if samples is not None:
            self.core.set_samples(*samples)

    def write(self, run: Any, block: int, output: NDArray[Any], first: int) -> None:
        """Write the columns of the result of the data of a block, from column `first` on."""
        number = [entry["is_result"] for entry in run.outputs(block)].index(True)
        run.write(block, number, output, self.core, first, self.integers)


#: Settings in place of which another one acts, unless this is 0 or off, without a warning.
_REPLACED = {
    "heat": {"time_step": ("fwhm", "mode"), "fidelity_weight": ("automatic_fidelity",)},
    "intrinsic_tv": {"time_step": ("mode",)},
    "turing_texture": {"time_step": ("automatic_time_step",)},
    "segment": {"means": ("automatic_means",)},
    "interpolate": {"smoothing": ("automatic_smoothing", "exact")},
}


def _refuse_replaced(function: str, properties: Mapping[str, Any]) -> None:
    """ValueError if a given keyword would be dropped because of another given one."""
    for name, others in _REPLACED.get(function, {}).items():
        for other in others:
            value = properties.get(other)
            acts = (value in ("SteadyState", "steady_state") if isinstance(value, str) else
                    isinstance(value, (bool, int, float, np.bool_, np.number)) and bool(value))
            if name in properties and acts:
                raise ValueError(f"{name} is {shorten(properties[name])}, but {other} is "
                                 f"{shorten(properties[other])}, which takes its place; allowed: one of them")


def in_words(function: str, arrays: Mapping[str, str], work: Callable[..., Any], *arguments: Any) -> Any:
    """work(*arguments), whose errors of the input are put in the words of Python."""
    try:
        return work(*arguments)
    except _core.InputError as error:
        raise ValueError(spell(function, error.words, arrays)) from None


class Runner:
    """Runs of a model with given settings, and the wording of their errors."""

    def __init__(self, function: str, properties: Mapping[str, Any], arrays: Mapping[str, str]):
        self.function, self.arrays = function, arrays
        _refuse_replaced(function, properties)
        off = {switch: False for name, switch in _core.list_found(function).items() if name in properties}
        self.settings = convert_all(function, {**off, **properties})
        if function == "heat" and not (
                properties.get("fwhm") or {"time_step", "mode"} & set(properties)):
            # The width of the default time step would depend on the mesh.
            raise ValueError("heat() has no width; allowed: one of fwhm (the width of a "
                             "Gaussian, in coordinate units), time_step and mode")
        interval = settings_of(function).get("output_interval")
        self.interval = self.settings.get("OutputInterval", interval.default if interval else 1)

    def call(self, work: Callable[..., Any], *arguments: Any) -> Any:
        """in_words() of the function."""
        return in_words(self.function, self.arrays, work, *arguments)

    def warnings(self, run: Any) -> list[str]:
        """The warnings that hold, in the words of Python."""
        return self._spell_all(run.warnings())

    def _spell_all(self, sentences: list[Any]) -> list[str]:
        return [spell(self.function, words, self.arrays) for words in sentences]

    def finish(
        self, run: Any, inputs: list[Input], make: Callable[[list[dict[str, Any]]], Any],
        progress: Progress, history: bool = True,
    ) -> Any:
        """Run to the last step. What `make` makes of the run and the common attributes of the result on
        each surface. history: whether energy and totals of the states are measured, too."""
        with ProgressReporter(progress) as reporter:
            self.call(run.update, [i.core for i in inputs], self.settings, reporter.callable, history)
            self.call(run.seek, -1, reporter.callable)
            sentences = self.warnings(run)
            made = make(self._attributes(run, inputs, sentences))
            reporter.finish_part()  # last, because the callable may use the run
        warn(sentences)
        return made

    def finish_panels(
        self, run: Any, given: Input, output: NDArray[Any], columns: int, progress: Progress
    ) -> None:
        """Run to the last step with a few columns of the data after another, and write `output`."""
        assert given.data is not None
        starts = range(0, output.shape[1], columns)
        known: list[str] = []
        # The C library of Linux keeps freed blocks up to the size of the largest one that was freed,
        # at most 32 MiB. Without this one, each panel would get its memory from the system again,
        # which takes a fifth of the time.
        np.empty(31 << 20, dtype=np.uint8)
        with ProgressReporter(progress, len(starts)) as reporter:
            for first in starts:
                panel = given.core.columns(first, min(columns, output.shape[1] - first))
                self.call(run.update, [panel], self.settings, reporter.callable, False)
                self.call(run.seek, -1, reporter.callable)
                self.call(given.write, run, 0, output, first)
                known += [text for text in self.warnings(run) if text not in known]
                reporter.finish_part()
        warn(known)

    def start(self, run: Any, inputs: list[Input]) -> None:
        """Begin a run whose states visit() shows, and whose warnings it gives once."""
        self.call(run.update, [i.core for i in inputs], self.settings, None)
        run.forget_warnings()

    def visit(
        self, run: Any, inputs: list[Input], steps: list[int], progress: Progress
    ) -> Iterator[list[dict[str, Any]]]:
        """The attributes of the result on each surface, at steps of a run after start()."""
        with ProgressReporter(progress, max(1, len(steps))) as reporter:
            for step in steps:
                self.call(run.seek, step, reporter.callable)
                reporter.finish_part()
                warn(self._spell_all(run.new_warnings()))
                yield self._attributes(run, inputs, self.warnings(run))

    def _attributes(
        self, run: Any, inputs: list[Input], sentences: list[str]
    ) -> list[dict[str, Any]]:
        history = {name: np.array(column) for name, column in run.history().items()}
        step = len(history["Time"]) - 1
        attributes = []
        for block in range(len(inputs)):
            results = run.results(block)
            results.update(history=history, step=step, warnings=sentences,
                           time=float(history["Time"][-1]),
                           number_of_iterations=int(history["Iterations"].sum()))
            attributes.append(results)
        return attributes


R = TypeVar("R")


class States(Generic[R]):
    """The states of a run in time steps: an iterator of results at steps 0, k, 2k, ... and the last, with
    k = `output_interval`. Each state is computed when it is asked for. Errors of the input come at once.
    """

    def __init__(
        self, name: str, runner: Runner, given: Input, make: Callable[[Any, dict[str, Any]], R],
        progress: Progress,
    ) -> None:
        self._name, self._runner, self._given = name, runner, given
        self._make, self._progress = make, progress
        # The run of the surface, with its factors, is that of these states until the last one.
        with given.surface._lock:
            self._run = given.surface._runs.pop(name, None) or _core.ModelRun(name)
        runner.start(self._run, [given])
        self._states = self._results()
        self._last: R | None = None

    def __iter__(self) -> Iterator[R]:
        return self

    def __next__(self) -> R:
        return next(self._states)

    def _results(self) -> Iterator[R]:
        count = self._run.number_of_steps()
        steps = [*range(0, count, self._runner.interval), count]
        states = self._runner.visit(self._run, [self._given], steps, self._progress)
        for step, (attributes,) in zip(steps, states):
            yield self._make(self._run, attributes)
            if attributes["step"] < step:
                return  # the run has ended by itself

    def last(self) -> R:
        """Compute the last state, without results of those before it. The iteration ends."""
        if self._last is None:
            ((attributes,),) = self._runner.visit(self._run, [self._given], [-1], self._progress)
            self._last = self._make(self._run, attributes)
            self._states = iter(())
            with self._given.surface._lock:
                self._given.surface._runs.setdefault(self._name, self._run)
        return self._last
