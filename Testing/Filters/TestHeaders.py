# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Headers and sources of the VTK classes under a VTK with an ABI namespace, as distributions build it
(VTK_ABI_NAMESPACE_NAME): each public header alone, all of them in any order, and the sources. Only the
syntax is checked.

    TestHeaders.py SOURCE COMPILE_COMMANDS COMPILER

Exit code 77 (skipped) means that this VTK, 9.1, knows no such namespace."""

import json
import os
import random
import re
import shlex
import subprocess
import sys
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

FOLDER, COMMANDS, COMPILER = Path(sys.argv[1], "Filters"), Path(sys.argv[2]), sys.argv[3]
# vtkABINamespace.h as such a VTK has it: the first definition keeps the header out.
NAMESPACE = ["-DvtkABINamespace_h", "-DVTK_HAS_ABI_NAMESPACE=1", "-DVTK_ABI_NAMESPACE_NAME=other",
             "-DVTK_ABI_NAMESPACE_BEGIN=inline namespace other {", "-DVTK_ABI_NAMESPACE_END=}",
             "-DVTK_ABI_NAMESPACE_MANGLE(x)=other_##x"]


def options():
    """Those by which the compiler finds headers when it compiles the library."""
    # VTK 9.7 names the target after the library.
    entry = next(each for each in json.loads(COMMANDS.read_text())
                 if re.search(r"(^|[ /])Filters/CMakeFiles/(Filters|vtkSurfaceDiffusion)\.dir/", each["command"]))
    words = iter(shlex.split(entry["command"]))
    kept = []
    for word in words:
        if word == "-isystem":
            kept += [word, next(words)]
        elif word.startswith(("-I", "-D", "-isystem", "-std")):
            kept.append(word)
    return kept


OPTIONS = options()
FOLDERS = [Path(word[2:] if word.startswith("-I") else word) for word in OPTIONS if word[0] != "-" or word[1] == "I"]
# Private parts begin with "#pragma once".
HEADERS = sorted(header for header in FOLDER.glob("vtk*.h") if "#pragma once" not in header.read_text())
SOURCES = sorted(each for folder in (".", "Conversion", "Distributed") for each in (FOLDER / folder).glob("*.cxx"))


def messages(included, text=""):
    """What the compiler says against files one after the other, and a text below them."""
    text = "".join('#include "%s"\n' % file for file in included) + text
    done = subprocess.run([COMPILER, *OPTIONS, *NAMESPACE, "-fsyntax-only", "-x", "c++", "-"], input=text,
                          text=True, capture_output=True)
    return done.stderr if done.returncode else ""


class TestHeaders(unittest.TestCase):
    def test_each_header_alone(self):
        self.assertGreater(len(HEADERS), 15)
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for header, said in zip(HEADERS, pool.map(lambda header: messages([header]), HEADERS)):
                self.assertEqual(said, "", header.name)

    def test_headers_in_any_order(self):
        shuffled = random.Random(76).sample(HEADERS, len(HEADERS))
        for order in (HEADERS, HEADERS[::-1], shuffled):
            self.assertEqual(messages(order, "other::vtkFVMHeatFilter* filter;\nother::vtkPolyData* data;\n"), "")

    def test_sources(self):
        self.assertGreater(len(SOURCES), 40)
        self.assertEqual(messages(SOURCES), "")

    def test_a_class_outside_of_the_namespace_is_found(self):
        self.assertIn("ambiguous", messages(HEADERS[:1], "class vtkPolyData;\nvtkPolyData* data;\n"))


if __name__ == "__main__":
    if not any((folder / "vtkABINamespace.h").exists() for folder in FOLDERS):
        print("this VTK has no vtkABINamespace.h")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
