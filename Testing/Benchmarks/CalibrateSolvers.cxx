// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// CalibrateSolvers [<largest level>] measures what the choice of a solver depends on, and prints
// Filters/Core/Solvers/SolverCosts.h. The surfaces are those of SurfaceOfLevel(), by default up to
// level 2 (178,000 vertices); CompareSolvers compares the choices with measurements on others.
// The exponents of the model are given; a factor is the geometric mean over the measurements.

#include "HeatSystem.h"
#include "ProcessTime.h"

#include "Core/Solvers/SolverChoice.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr double Size = 44000.0;
constexpr double Tolerance = 1e-10;
constexpr int Columns = 8;

struct Cost
{
  double SetUp = 0.0;
  double Solve = 0.0;
  double Iterations = 1.0;

  double PerIteration() const { return this->Solve / this->Iterations; }
};

/// The least of five measurements, as other work on the machine only adds time.
Cost Measure(const HeatSystem& system, SolverMethod method, int columns = 1)
{
  Cost least;
  for (int round = 0; round < 5; ++round)
  {
    const auto solver = MakeSolver(method);
    solver->SetLimits({ Tolerance, 100000 });
    Cost cost;
    double start = Now();
    solver->SetMatrix(system.Matrix);
    cost.SetUp = Now() - start;
    const Values b = system.RightHandSide(Noise(*system.Mesh)).replicate(1, columns);
    Values x = Values::Zero(b.rows(), b.cols());
    start = Now();
    const SolveReport report = solver->Solve(b, x);
    cost.Solve = Now() - start;
    cost.Iterations = std::max(1, report.Iterations);
    if (round == 0)
    {
      least = cost;
    }
    least.SetUp = std::min(least.SetUp, cost.SetUp);
    least.Solve = std::min(least.Solve, cost.Solve);
  }
  return least;
}

/// A line of the header: the geometric mean of the measurements over the model.
class Line
{
public:
  Line(std::string name, std::string comment)
    : Name(std::move(name))
    , Comment(std::move(comment))
  {
  }
  void Add(double measured, double model = 1.0)
  {
    this->SumOfLogarithms += std::log(measured / model);
    this->Count += 1.0;
  }
  void Print() const
  {
    std::printf("constexpr double %s = %.2g;%s%s\n", this->Name.c_str(),
      std::exp(this->SumOfLogarithms / this->Count), this->Comment.empty() ? "" : " // ",
      this->Comment.c_str());
  }

private:
  std::string Name, Comment;
  double SumOfLogarithms = 0.0;
  double Count = 0.0;
};

/// A line through points.
struct Regression
{
  double N = 0.0, X = 0.0, Y = 0.0, XX = 0.0, XY = 0.0;

  void Add(double x, double y)
  {
    this->N += 1.0;
    this->X += x;
    this->Y += y;
    this->XX += x * x;
    this->XY += x * y;
  }
  double Slope() const
  {
    return (this->N * this->XY - this->X * this->Y) / (this->N * this->XX - this->X * this->X);
  }
  double Intercept() const { return (this->Y - this->Slope() * this->X) / this->N; }
};

struct Table
{
  Line Factor{ "Factor", "x s^1.35" };
  Line Substitution{ "Substitution", "x s^1.4" };
  Line LocalSubstitution{ "LocalSubstitution", "x c^0.2 s: in short steps the factor is sparser" };
  Line SingleIteration{ "SingleIteration", "x s^1.1" };
  Line DoubleIteration{ "DoubleIteration", "x s^1.1" };
  Line Iterations{ "Iterations", "x digits c^0.4 s^0.1" };
  Line IterationsAcross{ "IterationsAcross",
    "x digits sqrt(n), at most: across the whole surface" };
  Line Hierarchy{ "Hierarchy", "x s" };
  Line Cycle{ "Cycle", "x s^1.2" };
  Regression Cycles;
  Line SubstitutionColumn{ "SubstitutionColumn", "" };
  Line SingleIterationColumn{ "SingleIterationColumn", "" };
  Line DoubleIterationColumn{ "DoubleIterationColumn", "" };
  Line CycleColumn{ "CycleColumn", "" };

  void MeasureDirect(const HeatSystem& system, double s, double c)
  {
    const Cost direct = Measure(system, SolverMethod::Direct);
    this->Factor.Add(direct.SetUp, std::pow(s, 1.35));
    if (c >= 100.0)
    {
      this->Substitution.Add(direct.Solve, std::pow(s, 1.4));
    }
    else
    {
      this->LocalSubstitution.Add(direct.Solve, std::pow(c, 0.2) * s);
    }
  }

  void MeasureConjugateGradients(const HeatSystem& system, double s, double c)
  {
    const Cost cost = Measure(system, SolverMethod::ConjugateGradient);
    if (c <= 100.0)
    {
      this->SingleIteration.Add(cost.PerIteration(), std::pow(s, 1.1));
      this->Iterations.Add(cost.Iterations, std::pow(c, 0.4) * std::pow(s, 0.1));
      return;
    }
    this->DoubleIteration.Add(cost.PerIteration(), std::pow(s, 1.1));
    this->IterationsAcross.Add(cost.Iterations, std::sqrt(s * Size));
  }

  void MeasureMultigrid(const HeatSystem& system, double s, double c)
  {
    const Cost cost = Measure(system, SolverMethod::Multigrid);
    this->Hierarchy.Add(cost.SetUp, s);
    this->Cycle.Add(cost.PerIteration(), std::pow(s, 1.2));
    this->Cycles.Add(std::log10(c), cost.Iterations);
  }

  /// The share of a further column: (t(columns) / t(1) - 1) / (columns - 1).
  static void AddColumns(Line& to, const HeatSystem& system, SolverMethod method)
  {
    const Cost one = Measure(system, method);
    const Cost many = Measure(system, method, Columns);
    const double ratio = method == SolverMethod::Direct ? many.Solve / one.Solve
                                                        : many.PerIteration() / one.PerIteration();
    to.Add(std::max(ratio - 1.0, 1e-3), Columns - 1.0);
  }

  void Print() const
  {
    std::printf("constexpr double Size = %.1f;\n\n", Size);
    for (const Line* line : { &this->Factor, &this->Substitution, &this->LocalSubstitution })
    {
      line->Print();
    }
    std::printf("\n// Of conjugate gradients with Jacobi\n");
    for (const Line* line : { &this->SingleIteration, &this->DoubleIteration, &this->Iterations,
           &this->IterationsAcross })
    {
      line->Print();
    }
    std::printf("\n// Of multigrid\n");
    this->Hierarchy.Print();
    this->Cycle.Print();
    std::printf(
      "constexpr double Cycles = %.2g; // x digits, at c = 1\n", this->Cycles.Intercept());
    std::printf(
      "constexpr double CyclesPerDecade = %.2g; // x digits log10(c)\n", this->Cycles.Slope());
    std::printf(
      "\n// What a further column costs of the first one, of %d: those of a panel share a "
      "pass over the matrix\n// or the factor, but for iterations in single precision.\n",
      Columns);
    for (const Line* line : { &this->SubstitutionColumn, &this->SingleIterationColumn,
           &this->DoubleIterationColumn, &this->CycleColumn })
    {
      line->Print();
    }
  }
};

} // namespace

int main(int argc, char** argv)
{
  const int last = argc > 1 ? std::atoi(argv[1]) : 2;
  Table table;
  for (int level = 0; level <= last; ++level)
  {
    HeatSystem system(SurfaceOfLevel(level));
    const double s = system.Mesh->NumberOfVertices() / Size;
    for (const double c : { 0.1, 1.0, 10.0, 100.0, 1e4 })
    {
      system.SetDiffusionNumber(c);
      table.MeasureDirect(system, s, c);
      table.MeasureConjugateGradients(system, s, c);
      if (c >= 1.0)
      {
        table.MeasureMultigrid(system, s, c);
      }
    }
  }
  HeatSystem system(SurfaceOfLevel(std::min(last, 1)), 1.0);
  Table::AddColumns(table.SingleIterationColumn, system, SolverMethod::ConjugateGradient);
  system.SetDiffusionNumber(1e4);
  Table::AddColumns(table.SubstitutionColumn, system, SolverMethod::Direct);
  Table::AddColumns(table.DoubleIterationColumn, system, SolverMethod::ConjugateGradient);
  Table::AddColumns(table.CycleColumn, system, SolverMethod::Multigrid);
  std::printf(
    "// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors\n"
    "// SPDX-License-Identifier: BSD-3-Clause\n"
    "#pragma once\n\n"
    "/// Written by Testing/Benchmarks/CalibrateSolvers: seconds on one core, of which only the "
    "ratios\n/// matter. s: the number of vertices over Size; c: the diffusion number; digits: the "
    "decimal digits\n/// of the tolerance over 10.\n"
    "namespace SurfaceDiffusion::SolverCosts\n{\n\n");
  table.Print();
  std::printf("\n} // namespace SurfaceDiffusion::SolverCosts\n");
  return 0;
}
