// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/SinglePrecisionSolver.h"
#include "Meshes.h"
#include "ThreadedFor.h"

#include <gtest/gtest.h>

#include <random>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Symmetric and diagonally dominant, with unit diagonal, and rows of 1 to 60 entries.
SparseMatrix UnevenMatrix(Index n)
{
  std::mt19937 engine(7);
  std::uniform_int_distribution<Index> vertex(0, n - 1);
  std::vector<Eigen::Triplet<double, Index>> entries;
  for (Index i = 0; i < n; ++i)
  {
    entries.emplace_back(i, i, 1.0);
  }
  for (Index i = 0; i < n; i += 3)
  {
    for (Index neighbor = 0; neighbor < (i % 60 == 0 ? 50 : 2); ++neighbor)
    {
      const Index j = vertex(engine);
      if (j != i && j % 7 != 0)
      {
        entries.emplace_back(i, j, 0.003);
        entries.emplace_back(j, i, 0.003);
      }
    }
  }
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::vector<float> InOrderOf(const SlicedMatrix& sliced, const Values& values)
{
  std::vector<float> ordered(sliced.PaddedRows() * values.cols(), 0.0F);
  for (Eigen::Index c = 0; c < values.cols(); ++c)
  {
    for (std::size_t place = 0; place < sliced.PaddedRows(); ++place)
    {
      const Index row = sliced.RowsInOrder()[place];
      ordered[c * sliced.PaddedRows() + place] =
        row < 0 ? 0.0F : static_cast<float>(values(row, c));
    }
  }
  return ordered;
}

Values AnyValues(Index rows, Index columns)
{
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  return Values::NullaryExpr(rows, columns, [&] { return number(engine); });
}

} // namespace

TEST(SlicedMatrix, MultipliesAsTheMatrixDoes)
{
  for (const Index n : { 1, 15, 16, 17, 2047, 2048, 2049, 5000 })
  {
    const SparseMatrix matrix = UnevenMatrix(n);
    const Vector scale = Vector::LinSpaced(n, 0.5, 2.0);
    SlicedMatrix sliced(SerialFor());
    sliced.Set(
      scale.cwiseInverse().asDiagonal() * matrix * scale.cwiseInverse().asDiagonal(), scale);
    const Values p = AnyValues(n, 3);
    const std::vector<float> ordered = InOrderOf(sliced, p);
    std::vector<float> q(ordered.size(), -1.0F);
    double sums[3];
    sliced.Multiply(3, ordered.data(), q.data(), sums);
    const Values exact = matrix * p;
    const std::vector<float> expected = InOrderOf(sliced, exact);
    for (std::size_t i = 0; i < q.size(); ++i)
    {
      ASSERT_NEAR(q[i], expected[i], 1e-5) << n;
    }
    for (int c = 0; c < 3; ++c)
    {
      EXPECT_NEAR(sums[c], p.col(c).dot(exact.col(c)), 1e-5 * n);
    }
  }
}

TEST(SlicedMatrix, TakesNewValuesAndNewPatterns)
{
  SlicedMatrix sliced(SerialFor());
  SparseMatrix matrix = UnevenMatrix(3000);
  for (int k = 0; k < 3; ++k)
  {
    const Index n = static_cast<Index>(matrix.rows());
    sliced.Set(matrix, Vector::Ones(n));
    const std::vector<float> ones = InOrderOf(sliced, Values::Ones(n, 1));
    std::vector<float> q(ones.size());
    double sum = 0.0;
    sliced.Multiply(1, ones.data(), q.data(), &sum);
    EXPECT_NEAR(sum, matrix.sum(), 1e-5 * n);
    if (k == 0)
    {
      matrix = 0.5 * matrix; // the unit diagonal is not stored
      matrix.diagonal().setOnes();
    }
    else
    {
      matrix = UnevenMatrix(2000);
    }
  }
}

TEST(SinglePrecisionSolver, GivesTheSameBitsOnAnyThreadsAndWithAnyColumns)
{
  const SparseMatrix matrix = UnevenMatrix(9000);
  const Vector inverse = Vector::Ones(9000);
  const Values r = AnyValues(9000, 6);
  const auto solve = [&](const ParallelFor& parallel, int first, int count)
  {
    SinglePrecisionSolver solver(parallel);
    StrongLines lines(parallel);
    lines.Set(matrix, inverse);
    solver.SetMatrix(matrix, inverse, lines);
    std::vector<SinglePrecisionSolver::Column> columns(count);
    for (int c = 0; c < count; ++c)
    {
      columns[c].Length = r.col(first + c).norm();
      columns[c].Reduction = 1e-4;
    }
    Values x = Values::Zero(9000, count);
    EXPECT_GT(solver.Correct(r.middleCols(first, count), columns, 100, x, ProgressMonitor()), 1);
    return x;
  };
  const Values all = solve(SerialFor(), 0, 6);
  EXPECT_LT((matrix * all - r).norm(), 2e-4 * r.norm());
  EXPECT_TRUE(solve(ThreadedFor(3), 0, 6) == all);
  for (int c = 0; c < 6; ++c)
  {
    EXPECT_TRUE(solve(SerialFor(), c, 1) == all.col(c)) << c;
  }
}

TEST(SinglePrecisionSolver, LeavesAColumnThatItCannotSolve)
{
  SparseMatrix matrix = UnevenMatrix(100);
  for (Index i = 0; i < 100; ++i)
  {
    matrix.coeffRef(i, (i + 1) % 100) = matrix.coeffRef((i + 1) % 100, i) = 5.0; // indefinite
  }
  matrix.makeCompressed();
  const Values r = AnyValues(100, 1);
  SinglePrecisionSolver solver(SerialFor());
  StrongLines lines(SerialFor());
  lines.Set(matrix, Vector::Ones(100));
  solver.SetMatrix(matrix, Vector::Ones(100), lines);
  std::vector<SinglePrecisionSolver::Column> columns(1);
  columns[0].Length = r.norm();
  columns[0].Reduction = 1e-4;
  Values x = Values::Constant(100, 1, 2.0);
  solver.Correct(r, columns, 100, x, ProgressMonitor());
  EXPECT_TRUE(x == Values::Constant(100, 1, 2.0));
}
