# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Scenes for the browser: every eighth of those that programs have written, or with SURFACEDIFFUSION_LONG
in the environment every one, is opened from its file and turned with the mouse. Arguments: the folder
of the programs, and the folder of the scenes."""
import contextlib
import os
import sys
import tempfile
import unittest
from pathlib import Path

from browser import PATIENCE, difference, drag, open_browser, picture_of, wait_for

import numpy as np
from selenium.webdriver.common.by import By
from vtkmodules.vtkFiltersSources import vtkSphereSource

DRAGS = 4
OUTPUT = Path(sys.argv.pop())
sys.path.insert(0, sys.argv.pop())
from scenes import save_scene  # noqa: E402
from surface_data import points_of, with_arrays  # noqa: E402


class Panel:
    """What save_scene needs of a panel of pictures.py, which needs a display."""

    def __init__(self, surface, array, title):
        self.surface, self.array, self.title = surface, array, title
        self.view, self.up, self.table = (0, 0, 1), (0, 1, 0), None


def two_coloured_ball():
    """Red for z > 0, the side to the camera, and blue behind."""
    ball = vtkSphereSource()
    ball.SetThetaResolution(30)
    ball.SetPhiResolution(30)
    ball.Update()
    front = points_of(ball.GetOutput())[:, 2] > 0
    colours = np.where(front[:, None], np.uint8([220, 30, 30]), np.uint8([30, 30, 220]))
    return with_arrays(ball.GetOutput(), colours=colours)


def blue_parts(picture):
    """The part of the ball that is blue and not red, in each half of the picture."""
    for half in np.split(picture, [picture.shape[1] // 2], axis=1):
        excess = (half[:, :, 2] - half[:, :, 0])
        clear = excess[np.abs(excess) > 60]
        yield (clear > 0).mean()


class TestScenes(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.browser = open_browser()
        cls.browser.set_window_size(600, 400)  # the browser draws without a graphics card

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()

    def turn(self, path, load=True):
        """Pictures of a scene before and after a drag of the mouse, which changes what is seen."""
        if load:
            self.browser.get(path.resolve().as_uri())
        before = wait_for(self.still_picture, f"a surface in {path.name}")
        after = self.drag_until_unlike(before)
        problems = [entry for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(problems, [])  # no error, and nothing asked from a network
        return before, after

    def drag_until_unlike(self, before):
        """A busy page may not listen to the mouse yet."""
        canvas = self.browser.find_element(By.TAG_NAME, "canvas")
        width, height = canvas.size["width"], canvas.size["height"]
        for _ in range(DRAGS):
            drag(self.browser, canvas, width // 4, 0, at=(-width * 3 // 8, -height // 8))
            with contextlib.suppress(AssertionError):
                return wait_for(lambda: self.still_picture(unlike=before), "the turned surface",
                                PATIENCE / 2)
        raise AssertionError(f"{DRAGS} drags have not turned the surface")

    def still_picture(self, unlike=None):
        """None while the page shows no surface, or is still drawing some of them."""
        last, picture = getattr(self, "last_picture", None), picture_of(self.browser)
        self.last_picture = picture
        if (picture.min(axis=2) < 200).mean() <= 0.02 or not np.array_equal(last, picture):
            return None
        return picture if unlike is None or difference(unlike, picture) > 0.01 else None

    def test_balls_turn_together_until_they_show_their_other_side(self):
        ball = two_coloured_ball()
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "ball.html")
            self.assertTrue(save_scene(path, [Panel(ball, "colours", "left <b>"),
                                              Panel(ball, "colours", "right")], 2, "Two balls"))
            before, after = self.turn(path)
            self.assertLess(max(blue_parts(before)), 0.05)
            for _ in range(8):
                if min(blue_parts(after)) > 0.5:
                    break
                _, after = self.turn(path, load=False)
            self.assertGreater(min(blue_parts(after)), 0.5)
            titles = [title.text for title in self.browser.find_elements(By.CLASS_NAME, "title")]
        self.assertEqual(titles, ["left <b>", "right"])
        self.assertEqual(self.browser.title, "Two balls")

    def test_scenes_of_examples_turn(self):
        every = 1 if "SURFACEDIFFUSION_LONG" in os.environ else 8
        scenes = sorted(OUTPUT.rglob("*.html"))[::every]
        if not scenes:
            self.skipTest(f"no scenes in {OUTPUT}: the tests Example.Python write them")
        for path in scenes:
            with self.subTest(path.name):
                self.turn(path)
        print("turned:", ", ".join(path.name for path in scenes))


if __name__ == "__main__":
    unittest.main(verbosity=2)
