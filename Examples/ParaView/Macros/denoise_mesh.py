# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Denoises the normals of the selected surface, preserves its creases, and moves the points to fit
the normals, equation (21) of the paper. If no source is selected, an example is shown."""

from paraview.simple import *

surface = GetActiveSource()
if surface is None:
    box = Subdivide(Clean(Triangulate(Box())), NumberofSubdivisions=5)
    place = "(1.13*coordsX + 1.71*coordsY + 2.93*coordsZ)"
    noise = "0.007*(sin(9871*%s)*iHat + sin(7919*%s)*jHat + sin(8887*%s)*kHat)" % ((place,) * 3)
    surface = WarpByVector(
        Calculator(box, Function=noise, ResultArrayName="noise"), Vectors=["POINTS", "noise"])

result = HarmonicMapFilter(surface, TimeStep=0.03, MoveVertices=1)
RenameSource("Denoised mesh", result)

view = GetActiveViewOrCreate("RenderView")
HideAll(view)
display = Show(result, view)
display.ColorArrayName = ["POINTS", ""]
ResetCamera(view)
Render(view)
SetActiveSource(result)
