# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Remove noise from ramps and roofs by total variation and by total generalised variation.

    ramps.py

Total variation prefers plateaus, so that a ramp with noise becomes stairs. Total generalised variation
of second order (Regularizer TGV of vtkIntrinsicTVFilter) prefers functions of piecewise constant slope.
The program draws a row each for a roof and for ramps that end at a cliff, on an irregular
triangulation of a square: the data with noise of 10 % of their range, and the results of both
regularizers with the weights that AutomaticFidelity finds, as heights over the square. It prints the
errors, writes ramps.png, and fails unless total generalised variation has at most half of the error on
the roof and less at the cliff.

Try next: SetTGVLength(8), which leaves more stairs; plateaus, whose edges total variation keeps sharper.
"""
import numpy as np
from minimal_surface import irregular_square
from pictures import Panel, display_missing, save_picture
from surface_data import array_of, make_surface, points_of, triangles_of, with_arrays

from vtkSurfaceDiffusion import vtkIntrinsicTVFilter

CELLS = 60
NOISE = 0.1


def denoise(surface, data, generalized):
    model = vtkIntrinsicTVFilter()
    model.SetInputData(with_arrays(surface, f=data))
    model.SetInputArrayToProcess(0, 0, 0, 0, "f")
    model.SetModeToSteadyState()
    model.AutomaticFidelityOn()
    model.SetStopTolerance(1e-3)
    if generalized:
        model.SetRegularizerToTGV()
    model.Update()
    return array_of(model.GetOutput(), "fTV").copy()


def raised(surface, height):
    """The surface at this height, of one colour: its shading shows the slopes."""
    points = points_of(surface) + np.outer(height, [0, 0, 1])
    return with_arrays(make_surface(points, triangles_of(surface)),
                       shown=np.full((len(points), 3), (205, 190, 165), np.uint8))


def row(surface, clean, name):
    noisy = clean + NOISE * np.ptp(clean) * np.random.default_rng(1).normal(size=len(clean))
    results = {"total variation": denoise(surface, noisy, False),
               "total generalised variation": denoise(surface, noisy, True)}
    errors = {title: np.sqrt(np.mean((u - clean) ** 2)) / np.ptp(clean)
              for title, u in (("noisy", noisy), *results.items())}
    print(f"{name}: error " + ", ".join(f"{100 * error:.1f} % {title}" for title, error in errors.items()))
    panels = [Panel(raised(surface, u), "shown", title, f"error {100 * errors[title]:.1f} %",
                    (-0.75, -1.0, 0.75), (0, 0, 1))
              for title, u in (("noisy", noisy), *results.items())]
    return panels, errors["total variation"] / errors["total generalised variation"]


def main():
    surface, _ = irregular_square(CELLS)
    x, y, _ = points_of(surface).T
    roof, of_roof = row(surface, 0.8 - np.maximum(np.abs(x), np.abs(y)), "roof")
    cliff, of_cliff = row(surface, np.where(y > 0.3 * x, 0.5 * x, 0.6 - 0.4 * x), "ramps with a cliff")
    assert of_roof > 2.0 and of_cliff > 1.0, (of_roof, of_cliff)
    if display_missing():
        print("  no picture: there is no display")
        return
    save_picture("ramps.png", roof + cliff, 3, (320, 270))


if __name__ == "__main__":
    main()
