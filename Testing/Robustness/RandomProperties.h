// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Dice.h"

#include "vtkDummyController.h"
#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkMumfordShahFilter.h"
#include "vtkSurfaceCurvatureFilter.h"
#include "vtkSurfaceDenoisingFilter.h"
#include "vtkSurfaceDerivativesFilter.h"
#include "vtkSurfaceDirectionFieldFilter.h"
#include "vtkSurfaceDistanceFilter.h"
#include "vtkSurfaceInterpolationFilter.h"
#include "vtkSurfaceRandomFieldFilter.h"
#include "vtkSurfaceReliefFilter.h"
#include "vtkSurfaceSegmentationFilter.h"
#include "vtkTensorDiffusionFilter.h"
#include "vtkTuringTextureFilter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <ostream>
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
  /// Sets a value that no number or choice allows, and returns it; empty if the property is neither.
  std::function<std::string(Filter*)> SetForbidden = [](Filter*) { return std::string(); };
};

struct FilterClass
{
  std::string Name;
  std::function<vtkSmartPointer<vtkPolyDataAlgorithm>()> Make;
  std::vector<RandomProperty> Properties;
};

inline void PrintTo(const FilterClass& kind, std::ostream* os)
{
  *os << kind.Name;
}

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

/// A property of the class F. The expression `value` draws a random value and may use `dice`.
#define RANDOM_PROPERTY(F, name, value)                                                            \
  RandomProperty                                                                                   \
  {                                                                                                \
#name,                                                                                         \
      [](vtkPolyDataAlgorithm * filter, [[maybe_unused]] Dice & dice)                              \
    { static_cast<F*>(filter)->Set##name(value); },                                                \
      [](vtkPolyDataAlgorithm * from, vtkPolyDataAlgorithm * to)                                   \
    { static_cast<F*>(to)->Set##name(static_cast<F*>(from)->Get##name()); },                       \
      [](vtkPolyDataAlgorithm * a, vtkPolyDataAlgorithm * b)                                       \
    { return SameValue(static_cast<F*>(a)->Get##name(), static_cast<F*>(b)->Get##name()); },       \
      [](vtkPolyDataAlgorithm * filter)                                                            \
    {                                                                                              \
      return SetForbidden(static_cast<F*>(filter)->Get##name(),                                    \
        [filter](auto other) { static_cast<F*>(filter)->Set##name(other); });                      \
    }   \
  }

/// A positive number, rarely a negative one, which most properties do not allow.
inline double Positive(Dice& dice)
{
  return dice.Flip(24) ? -0.5 : dice.Logarithmic(1e-3, 1e3);
}
inline double ZeroOrPositive(Dice& dice, int zeroOneIn = 2)
{
  return dice.Flip(zeroOneIn) ? 0.0 : Positive(dice);
}
/// An entry of an enum with `count` entries, rarely the number after the last.
inline int Choice(Dice& dice, int count)
{
  return dice.Below(dice.Flip(24) ? count + 1 : count);
}
/// A value close to a default, so that textures still form.
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

/// The properties of every filter.
template <typename F>
List OfSurface()
{
  return {
    RANDOM_PROPERTY(F, MergeCoincidentPoints, dice.Flip()),
    RANDOM_PROPERTY(F, MergeTolerance, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, SeamTolerance, dice.Flip() ? -1.0 : ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, RefineTo, dice.Below(3) > 0 ? 0.0 : 0.3 + dice.Unit()),
    RANDOM_PROPERTY(F, MaximumNumberOfTriangles, dice.Flip() ? 50000 : 1 + dice.Below(3000)),
    RANDOM_PROPERTY(F, NumberOfThreads, dice.Below(3)),
    RANDOM_PROPERTY(F, Controller, Controller(dice)),
    RANDOM_PROPERTY(F, ResultArrayName, Name(dice)),
  };
}

/// The properties of filters with a model of arrays.
template <typename F>
List OfModel()
{
  return {
    RANDOM_PROPERTY(F, Units, Choice(dice, 2)),
    RANDOM_PROPERTY(F, MaskMode, Choice(dice, 2)),
    RANDOM_PROPERTY(F, RandomSeed, dice.Below(5)),
    RANDOM_PROPERTY(F, IntrinsicDelaunay, dice.Flip()),
    RANDOM_PROPERTY(F, OutputPrecision, Choice(dice, 3)),
  };
}

/// The properties of filters with time steps.
template <typename F>
List OfDiffusion()
{
  List list = OfModel<F>();
  for (const RandomProperty& property : {
         RANDOM_PROPERTY(F, TimeStep, Positive(dice)),
         RANDOM_PROPERTY(F, NumberOfTimeSteps, dice.Below(6) - (dice.Flip(24) ? 7 : 0)),
         RANDOM_PROPERTY(F, GenerateTimeSteps, !dice.Flip(3)),
         RANDOM_PROPERTY(F, OutputInterval, 1 + dice.Below(3)),
         RANDOM_PROPERTY(F, CheckpointMemoryLimit, dice.Below(2)),
         RANDOM_PROPERTY(F, Solver, Choice(dice, 4)),
         RANDOM_PROPERTY(F, Tolerance, dice.Flip(24) ? 2.0 : dice.Logarithmic(1e-12, 0.5)),
         RANDOM_PROPERTY(
           F, MaximumNumberOfIterations, dice.Flip(4) ? dice.Below(4) : 100 + dice.Below(900)),
       })
  {
    list.push_back(property);
  }
  return list;
}

/// The property TimeIntegrator. Bit i of timeIntegrators is set if the class has integrator i.
template <typename F>
List OfTimeIntegrators(int timeIntegrators)
{
  List list{ RANDOM_PROPERTY(F, TimeIntegrator, Choice(dice, 4)) };
  list.back().Set = [timeIntegrators](vtkPolyDataAlgorithm* filter, Dice& dice)
  {
    const int choice = Choice(dice, 4);
    const bool has = timeIntegrators >> choice & 1;
    static_cast<F*>(filter)->SetTimeIntegrator(has || dice.Flip(12) ? choice : 0);
  };
  return list;
}

/// The properties of filters with time steps that diffuse an input array.
template <typename F>
List OfDataDiffusion()
{
  List list = OfDiffusion<F>();
  for (const RandomProperty& property : {
         RANDOM_PROPERTY(F, FidelityWeight, ZeroOrPositive(dice)),
         RANDOM_PROPERTY(F, InitialFill, Choice(dice, 4)),
         RANDOM_PROPERTY(F, HoldKnownValues, dice.Flip(3)),
         RANDOM_PROPERTY(F, ResultOnCells, dice.Flip()),
         RANDOM_PROPERTY(F, KeepCellDetail, dice.Flip()),
         RANDOM_PROPERTY(F, AlongDiffusivity, dice.Flip() ? 1.0 : Positive(dice)),
         RANDOM_PROPERTY(F, AcrossDiffusivity, dice.Flip() ? 1.0 : Positive(dice)),
       })
  {
    list.push_back(property);
  }
  return list;
}

inline List OfHeat()
{
  using F = vtkFVMHeatFilter;
  return {
    RANDOM_PROPERTY(F, Mode, dice.Flip(3)),
    RANDOM_PROPERTY(F, FWHM, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, MassMatrix, Choice(dice, 3)),
    RANDOM_PROPERTY(F, Period, dice.Flip(6) ? Positive(dice) : 0.0),
    RANDOM_PROPERTY(F, VectorType, Choice(dice, dice.Flip(3) ? 3 : 2)),
    RANDOM_PROPERTY(F, VectorLaplacian, Choice(dice, 3)),
    RANDOM_PROPERTY(F, NormalPart, Choice(dice, 3)),
    RANDOM_PROPERTY(F, AutomaticFidelity, dice.Flip(3)),
    RANDOM_PROPERTY(F, NoiseLevel, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, BlurFWHM, dice.Flip(3) ? Positive(dice) : 0.0),
    RANDOM_PROPERTY(F, BlurSteps, dice.Flip(24) ? 1 : 2 + dice.Below(5)),
  };
}

inline List OfInterpolation()
{
  using F = vtkSurfaceInterpolationFilter;
  return {
    RANDOM_PROPERTY(F, PointValueArray, Name(dice)),
    RANDOM_PROPERTY(F, PointWeightArray, Name(dice)),
    RANDOM_PROPERTY(F, Exact, dice.Flip()),
    RANDOM_PROPERTY(F, AutomaticSmoothing, dice.Flip()),
    RANDOM_PROPERTY(F, NoiseLevel, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, Smoothing, Positive(dice)),
    RANDOM_PROPERTY(F, CorrelationLength, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, KeepRange, dice.Flip(4)),
    RANDOM_PROPERTY(F, ComputeError, dice.Flip()),
    RANDOM_PROPERTY(F, Robust, dice.Flip(4)),
    RANDOM_PROPERTY(F, LeaveOneOut, dice.Flip(4)),
    RANDOM_PROPERTY(F, Boundary, Choice(dice, 3)),
    RANDOM_PROPERTY(F, MaximumDistance, ZeroOrPositive(dice)),
    { "MissingValue",
      [](vtkPolyDataAlgorithm* filter, Dice& dice)
      { static_cast<F*>(filter)->AddMissingValue(dice.Flip() ? 0.0 : -9999.0); },
      [](vtkPolyDataAlgorithm* from, vtkPolyDataAlgorithm* to)
      {
        static_cast<F*>(to)->RemoveAllMissingValues();
        for (int k = 0; k < static_cast<F*>(from)->GetNumberOfMissingValues(); ++k)
        {
          static_cast<F*>(to)->AddMissingValue(static_cast<F*>(from)->GetMissingValue(k));
        }
      },
      [](vtkPolyDataAlgorithm* a, vtkPolyDataAlgorithm* b)
      {
        const int count = static_cast<F*>(a)->GetNumberOfMissingValues();
        bool areEqual = count == static_cast<F*>(b)->GetNumberOfMissingValues();
        for (int k = 0; k < count && areEqual; ++k)
        {
          areEqual =
            static_cast<F*>(a)->GetMissingValue(k) == static_cast<F*>(b)->GetMissingValue(k);
        }
        return areEqual;
      } },
    RANDOM_PROPERTY(F, AlongDiffusivity, dice.Flip() ? 1.0 : Positive(dice)),
    RANDOM_PROPERTY(F, AcrossDiffusivity, dice.Flip() ? 1.0 : Positive(dice)),
    RANDOM_PROPERTY(F, ResultOnCells, dice.Flip()),
  };
}

inline List OfSegmentation()
{
  using F = vtkSurfaceSegmentationFilter;
  return {
    RANDOM_PROPERTY(F, NumberOfRegions, 2 + dice.Below(4) - (dice.Flip(24) ? 2 : 0)),
    RANDOM_PROPERTY(F, AutomaticFidelity, dice.Flip(2)),
    RANDOM_PROPERTY(F, FidelityWeight, Positive(dice)),
    RANDOM_PROPERTY(F, AutomaticMeans, !dice.Flip(12)),
    RANDOM_PROPERTY(F, ResultOnCells, dice.Flip()),
    RANDOM_PROPERTY(F, StopTolerance, dice.Flip(24) ? 2.0 : dice.Logarithmic(1e-4, 0.5)),
    { "Mean",
      [](vtkPolyDataAlgorithm* filter, Dice& dice) {
        static_cast<F*>(filter)->SetMean(1 + dice.Below(2), dice.Below(3), 1.0 + 2.0 * dice.Unit());
      },
      [](vtkPolyDataAlgorithm* from, vtkPolyDataAlgorithm* to)
      {
        static_cast<F*>(to)->RemoveAllMeans();
        for (int region = 1; region <= 2; ++region)
        {
          for (int component = 0; component < 3; ++component)
          {
            const double mean = static_cast<F*>(from)->GetMean(region, component);
            if (mean == mean) // it is set
            {
              static_cast<F*>(to)->SetMean(region, component, mean);
            }
          }
        }
      },
      [](vtkPolyDataAlgorithm* a, vtkPolyDataAlgorithm* b)
      {
        for (int entry = 0; entry < 6; ++entry)
        {
          const double x = static_cast<F*>(a)->GetMean(1 + entry / 3, entry % 3);
          const double y = static_cast<F*>(b)->GetMean(1 + entry / 3, entry % 3);
          if (!(x == y || (x != x && y != y)))
          {
            return false;
          }
        }
        return true;
      } },
  };
}

inline List OfTotalVariation()
{
  using F = vtkIntrinsicTVFilter;
  return {
    RANDOM_PROPERTY(F, Mode, dice.Flip(3)),
    RANDOM_PROPERTY(F, Regularizer, dice.Flip(3)),
    RANDOM_PROPERTY(F, TGVLength, Positive(dice)),
    RANDOM_PROPERTY(F, EdgeFunction, Choice(dice, 6)),
    RANDOM_PROPERTY(F, AcrossEdgeFunction, dice.Flip() ? 0 : Choice(dice, 7)),
    RANDOM_PROPERTY(F, Beta, Positive(dice)),
    RANDOM_PROPERTY(F, EdgeThreshold, Positive(dice)),
    RANDOM_PROPERTY(F, ChannelCoupling, Choice(dice, 2)),
    RANDOM_PROPERTY(F, FidelityNorm, dice.Flip(3)),
    RANDOM_PROPERTY(F, AutomaticFidelity, dice.Flip(4)),
    RANDOM_PROPERTY(F, NoiseLevel, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, BlurFWHM, dice.Flip(3) ? Positive(dice) : 0.0),
    RANDOM_PROPERTY(F, BlurSteps, dice.Flip(24) ? 1 : 2 + dice.Below(5)),
    RANDOM_PROPERTY(F, AutomaticBlurFidelity, dice.Flip()),
    RANDOM_PROPERTY(F, Discretization, dice.Flip(3)),
    RANDOM_PROPERTY(F, StopTolerance, dice.Flip(24) ? 1.0 : dice.Logarithmic(1e-6, 0.5)),
    RANDOM_PROPERTY(F, ColorModel, dice.Flip() ? 0 : Choice(dice, 3)),
    RANDOM_PROPERTY(F, ChromaWeight, Positive(dice)),
    RANDOM_PROPERTY(F, ChromaticityExponent, dice.Flip() ? 1.0 : 1.0 + dice.Unit()),
    RANDOM_PROPERTY(F, ChromaticityWeight, Positive(dice)),
    RANDOM_PROPERTY(F, LinearLight, dice.Flip()),
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
    RANDOM_PROPERTY(F, TangentTo, Choice(dice, 2)),
    RANDOM_PROPERTY(F, UseAsNormals, dice.Flip()),
    RANDOM_PROPERTY(F, MoveVertices, dice.Flip()),
  };
}

inline List OfMumfordShah()
{
  using F = vtkMumfordShahFilter;
  return {
    RANDOM_PROPERTY(F, AutomaticThreshold, dice.Flip()),
    RANDOM_PROPERTY(F, NoiseLevel, dice.Flip() ? 0.0 : Positive(dice)),
    RANDOM_PROPERTY(F, SmoothingLength, Positive(dice)),
    RANDOM_PROPERTY(F, EdgeThreshold, Positive(dice)),
    RANDOM_PROPERTY(F, EdgeWidth, Positive(dice)),
    RANDOM_PROPERTY(F, StopTolerance, dice.Flip(24) ? 1.0 : dice.Logarithmic(1e-6, 0.5)),
    RANDOM_PROPERTY(F, EdgeCurves, dice.Flip()),
  };
}

inline List OfTensorDiffusion()
{
  using F = vtkTensorDiffusionFilter;
  return {
    RANDOM_PROPERTY(F, Model, Choice(dice, 3)),
    RANDOM_PROPERTY(F, ColorScale, Positive(dice)),
    RANDOM_PROPERTY(F, Metric, Choice(dice, 2)),
    RANDOM_PROPERTY(F, NoiseScale, ZeroOrPositive(dice, 4)),
    RANDOM_PROPERTY(F, IntegrationScale, ZeroOrPositive(dice, 4)),
    RANDOM_PROPERTY(F, Contrast, Positive(dice)),
    RANDOM_PROPERTY(F, Alpha, dice.Flip(24) ? 2.0 : dice.Logarithmic(1e-6, 1.0)),
    RANDOM_PROPERTY(F, DiffusionAxes, dice.Flip(3)),
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
    RANDOM_PROPERTY(F, CoarseStartSize, dice.Flip() ? 1 : 50000),
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

inline List OfDenoising()
{
  using F = vtkSurfaceDenoisingFilter;
  return {
    RANDOM_PROPERTY(F, NoiseLevel, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, NoiseLength, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, SurfaceType, Choice(dice, 3)),
    RANDOM_PROPERTY(F, CreaseAngle, dice.Flip() ? 0.0 : 180.0 * dice.Unit()),
    RANDOM_PROPERTY(F, DisplacementLimit, ZeroOrPositive(dice)),
  };
}

inline List OfRelief()
{
  using F = vtkSurfaceReliefFilter;
  return {
    RANDOM_PROPERTY(F, Height, (dice.Flip() ? 0.01 : -0.01) * ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, Base, (dice.Flip() ? 0.01 : -0.01) * ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, Levels, Choice(dice, 2)),
    RANDOM_PROPERTY(F, Threshold, 4.0 * dice.Unit()),
    RANDOM_PROPERTY(F, Flank, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, Overhang, dice.Flip() ? -1.0 : 90.0 * dice.Unit()),
    RANDOM_PROPERTY(F, UpDirection, Color(dice).data()),
  };
}

inline List OfCurvature()
{
  using F = vtkSurfaceCurvatureFilter;
  return { RANDOM_PROPERTY(F, FWHM, ZeroOrPositive(dice)) };
}

inline List OfRandomField()
{
  using F = vtkSurfaceRandomFieldFilter;
  return {
    RANDOM_PROPERTY(F, Covariance, Choice(dice, 4)),
    RANDOM_PROPERTY(F, FWHM, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, Range, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, Smoothness, dice.Logarithmic(0.1, 4.0)),
    RANDOM_PROPERTY(F, NumberOfFields, 1 + dice.Below(20)),
    RANDOM_PROPERTY(F, RandomSeed, dice.Below(100) - 50),
    RANDOM_PROPERTY(F, Normalize, dice.Flip()),
  };
}

inline List OfDerivatives()
{
  using F = vtkSurfaceDerivativesFilter;
  return {
    RANDOM_PROPERTY(F, Quantity, Choice(dice, 5)),
    RANDOM_PROPERTY(F, SmoothingFWHM, ZeroOrPositive(dice)),
    RANDOM_PROPERTY(F, ResultOnCells, dice.Flip()),
  };
}

inline List OfDistance()
{
  using F = vtkSurfaceDistanceFilter;
  return {
    RANDOM_PROPERTY(F, Method, Choice(dice, 4)),
    RANDOM_PROPERTY(F, MaximumDistance, ZeroOrPositive(dice)),
    // Most runs have neither directions nor a method for them, which other speeds need.
    RANDOM_PROPERTY(F, AlongSpeed, dice.Flip(6) ? Positive(dice) : 1.0),
    RANDOM_PROPERTY(F, AcrossSpeed, dice.Flip(6) ? Positive(dice) : 1.0),
    RANDOM_PROPERTY(F, ComputeGradient, dice.Flip()),
    RANDOM_PROPERTY(F, Signed, dice.Flip(4)),
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
  using Shah = vtkMumfordShahFilter;
  using Tensor = vtkTensorDiffusionFilter;
  using Turing = vtkTuringTextureFilter;
  using Direction = vtkSurfaceDirectionFieldFilter;
  return {
    MakeClass<Heat>(
      { OfSurface<Heat>(), OfDataDiffusion<Heat>(), OfTimeIntegrators<Heat>(0b1011), OfHeat() }),
    MakeClass<TV>({ OfSurface<TV>(), OfDataDiffusion<TV>(), OfTimeIntegrators<TV>(0b0101),
      OfTotalVariation() }),
    MakeClass<Harmonic>({ OfSurface<Harmonic>(), OfDataDiffusion<Harmonic>(),
      OfTimeIntegrators<Harmonic>(0b0001), OfHarmonicMap() }),
    MakeClass<Shah>({ OfSurface<Shah>(), OfDataDiffusion<Shah>(), OfMumfordShah() }),
    MakeClass<Tensor>({ OfSurface<Tensor>(), OfDataDiffusion<Tensor>(), OfTensorDiffusion() }),
    MakeClass<Turing>({ OfSurface<Turing>(), OfDiffusion<Turing>(),
      OfTimeIntegrators<Turing>(0b0011), OfTexture() }),
    MakeClass<vtkSurfaceDenoisingFilter>({ OfSurface<vtkSurfaceDenoisingFilter>(), OfDenoising() }),
    MakeClass<vtkSurfaceCurvatureFilter>({ OfSurface<vtkSurfaceCurvatureFilter>(), OfCurvature() }),
    MakeClass<vtkSurfaceRandomFieldFilter>(
      { OfSurface<vtkSurfaceRandomFieldFilter>(), OfRandomField() }),
    MakeClass<vtkSurfaceDerivativesFilter>(
      { OfSurface<vtkSurfaceDerivativesFilter>(), OfDerivatives() }),
    MakeClass<vtkSurfaceDistanceFilter>({ OfSurface<vtkSurfaceDistanceFilter>(), OfDistance() }),
    MakeClass<Direction>({ OfSurface<Direction>(), OfDirectionField() }),
    MakeClass<vtkSurfaceReliefFilter>({ OfSurface<vtkSurfaceReliefFilter>(), OfRelief() }),
    MakeClass<vtkSurfaceSegmentationFilter>({ OfSurface<vtkSurfaceSegmentationFilter>(),
      OfModel<vtkSurfaceSegmentationFilter>(), OfSegmentation() }),
    MakeClass<vtkSurfaceInterpolationFilter>({ OfSurface<vtkSurfaceInterpolationFilter>(),
      OfModel<vtkSurfaceInterpolationFilter>(), OfInterpolation() }),
  };
}

} // namespace FilterTest
