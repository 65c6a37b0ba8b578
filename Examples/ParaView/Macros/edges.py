# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Finds the edges of the selected data and shows them as curves over the piecewise smooth result
(Mumford and Shah). If no source is selected, an example is shown."""

from paraview.simple import *

surface = GetActiveSource()
if surface is None:
    sphere = Clean(Sphere(ThetaResolution=200, PhiResolution=200))
    patches = Calculator(
        sphere, Function="(sin(9*coordsX)*sin(9*coordsY)>0)+0.5*coordsZ", ResultArrayName="patches")
    surface = patches

result = MumfordShahFilter(surface)
RenameSource("Edges", result)

view = GetActiveViewOrCreate("RenderView")
HideAll(view)
display = Show(result, view)
display.SetScalarBarVisibility(view, True)
curves = Show(OutputPort(result, 2), view)
curves.ColorArrayName = ["POINTS", ""]
curves.LineWidth = 3.0
curves.AmbientColor = curves.DiffuseColor = [0.0, 0.0, 0.0]
ResetCamera(view)
Render(view)
SetActiveSource(result)
