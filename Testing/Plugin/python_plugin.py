# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs all filters of a plugin, in Python or C++, in many ways, and writes what they give:

    pvpython python_plugin.py PLUGIN RESULTS.npz

TestPythonPlugin.py compares the two."""

import inspect
import json
import os
import random
import sys
import time

import numpy as np
from panel import click, sphere_with_arrays
from partitions import blocks, collection, copy_of, give_ids, partitioned, split
from paraview import servermanager, simple
from plugin_testing import filter_names, noisy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIdTypeArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import (
    vtkCellArray, vtkDataObject, vtkPolyData, vtkUnstructuredGrid,
)

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))
from kinds_of_run import kinds_of_run  # noqa: E402

CLICKS = 12  # runs of each filter with random properties
SEAMS = {"ids", "random", "unused", "apart", "absent", "flags", "twice"}  # ways to stitch pieces, for three filters
THREE = ("FVMHeatFilter", "SurfaceDenoisingFilter", "SurfaceDistanceFilter")
# Debian's ParaView 5.11 has Python 3.11, which has not this function of former versions.
if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec

found = {}  # what is compared: arrays, and texts


def put(key, value):
    assert key not in found, key
    found[key] = value


def producer(data):
    source = servermanager.sources.TrivialProducer()
    source.SMProxy.GetClientSideObject().SetOutput(data)
    return source


def make(name, source, **properties):
    """A filter and the messages that it will have, with steps enough to be seen."""
    made = getattr(servermanager.filters, name)(Input=source)
    if "NumberOfTimeSteps" in made.ListProperties():
        made.NumberOfTimeSteps = 3
    if name == "SurfaceReliefFilter":
        made.InputArray = ["POINTS", "f"]
    if name == "SurfaceDistanceFilter" and "Sources" not in properties:
        made.SourceArray = ["POINTS", "ends"]
    for key, value in properties.items():
        setattr(made, key, value)
    messages = []
    algorithm = made.SMProxy.GetClientSideObject()

    def remember(_object, event, text):
        # After the name and address of the object, which each has on a line of its own in C++
        lines = [line for line in text.strip().splitlines() if not line.startswith("ERROR: In /")
                 and not line.startswith("Warning: In /")]
        message = (event, " ".join(lines).partition("): ")[2].strip())
        messages.append(message)

    remember.CallDataType = "string0"
    for event in ("ErrorEvent", "WarningEvent"):
        algorithm.AddObserver(event, remember)
    return made, messages


def roles(data):
    """The names of the active attributes."""
    names = {}
    for place, kind in (("POINTS", vtkDataObject.POINT), ("CELLS", vtkDataObject.CELL)):
        attributes = data.GetAttributes(kind)
        for role in range(6 if attributes else 0):
            array = attributes.GetAbstractAttribute(role)
            names["%s %d" % (place, role)] = array.GetName() if array else None
    return names


def leaves(data):
    if not data.IsA("vtkCompositeDataSet"):
        return [data]
    iterator, all_leaves = data.NewIterator(), []
    while not iterator.IsDoneWithTraversal():
        all_leaves.append(iterator.GetCurrentDataObject())
        iterator.GoToNextItem()
    return all_leaves


def describe(made, key):
    """Put the outputs of a filter: numbers, types, roles, times."""
    algorithm = made.SMProxy.GetClientSideObject()
    for port in range(algorithm.GetNumberOfOutputPorts()):
        data = algorithm.GetOutputDataObject(port)
        put("%s/%d/class" % (key, port), data.GetClassName())
        if port == 0:
            information = data.GetInformation()
            at = vtkDataObject.DATA_TIME_STEP()
            put(key + "/time", information.Get(at) if information.Has(at) else None)
        for number, leaf in enumerate(leaves(data)):
            here = "%s/%d/%d" % (key, port, number)
            if leaf.IsA("vtkPolyData"):
                put(here + "/roles", roles(leaf))
                for kind, cells in (("polys", leaf.GetPolys()), ("lines", leaf.GetLines())):
                    if cells.GetNumberOfCells():
                        put(here + "/" + kind, vtk_to_numpy(cells.GetConnectivityArray()).copy())
            if leaf.IsA("vtkPointSet") and leaf.GetNumberOfPoints():
                put(here + "/coordinates", vtk_to_numpy(leaf.GetPoints().GetData()).copy())
            for place, kind in (("POINTS", vtkDataObject.POINT), ("CELLS", vtkDataObject.CELL),
                                ("ROWS", vtkDataObject.ROW), ("FIELD", vtkDataObject.FIELD)):
                attributes = leaf.GetAttributesAsFieldData(kind)
                for a in range(attributes.GetNumberOfArrays() if attributes else 0):
                    array = attributes.GetArray(a)
                    if array and (place, array.GetName()) != ("ROWS", "Seconds"):
                        names = [array.GetComponentName(k) for k in range(array.GetNumberOfComponents())]
                        put("%s/%s/%s" % (here, place, array.GetName()), vtk_to_numpy(array).copy())
                        put("%s/%s/%s/names" % (here, place, array.GetName()), names)
    made.UpdatePipelineInformation()
    for name in made.ListProperties():
        prop = made.SMProxy.GetProperty(name)
        # Steps are counted over the life of a filter.
        if prop.GetInformationOnly() and name != "NumberOfStepsComputed":
            made.SMProxy.UpdatePropertyInformation(prop)
            put("%s/%s" % (key, name), [prop.GetElement(i) for i in range(prop.GetNumberOfElements())])


def run(name, source, key, **properties):
    made, messages = make(name, source, **properties)
    made.UpdatePipeline()
    put("%s/%s/messages" % (key, name), messages)
    describe(made, "%s/%s" % (key, name))
    return made


def list_properties():
    for name in filter_names():
        made = getattr(servermanager.filters, name)()
        for key in made.ListProperties():
            prop = made.SMProxy.GetProperty(key)
            elements = None if prop.IsA("vtkSMProxyProperty") else [
                prop.GetElement(i) for i in range(prop.GetNumberOfElements())]
            put("properties/%s/%s" % (name, key), [
                prop.GetXMLLabel(), prop.GetPanelVisibility(), elements,
                prop.GetDocumentation().GetDescription(), prop.GetCommand()])
        groups = [made.SMProxy.GetPropertyGroup(i) for i in range(made.SMProxy.GetNumberOfPropertyGroups())]
        menu = servermanager.ProxyManager().GetPrototypeProxy("filters", name)
        hints = menu.GetHints().FindNestedElementByName("ShowInMenu")
        put("menu/%s" % name, [menu.GetXMLLabel(), hints.GetAttribute("category")])
        put("groups/%s" % name, [
            [group.GetXMLLabel()] + [group.GetProperty(k).GetXMLName()
                                     for k in range(group.GetNumberOfProperties())] for group in groups])
        put("simple/%s" % name, globals()[name].__doc__)


def run_clicks():
    for name in filter_names():
        for number in range(CLICKS):
            dice = random.Random("%s %d" % (name, number))
            made, messages = make(name, sphere_with_arrays())
            if name in ("FVMHeatFilter", "IntrinsicTVFilter", "SurfaceInterpolationFilter",
                        "SurfaceSegmentationFilter"):
                made.InputArray = dice.choice((["POINTS", "f"], ["CELLS", "g"]))
            clicked = []
            for _ in range(8):
                click(made, dice, clicked)
            if name == "SurfaceDirectionFieldFilter" and made.Method == "Hints":
                made.DirectionArray = ["CELLS", "up"]  # the hints, which the panel then shows
            made.UpdatePipeline()
            key = "clicks/%s/%d" % (name, number)
            put(key + "/clicked", repr(clicked))
            put(key + "/messages", messages)
            describe(made, key)


def mixed():
    """Vertices, lines, polygons of three to six corners, strips, a hidden cell and a hidden point."""
    sphere = sphere_with_arrays().SMProxy.GetClientSideObject().GetOutputDataObject(0)
    data = vtkPolyData()
    data.SetPoints(sphere.GetPoints())
    data.GetPointData().ShallowCopy(sphere.GetPointData())
    corners = vtk_to_numpy(sphere.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    polygons, strips = vtkCellArray(), vtkCellArray()
    taken = set()
    for t, triangle in enumerate(corners.tolist()):
        if t in taken:
            continue
        polygon = list(triangle)
        for u in range(t + 1, len(corners)):  # join neighbours into polygons
            shared = set(polygon) & set(corners[u].tolist())
            if len(polygon) < 3 + t % 4 and len(shared) == 2 and u not in taken:
                a, b = sorted(polygon.index(s) for s in shared)
                if b - a in (1, len(polygon) - 1):
                    (new,) = set(corners[u].tolist()) - shared
                    polygon.insert(b if b - a == 1 else len(polygon), new)
                    taken.add(u)
        target = strips if len(polygon) == 3 and t % 5 == 0 else polygons
        target.InsertNextCell(len(polygon), polygon)
    verts, lines = vtkCellArray(), vtkCellArray()
    verts.InsertNextCell(1, [3])
    lines.InsertNextCell(2, [4, 5])
    data.SetVerts(verts)
    data.SetLines(lines)
    data.SetPolys(polygons)
    data.SetStrips(strips)
    cells = data.GetNumberOfCells()
    for name, values in (("g", np.cos(np.arange(cells))), ("spots", (np.arange(cells) % 7 == 0) * 1.0),
                         ("up", np.tile([0.0, 0.0, 1.0], (cells, 1))),
                         ("rates", np.tile([21.0, 21.0, 2.6, 2.6], (cells, 1)))):
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        data.GetCellData().AddArray(array)
    ghosts = np.zeros(cells, dtype=np.uint8)
    ghosts[cells // 2] = 32
    hidden = np.zeros(data.GetNumberOfPoints(), dtype=np.uint8)
    hidden[20] = 2
    for attributes, flags in ((data.GetCellData(), ghosts), (data.GetPointData(), hidden)):
        array = numpy_to_vtk(flags, deep=True)
        array.SetName("vtkGhostType")
        attributes.AddArray(array)
    return producer(data)


def typed(kind):
    return producer(typed_data(kind))


def typed_data(kind):
    """The sphere with values of another type, and single precision coordinates with normals."""
    data = vtkPolyData()
    data.DeepCopy(sphere_with_arrays().SMProxy.GetClientSideObject().GetOutputDataObject(0))
    values = vtk_to_numpy(data.GetPointData().GetArray("f"))
    values = 100.0 * (values - values.min()) if kind != np.float32 else values
    array = numpy_to_vtk(values.astype(kind), deep=True)
    array.SetName("f")
    data.GetPointData().AddArray(array)
    colors = numpy_to_vtk(np.stack([values, values[::-1], values, values], axis=1).astype(np.uint8), deep=True)
    colors.SetName("rgba")
    colors.SetComponentName(3, "alpha")
    data.GetPointData().AddArray(colors)
    ids = vtkIdTypeArray()
    ids.DeepCopy(numpy_to_vtk(np.arange(data.GetNumberOfPoints())[::-1].copy()))
    ids.SetName("ids")
    data.GetPointData().SetGlobalIds(ids)
    return data


def with_arrays_of_all_kinds():
    """The arrays of kinds_of_run.txt on the sphere."""
    data = copy_of(dataset(noisy(sphere_with_arrays())))
    n, m = data.GetNumberOfPoints(), data.GetNumberOfCells()
    dice = np.random.default_rng(7)
    for attributes, name, values in (
        (data.GetCellData(), "c", 2.0 + 0.5 * dice.normal(size=m)),
        (data.GetCellData(), "weights", np.arange(m) % 4 * 0.25),
        (data.GetPointData(), "weights", np.arange(n) % 4 * 0.25),
        (data.GetPointData(), "rgb", dice.integers(0, 255, (n, 3), np.uint8)),
        (data.GetPointData(), "mask", np.arange(n) % 17 == 3),
        (data.GetPointData(), "e1", dice.normal(size=(n, 3))),
        (data.GetPointData(), "sources", np.where(np.arange(n) % 17 == 3, 1 + np.arange(n) % 3, 0)),
    ):
        array = numpy_to_vtk(np.ascontiguousarray(values * 1 if values.dtype == bool else values), deep=True)
        array.SetName(name)
        attributes.AddArray(array)
    return producer(data)


def run_kinds():
    source = with_arrays_of_all_kinds()
    for kind, class_name, values in kinds_of_run():
        values = {key: ["CELLS" if value[1] else "POINTS", value[0]] if isinstance(value, tuple) else value
                  for key, value in values.items()}
        if "PathPoints" in values:
            values["PathPoints"] = producer(scattered())
        run(class_name[len("vtk"):], source, "kind " + kind, **values)


def weightless():
    """The sphere with weights of 0 and other values there on a part of it."""
    data = copy_of(dataset(sphere_with_arrays()))
    outside = vtk_to_numpy(data.GetPoints().GetData())[:, 0] > 0.2
    vtk_to_numpy(data.GetPointData().GetArray("weight"))[outside] = 0.0
    vtk_to_numpy(data.GetPointData().GetArray("f"))[outside] += 100.0
    return producer(data)


def run_kinds_of_input():
    for name in filter_names():
        run(name, noisy(sphere_with_arrays()), "noisy")
        run(name, mixed(), "mixed")
        run(name, noisy(sphere_with_arrays()), "one thread", NumberOfThreads=1)
        run(name, sphere_with_arrays(), "refined", RefineTo=0.12)
        run(name, sphere_with_arrays(), "limit", RefineTo=0.05, MaximumNumberOfTriangles=900)
        for kind in (np.float32, np.int32, np.uint8):
            run(name, typed(kind), kind.__name__)
        for kind in ("vtkMultiBlockDataSet", "vtkPartitionedDataSetCollection"):
            parts = [sphere_with_arrays(), simple.Transform(Input=sphere_with_arrays())]
            parts[1].Transform.Translate = [3.0, 0.0, 0.0]
            parts[1].Transform.Scale = [1.5, 1.5, 1.5]
            group = simple.GroupDatasets(Input=parts, OutputType=kind)
            group.UpdatePipeline()
            run(name, group, kind)
    for name in ("FVMHeatFilter", "IntrinsicTVFilter", "MumfordShahFilter", "TensorDiffusionFilter",
                 "SurfaceSegmentationFilter", "SurfaceInterpolationFilter"):
        for length in (0.0, 0.12):
            run(name, weightless(), "weightless %g" % length, FidelityArray=["POINTS", "weight"],
                RefineTo=length)
    colors = dict(InputArray=["POINTS", "rgba"])
    for name in ("FVMHeatFilter", "IntrinsicTVFilter", "TensorDiffusionFilter", "SurfaceSegmentationFilter"):
        run(name, typed(np.uint8), "colors", **colors)
        run(name, typed(np.uint8), "single", OutputPrecision=0, ResultArrayName="mine", **colors)
    points = producer(scattered())
    run("SurfaceInterpolationFilter", sphere_with_arrays(), "samples", PointsWithValues=points,
        ComputeError=1, MissingValue=[-9999.0, 1e30])
    for method in ("Heat", "Eikonal", "Exact"):
        run("SurfaceDistanceFilter", sphere_with_arrays(), "sources" + method, Sources=points, Method=method,
            ComputeGradient=1, PathPoints=producer(scattered()))
    run("SurfaceSegmentationFilter", sphere_with_arrays(), "means", InputArray=["POINTS", "f"],
        AutomaticMeans=0, NumberOfRegions=2, Mean=[1, 0, -0.3, 2, 0, 0.3])
    run("TuringTextureFilter", sphere_with_arrays(), "feature", FeatureSize=0.3)


def hide(data, points):
    flags = np.zeros(data.GetNumberOfPoints(), dtype=np.uint8)
    flags[points] = 2
    array = numpy_to_vtk(flags, deep=True)
    array.SetName("vtkGhostType")
    data.GetPointData().AddArray(array)
    return producer(data)


def run_left_out():
    """Hidden points of second inputs and of surfaces, sources far away, and blocks with text in place of
    numbers."""
    for number, points in enumerate(([2, 9], slice(None))):
        run("SurfaceInterpolationFilter", sphere_with_arrays(), "left out/%d" % number,
            PointsWithValues=hide(scattered(), points))
        run("SurfaceDistanceFilter", sphere_with_arrays(), "left out/%d" % number,
            Sources=hide(scattered(), points))
        run("SurfaceDistanceFilter", sphere_with_arrays(), "left out/paths/%d" % number,
            Sources=producer(scattered()), PathPoints=hide(scattered(), points))
    far = copy_of(scattered())
    vtk_to_numpy(far.GetPoints().GetData())[:] *= 100.0
    run("SurfaceDistanceFilter", sphere_with_arrays(), "left out/far", Sources=producer(far))
    run("SurfaceDerivativesFilter", typed(np.uint8), "left out/rgba", InputArray=["POINTS", "rgba"])
    sphere = dataset(sphere_with_arrays())
    for name in filter_names():
        run(name, hide(copy_of(sphere), slice(None)), "left out/all")
        text = copy_of(sphere)
        for array in ("f", "ends"):
            names = vtkStringArray()
            names.SetName(array)
            names.SetNumberOfValues(text.GetNumberOfPoints())
            text.GetPointData().RemoveArray(array)
            text.GetPointData().AddArray(names)
        properties = {"InputArray": ["POINTS", "f"]} if name != "SurfaceDistanceFilter" else {}
        probe = getattr(servermanager.filters, name)()
        if not set(properties) - set(probe.ListProperties()) and name != "HarmonicMapFilter":
            run(name, producer(blocks([[copy_of(sphere)], [text]])), "left out/text", **properties)


def run_special_input():
    """What other lists have not: a surface without walls, arrays that ParaView converts, an array without
    tuples, and polygons of many corners at every step."""
    plane = simple.Plane(XResolution=6, YResolution=6)
    run("SurfaceReliefFilter", simple.Calculator(Input=plane, Function="coordsX", ResultArrayName="f"), "open")
    for number, choice in enumerate((["POINTS", "east_X"], ["POINTS", "east_Magnitude"], ["CELLS", "f"],
                                     ["POINTS", "g"])):
        run("FVMHeatFilter", sphere_with_arrays(), "converted%d" % number, InputArray=choice)
    data = vtkPolyData()
    data.DeepCopy(sphere_with_arrays().SMProxy.GetClientSideObject().GetOutputDataObject(0))
    empty = vtkDoubleArray()
    empty.SetName("empty")
    data.GetPointData().AddArray(empty)
    run("FVMHeatFilter", producer(data), "empty array", RefineTo=0.12)
    made = run("FVMHeatFilter", mixed(), "polygons", InputArray=["POINTS", "f"])
    made.TimeStep = 2.0 * made.TimeStep
    made.UpdatePipeline()
    describe(made, "polygons again")


def dataset(source):
    source.UpdatePipeline()
    return source.SMProxy.GetClientSideObject().GetOutputDataObject(0)


def run_pieces():
    """Surfaces in pieces, alone and among others, through the same updates as whole ones."""
    sphere = copy_of(dataset(noisy(sphere_with_arrays())))
    other = copy_of(dataset(sphere_with_arrays()))
    vtk_to_numpy(other.GetPoints().GetData())[:] *= 0.1
    vtk_to_numpy(other.GetPoints().GetData())[:] += 3.0
    many = copy_of(dataset(mixed()))
    for name in filter_names():
        for key, data in (
            ("slabs", partitioned(split(sphere, 2))),
            ("ids", partitioned(split(give_ids(sphere, cells=True), 3))),
            ("random", partitioned(split(sphere, 3, "random") + [vtkPolyData()])),
            ("ghosts", partitioned(split(give_ids(sphere), 3, "ghosts"))),
            ("unused", partitioned(split(sphere, 2, "unused"))),
            ("apart", partitioned(split(sphere, 2, "apart"))),
            ("array", partitioned(split(sphere, 2, "array"))),
            ("absent", partitioned(split(sphere, 2, "absent"))),
            ("flags", partitioned(split(sphere, 2, "flags"))),
            ("twice", partitioned(split(sphere, 2) + split(sphere, 2))),
            ("mixed", partitioned(split(many, 3))),
            ("collection", collection([split(sphere, 2), [other], []])),
            ("blocks", blocks([[other], split(sphere, 3)])),
        ):
            if name in THREE or key not in SEAMS:
                run(name, producer(data), "pieces " + key)
        slabs = partitioned(split(sphere, 3))
        run(name, producer(slabs), "pieces refined", RefineTo=0.12)
        run(name, producer(slabs), "pieces far", SeamTolerance=0.05)
        run(name, producer(slabs), "pieces seam", SeamTolerance=-3.0)
        made, messages = make(name, producer(slabs))
        made.UpdatePipeline()
        values = vtk_to_numpy(slabs.GetPartition(1).GetPointData().GetArray("f"))
        values[:] = 0.5 * values
        slabs.Modified()
        made.SMProxy.GetClientSideObject().Modified()
        made.SMProxy.MarkModified(made.SMProxy)
        made.UpdatePipeline()
        put("pieces edited/%s/messages" % name, messages)
        describe(made, "pieces edited/%s" % name)
    # ParaView 5.11 crashes where it makes point data of cell data on such a surface.
    for place, array in (("CELLS", "g"), ("POINTS", "f")):
        for name in ("FVMHeatFilter", "IntrinsicTVFilter", "SurfaceSegmentationFilter"):
            run(name, producer(partitioned(split(many, 3))), "pieces %s %s" % (place, array),
                InputArray=[place, array])
    run("HarmonicMapFilter", producer(partitioned(split(sphere, 3))), "pieces moved", MoveVertices=1)
    masked = partitioned(split(sphere, 3))
    for number, kind in enumerate((np.uint8, np.int32, np.float64)):
        data = masked.GetPartition(number)
        flags = np.zeros(data.GetNumberOfPoints(), dtype=kind)
        flags[:5] = 256 if number == 1 else 1
        mask = numpy_to_vtk(flags, deep=True)
        mask.SetName("of any type")
        data.GetPointData().AddArray(mask)
    run("FVMHeatFilter", producer(masked), "pieces masked", InputArray=["POINTS", "f"],
        MaskArray=["POINTS", "of any type"])
    run("FVMHeatFilter", producer(partitioned(split(typed_data(np.uint8), 2))), "pieces colors",
        InputArray=["POINTS", "rgba"], ResultArrayName="f")


def run_edits():
    """Points and values that are edited in place: results and warnings follow the contents."""
    for name in filter_names():
        data = vtkPolyData()
        data.DeepCopy(sphere_with_arrays().SMProxy.GetClientSideObject().GetOutputDataObject(0))
        made, messages = make(name, producer(data))
        made.UpdatePipeline()
        for number, change in enumerate((data.GetPoints().GetData(), data.GetPointData().GetArray("f"))):
            vtk_to_numpy(change)[::3] *= 1.02
            data.Modified()
            made.SMProxy.GetClientSideObject().Modified()
            made.SMProxy.MarkModified(made.SMProxy)
            made.UpdatePipeline()
            describe(made, "edits/%s/%d" % (name, number))
        put("edits/%s/messages" % name, messages)


def broken():
    """A triangle with a point that does not exist."""
    data = vtkPolyData()
    data.DeepCopy(sphere_with_arrays().SMProxy.GetClientSideObject().GetOutputDataObject(0))
    corners = vtk_to_numpy(data.GetPolys().GetConnectivityArray())
    corners[4] = 10000
    return producer(data)


def scattered():
    """Points with values and a line, around the sphere."""
    data = vtkPolyData()
    points = vtkPoints()
    places = np.random.default_rng(5).normal(size=(12, 3))
    points.SetData(numpy_to_vtk(0.52 * places / np.linalg.norm(places, axis=1)[:, None], deep=True))
    data.SetPoints(points)
    verts, lines = vtkCellArray(), vtkCellArray()
    for i in range(8):
        verts.InsertNextCell(1, [i])
    lines.InsertNextCell(3, [8, 9, 10])
    data.SetVerts(verts)
    data.SetLines(lines)
    array = numpy_to_vtk(places[:, 2].copy(), deep=True)
    array.SetName("height")
    data.GetPointData().SetScalars(array)
    return data


def run_times():
    """Times asked for in any order, and properties changed in between."""
    for name in filter_names():
        made, messages = make(name, noisy(sphere_with_arrays()))
        if "GenerateTimeSteps" not in made.ListProperties():
            continue
        made.GenerateTimeSteps = 1
        made.NumberOfTimeSteps = 6
        made.OutputInterval = 2
        for number, at in enumerate((6, 0, 3, 5, 6, 1)):
            if number == 4:
                made.OutputInterval = 3
            made.UpdatePipelineInformation()
            times = list(made.TimestepValues)
            put("times/%s/%d/all" % (name, number), times)
            made.UpdatePipeline(times[-1] * at / 6.0)
            describe(made, "times/%s/%d" % (name, number))
        made.NumberOfThreads = -1
        for time in (1.0, 0.0):
            made.UpdatePipeline(time)
        put("times/%s/messages" % name, messages)


def run_faults():
    grid = producer(vtkUnstructuredGrid())
    for name in filter_names():
        for key, source, properties in (
            ("grid", grid, {}), ("empty", producer(vtkPolyData()), {}),
            ("length", sphere_with_arrays(), {"RefineTo": -3.0}),
            ("unknown", sphere_with_arrays(), {"MaskArray": ["POINTS", "nothing"]}),
            ("text", sphere_with_arrays(), {"MaskArray": ["POINTS", "pair"], "TimeStep": -1.0}),
            ("broken", broken(), {}),
            ("precision", sphere_with_arrays(), {"OutputPrecision": 7}),
        ):
            probe = getattr(servermanager.filters, name)()
            if not set(properties) & set(probe.ListProperties()) and properties:
                continue
            known = {k: v for k, v in properties.items() if k in probe.ListProperties()}
            made, messages = make(name, source, **known)
            made.UpdatePipeline()
            put("faults/%s/%s" % (key, name), messages)


def run_aborts():
    """An update that is aborted gives the input, and the next one the whole result."""
    for name in filter_names():
        source = noisy(simple.LoopSubdivision(Input=sphere_with_arrays(), NumberofSubdivisions=3))
        abort(name, source, "aborts/" + name)
        if name in THREE:
            pieces = partitioned(split(copy_of(dataset(source)), 2))
            abort(name, producer(pieces), "aborts/pieces " + name)


def abort(name, source, key):
    made, messages = make(name, source)
    algorithm = made.SMProxy.GetClientSideObject()
    seen = []

    def stop(_object, _event):
        seen.append(algorithm.GetProgress())
        if len(seen) == 2:
            algorithm.SetAbortExecute(1)

    number = algorithm.AddObserver("ProgressEvent", stop)
    made.UpdatePipeline()
    given = [array for leaf in leaves(dataset(source)) for array in list_arrays(leaf)]
    put(key + "/input", [array.GetName() for leaf in leaves(algorithm.GetOutputDataObject(0))
                         for array in list_arrays(leaf) if array not in given])
    algorithm.RemoveObserver(number)
    algorithm.SetAbortExecute(0)
    algorithm.Modified()
    made.SMProxy.MarkModified(made.SMProxy)
    made.UpdatePipeline()
    put(key + "/seen", len(seen) > 1)
    put(key + "/increases", seen == sorted(seen))
    put(key + "/messages", [event for event, _ in messages])
    describe(made, key)


def list_arrays(data):
    return [data.GetAttributes(kind).GetAbstractArray(a) for kind in (vtkDataObject.POINT, vtkDataObject.CELL)
            for a in range(data.GetAttributes(kind).GetNumberOfArrays())]


begin = time.perf_counter()
simple.LoadPlugin(sys.argv[1], remote=False, ns=globals())
seconds = time.perf_counter() - begin
steps = (list_properties, run_clicks, run_kinds, run_kinds_of_input, run_left_out, run_special_input, run_pieces, run_edits,
         run_times, run_faults, run_aborts)
for step in steps:
    step()
arrays = {key: value for key, value in found.items() if isinstance(value, np.ndarray)}
rest = {key: value for key, value in found.items() if not isinstance(value, np.ndarray)}
np.savez(sys.argv[2], **{"text": np.array(json.dumps({"seconds": seconds, **rest})), **{
    "array %s" % key: value for key, value in arrays.items()}})
