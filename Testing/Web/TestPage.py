# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The page of Web in headless Chromium, as people and scripts use it. Argument: the folder of the page,
as its preset has built it."""
import functools
import json
import sys
import tempfile
import threading
import time
import unittest
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

from browser import difference, drag, open_browser, picture_in, picture_of, wait_for

try:
    import surfacediffusion as sd
except ImportError as problem:
    print(f"skipped: {problem} (Numpy.Wheel installs it)")
    sys.exit(77)

import numpy as np
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

FOLDER = Path(sys.argv.pop()).resolve()
if not (FOLDER / "wasm.js").exists():
    print(f"skipped: {FOLDER} has no page (cmake --preset page && cmake --build --preset page)")
    sys.exit(77)

CALL = """const [name, list, done] = arguments;
surfaceDiffusion[name](...list).then((value) => done({value: name === "open" ? value : {...value,
  arrays: Object.fromEntries(Object.entries(value.arrays).map(([key, array]) => [key, [...array]])),
  points: value.points && [...value.points]}}), (problem) => done({error: problem.message}));"""


class Handler(SimpleHTTPRequestHandler):
    asked = []  # of all pages

    def log_message(self, *_):
        self.asked.append(self.path)


def write_ply(path, surface, **arrays):
    """A binary PLY file with arrays in double precision."""
    names = ["x", "y", "z", *arrays]
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {surface.n_points}",
            *(f"property double {name}" for name in names), f"element face {surface.n_faces}",
            "property list uchar int vertex_indices", "end_header", ""]
    faces = np.zeros(surface.n_faces, [("n", "u1"), ("ids", "<i4", 3)])
    faces["n"], faces["ids"] = 3, surface.triangles
    rows = np.column_stack([surface.points, *arrays.values()]).astype("<f8")
    path.write_bytes("\n".join(head).encode() + rows.tobytes() + faces.tobytes())


def pebble(level=3):
    """A surface without symmetry, and noisy data."""
    ball = sd.sphere(level, radius=10.0)
    points = ball.points * (1 + 0.02 * ball.points[:, :1]) * [1.0, 1.2, 0.8]
    noise = np.random.default_rng(1).normal(scale=0.1, size=ball.n_points)
    return sd.Surface(points, ball.triangles), np.sign(points[:, 2]) + noise


class TestPage(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = Path(cls.temporary.name)
        cls.server = ThreadingHTTPServer(
            ("127.0.0.1", 0), functools.partial(Handler, directory=str(FOLDER)))
        threading.Thread(target=cls.server.serve_forever, daemon=True).start()
        cls.addClassCleanup(cls.server.server_close)
        cls.addClassCleanup(cls.server.shutdown)
        cls.browser = open_browser(cls.folder, performance=True)
        cls.addClassCleanup(cls.browser.quit)
        cls.browser.set_script_timeout(120)
        cls.surface, cls.values = pebble()
        write_ply(cls.folder / "pebble.ply", cls.surface, thickness=cls.values)
        cls.browser.get(f"http://127.0.0.1:{cls.server.server_port}/index.html")
        cls.browser.execute_async_script("surfaceDiffusion.ready.then(arguments[0])")
        cls.loaded = len(Handler.asked)
        cls.browser.get_log("performance")

    def setUp(self):
        self.choose("model", "heat")
        self.drop("pebble.ply")

    # ---- the page -------------------------------------------------------------------------------

    def one(self, name):
        return self.browser.find_element(By.ID, name)

    def message(self):
        return self.one("message").get_attribute("textContent")

    def choose(self, box, value):
        Select(self.one(box)).select_by_value(value)

    def drop(self, name, expected=None):
        self.one("file").send_keys(str(self.folder / name))
        wait_for(lambda: self.message().startswith(expected or f"{name}: "), name)

    def apply(self):
        self.one("apply").click()
        wait_for(lambda: "Done in" in self.message(), "the run")

    def call(self, name, *arguments):
        answer = self.browser.execute_async_script(CALL, name, arguments)
        if "error" in answer:
            raise ValueError(answer["error"])
        return answer["value"]

    def set_field(self, name, text):
        field = self.one(name)
        field.clear()
        field.send_keys(text)

    def halves(self):
        frame = self.one("frame").rect
        left, top = int(frame["x"]), int(frame["y"]) + 60  # below the colour bars
        picture = picture_of(self.browser)[top:top + int(frame["height"]) - 60, left:]
        return np.split(picture[:, :picture.shape[1] // 2 * 2], 2, axis=1)

    # ---- numbers --------------------------------------------------------------------------------

    def compare(self, model, options, expected, within=1e-9):
        """expected: numpy's arrays by the names of the page's."""
        found = self.call("run", model, options)
        for name, numbers in expected.items():
            with self.subTest(f"{model}: {name}"):
                numbers = np.ravel(numbers)
                array = np.array(found["points"] if name == "points" else found["arrays"][name], float)
                np.testing.assert_allclose(array, numbers, rtol=0, atol=within * np.abs(numbers).max())
        return found

    def test_scripts_get_the_numbers_of_numpy(self):
        """Of three models; TestEngine.py has all of them."""
        surface, values = self.surface, self.values
        self.compare("heat", {"array": "thickness", "fwhm": 3.0}, {
            "thicknessDiffused": sd.heat(surface, values, fwhm=3.0)})
        sparse = [5, 100, 300, 600]
        self.compare("interpolate", {"values": {"points": sparse, "values": [1.0, 2.0, 0.0, 4.0]}, "exact": True}, {
            "Interpolated": sd.interpolate(surface, [1.0, 2.0, 0.0, 4.0], surface.points[sparse],
                                           exact=True).values}, 1e-8)
        self.compare("denoise_mesh", {"noise_level": 0.1}, {
            "points": sd.denoise_mesh(surface, noise_level=0.1).points}, 1e-6)

    def test_apply_at_first_sight_works_for_every_model_and_says_the_width(self):
        for model in [option.get_attribute("value") for option in Select(self.one("model")).options]:
            with self.subTest(model):
                self.choose("model", model)
                self.apply()
                self.assertTrue(self.one("download").is_enabled())
                if model == "heat":
                    self.assertIn("four mean edge lengths", self.message())
                if model == "interpolate":  # values at points, in place of the array
                    self.assertEqual(Select(self.one("shown")).first_selected_option.text, "Interpolated")

    def test_a_smooth_mesh_comes_back_in_its_format_with_the_numbers_of_the_form(self):
        self.set_field("set-fwhm", "2.5")
        self.apply()
        self.one("download").click()
        path = self.folder / "pebble_result.ply"
        wait_for(path.exists, "the download", 30)
        self.drop(path.name)
        self.assertIn("thicknessDiffused", [option.text for option in Select(self.one("array")).options])
        again = self.call("run", "derivatives", {"array": "thicknessDiffused"})["arrays"]
        smooth = sd.heat(self.surface, self.values, fwhm=2.5)
        expected = np.ravel(sd.derivatives(self.surface, smooth))
        np.testing.assert_allclose(next(iter(again.values())), expected, atol=1e-4 * np.abs(expected).max())

    def test_values_opened_after_a_surface_are_its_arrays(self):
        self.drop("pebble.ply")
        np.savetxt(self.folder / "age.csv", self.values, header="age", comments="")
        self.drop("age.csv")
        self.assertEqual(Select(self.one("array")).first_selected_option.get_attribute("value"), "age")
        self.compare("heat", {"array": "age", "fwhm": 3.0}, {
            "ageDiffused": sd.heat(self.surface, np.loadtxt(self.folder / "age.csv", skiprows=1), fwhm=3.0)})

    def test_files_may_be_dropped_in_any_order(self):
        np.savetxt(self.folder / "a.csv", self.values, header="first", comments="")
        self.one("file").send_keys(f"{self.folder / 'a.csv'}\n{self.folder / 'pebble.ply'}")
        wait_for(lambda: "first" in [option.text for option in Select(self.one("array")).options], "both files")

    def test_scripts_open_files(self):
        found = self.call("open", "square.off", list(b"OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"))
        self.assertEqual([found["points"], found["triangles"], found["polygons"], found["arrays"]],
                         [4, 2, [{"corners": 4, "count": 1}], []])

    # ---- long runs, wrong files -----------------------------------------------------------------

    def test_cancel_ends_a_run_at_once_and_keeps_the_former_result(self):
        self.apply()
        shown = Select(self.one("shown")).first_selected_option.text
        self.choose("model", "turing_texture")
        self.browser.execute_script("document.getElementById('more').open = true")
        self.set_field("set-number_of_time_steps", "1000000")
        self.set_field("set-stop_tolerance", "0")
        self.one("apply").click()
        wait_for(lambda: self.one("cancel").is_enabled(), "the run")
        time.sleep(0.5)
        start = time.monotonic()
        self.one("cancel").click()
        wait_for(lambda: "cancelled" in self.message(), "its end")
        self.assertLess(time.monotonic() - start, 20)  # of a busy machine; an idle one takes below 1
        self.assertEqual(Select(self.one("shown")).first_selected_option.text, shown)
        self.assertTrue(self.one("download").is_enabled())
        self.choose("model", "heat")
        self.apply()  # the engine has the surface again

    def test_wrong_files_and_settings_are_one_line_and_the_page_lives_on(self):
        files = {"empty.ply": b"", "huge.off": b"OFF\n1000000000000 1000000000000 0\n0 0 0\n"}
        for name, content in files.items():
            with self.subTest(name):
                (self.folder / name).write_bytes(content)
                self.drop(name)
                self.assertEqual(self.one("message").get_attribute("className"), "error")
                self.assertNotIn("\n", self.message().strip())
        self.set_field("set-fwhm", "-1")
        self.one("apply").click()
        wait_for(lambda: "-1; allowed" in self.message(), "the sentence")
        self.set_field("set-fwhm", "wide")
        self.one("apply").click()
        wait_for(lambda: "allowed: a number" in self.message(), "the sentence")
        with self.assertRaisesRegex(ValueError, "allowed"):
            self.call("run", "heat", {"array": "thickness", "fwhm": -1.0})
        self.set_field("set-fwhm", "2")
        self.apply()

    def test_runs_without_room_are_refused_before_they_start(self):
        start = time.monotonic()
        with self.assertRaisesRegex(ValueError, "about .* GB of memory; allowed: 2 GB"):
            self.call("run", "turing_texture", {"refine_to": 1e-4, "maximum_number_of_triangles": 10**8})
        self.assertLess(time.monotonic() - start, 20)
        self.assertEqual(self.one("message").get_attribute("className"), "error")
        self.apply()

    def test_names_in_files_are_no_code(self):
        name = "<img src=x onerror=document.title=1>"
        surface, values = self.surface, self.values
        text = "\n".join([f"{name}", *map(repr, values.tolist())])
        (self.folder / "evil.csv").write_text(text + "\n")
        self.drop("evil.csv")
        self.apply()
        self.assertEqual(self.browser.title, "SurfaceDiffusion")
        self.assertEqual(surface.n_points, len(values))
        self.assertFalse(self.browser.find_elements(By.CSS_SELECTOR, "img"))

    # ---- policy ---------------------------------------------------------------------------------

    def test_no_request_leaves_the_page_and_none_can(self):
        self.apply()
        self.assertEqual(Handler.asked[self.loaded:], [])
        events = [json.loads(entry["message"])["message"] for entry in self.browser.get_log("performance")]
        asked = [event["params"]["request"]["url"] for event in events
                 if event["method"] == "Network.requestWillBeSent"]
        self.assertEqual([url for url in asked if not url.startswith(("blob:", "data:"))], [])
        refused = self.browser.execute_async_script(
            "fetch('index.html').then(() => arguments[0](false), () => arguments[0](true))")
        self.assertTrue(refused)
        self.browser.get_log("browser")  # which says so

    # ---- view -----------------------------------------------------------------------------------

    def test_the_view_compares_turns_and_reads_values(self):
        self.apply()
        before = wait_for(lambda: [half for half in self.halves()] if min(map(coloured, self.halves())) > 0.1
                          else None, "two surfaces")
        self.assertGreater(difference(*before), 0.01)
        canvas = self.one("view")
        drag(self.browser, canvas, 120, 40, at=(-150, 0))
        for old, new in zip(before, self.halves()):
            self.assertGreater(difference(old, new), 0.02)
        turned = self.halves()
        canvas.send_keys(Keys.ARROW_LEFT * 4)
        wait_for(lambda: difference(turned[0], self.halves()[0]) > 0.02, "keys that turn")
        canvas.send_keys(Keys.ENTER)
        wait_for(lambda: "thicknessDiffused:" in self.one("readout").text, "the value")
        labels = [self.browser.find_element(By.CSS_SELECTOR, f"#pane-{i} canvas").get_attribute("aria-label")
                  for i in range(2)]
        self.assertIn("thickness from", labels[0])
        self.choose("model", "distance")
        canvas.send_keys(Keys.ENTER)
        wait_for(lambda: "Point " in self.one("pick-list").text, "a source")
        self.apply()
        self.assertTrue(self.one("lines").is_selected())  # distances have isolines
        self.assertFalse(self.one("download-paths").is_displayed())

    def test_a_shortest_path_is_drawn_measured_and_saved(self):
        self.choose("model", "distance")
        self.choose("units", "mm")
        canvas = self.one("view")

        def click(x, y, found):
            ActionChains(self.browser, duration=0).move_to_element_with_offset(canvas, x, y).click().perform()
            entries = wait_for(lambda: self.browser.find_elements(By.CSS_SELECTOR, "#pick-list li")[found:], "a point")
            return int(entries[0].text.split()[1].rstrip(":"))

        source = click(-60, 20, 0)
        self.choose("pick-role", "path_points")
        start = click(90, -30, 1)
        self.assertIn("start of a path", self.one("pick-list").text)
        self.apply()
        length = sd.geodesic_path(self.surface, start, source).length
        numbers = self.one("numbers").text.split("\n")
        self.assertEqual(numbers[0], f"Path from point {start}")
        self.assertRegex(numbers[1], r"^[\d.]+ mm$")
        self.assertAlmostEqual(float(numbers[1].split()[0]), length, delta=0.01 * length)
        self.choose("shown", "")

        def pink():
            return [int((half.astype(int) @ [1, -1, 0] > 120).sum()) for half in self.halves()]

        drawn = wait_for(lambda: pink() if min(pink()) > 300 else None, "the line on both sides")
        self.browser.execute_script("page.comparison.view.setPaths([])")
        wait_for(lambda: max(pink()) < 0.5 * min(drawn), "views without the line")
        self.one("download-paths").click()
        path = self.folder / "pebble_paths.vtp"
        wait_for(path.exists, "the download", 30)
        self.assertIn('NumberOfLines="1"', path.read_text())

    def test_steps_and_energy_are_seen_and_the_view_is_saved(self):
        self.choose("model", "intrinsic_tv")
        self.apply()
        words = self.browser.find_element(By.CSS_SELECTOR, "#curve svg").get_attribute("aria-label")
        self.assertRegex(words, "Energy from .* to .*, time 0 to ")
        self.one("time").send_keys(Keys.HOME + 3 * Keys.ARROW_RIGHT)
        wait_for(lambda: "Step 3 of 10" in self.message() and "Done in" in self.message(), "the third step")
        self.one("picture").click()
        path = self.folder / "pebble.png"
        wait_for(path.exists, "the picture", 30)
        halves = np.array_split(wait_for(lambda: picture_in(path.read_bytes()), "all of it"), 2, axis=1)
        self.assertGreater(min(map(coloured, halves)), 0.1)

    def test_100k_triangles_are_seen_and_smoothed_within_seconds(self):
        surface, values = pebble(6)
        write_ply(self.folder / "large.ply", surface, thickness=values)
        start = time.monotonic()
        self.drop("large.ply")
        seen = time.monotonic() - start
        self.apply()
        done = time.monotonic() - start - seen
        print(f"{surface.n_faces} triangles: seen after {seen:.1f} s, default Apply {done:.1f} s")
        self.assertLess(max(seen, done), 20)  # of a busy machine

    # ---- access ---------------------------------------------------------------------------------

    def test_all_controls_have_names_and_are_reached_by_keys(self):
        self.apply()
        nameless = self.browser.execute_script("""
            return [...document.querySelectorAll("button, input, select, canvas, summary, progress, output")]
              .filter((e) => !(e.ariaLabel || e.textContent.trim() && e.tagName === "BUTTON"
                || e.tagName === "SUMMARY" || e.labels && e.labels.length)).map((e) => e.outerHTML)""")
        self.assertEqual(nameless, [])
        self.browser.execute_script("document.activeElement.blur()")
        reached = set()
        for _ in range(40):
            ActionChains(self.browser, duration=0).send_keys(Keys.TAB).perform()
            reached.add(self.browser.switch_to.active_element.get_attribute("id"))
        self.assertLessEqual({"file", "units", "model", "array", "set-fwhm", "apply", "download", "view", "shown",
                              "lines", "low", "reset", "picture"}, reached)

    def test_it_fits_a_telephone_and_has_contrast_in_the_dark(self):
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.clearDeviceMetricsOverride", {})
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": 400, "height": 800, "deviceScaleFactor": 1, "mobile": False})
        self.apply()
        self.assertLessEqual(self.browser.execute_script("return document.documentElement.scrollWidth"), 400)
        for scheme in ("dark", "light"):
            self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
                "features": [{"name": "prefers-color-scheme", "value": scheme}]})
            for name in ("message", "model-help", "apply", "download"):
                style = self.browser.execute_script("""
                    let e = document.getElementById(arguments[0]), back = e;
                    while (getComputedStyle(back).backgroundColor === "rgba(0, 0, 0, 0)") back = back.parentElement;
                    return [getComputedStyle(e).color, getComputedStyle(back).backgroundColor]""", name)
                with self.subTest(scheme=scheme, name=name):
                    self.assertGreater(contrast(*style), 4.5)


def coloured(picture):
    """The part of the pixels that have colour: the surface."""
    return float((np.ptp(picture, axis=2) > 30).mean())


def contrast(*colours):
    """The ratio of luminances of WCAG of "rgb(...)" and another one."""
    def luminance(text):
        c = np.array([float(x) for x in text[text.index("(") + 1:-1].split(",")[:3]]) / 255
        return np.where(c <= 0.03928, c / 12.92, ((c + 0.055) / 1.055) ** 2.4) @ [0.2126, 0.7152, 0.0722]
    low, high = sorted(luminance(text) + 0.05 for text in colours)
    return high / low


if __name__ == "__main__":
    unittest.main(verbosity=2)
