# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Diffusion equations on triangulated surfaces, for numpy arrays::

    from surfacediffusion import Surface, heat

    surface = Surface(points, faces)             # (n, 3) coordinates, (m, 3) rows of points
    smooth = heat(surface, thickness, fwhm=10)   # in the unit of the coordinates

===================== ============================================================================
`heat`                smoothing, denoising and inpainting by linear diffusion
`intrinsic_tv`        denoising and inpainting that preserves edges
`harmonic_map`        regularised normals and unit vectors, and denoised points
`denoise_mesh`        points without noise, sharp edges kept
`mumford_shah`        edges as curves, and data that are smooth between them
`tensor_diffusion`    smoothing along the edges or the lines of the data
`segment`             regions with short boundaries
`interpolate`         smooth functions through values at a few points, with their standard error
`turing_texture`      textures by reaction and diffusion
`direction_field`     line fields: principal curvature, the smoothest one, from hints
`curvature`           mean, Gaussian and principal curvatures at a scale
`derivatives`         gradients, divergences, curls, Laplacians and velocities of waves
`gradient`            tangential gradients of data
`divergence`          divergences of vectors
`curl`                curls of vectors about the normals
`laplacian`           Laplacians of data
`conduction_velocity` velocities of waves from arrival times
`helmholtz`           gradient, curl and harmonic parts of vectors
`estimate_fwhm`       the smoothness of noise maps
`smooth_to_fwhm`      smoothing up to a given smoothness
`smooth_img`          smoothing of surface images of nilearn
`estimate_fwhm_img`   the smoothness of their noise
`distance`            distances along the surface, arrival times of fronts
`nearest_sources`     the same with the source that is nearest
`distances`           distances between points up to a cutoff, for scipy
`geodesic_path`       the shortest path between two places
`path_through`        shortest paths through several places, as cuts and rims
`geodesic_disk`       the area and the boundary of what is within a distance
`mass_matrix`         areas of the points' control cells, for scipy
`stiffness_matrix`    cotangent Laplacian, or that of tensors, for scipy
`gradient_matrix`     gradients on the triangles, for scipy
`eigenmodes`          eigenvalues and modes of the surface
`random_field`        Gaussian random fields of a width or a range
`surrogates`          random maps with the values and the smoothness of a map
`scale_filter`        data without the scales below a wavelength
`spectrum`            the variance of data between scales
`resample`            values from sphere to sphere, by the weights of a `Resampler`
`refine`              shorter edges, for the large triangles of CAD files
`relief`              values as relief, for printing
`weld`                one point per place, T-junctions joined, repeated facets once
`bodies`              the solids of a surface, and whether it is closed, manifold and oriented
`on_faces`            where arrays are if there are as many points as faces; `on_points` alike
===================== ============================================================================

A function that finds one array returns it. `harmonic_map`, `denoise_mesh`, `mumford_shah`, `segment`,
`interpolate`, `turing_texture` and `curvature` find more, and return an :class:`ArrayResult`, which stands
for its main array wherever numpy takes one. The functions of time have their states, with times, energies
and totals, in `heat_steps`, `intrinsic_tv_steps`, `tensor_diffusion_steps`, `mumford_shah_steps`,
`harmonic_map_steps` and `turing_texture_steps`, whose ``last()`` is the result.

Keywords are the properties of the filters for VTK and ParaView in snake_case. The results have the same
bits. The classes of VTK are in a module of their own, ``vtkSurfaceDiffusion``, which may be installed
beside this package.
"""

import importlib as _importlib
import os as _os
import typing as _typing
import warnings as _warnings
from importlib.metadata import version as _version

from . import (
    _core, _derivatives, _distance, _fields, _functions, _operators, _paths, _resampling, _result, _scales, _solids,
    _steps, _surrogates)
from ._derivatives import *  # noqa: F403
from ._distance import *  # noqa: F403
from ._fields import *  # noqa: F403
from ._functions import *  # noqa: F403
from ._fwhm import FWHMEstimate, estimate_fwhm, smooth_to_fwhm
from ._images import estimate_fwhm_img, smooth_img
from ._operators import *  # noqa: F403
from ._paths import *  # noqa: F403
from ._refinement import RefinedSurface, refine
from ._resampling import *  # noqa: F403
from ._result import *  # noqa: F403
from ._run import States, SurfaceDiffusionWarning
from ._scales import *  # noqa: F403
from ._shape import ReliefResult, relief
from ._solids import *  # noqa: F403
from ._steps import *  # noqa: F403
from ._surrogates import *  # noqa: F403
from ._surface import Surface, on_faces, on_points, sphere
from ._threads import get_number_of_threads, set_number_of_threads

__version__ = _version("surfacediffusion")

__all__ = [
    "FWHMEstimate", "RefinedSurface", "ReliefResult", "States", "Surface", "SurfaceDiffusionWarning",
    "estimate_fwhm", "estimate_fwhm_img", "get_number_of_threads", "on_faces", "on_points", "refine",
    "relief", "set_number_of_threads", "smooth_img", "smooth_to_fwhm", "sphere",
]
__all__ += _derivatives.__all__
__all__ += _distance.__all__
__all__ += _fields.__all__
__all__ += _functions.__all__
__all__ += _operators.__all__
__all__ += _paths.__all__
__all__ += _resampling.__all__
__all__ += _result.__all__
__all__ += _scales.__all__
__all__ += _solids.__all__
__all__ += _steps.__all__
__all__ += _surrogates.__all__

if hasattr(_os, "register_at_fork"):
    _os.register_at_fork(after_in_child=_core.after_fork)

if not _typing.TYPE_CHECKING:  # otherwise type checkers would accept every name
    def __getattr__(name):
        """The classes of VTK, which were once in a package of this name."""
        if not name.startswith("vtk"):
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        try:
            classes = _importlib.import_module("vtkSurfaceDiffusion")
        except ModuleNotFoundError as error:
            if error.name != "vtkSurfaceDiffusion":
                raise
            raise ImportError(
                f"{name} is in the module vtkSurfaceDiffusion, which is not installed (pip install "
                "Packaging/VTK); surfacediffusion has functions of arrays and PyVista meshes",
                name="vtkSurfaceDiffusion") from None
        found = getattr(classes, name)
        _warnings.warn(f"{name} of surfacediffusion is deprecated: import it from vtkSurfaceDiffusion",
                       DeprecationWarning, stacklevel=2)
        globals()[name] = found  # `from ... import` asks twice
        return found
