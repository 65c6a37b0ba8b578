// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/SymmetricModes.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/DirichletEnergy.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// diag(d) + scale K with weights that differ from triangle to triangle.
SparseMatrix WeightedMatrix(const Assembler& assembler, double diagonal, double scale)
{
  const TriangleMesh& mesh = assembler.Mesh();
  std::vector<double> weights(mesh.NumberOfTriangles());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    weights[t] = 0.1 + UniformRandom(3, 0, mesh.InputTriangle()[t]);
  }
  SparseMatrix matrix = ZeroMatrix(assembler.Pattern());
  assembler.Fill(matrix, diagonal * mesh.ControlAreas(), scale, CotanWeights(mesh), weights.data());
  return matrix;
}

const std::vector<Surface>& Surfaces()
{
  static const std::vector<Surface> surfaces = { Icosphere(2), Torus(12, 8), Tetrahedron(),
    Jittered(Strip(9, 9), 0.03, 0, 1, 0, 1), Moebius(21, 3), ThreeFins(3),
    Joined(Disk(3), Icosphere(1)) };
  return surfaces;
}

} // namespace

TEST(Assembler, MatricesAreSymmetricToTheLastBit)
{
  for (const Surface& s : Surfaces())
  {
    const Eigen::MatrixXd matrix = WeightedMatrix(*MakeAssembler(s), 1.0, 0.7);
    EXPECT_EQ(matrix, matrix.transpose());
  }
}

TEST(Assembler, RowsOfTheStiffnessMatrixSumToZero)
{
  for (const Surface& s : Surfaces())
  {
    const Eigen::MatrixXd k = WeightedMatrix(*MakeAssembler(s), 0.0, 1.0);
    EXPECT_LT(k.rowwise().sum().cwiseAbs().maxCoeff(), 1e-14 * k.cwiseAbs().maxCoeff());
  }
}

TEST(Assembler, StiffnessMatrixIsPositiveSemidefinite)
{
  for (const Surface& s : Surfaces())
  {
    const Eigen::MatrixXd k = WeightedMatrix(*MakeAssembler(s), 0.0, 1.0);
    const Vector eigenvalues = SymmetricEigenvalues(k);
    EXPECT_GT(eigenvalues.minCoeff(), -1e-13 * eigenvalues.maxCoeff());
  }
}

// (7): omega_ij = 1/2 (cot alpha_ij + cot beta_ij), here the diagonal of a rhombus with angles of
// 60 degrees opposite to it, and its sides on the boundary.
TEST(Assembler, EntriesAreHalfTheSumOfOppositeCotangents)
{
  const double h = std::sqrt(3.0);
  const auto assembler = MakeAssembler(MakeSurface(
    { { -1, 0, 0 }, { 1, 0, 0 }, { 0, h, 0 }, { 0, -h, 0 } }, { { 0, 1, 2 }, { 1, 0, 3 } }));
  const TriangleMesh& mesh = assembler->Mesh();
  SparseMatrix k = ZeroMatrix(assembler->Pattern());
  assembler->Fill(k, Vector::Zero(4), 1.0, CotanWeights(mesh));
  std::vector<Index> number(4);
  for (Index i = 0; i < 4; ++i)
  {
    number[mesh.InputVertex()[i]] = i;
  }
  const double cot = 1.0 / h;
  EXPECT_NEAR(k.coeff(number[0], number[1]), -cot, 1e-15);
  EXPECT_NEAR(k.coeff(number[0], number[2]), -0.5 * cot, 1e-15);
  EXPECT_EQ(k.coeff(number[2], number[3]), 0.0);
  EXPECT_NEAR(k.coeff(number[0], number[0]), 2.0 * cot, 1e-15);
}

TEST(Assembler, StiffnessMatrixAndDirichletEnergyAgree)
{
  for (const Surface& s : Surfaces())
  {
    const auto assembler = MakeAssembler(s);
    const CornerWeights c = CotanWeights(assembler->Mesh());
    SparseMatrix k = ZeroMatrix(assembler->Pattern());
    assembler->Fill(k, Vector::Zero(k.rows()), 1.0, c);
    const Values u = Noise(assembler->Mesh(), 2);
    const double byMatrix = 0.5 * (u.transpose() * (k * u)).trace();
    EXPECT_NEAR(DirichletEnergy(assembler->Mesh(), c, u), byMatrix, 1e-13 * byMatrix);
  }
}

// A linear function has no Laplacian inside a flat surface, however irregular its triangles are.
TEST(Assembler, LinearFunctionsAreHarmonicInside)
{
  const Surface s = Rotated(Jittered(Strip(12, 12), 0.02, 0, 1, 0, 1));
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  SparseMatrix k = ZeroMatrix(assembler->Pattern());
  assembler->Fill(k, Vector::Zero(k.rows()), 1.0, CotanWeights(mesh));
  const Values u =
    Sample(mesh, s, [](const Eigen::RowVector3d& p) { return 2.0 * p[0] - 3.0 * p[1] + p[2]; });
  const Values flux = k * u;
  Flags boundary = Flags::Constant(mesh.NumberOfVertices(), false);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const Index column = mesh.InputVertex()[i] % 13;
    const Index row = mesh.InputVertex()[i] / 13;
    boundary[i] = column == 0 || column == 12 || row == 0 || row == 12;
  }
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    if (!boundary[i])
    {
      EXPECT_NEAR(flux(i, 0), 0.0, 1e-13);
    }
  }
}

TEST(Assembler, FillingAgainReplacesAllValues)
{
  const auto assembler = MakeAssembler(Icosphere(1));
  SparseMatrix matrix = WeightedMatrix(*assembler, 5.0, 9.0);
  const SparseMatrix fresh = WeightedMatrix(*assembler, 1.0, 2.0);
  std::vector<double> weights(assembler->Mesh().NumberOfTriangles());
  for (Index t = 0; t < assembler->Mesh().NumberOfTriangles(); ++t)
  {
    weights[t] = 0.1 + UniformRandom(3, 0, assembler->Mesh().InputTriangle()[t]);
  }
  assembler->Fill(
    matrix, assembler->Mesh().ControlAreas(), 2.0, CotanWeights(assembler->Mesh()), weights.data());
  EXPECT_EQ(Eigen::MatrixXd(matrix), Eigen::MatrixXd(fresh));
}

TEST(Assembler, ConstrainedSystemsHaveTheSolutionWithTheValuesPutIn)
{
  const auto assembler = MakeAssembler(Icosphere(1));
  const TriangleMesh& mesh = assembler->Mesh();
  const Index n = mesh.NumberOfVertices();
  const Eigen::MatrixXd full = WeightedMatrix(*assembler, 1.0, 0.5);
  SparseMatrix constrained = WeightedMatrix(*assembler, 1.0, 0.5);
  Flags fixed = Flags::Constant(n, false);
  for (Index i = 0; i < n; i += 5)
  {
    fixed[i] = true;
  }
  const Values values = Noise(mesh, 2);
  Values load(n, 2);
  assembler->Constrain(constrained, fixed, values, load);
  const Eigen::MatrixXd dense = constrained;
  EXPECT_EQ(dense, dense.transpose());
  EXPECT_GT(SymmetricEigenvalues(dense).minCoeff(), 0.0);

  Values b = Noise(mesh, 2, 8);
  Values rightHandSide = load;
  for (Index i = 0; i < n; ++i)
  {
    if (!fixed[i])
    {
      rightHandSide.row(i) += b.row(i);
    }
  }
  const Values x = dense.ldlt().solve(rightHandSide);
  const Values ax = full * x;
  for (Index i = 0; i < n; ++i)
  {
    const Values left = fixed[i] ? Values(x.row(i) - values.row(i)) : Values(ax.row(i) - b.row(i));
    EXPECT_LT(left.cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(Assembler, ListsTheManyNeighboursOfAHubOnceAndSorted)
{
  constexpr Index spokes = 1000;
  Surface fan{ Points(spokes + 1, 3), Triangles(spokes, 3) };
  fan.Vertices.row(spokes).setZero();
  for (Index i = 0; i < spokes; ++i)
  {
    const double angle = 2.0 * Pi * i / spokes;
    fan.Vertices.row(i) << std::cos(angle), std::sin(angle), 0.0;
    fan.Faces.row(i) << spokes, i, (i + 1) % spokes;
  }
  const auto assembler = MakeAssembler(fan);
  const SparsePattern& pattern = assembler->Pattern();
  EXPECT_EQ(pattern.NumberOfEntries(), spokes + 1 + 2 * 2 * spokes);
  for (Index i = 0; i <= spokes; ++i)
  {
    const Index* row = pattern.Inner.data();
    EXPECT_TRUE(
      std::is_sorted(row + pattern.Outer[i], row + pattern.Outer[i + 1], std::less_equal<Index>()));
  }
  EXPECT_EQ(assembler->Mesh().NumberOfEdges(), 2 * spokes);
}

TEST(Assembler, MultiplyGivesEveryColumnTheSameBits)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const SparseMatrix matrix = WeightedMatrix(*assembler, 1.0, 1.0);
  for (const Eigen::Index columns : { 1, 2, 3, 4, 7 })
  {
    const Values x = Noise(assembler->Mesh(), columns);
    Values y(x.rows(), columns);
    Multiply(matrix, x, y);
    EXPECT_LT((y - matrix * x).cwiseAbs().maxCoeff(), 1e-13);
    for (Eigen::Index k = 0; k < columns; ++k)
    {
      Values alone(x.rows(), 1);
      Multiply(matrix, x.col(k), alone);
      EXPECT_EQ(y.col(k), alone.col(0));
    }
  }
}

TEST(Assembler, TakesAnEmptyMesh)
{
  const auto assembler =
    std::make_shared<Assembler>(std::make_shared<TriangleMesh>(Points(0, 3), Triangles(0, 3)));
  EXPECT_EQ(assembler->Pattern().NumberOfRows(), 0);
  EXPECT_EQ(assembler->Pattern().NumberOfEntries(), 0);
}

TEST(Assembler, StopsWhenAsked)
{
  const auto mesh = MakeMesh(Icosphere(2));
  const ProgressMonitor::Callback stop = [](double) { return false; };
  EXPECT_THROW(Assembler(mesh, SerialFor(), ProgressMonitor(stop)), Aborted);
}
