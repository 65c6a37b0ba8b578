// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/CellDetail.h"

#include "Core/Foundation/Columns.h"
#include "Core/Operators/ExponentialSeries.h"
#include "Core/Operators/SparsePattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The weights of L1 depend on the result: the steady state repeats its solve.
constexpr int RepetitionsOfL1 = 5;

} // namespace

CellDetail::CellDetail(const TriangleMesh& mesh, const TriangleMesh& modelMesh,
  const CellTransfer& cells, std::unique_ptr<CellFluxes> fluxes, const Values& firstState,
  Data data, SolverFinder findSolver, const ParallelFor& parallel)
  : Mesh(mesh)
  , ModelMesh(modelMesh)
  , Cells(cells)
  , Fluxes(std::move(fluxes))
  , FirstState(firstState)
  , Given(std::move(data))
  , FindSolver(std::move(findSolver))
  , Parallel(parallel)
  , Components(mesh, cells, parallel)
  , Detail(Values::Zero(this->Fluxes->NumberOfRows(), this->Given.Start.cols()))
{
  this->Detail.topRows(this->Given.Start.rows()) = this->Given.Start;
  if (this->Given.HasRange)
  {
    this->Range = CellRange(mesh, cells, firstState, this->Given.Start, parallel);
  }
  this->Balance.resize(cells.NumberOfCells());
  this->Pull.resize(cells.NumberOfCells());
}

void CellDetail::Save(double* checkpoint) const
{
  std::copy(this->Detail.data(), this->Detail.data() + this->Detail.size(), checkpoint);
}

void CellDetail::Restore(const double* checkpoint)
{
  std::copy(checkpoint, checkpoint + this->Detail.size(), this->Detail.data());
}

void CellDetail::Advance(Model& model, StepReport& report, const ProgressMonitor& progress)
{
  const DiffusionStep step = model.Diffusion();
  if (!(step.TimeStep > 0.0))
  {
    return;
  }
  if (step.IsExponential)
  {
    this->StepExponential(model, step, report, progress);
  }
  else
  {
    this->StepBackwardEuler(model, step, report, progress);
  }
  if (this->Given.HasRange)
  {
    this->Range.Keep(model.State(), this->Given.Held, this->Components, this->Detail);
  }
}

void CellDetail::StepBackwardEuler(
  Model& model, const DiffusionStep& step, StepReport& report, const ProgressMonitor& progress)
{
  const Eigen::Index columns = this->Detail.cols();
  const Eigen::Index together = step.SharesTensor ? columns : 1;
  for (Eigen::Index first = 0; first < columns; first += together)
  {
    const auto share = [&](Eigen::Index column)
    { return static_cast<double>(column) / static_cast<double>(columns); };
    DiffusionStep ofColumn = step;
    if (!step.SharesTensor)
    {
      model.DiffusionWeights(first);
      ofColumn.Fidelity = model.Diffusion().Fidelity; // ColumnModels have one for each
    }
    this->AdvanceColumns(first, first + together, model, ofColumn, report,
      progress.Part(share(first), share(first + together)));
  }
}

void CellDetail::StepExponential(
  Model& model, DiffusionStep step, StepReport& report, const ProgressMonitor& progress)
{
  constexpr int last = ExponentialSeries::Degree;
  step.TimeStep *= ExponentialSeries::Step;
  Values& before = this->Series.TermBefore;
  Values& term = this->Series.LastTerm;
  Values& sum = this->Series.Sum;
  before = this->Detail;
  term = this->Detail;
  sum = ExponentialSeries::Coefficients[0] * this->Detail;
  for (int k = 1; k <= last; ++k)
  {
    this->StepBackwardEuler(
      model, step, report, progress.Part((k - 1.0) / last, static_cast<double>(k) / last));
    const double coefficient = ExponentialSeries::Coefficients[static_cast<std::size_t>(k)];
    ForEach(this->Parallel, static_cast<Index>(sum.rows()),
      [&](Index row)
      {
        for (Eigen::Index c = 0; c < sum.cols(); ++c)
        {
          double& d = this->Detail(row, c);
          d = ExponentialSeries::NextTerm(k, d, term(row, c), before(row, c));
          before(row, c) = d;
          sum(row, c) += coefficient * d;
        }
      });
    before.swap(term);
  }
  ForEach(this->Parallel, static_cast<Index>(sum.rows()),
    [&](Index row)
    {
      if (!this->IsFixed(row)) // others keep their bits
      {
        this->Detail.row(row) = sum.row(row);
      }
    });
}

void CellDetail::AdvanceColumns(Eigen::Index first, Eigen::Index last, Model& model,
  const DiffusionStep& step, StepReport& report, const ProgressMonitor& progress)
{
  const bool keepsMatrix = step.IsConstant && !step.IsL1 && step.SharesTensor;
  const bool isSteady = step.TimeStep == InfiniteTime;
  const int repetitions = step.IsL1 && isSteady ? RepetitionsOfL1 : 1;
  for (int repetition = 0; repetition < repetitions; ++repetition)
  {
    if (!(keepsMatrix && this->IsAssembled))
    {
      this->IsAssembled = false;
      if (repetition == 0)
      {
        this->TakeDiffusion(model, first);
      }
      this->Assemble(first, last, step, model.State(), progress.Part(0.0, 0.5));
      this->IsAssembled = true;
    }
    for (Eigen::Index k = first; k < last; k += ColumnPanel)
    {
      this->SolvePanel(
        k, std::min<Eigen::Index>(ColumnPanel, last - k), step, report, progress.Part(0.5, 1.0));
    }
  }
}

void CellDetail::SolvePanel(Eigen::Index first, Eigen::Index count, const DiffusionStep& step,
  StepReport& report, const ProgressMonitor& progress)
{
  Panel& panel = this->Panels[count == ColumnPanel ? 0 : 1];
  const Index rows = this->Fluxes->NumberOfRows();
  const double inertia = step.TimeStep == InfiniteTime ? 0.0 : 1.0;
  panel.X.resize(rows, count);
  panel.B.resize(rows, count);
  ForEach(this->Parallel, rows,
    [&](Index row)
    {
      panel.X.row(row) = this->Detail.row(row).segment(first, count);
      if (row < this->Cells.NumberOfCells())
      {
        if (this->Fixed[static_cast<std::size_t>(row)] != 0)
        {
          panel.B.row(row) = panel.X.row(row);
          return;
        }
        panel.B.row(row) = inertia * this->Cells.CellAreas()[row] * panel.X.row(row) +
          this->Pull[row] * this->Given.Start.row(row).segment(first, count);
      }
      else
      {
        panel.B.row(row).setZero();
      }
      if (this->Load.rows() > 0)
      {
        panel.B.row(row) += this->Load.row(row).segment(first, count);
      }
    });
  const SolveReport solve = this->Solver->Solve(panel.B, panel.X, progress);
  RequireAnswer(solve, this->Solver->GetLimits());
  if (!solve.Converged)
  {
    report.MissedResidual = std::max(report.MissedResidual, solve.Residual);
  }
  this->CorrectMeans(panel.B, panel.X);
  ForEach(this->Parallel, rows,
    [&](Index row)
    {
      if (!this->IsFixed(row))
      {
        this->Detail.row(row).segment(first, count) = panel.X.row(row);
      }
    });
}

/// What the solve leaves over in the sum of the equations of a connected component, in which the
/// fluxes vanish, is put back: sum Balance x = sum b.
void CellDetail::CorrectMeans(const Values& b, Values& x)
{
  const Eigen::Index columns = b.cols();
  this->Components.Sum(columns + 1,
    [&](Index cell, Eigen::Index k)
    { return k < columns ? b(cell, k) - this->Balance[cell] * x(cell, k) : this->Balance[cell]; });
  for (Index c = 0; c < this->Components.Count(); ++c)
  {
    const double weight = this->Components.SumOf(c, columns);
    if (this->CanShift[static_cast<std::size_t>(c)] == 0 || !(weight > 0.0))
    {
      continue;
    }
    const Index begin = this->Components.Begin(c);
    const Index end = this->Components.End(c);
    ForEach(this->Parallel, end - begin,
      [&](Index k)
      {
        for (Eigen::Index column = 0; column < columns; ++column)
        {
          x(this->Components.Cell(begin + k), column) += this->Components.SumOf(c, column) / weight;
        }
      });
  }
}

} // namespace SurfaceDiffusion
