// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SolverChoice.h"

#include "Core/Solvers/SolverCosts.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <stdexcept>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// What SolverCosts.h does not measure.
namespace Measured
{
// Fewer vertices are factorised in milliseconds, and solved to round-off.
constexpr double SmallestIterative = 5000.0;
constexpr double LargestToleranceOfSmall = 1e-5;

constexpr double LongestSingleStep = 150.0; // c, of conjugate gradients in single precision
constexpr double SmallestToleranceOfLongSteps = 1e-5;

constexpr double AnisotropicCycles = 0.2; // x min(anisotropy, c) to this power

constexpr double SmallestDiffusionNumber = 1e-2; // below, nothing changes
constexpr double SteadyState = 1e4; // the diffusion number that a steady state is as long as

// Iterations run on all threads, and a factorisation on one. This is their share of the time on one
// thread, between that of one thread and of two.
constexpr double Threads = 0.75;
// Over several processes longer steps are cheaper with multigrid.
constexpr double LargestDistributedJacobi = 10.0;
} // namespace Measured

double DiffusionNumberOf(const SolverTask& task)
{
  return task.DiffusionNumber.value_or(Measured::SteadyState);
}

SolverMethod FindFastest(const SolverTask& task)
{
  using namespace Measured;
  using namespace SolverCosts;
  const double n = task.NumberOfVertices;
  if (n <= SmallestIterative && task.Tolerance < LargestToleranceOfSmall)
  {
    return SolverMethod::Direct;
  }
  const double s = n / Size;
  const double c = std::max(DiffusionNumberOf(task), SmallestDiffusionNumber);
  const double digits = std::log(task.Tolerance) / std::log(1e-10);

  const auto columns = [&](double share) { return 1.0 + share * (task.NumberOfColumns - 1); };
  const double substitution = columns(SubstitutionColumn) *
    std::min(Substitution * std::pow(s, 1.4), LocalSubstitution * std::pow(c, 0.2) * s);
  const double factorization = Factor * std::pow(s, 1.5) + task.NumberOfSolves * substitution;

  const double iterations = digits *
    std::min(Iterations * std::pow(c, 0.4) * std::pow(s, 0.1), IterationsAcross * std::sqrt(n));
  const bool isSingle = c <= LongestSingleStep || task.Tolerance >= SmallestToleranceOfLongSteps;
  const double iteration = isSingle ? SingleIteration * columns(SingleIterationColumn)
                                    : DoubleIteration * columns(DoubleIterationColumn);
  const double conjugateGradient = Threads * task.NumberOfSolves * iterations * iteration * s;

  const double cycles = digits * (Cycles + CyclesPerDecade * std::log10(c)) *
    std::pow(std::min(task.Anisotropy, std::max(c, 1.0)), AnisotropicCycles);
  const double multigrid =
    Threads * (Hierarchy * s + columns(CycleColumn) * task.NumberOfSolves * cycles * Cycle * s);

  const double iterative =
    task.AllowMultigrid ? std::min(conjugateGradient, multigrid) : conjugateGradient;
  const bool hasRoom = task.NumberOfVertices <= LargestFactor || !task.AllowMultigrid;
  if (factorization < iterative && hasRoom)
  {
    return SolverMethod::Direct;
  }
  return iterative < conjugateGradient ? SolverMethod::Multigrid : SolverMethod::ConjugateGradient;
}

/// Several methods: the first, and the next ones for the systems on which those before fail.
class FallBackSolver : public LinearSolver
{
public:
  explicit FallBackSolver(std::vector<std::unique_ptr<LinearSolver>> methods)
    : Methods(std::move(methods))
  {
  }

  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress) override
  {
    this->Matrix = &matrix;
    for (this->First = 0;; ++this->First)
    {
      try
      {
        this->Methods[this->First]->SetMatrix(matrix, progress);
        return;
      }
      catch (const std::runtime_error&)
      {
        if (this->First + 1 == this->Methods.size())
        {
          throw;
        }
      }
    }
  }

  // The next solve tries the first method again: if the failure were remembered, the bits of a step
  // would depend on the steps computed before it.
  SolveReport Solve(const Values& b, Values& x, const ProgressMonitor& progress) override
  {
    SolveReport best;
    best.Residual = std::numeric_limits<double>::infinity();
    std::exception_ptr failure;
    double done = 0.0;
    for (std::size_t m = this->First; m < this->Methods.size(); ++m)
    {
      const double end = m + 1 < this->Methods.size() ? 0.5 * (1.0 + done) : 1.0;
      try
      {
        const SolveReport report = this->TrySolve(m, b, x, progress.Part(done, end));
        if (report.Converged)
        {
          progress.Report(1.0);
          return report;
        }
        if (report.Residual < best.Residual)
        {
          best = report;
          this->Best = x;
        }
      }
      catch (const std::runtime_error&)
      {
        if (!b.allFinite())
        {
          throw; // no method has an answer
        }
        failure = failure ? failure : std::current_exception();
        x.setZero(b.rows(), b.cols());
      }
      done = end;
    }
    if (!std::isfinite(best.Residual))
    {
      std::rethrow_exception(failure);
    }
    x = this->Best;
    best.IsFinal = true;
    return best;
  }

  void Precondition(const Values& r, Values& z) override
  {
    this->Methods[this->First]->Precondition(r, z);
  }

  bool RunsOnOneThread() const override { return this->Methods[this->First]->RunsOnOneThread(); }

private:
  SolveReport TrySolve(std::size_t m, const Values& b, Values& x, const ProgressMonitor& progress)
  {
    LinearSolver& method = *this->Methods[m];
    method.SetLimits(this->Limits);
    const double begin = m > this->First ? 0.8 : 0.0;
    if (m > this->First)
    {
      method.SetMatrix(*this->Matrix, progress.Part(0.0, begin));
    }
    return method.Solve(b, x, progress.Part(begin, 1.0));
  }

  std::vector<std::unique_ptr<LinearSolver>> Methods;
  std::size_t First = 0; ///< the first that took the matrix
  const SparseMatrix* Matrix = nullptr;
  Values Best;
};

std::unique_ptr<LinearSolver> MakeOne(SolverMethod method, const ParallelFor& parallel)
{
  switch (method)
  {
    case SolverMethod::Direct:
      return MakeCholeskySolver(parallel);
    case SolverMethod::Multigrid:
      return MakeMultigridSolver(parallel);
    default:
      return MakeConjugateGradientSolver(parallel);
  }
}

} // namespace

SolverChoice ChooseSolver(SolverMethod method, const SolverTask& task)
{
  SolverChoice choice;
  choice.Method = method;
  if (method == SolverMethod::Automatic)
  {
    choice.Method = task.IsPreconditioner ? SolverMethod::Direct : FindFastest(task);
    choice.FallsBack = !task.IsPreconditioner;
  }
  return choice;
}

std::unique_ptr<LinearSolver> MakeSolver(const SolverChoice& choice, const ParallelFor& parallel)
{
  if (!choice.FallsBack)
  {
    return MakeOne(choice.Method, parallel);
  }
  std::vector<std::unique_ptr<LinearSolver>> methods;
  methods.push_back(MakeOne(choice.Method, parallel));
  for (const SolverMethod next : { SolverMethod::Direct, SolverMethod::ConjugateGradient })
  {
    if (next != choice.Method)
    {
      methods.push_back(MakeOne(next, parallel));
    }
  }
  return std::make_unique<FallBackSolver>(std::move(methods));
}

bool PreferDistributedMultigrid(SolverMethod method, const SolverTask& task)
{
  if (method != SolverMethod::Automatic)
  {
    return method == SolverMethod::Multigrid;
  }
  const bool isLong = DiffusionNumberOf(task) > Measured::LargestDistributedJacobi;
  return task.IsPreconditioner || (task.AllowMultigrid && isLong);
}

} // namespace SurfaceDiffusion
