# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The arguments of each command."""
from __future__ import annotations

import argparse
import math
import os
import re
import textwrap

from ..files.export import UNITS
from . import tasks
from .doctor import doctor, version
from .printing import PATTERNS

__all__ = ["parse"]

PROGRAM = "surfacediffusion"

SURFACES = "SURFACE: GIFTI (.surf.gii), FreeSurfer (lh.white, ...), OFF, OBJ, PLY, STL, or VTK polydata."

FILES = f"""
{SURFACES}
DATA: GIFTI (.func.gii, .shape.gii), CIFTI (.dscalar.nii, .dtseries.nii; give --left, --right and
--cerebellum instead of SURFACE), FreeSurfer (curv, .mgh, .mgz, .nii.gz, .label), NumPy (.npy), or a PLY or VTK
file with data at its vertices; with --faces, where there is that option, at the faces. Files are
recognised by their content, and may be compressed by gzip, or pipes. OUTPUT has the format and the
metadata of DATA; that of a FreeSurfer curv may be named .mgh or .shape.gii, too. NaN means missing: the value is not used, and the output has a value there.
"""


def parse(argv):
    """The arguments of the command line, with the function that carries them out as `run`."""
    if argv and argv[0] in ("-metric-smoothing", "-cifti-smoothing"):  # as after wb_command
        argv = [argv[0][1:], *argv[1:]]
    # A CIFTI file has a surface per hemisphere, by --left and --right instead of SURFACE.
    hemispheres = any(word.split("=")[0] in _SIDES for word in argv) or (
        len(argv) > 1 and re.search(r"\.d[a-z]+\.nii$", argv[1]) is not None)
    parser = make_parser(hemispheres)
    complete(parser)
    arguments = parser.parse_args(argv)
    if getattr(arguments, "cortex", False):
        arguments.roi = _cortex_label(parser, arguments)
    return arguments


def complete(parser):
    """Answer a shell that asks for completions, if argcomplete is installed, and end."""
    if "_ARGCOMPLETE" in os.environ:
        try:
            import argcomplete
        except ImportError:
            return
        argcomplete.autocomplete(parser)


def _cortex_label(parser, arguments):
    """The label of the cortex that FreeSurfer wrote for the subject of a surface."""
    surface = arguments.surface or "with --left and --right"
    folder, name = os.path.split(os.path.abspath(surface))
    label = f"{name.split('.')[0]}.cortex.label"
    paths = [os.path.join(folder, "..", "label", label), os.path.join(folder, label)]
    for path in paths:
        if arguments.surface and os.path.isfile(path):
            return os.path.normpath(path)
    parser.error(f"--cortex: no {label} in ../label of the folder of {surface}; allowed: a surface in the "
                 "folder surf of a subject of FreeSurfer, or --roi")


class _Parser(argparse.ArgumentParser):
    """Errors are one line; the usage is in --help."""

    def error(self, message):
        self.exit(2, f"{self.prog}: {message}; see {self.prog} --help\n")


_SIDES = ("--left", "--right", "--cerebellum", "-left-surface", "-right-surface", "-cerebellum-surface")


def make_parser(hemispheres=False):
    parser = _Parser(
        prog=PROGRAM, allow_abbrev=False,
        description="Diffusion equations on surfaces, for files.",
        epilog=f"{PROGRAM} COMMAND --help shows the arguments of a command and an example.")
    parser.add_argument("--version", action="version", version=f"{PROGRAM} {version()}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True,
                                     parser_class=_Parser)
    for add in (_smooth, _metric_smoothing, _cifti_smoothing, _denoise, _denoise_mesh, _inpaint, _interpolate, _enhance,
                _edges, _segment, _refine, _texture, _directions, _curvature, _derivatives, _distance, _normals, _fwhm,
                _scale_filter, _spectrum, _random_field, _surrogates, _info, _doctor):
        add(_Commands(commands, hemispheres))
    return parser


class _Commands:
    """Adds commands with their common arguments."""

    def __init__(self, commands, hemispheres):
        self.commands = commands
        self.hemispheres = hemispheres

    def add(self, name, run, text, example, epilog=FILES):
        lines = "\n".join(f"  {line}" for line in example)
        parser = self.commands.add_parser(
            name, help=re.split(r"[.:] ", text)[0].rstrip("."), allow_abbrev=False,
            description=textwrap.fill(text, 98),
            formatter_class=argparse.RawDescriptionHelpFormatter,
            epilog=f"Example:\n{lines}\n{epilog}")
        parser.set_defaults(run=run)
        parser.add_argument("--json", action="store_true",
                            help="print a report as JSON: times, widths, totals, warnings")
        parser.add_argument("--quiet", action="store_true",
                            help="print nothing but errors: no progress bar, no summary")
        parser.add_argument("--threads", metavar="N", type=_threads,
                            help="the number of threads, 0: all processors (default: that of the "
                                 "variable SURFACEDIFFUSION_NUM_THREADS, else of OMP_NUM_THREADS, else "
                                 "0); the result does not depend on it")
        return parser

    def surface(self, parser, required=True):
        if self.hemispheres:
            parser.set_defaults(surface=None)
            parser.add_argument("--left", "-left-surface", metavar="FILE",
                                help="the surface of the left hemisphere, for CIFTI files")
            parser.add_argument("--right", "-right-surface", metavar="FILE",
                                help="the surface of the right hemisphere")
            parser.add_argument("--cerebellum", "-cerebellum-surface", metavar="FILE",
                                help="the surface of the cerebellum, for files with its vertices")
        else:
            parser.set_defaults(left=None, right=None, cerebellum=None)
            self.mesh(parser)

    @staticmethod
    def mesh(parser):
        parser.add_argument("surface", metavar="SURFACE", help="the surface")

    def data(self, parser, many=False):
        self.surface(parser)
        parser.add_argument("data", metavar="DATA", nargs="+" if many else None,
                            help="the values at its vertices" + "; several files, if OUTPUT is a folder"
                            * many)
        return parser

    @staticmethod
    def output(parser, words="the result"):
        parser.add_argument("output", metavar="OUTPUT", help=words)

    @staticmethod
    def merge(parser):
        parser.add_argument("--merge", action="store_true",
                            help="vertices at the same place are one vertex of the surface, as files "
                                 "with split normals or texture seams need")

    @staticmethod
    def faces(parser):
        parser.add_argument("--faces", action="store_true",
                            help="DATA, and all other files of data, have values at the faces: "
                                 "GIFTI, .mgh, .npy with one row per face, or VTK polydata with cell "
                                 "arrays. So has OUTPUT")

    @staticmethod
    def choices(parser):
        region = parser.add_mutually_exclusive_group()
        region.add_argument("--cortex", action="store_true",
                            help="work inside the cortex that FreeSurfer labelled: lh.cortex.label in "
                                 "the folder label beside that of SURFACE")
        region.add_argument("--roi", "-roi", metavar="FILE",
                            help="work inside this region alone, where its first column is above "
                                 "0: nothing flows across its boundary; outside, OUTPUT is 0. "
                                 "FILE may be a FreeSurfer .label, or FILE:LABEL for one label of an "
                                 "atlas, by its name or number: lh.aparc.annot:precentral (also of "
                                 ".label.gii and .dlabel.nii)")
        parser.add_argument("--fix-zeros", "-fix-zeros", action="store_true",
                            help="zeros mean missing, as NaN does")
        parser.add_argument("--column", "-column", action="append", metavar="N|NAME", default=[],
                            help="a column of DATA by number (from 1) or name; can be repeated. "
                                 "Default: all")


def _number(text, holds, allowed):
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or not holds(value):
        raise argparse.ArgumentTypeError(f"is {text!r}; allowed: {allowed}")
    return value


def _numbers(allowed, holds=lambda value: True):
    """The type of an argument that is a number."""
    return lambda text: _number(text, holds, allowed)


def _whole_numbers(allowed, least, most=2**31 - 1):
    """The type of an argument that is a whole number."""
    return lambda text: int(_number(
        text, lambda value: value == int(value) and least <= value <= most, allowed))


_finite = _numbers("a finite number")
_positive = _numbers("a number above 0", lambda value: value > 0)
_not_negative = _numbers("a number of at least 0", lambda value: value >= 0)
_exponent = _numbers("a number from 1 to 2", lambda value: 1 <= value <= 2)
_degrees = _numbers("degrees from 0 to 90", lambda value: 0 <= value <= 90)
_whole = _whole_numbers("a whole number", 1 - 2**31)
_count = _whole_numbers("a whole number of at least 1", 1)
_threads = _whole_numbers("a whole number from 0 to 1024", 0, 1024)
_regions = _whole_numbers("a whole number from 2 to 1000", 2, 1000)


def _positive_length(text):
    return _length(text, lambda value: value > 0, "a length above 0")


def _length_or_zero(text):
    return _length(text, lambda value: value >= 0, "a length of at least 0")


def _length(text, holds=lambda value: True, allowed="a length"):
    """A number and its unit, or None."""
    units = ", ".join(UNITS)
    found = re.fullmatch(r"\s*([-+0-9.eE]+?)\s*([^\W\d_]*)\s*", text)
    unit = found[2].lower().replace("\u03bc", "u").replace("\u00b5", "u") if found else ""
    allowed = f"{allowed}, with or without a unit ({units}), such as 4mm"
    if not found or unit and unit not in UNITS:
        raise argparse.ArgumentTypeError(f"is {text!r}; allowed: {allowed}")
    try:
        return _number(found[1], holds, allowed), unit or None
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(f"is {text!r}; allowed: {allowed}") from None


def _smooth(commands):
    text = ("Smooth data by diffusion for a given width. The result is the convolution with a "
            "Gaussian on the surface whose full width at half maximum is FWHM; the integral of "
            "the data over the surface is kept. The order of the arguments is that of "
            "wb_command -metric-smoothing, whose kernel is a standard deviation unless -fwhm is "
            "given: see metric-smoothing, or --sigma.")
    parser = commands.add(
        "smooth", tasks.smooth, text,
        [f"{PROGRAM} smooth lh.midthickness.surf.gii lh.thickness.shape.gii 10 lh.smooth.shape.gii",
         f"{PROGRAM} smooth bold.dtseries.nii 4 smooth.dtseries.nii --left L.surf.gii "
         "--right R.surf.gii",
         f"{PROGRAM} smooth lh.white sub-*.lh.thickness.mgh 10 smooth/ --cortex --jobs 4"])
    commands.data(parser, many=True)
    parser.add_argument("width", metavar="FWHM", type=_positive,
                        help="the width in the unit of the surface's coordinates (mm)")
    parser.add_argument("output", metavar="OUTPUT",
                        help="the result, or the folder of the results, which have the names of DATA")
    parser.add_argument("--jobs", metavar="N", type=_count, default=1,
                        help="the number of processes that share several files (default 1). Each has its "
                             "part of the threads")
    parser.add_argument("--to-fwhm", action="store_true",
                        help="smooth until the noise of DATA has the smoothness FWHM, so that data of "
                             "different smoothness become alike. The noise is that of --residuals, else "
                             "the columns minus their mean, else the one column")
    parser.add_argument("--residuals", metavar="FILE", help="the noise for --to-fwhm")
    commands.choices(parser)
    commands.faces(parser)
    _match_columns(parser)
    voxels = parser.add_mutually_exclusive_group()
    voxels.add_argument("--surface-only", action="store_true",
                        help="copy the voxels of a CIFTI file. Default: they are smoothed within "
                             "each structure by a Gaussian")
    voxels.add_argument("--volume-fwhm", metavar="W", type=_not_negative,
                        help="the width among voxels (default: FWHM)")
    parser.add_argument("--merged-volume", "-merged-volume", action="store_true",
                        help="smooth voxels across the boundaries of their structures, too")
    _areas_and_steps(parser)
    width = parser.add_mutually_exclusive_group()
    width.add_argument("--sigma", action="store_true",
                       help="FWHM is given as a standard deviation: FWHM = 2.3548 sigma")
    width.add_argument("-fwhm", dest="is_fwhm", action="store_true", help=argparse.SUPPRESS)


def _match_columns(parser):
    parser.add_argument("--match-columns", "-match-columns", action="store_true",
                        help="each column of DATA has the column of the same number in the file of --roi "
                             "as its region")


def _areas_and_steps(parser):
    parser.add_argument("--areas", "-corrected-areas", metavar="FILE",
                        help="the areas of the vertices in the first column, in place of those of "
                             "SURFACE: for a surface that is the average of many")
    parser.add_argument("--steps", metavar="N", type=_count, default=3,
                        help="number of time steps (default 3, which is within about 0.1 %% of "
                             "the solution at 10 mm on a cortex)")


def _metric_smoothing(commands):
    text = ("Smooth data with the arguments of wb_command -metric-smoothing, and with their meaning: "
            "KERNEL is the standard deviation (sigma) of a Gaussian, or its full width at half maximum "
            "with -fwhm, and zeros are values unless -fix-zeros is given. The result is that of `smooth`.")
    parser = commands.add(
        "metric-smoothing", tasks.smooth, text,
        [f"{PROGRAM} metric-smoothing L.midthickness.surf.gii L.thickness.shape.gii 4 "
         "L.smooth.shape.gii -roi L.roi.shape.gii"])
    commands.data(parser)
    parser.add_argument("width", metavar="KERNEL", type=_positive,
                        help="the standard deviation in the unit of the surface's coordinates (mm)")
    commands.output(parser)
    parser.add_argument("-fwhm", dest="sigma", action="store_false",
                        help="KERNEL is the full width at half maximum: sigma = FWHM / 2.3548")
    commands.choices(parser)
    parser.set_defaults(faces=False, surface_only=False, volume_fwhm=None, merged_volume=False, jobs=1,
                        to_fwhm=False, residuals=None)
    _match_columns(parser)
    _areas_and_steps(parser)
    parser.add_argument("-method", choices=("GEO_GAUSS_AREA",), default="GEO_GAUSS_AREA",
                        help="the kernel of Workbench that this one is like, its default; the others "
                             "weigh vertices without their areas")


def _cifti_smoothing(commands):
    text = ("Smooth a CIFTI file with the arguments of wb_command -cifti-smoothing, and with their "
            "meaning: the kernels are standard deviations (sigma) of Gaussians, or full widths at half "
            "maximum with -fwhm; 0 copies the values. The result is that of `smooth`.")
    parser = commands.add(
        "cifti-smoothing", tasks.cifti_smoothing, text,
        [f"{PROGRAM} cifti-smoothing bold.dtseries.nii 4 4 COLUMN smooth.dtseries.nii -fwhm "
         "-left-surface L.surf.gii -right-surface R.surf.gii"], "")
    parser.add_argument("data", metavar="CIFTI", help="the values, .dscalar.nii or .dtseries.nii")
    parser.add_argument("width", metavar="SURFACE_KERNEL", type=_not_negative,
                        help="the width on surfaces in mm")
    parser.add_argument("volume_kernel", metavar="VOLUME_KERNEL", type=_not_negative,
                        help="the width among voxels in mm")
    parser.add_argument("direction", choices=("COLUMN",),
                        help="the direction of the vertices and voxels in the matrix")
    commands.output(parser)
    _Commands(commands.commands, True).surface(parser)
    parser.add_argument("-fwhm", dest="sigma", action="store_false",
                        help="the kernels are full widths at half maximum")
    parser.add_argument("-cifti-roi", dest="roi", metavar="FILE",
                        help="a CIFTI file whose first column is above 0 in the region")
    for place, word in (("volume", "among voxels"), ("surface", "on surfaces")):
        parser.add_argument(f"-fix-zeros-{place}", action="store_true",
                            help=f"zeros {word} mean missing, as NaN does")
    parser.add_argument("-merged-volume", action="store_true",
                        help="smooth voxels across the boundaries of their structures, too")
    parser.set_defaults(faces=False, fix_zeros=False, column=[], areas=None, steps=3, to_fwhm=False,
                        match_columns=False, surface_only=False)


def _denoise(commands):
    text = ("Remove noise and keep edges, by minimising total variation. Without --weight, the "
            "weight is chosen so that the noise removed has the estimated (or given) level.")
    parser = commands.add(
        "denoise", tasks.denoise, text,
        [f"{PROGRAM} denoise scan.ply scan.ply clean.ply",
         f"{PROGRAM} denoise lh.white lh.curv lh.curv.clean --weight 3"])
    commands.data(parser)
    commands.output(parser)
    commands.choices(parser)
    commands.faces(parser)
    level = parser.add_mutually_exclusive_group()
    level.add_argument("--weight", metavar="W", type=_positive,
                       help="the fidelity weight, in natural units; smaller removes more")
    level.add_argument("--noise", metavar="SD", type=_positive,
                       help="the standard deviation of the noise, in the unit of the data")
    parser.add_argument("--colors", choices=("rgb", "opponent", "chromaticity"), default="rgb",
                        help="for colours. rgb: red, green and blue have their edges in common "
                             "(default); opponent: noise of hues is removed more than that of "
                             "brightness; chromaticity: brightness and hue are separate")


MESH = f"""
{SURFACES}
OUTPUT has the format of SURFACE, its faces and its data. Normals in the file are computed again, or
left out where they belong to corners of faces.
"""


def _denoise_mesh(commands):
    text = ("Remove the noise of the points of a surface, and keep its sharp edges, boundaries and "
            "volume. The level of the noise is measured, and all weights follow from it.")
    parser = commands.add(
        "denoise-mesh", tasks.denoise_mesh, text,
        [f"{PROGRAM} denoise-mesh scan.ply clean.ply",
         f"{PROGRAM} denoise-mesh part.stl clean.stl --type cad --noise 0.02"], MESH)
    commands.mesh(parser)
    commands.output(parser, "the surface with moved points")
    parser.add_argument("--noise", metavar="SD", type=_positive,
                        help="the standard deviation of the noise along the normal, in the unit of "
                             "the coordinates; larger removes more (default: measured)")
    parser.add_argument("--type", choices=("automatic", "cad", "organic"), default="automatic",
                        help="cad: smooth faces with sharp edges; organic: smooth shapes with "
                             "details, such as scans; automatic: found by the angles at edges "
                             "(default)")
    commands.merge(parser)
    parser.add_argument("--fixed", metavar="FILE",
                        help="data in which vertices stay where the first column is above 0")


def _inpaint(commands):
    text = ("Fill in missing values and keep all others exactly. Missing are NaN, zeros with "
            "--fix-zeros, and vertices where the first column of --missing is above 0.")
    parser = commands.add(
        "inpaint", tasks.inpaint, text,
        [f"{PROGRAM} inpaint lh.pial lh.thickness lh.thickness.full --fix-zeros"])
    commands.data(parser)
    commands.output(parser)
    commands.choices(parser)
    commands.faces(parser)
    parser.add_argument("--missing", metavar="FILE", help="missing where the first column is above 0")
    parser.add_argument("--model", choices=("heat", "tv"), default="heat",
                        help="heat: harmonic functions, smooth (default); tv: total variation, "
                             "which continues edges")


NEW = """
The name of OUTPUT gives its format: .func.gii, .shape.gii, .mgh, .mgz, .npy, or .ply, .vtk,
.vtp if SURFACE is such a file.
"""


POINTS = f"""
{SURFACES}
VALUES: a text file with a row x, y, z, value, ... for each point, separated by commas or spaces and
with or without a line of names, whose points count at the nearest points of SURFACE; or data with a
value for each vertex, in the formats of the other commands. NaN, and an empty value in a text file, is
unknown.
""" + NEW[1:]


def _interpolate(commands):
    text = ("Compute a smooth map from values at a few points, on the surface or beside it. The values "
            "are smoothed by an amount that generalised cross-validation finds, unless --exact or "
            "--noise is given. Parts of the surface that are connected to no value are NaN.")
    parser = commands.add(
        "interpolate", tasks.interpolate, text,
        [f"{PROGRAM} interpolate atrium.vtp electrodes.csv times.vtp --error errors.npy",
         f"{PROGRAM} interpolate lh.pial.surf.gii implants.txt map.shape.gii --exact"], POINTS)
    commands.mesh(parser)
    parser.add_argument("values", metavar="VALUES", help="the values, with their points or at vertices")
    commands.output(parser, "the map, values at the vertices")
    level = parser.add_mutually_exclusive_group()
    level.add_argument("--exact", action="store_true", help="keep the values exactly")
    level.add_argument("--noise", metavar="SD", type=_positive,
                       help="the standard deviation of the values' noise, in their unit (default: "
                            "estimated)")
    level.add_argument("--smoothing", metavar="MU", type=_positive,
                       help="the strength of the smoothing, in squared mean edge lengths (default: "
                            "found)")
    parser.add_argument("--length", metavar="L", type=_positive,
                        help="the distance beyond which the map returns to the mean of the values, in "
                             "the unit of the coordinates (default: it continues smoothly)")
    parser.add_argument("--free", action="store_true",
                        help="continue slopes at the boundary of the surface, in place of becoming flat")
    parser.add_argument("--keep-range", action="store_true",
                        help="stay between the smallest and the largest value")
    parser.add_argument("--within", metavar="D", type=_positive,
                        help="leave out points farther than D from the surface, in the unit of the "
                             "coordinates (default: none)")
    parser.add_argument("--error", metavar="FILE",
                        help="write the standard error of the map, which is large where nothing was "
                             "measured, in one of the formats of OUTPUT")


def _enhance(commands):
    text = ("Smooth data along their own lines or edges: stripes, ridges and fingerprints become more "
            "distinct, and interrupted ones are closed. NaN is filled in. The channels of a colour have "
            "their lines in common, all other columns have their own.")
    parser = commands.add(
        "enhance", tasks.enhance, text,
        [f"{PROGRAM} enhance scan.ply scan.ply closed.ply --time 20",
         f"{PROGRAM} enhance scan.ply scan.ply clean.ply --model beltrami"])
    commands.data(parser)
    commands.output(parser)
    commands.choices(parser)
    parser.add_argument("--model", choices=("lines", "edges", "beltrami"), default="lines",
                        help="lines: coherence-enhancing diffusion along lines (default); edges: "
                             "edge-enhancing diffusion, smooth away from edges; beltrami: the area of "
                             "the data as a surface is reduced, which keeps the edges of colours")
    parser.add_argument("--time", metavar="T", type=_positive, default=10.0,
                        help="the time of diffusion, in squared mean edge lengths (default 10)")
    parser.add_argument("--steps", metavar="N", type=_count, default=10,
                        help="number of time steps (default 10)")
    parser.add_argument("--contrast", metavar="K", type=_positive,
                        help="the gradient of lines and edges, in ranges of the data per mean edge "
                             "length (default 0.05; for beltrami 0.1)")
    parser.add_argument("--scale", metavar="S", type=_not_negative,
                        help="the distance over which the direction of lines is averaged, in mean edge "
                             "lengths (default 4)")


def _edges(commands):
    text = ("Find the edges of data, and smooth the data between them, by the functional of Mumford "
            "and Shah. NaN is filled in, with edges that continue. The channels of a colour have "
            "their edges in common, all other columns have their own.")
    parser = commands.add(
        "edges", tasks.edges, text,
        [f"{PROGRAM} edges scan.ply scan.ply smooth.ply --map edges.npy --curves curves.npy"])
    commands.data(parser)
    commands.output(parser, "the data, smooth between edges")
    commands.choices(parser)
    parser.add_argument("--map", metavar="FILE",
                        help="write 1 - v, which is 1 on edges, at the vertices: .func.gii, "
                             ".shape.gii, .mgh, .mgz, .npy, or .ply, .vtk, .vtp if SURFACE is such "
                             "a file")
    parser.add_argument("--curves", metavar="FILE",
                        help="write the points of curves along the edges, a .npy array with rows of "
                             "the number of the curve and x, y, z")
    parser.add_argument("--threshold", metavar="J", type=_positive,
                        help="the jump from which on an edge is kept, in the range of the data; at "
                             "least three times the noise (default: found from the data, together "
                             "with --length; with --length: 0.2)")
    parser.add_argument("--length", metavar="L", type=_positive,
                        help="the length over which data are smoothed, in mean edge lengths (default: "
                             "found from the data; with --threshold: 8)")
    parser.add_argument("--noise", metavar="SD", type=_positive,
                        help="the standard deviation of the noise, if --threshold and --length are "
                             "found (default: estimated)")
    parser.add_argument("--width", metavar="E", type=_positive,
                        help="the width of an edge, in mean edge lengths (default 2)")


def _segment(commands):
    text = ("Divide a surface into regions with short boundaries, by the convex models of Chan and "
            "Vese and of Potts. The result is the label of the region of each vertex, 1, 2, ... in "
            "the order of the means, or in that of --means.")
    parser = commands.add(
        "segment", tasks.segment, text,
        [f"{PROGRAM} segment lh.midthickness.surf.gii lh.myelin.func.gii lh.regions.func.gii "
         "--regions 3"])
    commands.data(parser)
    commands.output(parser, "the labels")
    commands.choices(parser)
    parser.add_argument("--regions", metavar="K", type=_regions, default=2,
                        help="the number of regions (default 2)")
    parser.add_argument("--weight", metavar="W", type=_positive,
                        help="the weight of the data, in natural units; smaller gives shorter "
                             "boundaries and fewer small regions (default: found from the data)")
    parser.add_argument("--means", metavar="C", type=_finite, nargs="+",
                        help="the mean of each region, for data of one component, in place of "
                             "--regions. Default: they are found")
    parser.add_argument("--seed", metavar="N", type=_whole, default=0,
                        help="of the search for means (default 0)")


DISTANCE = """
SOURCES: GIFTI, FreeSurfer (.label, curv, .mgh, ...), NumPy (.npy), or a PLY or VTK file with data. NaN is
no source.
The name of OUTPUT gives its format: .func.gii, .shape.gii, .mgh, .mgz, .npy, or .ply, .vtk,
.vtp if SURFACE is such a file.
"""


TEXTURE = """
Lengths may have a unit: 4mm, 0.2cm, 0.1in, 300um. Files of surfaces name no unit: --unit is that of
SURFACE.

The name of OUTPUT gives its format. .stl and .3mf are parts for printing and need --relief; .obj and
.ply have the pattern as grey values, too. For these, vertices at the same place become one, and edges
are bisected to 8 per FEATURE_SIZE, so that CAD files with few triangles do. .func.gii, .shape.gii,
.mgh, .mgz, .npy, or .ply, .vtk, .vtp if SURFACE is such a file, are the pattern at the vertices of
SURFACE as they are.
"""


REFINE = """
The name of OUTPUT gives its format: .ply, .obj, .stl or .3mf. NEW is .npy: a row per vertex of OUTPUT,
those of SURFACE first.
"""


def _refine(commands):
    text = ("Bisect the long edges of a surface, so that data and patterns have room on large triangles: "
            "flat faces stay flat, sharp edges sharp, and data at the vertices go along.")
    parser = commands.add(
        "refine", tasks.refine, text,
        [f"{PROGRAM} refine part.ply 0.5 fine.ply --data load.npy fine.npy"], REFINE)
    parser.add_argument("surface", metavar="SURFACE", help="the surface")
    parser.add_argument("length", metavar="LENGTH", type=_positive,
                        help="the length of the longest edge allowed, in the unit of the coordinates")
    parser.add_argument("output", metavar="OUTPUT", help="the surface with shorter edges")
    parser.add_argument("--data", metavar="FILE", nargs=2, action="append", default=[],
                        help="two files: DATA at the vertices of SURFACE, and NEW for those at the "
                             "vertices of OUTPUT; may be repeated")
    parser.add_argument("--maximum-triangles", metavar="N", type=_count, default=4_000_000,
                        help="refinement stops before there are more, with a warning (default 4000000)")


def _texture(commands):
    text = ("Grow spots or labyrinths on a surface by reaction and diffusion, as values, or as relief "
            "for printing: without seams, across the edges of a part.")
    parser = commands.add(
        "texture", tasks.texture, text,
        [f"{PROGRAM} texture part.stl 4mm out.stl --relief 0.4mm --pattern labyrinth",
         f"{PROGRAM} texture lh.pial.surf.gii 8 lh.spots.shape.gii --seed 1"], TEXTURE)
    commands.mesh(parser)
    parser.add_argument("size", metavar="FEATURE_SIZE", type=_positive_length,
                        help="the wavelength of the pattern")
    commands.output(parser, "the part, or the pattern as values")
    parser.add_argument("--relief", metavar="HEIGHT", type=_length,
                        help="raise the pattern by this height along the normal; --relief=-0.4mm "
                             "carves it")
    parser.add_argument("--base", metavar="HEIGHT", type=_length,
                        help="the height where the pattern is 0 (default 0)")
    parser.add_argument("--flank", metavar="WIDTH", type=_length_or_zero,
                        help="relief of two levels with a slope of this width between them; 0: as "
                             "steep as the triangles allow (default: the relief is smooth)")
    parser.add_argument("--overhang", metavar="DEGREES", type=_degrees,
                        help="no relief on faces that face down, against z, more steeply than this")
    parser.add_argument("--unit", choices=tuple(UNITS), default="mm",
                        help="the unit of the coordinates of SURFACE (default mm)")
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--pattern", choices=tuple(PATTERNS),
                      help="the pattern (default for .stl, .3mf, .obj and with --relief: labyrinth)")
    kind.add_argument("--kinetics", metavar="NAME",
                      help="the reaction: Turing (default), Schnakenberg, GrayScott, Brusselator, "
                           "GiererMeinhardt or FitzHughNagumo")
    parser.add_argument("--seed", metavar="N", type=_whole, default=0,
                        help="of the initial noise (default 0)")
    parser.add_argument("--steps", metavar="N", type=_count,
                        help="largest number of time steps (default 640, for parts to print 2000)")


def _directions(commands):
    text = "Compute a direction on every triangle, for instance of largest curvature."
    parser = commands.add(
        "directions", tasks.directions, text,
        [f"{PROGRAM} directions lh.pial directions.npy --method CurvatureAligned"],
        "\nThe directions are a .npy array, one row per face, or cell data of a .vtk or .vtp file "
        "if SURFACE is\nsuch a file. Their sign has no meaning.\n")
    commands.mesh(parser)
    commands.output(parser, "unit vectors, or 0, on the faces")
    parser.add_argument("--method", metavar="NAME", default="PrincipalCurvature",
                        help="PrincipalCurvature (default), CurvatureAligned or Smooth")


def _curvature(commands):
    text = ("Compute curvatures of a surface at a scale. They are positive where the surface bends away "
            "from the normals of its faces, as on a sphere.")
    parser = commands.add(
        "curvature", tasks.curvature, text,
        [f"{PROGRAM} curvature lh.white.surf.gii lh.curvature.shape.gii --fwhm 5",
         f"{PROGRAM} curvature scan.ply scan.curved.ply --fwhm 2 --merge"], NEW)
    commands.mesh(parser)
    parser.add_argument("output", metavar="OUTPUT",
                        help="columns mean, gaussian, k1, k2, shape_index and curvedness")
    parser.add_argument("--fwhm", metavar="W", type=_not_negative, default=0.0,
                        help="the full width at half maximum of the Gaussian on the surface, in the "
                             "unit of the coordinates (default: 0, the scale of the mesh)")
    commands.merge(parser)


def _derivatives(commands):
    text = ("Compute the gradient or the Laplacian of data on a surface, the divergence or curl of "
            "vectors, or the conduction velocity of a wave from its arrival times.")
    parser = commands.add(
        "derivatives", tasks.derivatives, text,
        [f"{PROGRAM} derivatives lh.white lh.thickness gradient.shape.gii --fwhm 5",
         f"{PROGRAM} derivatives atrium.vtp times.npy velocity.vtp --quantity velocity --fwhm 8"], NEW)
    commands.mesh(parser)
    parser.add_argument("data", metavar="DATA", help="data at its vertices; missing ones are NaN")
    parser.add_argument("output", metavar="OUTPUT",
                        help="columns x, y, z of each gradient or velocity, with the speed after that; "
                             "or one column for each column or vector of DATA")
    parser.add_argument("--quantity", default="gradient",
                        choices=("gradient", "divergence", "curl", "laplacian", "velocity"),
                        help="what to compute (default: gradient); velocity: grad T/|grad T|^2")
    parser.add_argument("--fwhm", metavar="W", type=_not_negative, default=0.0,
                        help="the full width at half maximum of the Gaussian on the surface that "
                             "smooths DATA first, in the unit of the coordinates (default: 0)")


def _distance(commands):
    text = ("Compute the distance along a surface from the nearest of several vertices, the length of the "
            "shortest way within it; with --speed the time at which fronts from them arrive. Vertices that "
            "no way reaches are NaN.")
    parser = commands.add(
        "distance", tasks.distance, text,
        [f"{PROGRAM} distance lh.white lh.V1.label from_v1.shape.gii",
         f"{PROGRAM} distance lh.white areas.label.gii distance.shape.gii --nearest territories.shape.gii",
         f"{PROGRAM} distance scan.ply distances.ply --from 1041 --from=-3.5,20,4"], DISTANCE)
    parser.add_argument("surface", metavar="SURFACE", help="the surface")
    parser.add_argument("sources", metavar="SOURCES", nargs="?",
                        help="data at its vertices, whose nonzero vertices are the sources; each column "
                             "of its own")
    parser.add_argument("output", metavar="OUTPUT", help="the distances, values at the vertices")
    parser.add_argument("--from", dest="starts", metavar="PLACE", action="append", type=_place,
                        help="in place of SOURCES: the number of a vertex, from 0, or x,y,z, which stands "
                             "for the nearest vertex; may be given several times")
    parser.add_argument("--method", choices=("eikonal", "heat"), default="eikonal",
                        help="eikonal: fast marching (default); heat: the heat method, which is smooth "
                             "where ways meet")
    parser.add_argument("--speed", metavar="FILE",
                        help="the speed of fronts at the vertices, 0 or more; faces of speed 0 are "
                             "barriers")
    parser.add_argument("--nearest", metavar="FILE",
                        help="also write which source is the nearest one: the value in SOURCES, or the "
                             "place among --from, from 1; 0 where no way arrives")


def _place(text):
    """The number of a vertex, or coordinates."""
    words = text.split(",")
    try:
        place = [float(word) for word in words]
    except ValueError:
        place = []
    if len(place) == 1 and re.fullmatch(r"\d+", text.strip()):
        return int(text)
    if len(place) != 3 or not all(map(math.isfinite, place)):
        raise argparse.ArgumentTypeError(
            f"is {text!r}; allowed: the number of a vertex, from 0, or x,y,z")
    return place


def _normals(commands):
    text = ("Regularise the normals of a surface by harmonic maps. With --move, denoise the "
            "surface: its points are moved to fit these normals, and OUTPUT is a surface.")
    parser = commands.add(
        "normals", tasks.normals, text,
        [f"{PROGRAM} normals scan.ply clean.ply --move"], NEW)
    commands.mesh(parser)
    parser.add_argument("output", metavar="OUTPUT", help="three columns, or with --move a surface "
                                                         "in the format of SURFACE")
    parser.add_argument("--move", action="store_true", help="move the points")
    parser.add_argument("--exponent", metavar="P", type=_exponent, default=1.0,
                        help="1 keeps creases (default), 2 smooths evenly")
    parser.add_argument("--time-step", metavar="T", type=_positive, help="in natural units")
    parser.add_argument("--steps", metavar="N", type=_count, help="number of time steps")


def _fwhm(commands):
    text = ("Estimate the smoothness of noise: the full width at half maximum of the Gaussian that "
            "would make white noise as smooth as these maps. DATA must be residuals, without "
            "anatomy.")
    parser = commands.add(
        "fwhm", tasks.fwhm, text, [f"{PROGRAM} fwhm lh.pial residuals.mgh --json"])
    commands.data(parser)
    commands.choices(parser)


def _scale_filter(commands):
    text = ("Filter data by scale: a third is left of waves of WAVELENGTH, more of longer ones and less of "
            "shorter ones. The integral over the surface is kept. Missing values stay missing, and nothing "
            "flows across them, as at the coast of an ocean.")
    parser = commands.add(
        "scale-filter", tasks.scale_filter, text,
        [f"{PROGRAM} scale-filter ocean.vtp height.npy 200 large.vtp --order 2",
         f"{PROGRAM} scale-filter lh.white lh.thickness 40 lh.thickness.large --cortex"])
    commands.data(parser)
    parser.add_argument("wavelength", metavar="WAVELENGTH", type=_positive,
                        help="in the unit of the coordinates")
    commands.output(parser)
    _order(parser, 1)
    commands.choices(parser)


def _spectrum(commands):
    text = ("Print the variance of data between scales: what scale-filter takes away as its wavelength grows "
            "from each WAVELENGTH to the next.")
    parser = commands.add(
        "spectrum", tasks.spectrum, text,
        [f"{PROGRAM} spectrum ocean.vtp height.npy 50 100 200 400 800"])
    commands.data(parser)
    parser.add_argument("wavelengths", metavar="WAVELENGTH", type=_positive, nargs="+",
                        help="in the unit of the coordinates, ascending")
    _order(parser, 2)
    commands.choices(parser)


def _order(parser, order):
    parser.add_argument("--order", type=int, choices=(1, 2), default=order,
                        help=f"the sharpness of the filter, (1 + 2 (-Laplace / k^2)^order) u = DATA (default "
                             f"{order})")


def _random_field(commands):
    text = ("Draw Gaussian random fields of mean 0 and variance 1: white noise smoothed to a width, or fields "
            "of Matern's class with a range.")
    parser = commands.add(
        "random-field", tasks.random_field, text,
        [f"{PROGRAM} random-field lh.white fields.func.gii --fwhm 10 --count 100",
         f"{PROGRAM} random-field stone.ply rough.ply --range 5 --nu 1"], NEW)
    commands.mesh(parser)
    parser.add_argument("output", metavar="OUTPUT", help="the fields, one column each")
    width = parser.add_mutually_exclusive_group(required=True)
    width.add_argument("--fwhm", metavar="W", type=_positive,
                       help="full width at half maximum of the kernel, in the unit of the coordinates")
    width.add_argument("--range", metavar="R", type=_positive,
                       help="the distance at which Matern's correlation has fallen to 0.14, in the unit of the "
                            "coordinates")
    parser.add_argument("--nu", type=int, choices=(1, 3), default=1,
                        help="the smoothness of Matern's correlation (default 1)")
    _count_and_seed(parser, "fields", 1)


def _surrogates(commands):
    text = ("Draw surrogates of a map: random maps with its values and its smoothness, and nothing else in "
            "common with it. The correlations of another map with them are the distribution without a "
            "relation. Missing values stay missing.")
    parser = commands.add(
        "surrogates", tasks.surrogates, text,
        [f"{PROGRAM} surrogates lh.white lh.thickness null.func.gii --cortex --count 1000"], f"""
{SURFACES}
DATA: GIFTI, FreeSurfer (curv, .mgh, ...), NumPy (.npy), or a PLY or VTK file with data.
{NEW}""")
    commands.data(parser)
    parser.add_argument("output", metavar="OUTPUT", help="the surrogates, one column each; NaN outside")
    _count_and_seed(parser, "surrogates", 1000)
    commands.choices(parser)


def _count_and_seed(parser, what, count):
    parser.add_argument("--count", metavar="N", type=_count, default=count,
                        help=f"the number of {what} (default {count})")
    parser.add_argument("--seed", metavar="S", type=_whole, default=0,
                        help="the seed of the random numbers (default 0)")


def _doctor(commands):
    text = ("Show what is installed, and compare results with exact solutions: version, compiler, threads, "
            "packages that read files and meshes, VTK and ParaView. Takes about ten seconds.")
    commands.add("doctor", doctor, text, [f"{PROGRAM} doctor", f"{PROGRAM} doctor --json > report.json"], "")


def _info(commands):
    text = "Describe files: kind, counts, columns, values."
    parser = commands.add("info", tasks.info, text, [f"{PROGRAM} info lh.pial lh.thickness"], "")
    parser.add_argument("files", metavar="FILE", nargs="+", help="surfaces and data")
