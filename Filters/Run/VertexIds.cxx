// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fields: the numbers of vertices in random numbers.

#include "Core/Foundation/Random.h"
#include "Run/Fields.h"

#include <algorithm>

namespace SurfaceDiffusion
{

std::vector<std::int64_t> MakeVertexIds(const Surface& surface, const Fields& fields, double h)
{
  const TriangleMesh& mesh = surface.Mesh();
  const std::vector<Index>& points = mesh.InputVertex();
  std::vector<std::int64_t> ids(static_cast<std::size_t>(mesh.NumberOfVertices()));
  if (fields.MakeIds)
  {
    const std::vector<std::int64_t> ofPoints = fields.MakeIds();
    std::transform(points.begin(), points.end(), ids.begin(),
      [&](Index point) { return ofPoints[static_cast<std::size_t>(point)]; });
    return ids;
  }
  ids = IdsOfPlaces(
    ids.size(),
    [&](std::size_t v, double* x) { std::copy_n(&surface.Points()(points[v], 0), 3, x); },
    NoiseGrid(h));
  // At interfaces the places of pieces may differ, and the points nearby as well.
  Vector numbers(static_cast<Eigen::Index>(ids.size()));
  std::copy(ids.begin(), ids.end(), numbers.data());
  mesh.GetReduction().UpdateFromOwners(numbers);
  std::transform(numbers.data(), numbers.data() + numbers.size(), ids.begin(),
    [](double number) { return static_cast<std::int64_t>(number); });
  return ids;
}

} // namespace SurfaceDiffusion
