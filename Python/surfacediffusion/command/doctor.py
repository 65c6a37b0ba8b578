# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command doctor: what is installed here, and whether the numerics give known results."""
from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
import time
from importlib import metadata, util

import numpy as np

from .report import number

#: What reads files, works on meshes, draws or shows progress beside this package
PACKAGES = ("nibabel", "scipy", "pyvista", "nilearn", "vtk", "vtk-surfacediffusion", "tqdm", "argcomplete")


def version():
    """The version with the commit, if a clone was built, and the compiler."""
    from .. import __version__, _core

    return f"{__version__} ({_core.build})"


def add_doctor(commands):
    commands.add(
        "doctor", doctor,
        "Show what is installed, and compare results with exact solutions: version, compiler, threads, "
        "packages that read files and meshes, VTK and ParaView. Takes about ten seconds.",
        ["", "--json > report.json"], "")


def doctor(arguments, report):
    """Raises RuntimeError if a result is wrong."""
    from .. import get_number_of_threads

    processors = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    facts = {
        "version": version(),
        "folder": os.path.dirname(os.path.dirname(os.path.abspath(__file__))),
        "python": platform.python_version(), "numpy": np.__version__,
        "system": platform.platform(), "threads": get_number_of_threads(), "processors": processors,
        "packages": {name: _version_of(name) for name in PACKAGES},
        "vtk_module": util.find_spec("vtkSurfaceDiffusion") is not None,
        "paraview": _paraview(),
    }
    report.facts.update(facts)
    report.say(f"surfacediffusion {facts['version']} in {facts['folder']}")
    report.say(f"Python {facts['python']} ({sys.executable}), NumPy {facts['numpy']}, {facts['system']}")
    report.say(f"{facts['threads']} threads on {processors} processors")
    found = facts["packages"]
    report.say("found: " + (", ".join(f"{name} {found[name]}" for name in found if found[name]) or "none"))
    missing = [name for name in found if not found[name]]
    if missing:
        report.say(f"not installed, and needed for their own files and meshes only: {', '.join(missing)}")
    report.say("the module vtkSurfaceDiffusion with the VTK classes is "
               + ("found" if facts["vtk_module"] else "not installed"))
    report.say(f"ParaView: {facts['paraview'] or 'not on the path'}")

    wrong = []
    checks = report.facts.setdefault("checks", [])
    for name, allowed, check in CHECKS:
        begin = time.perf_counter()
        error = float(check())
        seconds = time.perf_counter() - begin
        checks.append({"check": name, "error": number(error), "allowed": allowed,
                       "seconds": number(seconds)})
        if not error <= allowed:
            wrong.append(name)
        report.say(f"{'right' if error <= allowed else 'WRONG'}: {name}, error {error:.2g} of at most "
                   f"{allowed:g}, {seconds:.2f} s")
    if wrong:
        for line in () if arguments.json or arguments.quiet else report.lines:
            print(line)
        raise RuntimeError(f"wrong results here: {', '.join(wrong)}")


def _version_of(name):
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return _version_of_vtk() if name == "vtk" else None


def _version_of_vtk():
    """That of a VTK which pip does not know: of the system, or of ParaView. None without one."""
    try:
        from vtkmodules.vtkCommonCore import vtkVersion
    except ImportError:
        return None
    return vtkVersion.GetVTKVersion()


def _paraview():
    """The first line of pvpython --version; None without it."""
    program = shutil.which("pvpython")
    if program is None:
        return None
    try:
        shown = subprocess.run([program, "--version"], capture_output=True, text=True, timeout=30)
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"{program} does not start: {error}"
    lines = (shown.stdout + shown.stderr).split("\n")
    return f"{lines[0].strip()} ({program})"


def _heat():
    from .. import heat, sphere

    ball = sphere(5)
    width = 0.5  # time width^2 / (16 log 2), eigenvalue 2
    smooth = heat(ball, ball.points[:, 2], fwhm=width)
    return np.abs(smooth - np.exp(-2 * width**2 / (16 * np.log(2))) * ball.points[:, 2]).max()


def _distance():
    from .. import distance, sphere

    ball = sphere(5)
    exact = np.arccos(np.clip(ball.points @ ball.points[0], -1, 1))
    return np.abs(distance(ball, [0]) - exact).max() / np.pi


def _curvature():
    from .. import curvature, sphere

    return np.abs(curvature(sphere(4, radius=2.0)).mean / 0.5 - 1).max()


def _eigenmodes():
    from .. import eigenmodes, sphere

    exact = np.repeat([2.0, 6.0], [3, 5])
    return np.abs(eigenmodes(sphere(4), 9).eigenvalues[1:] / exact - 1).max()


def _threads():
    from .. import get_number_of_threads, intrinsic_tv, set_number_of_threads, sphere

    ball = sphere(4)
    noisy = (ball.points[:, 2] > 0.3) + 0.1 * np.random.default_rng(0).normal(size=len(ball.points))
    before = get_number_of_threads()
    try:
        set_number_of_threads(1)
        one = intrinsic_tv(ball, noisy)
        set_number_of_threads(max(before, 2))
        return np.abs(one - intrinsic_tv(ball, noisy)).max()
    finally:
        set_number_of_threads(before)


#: Name, largest error, and the function that returns the error
CHECKS = (
    ("heat flow of a spherical harmonic against exp(-2t) of it", 1e-3, _heat),
    ("distance on a sphere against great circles, of the longest", 1e-2, _distance),
    ("mean curvature of a sphere against 1/R, relative", 1e-2, _curvature),
    ("eigenvalues of a sphere against l (l + 1), relative", 1e-2, _eigenmodes),
    ("total variation on one and on several threads, whose bits are the same", 0.0, _threads),
)
