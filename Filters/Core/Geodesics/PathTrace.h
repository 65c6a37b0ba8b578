// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Geodesics/EdgeFrames.h"
#include "Core/Geodesics/GeodesicPath.h"
#include "Core/Geodesics/WindowFront.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

inline double CrossProduct(const Eigen::Vector2d& a, const Eigen::Vector2d& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

inline MeshPlace AtCorner(Index corner)
{
  MeshPlace place{ corner / 3, { 0.0, 0.0, 0.0 } };
  place.At[static_cast<std::size_t>(corner % 3)] = 1.0;
  return place;
}

/// Follows the ways of a front back to its source.
class PathTrace
{
public:
  PathTrace(const TriangleMesh& mesh, const EdgeFrames& frames, const WindowFront& front,
    std::vector<PathSegment>& segments)
    : Mesh(mesh)
    , Frames(frames)
    , Front(front)
    , Segments(segments)
  {
  }

  /// Returns whether the source is met.
  bool Follow(MeshPlace place, WindowFront::LastPart last)
  {
    while (last.Corner >= 0)
    {
      if (last.IsOverEdge)
      {
        if (!this->LeaveOver(last.Corner, place, last.Place, last.Start))
        {
          return false;
        }
      }
      else if (last.From >= 0)
      {
        this->GoToVertex(place, last.From);
      }
      else
      {
        const WindowFront::NearestPiece piece = this->Front.FindNearestPiece(place);
        if (!(piece.Distance < Never))
        {
          return false;
        }
        this->Segments.push_back({ place.Triangle, place.At, piece.At });
        return true;
      }
      if (this->Vertex < 0)
      {
        return true;
      }
      this->Passed = this->Front.Times[static_cast<std::size_t>(this->Vertex)];
      last = this->Front.LastPartTo(this->Vertex);
      place = AtCorner(std::max(Index(0), last.Corner));
    }
    return true;
  }

private:
  Index VertexAt(Index corner) const { return this->Mesh.TriangleVertices().data()[corner]; }

  void GoToVertex(const MeshPlace& place, Index vertex)
  {
    Index corner = 3 * place.Triangle;
    while (this->VertexAt(corner) != vertex)
    {
      ++corner;
    }
    this->GoToCorner(place, corner);
  }
  void GoToCorner(const MeshPlace& place, Index corner)
  {
    this->Segments.push_back({ place.Triangle, place.At, AtCorner(corner).At });
    this->Vertex = this->VertexAt(corner);
  }

  /// Whether the path from x to `end`, in the frame of an edge of the triangle of `corner`, which lies
  /// at `at`, goes through this corner, but for round-off. start: the distance at `end`.
  bool PassesCorner(Index corner, const Eigen::Vector2d& at, const Eigen::Vector2d& x,
    const Eigen::Vector2d& end, double start, double size) const
  {
    constexpr double beside = 1e-9, roundOff = 1e-12;
    const Eigen::Vector2d way = end - x;
    const double length = way.norm(), tolerance = beside * (length + size);
    const double along = length > 0.0 ? (at - x).dot(way) / length : 0.0;
    const double aside =
      length > 0.0 ? std::abs(CrossProduct(way, at - x)) / length : (at - x).norm();
    const double time = this->Front.Times[static_cast<std::size_t>(this->VertexAt(corner))];
    return aside <= tolerance && along >= -tolerance && along <= length + tolerance &&
      time < this->Passed &&
      time + (at - x).norm() <= start + length + roundOff * (start + length + size);
  }

  /// From a place of a triangle over an edge of it, to the next vertex or the source.
  bool LeaveOver(Index edge, const MeshPlace& place, const Eigen::Vector2d& end, double start)
  {
    const EdgeFrames::Frame& frame = this->Frames[edge];
    const Eigen::Vector2d x = this->Frames.PlaceOn(edge, place.At);
    const Index first = CornerAfter(edge, 1), second = CornerAfter(edge, 2);
    for (const Index corner : { first, second })
    {
      const Eigen::Vector2d at(corner == first ? 0.0 : frame.Length, 0.0);
      if (this->PassesCorner(corner, at, x, end, start, frame.Length))
      {
        this->GoToCorner(place, corner);
        return true;
      }
    }
    const double rise = x[1] - end[1];
    const double crossing =
      std::clamp(rise > 0.0 ? x[0] - x[1] * (x[0] - end[0]) / rise : x[0], 0.0, frame.Length);
    this->Segments.push_back({ place.Triangle, place.At, this->Frames.PlaceAlong(edge, crossing) });
    return this->GoOver(edge, crossing, end, start);
  }

  /// From the place `crossing` of an edge into what lies behind it.
  bool GoOver(Index edge, double crossing, Eigen::Vector2d end, double start)
  {
    const std::size_t before = this->Segments.size();
    std::uint32_t behind = this->Frames.Behind(edge);
    while (behind < EdgeFrames::Several)
    {
      const auto other = static_cast<Index>(behind >> 1);
      const Step step = this->CrossTriangle(other, (behind & 1u) != 0, crossing, end, start);
      if (step.Edge < 0)
      {
        return step.IsOver;
      }
      edge = step.Edge;
      crossing = step.Crossing;
      end = step.End;
      behind = this->Frames.Behind(edge);
    }
    // Of several triangles, the path comes from one, whose continuation ends where ways begin.
    bool found = false;
    const std::size_t here = this->Segments.size();
    this->Frames.ForEachBehind(edge, false, behind,
      [&](Index other, bool mirrored)
      {
        if (found)
        {
          return;
        }
        this->Segments.resize(here);
        const Step step = this->CrossTriangle(other, mirrored, crossing, end, start);
        found =
          step.Edge < 0 ? step.IsOver : this->GoOver(step.Edge, step.Crossing, step.End, start);
      });
    if (!found)
    {
      this->Segments.resize(before);
    }
    return found;
  }

  struct Step
  {
    Index Edge = -1; ///< that the triangle is left by; -1: the straight line ends here
    bool IsOver = false; ///< it has ended at a vertex or the source
    double Crossing = 0.0;
    Eigen::Vector2d End = { 0.0, 0.0 };
  };

  /// Over the triangle of `edge`, from a place of this edge seen from its other side. mirrored: the edge
  /// runs the other way there.
  Step CrossTriangle(Index edge, bool mirrored, double crossing, Eigen::Vector2d end, double start)
  {
    const EdgeFrames::Frame& frame = this->Frames[edge];
    crossing = mirrored ? frame.Length - crossing : crossing;
    end = { mirrored ? frame.Length - end[0] : end[0], -end[1] };
    const Eigen::Vector2d x(crossing, 0.0), apex(frame.X, frame.Y), way = end - x;
    const double size = std::max(frame.LeftLength, frame.RightLength);
    const MeshPlace place{ edge / 3, this->Frames.PlaceAlong(edge, crossing) };
    if (start == 0.0 && this->Front.Pieces.count(place.Triangle) > 0)
    {
      constexpr double tolerance = 1e-9;
      const WindowFront::NearestPiece piece = this->Front.FindNearestPiece(edge, end);
      if (piece.Distance <= tolerance * (way.norm() + size))
      {
        this->Segments.push_back({ place.Triangle, place.At, piece.At });
        this->Vertex = -1;
        return { -1, true };
      }
    }
    if (this->PassesCorner(edge, apex, x, end, start, size))
    {
      this->GoToCorner(place, edge);
      return { -1, true };
    }
    // The next edge begins at the apex on the left and ends there on the right
    const bool left = CrossProduct(way, apex - x) < 0.0;
    const Index next = CornerAfter(edge, left ? 2 : 1);
    const Eigen::Vector2d origin = left ? apex : Eigen::Vector2d(frame.Length, 0.0);
    const double length = this->Frames[next].Length;
    const Eigen::Vector2d u = ((left ? Eigen::Vector2d(0.0, 0.0) : apex) - origin) / length;
    const Eigen::Vector2d seen = end - origin, from = x - origin;
    Step step{ next, false, 0.0, { seen.dot(u), CrossProduct(u, seen) } };
    const double height = CrossProduct(u, from), rise = height - step.End[1];
    if (!(step.End[1] <= 0.0) || !(rise > 0.0))
    {
      return {}; // the line ends within the triangle, where no way begins
    }
    const double along = from.dot(u);
    step.Crossing = std::clamp(along - height * (along - step.End[0]) / rise, 0.0, length);
    this->Segments.push_back(
      { place.Triangle, place.At, this->Frames.PlaceAlong(next, step.Crossing) });
    return step;
  }

  const TriangleMesh& Mesh;
  const EdgeFrames& Frames;
  const WindowFront& Front;
  std::vector<PathSegment>& Segments;
  Index Vertex = -1; ///< where the last straight line has ended; -1: at the source
  double Passed = Never; ///< the distance of the last vertex: further ones are nearer to the source
};

} // namespace SurfaceDiffusion
