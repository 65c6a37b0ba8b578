// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/NestedDissection.h"
#include "Core/Solvers/Supernodes.h"
#include "MeshFiles.h"
#include "Meshes.h"

#include <Eigen/SparseCholesky>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Edges = std::vector<std::pair<Index, Index>>;

/// The Laplacian of the graph plus 1.
SparseMatrix MatrixOf(Index count, const Edges& edges)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < count; ++i)
  {
    entries.emplace_back(i, i, 1.0);
  }
  for (const auto& [i, j] : edges)
  {
    entries.emplace_back(i, j, -1.0);
    entries.emplace_back(j, i, -1.0);
    entries.emplace_back(i, i, 1.0);
    entries.emplace_back(j, j, 1.0);
  }
  SparseMatrix matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

SparseMatrix MatrixOf(const Surface& surface)
{
  Edges edges;
  for (const auto& corners : surface.Faces.rowwise())
  {
    for (int a = 0; a < 3; ++a)
    {
      edges.emplace_back(corners[a], corners[(a + 1) % 3]);
    }
  }
  return MatrixOf(surface.NumberOfVertices(), edges);
}

SparseMatrix Path(Index count)
{
  Edges edges;
  for (Index i = 1; i < count; ++i)
  {
    edges.emplace_back(i - 1, i);
  }
  return MatrixOf(count, edges);
}

SparseMatrix Star(Index count)
{
  Edges edges;
  for (Index i = 1; i < count; ++i)
  {
    edges.emplace_back(0, i);
  }
  return MatrixOf(count, edges);
}

SparseMatrix Complete(Index count)
{
  Edges edges;
  for (Index i = 0; i < count; ++i)
  {
    for (Index j = 0; j < i; ++j)
    {
      edges.emplace_back(i, j);
    }
  }
  return MatrixOf(count, edges);
}

/// Entries of the factor of the matrix with its rows at these places.
Eigen::Index EntriesOfFactor(const SparseMatrix& matrix, const std::vector<Index>& places)
{
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> order(matrix.rows());
  std::copy(places.begin(), places.end(), order.indices().data());
  SparseMatrix ordered;
  ordered = matrix.twistedBy(order);
  const Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<Index>> factor(
    ordered);
  return SparseMatrix(factor.matrixL()).nonZeros();
}

/// Of a factorisation.
double Operations(const Supernodes& nodes)
{
  return std::accumulate(nodes.Operations.begin(), nodes.Operations.end(), 0.0);
}

} // namespace

TEST(NestedDissection, GivesEveryRowOfAnyGraphAPlace)
{
  const std::vector<SparseMatrix> matrices = { MatrixOf(1, {}), MatrixOf(1000, {}), Path(1000),
    Star(1000), Complete(300), MatrixOf(Icosphere(4)),
    MatrixOf(Joined(Icosphere(4), Torus(40, 30))) };
  for (const SparseMatrix& matrix : matrices)
  {
    std::vector<Index> places = NestedDissection(matrix);
    std::sort(places.begin(), places.end());
    std::vector<Index> all(static_cast<std::size_t>(matrix.rows()));
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(places, all);
  }
}

TEST(NestedDissection, OrdersSmallComponentsAsEachAlone)
{
  const Surface torus = Torus(12, 10);
  const Surface one = Renumbered(torus, Permutation(torus.NumberOfVertices(), 3));
  const Surface four = Joined(Joined(one, one), Joined(one, one));
  const SparseMatrix alone = MatrixOf(one);
  const SparseMatrix all = MatrixOf(four);
  EXPECT_EQ(EntriesOfFactor(all, NestedDissection(all)),
    4 * EntriesOfFactor(alone, NestedDissection(alone)));
}

TEST(NestedDissection, FactorsRegularTriangulationsWithFewerEntriesThanMinimumDegree)
{
  // numbered along a Hilbert curve, as all matrices of this library are
  const auto assembler = MakeAssembler(Icosphere(6));
  SparseMatrix matrix = ZeroMatrix(assembler->Pattern());
  assembler->Fill(matrix, assembler->Mesh().ControlAreas(), 1.0, CotanWeights(assembler->Mesh()));
  const Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<Index>> byDegree(
    matrix);
  const double entries = static_cast<double>(SparseMatrix(byDegree.matrixL()).nonZeros());
  EXPECT_LT(EntriesOfFactor(matrix, NestedDissection(matrix)), 0.85 * entries);
}

/// A factor of a separated graph has O(n log n) entries.
TEST(NestedDissection, EntriesGrowAsTheSizeTimesItsLogarithm)
{
  const auto share = [](int subdivisions)
  {
    const SparseMatrix matrix = MatrixOf(Icosphere(subdivisions));
    const double n = static_cast<double>(matrix.rows());
    return static_cast<double>(EntriesOfFactor(matrix, NestedDissection(matrix))) /
      (n * std::log(n));
  };
  EXPECT_LT(share(6), 1.15 * share(4));
}

TEST(NestedDissection, IsForRegularTriangulations)
{
  EXPECT_TRUE(IsRegular(MatrixOf(Icosphere(4))));
  EXPECT_FALSE(IsRegular(MatrixOf(Icosphere(2)))); // 12 of 162 vertices have five neighbours
  EXPECT_FALSE(IsRegular(Path(1000)));
}

/// Regular as an icosphere, but the levels of the search are ragged.
TEST(Supernodes, TakeTheOrderOfFewerOperationsOnSubdividedScans)
{
  const SparseMatrix matrix = MatrixOf(Subdivided(ReadMeshFile("cactus"), 3));
  EXPECT_TRUE(IsRegular(matrix));
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> order;
  Eigen::AMDOrdering<Index>()(matrix, order);
  order = order.inverse().eval();
  const Supernodes byDegree(
    matrix, std::vector<Index>(order.indices().data(), order.indices().data() + matrix.rows()));
  EXPECT_LE(Operations(OrderedSupernodes(matrix, true)), Operations(byDegree));
  EXPECT_LT(Operations(byDegree), 0.8 * Operations(Supernodes(matrix, NestedDissection(matrix))));
}

TEST(Supernodes, TakeNestedDissectionOnIcospheres)
{
  const SparseMatrix matrix = MatrixOf(Icosphere(5));
  EXPECT_EQ(Operations(OrderedSupernodes(matrix, true)),
    Operations(Supernodes(matrix, NestedDissection(matrix))));
}
