// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/NoiseLevel.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

double EstimateNoiseLevel(const Assembler& assembler, const PointData& data)
{
  const SparseMatrix& pattern = assembler.Pattern();
  const Index n = static_cast<Index>(pattern.rows());
  const Index* outer = pattern.outerIndexPtr();
  const Index* inner = pattern.innerIndexPtr();
  double variance = 0.0;
  std::vector<double> deviations;
  for (Eigen::Index k = 0; k < data.Given.cols(); ++k)
  {
    deviations.clear();
    for (Index i = 0; i < n; ++i)
    {
      const Index valence = outer[i + 1] - outer[i] - 1;
      double sum = 0.0;
      bool known = valence > 0;
      for (Index slot = outer[i]; slot < outer[i + 1] && known; ++slot)
      {
        known = !data.Missing[inner[slot]];
        sum += data.Given(inner[slot], k);
      }
      if (known)
      {
        const double mean = (sum - data.Given(i, k)) / valence;
        deviations.push_back(std::abs(data.Given(i, k) - mean) / std::sqrt(1.0 + 1.0 / valence));
      }
    }
    if (!deviations.empty())
    {
      const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
      std::nth_element(deviations.begin(), middle, deviations.end());
      variance += std::pow(1.4826 * *middle, 2) / static_cast<double>(data.Given.cols());
    }
  }
  return std::sqrt(variance);
}

double Discrepancy(const TriangleMesh& mesh, const PointData& data, const Values& u)
{
  double sum = 0.0;
  double area = 0.0;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    if (!data.Missing[i])
    {
      sum += mesh.ControlAreas()[i] * (u.row(i) - data.Given.row(i)).squaredNorm();
      area += mesh.ControlAreas()[i];
    }
  }
  return area > 0.0 ? std::sqrt(sum / (area * static_cast<double>(u.cols()))) : 0.0;
}

double FindFidelityByDiscrepancy(
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
      return std::exp(b);
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
  return std::exp(b);
}

} // namespace SurfaceDiffusion
