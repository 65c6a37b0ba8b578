# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The filters as functions on PyVista's meshes: each takes a mesh and gives a new one back.

    from surfacediffusion.pyvista import heat

    smooth = heat(mesh, "thickness", FWHM=10)  # adds the point array "thicknessDiffused"

A mesh is a pyvista.PolyData, or a pyvista.MultiBlock of such. Arrays are given by name. Keywords in
capitals are the properties of the filter's class, whose help tells formula, units and defaults;
modes are given by their word: Mode="SteadyState". What the filter refuses is a ValueError.
"""

import pyvista
from vtkmodules.vtkCommonDataModel import vtkDataObject

from . import (
    vtkFVMHeatFilter, vtkHarmonicMapFilter, vtkIntrinsicTVFilter, vtkSurfaceDirectionFieldFilter,
    vtkTuringTextureFilter,
)

_POINTS = vtkDataObject.FIELD_ASSOCIATION_POINTS
_CELLS = vtkDataObject.FIELD_ASSOCIATION_CELLS


def heat(mesh, array=None, *, mask=None, direction=None, fixed=None, **properties):
    """Smooth, denoise or inpaint a point array by linear diffusion: vtkFVMHeatFilter.

    array: the data, by default the active scalars; mask: point array, nonzero is missing;
    direction: point or cell array to diffuse along; fixed: point array, nonzero stays.
    The result is the point array <array>Diffused.
    """
    return _run(vtkFVMHeatFilter(), mesh, properties, array, mask, direction, fixed)


def intrinsic_tv(mesh, array=None, *, mask=None, direction=None, fixed=None, **properties):
    """Denoise or inpaint a point array and keep its edges: vtkIntrinsicTVFilter.

    The arguments are those of heat(). The result is the point array <array>TV.
    """
    return _run(vtkIntrinsicTVFilter(), mesh, properties, array, mask, direction, fixed)


def harmonic_map(mesh, array=None, *, mask=None, direction=None, fixed=None, **properties):
    """Regularise normals or other unit vectors, or denoise the mesh: vtkHarmonicMapFilter.

    array: the vectors, by default the normals, computed where there are none; the other arguments
    are those of heat(). MoveVertices=True moves the points to fit the normals. The result is the
    point array <array>Harmonic.
    """
    return _run(vtkHarmonicMapFilter(), mesh, properties, array, mask, direction, fixed)


def turing_texture(
    mesh, initial=None, *, mask=None, direction=None, fixed=None, rates=None, **properties
):
    """Grow a texture on the mesh by reaction and diffusion: vtkTuringTextureFilter.

    initial: point array of two components to start from in place of noise; rates: cell array of
    four components in place of the four diffusion rates; the other arguments are those of heat().
    The result is the point arrays u1, u2 and Texture.
    """
    return _run(
        vtkTuringTextureFilter(), mesh, properties, initial, mask, direction, fixed, rates)


def direction_field(mesh, hints=None, **properties):
    """Make directions on the mesh, the cell array Direction: vtkSurfaceDirectionFieldFilter.

    hints: point or cell array of directions to follow, with Method="Hints".
    """
    return _run(vtkSurfaceDirectionFieldFilter(), mesh, properties, None, None, hints)


def _run(algorithm, mesh, properties, *arrays):
    """The output for these properties and input arrays, which stand in the order of their index."""
    for index, name in enumerate(arrays):
        if name is not None:
            algorithm.SetInputArrayToProcess(index, 0, 0, _association(mesh, index, name), name)
    for name, value in properties.items():
        _set(algorithm, name, value)
    errors = []

    def remember(_object, _event, text):
        errors.append(text)

    remember.CallDataType = "string0"
    algorithm.AddObserver("ErrorEvent", remember)
    algorithm.SetInputDataObject(mesh)
    algorithm.Update()
    if errors:
        raise ValueError(errors[0].strip())
    return pyvista.wrap(algorithm.GetOutputDataObject(0))


def _association(mesh, index, name):
    """Directions may be on points or cells, rates are on cells, all else is on points."""
    block = mesh
    while isinstance(block, pyvista.MultiBlock):
        block = block[0]
    on_cells = index == 4 or (index == 2 and name not in block.point_data)
    return _CELLS if on_cells else _POINTS


def _set(algorithm, name, value):
    setter = f"Set{name}To{value}" if isinstance(value, str) else f"Set{name}"
    if hasattr(algorithm, setter):
        getattr(algorithm, setter)(*([] if isinstance(value, str) else [value]))
    elif isinstance(value, str) and hasattr(algorithm, f"Set{name}") and name.endswith("Name"):
        getattr(algorithm, f"Set{name}")(value)
    else:
        raise TypeError(f"{algorithm.GetClassName()} has no property {name} that can be {value!r}")
