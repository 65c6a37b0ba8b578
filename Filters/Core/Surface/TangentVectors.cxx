// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/TangentVectors.h"

#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

using Row3 = Eigen::RowVector3d;

/// The unit vector along d for d of any size, or zero if d is zero or not finite.
Row3 Direction(const Row3& d)
{
  const double size = d.cwiseAbs().maxCoeff();
  return std::isfinite(size) && size > 0.0 ? Row3((d / size).normalized()) : Row3(Row3::Zero());
}

/// Main axes of the tensors tensorOf(input triangle), projected into the triangles.
template <typename TensorOf>
TangentVectors MainAxes(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const ParallelFor& parallel,
  const TensorOf& tensorOf)
{
  // Of d d^T for a vector d that is normal to the triangle, round-off alone lies in its plane.
  constexpr double roundOff = 1e-16;
  TangentVectors lines(mesh.NumberOfTriangles(), 2);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const auto axes = TriangleAxes(mesh, points, triangles, t);
      const Eigen::Matrix3d tensor = tensorOf(mesh.InputTriangle()[t]);
      const Eigen::Matrix2d plane = axes.transpose() * tensor * axes;
      lines.row(t) = plane.trace() > roundOff * tensor.trace()
        ? MainAxis(plane(0, 0), 0.5 * (plane(0, 1) + plane(1, 0)), plane(1, 1))
        : Eigen::RowVector2d(Eigen::RowVector2d::Zero());
    });
  return lines;
}

} // namespace

Eigen::Matrix<double, 3, 2> TriangleAxes(const TriangleMesh& mesh,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles, Index t)
{
  const Index input = mesh.InputTriangle()[t];
  const auto corner = [&](int a) -> Row3 { return points.row(triangles(input, a)); };
  const Row3 e1 = (corner(1) - corner(0)) / mesh.LengthUnit();
  const Row3 e2 = (corner(2) - corner(0)) / mesh.LengthUnit();
  const Row3 x = e1.normalized();
  const Row3 y = (e2 - e2.dot(x) * x).normalized();
  Eigen::Matrix<double, 3, 2> axes;
  axes << x.transpose(), y.transpose();
  return axes;
}

Eigen::RowVector2d MainAxis(double xx, double xy, double yy)
{
  const double trace = xx + yy;
  const double difference = std::hypot(xx - yy, 2.0 * xy);
  constexpr double roundOff = 1e-12;
  if (!(difference > roundOff * trace))
  {
    return Eigen::RowVector2d::Zero();
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  return { std::cos(angle), std::sin(angle) };
}

TangentVectors TangentVectorsFromTriangleVectors(const TriangleMesh& mesh,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
  const Eigen::Ref<const Points>& vectors, const ParallelFor& parallel)
{
  return MainAxes(mesh, points, triangles, parallel,
    [&](Index t) -> Eigen::Matrix3d
    {
      const Row3 d = Direction(vectors.row(t));
      return d.transpose() * d;
    });
}

TangentVectors TangentVectorsFromPointVectors(const TriangleMesh& mesh,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles,
  const Eigen::Ref<const Points>& vectors, const ParallelFor& parallel)
{
  return MainAxes(mesh, points, triangles, parallel,
    [&](Index t) -> Eigen::Matrix3d
    {
      Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
      for (int a = 0; a < 3; ++a)
      {
        const Row3 d = Direction(vectors.row(triangles(t, a)));
        tensor += d.transpose() * d;
      }
      return tensor;
    });
}

Points VectorsInSpace(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const Eigen::Ref<const TangentVectors>& vectors,
  const ParallelFor& parallel)
{
  Points inSpace = Points::Zero(triangles.rows(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      inSpace.row(mesh.InputTriangle()[t]) =
        (TriangleAxes(mesh, points, triangles, t) * vectors.row(t).transpose()).transpose();
    });
  return inSpace;
}

} // namespace SurfaceDiffusion
