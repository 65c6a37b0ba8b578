#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Compare the skipped tests of a run of ctest with those that may be skipped. Arguments: the file that
ctest --output-junit wrote, and may_be_skipped.txt. Skipped tests that the list does not have are
printed, and the exit code is 1."""
import re
import sys
from pathlib import Path
from xml.etree import ElementTree


def reasons_of(case):
    """Why the test, or a part of it, was skipped: one reason for each skipped part. A test of ctest has
    parts if it is a program of GoogleTest (on several processes) or of Python's unittest."""
    output = re.sub(r"(\[NON-XML-CHAR-0x1B\]|\x1b)\[[0-9;]*m", "", case.findtext("system-out") or "")
    parts = re.findall(r"\.\.\. skipped ['\"](.*)['\"]$", output, re.MULTILINE)
    # By name, since the lines of several processes may stand between a name and its reason
    why = " ".join(dict.fromkeys(re.findall(r": Skipped\n(.*)", output)))
    parts += [f"{name}: {why}" for name in dict.fromkeys(
        re.findall(r"^\[  SKIPPED \] ([^\s,]*\.[^\s,]+)", output, re.MULTILINE))]
    counted = sum(map(int, re.findall(r"^(?:OK|FAILED) \(.*skipped=(\d+)", output, re.MULTILINE)))
    if counted > len(parts):
        parts.append("no reason in the output")
    skipped = case.find("skipped")
    if skipped is not None and not parts:
        lines = output.strip().splitlines()
        parts.append(lines[-1] if lines else skipped.get("message", "no reason in the output"))
    return parts


def rules_of(path):
    """Pairs of regular expressions: of the test's whole name, and of a part of the reason."""
    for line in Path(path).read_text(encoding="utf-8").splitlines():
        if line.strip() and not line.startswith("#"):
            name, reason = line.split(": ", 1)
            yield re.compile(name), re.compile(reason)


def main(results, allowed):
    rules = list(rules_of(allowed))
    unexpected = [(case.get("name"), reason)
                  for case in ElementTree.parse(results).iter("testcase") for reason in reasons_of(case)
                  if not any(name.fullmatch(case.get("name")) and part.search(reason)
                             for name, part in rules)]
    for name, reason in unexpected:
        print(f"skipped: {name}: {reason}")
    if unexpected:
        print(f"These skips are not in {allowed}, so the run has failed.")
    return 1 if unexpected else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
