# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Smoothing by diffusion: smooth, and metric-smoothing and cifti-smoothing with Workbench's arguments."""
from __future__ import annotations

import argparse
import math

import numpy as np

from .. import heat, smooth_to_fwhm
from ..files import read_data
from ..files.content import read_content
from . import batch, common, grayordinates, inputs, values
from .report import counted
from .stages import all_columns, change_data, panels_of_missing

SIGMA_TO_FWHM = math.sqrt(8 * math.log(2))

#: What smooth has, and Workbench's commands have not
_ABSENT = {"surface_only": False, "volume_fwhm": None, "merged_volume": False, "jobs": 1,
           "to_fwhm": False, "residuals": None}


def add_smooth(commands):
    parser = commands.add(
        "smooth", smooth,
        "Smooth data by diffusion for a given width. The result is the convolution with a "
        "Gaussian on the surface whose full width at half maximum is FWHM; the integral of "
        "the data over the surface is kept. The order of the arguments is that of "
        "wb_command -metric-smoothing, whose kernel is a standard deviation unless -fwhm is "
        "given: see metric-smoothing, or --sigma.",
        ["lh.midthickness.surf.gii lh.thickness.shape.gii 10 lh.smooth.shape.gii",
         "bold.dtseries.nii 4 smooth.dtseries.nii --left L.surf.gii --right R.surf.gii",
         "lh.white sub-*.lh.thickness.mgh 10 smooth/ --cortex --jobs 4"])
    common.surface_and_data(parser, many=True)
    parser.add_argument("width", metavar="FWHM", type=values.positive,
                        help="the width in the unit of the surface's coordinates (mm)")
    common.output(parser, "the result, or the folder of the results, which have the names of DATA")
    parser.add_argument("--jobs", metavar="N", type=values.count, default=1,
                        help="the number of processes that share several files (default 1). Each has its "
                             "part of the threads")
    parser.add_argument("--to-fwhm", action="store_true",
                        help="smooth until the noise of DATA has the smoothness FWHM, so that data of "
                             "different smoothness become alike. The noise is that of --residuals, else "
                             "the columns minus their mean, else the one column")
    parser.add_argument("--residuals", metavar="FILE", help="the noise for --to-fwhm")
    common.region_and_columns(parser)
    common.faces(parser)
    common.merge(parser)
    _match_columns(parser)
    voxels = parser.add_mutually_exclusive_group()
    voxels.add_argument("--surface-only", action="store_true",
                        help="copy the voxels of a CIFTI file. Default: they are smoothed within "
                             "each structure by a Gaussian")
    voxels.add_argument("--volume-fwhm", metavar="W", type=values.not_negative,
                        help="the width among voxels (default: FWHM)")
    _merged_volume(parser, "--merged-volume", "-merged-volume")
    _areas_and_steps(parser)
    width = parser.add_mutually_exclusive_group()
    width.add_argument("--sigma", action="store_true",
                       help="FWHM is given as a standard deviation: FWHM = 2.3548 sigma")
    width.add_argument("-fwhm", dest="is_fwhm", action="store_true", help=argparse.SUPPRESS)


def add_metric_smoothing(commands):
    parser = commands.add(
        "metric-smoothing", smooth,
        "Smooth data with the arguments of wb_command -metric-smoothing, and with their meaning: "
        "KERNEL is the standard deviation (sigma) of a Gaussian, or its full width at half maximum "
        "with -fwhm, and zeros are values unless -fix-zeros is given. The result is that of `smooth`.",
        ["L.midthickness.surf.gii L.thickness.shape.gii 4 L.smooth.shape.gii -roi L.roi.shape.gii"])
    common.surface_and_data(parser)
    parser.add_argument("width", metavar="KERNEL", type=values.positive,
                        help="the standard deviation in the unit of the surface's coordinates (mm)")
    common.output(parser)
    _kernels_are_fwhm(parser, "KERNEL is the full width at half maximum: sigma = FWHM / 2.3548")
    common.region_and_columns(parser)
    parser.set_defaults(**_ABSENT)
    _match_columns(parser)
    _areas_and_steps(parser)
    parser.add_argument("-method", choices=("GEO_GAUSS_AREA",), default="GEO_GAUSS_AREA",
                        help="the kernel of Workbench that this one is like, its default; the others "
                             "weigh vertices without their areas")


def add_cifti_smoothing(commands):
    parser = commands.add(
        "cifti-smoothing", smooth_cifti,
        "Smooth a CIFTI file with the arguments of wb_command -cifti-smoothing, and with their "
        "meaning: the kernels are standard deviations (sigma) of Gaussians, or full widths at half "
        "maximum with -fwhm; 0 copies the values. The result is that of `smooth`.",
        ["bold.dtseries.nii 4 4 COLUMN smooth.dtseries.nii -fwhm -left-surface L.surf.gii "
         "-right-surface R.surf.gii"], "")
    parser.add_argument("data", metavar="CIFTI", help="the values, .dscalar.nii or .dtseries.nii")
    parser.add_argument("width", metavar="SURFACE_KERNEL", type=values.not_negative,
                        help="the width on surfaces in mm")
    parser.add_argument("volume_kernel", metavar="VOLUME_KERNEL", type=values.not_negative,
                        help="the width among voxels in mm")
    common.direction(parser)
    common.output(parser)
    common.hemispheres(parser)
    _kernels_are_fwhm(parser, "the kernels are full widths at half maximum")
    parser.add_argument("-cifti-roi", dest="roi", metavar="FILE",
                        help="a CIFTI file whose first column is above 0 in the region")
    common.areas(parser, "-corrected-areas")
    common.side_areas(parser)
    for place, word in (("volume", "among voxels"), ("surface", "on surfaces")):
        parser.add_argument(f"-fix-zeros-{place}", action="store_true",
                            help=f"zeros {word} mean missing, as NaN does")
    parser.set_defaults(**_ABSENT, fix_zeros=False, column=[], steps=1, mass_matrix="mixed")
    _merged_volume(parser, "-merged-volume")


def _match_columns(parser):
    parser.add_argument("--match-columns", "-match-columns", action="store_true",
                        help="each column of DATA has the column of the same number in the file of --roi "
                             "as its region")


def _merged_volume(parser, *options):
    parser.add_argument(*options, action="store_true",
                        help="smooth voxels across the boundaries of their structures, too")


def _areas_and_steps(parser):
    common.areas(parser, "--areas", "-corrected-areas")
    parser.add_argument("--mass-matrix", choices=("mixed", "lumped"),
                        help="mixed: white noise gets the width to 5 %% from 2 mean edge lengths on "
                             "(default); lumped: widths below 5 of them fall short, at 2 by a fifth")
    common.steps(parser, "number of time steps (default 1, whose error in time is 0.5 %% for white "
                         "noise of any width, 1 %% for data at faces; values may leave their range by 5e-4 "
                         "of it, by up to 0.6 %% of single peaks at widths of 1.5 edges, and by more at obtuse "
                         "angles of boundaries)")


def _kernels_are_fwhm(parser, text):
    parser.add_argument("-fwhm", dest="sigma", action="store_false", help=text)


def smooth(arguments, report):
    batch.run(arguments, report, _smooth_file)


def _smooth_file(arguments, report):
    content = read_content(arguments.data)
    _check_options(arguments, content)
    arguments.steps = arguments.steps or 1
    arguments.mass_matrix = arguments.mass_matrix or "mixed"
    width = _width(arguments, report)
    if content.kind == "cifti" and not arguments.to_fwhm:
        _smooth_grayordinates(arguments, report, content, width)
        return

    def compute(surface, values, **run):
        return heat(surface, values, on_faces=arguments.faces, fwhm=width, time_integrator="Exponential",
                    mass_matrix=arguments.mass_matrix.capitalize(), number_of_time_steps=arguments.steps, **run)

    def reach(surface, values, mask, **_):
        noise = _read_noise(arguments, values, mask)
        return smooth_to_fwhm(surface, values, width, residuals=noise, mask=mask)

    if arguments.to_fwhm:
        change_data(arguments, report, "Smoothing", reach, all_columns, content=content,
                    say=lambda surface: "smoothed to " + _width_text(width, surface))
        return
    change_data(arguments, report, "Smoothing", compute, panels_of_missing, content=content,
                say=lambda surface: _width_text(width, surface))


def _check_options(arguments, content):
    """Options that would have no effect are mistakes."""
    voxels = ("--surface-only", "--volume-fwhm", "--merged-volume")
    if arguments.to_fwhm:
        inputs.refuse(arguments, ["--faces"], "with --to-fwhm", "data at vertices")
        inputs.refuse(arguments, ["--merge", "--merge-tolerance", "--steps", "--mass-matrix", *voxels],
                      "with --to-fwhm", "one of them")
    else:
        inputs.refuse(arguments, ["--residuals"], "without --to-fwhm", "both")
    if content.kind == "cifti":
        inputs.refuse(arguments, ["--faces"], f"with the CIFTI file {content.path}", "data at vertices")
    else:
        inputs.refuse(arguments, voxels, f"with {content.path}, which has no voxels", "CIFTI files")
    if arguments.surface_only:
        inputs.refuse(arguments, ["--merged-volume"], "with --surface-only", "one of them")
    if arguments.roi is None:
        inputs.refuse(arguments, ["--match-columns"], "without --roi", "both")


def smooth_cifti(arguments, report):
    arguments.volume_fwhm = _to_fwhm(arguments, arguments.volume_kernel)
    if not arguments.width and not arguments.volume_kernel:
        raise inputs.ArgumentProblem("SURFACE_KERNEL and VOLUME_KERNEL are 0; allowed: one above 0")
    content = grayordinates.require_cifti(read_content(arguments.data))
    _smooth_grayordinates(arguments, report, content, _width(arguments, report))


def _to_fwhm(arguments, kernel):
    return kernel * (SIGMA_TO_FWHM if arguments.sigma else 1)


def _width(arguments, report):
    width = _to_fwhm(arguments, arguments.width)
    report.facts.update(fwhm=width, sigma=width / SIGMA_TO_FWHM, steps=arguments.steps)
    return width


def _read_noise(arguments, values, mask):
    """The columns of --residuals on the surface of `values`; None without."""
    if arguments.residuals is None:
        return None
    surfaces = inputs.read_surfaces(arguments)
    noise = read_data(arguments.residuals)
    if len(noise.parts) > 1 or len(surfaces) > 1:
        raise inputs.ArgumentProblem("--residuals with several surfaces; allowed: one SURFACE")
    (surface,) = surfaces.values()
    found, absent = inputs.on_surface(noise.parts[0], noise.parts[0].values, surface, noise)
    found = np.where(absent[:, None], np.nan, found)
    return found if mask is None else np.where(mask[:, None], np.nan, found)


def _smooth_grayordinates(arguments, report, content, width):
    """Surfaces and voxels; the width of these may be another one."""
    voxel_width = width if arguments.volume_fwhm is None else arguments.volume_fwhm
    columns = grayordinates.smooth(arguments, report, content, width, voxel_width)
    what = f"{counted(len(columns), 'column')}, {_width_text(width)}"
    voxels = report.facts["voxels"]
    if voxels:
        what += f", {voxels} voxels" + (f" FWHM {voxel_width:.3g} mm" if voxel_width != width else "")
    report.say_written(arguments.output, what)


def _width_text(fwhm, surface=None):
    """The formats of brains are in millimetres, other meshes in any unit."""
    unit = " mm" if surface is None or surface.kind in ("gifti", "freesurfer") else ""
    return f"FWHM {fwhm:.3g}{unit} (sigma {fwhm / SIGMA_TO_FWHM:.3g})"
