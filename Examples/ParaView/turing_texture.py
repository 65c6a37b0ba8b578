# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Watch spots and stripes grow on a surface, in ParaView's Python.

    PV_PLUGIN_PATH=<folder of SurfaceDiffusion.so> pvpython turing_texture.py [surface.vtp size]

Two chemicals react and diffuse over the surface, and a pattern of the wavelength FeatureSize grows
out of noise. On the left diffusion is isotropic. On the right the slower chemical u2 diffuses
faster along a smooth direction field, which gives stripes along it. GenerateTimeSteps lets
ParaView's clock play the growth, both in pvpython and in the window. The program writes the final
state, turing_texture.png, and the animation turing_texture.0000.png, turing_texture.0001.png, ...

Try next: DiffusionRate1=42, which gives a labyrinth; Kinetics="GrayScott" with AutomaticTimeStep=1;
Method="CurvatureAligned", which gives stripes that follow the shape.
"""

import sys

from paraview.simple import *

if len(sys.argv) > 2:
    surface = OpenDataFile(sys.argv[1])
    size = float(sys.argv[2])
else:
    surface = Clean(Sphere(ThetaResolution=90, PhiResolution=90))
    size = 0.2

run = dict(FeatureSize=size, TimeStep=0.125, NumberOfTimeSteps=160, GenerateTimeSteps=1,
           OutputInterval=16)
spots = TuringTextureFilter(surface, DiffusionRate1=13, **run)
field = SurfaceDirectionFieldFilter(surface, Method="Smooth")
stripes = TuringTextureFilter(
    field, DirectionArray=["CELLS", "Direction"], DiffusionRate2=5.2, DiffusionRateAcross2=2.6,
    **run)

LoadPalette("WhiteBackground")
layout = CreateLayout("Textures")
views = [CreateView("RenderView") for _ in range(2)]
AssignViewToLayout(views[0], layout)
AssignViewToLayout(views[1], layout, layout.SplitHorizontal(0, 0.5))
layout.SetSize(1000, 500)
for view, texture in zip(views, (spots, stripes)):
    texture.UpdatePipeline(0.0)
    display = Show(texture, view)
    ColorBy(display, ("POINTS", "Texture"))
    display.LookupTable = GetColorTransferFunction("Texture")
    view.OrientationAxesVisibility = 0
    ResetCamera(view)
GetColorTransferFunction("Texture").ApplyPreset("X Ray", True)

clock = GetAnimationScene()
clock.UpdateAnimationUsingDataTimeSteps()
print("times:", *spots.TimestepValues)
SaveAnimation("turing_texture.png", layout, ImageResolution=[1000, 500])
clock.GoToLast()
for texture in (spots, stripes):
    texture.SMProxy.UpdatePropertyInformation()
    print("wavelength", texture.GetPropertyValue("Wavelength"))
SaveScreenshot("turing_texture.png", layout, ImageResolution=[1000, 500])
