// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Fields/ResolventPolynomial.h"

#include "Core/Foundation/ColumnPanels.h"
#include "Core/Foundation/Resize.h"
#include "Core/Models/Fields/ResolventSeries.h"
#include "Core/Solvers/SolverChoice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

std::vector<double> ChebyshevSeries(const std::function<double(double)>& g, int degree)
{
  const double pi = std::acos(-1.0);
  std::vector<double> values(static_cast<std::size_t>(degree) + 1);
  for (int j = 0; j <= degree; ++j)
  {
    values[static_cast<std::size_t>(j)] = g(0.5 * (1.0 + std::cos(pi * j / degree)));
  }
  // The discrete cosine transform; the terms at both ends count half, and so do both end points.
  std::vector<double> series(values.size());
  for (int k = 0; k <= degree; ++k)
  {
    double sum = 0.0;
    for (int j = 0; j <= degree; ++j)
    {
      const double half = j == 0 || j == degree ? 0.5 : 1.0;
      sum += half * values[static_cast<std::size_t>(j)] *
        std::cos(pi * ((j * k) % (2 * degree)) / degree);
    }
    series[static_cast<std::size_t>(k)] = (k == 0 || k == degree ? 1.0 : 2.0) * sum / degree;
  }
  return series;
}

double SumChebyshev(const std::vector<double>& series, double y)
{
  const double w = 2.0 * y - 1.0;
  double sum = 0.0;
  double next = 0.0;
  for (std::size_t k = series.size(); k-- > 1;)
  {
    next = std::exchange(sum, series[k] + 2.0 * w * sum - next);
  }
  return series[0] + w * sum - next;
}

std::unique_ptr<LinearSolver> MakeResolventSolver(const TriangleMesh& mesh, double largestStep,
  const std::vector<double>& series, const ParallelFor& parallel)
{
  const double h = mesh.MeanEdgeLength();
  SolverTask task;
  task.NumberOfVertices = mesh.NumberOfVertices();
  task.DiffusionNumber = largestStep / (h * h);
  task.NumberOfColumns = ColumnPanel;
  task.NumberOfSolves = static_cast<double>(series.size() - 1);
  return MakeSolver(SolverMethod::Automatic, task, parallel);
}

ResolventPolynomial::ResolventPolynomial(std::shared_ptr<const Assembler> assembler,
  const CornerWeights& coefficients, double step, std::vector<double> series,
  std::shared_ptr<LinearSolver> solver, const ParallelFor& parallel)
  : Assembly(std::move(assembler))
  , Parallel(parallel)
  , Series(std::move(series))
  , System(this->Assembly, std::move(solver), parallel)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  this->System.Assemble(mesh.ControlAreas(), step, coefficients);
  this->Balanced = MeanCorrection(
    mesh, mesh.ControlAreas(), Flags::Constant(mesh.NumberOfVertices(), false), parallel);
}

void ResolventPolynomial::Apply(Values& u, const ProgressMonitor& progress)
{
  if (u.size() == 0)
  {
    return;
  }
  const double setup = this->IsPrepared ? 0.0 : 0.3;
  if (!this->IsPrepared)
  {
    this->System.SetUpSolver(progress.Part(0.0, setup));
    this->IsPrepared = true;
  }
  ForEachPanel(u, progress.Part(setup, 1.0),
    [this](Values& panel, const ProgressMonitor& part) { this->ApplyToPanel(panel, part); });
}

void ResolventPolynomial::ApplyToPanel(Values& u, const ProgressMonitor& progress)
{
  // Values are measured from their mean, so that the errors of the solves are relative to the
  // contrast.
  Eigen::RowVectorXd mean;
  FindMeans(this->Assembly->Mesh(), u, mean, this->Parallel);
  u.rowwise() -= mean;
  SumResolvents(
    this->Series, u,
    [&](const Values& b, Values& y, const ProgressMonitor& part) { this->Solve(b, y, part); },
    this->Parallel, progress);
  const double ofConstants = SumChebyshev(this->Series, 1.0);
  u.rowwise() += ofConstants * mean;
}

/// x = Y b.
void ResolventPolynomial::Solve(const Values& b, Values& x, const ProgressMonitor& progress)
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  Resize(this->RightHandSide, b.rows(), b.cols());
  ForEach(this->Parallel, mesh.NumberOfVertices(),
    [&](Index i) { this->RightHandSide.row(i) = mesh.ControlAreas()[i] * b.row(i); });
  x = b;
  this->System.Solve(this->RightHandSide, x, this->Report, progress);
  this->Balanced.Restore(mesh, this->RightHandSide, x, this->Parallel);
}

} // namespace SurfaceDiffusion
