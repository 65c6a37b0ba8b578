# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The states in time of the functions with time steps: <function>_steps()."""

from __future__ import annotations

import inspect
from typing import Any, Callable

from . import _functions
from ._run import States

__all__ = [
    "heat_steps", "harmonic_map_steps", "intrinsic_tv_steps", "mumford_shah_steps",
    "tensor_diffusion_steps", "turing_texture_steps",
]


def _steps_of(function: Callable[..., Any], result: str) -> Callable[..., States[Any]]:
    """The function of the same arguments that returns the states. result: their class."""

    def steps(*arguments: Any, **keywords: Any) -> States[Any]:
        states: States[Any] = function(*arguments, **keywords, _states=True)
        return states

    name = function.__name__
    steps.__name__ = steps.__qualname__ = f"{name}_steps"
    steps.__signature__ = inspect.signature(function).replace(  # type: ignore[attr-defined]
        return_annotation=f"States[{result}]")
    steps.__doc__ = f"""Return the states of :func:`{name}` in time.

    The arguments are those of :func:`{name}`.

    Returns
    -------
    States of {result}
        An iterator over the states at steps 0, k, 2k, ... and the last, with k = `output_interval`. Each
        is computed when it is asked for; ``last()`` goes to the last one.
    """
    return steps


heat_steps = _steps_of(_functions.heat, "DiffusionResult")
intrinsic_tv_steps = _steps_of(_functions.intrinsic_tv, "DiffusionResult")
tensor_diffusion_steps = _steps_of(_functions.tensor_diffusion, "TensorDiffusionResult")
mumford_shah_steps = _steps_of(_functions.mumford_shah, "EdgeResult")
harmonic_map_steps = _steps_of(_functions.harmonic_map, "HarmonicMapResult")
turing_texture_steps = _steps_of(_functions.turing_texture, "TextureResult")
