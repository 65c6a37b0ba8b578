// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/Slabs.h"
#include "Core/Geometry/TriangleTree.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Boxes around the triangles of a surface, as TriangleTree. Those around a vertex, or at an edge,
/// of more than 128 triangles are apart from the others: their boxes all meet there, so that each
/// would be near all others. Those around vertices at one place are together.
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
  /// for a few beside them. corners: of t. enters(box): whether a triangle within it may meet the
  /// box of t.
  template <typename Enters, typename Visitor>
  void VisitMeeting(
    Index t, const Slabs::Corners& corners, const Enters& enters, const Visitor& visit) const
  {
    const Index own = this->StarOf[static_cast<std::size_t>(t)];
    const double rounding = Rounding * this->Bounds.Bounds().diagonal().norm();
    const auto visitStar = [&](Index s)
    {
      const Star& star = this->Stars[static_cast<std::size_t>(s)];
      if (!enters(star.Boxes.Bounds()))
      {
        return;
      }
      if (s == 0 && own == 0)
      {
        star.Visit(star.Boxes, enters, visit);
      }
      else if (s != own && star.Arcs.rows() > 0)
      {
        // Seen from the vertex of the star, t meets the arcs of the triangles that it meets.
        const Slabs seen = Slabs::Seen(corners, star.Centre, rounding);
        star.Visit(
          star.ArcBoxes, [&](const Box& other) { return seen.Meet(other); }, visit);
      }
      else if (s != own)
      {
        const Slabs around = Slabs::Around(corners, rounding);
        star.Visit(
          star.Boxes, [&](const Box& other) { return enters(other) && around.Meet(other); }, visit);
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
    Eigen::Vector3d Centre; ///< if there are arcs
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
