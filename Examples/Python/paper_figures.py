#!/usr/bin/env python3
"""Figures 4, 5 and 6 of Wu, Deng and Chen (IEEE TVCG 14(3), 2008) with photographs on scanned
surfaces: linear diffusion compared with intrinsic total variation.

4. denoising, (16) and (17): a grey photograph with 25 % noise and a coloured one with 50 % on
   closed surfaces, one with 33 % on an open surface;
5. 20 % and 80 % noise on one closed surface;
6. inpainting, (18) and (19): scratches across edges on a surface of genus 2, random spots on a
   closed one, both on an open one.

Noise of n % is Gaussian with standard deviation n/100 of the range from black to white. It is
clipped in the pictures only. Both models are shown with the fidelity weight lambda whose result is
closest to the clean picture. Examples/figures.sh fetches meshes and photographs, builds the library
and runs this program.
"""
import argparse
import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

import surface_data as data
from pictures import Panel, display_missing, save_picture
from vtkSurfaceDiffusion import vtkFVMHeatFilter, vtkIntrinsicTVFilter

POINTS = vtkDataObject.FIELD_ASSOCIATION_POINTS
DATA, MASK = 0, 1  # the filters' input arrays
TIME_STEPS = vtkStreamingDemandDrivenPipeline.TIME_STEPS()
GREY = ("camera.png", "coins.png")

FRONT = dict(view=(0, 0, 1), up=(0, 1, 0))
ABOVE = dict(view=(0, 1, 0), up=(1, 0, 0))


class FigureError(Exception):
    """An error that the user can correct; shown without a traceback."""


@dataclass
class Example:
    """A row of a figure: a photograph on a mesh, and the damage to it."""
    mesh: str
    photo: str
    side: dict              # view direction of projection and picture
    closeup: tuple          # centre of the close-up, as fractions of width and height
    closed: bool = True
    noise: float = 0        # standard deviation, as a fraction of the range
    missing: float = 0      # fraction of the points
    scratches: float = 0.5  # fraction of the missing points in scratches; others: spots
    width: float = 4        # width of a scratch, in mean edge lengths


FIGURES = {
    4: [Example("bunny00", "camera.png", FRONT, (0.57, 0.38), noise=0.25),
        Example("bear", "astronaut.png", FRONT, (0.45, 0.45), noise=0.50),
        Example("three_peaks", "grace_hopper.jpg", ABOVE, (0.52, 0.3), closed=False, noise=0.33)],
    5: [Example("bunny00", "coffee.png", FRONT, (0.6, 0.5), noise=0.20),
        Example("bunny00", "coffee.png", FRONT, (0.6, 0.5), noise=0.80)],
    6: [Example("eight", "coins.png", ABOVE, (0.56, 0.3), missing=0.1, scratches=1, width=8),
        Example("bear", "retina.jpg", FRONT, (0.1, 0.15), missing=0.1, scratches=0),
        Example("three_peaks", "grace_hopper.jpg", ABOVE, (0.47, 0.42), closed=False, missing=0.1)],
}


# ---- surfaces with pictures ----------------------------------------------------------------------

def painted(example, args, quick_vertices=4_000):
    """The surface of the row with its picture `clean`: one or three values per point. quick_vertices: with
    more than so many if args.quick."""
    if args.quick:
        surface = data.refined(data.pebble() if example.closed else data.half_pebble(), quick_vertices)
        clean = data.patches(surface)
        if example.photo in GREY:
            clean = clean.mean(axis=1)
    else:
        mesh = data.read_mesh(args.meshes / f"{example.mesh}.off")
        surface = data.refined(mesh, 100_000, smooth=True)
        photo = data.read_photo(args.photos / example.photo)
        clean = data.paint(surface, photo, **example.side)
    return data.with_arrays(surface, clean=clean)


def spoiled(surface, example):
    """The surface with the array `spoiled`: the picture with noise, or with `missing` points in
    white."""
    clean = data.array_of(surface, "clean")
    if example.noise:
        random = np.random.default_rng(1)
        noise = random.normal(0, example.noise, clean.shape)
        return data.with_arrays(surface, spoiled=clean + noise)
    missing = data.damage(surface, example.missing, example.scratches, example.width)
    torn = clean.copy()
    torn[missing > 0] = 1
    return data.with_arrays(surface, missing=missing, spoiled=torn)


def shown(surface, values):
    """The surface with the values as clipped 8-bit colours."""
    colours = np.rint(255 * np.clip(values, 0, 1)).astype(np.uint8)
    colours = colours.reshape(len(colours), -1)
    return data.with_arrays(surface, shown=np.broadcast_to(colours, (len(colours), 3)).copy())


# ---- the two models ------------------------------------------------------------------------------

def prepared(model, surface):
    model.SetInputData(surface)
    model.SetInputArrayToProcess(DATA, 0, 0, POINTS, "spoiled")
    if surface.GetPointData().HasArray("missing"):
        model.SetInputArrayToProcess(MASK, 0, 0, POINTS, "missing")
    model.SetResultArrayName("result")
    return model


def linear_model(surface):
    """The steady state of (16) or (18)."""
    model = prepared(vtkFVMHeatFilter(), surface)
    model.SetModeToSteadyState()
    model.SetSolverToConjugateGradient()  # each lambda gives another matrix
    return model


def tv_denoising(surface):
    """The steady state of (17), computed directly."""
    model = prepared(vtkIntrinsicTVFilter(), surface)
    model.AutomaticFidelityOff()  # also a weight of 3 is tried
    model.SetModeToSteadyState()
    model.SetStopTolerance(2e-3)  # within 0.03 dB of the minimiser
    return model


def paper_scheme(model, steps=10):
    """The model with the scheme (11) in a few time steps; colours share one norm of the
    gradient."""
    model.UsePaperScheme()
    model.SetChannelCouplingToJoint()
    model.SetNumberOfTimeSteps(steps)
    model.SetTolerance(1e-4)
    return model


def tv_inpainting(surface):
    """(19) with large time steps from random initial values, as in the paper."""
    model = paper_scheme(prepared(vtkIntrinsicTVFilter(), surface), steps=8)
    model.SetInitialFillToNoise()
    model.SetBeta(1e-4)
    model.SetTimeStep(100)
    return model


def update(model):
    """Updates the model and returns its output; raises FigureError if the model reports an
    error."""
    errors = []

    @calldata_type(VTK_STRING)
    def listen(caller, event, message):
        errors.append(message.partition("): ")[2].strip())  # without source file and address

    observer = model.AddObserver(vtkCommand.ErrorEvent, listen)
    model.Update()
    model.RemoveObserver(observer)
    if errors:
        raise FigureError(errors[0])
    return model.GetOutput()


@dataclass
class Result:
    weight: float      # lambda
    values: np.ndarray
    psnr: float        # peak signal-to-noise ratio in decibels
    changed: float     # root mean square change of the known values
    seconds: float     # run time of the solves
    steps: int
    iterations: float  # per step

    def __str__(self):
        weight = f"{self.weight:.3g}" if self.weight < np.inf else "infinite"
        return (f"{self.psnr:5.2f} dB, {self.seconds:5.2f} s, {self.steps:2} "
                f"{'step ' if self.steps == 1 else 'steps'}, {self.iterations:3.0f} iterations a "
                f"step, lambda {weight}")


def psnr(surface, values):
    return -10 * np.log10(np.mean((values - data.array_of(surface, "clean")) ** 2))


def solve(model, weight):
    model.SetHoldKnownValues(weight == np.inf)
    model.SetFidelityWeight(0 if weight == np.inf else weight)
    output = update(model)
    values = data.array_of(output, "result")
    change = (values - data.array_of(output, "spoiled")) ** 2
    if output.GetPointData().HasArray("missing"):
        change = change[data.array_of(output, "missing") == 0]
    history = WrapDataObject(model.GetOutputDataObject(1)).RowData
    steps = len(history["Step"]) - 1  # the first row is the initial state
    return Result(weight, values.copy(), psnr(output, values), np.sqrt(change.mean()),
                  np.sum(history["Seconds"]), steps, np.sum(history["Iterations"]) / steps)


def solve_best(model, weight, gain=0):
    """The result with the best PSNR over the fidelity weight: a search from the given weight, in
    factors of 2 and then of 2^(1/4), which stops when PSNR gains no more than `gain` a factor of
    2."""
    results = {}

    def result(power):
        if power not in results:
            results[power] = solve(model, weight * 2 ** power)
        return results[power]

    best = 0
    for step in (1, -1, 1 / 4, -1 / 4):
        while result(best + step).psnr > result(best).psnr + gain * abs(step):
            best += step
    return result(best)


def steps_to_result(model):
    """For each initial fill, the number of steps to convergence: until the root mean square
    difference from the state after 40 steps, over the missing points, is below 1 % of the range."""
    counts = {}
    model.SetNumberOfTimeSteps(40)
    model.GenerateTimeStepsOn()
    for fill in ("Input", "Mean", "Noise"):
        getattr(model, f"SetInitialFillTo{fill}")()
        update(model)
        missing = data.array_of(model.GetOutput(), "missing") > 0
        end = data.array_of(model.GetOutput(), "result")[missing].copy()
        for step, time in enumerate(model.GetOutputInformation(0).Get(TIME_STEPS)):
            model.UpdateTimeStep(time)
            state = data.array_of(model.GetOutput(), "result")[missing]
            if np.mean((state - end) ** 2) < 0.01 ** 2:
                break
        counts[fill] = step
    return counts


# ---- rows of the figures: each prints its numbers and returns whether TV wins, and pictures ------

def denoise(surface, example):
    linear = solve_best(linear_model(surface), 0.2)
    model = tv_denoising(surface)
    tv = solve_best(model, 8)
    stepped = solve(paper_scheme(model), tv.weight)
    print(f"   linear (16)         {linear}")
    print(f"   TV (17)             {tv}")
    print(f"     in steps of (11)  {stepped}", flush=True)
    wins = tv.psnr > linear.psnr
    return wins, [(f"{example.noise:.0%} noise", data.array_of(surface, "spoiled")),
                  ("Linear (16)", linear.values), ("TV (17)", tv.values)]


def inpaint(surface, example):
    # PSNR increases with lambda, since the known values are undamaged. The search stops where a
    # larger lambda gains hardly anything.
    linear = solve_best(linear_model(surface), 1, gain=0.1)
    held = solve(linear_model(surface), np.inf)
    model = tv_inpainting(surface)
    tv = solve(model, np.inf)
    steps = steps_to_result(model)
    print(f"   linear (18)         {linear}; known values changed by {linear.changed:.2%}")
    print(f"     held              {held}")
    print(f"   TV (19)             {tv}; known values changed by {tv.changed:.2%}")
    print("     steps to 1 % from each initial fill: "
          + ", ".join(f"{fill} {count}" for fill, count in steps.items()), flush=True)
    wins = tv.psnr > max(linear.psnr, held.psnr) and tv.changed <= linear.changed / 4
    kind = {1: "scratches", 0: "spots"}.get(example.scratches, "scratches and spots")
    return wins, [(f"{example.missing:.0%} missing: {kind}", data.array_of(surface, "spoiled")),
                  ("Linear (18)", linear.values), ("TV (19)", tv.values)]


def panels_of(example, args):
    if args.quick:
        example = replace(example, width=4)
    surface = spoiled(painted(example, args), example)
    before = psnr(surface, data.array_of(surface, "spoiled"))
    print(f"{example.mesh}, {surface.GetNumberOfPoints():,} vertices, {example.photo}: "
          f"{before:.2f} dB", flush=True)
    wins, row = (denoise if example.noise else inpaint)(surface, example)
    if not wins:
        print("   total variation does not win here")
    look = FRONT if args.quick else example.side
    return wins, [Panel(shown(surface, values), "shown", title,
                        f"PSNR {psnr(surface, values):.1f} dB", closeup=example.closeup, **look)
                  for title, values in row]


# ---- the program -------------------------------------------------------------------------------

def arguments():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("--figure", choices=[*map(str, FIGURES), "all"], default="all",
                        help="which figure to draw (default: %(default)s)")
    parser.add_argument("--output", type=Path, default=Path("paper-figures"), metavar="DIR",
                        help="folder of the pictures (default: %(default)s)")
    parser.add_argument("--meshes", type=Path, metavar="DIR", help="folder of CGAL's meshes, .off")
    parser.add_argument("--photos", type=Path, metavar="DIR",
                        help="folder of scikit-image's photographs")
    parser.add_argument("--width", type=int, default=560, metavar="N",
                        help="width of a panel, in pixels (default: %(default)s)")
    parser.add_argument("--quick", action="store_true", help="small, on generated surfaces")
    args = parser.parse_args()
    if not args.quick and not (args.meshes and args.photos):
        parser.error("--meshes and --photos are needed (Examples/figures.sh fetches both), "
                     "or --quick")
    if display_missing():
        parser.error("no display to draw on: run under xvfb-run")
    return args


def main():
    args = arguments()
    args.output.mkdir(parents=True, exist_ok=True)
    lost = 0
    for number in FIGURES if args.figure == "all" else [int(args.figure)]:
        print(f"Figure {number}")
        panels = []
        for example in FIGURES[number]:
            wins, row = panels_of(example, args)
            lost += not wins
            panels += row
        picture = args.output / f"figure{number}.png"
        save_picture(picture, panels, 3, (args.width, args.width * 3 // 4))
        print(f"Picture: {picture}")
    if lost:
        raise FigureError(f"total variation does not win in {lost} rows")


if __name__ == "__main__":
    try:
        main()
    except (data.DataError, FigureError, OSError) as problem:
        sys.exit(f"paper_figures.py: {problem}")
