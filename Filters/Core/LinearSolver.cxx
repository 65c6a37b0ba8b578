// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LinearSolver.h"

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

bool PreferFactorization(const SolverTask& task)
{
  // Times measured for Eigen's LDL^T and Jacobi-preconditioned conjugate gradients on one core, as
  // powers of the size through 44,000 and 711,000 vertices: seconds, up to one common factor.
  const double size = task.NumberOfVertices / 44000.0;
  const double factor = 0.106 * std::pow(size, 1.5);
  const double substitution = 0.004 * std::pow(size, 1.33);
  const double digits = std::log10(task.Tolerance) / -8.0; // measured to 1e-8
  const double iterations = digits * (10.0 + 45.0 * std::pow(task.DiffusionNumber, 0.42));
  const double conjugateGradients = 3.2e-4 * size * iterations;
  return factor + task.NumberOfSolves * substitution < task.NumberOfSolves * conjugateGradients;
}

namespace
{

class AutomaticSolver : public LinearSolver
{
public:
  AutomaticSolver(const SolverTask& task, const ParallelFor& parallel)
    : Direct(PreferFactorization(task))
    , Cholesky(MakeCholeskySolver(parallel))
    , Iterative(MakeConjugateGradientSolver(parallel))
  {
  }

  void SetMatrix(const SparseMatrix& matrix, const Monitor& monitor) override
  {
    this->Matrix = &matrix;
    this->Chosen().SetMatrix(matrix, monitor);
  }

  SolveReport Solve(const Values& b, Values& x, const Monitor& monitor) override
  {
    this->Cholesky->SetLimits(this->Limits);
    this->Iterative->SetLimits(this->Limits);
    if (this->Direct)
    {
      return this->Cholesky->Solve(b, x, monitor);
    }
    const SolveReport report = this->Iterative->Solve(b, x, monitor.Part(0.0, 0.5));
    if (report.Converged)
    {
      monitor.Report(1.0);
      return report;
    }
    // The next solve tries again: were the failure remembered, the bits of a step would depend on
    // the steps computed before it.
    this->Cholesky->SetMatrix(*this->Matrix, monitor.Part(0.5, 0.9));
    return this->Cholesky->Solve(b, x, monitor.Part(0.9, 1.0));
  }

private:
  LinearSolver& Chosen() { return this->Direct ? *this->Cholesky : *this->Iterative; }

  const bool Direct;
  std::unique_ptr<LinearSolver> Cholesky, Iterative;
  const SparseMatrix* Matrix = nullptr;
};

} // namespace

std::unique_ptr<LinearSolver> MakeAutomaticSolver(
  const SolverTask& task, const ParallelFor& parallel)
{
  return std::make_unique<AutomaticSolver>(task, parallel);
}

} // namespace SurfaceDiffusion
