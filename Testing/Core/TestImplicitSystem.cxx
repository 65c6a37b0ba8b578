// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/ImplicitSystem.h"
#include "Core/Operators/CotanWeights.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// (M + 0.01 K) u = b for two columns on a sphere, with a few fixed vertices
/// next to each other.
struct Problem
{
  std::shared_ptr<const Assembler> Assembly = MakeAssembler(Icosphere(2));
  const TriangleMesh& Mesh = Assembly->Mesh();
  CornerWeights Coefficients = CotanWeights(Mesh);
  Values Given = Noise(Mesh, 2, 1);
  Values B = Noise(Mesh, 2, 2);
  Flags Fixed = Flags::Constant(Mesh.NumberOfVertices(), false);
  SparseMatrix Matrix = ZeroMatrix(Assembly->Pattern()); ///< without Dirichlet conditions

  Problem()
  {
    this->Fixed.head(7).setConstant(true);
    this->Assembly->Fill(this->Matrix, this->Mesh.ControlAreas(), 0.01, this->Coefficients);
  }

  ImplicitSystem MakeSystem(std::shared_ptr<LinearSolver> solver, const Values& given) const
  {
    ImplicitSystem system(this->Assembly, std::move(solver), SerialFor());
    system.Assemble(this->Mesh.ControlAreas(), 0.01, this->Coefficients);
    system.Constrain(this->Fixed, given);
    system.SetUpSolver(ProgressMonitor());
    return system;
  }

  /// Solve once with Given at the fixed vertices.
  StepReport Solve(std::shared_ptr<LinearSolver> solver, const IterationLimits& limits) const
  {
    solver->SetLimits(limits);
    ImplicitSystem system = this->MakeSystem(std::move(solver), this->Given);
    Values b = this->B;
    Values u = Values::Zero(b.rows(), b.cols());
    StepReport report;
    system.Solve(b, u, report);
    return report;
  }
};

} // namespace

TEST(ImplicitSystem, SolutionSatisfiesFreeRowsAndDirichletConditions)
{
  const Problem problem;
  for (const auto& solver :
    { std::shared_ptr(MakeCholeskySolver()), std::shared_ptr(MakeConjugateGradientSolver()) })
  {
    ImplicitSystem system = problem.MakeSystem(solver, problem.Given);
    for (int again = 0; again < 2; ++again) // the same matrix serves several right-hand sides
    {
      Values b = (1.0 + again) * problem.B;
      Values u = Values::Zero(b.rows(), b.cols());
      StepReport report;
      system.Solve(b, u, report);
      const Values residual = problem.Matrix * u - (1.0 + again) * problem.B;
      for (Index i = 0; i < problem.Mesh.NumberOfVertices(); ++i)
      {
        if (problem.Fixed[i])
        {
          EXPECT_EQ(u.row(i), problem.Given.row(i));
        }
        else
        {
          EXPECT_LT(residual.row(i).norm(), 1e-9);
        }
      }
    }
  }
}

TEST(ImplicitSystem, ProductIsTheRowWithoutDirichletConditions)
{
  const Problem problem;
  Values u = Noise(problem.Mesh, 1, 3);
  const ImplicitSystem system = problem.MakeSystem(MakeCholeskySolver(), u);
  const Values expected = problem.Matrix * u;
  for (Index i = 7; i < problem.Mesh.NumberOfVertices(); ++i)
  {
    EXPECT_NEAR(system.Product(i, u), expected(i), 1e-14);
  }
}

TEST(ImplicitSystem, ReportsAddUp)
{
  const Problem problem;
  ImplicitSystem system = problem.MakeSystem(MakeConjugateGradientSolver(), problem.Given);
  StepReport once, twice;
  for (StepReport* report : { &once, &twice, &twice })
  {
    Values b = problem.B;
    Values u = Values::Zero(b.rows(), b.cols());
    system.Solve(b, u, *report);
  }
  EXPECT_GT(once.Iterations, 0);
  EXPECT_EQ(twice.Iterations, 2 * once.Iterations);
  EXPECT_EQ(twice.Residual, once.Residual);
}

TEST(ImplicitSystem, TakesAnAnswerWithinTenTimesTheToleranceAndReportsIt)
{
  const Problem problem;
  constexpr double tolerance = 1e-8;
  double missed = 0.0;
  for (int iterations = 1; missed == 0.0 && iterations < 500; ++iterations)
  {
    try
    {
      missed =
        problem.Solve(MakeConjugateGradientSolver(), { tolerance, iterations }).MissedResidual;
    }
    catch (const NotConverged&)
    {
      continue;
    }
    ASSERT_GT(missed, 0.0) << "it converged before an answer was taken";
  }
  EXPECT_GT(missed, tolerance);
  EXPECT_LE(missed, 10.0 * tolerance);
}

TEST(ImplicitSystem, ADirectAnswerAboveTheToleranceIsReportedAndTaken)
{
  const StepReport report = Problem().Solve(MakeCholeskySolver(), { 1e-30, 1 });
  EXPECT_GT(report.MissedResidual, 0.0);
  EXPECT_LT(report.MissedResidual, 1e-13);
}

TEST(ImplicitSystem, ThrowsIfTheSolverDoesNotConverge)
{
  EXPECT_THROW(Problem().Solve(MakeConjugateGradientSolver(), { 1e-12, 1 }), NotConverged);
}
