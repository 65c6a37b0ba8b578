// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/SelfIntersections.h"

#include "Core/Geometry/TriangleStars.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

/// Distances below this, over the size of the surface, are rounding of coordinates.
constexpr double Touching = 1e-12;

using Vector3 = Eigen::Vector3d;

class CrossingTest
{
public:
  CrossingTest(const Points& points, const Triangles& triangles)
    : Places(points)
    , Faces(triangles)
  {
    if (points.rows() > 0)
    {
      this->Tolerance =
        Touching * (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
    }
  }

  /// Whether both cross along a line, see FindSelfIntersections().
  bool Cross(const TriangleStars& tree, Index t, Index u) const
  {
    int common = 0;
    for (int a = 0; a < 3; ++a)
    {
      for (int b = 0; b < 3; ++b)
      {
        common += this->Faces(t, a) == this->Faces(u, b);
      }
    }
    if (common > 1)
    {
      return false;
    }
    const Sides first = this->SidesOf(t, u);
    if (!first.Meets())
    {
      return false;
    }
    const Sides second = this->SidesOf(u, t);
    if (!second.Meets())
    {
      return false;
    }
    const Vector3 along = first.Normal.cross(second.Normal).normalized();
    const Vector3 from = this->AnyCommonPlace(t, first);
    const Interval a = this->IntervalOf(t, first, from, along);
    const Interval b = this->IntervalOf(u, second, from, along);
    const double begin = std::max(a.Begin, b.Begin);
    const double end = std::min(a.End, b.End);
    if (!(end - begin > this->Tolerance))
    {
      return false;
    }
    const Vector3 middle = from + 0.5 * (begin + end) * along;
    return this->AreInterleaved(this->HalfPlanes(tree, t, first, middle, along),
      this->HalfPlanes(tree, u, second, middle, along), along);
  }

private:
  /// On which sides of the plane of another triangle the corners are: -1, 0 or 1.
  struct Sides
  {
    Vector3 Normal; ///< of that plane
    std::array<double, 3> Distances; ///< times the length of the normal
    std::array<int, 3> Signs;

    /// Whether the triangle has a line in common with the plane, and not all of itself.
    bool Meets() const
    {
      const auto [least, most] = std::minmax_element(this->Signs.begin(), this->Signs.end());
      return *least * *most < 0 || (*least != *most && this->Edge() >= 0);
    }
    /// The corner opposite to the side in the plane; -1: there is none.
    int Edge() const
    {
      const auto zeros = std::count(this->Signs.begin(), this->Signs.end(), 0);
      const auto other =
        std::find_if(this->Signs.begin(), this->Signs.end(), [](int s) { return s; });
      return zeros == 2 ? static_cast<int>(other - this->Signs.begin()) : -1;
    }
  };
  struct Interval
  {
    double Begin = std::numeric_limits<double>::infinity();
    double End = -std::numeric_limits<double>::infinity();
  };

  Vector3 Place(Index t, int corner) const
  {
    return this->Places.row(this->Faces(t, corner)).transpose();
  }

  Sides SidesOf(Index t, Index plane) const
  {
    Sides sides;
    const Vector3 corner = this->Place(plane, 0);
    const Vector3 along = this->Place(plane, 1) - corner;
    const Vector3 across = this->Place(plane, 2) - corner;
    sides.Normal = along.cross(across);
    // The normal of a needle may be rounding alone, and is small against the product of its sides.
    const double least = this->Tolerance * along.norm() * across.norm();
    for (int a = 0; a < 3; ++a)
    {
      const double distance = sides.Normal.dot(this->Place(t, a) - corner);
      sides.Distances[static_cast<std::size_t>(a)] = distance;
      sides.Signs[static_cast<std::size_t>(a)] = distance > least ? 1 : distance < -least ? -1 : 0;
    }
    return sides;
  }

  /// use(place) for the ends of what triangle t has in common with the plane.
  template <typename Use>
  void ForEachEnd(Index t, const Sides& sides, const Use& use) const
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      const std::size_t b = (a + 1) % 3;
      const Vector3 p = this->Place(t, static_cast<int>(a));
      if (sides.Signs[a] == 0)
      {
        use(p);
      }
      else if (sides.Signs[a] * sides.Signs[b] < 0)
      {
        const Vector3 q = this->Place(t, static_cast<int>(b));
        use(
          Vector3(p + (q - p) * (sides.Distances[a] / (sides.Distances[a] - sides.Distances[b]))));
      }
    }
  }

  Vector3 AnyCommonPlace(Index t, const Sides& sides) const
  {
    Vector3 found;
    this->ForEachEnd(t, sides, [&](const Vector3& place) { found = place; });
    return found;
  }

  /// Where triangle t is on the line of both planes, through `from`.
  Interval IntervalOf(Index t, const Sides& sides, const Vector3& from, const Vector3& along) const
  {
    Interval interval;
    this->ForEachEnd(t, sides,
      [&](const Vector3& place)
      {
        const double at = along.dot(place - from);
        interval.Begin = std::min(interval.Begin, at);
        interval.End = std::max(interval.End, at);
      });
    return interval;
  }

  /// Two vectors from the line at `middle` into the surface of triangle t, across the line: those
  /// to both sides within the triangle or, if the line is along its side, into it and into its
  /// neighbour. Zero if it has not one neighbour there.
  std::array<Vector3, 2> HalfPlanes(const TriangleStars& tree, Index t, const Sides& sides,
    const Vector3& middle, const Vector3& along) const
  {
    const auto across = [&](const Vector3& place) -> Vector3
    { return place - middle - along.dot(place - middle) * along; };
    const int opposite = sides.Edge();
    if (opposite < 0)
    {
      const auto highest = std::max_element(sides.Distances.begin(), sides.Distances.end());
      const auto lowest = std::min_element(sides.Distances.begin(), sides.Distances.end());
      return { across(this->Place(t, static_cast<int>(highest - sides.Distances.begin()))),
        across(this->Place(t, static_cast<int>(lowest - sides.Distances.begin()))) };
    }
    std::array<Vector3, 2> both{ across(this->Place(t, opposite)), Vector3::Zero() };
    const Index p = this->Faces(t, (opposite + 1) % 3);
    const Index q = this->Faces(t, (opposite + 2) % 3);
    const Vector3 first = this->Places.row(p).transpose();
    const Vector3 last = this->Places.row(q).transpose();
    Index neighbours = 0;
    tree.Visit([&](const TriangleStars::Box& box)
      { return box.contains(first) && box.contains(last); }, // many have one of them
      [&](Index v)
      {
        const auto face = this->Faces.row(v);
        if (v != t && (face.array() == p).any() && (face.array() == q).any())
        {
          ++neighbours;
          const Index other = face.sum() - p - q;
          both[1] = across(this->Places.row(other).transpose());
        }
      });
    both[1] *= neighbours == 1 ? 1.0 : 0.0;
    return both;
  }

  /// Whether the half planes alternate around the line, clearly.
  bool AreInterleaved(const std::array<Vector3, 2>& first, const std::array<Vector3, 2>& second,
    const Vector3& along) const
  {
    const auto turn = [&](const Vector3& from, const Vector3& to)
    { return along.dot(from.cross(to)); };
    for (const Vector3& a : first)
    {
      for (const Vector3& b : second)
      {
        // from the one half plane to a corner of the other
        const double most = this->Tolerance * std::min(a.norm(), b.norm());
        if (a.dot(b) >= 0.0 && !(std::abs(turn(a, b)) > most))
        {
          return false;
        }
      }
    }
    const auto angle = [&](const Vector3& to)
    {
      const double found = std::atan2(turn(first[0], to), first[0].dot(to));
      return found < 0.0 ? found + 2.0 * std::acos(-1.0) : found;
    };
    const double last = angle(first[1]);
    return (angle(second[0]) < last) != (angle(second[1]) < last);
  }

  const Points& Places;
  const Triangles& Faces;
  double Tolerance = 0.0;
};

} // namespace

std::vector<char> FindSelfIntersections(const Points& points, const Triangles& triangles,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const TriangleStars tree(points, triangles);
  const CrossingTest test(points, triangles);
  std::vector<char> crosses(static_cast<std::size_t>(triangles.rows()), 0);
  const auto find = [&](Index t)
  {
    TriangleStars::Box box;
    Slabs::Corners corners;
    for (std::size_t a = 0; a < 3; ++a)
    {
      corners[a] = points.row(triangles(t, static_cast<int>(a))).transpose();
      box.extend(corners[a]);
    }
    char& found = crosses[static_cast<std::size_t>(t)];
    tree.VisitMeeting(
      t, corners, [&](const TriangleStars::Box& other) { return !found && box.intersects(other); },
      [&](Index u)
      {
        if (!found && u != t)
        {
          found = test.Cross(tree, t, u);
        }
      });
  };
  constexpr Index perReport = 1 << 16;
  const auto count = static_cast<Index>(triangles.rows());
  for (Index begin = 0; begin < count; begin += perReport)
  {
    progress.Report(static_cast<double>(begin) / count);
    ForEach(parallel, std::min(perReport, count - begin), [&](Index k) { find(begin + k); });
  }
  return crosses;
}

} // namespace SurfaceDiffusion
