# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The documentation of a property in ParaView is that of the setting, from which the documentation
of keywords is made, too. Sentences about ParaView may follow."""

import unittest
import xml.etree.ElementTree as ElementTree

from filter_classes import CLASSES, PLUGIN
from surfacediffusion import _core

PROXIES = {function: name[len("vtk"):] for function, name in CLASSES.items()}

#: Settings of all models that mean something else in a filter, whose proxy says what.
OTHERWISE = {"TuringTextureFilter": {"NumberOfTimeSteps"}}


def one_line(text):
    return " ".join(text.split())


def read_proxies():
    """The documentation of the properties of each proxy, with those of its base."""
    bases, own = {}, {}
    for path in PLUGIN.glob("*.xml"):
        for proxy in ElementTree.parse(path).iter():
            if proxy.tag in ("Proxy", "SourceProxy"):
                name = proxy.get("name")
                bases[name] = proxy.get("base_proxyname")
                own[name] = {
                    child.get("name"): one_line(child.find("Documentation").text)
                    for child in proxy
                    if child.get("name") and child.find("Documentation") is not None}

    def collect(name):
        return {**collect(bases[name]), **own[name]} if name in own else {}
    return {name: collect(name) for name in own}


class Texts(unittest.TestCase):
    def test_of_properties_are_those_of_settings(self):
        proxies = read_proxies()
        for function, proxy in PROXIES.items():
            different = set()
            for setting in _core.list_settings(function):
                name, text = setting["name"], one_line(setting["documentation"])
                if name == "Means":
                    continue  # a list with places in ParaView
                with self.subTest(proxy=proxy, property=name):
                    shown = proxies[proxy][name]
                    if name not in OTHERWISE.get(proxy, ()):
                        self.assertEqual(shown[:len(text)], text)
                    elif not shown.startswith(text):
                        different.add(name)
                    self.assertRegex(text, r"^\S.*[.)]$")
            self.assertEqual(different, OTHERWISE.get(proxy, set()), proxy)


if __name__ == "__main__":
    unittest.main()
