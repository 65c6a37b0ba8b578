# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The workflows of .github and what they call, as far as they can be read: they build what cannot be
built here. Argument: the folder of the sources. Without PyYAML the exit code is 77 (skipped)."""
import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

try:
    import yaml
except ImportError:
    print("PyYAML is not available (Debian: python3-yaml)")
    sys.exit(77)
if sys.version_info >= (3, 11):
    import tomllib
else:
    print("needs Python 3.11, which reads TOML")
    sys.exit(77)

SOURCE = Path(sys.argv.pop())
WORKFLOWS = {path.name: yaml.safe_load(path.read_text())
             for path in sorted((SOURCE / ".github/workflows").glob("*.yml"))}
PROJECT = tomllib.loads((SOURCE / "pyproject.toml").read_text())
#: The systems of GitHub's runners, by the first word of their names
SYSTEMS = {"ubuntu": "Operating System :: POSIX :: Linux", "macos": "Operating System :: MacOS",
           "windows": "Operating System :: Microsoft :: Windows"}


def steps_of(workflow):
    return [step for job in workflow["jobs"].values() for step in job["steps"]]


class Workflows(unittest.TestCase):
    def test_both_are_there(self):
        self.assertEqual(sorted(WORKFLOWS), ["paraview-plugin.yml", "wheels.yml"])

    def test_each_job_has_a_machine_and_named_steps_that_do_one_thing(self):
        for name, workflow in WORKFLOWS.items():
            with self.subTest(workflow=name):
                # "on" is a truth value in YAML 1.1
                self.assertEqual(set(workflow), {"name", True, "permissions", "jobs"})
                self.assertLessEqual(set(workflow[True]), {"workflow_dispatch", "push", "pull_request"})
                self.assertEqual(workflow["permissions"], {"contents": "read"})
                for job in workflow["jobs"].values():
                    self.assertLessEqual(set(job), {"name", "runs-on", "strategy", "steps"})
                    names = [step["name"] for step in job["steps"]]
                    self.assertEqual(len(set(names)), len(names))
                    self.assertEqual(names[0], "Check out")
                    for step in job["steps"]:
                        self.assertLessEqual(set(step), {"name", "uses", "with", "run"})
                        self.assertEqual(("uses" in step) + ("run" in step), 1, step)
                        if "uses" in step:
                            self.assertRegex(step["uses"], r"^actions/[a-z-]+@v\d+$")
                            self.assertNotEqual(step.get("with"), {})
                        else:
                            subprocess.run(["sh", "-n", "-c", re.sub(r"\$\{\{.*?\}\}", "x", step["run"])],
                                           check=True)

    def test_expressions_name_what_the_matrix_has(self):
        for name, workflow in WORKFLOWS.items():
            for job in workflow["jobs"].values():
                matrix = job.get("strategy", {}).get("matrix", {})
                rows = matrix.get("include", [{}])
                for row in rows:
                    known = {f"matrix.{key}" for key in {**matrix, **row} if key != "include"}
                    used = set(re.findall(r"\$\{\{ *(.*?) *\}\}", yaml.dump(job, width=10**6)))
                    self.assertEqual(used, known, name)

    def test_every_job_keeps_what_the_step_before_has_made(self):
        for name, workflow in WORKFLOWS.items():
            for job in workflow["jobs"].values():
                last = job["steps"][-1]
                self.assertIn("upload-artifact", last["uses"], name)
                self.assertEqual(last["with"]["if-no-files-found"], "error")
                self.assertTrue(last["with"]["path"].startswith("dist/"), name)
                self.assertIn("dist", job["steps"][-2]["run"], name)


class Plugin(unittest.TestCase):
    script = (SOURCE / ".ci/build-plugin").read_text()

    def test_the_workflow_calls_a_script_that_can_be_run(self):
        (run,) = [step["run"] for step in steps_of(WORKFLOWS["paraview-plugin.yml"])
                  if "docker run" in step.get("run", "")]
        words = run.split()
        at = words.index("/source/.ci/build-plugin")
        self.assertEqual(len(words), at + 3, "PREFIXES and FOLDER")
        self.assertIn("$PWD:/source", run)
        prefixes, folder = words[at + 1].strip('"').split(";"), words[at + 2]
        mounted = re.findall(r'-v "[^":]+:([^":]+)"', run)
        self.assertIn(prefixes[1], mounted)
        self.assertTrue(folder.startswith("/source/"))
        self.assertTrue(os.access(SOURCE / ".ci/build-plugin", os.X_OK))

    def test_its_options_exist(self):
        cmake = "".join(path.read_text() for path in (
            SOURCE / "CMakeLists.txt", *(SOURCE / "CMake").glob("*.cmake")))
        known = set(re.findall(r"(?:option\(|set\()\s*(SURFACEDIFFUSION_\w+)[\s\"]", cmake))
        options = re.findall(r"-D (\w+)=", self.script)
        ours = {option for option in options if option.startswith("SURFACEDIFFUSION_")}
        self.assertGreaterEqual(len(ours), 3)
        self.assertLessEqual(ours, known)
        self.assertIn("CMAKE_PREFIX_PATH", options)
        for name in re.findall(r"s/\^(SURFACEDIFFUSION_\w+):INTERNAL", self.script):
            self.assertRegex(cmake, rf"set\({name} .* CACHE INTERNAL")

    def test_the_versions_are_those_of_the_notes(self):
        """From the oldest that the sources ask for to the newest that Plugin/README.md describes."""
        rows = WORKFLOWS["paraview-plugin.yml"]["jobs"]["plugin"]["strategy"]["matrix"]["include"]
        versions = [str(row["paraview"]) for row in rows]
        oldest = re.search(r"find_package\(ParaView (\S+)", (SOURCE / "CMake/BuildForVTK.cmake").read_text())
        notes = (SOURCE / "Plugin/README.md").read_text()
        newest = re.search(r"from\s+ParaView \S+ to (\d+\.\d+)", notes)
        short = [".".join(version.split(".")[:2]) for version in versions]
        self.assertEqual((short[0], short[-1]), (oldest.group(1), newest.group(1)))
        self.assertEqual(len(set(short)), len(short))
        self.assertEqual(versions, sorted(versions, key=lambda text: tuple(map(int, text.split(".")))))


class Wheels(unittest.TestCase):
    settings = PROJECT["tool"]["cibuildwheel"]
    runners = WORKFLOWS["wheels.yml"]["jobs"]["wheels"]["strategy"]["matrix"]["runner"]

    def test_the_settings_are_known(self):
        self.assertLessEqual(set(self.settings), {
            "build", "skip", "test-command", "test-extras", "linux", "macos", "windows", "environment"})
        self.assertIn("surfacediffusion doctor", self.settings["test-command"])
        linux = self.settings["linux"]
        for processor in ("x86_64", "aarch64"):
            self.assertEqual(linux[f"manylinux-{processor}-image"], "manylinux_2_28")

    def test_wheels_are_built_from_the_oldest_python_that_the_package_takes(self):
        builds = [int(re.fullmatch(r"cp3(\d+)-\*", build).group(1)) for build in self.settings["build"]]
        self.assertEqual(builds, list(range(builds[0], builds[-1] + 1)))
        self.assertEqual(PROJECT["project"]["requires-python"], f">= 3.{builds[0]}")
        # One wheel for the stable interface of the newest versions, which must be among them
        (override,) = [each for each in PROJECT["tool"]["scikit-build"]["overrides"] if "wheel" in each]
        self.assertIn(int(override["wheel"]["py-api"][len("cp3"):]), builds)

    def test_systems_with_wheels_are_the_classifiers(self):
        systems = {SYSTEMS[runner.split("-")[0]] for runner in self.runners}
        given = {name for name in PROJECT["project"]["classifiers"] if name.startswith("Operating System")}
        self.assertEqual(given, systems)


if __name__ == "__main__":
    unittest.main(verbosity=2)
