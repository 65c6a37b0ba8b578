# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Removes the noise of the points of the selected surface, and keeps its sharp edges. The level of the
noise is measured. If no source is selected, an example is shown."""

from paraview.simple import *

surface = GetActiveSource()
if surface is None:
    box = Subdivide(Clean(Triangulate(Box())), NumberofSubdivisions=5)
    hashes = ["43758.5*sin(%g*coordsX + %g*coordsY + %g*coordsZ)" % turns for turns in (
        (127.1, 311.7, 74.7), (269.5, 183.3, 246.1), (113.5, 271.9, 124.6))]
    noise = "0.025*(%s)" % " + ".join(
        "(%s - floor(%s) - 0.5)*%s" % (number, number, axis)
        for number, axis in zip(hashes, ("iHat", "jHat", "kHat")))
    surface = WarpByVector(
        Calculator(box, Function=noise, ResultArrayName="noise"), Vectors=["POINTS", "noise"])

result = SurfaceDenoisingFilter(surface)
RenameSource("Denoised mesh", result)

view = GetActiveViewOrCreate("RenderView")
HideAll(view)
display = Show(result, view)
display.ColorArrayName = ["POINTS", ""]
ResetCamera(view)
Render(view)
SetActiveSource(result)
