// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/TriangleTree.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Boxes around the triangles of a surface, as TriangleTree. Those around a vertex, or at an edge,
/// of more than 128 triangles are apart from the others: their boxes all meet there, so that each
/// would be near all others.
class TriangleStars
{
public:
  using Box = TriangleTree::Box;

  TriangleStars(const Points& points, const Triangles& triangles);

  /// As TriangleTree::Visit(), for all triangles.
  template <typename Enters, typename Visitor>
  void Visit(const Enters& enters, const Visitor& visit) const
  {
    this->Bounds.Visit(enters,
      [&](Index s)
      {
        const Star& star = this->Stars[static_cast<std::size_t>(s)];
        star.Visit(star.Boxes, enters, visit);
      });
  }

  /// Call visit(u) for triangles u that may have a line in common with triangle t, and no edge, and
  /// for a few beside them. enters(box): whether a triangle within it may meet the box of t.
  template <typename Enters, typename Visitor>
  void VisitMeeting(Index t, const Enters& enters, const Visitor& visit) const
  {
    const Index own = this->StarOf[static_cast<std::size_t>(t)];
    const auto visitStar = [&](Index s)
    {
      const Star& star = this->Stars[static_cast<std::size_t>(s)];
      if (s != own || s == 0)
      {
        star.Visit(star.Boxes, enters, visit);
      }
      else if (star.Arcs.rows() > 0)
      {
        // Seen from their common vertex, both cover an arc, and the arcs cross.
        Box box;
        for (Index k = 3 * this->PlaceOf[static_cast<std::size_t>(t)], end = k + 3; k < end; ++k)
        {
          box.extend(star.Arcs.row(k).transpose());
        }
        box.min().array() -= Rounding;
        box.max().array() += Rounding;
        star.Visit(
          star.ArcBoxes, [&](const Box& other) { return box.intersects(other); }, visit);
      }
    };
    this->Bounds.Visit(enters, visitStar);
  }

private:
  static constexpr double Rounding = 1e-12; ///< of unit vectors

  struct Star
  {
    std::vector<Index> Members; ///< triangles
    TriangleTree Boxes; ///< of them
    /// Three corners of a triangle around the arc that each covers on the unit sphere around their
    /// common vertex. No rows: they have a common edge, or are those of no star.
    Points Arcs;
    TriangleTree ArcBoxes;

    template <typename Enters, typename Visitor>
    void Visit(const TriangleTree& tree, const Enters& enters, const Visitor& visit) const
    {
      tree.Visit(enters, [&](Index k) { visit(this->Members[static_cast<std::size_t>(k)]); });
    }
  };

  std::vector<Star> Stars; ///< the first: all triangles that are in no star
  TriangleTree Bounds; ///< of the stars
  std::vector<Index> StarOf; ///< per triangle
  std::vector<Index> PlaceOf; ///< per triangle, among the members
};

} // namespace SurfaceDiffusion
