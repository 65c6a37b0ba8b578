// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/EdgeScales.h"

#include "Core/Foundation/Resize.h"
#include "Core/Foundation/RobustRange.h"
#include "Core/Statistics/LinearFit.h"
#include "Core/Statistics/NoiseLevel.h"
#include "Core/Surface/EdgeLengths.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace SurfaceDiffusion
{

namespace
{

constexpr double SmallestJump = 0.12; ///< in R
constexpr double NoiseFactor = 3.2; ///< of the noise that makes no edges, with L = 8 h
constexpr double ReferenceLength = 8.0; ///< lengths in h
constexpr double ShortestLength = 2.0;
constexpr double UsualLength = 4.0;
constexpr double LongestLength = 24.0;

constexpr Index LargestSampleOfScales = 3000;
constexpr int DiskRadius = 4; ///< in edges
constexpr Eigen::Index SmallestDisk = 8;
/// A disk has a jump if the variance of its residual is half a standard deviation above that of
/// the noise; 30 % of those without one are left out, too. The residual of a jump is at least 0.3
/// of the fitted slope times the radius, that of smooth data less.
constexpr double LargestExcess = 0.5;
constexpr double LargestBend = 0.12;
constexpr double ShareWithoutJump = 0.7;
constexpr double LargestQuantile = 0.9;

constexpr double NoVariation = 1e-12; ///< relative variation that is no data

/// A linear fit of the data on a disk.
struct Fit
{
  double SquaredSlope = 0.0; ///< over all channels
  double Variance = 0.0; ///< that noise adds to it
  double Area = 0.0; ///< that it stands for
  bool HasJump = false;
};

/// offsets, deviations: from their means. variance: of the noise of a channel.
Fit FitDisk(const Points& offsets, const Values& deviations, double variance)
{
  const auto count = static_cast<double>(offsets.rows());
  const auto channels = static_cast<double>(deviations.cols());
  const Eigen::Matrix3d spread = offsets.transpose() * offsets;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const Eigen::Matrix<double, 3, Eigen::Dynamic> products =
    axes.eigenvectors().transpose() * (offsets.transpose() * deviations);
  Fit fit;
  double explained = 0.0;
  for (int axis = 1; axis < 3; ++axis) // those of the tangent plane
  {
    const double moment = axes.eigenvalues()[axis];
    if (moment > 1e-6 * axes.eigenvalues()[2])
    {
      fit.SquaredSlope += products.row(axis).squaredNorm() / (moment * moment);
      fit.Variance += channels * variance / moment;
      explained += products.row(axis).squaredNorm() / moment;
    }
  }
  const double residual = std::max(deviations.squaredNorm() - explained, 0.0) / (count - 3.0);
  const double ofNoise =
    channels * variance * (1.0 + LargestExcess * std::sqrt(2.0 / (channels * (count - 3.0))));
  const double squaredRadius = 4.0 * axes.eigenvalues()[2] / count;
  fit.HasJump = residual > ofNoise + LargestBend * LargestBend * fit.SquaredSlope * squaredRadius;
  return fit;
}

class Component
{
public:
  Component(const Assembler& assembler, const SparsePattern& pattern,
    const Eigen::Ref<const Points>& points, const PointData& data, VertexRange range)
    : Data(assembler, pattern, points, data, range)
    , Pattern(pattern)
  {
  }

  double MeanEdgeLength() const
  {
    const double ofMeasured = this->MeanLength(this->Data.Neighbours);
    const double length = ofMeasured > 0.0 ? ofMeasured : this->MeanLength(this->Pattern);
    return length > 0.0 ? length : 1.0;
  }

  /// Of the edges between neighbours, but for those of spikes; 0 if there are none.
  double MeanLength(const SparsePattern& pattern) const
  {
    std::vector<double> lengths;
    for (Index i = this->Data.Range.Begin; i < this->Data.Range.End; ++i)
    {
      for (Index slot = pattern.Outer[i]; slot < pattern.Outer[i + 1]; ++slot)
      {
        const Index j = pattern.Inner[slot];
        if (j != i)
        {
          lengths.push_back((this->Point(i) - this->Point(j)).norm());
        }
      }
    }
    const EdgeLengths counted = MeasureEdgeLengths(lengths);
    return counted.Number > 0.0 ? counted.Sum / counted.Number : 0.0;
  }

  /// Without outliers, but for data that are constant without them, in the Euclidean norm over the
  /// channels; 0 for values that differ by round-off.
  double ValueRange() const
  {
    double squares = 0.0, squaresOfAll = 0.0, magnitude = 0.0;
    std::vector<double> known;
    for (Eigen::Index k = 0; k < this->Data.Given.cols(); ++k)
    {
      known.clear();
      ValueBounds all;
      for (Index i = this->Data.Range.Begin; i < this->Data.Range.End; ++i)
      {
        if (!this->Data.IsMissing(i))
        {
          known.push_back(this->Data.Given(i, k));
          all.Widen({ known.back(), known.back() });
        }
      }
      squares += std::pow(RobustBounds(known).Width(), 2);
      squaresOfAll += std::pow(all.Width(), 2);
      magnitude = std::max({ magnitude, std::abs(all.Low), std::abs(all.High) });
    }
    const double negligible = NoVariation * magnitude;
    const double range =
      std::sqrt(squares) > negligible ? std::sqrt(squares) : std::sqrt(squaresOfAll);
    return range > negligible ? range : 0.0;
  }

  /// The slope between the jumps of the data. noise: of a channel.
  double Slope(double noise) const
  {
    Rings rings = this->Data.MakeRings();
    std::vector<Fit> fits;
    double area = 0.0, withoutJump = 0.0;
    Points offsets;
    Values deviations;
    for (const Index i : this->Data.SampleVertices(LargestSampleOfScales))
    {
      this->ReadDisk(rings.FindDisk(i, DiskRadius), offsets, deviations);
      if (offsets.rows() >= SmallestDisk)
      {
        Fit fit = FitDisk(offsets, deviations, noise * noise);
        fit.Area = this->Data.Operators.Mesh().ControlAreas()[i];
        area += fit.Area;
        if (!fit.HasJump)
        {
          withoutJump += fit.Area;
          fits.push_back(fit);
        }
      }
    }
    if (!(withoutJump > 0.0))
    {
      return 0.0;
    }
    const double quantile = LargestQuantile * std::min(withoutJump / area / ShareWithoutJump, 1.0);
    // The squared slope that noise alone has is distributed exponentially on round disks, and less
    // narrowly on long ones: this is above its quantile.
    const double ofNoise = -1.4 * std::log(1.0 - quantile);
    for (Fit& fit : fits)
    {
      fit.SquaredSlope = std::max(fit.SquaredSlope - ofNoise * fit.Variance, 0.0);
    }
    std::sort(fits.begin(), fits.end(),
      [](const Fit& one, const Fit& other) { return one.SquaredSlope < other.SquaredSlope; });
    auto chosen = fits.begin();
    for (double below = chosen->Area; below < quantile * withoutJump && chosen + 1 != fits.end();)
    {
      below += (++chosen)->Area;
    }
    return std::sqrt(chosen->SquaredSlope);
  }

private:
  /// In the length unit of the mesh, so that products of lengths are within the range of numbers.
  Eigen::RowVector3d Point(Index i) const
  {
    const TriangleMesh& mesh = this->Data.Operators.Mesh();
    return this->Data.InputPoints.row(mesh.InputVertex()[static_cast<std::size_t>(i)]) /
      mesh.LengthUnit();
  }

  void ReadDisk(const std::vector<Index>& disk, Points& offsets, Values& deviations) const
  {
    Resize(offsets, static_cast<Eigen::Index>(disk.size()), 3);
    Resize(deviations, offsets.rows(), this->Data.Given.cols());
    Eigen::Index known = 0;
    for (const Index i : disk)
    {
      if (!this->Data.IsMissing(i))
      {
        offsets.row(known) = this->Point(i);
        deviations.row(known++) = this->Data.Given.row(i);
      }
    }
    offsets.conservativeResize(known, 3);
    deviations.conservativeResize(known, deviations.cols());
    if (known > 0)
    {
      offsets.rowwise() -= offsets.colwise().mean().eval();
      deviations.rowwise() -= deviations.colwise().mean().eval();
    }
  }

  const FitData Data;
  const SparsePattern& Pattern; ///< of the stiffness matrix
};

/// The J that a slope needs.
double ThresholdOfSlope(double slope, double edgeWidth, double length)
{
  return slope * std::max(std::sqrt(24.0 * edgeWidth * length), 2.0 * length);
}

EdgeScales FindScales(const Assembler& assembler, const SparsePattern& pattern,
  const Eigen::Ref<const Points>& points, const PointData& data, const EdgeScalesInput& input,
  VertexRange range)
{
  const Component component(assembler, pattern, points, data, range);
  const double h = component.MeanEdgeLength();
  EdgeScales scales;
  scales.Noise = input.NoiseLevel;
  double correlationLength = h;
  if (!(scales.Noise > 0.0))
  {
    const NoiseEstimate estimate = EstimateNoise(assembler, pattern, points, data, range);
    scales.Noise =
      input.NoiseGain > 0.0 ? input.NoiseGain * estimate.BetweenNeighbours : estimate.Level();
    if (estimate.BetweenNeighbours > 0.0)
    {
      correlationLength *= std::max(scales.Noise / estimate.BetweenNeighbours, 1.0);
    }
  }
  scales.Slope = component.Slope(scales.Noise);
  const double smallest = SmallestJump * component.ValueRange();
  scales.SmoothingLength = UsualLength * h;
  if (!(smallest > 0.0))
  {
    return scales;
  }
  const double noise = NoiseFactor *
    std::sqrt(static_cast<double>(data.Given.cols()) * ReferenceLength * correlationLength) *
    scales.Noise; // times 1/sqrt(L): the J that noise needs
  double length =
    std::max(std::min(std::pow(noise / smallest, 2), LongestLength * h), UsualLength * h);
  const auto thresholdOfNoise = [&](double l) { return std::max(smallest, noise / std::sqrt(l)); };
  const auto excess = [&](double l)
  { return ThresholdOfSlope(scales.Slope, input.EdgeWidth, l) - thresholdOfNoise(l); };
  if (excess(length) > 0.0)
  {
    double low = ShortestLength * h;
    double high = length;
    for (int halving = 0; halving < 40 && excess(low) < 0.0; ++halving)
    {
      const double middle = 0.5 * (low + high);
      (excess(middle) > 0.0 ? high : low) = middle;
    }
    length = low;
  }
  scales.SmoothingLength = length;
  scales.Threshold =
    std::max(thresholdOfNoise(length), ThresholdOfSlope(scales.Slope, input.EdgeWidth, length));
  return scales;
}

} // namespace

std::vector<EdgeScales> FindEdgeScales(const Assembler& assembler,
  const Eigen::Ref<const Points>& points, const PointData& data, const EdgeScalesInput& input)
{
  const std::vector<Index>& begin = assembler.Mesh().ComponentsBegin();
  const SparsePattern pattern = assembler.Pattern();
  std::vector<EdgeScales> scales;
  double largest = 0.0;
  for (std::size_t c = 0; c + 1 < begin.size(); ++c)
  {
    scales.push_back(
      FindScales(assembler, pattern, points, data, input, { begin[c], begin[c + 1] }));
    largest = std::max(largest, scales.back().Threshold);
  }
  for (EdgeScales& ofComponent : scales)
  {
    if (!(ofComponent.Threshold > 0.0)) // constant data have no edges with any
    {
      ofComponent.Threshold = largest > 0.0 ? largest : 1.0;
    }
  }
  return scales;
}

} // namespace SurfaceDiffusion
