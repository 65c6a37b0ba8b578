# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Rows of Examples/Python/paper_figures.py as pictures: generated surfaces with patches instead of
photographs. The pictures show the first channel in bands, which reveal errors that smooth colours hide."""

import sys
import unittest
from pathlib import Path
from types import SimpleNamespace

from vtkmodules.vtkImagingCore import vtkImageDifference
from vtkmodules.vtkIOImage import vtkPNGReader

TESTING = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TESTING.parent / "Examples" / "Python"))

import paper_figures as figures  # noqa: E402
import surface_data as data  # noqa: E402
from pictures import Panel, colour_table, display_missing, save_picture  # noqa: E402

QUICK = SimpleNamespace(quick=True)
BANDS = colour_table(0, 1, [(0.2, 0.1, 0.5), (0.9, 0.8, 0.2), (0.1, 0.6, 0.3)], steps=12)
TOLERANCE = 10.0  # fully different pixels, see Testing/Filters/ImageTest.h


def denoised(surface, slip):
    linear = figures.solve(figures.linear_model(surface), 0.28)
    model = figures.tv_denoising(surface)
    model.SetStopTolerance(1e-6)  # so that the picture does not depend on the iterations
    return linear, figures.solve(model, 6.7 * (1.2 if slip else 1))


def inpainted(surface, slip):
    linear = figures.solve(figures.linear_model(surface), 64)
    model = figures.tv_inpainting(surface)
    if slip:
        model.SetBeta(0.1)
    return linear, figures.solve(model, float("inf"))


@unittest.skipIf(display_missing(), "no display to draw on")
class TestPaperFigures(unittest.TestCase):
    def error(self, surface, values, look, name, written):
        """The difference of a row of pictures from the baseline `name`, in fully different
        pixels."""
        panels = [Panel(data.with_arrays(surface, shown=each[:, 0].copy()), "shown", title,
                        table=BANDS, closeup=(0.6, 0.7), **look)
                  for title, each in values.items()]
        save_picture(f"{written}.png", panels, 3, (240, 180))
        readers = []
        for file in (f"{written}.png", TESTING / "Baseline" / f"{name}.png"):
            self.assertTrue(Path(file).is_file(), file)
            readers.append(vtkPNGReader())
            readers[-1].SetFileName(str(file))
        difference = vtkImageDifference()
        difference.SetInputConnection(readers[0].GetOutputPort())
        difference.SetImageConnection(readers[1].GetOutputPort())
        difference.AllowShiftOff()
        difference.AveragingOff()
        difference.SetThreshold(16)
        difference.Update()
        return difference.GetThresholdedError()

    def check(self, name, surface, example, look, model):
        """Checks that the row equals its baseline, and that a small change of the TV model would
        show."""
        surface = figures.spoiled(surface, example)
        for slip in (False, True):
            linear, tv = model(surface, slip)
            values = {"spoiled": data.array_of(surface, "spoiled"), "linear": linear.values,
                      "TV": tv.values}
            error = self.error(surface, values, look, name, name + ("Slipped" if slip else ""))
            if slip:
                self.assertGreater(error, TOLERANCE)
            else:
                self.assertLessEqual(error, TOLERANCE)
                self.assertGreater(tv.psnr, linear.psnr + 1)

    def test_noise_is_removed_on_a_closed_surface(self):
        example = figures.FIGURES[4][1]
        self.check("Figure4", figures.painted(example, QUICK), example, figures.FRONT, denoised)

    def test_scratches_and_spots_are_filled_in_on_an_open_surface(self):
        example = figures.FIGURES[6][2]
        self.check("Figure6", figures.painted(example, QUICK), example, figures.FRONT, inpainted)



if __name__ == "__main__":
    unittest.main(verbosity=2)
