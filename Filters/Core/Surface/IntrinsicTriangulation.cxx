// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/IntrinsicTriangulation.h"

#include "Core/Foundation/Grouping.h"
#include "Core/Surface/SideLengths.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

using Vec2 = Eigen::Vector2d;

/// The side of the back of the same triangle, whose corners 1 and 2 are exchanged.
Index BackOf(Index side, Index triangleCount)
{
  constexpr int behind[3] = { 0, 2, 1 };
  return 3 * (triangleCount + side / 3) + behind[side % 3];
}

} // namespace

IntrinsicTriangulation::IntrinsicTriangulation(
  const TriangleMesh& mesh, BoundaryEdges boundary, const ParallelFor& parallel)
{
  const EdgeList edges = ListEdges(mesh, parallel);
  this->TwoSheets = !IsOneSheet(edges.Uses, parallel);
  this->MakeSheets(mesh, parallel);
  this->JoinSheets(edges, mesh.NumberOfTriangles(), parallel);
  this->Mollify(parallel);
  if (boundary == BoundaryEdges::Keep && this->TwoSheets)
  {
    this->PartSheetsAtBoundaries(mesh.NumberOfTriangles());
  }
}

IntrinsicTriangulation::EdgeList IntrinsicTriangulation::ListEdges(
  const TriangleMesh& mesh, const ParallelFor& parallel)
{
  const auto& vertices = mesh.TriangleVertices();
  const auto from = [&](Index side) { return vertices(side / 3, Next(side % 3)); };
  const auto to = [&](Index side) { return vertices(side / 3, Last(side % 3)); };
  Groups sides = GroupByKey(3 * mesh.NumberOfTriangles(), mesh.NumberOfVertices(), parallel,
    [&](Index side) { return std::min(from(side), to(side)); });
  EdgeList edges;
  edges.Uses = Buffer<EdgeUse>(sides.Items.size());
  ForEach(parallel, mesh.NumberOfVertices(),
    [&](Index low)
    {
      const auto begin = edges.Uses.begin() + sides.Begin[low];
      const auto end = edges.Uses.begin() + sides.Begin[low + 1];
      std::transform(sides.Items.begin() + sides.Begin[low],
        sides.Items.begin() + sides.Begin[low + 1], begin,
        [&](Index side) -> EdgeUse {
          return { low, std::max(from(side), to(side)), side, from(side) < to(side) };
        });
      std::sort(begin, end,
        [](const EdgeUse& i, const EdgeUse& j)
        { return std::tie(i.High, i.Side) < std::tie(j.High, j.Side); });
    });
  edges.Begin = std::move(sides.Begin);
  return edges;
}

/// Whether every edge joins two triangles that run along it in opposite directions.
bool IntrinsicTriangulation::IsOneSheet(const Buffer<EdgeUse>& uses, const ParallelFor& parallel)
{
  const auto joinsTwo = [&](std::size_t i)
  {
    return uses[i].SameEdge(uses[i + 1]) &&
      !(i + 2 < uses.size() && uses[i].SameEdge(uses[i + 2])) &&
      uses[i].Ascending != uses[i + 1].Ascending;
  };
  return uses.size() % 2 == 0 &&
    Max(parallel, static_cast<Index>(uses.size() / 2),
      [&](Index pair) { return joinsTwo(2 * static_cast<std::size_t>(pair)) ? 0.0 : 1.0; }) == 0.0;
}

void IntrinsicTriangulation::MakeSheets(const TriangleMesh& mesh, const ParallelFor& parallel)
{
  const Index count = mesh.NumberOfTriangles();
  this->Triangles = Buffer<Triangle>((this->TwoSheets ? 2 : 1) * static_cast<std::size_t>(count));
  ForEach(parallel, count,
    [&](Index t)
    {
      const auto v = mesh.TriangleVertices().row(t);
      const TriangleMesh::Shape s = mesh.Shapes()[t];
      const double l0 = s.EdgeLength(0);
      const double l1 = s.EdgeLength(1);
      this->Triangles[t] = { { v[0], v[1], v[2] }, { l0, l1, s.Length }, {} };
      if (this->TwoSheets)
      {
        // The back is the triangle seen from behind: corners 1 and 2 exchanged.
        this->Triangles[count + t] = { { v[0], v[2], v[1] }, { l0, s.Length, l1 }, {} };
      }
    });
}

void IntrinsicTriangulation::JoinSheets(
  const EdgeList& edges, Index triangleCount, const ParallelFor& parallel)
{
  const Buffer<EdgeUse>& uses = edges.Uses;
  // The side of the front or of the back that runs in the given direction.
  const auto sideOf = [&](const EdgeUse& use, bool ascending)
  { return use.Ascending == ascending ? use.Side : BackOf(use.Side, triangleCount); };
  const auto joinEdge = [&](Index begin, Index end)
  {
    if (!this->TwoSheets)
    {
      this->Join(uses[begin].Side, uses[begin + 1].Side);
      return;
    }
    // Around the edge, the ascending side of each triangle meets the descending side of the next
    // one: any cyclic order gives nonnegative weights.
    for (Index k = begin; k < end; ++k)
    {
      const EdgeUse& next = uses[k + 1 < end ? k + 1 : begin];
      this->Join(sideOf(uses[k], true), sideOf(next, false));
    }
  };
  ForEach(parallel, static_cast<Index>(edges.Begin.size()) - 1,
    [&](Index low)
    {
      for (Index begin = edges.Begin[low], end = begin; begin < edges.Begin[low + 1]; begin = end)
      {
        while (end < edges.Begin[low + 1] && uses[begin].SameEdge(uses[end]))
        {
          ++end;
        }
        joinEdge(begin, end);
      }
    });
}

/// A side of its own twin is not flipped.
void IntrinsicTriangulation::PartSheetsAtBoundaries(Index triangleCount)
{
  for (Index side = 0; side < 3 * triangleCount; ++side)
  {
    const Index back = BackOf(side, triangleCount);
    if (this->Twin(side) == back)
    {
      this->Join(side, side);
      this->Join(back, back);
    }
  }
}

void IntrinsicTriangulation::Join(Index side, Index other)
{
  this->Triangles[side / 3].Twins[side % 3] = other;
  this->Triangles[other / 3].Twins[other % 3] = side;
}

/// Lengthen edges so that the triangle inequalities hold by a margin, relative to the size of each
/// triangle. Only the two shorter sides of a triangle that is too flat are lengthened, and as this
/// can make a neighbour too flat, its sides in turn. No edge grows by more than the largest margin:
/// if all grew by that, all inequalities would hold.
void IntrinsicTriangulation::Mollify(const ParallelFor& parallel)
{
  const auto isFlat = [this](Index t)
  {
    return this->LackOfSlack(t, 0) > 0.0 || this->LackOfSlack(t, 1) > 0.0 ||
      this->LackOfSlack(t, 2) > 0.0;
  };
  if (Max(parallel, static_cast<Index>(this->Triangles.size()),
        [&](Index t) { return isFlat(t) ? 1.0 : 0.0; }) == 0.0)
  {
    return;
  }
  std::vector<Index> queue(this->Triangles.size());
  std::iota(queue.begin(), queue.end(), 0);
  std::vector<char> queued(queue.size(), 1);
  std::vector<double> added(3 * queue.size(), 0.0);
  const auto raise = [&](Index side, double to)
  {
    if (to <= added[side])
    {
      return;
    }
    for (const Index same : { side, this->Twin(side) })
    {
      this->Triangles[same / 3].Lengths[same % 3] += to - added[same];
      added[same] = to;
      if (!queued[same / 3])
      {
        queued[same / 3] = 1;
        queue.push_back(same / 3);
      }
    }
  };
  while (!queue.empty())
  {
    const Index t = queue.back();
    queue.pop_back();
    queued[t] = 0;
    for (int a = 0; a < 3; ++a)
    {
      const double lack = this->LackOfSlack(t, a);
      if (lack > 0.0)
      {
        // Both up to one level, or the lower one alone.
        const Index next = 3 * t + Next(a);
        const Index last = 3 * t + Last(a);
        const double sum = added[next] + added[last] + lack;
        const double higher = std::max(added[next], added[last]);
        const double level = 0.5 * sum >= higher ? 0.5 * sum : sum - higher;
        raise(next, level);
        raise(last, level);
      }
    }
  }
}

/// The length that the other two sides lack to be longer than side a by the margin; 0 if they are
/// by half of it, which is enough.
double IntrinsicTriangulation::LackOfSlack(Index t, int a) const
{
  constexpr double relativeMargin = 1e-6; // of the longest side
  const std::array<double, 3>& l = this->Triangles[t].Lengths;
  const double margin = relativeMargin * std::max({ l[0], l[1], l[2] });
  const double slack = (l[Next(a)] - l[a]) + l[Last(a)];
  return slack < 0.5 * margin ? margin - slack : 0.0;
}

double IntrinsicTriangulation::Cotangent(Index side) const
{
  const Triangle& t = this->Triangles[side / 3];
  const int a = side % 3;
  const double l = t.Lengths[a];
  const Vec2 apex = Apex(t.Lengths[Next(a)], t.Lengths[Last(a)], l);
  return apex[1] / l - (apex[0] / apex[1]) * ((l - apex[0]) / l);
}

bool IntrinsicTriangulation::IsDelaunay(Index side) const
{
  const Index twin = this->Twin(side);
  if (twin / 3 == side / 3)
  {
    return true; // a cone around one vertex, or a boundary: nothing to flip
  }
  const double here = this->Cotangent(side);
  const double there = this->Cotangent(twin);
  // An edge of a triangle too flat to measure, whose cotangent is not a number, stays as it is.
  constexpr double roundOff = 1e-10;
  return !(here + there < -roundOff * (1.0 + std::abs(here) + std::abs(there)));
}

bool IntrinsicTriangulation::Flip(Index side, EdgeFlip& flip)
{
  const Index twin = this->Twin(side);
  Triangle& first = this->Triangles[side / 3];
  Triangle& second = this->Triangles[twin / 3];
  const std::array<double, 3> f = first.Lengths;
  const std::array<double, 3> g = second.Lengths;
  const int a = side % 3;
  const int b = twin % 3;
  const double pq = f[a];
  // P at the origin, Q at (pq, 0), A above and B below.
  const Vec2 above = Apex(f[Next(a)], f[Last(a)], pq);
  Vec2 below = Apex(g[Last(b)], g[Next(b)], pq);
  below[1] = -below[1];
  const double ab = (above - below).norm();
  const std::array<double, 3> left{ g[Next(b)], ab, f[Last(a)] };
  const std::array<double, 3> right{ f[Next(a)], ab, g[Last(b)] };
  if (!IsProper(left) || !IsProper(right))
  {
    return false;
  }
  const Vec2 fromBToQ = Vec2(pq, 0.0) - below;
  const double leftArea = Area(left);
  flip = { side, twin, AngleOfSide(f, a), AngleOfSide(g, b), std::atan2(-above[1], -above[0]),
    std::atan2(fromBToQ[1], fromBToQ[0]), leftArea / (leftArea + Area(right)) };
  this->Relink(side, twin);
  first.Lengths = left;
  second.Lengths = right;
  return true;
}

/// The vertices and neighbours of a flip.
void IntrinsicTriangulation::Relink(Index side, Index twin)
{
  const Index first = side / 3;
  const Index second = twin / 3;
  const int a = side % 3;
  const int b = twin % 3;
  const Triangle f = this->Triangles[first];
  const Triangle g = this->Triangles[second];
  // The outer sides A P, Q A of the first triangle and B Q, P B of the second: old and new place.
  const std::array<std::pair<Index, Index>, 4> outer{ { { 3 * first + Last(a), 3 * first + 2 },
    { 3 * first + Next(a), 3 * second + 0 }, { 3 * second + Last(b), 3 * second + 2 },
    { 3 * second + Next(b), 3 * first + 0 } } };
  const auto moved = [&](Index old)
  {
    const auto place = std::find_if(
      outer.begin(), outer.end(), [&](const auto& candidate) { return candidate.first == old; });
    return place == outer.end() ? old : place->second;
  };
  const std::array<Index, 4> twins{ moved(f.Twins[Last(a)]), moved(f.Twins[Next(a)]),
    moved(g.Twins[Last(b)]), moved(g.Twins[Next(b)]) };

  const Index A = f.Vertices[a];
  const Index P = f.Vertices[Next(a)];
  const Index Q = f.Vertices[Last(a)];
  const Index B = g.Vertices[b];
  this->Triangles[first].Vertices = { A, P, B };
  this->Triangles[second].Vertices = { B, Q, A };
  this->Join(3 * first + 1, 3 * second + 1);
  for (int k = 0; k < 4; ++k)
  {
    this->Join(outer[k].second, twins[k]);
  }
}

std::shared_ptr<TriangleMesh> IntrinsicTriangulation::MakeMesh(
  const TriangleMesh& mesh, const ParallelFor& parallel) const
{
  TriangleMesh::Contents contents;
  const auto count = static_cast<Index>(this->Triangles.size());
  contents.TriangleVertices.resize(count, 3);
  contents.TriangleEdges.resize(count, 3);
  contents.Shapes = TriangleMesh::ShapeList(count, this->TwoSheets ? 0.5 : 1.0);
  ForEach(parallel, count,
    [&](Index t)
    {
      const Triangle& triangle = this->Triangles[t];
      const Vec2 apex = Apex(triangle.Lengths);
      contents.Shapes.Set(t, triangle.Lengths[2], apex[0], apex[1]);
      contents.TriangleVertices.row(t) << triangle.Vertices[0], triangle.Vertices[1],
        triangle.Vertices[2];
      for (int a = 0; a < 3; ++a)
      {
        contents.TriangleEdges(t, a) = std::min(3 * t + a, triangle.Twins[a]);
      }
    });
  contents.InputVertex = mesh.InputVertex();
  contents.ComponentsBegin = mesh.ComponentsBegin();
  contents.BoundaryVertices = mesh.BoundaryVertices();
  contents.ControlAreas = mesh.ControlAreas();
  contents.LengthUnit = mesh.LengthUnit();
  contents.TotalEdgeLength = mesh.TotalEdgeLength();
  contents.NumberOfEdges = mesh.NumberOfEdges();
  contents.Diagnostics = mesh.Diagnostics();
  return std::make_shared<TriangleMesh>(std::move(contents), parallel);
}

} // namespace SurfaceDiffusion
