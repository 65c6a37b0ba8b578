# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The number of threads of this process."""

from __future__ import annotations

import os

from . import _core
from ._run import warn
from ._settings import as_integer, shorten


#: Variables of the environment with the number of threads at first, in this order.
_VARIABLES = ("SURFACEDIFFUSION_NUM_THREADS", "OMP_NUM_THREADS")


def get_number_of_threads() -> int:
    """The number of threads that loops run on. At first it is that of the variable
    SURFACEDIFFUSION_NUM_THREADS of the environment, else that of OMP_NUM_THREADS, as batch systems set
    it, else the number of processors this process may use. Variables that are no number from 1 to 1024
    give a warning, and are ignored; of a list, as OpenMP has for nested loops, the first number counts.
    """
    return int(_core.number_of_threads())


def set_number_of_threads(number: int) -> None:
    """Run later loops on this number of threads; 0 means as many as the processors this process may
    use. No bit of a result depends on it. The number at first is described in
    :func:`get_number_of_threads`.

    Examples
    --------
    >>> import surfacediffusion
    >>> surfacediffusion.set_number_of_threads(2)
    >>> surfacediffusion.get_number_of_threads()
    2
    """
    number = as_integer("number", number, 0, 1024, "0 to 1024 threads")
    _core.set_number_of_threads(number or _number_of_processors())


def _number_of_processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return min(1024, len(os.sched_getaffinity(0)))
    return min(1024, os.cpu_count() or 1)


def _number_of_environment() -> int:
    """The number of threads at first; 0 if no variable gives one."""
    for name in _VARIABLES:
        text = os.environ.get(name, "").split(",")[0].strip()
        if text.isdecimal() and 1 <= int(text) <= 1024:
            return int(text)
        if text:
            warn([f"{name} is {shorten(os.environ[name])}; allowed: 1 to 1024 threads"])
    return 0


set_number_of_threads(_number_of_environment())
