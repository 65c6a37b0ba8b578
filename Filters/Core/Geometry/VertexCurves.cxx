// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Geometry/VertexCurves.h"

#include "Core/Foundation/IndexLists.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace SurfaceDiffusion
{

/// The vertices around a vertex, each once.
void ListNeighbours(const TriangleMesh& mesh, Index i, std::vector<Index>& neighbours)
{
  constexpr Index few = 64; // triangles
  const bool isSmall = mesh.VertexCornersBegin()[i + 1] - mesh.VertexCornersBegin()[i] <= few;
  neighbours.clear();
  for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
  {
    for (const int step : { 1, 2 })
    {
      const Index j = mesh.OtherCorner(mesh.VertexCorners()[c], step);
      if (j != i &&
        !(isSmall && std::find(neighbours.begin(), neighbours.end(), j) != neighbours.end()))
      {
        neighbours.push_back(j);
      }
    }
  }
  if (!isSmall)
  {
    SortUnique(neighbours, 0);
  }
}

namespace
{

/// Thins a set of vertices to curves.
class Thinning
{
public:
  Thinning(const TriangleMesh& mesh, const Vector& values, double threshold, double core)
    : Mesh(mesh)
    , Set(static_cast<std::size_t>(values.size()), 0)
  {
    for (Index i = 0; i < static_cast<Index>(values.size()); ++i)
    {
      if (values[i] >= threshold)
      {
        this->Set[i] = 1;
        this->Order.push_back(i);
      }
    }
    this->OpenWholeComponents(values);
    std::stable_sort(this->Order.begin(), this->Order.end(),
      [&](Index a, Index b) { return values[a] < values[b]; });
    const auto kept = std::partition_point(
      this->Order.begin(), this->Order.end(), [&](Index i) { return values[i] < core; });
    this->Remove(static_cast<std::size_t>(kept - this->Order.begin()), false);
    this->Remove(this->Order.size(), true);
  }

  /// The vertices that are left, ascending.
  std::vector<Index> Rest() const
  {
    std::vector<Index> rest;
    std::copy_if(this->Order.begin(), this->Order.end(), std::back_inserter(rest),
      [&](Index i) { return this->Has(i); });
    std::sort(rest.begin(), rest.end());
    return rest;
  }

private:
  bool Has(Index i) const { return this->Set[i] != 0; }

  /// Thinning cannot begin on a closed surface that is in the set as a whole: its smallest value is
  /// removed first.
  void OpenWholeComponents(const Vector& values)
  {
    const std::vector<Index>& begin = this->Mesh.ComponentsBegin();
    for (std::size_t c = 0; c + 1 < begin.size(); ++c)
    {
      const auto first = this->Set.begin() + begin[c];
      const auto last = this->Set.begin() + begin[c + 1];
      if (std::find(first, last, 0) == last)
      {
        Eigen::Index smallest = 0;
        values.segment(begin[c], begin[c + 1] - begin[c]).minCoeff(&smallest);
        this->Set[begin[c] + smallest] = 0;
      }
    }
  }

  /// Remove vertices among the first `count`, until no more can be.
  void Remove(std::size_t count, bool keepEnds)
  {
    for (bool changed = true; changed;)
    {
      changed = false;
      for (std::size_t k = 0; k < count; ++k)
      {
        const Index i = this->Order[k];
        if (this->Has(i) && this->IsSimple(i, keepEnds))
        {
          this->Set[i] = 0;
          changed = true;
        }
      }
    }
  }

  /// Whether the rest has the same topology without vertex i: the part of the set in the link of i
  /// is one path, whose Euler characteristic is 1.
  bool IsSimple(Index i, bool keepEnds)
  {
    ListNeighbours(this->Mesh, i, this->Link);
    const auto vertices = static_cast<int>(
      std::count_if(this->Link.begin(), this->Link.end(), [&](Index j) { return this->Has(j); }));
    int edges = 0;
    const auto& begin = this->Mesh.VertexCornersBegin();
    for (Index c = begin[i]; c < begin[i + 1]; ++c)
    {
      const Index corner = this->Mesh.VertexCorners()[c];
      edges += this->Has(this->Mesh.OtherCorner(corner, 1)) &&
        this->Has(this->Mesh.OtherCorner(corner, 2));
    }
    return vertices - edges == 1 && !(keepEnds && vertices == 1);
  }

  const TriangleMesh& Mesh;
  std::vector<char> Set;
  std::vector<Index> Order; ///< the set, by value
  std::vector<Index> Link;
};

double LengthOf(const Points& points, const std::vector<Index>& path)
{
  double length = 0.0;
  for (std::size_t k = 1; k < path.size(); ++k)
  {
    length += (points.row(path[k]) - points.row(path[k - 1])).norm();
  }
  return length;
}

/// One of the two directions in which a path is found.
bool IsForwards(const std::vector<Index>& path)
{
  const std::size_t last = path.size() - 1;
  return std::make_pair(path[0], path[1]) <= std::make_pair(path[last], path[last - 1]);
}

} // namespace

VertexCurves::VertexCurves(
  const TriangleMesh& mesh, const Vector& values, double threshold, double core)
  : Members(Thinning(mesh, values, threshold, core).Rest())
  , Neighbours(this->Members.size())
{
  this->Connect(mesh, values);
}

/// Vertices are connected by the edges of the mesh. Triangles that are left at junctions lose their
/// weakest edge.
void VertexCurves::Connect(const TriangleMesh& mesh, const Vector& values)
{
  using Edge = std::pair<Index, Index>;
  std::vector<Index> member(static_cast<std::size_t>(mesh.NumberOfVertices()), -1);
  for (std::size_t m = 0; m < this->Members.size(); ++m)
  {
    member[this->Members[m]] = static_cast<Index>(m);
  }
  const auto strength = [&](const Edge& edge)
  { return values[this->Members[edge.first]] + values[this->Members[edge.second]]; };
  std::vector<Edge> edges;
  std::vector<Edge> weak;
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    std::vector<Edge> ofTriangle;
    for (int a = 0; a < 3; ++a)
    {
      const Index i = member[mesh.TriangleVertices()(t, a)];
      const Index j = member[mesh.TriangleVertices()(t, (a + 1) % 3)];
      if (i != j && i >= 0 && j >= 0)
      {
        ofTriangle.push_back(std::minmax(i, j));
      }
    }
    edges.insert(edges.end(), ofTriangle.begin(), ofTriangle.end());
    if (ofTriangle.size() == 3)
    {
      weak.push_back(*std::min_element(ofTriangle.begin(), ofTriangle.end(),
        [&](const Edge& a, const Edge& b) { return strength(a) < strength(b); }));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::sort(weak.begin(), weak.end());
  for (const Edge& edge : edges)
  {
    if (!std::binary_search(weak.begin(), weak.end(), edge))
    {
      this->Neighbours[edge.first].push_back(edge.second);
      this->Neighbours[edge.second].push_back(edge.first);
    }
  }
}

/// The path from i over its neighbour j to the next end or junction, or back to i.
std::vector<Index> VertexCurves::Follow(Index i, Index j) const
{
  std::vector<Index> path = { i, j };
  while (path.back() != i && this->Degree(path.back()) == 2)
  {
    const auto& next = this->Neighbours[path.back()];
    path.push_back(next[0] == path[path.size() - 2] ? next[1] : next[0]);
  }
  return path;
}

std::vector<std::vector<Index>> VertexCurves::FindPaths() const
{
  const auto count = static_cast<Index>(this->Members.size());
  std::vector<std::vector<Index>> paths;
  std::vector<char> used(this->Members.size(), 0);
  const auto add = [&](std::vector<Index> path)
  {
    for (const Index i : path)
    {
      used[i] = 1;
    }
    paths.push_back(std::move(path));
  };
  for (Index i = 0; i < count; ++i)
  {
    for (std::size_t n = 0; this->Degree(i) != 2 && n < this->Neighbours[i].size(); ++n)
    {
      std::vector<Index> path = this->Follow(i, this->Neighbours[i][n]);
      if (IsForwards(path))
      {
        add(std::move(path));
      }
    }
  }
  for (Index i = 0; i < count; ++i)
  {
    if (this->Degree(i) == 2 && !used[i])
    {
      add(this->Follow(i, this->Neighbours[i][0]));
    }
  }
  return paths;
}

void VertexCurves::RemoveShort(const Points& points, double shortest)
{
  for (bool changed = true; changed;)
  {
    changed = false;
    std::vector<std::pair<double, std::vector<Index>>> found;
    for (std::vector<Index>& path : this->FindPaths())
    {
      const double length = LengthOf(points, path);
      if (length < shortest)
      {
        found.emplace_back(length, std::move(path));
      }
    }
    std::sort(found.begin(), found.end());
    for (const auto& line : found)
    {
      // A junction that others have been removed from may be one no longer.
      const Index first = this->Degree(line.second.front());
      const Index last = this->Degree(line.second.back());
      if (std::min(first, last) == 1 && first != 2 && last != 2)
      {
        this->Cut(line.second);
        changed = true;
      }
    }
  }
}

/// Remove the edges of a path.
void VertexCurves::Cut(const std::vector<Index>& path)
{
  for (std::size_t k = 1; k < path.size(); ++k)
  {
    this->Disconnect(path[k - 1], path[k]);
    this->Disconnect(path[k], path[k - 1]);
  }
}

void VertexCurves::Disconnect(Index i, Index j)
{
  auto& list = this->Neighbours[i];
  list.erase(std::remove(list.begin(), list.end(), j), list.end());
}

} // namespace SurfaceDiffusion
