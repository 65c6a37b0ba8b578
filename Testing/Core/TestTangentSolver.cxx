// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/TangentSolver.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

using namespace SurfaceDiffusion;

namespace
{

/// Two vectors in the plane, coupled with a number `a`, each with 2 on the diagonal.
struct Pair
{
  explicit Pair(double a)
    : Matrix(2, 2)
  {
    Matrix.insert(0, 0) = Matrix.insert(1, 1) = 2.0;
    Matrix.insert(0, 1) = Matrix.insert(1, 0) = a;
    Matrix.makeCompressed();
    U << 1.0, 0.0, 1.0, 0.0;
    B << 3.0, 1.0, 5.0, -1.0;
  }

  SolveReport Solve()
  {
    return TangentSolver().Solve({ Matrix, U, Fixed, B, Inertia }, X, nullptr, { 1e-12, 10 });
  }

  SparseMatrix Matrix;
  Values U{ 2, 2 };
  Values B{ 2, 2 };
  Values X;
  Flags Fixed = Flags::Constant(2, false);
  Vector Inertia = Vector::Ones(2);
};

} // namespace

TEST(TangentSolver, SolvesAlongTheTangents)
{
  Pair pair(-1.0); // 2 x - y = 1, 2 y - x = -1 in the second component
  EXPECT_TRUE(pair.Solve().Converged);
  EXPECT_TRUE(pair.X.col(0).isZero(0.0));
  EXPECT_NEAR(pair.X(0, 1), 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(pair.X(1, 1), -1.0 / 3.0, 1e-12);
}

TEST(TangentSolver, StopsWhereTheMatrixIsNotPositive)
{
  Pair pair(3.0); // (1, -1) has the eigenvalue -1
  const SolveReport report = pair.Solve();
  EXPECT_FALSE(report.Converged);
  EXPECT_TRUE(pair.X.isZero(0.0));
}

TEST(TangentSolver, RefusesWhatIsNotFinite)
{
  Pair pair(-1.0);
  pair.B(0, 1) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(pair.Solve(), std::runtime_error);
}
