#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Usage: bound_shares.py SOURCE FILE...

Lists the numeric bounds of the tests with the largest share of each that is used, from the files that
test programs of several builds write (BoundShares.h; one build per file). A bound of round-off, below
1e-8, that is used by more than 0.3 fails: on a machine that none of the builds stands for, it may not
hold. Bounds that are larger say something, such as an order or a published figure; they are listed, and
do not fail."""

import pathlib
import re
import sys

LARGEST_SHARE = 0.3
ROUND_OFF = 1e-8


def read_shares(paths, source):
    """The largest share of each place and bound."""
    shares = {}
    for path in paths:
        for line in path.read_text().splitlines():
            place, bound, share = line.split("\t")
            key = (place.replace(f"{source}/", ""), bound)
            shares[key] = max(shares.get(key, 0.0), float(share), key=lambda x: (x != x, x))
    return shares


def is_of_round_off(bound):
    """Whether the smallest number in the text of a bound is one of round-off."""
    numbers = [float(number) for number in re.findall(r"\d+\.?\d*e-\d+", bound)]
    return bool(numbers) and min(numbers) < ROUND_OFF


def main(source, *paths):
    shares = read_shares([pathlib.Path(path) for path in paths], source)
    failed = 0
    for (place, bound), share in sorted(shares.items(), key=lambda item: -item[1]):
        fails = is_of_round_off(bound) and not share <= LARGEST_SHARE
        failed += fails
        print(f"{'FAIL' if fails else '    '} {share:9.2e} of {bound:<40} {place}")
    print(f"{len(shares)} bounds in {len(paths)} builds; {failed} of round-off are used by more than "
          f"{LARGEST_SHARE}")
    return 1 if failed or not shares else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
