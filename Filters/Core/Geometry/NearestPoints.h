// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"
#include "Core/Geometry/TriangleTree.h"

#include <array>

namespace SurfaceDiffusion
{

/// A point of a triangle with its barycentric coordinates. One on an edge or at a corner has zeros.
struct NearestPoint
{
  Index Triangle = -1; ///< -1: there are no triangles
  std::array<double, 3> Coordinates = { 0.0, 0.0, 0.0 };
  double SquaredDistance = 0.0;
};

/// Finds the points of triangles that are nearest to given points.
class NearestPoints
{
public:
  /// points, triangles: must outlive it; finite coordinates.
  NearestPoints(const Points& points, const Triangles& triangles);

  /// Of several triangles with the same point, the one with the smallest number.
  NearestPoint Find(const Eigen::RowVector3d& x) const;

private:
  NearestPoint InTriangle(Index t, const Eigen::RowVector3d& x) const;

  const Points& Vertices;
  const Triangles& Faces;
  const TriangleTree Tree;
};

} // namespace SurfaceDiffusion
