# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Scales of data: fwhm, scale-filter, spectrum."""
from __future__ import annotations

import numpy as np

from .. import estimate_fwhm
from .. import scale_filter as separate
from .. import spectrum as measure
from .._surface import place
from . import common, inputs
from .report import number, number_text
from .stages import change_data, panels_of_missing, read, require_known


def add_fwhm(commands):
    parser = commands.add(
        "fwhm", fwhm,
        "Estimate the smoothness of noise: the full width at half maximum of the Gaussian that "
        "would make white noise as smooth as these maps. DATA must be residuals, without "
        "anatomy.", ["lh.pial residuals.mgh --json"])
    common.surface_and_data(parser)
    common.region_and_columns(parser)


def fwhm(arguments, report):
    with report.timed("read"):
        _, data, columns, patches = read(arguments)
    for patch in patches:
        known = ~(patch.excluded | np.isnan(patch.values).any(axis=1))
        with report.timed("compute"):
            result = estimate_fwhm(patch.surface.solver, patch.values, mask=~known)
        entry = {"surface": patch.surface.path, "structure": patch.part.structure,
                 "pooled": number(result.pooled),
                 "columns": [{"name": data.names[c], "fwhm": number(width)}
                             for c, width in zip(columns, result.columns)]}
        report.facts.setdefault("surfaces", []).append(entry)
        where = f"{patch.part.structure}: " if len(patches) > 1 else ""
        for column, row in zip(columns, entry["columns"]):
            if len(columns) > 1:
                report.say(f"{where}{column + 1} {row['name']}: {number_text(row['fwhm'])}")
        report.say(f"{where}FWHM {number_text(entry['pooled'])}")


def add_scale_filter(commands):
    parser = commands.add(
        "scale-filter", scale_filter,
        "Filter data by scale: a third is left of waves of WAVELENGTH, more of longer ones and less of "
        "shorter ones. The integral over the surface is kept. Missing values stay missing, and nothing "
        "flows across them, as at the coast of an ocean.",
        ["ocean.vtp height.npy 200 large.vtp --order 2",
         "lh.white lh.thickness 40 lh.thickness.large --cortex"])
    common.surface_and_data(parser)
    common.wavelength(parser, "wavelength")
    common.output(parser)
    common.order(parser, 1)
    common.region_and_columns(parser)
    common.faces(parser)


def scale_filter(arguments, report):
    report.facts.update(wavelength=arguments.wavelength, order=arguments.order)

    def compute(surface, values, mask, progress, **_):
        return separate(surface, values, arguments.wavelength, order=arguments.order,
                        on_faces=arguments.faces, mask=_at_place(arguments, mask), progress=progress)

    change_data(arguments, report, "Scales", compute, panels_of_missing,
                say=lambda _: f"wavelength {arguments.wavelength:g}")


def add_spectrum(commands):
    parser = commands.add(
        "spectrum", spectrum,
        "Print the variance of data between scales: what scale-filter takes away as its wavelength grows "
        "from each WAVELENGTH to the next.", ["ocean.vtp height.npy 50 100 200 400 800"])
    common.surface_and_data(parser)
    common.wavelength(parser, "wavelengths", ", ascending", "+")
    common.order(parser, 2)
    common.region_and_columns(parser)
    common.faces(parser)


def spectrum(arguments, report):
    with report.timed("read"):
        _, data, columns, patches = read(arguments)
    rows = report.facts.setdefault("spectra", [])
    report.facts.update(wavelengths=arguments.wavelengths, order=arguments.order)
    if (np.diff(arguments.wavelengths) <= 0).any():
        raise inputs.ArgumentProblem("the WAVELENGTHs are not ascending; allowed: ascending numbers")
    bounds = ["0", *(f"{length:g}" for length in arguments.wavelengths), "infinity"]
    for patch in patches:
        solver = inputs.make_solver(arguments, patch.surface, None)
        for i, column in enumerate(columns):
            require_known(patch, [i], data, columns)
            with report.timed("compute"):
                found = measure(solver, patch.values[:, i].astype(float), arguments.wavelengths,
                                order=arguments.order, on_faces=arguments.faces,
                                mask=_at_place(arguments, patch.excluded_of(i)))
            rows.append({"name": data.names[column], "structure": patch.part.structure,
                         "variance": [number(value) for value in found.variance]})
            report.say(f"{column + 1} {data.names[column]}:")
            for low, high, value in zip(bounds, bounds[1:], found.variance):
                report.say(f"  {low} to {high}: {value:.4g}")


def _at_place(arguments, mask):
    """The mask, at faces if the data are there."""
    return mask if mask is None else place(mask, arguments.faces)
