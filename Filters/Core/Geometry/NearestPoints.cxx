// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/NearestPoints.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Coordinates below it are those of a point on an edge or at a corner.
constexpr double Resolved = 1e-9;

std::array<double, 3> Snapped(std::array<double, 3> coordinates)
{
  double sum = 0.0;
  for (double& c : coordinates)
  {
    c = c < Resolved ? 0.0 : c;
    sum += c;
  }
  for (double& c : coordinates)
  {
    c = c == sum ? (c > 0.0 ? 1.0 : 0.0) : c / sum;
  }
  return coordinates;
}

/// The share of b in the point of the edge from a to b that is nearest to x.
double AlongEdge(
  const Eigen::RowVector3d& a, const Eigen::RowVector3d& b, const Eigen::RowVector3d& x)
{
  const double square = (b - a).squaredNorm();
  return square > 0.0 ? std::clamp((x - a).dot(b - a) / square, 0.0, 1.0) : 0.0;
}

} // namespace

NearestPoints::NearestPoints(const Points& points, const Triangles& triangles)
  : Vertices(points)
  , Faces(triangles)
  , Tree(points, triangles)
{
}

NearestPoint NearestPoints::InTriangle(Index t, const Eigen::RowVector3d& x) const
{
  const std::array<Eigen::RowVector3d, 3> corners = { this->Vertices.row(this->Faces(t, 0)),
    this->Vertices.row(this->Faces(t, 1)), this->Vertices.row(this->Faces(t, 2)) };
  NearestPoint found;
  found.Triangle = t;
  found.SquaredDistance = std::numeric_limits<double>::infinity();
  const auto take = [&](const std::array<double, 3>& shares)
  {
    const std::array<double, 3> c = Snapped(shares);
    const double square =
      (c[0] * corners[0] + c[1] * corners[1] + c[2] * corners[2] - x).squaredNorm();
    if (square < found.SquaredDistance)
    {
      found.Coordinates = c;
      found.SquaredDistance = square;
    }
  };
  const Eigen::RowVector3d e = corners[1] - corners[0];
  const Eigen::RowVector3d f = corners[2] - corners[0];
  const Eigen::RowVector3d normal = e.cross(f);
  const double square = normal.squaredNorm();
  if (square > 0.0)
  {
    const Eigen::RowVector3d d = x - corners[0];
    const double second = d.cross(f).dot(normal) / square;
    const double third = e.cross(d).dot(normal) / square;
    if (second >= 0.0 && third >= 0.0 && second + third <= 1.0)
    {
      take({ 1.0 - second - third, second, third });
      return found;
    }
  }
  for (std::size_t a = 0; a < 3; ++a)
  {
    const std::size_t b = (a + 1) % 3;
    std::array<double, 3> shares = { 0.0, 0.0, 0.0 };
    shares[b] = AlongEdge(corners[a], corners[b], x);
    shares[a] = 1.0 - shares[b];
    take(shares);
  }
  return found;
}

NearestPoint NearestPoints::Find(const Eigen::RowVector3d& x) const
{
  NearestPoint best;
  best.SquaredDistance = std::numeric_limits<double>::infinity();
  this->Tree.VisitNear(x.transpose(),
    [&](Index t)
    {
      const NearestPoint found = this->InTriangle(t, x);
      if (std::pair{ found.SquaredDistance, found.Triangle } <
        std::pair{ best.SquaredDistance, best.Triangle })
      {
        best = found;
      }
      return best.SquaredDistance;
    });
  return best;
}

} // namespace SurfaceDiffusion
