// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Heat.h"
#include "Meshes.h"

#include "Core/Statistics/RiskDirections.h"
#include "Core/Statistics/UnbiasedRisk.h"
#include "Core/Statistics/WeightSearch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// A smoother that keeps q(k) = w/(w + k) of mode k = 1 to 100, of which the signal has 1/k^2, under
/// noise of deviation 1 as it is on average.
NoiseResponse Smoothed(double weight, double signal)
{
  NoiseResponse found;
  found.Direction = 1.0;
  for (int k = 1; k <= 100; ++k)
  {
    const double kept = weight / (weight + k * k);
    const double power = signal * signal / std::pow(k, 4);
    found.MeanSquare += 0.01 * (1.0 - kept) * (1.0 - kept) * (power + 1.0);
    found.Freedom += 0.01 * kept;
    found.Removed += 0.01 * (1.0 - kept) * (1.0 - kept);
  }
  return found;
}

double ErrorOf(double weight, double signal)
{
  const NoiseResponse found = Smoothed(weight, signal);
  return found.Risk(1.0) - 1.0; // E (u - f)^2 + 2 E u noise - 1
}

} // namespace

TEST(WeightSearch, FindsTheWeightThatLeavesTheNoiseToOnePercent)
{
  for (const double exact : { 1e-5, 0.3, 1.0, 250.0, 1e6 })
  {
    int calls = 0;
    const auto discrepancy = [&](double lambda)
    {
      ++calls;
      return 2.0 * exact / (lambda + exact);
    };
    const FidelityChoice found = FindFidelityByDiscrepancy(discrepancy, 1.0, 1.0);
    EXPECT_TRUE(found.IsFound);
    EXPECT_NEAR(found.Weight, exact, 0.01 * exact);
    EXPECT_NEAR(found.Discrepancy, 1.0, 0.01);
    EXPECT_LT(calls, 30);
  }
}

TEST(WeightSearch, SaysThatItEndedAtItsLimits)
{
  const FidelityChoice low = FindFidelityByDiscrepancy([](double) { return 0.1; }, 1.0, 5.0);
  EXPECT_FALSE(low.IsFound);
  EXPECT_NEAR(low.Discrepancy, 0.1, 1e-12);
  EXPECT_NEAR(std::log10(low.Weight / 5.0), -8.0, 0.7);
  const FidelityChoice high = FindFidelityByDiscrepancy([](double) { return 3.0; }, 1.0, 5.0);
  EXPECT_FALSE(high.IsFound);
  EXPECT_NEAR(high.Discrepancy, 3.0, 1e-12);
  EXPECT_NEAR(std::log10(high.Weight / 5.0), 8.0, 0.7);
}

TEST(WeightSearch, FindsTheWeightOfTheSmallestRiskFromAnyStart)
{
  for (const double signal : { 10.0, 100.0, 3000.0 })
  {
    double best = 1.0;
    for (double weight = 1e-3; weight < 1e7; weight *= 1.05)
    {
      best = ErrorOf(weight, signal) < ErrorOf(best, signal) ? weight : best;
    }
    for (const bool isGiven : { true, false })
    {
      // Without a given level the search cannot distinguish a strong signal from uneven noise.
      if (signal > 1000.0 && !isGiven)
      {
        continue;
      }
      for (const double start : { 1e-2, 1.0, 1e5 })
      {
        RiskSearch search(1.0, start, isGiven);
        int trials = 0;
        while (!search.IsDone())
        {
          search.Take(Smoothed(search.Trial(), signal));
          ++trials;
        }
        EXPECT_TRUE(search.Found().IsFound);
        EXPECT_LT(ErrorOf(search.Trial(), signal), 1.05 * ErrorOf(best, signal))
          << signal << ' ' << start << ' ' << isGiven;
        EXPECT_LT(trials, 20);
      }
    }
  }
}

TEST(WeightSearch, EndsOnNoiseAloneAndSaysIfALevelIsTooHigh)
{
  for (const double level : { 1.0, 3.0 })
  {
    RiskSearch search(level, 1.0, true);
    int trials = 0;
    while (!search.IsDone())
    {
      search.Take(Smoothed(search.Trial(), 0.0));
      ++trials;
    }
    EXPECT_LT(trials, 15);
    EXPECT_LT(ErrorOf(search.Trial(), 0.0), 0.01);
    EXPECT_EQ(search.Found().IsFound, level == 1.0);
  }
}

// Heat flow is linear: the sum of derivatives is the trace of its matrix, here with the areas.
TEST(UnbiasedRisk, MeasuresTheTraceOfALinearModelAndWhatItRemoves)
{
  const Testing::Surface s = Testing::Icosphere(2);
  const auto assembler = Testing::MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Index n = mesh.NumberOfVertices();
  const auto smooth = [&](const Values& f)
  {
    return Testing::Diffuse(
      assembler, PointData::FromValues(f), 0.02, 1, 0.0, Testing::Scheme::BackwardEuler);
  };
  const Values matrix = smooth(Values::Identity(n, n));
  const Vector& areas = mesh.ControlAreas();
  const double freedom = matrix.diagonal().dot(areas) / areas.sum();
  const double removed =
    ((Values::Identity(n, n) - matrix).rowwise().squaredNorm().dot(areas)) / areas.sum();

  const Values f = Testing::Noise(mesh, 3);
  PointData data = PointData::FromValues(f);
  const SparsePattern pattern = assembler->Pattern();
  constexpr int count = 200;
  std::vector<Values> directions;
  SetRiskDirections(mesh, pattern, s.Vertices, data, { 0, n }, 10.0, count, directions);
  std::vector<Values> changed;
  for (int d = 0; d < count; ++d)
  {
    changed.push_back(smooth(f + 0.5 * directions[static_cast<std::size_t>(d)]));
  }
  const NoiseResponse found =
    MeasureNoiseResponse(mesh, data, smooth(f), changed, directions, count, 0.5, { 0, n });
  // The deviation of the mean of 200 is 1 %.
  EXPECT_NEAR(found.Freedom, freedom, 0.05 * freedom);
  EXPECT_NEAR(found.Removed, removed, 0.05 * removed);
  EXPECT_NEAR(found.Direction, 1.0, 1e-12);

  // Half of the values known, with factors, of which the direction has the deviations.
  data.FidelityFactors = Vector::Constant(n, 4.0);
  data.Missing.head(n / 2) = true;
  directions.clear();
  SetRiskDirections(mesh, pattern, s.Vertices, data, { 0, n }, 10.0, 1, directions);
  const Values& direction = directions.front();
  EXPECT_EQ(direction.topRows(n / 2).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(direction.bottomRows(n - n / 2).cwiseAbs().minCoeff(), 0.5);
}

// Beyond twice the noise from all neighbours is an outlier; both sides of a jump are none.
TEST(UnbiasedRisk, OutliersHaveANoiseOfTheirOwnAndJumpsHaveNot)
{
  const Testing::Surface s = Testing::Icosphere(3);
  const auto assembler = Testing::MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Index n = mesh.NumberOfVertices();
  Values f(n, 1);
  for (Index i = 0; i < n; ++i)
  {
    f(i, 0) = s.Vertices(mesh.InputVertex()[i], 2) > 0.2 ? 1.0 : 0.0;
  }
  f(7, 0) += 5.0;
  std::vector<Values> directions;
  SetRiskDirections(
    mesh, assembler->Pattern(), s.Vertices, PointData::FromValues(f), { 0, n }, 0.1, 1, directions);
  for (Index i = 0; i < n; ++i)
  {
    EXPECT_NEAR(std::abs(directions[0](i, 0)), i == 7 ? 50.0 : 1.0, i == 7 ? 10.0 : 0.0) << i;
  }
}

} // namespace SurfaceDiffusion
