// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkInformation.h"
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

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

/// The filters for tests of properties that all of them have.
namespace FilterTest
{

struct FilterKind
{
  const char* Name;
  std::function<vtkSmartPointer<vtkPolyDataAlgorithm>()>
    Make; ///< with few time steps, if it has any
  const char* Result; ///< the array it adds
  bool IsSlow = false; ///< takes minutes on surfaces that suit the others

  /// The levels of a sphere for tests: those that suit the other kinds, or fewer.
  int Levels(int ofOthers) const { return this->IsSlow ? std::min(ofOthers, 3) : ofOthers; }
};

/// The kind with a flag that it is slow.
inline FilterKind Slow(FilterKind kind)
{
  kind.IsSlow = true;
  return kind;
}

template <typename Filter>
FilterKind MakeKind(
  const char* name, const char* result, int steps,
  const std::function<void(Filter*)>& set = [](Filter*) {})
{
  return { name,
    [=]() -> vtkSmartPointer<vtkPolyDataAlgorithm>
    {
      auto filter = vtkSmartPointer<Filter>::New();
      if constexpr (std::is_base_of_v<vtkSurfaceDiffusionAlgorithm, Filter>)
      {
        filter->SetNumberOfTimeSteps(steps);
      }
      if constexpr (std::is_same_v<vtkIntrinsicTVFilter, Filter>)
      {
        filter->AutomaticFidelityOff(); // some kinds turn it on, which takes longer
      }
      set(filter);
      return filter;
    },
    result };
}

/// The array that a run of this kind diffuses or fills in, "f", "rgb" or "c"; empty if there is none.
inline std::string DiffusedArray(const FilterKind& kind)
{
  const std::string result = kind.Result;
  const std::size_t end = result.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ");
  const std::string name = result.substr(0, end == std::string::npos ? 0 : end);
  return name == "f" || name == "rgb" || name == "c" ? name : "";
}

/// Whether SetInputArrayToProcess() has chosen an array of this index by its name.
inline bool HasInputArray(vtkAlgorithm* filter, int index)
{
  return filter->GetInputArrayInformation(index)->Has(vtkDataObject::FIELD_NAME()) != 0;
}

/// The weight of a point or cell in "weights" of AddArraysOfAllFilters().
inline double WeightOf(vtkIdType i)
{
  return i % 17 == 5 ? 0.0 : 0.5 + 0.25 * static_cast<double>(i % 4);
}

/// Adds the arrays other than "f" that some of AllFilters() take: the rough array "c" of cells,
/// the colours "rgb", the mask "mask", the directions "e1" and the labels "sources" of points, and the
/// weights "weights" of both, some of them 0.
inline void AddArraysOfAllFilters(vtkPolyData* surface)
{
  surface->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "c", surface->GetNumberOfCells(), 1,
    [](vtkIdType i, int k) { return 2.0 + Rough(i, k); }));
  AddPointArray(
    surface, "rgb", 3, [](vtkIdType i, int k) { return 120.0 + 100.0 * Rough(i, k); },
    VTK_UNSIGNED_CHAR);
  AddPointArray(surface, "mask", 1, [](vtkIdType i, int) { return i % 17 == 3; });
  const auto weight = [](vtkIdType i, int) { return WeightOf(i); };
  AddPointArray(surface, "weights", 1, weight);
  surface->GetCellData()->AddArray(
    MakeArray(VTK_DOUBLE, "weights", surface->GetNumberOfCells(), 1, weight));
  AddPointArray(surface, "e1", 3, [](vtkIdType i, int k) { return k + 0.3 * Rough(i, k); });
  // One of them is a corner of the largest triangle, which takes part.
  vtkIdType largest = 0;
  double area = 0.0;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    vtkNew<vtkIdList> corners;
    surface->GetCellPoints(c, corners);
    double p[3][3];
    for (vtkIdType a = 0; a < 3; ++a)
    {
      surface->GetPoint(corners->GetId(a), p[a]);
    }
    const double found = vtkTriangle::TriangleArea(p[0], p[1], p[2]);
    largest = found > area ? corners->GetId(0) : largest;
    area = std::max(area, found);
  }
  AddPointArray(surface, "sources", 1,
    [&](vtkIdType i, int) { return i == largest || i % 17 == 3 ? 1 + i % 3 : 0; });
}

/// Every filter, also with the settings that select other algorithms.
inline std::vector<FilterKind> AllFilters()
{
  using Heat = vtkFVMHeatFilter;
  using TV = vtkIntrinsicTVFilter;
  using Harmonic = vtkHarmonicMapFilter;
  using Shah = vtkMumfordShahFilter;
  using Segmentation = vtkSurfaceSegmentationFilter;
  using Spline = vtkSurfaceInterpolationFilter;
  using Tensor = vtkTensorDiffusionFilter;
  using Turing = vtkTuringTextureFilter;
  const auto holdToData = [](Segmentation* f) // noise has no regions if the weight is small
  {
    f->AutomaticFidelityOff();
    f->SetFidelityWeight(50.0);
    f->SetStopTolerance(0.1);
  };
  return {
    MakeKind<Heat>("Heat", "fDiffused", 3),
    MakeKind<Heat>(
      "HeatConjugateGradient", "fDiffused", 3, [](Heat* f) { f->SetSolverToConjugateGradient(); }),
    MakeKind<Heat>("HeatDirect", "fDiffused", 3, [](Heat* f) { f->SetSolverToDirect(); }),
    MakeKind<Heat>("HeatDelaunay", "fDiffused", 3, [](Heat* f) { f->IntrinsicDelaunayOn(); }),
    MakeKind<Heat>("HeatSteady", "fDiffused", 1,
      [](Heat* f)
      {
        f->SetModeToSteadyState();
        f->SetFidelityWeight(0.1);
      }),
    MakeKind<Heat>("HeatExponential", "fDiffused", 2,
      [](Heat* f)
      {
        f->SetTimeIntegratorToExponential();
        f->SetMassMatrixToMixed();
      }),
    MakeKind<Heat>("HeatMixed", "fDiffused", 2, [](Heat* f) { f->SetMassMatrixToMixed(); }),
    MakeKind<Heat>("HeatPeriodic", "fDiffused", 2, [](Heat* f) { f->SetPeriod(0.7); }),
    MakeKind<Heat>("HeatPeriodicOfCells", "cDiffused", 2,
      [](Heat* f)
      {
        f->SetPeriod(0.7);
        f->SetModeToSteadyState();
        f->AutomaticFidelityOn();
        SetInputArray(f, 0, "c", true);
      }),
    MakeKind<Heat>("HeatTangent", "e1Diffused", 2,
      [](Heat* f)
      {
        f->SetVectorTypeToTangent();
        f->SetNormalPartToDiffuse();
        SetInputArray(f, 0, "e1");
      }),
    MakeKind<Heat>("HeatTangentViscous", "e1Diffused", 2,
      [](Heat* f)
      {
        f->SetVectorTypeToTangent();
        f->SetVectorLaplacianToViscous();
        f->SetTimeIntegratorToExponential();
        f->SetMassMatrixToMixed();
        SetInputArray(f, 0, "e1");
        SetInputArray(f, 1, "mask");
      }),
    MakeKind<Heat>("HeatTangentSteady", "e1Diffused", 1,
      [](Heat* f)
      {
        f->SetVectorTypeToTangent();
        f->SetVectorLaplacianToHodge();
        f->SetModeToSteadyState();
        f->AutomaticFidelityOn();
        SetInputArray(f, 0, "e1");
      }),
    MakeKind<Heat>("HeatAutomatic", "fDiffused", 3, [](Heat* f) { f->AutomaticFidelityOn(); }),
    MakeKind<Heat>("HeatDeblurred", "fDiffused", 1,
      [](Heat* f)
      {
        f->SetModeToSteadyState();
        f->SetFidelityWeight(1.0);
        f->SetBlurFWHM(0.3);
        SetInputArray(f, 1, "mask");
      }),
    Slow(MakeKind<Heat>("HeatDeblurredFound", "fDiffused", 1,
      [](Heat* f)
      {
        f->SetModeToSteadyState();
        f->SetBlurFWHM(0.3);
        f->SetNoiseLevel(0.3);
      })),
    MakeKind<Heat>("HeatMultigrid", "fDiffused", 3, [](Heat* f) { f->SetSolverToMultigrid(); }),
    MakeKind<Heat>("HeatExcluded", "fDiffused", 3,
      [](Heat* f)
      {
        f->SetMaskModeToExclude();
        SetInputArray(f, 1, "mask");
      }),
    MakeKind<Heat>("HeatOfCells", "cDiffused", 3, [](Heat* f) { SetInputArray(f, 0, "c", true); }),
    MakeKind<Heat>("HeatWeighted", "fDiffused", 1,
      [](Heat* f)
      {
        f->SetModeToSteadyState();
        f->SetFidelityWeight(0.1);
        SetInputArray(f, 5, "weights");
      }),
    MakeKind<Heat>("HeatExponentialOfCells", "cDiffused", 2,
      [](Heat* f)
      {
        f->SetTimeIntegratorToExponential();
        SetInputArray(f, 0, "c", true);
      }),
    MakeKind<TV>("TV", "fTV", 3),
    MakeKind<TV>("TVImplicit", "fTV", 2, [](TV* f) { f->SetTimeIntegratorToImplicit(); }),
    MakeKind<TV>("TVSteady", "fTV", 1, [](TV* f) { f->SetModeToSteadyState(); }),
    MakeKind<TV>("TVGeneralized", "fTV", 1,
      [](TV* f)
      {
        f->SetModeToSteadyState();
        f->SetRegularizerToTGV();
        f->SetStopTolerance(1e-2);
      }),
    MakeKind<TV>(
      "TVCrouzeixRaviart", "fTV", 2, [](TV* f) { f->SetDiscretizationToCrouzeixRaviart(); }),
    MakeKind<TV>("TVAutomatic", "fTV", 1,
      [](TV* f)
      {
        f->SetModeToSteadyState();
        f->AutomaticFidelityOn();
        f->SetNoiseLevel(0.3);
      }),
    MakeKind<TV>("TVAbsolute", "fTV", 2,
      [](TV* f)
      {
        f->SetTimeIntegratorToImplicit();
        f->SetFidelityNormToL1();
      }),
    MakeKind<TV>("TVDeblurred", "fTV", 1,
      [](TV* f)
      {
        f->SetModeToSteadyState();
        f->SetFidelityWeight(10.0);
        f->SetBlurFWHM(0.3);
        f->SetStopTolerance(1e-2);
      }),
    Slow(MakeKind<TV>("TVDeblurredFound", "fTV", 1,
      [](TV* f)
      {
        f->AutomaticFidelityOn();
        f->SetModeToSteadyState();
        f->SetBlurFWHM(0.3);
        f->SetNoiseLevel(0.3);
        f->SetStopTolerance(0.1);
      })),
    MakeKind<TV>("TVOfCells", "cTV", 2, [](TV* f) { SetInputArray(f, 0, "c", true); }),
    MakeKind<TV>("TVWeighted", "fTV", 1,
      [](TV* f)
      {
        f->SetModeToSteadyState();
        SetInputArray(f, 5, "weights");
      }),
    MakeKind<TV>("TVOfWeightedCells", "cTV", 1,
      [](TV* f)
      {
        f->SetModeToSteadyState();
        SetInputArray(f, 0, "c", true);
        SetInputArray(f, 5, "weights", true);
      }),
    MakeKind<TV>("TVOpponent", "rgbTV", 2,
      [](TV* f)
      {
        f->SetColorModelToOpponent();
        SetInputArray(f, 0, "rgb");
      }),
    MakeKind<TV>("TVChromaticity", "rgbTV", 2,
      [](TV* f)
      {
        f->SetColorModelToChromaticityBrightness();
        SetInputArray(f, 0, "rgb");
      }),
    MakeKind<TV>("PeronaMalik", "fTV", 3,
      [](TV* f)
      {
        f->SetEdgeFunctionToPeronaMalikRational();
        f->SetFidelityWeight(0.1);
      }),
    MakeKind<Harmonic>("Harmonic", "NormalsHarmonic", 2),
    MakeKind<Harmonic>(
      "HarmonicMoved", "NormalsHarmonic", 2, [](Harmonic* f) { f->MoveVerticesOn(); }),
    MakeKind<Harmonic>("HarmonicExplicit", "NormalsHarmonic", 2,
      [](Harmonic* f) { f->SetSchemeToExplicitReaction(); }),
    MakeKind<Harmonic>("HarmonicLines", "NormalsHarmonic", 2,
      [](Harmonic* f)
      {
        f->LineFieldOn();
        f->UseAsNormalsOff();
      }),
    MakeKind<Harmonic>("HarmonicTangent", "e1Harmonic", 2,
      [](Harmonic* f)
      {
        SetInputArray(f, 0, "e1");
        f->SetTangentToToSurface();
      }),
    MakeKind<Harmonic>("HarmonicMinimizing", "NormalsHarmonic", 1,
      [](Harmonic* f) { f->SetSchemeToMinimizingMovement(); }),
    MakeKind<Shah>("MumfordShah", "fMumfordShah", 4),
    MakeKind<Shah>(
      "MumfordShahGiven", "fMumfordShah", 4, [](Shah* f) { f->AutomaticThresholdOff(); }),
    MakeKind<Shah>(
      "MumfordShahOfCells", "cMumfordShah", 4, [](Shah* f) { SetInputArray(f, 0, "c", true); }),
    MakeKind<Shah>(
      "MumfordShahWeighted", "fMumfordShah", 4, [](Shah* f) { SetInputArray(f, 5, "weights"); }),
    MakeKind<Shah>("MumfordShahDirect", "fMumfordShah", 3,
      [](Shah* f)
      {
        f->SetSolverToDirect();
        f->IntrinsicDelaunayOn();
      }),
    MakeKind<Tensor>("Beltrami", "fBeltrami", 3),
    MakeKind<Tensor>("BeltramiFixed", "fBeltrami", 3,
      [](Tensor* f)
      {
        f->SetMetricToFixed();
        f->SetTimeStep(1e4);
      }),
    MakeKind<Tensor>(
      "BeltramiOfCells", "cBeltrami", 3, [](Tensor* f) { SetInputArray(f, 0, "c", true); }),
    MakeKind<Tensor>("BeltramiWeighted", "fBeltrami", 3,
      [](Tensor* f)
      {
        f->SetFidelityWeight(0.1);
        SetInputArray(f, 5, "weights", true);
      }),
    MakeKind<Tensor>("CoherenceEnhancing", "fCoherent", 2,
      [](Tensor* f)
      {
        f->SetModelToCoherenceEnhancing();
        f->SetSolverToDirect(); // on needles, errors of other solvers raise the variance
        f->DiffusionAxesOn();
      }),
    MakeKind<Tensor>("EdgeEnhancing", "fEdgeEnhanced", 3,
      [](Tensor* f)
      {
        f->SetModelToEdgeEnhancing();
        f->SetSolverToDirect();
      }),
    MakeKind<Turing>("Turing", "u1", 4),
    MakeKind<Turing>("TuringFirstOrder", "u1", 4,
      [](Turing* f)
      {
        f->SetTimeIntegratorToFirstOrder();
        f->ColorOutputOn();
      }),
    MakeKind<Turing>("TuringCoarseStart", "u1", 4,
      [](Turing* f)
      {
        f->SetCoarseStartSize(300);
        f->SetDiffusionRate1(22.0); // so that waves have eleven edges on coarse surfaces, too
      }),
    MakeKind<Segmentation>("SegmentationDefaults", "RegionId", 1),
    MakeKind<Segmentation>("Segmentation", "RegionId", 1, holdToData),
    MakeKind<Segmentation>("SegmentationOfThree", "RegionId", 1,
      [=](Segmentation* f)
      {
        f->SetNumberOfRegions(3);
        f->AutomaticMeansOff();
        holdToData(f);
      }),
    MakeKind<Segmentation>("SegmentationWeighted", "RegionId", 1,
      [=](Segmentation* f)
      {
        holdToData(f);
        SetInputArray(f, 5, "weights");
      }),
    Slow(MakeKind<Segmentation>("SegmentationOfCells", "RegionId", 1,
      [=](Segmentation* f)
      {
        holdToData(f);
        SetInputArray(f, 0, "c", true);
      })),
    Slow(MakeKind<Spline>("Interpolation", "fInterpolated", 1,
      [](Spline* f)
      {
        SetInputArray(f, 1, "mask");
        f->ComputeErrorOn();
      })),
    MakeKind<Spline>("InterpolationFree", "fInterpolated", 1,
      [](Spline* f)
      {
        SetInputArray(f, 1, "mask");
        f->SetBoundaryToFree();
        f->ExactOn();
      }),
    MakeKind<Spline>("InterpolationNatural", "fInterpolated", 1,
      [](Spline* f)
      {
        SetInputArray(f, 1, "mask");
        f->SetBoundaryToNatural();
        f->ComputeErrorOn();
      }),
    Slow(MakeKind<Spline>("InterpolationWeighted", "fInterpolated", 1,
      [](Spline* f) { SetInputArray(f, 5, "weights"); })),
    Slow(MakeKind<Spline>("InterpolationRobust", "fInterpolated", 1,
      [](Spline* f)
      {
        SetInputArray(f, 1, "mask");
        f->RobustOn();
        f->LeaveOneOutOn();
      })),
    Slow(MakeKind<Spline>("InterpolationOfCells", "cInterpolated", 1,
      [](Spline* f) { SetInputArray(f, 0, "c", true); })),
    { "Denoising", [] { return vtkSmartPointer<vtkSurfaceDenoisingFilter>::New(); },
      "Displacement" },
    MakeKind<vtkSurfaceDenoisingFilter>("DenoisingOfLevel", "Displacement", 0,
      [](vtkSurfaceDenoisingFilter* f) { f->SetNoiseLevel(0.02); }),
    MakeKind<vtkSurfaceDenoisingFilter>("DenoisingOrganic", "Displacement", 0,
      [](vtkSurfaceDenoisingFilter* f)
      {
        f->SetNoiseLevel(0.02);
        f->SetSurfaceTypeToOrganic();
      }),
    MakeKind<vtkSurfaceDenoisingFilter>("DenoisingCorrelated", "Displacement", 0,
      [](vtkSurfaceDenoisingFilter* f)
      {
        f->SetNoiseLevel(0.03);
        f->SetNoiseLength(1.5);
        f->SetDisplacementLimit(0.02);
        SetInputArray(f, 6, "sources");
      }),
    MakeKind<vtkSurfaceReliefFilter>("Relief", "ReliefHeight", 0,
      [](vtkSurfaceReliefFilter* f)
      {
        f->SetHeight(0.02);
        SetInputArray(f, 0, "f");
      }),
    MakeKind<vtkSurfaceReliefFilter>("ReliefOfTwoLevels", "ReliefHeight", 0,
      [](vtkSurfaceReliefFilter* f)
      {
        f->SetHeight(-0.05);
        f->SetBase(0.03);
        f->SetLevelsToTwo();
        f->SetFlank(0.05);
        f->SetOverhang(60.0);
        SetInputArray(f, 0, "f");
        SetInputArray(f, 1, "mask");
      }),
    MakeKind<vtkSurfaceRandomFieldFilter>("RandomField", "RandomField", 0,
      [](vtkSurfaceRandomFieldFilter* f)
      {
        f->SetFWHM(0.5);
        f->SetNumberOfFields(2);
      }),
    MakeKind<vtkSurfaceRandomFieldFilter>("RandomFieldOfMatern", "RandomField", 0,
      [](vtkSurfaceRandomFieldFilter* f)
      {
        f->SetCovarianceToMatern();
        f->SetSmoothness(3.0);
        f->SetRange(0.8);
        f->NormalizeOff();
        f->SetRandomSeed(7);
        SetInputArray(f, 1, "mask");
      }),
    { "Curvature", [] { return vtkSmartPointer<vtkSurfaceCurvatureFilter>::New(); },
      "MeanCurvature" },
    { "CurvatureAtScale",
      []
      {
        auto filter = vtkSmartPointer<vtkSurfaceCurvatureFilter>::New();
        filter->SetFWHM(0.3);
        SetInputArray(filter, 1, "mask");
        return filter;
      },
      "MeanCurvature" },
    { "Gradient",
      []
      {
        auto filter = vtkSmartPointer<vtkSurfaceDerivativesFilter>::New();
        SetInputArray(filter, 0, "f");
        return filter;
      },
      "fGradient" },
    { "Helmholtz",
      []
      {
        auto filter = vtkSmartPointer<vtkSurfaceDerivativesFilter>::New();
        SetInputArray(filter, 0, "e1");
        SetInputArray(filter, 1, "mask");
        filter->SetQuantityToHelmholtz();
        return filter;
      },
      "e1GradientPotential" },
    { "ConductionVelocity",
      []
      {
        auto filter = vtkSmartPointer<vtkSurfaceDerivativesFilter>::New();
        SetInputArray(filter, 0, "f");
        SetInputArray(filter, 1, "mask");
        filter->SetQuantityToConductionVelocity();
        filter->SetSmoothingFWHM(0.3);
        return filter;
      },
      "fConductionVelocity" },
    { "SpeedWithBand",
      []
      {
        auto filter = vtkSmartPointer<vtkSurfaceDerivativesFilter>::New();
        SetInputArray(filter, 0, "f");
        SetInputArray(filter, 10, "weights");
        filter->SetQuantityToConductionVelocity();
        return filter;
      },
      "fConductionVelocity" },
    MakeKind<vtkSurfaceDistanceFilter>("DistanceHeat", "Distance", 0,
      [](vtkSurfaceDistanceFilter* f)
      {
        f->SetMethodToHeat();
        f->ComputeGradientOn();
        SetInputArray(f, 0, "sources");
      }),
    MakeKind<vtkSurfaceDistanceFilter>("DistanceExact", "Distance", 0,
      [](vtkSurfaceDistanceFilter* f)
      {
        f->SetMethodToExact();
        SetInputArray(f, 0, "sources");
        f->SetInputData(2, Sphere(0)); // the points that paths lead from
      }),
    MakeKind<vtkSurfaceDistanceFilter>("DistanceEikonal", "Distance", 0,
      [](vtkSurfaceDistanceFilter* f)
      {
        f->SetMethodToEikonal();
        SetInputArray(f, 0, "sources");
      }),
    MakeKind<vtkSurfaceDistanceFilter>("DistanceSigned", "Distance", 0,
      [](vtkSurfaceDistanceFilter* f)
      {
        f->SignedOn();
        SetInputArray(f, 0, "sources");
      }),
    MakeKind<vtkSurfaceDistanceFilter>("ArrivalTime", "ArrivalTime", 0,
      [](vtkSurfaceDistanceFilter* f)
      {
        f->SetMethodToEikonal();
        f->ComputeGradientOn();
        SetInputArray(f, 0, "sources");
        SetInputArray(f, 8, "c", true);
      }),
    MakeKind<vtkSurfaceDistanceFilter>("ArrivalTimeDirected", "ArrivalTime", 0,
      [](vtkSurfaceDistanceFilter* f)
      {
        f->SetMethodToEikonal();
        f->SetAlongSpeed(2.0);
        SetInputArray(f, 0, "sources");
        SetInputArray(f, 2, "e1");
        SetInputArray(f, 8, "c", true);
      }),
    { "DirectionCurvature", [] { return vtkSmartPointer<vtkSurfaceDirectionFieldFilter>::New(); },
      "Direction" },
    { "DirectionSmooth",
      []
      {
        auto filter = vtkSmartPointer<vtkSurfaceDirectionFieldFilter>::New();
        filter->SetMethodToSmooth();
        return filter;
      },
      "Direction" },
    { "DirectionAligned",
      []
      {
        auto filter = vtkSmartPointer<vtkSurfaceDirectionFieldFilter>::New();
        filter->SetMethodToCurvatureAligned();
        return filter;
      },
      "Direction" },
    { "DirectionHints",
      []
      {
        auto filter = vtkSmartPointer<vtkSurfaceDirectionFieldFilter>::New();
        filter->SetMethodToHints();
        SetInputArray(filter, 2, "e1");
        return filter;
      },
      "Direction" },
  };
}

inline std::string KindName(const testing::TestParamInfo<FilterKind>& info)
{
  return info.param.Name;
}

inline void PrintTo(const FilterKind& kind, std::ostream* os)
{
  *os << kind.Name;
}

/// The array that the filter has added to points or cells; null if there is none.
inline vtkDataArray* ResultOf(vtkPolyDataAlgorithm* filter, const char* name)
{
  vtkPolyData* output = filter->GetOutput();
  vtkDataArray* ofPoints = output->GetPointData()->GetArray(name);
  return ofPoints ? ofPoints : output->GetCellData()->GetArray(name);
}

/// Whether the output has the points, cells and arrays of the input, shared, and no others.
inline bool IsUnchanged(vtkPolyDataAlgorithm* filter, vtkPolyData* input)
{
  vtkPolyData* output = filter->GetOutput();
  bool same = output->GetPoints() == input->GetPoints() &&
    output->GetPolys() == input->GetPolys() &&
    output->GetPointData()->GetNumberOfArrays() == input->GetPointData()->GetNumberOfArrays() &&
    output->GetCellData()->GetNumberOfArrays() == input->GetCellData()->GetNumberOfArrays();
  for (int i = 0; same && i < input->GetPointData()->GetNumberOfArrays(); ++i)
  {
    same =
      output->GetPointData()->GetAbstractArray(i) == input->GetPointData()->GetAbstractArray(i);
  }
  return same;
}

} // namespace FilterTest
