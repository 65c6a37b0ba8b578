#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Compare the skipped tests of a run of ctest with those that may be skipped, and all with those that it
must have. Arguments: the file that ctest --output-junit wrote, that of ctest --show-only=json-v1, which
has the labels, may_be_skipped.txt, and must_run.txt. Skipped tests that the first list does not have, and
entries of the second that the run does not have, are printed, and the exit code is 1."""
import json
import re
import sys
from pathlib import Path
from xml.etree import ElementTree


def output_of(case):
    return re.sub(r"(\[NON-XML-CHAR-0x1B\]|\x1b)\[[0-9;]*m", "", case.findtext("system-out") or "")


def count_of(case):
    """How many tests an entry of ctest has: a test of GoogleTest is one for each value of its parameter."""
    count = re.search(r"^\[==========\] Running (\d+) tests? from", output_of(case), re.MULTILINE)
    return int(count.group(1)) if count else 1


def reasons_of(case):
    """Why the test, or a part of it, was skipped: one reason for each skipped part. A test of ctest has
    parts if it is a program of GoogleTest (on several processes) or of Python's unittest."""
    output = output_of(case)
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


def lines_of(path):
    return [line for line in Path(path).read_text(encoding="utf-8").splitlines()
            if line.strip() and not line.startswith("#")]


def rules_of(path):
    """Pairs of regular expressions: of the test's whole name, and of a part of the reason."""
    for line in lines_of(path):
        name, reason = line.split(": ", 1)
        yield re.compile(name), re.compile(reason)


def labels_of(path):
    """The labels of each test, by its name."""
    tests = json.loads(Path(path).read_text(encoding="utf-8"))["tests"]
    return {test.get("name"): [label for entry in test.get("properties", []) if entry["name"] == "LABELS"
                               for label in entry["value"]] for test in tests}


def missing_of(needed, counts, labels):
    """The entries of must_run.txt that a run does not fulfil. counts: the number of tests of each entry of
    ctest, by its name."""
    for entry in lines_of(needed):
        least = re.fullmatch(r"(\w+): (\d+) tests", entry)
        if least is None:
            if not any(re.fullmatch(entry, name) for name in counts):
                yield entry
            continue
        found = sum(count for name, count in counts.items() if least.group(1) in labels.get(name, []))
        if found < int(least.group(2)):
            yield f"{entry}, only {found}"


def main(results, listed, allowed, needed):
    rules = list(rules_of(allowed))
    cases = list(ElementTree.parse(results).iter("testcase"))
    unexpected = [(case.get("name"), reason) for case in cases for reason in reasons_of(case)
                  if not any(name.fullmatch(case.get("name")) and part.search(reason)
                             for name, part in rules)]
    counts = {case.get("name"): count_of(case) for case in cases}
    missing = list(missing_of(needed, counts, labels_of(listed)))
    for name, reason in unexpected:
        print(f"skipped: {name}: {reason}")
    if unexpected:
        print(f"These skips are not in {allowed}, so the run has failed.")
    for name in missing:
        print(f"not run: {name}")
    if missing:
        print(f"The run does not have these tests of {needed}, so it has failed.")
    return 1 if unexpected or missing else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
