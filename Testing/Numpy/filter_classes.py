# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The classes for VTK of the functions of arrays."""

import surfacediffusion

CLASSES = {
    "curvature": "vtkSurfaceCurvatureFilter",
    "denoise_mesh": "vtkSurfaceDenoisingFilter",
    "derivatives": "vtkSurfaceDerivativesFilter",
    "direction_field": "vtkSurfaceDirectionFieldFilter",
    "harmonic_map": "vtkHarmonicMapFilter",
    "heat": "vtkFVMHeatFilter",
    "intrinsic_tv": "vtkIntrinsicTVFilter",
    "mumford_shah": "vtkMumfordShahFilter",
    "interpolate": "vtkSurfaceInterpolationFilter",
    "segment": "vtkSurfaceSegmentationFilter",
    "tensor_diffusion": "vtkTensorDiffusionFilter",
    "turing_texture": "vtkTuringTextureFilter",
}
_MISSING = set(surfacediffusion._functions.__all__) ^ set(CLASSES)
assert not _MISSING, f"functions and classes differ: {sorted(_MISSING)}"
