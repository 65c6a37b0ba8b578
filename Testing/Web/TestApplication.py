# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Web driven in headless Chromium, as people would use it. Argument: the folder of the
application."""
import os
import re
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from urllib.request import urlopen

from browser import difference, drag, open_browser, picture_of, wait_for

try:
    import surfacediffusion as sd
    import trame.app  # noqa: F401
    import trame_vtk  # noqa: F401
    import trame_vuetify  # noqa: F401
except ImportError as problem:
    print(f"skipped: {problem} (.ci/fetch-test-data brings it)")
    sys.exit(77)

import numpy as np
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

FOLDER = Path(sys.argv.pop()).resolve()
sys.path.insert(0, str(FOLDER))
from filters import FILTERS  # noqa: E402


def write_off(path, surface):
    path.write_text("\n".join(
        [f"OFF\n{surface.n_points} {surface.n_faces} 0"]
        + [" ".join(map(repr, point)) for point in surface.points.tolist()]
        + [f"3 {a} {b} {c}" for a, b, c in surface.triangles.tolist()]) + "\n")


class TestApplication(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        environment = {**os.environ, "SURFACEDIFFUSION_WEB_MEGABYTES": "1"}
        cls.app = subprocess.Popen(
            [sys.executable, str(FOLDER / "app.py"), "--port", "0", "--no-browser", "--sessions", "2",
             "--life", "1"], stdout=subprocess.PIPE, text=True, env=environment)
        cls.address = re.search(r"http://\S+", cls.app.stdout.readline()).group()
        cls.browser = open_browser(cls.folder)
        cls.surface = sd.sphere(4, radius=50.0)
        cls.values = np.sign(cls.surface.points[:, 0]) + np.random.default_rng(1).normal(
            scale=0.3, size=cls.surface.n_points)
        write_off(cls.folder / "ball.off", cls.surface)
        np.save(cls.folder / "thickness.npy", cls.values)

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        cls.app.terminate()
        cls.app.wait()
        cls.app.stdout.close()
        cls.temporary.cleanup()

    # ---- the page -------------------------------------------------------------------------------

    def one(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def text(self, selector):
        return self.one(selector).get_attribute("textContent").strip()

    def runs(self):
        return int(self.text("#done"))

    def open(self):
        wait_for(self.load, "room for a session")
        wait_for(lambda: self.runs() >= 1, "the first run")

    def load(self):
        self.browser.get(self.address)
        return "please try again" not in self.browser.page_source

    def drop(self, *names):
        before = self.text("#mesh")
        self.one("input[type=file]").send_keys("\n".join(str(self.folder / n) for n in names))
        return before

    def drop_ball(self):
        runs = self.runs()
        self.drop("ball.off", "thickness.npy")
        wait_for(lambda: "ball.off: 2,562 points" in self.text("#mesh"), "the mesh")
        wait_for(lambda: self.runs() > runs, "its first run")

    def choose(self, box, title):
        self.one(f".v-select:has(#{box}) .v-field").click()
        item = wait_for(lambda: [e for e in self.browser.find_elements(
            By.CSS_SELECTOR, ".v-overlay--active .v-list-item") if e.text.strip() == title], title)
        item[0].click()
        wait_for(lambda: not self.browser.find_elements(
            By.CSS_SELECTOR, ".v-overlay--active .v-list-item"), "the closed list")

    def message(self):
        found = self.browser.find_elements(By.CSS_SELECTOR, "#message")
        return found[0].text if found else ""

    # ---- tests ----------------------------------------------------------------------------------

    def test_shows_a_surface_before_and_after_which_turns_in_both_views(self):
        self.open()
        picture = wait_for(lambda: self.halves_with_surface(), "two surfaces")
        canvas = self.one("canvas")
        drag(self.browser, canvas, 120, 40, at=(-200, 0))
        left, right = np.split(picture_of(self.browser)[:, 400:1180], 2, axis=1)
        for before, after in zip(picture, (left, right)):
            self.assertGreater(difference(before, after), 0.02)
            self.assertGreater(surface_part(after), 0.1)

    def halves_with_surface(self):
        halves = np.split(picture_of(self.browser)[:, 400:1180], 2, axis=1)
        return halves if min(map(surface_part, halves)) > 0.1 else None

    def test_smooths_a_dropped_mesh_and_the_slider_changes_the_download(self):
        self.open()
        self.drop_ball()
        self.choose("array", "thickness.npy")
        widths = []
        for presses in (0, 25):
            thumb = wait_for(lambda: self.one("#slider-width .v-slider-thumb"), "the slider")
            runs = self.runs()
            if presses:
                for _ in range(presses):
                    thumb.send_keys(Keys.ARROW_RIGHT)
                wait_for(lambda: self.runs() > runs, "the next run")
                picture = picture_of(self.browser)
            else:
                wait_for(lambda: self.one("#download").is_enabled(), "the first result")
                first = picture_of(self.browser)
            wait_for(lambda: self.one("#download").is_enabled(), "the end of the runs")
            widths.append(float(self.text("#slider-width div").rsplit(": ", 1)[1]))
            result = self.download()
            smooth = sd.heat(self.surface, self.values, fwhm=widths[-1])
            np.testing.assert_allclose(result, smooth, atol=1e-12)
        self.assertGreater(widths[1], 1.5 * widths[0])
        self.assertGreater(difference(first, picture), 0.005)
        self.assertIn("Energy", self.text("#history thead"))
        self.assertIn("energy", self.text("#curve svg"))

    def download(self):
        for old in self.folder.glob("result*"):
            old.unlink()
        self.one("#download").click()
        wait_for(lambda: (self.folder / "result.vtp").is_file(), "the download")
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(self.folder / "result.vtp"))
        reader.Update()
        return vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("Result"))

    def test_every_filter_runs_and_shows_no_message(self):
        self.open()
        for entry in FILTERS.values():
            with self.subTest(entry.name):
                if entry.name != "heat":  # which runs at first
                    runs = self.runs()
                    self.choose("filter", entry.title)
                    wait_for(lambda: self.runs() > runs, entry.title)
                self.assertEqual(self.message(), "")
                self.assertTrue(wait_for(self.halves_with_surface, "two surfaces"))
                folder = os.environ.get("SURFACEDIFFUSION_PICTURES")
                if folder:
                    self.browser.save_screenshot(f"{folder}/application_{entry.name}.png")

    def test_bad_files_give_a_message_and_leave_the_page_usable(self):
        (self.folder / "broken.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
        (self.folder / "words.obj").write_bytes(b"\x00\xff no mesh <script>alert(1)</script>")
        (self.folder / "empty.ply").write_bytes(b"")
        np.save(self.folder / "short.npy", np.zeros(5))
        (self.folder / "large.stl").write_bytes(b"x" * (2 << 20))
        self.open()
        for names, words in ((("broken.off",), "a face refers to point 7; allowed: 0 to 2"),
                             (("words.obj",), "words.obj"), (("empty.ply",), "empty.ply"),
                             (("ball.off", "short.npy"), "5 values; allowed: 2562"),
                             (("large.stl",), "the files have 2 MB; allowed: 1 MB")):
            with self.subTest(names[-1]):
                self.drop(*names)
                wait_for(lambda: words in self.message(), words)
                self.assertNotIn("/tmp", self.message())
                self.assertIn("example", self.text("#mesh"))
                self.browser.execute_script(
                    "arguments[0].click()", self.one(".v-file-input .v-field__clearable i"))
        self.drop_ball()
        self.assertEqual(self.message(), "")

    def test_two_people_do_not_see_each_other(self):
        self.open()
        self.drop_ball()
        first = self.browser.current_url
        self.browser.switch_to.new_window("tab")
        try:
            self.open()
            self.assertIn("example", self.text("#mesh"))
            self.assertNotEqual(self.browser.current_url, first)
            with self.assertRaisesRegex(Exception, "503"):  # --sessions 2
                urlopen(self.address)
            with self.assertRaisesRegex(Exception, "404"):
                urlopen(self.address + "not-a-session/index.html")
        finally:
            self.browser.close()
            self.browser.switch_to.window(self.browser.window_handles[0])
        self.assertIn("ball.off", self.text("#mesh"))
        wait_for(lambda: urlopen(self.address).status == 200, "the end of the closed session")

    def test_listens_to_this_machine_only(self):
        port = int(self.address.rstrip("/").rsplit(":", 1)[1])
        with socket.create_connection(("127.0.0.1", port), timeout=5):
            pass
        with self.assertRaises(OSError):  # a loopback address too, but another
            socket.create_connection(("127.0.0.2", port), timeout=5)


def surface_part(picture):
    """The part of the pixels that are neither white nor letters: a lit, coloured surface."""
    return float(((picture.max(axis=2) - picture.min(axis=2) > 20)
                  | ((picture.min(axis=2) > 60) & (picture.max(axis=2) < 235))).mean())


if __name__ == "__main__":
    unittest.main(verbosity=2)
