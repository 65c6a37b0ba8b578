# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The page MESH_DENOISING.md: its text and tables, written from rows of measures and read again."""
from __future__ import annotations

import datetime
import platform
import re

OURS = "SurfaceDiffusion, `denoise_mesh`"

TEXT = """# Mesh denoising beside other programs

This page is written by `Testing/Comparisons/compare_mesh_denoising.sh`, which installs the programs
and measures them side by side. Measured on {date}:
{versions}.
{kept}{missing}
{source}

The programs run with their default settings. Rows marked as tuned have the setting, of three to six,
whose result has the smallest angle to the truth. `denoise_mesh` has no such row.

Methods without a package that installs are not measured here. One is MeshTGV (Z. Liu, Y. Li, W. Wang,
L. Liu, R. Chen, IEEE TVCG 28(12), 2022), with settings for each mesh. Its released mesh for Block with
noise of 0.35 in random directions has 2.85 degrees; the 1.9 degrees for Block and 2.2 degrees for Fandisk
that its files name are those of its filtered normals.

The angle is the mean over the triangles of the angle between the normal and the true one, in degrees.
Root mean square distances of the points from the original surface are in its mean edge lengths. Then
follow the change of the volume, the numbers of triangles whose normal is more than 90 degrees off and
of those that intersect others, and the processor time in seconds, of all threads together and under
other load, on {processor}.

## Mean angles

{angles}

## All measures

{tables}
## Where another program is better

Found by the program that writes this page, with all settings of the others, tuned ones too:

{losses}
"""


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "| " + " | ".join("---" for _ in header) + " |"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def all_measures(results):
    parts = []
    for name, rows in results.items():
        parts.append(f"### {name}\n\n" + table(
            ["program", "angle", "distance", "volume", "flipped", "intersecting", "seconds"],
            [[row["program"], f"{row['angle']:.2f}", f"{row['distance']:.3f}",
              f"{100 * row['volume']:+.2f} %", str(row["flipped"]),
              "" if row["intersecting"] is None else str(row["intersecting"]),
              "" if row["program"] == "noisy" else f"{row['seconds']:.2f}"] for row in rows]))
    return "\n".join(parts)


def all_angles(results):
    programs = [row["program"] for row in next(iter(results.values()))]
    return table(["program", *results], [
        [program, *(f"{rows[number]['angle']:.1f}" for rows in results.values())]
        for number, program in enumerate(programs)])


def all_losses(results):
    lines = []
    for name, rows in results.items():
        ours = next(row for row in rows if row["program"] == OURS)
        for key in ("angle", "distance", "volume", "flipped", "intersecting", "seconds"):
            known = [row for row in rows[1:] if row[key] is not None]
            best = min(known, key=lambda row: abs(row[key]), default=ours)
            if ours[key] is not None and abs(best[key]) < abs(ours[key]):
                lines.append(f"- {name}, {key}: {best['program']}, {best[key] + 0.0:.3g} "
                             f"(`denoise_mesh`: {ours[key]:.3g})")
    return "\n".join(lines) or "nowhere"


def write_page(results, source, versions, missing, kept, path):
    """kept: the date of rows that were read from a former page; empty if there are none."""
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo")
                  if line.startswith("model name")), platform.processor())
    absent = "".join(f"{name} could not be used: {reason}.\n" for name, reason in missing.items())
    path.write_text(TEXT.format(
        date=datetime.date.today().isoformat(), versions=versions, missing=absent, source=source,
        kept=f"Rows of programs that have not changed since were measured on {kept}.\n" if kept else "",
        processor=model or "an unknown processor", angles=all_angles(results),
        tables=all_measures(results), losses=all_losses(results)))


def read_page(path):
    """The date, the versions, and the rows per mesh of a page that write_page() has written."""
    text = path.read_text()
    found = re.search(r"Measured on ([\d-]+):\n(.*?)\.\n", text, re.DOTALL)
    kept = re.search(r"since were measured on ([\d-]+)\.", text)
    results = {}
    for part in text.split("\n## All measures\n")[1].split("\n## ")[0].split("\n### ")[1:]:
        name, _, rest = part.partition("\n")
        rows = [[cell.strip() for cell in line.strip("|").split("|")]
                for line in rest.splitlines() if line.startswith("|")][2:]
        results[name] = [_row(cells) for cells in rows]
    return kept[1] if kept else found[1], found[2], results


def _row(cells):
    program, angle, distance, volume, flipped, intersecting, seconds = cells
    return {"program": program, "angle": float(angle), "distance": float(distance),
            "volume": float(volume.rstrip(" %")) / 100, "flipped": int(flipped),
            "intersecting": int(intersecting) if intersecting else None,
            "seconds": float(seconds) if seconds else 0.0}
