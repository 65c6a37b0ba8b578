// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "IntrinsicTVTest.h"

#include "vtkCellData.h"
#include "vtkIntArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkSurfaceSegmentationFilter.h"

#include <gtest/gtest.h>

#include <sstream>

using namespace FilterTest;
using IntrinsicTVTest::Height;

namespace
{

using Filter = vtkSurfaceSegmentationFilter;

const double Pi = std::acos(-1.0);

vtkSmartPointer<Filter> MakeFilter(vtkDataObject* surface)
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputDataObject(surface);
  return filter;
}

vtkDataArray* Labels(Filter* filter)
{
  return Result(filter, "RegionId");
}

double TableAt(Filter* filter, vtkIdType row, const char* column)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(1))
    ->GetValueByName(row, column)
    .ToDouble();
}

vtkPolyData* Boundaries(Filter* filter)
{
  return vtkPolyData::SafeDownCast(filter->GetOutputDataObject(2));
}

/// A sphere with a cap of 60 degrees, 2 in a field of -1.
vtkSmartPointer<vtkPolyData> SphereWithCap(int levels)
{
  auto sphere = Sphere(levels);
  AddPointArray(sphere, "f", 1,
    [&](vtkIdType i, int) { return Height(sphere->GetPoint(i)) > 0.5 ? 2.0 : -1.0; });
  sphere->GetPointData()->SetActiveScalars("f");
  return sphere;
}

} // namespace

TEST(SegmentationFilter, FindsTheCapWithItsAreaAndBoundary)
{
  auto filter = MakeFilter(SphereWithCap(5));
  filter->AutomaticFidelityOff();
  filter->SetFidelityWeight(0.2);
  filter->Update();
  EXPECT_LE(filter->GetGap(), 1e-3);
  EXPECT_GT(filter->GetLabelGap(), 0.01); // boundaries of labels follow edges
  EXPECT_LT(filter->GetLabelGap(), 0.15);
  EXPECT_GE(filter->GetNumberOfAlternations(), 1);
  EXPECT_NEAR(filter->GetEffectiveMean(1, 0), -1.0, 0.03);
  EXPECT_NEAR(filter->GetEffectiveMean(2, 0), 2.0, 0.06);
  EXPECT_TRUE(std::isnan(filter->GetEffectiveMean(3, 0)));
  vtkTable* const table = vtkTable::SafeDownCast(filter->GetOutputDataObject(1));
  ASSERT_EQ(table->GetNumberOfRows(), 2);
  EXPECT_EQ(TableAt(filter, 0, "Region"), 1.0);
  EXPECT_EQ(TableAt(filter, 1, "Region"), 2.0);
  EXPECT_NEAR(TableAt(filter, 1, "Area"), Pi, 0.02 * Pi);
  EXPECT_NEAR(TableAt(filter, 0, "Area"), 3.0 * Pi, 0.02 * Pi);
  const double length = 2.0 * Pi * std::sqrt(0.75);
  EXPECT_NEAR(TableAt(filter, 1, "BoundaryLength"), length, 0.03 * length);
  EXPECT_EQ(TableAt(filter, 0, "BoundaryLength"), TableAt(filter, 1, "BoundaryLength"));
  EXPECT_EQ(TableAt(filter, 1, "Components"), 1.0);
  EXPECT_NEAR(TableAt(filter, 1, "Mean_0"), 2.0, 0.06);

  vtkPolyData* const curves = Boundaries(filter);
  ASSERT_EQ(curves->GetNumberOfLines(), 1);
  EXPECT_EQ(curves->GetCellData()->GetArray("Regions")->GetComponent(0, 0), 1.0);
  EXPECT_EQ(curves->GetCellData()->GetArray("Regions")->GetComponent(0, 1), 2.0);
  EXPECT_EQ(curves->GetCellData()->GetArray("Length")->GetComponent(0, 0),
    TableAt(filter, 0, "BoundaryLength"));
  for (vtkIdType i = 0; i < curves->GetNumberOfPoints(); ++i)
  {
    EXPECT_NEAR(Height(curves->GetPoint(i)), 0.5, 0.05);
  }

  vtkDataArray* const segmented = Result(filter, "fSegmented");
  vtkDataArray* const u = Result(filter, "RegionProbability");
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetScalars(), Labels(filter));
  EXPECT_TRUE(vtkIntArray::SafeDownCast(Labels(filter)));
  for (vtkIdType i = 0; i < segmented->GetNumberOfTuples(); ++i)
  {
    const int label = static_cast<int>(Labels(filter)->GetComponent(i, 0));
    EXPECT_EQ(segmented->GetComponent(i, 0), filter->GetEffectiveMean(label, 0));
    EXPECT_NEAR(u->GetComponent(i, 0) + u->GetComponent(i, 1), 1.0, 1e-12);
    EXPECT_EQ(label == 2, u->GetComponent(i, 1) > u->GetComponent(i, 0));
  }
}

TEST(SegmentationFilter, AutomaticFidelityReplacesFidelityWeight)
{
  auto filter = MakeFilter(SphereWithCap(4));
  filter->SetFidelityWeight(0.001);
  const Messages messages(filter);
  filter->Update();
  EXPECT_EQ(Boundaries(filter)->GetNumberOfLines(), 1);
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("FidelityWeight is 0.001 but AutomaticFidelity finds the"),
    std::string::npos);
  filter->AutomaticFidelityOff();
  filter->Update();
  EXPECT_EQ(filter->GetEffectiveFidelityWeight(), 0.001);
  EXPECT_EQ(Boundaries(filter)->GetNumberOfLines(), 0);
}

TEST(SegmentationFilter, GivenMeansAreUsedAsTheyAre)
{
  auto filter = MakeFilter(SphereWithCap(4));
  filter->AutomaticMeansOff();
  filter->SetMean(1, 0, 2.0);
  filter->SetMean(2, 0, -1.0);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfAlternations(), 1);
  EXPECT_EQ(filter->GetEffectiveMean(1, 0), 2.0);
  EXPECT_NEAR(TableAt(filter, 0, "Area"), Pi, 0.05 * Pi); // the cap is region 1
  filter->SetMean(2, 0, -7.0);
  EXPECT_EQ(filter->GetMean(2, 0), -7.0);
  EXPECT_TRUE(std::isnan(filter->GetMean(2, 1)));
  filter->RemoveAllMeans();
  EXPECT_TRUE(std::isnan(filter->GetMean(2, 0)));
}

TEST(SegmentationFilter, WithoutMeansTheClustersOfTheValuesAreUsedAsTheyAre)
{
  auto filter = MakeFilter(SphereWithCap(4));
  filter->AutomaticMeansOff();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfAlternations(), 1);
  EXPECT_NEAR(filter->GetEffectiveMean(1, 0), -1.0, 1e-12);
  EXPECT_NEAR(filter->GetEffectiveMean(2, 0), 2.0, 1e-12);
}

TEST(SegmentationFilter, DataTermsReplaceTheData)
{
  auto sphere = SphereWithCap(4);
  AddPointArray(sphere, "r", 3,
    [&](vtkIdType i, int k)
    {
      const double z = sphere->GetPoint(i)[2];
      const int nearest = z < -0.3 ? 0 : (z < 0.4 ? 1 : 2);
      return k == nearest ? -5.0 : -4.0; // only differences count
    });
  auto filter = MakeFilter(sphere);
  SetInputArray(filter, 7, "r");
  filter->AutomaticFidelityOff();
  filter->SetFidelityWeight(0.3);
  filter->SetNumberOfRegions(3);
  filter->Update();
  EXPECT_EQ(filter->GetValueRange(), 1.0);
  EXPECT_FALSE(Result(filter, "fSegmented"));
  EXPECT_FALSE(Result(filter, "rSegmented"));
  const double lower = 2.0 * Pi * std::sqrt(1.0 - 0.09);
  const double upper = 2.0 * Pi * std::sqrt(1.0 - 0.16);
  EXPECT_NEAR(TableAt(filter, 0, "BoundaryLength"), lower, 0.06 * lower);
  EXPECT_NEAR(TableAt(filter, 1, "BoundaryLength"), lower + upper, 0.06 * (lower + upper));
  EXPECT_EQ(Boundaries(filter)->GetNumberOfLines(), 2);
  filter->AutomaticFidelityOn(); // from the terms: their contrast is 1
  filter->Update();
  EXPECT_NEAR(filter->GetEffectiveFidelityWeight(), 0.6, 1e-12);
  EXPECT_EQ(Boundaries(filter)->GetNumberOfLines(), 2);
  filter->SetNumberOfRegions(2);
  EXPECT_NE(ErrorOf(filter).find("components is 3; allowed: 2"), std::string::npos);
}

TEST(SegmentationFilter, BlocksHaveRowsAndCurvesOfTheirOwn)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, SphereWithCap(3));
  blocks->SetBlock(1, SphereWithCap(4));
  auto filter = MakeFilter(blocks);
  filter->Update();
  EXPECT_EQ(vtkTable::SafeDownCast(filter->GetOutputDataObject(1))->GetNumberOfRows(), 4);
  EXPECT_EQ(TableAt(filter, 2, "Block"), 1.0);
  EXPECT_EQ(TableAt(filter, 2, "Region"), 1.0);
  EXPECT_EQ(Boundaries(filter)->GetNumberOfLines(), 2);
  EXPECT_EQ(Boundaries(filter)->GetCellData()->GetArray("Block")->GetComponent(1, 0), 1.0);
}

/// Regions are a steady state: nothing that concerns time is there to be set or to be read.
TEST(SegmentationFilter, HasNeitherTimesNorPropertiesOfTimeSteps)
{
  auto filter = MakeFilter(SphereWithCap(4));
  filter->Update();
  EXPECT_TRUE(PublishedTimes(filter).empty());
  for (int port = 0; port < 3; ++port)
  {
    EXPECT_FALSE(
      filter->GetOutputInformation(port)->Has(vtkStreamingDemandDrivenPipeline::TIME_RANGE()));
    EXPECT_FALSE(
      filter->GetOutputDataObject(port)->GetInformation()->Has(vtkDataObject::DATA_TIME_STEP()));
  }
  std::ostringstream text;
  filter->Print(text);
  for (const char* const name : { "TimeStep", "NumberOfTimeSteps", "GenerateTimeSteps",
         "OutputInterval", "CheckpointMemoryLimit", "TimeIntegrator", "Solver", "Tolerance",
         "MaximumNumberOfIterations", "TimeUnit", "NumberOfStepsComputed" })
  {
    EXPECT_EQ(text.str().find("\n  " + std::string(name) + ":"), std::string::npos) << name;
  }
}

TEST(SegmentationFilter, PortsKeepTheirResultsIfMemoryIsReleased)
{
  auto filter = MakeFilter(SphereWithCap(4));
  filter->ReleaseDataFlagOn();
  filter->Update();
  EXPECT_EQ(vtkTable::SafeDownCast(filter->GetOutputDataObject(1))->GetNumberOfRows(), 2);
  EXPECT_EQ(Boundaries(filter)->GetNumberOfLines(), 1);
}

TEST(SegmentationFilter, MeansOfAnyOtherRegionOrComponentAreAnError)
{
  const std::pair<std::array<int, 2>, std::string> cases[] = {
    { { 0, 0 }, "the region of a Mean is 0; allowed: 1 to NumberOfRegions 2" },
    { { -3, 0 }, "the region of a Mean is -3; allowed: 1 to" },
    { { 3, 0 }, "the region of a Mean is 3; allowed: 1 to" },
    { { 1, -1 }, "the component of a Mean is -1; allowed: 0 to 0" },
    { { 1, 1 }, "the component of a Mean is 1; allowed: 0 to 0" },
    { { 20000000, 0 }, "the region of a Mean is 20000000; allowed: 1 to" },
    { { 1, 2000000000 }, "the component of a Mean is 2000000000; allowed: 0 to 0" },
  };
  for (const auto& [place, text] : cases)
  {
    auto filter = MakeFilter(SphereWithCap(3));
    filter->AutomaticMeansOff();
    filter->SetMean(place[0], place[1], 2.0); // neither clamped nor refused
    EXPECT_EQ(filter->GetMean(place[0], place[1]), 2.0);
    const std::string error = ErrorOf(filter);
    EXPECT_NE(error.find(text), std::string::npos) << error;
    filter->AutomaticMeansOn(); // the means have no effect
    EXPECT_EQ(ErrorOf(filter), "");
  }
}

/// A table of all regions and components would take 16 GB.
TEST(SegmentationFilter, PropertiesTakeTheMemoryOfTheMeansThatAreSet)
{
  auto filter = MakeFilter(SphereWithCap(3));
  filter->SetMean(20000000, 0, 1.0);
  filter->SetMean(1, 99, 1.0);
  filter->UpdateInformation();
  EXPECT_STREQ(filter->GetUnitsAsString(), "Natural");
}

TEST(SegmentationFilter, PrintSelfNamesMeans)
{
  auto filter = MakeFilter(SphereWithCap(3));
  filter->SetMean(2, 0, -7.5);
  std::ostringstream text;
  filter->Print(text);
  EXPECT_NE(text.str().find("Mean of region 2, component 0: -7.5"), std::string::npos);
}

TEST(SegmentationFilter, BlocksWithOtherNumbersOfComponentsHaveAllColumns)
{
  auto scalar = SphereWithCap(3);
  auto vector = SphereWithCap(3);
  AddPointArray(vector, "f", 3,
    [&](vtkIdType i, int k) { return (Height(vector->GetPoint(i)) > 0.5 ? 2.0 : -1.0) + k; });
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, scalar);
  blocks->SetBlock(1, vector);
  auto filter = MakeFilter(blocks);
  SetInputArray(filter, 0, "f");
  EXPECT_EQ(ErrorOf(filter), "");
  vtkTable* const table = vtkTable::SafeDownCast(filter->GetOutputDataObject(1));
  EXPECT_EQ(table->GetNumberOfRows(), 4);
  for (int k = 0; k < 3; ++k)
  {
    const std::string name = "Mean_" + std::to_string(k);
    ASSERT_TRUE(table->GetColumnByName(name.c_str())) << name;
    ASSERT_EQ(table->GetColumnByName(name.c_str())->GetNumberOfTuples(), 4);
    EXPECT_EQ(std::isnan(TableAt(filter, 1, name.c_str())), k > 0);
    EXPECT_NEAR(TableAt(filter, 3, name.c_str()), 2.0 + k, 0.3);
  }
}
