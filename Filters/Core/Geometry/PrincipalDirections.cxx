// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/PrincipalDirections.h"

#include "Core/Geometry/CoordinateRounding.h"
#include "Core/Geometry/HeatRegression.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Surface/TangentVectors.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// The area-weighted mean of n n^T around each vertex: xx, xy, xz, yy, yz, zz.
Values NormalTensors(const TriangleMesh& mesh, const Points& normals, const ParallelFor& parallel)
{
  Values tensors(mesh.NumberOfVertices(), 6);
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      Eigen::Matrix<double, 1, 6> sum = Eigen::Matrix<double, 1, 6>::Zero();
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index t = mesh.VertexCorners()[c] / 3;
        const double area = mesh.Shapes()[t].Area();
        int entry = 0;
        for (int a = 0; a < 3; ++a)
        {
          for (int b = a; b < 3; ++b)
          {
            sum[entry++] += area * normals(t, a) * normals(t, b);
          }
        }
      }
      tensors.row(i) = sum / (3.0 * mesh.ControlAreas()[i]);
    });
  return tensors;
}

/// Of numbers of size 1
constexpr double RoundOff = 1e-9;

/// The main axis; zero where there is none, as at the corners of a cube.
Eigen::RowVector3d MainNormal(const Values& tensors, Index i)
{
  Eigen::Matrix3d tensor;
  tensor << tensors(i, 0), tensors(i, 1), tensors(i, 2), tensors(i, 1), tensors(i, 3),
    tensors(i, 4), tensors(i, 2), tensors(i, 4), tensors(i, 5);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
  const Eigen::Vector3d values = solver.eigenvalues();
  return values[2] - values[1] > RoundOff * values[2]
    ? Eigen::RowVector3d(solver.eigenvectors().col(2).transpose())
    : Eigen::RowVector3d::Zero();
}

Points TriangleNormals(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const ParallelFor& parallel)
{
  Points normals(mesh.NumberOfTriangles(), 3);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const auto axes = TriangleAxes(mesh, points, triangles, t);
      normals.row(t) = axes.col(0).cross(axes.col(1)).transpose();
    });
  return normals;
}

/// A symmetric 2 x 2 matrix in a triangle's axes.
struct ShapeOperator
{
  double XX, XY, YY;
};

/// The derivative of the normal, made symmetric. vertexNormals may have any sign; zero where one has no
/// side of the triangle.
ShapeOperator ShapeOperatorOf(const TriangleMesh& mesh, Index t,
  const Eigen::Matrix<double, 3, 2>& axes, const Eigen::RowVector3d& triangleNormal,
  const Points& vertexNormals)
{
  Eigen::Vector3d tangential[2]; // the two components of the normals in the plane, per corner
  for (int a = 0; a < 3; ++a)
  {
    const Eigen::RowVector3d n = vertexNormals.row(mesh.TriangleVertices()(t, a));
    const double cosine = n.dot(triangleNormal);
    if (std::abs(cosine) < RoundOff)
    {
      return { 0.0, 0.0, 0.0 };
    }
    const double side = cosine < 0.0 ? -1.0 : 1.0;
    tangential[0][a] = side * n.dot(axes.col(0));
    tangential[1][a] = side * n.dot(axes.col(1));
  }
  const TriangleMesh::Shape s = mesh.Shapes()[t];
  const Eigen::Vector2d dx = Gradient(s, tangential[0][0], tangential[0][1], tangential[0][2]);
  const Eigen::Vector2d dy = Gradient(s, tangential[1][0], tangential[1][1], tangential[1][2]);
  return { dx[0], 0.5 * (dx[1] + dy[0]), dy[1] };
}

} // namespace

PrincipalDirections FindPrincipalDirections(const Assembler& assembler,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles, double fwhm,
  LinearSolver& solver, const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = assembler.Mesh();
  const Points normals = TriangleNormals(mesh, points, triangles, parallel);
  Values tensors = NormalTensors(mesh, normals, parallel);
  PrincipalDirections principal;
  if (fwhm > 0.0)
  {
    principal.MissedResidual =
      SmoothByHeat(assembler, fwhm, tensors, solver, parallel, progress.Part(0.0, 0.9));
  }
  Points vertexNormals(mesh.NumberOfVertices(), 3);
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i) { vertexNormals.row(i) = MainNormal(tensors, i); });

  // On a surface of about unit size curvatures have round-off, and at their scale that of coordinates.
  constexpr double factor = 32.0;
  const double rounding = factor * RoundingOfCoordinates(points) / mesh.LengthUnit();
  principal.MinimumCurvature.resize(mesh.NumberOfTriangles(), 2);
  principal.Difference.resize(mesh.NumberOfTriangles());
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const auto axes = TriangleAxes(mesh, points, triangles, t);
      const ShapeOperator s = ShapeOperatorOf(mesh, t, axes, normals.row(t), vertexNormals);
      // kappa_1 >= kappa_2 belongs to the main axis; |kappa_1| < |kappa_2| if their sum is
      // negative.
      const double sum = s.XX + s.YY;
      const double difference = std::hypot(s.XX - s.YY, 2.0 * s.XY);
      principal.Difference[t] = std::min(std::abs(sum), difference);
      Eigen::RowVector2d direction = Eigen::RowVector2d::Zero();
      const double square = std::max(mesh.Shapes()[t].Area(), fwhm * fwhm);
      if (principal.Difference[t] > std::max(RoundOff, rounding / square))
      {
        const double angle =
          0.5 * std::atan2(2.0 * s.XY, s.XX - s.YY) + (sum > 0.0 ? 0.5 * std::acos(-1.0) : 0.0);
        direction << std::cos(angle), std::sin(angle);
      }
      principal.MinimumCurvature.row(t) = direction;
    });
  progress.Report(1.0);
  return principal;
}

} // namespace SurfaceDiffusion
