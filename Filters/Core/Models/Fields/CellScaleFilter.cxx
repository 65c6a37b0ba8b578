// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Fields/CellScaleFilter.h"

#include "Core/Foundation/ColumnPanels.h"
#include "Core/Models/Fields/ResolventSeries.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/SolverChoice.h"

#include <algorithm>

namespace SurfaceDiffusion
{

CellScaleFilter::CellScaleFilter(std::shared_ptr<const Assembler> assembler, const Points& points,
  const std::vector<Index>& cells, Index count, const Vector& wavelengths, int order,
  const ParallelFor& parallel)
  : Parallel(parallel)
  , Transfer(assembler->Mesh(), cells, count, parallel)
  , Fluxes(assembler->Mesh(), points, cells, count, parallel)
  , Components(assembler->Mesh(), this->Transfer, parallel)
  , OfVertices(assembler, wavelengths, order, parallel)
  , Series(ScaleFilterSeries(order))
{
  const Vector& areas = this->CellAreas();
  // Cells that take no part have no fluxes: their unknown is 0.
  const Vector diagonal = (areas.array() > 0.0).select(areas, 1.0);
  this->Fluxes.SetDiffusivities(
    ScaleFilterDiffusivities(assembler->Mesh(), wavelengths, order, parallel));
  this->Fluxes.Assemble(diagonal, 1.0, this->Matrix);
  SolverTask task;
  task.NumberOfVertices = this->Fluxes.NumberOfRows();
  task.DiffusionNumber = 0.25 / std::max(count, 1) *
    Sum(
      parallel, count, [&](Index c) { return DiagonalEntry(this->Matrix, c) / diagonal[c] - 1.0; });
  task.NumberOfColumns = ColumnPanel;
  task.NumberOfSolves = static_cast<double>(this->Series.size() - 1);
  this->Solver = MakeSolver(SolverMethod::Automatic, task, parallel);
}

double CellScaleFilter::MissedResidual() const
{
  return std::max(this->Missed, this->OfVertices.MissedResidual());
}

void CellScaleFilter::Apply(Values& f, const ProgressMonitor& progress)
{
  if (!this->IsPrepared)
  {
    this->Solver->SetMatrix(this->Matrix, progress.Part(0.0, 0.2));
    this->IsPrepared = true;
  }
  Values u = this->Transfer.ToVertices(f, Vector::Ones(f.rows())).Of;
  Values detail = f - this->Transfer.ToCells(u);
  for (Eigen::Index c = 0; c < f.rows(); ++c)
  {
    if (!this->Transfer.Participates(static_cast<Index>(c)))
    {
      detail.row(c).setZero();
    }
  }
  this->OfVertices.Apply(u, progress.Part(0.2, 0.5));
  ForEachPanel(detail, progress.Part(0.5, 1.0),
    [this](Values& panel, const ProgressMonitor& ofPanel)
    {
      SumResolvents(
        this->Series, panel,
        [this](const Values& b, Values& y, const ProgressMonitor& part)
        { this->ApplyResolvent(b, y, part); },
        this->Parallel, ofPanel);
    });
  f = this->Transfer.ToCells(u) + detail;
}

void CellScaleFilter::ApplyResolvent(const Values& b, Values& y, const ProgressMonitor& progress)
{
  const auto cells = static_cast<Index>(b.rows());
  Values right = Values::Zero(this->Fluxes.NumberOfRows(), b.cols());
  ForEach(this->Parallel, cells, [&](Index c) { right.row(c) = this->CellAreas()[c] * b.row(c); });
  Values x = Values::Zero(right.rows(), right.cols());
  x.topRows(cells) = b;
  const SolveReport report = this->Solver->Solve(right, x, progress);
  RequireAnswer(report, this->Solver->GetLimits());
  this->Missed = report.Converged ? this->Missed : std::max(this->Missed, report.Residual);
  y = x.topRows(cells);
  this->CorrectMeans(b, y);
}

/// The sum of A y over a component is that of A b, in which the fluxes vanish: what the solve leaves
/// over is put back evenly.
void CellScaleFilter::CorrectMeans(const Values& b, Values& y)
{
  const Eigen::Index columns = b.cols();
  this->Components.Sum(columns + 1,
    [&](Index c, Eigen::Index k)
    { return this->CellAreas()[c] * (k < columns ? b(c, k) - y(c, k) : 1.0); });
  for (Index component = 0; component < this->Components.Count(); ++component)
  {
    const double area = this->Components.SumOf(component, columns);
    for (Index k = this->Components.Begin(component);
         area > 0.0 && k < this->Components.End(component); ++k)
    {
      for (Eigen::Index column = 0; column < columns; ++column)
      {
        y(this->Components.Cell(k), column) += this->Components.SumOf(component, column) / area;
      }
    }
  }
}

} // namespace SurfaceDiffusion
