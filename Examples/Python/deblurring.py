#!/usr/bin/env python3
"""Restores a photograph on a scanned surface that was blurred by a known width and has 2 % noise:
Tikhonov regularisation (vtkFVMHeatFilter) beside total variation (vtkIntrinsicTVFilter), both with
BlurFWHM and with the fidelity weight whose result is closest to the original.

The blur is linear diffusion in fine time steps, not the one that BlurFWHM models, as with data of
an instrument. The program fails unless total variation gains most and both gain. It takes the
arguments of paper_figures.py. Examples/figures.sh fetches the data and runs it.
"""
import sys

import numpy as np

import surface_data as data
from paper_figures import (
    ABOVE, Example, FigureError, FRONT, arguments, painted, prepared, psnr, shown, solve_best, update,
)
from pictures import Panel, save_picture
from vtkSurfaceDiffusion import vtkFVMHeatFilter, vtkIntrinsicTVFilter

WIDTH = 4  # of the blur, in mean edge lengths
NOISE = 0.02  # standard deviation, as a fraction of the range

EXAMPLES = (
    Example("bunny00", "coffee.png", FRONT, (0.6, 0.5)),
    Example("three_peaks", "grace_hopper.jpg", ABOVE, (0.52, 0.3), closed=False),
)


def blurred(surface, width):
    """The surface with the array `spoiled`: the picture after diffusion, with noise."""
    blur = vtkFVMHeatFilter()
    blur.SetInputData(surface)
    blur.SetInputArrayToProcess(0, 0, 0, 0, "clean")
    blur.SetFWHM(width)
    blur.SetResultArrayName("result")
    values = data.array_of(update(blur), "result")
    random = np.random.default_rng(1)
    return data.with_arrays(surface, spoiled=values + random.normal(0, NOISE, values.shape))


def restoring(model, surface, width):
    prepared(model, surface)
    model.SetModeToSteadyState()
    model.SetBlurFWHM(width)
    return model


def panels_of(example, args):
    surface = painted(example, args, quick_vertices=1_000)
    width = WIDTH * data.mean_edge_length(surface)
    surface = blurred(surface, width)
    before = psnr(surface, data.array_of(surface, "spoiled"))
    print(f"{example.mesh}, {surface.GetNumberOfPoints():,} vertices, {example.photo}: "
          f"{before:.2f} dB", flush=True)
    tikhonov = restoring(vtkFVMHeatFilter(), surface, width)
    tikhonov.SetTolerance(1e-5)
    linear = solve_best(tikhonov, 50)
    print(f"   Tikhonov            {linear}", flush=True)
    variation = restoring(vtkIntrinsicTVFilter(), surface, width)
    variation.SetStopTolerance(1e-3)
    tv = solve_best(variation, 100)
    print(f"   total variation     {tv}", flush=True)
    if not tv.psnr > linear.psnr > before:
        raise FigureError("total variation does not gain most")
    look = FRONT if args.quick else example.side
    pictures = (("Blurred, 2 % noise", data.array_of(surface, "spoiled")),
                ("Tikhonov", linear.values), ("Total variation", tv.values))
    return [Panel(shown(surface, values), "shown", title, f"PSNR {psnr(surface, values):.1f} dB",
                  closeup=example.closeup, **look) for title, values in pictures]


def main():
    args = arguments()
    args.output.mkdir(parents=True, exist_ok=True)
    panels = [panel for example in EXAMPLES for panel in panels_of(example, args)]
    picture = args.output / "deblurring.png"
    save_picture(picture, panels, 3, (args.width, args.width * 3 // 4))
    print(f"Picture: {picture}")


if __name__ == "__main__":
    try:
        main()
    except (data.DataError, FigureError, OSError) as problem:
        sys.exit(f"deblurring.py: {problem}")
