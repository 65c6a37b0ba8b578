// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Vectors/TangentPlanes.h"

#include "Core/Geometry/OrientedNormals.h"

#include <Eigen/Geometry>

namespace SurfaceDiffusion
{

TangentPlanes::TangentPlanes(
  std::shared_ptr<const TriangleMesh> mesh, Points positions, const ParallelFor& parallel)
  : SurfaceMesh(std::move(mesh))
  , Positions(std::move(positions))
  , Frames(this->SurfaceMesh->NumberOfVertices(), 9)
  , Parallel(parallel)
{
  const OrientedNormals oriented =
    FindOrientedNormals(*this->SurfaceMesh, this->Positions, parallel);
  const Points normals = SphericalNormals(*this->SurfaceMesh, oriented, parallel);
  ForEach(parallel, this->SurfaceMesh->NumberOfVertices(),
    [&](Index i)
    {
      Eigen::Vector3d n = normals.row(i);
      if (!(n.squaredNorm() > 0.0)) // the normals around the vertex cancel each other
      {
        const Index corner =
          this->SurfaceMesh->VertexCorners()[this->SurfaceMesh->VertexCornersBegin()[i]];
        n = oriented.OfTriangles.row(corner / 3);
      }
      n.normalize();
      // The axis that is the farthest from the normal, which keeps the frame accurate.
      Index axis = 0;
      n.cwiseAbs().minCoeff(&axis);
      const Eigen::Vector3d x = Eigen::Vector3d::Unit(axis).cross(n).normalized();
      this->Frames.row(i) << x.transpose(), n.cross(x).transpose(), n.transpose();
    });
}

Eigen::Matrix<double, 3, 2> TangentPlanes::TriangleAxes(Index t) const
{
  const auto corner = [&](int a) -> Eigen::Vector3d
  { return this->Positions.row(this->SurfaceMesh->TriangleVertices()(t, a)); };
  const Eigen::Vector3d x = (corner(1) - corner(0)).normalized();
  const Eigen::Vector3d edge = corner(2) - corner(0);
  Eigen::Matrix<double, 3, 2> axes;
  axes << x, (edge - edge.dot(x) * x).normalized();
  return axes;
}

Eigen::Vector3d TangentPlanes::TriangleNormal(Index t) const
{
  const Eigen::Matrix<double, 3, 2> axes = this->TriangleAxes(t);
  return axes.col(0).cross(axes.col(1));
}

Eigen::Matrix2d TangentPlanes::InTriangle(Index corner) const
{
  const Index i = this->SurfaceMesh->TriangleVertices()(corner / 3, corner % 3);
  Eigen::Matrix<double, 3, 2> frame;
  frame << this->X(i), this->Y(i);
  return this->TriangleAxes(corner / 3).transpose() * frame;
}

Values TangentPlanes::Coordinates(const Values& vectors) const
{
  const Eigen::Index columns = vectors.cols() / 3;
  Values coordinates(2 * vectors.rows(), columns);
  ForEach(this->Parallel, static_cast<Index>(vectors.rows()),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < columns; ++k)
      {
        const Eigen::Vector3d u = vectors.row(i).segment<3>(3 * k);
        coordinates(2 * i, k) = this->X(i).dot(u);
        coordinates(2 * i + 1, k) = this->Y(i).dot(u);
      }
    });
  return coordinates;
}

Eigen::RowVectorXd TangentPlanes::CoordinatesAt(Index i, const Eigen::RowVectorXd& vectors) const
{
  Eigen::RowVectorXd coordinates(2 * (vectors.size() / 3));
  for (Eigen::Index k = 0; k < coordinates.size() / 2; ++k)
  {
    const Eigen::Vector3d u = vectors.segment<3>(3 * k);
    coordinates[2 * k] = this->X(i).dot(u);
    coordinates[2 * k + 1] = this->Y(i).dot(u);
  }
  return coordinates;
}

Values TangentPlanes::NormalParts(const Values& vectors) const
{
  const Eigen::Index columns = vectors.cols() / 3;
  Values parts(vectors.rows(), columns);
  ForEach(this->Parallel, static_cast<Index>(vectors.rows()),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < columns; ++k)
      {
        parts(i, k) = this->Normal(i).dot(vectors.row(i).segment<3>(3 * k).transpose());
      }
    });
  return parts;
}

void TangentPlanes::SetVectors(
  const Values& coordinates, const Values& normalParts, Values& vectors) const
{
  vectors.resize(coordinates.rows() / 2, 3 * coordinates.cols());
  ForEach(this->Parallel, static_cast<Index>(vectors.rows()),
    [&](Index i)
    {
      for (Eigen::Index k = 0; k < coordinates.cols(); ++k)
      {
        const double normal = normalParts.rows() > 0 ? normalParts(i, k) : 0.0;
        vectors.row(i).segment<3>(3 * k) = coordinates(2 * i, k) * this->X(i) +
          coordinates(2 * i + 1, k) * this->Y(i) + normal * this->Normal(i);
      }
    });
}

} // namespace SurfaceDiffusion
