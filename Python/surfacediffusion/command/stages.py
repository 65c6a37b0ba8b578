# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The stages of a run that commands have in common: files are read, a function of the package is called,
the result is written, and a line says so."""
from __future__ import annotations

import io

import numpy as np

from .._run import part_of
from ..files import FileError, new_data, read_data, vtk_files, write_atomically
from ..files.content import check_output_folder, check_range, kind_of_name
from . import common, inputs
from .areas import face_areas, read_areas, vertex_areas
from .inputs import choose_columns, make_patches, read_surfaces
from .report import counted, number
from .surfaces import open_surface

#: Values that are computed together, where columns are independent
PANEL = 1 << 22

# ---- new values of the data ----------------------------------------------------------------------

def read(arguments, missing=None, content=None):
    """The data of a command line and its values on each surface. missing: a file of marks. content: of
    DATA, if it has been read."""
    surfaces = read_surfaces(arguments)
    data = read_data(content or arguments.data, arguments.faces)
    columns = choose_columns(data, arguments.column)
    patches = make_patches(surfaces, data, columns, arguments)
    if missing is not None:
        marks = dict(inputs.read_marks(missing, surfaces, data.on_faces))
        for patch in patches:
            patch.values[marks[id(patch.surface)] & ~patch.excluded] = np.nan
    return surfaces, data, columns, patches


def change_data(arguments, report, title, compute, groups, missing=None, say=None, content=None,
                labels=False):
    """Applies compute(surface, values, mask=, mask_mode=, progress=) to the groups of columns of each
    surface and writes the result in the format of DATA. say(surface): a part of the summary. missing and
    content: as of read(). labels: whether the result is numbers of labels."""
    check_output_folder(arguments.output)
    with report.timed("read"):
        surfaces, data, columns, patches = read(arguments, missing, content)
        areas = read_areas(arguments.areas, surfaces)
        target, kept = _target(data, columns, patches[0].surface, arguments.output)
    if data.extra:
        report.warn(f"{data.path}: {data.extra}")
    options = given(**common.merging(arguments))
    results = []
    total = sum(len(columns) for _ in patches)
    done = 0
    with report.progress(title) as progress:
        for patch in patches:
            surface = inputs.make_solver(arguments, patch.surface, areas.get(id(patch.surface)))
            totals = _Totals(patch, data.on_faces, areas.get(id(patch.surface)))
            new = patch.values  # each group is read before its result replaces it
            for group in groups(data, columns, patch):
                excluded = patch.excluded_of(group[0])
                mask = excluded if excluded.any() else None
                require_known(patch, group, data, columns)
                chosen = slice(None) if len(group) == len(columns) else group
                with report.timed("compute"):
                    new[:, chosen] = compute(
                        surface, patch.values[:, chosen], mask=mask, mask_mode="Exclude", **options,
                        progress=part_of(progress, done / total, len(group) / total))
                done += len(group)
            report.facts.setdefault("columns", []).extend(totals.rows(data, columns))
            results.append(patch.to_part(new))
    target.labels = labels
    with report.timed("write"):
        target.save(arguments.output, results, kept)
    report.facts.update(data=data.path, output=arguments.output)
    what = counted(len(columns), "column")
    if say is not None:
        what += ", " + say(patches[0].surface)
    report.say_written(arguments.output, what)


def _target(data, columns, surface, path):
    """What is written, and which of its columns: DATA with other values, or, since files without metadata
    have nothing else to keep, the format that the name of the output announces."""
    if data.kind in ("curv", "npy", "text") and not data.on_faces and kind_of_name(path) not in (
            None, data.kind):
        return new_data(surface, path, [data.names[c] for c in columns]), None
    data.check_name(path)
    return data, columns


def all_columns(data, columns, patch):
    """All columns are one group: the noise of all has one smoothness."""
    return [list(range(len(columns)))]


def columns_of_missing(data, columns, patch):
    """Columns whose missing values are at the same vertices are solved together."""
    missing = np.isnan(patch.values)
    if not missing.any() and patch.excluded.ndim == 1:
        return all_columns(data, columns, patch)
    groups = {}
    for i in range(len(columns)):
        key = np.packbits(missing[:, i]).tobytes(), np.packbits(patch.excluded_of(i)).tobytes()
        groups.setdefault(key, []).append(i)
    return list(groups.values())


def panels_of_missing(data, columns, patch):
    """Those groups by a few columns at a time."""
    count = max(1, PANEL // len(patch.values))
    return [group[i:i + count] for group in columns_of_missing(data, columns, patch)
            for i in range(0, len(group), count)]


def columns_of_arrays(data, columns, patch):
    """Edges are common to the channels of a colour or a vector, and to no other columns."""
    colour = {"red", "green", "blue"}
    groups = {}
    for i, column in enumerate(columns):
        name = data.names[column]
        if data.kind == "ply" and name in colour:
            key = "colour"
        else:
            key = name if data.kind in vtk_files.KINDS else i
        groups.setdefault(key, []).append(i)
    return list(groups.values())


def require_known(patch, group, data, columns):
    missing = np.isnan(patch.values[:, group]).any(axis=1)
    if (missing | patch.excluded_of(group[0])).all():
        raise FileError(f"{data.path}: column {columns[group[0]] + 1} has no known value in the "
                        "region; allowed: at least one")


class _Totals:
    """The integrals of the columns over the region before (known values alone) and after."""

    def __init__(self, patch, on_faces, areas):
        self._patch = patch
        self._missing = np.isnan(patch.values).sum(axis=0)
        every = [slice(None)] if patch.excluded.ndim == 1 else [slice(i, i + 1) for i in range(len(self._missing))]
        self._regions = []
        for region in every:
            excluded = patch.excluded_of(region.start or 0)
            sizes = (np.where(excluded, 0, face_areas(patch.surface)) if on_faces
                     else vertex_areas(patch.surface, excluded, areas))
            self._regions.append((region, sizes, int(excluded.sum())))
        self._before = self._integrals()

    def _integrals(self):
        return np.concatenate([_integrals(sizes, self._patch.values[:, region]) for region, sizes, _ in self._regions])

    def rows(self, data, columns):
        """The facts of each column, whose values are the new ones now."""
        structure = self._patch.part.structure or self._patch.surface.structure
        counts = [count for region, _, count in self._regions for _ in columns[region]]
        return [{"column": column + 1, "name": data.names[column], "structure": structure, "missing": int(missing),
                 "excluded": excluded, "total_before": number(before), "total_after": number(after)}
                for column, missing, excluded, before, after in zip(
                    columns, self._missing, counts, self._before, self._integrals())]


def _integrals(areas, values):
    """Of each column, missing values left out; in panels, since copies in double are large."""
    return np.concatenate([areas @ np.nan_to_num(values[:, i:i + 32].astype(float))
                           for i in range(0, values.shape[1], 32)])


# ---- results of one surface ----------------------------------------------------------------------

def read_surface_for_output(arguments, report, lengths=False, weld=True):
    """lengths: whether the result is in millimetres. weld: see read_surface()."""
    check_output_folder(arguments.output)
    with report.timed("read"):
        surface = open_surface(arguments, arguments.surface, lengths, weld)
    report.facts.update(surface=arguments.surface, output=arguments.output)
    return surface


def given(**options):
    """The options that have a value; for the others a function has defaults of its own."""
    return {name: value for name, value in options.items() if value}


def write_new(arguments, report, target, values):
    """Values at the vertices as new data."""
    check_range(arguments.output, target.kind, [values], "value", single=True)
    with report.timed("write"):
        target.save(arguments.output, [values.astype(np.float32)])
    report.say_written(arguments.output, counted(len(target.names), "column"))


def write_points(arguments, report, surface, result, what):
    """The surface with the points of `result`, and facts of how they moved. what: of the summary."""
    with report.timed("write"):
        normals = report.facts["normals"] = surface.save(arguments.output, result.points) or None
    # Normals of the old points would let viewers draw the old surface.
    report.say_written(arguments.output, what + (f", normals {normals}" if normals else ""))


def write_array(path, array):
    """A .npy file"""
    file = io.BytesIO()
    np.save(file, array)
    write_atomically(path, file.getvalue())


def require_array(path, what):
    if kind_of_name(path) != "npy":
        raise FileError(f"{path}: the name announces no format for {what}; allowed: .npy")
