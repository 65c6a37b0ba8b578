// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every filter, with its default properties but few time steps, on mesh files and on a family of
// surfaces with one defect each. The promises of each class hold (Promises.h), and no run is an
// error. Run by itself the program prints a table. With SURFACEDIFFUSION_LONG in the environment
// (the test preset "long") all mesh files are read, and runs have their default length.

#include "MeshFile.h"
#include "Promises.h"
#include "SurfaceData.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>

using namespace FilterTest;

namespace
{

const bool Long = std::getenv("SURFACEDIFFUSION_LONG") != nullptr;

/// The name of a mesh file, or a surface of the family.
struct Case
{
  std::string Name;
  std::string File;
};

void PrintTo(const Case& c, std::ostream* os)
{
  *os << c.Name;
}

std::string NameOf(const testing::TestParamInfo<Case>& info)
{
  std::string name = info.param.Name;
  std::replace_if(
    name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
  return name;
}

/// A tenth of the mesh files, with every defect that occurs in them.
const std::set<std::string> SomeMeshes = {
  "anchor_dense", // angles from 0.0007 to 180 degrees, genus 4
  "bear", // a closed scan of 14,000 points
  "blobby-shuffled", // triangles of both orientations
  "boeing", // 122 components, 1,477 coincident points
  "bones", // 26 closed components
  "cow", // a coincident point
  "degtri_sliding", // triangles of zero area
  "double-torus-example", // polygons of 4 to 7 corners, genus 2
  "elephant-with-holes", // open, coincident points
  "fandisk", // sharp creases
  "mpi_triang", // angles of 2e-5 degrees, genus 1
  "polygon_mesh", // non-manifold vertices
  "prim", // isolated vertices
  "triceratops", // angles from 0.0002 to 180 degrees
};

std::vector<Case> MeshFiles()
{
  std::vector<Case> cases;
  const std::string folder = SURFACEDIFFUSION_MESH_DIR;
  if (!folder.empty())
  {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
    {
      if (entry.path().extension() == ".off" && (Long || SomeMeshes.count(entry.path().stem())))
      {
        cases.push_back({ entry.path().stem().string(), entry.path().string() });
      }
    }
  }
  std::sort(
    cases.begin(), cases.end(), [](const Case& a, const Case& b) { return a.Name < b.Name; });
  return cases;
}

std::vector<Case> Family()
{
  std::vector<Case> cases;
  for (const auto& bad : SurfaceDiffusion::Testing::BadMeshes())
  {
    cases.push_back({ bad.Name, "" });
  }
  return cases;
}

/// The surface of the case, with the rough positive data "f" in [1, 3).
vtkSmartPointer<vtkPolyData> MakeSurface(const Case& c)
{
  vtkSmartPointer<vtkPolyData> surface;
  if (!c.File.empty())
  {
    surface = ReadOFF(c.File);
  }
  else
  {
    for (const auto& bad : SurfaceDiffusion::Testing::BadMeshes())
    {
      surface = bad.Name == c.Name ? MakePolyData(bad) : surface;
    }
  }
  AddDataOfAllFilters(surface);
  return surface;
}

/// Print a row of the table, in columns of fixed width.
void PrintRow(const std::string& mesh, vtkPolyDataAlgorithm* filter, const Messages& messages,
  const std::string& found)
{
  std::string message = messages.Errors.empty() ? "" : "error: " + messages.Errors[0];
  if (message.empty() && !messages.Warnings.empty())
  {
    message = messages.Warnings[0];
  }
  message = message.substr(message.find("):") == std::string::npos ? 0 : message.find("):") + 3);
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::printf("| %-28s | %-30s | %-34s | %s |\n", mesh.c_str(), filter->GetClassName(),
    found.c_str(), message.c_str());
}

void SetSteps(vtkSurfaceDiffusionAlgorithm* filter, int steps)
{
  if (!Long)
  {
    filter->SetNumberOfTimeSteps(steps);
  }
}

class EveryMesh : public testing::TestWithParam<Case>
{
protected:
  void SetUp() override { this->Surface = MakeSurface(this->GetParam()); }

  /// Run the filter and check the promises of its class.
  void Run(vtkPolyDataAlgorithm* filter, const char* result)
  {
    SCOPED_TRACE(filter->GetClassName());
    filter->SetInputData(this->Surface);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty()) << messages.Errors[0];
    const bool solverFailed = std::any_of(messages.Warnings.begin(), messages.Warnings.end(),
      [](const std::string& warning)
      { return warning.find("missed its tolerance") != std::string::npos; });
    PrintRow(this->GetParam().Name, filter, messages,
      ExpectPromises(filter, this->Surface, result, solverFailed));
  }

  vtkSmartPointer<vtkPolyData> Surface;
};

} // namespace

TEST_P(EveryMesh, IsDiffused)
{
  vtkNew<vtkFVMHeatFilter> heat;
  SetSteps(heat, 2);
  this->Run(heat, "fDiffused");

  vtkNew<vtkFVMHeatFilter> bounded;
  SetSteps(bounded, 2);
  bounded->IntrinsicDelaunayOn();
  bounded->SetTimeIntegratorToFirstOrder();
  this->Run(bounded, "fDiffused");
}

TEST_P(EveryMesh, IsDenoisedByTotalVariation)
{
  for (const double fidelity : { 0.0, 3.0 })
  {
    vtkNew<vtkIntrinsicTVFilter> tv;
    SetSteps(tv, 2);
    tv->SetFidelityWeight(fidelity);
    this->Run(tv, "fTV");
  }
}

TEST_P(EveryMesh, HasItsCellDataDiffused)
{
  for (const bool detail : { true, false })
  {
    vtkNew<vtkFVMHeatFilter> heat;
    SetSteps(heat, 2);
    SetInputArray(heat, 0, "c", true);
    heat->SetKeepCellDetail(detail);
    this->Run(heat, "cDiffused");
  }
}

TEST_P(EveryMesh, HasItsNormalsRegularised)
{
  vtkNew<vtkHarmonicMapFilter> harmonic;
  SetSteps(harmonic, 2);
  this->Run(harmonic, "NormalsHarmonic");
}

TEST_P(EveryMesh, HasItsEdgesFound)
{
  vtkNew<vtkMumfordShahFilter> shah;
  SetSteps(shah, 40);
  shah->AutomaticThresholdOff();
  shah->SetEdgeThreshold(0.8);
  this->Run(shah, "fMumfordShah");
}

TEST_P(EveryMesh, IsDiffusedAlongItsDataByTensors)
{
  vtkNew<vtkTensorDiffusionFilter> beltrami;
  SetSteps(beltrami, 2);
  this->Run(beltrami, "fBeltrami");

  vtkNew<vtkTensorDiffusionFilter> coherent;
  SetSteps(coherent, 1);
  coherent->SetModelToCoherenceEnhancing();
  coherent->SetSolverToDirect(); // on needles, errors of other solvers raise the variance
  this->Run(coherent, "fCoherent");
}

TEST_P(EveryMesh, HasATextureGrown)
{
  vtkNew<vtkTuringTextureFilter> turing;
  SetSteps(turing, 8);
  this->Run(turing, "u1");

  vtkNew<vtkTuringTextureFilter> firstOrder;
  SetSteps(firstOrder, 8);
  firstOrder->SetTimeIntegratorToFirstOrder();
  this->Run(firstOrder, "u1");
}

TEST_P(EveryMesh, HasDistancesMeasured)
{
  for (const int method : { 0, 1, 3 })
  {
    vtkNew<vtkSurfaceDistanceFilter> distance;
    distance->SetMethod(method);
    distance->ComputeGradientOn();
    SetInputArray(distance, 0, "sources");
    this->Run(distance, "Distance");
  }
}

TEST_P(EveryMesh, HasDirectionsFound)
{
  vtkNew<vtkSurfaceDirectionFieldFilter> field;
  this->Run(field, "Direction");
}

class EveryBadMesh : public EveryMesh
{
};

TEST_P(EveryBadMesh, IsTakenByEveryModel)
{
  for (const FilterKind& kind : AllFilters())
  {
    SCOPED_TRACE(kind.Name);
    const auto filter = kind.Make();
    FitHeights(filter, this->Surface);
    this->Run(filter, kind.Result.c_str());
  }
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryMesh);
INSTANTIATE_TEST_SUITE_P(Files, EveryMesh, testing::ValuesIn(MeshFiles()), NameOf);
INSTANTIATE_TEST_SUITE_P(Family, EveryMesh, testing::ValuesIn(Family()), NameOf);
INSTANTIATE_TEST_SUITE_P(Family, EveryBadMesh, testing::ValuesIn(Family()), NameOf);
