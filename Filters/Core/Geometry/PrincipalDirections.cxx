// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/PrincipalDirections.h"

#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Surface/TangentVectors.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Rows of the six entries xx, xy, xz, yy, yz, zz of a symmetric tensor.
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

/// The heat equation (8) until the Gaussian has this full width at half maximum, in four steps.
void Smooth(const Assembler& assembler, double fwhm, Values& u, LinearSolver& solver,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = assembler.Mesh();
  constexpr int steps = 4;
  const double dt = fwhm * fwhm / (16.0 * std::log(2.0)) / steps;
  SparseMatrix matrix;
  TakePattern(assembler.Pattern(), matrix, parallel);
  assembler.Fill(matrix, mesh.ControlAreas(), dt, CotanWeights(mesh, parallel), nullptr, parallel);
  solver.SetMatrix(matrix, progress.Part(0.0, 0.5));
  for (int step = 0; step < steps; ++step)
  {
    const Values b = mesh.ControlAreas().asDiagonal() * u;
    const double part = 0.5 + 0.5 * step / steps;
    const SolveReport report = solver.Solve(b, u, progress.Part(part, part + 0.5 / steps));
    if (!report.Converged)
    {
      throw NotConverged(report);
    }
  }
}

Eigen::RowVector3d MainNormal(const Values& tensors, Index i)
{
  Eigen::Matrix3d tensor;
  tensor << tensors(i, 0), tensors(i, 1), tensors(i, 2), tensors(i, 1), tensors(i, 3),
    tensors(i, 4), tensors(i, 2), tensors(i, 4), tensors(i, 5);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(tensor).eigenvectors().col(2).transpose();
}

} // namespace

PrincipalDirections FindPrincipalDirections(const Assembler& assembler,
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles, double fwhm,
  LinearSolver& solver, const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = assembler.Mesh();
  const Index triangleCount = mesh.NumberOfTriangles();
  Points normals(triangleCount, 3);
  ForEach(parallel, triangleCount,
    [&](Index t)
    {
      const auto axes = TriangleAxes(mesh, points, triangles, t);
      normals.row(t) = axes.col(0).cross(axes.col(1)).transpose();
    });
  Values tensors = NormalTensors(mesh, normals, parallel);
  if (fwhm > 0.0)
  {
    Smooth(assembler, fwhm, tensors, solver, parallel, progress.Part(0.0, 0.9));
  }
  Points ofVertices(mesh.NumberOfVertices(), 3);
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i) { ofVertices.row(i) = MainNormal(tensors, i); });

  PrincipalDirections principal;
  principal.LeastBent.resize(triangleCount, 2);
  principal.Strength.resize(triangleCount);
  ForEach(parallel, triangleCount,
    [&](Index t)
    {
      const auto axes = TriangleAxes(mesh, points, triangles, t);
      Eigen::Vector3d inPlane[2]; // the two components of the normals in the plane, per corner
      for (int a = 0; a < 3; ++a)
      {
        const Eigen::RowVector3d n = ofVertices.row(mesh.TriangleVertices()(t, a));
        const double side = n.dot(normals.row(t)) < 0.0 ? -1.0 : 1.0;
        inPlane[0][a] = side * n.dot(axes.col(0));
        inPlane[1][a] = side * n.dot(axes.col(1));
      }
      // Shape operator: the derivative of the normal, made symmetric.
      const TriangleMesh::Shape& s = mesh.Shapes()[t];
      const Eigen::Vector2d dx = Gradient(s, inPlane[0][0], inPlane[0][1], inPlane[0][2]);
      const Eigen::Vector2d dy = Gradient(s, inPlane[1][0], inPlane[1][1], inPlane[1][2]);
      const double xx = dx[0];
      const double yy = dy[1];
      const double xy = 0.5 * (dx[1] + dy[0]);
      // k1 >= k2 belongs to the main axis; it bends less than k2 where |k1| < |k2|, k1 + k2 < 0.
      const double sum = xx + yy;
      const double difference = std::hypot(xx - yy, 2.0 * xy);
      principal.Strength[t] = std::min(std::abs(sum), difference);
      Eigen::RowVector2d least = Eigen::RowVector2d::Zero();
      if (principal.Strength[t] > 1e-9) // of a surface of about unit size: more than round-off
      {
        const double angle =
          0.5 * std::atan2(2.0 * xy, xx - yy) + (sum > 0.0 ? 0.5 * std::acos(-1.0) : 0.0);
        least << std::cos(angle), std::sin(angle);
      }
      principal.LeastBent.row(t) = least;
    });
  progress.Report(1.0);
  return principal;
}

} // namespace SurfaceDiffusion
