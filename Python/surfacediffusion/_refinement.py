# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces with shorter edges, and the keyword refine_to of all functions."""

from __future__ import annotations

import functools
import inspect
import math
import textwrap
from dataclasses import dataclass, field
from typing import Any, Callable, Sequence, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._run import Progress, ProgressReporter, warn
from ._settings import as_integer, as_number, shorten, spell
from ._surface import (
    Surface, SurfaceLike, as_numbers, as_outside, as_surface, known_place, place, require_shape,
)

F = TypeVar("F", bound=Callable[..., Any])

#: The triangles that refinement makes at most by default: about 1 GB of memory for a texture.
MAXIMUM_TRIANGLES = 4_000_000

#: Edges per wavelength of a texture on a refined surface, and those that a mesh should have.
EDGES_PER_WAVELENGTH = _core.edges_of_refinement
FEWEST_EDGES_PER_WAVELENGTH = _core.edges_per_wavelength

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
        """Data of the given points (n,) or (n, k) at all points, by linear interpolation. Integers and
        bools keep their type: single ones, which are labels and marks, become the smaller of two, and
        others, such as colours, are rounded."""
        array = as_numbers("values", values)
        n = self.surface.n_points - len(self.parents)
        require_shape("values", array, array.ndim in (1, 2) and len(array) == n,
                      f"({n},) or ({n}, k), one row per given point")
        return interpolate_points(array, self.parents)

    def at_faces(self, values: ArrayLike) -> NDArray[Any]:
        """Data of the given faces (m,) or (m, k) at the triangles: each has those of its face."""
        array = np.asarray(values)
        fits = array.ndim in (1, 2) and len(array) > self.faces.max(initial=0)
        require_shape("values", array, fits, "one row per given face")
        return array[self.faces]


#: The roles of arguments at points, by which they are interpolated between two; others are data.
ROLES = {"mask": _core.PointRole.Mask, "fidelity": _core.PointRole.Weight,
         **dict.fromkeys(("fixed", "seeds", "sources"), _core.PointRole.Mark)}


def interpolate_points(
    array: NDArray[Any], parents: NDArray[Any], role: _core.PointRole = _core.PointRole.Data
) -> NDArray[Any]:
    """Data (n, ...) of points, and between them: row n + i belongs to the middle of the two parents i."""
    columns = np.ascontiguousarray(array.reshape(len(array), array.size // max(len(array), 1)), dtype=float)
    found = _core.interpolate_at_points(columns, parents, role, array.dtype.name)
    return found.astype(array.dtype).reshape(-1, *array.shape[1:])


def refine(
    surface: SurfaceLike,
    length: float,
    *,
    maximum_number_of_triangles: int = MAXIMUM_TRIANGLES,
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
        The surface, without given `areas`. Polygons are cut into triangles first; a surface without a
        longer edge stays as it is.
    length : float
        The length of the longest edge allowed, above 0, in the unit of the coordinates.
    maximum_number_of_triangles : int, default 4,000,000
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
    surface, length = as_surface(surface), as_number("length", length)
    if surface.areas is not None:
        raise ValueError(f"length is {length:g}, but areas are given for the points; allowed: surfaces "
                         "without given areas")
    return _refine(surface, length, maximum_number_of_triangles, progress)


def _refine(surface: Surface, length: float, limit: Any, progress: Progress = False) -> RefinedSurface:
    """The same; a surface keeps its last one."""
    key = (length, as_integer("maximum_number_of_triangles", limit, 1, 2**31 - 1))
    with surface._lock, ProgressReporter(progress) as reporter:
        if key not in surface._refined:
            found = _core.refine(surface._core, *key, reporter.callable)
            stays = len(found["parents"]) == 0
            surface._refined.clear()
            surface._refined[key] = RefinedSurface(
                surface if stays else Surface(found["points"], found["triangles"]),
                np.arange(surface.n_faces, dtype=np.int32) if stays else found["faces"],
                found["parents"], found["longest_edge"], found["limit_reached"])
        refined: RefinedSurface = surface._refined[key]
        reporter.finish_part()
    if refined.limit_reached:
        warn([_say("Stopped", refined.longest_edge, length, limit)])
    return refined


def _say(name: str, *parts: Any) -> str:
    return spell("turing_texture", _core.say(name, *parts), {})


def mean_edge_length(surfaces: Sequence[Any]) -> float:
    """h of surfaces of the extension; 0 without an edge."""
    total, number = np.sum([_core.sum_edges(surface) for surface in surfaces], axis=0)
    return float(total / number) if number else 0.0


def refine_as_asked(
    surfaces: Sequence[Surface], function: str, refine_to: Any, limit: Any, feature_size: Any = 0.0
) -> list[RefinedSurface] | None:
    """The surfaces with the keywords of a function; None if they stay as they are."""
    automatic = function == "turing_texture" and isinstance(refine_to, (int, float)) and refine_to == -1
    if not automatic:
        length = as_number("refine_to", refine_to, "finite numbers of at least 0",
                           lambda number: 0.0 <= number < math.inf)
    elif isinstance(feature_size, (int, float, np.number)) and feature_size > 0:
        mean = mean_edge_length([surface._core for surface in surfaces])
        length = _core.edge_length_for_features(feature_size, mean)
    else:
        length = 0.0
    if length == 0:
        return None
    if any(surface.areas is not None for surface in surfaces):
        raise ValueError(f"refine_to is {shorten(refine_to)}, but areas are given for the points; allowed: "
                         "one of them")
    refined = [_refine(surface, length, limit) for surface in surfaces]
    longest = max((fine.longest_edge for fine in refined if fine.limit_reached), default=0.0)
    if longest > 0.0 and len(surfaces) > 1:  # alike in every block
        refined = [_refine(surface, longest, limit) for surface in surfaces]
    triangles = sum(fine.surface.n_faces for fine in refined if len(fine.parents))
    if not triangles:
        return None
    if automatic:
        size = float(feature_size)
        warn([_say("Bisected", triangles, _say("Features", size, size / mean))])
    return refined


def with_refinement(function: F) -> F:
    """The function of a surface with the keywords refine_to and maximum_number_of_triangles."""
    own = inspect.signature(function)
    name = function.__name__
    new = keywords_of(name)

    @functools.wraps(function)
    def refining(surface: Any, *arguments: Any, refine_to: Any = new[0].default,
                 maximum_number_of_triangles: Any = new[1].default, **keywords: Any) -> Any:
        if refine_to == 0:
            return function(surface, *arguments, **keywords)
        bound = own.bind(surface, *arguments, **keywords)
        bound.apply_defaults()
        given = dict(bound.arguments)
        properties = given.pop("properties")
        surface, given, refined = take_along(given.pop("surface"), name, refine_to,
                                             maximum_number_of_triangles, given,
                                             properties.get("feature_size", 0.0))
        if name in ESTIMATING and refined is not None:
            properties["_refined"] = refined
        return function(surface, **given, **properties)

    return refining  # type: ignore[return-value]


def keywords_of(function: str) -> tuple[inspect.Parameter, inspect.Parameter]:
    """The parameters that all functions have."""
    default = -1.0 if function == "turing_texture" else 0.0
    return (inspect.Parameter("refine_to", inspect.Parameter.KEYWORD_ONLY, default=default,
                              annotation="float"),
            inspect.Parameter("maximum_number_of_triangles", inspect.Parameter.KEYWORD_ONLY,
                              default=MAXIMUM_TRIANGLES, annotation="int"))


def document_keywords(function: str) -> str:
    """Their entries in a docstring."""
    automatic = function == "turing_texture"
    special = (", or -1: `feature_size` / 8 if that is less than 6 mean edge lengths, with a warning, and "
               "otherwise 0") if automatic else ""
    text = ("Edges that are longer are bisected first, and the data go along: the result belongs to "
            "the points and faces of ``refine(surface, refine_to).surface``. Values that are interpolated "
            "on the way are no measurements: interpolation and estimates of noise do not count them. 0: "
            f"the surface stays as it is{special}.")
    lines = textwrap.fill(text, 92, initial_indent="    ", subsequent_indent="    ")
    return (f"refine_to : float, 0 or more{' or -1' * automatic}, in coordinates, default "
            f"{-1.0 if automatic else 0.0}\n{lines}\n"
            f"maximum_number_of_triangles : int, 1 or more, default {MAXIMUM_TRIANGLES}\n"
            "    Refinement stops before there are more, with a warning.")


#: The functions that ask which of the data were measured.
ESTIMATING = ("heat", "intrinsic_tv", "mumford_shah", "interpolate")

#: The arguments with rows of points or faces. The first are where on_faces says, if it is given.
_DATA = ("values", "terms", "vectors")
_ROWS = ("initial", "mask", "roi", "directions", "fixed", "fidelity", "seeds", "rates", "hints", "speed",
         "along_speed", "across_speed")


def take_along(
    surface: Any, function: str, refine_to: Any, limit: Any, given: dict[str, Any],
    feature_size: Any = 0.0,
) -> tuple[Surface, dict[str, Any], RefinedSurface | None]:
    """The surface with shorter edges, if that is asked for, the arguments of a function for it, and the
    refinement."""
    surface = as_surface(surface)
    refined = refine_as_asked([surface], function, refine_to, limit, feature_size)
    if refined is None:
        return surface, given, None
    (fine,) = refined
    n, m = surface.n_points, surface.n_faces
    carried = dict(given)
    beside = given.get("points") is not None  # values and their weights at other places
    for name in (*_DATA, *_ROWS):
        values = given.get(name)
        if values is None or (beside and name in ("values", "fidelity")):
            continue
        array = ~as_outside(values, n, m) if name == "roi" else as_numbers(name, values)
        known = known_place(values)
        on_faces = array.ndim > 0 and len(array) == m and (n != m or bool(known))
        if name in _DATA and given.get("on_faces") is not None:
            on_faces = bool(given["on_faces"])
        require_shape(name, array, array.ndim in (1, 2) and len(array) == (m if on_faces else n),
                      f"one row per point, of which there are {n}, or per face, {m}")
        found = fine.at_faces(array) if on_faces else interpolate_points(array, fine.parents, ROLES.get(name, _core.PointRole.Data))
        carried[name] = place(found, on_faces)
        if name in _DATA and "on_faces" in given:
            carried["on_faces"] = on_faces
    return fine.surface, carried, fine
