// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/QuadraticDescent.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// A system M + K with k columns, and its descent.
struct System
{
  std::shared_ptr<const Assembler> Operators = MakeAssembler(Icosphere(3));
  const TriangleMesh& Mesh = Operators->Mesh();
  SparseMatrix Matrix = ZeroMatrix(Operators->Pattern());
  QuadraticDescent Descent;
  Values B, X;

  explicit System(Eigen::Index columns, bool isSingle = false)
    : B(Noise(Mesh, columns))
    , X(Values::Zero(Mesh.NumberOfVertices(), columns))
  {
    this->Operators->Fill(this->Matrix, this->Mesh.ControlAreas(), 0.05, CotanWeights(this->Mesh));
    this->Descent.SetSinglePrecision(isSingle);
    this->Descent.SetMatrix(this->Matrix);
    this->Descent.Residual = this->B;
  }

  Values TrueResidual() const
  {
    Values product(this->X.rows(), this->X.cols());
    Multiply(this->Matrix, this->X, product);
    return this->B - product;
  }
};

} // namespace

TEST(QuadraticDescent, KeepsTheResidualWhileTheRightHandSideMoves)
{
  for (const Eigen::Index columns : { 1, 2, 3, 5 })
  {
    System system(columns);
    for (int call = 0; call < 20; ++call)
    {
      system.Descent.Improve(system.X, 0.0, 3);
      const Values change = 0.1 * Noise(system.Mesh, columns, call);
      system.B += change;
      system.Descent.Residual += change;
      EXPECT_LT((system.Descent.Residual - system.TrueResidual()).cwiseAbs().maxCoeff(), 1e-12);
    }
  }
}

TEST(QuadraticDescent, KeepsItsDigitsInSinglePrecision)
{
  for (const Eigen::Index columns : { 1, 3, 5 })
  {
    System system(columns, true);
    System exact(columns);
    system.Descent.Improve(system.X, 0.0, 3);
    exact.Descent.Improve(exact.X, 0.0, 3);
    const double size = exact.X.cwiseAbs().maxCoeff();
    EXPECT_GT((system.X - exact.X).cwiseAbs().maxCoeff(), 1e-14 * size); // it is another path
    EXPECT_LT((system.X - exact.X).cwiseAbs().maxCoeff(), 1e-5 * size);
    EXPECT_LT((system.Descent.Residual - system.TrueResidual()).cwiseAbs().maxCoeff(),
      1e-6 * system.B.cwiseAbs().maxCoeff());
  }
}

TEST(QuadraticDescent, EndsAtTheSolutionInSinglePrecision)
{
  System system(3, true);
  for (int call = 0; call < 100; ++call)
  {
    system.Descent.Residual = system.TrueResidual();
    system.Descent.Improve(system.X, 0.0, 4);
  }
  EXPECT_LT(system.TrueResidual().cwiseAbs().maxCoeff(), 1e-13);
}

// Of directions that are nearly constant along lines, products in single precision have no digit.
TEST(QuadraticDescent, KnowsWhatLinesHideInSinglePrecision)
{
  constexpr Index side = 150;
  constexpr double across = 1e-6;
  std::vector<Eigen::Triplet<double, Index>> entries;
  const auto connect = [&](Index i, Index j, double weight)
  {
    for (const auto& [row, column, sign] : { std::tuple(i, i, 1.0), std::tuple(j, j, 1.0),
           std::tuple(i, j, -1.0), std::tuple(j, i, -1.0) })
    {
      entries.emplace_back(row, column, sign * weight);
    }
  };
  for (Index i = 0; i < side * side; ++i)
  {
    entries.emplace_back(i, i, 1e-2 * across);
    if (i % side + 1 < side)
    {
      connect(i, i + 1, 1.0);
    }
    if (i + side < side * side)
    {
      connect(i, i + side, across);
    }
  }
  SparseMatrix matrix(side * side, side * side);
  matrix.setFromTriplets(entries.begin(), entries.end());
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  const Values b = Values::NullaryExpr(side * side, 1, [&] { return normal(engine); });
  Values x = Values::Zero(side * side, 1);
  QuadraticDescent descent;
  descent.SetSinglePrecision(true);
  descent.SetMatrix(matrix);
  descent.Residual = b;
  for (int call = 0; call < 5; ++call)
  {
    descent.Improve(x, 0.1, 20);
  }
  EXPECT_LT((b - matrix * x - descent.Residual).norm(), 2e-2 * b.norm());
  EXPECT_LT((b - matrix * x).norm(), 0.1 * b.norm());
}

TEST(QuadraticDescent, StopsAtTheReduction)
{
  for (const bool isSingle : { false, true })
  {
    System system(2, isSingle);
    const auto lengthOf = [&](Eigen::Index column)
    {
      const Vector inverse = Vector(system.Matrix.diagonal()).cwiseInverse();
      const Values& r = system.Descent.Residual;
      return std::sqrt(r.col(column).cwiseAbs2().dot(inverse));
    };
    system.Descent.Residual.col(1) *= 1e6;
    const double first = lengthOf(0);
    const double second = lengthOf(1);
    system.Descent.Improve(system.X, 0.1, 100);
    for (const double share : { lengthOf(0) / first, lengthOf(1) / second })
    {
      EXPECT_LT(share, 0.1);
      EXPECT_GT(share, 0.01);
    }
  }
}

TEST(QuadraticDescent, EndsAtTheSolution)
{
  System system(3);
  for (int call = 0; call < 100; ++call)
  {
    system.Descent.Improve(system.X, 0.0, 4);
  }
  EXPECT_LT(system.TrueResidual().cwiseAbs().maxCoeff(), 1e-13);
  const Values x = system.X;
  system.Descent.Improve(system.X, 0.0, 4); // nothing left to do
  EXPECT_LT((system.X - x).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(QuadraticDescent, ColumnsDoNotKnowOfEachOther)
{
  System all(3);
  all.Descent.Improve(all.X, 0.0, 4);
  for (Eigen::Index k = 0; k < 3; ++k)
  {
    System one(1);
    one.Descent.Residual = all.B.col(k);
    one.Descent.Improve(one.X, 0.0, 4);
    EXPECT_TRUE(one.X == all.X.col(k));
  }
}

// Along (1, 1, -1) the entries of this matrix leave nothing but their last digits.
TEST(QuadraticDescent, TakesNoStepThatOnlyRoundOffBounds)
{
  Eigen::Matrix3d dense;
  dense << 0.25, 0.5, 0.75, 0.5, 1.0, 1.5, 0.75, 1.5, 2.25;
  SparseMatrix matrix = dense.sparseView();
  matrix.coeffRef(0, 0) *= 1.0 + 4e-16;
  for (const bool isSingle : { false, true })
  {
    QuadraticDescent descent;
    descent.SetSinglePrecision(isSingle);
    descent.SetMatrix(matrix);
    descent.Residual = Values::Zero(3, 1);
    descent.Residual.col(0) << 0.25, 1.0, -2.25; // the diagonal times that
    Values x = Values::Zero(3, 1);
    descent.Improve(x, 0.0, 4);
    EXPECT_LT(x.cwiseAbs().maxCoeff(), 1e3);
  }
}
