# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The surfaces of PyVista meshes."""

from __future__ import annotations

from typing import Any, Iterator

import pyvista


def find_polydata(mesh: Any) -> Iterator[pyvista.PolyData]:
    """The mesh, or the blocks of a MultiBlock at any depth, without those that are None. TypeError
    with the remedy if there is anything other than a surface."""
    if isinstance(mesh, pyvista.MultiBlock):
        for block in mesh:
            if block is not None:
                yield from find_polydata(block)
    elif isinstance(mesh, pyvista.PolyData):
        yield mesh
    else:
        remedy = "; mesh.extract_surface() gives its surface" if hasattr(
            mesh, "extract_surface") else ""
        raise TypeError(f"the mesh is a {type(mesh).__name__}; allowed: pyvista.PolyData, or a "
                        f"pyvista.MultiBlock of it{remedy}")
