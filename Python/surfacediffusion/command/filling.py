# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Values where there are none: inpaint fills in missing data, interpolate continues values at points."""
from __future__ import annotations

import numpy as np

from .. import heat, intrinsic_tv
from .. import interpolate as fit
from ..files import new_data
from ..files.content import check_output_folder
from . import common, inputs, values
from .report import number, number_text
from .stages import (
    change_data, columns_of_arrays, columns_of_missing, given, read_surface_for_output)

POINTS = f"""
{common.SURFACES}
VALUES: a text file with a row x, y, z, value, ... for each point, separated by commas or spaces and
with or without a line of names (x, y, z may then be in any columns), whose points count at the nearest
points of SURFACE; or data with a value for each vertex, in the formats of the other commands. NaN, and an
empty value in a text file, is unknown.{common.NEW}"""


def add_inpaint(commands):
    parser = commands.add(
        "inpaint", inpaint,
        "Fill in missing values and keep all others exactly. Missing are NaN, zeros with "
        "--fix-zeros, and vertices where the first column of --missing is above 0.",
        ["lh.pial lh.thickness lh.thickness.full --fix-zeros"])
    common.data_to_data(parser)
    common.faces(parser)
    parser.add_argument("--missing", metavar="FILE", help="missing where the first column is above 0")
    parser.add_argument("--model", choices=("heat", "tv"), default="heat",
                        help="heat: harmonic functions, smooth (default); tv: total variation, "
                             "which continues edges")
    parser.add_argument("--intrinsic-delaunay", action="store_true",
                        help="flip edges along the surface first, for triangles with obtuse angles: with heat, "
                             "no value then leaves the range of its neighbours'")


def inpaint(arguments, report):
    model, groups = {"heat": (heat, columns_of_missing), "tv": (intrinsic_tv, columns_of_arrays)}[
        arguments.model]
    report.facts["model"] = arguments.model

    def compute(surface, values, **run):
        if not np.isnan(values).any():
            return values
        return model(surface, values, on_faces=arguments.faces, mode="SteadyState",
                     hold_known_values=True, intrinsic_delaunay=arguments.intrinsic_delaunay, **run)

    change_data(arguments, report, "Inpainting", compute, groups, arguments.missing)
    if not any(row["missing"] for row in report.facts["columns"]):
        report.warn(f"{arguments.data}: nothing is missing, the values are unchanged")


def add_interpolate(commands):
    parser = commands.add(
        "interpolate", interpolate,
        "Compute a smooth map from values at a few points, on the surface or beside it. The values "
        "are smoothed by an amount that generalised cross-validation finds, unless --exact or "
        "--noise is given. Parts of the surface that are connected to no value are NaN.",
        ["atrium.vtp electrodes.csv times.vtp --error errors.npy",
         "lh.pial.surf.gii implants.txt map.shape.gii --exact"], POINTS)
    common.mesh(parser)
    common.any_hemisphere(parser)
    parser.add_argument("values", metavar="VALUES", help="the values, with their points or at vertices")
    common.output(parser, "the map, values at the vertices")
    level = parser.add_mutually_exclusive_group()
    level.add_argument("--exact", action="store_true", help="keep the values exactly")
    common.noise(level, "the values' noise, in their unit (default: estimated)")
    common.positive(level, "--smoothing", "MU",
                    "the strength of the smoothing, in squared mean edge lengths (default: found)")
    common.positive(parser, "--length", "L",
                    "the distance beyond which the map returns to the mean of the values, in the unit of "
                    "the coordinates (default: it continues smoothly)")
    parser.add_argument("--flat", action="store_true",
                        help="become flat at the boundary of the surface, in place of continuing slopes")
    parser.add_argument("--robust", action="store_true",
                        help="find values that the others contradict, and leave them out")
    parser.add_argument("--keep-range", action="store_true",
                        help="stay between the smallest and the largest value")
    common.positive(parser, "--within", "D",
                    "leave out points farther than D from the surface, in the unit of the coordinates "
                    "(default: none)")
    common.coordinates(parser, "VALUES")
    parser.add_argument("--missing-value", metavar="V", type=values.finite, action="append", default=[],
                        help="a number that stands for no value, as NaN does, such as -10000 (repeatable)")
    parser.add_argument("--error", metavar="FILE",
                        help="write the standard error of the map, which is large where nothing was "
                             "measured, in one of the formats of OUTPUT")
    parser.add_argument("--slope-error", metavar="FILE",
                        help="write the standard error of its slopes, which derivatives --error takes")
    common.merge(parser)


def interpolate(arguments, report):
    surface = read_surface_for_output(arguments, report, lengths=True)
    if arguments.exact:
        inputs.refuse(arguments, ["--slope-error"], "with --exact", "without it")
    for path in (arguments.error, arguments.slope_error):
        if path is not None:
            check_output_folder(path)
    with report.timed("read"):
        places, measured, names = inputs.read_values(arguments.values, surface)
    if places is None:
        inputs.refuse(arguments, ["--within"], f"with values at vertices, in {arguments.values}",
                      "a table of points")
    else:
        places = inputs.to_surface(arguments, surface, places, report)
    target = new_data(surface, arguments.output, names)
    errors = {path: new_data(surface, path, names) for path in (arguments.error, arguments.slope_error) if path}
    with report.working("Interpolation") as progress:
        result = fit(
            surface.solver, measured, places, exact=arguments.exact, noise_level=arguments.noise or 0.0,
            correlation_length=arguments.length or 0.0, boundary="Natural" if arguments.flat else "Automatic",
            keep_range=arguments.keep_range, maximum_distance=arguments.within or 0.0,
            missing_value=arguments.missing_value,
            compute_error=bool(errors), robust=arguments.robust, progress=progress,
            **given(smoothing=arguments.smoothing), **common.merging(arguments))
    is_tkr = places is not None and arguments.ras == "tkr" and surface.center.any()
    if is_tkr and result.median_distance > result.mean_edge_length:
        report.warn(f"{surface.path} has FreeSurfer's coordinates, and points in the scanner's are larger by its "
                    f"c_ras, ({', '.join(map(number_text, surface.center))}): give --ras scanner")
    rows = zip(result.smoothing, result.misfit, result.degrees_of_freedom, result.noise_level)
    report.facts.update(
        values=result.number_of_values, far_values=result.number_of_far_values,
        median_distance=result.median_distance, largest_distance=result.largest_distance,
        columns=[{"name": name, "smoothing": number(mu), "misfit": number(misfit),
                  "degrees_of_freedom": number(freedom), "noise": number(noise)}
                 for name, (mu, misfit, freedom, noise) in zip(names, rows)])
    if arguments.robust:
        outliers = result.outliers.reshape(len(result.outliers), -1)
        report.facts["outliers"] = np.flatnonzero(outliers.any(axis=1)).tolist()
    with report.timed("write"):
        target.save(arguments.output, [result.values.astype(np.float32)])
        for path, error in ((arguments.error, result.error), (arguments.slope_error, result.slope_error)):
            if path:
                errors[path].save(path, [error.astype(np.float32)])
    report.say_written(arguments.output, f"{result.number_of_values} values, misfit "
                       + ", ".join(f"{misfit:.4g}" for misfit in result.misfit))
