# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The shape of a surface: directions, curvature."""
from __future__ import annotations

import numpy as np

from .. import curvature as measure
from .. import direction_field
from ..files import FileError, new_data, vtk_files, write_atomically
from ..files.content import kind_of_name
from . import common
from .report import number
from .stages import read_surface_for_output, write_array, write_new


def add_directions(commands):
    parser = commands.add(
        "directions", directions,
        "Compute a direction on every triangle, for instance of largest curvature.",
        ["lh.pial directions.npy --method CurvatureAligned"],
        "\nThe directions are a .npy array, one row per face, or cell data of a .vtk, .vtp or "
        ".vtu file if SURFACE is\nsuch a file, 0 at cells that are no faces. Their sign has no meaning.\n")
    common.mesh(parser)
    common.output(parser, "unit vectors, or 0, on the faces")
    parser.add_argument("--method", metavar="NAME", default="PrincipalCurvature",
                        help="PrincipalCurvature (default), CurvatureAligned or Smooth")
    common.merge(parser)


def directions(arguments, report):
    kind = kind_of_name(arguments.output)
    surface = read_surface_for_output(arguments, report)
    if kind != "npy" and not (kind in vtk_files.KINDS and kind == surface.kind):
        raise FileError(f"{arguments.output}: the name announces no format for directions on "
                        "faces; allowed: .npy, or .vtk, .vtp or .vtu as the surface")
    with report.working("Directions") as progress:
        field = direction_field(surface.solver, method=arguments.method, progress=progress,
                                **common.merging(arguments))
    report.facts.update(method=arguments.method, faces=len(surface.faces))
    with report.timed("write"):
        if kind == "npy":
            write_array(arguments.output, field)
        else:
            write_atomically(arguments.output, vtk_files.write(
                kind, surface.image, cell_data={"Direction": vtk_files.at_cells(surface.image, field)}))
    report.say_written(arguments.output, f"{len(surface.faces)} directions")


def add_curvature(commands):
    parser = commands.add(
        "curvature", curvature,
        "Compute curvatures of a surface at a scale. They are positive where the surface bends away "
        "from the normals of its faces, as on a sphere.",
        ["lh.white.surf.gii lh.curvature.shape.gii --fwhm 5",
         "scan.ply scan.curved.ply --fwhm 2 --merge"],
        common.NEW)
    common.mesh(parser)
    common.output(parser, "columns mean, gaussian, k1, k2, shape_index and curvedness")
    common.fwhm(parser, "", "0, the scale of the mesh")
    common.merge(parser)


def curvature(arguments, report):
    surface = read_surface_for_output(arguments, report, lengths=True)
    target = new_data(surface, arguments.output,
                      ["mean", "gaussian", "k1", "k2", "shape_index", "curvedness"])
    with report.working("Curvature") as progress:
        found = measure(surface.solver, fwhm=arguments.fwhm, progress=progress,
                        **common.merging(arguments))
    report.facts.update(fwhm=arguments.fwhm, mean_edge_length=number(found.mean_edge_length),
                        mean_curvature=number(found.mean.mean()))
    write_new(arguments, report, target, np.column_stack(
        [found.mean, found.gaussian, found.principal, found.shape_index, found.curvedness]))
