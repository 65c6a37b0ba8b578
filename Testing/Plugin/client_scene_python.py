# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The initial scene of the client, with the filters of the plugin in Python."""

import inspect
import os

from paraview.simple import LoadPlugin

# Debian's ParaView 5.11 has Python 3.11, which has not this function of former versions.
if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec
LoadPlugin(os.environ["SURFACEDIFFUSION_PYTHON_PLUGIN"], remote=False, ns=globals())

import client_scene  # noqa: E402,F401  pylint: disable=wrong-import-position,unused-import
