# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A scene with every filter is saved and loaded again, and the pictures are equal in every pixel, the
results in every bit. Each part runs in a separate process, as for a user who returns the next day."""

import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from paraview import make_name_valid, servermanager, simple, smstate
from paraview.simple import (
    Calculator, ColorBy, FindSource, GetActiveViewOrCreate, GetAnimationScene, GetColorTransferFunction,
    Line, LoadState, Render, ResetCamera, SaveScreenshot, SaveState, Show, XMLPolyDataReader,
)
from plugin_testing import differences, filter_names, results, write_sphere
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

# Properties that a state must keep, of some filters
SETTINGS = {
    "FVMHeatFilter": dict(GenerateTimeSteps=1),
    "HarmonicMapFilter": dict(InputArray=["POINTS", "east"], LineField=1),
    "IntrinsicTVFilter": dict(MaskArray=["POINTS", "hole"]),
    "MumfordShahFilter": dict(AutomaticThreshold=0, EdgeThreshold=0.5),
    "SurfaceCurvatureFilter": dict(FWHM=0.3),
    "SurfaceDerivativesFilter": dict(Quantity="Laplacian"),
    "SurfaceDirectionFieldFilter": dict(Method="Smooth"),
    "SurfaceDistanceFilter": dict(Method="Eikonal"),
    "SurfaceInterpolationFilter": dict(ComputeError=1),
    "SurfaceRandomFieldFilter": dict(Covariance="MaternNu1", NumberOfFields=2),
    "SurfaceSegmentationFilter": dict(NumberOfRegions=3),
    "TensorDiffusionFilter": dict(NumberOfTimeSteps=4),
    "TuringTextureFilter": dict(
        NumberOfTimeSteps=80, DirectionArray=["CELLS", "Direction"], DiffusionRate2=5.2,
        DiffusionRateAcross2=2.6),
}
INPUTS = {"TuringTextureFilter": "SurfaceDirectionFieldFilter"}  # of the others: the sphere
FURTHER_INPUTS = {"SurfaceDistanceFilter": ["Sources", "PathPoints"],
                  "SurfaceInterpolationFilter": ["PointsWithValues"]}
NAMES = filter_names()
SIZE = [100 * len(NAMES), 100]
TIMES = (0, 4)


def make(folder):
    """Saves a scene with the results of the filters, both kinds of state, and the pictures."""
    path = os.path.join(folder, "sphere.vtp")
    write_sphere(path, roughness=0.02)
    sphere = XMLPolyDataReader(FileName=[path])
    line = Line(registrationName="line", Point1=[0.9, 0.3, -0.3], Point2=[0.9, 0.3, 0.3], Resolution=9)
    points = Calculator(line, registrationName="points", Function="coordsX + 2*coordsZ", ResultArrayName="height")
    points.UpdatePipeline()
    view = GetActiveViewOrCreate("RenderView")
    view.ViewSize = SIZE
    view.OrientationAxesVisibility = 0
    view.CameraParallelProjection = 1
    for i, name in enumerate(NAMES):
        # By its label, as from the window's menu; TestProxies makes them by their classes' names, too.
        label = make_name_valid(servermanager.ProxyManager().GetPrototypeProxy("filters", name).GetXMLLabel())
        source = getattr(simple, label)(
            FindSource(INPUTS[name]) if name in INPUTS else sphere, registrationName=name,
            **SETTINGS.get(name, {}), **dict.fromkeys(FURTHER_INPUTS.get(name, ()), points))
        place, array = next(
            key[1:] for key in results(source) if key[0] == 0 and key[2] != "coordinates")
        display = Show(source, view)
        display.Position = (2.2 * i, 0.0, 0.0)
        ColorBy(display, (place, array))
        display.LookupTable = GetColorTransferFunction(array)
    ResetCamera(view)
    view.CameraParallelScale /= len(NAMES)
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
    for each in NAMES:
        source = FindSource(each)
        source.UpdatePipeline(TIMES[-1])
        found = {"%d %s %s" % key: numbers for key, numbers in results(source).items()}
        np.savez(os.path.join(folder, "%s_%s.npz" % (name, each)), **found)


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
        for name in NAMES:
            found, expected = (
                dict(np.load(os.path.join(self.folder, "%s_%s.npz" % (each, name))))
                for each in (part, "made"))
            self.assertEqual(differences(found, expected), [], name)


if __name__ == "__main__":
    if len(sys.argv) == 3:
        globals()[sys.argv[1]](sys.argv[2])
    else:
        unittest.main(verbosity=2)
