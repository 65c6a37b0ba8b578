// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RunInput.h"

#include "Core/Solvers/LinearSolver.h"
#include "Core/Solvers/NotPositiveDefinite.h"
#include "Run/DenoisingRun.h"
#include "Run/ErrorCauses.h"
#include "Run/HeatSettings.h"
#include "Run/InputSentences.h"
#include "Run/SegmentationSettings.h"
#include "Run/Solve.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

std::vector<Word::Kind> KindsOf(const Sentence& sentence)
{
  std::vector<Word::Kind> kinds;
  for (const Word& word : sentence.Words())
  {
    kinds.push_back(word.Type);
  }
  return kinds;
}

/// A sphere with a triangle of zero area at the end.
Testing::RunInput WithDegenerateTriangle()
{
  Testing::RunInput input(Testing::Icosphere(3));
  input.Faces.conservativeResize(input.Faces.rows() + 1, 3);
  input.Faces.bottomRows(1) << 0, 0, 6;
  return input;
}

} // namespace

TEST(Sentence, IsSpelledInTheWordsOfVTKAndKeepsWhatTheyRefer)
{
  Sentence sentence = Word::Setting("Mode");
  sentence << " is " << Word::Number("Mode", HeatMode::TimeSteps) << ", and "
           << Word::Array("InputArray", " \"f\"") << " has " << 3 << " of " << 2.5 << " "
           << Word::Cells()
           << "; allowed: " << Word::NumberedChoice("Mode", HeatMode::SteadyState, "SteadyState")
           << " or " << Word::Switch(false);
  EXPECT_EQ(sentence.Text(),
    "Mode is 0, and InputArray \"f\" has 3 of 2.5 cells; allowed: 1 SteadyState or off");
  EXPECT_EQ(sentence.Text({ { "InputArray", "Data" } }),
    "Mode is 0, and Data has 3 of 2.5 cells; allowed: 1 SteadyState or off");
  using Kind = Word::Kind;
  EXPECT_EQ(KindsOf(sentence),
    (std::vector<Kind>{ Kind::Setting, Kind::Text, Kind::Choice, Kind::Text, Kind::Array,
      Kind::Text, Kind::Cell, Kind::Text, Kind::Choice, Kind::Text, Kind::Switch }));
  EXPECT_EQ(sentence.Words()[2].Name, "Mode");
  EXPECT_EQ(sentence.Words()[8].Value, 1);
}

TEST(Sentence, OfAProblemRefersToTheSettingAndItsValues)
{
  HeatSettings settings;
  settings.FWHM = 2.0;
  settings.Mode = HeatMode::SteadyState;
  Problems problems;
  settings.Check(nullptr, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].Text(),
    "Mode is 1; allowed: 0 TimeSteps together with FWHM: a steady state has no width");
  using Kind = Word::Kind;
  EXPECT_EQ(KindsOf(problems[0]),
    (std::vector<Kind>{ Kind::Setting, Kind::Text, Kind::Choice, Kind::Text, Kind::Choice,
      Kind::Text, Kind::Setting, Kind::Text }));
}

TEST(Sentence, OfTheTableHasItsPartsAndRefersToSettings)
{
  const Sentence sentence = Say("Stopped", 0.5, 0.25, 7);
  EXPECT_EQ(sentence.Text(),
    "refinement stopped at edges of 0.5, longer than 0.25, because MaximumNumberOfTriangles is 7");
  using Kind = Word::Kind;
  EXPECT_EQ(KindsOf(sentence), (std::vector<Kind>{ Kind::Text, Kind::Setting, Kind::Text }));
  EXPECT_EQ(Say("Bisected", 8, Say("Features", 2.0, 3.0)).Words()[1].Name, "FeatureSize");
  EXPECT_THROW(Say("NoSuchSentence"), std::out_of_range);
}

TEST(Sentence, OfAFailureNamesOnlySettingsThatTheModelHas)
{
  SolveReport report;
  report.Iterations = 7;
  HeatSettings heat;
  EXPECT_EQ(ExplainError(heat, NotConverged(report)).Text(),
    std::string(NotConverged(report).what()) +
      "; allow a larger Tolerance or MaximumNumberOfIterations, or set Solver to Direct");
  EXPECT_NE(
    ExplainError(heat, NotPositiveDefinite()).Text().find("IntrinsicDelaunay"), std::string::npos);
  heat.IntrinsicDelaunay = true;
  EXPECT_EQ(ExplainError(heat, NotPositiveDefinite()).Text(), NotPositiveDefinite().what());
  DenoisingRunSettings denoising;
  EXPECT_EQ(ExplainError(denoising, NotConverged(report)).Text(), NotConverged(report).what());
  EXPECT_EQ(ExplainError(denoising, NotPositiveDefinite()).Text(), NotPositiveDefinite().what());
}

TEST(Sentence, AboutTrianglesWithoutAreaSaysWhatBecomesOfThem)
{
  const Testing::RunInput input = WithDegenerateTriangle();
  const std::vector<std::string> ofDirections =
    DirectionField(input.Vertices, input.Faces).Warnings;
  ASSERT_FALSE(ofDirections.empty());
  EXPECT_EQ(ofDirections.back(), "1 triangles of zero area get no direction");
  const std::vector<std::string> warnings = DenoiseMesh(input.Vertices, input.Faces).Warnings;
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings.back(), "1 triangles of zero area have no normal");
}

TEST(Sentence, AboutOneEmptyRegionIsSingular)
{
  const Testing::RunInput input(Testing::Icosphere(3));
  SegmentationSettings settings;
  settings.AutomaticMeans = false;
  settings.Means = { 0.0, 100.0 };
  const Solution solution = Segment(input.Vertices, input.Faces, input.Data, settings);
  ASSERT_EQ(solution.Warnings.size(), 1u);
  EXPECT_EQ(solution.Warnings[0].find("no point is in the region 2 ("), 0u) << solution.Warnings[0];
}

TEST(Sentence, AboutVectorsIsThatOfTheirSettings)
{
  HarmonicMapSettings settings;
  FieldSummary fields;
  fields.Data = true;
  const auto check = [&](int components)
  {
    fields.DataComponents = components;
    Problems problems;
    settings.Check(&fields, problems);
    return Join(problems).Text();
  };
  EXPECT_EQ(check(2), "");
  EXPECT_EQ(
    check(1), "InputArray has 1 components; allowed: 2 or more, alpha of colours not counted");
  settings.MoveVertices = true;
  EXPECT_EQ(check(3), "");
  EXPECT_EQ(check(2), "InputArray has 2 components; allowed: 3 with MoveVertices");
  fields.Data = false;
  EXPECT_EQ(check(0), "InputArray has 0 values; allowed: a row for each point or cell");
}

} // namespace SurfaceDiffusion
