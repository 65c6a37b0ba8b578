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

/// The estimate from the vertices at a distance of `edges` edges, of which there are enough around
/// `count` vertices.
double EstimateAt(int edges, const FitData& data, double& count)
{
  const Eigen::Index columns = data.Given.cols();
  Rings rings = data.MakeRings();
  const Eigen::RowVectorXd roundOff = RoundOffOf(data);
  RobustDeviations deviations(columns);
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
    count += weights.size() > 0 ? 1.0 : 0.0;
    for (Eigen::Index k = 0; k < columns && weights.size() > 0; ++k)
    {
      double residual = 0.0;
      bool varies = false;
      for (std::size_t j = 0; j < known.size(); ++j)
      {
        const double difference = data.Given(known[j], k) - data.Given(i, k);
        residual += weights[static_cast<Eigen::Index>(j)] * difference;
        varies = varies || std::abs(difference) > roundOff[k];
      }
      if (varies)
      {
        deviations.Add(k, std::abs(residual) / std::sqrt(1.0 + weights.squaredNorm()));
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
  const Points none;
  const SparsePattern pattern = assembler.Pattern();
  return FindVarying({ assembler, pattern, none, data, AllVertices(assembler) });
}

NoiseEstimate EstimateNoise(
  const Assembler& assembler, const Eigen::Ref<const Points>& points, const PointData& data)
{
  return EstimateNoise(assembler, assembler.Pattern(), points, data, AllVertices(assembler));
}

NoiseEstimate EstimateNoise(const Assembler& assembler, const SparsePattern& pattern,
  const Eigen::Ref<const Points>& points, const PointData& given, VertexRange range)
{
  FitData data(assembler, pattern, points, given, range);
  const bool anyKnown = !data.Missing.all();
  data.Missing = !FindVarying(data);
  NoiseEstimate estimate;
  double count = 0.0;
  estimate.BetweenNeighbours = EstimateAt(1, data, count);
  estimate.IsUndetermined = count == 0.0 && !(anyKnown && data.Missing.all());
  estimate.Apart = estimate.BetweenNeighbours;
  double apart = estimate.BetweenNeighbours;
  double growth = MostGrowth;
  for (int edges = 2; edges <= FarthestRing && apart > 0.0; edges *= 2)
  {
    const double next = EstimateAt(edges, data, count);
    if (next <= 1.15 * apart)
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

double Discrepancy(const TriangleMesh& mesh, const PointData& data, const Values& u)
{
  double sum = 0.0;
  double area = 0.0;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const double weight = mesh.ControlAreas()[i] * data.FidelityFactor(i);
    if (weight > 0.0)
    {
      sum += weight * (u.row(i) - data.Given.row(i)).squaredNorm();
      area += weight;
    }
  }
  return area > 0.0 ? std::sqrt(sum / (area * static_cast<double>(u.cols()))) : 0.0;
}

FidelityChoice FindFidelityByDiscrepancy(
  const std::function<double(double)>& discrepancy, double noiseLevel, double start)
{
  // Bracket the root in log(lambda) by factors of 4, then regula falsi (Illinois) inside.
  const auto excess = [&](double x) { return discrepancy(std::exp(x)) - noiseLevel; };
  const double limit = std::log(1e8);
  const double origin = std::log(start);
  double a = origin;
  double fa = excess(a);
  const double stride = fa > 0.0 ? std::log(4.0) : -std::log(4.0);
  double b = a;
  double fb = fa;
  while (fa * fb > 0.0)
  {
    if (std::abs(b - origin) > limit)
    {
      return { std::exp(b), fb + noiseLevel, false };
    }
    a = b;
    fa = fb;
    b += stride;
    fb = excess(b);
  }
  while (std::abs(b - a) > 0.01 && fa != fb)
  {
    const double x = (a * fb - b * fa) / (fb - fa);
    const double fx = excess(x);
    if (fx * fb <= 0.0)
    {
      a = b;
      fa = fb;
    }
    else
    {
      fa *= 0.5; // the same end twice: pull the other one in
    }
    const bool close = std::abs(x - b) < 0.01;
    b = x;
    fb = fx;
    if (close || fb == 0.0)
    {
      break;
    }
  }
  return { std::exp(b), fb + noiseLevel, true };
}

} // namespace SurfaceDiffusion
