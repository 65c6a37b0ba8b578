// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geometry/Ray.h"
#include "Core/Geometry/TriangleTree.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// The place of a corner of triangle t.
inline Eigen::Vector3d CornerPlace(const Points& points, const Triangles& faces, Index t, int a)
{
  return points.row(faces(t, a)).transpose();
}

/// Its normal, whose length is twice its area.
inline Eigen::Vector3d DoubledNormal(const Points& points, const Triangles& faces, Index t)
{
  const Eigen::Vector3d a = CornerPlace(points, faces, t, 0);
  return (CornerPlace(points, faces, t, 1) - a).cross(CornerPlace(points, faces, t, 2) - a);
}

/// How often sets of triangles go around a place.
class Windings
{
public:
  /// Nearer places touch, over the size of the surface.
  static constexpr double Touching = 1e-6;

  /// setOf: per triangle, -1 for those that do not count.
  Windings(const Points& points, const Triangles& faces, const std::vector<Index>& setOf)
    : Places(points)
    , Faces(faces)
    , SetOf(setOf)
    , Tree(points, faces)
    , Tolerance(Touching * this->Tree.Bounds().diagonal().norm())
  {
  }

  using Sums = std::vector<std::pair<Index, int>>; ///< of each set

  /// Of the sets that a line in general position meets; 0 for all others.
  Sums At(const Eigen::Vector3d& place) const
  {
    Sums sums;
    const Ray ray(place, Eigen::Vector3d(0.5773, 0.2113, 0.7887).normalized());
    this->Tree.Visit([&](const TriangleTree::Box& box)
      { return ray.Meets(box, 0.0, std::numeric_limits<double>::max()); },
      [&](Index t)
      {
        const Eigen::Vector3d normal = DoubledNormal(this->Places, this->Faces, t);
        if (this->SetOf[static_cast<std::size_t>(t)] >= 0 && this->Distance(ray, t, normal) >= 0.0)
        {
          Add(sums, this->SetOf[static_cast<std::size_t>(t)], normal.dot(ray.Way) > 0.0 ? 1 : -1);
        }
      });
    return sums;
  }

  bool Touches(const Eigen::Vector3d& place, Index set) const
  {
    bool touches = false;
    const double square = this->Tolerance * this->Tolerance;
    this->Tree.Visit([&](const TriangleTree::Box& box)
      { return !touches && box.squaredExteriorDistance(place) <= square; },
      [&](Index t)
      {
        touches = touches ||
          (this->SetOf[static_cast<std::size_t>(t)] == set &&
            (NearestInTriangle(place, CornerPlace(this->Places, this->Faces, t, 0),
               CornerPlace(this->Places, this->Faces, t, 1),
               CornerPlace(this->Places, this->Faces, t, 2)) -
              place)
                .squaredNorm() <= square);
      });
    return touches;
  }

  /// A set other than `own` that the place is inside of and does not touch; -1 for none.
  Index Around(const Eigen::Vector3d& place, Index own) const
  {
    Index found = -1;
    for (const auto& [set, sum] : this->At(place))
    {
      found = set != own && sum > 0 && !this->Touches(place, set) ? set : found;
    }
    return found;
  }

  /// visit(set) for the sets that the line from a to b enters or leaves.
  template <typename Visitor>
  void VisitBetween(
    const Eigen::Vector3d& a, const Eigen::Vector3d& b, Index own, const Visitor& visit) const
  {
    const double length = (b - a).norm();
    if (!(length > 0.0))
    {
      return;
    }
    const Ray ray(a, (b - a) / length);
    this->Tree.Visit([&](const TriangleTree::Box& box) { return ray.Meets(box, 0.0, length); },
      [&](Index t)
      {
        const Eigen::Vector3d normal = DoubledNormal(this->Places, this->Faces, t);
        const double distance = this->Distance(ray, t, normal);
        const double height = std::abs(normal.dot(ray.Way)) / normal.norm();
        const double step = 2.0 * this->Tolerance / height;
        const Index set = this->SetOf[static_cast<std::size_t>(t)];
        if (set >= 0 && set != own && distance > step && distance + step < length)
        {
          for (const double way : { -step, step })
          {
            const Index around = this->Around(a + (distance + way) * ray.Way, own);
            if (around >= 0)
            {
              visit(around);
            }
          }
        }
      });
  }

private:
  double Distance(const Ray& ray, Index t, const Eigen::Vector3d& normal) const
  {
    return ray.DistanceTo(CornerPlace(this->Places, this->Faces, t, 0),
      CornerPlace(this->Places, this->Faces, t, 1), CornerPlace(this->Places, this->Faces, t, 2),
      normal);
  }

  static void Add(Sums& sums, Index set, int sign)
  {
    for (auto& [known, sum] : sums)
    {
      if (known == set)
      {
        sum += sign;
        return;
      }
    }
    sums.emplace_back(set, sign);
  }

  const Points& Places;
  const Triangles& Faces;
  const std::vector<Index>& SetOf;
  TriangleTree Tree;
  double Tolerance;
};

} // namespace SurfaceDiffusion
