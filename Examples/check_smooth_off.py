# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs smooth_off on a sphere and checks its numbers.

    check_smooth_off.py PROGRAM
"""

import math
import os
import subprocess
import sys
import tempfile

RADIUS, FWHM = 2.0, 1.5


def sphere(levels):
    """An octahedron, each of whose triangles is divided into four `levels` times."""
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    triangles = [(a, b, c) if (a % 2 + b % 2 + c % 2) % 2 == 0 else (a, c, b)
                 for a in (0, 1) for b in (2, 3) for c in (4, 5)]
    for _ in range(levels):
        middles, finer = {}, []

        def middle(a, b):
            key = min(a, b), max(a, b)
            if key not in middles:
                sums = [points[a][k] + points[b][k] for k in range(3)]
                middles[key] = len(points)
                points.append(tuple(x / math.hypot(*sums) for x in sums))
            return middles[key]

        for a, b, c in triangles:
            d, e, f = middle(b, c), middle(c, a), middle(a, b)
            finer += [(a, f, e), (f, b, d), (e, d, c), (d, e, f)]
        triangles = finer
    return [tuple(RADIUS * x for x in p) for p in points], triangles


def control_areas(points, triangles):
    areas = [0.0] * len(points)
    for corners in triangles:
        p, q, r = (points[i] for i in corners)
        u, v = [q[k] - p[k] for k in range(3)], [r[k] - p[k] for k in range(3)]
        normal = [u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2] for k in range(3)]
        for i in corners:
            areas[i] += math.hypot(*normal) / 6
    return areas


def write(path, lines):
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(line + "\n" for line in lines)


def main():
    points, triangles = sphere(5)
    areas = control_areas(points, triangles)
    data = [3.0 + p[2] + p[0] * p[1] for p in points]

    def total(values):
        return sum(a * u for a, u in zip(areas, values))

    with tempfile.TemporaryDirectory() as folder:
        surface, values = os.path.join(folder, "sphere.off"), os.path.join(folder, "values.txt")
        write(surface, ["OFF", "%d %d 0" % (len(points), len(triangles))]
              + [" ".join(map(repr, p)) for p in points] + ["3 %d %d %d" % t for t in triangles])
        write(values, map(repr, data))

        def smooth(*arguments):
            command = [sys.argv[1], surface, *arguments]
            return [float(u) for u in subprocess.check_output(command, text=True).split()]

        smoothed = smooth(repr(FWHM), values)
        height = smooth(repr(FWHM))
        refused = subprocess.run([sys.argv[1], surface, "-1"], stderr=subprocess.PIPE, text=True,
                                 check=False)

    assert len(smoothed) == len(points)
    kept = abs(total(smoothed) - total(data)) / total(data)
    print("the integral changes by", kept)
    assert kept < 1e-13, kept
    # Spherical harmonics of degree l decay by exp(-l (l + 1) t / R^2), t = FWHM^2 / (16 ln 2).
    time = FWHM**2 / (16 * math.log(2))
    decay = [math.exp(-degree * (degree + 1) * time / RADIUS**2) for degree in (0, 1, 2)]
    exact = [3.0 * decay[0] + decay[1] * p[2] + decay[2] * p[0] * p[1] for p in points]
    error = max(abs(u - e) for u, e in zip(smoothed, exact))
    print("largest error", error, "of changes up to",
          max(abs(f - e) for f, e in zip(data, exact)))
    assert error < 2e-3, error
    error = max(abs(u - decay[1] * p[2]) for u, p in zip(height, points))
    print("largest error of the z coordinate", error)
    assert error < 2e-3, error
    assert refused.returncode == 1 and "FWHM above 0" in refused.stderr, refused


if __name__ == "__main__":
    main()
