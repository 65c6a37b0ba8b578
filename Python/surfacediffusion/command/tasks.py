# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The commands: each reads its files, calls a function of the package, and writes the result."""
from __future__ import annotations

import io
import math

import numpy as np

from .._run import part_of
from ..files import FileError, new_data, read_data, read_surface
from ..files.content import (
    check_output_folder, check_output_name, kind_of_name, read_content)
from ..files.export import export
from . import batch, inputs
from .inputs import choose_columns, make_patches, read_surfaces
from .printing import PATTERNS, in_coordinates, is_for_printing, print_texture
from .report import number

SIGMA_TO_FWHM = math.sqrt(8 * math.log(2))


def smooth(arguments, report):
    batch.run(arguments, report, _smooth_file)


def _smooth_file(arguments, report):
    from .. import heat, smooth_to_fwhm

    width = arguments.width * (SIGMA_TO_FWHM if arguments.sigma else 1)
    report.facts.update(fwhm=width, sigma=width / SIGMA_TO_FWHM, steps=arguments.steps)
    content = read_content(arguments.data)
    if content.kind == "cifti" and not arguments.to_fwhm:
        _smooth_cifti(arguments, report, content, width)
        return
    if arguments.residuals and not arguments.to_fwhm:
        raise inputs.ArgumentProblem("--residuals without --to-fwhm; allowed: both")

    def compute(surface, values, mask, progress):
        return heat(surface, values, on_faces=arguments.faces, mask=mask, mask_mode="Exclude",
                    fwhm=width, number_of_time_steps=arguments.steps, progress=progress)

    def reach(surface, values, mask, progress):
        noise = _read_noise(arguments, values, mask)
        return smooth_to_fwhm(surface, values, width, residuals=noise, mask=mask)

    if arguments.to_fwhm:
        if arguments.faces:
            raise inputs.ArgumentProblem("--to-fwhm with --faces; allowed: data at vertices")
        _change_data(arguments, report, "Smoothing", reach, _one_group, content=content,
                     say=lambda surface: "smoothed to " + _width_text(width, surface))
        return
    _change_data(arguments, report, "Smoothing", compute, _groups_of_missing,
                 say=lambda surface: _width_text(width, surface), content=content)


def cifti_smoothing(arguments, report):
    arguments.volume_fwhm = arguments.volume_kernel * (SIGMA_TO_FWHM if arguments.sigma else 1)
    if not arguments.width and not arguments.volume_kernel:
        raise inputs.ArgumentProblem("SURFACE_KERNEL and VOLUME_KERNEL are 0; allowed: one above 0")
    content = read_content(arguments.data)
    if content.kind != "cifti":
        raise content.error(f"a {content.name} file; allowed: CIFTI (.dscalar.nii, .dtseries.nii)")
    width = arguments.width * (SIGMA_TO_FWHM if arguments.sigma else 1)
    report.facts.update(fwhm=width, sigma=width / SIGMA_TO_FWHM, steps=arguments.steps)
    _smooth_cifti(arguments, report, content, width)


def _one_group(data, columns, patch):
    """The noise of all columns has one smoothness."""
    return [list(range(len(columns)))]


def _read_noise(arguments, values, mask):
    """The columns of --residuals on the surface of `values`; None without."""
    if arguments.residuals is None:
        return None
    surfaces = read_surfaces(arguments)
    noise = read_data(arguments.residuals)
    if len(noise.parts) > 1 or len(surfaces) > 1:
        raise inputs.ArgumentProblem("--residuals with several surfaces; allowed: one SURFACE")
    (surface,) = surfaces.values()
    found, absent = inputs.on_surface(noise.parts[0], noise.parts[0].values, surface, noise)
    found = np.where(absent[:, None], np.nan, found)
    return found if mask is None else np.where(mask[:, None], np.nan, found)


def _smooth_cifti(arguments, report, content, width):
    """Surfaces and voxels; the width of these may be another one."""
    from . import grayordinates

    voxel_width = width if arguments.volume_fwhm is None else arguments.volume_fwhm
    columns = grayordinates.smooth(arguments, report, content, width, voxel_width)
    what = (f"{len(columns)} column{'s' * (len(columns) > 1)}, FWHM {width:.3g} mm (sigma "
            f"{width / SIGMA_TO_FWHM:.3g})")
    voxels = report.facts["voxels"]
    if voxels:
        what += f", {voxels} voxels" + (f" FWHM {voxel_width:.3g} mm" if voxel_width != width else "")
    _say_written(arguments, report, what)


def _width_text(fwhm, surface):
    """The formats of brains are in millimetres, other meshes in any unit."""
    unit = " mm" if surface.kind in ("gifti", "freesurfer") else ""
    return f"FWHM {fwhm:.3g}{unit} (sigma {fwhm / SIGMA_TO_FWHM:.3g})"


def denoise(arguments, report):
    from .. import intrinsic_tv_steps

    options = {"fidelity_weight": arguments.weight} if arguments.weight else {
        "automatic_fidelity": True, "noise_level": arguments.noise or 0.0}
    model = {"rgb": "RGB", "opponent": "Opponent",
             "chromaticity": "ChromaticityBrightness"}[arguments.colors]
    found = []
    weights = report.facts.setdefault("fidelity_weights", [])

    def compute(surface, values, mask, progress):
        found.append(values.shape[1] == 3)
        result = intrinsic_tv_steps(
            surface, values, on_faces=arguments.faces, mask=mask, mask_mode="Exclude", mode="SteadyState",
            color_model=model if found[-1] else "RGB", progress=progress, **options).last()
        weights.append(number(result.effective_fidelity_weight))
        return result.values

    _change_data(arguments, report, "Denoising", compute, _groups_of_arrays)
    if arguments.colors != "rgb" and not any(found):
        report.warn(f"--colors is {arguments.colors}, but {arguments.data} has no colours")


def denoise_mesh(arguments, report):
    from .. import Surface
    from .. import denoise_mesh as remove_noise

    surface = _read_surface_for_output(arguments, report)
    check_output_name(arguments.output, surface.kind)
    options = {"noise_level": arguments.noise or 0.0,
               "surface_type": {"cad": "CAD"}.get(arguments.type, arguments.type.capitalize()),
               "merge_coincident_points": arguments.merge}
    if arguments.fixed is not None:
        with report.timed("read"):
            options["fixed"] = dict(inputs.read_marks(arguments.fixed, {"": surface}))[id(surface)]
    with report.timed("compute"), report.progress("Denoising") as progress:
        result = remove_noise(Surface(surface.points, surface.faces), progress=progress, **options)
    _write_points(arguments, report, surface, result.points)
    for name in ("noise_level", "correlation_length", "mean_displacement", "maximum_displacement",
                 "volume_before", "volume_after", "mean_edge_length"):
        report.facts[name] = number(getattr(result, name))
    report.facts["surface_type"] = result.surface_type
    _say_written(arguments, report,
                 f"{_denoising_text(result)}{_normals_text(report)}")


def _denoising_text(result):
    if result.maximum_displacement == 0:
        return "no noise was found, no point moved" if result.noise_level == 0 else "no point moved"
    kind = {"Automatic": "CAD and Organic parts"}.get(result.surface_type, result.surface_type)
    correlated = (f", correlated over {result.correlation_length:.4g}"
                  if result.correlation_length > 0 else "")
    return (f"{kind}, noise {result.noise_level:.4g}{correlated}, points moved by "
            f"{result.mean_displacement:.4g} on average, at most {result.maximum_displacement:.4g}")


def inpaint(arguments, report):
    from .. import heat, intrinsic_tv

    model = {"heat": heat, "tv": intrinsic_tv}[arguments.model]
    report.facts["model"] = arguments.model

    def compute(surface, values, mask, progress):
        if not np.isnan(values).any():
            return values
        return model(surface, values, on_faces=arguments.faces, mask=mask, mask_mode="Exclude",
                     mode="SteadyState", hold_known_values=True, progress=progress)

    groups = _groups_of_missing if arguments.model == "heat" else _groups_of_arrays
    _change_data(arguments, report, "Inpainting", compute, groups, arguments.missing)
    if not any(row["missing"] for row in report.facts["columns"]):
        report.warn(f"{arguments.data}: nothing is missing, the values are unchanged")


def interpolate(arguments, report):
    from .. import Surface
    from .. import interpolate as fit

    surface = _read_surface_for_output(arguments, report)
    if arguments.error is not None:
        check_output_folder(arguments.error)
    with report.timed("read"):
        places, values, names = inputs.read_values(arguments.values, surface)
    target = new_data(surface, arguments.output, names)
    errors = new_data(surface, arguments.error, names) if arguments.error else None
    options = {"exact": arguments.exact, "noise_level": arguments.noise or 0.0,
               "correlation_length": arguments.length or 0.0,
               "boundary": "Free" if arguments.free else "Natural",
               "keep_range": arguments.keep_range, "maximum_distance": arguments.within or 0.0,
               "compute_error": errors is not None}
    if arguments.smoothing:
        options["smoothing"] = arguments.smoothing
    with report.timed("compute"), report.progress("Interpolation") as progress:
        result = fit(Surface(surface.points, surface.faces), values, places, progress=progress,
                     **options)
    rows = zip(result.smoothing, result.misfit, result.degrees_of_freedom, result.noise_level)
    report.facts.update(
        values=result.number_of_values, far_values=result.number_of_far_values,
        columns=[{"name": name, "smoothing": number(mu), "misfit": number(misfit),
                  "degrees_of_freedom": number(freedom), "noise": number(noise)}
                 for name, (mu, misfit, freedom, noise) in zip(names, rows)])
    with report.timed("write"):
        target.save(arguments.output, [result.values.astype(np.float32)])
        if errors is not None:
            errors.save(arguments.error, [result.error.astype(np.float32)])
    _say_written(arguments, report, f"{result.number_of_values} values, misfit "
                 + ", ".join(f"{misfit:.4g}" for misfit in result.misfit))


def enhance(arguments, report):
    from .. import tensor_diffusion

    options = {"time_step": arguments.time / arguments.steps,
               "number_of_time_steps": arguments.steps,
               "model": {"lines": "CoherenceEnhancing", "edges": "EdgeEnhancing",
                         "beltrami": "Beltrami"}[arguments.model]}
    if arguments.contrast and arguments.model == "beltrami":
        options["color_scale"] = 1 / arguments.contrast
    elif arguments.contrast:
        options["contrast"] = arguments.contrast
    if arguments.scale is not None:
        if arguments.model != "lines":
            raise FileError(f"--scale is {arguments.scale:g}; allowed: with --model lines")
        options["integration_scale"] = arguments.scale
    report.facts.update(model=arguments.model, time=arguments.time, steps=arguments.steps)

    def compute(surface, values, mask, progress):
        return tensor_diffusion(surface, values, mask=mask, mask_mode="Exclude", progress=progress,
                                **options)

    _change_data(arguments, report, "Enhancing", compute, _groups_of_arrays)


def edges(arguments, report):
    from .. import mumford_shah

    options = {name: value for name, value in (
        ("edge_threshold", arguments.threshold), ("smoothing_length", arguments.length),
        ("edge_width", arguments.width), ("noise_level", arguments.noise)) if value}
    for name in (arguments.map, arguments.curves):
        if name is not None:
            check_output_folder(name)
    if arguments.curves is not None and kind_of_name(arguments.curves) != "npy":
        raise FileError(f"{arguments.curves}: the name announces no format for curves; allowed: .npy")
    if (arguments.map or arguments.curves) and not arguments.surface:
        raise FileError("--map and --curves need one surface; allowed: without --left and --right")
    maps, curves = [], []

    def compute(surface, values, mask, progress):
        result = mumford_shah(surface, values, mask=mask, mask_mode="Exclude", progress=progress,
                              **options)
        maps.append(result.edges)
        curves.extend(result.curves)
        report.facts["edge_length"] = number(
            (report.facts.get("edge_length") or 0.0) + result.edge_length)
        return result.values

    _change_data(arguments, report, "Edges", compute, _groups_of_arrays)
    report.facts["curves"] = len(curves)
    report.say(f"{len(curves)} edge{'s' * (len(curves) != 1)} of length "
               f"{report.facts['edge_length']:.4g}")
    with report.timed("write"):
        if arguments.map is not None:
            target = new_data(read_surface(arguments.surface), arguments.map,
                              [f"Edges{k + 1}" for k in range(len(maps))])
            target.save(arguments.map, [np.column_stack(maps).astype(np.float32)])
        if arguments.curves is not None:
            _write_curves(arguments.curves, curves)


def _write_curves(path, curves):
    """Rows of the number of the curve and the coordinates."""
    from ..files import write_atomically

    rows = [np.column_stack([np.full(len(curve), k), curve]) for k, curve in enumerate(curves)]
    file = io.BytesIO()
    np.save(file, np.concatenate(rows) if rows else np.empty((0, 4)))
    write_atomically(path, file.getvalue())


def segment(arguments, report):
    from .. import segment as find_regions

    options = {"number_of_regions": arguments.regions}
    if arguments.weight:
        options["fidelity_weight"] = arguments.weight
    if arguments.means:
        options.update(means=arguments.means, number_of_regions=len(arguments.means))
    found = report.facts.setdefault("segmentations", [])

    def compute(surface, values, mask, progress):
        result = find_regions(surface, values, mask=mask, mask_mode="Exclude", seed=arguments.seed,
                              progress=progress, **options)
        rows = [{"region": k + 1, "area": number(result.areas[k]),
                 "boundary_length": number(result.boundary_lengths[k]),
                 "components": int(result.components[k]),
                 "mean": [number(mean) for mean in result.means[k]]}
                for k in range(len(result.areas))]
        found.append({"gap": number(result.gap), "regions": rows})
        return np.repeat(result.values[:, None].astype(float), values.shape[1], axis=1)

    _change_data(arguments, report, "Segmentation", compute, _groups_of_arrays)
    for entry in found:
        for row in entry["regions"]:
            report.say(f"region {row['region']}: mean {', '.join(_text(m) for m in row['mean'])}, "
                       f"area {_text(row['area'])}, boundary {_text(row['boundary_length'])}, "
                       f"{row['components']} connected")


def texture(arguments, report):
    surface = _read_surface_for_output(arguments, report)
    if is_for_printing(arguments):
        print_texture(arguments, surface, report)
        return
    target = new_data(surface, arguments.output, ["Texture"])
    from .. import Surface, turing_texture

    size = in_coordinates(arguments.size, arguments.unit)
    options = {}
    if arguments.pattern:
        options = {"diffusion_rate1": 2.6 * PATTERNS[arguments.pattern], "diffusion_rate2": 2.6}
    if arguments.kinetics:
        options["kinetics"] = arguments.kinetics
    if arguments.steps:
        options["number_of_time_steps"] = arguments.steps
    with report.timed("compute"), report.progress("Texture") as progress:
        result = turing_texture(Surface(surface.points, surface.faces), progress=progress,
                                feature_size=size, seed=arguments.seed, refine_to=0, **options)
    report.facts.update(feature_size=size, seed=arguments.seed, steps=result.step,
                        wavelength=number(result.wavelength))
    _write_new(arguments, report, target, result.texture[:, None].astype(np.float32))


def directions(arguments, report):
    from .. import Surface, direction_field
    from ..files import vtk_files, write_atomically

    kind = kind_of_name(arguments.output)
    surface = _read_surface_for_output(arguments, report)
    if kind != "npy" and not (kind in ("vtk", "vtp") and kind == surface.kind):
        raise FileError(f"{arguments.output}: the name announces no format for directions on "
                        "faces; allowed: .npy, or .vtk or .vtp as the surface")
    with report.timed("compute"), report.progress("Directions") as progress:
        field = direction_field(Surface(surface.points, surface.faces), method=arguments.method,
                                progress=progress)
    report.facts.update(method=arguments.method, faces=len(surface.faces))
    with report.timed("write"):
        if kind == "npy":
            file = io.BytesIO()
            np.save(file, field)
            write_atomically(arguments.output, file.getvalue())
        else:
            write_atomically(arguments.output, vtk_files.write(
                kind, surface.image, cell_data={"Direction": field}))
    _say_written(arguments, report, f"{len(surface.faces)} directions")


def refine(arguments, report):
    from .. import Surface
    from .. import refine as bisect
    from ..files import write_atomically

    for output in (arguments.output, *(new for _, new in arguments.data)):
        check_output_folder(output)
    for _, new in arguments.data:
        if kind_of_name(new) != "npy":
            raise FileError(f"{new}: the name announces no format for data of the new vertices; allowed: "
                            ".npy")
    with report.timed("read"):
        surface = read_surface(arguments.surface)
        columns = [inputs.read_values(path, surface, tables=False)[1] for path, _ in arguments.data]
    with report.timed("compute"), report.progress("Refinement") as progress:
        fine = bisect(Surface(surface.points, surface.faces), arguments.length, progress=progress,
                      maximum_number_of_triangles=arguments.maximum_triangles)
    report.facts.update(longest_edge=number(fine.longest_edge), vertices=fine.surface.n_points,
                        triangles=fine.surface.n_faces)
    with report.timed("write"):
        export(arguments.output, fine.surface.points, fine.surface.triangles)
        for (_, new), values in zip(arguments.data, columns):
            file = io.BytesIO()
            np.save(file, fine.at_points(values))
            write_atomically(new, file.getvalue())
    _say_written(arguments, report, f"{fine.surface.n_faces} triangles, edges of at most "
                 f"{fine.longest_edge:.4g}")


def curvature(arguments, report):
    from .. import Surface
    from .. import curvature as measure

    surface = _read_surface_for_output(arguments, report)
    target = new_data(surface, arguments.output,
                      ["mean", "gaussian", "k1", "k2", "shape_index", "curvedness"])
    with report.timed("compute"), report.progress("Curvature") as progress:
        found = measure(Surface(surface.points, surface.faces), fwhm=arguments.fwhm,
                        merge_coincident_points=arguments.merge, progress=progress)
    report.facts.update(fwhm=arguments.fwhm, mean_edge_length=number(found.mean_edge_length),
                        mean_curvature=number(found.mean.mean()))
    values = np.column_stack([found.mean, found.gaussian, found.principal, found.shape_index,
                              found.curvedness])
    _write_new(arguments, report, target, values.astype(np.float32))


def derivatives(arguments, report):
    from .. import Surface, conduction_velocity
    from .. import derivatives as derive

    surface = _read_surface_for_output(arguments, report)
    with report.timed("read"):
        _, values, names = inputs.read_values(arguments.data, surface, tables=False)
    word = arguments.quantity.capitalize()
    options = {"on_faces": False, "smoothing_fwhm": arguments.fwhm}
    with report.timed("compute"), report.progress(word) as progress:
        solver = Surface(surface.points, surface.faces)
        if arguments.quantity == "velocity":
            result = np.column_stack(conduction_velocity(solver, values, progress=progress, **options))
        else:
            result = derive(solver, values, quantity=word, progress=progress, **options)
    if arguments.quantity in ("gradient", "velocity"):
        columns = [f"{name} {axis}" for name in names for axis in "xyz"]
    elif arguments.quantity == "laplacian":
        columns = list(names)
    else:
        columns = list(names[::3])
    if arguments.quantity == "velocity":
        columns += [f"{name} speed" for name in names]
    report.facts.update(quantity=arguments.quantity, fwhm=arguments.fwhm)
    target = new_data(surface, arguments.output, columns)
    _write_new(arguments, report, target, result.reshape(len(surface.points), -1).astype(np.float32))


def distance(arguments, report):
    from .. import Surface
    from .. import distance as measure
    from .. import nearest_sources

    if (arguments.sources is None) == (arguments.starts is None):
        raise inputs.ArgumentProblem("the sources are " + (
            "missing" if arguments.starts is None else "both SOURCES and --from")
            + "; allowed: one of SOURCES and --from")
    surface = _read_surface_for_output(arguments, report)
    with report.timed("read"):
        sets, numbers, names = inputs.read_sources(arguments, surface)
        speed = None
        if arguments.speed is not None:
            _, values, _ = inputs.read_values(arguments.speed, surface, tables=False)
            speed = values[:, 0]
    target = new_data(surface, arguments.output, names)
    nearest = arguments.nearest and new_data(surface, arguments.nearest, names)
    solid = Surface(surface.points, surface.faces)
    with report.timed("compute"), report.progress("Distance") as progress:
        found = np.column_stack([
            measure(solid, rows, speed=speed, method=arguments.method.capitalize(), progress=progress)
            for rows in sets])
        if nearest:
            labels = np.zeros_like(found)
            for column, rows, given in zip(labels.T, sets, numbers):
                first = nearest_sources(solid, rows, speed=speed).source
                column[:] = np.where(first < 0, 0, given[first])
    reached = np.isfinite(found)
    report.facts.update(
        method=arguments.method, columns=[
            {"name": name, "sources": len(rows), "unreached": int((~column).sum()),
             "maximum": number(values[column].max())}
            for name, rows, values, column in zip(names, sets, found.T, reached.T)])
    _write_new(arguments, report, target, np.where(reached, found, np.nan).astype(np.float32))
    if nearest:
        nearest.save(arguments.nearest, [labels.astype(np.float32)])


def normals(arguments, report):
    from .. import Surface, harmonic_map

    surface = _read_surface_for_output(arguments, report)
    if arguments.move:
        check_output_name(arguments.output, surface.kind)
    else:
        target = new_data(surface, arguments.output, ["nx", "ny", "nz"])
    options = {"exponent": arguments.exponent, "move_vertices": arguments.move}
    if arguments.time_step:
        options["time_step"] = arguments.time_step
    if arguments.steps:
        options["number_of_time_steps"] = arguments.steps
    with report.timed("compute"), report.progress("Normals") as progress:
        result = harmonic_map(Surface(surface.points, surface.faces), progress=progress, **options)
    report.facts.update(exponent=arguments.exponent, moved=arguments.move, steps=result.step)
    if not arguments.move:
        _write_new(arguments, report, target, np.asarray(result.values, dtype=np.float32))
        return
    _write_points(arguments, report, surface, result.points)
    report.facts.update(mean_displacement=number(result.mean_displacement),
                        maximum_displacement=number(result.maximum_displacement),
                        volume_before=number(result.volume_before),
                        volume_after=number(result.volume_after))
    _say_written(arguments, report,
                 f"points moved by {result.mean_displacement:.4g} on average, at most "
                 f"{result.maximum_displacement:.4g}{_normals_text(report)}")


def fwhm(arguments, report):
    from .. import Surface, estimate_fwhm

    with report.timed("read"):
        surfaces, data, columns, patches = _read(arguments)
    for patch in patches:
        known = ~(patch.excluded | np.isnan(patch.values).any(axis=1))
        with report.timed("compute"):
            result = estimate_fwhm(Surface(patch.surface.points, patch.surface.faces),
                                   patch.values, mask=~known)
        entry = {"surface": patch.surface.path, "structure": patch.part.structure,
                 "pooled": number(result.pooled),
                 "columns": [{"name": data.names[c], "fwhm": number(width)}
                             for c, width in zip(columns, result.columns)]}
        report.facts.setdefault("surfaces", []).append(entry)
        where = f"{patch.part.structure}: " if len(patches) > 1 else ""
        for column, row in zip(columns, entry["columns"]):
            if len(columns) > 1:
                report.say(f"{where}{column + 1} {row['name']}: {_text(row['fwhm'])}")
        report.say(f"{where}FWHM {_text(entry['pooled'])}")


def scale_filter(arguments, report):
    from .. import scale_filter as separate

    report.facts.update(wavelength=arguments.wavelength, order=arguments.order)
    _change_data(
        arguments, report, "Scales",
        lambda surface, values, mask, progress: separate(
            surface, values, arguments.wavelength, order=arguments.order, mask=mask, progress=progress),
        _groups_of_missing, say=lambda _: f"wavelength {arguments.wavelength:g}")


def spectrum(arguments, report):
    from .. import spectrum as measure

    with report.timed("read"):
        _, data, columns, patches = _read(arguments)
    rows = report.facts.setdefault("spectra", [])
    report.facts.update(wavelengths=arguments.wavelengths, order=arguments.order)
    if (np.diff(arguments.wavelengths) <= 0).any():
        raise inputs.ArgumentProblem("the WAVELENGTHs are not ascending; allowed: ascending numbers")
    bounds = ["0", *(f"{length:g}" for length in arguments.wavelengths), "infinity"]
    for patch in patches:
        solver = inputs.make_solver(arguments, patch.surface, None)
        for i, column in enumerate(columns):
            _require_known(patch, [i], data, columns)
            with report.timed("compute"):
                found = measure(solver, patch.values[:, i].astype(float), arguments.wavelengths,
                                order=arguments.order, mask=patch.excluded_of(i))
            rows.append({"name": data.names[column], "structure": patch.part.structure,
                         "variance": [number(value) for value in found.variance]})
            report.say(f"{column + 1} {data.names[column]}:")
            for low, high, value in zip(bounds, bounds[1:], found.variance):
                report.say(f"  {low} to {high}: {value:.4g}")


def random_field(arguments, report):
    from .. import random_field as draw

    if arguments.fwhm is not None and arguments.nu != 1:
        raise inputs.ArgumentProblem("--nu with --fwhm; allowed: --nu with --range")
    surface = _read_surface_for_output(arguments, report)
    target = new_data(surface, arguments.output, [f"field {k + 1}" for k in range(arguments.count)])
    with report.timed("compute"), report.progress("Fields") as progress:
        solver = inputs.make_solver(arguments, surface, None)
        found = draw(solver, arguments.count, fwhm=arguments.fwhm, range=arguments.range, nu=arguments.nu,
                     seed=arguments.seed, progress=progress)
    report.facts.update(fwhm=arguments.fwhm, range=arguments.range, seed=arguments.seed)
    _write_new(arguments, report, target, found.astype(np.float32))


def surrogates(arguments, report):
    from .. import surrogates as draw

    check_output_folder(arguments.output)
    with report.timed("read"):
        _, data, columns, patches = _read(arguments)
    if len(patches) != 1 or len(columns) != 1:
        found = f"{len(columns)} columns" if len(patches) == 1 else f"{len(patches)} surfaces"
        raise inputs.ArgumentProblem(f"{data.path} has {found}; allowed: one surface and one column, by "
                                     "--column")
    patch = patches[0]
    _require_known(patch, [0], data, columns)
    target = new_data(patch.surface, arguments.output,
                      [f"surrogate {k + 1}" for k in range(arguments.count)])
    with report.timed("compute"), report.progress("Surrogates") as progress:
        found = draw(inputs.make_solver(arguments, patch.surface, None), patch.values[:, 0].astype(float),
                     arguments.count, seed=arguments.seed, mask=patch.excluded_of(0), progress=progress)
    report.facts.update(
        output=arguments.output, seed=arguments.seed, model=[
            {"fwhm": number(width), "variance": number(share)}
            for width, share in zip(found.fwhm, found.variances)])
    _write_new(arguments, report, target, found.values.astype(np.float32))


def _text(value, digits=4):
    return "unknown" if value is None else f"{value:.{digits}g}"


def info(arguments, report):
    entries = report.facts.setdefault("files", [])
    for path in arguments.files:
        entry = {"file": path}
        surface_problem = data_problem = None
        content = read_content(path)
        try:
            entry.update(_surface_info(read_surface(content)))
        except FileError as error:
            surface_problem = error
        try:
            entry.update(_data_info(read_data(content)))
        except FileError as error:
            data_problem = error
        if surface_problem and data_problem:
            raise surface_problem if "has no surface" not in str(surface_problem) else data_problem
        entries.append(entry)
        report.say(_info_line(entry))


def _surface_info(surface):
    with np.errstate(over="ignore", invalid="ignore"):  # numbers that no double holds are unknown
        return _measure(surface)


def _measure(surface):
    areas = inputs.vertex_areas(surface)
    faces = inputs.triangles(surface)
    edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]),
                              axis=1), axis=0)
    points = np.asarray(surface.points, dtype=float)
    lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    return {"format": surface.kind, "points": len(points), "faces": len(surface.faces),
            "structure": surface.structure, "area": number(areas.sum()),
            "mean_edge_length": number(lengths.mean())}


def _data_info(data):
    columns = []
    for i, name in enumerate(data.names):
        values = np.concatenate([part.values[:, i] for part in data.parts]).astype(float)
        known = values[np.isfinite(values)]
        columns.append({
            "name": name, "values": len(values), "missing": int(np.isnan(values).sum()),
            "zeros": int((values == 0).sum()),
            "minimum": number(known.min()) if len(known) else None,
            "mean": number(known.mean()) if len(known) else None,
            "maximum": number(known.max()) if len(known) else None})
    return {"format": data.kind, "columns": columns,
            "structures": [part.structure for part in data.parts if part.structure]}


def _info_line(entry):
    words = [f"{entry['file']}: {entry['format']}"]
    if "points" in entry:
        words.append(f"{entry['points']} points, {entry['faces']} faces, "
                     f"area {_text(entry['area'], 6)}, mean edge {_text(entry['mean_edge_length'])}")
    lines = [", ".join(words)]
    columns = entry.get("columns", [])
    for i, column in enumerate(columns[:8], start=1):
        lines.append(f"  {i} {column['name']}: {column['values']} values, "
                     f"{column['missing']} missing, {column['zeros']} zeros, "
                     f"{_text(column['minimum'])} to {_text(column['maximum'])}, "
                     f"mean {_text(column['mean'])}")
    if len(columns) > 8:
        lines.append(f"  ... {len(columns)} columns")
    return "\n".join(lines)


# ---- common parts --------------------------------------------------------------------------------

def _read(arguments, missing=None, content=None):
    surfaces = read_surfaces(arguments)
    data = read_data(content or arguments.data, getattr(arguments, "faces", False))
    columns = choose_columns(data, arguments.column)
    patches = make_patches(surfaces, data, columns, arguments)
    if missing is not None:
        marks = dict(inputs.read_marks(missing, surfaces, data.on_faces))
        for patch in patches:
            patch.values[marks[id(patch.surface)] & ~patch.excluded] = np.nan
    return surfaces, data, columns, patches


def _change_data(arguments, report, title, compute, groups, missing=None, say=None, content=None):
    """Applies compute(surface, values, mask, progress) to the groups of columns of each surface
    and writes the result in the format of DATA. say(surface): a part of the summary. content: of DATA, if
    it has been read."""
    check_output_folder(arguments.output)
    with report.timed("read"):
        surfaces, data, columns, patches = _read(arguments, missing, content)
        areas = inputs.read_areas(getattr(arguments, "areas", None), surfaces)
        target = _target(data, patches, arguments.output)
    if data.extra:
        report.warn(f"{data.path}: {data.extra}")
    results = []
    total = sum(len(columns) for _ in patches)
    done = 0
    with report.progress(title) as progress:
        for patch in patches:
            surface = inputs.make_solver(arguments, patch.surface, areas.get(id(patch.surface)))
            new = np.empty_like(patch.values)
            for group in groups(data, columns, patch):
                excluded = patch.excluded_of(group[0])
                mask = excluded if excluded.any() else None
                _require_known(patch, group, data, columns)
                chosen = slice(None) if len(group) == len(columns) else group
                with report.timed("compute"):
                    new[:, chosen] = compute(
                        surface, patch.values[:, chosen], mask,
                        part_of(progress, done / total, len(group) / total))
                done += len(group)
            results.append(patch.to_part(new))
            _add_totals(report, data, columns, patch, new, areas)
    with report.timed("write"):
        target.save(arguments.output, results, columns)
    report.facts.update(data=data.path, output=arguments.output)
    what = f"{len(columns)} column{'s' * (len(columns) > 1)}"
    if say is not None:
        what += ", " + say(patches[0].surface)
    _say_written(arguments, report, what)


def _target(data, patches, path):
    """What is written: DATA with other values, or of a curv file, which has no metadata, the format that
    the name of the output announces."""
    if data.kind == "curv" and kind_of_name(path) not in (None, "curv"):
        return new_data(patches[0].surface, path, data.names)
    data.check_name(path)
    return data


def _groups_of_missing(data, columns, patch):
    """Columns whose missing values are at the same vertices are solved together."""
    missing = np.isnan(patch.values)
    if not missing.any() and patch.excluded.ndim == 1:
        return [list(range(len(columns)))]
    groups = {}
    for i in range(len(columns)):
        key = np.packbits(missing[:, i]).tobytes(), np.packbits(patch.excluded_of(i)).tobytes()
        groups.setdefault(key, []).append(i)
    return list(groups.values())


def _groups_of_arrays(data, columns, patch):
    """Edges are common to the channels of a colour or a vector, and to no other columns."""
    colour = {"red", "green", "blue"}
    groups = {}
    for i, column in enumerate(columns):
        name = data.names[column]
        if data.kind == "ply" and name in colour:
            key = "colour"
        else:
            key = name if data.kind in ("vtk", "vtp") else i
        groups.setdefault(key, []).append(i)
    return list(groups.values())


def _require_known(patch, group, data, columns):
    missing = np.isnan(patch.values[:, group]).any(axis=1)
    if (missing | patch.excluded_of(group[0])).all():
        raise FileError(f"{data.path}: column {columns[group[0]] + 1} has no known value in the "
                        "region; allowed: at least one")


def _add_totals(report, data, columns, patch, new, areas):
    """The integrals over the region before (known values alone) and after."""
    given = None if data.on_faces else areas.get(id(patch.surface))
    missing = np.isnan(patch.values).sum(axis=0)
    rows = report.facts.setdefault("columns", [])
    regions = [slice(None)] if patch.excluded.ndim == 1 else [[i] for i in range(len(columns))]
    for region in regions:
        excluded = patch.excluded_of(0 if isinstance(region, slice) else region[0])
        sizes = _sizes(data, patch, excluded, given)
        before, after = _integrals(sizes, patch.values[:, region]), _integrals(sizes, new[:, region])
        for k, i in enumerate(range(len(columns))[region] if isinstance(region, slice) else region):
            rows.append({"column": columns[i] + 1, "name": data.names[columns[i]],
                         "structure": patch.part.structure or patch.surface.structure,
                         "missing": int(missing[i]), "excluded": int(excluded.sum()),
                         "total_before": number(before[k]), "total_after": number(after[k])})


def _sizes(data, patch, excluded, given):
    """The areas that vertices or faces have in integrals. given: those of the vertices, or None."""
    if data.on_faces:
        return np.where(excluded, 0, inputs.face_areas(patch.surface))
    areas = inputs.vertex_areas(patch.surface, excluded)
    if given is not None:
        whole = inputs.vertex_areas(patch.surface)
        areas = np.divide(areas * given, whole, out=areas, where=whole > 0)
    return areas


def _integrals(areas, values):
    """Of each column, missing values left out; in panels, since copies in double are large."""
    return np.concatenate([areas @ np.nan_to_num(values[:, i:i + 32].astype(float))
                           for i in range(0, values.shape[1], 32)])


def _read_surface_for_output(arguments, report):
    check_output_folder(arguments.output)
    with report.timed("read"):
        surface = read_surface(arguments.surface)
    report.facts.update(surface=arguments.surface, output=arguments.output)
    return surface


def _write_points(arguments, report, surface, points):
    with report.timed("write"):
        report.facts["normals"] = surface.save(arguments.output, points) or None


def _normals_text(report):
    """Normals of the old points would let viewers draw the old surface."""
    done = report.facts["normals"]
    return f", normals {done}" if done else ""


def _write_new(arguments, report, target, values):
    with report.timed("write"):
        target.save(arguments.output, [values])
    count = len(target.names)
    _say_written(arguments, report, f"{count} column{'s' * (count > 1)}")


def _say_written(arguments, report, what):
    seconds = sum(entry["wall"] for entry in report.seconds.values())
    report.say(f"{arguments.output}: {what}, {seconds:.2f} s")
