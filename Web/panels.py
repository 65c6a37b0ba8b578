# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes what the page asks for at first sight: panels.py PLUGIN OUTPUT.js.

The panels of the plugin say which settings come first, which are advanced, what their labels are, and
which arrays there are. The page has the same, from the same XML; names, ranges, help and conditions come
from the settings' declarations.
"""
import json
import sys
from pathlib import Path
from xml.etree import ElementTree


def proxies_of(folder):
    for path in sorted(Path(folder).glob("*.xml")):
        yield from ElementTree.parse(path).getroot().iter("SourceProxy")


def entries_of(proxy, proxies):
    """Settings and arrays in the order of the panel: inherited ones first."""
    entries = {}
    if proxy.get("base_proxyname") in proxies:
        entries.update(entries_of(proxies[proxy.get("base_proxyname")], proxies))
    for element in proxy.iter():
        if element.tag in ("Setting", "Array"):
            entry = {"advanced": element.get("panel_visibility") == "advanced"}
            if element.get("label"):
                entry["label"] = element.get("label")
            if element.tag == "Array":
                entry["onlyIf"] = element.get("when", "")
                entry["help"] = " ".join((element.text or "").split())
            entries.pop(element.get("name"), None)
            entries[element.get("name")] = entry
    return entries


def main():
    proxies = {proxy.get("name"): proxy for proxy in proxies_of(sys.argv[1])}
    panels = {}
    for proxy in proxies.values():
        hint = proxy.find("Hints/SurfaceDiffusion")
        if hint is not None:
            panels[hint.get("function")] = {
                "title": proxy.get("label"),
                "help": proxy.find("Documentation").get("short_help"),
                "entries": entries_of(proxy, proxies)}
    Path(sys.argv[2]).write_text(
        f'"use strict";\n// Made by panels.py from the panels of the plugin.\nconst PANELS = '
        f'{json.dumps(panels, indent=1)};\n')


if __name__ == "__main__":
    main()
