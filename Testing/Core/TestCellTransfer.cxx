// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CellRun.h"
#include "Meshes.h"
#include "ThreadedFor.h"

#include "Core/Operators/CellTransfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace SurfaceDiffusion
{

using namespace Testing;

namespace
{

/// Random values per cell, uniform in [-1, 1).
Values RandomCells(Index count, Index columns = 1)
{
  Values values(count, columns);
  for (Index c = 0; c < count; ++c)
  {
    for (Index k = 0; k < columns; ++k)
    {
      values(c, k) = 2.0 * UniformRandom(11, k, c) - 1.0;
    }
  }
  return values;
}

/// Irregular surfaces, whose cells have one or two triangles.
struct Example
{
  Testing::Surface Shape;
  std::vector<Index> Cells;
};

std::vector<Example> Examples()
{
  std::vector<Example> examples;
  for (const Testing::Surface& shape : { Torus(20, 12), Moebius(30, 6), ThreeFins(5),
         Jittered(Plate(12, 1.0), 0.05, -0.9, 0.9, -0.9, 0.9) })
  {
    std::vector<Index> triangles(static_cast<std::size_t>(shape.NumberOfTriangles()));
    std::iota(triangles.begin(), triangles.end(), 0);
    examples.push_back({ shape, triangles });
    examples.push_back({ shape, CellsOfQuads(shape) });
  }
  return examples;
}

} // namespace

TEST(CellTransfer, WeightedMeansKeepWeightedIntegrals)
{
  for (const Example& example : Examples())
  {
    const auto mesh = MakeMesh(example.Shape);
    const Index count = example.Cells.back() + 1;
    const CellTransfer transfer(*mesh, example.Cells, count, SerialFor());
    const Values f = RandomCells(count, 2);
    Vector weights(count);
    for (Index c = 0; c < count; ++c)
    {
      weights[c] = c % 5 == 0 ? 0.0 : std::exp2(4.0 * UniformRandom(12, 0, c) - 2.0);
    }
    const VertexMeans means = transfer.ToVertices(f, weights);
    const Vector ofCells = weights.cwiseProduct(transfer.CellAreas());
    EXPECT_NEAR(means.Weights.sum(), ofCells.sum(), 1e-13 * ofCells.sum());
    for (Eigen::Index k = 0; k < 2; ++k)
    {
      EXPECT_NEAR(means.Weights.dot(means.Of.col(k)), ofCells.dot(f.col(k)), 1e-13 * ofCells.sum());
    }
  }
}

TEST(CellTransfer, KeepsConstantsAndIntegralsAndIsAdjointOnTriangles)
{
  for (const Example& example : Examples())
  {
    const auto mesh = MakeMesh(example.Shape);
    const Index count = example.Cells.back() + 1;
    const CellTransfer transfer(*mesh, example.Cells, count, SerialFor());
    const Vector ones = Vector::Ones(count);
    const Vector& vertexAreas = mesh->ControlAreas();
    const Vector& cellAreas = transfer.CellAreas();
    EXPECT_NEAR(cellAreas.sum(), vertexAreas.sum(), 1e-13 * vertexAreas.sum());

    const Values constant = Values::Constant(count, 1, 0.7);
    const Values atVertices = transfer.ToVertices(constant, ones).Of;
    EXPECT_LT((atVertices.array() - 0.7).abs().maxCoeff(), 1e-14);
    EXPECT_LT((transfer.ToCells(atVertices).array() - 0.7).abs().maxCoeff(), 1e-14);

    const Values f = RandomCells(count, 2);
    const Values u = Noise(*mesh, 2);
    const Values pf = transfer.ToVertices(f, ones).Of;
    const Values pu = transfer.ToCells(u);
    for (const Index k : { 0, 1 })
    {
      const double size = vertexAreas.sum();
      EXPECT_NEAR(vertexAreas.dot(pf.col(k)), cellAreas.dot(f.col(k)), 1e-14 * size);
      EXPECT_NEAR(cellAreas.dot(pu.col(k)), vertexAreas.dot(u.col(k)), 1e-14 * size);
      if (count == mesh->NumberOfTriangles())
      {
        EXPECT_NEAR(vertexAreas.dot(pf.col(k).cwiseProduct(u.col(k))),
          cellAreas.dot(f.col(k).cwiseProduct(pu.col(k))), 1e-14 * size);
      }
    }
  }
}

TEST(CellTransfer, KeepsTheIntegralOverGivenAreas)
{
  const Testing::Surface shape = Torus(20, 12);
  TriangleMesh mesh(shape.Vertices, shape.Faces);
  std::vector<double> factors(static_cast<std::size_t>(shape.NumberOfVertices()));
  for (std::size_t i = 0; i < factors.size(); ++i)
  {
    factors[i] = 1.0 + 0.5 * std::sin(3.0 * static_cast<double>(i));
  }
  mesh.ScaleControlAreas(factors);
  const std::vector<Index> cells = CellsOfQuads(shape);
  const CellTransfer transfer(mesh, cells, cells.back() + 1, SerialFor());
  const Values f = RandomCells(transfer.NumberOfCells());
  const Values pf = transfer.ToVertices(f, Vector::Ones(f.rows())).Of;
  const double size = mesh.ControlAreas().sum();
  EXPECT_NEAR(mesh.ControlAreas().dot(pf.col(0)), transfer.CellAreas().dot(f.col(0)), 1e-14 * size);
}

TEST(CellTransfer, ToCellsIsTheMeanOfTheLinearInterpolant)
{
  const Testing::Surface shape = Strip(8, 4);
  const auto mesh = MakeMesh(shape);
  const CellInput input(shape);
  const CellTransfer transfer(*mesh, input.Data.Cells, input.Data.NumberOfCells, SerialFor());
  Values x(mesh->NumberOfVertices(), 1);
  for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
  {
    x(i, 0) = shape.Vertices(mesh->InputVertex()[static_cast<std::size_t>(i)], 0);
  }
  const Values means = transfer.ToCells(x);
  EXPECT_LT((means.col(0) - input.Centres().col(0)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(CellTransfer, OfWeightsLeavesCellsWithoutWeightUnread)
{
  const Testing::Surface shape = Strip(8, 4);
  const auto mesh = MakeMesh(shape);
  const CellInput input(shape);
  const CellTransfer transfer(*mesh, input.Data.Cells, input.Data.NumberOfCells, SerialFor());
  Values f = Values::Constant(transfer.NumberOfCells(), 1, 2.0);
  Vector weights = Vector::Ones(transfer.NumberOfCells());
  f(5, 0) = std::numeric_limits<double>::quiet_NaN();
  weights[5] = 0.0;
  const VertexMeans means = transfer.ToVertices(f, weights);
  EXPECT_LT((means.Of.array() - 2.0).abs().maxCoeff(), 1e-15);
  EXPECT_NEAR(means.Weights.sum(), transfer.CellAreas().sum() - transfer.CellAreas()[5], 1e-14);
}

/// The numbers that the documentation gives.
TEST(CellTransfer, ThereAndBackKeepsAThirdOfWhiteNoise)
{
  const Testing::Surface shape = Icosphere(6);
  const auto mesh = MakeMesh(shape);
  const CellInput input(shape);
  const CellTransfer transfer(*mesh, input.Data.Cells, input.Data.NumberOfCells, SerialFor());
  const Values noise = RandomCells(transfer.NumberOfCells());
  const double before = Deviation(transfer.CellAreas(), noise);
  const Values pf = transfer.ToVertices(noise, Vector::Ones(noise.rows())).Of;
  EXPECT_NEAR(transfer.NoiseGain(), 1.0 / std::sqrt(6.0), 0.01);
  const ThreadedFor threads(3);
  const CellTransfer threaded(*mesh, input.Data.Cells, input.Data.NumberOfCells, threads);
  EXPECT_EQ(threaded.NoiseGain(), transfer.NoiseGain());
  EXPECT_NEAR(Deviation(mesh->ControlAreas(), pf), before * transfer.NoiseGain(), 0.005 * before);
  const Values back = transfer.ToCells(pf);
  EXPECT_NEAR(Deviation(transfer.CellAreas(), back), 0.31 * before, 0.01 * before);
  EXPECT_NEAR(Deviation(transfer.CellAreas(), noise - back), 0.87 * before, 0.01 * before);
}

} // namespace SurfaceDiffusion
