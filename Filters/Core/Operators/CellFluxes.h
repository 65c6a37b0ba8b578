// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The finite volume method of div(D grad w) with one unknown w_c per cell: the outflow of cell c
/// is
///
///     (L w)_c = sum over the edges e of c and the other cells c' at e of
///               t_ce t_c'e / (sum over the cells at e of t) (w_c - w_c'),
///     t_ce = |e| (n . D n) / |x_c - x_e|,
///
/// the two-point flux through an edge with the half transmissibilities t, where x_c is the centroid
/// of the cell, x_e the midpoint of the edge, n its normal in the triangle of the cell at e, and D
/// that triangle's. With D = 1 in two cells at an edge that is |e| over the distance of their
/// centres by way of x_e. All cells at an edge of more than two exchange fluxes. L is symmetric,
/// its columns sum to zero, and its entries off the diagonal are not positive on any surface:
/// backward Euler keeps the range of w and the sum of A_c w_c.
///
/// The fluxes are not consistent where x_c - x_c' is not normal to e. They are for differences
/// between cells that last for a few steps, see CellDetail.
///
/// Over several processes the value at an edge on an interface is an unknown of its own, in the row
/// of the number of cells plus its number in Reduction::InterfaceEdges(); eliminated, it gives the
/// fluxes above. So is, in the rows after these, that at an edge of many triangles, whose cells would
/// have a full matrix.
class CellFluxes
{
public:
  /// points: of the input of the mesh. cells: as for CellTransfer. `mesh` must live longer.
  CellFluxes(const TriangleMesh& mesh, const Points& points, const std::vector<Index>& cells,
    Index count, const ParallelFor& parallel);

  Index NumberOfCells() const { return this->CellCount; }
  /// Cells, then edges with an unknown of their own.
  Index NumberOfRows() const { return static_cast<Index>(this->RowBegin.size()) - 1; }
  /// Over the processes, for vectors with an entry per row.
  std::shared_ptr<const Reduction> GetReduction() const { return this->OverProcesses; }

  /// Take D = 1; D of the weights (12) of each triangle; or D of a number for each triangle.
  void SetUnitDiffusion();
  void SetWeights(const CornerWeights& weights);
  void SetDiffusivities(const Vector& ofTriangles);

  /// matrix = diag(d) + scale L; diagonal: d, an entry per cell.
  void Assemble(const Vector& diagonal, double scale, SparseMatrix& matrix) const;

private:
  /// An edge of a cell that has neighbours there.
  struct Side
  {
    Index Cell;
    Index Edge;
    Index Corner; ///< 3 t + a: opposite the edge in the triangle of the cell
    double Plain; ///< t of D = 1
    double Factor; ///< t over the sum of the weights of the triangle's other two edges
  };

  void ListSides(const Points& centres, const Points& points, const std::vector<Index>& cells);
  void MakePattern();
  template <typename Conductance>
  void SetConductances(const Conductance& conductance);
  bool HasUnknown(Index edge) const { return edge < this->UnknownCount; }

  const TriangleMesh& Mesh;
  const ParallelFor& Parallel;
  Index CellCount;
  Index UnknownCount = 0; ///< edges with an unknown are the first ones
  std::vector<Side> Sides; ///< by edge
  std::vector<Index> EdgeBegin;
  std::vector<Index> CellBegin, CellSides; ///< the sides of each cell
  Vector Conductances; ///< t per side
  Vector Sums; ///< of t per edge
  std::vector<Index> RowBegin, Columns; ///< the pattern
  std::shared_ptr<const Reduction> OverProcesses;
};

} // namespace SurfaceDiffusion
