// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleMesh.h"

#include "HilbertCurve.h"
#include "IndexSet.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

using Row3 = Eigen::RowVector3d;

TriangleMesh::Frame BoundingFrame(
  const Eigen::Ref<const Points>& points, const Eigen::Ref<const Triangles>& triangles)
{
  Row3 low = Row3::Constant(std::numeric_limits<double>::max());
  Row3 high = -low;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      low = low.cwiseMin(points.row(triangles(t, a)));
      high = high.cwiseMax(points.row(triangles(t, a)));
    }
  }
  const double extent = triangles.rows() > 0 ? (0.5 * high - 0.5 * low).maxCoeff() : 0.0;
  // Half the extent cannot overflow; the unit is the next power of two above it, if there is one.
  const double unit = extent > 0.0 ? std::exp2(std::min(std::ilogb(extent) + 1, 1023)) : 1.0;
  return { 0.5 * low + 0.5 * high, unit };
}

/// Lay the triangle out in the plane; a zero Y tells a degenerate one.
TriangleMesh::Shape LayOut(const Row3& p0, const Row3& p1, const Row3& p2)
{
  const Row3 e1 = p1 - p0;
  const Row3 e2 = p2 - p0;
  const double length = e1.norm();
  const double doubleArea = e1.cross(e2).norm();
  const double longest = std::max({ length, e2.norm(), (p2 - p1).norm() });
  constexpr double flat = 4.0 * std::numeric_limits<double>::epsilon();
  if (!(length > 0.0) || !(doubleArea > flat * longest * longest))
  {
    return { length, 0.0, 0.0 };
  }
  return { length, e1.dot(e2) / length, doubleArea / length };
}

class DisjointSets
{
public:
  explicit DisjointSets(Index count)
    : Parent(count)
  {
    std::iota(this->Parent.begin(), this->Parent.end(), 0);
  }
  Index Find(Index i)
  {
    while (this->Parent[i] != i)
    {
      i = this->Parent[i] = this->Parent[this->Parent[i]];
    }
    return i;
  }
  void Join(Index i, Index j) { this->Parent[this->Find(i)] = this->Find(j); }

private:
  std::vector<Index> Parent;
};

/// Turn counts into begins: count[i] becomes the sum of those before it; one entry longer.
void Accumulate(std::vector<Index>& count)
{
  Index sum = 0;
  for (Index& entry : count)
  {
    const Index next = sum + entry;
    entry = sum;
    sum = next;
  }
}

} // namespace

TriangleMesh::TriangleMesh(const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const ParallelFor& parallel, const Monitor& monitor,
  double unit)
{
  Frame frame = BoundingFrame(points, triangles);
  frame.Unit = unit > 0.0 ? unit : frame.Unit;
  this->SelectTriangles(points, triangles, frame, parallel);
  monitor.Report(0.2);
  this->NumberVertices(points, triangles, frame, parallel);
  monitor.Report(0.6);
  this->ListCorners();
  monitor.Report(0.8);
  this->MeasureAreas(parallel);
  this->MeasureEdges(parallel);
  monitor.Report(1.0);
}

TriangleMesh::TriangleMesh(const TriangleMesh& mesh, Triangles corners, std::vector<Shape> shapes,
  const ParallelFor& parallel)
  : InputVertices(mesh.InputVertices)
  , Corners(std::move(corners))
  , TriangleShapes(std::move(shapes))
  , Components(mesh.Components)
  , Boundary(mesh.Boundary)
  , Unit(mesh.Unit)
  , EdgeLength(mesh.EdgeLength)
  , Edges(mesh.Edges)
  , Found(mesh.Found)
{
  this->ListCorners();
  this->MeasureAreas(parallel);
}

void TriangleMesh::SelectTriangles(const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const Frame& frame, const ParallelFor& parallel)
{
  this->Unit = frame.Unit;
  const Index count = static_cast<Index>(triangles.rows());
  std::vector<Shape> shapes(count);
  ForEach(parallel, count,
    [&](Index t)
    {
      const auto corner = [&](int a) -> Row3
      { return (points.row(triangles(t, a)) - frame.Centre) / frame.Unit; };
      shapes[t] = LayOut(corner(0), corner(1), corner(2));
    });
  this->InputTriangles.reserve(count);
  this->TriangleShapes.reserve(count);
  for (Index t = 0; t < count; ++t)
  {
    if (shapes[t].Y > 0.0)
    {
      this->InputTriangles.push_back(t);
      this->TriangleShapes.push_back(shapes[t]);
    }
  }
  this->Found.DegenerateTriangles = count - static_cast<Index>(this->InputTriangles.size());
}

void TriangleMesh::NumberVertices(const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const Frame& frame, const ParallelFor& parallel)
{
  const Index inputCount = static_cast<Index>(points.rows());
  DisjointSets sets(inputCount);
  std::vector<char> used(inputCount, 0);
  for (const Index t : this->InputTriangles)
  {
    for (int a = 0; a < 3; ++a)
    {
      used[triangles(t, a)] = 1;
    }
    sets.Join(triangles(t, 0), triangles(t, 1));
    sets.Join(triangles(t, 1), triangles(t, 2));
  }

  struct Place
  {
    std::uint64_t Position;
    Index Vertex;
    bool operator<(const Place& other) const
    {
      return this->Position != other.Position ? this->Position < other.Position
                                              : this->Vertex < other.Vertex;
    }
  };
  std::vector<Place> places;
  places.reserve(inputCount);
  for (Index i = 0; i < inputCount; ++i)
  {
    if (used[i])
    {
      places.push_back({ 0, i });
    }
  }
  const Index count = static_cast<Index>(places.size());
  this->Found.IsolatedVertices = inputCount - count;
  ForEach(parallel, count,
    [&](Index i)
    {
      std::array<std::uint32_t, 3> cell;
      for (int axis = 0; axis < 3; ++axis)
      {
        const double x = (points(places[i].Vertex, axis) - frame.Centre[axis]) / frame.Unit;
        cell[axis] = static_cast<std::uint32_t>(
          std::min(2097151.0, std::max(0.0, (0.5 * x + 0.5) * 2097152.0)));
      }
      places[i].Position = HilbertPosition(cell);
    });
  std::sort(places.begin(), places.end());

  // Components in the order in which the curve meets them.
  std::vector<Index> component(inputCount, -1);
  this->Components.clear();
  for (const Place& place : places)
  {
    Index& id = component[sets.Find(place.Vertex)];
    if (id < 0)
    {
      id = static_cast<Index>(this->Components.size());
      this->Components.push_back(0);
    }
    ++this->Components[id];
  }
  this->Components.push_back(0);
  Accumulate(this->Components);
  std::vector<Index> next = this->Components;
  std::vector<Index> number(inputCount, -1);
  this->InputVertices.resize(count);
  for (const Place& place : places)
  {
    const Index i = next[component[sets.Find(place.Vertex)]]++;
    number[place.Vertex] = i;
    this->InputVertices[i] = place.Vertex;
  }

  // Triangles follow their smallest vertex.
  const Index triangleCount = static_cast<Index>(this->InputTriangles.size());
  std::vector<Index> begin(count + 1, 0);
  std::vector<Index> smallest(triangleCount);
  for (Index t = 0; t < triangleCount; ++t)
  {
    const auto corners = triangles.row(this->InputTriangles[t]);
    smallest[t] = std::min({ number[corners[0]], number[corners[1]], number[corners[2]] });
    ++begin[smallest[t]];
  }
  Accumulate(begin);
  std::vector<Index> sortedTriangles(triangleCount);
  std::vector<Shape> sortedShapes(triangleCount);
  this->Corners.resize(triangleCount, 3);
  for (Index t = 0; t < triangleCount; ++t)
  {
    const Index place = begin[smallest[t]]++;
    sortedTriangles[place] = this->InputTriangles[t];
    sortedShapes[place] = this->TriangleShapes[t];
    for (int a = 0; a < 3; ++a)
    {
      this->Corners(place, a) = number[triangles(this->InputTriangles[t], a)];
    }
  }
  this->InputTriangles.swap(sortedTriangles);
  this->TriangleShapes.swap(sortedShapes);
}

void TriangleMesh::ListCorners()
{
  this->CornersBegin.assign(this->NumberOfVertices() + 1, 0);
  const Index cornerCount = 3 * this->NumberOfTriangles();
  const Index* corners = this->Corners.data();
  for (Index c = 0; c < cornerCount; ++c)
  {
    ++this->CornersBegin[corners[c]];
  }
  Accumulate(this->CornersBegin);
  std::vector<Index> next = this->CornersBegin;
  this->CornerList.resize(cornerCount);
  for (Index c = 0; c < cornerCount; ++c)
  {
    this->CornerList[next[corners[c]]++] = c;
  }
}

void TriangleMesh::MeasureAreas(const ParallelFor& parallel)
{
  this->Areas.resize(this->NumberOfVertices());
  ForEach(parallel, this->NumberOfVertices(),
    [&](Index i)
    {
      double area = 0.0;
      for (Index c = this->CornersBegin[i]; c < this->CornersBegin[i + 1]; ++c)
      {
        area += this->TriangleShapes[this->CornerList[c] / 3].Area() / 3.0;
      }
      this->Areas[i] = area;
    });
}

void TriangleMesh::MeasureEdges(const ParallelFor& parallel)
{
  struct Block
  {
    double Length = 0.0;
    Index Edges = 0, BoundaryEdges = 0, NonManifold = 0;
    std::vector<Index> BoundaryVertices;
  };
  std::vector<Block> results(NumberOfBlocks(this->NumberOfVertices()));
  ForEachBlock(parallel, this->NumberOfVertices(),
    [&](Index block, Index begin, Index end)
    {
      IndexSet neighbours; // of vertex i, of higher numbers
      std::vector<Index> uses;
      Block& result = results[block];
      for (Index i = begin; i < end; ++i)
      {
        neighbours.Clear();
        uses.clear();
        for (Index c = this->CornersBegin[i]; c < this->CornersBegin[i + 1]; ++c)
        {
          const Index t = this->CornerList[c] / 3;
          const int a = this->CornerList[c] % 3;
          for (const int b : { (a + 1) % 3, (a + 2) % 3 })
          {
            if (this->Corners(t, b) <= i)
            {
              continue;
            }
            const Index edge = neighbours.Insert(this->Corners(t, b));
            if (edge == static_cast<Index>(uses.size()))
            {
              uses.push_back(0);
              result.Length += this->TriangleShapes[t].EdgeLength(3 - a - b);
            }
            ++uses[edge];
          }
        }
        result.Edges += static_cast<Index>(uses.size());
        for (std::size_t edge = 0; edge < uses.size(); ++edge)
        {
          if (uses[edge] == 1)
          {
            ++result.BoundaryEdges;
            result.BoundaryVertices.push_back(i);
            result.BoundaryVertices.push_back(neighbours.Entries()[edge]);
          }
          result.NonManifold += uses[edge] > 2;
        }
      }
    });
  for (const Block& result : results)
  {
    this->EdgeLength += result.Length;
    this->Edges += result.Edges;
    this->Found.BoundaryEdges += result.BoundaryEdges;
    this->Found.NonManifoldEdges += result.NonManifold;
    this->Boundary.insert(
      this->Boundary.end(), result.BoundaryVertices.begin(), result.BoundaryVertices.end());
  }
  std::sort(this->Boundary.begin(), this->Boundary.end());
  this->Boundary.erase(
    std::unique(this->Boundary.begin(), this->Boundary.end()), this->Boundary.end());
}

Values GatherVertices(const TriangleMesh& mesh, const Eigen::Ref<const Values>& input)
{
  Values values(mesh.NumberOfVertices(), input.cols());
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    values.row(i) = input.row(mesh.InputVertex()[i]);
  }
  return values;
}

} // namespace SurfaceDiffusion
