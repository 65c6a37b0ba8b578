# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Denoise a mesh through its normals, in ParaView's Python.

    PV_PLUGIN_PATH=<folder of SurfaceDiffusion.so> pvpython harmonic_map.py [surface.vtp]

The normals diffuse as unit vectors (Exponent 1 removes noise and preserves creases), and with
MoveVertices the points are moved so that the triangles turn with them. The program writes
harmonic_map.png: the surface, the same points shaded with the regularised normals, and the moved
points.

Try next: Exponent=2, which rounds the edges; GenerateTimeSteps=1, which lets ParaView's clock play
the run.
"""

import sys

from paraview.simple import *

if len(sys.argv) > 1:
    surface = OpenDataFile(sys.argv[1])
else:
    box = Box(XLength=1, YLength=1, ZLength=1)
    fine = Subdivide(Clean(Triangulate(box)), NumberofSubdivisions=5)
    place = "(1.13*coordsX + 1.71*coordsY + 2.93*coordsZ)"
    noise = "0.007*(sin(9871*%s)*iHat + sin(7919*%s)*jHat + sin(8887*%s)*kHat)" % ((place,) * 3)
    surface = WarpByVector(
        Calculator(fine, Function=noise, ResultArrayName="noise"), Vectors=["POINTS", "noise"])

try:
    make_normals = SurfaceNormals
except NameError:  # its name in ParaView 5.11
    make_normals = GenerateSurfaceNormals
normals = make_normals(surface, Splitting=0)  # those of the noisy surface, for comparison
lighted = HarmonicMapFilter(normals, TimeStep=0.03, NumberOfTimeSteps=10)
moved = HarmonicMapFilter(normals, TimeStep=0.03, NumberOfTimeSteps=10, MoveVertices=1)
moved.UpdatePipeline()
moved.SMProxy.UpdatePropertyInformation()
for name in ("MeanDisplacement", "MaximumDisplacement", "VolumeBefore", "VolumeAfter"):
    print(name, moved.GetPropertyValue(name))

LoadPalette("WhiteBackground")
layout = CreateLayout("Normals")
views = [CreateView("RenderView") for _ in range(3)]
AssignViewToLayout(views[0], layout)
AssignViewToLayout(views[2], layout, layout.SplitHorizontal(0, 0.67))
AssignViewToLayout(views[1], layout, layout.SplitHorizontal(1, 0.5))
layout.SetSize(1200, 400)
for view, source in zip(views, (normals, lighted, moved)):
    display = Show(source, view)
    display.ColorArrayName = ["POINTS", ""]
    view.OrientationAxesVisibility = 0
    view.CameraPosition = (3, 2, 4)
    ResetCamera(view)
SaveScreenshot("harmonic_map.png", layout, ImageResolution=[1200, 400])
