# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the plugin gives to ParaView: a class for each filter, with its properties, and its proxies, which
are those of the plugin in C++ with another class."""

from __future__ import annotations

import glob
import os
import re
import xml.etree.ElementTree as ElementTree
from typing import Any, Callable

from paraview.modules.vtkRemotingCore import vtkPVPluginTracker  # type: ignore[import-not-found]

from ._fields import ANY
from ._filters import CLASSES, ModelFilter, RunFilter

_PROXIES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "proxies")
_SHARED = "SurfaceDiffusionAlgorithm.xml"  #: the properties that filters inherit


class _Definition:
    """An object of a plugin's module whose XML ParaView reads."""

    def __init__(self, xml: str) -> None:
        self._pvsm_proxy_xml = xml


def define_filters(module: str) -> dict[str, Any]:
    """Return the objects of the plugin's module: classes and proxies. There are none if the plugin in C++ is
    loaded, whose filters need no Python; if it comes later, it replaces these proxies."""
    if _is_loaded():
        print("SurfaceDiffusionPython: the plugin SurfaceDiffusion is loaded, whose filters stay.")
        return {}
    shared = _read(_SHARED)
    bases = {proxy.get("name"): proxy for proxy in ElementTree.fromstring(shared).iter("SourceProxy")}
    objects: dict[str, Any] = {"_SharedProperties": _Definition(shared)}
    for path in sorted(glob.glob(os.path.join(_PROXIES, "*Filter.xml"))):
        xml = _read(os.path.basename(path))
        (proxy,) = ElementTree.fromstring(xml).iter("SourceProxy")
        name, old = proxy.get("name", ""), proxy.get("class", "")
        xml = xml.replace(f'class="{old}"', f'class="{module}.{old}" si_class="vtkSIPythonSourceProxy"')
        usual = RunFilter if proxy.get("base_proxyname") == "SurfaceFilter" else ModelFilter
        properties = _properties(proxy, bases)
        base = CLASSES.get(name, usual)
        made = type(old, (base,), {
            "__module__": module, "OUTPUTS": base.OUTPUTS[:len(proxy.findall("OutputPort"))],
            **_constants(proxy, properties), **_methods(properties)})
        made._pvsm_proxy_xml = xml  # type: ignore[attr-defined]
        objects[old] = made
        objects[f"_{name}ByClass"] = _Definition(_by_class(name, xml))
    return objects


def _is_loaded() -> bool:
    """Whether the plugin in C++ is there."""
    tracker = vtkPVPluginTracker.GetInstance()
    return any(tracker.GetPluginName(number) == "SurfaceDiffusion" and tracker.GetPluginLoaded(number)
               for number in range(tracker.GetNumberOfPlugins()))


def _read(name: str) -> str:
    with open(os.path.join(_PROXIES, name), encoding="utf-8") as file:
        return file.read()


def _by_class(name: str, xml: str) -> str:
    """The second proxy of a filter, for the function of paraview.simple with the name of its class: see
    CMakeLists.txt of the plugin in C++."""
    xml = re.sub(rf'(<SourceProxy name="{name})("[^>]*label=")[^"]*', rf"\1ByClass\2{name}", xml)
    return re.sub("<ShowInMenu[^>]*>", "<ReaderFactory/>", xml)


def _properties(proxy: Any, bases: dict[str | None, Any]) -> dict[str, Any]:
    """The properties of a proxy, inherited ones first, by name."""
    base = bases.get(proxy.get("base_proxyname"))
    properties = {} if base is None else _properties(base, bases)
    return {**properties, **{each.get("name"): each for each in proxy if each.tag.endswith("Property")}}


def _constants(proxy: Any, properties: dict[str, Any]) -> dict[str, Any]:
    """What a class has from its proxy beside the methods."""
    counts = {domain.get("name"): domain.get("number_of_components", "") for domain in properties["Input"]}
    arrays = {}
    for name, element in properties.items():
        if element.get("command") == "SetInputArrayToProcess":
            count = counts[element.find("ArrayListDomain").get("input_domain_name")]
            arrays[int(element.get("default_values", 0))] = (name, int(count) if count.isdigit() else ANY)
    return {"MODEL": proxy.find("Hints/SurfaceDiffusion").get("function"), "ARRAYS": arrays,
            "RESULT_NAME": properties["ResultArrayName"].get("default_values")}


def _methods(properties: dict[str, Any]) -> dict[str, Callable[..., Any]]:
    """The methods that properties call."""
    methods = {}
    for element in properties.values():
        command = element.get("command", "")
        if element.get("information_only") == "1" and command.startswith("Get"):
            methods[command] = _getter(command[3:], element.tag != "DoubleVectorProperty")
        elif command.startswith("Set") and element.tag.endswith("VectorProperty"):
            if command != "SetInputArrayToProcess":
                methods[command] = _setter(command[3:])
    return methods


def _setter(name: str) -> Callable[..., None]:
    def assign(self: Any, *values: Any) -> None:
        self.assign(name, values)

    return assign


def _getter(name: str, is_integer: bool) -> Callable[..., Any]:
    def find(self: Any) -> Any:
        number = self.find_number(name)
        return int(number) if is_integer else float(number)

    return find
