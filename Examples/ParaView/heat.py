# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Watch data diffuse on a surface, in ParaView's Python.

    PV_PLUGIN_PATH=<folder of SurfaceDiffusion.so> pvpython heat.py [surface.vtp array]

GenerateTimeSteps publishes time steps: time 0 shows the data, and ParaView's clock plays the
diffusion, both in pvpython and in the window. The range of the colours is fixed, so that one sees
the ripples fade before the broad wave. The program writes heat.png, the start beside the end, and
the animation heat.0000.png, heat.0001.png, ...

Try next: FWHM=0.5, which blurs by half a unit of length and replaces TimeStep; FidelityWeight=0.05,
whose limit is close to the data; Show(OutputPort(heat, 1), CreateView("XYChartView")), which plots
the history.
"""

import sys

from paraview.simple import *

if len(sys.argv) > 2:
    surface = OpenDataFile(sys.argv[1])
    name = sys.argv[2]
else:
    name = "waves"  # a broad wave and ripples
    waves = "cos(6*coordsY) + 0.5*sin(40*coordsX)*sin(40*coordsZ)"
    sphere = Sphere(ThetaResolution=128, PhiResolution=128)
    surface = Calculator(sphere, Function=waves, ResultArrayName=name)
surface.UpdatePipeline()

heat = FVMHeatFilter(
    surface, InputArray=["POINTS", name], TimeStep=1, NumberOfTimeSteps=10, GenerateTimeSteps=1)
heat.UpdatePipeline(0.0)

LoadPalette("WhiteBackground")
layout = CreateLayout("Heat")
start, end = CreateView("RenderView"), CreateView("RenderView")
AssignViewToLayout(start, layout)
AssignViewToLayout(end, layout, layout.SplitHorizontal(0, 0.5))
layout.SetSize(1000, 500)

colors = GetColorTransferFunction(name + "Diffused")
colors.AutomaticRescaleRangeMode = "Never"
colors.RescaleTransferFunction(*surface.PointData[name].GetRange())
for view, source, array in ((start, surface, name), (end, heat, name + "Diffused")):
    display = Show(source, view)
    ColorBy(display, ("POINTS", array))
    display.LookupTable = colors
    view.OrientationAxesVisibility = 0
    ResetCamera(view)

clock = GetAnimationScene()
clock.UpdateAnimationUsingDataTimeSteps()
print("times:", *heat.TimestepValues)
SaveAnimation("heat.png", end, ImageResolution=[500, 500])
clock.GoToLast()
SaveScreenshot("heat.png", layout, ImageResolution=[1000, 500])
