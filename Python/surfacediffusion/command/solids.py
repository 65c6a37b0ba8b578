# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Parts as they come and as they are written: welded facets, objects, and what a slicer will find."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .. import Surface, _core, bodies, weld
from ..files.threemf import Objects
from .report import counted


@dataclass
class Part:
    """A surface with one point per place. faces: (m,), the face of the file that each triangle lies in."""

    surface: Surface
    faces: np.ndarray
    objects: Objects | None  # of the file, if it is 3MF


def weld_part(given, tolerance, unit, report):
    """The part of a SurfaceFile, oriented outwards: the facets of each of its objects are joined. tolerance: None
    for the default."""
    objects = given.image if given.kind == "3mf" else None
    surface = given.solver
    groups = [np.arange(surface.n_faces)] if objects is None else [
        np.flatnonzero(objects.of_face == i) for i in range(len(objects.names))]
    found, shift, points, triangles, faces = [], 0, [], [], []
    for group in groups:
        if not len(group):
            continue
        welded = weld(surface if objects is None else _part_of(surface, group), tolerance)
        found.append(welded)
        points.append(welded.surface.points)
        triangles.append(welded.surface.triangles + shift)
        faces.append(group[welded.faces])
        shift += len(points[-1])
    counts = {name: sum(getattr(one, name) for one in found) for name in ("welded", "split", "duplicates", "flat")}
    report.facts.update({name: counts[name] for name in ("welded", "split", "duplicates")}, zero_area=counts["flat"])
    apart = max(one.apart for one in found)
    said = [text for name, text in (
        ("welded", f"{counted(counts['welded'], 'corner')} of facets up to {apart:.2g} {unit} apart, at open edges, "
                   "are welded"),
        ("split", f"{counted(counts['split'], 'edge')} split at a vertex that is on them (T-junctions)"),
        ("duplicates", f"{counted(counts['duplicates'], 'triangle')} left out, since others have the same corners"),
        ("flat", f"{counted(counts['flat'], 'triangle')} of no area left out")) if counts[name]]
    if said:
        report.warn(f"{given.path}: {', '.join(said)}; --weld sets the tolerance, and --weld 0 turns it off")
    united = Surface(np.concatenate(points), np.concatenate(triangles))
    united = Surface(united.points, _core.turn_outwards(united._core))
    return Part(united, np.concatenate(faces), objects)


def _part_of(surface, faces):
    used, corners = np.unique(surface.triangles[faces], return_inverse=True)
    return surface.points[used], corners.reshape(-1, 3)


def as_in_stl(points, triangles):
    """The points with the precision of STL, and the triangles that have three of them."""
    points = points.astype(np.float32).astype(float)
    _, place = np.unique(points, axis=0, return_inverse=True)
    corners = place.reshape(-1)[triangles]
    return points, triangles[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]


def describe(kind, points, triangles, report):
    """What the file of a part is, as slicers see it: facts of the report, words, and the bodies."""
    if kind == "stl":  # which has places in place of vertices
        points, numbers = np.unique(points, axis=0, return_inverse=True)
        triangles = numbers.reshape(-1)[triangles]
    found = bodies(Surface(points, triangles))
    report.facts.update(
        closed=found.open_edges == 0, open_edges=found.open_edges,
        manifold=found.non_manifold_edges == 0, non_manifold_edges=found.non_manifold_edges,
        oriented=found.misoriented_edges == 0, misoriented_edges=found.misoriented_edges,
        overlaps=found.overlaps, bodies=[vars(body) for body in found.table])
    words = ["closed" if found.open_edges == 0 else counted(found.open_edges, "open edge"),
             "manifold" if found.non_manifold_edges == 0
             else f"{counted(found.non_manifold_edges, 'edge')} of more than two triangles",
             "oriented" if found.misoriented_edges == 0
             else f"{counted(found.misoriented_edges, 'edge')} of triangles that face opposite sides"]
    if len(found.table) > 1:
        words.append(f"{len(found.table)} bodies")
    if found.overlaps:
        words.append(f"{counted(found.overlaps, 'pair')} of them overlapping")
    return words, found


def objects_of(part, unit, faces, found, stem):
    """Objects of a 3MF file, one per body: with the names of the file, or that of its path. faces: of the file, per
    triangle."""
    of_face = np.maximum(found.of_triangle, 0)
    given = [stem] * len(found.table)
    colors = None
    if part.objects is not None:
        first = np.unique(of_face, return_index=True)[1]
        given = [part.objects.names[part.objects.of_face[faces[t]]] or stem for t in first]
        colors = with_faces(part.objects, faces).colors
    names = [name if given.count(name) == 1 else f"{name} {given[:i].count(name) + 1}" for i, name in enumerate(given)]
    return Objects(unit, names, of_face, colors)


def with_faces(objects, faces):
    """The objects of a file after its faces were divided. faces: of each triangle."""
    mean = None if objects.colors is None else np.repeat(
        np.rint(objects.colors.mean(axis=1)).astype(np.uint8)[faces][:, None], 3, axis=1)
    return replace(objects, of_face=objects.of_face[faces], colors=mean)
