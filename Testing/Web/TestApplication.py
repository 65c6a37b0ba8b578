# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Web driven in headless Chromium, as people would use it. Argument: the folder of the
application."""
import gzip
import os
import re
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import zipfile
from http.client import HTTPConnection
from pathlib import Path
from types import SimpleNamespace
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
from nibabel import freesurfer
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from surfacediffusion.files import read_surface
from surfacediffusion.files.export import export

FOLDER = Path(sys.argv.pop()).resolve()
sys.path.insert(0, str(FOLDER))
from filters import FILTERS  # noqa: E402
from meshes import size_of  # noqa: E402


def write_off(path, surface, centre=(0, 0, 0)):
    path.write_text("\n".join(
        [f"OFF\n{surface.n_points} {surface.n_faces} 0"]
        + [" ".join(map(repr, point)) for point in (surface.points + centre).tolist()]
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
        wait_for(lambda: self.open_menu(box), f"the menu {box}")
        item = wait_for(lambda: [e for e in self.browser.find_elements(
            By.CSS_SELECTOR, ".v-overlay--active .v-list-item") if e.text.strip() == title], title)
        self.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", item[0])
        wait_for(lambda: item[0].click() or True, f"a click on {title}")  # the list may scroll still
        wait_for(lambda: not self.browser.find_elements(
            By.CSS_SELECTOR, ".v-overlay--active .v-list-item"), "the closed list")

    def open_menu(self, box):
        field = self.one(f".v-select:has(#{box}) .v-field")
        self.browser.execute_script("arguments[0].scrollIntoView()", field)
        field.click()  # an error while something else still covers it
        return True

    def message(self):
        found = self.browser.find_elements(By.CSS_SELECTOR, "#message")
        return found[0].text if found else ""

    # ---- tests ----------------------------------------------------------------------------------

    def test_shows_a_surface_before_and_after_which_turns_in_both_views(self):
        self.open()
        picture = wait_for(lambda: self.halves_with_surface(), "two surfaces")
        canvas = self.one("canvas")
        drag(self.browser, canvas, 120, 40, at=(-200, 0))
        for before, after in zip(picture, self.halves()):
            self.assertGreater(difference(before, after), 0.02)
            self.assertGreater(surface_part(after), 0.1)

    def halves_with_surface(self):
        halves = self.halves()
        return halves if min(map(surface_part, halves)) > 0.1 else None

    def test_smooths_a_dropped_mesh_and_the_slider_changes_the_download(self):
        self.open()
        self.drop_ball()
        self.choose("array", "thickness.npy")
        widths, pictures = [], []
        for presses in (0, 25):
            thumb = wait_for(lambda: self.one("#slider-width .v-slider-thumb"), "the slider")
            runs = self.runs()
            if presses:
                for _ in range(presses):
                    thumb.send_keys(Keys.ARROW_RIGHT)
                wait_for(lambda: self.runs() > runs, "the next run")
            widths.append(self.width())
            smooth = sd.heat(self.surface, self.values, fwhm=widths[-1])
            # In the format of the file that was dropped, and with everything. There may be a run left.
            wait_for(lambda: np.allclose(np.load(self.download()), smooth, rtol=0, atol=1e-12),
                     "the result of this width")
            pictures.append(picture_of(self.browser))
            self.choose("format", "result.vtp")
            np.testing.assert_allclose(self.download_vtp(), smooth, atol=1e-12)
            self.choose("format", "thickness_result.npy")
        self.assertGreater(widths[1], 1.5 * widths[0])
        self.assertGreater(difference(*pictures), 0.005)
        self.assertIn("Energy", self.text("#history thead"))
        self.assertIn("energy", self.text("#curve svg"))

    def width(self):
        return float(self.text("#slider-width div").rsplit(": ", 1)[1].split()[0])

    def download(self):
        """The path of the file."""
        for old in self.folder.glob("*result*"):
            old.unlink()
        wait_for(lambda: self.one("#download").is_enabled(), "a result")
        self.one("#download").click()
        return wait_for(lambda: [path for path in self.folder.glob("*result*")
                                 if path.suffix != ".crdownload"], "the download", 60)[0]

    def download_vtp(self):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(self.download()))
        reader.Update()
        return vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("Result"))

    def test_frames_a_dropped_mesh_of_any_size_and_place(self):
        self.open()
        for number, (radius, centre) in enumerate(((50.0, 0), (0.002, 0), (300.0, 5000), (1.0, -7))):
            with self.subTest(radius=radius):
                name = f"ball{number}.off"
                write_off(self.folder / name, sd.sphere(3, radius=radius), (centre, 0, centre))
                runs = self.runs()
                self.drop(name)
                wait_for(lambda: name in self.text("#mesh") and self.runs() > runs, "its first run")
                # A ball fills a third of a view, and its width does not reach the sides.
                wait_for(lambda: all(0.2 < surface_part(half) < 0.5 and
                                     surface_part(half[200:400, :4]) == 0 for half in self.halves()),
                         "a ball in the middle of each view")
                self.clear_files()

    def halves(self):
        return np.split(picture_of(self.browser)[:, 400:1180], 2, axis=1)

    def clear_files(self):
        self.browser.execute_script(
            "arguments[0].click()", self.one(".v-file-input .v-field__clearable i"))

    def test_colour_bars_have_the_range_of_the_data_and_its_name(self):
        self.open()
        self.drop_ball()
        self.choose("array", "thickness.npy")
        low, high = (f"{limit:.4g}" for limit in (self.values.min(), self.values.max()))
        wait_for(lambda: [low, high] == [e.text for e in self.browser.find_elements(
            By.CSS_SELECTOR, ".bar span")][:2], "the range")
        self.assertIn("thickness.npy", self.text(".bar"))
        self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, ".bar")), 2)

    def test_brains_have_millimetres_and_come_back_in_their_format(self):
        name = str(self.folder / "lh.white")
        freesurfer.write_geometry(name, self.surface.points, self.surface.triangles)
        freesurfer.write_morph_data(str(self.folder / "lh.thickness"), self.values.astype(np.float32))
        self.open()
        self.drop("lh.white", "lh.thickness")
        wait_for(lambda: "lh.white: 2,562 points" in self.text("#mesh"), "the mesh")
        self.choose("array", "lh.thickness")
        wait_for(lambda: "lh.thickness, mm" in self.text(".bar"), "the unit")
        wait_for(lambda: all(surface_part(half) > 0.1 for half in self.halves()), "a framed brain")
        self.assertIn("mm", self.text("#slider-width div"))
        smooth = sd.heat(self.surface, self.values.astype(np.float32), fwhm=self.width())
        wait_for(lambda: np.allclose(freesurfer.read_morph_data(str(self.download())), smooth,
                                     rtol=0, atol=1e-4), "the smooth thickness")

    def test_choices_are_menus_and_switches(self):
        self.open()
        self.choose("filter", FILTERS["tensor_diffusion"].title)
        wait_for(lambda: "Beltrami" in self.text("#note"), "the first choice")
        self.choose("model", "along lines")
        wait_for(lambda: "CoherenceEnhancing" in self.text("#note"), "the second choice")
        runs = self.runs()
        self.choose("filter", FILTERS["harmonic_map"].title)
        wait_for(lambda: self.runs() > runs and "points moved" in self.text("#note"), "moved points")
        self.browser.execute_script("arguments[0].click()", self.one("#slider-move input"))
        wait_for(lambda: self.runs() > runs + 1 and self.text("#note") == "", "points that stay")

    def test_moved_points_are_downloaded_in_the_format_of_the_mesh(self):
        self.open()
        noisy = sd.sphere(4, radius=50.0)
        noisy = sd.Surface(noisy.points + np.random.default_rng(2).normal(
            scale=0.5, size=noisy.points.shape), noisy.triangles)
        write_off(self.folder / "noisy.off", noisy)
        runs = self.runs()
        self.drop("noisy.off")
        wait_for(lambda: "noisy.off" in self.text("#mesh") and self.runs() > runs, "the mesh")
        self.choose("filter", FILTERS["denoise_mesh"].title)
        wait_for(lambda: "surface, noise of" in self.text("#note"), "its run")
        path = self.download()
        self.assertEqual(path.name, "noisy_result.off")
        points = np.loadtxt(path.read_text().splitlines()[2:2 + noisy.n_points])
        error = np.abs(np.linalg.norm(points, axis=1) - 50)
        self.assertLess(error.mean(), 0.5 * np.abs(np.linalg.norm(noisy.points, axis=1) - 50).mean())

    def test_a_dropped_stl_becomes_a_part_with_relief_as_stl_and_3mf(self):
        self.open()
        corners = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) * 20.0
        squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        export(self.folder / "cube.stl", corners,
               [t for a, b, c, d in squares for t in ((a, b, c), (a, c, d))])
        runs = self.runs()
        self.drop("cube.stl")
        wait_for(lambda: "cube.stl" in self.text("#mesh") and self.runs() > runs, "the mesh")
        self.choose("filter", FILTERS["relief"].title)
        wait_for(lambda: "triangles, closed, smallest wall" in self.text("#note"), "its run")
        runs = self.runs()
        self.choose("pattern", "spots")
        wait_for(lambda: self.runs() > runs, "the spots")
        path = self.download()
        self.assertEqual(path.name, "result.stl")
        part = read_surface(path)
        height = float(self.text("#slider-height div").rsplit(": ", 1)[1].split()[0])
        self.assertAlmostEqual(part.points.max(), 20 + height, delta=1e-3)
        sides = np.sort(np.concatenate([part.faces[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
        self.assertTrue((np.unique(sides, axis=0, return_counts=True)[1] == 2).all())
        self.choose("format", "result.3mf")
        with zipfile.ZipFile(self.download()) as archive:
            model = archive.read("3D/3dmodel.model")
        self.assertEqual(model.count(b"<triangle "), len(part.faces))

    def test_a_surface_without_noise_is_said_to_have_none(self):
        outcome = FILTERS["denoise_mesh"].run(
            SimpleNamespace(surface=self.surface), None, {"noise": 0.0, "type": 0}, False)
        self.assertEqual(outcome.note, "no noise was found")

    def test_a_scan_with_correlated_noise_is_denoised_and_the_noise_described(self):
        self.open()
        clean = sd.sphere(5, radius=50.0)
        rough = sd.heat(clean, np.random.default_rng(5).normal(size=clean.n_points), fwhm=6.0)
        noisy = sd.Surface(np.round(clean.points * (1 + 0.01 * rough[:, None] / rough.std()), 4),
                           clean.triangles)
        write_off(self.folder / "scan.off", noisy)
        runs = self.runs()
        self.drop("scan.off")
        wait_for(lambda: "scan.off" in self.text("#mesh") and self.runs() > runs, "the mesh")
        self.choose("filter", FILTERS["denoise_mesh"].title)
        note = wait_for(lambda: "surface, noise of" in self.text("#note") and self.text("#note"), "its run")
        found = sd.denoise_mesh(noisy)
        self.assertGreater(found.correlation_length, 0)
        self.assertIn(f"noise of {found.noise_level:.3g}, correlated over {found.correlation_length:.3g}",
                      note)
        self.assertIn("details of that size are removed with it", note)
        path = self.download()
        points = np.loadtxt(path.read_text().splitlines()[2:2 + noisy.n_points])
        error = np.linalg.norm(points, axis=1) - 50
        self.assertLess(error.std(), 0.6 * 0.5)  # 0.5: 1 % of the radius

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
        (self.folder / "part.stl").write_text(
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
            "endloop\nendfacet\nendsolid a\n")
        (self.folder / "large.stl").write_bytes(b"x" * (2 << 20))
        (self.folder / "zeros.gii.gz").write_bytes(gzip.compress(b"\0" * (200 << 20)))
        self.open()
        for names, words in ((("broken.off",), "a face refers to point 7; allowed: 0 to 2"),
                             (("words.obj",), "words.obj"), (("empty.ply",), "empty.ply"),
                             (("ball.off", "short.npy"), "5 values; allowed: 2562"),
                             (("part.stl", "short.npy"), "an STL file numbers no vertices"),
                             (("large.stl",), "the files have more than 1 MB, decompressed; allowed: 1 MB"),
                             (("zeros.gii.gz",), "the files have more than 1 MB, decompressed")):
            with self.subTest(names[-1]):
                self.drop(*names)
                wait_for(lambda: words in self.message(), words)
                self.assertNotIn("/tmp", self.message())
                self.assertIn("example", self.text("#mesh"))
                self.clear_files()
        self.drop_ball()
        self.assertEqual(self.message(), "")

    def test_a_compressed_file_is_undone_no_further_than_is_allowed(self):
        zeros = gzip.compress(b"\0" * (200 << 20))
        self.assertLess(size_of(zeros, 1 << 20), 4 << 20)
        self.assertEqual(size_of(gzip.compress(b"\0" * 5000), 1 << 20), 5000)

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

    def ask(self, path="/", **headers):
        """The status of an answer; no redirection is followed."""
        connection = HTTPConnection("127.0.0.1", int(self.address.rstrip("/").rsplit(":", 1)[1]))
        try:
            connection.request("GET", path, headers={
                name.replace("_", "-"): value for name, value in headers.items()})
            answer = connection.getresponse()
            answer.read()
            return answer.status, answer.getheader("Location")
        finally:
            connection.close()

    def wait_for_room(self):
        """A new session; those of other tests end after a second."""
        return wait_for(lambda: [location for status, location in [self.ask()] if status == 302],
                        "room for a session")[0]

    def test_other_sites_get_no_session(self):
        self.assertEqual(self.ask(Host="evil.example")[0], 403)
        self.assertEqual(self.ask(Host="evil.example:8080")[0], 403)
        for site in ("cross-site", "same-site"):  # a picture or a link of another page
            self.assertEqual(self.ask(Sec_Fetch_Site=site)[0], 403)
        location = self.wait_for_room()
        self.assertEqual(self.ask(location, Host="evil.example")[0], 403)
        for host in ("localhost", "localhost:8080", "127.0.0.1:9000", "[::1]:8080", "192.168.1.2"):
            self.assertEqual(self.ask(location, Host=host)[0], 200, host)

    def test_a_request_without_an_upgrade_does_not_keep_the_session(self):
        location = self.wait_for_room()
        self.assertEqual(self.ask(location.partition("/index")[0] + "/ws")[0], 426)
        wait_for(lambda: self.ask(location)[0] == 404, "the end of the session", 20)

    def test_a_large_message_ends_the_connection_before_it_is_stored(self):
        location = self.wait_for_room()
        port = int(self.address.rstrip("/").rsplit(":", 1)[1])
        with socket.create_connection(("127.0.0.1", port), timeout=20) as connection:
            connection.sendall((f"GET {location.partition('/index')[0]}/ws HTTP/1.1\r\nHost: localhost\r\n"
                                "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n").encode())
            self.assertIn(b"101", connection.recv(4096))
            before = memory_of(self.app.pid)
            # A masked binary frame of 300 MB
            connection.sendall(b"\x82\xff" + (300 << 20).to_bytes(8, "big") + b"\0\0\0\0")
            with self.assertRaises(OSError):
                for _ in range(300):
                    connection.sendall(b"\0" * (1 << 20))
                    time.sleep(0.001)
        self.assertLess(memory_of(self.app.pid) - before, 60)

    def test_listens_to_this_machine_only(self):
        port = int(self.address.rstrip("/").rsplit(":", 1)[1])
        with socket.create_connection(("127.0.0.1", port), timeout=5):
            pass
        with self.assertRaises(OSError):  # a loopback address too, but another
            socket.create_connection(("127.0.0.2", port), timeout=5)


def memory_of(process):
    """MB that a process has in memory."""
    text = Path(f"/proc/{process}/status").read_text()
    return int(re.search(r"VmRSS:\s*(\d+)", text).group(1)) / 1024


def surface_part(picture):
    """The part of the pixels that are neither white nor letters: a lit, coloured surface."""
    return float(((picture.max(axis=2) - picture.min(axis=2) > 20)
                  | ((picture.min(axis=2) > 60) & (picture.max(axis=2) < 235))).mean())


if __name__ == "__main__":
    unittest.main(verbosity=2)
