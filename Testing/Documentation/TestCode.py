# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The examples in the pages of Documentation run, its links lead to files, each filter has its page, and its tutorials
run."""
import doctest
import os
import re
import runpy
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[2] / "Documentation"
MADE = {"gallery", "pictures", "cpp", "command.md"}  # by the build of the site

try:
    import pyvista
except ImportError as problem:
    print(f"skipped: {problem}")
    sys.exit(77)
pyvista.OFF_SCREEN = True  # on a display, show() waits until its window is closed


class TestCode(unittest.TestCase):

    def test_examples_in_pages_give_what_the_pages_say(self):
        attempted = 0
        for page in sorted(FOLDER.glob("*.md")):
            with self.subTest(page.name):
                result = doctest.testfile(str(page), module_relative=False, encoding="utf-8")
                self.assertEqual(result.failed, 0)
                attempted += result.attempted
        self.assertGreater(attempted, 3)

    def test_every_filter_has_a_page_with_its_parts_and_is_on_the_page_that_chooses(self):
        chosen = (FOLDER / "choose.md").read_text(encoding="utf-8")
        filters = dict(re.findall(r'^    Filter\("(\w+)", "(\w+)"',
                                  (FOLDER / "generate.py").read_text(), re.M))
        classes = {path.stem for path in (FOLDER.parent / "Filters").glob("vtk*Filter.h")}
        self.assertEqual(set(filters.values()), classes - {"vtkSurfaceFilter"})
        for name in filters:
            with self.subTest(name):
                self.assertIn(f"(filters/{name}.md)", chosen)
                page = (FOLDER / "filters" / f"{name}.md").read_text(encoding="utf-8")
                self.assertEqual(re.findall(r"^## (.+)", page, re.M), [
                    "Equation", "Effect of the properties", "Exact tests", "Limits", "Sources"])
                self.assertIn(f'"{name}": (', (FOLDER / "effects.py").read_text(encoding="utf-8"))

    def test_exact_tests_of_the_pages_exist(self):
        """In the files that the page's entry names."""
        entries = re.findall(r'^    Filter\("(\w+)", "\w+",\s*\(([^)]*)\)', (FOLDER / "generate.py").read_text(),
                             re.M)
        self.assertGreater(len(entries), 10)
        for name, files in entries:
            tests = set()
            for file in re.findall(r'"(\w+)"', files):
                path = FOLDER.parent / "Testing/Core" / f"Test{file}.cxx"
                tests.update(re.findall(r"^TEST(?:_[FP])?\(\w+,\s*(\w+)\)", path.read_text(), re.M))
            page = (FOLDER / "filters" / f"{name}.md").read_text(encoding="utf-8")
            for line in re.findall(r"^@@exact (.+)$", page, re.M):
                with self.subTest(name):
                    self.assertEqual(set(line.split()) - tests, set())

    def test_links_between_pages_lead_to_files(self):
        for page in sorted(FOLDER.glob("*.md")):
            for target in re.findall(r"\]\(([^)#:]+)\)", page.read_text(encoding="utf-8")):
                with self.subTest(f"{page.name}: {target}"):
                    known = re.findall(r'": "(\w+)"', (FOLDER / "generate.py").read_text())
                    self.assertTrue(Path(target).parts[0] in MADE or (FOLDER / target).is_file()
                                    or Path(target).stem in known)

    def test_links_of_the_pages_of_the_repository_lead_to_files(self):
        root = FOLDER.parent
        pages = [*root.glob("*.md"), *(path for folder in ("Examples", "Filters", "Packaging", "Plugin",
                                                           "Testing")
                                       for path in (root / folder).rglob("*.md"))]
        self.assertGreater(len(pages), 10)
        for page in pages:
            for target in re.findall(r"\]\(([^)#:\s]+)\)", page.read_text(encoding="utf-8")):
                with self.subTest(f"{page.name}: {target}"):
                    self.assertTrue((page.parent / target).exists())

    def test_the_page_of_the_command_has_every_option(self):
        from surfacediffusion.command.arguments import make_parser

        sys.path.insert(0, str(FOLDER))
        import command_reference

        page = command_reference.page()
        commands = make_parser()._subparsers._group_actions[0].choices
        self.assertEqual(re.findall(r"^## (.+)", page, re.M), list(commands))
        for name, parser in commands.items():
            part = page.split(f"\n## {name}\n")[1].split("\n## ")[0]
            self.assertIn(f"surfacediffusion {name} ", part)
            for option in re.findall(r"(?<=[ ,\[])--?[a-z][a-z-]+", parser.format_usage()):
                if option not in ("-h", "--help"):
                    self.assertRegex(part, f"`.*{option}[ ,`]")

    def test_every_public_name_is_on_a_page(self):
        import surfacediffusion.examples
        import surfacediffusion.files
        import surfacediffusion.pyvista as of_meshes
        import surfacediffusion.xarray as of_arrays

        pages = "".join((FOLDER / f"{page}.md").read_text(encoding="utf-8")
                        for page in ("python", "results", "pyvista", "files"))
        shown = re.findall(r"^\.\. auto(?:function|class):: (\S+?)(?:\(\))?$", pages, re.M)
        public = [f"{module.__name__}.{name}" for module in (
            surfacediffusion, surfacediffusion.examples, surfacediffusion.files, of_meshes, of_arrays)
            for name in module.__all__]
        self.assertEqual(sorted(shown), sorted(public))

    def test_the_doors_of_the_readme_run(self):
        from surfacediffusion.examples import fetch
        from surfacediffusion.files import read_data, read_surface

        doors = (FOLDER.parent / "README.md").read_text(encoding="utf-8").split("## Filters")[0]
        commands = re.findall(r"^surfacediffusion (.+)", doors, re.M)
        self.assertEqual(len(commands), 3)
        self.assertLessEqual(doors.count("\n"), 60)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        white, thickness = (fetch(f"{name}_left.gii.gz") for name in ("white", "thick"))
        surface, data = read_surface(white), read_data(thickness)
        surface.save("lh.midthickness.surf.gii", surface.points)
        data.save("lh.thickness.shape.gii", [data.parts[0].values])
        scan = pyvista.PolyData.from_regular_faces(surface.points, surface.faces)
        scan["thickness"] = data.parts[0].values[:, 0]
        scan.save("scan.vtp")
        scan.save("scan.ply")
        pyvista.PolyData.plot = lambda *_, scalars: self.assertEqual(scalars, "thicknessDiffused")
        exec(re.search(r"```python\n(.+?)```", doors, re.DOTALL).group(1), {})
        for command in commands:
            subprocess.run([sys.executable, "-m", "surfacediffusion", *command.split()], check=True,
                           stdout=subprocess.DEVNULL)
        self.assertTrue(os.path.isfile("lh.smooth.shape.gii") and os.path.isfile("clean.ply"))

    def test_tutorials_run(self):
        tutorials = sorted((FOLDER / "tutorials").glob("plot_*.py"))
        self.assertEqual(len(tutorials), 9)
        for tutorial in tutorials:
            with self.subTest(tutorial.name):
                runpy.run_path(str(tutorial), run_name="__main__")


if __name__ == "__main__":
    unittest.main(verbosity=2)
