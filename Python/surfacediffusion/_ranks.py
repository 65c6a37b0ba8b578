# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The ranks of the values of a map, and the values of ranks."""

from __future__ import annotations

from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from ._fields import check_finite

__all__: list[str] = []


def check_known(name: str, values: NDArray[np.float64]) -> None:
    check_finite(name, values)
    if np.isnan(values).all():
        raise ValueError(f"{name} has no known value: it is NaN everywhere; allowed: maps with known values")


def check_varies(name: str, known: NDArray[np.float64]) -> None:
    if len(np.unique(known)) < 2:
        raise ValueError(f"{name} is constant; allowed: values that differ")


def normal_scores(given: NDArray[np.float64], known: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The quantiles of the normal distribution of the ranks, equal ones for equal values; 0 where they are
    not known."""
    _, inverse, counts = np.unique(given[known], return_inverse=True, return_counts=True)
    ends = np.cumsum(counts)
    shares = (ends - 0.5 * counts) / ends[-1]
    quantile = NormalDist().inv_cdf
    scores = np.zeros(len(given))
    scores[known] = np.array([quantile(share) for share in shares])[inverse.reshape(-1)]
    return scores


def take_values(given: NDArray[np.float64], fields: NDArray[np.float64], rows: NDArray[np.int64]) -> None:
    """Replace these rows of each column by the given values, in the order of the column."""
    ordered = np.sort(given)
    for column in fields.T:
        column[rows[np.argsort(column[rows], kind="stable")]] = ordered
