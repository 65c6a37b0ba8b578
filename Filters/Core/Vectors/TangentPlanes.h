// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// The tangent planes of a surface at its vertices: orthogonal to the normals n_i of N. Max (J.
/// Graphics Tools 4(2), 1999), which are exact on spheres; with an orthonormal frame x_i, y_i of each.
/// A vector is a_i x_i + b_i y_i + c_i n_i.
class TangentPlanes
{
public:
  /// positions: per vertex of the mesh, in LengthUnit(). Triangles may have any orientation.
  TangentPlanes(std::shared_ptr<const TriangleMesh> mesh, Points positions,
    const ParallelFor& parallel = SerialFor());

  const TriangleMesh& Mesh() const { return *this->SurfaceMesh; }
  Eigen::Vector3d X(Index i) const { return this->Frames.row(i).head<3>(); }
  Eigen::Vector3d Y(Index i) const { return this->Frames.row(i).segment<3>(3); }
  Eigen::Vector3d Normal(Index i) const { return this->Frames.row(i).tail<3>(); }

  /// The frame of vertex i, projected into the plane of a triangle with it, in the triangle's own
  /// axes: x_i and y_i are the columns. corner: 3 t + a.
  Eigen::Matrix2d InTriangle(Index corner) const;

  Eigen::Vector3d TriangleNormal(Index t) const;

  /// Of n x 3m vectors the 2n x m coordinates: rows 2i and 2i + 1 are a and b of vertex i.
  Values Coordinates(const Values& vectors) const;
  /// Of 3m numbers at vertex i the 2m coordinates.
  Eigen::RowVectorXd CoordinatesAt(Index i, const Eigen::RowVectorXd& vectors) const;
  /// Of the same the n x m parts c.
  Values NormalParts(const Values& vectors) const;
  /// The n x 3m vectors of coordinates and normal parts; these may have no row: 0.
  Values Vectors(const Values& coordinates, const Values& normalParts) const
  {
    Values vectors;
    this->SetVectors(coordinates, normalParts, vectors);
    return vectors;
  }
  void SetVectors(const Values& coordinates, const Values& normalParts, Values& vectors) const;

private:
  Eigen::Matrix<double, 3, 2> TriangleAxes(Index t) const;

  std::shared_ptr<const TriangleMesh> SurfaceMesh;
  Points Positions;
  Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor> Frames; ///< x, y and n
  const ParallelFor& Parallel;
};

} // namespace SurfaceDiffusion
