#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures this package beside Connectome Workbench, CAT and nilearn, and writes the page README.md
and the picture of the project's README. compare.sh installs what it needs and runs this program."""
from __future__ import annotations

import argparse
import datetime
import json
import os
import statistics
import platform
import sys
import tempfile
from pathlib import Path

import numpy as np
import page
import peers
import reference
from surfaces import make_grayordinates, make_samples, write_columns

PEERS = ("SurfaceDiffusion", "Workbench", "CAT", "nilearn")
MISSING = 0.2


def measure_widths(samples, chosen, asked, results):
    """The width that each program realises, by the decay of 12 eigenfunctions."""
    for sample in samples:
        eigenvalues, functions, mass = reference.eigenfunctions(sample.points, sample.faces, 12)
        for fwhm in asked:
            for peer in chosen:
                smoothed = peers.smooth(peer, sample, functions, fwhm)
                widths = reference.realised_widths(smoothed, eigenvalues, functions, mass)
                results.append({"surface": sample.name, "fwhm": fwhm, "peer": peer,
                                "width": np.median(widths),
                                "low": widths.min(), "high": widths.max()})


def measure_errors(samples, chosen, asked, results):
    """Relative error in L2 against a fine solution, and the change of the integral."""
    for sample in samples:
        _, areas = reference.matrices(sample.points, sample.faces)
        values = np.column_stack(list(sample.maps.values()))
        for fwhm in asked:
            exact = reference.diffuse(sample.points, sample.faces, values, fwhm)
            for peer in chosen:
                smoothed = peers.smooth(peer, sample, values, fwhm)
                for i, name in enumerate(sample.maps):
                    error = np.sqrt(areas @ (smoothed - exact)[:, i]**2 / (areas @ exact[:, i]**2))
                    size = areas @ np.abs(values[:, i])
                    integral = areas @ (smoothed - values)[:, i] / size
                    results.append({"surface": sample.name, "map": name, "fwhm": fwhm,
                                    "peer": peer, "error": error, "integral": integral})


def measure_missing(samples, chosen, results, fwhm=10):
    """A fifth of the values of each map, chosen at random, is missing. Compared inside the region
    with what the same program gives for all values."""
    for sample in samples:
        if sample.region is None:
            continue
        lost = sample.region & (np.random.default_rng(5).random(len(sample.points)) < MISSING)
        for name, values in sample.maps.items():
            holes = np.where(lost, np.nan, values)
            for peer in chosen:
                full, part = _smooth_with_holes(peer, sample, values, holes, lost, fwhm)
                inside = sample.region
                results.append({
                    "surface": sample.name, "map": name, "peer": peer,
                    "rms": float(np.sqrt(np.mean((part - full)[inside]**2))),
                    "mean": float(part[inside].mean()), "mean_full": float(full[inside].mean()),
                    "mean_input": float(values[inside].mean())})


def _smooth_with_holes(peer, sample, values, holes, lost, fwhm):
    """The results for all values and for those with holes, in the way the program has for it."""
    inside = sample.region
    if peer == "SurfaceDiffusion":
        return [peers.ours(sample.points, sample.faces, data, fwhm, mask=~inside)
                for data in (values, holes)]
    if peer == "Workbench":
        # Its word for missing is zero; a map may hold real zeros, which -fix-zeros drops too.
        with tempfile.TemporaryDirectory() as folder:
            roi = write_columns(Path(folder) / "roi.func.gii", inside)
            return [peers.workbench(sample.path, data, fwhm, *options) for data, options in (
                (np.where(inside, values, 0), ("-roi", roi)),
                (np.where(lost | ~inside, 0, values), ("-roi", roi, "-fix-zeros")))]
    return [peers.smooth(peer, sample, data, fwhm) for data in (values, holes)]


def measure_costs(sample, chosen, columns, rounds, results, folder):
    """Time and memory of whole processes, and processor time without input and output: the medians
    over rounds, in each of which all programs run after another. 60 columns and 4 mm are those of many
    functional images."""
    data = folder / "columns.func.gii"
    output = folder / "out.func.gii"
    random = np.random.default_rng(6)
    for count, fwhm in ((1, 10), (min(60, columns), 4), (columns, 10)):
        values = random.normal(size=(len(sample.points), count))
        # CAT smooths one map at a time: its time for many is that for a tenth, times ten.
        shares = {peer: 10 if peer == "CAT" and count >= 100 else 1 for peer in chosen}
        measured = {peer: [] for peer in chosen}
        for _ in range(rounds):
            for peer, share in shares.items():
                write_columns(data, values[:, :count // share])
                cost = peers.run(peers.process_command(peer, sample.path, data, fwhm, output))
                if peer == "Workbench":
                    # A process that reads and writes the same columns.
                    copy = peers.run(["wb_command", "-metric-math", "x", output, "-var", "x", data])
                    alone = cost.cpu - copy.cpu
                else:
                    alone = float(cost.output.split()[-1])
                measured[peer].append({"wall": share * cost.wall, "cpu": share * cost.cpu,
                                       "memory": cost.memory, "alone": share * alone})
                output.unlink()
        for peer, found in measured.items():
            medians = {name: statistics.median(row[name] for row in found) for name in found[0]}
            results.append({"columns": count, "fwhm": fwhm, "peer": peer, "share": shares[peer],
                            **medians, "rounds": [row["alone"] for row in found]})
    data.unlink()


def measure_cifti(chosen, columns, rounds, results, folder, fwhm=4):
    """The medians of whole processes that smooth a time series of 91,282 grayordinates, on surfaces and
    among voxels, by the programs that do."""
    chosen = [peer for peer in chosen if peer in peers.OF_CIFTI]
    output = folder / "out.dtseries.nii"
    for count in (min(60, columns), columns):
        data, surfaces = make_grayordinates(folder, count)
        measured = {peer: [] for peer in chosen}
        for _ in range(rounds):
            for peer in chosen:
                cost = peers.run(peers.OF_CIFTI[peer](data, fwhm, output, *surfaces))
                measured[peer].append({"wall": cost.wall, "cpu": cost.cpu, "memory": cost.memory})
                output.unlink()
        results += [{"columns": count, "fwhm": fwhm, "peer": peer, "file": data.stat().st_size,
                     **{name: statistics.median(row[name] for row in found) for name in found[0]}}
                    for peer, found in measured.items()]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--columns", type=int, default=1200, help="of the time series")
    parser.add_argument("--rounds", type=int, default=3, help="of the measurement of times")
    parser.add_argument("--widths", type=float, nargs="+", default=[6, 10, 20], metavar="MM",
                        help="asked for; 10 must be among them")
    parser.add_argument("--only", action="append", choices=("widths", "errors", "missing", "costs", "cifti"),
                        help="measure these parts; the others keep their last results")
    parser.add_argument("--peer", action="append", choices=PEERS,
                        help="measure these programs; the others keep their last results")
    parser.add_argument("--results", type=Path, default=Path("build-comparisons/results.json"),
                        help="where the measurements are kept")
    parser.add_argument("--page", type=Path, default=Path(__file__).parent / "README.md")
    parser.add_argument("--picture", type=Path,
                        default=Path(__file__).parents[2] / "Examples/Gallery/comparison.png")
    arguments = parser.parse_args()

    chosen = arguments.peer or PEERS
    results = {}
    if arguments.results.exists():
        results = json.loads(arguments.results.read_text())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        samples = make_samples(folder)
        parts = {
            "widths": lambda rows: measure_widths(samples, chosen, arguments.widths, rows),
            "errors": lambda rows: measure_errors(samples, chosen, arguments.widths, rows),
            "missing": lambda rows: measure_missing(samples, chosen, rows),
            "costs": lambda rows: measure_costs(
                samples[2], chosen, arguments.columns, arguments.rounds, rows, folder),
            "cifti": lambda rows: measure_cifti(
                chosen, arguments.columns, arguments.rounds, rows, folder)}
        for part in arguments.only or parts:
            print(f"measuring {part}", file=sys.stderr)
            rows = [row for row in results.get(part, []) if row["peer"] not in chosen]
            parts[part](rows)
            results[part] = rows
            results["machine"] = _machine()
            arguments.results.parent.mkdir(parents=True, exist_ok=True)
            arguments.results.write_text(json.dumps(results, indent=1, default=float))
    if all(any(row["peer"] == peer for row in results.get(part, []))
           for part in parts for peer in (peers.OF_CIFTI if part == "cifti" else PEERS)):
        page.write_page(results, arguments.page)
        page.draw(results, arguments.picture)
    else:
        print("no page: not every program was measured in every part", file=sys.stderr)


def _machine():
    from importlib import metadata

    workbench = peers.run(["wb_command", "-version"]).output
    version = next(line.split()[-1] for line in workbench.splitlines() if "Version:" in line)
    installed = {found.metadata["Name"]: found.version for found in metadata.distributions()}
    versions = {name: installed.get(package, "") for name, package in (
        ("SurfaceDiffusion", "surfacediffusion"), ("CAT", "cat-surf"), ("nilearn", "nilearn"))}
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo")
                  if line.startswith("model name")), platform.processor())
    return {"processor": model, "cores": os.cpu_count(),
            "date": datetime.date.today().isoformat(),
            "versions": {**versions, "Workbench": version}}


if __name__ == "__main__":
    main()
