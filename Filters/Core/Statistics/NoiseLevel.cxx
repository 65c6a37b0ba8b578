// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/NoiseLevel.h"

#include "Core/Statistics/LinearFit.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index LargestSample = 20000;
constexpr int FarthestRing = 8;
/// Twice as far apart, the residuals of a smooth signal are up to four times as large, and grow
/// faster with every ring. Those of noise that heat flow has smoothed grow less with every ring.
constexpr double MostGrowth = 3.0;
constexpr double SettledGrowth = 1.3; ///< at the farthest ring

/// That of the residual of a fit at vertex i to noise of the variances 1/w of fidelity factors; no
/// factors: 1.
double DeviationOfResidual(Index i, const LinearFit& fit, const Vector& factors)
{
  if (factors.size() == 0)
  {
    return std::sqrt(1.0 + fit.Weights.squaredNorm());
  }
  double variance = 1.0 / factors[i];
  for (std::size_t j = 0; j < fit.Known.size(); ++j)
  {
    variance += std::pow(fit.Weights[static_cast<Eigen::Index>(j)], 2) / factors[fit.Known[j]];
  }
  return std::sqrt(variance);
}

/// The estimate from the vertices at a distance of `edges` edges, of which there are enough around
/// `count` vertices.
double EstimateAt(int edges, const FitData& data, const Vector& factors,
  const NoisyCoordinates& coordinates, double& count)
{
  const Eigen::Index columns = data.Given.cols();
  Rings rings = data.MakeRings();
  const Eigen::RowVectorXd roundOff = RoundOffOf(data);
  RobustDeviations deviations(coordinates
      ? coordinates(data.Range.Begin, Eigen::RowVectorXd::Zero(columns)).size()
      : columns);
  Eigen::RowVectorXd residuals(columns);
  count = 0.0;
  for (const Index i : data.SampleVertices(LargestSample))
  {
    if (data.IsMissing(i))
    {
      continue;
    }
    const LinearFit fit = FitAround(i, edges, rings, data);
    const std::vector<Index>& known = fit.Known;
    const Vector& weights = fit.Weights;
    if (weights.size() == 0)
    {
      continue;
    }
    count += 1.0;
    const double deviation = DeviationOfResidual(i, fit, factors);
    bool varies = false;
    const auto add = [&](Eigen::Index k, double residual)
    { deviations.Add(k, std::abs(residual) / deviation); };
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      double residual = 0.0;
      varies = coordinates && varies;
      for (std::size_t j = 0; j < known.size(); ++j)
      {
        const double difference = data.Given(known[j], k) - data.Given(i, k);
        residual += weights[static_cast<Eigen::Index>(j)] * difference;
        varies = varies || std::abs(difference) > roundOff[k];
      }
      residuals[k] = residual;
      if (varies && !coordinates)
      {
        add(k, residual);
      }
    }
    if (varies && coordinates)
    {
      const Eigen::RowVectorXd noisy = coordinates(i, residuals);
      for (Eigen::Index k = 0; k < noisy.size(); ++k)
      {
        add(k, noisy[k]);
      }
    }
  }
  return deviations.RootMeanSquare(count);
}

/// See FindVaryingVertices(). Per vertex of the range.
Flags FindVarying(const FitData& data)
{
  const SparsePattern& pattern = data.Neighbours;
  const Index first = data.Range.Begin;
  const Index n = data.Range.Size();
  const Eigen::RowVectorXd roundOff = RoundOffOf(data);
  const auto anyNeighbour = [&](Index i, const auto& holds)
  {
    bool found = false;
    for (Index slot = pattern.Outer[i]; slot < pattern.Outer[i + 1] && !found; ++slot)
    {
      const Index j = pattern.Inner[slot];
      found = j != i && !data.IsMissing(j) && holds(j);
    }
    return found;
  };
  Flags constant = Flags::Constant(n, false);
  for (Index i = first; i < data.Range.End; ++i)
  {
    constant[i - first] = !data.IsMissing(i) && anyNeighbour(i, [](Index) { return true; }) &&
      !anyNeighbour(i,
        [&](Index j) {
          return ((data.Given.row(j) - data.Given.row(i)).cwiseAbs().array() > roundOff.array())
            .any();
        });
  }
  Flags varying = Flags::Constant(n, false);
  for (Index i = first; i < data.Range.End; ++i)
  {
    varying[i - first] = !data.IsMissing(i) && !constant[i - first] &&
      !anyNeighbour(i, [&](Index j) { return constant[j - first] != 0; });
  }
  const auto outside = (!data.Missing && !constant).count();
  return 3 * varying.count() < outside ? Flags(Flags::Constant(n, false)) : varying;
}

VertexRange AllVertices(const Assembler& assembler)
{
  return { 0, assembler.Mesh().NumberOfVertices() };
}

} // namespace

Flags FindVaryingVertices(const Assembler& assembler, const PointData& data)
{
  return FindVaryingVertices(assembler, assembler.Pattern(), data, AllVertices(assembler));
}

Flags FindVaryingVertices(const Assembler& assembler, const SparsePattern& pattern,
  const PointData& data, VertexRange range)
{
  const Points none;
  return FindVarying({ assembler, pattern, none, data, range });
}

NoiseEstimate EstimateNoise(
  const Assembler& assembler, const Eigen::Ref<const Points>& points, const PointData& data)
{
  return EstimateNoise(assembler, assembler.Pattern(), points, data, AllVertices(assembler));
}

NoiseEstimate EstimateNoise(const Assembler& assembler, const SparsePattern& pattern,
  const Eigen::Ref<const Points>& points, const PointData& given, VertexRange range,
  bool isOfFactorOne, const NoisyCoordinates& coordinates)
{
  const Vector none;
  const Vector& factors = isOfFactorOne ? given.FidelityFactors : none;
  FitData data(assembler, pattern, points, given, range);
  const bool anyKnown = !data.Missing.all();
  data.Missing = !FindVarying(data);
  NoiseEstimate estimate;
  double count = 0.0;
  estimate.BetweenNeighbours = EstimateAt(1, data, factors, coordinates, count);
  estimate.IsUndetermined = count == 0.0 && !(anyKnown && data.Missing.all());
  estimate.Apart = estimate.BetweenNeighbours;
  double apart = estimate.BetweenNeighbours;
  double growth = MostGrowth;
  for (int edges = 2; edges <= FarthestRing && apart > 0.0; edges *= 2)
  {
    const double next = EstimateAt(edges, data, factors, coordinates, count);
    if (next <= NoiseEstimate::CorrelatedGrowth * apart)
    {
      estimate.Apart = apart;
      return estimate;
    }
    if (next > growth * apart)
    {
      return estimate;
    }
    growth = next / apart;
    apart = next;
  }
  if (growth < SettledGrowth)
  {
    estimate.Apart = apart;
  }
  return estimate;
}

double ExpectedEstimate(const Assembler& assembler, const Eigen::Ref<const Points>& points,
  const PointData& given,
  const std::function<double(const std::vector<Index>&, const Vector&)>& deviationOf)
{
  const SparsePattern pattern = assembler.Pattern();
  const FitData data(assembler, pattern, points, given, AllVertices(assembler));
  Rings rings = data.MakeRings();
  std::vector<double> deviations; // of the residuals
  double largest = 0.0;
  for (const Index i : data.SampleVertices(LargestSample))
  {
    LinearFit fit = data.IsMissing(i) ? LinearFit() : FitAround(i, 1, rings, data);
    if (fit.Weights.size() > 0)
    {
      Vector weights(fit.Weights.size() + 1);
      weights << fit.Weights, -fit.Weights.sum();
      fit.Known.push_back(i);
      deviations.push_back(
        deviationOf(fit.Known, weights) / std::sqrt(1.0 + fit.Weights.squaredNorm()));
      largest = std::max(largest, deviations.back());
    }
  }
  // The median of the absolute values of Gaussian numbers of these deviations.
  double low = 0.0;
  double high = largest;
  for (int halving = 0; halving < 50; ++halving)
  {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    for (const double deviation : deviations)
    {
      below += deviation > 0.0 ? std::erf(middle / (std::sqrt(2.0) * deviation)) : 1.0;
    }
    (2.0 * below < static_cast<double>(deviations.size()) ? low : high) = middle;
  }
  return GaussianFactor * high;
}

double Discrepancy(const TriangleMesh& mesh, const PointData& data, const Values& u)
{
  return Discrepancy(mesh, data, u, { 0, mesh.NumberOfVertices() });
}

double Discrepancy(
  const TriangleMesh& mesh, const PointData& data, const Values& u, VertexRange range)
{
  double sum = 0.0;
  double area = 0.0;
  for (Index i = range.Begin; i < range.End; ++i)
  {
    const double factor = data.FidelityFactor(i);
    if (factor > 0.0)
    {
      sum += mesh.ControlAreas()[i] * factor * (u.row(i) - data.Given.row(i)).squaredNorm();
      area += mesh.ControlAreas()[i];
    }
  }
  return area > 0.0 ? std::sqrt(sum / (area * static_cast<double>(u.cols()))) : 0.0;
}

} // namespace SurfaceDiffusion
