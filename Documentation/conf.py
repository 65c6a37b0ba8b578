# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Sphinx: see build.sh."""
import os

import pyvista

pyvista.OFF_SCREEN = True
pyvista.BUILDING_GALLERY = True
os.environ.setdefault("PYVISTA_BUILDING_GALLERY", "true")

project = "SurfaceDiffusion"
copyright = "SurfaceDiffusion contributors"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_gallery.gen_gallery"]
myst_heading_anchors = 3
exclude_patterns = ["tutorials"]
html_theme = "furo"
html_title = "SurfaceDiffusion"
html_extra_path = ["extra"]
html_copy_source = False
autodoc_typehints = "none"
napoleon_use_rtype = False
napoleon_use_ivar = True
nitpicky = True
default_role = "py:obj"  # links to what the pages have, code for all else
# Types in docstrings are words ("array_like", those of choices); these end in names of classes.
nitpick_ignore_regex = [("py:class", r"(?!\S*(Result|States|Surface|Estimate|Modes|Sources|Data|Part|File)$).*"),
                        ("py:obj", ".*")]
suppress_warnings = ["config.cache"]
sphinx_gallery_conf = {
    "examples_dirs": "tutorials",
    "gallery_dirs": "gallery",
    "filename_pattern": r"/\w+\.py",
    "image_scrapers": ("pyvista",),
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_signature": False,
    "within_subsection_order": "FileNameSortKey",
    "reset_argv": lambda conf, variables: [],
}


def escape_bars(app, what, name, obj, options, lines):
    """Bars are absolute values in the docstrings, and substitutions for Sphinx."""
    lines[:] = [line.replace("|", "\\|") for line in lines]


def setup(app):
    app.connect("autodoc-process-docstring", escape_bars, priority=900)
