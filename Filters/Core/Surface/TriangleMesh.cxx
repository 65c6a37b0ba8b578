// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/TriangleMesh.h"

#include "Core/Foundation/Grouping.h"
#include "Core/Foundation/IndexSet.h"
#include "Core/Surface/EdgeLengths.h"
#include "Core/Surface/MeshNumbering.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// Sums over the edges whose smaller vertex is in a block of vertices.
struct EdgeSums
{
  /// Sum of (1 - uses/2) length, which corrects half of all perimeters at edges that do not have
  /// two triangles.
  double LengthCorrection = 0.0;
  Index EdgeEnds = 0; ///< counted at both vertices of an edge
  Index BoundaryEdges = 0;
  Index NonManifoldEdges = 0;
  std::vector<Index> BoundaryVertices;
};

/// Lists the edges at a vertex, one vertex after the other.
class EdgesAtVertex
{
public:
  explicit EdgesAtVertex(const TriangleMesh& mesh)
    : Mesh(mesh)
  {
  }

  void AddTo(EdgeSums& sums, Index vertex)
  {
    this->Find(vertex);
    sums.EdgeEnds += this->Neighbours.Size();
    for (Index k = 0; k < this->Neighbours.Size(); ++k)
    {
      const Edge& edge = this->Edges[k];
      if (edge.Uses == 2 || this->Neighbours[k] < vertex)
      {
        continue;
      }
      const int a = edge.Corner % 3;
      const int opposite = 3 - a - (a + edge.Step) % 3;
      sums.LengthCorrection +=
        (1.0 - 0.5 * edge.Uses) * this->Mesh.Shapes()[edge.Corner / 3].EdgeLength(opposite);
      if (edge.Uses == 1)
      {
        ++sums.BoundaryEdges;
        sums.BoundaryVertices.push_back(vertex);
        sums.BoundaryVertices.push_back(this->Neighbours[k]);
      }
      sums.NonManifoldEdges += edge.Uses > 2;
    }
  }

private:
  struct Edge
  {
    Index Uses; ///< its triangles
    Index Corner; ///< at this vertex, of the last of them
    int Step; ///< from there to the edge's other end
  };

  void Find(Index vertex)
  {
    const Index begin = this->Mesh.VertexCornersBegin()[vertex];
    const Index end = this->Mesh.VertexCornersBegin()[vertex + 1];
    this->Neighbours.Clear();
    this->Edges.assign(2 * static_cast<std::size_t>(end - begin), { 0, 0, 0 });
    for (const int step : { 1, 2 }) // most of the first are new, most of the second known
    {
      for (Index c = begin; c < end; ++c)
      {
        const Index corner = this->Mesh.VertexCorners()[c];
        Edge& edge = this->Edges[this->Neighbours.Insert(this->Mesh.OtherCorner(corner, step))];
        ++edge.Uses;
        edge.Corner = corner;
        edge.Step = step;
      }
    }
  }

  const TriangleMesh& Mesh;
  IndexSet Neighbours;
  std::vector<Edge> Edges; ///< to them
};

} // namespace

TriangleMesh::TriangleMesh(const Eigen::Ref<const Points>& points,
  const Eigen::Ref<const Triangles>& triangles, const ParallelFor& parallel,
  const ProgressMonitor& progress, double lengthUnit)
{
  this->Given = NumberMesh(points, triangles, lengthUnit, parallel, progress.Part(0.0, 0.6));
  this->ListCorners(parallel);
  progress.Report(0.8);
  this->SumAreas(parallel);
  this->MeasureEdges(parallel);
  progress.Report(1.0);
}

TriangleMesh::TriangleMesh(Contents contents, const ParallelFor& parallel)
  : Given(std::move(contents))
{
  this->ListCorners(parallel);
  this->SumAreas(parallel);
}

void TriangleMesh::ListCorners(const ParallelFor& parallel)
{
  const Index* const corners = this->Given.TriangleVertices.data();
  Groups groups = GroupByKey(3 * this->NumberOfTriangles(), this->NumberOfVertices(), parallel,
    [corners](Index c) { return corners[c]; });
  this->CornersBegin = std::move(groups.Begin);
  this->CornerList = std::move(groups.Items);
}

double TriangleMesh::ThirdOfTriangles(Index i) const
{
  double area = 0.0;
  for (Index c = this->CornersBegin[i]; c < this->CornersBegin[i + 1]; ++c)
  {
    area += this->Given.Shapes[this->CornerList[c] / 3].Area() / 3.0;
  }
  return area;
}

void TriangleMesh::SumAreas(const ParallelFor& parallel)
{
  if (this->Given.ControlAreas.size() > 0)
  {
    return;
  }
  this->Given.ControlAreas.resize(this->NumberOfVertices());
  ForEach(parallel, this->NumberOfVertices(),
    [&](Index i) { this->Given.ControlAreas[i] = this->ThirdOfTriangles(i); });
}

void TriangleMesh::ScaleControlAreas(const std::vector<double>& factors)
{
  for (Index i = 0; i < this->NumberOfVertices(); ++i)
  {
    this->Given.ControlAreas[i] *= factors[static_cast<std::size_t>(this->InputVertex()[i])];
  }
}

void TriangleMesh::MeasureEdges(const ParallelFor& parallel)
{
  Contents& mesh = this->Given;
  const auto halfPerimeter = [&](Index t)
  {
    const Shape shape = mesh.Shapes[t];
    return 0.5 * (shape.Length + shape.EdgeLength(0) + shape.EdgeLength(1));
  };
  mesh.TotalEdgeLength = Sum(parallel, this->NumberOfTriangles(), halfPerimeter);
  std::vector<EdgeSums> blocks(NumberOfBlocks(this->NumberOfVertices()));
  ForEachBlock(parallel, this->NumberOfVertices(),
    [&](Index block, Index begin, Index end)
    {
      EdgesAtVertex edges(*this);
      for (Index i = begin; i < end; ++i)
      {
        edges.AddTo(blocks[block], i);
      }
    });
  Index ends = 0;
  std::vector<Index>& boundary = mesh.BoundaryVertices;
  for (const EdgeSums& sums : blocks)
  {
    mesh.TotalEdgeLength += sums.LengthCorrection;
    ends += sums.EdgeEnds;
    mesh.Diagnostics.BoundaryEdges += sums.BoundaryEdges;
    mesh.Diagnostics.NonManifoldEdges += sums.NonManifoldEdges;
    boundary.insert(boundary.end(), sums.BoundaryVertices.begin(), sums.BoundaryVertices.end());
  }
  mesh.NumberOfEdges = ends / 2;
  if (CountLongEdges(*this, parallel) > 0.0)
  {
    const EdgeLengths counted = MeasureEdgeLengths(*this, Reduction::Serial());
    mesh.TotalEdgeLength = counted.Sum;
    mesh.NumberOfEdges = static_cast<Index>(counted.Number);
  }
  std::sort(boundary.begin(), boundary.end());
  boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
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
