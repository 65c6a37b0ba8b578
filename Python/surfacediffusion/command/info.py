# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What files hold: info."""
from __future__ import annotations

import numpy as np

from .._refinement import mean_edge_length
from ..files import FileError, read_data, read_surface
from ..files.content import read_content
from .report import number, number_text


def add_info(commands):
    parser = commands.add(
        "info", info, "Describe files: kind, counts, columns, values.", ["lh.pial lh.thickness"], "")
    parser.add_argument("files", metavar="FILE", nargs="+", help="surfaces and data")


def info(arguments, report):
    entries = report.facts.setdefault("files", [])
    for path in arguments.files:
        try:
            entry = _describe(path, report)
        except FileError as problem:  # the others are described
            report.refuse(problem)
            continue
        entries.append(entry)
        report.say(_info_line(entry))


def _describe(path, report):
    entry = {"file": path}
    surface_problem = data_problem = None
    content = read_content(path)
    try:
        entry.update(_surface_info(read_surface(content)))
    except FileError as error:
        surface_problem = error
    try:
        entry.update(_data_info(read_data(content)))
    except FileError as error:
        data_problem = error
    if surface_problem and data_problem:
        raise surface_problem if "has no surface" not in str(surface_problem) else data_problem
    if surface_problem and "no surface" not in str(surface_problem):
        report.warn(str(surface_problem))
    return entry


def _surface_info(surface):
    with np.errstate(over="ignore", invalid="ignore"):  # numbers that no double holds are unknown
        return _measure(surface)


def _measure(surface):
    solver = surface.solver
    return {"format": surface.kind, "points": solver.n_points, "faces": solver.n_faces,
            "structure": surface.structure, "area": number(solver.area),
            "mean_edge_length": number(mean_edge_length([solver._core]))}


def _data_info(data):
    columns = []
    for i, name in enumerate(data.names):
        values = np.concatenate([part.values[:, i] for part in data.parts]).astype(float)
        known = values[np.isfinite(values)]
        columns.append({
            "name": name, "values": len(values), "missing": int(np.isnan(values).sum()),
            "zeros": int((values == 0).sum()),
            "minimum": number(known.min()) if len(known) else None,
            "mean": number(known.mean()) if len(known) else None,
            "maximum": number(known.max()) if len(known) else None})
    return {"format": data.kind, "columns": columns,
            "structures": [part.structure for part in data.parts if part.structure]}


def _info_line(entry):
    words = [f"{entry['file']}: {entry['format']}"]
    if "points" in entry:
        words.append(f"{entry['points']} points, {entry['faces']} faces, "
                     f"area {number_text(entry['area'], 6)}, "
                     f"mean edge {number_text(entry['mean_edge_length'])}")
    lines = [", ".join(words)]
    columns = entry.get("columns", [])
    for i, column in enumerate(columns[:8], start=1):
        lines.append(f"  {i} {column['name']}: {column['values']} values, "
                     f"{column['missing']} missing, {column['zeros']} zeros, "
                     f"{number_text(column['minimum'])} to {number_text(column['maximum'])}, "
                     f"mean {number_text(column['mean'])}")
    if len(columns) > 8:
        lines.append(f"  ... {len(columns)} columns")
    return "\n".join(lines)


