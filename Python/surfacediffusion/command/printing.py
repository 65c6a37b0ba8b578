# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Textures for printing: from a part to the part with relief, in one line."""
from __future__ import annotations

import numpy as np

from .. import Surface, refine, relief, turing_texture
from .._refinement import EDGES_PER_WAVELENGTH, FEWEST_EDGES_PER_WAVELENGTH
from ..files.content import check_output_folder
from ..files.export import UNITS, export, kind_of_export, places_in_file
from .inputs import ArgumentProblem
from .report import number

#: D1/D2 of the default kinetics for each pattern.
PATTERNS = {"labyrinth": 18.0, "spots": 5.0, "net": 30.0}

#: Parts with more by default are mistakes of the unit rather than wanted.
MAXIMUM_TRIANGLES_OF_PARTS = 1_000_000

#: Patterns from a coarser mesh are flatter: more points than by default may have all steps, which take
#: a minute of processor time at this size.
COARSE_START_SIZE = 250_000


def reaction_of_pattern(pattern):
    return {"diffusion_rate1": 2.6 * PATTERNS[pattern], "diffusion_rate2": 2.6}


def is_for_printing(arguments, surface):
    """Whether the output of the command texture is a surface, and not values at its vertices, which PLY
    has for a PLY file."""
    kind = kind_of_export(arguments.output)
    return arguments.relief is not None or kind is not None and (kind != "ply" or surface.kind != "ply")


def print_texture(arguments, surface, report):
    """Refine, grow the texture, raise it as relief, and write the surface. surface: as read."""
    check_output_folder(arguments.output)
    kind = kind_of_export(arguments.output)
    if kind is None:
        raise ArgumentProblem(f"{arguments.output}: the name announces no format for a part with relief; "
                              "allowed: .stl, .3mf, .obj, .off or .ply")
    if arguments.relief is None and kind in ("stl", "3mf"):
        raise ArgumentProblem(f"{arguments.output}: without relief nothing of the pattern is in it; "
                              "allowed: --relief HEIGHT, or .obj, .off or .ply, which have colours")
    unit = arguments.unit
    lengths = {}
    for name in ("size", "relief", "base", "flank"):
        _warn_without_unit(name, getattr(arguments, name), unit, report)
        lengths[name] = in_coordinates(getattr(arguments, name), unit)
    size, height = lengths["size"], lengths["relief"]
    part = welded(surface.solver)
    extent = float(np.linalg.norm(part.points.max(axis=0) - part.points.min(axis=0)))
    if not size < extent:
        raise ArgumentProblem(f"FEATURE_SIZE is {size:.4g} {unit}, but the part is {extent:.4g} {unit} "
                              "from corner to corner; allowed: smaller features")
    most = max(arguments.maximum_triangles or MAXIMUM_TRIANGLES_OF_PARTS, part.n_faces)
    smallest = FEWEST_EDGES_PER_WAVELENGTH * edge_of_triangles(part, most)
    if size < smallest:
        raise ArgumentProblem(f"FEATURE_SIZE is {size:.4g} {unit}, for which the part, {extent:.4g} {unit} "
                              f"from corner to corner, needs more than {most} triangles; "
                              f"allowed: {1.01 * smallest:.3g} {unit} or more, or --maximum-triangles")
    if height is not None and not abs(height) < extent:
        raise ArgumentProblem(f"--relief is {height:.4g} {unit}, but the part is {extent:.4g} {unit} from "
                              "corner to corner; allowed: less")
    options = {"kinetics": arguments.kinetics} if arguments.kinetics else reaction_of_pattern(
        arguments.pattern or "labyrinth")
    with report.working("Refinement", "refine") as progress:
        fine = refine(part, size / EDGES_PER_WAVELENGTH, progress=progress,
                      maximum_number_of_triangles=most).surface
    options.update(coarse_start_size=COARSE_START_SIZE, stop_tolerance=0.02, refine_to=0)
    options["number_of_time_steps"] = arguments.steps or 2000
    with report.working("Texture", "texture") as progress:
        texture = turing_texture(fine, feature_size=size, seed=arguments.seed, progress=progress,
                                 **options)
    points, triangles = fine.points, fine.triangles
    report.facts.update(feature_size=size, unit=unit, seed=arguments.seed, steps=texture.step,
                        wavelength=number(texture.wavelength), triangles=len(triangles))
    said = [f"{len(triangles)} triangles", f"pattern of {size:.4g} {unit}"]
    if height is not None:
        two = arguments.flank is not None
        with report.working("Relief", "relief") as progress:
            result = relief(fine, texture.texture, height, base=lengths["base"] or 0.0,
                            levels="Two" if two else "Smooth", flank=lengths["flank"] or 0.0,
                            overhang=arguments.overhang, progress=progress)
        points, triangles = result.surface.points, result.surface.triangles
        report.facts.update(
            relief=height, volume_change=number(result.volume_change),
            lowered_points=result.lowered_points, open_edges=result.open_edges,
            non_manifold_edges=result.non_manifold_edges,
            crossing_triangles=result.crossing_triangles, smallest_wall=number(result.smallest_wall))
        said.append(f"relief of {height:.4g} {unit}")
        if np.isfinite(result.smallest_wall):
            said.append(f"smallest wall {result.smallest_wall:.3g} {unit}")
        said.append("closed" if result.open_edges == 0 else f"{result.open_edges} open edges")
        said.append("manifold" if result.non_manifold_edges == 0
                    else f"{result.non_manifold_edges} edges of more than two triangles")
    shades = np.rint(255 * np.clip(texture.texture, 0, 1)).astype(np.uint8)
    points = places_in_file(arguments.output, points, report.warn)
    if kind == "stl":
        _warn_of_rounding(arguments.output, points, triangles, report)
    with report.timed("write"):
        export(arguments.output, points, triangles, np.repeat(shades[:, None], 3, axis=1), unit)
    report.say_written(arguments.output, ", ".join(said))


def _warn_of_rounding(path, points, triangles, report):
    """Of triangles that collapse in single precision."""
    _, before = np.unique(points, axis=0, return_inverse=True)
    _, after = np.unique(points.astype(np.float32), axis=0, return_inverse=True)
    collapsed = [np.any(np.roll(corners, 1, axis=1) == corners, axis=1).sum()
                 for corners in (before.reshape(-1)[triangles], after.reshape(-1)[triangles])]
    if collapsed[1] > collapsed[0]:
        report.warn(f"{path}: {collapsed[1] - collapsed[0]} triangles have no area in the precision of STL; .ply and "
                    ".obj have more digits")


def edge_of_triangles(surface, count):
    """The edge length of so many triangles of equal sides: with as many, a refined surface has longer ones."""
    area = surface._triangle_areas().sum()
    return float(np.sqrt(area / count * 4 / np.sqrt(3)))


def welded(surface):
    """Vertices at the same place are one: files for viewers have one per face."""
    points, numbers = np.unique(surface.points + 0.0, axis=0, return_inverse=True)
    return Surface(points, numbers.reshape(-1)[surface.triangles])


def in_coordinates(length, unit):
    """A length of the command line, a number and its unit or None, in the unit of the coordinates."""
    if length is None:
        return None
    value, given = length
    return value if given is None else value * UNITS[given][0] / UNITS[unit][0]


def _warn_without_unit(name, length, unit, report):
    if length is not None and length[1] is None and length[0] != 0:
        option = "FEATURE_SIZE" if name == "size" else "--" + name
        report.warn(f"{option} {length[0]:g} has no unit: taken as {length[0]:g} {unit}, the unit of the "
                    "coordinates (--unit)")
