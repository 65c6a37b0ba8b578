// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/SupernodalFactor.h"
#include "Meshes.h"
#include "ThreadedFor.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// K M^-1 K with `share` at every tenth vertex of the diagonal.
SparseMatrix FourthOrder(const Assembler& assembler, double share = 1.0)
{
  const TriangleMesh& mesh = assembler.Mesh();
  SparseMatrix stiffness = ZeroMatrix(assembler.Pattern());
  assembler.Fill(stiffness, Vector::Zero(mesh.NumberOfVertices()), 1.0, CotanWeights(mesh));
  SparseMatrix matrix = stiffness * mesh.ControlAreas().cwiseInverse().asDiagonal() * stiffness;
  for (Index i = 0; i < mesh.NumberOfVertices(); i += 10)
  {
    matrix.coeffRef(i, i) += share;
  }
  return matrix;
}

std::vector<Surface> SeveralSurfaces()
{
  return { Tetrahedron(), Icosphere(2), Torus(14, 8), Disk(5), ThreeFins(5), Moebius(16, 4),
    Jittered(Strip(17, 9), 0.02, 0.05, 0.95, 0.1, 0.9),
    Joined(Icosphere(1), Moved(Strip(9, 30), { 5.0, 0.0, 0.0 })) };
}

} // namespace

TEST(SupernodalFactor, SolvesAsTheDenseMatrixOnAnySurface)
{
  for (const Surface& s : SeveralSurfaces())
  {
    const auto assembler = MakeAssembler(s);
    const SparseMatrix matrix = FourthOrder(*assembler);
    const Eigen::MatrixXd dense(matrix);
    const auto inverse = dense.inverse().eval();
    for (const bool isRegular : { false, true })
    {
      SupernodalFactor factor;
      ASSERT_EQ(factor.Compute(matrix, isRegular, 1e-14, SerialFor()).Open, 0);
      for (const Index columns : { 1, 8, 11 })
      {
        const Values b = Noise(assembler->Mesh(), columns);
        Values x = b;
        factor.Solve(x, SerialFor());
        const Values expected = inverse * b;
        EXPECT_LT((x - expected).norm(), 1e-9 * expected.norm()) << matrix.rows() << " rows";
      }
      const Vector diagonal = factor.InverseDiagonal(SerialFor());
      EXPECT_LT((diagonal.cwiseQuotient(inverse.diagonal()).array() - 1.0).abs().maxCoeff(), 1e-9);
    }
  }
}

TEST(SupernodalFactor, CountsThePivotsOfASingularMatrix)
{
  const auto assembler =
    MakeAssembler(Joined(Icosphere(2), Moved(Icosphere(3), { 5.0, 0.0, 0.0 })));
  SupernodalFactor factor;
  EXPECT_EQ(factor.Compute(FourthOrder(*assembler, 0.0), true, 1e-11, SerialFor()).Open, 2);
  Values x = Noise(assembler->Mesh());
  factor.Solve(x, SerialFor());
  EXPECT_TRUE(x.allFinite());
  EXPECT_EQ(factor.Compute(FourthOrder(*assembler, 1.0), true, 1e-11, SerialFor()).Open, 0);
}

TEST(SupernodalFactor, HasTheSameBitsOnAnyNumberOfThreadsAndInAnyHistory)
{
  const auto assembler = MakeAssembler(Icosphere(5));
  const Values b = Noise(assembler->Mesh(), 20);
  const SparseMatrix matrix = FourthOrder(*assembler, 3.0);
  SupernodalFactor serial, threaded;
  serial.Compute(matrix, true, 1e-14, SerialFor());
  Values x = b;
  serial.Solve(x, SerialFor());
  const ThreadedFor threads(3);
  threaded.Compute(FourthOrder(*assembler, 1.0), true, 1e-14, threads);
  threaded.Compute(matrix, true, 1e-14, threads);
  Values y = b;
  threaded.Solve(y, threads);
  EXPECT_EQ(x, y);
  EXPECT_EQ(serial.InverseDiagonal(SerialFor()), threaded.InverseDiagonal(threads));
}

TEST(SupernodalFactor, TakesNothingForAnAnswerWithoutRows)
{
  SupernodalFactor factor;
  EXPECT_EQ(factor.Compute(SparseMatrix(0, 0), false, 1e-14, SerialFor()).Open, 0);
  Values x(0, 3);
  factor.Solve(x, SerialFor());
  EXPECT_EQ(factor.InverseDiagonal(SerialFor()).size(), 0);
}

TEST(SupernodalFactor, EndsWhenItIsAborted)
{
  const auto assembler = MakeAssembler(Icosphere(4));
  const ProgressMonitor::Callback stop = [](double fraction) { return fraction < 0.5; };
  SupernodalFactor factor;
  EXPECT_THROW(
    factor.Compute(FourthOrder(*assembler), true, 1e-14, SerialFor(), ProgressMonitor(stop)),
    Aborted);
  EXPECT_EQ(factor.Compute(FourthOrder(*assembler), true, 1e-14, SerialFor()).Open, 0);
}

/// Rows without neighbours, as Dirichlet conditions leave them, are subtrees of their own.
TEST(SupernodalFactor, ReportsAndStartsLoopsFewTimesForManySmallSubtrees)
{
  SparseMatrix identity(100000, 100000);
  identity.setIdentity();
  int reports = 0;
  const ProgressMonitor::Callback count = [&](double)
  {
    ++reports;
    return true;
  };
  SupernodalFactor factor;
  factor.Compute(identity, false, 1e-14, SerialFor(), ProgressMonitor(count));
  reports = 0; // with the order that is known now
  factor.Compute(identity, false, 1e-14, SerialFor(), ProgressMonitor(count));
  EXPECT_LT(reports, 60);
}
