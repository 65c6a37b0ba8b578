# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Denoises the data of the selected surface and preserves their edges, equation (17) of the paper.
The noise level is estimated. If no source is selected, an example is shown."""

from paraview.simple import *

surface = GetActiveSource()
if surface is None:
    sphere = Clean(Sphere(ThetaResolution=120, PhiResolution=120))
    patches = "sign(sin(8*coordsX)*sin(8*coordsY)*sin(8*coordsZ))"
    noise = "0.6*sin(9871*coordsX+7919*coordsY+8887*coordsZ)"
    surface = Calculator(sphere, Function=patches + "+" + noise, ResultArrayName="noisy")

result = IntrinsicTVFilter(surface, Mode="SteadyState", AutomaticFidelity=1)
RenameSource("Denoised", result)

view = GetActiveViewOrCreate("RenderView")
HideAll(view)
display = Show(result, view)
display.SetScalarBarVisibility(view, True)
ResetCamera(view)
Render(view)
SetActiveSource(result)
