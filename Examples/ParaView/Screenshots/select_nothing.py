# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Without a selection, each macro shows its example."""

from paraview.simple import *

SetActiveSource(None)
