# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command `surfacediffusion`: smoothing, denoising, inpainting and textures for files.

main() runs a command line. Exit codes: 0 success, 1 the computation failed or was interrupted,
2 arguments or files are wrong. Errors are one line on standard error.

A module for each family of commands declares their arguments and runs them: smoothing, denoising,
filling, dilating, edges, parts, shape, distances, scales, fields, resampling, workbench, info, doctor. They are
made of the arguments in `common` and `values`, and of the stages of a run in `stages`, `inputs`, `batch` and
`report`. `arguments` has the list of all commands, in which a new one is entered.
"""
from __future__ import annotations

import sys

from .._threads import set_number_of_threads
from ..files import FileError
from .arguments import parse
from .common import PROGRAM
from .inputs import ArgumentProblem, check_files
from .report import Report
from .signals import ended_by_signals


def main(argv=None) -> int:
    """Run the command line `argv` (default: that of the process); returns the exit code."""
    argv = sys.argv[1:] if argv is None else list(argv)
    try:
        arguments = parse(argv)
    except SystemExit as finished:  # --help and --version; argparse's own errors
        return int(finished.code or 0)
    except ArgumentProblem as error:
        print(f"{PROGRAM}: {error}", file=sys.stderr)
        return 2
    with ended_by_signals():
        return _run(arguments)


def _run(arguments):
    report = Report(arguments)
    try:
        if arguments.threads is not None:
            set_number_of_threads(arguments.threads)
        check_files(arguments)
        with report.collecting_warnings():
            arguments.run(arguments, report)
    except (FileError, ArgumentProblem, ValueError) as error:
        return report.fail(error, 2)
    except KeyboardInterrupt as interruption:
        return report.fail(str(interruption) or "interrupted", 1)
    except MemoryError:
        return report.fail("out of memory", 1)
    except (ArithmeticError, RuntimeError, OSError) as error:
        return report.fail(error, 1)
    except Exception as error:  # a defect of this program; the user still gets one line
        return report.fail(f"internal error: {type(error).__name__}: {error}", 1)
    return report.finish()
