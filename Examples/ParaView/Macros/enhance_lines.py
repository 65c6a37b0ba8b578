# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Smooths the selected data along their own lines, such as stripes and ridges, and closes the gaps of
these (coherence-enhancing diffusion). If no source is selected, an example is shown."""

from paraview.simple import *

surface = GetActiveSource()
if surface is None:
    sphere = Clean(Sphere(ThetaResolution=120, PhiResolution=120))
    stripes = Calculator(
        sphere, Function="sin(40*(0.8*coordsX+0.6*coordsZ))*(sin(25*coordsY)>-0.8)",
        ResultArrayName="stripes")
    surface = stripes

result = TensorDiffusionFilter(surface, Model="CoherenceEnhancing")
RenameSource("Enhanced", result)

view = GetActiveViewOrCreate("RenderView")
HideAll(view)
display = Show(result, view)
display.SetScalarBarVisibility(view, True)
ResetCamera(view)
Render(view)
SetActiveSource(result)
