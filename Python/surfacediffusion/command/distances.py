# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Distances along a surface, paths on it, and derivatives of data: distance, path, derivatives."""
from __future__ import annotations

import numpy as np

from .. import conduction_velocity, nearest_sources, path_through
from .. import derivatives as derive
from ..files import FileError, new_data
from ..files.content import kind_of_name, read_content, write_atomically
from . import common, inputs, values
from .report import number
from .stages import read_surface_for_output, write_array, write_new

SOURCES = f"""
SOURCES: GIFTI, FreeSurfer (.label, curv, .mgh, ...), NumPy (.npy), text (.txt), or a PLY or VTK file with
data. NaN is no source.{common.NEW}"""


def add_distance(commands):
    parser = commands.add(
        "distance", distance,
        "Compute the distance along a surface from the nearest of several vertices, the length of the "
        "shortest way within it; with --speed the time at which fronts from them arrive. Vertices that "
        "no way reaches are NaN.",
        ["lh.white lh.V1.label from_v1.shape.gii",
         "lh.white areas.label.gii distance.shape.gii --nearest territories.shape.gii",
         "scan.ply distances.ply --from 1041 --from=-3.5,20,4"], SOURCES)
    common.mesh(parser)
    parser.add_argument("sources", metavar="SOURCES", nargs="?",
                        help="data at its vertices, whose nonzero vertices are the sources; each column "
                             "of its own")
    common.output(parser, "the distances, values at the vertices")
    common.coordinates(parser, "PLACE")
    common.any_hemisphere(parser)
    parser.add_argument("--from", dest="starts", metavar="PLACE", action="append", type=values.place,
                        help="in place of SOURCES: the number of a vertex, from 0, or x,y,z, which "
                             "stands for the nearest place of the surface; may be given several times")
    parser.add_argument("--method", choices=("automatic", "exact", "eikonal", "heat"), default="automatic",
                        help="automatic: exact where it takes at most a second, without --speed, and "
                             "eikonal otherwise (default); exact: the lengths of the shortest ways over "
                             "the faces; eikonal: fast marching; heat: the heat method, which is smooth "
                             "where ways meet")
    parser.add_argument("--speed", metavar="FILE",
                        help="the speed of fronts at the vertices, 0 or more; faces of speed 0 are "
                             "barriers")
    parser.add_argument("--signed", action="store_true",
                        help="the sources are a region, its nonzero vertices: distances from its boundary, "
                             "below 0 inside")
    parser.add_argument("--nearest", metavar="FILE",
                        help="also write which source is the nearest one: the value in SOURCES, or the "
                             "place among --from, from 1; 0 where no way arrives")


def distance(arguments, report):
    if (arguments.sources is None) == (arguments.starts is None):
        raise inputs.ArgumentProblem("the sources are " + (
            "missing" if arguments.starts is None else "both SOURCES and --from")
            + "; allowed: one of SOURCES and --from")
    if arguments.signed and arguments.sources is None:
        raise inputs.ArgumentProblem("--signed needs a region; allowed: with SOURCES")
    if arguments.signed:
        inputs.refuse(arguments, ["--nearest"], "with --signed", "without it")
    surface = read_surface_for_output(arguments, report, lengths=True)
    with report.timed("read"):
        sets, numbers, names = _read_sources(arguments, surface, report)
        speed = None
        if arguments.speed is not None:
            speed = inputs.read_values(arguments.speed, surface, tables=False)[1][:, 0]
    target = new_data(surface, arguments.output, names)
    nearest = arguments.nearest and new_data(surface, arguments.nearest, names)
    solver = surface.solver
    with report.working("Distance") as progress:
        results = [nearest_sources(solver, _as_region(places, surface) if arguments.signed else places,
                                   speed=speed, method=arguments.method, signed=arguments.signed,
                                   progress=progress)
                   for places in sets]
        found = np.column_stack([result.distance for result in results])
    reached = np.isfinite(found)
    report.facts.update(
        method=results[0].method.lower(), columns=[
            {"name": name, "sources": len(rows), "unreached": int((~column).sum()),
             "maximum": number(times[column].max())}
            for name, rows, times, column in zip(names, sets, found.T, reached.T)])
    write_new(arguments, report, target, np.where(reached, found, np.nan))
    if nearest:
        labels = np.column_stack([np.where(result.source < 0, 0, given[result.source])
                                  for result, given in zip(results, numbers)])
        nearest.save(arguments.nearest, [labels.astype(np.float32)])


def _as_region(rows, surface):
    region = np.zeros(len(surface.points), dtype=bool)
    region[rows] = True
    return region


def add_path(commands):
    parser = commands.add(
        "path", path,
        "Find the shortest path on a surface from one place to another, by way of others if they are given. It "
        "is straight over the faces.",
        ["scan.ply rim.vtk --from 1041 --to=-3.5,20,4", "part.stl loop.npy --from 12 --by 80 --to 143 --closed"],
        "\nOUTPUT: the points of the path, in the coordinates of SURFACE, as rows of x, y, z (.npy) or a line for "
        "ParaView (.vtk).\n")
    common.mesh(parser)
    common.output(parser, "the path")
    for option, what in (("--from", "where it begins"), ("--to", "where it ends")):
        parser.add_argument(option, dest=option[2:] + "_", metavar="PLACE", type=values.place, required=True,
                            help=what + ": the number of a vertex, from 0, or x,y,z, which stands for the "
                                        "nearest place of the surface")
    common.coordinates(parser, "PLACE")
    parser.add_argument("--by", metavar="PLACE", action="append", type=values.place, default=[],
                        help="a place between; may be given several times")
    parser.add_argument("--closed", action="store_true", help="lead back to the begin")


def path(arguments, report):
    kind = kind_of_name(arguments.output)
    if kind not in ("npy", "vtk"):
        raise FileError(f"{arguments.output}: the name announces no format for paths; allowed: .npy, .vtk")
    surface = read_surface_for_output(arguments, report, lengths=True)
    places = [arguments.from_, *arguments.by, arguments.to_]
    for place in places:
        if isinstance(place, int) and place >= len(surface.points):
            raise inputs.ArgumentProblem(f"a place is {place}; allowed: 0 to {len(surface.points) - 1}, the "
                                         f"vertices of {surface.path}, or x,y,z")
    places = [place if isinstance(place, int) else inputs.to_surface(arguments, surface, place, report)
              for place in places]
    with report.working("Path") as progress:
        found = path_through(surface.solver, places, closed=arguments.closed, progress=progress)
    report.facts.update(length=number(found.length), points=len(found.points))
    with report.timed("write"):
        if kind == "npy":
            write_array(arguments.output, found.points)
        else:
            write_atomically(arguments.output, _polyline(found.points).encode())
    report.say_written(arguments.output, f"length {found.length:.6g}")


def _polyline(points):
    """A line as a legacy file of VTK."""
    count = len(points)
    rows = [" ".join(map(repr, row)) for row in points.tolist()]
    return "\n".join(["# vtk DataFile Version 3.0", "a path on a surface", "ASCII", "DATASET POLYDATA",
                      f"POINTS {count} double", *rows, f"LINES 1 {count + 1}",
                      " ".join(map(str, [count, *range(count)])), ""])


def _read_sources(arguments, surface, report):
    """The vertices or coordinates of each set of sources, the number that each of them stands for, and the
    names of the columns."""
    count = len(surface.points)
    if arguments.starts is not None:
        are_vertices = [isinstance(place, int) for place in arguments.starts]
        for place, is_vertex in zip(arguments.starts, are_vertices):
            if is_vertex and place >= count:
                raise inputs.ArgumentProblem(f"--from is {place}; allowed: 0 to {count - 1}, the "
                                             f"vertices of {surface.path}, or x,y,z")
        places = arguments.starts if all(are_vertices) else [
            surface.points[place] if is_vertex else inputs.to_surface(arguments, surface, place, report)
            for place, is_vertex in zip(arguments.starts, are_vertices)]
        return [np.array(places)], [np.arange(1, len(places) + 1)], ["distance"]
    content = read_content(arguments.sources)
    _, columns, names = inputs.read_values(content, surface, tables=False)
    if content.kind == "label":  # whose values may be anything, and mostly are 0
        columns = np.isfinite(columns).astype(float)
    sets = [np.flatnonzero(np.nan_to_num(column)) for column in columns.T]
    for rows, name in zip(sets, names):
        if len(rows) == 0:
            raise FileError(f"{arguments.sources}: the column {name!r} is 0 at all vertices; allowed: a "
                            "nonzero vertex, which is a source")
    return sets, [column[rows] for column, rows in zip(columns.T, sets)], names


def add_derivatives(commands):
    parser = commands.add(
        "derivatives", derivatives,
        "Compute the gradient or the Laplacian of data on a surface, the divergence or curl of "
        "vectors, or the conduction velocity of a wave from its arrival times.",
        ["lh.white lh.thickness gradient.shape.gii --fwhm 5",
         "atrium.vtp times.npy velocity.vtp --quantity velocity --fwhm 8",
         "atrium.vtp times.npy velocity.vtp --quantity velocity --error slopes.npy"], common.NEW)
    common.mesh(parser)
    parser.add_argument("data", metavar="DATA", help="data at its vertices; missing ones are NaN")
    common.output(parser, "columns x, y, z of each gradient or velocity, with the speed after that, and the "
                          "bounds of its band with --error; or one column for each column or vector of DATA")
    parser.add_argument("--quantity", default="gradient",
                        choices=("gradient", "divergence", "curl", "laplacian", "velocity"),
                        help="what to compute (default: gradient); velocity: grad T/|grad T|^2")
    parser.add_argument("--error", metavar="FILE",
                        help="the standard errors of the slopes of times, of interpolate --slope-error, for "
                             "velocity: the bounds of a band that holds 90 %% of the speeds are columns, too")
    common.any_hemisphere(parser)
    common.fwhm(parser, " that smooths DATA first", "0")
    common.merge(parser)


def derivatives(arguments, report):
    if arguments.quantity != "velocity":
        inputs.refuse(arguments, ["--error"], f"with --quantity {arguments.quantity}", "--quantity velocity")
    surface = read_surface_for_output(arguments, report, lengths=True)
    error = None
    with report.timed("read"):
        _, data, names = inputs.read_values(arguments.data, surface, tables=False)
        if arguments.error is not None:
            error = inputs.read_values(arguments.error, surface, tables=False)[1]
    word = arguments.quantity.capitalize()
    options = {"on_faces": False, "smoothing_fwhm": arguments.fwhm, **common.merging(arguments)}
    with report.working(word) as progress:
        solver = surface.solver
        if arguments.quantity == "velocity":
            found = conduction_velocity(solver, data, error=error, progress=progress, **options)
            bands = () if error is None else (found.speed_lower, found.speed_upper)
            result = np.column_stack((*found, *bands))
        else:
            result = derive(solver, data, quantity=word, progress=progress, **options)
    if arguments.quantity in ("gradient", "velocity"):
        columns = [f"{name} {axis}" for name in names for axis in "xyz"]
    elif arguments.quantity == "laplacian":
        columns = list(names)
    else:
        columns = list(names[::3])
    if arguments.quantity == "velocity":
        columns += [f"{name} speed{bound}" for bound in ("", *(() if error is None else (" lower", " upper")))
                    for name in names]
    report.facts.update(quantity=arguments.quantity, fwhm=arguments.fwhm)
    target = new_data(surface, arguments.output, columns)
    write_new(arguments, report, target, result.reshape(len(surface.points), -1))
