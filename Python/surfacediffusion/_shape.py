# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Functions that make another surface: with relief."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._functions import _with_settings, run_once
from ._models import ARRAYS
from ._run import Input, Progress
from ._settings import snake_case
from ._surface import Surface, SurfaceLike, as_data, as_surface


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
    walls : ndarray, shape (n,)
        The distance from each point to the opposite side; infinite where there is none.
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
    walls: NDArray[np.float64] = field(repr=False)
    warnings: list[str] = field(repr=False)


@_with_settings
def relief(
    surface: SurfaceLike,
    values: ArrayLike,
    height: float,
    *,
    mask: ArrayLike | None = None,
    progress: Progress = False,
    **properties: Any,
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
    mask : array_like, shape (n,) or (m,), optional
        Nonzero has no relief, at points or faces, such as faces that fit others.
    {progress}

    {settings}

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
    relief fades over twice its height. Points on edges of one triangle, and of three or more, stay, and so
    do those inside another closed body.
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
    if properties.get("overhang", 0) is None:
        del properties["overhang"]
    given = Input(surface, as_data("values", values, surface.n_points), mask=mask)
    outputs, found = run_once("relief", given, {"height": height, **properties}, ARRAYS, progress)
    triangles = np.array(surface.triangles)
    triangles[found["turned"]] = triangles[found["turned"]][:, [0, 2, 1]]
    of_name = {output.name: output.values for output in outputs}
    return ReliefResult(
        Surface(of_name.pop("Points"), triangles), of_name.pop("ReliefHeight"), walls=found["walls"],
        warnings=found["warnings"],
        **{snake_case(name): value for name, value in of_name.items()})
