# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Removal of noise: of data (denoise), of the points of a surface (denoise-mesh), of its normals."""
from __future__ import annotations

import numpy as np

from .. import denoise_mesh as remove_noise
from .. import harmonic_map, intrinsic_tv_steps
from ..files import new_data
from ..files.content import check_output_name
from . import common, inputs, values
from .report import number
from .stages import (
    change_data, columns_of_arrays, given, read_surface_for_output, write_new, write_points)

MESH = f"""
{common.SURFACES}
OUTPUT has the format of SURFACE, its faces and its data. Normals in the file are computed again, or
left out where they belong to corners of faces.
"""


def add_denoise(commands):
    parser = commands.add(
        "denoise", denoise,
        "Remove noise and keep edges, by minimising total variation. Without --weight, the "
        "weight is chosen so that the noise removed has the estimated (or given) level.",
        ["scan.ply scan.ply clean.ply", "lh.white lh.curv lh.curv.clean --weight 3"])
    common.data_to_data(parser)
    common.faces(parser)
    level = parser.add_mutually_exclusive_group()
    common.positive(level, "--weight", "W", "the fidelity weight, in natural units; smaller removes more")
    common.noise(level, "the noise, in the unit of the data")
    parser.add_argument("--colors", choices=("rgb", "opponent", "chromaticity"), default="rgb",
                        help="for colours. rgb: red, green and blue have their edges in common "
                             "(default); opponent: noise of hues is removed more than that of "
                             "brightness; chromaticity: brightness and hue are separate")


def denoise(arguments, report):
    options = given(fidelity_weight=arguments.weight, noise_level=arguments.noise)
    model = {"rgb": "RGB", "opponent": "Opponent",
             "chromaticity": "ChromaticityBrightness"}[arguments.colors]
    found = []
    weights = report.facts.setdefault("fidelity_weights", [])

    def compute(surface, values, **run):
        found.append(values.shape[1] == 3)
        result = intrinsic_tv_steps(
            surface, values, on_faces=arguments.faces, mode="SteadyState",
            color_model=model if found[-1] else "RGB", **options, **run).last()
        weights.append(number(result.effective_fidelity_weight))
        return result.values

    change_data(arguments, report, "Denoising", compute, columns_of_arrays)
    if arguments.colors != "rgb" and not any(found):
        report.warn(f"--colors is {arguments.colors}, but {arguments.data} has no colours")


def add_denoise_mesh(commands):
    parser = commands.add(
        "denoise-mesh", denoise_mesh,
        "Remove the noise of the points of a surface, and keep its sharp edges, boundaries and "
        "volume. The level of the noise is measured, and all weights follow from it.",
        ["scan.ply clean.ply", "part.stl clean.stl --type cad --noise 0.02"], MESH)
    common.mesh(parser)
    common.output(parser, "the surface with moved points")
    common.noise(parser, "the noise along the normal, in the unit of the coordinates; larger removes "
                         "more (default: measured)")
    parser.add_argument("--type", choices=("automatic", "cad", "organic"), default="automatic",
                        help="cad: smooth faces with sharp edges; organic: smooth shapes with "
                             "details, such as scans; automatic: cad unless details are lost "
                             "(default)")
    common.positive(parser, "--noise-length", "N", "over how many edges points share their noise, as those of "
                                                   "depth cameras do: the deviation of its kernel (default: "
                                                   "measured)")
    common.positive(parser, "--crease-angle", "DEG", "edges between triangles that differ by this angle and "
                                                     "more, in degrees, stay as they are")
    common.positive(parser, "--limit", "LENGTH", "no point moves farther")
    common.merge(parser)
    parser.add_argument("--fixed", metavar="FILE",
                        help="data in which vertices stay where the first column is above 0")


def denoise_mesh(arguments, report):
    surface = read_surface_for_output(arguments, report)
    check_output_name(arguments.output, surface.kind)
    options = {"noise_level": arguments.noise or 0.0,
               "surface_type": {"cad": "CAD"}.get(arguments.type, arguments.type.capitalize()),
               **given(noise_length=arguments.noise_length, crease_angle=arguments.crease_angle,
                       displacement_limit=arguments.limit), **common.merging(arguments)}
    if arguments.fixed is not None:
        with report.timed("read"):
            options["fixed"] = dict(inputs.read_marks(arguments.fixed, {"": surface}))[id(surface)]
    with report.working("Denoising") as progress:
        result = remove_noise(surface.solver, progress=progress, **options)
    write_points(arguments, report, surface, result, _denoising_text(result))
    report.add_numbers(result, "noise_level", "correlation_length", "mean_displacement",
                       "maximum_displacement", "volume_before", "volume_after", "mean_edge_length")
    report.facts["surface_type"] = result.surface_type


def _denoising_text(result):
    if result.maximum_displacement == 0:
        return "no noise was found, no point moved" if result.noise_level == 0 else "no point moved"
    kind = {"Automatic": "CAD and Organic parts"}.get(result.surface_type, result.surface_type)
    correlated = (f", correlated over {result.correlation_length:.4g}"
                  if result.correlation_length > 0 else "")
    return f"{kind}, noise {result.noise_level:.4g}{correlated}, {_moved_text(result)}"


def _moved_text(result):
    return (f"points moved by {result.mean_displacement:.4g} on average, at most "
            f"{result.maximum_displacement:.4g}")


def add_normals(commands):
    parser = commands.add(
        "normals", normals,
        "Regularise the normals of a surface by harmonic maps. With --move, denoise the "
        "surface: its points are moved so that its triangles turn with them, and OUTPUT is a surface.",
        ["scan.ply clean.ply --move"], common.NEW)
    common.mesh(parser)
    common.output(parser, "three columns, or with --move a surface in the format of SURFACE")
    parser.add_argument("--move", action="store_true", help="move the points")
    parser.add_argument("--exponent", metavar="P", default=1.0,
                        type=values.numbers("a number from 1 to 2", lambda value: 1 <= value <= 2),
                        help="1 keeps creases (default), 2 smooths evenly")
    common.positive(parser, "--time-step", "T", "in natural units")
    common.steps(parser)
    common.merge(parser)


def normals(arguments, report):
    surface = read_surface_for_output(arguments, report)
    if arguments.move:
        check_output_name(arguments.output, surface.kind)
    else:
        target = new_data(surface, arguments.output, ["nx", "ny", "nz"])
    options = given(time_step=arguments.time_step, number_of_time_steps=arguments.steps,
                    **common.merging(arguments))
    with report.working("Normals") as progress:
        result = harmonic_map(surface.solver, exponent=arguments.exponent, move_vertices=arguments.move,
                              progress=progress, **options)
    report.facts.update(exponent=arguments.exponent, moved=arguments.move, steps=result.step)
    if not arguments.move:
        write_new(arguments, report, target, np.asarray(result.values))
        return
    write_points(arguments, report, surface, result, _moved_text(result))
    report.add_numbers(result, "mean_displacement", "maximum_displacement", "volume_before",
                       "volume_after")
