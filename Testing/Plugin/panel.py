# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the panel of a filter offers, and clicks on it."""

import numpy as np
from paraview import servermanager
from paraview.modules.vtkRemotingServerManager import vtkSMOrderedPropertyIterator
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersSources import vtkSphereSource


def holds(proxy, element):
    """Whether a decorator of the panel, or a combination of some, lets its property be edited."""
    children = [element.GetNestedElement(i) for i in range(element.GetNumberOfNestedElements())]
    if element.GetName() == "Expression":
        return (all if element.GetAttribute("type") == "and" else any)(
            holds(proxy, child) for child in children)
    if element.GetAttribute("type") == "CompositeDecorator":
        return all(holds(proxy, child) for child in children)
    other = proxy.SMProxy.GetProperty(element.GetAttribute("property"))
    if other is None:
        return True  # a property that this filter does not have
    value = other.GetElement(int(element.GetAttribute("index") or 0)) or 0
    wanted = element.GetAttribute("value")
    equal = (value or "") == wanted if isinstance(value, str) or not wanted else (
        float(value) == float(wanted))
    if value == 0 and not wanted:
        equal = True  # no array
    return equal != (element.GetAttribute("inverse") == "1")


def offered(proxy):
    """The properties that the panel lets the user edit now, in its order."""
    iterator = vtkSMOrderedPropertyIterator()
    iterator.SetProxy(proxy.SMProxy)
    iterator.Begin()
    while not iterator.IsAtEnd():
        prop = iterator.GetProperty()
        hints = prop.GetHints()
        decorators = [] if hints is None else [
            hints.GetNestedElement(n) for n in range(hints.GetNumberOfNestedElements())]
        shown = not prop.GetInformationOnly() and prop.GetPanelVisibility() != "never"
        if not prop.IsA("vtkSMInputProperty") and shown and all(
                holds(proxy, element) for element in decorators
                if element.GetName() == "PropertyWidgetDecorator"):
            yield iterator.GetKey()
        iterator.Next()


def is_advanced(proxy, key):
    return proxy.SMProxy.GetProperty(key).GetPanelVisibility() == "advanced"


# What a user may type or select. Switches and menus are clicked without a list.
VALUES = {
    "FWHM": (0.0, 0.4), "FidelityWeight": (0.0, 2.0), "AlongDiffusivity": (1.0, 0.5),
    "AcrossDiffusivity": (1.0, 0.2), "NoiseLevel": (0.0, 0.1), "FeatureSize": (0.0, 0.5),
    "DiffusionRateAcross1": (-1.0, 3.0), "DiffusionRateAcross2": (-1.0, 3.0),
    "TimeStep": (0.02, 0.05), "Exponent": (1.0, 2.0), "OutputInterval": (1, 2),
    "MaskArray": (["POINTS", "hole"], ["CELLS", "spots"]),
    "FixedArray": (["POINTS", "ends"], ["CELLS", "spots"]),
    "DirectionArray": (["CELLS", "up"], ["POINTS", "east"]), "SmoothingLength": (0.2, 0.5),
    "DiffusionRateArray": (["CELLS", "rates"],), "FidelityArray": (["POINTS", "weight"],),
    "BlurFWHM": (0.0, 0.3), "SpeedArray": (["POINTS", "weight"], ["CELLS", "speed"], ["POINTS", ""]),
    "AlongSpeedArray": (["CELLS", "speed"], ["POINTS", ""]), "AcrossSpeedArray": (["POINTS", "weight"], ["POINTS", ""]),
    "SourceTimes": (["POINTS", "f"],), "SlopeErrorArray": (["POINTS", "weight"], ["POINTS", ""]),
}


def click(filter, dice, clicked):
    """Changes one property that the panel offers; appends it to `clicked`."""
    # ColorModel and VectorType need data of three components.
    keys = [key for key in offered(filter) if key not in ("Kinetics", "ColorModel", "VectorType")]
    key = dice.choice(keys)
    prop = filter.SMProxy.GetProperty(key)
    entries = prop.FindDomain("vtkSMEnumerationDomain")
    if key in VALUES:
        value = dice.choice(VALUES[key])
    elif entries is not None:
        value = entries.GetEntryText(dice.randrange(entries.GetNumberOfEntries()))
    elif prop.FindDomain("vtkSMBooleanDomain") is not None:
        value = dice.randrange(2)
    else:
        return
    setattr(filter, key, value)
    clicked.append((key, value))


def sphere_with_arrays():
    sphere = vtkSphereSource()
    sphere.SetThetaResolution(12)
    sphere.SetPhiResolution(9)
    sphere.Update()
    data = sphere.GetOutput()
    points = vtk_to_numpy(data.GetPoints().GetData())
    cells = data.GetNumberOfCells()

    def add(attributes, name, values):
        array = numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True)
        array.SetName(name)
        attributes.AddArray(array)

    add(data.GetPointData(), "f", points[:, 2] + 0.1 * np.cos(50 * points[:, 0]))
    add(data.GetPointData(), "hole", points[:, 0] > 0.3)
    add(data.GetPointData(), "ends", points[:, 2] < -0.4)
    add(data.GetPointData(), "pair", points[:, :2])
    add(data.GetPointData(), "weight", 1.0 + points[:, 1] ** 2)
    add(data.GetPointData(), "east", np.tile([1.0, 0.0, 0.0], (len(points), 1)))
    add(data.GetCellData(), "g", np.cos(np.arange(cells)))
    add(data.GetCellData(), "spots", np.arange(cells) % 7 == 0)
    add(data.GetCellData(), "speed", 1 + np.arange(cells) % 2)  # no barriers, which may hold all sources
    add(data.GetCellData(), "up", np.tile([0.0, 0.0, 1.0], (cells, 1)))
    add(data.GetCellData(), "rates", np.tile([21.0, 21.0, 2.6, 2.6], (cells, 1)))
    source = servermanager.sources.TrivialProducer()
    source.SMProxy.GetClientSideObject().SetOutput(data)
    return source
