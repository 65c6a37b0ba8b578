# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives of data on surfaces, each by its name."""

from __future__ import annotations

import inspect
from typing import Any, Callable, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._functions import SHARED, derivatives
from ._result import ConductionVelocity, HelmholtzParts, InterpolationResult
from ._surface import SurfaceLike, as_numbers

__all__ = ["conduction_velocity", "curl", "divergence", "gradient", "helmholtz", "laplacian"]

F = TypeVar("F", bound=Callable[..., Any])


def _with_arguments(function: F) -> F:
    """Give a function, which has the surface and the data, the other arguments of derivatives()."""
    own, of_all = inspect.signature(function), inspect.signature(derivatives).parameters
    others = [parameter for name, parameter in of_all.items()
              if parameter.kind is inspect.Parameter.KEYWORD_ONLY and name != "quantity"]
    function.__signature__ = own.replace(  # type: ignore[attr-defined]
        parameters=[*(each for each in own.parameters.values() if each.name != "others"), *others])
    names = [other.name for other in others if f"\n    {other.name} : " not in (function.__doc__ or "")]
    text = inspect.cleandoc(function.__doc__ or "").replace("{surface}", SHARED["surface"])
    function.__doc__ = text.replace(
        "{others}", f"{', '.join(names)}\n    As for :func:`derivatives`, which describes the discretisation.")
    return function


@_with_arguments
def gradient(surface: SurfaceLike, values: ArrayLike, **others: Any) -> NDArray[np.float64]:
    """Compute the tangential gradient of data on a surface.

    Parameters
    ----------
    {surface}
    values : array_like, shape (n,), (n, k), (m,) or (m, k)
        Data at points or faces; NaN is missing.
    {others}

    Returns
    -------
    ndarray, shape (n, 3), or (n, 3 k) of k columns
        In the unit of the values per unit of the coordinates: x, y and z of the first column, then
        those of the second. (m, 3) with `result_on_faces`.

    Examples
    --------
    >>> from surfacediffusion import gradient, sphere
    >>> surface = sphere(5)
    >>> gradient(surface, surface.points[:, 2]).shape
    (10242, 3)
    """
    return derivatives(surface, values, quantity="Gradient", **others)


@_with_arguments
def divergence(surface: SurfaceLike, vectors: ArrayLike, **others: Any) -> NDArray[np.float64]:
    """Compute the divergence of the tangential parts of vectors on a surface.

    Parameters
    ----------
    {surface}
    vectors : array_like, shape (n, 3), (n, 3 k), (m, 3) or (m, 3 k)
        Vectors in space at points or faces, whose tangential parts count; NaN is missing.
    {others}

    Returns
    -------
    ndarray, shape (n,), or (n, k) of k vectors
        Per unit of the coordinates. (m,) with `result_on_faces`.

    Examples
    --------
    >>> from surfacediffusion import divergence, sphere
    >>> surface = sphere(5)
    >>> z = surface.points[:, 2]
    >>> found = divergence(surface, [[0, 0, 1]] * len(z))  # of grad z: -2 z
    >>> bool(abs(found + 2 * z).mean() < 0.01)
    True
    """
    return derivatives(surface, vectors, quantity="Divergence", _name="vectors", **others)


@_with_arguments
def curl(surface: SurfaceLike, vectors: ArrayLike, **others: Any) -> NDArray[np.float64]:
    """Compute the curl about the normals of the tangential parts of vectors on a surface.

    Parameters
    ----------
    {surface}
    vectors : array_like, shape (n, 3), (n, 3 k), (m, 3) or (m, 3 k)
        Vectors in space at points or faces, whose tangential parts count; NaN is missing.
    {others}

    Returns
    -------
    ndarray, shape (n,), or (n, k) of k vectors
        Per unit of the coordinates. (m,) with `result_on_faces`. Positive where vectors turn
        counter-clockwise as seen from the side to which the normals point.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import curl, sphere
    >>> surface = sphere(5)
    >>> spin = np.cross([0, 0, 1], surface.points)  # a rotation, whose curl is 2 z
    >>> bool(abs(curl(surface, spin) - 2 * surface.points[:, 2]).max() < 0.02)
    True
    """
    return derivatives(surface, vectors, quantity="Curl", _name="vectors", **others)


@_with_arguments
def laplacian(surface: SurfaceLike, values: ArrayLike, **others: Any) -> NDArray[np.float64]:
    """Compute the Laplacian of data on a surface, the divergence of the gradient.

    Parameters
    ----------
    {surface}
    values : array_like, shape (n,), (n, k), (m,) or (m, k)
        Data at points or faces; NaN is missing.
    {others}

    Returns
    -------
    ndarray, shape (n,), or (n, k) of k columns
        In the unit of the values per square of the unit of the coordinates. Inside, -M^-1 K u with
        the matrices of :func:`mass_matrix` and :func:`stiffness_matrix`, without areas that are
        given for the surface; at boundary points that of the quadratic polynomial that fits the data
        near them, or NaN, with a warning, if their neighbours are too few. Its values at single points
        inside converge where the points of a mesh look alike, and means over several on any mesh. (m,)
        with `result_on_faces`.

    Examples
    --------
    >>> from surfacediffusion import laplacian, sphere
    >>> surface = sphere(5)
    >>> z = surface.points[:, 2]
    >>> bool(abs(laplacian(surface, z) + 2 * z).mean() < 0.01)
    True
    """
    return derivatives(surface, values, quantity="Laplacian", **others)


@_with_arguments
def conduction_velocity(
    surface: SurfaceLike, times: ArrayLike, *, error: InterpolationResult | ArrayLike | None = None, **others: Any
) -> ConductionVelocity:
    """Compute the velocity of a wave on a surface from its arrival times T: grad T/|grad T|^2.

    Times in ms on coordinates in mm give mm/ms = m/s. Where the times do not change, the velocity is
    not defined and is 0. Where fronts meet or begin, the direction is not determined: the speed is NaN there,
    and velocity and direction are 0.

    Parameters
    ----------
    {surface}
    times : array_like, shape (n,) or (m,)
        Arrival times at points or faces; NaN is missing. :func:`interpolate` makes them of times at a
        few points.
    smoothing_fwhm : float, default 0
        The width, in the unit of the coordinates, of the Gaussian that smooths the times first:
        several edges for times with noise. Linear functions on planes stay as they are.
    error : InterpolationResult or array_like of the shape of the times, optional
        The result of :func:`interpolate` with ``compute_error=True`` that the times are of, or its
        `slope_error` alone. It gives the band
        of the speed, 1/(abs(grad T) +- 1.645 e) with the standard error e of slopes. Not with
        `smoothing_fwhm` or `result_on_faces`.
    {others}

    Returns
    -------
    ConductionVelocity
        The pair of `velocity` (n, 3) and `speed` (n,), at the faces with `result_on_faces`, with `direction`
        and the marks `collision` and `focus` of where it is undetermined and the speed NaN. With `error` also `speed_lower`
        and `speed_upper`. The smoothness that interpolation assumes is rougher than waves are, so that the
        bands hold more than 90 %.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import conduction_velocity
    >>> x, y = np.meshgrid(np.arange(20.0), np.arange(10.0))  # mm
    >>> points = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()])
    >>> first = (np.arange(9)[:, None] * 20 + np.arange(19)).ravel()
    >>> squares = np.column_stack([first, first + 1, first + 21, first + 20])
    >>> found = conduction_velocity((points, squares), points[:, 0] / 0.6)  # ms
    >>> float(found.speed.round(6).min()), found.velocity.shape
    (0.6, (200, 3))
    """
    slope_error = None if error is None else _slope_error_of(error)
    outputs: list[Any] = []
    derivatives(surface, times, quantity="ConductionVelocity", _outputs=outputs, _slope_error=slope_error,
                **others)
    named = {output.name: output.values for output in outputs}
    result = ConductionVelocity(named["ConductionVelocity"], named["Speed"])
    speeds = np.asarray(result.speed)
    vectors = result.velocity.reshape(*speeds.shape, 3)
    with np.errstate(divide="ignore", invalid="ignore"):
        result.direction = np.where(speeds[..., None] > 0.0, vectors / speeds[..., None], 0.0 * vectors).reshape(
            result.velocity.shape)
    result.collision, result.focus = named["Collision"] > 0.0, named["Focus"] > 0.0
    result.speed_lower, result.speed_upper = named.get("SpeedLower"), named.get("SpeedUpper")
    return result


def _slope_error_of(error: Any) -> NDArray[np.float64]:
    if not isinstance(error, InterpolationResult):
        return as_numbers("error", error)
    if error.slope_error.size == 0:
        raise ValueError("error has no errors of slopes; allowed: the result of interpolate() with "
                         "compute_error=True and without exact=True")
    return error.slope_error


@_with_arguments
def helmholtz(surface: SurfaceLike, vectors: ArrayLike, **others: Any) -> HelmholtzParts:
    """Split tangent vectors into a gradient, a curl and a harmonic part.

    On the triangles u = grad(phi) + n x grad(psi) + h, three parts that are orthogonal in the integral
    over the surface to 1e-12. phi and psi are linear on each triangle; psi is 0 on boundaries, and
    otherwise both have the mean 0 on each connected part. h has neither divergence nor curl: flow around
    the holes of the surface, and across and along its boundaries. Smoothing phi and psi by
    :func:`heat` or :func:`scale_filter` filters u by scale and commutes with divergence and curl.

    Parameters
    ----------
    {surface}
    vectors : array_like, shape (n, 3), (n, 3 k), (m, 3) or (m, 3 k)
        Vectors in space at points or faces, whose tangential parts count; NaN is missing.
    {others}

    Returns
    -------
    HelmholtzParts
        `gradient_potential` phi and `curl_potential` psi, (n,) or (n, k); `gradient_part`, `curl_part`
        and `harmonic_part`, (n, 3) or (n, 3 k), at points the means over the triangles around. With
        `result_on_faces` all are at the faces.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import helmholtz, sphere
    >>> surface = sphere(5)
    >>> spin = np.cross([0.0, 0.0, 1.0], surface.points)
    >>> found = helmholtz(surface, spin)
    >>> bool(np.abs(found.curl_potential + surface.points[:, 2]).max() < 0.01)
    True
    >>> bool(np.abs(found.gradient_part).max() < 1e-3)
    True
    """
    outputs: list[Any] = []
    derivatives(surface, vectors, quantity="Helmholtz", _name="vectors", _outputs=outputs, **others)
    named = {output.name: output.values for output in outputs}
    return HelmholtzParts(*(named[name] for name in (
        "GradientPotential", "CurlPotential", "GradientPart", "CurlPart", "HarmonicPart")))
