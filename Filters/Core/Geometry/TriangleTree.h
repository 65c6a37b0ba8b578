// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <Eigen/Geometry>

#include <limits>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// Boxes around the triangles of a surface, in a binary tree, to find those near a place.
class TriangleTree
{
public:
  using Box = Eigen::AlignedBox3d;

  TriangleTree() = default;
  TriangleTree(const Points& points, const Triangles& triangles);
  /// Of boxes in place of those around triangles.
  explicit TriangleTree(const std::vector<Box>& boxes);

  /// Around all; at the origin if there are none.
  Box Bounds() const
  {
    return this->Nodes.empty() ? Box(Eigen::Vector3d::Zero()) : this->Nodes.front().Bounds;
  }

  /// Call visit(t) for the triangles in boxes of interest, and a few beside them. enters(box) says
  /// whether a triangle within the box may be of interest, and may become stricter meanwhile.
  template <typename Enters, typename Visitor>
  void Visit(const Enters& enters, const Visitor& visit) const
  {
    Index stack[Deepest];
    int size = 0;
    if (!this->Nodes.empty())
    {
      stack[size++] = 0;
    }
    while (size > 0)
    {
      const Node& node = this->Nodes[static_cast<std::size_t>(stack[--size])];
      if (!enters(node.Bounds))
      {
        continue;
      }
      if (node.Second < 0)
      {
        for (Index k = node.Begin; k < node.End; ++k)
        {
          visit(this->Order[static_cast<std::size_t>(k)]);
        }
        continue;
      }
      stack[size++] = node.Second;
      stack[size++] = static_cast<Index>(&node - this->Nodes.data()) + 1;
    }
  }

  /// Call visit(t) for triangles near x, nearer boxes first. It returns the squared distance within
  /// which further triangles are of interest.
  template <typename Visitor>
  void VisitNear(const Eigen::Vector3d& x, const Visitor& visit) const
  {
    struct Open
    {
      Index Number;
      double Square; ///< of the distance of its box
    };
    Open stack[Deepest];
    int size = 0;
    const auto push = [&](Index number)
    {
      const Node& node = this->Nodes[static_cast<std::size_t>(number)];
      stack[size++] = { number, node.Bounds.squaredExteriorDistance(x) };
    };
    if (!this->Nodes.empty())
    {
      push(0);
    }
    double square = std::numeric_limits<double>::infinity();
    while (size > 0)
    {
      const Open open = stack[--size];
      if (open.Square > square)
      {
        continue;
      }
      const Node& node = this->Nodes[static_cast<std::size_t>(open.Number)];
      if (node.Second < 0)
      {
        for (Index k = node.Begin; k < node.End; ++k)
        {
          square = visit(this->Order[static_cast<std::size_t>(k)]);
        }
        continue;
      }
      push(node.Second);
      push(open.Number + 1);
      if (stack[size - 1].Square > stack[size - 2].Square)
      {
        std::swap(stack[size - 1], stack[size - 2]);
      }
    }
  }

private:
  static constexpr int Deepest = 64; ///< halves of fewer than 2^32 triangles

  /// The first child of an inner node follows it.
  struct Node
  {
    Box Bounds;
    Index Begin, End; ///< of Order
    Index Second; ///< child; -1 for leaves
  };

  void Build(const std::vector<Box>& boxes, Index begin, Index end);

  std::vector<Node> Nodes;
  std::vector<Index> Order; ///< triangles
};

/// The point of triangle abc that is nearest to p.
Eigen::Vector3d NearestInTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
  const Eigen::Vector3d& b, const Eigen::Vector3d& c);

} // namespace SurfaceDiffusion
