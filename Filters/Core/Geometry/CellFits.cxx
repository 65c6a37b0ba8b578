// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/CellFits.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>

namespace SurfaceDiffusion
{

namespace
{

using Place = Eigen::Vector2d; ///< in the tangent plane of a vertex

/// The weights of places in the value at the origin of the linear function that fits values there,
/// for positive weights of the squares.
Vector WeightsOfFit(const std::vector<Place>& places, const Vector& ofSquares)
{
  const auto count = static_cast<Eigen::Index>(places.size());
  const Vector shares = ofSquares / ofSquares.sum();
  Place centre = Place::Zero();
  for (Eigen::Index k = 0; k < count; ++k)
  {
    centre += shares[k] * places[static_cast<std::size_t>(k)];
  }
  Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
  for (Eigen::Index k = 0; k < count; ++k)
  {
    const Place d = places[static_cast<std::size_t>(k)] - centre;
    moments += shares[k] * d * d.transpose();
  }
  constexpr double flat = 1e-8; // of the larger moment: places on a line
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(moments);
  Place slope = Place::Zero();
  for (int a = 0; a < 2; ++a)
  {
    const double moment = axes.eigenvalues()[a];
    if (moment > flat * axes.eigenvalues()[1])
    {
      slope -= axes.eigenvectors().col(a).dot(centre) / moment * axes.eigenvectors().col(a);
    }
  }
  Vector weights(count);
  for (Eigen::Index k = 0; k < count; ++k)
  {
    weights[k] = shares[k] * (1.0 + slope.dot(places[static_cast<std::size_t>(k)] - centre));
  }
  return weights;
}

} // namespace

Values FitCells(const TriangleMesh& mesh, const CellTransfer& transfer, const Points& positions,
  const Points& normals, const Values& ofCells, const ParallelFor& parallel)
{
  const Values centroids = transfer.ToCells(positions);
  Flags atBoundary = Flags::Constant(mesh.NumberOfVertices(), false);
  for (const Index i : mesh.BoundaryVertices())
  {
    atBoundary[i] = true;
  }
  Values found = Values::Zero(mesh.NumberOfVertices(), ofCells.cols());
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      std::vector<Index> cells;
      const auto add = [&](Index cell) { cells.push_back(cell); };
      transfer.ForEachCellAround(i, add);
      if (atBoundary[i])
      {
        const std::vector<Index> nearest = cells;
        for (const Index cell : nearest)
        {
          transfer.ForEachVertexOf(cell, [&](Index j) { transfer.ForEachCellAround(j, add); });
        }
        std::sort(cells.begin(), cells.end());
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
      }
      const Eigen::Vector3d normal = normals.row(i).transpose();
      const Eigen::Vector3d first =
        normal.isZero(0.0) ? Eigen::Vector3d::UnitX() : normal.unitOrthogonal();
      const Eigen::Vector3d second = normal.cross(first);
      std::vector<Place> places;
      Vector ofSquares(static_cast<Eigen::Index>(cells.size()));
      for (const Index cell : cells)
      {
        const Eigen::Vector3d d = (centroids.row(cell) - positions.row(i)).transpose();
        ofSquares[static_cast<Eigen::Index>(places.size())] = transfer.CellAreas()[cell];
        places.emplace_back(d.dot(first), d.dot(second));
      }
      const Vector fit = WeightsOfFit(places, ofSquares);
      for (std::size_t k = 0; k < cells.size(); ++k)
      {
        found.row(i) += fit[static_cast<Eigen::Index>(k)] * ofCells.row(cells[k]);
      }
    });
  return found;
}

} // namespace SurfaceDiffusion
