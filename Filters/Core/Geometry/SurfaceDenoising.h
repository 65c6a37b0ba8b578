// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/FaceNormalFilter.h"

namespace SurfaceDiffusion
{

/// The kind of surface that a user asks for.
enum class SurfaceType
{
  Automatic, ///< by the angles at the edges of the filtered surface
  CAD,
  Organic
};

struct DenoisingSettings
{
  /// The standard deviation of the noise of the vertices along the normal, in the unit of the
  /// points; 0: estimated (see EstimateVertexNoise()), less 0.03 mean edge lengths, in squares,
  /// which surfaces without noise have.
  double NoiseLevel = 0.0;
  SurfaceType Type = SurfaceType::Automatic;
};

struct DenoisingReport
{
  double NoiseLevel = 0.0; ///< given or estimated, in the unit of the points
  SurfaceKind Kind = SurfaceKind::Sharp; ///< given or found
  /// The 0.8 quantile over the root mean square of the angles between filtered normals across
  /// edges: small if a few sharp edges have most of the curvature.
  double AngleRatio = 0.0;
  double MeanDisplacement = 0.0; ///< of the vertices, in the unit of the points
  double MaximumDisplacement = 0.0;
};

/// Remove the noise of the vertices of a triangulated surface.
///
/// Each iteration filters the normals of the present surface and fits the given points to them
/// with FitToNormals(): block descent on an energy of positions and normals, whose weights follow
/// from the noise level. The first iterations use FilterNormals(), which suits piecewise constant
/// normals and sharpens edges. The last ones use FitLinearNormals() with the normals of the present
/// surface as guide, for piecewise linear normals, and TurnFlippedFaces(). Tangential displacements
/// are small, so that triangles and boundaries keep their shape. A noise level of 0 leaves the
/// points as they are.
///
/// Displacements along the normal should have the variance of the noise (the discrepancy
/// principle). If their median shows more, the fidelity grows. On organic surfaces it grows and
/// falls per vertex, by local means of the squared displacements (G. Gilboa, N. Sochen, Y. Zeevi,
/// Variational Denoising of Partly Textured Images by Spatially Varying Constraints, IEEE
/// Transactions on Image Processing 15(8), 2006), so that regions of fine details keep them.
///
/// points: per vertex of the mesh; fixed: per vertex, nonzero for vertices that stay, may be empty.
/// Triangles should be oriented consistently: an edge with opposite orientations on its two sides
/// counts as sharp. Throws Aborted.
Points DenoiseSurface(const TriangleMesh& mesh, const Points& points,
  const std::vector<char>& fixed, const DenoisingSettings& settings,
  DenoisingReport* report = nullptr, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
