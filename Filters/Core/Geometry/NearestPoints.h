// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <array>
#include <vector>

namespace SurfaceDiffusion
{

/// A point of a triangle with its barycentric coordinates. One on an edge or at a corner has zeros.
struct NearestPoint
{
  Index Triangle = -1; ///< -1: there are no triangles
  std::array<double, 3> Coordinates = { 0.0, 0.0, 0.0 };
  double SquaredDistance = 0.0;
};

/// Finds the points of triangles that are nearest to given points, with a tree of bounding boxes.
class NearestPoints
{
public:
  /// points, triangles: must outlive it; finite coordinates.
  NearestPoints(const Points& points, const Triangles& triangles);

  /// Of several triangles with the same point, the one with the smallest number.
  NearestPoint Find(const Eigen::RowVector3d& x) const;

private:
  struct Node
  {
    Eigen::Array3d Low, High;
    Index Begin = 0, End = 0; ///< of Order
    Index Right = -1; ///< -1: a leaf; the left one follows its parent
  };

  void Split(Index begin, Index end, const Points& centers);
  NearestPoint InTriangle(Index t, const Eigen::RowVector3d& x) const;

  const Points& Vertices;
  const Triangles& Faces;
  std::vector<Index> Order; ///< triangles, those of a node one after the other
  std::vector<Node> Nodes;
};

} // namespace SurfaceDiffusion
