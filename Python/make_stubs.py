# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Write surfacediffusion/_functions.pyi, the types of the functions' keywords for editors and type
checkers, from the signatures that the functions get from the settings in C++.

    make_stubs.py <folder of the package>
"""

import importlib
import inspect
import pathlib
import re
import sys
import types

HEADER = """\
from typing import Any, Iterator, Literal, overload

from numpy.typing import ArrayLike, NDArray
import numpy as np

from ._result import {results}
from ._run import Progress
from ._surface import SurfaceLike

__all__ = {functions}
"""


def returns(function):
    """The return types of a function for the values of its switches: its annotation lists that of
    neither, of full_output and of steps, in this order."""
    annotations = str(inspect.signature(function).return_annotation).split(" | ")
    has_steps = annotations[-1].startswith("Iterator")
    has_full_output = len(annotations) > 1 + has_steps
    switches = [{}] + has_full_output * [{"full_output": True}] + has_steps * [{"steps": True}]
    return list(zip(switches, annotations))


def load(folder):
    """The module of functions without the package, which needs the installed version."""
    package = types.ModuleType("surfacediffusion")
    package.__path__ = [str(folder)]
    sys.modules["surfacediffusion"] = package
    return importlib.import_module("surfacediffusion._functions")


def lines_of(name, signature, switches, returned, documentation, overloaded):
    """One definition, for given values of the switches."""
    lines, keyword_only = [f"def {name}("], False
    for parameter in signature.parameters.values():
        if parameter.kind is parameter.KEYWORD_ONLY and not keyword_only:
            lines.append("    *,")
            keyword_only = True
        annotation, default = parameter.annotation, repr(parameter.default)
        if parameter.name in ("steps", "full_output") and overloaded:
            if parameter.name in switches:
                annotation, default = "Literal[True]", None
            elif "steps" not in switches:
                annotation = "Literal[False]"
        end = "" if default is None or parameter.default is parameter.empty else f" = {default}"
        lines.append(f"    {parameter.name}: {annotation}{end},")
    lines.append(f") -> {returned}:" + (" ..." if not documentation else ""))
    if documentation:
        text = documentation.replace("\\", "\\\\")
        lines += [("    " + line).rstrip() for line in f'"""{text}\n"""'.splitlines()]
    return lines


def main(folder):
    module = load(folder)
    annotations = {name: returns(getattr(module, name)) for name in module.__all__}
    results = {match for variants in annotations.values() for _, returned in variants
               for match in re.findall(r"\w+Result", returned)}
    lines = HEADER.format(results=", ".join(sorted(results)), functions=module.__all__).splitlines()
    for name, variants in annotations.items():
        function = getattr(module, name)
        for number, (switches, returned) in enumerate(variants):
            lines.append("")
            if len(variants) > 1:
                lines.append("@overload")
            documentation = inspect.getdoc(function) if number == 0 else ""
            lines += lines_of(name, inspect.signature(function), switches, returned, documentation,
                              len(variants) > 1)
    path = folder / "_functions.pyi"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    compile(path.read_text(encoding="utf-8"), str(path), "exec")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
