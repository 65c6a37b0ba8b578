#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the command `texture` from STL to STL: a box of 12 triangles gets a pattern and relief.

    print_texture.py [HALVINGS]

The shorter sides of the box are halved 8 times by default, which gives 1.8 million triangles; each further
time makes four times as many. Prints the seconds of each step, and those of all processors and of the
clock. It needs the package and its command in this Python, and 2 GB of memory.
"""

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from surfacediffusion.files.export import export

SIDES = np.array([100.0, 100.0, 150.0])


def box():
    """The points and the triangles of the box, oriented outwards."""
    points = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) * SIDES
    squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return points, np.array([t for a, b, c, d in squares for t in ((a, b, c), (a, c, d))])


def main():
    halvings = int(sys.argv[1]) if len(sys.argv) > 1 else 8
    # Until no diagonal of a square is longer than an eighth of the wavelength
    size = 8.01 * np.sqrt(2) * SIDES[0] / 2**halvings
    with tempfile.TemporaryDirectory() as folder:
        part, output = Path(folder, "part.stl"), Path(folder, "out.stl")
        export(part, *box())
        command = [sys.executable, "-m", "surfacediffusion.command", "texture", str(part), f"{size}mm",
                   str(output), "--relief", f"{0.1 * size}mm", "--json"]
        before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        report = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
        wall, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
        processors = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        print(f"{report['triangles']} triangles, {report['steps']} steps, {report['open_edges']} open edges, "
              f"{output.stat().st_size / 1e6:.0f} MB, {after.ru_maxrss / 1e6:.1f} GB")
        for step, seconds in report["seconds"].items():
            print(f"{step}: {seconds}")
        print(f"all: {processors:.1f} s of processors, {wall:.1f} s of the clock")


if __name__ == "__main__":
    main()
