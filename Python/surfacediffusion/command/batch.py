# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""One command for many files on one surface, in one process or several."""
from __future__ import annotations

import argparse
import os

from .._threads import get_number_of_threads, set_number_of_threads
from .inputs import ArgumentProblem, read_surfaces
from .signals import ended_by_signals


def run(arguments, report, work):
    """work(arguments, report) for each file of DATA, with `data` and `output` of its own. The surface is
    read once, and its factor is kept from file to file."""
    if isinstance(arguments.data, str):
        return work(arguments, report)
    pairs = _pairs(arguments)
    if len(pairs) == 1:
        arguments.data, arguments.output = pairs[0]
        return work(arguments, report)
    if arguments.jobs > 1:
        return _run_in_processes(arguments, report, work, pairs)
    files = report.facts.setdefault("files", [])
    with report.timed("read"):
        read_surfaces(arguments)
    for facts in _one_by_one(arguments, report, work, pairs):
        files.append(facts)


def _one_by_one(arguments, report, work, pairs):
    """The facts of each file, which are no facts of the whole run."""
    vars(arguments).setdefault("solvers", {})
    for data, output in pairs:
        whole, report.facts = report.facts, {}
        try:
            work(_changed(arguments, data=data, output=output), report)
        finally:
            found, report.facts = report.facts, whole
        yield found


def _changed(arguments, **others):
    return argparse.Namespace(**{**vars(arguments), **others})


def _pairs(arguments):
    """Each file of DATA and its output."""
    if len(arguments.data) == 1 and not os.path.isdir(arguments.output):
        return [(arguments.data[0], arguments.output)]
    if not os.path.isdir(arguments.output):
        raise ArgumentProblem(f"OUTPUT is {arguments.output}, for {len(arguments.data)} files; allowed: a "
                              "folder that exists")
    pairs = [(path, os.path.join(arguments.output, os.path.basename(path))) for path in arguments.data]
    outputs = [output for _, output in pairs]
    for path, output in pairs:
        if outputs.count(output) > 1:
            raise ArgumentProblem(f"DATA has several files named {os.path.basename(path)}; allowed in one "
                                  "command: different names")
        if os.path.realpath(path) == os.path.realpath(output):
            raise ArgumentProblem(f"{path} would be replaced by its result; allowed: another folder")
    return pairs


def _run_in_processes(arguments, report, work, pairs):
    import concurrent.futures
    import multiprocessing

    jobs = min(arguments.jobs, len(pairs))
    threads = max(1, get_number_of_threads() // jobs)
    # New processes, since threads of this one would be lost in a fork.
    context = multiprocessing.get_context("spawn")
    others = multiprocessing.active_children()
    with concurrent.futures.ProcessPoolExecutor(jobs, mp_context=context) as pool:
        try:
            tasks = [pool.submit(_run_part, arguments, work, pairs[i::jobs], threads) for i in range(jobs)]
            parts = [task.result() for task in tasks]
        except KeyboardInterrupt:
            for process in multiprocessing.active_children():
                if process not in others:
                    process.terminate()
            raise
    for part in parts:
        for text in part["warnings"]:
            if text not in report.warnings:
                report.warn(text)
        for phase, seconds in part["seconds"].items():
            entry = report.seconds.setdefault(phase, {"wall": 0.0, "cpu": 0.0})
            for clock in entry:
                entry[clock] += seconds[clock]
    order = {data: i for i, (data, _) in enumerate(pairs)}
    found = [entry for part in parts for entry in zip(part["files"], part["lines"])]
    found.sort(key=lambda entry: order[entry[0]["data"]])
    report.facts["files"] = [facts for facts, _ in found]
    report.lines += [line for _, line in found]
    for part in parts:
        if part["error"] is not None:
            raise part["error"]


def _run_part(arguments, work, pairs, threads):
    """In a process of its own: the facts, lines and times of some files, and the error that ended them."""
    from .report import Report

    set_number_of_threads(threads)
    arguments = _changed(arguments, quiet=True, jobs=1)
    report = Report(arguments)
    files, error = [], None
    with ended_by_signals(), report.collecting_warnings():
        read_surfaces(arguments)
        try:
            for facts in _one_by_one(arguments, report, work, pairs):
                files.append(facts)
        except (ValueError, ArithmeticError, RuntimeError, OSError, MemoryError) as problem:
            error = problem
    return {"files": files, "lines": report.lines, "seconds": report.seconds,
            "warnings": report.warnings, "error": error}
