# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The examples in the docstrings, the types, and what is in the installed package."""

import doctest
import importlib.metadata
import importlib.util
import pathlib
import pkgutil
import struct
import subprocess
import sys
import tempfile
import textwrap
import unittest

import surfacediffusion as sd

FOLDER = pathlib.Path(sd.__file__).parent

GOOD = """
    import numpy as np
    from surfacediffusion import (
        Surface, conduction_velocity, denoise_mesh, gradient, heat, heat_steps, intrinsic_tv_steps,
        harmonic_map, turing_texture, sphere)

    surface = Surface(np.zeros((3, 3)), [[0, 1, 2]])
    array = heat(surface, np.zeros(3), fwhm=2.0, mode="TimeSteps", intrinsic_delaunay=True)
    mean: float = float(array.mean())
    weight: float = intrinsic_tv_steps(surface, [1, 2, 3]).last().effective_fidelity_weight
    times = [state.time for state in heat_steps((surface.points, surface.triangles), array)]
    moved = harmonic_map(sphere(), move_vertices=True).points
    texture = turing_texture(sphere(), kinetics="GrayScott", seed=1).texture
    points = denoise_mesh(sphere(), surface_type="CAD").points
    level: float = denoise_mesh((points, surface.faces)).noise_level
    slope = gradient(surface, np.zeros(3), smoothing_fwhm=2.0).max()
    speed = conduction_velocity(surface, np.zeros(3), roi=[1, 1, 0]).speed
"""

BAD = {
    'heat(sphere(), [1.0], fwhm="10")': "fwhm",
    'heat(sphere(), [1.0], mode="Steady")': "mode",
    "heat(sphere(), [1.0], intrinsic_delaunay=1.5)": "intrinsic_delaunay",
    "heat(sphere(), [1.0]).history": "history",
    "harmonic_map_steps(sphere()).points": "points",
    "heat(sphere(), [1.0], full_output=True)": "full_output",
    'gradient(sphere(), [1.0], quantity="Curl")': "quantity",
    'denoise_mesh(sphere(), surface_type="Metal")': "surface_type",
    "denoise_mesh(sphere()).noise": "noise",
    "surfacediffusion.vtkFVMHeatFilter()": "vtkFVMHeatFilter",
}


class Package(unittest.TestCase):
    def test_examples_in_docstrings_hold(self):
        names = ["_functions", "_fwhm", "_refinement", "_shape", "_surface", "_threads", "_result", "_derivatives"]
        examples = 0
        for name in names:
            results = doctest.testmod(importlib.import_module(f"surfacediffusion.{name}"))
            self.assertEqual(results.failed, 0)
            examples += results.attempted
        self.assertGreater(examples, 30)

    def test_every_public_name_is_documented(self):
        for name in sd.__all__:
            self.assertGreater(len(getattr(sd, name).__doc__ or ""), 40, name)

    def test_package_has_its_types_and_no_vtk(self):
        self.assertTrue((FOLDER / "py.typed").exists())
        self.assertTrue((FOLDER / "_functions.pyi").exists())
        self.assertEqual(sd.__version__, importlib.metadata.version("surfacediffusion"))
        self.assertFalse([path for path in FOLDER.rglob("*") if "vtkSurface" in path.name])
        code = "import sys, surfacediffusion; sys.exit(any('vtk' in name for name in sys.modules))"
        subprocess.run([sys.executable, "-c", code], check=True)

    def test_package_has_the_notices_of_what_is_compiled_into_it(self):
        texts = {file.name: file.read_text() for file in importlib.metadata.files("surfacediffusion")
                 if "licenses" in file.parts}
        self.assertEqual(set(texts), {"LICENSE", "NOTICE"})
        for text in ("Mozilla Public License, v. 2.0", "gitlab.com/libeigen", "Wenzel Jakob", "Thibaut Goetghebuer"):
            self.assertIn(text, texts["NOTICE"])

    @unittest.skipUnless(sys.platform == "linux", "guards of ELF files")
    def test_the_extension_has_guards_against_overwritten_memory(self):
        content = next(FOLDER.glob("_core*.so")).read_bytes()
        self.assertTrue(b"__stack_chk_fail" in content)
        # The dynamic section of an ELF file of 64 bits: pairs of a tag and a number
        table, size, count = (int.from_bytes(content[at:at + n], sys.byteorder)
                              for at, n in ((32, 8), (54, 2), (56, 2)))
        headers = [struct.unpack("=IIQQQQQQ", content[table + i * size:table + (i + 1) * size])
                   for i in range(count)]
        dynamic = next(content[at:at + length] for kind, _, at, _, _, length, _, _ in headers if kind == 2)
        flags = dict(struct.iter_unpack("=qQ", dynamic))
        self.assertTrue(flags.get(30, 0) & 8, "DT_FLAGS has no DF_BIND_NOW")
        self.assertTrue(any(header[0] == 0x6474E552 for header in headers), "no PT_GNU_RELRO")

    def test_classes_of_vtk_are_an_error_that_says_where_they_are(self):
        if importlib.util.find_spec("vtkSurfaceDiffusion"):
            self.skipTest("vtkSurfaceDiffusion is installed")
        with self.assertRaisesRegex(ImportError, "^vtkFVMHeatFilter is in the module vtkSurfaceDiff"
                                    "usion, which is not installed [^\n]*$"):
            from surfacediffusion import vtkFVMHeatFilter  # noqa: F401
        with self.assertRaisesRegex(ImportError, "cannot import name 'smooth'"):
            from surfacediffusion import smooth  # noqa: F401

    def test_numpy_is_the_only_requirement(self):
        required = importlib.metadata.requires("surfacediffusion")
        self.assertEqual([line for line in required if "extra" not in line], ["numpy>=1.21"])

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_types_hold_and_catch_mistakes(self):
        with tempfile.TemporaryDirectory() as name:
            def check(program):
                path = pathlib.Path(name) / "program.py"
                path.write_text(textwrap.dedent(program))
                return subprocess.run(
                    [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", str(path)],
                    capture_output=True, text=True, cwd=name)

            good = check(GOOD)
            self.assertEqual(good.returncode, 0, good.stdout + good.stderr)
            imports = ("import surfacediffusion; from surfacediffusion import (denoise_mesh, gradient, heat, "
                            "harmonic_map, harmonic_map_steps, sphere)\n")
            found = check(imports + "\n".join(BAD)).stdout
            for line, (statement, word) in enumerate(BAD.items(), 2):
                of_line = [text for text in found.splitlines() if f"program.py:{line}:" in text]
                self.assertTrue(of_line, f"{statement} is accepted: {found}")

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    @unittest.skipUnless(importlib.util.find_spec("vtkmodules"), "VTK is not installed")
    def test_types_of_the_plugin_hold(self):
        with tempfile.TemporaryDirectory() as name:
            found = subprocess.run([sys.executable, "-m", "mypy", "-p", "surfacediffusion.paraview"],
                                   capture_output=True, text=True, cwd=name)
        self.assertEqual(found.returncode, 0, found.stdout + found.stderr)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_stubs_agree_with_the_module(self):
        modules = [f"surfacediffusion.{module.name}" for module in pkgutil.iter_modules([str(FOLDER)])
                   if module.name.startswith("_") and module.name != "_core"]
        self.assertIn("surfacediffusion._functions", modules)
        for name in ("_functions", "_steps", "_derivatives"):
            found = subprocess.run(
                [sys.executable, "-m", "mypy.stubtest", "--concise", f"surfacediffusion.{name}"],
                capture_output=True, text=True, cwd=tempfile.gettempdir())
            self.assertEqual(found.returncode, 0, found.stdout + found.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=sys.argv)
