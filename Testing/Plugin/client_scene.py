# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the client shows before ClientHeat.xml starts: data on a sphere, and for the result a
colour map of black and white bands, which make small differences of values large ones of images."""

from paraview.simple import Calculator, GetColorTransferFunction, Render, Show, Sphere

sphere = Sphere(ThetaResolution=64, PhiResolution=64)
waves = "sin(14*coordsX)*sin(14*coordsY)*sin(14*coordsZ)"
Show(Calculator(sphere, Function=waves, ResultArrayName="f"))

BANDS = 12
colors = GetColorTransferFunction("fDiffused")
colors.AutomaticRescaleRangeMode = "Never"
colors.RGBPoints = [
    number
    for i in range(BANDS)
    for number in (0.2 * (2 * i / (BANDS - 1) - 1), i % 2, i % 2, i % 2)
]
colors.Discretize = 1
colors.NumberOfTableValues = BANDS
Render()
