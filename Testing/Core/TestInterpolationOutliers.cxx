// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Values that others contradict, and the fit without each value.
#include "Core/Models/Interpolation/InterpolationModel.h"
#include "Core/Models/Interpolation/Outliers.h"
#include "Interpolation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <utility>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

double Waves(const Eigen::RowVector3d& x)
{
  return std::sin(2.0 * x[0]) + 0.5 * std::cos(3.0 * x[1]) * x[2];
}

/// Values of a field at places in triangles, with noise of this deviation.
ScatteredValues NoisyValues(
  const TriangleMesh& mesh, const Values& field, Index count, double noise, int seed)
{
  ScatteredValues data = ValuesInTriangles(mesh, field, count, seed);
  for (Index i = 0; i < count; ++i)
  {
    data.Given(i, 0) += noise * Gaussian(seed, 7, i);
  }
  return data;
}

struct RobustFit
{
  Values U;
  double LeftOut = 0.0;
};

RobustFit FitRobustly(
  const std::shared_ptr<const Assembler>& assembler, const ScatteredValues& data)
{
  InterpolationModel model(assembler, CotanWeights(assembler->Mesh()), data,
    InterpolationSettings(Choice::Automatic), SerialFor(), true);
  model.Advance(ProgressMonitor());
  return { model.State(), model.Outliers().sum() };
}

} // namespace

/// A tenth of the values are replaced by others of the range.
TEST(InterpolationOutliers, WrongValuesAreLeftOut)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field = Sample(mesh, s, Waves);
  const auto error = [&](const Values& u) { return std::pow(RootMeanSquare(mesh, u - field), 2); };
  const Interpolation::Settings settings = InterpolationSettings(Choice::Automatic);
  double robust = 0.0;
  double without = 0.0;
  double all = 0.0;
  for (const Index count : { 60, 150, 500 })
  {
    for (int seed = 1; seed <= 4; ++seed)
    {
      const Index wrong = count / 10;
      ScatteredValues data = NoisyValues(mesh, field, count, 0.03, seed);
      ScatteredValues clean;
      clean.Places.assign(data.Places.begin() + wrong, data.Places.end());
      clean.Given = data.Given.bottomRows(count - wrong);
      clean.Weights = Vector::Ones(count - wrong);
      for (Index i = 0; i < wrong; ++i)
      {
        data.Given(i, 0) = -1.5 + 3.0 * UniformRandom(seed, 9, i);
      }
      robust += error(FitRobustly(assembler, data).U);
      without += error(Interpolate(assembler, clean, settings).U);
      all += error(Interpolate(assembler, data, settings).U);
    }
  }
  std::printf("error over that without wrong values: robust %.3f, otherwise %.2f\n",
    std::sqrt(robust / without), std::sqrt(all / without));
  EXPECT_LT(robust, 1.1 * 1.1 * without);
  EXPECT_GT(all, 9.0 * robust);
}

TEST(InterpolationOutliers, CleanValuesStay)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field = Sample(mesh, s, Waves);
  double leftOut = 0.0;
  double values = 0.0;
  for (const double noise : { 0.02, 0.05, 0.5 })
  {
    for (const Index count : { 8, 20, 60, 400 })
    {
      for (int seed = 1; seed <= 5; ++seed)
      {
        leftOut += FitRobustly(assembler, NoisyValues(mesh, field, count, noise, seed)).LeftOut;
        values += count;
      }
    }
  }
  std::printf("%g of %g values left out\n", leftOut, values);
  EXPECT_LE(leftOut, 0.002 * values);
}

TEST(InterpolationOutliers, LeaveOneOutIsTheFitWithoutTheValue)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field = Sample(mesh, s, Waves);
  ScatteredValues few = NoisyValues(mesh, field, 40, 0.1, 1);
  few.Weights[3] = 4.0;
  few.Places[5] = few.Places[6]; // repeats
  for (const bool areMany : { false, true })
  {
    const ScatteredValues data = areMany ? NoisyValues(mesh, field, 400, 0.1, 2) : few;
    Interpolation::Settings settings = InterpolationSettings(Choice::Automatic);
    settings.ComputeLeverage = true;
    const Interpolation::Result fit = Interpolate(assembler, data, settings);
    const Values residuals = ResidualsOf(data, fit.U);
    settings = InterpolationSettings(Choice::Given, fit.Columns[0].Mu);
    for (const Index i : { 0, 3, 5, 20 })
    {
      ScatteredValues others = data;
      others.Places.erase(others.Places.begin() + i);
      others.Given.resize(data.Count() - 1, 1);
      others.Weights.resize(data.Count() - 1);
      for (Index k = 0; k + 1 < data.Count(); ++k)
      {
        others.Given(k, 0) = data.Given(k < i ? k : k + 1, 0);
        others.Weights[k] = data.Weights[k < i ? k : k + 1];
      }
      const double expected = ResidualsOf(data, Interpolate(assembler, others, settings).U)(i, 0);
      EXPECT_NEAR(residuals(i, 0) / (1.0 - fit.Leverage(i, 0)), expected, 1e-7) << i;
    }
  }
}

TEST(InterpolationOutliers, AreCountedUnlessNoiseHasAsMany)
{
  const Surface s = Icosphere(4);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values field = Sample(mesh, s, Waves);
  Index warned = 0;
  for (int seed = 1; seed <= 40; ++seed)
  {
    ScatteredValues data = NoisyValues(mesh, field, 200, 0.1, seed);
    const auto count = [&]
    {
      const Values u = Interpolate(assembler, data, InterpolationSettings(Choice::Automatic)).U;
      return CountOutliers(data, ResidualsOf(data, u), 0);
    };
    warned += count() > 0;
    data.Given(17, 0) += 3.0;
    EXPECT_GE(count(), 1) << seed;
  }
  EXPECT_LE(warned, 3);
}
