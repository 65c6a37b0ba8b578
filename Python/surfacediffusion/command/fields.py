# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Random maps: random-field, surrogates."""
from __future__ import annotations

from .. import random_field as draw_field
from .. import surrogates as draw_surrogates
from ..files import new_data
from ..files.content import check_output_folder
from . import common, inputs, values
from .report import number
from .stages import read, read_surface_for_output, require_known, write_new


def add_random_field(commands):
    parser = commands.add(
        "random-field", random_field,
        "Draw Gaussian random fields of mean 0 and variance 1: white noise smoothed to a width, or "
        "fields of Matern's class with a range.",
        ["lh.white fields.func.gii --fwhm 10 --count 100", "stone.ply rough.ply --range 5 --nu 1"],
        common.NEW)
    common.mesh(parser)
    common.output(parser, "the fields, one column each")
    width = parser.add_mutually_exclusive_group(required=True)
    common.positive(width, "--fwhm", "W",
                    "full width at half maximum of the kernel, in the unit of the coordinates")
    common.positive(width, "--range", "R",
                    "the distance at which Matern's correlation has fallen to 0.14, in the unit of the "
                    "coordinates")
    parser.add_argument("--nu", metavar="NU", type=values.positive, default=1,
                        help="the smoothness of Matern's correlation, up to 4 (default 1)")
    common.count_and_seed(parser, "fields", 1)


def random_field(arguments, report):
    if arguments.fwhm is not None and arguments.nu != 1:
        raise inputs.ArgumentProblem("--nu with --fwhm; allowed: --nu with --range")
    surface = read_surface_for_output(arguments, report, lengths=True)
    target = _target(arguments, surface, "field")
    with report.working("Fields") as progress:
        solver = inputs.make_solver(arguments, surface, None)
        found = draw_field(solver, arguments.count, fwhm=arguments.fwhm, range=arguments.range,
                           nu=arguments.nu, seed=arguments.seed, progress=progress)
    report.facts.update(fwhm=arguments.fwhm, range=arguments.range, seed=arguments.seed)
    write_new(arguments, report, target, found)


def add_surrogates(commands):
    parser = commands.add(
        "surrogates", surrogates,
        "Draw surrogates of a map: random maps with its values and its smoothness, and nothing else in "
        "common with it. The correlations of another map with them are the distribution without a "
        "relation. Missing values stay missing.",
        ["lh.white lh.thickness null.func.gii --cortex --count 1000"], f"""
{common.SURFACES}
DATA: GIFTI, FreeSurfer (curv, .mgh, ...), NumPy (.npy), text (.txt), or a PLY or VTK file with data.
{common.NEW}""")
    common.surface_and_data(parser)
    common.output(parser, "the surrogates, one column each; NaN outside")
    common.count_and_seed(parser, "surrogates", 1000)
    common.region_and_columns(parser)


def surrogates(arguments, report):
    check_output_folder(arguments.output)
    with report.timed("read"):
        _, data, columns, patches = read(arguments)
    if len(patches) != 1 or len(columns) != 1:
        found = f"{len(columns)} columns" if len(patches) == 1 else f"{len(patches)} surfaces"
        raise inputs.ArgumentProblem(f"{data.path} has {found}; allowed: one surface and one column, by "
                                     "--column")
    patch = patches[0]
    require_known(patch, [0], data, columns)
    target = _target(arguments, patch.surface, "surrogate")
    with report.working("Surrogates") as progress:
        solver = inputs.make_solver(arguments, patch.surface, None)
        found = draw_surrogates(solver, patch.values[:, 0].astype(float), arguments.count,
                                seed=arguments.seed, mask=patch.excluded_of(0), progress=progress)
    report.facts.update(
        output=arguments.output, seed=arguments.seed, model=[
            {"fwhm": number(width), "variance": number(share)}
            for width, share in zip(found.fwhm, found.variances)])
    write_new(arguments, report, target, found.values)


def _target(arguments, surface, what):
    """A column for each map."""
    return new_data(surface, arguments.output, [f"{what} {k + 1}" for k in range(arguments.count)])
