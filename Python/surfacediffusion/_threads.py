# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The number of threads of this process."""

from __future__ import annotations

import os

import numpy as np

from . import _core
from ._settings import shorten


def get_number_of_threads() -> int:
    """The number of threads that loops run on; at first that of the processors this process may
    use."""
    return int(_core.number_of_threads())


def set_number_of_threads(number: int) -> None:
    """Run later loops on this number of threads; 0 means as many as the processors this process may
    use, the default. No bit of a result depends on it.

    Examples
    --------
    >>> import surfacediffusion
    >>> surfacediffusion.set_number_of_threads(2)
    >>> surfacediffusion.get_number_of_threads()
    2
    """
    allowed = isinstance(number, (int, np.integer)) and not isinstance(number, bool)
    if not allowed or not 0 <= number <= 1024:
        raise ValueError(f"number is {shorten(number)}; allowed: 0 to 1024 threads")
    _core.set_number_of_threads(int(number) or _number_of_processors())


def _number_of_processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return min(1024, len(os.sched_getaffinity(0)))
    return min(1024, os.cpu_count() or 1)


set_number_of_threads(0)
