// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SurfaceDenoising.h"

#include "Core/Geometry/VertexNoise.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The noise, in h, for which the fidelities of a scheme are meant.
constexpr double ReferenceNoise = 0.3;
/// The estimate, in h, on surfaces without noise that have details as small as their triangles.
constexpr double DetailLevel = 0.02;
/// Noise below this, in h, is none: that of points in single precision.
constexpr double SmallestNoise = 1e-4;
/// AngleRatio below which a surface is sharp, after ProbeIterations for sharp surfaces.
constexpr double SharpAngleRatio = 0.18;
constexpr int ProbeIterations = 5;
/// Vertices that move farther than the noise, by this factor, are held more firmly.
constexpr double LargestSpread = 1.1;
constexpr double LargestTightening = 4.0;

double MeanEdgeLength(const TriangleMesh& mesh)
{
  return mesh.NumberOfEdges() > 0 ? mesh.TotalEdgeLength() / mesh.NumberOfEdges() : 1.0;
}

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
  return MedianOf(differences) / std::sqrt(squares / static_cast<double>(differences.size()));
}

/// The standard deviation of the displacements, by their median.
double MeasureSpread(const Points& points, const Points& moved)
{
  std::vector<double> distances(static_cast<std::size_t>(points.rows()));
  for (Index i = 0; i < static_cast<Index>(points.rows()); ++i)
  {
    distances[i] = (moved.row(i) - points.row(i)).norm();
  }
  return MedianDeviation(distances);
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
  DenoisingScheme probe = SchemeFor(SurfaceKind::Sharp);
  probe.Iterations = ProbeIterations;
  FaceGeometry geometry;
  geometry.Measure(graph.Mesh,
    DenoiseWithScheme(graph, points, fixed, noise, probe, parallel, progress), parallel);
  angleRatio = MeasureAngleRatio(graph, geometry.Normals);
  return angleRatio < SharpAngleRatio ? SurfaceKind::Sharp : SurfaceKind::Smooth;
}

} // namespace

DenoisingScheme SchemeFor(SurfaceKind kind)
{
  DenoisingScheme scheme;
  scheme.Filter.Kind = kind;
  if (kind == SurfaceKind::Smooth)
  {
    scheme.Filter.Sweeps = 1;
    scheme.Iterations = 15;
    scheme.FirstFidelity = 0.09;
    scheme.LastFidelity = 0.09;
    scheme.TangentialFidelity = 2.0;
  }
  return scheme;
}

Points DenoiseWithScheme(const FaceGraph& graph, const Points& points,
  const std::vector<char>& fixed, double noise, const DenoisingScheme& scheme,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const double h = MeanEdgeLength(graph.Mesh);
  const double relative = ReferenceNoise * h / noise;
  double tightening = 1.0;
  Points moved = points;
  FaceGeometry geometry;
  for (int i = 0; i < scheme.Iterations; ++i)
  {
    const double fraction = scheme.Iterations > 1 ? i / (scheme.Iterations - 1.0) : 1.0;
    progress.Report(static_cast<double>(i) / scheme.Iterations);
    geometry.Measure(graph.Mesh, moved, parallel);
    const Points guide = MakeGuide(graph, geometry, scheme.Filter, parallel);
    const Points normals = FilterNormals(graph, geometry, guide, scheme.Filter, parallel);
    NormalFitSettings fit;
    fit.Fidelity = tightening * relative * relative * scheme.FirstFidelity *
      std::pow(scheme.LastFidelity / scheme.FirstFidelity, fraction);
    fit.TangentialFidelity = scheme.TangentialFidelity;
    fit.MaximumNumberOfIterations = scheme.FitIterations;
    fit.OutlierDistance = scheme.OutlierLevel * noise;
    FitToNormals(graph.Mesh, points, normals, fixed, fit, moved, parallel,
      progress.Part((i + 0.5) / scheme.Iterations, (i + 1.0) / scheme.Iterations));
    const double spread = MeasureSpread(points, moved) / (LargestSpread * noise);
    tightening *= std::clamp(spread * spread, 1.0, LargestTightening);
  }
  return moved;
}

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
    moved = DenoiseWithScheme(graph, points, fixed, found.NoiseLevel, SchemeFor(found.Kind),
      parallel, progress.Part(0.25, 1.0));
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
