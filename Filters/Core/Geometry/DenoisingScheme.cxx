// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/DenoisingScheme.h"

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
/// Vertices that move farther than the noise, by this factor, are held more firmly.
constexpr double LargestSpread = 1.1;
constexpr double LargestTightening = 4.0;
/// The shares of the work up to the third stage, and up to the final fit.
constexpr double VariationProgress = 0.5;
constexpr double FinalProgress = 0.95;
/// In standard deviations of the noise: the largest displacement that counts.
constexpr double LargestDisplacement = 3.0;
/// Of the local fidelity: the largest displacement that counts, in standard deviations of the
/// noise, the sweeps of averaging, and the range of the factors.
constexpr double LargestLocalDisplacement = 1.5;
constexpr double MeanOfLocalSquares = 0.7785; ///< of noise alone, with that limit
constexpr int LocalSweeps = 8;
constexpr double SmallestFactor = 0.5;
constexpr double LargestFactor = 100.0;

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
    this->RunFilters(progress);
    this->RunVariation(progress);
    return this->Moved;
  }

  /// The first two stages.
  void RunFilters(const ProgressMonitor& progress)
  {
    const int count = this->Scheme.Iterations + this->Scheme.LinearIterations;
    const double iterations = this->HasVariation() ? VariationProgress : FinalProgress;
    for (int i = 0; i < count; ++i)
    {
      const ProgressMonitor part =
        progress.Part(iterations * i / count, iterations * (i + 1.0) / count);
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
  }

  /// The others.
  const Points& RunVariation(const ProgressMonitor& progress)
  {
    if (this->HasVariation())
    {
      this->MinimizeVariation(progress.Part(VariationProgress, FinalProgress));
    }
    if (this->Scheme.FinalFitIterations > 0)
    {
      this->FitFinally(progress.Part(FinalProgress, 1.0));
    }
    return this->Moved;
  }

  /// Whether the displacements along the normals are no more alike at neighbours than independent
  /// noise: the variance of their sums over a vertex and its neighbours is that of as many
  /// independent numbers, within two of its standard deviations.
  bool LeavesOnlyNoise() const
  {
    const TriangleMesh& mesh = this->Graph.Mesh;
    const Vector displacements = this->DisplacementsAlongNormals(this->LastNormals);
    Vector means = displacements;
    AverageOverNeighbours(mesh, means, this->Parallel);
    double free = 0.0;
    double square = 0.0;
    double squareOfSums = 0.0;
    double terms = 0.0;
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      if (!this->Fixed.empty() && this->Fixed[i] != 0)
      {
        continue;
      }
      const double count = 1.0 + mesh.VertexCornersBegin()[i + 1] - mesh.VertexCornersBegin()[i];
      free += 1.0;
      square += displacements[i] * displacements[i];
      squareOfSums += count * means[i] * count * means[i];
      terms += count;
    }
    // Sums share terms, so that there are as many independent ones as sums without a common term.
    const double deviation = std::sqrt(2.0 * terms) / std::max(1.0, free);
    return squareOfSums * free <= (1.0 + 2.0 * deviation) * square * terms;
  }

private:
  bool HasVariation() const { return this->Scheme.VariationIterations > 0; }

  /// Per vertex, in standard deviations of the noise, without outliers.
  Vector DisplacementsAlongNormals(const Points& normals) const
  {
    const TriangleMesh& mesh = this->Graph.Mesh;
    Vector displacements(mesh.NumberOfVertices());
    ForEach(this->Parallel, mesh.NumberOfVertices(),
      [&](Index i)
      {
        Eigen::RowVector3d normal = Eigen::RowVector3d::Zero();
        for (Index k = mesh.VertexCornersBegin()[i]; k < mesh.VertexCornersBegin()[i + 1]; ++k)
        {
          normal += normals.row(mesh.VertexCorners()[k] / 3);
        }
        normal.normalize();
        displacements[i] =
          std::clamp(normal.dot(this->Moved.row(i) - this->Given.row(i)) / this->Noise,
            -LargestDisplacement, LargestDisplacement);
      });
    return displacements;
  }

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
    this->LastNormals =
      FitLinearNormals(this->Graph, this->Geometry, guide, scheme.LinearFilter, this->Parallel);
    this->Fit(this->LastNormals, scheme.LinearFidelity, progress);
    TurnFlippedFaces(this->Graph.Mesh, this->LastNormals, this->Fixed, this->Moved);
  }

  void MinimizeVariation(const ProgressMonitor& progress)
  {
    const DenoisingScheme& scheme = this->Scheme;
    const TriangleMesh& mesh = this->Graph.Mesh;
    NormalVariation variation(this->Graph, mesh.MeanEdgeLength(), this->Parallel);
    const int count = scheme.VariationIterations;
    for (int i = 0; i < count; ++i)
    {
      const ProgressMonitor part = progress.Part(i / static_cast<double>(count), (i + 1.0) / count);
      this->Geometry.Measure(mesh, this->Moved, this->Parallel);
      if (i == 0)
      {
        variation.SetWeights(this->Geometry.Normals, scheme.VariationRange);
      }
      const double fraction = count > 1 ? i / (count - 1.0) : 1.0;
      NormalVariationSettings settings;
      settings.First =
        scheme.FirstVariation * std::pow(scheme.LastVariation / scheme.FirstVariation, fraction);
      settings.Iterations = scheme.VariationSplittings;
      settings.Second = scheme.SecondOrder * settings.First;
      variation.SetPlaces(this->Moved, this->Geometry);
      this->LastNormals = variation.Minimize(this->Geometry.Normals, settings, part.Part(0.0, 0.8));
      this->LastNormals.rowwise().normalize();
      variation.SetWeights(this->LastNormals, scheme.VariationRange);
      const double relative = this->RelativePrecision();
      this->Fit(this->LastNormals, scheme.VariationFidelity * relative * relative,
        scheme.VariationFitIterations, part.Part(0.8, 1.0));
      TurnFlippedFaces(mesh, this->LastNormals, this->Fixed, this->Moved);
    }
  }

  void FitFinally(const ProgressMonitor& progress)
  {
    const double relative = this->RelativePrecision();
    this->Fit(this->LastNormals,
      std::min(relative, relative * relative) * this->Scheme.FinalFidelity,
      this->Scheme.FinalFitIterations, progress);
    TurnFlippedFaces(this->Graph.Mesh, this->LastNormals, this->Fixed, this->Moved);
  }

  /// The reciprocal of the noise in units of ReferenceNoise.
  double RelativePrecision() const
  {
    return ReferenceNoise * this->Graph.Mesh.MeanEdgeLength() / this->Noise;
  }

  /// fidelity: for ReferenceNoise.
  void Fit(const Points& normals, double fidelity, const ProgressMonitor& progress)
  {
    const double relative = this->RelativePrecision();
    this->Fit(normals, this->Tightening * relative * relative * fidelity,
      this->Scheme.FitIterations, progress);
  }

  void Fit(const Points& normals, double fidelity, int iterations, const ProgressMonitor& progress)
  {
    NormalFitSettings fit;
    fit.Fidelity = fidelity;
    fit.FidelityFactors = this->LocalFactors;
    fit.TangentialFidelity = this->Scheme.TangentialFidelity;
    fit.MaximumNumberOfIterations = iterations;
    fit.OutlierDistance = this->Scheme.OutlierLevel * this->Noise;
    FitToNormals(this->Graph.Mesh, this->Given, normals, this->Fixed, fit, this->Moved,
      this->Parallel, progress);
  }

  void AdaptLocally(const Points& normals)
  {
    const TriangleMesh& mesh = this->Graph.Mesh;
    Vector squares = this->DisplacementsAlongNormals(normals)
                       .cwiseAbs()
                       .cwiseMin(LargestLocalDisplacement)
                       .cwiseAbs2() /
      MeanOfLocalSquares;
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
  Points LastNormals; ///< of the last iteration
  double Tightening = 1.0;
  Vector LocalFactors; ///< of the fidelity, per vertex; no entries: 1
};

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
    scheme.FinalFitIterations = 0;
    scheme.VariationIterations = 0;
  }
  return scheme;
}

DenoisingScheme SchemeForCorrelatedNoise(double length)
{
  DenoisingScheme scheme = SchemeFor(SurfaceKind::Sharp, ReferenceNoise);
  scheme.LinearIterations = 5;
  scheme.VariationIterations = 20;
  scheme.VariationSplittings = 15;
  scheme.FirstVariation = 0.3 * length;
  scheme.LastVariation = 0.15 * length;
  return scheme;
}

Points DenoiseWithScheme(const FaceGraph& graph, const Points& points,
  const std::vector<char>& fixed, double noise, const DenoisingScheme& scheme,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  return Denoising(graph, points, fixed, noise, scheme, parallel).Run(progress);
}

std::optional<Points> DenoiseUnlessDetailsAreLost(const FaceGraph& graph, const Points& points,
  const std::vector<char>& fixed, double noise, const DenoisingScheme& scheme,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  Denoising denoising(graph, points, fixed, noise, scheme, parallel);
  denoising.RunFilters(progress);
  if (!denoising.LeavesOnlyNoise())
  {
    return std::nullopt;
  }
  return denoising.RunVariation(progress);
}

} // namespace SurfaceDiffusion
