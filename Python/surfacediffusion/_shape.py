# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Functions that make another surface: with relief."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._refinement import MAXIMUM_TRIANGLES, as_length, take_along
from ._run import Progress, ProgressReporter, warn
from ._settings import shorten
from ._surface import Surface, SurfaceLike, as_numbers, find_mask


@dataclass(frozen=True)
class ReliefResult:
    """A surface with relief.

    Attributes
    ----------
    surface : Surface
        The triangles are oriented outwards, and are those of the given surface otherwise.
    heights : ndarray, shape (n,)
        The heights that were used, in coordinate units.
    volume_change : float
        The volume after the relief minus that before; for a closed surface.
    lowered_points : int
        The points whose relief had to be lower than wanted.
    open_edges : int
        The edges of one triangle, before and after. 0: the surface is closed.
    non_manifold_edges : int
        The edges of three or more triangles.
    crossing_triangles_before, crossing_triangles : int
        The triangles that cross others, before and after the relief.
    smallest_wall : float
        The smallest distance between two opposite sides; infinite if there are none.
    warnings : list of str
        Everything that was also given as a Python warning.
    """

    surface: Surface
    heights: NDArray[np.float64] = field(repr=False)
    volume_change: float
    lowered_points: int
    open_edges: int
    non_manifold_edges: int
    crossing_triangles_before: int
    crossing_triangles: int
    smallest_wall: float
    warnings: list[str] = field(repr=False)


def relief(
    surface: SurfaceLike,
    values: ArrayLike,
    height: float,
    *,
    base: float = 0.0,
    levels: Literal["Smooth", "Two"] = "Smooth",
    threshold: float = 0.5,
    flank: float = 0.0,
    mask: ArrayLike | None = None,
    overhang: float | None = None,
    up: ArrayLike = (0.0, 0.0, 1.0),
    progress: Progress = False,
    refine_to: float = 0.0,
    maximum_number_of_triangles: int = MAXIMUM_TRIANGLES,
) -> ReliefResult:
    """Raise or carve values on a surface as relief, for printing.

    Each point moves by ``base + height * value`` along its normal, outwards from a closed surface.
    At sharp edges the direction is such that the flat faces beside them move by the heights.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface. Large triangles have no room for relief: see `refine_to`.
    values : array_like, shape (n,)
        The values at the points, usually from 0 to 1 as `texture` of :func:`turing_texture`.
    height : float
        The height of the value 1 above that of 0, in coordinate units; below 0 it is carved.
    base : float, default 0
        The height of the value 0.
    levels : {"Smooth", "Two"} or in snake_case, default "Smooth"
        "Two" is `base` where the value is below `threshold`, and ``base + height`` above.
    threshold : float, default 0.5
    flank : float, default 0
        With two levels, the width of the slope between them, in coordinate units along the surface.
    mask : array_like, shape (n,) or (m,), optional
        Nonzero has no relief, at points or faces, such as faces that fit others.
    overhang : float, 0 to 90, optional
        No relief on faces that face down more steeply than this: the angle in degrees between the
        normal and the horizontal. 0: on no face that faces down.
    up : array_like, shape (3,), default (0, 0, 1)
        The direction of printing, for `overhang`.
    progress : bool or callable, default False
        As for :func:`heat`.
    refine_to : float, default 0
        Edges that are longer are bisected first, and values and masks go along: the result belongs to
        the points of ``refine(surface, refine_to).surface``. 0: the surface stays as it is.
    maximum_number_of_triangles : int, default 4,000,000
        Refinement stops before there are more, with a warning.

    Returns
    -------
    ReliefResult
        The surface, the heights, and counts of defects.

    Warns
    -----
    SurfaceDiffusionWarning
        For open edges, for triangles that cross others, and where relief had to be lower.

    Notes
    -----
    A point moves by at most half the radius of the largest ball that touches the surface there and
    is empty, on the side to which it moves: in the middle of a wall this is a quarter of its
    thickness, so that relief of up to 10 % of the thickness is not changed there. Near inner edges
    relief fades over twice its height. Points on edges of one triangle, and of three or more, stay.
    The relief is lowered further where triangles would still cross.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import relief, sphere
    >>> ball = sphere(4, radius=10.0)
    >>> result = relief(ball, np.ones(ball.n_points), 0.5)
    >>> bool(np.allclose(np.linalg.norm(result.surface.points, axis=1), 10.5, atol=1e-3))
    True
    >>> result.open_edges, result.crossing_triangles, round(result.smallest_wall, 1)
    (0, 0, 21.0)
    """
    surface, rows, _ = take_along(surface, "relief", refine_to, maximum_number_of_triangles,
                                  {"values": values, "mask": mask})
    array, mask = as_numbers("values", rows["values"]), rows["mask"]
    n = surface.n_points
    if array.shape != (n,):
        raise ValueError(f"values has shape {array.shape}; allowed: ({n},), one number per point")
    numbers = np.ascontiguousarray(array, dtype=np.float64)
    if not np.isfinite(numbers).all():
        row = int(np.argmin(np.isfinite(numbers)))
        raise ValueError(f"values is {numbers[row]} at point {row}; allowed: finite numbers")
    if levels not in ("Smooth", "Two", "smooth", "two"):
        raise ValueError(f"levels is {shorten(levels)}; allowed: Smooth or Two, or in snake_case")
    heights = _core.relief_heights(
        surface._core, numbers, _as_number("height", height), _as_number("base", base),
        levels in ("Two", "two"), _as_number("threshold", threshold),
        as_length("flank", flank, zero=True))[:, 0]
    extent = float(np.linalg.norm(np.ptp(surface.points, axis=0)))
    if not np.abs(heights).max() <= extent:
        raise ValueError(f"height is {shorten(height)}, which makes a relief larger than the surface, of "
                         f"{extent:.4g} from corner to corner; allowed: less")
    heights[_smooth_points(surface, mask, overhang, up)] = 0.0
    with ProgressReporter(progress) as reporter:
        found = _core.relief(surface._core, heights, reporter.callable)
        reporter.finish_part()
    sentences = list(found["warnings"])
    warn(sentences)
    new = Surface(found["points"], found["triangles"])
    counts = {name: found[name] for name in (
        "lowered_points", "open_edges", "non_manifold_edges", "crossing_triangles_before",
        "crossing_triangles", "smallest_wall", "volume_change")}
    return ReliefResult(new, found["heights"][:, 0], warnings=sentences, **counts)


def _smooth_points(surface: Surface, mask: Any, overhang: Any, up: Any) -> NDArray[np.bool_]:
    """The points without relief."""
    smooth = np.ones(surface.n_points, dtype=bool)
    smooth[surface._connectivity] = False  # the points of a face; others stay
    faces = np.zeros(surface.n_faces, dtype=bool)
    flags, on_faces = find_mask(mask, (surface.n_points, surface.n_faces))
    if flags is not None:
        marked = faces if on_faces else smooth
        marked |= flags != 0
    if overhang is not None:
        angle = _as_number("overhang", overhang)
        axis = as_numbers("up", up).astype(float)
        if not 0 <= angle <= 90:
            raise ValueError(f"overhang is {shorten(overhang)}; allowed: 0 to 90 degrees")
        if axis.shape != (3,) or not 0 < np.linalg.norm(axis) < np.inf:
            raise ValueError(f"up is {shorten(up)}; allowed: three numbers that are not all 0")
        x, y, z = axis.tolist()
        smooth |= _core.relief_overhangs(surface._core, x, y, z, angle)[:, 0] != 0
    if faces.any():
        sizes = np.diff(surface._offsets)
        smooth[surface._connectivity[np.repeat(faces, sizes)]] = True
    return smooth


def _as_number(name: str, value: Any) -> float:
    real = isinstance(value, (int, float, np.number)) and not isinstance(value, (bool, np.bool_))
    if not (real and math.isfinite(value)):
        raise ValueError(f"{name} is {shorten(value)}; allowed: finite numbers")
    return float(value)
