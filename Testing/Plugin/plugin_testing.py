# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Functions that the tests of the plugin share: the list of its filters, a surface in a file, the
errors of a filter, and the comparison of pictures."""

import glob
import math
import os
import random
import xml.etree.ElementTree

import numpy as np
from paraview import servermanager
from paraview.simple import Calculator, SaveScreenshot, XMLPolyDataReader
from paraview.vtk import vtkDoubleArray, vtkStringArray, vtkUnsignedCharArray
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSetAttributes
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkImagingCore import vtkImageDifference
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

GARBAGE = 1000.0  # the damaged values
PLUGIN = os.path.join(os.path.dirname(__file__), "..", "..", "Plugin")


def filter_names():
    """The names of all filters of the plugin: those that its XML files define."""
    return [
        proxy.get("name")
        for path in sorted(glob.glob(os.path.join(PLUGIN, "*.xml")))
        for proxy in xml.etree.ElementTree.parse(path).iterfind("ProxyGroup[@name='filters']/*")]


def add_array(attributes, name, values, array=None):
    """Adds values, numbers or tuples of numbers, as an array."""
    array = array or vtkDoubleArray()
    array.SetName(name)
    tuples = [value if isinstance(value, tuple) else (value,) for value in values]
    array.SetNumberOfComponents(len(tuples[0]))
    array.SetNumberOfTuples(len(tuples))
    for i, value in enumerate(tuples):
        array.SetTuple(i, value)
    attributes.AddArray(array)
    return array


def write_sphere(path, centre=(0.0, 0.0, 0.0), roughness=0.0):
    """A sphere of radius 1 with arrays, among them the smooth `clean` and `noisy`, its noisy
    copy. Its points are moved along the normals by at most the roughness."""
    source = vtkSphereSource()
    source.SetRadius(1.0)
    source.SetThetaResolution(64)
    source.SetPhiResolution(64)
    source.SetCenter(*centre)
    source.Update()
    sphere = source.GetOutput()
    points = [
        tuple(x - c for x, c in zip(sphere.GetPoint(i), centre))
        for i in range(sphere.GetNumberOfPoints())
    ]
    data = sphere.GetPointData()
    noise = random.Random(1)
    clean = [z for _, _, z in points]
    noisy = [value + noise.uniform(-0.3, 0.3) for value in clean]
    hole = [int(x > 0.8) for x, _, _ in points]
    add_array(data, "clean", clean)
    data.SetScalars(add_array(data, "noisy", noisy))
    add_array(data, "damaged", [GARBAGE if h else v for v, h in zip(noisy, hole)])
    add_array(data, "hole", hole, vtkUnsignedCharArray())
    add_array(data, "poles", [int(abs(z) > 0.95) for _, _, z in points], vtkUnsignedCharArray())
    add_array(data, "east", [(-y, x, 0.0) for x, y, _ in points])
    add_array(data, "pair", [(x, y) for x, y, _ in points])
    names = vtkStringArray()
    names.SetName("names")
    for _ in points:
        names.InsertNextValue("point")
    data.AddArray(names)
    for i, point in enumerate(points):
        radius = 1.0 + roughness * noise.uniform(-1.0, 1.0)
        sphere.GetPoints().SetPoint(i, *(c + radius * x for x, c in zip(point, centre)))
    add_array(sphere.GetCellData(), "up", [(0.0, 0.0, 1.0)] * sphere.GetNumberOfCells())
    add_array(sphere.GetCellData(), "odd", [c % 2 for c in range(sphere.GetNumberOfCells())])
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(sphere)
    writer.SetDataModeToBinary()  # some versions of expat cannot read appended data
    assert writer.Write()


def read_sphere(path, **arguments):
    """An updated reader of such a sphere, as after Apply."""
    write_sphere(path, **arguments)
    reader = XMLPolyDataReader(FileName=[path])
    reader.UpdatePipeline()
    return reader


def values(source, name, port=0):
    """The values of a point array, or of a table's column, as a list of floats."""
    output = servermanager.Fetch(source, idx=port)
    kind = vtkDataObject.ROW if output.IsA("vtkTable") else vtkDataObject.POINT
    array = output.GetAttributes(kind).GetArray(name)
    if array is None:
        return None
    return [array.GetComponent(i, 0) for i in range(array.GetNumberOfTuples())]


def outputs(source):
    """All numbers of the outputs of a source: coordinates and arrays, by port, place and name. Left
    out are the seconds in a history, which differ between runs, and arrays without values, which
    servers do not send."""
    found = {}
    for port in range(source.SMProxy.GetNumberOfOutputPorts()):
        data = servermanager.Fetch(source, idx=port)
        if data.IsA("vtkPointSet") and data.GetNumberOfPoints():
            found[port, "POINTS", "coordinates"] = vtk_to_numpy(data.GetPoints().GetData()).copy()
        for place, kind in (
            ("POINTS", vtkDataObject.POINT), ("CELLS", vtkDataObject.CELL), ("ROWS", vtkDataObject.ROW),
        ):
            attributes = data.GetAttributes(kind)
            for i in range(attributes.GetNumberOfArrays() if attributes else 0):
                array = attributes.GetArray(i)  # None for texts
                timing = array and (place, array.GetName()) == ("ROWS", "Seconds")
                if array and array.GetNumberOfTuples() and not timing:
                    found[port, place, array.GetName()] = vtk_to_numpy(array).copy()
    return found


def results(source):
    """What a filter has changed or added: those of its outputs that its input does not have."""
    before = outputs(source.Input)
    found = {
        key: numbers for key, numbers in outputs(source).items()
        if key not in before or not np.array_equal(before[key], numbers, equal_nan=True)
    }
    assert any(port == 0 for port, _, _ in found), "no result of %s" % source.SMProxy.GetXMLName()
    return found


def differences(found, expected):
    """The names of the numbers that differ between two dictionaries from outputs() or results()."""
    return [
        key for key in sorted(set(found) | set(expected))
        if key not in found or key not in expected
        or not np.array_equal(found[key], expected[key], equal_nan=True)
    ]


NOISE = "sin(1e4*coordsX + 2.3e4*coordsY + 3.7e4*coordsZ)"


def noisy(source):
    """The source with noise on its points, and with two regions as noisy data f."""
    rough = Calculator(source, Function="coords*(1 + 0.02*%s)" % NOISE, CoordinateResults=1)
    regions = "if(coordsX*coordsZ > 0, 1, 0) + 0.5*%s" % NOISE
    return Calculator(rough, Function=regions, ResultArrayName="f")


def menu(source, name):
    """The entries of a menu of arrays: association and name of each."""
    domain = source.SMProxy.GetProperty(name).FindDomain("vtkSMArrayListDomain")
    names = [domain.GetString(i) for i in range(domain.GetNumberOfStrings())]
    return {
        ("POINTS", "CELLS")[domain.GetFieldAssociation(i)] + " " + text
        for i, text in enumerate(names) if text
    }


def root_mean_square(a, b):
    """The root mean square difference of two lists."""
    return math.sqrt(sum((x - y) ** 2 for x, y in zip(a, b)) / len(a))


def errors_of(source):
    """A list that collects the errors of a filter from now on instead of printing them."""
    errors = []

    @calldata_type(VTK_STRING)
    def remember(_object, _event, text):
        errors.append(text)

    source.GetClientSideObject().AddObserver("ErrorEvent", remember)
    return errors


# The largest error of equal pictures, in fully different pixels; see Testing/Filters/ImageTest.h.
PICTURE_TOLERANCE = 10.0


def picture_error(view, baseline, written=None):
    """The difference of the view's picture from the baseline, in fully different pixels, by the
    strict comparison of ImageTest.h: no shifts, no averages. The picture is kept as `written`."""
    folder = os.environ["SURFACEDIFFUSION_OUTPUT_DIR"]
    path = os.path.join(folder, (written or baseline) + ".png")
    SaveScreenshot(path, view, ImageResolution=[300, 300], OverrideColorPalette="WhiteBackground")
    images = []
    for each in (path, os.path.join(os.environ["SURFACEDIFFUSION_BASELINE_DIR"], baseline + ".png")):
        assert os.path.exists(each), "no picture %s; obtained: %s" % (each, path)
        reader = vtkPNGReader()
        reader.SetFileName(each)
        reader.Update()
        images.append(reader)
    difference = vtkImageDifference()
    difference.SetInputConnection(images[0].GetOutputPort())
    difference.SetImageConnection(images[1].GetOutputPort())
    difference.AllowShiftOff()
    difference.AveragingOff()
    difference.SetThreshold(16)
    difference.Update()
    error = difference.GetThresholdedError()
    os.write(1, ("%s: difference %g\n" % (path, error)).encode())
    return error


def assert_looks_like(view, baseline):
    """Asserts that the picture of the view equals the baseline."""
    error = picture_error(view, baseline)
    assert error <= PICTURE_TOLERANCE, "%s differs from its baseline by %g pixels" % (baseline, error)


def assert_looks_unlike(view, baseline):
    """Asserts that the picture differs from the baseline: a negative twin, which shows something
    slightly wrong."""
    error = picture_error(view, baseline, written=baseline + "Slipped")
    assert error > PICTURE_TOLERANCE, "%s does not show the change: %g pixels" % (baseline, error)
