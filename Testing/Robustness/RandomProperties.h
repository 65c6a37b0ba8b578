// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Dice.h"

#include "vtkDummyController.h"
#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkSurfaceDirectionFieldFilter.h"
#include "vtkTuringTextureFilter.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

/// Every settable property of every filter: how to draw a random value for it, and how to copy it.
/// A test compares these tables with the headers of the classes.
namespace FilterTest
{

struct RandomProperty
{
  using Filter = vtkPolyDataAlgorithm;
  std::string Name;
  std::function<void(Filter*, Dice&)> Set; ///< mostly to an allowed value
  std::function<void(Filter* from, Filter* to)> Copy;
  std::function<bool(Filter*, Filter*)> Equal;
};

struct FilterClass
{
  std::string Name;
  std::function<vtkSmartPointer<vtkPolyDataAlgorithm>()> Make;
  std::vector<RandomProperty> Properties;
};

namespace RandomProperties
{

inline bool SameValue(double a, double b)
{
  return a == b;
}
inline bool SameValue(const char* a, const char* b)
{
  return std::string(a ? a : "") == (b ? b : "");
}
inline bool SameValue(const void* a, const void* b)
{
  return a == b;
}
inline bool SameValue(const double* a, const double* b)
{
  return std::equal(a, a + 3, b);
}

/// Of the class F: draws the values with the expression `value`, which may use `dice`.
#define RANDOM_PROPERTY(F, name, value)                                                            \
  RandomProperty                                                                                   \
  {                                                                                                \
#name,                                                                                         \
      [](vtkPolyDataAlgorithm * filter, [[maybe_unused]] Dice & dice)                              \
    { static_cast<F*>(filter)->Set##name(value); },                                                \
      [](vtkPolyDataAlgorithm * from, vtkPolyDataAlgorithm * to)                                   \
    { static_cast<F*>(to)->Set##name(static_cast<F*>(from)->Get##name()); },                       \
      [](vtkPolyDataAlgorithm * a, vtkPolyDataAlgorithm * b)                                       \
    { return SameValue(static_cast<F*>(a)->Get##name(), static_cast<F*>(b)->Get##name()); }        \
  }

/// Positive, seldom negative, which most properties refuse.
inline double Positive(Dice& dice)
{
  return dice.Flip(24) ? -0.5 : dice.Logarithmic(1e-3, 1e3);
}
inline double ZeroOrPositive(Dice& dice, int zeroOneIn = 2)
{
  return dice.Flip(zeroOneIn) ? 0.0 : Positive(dice);
}
/// A choice of an enum with `count` entries, seldom one more.
inline int Choice(Dice& dice, int count)
{
  return dice.Below(dice.Flip(24) ? count + 1 : count);
}
/// A value not far from a default that makes a pattern.
inline double Near(Dice& dice, double value)
{
  return value * (0.75 + 0.5 * dice.Unit());
}
inline const char* Name(Dice& dice)
{
  const char* const names[] = { "", "Result", "f" };
  return names[dice.Below(3)];
}
inline vtkMultiProcessController* Controller(Dice& dice)
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

using List = std::vector<RandomProperty>;

/// Of every filter.
template <typename F>
List OfSurface()
{
  return {
    RANDOM_PROPERTY(F, MergeCoincidentPoints, dice.Flip()),
    // A tolerance far beyond the size of the surface takes VTK's point locator for ever.
    RANDOM_PROPERTY(F, MergeTolerance, dice.Flip() ? 0.0 : dice.Logarithmic(1e-9, 0.1)),
    RANDOM_PROPERTY(F, SeamTolerance, dice.Flip() ? -1.0 : ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, Controller, Controller(dice)),
    RANDOM_PROPERTY(F, ResultArrayName, Name(dice)),
  };
}

/// Of filters that take time steps; the fidelity and the diffusivities are the only value allowed
/// by filters that have no use for them.
template <typename F>
List OfDiffusion(int timeIntegrators, bool usesData)
{
  static const auto fromData = [](Dice& dice, double unused)
  { return dice.Flip(24) ? Positive(dice) : unused; };
  List list{
    RANDOM_PROPERTY(F, TimeStep, Positive(dice)),
    RANDOM_PROPERTY(F, NumberOfTimeSteps, dice.Below(6) - (dice.Flip(24) ? 7 : 0)),
    RANDOM_PROPERTY(F, Units, Choice(dice, 2)),
    RANDOM_PROPERTY(F, GenerateTimeSteps, !dice.Flip(3)),
    RANDOM_PROPERTY(F, OutputInterval, 1 + dice.Below(3)),
    RANDOM_PROPERTY(F, MaskMode, Choice(dice, 2)),
    RANDOM_PROPERTY(F, InitialFill, Choice(dice, 3)),
    RANDOM_PROPERTY(F, HoldKnownValues, dice.Flip(3)),
    RANDOM_PROPERTY(F, RandomSeed, dice.Below(5)),
    RANDOM_PROPERTY(F, Solver, Choice(dice, 4)),
    RANDOM_PROPERTY(F, Tolerance, dice.Flip(24) ? 2.0 : dice.Logarithmic(1e-12, 0.5)),
    RANDOM_PROPERTY(
      F, MaximumNumberOfIterations, dice.Flip(4) ? dice.Below(4) : 100 + dice.Below(900)),
    RANDOM_PROPERTY(F, IntrinsicDelaunay, dice.Flip()),
    RANDOM_PROPERTY(F, OutputPrecision, Choice(dice, 3)),
    RANDOM_PROPERTY(F, CheckpointMemoryLimit, dice.Below(2)),
  };
  if (usesData)
  {
    list.push_back(RANDOM_PROPERTY(F, FidelityWeight, ZeroOrPositive(dice)));
    list.push_back(RANDOM_PROPERTY(F, AlongDiffusivity, dice.Flip() ? 1.0 : Positive(dice)));
    list.push_back(RANDOM_PROPERTY(F, AcrossDiffusivity, dice.Flip() ? 1.0 : Positive(dice)));
  }
  else
  {
    list.push_back(RANDOM_PROPERTY(F, FidelityWeight, fromData(dice, 0.0)));
    list.push_back(RANDOM_PROPERTY(F, AlongDiffusivity, fromData(dice, 1.0)));
    list.push_back(RANDOM_PROPERTY(F, AcrossDiffusivity, fromData(dice, 1.0)));
  }
  // Bit i of timeIntegrators: whether the class has integrator i.
  list.push_back(RANDOM_PROPERTY(F, TimeIntegrator, Choice(dice, 3)));
  list.back().Set = [timeIntegrators](vtkPolyDataAlgorithm* filter, Dice& dice)
  {
    const int choice = Choice(dice, 3);
    const bool has = timeIntegrators >> choice & 1;
    static_cast<F*>(filter)->SetTimeIntegrator(has || dice.Flip(12) ? choice : 0);
  };
  return list;
}

inline List OfHeat()
{
  using F = vtkFVMHeatFilter;
  return {
    RANDOM_PROPERTY(F, Mode, dice.Flip(3)),
    RANDOM_PROPERTY(F, FWHM, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, AutomaticFidelity, dice.Flip(3)),
    RANDOM_PROPERTY(F, NoiseLevel, ZeroOrPositive(dice)),
  };
}

inline List OfTotalVariation()
{
  using F = vtkIntrinsicTVFilter;
  return {
    RANDOM_PROPERTY(F, Mode, dice.Flip(3)),
    RANDOM_PROPERTY(F, EdgeFunction, Choice(dice, 6)),
    RANDOM_PROPERTY(F, AcrossEdgeFunction, dice.Flip() ? 0 : Choice(dice, 7)),
    RANDOM_PROPERTY(F, Beta, Positive(dice)),
    RANDOM_PROPERTY(F, EdgeThreshold, Positive(dice)),
    RANDOM_PROPERTY(F, ChannelCoupling, Choice(dice, 2)),
    RANDOM_PROPERTY(F, FidelityNorm, dice.Flip(3)),
    RANDOM_PROPERTY(F, AutomaticFidelity, dice.Flip(4)),
    RANDOM_PROPERTY(F, NoiseLevel, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, Discretization, dice.Flip(3)),
    RANDOM_PROPERTY(F, StopTolerance, dice.Flip(24) ? 1.0 : dice.Logarithmic(1e-6, 0.5)),
  };
}

inline List OfHarmonicMap()
{
  using F = vtkHarmonicMapFilter;
  return {
    RANDOM_PROPERTY(F, Exponent, dice.Flip() ? 1.0 + dice.Below(2) : 1.0 + dice.Unit()),
    RANDOM_PROPERTY(F, Beta, Positive(dice)),
    RANDOM_PROPERTY(F, Scheme, Choice(dice, 3)),
    RANDOM_PROPERTY(F, ConsistentReaction, dice.Flip()),
    RANDOM_PROPERTY(F, ProjectToSphere, dice.Flip()),
    RANDOM_PROPERTY(F, LineField, dice.Flip()),
    RANDOM_PROPERTY(F, UseAsNormals, dice.Flip()),
    RANDOM_PROPERTY(F, MoveVertices, dice.Flip()),
  };
}

inline List OfTexture()
{
  using F = vtkTuringTextureFilter;
  return {
    RANDOM_PROPERTY(F, Kinetics, Choice(dice, 6)),
    RANDOM_PROPERTY(F, ReactionRate, Positive(dice)),
    RANDOM_PROPERTY(F, DiffusionRate1, Near(dice, 21.0)),
    RANDOM_PROPERTY(F, DiffusionRate2, Near(dice, 2.6)),
    RANDOM_PROPERTY(F, DiffusionRateAcross1, dice.Flip() ? -1.0 : Near(dice, 21.0)),
    RANDOM_PROPERTY(F, DiffusionRateAcross2, dice.Flip() ? -1.0 : Near(dice, 2.6)),
    RANDOM_PROPERTY(F, FeatureSize, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, InitialNoise, ZeroOrPositive(dice, 8)),
    RANDOM_PROPERTY(F, ClampToNonNegative, dice.Flip()),
    RANDOM_PROPERTY(F, AutomaticTimeStep, dice.Flip()),
    RANDOM_PROPERTY(F, StopTolerance, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, GrowthRate, Near(dice, 16.0)),
    RANDOM_PROPERTY(F, DecayRate, Near(dice, 12.0)),
    RANDOM_PROPERTY(F, ActivatorSupply, Near(dice, 0.01)),
    RANDOM_PROPERTY(F, SubstrateSupply, Near(dice, 1.0)),
    RANDOM_PROPERTY(F, FeedRate, Near(dice, 0.05)),
    RANDOM_PROPERTY(F, KillRate, Near(dice, 0.06)),
    RANDOM_PROPERTY(F, ReactantA, Near(dice, 2.0)),
    RANDOM_PROPERTY(F, ReactantB, Near(dice, 4.0)),
    RANDOM_PROPERTY(F, InhibitorDecayRate, Near(dice, 1.05)),
    RANDOM_PROPERTY(F, Saturation, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, RecoveryRate, Near(dice, 1.2)),
    RANDOM_PROPERTY(F, RecoveryDamping, Near(dice, 0.9)),
    RANDOM_PROPERTY(F, Stimulus, dice.Unit() - 0.5),
    RANDOM_PROPERTY(F, TextureChemical, Choice(dice, 2)),
    RANDOM_PROPERTY(F, ColorOutput, dice.Flip()),
    RANDOM_PROPERTY(F, LowColor, Color(dice).data()),
    RANDOM_PROPERTY(F, HighColor, Color(dice).data()),
  };
}

inline List OfDirectionField()
{
  using F = vtkSurfaceDirectionFieldFilter;
  return {
    RANDOM_PROPERTY(F, Method, Choice(dice, 4)),
    RANDOM_PROPERTY(F, PrincipalDirection, Choice(dice, 2)),
    RANDOM_PROPERTY(F, SmoothingLength, dice.Flip() ? -1.0 : ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, HintWeight, Positive(dice)),
    RANDOM_PROPERTY(F, Angle, 360.0 * dice.Unit()),
  };
}

#undef RANDOM_PROPERTY

template <typename F>
FilterClass MakeClass(const std::vector<List>& lists)
{
  FilterClass result;
  result.Make = [] { return vtkSmartPointer<F>::New(); };
  result.Name = result.Make()->GetClassName();
  for (const List& list : lists)
  {
    result.Properties.insert(result.Properties.end(), list.begin(), list.end());
  }
  return result;
}

} // namespace RandomProperties

inline std::vector<FilterClass> AllFilterClasses()
{
  using namespace RandomProperties;
  using Heat = vtkFVMHeatFilter;
  using TV = vtkIntrinsicTVFilter;
  using Harmonic = vtkHarmonicMapFilter;
  using Turing = vtkTuringTextureFilter;
  using Direction = vtkSurfaceDirectionFieldFilter;
  return {
    MakeClass<Heat>({ OfSurface<Heat>(), OfDiffusion<Heat>(0b011, true), OfHeat() }),
    MakeClass<TV>({ OfSurface<TV>(), OfDiffusion<TV>(0b101, true), OfTotalVariation() }),
    MakeClass<Harmonic>(
      { OfSurface<Harmonic>(), OfDiffusion<Harmonic>(0b001, true), OfHarmonicMap() }),
    MakeClass<Turing>({ OfSurface<Turing>(), OfDiffusion<Turing>(0b011, false), OfTexture() }),
    MakeClass<Direction>({ OfSurface<Direction>(), OfDirectionField() }),
  };
}

} // namespace FilterTest
