// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CotanWeights.h"

namespace SurfaceDiffusion
{

CornerWeights CotanWeights(const TriangleMesh& mesh, const ParallelFor& parallel)
{
  CornerWeights c(mesh.NumberOfTriangles(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t) { c.row(t) = CotanWeights(mesh.Shapes()[t]); });
  return c;
}

CornerWeights DirectionalWeights(const TriangleMesh& mesh,
  const Eigen::Ref<const TangentVectors>& frames, const ParallelFor& parallel)
{
  CornerWeights c(mesh.NumberOfTriangles(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t) { c.row(t) = DirectionalWeights(mesh.Shapes()[t], frames(t, 0), frames(t, 1)); });
  return c;
}

CornerWeights AnisotropicWeights(const TriangleMesh& mesh, const CornerWeights& isotropic,
  const Eigen::Ref<const TangentVectors>& frames, double g1, double g2, const ParallelFor& parallel)
{
  return AnisotropicWeights(mesh, isotropic, frames, Vector::Constant(mesh.NumberOfTriangles(), g1),
    Vector::Constant(mesh.NumberOfTriangles(), g2), parallel);
}

CornerWeights AnisotropicWeights(const TriangleMesh& mesh, const CornerWeights& isotropic,
  const Eigen::Ref<const TangentVectors>& frames, const Eigen::Ref<const Vector>& g1,
  const Eigen::Ref<const Vector>& g2, const ParallelFor& parallel)
{
  CornerWeights c(mesh.NumberOfTriangles(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const TriangleMesh::Shape s = mesh.Shapes()[t];
      c.row(t) = AnisotropicWeights(HasDirection(frames, t), isotropic.row(t),
        DirectionalWeights(s, frames(t, 0), frames(t, 1)),
        DirectionalWeights(s, -frames(t, 1), frames(t, 0)), g1[t], g2[t]);
    });
  return c;
}

} // namespace SurfaceDiffusion
