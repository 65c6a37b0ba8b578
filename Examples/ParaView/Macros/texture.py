# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Grows stripes on the selected surface along a smooth direction field, equations (22) to (24) of
the paper. "Play" shows their growth. If no source is selected, an example is shown."""

from paraview.simple import *

surface = GetActiveSource()
if surface is None:
    surface = Clean(Sphere(ThetaResolution=90, PhiResolution=90))

field = SurfaceDirectionFieldFilter(surface, Method="Smooth")
result = TuringTextureFilter(
    field, DirectionArray=["CELLS", "Direction"], DiffusionRate2=5.2, DiffusionRateAcross2=2.6,
    TimeStep=0.125, NumberOfTimeSteps=160, GenerateTimeSteps=1, OutputInterval=16)
RenameSource("Texture", result)
clock = GetAnimationScene()
result.UpdatePipelineInformation()
clock.UpdateAnimationUsingDataTimeSteps()
clock.GoToLast()

view = GetActiveViewOrCreate("RenderView")
HideAll(view)
display = Show(result, view)
ColorBy(display, ("POINTS", "Texture"))
ResetCamera(view)
Render(view)
SetActiveSource(result)
