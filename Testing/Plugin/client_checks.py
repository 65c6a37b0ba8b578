# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the macros of the client's tests look at. They run in ParaView's window, between two clicks;
each prints one line for the test to find."""

import os

from paraview import smtrace
from paraview.simple import (
    AssignViewToLayout, ColorBy, CreateView, Delete, FindSource, GetActiveSource, GetActiveView,
    GetAnimationScene, GetColorTransferFunction, GetDisplayProperties, GetLayout, GetViews, Hide,
    SetActiveSource, SetActiveView, Show,
)
from plugin_testing import assert_looks_like

# What the test colours the picture of a filter by, and what the first Apply has coloured it by.
COLORS = {
    "FVMHeatFilter": (("POINTS", "fDiffused"), ("POINTS", "fDiffused")),
    "IntrinsicTVFilter": (("POINTS", "fTV"), ("POINTS", "fTV")),
    "HarmonicMapFilter": (("POINTS", "NormalsHarmonic"), ("POINTS", "f")),  # shading shows it
    "TuringTextureFilter": (("POINTS", "Texture"), ("POINTS", "u1")),
    "SurfaceDirectionFieldFilter": (("CELLS", "Direction"), ("POINTS", "f")),
}


def say(text):
    """To the terminal: print() goes to the window."""
    os.write(1, (text + "\n").encode())


def name_of(source):
    return source.SMProxy.GetXMLName()


def render_view():
    return next(view for view in GetViews() if name_of(view) == "RenderView")


def check_picture(baseline):
    """The surface of the active source, coloured by its result."""
    source, view = GetActiveSource(), render_view()
    array, _ = COLORS[name_of(source)]
    display = GetDisplayProperties(source, view)
    display.SetScalarBarVisibility(view, False)
    ColorBy(display, array)
    display.LookupTable = GetColorTransferFunction(array[1])
    display.SetScalarBarVisibility(view, False)
    view.OrientationAxesVisibility = 0
    assert_looks_like(view, baseline)


def looks_like(baseline):
    try:
        check_picture(baseline)
    except AssertionError:
        return False
    return True


def check_first_apply():
    source, view = GetActiveSource(), render_view()
    name = name_of(source)
    display = GetDisplayProperties(source, view)
    assert display.Visibility
    assert tuple(display.ColorArrayName) == COLORS[name][1], display.ColorArrayName
    assert len(GetViews()) == 1  # the history does not take half of the window by itself
    check_picture("Client" + name)
    Hide(source, view)
    SetActiveView(view)
    data = FindSource("Data")
    Show(data, view)
    SetActiveSource(data)
    say("as expected: " + name)


def check_time(time, end):
    """The clock's time, and whether the picture is that of the end."""
    clock = GetAnimationScene()
    assert list(clock.TimeKeeper.TimestepValues) == list(range(11)), clock.TimeKeeper.TimestepValues
    assert clock.AnimationTime == time, clock.AnimationTime
    assert looks_like("ClientFVMHeatFilter") == end
    say("as expected: time %g" % time)


def check_steps(steps, end):
    """The number of time steps that the panel set, and whether the picture is that of ten."""
    assert GetActiveSource().NumberOfTimeSteps == steps, GetActiveSource().NumberOfTimeSteps
    assert looks_like("ClientFVMHeatFilter") == end
    say("as expected: %d steps" % steps)


def start_recording():
    """As "Start Trace" does."""
    smtrace.start_trace()


def check_recording():
    """Without the filter, the trace makes it again, and the same picture."""
    trace = smtrace.stop_trace()
    assert "FVMHeatFilter(" in trace and "NumberOfTimeSteps = 10" not in trace, trace
    Delete(GetActiveSource())
    assert FindSource("FVMHeatFilter1") is None
    exec(compile(trace, "trace", "exec"), {"__name__": "trace"})
    SetActiveSource(FindSource("FVMHeatFilter1"))
    check_steps(10, end=True)
    say("as expected: trace")


def open_chart():
    """As "Split Horizontal" and "Line Chart View" do."""
    view = CreateView("XYChartView")
    AssignViewToLayout(view, GetLayout(render_view()))
    SetActiveView(view)


def check_chart():
    """The second output of the active source as lines over its time."""
    chart = GetActiveView()
    assert name_of(chart) == "XYChartView"
    (lines,) = chart.Representations
    assert lines.Visibility and lines.Input.Port == 1
    assert (lines.UseIndexForXAxis, lines.XArrayName) == (0, "Time"), lines.XArrayName
    assert "Energy" in lines.SeriesVisibility, lines.SeriesVisibility
    say("as expected: chart")


def check_selected_denoised():
    """The macro took the source that was selected."""
    source = GetActiveSource()
    assert source == FindSource("Denoised") and source.Input == FindSource("Data")
    assert source.PointData["fTV"] is not None
    say("as expected: selected data")


def check_history():
    """A chart of the energy stands beside the picture, which is still the active view."""
    (chart,) = [view for view in GetViews() if name_of(view) == "XYChartView"]
    (lines,) = chart.Representations
    assert lines.Input.Port == 1 and "Energy" in lines.SeriesVisibility, lines.SeriesVisibility
    assert GetActiveView() == render_view()
    say("as expected: history")


def select_nothing():
    SetActiveSource(None)


def check_macro():
    """The picture of the example that a macro of Examples/ParaView shows."""
    source, view = GetActiveSource(), render_view()
    name = {
        "IntrinsicTVFilter": "Inpaint" if source == FindSource("Inpainted") else "Denoise",
        "HarmonicMapFilter": "DenoiseMesh",
        "TuringTextureFilter": "Texture",
    }[name_of(source)]
    if name != "DenoiseMesh":
        GetDisplayProperties(source, view).SetScalarBarVisibility(view, False)
    view.OrientationAxesVisibility = 0
    assert_looks_like(view, "Macro" + name)
    say("as expected: " + name)
