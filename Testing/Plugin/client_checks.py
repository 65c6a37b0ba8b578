# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The checks of the macros of the client tests. They run in ParaView's window, between two clicks,
and each prints one line that the test requires."""

import os

from paraview import make_name_valid, smtrace
from paraview.simple import (
    AssignViewToLayout, ColorBy, CreateView, Delete, FindSource, GetActiveSource, GetActiveView,
    GetAnimationScene, GetColorTransferFunction, GetDisplayProperties, GetLayout, GetSources,
    GetViews, Hide, SetActiveSource, SetActiveView, Show,
)
from plugin_testing import (
    PICTURE_TOLERANCE, assert_looks_like, assert_looks_unlike, picture_error,
)

# The array that colours the test's picture of a filter, and the array that the first Apply selects.
COLORS = {
    "FVMHeatFilter": (("POINTS", "fDiffused"), ("POINTS", "fDiffused")),
    "IntrinsicTVFilter": (("POINTS", "fTV"), ("POINTS", "fTV")),
    "HarmonicMapFilter": (("POINTS", "NormalsHarmonic"), ("POINTS", "f")),  # seen in the shading
    "TuringTextureFilter": (("POINTS", "Texture"), ("POINTS", "u1")),
    "SurfaceDirectionFieldFilter": (("CELLS", "Direction"), ("POINTS", "f")),
}

# A change of each filter that its picture must show: one step fewer, or a rate that is slightly off.
SLIPS = {
    "FVMHeatFilter": lambda heat: {"NumberOfTimeSteps": heat.NumberOfTimeSteps - 1},
    "IntrinsicTVFilter": lambda tv: {"FidelityWeight": 1.2 * tv.FidelityWeight},
    "HarmonicMapFilter": lambda harmonic: {"NumberOfTimeSteps": harmonic.NumberOfTimeSteps - 1},
    "TuringTextureFilter": lambda turing: {"DiffusionRate2": 1.02 * turing.DiffusionRate2},
    "SurfaceDirectionFieldFilter": lambda field: {"Angle": field.Angle + 3.0},
}


def say(text):
    """Writes to the terminal; print() writes to the window."""
    os.write(1, (text + "\n").encode())


def name_of(source):
    return source.SMProxy.GetXMLName()


def render_view():
    return next(view for view in GetViews() if name_of(view) == "RenderView")


def show_result():
    """Colours the picture of the active source by its result."""
    source, view = GetActiveSource(), render_view()
    array, _ = COLORS[name_of(source)]
    display = GetDisplayProperties(source, view)
    display.SetScalarBarVisibility(view, False)
    ColorBy(display, array)
    display.LookupTable = GetColorTransferFunction(array[1])
    display.SetScalarBarVisibility(view, False)
    view.OrientationAxesVisibility = 0
    return view


def check_picture(baseline):
    """Checks the picture of the active source, coloured by its result."""
    assert_looks_like(show_result(), baseline)


def looks_like(baseline):
    return picture_error(show_result(), baseline) <= PICTURE_TOLERANCE


def check_slip(view, baseline, slip):
    """Checks that the picture of the active source would show this change of its properties."""
    source = GetActiveSource()
    correct = {name: source.GetPropertyValue(name) for name in slip}
    for name, value in slip.items():
        source.SetPropertyWithName(name, value)
    assert_looks_unlike(view, baseline)
    for name, value in correct.items():
        source.SetPropertyWithName(name, value)


def check_first_apply():
    source, view = GetActiveSource(), render_view()
    name = name_of(source)
    display = GetDisplayProperties(source, view)
    assert display.Visibility
    assert tuple(display.ColorArrayName) == COLORS[name][1], display.ColorArrayName
    assert len(GetViews()) == 1  # the history does not open by default
    check_picture("Client" + name)
    check_slip(view, "Client" + name, SLIPS[name](source))
    Hide(source, view)
    SetActiveView(view)
    data = FindSource("Data")
    Show(data, view)
    SetActiveSource(data)
    say("as expected: " + name)


def check_time(time, end):
    """Checks the time of the clock and whether the picture is that of the end."""
    clock = GetAnimationScene()
    assert list(clock.TimeKeeper.TimestepValues) == list(range(11)), clock.TimeKeeper.TimestepValues
    assert clock.AnimationTime == time, clock.AnimationTime
    assert looks_like("ClientFVMHeatFilter") == end
    say("as expected: time %g" % time)


def check_steps(steps, end):
    """Checks the number of time steps from the panel and whether the picture is that of ten
    steps."""
    assert GetActiveSource().NumberOfTimeSteps == steps, GetActiveSource().NumberOfTimeSteps
    assert looks_like("ClientFVMHeatFilter") == end
    say("as expected: %d steps" % steps)


def start_recording():
    """The same as the menu item "Start Trace"."""
    smtrace.start_trace()


def check_recording():
    """After the filter is deleted, the trace creates it again with the same picture."""
    trace = smtrace.stop_trace()
    name = make_name_valid(GetActiveSource().SMProxy.GetXMLLabel())
    assert name + "(" in trace and "NumberOfTimeSteps = 10" not in trace, trace
    Delete(GetActiveSource())
    assert FindSource(name + "1") is None
    exec(compile(trace, "trace", "exec"), {"__name__": "trace"})
    SetActiveSource(FindSource(name + "1"))
    assert name_of(GetActiveSource()) == "FVMHeatFilter"
    check_steps(10, end=True)
    say("as expected: trace")


def open_chart():
    """The same as the buttons "Split Horizontal" and "Line Chart View"."""
    view = CreateView("XYChartView")
    AssignViewToLayout(view, GetLayout(render_view()))
    SetActiveView(view)


def check_chart():
    """Checks that the chart shows the second output of the active source over its time."""
    chart = GetActiveView()
    assert name_of(chart) == "XYChartView"
    (lines,) = chart.Representations
    assert lines.Visibility and lines.Input.Port == 1
    assert (lines.UseIndexForXAxis, lines.XArrayName) == (0, "Time"), lines.XArrayName
    assert "Energy" in lines.SeriesVisibility, lines.SeriesVisibility
    say("as expected: chart")


def check_selected_denoised():
    """Checks that the macro used the selected source."""
    source = GetActiveSource()
    assert source == FindSource("Denoised") and source.Input == FindSource("Data")
    assert source.PointData["fTV"] is not None
    say("as expected: selected data")


def check_history():
    """Checks that there is a chart of the energy, and that the picture is still the active view."""
    (chart,) = [view for view in GetViews() if name_of(view) == "XYChartView"]
    (lines,) = chart.Representations
    assert lines.Input.Port == 1 and "Energy" in lines.SeriesVisibility, lines.SeriesVisibility
    assert GetActiveView() == render_view()
    say("as expected: history")


def select_nothing():
    SetActiveSource(None)


def check_macro():
    """Checks the picture of the example that a macro of Examples/ParaView shows."""
    source, view = GetActiveSource(), render_view()
    name, slip = {
        "Inpainted": ("Inpaint", {"HoldKnownValues": 0}),
        "Denoised": ("Denoise", {}),
        "Edges": ("Edges", {"AutomaticThreshold": 0, "EdgeThreshold": 0.9}),
        "Denoised mesh": ("DenoiseMesh", {"SurfaceType": "Organic"}),
        "Texture": ("Texture", {"DiffusionRate2": 1.02 * 5.2}),
    }[next(key[0] for key, each in GetSources().items() if each == source)]
    if name == "Denoise":
        source.UpdatePropertyInformation()
        weight = source.GetPropertyValue("EffectiveFidelityWeight")
        slip = {"AutomaticFidelity": 0, "FidelityWeight": 1.2 * weight}
    if name != "DenoiseMesh":
        GetDisplayProperties(source, view).SetScalarBarVisibility(view, False)
    view.OrientationAxesVisibility = 0
    assert_looks_like(view, "Macro" + name)
    check_slip(view, "Macro" + name, slip)
    say("as expected: " + name)
