# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the command doctor, of --version, and of completion in a shell."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import types
import unittest
from importlib import metadata
from unittest import mock

from samples import run

import surfacediffusion
from surfacediffusion import _core
from surfacediffusion.command import doctor


def completions(line):
    """What a shell gets for the line, whose last word is to be completed."""
    with tempfile.NamedTemporaryFile("r") as answer:
        variables = {"_ARGCOMPLETE": "1", "COMP_LINE": line, "COMP_POINT": str(len(line)), "COMP_TYPE": "9",
                     "_ARGCOMPLETE_IFS": "\n", "_ARGCOMPLETE_STDOUT_FILENAME": answer.name}
        subprocess.run([sys.executable, "-m", "surfacediffusion.command"], check=True, timeout=60,
                       env={**os.environ, **variables}, stdout=subprocess.DEVNULL)
        return {word.strip() for word in answer.read().split("\n")}


class Doctor(unittest.TestCase):
    def test_every_result_is_right_here(self):
        code, out, error = run("doctor")
        self.assertEqual((code, error), (0, ""))
        self.assertIn(f"surfacediffusion {surfacediffusion.__version__} (", out)
        self.assertEqual(out.count("\nright: "), len(doctor.CHECKS))
        self.assertNotIn("WRONG", out)

    def test_the_report_has_versions_and_errors(self):
        code, out, _ = run("doctor", "--json")
        report = json.loads(out)
        self.assertEqual(code, 0)
        self.assertRegex(report["version"], r"\b(GNU|Clang) \d")
        self.assertEqual(report["packages"]["nibabel"], __import__("nibabel").__version__)
        for check in report["checks"]:
            self.assertLessEqual(check["error"], check["allowed"], check)
        self.assertLess(sum(check["seconds"] for check in report["checks"]), 60)

    def test_a_vtk_that_pip_does_not_know_is_found(self):
        core = types.ModuleType("vtkmodules.vtkCommonCore")
        core.vtkVersion = types.SimpleNamespace(GetVTKVersion=lambda: "9.2.6")
        known = metadata.version

        def version(name):
            if name == "vtk":
                raise metadata.PackageNotFoundError(name)
            return known(name)
        parts = {"vtkmodules": types.ModuleType("vtkmodules"), "vtkmodules.vtkCommonCore": core}
        with mock.patch.object(doctor.metadata, "version", version), mock.patch.object(doctor, "CHECKS", ()):
            with mock.patch.dict(sys.modules, parts):
                _, out, _ = run("doctor", "--json")
            self.assertEqual(json.loads(out)["packages"]["vtk"], "9.2.6")
            with mock.patch.dict(sys.modules, {"vtkmodules": None, "vtkmodules.vtkCommonCore": None}):
                _, out, _ = run("doctor", "--json")
            self.assertIsNone(json.loads(out)["packages"]["vtk"])

    def test_a_wrong_result_is_an_error_that_names_it(self):
        for wrong in (0.3, float("nan")):
            checks = (("heat against the solution", 0.2, lambda: 0.1), ("distance", 0.2, lambda: wrong))
            with mock.patch.object(doctor, "CHECKS", checks):
                code, out, error = run("doctor")
            self.assertEqual((code, error), (1, "surfacediffusion: wrong results here: distance\n"))
            self.assertIn("right: heat against the solution", out)
            self.assertIn("WRONG: distance", out)
            with mock.patch.object(doctor, "CHECKS", checks):
                code, out, _ = run("doctor", "--json")
            report = json.loads(out)
            self.assertEqual((code, report["error"]), (1, "wrong results here: distance"))
            self.assertEqual(report["checks"][0]["error"], 0.1)

    def test_the_checks_see_errors_of_the_numerics(self):
        """Each error grows beyond what is allowed if the surface is another one."""
        ball = surfacediffusion.sphere
        with mock.patch.object(surfacediffusion, "sphere",
                               lambda subdivisions, radius=1.0: ball(subdivisions, 1.1 * radius)):
            for name, allowed, check in doctor.CHECKS:
                if allowed > 0:
                    self.assertGreater(check(), allowed, name)


class Version(unittest.TestCase):
    def test_it_names_the_compiler(self):
        code, out, _ = run("--version")
        self.assertEqual((code, out), (0, f"surfacediffusion {surfacediffusion.__version__} ({_core.build})\n"))
        self.assertRegex(_core.build, r"^(commit [0-9a-f]{10}(-dirty)?, )?\w+ \d+(\.\d+)+, \w+$")


class Completion(unittest.TestCase):
    def test_commands_and_options_are_completed(self):
        self.assertEqual(completions("surfacediffusion sm"), {"smooth"})
        self.assertEqual(completions("surfacediffusion smooth --s"), {"--sigma", "--steps", "--surface-only"})

    def test_each_shell_gets_its_script(self):
        scripts = [run("--completion", shell) for shell in ("bash", "zsh", "fish")]
        for code, out, error in scripts:
            self.assertEqual((code, error), (0, ""))
            self.assertIn("surfacediffusion", out)
        self.assertIn("complete -o", scripts[0][1])
        self.assertIn("compdef", scripts[1][1])
        self.assertIn("complete --command surfacediffusion", scripts[2][1])
        if shutil.which("bash"):
            subprocess.run(["bash", "-c", scripts[0][1] + "\ncomplete -p surfacediffusion"], check=True,
                           stdout=subprocess.DEVNULL)
        self.assertEqual(run("--completion", "tcsh")[0], 2)
        with mock.patch.dict(sys.modules, {"argcomplete": None}):
            code, _, error = run("--completion", "bash")
        self.assertEqual(code, 2)
        self.assertIn("pip install argcomplete", error)

    def test_nothing_is_said_without_argcomplete(self):
        variables = {"_ARGCOMPLETE": "1", "COMP_LINE": "surfacediffusion sm", "COMP_POINT": "19"}
        with mock.patch.dict(sys.modules, {"argcomplete": None}), mock.patch.dict(os.environ, variables):
            code, out, _ = run("--version")
        self.assertEqual((code, out.split()[0]), (0, "surfacediffusion"))


if __name__ == "__main__":
    unittest.main()
