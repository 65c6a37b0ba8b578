# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The settings of each function, as the C++ library declares them: one table for names, types,
ranges, defaults and documentation of the keywords, and for the wording of errors."""

from __future__ import annotations

import difflib
import functools
import math
import numbers
import operator
import re
from dataclasses import dataclass
from typing import Any, Callable, Mapping, Sequence

import numpy as np

from . import _core


@dataclass(frozen=True)
class Setting:
    """One keyword of a function."""

    name: str  #: in C++, VTK and ParaView
    keyword: str
    kind: str  #: "number", "numbers", "integer", "switch" or "choice"
    unit: str
    documentation: str
    default: Any
    allowed: str
    is_of_output: bool  #: no state depends on it
    words: tuple[str, ...] = ()  #: of a choice
    usable: tuple[str, ...] = ()  #: the words that may be chosen

    @functools.cached_property
    def spellings(self) -> dict[str, str]:
        """The word for each spelling of a choice: as in C++, and in snake_case."""
        return {spelling: word for word in self.usable for spelling in (word, snake_case(word))}

    def convert(self, value: Any) -> Any:
        """The value for C++. ValueError if it has another type or is no word."""
        if self.kind == "choice":
            word = self.spellings.get(value) if isinstance(value, str) else None
            if word is not None:
                return self.words.index(word)
        elif self.kind == "switch":
            if isinstance(value, (bool, np.bool_)):
                return bool(value)
        elif self.kind == "numbers":
            found = np.asarray(value)
            if found.dtype.kind in "iuf" and np.isfinite(found).all():
                return [float(number) for number in found.ravel()]
        elif isinstance(value, numbers.Real) and not isinstance(value, (bool, np.bool_)):
            if self.kind == "number":
                return float(value)
            if math.isfinite(value) and value == int(value) and abs(value) < 2**31:
                return operator.index(int(value))
        elif isinstance(value, np.ndarray) and value.ndim == 0 and value.dtype.kind in "iuf":
            return self.convert(value[()])
        hint = ", or in snake_case" if self.kind == "choice" else ""
        raise ValueError(f"{self.keyword} is {shorten(value)}; allowed: {self.allowed}{hint}")


def shorten(value: Any) -> str:
    """The value as one short line."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:57] + "..."


def as_number(
    name: str, value: Any, allowed: str = "finite numbers above 0",
    fits: Callable[[float], bool] = lambda number: 0.0 < number < math.inf,
) -> float:
    """The value as a float. ValueError if it is none, or does not fit."""
    is_number = isinstance(value, (int, float, np.number)) and not isinstance(value, (bool, np.bool_))
    if not (is_number and fits(value)):
        raise ValueError(f"{name} is {shorten(value)}; allowed: {allowed}")
    return float(value)


def as_integer(name: str, value: Any, low: int, high: int, allowed: str = "") -> int:
    """The value as an int. ValueError unless it is from low to high."""
    is_integer = isinstance(value, (int, np.integer)) and not isinstance(value, (bool, np.bool_))
    if not (is_integer and low <= value <= high):
        raise ValueError(f"{name} is {shorten(value)}; allowed: {allowed or f'{low} to {high}'}")
    return int(value)


def as_switch(name: str, value: Any, allowed: str = "True or False") -> bool:
    """The value as a bool. ValueError if it is none."""
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name} is {shorten(value)}; allowed: {allowed}")
    return bool(value)


def snake_case(name: str) -> str:
    """The keyword of a C++ name: "NumberOfTimeSteps" is "number_of_time_steps"."""
    return _core.python_name(name)


@functools.lru_cache(maxsize=None)
def settings_of(function: str) -> dict[str, Setting]:
    """The settings of a function by keyword, in the order of C++."""
    table = {}
    for entry in _core.list_settings(function):
        # An iterator over time steps needs no requests of times.
        if not entry.pop("is_of_pipelines"):
            for list_name in ("words", "usable"):
                entry[list_name] = tuple(entry.get(list_name, ()))
            setting = Setting(keyword=snake_case(entry["name"]), **entry)
            table[setting.keyword] = setting
    return table


def convert_all(function: str, properties: Mapping[str, Any]) -> dict[str, Any]:
    """The values for C++ by C++ name. TypeError for a keyword that the function does not have, as
    for any Python function."""
    table = settings_of(function)
    for keyword in properties:
        if keyword not in table:
            close = difflib.get_close_matches(keyword, table, 1)
            hint = f"; did you mean {close[0]!r}?" if close else ""
            raise TypeError(f"{function}() has no keyword {keyword!r}{hint}")
    return {table[k].name: table[k].convert(value) for k, value in properties.items()}


#: The result type in place of the setting of VTK.
_DTYPES = {"Single": "float32", "Double": "float64"}


def spell(function: str, words: Sequence[tuple[str, str, str, int]], arrays: Mapping[str, str]) -> str:
    """A sentence of the library in the words of Python: keywords for settings and arrays, the words of
    choices, faces for cells. arrays: the keywords of input arrays."""
    table = {setting.name: setting for setting in settings_of(function).values()}

    def spell_one(kind: str, spelling: str, name: str, value: int) -> str:
        if kind == "setting":
            return "dtype" if name == "OutputPrecision" else snake_case(name)
        if kind == "array":
            return arrays.get(name, spelling)
        if kind == "choice":
            return table[name].words[value] if name in table else _DTYPES.get(spelling, spelling)
        if kind == "switch":
            return str(bool(value))
        if kind == "face":
            return "faces" if value else "face"
        return spelling

    return "".join(spell_one(*word) for word in words)


def spell_documentation(function: str, text: str, arrays: Mapping[str, str]) -> str:
    """The documentation of a setting with the keywords of settings and arrays."""
    names = {setting.name: setting.keyword for setting in settings_of(function).values()}
    names.update(arrays, cell="face", cells="faces")
    return re.sub(r"\b\w+\b", lambda word: names.get(word.group(), word.group()), text)
