// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/ResidualSquares.h"
#include "Core/Solvers/SolverChoice.h"
#include "Meshes.h"
#include "NeedleMeshes.h"
#include "ThreadedFor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <ostream>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// M + dt K, dt in the mesh's own units.
SparseMatrix HeatMatrix(const Assembler& assembler, double timeStep)
{
  SparseMatrix matrix = ZeroMatrix(assembler.Pattern());
  assembler.Fill(matrix, assembler.Mesh().ControlAreas(), timeStep, CotanWeights(assembler.Mesh()));
  return matrix;
}

/// The largest over the columns, as SolveReport::Residual.
double ResidualOf(const SparseMatrix& matrix, const Values& b, const Values& x)
{
  const Vector scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Values left = scale.asDiagonal() * (b - matrix * x);
  const Values whole = scale.asDiagonal() * b;
  return (left.colwise().norm().array() / whole.colwise().norm().array()).maxCoeff();
}

struct Reported
{
  double Residual; ///< of the report
  double TrueResidual;
};

/// A solve of conjugate gradients from zero.
Reported SolveFromZero(const SparseMatrix& matrix, const Values& b, double tolerance)
{
  const std::unique_ptr<LinearSolver> solver = MakeConjugateGradientSolver();
  solver->SetLimits({ tolerance, 5000 });
  solver->SetMatrix(matrix);
  Values x = Values::Zero(b.rows(), b.cols());
  const SolveReport report = solver->Solve(b, x);
  return { report.Residual, ResidualOf(matrix, b, x) };
}

SolverTask ManySolves()
{
  SolverTask task;
  task.NumberOfVertices = 1000;
  task.NumberOfSolves = 1000;
  return task;
}

SolverTask OneShortStep()
{
  SolverTask task;
  task.NumberOfVertices = 100000;
  task.DiffusionNumber = 0.1;
  return task;
}

struct Kind
{
  const char* Name;
  std::function<std::unique_ptr<LinearSolver>()> Make;
};

void PrintTo(const Kind& kind, std::ostream* out)
{
  *out << kind.Name;
}

class AnySolver : public ::testing::TestWithParam<Kind>
{
protected:
  std::unique_ptr<LinearSolver> Solver = GetParam().Make();
};

} // namespace

TEST_P(AnySolver, SolvesAllColumnsToTheTolerance)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  for (const double timeStep : { 1e-6, 1e-2, 1.0 })
  {
    const SparseMatrix matrix = HeatMatrix(*assembler, timeStep);
    this->Solver->SetMatrix(matrix);
    for (const Eigen::Index columns : { 1, 2, 3, 5 })
    {
      const Values exact = Noise(assembler->Mesh(), columns);
      const Values b = matrix * exact;
      Values x = Values::Zero(exact.rows(), columns);
      const SolveReport report = this->Solver->Solve(b, x);
      EXPECT_TRUE(report.Converged);
      EXPECT_LE(report.Residual, this->Solver->GetLimits().Tolerance);
      EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-8);
      const double residual = (b - matrix * x).norm() / b.norm();
      EXPECT_LT(residual, 1e-9); // what it reports is true
    }
  }
}

TEST_P(AnySolver, TakesEmptySystems)
{
  const SparseMatrix none(0, 0);
  this->Solver->SetMatrix(none);
  Values x(0, 1);
  EXPECT_TRUE(this->Solver->Solve(Values(0, 1), x).Converged);
  this->Solver->Precondition(Values(0, 1), x);
  EXPECT_EQ(x.rows(), 0);
}

TEST_P(AnySolver, TakesNoColumns)
{
  const auto assembler = MakeAssembler(Icosphere(1));
  const SparseMatrix matrix = HeatMatrix(*assembler, 1.0);
  this->Solver->SetMatrix(matrix);
  Values x(matrix.rows(), 0);
  EXPECT_TRUE(this->Solver->Solve(Values(matrix.rows(), 0), x).Converged);
  EXPECT_EQ(x.rows(), matrix.rows());
  this->Solver->Precondition(Values(matrix.rows(), 0), x);
  EXPECT_EQ(x.size(), 0);
}

TEST_P(AnySolver, TakesAZeroRightHandSide)
{
  const auto assembler = MakeAssembler(Icosphere(1));
  const SparseMatrix matrix = HeatMatrix(*assembler, 1.0);
  this->Solver->SetMatrix(matrix);
  Values x = Noise(assembler->Mesh());
  EXPECT_TRUE(this->Solver->Solve(Values::Zero(matrix.rows(), 1), x).Converged);
  EXPECT_LT(x.cwiseAbs().maxCoeff(), 1e-8);
}

TEST_P(AnySolver, SizeOfTheRightHandSideDoesNotMatter)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const SparseMatrix matrix = HeatMatrix(*assembler, 0.1);
  this->Solver->SetMatrix(matrix);
  const Values b = matrix * Noise(assembler->Mesh(), 2);
  Values x = Values::Zero(b.rows(), 2);
  this->Solver->Solve(b, x);
  for (const int exponent : { -900, -600, 600, 900 }) // their squares no double holds
  {
    Values scaled = Values::Zero(b.rows(), 2);
    const SolveReport report = this->Solver->Solve(std::ldexp(1.0, exponent) * b, scaled);
    EXPECT_TRUE(report.Converged);
    EXPECT_TRUE(std::ldexp(1.0, -exponent) * scaled == x) << exponent;
  }
}

TEST_P(AnySolver, TakesANewMatrixOfTheSameOrAnotherPattern)
{
  for (const Surface& s : { Icosphere(2), Torus(12, 8) })
  {
    const auto assembler = MakeAssembler(s);
    for (const double timeStep : { 0.1, 0.1, 0.3 })
    {
      const SparseMatrix matrix = HeatMatrix(*assembler, timeStep);
      this->Solver->SetMatrix(matrix);
      const Values exact = Noise(assembler->Mesh());
      Values x = Values::Zero(exact.rows(), 1);
      this->Solver->Solve(matrix * exact, x);
      EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-8);
    }
  }
}

TEST_P(AnySolver, DoesNotPassOffAnIndefiniteMatrixAsSolved)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  SparseMatrix matrix = ZeroMatrix(assembler->Pattern());
  assembler->Fill(
    matrix, -0.5 * assembler->Mesh().ControlAreas(), 1.0, CotanWeights(assembler->Mesh()));
  bool solved = false;
  try
  {
    this->Solver->SetMatrix(matrix);
    Values x = Values::Zero(matrix.rows(), 1);
    solved = this->Solver->Solve(matrix.diagonal(), x).Converged;
  }
  catch (const std::runtime_error& error)
  {
    EXPECT_NE(std::string(error.what()).find("not positive definite"), std::string::npos);
  }
  EXPECT_FALSE(solved);
}

TEST_P(AnySolver, RefusesWhatIsNotFinite)
{
  const auto assembler = MakeAssembler(Icosphere(1));
  const SparseMatrix matrix = HeatMatrix(*assembler, 1.0);
  this->Solver->SetMatrix(matrix);
  Values b = Values::Ones(matrix.rows(), 2);
  b(3, 1) = std::nan("");
  Values x = Values::Zero(matrix.rows(), 2);
  EXPECT_THROW(this->Solver->Solve(b, x), std::runtime_error);
}

TEST_P(AnySolver, IsAsNewAfterASolveThatFailed)
{
  const auto assembler = MakeAssembler(Icosphere(4)); // several levels of multigrid
  const SparseMatrix matrix = HeatMatrix(*assembler, 0.01);
  for (const Eigen::Index columns : { 1, 2, 5 })
  {
    const Values b = matrix * Noise(assembler->Mesh(), columns);
    const auto solve = [&](LinearSolver& solver)
    {
      solver.SetMatrix(matrix);
      Values x = Values::Zero(b.rows(), columns);
      EXPECT_TRUE(solver.Solve(b, x).Converged);
      return x;
    };
    const Values expected = solve(*GetParam().Make());
    for (const double wrong :
      { std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity() })
    {
      this->Solver->SetMatrix(matrix);
      Values bad = b;
      bad(7, columns - 1) = wrong;
      Values x = Values::Zero(b.rows(), columns);
      EXPECT_THROW(this->Solver->Solve(bad, x), std::runtime_error);
      EXPECT_TRUE(solve(*this->Solver) == expected) << columns << " columns, " << wrong;
    }
  }
}

TEST_P(AnySolver, StopsWhenAskedAndWorksAfterwards)
{
  const auto assembler = MakeAssembler(Icosphere(5)); // large enough to factorise in background
  const SparseMatrix matrix = HeatMatrix(*assembler, 1.0);
  const Values exact = Noise(assembler->Mesh());
  const Values b = matrix * exact;
  Values x = Values::Zero(exact.rows(), 1);
  const ProgressMonitor::Callback stop = [](double) { return false; };
  EXPECT_THROW(
    {
      this->Solver->SetMatrix(matrix, ProgressMonitor(stop));
      this->Solver->Solve(b, x, ProgressMonitor(stop));
    },
    Aborted);
  this->Solver->SetMatrix(matrix);
  this->Solver->Solve(b, x);
  EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-8);
}

TEST_P(AnySolver, ReportsProgressUpwards)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const SparseMatrix matrix = HeatMatrix(*assembler, 1.0);
  double last = 0.0;
  bool upwards = true;
  const ProgressMonitor::Callback watch = [&](double fraction)
  {
    upwards = upwards && fraction >= last;
    last = fraction;
    return true;
  };
  this->Solver->SetMatrix(matrix, ProgressMonitor(watch).Part(0.0, 0.5));
  Values x = Values::Zero(matrix.rows(), 1);
  this->Solver->Solve(matrix * Noise(assembler->Mesh()), x, ProgressMonitor(watch).Part(0.5, 1.0));
  EXPECT_TRUE(upwards);
  EXPECT_EQ(last, 1.0);
}

INSTANTIATE_TEST_SUITE_P(LinearSolver, AnySolver,
  ::testing::Values(Kind{ "Cholesky", [] { return MakeCholeskySolver(); } },
    Kind{ "ConjugateGradient", [] { return MakeConjugateGradientSolver(); } },
    Kind{ "Multigrid", [] { return MakeMultigridSolver(); } },
    Kind{ "AutomaticDirect", [] { return MakeSolver(SolverMethod::Automatic, ManySolves()); } },
    Kind{
      "AutomaticIterative", [] { return MakeSolver(SolverMethod::Automatic, OneShortStep()); } }),
  [](const auto& parameter) { return parameter.param.Name; });

// Entries of the factor below round-off are dropped, many of them if steps are short.
/// Few columns, panels of sixteen and others have loops of their own.
TEST(ResidualSquares, AreWeightedSumsForAnyNumberOfColumns)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const TriangleMesh& mesh = assembler->Mesh();
  ASSERT_GT(mesh.NumberOfVertices(), BlockSize);
  const SparseMatrix matrix = HeatMatrix(*assembler, 0.01);
  const Vector weights = Noise(mesh, 1, 3).array().abs();
  for (const int columns : { 1, 2, 3, 4, 5, 8, 11, 16, 17, 40 })
  {
    const Values b = Noise(mesh, columns, 1);
    const Values x = Noise(mesh, columns, 2);
    std::vector<double> squares;
    ResidualSquares(matrix, b, x, weights, squares, SerialFor());
    const Values r = b - matrix * x;
    for (int k = 0; k < columns; ++k)
    {
      const double ofR = weights.dot(r.col(k).cwiseAbs2());
      const double ofB = weights.dot(b.col(k).cwiseAbs2());
      EXPECT_NEAR(squares[2 * k], ofR, 1e-12 * ofR) << k << " of " << columns;
      EXPECT_NEAR(squares[2 * k + 1], ofB, 1e-12 * ofB) << k << " of " << columns;
    }
  }
}

TEST(Cholesky, IsExactToRoundOffAtSmallAndLargeSteps)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const double h = assembler->Mesh().TotalEdgeLength() / assembler->Mesh().NumberOfEdges();
  for (const double number : { 1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6 })
  {
    const SparseMatrix matrix = HeatMatrix(*assembler, number * h * h);
    const Values exact = Noise(assembler->Mesh(), 1);
    Values b = exact;
    Multiply(matrix, exact, b);
    Values x = Values::Zero(b.rows(), 1);
    const auto solver = MakeCholeskySolver();
    solver->SetMatrix(matrix);
    EXPECT_LT(solver->Solve(b, x).Residual, 2e-15) << number;
    EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-13 * (1.0 + number)) << number;
  }
}

TEST(ConjugateGradient, ReportsThatItDidNotConverge)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const SparseMatrix matrix = HeatMatrix(*assembler, 10.0);
  const auto solver = MakeConjugateGradientSolver();
  solver->SetLimits({ 1e-10, 5 });
  solver->SetMatrix(matrix);
  Values x = Values::Zero(matrix.rows(), 1);
  const SolveReport report = solver->Solve(matrix * Noise(assembler->Mesh()), x);
  EXPECT_FALSE(report.Converged);
  EXPECT_EQ(report.Iterations, 5);
  EXPECT_GT(report.Residual, 1e-10);
}

class IterativeSolver : public AnySolver
{
};

INSTANTIATE_TEST_SUITE_P(LinearSolver, IterativeSolver,
  ::testing::Values(Kind{ "ConjugateGradient", [] { return MakeConjugateGradientSolver(); } },
    Kind{ "Multigrid", [] { return MakeMultigridSolver(); } }),
  [](const auto& parameter) { return parameter.param.Name; });

/// The residual of the last iterations is known by their recurrence alone where round-off cannot
/// have moved it.
TEST(ConjugateGradient, ReportsNoLessThanTheTrueResidual)
{
  const Surface blown = Joined(Icosphere(3), Moved(Scaled(Icosphere(3), 1e-3), { 5.0, 0.0, 0.0 }));
  const std::vector<Surface> surfaces = { Icosphere(4), LatitudeLongitudeSphere(60, 40), blown,
    CylinderWithFans(40, 20), Jittered(Plate(24, 1.0), 0.03, -0.9, 0.9, -0.9, 0.9) };
  for (std::size_t s = 0; s < surfaces.size(); ++s)
  {
    const auto assembler = MakeAssembler(surfaces[s]);
    const double h = MeanEdge(assembler->Mesh());
    const auto n = static_cast<Eigen::Index>(assembler->Mesh().NumberOfVertices());
    for (const bool isHeld : { false, true })
    {
      for (const double diffusionNumber : { 0.1, 1.0, 10.0, 100.0 })
      {
        SparseMatrix matrix = HeatMatrix(*assembler, diffusionNumber * h * h);
        if (isHeld)
        {
          Values load(n, 1);
          assembler->Constrain(
            matrix, Noise(assembler->Mesh(), 1, 3).col(0).array() > 0.5, Values::Zero(n, 1), load);
        }
        for (const double tolerance : { 1e-2, 1e-4, 1e-7, 1e-10 })
        {
          const std::unique_ptr<LinearSolver> solver = MakeConjugateGradientSolver();
          solver->SetLimits({ tolerance, 1000 });
          solver->SetMatrix(matrix);
          const Values b = Noise(assembler->Mesh(), 2);
          Values x = 0.5 * b; // the second solve starts near its solution
          for (const double factor : { 1.0, 1.001 })
          {
            const SolveReport report = solver->Solve(factor * b, x);
            EXPECT_LE(report.Residual, 2.1 * tolerance); // of iterations in double precision
            EXPECT_LE(ResidualOf(matrix, factor * b, x) - 1.0001 * report.Residual, 1e-14)
              << s << " " << isHeld << " " << diffusionNumber << " " << tolerance;
          }
        }
      }
    }
  }
}

/// Signs of line fields turn entries around, so that rows have large sums and the smallest
/// eigenvalue is as small as without them.
TEST(ConjugateGradient, ReportsNoLessThanTheTrueResidualWithSigns)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const TriangleMesh& mesh = assembler->Mesh();
  const double h = MeanEdge(mesh);
  CornerWeights signs(mesh.NumberOfTriangles(), 3);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto v = mesh.TriangleVertices().row(t);
    for (int a = 0; a < 3; ++a)
    {
      signs(t, a) = (v[(a + 1) % 3] + v[(a + 2) % 3]) % 2 == 0 ? 1.0 : -1.0;
    }
  }
  for (const double diffusionNumber : { 1.0, 100.0, 1e5, 1e6 })
  {
    SparseMatrix matrix = ZeroMatrix(assembler->Pattern());
    assembler->Fill(matrix, mesh.ControlAreas(), diffusionNumber * h * h, CotanWeights(mesh),
      nullptr, SerialFor(), &signs);
    for (const double tolerance : { 1e-2, 1e-4 })
    {
      const Reported found = SolveFromZero(matrix, Noise(mesh), tolerance);
      EXPECT_LE(found.Residual, 2.1 * tolerance);
      EXPECT_LE(found.TrueResidual, 1.0001 * found.Residual) << diffusionNumber;
    }
  }
}

/// Where the obtuse corners of flat rhombi are held, the sums of the rows are large, and the
/// smallest eigenvalue is small.
TEST(ConjugateGradient, ReportsNoLessThanTheTrueResidualAtHeldObtuseCorners)
{
  constexpr Index count = 500;
  for (const double height : { 0.1, 0.01, 0.001 })
  {
    Surface rhombi;
    rhombi.Vertices.resize(4 * count, 3);
    rhombi.Faces.resize(2 * count, 3);
    for (Index r = 0; r < count; ++r)
    {
      const double x = 3.0 * r;
      rhombi.Vertices.middleRows(4 * r, 4) << x - 1.0, 0.0, 0.0, x + 1.0, 0.0, 0.0, x, height, 0.0,
        x, -height, 0.0;
      rhombi.Faces.middleRows(2 * r, 2) << 4 * r, 4 * r + 1, 4 * r + 2, 4 * r + 1, 4 * r, 4 * r + 3;
    }
    const auto assembler = MakeAssembler(rhombi);
    const TriangleMesh& mesh = assembler->Mesh();
    Flags held(mesh.NumberOfVertices());
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      held[i] = mesh.InputVertex()[i] % 4 >= 2;
    }
    SparseMatrix matrix = HeatMatrix(*assembler, 1.0);
    Values load(mesh.NumberOfVertices(), 1);
    assembler->Constrain(matrix, held, Values::Zero(mesh.NumberOfVertices(), 1), load);
    for (const double tolerance : { 1e-2, 1e-3, 1e-4 })
    {
      const Reported found = SolveFromZero(matrix, Noise(mesh), tolerance);
      EXPECT_LE(found.TrueResidual, 1.0001 * found.Residual) << height << " " << tolerance;
    }
  }
}

/// A long step leaves the first column to double precision, while single precision is enough for
/// the second one.
TEST(ConjugateGradient, SolvesAColumnFarFromItsSolutionBesideANearOne)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const double h = MeanEdge(assembler->Mesh());
  for (const double diffusionNumber : { 100.0, 400.0, 700.0, 1500.0 })
  {
    const SparseMatrix matrix = HeatMatrix(*assembler, diffusionNumber * h * h);
    const Values exact = Noise(assembler->Mesh(), 2);
    const Values b = matrix * exact;
    for (const double distance : { 2.0, 5.0, 30.0 })
    {
      constexpr double tolerance = 1e-7;
      Values x = Values::Zero(b.rows(), 2);
      x.col(1) = exact.col(1) + distance * tolerance * Noise(assembler->Mesh(), 1, 3);
      const std::unique_ptr<LinearSolver> solver = MakeConjugateGradientSolver();
      solver->SetLimits({ tolerance, 5000 });
      solver->SetMatrix(matrix);
      const SolveReport report = solver->Solve(b, x);
      EXPECT_TRUE(report.Converged);
      EXPECT_LE(ResidualOf(matrix, b, x), 2.1 * tolerance) << diffusionNumber << " " << distance;
    }
  }
}

/// Diffusion along a direction only, at a long step, from the second step of a run that a fuzzer
/// found: in single precision the iterates grow beyond all bounds.
TEST(ConjugateGradient, MeetsTheToleranceWhereSinglePrecisionDiverges)
{
  const std::array<double, 9> entries = { 0x1.f17c5ed085f1p+16, -0x1.7f08441056bb4p+16,
    -0x1.ae5bf9ebed12ap+14, -0x1.7f08441056bb4p+16, 0x1.2b094a1e7b67ap+16, 0x1.4ffc127217f96p+14,
    -0x1.ae5bf9ebed12ap+14, 0x1.4ffc127217f96p+14, 0x1.79834df5e8116p+12 };
  const Eigen::Matrix3d dense = Eigen::Map<const Eigen::Matrix3d>(entries.data());
  const SparseMatrix matrix = dense.sparseView();
  Values b(3, 1);
  b << -0x1.b2b3a90d6e929p+9, -0x1.11d1cbbd28432p-6, -0x1.66ac176c4301ap-3;
  Values x(3, 1);
  x << -0x1.fa9d9a5ab1ffdp-2, -0x1.9abab19bbc64bp-2, -0x1.a7fd4fe9b8958p-1;
  const std::unique_ptr<LinearSolver> solver = MakeConjugateGradientSolver();
  solver->SetMatrix(matrix);
  const SolveReport report = solver->Solve(b, x);
  EXPECT_TRUE(report.Converged);
  EXPECT_LE(report.Residual, 1e-10);
  const Eigen::Array3d scale = dense.diagonal().array().rsqrt();
  const Eigen::Vector3d residual = b - dense * x;
  EXPECT_LE((scale * residual.array()).matrix().norm(),
    1.01e-10 * (scale * b.col(0).array()).matrix().norm());
}

TEST_P(AnySolver, GivesEveryColumnTheBitsItHasAlone)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const SparseMatrix matrix = HeatMatrix(*assembler, 0.3);
  const auto& solver = this->Solver;
  solver->SetMatrix(matrix);
  // Up to three, half a panel, a panel, and parts of panels.
  for (const Eigen::Index columns : { 2, 3, 6, 8, 13, 16, 37 })
  {
    // Columns that converge at very different times: zero, smooth, rough.
    Values b = matrix * Noise(assembler->Mesh(), columns);
    b.col(0).setZero();
    b.col(1) = assembler->Mesh().ControlAreas();
    Values x = Values::Zero(b.rows(), columns);
    solver->Solve(b, x);
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      Values alone = Values::Zero(b.rows(), 1);
      solver->Solve(b.col(k), alone);
      EXPECT_EQ(x.col(k), alone.col(0)) << k << " of " << columns;
    }
  }
}

namespace
{

/// What a Dirichlet condition at every third vertex leaves: zeros.
SparseMatrix WithDirichletRows(SparseMatrix matrix)
{
  for (Index i = 0; i < static_cast<Index>(matrix.rows()); ++i)
  {
    for (SparseMatrix::InnerIterator a(matrix, i); a; ++a)
    {
      a.valueRef() = i != a.index() && (i % 3 == 0 || a.index() % 3 == 0) ? 0.0 : a.value();
    }
  }
  return matrix;
}

} // namespace

/// Patterns change, zeros are left out, and pivots are regularised, in turn.
TEST(Cholesky, HasTheBitsOfANewOneAfterAnyOtherMatrixAndAnyAbort)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const SparseMatrix heat = HeatMatrix(*assembler, 1.0);
  const std::vector<SparseMatrix> matrices{ heat, WithDirichletRows(heat),
    HeatMatrix(*assembler, 1e18), HeatMatrix(*MakeAssembler(Icosphere(3)), 1.0), heat };
  const ThreadedFor threads(3);
  const auto solver = MakeCholeskySolver(threads);
  for (const SparseMatrix& matrix : matrices)
  {
    const Values b = Values::Random(matrix.rows(), 2);
    Values expected, found;
    const auto other = MakeCholeskySolver();
    other->SetMatrix(matrix);
    other->Solve(b, expected);
    int allowed = 0;
    for (bool isAborted = true; isAborted; ++allowed)
    {
      int reports = 0;
      const ProgressMonitor::Callback stop = [&](double) { return ++reports <= allowed; };
      try
      {
        solver->SetMatrix(matrix, ProgressMonitor(stop));
        isAborted = false;
      }
      catch (const Aborted&)
      {
      }
    }
    EXPECT_GT(allowed, 3);
    solver->Solve(b, found);
    EXPECT_TRUE(found == expected);
  }
}

TEST(Cholesky, RefinesOnlyTheColumnsThatMissTheTolerance)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const SparseMatrix matrix = HeatMatrix(*assembler, 0.3);
  const auto solver = MakeCholeskySolver();
  solver->SetMatrix(matrix);
  constexpr Eigen::Index columns = 8;
  const Values b = matrix * Noise(assembler->Mesh(), columns);
  Values plain = b;
  std::vector<double> residuals;
  for (Eigen::Index k = 0; k < columns; ++k)
  {
    Values alone = Values::Zero(b.rows(), 1);
    residuals.push_back(solver->Solve(b.col(k), alone).Residual);
    plain.col(k) = alone;
  }
  IterationLimits limits;
  std::vector<double> sorted = residuals;
  std::sort(sorted.begin(), sorted.end());
  limits.Tolerance = sorted[columns / 2];
  solver->SetLimits(limits);
  Values x = Values::Zero(b.rows(), columns);
  solver->Solve(b, x);
  for (Eigen::Index k = 0; k < columns; ++k)
  {
    EXPECT_EQ(x.col(k) != plain.col(k), residuals[static_cast<std::size_t>(k)] > limits.Tolerance);
    Values alone = Values::Zero(b.rows(), 1);
    solver->Solve(b.col(k), alone);
    EXPECT_EQ(x.col(k), alone.col(0)) << k;
  }
}

TEST_P(AnySolver, PreconditionsSymmetricallyAndLinearly)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const SparseMatrix matrix = HeatMatrix(*assembler, 1.0);
  this->Solver->SetMatrix(matrix);
  const Values a = Noise(assembler->Mesh(), 1);
  const Values b = Noise(assembler->Mesh(), 1, 1);
  const auto apply = [&](const Values& r)
  {
    Values z = Values::Constant(r.rows(), r.cols(), 1e3); // no start of an iteration
    this->Solver->Precondition(r, z);
    return z;
  };
  const Values ofA = apply(a);
  const Values ofB = apply(b);
  constexpr double digits = 1e-5; // of multigrid, which is in single precision
  const double size = std::sqrt(a.cwiseProduct(ofA).sum() * b.cwiseProduct(ofB).sum());
  EXPECT_NEAR(a.cwiseProduct(ofB).sum(), b.cwiseProduct(ofA).sum(), digits * size);
  EXPECT_LT((apply(a - 3.0 * b) - (ofA - 3.0 * ofB)).norm(), digits * ofA.norm());
}

TEST_P(IterativeSolver, TakesNoIterationFromTheSolution)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const SparseMatrix matrix = HeatMatrix(*assembler, 0.3);
  this->Solver->SetMatrix(matrix);
  Values x = Noise(assembler->Mesh());
  const Values b = matrix * x;
  EXPECT_EQ(this->Solver->Solve(b, x).Iterations, 0);
}

TEST(Automatic, FactorisesWhereConjugateGradientsDoNotConverge)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const SparseMatrix matrix = HeatMatrix(*assembler, 100.0);
  const auto solver = MakeSolver(SolverMethod::Automatic, OneShortStep()); // the step is long
  solver->SetLimits({ 1e-10, 10 });
  solver->SetMatrix(matrix);
  const Values exact = Noise(assembler->Mesh());
  Values x = Values::Zero(exact.rows(), 1);
  const SolveReport report = solver->Solve(matrix * exact, x);
  EXPECT_TRUE(report.Converged);
  EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-8);
}

/// The method for a matrix with as many iterations of conjugate gradients as expected.
static SolverMethod MethodOf(const SolverTask& task)
{
  const SolverChoice choice = ChooseSolver(SolverMethod::Automatic, task);
  const bool isSlow = choice.Patience > 0 && choice.ExpectedIterations > choice.Patience;
  return isSlow ? choice.Next : choice.Method;
}

TEST(Automatic, ChoosesWhatTheMeasurementsFoundFaster)
{
  const auto choice =
    [](Index vertices, double diffusionNumber, double solves, double tolerance = 1e-10)
  {
    SolverTask task;
    task.NumberOfVertices = vertices;
    task.DiffusionNumber = diffusionNumber;
    task.NumberOfSolves = solves;
    task.Tolerance = tolerance;
    return MethodOf(task);
  };
  EXPECT_EQ(choice(3000, 0.1, 1), SolverMethod::Direct);
  EXPECT_EQ(choice(3000, 0.1, 1, 1e-3), SolverMethod::ConjugateGradient);
  EXPECT_EQ(choice(44000, 0.1, 1), SolverMethod::ConjugateGradient);
  EXPECT_EQ(choice(44000, 100.0, 1), SolverMethod::Multigrid);
  EXPECT_EQ(choice(44000, 1.0, 10), SolverMethod::ConjugateGradient);
  EXPECT_EQ(choice(44000, 1.0, 40), SolverMethod::Direct);
  EXPECT_EQ(choice(44000, 1.0, 10, 1e-3), SolverMethod::ConjugateGradient);
  EXPECT_EQ(choice(178000, 100.0, 20), SolverMethod::Direct);
  EXPECT_EQ(choice(178000, 1e4, 1), SolverMethod::Multigrid);
  EXPECT_EQ(choice(711000, 0.1, 10), SolverMethod::ConjugateGradient);
  EXPECT_EQ(choice(711000, 1e4, 3), SolverMethod::Multigrid);
  EXPECT_EQ(choice(711000, 1e4, 10), SolverMethod::Direct);
  EXPECT_EQ(choice(711000, 1.0, 100), SolverMethod::Direct);
  EXPECT_EQ(choice(178000, 0.1, 10), SolverMethod::ConjugateGradient);
  EXPECT_EQ(choice(178000, 0.1, 100), SolverMethod::Direct);
  EXPECT_EQ(choice(178000, 1.0, 100), SolverMethod::Direct);
  EXPECT_EQ(choice(1000000, 0.1, 200), SolverMethod::ConjugateGradient);
}

// The matrix decides between conjugate gradients and the method for as many iterations as expected.
TEST(Automatic, BeginsWithConjugateGradientsWhereEvenMeshesAreSolvedFaster)
{
  SolverTask task;
  task.NumberOfVertices = 90000;
  task.NumberOfSolves = 30.0;
  const SolverChoice choice = ChooseSolver(SolverMethod::Automatic, task);
  EXPECT_EQ(choice.Method, SolverMethod::ConjugateGradient);
  EXPECT_EQ(choice.Next, SolverMethod::Direct);
  EXPECT_LT(choice.Patience, choice.ExpectedIterations);
  EXPECT_GT(choice.Patience, 0.5 * choice.ExpectedIterations);
  task.DiffusionNumber.reset(); // nothing to forecast from
  EXPECT_NE(ChooseSolver(SolverMethod::Automatic, task).Method, SolverMethod::ConjugateGradient);
}

TEST(Automatic, FactorisesForManyColumnsWhoseSubstitutionsShareTheFactor)
{
  SolverTask task;
  task.NumberOfVertices = 41000;
  task.DiffusionNumber = 1.0;
  task.NumberOfSolves = 3.0;
  EXPECT_EQ(ChooseSolver(SolverMethod::Automatic, task).Method, SolverMethod::ConjugateGradient);
  task.NumberOfColumns = 50;
  EXPECT_EQ(ChooseSolver(SolverMethod::Automatic, task).Method, SolverMethod::Direct);
}

TEST(Automatic, TriesConjugateGradientsIfAFactorisationFails)
{
  // Indefinite by one entry that the solution hardly has: no pivot is positive enough for a
  // factorisation, and Automatic goes on.
  const auto assembler = MakeAssembler(Icosphere(2));
  SparseMatrix matrix = HeatMatrix(*assembler, 1.0);
  matrix.coeffRef(3, 3) = -1.0;
  const auto direct = MakeSolver(SolverChoice{ SolverMethod::Direct, false });
  EXPECT_THROW(direct->SetMatrix(matrix), std::runtime_error);
  const auto solver = MakeSolver(SolverChoice{ SolverMethod::Direct, true });
  EXPECT_NO_THROW(solver->SetMatrix(matrix));
}

TEST(Automatic, ChoosesMultigridOnlyWhereAllowed)
{
  SolverTask task;
  task.NumberOfVertices = 711000;
  task.DiffusionNumber = 1e4;
  EXPECT_EQ(ChooseSolver(SolverMethod::Automatic, task).Method, SolverMethod::Multigrid);
  task.AllowMultigrid = false;
  EXPECT_NE(ChooseSolver(SolverMethod::Automatic, task).Method, SolverMethod::Multigrid);
}

TEST(Automatic, KnowsThatAnisotropyCostsCycles)
{
  SolverTask task;
  task.NumberOfVertices = 262000;
  task.DiffusionNumber = 100.0;
  EXPECT_EQ(MethodOf(task), SolverMethod::Multigrid);
  task.Anisotropy = 100.0;
  EXPECT_EQ(MethodOf(task), SolverMethod::ConjugateGradient);
}

TEST(Automatic, TakesASteadyStateForALongStep)
{
  SolverTask task;
  task.NumberOfVertices = 711000;
  task.DiffusionNumber.reset();
  EXPECT_EQ(ChooseSolver(SolverMethod::Automatic, task).Method, SolverMethod::Multigrid);
}

/// Each process would have to factorise the whole matrix.
TEST(Automatic, FactorisesOverProcessesOnlyIfNothingElseConverges)
{
  for (const Index vertices : { 0, 100, 44000, 711000 })
  {
    for (const double diffusionNumber : { 0.1, 1.0, 1e4 })
    {
      SolverTask task;
      task.NumberOfVertices = vertices;
      task.DiffusionNumber = diffusionNumber;
      task.NumberOfSolves = 1000.0;
      EXPECT_EQ(MethodOf(task), SolverMethod::Direct);
      task.IsDistributed = true;
      const SolverChoice choice = ChooseSolver(SolverMethod::Automatic, task);
      EXPECT_NE(choice.Method, SolverMethod::Direct);
      EXPECT_TRUE(choice.FallsBack);
      EXPECT_GE(choice.Patience, 0);
      EXPECT_TRUE(
        choice.Method == SolverMethod::Multigrid || choice.Next == SolverMethod::Multigrid);
      task.AllowMultigrid = false;
      EXPECT_EQ(
        ChooseSolver(SolverMethod::Automatic, task).Method, SolverMethod::ConjugateGradient);
    }
  }
}

namespace
{

/// Of several processes of which the others have no vertices.
class OneOfMany : public Reduction
{
public:
  explicit OneOfMany(Eigen::Index vertices)
    : Reduction(Reduction::Kind::Distributed)
  {
    this->OwnedVertices.assign(static_cast<std::size_t>(vertices), true);
  }
};

} // namespace

TEST(Automatic, IteratesToTheEndOverProcessesThatHaveNoRoomForAFactor)
{
  const auto assembler = MakeAssembler(Strip(450, 450));
  const double h = assembler->Mesh().MeanEdgeLength();
  const SparseMatrix matrix = HeatMatrix(*assembler, 100.0 * h * h); // worse than the task says
  SolverTask task;
  task.NumberOfVertices = static_cast<Index>(matrix.rows());
  ASSERT_GT(task.NumberOfVertices, LargestReplicated);
  task.NumberOfSolves = 1000.0;
  task.AllowMultigrid = false;
  task.IsDistributed = true;
  const SolverChoice choice = ChooseSolver(SolverMethod::Automatic, task);
  const auto solver =
    MakeSolver(choice, SerialFor(), std::make_shared<const OneOfMany>(matrix.rows()));
  solver->SetMatrix(matrix);
  const Values exact = Noise(assembler->Mesh(), 1);
  const Values b = matrix * exact;
  for (int solve = 0; solve < 2; ++solve)
  {
    Values x = Values::Zero(exact.rows(), 1);
    const SolveReport report = solver->Solve(b, x);
    EXPECT_TRUE(report.Converged);
    EXPECT_GT(report.Iterations, choice.Patience);
    EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(Automatic, FactorisesForAPreconditionerAtAnySize)
{
  SolverTask task;
  task.NumberOfVertices = 3000000;
  task.DiffusionNumber = 0.1;
  task.IsPreconditioner = true;
  const SolverChoice choice = ChooseSolver(SolverMethod::Automatic, task);
  EXPECT_EQ(choice.Method, SolverMethod::Direct);
  EXPECT_FALSE(choice.FallsBack);
  task.IsDistributed = true;
  EXPECT_EQ(ChooseSolver(SolverMethod::Automatic, task).Method, SolverMethod::Multigrid);
}

TEST(SolverChoice, IsTheMethodAskedForUnlessAutomatic)
{
  for (const SolverMethod method :
    { SolverMethod::Direct, SolverMethod::ConjugateGradient, SolverMethod::Multigrid })
  {
    const SolverChoice choice = ChooseSolver(method, ManySolves());
    EXPECT_EQ(choice.Method, method);
    EXPECT_EQ(choice.FallsBack, method == SolverMethod::Multigrid); // it cannot resolve needles
  }
  EXPECT_TRUE(ChooseSolver(SolverMethod::Automatic, OneShortStep()).FallsBack);
  EXPECT_TRUE(ChooseSolver(SolverMethod::Automatic, OneShortStep()) !=
    ChooseSolver(SolverMethod::ConjugateGradient, OneShortStep()));
}
