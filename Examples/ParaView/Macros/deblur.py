# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Restores data of the selected surface that were blurred on it, and their edges. Weak noise is
removed; stronger noise needs a smaller FidelityWeight. If no source is selected, an example is
shown."""

from paraview.simple import *

WIDTH = 0  # full width at half maximum, in the unit of the coordinates; 0: 4 mean edge lengths

surface = GetActiveSource()
if surface is None:
    sphere = Clean(Sphere(ThetaResolution=120, PhiResolution=120))
    patches = "sign(sin(8*coordsX)*sin(8*coordsY)*sin(8*coordsZ))"
    clean = Calculator(sphere, Function=patches, ResultArrayName="patches")
    surface = FVMHeatFilter(clean, FWHM=0.06, ResultArrayName="blurred")
    WIDTH = 0.06

result = IntrinsicTVFilter(surface, Mode="SteadyState")
if not WIDTH:
    UpdatePipeline(proxy=result)
    result.UpdatePropertyInformation()
    WIDTH = 4 * result.MeanEdgeLength
result.BlurFWHM = WIDTH
result.FidelityWeight = 100
RenameSource("Deblurred", result)

view = GetActiveViewOrCreate("RenderView")
HideAll(view)
display = Show(result, view)
display.SetScalarBarVisibility(view, True)
ResetCamera(view)
Render(view)
SetActiveSource(result)
