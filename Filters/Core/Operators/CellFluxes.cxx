// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CellFluxes.h"

#include "Core/Foundation/Offsets.h"
#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace SurfaceDiffusion
{

namespace
{

/// With more triangles an edge has an unknown of its own.
constexpr std::size_t MostTriangles = 16;

/// The reduction of rows that are cells, each in one process, edges on interfaces, and others.
class CellReduction : public Reduction
{
public:
  CellReduction(const Reduction& ofVertices, Index cells, Index rows)
    : Reduction(Kind::Distributed)
    , OfVertices(ofVertices)
  {
    const auto edges = static_cast<Index>(ofVertices.InterfaceEdges().size());
    this->OwnedVertices.assign(static_cast<std::size_t>(rows), 1);
    for (Index e = 0; e < edges; ++e)
    {
      this->VerticesOnInterface.push_back(cells + e);
      this->OwnedVertices[static_cast<std::size_t>(cells + e)] = ofVertices.OwnsInterfaceEdge(e);
    }
    this->Column.resize(static_cast<std::size_t>(edges));
  }

  using Reduction::Sum;
  void Sum(double* numbers, Index count) const override { this->OfVertices.Sum(numbers, count); }
  void Max(double* numbers, Index count) const override { this->OfVertices.Max(numbers, count); }
  int Rank() const override { return this->OfVertices.Rank(); }
  std::vector<double> Gather(const std::vector<double>& here) const override
  {
    return this->OfVertices.Gather(here);
  }
  void AccumulateInterface(double* rows, Index columns) const override
  {
    this->Exchange(rows, columns, false);
  }
  void UpdateInterface(double* rows, Index columns) const override
  {
    this->Exchange(rows, columns, true);
  }

private:
  void Exchange(double* rows, Index columns, bool ofOwners) const
  {
    const auto edges = static_cast<Index>(this->Column.size());
    for (Index k = 0; k < columns; ++k)
    {
      for (Index e = 0; e < edges; ++e)
      {
        const bool counts = !ofOwners || this->OfVertices.OwnsInterfaceEdge(e);
        this->Column[static_cast<std::size_t>(e)] = counts ? rows[e * columns + k] : 0.0;
      }
      this->OfVertices.AccumulateInterfaceEdges(this->Column.data());
      for (Index e = 0; e < edges; ++e)
      {
        rows[e * columns + k] = this->Column[static_cast<std::size_t>(e)];
      }
    }
  }

  const Reduction& OfVertices;
  mutable std::vector<double> Column; ///< one number per edge
};

/// A triangle at an edge.
struct EdgeTriangle
{
  Index Other; ///< the vertex of the edge with the higher number
  Index Corner; ///< 3 t + a

  bool operator<(const EdgeTriangle& b) const
  {
    return this->Other < b.Other || (this->Other == b.Other && this->Corner < b.Corner);
  }
};

/// The edges between a vertex and those of higher numbers, with their triangles.
void ListEdgesAt(const TriangleMesh& mesh, Index vertex, std::vector<EdgeTriangle>& list)
{
  list.clear();
  for (Index c = mesh.VertexCornersBegin()[vertex]; c < mesh.VertexCornersBegin()[vertex + 1]; ++c)
  {
    const Index corner = mesh.VertexCorners()[c];
    const Index triangle = 3 * (corner / 3);
    for (const int step : { 1, 2 })
    {
      const Index other = mesh.OtherCorner(corner, step);
      if (other > vertex)
      {
        list.push_back({ other, triangle + (corner % 3 + 3 - step) % 3 });
      }
    }
  }
  std::sort(list.begin(), list.end());
}

} // namespace

CellFluxes::CellFluxes(const TriangleMesh& mesh, const Points& points,
  const std::vector<Index>& cells, Index count, const ParallelFor& parallel)
  : Mesh(mesh)
  , Parallel(parallel)
  , CellCount(count)
{
  std::vector<Index> cellOfTriangle(static_cast<std::size_t>(mesh.NumberOfTriangles()));
  Points vertices(mesh.NumberOfVertices(), 3);
  for (Index v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    vertices.row(v) = points.row(mesh.InputVertex()[v]) / mesh.LengthUnit();
  }
  Points centres = Points::Zero(count, 3);
  Vector areas = Vector::Zero(count);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const Index cell = cells[static_cast<std::size_t>(mesh.InputTriangle()[t])];
    const auto corners = mesh.TriangleVertices().row(t);
    const double area = mesh.Shapes()[t].Area();
    centres.row(cell) +=
      area / 3.0 * (vertices.row(corners[0]) + vertices.row(corners[1]) + vertices.row(corners[2]));
    areas[cell] += area;
    cellOfTriangle[static_cast<std::size_t>(t)] = cell;
  }
  for (Index c = 0; c < count; ++c)
  {
    if (areas[c] > 0.0)
    {
      centres.row(c) /= areas[c];
    }
  }
  this->ListSides(centres, vertices, cellOfTriangle);
  this->MakePattern();
  this->OverProcesses = mesh.GetReduction().IsSerial()
    ? Reduction::SharedSerial()
    : std::make_shared<CellReduction>(mesh.GetReduction(), count, this->NumberOfRows());
}

void CellFluxes::ListSides(
  const Points& centres, const Points& points, const std::vector<Index>& cells)
{
  std::map<std::array<Index, 2>, Index> interfaces;
  for (const std::array<Index, 2>& edge : this->Mesh.GetReduction().InterfaceEdges())
  {
    interfaces.emplace(
      std::array<Index, 2>{ std::min(edge[0], edge[1]), std::max(edge[0], edge[1]) },
      static_cast<Index>(interfaces.size()));
  }
  std::vector<std::vector<Side>> withUnknowns(interfaces.size());
  std::vector<Side> inside;
  std::vector<Index> insideBegin;
  std::vector<EdgeTriangle> list;
  for (Index v = 0; v < this->Mesh.NumberOfVertices(); ++v)
  {
    ListEdgesAt(this->Mesh, v, list);
    for (std::size_t begin = 0, end = 0; begin < list.size(); begin = end)
    {
      const Index other = list[begin].Other;
      bool hasNeighbours = false;
      for (end = begin; end < list.size() && list[end].Other == other; ++end)
      {
        hasNeighbours = hasNeighbours ||
          cells[static_cast<std::size_t>(list[end].Corner / 3)] !=
            cells[static_cast<std::size_t>(list[begin].Corner / 3)];
      }
      const auto found = interfaces.empty() ? interfaces.end() : interfaces.find({ v, other });
      const bool isInterface = found != interfaces.end();
      if (!hasNeighbours && !isInterface)
      {
        continue;
      }
      const bool isWide = !isInterface && end - begin > MostTriangles;
      if (isWide)
      {
        withUnknowns.emplace_back();
      }
      else if (!isInterface)
      {
        insideBegin.push_back(static_cast<Index>(inside.size()));
      }
      std::vector<Side>& sides = isInterface ? withUnknowns[static_cast<std::size_t>(found->second)]
                                             : (isWide ? withUnknowns.back() : inside);
      const Eigen::RowVector3d middle = 0.5 * (points.row(v) + points.row(other));
      for (std::size_t k = begin; k < end; ++k)
      {
        const Index t = list[k].Corner / 3;
        const Index cell = cells[static_cast<std::size_t>(t)];
        const TriangleMesh::Shape shape = this->Mesh.Shapes()[t];
        const double length = shape.EdgeLength(list[k].Corner % 3);
        // The centroid of a polygon that is not convex may be on its edge.
        const double distance = std::max((centres.row(cell) - middle).norm(), 1e-6 * length);
        sides.push_back({ cell, 0, list[k].Corner, length / distance,
          2.0 * (shape.Length / length) * (shape.Y / distance) });
      }
    }
  }
  this->UnknownCount = static_cast<Index>(withUnknowns.size());
  for (const std::vector<Side>& sides : withUnknowns)
  {
    this->EdgeBegin.push_back(static_cast<Index>(this->Sides.size()));
    this->Sides.insert(this->Sides.end(), sides.begin(), sides.end());
  }
  for (const Index begin : insideBegin)
  {
    this->EdgeBegin.push_back(static_cast<Index>(this->Sides.size()) + begin);
  }
  this->Sides.insert(this->Sides.end(), inside.begin(), inside.end());
  this->EdgeBegin.push_back(static_cast<Index>(this->Sides.size()));
  this->Conductances.resize(static_cast<Eigen::Index>(this->Sides.size()));
  this->Sums.resize(static_cast<Eigen::Index>(this->EdgeBegin.size()) - 1);
}

void CellFluxes::MakePattern()
{
  this->CellBegin.assign(static_cast<std::size_t>(this->CellCount) + 1, 0);
  for (std::size_t e = 0; e + 1 < this->EdgeBegin.size(); ++e)
  {
    for (Index s = this->EdgeBegin[e]; s < this->EdgeBegin[e + 1]; ++s)
    {
      Side& side = this->Sides[static_cast<std::size_t>(s)];
      side.Edge = static_cast<Index>(e);
      ++this->CellBegin[static_cast<std::size_t>(side.Cell)];
    }
  }
  CountsToOffsets(this->CellBegin);
  this->CellSides.resize(this->Sides.size());
  std::vector<Index> next = this->CellBegin;
  for (std::size_t s = 0; s < this->Sides.size(); ++s)
  {
    Index& place = next[static_cast<std::size_t>(this->Sides[s].Cell)];
    this->CellSides[static_cast<std::size_t>(place++)] = static_cast<Index>(s);
  }
  std::vector<Index> row;
  const auto addRow = [&]
  {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    this->Columns.insert(this->Columns.end(), row.begin(), row.end());
    this->RowBegin.push_back(static_cast<Index>(this->Columns.size()));
  };
  const auto addCellsAt = [&](Index edge)
  {
    for (Index s = this->EdgeBegin[edge]; s < this->EdgeBegin[edge + 1]; ++s)
    {
      row.push_back(this->Sides[static_cast<std::size_t>(s)].Cell);
    }
  };
  this->RowBegin.push_back(0);
  for (Index c = 0; c < this->CellCount; ++c)
  {
    row.assign(1, c);
    for (Index k = this->CellBegin[c]; k < this->CellBegin[c + 1]; ++k)
    {
      const Index edge = this->Sides[static_cast<std::size_t>(this->CellSides[k])].Edge;
      if (this->HasUnknown(edge))
      {
        row.push_back(this->CellCount + edge);
      }
      else
      {
        addCellsAt(edge);
      }
    }
    addRow();
  }
  for (Index e = 0; e < this->UnknownCount; ++e)
  {
    row.assign(1, this->CellCount + e);
    addCellsAt(e);
    addRow();
  }
}

template <typename Conductance>
void CellFluxes::SetConductances(const Conductance& conductance)
{
  ForEach(this->Parallel, static_cast<Index>(this->Sums.size()),
    [&](Index e)
    {
      // An unknown needs an equation.
      const double least = this->HasUnknown(e) ? 1e-12 : 0.0;
      double sum = 0.0;
      for (Index s = this->EdgeBegin[e]; s < this->EdgeBegin[e + 1]; ++s)
      {
        const Side& side = this->Sides[static_cast<std::size_t>(s)];
        const double t = std::max(conductance(side), least * side.Plain);
        this->Conductances[s] = t;
        sum += t;
      }
      this->Sums[e] = sum;
    });
}

void CellFluxes::SetUnitDiffusion()
{
  this->SetConductances([](const Side& side) { return side.Plain; });
}

/// With area grad(phi_a) . D grad(phi_a) = the sum of the weights of the edges at corner a, and
/// grad(phi_a) = n |e| / (2 area): |e| n . D n = 4 area / |e| times that sum.
void CellFluxes::SetWeights(const CornerWeights& weights)
{
  this->SetConductances(
    [&](const Side& side)
    {
      const auto row = weights.row(side.Corner / 3);
      const int a = side.Corner % 3;
      return side.Factor * (row[(a + 1) % 3] + row[(a + 2) % 3]);
    });
}

void CellFluxes::SetDiffusivities(const Vector& ofTriangles)
{
  this->SetConductances(
    [&](const Side& side) { return ofTriangles[side.Corner / 3] * side.Plain; });
}

void CellFluxes::Assemble(const Vector& diagonal, double scale, SparseMatrix& matrix) const
{
  const Index rows = this->NumberOfRows();
  if (matrix.rows() != rows)
  {
    SparseMatrix taken;
    TakePattern(rows, this->RowBegin.data(), this->Columns.data(), taken, this->Parallel);
    matrix.swap(taken); // complete: the loop may have been aborted
  }
  double* const values = matrix.valuePtr();
  const auto entry = [&](Index row, Index column) -> double&
  {
    const Index* const begin = this->Columns.data() + this->RowBegin[row];
    const Index* const end = this->Columns.data() + this->RowBegin[row + 1];
    return values[std::lower_bound(begin, end, column) - this->Columns.data()];
  };
  const auto fillCell = [&](Index c)
  {
    double sum = diagonal[c];
    for (Index k = this->CellBegin[c]; k < this->CellBegin[c + 1]; ++k)
    {
      const Index s = this->CellSides[k];
      const Index edge = this->Sides[static_cast<std::size_t>(s)].Edge;
      const double t = scale * this->Conductances[s];
      if (this->HasUnknown(edge))
      {
        sum += t;
        entry(c, this->CellCount + edge) -= t;
        continue;
      }
      for (Index other = this->EdgeBegin[edge]; other < this->EdgeBegin[edge + 1]; ++other)
      {
        const Index cell = this->Sides[static_cast<std::size_t>(other)].Cell;
        if (cell != c && t > 0.0)
        {
          const double others = scale * this->Conductances[other];
          const double flux =
            std::max(t, others) * (std::min(t, others) / (scale * this->Sums[edge]));
          sum += flux;
          entry(c, cell) -= flux;
        }
      }
    }
    entry(c, c) += sum;
  };
  const auto fillEdge = [&](Index edge)
  {
    for (Index s = this->EdgeBegin[edge]; s < this->EdgeBegin[edge + 1]; ++s)
    {
      entry(this->CellCount + edge, this->Sides[static_cast<std::size_t>(s)].Cell) -=
        scale * this->Conductances[s];
    }
    entry(this->CellCount + edge, this->CellCount + edge) += scale * this->Sums[edge];
  };
  ForEach(this->Parallel, rows,
    [&](Index row)
    {
      std::fill(values + this->RowBegin[row], values + this->RowBegin[row + 1], 0.0);
      if (row < this->CellCount)
      {
        fillCell(row);
      }
      else
      {
        fillEdge(row - this->CellCount);
      }
    });
}

} // namespace SurfaceDiffusion
