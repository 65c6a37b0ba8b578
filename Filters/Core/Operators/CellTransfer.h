// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The weighted means of cell data around each vertex.
struct VertexMeans
{
  Values Of; ///< one row per vertex; zero where no cell has weight
  Vector Weights; ///< sum over c of w_c m_ci
};

/// Conservative transfer of data between the cells of a surface, which are triangles or polygons of
/// several triangles, and its vertices. Cell c and the control cell of vertex i have the area
///
///     m_ci = sum over the triangles t of c around i of area(t)/3
///
/// in common, times the area factor of vertex i if the surface has given areas. The sum of m_ci
/// over i is the area A_c of the cell, and that over c is the area A_i of the control cell. On
/// triangles
///
///     (P f)_i  = sum over c of m_ci f_c / A_i     cells to vertices,
///     (P*u)_c  = sum over i of m_ci u_i / A_c     vertices to cells
///
/// are the mean of f over the control cell and the mean of the piecewise linear u over the cell.
/// They are adjoint in the inner products weighted by the areas. The m_ci of polygons depend on the
/// diagonals that cut them, so that P f would do so to first order. There P has an equal share of
/// the polygon's area for each of its corners in place of m_ci, and a constant for each connected
/// component of the surface, of second order, restores the integral.
///
/// P and P* keep constants and the integral: sum of A_i (P f)_i = sum of A_c f_c, and sum of A_c
/// (P*u)_c = sum of A_i u_i. P* P smooths: it keeps 31 % of the standard deviation of white noise
/// on the triangles of a regular mesh, and P 41 %.
class CellTransfer
{
public:
  /// cells: the cell of each row of triangles that `mesh` was made from, below `count`. `mesh` must
  /// live longer than this object. Triangles of zero area and unused cells take no part.
  /// Collective.
  CellTransfer(const TriangleMesh& mesh, const std::vector<Index>& cells, Index count,
    const ParallelFor& parallel);

  Index NumberOfCells() const { return static_cast<Index>(this->Areas.size()); }
  /// Whether the cell has any area.
  bool Participates(Index cell) const { return this->Areas[cell] > 0.0; }
  const Vector& CellAreas() const { return this->Areas; } ///< A_c, in the unit of the mesh

  /// The means with weights w_c >= 0, one per cell: P f if all are 1. Rows of `ofCells` without
  /// weight are not read. Collective.
  VertexMeans ToVertices(const Values& ofCells, const Vector& weights) const;
  /// P* u: one row per cell, zero at cells that take no part.
  Values ToCells(const Values& ofVertices) const;

  /// P* u of one cell; u(i): that of vertex i.
  template <typename F>
  double MeanOver(Index cell, const F& u) const
  {
    double mean = 0.0;
    for (Index k = this->CellBegin[static_cast<std::size_t>(cell)];
         k < this->CellBegin[static_cast<std::size_t>(cell) + 1]; ++k)
    {
      const Corner& corner = this->Corners[static_cast<std::size_t>(k)];
      mean += corner.Area / this->Areas[cell] * u(corner.Vertex);
    }
    return mean;
  }

  /// Call f(vertex) for the corners of a cell.
  template <typename F>
  void ForEachVertexOf(Index cell, const F& f) const
  {
    const auto c = static_cast<std::size_t>(cell);
    for (Index k = this->CellBegin[c]; k < this->CellBegin[c + 1]; ++k)
    {
      f(this->Corners[static_cast<std::size_t>(k)].Vertex);
    }
  }

  /// Call f(cell) for the cells around a vertex.
  template <typename F>
  void ForEachCellAround(Index vertex, const F& f) const
  {
    this->ForEachCornerAround(vertex, [&](const Corner& corner) { f(corner.Cell); });
  }

  /// The standard deviation of P f over that of f for white noise f, as root mean square over the
  /// surface. measuredAs: per cell, a number that cells with the same value share, as those do that
  /// were one when it was measured. leftOut: per vertex, those that do not count. Both may be
  /// empty. Collective.
  double NoiseGain(const std::vector<Index>& measuredAs = {}, const Flags& leftOut = Flags()) const;

  /// The standard deviation of the sum of weights times P f at vertices, for white noise f of
  /// deviation 1. measuredAs: see NoiseGain(). Of the cells of this process.
  double DeviationOf(const std::vector<Index>& vertices, const Vector& weights,
    const std::vector<Index>& measuredAs = {}) const;

private:
  /// A corner of a cell.
  struct Corner
  {
    Index Cell, Vertex;
    double Area; ///< m_ci
    double Share; ///< the weight of P
  };

  /// Call f(corner) for the corners at a vertex.
  template <typename F>
  void ForEachCornerAround(Index vertex, const F& f) const
  {
    const auto v = static_cast<std::size_t>(vertex);
    for (Index k = this->VertexBegin[v]; k < this->VertexBegin[v + 1]; ++k)
    {
      const Index corner = this->VertexCorners[static_cast<std::size_t>(k)];
      f(this->Corners[static_cast<std::size_t>(corner)]);
    }
  }

  void ListCorners(const std::vector<Index>& cellOfTriangle);
  /// Add constants to P f so that its integrals agree with those of f.
  void RestoreIntegrals(const Values& ofCells, const Vector& weights, VertexMeans& means) const;

  const TriangleMesh& Mesh;
  const ParallelFor& Parallel;
  std::vector<Corner> Corners; ///< by cell
  std::vector<Index> CellBegin; ///< of the corners of each cell
  std::vector<Index> VertexBegin, VertexCorners; ///< the corners around each vertex
  Vector Areas;
  bool HasPolygons = false; ///< in any process
};

} // namespace SurfaceDiffusion
