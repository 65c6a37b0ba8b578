// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CellTransfer.h"

#include "Core/Foundation/Offsets.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace SurfaceDiffusion
{

CellTransfer::CellTransfer(const TriangleMesh& mesh, const std::vector<Index>& cells, Index count,
  const ParallelFor& parallel)
  : Mesh(mesh)
  , Parallel(parallel)
  , CellBegin(static_cast<std::size_t>(count) + 1, 0)
  , VertexBegin(static_cast<std::size_t>(mesh.NumberOfVertices()) + 1, 0)
  , Areas(Vector::Zero(count))
{
  std::vector<Index> cellOfTriangle(static_cast<std::size_t>(mesh.NumberOfTriangles()));
  for (std::size_t t = 0; t < cellOfTriangle.size(); ++t)
  {
    cellOfTriangle[t] = cells[static_cast<std::size_t>(mesh.InputTriangle()[t])];
  }
  this->ListCorners(cellOfTriangle);
  for (const Corner& corner : this->Corners)
  {
    ++this->VertexBegin[static_cast<std::size_t>(corner.Vertex)];
    this->Areas[corner.Cell] += corner.Area;
  }
  CountsToOffsets(this->VertexBegin);
  std::vector<Index> next = this->VertexBegin;
  this->VertexCorners.resize(this->Corners.size());
  for (std::size_t k = 0; k < this->Corners.size(); ++k)
  {
    Index& place = next[static_cast<std::size_t>(this->Corners[k].Vertex)];
    this->VertexCorners[static_cast<std::size_t>(place++)] = static_cast<Index>(k);
  }
  this->HasPolygons = mesh.GetReduction().Any(this->HasPolygons);
}

/// Cell by cell, each vertex once.
void CellTransfer::ListCorners(const std::vector<Index>& cellOfTriangle)
{
  std::vector<Index> order(cellOfTriangle.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&](Index a, Index b)
    {
      return cellOfTriangle[static_cast<std::size_t>(a)] <
        cellOfTriangle[static_cast<std::size_t>(b)];
    });
  this->Corners.reserve(3 * order.size());
  Vector factors = this->Mesh.ControlAreas();
  for (Index i = 0; i < this->Mesh.NumberOfVertices(); ++i)
  {
    factors[i] /= this->Mesh.ThirdOfTriangles(i);
  }
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end)
  {
    const Index cell = cellOfTriangle[static_cast<std::size_t>(order[begin])];
    const std::size_t first = this->Corners.size();
    double area = 0.0;
    for (end = begin;
         end < order.size() && cellOfTriangle[static_cast<std::size_t>(order[end])] == cell; ++end)
    {
      const Index t = order[end];
      const double ofTriangle = this->Mesh.Shapes()[static_cast<std::size_t>(t)].Area();
      area += ofTriangle;
      for (int a = 0; a < 3; ++a)
      {
        const Index vertex = this->Mesh.TriangleVertices()(t, a);
        const double factor = factors[vertex];
        auto found = std::find_if(this->Corners.begin() + static_cast<std::ptrdiff_t>(first),
          this->Corners.end(), [&](const Corner& corner) { return corner.Vertex == vertex; });
        if (found == this->Corners.end())
        {
          this->Corners.push_back({ cell, vertex, 0.0, factor });
          found = this->Corners.end() - 1;
        }
        found->Area += ofTriangle / 3.0 * factor;
      }
    }
    const auto count = static_cast<double>(this->Corners.size() - first);
    for (std::size_t k = first; k < this->Corners.size(); ++k)
    {
      this->Corners[k].Share *= area / count;
    }
    this->HasPolygons = this->HasPolygons || end - begin > 1;
    this->CellBegin[static_cast<std::size_t>(cell)] = static_cast<Index>(count);
  }
  CountsToOffsets(this->CellBegin);
}

VertexMeans CellTransfer::ToVertices(const Values& ofCells, const Vector& weights) const
{
  const Eigen::Index columns = ofCells.cols();
  const Index n = this->Mesh.NumberOfVertices();
  Values sums = Values::Zero(n, columns + 2); // the last columns: of the shares and of m_ci
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      this->ForEachCornerAround(i,
        [&](const Corner& corner)
        {
          const double weight = weights[corner.Cell];
          if (weight > 0.0)
          {
            sums.row(i).head(columns) += weight * corner.Share * ofCells.row(corner.Cell);
            sums(i, columns) += weight * corner.Share;
            sums(i, columns + 1) += weight * corner.Area;
          }
        });
    });
  this->Mesh.GetReduction().Accumulate(sums);
  VertexMeans means{ sums.leftCols(columns), sums.col(columns + 1) };
  for (Index i = 0; i < n; ++i)
  {
    if (sums(i, columns) > 0.0)
    {
      means.Of.row(i) /= sums(i, columns);
    }
  }
  if (this->HasPolygons)
  {
    this->RestoreIntegrals(ofCells, weights, means);
  }
  return means;
}

void CellTransfer::RestoreIntegrals(
  const Values& ofCells, const Vector& weights, VertexMeans& means) const
{
  const Eigen::Index columns = ofCells.cols();
  const Index count = this->Mesh.NumberOfComponents();
  const Reduction& reduction = this->Mesh.GetReduction();
  std::vector<Index> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), 0);
  Values sums = Values::Zero(count, columns + 1); // of f - P f, and of the weights
  for (Index c = 0; c < count; ++c)
  {
    for (Index i = this->Mesh.ComponentsBegin()[static_cast<std::size_t>(c)];
         i < this->Mesh.ComponentsBegin()[static_cast<std::size_t>(c) + 1]; ++i)
    {
      this->ForEachCornerAround(i,
        [&](const Corner& corner)
        {
          const double weight = weights[corner.Cell] * corner.Area;
          if (weight > 0.0)
          {
            sums.row(c).head(columns) += weight * (ofCells.row(corner.Cell) - means.Of.row(i));
            sums(c, columns) += weight;
          }
        });
    }
  }
  reduction.SumComponents(all, sums);
  for (Index c = 0; c < count; ++c)
  {
    const Index begin = this->Mesh.ComponentsBegin()[static_cast<std::size_t>(c)];
    const Index end = this->Mesh.ComponentsBegin()[static_cast<std::size_t>(c) + 1];
    for (Index i = begin; i < end && sums(c, columns) > 0.0; ++i)
    {
      if (means.Weights[i] > 0.0)
      {
        means.Of.row(i) += sums.row(c).head(columns) / sums(c, columns);
      }
    }
  }
}

Values CellTransfer::ToCells(const Values& ofVertices) const
{
  Values values = Values::Zero(this->NumberOfCells(), ofVertices.cols());
  ForEach(this->Parallel, this->NumberOfCells(),
    [&](Index cell)
    {
      for (Index k = this->CellBegin[static_cast<std::size_t>(cell)];
           k < this->CellBegin[static_cast<std::size_t>(cell) + 1]; ++k)
      {
        const Corner& corner = this->Corners[static_cast<std::size_t>(k)];
        values.row(cell) += corner.Area / this->Areas[cell] * ofVertices.row(corner.Vertex);
      }
    });
  return values;
}

double CellTransfer::NoiseGain(const std::vector<Index>& measuredAs, const Flags& leftOut) const
{
  const Index n = this->Mesh.NumberOfVertices();
  // A_i, the sum of the shares, and that of the squares of the shares of different values.
  Values sums = Values::Zero(n, 3);
  ForEach(this->Parallel, n,
    [&](Index i)
    {
      if (leftOut.size() > 0 && leftOut[i])
      {
        return;
      }
      this->ForEachCornerAround(i,
        [&](const Corner& corner)
        {
          double ofValue = corner.Share;
          if (!measuredAs.empty())
          {
            ofValue = 0.0;
            this->ForEachCornerAround(i,
              [&](const Corner& other)
              {
                const bool isSame = measuredAs[static_cast<std::size_t>(other.Cell)] ==
                  measuredAs[static_cast<std::size_t>(corner.Cell)];
                ofValue += isSame ? other.Share : 0.0;
              });
          }
          sums.row(i) += Eigen::RowVector3d(corner.Area, corner.Share, corner.Share * ofValue);
        });
    });
  const Reduction& reduction = this->Mesh.GetReduction();
  reduction.Accumulate(sums);
  const double area =
    reduction.SumOverVertices(this->Parallel, n, [&](Index i) { return sums(i, 0); });
  const double variance = reduction.SumOverVertices(this->Parallel, n,
    [&](Index i)
    { return sums(i, 1) > 0.0 ? sums(i, 0) * sums(i, 2) / (sums(i, 1) * sums(i, 1)) : 0.0; });
  return area > 0.0 ? std::sqrt(variance / area) : 1.0;
}

double CellTransfer::DeviationOf(const std::vector<Index>& vertices, const Vector& weights,
  const std::vector<Index>& measuredAs) const
{
  std::vector<std::pair<Index, double>> terms; // values, and what they are multiplied by
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    double sum = 0.0;
    this->ForEachCornerAround(vertices[v], [&](const Corner& corner) { sum += corner.Share; });
    this->ForEachCornerAround(vertices[v],
      [&](const Corner& corner)
      {
        terms.emplace_back(
          measuredAs.empty() ? corner.Cell : measuredAs[static_cast<std::size_t>(corner.Cell)],
          weights[static_cast<Eigen::Index>(v)] * corner.Share / sum);
      });
  }
  std::sort(terms.begin(), terms.end());
  double variance = 0.0;
  for (std::size_t k = 0; k < terms.size();)
  {
    double ofValue = 0.0;
    for (const Index value = terms[k].first; k < terms.size() && terms[k].first == value; ++k)
    {
      ofValue += terms[k].second;
    }
    variance += ofValue * ofValue;
  }
  return std::sqrt(variance);
}

} // namespace SurfaceDiffusion
