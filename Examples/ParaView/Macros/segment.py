# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Divides the selected surface into three regions by its active array and shows their boundaries.
If no source is selected, an example is shown."""

from paraview.simple import *

surface = GetActiveSource()
if surface is None:
    sphere = Clean(Sphere(ThetaResolution=120, PhiResolution=120))
    surface = Calculator(
        sphere, Function="sin(8*coordsX)*sin(8*coordsY)+0.3*sin(200*coordsX+170*coordsY*coordsZ)",
        ResultArrayName="patches")

result = SurfaceSegmentationFilter(surface, NumberOfRegions=3)
RenameSource("Regions", result)

view = GetActiveViewOrCreate("RenderView")
HideAll(view)
display = Show(result, view)
display.SetScalarBarVisibility(view, True)
boundaries = Show(OutputPort(result, 2), view)
boundaries.ColorArrayName = ["POINTS", ""]
boundaries.LineWidth = 3.0
boundaries.AmbientColor = boundaries.DiffuseColor = [0.0, 0.0, 0.0]
ResetCamera(view)
Render(view)
SetActiveSource(result)
