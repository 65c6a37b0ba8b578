// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkIntrinsicTVFilter.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkMumfordShahFilter.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkSurfaceSegmentationFilter.h"
#include "vtkTensorDiffusionFilter.h"
#include "vtkTuringTextureFilter.h"

#include <gtest/gtest.h>

#include <functional>
#include <type_traits>

using namespace FilterTest;

namespace
{

vtkSmartPointer<vtkFVMHeatFilter> MakeFilter(vtkDataObject* surface)
{
  auto filter = vtkSmartPointer<vtkFVMHeatFilter>::New();
  filter->SetInputDataObject(surface);
  return filter;
}

/// The values of the natural units.
struct NaturalUnits
{
  double Length, Range, Time;
};

template <typename Filter>
using Change = std::function<void(Filter*)>;

/// A filter in natural units gives what it gives with `convert`, the same settings in the units of
/// the coordinates and of the data.
template <typename Filter>
void ExpectNaturalIsAbsolute(const char* result, double tolerance, const Change<Filter>& set,
  const std::function<void(Filter*, const NaturalUnits&)>& convert)
{
  SCOPED_TRACE(result);
  auto sphere = Sphere(3);
  AddPointArray(sphere, "f", 1, [](vtkIdType i, int k) { return 3.0 * Rough(i, k); });
  AddPointArray(sphere, "color", 3, [](vtkIdType i, int k) { return 2.0 + Rough(i, k); });
  AddPointArray(sphere, "cap", 1,
    [&](vtkIdType i, int k)
    { return (sphere->GetPoint(i)[2] > 0.5 ? 7.0 : 3.0) + 0.1 * Rough(i, k); });
  sphere->GetPointData()->SetActiveScalars("f");
  vtkNew<Filter> natural, absolute;
  for (Filter* const filter : { natural.Get(), absolute.Get() })
  {
    filter->SetInputData(sphere);
    filter->SetResultArrayName(result);
    set(filter);
  }
  natural->Update();
  NaturalUnits units{ natural->GetMeanEdgeLength(), natural->GetValueRange(), 1.0 };
  if constexpr (std::is_base_of_v<vtkSurfaceDiffusionAlgorithm, Filter>)
  {
    units.Time = natural->GetTimeUnit();
  }
  absolute->SetUnitsToAbsolute();
  convert(absolute, units);
  absolute->Update();
  const bool isTexture = natural->IsA("vtkTuringTextureFilter") != 0;
  const std::string name = result + std::string(isTexture ? "u1" : "");
  ASSERT_TRUE(Result(natural, name.c_str()) && Result(absolute, name.c_str()));
  EXPECT_LT(
    LargestDifference(Result(natural, name.c_str()), Result(absolute, name.c_str())), tolerance);
  if constexpr (std::is_base_of_v<vtkSurfaceDiffusionAlgorithm, Filter>)
  {
    EXPECT_EQ(absolute->GetTimeUnit(), 1.0);
  }
}

} // namespace

TEST(Units, AreMeasuredOnDistinctEdgesAndKnownValues)
{
  auto grid = Grid(3, 2, 2.0); // 4 edges along x, 3 along y, 2 diagonals
  AddPointArray(
    grid, "f", 2, [](vtkIdType i, int k) { return k == 1 ? -5.0 * static_cast<double>(i) : 0.0; });
  grid->GetPointData()->GetArray("f")->SetComponent(5, 1, -1e6);
  AddPointArray(grid, "mask", 1, [](vtkIdType i, int) { return i == 5; });
  auto filter = MakeFilter(grid);
  SetInputArray(filter, 0, "f");
  SetInputArray(filter, 1, "mask");
  filter->Update();
  const double h = (7.0 * 2.0 + 2.0 * 2.0 * std::sqrt(2.0)) / 9.0;
  EXPECT_NEAR(filter->GetMeanEdgeLength(), h, 1e-14);
  EXPECT_EQ(filter->GetValueRange(), 20.0); // range of the second component, from 0 to -20
  EXPECT_NEAR(filter->GetTimeUnit(), h * h, 1e-13);

  grid->GetPointData()->GetArray("f")->SetComponent(5, 0, std::nan(""));
  grid->GetPointData()->GetArray("f")->Modified();
  SetInputArray(filter, 1, "");
  filter->Update();
  EXPECT_EQ(filter->GetValueRange(), 20.0); // a NaN is missing
}

TEST(Units, PointsThatTakeNoPartDoNotCount)
{
  auto grid = Grid(3, 3);
  AddPointArray(grid, "f", 1, [](vtkIdType i, int) { return static_cast<double>(i % 5); });
  grid->GetPoints()->InsertNextPoint(0.0, 0.0, 9.0); // of no cell
  vtkDataArray* f = grid->GetPointData()->GetArray("f");
  f->InsertNextTuple1(100.0);
  auto filter = MakeFilter(grid);
  SetInputArray(filter, 0, "f");
  filter->Update();
  EXPECT_EQ(filter->GetValueRange(), 4.0);

  const vtkIdType corner = 0;
  AddPointArray(grid, "mask", 1, [](vtkIdType i, int) { return i == corner; });
  f->SetComponent(corner, 0, -100.0);
  SetInputArray(filter, 1, "mask");
  filter->SetMaskModeToExclude();
  filter->Update();
  EXPECT_EQ(filter->GetValueRange(), 4.0);
}

TEST(Units, RangeOfAConstantIsOne)
{
  auto grid = Grid(3, 3);
  AddPointArray(grid, "f", 1, [](vtkIdType, int) { return 7.0; });
  auto filter = MakeFilter(grid);
  SetInputArray(filter, 0, "f");
  filter->Update();
  EXPECT_EQ(filter->GetValueRange(), 1.0);
}

TEST(Units, AlphaDoesNotCountInTheRange)
{
  auto grid = Grid(3, 3);
  AddPointArray(
    grid, "f", 4,
    [](vtkIdType i, int k)
    { return k == 3 ? 31.0 * static_cast<double>(i) : 10.0 + static_cast<double>(i); },
    VTK_UNSIGNED_CHAR);
  auto filter = MakeFilter(grid);
  SetInputArray(filter, 0, "f");
  filter->Update();
  EXPECT_EQ(filter->GetValueRange(), 8.0);
}

TEST(Units, NaturalSettingsAreTheAbsoluteOnesInTheUnitsOfLinearModels)
{
  using Heat = vtkFVMHeatFilter;
  ExpectNaturalIsAbsolute<Heat>(
    "heat", 1e-12,
    [](Heat* f)
    {
      f->SetTimeStep(0.7);
      f->SetFidelityWeight(0.2);
    },
    [](Heat* f, const NaturalUnits& u)
    {
      EXPECT_NEAR(u.Time, u.Length * u.Length, 1e-12 * u.Time);
      f->SetTimeStep(0.7 * u.Time);
      f->SetFidelityWeight(0.2 / u.Time);
    });
  using Tensor = vtkTensorDiffusionFilter;
  for (int model = 0; model < 3; ++model)
  {
    ExpectNaturalIsAbsolute<Tensor>(
      "tensor", 1e-9,
      [=](Tensor* f)
      {
        f->SetModel(model);
        f->SetNumberOfTimeSteps(4);
        f->SetFidelityWeight(0.2);
      },
      [](Tensor* f, const NaturalUnits& u)
      {
        EXPECT_NEAR(u.Time, u.Length * u.Length, 1e-12 * u.Time);
        f->SetTimeStep(u.Time);
        f->SetFidelityWeight(0.2 / u.Time);
        f->SetColorScale(10.0 * u.Length / u.Range);
        f->SetContrast(0.05 * u.Range / u.Length);
        f->SetNoiseScale(u.Length);
        f->SetIntegrationScale(4.0 * u.Length);
      });
  }
  using Turing = vtkTuringTextureFilter;
  const double rate = 3.0;
  ExpectNaturalIsAbsolute<Turing>(
    "texture", 1e-9,
    [=](Turing* f)
    {
      f->SetNumberOfTimeSteps(48);
      f->SetReactionRate(rate);
      f->SetDiffusionRate1(22.0); // the default has a size of the surface on coarse ones
    },
    [=](Turing* f, const NaturalUnits& u)
    {
      EXPECT_NEAR(u.Time, 1.0 / rate, 1e-15);
      f->SetTimeStep(f->GetTimeStep() / rate);
      f->SetDiffusionRate1(22.0 * u.Length * u.Length * rate);
      f->SetDiffusionRate2(2.6 * u.Length * u.Length * rate);
    });
}

TEST(Units, NaturalSettingsAreTheAbsoluteOnesInTheUnitsOfTotalVariation)
{
  using TV = vtkIntrinsicTVFilter;
  const auto expect = [](double tolerance, const Change<TV>& set)
  {
    ExpectNaturalIsAbsolute<TV>(
      "tv", tolerance,
      [&](TV* f)
      {
        f->SetTimeStep(0.3);
        f->SetNumberOfTimeSteps(3);
        f->SetBeta(1e-2);
        f->SetFidelityWeight(0.7);
        f->SetChromaticityWeight(1.5);
        set(f);
      },
      [](TV* f, const NaturalUnits& u)
      {
        const bool isL1 = f->GetFidelityNorm() == TV::FIDELITY_NORM_L1;
        const bool isTV = f->GetEdgeFunction() == TV::EDGE_FUNCTION_TOTAL_VARIATION;
        const double p = f->GetChromaticityExponent();
        f->SetTimeStep(0.3 * u.Time);
        f->SetBeta(1e-2 * u.Range * u.Range / (u.Length * u.Length));
        f->SetEdgeThreshold(0.1 * u.Range / u.Length);
        f->SetFidelityWeight(0.7 / u.Time * (isL1 ? u.Range : 1.0));
        f->SetChromaticityWeight(1.5 * u.Range *
          (isTV ? std::pow(u.Length, p - 1.0) : u.Range * std::pow(u.Length, p - 2.0)));
      });
  };
  const Change<TV> models[] = { [](TV*) {}, [](TV* f) { f->SetFidelityNormToL1(); },
    [](TV* f) { f->SetTimeIntegratorToImplicit(); }, [](TV* f) { f->SetModeToSteadyState(); },
    [](TV* f) { f->SetEdgeFunctionToPeronaMalikRational(); },
    [](TV* f) { f->SetEdgeFunctionToCharbonnier(), f->SetFidelityNormToL1(); },
    [](TV* f) { f->SetEdgeFunctionToCharbonnier(), f->SetTimeIntegratorToImplicit(); } };
  for (const Change<TV>& set : models)
  {
    expect(1e-7, set);
  }
  const Change<TV> ofColors[] = { [](TV*) {},
    [](TV* f)
    {
      f->SetModeToSteadyState();
      f->SetStopTolerance(1e-8); // the last bits of h decide in which iteration it stops
    },
    [](TV* f) { f->SetChromaticityExponent(1.5); },
    [](TV* f) { f->SetEdgeFunctionToCharbonnier(); } };
  for (const Change<TV>& set : ofColors)
  {
    expect(1e-5, // many alternations amplify the last bits of h
      [&](TV* f)
      {
        SetInputArray(f, 0, "color");
        f->SetColorModelToChromaticityBrightness();
        f->SetTolerance(1e-12);
        set(f);
      });
  }
}

TEST(Units, NaturalSettingsAreTheAbsoluteOnesInTheUnitsOfMapsEdgesAndRegions)
{
  using Map = vtkHarmonicMapFilter;
  for (const double exponent : { 1.0, 1.5, 2.0 })
  {
    ExpectNaturalIsAbsolute<Map>(
      "map", 1e-8,
      [=](Map* f)
      {
        SetInputArray(f, 0, "color");
        f->SetExponent(exponent);
        f->SetTimeStep(0.05);
        f->SetFidelityWeight(0.3);
      },
      [=](Map* f, const NaturalUnits& u)
      {
        EXPECT_NEAR(u.Time / std::pow(u.Length, exponent), 1.0, 1e-12);
        f->SetTimeStep(0.05 * u.Time);
        f->SetFidelityWeight(0.3 / u.Time);
        f->SetBeta(1e-6 / (u.Length * u.Length));
      });
  }
  using Shah = vtkMumfordShahFilter;
  for (const bool automatic : { false, true }) // in which case the defaults of the two are ignored
  {
    ExpectNaturalIsAbsolute<Shah>(
      "edges", 1e-9,
      [=](Shah* f)
      {
        SetInputArray(f, 0, "cap");
        f->SetAutomaticThreshold(automatic);
      },
      [=](Shah* f, const NaturalUnits& u)
      {
        f->SetEdgeWidth(2.0 * u.Length);
        f->SetSmoothingLength(8.0 * (automatic ? 1.0 : u.Length));
        f->SetEdgeThreshold(0.2 * (automatic ? 1.0 : u.Range));
      });
  }
  using Regions = vtkSurfaceSegmentationFilter;
  ExpectNaturalIsAbsolute<Regions>(
    "regions", 1e-6,
    [](Regions* f)
    {
      SetInputArray(f, 0, "cap");
      f->AutomaticFidelityOff();
      f->SetFidelityWeight(0.6);
    },
    [](Regions* f, const NaturalUnits& u)
    { f->SetFidelityWeight(0.6 / (u.Length * u.Range * u.Range)); });
}

TEST(Units, BlocksOfCompositeDataShareLengthAndRange)
{
  auto fine = Grid(9, 9, 0.5);
  auto coarse = Grid(5, 5, 3.0);
  for (vtkIdType i = 0; i < coarse->GetNumberOfPoints(); ++i)
  {
    double x[3];
    coarse->GetPoint(i, x);
    coarse->GetPoints()->SetPoint(i, x[0], x[1], 10.0); // partitions that touch are one surface
  }
  AddPointArray(fine, "f", 1, Rough);
  AddPointArray(coarse, "f", 1, [](vtkIdType i, int k) { return 40.0 * Rough(i, k); });
  vtkNew<vtkMultiBlockDataSet> blocks;
  vtkNew<vtkPartitionedDataSet> partitions;
  vtkNew<vtkPartitionedDataSetCollection> collection;
  vtkNew<vtkMultiBlockDataSet> nested;
  nested->SetBlock(0, coarse);
  blocks->SetBlock(0, fine);
  blocks->SetBlock(2, nested);
  partitions->SetPartition(0, fine);
  partitions->SetPartition(1, coarse);
  collection->SetPartition(0, 0, fine);
  collection->SetPartition(1, 0, coarse);
  const auto edges = [](double n) { return 2.0 * n * (n - 1.0) + (n - 1.0) * (n - 1.0); };
  const auto length = [](double n, double s)
  { return s * (2.0 * n * (n - 1.0) + std::sqrt(2.0) * (n - 1.0) * (n - 1.0)); };
  const double h = (length(9.0, 0.5) + length(5.0, 3.0)) / (edges(9.0) + edges(5.0));
  for (vtkDataObject* input :
    std::initializer_list<vtkDataObject*>{ blocks.Get(), partitions.Get(), collection.Get() })
  {
    auto filter = MakeFilter(input);
    SetInputArray(filter, 0, "f");
    filter->Update();
    EXPECT_NEAR(filter->GetMeanEdgeLength(), h, 1e-13);
    double range[2];
    coarse->GetPointData()->GetArray("f")->GetRange(range);
    EXPECT_EQ(filter->GetValueRange(), range[1] - range[0]);

    vtkDataObject* output = filter->GetOutputDataObject(0);
    ASSERT_STREQ(output->GetClassName(), input->GetClassName());
    vtkPolyData* results[2];
    if (auto* tree = vtkMultiBlockDataSet::SafeDownCast(output))
    {
      results[0] = vtkPolyData::SafeDownCast(tree->GetBlock(0));
      results[1] = vtkPolyData::SafeDownCast(
        vtkMultiBlockDataSet::SafeDownCast(tree->GetBlock(2))->GetBlock(0));
    }
    else if (auto* all = vtkPartitionedDataSetCollection::SafeDownCast(output))
    {
      results[0] = vtkPolyData::SafeDownCast(all->GetPartition(0, 0));
      results[1] = vtkPolyData::SafeDownCast(all->GetPartition(1, 0));
    }
    else
    {
      auto* set = vtkPartitionedDataSet::SafeDownCast(output);
      results[0] = vtkPolyData::SafeDownCast(set->GetPartition(0));
      results[1] = vtkPolyData::SafeDownCast(set->GetPartition(1));
    }
    double total = 0.0;
    int b = 0;
    for (vtkPolyData* block : { fine.Get(), coarse.Get() })
    {
      auto alone = MakeFilter(block);
      SetInputArray(alone, 0, "f");
      alone->SetUnitsToAbsolute();
      alone->SetTimeStep(filter->GetTimeUnit());
      alone->Update();
      vtkDataArray* result = results[b++]->GetPointData()->GetArray("fDiffused");
      ASSERT_NE(result, nullptr);
      EXPECT_LT(LargestDifference(result, Result(alone)), 1e-12);
      total += HistoryAt(alone, 10, "Total_0");
    }
    EXPECT_NEAR(HistoryAt(filter, 10, "Total_0"), total, 1e-9);
    EXPECT_EQ(fine->GetPointData()->GetArray("fDiffused"), nullptr); // the input is unchanged
  }
}
