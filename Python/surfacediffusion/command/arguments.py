# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The parser of the command line: which commands there are, and what holds for all of them."""
from __future__ import annotations

import argparse
import os
import re

from . import (
    denoising, dilating, distances, doctor, edges, fields, filling, info, parts, resampling, scales, shape,
    smoothing, workbench)
from .common import PROGRAM, SIDES, Command, Commands, Parser
from ..files.cifti import structure_of_word
from .inputs import ArgumentProblem

__all__ = ["make_parser", "parse"]

#: What declares each command, in the order of --help
COMMANDS = (
    smoothing.add_smooth,
    smoothing.add_metric_smoothing,
    smoothing.add_cifti_smoothing,
    denoising.add_denoise,
    denoising.add_denoise_mesh,
    filling.add_inpaint,
    filling.add_interpolate,
    dilating.add_metric_dilate,
    dilating.add_cifti_dilate,
    edges.add_enhance,
    edges.add_edges,
    edges.add_segment,
    parts.add_refine,
    parts.add_texture,
    shape.add_directions,
    shape.add_curvature,
    distances.add_derivatives,
    distances.add_distance,
    distances.add_path,
    denoising.add_normals,
    scales.add_fwhm,
    scales.add_scale_filter,
    scales.add_spectrum,
    fields.add_random_field,
    fields.add_surrogates,
    resampling.add_resample,
    resampling.add_metric_resample,
    workbench.add_metric_gradient,
    workbench.add_metric_estimate_fwhm,
    workbench.add_cifti_estimate_fwhm,
    workbench.add_surface_curvature,
    workbench.add_surface_geodesic_distance,
    workbench.add_surface_vertex_areas,
    info.add_info,
    doctor.add_doctor,
)


#: The commands with Workbench's names and arguments
SAME_WORDS = ("-metric-smoothing", "-cifti-smoothing", "-metric-resample", "-metric-dilate", "-cifti-dilate",
              "-metric-gradient", "-metric-estimate-fwhm", "-cifti-estimate-fwhm",
              "-surface-curvature", "-surface-geodesic-distance", "-surface-vertex-areas")

#: What other commands of Workbench are here
WORKBENCH = {
    "-cifti-gradient": "derivatives", "-surface-information": "info", "-file-information": "info",
    "-label-resample": "resample",
}


def parse(argv):
    """The arguments of the command line, with the function that carries them out as `run`."""
    if argv and argv[0] in SAME_WORDS:  # as after wb_command
        argv = [argv[0][1:], *argv[1:]]
    elif argv and argv[0] in WORKBENCH:
        raise ArgumentProblem(f"{argv[0]} is a command of Workbench with arguments of its own; allowed: "
                              f"{PROGRAM} {WORKBENCH[argv[0]]}, or {', '.join(SAME_WORDS)}")
    # A CIFTI file has a surface per hemisphere, by --left and --right instead of SURFACE.
    hemispheres = any(word.split("=")[0] in SIDES for word in argv) or (
        len(argv) > 1 and re.search(r"\.d[a-z]+\.nii$", argv[1]) is not None)
    parser = make_parser(hemispheres)
    complete(parser)
    argv = _join_structures(argv)
    arguments = parser.parse_args(argv)
    if getattr(arguments, "cortex", False):
        arguments.roi = _cortex_label(parser, arguments)
    return arguments


def _join_structures(argv):
    """The words --areas STRUCTURE FILE as one argument of the option; STRUCTURE is in capitals, as CORTEX_LEFT."""
    joined = []
    for word in argv:
        if len(joined) > 1 and joined[-2] in ("--areas", "-corrected-areas") and re.fullmatch(
                "[A-Z]+(_[A-Z]+)*", joined[-1]):
            joined[-1] = f"{structure_of_word(joined[-1])}\0{word}"
        else:
            joined.append(word)
    return joined


def make_parser(hemispheres=False):
    """hemispheres: whether surfaces are given by --left and --right, as for CIFTI files."""
    parser = Parser(
        prog=PROGRAM, allow_abbrev=False,
        description="Diffusion equations on surfaces, for files.",
        epilog=f"{PROGRAM} COMMAND --help shows the arguments of a command and an example.")
    parser.add_argument("--version", action="version", version=f"{PROGRAM} {doctor.version()}")
    parser.add_argument(
        "--completion", action=_Completion, choices=("bash", "zsh", "fish"), metavar="SHELL",
        help="print the script by which bash, zsh or fish completes commands, options and files, and end")
    commands = Commands(parser.add_subparsers(
        dest="command", metavar="COMMAND", required=True, parser_class=Command), hemispheres)
    for add in COMMANDS:
        add(commands)
    return parser


class _Completion(argparse.Action):
    """Prints the script that a shell runs at its start."""

    def __call__(self, parser, namespace, values, option_string=None):
        try:
            import argcomplete
        except ImportError:
            parser.error("--completion needs argcomplete, which is not installed; pip install argcomplete")
        print(argcomplete.shellcode([PROGRAM], shell=values))
        parser.exit()


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
