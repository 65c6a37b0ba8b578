#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Compare the benchmarks of two builds, side by side in one run.

    compare_builds.py OLD NEW [--seconds S] [--level N] [--filter REGEX] [--limit PERCENT]
                      [--rename OLD=NEW ...] [--out FILE]

OLD and NEW are build folders with SURFACEDIFFUSION_BUILD_BENCHMARKS. Every row (a benchmark at a
size) is measured alternately in the old and in the new build, each time in a new process on one
CPU. Its time is the minimum (CPU time, or real time for rows that measure it). Half of the total
time is for rounds over all rows, the other half for more measurements of the rows that differ by
more than the limit: with these, differences that are only noise disappear.

--level 1 (the default) takes surfaces of up to 41,000 vertices. The exit code is 1 if a row of the
new build is slower by more than the limit.
"""

import argparse
import json
import math
import os
import re
import subprocess
import sys
import time

MILLISECONDS = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}
# The rows of other models and sizes that run_benchmarks.py reports, with levels of their own.
SMALL = r"MinimizeToGap/.*:[3-4]$|LaggedStep/.*:3$|TenSteps/5/[12]/[012]$|Step/mesh:1"


def program(build):
    return os.path.join(build, "bin", "SurfaceDiffusionBenchmarks")


def run(build, *arguments):
    return subprocess.run([program(build), *arguments], check=True, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout


def names_of(build):
    return run(build, "--benchmark_list_tests").split()


class Row:
    """The times of one benchmark at one size in both builds, in milliseconds."""

    def __init__(self, names):
        self.names = names
        self.times = ([], [])

    def measure(self, builds, min_time):
        """Once in each build; which is first changes from time to time."""
        order = (0, 1) if len(self.times[0]) % 2 == 0 else (1, 0)
        for which in order:
            name = self.names[which]
            text = run(builds[which], "--benchmark_filter=^%s$" % re.escape(name),
                       "--benchmark_format=json", "--benchmark_min_time=%g" % min_time)
            row = json.loads(text)["benchmarks"][0]
            if row.get("error_occurred"):
                raise RuntimeError("%s: %s" % (name, row.get("error_message")))
            kind = "real_time" if "/real_time" in name else "cpu_time"
            self.times[which].append(row[kind] * MILLISECONDS[row["time_unit"]])

    def ratio(self):
        return min(self.times[1]) / min(self.times[0])

    def cells(self):
        old, new = (min(times) for times in self.times)
        return "| %s | %.4g | %.4g | %.3f | %d |" % (
            self.names[1], old, new, self.ratio(), len(self.times[0]))


def pair(builds, options):
    """The rows that both builds have, and the names that only one has."""
    renamed = dict(entry.split("=", 1) for entry in options.rename)
    old, new = (names_of(build) for build in builds)
    keep = re.compile(options.filter or "level:[0-%d](/|$)|%s" % (options.level, SMALL))
    of_new = {}
    for name in old:
        parts = name.split("/", 1)
        parts[0] = renamed.get(parts[0], parts[0])
        of_new["/".join(parts)] = name
    rows = [Row((of_new[name], name)) for name in new if name in of_new and keep.search(name)]
    single = [name for name in new if name not in of_new and keep.search(name)]
    single += [name for name in of_new if name not in new and keep.search(name)]
    return rows, single


def measure_until(rows, builds, end, options):
    """Rounds over the rows, at least one, as long as another round may fit in."""
    round_seconds = 0.0
    while True:
        begin = time.monotonic()
        for row in rows:
            row.measure(builds, options.min_time)
        round_seconds = time.monotonic() - begin
        print("%d rows in %.0f s" % (len(rows), round_seconds), file=sys.stderr, flush=True)
        if time.monotonic() + round_seconds > end:
            return


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--seconds", type=float, default=240.0, help="for all measurements")
    parser.add_argument("--level", type=int, default=1, help="of the largest surface, 0 to 4")
    parser.add_argument("--filter", help="rows to measure, in place of --level")
    parser.add_argument("--limit", type=float, default=3.0, help="percent")
    parser.add_argument("--min-time", type=float, default=0.05, help="seconds per measurement")
    parser.add_argument("--rename", nargs="+", default=[], metavar="OLD=NEW",
                        help="benchmarks that have another name in the new build")
    parser.add_argument("--out", help="file for the page, in place of standard output")
    options = parser.parse_args()
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})

    builds = (options.old, options.new)
    rows, single = pair(builds, options)
    if not rows:
        sys.exit("no row is in both builds")
    begin = time.monotonic()
    measure_until(rows, builds, begin + 0.5 * options.seconds, options)

    def beyond():
        return [row for row in rows if abs(row.ratio() - 1.0) > 0.01 * options.limit]

    while beyond() and time.monotonic() - begin < options.seconds:
        for row in beyond():
            if time.monotonic() - begin < options.seconds:
                row.measure(builds, options.min_time)

    mean = math.exp(sum(math.log(row.ratio()) for row in rows) / len(rows))
    head = ["| row | old, ms | new, ms | new/old | measurements |",
            "| --- | --- | --- | --- | --- |"]
    page = head + [row.cells() for row in rows]
    page += ["", "Geometric mean of new/old over %d rows: %.3f." % (len(rows), mean), ""]
    far = sorted(beyond(), key=Row.ratio, reverse=True)
    if far:
        page += ["Beyond %g %%:" % options.limit, ""] + head + [row.cells() for row in far]
    else:
        page += ["No row is beyond %g %%." % options.limit]
    if single:
        page += ["", "In one build only: " + ", ".join(single)]
    text = "\n".join(page) + "\n"
    if options.out:
        with open(options.out, "w", encoding="utf-8") as file:
            file.write(text)
    else:
        print(text, end="")
    sys.exit(any(row.ratio() > 1.0 + 0.01 * options.limit for row in rows))


if __name__ == "__main__":
    main()
