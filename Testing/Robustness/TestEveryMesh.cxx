// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every filter, with its default properties but few time steps, on all mesh files and on a family
// of surfaces with one defect each. Results are finite, integrals are conserved, bounds hold if the
// scheme has them, and no run is an error. Run by itself the program prints a table. With
// SURFACEDIFFUSION_LONG in the environment (ctest -C Long) runs have their default length.

#include "AllFilters.h"
#include "BadMeshes.h"
#include "MeshFile.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

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

std::vector<Case> MeshFiles()
{
  std::vector<Case> cases;
  const std::string folder = SURFACEDIFFUSION_MESH_DIR;
  if (!folder.empty())
  {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
    {
      if (entry.path().extension() == ".off")
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

vtkSmartPointer<vtkPolyData> MakePolyData(const SurfaceDiffusion::Testing::NamedSurface& named)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(named.InSinglePrecision ? VTK_FLOAT : VTK_DOUBLE);
  for (const auto& v : named.Shape.Vertices.rowwise())
  {
    points->InsertNextPoint(v.data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& f : named.Shape.Faces.rowwise())
  {
    cells->InsertNextCell({ f[0], f[1], f[2] });
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(cells);
  return surface;
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
  AddPointArray(surface, "f", 1, [](vtkIdType i, int k) { return 2.0 + Rough(i, k); });
  surface->GetPointData()->SetActiveScalars("f");
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

std::string Text(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// The change of the integral in the history, relative to its start; the data are positive.
double ChangeOfTotal(vtkAlgorithm* filter)
{
  const vtkIdType last = History(filter)->GetNumberOfRows() - 1;
  const double first = HistoryAt(filter, 0, "Total_0");
  return first == 0.0 ? 0.0 : std::abs(HistoryAt(filter, last, "Total_0") / first - 1.0);
}

/// The largest distance of the values from [1, 3), relative to the length of that interval.
double Overshoot(vtkPolyData* surface, vtkDataArray* u)
{
  double given[2];
  double range[2];
  surface->GetPointData()->GetScalars()->GetRange(given);
  u->GetRange(range);
  return std::max({ 0.0, given[0] - range[0], range[1] - given[1] }) /
    std::max(given[1] - given[0], 1e-300);
}

void SetSteps(vtkSurfaceDiffusionAlgorithm* filter)
{
  if (!Long)
  {
    filter->SetNumberOfTimeSteps(2);
  }
}

class EveryMesh : public testing::TestWithParam<Case>
{
protected:
  void SetUp() override { this->Surface = MakeSurface(this->GetParam()); }

  /// Run the filter and check its result; `examine` returns further findings for the table.
  template <typename Examine>
  void Run(vtkPolyDataAlgorithm* filter, const char* result, Examine examine)
  {
    filter->SetInputData(this->Surface);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty()) << filter->GetClassName() << messages.Errors[0];
    vtkDataArray* u = Result(filter, result);
    if (!u)
    {
      u = filter->GetOutput()->GetCellData()->GetArray(result);
    }
    EXPECT_TRUE(AllFinite(u)) << filter->GetClassName();
    PrintRow(this->GetParam().Name, filter, messages, u ? examine(u) : "");
  }

  void RunConserving(vtkPolyDataAlgorithm* filter, const char* result)
  {
    this->Run(filter, result,
      [&](vtkDataArray*)
      {
        const double change = ChangeOfTotal(filter);
        EXPECT_LE(change, 1e-12) << filter->GetClassName();
        return Text("sum changed by %.1e", change);
      });
  }

  vtkSmartPointer<vtkPolyData> Surface;
};

} // namespace

TEST_P(EveryMesh, IsDiffused)
{
  vtkNew<vtkFVMHeatFilter> heat;
  SetSteps(heat);
  this->RunConserving(heat, "fDiffused");

  vtkNew<vtkIntrinsicTVFilter> tv;
  SetSteps(tv);
  tv->SetFidelityWeight(0.0); // the fidelity term changes the integral
  this->RunConserving(tv, "fTV");

  vtkNew<vtkFVMHeatFilter> bounded;
  SetSteps(bounded);
  bounded->IntrinsicDelaunayOn();
  bounded->SetTimeIntegratorToFirstOrder();
  this->Run(bounded, "fDiffused",
    [&](vtkDataArray* u)
    {
      const double overshoot = Overshoot(this->Surface, u);
      EXPECT_LE(overshoot, 1e-9); // the solver's tolerance
      EXPECT_LE(ChangeOfTotal(bounded), 1e-12);
      return Text("Delaunay: overshoot %.1e", overshoot);
    });
}

TEST_P(EveryMesh, IsDenoisedByTotalVariation)
{
  vtkNew<vtkIntrinsicTVFilter> tv;
  SetSteps(tv);
  this->Run(tv, "fTV",
    [&](vtkDataArray* u) { return Text("overshoot %.1e", Overshoot(this->Surface, u)); });
}

TEST_P(EveryMesh, HasItsNormalsRegularised)
{
  vtkNew<vtkHarmonicMapFilter> harmonic;
  SetSteps(harmonic);
  this->Run(harmonic, "NormalsHarmonic",
    [&](vtkDataArray*)
    {
      const vtkIdType last = History(harmonic)->GetNumberOfRows() - 1;
      const double first = HistoryAt(harmonic, 0, "Energy");
      const double energy = HistoryAt(harmonic, last, "Energy");
      EXPECT_LE(energy, first * (1.0 + 1e-9));
      return Text("energy fell to %.4f", first > 0.0 ? energy / first : 1.0);
    });
}

TEST_P(EveryMesh, HasATextureGrown)
{
  vtkNew<vtkTuringTextureFilter> turing;
  if (!Long)
  {
    turing->SetNumberOfTimeSteps(8);
  }
  this->Run(turing, "u1", [&](vtkDataArray* u) { return Text("smallest %.1e", u->GetRange()[0]); });
}

TEST_P(EveryMesh, HasDirectionsFound)
{
  vtkNew<vtkSurfaceDirectionFieldFilter> field;
  this->Run(field, "Direction", [&](vtkDataArray*) { return std::string(); });
}

class EveryBadMesh : public EveryMesh
{
};

TEST_P(EveryBadMesh, IsTakenByEveryModel)
{
  for (const FilterKind& kind : AllFilters())
  {
    SCOPED_TRACE(kind.Name);
    this->Run(kind.Make(), kind.Result, [&](vtkDataArray*) { return kind.Name; });
  }
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryMesh);
INSTANTIATE_TEST_SUITE_P(Files, EveryMesh, testing::ValuesIn(MeshFiles()), NameOf);
INSTANTIATE_TEST_SUITE_P(Family, EveryMesh, testing::ValuesIn(Family()), NameOf);
INSTANTIATE_TEST_SUITE_P(Family, EveryBadMesh, testing::ValuesIn(Family()), NameOf);
