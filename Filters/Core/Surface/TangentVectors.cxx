// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/TangentVectors.h"

#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

using Row3 = Eigen::RowVector3d;

/// The triangle's plane axes in space, as the columns of a 3 x 2 matrix.
Eigen::Matrix<double, 3, 2> AxesInSpace(const Row3& p0, const Row3& p1, const Row3& p2, double unit)
{
  const Row3 e1 = (p1 - p0) / unit;
  const Row3 e2 = (p2 - p0) / unit;
  const Row3 x = e1.normalized();
  const Row3 y = (e2 - e2.dot(x) * x).normalized();
  Eigen::Matrix<double, 3, 2> axes;
  axes << x.transpose(), y.transpose();
  return axes;
}

/// A vector of unit length along d, whatever the size of d; zero where d is zero or not finite.
Row3 Direction(const Row3& d)
{
  const double size = d.cwiseAbs().maxCoeff();
  return std::isfinite(size) && size > 0.0 ? Row3((d / size).normalized()) : Row3(Row3::Zero());
}

template <typename TensorOf>
TangentVectors MainAxes(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const ParallelFor& parallel,
  const TensorOf& tensorOf)
{
  TangentVectors frames(mesh.NumberOfTriangles(), 2);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const Index input = mesh.InputTriangle()[t];
      const auto axes = TriangleAxes(mesh, points, triangles, t);
      const Eigen::Matrix3d tensor = tensorOf(input);
      const Eigen::Matrix2d plane = axes.transpose() * tensor * axes;
      // A vector that stands almost upright on the triangle gives no direction in it.
      frames.row(t) = plane.trace() > 1e-16 * tensor.trace()
        ? MainAxis(plane(0, 0), 0.5 * (plane(0, 1) + plane(1, 0)), plane(1, 1))
        : Eigen::RowVector2d(Eigen::RowVector2d::Zero());
    });
  return frames;
}

} // namespace

Eigen::Matrix<double, 3, 2> TriangleAxes(const TriangleMesh& mesh,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles, Index t)
{
  const Index input = mesh.InputTriangle()[t];
  return AxesInSpace(points.row(triangles(input, 0)), points.row(triangles(input, 1)),
    points.row(triangles(input, 2)), mesh.LengthUnit());
}

Eigen::RowVector2d MainAxis(double xx, double xy, double yy)
{
  const double trace = xx + yy;
  const double difference = std::hypot(xx - yy, 2.0 * xy);
  if (!(difference > 1e-12 * trace))
  {
    return Eigen::RowVector2d::Zero();
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  return { std::cos(angle), std::sin(angle) };
}

TangentVectors FramesFromTriangleVectors(const TriangleMesh& mesh,
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

TangentVectors FramesFromPointVectors(const TriangleMesh& mesh,
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

Points VectorsFromFrames(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const Eigen::Ref<const TangentVectors>& frames,
  const ParallelFor& parallel)
{
  Points vectors = Points::Zero(triangles.rows(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      vectors.row(mesh.InputTriangle()[t]) =
        (TriangleAxes(mesh, points, triangles, t) * frames.row(t).transpose()).transpose();
    });
  return vectors;
}

} // namespace SurfaceDiffusion
