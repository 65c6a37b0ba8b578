// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkSurfaceDistanceFilter.h"
#include "vtkTable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

using namespace FilterTest;

namespace
{

using Filter = vtkSurfaceDistanceFilter;

constexpr double Never = std::numeric_limits<double>::infinity();

/// Points, and polylines of their numbers.
vtkSmartPointer<vtkPolyData> Places(const std::vector<std::array<double, 3>>& places,
  const std::vector<std::vector<vtkIdType>>& lines = {})
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const auto& place : places)
  {
    points->InsertNextPoint(place.data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& line : lines)
  {
    cells->InsertNextCell(static_cast<vtkIdType>(line.size()), line.data());
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(cells);
  return data;
}

/// The grid with the point array "source", 1 at one point.
vtkSmartPointer<vtkPolyData> MarkedGrid(int nx, int ny, vtkIdType source)
{
  auto grid = Grid(nx, ny);
  AddPointArray(grid, "source", 1, [&](vtkIdType i, int) { return i == source ? 1.0 : 0.0; });
  return grid;
}

vtkSmartPointer<Filter> MakeFilter(vtkDataObject* surface, vtkDataObject* sources = nullptr)
{
  auto filter = vtkSmartPointer<Filter>::New();
  filter->SetInputDataObject(surface);
  filter->SetMethodToEikonal();
  SetInputArray(filter, 0, "source");
  if (sources)
  {
    filter->SetInputData(1, sources);
  }
  return filter;
}

double At(Filter* filter, vtkIdType point, const char* name = "Distance")
{
  return Result(filter, name)->GetComponent(point, 0);
}

double DistanceOf(Filter* filter, vtkIdType point, const std::array<double, 3>& place)
{
  double x[3];
  filter->GetOutput()->GetPoint(point, x);
  return std::sqrt(vtkMath::Distance2BetweenPoints(x, place.data()));
}

bool Has(const std::string& text, const char* part)
{
  return text.find(part) != std::string::npos;
}

} // namespace

TEST(DistanceFilter, InAPlaneIsExact)
{
  const auto grid = MarkedGrid(30, 20, 30 * 7 + 4);
  auto filter = MakeFilter(grid);
  filter->ComputeGradientOn();
  filter->Update();
  vtkPointData* const arrays = filter->GetOutput()->GetPointData();
  ASSERT_TRUE(arrays->HasArray("Distance") && arrays->HasArray("DistanceGradient"));
  EXPECT_EQ(arrays->GetScalars(), arrays->GetArray("Distance"));
  EXPECT_EQ(arrays->GetArray("NearestSource")->GetDataType(), VTK_INT);
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    const double exact = DistanceOf(filter, i, { 4.0, 7.0, 0.0 });
    EXPECT_NEAR(At(filter, i), exact, 1e-12);
    EXPECT_EQ(At(filter, i, "NearestSource"), 1.0);
    if (exact > 6.0)
    {
      double x[3];
      grid->GetPoint(i, x);
      const double* const gradient = arrays->GetArray("DistanceGradient")->GetTuple3(i);
      EXPECT_NEAR(gradient[0], (x[0] - 4.0) / exact, 0.12);
      EXPECT_NEAR(gradient[1], (x[1] - 7.0) / exact, 0.12);
      EXPECT_EQ(gradient[2], 0.0);
    }
  }
  EXPECT_EQ(filter->GetNumberOfSources(), 1);
  EXPECT_EQ(filter->GetNumberOfUnreachedPoints(), 0);
  EXPECT_EQ(filter->GetMeanEdgeLength() > 1.0, true);
  filter->SetResultArrayName("My");
  filter->Update();
  EXPECT_TRUE(arrays->HasArray("MyDistance") && arrays->HasArray("MyNearestSource"));
}

TEST(DistanceFilter, TakesPointsAndLinesBesideTheSurface)
{
  const auto grid = Grid(21, 11);
  const std::array<double, 3> place = { 3.4, 2.3, 0.7 };
  auto filter = MakeFilter(grid,
    Places({ place, { 16.0, -3.0, 1.0 }, { 16.0, 4.0, 0.0 }, { 16.0, 14.0, -1.0 } },
      { { 1, 2 }, { 2, 3 } }));
  filter->Update();
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    const double fromPoint = DistanceOf(filter, i, { 3.4, 2.3, 0.0 });
    const double fromLine = std::abs(grid->GetPoint(i)[0] - 16.0);
    EXPECT_NEAR(At(filter, i), std::min(fromPoint, fromLine), 1e-6) << i;
    if (std::abs(fromPoint - fromLine) > 1e-3)
    {
      EXPECT_EQ(At(filter, i, "NearestSource"), fromPoint < fromLine ? 0.0 : 1.0) << i;
    }
  }
  EXPECT_EQ(filter->GetNumberOfSources(), 3);
  // A point that is moved in place is read again.
  vtkPolyData* const sources = vtkPolyData::SafeDownCast(filter->GetInputDataObject(1, 0));
  sources->GetPoints()->SetPoint(0, 9.2, 2.3, 0.0);
  filter->Modified();
  filter->Update();
  EXPECT_NEAR(At(filter, 21 * 2 + 9), std::hypot(0.2, 0.3), 1e-12);
  filter->SetMaximumDistance(0.5); // the line ends where it leaves this distance
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfSources(), 3);
  EXPECT_NEAR(At(filter, 21 * 10 + 16), 1.0, 1e-3);
  filter->RemoveAllInputConnections(1);
  EXPECT_TRUE(Has(ErrorOf(filter), "SourceArray \"source\" is not among the point arrays"));
}

TEST(DistanceFilter, TakesTheSourcesOfEachBlock)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, MarkedGrid(9, 5, 0));
  blocks->SetBlock(1, MarkedGrid(9, 5, -1)); // without a source
  blocks->SetBlock(2, Grid(9, 5)); // without the array
  vtkNew<vtkTable> table;
  blocks->SetBlock(3, table);
  auto filter = MakeFilter(blocks);
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Errors.empty());
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_TRUE(Has(messages.Warnings[0], "counts as not set on block 2")) << messages.Warnings[0];
  auto* const output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  const auto distances = [&](unsigned int b)
  { return vtkPolyData::SafeDownCast(output->GetBlock(b))->GetPointData()->GetArray("Distance"); };
  EXPECT_NEAR(distances(0)->GetComponent(44, 0), std::hypot(8.0, 4.0), 1e-12);
  EXPECT_EQ(distances(1)->GetComponent(44, 0), Never);
  EXPECT_EQ(distances(2), nullptr);
  EXPECT_EQ(filter->GetNumberOfUnreachedPoints(), 45);
  // Those of port 1 count on each block.
  filter->SetInputData(1, Places({ { 1.5, 0.5, 0.0 } }));
  filter->Update();
  for (unsigned int b = 0; b < 3; ++b)
  {
    EXPECT_NEAR(distances(b)->GetComponent(0, 0), std::hypot(1.5, 0.5), 1e-12);
  }
}

/// The polylines of the paths, as their points.
std::vector<std::vector<std::array<double, 3>>> PathsOf(Filter* filter)
{
  auto* const lines = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  std::vector<std::vector<std::array<double, 3>>> paths;
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < lines->GetNumberOfCells(); ++c)
  {
    lines->GetCellPoints(c, corners);
    paths.emplace_back();
    for (const vtkIdType corner : *corners)
    {
      paths.back().push_back({});
      lines->GetPoint(corner, paths.back().back().data());
    }
  }
  return paths;
}

double OfPath(Filter* filter, const char* name, vtkIdType path)
{
  auto* const lines = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(1));
  return lines->GetCellData()->GetArray(name)->GetComponent(path, 0);
}

TEST(DistanceFilter, HasPathsToTheNearestSource)
{
  const auto sphere = Sphere(3);
  AddPointArray(sphere, "source", 1, [](vtkIdType i, int) { return i % 200 == 7 ? 1.0 + i : 0.0; });
  std::vector<std::array<double, 3>> places;
  for (vtkIdType i = 0; i < sphere->GetNumberOfPoints(); i += 11)
  {
    places.emplace_back();
    sphere->GetPoint(i, places.back().data());
  }
  const auto ofPoints = MakeFilter(sphere);
  ofPoints->SetMethodToExact();
  const auto ofLine = MakeFilter(sphere, Places({ { 1, 0, 0 }, { 0, 1, 0 } }, { { 0, 1 } }));
  ofLine->SetMethodToExact();
  for (Filter* const filter : { ofPoints.Get(), ofLine.Get() })
  {
    filter->Update();
    EXPECT_EQ(PathsOf(filter).size(), 0u);
    filter->SetInputData(2, Places(places));
    filter->Update();
    const auto paths = PathsOf(filter);
    ASSERT_EQ(paths.size(), places.size());
    for (vtkIdType k = 0; k < static_cast<vtkIdType>(paths.size()); ++k)
    {
      const auto& path = paths[static_cast<std::size_t>(k)];
      double length = 0.0;
      for (std::size_t j = 1; j < path.size(); ++j)
      {
        length += std::sqrt(vtkMath::Distance2BetweenPoints(path[j - 1].data(), path[j].data()));
      }
      const double distance = At(filter, 11 * k);
      EXPECT_NEAR(length, distance, 1e-12) << k;
      EXPECT_NEAR(OfPath(filter, "Length", k), distance, 1e-12) << k;
      EXPECT_EQ(OfPath(filter, "PathPoint", k), k);
      EXPECT_EQ(OfPath(filter, "NearestSource", k), At(filter, 11 * k, "NearestSource")) << k;
      EXPECT_EQ(path.front(), places[static_cast<std::size_t>(k)]);
    }
  }
}

TEST(DistanceFilter, PathsFollowTheirPointsAndBlocks)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, MarkedGrid(9, 5, 0));
  blocks->SetBlock(1, MarkedGrid(9, 5, 8));
  blocks->SetBlock(2, MarkedGrid(9, 5, -1)); // without a source
  auto filter = MakeFilter(blocks);
  const auto points = Places({ { 3.5, 1.0, 0.4 }, { 0.0, 4.0, -0.2 } });
  filter->SetInputData(2, points);
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_TRUE(Has(messages.Warnings[0], "2 path points have no path")) << messages.Warnings[0];
  const double corners[] = { 0.0, 0.0, 8.0, 8.0 };
  ASSERT_EQ(PathsOf(filter).size(), 4u);
  for (vtkIdType k = 0; k < 4; ++k)
  {
    EXPECT_EQ(OfPath(filter, "Block", k), k / 2);
    EXPECT_EQ(OfPath(filter, "PathPoint", k), k % 2);
    const double x = k % 2 == 0 ? 3.5 : 0.0, y = k % 2 == 0 ? 1.0 : 4.0;
    EXPECT_NEAR(OfPath(filter, "Length", k), std::hypot(x - corners[k], y), 1e-12);
  }
  points->GetPoints()->SetPoint(0, 2.0, 1.0, 0.0);
  filter->Modified();
  filter->Update();
  EXPECT_NEAR(OfPath(filter, "Length", 0), std::hypot(2.0, 1.0), 1e-12);
  // Points in another unit, and an array of speeds
  filter->SetInputData(2, Places({ { 35.0, 40.0, 0.0 } }));
  messages.Warnings.clear();
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_TRUE(Has(messages.Warnings[0], "that paths lead from")) << messages.Warnings[0];
  filter->SetAcrossSpeed(2.0);
  SetInputArray(filter, 2, "source");
  EXPECT_TRUE(Has(ErrorOf(filter), "the path points are set together with speeds or start times"));
  EXPECT_EQ(PathsOf(filter).size(), 0u);
  filter->SetAcrossSpeed(1.0);
  SetInputArray(filter, 2, "");
  filter->SetInputData(2, Places({ { vtkMath::Nan(), 0.0, 0.0 } }));
  EXPECT_TRUE(Has(ErrorOf(filter), "a coordinate is not finite at point 0 of the path points"));
  filter->SetInputData(2, Places({}));
  EXPECT_TRUE(Has(ErrorOf(filter), "the third input, the path points, has 0 points"));
  filter->RemoveAllInputConnections(2);
  filter->Update();
  EXPECT_EQ(PathsOf(filter).size(), 0u);
}

TEST(DistanceFilter, NamesInputsThatItCannotTake)
{
  const auto grid = MarkedGrid(9, 5, 3);
  grid->GetCellData()->AddArray(
    MakeArray(VTK_DOUBLE, "c", grid->GetNumberOfCells(), 1, [](vtkIdType, int) { return 1.0; }));
  auto filter = MakeFilter(grid);
  SetInputArray(filter, 0, "c", true);
  EXPECT_TRUE(
    Has(ErrorOf(filter), "SourceArray is a cell array; allowed: point arrays of 1 component"));
  EXPECT_EQ(Result(filter, "Distance"), nullptr);
  vtkNew<vtkTable> table;
  filter->SetInputData(1, table);
  EXPECT_TRUE(Has(ErrorOf(filter), "the sources, is a vtkTable; allowed: a vtkPointSet"));
  filter->SetInputData(1, Places({}));
  EXPECT_TRUE(Has(ErrorOf(filter), "the sources, has 0 points; allowed: 1 or more"));
  filter->SetInputData(1, Places({ { vtkMath::Nan(), 0.0, 0.0 } }));
  EXPECT_TRUE(Has(ErrorOf(filter), "a coordinate is not finite at point 0 of the sources"));
  // Colours are active, and nobody has chosen an array.
  const auto coloured = Grid(9, 5);
  coloured->GetPointData()->SetScalars(MakeArray(VTK_UNSIGNED_CHAR, "rgb",
    coloured->GetNumberOfPoints(), 3, [](vtkIdType i, int k) { return i + k; }));
  vtkNew<Filter> unset;
  unset->SetInputData(coloured);
  EXPECT_TRUE(Has(ErrorOf(unset),
    "SourceArray is not set, and the active array \"rgb\" has 3 components; allowed: 1"))
    << ErrorOf(unset);
}

TEST(DistanceFilter, TakesTheExactMethodUnlessThereAreTimes)
{
  const auto grid = MarkedGrid(9, 5, 3);
  AddPointArray(grid, "start", 1, [](vtkIdType, int) { return 7.0; });
  vtkNew<Filter> filter;
  filter->SetInputData(grid);
  SetInputArray(filter, 0, "source");
  EXPECT_EQ(filter->GetMethod(), Filter::METHOD_AUTOMATIC);
  filter->Update();
  EXPECT_EQ(filter->GetEffectiveMethod(), Filter::METHOD_EXACT);
  EXPECT_NEAR(At(filter, 44), DistanceOf(filter, 44, { 3.0, 0.0, 0.0 }), 1e-13);
  SetInputArray(filter, 9, "start");
  filter->Update();
  EXPECT_EQ(filter->GetEffectiveMethod(), Filter::METHOD_EIKONAL);
  EXPECT_NEAR(
    At(filter, 44, "ArrivalTime"), 7.0 + DistanceOf(filter, 44, { 3.0, 0.0, 0.0 }), 1e-12);
  filter->SetMethodToExact();
  EXPECT_TRUE(Has(
    ErrorOf(filter), "Method is 2; allowed: 1 Eikonal or 3 Automatic together with SourceTimes"));
}

TEST(DistanceFilter, WarnsAboutSourcesThatDoNotCount)
{
  const auto grid = MarkedGrid(9, 5, 3);
  AddPointArray(grid, "source", 1, [](vtkIdType i, int) { return i < 2 ? 1.0 : 0.0; });
  AddPointArray(grid, "mask", 1, [](vtkIdType i, int) { return i == 0 ? 1.0 : 0.0; });
  auto filter = MakeFilter(grid);
  SetInputArray(filter, 1, "mask");
  const auto warningOf = [&]
  {
    const Messages messages(filter);
    filter->Update();
    return messages.Warnings.empty() ? std::string() : messages.Warnings[0];
  };
  EXPECT_TRUE(Has(warningOf(), "1 sources are on no triangle that takes part and do not count"));
  EXPECT_EQ(filter->GetNumberOfSources(), 1);
  SetInputArray(filter, 1, "");
  AddPointArray(grid, "source", 1, [](vtkIdType, int) { return 2.0; });
  EXPECT_TRUE(Has(warningOf(), "all points of the surface are sources"));
  const auto withoutArea = Grid(3, 3, 0.0);
  AddPointArray(withoutArea, "source", 1, [](vtkIdType, int) { return 2.0; });
  filter->SetInputData(withoutArea);
  const std::string warning = warningOf();
  EXPECT_TRUE(Has(warning, "triangles of zero area are barriers")) << warning;
  EXPECT_FALSE(Has(warning, "all points of the surface are sources")) << warning;
}

TEST(DistanceFilter, WarnsAboutSourcesInAnotherUnit)
{
  const auto grid = Grid(9, 5); // in cm, and the sources in mm
  for (const bool onLine : { false, true })
  {
    auto filter = MakeFilter(grid,
      Places({ { 5.0, 5.0, 0.0 }, { 60.0, 35.0, 0.0 }, { 75.0, 10.0, 0.0 } },
        onLine ? std::vector<std::vector<vtkIdType>>{ { 0, 1, 2 } }
               : std::vector<std::vector<vtkIdType>>()));
    Messages messages(filter);
    filter->Update();
    ASSERT_EQ(messages.Warnings.size(), 1u);
    EXPECT_TRUE(Has(messages.Warnings[0],
      "points of the sources are farther than 0.894427 from the surface, which is 8.94427 "
      "large; median distance 60.5392")) // of (60, 35)
      << messages.Warnings[0];
    EXPECT_TRUE(Has(messages.Warnings[0], "; their unit or origin may be another"));
    filter->SetInputData(1, Places({ { 0.5, 0.5, 0.5 }, { 0.75, 1.0, 0.0 }, { 6.0, 3.5, -0.5 } }));
    filter->Update();
    filter->SetMaximumDistance(100.0); // the user has said how far is far
    filter->SetInputData(1, Places({ { 60.0, 35.0, 0.0 } }));
    filter->Update();
    EXPECT_EQ(messages.Warnings.size(), 1u) << messages.Warnings.back();
  }
}
