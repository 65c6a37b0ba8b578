// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/Seams.h"

#include "Core/Surface/SideLengths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

Seams FindSeams(const TriangleMesh& mesh, const Points& points)
{
  const std::vector<Index>& boundary = mesh.BoundaryVertices();
  const auto distance = [&](Index i, Index j)
  { return (points.row(mesh.InputVertex()[i]) - points.row(mesh.InputVertex()[j])).stableNorm(); };

  constexpr double share = 1e-3;
  Vector reach = Vector::Zero(boundary.empty() ? 0 : mesh.NumberOfVertices()); // 0 inside
  for (const Index i : boundary)
  {
    reach[i] = std::numeric_limits<double>::infinity();
  }
  for (Index t = 0; t < (boundary.empty() ? 0 : mesh.NumberOfTriangles()); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Index i = mesh.TriangleVertices()(t, a);
      const Index j = mesh.TriangleVertices()(t, Next(a));
      if (reach[i] > 0.0 || reach[j] > 0.0)
      {
        const double length = share * distance(i, j);
        reach[i] = std::min(reach[i], length);
        reach[j] = std::min(reach[j], length);
      }
    }
  }

  // Those that are near one another are near in their order along any line; few others are along
  // one that no axis and no plane of usual shapes is perpendicular to.
  const Eigen::RowVector3d line(0.529, 0.623, 0.577);
  std::vector<std::pair<double, Index>> order;
  order.reserve(boundary.size());
  for (const Index i : boundary)
  {
    order.emplace_back(points.row(mesh.InputVertex()[i]).dot(line), i);
  }
  std::sort(order.begin(), order.end());
  Seams found;
  std::vector<char> coincides(order.size(), 0);
  for (std::size_t k = 0; k < order.size(); ++k)
  {
    const auto [place, i] = order[k];
    constexpr int enough = 16; // at the apex of a cone of separate triangles there may be thousands
    int others = 0;
    for (std::size_t l = k + 1;
         others < enough && l < order.size() && order[l].first - place <= reach[i]; ++l)
    {
      const Index j = order[l].second;
      const double apart = distance(i, j);
      if (apart <= std::min(reach[i], reach[j]))
      {
        ++others;
        coincides[k] = coincides[l] = 1;
        found.Distance = std::max(found.Distance, apart);
      }
    }
  }
  if (found.Distance > 0.0)
  {
    const double digit = std::pow(10.0, std::floor(std::log10(found.Distance)));
    found.Distance = digit * std::ceil(found.Distance / digit);
  }
  found.NumberOfVertices = static_cast<Index>(std::count(coincides.begin(), coincides.end(), 1));
  return found;
}

} // namespace SurfaceDiffusion
