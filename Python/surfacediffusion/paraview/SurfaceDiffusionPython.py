# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""ParaView loads this file as a plugin: see help("surfacediffusion.paraview")."""

import os
import sys

try:
    import surfacediffusion
except ImportError:  # it is beside this file
    sys.path.append(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
    import surfacediffusion

from surfacediffusion.paraview._plugin import define_filters

paraview_plugin_name = "SurfaceDiffusionPython"
paraview_plugin_version = surfacediffusion.__version__

globals().update(define_filters(__name__))
