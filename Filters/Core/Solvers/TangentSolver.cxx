// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/TangentSolver.h"

#include "Core/Operators/SparsePattern.h"

#include "Core/Operators/Assembler.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// Row i; K columns, known to the compiler unless it is Eigen::Dynamic.
template <int K>
Eigen::Map<Eigen::Matrix<double, 1, K>> Row(Values& v, Index i)
{
  return { v.data() + i * v.cols(), 1, v.cols() };
}
template <int K>
Eigen::Map<const Eigen::Matrix<double, 1, K>> Row(const Values& v, Index i)
{
  return { v.data() + i * v.cols(), 1, v.cols() };
}

/// Take from row i of x what is not tangential to the sphere at u_i; all of it where i is fixed.
template <int K>
void Project(const TangentSystem& system, Index i, Values& x)
{
  auto xi = Row<K>(x, i);
  const auto ui = Row<K>(system.U, i);
  if (system.Fixed[i])
  {
    xi.setZero();
    return;
  }
  xi -= (xi.dot(ui) / ui.squaredNorm()) * ui;
}

} // namespace

SolveReport TangentSolver::Solve(const TangentSystem& system, Values& x,
  LinearSolver* preconditioner, const IterationLimits& limits, const ProgressMonitor& progress)
{
  switch (system.U.cols())
  {
    case 2:
      return this->SolveColumns<2>(system, x, preconditioner, limits, progress);
    case 3:
      return this->SolveColumns<3>(system, x, preconditioner, limits, progress);
    default:
      return this->SolveColumns<Eigen::Dynamic>(system, x, preconditioner, limits, progress);
  }
}

template <int K>
SolveReport TangentSolver::SolveColumns(const TangentSystem& system, Values& x,
  LinearSolver* preconditioner, const IterationLimits& limits, const ProgressMonitor& progress)
{
  const SparseMatrix& matrix = system.Matrix;
  const Values& b = system.B;
  const Index n = static_cast<Index>(b.rows());
  x.setZero(b.rows(), b.cols());
  this->InverseDiagonal.resize(n);
  this->R = b;
  this->Z.resize(b.rows(), b.cols());
  this->P.setZero(b.rows(), b.cols());
  this->Q.resize(b.rows(), b.cols());
  const Reduction& reduction = system.Reduction;
  const Vector& inertia = reduction.Accumulated(system.Inertia, this->Inertia);
  ForEach(this->Parallel, n, [&](Index i) { this->InverseDiagonal[i] = DiagonalEntry(matrix, i); });
  reduction.Accumulate(this->InverseDiagonal);
  reduction.Accumulate(this->R);

  // Measured as in LinearSolver: in the norm of diag(A)^-1, whatever preconditions.
  const double scale = reduction.SumOverVertices(this->Parallel, n,
    [&](Index i)
    {
      this->InverseDiagonal[i] = 1.0 / this->InverseDiagonal[i];
      return inertia[i] * inertia[i] * this->InverseDiagonal[i] * Row<K>(system.U, i).squaredNorm();
    });
  const double start = reduction.SumOverVertices(this->Parallel, n,
    [&](Index i)
    {
      Project<K>(system, i, this->R);
      Project<K>(system, i, this->R); // near rest the first leaves as much round-off as there is
      return this->InverseDiagonal[i] * Row<K>(this->R, i).squaredNorm();
    });
  if (!std::isfinite(start))
  {
    throw std::runtime_error("the linear system has no finite solution");
  }

  const double target = limits.Tolerance * limits.Tolerance * std::max(scale, start);
  SolveReport report;
  double left = start;
  double rho = 0.0;
  while (left > target)
  {
    if (report.Iterations == limits.MaximumNumberOfIterations)
    {
      report.Converged = false;
      break;
    }
    const double previous = rho;
    rho = this->Precondition<K>(system, preconditioner);
    const double beta = previous > 0.0 ? rho / previous : 0.0;
    ForEach(this->Parallel, n,
      [&](Index i) { Row<K>(this->P, i) = Row<K>(this->Z, i) + beta * Row<K>(this->P, i); });
    Multiply(matrix, this->P, this->Q, this->Parallel);
    reduction.Accumulate(this->Q);
    const double curvature = reduction.SumOverVertices(this->Parallel, n,
      [&](Index i)
      {
        Project<K>(system, i, this->Q);
        return Row<K>(this->P, i).dot(Row<K>(this->Q, i));
      });
    if (!(curvature > 0.0)) // all that is left is round-off
    {
      report.Converged = false;
      break;
    }
    const double alpha = rho / curvature;
    left = reduction.SumOverVertices(this->Parallel, n,
      [&](Index i)
      {
        auto r = Row<K>(this->R, i);
        Row<K>(x, i) += alpha * Row<K>(this->P, i);
        r -= alpha * Row<K>(this->Q, i);
        return this->InverseDiagonal[i] * r.squaredNorm();
      });
    if (++report.Iterations % 8 == 0)
    {
      progress.Report(
        std::min(0.99, std::max(0.0, std::log(left / start) / std::log(target / start))));
    }
  }
  report.Residual = std::sqrt(left / std::max(scale, start));
  progress.Report(1.0);
  return report;
}

/// Z = P C^-1 R for the preconditioner C; returns R.Z.
template <int K>
double TangentSolver::Precondition(const TangentSystem& system, LinearSolver* preconditioner)
{
  if (preconditioner)
  {
    preconditioner->Precondition(this->R, this->Z);
  }
  return system.Reduction.SumOverVertices(this->Parallel, static_cast<Index>(this->R.rows()),
    [&](Index i)
    {
      if (preconditioner)
      {
        Project<K>(system, i, this->Z);
      }
      else
      {
        Row<K>(this->Z, i) = this->InverseDiagonal[i] * Row<K>(this->R, i);
      }
      return Row<K>(this->R, i).dot(Row<K>(this->Z, i));
    });
}

} // namespace SurfaceDiffusion
