# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The filters of the page: one entry of FILTERS each, with its sliders and the call that runs it.

An entry's `run` takes a Mesh, the data and the sliders' values, and returns an Outcome. To add a
model, write such a function and an entry; the page needs no other change.
"""
from dataclasses import dataclass, field
from typing import Any, Callable

import numpy as np

import surfacediffusion as sd
from surfacediffusion.command.printing import EDGES_PER_WAVELENGTH, PATTERNS, welded

STEPS = 10  # time steps within the time of the slider


@dataclass(frozen=True)
class Slider:
    """A number that the page asks for. With `of_diagonal`, low, high, step and default are parts of
    the diagonal of the mesh's bounding box, and the page shows coordinates, in their unit. A number
    that stands for a choice is asked for by a menu with the words in `choices`, from 0 on; one that is
    0 or 1, without words, by a switch."""

    name: str
    label: str
    low: float
    high: float
    step: float
    default: float
    of_diagonal: bool = False
    choices: tuple = ()

    def range(self, diagonal):
        """low, high, step and default for a mesh with this diagonal: lengths with three digits."""
        numbers = (self.low, self.high, self.step, self.default)
        if not self.of_diagonal:
            return numbers
        return tuple(float(f"{number * diagonal:.3g}") for number in numbers)

    @property
    def look(self):
        if self.choices:
            return "menu"
        return "switch" if (self.low, self.high, self.step) == (0, 1, 1) else "slider"


def choice(name, label, *words):
    return Slider(name, label, 0, len(words) - 1, 1, 0, choices=words)


@dataclass
class Outcome:
    """The result of a filter: the array that the page shows (None: a grey surface), further arrays for
    the download, and the points if they have moved. labels: the values are numbers of regions."""

    shown: Any
    arrays: dict = field(default_factory=dict)
    cell_arrays: dict = field(default_factory=dict)
    points: Any = None
    history: dict = field(default_factory=dict)
    labels: bool = False
    note: str = ""
    triangles: Any = None  # if the result is another surface, for printing: its triangles


@dataclass(frozen=True)
class Filter:
    """input: "values" for any array, "vectors" for those with several components or the normals,
    "none" for filters of the surface alone."""

    name: str
    title: str
    input: str
    sliders: tuple
    run: Callable[..., Outcome]


def run_heat(mesh, data, options, progress):
    if options["width"] > 0:
        settings = {"fwhm": options["width"]}
    else:
        settings = {"fidelity_weight": options["weight"], "time_step": options["time"] / STEPS,
                    "number_of_time_steps": STEPS}
    return _diffused(sd.heat_steps(mesh.surface, data, progress=progress, **settings).last())


def run_total_variation(mesh, data, options, progress):
    settings = {"automatic_fidelity": True}
    if options["weight"] > 0:
        settings = {"fidelity_weight": options["weight"]}
    if options["time"] > 0:
        settings.update(time_step=options["time"] / STEPS, number_of_time_steps=STEPS)
    else:
        settings["mode"] = "SteadyState"
    result = sd.intrinsic_tv_steps(mesh.surface, data, progress=progress, **settings).last()
    return _diffused(result, f"λ is {result.effective_fidelity_weight:.3g}")


def run_tensor_diffusion(mesh, data, options, progress):
    result = sd.tensor_diffusion_steps(
        mesh.surface, data, progress=progress, model=TENSORS[int(options["model"])],
        contrast=options["contrast"], fidelity_weight=options["weight"],
        time_step=options["time"] / STEPS, number_of_time_steps=STEPS).last()
    return _diffused(result, TENSORS[int(options["model"])])


def _diffused(result, note=""):
    return Outcome(result.values, {"Result": result.values}, history=result.history, note=note)


def run_edges(mesh, data, options, progress):
    given = {name: options[key] for name, key in (
        ("smoothing_length", "length"), ("edge_threshold", "threshold")) if options[key] > 0}
    result = sd.mumford_shah(
        mesh.surface, data, progress=progress, fidelity_weight=options["weight"], **given)
    return Outcome(result.values, {"Result": result.values, "Edges": result.edges},
                   history=result.history,
                   note=f"{len(result.curves)} edges of length {result.edge_length:.4g}")


def run_regions(mesh, data, options, progress):
    settings = {"number_of_regions": int(options["regions"])}
    if options["weight"] > 0:
        settings.update(fidelity_weight=options["weight"], automatic_fidelity=False)
    result = sd.segment(mesh.surface, data, progress=progress, **settings)
    areas = ", ".join(f"{area:.4g}" for area in result.areas)
    return Outcome(result.values, {"Region": result.values}, labels=True, note=f"areas {areas}")


def run_interpolation(mesh, data, options, progress):
    result = sd.interpolate(
        mesh.surface, data, progress=progress, exact=options["exact"] > 0,
        keep_range=options["range"] > 0, correlation_length=options["length"], compute_error=True)
    arrays = {"Result": result.values, "Error": result.error}
    return Outcome(result.values, arrays, note=f"{result.number_of_values} values, misfit "
                   + ", ".join(f"{misfit:.3g}" for misfit in result.misfit))


def run_normals(mesh, data, options, progress):
    result = sd.harmonic_map(
        mesh.surface, data, progress=progress, exponent=options["exponent"],
        time_step=options["time"] / STEPS, number_of_time_steps=STEPS,
        move_vertices=data is None and options["move"] > 0)
    moved = result.points if data is None and options["move"] > 0 else None
    return Outcome(result.values, {"Vectors": result.values}, points=moved, history=result.history,
                   note="" if moved is None else
                   f"points moved by {result.mean_displacement:.3g} on average")


def run_surface_denoising(mesh, _, options, progress):
    """The surface before and after, in grey."""
    result = sd.denoise_mesh(mesh.surface, noise_level=options["noise"],
                             surface_type=SURFACES[int(options["type"])], progress=progress)
    return Outcome(None, {"Displacement": result.points - mesh.surface.points}, points=result.points,
                   note="no noise was found" if result.noise_level == 0 else
                   f"{result.surface_type.replace('Automatic', 'mixed')} surface, "
                   f"noise of {result.noise_level:.3g}" + (
                       f", correlated over {result.correlation_length:.3g}"
                       if result.correlation_length > 0 else ""))


def run_texture(mesh, _, options, progress):
    result = sd.turing_texture(mesh.surface, feature_size=options["size"], seed=int(options["seed"]),
                               refine_to=0, progress=progress)
    return Outcome(result.texture, {"Texture": result.texture}, history=result.history,
                   note=f"the fastest-growing wavelength is {result.wavelength:.4g}")


def run_relief(mesh, _, options, progress):
    """The part with relief, for printing."""
    part = welded(mesh.surface)
    fine = sd.refine(part, options["size"] / EDGES_PER_WAVELENGTH, maximum_number_of_triangles=MOST_TRIANGLES)
    ratio = PATTERNS[list(PATTERNS)[int(options["pattern"])]]
    texture = sd.turing_texture(
        fine.surface, feature_size=options["size"], seed=int(options["seed"]), progress=progress,
        diffusion_rate1=2.6 * ratio, diffusion_rate2=2.6, number_of_time_steps=2000)
    overhang = options["overhang"] if options["overhang"] < 90 else None
    result = sd.relief(fine.surface, texture.texture, options["height"], overhang=overhang)
    wall = f", smallest wall {result.smallest_wall:.3g}" if np.isfinite(result.smallest_wall) else ""
    closed = "closed" if result.open_edges == 0 else f"{result.open_edges} open edges"
    return Outcome(texture.texture, {"Texture": texture.texture, "ReliefHeight": result.heights},
                   points=result.surface.points, triangles=result.surface.triangles,
                   note=f"{result.surface.n_faces} triangles, {closed}{wall}")


def run_directions(mesh, _, options, progress):
    """Directions on the faces, shown by noise that is smeared along them."""
    field_of_lines = sd.direction_field(
        mesh.surface, method="CurvatureAligned" if options["curvature"] > 0 else "Smooth",
        progress=progress)
    noise = np.random.default_rng(0).uniform(size=mesh.surface.n_points)
    lines = sd.heat(mesh.surface, noise, directions=field_of_lines, across_diffusivity=0.001,
                    time_step=10.0, number_of_time_steps=5)
    return Outcome(lines, {"Lines": lines}, cell_arrays={"Direction": field_of_lines})


#: Of a part for printing: a texture on these takes some ten seconds.
MOST_TRIANGLES = 600_000

SURFACES = ("Automatic", "CAD", "Organic")
TENSORS = ("Beltrami", "CoherenceEnhancing", "EdgeEnhancing")

WEIGHT = Slider("weight", "λ (0: found from the data)", 0, 20, 0.1, 0)

FILTERS = {entry.name: entry for entry in (
    Filter("heat", "Smooth: linear diffusion", "values", (
        Slider("width", "Width (FWHM; 0: λ and time instead)", 0, 0.2, 0.001, 0.03, True),
        Slider("weight", "λ", 0, 2, 0.01, 0.05),
        Slider("time", "Time, in squared edge lengths", 0.1, 50, 0.1, 4)), run_heat),
    Filter("intrinsic_tv", "Denoise: total variation", "values", (
        WEIGHT,
        Slider("time", "Time (0: until nothing changes)", 0, 20, 0.1, 0)), run_total_variation),
    Filter("tensor_diffusion", "Along edges and lines: tensor diffusion", "values", (
        choice("model", "Tensor", "Beltrami flow", "along lines", "along edges"),
        Slider("contrast", "Gradient of lines and edges, part of the range", 0.002, 0.2, 0.002, 0.02),
        Slider("weight", "λ", 0, 2, 0.01, 0),
        Slider("time", "Time, in squared edge lengths", 0.1, 100, 0.1, 4)), run_tensor_diffusion),
    Filter("mumford_shah", "Edges: Mumford-Shah", "values", (
        Slider("weight", "λ", 0.05, 5, 0.05, 1),
        Slider("length", "Width, in edge lengths (0: found)", 0, 30, 0.5, 0),
        Slider("threshold", "Jump, part of the range (0: found)", 0, 1, 0.01, 0)), run_edges),
    Filter("segment", "Regions", "values", (
        Slider("regions", "Number of regions", 2, 8, 1, 2),
        WEIGHT), run_regions),
    Filter("interpolate", "Values at few points (NaN elsewhere): spline", "values", (
        Slider("exact", "Keep the values exactly", 0, 1, 1, 0),
        Slider("range", "Stay between the smallest and the largest value", 0, 1, 1, 0),
        Slider("length", "Correlation length (0: infinite)", 0, 0.5, 0.001, 0, True)),
        run_interpolation),
    Filter("harmonic_map", "Normals and vectors: harmonic map", "vectors", (
        Slider("exponent", "Exponent p: 1 keeps creases, 2 smooths evenly", 1, 2, 0.05, 1),
        Slider("time", "Time", 0.1, 50, 0.1, 0.3),
        Slider("move", "Move the points along", 0, 1, 1, 1)), run_normals),
    Filter("denoise_mesh", "The mesh without noise: surface denoising", "none", (
        Slider("noise", "Noise of the points (0: found from the mesh)", 0, 0.01, 0.0001, 0, True),
        choice("type", "Surface", "found from the mesh", "CAD", "organic")), run_surface_denoising),
    Filter("turing_texture", "Texture: reaction and diffusion", "none", (
        Slider("size", "Width of a spot with its gap", 0.02, 0.3, 0.001, 0.08, True),
        Slider("seed", "Seed of the noise", 0, 100, 1, 0)), run_texture),
    Filter("relief", "Relief for printing", "none", (
        choice("pattern", "Pattern", *PATTERNS),
        Slider("size", "Width of a spot with its gap", 0.02, 0.3, 0.001, 0.1, True),
        Slider("height", "Height (below 0: carved)", -0.03, 0.03, 0.0005, 0.01, True),
        Slider("overhang", "No relief below this angle, in degrees (90: everywhere)", 0, 90, 1, 90),
        Slider("seed", "Seed of the noise", 0, 100, 1, 0)), run_relief),
    Filter("direction_field", "Direction field", "none", (
        Slider("curvature", "Along the curvature, not only smooth", 0, 1, 1, 1),), run_directions),
)}
