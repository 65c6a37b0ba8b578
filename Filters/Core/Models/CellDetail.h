// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/CellRange.h"
#include "Core/Models/Model.h"
#include "Core/Operators/CellFluxes.h"
#include "Core/Operators/CellTransfer.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The part of data f on cells that the vertices do not resolve, d = f - P* u_0 with the transfer
/// P* from vertices to cells and the initial state u_0. The result on cells is P* u + d. Beside the
/// state u, d diffuses as the model does, by one step of backward Euler per step of the model,
///
///     (A + dt L + dt lambda w chi A) d_new = A (d_old + dt lambda w chi d_0),
///
/// with the areas A of the cells, the fluxes L of CellFluxes for the diffusion tensor D of the
/// model's step, and the model's lambda, factors w and indicator chi of the known cells. If the
/// model's step is an ExponentialSeries, so is that of d, of such steps. The steady
/// state is the limit of infinite dt; of a connected component without fidelity it is the mean.
/// With an L1 norm, lambda is divided by the distance of the result to f at the old d. Per
/// connected component without held cells, the sum of A d is that of the equation, to round-off.
/// All errors of this step are errors of d, which is of second order in the size of the cells for
/// smooth f.
///
/// P* u and d keep their ranges if the model does, but their sum may leave that of f by some
/// percent where d decays faster than u: next to jumps between plateaus. CellRange puts it back.
class CellDetail
{
public:
  /// The data of the cells.
  struct Data
  {
    Values Start; ///< d_0; zero at cells that take no part
    Values Factors; ///< w chi, of each column or of all in one
    std::vector<char> Held; ///< cells whose d stays
    double Rounding = 0.0; ///< of the distance in L1, in units of the values
    bool HasRange = true; ///< false: values outside the range of f have a meaning
  };

  /// diffusionNumber: the mean of the diagonal of dt L/A over 4, which is dt D/h^2 on squares;
  /// infinite for steady states.
  using SolverFinder =
    std::function<std::shared_ptr<LinearSolver>(double diffusionNumber, bool isConstant)>;

  /// mesh: that of `cells`. isFlipped: whether the model is on another triangulation of the same
  /// vertices, modelMesh. firstState: u_0. All references must outlive this object.
  CellDetail(const TriangleMesh& mesh, const TriangleMesh& modelMesh, const CellTransfer& cells,
    std::unique_ptr<CellFluxes> fluxes, const Values& firstState, Data data,
    SolverFinder findSolver, const ParallelFor& parallel);

  /// A step beside the last one of the model.
  void Advance(Model& model, StepReport& report, const ProgressMonitor& progress);

  /// d - d_0 of a cell.
  Eigen::RowVectorXd Change(Index cell) const
  {
    return this->Detail.row(cell) - this->Given.Start.row(cell);
  }

  std::size_t CheckpointSize() const { return static_cast<std::size_t>(this->Detail.size()); }
  void Save(double* checkpoint) const;
  void Restore(const double* checkpoint);

private:
  /// A step of all columns by backward Euler.
  void StepBackwardEuler(
    Model& model, const DiffusionStep& step, StepReport& report, const ProgressMonitor& progress);
  void StepExponential(
    Model& model, DiffusionStep step, StepReport& report, const ProgressMonitor& progress);
  /// The same of columns that share D.
  void AdvanceColumns(Eigen::Index first, Eigen::Index last, Model& model,
    const DiffusionStep& step, StepReport& report, const ProgressMonitor& progress);
  void TakeDiffusion(Model& model, Eigen::Index column);
  void Assemble(Eigen::Index first, Eigen::Index last, const DiffusionStep& step,
    const Values& state, const ProgressMonitor& progress);
  void MeasureDistances(Eigen::Index first, Eigen::Index last, const Values& state);
  void FixFreeComponents(Eigen::Index first, Eigen::Index last);
  void ImposeHeld(Eigen::Index first, Eigen::Index last);
  double DiffusionNumber(double inertia) const;
  /// Of cells, and of the values at edges, which are free.
  bool IsFixed(Index row) const
  {
    return row < this->Cells.NumberOfCells() && this->Fixed[static_cast<std::size_t>(row)] != 0;
  }
  void SolvePanel(Eigen::Index first, Eigen::Index count, const DiffusionStep& step,
    StepReport& report, const ProgressMonitor& progress);
  void CorrectMeans(const Values& b, Values& x);

  const TriangleMesh& Mesh;
  const TriangleMesh& ModelMesh;
  const CellTransfer& Cells;
  std::unique_ptr<CellFluxes> Fluxes;
  const Values& FirstState;
  Data Given;
  SolverFinder FindSolver;
  const ParallelFor& Parallel;

  CellComponents Components;
  CellRange Range; ///< of f; empty without HasRange
  Values Detail; ///< d, and the values at edges on interfaces
  std::shared_ptr<LinearSolver> Solver;
  bool IsAssembled = false; ///< the matrix is that of all steps
  SparseMatrix Matrix;
  std::vector<char> Fixed; ///< held, in a free component of a steady state, or without area
  std::vector<char> CanShift; ///< per component: no cell is fixed
  Vector Balance; ///< A (1 + dt lambda w chi)
  Vector Pull; ///< dt lambda w chi A
  Values Load; ///< of fixed cells on the others, all columns; no rows if there are none
  Vector Distances; ///< of the result to f
  Values VertexSums; ///< trace of D and areas around each vertex of a flipped mesh
  Vector Diffusivities; ///< per triangle, likewise
  struct Panel
  {
    Values X, B;
  };
  struct SeriesTerms
  {
    Values LastTerm, TermBefore, Sum;
  };
  SeriesTerms Series; ///< of an exponential step; kept, since later steps allocate nothing
  std::array<Panel, 2> Panels; ///< of ColumnPanel columns, and of fewer
};

} // namespace SurfaceDiffusion
