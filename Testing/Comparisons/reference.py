# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Reference solutions, by means of their own: finite elements of LaPy and SciPy's solvers."""
from __future__ import annotations

import lapy
import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu

LN2 = np.log(2)


def time_of_width(fwhm):
    """The diffusion time whose heat kernel has this full width at half maximum."""
    return fwhm**2 / (16 * LN2)


def width_of_time(time):
    return np.sqrt(16 * LN2 * np.maximum(time, 0))


def matrices(points, faces):
    """Cotan stiffness and lumped mass matrix (the vector of its diagonal)."""
    solver = lapy.Solver(lapy.TriaMesh(points, faces), lump=True)
    return solver.stiffness.tocsc(), solver.mass.diagonal()


def eigenfunctions(points, faces, count):
    """Eigenvalues and eigenfunctions of the Laplace-Beltrami operator but the constant one, by
    linear finite elements, and their mass matrix."""
    solver = lapy.Solver(lapy.TriaMesh(points, faces), lump=False)
    values, functions = solver.eigs(k=count + 1, rng=1)
    return values[1:], functions[:, 1:], solver.mass


def diffuse(points, faces, values, fwhm, steps=200):
    """The heat equation by Crank-Nicolson, after two steps of backward Euler of half the length,
    without which the method does not damp noise (Rannacher 1984)."""
    stiffness, mass = matrices(points, faces)
    step = time_of_width(fwhm) / steps
    factor = splu(sparse.diags(mass) + step / 2 * stiffness)
    u = np.array(values, float)
    column = mass.reshape(-1, *[1] * (u.ndim - 1))
    for _ in range(2):
        u = factor.solve(column * u)
    for _ in range(steps - 1):
        u = factor.solve(column * u - step / 2 * (stiffness @ u))
    return u


def realised_widths(smoothed, eigenvalues, functions, mass):
    """For each eigenfunction, the width of the Gaussian that would make it decay as much."""
    weighted = mass @ functions
    decay = (weighted * smoothed).sum(axis=0) / (weighted * functions).sum(axis=0)
    return width_of_time(-np.log(np.clip(decay, 1e-12, None)) / eigenvalues)
