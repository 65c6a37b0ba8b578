// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/GeodesicPath.h"

#include "Core/Geodesics/PathTrace.h"

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
        this->Take(
          distance, { vertex, corner }, this->Front.Sources[static_cast<std::size_t>(vertex)]);
      }
    }
    return this->Least;
  }
  const LastPart& Last() const { return this->Part; }
  Index LastPiece() const { return this->Piece; }

private:
  void Take(double distance, const LastPart& part, Index piece)
  {
    this->Least = distance;
    this->Part = part;
    this->Piece = piece;
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
