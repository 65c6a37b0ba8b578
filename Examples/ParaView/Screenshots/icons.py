#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the icons of the macros: icons.py <folder for the pictures>. A new macro needs a function in
ICONS, of the coordinates x and y from -1 to 1, that returns a colour at each point."""
import pathlib
import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter

SIZE, FINER = 48, 6
BLUE, YELLOW, RED, GREEN = (38, 84, 124), (255, 209, 102), (214, 64, 69), (70, 150, 110)
WHITE, DARK = (250, 250, 248), (40, 40, 46)


def painted(place, *layers):
    """Colours of pairs (condition, colour), the later ones on top, within a condition."""
    colours = np.zeros((*place.shape, 4))
    for condition, colour in layers:
        colours[condition] = (*colour, 255)
    colours[~place] = 0
    return colours


def disk(x, y, radius=0.95):
    return x * x + y * y < radius * radius


def wave(x, y):
    """The border of two patches."""
    return y < 0.25 * np.sin(3 * x) - 0.05


def dice(x, y, size):
    """A random number for each square of a grid."""
    numbers = np.random.default_rng(3).uniform(size=(64, 64))
    return numbers[np.floor((y + 1) / size).astype(int) % 64, np.floor((x + 1) / size).astype(int) % 64]


def rim(x, y):
    return ~disk(x, y, 0.87), DARK


def denoise(x, y):
    wrong = (dice(x, y, 0.14) < 0.28) & (x < 0)
    return painted(disk(x, y), (disk(x, y), YELLOW), (wave(x, y) ^ wrong, BLUE), rim(x, y))


def inpaint(x, y):
    hole = disk(x + 0.1, y - 0.05, 0.42)
    ring = hole & ~disk(x + 0.1, y - 0.05, 0.32) & (np.sin(6 * np.arctan2(y - 0.05, x + 0.1)) > 0)
    return painted(disk(x, y), (disk(x, y), YELLOW), (wave(x, y), BLUE), (ring, WHITE), rim(x, y))


def deblur(x, y):
    colours = painted(disk(x, y), (disk(x, y), YELLOW), (wave(x, y), BLUE), rim(x, y))
    blurred = disk(x, y, 0.87) & (x < 0)
    mixed = np.clip(0.5 + 0.8 * (y - 0.25 * np.sin(3 * x) + 0.05), 0, 1)[..., None]
    colours[blurred, :3] = (mixed * YELLOW + (1 - mixed) * BLUE)[blurred]
    return colours


def segment(x, y):
    angle = np.mod(np.arctan2(y, x) + 0.5, 2 * np.pi)
    near = np.abs(np.mod(angle, 2 * np.pi / 3) - np.pi / 3) > np.pi / 3 - 0.09 / np.hypot(x, y).clip(0.1)
    return painted(disk(x, y), (disk(x, y), BLUE), (angle > 2 * np.pi / 3, YELLOW),
                   (angle > 4 * np.pi / 3, GREEN), (near, DARK), rim(x, y))


def denoise_mesh(x, y):
    place = (np.abs(x) < 0.95) & (np.abs(y) < 0.95)
    roof = 0.75 - np.abs(x) * 1.1
    zigzag = roof - 0.55 + 0.2 * (np.abs(np.mod(7 * x, 2) - 1) - 0.5)
    top, bottom = np.abs(y - zigzag + 0.15) < 0.13, np.abs(y - roof) < 0.13
    return painted(place & (top | bottom), (top, RED), (bottom, BLUE))


def edges(x, y):
    curve = np.abs(y - 0.25 * np.sin(3 * x) + 0.05) < 0.12
    return painted(disk(x, y), (disk(x, y), WHITE), (wave(x, y), (214, 222, 230)), (curve, RED), rim(x, y))


def enhance_lines(x, y):
    lines = np.cos(11 * (0.8 * x - 0.6 * y)) > 0.1
    gaps = (np.cos(7 * (0.6 * x + 0.8 * y)) > 0.5) & (x < 0)
    return painted(disk(x, y), (disk(x, y), YELLOW), (lines & ~gaps, BLUE), rim(x, y))


def texture(x, y):
    rows = np.round(y / 0.36)
    spots = np.hypot(np.mod(x / 0.42 + 0.5 * rows, 1) - 0.5, (y / 0.36 - rows) * 0.86) < 0.31
    return painted(disk(x, y), (disk(x, y), YELLOW), (spots, BLUE), rim(x, y))


def relief(x, y):
    """A block with rounded ridges on its top."""
    top = 0.15 + 0.3 * np.sqrt(np.abs(np.sin(np.pi * 1.67 * (x + 0.9))))
    block = (np.abs(x) < 0.9) & (y > -0.85) & (y < top)
    inner = (np.abs(x) < 0.8) & (y > -0.75) & (y < top - 0.1)
    return painted(block, (block, DARK), (inner, YELLOW), (inner & (y > 0.1), BLUE))


def history(x, y):
    axes = (np.abs(x + 0.8) < 0.08) & (y > -0.88) | (np.abs(y + 0.8) < 0.08) & (x > -0.88)
    slope = 3.5 * np.exp(-2.2 * (x + 0.8))
    curve = np.abs(y + 0.5 - 1.3 * np.exp(-2.2 * (x + 0.8))) < 0.09 * np.sqrt(1 + (1.3 / 3.5 * 2.2 * slope) ** 2)
    curve &= (x > -0.7) & (y < 0.9)
    place = np.maximum(np.abs(x), np.abs(y)) < 0.95
    return painted(place & (axes | curve), (axes, DARK), (curve, RED))


ICONS = (denoise, inpaint, deblur, segment, denoise_mesh, edges, enhance_lines, texture, relief,
         history)


def draw(icon, size=SIZE):
    """The icon as rows from the bottom up: red, green, blue and alpha."""
    line = (np.arange(size * FINER) + 0.5) / (size * FINER) * 2 - 1
    colours = icon(*np.meshgrid(line, line))
    colours[..., :3] *= colours[..., 3:] / 255  # transparent points do not count
    mean = colours.reshape(size, FINER, size, FINER, 4).mean(axis=(1, 3))
    mean[..., :3] /= np.maximum(mean[..., 3:], 1e-9) / 255
    return np.round(mean).astype(np.uint8)


def main():
    for icon in ICONS:
        image, writer = vtkImageData(), vtkPNGWriter()
        image.SetDimensions(SIZE, SIZE, 1)
        image.GetPointData().SetScalars(numpy_to_vtk(draw(icon).reshape(-1, 4), deep=True))
        writer.SetFileName(str(pathlib.Path(sys.argv[1], icon.__name__ + ".png")))
        writer.SetInputData(image)
        writer.Write()


if __name__ == "__main__":
    main()
