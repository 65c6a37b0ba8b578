// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/LinearSolver.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace SurfaceDiffusion
{

namespace
{

std::string DescribeFailure(const SolveReport& report)
{
  std::ostringstream text;
  text << "the linear solver stopped after " << report.Iterations
       << " iterations at a relative residual of " << report.Residual
       << "; allow a larger Tolerance or MaximumNumberOfIterations, or set Solver to Direct";
  return text.str();
}

} // namespace

NotConverged::NotConverged(const SolveReport& report)
  : std::runtime_error(DescribeFailure(report))
{
}

double LinearSolver::ScaleOf(
  const Values& a, const Values& b, Eigen::Index column, const ParallelFor& parallel)
{
  const double largest = Max(parallel, static_cast<Index>(a.rows()),
    [&](Index i) { return std::max(std::abs(a(i, column)), std::abs(b(i, column))); });
  return largest > 0.0 && std::isfinite(largest) ? std::exp2(std::ilogb(largest)) : 1.0;
}

SolverMethod ChooseMethod(const SolverTask& task)
{
  // Fitted to times on one core of scans with 11,000 to 711,000 vertices: seconds at 44,000, up to
  // one common factor. Travelling once over the surface bounds the iterations of long steps. What
  // iterates runs on all threads: its times are those between one thread and two.
  constexpr double threads = 0.75;
  // A factor this large takes 1 kB per vertex and, on regular meshes, up to ten times as long as on
  // scans.
  constexpr Index largestFactor = 800000;
  const double n = task.NumberOfVertices;
  const double size = n / 44000.0;
  const double digits = std::log(task.Tolerance) / std::log(1e-10);
  const double c = std::max(task.DiffusionNumber, 1e-2);
  const double iterations =
    digits * std::min(67.0 * std::pow(c, 0.4) * std::pow(size, 0.1), 6.5 * std::sqrt(n));
  const double cycles = digits * (9.5 + 2.7 * std::log10(c));

  // In short steps a vertex feels only those near it: the factor has as much per vertex at any
  // size.
  const double substitution =
    std::min(0.0027 * std::pow(size, 1.4), 0.004 * std::pow(c, 0.2) * size);
  const double direct = 0.112 * std::pow(size, 1.5) + task.NumberOfSolves * substitution;
  const double conjugateGradient = threads * task.NumberOfSolves * iterations * 4.2e-4 * size;
  const double multigrid = threads * (0.036 * size + task.NumberOfSolves * cycles * 2.9e-3 * size);
  const double iterative =
    task.AllowMultigrid ? std::min(conjugateGradient, multigrid) : conjugateGradient;
  if (direct < iterative && (task.NumberOfVertices <= largestFactor || !task.AllowMultigrid))
  {
    return SolverMethod::Factorization;
  }
  return iterative < conjugateGradient ? SolverMethod::Multigrid : SolverMethod::ConjugateGradient;
}

std::unique_ptr<LinearSolver> MakeSolver(SolverMethod method, const ParallelFor& parallel)
{
  switch (method)
  {
    case SolverMethod::ConjugateGradient:
      return MakeConjugateGradientSolver(parallel);
    case SolverMethod::Multigrid:
      return MakeMultigridSolver(parallel);
    default:
      return MakeCholeskySolver(parallel);
  }
}

namespace
{

/// An iterative solver that a factorisation helps out.
class AutomaticSolver : public LinearSolver
{
public:
  AutomaticSolver(SolverMethod method, const ParallelFor& parallel)
    : Iterative(MakeSolver(method, parallel))
    , Cholesky(MakeCholeskySolver(parallel))
  {
  }

  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress) override
  {
    this->Matrix = &matrix;
    this->Iterative->SetMatrix(matrix, progress);
  }

  SolveReport Solve(const Values& b, Values& x, const ProgressMonitor& progress) override
  {
    this->Iterative->SetLimits(this->Limits);
    const SolveReport report = this->Iterative->Solve(b, x, progress.Part(0.0, 0.5));
    if (report.Converged)
    {
      progress.Report(1.0);
      return report;
    }
    // The next solve tries again: were the failure remembered, the bits of a step would depend on
    // the steps computed before it.
    this->Cholesky->SetLimits(this->Limits);
    this->Cholesky->SetMatrix(*this->Matrix, progress.Part(0.5, 0.9));
    return this->Cholesky->Solve(b, x, progress.Part(0.9, 1.0));
  }

private:
  std::unique_ptr<LinearSolver> Iterative, Cholesky;
  const SparseMatrix* Matrix = nullptr;
};

} // namespace

std::unique_ptr<LinearSolver> MakeAutomaticSolver(
  const SolverTask& task, const ParallelFor& parallel)
{
  const SolverMethod method = ChooseMethod(task);
  if (method == SolverMethod::Factorization)
  {
    return MakeCholeskySolver(parallel);
  }
  return std::make_unique<AutomaticSolver>(method, parallel);
}

} // namespace SurfaceDiffusion
