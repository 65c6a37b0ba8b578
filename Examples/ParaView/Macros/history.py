# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Plots the energy of the selected surface diffusion filter over time, in a line chart beside the
surface."""

from paraview.simple import *

source = GetActiveSource()
view = GetActiveView()
layout = GetLayout(view)
chart = CreateView("XYChartView")
AssignViewToLayout(chart, layout, layout.SplitHorizontal(layout.GetViewLocation(view), 0.6))
lines = Show(OutputPort(source, 1), chart)
lines.SeriesVisibility = ["Energy"]
chart.BottomAxisTitle = "Time"
chart.LeftAxisTitle = "Energy"
Render(chart)
SetActiveView(view)
