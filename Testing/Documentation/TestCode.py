# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The examples in the pages of Documentation run, its links lead to files, and its tutorials run."""
import doctest
import os
import re
import runpy
import sys
import unittest
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[2] / "Documentation"
MADE = {"filters", "gallery", "pictures", "cpp"}  # by the build of the site

try:
    import pyvista
except ImportError as problem:
    print(f"skipped: {problem}")
    sys.exit(77)


class TestCode(unittest.TestCase):

    def test_examples_in_pages_give_what_the_pages_say(self):
        attempted = 0
        for page in sorted(FOLDER.glob("*.md")):
            with self.subTest(page.name):
                result = doctest.testfile(str(page), module_relative=False, encoding="utf-8")
                self.assertEqual(result.failed, 0)
                attempted += result.attempted
        self.assertGreater(attempted, 3)

    def test_every_filter_of_the_package_is_on_the_page_that_chooses(self):
        import surfacediffusion as sd

        chosen = (FOLDER / "choose.md").read_text(encoding="utf-8")
        filters = re.findall(r'^    Filter\("(\w+)"', (FOLDER / "generate.py").read_text(), re.M)
        self.assertGreater(len(filters), 5)
        for name in filters:
            self.assertTrue(callable(getattr(sd, name)))
            self.assertIn(f"(filters/{name}.md)", chosen)

    def test_links_between_pages_lead_to_files(self):
        for page in sorted(FOLDER.glob("*.md")):
            for target in re.findall(r"\]\(([^)#:]+)\)", page.read_text(encoding="utf-8")):
                with self.subTest(f"{page.name}: {target}"):
                    known = re.findall(r'": "(\w+)"', (FOLDER / "generate.py").read_text())
                    self.assertTrue(Path(target).parts[0] in MADE or (FOLDER / target).is_file()
                                    or Path(target).stem in known)

    def test_tutorials_run(self):
        if not os.environ.get("SURFACEDIFFUSION_MESH_DIR"):
            self.skipTest("SURFACEDIFFUSION_MESH_DIR is not set (.ci/fetch-test-data)")
        pyvista.Plotter.show = lambda self, *_, **__: self.close()
        sys.path.insert(0, str(FOLDER / "tutorials"))
        tutorials = sorted((FOLDER / "tutorials").glob("plot_*.py"))
        self.assertEqual(len(tutorials), 6)
        for tutorial in tutorials:
            with self.subTest(tutorial.name):
                runpy.run_path(str(tutorial), run_name="__main__")


if __name__ == "__main__":
    unittest.main(verbosity=2)
