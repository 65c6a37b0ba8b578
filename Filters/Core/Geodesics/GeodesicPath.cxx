// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/GeodesicPath.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

using Eigen::Vector2d;
using LastPart = WindowFront::LastPart;

double CrossProduct(const Vector2d& a, const Vector2d& b)
{
  return a[0] * b[1] - a[1] * b[0];
}

MeshPlace AtCorner(Index corner)
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
  bool Follow(MeshPlace place, LastPart last)
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
  bool PassesCorner(Index corner, const Vector2d& at, const Vector2d& x, const Vector2d& end,
    double start, double size) const
  {
    constexpr double beside = 1e-9, roundOff = 1e-12;
    const Vector2d way = end - x;
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
  bool LeaveOver(Index edge, const MeshPlace& place, const Vector2d& end, double start)
  {
    const EdgeFrames::Frame& frame = this->Frames[edge];
    const Vector2d x = this->Frames.PlaceOn(edge, place.At);
    const Index first = CornerAfter(edge, 1), second = CornerAfter(edge, 2);
    for (const Index corner : { first, second })
    {
      const Vector2d at(corner == first ? 0.0 : frame.Length, 0.0);
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
  bool GoOver(Index edge, double crossing, Vector2d end, double start)
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
    Vector2d End = { 0.0, 0.0 };
  };

  /// Over the triangle of `edge`, from a place of this edge seen from its other side. mirrored: the edge
  /// runs the other way there.
  Step CrossTriangle(Index edge, bool mirrored, double crossing, Vector2d end, double start)
  {
    const EdgeFrames::Frame& frame = this->Frames[edge];
    crossing = mirrored ? frame.Length - crossing : crossing;
    end = { mirrored ? frame.Length - end[0] : end[0], -end[1] };
    const Vector2d x(crossing, 0.0), apex(frame.X, frame.Y), way = end - x;
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
    const Vector2d origin = left ? apex : Vector2d(frame.Length, 0.0);
    const double length = this->Frames[next].Length;
    const Vector2d u = ((left ? Vector2d(0.0, 0.0) : apex) - origin) / length;
    const Vector2d seen = end - origin, from = x - origin;
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

/// The shortest way of a front to a place.
class PathArrival
{
public:
  PathArrival(const TriangleMesh& mesh, const EdgeFrames& frames, const MeshPlace& place,
    const WindowFront& front)
    : Mesh(mesh)
    , Frames(frames)
    , Target(place)
    , Front(front)
  {
    const WindowFront::NearestPiece piece = front.FindNearestPiece(place);
    this->Take(piece.Distance, { -1, 3 * place.Triangle }, piece.Source);
  }

  /// Take windows that go over the triangle of the place.
  void Add(Index edge, const std::vector<GeodesicWindow>& windows)
  {
    const Vector2d x = this->Frames.PlaceOn(edge, this->Target.At);
    for (const GeodesicWindow& w : windows)
    {
      const double distance = w.Beyond(x[0], x[1]);
      if (distance < this->Least)
      {
        this->Take(distance, WindowFront::LastPartOver(edge, w, x), w.Source);
      }
    }
  }

  double Distance()
  {
    for (Index corner = 3 * this->Target.Triangle; corner < 3 * this->Target.Triangle + 3; ++corner)
    {
      const Index vertex = this->Mesh.TriangleVertices().data()[corner];
      const Index edge = CornerAfter(corner, 2); // begins at the corner
      const double distance = this->Front.Times[static_cast<std::size_t>(vertex)] +
        this->Frames.PlaceOn(edge, this->Target.At).norm();
      // Ways that only turn by the corner, through the end of a window there, are as long.
      constexpr double roundOff = 1e-13;
      if (distance < Never && distance <= (1.0 + roundOff) * this->Least)
      {
        this->Least = distance;
        this->Part = { vertex, corner };
        this->Piece = this->Front.Sources[static_cast<std::size_t>(vertex)];
      }
    }
    return this->Least;
  }
  const LastPart& Last() const { return this->Part; }
  Index LastPiece() const { return this->Piece; }

private:
  void Take(double distance, const LastPart& part, Index piece)
  {
    if (distance < this->Least)
    {
      this->Least = distance;
      this->Part = part;
      this->Piece = piece;
    }
  }

  const TriangleMesh& Mesh;
  const EdgeFrames& Frames;
  const MeshPlace& Target;
  const WindowFront& Front;
  double Least = Never;
  LastPart Part;
  Index Piece = -1;
};

} // namespace

GeodesicPath::Path GeodesicPath::Find(
  const MeshPlace& from, const MeshPlace& to, const ProgressMonitor& progress)
{
  return this->FindAll({ from }, { { to.Triangle, to.At, to.At } }, progress).front();
}

std::vector<GeodesicPath::Path> GeodesicPath::FindAll(const std::vector<MeshPlace>& from,
  const std::vector<SourcePiece>& to, const ProgressMonitor& progress)
{
  std::vector<Path> paths = this->FindOnce(from, to, progress);
  for (std::size_t k = 0; k < paths.size(); ++k)
  {
    Path& path = paths[k];
    if (path.Length < Never && !path.IsFollowed)
    {
      // Round-off among needles may hide a way from one end alone.
      const SourcePiece& piece = to[static_cast<std::size_t>(path.Piece)];
      const SourcePiece begin{ from[k].Triangle, from[k].At, from[k].At };
      if (piece.From == piece.To)
      {
        path = this->FindOnce({ { piece.Triangle, piece.From } }, { begin }, progress).front();
        path.Piece = static_cast<Index>(&piece - to.data());
        Turn(path);
      }
    }
    const auto length = [&](const PathSegment& segment)
    {
      const Index edge = 3 * segment.Triangle;
      return (this->Frames.PlaceOn(edge, segment.To) - this->Frames.PlaceOn(edge, segment.From))
        .norm();
    };
    const double least = 1e-13 * path.Length;
    path.Segments.erase(std::remove_if(path.Segments.begin(), path.Segments.end(),
                          [&](const PathSegment& segment) { return length(segment) <= least; }),
      path.Segments.end());
  }
  return paths;
}

/// From the other end.
void GeodesicPath::Turn(Path& path)
{
  std::reverse(path.Segments.begin(), path.Segments.end());
  for (PathSegment& segment : path.Segments)
  {
    std::swap(segment.From, segment.To);
  }
}

/// The ways back from places along windows that run from pieces.
std::vector<GeodesicPath::Path> GeodesicPath::FindOnce(const std::vector<MeshPlace>& from,
  const std::vector<SourcePiece>& to, const ProgressMonitor& progress)
{
  for (std::size_t k = 0; k < to.size(); ++k)
  {
    this->Front.AddSource(to[k], static_cast<Index>(k));
  }
  std::vector<char>& watched = this->Front.Watched;
  watched.assign(static_cast<std::size_t>(this->Mesh.NumberOfTriangles()), 0);
  std::vector<PathArrival> arrivals;
  std::unordered_multimap<Index, std::size_t> arrivalsAt; // triangles
  for (const MeshPlace& place : from)
  {
    watched[static_cast<std::size_t>(place.Triangle)] = 1;
    arrivalsAt.emplace(place.Triangle, arrivals.size());
    arrivals.emplace_back(this->Mesh, this->Frames, place, this->Front);
  }
  std::size_t open = arrivals.size();
  this->Front.Run(
    progress,
    [&](Index edge, const std::vector<GeodesicWindow>& windows)
    {
      const auto [begin, end] = arrivalsAt.equal_range(edge / 3);
      for (auto found = begin; found != end; ++found)
      {
        arrivals[found->second].Add(edge, windows);
      }
    },
    [&](double least)
    {
      while (open > 0 && least > arrivals[open - 1].Distance())
      {
        --open;
      }
      return open == 0;
    });
  std::vector<Path> paths;
  for (std::size_t k = 0; k < from.size(); ++k)
  {
    Path path;
    path.Length = arrivals[k].Distance();
    path.Piece = arrivals[k].LastPiece();
    path.IsFollowed = path.Length < Never &&
      PathTrace(this->Mesh, this->Frames, this->Front, path.Segments)
        .Follow(from[k], arrivals[k].Last());
    paths.push_back(std::move(path));
  }
  this->Front.Clear();
  return paths;
}

} // namespace SurfaceDiffusion
