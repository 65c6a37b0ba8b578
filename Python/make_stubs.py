# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Write the types of the functions' keywords for editors and type checkers, from the signatures that the
functions get from the settings in C++: _functions.pyi, _steps.pyi and _derivatives.pyi.

    make_stubs.py <folder of the package>
"""

import importlib
import inspect
import pathlib
import re
import sys
import types

MODULES = ("_functions", "_steps", "_derivatives")

HEADER = """\
from typing import Any, Literal

from numpy.typing import ArrayLike, NDArray
import numpy as np

from ._result import {results}
from ._run import Progress, States
from ._surface import SurfaceLike

__all__ = {functions}
"""


def load(folder, name):
    """A module of functions without the package, which needs the installed version."""
    package = types.ModuleType("surfacediffusion")
    package.__path__ = [str(folder)]
    sys.modules.setdefault("surfacediffusion", package)
    return importlib.import_module(f"surfacediffusion.{name}")


def lines_of(function):
    """The definition of a function."""
    signature = inspect.signature(function)
    lines, keyword_only = ["", f"def {function.__name__}("], False
    for parameter in signature.parameters.values():
        if parameter.kind is parameter.KEYWORD_ONLY and not keyword_only:
            lines.append("    *,")
            keyword_only = True
        end = "" if parameter.default is parameter.empty else f" = {parameter.default!r}"
        lines.append(f"    {parameter.name}: {parameter.annotation}{end},")
    lines.append(f") -> {signature.return_annotation}:")
    text = inspect.getdoc(function).replace("\\", "\\\\")
    return lines + [("    " + line).rstrip() for line in f'"""{text}\n"""'.splitlines()]


def main(folder):
    for name in MODULES:
        module = load(folder, name)
        functions = [getattr(module, function) for function in module.__all__]
        results = {match for function in functions for match in re.findall(
            r"\w+Result|ConductionVelocity|HelmholtzParts", str(inspect.signature(function)))}
        lines = HEADER.format(results=", ".join(sorted(results)), functions=module.__all__).splitlines()
        for function in functions:
            lines += lines_of(function)
        path = folder / f"{name}.pyi"
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        compile(path.read_text(encoding="utf-8"), str(path), "exec")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
