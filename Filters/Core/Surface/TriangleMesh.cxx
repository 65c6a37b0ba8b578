// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/TriangleMesh.h"

#include "Core/Foundation/DisjointSets.h"
#include "Core/Foundation/IndexSet.h"
#include "Core/Surface/HilbertCurve.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

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
  const Eigen::Ref<const Triangles>& triangles, const ParallelFor& parallel,
  const ProgressMonitor& progress, double unit)
{
  Frame frame = BoundingFrame(points, triangles);
  frame.Unit = unit > 0.0 ? unit : frame.Unit;
  this->SelectTriangles(points, triangles, frame, parallel);
  progress.Report(0.2);
  this->NumberVertices(points, triangles, frame, parallel);
  progress.Report(0.6);
  this->ListCorners();
  progress.Report(0.8);
  this->MeasureAreas(parallel);
  this->MeasureEdges(parallel);
  progress.Report(1.0);
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
  const Index triangleCount = static_cast<Index>(this->InputTriangles.size());
  std::vector<Index> number(inputCount, -1);
  for (const Index t : this->InputTriangles)
  {
    for (int a = 0; a < 3; ++a)
    {
      number[triangles(t, a)] = 0; // used
    }
  }
  std::vector<HilbertPlace> places;
  places.reserve(inputCount);
  for (Index i = 0; i < inputCount; ++i)
  {
    if (number[i] == 0)
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
          std::min(HilbertCells - 1.0, std::max(0.0, (0.5 * x + 0.5) * HilbertCells)));
      }
      places[i].Position = HilbertPosition(cell);
    });
  SortAlongCurve(places);
  for (Index i = 0; i < count; ++i)
  {
    number[places[i].Vertex] = i;
  }

  Triangles corners(triangleCount, 3);
  DisjointSets connected(count);
  for (Index t = 0; t < triangleCount; ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      corners(t, a) = number[triangles(this->InputTriangles[t], a)];
    }
    connected.Join(corners(t, 0), corners(t, 1));
    connected.Join(corners(t, 1), corners(t, 2));
  }

  // Components in the order in which the curve meets them, each along the curve.
  const std::vector<Index> component = connected.Labels();
  this->Components.assign(1, 0);
  for (const Index c : component)
  {
    this->Components.resize(std::max<std::size_t>(this->Components.size(), c + 2), 0);
    ++this->Components[c];
  }
  Accumulate(this->Components);
  std::vector<Index> next = this->Components;
  this->InputVertices.resize(count);
  number.resize(count);
  for (Index i = 0; i < count; ++i)
  {
    number[i] = next[component[i]]++;
    this->InputVertices[number[i]] = places[i].Vertex;
  }

  // Triangles follow their smallest vertex.
  std::vector<Index> begin(count + 1, 0);
  for (Index t = 0; t < triangleCount; ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      corners(t, a) = number[corners(t, a)];
    }
    ++begin[corners.row(t).minCoeff()];
  }
  Accumulate(begin);
  std::vector<Index> sortedTriangles(triangleCount);
  std::vector<Shape> sortedShapes(triangleCount);
  this->Corners.resize(triangleCount, 3);
  for (Index t = 0; t < triangleCount; ++t)
  {
    const Index place = begin[corners.row(t).minCoeff()]++;
    sortedTriangles[place] = this->InputTriangles[t];
    sortedShapes[place] = this->TriangleShapes[t];
    this->Corners.row(place) = corners.row(t);
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
  // Half of all perimeters is right where edges have two triangles each; others are added here.
  this->EdgeLength = Sum(parallel, this->NumberOfTriangles(),
    [&](Index t)
    {
      const Shape& shape = this->TriangleShapes[t];
      return 0.5 * (shape.Length + shape.EdgeLength(0) + shape.EdgeLength(1));
    });
  struct Block
  {
    double Length = 0.0;
    Index Ends = 0, BoundaryEdges = 0, NonManifold = 0;
    std::vector<Index> BoundaryVertices;
  };
  std::vector<Block> results(NumberOfBlocks(this->NumberOfVertices()));
  ForEachBlock(parallel, this->NumberOfVertices(),
    [&](Index block, Index begin, Index end)
    {
      struct Edge
      {
        Index Uses, Corner; // the last of its triangles' corners at this vertex
        int Step; // from there to the edge's other end
      };
      IndexSet neighbours;
      std::vector<Edge> edges; // to them
      Block& result = results[block];
      for (Index i = begin; i < end; ++i)
      {
        const Index first = this->CornersBegin[i];
        const Index last = this->CornersBegin[i + 1];
        neighbours.Clear();
        edges.assign(2 * static_cast<std::size_t>(last - first), { 0, 0, 0 });
        for (const int step : { 1, 2 }) // most of the first are new, most of the second known
        {
          for (Index c = first; c < last; ++c)
          {
            const Index corner = this->CornerList[c];
            Edge& edge = edges[neighbours.Insert(this->OtherCorner(corner, step))];
            ++edge.Uses;
            edge.Corner = corner;
            edge.Step = step;
          }
        }
        result.Ends += neighbours.Size();
        for (Index k = 0; k < neighbours.Size(); ++k)
        {
          const Edge& edge = edges[k];
          if (edge.Uses == 2 || neighbours[k] < i)
          {
            continue;
          }
          const int a = edge.Corner % 3;
          const int opposite = 3 - a - (a + edge.Step) % 3;
          result.Length +=
            (1.0 - 0.5 * edge.Uses) * this->TriangleShapes[edge.Corner / 3].EdgeLength(opposite);
          if (edge.Uses == 1)
          {
            ++result.BoundaryEdges;
            result.BoundaryVertices.push_back(i);
            result.BoundaryVertices.push_back(neighbours[k]);
          }
          result.NonManifold += edge.Uses > 2;
        }
      }
    });
  Index ends = 0;
  for (const Block& result : results)
  {
    this->EdgeLength += result.Length;
    ends += result.Ends;
    this->Found.BoundaryEdges += result.BoundaryEdges;
    this->Found.NonManifoldEdges += result.NonManifold;
    this->Boundary.insert(
      this->Boundary.end(), result.BoundaryVertices.begin(), result.BoundaryVertices.end());
  }
  this->Edges = ends / 2;
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
