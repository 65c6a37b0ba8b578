// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The values that settings allow, alone and together. That every door passes its settings on, and
// their problems back, is tested there.
#include "Run/CurvatureRun.h"
#include "Run/DenoisingRun.h"
#include "Run/DirectionFieldRun.h"
#include "Run/DistanceRun.h"
#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/OwnedSettings.h"
#include "Run/RandomFieldRun.h"
#include "Run/ReliefRun.h"
#include "Run/SegmentationSettings.h"
#include "Run/TensorDiffusionSettings.h"
#include "Run/TextureSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace SurfaceDiffusion;

namespace
{

/// fields: of a run; null: none.
std::string ProblemsOf(Settings& settings, const FieldSummary* fields = nullptr)
{
  Problems problems;
  settings.Check(fields, problems);
  std::string all;
  for (const Sentence& problem : problems)
  {
    all += problem.Text() + "\n";
  }
  return all;
}

/// Values of a setting that are just outside of its range.
struct SettingOutside
{
  OwnedSettings (*Make)();
  const char* Name;
  std::vector<double> Values;
  const char* Allowed;
};

} // namespace

TEST(SettingRanges, EndWhereTheySay)
{
  const char* const positive = "finite numbers above 0";
  const char* const notNegative = "finite numbers, 0 or more";
  const auto heat = &OwnedSettings::Make<HeatSettings>;
  const auto variation = &OwnedSettings::Make<TotalVariationSettings>;
  const auto harmonic = &OwnedSettings::Make<HarmonicMapSettings>;
  const auto shah = &OwnedSettings::Make<MumfordShahSettings>;
  const auto tensor = &OwnedSettings::Make<TensorDiffusionSettings>;
  const auto texture = &OwnedSettings::Make<TextureSettings>;
  const auto segmentation = &OwnedSettings::Make<SegmentationSettings>;
  const auto field = &OwnedSettings::Make<RandomFieldSettings>;
  const auto relief = &OwnedSettings::Make<ReliefSettings>;
  const auto directions = &OwnedSettings::Make<DirectionFieldSettings>;
  const SettingOutside rows[] = {
    { heat, "TimeStep", { 0.0, -1.5 }, positive },
    { heat, "FidelityWeight", { -1.5 }, notNegative },
    { heat, "AlongDiffusivity", { -1.5 }, notNegative },
    { heat, "AcrossDiffusivity", { -1.5 }, notNegative },
    { heat, "MergeTolerance", { -1.5 }, notNegative },
    { heat, "FWHM", { -1.5 }, notNegative },
    { heat, "NoiseLevel", { -1.5 }, notNegative },
    { heat, "BlurFWHM", { -1.0 }, notNegative },
    { heat, "BlurSteps", { 1.0, 65.0 }, "2 to 64" },
    { heat, "Tolerance", { 0.0, 1.0, -1.0 }, "" },
    { heat, "NumberOfTimeSteps", { -1.0, 2147483647.0 }, "0 to 1000000000" },
    { heat, "OutputInterval", { 0.0, -2.0 }, "1 or more" },
    { heat, "MaximumNumberOfIterations", { 0.0 }, "1 or more" },
    { heat, "CheckpointMemoryLimit", { -1.0 }, "0 or more MiB" },
    { heat, "Units", { 2.0, -1.0 }, "0 Natural, 1 Absolute" },
    { heat, "InitialFill", { 4.0 }, "0 Input" },
    { heat, "TimeIntegrator", { 2.0 }, "0 FirstOrder, 1 SecondOrder" },
    { variation, "Beta", { 0.0 }, positive },
    { variation, "EdgeThreshold", { 0.0, -1.0 }, positive },
    { variation, "StopTolerance", { 1.0 }, "" },
    { variation, "TGVLength", { 0.0, -1.0 }, positive },
    { variation, "AcrossEdgeFunction", { -1.0, 7.0 }, "0 Same, 1 TotalVariation" },
    { variation, "ChromaWeight", { 0.0 }, positive },
    { variation, "ChromaticityWeight", { -1.0 }, positive },
    { variation, "ChromaticityExponent", { 0.5, 2.5 }, "numbers from 1 to 2" },
    { harmonic, "Exponent", { 0.9, 2.1 }, "numbers from 1 to 2" },
    { harmonic, "Beta", { 0.0, -1.0 }, "allowed: " },
    { harmonic, "TimeIntegrator", { 1.0 }, "0 FirstOrder" },
    { shah, "SmoothingLength", { 0.0, -1.0 }, positive },
    { shah, "EdgeThreshold", { 0.0, -1.0 }, positive },
    { shah, "EdgeWidth", { 0.0, -1.0 }, positive },
    { shah, "StopTolerance", { 0.0, -1.0 }, "" },
    { tensor, "ColorScale", { 0.0 }, positive },
    { tensor, "NoiseScale", { -1.0 }, notNegative },
    { tensor, "Contrast", { 0.0 }, positive },
    { tensor, "Alpha", { 0.0, 1.5 }, "1e-12 to 1" },
    { texture, "DiffusionRate1", { -1.0 }, notNegative },
    { texture, "DiffusionRateAcross1", { -2.0 }, "0 or more, or -1" },
    { texture, "ReactionRate", { 0.0 }, positive },
    { texture, "FeatureSize", { -1.0 }, notNegative },
    { texture, "InitialNoise", { -0.1 }, notNegative },
    { texture, "StopTolerance", { -1.0 }, notNegative },
    { texture, "CoarseStartSize", { -1.0 }, "0 or more vertices" },
    { texture, "GrowthRate", { 0.0 }, positive },
    { segmentation, "NumberOfRegions", { 1.0, 1001.0 }, "2 to 1000" },
    { segmentation, "FidelityWeight", { -1.0 }, notNegative },
    { segmentation, "StopTolerance", { 1.0 }, "" },
    { directions, "SmoothingLength", { -2.0 }, "0 or more, or -1" },
    { directions, "HintWeight", { 0.0 }, positive },
    { &OwnedSettings::Make<DenoisingRunSettings>, "NoiseLevel", { -1.0 }, notNegative },
    { &OwnedSettings::Make<CurvatureSettings>, "FWHM", { -1.0 }, notNegative },
    { &OwnedSettings::Make<DistanceSettings>, "MaximumDistance", { -2.0 }, notNegative },
    { field, "FWHM", { -1.0 }, notNegative },
    { field, "NumberOfFields", { 0.0 }, "1 or more" },
    { relief, "Flank", { -1.0 }, notNegative },
    { relief, "Overhang", { 91.0, -2.0 }, "0 to 90 degrees, or -1" },
  };
  for (const SettingOutside& row : rows)
  {
    for (const double value : row.Values)
    {
      const OwnedSettings owned = row.Make();
      const bool isReal = WriteSetting(owned.Get(), row.Name, value) != SettingChange::Unknown;
      EXPECT_TRUE(isReal ||
        WriteSetting(owned.Get(), row.Name, static_cast<int>(value)) == SettingChange::Changed)
        << row.Name;
      const std::string problems = ProblemsOf(owned.Get());
      EXPECT_EQ(problems.find(std::string(row.Name) + " is "), 0u) << row.Name << ' ' << problems;
      EXPECT_NE(problems.find(row.Allowed), std::string::npos) << problems;
    }
  }
}

TEST(SettingRanges, OfBetaIncludeZeroWhereItHasNoEffect)
{
  HarmonicMapSettings settings;
  settings.Beta = 0.0;
  settings.Exponent = 2.0;
  EXPECT_EQ(ProblemsOf(settings), "");
}

TEST(SettingRanges, ExcludeWhatWouldChangeAWidth)
{
  using Change = void (*)(HeatSettings&);
  const std::pair<Change, const char*> cases[] = {
    { [](auto& s) { s.AutomaticFidelity = true; }, "AutomaticFidelity is 1; allowed: 0" },
    { [](auto& s) { s.Mode = HeatMode::SteadyState; }, "Mode is 1; allowed: 0 TimeSteps" },
    { [](auto& s) { s.AlongDiffusivity = 2.0, s.AcrossDiffusivity = 3.0; },
      "AlongDiffusivity is 2; allowed: 1" },
  };
  for (const auto& [change, text] : cases)
  {
    HeatSettings settings;
    settings.FWHM = 2.0;
    change(settings);
    EXPECT_NE(ProblemsOf(settings).find(text), std::string::npos) << ProblemsOf(settings);
    EXPECT_NE(ProblemsOf(settings).find("together with FWHM"), std::string::npos);
  }
}

TEST(SettingRanges, OfMinimisersExcludeEnergiesThatAreNotConvex)
{
  using Change = void (*)(TotalVariationSettings&);
  const Change purposes[] = { [](auto& s) { s.Mode = TotalVariationMode::SteadyState; },
    [](auto& s) { s.TimeIntegrator = TimeIntegrator::Implicit; } };
  const std::pair<Change, const char*> cases[] = {
    { [](auto& s) { s.EdgeFunction = EdgeFunctionKind::PeronaMalikExponential; },
      "EdgeFunction is 1; allowed" },
    { [](auto& s) { s.EdgeFunction = EdgeFunctionKind::PeronaMalikRational; },
      "EdgeFunction is 2; allowed" },
    { [](auto& s) { s.EdgeFunction = EdgeFunctionKind::Weickert; }, "EdgeFunction is 4; allowed" },
    { [](auto& s) { s.AcrossEdgeFunction = 6; }, "AcrossEdgeFunction is 6; allowed" },
    { [](auto& s) { s.AlongDiffusivity = s.AcrossDiffusivity = 0.0; },
      "AlongDiffusivity and AcrossDiffusivity is 0; allowed: one above 0" },
  };
  for (const Change purpose : purposes)
  {
    for (const auto& [change, text] : cases)
    {
      TotalVariationSettings settings;
      purpose(settings);
      EXPECT_EQ(ProblemsOf(settings), "");
      change(settings);
      EXPECT_EQ(ProblemsOf(settings).find(text), 0u) << ProblemsOf(settings);
    }
  }
}

TEST(SettingRanges, OfSearchesBlurAndColourModelsExcludeOtherModels)
{
  using Change = void (*)(TotalVariationSettings&);
  const std::pair<Change, const char*> cases[] = {
    { [](auto& s) { s.Color.Model = ColorModel::Opponent, s.FidelityNorm = FidelityNorm::L1; },
      "FidelityNorm is 1; allowed: 0 L2" },
    { [](auto& s) { s.Blur.FWHM = 1.0; }, "Mode is 0; allowed: 1 SteadyState together with" },
    { [](auto& s) { s.Regularizer = Regularizer::TGV; },
      "Mode is 0; allowed: 1 SteadyState together with Regularizer TGV" },
    { [](auto& s)
      {
        s.Mode = TotalVariationMode::SteadyState;
        s.Regularizer = Regularizer::TGV;
        s.Discretization = Discretization::CrouzeixRaviart;
      },
      "Discretization is 1; allowed: 0 Linear together with Regularizer TGV" },
    { [](auto& s)
      {
        s.Mode = TotalVariationMode::SteadyState;
        s.Regularizer = Regularizer::TGV;
        s.EdgeFunction = EdgeFunctionKind::Charbonnier;
      },
      "EdgeFunction is 3; allowed: 0 TotalVariation together with Regularizer TGV" },
    { [](auto& s)
      {
        s.Mode = TotalVariationMode::SteadyState;
        s.Regularizer = Regularizer::TGV;
        s.Color.Model = ColorModel::ChromaticityBrightness;
      },
      "ColorModel is 2; allowed: 0 RGB and 1 Opponent together with Regularizer TGV" },
    { [](auto& s)
      {
        s.Mode = TotalVariationMode::SteadyState;
        s.Blur.FWHM = 1.0;
        s.Color.Model = ColorModel::Opponent;
      },
      "ColorModel is 1; allowed: 0 RGB together with BlurFWHM" },
  };
  for (const auto& [change, text] : cases)
  {
    TotalVariationSettings settings;
    change(settings);
    EXPECT_EQ(ProblemsOf(settings).find(text), 0u) << ProblemsOf(settings);
  }
}

TEST(SettingRanges, OfColourModelsNeedThreeComponents)
{
  TotalVariationSettings settings;
  settings.Color.Model = ColorModel::Opponent;
  FieldSummary fields;
  fields.Data = true;
  fields.DataComponents = 2;
  EXPECT_EQ(
    ProblemsOf(settings, &fields).find("ColorModel is 1 but InputArray has 2 components"), 0u);
}
