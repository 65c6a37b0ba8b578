// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// CompareSolvers [<largest level> | <mesh file>...] compares the solver that Automatic selects with all solvers, for
// runs of several backward Euler steps of c h^2 from noise. It prints a line of JSON per size, c
// and number of steps: CPU seconds per method, the selected method, and its time over that of the
// fastest. The sizes are those of SurfaceOfLevel(), by default up to level 2 (178,000 vertices). Mesh
// files, by their names without an ending, are surfaces on which CalibrateSolvers did not measure.

#include "HeatSystem.h"
#include "ProcessTime.h"

#include "Core/Solvers/SolverChoice.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr SolverMethod Methods[] = { SolverMethod::Direct, SolverMethod::ConjugateGradient,
  SolverMethod::Multigrid };
constexpr const char* Names[] = { "Direct", "ConjugateGradient", "Multigrid" };

/// Seconds of the set-up and of each step. Steps after the last measured one cost as much as it.
struct Cost
{
  double SetUp = 0.0;
  std::vector<double> Steps;

  double Run(int steps) const
  {
    double seconds = this->SetUp;
    for (int step = 0; step < steps; ++step)
    {
      seconds += this->Steps[std::min<std::size_t>(step, this->Steps.size() - 1)];
    }
    return seconds;
  }
};

Cost Measure(const HeatSystem& system, SolverMethod method)
{
  Cost cost;
  const auto solver = MakeSolver(method);
  solver->SetLimits({ 1e-10, 100000 });
  double start = Now();
  solver->SetMatrix(system.Matrix);
  cost.SetUp = Now() - start;
  Values u = Noise(*system.Mesh), b;
  for (int step = 0; step < 3; ++step)
  {
    start = Now();
    b = system.RightHandSide(u);
    solver->Solve(b, u);
    cost.Steps.push_back(Now() - start);
  }
  return cost;
}

/// The minimum of two measurements, entry by entry, since other work on the machine only adds time.
Cost Least(const Cost& a, const Cost& b)
{
  Cost least = a;
  least.SetUp = std::min(a.SetUp, b.SetUp);
  for (std::size_t step = 0; step < least.Steps.size(); ++step)
  {
    least.Steps[step] = std::min(a.Steps[step], b.Steps[step]);
  }
  return least;
}

void Compare(HeatSystem& system, double number)
{
  system.SetDiffusionNumber(number);
  Cost costs[3];
  for (int m = 0; m < 3; ++m)
  {
    costs[m] = Measure(system, Methods[m]);
    if (costs[m].Run(1) < 3.0)
    {
      costs[m] = Least(costs[m], Measure(system, Methods[m]));
    }
  }
  for (const int steps : { 1, 3, 10, 30, 100 })
  {
    SolverTask task;
    task.NumberOfVertices = system.Mesh->NumberOfVertices();
    task.DiffusionNumber = number;
    task.NumberOfSolves = steps;
    const SolverMethod method = ChooseSolver(SolverMethod::Automatic, task).Method;
    const auto chosen = std::find(std::begin(Methods), std::end(Methods), method) - Methods;
    double seconds[3];
    for (int m = 0; m < 3; ++m)
    {
      seconds[m] = costs[m].Run(steps);
    }
    const double best = std::min({ seconds[0], seconds[1], seconds[2] });
    std::printf(
      "{\"vertices\": %d, \"c\": %g, \"steps\": %d, ", task.NumberOfVertices, number, steps);
    for (int m = 0; m < 3; ++m)
    {
      std::printf("\"%s\": %.4g, ", Names[m], seconds[m]);
    }
    std::printf("\"chosen\": \"%s\", \"ratio\": %.3f}\n", Names[chosen], seconds[chosen] / best);
  }
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv)
{
  std::vector<Surface> surfaces;
  const bool haveNames = argc > 1 && std::strspn(argv[1], "0123456789") < std::strlen(argv[1]);
  for (int a = 1; haveNames && a < argc; ++a)
  {
    surfaces.push_back(ReadMeshFile(argv[a]));
  }
  const int last = argc > 1 ? std::atoi(argv[1]) : 2;
  for (int level = 0; !haveNames && level <= last; ++level)
  {
    surfaces.push_back(SurfaceOfLevel(level));
  }
  for (const Surface& surface : surfaces)
  {
    HeatSystem system(surface);
    for (const double number : { 0.1, 1.0, 100.0, 1e4 })
    {
      Compare(system, number);
    }
  }
  return 0;
}
