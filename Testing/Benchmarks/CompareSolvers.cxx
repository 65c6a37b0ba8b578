// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// CompareSolvers [<largest level> | <mesh file>... | needles [<size>]] compares the solver
// Automatic with all solvers, for runs of several backward Euler steps of c h^2 from noise. It
// prints a line of JSON per surface, c and number of steps: CPU seconds and iterations per method,
// the method that Automatic begins with, and its time over that of the fastest. The surfaces are
// those of SurfaceOfLevel(), by default up to level 2 (178,000 vertices). Mesh files, by their
// names without an ending, are surfaces on which CalibrateSolvers did not measure; needles are
// those of NeedleMeshes.h with about size^2 vertices, by default 200^2.

#include "HeatSystem.h"
#include "NeedleMeshes.h"
#include "ProcessTime.h"

#include "Core/Solvers/SolverChoice.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string>
#include <utility>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr SolverMethod Methods[] = { SolverMethod::Direct, SolverMethod::ConjugateGradient,
  SolverMethod::Multigrid };
constexpr const char* Names[] = { "Direct", "ConjugateGradient", "Multigrid" };

/// Seconds of the set-up, and seconds and iterations of each step. Steps after the last measured
/// one cost as much as it.
struct Cost
{
  double SetUp = 0.0;
  std::vector<double> Steps;
  std::vector<double> Iterations;

  double Seconds(int steps) const { return this->SetUp + Sum(this->Steps, steps); }
  double NumberOfIterations(int steps) const { return Sum(this->Iterations, steps); }

private:
  static double Sum(const std::vector<double>& ofSteps, int steps)
  {
    double sum = 0.0;
    for (int step = 0; step < steps; ++step)
    {
      sum += ofSteps[std::min<std::size_t>(step, ofSteps.size() - 1)];
    }
    return sum;
  }
};

Cost MeasureOnce(const HeatSystem& system, const SolverChoice& choice, int steps)
{
  Cost cost;
  const auto solver = MakeSolver(choice);
  solver->SetLimits({ 1e-10, choice.FallsBack ? 1000 : 10000 });
  double start = Now();
  solver->SetMatrix(system.Matrix);
  cost.SetUp = Now() - start;
  Values u = Noise(*system.Mesh), b;
  for (int step = 0; step < std::min(steps, 3); ++step)
  {
    start = Now();
    b = system.RightHandSide(u);
    const SolveReport report = solver->Solve(b, u);
    cost.Steps.push_back(Now() - start);
    cost.Iterations.push_back(report.Iterations);
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

Cost Measure(const HeatSystem& system, const SolverChoice& choice, int steps = 3)
{
  const Cost cost = MeasureOnce(system, choice, steps);
  return cost.Seconds(1) < 3.0 ? Least(cost, MeasureOnce(system, choice, steps)) : cost;
}

void Compare(const std::string& name, HeatSystem& system, double number)
{
  system.SetDiffusionNumber(number);
  Cost costs[3];
  for (int m = 0; m < 3; ++m)
  {
    costs[m] = Measure(system, { Methods[m] });
  }
  for (const int steps : { 1, 3, 10, 30, 100 })
  {
    SolverTask task;
    task.NumberOfVertices = system.Mesh->NumberOfVertices();
    task.DiffusionNumber = number;
    task.NumberOfSolves = steps;
    const SolverChoice choice = ChooseSolver(SolverMethod::Automatic, task);
    const Cost automatic = Measure(system, choice, steps);
    const auto chosen = std::find(std::begin(Methods), std::end(Methods), choice.Method) - Methods;
    std::printf("{\"surface\": \"%s\", \"vertices\": %d, \"c\": %g, \"steps\": %d, ", name.c_str(),
      task.NumberOfVertices, number, steps);
    double best = costs[0].Seconds(steps);
    for (int m = 0; m < 3; ++m)
    {
      best = std::min(best, costs[m].Seconds(steps));
      std::printf("\"%s\": [%.4g, %g], ", Names[m], costs[m].Seconds(steps),
        costs[m].NumberOfIterations(steps));
    }
    std::printf("\"Automatic\": [%.4g, %g], \"chosen\": \"%s\", \"ratio\": %.3f}\n",
      automatic.Seconds(steps), automatic.NumberOfIterations(steps), Names[chosen],
      automatic.Seconds(steps) / best);
  }
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv)
{
  std::vector<std::pair<std::string, Surface>> surfaces;
  const bool haveNames = argc > 1 && std::strspn(argv[1], "0123456789") < std::strlen(argv[1]);
  if (haveNames && std::strcmp(argv[1], "needles") == 0)
  {
    const Index size = argc > 2 ? std::atoi(argv[2]) : 200;
    surfaces.emplace_back("sphere of meridians", LatitudeLongitudeSphere(size, size));
    surfaces.emplace_back("torus with a seam", TorusWithSeam(size));
    surfaces.emplace_back("cylinder with fans", CylinderWithFans(size, size));
    surfaces.emplace_back("contour of a grid", ContourOfGrid(size / 4));
  }
  else if (haveNames)
  {
    for (int a = 1; a < argc; ++a)
    {
      surfaces.emplace_back(argv[a], ReadMeshFile(argv[a]));
    }
  }
  else
  {
    const int last = argc > 1 ? std::atoi(argv[1]) : 2;
    for (int level = 0; level <= last; ++level)
    {
      surfaces.emplace_back("level " + std::to_string(level), SurfaceOfLevel(level));
    }
  }
  for (const auto& surface : surfaces)
  {
    HeatSystem system(surface.second);
    for (const double number : { 0.1, 1.0, 100.0, 1e4 })
    {
      Compare(surface.first, system, number);
    }
  }
  return 0;
}
