// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/Stl.h"

#include "Core/Geometry/OpenEdges.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace SurfaceDiffusion::Files
{

void JoinSeams(SurfaceFile& file)
{
  const auto isFinite = [](double x) { return std::isfinite(x); };
  if (!std::all_of(file.Points.begin(), file.Points.end(), isFinite))
  {
    return;
  }
  const auto count = static_cast<Eigen::Index>(file.NumberOfPoints());
  const Points points = Eigen::Map<const Points>(file.Points.data(), count, 3);
  Triangles triangles(static_cast<Eigen::Index>(file.Corners.size() / 3), 3);
  std::transform(file.Corners.begin(), file.Corners.begin() + triangles.size(), triangles.data(),
    [](std::int64_t corner) { return static_cast<Index>(corner); });
  const std::vector<Index> pointOf =
    JoinOpenEdges(points, triangles, DefaultWeldTolerance(points, triangles));
  double apart = 0.0;
  std::vector<std::int64_t> fresh(pointOf.size(), -1);
  std::vector<double> kept;
  for (std::size_t i = 0; i < pointOf.size(); ++i)
  {
    const auto row = static_cast<Eigen::Index>(i);
    apart = std::max(apart, (points.row(row) - points.row(pointOf[i])).norm());
    if (pointOf[i] == static_cast<Index>(i))
    {
      fresh[i] = static_cast<std::int64_t>(kept.size() / 3);
      kept.insert(kept.end(), points.row(row).begin(), points.row(row).end());
    }
  }
  if (apart == 0.0)
  {
    return;
  }
  for (std::int64_t& corner : file.Corners)
  {
    corner = fresh[static_cast<std::size_t>(pointOf[static_cast<std::size_t>(corner)])];
  }
  file.Points = std::move(kept);
  char number[32];
  std::snprintf(number, sizeof(number), "%.2g", apart);
  file.Warnings.push_back(
    std::string("corners of facets up to ") + number + " apart, at open edges, are joined");
}

} // namespace SurfaceDiffusion::Files
