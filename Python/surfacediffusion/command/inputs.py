# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The surfaces, regions and columns that a command line names, checked against each other."""
from __future__ import annotations

import os
import re
from dataclasses import dataclass

import numpy as np

from .._surface import Surface
from ..files import Data, FileError, Part, SurfaceFile, read_data
from ..files.cifti import structure_of_word, word_of_structure
from ..files.data import NO_VERTICES
from .surfaces import open_surface, require_same_hemisphere, require_same_structure
from .tables import read_table


#: The options that name the surface of a structure
SIDES = {"left": "CortexLeft", "right": "CortexRight", "cerebellum": "Cerebellum"}


#: Where data are written, they are written with their surface, or not at all
_MESHES = (".ply", ".vtk", ".vtp", ".vtu", ".off", ".obj", ".asc", ".stl")


class ArgumentProblem(ValueError):
    """Arguments that contradict each other or the files; one line that names them."""


@dataclass
class Patch:
    """The values of one part of the data on its surface, one row per vertex of the surface, or per face
    if the data are at faces.

    values   (n, k) float, NaN is missing; 0 where excluded
    excluded (n,) bool: outside the region, or without data in the file; (n, k) if each column has a
             region of its own
    """

    surface: SurfaceFile
    part: Part
    values: np.ndarray
    excluded: np.ndarray

    def excluded_of(self, column):
        """(n,) bool, of this one of the k columns."""
        return self.excluded if self.excluded.ndim == 1 else self.excluded[:, column]

    def to_part(self, values):
        """The rows of the part. Outside the region the values become 0."""
        _clear(values, self.excluded)
        return values if self.part.vertices is None else values[self.part.vertices]


#: The arguments that name what a command writes, and what it reads beside DATA
_OUTPUTS = {"output": "OUTPUT", "map": "--map", "curves": "--curves", "nearest": "--nearest", "error": "--error",
            "valid": "-valid-roi-out", "vectors": "-vectors", "mean": "-mean", "gauss": "-gauss"}
_INPUTS = ("surface", *SIDES, "roi", "areas", "missing", "data_roi", "residuals", "fixed", "speed", "sources", "values",
           "source", "target", "source_areas", "target_areas")


def check_files(arguments):
    """ArgumentProblem if an output would replace another one, or a file that is read. DATA may be replaced by
    the result, and a surface by one that has its points or its data."""
    outputs = [(word, getattr(arguments, name, None)) for name, word in _OUTPUTS.items()]
    if arguments.command == "refine":
        outputs += [("NEW", new) for _, new in arguments.data]
    seen = {}
    for word, path in outputs:
        if path is None:
            continue
        same = os.path.realpath(path)
        if same in seen:
            raise ArgumentProblem(f"{path} is {seen[same]} and {word}; allowed: different files")
        seen[same] = word
        for name in _INPUTS:
            others = getattr(arguments, name, None)
            others = others if isinstance(others, list) else [others]
            if not any(isinstance(other, str) and os.path.realpath(split_label(other.split("\0")[-1])[0]) == same
                       for other in others):
                continue
            is_mesh = path.lower().endswith(_MESHES) or arguments.command == "denoise-mesh" or getattr(
                arguments, "move", False)
            if name != "surface" or not is_mesh:
                raise ArgumentProblem(f"{path}, which is read, would be replaced by {word}; allowed: another file")


def refuse(arguments, options, where, allowed):
    """ArgumentProblem if one of the options is given where it has no effect."""
    for option in options:
        if getattr(arguments, option.strip("-").replace("-", "_"), None) not in (None, False):
            raise ArgumentProblem(f"{option} {where}; allowed: {allowed}")


def read_surfaces(arguments):
    """{structure: surface}; the structure is "" for SURFACE, which takes any data. They are read once for
    many files."""
    if not hasattr(arguments, "surfaces"):
        arguments.surfaces = _read_surfaces(arguments)
    return arguments.surfaces


def make_solver(arguments, surface: SurfaceFile, areas):
    """The surface for functions of the package, with the areas that were given for it or None. It is made
    once for many files, and keeps its factors."""
    solvers = vars(arguments).setdefault("solvers", {})
    try:
        if areas is None:
            return surface.solver
        if id(surface) not in solvers:
            solvers[id(surface)] = Surface(surface.points, surface.faces, areas)
    except ValueError as error:
        raise FileError(f"{surface.path}: {error}") from error
    return solvers[id(surface)]


def _read_surfaces(arguments):
    if arguments.surface is not None:
        return {"": open_surface(arguments, arguments.surface)}
    surfaces = {}
    for side, structure in SIDES.items():
        path = getattr(arguments, side)
        if path is not None:
            surfaces[structure] = open_surface(arguments, path)
            require_same_structure(surfaces[structure], structure, f"--{side}", "for")
    for word, path in arguments.structures:
        structure = structure_of_word(word)
        if structure in surfaces:
            raise ArgumentProblem(f"--surface {word} and another surface of {structure}; allowed: one of them")
        surfaces[structure] = open_surface(arguments, path)
        require_same_hemisphere(surfaces[structure], structure, f"--surface {word}", "for")
    return surfaces


def to_surface(arguments, surface, places, report):
    """Points in the coordinates of the surface; they are given in those of --ras."""
    if arguments.ras == "tkr":
        return places
    matrix = surface.to_scanner
    if matrix is None:
        raise ArgumentProblem(
            f"--ras scanner with {surface.path}, which has no c_ras; allowed: surfaces of FreeSurfer, or of GIFTI with "
            "VolGeomC_R, VolGeomC_A and VolGeomC_S or a transform to NIFTI_XFORM_SCANNER_ANAT")
    report.facts.update(ras="scanner", to_scanner=matrix.tolist())
    if surface.center.any():
        report.facts.update(c_ras=[float(x) for x in surface.center])
    return (np.asarray(places, dtype=float) - matrix[:3, 3]) @ np.linalg.inv(matrix[:3, :3]).T


def read_values(path, surface, tables=True):
    """The values of a file or its Content: places (p, 3) or None, values (p, k) or (n, k), NaN where the file
    has none, and the names of the columns. tables: whether places with values are allowed; otherwise they are
    at the vertices."""
    table = read_table(path) if tables else None
    if table is not None:
        rows, names = table
        return rows[:, :3], rows[:, 3:], names
    data = read_data(path)
    columns = list(data.usual)
    if len(data.parts) > 1:
        raise FileError(f"{data.path}: data of {len(data.parts)} surfaces; allowed: of one")
    part = data.parts[0]
    surface_for(part, {"": surface}, data)
    values, absent = on_surface(part, part.values[:, columns].astype(float), surface, data)
    values[absent] = np.nan
    return None, values, [data.names[c] for c in columns]


def choose_columns(data: Data, choices):
    """The numbers of the chosen columns, in the order of the file."""
    if not choices:
        return list(data.usual)
    chosen = set()
    for choice in choices:
        named = [i for i, name in enumerate(data.names) if name == choice]
        if not named and choice.isdigit() and 1 <= int(choice) <= len(data.names):
            named = [int(choice) - 1]
        if not named:
            raise ArgumentProblem(f"--column is {choice!r}; {data.path} has columns "
                                  f"{_range_text(data.names)}")
        chosen.update(named)
    return sorted(chosen)


def _range_text(names):
    numbers = "1" if len(names) == 1 else f"1 to {len(names)}"
    shown = list(dict.fromkeys(name for name in names if name and not name.isdigit()))
    more = ", ..." if len(shown) > 6 else ""
    return numbers + (f" ({', '.join(shown[:6])}{more})" if shown else "")


def make_patches(surfaces, data: Data, columns, arguments, labels=False):
    """The values on each surface, with what is missing and what is excluded. labels: whether numbers of
    labels are allowed."""
    if data.labels and not labels:
        raise FileError(f"{data.path}: labels, which have no mean; allowed: real values")
    regions = {}
    if arguments.roi is not None:
        own = data if arguments.match_columns else None
        regions = dict(_regions(arguments, surfaces, data.on_faces, own, columns))
    patches = []
    for part in data.parts:
        surface = surface_for(part, surfaces, data)
        every = list(columns) == list(range(part.values.shape[1]))
        # The memory of the file's values, since time series fill it.
        values = np.require(part.values if every else part.values[:, columns], _float_type(part.values), "W")
        require_finite(values, data, part, columns)
        if arguments.fix_zeros:
            values[values == 0] = np.nan
        values, excluded = on_surface(part, values, surface, data)
        if arguments.roi is not None:
            excluded = (excluded | ~regions[id(surface)].T).T
        if excluded.all(axis=0).any():
            what = "face" if data.on_faces else "vertex"
            raise FileError(f"{arguments.roi or data.path}: no {what} of {surface.path} is in the "
                            "region; allowed: at least one")
        _clear(values, excluded)
        patches.append(Patch(surface, part, values, excluded))
    return patches


def _clear(values, excluded):
    """Zero where excluded: (n,), or (n, k)."""
    values[excluded if excluded.ndim == 1 else np.broadcast_to(excluded, values.shape)] = 0


def read_marks(path, surfaces, on_faces=False, columns=None):
    """For each surface, a bool per vertex or face: whether the first column is above 0, or has the
    label that is named after a colon, as in lh.aparc.annot:precentral. columns: the numbers of others;
    each then has a column of bools."""
    path, label = split_label(path)
    data = read_data(path, on_faces)
    if data.kind == "annot" and label is None:
        raise FileError(f"{path}: an atlas without a label; allowed: {path}:LABEL with "
                        f"{_labels_text(data)}")
    number = None if label is None else find_label(data, label)
    chosen = [0] if columns is None else columns
    for part in data.parts:
        surface = surface_for(part, surfaces, data)
        if data.kind == "label":
            inside = np.ones((len(part.values), 1), dtype=bool)
        elif number is not None:
            inside = part.values[:, chosen] == number
        else:
            with np.errstate(invalid="ignore"):
                inside = part.values[:, chosen] > 0
        marks, _ = on_surface(part, inside, surface, data)
        yield id(surface), marks[:, 0].astype(bool) if columns is None else marks.astype(bool)


def split_label(path):
    """The file and the label of FILE:LABEL; None if no label is named. Both may have colons."""
    if not os.path.exists(path):
        for colon in re.finditer(":", path):
            if os.path.exists(path[:colon.start()]):
                return path[:colon.start()], path[colon.end():]
    return path, None


def find_label(data, label):
    """The number of a label that is given by its name or number."""
    if not data.labels:
        raise FileError(f"{data.path}: values, which have no label {label!r}; allowed: an atlas (.annot, "
                        ".label.gii, .dlabel.nii)")
    for number, name in data.label_names.items():
        if label == name:
            return number
    if re.fullmatch(r"-?\d+", label) and int(label) in data.label_names:
        return int(label)
    raise FileError(f"{data.path}: no label {label!r}; allowed: {_labels_text(data)}")


def _labels_text(data):
    shown = [f"{number} {name}" for number, name in data.label_names.items()]
    return ", ".join(shown[:40]) + (", ..." if len(shown) > 40 else "")


def _regions(arguments, surfaces, on_faces, own, columns):
    """{id of the surface: its flags}. own: data of which each column has its own region."""
    if own is not None:
        of_region = read_data(split_label(arguments.roi)[0], on_faces)
        require_same_number(arguments.roi, of_region.names, own.path, own.names)
    found = dict(read_marks(arguments.roi, surfaces, on_faces, columns if own is not None else None))
    for surface in surfaces.values():
        if id(surface) not in found:
            raise FileError(f"{arguments.roi}: nothing for {surface.path}; allowed: a region on "
                            "each surface")
    return found


def require_same_number(path, names, path_of_data, names_of_data):
    """Each column of the data has a region of its own."""
    if len(names) != len(names_of_data):
        raise ArgumentProblem(f"{path} has {len(names)} columns, but {path_of_data} has "
                              f"{len(names_of_data)}; allowed with --match-columns: the same number")


def surface_for(part, surfaces, data):
    if "" not in surfaces:
        if data.kind != "cifti":
            raise ArgumentProblem(f"--left and --right are for CIFTI files; {data.path} is of one surface; "
                                  "allowed: a CIFTI file, or all files of one SURFACE")
        missing = [other.structure for other in data.parts if other.structure not in surfaces]
        if part.structure not in surfaces:
            raise ArgumentProblem(f"{data.path} has data of {' and '.join(missing)}; add "
                                  + " ".join(map(_option_of, missing)))
        return surfaces[part.structure]
    surface = surfaces[""]
    if len(data.parts) > 1:
        structures = " and ".join(p.structure for p in data.parts)
        raise ArgumentProblem(f"{data.path} has data of {structures}; give --left and --right "
                              "instead of SURFACE")
    require_same_structure(surface, part.structure, data.path, "data of", data.path)
    return surface


def _option_of(structure):
    """The option by which the surface of a structure is given."""
    sides = [f"--{side} FILE" for side, name in SIDES.items() if name == structure]
    return sides[0] if sides else f"--surface {word_of_structure(structure)} FILE"


def on_surface(part, values, surface, data):
    """Values (n, k) with 0 where the file has none, and a bool per vertex or face: whether it has
    none."""
    path, what = data.path, "faces" if data.on_faces else "points"
    if surface.kind == "stl" and not data.on_faces:
        raise FileError(f"{path} on {surface.path}: {NO_VERTICES}values at faces, or a surface of another format")
    count = len(surface.faces if data.on_faces else surface.points)
    if part.vertices is None or part.size is not None:
        size = len(part.values) if part.size is None else part.size
        if size != count:
            hint = "" if data.on_faces or size != len(surface.faces) else ", or --faces"
            raise FileError(f"{path}: {size} values per column, but {surface.path} has {count} "
                            f"{what}; allowed: {count} values{hint}")
    if part.vertices is None:
        return values, np.zeros(count, dtype=bool)
    if len(part.vertices) and not 0 <= part.vertices.min() <= part.vertices.max() < count:
        raise FileError(f"{path}: vertices {part.vertices.min()} to {part.vertices.max()}, but "
                        f"{surface.path} has points 0 to {count - 1}")
    full = np.zeros((count, values.shape[1]), dtype=values.dtype)
    full[part.vertices] = values
    absent = np.ones(count, dtype=bool)
    absent[part.vertices] = False
    return full, absent


def _float_type(values):
    return np.float32 if values.dtype.kind == "f" and values.dtype.itemsize <= 4 else np.float64


def require_finite(values, data, part, columns):
    bad = np.argwhere(np.isinf(values))
    if len(bad):
        row, column = bad[0]
        vertex = row if part.vertices is None else part.vertices[row]
        raise FileError(f"{data.path}: column {columns[column] + 1} is {values[row, column]} at "
                        f"vertex {vertex}; allowed: finite values, or NaN for missing")
