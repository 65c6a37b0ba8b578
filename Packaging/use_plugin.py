# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""For pvpython: load a plugin that was built, smooth data with it, and compare with the exact solution.
Argument: the plugin."""

import math
import sys

from paraview.simple import Elevation, LoadPlugin, Sphere

LoadPlugin(sys.argv[1], remote=False, ns=globals())
source = Elevation(Sphere(ThetaResolution=64, PhiResolution=64))
smooth = FVMHeatFilter(source, FWHM=0.2)  # noqa: F821  # from the plugin
smooth.UpdatePipeline()
low, high = source.PointData["Elevation"].GetRange()
smooth_low, smooth_high = smooth.PointData["ElevationDiffused"].GetRange()
# A linear function on a sphere of radius 1/2, whose eigenvalue is 8, after the time FWHM^2 / (16 log 2)
factor = (smooth_high - smooth_low) / (high - low)
exact = math.exp(-8 * 0.2**2 / (16 * math.log(2)))
if not abs(factor - exact) < 1e-3:
    sys.exit(f"the plugin smooths by {factor}, not by {exact}")
print("the plugin smooths by", factor)
