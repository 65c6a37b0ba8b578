# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The parts of the functions that arrays and PyVista meshes share: checks of each model's data, and
results on one of the surfaces of a run."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ._result import (
    DiffusionResult, EdgeResult, HarmonicMapResult, RegionBoundary, SegmentationResult,
    TensorDiffusionResult, TextureResult,
)
from ._run import Input, Runner, find_result_type
from ._settings import shorten
from ._surface import Surface, as_data, as_numbers, data_components

#: The keywords of input arrays, by their names in messages.
ARRAYS = {"InputArray": "values", "MaskArray": "mask", "DirectionArray": "directions",
          "FixedArray": "fixed", "DiffusionRateArray": "rates", "FidelityArray": "fidelity",
          "SeedArray": "seeds", "DataTermArray": "terms"}


def make_diffusion(
    run: Any, block: int, given: Input, runner: Runner, dtype: Any, found: dict[str, Any]
) -> DiffusionResult:
    """The result of heat or intrinsic_tv on one surface, with columns for components."""
    assert given.data is not None
    output = _empty(run, block, given, dtype)
    runner.call(given.write, run, block, output)
    return DiffusionResult(output, **_pick(DiffusionResult, found))


def make_harmonic_map(
    run: Any, block: int, given: Input, runner: Runner, dtype: Any, found: dict[str, Any]
) -> HarmonicMapResult:
    """The result of harmonic_map on one surface."""
    assert given.data is not None
    output = _empty(run, block, given, dtype)
    if output.dtype == np.uint8:
        runner.call(run.write_colors_of_vectors, block, output, given.core)
    else:
        runner.call(given.write, run, block, output)
    points = np.array(given.surface.points)
    runner.call(run.write_moved_points, block, points)
    return HarmonicMapResult(output, points=points, **_pick(HarmonicMapResult, found))


def make_edges(
    run: Any, block: int, given: Input, runner: Runner, dtype: Any, found: dict[str, Any]
) -> EdgeResult:
    """The result of mumford_shah on one surface, with columns for components."""
    assert given.data is not None
    result_type = find_result_type(given.data, dtype)
    output = _empty(run, block, given, dtype)
    runner.call(given.write, run, block, output)
    single = result_type == np.float32
    edges = np.empty((len(output), 1), dtype=np.float32 if single else np.float64)
    runner.call(run.write_edges, block, edges)
    sizes = run.curve_sizes(block)
    points = np.empty((sum(sizes), 3))
    runner.call(run.write_curves, block, points)
    return EdgeResult(output, edges=edges[:, 0], curves=np.split(points, np.cumsum(sizes))[:-1],
                      **_pick(EdgeResult, found))


def make_tensor_diffusion(
    run: Any, block: int, given: Input, runner: Runner, dtype: Any, found: dict[str, Any]
) -> TensorDiffusionResult:
    """The result of tensor_diffusion on one surface, with columns for components."""
    assert given.data is not None
    output = _empty(run, block, given, dtype)
    runner.call(given.write, run, block, output)
    axes = np.empty((given.surface.n_faces, 3))
    if not runner.call(run.write_axes, block, given.surface._core, axes):
        axes = np.empty((0, 3))
    return TensorDiffusionResult(output, axes=axes, **_pick(TensorDiffusionResult, found))


def make_texture(
    run: Any, block: int, given: Input, runner: Runner, dtype: Any, found: dict[str, Any],
    colors: Sequence[Any] = (),
) -> TextureResult:
    """The result of turing_texture on one surface. colors: of the texture's 0 and 1, or none."""
    n, result_type = given.surface.n_points, find_result_type(given.data, dtype)
    concentrations = np.empty((n, 2), dtype=result_type)
    runner.call(run.write_state, block, concentrations, given.data)
    texture = np.empty((n, 1), dtype=result_type)
    runner.call(run.write_texture, block, texture)
    painted = None
    if colors:
        painted = np.empty((n, 3), dtype=np.uint8)
        runner.call(run.write_texture_colors, block, painted, *colors)
    return TextureResult(concentrations, texture=texture[:, 0], colors=painted,
                         **_pick(TextureResult, found))


def make_segmentation(
    run: Any, block: int, given: Input, runner: Runner, found: dict[str, Any]
) -> SegmentationResult:
    """The result of segment on one surface."""
    n = given.rows(run, block)
    regions = run.regions(block)
    labels = np.empty((n, 1))
    runner.call(run.write_labels, block, labels)
    probabilities = np.empty((n, len(regions["areas"])))
    runner.call(run.write_state, block, probabilities, None)
    points = np.array(regions.pop("points"), dtype=float).reshape(-1, 3)
    boundaries = [RegionBoundary((first, second), points[curve], length)
                  for first, second, length, curve in regions.pop("curves")]
    means = np.array(regions.pop("means"), dtype=float).reshape(probabilities.shape[1], -1)
    for name in ("areas", "boundary_lengths", "components"):
        regions[name] = np.array(regions[name])
    return SegmentationResult(
        labels[:, 0].astype(np.int32), probabilities=probabilities, means=means,
        boundaries=boundaries, **regions, **_pick(SegmentationResult, found))


def as_vectors(surface: Surface, vectors: Any, properties: Mapping[str, Any],
               on_faces: bool = False) -> NDArray[Any]:
    """The vectors of harmonic_map: the given ones, or the normals."""
    n = surface.n_faces if on_faces else surface.n_points
    if vectors is None:
        return surface._point_normals()
    found = as_numbers("vectors", vectors)
    columns = data_components(found) if found.ndim == 2 else 0
    if found.ndim != 2 or found.shape[0] != n or columns < 2:
        raise ValueError(f"vectors has shape {found.shape}; allowed: ({n}, k), one row per "
                         f"{'face' if on_faces else 'point'} and k > 1, alpha of colours not counted")
    if properties.get("move_vertices", False) is True and found.shape[1] != 3:
        raise ValueError(f"vectors has shape {found.shape}; allowed with move_vertices: ({n}, 3)")
    return as_data("vectors", vectors, n)


def as_initial(surface: Surface, initial: Any) -> NDArray[Any] | None:
    """The initial state of turing_texture; None stays."""
    if initial is None:
        return None
    found = as_numbers("initial", initial)
    if found.shape != (surface.n_points, 2):
        raise ValueError(f"initial has shape {found.shape}; allowed: ({surface.n_points}, 2), one row "
                         "per point")
    return as_data("initial", initial, surface.n_points)


def as_colors(low: Any, high: Any) -> list[tuple[float, ...]]:
    """Two colours as numbers from 0 to 1."""
    colors = []
    for name, color in (("low_color", low), ("high_color", high)):
        parts = as_numbers(name, color)
        if parts.shape != (3,) or not ((parts >= 0.0) & (parts <= 1.0)).all():
            raise ValueError(f"{name} is {shorten(color)}; allowed: three numbers from 0 to 1")
        colors.append(tuple(float(part) for part in parts))
    return colors


def _empty(run: Any, block: int, given: Input, dtype: Any) -> NDArray[Any]:
    """An array for the result of data."""
    assert given.data is not None
    shape = (given.rows(run, block), given.data.shape[1])
    return np.empty(shape, dtype=find_result_type(given.data, dtype))


def _pick(result_class: Any, found: dict[str, Any]) -> dict[str, Any]:
    """The attributes that a class of results has."""
    return {name: found[name] for name in result_class.__dataclass_fields__ if name in found}
