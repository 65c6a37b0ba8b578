# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What run-tests.sh and run-checks.sh rely on. Argument: the folder of the sources."""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(sys.argv.pop())
TESTING = SOURCE / "Testing"
sys.path.insert(0, str(TESTING))
from record_check import HEAD, ROW, result_of, stale_checks  # noqa: E402


def case(name, output, skipped=""):
    return f'<testcase name="{name}">{skipped}<system-out>{output}</system-out></testcase>'


class Skips(unittest.TestCase):

    def check(self, cases, rules="", needed="", labels=()):
        """The exit code and the output of check_skips.py. labels: pairs of a test and its label."""
        with tempfile.TemporaryDirectory() as folder:
            results, allowed = Path(folder, "tests.xml"), Path(folder, "allowed.txt")
            listed = Path(folder, "tests.json")
            listed.write_text(json.dumps({"tests": [
                {"name": name, "properties": [{"name": "LABELS", "value": [label]}]} for name, label in labels]}))
            results.write_text(f"<testsuite>{''.join(cases)}</testsuite>")
            allowed.write_text("# reasons\n\n" + rules)
            must_run = Path(folder, "needed.txt")
            must_run.write_text("# names\n" + needed)
            run = subprocess.run([sys.executable, TESTING / "check_skips.py", results, listed, allowed,
                                  must_run], capture_output=True, text=True)
        return run.returncode, run.stdout

    def test_a_run_without_skips_passes_in_silence(self):
        self.assertEqual(self.check([case("A", "skipped nothing\nOK")]), (0, ""))

    def test_skips_of_ctest_googletest_and_unittest_are_found(self):
        code, text = self.check([
            case("ByCode", "skipped: no tool", '<skipped message="SKIP_RETURN_CODE=77"/>'),
            case("ByGoogleTest", "[ RUN      ] A.b\nx.cxx:80: Skipped\nno meshes\n\n[  SKIPPED ] A.b (0 ms)"),
            case("ByUnittest", "test_a (__main__.T.test_a) ... skipped 'no VTK'\n\nOK (skipped=1)"),
            case("WithoutReason", "..s.\n\nOK (skipped=1)"),
        ])
        self.assertEqual(code, 1)
        self.assertEqual(text.splitlines()[:4], [
            "skipped: ByCode: skipped: no tool", "skipped: ByGoogleTest: A.b: no meshes",
            "skipped: ByUnittest: no VTK", "skipped: WithoutReason: no reason in the output"])

    def test_tests_that_were_not_made_are_found(self):
        cases = [case("Plugin.Toolbar", "OK"), case("Parallel.Program.4", "OK")]
        self.assertEqual(self.check(cases, needed="Plugin\\.Toolbar\nParallel\\..*\n"), (0, ""))
        code, text = self.check(cases, needed="Plugin\\.Tool\nParallel\\..*\n")
        self.assertEqual((code, text.splitlines()[0]), (1, "not run: Plugin\\.Tool"))

    def test_a_label_with_fewer_tests_is_found(self):
        two = "[==========] Running 2 tests from 1 test suite.\n[==========] 2 tests from 1 test suite ran."
        cases = [case("A", "OK"), case("B", "OK"), case("C", two)]
        labels = [("A", "core"), ("B", "core"), ("C", "vtk"), ("NotRun", "core")]
        self.assertEqual(self.check(cases, needed="vtk: 2 tests\n", labels=labels), (0, ""))
        self.assertEqual(self.check(cases, needed="core: 2 tests\n", labels=labels), (0, ""))
        code, text = self.check(cases, needed="core: 3 tests\nmpi: 1 tests\n", labels=labels)
        self.assertEqual((code, text.splitlines()[:2]),
                         (1, ["not run: core: 3 tests, only 2", "not run: mpi: 1 tests, only 0"]))

    def test_every_label_must_run(self):
        rules = dict(re.findall(r"^(\w+): (\d+) tests$", (TESTING / "must_run.txt").read_text(), re.M))
        table = re.findall(r"^\| `([a-z]+)` \|", (SOURCE / "CONTRIBUTING.md").read_text(), re.M)
        self.assertEqual(set(rules), set(table) - {"versions"})

    def test_only_the_listed_reason_is_allowed(self):
        cases = [case("Command.A", "test_a (T) ... skipped 'root may write'\n\nOK (skipped=1)")]
        self.assertEqual(self.check(cases, "Command\\..*: root may\n"), (0, ""))
        self.assertEqual(self.check(cases, "Command\\..*: no VTK\n")[0], 1)
        self.assertEqual(self.check(cases, "Command: root may\n")[0], 1)


class TestData(unittest.TestCase):

    def configure(self, meshes, wheels):
        with tempfile.TemporaryDirectory() as folder:
            environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
            return subprocess.run(
                ["cmake", "-S", SOURCE, "-B", folder, "-DSURFACEDIFFUSION_HOST=None", "-DBUILD_TESTING=ON",
                 "-DSURFACEDIFFUSION_REQUIRE_TEST_DATA=ON", f"-DSURFACEDIFFUSION_MESH_DIR={meshes}",
                 f"-DSURFACEDIFFUSION_WHEEL_DIR={wheels}"],
                capture_output=True, text=True, env=environment)

    def test_an_empty_folder_of_meshes_or_wheels_is_an_error(self):
        with tempfile.TemporaryDirectory() as data:
            meshes, wheels = Path(data, "meshes"), Path(data, "wheels")
            meshes.mkdir()
            wheels.mkdir()
            self.assertIn("there is no file", self.configure(meshes, wheels).stderr)
            (meshes / "a.off").touch()
            (wheels / "a.whl").touch()
            run = self.configure(meshes, wheels)
            self.assertNotEqual(run.returncode, 0)
            self.assertIn("there is no file", run.stderr)
            self.assertIn("/numpy/", run.stderr)


class Host(unittest.TestCase):

    def test_an_unknown_host_is_an_error_that_names_the_allowed_ones(self):
        with tempfile.TemporaryDirectory() as folder:
            for host in ("Foo", "paraview", "None;VTK"):
                run = subprocess.run(["cmake", "-S", SOURCE, "-B", folder, f"-DSURFACEDIFFUSION_HOST={host}"],
                                     capture_output=True, text=True)
                self.assertNotEqual(run.returncode, 0, host)
                self.assertIn(f"SURFACEDIFFUSION_HOST is {host}; allowed: ParaView, VTK, None",
                              " ".join(run.stderr.split()))


class Checks(unittest.TestCase):

    def test_each_check_has_passed_since_the_last_release(self):
        page = (TESTING / "CHECKS.md").read_text()
        script = (TESTING / "run-checks.sh").read_text()
        names = re.search(r"\|\| set -- (.*)", script).group(1).split()
        self.assertLessEqual({row[0] for row in ROW.findall(page)}, set(names))
        self.assertEqual(stale_checks(names, page, (SOURCE / "CHANGELOG.md").read_text()), [])

    def test_a_check_without_a_row_or_of_a_former_version_is_stale(self):
        page = HEAD + "".join(f"| `{name}` | 1 tests pass | 2026-01-02 | {'a' * 10} | {version} |\n"
                              for name, version in (("old", "0.9.12"), ("new", "1.2.0")))
        names = ["new", "none", "old"]
        for changelog, stale in (("# Changelog\n\n## 1.0.0\n\n## 0.9.0\n", ["none", "old"]),
                                 ("## 2.0.10 (unreleased)\n\n## 1.10.0\n", names),
                                 ("## 1.0.10 (unreleased)\n", [])):
            self.assertEqual(stale_checks(names, page, changelog), stale)

    def test_the_counts_of_ctest_of_the_fuzzer_and_of_the_site_are_read(self):
        self.assertEqual(result_of("100% tests passed, 0 tests failed out of 12\n"), "12 tests pass")
        self.assertEqual(result_of("stat::number_of_executed_units: 345\n"), "345 runs without a finding")
        self.assertEqual(result_of("4 pages, 56 links, 0 broken\n"), "4 pages, 56 links, none broken")
        self.assertEqual(result_of("7 bounds in 6 builds; 0 of round-off are used by more than 0.3\n"),
                         "7 bounds in 6 builds, none of round-off used by more than 0.3")


if __name__ == "__main__":
    unittest.main(verbosity=2)
