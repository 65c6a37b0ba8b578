// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NeedleMeshes.h"

#include "Core/Foundation/SymmetricModes.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/SparsePattern.h"
#include "Core/Solvers/StrongLines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// M + c h^2 K of a surface.
SparseMatrix HeatMatrix(const Testing::Surface& surface, double c)
{
  const auto mesh = MakeMesh(surface);
  const Assembler assembler(mesh);
  const double h = MeanEdge(*mesh);
  SparseMatrix matrix = ZeroMatrix(assembler.Pattern());
  assembler.Fill(matrix, mesh->ControlAreas(), c * h * h, CotanWeights(*mesh));
  return matrix;
}

/// A graph Laplacian of n vertices plus `excess` per vertex: a path with uneven weights of about
/// 100, in a random numbering, a loop if it is closed.
SparseMatrix PathMatrix(Index n, bool isClosed, double excess)
{
  std::mt19937 engine(5);
  std::vector<Index> number(n);
  for (Index i = 0; i < n; ++i)
  {
    number[i] = i;
  }
  std::shuffle(number.begin(), number.end(), engine);
  std::uniform_real_distribution<double> weight(90.0, 110.0);
  std::vector<Eigen::Triplet<double, Index>> entries;
  for (Index k = 0; k < n; ++k)
  {
    entries.emplace_back(k, k, excess * (1.0 + 0.1 * static_cast<double>(k % 3)));
  }
  for (Index k = 0; k + 1 < n || (isClosed && k < n); ++k)
  {
    const Index i = number[k];
    const Index j = number[(k + 1) % n];
    const double w = weight(engine);
    for (const auto& [row, column, value] :
      { std::tuple(i, i, w), std::tuple(j, j, w), std::tuple(i, j, -w), std::tuple(j, i, -w) })
    {
      entries.emplace_back(row, column, value);
    }
  }
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

struct LinesOf
{
  SparseMatrix Matrix;
  Vector InverseDiagonal;
  StrongLines Lines;

  explicit LinesOf(SparseMatrix matrix, const ParallelFor& parallel = SerialFor())
    : Matrix(std::move(matrix))
    , InverseDiagonal(Vector(this->Matrix.diagonal()).cwiseInverse())
    , Lines(parallel)
  {
    this->Lines.Set(this->Matrix, this->InverseDiagonal);
  }

  Values Precondition(const Values& r) const
  {
    Values z(r.rows(), r.cols());
    this->Lines.Precondition(this->InverseDiagonal, r, z);
    return z;
  }
};

Values Random(Index n, Index columns = 1)
{
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  return Values::NullaryExpr(n, columns, [&] { return normal(engine); });
}

} // namespace

TEST(StrongLines, AreNowhereOnEvenMeshes)
{
  EXPECT_TRUE(LinesOf(HeatMatrix(Icosphere(4), 10.0)).Lines.IsEmpty());
  EXPECT_TRUE(LinesOf(HeatMatrix(Icosphere(4), 10.0)).Lines.IsEmptyEverywhere());
  EXPECT_TRUE(LinesOf(SparseMatrix(0, 0)).Lines.IsEmpty());
}

TEST(StrongLines, SolvePathsAndLoops)
{
  for (const bool isClosed : { false, true })
  {
    for (const Index n : { 2, 3, 4, 5, 100, 4096 })
    {
      if (isClosed && n == 2)
      {
        continue;
      }
      const LinesOf path(PathMatrix(n, isClosed, 0.5));
      EXPECT_EQ(path.Lines.Vertices().size(), static_cast<std::size_t>(n));
      const Values exact = Random(n, 2);
      const Values x = path.Precondition(path.Matrix * exact);
      EXPECT_LT((x - exact).norm(), 2e-4 * exact.norm()) << n << isClosed;
    }
  }
}

TEST(StrongLines, CorrectInSinglePrecisionAsTheyPrecondition)
{
  const LinesOf path(PathMatrix(1000, true, 5.0));
  LinesOf again(path.Matrix);
  const Values r = Random(1000);
  const Vector roots = path.InverseDiagonal.cwiseSqrt();
  std::vector<float> scaled(1000), correction(1000);
  for (Index i = 0; i < 1000; ++i)
  {
    scaled[i] = static_cast<float>(roots[i] * r(i, 0));
  }
  const double product =
    again.Lines.Correct(again.Lines.Vertices(), scaled.data(), correction.data());
  const Values z = path.Precondition(r);
  EXPECT_NEAR(product,
    r.col(0).dot(z.col(0)) - r.col(0).dot(path.InverseDiagonal.cwiseProduct(r.col(0))),
    1e-4 * std::abs(product));
  for (std::size_t k = 0; k < 1000; ++k)
  {
    const Index i = again.Lines.Vertices()[k];
    EXPECT_NEAR(roots[i] * (correction[k] + scaled[i]), z(i, 0), 1e-5 * z.cwiseAbs().maxCoeff());
  }
}

// M of at most two entries a row is at least half of A, and at most what A is without its other
// connections: the eigenvalues of M^-1 A are in (0, 2].
TEST(StrongLines, ArePositiveDefiniteAndBoundTheMatrix)
{
  for (const double c : { 0.3, 100.0 })
  {
    const LinesOf needles(HeatMatrix(LatitudeLongitudeSphere(64, 10), c));
    const auto n = static_cast<Index>(needles.Matrix.rows());
    ASSERT_FALSE(needles.Lines.IsEmpty());
    const Eigen::MatrixXd b = needles.Precondition(Values::Identity(n, n));
    EXPECT_LT((b - b.transpose()).norm(), 1e-12 * b.norm());
    const Eigen::LLT<Eigen::MatrixXd> root(0.5 * (b + b.transpose()));
    ASSERT_EQ(root.info(), Eigen::Success);
    const Eigen::MatrixXd l = root.matrixL();
    const Vector modes = SymmetricEigenvalues(l.transpose() * Eigen::MatrixXd(needles.Matrix) * l);
    EXPECT_GT(modes.minCoeff(), 0.0);
    EXPECT_LT(modes.maxCoeff(), 2.0 + 1e-4);
    const Vector roots = needles.InverseDiagonal.cwiseSqrt();
    const Vector ofDiagonal = SymmetricEigenvalues(
      roots.asDiagonal() * Eigen::MatrixXd(needles.Matrix) * roots.asDiagonal());
    EXPECT_GT(modes.minCoeff(), 5.0 * ofDiagonal.minCoeff()) << c;
  }
}

TEST(StrongLines, AreCutWhereTheyAreLong)
{
  for (const bool isClosed : { false, true })
  {
    const LinesOf path(PathMatrix(20000, isClosed, 5.0));
    EXPECT_EQ(path.Lines.Vertices().size(), 20000U);
    const Values r = Random(20000);
    const Values z = path.Precondition(r);
    const double product = r.col(0).dot(z.col(0));
    EXPECT_GT(product, 0.0);
    // at most four cuts
    EXPECT_LT(
      (path.Matrix * z - r).cwiseAbs().unaryExpr([](double x) { return x > 1e-3; }).count(), 12);
  }
}

// Round-off would be taken for the mean of a needle's ends: iterations would be ten times as many.
TEST(StrongLines, LeaveWhatRoundOffHides)
{
  const LinesOf seam(HeatMatrix(TorusWithSeam(60, 1.0, 0.2), 1.0));
  EXPECT_FALSE(seam.Lines.IsEmpty());
  for (std::size_t k = 0; k < seam.Lines.Vertices().size(); ++k)
  {
    EXPECT_LT(seam.Lines.Share(k), 1.0 - 0.5e-6);
  }
  SparseMatrix pair = PathMatrix(2, false, 1e-6);
  EXPECT_TRUE(LinesOf(pair).Lines.IsEmpty());
  pair = PathMatrix(2, false, 1e-2);
  EXPECT_FALSE(LinesOf(pair).Lines.IsEmpty());
}

// Such entries, which no surface has, would make M another matrix than A.
TEST(StrongLines, LeaveRowsWithLargePositiveEntries)
{
  SparseMatrix matrix = PathMatrix(50, false, 1.0);
  EXPECT_EQ(LinesOf(matrix).Lines.Vertices().size(), 50U);
  std::vector<Eigen::Triplet<double, Index>> entries;
  for (Index i = 0; i < 50; ++i)
  {
    for (SparseMatrix::InnerIterator a(matrix, i); a; ++a)
    {
      entries.emplace_back(i, a.index(), a.value());
    }
    entries.emplace_back(i, 50, 300.0);
    entries.emplace_back(50, i, 300.0);
  }
  entries.emplace_back(50, 50, 1e6);
  SparseMatrix larger(51, 51);
  larger.setFromTriplets(entries.begin(), entries.end());
  EXPECT_TRUE(LinesOf(larger).Lines.IsEmpty());
}

TEST(StrongLines, AreNotMadeOfFixedOrBrokenRows)
{
  SparseMatrix matrix = PathMatrix(10, false, 1.0);
  matrix.coeffRef(3, 3) = std::numeric_limits<double>::quiet_NaN();
  const LinesOf broken(matrix);
  EXPECT_EQ(std::count(broken.Lines.Vertices().begin(), broken.Lines.Vertices().end(), 3), 0);
  SparseMatrix identity(10, 10);
  identity.setIdentity();
  EXPECT_TRUE(LinesOf(identity).Lines.IsEmpty());
}
