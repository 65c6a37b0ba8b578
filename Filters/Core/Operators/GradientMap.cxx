// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/GradientMap.h"

#include "Core/Operators/CotanWeights.h"

namespace SurfaceDiffusion
{

std::vector<GradientMap> PlainGradients(const TriangleMesh& mesh, const ParallelFor& parallel)
{
  std::vector<GradientMap> maps(mesh.NumberOfTriangles());
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const TriangleMesh::Shape& s = mesh.Shapes()[t];
      maps[t] = { Gradient(s, 0.0, 1.0, 0.0), Gradient(s, 0.0, 0.0, 1.0) };
    });
  return maps;
}

std::vector<GradientMap> StretchedGradients(const TriangleMesh& mesh,
  const Eigen::Ref<const TangentVectors>& frames, double along, double across,
  const ParallelFor& parallel)
{
  std::vector<GradientMap> maps = PlainGradients(mesh, parallel);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const bool directed = HasDirection(frames, t);
      const Eigen::Vector2d e1 = frames.row(t);
      const auto stretch = [&](const Eigen::Vector2d& v) -> Eigen::Vector2d
      {
        if (!directed)
        {
          return IsotropicMean(along, across) * v;
        }
        return across * v + ((along - across) * e1.dot(v)) * e1;
      };
      maps[t] = { stretch(maps[t].First), stretch(maps[t].Second) };
    });
  return maps;
}

} // namespace SurfaceDiffusion
