#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Enter a check that has passed into CHECKS.md. Arguments: its name, and its log."""
import re
import subprocess
import sys
from datetime import date
from pathlib import Path

HERE = Path(__file__).parent
PAGE = HERE / "CHECKS.md"
ROW = re.compile(r"^\| `([\w-]+)` \| (.*?) \| (\d{4}-\d\d-\d\d) \| ([0-9a-f]{10}) \| (\S+) \|$", re.MULTILINE)
HEAD = """# Checks before a release

`Testing/run-tests.sh checks` runs them, and enters those that pass. A row has the day and the commit of
the last run that passed, and the version of the project then. `Packaging.TestChecks`
compares the versions with the last release of the changelog.

| check | result | day | commit | version |
| --- | --- | --- | --- | --- |
"""


def result_of(log):
    """The count of ctest, of the fuzzer, of the links of the site or of the bounds."""
    bounds = re.findall(r"^(\d+ bounds in \d+ builds); 0 of", log, re.MULTILINE)
    if bounds:
        return f"{bounds[-1]}, none of round-off used by more than 0.3"
    passed = re.findall(r"^\d+% tests passed, \d+ tests failed out of (\d+)", log, re.MULTILINE)
    if passed:
        return f"{passed[-1]} tests pass"
    pages = re.findall(r"^(\d+ pages, \d+ links), 0 broken$", log, re.MULTILINE)
    if pages:
        return f"{pages[-1]}, none broken"
    runs = re.findall(r"^stat::number_of_executed_units:\s*(\d+)", log, re.MULTILINE)
    return f"{runs[-1]} runs without a finding"


def stale_checks(names, page, changelog):
    """The checks that have not passed since the last release of the changelog; none before the first."""
    releases = re.findall(r"^## (\d+)\.(\d+)\.(\d+)(?!\d| \(unreleased\))", changelog, re.MULTILINE)  # newest first
    last = tuple(map(int, releases[0])) if releases else (-1,)
    passed = {row[0]: tuple(map(int, row[4].split("."))) for row in ROW.findall(page)}
    return [name for name in names if passed.get(name, (-1,)) < last]


def main(check, log):
    def git(*arguments):
        return subprocess.run(["git", *arguments], cwd=HERE, check=True, capture_output=True,
                              text=True).stdout.strip()

    changed = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!CHECKS.md")
    if changed:
        sys.exit(f"{check} is not entered into {PAGE.name}: there are changes that are not committed")
    version = re.search(r"VERSION (\d+\.\d+\.\d+)", (HERE.parent / "CMakeLists.txt").read_text()).group(1)
    rows = {row[0]: row for row in ROW.findall(PAGE.read_text())} if PAGE.exists() else {}
    rows[check] = (check, result_of(Path(log).read_text(errors="replace")), date.today().isoformat(),
                   git("rev-parse", "--short=10", "HEAD"), version)
    PAGE.write_text(HEAD + "".join("| `{}` | {} | {} | {} | {} |\n".format(*rows[name])
                                   for name in sorted(rows)))
    print(" ".join(rows[check]))


if __name__ == "__main__":
    main(*sys.argv[1:])
