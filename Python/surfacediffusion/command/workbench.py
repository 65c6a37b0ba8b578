# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Commands with the names, arguments and meaning of Workbench's: metric-gradient, metric-estimate-fwhm,
cifti-estimate-fwhm, surface-curvature, surface-geodesic-distance and surface-vertex-areas."""
from __future__ import annotations

import numpy as np

from .. import curvature as measure_curvature
from .. import distance, estimate_fwhm, gradient, heat
from .._voxels import voxel_fwhm
from ..files import Data, Part, new_data
from ..files.cifti import open_cifti, word_of_structure
from ..files.content import check_output_folder, read_content
from . import common, inputs, values
from .areas import read_areas, vertex_areas
from .report import counted, number, number_text
from .smoothing import SIGMA_TO_FWHM
from .grayordinates import require_cifti
from .stages import read, read_surface_for_output, write_new
from .surfaces import open_surface


def add_metric_gradient(commands):
    parser = commands.add(
        "metric-gradient", metric_gradient,
        "Compute the gradient of data with the arguments of wb_command -metric-gradient, and with their "
        "meaning: OUTPUT is its magnitude per mm, 0 outside of the region. The directions are those of "
        "`derivatives --quantity gradient`.",
        ["L.midthickness.surf.gii L.thickness.shape.gii L.gradient.func.gii -presmooth 2 -roi L.roi.shape.gii"])
    common.surface_and_data(parser)
    common.output(parser, "the magnitude, a column for each of DATA")
    parser.add_argument("-presmooth", metavar="KERNEL", type=values.positive,
                        help="smooth first by a Gaussian of this standard deviation in mm")
    parser.add_argument("-fwhm", dest="sigma", action="store_false",
                        help="KERNEL is the full width at half maximum")
    common.region_and_columns(parser)
    parser.add_argument("-vectors", metavar="FILE", help="write x, y and z of the gradient of each column, too")
    parser.add_argument("-average-normals", action="store_true",
                        help="no effect: gradients are tangential to the faces about each vertex")


def metric_gradient(arguments, report):
    for path in filter(None, (arguments.output, arguments.vectors)):
        check_output_folder(path)
    with report.timed("read"):
        _, data, columns, (patch, *_) = read(arguments)
        names = [data.names[c] for c in columns]
        target = new_data(patch.surface, arguments.output, names)
        vectors = arguments.vectors and new_data(
            patch.surface, arguments.vectors, [f"{name} {axis}" for name in names for axis in "xyz"])
    outside = patch.excluded if patch.excluded.any() else None
    given = patch.values.astype(float)
    with report.working("Gradient") as progress:
        if arguments.presmooth is not None:
            width = arguments.presmooth * (SIGMA_TO_FWHM if arguments.sigma else 1.0)
            given = heat(patch.surface.solver, given, fwhm=width, time_integrator="Exponential", mask=outside,
                         mask_mode="Exclude", number_of_time_steps=1)
        found = gradient(patch.surface.solver, given, mask=outside, progress=progress).reshape(len(given), -1, 3)
    found[patch.excluded] = 0.0
    report.facts.update(data=data.path, output=arguments.output)
    write_new(arguments, report, target, np.linalg.norm(found, axis=2))
    if vectors:
        with report.timed("write"):
            vectors.save(arguments.vectors, [found.reshape(len(given), -1).astype(np.float32)])


def add_metric_estimate_fwhm(commands):
    parser = commands.add(
        "metric-estimate-fwhm", metric_estimate_fwhm,
        "Estimate the smoothness of each column with the arguments of wb_command -metric-estimate-fwhm, and print "
        "it in its words. Unlike there, edges count with their lengths. The estimate of all columns, as noise, "
        "is that of `fwhm`.", ["L.midthickness.surf.gii L.residuals.func.gii -whole-file -demean"])
    common.surface_and_data(parser)
    common.region_and_columns(parser)
    _whole_file(parser)


def _whole_file(parser):
    parser.add_argument("-whole-file", action="store_true", help="one estimate for all columns")
    parser.add_argument("-demean", action="store_true", help="subtract the mean of the columns from each of them")


def _demeaned(arguments, given):
    given = given.astype(float)
    return given - given.mean(axis=1, keepdims=True) if arguments.demean else given


def _check_demean(arguments):
    if arguments.demean and not arguments.whole_file:
        raise inputs.ArgumentProblem("-demean without -whole-file; allowed: both")


def metric_estimate_fwhm(arguments, report):
    _check_demean(arguments)
    with report.timed("read"):
        _, data, columns, (patch, *_) = read(arguments)
    given = _demeaned(arguments, patch.values)
    known = ~(patch.excluded | np.isnan(given).any(axis=1))
    with report.timed("compute"):
        found = estimate_fwhm(patch.surface.solver, given, mask=~known)
    report.facts.update(data=data.path, pooled=number(found.pooled), columns=[
        {"column": column + 1, "fwhm": number(width)} for column, width in zip(columns, found.columns)])
    if arguments.whole_file:
        report.say(f"FWHM: {number_text(found.pooled)}")
        return
    for column, width in zip(columns, found.columns):
        report.say(f"column {column + 1} FWHM: {number_text(width)}")


def add_cifti_estimate_fwhm(commands):
    parser = commands.add(
        "cifti-estimate-fwhm", cifti_estimate_fwhm,
        "Estimate the smoothness of the structures of a CIFTI file with the arguments of wb_command "
        "-cifti-estimate-fwhm, and print it in its words: of voxels along the axes of the grid. Unlike there, edges "
        "of surfaces count with their lengths.",
        ["residuals.dscalar.nii -whole-file -demean -surface CORTEX_LEFT L.midthickness.surf.gii"], "")
    parser.add_argument("data", metavar="CIFTI", help="the values, .dscalar.nii or .dtseries.nii")
    common.hemispheres(parser)
    common.columns(parser)
    parser.add_argument("-merged-volume", action="store_true", help="one estimate for the voxels of all structures")
    _whole_file(parser)
    parser.set_defaults(fix_zeros=False)


def cifti_estimate_fwhm(arguments, report):
    _check_demean(arguments)
    with report.timed("read"):
        file = open_cifti(require_cifti(read_content(arguments.data)))
        data = Data(file.content.path, "cifti", file.names, [], usual=range(len(file.names)))
        columns = inputs.choose_columns(data, arguments.column)
        data.parts = [Part(file.read(columns, [entry.place]).T, entry.vertices, entry.size, entry.name)
                      for entry in file.structures if entry.vertices is not None]
        surfaces = inputs.read_surfaces(arguments)
        patches = inputs.make_patches(surfaces, data, range(len(columns)), arguments)
    groups = [slice(None)] if arguments.whole_file else [slice(k, k + 1) for k in range(len(columns))]
    lines = [[] for _ in groups]
    with report.timed("compute"):
        for patch in patches:
            given = _demeaned(arguments, patch.values)
            absent = patch.excluded | np.isnan(given).any(axis=1)
            found = estimate_fwhm(patch.surface.solver, given, mask=absent)
            for line, width in zip(lines, [found.pooled] if arguments.whole_file else found.columns):
                line.append((word_of_structure(patch.part.structure), [width]))
        for name, entries in _volumes(file, arguments.merged_volume):
            given = _demeaned(arguments, file.read(columns, [entry.place for entry in entries]).T)
            voxels = np.concatenate([entry.voxels for entry in entries])
            for line, group in zip(lines, groups):
                line.append((name, voxel_fwhm(voxels, entries[0].affine, given[:, group])))
    report.facts.update(data=file.content.path, estimates=[
        {name: [number(width) for width in widths] for name, widths in line} for line in lines])
    for k, line in enumerate(lines):
        if not arguments.whole_file:
            report.say(f"Column {columns[k] + 1}:")
        for name, widths in line:
            report.say(f"{name} FWHM: " + ", ".join(map(number_text, widths)))


def _volumes(file, merged):
    """The structures of voxels, each or all together, with their names in Workbench's words."""
    entries = [entry for entry in file.structures if entry.voxels is not None]
    if merged and entries:
        return [("Voxels", entries)]
    return [(word_of_structure(entry.name), [entry]) for entry in entries]


def add_surface_curvature(commands):
    parser = commands.add(
        "surface-curvature", surface_curvature,
        "Compute curvatures with the arguments of wb_command -surface-curvature, and with their signs: positive "
        "where the surface bends away from its normals, as on a sphere. The numbers are those of `curvature`.",
        ["L.midthickness.surf.gii -mean L.mean.shape.gii -gauss L.gauss.shape.gii"], common.NEW)
    common.mesh(parser)
    parser.add_argument("-mean", metavar="FILE", help="write the mean curvature, per mm")
    parser.add_argument("-gauss", metavar="FILE", help="write the Gaussian curvature, per mm^2")


def surface_curvature(arguments, report):
    outputs = [(path, name) for path, name in ((arguments.mean, "mean"), (arguments.gauss, "gaussian")) if path]
    if not outputs:
        raise inputs.ArgumentProblem("-mean and -gauss are missing; allowed: one of them, or both")
    for path, _ in outputs:
        check_output_folder(path)
    with report.timed("read"):
        surface = open_surface(arguments, arguments.surface)
        targets = [new_data(surface, path, [name]) for path, name in outputs]
    with report.working("Curvature") as progress:
        found = measure_curvature(surface.solver, progress=progress)
    report.facts.update(surface=arguments.surface)
    for (path, name), target in zip(outputs, targets):
        target.save(path, [getattr(found, name)[:, None].astype(np.float32)])
        report.say_written(path, counted(1, "column"))


def add_surface_geodesic_distance(commands):
    parser = commands.add(
        "surface-geodesic-distance", surface_geodesic_distance,
        "Compute the distance of all vertices from one with the arguments of wb_command "
        "-surface-geodesic-distance; -1 beyond -limit. Ways go over the faces, those of Workbench over "
        "edges and pairs of triangles, and are up to some percent longer.",
        ["L.midthickness.surf.gii 1041 L.distance.func.gii -limit 50"], common.NEW)
    common.mesh(parser)
    parser.add_argument("vertex", metavar="VERTEX", type=values.whole, help="the number of the vertex, from 0")
    common.output(parser, "the distances")
    common.positive(parser, "-limit", "MM", "distances up to this one alone")
    common.areas(parser, "-corrected-areas")


def surface_geodesic_distance(arguments, report):
    surface = read_surface_for_output(arguments, report, lengths=True)
    if not 0 <= arguments.vertex < len(surface.points):
        raise inputs.ArgumentProblem(f"VERTEX is {arguments.vertex}; allowed: 0 to {len(surface.points) - 1}")
    areas = read_areas(arguments.areas, {"": surface}).get(id(surface))
    target = new_data(surface, arguments.output, [f"distance from {arguments.vertex}"])
    speed = None
    if areas is not None:  # lengths grow with the root of the area
        speed = np.sqrt(vertex_areas(surface) / areas)
    with report.working("Distance") as progress:
        found = distance(surface.solver, [arguments.vertex], speed=speed, progress=progress,
                         maximum_distance=arguments.limit or 0.0)
    beyond = ~np.isfinite(found) | (found > (arguments.limit or np.inf))
    write_new(arguments, report, target, np.where(beyond, -1.0, found)[:, None])


def add_surface_vertex_areas(commands):
    parser = commands.add(
        "surface-vertex-areas", surface_vertex_areas,
        "Write the areas of the vertices as wb_command -surface-vertex-areas: a third of the triangles at each. "
        "Their means over subjects are what --areas takes.",
        ["L.midthickness.surf.gii L.areas.shape.gii"], common.NEW)
    common.mesh(parser)
    common.output(parser, "the areas, in mm^2")


def surface_vertex_areas(arguments, report):
    surface = read_surface_for_output(arguments, report, lengths=True)
    target = new_data(surface, arguments.output, ["vertex areas"])
    write_new(arguments, report, target, vertex_areas(surface)[:, None])
