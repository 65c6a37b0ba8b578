# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Field data, which belong to no point or cell and which many readers write (TimeValue, CYCLE), are
not offered as data of a filter, and do not enable it."""

import unittest

from paraview import servermanager, simple
from paraview.simple import TrivialProducer
from plugin_testing import add_array, filter_names, menu
from vtkmodules.vtkFiltersSources import vtkSphereSource

# These need an array of the surface; the others work on the surface itself.
NEED_AN_ARRAY = {
    "FVMHeatFilter", "IntrinsicTVFilter", "MumfordShahFilter", "SurfaceDerivativesFilter",
    "SurfaceReliefFilter", "SurfaceSegmentationFilter", "TensorDiffusionFilter",
}


def sphere(with_points=False):
    """A surface with one number, one pair and one vector as field data, and on request with a point
    array."""
    source = vtkSphereSource()
    source.Update()
    data = source.GetOutput()
    data.GetPointData().Initialize()  # no normals
    add_array(data.GetFieldData(), "TimeValue", [0.5])
    add_array(data.GetFieldData(), "pair", [(1.0, 2.0)])
    add_array(data.GetFieldData(), "vector", [(1.0, 2.0, 3.0)])
    if with_points:
        heights = [data.GetPoint(i)[2] for i in range(data.GetNumberOfPoints())]
        add_array(data.GetPointData(), "f", heights)
    producer = TrivialProducer()
    producer.SMProxy.GetClientSideObject().SetOutput(data)
    producer.UpdatePipeline()
    return producer


def is_enabled(name, source):
    """Whether the menu enables the filter for this source."""
    prop = servermanager.ProxyManager().GetPrototypeProxy("filters", name).GetProperty("Input")
    prop.RemoveAllUncheckedProxies()
    prop.AddUncheckedInputConnection(source.SMProxy, 0)
    enabled = prop.IsInDomains() > 0
    prop.RemoveAllUncheckedProxies()
    return enabled


class TestFieldData(unittest.TestCase):
    def test_field_data_alone_do_not_enable_filters_of_data(self):
        found = {name for name in filter_names() if not is_enabled(name, sphere())}
        self.assertEqual(found, NEED_AN_ARRAY)

    def test_a_point_array_beside_field_data_enables_every_filter(self):
        for name in filter_names():
            self.assertTrue(is_enabled(name, sphere(with_points=True)), name)

    def test_menus_list_no_field_data(self):
        source = sphere(with_points=True)
        for name in filter_names():
            filter = getattr(servermanager.filters, name)(Input=source)
            for key in filter.ListProperties():
                if filter.SMProxy.GetProperty(key).FindDomain("vtkSMArrayListDomain"):
                    self.assertLessEqual(menu(filter, key), {"POINTS f"}, (name, key))

    def test_the_data_are_a_point_array_by_default(self):
        source = sphere(with_points=True)
        for name in NEED_AN_ARRAY:
            filter = getattr(simple, name)(source)
            self.assertEqual(list(filter.InputArray), ["POINTS", "f"], name)


if __name__ == "__main__":
    unittest.main()
