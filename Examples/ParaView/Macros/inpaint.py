# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Fills in the data of the selected surface at points whose array "mask" is nonzero and continues
the edges of the data, equation (19) of the paper. If no source is selected, an example is shown."""

from paraview.simple import *

surface = GetActiveSource()
if surface is None:
    sphere = Clean(Sphere(ThetaResolution=120, PhiResolution=120))
    strokes = Calculator(
        sphere, Function="abs(sin(15*(coordsX+coordsY+0.3*coordsZ)))<0.3", ResultArrayName="mask")
    surface = Calculator(
        strokes, Function="sin(8*coordsX)*sin(8*coordsY)*(1-mask)+mask", ResultArrayName="damaged")

result = IntrinsicTVFilter(
    surface, MaskArray=["POINTS", "mask"], HoldKnownValues=1, Mode="SteadyState")
RenameSource("Inpainted", result)

view = GetActiveViewOrCreate("RenderView")
HideAll(view)
display = Show(result, view)
display.SetScalarBarVisibility(view, True)
ResetCamera(view)
Render(view)
SetActiveSource(result)
