// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/ChromaticityBrightness.h"
#include "Core/Models/Harmonic/UnitVectors.h"
#include "Core/Models/OpponentColors.h"
#include "EveryMeshFile.h"
#include "HarmonicMaps.h"
#include "Heat.h"
#include "TotalVariation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Times and weights in coordinate units, and values in R.
struct ColorSettings
{
  double TimeStep = 0.0; ///< 0: steady
  double Fidelity = 0.0;
  double Weight = 1.0; ///< mu
  double Exponent = 1.0;
  double Range = 1.0; ///< R
  bool Lagged = false;
  double Tolerance = 1e-6;
  double Beta = 1e-6; ///< in (R/h)^2
};

std::unique_ptr<ChromaticityBrightness> MakeColors(std::shared_ptr<const Assembler> assembler,
  PointData data, const ColorSettings& settings, const ParallelFor& parallel = SerialFor())
{
  const TriangleMesh& mesh = assembler->Mesh();
  const double unit = mesh.LengthUnit();
  const double r = settings.Range;
  const bool steady = settings.TimeStep == 0.0;
  const double timeStep = steady ? 1e3 * MeanEdge(mesh) * unit * r : settings.TimeStep;
  const double fidelity = settings.Fidelity / r;
  const double beta = r * r * settings.Beta;
  const double weight = r * settings.Weight * std::pow(unit, 1.0 - settings.Exponent);

  ChromaticityBrightness::Settings options;
  options.Fidelity = fidelity * unit;
  options.ChromaticityWeight = weight;
  options.SteadyState = steady;
  options.StopTolerance = settings.Tolerance;
  const auto makeBrightness = [&](PointData brightness) -> std::unique_ptr<DataModel>
  {
    const std::shared_ptr<LinearSolver> solver = MakeConjugateGradientSolver(parallel);
    solver->SetLimits({ settings.Tolerance, 10000 });
    if (settings.Lagged)
    {
      auto lagged = LaggedSettings(mesh, timeStep, fidelity, beta);
      lagged.ConservesTotal = fidelity == 0.0;
      return MakeLagged(assembler, std::move(brightness), lagged, solver, parallel);
    }
    auto exact = ExactSettings(mesh, timeStep, fidelity, settings.Tolerance);
    exact.ConservesTotal = fidelity == 0.0;
    return MakeExact(assembler, std::move(brightness), exact, parallel);
  };
  const auto makeChromaticity = [&](PointData chromaticity)
  {
    HarmonicMap::Settings map;
    map.Exponent = settings.Exponent;
    map.TimeStep = timeStep / unit * weight / (r * r);
    map.Beta = settings.Beta / (MeanEdge(mesh) * MeanEdge(mesh));
    map.Fidelity = options.Fidelity / weight;
    map.Limits = { settings.Tolerance, 10000 };
    return MakeMap(assembler, std::move(chromaticity), map, MakeCholeskySolver(parallel), parallel);
  };
  return std::make_unique<ChromaticityBrightness>(
    assembler, std::move(data), options, makeBrightness, makeChromaticity, parallel);
}

/// Colours from 0 to 1 in smooth patches with noise.
Values Patches(const TriangleMesh& mesh, const Surface& s, double noise)
{
  Values u(mesh.NumberOfVertices(), 3);
  const Values x = Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[0]; });
  const Values y = Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[1]; });
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    u.row(i) =
      x(i, 0) > 0.0 ? Eigen::RowVector3d(0.8, 0.2, 0.1) : Eigen::RowVector3d(0.2, 0.5, 0.9);
    u.row(i) *= y(i, 0) > 0.2 ? 1.0 : 0.4;
  }
  return u + noise * Noise(mesh, 3);
}

/// |B C - f|^2 and the rest, without the sums that the model shares with its parts.
double DirectEnergy(const ChromaticityBrightness& model, const Assembler& assembler,
  const PointData& data, const ColorSettings& settings)
{
  const TriangleMesh& mesh = assembler.Mesh();
  const double unit = mesh.LengthUnit();
  double energy = 0.0;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    energy += 0.5 * settings.Fidelity * unit * data.FidelityFactor(i) * mesh.ControlAreas()[i] *
      (model.Brightness()(i, 0) * model.Chromaticity().row(i) - data.Given.row(i)).squaredNorm();
  }
  const double beta = settings.Beta / (MeanEdge(mesh) * MeanEdge(mesh));
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    const auto v = mesh.TriangleVertices().row(t);
    const auto square = [&](const Values& u)
    {
      double sum = 0.0;
      for (Eigen::Index k = 0; k < u.cols(); ++k)
      {
        sum += Gradient(mesh.Shapes()[t], u(v[0], k), u(v[1], k), u(v[2], k)).squaredNorm();
      }
      return sum;
    };
    energy += mesh.Shapes()[t].Area() *
      (std::sqrt(square(model.Brightness())) +
        settings.Weight * (std::sqrt(square(model.Chromaticity()) + beta) - std::sqrt(beta)));
  }
  return energy;
}

} // namespace

TEST(ChromaticityBrightness, GreyDataKeepTheirChromaticityAndTheirBrightnessIsTheScalarRun)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values grey = Cap(mesh, s, 1.0) + 0.2 * Noise(mesh) + Values::Constant(2562, 1, 0.5);
  const Values colors = grey.replicate(1, 3);
  for (const bool lagged : { false, true })
  {
    ColorSettings settings;
    settings.TimeStep = 0.02;
    settings.Fidelity = 5.0;
    settings.Lagged = lagged;
    settings.Tolerance = lagged ? 1e-12 : 1e-6; // for which the minimiser uses double precision
    const auto model = MakeColors(assembler, PointData::FromValues(colors), settings);
    std::unique_ptr<Model> scalar;
    const PointData data = PointData::FromValues(std::sqrt(3.0) * grey);
    if (lagged)
    {
      scalar = MakeLagged(assembler, data, LaggedSettings(mesh, 0.02, 5.0));
    }
    else
    {
      auto exact = ExactSettings(mesh, 0.02, 5.0, settings.Tolerance);
      exact.ConservesTotal = false;
      scalar = MakeExact(assembler, data, exact);
    }
    Advance(*model, 4);
    Advance(*scalar, 4);
    EXPECT_LT((model->Chromaticity().array() - 1.0 / std::sqrt(3.0)).abs().maxCoeff(), 1e-12);
    EXPECT_LT((model->Brightness() - scalar->State()).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_NEAR(model->Energy(), scalar->Energy(), 1e-9 * scalar->Energy());
  }
}

TEST(ChromaticityBrightness, GreySteadyStateIsTheScalarMinimiser)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values grey = Cap(mesh, s, 1.0) + Values::Constant(2562, 1, 0.5);
  ColorSettings settings;
  settings.Fidelity = 5.0;
  settings.Tolerance = 1e-5;
  const auto model = MakeColors(assembler, PointData::FromValues(grey.replicate(1, 3)), settings);
  const auto scalar = MakeExact(
    assembler, PointData::FromValues(std::sqrt(3.0) * grey), ExactSettings(mesh, 0.0, 5.0, 1e-5));
  Advance(*model, 1);
  Advance(*scalar, 1);
  EXPECT_LT((model->Chromaticity().array() - 1.0 / std::sqrt(3.0)).abs().maxCoeff(), 1e-12);
  EXPECT_LT(RootMeanSquare(mesh, model->Brightness() - scalar->State()), 1e-3);
  EXPECT_LT(model->Energy(), (1.0 + 1e-4) * scalar->Energy());
}

TEST(ChromaticityBrightness, HueOnAGreatCircleFollowsTotalVariationFlow)
{
  // psi of C = (cos psi, sin psi, 0) at B = 1 is a cap of height 1. P1 finds its edge 5 % too long.
  const double angle = Pi / 3.0;
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values colors = SampleGreatCircle(mesh, s,
    [&](const Eigen::RowVector3d& x) { return std::acos(x[2] / x.norm()) < angle ? 1.0 : 0.0; });
  for (const double mu : { 1.0, 2.0 })
  {
    ColorSettings settings;
    settings.TimeStep = 0.2 / 32 / mu;
    settings.Weight = mu;
    settings.Tolerance = 1e-4;
    const auto model = MakeColors(assembler, PointData::FromValues(colors), settings);
    Advance(*model, 32);
    EXPECT_LT((model->Brightness().array() - 1.0).abs().maxCoeff(), 1e-12);
    // It is the harmonic map flow itself.
    HarmonicMap::Settings map = MapSettings(
      mesh, 1.0, 0.2 / 32, settings.Beta / std::pow(MeanEdge(mesh) * mesh.LengthUnit(), 2));
    map.Limits = { settings.Tolerance, 10000 };
    const auto alone = MakeMap(assembler, PointData::FromValues(colors), map);
    Advance(*alone, 32);
    EXPECT_LT((model->Chromaticity() - alone->State()).cwiseAbs().maxCoeff(), 1e-9);
    const Plateaus found = MeasurePlateaus(mesh, s, Angles(model->Chromaticity()), angle);
    EXPECT_LT(PlateauError(found, ExactPlateaus(angle, 0.2)), 0.05);
  }
}

TEST(ChromaticityBrightness, PowersOfTwoOfTheValuesKeepEveryBitOfTheChromaticity)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values colors = Patches(mesh, s, 0.2);
  for (const bool lagged : { false, true })
  {
    ColorSettings settings;
    settings.Fidelity = 5.0;
    settings.Lagged = lagged;
    settings.Tolerance = 1e-3;
    const auto run = [&](double factor)
    {
      settings.Range = factor;
      settings.TimeStep = 0.05 * factor;
      auto model = MakeColors(assembler, PointData::FromValues(factor * colors), settings);
      Advance(*model, 3);
      return model;
    };
    const auto one = run(1.0);
    for (const double factor : { 256.0, 1.0 / 64.0 })
    {
      const auto scaled = run(factor);
      EXPECT_TRUE(scaled->Chromaticity() == one->Chromaticity());
      EXPECT_TRUE(scaled->State() == factor * one->State());
    }
  }
}

TEST(ChromaticityBrightness, EnergyIsThatOfTheColours)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Patches(mesh, s, 0.3));
  data.Missing.head(30) = true;
  data.FidelityFactors = Noise(mesh).cwiseAbs();
  data.Given.row(100).setZero();
  ColorSettings settings;
  settings.TimeStep = 0.05;
  settings.Fidelity = 7.0;
  settings.Weight = 0.6;
  const auto model = MakeColors(assembler, data, settings);
  for (int step = 0; step < 3; ++step)
  {
    const double direct = DirectEnergy(*model, *assembler, data, settings);
    EXPECT_NEAR(model->Energy(), direct, 1e-12 * direct) << step;
    Advance(*model, 1);
  }
}

TEST(ChromaticityBrightness, JointEnergyFallsOnAnyMesh)
{
  ForEachMeshFile(
    [](const Surface& surface)
    {
      const auto assembler = MakeAssembler(surface);
      const TriangleMesh& mesh = assembler->Mesh();
      PointData data = PointData::FromValues(
        0.5 * Noise(mesh, 3) + Values::Constant(mesh.NumberOfVertices(), 3, 0.3));
      data.Missing.head(mesh.NumberOfVertices() / 20) = true;
      const double h = MeanEdge(mesh) * mesh.LengthUnit();
      for (const bool lagged : { true, false })
      {
        for (const double timeStep : { 0.5 * h, 1e3 * h })
        {
          ColorSettings settings;
          settings.TimeStep = timeStep;
          settings.Fidelity = 2.0 / h;
          settings.Lagged = lagged;
          settings.Tolerance = 1e-2;
          const auto model = MakeColors(assembler, data, settings);
          for (int step = 0; step < 3; ++step)
          {
            const double energy = model->Energy();
            Advance(*model, 1);
            EXPECT_LE(model->Energy() - energy, 1e-12 * energy) << step;
            EXPECT_GE(model->Brightness().minCoeff(), 0.0);
          }
          EXPECT_LT(LargestLengthError(model->Chromaticity()), 1e-12);
        }
      }
    });
}

TEST(ChromaticityBrightness, SteadyStateIsStationaryAndBelowManySteps)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Patches(mesh, s, 0.2));
  ColorSettings settings;
  settings.Fidelity = 50.0;
  settings.Tolerance = 1e-4;
  const auto steady = MakeColors(assembler, data, settings);
  const StepReport report = steady->Advance(ProgressMonitor());
  EXPECT_LE(report.Residual, 1e-4);
  const double energy = steady->Energy();
  settings.TimeStep = 0.02;
  const auto flow = MakeColors(assembler, data, settings);
  Advance(*flow, 30);
  std::printf("energy %.6f steady, %.6f after 30 steps, %d iterations\n", energy, flow->Energy(),
    report.Iterations);
  EXPECT_LT(energy, flow->Energy() * (1.0 + 1e-3));
  EXPECT_LT(RootMeanSquare(mesh, steady->State() - flow->State()), 0.01);
  // Chromaticity is closer to that without noise than the data are.
  const Values clean = Patches(mesh, s, 0.0);
  EXPECT_LT(
    RootMeanSquare(mesh, steady->State() - clean), 0.4 * RootMeanSquare(mesh, data.Given - clean));
}

TEST(ChromaticityBrightness, BlackVerticesTakeTheChromaticityAroundThem)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Eigen::RowVector3d color(0.6, 0.3, 0.2);
  Values colors = Values::Constant(mesh.NumberOfVertices(), 3, 0.0);
  const Values cap = Cap(mesh, s, 2.5);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    colors.row(i) = cap(i, 0) * color;
  }
  ColorSettings settings;
  settings.TimeStep = 0.1;
  settings.Fidelity = 1.0;
  const auto model = MakeColors(assembler, PointData::FromValues(colors), settings);
  EXPECT_TRUE(model->State() == colors);
  Advance(*model, 3);
  const Values away = model->Chromaticity().rowwise() - color.normalized();
  EXPECT_LT(away.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT(model->State().minCoeff(), 0.01); // brightness has spread
}

TEST(ChromaticityBrightness, SteadyStateWithoutConditionsIsTheMean)
{
  const Surface s = Joined(Icosphere(2), Moved(Icosphere(2), { 5.0, 0.0, 0.0 }));
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values colors = Patches(mesh, s, 0.1);
  const auto model = MakeColors(assembler, PointData::FromValues(colors), ColorSettings());
  Advance(*model, 1);
  for (Eigen::Index k = 0; k < 3; ++k)
  {
    EXPECT_NEAR(Total(mesh, model->State(), k), Total(mesh, colors, k), 1e-12);
  }
  EXPECT_NEAR(model->Energy(), 0.0, 1e-12);
}

TEST(ChromaticityBrightness, RotationsOfColourSpaceCommute)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const Values colors = Patches(assembler->Mesh(), s, 0.1);
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(1.0, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  ColorSettings settings;
  settings.TimeStep = 0.02;
  settings.Fidelity = 5.0;
  settings.Lagged = true;
  settings.Tolerance = 1e-12;
  const auto a = MakeColors(assembler, PointData::FromValues(colors), settings);
  const auto b = MakeColors(assembler, PointData::FromValues(colors * turn), settings);
  Advance(*a, 3);
  Advance(*b, 3);
  EXPECT_LT((a->State() * turn - b->State()).cwiseAbs().maxCoeff(), 1e-9);
}

namespace
{

/// A minimising or lagged model of colours, with the fidelity of colour weighted.
std::unique_ptr<Model> MakeOpponent(std::shared_ptr<const Assembler> assembler,
  const PointData& data, double chromaWeight, bool lagged, double timeStep, bool opponent = true,
  ChannelCoupling coupling = ChannelCoupling::Joint, double tolerance = 1e-6)
{
  const TriangleMesh& mesh = assembler->Mesh();
  const auto make = [&](PointData channels) -> std::unique_ptr<Model>
  {
    const std::vector<double> weights = chromaWeight == 1.0
      ? std::vector<double>()
      : std::vector<double>{ 1.0, chromaWeight, chromaWeight };
    if (lagged)
    {
      auto settings = LaggedSettings(mesh, timeStep, 5.0);
      settings.Coupling = coupling;
      settings.ChannelWeights = weights;
      return MakeLagged(assembler, std::move(channels), settings);
    }
    auto settings = ExactSettings(mesh, timeStep, 5.0, tolerance);
    settings.Coupling = coupling;
    settings.ChannelWeights = weights;
    return MakeExact(assembler, std::move(channels), settings);
  };
  return opponent ? std::make_unique<OpponentColors>(data, make) : make(data);
}

} // namespace

TEST(OpponentColors, WithChromaWeightOneAreJointTotalVariation)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Patches(mesh, s, 0.2));
  data.Fixed.tail(20) = true;
  data.Missing.head(20) = true;
  for (const bool lagged : { false, true })
  {
    for (const double timeStep : { 0.0, 0.05 })
    {
      if (lagged && timeStep == 0.0)
      {
        continue;
      }
      const auto make = [&](bool isOpponent)
      {
        return MakeOpponent(
          assembler, data, 1.0, lagged, timeStep, isOpponent, ChannelCoupling::Joint, 1e-10);
      };
      const auto opponent = make(true);
      const auto rgb = make(false);
      EXPECT_TRUE(opponent->State() == data.Start);
      Advance(*opponent, 2);
      Advance(*rgb, 2);
      EXPECT_LT(RootMeanSquare(mesh, opponent->State() - rgb->State()), lagged ? 1e-10 : 1e-4);
      EXPECT_NEAR(opponent->Energy(), rgb->Energy(), 1e-7 * rgb->Energy());
      EXPECT_TRUE(opponent->State().bottomRows(20) == data.Start.bottomRows(20));
    }
  }
}

TEST(OpponentColors, ChromaWeightIsTheFidelityWeightOfTheAxesOfColour)
{
  // Per channel each axis is a scalar problem with its own lambda.
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Patches(mesh, s, 0.2));
  const double chroma = 0.25;
  for (const bool lagged : { false, true })
  {
    const auto model =
      MakeOpponent(assembler, data, chroma, lagged, 0.05, true, ChannelCoupling::PerChannel);
    Advance(*model, 2);
    const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -1.0, 0.0) / std::sqrt(2.0);
    const PointData redGreen = PointData::FromValues(data.Given * axis);
    std::unique_ptr<Model> scalar;
    if (lagged)
    {
      scalar = MakeLagged(assembler, redGreen, LaggedSettings(mesh, 0.05, 5.0 * chroma));
    }
    else
    {
      scalar = MakeExact(assembler, redGreen, ExactSettings(mesh, 0.05, 5.0 * chroma, 1e-6));
    }
    Advance(*scalar, 2);
    EXPECT_LT((model->State() * axis - scalar->State()).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(OpponentColors, WeightedJointMinimumIsCertifiedAndTheLimitOfTimeSteps)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Patches(mesh, s, 0.2));
  data.Missing.head(20) = true;
  data.Fixed.tail(20) = true;
  const auto steady = MakeOpponent(assembler, data, 0.25, false, 0.0);
  const StepReport report = steady->Advance(ProgressMonitor());
  EXPECT_LE(report.Residual, 1e-6);
  const auto flow = MakeOpponent(assembler, data, 0.25, false, 1.0);
  Advance(*flow, 40);
  EXPECT_LT(RootMeanSquare(mesh, steady->State() - flow->State()), 1e-3);
  const auto lagged = MakeOpponent(assembler, data, 0.25, true, 1.0);
  double energy = lagged->Energy();
  for (int step = 0; step < 60; ++step)
  {
    Advance(*lagged, 1);
    EXPECT_LE(lagged->Energy() - energy, 1e-12 * energy);
    energy = lagged->Energy();
  }
  EXPECT_NEAR(energy, steady->Energy(), 0.01 * steady->Energy());
}

TEST(OpponentColors, KeepTheTotalsOfColours)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData data = PointData::FromValues(Patches(mesh, s, 0.2));
  for (const bool lagged : { false, true })
  {
    const auto model = MakeOpponent(assembler, data, 0.25, lagged, 0.05);
    Advance(*model, 3);
    for (Eigen::Index k = 0; k < 3; ++k)
    {
      const double total = Total(mesh, data.Given, k);
      EXPECT_NEAR(Total(mesh, model->State(), k), total, 1e-12 * std::abs(total));
    }
  }
}
