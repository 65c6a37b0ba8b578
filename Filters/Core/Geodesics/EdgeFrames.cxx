// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/EdgeFrames.h"

#include "Core/Foundation/Grouping.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// Angles that differ by less from pi and 2 pi are those. Windows bridge such gaps (see
/// WindowFront.cxx).
constexpr double AngleTolerance = 1e-11;
const double HalfTurn = std::acos(-1.0);

} // namespace

EdgeFrames::EdgeFrames(const TriangleMesh& mesh)
  : Mesh(mesh)
  , Frames(3 * static_cast<std::size_t>(mesh.NumberOfTriangles()))
  , Angles(this->Frames.size())
  , TotalAngles(static_cast<std::size_t>(mesh.NumberOfVertices()), 0.0)
  , Passings(this->TotalAngles.size(), Passing::None)
  , Closed(this->TotalAngles.size(), 0)
{
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const TriangleMesh::Shape shape = mesh.Shapes()[static_cast<std::size_t>(t)];
    const double length[3] = { shape.EdgeLength(0), shape.EdgeLength(1), shape.Length };
    const double area = shape.Length * shape.Y; // twice
    for (int a = 0; a < 3; ++a)
    {
      const double base = length[a], left = length[(a + 2) % 3], right = length[(a + 1) % 3];
      // From the corners of the shape, without differences of squares
      const double alongLeft = a == 0 ? shape.Length * (shape.Length - shape.X)
        : a == 1                      ? shape.X * (shape.X - shape.Length) + shape.Y * shape.Y
                                      : shape.Length * shape.X;
      Frame& frame = this->Frames[static_cast<std::size_t>(3 * t + a)];
      frame = { base, alongLeft / base, area / base, left, right, 1.0 / left, 1.0 / right, Nothing,
        Nothing };
      this->Angles[static_cast<std::size_t>(3 * t + (a + 1) % 3)] = std::atan2(area, alongLeft);
    }
  }
  this->LinkEdges();
  this->ClassifyVertices();
}

void EdgeFrames::LinkEdges()
{
  const TriangleMesh& mesh = this->Mesh;
  const bool numbered = mesh.TriangleEdges().rows() > 0;
  const auto edges = static_cast<Index>(this->Frames.size());
  const auto lower = [&](Index edge)
  {
    return numbered ? mesh.TriangleEdges().data()[edge]
                    : std::min(mesh.OtherCorner(edge, 1), mesh.OtherCorner(edge, 2));
  };
  const auto upper = [&](Index edge)
  { return numbered ? Index(0) : std::max(mesh.OtherCorner(edge, 1), mesh.OtherCorner(edge, 2)); };
  // Sets what lies behind an edge in the frames of the other two edges of its triangle.
  const auto set = [&](Index edge, std::uint32_t code)
  {
    const Index first = edge - edge % 3;
    this->Frames[static_cast<std::size_t>(first + (edge + 1) % 3)].BehindLeft =
      code >= Several ? code : code ^ 1u;
    this->Frames[static_cast<std::size_t>(first + (edge + 2) % 3)].BehindRight = code;
  };
  const Groups groups =
    GroupByKey(edges, numbered ? edges : mesh.NumberOfVertices(), SerialFor(), lower);
  std::vector<std::pair<Index, Index>> here;
  for (std::size_t key = 0; key + 1 < groups.Begin.size(); ++key)
  {
    here.clear();
    for (Index k = groups.Begin[key]; k < groups.Begin[key + 1]; ++k)
    {
      const Index edge = groups.Items[static_cast<std::size_t>(k)];
      here.emplace_back(upper(edge), edge);
    }
    std::sort(here.begin(), here.end());
    for (std::size_t first = 0, end = 0; first < here.size(); first = end)
    {
      while (end < here.size() && here[end].first == here[first].first)
      {
        ++end;
      }
      if (end - first == 2)
      {
        const Index a = here[first].second, b = here[first + 1].second;
        const std::uint32_t reversed = this->IsUpward(a) != this->IsUpward(b) ? 1 : 0;
        set(a, (static_cast<std::uint32_t>(b) << 1) | reversed);
        set(b, (static_cast<std::uint32_t>(a) << 1) | reversed);
      }
      else if (end - first > 2)
      {
        this->GroupOf.resize(this->Frames.size(), -1);
        for (std::size_t k = first; k < end; ++k)
        {
          this->GroupOf[static_cast<std::size_t>(here[k].second)] =
            static_cast<Index>(this->GroupBegin.size());
          set(here[k].second, Several);
        }
        this->GroupBegin.push_back(static_cast<Index>(this->Members.size()));
        for (std::size_t k = first; k < end; ++k)
        {
          this->Members.push_back(here[k].second);
        }
      }
    }
  }
  this->GroupBegin.push_back(static_cast<Index>(this->Members.size()));
}

Index EdgeFrames::NextCorner(Index corner, bool& right) const
{
  const Index first = corner - corner % 3;
  // The edge to corner a + 1 is opposite corner a + 2 and begins at the vertex; the other one ends
  // there.
  const std::uint32_t behind = this->Behind(first + (corner + (right ? 1 : 2)) % 3);
  if (behind >= Several)
  {
    return -1;
  }
  const auto edge = static_cast<Index>(behind >> 1);
  const bool atBegin = right == ((behind & 1u) != 0);
  right = atBegin; // the edge is then the left one of the corner there
  return edge - edge % 3 + (edge + (atBegin ? 1 : 2)) % 3;
}

void EdgeFrames::ClassifyVertices()
{
  const TriangleMesh& mesh = this->Mesh;
  for (Index v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    const Index begin = mesh.VertexCornersBegin()[static_cast<std::size_t>(v)];
    const Index end = mesh.VertexCornersBegin()[static_cast<std::size_t>(v) + 1];
    double total = 0.0;
    for (Index k = begin; k < end; ++k)
    {
      total += this->Angle(mesh.VertexCorners()[static_cast<std::size_t>(k)]);
    }
    this->TotalAngles[static_cast<std::size_t>(v)] = total;
    if (begin == end)
    {
      continue;
    }
    // One fan if all triangles are met to the right and to the left of one of them
    const Index start = mesh.VertexCorners()[static_cast<std::size_t>(begin)];
    Index met = 1;
    bool closed = false;
    for (const bool side : { true, false })
    {
      bool right = side;
      Index corner = start;
      while (!closed && met <= end - begin)
      {
        corner = this->NextCorner(corner, right);
        closed = corner == start;
        if (corner < 0 || closed)
        {
          break;
        }
        ++met;
      }
    }
    this->Closed[static_cast<std::size_t>(v)] = closed ? 1 : 0;
    const double turn = closed ? 2.0 * HalfTurn : HalfTurn;
    Passing& passing = this->Passings[static_cast<std::size_t>(v)];
    passing = met != end - begin      ? Passing::All
      : total > turn + AngleTolerance ? Passing::Around
                                      : Passing::None;
  }
  for (const Index edge : this->Members)
  {
    for (const int step : { 1, 2 })
    {
      this->Passings[static_cast<std::size_t>(mesh.OtherCorner(edge, step))] = Passing::All;
    }
  }
}

} // namespace SurfaceDiffusion
