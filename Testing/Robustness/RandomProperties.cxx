// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RandomProperties.h"

#include "Properties.h"

#include "vtkDummyController.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkSurfaceInterpolationFilter.h"
#include "vtkSurfaceModelAlgorithm.h"
#include "vtkSurfaceReliefFilter.h"
#include "vtkSurfaceSegmentationFilter.h"
#include "vtkTuringTextureFilter.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace FilterTest
{
namespace
{

using List = std::vector<RandomProperty>;

/// A number of any size, rarely a negative one, which most properties do not allow.
double Positive(Dice& dice)
{
  return dice.Flip(24) ? -0.5 : dice.Logarithmic(1e-3, 1e3);
}

/// Mostly near the default, so that textures still form.
double DrawNumber(const Property& property, Dice& dice)
{
  const SurfaceDiffusion::SettingRange& range = property.Range;
  if (range.HasSpecial && dice.Flip())
  {
    return range.Special;
  }
  if (range.Low < range.High && std::isfinite(range.High)) // small values matter most
  {
    const double width = range.High - range.Low;
    return dice.Flip(24) ? range.High + width : range.Low + width * dice.Logarithmic(1e-6, 1.0);
  }
  if (property.Default == 0.0)
  {
    return dice.Flip() ? 0.0 : Positive(dice);
  }
  return dice.Flip(4) ? Positive(dice) : property.Default * (0.75 + 0.5 * dice.Unit());
}

double DrawInteger(const Property& property, Dice& dice)
{
  if (property.Name == "RandomSeed")
  {
    return dice.Below(100) - 50;
  }
  const bool isLarge = property.Default > 50.0 && property.Name != "NumberOfTimeSteps";
  if (isLarge && !dice.Flip(4))
  {
    return property.Default;
  }
  return property.Range.Low + (dice.Flip(24) ? -7 : dice.Below(6));
}

/// Rarely a word that is not allowed, or the number after the last.
double DrawChoice(const Property& property, Dice& dice)
{
  const int count = static_cast<int>(property.Words.size());
  const int choice = dice.Below(dice.Flip(24) ? count + 1 : count);
  const bool isAllowed = choice >= static_cast<int>(property.Allowed.size()) ||
    property.Allowed[static_cast<std::size_t>(choice)];
  return isAllowed || dice.Flip(12) ? choice : property.Default;
}

double Draw(const Property& property, Dice& dice)
{
  switch (property.Type)
  {
    case Property::Form::Number:
      return DrawNumber(property, dice);
    case Property::Form::Integer:
      return DrawInteger(property, dice);
    case Property::Form::Switch: // searches for weights take long
      return dice.Flip(property.Name == "AutomaticFidelity" ? 4 : 2);
    default:
      return DrawChoice(property, dice);
  }
}

RandomProperty OfSetting(const Property& property)
{
  RandomProperty random{ property.Name,
    [=](vtkPolyDataAlgorithm* filter, Dice& dice) { property.Set(filter, Draw(property, dice)); },
    [=](vtkPolyDataAlgorithm* from, vtkPolyDataAlgorithm* to)
    { property.Set(to, property.Get(from)); },
    [=](vtkPolyDataAlgorithm* a, vtkPolyDataAlgorithm* b)
    { return property.Get(a) == property.Get(b); } };
  if (property.Type != Property::Form::Switch)
  {
    const bool isNumber = property.Type == Property::Form::Number;
    random.SetForbidden = [=](vtkPolyDataAlgorithm* filter)
    {
      property.Set(filter, isNumber ? std::nan("") : -77.0);
      return std::string(isNumber ? "nan" : "-77");
    };
  }
  return random;
}

bool SameValue(double a, double b)
{
  return a == b;
}
bool SameValue(const char* a, const char* b)
{
  return std::string(a ? a : "") == (b ? b : "");
}
bool SameValue(const void* a, const void* b)
{
  return a == b;
}
bool SameValue(const double* a, const double* b)
{
  return std::equal(a, a + 3, b);
}

template <typename Set>
std::string SetForbidden(double, const Set& set)
{
  set(std::nan(""));
  return "nan";
}
template <typename Set>
std::string SetForbidden(const double*, const Set& set)
{
  set(std::array<double, 3>{ 0.5, std::nan(""), 0.5 }.data());
  return "nan";
}
template <typename Set>
std::string SetForbidden(int, const Set& set)
{
  set(-77);
  return "-77";
}
template <typename Set>
std::string SetForbidden(bool, const Set&)
{
  return "";
}
template <typename Set>
std::string SetForbidden(const void*, const Set&)
{
  return "";
}

/// A property of the class F that is no setting. The expression `value` draws a random value and may use `dice`.
#define RANDOM_PROPERTY(F, name, value)                                                            \
  RandomProperty                                                                                   \
  {                                                                                                \
#name,                                                                                         \
      [](vtkPolyDataAlgorithm * target, [[maybe_unused]] Dice & dice)                              \
    { F::SafeDownCast(target)->Set##name(value); },                                                \
      [](vtkPolyDataAlgorithm * from, vtkPolyDataAlgorithm * to)                                   \
    { F::SafeDownCast(to)->Set##name(F::SafeDownCast(from)->Get##name()); },                       \
      [](vtkPolyDataAlgorithm * a, vtkPolyDataAlgorithm * b)                                       \
    { return SameValue(F::SafeDownCast(a)->Get##name(), F::SafeDownCast(b)->Get##name()); },       \
      [](vtkPolyDataAlgorithm * target)                                                            \
    {                                                                                              \
      return SetForbidden(F::SafeDownCast(target)->Get##name(),                                    \
        [target](auto other) { F::SafeDownCast(target)->Set##name(other); });                      \
    }   \
  }

const char* Name(Dice& dice)
{
  const char* const names[] = { "", "Result", "f" };
  return names[dice.Below(3)];
}
vtkMultiProcessController* Controller(Dice& dice)
{
  static const vtkNew<vtkDummyController> controller;
  return dice.Flip() ? controller.Get() : nullptr;
}
struct Color : std::array<double, 3>
{
  explicit Color(Dice& dice)
    : std::array<double, 3>{ dice.Unit(), dice.Unit(), dice.Unit() }
  {
  }
};

RandomProperty OfMissingValues()
{
  using F = vtkSurfaceInterpolationFilter;
  const auto values = [](vtkPolyDataAlgorithm* filter)
  {
    std::vector<double> found;
    for (int k = 0; k < F::SafeDownCast(filter)->GetNumberOfMissingValues(); ++k)
    {
      found.push_back(F::SafeDownCast(filter)->GetMissingValue(k));
    }
    return found;
  };
  return { "MissingValue",
    [](vtkPolyDataAlgorithm* filter, Dice& dice)
    { F::SafeDownCast(filter)->AddMissingValue(dice.Flip() ? 0.0 : -9999.0); },
    [values](vtkPolyDataAlgorithm* from, vtkPolyDataAlgorithm* to)
    {
      F::SafeDownCast(to)->RemoveAllMissingValues();
      for (const double value : values(from))
      {
        F::SafeDownCast(to)->AddMissingValue(value);
      }
    },
    [values](vtkPolyDataAlgorithm* a, vtkPolyDataAlgorithm* b) { return values(a) == values(b); } };
}

RandomProperty OfMeans()
{
  using F = vtkSurfaceSegmentationFilter;
  constexpr double unset = -1e300;
  const auto means = [](vtkPolyDataAlgorithm* filter)
  {
    std::array<double, 6> found{};
    for (int entry = 0; entry < 6; ++entry)
    {
      const double mean = F::SafeDownCast(filter)->GetMean(1 + entry / 3, entry % 3);
      found[static_cast<std::size_t>(entry)] = std::isnan(mean) ? unset : mean;
    }
    return found;
  };
  return { "Mean",
    [](vtkPolyDataAlgorithm* filter, Dice& dice) {
      F::SafeDownCast(filter)->SetMean(1 + dice.Below(2), dice.Below(3), 1.0 + 2.0 * dice.Unit());
    },
    [means](vtkPolyDataAlgorithm* from, vtkPolyDataAlgorithm* to)
    {
      F::SafeDownCast(to)->RemoveAllMeans();
      const auto given = means(from);
      for (int entry = 0; entry < 6; ++entry)
      {
        const double mean = given[static_cast<std::size_t>(entry)];
        if (mean != unset)
        {
          F::SafeDownCast(to)->SetMean(1 + entry / 3, entry % 3, mean);
        }
      }
    },
    [means](vtkPolyDataAlgorithm* a, vtkPolyDataAlgorithm* b) { return means(a) == means(b); } };
}

/// The properties of an object that are no settings.
List OfClass(vtkPolyDataAlgorithm* filter)
{
  using Surface = vtkSurfaceFilter;
  using Spline = vtkSurfaceInterpolationFilter;
  using Turing = vtkTuringTextureFilter;
  List list = {
    RANDOM_PROPERTY(Surface, SeamTolerance, dice.Flip() ? -1.0 : Positive(dice)),
    RANDOM_PROPERTY(Surface, RefineTo, dice.Below(3) > 0 ? 0.0 : 0.3 + dice.Unit()),
    RANDOM_PROPERTY(Surface, MaximumNumberOfTriangles, dice.Flip() ? 50000 : 1 + dice.Below(3000)),
    RANDOM_PROPERTY(Surface, NumberOfThreads, dice.Below(3)),
    RANDOM_PROPERTY(Surface, Controller, Controller(dice)),
    RANDOM_PROPERTY(Surface, ResultArrayName, Name(dice)),
  };
  const auto add = [&](const char* className, const List& others)
  {
    if (filter->IsA(className))
    {
      list.insert(list.end(), others.begin(), others.end());
    }
  };
  add("vtkSurfaceModelAlgorithm",
    { RANDOM_PROPERTY(vtkSurfaceModelAlgorithm, OutputPrecision, dice.Below(4)) });
  add("vtkHarmonicMapFilter", { RANDOM_PROPERTY(vtkHarmonicMapFilter, UseAsNormals, dice.Flip()) });
  add("vtkSurfaceInterpolationFilter",
    { RANDOM_PROPERTY(Spline, PointValueArray, Name(dice)),
      RANDOM_PROPERTY(Spline, PointWeightArray, Name(dice)), OfMissingValues() });
  add("vtkSurfaceSegmentationFilter", { OfMeans() });
  add("vtkTuringTextureFilter",
    { RANDOM_PROPERTY(Turing, LowColor, Color(dice).data()),
      RANDOM_PROPERTY(Turing, HighColor, Color(dice).data()) });
  add("vtkSurfaceReliefFilter",
    { RANDOM_PROPERTY(vtkSurfaceReliefFilter, UpDirection, Color(dice).data()) });
  return list;
}

#undef RANDOM_PROPERTY

} // namespace

vtkSmartPointer<vtkPolyDataAlgorithm> FilterClass::Make() const
{
  return MakeFilter(this->Name);
}

const std::vector<FilterClass>& AllFilterClasses()
{
  static const std::vector<FilterClass> all = []
  {
    std::vector<FilterClass> classes;
    for (const std::string& name : FilterClassNames())
    {
      const auto filter = MakeFilter(name);
      FilterClass made{ name, OfClass(filter) };
      for (const Property& property : PropertiesOf(filter))
      {
        made.Properties.push_back(OfSetting(property));
      }
      classes.push_back(std::move(made));
    }
    return classes;
  }();
  return all;
}

} // namespace FilterTest
