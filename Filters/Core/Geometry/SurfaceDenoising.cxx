// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SurfaceDenoising.h"

#include "Core/Geometry/DenoisingScheme.h"
#include "Core/Geometry/VertexNoise.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The estimate, in h, on surfaces without noise that have details as small as their triangles.
constexpr double DetailLevel = 0.03;
/// Noise below this, in h, is none: that of points in single precision.
constexpr double SmallestNoise = 1e-4;
/// AngleRatio below which a surface is sharp, after ProbeIterations for sharp surfaces.
constexpr double AngleQuantile = 0.8;
constexpr double SharpAngleRatio = 0.4;
constexpr int ProbeIterations = 5;

/// DenoisingReport::AngleRatio of normals.
double MeasureAngleRatio(const FaceGraph& graph, const Points& normals)
{
  std::vector<double> differences;
  double squares = 0.0;
  for (Index f = 0; f < graph.NumberOfFaces(); ++f)
  {
    for (Index k = graph.Across.Begin[f]; k < graph.Across.Begin[f + 1]; ++k)
    {
      const Index g = graph.Across.Entries[k];
      if (g > f)
      {
        const double square = (normals.row(f) - normals.row(g)).squaredNorm();
        differences.push_back(std::sqrt(square));
        squares += square;
      }
    }
  }
  if (!(squares > 0.0))
  {
    return 0.0;
  }
  return QuantileOf(differences, AngleQuantile) /
    std::sqrt(squares / static_cast<double>(differences.size()));
}

/// The estimated noise, less the details of surfaces without noise.
double EstimateNoise(const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel)
{
  const double measured = EstimateVertexNoise(mesh, points, parallel);
  const double details = DetailLevel * MeanEdgeLength(mesh);
  return std::sqrt(std::max(0.0, measured * measured - details * details));
}

SurfaceKind FindKind(const FaceGraph& graph, const Points& points, const std::vector<char>& fixed,
  double noise, double& angleRatio, const ParallelFor& parallel, const ProgressMonitor& progress)
{
  DenoisingScheme probe = SchemeFor(SurfaceKind::Sharp, noise / MeanEdgeLength(graph.Mesh));
  probe.Iterations = ProbeIterations;
  probe.LinearIterations = 0;
  probe.FitIterations = 10;
  FaceGeometry geometry;
  geometry.Measure(graph.Mesh,
    DenoiseWithScheme(graph, points, fixed, noise, probe, parallel, progress), parallel);
  angleRatio = MeasureAngleRatio(graph, geometry.Normals);
  return angleRatio < SharpAngleRatio ? SurfaceKind::Sharp : SurfaceKind::Smooth;
}

} // namespace

Points DenoiseSurface(const TriangleMesh& mesh, const Points& points,
  const std::vector<char>& fixed, const DenoisingSettings& settings, DenoisingReport* report,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  DenoisingReport found;
  found.NoiseLevel =
    settings.NoiseLevel > 0.0 ? settings.NoiseLevel : EstimateNoise(mesh, points, parallel);
  progress.Report(0.05);
  Points moved = points;
  if (found.NoiseLevel > SmallestNoise * MeanEdgeLength(mesh))
  {
    const FaceGraph graph(mesh, parallel);
    progress.Report(0.1);
    found.Kind = settings.Type == SurfaceType::Automatic
      ? FindKind(graph, points, fixed, found.NoiseLevel, found.AngleRatio, parallel,
          progress.Part(0.1, 0.25))
      : (settings.Type == SurfaceType::CAD ? SurfaceKind::Sharp : SurfaceKind::Smooth);
    moved = DenoiseWithScheme(graph, points, fixed, found.NoiseLevel,
      SchemeFor(found.Kind, found.NoiseLevel / MeanEdgeLength(mesh)), parallel,
      progress.Part(0.25, 1.0));
  }
  const auto displacement = [&](Index i) { return (moved.row(i) - points.row(i)).norm(); };
  const Index count = mesh.NumberOfVertices();
  found.MeanDisplacement = Sum(parallel, count, displacement) / std::max<Index>(1, count);
  found.MaximumDisplacement = Max(parallel, count, displacement);
  if (report)
  {
    *report = found;
  }
  progress.Report(1.0);
  return moved;
}

} // namespace SurfaceDiffusion
