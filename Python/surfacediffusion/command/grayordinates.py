# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""New values of CIFTI files, on surfaces and among voxels, by a few columns at a time."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import heat
from .._voxels import VoxelSmoother
from ..files import Data, FileError, Part
from ..files.cifti import open_cifti
from ..files.content import check_output_folder, check_output_name, read_content
from . import inputs
from .areas import read_areas, vertex_areas
from .common import merging
from .inputs import ArgumentProblem
from .report import number

#: Values that are read, smoothed and written together.
PANEL = 1 << 23


def smooth(arguments, report, content, width, voxel_width):
    """Smooth a CIFTI file. voxel_width: the FWHM among voxels; 0: they are copied."""
    def on_surface(solver, values, mask):
        return heat(solver, values, mask=mask, mask_mode="Exclude", fwhm=width, time_integrator="Exponential",
                    mass_matrix=arguments.mass_matrix.capitalize(), number_of_time_steps=arguments.steps,
                    **merging(arguments))

    columns = change(arguments, report, content, "Smoothing", on_surface if width else None,
                     (lambda *voxels: VoxelSmoother(*voxels, voxel_width)) if voxel_width else None)
    report.facts.update(voxel_fwhm=voxel_width)
    return columns


def change(arguments, report, content, title, on_surface, among_voxels):
    """Write a CIFTI file with new values, and return the numbers of its columns. on_surface(surface, values (n, k),
    mask): the new values, where NaN is missing and the mask outside. among_voxels(voxels, affine): a function of
    values (v, k) and known (v,). None: they are copied."""
    check_output_folder(arguments.output)
    with report.timed("read"):
        file = open_cifti(content)
        if file.rows == "dlabel":
            raise FileError(f"{content.path}: labels, which have no mean; allowed: real values")
        check_output_name(arguments.output, "cifti", file.rows)
        data = Data(content.path, "cifti", file.names, [], usual=range(len(file.names)))
        columns = inputs.choose_columns(data, arguments.column)
        surfaces = inputs.read_surfaces(arguments)
        places = _places(arguments, file, data, surfaces, on_surface, among_voxels)
        region = _read_region(arguments, arguments.roi, file, places, surfaces)
        missing = None
        if arguments.missing is not None:
            missing = _read_region(arguments, arguments.missing, file, places, surfaces)[0]
    rows = report.facts.setdefault("columns", [])
    total, done = len(columns) * region.shape[1], 0
    with report.progress(title) as progress, file.writing(arguments.output, columns) as write:
        for place in places:
            panel = max(1, PANEL // place.count)
            for first in range(0, len(columns), panel):
                chosen = columns[first:first + panel]
                with report.timed("read"):
                    values = file.read(chosen, place.slices)
                if place.solve is not None:
                    if missing is not None:
                        values = np.where(missing[place.of_file], np.nan, values)
                    inside = (region if len(region) == 1 else region[chosen])[:, place.of_file]
                    with report.timed("compute"):
                        values, found = _smooth_place(place, file, data, chosen, values, inside,
                                                      _fixes_zeros(arguments, place), report)
                        rows += found
                with report.timed("write"):
                    write(first, place.slices, values)
                done += len(chosen) * place.count
                if progress is not None:
                    progress(done / total)
    report.facts.update(data=content.path, output=arguments.output, voxels=sum(
        place.count for place in places if place.is_volume and place.solve is not None))
    return columns


def require_cifti(content):
    """The content of a file."""
    if content.kind != "cifti":
        raise content.error(f"a {content.name} file; allowed: CIFTI (.dscalar.nii, .dtseries.nii)")
    return content


def _fixes_zeros(arguments, place):
    """Whether zeros are missing; with the words of Workbench, on surfaces or among voxels."""
    return arguments.fix_zeros or (
        arguments.fix_zeros_volume if place.is_volume else arguments.fix_zeros_surface)


@dataclass
class _Place:
    """A structure and what smooths it.

    name     "CortexLeft"
    slices   the columns of the matrix of the file
    part     its vertices, for messages; of voxels their numbers in the file
    solve    solve(values (v, k), known (v,), inside (v,)), of the rows that are inside; None: copied
    areas    areas(inside): (v,) the sizes of the control cells, or the volumes of voxels
    """

    name: str
    slices: list[slice]
    part: Part
    solve: Any = None
    areas: Any = None
    is_volume: bool = False
    warned: bool = False

    @property
    def of_file(self):
        return np.concatenate([np.arange(place.start, place.stop) for place in self.slices])

    @property
    def count(self):
        return sum(place.stop - place.start for place in self.slices)


def _places(arguments, file, data, surfaces, on_surface, among_voxels):
    """The structures to be changed."""
    places, voxels = [], []
    known = [entry.name for entry in file.structures if entry.vertices is not None]
    data.parts = [Part(np.empty((0, 0)), structure=name) for name in known]
    areas = read_areas(arguments.areas, surfaces)
    for entry in file.structures:
        if entry.vertices is None:
            voxels.append(entry)
            continue
        part = Part(np.empty((len(entry.vertices), 1), bool), entry.vertices, entry.size, entry.name)
        surface = inputs.surface_for(part, surfaces, data)
        inputs.on_surface(part, part.values, surface, data)  # checks the numbers
        places.append(_surface_place(entry, part, surface, areas.get(id(surface)), on_surface, arguments))
    if arguments.surface_only:
        among_voxels = None
    groups = [voxels] if arguments.merged_volume and voxels else [[entry] for entry in voxels]
    return places + [_volume_place(group, among_voxels) for group in groups]


def _surface_place(entry, part, surface, areas, on_surface, arguments):
    solver = inputs.make_solver(arguments, surface, areas)

    def solve(values, known, inside):
        full = np.zeros((solver.n_points, values.shape[1]), dtype=values.dtype)
        excluded = np.ones(solver.n_points, dtype=bool)
        full[entry.vertices] = np.where(known[:, None], values, np.nan)
        full[entry.vertices[~inside]] = 0
        excluded[entry.vertices[inside]] = False
        mask = excluded if excluded.any() else None
        return on_surface(solver, full, mask)[entry.vertices]

    def measure(inside):
        excluded = np.ones(solver.n_points, dtype=bool)
        excluded[entry.vertices[inside]] = False
        return vertex_areas(surface, excluded, areas)[entry.vertices]

    return _Place(entry.name, [entry.place], part, solve if on_surface else None, measure)


def _volume_place(entries, among_voxels):
    """Voxels that are changed together, or copied."""
    name = entries[0].name if len(entries) == 1 else "Volume"
    slices = [entry.place for entry in entries]
    place = _Place(name, slices, Part(np.empty((0, 0)), structure=name), is_volume=True)
    place.part.vertices = place.of_file
    if among_voxels:
        affine = entries[0].affine
        smoother = among_voxels(np.concatenate([entry.voxels for entry in entries]), affine)
        volume = abs(np.linalg.det(affine[:3, :3]))
        place.solve = lambda values, known, inside: smoother(values, known & inside)
        place.areas = lambda inside: inside * volume
    return place


def _smooth_place(place, file, data, columns, values, inside, fix_zeros, report):
    """Smooths `values` (k, v), those of a structure. inside: (k, v), or (1, v) for
    all. The new values, 0 outside, and the totals of each column."""
    given = values.T
    inputs.require_finite(given, data, place.part, columns)
    known = ~np.isnan(given)
    if fix_zeros:
        known &= given != 0
    new = np.zeros_like(given)
    entries = [None] * len(columns)
    groups = {}
    for i in range(len(columns)):
        marks = inside[i if len(inside) > 1 else 0]
        groups.setdefault((np.packbits(marks).tobytes(), np.packbits(known[:, i] | ~marks).tobytes()),
                          []).append(i)
    for group in groups.values():
        marks = inside[group[0] if len(inside) > 1 else 0]
        some = known[:, group[0]] & marks
        if some.any():
            found = place.solve(given[:, group], known[:, group[0]], marks)
            new[:, group] = np.where(np.isnan(found), given[:, group], found)
        elif marks.any():  # nothing to smooth
            new[:, group] = given[:, group]
            if not place.warned:
                place.warned = True
                report.warn(f"{data.path}: column {columns[group[0]] + 1} has no known value in "
                            f"{place.name}, which is unchanged")
        new[np.ix_(~marks, group)] = 0
        sizes = place.areas(marks)
        for i in group:
            before = np.where(known[:, i] & marks, given[:, i], 0).astype(float)
            entries[i] = {
                "column": columns[i] + 1, "name": file.names[columns[i]], "structure": place.name,
                "missing": int((~known[:, i] & marks).sum()), "excluded": int((~marks).sum()),
                "total_before": number(sizes @ before),
                "total_after": number(sizes @ np.nan_to_num(new[:, i].astype(float)))}
    return new.T, entries


def _read_region(arguments, named, file, places, surfaces):
    """Flags of a region: (1, v), or (columns of the file, v) if each has its own."""
    count = file.structures[-1].place.stop
    if named is None:
        return np.ones((1, count), dtype=bool)
    path, label = inputs.split_label(named)
    content = read_content(path)
    if content.kind != "cifti" or arguments.surface is not None:
        return _region_of_one_surface(arguments, named, file, places, surfaces, count)
    region = open_cifti(content)
    if arguments.match_columns:
        inputs.require_same_number(path, region.names, file.content.path, file.names)
    rows = list(range(len(region.names))) if arguments.match_columns else [0]
    atlas = Data(path, "cifti", region.names, [], labels=region.rows == "dlabel",
                 label_names=region.label_names)
    wanted = None if label is None else inputs.find_label(atlas, label)
    needed = np.concatenate([place.of_file for place in places if place.solve is not None])
    found = np.zeros((len(rows), count), dtype=bool)
    for i, row in enumerate(rows):
        values = region.read([row], [slice(0, region.structures[-1].place.stop)])[0]
        with np.errstate(invalid="ignore"):
            marks = values == wanted if wanted is not None else values > 0
        for entry in file.structures:
            if np.isin(needed, np.arange(entry.place.start, entry.place.stop)).any():
                found[i, entry.place] = _marks_of(entry, region, marks, path)
        if not found[i, needed].any():
            raise FileError(f"{path}: column {row + 1} has no vertex and no voxel in the region; allowed: "
                            "at least one")
    return found


def _region_of_one_surface(arguments, path, file, places, surfaces, count):
    """Flags (1, v) from a file of another format, or of one hemisphere."""
    if arguments.match_columns:
        raise ArgumentProblem("--match-columns with SURFACE for a CIFTI file; allowed: --left and --right")
    marks = dict(inputs.read_marks(path, surfaces))
    found = np.zeros((1, count), dtype=bool)
    for place in places:
        if place.is_volume and place.solve is not None:
            raise FileError(f"{path}: nothing for {place.name}; allowed: a CIFTI file, or "
                            "--surface-only")
        if not place.is_volume:
            found[0, place.of_file] = marks[id(surfaces[""])][place.part.vertices]
    if not found.any():
        raise FileError(f"{path}: no vertex of {surfaces[''].path} is in the region; allowed: at "
                        "least one")
    return found


def _marks_of(entry, region, marks, path):
    """The flags of the vertices or voxels of a structure, from those of another file."""
    for other in region.structures:
        if other.name != entry.name or (other.vertices is None) != (entry.vertices is None):
            continue
        if entry.vertices is None:
            if entry.voxels.shape != other.voxels.shape or (entry.voxels != other.voxels).any():
                raise FileError(f"{path}: other voxels of {entry.name}; allowed: those of the data")
            return marks[other.place]
        full = np.zeros(max(entry.size, other.size), dtype=bool)
        full[other.vertices] = marks[other.place]
        return full[entry.vertices]
    raise FileError(f"{path}: nothing for {entry.name}; allowed: a region in each structure")
