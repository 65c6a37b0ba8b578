#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures mesh denoising beside VTK, MeshLab, MeshLib and Open3D, and writes the page
MESH_DENOISING.md. compare_mesh_denoising.sh installs what it needs and runs this program.

    compare_mesh_denoising.py --pairs DIR     pairs of noisy and original meshes, DIR/<name>/Noisy.obj.xz
                                              and Original.obj.xz with the same faces
    compare_mesh_denoising.py --meshes DIR    meshes of libcgal-demo, to which noise is added

    compare_mesh_denoising.py --again 'SurfaceDiffusion, `denoise_mesh`' --pairs DIR

Each program runs with its default settings. Rows that are marked as tuned have the setting, of a few,
whose result is closest to the truth, which no user has."""
from __future__ import annotations

import argparse
import lzma
import os
import sys
import time
from dataclasses import dataclass
from functools import partial
from importlib import metadata
from pathlib import Path
from typing import Any, Callable

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkWindowedSincPolyDataFilter
from vtkmodules.vtkFiltersGeneral import vtkDistancePolyDataFilter

import surfacediffusion
from mesh_denoising_page import OURS, read_page, write_page

MESHES = (  # of libcgal-demo: name, kind of noise, its standard deviation in mean edge lengths
    ("fandisk", "normal", 0.3), ("fandisk", "impulsive", 0.5), ("fandisk", "sparse", 0.5),
    ("anchor_dense", "normal", 0.2), ("mech-holes-shark", "impulsive", 0.5), ("bear", "normal", 0.2),
    ("bunny00", "normal", 0.2), ("retinal", "normal", 0.2), ("elephant", "normal", 0.2))
IMPULSES = 0.5  # the share of the points that impulsive noise moves along their normals
SPARSE = 0.2  # the share of the points that sparse noise moves in any direction


@dataclass
class Mesh:
    name: str
    points: np.ndarray
    triangles: np.ndarray
    truth: np.ndarray  # points of the original


# ---- meshes --------------------------------------------------------------------------------------

def read_pairs(folder: Path) -> list[Mesh]:
    meshes = []
    for pair in sorted(path for path in folder.iterdir() if path.is_dir()):
        points, triangles = _read_obj(pair / "Noisy.obj.xz")
        truth, others = _read_obj(pair / "Original.obj.xz")
        if not np.array_equal(triangles, others):
            raise ValueError(f"{pair}: the faces of the meshes differ; allowed: the same faces")
        meshes.append(Mesh(pair.name, points, triangles, truth))
    return meshes


def _read_obj(path: Path) -> tuple[np.ndarray, np.ndarray]:
    points, triangles = [], []
    for line in lzma.decompress(path.read_bytes()).decode().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            triangles.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
    return np.array(points), np.array(triangles)


def spoil_meshes(folder: Path) -> list[Mesh]:
    meshes = []
    for name, kind, amount in MESHES:
        words = (folder / f"{name}.off").read_text().split()
        n, m = int(words[1]), int(words[2])
        truth = np.array(words[4 : 4 + 3 * n], float).reshape(n, 3)
        rows = np.array(words[4 + 3 * n : 4 + 3 * n + 4 * m], int).reshape(m, 4)
        if (rows[:, 0] != 3).any():
            raise ValueError(f"{name}.off has faces that are no triangles; allowed: triangles")
        triangles = rows[:, 1:]
        points = truth + make_noise(truth, triangles, kind, amount)
        meshes.append(Mesh(f"{name} {amount} {kind}", points, triangles, truth))
    return meshes


def make_noise(points, triangles, kind, amount):
    random = np.random.default_rng(1)
    directions = np.zeros(points.shape)
    np.add.at(directions, triangles, normals_of(points, triangles)[:, None])
    if kind == "impulsive":
        directions[random.random(len(points)) > IMPULSES] = 0
    elif kind == "sparse":
        directions = random.normal(size=points.shape)
        directions[random.random(len(points)) > SPARSE] = 0
    lengths = np.linalg.norm(directions, axis=1, keepdims=True)
    directions /= np.where(lengths > 0, lengths, 1)
    return amount * mean_edge(points, triangles) * random.normal(size=(len(points), 1)) * directions


# ---- measures ------------------------------------------------------------------------------------

def normals_of(points, triangles):
    """The normals times twice the areas."""
    a, b, c = points[triangles].swapaxes(0, 1)
    return np.cross(b - a, c - a)


def mean_edge(points, triangles):
    corners = points[triangles]
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean()


def angles_to_truth(mesh: Mesh, points):
    """Between the normals of triangles, in degrees. 90 for triangles of zero area."""
    found, wanted = (normals_of(p, mesh.triangles) for p in (points, mesh.truth))
    sizes = np.linalg.norm(found, axis=1) * np.linalg.norm(wanted, axis=1)
    cosines = (found * wanted).sum(axis=1) / np.where(sizes > 0, sizes, 1)
    return np.degrees(np.arccos(np.clip(cosines, -1, 1)))


def measure(mesh: Mesh, points, seconds):
    angles = angles_to_truth(mesh, points)
    # Places relative to a corner: volumes of meshes far from the origin would lose their digits.
    volumes = []
    for corners in (points, mesh.truth):
        a, b, c = (corners - mesh.truth.min(axis=0))[mesh.triangles].swapaxes(0, 1)
        volumes.append((a * np.cross(b, c)).sum() / 6)
    return {"angle": angles.mean(), "distance": rms_distance(mesh, points),
            "volume": volumes[0] / volumes[1] - 1, "flipped": int((angles > 90).sum()),
            "intersecting": self_intersections(mesh, points), "seconds": seconds}


def self_intersections(mesh: Mesh, points):
    """The number of triangles that intersect others, by MeshLab; None without it."""
    try:
        import pymeshlab
    except ImportError:
        return None
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(points, mesh.triangles))
    meshes.apply_filter("compute_selection_by_self_intersections_per_face")
    return int(meshes.current_mesh().face_selection_array().sum())


def rms_distance(mesh: Mesh, points):
    """Of the points to the original surface, in its mean edge lengths."""
    distance = vtkDistancePolyDataFilter()
    distance.SetInputData(0, polydata(points, mesh.triangles))
    distance.SetInputData(1, polydata(mesh.truth, mesh.triangles))
    distance.SignedDistanceOff()
    distance.ComputeSecondDistanceOff()
    distance.ComputeCellCenterDistanceOff()
    distance.Update()
    found = vtk_to_numpy(distance.GetOutput().GetPointData().GetArray("Distance"))
    return np.sqrt((found**2).mean()) / mean_edge(mesh.truth, mesh.triangles)


def polydata(points, triangles):
    coordinates, cells, data = vtkPoints(), vtkCellArray(), vtkPolyData()
    coordinates.SetData(numpy_to_vtk(np.ascontiguousarray(points, float), deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(triangles.astype(np.int64).ravel(), deep=True))
    data.SetPoints(coordinates)
    data.SetPolys(cells)
    return data


# ---- programs: each takes points and triangles, and returns points ---------------------------------

def surface_denoising(points, triangles, **settings):
    return surfacediffusion.denoise_mesh((points, triangles), **settings).points


def harmonic_map(points, triangles, **settings):
    result = surfacediffusion.harmonic_map((points, triangles), move_vertices=True, **settings)
    return result.points


def windowed_sinc(points, triangles, band=None):
    smoother = vtkWindowedSincPolyDataFilter()
    smoother.SetInputData(polydata(points, triangles))
    if band is not None:
        smoother.NormalizeCoordinatesOn()
        smoother.SetNumberOfIterations(100)
        smoother.SetPassBand(band)
    smoother.Update()
    return vtk_to_numpy(smoother.GetOutput().GetPoints().GetData())


def meshlab(points, triangles, filter_name, **settings):
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(points, triangles))
    meshes.apply_filter(filter_name, **settings)
    return meshes.current_mesh().vertex_matrix()


def meshlib(points, triangles, **settings):
    from meshlib import mrmeshnumpy, mrmeshpy

    mesh = mrmeshnumpy.meshFromFacesVerts(triangles.astype(np.int32), points.astype(np.float32))
    options = mrmeshpy.DenoiseViaNormalsSettings()
    for name, value in settings.items():
        setattr(options, name, value)
    mrmeshpy.meshDenoiseViaNormals(mesh, options)
    return mrmeshnumpy.getNumpyVerts(mesh)[: len(points)]


def open3d(points, triangles, filter_name, **settings):
    import open3d as library

    mesh = library.geometry.TriangleMesh(
        library.utility.Vector3dVector(points), library.utility.Vector3iVector(triangles))
    return np.asarray(getattr(mesh, filter_name)(**settings).vertices)


@dataclass
class Program:
    """tuned: the settings to choose from, with the truth."""

    name: str
    package: str
    run: Callable[..., Any]
    tuned: tuple[dict[str, Any], ...] = ()


TWO_STEP = partial(meshlab, filter_name="apply_coord_two_steps_smoothing")
PROGRAMS = (
    Program(OURS, "surfacediffusion", surface_denoising),
    Program("SurfaceDiffusion, `harmonic_map` with `move_vertices`", "surfacediffusion", harmonic_map,
            tuple({"time_step": step} for step in (0.03, 0.1, 0.3, 1.0, 3.0))),
    Program("VTK, windowed sinc", "vtk", windowed_sinc,
            tuple({"band": band} for band in (0.3, 0.1, 0.03, 0.01, 0.003))),
    Program("MeshLab, two-step", "pymeshlab", TWO_STEP,
            tuple({"stepsmoothnum": rounds, "normalthr": threshold}
                  for rounds in (3, 8) for threshold in (30, 60, 90))),
    Program("MeshLab, Taubin", "pymeshlab",
            partial(meshlab, filter_name="apply_coord_taubin_smoothing"),
            tuple({"stepsmoothnum": steps} for steps in (5, 20, 40, 80))),
    Program("MeshLib, by normals", "meshlib", meshlib,
            tuple({"gamma": gamma, "beta": beta}
                  for gamma in (5.0, 20.0, 60.0) for beta in (0.01, 0.03))),
    Program("Open3D, Taubin", "open3d", partial(open3d, filter_name="filter_smooth_taubin"),
            tuple({"number_of_iterations": steps} for steps in (10, 30, 100))),
    Program("Open3D, simple", "open3d", partial(open3d, filter_name="filter_smooth_simple")),
)


def compare(mesh: Mesh, programs, kept) -> list[dict[str, Any]]:
    """kept: the rows of programs that need not run again."""
    rows = [{"program": "noisy", **measure(mesh, mesh.points, 0.0)}]
    for program in programs:
        old = [row for row in kept if row["program"] in (program.name, program.name + ", tuned")]
        if old:
            rows += old
            continue
        rows.append({"program": program.name, **measure(mesh, *run(mesh, program, {}))})
        if program.tuned:
            found = [run(mesh, program, settings) for settings in program.tuned]
            best = min(found, key=lambda result: angles_to_truth(mesh, result[0]).mean())
            rows.append({"program": program.name + ", tuned", **measure(mesh, *best)})
    for row in rows:
        print(f"{mesh.name:24} {row['program']:55} {row['angle']:6.2f} {row['distance']:.4f} "
              f"{row['seconds']:.2f} s", file=sys.stderr, flush=True)
    return rows


def run(mesh: Mesh, program: Program, settings):
    """The points, and the processor time in seconds."""
    start = time.process_time()
    points = np.asarray(program.run(mesh.points, mesh.triangles, **settings), dtype=float)
    seconds = time.process_time() - start
    if points.shape != mesh.points.shape:
        raise ValueError(f"{program.name} returns {len(points)} points for {len(mesh.points)}")
    return points, seconds


def usable(program: Program, missing) -> bool:
    """Whether the program runs on a tetrahedron; the reason goes to `missing`."""
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    triangles = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    try:
        program.run(points, triangles)
        return True
    except (ImportError, OSError, AttributeError) as error:
        missing[program.package] = " ".join(str(error).split())
        return False


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=Path, default=os.environ.get("SURFACEDIFFUSION_PAIR_DIR"),
                        help="default: $SURFACEDIFFUSION_PAIR_DIR")
    parser.add_argument("--meshes", type=Path, default=os.environ.get("SURFACEDIFFUSION_MESH_DIR"),
                        help="default: $SURFACEDIFFUSION_MESH_DIR, or that of libcgal-demo")
    parser.add_argument("--only", action="append", default=[], metavar="NAME",
                        help="meshes whose names begin so")
    parser.add_argument("--again", metavar="PROGRAM",
                        help="run programs whose names begin so, and the others on new meshes only; their "
                             "other rows are those of the page")
    parser.add_argument("--page", type=Path, default=Path(__file__).parent / "MESH_DENOISING.md")
    arguments = parser.parse_args()
    if arguments.pairs:
        meshes = read_pairs(Path(arguments.pairs))
        source = ("The meshes are pairs of noisy and original ones that come with the code of Guided "
                  "Mesh Normal\nFiltering (W. Zhang, B. Deng, J. Zhang, S. Bouaziz, L. Liu, CGF 34(7), "
                  "2015); the number in a name is\nthe noise in mean edge lengths. KinectPyramid, "
                  "the scan of a depth camera, comes with the data of\nMeshTGV; its noise is "
                  "correlated over neighbouring points. It\nis open: its volume is that of the cones over "
                  "its triangles from a corner of its box.")
    elif arguments.meshes:
        meshes = spoil_meshes(Path(arguments.meshes))
        source = ("The meshes are those of libcgal-demo, with noise of this standard deviation in mean "
                  "edge lengths:\nalong the normals of all points, along those of half of them "
                  "(impulsive), or in any direction at a\nfifth of the points (sparse).")
    else:
        parser.error("--pairs or --meshes is needed")
    meshes = [mesh for mesh in meshes
              if not arguments.only or mesh.name.startswith(tuple(arguments.only))]
    missing: dict[str, str] = {}
    programs = [program for program in PROGRAMS if usable(program, missing)]
    version = {program.package: metadata.version(program.package) for program in programs}
    versions = ", ".join(f"{name} {number}" for name, number in version.items())
    date, former, kept = read_page(arguments.page) if arguments.again else ("", "", {})
    unlike = {f"{program.package} {version[program.package]}" for program in programs
              if arguments.again and not program.name.startswith(arguments.again)}
    unlike -= set(former.replace("\n", " ").split(", "))
    if unlike:
        parser.error(f"rows are kept of the versions of the page, {former}; these are "
                     + ", ".join(sorted(unlike)))
    kept = {name: [row for row in rows if not row["program"].startswith(arguments.again)]
            for name, rows in kept.items()}
    results = {mesh.name: compare(mesh, programs, kept.get(mesh.name, [])) for mesh in meshes}
    write_page(results, source, versions, missing, date, arguments.page)


if __name__ == "__main__":
    main()
