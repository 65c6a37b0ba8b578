# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What a run says: progress, summary, warnings, errors, and a report as JSON."""
from __future__ import annotations

import contextlib
import json
import os
import re
import sys
import time
import warnings

import numpy as np

#: The option of a command that gives a setting of the package: its destination, and how it is written
_OPTIONS = {
    "automatic_fidelity": ("weight", "the search for --weight"),
    "correlation_length": ("length", "--length"),
    "edge_threshold": ("threshold", "--threshold"),
    "edge_width": ("width", "--width"),
    "feature_size": ("size", "FEATURE_SIZE"),
    "fidelity_weight": ("weight", "--weight"),
    "maximum_distance": ("within", "--within"),
    "maximum_number_of_triangles": ("maximum_triangles", "--maximum-triangles"),
    "missing_value": ("missing_value", "--missing-value"),
    "merge_coincident_points": ("merge", "--merge"),
    "merge_tolerance": ("merge_tolerance", "--merge-tolerance"),
    "noise_level": ("noise", "--noise"),
    "number_of_regions": ("regions", "--regions"),
    "number_of_time_steps": ("steps", "--steps"),
    "smoothing_length": ("length", "--length"),
}


def in_options(text, arguments):
    """A sentence of the package in the words of the command line: the options that it has."""
    text = re.sub(r"to join them, number points.* (does|finds them)\)",
                  "ParaView's filter Clean joins them)", text)
    # A number that is given turns its choice from the data off.
    text = re.sub(r"turn off automatic_\w+ and |, with automatic_\w+ off", "", text)
    text = text.replace("turn automatic_threshold on", "give no edge_threshold")
    if not hasattr(arguments, "within"):  # of distances, whose sources are given one by one
        text = text.replace(" (set maximum_distance to leave out those beyond it)", "")
    for setting, (destination, option) in _OPTIONS.items():
        if hasattr(arguments, destination):
            text = re.sub(rf"(?<![\w./-]){setting}(?![\w./-])", option, text)  # names of files stay
    text = re.sub(r"to join them, set merge_coincident_points(, and merge_tolerance[^)]*)?",
                  "ParaView's filter Clean joins them", text)
    return re.sub(r"(^|; )(fwhm|kinetics|method|range|speed) is",
                  lambda found: found[1] + ("--" + found[2] if hasattr(arguments, found[2])
                                            else found[2].upper()) + " is", text)


class Report:
    """Collects facts of a run; `facts` becomes the JSON object."""

    def __init__(self, arguments):
        self.arguments = arguments
        self.facts = {"command": arguments.command}
        self.seconds = {}
        self.warnings = []
        self.problems = []
        self.lines = []

    @contextlib.contextmanager
    def timed(self, phase):
        """Adds wall-clock and processor time to the phase: read, compute or write."""
        wall, processor = time.perf_counter(), time.process_time()
        yield
        entry = self.seconds.setdefault(phase, {"wall": 0.0, "cpu": 0.0})
        entry["wall"] += time.perf_counter() - wall
        entry["cpu"] += time.process_time() - processor

    @contextlib.contextmanager
    def working(self, title, phase="compute"):
        """Measures the time of the phase; a callable for progress(), whose bar has the title."""
        with self.timed(phase), self.progress(title) as progress:
            yield progress

    @contextlib.contextmanager
    def collecting_warnings(self):
        with warnings.catch_warnings():
            warnings.simplefilter("always", UserWarning)
            warnings.simplefilter("always", RuntimeWarning)
            warnings.showwarning = self._show_warning
            yield

    def _show_warning(self, message, category, filename, lineno, file=None, line=None):
        text = " ".join(str(message).split())
        if issubclass(category, (UserWarning, RuntimeWarning)) and text not in self.warnings:
            self.warn(text)

    def warn(self, text):
        text = in_options(text, self.arguments)
        self.warnings.append(text)
        if not self.arguments.quiet:
            print(f"surfacediffusion: warning: {text}", file=sys.stderr)

    @contextlib.contextmanager
    def progress(self, text):
        """A callable that takes the fraction done, and draws a bar if a person looks."""
        if self.arguments.quiet or not sys.stderr.isatty():
            yield None
            return
        try:
            from tqdm import tqdm
        except ImportError:
            yield None
            return
        form = "{desc}: {percentage:3.0f}%|{bar}| {elapsed}<{remaining}"
        with tqdm(total=1.0, desc=text, leave=False, bar_format=form) as bar:
            def update(fraction, *_):
                bar.update(max(0.0, min(fraction, 1.0) - bar.n))

            yield update

    def say(self, line):
        self.lines.append(line)

    def announce(self, line):
        """A line before a long step."""
        if not self.arguments.quiet and not self.arguments.json:
            print(line, flush=True)

    def say_written(self, path, what):
        """The line about an output, with the time until now."""
        seconds = sum(entry["wall"] for entry in self.seconds.values())
        self.say(f"{path}: {what}, {seconds:.2f} s")

    def refuse(self, error):
        """A problem with one of several inputs; the run goes on, and ends as one that failed."""
        self.problems.append(self._text_of(error))

    def _text_of(self, error):
        return in_options(" ".join(str(error).split()) or type(error).__name__, self.arguments)

    def add_numbers(self, result, *names):
        """Facts from attributes of a result."""
        self.facts.update({name: number(getattr(result, name)) for name in names})

    def finish(self):
        """Print the summary or the report. The exit code."""
        lines = [] if self.arguments.quiet else self.lines
        if self.arguments.json:
            self.facts["seconds"] = self.seconds
            self.facts["warnings"] = self.warnings
            if self.problems:
                self.facts["error"] = "; ".join(self.problems)
            lines = [json.dumps(self.facts, indent=2, default=_plain, allow_nan=False)]
        try:
            if getattr(sys.stdout, "errors", None) == "strict":  # names of files may have any characters
                sys.stdout.reconfigure(errors="backslashreplace")
            for line in lines:
                print(line, flush=True)
        except OSError as error:  # a full disk, or a pipe that nobody reads, where Python would flush again
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            if isinstance(error, BrokenPipeError):
                return 1
            return self.fail(f"standard output: cannot be written: {error.strerror}", 1)
        for problem in self.problems:
            print(f"surfacediffusion: {problem}", file=sys.stderr)
        return 2 if self.problems else 0

    def fail(self, error, code):
        text = self._text_of(error)
        print(f"surfacediffusion: {text}", file=sys.stderr)
        if self.arguments.json:
            self.facts.update(error=text, warnings=self.warnings)
            print(json.dumps(self.facts, indent=2, default=_plain))
        return code


def _plain(value):
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is not JSON")


def number(value):
    """A number for JSON, which has no NaN: None instead."""
    value = float(value)
    return value if np.isfinite(value) else None


def number_text(value, digits=4):
    """What a line says of such a number."""
    return "unknown" if value is None else f"{value:.{digits}g}"


def counted(count, noun):
    """As in 1 column, 2 columns."""
    return f"{count} {noun}{'s' * (count != 1)}"
