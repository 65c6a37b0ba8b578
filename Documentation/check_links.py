# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that what the pages of a site refer to is there: check_links.py FOLDER. Addresses of other
sites are not followed. The reference of the headers, which Doxygen checks, is only a target."""
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """The links and the anchors of a page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src") and value:
                self.links.append(value)
            if name in ("id", "name") and value:
                self.anchors.add(value)


def main():
    root = Path(sys.argv[1]).resolve()
    pages = {path: Page(path) for path in sorted(root.rglob("*.html"))
             if not {"cpp", "scenes", "_static"} & set(path.relative_to(root).parts)}
    problems, count = [], 0
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            count += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.is_file():
                problems.append(f"{path.relative_to(root)}: {link}: no such file")
            elif parts.fragment and target in pages and unquote(
                    parts.fragment) not in pages[target].anchors:
                problems.append(f"{path.relative_to(root)}: {link}: no such anchor")
    for problem in problems:
        print(problem)
    print(f"{len(pages)} pages, {count} links, {len(problems)} broken")
    sys.exit(bool(problems) or not pages)


if __name__ == "__main__":
    main()
