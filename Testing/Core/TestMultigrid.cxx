// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Allocations.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/Aggregation.h"
#include "Core/Solvers/LinearSolver.h"
#include "Core/Solvers/Multigrid.h"
#include "Core/Solvers/SparseColumns.h"
#include "MeshFiles.h"
#include "Meshes.h"
#include "ThreadedFor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// M + c h^2 K
SparseMatrix HeatMatrix(const Assembler& assembler, double c, const CornerWeights& coefficients)
{
  const TriangleMesh& mesh = assembler.Mesh();
  const double h = mesh.TotalEdgeLength() / mesh.NumberOfEdges();
  SparseMatrix matrix = ZeroMatrix(assembler.Pattern());
  assembler.Fill(matrix, mesh.ControlAreas(), c * h * h, coefficients);
  return matrix;
}

SparseMatrix HeatMatrix(const Assembler& assembler, double c)
{
  return HeatMatrix(assembler, c, CotanWeights(assembler.Mesh()));
}

int IterationsOf(const SparseMatrix& matrix, const Values& exact)
{
  const auto solver = MakeMultigridSolver();
  solver->SetMatrix(matrix);
  Values x = Values::Zero(exact.rows(), exact.cols());
  const SolveReport report = solver->Solve(matrix * exact, x);
  EXPECT_TRUE(report.Converged);
  return report.Iterations;
}

} // namespace

TEST(Multigrid, IterationsHardlyGrowWithSizeAndTimeStep)
{
  for (const double c : { 0.1, 1.0, 100.0, 1e4, 1e8 })
  {
    std::cout << "dt = " << c << " h^2, iterations:";
    for (const int subdivisions : { 4, 5, 6 })
    {
      const auto assembler = MakeAssembler(Icosphere(subdivisions));
      const int iterations = IterationsOf(HeatMatrix(*assembler, c), Noise(assembler->Mesh()));
      std::cout << ' ' << iterations;
      EXPECT_LE(iterations, c < 10.0 ? 12 : 25) << subdivisions;
    }
    std::cout << '\n';
  }
}

TEST(Multigrid, FollowsStrongCoefficients)
{
  // 100:1 along one direction of a strip, where isotropic coarsening would stall.
  const auto assembler = MakeAssembler(Strip(100, 100));
  const TriangleMesh& mesh = assembler->Mesh();
  TangentVectors frames(mesh.NumberOfTriangles(), 2);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    frames.row(t) << 1.0, 0.0; // some edge of each
  }
  const Vector along = Vector::Constant(mesh.NumberOfTriangles(), 100.0);
  const Vector across = Vector::Ones(mesh.NumberOfTriangles());
  const SparseMatrix matrix = HeatMatrix(
    *assembler, 100.0, AnisotropicWeights(mesh, CotanWeights(mesh), frames, along, across));
  EXPECT_LE(IterationsOf(matrix, Noise(mesh)), 60);
}

TEST(Multigrid, ConvergesOnRealMeshes)
{
  if (!HaveMeshFiles())
  {
    GTEST_SKIP() << "no folder with meshes";
  }
  for (const char* name : { "elephant", "bunny00", "fandisk", "blobby", "oblong-shuffled" })
  {
    const auto assembler = MakeAssembler(ReadMeshFile(name));
    for (const double c : { 1.0, 1e4 })
    {
      const int iterations = IterationsOf(HeatMatrix(*assembler, c), Noise(assembler->Mesh()));
      std::cout << name << ", dt = " << c << " h^2: " << iterations << " iterations\n";
      EXPECT_LE(iterations, 60) << name;
    }
  }
}

TEST(Multigrid, SolvesComponentsApartFromEachOther)
{
  // Far apart in size and more of them than the coarsest level has vertices.
  Surface s = Icosphere(4);
  for (int i = 0; i < 700; ++i)
  {
    s = Joined(s, Moved(Scaled(Tetrahedron(), 1e-3), { 3.0 + i, 0.0, 0.0 }));
  }
  const auto assembler = MakeAssembler(s);
  EXPECT_LE(IterationsOf(HeatMatrix(*assembler, 100.0), Noise(assembler->Mesh())), 30);
}

TEST(Multigrid, AllocatesNothingInLaterSolves)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const SparseMatrix matrix = HeatMatrix(*assembler, 100.0);
  const auto solver = MakeMultigridSolver();
  solver->SetMatrix(matrix);
  const Values b = matrix * Noise(assembler->Mesh());
  Values x = Values::Zero(b.rows(), 1);
  solver->Solve(b, x);
  x.setZero();
  const auto before = NumberOfAllocations();
  solver->Solve(b, x);
  EXPECT_EQ(NumberOfAllocations(), before);
}

TEST(Multigrid, TakesOtherMatricesAndNumbersOfColumns)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const auto solver = MakeMultigridSolver();
  for (const double c : { 1.0, 100.0 })
  {
    const SparseMatrix matrix = HeatMatrix(*assembler, c);
    solver->SetMatrix(matrix);
    for (const Eigen::Index columns : { 1, 5, 3 })
    {
      const Values exact = Noise(assembler->Mesh(), columns);
      Values x = Values::Zero(exact.rows(), columns);
      solver->Solve(matrix * exact, x);
      EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-7);
    }
  }
}

TEST(SmoothedAggregation, KeepsTheKernel)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const SparseMatrix matrix = HeatMatrix(*assembler, 1e12); // constants are its kernel, all but
  const Vector ones = Vector::Ones(matrix.rows());
  Vector coarse = ones;
  const SparseMatrix restriction = SmoothedAggregation(matrix, 0.08, coarse, SerialFor());
  EXPECT_LT(restriction.rows(), matrix.rows() / 3);
  EXPECT_EQ(coarse.size(), restriction.rows());
  EXPECT_LT((restriction.transpose() * coarse - ones).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(SmoothedAggregation, LeavesOutRowsWithoutStrongEntries)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const SparseMatrix matrix = HeatMatrix(*assembler, 1e-6); // all but diagonal
  Vector kernel = Vector::Ones(matrix.rows());
  EXPECT_EQ(SmoothedAggregation(matrix, 0.08, kernel, SerialFor()).rows(), 0);
}

TEST(GalerkinProduct, EqualsTheProductOfThree)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const SparseMatrix matrix = HeatMatrix(*assembler, 1.0);
  Vector kernel = Vector::Ones(matrix.rows());
  const SparseMatrix restriction = SmoothedAggregation(matrix, 0.08, kernel, SerialFor());
  const SparseMatrix prolongation = restriction.transpose();
  const SparseMatrix product = GalerkinProduct(matrix, restriction, prolongation, ThreadedFor(2));
  const SparseMatrix half = matrix * prolongation;
  const SparseMatrix whole = restriction * half;
  EXPECT_LT((product - whole).norm(), 1e-14 * whole.norm());
}

namespace
{

/// A stiffness matrix whose coefficients differ by a factor of up to 20 from triangle to triangle.
SparseMatrix NoisyMatrix(const Assembler& assembler, double c, unsigned seed)
{
  CornerWeights coefficients = CotanWeights(assembler.Mesh());
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> exponent(0.0, std::log(20.0));
  for (Index t = 0; t < static_cast<Index>(coefficients.rows()); ++t)
  {
    coefficients.row(t) *= std::exp(exponent(random));
  }
  return HeatMatrix(assembler, c, coefficients);
}

int IterationsOf(LinearSolver& solver, const SparseMatrix& matrix, const Values& exact)
{
  solver.SetMatrix(matrix);
  Values x = Values::Zero(exact.rows(), exact.cols());
  const SolveReport report = solver.Solve(matrix * exact, x);
  EXPECT_TRUE(report.Converged);
  EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-6);
  return report.Iterations;
}

} // namespace

TEST(Coarsening, HasTheBitsOfItsParts)
{
  const auto assembler = MakeAssembler(Icosphere(5));
  const SparseMatrix first = HeatMatrix(*assembler, 100.0);
  const ThreadedFor threads(2);
  Coarsening coarsening(first, 0.08, threads);
  Vector kernel = Vector::Ones(first.rows());
  coarsening.SetMatrix(NoisyMatrix(*assembler, 100.0, 1), kernel);
  kernel = Vector::Ones(first.rows());
  coarsening.SetMatrix(first, kernel);

  Vector expected = Vector::Ones(first.rows());
  const SparseMatrix restriction = SmoothedAggregation(first, 0.08, expected, SerialFor());
  const SparseMatrix prolongation = restriction.transpose();
  const SparseMatrix product = GalerkinProduct(first, restriction, prolongation, SerialFor());
  EXPECT_TRUE(kernel == expected);
  EXPECT_EQ(coarsening.NumberOfAggregates(), restriction.rows());
  EXPECT_EQ((coarsening.Restriction() - restriction).norm(), 0.0);
  EXPECT_EQ((coarsening.Prolongation() - prolongation).norm(), 0.0);
  EXPECT_EQ((coarsening.Product() - product).norm(), 0.0);
}

TEST(Multigrid, KeptAggregatesServeOtherCoefficients)
{
  const auto assembler = MakeAssembler(Icosphere(5));
  const Values exact = Noise(assembler->Mesh(), 3);
  const auto kept = MakeMultigridSolver(HeatMatrix(*assembler, 1000.0), SerialFor());
  for (const unsigned seed : { 1U, 2U })
  {
    for (const double c : { 10.0, 1000.0 })
    {
      const SparseMatrix matrix = NoisyMatrix(*assembler, c, seed);
      const int own = IterationsOf(matrix, exact);
      const int iterations = IterationsOf(*kept, matrix, exact);
      std::cout << "dt = " << c << " h^2: " << iterations << " iterations, " << own
                << " with its own aggregates\n";
      EXPECT_LE(iterations, 1.5 * own);
    }
  }
}

TEST(Multigrid, KeptAggregatesForgetEarlierMatrices)
{
  const auto assembler = MakeAssembler(Icosphere(5));
  const SparseMatrix model = HeatMatrix(*assembler, 1000.0);
  const SparseMatrix matrix = NoisyMatrix(*assembler, 100.0, 3);
  const Values r = Noise(assembler->Mesh(), 3);
  const ThreadedFor threads(3);
  const ParallelFor* const loops[] = { &SerialFor(), &threads };
  Values z[2];
  for (const int k : { 0, 1 })
  {
    const auto solver = MakeMultigridSolver(model, *loops[k]);
    if (k == 1)
    {
      solver->SetMatrix(NoisyMatrix(*assembler, 10.0, 4));
    }
    solver->SetMatrix(matrix);
    solver->Precondition(r, z[k]);
  }
  EXPECT_TRUE(z[0] == z[1]);
}

TEST(Multigrid, BitsOfAColumnDoNotDependOnTheOthers)
{
  const auto assembler = MakeAssembler(Icosphere(5));
  const auto solver = MakeMultigridSolver();
  const SparseMatrix matrix = HeatMatrix(*assembler, 100.0);
  solver->SetMatrix(matrix);
  const Values all = Noise(assembler->Mesh(), 20);
  for (const Eigen::Index columns : { 1, 2, 3, 4, 5, 8, 9, 16, 17, 20, 3, 12 })
  {
    Values z, one;
    solver->Precondition(all.leftCols(columns), z);
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      solver->Precondition(all.col(c), one);
      EXPECT_TRUE(z.col(c) == one.col(0)) << c << " of " << columns;
    }
  }
}

TEST(CollectColumns, KeepsNoPlacesOfAColumnWithTooManyRows)
{
  // 70,000 rows in one column: their places do not fit in 16 bits.
  const auto collect = [](double factor)
  {
    return [factor](Index j, auto& column)
    {
      for (Index i = 0; i < (j == 0 ? 70000 : 3); ++i)
      {
        column.Add(i, factor * (i + j));
      }
    };
  };
  CollectedPlaces places;
  SparseMatrix matrix = CollectColumns<NotedColumn>(70000, 5, SerialFor(), collect(1.0), places);
  EXPECT_TRUE(places.empty());
  EXPECT_EQ(matrix.coeff(69999, 0), 69999.0);
}
