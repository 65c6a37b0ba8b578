// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace SurfaceDiffusion
{

/// The corner, or the edge opposite, that is `step` = 0, 1 or 2 after 3 t + a in its triangle.
inline Index CornerAfter(Index corner, int step)
{
  return corner - corner % 3 + (corner + step) % 3;
}

/// The triangles of a mesh laid out from each of their edges, and what lies behind the edges.
///
/// Edge 3 t + a of triangle t is the one opposite corner a, from its corner a + 1 to its corner
/// a + 2. Two triangles that share an edge have it twice, in the same or in opposite directions.
class EdgeFrames
{
public:
  /// The triangle in the plane, with the edge from (0, 0) to (Length, 0) and the corner opposite at
  /// (X, Y), Y > 0.
  struct Frame
  {
    double Length, X, Y;
    double LeftLength, RightLength; ///< of the edges at the begin and at the end
    double OverLeft, OverRight; ///< one over these
    std::uint32_t BehindLeft,
      BehindRight; ///< the left one away from the begin, the right to the end
  };

  /// The other edges at an edge: none, several, or one with Reversed(), twice its number plus
  /// whether it runs the other way.
  static constexpr std::uint32_t Nothing = 0xffffffffu;
  static constexpr std::uint32_t Several = 0xfffffffeu;

  /// What ways do that come to a vertex.
  enum class Passing : char
  {
    None, ///< they end: going by on a side is shorter
    Around, ///< they go on where both sides have at least the angle pi
    All ///< they go on everywhere: triangles form no single fan around the vertex
  };

  explicit EdgeFrames(const TriangleMesh& mesh);

  const Frame& operator[](Index edge) const { return this->Frames[static_cast<std::size_t>(edge)]; }
  /// What lies behind edge 3 t + a, seen along its own direction.
  std::uint32_t Behind(Index edge) const
  {
    const std::uint32_t code =
      this->Frames[static_cast<std::size_t>(edge - edge % 3 + (edge + 1) % 3)].BehindLeft;
    return code >= Several ? code : code ^ 1u;
  }
  /// use(other, reversed) for all edges where ways come out that go over `edge`, whose `behind` is
  /// known.
  template <typename Use>
  void ForEachBehind(Index edge, bool reversed, std::uint32_t behind, const Use& use) const
  {
    if (behind < Several)
    {
      use(static_cast<Index>(behind >> 1), (behind & 1u) != 0);
    }
    else if (behind == Several)
    {
      const Index group = this->GroupOf[static_cast<std::size_t>(edge)];
      for (Index k = this->GroupBegin[static_cast<std::size_t>(group)];
           k < this->GroupBegin[static_cast<std::size_t>(group) + 1]; ++k)
      {
        const Index other = this->Members[static_cast<std::size_t>(k)];
        if (other != edge)
        {
          use(other, reversed != (this->IsUpward(edge) != this->IsUpward(other)));
        }
      }
    }
  }

  /// A point of a triangle, in barycentric coordinates, in the frame of one of its edges.
  Eigen::Vector2d PlaceOn(Index edge, const std::array<double, 3>& at) const
  {
    const Frame& frame = (*this)[edge];
    const double apex = at[static_cast<std::size_t>(edge % 3)];
    const double end = at[static_cast<std::size_t>((edge + 2) % 3)];
    return { end * frame.Length + apex * frame.X, std::max(0.0, apex) * frame.Y };
  }
  /// The barycentric coordinates of the place x of an edge, 0 to its length.
  std::array<double, 3> PlaceAlong(Index edge, double x) const
  {
    std::array<double, 3> at = { 0.0, 0.0, 0.0 };
    at[static_cast<std::size_t>((edge + 2) % 3)] = x / (*this)[edge].Length;
    at[static_cast<std::size_t>((edge + 1) % 3)] =
      1.0 - at[static_cast<std::size_t>((edge + 2) % 3)];
    return at;
  }

  double Angle(Index corner) const { return this->Angles[static_cast<std::size_t>(corner)]; }
  double TotalAngle(Index vertex) const
  {
    return this->TotalAngles[static_cast<std::size_t>(vertex)];
  }
  Passing PassingAt(Index vertex) const { return this->Passings[static_cast<std::size_t>(vertex)]; }
  bool IsClosed(Index vertex) const { return this->Closed[static_cast<std::size_t>(vertex)] != 0; }

  /// The corner of the same vertex beside `corner`, across the edge at its own left (to corner
  /// a + 1) or right (to corner a + 2), and the side of it to leave by when one goes on; -1: none,
  /// or several.
  Index NextCorner(Index corner, bool& right) const;

private:
  void LinkEdges();
  void ClassifyVertices();
  bool IsUpward(Index edge) const
  {
    return this->Mesh.OtherCorner(edge, 1) < this->Mesh.OtherCorner(edge, 2);
  }

  const TriangleMesh& Mesh;
  std::vector<Frame> Frames;
  std::vector<Index> GroupOf, GroupBegin, Members; ///< edges of three or more triangles
  std::vector<double> Angles, TotalAngles;
  std::vector<Passing> Passings;
  std::vector<char> Closed;
};

} // namespace SurfaceDiffusion
