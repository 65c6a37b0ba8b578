#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the benchmarks on one CPU and writes the results to a page.

    run_benchmarks.py BUILD [--level N] [--note TEXT]
                      [--peers DIR --peers-python PYTHON --meshes DIR] [--peers-level N]

BUILD is a build folder with SURFACEDIFFUSION_BUILD_BENCHMARKS. --peers is a folder of programs that
run other software (a run.py with the option --ours) and --peers-python a Python that can import
that software; --meshes is the folder of elephant.off and refined_elephant.off. Level 4 has 2.8
million vertices. All times are CPU times.
"""

import argparse
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from datetime import date

HERE = os.path.dirname(os.path.abspath(__file__))
STAGES = {
    "MeshAndOrder": "mesh: selection, renumbering, control areas",
    "PatternAndSlots": "matrix pattern and slot map",
    "CoefficientsAndFill": "cotan weights and assembly",
    "Refill": "reassembly",
    "Product/columns:1": "matrix-vector product, 1 column",
    "Product/columns:3": "matrix-vector product, 3 columns",
    "SetUp/Direct": "Cholesky: ordering and factorisation",
    "SetUpAgain/Direct": "Cholesky: factorisation",
    "SetUp/Multigrid": "multigrid: set-up",
    "Step/BackwardEuler": "backward Euler step, 1 h²",
    "Step/SDIRK2": "SDIRK2 step, 1 h²",
    "ToAThousandth/BackwardEuler": "backward Euler steps to an error of 1e-3",
    "ToAThousandth/SDIRK2": "SDIRK2 steps to an error of 1e-3",
    "Core100Steps": "100 SDIRK2 steps in the core, with history",
    "Filter100Steps": "the same in the filter",
    "TimeSeek": "seek to another time of that run",
}
MODELS = ("FindExactDistances|MarchDistances|MinimizeToGap|MinimizeAllData|FlowOfSteps|PaperSteps|SegmentToGap|DenoiseColors/s:6|DeblurBy.*/s:6|FindEdges|"
          "ExtractCurves|LaggedStep/.*:3$|ChannelStep|TenSteps/[56]/[12]/1|^Step/mesh:[13]|"
          "Stands/mesh:[13]")
PRECISION = {
    "product": ("ProductIn/double", "ProductIn/single"),
    "conjugate gradients to 1e-10, 100 h²": ("SolveIn/double", "SolveIn/single"),
    "total variation: update of the gradients": ("UpdateIn<double>", "UpdateIn<float>"),
}
NOTED = {"vertices", "Gap", "Iterations", "Error", "steps", "time", "step_over_solves",
         "degrees_before", "degrees_after", "Worst", "Median"}


def run(command, **options):
    print("+", " ".join(command), file=sys.stderr, flush=True)
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, **options).stdout


def number(value):
    return "" if value is None else f"{value:.3g}" if value < 1000 else f"{value:.0f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| --- " * len(head) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n\n"


def exponent(times):
    """Slope of log(time) over log(vertices), by least squares."""
    points = [(math.log(n), math.log(t)) for n, t in times.items()]
    if len(points) < 2:
        return None
    x, y = (sum(p[k] for p in points) / len(points) for k in (0, 1))
    return sum((p[0] - x) * (p[1] - y) for p in points) / sum((p[0] - x) ** 2 for p in points)


class Results:
    """The rows of the benchmark program: milliseconds by name and number of vertices."""

    def __init__(self, rows):
        self.times, self.bandwidth, self.triad = {}, {}, {}
        for row in rows:
            name = re.sub("/(process_time|iterations:1)", "", row["name"])
            if name.startswith("Triad"):
                self.triad[int(name.split(":")[1])] = row["GB/s"]
                continue
            name = re.sub("/level:[0-9]+", "", name)
            n = int(row["vertices"])
            unit = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[row["time_unit"]]
            self.times.setdefault(name, {})[n] = row["cpu_time"] * unit
            if "bytes" in row:
                passes = max(1, row["iterations"]) if "Gradient" in name else 1  # solver
                self.bandwidth.setdefault(name, {})[n] = (row["GB/s"], row["bytes"] / passes)
        self.sizes = sorted(self.times["MeshAndOrder"])

    def share(self, name):
        """The bandwidth on the largest surface, relative to the triad on data of the same size."""
        if name not in self.bandwidth:
            return ""
        speed, size = self.bandwidth[name][max(self.bandwidth[name])]
        near = min(self.triad, key=lambda mib: abs(math.log(mib * 2**20 / size)))
        return f"{100 * speed / self.triad[near]:.0f} %"

    def row(self, title, name):
        times = self.times.get(name, {})
        slope = exponent(times)
        return ([title] + [number(times.get(n)) for n in self.sizes]
                + ["" if slope is None else f"{slope:.2f}", self.share(name)])


def stages(results):
    head = ["ms"] + [f"{n:,}" for n in results.sizes] + ["exponent", "of bandwidth"]
    rows = []
    for name, title in STAGES.items():
        full = next((key for key in results.times
                     if key == name or key.startswith(name + "/c:")), name)
        rows.append(results.row(title, full))
    return table(head, rows)


def solvers(results):
    head = ["ms"] + [f"{n:,}" for n in results.sizes] + ["exponent", "of bandwidth"]
    rows = []
    for name in results.times:
        found = re.fullmatch(r"Solve/(\w+)/c:(\d+)/columns:(\d)", name)
        if found:
            method, tenths, columns = found.groups()
            title = f"{method}, {int(tenths) / 10:g} h², {columns} column"
            rows.append(results.row(title + ("s" if columns != "1" else ""), name))
    return table(head, rows)


def precisions(results):
    """Milliseconds in double and in single precision, and their ratio."""
    sizes = sorted(results.times["ProductIn/double"])
    rows = []
    for title, names in PRECISION.items():
        double, single = (results.times[name] for name in names)
        rows.append([title] + [f"{number(double[n])} / {number(single[n])} = {double[n] / single[n]:.2f}"
                               for n in sizes])
    return table(["ms"] + [f"{n:,}" for n in sizes], rows)


def models(rows):
    """The table of the other models' benchmarks, one surface each."""
    body = []
    for row in rows:
        name = re.sub("/(process_time|real_time|iterations:1)", "", row["name"])
        unit = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[row["time_unit"]]
        notes = ", ".join(f"{key} {row[key]:.4g}" for key in row if key in NOTED)
        body.append([name, number(row["cpu_time"] * unit), number(row["real_time"] * unit), notes])
    return table(["run", "CPU ms", "elapsed ms", ""], body)


def iterations(rows):
    """Iterations of conjugate gradients, with the diagonal alone and with lines."""
    numbers = sorted({row["c"] for row in rows})
    surfaces = {}
    for row in rows:
        surfaces.setdefault(row["surface"], []).append(row)
    body = []
    for name, of_surface in surfaces.items():
        counts = {row["c"]: f"{row['diagonal']} → {row['lines']}" if row["on_lines"] > 0.0
                  else str(row["lines"]) for row in of_surface}
        shares = max(row["on_lines"] for row in of_surface)
        body.append([name, f"{of_surface[0]['vertices']:,}", f"{shares:.2f}"]
                    + [counts[c] for c in numbers])
    return table(["surface", "vertices", "on lines"] + [f"{c:g} h²" for c in numbers], body)


def choices(rows):
    steps = sorted({row["steps"] for row in rows})
    cells = {}
    for row in rows:
        cells.setdefault((row["vertices"], row["c"]), {})[row["steps"]] = row
    letters = {"Direct": "D", "ConjugateGradient": "C", "Multigrid": "M"}
    head = ["vertices", "Δt/h²"] + ["1 step" if k == 1 else f"{k} steps" for k in steps]
    body = [[f"{n:,}", f"{c:g}"] + [f"{letters[cell[k]['chosen']]} {cell[k]['ratio']:.2f}"
            for k in steps] for (n, c), cell in cells.items()]
    good = sum(row["ratio"] <= 1.3 for row in rows)
    return table(head, body) + f"At most 1.3 times the fastest in {good} of {len(rows)} cells.\n\n"


def libraries(rows, solves):
    """Milliseconds of the set-up and some solves with each solver, per step size and columns, and
    the time of the solver that Automatic begins with over each."""
    text = ""
    cases = sorted({(row["c"], row["columns"]) for row in rows})
    sizes = sorted({row["vertices"] for row in rows})
    ratios = []
    for c, columns in cases:
        times, selected = {}, {}
        for row in rows:
            if (row["c"], row["columns"]) == (c, columns):
                total = row["setup"] + solves * row["solve"]
                times.setdefault(row["solver"], {})[row["vertices"]] = total
                if row.get(f"selected{solves}"):
                    selected[row["vertices"]] = total
        body = [[solver] + [f"{number(of[n])} ({selected[n] / of[n]:.2f})" if n in of else ""
                            for n in sizes] for solver, of in times.items()]
        ratios += [selected[n] / min(of[n] for of in times.values() if n in of) for n in sizes]
        text += (f"Δt = {c:g} h², {columns} column{'s' if columns > 1 else ''}:\n\n"
                 + table(["ms"] + [f"{n:,}" for n in sizes], body))
    good = sum(ratio <= 1.3 for ratio in ratios)
    return text + ("The solver that Automatic begins with takes at most 1.3 times the fastest in "
                   f"{good} of {len(ratios)} cases.\n\n")


def peers(options, program, folder):
    """The rows of the peers' program, which include ours."""
    specs = ["elephant.off+1", "refined_elephant.off", "refined_elephant.off+1",
             "refined_elephant.off+2"][:options.peers_level + 1]
    run([options.peers_python, os.path.join(options.peers, "run.py"), "--mesh-dir", options.meshes,
         "--meshes", *specs, "--tasks", "1", "--ours", program, "--out", folder, "--limit", "60",
         "--peers", *options.names])
    with open(os.path.join(folder, "task1.json"), encoding="utf-8") as file:
        return json.load(file)


def peers_table(rows, steps):
    """The tables of one solve: milliseconds of set-up and solution, and our time over each."""
    text = ""
    for c in steps:
        first = {}
        for row in rows:
            # a factorisation costs the same for every time step
            direct = row["peer"].startswith("libigl +") and c != row.get("c")
            if row.get("solve_s") is None or (row.get("c") != c and not direct):
                continue
            if direct and any(r.get("peer") == row["peer"] and r.get("mesh") == row["mesh"]
                              and r.get("c") == c for r in rows):
                continue
            seconds = (row.get("setup_s") or 0.0) + row["solve_s"]
            first.setdefault(row["peer"], {})[row["n"]] = (1e3 * seconds, row)
        sizes = sorted({n for times in first.values() for n in times})
        body = []
        for peer, times in first.items():
            if not set(times) & set(first["ours"]):
                continue
            cells = []
            for n in sizes:
                if n not in times:
                    cells.append("")
                elif peer == "ours":
                    cells.append(f"{number(times[n][0])} ({times[n][1]['version']})")
                else:
                    ratio = first["ours"][n][0] / times[n][0] if n in first["ours"] else math.nan
                    cells.append(f"{number(times[n][0])} ({ratio:.2f})")
            body.append([peer] + cells)
        text += f"Δt = {c:g} h²:\n\n" + table(["ms"] + [f"{n:,}" for n in sizes], body)
    return text


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        model = next((line.split(":")[1].strip() for line in file if "model name" in line), "?")
    return f"{model}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}, {date.today()}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build")
    parser.add_argument("--level", type=int, default=4)
    parser.add_argument("--peers")
    parser.add_argument("--peers-level", type=int, default=3)
    parser.add_argument("--peers-python", default=sys.executable)
    parser.add_argument("--names", nargs="+", help="names of the peers to run",
                        default=["igl_cholmod", "cg_jacobi", "pyamg_sa", "robust_cholmod"])
    parser.add_argument("--meshes", default=".")
    parser.add_argument("--note", default="")
    parser.add_argument("--out", default=os.path.join(HERE, "RESULTS.md"))
    options = parser.parse_args()
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})

    def program(name):
        return os.path.join(options.build, "bin", name)

    keep = f"MiB|level:[0-{options.level}]"
    rows = json.loads(run([program("SurfaceDiffusionBenchmarks"), "--benchmark_format=json",
                           "--benchmark_min_time=0.1", f"--benchmark_filter={keep}"]))["benchmarks"]
    results = Results(rows)
    of_models = json.loads(run([program("SurfaceDiffusionBenchmarks"), "--benchmark_format=json",
                                "--benchmark_min_time=0.1", "--benchmark_filter=" + MODELS]))
    grid = [json.loads(line) for line in
            run([program("CompareSolvers"), str(min(options.level, 3))]).splitlines()]
    counted = [json.loads(line) for line in run([program("CountIterations")]).splitlines()]
    shares = [json.loads(line) for line in
              run([program("MeasureSerialShare"), str(min(options.level, 3))]).splitlines()]
    compared_libraries = []
    if os.path.exists(program("CompareLibraries")):
        compared_libraries = [json.loads(line) for line in run(
            [program("CompareLibraries"), str(min(options.level, 3))]).splitlines()]
    page = ("# Measured times\n\nWritten by `run_benchmarks.py`: CPU time on one thread. "
            f"{machine()}. {options.note}\n\n"
            "Memory bandwidth (triad, 24 bytes per entry): "
            + ", ".join(f"{speed:.0f} GB/s at {mib} MiB" for mib, speed in results.triad.items())
            + ".\n\n## Stages\n\nOne scanned surface, subdivided. The exponent is the slope of "
            "log(time) over log(vertices). Of bandwidth: the minimum memory traffic of a stage per "
            "time, relative to the triad on data of the same size.\n\n" + stages(results)
            + "## Linear solves from noise to a residual of 1e-10\n\n" + solvers(results)
            + "## Narrow triangles\n\nIterations of conjugate gradients from noise to a residual of 1e-6, "
            "by `CountIterations`: with the diagonal alone → with lines (`StrongLines`), where there are "
            "any. On lines: the largest share of the vertices that are. What is left on the contour and "
            "the torus are triangles narrower than 1 : 1000, which lines leave alone, as single precision "
            "could not resolve them: `Automatic` gives them to multigrid or to a factorisation.\n\n"
            + iterations(counted)
            + "## What single precision gains\n\nThe same work in double precision on compressed "
            "rows and in single precision on slices of 16 rows or triangles, one column.\n\n"
            + precisions(results)
            + "## Other models\n\nTotal variation (MinimizeToGap: the minimiser, FlowOfSteps: the "
            "minimiser in steps of a flow, LaggedStep: one step of the paper's scheme, PaperSteps: "
            "ten of them on a scanned surface, ChannelStep: one for all channels, of total variation, "
            "the Beltrami flow or coherence-enhancing diffusion) and harmonic maps (TenSteps) on icospheres of 10 4^s + 2 "
            "vertices, edges (FindEdges: the whole run, ExtractCurves) and textures (Step: one step, "
            "Stands: until the pattern is stationary) on a scanned surface.\n\n" + models(of_models["benchmarks"])
            + "## What threads do not make faster\n\nThe share of the time on one thread that is "
            "outside of parallel loops, by `MeasureSerialShare`; loops over a few long tasks count "
            f"with the longest one. {int(shares[0]['vertices']):,} vertices.\n\n"
            + table(["stage", "ms", "serial"], [[row["stage"], number(row["ms"]),
                                                 f"{100 * row['serial']:.1f} %"] for row in shares])
            + "## The solver that Automatic selects\n\nRuns of backward Euler steps: the solver that "
            "Automatic begins with (D: Direct, C: ConjugateGradient, M: Multigrid) and the time of "
            "its run over that of the fastest.\n\n"
            + choices(grid))
    for solves in (1, 10) if compared_libraries else ():
        page += (f"## {solves} step{'s' if solves > 1 else ''} with the solvers of other libraries\n\n"
                 "Set-up and solves to a residual of 1e-10, by `CompareLibraries`. In brackets: the "
                 "solver that Automatic begins with over this one. Where that forecasts too many "
                 "iterations, Automatic changes over to the next, as in the section before.\n\n"
                 + libraries(compared_libraries, solves))
    if options.peers:
        with tempfile.TemporaryDirectory() as folder:
            compared = peers(options, program("HeatStep"), folder)
        page += ("## Comparison with other software\n\nOne step to a residual of 1e-8: set-up "
                 "(factorisation or multigrid hierarchy) and solution together, without the "
                 "assembly. In brackets: our time over theirs.\n\n"
                 + peers_table(compared, (1.0, 100.0, 1e4)))
        assembly = {(r["peer"], r["n"]): r["assembly_s"] for r in compared if r.get("assembly_s")}
        names = sorted({peer for peer, _ in assembly if peer == "libigl + CHOLMOD"
                        or peer.startswith("robust")})
        ours = [results.times["CoefficientsAndFill"], results.times["PatternAndSlots"],
                results.times["MeshAndOrder"]]
        body = [["cotan weights and assembly"] + [number(ours[0][n]) for n in results.sizes],
                ["with mesh, renumbering and pattern"]
                + [number(sum(times[n] for times in ours)) for n in results.sizes]]
        body += [[peer] + [number(1e3 * assembly[peer, n]) if (peer, n) in assembly else ""
                           for n in results.sizes] for peer in names]
        page += "Assembly:\n\n" + table(["ms"] + [f"{n:,}" for n in results.sizes], body)
    with open(options.out, "w", encoding="utf-8") as file:
        file.write(page.rstrip() + "\n")


if __name__ == "__main__":
    main()
