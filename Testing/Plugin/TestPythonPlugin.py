# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The plugin in Python has the proxies, properties, results and messages of the plugin in C++. Runs in any
Python with numpy: python_plugin.py runs in pvpython, once with each plugin."""

import json
import os
import subprocess
import tempfile
import unittest

import numpy as np

FOLDER = os.path.dirname(os.path.abspath(__file__))
PLUGINS = {"C++": os.environ["SURFACEDIFFUSION_PLUGIN"], "Python": os.environ["SURFACEDIFFUSION_PYTHON_PLUGIN"]}


def pvpython(*arguments):
    """Standard output and errors of a script of this folder, without plugins that load by themselves."""
    environment = {key: value for key, value in os.environ.items() if key != "PV_PLUGIN_PATH"}
    done = subprocess.run(
        [os.environ["SURFACEDIFFUSION_PVPYTHON"], *arguments], env=environment, cwd=FOLDER,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, check=False)
    assert done.returncode == 0, done.stdout
    return done.stdout


class TestPythonPlugin(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.texts, cls.arrays = {}, {}
        with tempfile.TemporaryDirectory() as folder:
            for kind, plugin in PLUGINS.items():
                path = os.path.join(folder, "results.npz")
                pvpython(os.path.join(FOLDER, "python_plugin.py"), plugin, path)
                with np.load(path) as found:
                    cls.texts[kind] = json.loads(str(found["text"]))
                    cls.arrays[kind] = {
                        key[len("array "):]: found[key] for key in found.files if key != "text"}
        cls.seconds = {kind: texts.pop("seconds") for kind, texts in cls.texts.items()}

    def compare(self, *beginnings):
        """Compare what has a key with one of these beginnings."""
        for found, same in ((self.texts, lambda a, b: a == b), (self.arrays, self.is_same)):
            keys = {kind: {key for key in values if key.startswith(beginnings)}
                    for kind, values in found.items()}
            self.assertEqual(keys["C++"] ^ keys["Python"], set())
            different = {
                key: (found["C++"][key], found["Python"][key]) for key in sorted(keys["C++"])
                if not same(found["C++"][key], found["Python"][key])}
            shown = "\n".join("%s: %s\n    Python: %s" % (key, *pair) for key, pair in
                              list(different.items())[:20])
            self.assertEqual(len(different), 0, "%d of %d differ:\n%s" % (
                len(different), len(keys["C++"]), shown))
        self.assertTrue(any(key.startswith(beginnings) for key in self.texts["C++"]))

    @staticmethod
    def is_same(a, b):
        return a.dtype == b.dtype and a.shape == b.shape and np.array_equal(
            a, b, equal_nan=a.dtype.kind == "f")

    def test_properties_panels_and_functions_are_the_same(self):
        self.compare("properties/", "menu/", "groups/", "simple/")

    def test_random_clicks_give_the_same_bits_and_messages(self):
        self.compare("clicks/")

    def test_all_kinds_of_run_give_the_same_bits_and_messages(self):
        self.compare("kind ")

    def test_all_kinds_of_input_give_the_same_bits(self):
        self.compare("noisy/", "mixed/", "one thread/", "refined/", "limit/", "float32/", "int32/", "uint8/",
                     "vtk", "colors/", "single/", "samples/", "sources", "means/", "feature/")

    def test_special_input_gives_the_same_bits(self):
        self.compare("open/", "converted", "empty array/", "polygons")

    def test_what_is_left_out_gives_the_same_bits_and_messages(self):
        self.compare("left out/")

    def test_surfaces_in_pieces_give_the_same_bits_and_messages(self):
        self.compare("pieces ")

    def test_edits_in_place_give_the_same_bits_and_warnings(self):
        self.compare("edits/")

    def test_times_in_any_order_give_the_same_bits(self):
        self.compare("times/")

    def test_faults_have_the_same_sentences(self):
        self.compare("faults/")

    def test_an_abort_gives_the_input_and_the_next_update_the_result(self):
        self.compare("aborts/")
        for key, value in self.texts["Python"].items():
            if key.startswith("aborts/") and key.endswith("/seen"):
                self.assertTrue(value, key)
            if key.startswith("aborts/") and key.endswith("/input"):
                self.assertEqual(value, [], key)

    def test_with_both_plugins_filters_are_those_in_cxx_and_the_second_one_says_so(self):
        script = (
            "import inspect, sys\n"
            "if not hasattr(inspect, 'getargspec'):\n"
            "    inspect.getargspec = inspect.getfullargspec\n"
            "from paraview import simple\n"
            "for path in sys.argv[1:]:\n"
            "    simple.LoadPlugin(path, remote=False, ns=globals())\n"
            "print('CLASS', FVMHeatFilter(Input=Sphere()).SMProxy.GetVTKClassName())\n")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "both.py")
            with open(path, "w", encoding="utf-8") as file:
                file.write(script)
            for order, said in ((("C++", "Python"), "whose filters stay"),
                                (("Python", "C++"), "those made before stay")):
                text = pvpython(path, *(PLUGINS[kind] for kind in order))
                self.assertIn("CLASS vtkFVMHeatFilter", text)
                self.assertEqual(text.count(said), 1, text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
