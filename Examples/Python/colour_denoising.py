#!/usr/bin/env python3
"""Models of colours compared on photographs with noise, on two scanned surfaces and on a sphere:
linear diffusion, total variation of each channel and of all of them jointly, ColorModel Opponent and
ChromaticityBrightness of vtkIntrinsicTVFilter, and the Beltrami flow (vtkTensorDiffusionFilter).

Noise of n % is Gaussian with standard deviation n/100 of the range from black to white in every
channel. Noise of colour alone has no component along grey. Every model has the fidelity weight
lambda, found by golden sections, whose result is closest to the clean picture by CIEDE2000, the
perceived difference of colours; its other settings are the defaults, except that the
ChromaticityWeight is 2 with noise of colour alone. The program prints PSNR and CIEDE2000 of all of
them, and their means as a table, and draws a part. It fails unless
ChromaticityBrightness is closer than joint total variation by 1 CIEDE2000 with noise of colour alone,
and Opponent is closer with every noise.

It takes the arguments of paper_figures.py. Examples/figures.sh fetches the data and runs it.
"""
import sys
from dataclasses import dataclass

import numpy as np

import surface_data as data
from color_difference import mean_difference
from paper_figures import (
    Example, FigureError, FRONT, arguments, prepared, psnr, shown, update,
)
from pictures import Panel, save_picture
from vtkSurfaceDiffusion import vtkFVMHeatFilter, vtkIntrinsicTVFilter, vtkTensorDiffusionFilter

COLOUR = 0.2  # standard deviation of the noise of colour alone
NOISES = (0.1, 0.2, 0.4, "colour")
FACTOR = 4  # lambda is sought from its typical value over this to its multiple
EVALUATIONS = 7
COLOUR_WEIGHT = 2  # ChromaticityWeight with noise of colour alone
LEAST_GAIN = 1.0  # of ChromaticityBrightness with noise of colour alone, in CIEDE2000

EXAMPLES = (
    Example("bear", "astronaut.png", FRONT, (0.45, 0.45)),
    Example("mannequin-devil", "chelsea.png", dict(view=(1, 0, 0), up=(0, 0, 1)), (0.28, 0.62)),
    Example("sphere", "astronaut.png", FRONT, (0.45, 0.75)),
)
PICTURES = {"bear": 0.4, "mannequin-devil": "colour", "sphere": 0.2}  # the noise of each row


# ---- the models ----------------------------------------------------------------------------------

def linear(surface):
    model = prepared(vtkFVMHeatFilter(), surface)
    model.SetModeToSteadyState()
    model.SetSolverToConjugateGradient()  # each lambda gives another matrix
    model.SetTolerance(1e-5)
    return model


def total_variation(surface):
    model = prepared(vtkIntrinsicTVFilter(), surface)
    model.AutomaticFidelityOff()  # all weights are tried
    model.SetModeToSteadyState()
    model.SetStopTolerance(2e-3)  # within 0.03 dB of the minimiser
    return model


def per_channel(surface):
    model = total_variation(surface)
    model.SetChannelCouplingToPerChannel()
    return model


def opponent(surface):
    model = total_variation(surface)
    model.SetColorModelToOpponent()
    return model


def chromaticity(surface):
    model = total_variation(surface)
    model.SetColorModelToChromaticityBrightness()
    return model


def beltrami(surface):
    model = prepared(vtkTensorDiffusionFilter(), surface)
    model.SetModelToBeltrami()
    return model


@dataclass
class Model:
    name: str
    make: callable
    weight: float  # a typical lambda


MODELS = (
    Model("Linear", linear, 0.4),
    Model("TV per channel", per_channel, 8),
    Model("TV joint", total_variation, 5),
    Model("Opponent", opponent, 12),
    Model("Chromaticity", chromaticity, 12),
    Model("Beltrami", beltrami, 0.5),
)


@dataclass
class Result:
    weight: float
    values: np.ndarray
    difference: float  # mean CIEDE2000
    psnr: float


def solve(model, weight):
    model.SetFidelityWeight(weight)
    if model.IsA("vtkTensorDiffusionFilter"):
        model.SetTimeStep(2 / weight)  # ten steps then come close to the steady state
    output = update(model)
    values = data.array_of(output, "result").copy()
    return Result(weight, values, mean_difference(values, data.array_of(output, "clean")),
                  psnr(output, values))


def solve_best(model, weight):
    """The result of the least difference, by golden sections of log lambda."""
    golden = (np.sqrt(5) - 1) / 2
    low, high = -np.log(FACTOR), np.log(FACTOR)
    results = {}

    def result(place):
        if place not in results:
            results[place] = solve(model, weight * np.exp(place))
        return results[place].difference

    left, right = high - golden * (high - low), low + golden * (high - low)
    while len(results) < EVALUATIONS:
        if result(left) < result(right):
            high, right = right, left
            left = high - golden * (high - low)
        else:
            low, left = left, right
            right = low + golden * (high - low)
    return min(results.values(), key=lambda found: found.difference)


# ---- the pictures --------------------------------------------------------------------------------

def sphere(more_than):
    """A sphere with more than this many vertices: an icosahedron, refined."""
    golden = (1 + np.sqrt(5)) / 2
    corners = np.array([p for a in (-1, 1) for b in (-golden, golden)
                        for p in ((0, a, b), (a, b, 0), (b, 0, a))])
    distances = np.linalg.norm(corners[:, None] - corners, axis=2)
    near = np.isclose(distances, 2)
    triangles = np.array([(i, j, k) for i in range(12) for j in range(i) for k in range(j)
                          if near[i, j] and near[j, k] and near[i, k]])
    a, b, c = np.moveaxis(corners[triangles], 1, 0)
    inside = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    triangles[inside] = triangles[inside, ::-1]
    surface = data.refined(data.make_surface(corners, triangles), more_than)
    points = data.points_of(surface)
    return data.make_surface(points / np.linalg.norm(points, axis=1)[:, None],
                             data.triangles_of(surface))


def painted(example, args):
    if args.quick:
        surface = data.refined(data.pebble(), 2_000)
        clean = data.patches(surface)
    else:
        surface = (sphere(10_000) if example.mesh == "sphere" else
                   data.refined(data.read_mesh(args.meshes / f"{example.mesh}.off"), 10_000,
                                smooth=True))
        clean = data.paint(surface, data.read_photo(args.photos / example.photo), **example.side)
    return data.with_arrays(surface, clean=clean)


def spoiled(surface, noise):
    random = np.random.default_rng(1)
    clean = data.array_of(surface, "clean")
    change = random.normal(0, COLOUR if noise == "colour" else noise, clean.shape)
    if noise == "colour":
        change -= change.mean(axis=1, keepdims=True)
    return data.with_arrays(surface, spoiled=clean + change)


def name_of(noise):
    return f"{COLOUR:.0%} in colour" if noise == "colour" else f"{noise:.0%}"


def compared(surface, noise):
    """The best result of each model, by its name."""
    surface = spoiled(surface, noise)
    noisy = data.array_of(surface, "spoiled")
    difference = mean_difference(noisy, data.array_of(surface, "clean"))
    print(f"  noise {name_of(noise)}: {psnr(surface, noisy):.2f} dB, CIEDE2000 {difference:.2f}")
    results = {"Noisy": Result(0, noisy, difference, psnr(surface, noisy))}
    for model in MODELS:
        made = model.make(surface)
        if noise == "colour" and model.make is chromaticity:
            made.SetChromaticityWeight(COLOUR_WEIGHT)
        best = solve_best(made, model.weight)
        results[model.name] = best
        print(f"    {model.name:15} lambda {best.weight:6.2f}: {best.psnr:5.2f} dB, "
              f"CIEDE2000 {best.difference:5.2f}", flush=True)
    return results


def check(example, noise, results, is_photograph=True):
    """Raises FigureError unless the models of colours win as they should. On few flat colours joint
    total variation may win unless the noise is in colour alone."""
    joint = results["TV joint"].difference
    gain = joint - results["Chromaticity"].difference
    if is_photograph and noise == "colour" and gain < LEAST_GAIN:
        raise FigureError(f"{example.mesh}: ChromaticityBrightness is ahead of joint total "
                          f"variation by {gain:.2f} CIEDE2000 only")
    if (is_photograph or noise == "colour") and results["Opponent"].difference >= joint:
        raise FigureError(f"{example.mesh}: Opponent is not ahead with noise {name_of(noise)}")


def table_of(all_results):
    """The means over the photographs as a table in Markdown."""
    names = list(next(iter(all_results.values())))
    lines = ["| noise | " + " | ".join(names) + " |", "| --- " * (len(names) + 1) + "|"]
    for noise in NOISES:
        rows = [results for (_, of), results in all_results.items() if of == noise]
        cells = []
        for name in names:
            difference = np.mean([row[name].difference for row in rows])
            decibels = np.mean([row[name].psnr for row in rows])
            cells.append(f"{difference:.1f} ({decibels:.1f} dB)")
        lines.append(f"| {name_of(noise)} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def panels_of(example, surface, results, look):
    clean = Panel(shown(surface, data.array_of(surface, "clean")), "shown", "Clean", "",
                  closeup=example.closeup, **look)
    return [clean] + [
        Panel(shown(surface, found.values), "shown", name,
              f"CIEDE2000 {found.difference:.1f}, {found.psnr:.1f} dB",
              closeup=example.closeup, **look)
        for name, found in results.items() if name not in ("Linear", "TV per channel")]


def main():
    args = arguments()
    args.output.mkdir(parents=True, exist_ok=True)
    panels, all_results, problems = [], {}, []
    for example in EXAMPLES[:1] if args.quick else EXAMPLES:
        surface = painted(example, args)
        print(f"{example.mesh}, {surface.GetNumberOfPoints():,} vertices, {example.photo}")
        for noise in NOISES:
            results = compared(surface, noise)
            all_results[example.mesh, noise] = results
            try:
                check(example, noise, results, not args.quick)
            except FigureError as problem:
                problems.append(str(problem))
            if PICTURES[example.mesh] == noise:
                panels += panels_of(example, surface, results, example.side)
    print(table_of(all_results))
    picture = args.output / "colour_denoising.png"
    width = args.width * 5 // 7
    save_picture(picture, panels, 6, (width, width * 3 // 4))
    print(f"Picture: {picture}")
    if problems:
        raise FigureError("; ".join(problems))


if __name__ == "__main__":
    try:
        main()
    except (data.DataError, FigureError, OSError) as problem:
        sys.exit(f"colour_denoising.py: {problem}")
