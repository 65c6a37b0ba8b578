// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/NoiseLevel.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

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

/// The vertices at a distance of a number of edges.
class Rings
{
public:
  explicit Rings(const SparsePattern& pattern)
    : Outer(pattern.Outer.data())
    , Inner(pattern.Inner.data())
    , VisitedBy(static_cast<std::size_t>(pattern.NumberOfRows()), -1)
  {
  }

  const std::vector<Index>& Find(Index centre, int edges)
  {
    this->Ring.assign(1, centre);
    this->VisitedBy[centre] = centre; // each centre is asked for once
    for (int edge = 0; edge < edges; ++edge)
    {
      this->Next.clear();
      for (const Index i : this->Ring)
      {
        for (Index slot = this->Outer[i]; slot < this->Outer[i + 1]; ++slot)
        {
          const Index j = this->Inner[slot];
          if (this->VisitedBy[j] != centre)
          {
            this->VisitedBy[j] = centre;
            this->Next.push_back(j);
          }
        }
      }
      this->Ring.swap(this->Next);
    }
    return this->Ring;
  }

private:
  const Index* Outer;
  const Index* Inner;
  std::vector<Index> VisitedBy, Ring, Next;
};

/// The weights of the values at `offsets` in the linear fit at the origin, in the plane of the
/// offsets; none if they do not determine one.
Vector WeightsOfFit(const Eigen::Ref<const Points>& offsets)
{
  if (offsets.rows() < 3)
  {
    return Vector();
  }
  const Eigen::Matrix3d spread = offsets.transpose() * offsets;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const double size = std::sqrt(axes.eigenvalues()[2]);
  if (!(axes.eigenvalues()[1] > 1e-6 * axes.eigenvalues()[2]) || !(size > 0.0))
  {
    return Vector();
  }
  Eigen::Matrix<double, Eigen::Dynamic, 3> basis(offsets.rows(), 3);
  basis.col(0).setOnes();
  basis.rightCols(2) = offsets * axes.eigenvectors().rightCols(2) / size;
  const Eigen::Matrix3d normal = basis.transpose() * basis;
  const Eigen::Vector3d one = normal.ldlt().solve(Eigen::Vector3d::UnitX());
  const Vector weights = basis * one;
  return std::abs(weights.sum() - 1.0) < 1e-6 ? weights : Vector();
}

double MedianDeviation(std::vector<double>& deviations)
{
  if (deviations.empty())
  {
    return 0.0;
  }
  const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
  std::nth_element(deviations.begin(), middle, deviations.end());
  return 1.4826 * *middle;
}

/// The estimate from the vertices at a distance of `edges` edges.
double EstimateAt(int edges, const Assembler& assembler, const Eigen::Ref<const Points>& points,
  const PointData& data)
{
  const std::vector<Index>& row = assembler.Mesh().InputVertex();
  const Index n = assembler.Mesh().NumberOfVertices();
  const Eigen::Index columns = data.Given.cols();
  const Index stride = 1 + n / LargestSample;
  Rings rings(assembler.Pattern());
  std::vector<std::vector<double>> deviations(static_cast<std::size_t>(columns));
  std::vector<Index> known;
  Points offsets;
  for (Index i = 0; i < n; i += stride)
  {
    if (data.Missing[i])
    {
      continue;
    }
    known.clear();
    for (const Index j : rings.Find(i, edges))
    {
      if (!data.Missing[j])
      {
        known.push_back(j);
      }
    }
    offsets.resize(static_cast<Eigen::Index>(known.size()), 3);
    for (std::size_t j = 0; j < known.size(); ++j)
    {
      offsets.row(static_cast<Eigen::Index>(j)) =
        points.row(row[static_cast<std::size_t>(known[j])]) -
        points.row(row[static_cast<std::size_t>(i)]);
    }
    const Vector weights = WeightsOfFit(offsets);
    for (Eigen::Index k = 0; k < columns && weights.size() > 0; ++k)
    {
      double residual = 0.0;
      for (std::size_t j = 0; j < known.size(); ++j)
      {
        residual +=
          weights[static_cast<Eigen::Index>(j)] * (data.Given(known[j], k) - data.Given(i, k));
      }
      deviations[static_cast<std::size_t>(k)].push_back(
        std::abs(residual) / std::sqrt(1.0 + weights.squaredNorm()));
    }
  }
  double variance = 0.0;
  for (std::vector<double>& ofColumn : deviations)
  {
    variance += std::pow(MedianDeviation(ofColumn), 2) / static_cast<double>(columns);
  }
  return std::sqrt(variance);
}

} // namespace

NoiseEstimate EstimateNoise(
  const Assembler& assembler, const Eigen::Ref<const Points>& points, const PointData& data)
{
  NoiseEstimate estimate;
  estimate.BetweenNeighbours = EstimateAt(1, assembler, points, data);
  estimate.Apart = estimate.BetweenNeighbours;
  double apart = estimate.BetweenNeighbours;
  double growth = MostGrowth;
  for (int edges = 2; edges <= FarthestRing && apart > 0.0; edges *= 2)
  {
    const double next = EstimateAt(edges, assembler, points, data);
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
