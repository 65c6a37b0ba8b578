# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Signals that end the process: it takes its temporary files away first, as at an interruption."""
from __future__ import annotations

import contextlib
import signal
import threading


@contextlib.contextmanager
def ended_by_signals():
    """SIGTERM and SIGHUP are a KeyboardInterrupt with their name, where they would end the process at once."""
    numbers = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
    if threading.current_thread() is not threading.main_thread():  # which may not handle signals
        numbers = []
    numbers = [number for number in numbers if signal.getsignal(number) == signal.SIG_DFL]

    def end(number, _):
        raise KeyboardInterrupt(f"ended by {signal.Signals(number).name}")

    for number in numbers:
        signal.signal(number, end)
    try:
        yield
    finally:
        for number in numbers:
            signal.signal(number, signal.SIG_DFL)
