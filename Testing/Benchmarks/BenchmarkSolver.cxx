// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The cost of the linear solvers in a backward Euler step dt = c h^2 that starts from noise. SetUp
// computes the factor or the multigrid hierarchy. Solve is one solve to 1e-10 with the given number
// of columns. The number after "c:" is 10 c. CompareSolvers.cxx measures whole runs.

#include "HeatSystem.h"

#include "Core/Solvers/SolverChoice.h"

#include <string>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

HeatSystem MakeSystem(const benchmark::State& state)
{
  return HeatSystem(
    SurfaceOfLevel(static_cast<int>(state.range(0))), static_cast<double>(state.range(1)) / 10.0);
}

void SetUp(benchmark::State& state, SolverMethod method)
{
  const HeatSystem system = MakeSystem(state);
  for (auto _ : state)
  {
    const auto solver = MakeSolver(method);
    solver->SetMatrix(system.Matrix);
  }
  CountVertices(state, system.Mesh->NumberOfVertices());
}

/// Set-up for new values of the matrix with an unchanged pattern.
void SetUpAgain(benchmark::State& state, SolverMethod method)
{
  HeatSystem system = MakeSystem(state);
  const auto solver = MakeSolver(method);
  solver->SetMatrix(system.Matrix);
  for (auto _ : state)
  {
    system.Matrix *= 1.01;
    solver->SetMatrix(system.Matrix);
  }
  CountVertices(state, system.Mesh->NumberOfVertices());
}

void Solve(benchmark::State& state, SolverMethod method)
{
  const HeatSystem system = MakeSystem(state);
  const Values u = Noise(*system.Mesh, state.range(2));
  const Values b = system.RightHandSide(u);
  Values x = u;
  const auto solver = MakeSolver(method);
  solver->SetLimits({ 1e-10, 100000 });
  solver->SetMatrix(system.Matrix);
  int iterations = 0;
  for (auto _ : state)
  {
    x = u;
    iterations = solver->Solve(b, x).Iterations;
  }
  CountVertices(state, system.Mesh->NumberOfVertices());
  state.counters["iterations"] = iterations;
  if (method == SolverMethod::ConjugateGradient)
  {
    // In addition to the product: x, r, p and A p are read, x and r written; then r, the diagonal
    // and p are read, p written.
    const double n = system.Mesh->NumberOfVertices();
    const double columns = static_cast<double>(u.cols());
    CountBytes(
      state, iterations * (BytesOfProduct(system.Matrix, columns) + (72 * columns + 8) * n));
  }
}

using Benchmark = benchmark::internal::Benchmark;
using Numbers = std::vector<std::int64_t>;

Benchmark* OnProcessTime(Benchmark* b, std::vector<std::string> names)
{
  return b->ArgNames(std::move(names))->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
}

const Numbers Levels = { 0, 1, 2, 3 };
constexpr std::int64_t Largest = 4; // too large for a factorisation

void SetUpOnLevels(Benchmark* b)
{
  OnProcessTime(b, { "level", "c" })->ArgsProduct({ Levels, { 1000 } });
}

void SetUpOnAllLevels(Benchmark* b)
{
  SetUpOnLevels(b);
  b->Args({ Largest, 1000 });
}

Benchmark* SolveOnLevels(Benchmark* b, Numbers tenths)
{
  return OnProcessTime(b, { "level", "c", "columns" })
    ->ArgsProduct({ Levels, std::move(tenths), { 1, 3 } });
}

void SolveOnShortAndLongSteps(Benchmark* b) // all further ones take as long as the last one
{
  SolveOnLevels(b, { 1, 1000 });
}

void SolveOnAllLevels(Benchmark* b)
{
  SolveOnLevels(b, { 1, 10, 1000, 100000 })->ArgsProduct({ { Largest }, { 1, 10, 1000 }, { 1 } });
}

} // namespace

BENCHMARK_CAPTURE(SetUp, Direct, SolverMethod::Direct)->Apply(SetUpOnLevels);
BENCHMARK_CAPTURE(SetUpAgain, Direct, SolverMethod::Direct)->Apply(SetUpOnLevels);
BENCHMARK_CAPTURE(SetUp, Multigrid, SolverMethod::Multigrid)->Apply(SetUpOnAllLevels);
BENCHMARK_CAPTURE(Solve, Direct, SolverMethod::Direct)->Apply(SolveOnShortAndLongSteps);
BENCHMARK_CAPTURE(Solve, Multigrid, SolverMethod::Multigrid)->Apply(SolveOnAllLevels);
BENCHMARK_CAPTURE(Solve, ConjugateGradient, SolverMethod::ConjugateGradient)
  ->Apply(SolveOnAllLevels);
