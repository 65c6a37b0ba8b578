# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Compares each filter of the plugin with its C++ class: names, defaults, entries,
documentation."""

import glob
import os
import unittest
import xml.etree.ElementTree

import surfacediffusion
from paraview import make_name_valid, servermanager, simple
from vtkmodules.vtkCommonExecutionModel import vtkPolyDataAlgorithm

GROUPS = ("Data", "Model", "Time", "Constraints", "Solver")
PLUGIN = os.path.join(os.path.dirname(__file__), "..", "..", "Plugin")
# All arrays have the C++ setter SetInputArrayToProcess(); the clock has none.
NOT_CXX_PROPERTIES = {
    "Input", "InputArray", "MaskArray", "DirectionArray", "FixedArray", "DiffusionRateArray",
    "TimestepValues",
}
# C++ properties that do not apply to a filter although its class inherits them.
NOT_APPLICABLE = {
    "TuringTextureFilter": {
        "AlongDiffusivity", "AcrossDiffusivity", "FidelityWeight", "HoldKnownValues", "InitialFill",
    },
}


def filters():
    """The names of the plugin's filters."""
    for path in sorted(glob.glob(os.path.join(PLUGIN, "*.xml"))):
        for proxy in xml.etree.ElementTree.parse(path).iterfind("ProxyGroup[@name='filters']/*"):
            yield proxy.get("name")


def proxies():
    """Each filter: its name, a new proxy of it with the defaults of the XML, its C++ class."""
    for name in filters():
        yield name, getattr(servermanager.filters, name)(), getattr(surfacediffusion, "vtk" + name)


def properties():
    """Each property of each filter: `Filter.Property`, its name, the property, the C++ class."""
    for name, proxy, cxx in proxies():
        for key in proxy.ListProperties():
            yield "%s.%s" % (name, key), key, proxy.SMProxy.GetProperty(key), cxx


class TestProxies(unittest.TestCase):
    def test_there_are_filters(self):
        self.assertIn("FVMHeatFilter", list(filters()))

    def test_proxy_is_named_like_its_class_and_made_by_paraview_simple(self):
        for name, proxy, cxx in proxies():
            self.assertEqual(proxy.SMProxy.GetVTKClassName(), cxx.__name__)
            self.assertTrue(hasattr(simple, name), name)

    def test_proxy_has_help_and_a_place_in_the_menu(self):
        for name, proxy, _ in proxies():
            text = proxy.SMProxy.GetDocumentation()
            for part in (text.GetShortHelp(), text.GetLongHelp(), text.GetDescription()):
                self.assertGreater(len(part or ""), 20, name)
            menu = proxy.SMProxy.GetHints().FindNestedElementByName("ShowInMenu")
            self.assertEqual(menu.GetAttribute("category"), "Surface Diffusion", name)

    def test_ports_have_names(self):
        for name, proxy, cxx in proxies():
            ports = ["Surface", "History"][: cxx().GetNumberOfOutputPorts()]
            found = [proxy.SMProxy.GetOutputPortName(i) for i in range(len(ports))]
            self.assertEqual(found, ports, name)

    def test_abstract_proxies_are_hidden(self):
        self.assertFalse(hasattr(simple, "SurfaceDiffusionAlgorithm"))
        self.assertFalse(hasattr(simple, "SurfaceDataDiffusionAlgorithm"))

    def test_every_property_is_documented(self):
        for name, _, prop, _ in properties():
            text = prop.GetDocumentation().GetDescription() or ""
            self.assertGreater(len(text.strip()), 20, name)

    def test_labels_give_python_the_same_names(self):
        for name, key, prop, _ in properties():
            if not prop.GetInformationOnly():
                self.assertEqual(make_name_valid(prop.GetXMLLabel()), key, name)

    def test_every_property_is_one_of_cxx_with_the_same_default(self):
        for name, key, prop, cxx in properties():
            if key in NOT_CXX_PROPERTIES:
                continue
            default = getattr(cxx(), "Get" + key)()
            if prop.GetInformationOnly():
                self.assertEqual(prop.GetCommand(), "Get" + key, name)
            else:
                self.assertEqual(prop.GetCommand(), "Set" + key, name)
                found = tuple(prop.GetElement(i) for i in range(prop.GetNumberOfElements()))
                self.assertEqual(found if len(found) > 1 else found[0], default, name)

    def test_every_property_of_cxx_is_one_of_paraview(self):
        for name, proxy, cxx in proxies():
            setters = {
                method[len("Set"):]
                for method in set(dir(cxx)) - set(dir(vtkPolyDataAlgorithm))
                if method.startswith("Set")
            }
            words = {m for m in setters if any(m.startswith(s + "To") for s in setters)}
            missing = setters - words - set(proxy.ListProperties()) - {"Controller"}  # not a value
            self.assertEqual(missing, NOT_APPLICABLE.get(name, set()), name)

    def test_entries_of_enums_are_the_words_of_cxx(self):
        enums = set()
        for name, key, prop, cxx in properties():
            domain = prop.FindDomain("vtkSMEnumerationDomain")
            if domain is None:
                continue
            enums.add(key)
            for i in range(domain.GetNumberOfEntries()):
                instance = cxx()
                getattr(instance, "Set%sTo%s" % (key, domain.GetEntryText(i)))()
                value = getattr(instance, "Get" + key)()
                self.assertEqual(value, domain.GetEntryValue(i), name)
            if key != "TimeIntegrator":  # classes have different integrators
                words = [method for method in dir(cxx) if method.startswith("Set%sTo" % key)]
                self.assertEqual(len(words), domain.GetNumberOfEntries(), name)
        self.assertLessEqual({"Units", "MaskMode", "Solver", "Mode", "TimeIntegrator"}, enums)

    def test_every_visible_property_is_in_one_group(self):
        for name, proxy, _ in proxies():
            grouped = []
            for i in range(proxy.SMProxy.GetNumberOfPropertyGroups()):
                group = proxy.SMProxy.GetPropertyGroup(i)
                self.assertIn(group.GetXMLLabel(), GROUPS, name)
                for k in range(group.GetNumberOfProperties()):
                    grouped.append(group.GetProperty(k).GetXMLName())
            shown = [
                key for key in proxy.ListProperties()
                if key != "Input" and not proxy.SMProxy.GetProperty(key).GetInformationOnly()
            ]
            self.assertEqual(sorted(grouped), sorted(shown), name)


if __name__ == "__main__":
    unittest.main()
