# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A scene with every filter is saved and loaded again, and the pictures are equal in every pixel, the
results in every bit. Each part runs in a separate process, as for a user who returns the next day."""

import os
import subprocess
import sys
import tempfile
import unittest

from paraview import smstate
from paraview.simple import (
    ColorBy, FVMHeatFilter, GetActiveCamera, GetActiveViewOrCreate, GetAnimationScene,
    GetColorTransferFunction, HarmonicMapFilter, IntrinsicTVFilter, LoadState, Render, ResetCamera,
    SaveScreenshot, SaveState, Show, SurfaceDirectionFieldFilter, TuringTextureFilter,
    XMLPolyDataReader,
)
from plugin_testing import write_sphere
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

SIZE = [400, 100]
TIMES = (0, 4)


def make(folder):
    """Saves a scene with the results of the filters, both kinds of state, and the pictures."""
    path = os.path.join(folder, "sphere.vtp")
    write_sphere(path)
    sphere = XMLPolyDataReader(FileName=[path])
    chained = TuringTextureFilter(
        SurfaceDirectionFieldFilter(sphere, Method="Smooth"), NumberOfTimeSteps=80,
        DirectionArray=["CELLS", "Direction"], DiffusionRate2=5.2, DiffusionRateAcross2=2.6)
    results = (
        (FVMHeatFilter(sphere, GenerateTimeSteps=1), "noisyDiffused"),
        (IntrinsicTVFilter(sphere, MaskArray=["POINTS", "hole"]), "noisyTV"),
        (HarmonicMapFilter(sphere, InputArray=["POINTS", "east"], LineField=1), "eastHarmonic"),
        (chained, "Texture"),
    )
    view = GetActiveViewOrCreate("RenderView")
    view.ViewSize = SIZE
    view.OrientationAxesVisibility = 0
    for i, (source, array) in enumerate(results):
        display = Show(source, view)
        display.Position = (2.2 * i, 0.0, 0.0)
        ColorBy(display, ("POINTS", array))
        display.LookupTable = GetColorTransferFunction(array)
    ResetCamera(view)
    GetActiveCamera().Dolly(2.4)
    Render(view)
    SaveState(os.path.join(folder, "scene.pvsm"))
    with open(os.path.join(folder, "scene.py"), "w") as script:
        script.write(smstate.get_state())
    draw(folder, "made")


def load_pvsm(folder):
    LoadState(os.path.join(folder, "scene.pvsm"))
    draw(folder, "load_pvsm")


def load_python(folder):
    with open(os.path.join(folder, "scene.py")) as script:
        exec(script.read(), {"__name__": "state"})
    draw(folder, "load_python")


def draw(folder, name):
    clock = GetAnimationScene()
    clock.UpdateAnimationUsingDataTimeSteps()  # the window does this automatically
    for time in TIMES:
        clock.AnimationTime = time
        SaveScreenshot(
            os.path.join(folder, "%s%d.png" % (name, time)), GetActiveViewOrCreate("RenderView"),
            ImageResolution=SIZE)


class TestScenes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.run_alone("make")

    @classmethod
    def run_alone(cls, part):
        interpreter = os.environ["SURFACEDIFFUSION_PVPYTHON"]
        subprocess.run([interpreter, __file__, part, cls.folder], check=True)

    def pixels(self, name, time):
        reader = vtkPNGReader()
        reader.SetFileName(os.path.join(self.folder, "%s%d.png" % (name, time)))
        reader.Update()
        return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())

    def differences(self, a, b):
        return (self.pixels(*a) != self.pixels(*b)).any(1).sum()

    def test_time_changes_the_picture(self):
        self.assertGreater(self.differences(("made", 0), ("made", 4)), 1000)

    def test_a_state_file_restores_the_picture(self):
        self.check("load_pvsm")

    def test_a_python_state_restores_the_picture(self):
        self.check("load_python")

    def check(self, part):
        self.run_alone(part)
        for time in TIMES:
            self.assertEqual(self.differences(("made", time), (part, time)), 0)


if __name__ == "__main__":
    if len(sys.argv) == 3:
        globals()[sys.argv[1]](sys.argv[2])
    else:
        unittest.main(verbosity=2)
