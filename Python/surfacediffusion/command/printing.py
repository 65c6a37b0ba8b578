# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Textures for printing: from a part to the part with relief, in one line."""
from __future__ import annotations

import os
from dataclasses import replace

import numpy as np

from .. import Surface, _core, refine, relief, turing_texture
from .._refinement import EDGES_PER_WAVELENGTH, FEWEST_EDGES_PER_WAVELENGTH, MAXIMUM_TRIANGLES
from ..files.content import check_output_folder
from ..files.export import UNITS, export, kind_of_export, places_in_file
from .flat import parts_of_relief
from .inputs import ArgumentProblem
from .report import counted, number
from .solids import as_in_stl, describe, objects_of, weld_part

#: D1/D2 of the default kinetics for each pattern.
PATTERNS = {"labyrinth": 18.0, "spots": 5.0, "net": 30.0}

#: Parts with more by default are mistakes of the unit rather than wanted.
MAXIMUM_TRIANGLES_OF_PARTS = 1_000_000

#: Patterns from a coarser mesh are flatter: more points than by default may have all steps, which take
#: a minute of processor time at this size.
COARSE_START_SIZE = 250_000

#: Bytes of files, per triangle.
_BYTES = {"stl": 50, "3mf": 20, "obj": 48, "off": 44, "ply": 27}

#: Two materials: the part, and its pattern.
_MATERIALS = (("part", (200, 200, 200)), ("pattern", (40, 40, 40)))


def reaction_of_pattern(pattern):
    return {"diffusion_rate1": 2.6 * PATTERNS[pattern], "diffusion_rate2": 2.6}


def is_for_printing(arguments, surface):
    """Whether the output of the command texture is a surface, and not values at its vertices, which PLY
    has for a PLY file."""
    kind = kind_of_export(arguments.output)
    return arguments.relief is not None or kind is not None and (kind != "ply" or surface.kind != "ply")


def unit_of(arguments, surface):
    """The unit of the coordinates, which 3MF files name."""
    if surface.kind != "3mf":
        return arguments.unit or "mm"
    if arguments.unit not in (None, surface.image.unit):
        raise ArgumentProblem(f"--unit is {arguments.unit}, but the unit of {surface.path} is {surface.image.unit}; "
                              f"allowed: {surface.image.unit}, or none")
    return surface.image.unit


def print_texture(arguments, surface, report):
    """Refine, grow the texture, raise it as relief, and write the surface. surface: as read."""
    check_output_folder(arguments.output)
    _check_output(arguments)
    lengths = _lengths(arguments, report)
    part = weld_part(surface, lengths["weld"], arguments.unit, report)
    fine = _refine(arguments, part.surface, lengths, report)
    faces = part.faces[fine.faces]
    fine = fine.surface
    texture = _grow(arguments, fine, lengths["size"], report)
    said = [f"{len(fine.triangles)} triangles", f"pattern of {lengths['size']:.4g} {arguments.unit}"]
    points, triangles = fine.points, fine.triangles
    if lengths["relief"] is not None:
        keeps = parts_of_relief(arguments.keep_flat or [], lengths["border"] or 0.0, surface, fine, faces,
                                lambda length: in_coordinates(length, arguments.unit)) if arguments.keep_flat else None
        result = _raise(arguments, fine, texture.texture, lengths, keeps, report)
        points, triangles = result.surface.points, result.surface.triangles
        said += _describe_relief(arguments, result, lengths, report)
    shades = np.repeat(np.rint(255 * np.clip(texture.texture, 0, 1)).astype(np.uint8)[:, None], 3, axis=1)
    if arguments.two_colour:
        points, triangles, raised = _divide(fine, points, triangles, texture.texture)
        faces = shades = None
    else:
        raised = None
    points = places_in_file(arguments.output, points, report.warn)
    _write(arguments, part, points, triangles, (shades, faces, raised), said, report)


def _check_output(arguments):
    kind = kind_of_export(arguments.output)
    if kind is None:
        raise ArgumentProblem(f"{arguments.output}: the name announces no format for a part with relief; "
                              "allowed: .stl, .3mf, .obj, .off or .ply")
    if arguments.relief is None and kind == "stl":
        raise ArgumentProblem(f"{arguments.output}: without relief nothing of the pattern is in it; "
                              "allowed: --relief HEIGHT, or .3mf, .obj, .off or .ply, which have colours")
    if arguments.two_colour and kind != "3mf":
        raise ArgumentProblem(f"{arguments.output}: --two-colour makes two materials, which .{kind} has not; "
                              "allowed: .3mf")
    if arguments.two_colour and (arguments.relief[0] <= 0 or (arguments.base or (0,))[0] < 0):
        raise ArgumentProblem("--two-colour raises the pattern as a solid of its own; allowed: --relief above 0, and "
                              "--base of 0 or more")
    if arguments.border is not None and not arguments.keep_flat:
        raise ArgumentProblem("--border is that of --keep-flat, which is not given; allowed: both")


def _lengths(arguments, report):
    """In the unit of the coordinates; None for those that are not given."""
    lengths = {}
    for name in ("size", "relief", "base", "flank", "weld", "border", "min_wall", "printer"):
        _warn_without_unit(name, getattr(arguments, name), arguments.unit, report)
        lengths[name] = in_coordinates(getattr(arguments, name), arguments.unit)
    return lengths


def _refine(arguments, part, lengths, report):
    """The part with edges for the pattern and, if it is given, for the printer."""
    unit, size, height, nozzle = arguments.unit, lengths["size"], lengths["relief"], lengths["printer"]
    extent = float(np.linalg.norm(part.points.max(axis=0) - part.points.min(axis=0)))
    if not size < extent:
        raise ArgumentProblem(f"FEATURE_SIZE is {size:.4g} {unit}, but the part is {extent:.4g} {unit} "
                              "from corner to corner; allowed: smaller features")
    if height is not None and not abs(height) < extent:
        raise ArgumentProblem(f"--relief is {height:.4g} {unit}, but the part is {extent:.4g} {unit} from "
                              "corner to corner; allowed: less")
    default = MAXIMUM_TRIANGLES_OF_PARTS if nozzle is None else MAXIMUM_TRIANGLES
    most = max(arguments.maximum_triangles or default, part.n_faces)
    shortest = edge_of_triangles(part, most)
    if size < FEWEST_EDGES_PER_WAVELENGTH * shortest:
        raise ArgumentProblem(f"FEATURE_SIZE is {size:.4g} {unit}, for which the part, {extent:.4g} {unit} "
                              f"from corner to corner, needs more than {most} triangles; allowed: "
                              f"{1.01 * FEWEST_EDGES_PER_WAVELENGTH * shortest:.3g} {unit} or more, or "
                              f"--maximum-triangles {_count(part, size / FEWEST_EDGES_PER_WAVELENGTH)}")
    if nozzle is not None and nozzle < shortest:
        raise ArgumentProblem(f"--printer is {nozzle:.4g} {unit}, for which the part, {extent:.4g} {unit} from corner "
                              f"to corner, needs more than {most} triangles; allowed: {1.01 * shortest:.3g} {unit} or "
                              f"more, or --maximum-triangles {_count(part, nozzle)}")
    length = min(size / EDGES_PER_WAVELENGTH, nozzle or np.inf)
    with report.working("Refinement", "refine") as progress:
        fine = refine(part, length, progress=progress, maximum_number_of_triangles=most)
    if nozzle is not None:
        count = fine.surface.n_faces
        megabytes = count * _BYTES[kind_of_export(arguments.output)] / 1e6
        report.facts.update(longest_edge=number(fine.longest_edge), megabytes=megabytes)
        report.announce(f"{arguments.output}: {count} triangles with edges of at most {fine.longest_edge:.3g} {unit}, "
                        f"about {megabytes:.3g} MB")
    return fine


def _grow(arguments, fine, size, report):
    options = {"kinetics": arguments.kinetics} if arguments.kinetics else reaction_of_pattern(
        arguments.pattern or "labyrinth")
    options.update(coarse_start_size=COARSE_START_SIZE, stop_tolerance=0.02, refine_to=0)
    options["number_of_time_steps"] = arguments.steps or 2000
    with report.working("Texture", "texture") as progress:
        texture = turing_texture(fine, feature_size=size, seed=arguments.seed, progress=progress,
                                 **options)
    report.facts.update(feature_size=size, unit=arguments.unit, seed=arguments.seed, steps=texture.step,
                        wavelength=number(texture.wavelength), triangles=fine.n_faces)
    return texture


def _raise(arguments, fine, texture, lengths, keeps, report):
    """keeps: per point the part of the relief; None for all of it."""
    height, base, two = lengths["relief"], lengths["base"] or 0.0, arguments.flank is not None
    profile = {"base": base, "levels": "Two" if two else "Smooth", "flank": lengths["flank"] or 0.0}
    if keeps is not None:
        texture = keeps * _core.relief_heights(fine._core, texture, height, base, two, 0.5, profile["flank"])
        height, profile = 1.0, {}
    with report.working("Relief", "relief") as progress:
        return relief(fine, texture, height, overhang=arguments.overhang, progress=progress, **profile)


def _describe_relief(arguments, result, lengths, report):
    """What is said of it. Walls that are thinner than wanted are a warning."""
    unit, height, least = arguments.unit, lengths["relief"], lengths["min_wall"]
    report.facts.update(
        relief=height, volume_change=number(result.volume_change), lowered_points=result.lowered_points,
        crossing_triangles=result.crossing_triangles, smallest_wall=number(result.smallest_wall))
    said = [f"relief of {height:.4g} {unit}"]
    if np.isfinite(result.smallest_wall):
        said.append(f"smallest wall {result.smallest_wall:.3g} {unit}")
    if least is not None:
        thin = int((result.walls < least).sum())
        report.facts.update(min_wall=least, thin_points=thin)
        if thin:
            place = result.surface.points[int(np.argmin(result.walls))]
            report.facts["thinnest_at"] = place.tolist()
            report.warn(f"the wall is thinner than --min-wall {least:.4g} {unit} at {counted(thin, 'point')}, and "
                        f"{result.smallest_wall:.3g} {unit} at {' '.join(f'{x:.4g}' for x in place)}: lower --relief, "
                        "or --keep-flat there")
    return said


def _divide(fine, points, triangles, texture):
    """The part and its pattern as solids that share no point: points, triangles, and which are the pattern's."""
    places, corners, raised = _core.divide_relief(
        Surface(fine.points, triangles)._core, np.ascontiguousarray(points), np.ascontiguousarray(texture - 0.5))
    raised = raised.astype(bool)
    corners = corners + len(places) * raised[:, None]
    used, numbers = np.unique(corners, return_inverse=True)
    return np.vstack([places, places])[used], numbers.reshape(-1, 3), raised


def _write(arguments, part, points, triangles, beside, said, report):
    """beside: colours of the points, the face of the file of each triangle, and which are those of the pattern as a
    solid of its own; None for none."""
    colors, faces, raised = beside
    kind, unit, objects, materials = kind_of_export(arguments.output), arguments.unit, None, ()
    if kind == "stl":
        places, kept = as_in_stl(points, triangles)
        if len(kept) < len(triangles):
            report.warn(f"{arguments.output}: {len(triangles) - len(kept)} triangles have no area in the precision of "
                        "STL, and are left out; .ply and .obj have more digits")
        points, triangles = places, kept
    words, found = describe(kind, points, triangles, report)
    report.facts["triangles"] = len(triangles)
    if kind == "3mf":
        stem = os.path.splitext(os.path.basename(arguments.surface))[0]
        if raised is None:
            objects = objects_of(part, unit, faces, found, stem)
            colors = colors if arguments.relief is None else None
        else:
            objects, materials = replace(objects_of(part, unit, np.zeros(len(triangles), int), found, stem), names=[
                stem, f"{stem} pattern"], of_face=raised.astype(int), colors=None), _MATERIALS
        report.facts["objects"] = objects.names
    with report.timed("write"):
        export(arguments.output, points, triangles, colors, unit, objects, materials)
    report.say_written(arguments.output, ", ".join(said + words))


def edge_of_triangles(surface, count):
    """The edge length of so many triangles of equal sides: with as many, a refined surface has longer ones."""
    area = surface._triangle_areas().sum()
    return float(np.sqrt(area / count * 4 / np.sqrt(3)))


def _count(surface, length):
    """Of triangles that bisection leaves with edges of this length, in two digits: three times those of equal sides,
    at most."""
    count = 3 * surface._triangle_areas().sum() / (length**2 * np.sqrt(3) / 4)
    digit = 10.0 ** (np.floor(np.log10(count)) - 1)
    return int(np.ceil(count / digit) * digit)


def in_coordinates(length, unit):
    """A length of the command line, a number and its unit or None, in the unit of the coordinates."""
    if length is None:
        return None
    value, given = length
    return value if given is None else value * UNITS[given][0] / UNITS[unit][0]


def _warn_without_unit(name, length, unit, report):
    if length is not None and length[1] is None and length[0] != 0:
        option = "FEATURE_SIZE" if name == "size" else "--" + name.replace("_", "-")
        report.warn(f"{option} {length[0]:g} has no unit: taken as {length[0]:g} {unit}, the unit of the "
                    "coordinates (--unit)")
