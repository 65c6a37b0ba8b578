# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Text files with points and their values."""
from __future__ import annotations

import re

import numpy as np

from ..files import FileError


def read_table(path):
    """The rows x, y, z, value, ... of a text file, in this order, and the names of the values; None if it is
    none."""
    if not re.search(r"\.(csv|tsv|txt)$", path, re.IGNORECASE):
        return None
    try:
        with open(path, encoding="utf-8-sig") as file:
            lines = [line.strip() for line in file]
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or 'no text'}") from error
    rows, names = [], []
    for i, line in enumerate(lines, start=1):
        if not line or line.startswith("#"):
            continue
        separator = "," if "," in line else ";" if ";" in line else "\t" if "\t" in line else None
        words = [word.strip().strip('"') for word in line.split(separator)]
        try:
            row = [float(word) if word else np.nan for word in words]
        except ValueError:
            if rows or names:
                raise FileError(f"{path}: line {i} is {line[:40]!r}; allowed: numbers x, y, z, value"
                                ) from None
            names = words
            continue
        if len(row) == 1 and not rows and not names:  # a value for each vertex
            return None
        width = len(rows[0]) if rows else len(names) or len(row)
        if len(row) != width or width < 4:
            raise FileError(f"{path}: line {i} has {len(row)} numbers; allowed: x, y, z and as many "
                            "values as the other lines, one or more")
        rows.append(row)
    if not rows:
        raise FileError(f"{path}: no row of numbers; allowed: rows x, y, z, value")
    order = _order_of_columns(path, names) if names else list(range(len(rows[0])))
    return np.array(rows)[:, order], [names[c] for c in order[3:]] if names else [
        f"Value{k + 1}" for k in range(len(rows[0]) - 3)]


def _order_of_columns(path, names):
    """The columns of the coordinates and then the others: those named x, y, z, or Points:0, Points:1,
    Points:2 as ParaView writes them; the first three if no name is one of these."""
    short = [re.sub(r"^points[:_]([012])$", lambda found: "xyz"[int(found[1])], name.lower()) for name in names]
    counts = [short.count(axis) for axis in "xyz"]
    if not any(counts):
        return list(range(len(names)))
    if counts != [1, 1, 1]:
        raise FileError(f"{path}: the line of names has {', '.join(names)}; allowed: each of x, y, z once, or "
                        "none of them if they are the first three")
    places = [short.index(axis) for axis in "xyz"]
    return places + [c for c in range(len(names)) if c not in places]
