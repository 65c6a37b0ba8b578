// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every kind of run on coarse and odd surfaces, and every filter as it is on the sources of ParaView's
// menu: polyhedra, extruded outlines, planes of few points, a Moebius strip, several sheets at an
// edge, many parts, parts of many sizes.

#include "Promises.h"
#include "SurfaceData.h"

#include "vtkCleanPolyData.h"
#include "vtkConeSource.h"
#include "vtkCubeSource.h"
#include "vtkCylinderSource.h"
#include "vtkDiskSource.h"
#include "vtkPlaneSource.h"
#include "vtkPlatonicSolidSource.h"
#include "vtkSphereSource.h"
#include "vtkSuperquadricSource.h"
#include "vtkTriangleFilter.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <map>
#include <queue>
#include <set>

using namespace FilterTest;
using SurfaceDiffusion::Testing::CoarseSurfaces;
using SurfaceDiffusion::Testing::NamedSurface;
using SurfaceDiffusion::Testing::SmallCoarseSurfaces;

namespace
{

/// Run without an error. unturned: the surface before it was Rotated().
vtkSmartPointer<vtkPolyDataAlgorithm> RunKind(
  const FilterKind& kind, vtkPolyData* surface, vtkPolyData* unturned = nullptr)
{
  auto filter = kind.Make();
  FitHeights(filter, unturned ? unturned : surface);
  auto* const relief = vtkSurfaceReliefFilter::SafeDownCast(filter);
  if (relief && unturned)
  {
    SurfaceDiffusion::Testing::Surface up{ SurfaceDiffusion::Points(1, 3), {} };
    up.Vertices.row(0) << 0.0, 0.0, 1.0;
    up = SurfaceDiffusion::Testing::Rotated(up);
    relief->SetUpDirection(up.Vertices.data());
  }
  filter->SetInputData(surface);
  Messages messages(filter);
  filter->Update();
  EXPECT_EQ(messages.Errors, std::vector<std::string>());
  return filter;
}

template <typename Check>
void ForEachKind(const std::vector<NamedSurface>& surfaces, Check&& check)
{
  EXPECT_FALSE(surfaces.empty());
  for (const NamedSurface& named : surfaces)
  {
    SCOPED_TRACE(named.Name);
    const auto surface = MakePolyData(named);
    AddDataOfAllFilters(surface);
    for (const FilterKind& kind : AllFilters())
    {
      SCOPED_TRACE(kind.Name);
      check(kind, surface);
    }
  }
}

void ExpectSamePoints(vtkPolyData* a, vtkPolyData* b)
{
  EXPECT_TRUE(Identical(a->GetPoints()->GetData(), b->GetPoints()->GetData()));
}

/// The lengths of the shortest ways along edges from point 0, which are no shorter than distances.
std::vector<double> WaysAlongEdges(const NamedSurface& named)
{
  const auto& s = named.Shape;
  std::map<Eigen::Index, std::set<Eigen::Index>> neighbours;
  for (const auto& f : s.Faces.rowwise())
  {
    for (int a = 0; a < 3; ++a)
    {
      neighbours[f[a]].insert(f[(a + 1) % 3]);
      neighbours[f[(a + 1) % 3]].insert(f[a]);
    }
  }
  std::vector<double> lengths(s.Vertices.rows(), std::numeric_limits<double>::infinity());
  std::set<std::pair<double, Eigen::Index>> open = { { 0.0, 0 } };
  lengths[0] = 0.0;
  while (!open.empty())
  {
    const auto [length, i] = *open.begin();
    open.erase(open.begin());
    for (const Eigen::Index j : neighbours[i])
    {
      const double by = length + (s.Vertices.row(j) - s.Vertices.row(i)).norm();
      if (by < lengths[j])
      {
        lengths[j] = by;
        open.insert({ by, j });
      }
    }
  }
  return lengths;
}

vtkSmartPointer<vtkPolyData> Cleaned(vtkPolyData* surface)
{
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputData(surface);
  vtkNew<vtkCleanPolyData> clean;
  clean->SetInputConnection(triangles->GetOutputPort());
  clean->Update();
  return clean->GetOutput();
}

/// ParaView's sources with their default properties, as they are and with coincident points merged.
std::map<std::string, vtkSmartPointer<vtkPolyData>> SourcesOfTheMenu()
{
  std::map<std::string, vtkSmartPointer<vtkPolyData>> sources;
  const auto add = [&](const std::string& name, vtkPolyDataAlgorithm* source)
  {
    source->Update();
    sources[name] = source->GetOutput();
    sources[name + "Merged"] = Cleaned(source->GetOutput());
  };
  add("Box", vtkNew<vtkCubeSource>());
  add("Cone", vtkNew<vtkConeSource>());
  add("Cylinder", vtkNew<vtkCylinderSource>());
  add("Disk", vtkNew<vtkDiskSource>());
  add("Plane", vtkNew<vtkPlaneSource>());
  add("Sphere", vtkNew<vtkSphereSource>());
  add("Superquadric", vtkNew<vtkSuperquadricSource>());
  for (int type = 0; type < 5; ++type)
  {
    vtkNew<vtkPlatonicSolidSource> solid;
    solid->SetSolidType(type);
    add("Platonic" + std::to_string(type), solid);
  }
  return sources;
}

} // namespace

TEST(CoarseSurfaces, AreTakenByEveryKind)
{
  ForEachKind(CoarseSurfaces(),
    [](const FilterKind& kind, vtkPolyData* surface)
    {
      const auto filter = RunKind(kind, surface);
      ExpectPromises(filter, surface, kind.Result.c_str());
    });
}

TEST(CoarseSurfaces, KeepConstants)
{
  ForEachKind(CoarseSurfaces(),
    [](const FilterKind& kind, vtkPolyData* given)
    {
      const std::string name = DiffusedArray(kind);
      const bool isSegmentation = vtkSurfaceSegmentationFilter::SafeDownCast(kind.Make());
      const bool isOfSlopes = vtkSurfaceDerivativesFilter::SafeDownCast(kind.Make());
      if (name.empty() || isSegmentation || isOfSlopes)
      {
        return;
      }
      vtkNew<vtkPolyData> surface;
      surface->DeepCopy(given);
      for (auto* const data : { surface->GetAttributes(vtkDataObject::POINT),
             surface->GetAttributes(vtkDataObject::CELL) })
      {
        if (vtkDataArray* const array = data->GetArray(name.c_str()))
        {
          for (int k = 0; k < array->GetNumberOfComponents(); ++k)
          {
            array->FillComponent(k, 50.0);
          }
        }
      }
      const auto filter = RunKind(kind, surface);
      vtkDataArray* const result = ResultOf(filter, kind.Result);
      ASSERT_NE(result, nullptr);
      for (int k = 0; k < result->GetNumberOfComponents(); ++k)
      {
        EXPECT_NEAR(result->GetRange(k)[0], 50.0, 1e-8);
        EXPECT_NEAR(result->GetRange(k)[1], 50.0, 1e-8);
      }
    });
}

TEST(CoarseSurfaces, GiveTheSameTurned)
{
  const std::set<std::string> others = { "Turing", "TuringFirstOrder", "TuringCoarseStart",
    "RandomField", "RandomFieldOfMatern", "RandomFieldRough", // noise belongs to coordinates
    "ArrivalTimeDirected", "ArrivalTimeOfFibres", "Helmholtz", // the directions are not turned here
    // Labels of noise depend on the start, whose noise belongs to coordinates.
    "Segmentation", "SegmentationDefaults", "SegmentationOfCells", "SegmentationOfThree" };
  // Relative to the largest value, where results depend on round-off by more than that.
  const std::map<std::string, double> tolerances = {
    // Ten times what is measured: of edges of equal length, either is bisected first.
    { "ArrivalTime", 0.01 }, { "DistanceEikonal", 1e-4 },
    // These iterations stop within their tolerances, the coarsest of all.
    { "TV", 1e-3 }, { "TVGeneralized", 1e-3 }, { "TVCrouzeixRaviart", 1e-3 },
    { "MumfordShahWeighted", 1e-4 }, { "TVChromaticity", 0.01 } // one step of a byte
  };
  // Of two diagonals of equal length, either is Delaunay: after a rotation of the square washer, others of
  // its edges have the weight 0, and errors of the methods depend on that.
  const std::set<std::string> undetermined = { "MumfordShahDirect SquareWasher",
    "DistanceHeat SquareWasher", "DistanceEikonal SquareWasher", "CurvatureAtScale SquareWasher" };
  for (const NamedSurface& named : SmallCoarseSurfaces())
  {
    SCOPED_TRACE(named.Name);
    const auto given = MakePolyData(named);
    const auto turned = MakePolyData({ named.Name, Rotated(named.Shape) });
    AddDataOfAllFilters(given);
    for (const int type : { vtkDataObject::POINT, vtkDataObject::CELL })
    {
      turned->GetAttributes(type)->ShallowCopy(given->GetAttributes(type));
    }
    for (const FilterKind& kind : AllFilters())
    {
      SCOPED_TRACE(kind.Name);
      const auto a = RunKind(kind, given);
      vtkDataArray* const before = ResultOf(a, kind.Result);
      const bool isVector =
        before && before->GetNumberOfComponents() == 3 && kind.Result.find("rgb") != 0;
      const bool isOpen = undetermined.count(kind.Name + std::string(" ") + named.Name) > 0;
      if (others.count(kind.Name) || isOpen || isVector || !before)
      {
        continue;
      }
      const auto b = RunKind(kind, turned, given);
      vtkDataArray* const after = ResultOf(b, kind.Result);
      const auto looser = tolerances.find(kind.Name);
      const double tolerance = looser == tolerances.end() ? 1e-5 : looser->second;
      double largest = 0.0;
      for (vtkIdType i = 0; i < before->GetNumberOfTuples(); ++i)
      {
        const double value = std::abs(before->GetComponent(i, 0));
        largest = std::isfinite(value) ? std::max(largest, value) : largest;
      }
      for (vtkIdType i = 0; i < before->GetNumberOfTuples(); ++i)
      {
        const double x = before->GetComponent(i, 0);
        const double y = after->GetComponent(i, 0);
        if (std::isfinite(x) || std::isfinite(y))
        {
          EXPECT_NEAR(x, y, tolerance * largest) << "row " << i;
        }
      }
    }
  }
}

TEST(CoarseSurfaces, HaveDistancesBetweenTheStraightLineAndTheWayAlongEdges)
{
  for (const NamedSurface& named : SmallCoarseSurfaces())
  {
    SCOPED_TRACE(named.Name);
    const auto surface = MakePolyData(named);
    AddPointArray(surface, "sources", 1, [](vtkIdType i, int) { return i == 0; });
    vtkNew<vtkSurfaceDistanceFilter> filter;
    filter->SetInputData(surface);
    SetInputArray(filter, 0, "sources");
    filter->Update();
    vtkDataArray* const distances = Result(filter, "Distance");
    ASSERT_NE(distances, nullptr);
    const std::vector<double> ways = WaysAlongEdges(named);
    const bool isOfEdges = named.Shape.NumberOfVertices() == 4 &&
      named.Shape.NumberOfTriangles() == 4; // each way in a tetrahedron is an edge
    for (vtkIdType i = 0; i < distances->GetNumberOfTuples(); ++i)
    {
      const double found = distances->GetComponent(i, 0);
      const double straight = (named.Shape.Vertices.row(i) - named.Shape.Vertices.row(0)).norm();
      EXPECT_GE(found, straight * (1.0 - 1e-12)) << i;
      EXPECT_LE(found, ways[static_cast<std::size_t>(i)] * (1.0 + 1e-12)) << i;
      EXPECT_TRUE(!isOfEdges || std::abs(found - straight) <= 1e-12 * straight) << i;
    }
  }
}

TEST(CoarseSurfaces, AreNotMovedWithoutNoiseOrSteps)
{
  for (const NamedSurface& named : CoarseSurfaces())
  {
    SCOPED_TRACE(named.Name);
    const auto surface = MakePolyData(named);
    vtkNew<vtkSurfaceDenoisingFilter> denoising;
    denoising->SetInputData(surface);
    denoising->Update();
    ExpectSamePoints(denoising->GetOutput(), surface);

    vtkNew<vtkHarmonicMapFilter> harmonic;
    harmonic->SetInputData(surface);
    harmonic->MoveVerticesOn();
    harmonic->SetNumberOfTimeSteps(0);
    harmonic->Update();
    ExpectSamePoints(harmonic->GetOutput(), surface);
  }
}

TEST(SourcesOfTheMenu, GiveResultsThatMeanSomethingOrALine)
{
  for (const auto& [name, surface] : SourcesOfTheMenu())
  {
    SCOPED_TRACE(name);
    vtkNew<vtkTuringTextureFilter> turing;
    turing->SetInputData(surface);
    Messages messages(turing);
    turing->Update();
    EXPECT_EQ(messages.Errors, std::vector<std::string>());
    vtkDataArray* const u1 = Result(turing, "u1");
    ASSERT_NE(u1, nullptr);
    const bool grew = u1->GetRange()[1] - u1->GetRange()[0] > 0.1;
    EXPECT_TRUE(grew || !messages.Warnings.empty());

    vtkNew<vtkSurfaceDenoisingFilter> denoising;
    denoising->SetInputData(surface);
    denoising->Update();
    ExpectSamePoints(denoising->GetOutput(), surface);

    vtkNew<vtkPolyData> marked;
    marked->ShallowCopy(surface);
    AddPointArray(marked, "sources", 1, [](vtkIdType i, int) { return i == 0; });
    vtkNew<vtkSurfaceDistanceFilter> distance;
    distance->SetInputData(marked);
    distance->MergeCoincidentPointsOn();
    SetInputArray(distance, 0, "sources");
    distance->Update();
    vtkDataArray* const lengths = Result(distance, "Distance");
    ASSERT_NE(lengths, nullptr);
    for (vtkIdType i = 0; i < lengths->GetNumberOfTuples(); ++i)
    {
      double from[3], to[3];
      marked->GetPoint(0, from);
      marked->GetPoint(i, to);
      const double straight = std::sqrt(vtkMath::Distance2BetweenPoints(from, to));
      EXPECT_GE(lengths->GetComponent(i, 0), straight - 1e-6 * marked->GetLength()) << i;
    }
  }
}
