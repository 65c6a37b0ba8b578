# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""README.md for the page of a package index, which has no other files of the repository (a plugin of
scikit-build-core, see pyproject.toml). With the setting `address`, the address of the repository as
shown by its host, pictures and links get absolute addresses there. Without it pictures are left out,
and links to files become their text."""

import re
from pathlib import Path

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


def dynamic_metadata(field, settings=None):
    settings = dict(settings or {})
    address = settings.pop("address", "")
    if field != "readme" or settings:
        raise ValueError("only readme, with the setting address")
    return {"content-type": "text/markdown",
            "text": readme_for_index(Path("README.md").read_text(encoding="utf-8"), address)}
