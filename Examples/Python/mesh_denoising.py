# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Remove the noise of the points of CAD shapes and of scans, independent, impulsive and correlated.

    mesh_denoising.py [--quick]

The points of the surfaces get noise whose standard deviation is a fraction of the mean edge length
h: Gaussian noise along the normals, of all points or, impulsive noise, of half of them.
vtkSurfaceDenoisingFilter, without any setting, measures the noise and removes it.
vtkWindowedSincPolyDataFilter, a low-pass filter, has the setting, of its default and five pass bands,
whose result is closest to the truth, which no user knows. On a smooth shape its angles may be a tenth
smaller than those of mesh denoising, but it rounds edges and moves the surface farther.

The program prints the mean angle between the normals of the triangles and the true ones, the root
mean square distance of the points from their true places, and the change of the volume. It fails
unless the angle is below that of the low-pass filter times the factor of the example, the volume stays
within a half percent, and no more triangles are flipped than before. It writes
mesh_denoising.png, coloured by the angle in bands of five degrees.

The second picture, mesh_denoising_distance.png, is coloured by the distance of the points from the true
surface, and shows the low-pass filter with its default settings, too. Its scan is a depth image of a
pyramid and a ball in front of a wall, with noise that is correlated over two pixels, as that of depth
cameras is. In a coarser image, where shapes are not smooth over sixteen edges, such noise resembles
them, is not found, and stays.

The other surfaces are those of libcgal-demo in the folder SURFACEDIFFUSION_MESH_DIR. If that is not
set, a cube takes the place of the CAD shapes. --quick: small pictures, the second one without
the depth image.

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
    DataError, array_of, make_surface, mean_edge_length, points_of, read_mesh, refined, triangles_of,
    with_arrays)
from vtkmodules.vtkFiltersCore import vtkWindowedSincPolyDataFilter
from vtkmodules.vtkFiltersGeneral import vtkDistancePolyDataFilter

from vtkSurfaceDiffusion import vtkSurfaceDenoisingFilter

PASS_BANDS = (0.3, 0.1, 0.03, 0.01, 0.003)
LARGEST_ANGLE = 20  # of the colours, in degrees
LARGEST_DISTANCE = 0.4  # of the colours, in mean edge lengths
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
    correlation: float = 0.0  # length in pixels; 0: independent noise


SURFACES = (
    Example("anchor_dense", "CAD", 0.2, 1.0, 0.4, (0.5, 0.5, 1), (0, 1, 0)),
    Example("bear", "scan", 0.2, 1.0, 1.1, (0, 0, 1), (0, 1, 0)),
    Example("fandisk", "impulses", 0.5, 0.5, 0.35, (-0.6, 0.5, 1), (0, 1, 0)),
)
DEPTH_IMAGE = Example("depth image", "scan", 0.3, 1.0, 1.0, (0.3, 0.4, 1), (0, 1, 0), correlation=2.0)
WIDTH, HEIGHT = 200, 150  # of the depth image, in pixels


def box():
    """A cube of 6,146 points."""
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([(q[0], q[i], q[i + 1]) for q in quads for i in (1, 2)])
    return refined(make_surface(corners, triangles), 5_000)


def depth_image():
    """A pyramid and a ball in front of a wall, as a depth camera sees them: a height per pixel."""
    y, x = np.mgrid[:HEIGHT, :WIDTH].astype(float)
    pyramid = 40.8 - np.maximum(abs(x - 58), abs(y - 75))
    ball = np.sqrt(np.maximum(0, 51**2 - (x - 142) ** 2 - (y - 75) ** 2)) - 25.5
    points = np.stack([x, y, np.maximum(np.maximum(pyramid, ball), 0)], axis=-1).reshape(-1, 3)
    corner = np.arange(WIDTH * HEIGHT).reshape(HEIGHT, WIDTH)
    a, b, c, d = (part.ravel() for part in (
        corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]))
    return make_surface(points, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))


def correlated_noise(random, length):
    """Noise of the depth, of mean square 1, per pixel: white noise under a Gaussian of this length."""
    offsets = np.arange(-4 * length, 4 * length + 1)
    kernel = np.exp(-0.5 * (offsets / (length / np.sqrt(2))) ** 2)  # the covariance has the length
    noise = random.normal(size=(HEIGHT, WIDTH))
    for axis in (0, 1):
        noise = np.apply_along_axis(np.convolve, axis, noise, kernel, "same")
    return noise.reshape(-1, 1) / np.sqrt((noise**2).mean())


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
    amount = example.noise * mean_edge_length(surface)
    if example.correlation > 0:
        depth = amount * correlated_noise(random, example.correlation)
        return make_surface(points + depth * [0, 0, 1], triangles)
    directions = np.zeros(points.shape)
    np.add.at(directions, triangles, normals_of(points, triangles)[:, None])
    directions = unit(directions)
    directions[random.random(len(points)) > example.share] = 0
    return make_surface(points + amount * random.normal(size=(len(points), 1)) * directions, triangles)


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


def low_pass_of_defaults(surface):
    return output_points(vtkWindowedSincPolyDataFilter(), surface)


class Truth:
    """The original surface, and the measures of others against it."""

    def __init__(self, surface):
        self.surface = surface
        self.points, self.triangles = points_of(surface).astype(float), triangles_of(surface)
        self.normals = unit(normals_of(self.points, self.triangles))

    def angles(self, points):
        """Between the normals of the triangles and the true ones, in degrees."""
        normals = unit(normals_of(points, self.triangles))
        return np.degrees(np.arccos(np.clip((normals * self.normals).sum(axis=1), -1, 1)))

    def distances(self, points):
        """From the points to the true surface, in its mean edge lengths."""
        distance = vtkDistancePolyDataFilter()
        distance.SetInputData(0, make_surface(points, self.triangles))
        distance.SetInputData(1, self.surface)
        distance.SignedDistanceOff()
        distance.ComputeSecondDistanceOff()
        distance.Update()
        return array_of(distance.GetOutput(), "Distance") / mean_edge_length(self.surface)

    def volume(self, points):
        a, b, c = points[self.triangles].swapaxes(0, 1)
        return (a * np.cross(b, c)).sum() / 6

    def describe(self, name, points):
        angles = self.angles(points)
        distance = np.sqrt(((points - self.points) ** 2).sum(axis=1).mean())
        change = self.volume(points) / self.volume(self.points) - 1
        print(f"  {name:24} mean angle {angles.mean():5.2f} degrees, distance {distance:.2e}, "
              f"volume {100 * change:+.2f} %, {np.sum(angles > 90)} flipped")


def faceted(points, triangles, **arrays):
    """The triangles with points of their own, so that each has its normal; arrays: per corner."""
    normals = unit(normals_of(points, triangles))
    separate = make_surface(points[triangles].reshape(-1, 3),
                            np.arange(3 * len(triangles)).reshape(-1, 3))
    separate = with_arrays(separate, Normals=np.repeat(normals, 3, axis=0).astype(np.float32), **arrays)
    separate.GetPointData().SetActiveNormals("Normals")
    return separate


def check(example, truth, noisy, filtered, denoised):
    """Raises AssertionError unless the filter does what the picture is to show."""
    least = example.factor * truth.angles(filtered).mean()
    angle = truth.angles(denoised).mean()
    assert angle < least, f"{example.mesh}: {angle:.2f} degrees; wanted: below {least:.2f}"
    largest, distance = (np.linalg.norm(points - truth.points) for points in (filtered, denoised))
    assert distance < largest, f"{example.mesh}: distance {distance:.2e}; wanted: below {largest:.2e}"
    if example.correlation == 0:  # otherwise an open surface
        change = truth.volume(denoised) / truth.volume(truth.points) - 1
        assert abs(change) < LARGEST_VOLUME_CHANGE, f"{example.mesh}: the volume changes by {change:.2%}"
    before, after = (np.sum(truth.angles(points) > 90) for points in (noisy, denoised))
    assert after <= before, f"{example.mesh}: {after} flipped triangles, {before} before"


def denoise(example, surface):
    """The truth, and the points before and after each method by its title."""
    truth = Truth(surface)
    noisy = with_noise(surface, example)
    print(f"{example.mesh}: {noisy.GetNumberOfPoints():,} points, noise of {example.noise} h"
          + (f" at {example.share:.0%} of the points" if example.share < 1 else ""))
    plain = low_pass_of_defaults(noisy)
    filtered = min([plain, *(low_pass(noisy, band) for band in PASS_BANDS)],
                   key=lambda points: truth.angles(points).mean())
    model = vtkSurfaceDenoisingFilter()
    denoised = output_points(model, noisy)
    given = points_of(noisy).astype(float)
    columns = {f"{example.title}, noisy": given, "windowed sinc": plain,
               "best windowed sinc": filtered, "surface denoising": denoised}
    for name, points in columns.items():
        truth.describe(name, points)
    length = mean_edge_length(surface)
    kind = ("mixed", "CAD", "organic")[model.GetEffectiveSurfaceType()]
    level = model.GetEffectiveNoiseLevel() / length
    print(f"  found: {kind}, noise of {level:.3f} h"
          + (f", correlated over {model.GetCorrelationLength() / length:.1f} h"
             if model.GetCorrelationLength() > 0 else ""))
    check(example, truth, given, filtered, denoised)
    if example.correlation == 0:
        assert kind == ("organic" if example.title == "scan" else "CAD"), f"{example.mesh}: {kind}"
        assert example.share < 1 or abs(level - example.noise) < 0.04, f"{example.mesh}: {level:.3f} h"
    return truth, columns


def panels_of_angles(example, truth, columns, bar):
    table = colour_table(0, LARGEST_ANGLE, COLOURS, steps=LARGEST_ANGLE // 5)
    panels = []
    for name, points in columns.items():
        if name == "windowed sinc":  # the best one is nearer
            continue
        angles = truth.angles(points)
        panels.append(Panel(faceted(points, truth.triangles, angle=np.repeat(angles, 3)), "angle", name,
                            f"mean angle {angles.mean():.1f} degrees", example.view, example.up,
                            table=table, bar=bar))
    return panels


def panels_of_distances(example, truth, columns, bar):
    table = colour_table(0, LARGEST_DISTANCE, COLOURS)
    panels = []
    for name, points in columns.items():
        distances = truth.distances(points)
        surface = faceted(points, truth.triangles, distance=distances[truth.triangles.ravel()])
        panels.append(Panel(surface, "distance", name,
                            f"distance {np.sqrt((distances**2).mean()):.3f} edge lengths (rms)",
                            example.view, example.up, table=table, bar=bar))
    return panels


def main():
    quick = "--quick" in sys.argv[1:]
    folder = os.environ.get("SURFACEDIFFUSION_MESH_DIR")
    angles, distances = [], []
    for example in SURFACES:
        if folder or example.title != "scan":
            surface = read_mesh(Path(folder) / f"{example.mesh}.off") if folder else box()
            truth, columns = denoise(example, surface)
            angles += panels_of_angles(example, truth, columns, bar=example is SURFACES[-1])
            if example is SURFACES[0]:
                distances += panels_of_distances(example, truth, columns, bar=False)
    of_depth_image = denoise(DEPTH_IMAGE, depth_image())
    if not quick:
        distances += panels_of_distances(DEPTH_IMAGE, *of_depth_image, bar=True)
    if display_missing():
        print("no picture: there is no display")
    else:
        save_picture("mesh_denoising.png", angles, 3, (220, 200) if quick else (440, 400))
        save_picture("mesh_denoising_distance.png", distances, 4, (220, 200) if quick else (400, 380))


if __name__ == "__main__":
    try:
        main()
    except (AssertionError, DataError, OSError) as problem:
        sys.exit(f"mesh_denoising.py: {problem}")
