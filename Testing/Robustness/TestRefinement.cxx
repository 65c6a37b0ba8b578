// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// RefineTo of every kind of run, its limit, and the surfaces in pieces that it keeps together.

#include "Core/Foundation/Random.h"
#include "Twins.h"

#include "vtkPartitionedDataSet.h"

#include <algorithm>
#include <cmath>

using namespace FilterTest;

namespace
{

constexpr double Length = 0.25; // of a sphere of 80 triangles

/// A coarse sphere with the arrays of all filters, and the same with bisected edges.
struct Spheres
{
  vtkSmartPointer<vtkPolyData> Coarse = Sphere(1);
  vtkNew<vtkPolyData> Fine;

  /// ruled: the index of the array that has a rule of its own, a mask, weights or marks; -1: none.
  explicit Spheres(int ruled)
  {
    AddRough(this->Coarse);
    AddArraysOfAllFilters(this->Coarse);
    AddPointArray(this->Coarse, "none", 1, [](vtkIdType, int) { return 0.0; });
    vtkNew<vtkSurfaceReliefFilter> relief;
    relief->SetInputData(this->Coarse);
    SetInputArray(relief, 0, "none");
    if (ruled >= 0)
    {
      SetInputArray(relief, ruled, ruled == 1 ? "mask" : ruled == 3 ? "sources" : "weights");
    }
    relief->SetRefineTo(Length);
    relief->Update();
    this->Fine->ShallowCopy(relief->GetOutput());
    this->Fine->GetPointData()->RemoveArray("ReliefHeight");
    this->Fine->GetPointData()->SetActiveScalars("f");
  }
};

class RefinementOf : public testing::TestWithParam<FilterKind>
{
};

/// The part of a box in which z is below or above a plane, refined so far that parts differ.
vtkSmartPointer<vtkPolyData> BoxPart(bool upper)
{
  const double low = upper ? 1.0 : 0.0;
  const double high = upper ? 4.0 : 1.0;
  auto part = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 8; ++i)
  {
    points->InsertNextPoint(3.0 * (i & 1), 2.0 * (i >> 1 & 1), i < 4 ? low : high);
  }
  vtkNew<vtkCellArray> squares;
  const vtkIdType sides[5][4] = { { 0, 1, 5, 4 }, { 1, 3, 7, 5 }, { 3, 2, 6, 7 }, { 2, 0, 4, 6 },
    { 0, 2, 3, 1 } };
  for (const auto& side : sides)
  {
    squares->InsertNextCell(4, side);
  }
  if (upper) // the top in place of the bottom
  {
    const vtkIdType top[4] = { 4, 5, 7, 6 };
    squares->ReplaceCellAtId(4, 4, top);
  }
  part->SetPoints(points);
  part->SetPolys(squares);
  AddPointArray(part, "Texture", 1, [](vtkIdType, int) { return 1.0; });
  return part;
}

} // namespace

TEST_P(RefinementOf, GivesWhatTheFilterGivesOnTheRefinedSurface)
{
  const auto refining = this->GetParam().Make();
  static const Spheres plain(-1), withMask(1), withSources(3), withWeights(5);
  const bool hasMarks = refining->IsA("vtkSurfaceDistanceFilter") || HasInputArray(refining, 6);
  const Spheres& spheres = hasMarks ? withSources
    : HasInputArray(refining, 1)    ? withMask
    : HasInputArray(refining, 5)    ? withWeights
                                    : plain;
  const auto given = this->GetParam().Make();
  vtkSurfaceFilter::SafeDownCast(refining)->SetRefineTo(Length);
  refining->SetInputData(spheres.Coarse);
  given->SetInputData(spheres.Fine);
  Messages messages(refining);
  Messages ofGiven(given);
  refining->Update();
  given->Update();
  EXPECT_EQ(Sentences(messages), std::vector<std::string>());
  EXPECT_EQ(messages.Warnings.size(), ofGiven.Warnings.size());
  EXPECT_GT(refining->GetOutput()->GetNumberOfCells(), 4 * spheres.Coarse->GetNumberOfCells());
  EXPECT_NE(refining->GetOutput()->GetCellData()->GetArray("vtkOriginalCellIds"), nullptr);
  EXPECT_NE(
    refining->GetOutput()->GetPointData()->GetArray(this->GetParam().Result.c_str()) != nullptr,
    refining->GetOutput()->GetCellData()->GetArray(this->GetParam().Result.c_str()) != nullptr);
  EXPECT_EQ(Difference(refining, given), "");
}

/// Those that ask for the noise of the data, or for the places of the values, take what was
/// measured: on a surface that was given so, all values were.
std::vector<FilterKind> FiltersThatTakeAllValues()
{
  std::vector<FilterKind> kinds = AllFilters();
  const auto asks = [](const FilterKind& kind)
  {
    const std::string name = kind.Name;
    return name.rfind("Interpolation", 0) == 0 || name.rfind("MumfordShah", 0) == 0 ||
      name == "SegmentationOfCells" || name == "HeatAutomatic" || name == "TVAutomatic" ||
      name == "HeatPeriodicOfCells" || name == "HeatTangentSteady" ||
      name == "HeatDeblurredFound" || name == "TVDeblurredFound";
  };
  kinds.erase(std::remove_if(kinds.begin(), kinds.end(), asks), kinds.end());
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(
  EveryKind, RefinementOf, testing::ValuesIn(FiltersThatTakeAllValues()), KindName);

TEST(Refinement, PointsBetweenWeightlessOnesAndOthersHaveNoWeight)
{
  for (const FilterKind& kind : AllFilters())
  {
    const std::string name = kind.Name;
    if (name != "HeatWeighted" && name != "TVWeighted" && name != "SegmentationWeighted")
    {
      continue;
    }
    SCOPED_TRACE(name);
    // A step, and other values or none where points have no weight.
    std::vector<vtkSmartPointer<vtkPolyDataAlgorithm>> filters;
    for (const double other : { 1e3, std::nan("") })
    {
      const auto sphere = Sphere(2);
      AddPointArray(sphere, "weights", 1,
        [&](vtkIdType i, int) { return sphere->GetPoint(i)[0] > 0.4 ? 0.0 : 1.0; });
      AddPointArray(sphere, "f", 1,
        [&](vtkIdType i, int)
        {
          const double* const p = sphere->GetPoint(i);
          return p[0] > 0.4 ? other : p[2] > 0.1 ? 1.0 : 0.0;
        });
      sphere->GetPointData()->SetActiveScalars("f");
      filters.push_back(kind.Make());
      filters.back()->SetInputData(sphere);
      vtkSurfaceFilter::SafeDownCast(filters.back())->SetRefineTo(0.15);
      Messages messages(filters.back());
      filters.back()->Update();
      EXPECT_EQ(messages.Errors, std::vector<std::string>());
    }
    vtkDataArray* const ofValues = ResultOf(filters[0], kind.Result);
    vtkDataArray* const ofNone = ResultOf(filters[1], kind.Result);
    ASSERT_TRUE(ofValues && ofNone);
    ASSERT_GT(ofValues->GetNumberOfTuples(), 500);
    for (vtkIdType i = 0; i < ofValues->GetNumberOfTuples(); ++i)
    {
      ASSERT_EQ(ofValues->GetComponent(i, 0), ofNone->GetComponent(i, 0)) << i;
    }
  }
}

namespace
{

/// Gaussian white noise of the deviation 0.2 on a wave, at the points and cells of a sphere.
vtkSmartPointer<vtkPolyData> NoisySphere(int levels)
{
  const auto sphere = Sphere(levels);
  const auto noise = [](vtkIdType i, int stream)
  {
    const double radius = std::sqrt(-2.0 * std::log(SurfaceDiffusion::UniformRandom(7, stream, i)));
    const double turn = SurfaceDiffusion::UniformRandom(7, stream + 2, i);
    return 0.2 * radius * std::cos(2.0 * std::acos(-1.0) * turn);
  };
  AddPointArray(
    sphere, "f", 1, [&](vtkIdType i, int) { return 2.0 * sphere->GetPoint(i)[2] + noise(i, 0); });
  sphere->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "c", sphere->GetNumberOfCells(), 1,
    [&](vtkIdType i, int)
    {
      double p[3];
      sphere->GetPoint(sphere->GetCell(i)->GetPointId(0), p);
      return 2.0 * p[2] + noise(i, 1);
    }));
  return sphere;
}

/// A filter on the sphere as it is, and with edges of a third.
template <typename Filter, typename Set>
std::vector<vtkSmartPointer<Filter>> RunOnBoth(int levels, const Set& set)
{
  std::vector<vtkSmartPointer<Filter>> filters;
  for (const double length : { 0.0, 0.64 / (1 << levels) })
  {
    auto filter = vtkSmartPointer<Filter>::New();
    filter->SetInputData(NoisySphere(levels));
    filter->SetRefineTo(length);
    filter->SetUnitsToAbsolute();
    set(filter);
    filter->Update();
    filters.push_back(filter);
  }
  EXPECT_GT(
    filters[1]->GetOutput()->GetNumberOfPoints(), 6 * filters[0]->GetOutput()->GetNumberOfPoints());
  for (vtkFieldData* const data :
    { static_cast<vtkFieldData*>(filters[1]->GetOutput()->GetPointData()),
      static_cast<vtkFieldData*>(filters[1]->GetOutput()->GetCellData()) })
  {
    for (int a = 0; a < data->GetNumberOfArrays(); ++a)
    {
      EXPECT_EQ(std::string(data->GetArrayName(a)).find("surface diffusion"), std::string::npos);
    }
  }
  return filters;
}

} // namespace

TEST(Refinement, ValuesBetweenMeasuredOnesAreNoMeasurementsForInterpolation)
{
  for (const bool onCells : { false, true })
  {
    const auto filters = RunOnBoth<vtkSurfaceInterpolationFilter>(4,
      [&](vtkSurfaceInterpolationFilter* filter)
      {
        SetInputArray(filter, 0, onCells ? "c" : "f", onCells);
        filter->ResultOnCellsOff();
        filter->ComputeErrorOn();
      });
    EXPECT_EQ(filters[1]->GetNumberOfValues(), filters[0]->GetNumberOfValues());
    EXPECT_NEAR(filters[1]->GetEffectiveSmoothing(), filters[0]->GetEffectiveSmoothing(),
      0.2 * filters[0]->GetEffectiveSmoothing());
    const char* const error = onCells ? "cError" : "fError";
    vtkDataArray* const given = filters[0]->GetOutput()->GetPointData()->GetArray(error);
    vtkDataArray* const refined = filters[1]->GetOutput()->GetPointData()->GetArray(error);
    ASSERT_TRUE(given && refined);
    for (vtkIdType i = 0; i < given->GetNumberOfTuples(); i += 100)
    {
      EXPECT_NEAR(
        refined->GetComponent(i, 0), given->GetComponent(i, 0), 0.25 * given->GetComponent(i, 0));
    }
  }
}

TEST(Refinement, NoiseIsThatOfTheMeasuredValues)
{
  for (const bool onCells : { false, true })
  {
    const auto edges = RunOnBoth<vtkMumfordShahFilter>(5,
      [&](vtkMumfordShahFilter* filter)
      {
        SetInputArray(filter, 0, onCells ? "c" : "f", onCells);
        filter->SetEdgeWidth(0.05);
      });
    for (const auto& filter : edges)
    {
      EXPECT_NEAR(filter->GetEstimatedNoiseLevel(), 0.2, onCells ? 0.03 : 0.02);
    }
    EXPECT_NEAR(edges[1]->GetEffectiveSmoothingLength(), edges[0]->GetEffectiveSmoothingLength(),
      (onCells ? 0.5 : 0.3) * edges[0]->GetEffectiveSmoothingLength());
    const auto heat = RunOnBoth<vtkFVMHeatFilter>(5,
      [&](vtkFVMHeatFilter* filter)
      {
        SetInputArray(filter, 0, onCells ? "c" : "f", onCells);
        filter->ResultOnCellsOff();
        filter->AutomaticFidelityOn();
        filter->SetModeToSteadyState();
      });
    // Over the given points, squared.
    const auto errorOf = [&](vtkFVMHeatFilter* filter)
    {
      filter->Update();
      vtkPolyData* const output = filter->GetOutput();
      vtkDataArray* const u = output->GetPointData()->GetArray(onCells ? "cDiffused" : "fDiffused");
      const auto count = static_cast<double>(heat[0]->GetOutput()->GetNumberOfPoints());
      double error = 0.0;
      for (vtkIdType i = 0; i < count; ++i)
      {
        error += std::pow(u->GetComponent(i, 0) - 2.0 * output->GetPoint(i)[2], 2) / count;
      }
      return error;
    };
    const double given = errorOf(heat[0]);
    const double refined = errorOf(heat[1]);
    EXPECT_LT(refined, std::pow(onCells ? 0.1 : 0.11, 2)); // of 0.2
    if (!onCells)
    {
      EXPECT_LT(refined, 1.1 * given);
    }
    const double found = heat[1]->GetEffectiveFidelityWeight();
    heat[1]->AutomaticFidelityOff();
    for (const double factor : { 0.25, 0.5, 2.0, 4.0 })
    {
      heat[1]->SetFidelityWeight(factor * found);
      EXPECT_LT(refined, 1.3 * errorOf(heat[1])) << factor << (onCells ? " on cells" : "");
    }
  }
}

TEST(Refinement, StopsAtTheLimitWithOneWarning)
{
  const auto sphere = Sphere(1);
  AddRough(sphere);
  vtkNew<vtkFVMHeatFilter> heat;
  heat->SetInputData(sphere);
  heat->SetRefineTo(0.01);
  heat->SetMaximumNumberOfTriangles(1000);
  Messages messages(heat);
  heat->Update();
  heat->SetTimeStep(2.0);
  heat->Update();
  EXPECT_LE(heat->GetOutput()->GetNumberOfCells(), 1000);
  EXPECT_GT(heat->GetOutput()->GetNumberOfCells(), 990);
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("refinement stopped at edges of 0.2"), std::string::npos)
    << messages.Warnings[0];
  EXPECT_NE(messages.Warnings[0].find("longer than 0.01, because MaximumNumberOfTriangles is 1000"),
    std::string::npos);
  heat->SetMaximumNumberOfTriangles(2000);
  heat->Update();
  EXPECT_GT(heat->GetOutput()->GetNumberOfCells(), 1990);
  heat->SetMaximumNumberOfTriangles(0);
  heat->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(messages.Errors[0].find("MaximumNumberOfTriangles is 0; allowed: integers, 1 or more"),
    std::string::npos);
}

TEST(Refinement, KeepsPiecesTogetherAtAndBelowTheLimit)
{
  // One part has four times the area of the other: it alone reaches the limit.
  for (const int limit : { 4000000, 500 })
  {
    vtkNew<vtkPartitionedDataSet> pieces;
    pieces->SetPartition(0, BoxPart(false));
    pieces->SetPartition(1, BoxPart(true));
    vtkNew<vtkSurfaceReliefFilter> filter;
    filter->SetInputDataObject(pieces);
    filter->SetHeight(0.01);
    filter->SetRefineTo(0.1);
    filter->SetMaximumNumberOfTriangles(limit);
    Messages messages(filter);
    filter->Update();
    EXPECT_EQ(messages.Warnings.size(), limit == 500 ? 1u : 0u);
    EXPECT_EQ(filter->GetOpenEdges(), 0) << limit;
    EXPECT_NEAR(filter->GetVolumeChange(), 3.02 * 2.02 * 4.02 - 24.0, 1e-9) << limit;
  }
}
