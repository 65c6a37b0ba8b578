# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Write surfacediffusion/_functions.pyi, the types of the functions' keywords for editors and type
checkers, from the signatures that the functions get from the settings in C++.

    make_stubs.py <folder of the package>
"""

import importlib
import inspect
import pathlib
import sys
import types

HEADER = """\
from typing import Any, Iterator, Literal, overload

from numpy.typing import ArrayLike, NDArray
import numpy as np

from ._result import (
    DiffusionResult, EdgeResult, HarmonicMapResult, MeshDenoisingResult, SegmentationResult,
    TensorDiffusionResult, TextureResult,
)
from ._run import Progress
from ._surface import SurfaceLike

__all__ = [
    "denoise_mesh", "direction_field", "harmonic_map", "heat", "intrinsic_tv", "mumford_shah", "segment",
    "tensor_diffusion", "turing_texture",
]
"""

#: The return types of a function for the values of its switches.
RETURNS = {
    "heat": [({}, "NDArray[Any]"), ({"full_output": True}, "DiffusionResult"),
             ({"steps": True}, "Iterator[DiffusionResult]")],
    "harmonic_map": [({}, "HarmonicMapResult"), ({"steps": True}, "Iterator[HarmonicMapResult]")],
    "mumford_shah": [({}, "EdgeResult"), ({"steps": True}, "Iterator[EdgeResult]")],
    "turing_texture": [({}, "TextureResult"), ({"steps": True}, "Iterator[TextureResult]")],
    "denoise_mesh": [({}, "NDArray[np.float64]"), ({"full_output": True}, "MeshDenoisingResult")],
    "segment": [({}, "SegmentationResult")],
    "tensor_diffusion": [({}, "NDArray[Any]"), ({"full_output": True}, "TensorDiffusionResult"),
                         ({"steps": True}, "Iterator[TensorDiffusionResult]")],
    "direction_field": [({}, "NDArray[np.float64]")],
}
RETURNS["intrinsic_tv"] = RETURNS["heat"]


def load(folder):
    """The module of functions without the package, which needs the installed version."""
    package = types.ModuleType("surfacediffusion")
    package.__path__ = [str(folder)]
    sys.modules["surfacediffusion"] = package
    return importlib.import_module("surfacediffusion._functions")


def lines_of(name, signature, switches, returned, documentation):
    """One definition, for given values of the switches."""
    lines, keyword_only = [f"def {name}("], False
    for parameter in signature.parameters.values():
        if parameter.kind is parameter.KEYWORD_ONLY and not keyword_only:
            lines.append("    *,")
            keyword_only = True
        annotation, default = parameter.annotation, repr(parameter.default)
        if parameter.name in ("steps", "full_output") and len(RETURNS[name]) > 1:
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
    lines = HEADER.splitlines()
    for name, variants in RETURNS.items():
        function = getattr(module, name)
        for number, (switches, returned) in enumerate(variants):
            lines.append("")
            if len(variants) > 1:
                lines.append("@overload")
            documentation = inspect.getdoc(function) if number == 0 else ""
            lines += lines_of(name, inspect.signature(function), switches, returned, documentation)
    path = folder / "_functions.pyi"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    compile(path.read_text(encoding="utf-8"), str(path), "exec")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
