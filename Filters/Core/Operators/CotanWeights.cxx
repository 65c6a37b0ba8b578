// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CotanWeights.h"

namespace SurfaceDiffusion
{

CornerWeights CotanWeights(const TriangleMesh& mesh, const ParallelFor& parallel)
{
  CornerWeights c(mesh.NumberOfTriangles(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const TriangleMesh::Shape& s = mesh.Shapes()[t];
      // The cotangent of an angle is the cosine over the sine of its two edges.
      const double half = 0.5 * s.Weight;
      c(t, 0) = half * s.X / s.Y;
      c(t, 1) = half * (s.Length - s.X) / s.Y;
      c(t, 2) = half * (s.Y / s.Length - (s.X / s.Y) * ((s.Length - s.X) / s.Length));
    });
  return c;
}

CornerWeights DirectionalWeights(const TriangleMesh& mesh,
  const Eigen::Ref<const TangentVectors>& frames, const ParallelFor& parallel)
{
  CornerWeights c(mesh.NumberOfTriangles(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const TriangleMesh::Shape& s = mesh.Shapes()[t];
      const double d1 = frames.row(t).dot(Gradient(s, 0.0, 1.0, 0.0)); // grad(phi_1) . e1
      const double d2 = frames.row(t).dot(Gradient(s, 0.0, 0.0, 1.0));
      const double d0 = -d1 - d2;
      const double area = s.Area();
      c(t, 0) = -area * d1 * d2;
      c(t, 1) = -area * d2 * d0;
      c(t, 2) = -area * d0 * d1;
    });
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
  CornerWeights c = DirectionalWeights(mesh, frames, parallel);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      c.row(t) =
        AnisotropicWeights(HasDirection(frames, t), isotropic.row(t), c.row(t), g1[t], g2[t]);
    });
  return c;
}

} // namespace SurfaceDiffusion
