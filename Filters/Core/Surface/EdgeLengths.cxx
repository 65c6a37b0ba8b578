// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Surface/EdgeLengths.h"

#include "Core/Foundation/RobustRange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr double LongestCounted = 30.0; ///< in median edges

/// The largest length that counts; the median is sought only if the largest of all may not.
double FindBound(
  const Reduction& processes, std::vector<double> lengths, double number, double largest)
{
  const double high = largest / LongestCounted;
  const auto here =
    std::count_if(lengths.begin(), lengths.end(), [high](double length) { return length <= high; });
  return processes.Sum(static_cast<double>(here)) > std::floor(0.5 * number)
    ? LongestCounted * Median(lengths, processes)
    : largest;
}

/// Ends of the interface edges of other processes, ascending.
std::vector<std::pair<Index, Index>> ForeignEdges(const Reduction& reduction)
{
  std::vector<std::pair<Index, Index>> foreign;
  for (std::size_t e = 0; e < reduction.InterfaceEdges().size(); ++e)
  {
    if (!reduction.OwnsInterfaceEdge(static_cast<Index>(e)))
    {
      const std::array<Index, 2>& ends = reduction.InterfaceEdges()[e];
      foreign.emplace_back(std::minmax(ends[0], ends[1]));
    }
  }
  std::sort(foreign.begin(), foreign.end());
  return foreign;
}

} // namespace

EdgeLengths MeasureEdgeLengths(const std::vector<double>& lengths, const Reduction& processes)
{
  const auto here = static_cast<double>(lengths.size());
  const double number = processes.Sum(here);
  double largest = lengths.empty() ? 0.0 : *std::max_element(lengths.begin(), lengths.end());
  processes.Max(&largest, 1);
  const double bound = FindBound(processes, lengths, number, largest);
  double sums[2] = { 0.0, 0.0 };
  for (const double length : lengths)
  {
    if (length <= bound)
    {
      sums[0] += length;
      sums[1] += 1.0;
    }
  }
  processes.Sum(sums, 2);
  return { sums[0], sums[1], number - sums[1] };
}

EdgeLengths MeasureEdgeLengths(const Points& points, const Triangles& triangles)
{
  std::vector<std::pair<Index, Index>> edges;
  edges.reserve(static_cast<std::size_t>(triangles.size()));
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      edges.emplace_back(std::minmax({ triangles(t, a), triangles(t, (a + 1) % 3) }));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<double> lengths;
  for (const auto& [a, b] : edges)
  {
    lengths.push_back((points.row(a) - points.row(b)).norm());
  }
  return MeasureEdgeLengths(lengths);
}

EdgeLengths MeasureEdgeLengths(const TriangleMesh& mesh, const Reduction& processes)
{
  struct Edge
  {
    std::pair<Index, Index> Ends;
    double Length;
  };
  const std::vector<std::pair<Index, Index>> foreign = ForeignEdges(mesh.GetReduction());
  std::vector<Edge> edges;
  edges.reserve(3 * static_cast<std::size_t>(mesh.NumberOfTriangles()));
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const std::pair<Index, Index> ends = std::minmax(
        { mesh.TriangleVertices()(t, (a + 1) % 3), mesh.TriangleVertices()(t, (a + 2) % 3) });
      if (!std::binary_search(foreign.begin(), foreign.end(), ends))
      {
        edges.push_back({ ends, mesh.Shapes()[t].EdgeLength(a) });
      }
    }
  }
  std::sort(
    edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.Ends < b.Ends; });
  std::vector<double> lengths;
  lengths.reserve(edges.size() / 2);
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    if (e == 0 || edges[e].Ends != edges[e - 1].Ends)
    {
      lengths.push_back(edges[e].Length);
    }
  }
  return MeasureEdgeLengths(lengths, processes);
}

double CountLongEdges(const TriangleMesh& mesh, const ParallelFor& parallel)
{
  const Index count = mesh.NumberOfTriangles();
  const auto longest = [&](Index t)
  {
    const TriangleMesh::Shape shape = mesh.Shapes()[t];
    return std::max({ shape.Length, shape.EdgeLength(0), shape.EdgeLength(1) });
  };
  const double bound = Max(parallel, count, longest) / LongestCounted;
  const auto shortSides = [&](Index t)
  {
    const TriangleMesh::Shape shape = mesh.Shapes()[t];
    return static_cast<double>(shape.Length < bound) + (shape.EdgeLength(0) < bound) +
      (shape.EdgeLength(1) < bound);
  };
  // If an edge is left out, then half of all edges are that short, and so are a quarter of the sides
  // of triangles, or an eighth where edges have several triangles.
  return 8.0 * Sum(parallel, count, shortSides) < 3.0 * count
    ? 0.0
    : MeasureEdgeLengths(mesh, Reduction::Serial()).LeftOut;
}

} // namespace SurfaceDiffusion
