// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SurfaceDenoising.h"

#include "Core/Geometry/FaceFlips.h"
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
constexpr double DetailLevel = 0.03;
/// Noise below this, in h, is none: that of points in single precision.
constexpr double SmallestNoise = 1e-4;
/// AngleRatio below which a surface is sharp, after ProbeIterations for sharp surfaces.
constexpr double AngleQuantile = 0.8;
constexpr double SharpAngleRatio = 0.4;
constexpr int ProbeIterations = 5;
/// Vertices that move farther than the noise, by this factor, are held more firmly.
constexpr double LargestSpread = 1.1;
constexpr double LargestTightening = 4.0;
/// Of the local fidelity: the largest displacement that counts, in standard deviations of the
/// noise, the sweeps of averaging, and the range of the factors.
constexpr double LargestLocalDisplacement = 1.5;
constexpr double MeanOfLocalSquares = 0.7785; ///< of noise alone, with that limit
constexpr int LocalSweeps = 8;
constexpr double SmallestFactor = 0.5;
constexpr double LargestFactor = 100.0;

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
  return QuantileOf(differences, AngleQuantile) /
    std::sqrt(squares / static_cast<double>(differences.size()));
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

/// Replace values by their means over each vertex and its neighbours.
void AverageOverNeighbours(const TriangleMesh& mesh, Vector& values, const ParallelFor& parallel)
{
  Vector next(values.size());
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      const Index begin = mesh.VertexCornersBegin()[i];
      const Index end = mesh.VertexCornersBegin()[i + 1];
      double sum = values[i];
      for (Index k = begin; k < end; ++k)
      {
        const Index corner = mesh.VertexCorners()[k];
        sum += 0.5 * (values[mesh.OtherCorner(corner, 1)] + values[mesh.OtherCorner(corner, 2)]);
      }
      next[i] = sum / static_cast<double>(end - begin + 1);
    });
  values.swap(next);
}

/// The iterations of a scheme.
class Denoising
{
public:
  Denoising(const FaceGraph& graph, const Points& points, const std::vector<char>& fixed,
    double noise, const DenoisingScheme& scheme, const ParallelFor& parallel)
    : Graph(graph)
    , Given(points)
    , Fixed(fixed)
    , Noise(noise)
    , Scheme(scheme)
    , Parallel(parallel)
    , Moved(points)
  {
    if (scheme.HasLocalFidelity)
    {
      this->LocalFactors = Vector::Ones(graph.Mesh.NumberOfVertices());
    }
  }

  /// The moved points.
  const Points& Run(const ProgressMonitor& progress)
  {
    const int count = this->Scheme.Iterations + this->Scheme.LinearIterations;
    for (int i = 0; i < count; ++i)
    {
      const ProgressMonitor part = progress.Part(static_cast<double>(i) / count, (i + 1.0) / count);
      part.Report(0.0);
      this->Geometry.Measure(this->Graph.Mesh, this->Moved, this->Parallel);
      if (i < this->Scheme.Iterations)
      {
        this->IterateConstant(i, part);
      }
      else
      {
        this->IterateLinear(part);
      }
    }
    return this->Moved;
  }

private:
  void IterateConstant(int iteration, const ProgressMonitor& progress)
  {
    const DenoisingScheme& scheme = this->Scheme;
    const Points guide = MakeGuide(this->Graph, this->Geometry, scheme.Filter, this->Parallel);
    const Points normals =
      FilterNormals(this->Graph, this->Geometry, guide, scheme.Filter, this->Parallel);
    const double fraction = scheme.Iterations > 1 ? iteration / (scheme.Iterations - 1.0) : 1.0;
    this->Fit(normals,
      scheme.FirstFidelity * std::pow(scheme.LastFidelity / scheme.FirstFidelity, fraction),
      progress);
    if (scheme.HasLocalFidelity)
    {
      this->AdaptLocally(normals);
    }
    else
    {
      const double spread = MeasureSpread(this->Given, this->Moved) / (LargestSpread * this->Noise);
      this->Tightening *= std::clamp(spread * spread, 1.0, LargestTightening);
    }
  }

  void IterateLinear(const ProgressMonitor& progress)
  {
    const DenoisingScheme& scheme = this->Scheme;
    const Points guide =
      ReplaceUnsupportedNormals(this->Graph, this->Geometry, scheme.LinearFilter, this->Parallel);
    const Points normals =
      FitLinearNormals(this->Graph, this->Geometry, guide, scheme.LinearFilter, this->Parallel);
    this->Fit(normals, scheme.LinearFidelity, progress);
    TurnFlippedFaces(this->Graph.Mesh, normals, this->Fixed, this->Moved);
  }

  void Fit(const Points& normals, double fidelity, const ProgressMonitor& progress)
  {
    const double relative = ReferenceNoise * MeanEdgeLength(this->Graph.Mesh) / this->Noise;
    NormalFitSettings fit;
    fit.Fidelity = this->Tightening * relative * relative * fidelity;
    fit.FidelityFactors = this->LocalFactors;
    fit.TangentialFidelity = this->Scheme.TangentialFidelity;
    fit.MaximumNumberOfIterations = this->Scheme.FitIterations;
    fit.OutlierDistance = this->Scheme.OutlierLevel * this->Noise;
    FitToNormals(this->Graph.Mesh, this->Given, normals, this->Fixed, fit, this->Moved,
      this->Parallel, progress);
  }

  void AdaptLocally(const Points& normals)
  {
    const TriangleMesh& mesh = this->Graph.Mesh;
    Vector squares(mesh.NumberOfVertices());
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        Eigen::RowVector3d normal = Eigen::RowVector3d::Zero();
        for (Index k = mesh.VertexCornersBegin()[i]; k < mesh.VertexCornersBegin()[i + 1]; ++k)
        {
          normal += normals.row(mesh.VertexCorners()[k] / 3);
        }
        normal.normalize();
        const double moved = std::abs(normal.dot(this->Moved.row(i) - this->Given.row(i)));
        const double counted = std::min(moved / this->Noise, LargestLocalDisplacement);
        squares[i] = counted * counted / MeanOfLocalSquares;
      });
    for (int sweep = 0; sweep < LocalSweeps; ++sweep)
    {
      AverageOverNeighbours(mesh, squares, this->Parallel);
    }
    std::vector<double> all(squares.data(), squares.data() + squares.size());
    const double usual = std::max(1.0, QuantileOf(all, 0.5));
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        const double change =
          std::sqrt(std::clamp(squares[i] / usual, 1.0 / LargestTightening, LargestTightening));
        this->LocalFactors[i] =
          std::clamp(change * this->LocalFactors[i], SmallestFactor, LargestFactor);
      });
  }

  const FaceGraph& Graph;
  const Points& Given;
  const std::vector<char>& Fixed;
  const double Noise;
  const DenoisingScheme Scheme;
  const ParallelFor& Parallel;
  Points Moved;
  FaceGeometry Geometry;
  double Tightening = 1.0;
  Vector LocalFactors; ///< of the fidelity, per vertex; no entries: 1
};

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

DenoisingScheme SchemeFor(SurfaceKind kind, double noise)
{
  DenoisingScheme scheme;
  scheme.Filter.Kind = kind;
  scheme.LinearFilter.Kind = kind;
  scheme.Filter.Fidelity = 0.12;
  scheme.LinearFilter.Range = 0.31;
  scheme.LinearFilter.Width = 2.0;
  if (kind == SurfaceKind::Smooth)
  {
    scheme.Filter.Sweeps = 1;
    // Each iteration is one step of descent, so that strong noise needs more of them.
    scheme.Iterations = std::clamp(static_cast<int>(std::lround(50.0 * noise)), 3, 30);
    scheme.FirstFidelity = 0.09;
    scheme.LastFidelity = 0.09;
    scheme.LinearFilter.Range = 0.4;
    scheme.LinearFilter.Width = 0.9;
    scheme.LinearIterations =
      std::clamp(static_cast<int>(std::lround(100.0 * noise * noise)), 2, 15);
    scheme.LinearFidelity = 0.06;
    scheme.FitIterations = 1;
    scheme.TangentialFidelity = 2.0;
    scheme.HasLocalFidelity = true;
  }
  return scheme;
}

Points DenoiseWithScheme(const FaceGraph& graph, const Points& points,
  const std::vector<char>& fixed, double noise, const DenoisingScheme& scheme,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  return Denoising(graph, points, fixed, noise, scheme, parallel).Run(progress);
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
