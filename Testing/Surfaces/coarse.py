# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads the coarse and odd surfaces of coarse.txt."""

import pathlib

import numpy as np


def read_surfaces():
    """Name, points and triangles of each surface."""
    path = pathlib.Path(__file__).with_name("coarse.txt")
    lines = iter(line for line in path.read_text().splitlines() if not line.startswith("#"))
    for line in lines:
        name, points, triangles = line.split()
        yield (name, np.array([next(lines).split() for _ in range(int(points))], float),
               np.array([next(lines).split() for _ in range(int(triangles))], int))
