# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Grows a labyrinth on the selected part and raises it as relief, for printing: "Save Data" writes an STL
file. The pattern has a tenth of the part's diagonal. If no source is selected, an example is shown."""

from paraview.simple import *

part = GetActiveSource()
if part is None:
    part = Box()

part = Clean(Triangulate(part))  # STL files have points of their own for each face
part.UpdatePipeline()
bounds = part.GetDataInformation().GetBounds()
size = 0.1 * sum((high - low) ** 2 for low, high in zip(bounds[::2], bounds[1::2])) ** 0.5
texture = TuringTextureFilter(part, FeatureSize=size, DiffusionRate1=18 * 2.6)
result = SurfaceReliefFilter(texture, InputArray=["POINTS", "Texture"], Height=0.15 * size)
RenameSource("Relief", result)

view = GetActiveViewOrCreate("RenderView")
HideAll(view)
display = Show(result, view)
display.ColorArrayName = ["POINTS", ""]
ResetCamera(view)
Render(view)
SetActiveSource(result)
