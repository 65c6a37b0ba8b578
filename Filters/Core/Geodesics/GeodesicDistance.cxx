// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geodesics/GeodesicDistance.h"

#include "Core/Foundation/DisjointSets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The angle above 2 pi from which on a vertex is a saddle, in radians. On fine surfaces, whose angles
/// differ less, ways along edges are mostly those of the triangulation.
constexpr double SmallestSaddle = 0.5;

/// Of the length of an edge between its two triangles, relative, from which on their speeds are two, and
/// fronts are refracted. Of smooth speeds on fine surfaces, jumps are smaller.
constexpr double SmallestJump = 0.1;

/// A triangle ABC in the plane: A at the origin, B at (Edge, 0), C above.
struct LaidOut
{
  double Edge, X, Y;

  LaidOut(double ab, double ca, double cb)
    : Edge(ab)
    , X((ca * ca - cb * cb + ab * ab) / (2.0 * ab))
    , Y(std::sqrt(std::max(0.0, ca * ca - X * X)))
  {
  }

  /// The distance of C from a point below AB at distances da from A and db from B, or infinity if
  /// its straight line does not cross AB, or there is none.
  double FromPoint(double da, double db) const
  {
    const double x = (da * da - db * db + this->Edge * this->Edge) / (2.0 * this->Edge);
    const double square = da * da - x * x;
    constexpr double roundOff = 1e-9;
    if (square < -roundOff * this->Edge * this->Edge)
    {
      return Never; // no point has these distances
    }
    const double y = std::sqrt(std::max(0.0, square));
    const double crossing = x * this->Y + this->X * y; // of AB, times Y + y
    const bool crosses = crossing >= 0.0 && crossing <= this->Edge * (this->Y + y);
    return crosses && this->Y > 0.0 ? std::hypot(this->X - x, this->Y + y) : Never;
  }

  /// The same for a plane front.
  double FromPlane(double da, double db) const
  {
    const double along = (db - da) / this->Edge; // of the gradient
    if (!(std::abs(along) < 1.0))
    {
      return Never;
    }
    const double up = std::sqrt((1.0 - along) * (1.0 + along));
    const double crossing = this->X * up - this->Y * along; // of AB, times `up`
    return crossing >= 0.0 && crossing <= this->Edge * up ? da + along * this->X + up * this->Y
                                                          : Never;
  }
};

} // namespace

GeodesicDistance::GeodesicDistance(std::shared_ptr<const TriangleMesh> mesh, FrontShapes shapes)
  : Mesh(std::move(mesh))
  , Shapes(std::move(shapes))
{
  this->FindCorners();
  this->FindBehind();
  this->FindGates();
}

/// The vertices of boundaries and barriers with an open angle above pi, and others with one above 2 pi.
void GeodesicDistance::FindCorners()
{
  const TriangleMesh& mesh = *this->Mesh;
  const auto n = static_cast<std::size_t>(mesh.NumberOfVertices());
  std::vector<double> angles(n, 0.0);
  std::vector<char> isOnRim(n, 0);
  for (const Index vertex : mesh.BoundaryVertices())
  {
    isOnRim[static_cast<std::size_t>(vertex)] = 1;
  }
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const TriangleMesh::Shape shape = this->ShapeOf(t);
    const bool isOpen = !IsBarrier(this->Shapes, t);
    const double first = std::atan2(shape.Y, shape.X);
    const double second = std::atan2(shape.Y, shape.Length - shape.X);
    const double angle[] = { first, second, std::acos(-1.0) - first - second };
    for (int a = 0; a < 3; ++a)
    {
      const auto vertex = static_cast<std::size_t>(mesh.TriangleVertices()(t, a));
      // Both sheets of a surface that is covered twice have each angle.
      angles[vertex] += isOpen ? shape.Weight * angle[a] : 0.0;
      isOnRim[vertex] = isOnRim[vertex] != 0 || !isOpen;
    }
  }
  const double straight = std::acos(-1.0) * (1.0 + 1e-6);
  const double saddle = 2.0 * std::acos(-1.0) + SmallestSaddle;
  this->IsCorner.resize(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    this->IsCorner[i] = angles[i] > (isOnRim[i] != 0 ? straight : saddle);
  }
}

/// Sides without another open triangle, and all sides of triangles that have a vertex twice: times at
/// two places of one vertex say nothing of the way between them.
void GeodesicDistance::FindGates()
{
  const TriangleMesh& mesh = *this->Mesh;
  const Triangles& edges = mesh.TriangleEdges();
  const Index sides = 3 * mesh.NumberOfTriangles();
  std::vector<char> uses(edges.rows() > 0 ? static_cast<std::size_t>(sides) : 0, 0);
  for (Index side = 0; edges.rows() > 0 && side < sides; ++side)
  {
    char& known = uses[static_cast<std::size_t>(edges.data()[side])];
    known = static_cast<char>(std::min(2, known + (IsBarrier(this->Shapes, side / 3) ? 0 : 1)));
  }
  this->IsClosed.assign(static_cast<std::size_t>(sides), 0);
  for (Index side = 0; side < sides; ++side)
  {
    const Index i = mesh.OtherCorner(side, 1);
    const Index j = mesh.OtherCorner(side, 2);
    const bool isOpen = edges.rows() == 0 ? this->Behind[static_cast<std::size_t>(side)] >= 0
                                          : uses[static_cast<std::size_t>(edges.data()[side])] > 1;
    const Index opposite = mesh.TriangleVertices().data()[side];
    const bool isLoop = i == j || i == opposite || j == opposite;
    this->IsClosed[static_cast<std::size_t>(side)] = isLoop ? 2 : (isOpen ? 0 : 1);
  }
}

void GeodesicDistance::FindBehind()
{
  const TriangleMesh& mesh = *this->Mesh;
  const auto lengthOf = [this](Index side) { return this->ShapeOf(side / 3).EdgeLength(side % 3); };
  const bool isNeeded = !this->Shapes.empty() || mesh.TriangleEdges().rows() == 0;
  const auto vertices = isNeeded ? mesh.NumberOfVertices() : 0;
  this->Behind.assign(isNeeded ? 3 * static_cast<std::size_t>(mesh.NumberOfTriangles()) : 0, -1);
  std::vector<std::pair<Index, Index>> sides; // of the edges to vertices of higher numbers
  for (Index i = 0; i < vertices; ++i)
  {
    sides.clear();
    const Index end = mesh.VertexCornersBegin()[static_cast<std::size_t>(i) + 1];
    for (Index k = mesh.VertexCornersBegin()[static_cast<std::size_t>(i)]; k < end; ++k)
    {
      const Index corner = mesh.VertexCorners()[static_cast<std::size_t>(k)];
      for (const int step : { 1, 2 })
      {
        const Index j = mesh.OtherCorner(corner, step);
        if (j > i && !IsBarrier(this->Shapes, corner / 3))
        {
          sides.emplace_back(j, corner - corner % 3 + (corner % 3 + 3 - step) % 3);
        }
      }
    }
    std::sort(sides.begin(), sides.end());
    for (auto begin = sides.begin(); begin != sides.end();)
    {
      const auto next = std::find_if(
        begin, sides.end(), [j = begin->first](const auto& side) { return side.first != j; });
      std::array<Index, 2> shortest = { -1, -1 };
      for (auto side = begin; side != next; ++side)
      {
        if (shortest[0] < 0 || lengthOf(side->second) < lengthOf(shortest[0]))
        {
          shortest = { side->second, shortest[0] };
        }
        else if (shortest[1] < 0 || lengthOf(side->second) < lengthOf(shortest[1]))
        {
          shortest[1] = side->second;
        }
      }
      for (; begin != next; ++begin)
      {
        this->Behind[static_cast<std::size_t>(begin->second)] =
          begin->second == shortest[0] ? shortest[1] : shortest[0];
      }
    }
  }
  if (!this->Shapes.empty())
  {
    this->FindMedia();
  }
}

void GeodesicDistance::FindMedia()
{
  DisjointSets media(static_cast<Index>(this->Shapes.size()));
  for (Index side = 0; side < static_cast<Index>(this->Behind.size()); ++side)
  {
    const Index behind = this->Behind[static_cast<std::size_t>(side)];
    const double edge = this->ShapeOf(side / 3).EdgeLength(side % 3);
    if (behind >= 0 &&
      std::abs(this->ShapeOf(behind / 3).EdgeLength(behind % 3) - edge) <= SmallestJump * edge)
    {
      media.Join(side / 3, behind / 3);
    }
  }
  this->Medium = media.Labels();
}

/// Whether the way to an end of the side opposite a corner has a radius of the medium behind.
bool GeodesicDistance::FitsBehind(Index corner, Index vertex, const Memory& memory) const
{
  const Index behind = this->Behind.empty() ? -1 : this->Behind[static_cast<std::size_t>(corner)];
  const Index medium = memory.Media[static_cast<std::size_t>(vertex)];
  return behind < 0 || medium < 0 || medium == this->Medium[static_cast<std::size_t>(behind / 3)];
}

/// The start of a front before the side opposite a corner, which has this length here, from that behind
/// and the times at both ends. These times and the curvature of the time along the side, in a plane the
/// squared cosine of the angle of incidence over the radius, are the same on both sides. The radius does
/// not become smaller: fronts would be early where the way does not come from behind. It stays where
/// lengths all but agree, as with smooth speeds: it would drift from edge to edge.
double GeodesicDistance::Refracted(
  Index corner, double edge, double one, double other, double start) const
{
  constexpr double far = 1e6; // of a radius, in edges
  const Index side = this->Behind.empty() ? -1 : this->Behind[static_cast<std::size_t>(corner)];
  const double behind = side < 0 ? edge : this->ShapeOf(side / 3).EdgeLength(side % 3);
  if (std::abs(behind - edge) <= SmallestJump * edge)
  {
    return start;
  }
  const double slope = other - one;
  const double middle = 0.5 * (one + other);
  const double factor =
    std::max(1.0, (edge - slope) * (edge + slope) / ((behind - slope) * (behind + slope)));
  const double radius = factor * (middle - start);
  return std::abs(slope) < behind && radius < far * edge ? middle - radius : -Never;
}

/// The first way to a corner of a triangle through the triangle.
GeodesicDistance::Way GeodesicDistance::WayThrough(
  Index corner, const std::vector<FrontSource>& fronts, const Memory& memory) const
{
  const Arrival& arrival = memory.Found;
  const Index t = corner / 3;
  if (IsBarrier(this->Shapes, t))
  {
    return { Never, -1, -1, 0.0, -1 };
  }
  const int a = corner % 3;
  const TriangleMesh::Shape shape = this->ShapeOf(t);
  const Index second = this->Mesh->OtherCorner(corner, 1);
  const Index third = this->Mesh->OtherCorner(corner, 2);
  const double toSecond = shape.EdgeLength((a + 2) % 3);
  const double toThird = shape.EdgeLength((a + 1) % 3);
  const double ofSecond = arrival.Times[static_cast<std::size_t>(second)];
  const double ofThird = arrival.Times[static_cast<std::size_t>(third)];
  const Index bySecond = arrival.Sources[static_cast<std::size_t>(second)];
  const Index byThird = arrival.Sources[static_cast<std::size_t>(third)];
  const double startOfSecond = memory.Starts[static_cast<std::size_t>(second)];
  const double startOfThird = memory.Starts[static_cast<std::size_t>(third)];
  const Index medium = this->Medium.empty() ? -1 : this->Medium[static_cast<std::size_t>(t)];
  Way way{ ofSecond + toSecond, bySecond, second, startOfSecond, medium };
  if (ofThird + toThird < way.Time)
  {
    way = { ofThird + toThird, byThird, third, startOfThird, medium };
  }
  if (bySecond < 0 || byThird < 0)
  {
    return way;
  }
  const FrontSource& one = fronts[static_cast<std::size_t>(bySecond)];
  const FrontSource& other = fronts[static_cast<std::size_t>(byThird)];
  if (one.Label != other.Label)
  {
    return way;
  }
  // A vertex that a front starts from, a source or a corner, is a point of it.
  const auto startsAt = [](const FrontSource& front, Index vertex)
  { return front.Vertex == vertex && front.Time == front.Start; };
  const bool areTwoPoints = one.Point >= 0 && other.Point >= 0 && one.Point != other.Point;
  const char isClosed = this->IsClosed[static_cast<std::size_t>(corner)];
  const bool isSource = areTwoPoints && startsAt(one, second) && startsAt(other, third);
  if (isClosed == 2 || (isClosed == 1 && !isSource))
  {
    return way;
  }
  const double edge = shape.EdgeLength(a);
  const LaidOut triangle(edge, toSecond, toThird);
  // Of a way around a corner and another one, the point where both begin
  const bool isOther =
    startsAt(other, second) || (!startsAt(one, third) && startOfThird < startOfSecond);
  const double start =
    this->Refracted(corner, edge, ofSecond, ofThird, isOther ? startOfThird : startOfSecond);
  const bool fitsSecond = this->FitsBehind(corner, second, memory);
  const bool fitsThird = this->FitsBehind(corner, third, memory);
  const double first = std::min(ofSecond, ofThird);
  double through = start + triangle.FromPoint(ofSecond - start, ofThird - start);
  // The point that a refracted front seems to come from may be too near: not before both ends.
  const bool isTooNear = start != one.Start && start != other.Start && through < first;
  const bool isPlane = start == -Never || !fitsSecond || !fitsThird || isTooNear ||
    (areTwoPoints && !startsAt(one, third) && !startsAt(other, second));
  if (isPlane)
  {
    through = first + triangle.FromPlane(ofSecond - first, ofThird - first);
  }
  if (!(through < way.Time))
  {
    return way;
  }
  const bool isFirst = ofSecond < ofThird;
  double startHere = bySecond == byThird ? start : (isFirst ? startOfSecond : startOfThird);
  if (fitsSecond != fitsThird)
  {
    startHere =
      this->Refracted(corner, edge, ofSecond, ofThird, fitsSecond ? startOfSecond : startOfThird);
  }
  return { through, isFirst ? bySecond : byThird, -1, startHere, medium };
}

} // namespace SurfaceDiffusion
