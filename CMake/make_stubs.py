# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Write vtkSurfaceDiffusion/vtkSurfaceDiffusion.pyi for editors, which cannot read a compiled module:
the types from VTK's own generator, and the documentation of the headers.

    make_stubs.py <folder of vtkSurfaceDiffusion>
"""

import inspect
import pathlib
import re
import sys

sys.path.insert(0, sys.argv[1])
from vtkmodules import generate_pyi  # noqa: E402

import vtkSurfaceDiffusion.vtkSurfaceDiffusion as module  # noqa: E402

folder = pathlib.Path(sys.argv[1]) / "vtkSurfaceDiffusion"
generate_pyi.main(["generate_pyi", "-p", folder.name, "-o", str(folder), "vtkSurfaceDiffusion"])


def documentation(thing, indent):
    """The lines of a docstring, if there is one. A method's begins with its signatures in C++ and
    Python, which are left out."""
    text = inspect.getdoc(thing) or ""
    if not inspect.isclass(thing):
        text = text.partition("\n\n")[2]
    text = text.strip().replace("\\", "\\\\").replace('"""', "'''")
    lines = [(indent + line).rstrip() for line in ('"""' + text + '\n"""').splitlines()]
    return lines if text else []


path = folder / "vtkSurfaceDiffusion.pyi"
lines, cls = [], None
for line in path.read_text().splitlines():
    match = re.match(r"class (\w+)\(", line)
    if match:
        cls = getattr(module, match.group(1))
        lines += [line] + documentation(cls, "    ")
        continue
    match = re.match(r"    def (\w+)\(.*: \.\.\.$", line)
    text = documentation(getattr(cls, match.group(1), None), "        ") if match else []
    lines += [line[: -len(" ...")]] + text if text else [line]
path.write_text("\n".join(lines) + "\n")
compile(path.read_text(), str(path), "exec")
