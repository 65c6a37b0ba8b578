// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkIdTypeArray.h"
#include "vtkSurfaceRandomFieldFilter.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace FilterTest;

namespace
{

vtkDataArray* FieldOf(vtkSurfaceRandomFieldFilter* filter)
{
  filter->Update();
  return filter->GetOutput()->GetPointData()->GetArray("RandomField");
}

/// The mean over points and fields of the squares.
double MeanSquare(vtkDataArray* fields)
{
  double sum = 0.0;
  for (vtkIdType i = 0; i < fields->GetNumberOfTuples(); ++i)
  {
    for (int k = 0; k < fields->GetNumberOfComponents(); ++k)
    {
      sum += fields->GetComponent(i, k) * fields->GetComponent(i, k);
    }
  }
  return sum / static_cast<double>(fields->GetNumberOfValues());
}

} // namespace

TEST(RandomFieldFilter, HasVarianceOneForEveryCovariance)
{
  vtkNew<vtkSurfaceRandomFieldFilter> filter;
  filter->SetInputData(Sphere(4));
  filter->SetNumberOfFields(200);
  filter->SetFWHM(0.3);
  filter->SetRange(0.4);
  filter->SetSmoothness(1.5);
  for (const int covariance : { 0, 1, 2, 3 })
  {
    filter->SetCovariance(covariance);
    vtkDataArray* const fields = FieldOf(filter);
    ASSERT_NE(fields, nullptr);
    EXPECT_EQ(fields->GetNumberOfComponents(), 200);
    EXPECT_EQ(filter->GetOutput()->GetPointData()->GetScalars(), fields);
    EXPECT_NEAR(MeanSquare(fields), 1.0, 0.03);
  }
}

TEST(RandomFieldFilter, ByDefaultIsTenEdgesWide)
{
  vtkNew<vtkSurfaceRandomFieldFilter> filter;
  filter->SetInputData(Sphere(4));
  filter->Update();
  vtkNew<vtkSurfaceRandomFieldFilter> given;
  given->SetInputData(Sphere(4));
  given->SetFWHM(10.0 * filter->GetMeanEdgeLength());
  EXPECT_TRUE(Identical(FieldOf(filter), FieldOf(given)));
  filter->SetCovarianceToMaternNu1();
  given->SetCovarianceToMaternNu1();
  given->SetRange(20.0 * filter->GetMeanEdgeLength());
  EXPECT_TRUE(Identical(FieldOf(filter), FieldOf(given)));
}

TEST(RandomFieldFilter, FollowsGlobalIdsWhereThereAreSome)
{
  const auto sphere = Sphere(3);
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("ids");
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    ids->InsertNextValue(1000 - i);
  }
  sphere->GetPointData()->SetGlobalIds(ids);
  const auto bent = Sphere(3);
  for (vtkIdType i = 0; i < bent->GetNumberOfPoints(); ++i)
  {
    double x[3];
    bent->GetPoint(i, x);
    bent->GetPoints()->SetPoint(i, x[0] * (1.0 + 1e-5), x[1], x[2]);
  }
  vtkNew<vtkSurfaceRandomFieldFilter> filter;
  filter->SetFWHM(0.5);
  filter->SetInputData(sphere);
  vtkSmartPointer<vtkDataArray> expected = FieldOf(filter);
  filter->SetInputData(bent);
  EXPECT_GT(LargestDifference(FieldOf(filter), expected), 0.5) << "others by coordinates";
  bent->GetPointData()->SetGlobalIds(ids);
  bent->Modified();
  EXPECT_LT(LargestDifference(FieldOf(filter), expected), 1e-3);
}

TEST(RandomFieldFilter, MaskedPointsHaveNone)
{
  const auto sphere = Sphere(3);
  AddPointArray(sphere, "mask", 1, [](vtkIdType i, int) { return i < 20; });
  vtkNew<vtkSurfaceRandomFieldFilter> filter;
  filter->SetInputData(sphere);
  filter->SetFWHM(0.5);
  SetInputArray(filter, 1, "mask");
  vtkDataArray* const field = FieldOf(filter);
  for (vtkIdType i = 0; i < 20; ++i)
  {
    EXPECT_TRUE(std::isnan(field->GetComponent(i, 0)));
  }
  vtkIdType missing = 0;
  for (vtkIdType i = 0; i < field->GetNumberOfTuples(); ++i)
  {
    missing += std::isnan(field->GetComponent(i, 0));
  }
  EXPECT_LT(missing, 40);
}

TEST(RandomFieldFilter, NamesWhatIsNotAllowedAndWhatIsNotResolved)
{
  vtkNew<vtkSurfaceRandomFieldFilter> filter;
  filter->SetInputData(Sphere(3));
  Messages messages(filter);
  filter->SetFWHM(-1.0);
  filter->SetNumberOfFields(0);
  filter->SetCovariance(7);
  filter->SetSmoothness(4.5);
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  for (const char* const text : { "FWHM is -1; allowed: ",
         "NumberOfFields is 0; allowed: 1 or more", "Covariance is 7; allowed: 0 Gaussian",
         "Smoothness is 4.5; allowed: numbers above 0, up to 4" })
  {
    EXPECT_NE(messages.Errors.front().find(text), std::string::npos) << messages.Errors.front();
  }
  filter->SetNumberOfFields(1);
  filter->SetSmoothness(1.0);
  filter->SetCovarianceToGaussian();
  filter->SetFWHM(1e-3);
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(
    messages.Warnings.front().find("FWHM is 0.001, below two mean edges of "), std::string::npos)
    << messages.Warnings.front();
  EXPECT_NEAR(MeanSquare(FieldOf(filter)), 1.0, 0.2);
}
