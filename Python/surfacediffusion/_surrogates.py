# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surrogates of maps: random maps with the values and the smoothness of a given one."""

from __future__ import annotations

import math
from typing import Any, Callable, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._fans import as_one_surface, fans
from ._fields import (
    STREAM, areas_of, as_count, draw_fields, find_bands, leave_out_missing, make_fields,
)
from ._parcels import Parcels
from ._ranks import check_known, check_varies, normal_scores, take_values
from ._run import Progress, ProgressReporter, part_of
from ._settings import as_integer
from ._surface import SurfaceLike, as_data, find_on_faces, left_out, place, require_shape

__all__ = ["Surrogates", "surrogates"]

#: Fields with which the variances of scales are measured: the most, drawn at once, and the least.
_SAMPLE, _FEWEST = 64, 8

#: Independent parts in all fields of a width, from which on fewer fields will do: variances within 5 %.
_PARTS = 1024

#: Numbers in maps that are filtered together: 64 MB.
_LARGEST = 1 << 23

# The numbers of the fields of one width of surrogates begin at a multiple of STREAM, and those of the sample
# halfway to the next multiple.


class Surrogates(NamedTuple):
    """Surrogates of a map, and the model of its smoothness."""

    values: NDArray[np.float64]  #: (points, n), (faces, n) or (parcels, n), one surrogate per column
    fwhm: NDArray[np.float64]  #: (k,), the widths of the model, in coordinates; 0: without correlation
    variances: NDArray[np.float64]  #: (k,), the share of each width in the variance of the normal scores


def surrogates(
    surface: SurfaceLike | tuple[SurfaceLike, SurfaceLike],
    values: ArrayLike,
    n: int = 1000,
    *,
    labels: ArrayLike | None = None,
    on_faces: bool | None = None,
    seed: int = 0,
    mask: ArrayLike | None = None,
    roi: ArrayLike | None = None,
    progress: Progress = None,
) -> Surrogates:
    """Draw surrogates of a map: random maps that have its values, each as often, and its smoothness, but
    nothing else in common with it. The correlations of another map with them are the distribution
    without a relation, which neighbours that are alike make wider than that of independent values.

    The normal scores of the map are taken as a sum of random fields of widths 2 h, 4 h, ... up to
    three times the root of the area, and of values without correlation. The variances of these are
    found such that, on average, the sum has the variances of the map between scales, as
    :func:`spectrum` measures them, by nonnegative least squares. A surrogate is such a sum, whose
    values are replaced by those of the map by their ranks.

    With `labels`, the map has a value per parcel, and the fields are averaged over the parcels by area. Their
    variances, of widths from half the size of a parcel on, are those for which the normal scores of the
    map are likeliest (restricted maximum likelihood), with the exact covariances of the means.

    Parameters
    ----------
    surface : Surface or tuple (points, faces), or a tuple of two of these
        The surface, or both hemispheres of a brain (left, right), whose fields are independent of each other.
        Points, and faces, are then those of the left one, followed by those of the right one.
    values : array_like, shape (n,) or (m,), or (k,) with labels
        The map, at points, at faces, or a value per parcel in ascending order of the labels. NaN, such as in
        the medial wall, is left out, and is NaN in the surrogates.
    n : int, 1 or more, default 1000
        The number of surrogates.
    labels : array_like of int, shape (n,), optional
        The number of the parcel of each point; 0: in none, but the fields go through there.
    on_faces : bool, optional
        Whether `values` are at faces. Default: whether there are as many as faces, and not as points.
    seed : int, default 0
        Of the random numbers. Surrogates of different maps that enter one test need different seeds.
    mask : array_like, shape (n,) or (m,), optional
        Nonzero leaves a point with its faces, or a face, out.
    roi : array_like, shape (n,) or (m,), optional
        The region of interest, the opposite of a mask and in place of one.
    progress : bool or callable, optional
        As for :func:`heat`.

    Returns
    -------
    Surrogates
        `values` (points, n), (faces, n) or (parcels, n), and the model: `fwhm` (k,) and `variances` (k,). Points
        without a face that is left, of points with known values, are NaN, too, and their values are not in the
        surrogates.

    Notes
    -----
    In simulations with 100 x 100 independent maps on a sphere of 642 points (Gaussian of FWHM 0.6 of the radius,
    Matern's with range 0.8, a mixture of two widths with noise), tests at 5 % by 99 surrogates have found
    5.9, 5.7 and 6.3 % of the pairs to be related, and those with the true model 5.7, 5.8 and 5.8 %; with a third
    of the points missing 6.2, 6.0 and 6.6 %, and 5.4, 5.4 and 6.0 %; over 100 parcels
    4.4, 5.0 and 5.0 %, and 5.1, 5.1 and 5.0 %. Maps that
    are as smooth as the surface is large have few independent parts, and no model can be found well: on a
    cap of a sphere whose root of the area is 2 radii, 9 to 10 % at FWHM 1 and 1.6 of the radius.

    The surface stays as it is and no matrix of distances is made: time and memory grow with the number
    of points, and with parcels with that of points times parcels, for the first map of a Surface.

    References
    ----------
    J. Burt, M. Helmer, M. Shinn, A. Anticevic, J. Murray, Generative modeling of brain maps with
    spatial autocorrelation, NeuroImage 220, 2020, where maps are compared by variograms.

    Examples
    --------
    >>> import numpy as np
    >>> from surfacediffusion import random_field, sphere, surrogates
    >>> surface = sphere(4, radius=100.0)
    >>> x, y = random_field(surface, 2, fwhm=60.0).T
    >>> null = surrogates(surface, x, 199).values
    >>> found = abs(np.corrcoef(x, y)[0, 1])
    >>> smaller = [abs(np.corrcoef(s, y)[0, 1]) < found for s in null.T]
    >>> bool(1 - np.mean(smaller) > 0.05)  # not significant
    True
    >>> bool((np.sort(null[:, 0]) == np.sort(x)).all())
    True
    """
    surface = as_one_surface(surface)
    n = as_count("n", n, 1)
    seed = as_integer("seed", seed, -2**63, 2**63 - 1, "whole numbers of 64 bits")
    if labels is not None:
        return Surrogates(*Parcels(surface, values, labels, left_out(mask, roi, surface)).draw(n, seed, progress))
    of_faces = find_on_faces("values", values, surface, on_faces)
    rows = surface.n_faces if of_faces else surface.n_points
    array = as_data("values", values, rows, "face" if of_faces else "point")
    require_shape("values", values, array.shape[1] == 1, f"({rows},), one map")
    given = array[:, 0].astype(np.float64)
    check_known("values", given)
    fields = make_fields(surface, leave_out_missing(surface, left_out(mask, roi, surface), given, of_faces))
    areas = areas_of(fields, of_faces)
    known = areas > 0.0
    check_varies("values", given[known])
    drawn = fields
    if of_faces:
        fan = fans(surface)
        drawn = make_fields(fan.surface, fan.left_out(place(~known, True)))
    model = _Model(fields, areas, seed, of_faces, drawn, slice(surface.n_points if of_faces else 0, None))
    with surface._lock, ProgressReporter(progress, 2 * len(model.widths)) as reporter:
        variances = model.fit(normal_scores(given, known), reporter)
        result = model.draw(variances, n, reporter)
    take_values(given[known], result, np.flatnonzero(known))
    result[~known] = np.nan
    shares = variances * model.totals
    return Surrogates(result, np.array(model.widths), shares / shares.sum())


class _Model:
    """Sums of random fields of several widths, the last of which has no correlation."""

    def __init__(self, fields: Any, areas: NDArray[np.float64], seed: int, of_faces: bool, drawn: Any,
                 rows: slice) -> None:
        """drawn: the source of the fields, of whose points `rows` are those of the map."""
        self._fields, self._areas, self._seed, self._of_faces = fields, areas, seed, of_faces
        self._drawn, self._rows = drawn, rows
        h = fields.mean_edge_length()
        size = math.sqrt(areas.sum()) * fields.length_unit()
        self.widths = [2.0 * h]
        while 2.0 * self.widths[-1] < 3.0 * size:  # the trends of maps that are smoother than the surface
            self.widths.append(2.0 * self.widths[-1])
        self._wavelengths = [3.0 * h]
        while self._wavelengths[-1] < size:
            self._wavelengths.append(2.0 * self._wavelengths[-1])
        parts = [(size / width) ** 2 for width in self.widths]
        self._samples = [int(min(_SAMPLE, max(_FEWEST, _PARTS / count))) for count in parts] + [_FEWEST]
        self.widths.append(0.0)
        self.totals = np.ones(len(self.widths))

    def fit(self, scores: NDArray[np.float64], reporter: ProgressReporter) -> NDArray[np.float64]:
        """The variances of the fields."""
        found, maps = [], [scores[:, None]]
        for k in range(len(self.widths)):
            maps.append(self._draw(k, STREAM // 2, np.empty((len(self._areas), self._samples[k])),
                                   reporter.callable))
            # Maps of several widths share the factors of the filters, as memory allows.
            if k + 1 == len(self.widths) or sum(m.size for m in maps) > _LARGEST:
                found.append(self._bands(np.hstack(maps)))
                maps = []
            reporter.finish_part()
        self._drawn.end_sharing()
        variances = np.hstack(found)
        wanted = variances[:, 0]
        # Errors count relative to the root of the variance of their band.
        weights = 1.0 / np.sqrt(np.maximum(wanted, 1e-6 * wanted.sum()))
        parts = np.split(variances[:, 1:], np.cumsum(self._samples)[:-1], axis=1)
        bands = np.column_stack([part.mean(axis=1) for part in parts])
        self.totals = bands.sum(axis=0)  # of fields of variance 1, without their mean
        return solve_nonnegative(bands * weights[:, None], wanted * weights)

    def draw(
        self, variances: NDArray[np.float64], n: int, reporter: ProgressReporter
    ) -> NDArray[np.float64]:
        """Sums of n fields of each width, of which those with a variance are needed."""
        total = np.zeros((len(self._areas), n))
        for k in range(len(self.widths)):
            for first in np.arange(0, n if variances[k] > 0.0 else 0, _SAMPLE):
                part = np.empty((len(self._areas), min(_SAMPLE, n - int(first))))
                share = part_of(reporter.callable, first / n, part.shape[1] / n)
                total[:, first:first + part.shape[1]] += math.sqrt(variances[k]) * self._draw(
                    k, int(first), part, share)
            reporter.finish_part()
        return total

    def _draw(
        self, k: int, first: int, result: NDArray[np.float64], progress: Callable[[float], Any] | None
    ) -> NDArray[np.float64]:
        fields = np.empty((len(self._drawn.areas()), result.shape[1])) if self._of_faces else result
        draw_fields(self._drawn, self.widths[k], 0.0, self._seed, (int(k) + 1) * STREAM + first, True, fields,
                    progress, shares=True)
        if self._of_faces:
            result[:] = fields[self._rows]
        return result

    def _bands(self, maps: NDArray[np.float64]) -> NDArray[np.float64]:
        """The variances between the wavelengths, (bands, columns)."""
        return find_bands(self._fields, self._areas, maps, self._wavelengths, 1, None, self._of_faces)


def solve_nonnegative(matrix: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """x >= 0 with the smallest |matrix x - b| (C. Lawson, R. Hanson, Solving least squares problems,
    1974, chapter 23). At least one x is above 0 for nonnegative, nonzero entries."""
    n = matrix.shape[1]
    x = np.zeros(n)
    free = np.zeros(n, dtype=bool)
    scale = np.abs(matrix).sum(axis=0).max() * np.abs(b).max()
    for _ in np.arange(10 * n):
        slope = np.where(free, 0.0, matrix.T @ (b - matrix @ x))
        if slope.max() <= 1e-12 * scale:
            break
        free[np.argmax(slope)] = True
        while True:
            solved = np.zeros(n)
            solved[free] = np.linalg.lstsq(matrix[:, free], b, rcond=None)[0]
            below = free & (solved <= 0.0)
            if not below.any():
                break
            step = (x[below] / (x[below] - solved[below])).min()
            x += step * (solved - x)
            free &= x > 1e-14 * x.max()
            x[~free] = 0.0
        x = solved
    return x
