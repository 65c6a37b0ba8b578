// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SolverChoice.h"

#include "Core/Solvers/FallBackSolver.h"
#include "Core/Solvers/SolverCosts.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

constexpr double LongestSingleStep = 300.0; // c, of conjugate gradients in single precision
constexpr double SmallestToleranceOfLongSteps = 1e-5;

constexpr double AnisotropicCycles = 0.2; // x min(anisotropy, c) to this power

constexpr double SmallestDiffusionNumber = 1e-2; // below, nothing changes
constexpr double SteadyState = 1e4; // the diffusion number that a steady state is as long as

// Iterations run on all threads, but of a factorisation only the numbers, its smaller part. This is
// the time of iterations relative to that of factorisations, between one thread and two.
constexpr double Threads = 0.85;
// On meshes where conjugate gradients give up, multigrid takes the cycles of steps that are longer
// by this factor.
constexpr double Hardness = 30.0;
// Conjugate gradients are not given up before they need this factor of the expected iterations,
// multigrid not before that.
constexpr double LeastOfExpected = 1.5;
constexpr double LeastOfNext = 1.25; // of the time of the next method
// Where the matrix lets forecast the iterations: those of an even mesh, of the expected ones.
constexpr double EvenMesh = 0.5;
// Parametric surfaces have most needles, and their factor takes longer than that of the scanned
// surfaces of SolverCosts.h.
constexpr double FactorOfParametric = 1.7;
constexpr double MostOfExpected = 5.0;
} // namespace Measured

double DiffusionNumberOf(const SolverTask& task)
{
  return task.DiffusionNumber.value_or(Measured::SteadyState);
}

/// SolverChoice::Patience
int PatienceOf(double iterations)
{
  return static_cast<int>(std::min(iterations, 1e9));
}

/// SolverChoice::MayFactorize
bool MayFactorize(const SolverTask& task)
{
  return !task.IsDistributed || task.NumberOfVertices <= LargestReplicated;
}

/// Seconds that a method is expected to take in all, by SolverCosts.h.
class ExpectedCosts
{
public:
  explicit ExpectedCosts(const SolverTask& task)
    : Task(task)
    , S(std::max(task.NumberOfVertices, 1) / SolverCosts::Size)
    , C(std::max(DiffusionNumberOf(task), Measured::SmallestDiffusionNumber))
    , Digits(std::log(task.Tolerance) / std::log(1e-10))
  {
  }

  double Factorization() const
  {
    using namespace SolverCosts;
    const double substitution = this->Columns(SubstitutionColumn) *
      std::min(Substitution * std::pow(this->S, 1.4),
        LocalSubstitution * std::pow(this->C, 0.2) * this->S);
    return Factor * std::pow(this->S, 1.35) + this->Task.NumberOfSolves * substitution;
  }

  /// Of conjugate gradients with the diagonal.
  double Iterations() const
  {
    using namespace SolverCosts;
    return this->Digits *
      std::min(SolverCosts::Iterations * std::pow(this->C, 0.4) * std::pow(this->S, 0.1),
        IterationsAcross * std::sqrt(static_cast<double>(this->Task.NumberOfVertices)));
  }
  /// One iteration in each solve
  double Iteration() const
  {
    using namespace SolverCosts;
    const bool isSingle = this->C <= Measured::LongestSingleStep ||
      this->Task.Tolerance >= Measured::SmallestToleranceOfLongSteps;
    const double iteration = isSingle ? SingleIteration * this->Columns(SingleIterationColumn)
                                      : DoubleIteration * this->Columns(DoubleIterationColumn);
    return Measured::Threads * this->Task.NumberOfSolves * iteration * std::pow(this->S, 1.1);
  }

  /// Of multigrid. hardness: a factor on the diffusion number.
  double Cycles(double hardness = 1.0) const
  {
    using namespace SolverCosts;
    return this->Digits * (SolverCosts::Cycles + CyclesPerDecade * std::log10(hardness * this->C)) *
      std::pow(
        std::min(this->Task.Anisotropy, std::max(this->C, 1.0)), Measured::AnisotropicCycles);
  }
  double Multigrid(double hardness = 1.0) const
  {
    using namespace SolverCosts;
    const double cycles = this->Task.NumberOfSolves * this->Cycles(hardness);
    return Measured::Threads *
      (Hierarchy * this->S + this->Columns(CycleColumn) * cycles * Cycle * std::pow(this->S, 1.2));
  }

private:
  double Columns(double share) const { return 1.0 + share * (this->Task.NumberOfColumns - 1); }

  const SolverTask& Task;
  const double S, C, Digits;
};

/// Of Automatic.
SolverChoice FindFastest(const SolverTask& task)
{
  using namespace Measured;
  SolverChoice choice;
  choice.FallsBack = true;
  choice.MayFactorize = MayFactorize(task);
  if (task.NumberOfVertices <= SmallestIterative && task.Tolerance < LargestToleranceOfSmall &&
    !task.IsDistributed)
  {
    return choice;
  }
  const ExpectedCosts costs(task);
  const bool isForecast = task.AllowMultigrid && task.DiffusionNumber;
  const bool hasRoom =
    !task.IsDistributed && (task.NumberOfVertices <= LargestFactor || !task.AllowMultigrid);
  constexpr double never = std::numeric_limits<double>::infinity();
  const double conjugateGradient = costs.Iterations() * costs.Iteration();
  const double least = (isForecast ? EvenMesh : 1.0) * conjugateGradient;
  const double multigrid = task.AllowMultigrid ? costs.Multigrid() : never;
  const double factorization = hasRoom ? costs.Factorization() : never;
  if (factorization < std::min(least, multigrid))
  {
    return choice;
  }
  if (multigrid < least)
  {
    choice.Method = SolverMethod::Multigrid;
    choice.Patience = PatienceOf(MostOfExpected * costs.Cycles());
    return choice;
  }
  choice.Method = SolverMethod::ConjugateGradient;
  if (isForecast)
  {
    choice.ExpectedIterations = costs.Iterations();
    choice.DiffusionNumber = std::max(*task.DiffusionNumber, SmallestDiffusionNumber);
  }
  const double other = std::min(factorization, multigrid);
  if (other < conjugateGradient)
  {
    choice.Next = multigrid < factorization ? SolverMethod::Multigrid : SolverMethod::Direct;
    choice.Patience = PatienceOf(other / costs.Iteration());
    return choice;
  }
  double next = costs.Factorization();
  const double onNeedles = costs.Multigrid(Hardness);
  if (task.AllowMultigrid && (onNeedles < FactorOfParametric * next || !hasRoom))
  {
    choice.Next = SolverMethod::Multigrid;
    next = onNeedles;
  }
  choice.Patience = PatienceOf(
    std::max(LeastOfNext * next / costs.Iteration(), LeastOfExpected * costs.Iterations()));
  return choice;
}

std::unique_ptr<LinearSolver> MakeOne(SolverMethod method, const ParallelFor& parallel,
  const std::shared_ptr<const Reduction>& overProcesses)
{
  switch (method)
  {
    case SolverMethod::Direct:
      return overProcesses->IsSerial() ? MakeCholeskySolver(parallel)
                                       : MakeGatheredSolver(overProcesses, parallel);
    case SolverMethod::Multigrid:
      return MakeMultigridSolver(overProcesses, parallel);
    default:
      return MakeConjugateGradientSolver(overProcesses, parallel);
  }
}

} // namespace

SolverChoice ChooseSolver(SolverMethod method, const SolverTask& task)
{
  if (method == SolverMethod::Automatic && !task.IsPreconditioner)
  {
    return FindFastest(task);
  }
  SolverChoice choice;
  const SolverMethod best = task.IsDistributed ? SolverMethod::Multigrid : SolverMethod::Direct;
  choice.Method = method == SolverMethod::Automatic ? best : method;
  if (method == SolverMethod::Multigrid && !task.IsPreconditioner)
  {
    choice.FallsBack = true;
    choice.MayFactorize = MayFactorize(task);
    choice.Patience = std::numeric_limits<int>::max();
  }
  return choice;
}

bool WouldSolveAlike(
  const LinearSolver& solver, const SolverChoice& made, const SolverChoice& other)
{
  if (made == other)
  {
    return true;
  }
  const auto* const trying = dynamic_cast<const FallBackSolver*>(&solver);
  return trying && made.Method == other.Method && made.FallsBack == other.FallsBack &&
    made.Patience > 0 && other.Patience > 0 && trying->EndsAlike(other.Patience);
}

std::unique_ptr<LinearSolver> MakeSolver(const SolverChoice& choice, const ParallelFor& parallel,
  const std::shared_ptr<const Reduction>& overProcesses)
{
  if (!choice.FallsBack)
  {
    return MakeOne(choice.Method, parallel, overProcesses);
  }
  std::vector<SolverMethod> order = { choice.Method };
  for (const SolverMethod next :
    { choice.Next, SolverMethod::Direct, SolverMethod::ConjugateGradient })
  {
    const bool isPossible = next != SolverMethod::Direct || choice.MayFactorize;
    if (isPossible && std::find(order.begin(), order.end(), next) == order.end())
    {
      order.push_back(next);
    }
  }
  std::vector<std::unique_ptr<LinearSolver>> methods;
  for (const SolverMethod method : order)
  {
    methods.push_back(MakeOne(method, parallel, overProcesses));
  }
  const auto factor = std::find(order.begin(), order.end(), SolverMethod::Direct) - order.begin();
  return std::make_unique<FallBackSolver>(
    std::move(methods), static_cast<std::size_t>(factor), choice, parallel, overProcesses);
}

} // namespace SurfaceDiffusion
