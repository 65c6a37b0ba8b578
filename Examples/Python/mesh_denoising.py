# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Remove the noise of the points of a CAD shape, of a scan, and impulsive noise of a CAD shape.

    mesh_denoising.py

The points of three surfaces get noise whose standard deviation is a fraction of the mean edge length
h: Gaussian noise along the normals, of all points or, impulsive noise, of half of them.
vtkSurfaceDenoisingFilter, without any setting, measures the noise and removes it.
vtkWindowedSincPolyDataFilter, a low-pass filter, has the pass band, of five, whose result is closest
to the truth, which no user knows. On a smooth shape it is nearly as close as mesh denoising, but it
rounds edges.

The program prints the mean angle between the normals of the triangles and the true ones, the root
mean square distance of the points from their true places, and the change of the volume. It fails
unless the angle is below that of the low-pass filter times the factor in SURFACES, the volume stays
within a half percent, and no more triangles are flipped than before. It writes
mesh_denoising.png, coloured by the angle in bands of five degrees.

The surfaces are those of libcgal-demo in the folder SURFACEDIFFUSION_MESH_DIR. If that is not set,
there are two examples, on a cube.

Try next: SetNoiseLevel(), if too little or too much is removed; SetSurfaceTypeToOrganic() for the CAD
shape, which rounds its edges.
"""
import os
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pictures import Panel, colour_table, display_missing, save_picture
from surface_data import (
    DataError, make_surface, mean_edge_length, points_of, read_mesh, refined, triangles_of,
    with_arrays)
from vtkmodules.vtkFiltersCore import vtkWindowedSincPolyDataFilter

from vtkSurfaceDiffusion import vtkSurfaceDenoisingFilter

PASS_BANDS = (0.3, 0.1, 0.03, 0.01, 0.003)
LARGEST_ANGLE = 20  # of the colours, in degrees
LARGEST_VOLUME_CHANGE = 0.005
COLOURS = [(0.93, 0.93, 0.91), (0.55, 0.75, 0.85), (0.97, 0.72, 0.35), (0.62, 0.10, 0.20)]


@dataclass
class Example:
    mesh: str
    title: str
    noise: float            # standard deviation, in mean edge lengths
    share: float            # of the points that have noise
    factor: float           # largest share of the low-pass filter's angle that remains
    view: tuple
    up: tuple


SURFACES = (
    Example("anchor_dense", "CAD", 0.2, 1.0, 0.4, (0.5, 0.5, 1), (0, 1, 0)),
    Example("bear", "scan", 0.2, 1.0, 1.0, (0, 0, 1), (0, 1, 0)),
    Example("fandisk", "impulses", 0.5, 0.5, 0.35, (-0.6, 0.5, 1), (0, 1, 0)),
)


def box():
    """A cube of 6,146 points."""
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([(q[0], q[i], q[i + 1]) for q in quads for i in (1, 2)])
    return refined(make_surface(corners, triangles), 5_000)


def normals_of(points, triangles):
    """The normals of the triangles times twice their areas."""
    a, b, c = points[triangles].swapaxes(0, 1)
    return np.cross(b - a, c - a)


def unit(vectors):
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / np.where(lengths > 0, lengths, 1)


def with_noise(surface, example):
    """The surface with noise of its points."""
    random = np.random.default_rng(1)
    points, triangles = points_of(surface), triangles_of(surface)
    directions = np.zeros(points.shape)
    np.add.at(directions, triangles, normals_of(points, triangles)[:, None])
    directions = unit(directions)
    directions[random.random(len(points)) > example.share] = 0
    amount = example.noise * mean_edge_length(surface) * random.normal(size=(len(points), 1))
    return make_surface(points + amount * directions, triangles)


def output_points(model, surface):
    model.SetInputData(surface)
    model.Update()
    return points_of(model.GetOutput()).astype(float)


def low_pass(surface, band):
    model = vtkWindowedSincPolyDataFilter()
    model.SetPassBand(band)
    model.SetNumberOfIterations(100)
    model.NormalizeCoordinatesOn()
    model.FeatureEdgeSmoothingOff()
    return output_points(model, surface)


class Truth:
    """The original surface, and the measures of others against it."""

    def __init__(self, surface):
        self.points, self.triangles = points_of(surface).astype(float), triangles_of(surface)
        self.normals = unit(normals_of(self.points, self.triangles))

    def angles(self, points):
        """Between the normals of the triangles and the true ones, in degrees."""
        normals = unit(normals_of(points, self.triangles))
        return np.degrees(np.arccos(np.clip((normals * self.normals).sum(axis=1), -1, 1)))

    def volume(self, points):
        a, b, c = points[self.triangles].swapaxes(0, 1)
        return (a * np.cross(b, c)).sum() / 6

    def describe(self, name, points):
        angles = self.angles(points)
        distance = np.sqrt(((points - self.points) ** 2).sum(axis=1).mean())
        change = self.volume(points) / self.volume(self.points) - 1
        print(f"  {name:24} mean angle {angles.mean():5.2f} degrees, distance {distance:.2e}, "
              f"volume {100 * change:+.2f} %, {np.sum(angles > 90)} flipped")


def faceted(points, triangles, angles):
    """The triangles with points of their own, so that each has its normal and its colour."""
    normals = unit(normals_of(points, triangles))
    separate = make_surface(points[triangles].reshape(-1, 3),
                            np.arange(3 * len(triangles)).reshape(-1, 3))
    separate = with_arrays(separate, Normals=np.repeat(normals, 3, axis=0).astype(np.float32),
                           angle=np.repeat(angles, 3))
    separate.GetPointData().SetActiveNormals("Normals")
    return separate


def check(example, truth, noisy, filtered, denoised):
    """Raises AssertionError unless the filter does what the picture is to show."""
    least = example.factor * truth.angles(filtered).mean()
    angle = truth.angles(denoised).mean()
    assert angle < least, f"{example.mesh}: {angle:.2f} degrees; wanted: below {least:.2f}"
    change = truth.volume(denoised) / truth.volume(truth.points) - 1
    assert abs(change) < LARGEST_VOLUME_CHANGE, f"{example.mesh}: the volume changes by {change:.2%}"
    before, after = (np.sum(truth.angles(points) > 90) for points in (noisy, denoised))
    assert after <= before, f"{example.mesh}: {after} flipped triangles, {before} before"


def draw(example, surface, table):
    truth = Truth(surface)
    noisy = with_noise(surface, example)
    print(f"{example.mesh}: {noisy.GetNumberOfPoints():,} points, noise of {example.noise} h"
          + (f" at {example.share:.0%} of the points" if example.share < 1 else ""))
    filtered = min((low_pass(noisy, band) for band in PASS_BANDS),
                   key=lambda points: truth.angles(points).mean())
    model = vtkSurfaceDenoisingFilter()
    denoised = output_points(model, noisy)
    given = points_of(noisy).astype(float)
    columns = [(f"{example.title}, noisy", given), ("best windowed sinc", filtered),
               ("surface denoising", denoised)]
    for name, points in columns:
        truth.describe(name, points)
    level = model.GetEffectiveNoiseLevel() / mean_edge_length(surface)
    kind = ("mixed", "CAD", "organic")[model.GetEffectiveSurfaceType()]
    print(f"  found: {kind}, noise of {level:.3f} h")
    check(example, truth, given, filtered, denoised)
    panels = []
    for name, points in columns:
        angles = truth.angles(points)
        panels.append(Panel(faceted(points, truth.triangles, angles), "angle", name,
                            f"mean angle {angles.mean():.1f} degrees", example.view, example.up,
                            table=table, bar=example is SURFACES[-1]))
    return panels


def main():
    folder = os.environ.get("SURFACEDIFFUSION_MESH_DIR")
    table = colour_table(0, LARGEST_ANGLE, COLOURS, steps=LARGEST_ANGLE // 5)
    panels = []
    for example in SURFACES:
        if folder:
            panels += draw(example, read_mesh(Path(folder) / f"{example.mesh}.off"), table)
        elif example.title != "scan":
            panels += draw(example, box(), table)
    if display_missing():
        print("no picture: there is no display")
    else:
        save_picture("mesh_denoising.png", panels, 3, (440, 400))


if __name__ == "__main__":
    try:
        main()
    except (AssertionError, DataError, OSError) as problem:
        sys.exit(f"mesh_denoising.py: {problem}")
