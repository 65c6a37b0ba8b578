# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The matrices of surfaces, and the modes of their operators."""

from __future__ import annotations

import inspect
from typing import Any, Callable, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._functions import SHARED
from ._run import Progress, ProgressReporter, check_parts, in_words, warn_of_seams
from ._settings import as_integer, as_switch
from ._surface import Surface, SurfaceLike, as_numbers, as_surface, find_mask, left_out, require_shape

__all__ = ["Eigenmodes", "eigenmodes", "gradient_matrix", "mass_matrix", "stiffness_matrix"]


class Eigenmodes(NamedTuple):
    """The smallest eigenvalues of the operator of a surface, and their modes."""

    eigenvalues: NDArray[np.float64]  #: (k,), ascending, in 1 / (unit of the coordinates)^2
    modes: NDArray[np.float64]  #: (n, k), one mode per column


F = TypeVar("F", bound=Callable[..., Any])


def _with_shared(function: F) -> F:
    function.__doc__ = inspect.cleandoc(function.__doc__ or "").replace("{left_out}", SHARED["left_out"])
    return function


@_with_shared
def mass_matrix(
    surface: SurfaceLike, *, mask: ArrayLike | None = None, roi: ArrayLike | None = None
) -> Any:
    """The lumped mass matrix M of a surface: the diagonal matrix of the areas of the points'
    control cells, a third of the triangles at each point. The integral of u over the surface is
    sum(M @ u).

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface. A Surface with given areas has these on the diagonal.
    {left_out}

    Returns
    -------
    scipy.sparse.csr_array, shape (n, n)
        In the square of the unit of the coordinates. Rows and columns of points that no face uses
        have no entries.

    Raises
    ------
    ImportError
        If scipy is not installed.

    Examples
    --------
    >>> from surfacediffusion import mass_matrix, sphere
    >>> round(float(mass_matrix(sphere(4, radius=2.0)).sum()), 2)  # 4 pi 2^2 = 50.27
    50.21
    """
    sparse = import_sparse("mass_matrix")
    surface = as_surface(surface)
    masses = _make_operators(surface, mask, roi).masses()
    used = np.flatnonzero(masses)
    begin = np.concatenate([[0], np.cumsum(masses != 0)]).astype(np.int32)
    return sparse.csr_array(
        (masses[used], used.astype(np.int32), begin), shape=(surface.n_points,) * 2)


@_with_shared
def stiffness_matrix(
    surface: SurfaceLike,
    *,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    diffusivity: ArrayLike | None = None,
    intrinsic_delaunay: bool = False,
) -> Any:
    """The stiffness matrix K of a surface, the finite-element and finite-volume discretisation of
    -div(D grad u): u @ K @ u is the integral of grad u . D grad u for the linear interpolation of
    u. With D = 1 it is the cotangent Laplacian, and M^-1 K u approximates minus the
    Laplace-Beltrami operator of u, with the matrix M of :func:`mass_matrix`.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface.
    {left_out}
    diffusivity : array_like, shape (m,) or (m, 3, 3), optional
        D of each face: a number, 0 or more, or a symmetric positive semidefinite tensor in space,
        whose part in the plane of the triangle counts. By default 1.
    intrinsic_delaunay : bool, default False
        Whether K is that of the intrinsic Delaunay triangulation, whose entries off the diagonal
        are 0 or less, except at edges of the boundary, which are kept, opposite an obtuse angle. Not
        with `diffusivity`.

    Returns
    -------
    scipy.sparse.csr_array, shape (n, n)
        Symmetric, positive semidefinite, without unit if `diffusivity` has none. Its rows sum to 0:
        no flux crosses the boundary. Those of points that no face uses have no entries.

    Raises
    ------
    ImportError
        If scipy is not installed.

    References
    ----------
    C. Wu, J. Deng, F. Chen, Diffusion equations over arbitrary triangulated surfaces for filtering
    and texture applications, IEEE TVCG 14, 2008. A. Bobenko, B. Springborn, A discrete
    Laplace-Beltrami operator for simplicial surfaces, Discrete Comput. Geom. 38, 2007.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import sphere, stiffness_matrix
    >>> surface = sphere(4)
    >>> z = surface.points[:, 2]
    >>> integral = float(z @ (stiffness_matrix(surface) @ z))
    >>> round(integral / (8 * np.pi / 3), 3)  # over the exact integral
    0.999
    """
    sparse = import_sparse("stiffness_matrix")
    surface = as_surface(surface)
    tensors = _as_tensors(surface, diffusivity)
    operators = _make_operators(surface, mask, roi, _as_delaunay(surface, intrinsic_delaunay, tensors))
    warn_of_seams(operators)
    return sparse.csr_array(operators.stiffness(tensors), shape=(surface.n_points,) * 2)


@_with_shared
def gradient_matrix(
    surface: SurfaceLike, *, mask: ArrayLike | None = None, roi: ArrayLike | None = None
) -> Any:
    """The matrix G of the gradients of linear functions on the triangles:
    ``(G @ u).reshape(-1, 3)`` has the gradient of u on each of ``surface.triangles``, a vector in
    space and in the plane of the triangle. With the areas W of the triangles, each three times on a
    diagonal, G^T W G is the matrix of :func:`stiffness_matrix`, and -M^-1 G^T W the divergence.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface.
    {left_out}

    Returns
    -------
    scipy.sparse.csr_array, shape (3 t, n) for t triangles
        In 1 / (unit of the coordinates). Rows of triangles that are left out, or have no area, are
        empty.

    Raises
    ------
    ImportError
        If scipy is not installed.

    Examples
    --------
    >>> from surfacediffusion import Surface, gradient_matrix
    >>> surface = Surface([[0, 0, 0], [2, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> (gradient_matrix(surface) @ [1.0, 4.0, 3.0]).reshape(-1, 3)
    array([[1.5, 2. , 0. ]])
    """
    sparse = import_sparse("gradient_matrix")
    surface = as_surface(surface)
    entries = _make_operators(surface, mask, roi).gradient()
    return sparse.csr_array(entries, shape=(3 * len(surface.triangles), surface.n_points))


@_with_shared
def eigenmodes(
    surface: SurfaceLike,
    n: int,
    *,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    diffusivity: ArrayLike | None = None,
    intrinsic_delaunay: bool = False,
    progress: Progress = None,
) -> Eigenmodes:
    """The n smallest eigenvalues lambda of -div(D grad) on a surface, without flux across its
    boundary, and their modes x: K x = lambda M x with the matrices of :func:`stiffness_matrix` and
    :func:`mass_matrix`. On a sphere of radius R they are l (l + 1) / R^2 with an error of second
    order in the length of the edges, 2 l + 1 times each.

    They are found by block Lanczos with full orthogonalisation and shift and invert on one sparse
    factor. Each connected component has its own modes, which are 0 on the others; the first one is
    constant, with the eigenvalue 0. scipy is not needed.

    Parameters
    ----------
    surface : Surface or tuple (points, faces)
        The surface.
    n : int, from 1 to the number of points of the surface
        The number of modes.
    {left_out}
    diffusivity : array_like, shape (m,) or (m, 3, 3), optional
        D of each face, as for :func:`stiffness_matrix`.
    intrinsic_delaunay : bool, default False
        Whether to work on the intrinsic Delaunay triangulation. Not with `diffusivity`.
    progress : bool or callable, optional
        As for :func:`heat`.

    Returns
    -------
    Eigenmodes
        `eigenvalues` (n,), ascending, and `modes` (points, n), orthonormal: modes.T @ M @ modes =
        1, and 0 at points that are left out. The entry of each mode with the largest magnitude is positive, the first one of equal
        entries. The same input gives the same bits, on any number of threads.

    References
    ----------
    G. Golub, R. Underwood, The block Lanczos method for computing eigenvalues, Mathematical
    Software III, 1977, 361-377.

    Examples
    --------
    >>> from surfacediffusion import eigenmodes, sphere
    >>> eigenmodes(sphere(4), 5).eigenvalues.round(2)
    array([0.  , 2.  , 2.  , 2.  , 5.99])
    """
    surface = as_surface(surface)
    tensors = _as_tensors(surface, diffusivity)
    operators = _make_operators(surface, mask, roi, _as_delaunay(surface, intrinsic_delaunay, tensors),
                                join_short_edges=True)
    most = check_parts(operators)
    n = as_integer("n", n, 1, most, f"1 to {most}, the points with a triangle")
    with ProgressReporter(progress) as reporter:
        found = operators.modes(tensors, n, reporter.callable)
        reporter.finish_part()
    return Eigenmodes(*found)


def import_sparse(function: str) -> Any:
    """scipy.sparse, or an error that names the function that needs it."""
    try:
        import scipy.sparse as sparse  # type: ignore[import-not-found,import-untyped,unused-ignore]
    except ImportError:
        raise ImportError(f"{function}() returns a matrix of scipy.sparse, but scipy is not "
                          "installed; pip install scipy", name="scipy") from None
    return sparse


def _make_operators(surface: Surface, mask: Any, roi: Any, intrinsic_delaunay: bool = False,
                    join_short_edges: bool = False) -> Any:
    flags, on_faces = find_mask(left_out(mask, roi, surface), (surface.n_points, surface.n_faces))
    return in_words("heat", {}, _core.Operators, surface._core, flags, on_faces, intrinsic_delaunay,
                    join_short_edges, None)


def _as_delaunay(surface: Surface, intrinsic_delaunay: Any, tensors: Any) -> bool:
    if as_switch("intrinsic_delaunay", intrinsic_delaunay) and tensors is not None:
        raise ValueError("intrinsic_delaunay is True, and diffusivity is given for the faces, "
                         "which are not its triangles; allowed: one of them")
    return bool(intrinsic_delaunay)


def _as_tensors(surface: Surface, diffusivity: Any) -> NDArray[np.float64] | None:
    """A row of nine numbers per face; None stays."""
    if diffusivity is None:
        return None
    m = surface.n_faces
    array = np.asarray(as_numbers("diffusivity", diffusivity), dtype=np.float64)
    require_shape("diffusivity", array, array.shape in ((m,), (m, 3, 3)),
                  f"({m},), one number per face, or ({m}, 3, 3), one tensor per face")
    if array.ndim == 1:
        array = array[:, None, None] * np.eye(3)
    bad = ~np.isfinite(array).all(axis=(1, 2))
    if not bad.any():
        size = np.abs(array).max(axis=(1, 2))
        bad = np.abs(array - array.transpose(0, 2, 1)).max(axis=(1, 2)) > 1e-10 * size
        bad |= np.linalg.eigvalsh(array)[:, 0] < -1e-10 * size
    if bad.any():
        row = int(np.argmax(bad))
        raise ValueError(f"diffusivity is {array[row].tolist()} in row {row}; allowed: finite "
                         "numbers, 0 or more, or symmetric positive semidefinite tensors")
    return np.ascontiguousarray(array.reshape(m, 9))
