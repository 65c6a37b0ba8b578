# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The parts of the functions that arrays and PyVista meshes share: checks of each model's data, and
the outputs of a run on one of its surfaces."""

from __future__ import annotations

from typing import Any, Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from ._result import LeaveOneOut, RegionBoundary
from ._run import Given, find_result_type
from ._settings import shorten, snake_case
from ._surface import Surface, as_data, as_factors, as_numbers, find_on_faces, left_out, require_shape

#: The keywords of input arrays, by their names in messages.
ARRAYS = {"InputArray": "values", "MaskArray": "mask", "DirectionArray": "directions",
          "FixedArray": "fixed", "DiffusionRateArray": "rates", "FidelityArray": "fidelity",
          "SeedArray": "seeds", "DataTermArray": "terms"}


class Output:
    """What a model returns, an entry of the list of a run: see Run/Output.h.

    place: "points", "faces", "curve points", "curves", "column", "samples" or "number". role: "scalars", "vectors",
    "coordinates" or "". is_result, is_beside_result: named after the data. rows: an array with a row per
    point, face, entry of a column, point of a curve, or of a matrix."""

    def __init__(self, entry: dict[str, Any], rows: NDArray[Any]) -> None:
        self.entry, self.rows = entry, rows
        self.name, self.place, self.role, self.kind = (
            str(entry[key]) for key in ("name", "place", "role", "kind"))
        self.is_result, self.is_beside_result = entry["is_result"], entry["is_beside_result"]

    @property
    def values(self) -> Any:
        """The rows as Python has them: a list of curves, a number, or an array with one dimension of one
        column, unless it has the type of the data."""
        if "corners" in self.entry:
            corners = np.array(self.entry["corners"], dtype=np.int64)
            return np.split(self.rows[corners], self.entry["begin"][1:])[:-1]
        if self.place == "number":
            return self.rows[0, 0].item() if self.rows.shape == (1, 1) else self.rows
        if self.kind == "data" or self.rows.shape[1] != 1:
            return self.rows
        return self.rows[:, 0].astype(np.int64) if self.place == "column" and self.kind == "integer" else (
            self.rows[:, 0])


def read_outputs(
    entries: list[dict[str, Any]], write: Callable[[int, Any, Any], None], given: Given, dtype: Any = None
) -> list[Output]:
    """The outputs of one surface. entries: the list of a run; write: its function of the number of an
    entry, an array and the input. dtype: of the result of the data, that of the data by default."""
    result_type = find_result_type(given.data, dtype)
    real = np.float32 if result_type == np.float32 else np.float64
    types = {"data": result_type, "real": real, "double": np.float64, "integer": np.int32,
             "byte": np.uint8}
    outputs = []
    for number, entry in enumerate(entries):
        columns = entry["columns"]
        if entry["kind"] == "data" and given.data is not None:
            columns = given.data.shape[1]  # with alpha
        rows = np.empty((given.sizes.get(entry["place"], entry["rows"]), columns), dtype=types[entry["kind"]])
        write(number, rows, given.core)
        outputs.append(Output(entry, rows))
    return outputs


def find_outputs(
    run: Any, block: int, given: Given, dtype: Any = None, call: Callable[..., Any] | None = None
) -> list[Output]:
    """The outputs of one of the surfaces of a run. call: calls the function that it is given, for its errors."""

    def write(number: int, values: NDArray[Any], source: Any) -> None:
        arguments = block, number, values, source, -1, given.integers
        run.write(*arguments) if call is None else call(run.write, *arguments)

    return read_outputs(run.outputs(block), write, given, dtype)


#: The attributes of results that have other names than their outputs in snake_case.
_ATTRIBUTES = {
    "MeanCurvature": "mean", "GaussianCurvature": "gaussian", "PrincipalCurvatures": "principal",
    "Area": "areas", "BoundaryLength": "boundary_lengths", "DiffusionAxes": "axes",
    "EffectiveNoiseLevel": "noise_level", "EffectiveSurfaceType": "surface_type",
    "RegionProbability": "probabilities", "TextureColor": "colors",
}


def make_result(
    result_class: Any, outputs: list[Output], found: Mapping[str, Any], surface: Surface
) -> Any:
    """A result whose attributes are outputs, and those that were found otherwise."""
    fields = result_class.__dataclass_fields__
    attributes = {"surface": surface, **found}
    if "points" in fields:  # which outputs have if they have moved
        attributes["points"] = np.array(surface.points)
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
    left_out = {output.name: output.values for output in outputs if output.name.startswith("LeaveOneOut")}
    if left_out:
        attributes["leave_one_out"] = LeaveOneOut(
            left_out["LeaveOneOutResiduals"], left_out["LeaveOneOutErrors"])
    attributes["curves"] = on_curves.get("Curves", [])
    attributes["boundaries"] = [
        RegionBoundary((int(pair[0]), int(pair[1])), points, float(length)) for points, pair, length
        in zip(*(on_curves.get(name, []) for name in ("Boundaries", "Regions", "Length")))]
    return result_class(**{name: value for name, value in attributes.items() if name in fields})


def take_data(
    function: str, surface: Surface, values: Any, on_faces: Any = None, name: str = "values"
) -> tuple[Any, bool, bool]:
    """The data of a function, whether they are on faces, and whether they were integers, for which there may
    be floating-point numbers. name: in messages."""
    n = surface.n_points
    if function == "harmonic_map" and values is None:
        return surface._point_normals(), False, False
    if function == "turing_texture":
        name, on_faces = "initial", False
        if values is None:
            return None, False, False
        shape = np.shape(as_numbers(name, values))
        require_shape(name, values, shape == (n, 2), f"({n}, 2), one row per point")
    name = "vectors" if function == "harmonic_map" else name
    on_faces = find_on_faces(name, values, surface, on_faces)
    data = as_data(name, values, *((surface.n_faces, "face") if on_faces else (n, "point")))
    return data, on_faces, function != "turing_texture" and np.asarray(values).dtype.kind in "biu"


def as_mask(mask: Any, roi: Any, surface: Surface, properties: dict[str, Any]) -> Any:
    """The mask, or that of the region of interest, which sets mask_mode."""
    found = left_out(mask, roi, surface)
    if roi is None:
        return found
    mode = properties.setdefault("mask_mode", "Exclude")
    if mode not in ("Exclude", "exclude"):
        raise ValueError(f"mask_mode is {shorten(mode)} with roi; allowed with roi: Exclude")
    return found if found.any() else None


def as_samples(
    points: Any, values: Any, fidelity: Any
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | None]:
    """Places (p, 3), values (p, k) and weights (p,) of interpolate."""
    places = np.ascontiguousarray(as_numbers("points", points), dtype=np.float64)
    require_shape("points", places, places.shape[1:] == (3,), "(p, 3), one row per value")
    found = np.ascontiguousarray(as_numbers("values", values), dtype=np.float64)
    p = len(places)
    require_shape("values", found, found.ndim in (1, 2) and len(found) == p and found.shape[1:] != (0,),
                  f"({p},) or ({p}, k), one row per point of points")
    weights = as_factors("fidelity", fidelity)
    require_shape("fidelity", weights, weights is None or weights.shape == (p,),
                  f"({p},), one number per point of points")
    return places, found.reshape(p, -1 if found.size else 1), weights
