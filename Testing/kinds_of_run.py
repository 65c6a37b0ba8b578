# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The kinds of run of kinds_of_run.txt: (name, class, values of properties by their names). A value is a number,
a word, or of an array (name, whether it is of cells)."""

import os


def value_of(name, text):
    if name.endswith("Array"):
        array, _, place = text.partition("@")
        return array, place == "cells"
    try:
        return float(text) if "." in text else int(text)
    except ValueError:
        return text


def kinds_of_run():
    with open(os.path.splitext(os.path.abspath(__file__))[0] + ".txt", encoding="utf-8") as file:
        lines = [line.split() for line in file if line.strip() and not line.startswith(("#", "model "))]
    return [(name, class_name, {key: value_of(key, text) for key, _, text in (
        word.partition("=") for word in words) if text}) for name, class_name, _, *words in lines]
