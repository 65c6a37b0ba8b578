# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""metric-dilate and cifti-dilate: places near others get their values, with Workbench's arguments."""
from __future__ import annotations

from .._dilation import Dilation, VoxelDilator, dilate
from ..files.content import read_content
from . import common, grayordinates, inputs, values
from .report import counted
from .stages import change_data, panels_of_missing

_TEXT = (", and with their meaning: {what} that are 0, or missing (NaN), get the mean of values near them, weighted "
         "by {size} / distance^{exponent}, or with -nearest the value of the nearest one; those farther than the "
         "distance, and no neighbours, become 0. `inpaint` fills by harmonic functions, and `interpolate` by "
         "splines.")


def add_metric_dilate(commands):
    parser = commands.add(
        "metric-dilate", metric_dilate,
        "Fill in values with the arguments of wb_command -metric-dilate" + _TEXT.format(
            what="vertices", size="area", exponent="6"),
        ["L.thickness.shape.gii L.midthickness.surf.gii 10 L.dilated.shape.gii -nearest"])
    parser.add_argument("data", metavar="METRIC", help="the values")
    common.mesh(parser)
    _distance(parser, "distance", "DISTANCE", "")
    common.output(parser)
    parser.add_argument("-bad-vertex-roi", dest="missing", metavar="FILE",
                        help="values to fill in, in place of zeros: where the first column is above 0")
    parser.add_argument("-data-roi", metavar="FILE",
                        help="the values that others are filled in from: where the first column is above 0")
    common.columns(parser)
    how = parser.add_mutually_exclusive_group()
    _nearest(how)
    how.add_argument("-exponent", metavar="N", type=values.positive, default=6.0, help="of the weights (default 6)")
    common.areas(parser, "-corrected-areas")
    common.any_hemisphere(parser)


def metric_dilate(arguments, report):
    arguments.fix_zeros = arguments.missing is None
    how = Dilation(arguments.distance, None if arguments.take_nearest else arguments.exponent, 2)

    sources = True
    if arguments.data_roi is not None:
        (_, sources), = inputs.read_marks(arguments.data_roi, inputs.read_surfaces(arguments))

    def compute(surface, values, mask, **_):
        return dilate(surface, values, how, mask, sources)

    change_data(arguments, report, "Dilation", compute, panels_of_missing, arguments.missing)


def add_cifti_dilate(commands):
    parser = commands.add(
        "cifti-dilate", cifti_dilate,
        "Fill in values of a CIFTI file with the arguments of wb_command -cifti-dilate" + _TEXT.format(
            what="vertices, and voxels within each structure,", size="area", exponent="6, of voxels by 1 / distance^7"),
        ["a.dscalar.nii COLUMN 10 8 b.dscalar.nii -left-surface L.surf.gii -right-surface R.surf.gii"], "")
    parser.add_argument("data", metavar="CIFTI", help="the values, .dscalar.nii or .dtseries.nii")
    common.direction(parser)
    _distance(parser, "distance", "SURFACE_DISTANCE", " on surfaces")
    _distance(parser, "volume_distance", "VOLUME_DISTANCE", " among voxels")
    common.output(parser)
    common.hemispheres(parser)
    common.side_areas(parser)
    parser.add_argument("-bad-brainordinate-roi", dest="missing", metavar="FILE",
                        help="values to fill in, in place of zeros: where the first column is above 0")
    _nearest(parser)
    parser.add_argument("-merged-volume", action="store_true",
                        help="fill in voxels across the boundaries of their structures, too")
    parser.set_defaults(column=[], surface_only=False)


def cifti_dilate(arguments, report):
    arguments.fix_zeros = arguments.missing is None
    content = grayordinates.require_cifti(read_content(arguments.data))
    on_surface = Dilation(arguments.distance, None if arguments.take_nearest else 6.0, 2)
    in_volume = Dilation(arguments.volume_distance, None if arguments.take_nearest else 7.0, 3)
    columns = grayordinates.change(
        arguments, report, content, "Dilation",
        lambda surface, values, mask: dilate(surface, values, on_surface, mask),
        lambda voxels, affine: VoxelDilator(voxels, affine, in_volume))
    report.say_written(arguments.output, counted(len(columns), "column"))


def _distance(parser, dest, metavar, where):
    parser.add_argument(dest, metavar=metavar, type=values.not_negative,
                        help=f"the distance up to which values reach{where}, in mm")


def _nearest(parser):
    parser.add_argument("-nearest", dest="take_nearest", action="store_true", help="take the nearest value")
