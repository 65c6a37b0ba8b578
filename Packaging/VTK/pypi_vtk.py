# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Dependencies of the wheel (a plugin of scikit-build-core, see pyproject.toml). With
SURFACEDIFFUSION_PYPI_VTK=X.Y in the environment the wheel is built with Kitware's vtk-sdk X.Y and
needs vtk X.Y, because classes of another minor version crash. Otherwise it is built for the VTK of
this machine, which pip does not know."""

import os


def _version():
    version = os.environ.get("SURFACEDIFFUSION_PYPI_VTK", "")
    if version and len(version.split(".")) != 2:
        raise ValueError("SURFACEDIFFUSION_PYPI_VTK is %r; allowed: X.Y, such as 9.7" % version)
    return version


def dynamic_metadata(field, settings=None):
    if field != "dependencies" or settings:
        raise ValueError("only dependencies, without settings")
    return ["vtk==%s.*" % _version()] if _version() else []


def get_requires_for_dynamic_metadata(settings=None):
    return ["vtk-sdk==%s.*" % _version()] if _version() else []
