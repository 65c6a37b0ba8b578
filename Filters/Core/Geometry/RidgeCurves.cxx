// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/RidgeCurves.h"

#include "Core/Geometry/VertexCurves.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

constexpr double Threshold = 0.5; ///< of the values that belong to a ridge
constexpr double Core = 0.9; ///< of those whose ends are kept

/// Finds the point of the ridge next to a vertex.
class RidgePoint
{
public:
  RidgePoint(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points, const Vector& values)
    : Mesh(mesh)
    , Coordinates(points)
    , Values(values)
  {
  }

  Eigen::RowVector3d operator()(Index i)
  {
    this->ListPatch(i);
    const Eigen::RowVector3d origin = this->At(i);
    const Eigen::Matrix3d axes = this->Axes(i);
    // value and height over the tangent plane ~ a + b x + c y + d x^2 + e x y + f y^2
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 2> right = Eigen::Matrix<double, 6, 2>::Zero();
    for (const Index j : this->Patch)
    {
      const Eigen::Vector3d x = axes * (this->At(j) - origin).transpose() / this->Scale;
      Eigen::Matrix<double, 6, 1> basis;
      basis << 1.0, x[0], x[1], x[0] * x[0], x[0] * x[1], x[1] * x[1];
      const double weight = std::exp(-0.25 * x.squaredNorm());
      normal += weight * basis * basis.transpose();
      right += weight * basis * Eigen::RowVector2d(this->Values[j], x[2]);
    }
    const Eigen::Matrix<double, 6, 2> fit = normal.ldlt().solve(right);
    Eigen::Matrix2d hessian;
    hessian << 2.0 * fit(3, 0), fit(4, 0), fit(4, 0), 2.0 * fit(5, 0);
    if (this->Patch.size() < 7 || !fit.allFinite())
    {
      return origin;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> curvature(hessian);
    const Eigen::Vector2d across = curvature.eigenvectors().col(0);
    const double bend = curvature.eigenvalues()[0];
    if (!(bend < 0.0))
    {
      return origin;
    }
    const double step = -across.dot(fit.block<2, 1>(1, 0)) / bend;
    const Eigen::Vector2d x = std::max(-1.0, std::min(1.0, step)) * across;
    const double height = fit(1, 1) * x[0] + fit(2, 1) * x[1] + fit(3, 1) * x[0] * x[0] +
      fit(4, 1) * x[0] * x[1] + fit(5, 1) * x[1] * x[1];
    return origin +
      this->Scale * (axes.transpose() * Eigen::Vector3d(x[0], x[1], height)).transpose();
  }

private:
  Eigen::RowVector3d At(Index i) const
  {
    return this->Coordinates.row(this->Mesh.InputVertex()[static_cast<std::size_t>(i)]);
  }

  /// Vertex i, its neighbours and theirs; Scale is the mean length of its edges. Ways do not lead
  /// through a vertex of many triangles, which would make all around it near to each other.
  void ListPatch(Index i)
  {
    constexpr Index manyTriangles = 64;
    const std::vector<Index>& begin = this->Mesh.VertexCornersBegin();
    ListNeighbours(this->Mesh, i, this->Ring);
    this->Patch = this->Ring;
    this->Patch.push_back(i);
    this->Scale = 0.0;
    for (const Index j : this->Ring)
    {
      this->Scale += (this->At(j) - this->At(i)).norm() / static_cast<double>(this->Ring.size());
    }
    for (const Index j : this->Ring)
    {
      if (static_cast<Index>(this->Ring.size()) > manyTriangles ||
        begin[j + 1] - begin[j] > manyTriangles)
      {
        continue;
      }
      ListNeighbours(this->Mesh, j, this->NextRing);
      for (const Index k : this->NextRing)
      {
        if (std::find(this->Patch.begin(), this->Patch.end(), k) == this->Patch.end())
        {
          this->Patch.push_back(k);
        }
      }
    }
  }

  /// Rows: two tangents and the normal, the mean of those of the triangles up to their signs.
  Eigen::Matrix3d Axes(Index i) const
  {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (Index c = this->Mesh.VertexCornersBegin()[i]; c < this->Mesh.VertexCornersBegin()[i + 1];
         ++c)
    {
      const Index corner = this->Mesh.VertexCorners()[c];
      const Eigen::Vector3d a = (this->At(this->Mesh.OtherCorner(corner, 1)) - this->At(i));
      const Eigen::Vector3d b = (this->At(this->Mesh.OtherCorner(corner, 2)) - this->At(i));
      const Eigen::Vector3d ofTriangle = a.cross(b);
      normal += normal.dot(ofTriangle) < 0.0 ? Eigen::Vector3d(-ofTriangle) : ofTriangle;
    }
    normal.normalize();
    const Eigen::Vector3d first = normal.unitOrthogonal();
    Eigen::Matrix3d axes;
    axes << first.transpose(), normal.cross(first).transpose(), normal.transpose();
    return axes;
  }

  const TriangleMesh& Mesh;
  const Eigen::Ref<const Points> Coordinates;
  const Vector& Values;
  std::vector<Index> Ring, NextRing, Patch;
  double Scale = 0.0;
};

} // namespace

double Polylines::Length(Index l) const
{
  double length = 0.0;
  for (Index k = this->Begin[l] + 1; k < this->Begin[l + 1]; ++k)
  {
    length += (this->Points.row(k) - this->Points.row(k - 1)).norm();
  }
  return length;
}

Polylines FindRidges(const TriangleMesh& mesh, const Eigen::Ref<const Points>& points,
  const Vector& values, double shortest, const ParallelFor& parallel)
{
  VertexCurves curves(mesh, values, Threshold, Core);
  Points ridge(static_cast<Eigen::Index>(curves.Vertices().size()), 3);
  ForEachBlock(parallel, static_cast<Index>(ridge.rows()),
    [&](Index, Index begin, Index end)
    {
      RidgePoint find(mesh, points, values);
      for (Index m = begin; m < end; ++m)
      {
        ridge.row(m) = find(curves.Vertices()[m]);
      }
    });
  curves.RemoveShort(ridge, shortest);

  Polylines lines;
  std::vector<Index> members;
  for (const std::vector<Index>& path : curves.FindPaths())
  {
    members.insert(members.end(), path.begin(), path.end());
    lines.Begin.push_back(static_cast<Index>(members.size()));
  }
  lines.Points.resize(static_cast<Eigen::Index>(members.size()), 3);
  for (std::size_t k = 0; k < members.size(); ++k)
  {
    lines.Points.row(static_cast<Eigen::Index>(k)) = ridge.row(members[k]);
    lines.Vertices.push_back(curves.Vertices()[members[k]]);
  }
  return lines;
}

} // namespace SurfaceDiffusion
