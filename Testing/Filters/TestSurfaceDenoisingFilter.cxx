// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkContourFilter.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkMinimalStandardRandomSequence.h"
#include "vtkPolygon.h"
#include "vtkSurfaceDenoisingFilter.h"

#include <gtest/gtest.h>

using namespace FilterTest;

namespace
{

/// Points moved along the unit sphere's normals, with standard deviation `amount`.
vtkSmartPointer<vtkPolyData> NoisySphere(double amount, int levels = 5, bool single = false)
{
  auto sphere = Sphere(levels);
  vtkNew<vtkPoints> points;
  points->SetDataType(single ? VTK_FLOAT : VTK_DOUBLE);
  vtkNew<vtkMinimalStandardRandomSequence> random;
  random->SetSeed(7);
  const auto uniform = [&]
  {
    random->Next();
    return random->GetValue();
  };
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    double p[3];
    sphere->GetPoint(i, p);
    double sum = -6.0; // the sum of twelve uniform numbers is nearly Gaussian
    for (int k = 0; k < 12; ++k)
    {
      sum += uniform();
    }
    vtkMath::MultiplyScalar(p, 1.0 + amount * sum);
    points->InsertNextPoint(p);
  }
  sphere->SetPoints(points);
  return sphere;
}

/// An isosurface, most of whose vertices are in triangles of all shapes, some of them needles.
vtkSmartPointer<vtkPolyData> Isosurface()
{
  vtkNew<vtkImageData> image;
  constexpr int size = 24;
  image->SetDimensions(size, size, size);
  vtkNew<vtkDoubleArray> values;
  values->SetName("f");
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    double p[3];
    image->GetPoint(i, p);
    values->InsertNextValue(
      vtkMath::Distance2BetweenPoints(p, std::array<double, 3>{ 11, 12, 11.5 }.data()) +
      12.0 * std::sin(0.9 * p[0]) + 12.0 * std::sin(0.8 * p[1]) + 9.0 * std::cos(0.6 * p[2]));
  }
  image->GetPointData()->SetScalars(values);
  vtkNew<vtkContourFilter> contour;
  contour->SetInputData(image);
  contour->SetValue(0, 70.0);
  contour->ComputeNormalsOff();
  contour->Update();
  return contour->GetOutput();
}

/// The same surface with other numbers of its points and triangles, and other first corners. Point
/// i becomes point factor * i modulo their number.
vtkSmartPointer<vtkPolyData> Renumbered(vtkPolyData* surface, vtkIdType factor)
{
  const vtkIdType n = surface->GetNumberOfPoints();
  vtkNew<vtkPoints> points;
  points->SetDataType(surface->GetPoints()->GetDataType());
  points->SetNumberOfPoints(n);
  for (vtkIdType i = 0; i < n; ++i)
  {
    points->SetPoint(factor * i % n, surface->GetPoint(i));
  }
  vtkNew<vtkCellArray> triangles;
  for (vtkIdType c = surface->GetNumberOfCells() - 1; c >= 0; --c)
  {
    vtkNew<vtkIdList> corners;
    surface->GetCellPoints(c, corners);
    triangles->InsertNextCell(3);
    for (vtkIdType k = 0; k < 3; ++k)
    {
      triangles->InsertCellPoint(factor * corners->GetId((k + c) % 3) % n);
    }
  }
  auto result = vtkSmartPointer<vtkPolyData>::New();
  result->SetPoints(points);
  result->SetPolys(triangles);
  return result;
}

/// The root mean square of |p| - 1.
double Roughness(vtkPolyData* sphere)
{
  double sum = 0.0;
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    const double d = vtkMath::Norm(sphere->GetPoint(i)) - 1.0;
    sum += d * d;
  }
  return std::sqrt(sum / sphere->GetNumberOfPoints());
}

} // namespace

TEST(SurfaceDenoisingFilter, RemovesNoiseAndReportsItsLevel)
{
  const auto noisy = NoisySphere(0.01);
  vtkNew<vtkSurfaceDenoisingFilter> filter;
  filter->SetInputData(noisy);
  filter->Update();
  EXPECT_NEAR(Roughness(noisy), 0.01, 0.001);
  EXPECT_LT(Roughness(filter->GetOutput()), 0.003);
  EXPECT_NEAR(filter->GetEffectiveNoiseLevel(), 0.01, 0.0015);
  EXPECT_GT(filter->GetMeanDisplacement(), 0.005);
  EXPECT_GT(filter->GetMaximumDisplacement(), filter->GetMeanDisplacement());
  EXPECT_GT(filter->GetMeanEdgeLength(), 0.0);
}

TEST(SurfaceDenoisingFilter, ReportsTheKindOfSurfaceAndTheVolume)
{
  vtkNew<vtkSurfaceDenoisingFilter> filter;
  EXPECT_EQ(filter->GetEffectiveSurfaceType(), vtkSurfaceDenoisingFilter::SURFACE_TYPE_AUTOMATIC);
  const auto noisy = NoisySphere(0.01);
  filter->SetInputData(noisy);
  filter->Update();
  EXPECT_EQ(filter->GetEffectiveSurfaceType(), vtkSurfaceDenoisingFilter::SURFACE_TYPE_CAD);
  const double ball = 4.0 / 3.0 * vtkMath::Pi();
  EXPECT_NEAR(filter->GetVolumeBefore(), ball, 0.01 * ball);
  EXPECT_NEAR(filter->GetVolumeAfter(), filter->GetVolumeBefore(), 0.005 * ball);
  EXPECT_NE(filter->GetVolumeAfter(), filter->GetVolumeBefore());
  filter->SetSurfaceTypeToCAD();
  filter->Update();
  EXPECT_EQ(filter->GetEffectiveSurfaceType(), vtkSurfaceDenoisingFilter::SURFACE_TYPE_CAD);
}

TEST(SurfaceDenoisingFilter, IsosurfacesMoveAlikeForAnyNumbering)
{
  const auto surface = Isosurface();
  const vtkIdType n = surface->GetNumberOfPoints();
  constexpr vtkIdType factor = 1009; // a prime number
  ASSERT_NE(n % factor, 0);
  const auto other = Renumbered(surface, factor);
  for (const double level : { 0.1, 0.3 })
  {
    vtkNew<vtkSurfaceDenoisingFilter> filter, again;
    filter->SetInputData(surface);
    again->SetInputData(other);
    for (auto* const f : { filter.Get(), again.Get() })
    {
      f->SetNoiseLevel(level);
      f->SetSurfaceType(level < 0.2 ? vtkSurfaceDenoisingFilter::SURFACE_TYPE_CAD
                                    : vtkSurfaceDenoisingFilter::SURFACE_TYPE_ORGANIC);
      f->Update();
    }
    vtkDataArray* const moved = filter->GetOutput()->GetPointData()->GetArray("Displacement");
    vtkDataArray* const found = again->GetOutput()->GetPointData()->GetArray("Displacement");
    double farthest = 0.0;
    for (vtkIdType i = 0; i < n; ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        ASSERT_EQ(moved->GetComponent(i, k), found->GetComponent(factor * i % n, k)) << i;
        farthest = std::max(farthest, std::abs(moved->GetComponent(i, k)));
      }
    }
    EXPECT_GT(farthest, 0.1);
  }
}

TEST(SurfaceDenoisingFilter, PointsThatMoveFarAreAWarningAndSoIsASurfaceWithoutNoise)
{
  const auto noisy = NoisySphere(0.01, 4);
  vtkNew<vtkSurfaceDenoisingFilter> filter;
  filter->SetInputData(noisy);
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Warnings.empty());
  const auto spoilt = NoisySphere(0.01, 4);
  spoilt->GetPoints()->SetPoint(700, 1.2 * spoilt->GetPoint(700)[0], 1.2 * spoilt->GetPoint(700)[1],
    1.2 * spoilt->GetPoint(700)[2]);
  filter->SetInputData(spoilt);
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("points moved by more than 10 times the noise level"),
    std::string::npos);
  filter->SetInputData(NoisySphere(0.0, 4));
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 2u);
  EXPECT_NE(messages.Warnings[1].find("no noise was found"), std::string::npos);
  EXPECT_EQ(filter->GetEffectiveSurfaceType(), vtkSurfaceDenoisingFilter::SURFACE_TYPE_AUTOMATIC);
  filter->SetNoiseLevel(1e-7);
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 3u);
  EXPECT_NE(messages.Warnings[2].find("NoiseLevel is 1e-07, less than 1e-4"), std::string::npos)
    << messages.Warnings[2];
}

TEST(SurfaceDenoisingFilter, FixedPointsStayAndPointsKeepTheirPrecision)
{
  const auto noisy = NoisySphere(0.01, 4, true);
  vtkNew<vtkDoubleArray> fixed;
  fixed->SetName("fixed");
  for (vtkIdType i = 0; i < noisy->GetNumberOfPoints(); ++i)
  {
    fixed->InsertNextValue(i % 2);
  }
  noisy->GetPointData()->AddArray(fixed);
  vtkNew<vtkSurfaceDenoisingFilter> filter;
  filter->SetInputData(noisy);
  filter->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "fixed");
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPoints()->GetDataType(), VTK_FLOAT);
  double farthest = 0.0;
  for (vtkIdType i = 0; i < noisy->GetNumberOfPoints(); ++i)
  {
    double before[3], after[3];
    noisy->GetPoint(i, before);
    filter->GetOutput()->GetPoint(i, after);
    const double distance = std::sqrt(vtkMath::Distance2BetweenPoints(before, after));
    EXPECT_TRUE(i % 2 == 0 || distance == 0.0) << i;
    farthest = std::max(farthest, distance);
  }
  EXPECT_GT(farthest, 0.005);
}

TEST(SurfaceDenoisingFilter, ActiveNormalsAreThoseOfTheMovedPoints)
{
  const auto noisy = NoisySphere(0.01, 4);
  AddPointArray(noisy, "n", 3, [&](vtkIdType i, int k) { return noisy->GetPoint(i)[k]; });
  AddPointArray(noisy, "other", 3, [&](vtkIdType i, int k) { return noisy->GetPoint(i)[k]; });
  noisy->GetPointData()->SetActiveNormals("n");
  vtkNew<vtkSurfaceDenoisingFilter> filter;
  filter->SetInputData(noisy);
  filter->Update();
  vtkPointData* const data = filter->GetOutput()->GetPointData();
  ASSERT_NE(data->GetNormals(), nullptr);
  EXPECT_STREQ(data->GetNormals()->GetName(), "n");
  EXPECT_EQ(data->GetArray("other"), noisy->GetPointData()->GetArray("other"));
  double worst = 1.0;
  for (vtkIdType i = 0; i < noisy->GetNumberOfPoints(); ++i)
  {
    double p[3];
    filter->GetOutput()->GetPoint(i, p);
    vtkMath::Normalize(p);
    worst = std::min(worst, vtkMath::Dot(p, data->GetNormals()->GetTuple3(i)));
  }
  EXPECT_GT(worst, 0.97); // the noisy ones reach 0.9
}

/// VTK's mappers shade by the normals of cells if points have none.
TEST(SurfaceDenoisingFilter, NormalsOfCellsAreThoseOfTheMovedTriangles)
{
  for (const double side : { 1.0, -1.0 })
  {
    const auto noisy = NoisySphere(0.01, 4);
    const auto addNormals = [&](const char* name)
    {
      noisy->GetCellData()->AddArray(MakeArray(VTK_FLOAT, name, noisy->GetNumberOfCells(), 3,
        [&](vtkIdType c, int k)
        {
          double n[3];
          vtkPolygon::ComputeNormal(noisy->GetCell(c)->GetPoints(), n);
          return side * n[k];
        }));
    };
    addNormals("n");
    addNormals("Normals");
    addNormals("other");
    noisy->GetCellData()->SetActiveNormals("n");
    noisy->GetPointData()->AddArray(MakeArray(VTK_DOUBLE, "Normals", noisy->GetNumberOfPoints(), 3,
      [&](vtkIdType i, int k) { return side * noisy->GetPoint(i)[k]; }));
    AddPointArray(noisy, "Tangents", 3, Rough);
    vtkNew<vtkSurfaceDenoisingFilter> filter;
    filter->SetInputData(noisy);
    filter->Update();
    vtkPolyData* const output = filter->GetOutput();
    vtkCellData* const cells = output->GetCellData();
    ASSERT_NE(cells->GetNormals(), nullptr);
    EXPECT_STREQ(cells->GetNormals()->GetName(), "n");
    EXPECT_TRUE(Identical(cells->GetNormals(), cells->GetArray("Normals")));
    EXPECT_EQ(cells->GetArray("other"), noisy->GetCellData()->GetArray("other"));
    for (vtkIdType c = 0; c < output->GetNumberOfCells(); ++c)
    {
      double n[3];
      vtkPolygon::ComputeNormal(output->GetCell(c)->GetPoints(), n);
      ASSERT_NEAR(side * vtkMath::Dot(n, cells->GetNormals()->GetTuple3(c)), 1.0, 1e-6) << c;
    }
    vtkDataArray* const ofPoints = output->GetPointData()->GetArray("Normals");
    ASSERT_NE(ofPoints, nullptr);
    EXPECT_EQ(ofPoints->GetDataType(), VTK_DOUBLE);
    EXPECT_FALSE(output->GetPointData()->HasArray("Tangents"));
    double worst = 1.0;
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      double p[3];
      output->GetPoint(i, p);
      vtkMath::Normalize(p);
      worst = std::min(worst, side * vtkMath::Dot(p, ofPoints->GetTuple3(i)));
    }
    EXPECT_GT(worst, 0.97);
    EXPECT_TRUE(noisy->GetPointData()->HasArray("Tangents")); // the input is unchanged
  }
}

TEST(SurfaceDenoisingFilter, NeedsANameAndTheArrayThatIsChosen)
{
  const auto noisy = NoisySphere(0.01, 2);
  vtkNew<vtkSurfaceDenoisingFilter> filter;
  filter->SetInputData(noisy);
  Messages messages(filter);
  filter->SetResultArrayName("");
  filter->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "absent");
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(messages.Errors[0].find("ResultArrayName is empty"), std::string::npos);
  EXPECT_NE(messages.Errors[0].find("FixedArray"), std::string::npos);
  EXPECT_EQ(filter->GetOutput()->GetPoints(), noisy->GetPoints());
}
