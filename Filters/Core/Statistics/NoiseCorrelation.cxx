// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/NoiseCorrelation.h"

#include "Core/Statistics/LinearFit.h"
#include "Core/Statistics/NoiseLevel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index LargestSampleOfPairs = 10000;

constexpr double LargestShare = 0.5; ///< of white noise in the estimate
const double LargestOfDifferences = std::sqrt(1.0 / 3.0); ///< relative to that of sums
constexpr double LargestOfData = 0.01; ///< relative to the deviation of the data
constexpr double StandardErrors = 4.0;
constexpr double FewestPairs = 100.0; ///< for the distribution of medians
constexpr double VarianceOfLogOfMedian = 1.361; ///< of |x|, x Gaussian, times the number of samples

/// Of two residuals in white noise. Those of very small surfaces are nearly the same.
constexpr double LargestCorrelation = 0.99;

/// The residual of the cubic fit at a vertex as a combination of values, of variance 1 for white
/// noise.
class CubicResidual
{
public:
  CubicResidual(Index vertex, Rings& rings, const FitData& data)
    : Vertex(vertex)
    , Fit(FitCubicAround(vertex, rings, data))
    , Size(std::sqrt(1.0 + this->Fit.Weights.squaredNorm()))
  {
  }

  bool Exists() const { return this->Fit.Weights.size() > 0; }

  double Of(const Values& f, Eigen::Index column) const
  {
    double residual = 0.0;
    for (std::size_t j = 0; j < this->Fit.Known.size(); ++j)
    {
      residual += this->Weight(j) * (f(this->Fit.Known[j], column) - f(this->Vertex, column));
    }
    return residual / this->Size;
  }

  /// The correlation with another one in white noise.
  double CorrelationWith(const CubicResidual& other) const
  {
    double product = -this->WeightOf(other.Vertex) - other.WeightOf(this->Vertex);
    for (std::size_t j = 0; j < this->Fit.Known.size(); ++j)
    {
      product += this->Weight(j) * other.WeightOf(this->Fit.Known[j]);
    }
    return product / (this->Size * other.Size);
  }

private:
  double Weight(std::size_t j) const { return this->Fit.Weights[static_cast<Eigen::Index>(j)]; }

  /// 0 for vertices that the fit does not use.
  double WeightOf(Index vertex) const
  {
    const auto found = std::find(this->Fit.Known.begin(), this->Fit.Known.end(), vertex);
    return found == this->Fit.Known.end()
      ? 0.0
      : this->Weight(static_cast<std::size_t>(found - this->Fit.Known.begin()));
  }

  Index Vertex;
  LinearFit Fit;
  double Size;
};

double SquareDistance(Index i, Index j, const FitData& data)
{
  const std::vector<Index>& row = data.Operators.Mesh().InputVertex();
  return (data.InputPoints.row(row[static_cast<std::size_t>(i)]) -
    data.InputPoints.row(row[static_cast<std::size_t>(j)]))
    .squaredNorm();
}

/// The known vertex at one edge that is nearest; -1 if there is none.
Index NearestNeighbour(Index vertex, Rings& rings, const FitData& data)
{
  Index nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (const Index j : rings.FindRing(vertex, 1))
  {
    const double square = data.IsMissing(j) ? least : SquareDistance(vertex, j, data);
    if (square < least)
    {
      least = square;
      nearest = j;
    }
  }
  return nearest;
}

/// Sets OfCubicFits, OfSums, OfDifferences and NumberOfPairs.
void MeasureResiduals(const FitData& data, NeighbourVariation& variation)
{
  const Eigen::Index columns = data.Given.cols();
  const Eigen::RowVectorXd roundOff = RoundOffOf(data);
  Rings rings = data.MakeRings();
  Flags used = data.Missing;
  RobustDeviations single(columns);
  RobustDeviations sums(columns);
  RobustDeviations differences(columns);
  for (const Index i : data.SampleVertices(LargestSampleOfPairs))
  {
    const Index j = used[i] ? -1 : NearestNeighbour(i, rings, data);
    if (j < 0 || used[j])
    {
      continue;
    }
    const CubicResidual ofI(i, rings, data);
    const CubicResidual ofJ(j, rings, data);
    if (!ofI.Exists() || !ofJ.Exists())
    {
      continue;
    }
    const double correlation = ofI.CorrelationWith(ofJ);
    if (std::abs(correlation) > LargestCorrelation)
    {
      continue;
    }
    used[i] = true;
    used[j] = true;
    variation.NumberOfPairs += 1.0;
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      const double ri = ofI.Of(data.Given, k);
      const double rj = ofJ.Of(data.Given, k);
      if (std::abs(ri) > roundOff[k] || std::abs(rj) > roundOff[k])
      {
        single.Add(k, std::abs(ri));
        sums.Add(k, std::abs(ri + rj) / std::sqrt(2.0 + 2.0 * correlation));
        differences.Add(k, std::abs(ri - rj) / std::sqrt(2.0 - 2.0 * correlation));
      }
    }
  }
  variation.OfCubicFits = single.RootMeanSquare(variation.NumberOfPairs);
  variation.OfSums = sums.RootMeanSquare(variation.NumberOfPairs);
  variation.OfDifferences = differences.RootMeanSquare(variation.NumberOfPairs);
}

/// Sets Deviation and Width.
void MeasureValues(const FitData& data, NeighbourVariation& variation)
{
  Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(data.Given.cols());
  double count = 0.0;
  double edges = 0.0;
  double squareDifferences = 0.0;
  double squareLengths = 0.0;
  Rings rings = data.MakeRings();
  for (Index i = data.Range.Begin; i < data.Range.End; ++i)
  {
    if (data.IsMissing(i))
    {
      continue;
    }
    mean += data.Given.row(i);
    count += 1.0;
    for (const Index j : rings.FindRing(i, 1))
    {
      if (j > i && !data.IsMissing(j))
      {
        edges += 1.0;
        squareDifferences += (data.Given.row(j) - data.Given.row(i)).squaredNorm();
        squareLengths += SquareDistance(i, j, data);
      }
    }
  }
  if (count == 0.0 || edges == 0.0)
  {
    return;
  }
  mean /= count;
  double squares = 0.0;
  for (Index i = data.Range.Begin; i < data.Range.End; ++i)
  {
    squares += data.IsMissing(i) ? 0.0 : (data.Given.row(i) - mean).squaredNorm();
  }
  variation.Deviation = std::sqrt(squares / (count * static_cast<double>(data.Given.cols())));
  variation.Width =
    WidthOfCorrelation(squareDifferences / edges, squares / count, squareLengths / edges);
}

} // namespace

double WidthOfCorrelation(double squareDifference, double variance, double squareDistance)
{
  const double uncorrelated = squareDifference / (2.0 * variance); // see estimate_fwhm() in Python
  return uncorrelated > 0.0 && uncorrelated < 1.0
    ? std::sqrt(2.0 * std::log(2.0) * squareDistance / -std::log1p(-uncorrelated))
    : 0.0;
}

bool NeighbourVariation::IsSmooth() const
{
  const double white =
    std::exp(-StandardErrors * std::sqrt(2.0 * VarianceOfLogOfMedian / this->NumberOfPairs));
  if (this->NumberOfPairs < FewestPairs)
  {
    return false;
  }
  const double whiteAtMost = std::min(this->OfCubicFits, this->OfDifferences);
  return whiteAtMost < std::min(LargestShare, white) * this->OfLinearFits &&
    (this->OfDifferences < std::min(LargestOfDifferences, white) * this->OfSums ||
      whiteAtMost < LargestOfData * this->Deviation);
}

NeighbourVariation MeasureVariation(const Assembler& assembler,
  const Eigen::Ref<const Points>& points, const PointData& given, double ofLinearFits)
{
  NeighbourVariation variation;
  variation.OfLinearFits = ofLinearFits;
  const SparsePattern pattern = assembler.Pattern();
  FitData data(assembler, pattern, points, given, { 0, assembler.Mesh().NumberOfVertices() });
  data.Missing = !FindVaryingVertices(assembler, given);
  if (data.Given.rows() > 0)
  {
    MeasureResiduals(data, variation);
    MeasureValues(data, variation);
  }
  return variation;
}

} // namespace SurfaceDiffusion
