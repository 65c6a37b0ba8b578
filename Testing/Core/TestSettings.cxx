// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/OwnedSettings.h"
#include "Run/SegmentationSettings.h"
#include "Run/TextureSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

using namespace SurfaceDiffusion;

namespace
{

/// Calls change(value) for one setting after the other.
class EachSetting : public SettingVisitor
{
public:
  using SettingVisitor::Choice;
  explicit EachSetting(int index)
    : Index(index)
  {
  }
  void Number(const SettingInfo& info, double& value, const SettingRange&) override
  {
    if (this->IsNext(info))
    {
      value += 0.25;
    }
  }
  /// A list is one setting.
  void Numbers(const SettingInfo& info, std::vector<double>& values, const SettingRange&) override
  {
    if (!values.empty() && this->IsNext(info))
    {
      values.front() += 0.25;
    }
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange&) override
  {
    if (this->IsNext(info))
    {
      ++value;
    }
  }
  void Switch(const SettingInfo& info, bool& value) override
  {
    if (this->IsNext(info))
    {
      value = !value;
    }
  }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>&,
    const std::vector<bool>&) override
  {
    if (this->IsNext(info))
    {
      ++value;
    }
  }

  SettingInfo Changed{ "", "", "" };
  int Count = 0;

private:
  bool IsNext(const SettingInfo& info)
  {
    const bool next = this->Count++ == this->Index;
    if (next)
    {
      this->Changed = info;
    }
    return next;
  }

  const int Index;
};

using Maker = std::function<std::unique_ptr<RunSettings>()>;

const std::vector<Maker> AllModels = { [] { return std::make_unique<HeatSettings>(); },
  [] { return std::make_unique<TotalVariationSettings>(); },
  [] { return std::make_unique<HarmonicMapSettings>(); },
  [] { return std::make_unique<TextureSettings>(); },
  []
  {
    auto settings = std::make_unique<SegmentationSettings>();
    settings->Means = { 1.0 };
    return settings;
  } };

bool HasProblem(RunSettings& settings, const std::string& start)
{
  Problems problems;
  settings.Check(nullptr, problems);
  for (const Sentence& problem : problems)
  {
    if (problem.Text().compare(0, start.size(), start) == 0)
    {
      return true;
    }
  }
  return false;
}

} // namespace

TEST(Settings, EveryChangedSettingChangesTheSnapshotOfItsScopeAlone)
{
  for (const Maker& make : AllModels)
  {
    EachSetting counter(-1);
    make()->Visit(counter);
    ASSERT_GT(counter.Count, 10);
    for (int i = 0; i < counter.Count; ++i)
    {
      const auto before = make();
      const auto after = make();
      EachSetting change(i);
      after->Visit(change);
      for (const SettingScope scope :
        { SettingScope::Surface, SettingScope::Model, SettingScope::Output })
      {
        const bool equal = SettingsSnapshot(*before, scope) == SettingsSnapshot(*after, scope);
        // The choice of the kinetics also decides which of their parameters have an effect.
        if (scope == change.Changed.Scope || std::string(change.Changed.Name) != "Kinetics")
        {
          EXPECT_EQ(equal, scope != change.Changed.Scope) << change.Changed.Name;
        }
      }
    }
  }
}

TEST(Settings, EverySettingHasANameOfItsOwnAndADocumentation)
{
  for (const Maker& make : AllModels)
  {
    const auto settings = make();
    EachSetting counter(-1);
    settings->Visit(counter);
    std::set<std::string> names;
    for (int i = 0; i < counter.Count; ++i)
    {
      EachSetting change(i);
      make()->Visit(change);
      names.insert(change.Changed.Name);
      EXPECT_GT(std::string(change.Changed.Documentation).size(), 10u) << change.Changed.Name;
    }
    EXPECT_EQ(static_cast<int>(names.size()), counter.Count);
  }
}

TEST(Settings, ChoicesListTheWordsThatTheModelAllows)
{
  TotalVariationSettings settings;
  settings.TimeIntegrator = TimeIntegrator::SecondOrder;
  Problems problems;
  settings.Check(nullptr, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems.front(), "TimeIntegrator is 1; allowed: 0 FirstOrder, 2 Implicit");
}

TEST(Settings, NumbersThatAreNotFiniteAreProblems)
{
  for (const double value : { std::nan(""), std::numeric_limits<double>::infinity() })
  {
    HarmonicMapSettings settings;
    settings.FidelityWeight = value;
    EXPECT_TRUE(HasProblem(settings, "FidelityWeight is"));
  }
}

TEST(Settings, ParametersOfOtherKineticsAreFree)
{
  TextureSettings settings;
  settings.Parameters[static_cast<std::size_t>(KineticsName::GrayScott)][0] = -1.0;
  EXPECT_FALSE(HasProblem(settings, "FeedRate"));
  settings.Kinetics = KineticsName::GrayScott;
  EXPECT_TRUE(HasProblem(settings, "FeedRate is -1"));
}

TEST(Settings, FWHMExcludesWhatWouldChangeTheWidth)
{
  HeatSettings settings;
  settings.FWHM = 2.0;
  settings.FidelityWeight = 1.0;
  EXPECT_TRUE(HasProblem(settings, "FidelityWeight is 1; allowed: 0 together with FWHM"));
}

TEST(Settings, UnknownNumbersOfChoicesAreProblemsAndNotFailures)
{
  for (const int number : { -1, 99 })
  {
    TotalVariationSettings settings;
    settings.EdgeFunction = static_cast<EdgeFunctionKind>(number);
    EXPECT_TRUE(HasProblem(settings, "EdgeFunction is"));
    TextureSettings texture;
    texture.Kinetics = static_cast<KineticsName>(number);
    EXPECT_TRUE(HasProblem(texture, "Kinetics is"));
    EXPECT_STREQ(FindWord(texture, "Kinetics"), "Unknown");
  }
}

TEST(Settings, PublishedTimesEndWithTheLastStep)
{
  HeatSettings settings;
  settings.TimeStep = 0.5;
  settings.NumberOfTimeSteps = 7;
  settings.OutputInterval = 3;
  EXPECT_EQ(settings.PublishedTimes(7), (std::vector<double>{ 0.0, 1.5, 3.0, 3.5 }));
  EXPECT_EQ(settings.FindStep(1.49, 7), 0);
  EXPECT_EQ(settings.FindStep(1.5, 7), 3);
  EXPECT_EQ(settings.FindStep(3.4, 7), 6);
  EXPECT_EQ(settings.FindStep(99.0, 7), 7);
  EXPECT_EQ(settings.FindStep(-1.0, 7), 0);
  // The run has ended at step 4.
  EXPECT_EQ(settings.PublishedTimes(4), (std::vector<double>{ 0.0, 1.5, 2.0 }));
  EXPECT_EQ(settings.FindStep(1.9, 4), 3);
  EXPECT_EQ(settings.FindStep(2.0, 4), 4);
  EXPECT_EQ(settings.FindStep(3.5, 4), 4);
  settings.OutputInterval = std::numeric_limits<int>::max();
  EXPECT_EQ(settings.PublishedTimes(7), (std::vector<double>{ 0.0, 3.5 }));
  EXPECT_EQ(settings.PublishedTimes(0), (std::vector<double>{ 0.0 }));
}

TEST(OwnedSettings, AreReadAndWrittenByNameAndType)
{
  const OwnedSettings owned = OwnedSettings::Make<HeatSettings>();
  auto& settings = static_cast<HeatSettings&>(owned.Get());
  double width = 0.0;
  int choice = 0;
  bool flag = true;
  EXPECT_EQ(WriteSetting(owned.Get(), "FWHM", 2.5), SettingChange::Changed);
  EXPECT_EQ(WriteSetting(owned.Get(), "FWHM", 2.5), SettingChange::None);
  EXPECT_EQ(settings.FWHM, 2.5);
  EXPECT_TRUE(ReadSetting(owned.Get(), "FWHM", width));
  EXPECT_EQ(width, 2.5);
  EXPECT_EQ(WriteSetting(owned.Get(), "Mode", 1), SettingChange::Changed);
  EXPECT_EQ(settings.Mode, HeatMode::SteadyState);
  EXPECT_TRUE(ReadSetting(owned.Get(), "Mode", choice));
  EXPECT_EQ(choice, 1);
  EXPECT_TRUE(ReadSetting(owned.Get(), "AutomaticFidelity", flag));
  EXPECT_FALSE(flag);
  for (const char* name : { "FWMH", "fwhm", "" })
  {
    EXPECT_EQ(WriteSetting(owned.Get(), name, 1.0), SettingChange::Unknown);
    EXPECT_FALSE(ReadSetting(owned.Get(), name, width));
  }
  EXPECT_EQ(WriteSetting(owned.Get(), "FWHM", 1), SettingChange::Unknown); // it is no integer
  EXPECT_EQ(WriteSetting(owned.Get(), "BlurSteps", 5.0), SettingChange::Unknown);
  EXPECT_EQ(WriteSetting(owned.Get(), "BlurSteps", true), SettingChange::Unknown);
  EXPECT_EQ(settings.FWHM, 2.5);
  EXPECT_EQ(settings.Blur.Steps, 4);
}

TEST(OwnedSettings, CopiesAreIndependent)
{
  const OwnedSettings owned = OwnedSettings::Make<HeatSettings>();
  WriteSetting(owned.Get(), "FWHM", 2.5);
  const auto copy = std::dynamic_pointer_cast<HeatSettings>(owned.Copy());
  ASSERT_NE(copy, nullptr);
  WriteSetting(owned.Get(), "FWHM", 3.0);
  EXPECT_EQ(copy->FWHM, 2.5);
  copy->FWHM = 4.0;
  double width = 0.0;
  EXPECT_TRUE(ReadSetting(owned.Get(), "FWHM", width));
  EXPECT_EQ(width, 3.0);
}

/// A reworded setting keeps its value, its range and its scope.
TEST(OwnedSettings, OfAModelWithOtherWordsAreWrittenAndChecked)
{
  const OwnedSettings owned = OwnedSettings::Make<MumfordShahSettings>();
  const SettingsSnapshot before(owned.Get(), SettingScope::Model);
  EXPECT_EQ(WriteSetting(owned.Get(), "FidelityWeight", -1.0), SettingChange::Changed);
  EXPECT_EQ(static_cast<MumfordShahSettings&>(owned.Get()).FidelityWeight, -1.0);
  EXPECT_TRUE(before != SettingsSnapshot(owned.Get(), SettingScope::Model));
  Problems problems;
  CheckRanges(owned.Get(), problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0], "FidelityWeight is -1; allowed: finite numbers, 0 or more");
  const SettingsSnapshot model(owned.Get(), SettingScope::Model);
  EXPECT_EQ(WriteSetting(owned.Get(), "NumberOfTimeSteps", 3), SettingChange::Changed);
  EXPECT_TRUE(model == SettingsSnapshot(owned.Get(), SettingScope::Model)); // of the output alone
}
