#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the recipe of Packaging: it can be read, names this version, and passes CMake options that
exist and with which the sources configure. Wheels for PyPI's vtk pin its version.

    recipes.py SOURCE FOLDER CMAKE VTK_DIR

Needs scikit-build-core (its wheels are in SURFACEDIFFUSION_WHEEL_DIR) and PyYAML; without them the
exit code is 77 (skipped)."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

source, folder, cmake, vtk_dir = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3], sys.argv[4]
wheels = os.environ.get("SURFACEDIFFUSION_WHEEL_DIR")
if not wheels:
    print("SURFACEDIFFUSION_WHEEL_DIR is not set")
    sys.exit(77)
try:
    import yaml
except ImportError:
    print("PyYAML is not available (Debian: python3-yaml)")
    sys.exit(77)


def load_build_backend():
    """Unpacks scikit-build-core into the folder."""
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([sys.executable, "-m", "pip", "--isolated", "install", "--quiet", "--no-index",
                    "--find-links", wheels, "--target", str(folder / "tools"), "scikit-build-core"],
                   check=True)
    sys.path.insert(0, str(folder / "tools"))


def conda_options(sources):
    """The CMake options of the recipe for conda-forge."""
    recipe = yaml.safe_load((sources / "Packaging/conda-forge/recipe.yaml").read_text())
    version = re.search(r"VERSION (\S+)", (sources / "CMakeLists.txt").read_text().split("project(")[1])
    assert recipe["context"]["version"] == version.group(1), recipe["context"]
    assert all((sources / name).exists() for name in recipe["about"]["license_file"])
    command = recipe["build"]["script"][0]
    return dict(re.findall(r"-D (\w+)=(\S+)", command))


def configure(sources, name, options):
    """Configures the sources; CMake warns of options that it does not use."""
    fixed = {"CMAKE_INSTALL_PREFIX": folder / "prefix", "Python3_EXECUTABLE": sys.executable,
             "SURFACEDIFFUSION_PYTHON_DIR": "lib/python3/site-packages"}
    command = [cmake, "-S", sources, "-B", folder / name, "-G", "Ninja", "-D", "VTK_DIR=" + vtk_dir]
    for option, value in options.items():
        command += ["-D", "%s=%s" % (option, fixed.get(option, value))]
    print(shlex.join(map(str, command)), flush=True)
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(done.stdout)
    assert done.returncode == 0, name
    unused = re.search(r"Manually-specified variables were not used.*", done.stdout, re.DOTALL)
    assert not unused or not re.search(r"SURFACEDIFFUSION_", unused.group(0)), unused.group(0)


def check_dependencies():
    """The wheel for PyPI's vtk pins vtk and its SDK; the one for this machine's VTK pins nothing."""
    os.chdir(source / "Packaging/VTK")
    from scikit_build_core.build import (
        get_requires_for_build_wheel, prepare_metadata_for_build_wheel,
    )

    for version, sdk, vtk in (("9.7", ["vtk-sdk==9.7.*"], ["vtk==9.7.*"]), ("", [], [])):
        os.environ["SURFACEDIFFUSION_PYPI_VTK"] = version
        requires = [each for each in get_requires_for_build_wheel() if "vtk" in each]
        assert requires == sdk, requires
        (folder / version).mkdir(exist_ok=True)
        name = prepare_metadata_for_build_wheel(str(folder / version))
        metadata = (folder / version / name / "METADATA").read_text()
        assert re.findall(r"Requires-Dist: (\S+)", metadata) == vtk, metadata[:600]
    os.environ.pop("SURFACEDIFFUSION_PYPI_VTK")


def check_page():
    """The page for an index: README.md without links to files, or with their addresses; the version of
    both packages and of CITATION.cff is that of CMakeLists.txt."""
    version = re.search(r"VERSION (\d\S+)", (source / "CMakeLists.txt").read_text().split("project(")[1])
    relative = re.compile(r"\]\((?!https?://|#)[^()]*\)")
    assert len(relative.findall((source / "README.md").read_text())) > 10
    sys.path.insert(0, str(source / "Packaging"))
    from pypi_page import readme_for_index

    text = "![a](b/c.png) [d](e.md#f) [g](https://h.example/i) [j](#k)"
    assert readme_for_index(text, "") == " d [g](https://h.example/i) [j](#k)"
    absolute = readme_for_index(text, "https://x.example/y/")
    assert absolute.startswith("![a](https://x.example/y/raw/main/b/c.png) "
                               "[d](https://x.example/y/blob/main/e.md#f) [g](https"), absolute
    from scikit_build_core.build import prepare_metadata_for_build_wheel

    project = (source / "pyproject.toml").read_text()
    for package in ("", "Packaging/VTK"):
        os.chdir(source / package)
        target = folder / "page" / package
        target.mkdir(parents=True)
        name = prepare_metadata_for_build_wheel(str(target))
        metadata = (target / name / "METADATA").read_text()
        assert f"\nVersion: {version.group(1)}\n" in metadata, metadata[:600]
        _, page = metadata.split("\n\n", 1)
        assert len(page) > 6000 and not relative.search(page), relative.findall(page)
        assert "License: BSD-3-Clause\n" in metadata
        assert ("Project-URL: " in metadata) == bool(re.search('^address = "."', project, re.M))
    with_address = folder / "with_address"
    (with_address / "Packaging").mkdir(parents=True)
    for name in ("README.md", "CMakeLists.txt", "LICENSE", "Packaging/pypi_page.py"):
        shutil.copy(source / name, with_address / name)
    (with_address / "pyproject.toml").write_text(
        re.sub('^address = ".*?"', 'address = "https://x.example/y"', project, flags=re.M))
    os.chdir(with_address)
    del sys.modules["pypi_page"]  # which reads the files of its repository
    sys.path.remove(str(source / "Packaging"))
    metadata = Path(prepare_metadata_for_build_wheel("."), "METADATA").read_text()
    links = dict(re.findall(r"^Project-URL: (\w+), (\S+)$", metadata, re.M))
    assert links == {"Repository": "https://x.example/y", "Issues": "https://x.example/y/issues",
                     "Changelog": "https://x.example/y/blob/main/CHANGELOG.md"}, links
    assert "](https://x.example/y/raw/main/Examples/" in metadata
    citation = yaml.safe_load((source / "CITATION.cff").read_text())
    assert citation["version"] == version.group(1), citation["version"]


def check_versions_of_wheels():
    """build_wheel.py refuses a vtk without an SDK before it fetches anything."""
    run = subprocess.run([sys.executable, source / "Packaging/VTK/build_wheel.py", "9.1.0", "--out", folder],
                         capture_output=True, text=True)
    assert run.returncode == 1 and "VERSION is 9.1.0; allowed: 9.5, 9.7" in run.stderr, run


load_build_backend()
check_versions_of_wheels()
check_dependencies()
check_page()
configure(source, "conda", conda_options(source))
print("the recipes can be read, and their options configure")
