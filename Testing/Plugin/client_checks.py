# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The checks of the macros of the client tests. They run in ParaView's window, between two clicks,
and each prints one line that the test requires."""

import os

import numpy as np
from paraview import make_name_valid, smtrace
from paraview.simple import (
    AssignViewToLayout, ColorBy, CreateView, Delete, FindSource, GetActiveSource, GetActiveView,
    GetAnimationScene, GetColorTransferFunction, GetDisplayProperties, GetLayout, GetSources,
    GetViews, Hide, Render, SetActiveSource, SetActiveView, Show,
)
from plugin_testing import (
    PICTURE_TOLERANCE, assert_looks_like, assert_looks_unlike, differences, filter_names,
    picture_error, results,
)
from vtkmodules.vtkCommonCore import vtkLogger

# The array that colours the test's picture of a filter, the root mean square of its first component,
# and the array that the first Apply selects.
RESULTS = {
    "FVMHeatFilter": (("POINTS", "fDiffused"), 0.0592719, ("POINTS", "fDiffused")),
    "IntrinsicTVFilter": (("POINTS", "fTV"), 0.314870988, ("POINTS", "fTV")),
    "HarmonicMapFilter": (("POINTS", "NormalsHarmonic"), 0.423504683, ("POINTS", "f")),  # seen in the shading
    "MumfordShahFilter": (("POINTS", "fMumfordShah"), 0.612244, ("POINTS", "fMumfordShah")),
    "SurfaceDenoisingFilter": (("POINTS", "Displacement"), 0.00250532, ("POINTS", "f")),
    "SurfaceCurvatureFilter": (("POINTS", "MeanCurvature"), 17.682478, ("POINTS", "MeanCurvature")),
    "SurfaceDerivativesFilter": (("POINTS", "fGradient"), 10.6204755, ("POINTS", "f")),
    "SurfaceDirectionFieldFilter": (("CELLS", "Direction"), 0.881400, ("POINTS", "f")),
    "SurfaceDistanceFilter": (("POINTS", "Distance"), 0.511944, ("POINTS", "Distance")),
    "SurfaceInterpolationFilter": (("POINTS", "fInterpolated"), 0.692164, ("POINTS", "fInterpolated")),
    "SurfaceRandomFieldFilter": (("POINTS", "RandomField"), 0.875830508, ("POINTS", "RandomField")),
    "SurfaceReliefFilter": (("POINTS", "ReliefHeight"), 0.00321144, ("POINTS", "f")),
    "SurfaceSegmentationFilter": (("POINTS", "RegionProbability"), 0.706920, ("POINTS", "RegionId")),
    "TensorDiffusionFilter": (("POINTS", "fBeltrami"), 0.0826594, ("POINTS", "fBeltrami")),
    "TuringTextureFilter": (("POINTS", "Texture"), 0.476918, ("POINTS", "Texture")),
}
TOLERANCE = 1e-4  # of these numbers, relative

# A change of each filter that its picture and its number must show: one step fewer, or a value that
# is slightly off.
SLIPS = {
    "FVMHeatFilter": lambda heat: {"NumberOfTimeSteps": heat.NumberOfTimeSteps - 1},
    "IntrinsicTVFilter": lambda tv: {"FidelityWeight": 1.2 * tv.FidelityWeight},
    "HarmonicMapFilter": lambda harmonic: {"NumberOfTimeSteps": harmonic.NumberOfTimeSteps - 1},
    "MumfordShahFilter": lambda edges: {"EdgeWidth": 1.2 * edges.EdgeWidth},
    "SurfaceDenoisingFilter": lambda mesh: {
        "NoiseLevel": 1.2 * mesh.GetPropertyValue("EffectiveNoiseLevel")},
    "SurfaceCurvatureFilter": lambda curved: {"FWHM": curved.FWHM + 0.2},
    "SurfaceDerivativesFilter": lambda derived: {"SmoothingFWHM": derived.SmoothingFWHM + 0.2},
    "SurfaceDirectionFieldFilter": lambda field: {"Angle": field.Angle + 3.0},
    "SurfaceDistanceFilter": lambda _: {"Method": "Heat"},
    "SurfaceInterpolationFilter": lambda spline: {
        "AutomaticSmoothing": 0, "Smoothing": 1.2 * spline.GetPropertyValue("EffectiveSmoothing")},
    "SurfaceRandomFieldFilter": lambda field: {"RandomSeed": field.RandomSeed + 1},
    "SurfaceReliefFilter": lambda relief: {"Height": 1.2 * relief.Height},
    "SurfaceSegmentationFilter": lambda regions: {
        "AutomaticFidelity": 0,
        "FidelityWeight": 0.5 * regions.GetPropertyValue("EffectiveFidelityWeight")},
    "TensorDiffusionFilter": lambda flow: {"NumberOfTimeSteps": flow.NumberOfTimeSteps - 1},
    "TuringTextureFilter": lambda turing: {"DiffusionRate2": 1.02 * turing.DiffusionRate2},
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
    array, _, _ = RESULTS[name_of(source)]
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


def has_number(source):
    """Whether the root mean square of a filter's result is that of its first Apply."""
    array, expected, _ = RESULTS[name_of(source)]
    numbers = results(source)[(0,) + array].astype(float)
    number = np.sqrt(np.mean(numbers.reshape(len(numbers), -1)[:, 0] ** 2))
    say("%s: %s %.9g" % (name_of(source), array[1], number))
    return abs(number - expected) <= TOLERANCE * expected


def check_slip(view, baseline, slip, number=False):
    """Checks that the picture of the active source would show this change of its properties, and
    so would its number."""
    source = GetActiveSource()
    correct = {name: source.GetPropertyValue(name) for name in slip}
    for name, value in slip.items():
        source.SetPropertyWithName(name, value)
    assert_looks_unlike(view, baseline)
    assert not (number and has_number(source)), "%s does not change the number" % slip
    for name, value in correct.items():
        source.SetPropertyWithName(name, value)


def hide(source):
    """Hides all outputs of a source."""
    for port in range(source.SMProxy.GetNumberOfOutputPorts()):
        Hide(source[port], render_view())


def check_first_apply():
    """Checks the result of the active source, which has been applied with its default settings."""
    source, view, data = GetActiveSource(), render_view(), FindSource("Data")
    name = name_of(source)
    display = GetDisplayProperties(source, view)
    assert display.Visibility
    assert tuple(display.ColorArrayName) == RESULTS[name][2], display.ColorArrayName
    assert len(GetViews()) == 1  # the history does not open by default
    Hide(data, view)
    assert has_number(source), name
    check_picture("Client" + name)
    source.UpdatePropertyInformation()
    check_slip(view, "Client" + name, SLIPS[name](source), number=True)
    hide(source)
    SetActiveView(view)
    Show(data, view)
    SetActiveSource(data)
    say("as expected: " + name)


def applied_filters():
    """The filters of the scene by name."""
    found = {name_of(source): source for source in GetSources().values()}
    return {name: found[name] for name in filter_names() if name in found}


def check_every_filter():
    """Checks that every filter of the plugin has been applied."""
    missing = set(filter_names()) - set(applied_filters())
    assert not missing, "not applied: %s" % missing
    say("as expected: %d filters" % len(filter_names()))


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
    """After the filters are deleted, the trace creates them again with the same numbers, and the
    same picture of the first one."""
    trace = smtrace.stop_trace()
    assert "NumberOfTimeSteps = " not in trace, trace  # a default
    expected = {}
    assert len(applied_filters()) == 2
    for name, source in applied_filters().items():
        label = make_name_valid(source.SMProxy.GetXMLLabel())
        assert label + "(" in trace, trace
        assert has_number(source), name
        expected[name] = label + "1", results(source)
        Delete(source)
        assert FindSource(label + "1") is None
    del source  # the last one keeps its proxy
    exec(compile(trace, "trace", "exec"), {"__name__": "trace"})
    for name, (label, numbers) in expected.items():
        source = FindSource(label)
        assert name_of(source) == name
        wrong = differences(results(source), numbers)
        assert not wrong, "%s differs: %s" % (name, wrong)
        if name != "FVMHeatFilter":
            hide(source)
    SetActiveSource(FindSource(expected["FVMHeatFilter"][0]))
    check_steps(10, end=True)
    say("as expected: trace of %d filters" % len(expected))


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


LOG = os.path.join(os.environ["SURFACEDIFFUSION_OUTPUT_DIR"], "errors.log")
executions = []


def refuse():
    """Gives the active source, which has not been applied yet, a setting that it refuses. From now on
    errors are logged."""
    source = GetActiveSource()
    source.NumberOfThreads = -1
    vtkLogger.LogToFile(LOG, vtkLogger.TRUNCATE, vtkLogger.VERBOSITY_ERROR)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)  # where the test's driver takes it for a failure
    source.SMProxy.GetClientSideObject().AddObserver(
        "StartEvent", lambda *_: executions.append(1))


def check_refusal():
    """Checks that the refused Apply gave one message of one line, and that the input is shown."""
    display = GetDisplayProperties(GetActiveSource(), render_view())
    Render(render_view())
    shown = display.GetClientSideObject().GetRenderedDataObject(0)
    points = FindSource("Data").GetDataInformation().GetNumberOfPoints()
    found = shown.GetNumberOfPoints() if shown else 0
    vtkLogger.EndLogToFile(LOG)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_INFO)
    with open(LOG) as file:
        lines = file.read().split("ERR|", 1)[-1].strip().splitlines()
    say("refused: %d executions, %d lines, %d of %d points" % (len(executions), len(lines), found, points))
    assert len(executions) == len(lines) == 1, lines
    assert "NumberOfThreads is -1" in lines[0], lines
    assert display.Visibility and found == points
    say("as expected: refusal")


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
        "Inpainted": ("Inpaint", {"HoldKnownValues": 0, "FidelityWeight": 4.0}),
        "Denoised": ("Denoise", {}),
        "Edges": ("Edges", {"AutomaticThreshold": 0, "EdgeThreshold": 0.9}),
        "Denoised mesh": ("DenoiseMesh", {"SurfaceType": "Organic"}),
        "Relief": ("Relief", {"Height": 0.034}),
        "Texture": ("Texture", {"DiffusionRate2": 1.02 * 5.2}),
    }[next(key[0] for key, each in GetSources().items() if each == source)]
    if name == "Denoise":
        source.UpdatePropertyInformation()
        weight = source.GetPropertyValue("EffectiveFidelityWeight")
        slip = {"AutomaticFidelity": 0, "FidelityWeight": 0.25 * weight}  # one trial of the search
    if name not in ("DenoiseMesh", "Relief"):
        GetDisplayProperties(source, view).SetScalarBarVisibility(view, False)
    view.OrientationAxesVisibility = 0
    assert_looks_like(view, "Macro" + name)
    check_slip(view, "Macro" + name, slip)
    say("as expected: " + name)
