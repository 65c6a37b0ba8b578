// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/CellDirections.h"

#include "Core/Surface/TangentVectors.h"

#include <Eigen/Eigenvalues>

namespace SurfaceDiffusion
{

Points DirectionsOfCells(const Surface& surface, const TangentVectors& directions,
  std::int64_t numberOfCells, const std::function<std::int64_t(Index)>& cellOf,
  const ParallelFor& parallel)
{
  const TriangleMesh& mesh = surface.InputMesh();
  const Points vectors =
    VectorsInSpace(mesh, surface.Points(), surface.MakeTriangles(), directions, parallel);
  Points result = Points::Zero(static_cast<Eigen::Index>(numberOfCells), 3);

  Vector areas = Vector::Zero(surface.NumberOfTriangles());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    areas[mesh.InputTriangle()[t]] = mesh.Shapes()[t].Area();
  }
  const auto cellOfRow = [&](Eigen::Index row)
  { return cellOf(surface.InputTriangle(static_cast<Index>(row))); };
  for (Eigen::Index begin = 0, end = 0; begin < vectors.rows(); begin = end)
  {
    const std::int64_t cell = cellOfRow(begin);
    Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
    for (end = begin; end < vectors.rows() && cellOfRow(end) == cell; ++end)
    {
      tensor += areas[end] * vectors.row(end).transpose() * vectors.row(end);
    }
    Eigen::Vector3d direction = vectors.row(begin);
    if (end - begin > 1)
    {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(tensor);
      direction = axes.eigenvalues()[2] > 0.0 ? Eigen::Vector3d(axes.eigenvectors().col(2))
                                              : Eigen::Vector3d(Eigen::Vector3d::Zero());
    }
    result.row(static_cast<Eigen::Index>(cell)) = direction;
  }
  return result;
}

} // namespace SurfaceDiffusion
