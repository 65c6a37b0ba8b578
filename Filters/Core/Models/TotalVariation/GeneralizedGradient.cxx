// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/GeneralizedGradient.h"

#include <algorithm>

namespace SurfaceDiffusion
{

GeneralizedGradient::GeneralizedGradient(
  std::shared_ptr<const TriangleMesh> mesh, const ParallelFor& parallel)
  : Mesh(std::move(mesh))
  , Maps(static_cast<std::size_t>(this->Mesh->NumberOfTriangles()))
  , Sides(this->Maps.size(), { -1, -1, -1 })
{
  ForEach(parallel, this->NumberOfTriangles(),
    [&](Index t)
    { this->Maps[static_cast<std::size_t>(t)] = PlainGradientMap(this->Mesh->Shapes()[t]); });
  this->ListEdges();
}

void GeneralizedGradient::ListEdges()
{
  const TriangleMesh& mesh = *this->Mesh;
  const bool numbered = mesh.TriangleEdges().rows() > 0;
  std::vector<std::array<Index, 3>> sides; // two numbers of the edge, and the side 3 t + a
  sides.reserve(3 * this->Maps.size());
  for (Index side = 0; side < 3 * this->NumberOfTriangles(); ++side)
  {
    const Index begin = mesh.OtherCorner(side, 1);
    const Index end = mesh.OtherCorner(side, 2);
    sides.push_back(numbered
        ? std::array<Index, 3>{ mesh.TriangleEdges().data()[side], 0, side }
        : std::array<Index, 3>{ std::min(begin, end), std::max(begin, end), side });
  }
  std::sort(sides.begin(), sides.end());
  const auto isSameEdge = [&](std::size_t i, std::size_t j)
  { return sides[i][0] == sides[j][0] && sides[i][1] == sides[j][1]; };
  for (std::size_t first = 0, end = 0; first < sides.size(); first = end)
  {
    while (end < sides.size() && isSameEdge(first, end))
    {
      ++end;
    }
    if (end - first == 2)
    {
      this->AddEdge(sides[first][2], sides[first + 1][2]);
    }
  }
}

/// The edge that two sides 3 t + a of triangles share.
void GeneralizedGradient::AddEdge(Index side, Index other)
{
  const auto begin = [&](Index of) { return this->Mesh->OtherCorner(of, 1); };
  const auto end = [&](Index of) { return this->Mesh->OtherCorner(of, 2); };
  // Along the edge in the direction of the left side, and away from its triangle. An edge from a
  // vertex to itself is one of an intrinsic triangulation, whose triangles turn all the same way.
  const bool isReversed =
    begin(side) == end(side) || (begin(side) < end(side)) != (begin(other) < end(other));
  Eigen::Matrix2d left = this->AxesOfSide(side);
  Eigen::Matrix2d right = this->AxesOfSide(other);
  left.col(1) *= -1.0;
  right.col(0) *= isReversed ? -1.0 : 1.0;
  const TriangleMesh::Shape shape = this->Mesh->Shapes()[static_cast<std::size_t>(side / 3)];
  const auto number = static_cast<Index>(this->Edges.size());
  this->Edges.push_back(
    { side / 3, other / 3, shape.EdgeLength(side % 3) * shape.Weight, left * right.transpose() });
  this->Sides[static_cast<std::size_t>(side / 3)][side % 3] = 2 * number;
  this->Sides[static_cast<std::size_t>(other / 3)][other % 3] = 2 * number + 1;
}

/// The unit vectors along a side of a triangle, and from it to the inside.
Eigen::Matrix2d GeneralizedGradient::AxesOfSide(Index side) const
{
  const TriangleMesh::Shape shape = this->Mesh->Shapes()[static_cast<std::size_t>(side / 3)];
  const Eigen::Vector2d corners[3] = { { 0.0, 0.0 }, { shape.Length, 0.0 }, { shape.X, shape.Y } };
  const Eigen::Vector2d along =
    (corners[(side % 3 + 2) % 3] - corners[(side % 3 + 1) % 3]).normalized();
  Eigen::Matrix2d axes;
  axes << along[0], -along[1], along[1], along[0];
  return axes;
}

/// use(row of x, its two coefficients) for the entries of a group.
template <typename Use>
void GeneralizedGradient::ForEachEntry(Index g, const Use& use) const
{
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  const auto useVector = [&](Index t, const Eigen::Matrix2d& coefficients)
  {
    use(this->NumberOfVertices() + 2 * t, coefficients.col(0));
    use(this->NumberOfVertices() + 2 * t + 1, coefficients.col(1));
  };
  if (g < this->NumberOfTriangles())
  {
    for (int a = 0; a < 3; ++a)
    {
      use(
        this->Mesh->TriangleVertices()(g, a), this->Maps[static_cast<std::size_t>(g)].OfCorner(a));
    }
    useVector(g, -one);
    return;
  }
  const Edge& edge = this->GetEdge(g - this->NumberOfTriangles());
  useVector(edge.Left, one);
  useVector(edge.Right, -edge.P);
}

/// use(g) for the groups of a row of x, each once, though a triangle of an intrinsic triangulation
/// may have a vertex or an edge twice.
template <typename Use>
void GeneralizedGradient::ForEachGroup(Index row, const Use& use) const
{
  const Index n = this->NumberOfVertices();
  if (row >= n)
  {
    const Index t = (row - n) / 2;
    use(t);
    const std::array<Index, 3>& sides = this->Sides[static_cast<std::size_t>(t)];
    for (int a = 0; a < 3; ++a)
    {
      const bool isNew = std::none_of(sides.begin(), sides.begin() + a,
        [&](Index side) { return side / 2 == sides[a] / 2 && side >= 0; });
      if (sides[a] >= 0 && isNew)
      {
        use(this->NumberOfTriangles() + sides[a] / 2);
      }
    }
    return;
  }
  Index last = -1;
  for (Index c = this->Mesh->VertexCornersBegin()[row];
       c < this->Mesh->VertexCornersBegin()[row + 1]; ++c)
  {
    const Index t = this->Mesh->VertexCorners()[c] / 3;
    if (t != last)
    {
      use(t);
    }
    last = t;
  }
}

/// The entries of a row of the matrix, sorted.
void GeneralizedGradient::MakeRow(Index row, const Vector& weights, Entries& entries) const
{
  entries.clear();
  this->ForEachGroup(row,
    [&](Index g)
    {
      Eigen::Vector2d own = Eigen::Vector2d::Zero();
      this->ForEachEntry(g,
        [&](Index column, const Eigen::Vector2d& coefficients)
        {
          if (column == row)
          {
            own += coefficients;
          }
        });
      this->ForEachEntry(g,
        [&](Index column, const Eigen::Vector2d& coefficients)
        { entries.emplace_back(column, weights[g] * own.dot(coefficients)); });
    });
  std::sort(entries.begin(), entries.end());
  auto last = entries.begin();
  for (auto entry = entries.begin(); entry != entries.end(); ++entry)
  {
    if (entry == entries.begin())
    {
      continue;
    }
    if (entry->first == last->first)
    {
      last->second += entry->second;
    }
    else
    {
      *++last = *entry;
    }
  }
  entries.resize(entries.empty() ? 0 : static_cast<std::size_t>(last - entries.begin()) + 1);
}

SparseMatrix GeneralizedGradient::MakeMatrix(
  const Vector& weights, const ParallelFor& parallel) const
{
  const Index rows = this->NumberOfRows();
  SparseMatrix matrix(rows, rows);
  Index* const outer = matrix.outerIndexPtr();
  const auto forEachRow = [&](const auto& act)
  {
    ForEachBlock(parallel, rows,
      [&](Index, Index begin, Index end)
      {
        Entries entries;
        for (Index row = begin; row < end; ++row)
        {
          this->MakeRow(row, weights, entries);
          act(row, entries);
        }
      });
  };
  forEachRow([&](Index row, const Entries& entries)
    { outer[row + 1] = static_cast<Index>(entries.size()); });
  outer[0] = 0;
  for (Index row = 0; row < rows; ++row)
  {
    outer[row + 1] += outer[row];
  }
  matrix.resizeNonZeros(outer[rows]);
  forEachRow(
    [&](Index row, const Entries& entries)
    {
      Index slot = outer[row];
      for (const auto& [column, value] : entries)
      {
        matrix.innerIndexPtr()[slot] = column;
        matrix.valuePtr()[slot] = value;
        ++slot;
      }
    });
  return matrix;
}

} // namespace SurfaceDiffusion
