# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The filters as a plugin for ParaView from 5.11 on, without a compiler. (The ParaView of Debian 12 loads no
plugin in Python, because it asks Python 3.11 for a function that older versions had.)

In ParaView, Tools > Manage Plugins > Load New takes the file SurfaceDiffusionPython.py of this folder;
in a script it is ``LoadPlugin(path)``. The file finds the package beside it if the Python of ParaView
does not have it. The filters have the names, properties, panels, defaults and results of the plugin in
C++: the proxies are those of its XML files, and the numerics are the same. ParaView has to run in one
process, and a surface has to be in one piece.
"""

from __future__ import annotations

import os

#: The file that ParaView loads.
PLUGIN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "SurfaceDiffusionPython.py")
