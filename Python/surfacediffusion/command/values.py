# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The types of arguments: numbers, lengths with a unit, places."""
from __future__ import annotations

import argparse
import math
import re

from ..files.export import UNITS


def _number(text, holds, allowed, given=None):
    """given: the whole argument, if `text` is a part of it."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or not holds(value):
        raise _wrong(given or text, allowed)
    return value


def _wrong(text, allowed):
    return argparse.ArgumentTypeError(f"is {text!r}; allowed: {allowed}")


def numbers(allowed, holds=lambda value: True):
    """The type of an argument that is a number."""
    return lambda text: _number(text, holds, allowed)


def whole_numbers(allowed, least, most=2**31 - 1):
    """The type of an argument that is a whole number."""
    return lambda text: int(_number(
        text, lambda value: value == int(value) and least <= value <= most, allowed))


finite = numbers("a finite number")
positive = numbers("a number above 0", lambda value: value > 0)
not_negative = numbers("a number of at least 0", lambda value: value >= 0)
whole = whole_numbers("a whole number from -2147483647 to 2147483647", 1 - 2**31)
count = whole_numbers("a whole number from 1 to 2147483647", 1)


def length(text, holds=lambda value: True, allowed="a length"):
    """A number and its unit, or None."""
    units = ", ".join(UNITS)
    found = re.fullmatch(r"\s*([-+0-9.eE]+?)\s*([^\W\d_]*)\s*", text)
    unit = found[2].lower().replace("\u03bc", "u").replace("\u00b5", "u") if found else ""
    allowed = f"{allowed}, with or without a unit ({units}), such as 4mm"
    if not found or unit and unit not in UNITS:
        raise _wrong(text, allowed)
    return _number(found[1], holds, allowed, text), unit or None


def positive_length(text):
    return length(text, lambda value: value > 0, "a length above 0")


def length_or_zero(text):
    return length(text, lambda value: value >= 0, "a length of at least 0")


def place(text):
    """The number of a vertex, or coordinates."""
    words = text.split(",")
    try:
        coordinates = [float(word) for word in words]
    except ValueError:
        coordinates = []
    if len(coordinates) == 1 and re.fullmatch(r"\d+", text.strip()):
        return int(text)
    if len(coordinates) != 3 or not all(map(math.isfinite, coordinates)):
        raise _wrong(text, "the number of a vertex, from 0, or x,y,z")
    return coordinates
