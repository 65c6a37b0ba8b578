# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The arguments that several commands have. Each function adds one of them, or those that belong
together, to the parser of a command or to a group of it."""
from __future__ import annotations

import argparse
import re
import textwrap

from . import inputs, values

PROGRAM = "surfacediffusion"

#: The options that name the surface of a hemisphere
SIDES = ("--left", "--right", "--cerebellum", "-left-surface", "-right-surface", "-cerebellum-surface", "--surface",
         "-surface")

#: What a run reads where a command has no such argument
ABSENT = {"surface": None, "left": None, "right": None, "cerebellum": None, "structures": [], "faces": False,
          "areas": [], "roi": None, "missing": None, "match_columns": False, "any_hemisphere": False,
          "fix_zeros_volume": False, "fix_zeros_surface": False}

SURFACES = "SURFACE: GIFTI (.surf.gii), FreeSurfer (lh.white, ...), OFF, OBJ, PLY, STL, or VTK."

#: The formats of new data at the vertices
NEW_FORMATS = (".func.gii, .shape.gii, .mgh, .mgz, .npy, .txt for one column, or .ply, .vtk, .vtp, .vtu if SURFACE "
               "is such a file")


def paragraph(text, width):
    return textwrap.fill(text, width, break_on_hyphens=False) + "\n"


FILES = f"""
{SURFACES}
""" + paragraph(
    "DATA: GIFTI (.func.gii, .shape.gii), CIFTI (.dscalar.nii, .dtseries.nii; give --left, --right, "
    "--cerebellum and --surface STRUCTURE FILE instead of SURFACE), FreeSurfer (curv, .mgh, .mgz, .nii.gz, .label), "
    "NumPy (.npy), text with "
    "one number per line (.txt; # starts a comment), or a PLY or VTK file with data at its vertices; with "
    "--faces, where there is that option, at the faces. Files are recognised by their content, and may be "
    "compressed by gzip, or pipes. OUTPUT has the format and the metadata of DATA, and its name the extension "
    "of that format. DATA of a FreeSurfer curv, NumPy or text file have no metadata: their OUTPUT may be "
    f"{NEW_FORMATS}, too. NaN means missing: the value is not used, and the output has a value there.", 98)

NEW = "\n" + paragraph(f"The name of OUTPUT gives its format: {NEW_FORMATS}.", 96)


class Parser(argparse.ArgumentParser):
    """Errors are one line; the usage is in --help."""

    def error(self, message):
        self.exit(2, f"{self.prog}: {message}; see {self.prog} --help\n")


class Command(Parser):
    """hemispheres: whether its surfaces are given by --left and --right."""

    def __init__(self, *, hemispheres=False, **options):
        super().__init__(**options)
        self.hemispheres = hemispheres


class Commands:
    """The commands of the parser, to which add() adds one."""

    def __init__(self, subparsers, hemispheres):
        self._subparsers = subparsers
        self._hemispheres = hemispheres

    def add(self, name, run, text, examples, files=FILES):
        """A command with the arguments of all commands. run(arguments, report) carries it out. examples:
        command lines after the name. files: about formats, at the end of --help."""
        lines = "\n".join(f"  {PROGRAM} {name} {example}".rstrip() for example in examples)
        parser = self._subparsers.add_parser(
            name, help=re.split(r"[.:] ", text)[0].rstrip("."), allow_abbrev=False,
            description=textwrap.fill(text, 98), hemispheres=self._hemispheres,
            formatter_class=argparse.RawDescriptionHelpFormatter,
            epilog=f"Example:\n{lines}\n{files}")
        parser.set_defaults(run=run, **ABSENT)
        parser.add_argument("--json", action="store_true",
                            help="print a report as JSON: times, widths, totals, warnings")
        parser.add_argument("--quiet", action="store_true",
                            help="print nothing but errors: no progress bar, no summary")
        parser.add_argument("--threads", metavar="N",
                            type=values.whole_numbers("a whole number from 0 to 1024", 0, 1024),
                            help="the number of threads, 0: all processors (default: that of the "
                                 "variable SURFACEDIFFUSION_NUM_THREADS, else of OMP_NUM_THREADS, else "
                                 "0); the result does not depend on it")
        return parser


# ---- files ---------------------------------------------------------------------------------------

def mesh(parser):
    parser.add_argument("surface", metavar="SURFACE", help="the surface")


def hemispheres(parser):
    parser.add_argument("--left", "-left-surface", metavar="FILE",
                        help="the surface of the left hemisphere, for CIFTI files")
    parser.add_argument("--right", "-right-surface", metavar="FILE",
                        help="the surface of the right hemisphere")
    parser.add_argument("--cerebellum", "-cerebellum-surface", metavar="FILE",
                        help="the surface of the cerebellum, for files with its vertices")
    parser.add_argument("--surface", "-surface", dest="structures", nargs=2, action="append", default=[],
                        metavar=("STRUCTURE", "FILE"),
                        help="the surface of another structure, by Workbench's word, such as HIPPOCAMPUS_LEFT or "
                             "HIPPOCAMPUS_DENTATE_RIGHT; can be repeated")
    any_hemisphere(parser)


def any_hemisphere(parser):
    parser.add_argument("--any-hemisphere", "-any-hemisphere", action="store_true",
                        help="take data and surfaces of different hemispheres, too")


def surface_and_data(parser, many=False):
    if parser.hemispheres:
        hemispheres(parser)
    else:
        mesh(parser)
        any_hemisphere(parser)
    parser.add_argument("data", metavar="DATA", nargs="+" if many else None,
                        help="the values at its vertices"
                             + "; several files, if OUTPUT is a folder" * many)


def output(parser, text="the result"):
    parser.add_argument("output", metavar="OUTPUT", help=text)


def areas(parser, *options):
    """The words STRUCTURE FILE are joined by parse()."""
    parser.add_argument(*options, dest="areas", metavar="FILE", action="append", default=[],
                        help="the areas of the vertices in the first column, in place of those of "
                             "the surface: for a surface that is the average of many. For CIFTI files also "
                             "STRUCTURE FILE, with Workbench's word; can be repeated, for all surfaces or none")


def side_areas(parser):
    """Workbench's words for the areas of each surface."""
    for side, structure in inputs.SIDES.items():
        parser.add_argument(f"-{side}-corrected-areas", dest="areas", metavar="FILE", action="append", default=[],
                            type=lambda path, structure=structure: f"{structure}\0{path}",
                            help=f"the areas of the vertices of -{side}-surface")


def direction(parser):
    """Workbench's word for the axis of a CIFTI matrix."""
    parser.add_argument("direction", choices=("COLUMN",),
                        help="the direction of the vertices and voxels in the matrix")


# ---- what is chosen of the data and of the surface -----------------------------------------------

def region_and_columns(parser):
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
    zeros_and_columns(parser)


def zeros_and_columns(parser):
    parser.add_argument("--fix-zeros", "-fix-zeros", action="store_true",
                        help="zeros mean missing, as NaN does")
    columns(parser)


def columns(parser):
    parser.add_argument("--column", "-column", action="append", metavar="N|NAME", default=[],
                        help="a column of DATA by number (from 1) or name; can be repeated. "
                             "Default: all; of a VTK file with active scalars, these")


def data_to_data(parser, text="the result"):
    """For a command that changes DATA. text: about OUTPUT."""
    surface_and_data(parser)
    output(parser, text)
    region_and_columns(parser)
    merge(parser)


def faces(parser):
    parser.add_argument("--faces", action="store_true",
                        help="DATA, and all other files of data, have values at the faces: "
                             "GIFTI, .mgh, .npy with one row per face, or VTK with cell "
                             "arrays. So has OUTPUT")


def merge(parser):
    parser.add_argument("--merge", action="store_true",
                        help="vertices at the same place are one vertex of the surface, as files "
                             "with split normals or texture seams need")
    positive(parser, "--merge-tolerance", "DISTANCE",
             "as --merge, also of vertices within DISTANCE of one another, as seams need whose sides "
             "differ by round-off")


def merging(arguments):
    """The settings of --merge and --merge-tolerance, where a command has them."""
    tolerance = getattr(arguments, "merge_tolerance", None)
    return {"merge_coincident_points": getattr(arguments, "merge", False) or tolerance is not None,
            "merge_tolerance": tolerance or 0.0}


def coordinates(parser, which):
    """Of which points the coordinates are given."""
    parser.add_argument("--ras", choices=("tkr", "scanner"), default="tkr",
                        help=f"the coordinates of {which}: tkr: those of SURFACE (default); scanner: larger by "
                             "FreeSurfer's c_ras, or by the transform of GIFTI, which is in the file of SURFACE")


# ---- numbers -------------------------------------------------------------------------------------

def positive(parser, option, metavar, text, default=None):
    parser.add_argument(option, metavar=metavar, type=values.positive, default=default, help=text)


def noise(parser, text):
    """text: of what, and in which unit"""
    positive(parser, "--noise", "SD", f"the standard deviation of {text}")


def fwhm(parser, which, default):
    """The width of a Gaussian, 0 for none."""
    parser.add_argument("--fwhm", metavar="W", type=values.not_negative, default=0.0,
                        help=f"the full width at half maximum of the Gaussian on the surface{which}, in "
                             f"the unit of the coordinates (default: {default})")


def wavelength(parser, dest, text="", nargs=None):
    parser.add_argument(dest, metavar="WAVELENGTH", type=values.positive, nargs=nargs,
                        help=f"in the unit of the coordinates{text}")


def order(parser, default):
    parser.add_argument("--order", type=int, choices=(1, 2), default=default,
                        help="the sharpness of the filter, (1 + 2 (-Laplace / k^2)^order) u = DATA "
                             f"(default {default})")


def steps(parser, text="number of time steps", default=None):
    parser.add_argument("--steps", metavar="N", type=values.count, default=default, help=text)


def seed(parser, text, metavar="N"):
    parser.add_argument("--seed", metavar=metavar, type=values.whole, default=0,
                        help=f"{text} (default 0)")


def count_and_seed(parser, what, default):
    parser.add_argument("--count", metavar="N", type=values.count, default=default,
                        help=f"the number of {what} (default {default})")
    seed(parser, "the seed of the random numbers", metavar="S")
