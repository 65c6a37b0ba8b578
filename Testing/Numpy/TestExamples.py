# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Example files are found in packages and their wheels, and are those that the examples are written for."""

import hashlib
import os
import tempfile
import unittest
import zipfile
from pathlib import Path
from unittest import mock

from surfacediffusion import examples
from surfacediffusion.examples import FILES, fetch

NAME = "thick_left.gii.gz"
PACKAGE, MEMBER, _ = FILES[NAME]


class Fetch(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        # Neither the package of this environment nor what another test has unpacked
        for patch in (mock.patch.object(examples.importlib.util, "find_spec", return_value=None),
                      mock.patch.object(examples, "_unpacked", {}),
                      mock.patch.dict(os.environ, {"SURFACEDIFFUSION_BRAIN_DIR": folder.name})):
            patch.start()
            self.addCleanup(patch.stop)

    def put(self, content):
        with zipfile.ZipFile(self.folder / f"{PACKAGE}-1.0-py3-none-any.whl", "w") as wheel:
            wheel.writestr(f"{PACKAGE}/{MEMBER}", content)

    def test_a_file_is_found_in_a_wheel_and_in_an_installed_package(self):
        self.put(b"thickness")
        right = {NAME: (PACKAGE, MEMBER, hashlib.sha256(b"thickness").hexdigest())}
        with mock.patch.object(examples, "FILES", right):
            self.assertEqual(fetch(NAME).read_bytes(), b"thickness")
            self.assertEqual(fetch(NAME), fetch(NAME))
            installed = self.folder / "site" / PACKAGE / MEMBER
            installed.parent.mkdir(parents=True)
            installed.write_bytes(b"thickness")
            examples.importlib.util.find_spec.return_value = mock.Mock(
                submodule_search_locations=[str(self.folder / "site" / PACKAGE)])
            self.assertEqual(fetch(NAME), installed)

    def test_another_file_is_an_error(self):
        self.put(b"another one")
        with self.assertRaisesRegex(OSError, "thick_left.gii.gz is not the file that the examples"):
            fetch(NAME)

    def test_without_the_package_the_error_names_it(self):
        with self.assertRaisesRegex(FileNotFoundError, "not installed; pip install nilearn"):
            fetch(NAME)

    def test_other_names_are_an_error(self):
        with self.assertRaisesRegex(ValueError, "name is 'lh.white'; allowed: white_left.gii.gz, thick"):
            fetch("lh.white")


if __name__ == "__main__":
    unittest.main()
