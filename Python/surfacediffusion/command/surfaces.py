# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of brains: whether data are of the same hemisphere, and lengths on them millimetres of the brain."""
from __future__ import annotations

import re
import warnings

import numpy as np

from ..files import FileError, SurfaceFile, read_surface
from ..files.surface import structure_of_name

#: The radii of FreeSurfer's and Workbench's spheres of registration
_SPHERES = (95, 105)
#: The lengths of the longest side of the box about a cortex in millimetres
_CORTEX = (20, 500)


def open_surface(arguments, path, lengths=True, weld=True) -> SurfaceFile:
    """The surface of a file. lengths: whether the result depends on lengths on it. weld: see read_surface()."""
    surface = read_surface(path, weld)
    surface.any_hemisphere = arguments.any_hemisphere
    return lengths_of(surface) if lengths else surface


def lengths_of(surface: SurfaceFile):
    """The surface, with a warning if lengths on it are none of the brain."""
    what = _other_lengths(surface)
    if what:
        warnings.warn(f"{surface.path} is {what}: lengths and areas on it are not "
                      "those of the brain; give an anatomical surface, such as white, midthickness or pial",
                      stacklevel=2)
    return surface


def _other_lengths(surface):
    """What the surface is, if it is no anatomical one in millimetres; otherwise empty."""
    shape = surface.geometry
    if shape in ("spherical", "flat", "inflated", "very_inflated", "ellipsoid"):
        return shape.replace("_", " ")
    if surface.kind not in ("gifti", "freesurfer"):
        return ""
    if not shape:
        radii = np.linalg.norm(surface.points - surface.points.mean(axis=0), axis=1)
        if _SPHERES[0] <= radii.mean() <= _SPHERES[1] and np.ptp(radii) <= 1e-3 * radii.mean():
            return f"a sphere of radius {radii.mean():.4g}"
    longest = np.ptp(surface.points, axis=0).max()
    if surface.structure.startswith("Cortex") and not _CORTEX[0] <= longest <= _CORTEX[1]:
        return f"{longest:.3g} long, and a cortex in mm {_CORTEX[0]} to {_CORTEX[1]}"
    return ""


def _hemisphere(structure, path):
    """"Left" or "Right", of a structure, or of the name of a file if that is not known, as FreeSurfer, HCP and BIDS
    name files; empty if neither says it."""
    if structure:
        return next((side for side in ("Left", "Right") if structure.endswith(side)), "")
    if structure_of_name(path):
        return structure_of_name(path)[len("Cortex"):]
    name = re.split(r"[/\\]", path)[-1]
    found = set(re.findall(r"(?<=[._])(?:hemi-)?([LR])(?=[._])", f".{name}"))
    return {"L": "Left", "R": "Right"}[found.pop()] if len(found) == 1 else ""


def require_same_hemisphere(surface: SurfaceFile, structure, name, what, path=""):
    """FileError if the surface is of another hemisphere than the structure, or else the path; what neither the files
    nor their names say is taken to be right. name, what: the begin of the error, as "lh.thickness: data of"."""
    mine = _hemisphere(structure, path)
    other = _hemisphere(surface.structure, surface.path)
    if mine and other and mine != other and not surface.any_hemisphere:
        said = [known or f"the {side.lower()} hemisphere by its name"
                for known, side in ((structure, mine), (surface.structure, other))]
        raise FileError(f"{name}: {what} {said[0]}, but {surface.path} is of {said[1]}; allowed: the same hemisphere, "
                        "or any with --any-hemisphere")


def require_same_structure(surface: SurfaceFile, structure, name, what, path=""):
    """The same, and FileError if the surface is of another structure."""
    require_same_hemisphere(surface, structure, name, what, path)
    same, other = (re.sub("(Left|Right)$", "", word) for word in (structure, surface.structure))
    if same and other and same != other:
        raise FileError(f"{name}: {what} {structure}, but {surface.path} is of {surface.structure}; allowed: the same "
                        "structure")
