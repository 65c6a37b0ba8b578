// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/InitialState.h"
#include "Core/Operators/MeanCorrection.h"
#include "HarmonicMaps.h"
#include "Heat.h"
#include "TotalVariation.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using ModelOf = std::function<std::unique_ptr<Model>(
  const std::shared_ptr<const Assembler>&, PointData, double fidelity)>;

/// Every model with a fidelity term.
std::vector<ModelOf> AllModels()
{
  return {
    [](const auto& assembler, PointData data, double fidelity) {
      return MakeHeat(assembler, std::move(data), { 0.01, fidelity, Scheme::SDIRK2 });
    },
    [](const auto& assembler, PointData data, double fidelity) {
      return MakeHeat(assembler, std::move(data), { 0.01, fidelity, Scheme::SteadyState });
    },
    [](const auto& assembler, PointData data, double fidelity)
    {
      return MakeLagged(
        assembler, std::move(data), LaggedSettings(assembler->Mesh(), 0.01, fidelity));
    },
    [](const auto& assembler, PointData data, double fidelity) {
      return MakeExact(assembler, std::move(data), ExactSettings(assembler->Mesh(), 0.0, fidelity));
    },
    [](const auto& assembler, PointData data, double fidelity)
    {
      auto settings = ExactSettings(assembler->Mesh(), 0.0, fidelity);
      settings.Norm = FidelityNorm::L1;
      return MakeExact(assembler, std::move(data), settings);
    },
    [](const auto& assembler, PointData data, double fidelity)
    {
      return MakeOnEdges(
        assembler, std::move(data), ExactSettings(assembler->Mesh(), 0.01, fidelity));
    },
    [](const auto& assembler, PointData data, double fidelity)
    {
      auto settings = MapSettings(assembler->Mesh(), 1.0, 0.01);
      settings.Fidelity = fidelity;
      return MakeMap(assembler, std::move(data), settings);
    },
  };
}

Values Advanced(std::unique_ptr<Model> model)
{
  Advance(*model, 2);
  return model->State();
}

PointData UnitVectorsOf(const TriangleMesh& mesh)
{
  return PointData::FromValues(RandomUnitVectors(mesh, 2));
}

Vector Height(const TriangleMesh& mesh, const Surface& s)
{
  Vector z(mesh.NumberOfVertices());
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    z[i] = s.Vertices(mesh.InputVertex()[i], 2);
  }
  return z;
}

} // namespace

TEST(FidelityFactors, TwoEverywhereIsTwiceTheFidelityWeight)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const PointData plain = UnitVectorsOf(assembler->Mesh());
  PointData weighted = plain;
  weighted.FidelityFactors = Vector::Constant(plain.Start.rows(), 2.0);
  std::size_t number = 0;
  for (const ModelOf& make : AllModels())
  {
    const Values expected = Advanced(make(assembler, plain, 6.0));
    EXPECT_EQ(Advanced(make(assembler, weighted, 3.0)), expected) << number;
    EXPECT_NE(Advanced(make(assembler, plain, 3.0)), expected) << number;
    ++number;
  }
}

TEST(FidelityFactors, ZeroHasTheEffectOfMissingDataThatStartFromTheInput)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  PointData missing = UnitVectorsOf(assembler->Mesh());
  PointData weighted = missing;
  missing.Missing.segment(10, 20) = true;
  weighted.FidelityFactors = Vector::Ones(missing.Start.rows());
  weighted.FidelityFactors.segment(10, 20).setZero();
  std::size_t number = 0;
  for (const ModelOf& make : AllModels())
  {
    EXPECT_EQ(Advanced(make(assembler, weighted, 3.0)), Advanced(make(assembler, missing, 3.0)))
      << number++;
  }
}

TEST(FidelityFactors, VaryingFidelityConvergesWithSecondOrder)
{
  // On the unit sphere, -Lap z = 2 z, so that z solves lambda w (f - u) + Lap u = 0 for these f.
  const double lambda = 3.0;
  std::vector<double> errors;
  for (const int level : { 3, 4, 5 })
  {
    const Surface sphere = Icosphere(level);
    const auto assembler = MakeAssembler(sphere);
    const Vector z = Height(assembler->Mesh(), sphere);
    const Vector w = 0.5 + z.array().square();
    PointData data = PointData::FromValues(z.array() * (1.0 + 2.0 / (lambda * w.array())));
    data.FidelityFactors = w;
    const auto settings =
      HeatSettings(assembler->Mesh(), 1.0, lambda, LinearDiffusion::Scheme::SteadyState);
    const auto heat = MakeHeat(assembler, data, settings);
    Advance(*heat, 1);
    const Vector& areas = assembler->Mesh().ControlAreas();
    const Vector squares = (heat->State().col(0) - z).array().square();
    errors.push_back(std::sqrt(areas.dot(squares) / areas.sum()));
  }
  EXPECT_LT(errors[2], 1e-3);
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.8);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.8);
}

TEST(FidelityFactors, OnlyEqualFactorsConserveTheTotal)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Noise(mesh));
  const double total = Total(mesh, data.Start, 0);
  data.FidelityFactors = Vector::Constant(mesh.NumberOfVertices(), 0.5);
  const LinearDiffusion::Settings settings = { 0.01, 3.0, Scheme::SDIRK2 };
  EXPECT_NEAR(Total(mesh, Advanced(MakeHeat(assembler, data, settings)), 0), total, 1e-13);
  data.FidelityFactors.head(20).setConstant(5.0);
  EXPECT_GT(std::abs(Total(mesh, Advanced(MakeHeat(assembler, data, settings)), 0) - total), 1e-6);
}

TEST(FidelityFactors, ComponentsWithoutPositiveFactorEndAtTheirMean)
{
  const auto mesh = MakeMesh(Joined(Disk(4), Icosphere(2)));
  PointData data = PointData::FromValues(Noise(*mesh));
  const Index second = mesh->ComponentsBegin()[1];
  data.FidelityFactors = Vector::Ones(mesh->NumberOfVertices());
  data.FidelityFactors.head(second).setZero();
  FixFreeComponents(*mesh, data, 1.0);
  EXPECT_TRUE(data.Fixed.head(second).all());
  EXPECT_FALSE(data.Fixed.tail(mesh->NumberOfVertices() - second).any());
}
