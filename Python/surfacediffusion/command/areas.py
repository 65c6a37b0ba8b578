# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The areas of vertices and faces: those of the triangles, or given ones."""
from __future__ import annotations

import numpy as np

from ..files import FileError, SurfaceFile, read_data, read_surface
from ..files.cifti import word_of_structure
from ..files.content import read_content
from .inputs import ArgumentProblem, on_surface, surface_for
from .surfaces import lengths_of


def read_areas(paths, surfaces):
    """{id of the surface: areas of its vertices} from the first columns; empty without a file. paths: with the
    structure before a NUL, if it is given."""
    found = {}
    for word in paths:
        structure, _, path = word.rpartition("\0")
        for number, areas in _read_areas(path, structure, surfaces):
            if number in found:
                raise ArgumentProblem(f"--areas {path}: areas of a surface that has some; allowed: one file for each")
            found[number] = areas
    missing = [structure for structure, surface in surfaces.items() if found and id(surface) not in found]
    if missing:
        raise ArgumentProblem("--areas for some surfaces; allowed: for none or all: add " + " ".join(
            f"--areas {word_of_structure(structure)} FILE" for structure in missing))
    return found


def _read_areas(path, structure, surfaces):
    data = read_data(path)
    if structure and len(data.parts) == 1:
        data.parts[0].structure = structure
    for part in data.parts:
        if "" in surfaces:
            surface = surface_for(part, surfaces, data)
        elif part.structure in surfaces:
            surface = surfaces[part.structure]
        elif data.kind == "cifti":
            continue
        else:
            raise FileError(f"{data.path}: areas of {part.structure or 'no structure'}; allowed: of "
                            f"{', '.join(surfaces)}, by --areas STRUCTURE FILE")
        areas, absent = on_surface(part, part.values[:, :1].astype(float), surface, data)
        areas = np.where(absent, vertex_areas(surface), areas[:, 0])
        wrong = ~(np.isfinite(areas) & (areas > 0))
        if wrong.any():
            vertex = int(np.argmax(wrong))
            raise FileError(f"{data.path}: the area of vertex {vertex} is {areas[vertex]:g}; allowed: "
                            "finite numbers above 0")
        yield id(surface), areas


def read_areas_or_surface(path, sphere: SurfaceFile):
    """The areas of the vertices of a sphere: those of the surface in the file, or its first column; None
    without a file."""
    if path is None:
        return None
    content = read_content(path)
    try:
        surface = lengths_of(read_surface(content))
    except FileError as error:
        if "no surface" not in str(error):
            raise
        return dict(_read_areas(content, "", {"": sphere}))[id(sphere)]
    if len(surface.points) != len(sphere.points):
        raise FileError(f"{path}: {len(surface.points)} points, but {sphere.path} has {len(sphere.points)}; "
                        "allowed: the surface of the same vertices, or their areas")
    return vertex_areas(surface)


def vertex_areas(surface: SurfaceFile, excluded=None, given=None):
    """The areas of the barycentric control cells (n,): a third of those of the triangles. Triangles
    with an excluded corner take no part. given: the areas of whole cells in place of the true ones."""
    solver = surface.solver
    areas = solver._triangle_areas(excluded)
    if given is not None:
        whole = solver._triangle_areas()
        areas = np.divide(areas * given, whole, out=areas, where=whole > 0)
    return areas


def face_areas(surface: SurfaceFile):
    """The areas of the faces (m,)."""
    solver = surface.solver
    return np.bincount(solver._core.faces(), solver._areas_of_triangles(), minlength=len(surface.faces))
