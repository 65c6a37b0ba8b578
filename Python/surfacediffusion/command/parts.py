# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Parts to print and their meshes: refine, texture."""
from __future__ import annotations

from .. import refine as bisect
from .. import turing_texture
from .._refinement import MAXIMUM_TRIANGLES
from ..files import new_data
from ..files.content import check_output_folder
from ..files.export import UNITS, export, kind_of_export, places_in_file
from . import common, flat, inputs, solids, values
from .printing import MAXIMUM_TRIANGLES_OF_PARTS, PATTERNS, edge_of_triangles, in_coordinates
from .printing import is_for_printing, print_texture, reaction_of_pattern, unit_of
from .report import number
from .stages import given, read_surface_for_output, require_array, write_array, write_new
from .surfaces import open_surface

REFINE = """
The name of OUTPUT gives its format: .ply, .off, .obj, .stl or .3mf. NEW is .npy: a row per vertex of OUTPUT,
those of SURFACE first.
"""

TEXTURE = """
Lengths may have a unit: 4mm, 0.2cm, 0.1in, 300um. Files of surfaces name no unit: --unit is that of
SURFACE.

""" + common.paragraph(
    "The name of OUTPUT gives its format. .stl is a part for printing and needs --relief; .obj, .off, .ply and, "
    "without relief, .3mf have the pattern as grey values, too. For these, vertices at the same place become one, "
    "and edges are bisected to 8 per FEATURE_SIZE, so that CAD files with few triangles do. "
    f"{common.NEW_FORMATS}, are the pattern at the vertices of SURFACE as they are.", 103)


def add_refine(commands):
    parser = commands.add(
        "refine", refine,
        "Bisect the long edges of a surface, so that data and patterns have room on large triangles: "
        "flat faces stay flat, sharp edges sharp, and data and colours at the vertices go along.",
        ["part.ply 0.5 fine.ply --data load.npy fine.npy"], REFINE)
    common.mesh(parser)
    common.any_hemisphere(parser)
    parser.add_argument("length", metavar="LENGTH", type=values.positive,
                        help="the length of the longest edge allowed, in the unit of the coordinates")
    common.output(parser, "the surface with shorter edges")
    parser.add_argument("--data", metavar="FILE", nargs=2, action="append", default=[],
                        help="two files: DATA at the vertices of SURFACE, and NEW for those at the "
                             "vertices of OUTPUT; may be repeated")
    parser.add_argument("--maximum-triangles", metavar="N", type=values.count,
                        help="refinement stops before there are more, with a warning (default: a LENGTH that "
                             f"needs more than {MAXIMUM_TRIANGLES} is refused)")


def refine(arguments, report):
    for output in (arguments.output, *(new for _, new in arguments.data)):
        check_output_folder(output)
    for _, new in arguments.data:
        require_array(new, "data of the new vertices")
    with report.timed("read"):
        surface = open_surface(arguments, arguments.surface, lengths=False)
        shortest = edge_of_triangles(surface.solver, MAXIMUM_TRIANGLES)
        if arguments.maximum_triangles is None and arguments.length < shortest:
            raise inputs.ArgumentProblem(
                f"LENGTH is {arguments.length:g}, for which the surface needs more than {MAXIMUM_TRIANGLES} "
                f"triangles; allowed: {1.01 * shortest:.3g} or more, or --maximum-triangles")
        columns = [inputs.read_values(path, surface, tables=False)[1] for path, _ in arguments.data]
    with report.working("Refinement") as progress:
        fine = bisect(surface.solver, arguments.length, progress=progress,
                      maximum_number_of_triangles=arguments.maximum_triangles or MAXIMUM_TRIANGLES)
    report.facts.update(longest_edge=number(fine.longest_edge), vertices=fine.surface.n_points,
                        triangles=fine.surface.n_faces)
    colors, lost = surface.beside()
    kind = kind_of_export(arguments.output)
    if colors is not None and kind == "stl":
        colors, lost = None, ["colours", *lost]
    if kind == surface.kind == "3mf":
        lost = []
    with report.timed("write"):
        points = places_in_file(arguments.output, fine.surface.points, report.warn)
        objects = solids.with_faces(surface.image, fine.faces) if surface.kind == "3mf" else None
        export(arguments.output, points, fine.surface.triangles,
               None if colors is None else fine.at_points(colors), objects=objects)
        if lost:
            report.warn(f"{arguments.output} has none of the {', '.join(lost)} of {surface.path}; --data takes "
                        "data at the vertices along")
        for (_, new), given_values in zip(arguments.data, columns):
            write_array(new, fine.at_points(given_values))
    report.say_written(arguments.output, f"{fine.surface.n_faces} triangles, edges of at most "
                                         f"{fine.longest_edge:.4g}")


def add_texture(commands):
    parser = commands.add(
        "texture", texture,
        "Grow spots or labyrinths on a surface by reaction and diffusion, as values, or as relief "
        "for printing: without seams, across the edges of a part.",
        ["part.stl 4mm out.stl --relief 0.4mm --pattern labyrinth",
         "lh.pial.surf.gii 8 lh.spots.shape.gii --seed 1"], TEXTURE)
    common.mesh(parser)
    parser.add_argument("size", metavar="FEATURE_SIZE", type=values.positive_length,
                        help="the wavelength of the pattern")
    common.output(parser, "the part, or the pattern as values")
    parser.add_argument("--relief", metavar="HEIGHT", type=values.length,
                        help="raise the pattern by this height along the normal; --relief=-0.4mm "
                             "carves it")
    parser.add_argument("--base", metavar="HEIGHT", type=values.length,
                        help="the height where the pattern is 0 (default 0)")
    parser.add_argument("--flank", metavar="WIDTH", type=values.length_or_zero,
                        help="relief of two levels with a slope of this width between them; 0: as "
                             "steep as the triangles allow (default: the relief is smooth)")
    parser.add_argument("--overhang", metavar="DEGREES",
                        type=values.numbers("degrees from 0 to 90", lambda value: 0 <= value <= 90),
                        help="no relief on faces that face down, against z, more steeply than this")
    parser.add_argument("--keep-flat", metavar="REGION", action="append", type=flat.region,
                        help="no relief in a region, and all of it beyond its --border: " + flat.ALLOWED
                             + "; may be repeated")
    parser.add_argument("--border", metavar="WIDTH", type=values.length_or_zero,
                        help="the width in which relief grows beside --keep-flat (default 0)")
    parser.add_argument("--min-wall", metavar="WIDTH", type=values.positive_length,
                        help="warn where the part with relief is thinner")
    parser.add_argument("--two-colour", action="store_true",
                        help="the raised pattern is a solid of its own, of another material (.3mf)")
    parser.add_argument("--weld", metavar="LENGTH", type=values.length_or_zero,
                        help="join corners of facets that are no more apart, at open edges, and edges with a vertex "
                             "on them; 0: only corners at one place (default: 1e-5 of the size of the part, and at "
                             "most 1 %% of its open edges)")
    parser.add_argument("--printer", metavar="NOZZLE", type=values.positive_length,
                        help="edges of at most this length, as wide as the printer draws; the number of triangles and "
                             "the size of the file are said before")
    parser.add_argument("--unit", choices=tuple(UNITS),
                        help="the unit of the coordinates of SURFACE (default mm, and that of the file for .3mf)")
    parser.add_argument("--maximum-triangles", metavar="N", type=values.count,
                        help="the largest number of triangles of a part, of which a million take about a "
                             f"minute (default {MAXIMUM_TRIANGLES_OF_PARTS}, with --printer "
                             f"{MAXIMUM_TRIANGLES}); what needs more is refused")
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--pattern", choices=tuple(PATTERNS),
                      help="the pattern (default for .stl, .3mf, .obj, .off and with --relief: labyrinth)")
    kind.add_argument("--kinetics", metavar="NAME",
                      help="the reaction: Turing (default), Schnakenberg, GrayScott, Brusselator, "
                           "GiererMeinhardt or FitzHughNagumo")
    common.merge(parser)
    common.seed(parser, "of the initial noise")
    common.steps(parser, "largest number of time steps (default 640, for parts to print 2000)")


def texture(arguments, report):
    surface = read_surface_for_output(arguments, report, weld=False)
    arguments.unit = unit_of(arguments, surface)
    if arguments.relief is None:
        inputs.refuse(arguments, ["--base", "--flank", "--overhang", "--keep-flat", "--border", "--min-wall",
                                  "--two-colour"], "without --relief", "both")
    if is_for_printing(arguments, surface):
        inputs.refuse(arguments, ["--merge", "--merge-tolerance"],
                      "for parts, whose vertices at the same place are one", "for values at the vertices")
        print_texture(arguments, surface, report)
        return
    inputs.refuse(arguments, ["--maximum-triangles", "--weld", "--printer"], "for values at the vertices",
                  "for parts")
    target = new_data(surface, arguments.output, ["Texture"])
    size = in_coordinates(arguments.size, arguments.unit)
    options = given(kinetics=arguments.kinetics, number_of_time_steps=arguments.steps, **common.merging(arguments))
    if arguments.pattern:
        options.update(reaction_of_pattern(arguments.pattern))
    with report.working("Texture") as progress:
        result = turing_texture(surface.solver, progress=progress, feature_size=size, seed=arguments.seed,
                                refine_to=0, **options)
    report.facts.update(feature_size=size, seed=arguments.seed, steps=result.step,
                        wavelength=number(result.wavelength))
    write_new(arguments, report, target, result.texture[:, None])
