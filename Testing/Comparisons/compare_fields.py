#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures surrogates of maps, random fields and filters by scale beside other programs, and writes the
page FIELDS.md. compare_fields.sh installs what it needs and runs this program."""
from __future__ import annotations

import argparse
import datetime
import importlib.metadata
import json
import logging
import os
import platform
import resource
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import surfacediffusion as sd

HERE = Path(__file__).parent
RADIUS = 100.0

PAGE = """# Surrogate maps, random fields and scales beside other programs

This page is written by `Testing/Comparisons/compare_fields.sh`, which installs the programs and measures
them side by side. Measured on {date}:
{versions}.
Machine: {processor}, {cores} cores.

| name | call |
| --- | --- |
| SurfaceDiffusion | `surrogates(surface, map, n)` |
| brainsmash | `Base(map, distances)(n)` with geodesic distances; variograms (Burt et al., NeuroImage 220, 2020) |
| BrainSpace, Moran | `MoranRandomization(procedure="singleton", joint=True)` with inverse distances (Wagner, Dray, 2015) |
| neuromodes | `EigenSolver().solve(400).eigenstrap(map)`: rotated eigenmodes (Koussis et al., 2024) |
| the true model | independent maps of the same kind, which nobody has in practice |

## Maps without a relation that are found to be related

Pairs of independent random maps on a sphere of radius 100 with {points} points; `p` is the share of {count}
surrogates of the first map whose correlation with the second is at least that of the map itself. The
columns are the kinds of maps: {kinds}. In the last column the first map is the cortical thickness of
fsaverage5, and the others are random fields of FWHM 20 mm on its white surface. The numbers are the percentage of
pairs with p <= 5 %, with the interval in which 95 % of such counts are found if that is the true share: 5 % of
{pairs} pairs is {interval}.

{rates}

## Seconds and memory

Of {drawn} surrogates of one map, with all that has to be prepared, in a process of its own; the memory is the
largest of that process. brainsmash and Moran's method need all distances, whose number is the square of that
of the points: 8.4 GB in double precision at 32,492 points. Sizes that take many minutes were left out.

{seconds}

1,000 random fields of FWHM 10 on an icosphere of 40,962 points and radius 100, with the variance 1 at each
point: {fields}.

## Scales

The filter (1 + 2 (-Laplace / k^2)^n) u = f on an icosphere of 655,362 points, with 2 / k^2 = 1e4 h^2 for n = 1.
Conjugate gradients with the diagonal as preconditioner are what implicit filters elsewhere use (K. Nowak et al.,
Geosci. Model Dev. 18, 2025); here they are those of this library, on the same matrix and to the same tolerance.

{scales}

A zonal harmonic of degree 12 about an axis in the equator, on a sphere of the earth's radius, and the Gaussian of
gcm-filters of 2,000 km, exp(-L^2 lambda / 24). gcm-filters works on a grid of 1 degree (64,800 points), whose
cells at the poles are 1 km wide and ask for thousands of steps; the same Gaussian by `heat(fwhm=)`, and the
implicit filter, on an icosphere of 40,962 points. The error is relative to the filtered harmonic.

{sphere}
"""


def warned(function):
    """A function without the warnings of other programs."""
    def call(*arguments):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return function(*arguments)
    return call


class Peers:
    """Each makes n surrogates of a map, (n, points). Matrices of the surface are made once."""

    def __init__(self, surface, region=None):
        self.surface = surface
        self.region = np.ones(surface.n_points, dtype=bool) if region is None else region
        self._distances = self._moran = self._modes = None

    def _all_distances(self):
        if self._distances is None:
            rows = np.flatnonzero(self.region)
            full = sd.distances(self.surface, rows).toarray()[:, rows]
            self._distances = 0.5 * (full + full.T)
        return self._distances

    def SurfaceDiffusion(self, values, n, seed):
        mask = None if self.region.all() else ~self.region
        return sd.surrogates(self.surface, values, n, seed=seed, mask=mask).values[self.region].T

    @warned
    def brainsmash(self, values, n, seed):
        from brainsmash.mapgen.base import Base
        return np.atleast_2d(Base(values[self.region], self._all_distances(), resample=True, seed=seed)(n))

    @warned
    def Moran(self, values, n, seed):
        from brainspace.null_models import MoranRandomization
        if self._moran is None:
            distances = self._all_distances().copy()
            np.fill_diagonal(distances, 1.0)
            weights = 1.0 / distances
            np.fill_diagonal(weights, 0.0)
            self._moran = MoranRandomization(procedure="singleton", joint=True, n_rep=n, tol=1e-6)
            self._moran.fit(weights)
        self._moran.random_state, self._moran.n_rep = seed, n
        return self._moran.randomize(values[self.region])

    @warned
    def neuromodes(self, values, n, seed):
        from neuromodes.eigen import EigenSolver
        if self._modes is None:
            from lapy import TriaMesh
            mesh = TriaMesh(self.surface.points, self.surface.triangles)
            count = min(400, int(self.region.sum()) // 2)
            self._modes = EigenSolver(mesh, None if self.region.all() else self.region).solve(count)
        found = np.asarray(self._modes.eigenstrap(values[self.region], n_nulls=n, seed=seed))
        return found if found.shape[0] == n else found.T


NAMES = ("SurfaceDiffusion", "brainsmash", "Moran", "neuromodes")
#: brainsmash takes half a minute for 100 surrogates at 642 points: too long for hundreds of maps.
WITH_RATES = ("SurfaceDiffusion", "Moran", "neuromodes")
#: The largest level of the icosphere with which each is timed; time or memory forbids the next.
LARGEST = {"SurfaceDiffusion": 6, "brainsmash": 3, "Moran": 4, "neuromodes": 6}

KINDS = {
    "FWHM 60": lambda surface, n, seed: sd.random_field(surface, n, fwhm=60.0, seed=seed),
    "Matern, nu = 1, range 80": lambda surface, n, seed: sd.random_field(surface, n, range=80.0, seed=seed),
    "FWHM 80, 35 and noise": lambda surface, n, seed: (
        sd.random_field(surface, n, fwhm=80.0, seed=seed)
        + 0.7 * sd.random_field(surface, n, fwhm=35.0, seed=seed + 500)
        + 0.4 * np.random.default_rng(seed).normal(size=(surface.n_points, n))),
}


def correlations(null, values):
    null = null - null.mean(axis=1, keepdims=True)
    values = values - values.mean()
    return null @ values / np.linalg.norm(null, axis=1) / np.linalg.norm(values)


def share(found, null):
    return (1 + (np.abs(null) >= abs(found)).sum()) / (1 + len(null))


def measure_rates(pairs, count):
    """The percentages of pairs with p <= 5 %, by program and kind."""
    surface = sd.sphere(3, RADIUS)
    rates = {}
    for kind, make in KINDS.items():
        first, second = make(surface, pairs, 1), make(surface, pairs, 2)
        peers = Peers(surface)
        for name in WITH_RATES:
            p = []
            for k in range(pairs):
                null = getattr(peers, name)(first[:, k].copy(), count, 1000 + k)
                found = np.corrcoef(first[:, k], second[:, k])[0, 1]
                p.append(share(found, correlations(null, second[:, k])))
            rates[name, kind] = 100.0 * np.mean(np.array(p) <= 0.05)
            print(name, kind, rates[name, kind], flush=True)
        truth = make(surface, count, 3).T
        p = [share(np.corrcoef(first[:, k], second[:, k])[0, 1], correlations(truth, second[:, k]))
             for k in range(pairs)]
        rates["the true model", kind] = 100.0 * np.mean(np.array(p) <= 0.05)
    return rates, surface.n_points


def measure_thickness(pairs, count):
    """The same of the thickness of fsaverage5 with random fields."""
    from surfaces import _fsaverage5
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        sample = _fsaverage5(Path(folder))
    surface = sd.Surface(sample.points, sample.faces)
    thickness, region = sample.maps["thickness"], sample.region
    others = sd.random_field(surface, pairs, fwhm=20.0, mask=~region, seed=9)[region]
    peers, rates = Peers(surface, region), {}
    for name in ("SurfaceDiffusion",):  # neuromodes takes manifolds alone, and the others all distances
        null = getattr(peers, name)(thickness.copy(), count, 5)
        p = [share(np.corrcoef(thickness[region], other)[0, 1], correlations(null, other))
             for other in others.T]
        rates[name] = 100.0 * np.mean(np.array(p) <= 0.05)
        print(name, "thickness", rates[name], flush=True)
    return rates


def run_alone(name, level, count):
    """Seconds and MiB of surrogates in a process of its own."""
    done = subprocess.run([sys.executable, __file__, "--alone", name, str(level), str(count)],
                          check=True, capture_output=True, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def alone(name, level, count):
    surface = sd.sphere(level, RADIUS)
    values = sd.random_field(surface, 1, fwhm=40.0, seed=1)[:, 0]
    start = time.perf_counter()
    if name == "fields":
        sd.random_field(surface, count, fwhm=10.0, seed=2)
    else:
        getattr(Peers(surface), name)(values, count, 3)
    print(json.dumps([time.perf_counter() - start,
                      resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024]))


def measure_scales():
    """Seconds of filters by scale."""
    surface = sd.sphere(8, RADIUS)
    values = sd.random_field(surface, 1, fwhm=5.0, normalize=False)[:, 0]
    edges = surface.points[surface.triangles[:, 0]] - surface.points[surface.triangles[:, 1]]
    h = np.linalg.norm(edges, axis=1).mean()
    step = 1e4 * h**2
    wavelength = 2.0 * np.pi * np.sqrt(step / 2.0)
    seconds = {}
    for name, run in (
            ("`scale_filter(order=1)`", lambda: sd.scale_filter(surface, values, wavelength)),
            ("`scale_filter(order=2)`", lambda: sd.scale_filter(surface, values, wavelength, order=2)),
            ("conjugate gradients, order 1", lambda: sd.heat(
                surface, values, time_step=step, number_of_time_steps=1, units="absolute",
                time_integrator="first_order", solver="ConjugateGradient",
                maximum_number_of_iterations=100000))):
        start = time.perf_counter()
        run()
        seconds[name] = time.perf_counter() - start
        print(name, seconds[name], flush=True)
    return seconds


def measure_sphere():
    """Seconds and relative errors of filters of a harmonic."""
    import gcm_filters
    import xarray

    radius, degree, length, n = 6371.0, 12, 2000.0, 180
    eigenvalue = degree * (degree + 1) / radius**2
    coefficients = np.eye(degree + 1)[degree]
    latitude = np.radians((np.arange(n) + 0.5) * 180 / n - 90)[:, None]
    longitude = np.radians((np.arange(2 * n) + 0.5) * 180 / n)[None]
    south = np.radians(np.arange(n) * 180 / n - 90)[:, None]
    size, ones = radius * np.pi / n, np.ones((n, 2 * n))
    values = np.polynomial.legendre.legval(np.cos(latitude) * np.cos(longitude), coefficients)
    area = size**2 * np.cos(latitude) * ones
    grid = {"wet_mask": ones, "dxw": size * np.cos(latitude) * ones, "dyw": size * ones,
            "dxs": np.maximum(size * np.cos(south), 1e-6) * ones, "dys": size * ones, "area": area,
            "kappa_w": ones, "kappa_s": ones}
    found = {}

    def add(name, run, given, areas, factor):
        start = time.perf_counter()
        result = run()
        error = areas * (result - factor * given) ** 2
        found[name] = (time.perf_counter() - start,
                       np.sqrt(error.sum() / (areas * given**2).sum()) / factor)
        print(name, found[name], flush=True)

    def filtered():
        made = gcm_filters.Filter(
            filter_scale=length, dx_min=float(grid["dxw"].min()),
            filter_shape=gcm_filters.FilterShape.GAUSSIAN,
            grid_type=gcm_filters.GridType.IRREGULAR_WITH_LAND,
            grid_vars={name: xarray.DataArray(array, dims=("y", "x")) for name, array in grid.items()})
        return made.apply(xarray.DataArray(values, dims=("y", "x")), dims=["y", "x"]).values

    gaussian = np.exp(-length**2 * eigenvalue / 24)
    add("gcm-filters, 1 degree", warned(filtered), values, area, gaussian)
    surface = sd.sphere(6, radius)
    given = np.polynomial.legendre.legval(surface.points[:, 0] / radius, coefficients)
    areas = np.array(surface.vertex_areas)
    add("`heat(fwhm=)`", lambda: sd.heat(surface, given, fwhm=length * np.sqrt(8 * np.log(2) / 12)), given,
        areas, gaussian)
    for order in (1, 2):
        factor = 1 / (1 + 2 * (eigenvalue * (length / (2 * np.pi)) ** 2) ** order)
        add(f"`scale_filter(order={order})`",
            lambda order=order: sd.scale_filter(surface, given, length, order=order), given, areas, factor)
    return found


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(str(entry) for entry in line) + " |" for line in lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pairs", type=int, default=400, help="pairs of maps (default 400)")
    parser.add_argument("--surrogates", type=int, default=99, help="of each map (default 99)")
    parser.add_argument("--alone", nargs=3, metavar=("NAME", "LEVEL", "COUNT"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    logging.disable(logging.WARNING)
    if arguments.alone:
        name, level, count = arguments.alone
        alone(name, int(level), int(count))
        return
    pairs, count, drawn = arguments.pairs, arguments.surrogates, 100
    seconds = {(name, level): run_alone(name, level, drawn)
               for name in NAMES for level in range(3, LARGEST[name] + 1)}
    print(seconds, flush=True)
    fields = run_alone("fields", 6, 1000)
    scales, sphere = measure_scales(), measure_sphere()
    rates, points = measure_rates(pairs, count)
    thickness = measure_thickness(pairs, 1000)
    spread = 100.0 * 1.96 * np.sqrt(0.05 * 0.95 / pairs)
    rows = [[name, *(f"{rates[name, kind]:.1f}" for kind in KINDS),
                  f"{thickness[name]:.1f}" if name in thickness else "-"] for name in (*WITH_RATES, "the true model")]
    levels = {3: "642", 4: "2,562", 5: "10,242", 6: "40,962"}
    page = PAGE.format(
        date=datetime.date.today(), processor=platform.machine(), cores=os.cpu_count(), points=points,
        versions=", ".join(f"{name} {importlib.metadata.version(name)}" for name in (
            "surfacediffusion", "brainsmash", "brainspace", "neuromodes", "gcm_filters", "numpy", "scipy")),
        count=count, pairs=pairs, kinds="; ".join(KINDS), interval=f"{5 - spread:.1f} to {5 + spread:.1f} %",
        drawn=drawn, rates=table(["program", *KINDS, "thickness"], rows),
        seconds=table(["program", *(f"{n} points" for n in levels.values())], [
            [name, *("-" if (name, level) not in seconds else
                     "{:.3g} s, {:.0f} MiB".format(*seconds[name, level]) for level in levels)]
            for name in NAMES]),
        fields="{:.3g} s, {:.0f} MiB".format(*fields),
        scales=table(["method", "seconds"], [[name, f"{value:.3g}"] for name, value in scales.items()]),
        sphere=table(["method", "seconds", "error"], [
            [name, f"{value:.3g}", f"{100 * error:.2g} %"] for name, (value, error) in sphere.items()]))
    (HERE / "FIELDS.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
