// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/DenoisingScheme.h"

#include "Core/Foundation/Quantile.h"
#include "Core/Geometry/DisplacementStatistics.h"
#include "Core/Geometry/FaceFlips.h"
#include "Core/Geometry/LinearNormals.h"
#include "Core/Geometry/NormalFit.h"
#include "Core/Geometry/NormalVariation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The noise, in h, for which the fidelities of a scheme are meant.
constexpr double ReferenceNoise = 0.3;
/// The share of the work that finds neighbours, and those of the rest up to the third stage, and up
/// to the final fit.
constexpr double GraphProgress = 0.05;
constexpr double VariationProgress = 0.5;
constexpr double FinalProgress = 0.95;
/// In standard deviations of the noise: the largest displacement that counts.
constexpr double LargestDisplacement = 3.0;
/// Of the local fidelity: the largest displacement that counts, in standard deviations of the
/// noise, the change in one iteration, and the range of the factors.
constexpr double LargestLocalDisplacement = 1.5;
constexpr double MeanOfLocalSquares = 0.7785; ///< of noise alone, with that limit
constexpr double LargestChange = 4.0;
constexpr double SmallestFactor = 0.5;
constexpr double LargestFactor = 100.0;
/// Limits of the whiteness of displacements: all of a step or a result up to the first, nothing
/// from the second on.
struct WhitenessLimits
{
  double All;
  double Nothing;
};
/// Of careful steps: between them is the least error, in normals, on surfaces of many kinds, since
/// the noise that is left then weighs as much as the details that further steps would remove.
constexpr WhitenessLimits LimitsOfSteps = { 0.55, 0.75 };
/// Of whole steps: after them, the displacements of smooth surfaces have 0.6 to 0.8, and those of
/// surfaces with details 1 to 5.
constexpr WhitenessLimits LimitsOfResult = { 0.85, 1.1 };
/// Details of short wavelength leave displacements that are not alike at neighbours but larger than
/// the noise: nothing from this mean square on, in squares of the noise. Impulsive noise, whose
/// level is that of fewer vertices, and noise that is underestimated have up to 2.
constexpr double LargestMeanSquare = 3.0;
/// The pauses between measurements of the whiteness grow by one iteration after so many, since
/// steps become smaller.
constexpr int IterationsPerPause = 4;

/// The stages of a scheme.
class Denoising
{
public:
  Denoising(const TriangleMesh& mesh, const Points& points, const std::vector<char>& fixed,
    const VertexPairs& creases, double noise, const DenoisingScheme& scheme,
    const ParallelFor& parallel, const ProgressMonitor& progress)
    : Graph(mesh, parallel, progress)
    , Given(points)
    , Fixed(fixed)
    , Noise(noise)
    , Scheme(scheme)
    , Parallel(parallel)
    , Moved(points)
    , Statistics(mesh, fixed, parallel)
  {
    if (!creases.empty())
    {
      this->Graph.Separate(creases, parallel);
    }
  }

  DenoisedSurface Run(SurfaceType type, const ProgressMonitor& progress)
  {
    const bool isOrganic = type == SurfaceType::Organic;
    const double end = isOrganic ? 1.0 : VariationProgress;
    this->FilterWithMeans(progress.Part(0.0, 0.4 * end));
    this->FilterWithLinearFits(progress.Part(0.4 * end, end));
    if (isOrganic)
    {
      return { std::move(this->Moved), type };
    }
    Points filtered = type == SurfaceType::Automatic ? this->Moved : Points();
    this->MinimizeVariation(progress.Part(VariationProgress, FinalProgress));
    this->FitFinally(progress.Part(FinalProgress, 1.0));
    if (type == SurfaceType::Automatic && !this->LeavesOnlyNoise())
    {
      return { std::move(filtered), SurfaceType::Organic };
    }
    return { std::move(this->Moved), SurfaceType::CAD };
  }

private:
  /// The first stage.
  void FilterWithMeans(const ProgressMonitor& progress)
  {
    const NormalFilterSettings& filter = this->Scheme.Filter;
    const int count = this->Scheme.Iterations;
    for (int i = 0; i < count; ++i)
    {
      const ProgressMonitor part = this->Begin(progress, i, count);
      if (i == 0)
      {
        this->Geometry.MeasureWidths(this->Graph, this->Parallel);
      }
      const Points guide = MakeGuide(this->Graph, this->Geometry, filter, this->Parallel);
      const Points normals =
        FilterNormals(this->Graph, this->Geometry, guide, filter, this->Parallel);
      this->Step(normals, this->Scheme.Fidelity, part);
      if (this->Scheme.IsNoiseIndependent)
      {
        this->AdaptFidelity(normals);
      }
    }
  }

  /// The second stage. Careful steps end around each vertex before they remove details; whole ones
  /// show whether there are any, and are kept where there are none.
  void FilterWithLinearFits(const ProgressMonitor& progress)
  {
    const int count = this->Scheme.LinearIterations;
    const bool isCareful = this->Scheme.IsNoiseIndependent && count > 0;
    Points careful = isCareful ? this->Moved : Points();
    Points before;
    Vector shares;
    int next = 0;
    for (int i = 0; i < count; ++i)
    {
      const ProgressMonitor part = this->Begin(progress, i, count);
      if (i == 0)
      {
        this->Geometry.MeasureWidths(this->Graph, this->Parallel);
      }
      if (isCareful)
      {
        before = this->Moved;
        if (i == next)
        {
          shares = this->Shares(LimitsOfSteps, careful);
          next = i + 1 + i / IterationsPerPause;
        }
      }
      this->FitNormals();
      this->Step(this->LastNormals, this->Scheme.LinearFidelity, part);
      this->TurnFlippedFaces(this->Moved);
      if (isCareful)
      {
        ForEach(this->Parallel, static_cast<Index>(careful.rows()),
          [&](Index k) { careful.row(k) += shares[k] * (this->Moved.row(k) - before.row(k)); });
        this->TurnFlippedFaces(careful);
      }
    }
    if (isCareful)
    {
      this->Geometry.Measure(this->Graph.Mesh, this->Moved, this->Parallel);
      shares = this->Shares(LimitsOfResult, this->Moved);
      ForEach(this->Parallel, static_cast<Index>(careful.rows()),
        [&](Index k) {
          this->Moved.row(k) = careful.row(k) + shares[k] * (this->Moved.row(k) - careful.row(k));
        });
      this->Geometry.Measure(this->Graph.Mesh, this->Moved, this->Parallel);
      this->FitNormals();
      this->TurnFlippedFaces(this->Moved);
    }
  }

  /// The last normals: linear fits to those of the present surface.
  void FitNormals()
  {
    const NormalFilterSettings& filter = this->Scheme.LinearFilter;
    const Points guide =
      ReplaceUnsupportedNormals(this->Graph, this->Geometry, filter, this->Parallel);
    this->LastNormals =
      FitLinearNormals(this->Graph, this->Geometry, guide, filter, this->Parallel);
  }

  /// By the last normals.
  void TurnFlippedFaces(Points& points) const
  {
    SurfaceDiffusion::TurnFlippedFaces(
      this->Graph.Mesh, this->LastNormals, this->Fixed, points, this->Parallel);
  }

  /// Measure the present surface for iteration i. Returns its part of the progress.
  ProgressMonitor Begin(const ProgressMonitor& progress, int i, int count)
  {
    const ProgressMonitor part = progress.Part(i / static_cast<double>(count), (i + 1.0) / count);
    part.Report(0.0);
    this->Geometry.Measure(this->Graph.Mesh, this->Moved, this->Parallel);
    return part;
  }

  /// Per vertex, by the whiteness of the displacements of the present surface, and by the mean
  /// square of those of `points`, around it.
  Vector Shares(const WhitenessLimits& limits, const Points& points) const
  {
    const Vector whiteness = this->Statistics.LocalWhiteness(
      this->DisplacementsAlongNormals(this->Moved, this->Geometry.Normals));
    const Vector squares = this->Statistics.LocalMeans(
      this->DisplacementsAlongNormals(points, this->Geometry.Normals).cwiseAbs2());
    return ((limits.Nothing - whiteness.array()) / (limits.Nothing - limits.All))
      .cwiseMin(LargestMeanSquare - squares.array())
      .cwiseMax(0.0)
      .cwiseMin(1.0);
  }

  /// The third stage.
  void MinimizeVariation(const ProgressMonitor& progress)
  {
    const DenoisingScheme& scheme = this->Scheme;
    const TriangleMesh& mesh = this->Graph.Mesh;
    NormalVariation variation(this->Graph, mesh.MeanEdgeLength(), this->Parallel);
    // It knows the edges now, and needs the memory.
    this->Graph.Ring = IndexLists();
    this->Graph.Across = IndexLists();
    this->Geometry.Widths = Vector();
    const int count = scheme.VariationIterations;
    for (int i = 0; i < count; ++i)
    {
      const ProgressMonitor part = this->Begin(progress, i, count);
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
      this->LastNormals = Points();
      this->LastNormals = variation.Minimize(this->Geometry.Normals, settings, part.Part(0.0, 0.8));
      this->LastNormals.rowwise().normalize();
      variation.SetWeights(this->LastNormals, scheme.VariationRange);
      const double relative = this->RelativePrecision();
      this->Fit(this->LastNormals, scheme.VariationFidelity * relative * relative,
        scheme.VariationTangentialFidelity, scheme.VariationFitIterations, part.Part(0.8, 1.0));
      this->TurnFlippedFaces(this->Moved);
    }
  }

  void FitFinally(const ProgressMonitor& progress)
  {
    const double relative = this->RelativePrecision();
    this->Fit(this->LastNormals,
      std::min(relative, relative * relative) * this->Scheme.FinalFidelity,
      this->Scheme.VariationTangentialFidelity, this->Scheme.FinalFitIterations, progress);
    this->TurnFlippedFaces(this->Moved);
  }

  bool LeavesOnlyNoise() const
  {
    const Vector displacements = this->DisplacementsAlongNormals(this->Moved, this->LastNormals);
    return displacements.squaredNorm() <=
      LargestMeanSquare * static_cast<double>(displacements.size()) &&
      this->Statistics.Whiteness(displacements) <=
      1.0 + 2.0 * this->Statistics.WhitenessDeviation();
  }

  /// Per vertex, in standard deviations of the noise, without outliers.
  Vector DisplacementsAlongNormals(const Points& points, const Points& normals) const
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
        displacements[i] = std::clamp(normal.dot(points.row(i) - this->Given.row(i)) / this->Noise,
          -LargestDisplacement, LargestDisplacement);
      });
    return displacements;
  }

  /// The reciprocal of the noise in units of ReferenceNoise.
  double RelativePrecision() const
  {
    return ReferenceNoise * this->Graph.Mesh.MeanEdgeLength() / this->Noise;
  }

  /// One step of conjugate gradients towards the fit: few of them regularise. fidelity: for
  /// ReferenceNoise.
  void Step(const Points& normals, double fidelity, const ProgressMonitor& progress)
  {
    const double relative = this->RelativePrecision();
    this->Fit(
      normals, relative * relative * fidelity, this->Scheme.TangentialFidelity, 1, progress);
  }

  void Fit(const Points& normals, double fidelity, double tangentialFidelity, int iterations,
    const ProgressMonitor& progress)
  {
    NormalFitSettings fit;
    fit.Fidelity = fidelity;
    fit.FidelityFactors = this->LocalFactors;
    fit.TangentialFidelity = tangentialFidelity;
    fit.MaximumNumberOfIterations = iterations;
    fit.OutlierDistance = this->Scheme.OutlierLevel * this->Noise;
    FitToNormals(this->Graph.Mesh, this->Given, normals, this->Fixed, fit, this->Moved,
      this->Parallel, progress);
  }

  void AdaptFidelity(const Points& normals)
  {
    const Vector squares =
      this->Statistics.LocalMeans(this->DisplacementsAlongNormals(this->Moved, normals)
                                    .cwiseAbs()
                                    .cwiseMin(LargestLocalDisplacement)
                                    .cwiseAbs2() /
        MeanOfLocalSquares);
    if (this->LocalFactors.size() == 0)
    {
      this->LocalFactors = Vector::Ones(squares.size());
    }
    std::vector<double> all(squares.data(), squares.data() + squares.size());
    const double usual = std::max(1.0, QuantileOf(all, 0.5));
    ForEach(this->Parallel, static_cast<Index>(squares.size()),
      [&](Index i)
      {
        const double change =
          std::sqrt(std::clamp(squares[i] / usual, 1.0 / LargestChange, LargestChange));
        this->LocalFactors[i] =
          std::clamp(change * this->LocalFactors[i], SmallestFactor, LargestFactor);
      });
  }

  FaceGraph Graph;
  const Points& Given;
  const std::vector<char>& Fixed;
  const double Noise;
  const DenoisingScheme Scheme;
  const ParallelFor& Parallel;
  Points Moved;
  DisplacementStatistics Statistics;
  FaceGeometry Geometry;
  Points LastNormals; ///< of the last iteration
  Vector LocalFactors; ///< of the fidelity, per vertex; no entries: 1
};

} // namespace

DenoisingScheme SchemeForIndependentNoise(double noise)
{
  DenoisingScheme scheme;
  // Each iteration is one step of descent, so that strong noise needs more of them.
  scheme.Iterations = std::clamp(static_cast<int>(std::lround(50.0 * noise)), 3, 30);
  return scheme;
}

DenoisingScheme SchemeForCorrelatedNoise(double length)
{
  DenoisingScheme scheme;
  scheme.IsNoiseIndependent = false;
  scheme.TangentialFidelity = 0.1;
  scheme.LinearIterations = 5;
  scheme.VariationIterations = 20;
  scheme.VariationSplittings = 15;
  scheme.FirstVariation = 0.3 * length;
  scheme.LastVariation = 0.15 * length;
  return scheme;
}

DenoisedSurface DenoiseWithScheme(const TriangleMesh& mesh, const Points& points,
  const std::vector<char>& fixed, const VertexPairs& creases, double noise,
  const DenoisingScheme& scheme, SurfaceType type, const ParallelFor& parallel,
  const ProgressMonitor& progress)
{
  Denoising denoising(
    mesh, points, fixed, creases, noise, scheme, parallel, progress.Part(0.0, GraphProgress));
  return denoising.Run(type, progress.Part(GraphProgress, 1.0));
}

} // namespace SurfaceDiffusion
