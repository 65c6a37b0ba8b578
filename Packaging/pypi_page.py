# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The page of a package index, which has no other files of the repository: README.md and the links
beside it (a plugin of scikit-build-core, see pyproject.toml). With `address` of tool.surfacediffusion,
the address of the repository as shown by its host, pictures and links get absolute addresses there.
Without it pictures are left out, links to files become their text, and there are no links beside it."""

import re
from pathlib import Path

try:
    import tomllib
except ImportError:  # Python before 3.11, where scikit-build-core needs tomli
    import tomli as tomllib

# ![text](target) or [text](target), where the target is no address and no heading of this page
_LINK = re.compile(r"(!?)\[([^\[\]]*)\]\((?!\w+:|#)([^()\s]+)\)")


def readme_for_index(text, address):
    """The text of README.md, whose links are relative to the root of the repository."""
    def replace(match):
        picture, name, target = match.groups()
        if address:
            folder = "raw" if picture else "blob"
            return f"{picture}[{name}]({address.rstrip('/')}/{folder}/main/{target})"
        return "" if picture else name

    return re.sub(r"\n{3,}", "\n\n", _LINK.sub(replace, text))


def urls_for_index(address):
    """The links beside the page."""
    address = address.rstrip("/")
    return {"Repository": address, "Changelog": f"{address}/blob/main/CHANGELOG.md",
            "Issues": f"{address}/issues"} if address else {}


def dynamic_metadata(field, settings=None):
    if settings:
        raise ValueError("no settings: the address is that of tool.surfacediffusion")
    root = Path(__file__).resolve().parent.parent  # also for Packaging/VTK
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))
    address = project["tool"]["surfacediffusion"]["address"]
    if field == "urls":
        return urls_for_index(address)
    if field == "readme":
        return {"content-type": "text/markdown",
                "text": readme_for_index((root / "README.md").read_text(encoding="utf-8"), address)}
    raise ValueError(f"{field}; allowed: readme or urls")
