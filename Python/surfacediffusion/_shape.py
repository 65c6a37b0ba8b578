# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Functions that make another surface: with shorter edges, and with relief."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._run import Progress, ProgressReporter, warn
from ._settings import shorten
from ._surface import Surface, SurfaceLike, as_flags, as_numbers, as_surface, find_place

#: The triangles that refine() makes at most by default: about 1 GB of memory for a texture.
MAXIMUM_TRIANGLES = 4_000_000

#: Edges per wavelength of a texture on a refined surface.
EDGES_PER_WAVELENGTH = 8


@dataclass(frozen=True)
class RefinedSurface:
    """A surface with shorter edges.

    Attributes
    ----------
    surface : Surface
        Its first points are those of the given surface.
    faces : ndarray of int, shape (t,)
        The face of the given surface that each triangle lies in.
    parents : ndarray of int, shape (k, 2)
        New point n + k, with n given points, is the middle of these two points.
    longest_edge : float
        In coordinate units.
    limit_reached : bool
        Whether edges that are too long are left, because there would be too many triangles.
    """

    surface: Surface
    faces: NDArray[np.int32] = field(repr=False)
    parents: NDArray[np.int32] = field(repr=False)
    longest_edge: float
    limit_reached: bool

    def at_points(self, values: ArrayLike) -> NDArray[Any]:
        """Data of the given points (n,) or (n, k) at the new points, by linear interpolation."""
        array = as_numbers("values", values)
        n = self.surface.n_points - len(self.parents)
        if array.ndim not in (1, 2) or len(array) != n:
            raise ValueError(f"values has shape {array.shape}; allowed: ({n},) or ({n}, k), one row "
                             "per given point")
        kind = array.dtype if array.dtype.kind == "f" else np.dtype(np.float64)
        found = np.empty((self.surface.n_points, *array.shape[1:]), dtype=kind)
        found[:n] = array
        # Parents come before their children: all that have known parents are found at once.
        newest = np.maximum.accumulate(self.parents.max(axis=1)) if len(self.parents) else np.empty(0)
        known = 0
        while known < len(self.parents):
            end = int(np.searchsorted(newest, n + known))
            first, second = self.parents[known:end].T
            found[n + known:n + end] = (found[first] + found[second]) / 2
            known = end
        return found

    def at_faces(self, values: ArrayLike) -> NDArray[Any]:
        """Data of the given faces (m,) or (m, k) at the triangles: each has those of its face."""
        array = np.asarray(values)
        if array.ndim not in (1, 2) or len(array) <= self.faces.max(initial=0):
            raise ValueError(f"values has shape {array.shape}; allowed: one row per given face")
        return array[self.faces]


def refine(
    surface: SurfaceLike,
    length: float,
    *,
    maximum_triangles: int = MAXIMUM_TRIANGLES,
    progress: Progress = False,
) -> RefinedSurface:
    """Bisect the edges of a surface that are longer than `length`, and keep its shape.

    CAD files have few large triangles, on which data and textures have no place. Flat faces stay
    flat and sharp edges sharp, because new points are the middles of edges. The longest edge of the
    surface is always bisected next, in all its triangles at once: there are no cracks, and angles
    are at least half of those of the given triangles.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface. Polygons are cut into triangles first.
    length : float
        The length of the longest edge allowed, above 0, in the unit of the coordinates.
    maximum_triangles : int, default 4,000,000
        Refinement stops before there are more, with a warning.
    progress : bool or callable, default False
        As for :func:`heat`.

    Returns
    -------
    RefinedSurface
        `surface`, and what data on it need: `at_points` and `at_faces`.

    Examples
    --------
    >>> from surfacediffusion import Surface, refine
    >>> square = Surface([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
    >>> fine = refine(square, 0.3)
    >>> fine.surface, fine.longest_edge
    (<Surface: 41 points, 64 faces>, 0.25)
    >>> bool((fine.at_points(square.points) == fine.surface.points).all())
    True
    """
    surface = as_surface(surface)
    length = _as_length("length", length)
    whole = isinstance(maximum_triangles, (int, np.integer)) and not isinstance(maximum_triangles, bool)
    if not (whole and 1 <= maximum_triangles < 2**31):
        raise ValueError(f"maximum_triangles is {shorten(maximum_triangles)}; allowed: 1 to {2**31 - 1}")
    with ProgressReporter(progress) as reporter:
        found = _core.refine(surface._core, length, int(maximum_triangles), reporter.callable)
        reporter.finish_part()
    if found["limit_reached"]:
        warn([f"refinement stopped at {len(found['triangles'])} triangles with edges of up to "
              f"{found['longest_edge']:.3g}, longer than {length:.3g}; maximum_triangles is "
              f"{maximum_triangles}"])
    return RefinedSurface(Surface(found["points"], found["triangles"]), found["faces"][:, 0],
                          found["parents"], found["longest_edge"], found["limit_reached"])


def refine_for_texture(surface: Any, refine_to: Any, feature_size: Any) -> RefinedSurface:
    """For a texture of this wavelength, in the words of turing_texture()."""
    if refine_to == "Automatic" or refine_to == "automatic":
        size = _as_length("feature_size", feature_size)
        return refine(surface, size / EDGES_PER_WAVELENGTH)
    if isinstance(refine_to, str):
        raise ValueError(f'refine_to is {refine_to!r}; allowed: "Automatic", or a length above 0')
    return refine(surface, _as_length("refine_to", refine_to))


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
) -> ReliefResult:
    """Raise or carve values on a surface as relief, for printing.

    Each point moves by ``base + height * value`` along its normal, outwards from a closed surface.
    At sharp edges the direction is such that the flat faces beside them move by the heights.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface. Large triangles have no room for relief: see :func:`refine`.
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
    surface = as_surface(surface)
    array = as_numbers("values", values)
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
        _as_length("flank", flank, zero=True))[:, 0]
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
    smooth = np.zeros(surface.n_points, dtype=bool)
    faces = np.zeros(surface.n_faces, dtype=bool)
    flags = as_flags("mask", mask)
    if flags is not None:
        if find_place("mask", flags, (surface.n_points, surface.n_faces), "flag", False):
            faces |= flags != 0
        else:
            smooth |= flags != 0
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


def _as_length(name: str, value: Any, zero: bool = False) -> float:
    real = isinstance(value, (int, float, np.number)) and not isinstance(value, (bool, np.bool_))
    if not (real and math.isfinite(value) and (value > 0 or (zero and value == 0))):
        raise ValueError(f"{name} is {shorten(value)}; allowed: finite numbers "
                         + ("of at least 0" if zero else "above 0"))
    return float(value)
