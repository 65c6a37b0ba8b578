# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Denoise data on a surface and preserve edges, in ParaView's Python.

    PV_PLUGIN_PATH=<folder of SurfaceDiffusion.so> pvpython intrinsic_tv.py [surface.vtp array]

The program writes intrinsic_tv.png: the data, the result of linear diffusion, which smooths the
edges together with the noise, and that of intrinsic total variation with its default settings.

Try next: FidelityWeight=6, which removes less; Mode="SteadyState", which computes the limit of a
long run in one step; FidelityNorm="L1", for outliers; MaskArray=["POINTS", name], which fills in
missing points.
"""

import sys

from paraview.simple import *

if len(sys.argv) > 2:
    surface = OpenDataFile(sys.argv[1])
    name = sys.argv[2]
else:
    name = "patches"  # of heights 0 and 1, with noise
    sphere = Sphere(ThetaResolution=128, PhiResolution=128)
    noise = RandomAttributes(sphere, GeneratePointScalars=1, GenerateCellVectors=0,
                             GeneratePointVectors=0)
    patches = "if(sin(9*coordsX)*sin(9*coordsY)*sin(9*coordsZ) > 0, 1, 0)"
    surface = Calculator(noise, Function=f"{patches} + RandomPointScalars/255 - 0.5",
                         ResultArrayName=name)
surface.UpdatePipeline()

heat = FVMHeatFilter(surface, InputArray=["POINTS", name], NumberOfTimeSteps=2)
tv = IntrinsicTVFilter(surface, InputArray=["POINTS", name])

LoadPalette("WhiteBackground")
layout = CreateLayout("Total variation")
views = [CreateView("RenderView") for _ in range(3)]
AssignViewToLayout(views[0], layout)
right = layout.SplitHorizontal(0, 1 / 3) + 1
AssignViewToLayout(views[1], layout, right)
AssignViewToLayout(views[2], layout, layout.SplitHorizontal(right, 0.5) + 1)
layout.SetSize(1200, 400)

for view, source, array in (
        (views[0], surface, name), (views[1], heat, name + "Diffused"), (views[2], tv, name + "TV")):
    display = Show(source, view)
    ColorBy(display, ("POINTS", array))
    colors = GetColorTransferFunction(array)
    colors.AutomaticRescaleRangeMode = "Never"
    colors.RescaleTransferFunction(*surface.PointData[name].GetRange())
    display.LookupTable = colors
    view.OrientationAxesVisibility = 0
    ResetCamera(view)
SaveScreenshot("intrinsic_tv.png", layout, ImageResolution=[1200, 400])
