# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause

import pathlib

from spack.package import *


class Surfacediffusion(CMakePackage):
    """VTK filters that solve diffusion equations on triangulated surfaces: smoothing, denoising,
    inpainting, regularisation of normals, and textures."""

    git = "file://" + str(pathlib.Path(__file__).resolve().parents[4])

    license("BSD-3-Clause")

    version("main", branch="main")

    variant(
        "host",
        default="vtk",
        values=("none", "vtk", "paraview"),
        multi=False,
        description="Build for VTK, for ParaView with its plugin, or the core alone",
    )
    variant("python", default=True, description="Build the Python module vtkSurfaceDiffusion")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.22:", type="build")
    depends_on("ninja", type="build")
    depends_on("eigen@3.3:")

    with when("host=vtk"):
        depends_on("vtk@9.1:")
        depends_on("vtk+python", when="+python")
    with when("host=paraview"):
        depends_on("paraview@5.11: +development_files")
        depends_on("paraview+python", when="+python")
    extends("python", when="+python")

    conflicts("+python", when="host=none", msg="The Python module needs VTK: add ~python")

    generator("ninja")

    def cmake_args(self):
        host = {"none": "None", "vtk": "VTK", "paraview": "ParaView"}
        return [
            self.define("SURFACEDIFFUSION_HOST", host[self.spec.variants["host"].value]),
            self.define_from_variant("SURFACEDIFFUSION_WRAP_PYTHON", "python"),
        ]
