# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The parts of the functions that arrays and PyVista meshes share: checks of each model's data, and
the outputs of a run on one of its surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from ._result import RegionBoundary
from ._run import Input, Runner, find_result_type
from ._settings import shorten, snake_case
from ._surface import Surface, as_data, as_factors, as_numbers, data_components

#: The keywords of input arrays, by their names in messages.
ARRAYS = {"InputArray": "values", "MaskArray": "mask", "DirectionArray": "directions",
          "FixedArray": "fixed", "DiffusionRateArray": "rates", "FidelityArray": "fidelity",
          "SeedArray": "seeds", "DataTermArray": "terms"}


@dataclass(frozen=True)
class Output:
    """What a model returns, under the name that it has in VTK and ParaView: see Run/Output.h.

    values: an array with a row per point, face, entry of a column, or curve and its points; a number
    or a matrix of numbers; or a list of curves."""

    name: str
    place: str  #: "points", "faces", "curve points", "curves", "column" or "number"
    role: str  #: "scalars", "vectors", "coordinates" or ""
    is_result: bool  #: named after the data
    values: Any
    is_beside_result: bool = False  #: named after the data, too


def read_outputs(
    entries: list[dict[str, Any]], write: Callable[..., None], given: Input, runner: Runner,
    dtype: Any = None,
) -> list[Output]:
    """The outputs of one surface. entries: the list of a run; write: its function of the number of an
    entry, an array and the input."""
    result_type = find_result_type(given.data, dtype)
    real = np.float32 if result_type == np.float32 else np.float64
    types = {"data": result_type, "real": real, "double": np.float64, "integer": np.int32,
             "byte": np.uint8}
    sizes = {"points": given.surface.n_points, "faces": given.surface.n_faces}
    outputs = []
    for number, entry in enumerate(entries):
        place, kind, columns = entry["place"], entry["kind"], entry["columns"]
        if kind == "data" and given.data is not None:
            columns = given.data.shape[1]  # with alpha
        values: Any = np.empty((sizes.get(place, entry["rows"]), columns), dtype=types[kind])
        runner.call(write, number, values, given.core)
        if "corners" in entry:
            corners = np.array(entry["corners"], dtype=np.int64)
            values = np.split(values[corners], entry["begin"][1:])[:-1]
        elif place == "number" and values.shape == (1, 1):
            values = values[0, 0].item()
        elif kind != "data" and columns == 1 and place != "number":
            values = values[:, 0].astype(np.int64) if place == "column" and kind == "integer" else (
                values[:, 0])
        outputs.append(Output(entry["name"], place, entry["role"], entry["is_result"], values,
                              entry["is_beside_result"]))
    return outputs


def find_outputs(run: Any, block: int, given: Input, runner: Runner, dtype: Any = None) -> list[Output]:
    """The outputs of one of the surfaces of a run."""

    def write(number: int, values: NDArray[Any], source: Any) -> None:
        run.write(block, number, values, source, -1, given.integers)

    return read_outputs(run.outputs(block), write, given, runner, dtype)


#: The attributes of results that have other names than their outputs in snake_case.
_ATTRIBUTES = {
    "MeanCurvature": "mean", "GaussianCurvature": "gaussian", "PrincipalCurvatures": "principal",
    "Area": "areas", "BoundaryLength": "boundary_lengths", "DiffusionAxes": "axes",
    "EffectiveNoiseLevel": "noise_level", "EffectiveSurfaceType": "surface_type",
    "RegionProbability": "probabilities", "TextureColor": "colors",
}


def make_result(result_class: Any, outputs: list[Output], found: Mapping[str, Any]) -> Any:
    """A result whose attributes are outputs, and those that were found otherwise."""
    attributes = dict(found)
    on_curves = {output.name: output.values for output in outputs if "curve" in output.place}
    for output in outputs:
        if output.name not in on_curves or output.place in ("points", "faces"):
            attributes[_ATTRIBUTES.get(output.name, snake_case(output.name))] = output.values
        if output.is_result:
            attributes["values"] = output.values
    if result_class.VALUES:
        named = {output.name: output.values for output in outputs}
        columns = [named[name] for name in result_class.VALUES]
        attributes["values"] = columns[0] if len(columns) == 1 else np.column_stack(columns)
    attributes["curves"] = on_curves.get("Curves", [])
    attributes["boundaries"] = [
        RegionBoundary((int(pair[0]), int(pair[1])), points, float(length)) for points, pair, length
        in zip(*(on_curves.get(name, []) for name in ("Boundaries", "Regions", "Length")))]
    fields = result_class.__dataclass_fields__
    return result_class(**{name: value for name, value in attributes.items() if name in fields})


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


def as_samples(
    points: Any, values: Any, fidelity: Any
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | None]:
    """Places (p, 3), values (p, k) and weights (p,) of interpolate."""
    places = np.ascontiguousarray(as_numbers("points", points), dtype=np.float64)
    if places.ndim != 2 or places.shape[1] != 3:
        raise ValueError(f"points has shape {places.shape}; allowed: (p, 3), one row per value")
    found = np.ascontiguousarray(as_numbers("values", values), dtype=np.float64)
    p = len(places)
    if found.ndim not in (1, 2) or len(found) != p or (found.ndim == 2 and found.shape[1] == 0):
        raise ValueError(f"values has shape {found.shape}; allowed: ({p},) or ({p}, k), one row per "
                         "point of points")
    weights = as_factors("fidelity", fidelity)
    if weights is not None and weights.shape != (p,):
        raise ValueError(f"fidelity has shape {weights.shape}; allowed: ({p},), one number per point "
                         "of points")
    return places, found.reshape(p, -1 if found.size else 1), weights


def check_colors(properties: Mapping[str, Any]) -> None:
    """low_color and high_color have to be colours."""
    for name in ("low_color", "high_color"):
        if name in properties:
            parts = as_numbers(name, properties[name])
            if parts.shape != (3,) or not ((parts >= 0.0) & (parts <= 1.0)).all():
                raise ValueError(f"{name} is {shorten(properties[name])}; allowed: three numbers from "
                                 "0 to 1")
