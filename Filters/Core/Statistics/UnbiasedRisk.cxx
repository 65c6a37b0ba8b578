// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/UnbiasedRisk.h"

#include "Core/Foundation/Random.h"
#include "Core/Statistics/MeasuredVertices.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// The vertices of the range by their values, and by their places where these are equal.
std::vector<Index> SortByValues(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Values& values, VertexRange range)
{
  std::vector<Index> order(static_cast<std::size_t>(range.Size()));
  std::iota(order.begin(), order.end(), range.Begin);
  std::sort(order.begin(), order.end(),
    [&](Index a, Index b)
    {
      const auto ofA = values.row(a);
      const auto ofB = values.row(b);
      if (ofA != ofB)
      {
        return std::lexicographical_compare(ofA.begin(), ofA.end(), ofB.begin(), ofB.end());
      }
      const auto placeOfA = points.row(mesh.InputVertex()[a]);
      const auto placeOfB = points.row(mesh.InputVertex()[b]);
      return placeOfA != placeOfB ? std::lexicographical_compare(placeOfA.begin(), placeOfA.end(),
                                      placeOfB.begin(), placeOfB.end())
                                  : a < b;
    });
  return order;
}

} // namespace

Values RiskDirection(const TriangleMesh& mesh, const SparsePattern& pattern,
  const Eigen::Ref<const Points>& points, const PointData& data, VertexRange range)
{
  const auto isBetween = [&](Index i) { return data.Measured && data.Measured->IsBetween[i]; };
  const auto canChange = [&](Index i) { return !data.Fixed[i] && data.FidelityFactor(i) > 0.0; };
  Values direction = Values::Zero(data.Given.rows(), data.Given.cols());
  std::int64_t rank = 0;
  for (const Index i : SortByValues(mesh, points, data.Given, range))
  {
    if (canChange(i) && !isBetween(i))
    {
      for (Eigen::Index k = 0; k < direction.cols(); ++k)
      {
        const double sign = UniformRandom(0, k, rank) < 0.5 ? -1.0 : 1.0;
        direction(i, k) = sign / std::sqrt(data.FidelityFactor(i));
      }
      ++rank;
    }
  }
  for (Index i = range.Begin; data.Measured && i < range.End; ++i)
  {
    if (canChange(i) && isBetween(i))
    {
      double count = 0.0;
      for (Index slot = pattern.Outer[i]; slot < pattern.Outer[i + 1]; ++slot)
      {
        if (const Index j = pattern.Inner[slot]; canChange(j) && !isBetween(j))
        {
          direction.row(i) += direction.row(j);
          count += 1.0;
        }
      }
      direction.row(i) /= std::max(count, 1.0);
    }
  }
  return direction;
}

double UnbiasedRisk(const TriangleMesh& mesh, const PointData& data, const Values& u,
  const Values& uOfPerturbed, const Values& direction, double noise, VertexRange range)
{
  double sum = 0.0;
  double area = 0.0;
  for (Index i = range.Begin; i < range.End; ++i)
  {
    const double factor = data.FidelityFactor(i);
    if (factor > 0.0)
    {
      const double weight = mesh.ControlAreas()[i] * factor;
      sum += weight *
        ((u.row(i) - data.Given.row(i)).squaredNorm() +
          2.0 * noise * direction.row(i).dot(uOfPerturbed.row(i) - u.row(i)));
      area += mesh.ControlAreas()[i];
    }
  }
  return area > 0.0 ? sum / (area * static_cast<double>(u.cols())) : 0.0;
}

} // namespace SurfaceDiffusion
