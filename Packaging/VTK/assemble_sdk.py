# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A CMake package of the VTK in a wheel of PyPI, which has libraries only: headers and properties of
modules from an SDK of the same minor version, and programs that wrap classes for Python."""

import re
import shutil
import sys
from pathlib import Path

# Modules that vtkSurfaceDiffusion is linked with; others follow from what these depend on.
MODULES = ["CommonCore", "CommonDataModel", "CommonExecutionModel", "ParallelCore", "Python", "WrappingPythonCore"]

# The SDK for a minor version, and what has to change in its headers. PyPI has Kitware's SDK for macOS only,
# whose headers serve all systems. PyVista's fork of VTK has members that VTK's own library has not.
SDKS = {
    "9.5": {"requirement": "vtk-sdk==9.5.0", "python": "3.10", "platform": "macosx_11_0_arm64", "edits": {
        # An older program that wraps does not know these hints.
        "vtkWrappingHints.h": (r"(?m)(define VTK_(?:PROPEXCLUDE|UNBLOCKTHREADS|MARSHAL).*?)\[\[.*", r"\1")}},
    "9.7": {"requirement": "cvista-sdk==9.7.0.5", "python": "3.12", "platform": "manylinux_2_28_x86_64", "edits": {
        "vtkPolyData.h": (r"(?m)^ *std::mutex Build\w+;$", ""),
        "vtkUnstructuredGrid.h": (r"(?m)^ *std::mutex Build\w+;$", ""),
        "SMP/Common/vtkSMPToolsAPI.h": (r"(?m)^ *GilReleaseScope gilScope\(.*\);$", "")}},
}

CONFIG = """\
set(VTK_VERSION "@version@")
string(REPLACE "." ";" numbers "${VTK_VERSION}")
list(GET numbers 0 VTK_MAJOR_VERSION)
list(GET numbers 1 VTK_MINOR_VERSION)
list(GET numbers 2 VTK_BUILD_VERSION)
set(VTK_PYTHON_VERSION 3)
set(VTK_WRAP_PYTHON ON)
find_package(Python3 REQUIRED COMPONENTS Interpreter Development.Module)
set(_vtk_module_import_prefix "@content@")
add_library(VTK::vtkbuild INTERFACE IMPORTED)
@targets@
target_link_libraries(VTK::Python INTERFACE Python3::Module)
# Names of Python 2, which the code of older programs that wrap has.
target_compile_definitions(VTK::Python INTERFACE PyIntObject=PyLongObject PyInt_Type=PyLong_Type)
include("@cmake@/vtkModule.cmake")
include("@cmake@/vtkModuleWrapPython.cmake")
"""
MODULE = """\
add_library(VTK::@name@ @kind@ IMPORTED)
set_target_properties(VTK::@name@ PROPERTIES @location@
  INTERFACE_LINK_LIBRARIES "@depends@"
  INTERFACE_INCLUDE_DIRECTORIES "@headers@")
set(VTK_@name@_FOUND TRUE)
"""


def _filled(text, **values):
    return re.sub("@([a-z]+)@", lambda match: str(values[match[1]]), text)


def _properties(folder):
    """Of every module of an SDK: the lines that set its properties, and the public modules it depends on."""
    lines, depends = {}, {}
    for path in sorted(folder.glob("*-module-properties.cmake")):
        for line in path.read_text().splitlines():
            match = re.match(r'set_property\(TARGET "VTK::(\w+)" PROPERTY "INTERFACE_vtk_module_(\w+)" "(.*)"', line)
            if not match or match[2] == "kit":  # a wheel has a library for each module
                continue
            line = line.replace('"cvista"', '"vtkmodules"')
            lines.setdefault(match[1], []).append(line)
            if match[2] == "depends":
                depends[match[1]] = re.findall(r"VTK::(\w+)", match[3])
    return lines, depends


def _closure(names, depends):
    found = []
    names = list(names)
    while names:
        name = names.pop(0)
        if name not in found:
            found.append(name)
            names += depends.get(name, [])
    return found


def _wrapper(sdk):
    """The programs that wrap, and the folder of the CMake functions that call them: of the SDK if they run
    on this system, otherwise of a VTK that is installed."""
    programs = sorted(sdk.glob("bin/vtkWrap*-cvista"))
    if programs:
        for program in programs:
            program.chmod(0o755)  # which zipfile does not keep
        return programs, next(sdk.glob("*.data/headers/cmake"))
    for program in sorted(Path("/usr/bin").glob("vtkWrapPython-*")):
        suffix = program.name[len("vtkWrapPython"):]
        programs = [program.with_name(name + suffix) for name in ("vtkWrapHierarchy", "vtkWrapPython", "vtkWrapPythonInit")]
        folders = sorted(Path("/usr/lib").glob("*/cmake/*%s*/vtk" % re.sub(r"^-pv", "", suffix)))
        if folders and all(each.exists() for each in programs):
            return programs, folders[0]
    raise SystemExit("no vtkWrapPython in /usr/bin, which wraps classes for this VTK; on Debian 12 the package "
                     "paraview-dev has it. The wheel does not depend on ParaView")


def assemble(version, content, libraries, folder):
    """Writes vtk-config.cmake into the folder. version: of the wheel; content: of the unpacked SDK;
    libraries: the folder vtkmodules of the wheel."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (headers,) = content.glob("*.data/headers/vtk-*")
    copy = shutil.copytree(headers, folder / "headers")
    for name, (pattern, replacement) in SDKS[".".join(version.split(".")[:2])]["edits"].items():
        text, number = re.subn(pattern, replacement, (copy / name).read_text())
        if not number:
            raise SystemExit(f"{name} of the SDK has nothing like {pattern}; adapt SDKS in {Path(__file__).name}")
        (copy / name).write_text(text)
    lines, depends = _properties(headers.parent / "cmake")
    modules = [name for name in _closure(MODULES, depends) if name in lines]
    programs, cmake = _wrapper(content)
    targets = []
    for name in modules:
        library = re.search(r'library_name" "(\w+)"', "".join(lines[name]))[1]
        if name == "WrappingPythonCore":
            library += "%d.%d" % sys.version_info[:2]
        file = libraries / f"lib{library}.so"  # headers alone have none
        targets.append(_filled(MODULE, name=name, kind="SHARED" if file.exists() else "INTERFACE", headers=copy,
                               location=f'IMPORTED_LOCATION "{file}"' if file.exists() else "",
                               depends=";".join("VTK::" + each for each in depends[name])))
        targets += [line + "\n" for line in lines[name]]
    for program in programs:
        name = re.match("vtk(Wrap[A-Za-z]+)", program.name)[1]
        targets.append(f'add_executable(VTK::{name} IMPORTED)\n'
                       f'set_target_properties(VTK::{name} PROPERTIES IMPORTED_LOCATION "{program}")\n')
    (folder / "vtk-config.cmake").write_text(_filled(
        CONFIG, version=version, content=content, cmake=cmake, targets="".join(targets)))
    (folder / "vtk-config-version.cmake").write_text(
        'set(PACKAGE_VERSION "%s")\nset(PACKAGE_VERSION_COMPATIBLE TRUE)\n' % version)
    return folder
