# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Prepares ParaView's window for the clicks of window.xml: noisy data on a surface."""

from paraview.simple import *

sphere = Clean(Sphere(ThetaResolution=120, PhiResolution=120))
patches = "sign(sin(8*coordsX)*sin(8*coordsY)*sin(8*coordsZ))"
noise = "0.6*sin(9871*coordsX+7919*coordsY+8887*coordsZ)"
noisy = Calculator(sphere, Function=patches + "+" + noise, ResultArrayName="noisy")
RenameSource("Noisy", noisy)
view = GetActiveViewOrCreate("RenderView")
Show(noisy, view)
LoadPalette("WhiteBackground")
view.CameraPosition = (1.2, 0.9, 1.6)
ResetCamera(view)
SetActiveSource(noisy)
Render(view)
