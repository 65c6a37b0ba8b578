// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/FaceNormalFilter.h"
#include "Core/Geometry/NormalFit.h"

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
  /// points; 0: estimated (see EstimateVertexNoise()), less 0.02 mean edge lengths, in squares,
  /// which surfaces without noise have.
  double NoiseLevel = 0.0;
  SurfaceType Type = SurfaceType::Automatic;
};

/// How normals are filtered and vertices fitted for one kind of surface, in mean edge lengths h.
struct DenoisingScheme
{
  NormalFilterSettings Filter;
  int Iterations = 30;
  int FitIterations = 10; ///< of conjugate gradients in each iteration
  /// Fidelity of the fit in the first and in the last iteration for noise of 0.3 h. It is
  /// proportional to the inverse of the variance of the noise.
  double FirstFidelity = 0.5;
  double LastFidelity = 0.05;
  double TangentialFidelity = 0.1;
  double OutlierLevel = 1.0; ///< OutlierDistance of the fit, in standard deviations of the noise
};
DenoisingScheme SchemeFor(SurfaceKind kind);

struct DenoisingReport
{
  double NoiseLevel = 0.0; ///< given or estimated, in the unit of the points
  SurfaceKind Kind = SurfaceKind::Sharp; ///< given or found
  /// The median over the root mean square of the angles between filtered normals across edges:
  /// small if a few sharp edges have most of the curvature.
  double AngleRatio = 0.0;
  double MeanDisplacement = 0.0; ///< of the vertices, in the unit of the points
  double MaximumDisplacement = 0.0;
};

/// Remove the noise of the vertices of a triangulated surface.
///
/// Iterations of FilterNormals() on the present surface and FitToNormals() to the given points:
/// block descent on an energy of positions and normals, whose weights follow from the noise level.
/// Tangential displacements are small, so that triangles and boundaries keep their shape. A noise
/// level of 0 leaves the points as they are.
///
/// points: per vertex of the mesh; fixed: per vertex, nonzero for vertices that stay, may be empty.
/// Triangles should be oriented consistently: an edge with opposite orientations on its two sides
/// counts as sharp. Throws Aborted.
Points DenoiseSurface(const TriangleMesh& mesh, const Points& points,
  const std::vector<char>& fixed, const DenoisingSettings& settings,
  DenoisingReport* report = nullptr, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

/// The same with a given scheme.
Points DenoiseWithScheme(const FaceGraph& graph, const Points& points,
  const std::vector<char>& fixed, double noise, const DenoisingScheme& scheme,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
