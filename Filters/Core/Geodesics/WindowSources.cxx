// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/WindowFront.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

using Window = GeodesicWindow;
using Eigen::Vector2d;

const double Pi = std::acos(-1.0);

/// Points nearer to a vertex than this part of the shortest edge there are at the vertex.
constexpr double AtVertex = 1e-12;
/// Ways from points nearer than this part turn at the vertex, too: their directions there are less
/// certain.
constexpr double NearVertex = 1e-3;

double Entry(const std::array<double, 3>& at, Index corner)
{
  return at[static_cast<std::size_t>(corner % 3)];
}

} // namespace

void WindowFront::AddSource(const SourcePiece& piece, Index source)
{
  this->AddPoint(piece.Triangle, piece.From, source);
  if (piece.From != piece.To)
  {
    this->AddPoint(piece.Triangle, piece.To, source);
    this->AddStrips(piece, source);
    this->Pieces.insert({ piece.Triangle, { piece.From, piece.To, source } });
  }
}

WindowFront::NearestPiece WindowFront::FindNearestPiece(Index edge, const Vector2d& x) const
{
  NearestPiece nearest;
  const auto [begin, end] = this->Pieces.equal_range(edge / 3);
  for (auto found = begin; found != end; ++found)
  {
    const PieceWithin& piece = found->second;
    const Vector2d from = this->Frames.PlaceOn(edge, piece.From);
    const Vector2d along = this->Frames.PlaceOn(edge, piece.To) - from;
    const double square = along.squaredNorm();
    const double share = square > 0.0 ? std::clamp((x - from).dot(along) / square, 0.0, 1.0) : 0.0;
    const double distance = (x - from - share * along).norm();
    if (distance < nearest.Distance)
    {
      nearest = { distance, piece.From, piece.Source };
      for (std::size_t a = 0; a < 3 && share > 0.0; ++a)
      {
        nearest.At[a] += share * (piece.To[a] - piece.From[a]);
      }
    }
  }
  return nearest;
}

void WindowFront::ReachFrom(Index corner, const Vector2d& place, Index source)
{
  // In the frame of the edge that begins at the corner, so that short distances are precise
  const EdgeFrames::Frame& frame = this->Frames[CornerAfter(corner, 2)];
  const double distance = std::hypot(place[0], place[1]);
  Incoming incoming;
  incoming.Last.Corner = corner;
  if (distance >= NearVertex * std::min(frame.Length, frame.LeftLength))
  {
    incoming.Corner = corner;
    incoming.Angle = std::max(0.0, std::atan2(place[1], place[0]));
  }
  this->Reach(this->VertexAt(corner), distance, source, incoming);
}

void WindowFront::AddPoint(Index triangle, const std::array<double, 3>& at, Index source)
{
  const Index nearest =
    3 * triangle + static_cast<Index>(std::max_element(at.begin(), at.end()) - at.begin());
  const auto placeFrom = [&](Index corner)
  {
    const Index edge = CornerAfter(corner, 2);
    return this->Frames.PlaceOn(edge, at);
  };
  const EdgeFrames::Frame& around = this->Frames[nearest];
  const Vector2d place = placeFrom(nearest);
  const double distance = std::hypot(place[0], place[1]);
  if (distance <= AtVertex * std::min(around.LeftLength, around.RightLength))
  {
    this->Reach(this->VertexAt(nearest), distance, source, {});
    return;
  }
  // Ways from a point on an edge have no order there, and start behind it.
  this->LeavePoint(triangle, at, source, -1);
  for (Index edge = 3 * triangle; edge < 3 * triangle + 3; ++edge)
  {
    if (this->IsOnEdge(edge, at))
    {
      this->Frames.ForEachBehind(edge, false, this->Frames.Behind(edge),
        [&](Index other, bool mirrored)
        {
          std::array<double, 3> behind{ 0.0, 0.0, 0.0 };
          behind[static_cast<std::size_t>((other + 1) % 3)] = Entry(at, edge + (mirrored ? 2 : 1));
          behind[static_cast<std::size_t>((other + 2) % 3)] = Entry(at, edge + (mirrored ? 1 : 2));
          this->LeavePoint(other / 3, behind, source, other);
        });
    }
  }
}

bool WindowFront::IsOnEdge(Index edge, const std::array<double, 3>& at) const
{
  const EdgeFrames::Frame& frame = this->Frames[edge];
  return Entry(at, edge) * frame.Y <= AtVertex * frame.Length;
}

void WindowFront::LeavePoint(
  Index triangle, const std::array<double, 3>& at, Index source, Index behind)
{
  this->Pieces.insert({ triangle, { at, at, source } });
  for (Index edge = 3 * triangle; edge < 3 * triangle + 3; ++edge)
  {
    const Index before = CornerAfter(edge, 2);
    this->ReachFrom(edge, this->Frames.PlaceOn(before, at), source);
    if (behind >= 0 ? edge != behind : !this->IsOnEdge(edge, at))
    {
      const EdgeFrames::Frame& frame = this->Frames[edge];
      const Vector2d place = this->Frames.PlaceOn(edge, at);
      Window w{ 0.0, frame.Length, place[0], -place[1], 0.0, 0.0, 0.0, source, false, false };
      w.AtBegin = w.At(w.Begin);
      w.AtEnd = w.At(w.End);
      this->GoOver(edge, false, this->Frames.Behind(edge), w);
    }
  }
}

void WindowFront::AddStrips(const SourcePiece& piece, Index source)
{
  for (Index edge = 3 * piece.Triangle; edge < 3 * piece.Triangle + 3; ++edge)
  {
    // The corner at the begin of the edge
    const EdgeFrames::Frame& frame = this->Frames[edge];
    const Vector2d from = this->Frames.PlaceOn(edge, piece.From),
                   to = this->Frames.PlaceOn(edge, piece.To);
    const Vector2d along = to - from;
    const double length = along.norm(), share = -from.dot(along) / (length * length);
    if (!(length > 0.0))
    {
      return;
    }
    if (share > 0.0 && share < 1.0)
    {
      this->ReachFrom(CornerAfter(edge, 1), from + share * along, source);
    }
    // The ways out over this edge, at a right angle to the piece
    const double side = along[0] < 0.0 ? 1.0 : -1.0;
    const Vector2d way = Vector2d(-along[1], along[0]) * (side / length);
    if (!(way[1] < 0.0))
    {
      continue;
    }
    const double a = from[0] - way[0] * from[1] / way[1], b = to[0] - way[0] * to[1] / way[1];
    Window w{ std::clamp(std::min(a, b), 0.0, frame.Length),
      std::clamp(std::max(a, b), 0.0, frame.Length), -way[0], way[1], -from.dot(way), 0.0, 0.0,
      source, true, false };
    w.AtBegin = w.At(w.Begin);
    w.AtEnd = w.At(w.End);
    if (w.End > w.Begin)
    {
      this->GoOver(edge, false, this->Frames.Behind(edge), w);
    }
  }
}

void WindowFront::LeaveCorner(Index corner, double from, double to, double start, Index source)
{
  const EdgeFrames::Frame& frame = this->Frames[corner];
  const double angle = this->Frames.Angle(corner);
  // Seen from the corner at (X, Y), the angle from the edge to the begin
  const auto meet = [&](double turn)
  {
    const double c = std::cos(turn), s = std::sin(turn);
    const double x = -frame.X * c + frame.Y * s, y = -frame.X * s - frame.Y * c;
    return y < 0.0 ? std::clamp(frame.X - x * frame.Y / y, 0.0, frame.Length) : frame.Length;
  };
  Window w;
  w.Begin = from > 0.0 ? meet(from) : 0.0;
  w.End = to < angle ? meet(to) : frame.Length;
  w.X = frame.X;
  w.Y = -frame.Y;
  w.Start = start;
  w.Source = source;
  w.IsStrip = false;
  w.IsPast = false;
  w.AtBegin = w.At(w.Begin);
  w.AtEnd = w.At(w.End);
  const double margin = 2e-14 * (w.AtBegin + frame.Length);
  if (w.End > w.Begin &&
    !w.IsLongerThanBy(frame.Length, this->TimeAt(CornerAfter(corner, 1)),
      this->TimeAt(CornerAfter(corner, 2)), margin))
  {
    this->GoOver(corner, false, this->Frames.Behind(corner), w);
  }
}

void WindowFront::LeaveEverywhere(Index vertex)
{
  Incoming& way = this->Ways[static_cast<std::size_t>(vertex)];
  if (way.Corner >= 0 && this->Frames.PassingAt(vertex) != EdgeFrames::Passing::All)
  {
    way.Corner = -1;
    this->Queue.emplace(this->Times[static_cast<std::size_t>(vertex)], -1 - vertex);
  }
}

void WindowFront::LeaveVertex(Index vertex)
{
  const auto v = static_cast<std::size_t>(vertex);
  const double start = this->Times[v];
  const Index source = this->Sources[v];
  const Incoming way = this->Ways[v];
  const auto reachAlong = [&](Index corner)
  {
    const EdgeFrames::Frame& frame = this->Frames[corner];
    const Index first = CornerAfter(corner, 1), second = CornerAfter(corner, 2);
    const Index* const vertices = this->Mesh.TriangleVertices().data();
    this->Reach(vertices[first], start + frame.LeftLength, source,
      { first, this->Frames.Angle(first), { vertex, first } });
    this->Reach(
      vertices[second], start + frame.RightLength, source, { second, 0.0, { vertex, second } });
  };
  if (way.Corner < 0 || this->Frames.PassingAt(vertex) == EdgeFrames::Passing::All)
  {
    for (Index k = this->Mesh.VertexCornersBegin()[v]; k < this->Mesh.VertexCornersBegin()[v + 1];
         ++k)
    {
      const Index corner = this->Mesh.VertexCorners()[static_cast<std::size_t>(k)];
      reachAlong(corner);
      this->LeaveCorner(corner, 0.0, this->Frames.Angle(corner), start, source);
    }
    return;
  }
  // Ways go on where both sides have at least the angle pi
  constexpr double tolerance = 1e-10;
  const bool closed = this->Frames.IsClosed(vertex);
  const double begin = Pi - tolerance;
  const double end = closed ? this->Frames.TotalAngle(vertex) - Pi + tolerance : Never;
  for (const bool side : { true, false })
  {
    bool right = side;
    Index corner = way.Corner;
    double before = right ? -way.Angle : way.Angle - this->Frames.Angle(corner);
    while (corner >= 0 && before < end)
    {
      const double angle = this->Frames.Angle(corner);
      if (before + angle > begin)
      {
        reachAlong(corner);
        const double from = std::max(0.0, begin - before), to = std::min(angle, end - before);
        // Angles are measured from the side that this corner is entered by
        this->LeaveCorner(
          corner, right ? from : angle - to, right ? to : angle - from, start, source);
      }
      before += angle;
      corner = this->Frames.NextCorner(corner, right);
    }
    if (closed)
    {
      break;
    }
  }
}

} // namespace SurfaceDiffusion
