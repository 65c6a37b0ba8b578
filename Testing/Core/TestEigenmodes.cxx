// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/SymmetricModes.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/Eigenmodes.h"
#include "Hubs.h"
#include "Meshes.h"
#include "ThreadedFor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

Eigenmodes Find(const Surface& s, Index count, const ParallelFor& parallel = SerialFor())
{
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Eigenmodes found = FindEigenmodes(*assembler, CotanWeights(mesh), count, parallel);
  found.Eigenvalues /= mesh.LengthUnit() * mesh.LengthUnit();
  return found;
}

double DefectOfOrthonormality(const Surface& s, const Eigenmodes& found)
{
  const Eigen::MatrixXd product =
    found.Modes.transpose() * MakeMesh(s)->ControlAreas().asDiagonal() * found.Modes;
  return (product - Eigen::MatrixXd::Identity(product.rows(), product.cols()))
    .cwiseAbs()
    .maxCoeff();
}

} // namespace

// l(l + 1) / R^2, 2 l + 1 times.
TEST(Eigenmodes, OfTheSphereHaveOrderTwoAndTheirMultiplicities)
{
  constexpr double radius = 3.0;
  std::vector<double> errors;
  for (const int subdivisions : { 3, 4 })
  {
    const Surface s = Icosphere(subdivisions, radius);
    const Eigenmodes found = Find(s, 36);
    double error = 0.0;
    for (int l = 0, k = 0; l <= 5; ++l)
    {
      for (int m = -l; m <= l; ++m, ++k)
      {
        const double exact = l * (l + 1.0) / (radius * radius);
        error = std::max(error, std::abs(found.Eigenvalues[k] - exact));
      }
    }
    errors.push_back(error);
    EXPECT_EQ(found.Eigenvalues[0], 0.0);
    EXPECT_LT(DefectOfOrthonormality(s, found), 1e-12);
  }
  EXPECT_GT(ObservedOrder(errors[0], errors[1]), 1.9);
}

/// A block of Lanczos' method finds an eigenvalue as often as it has columns.
TEST(Eigenmodes, OfTheSameEigenvalueAreAllFound)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  CornerWeights coefficients = CotanWeights(mesh);
  std::vector<char> diffuses(static_cast<std::size_t>(mesh.NumberOfVertices()), 0);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    double height = 0.0;
    for (const Index i : mesh.TriangleVertices().row(t))
    {
      height += s.Vertices(mesh.InputVertex()[static_cast<std::size_t>(i)], 2) / 3.0;
    }
    if (height > 0.8)
    {
      coefficients.row(t).setZero();
      continue;
    }
    for (const Index i : mesh.TriangleVertices().row(t))
    {
      diffuses[static_cast<std::size_t>(i)] = 1;
    }
  }
  const auto zeros = static_cast<Index>(std::count(diffuses.begin(), diffuses.end(), 0)) + 1;
  ASSERT_GT(zeros, 150); // one for each vertex without diffusion
  const Eigenmodes found = FindEigenmodes(*assembler, coefficients, zeros + 5);
  EXPECT_LT(found.Eigenvalues[zeros - 1], 1e-9);
  EXPECT_GT(found.Eigenvalues[zeros], 1e-3);
  EXPECT_LT(DefectOfOrthonormality(s, found), 1e-10);
}

TEST(Eigenmodes, AreThoseOfTheDenseProblem)
{
  for (const Surface& s : { Strip(60, 12, 5.0, 1.0), Torus(40, 20), Disk(14), ThreeFins(15),
         Jittered(Strip(30, 20), 0.01, 0.02, 0.98, 0.03, 0.97), Moebius(60, 10) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    SparseMatrix stiffness = ZeroMatrix(assembler->Pattern());
    assembler->Fill(stiffness, Vector::Zero(mesh.NumberOfVertices()), 1.0, CotanWeights(mesh));
    const Vector roots = mesh.ControlAreas().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd dense =
      roots.asDiagonal() * Eigen::MatrixXd(stiffness) * roots.asDiagonal();
    const Vector expected = SymmetricEigenvalues(dense);
    constexpr Index count = 40;
    const Eigenmodes found = FindEigenmodes(*assembler, CotanWeights(mesh), count);
    ASSERT_GT(mesh.NumberOfVertices(), 400) << "solved by iteration";
    EXPECT_LT((found.Eigenvalues - expected.head(count)).cwiseAbs().maxCoeff(),
      1e-12 * expected.maxCoeff());
    const Values residual = stiffness * found.Modes -
      mesh.ControlAreas().asDiagonal() * found.Modes * found.Eigenvalues.asDiagonal();
    EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-6 * found.Eigenvalues[count - 1]);
    EXPECT_LT(DefectOfOrthonormality(s, found), 1e-12);
  }
}

// Each component has its own zero and the same eigenvalues: none of them is lost.
TEST(Eigenmodes, OfSeparatePartsAreFoundForEachOfThem)
{
  constexpr Index parts = 20;
  const Surface one = Icosphere(2);
  Surface all = one;
  for (Index part = 1; part < parts; ++part)
  {
    all = Joined(all, Moved(one, { 3.0 * part, 0.0, 0.0 }));
  }
  const Eigenmodes found = Find(all, 4 * parts + 1);
  const Eigenmodes ofOne = Find(one, 5);
  for (Index part = 0; part < parts; ++part)
  {
    EXPECT_EQ(found.Eigenvalues[part], 0.0);
    for (Index k = 0; k < 3; ++k)
    {
      EXPECT_NEAR(found.Eigenvalues[parts + 3 * part + k], ofOne.Eigenvalues[1], 1e-10);
    }
  }
  EXPECT_NEAR(found.Eigenvalues[4 * parts], ofOne.Eigenvalues[4], 1e-10);
  EXPECT_LT(DefectOfOrthonormality(all, found), 1e-12);
}

TEST(Eigenmodes, HaveTheSameBitsOnAnyNumberOfThreads)
{
  const Surface s = Torus(50, 30);
  const Eigenmodes expected = Find(s, 30);
  const Eigenmodes found = Find(s, 30, ThreadedFor(5));
  EXPECT_TRUE(found.Eigenvalues == expected.Eigenvalues);
  EXPECT_TRUE(found.Modes == expected.Modes);
}

TEST(Eigenmodes, HaveAPositiveLargestEntry)
{
  const Eigenmodes found = Find(Torus(50, 30), 30);
  for (Eigen::Index k = 0; k < found.Modes.cols(); ++k)
  {
    const double largest = found.Modes.col(k).cwiseAbs().maxCoeff();
    EXPECT_GE(found.Modes.col(k).maxCoeff(), (1.0 - 1e-6) * largest);
  }
}

TEST(Eigenmodes, OfALongStripAreFound)
{
  const Surface s = Strip(2000, 1, 1000.0, 0.5);
  const Eigenmodes found = Find(s, 12);
  for (Index k = 0; k < 12; ++k)
  {
    const double exact = std::pow(Pi * k / 1000.0, 2.0);
    EXPECT_NEAR(found.Eigenvalues[k], exact, 1e-3 * exact + 1e-14);
  }
}

// With 999 functions that vanish at the edge: Krylov's space ends after a few blocks.
TEST(Eigenmodes, OfTheTrianglesAtAnEdgeAreFound)
{
  const Surface s = TrianglesAtAnEdge(1000);
  const Eigenmodes found = Find(s, 10);
  for (Index k = 1; k < 10; ++k)
  {
    EXPECT_NEAR(found.Eigenvalues[k], 3.0, 1e-9);
  }
  EXPECT_LT(DefectOfOrthonormality(s, found), 1e-12);
}

// As many modes as vertices are a basis of all functions.
TEST(Eigenmodes, OfASmallSurfaceCanAllBeFound)
{
  const Surface s = Tetrahedron();
  const Eigenmodes found = Find(s, 4);
  EXPECT_EQ(found.Modes.cols(), 4);
  EXPECT_LT(DefectOfOrthonormality(s, found), 1e-12);
}
