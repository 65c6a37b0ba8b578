#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Wheels of the VTK classes for PyPI's vtk, each built and installed into a fresh environment, beside the
PyVista of the day: results have the bits of the build for this Python's VTK.

    vtk_wheel.py FOLDER VERSION...

The module of the build for this Python's VTK is on PYTHONPATH, and meshes are in
SURFACEDIFFUSION_MESH_DIR. Needs a network and a display."""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MESHES = ["bear", "camel", "cow", "femur", "homer", "elephant-with-holes", "knot1", "mannequin-devil",
          "oblong", "double-torus-example"]

#: Properties of each filter, with few steps, and the arrays it takes by their index. Lengths are in
#: diagonals of the mesh.
FILTERS = {
    "vtkFVMHeatFilter": ({"NumberOfTimeSteps": 3}, {"f": 0, "mask": 1}),
    "vtkHarmonicMapFilter": ({}, {"vectors": 0}),
    "vtkIntrinsicTVFilter": ({"NumberOfTimeSteps": 3}, {"columns": 0}),
    "vtkMumfordShahFilter": ({"NumberOfTimeSteps": 5}, {"f": 0}),
    "vtkSurfaceCurvatureFilter": ({}, {}),
    "vtkSurfaceDenoisingFilter": ({"NoiseLevel": 1e-3}, {}),
    "vtkSurfaceDerivativesFilter": ({"Quantity": "Laplacian"}, {"f": 0}),
    "vtkSurfaceDirectionFieldFilter": ({"Method": "Smooth"}, {}),
    "vtkSurfaceDistanceFilter": ({"Method": "Eikonal"}, {"sources": 0}),
    "vtkSurfaceInterpolationFilter": ({"ComputeError": True}, {"known": 0}),
    "vtkSurfaceRandomFieldFilter": ({"NumberOfFields": 2}, {}),
    "vtkSurfaceReliefFilter": ({"Height": 0.01}, {"f": 0}),
    "vtkSurfaceSegmentationFilter": ({"NumberOfRegions": 3}, {"f": 0}),
    "vtkTensorDiffusionFilter": ({"NumberOfTimeSteps": 2}, {"columns": 0}),
    "vtkTuringTextureFilter": ({"NumberOfTimeSteps": 30, "RefineTo": 0.0}, {}),
}

BOTH_ORDERS = ("import vtk, vtkSurfaceDiffusion", "import vtkSurfaceDiffusion, vtk",
               "import pyvista, vtkSurfaceDiffusion", "import vtkSurfaceDiffusion, pyvista")

PYVISTA = """
import pyvista, vtkSurfaceDiffusion
mesh = pyvista.Icosphere(nsub=3)
mesh["f"] = mesh.points[:, 2]
heat = vtkSurfaceDiffusion.vtkFVMHeatFilter()
heat.SetInputDataObject(mesh)
heat.SetInputArrayToProcess(0, 0, 0, 0, "f")
heat.Update()
smooth = pyvista.wrap(heat.GetOutput())
assert 0.5 < abs(smooth["fDiffused"]).max() < 1, smooth
"""

REFUSED = """
import sys
try:
    import vtkSurfaceDiffusion
except ImportError as error:
    assert "%s" in str(error) and "%s" in str(error), error
    assert "libvtkSurfaceDiffusion" not in open("/proc/self/maps").read()
    sys.exit(0)
sys.exit("vtkSurfaceDiffusion was imported with another vtk")
"""


def call(*command, **variables):
    print("+", *command, flush=True)
    own = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "LD_LIBRARY_PATH")}
    subprocess.run([str(word) for word in command], check=True, env={**own, **variables})


def read_off(path):
    words = re.sub(r"#.*", "", path.read_text()).split()
    vertices, faces = int(words[1]), int(words[2])
    points = np.array(words[4:4 + 3 * vertices], float).reshape(-1, 3)
    corners, sizes, at = [], [], 4 + 3 * vertices
    for _ in range(faces):
        size = int(words[at])
        corners += words[at + 1:at + 1 + size]
        sizes.append(size)
        at += 1 + size
    return points, np.array(corners, int), np.array(sizes)


def write_cases(folder):
    """What Testing/Numpy/run_filters.py reads: every filter on every mesh."""
    folder.mkdir(parents=True)
    cases = []
    for mesh in MESHES:
        points, faces, sizes = read_off(Path(os.environ["SURFACEDIFFUSION_MESH_DIR"], mesh + ".off"))
        random = np.random.default_rng(len(points))
        n = len(points)
        diagonal = float(np.linalg.norm(np.ptp(points, axis=0)))
        columns = np.sign(np.sin(9 * points[:, :1] / diagonal)) + 0.2 * random.normal(size=(n, 3))
        known = np.where(np.arange(n) % 11 == 3, columns[:, 0], np.nan)
        arrays = {"f": columns[:, 0].copy(), "columns": columns, "known": known, "vectors": random.normal(size=(n, 3)),
                  "mask": (np.arange(n) % 17 == 3).astype(np.uint8), "sources": (np.arange(n) % 97 == 5).astype(np.uint8)}
        for name, (properties, indices) in FILTERS.items():
            np.savez(folder / f"case{len(cases)}.npz", points=points, faces=faces, sizes=sizes,
                     **{key: arrays[key] for key in indices})
            lengths = {key: properties[key] * diagonal for key in ("NoiseLevel", "Height") if key in properties}
            cases.append([name, {**properties, **lengths}, indices])
    (folder / "cases.json").write_text(json.dumps(cases))
    return len(cases)


def hashes(folder, number):
    """Of every array of every result."""
    found = {}
    for case in range(number):
        with np.load(folder / f"result{case}.npz") as arrays:
            for name in arrays.files:
                array = np.ascontiguousarray(arrays[name])
                found[case, name] = str(array.dtype), array.shape, hashlib.sha256(array.tobytes()).hexdigest()
    return found


def check_contents(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        metadata = archive.read(next(name for name in names if name.endswith("/METADATA"))).decode()
    for ending in ("/vtkSurfaceDiffusion.pyi", "/py.typed", "/LICENSE", "/NOTICE"):
        assert any(name.endswith(ending) for name in names), (ending, names)
    libraries = [name for name in names if ".so" in name]
    assert len(libraries) == 2 and all("urfaceDiffusion" in name for name in libraries), libraries
    assert not any("/include/" in name or name.endswith((".cmake", ".h")) for name in names), names
    assert "manylinux" in wheel.name and wheel.stat().st_size < 8e6, wheel
    return re.search(r"Requires-Dist: (vtk==[\d.]+\.\*)", metadata)[1]


def main(folder, versions):
    assert set(FILTERS) == {path.stem for path in ROOT.glob("Filters/vtk*Filter.h")} - {"vtkSurfaceFilter"}
    shutil.rmtree(folder, ignore_errors=True)
    number = write_cases(folder / "cases")
    runner = ROOT / "Testing/Numpy/run_filters.py"
    call(sys.executable, runner, folder / "cases", PYTHONPATH=os.environ["PYTHONPATH"])
    expected = hashes(folder / "cases", number)
    assert len(expected) > 5 * number
    programs = {}
    for version in versions:
        call(sys.executable, ROOT / "Packaging/VTK/build_wheel.py", version, "--out", folder / version)
        (wheel,) = (folder / version).glob("*.whl")
        minor = ".".join(version.split(".")[:2])
        assert check_contents(wheel) == f"vtk=={minor}.*", wheel
        programs[version] = folder / f"environment-{version}/bin"
        call(sys.executable, "-m", "venv", programs[version].parent)
        call(programs[version] / "pip", "install", "--quiet", wheel, f"vtk=={version}", "pyvista")
        python = programs[version] / "python"
        for line in BOTH_ORDERS:
            call(python, "-c", line + "; vtkSurfaceDiffusion.vtkFVMHeatFilter()")
        call(python, "-c", PYVISTA)
        for result in (folder / "cases").glob("result*.npz"):
            result.unlink()
        call(python, runner, folder / "cases")
        found = hashes(folder / "cases", number)
        different = [key for key in {*expected, *found} if expected.get(key) != found.get(key)]
        assert not different, [(cases_name(folder, case), name) for case, name in sorted(different)]
        print(f"vtk {version}: {len(found)} arrays of {number} runs have the same bits", flush=True)
        for script in ("TestModule", "TestProperties", "TestPipeline"):
            call(python, HERE / f"{script}.py")
        call(python, ROOT / "Examples/Python/pyvista_pipeline.py")
    for version, other in zip(versions, versions[1:] + versions[:1]):
        if other != version:  # its wheel with the other vtk
            (wheel,) = (folder / version).glob("*.whl")
            alone = folder / f"alone-{version}"
            call(programs[other] / "pip", "install", "--quiet", "--no-deps", "--target", alone, wheel)
            call(programs[other] / "python", "-c", REFUSED % (version, other), PYTHONPATH=str(alone))


def cases_name(folder, case):
    return json.loads((folder / "cases/cases.json").read_text())[case][0], MESHES[case // len(FILTERS)]


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), sys.argv[2:])
