# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The table of equations in Filters/Core/README.md. Argument: the folder of the sources."""
import re
import sys
import unittest
from pathlib import Path

CORE = Path(sys.argv.pop()) / "Filters/Core"
ROW = re.compile(r"^\| (\(.*?\)) \| .* \| `(.*)` \| `(.*)` \|$", re.M)
ROWS = [(re.findall(r"\((\d+)\)", numbers), file, name)
        for numbers, file, name in ROW.findall((CORE / "README.md").read_text(encoding="utf-8"))]


def comments_of(text, name):
    """The comments before the declarations of a name: the block of /// above it."""
    return [match.group(1) for match in re.finditer(
        r"((?:^ *///.*\n)+)(?:\n|template.*\n)*^[^/\n]*\b%s\b" % name, text, re.M)]


class Equations(unittest.TestCase):
    def test_each_of_the_paper_has_one_row(self):
        self.assertEqual(sorted(int(n) for numbers, _, _ in ROWS for n in numbers), list(range(1, 25)))

    def test_the_comment_of_each_function_has_the_number(self):
        for numbers, file, name in ROWS:
            text = (CORE / file).read_text(encoding="utf-8")
            found = "".join(comments_of(text, name))
            for number in numbers:
                with self.subTest(equation=number, function=name):
                    self.assertIn(f"({number})", found)


if __name__ == "__main__":
    unittest.main()
