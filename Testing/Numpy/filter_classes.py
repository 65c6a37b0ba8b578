# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The classes for VTK of the functions of arrays, as the proxies of ParaView have them."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import surfacediffusion

PLUGIN = Path(__file__).resolve().parents[2] / "Plugin"
CLASSES = {
    proxy.find("Hints/SurfaceDiffusion").get("function"): proxy.get("class")
    for path in PLUGIN.glob("*Filter.xml") for proxy in ElementTree.parse(path).iter("SourceProxy")}
_MISSING = set(surfacediffusion._functions.__all__) - set(CLASSES)
assert not _MISSING, f"functions have no class: {sorted(_MISSING)}"
