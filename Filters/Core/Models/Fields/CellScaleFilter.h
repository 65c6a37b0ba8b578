// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fields/ScaleFilter.h"
#include "Core/Operators/CellComponents.h"
#include "Core/Operators/CellFluxes.h"
#include "Core/Operators/CellTransfer.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The ScaleFilter, p(Y) with the resolvent Y, of data f on cells. With the transfer
/// P from cells to vertices and P* back it is
///
///     P* p(Y) P f + p(Z) d,   d = f - P* P f,   Z = (A + L)^-1 A,
///
/// where the detail d, which the vertices do not resolve, has the areas A of the cells and the fluxes
/// L of CellFluxes for the diffusivities of the filter. Constants stay, and so does the integral over
/// each connected component, to round-off. Of smooth f it is of second order.
class CellScaleFilter
{
public:
  /// points, cells, count: see CellFluxes. wavelengths, order: see ScaleFilter. All references
  /// must outlive it.
  CellScaleFilter(std::shared_ptr<const Assembler> assembler, const Points& points,
    const std::vector<Index>& cells, Index count, const Vector& wavelengths, int order,
    const ParallelFor& parallel = SerialFor());

  /// A_c, in the unit of the mesh; 0 for cells that take no part.
  const Vector& CellAreas() const { return this->Transfer.CellAreas(); }
  /// f becomes the filtered data. Rows of cells that take no part are 0. Throws NotConverged and
  /// Aborted.
  void Apply(Values& f, const ProgressMonitor& progress = ProgressMonitor());
  /// See ResolventPolynomial.
  double MissedResidual() const;

private:
  /// y = Z b.
  void ApplyResolvent(const Values& b, Values& y, const ProgressMonitor& progress);
  void CorrectMeans(const Values& b, Values& y);

  const ParallelFor& Parallel;
  CellTransfer Transfer;
  CellFluxes Fluxes;
  CellComponents Components;
  ScaleFilter OfVertices;
  std::vector<double> Series;
  SparseMatrix Matrix; ///< A + L
  std::shared_ptr<LinearSolver> Solver;
  bool IsPrepared = false;
  double Missed = 0.0;
};

} // namespace SurfaceDiffusion
