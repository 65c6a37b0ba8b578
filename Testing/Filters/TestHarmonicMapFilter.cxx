// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkPolygon.h"
#include "vtkStripper.h"

#include <gtest/gtest.h>

using namespace FilterTest;

namespace
{

const double Pi = vtkMath::Pi();

vtkSmartPointer<vtkHarmonicMapFilter> MakeFilter(vtkDataObject* data)
{
  auto filter = vtkSmartPointer<vtkHarmonicMapFilter>::New();
  filter->SetInputDataObject(data);
  filter->SetTimeStep(0.05);
  filter->SetNumberOfTimeSteps(10);
  return filter;
}

/// The unit sphere with its exact normals plus noise as the active normals "n".
vtkSmartPointer<vtkPolyData> SphereWithNoisyNormals(int levels, double noise = 0.3)
{
  auto sphere = Sphere(levels);
  AddPointArray(sphere, "n", 3,
    [&](vtkIdType i, int k) { return sphere->GetPoint(i)[k] + noise * Rough(i, k); });
  sphere->GetPointData()->SetActiveNormals("n");
  return sphere;
}

double Length(vtkDataArray* array, vtkIdType i)
{
  double square = 0.0;
  for (int k = 0; k < array->GetNumberOfComponents(); ++k)
  {
    square += array->GetComponent(i, k) * array->GetComponent(i, k);
  }
  return std::sqrt(square);
}

/// Largest ||u| - 1|.
double LargestLengthError(vtkDataArray* array)
{
  double largest = 0.0;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    largest = std::max(largest, std::abs(Length(array, i) - 1.0));
  }
  return largest;
}

/// Mean angle between the array and the points of a sphere around the origin, in radians.
double MeanAngleToPoints(vtkPolyData* sphere, vtkDataArray* array)
{
  double sum = 0.0;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    double p[3];
    double u[3];
    sphere->GetPoint(i, p);
    array->GetTuple(i, u);
    sum += vtkMath::AngleBetweenVectors(p, u);
  }
  return sum / array->GetNumberOfTuples();
}

std::string OnlyError(vtkHarmonicMapFilter* filter)
{
  Messages messages(filter);
  filter->Update();
  return messages.Errors.size() == 1 ? messages.Errors[0] : "";
}

void ExpectError(vtkHarmonicMapFilter* filter, const std::string& property)
{
  const std::string error = OnlyError(filter);
  EXPECT_NE(error.find(property), std::string::npos) << error;
  EXPECT_NE(error.find("allowed"), std::string::npos) << error;
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetArray("nHarmonic"), nullptr);
}

} // namespace

TEST(HarmonicMapFilter, UsePaperSchemeSetsThePapersReading)
{
  vtkNew<vtkHarmonicMapFilter> filter;
  filter->SetConsistentReaction(true);
  filter->SetProjectToSphere(false);
  filter->SetLineField(true);
  filter->SetMoveVertices(true);
  filter->SetExponent(1.7);
  filter->SetIntrinsicDelaunay(true);
  filter->UsePaperScheme();
  EXPECT_EQ(filter->GetScheme(), vtkHarmonicMapFilter::SCHEME_EXPLICIT_REACTION);
  EXPECT_FALSE(filter->GetConsistentReaction());
  EXPECT_TRUE(filter->GetProjectToSphere());
  EXPECT_FALSE(filter->GetLineField());
  EXPECT_FALSE(filter->GetMoveVertices());
  EXPECT_FALSE(filter->GetIntrinsicDelaunay());
  EXPECT_EQ(filter->GetInitialFill(), vtkHarmonicMapFilter::INITIAL_FILL_INPUT);
  EXPECT_EQ(filter->GetExponent(), 1.7); // unchanged
}

// --- Input and output arrays ---

TEST(HarmonicMapFilter, ComputesNormalsIfThereAreNone)
{
  auto sphere = Sphere(4);
  auto filter = MakeFilter(sphere);
  filter->SetExponent(2.0);
  filter->Update();
  vtkDataArray* result = Result(filter, "NormalsHarmonic");
  ASSERT_NE(result, nullptr);
  EXPECT_EQ(result->GetDataType(), VTK_FLOAT); // as from vtkPolyDataNormals
  EXPECT_LT(MeanAngleToPoints(sphere, result), 0.01);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNormals(), result);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetVectors(), nullptr); // see the class comment
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNumberOfArrays(), 1);
  EXPECT_EQ(sphere->GetPointData()->GetNormals(), nullptr);
}

TEST(HarmonicMapFilter, NormalsOfStripsAreThoseOfTheirTriangles)
{
  const auto sphere = Sphere(3);
  vtkNew<vtkStripper> stripper;
  stripper->SetInputData(sphere);
  stripper->Update();
  ASSERT_GT(stripper->GetOutput()->GetNumberOfStrips(), 0);
  const auto ofTriangles = MakeFilter(sphere);
  const auto ofStrips = MakeFilter(stripper->GetOutput());
  for (vtkHarmonicMapFilter* filter : { ofTriangles.Get(), ofStrips.Get() })
  {
    filter->SetNumberOfTimeSteps(0);
    filter->Update();
  }
  EXPECT_LT(
    LargestDifference(Result(ofStrips, "NormalsHarmonic"), Result(ofTriangles, "NormalsHarmonic")),
    1e-6);
}

TEST(HarmonicMapFilter, ACellWithInvalidPointIdsIsAnErrorBeforeNormalsAreComputed)
{
  auto sphere = Sphere(1);
  sphere->GetPolys()->InsertNextCell({ 0, 1, 1000000 });
  EXPECT_NE(OnlyError(MakeFilter(sphere)).find("point"), std::string::npos);
}

TEST(HarmonicMapFilter, AnEmptyArrayNameSelectsTheNormals)
{
  auto sphere = SphereWithNoisyNormals(3);
  AddPointArray(sphere, "other", 3, Rough);
  sphere->GetPointData()->SetActiveScalars("other");
  auto filter = MakeFilter(sphere);
  SetInputArray(filter, 0, "");
  filter->Update();
  EXPECT_NE(Result(filter, "nHarmonic"), nullptr);
}

TEST(HarmonicMapFilter, UseAsNormalsActsOnNormalsOnly)
{
  auto sphere = SphereWithNoisyNormals(3);
  vtkDataArray* normals = sphere->GetPointData()->GetNormals();
  AddPointArray(sphere, "field", 3, Rough);
  auto filter = MakeFilter(sphere);
  filter->UseAsNormalsOff();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNormals(), normals);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetVectors(), Result(filter, "nHarmonic"));
  filter->UseAsNormalsOn();
  SetInputArray(filter, 0, "field");
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNormals(), normals);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetVectors(), Result(filter, "fieldHarmonic"));
  SetInputArray(filter, 0, "n"); // the active normals, selected by name
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNormals(), Result(filter, "nHarmonic"));
}

TEST(HarmonicMapFilter, AcceptsTwoOrMoreComponents)
{
  auto sphere = Sphere(3);
  for (const int components : { 2, 3, 4, 7 })
  {
    AddPointArray(sphere, "field", components, Rough);
    auto filter = MakeFilter(sphere);
    SetInputArray(filter, 0, "field");
    filter->Update();
    vtkDataArray* result = Result(filter, "fieldHarmonic");
    ASSERT_NE(result, nullptr);
    EXPECT_EQ(result->GetNumberOfComponents(), components);
    EXPECT_LT(LargestLengthError(result), 1e-12);
    EXPECT_EQ(HistoryAt(filter, 0, "Step"), 0.0);
    EXPECT_LT(HistoryAt(filter, 10, "Energy"), HistoryAt(filter, 0, "Energy"));
    vtkPointData* data = filter->GetOutput()->GetPointData();
    EXPECT_EQ(components == 3 ? data->GetVectors() : data->GetScalars(), result);
  }
}

TEST(HarmonicMapFilter, ColoursKeepTheirBrightness)
{
  auto sphere = Sphere(4);
  vtkDataArray* colours = AddPointArray(
    sphere, "rgba", 4,
    [&](vtkIdType i, int k)
    {
      const double chroma[3] = { 1.0 + 0.3 * Rough(i, 0), 1.0 + 0.3 * Rough(i, 1), 0.5 };
      return k < 3 ? std::floor((60.0 + i % 60) * chroma[k]) : static_cast<double>(i % 256);
    },
    VTK_UNSIGNED_CHAR);
  auto filter = MakeFilter(sphere);
  SetInputArray(filter, 0, "rgba");
  filter->SetTimeStep(0.5);
  filter->Update();
  vtkDataArray* result = Result(filter, "rgbaHarmonic");
  ASSERT_NE(result, nullptr);
  EXPECT_EQ(result->GetDataType(), VTK_UNSIGNED_CHAR);
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetScalars(), result);
  for (vtkIdType i = 0; i < result->GetNumberOfTuples(); ++i)
  {
    const auto brightness = [&](vtkDataArray* array)
    {
      const double* c = array->GetTuple(i);
      return std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]);
    };
    const double before = brightness(colours);
    EXPECT_NEAR(brightness(result), before, 1.0);
    EXPECT_EQ(result->GetComponent(i, 3), colours->GetComponent(i, 3));
  }
  filter->SetOutputPrecisionToDouble();
  filter->Update();
  const double* u = Result(filter, "rgbaHarmonic")->GetTuple(7);
  EXPECT_NEAR(u[0] * u[0] + u[1] * u[1] + u[2] * u[2], 1.0, 1e-12);
}

TEST(HarmonicMapFilter, MovedPointsHaveNormalsOfTheirOwn)
{
  auto sphere = SphereWithNoisyNormals(3);
  sphere->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "ofCells", sphere->GetNumberOfCells(), 3,
    [&](vtkIdType c, int k)
    {
      double n[3];
      vtkPolygon::ComputeNormal(sphere->GetCell(c)->GetPoints(), n);
      return n[k];
    }));
  sphere->GetCellData()->SetActiveNormals("ofCells");
  auto filter = MakeFilter(sphere);
  filter->MoveVerticesOn();
  filter->Update();
  vtkPolyData* const output = filter->GetOutput();
  EXPECT_EQ(output->GetPointData()->GetNormals(), Result(filter, "nHarmonic"));
  vtkDataArray* const ofCells = output->GetCellData()->GetNormals();
  ASSERT_NE(ofCells, nullptr);
  for (vtkIdType c = 0; c < output->GetNumberOfCells(); ++c)
  {
    double n[3];
    vtkPolygon::ComputeNormal(output->GetCell(c)->GetPoints(), n);
    ASSERT_NEAR(vtkMath::Dot(n, ofCells->GetTuple3(c)), 1.0, 1e-12) << c;
  }
  EXPECT_FALSE(Identical(Result(filter, "n"), sphere->GetPointData()->GetNormals()));
  filter->MoveVerticesOff();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetCellData()->GetNormals(), sphere->GetCellData()->GetNormals());
}

// --- Size, time ---

TEST(HarmonicMapFilter, NormalsAreComputedAtAnySize)
{
  for (const double size : { 1e-140, 1.0, 1e140 })
  {
    auto sphere = Sphere(4);
    for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
    {
      double p[3];
      sphere->GetPoint(i, p);
      vtkMath::MultiplyScalar(p, size);
      sphere->GetPoints()->SetPoint(i, p);
    }
    auto filter = MakeFilter(sphere);
    filter->SetNumberOfTimeSteps(0);
    filter->Update();
    vtkDataArray* result = Result(filter, "NormalsHarmonic");
    ASSERT_NE(result, nullptr);
    for (vtkIdType i = 0; i < result->GetNumberOfTuples(); ++i)
    {
      const double* p = sphere->GetPoint(i);
      for (int k = 0; k < 3; ++k)
      {
        EXPECT_NEAR(result->GetComponent(i, k), p[k] / size, 0.02);
      }
    }
  }
}

TEST(HarmonicMapFilter, ComputedNormalsAreKeptWhilePlaying)
{
  auto filter = MakeFilter(Sphere(3));
  filter->GenerateTimeStepsOn();
  UpdateAt(filter, 0.5);
  const vtkIdType computed = filter->GetNumberOfStepsComputed();
  UpdateAt(filter, 0.4);
  UpdateAt(filter, 0.5);
  EXPECT_LE(filter->GetNumberOfStepsComputed(), computed + 2); // the run was not restarted
}

// --- Moving vertices ---

TEST(HarmonicMapFilter, MoveVerticesReportsVolumesAndDisplacements)
{
  auto sphere = Sphere(5);
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
  {
    double p[3];
    sphere->GetPoint(i, p);
    for (int k = 0; k < 3; ++k)
    {
      p[k] += 0.01 * Rough(i, k);
    }
    sphere->GetPoints()->SetPoint(i, p);
  }
  for (const bool delaunay : { false, true })
  {
    auto filter = MakeFilter(sphere);
    filter->SetIntrinsicDelaunay(delaunay);
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetPoints(), sphere->GetPoints());
    EXPECT_EQ(filter->GetVolumeBefore(), 0.0);
    filter->MoveVerticesOn();
    filter->Update();
    EXPECT_NEAR(filter->GetVolumeBefore(), 4.0 / 3.0 * Pi, 0.05);
    EXPECT_NEAR(filter->GetVolumeAfter() / filter->GetVolumeBefore(), 1.0, 5e-3);
    EXPECT_GT(filter->GetMeanDisplacement(), 1e-3);
    EXPECT_LT(filter->GetMeanDisplacement(), filter->GetMaximumDisplacement());
    EXPECT_LT(filter->GetMaximumDisplacement(), 0.05);
    double largest = 0.0;
    for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); ++i)
    {
      double p[3];
      double q[3];
      sphere->GetPoint(i, p);
      filter->GetOutput()->GetPoint(i, q);
      largest = std::max(largest, std::sqrt(vtkMath::Distance2BetweenPoints(p, q)));
    }
    EXPECT_NEAR(filter->GetMaximumDisplacement(), largest, 1e-14);
    filter->MoveVerticesOff();
    filter->Update();
    EXPECT_EQ(filter->GetOutput()->GetPoints(), sphere->GetPoints());
    EXPECT_EQ(filter->GetMaximumDisplacement(), 0.0);
  }
}

TEST(HarmonicMapFilter, AChangeOfTheVolumeIsAWarningWhileThePointsMove)
{
  auto ellipsoid = Sphere(1);
  for (vtkIdType i = 0; i < ellipsoid->GetNumberOfPoints(); ++i)
  {
    const double* const p = ellipsoid->GetPoint(i);
    ellipsoid->GetPoints()->SetPoint(i, 3.0 * p[0], p[1], 0.5 * p[2]);
  }
  auto filter = MakeFilter(ellipsoid);
  filter->SetTimeStep(1.0);
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Warnings.empty());
  filter->MoveVerticesOn();
  filter->Update();
  EXPECT_GT(std::abs(filter->GetVolumeAfter() / filter->GetVolumeBefore() - 1.0), 0.02);
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("MoveVertices changes the volume by "), std::string::npos);
  EXPECT_NE(
    messages.Warnings[0].find("set NumberOfTimeSteps or TimeStep lower"), std::string::npos);
  filter->SetNumberOfTimeSteps(0);
  filter->Update();
  EXPECT_EQ(messages.Warnings.size(), 1u);
}

TEST(HarmonicMapFilter, MovedPointsKeepTheirPrecisionAndMergedOnesStayTogether)
{
  auto grid = Grid(6, 6);
  vtkNew<vtkPoints> points; // two copies of the grid with coincident points only
  points->SetDataTypeToFloat();
  vtkNew<vtkCellArray> triangles;
  for (int half = 0; half < 2; ++half)
  {
    for (vtkIdType i = 0; i < 36; ++i)
    {
      double p[3];
      grid->GetPoint(i, p);
      points->InsertNextPoint(half == 0 ? p[0] : -p[0], p[1], 0.2 * Rough(i, 2));
    }
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
    {
      vtkNew<vtkIdList> corners;
      grid->GetCellPoints(c, corners);
      triangles->InsertNextCell(
        { corners->GetId(0) + 36 * half, corners->GetId(half == 0 ? 1 : 2) + 36 * half,
          corners->GetId(half == 0 ? 2 : 1) + 36 * half });
    }
  }
  vtkNew<vtkPolyData> roof;
  roof->SetPoints(points);
  roof->SetPolys(triangles);
  auto filter = MakeFilter(roof);
  filter->MergeCoincidentPointsOn();
  filter->MoveVerticesOn();
  filter->Update();
  vtkPoints* moved = filter->GetOutput()->GetPoints();
  EXPECT_EQ(moved->GetDataType(), VTK_FLOAT);
  EXPECT_GT(filter->GetMaximumDisplacement(), 1e-3);
  for (int j = 0; j < 6; ++j) // the common edge x = 0
  {
    double p[3];
    double q[3];
    moved->GetPoint(6 * j, p);
    moved->GetPoint(6 * j + 36, q);
    EXPECT_EQ(vtkMath::Distance2BetweenPoints(p, q), 0.0);
  }
  EXPECT_EQ(filter->GetVolumeBefore(), 0.0); // open
}

TEST(HarmonicMapFilter, MovedPointsOfIntegersAreRealNumbers)
{
  auto grid = Grid(6, 6);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToInt();
  for (vtkIdType i = 0; i < 36; ++i)
  {
    double p[3];
    grid->GetPoint(i, p);
    points->InsertNextPoint(10.0 * p[0], 10.0 * p[1], std::round(3.0 * Rough(i, 2)));
  }
  grid->SetPoints(points);
  auto filter = MakeFilter(grid);
  filter->MoveVerticesOn();
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPoints()->GetDataType(), VTK_DOUBLE);
  EXPECT_GT(filter->GetMaximumDisplacement(), 1e-3);
}

// --- Errors ---

TEST(HarmonicMapFilter, NamesArraysThatItCannotTake)
{
  auto sphere = SphereWithNoisyNormals(2);
  AddPointArray(sphere, "one", 1, Rough);
  AddPointArray(sphere, "field", 3, Rough);
  AddPointArray(
    sphere, "grey", 2, [](vtkIdType i, int) { return i % 200; }, VTK_UNSIGNED_CHAR);
  for (const char* name : { "one", "grey" }) // the second component of grey is alpha
  {
    auto filter = MakeFilter(sphere);
    SetInputArray(filter, 0, name);
    ExpectError(filter, name);
  }
  auto filter = MakeFilter(sphere);
  SetInputArray(filter, 0, "field");
  filter->MoveVerticesOn();
  ExpectError(filter, "MoveVertices");
}
