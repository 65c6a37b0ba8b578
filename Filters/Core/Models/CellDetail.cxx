// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/CellDetail.h"

#include "Core/Foundation/Columns.h"
#include "Core/Models/ExponentialSeries.h"
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
    this->AdvanceColumns(first, first + together, model, step, report,
      progress.Part(share(first), share(first + together)));
  }
}

/// As LinearDiffusion::StepExponential().
void CellDetail::StepExponential(
  Model& model, DiffusionStep step, StepReport& report, const ProgressMonitor& progress)
{
  constexpr int last = ExponentialSeries::Degree;
  step.TimeStep *= ExponentialSeries::Step;
  Values before = this->Detail;
  Values term = this->Detail;
  Values sum = ExponentialSeries::Coefficients[0] * this->Detail;
  for (int k = 1; k <= last; ++k)
  {
    this->StepBackwardEuler(
      model, step, report, progress.Part((k - 1.0) / last, static_cast<double>(k) / last));
    const double factor = k == 1 ? 2.0 : 4.0;
    this->Detail = factor * this->Detail - (factor - 2.0) * term - before;
    before.swap(term);
    term = this->Detail;
    sum += ExponentialSeries::Coefficients[static_cast<std::size_t>(k)] * term;
  }
  for (Index c = 0; c < this->Cells.NumberOfCells(); ++c)
  {
    if (this->Fixed[static_cast<std::size_t>(c)] == 0) // others keep their bits
    {
      this->Detail.row(c) = sum.row(c);
    }
  }
  this->Detail.bottomRows(this->Detail.rows() - this->Cells.NumberOfCells()) =
    sum.bottomRows(sum.rows() - this->Cells.NumberOfCells());
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

/// The triangles of a flipped mesh are not those of the cells, which take the mean of D over all
/// directions around their vertices: area trace D is the sum of the weights times |e|^2.
void CellDetail::TakeDiffusion(Model& model, Eigen::Index column)
{
  const CornerWeights& weights = model.DiffusionWeights(column);
  if (weights.rows() == 0)
  {
    this->Fluxes->SetUnitDiffusion();
    return;
  }
  if (&this->Mesh == &this->ModelMesh)
  {
    this->Fluxes->SetWeights(weights);
    return;
  }
  const TriangleMesh& mesh = this->ModelMesh;
  this->VertexSums.setZero(mesh.NumberOfVertices(), 2);
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      for (Index c = mesh.VertexCornersBegin()[i]; c < mesh.VertexCornersBegin()[i + 1]; ++c)
      {
        const Index t = mesh.VertexCorners()[c] / 3;
        const TriangleMesh::Shape& shape = mesh.Shapes()[t];
        for (int a = 0; a < 3; ++a)
        {
          const double length = shape.EdgeLength(a);
          this->VertexSums(i, 0) += 0.5 * weights(t, a) * length * length;
        }
        this->VertexSums(i, 1) += shape.Area();
      }
    });
  this->Diffusivities.resize(this->Mesh.NumberOfTriangles());
  ForEach(this->Parallel, this->Mesh.NumberOfTriangles(),
    [&](Index t)
    {
      double sum = 0.0;
      for (const Index i : this->Mesh.TriangleVertices().row(t))
      {
        sum += this->VertexSums(i, 0) / this->VertexSums(i, 1);
      }
      this->Diffusivities[t] = sum / 3.0;
    });
  this->Fluxes->SetDiffusivities(this->Diffusivities);
}

void CellDetail::Assemble(Eigen::Index first, Eigen::Index last, const DiffusionStep& step,
  const Values& state, const ProgressMonitor& progress)
{
  const bool isSteady = step.TimeStep == InfiniteTime;
  const double inertia = isSteady ? 0.0 : 1.0;
  const double dt = isSteady ? 1.0 : step.TimeStep;
  if (step.IsL1)
  {
    this->MeasureDistances(first, last, state);
  }
  this->Fixed.resize(this->Given.Held.size());
  ForEach(this->Parallel, this->Cells.NumberOfCells(),
    [&](Index c)
    {
      const auto cell = static_cast<std::size_t>(c);
      this->Fixed[cell] =
        static_cast<char>(this->Given.Held[cell] != 0 || !this->Cells.Participates(c));
      const double distance = step.IsL1 ? this->Distances[c] : 1.0;
      const double area = this->Cells.CellAreas()[c];
      this->Pull[c] = area * (dt * step.Fidelity * this->Given.Factors[c] / distance);
      this->Balance[c] = inertia * area + this->Pull[c];
    });
  if (isSteady)
  {
    this->FixFreeComponents(first, last);
  }
  this->Fluxes->Assemble(this->Balance, dt, this->Matrix);
  const double number = this->Solver ? 0.0 : this->DiffusionNumber(inertia);
  this->ImposeHeld(first, last);
  if (!this->Solver)
  {
    this->Solver = this->FindSolver(number, step.IsConstant);
  }
  this->Solver->SetMatrix(this->Matrix, progress);
}

/// The rounded distance of the result to f: P* (u - u_0) + d - d_0.
void CellDetail::MeasureDistances(Eigen::Index first, Eigen::Index last, const Values& state)
{
  this->Distances.resize(this->Cells.NumberOfCells());
  ForEach(this->Parallel, this->Cells.NumberOfCells(),
    [&](Index c)
    {
      double square = this->Given.Rounding * this->Given.Rounding;
      for (Eigen::Index k = first; k < last; ++k)
      {
        const double change = this->Detail(c, k) - this->Given.Start(c, k) +
          this->Cells.MeanOver(c, [&](Index i) { return state(i, k) - this->FirstState(i, k); });
        square += change * change;
      }
      this->Distances[c] = square > 0.0 ? std::sqrt(square) : 1.0;
    });
}

/// In a steady state without fidelity and held cells, d is the mean.
void CellDetail::FixFreeComponents(Eigen::Index first, Eigen::Index last)
{
  const Eigen::Index columns = last - first;
  this->Components.Sum(columns + 2,
    [&](Index cell, Eigen::Index k)
    {
      const double area = this->Cells.CellAreas()[cell];
      if (k < columns)
      {
        return area * this->Detail(cell, first + k);
      }
      const bool holds =
        this->Balance[cell] > 0.0 || this->Fixed[static_cast<std::size_t>(cell)] != 0;
      return k == columns ? area : (holds ? 1.0 : 0.0);
    });
  for (Index c = 0; c < this->Components.Count(); ++c)
  {
    if (this->Components.SumOf(c, columns + 1) > 0.0 || !(this->Components.SumOf(c, columns) > 0.0))
    {
      continue;
    }
    for (Index k = this->Components.Begin(c); k < this->Components.End(c); ++k)
    {
      const Index cell = this->Components.Cell(k);
      this->Fixed[static_cast<std::size_t>(cell)] = 1;
      for (Eigen::Index column = 0; column < columns; ++column)
      {
        this->Detail(cell, first + column) =
          this->Components.SumOf(c, column) / this->Components.SumOf(c, columns);
      }
    }
  }
}

double CellDetail::DiffusionNumber(double inertia) const
{
  if (inertia == 0.0)
  {
    return InfiniteTime;
  }
  const Index count = this->Cells.NumberOfCells();
  const double sum = Sum(this->Parallel, count,
    [&](Index c)
    {
      const double area = this->Cells.CellAreas()[c];
      return area > 0.0 ? (DiagonalEntry(this->Matrix, c) - this->Balance[c]) / area : 0.0;
    });
  return 0.25 * sum / std::max(count, 1);
}

/// Dirichlet conditions at fixed cells.
void CellDetail::ImposeHeld(Eigen::Index first, Eigen::Index last)
{
  const auto isFixed = [&](Index row)
  { return row < this->Cells.NumberOfCells() && this->Fixed[static_cast<std::size_t>(row)] != 0; };
  this->Components.Sum(1,
    [&](Index cell, Eigen::Index)
    { return this->Fixed[static_cast<std::size_t>(cell)] != 0 ? 1.0 : 0.0; });
  this->CanShift.resize(static_cast<std::size_t>(this->Components.Count()));
  for (Index c = 0; c < this->Components.Count(); ++c)
  {
    this->CanShift[static_cast<std::size_t>(c)] =
      static_cast<char>(this->Components.SumOf(c, 0) == 0.0);
  }
  if (std::none_of(this->Fixed.begin(), this->Fixed.end(), [](char fixed) { return fixed != 0; }))
  {
    this->Load.resize(0, 0);
    return;
  }
  this->Load.resize(this->Detail.rows(), this->Detail.cols());
  ForEach(this->Parallel, this->Fluxes->NumberOfRows(),
    [&](Index row)
    {
      this->Load.row(row).segment(first, last - first).setZero();
      for (Index slot = this->Matrix.outerIndexPtr()[row];
           slot < this->Matrix.outerIndexPtr()[row + 1]; ++slot)
      {
        const Index column = this->Matrix.innerIndexPtr()[slot];
        double& a = this->Matrix.valuePtr()[slot];
        if (isFixed(row))
        {
          a = column == row ? 1.0 : 0.0;
        }
        else if (isFixed(column))
        {
          this->Load.row(row).segment(first, last - first) -=
            a * this->Detail.row(column).segment(first, last - first);
          a = 0.0;
        }
      }
    });
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
      const bool isFixed =
        row < this->Cells.NumberOfCells() && this->Fixed[static_cast<std::size_t>(row)] != 0;
      if (!isFixed)
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

//------------------------------------------------------------------------------------------------
StepReport ModelWithCellDetail::Advance(const ProgressMonitor& progress)
{
  StepReport report = this->OfVertices->Advance(progress.Part(0.0, 0.6));
  this->Detail->Advance(*this->OfVertices, report, progress.Part(0.6, 1.0));
  return report;
}

void ModelWithCellDetail::Save(double* checkpoint) const
{
  this->OfVertices->Save(checkpoint);
  this->Detail->Save(checkpoint + this->OfVertices->CheckpointSize());
}

void ModelWithCellDetail::Restore(const double* checkpoint)
{
  this->OfVertices->Restore(checkpoint);
  this->Detail->Restore(checkpoint + this->OfVertices->CheckpointSize());
}

} // namespace SurfaceDiffusion
