# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The initial scene of the client: smooth data on an ellipsoid, and two regions of noisy data on an
ellipsoid with noisy points, and a patch of an ellipsoid. Results are shown in black and white
bands, so that small differences of values are large differences of images."""

from paraview.simple import (
    Calculator, GenerateSurfaceNormals, GetActiveViewOrCreate, GetColorTransferFunction, Render,
    RenameSource, ResetCamera, SetActiveSource, Show, Sphere, Transform,
)
from plugin_testing import noisy

sphere = Sphere(ThetaResolution=64, PhiResolution=64)
ellipsoid = Transform(Input=sphere)
ellipsoid.Transform.Scale = (1.0, 0.8, 0.6)
normals = GenerateSurfaceNormals(Input=ellipsoid, Splitting=0)
waves = "sin(14*coordsX)*sin(14*coordsY)*sin(14*coordsZ)"
data = Calculator(Input=normals, Function=waves, ResultArrayName="f")
RenameSource("Data", data)
regions = noisy(normals)
RenameSource("Noisy", regions)
patch = Calculator(Input=normals, Function="if(coordsX > 0.4, 1, 0)", ResultArrayName="source")
RenameSource("Patch", patch)
patch.UpdatePipeline()
regions.UpdatePipeline()  # without arrays the menu would not offer filters
view = GetActiveViewOrCreate("RenderView")
Show(data, view)

BANDS = 13  # odd: x and -x look the same, since the sign of a direction has no meaning
for array, largest in (
    ("fDiffused", 0.2), ("fTV", 1.0), ("NormalsHarmonic", 1.0), ("Texture", 1.0), ("Direction", 1.0),
    ("fMumfordShah", 1.0), ("fBeltrami", 0.5), ("RegionProbability", 1.0), ("Displacement", 0.02),
    ("fInterpolated", 1.0), ("ReliefHeight", 0.02), ("MeanCurvature", 40.0), ("fGradient", 30.0),
    ("Distance", 1.0),
):
    colors = GetColorTransferFunction(array)
    colors.AutomaticRescaleRangeMode = "Never"
    colors.RGBPoints = [
        number
        for i in range(BANDS)
        for number in (largest * (2 * i / (BANDS - 1) - 1), i % 2, i % 2, i % 2)
    ]
    colors.Discretize = 1
    colors.NumberOfTableValues = BANDS
    colors.VectorMode = "Component"
    colors.VectorComponent = 0
ResetCamera(view)
Render(view)
SetActiveSource(data)
