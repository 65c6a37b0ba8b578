// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"
#include "vtkFieldData.h"
#include "vtkMumfordShahFilter.h"
#include "vtkPartitionedDataSet.h"
#include "vtkSurfaceSegmentationFilter.h"
#include "vtkTensorDiffusionFilter.h"
#include "vtkTuringTextureFilter.h"

#include <gtest/gtest.h>

#include <set>

using namespace FilterTest;

namespace
{

double Color(vtkIdType i, int k)
{
  return std::floor(127.5 + 127.0 * Rough(i, k));
}

} // namespace

TEST(OutputArrays, TheOutputIsTheInputWithOneMoreActiveArray)
{
  auto plane = Grid(6, 5);
  AddPointArray(plane, "other", 2, Rough);
  AddRough(plane);
  plane->GetCellData()->AddArray(
    MakeArray(VTK_INT, "ofCells", plane->GetNumberOfCells(), 1, Rough));
  plane->GetFieldData()->AddArray(MakeArray(VTK_INT, "ofField", 3, 1, Rough));
  auto filter = MakeHeatFilter(plane);
  filter->Update();
  vtkPolyData* output = filter->GetOutput();
  EXPECT_EQ(output->GetPoints(), plane->GetPoints());
  EXPECT_EQ(output->GetPolys(), plane->GetPolys());
  ASSERT_EQ(output->GetPointData()->GetNumberOfArrays(), 3);
  EXPECT_EQ(output->GetPointData()->GetArray("f"), plane->GetPointData()->GetArray("f"));
  EXPECT_EQ(output->GetPointData()->GetArray("other"), plane->GetPointData()->GetArray("other"));
  EXPECT_EQ(output->GetCellData()->GetArray("ofCells"), plane->GetCellData()->GetArray("ofCells"));
  EXPECT_NE(output->GetFieldData()->GetArray("ofField"), nullptr);
  EXPECT_EQ(output->GetPointData()->GetScalars(), Result(filter));
  EXPECT_EQ(plane->GetPointData()->GetNumberOfArrays(), 2); // the input is unchanged
  EXPECT_STREQ(plane->GetPointData()->GetScalars()->GetName(), "f");
}

TEST(OutputArrays, TheResultHasTheRequestedName)
{
  auto plane = Grid(6, 5);
  AddRough(plane);
  AddPointArray(plane, "unnamed", 1, Rough)->SetName(nullptr);
  auto filter = MakeHeatFilter(plane);
  filter->SetResultArrayName("u");
  filter->Update();
  EXPECT_NE(Result(filter, "u"), nullptr);
  EXPECT_EQ(Result(filter), nullptr);
  const auto u = Copy(Result(filter, "u"));

  filter->SetResultArrayName("f"); // replaced
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNumberOfArrays(), 2);
  EXPECT_TRUE(Identical(u, Result(filter, "f")));
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetScalars(), Result(filter, "f"));
  EXPECT_EQ(plane->GetPointData()->GetArray("f")->GetComponent(3, 0), Rough(3, 0));

  filter->SetResultArrayName("");
  filter->Update();
  EXPECT_TRUE(Identical(u, Result(filter)));
}

TEST(OutputArrays, PrecisionFollowsTheInputOrIsSet)
{
  auto plane = Grid(6, 5);
  AddPointArray(plane, "uchar", 1, Color, VTK_UNSIGNED_CHAR);
  AddPointArray(plane, "float", 1, Rough, VTK_FLOAT);
  AddPointArray(plane, "double", 1, Rough, VTK_DOUBLE);
  AddPointArray(plane, "int", 1, Color, VTK_INT);
  AddPointArray(
    plane, "char", 1, [](vtkIdType, int) { return 3.0; }, VTK_SIGNED_CHAR);
  const std::map<std::string, int> types{ { "uchar", VTK_UNSIGNED_CHAR }, { "float", VTK_FLOAT },
    { "double", VTK_DOUBLE }, { "int", VTK_DOUBLE }, { "char", VTK_DOUBLE } };
  for (const auto& [name, type] : types)
  {
    auto filter = MakeHeatFilter(plane);
    SetInputArray(filter, 0, name.c_str());
    const std::string result = name + "Diffused";
    filter->Update();
    EXPECT_EQ(Result(filter, result.c_str())->GetDataType(), type) << name;
    filter->SetOutputPrecisionToSingle();
    filter->Update();
    EXPECT_EQ(Result(filter, result.c_str())->GetDataType(), VTK_FLOAT) << name;
    filter->SetOutputPrecisionToDouble();
    filter->Update();
    EXPECT_EQ(Result(filter, result.c_str())->GetDataType(), VTK_DOUBLE) << name;
  }
}

TEST(OutputArrays, ValuesOutsideTheRangeOfFloatAreAnError)
{
  auto plane = Grid(6, 5);
  AddPointArray(plane, "f", 2, [](vtkIdType i, int k) { return 1e60 * (2.0 + Rough(i, k)); });
  for (vtkSmartPointer<vtkSurfaceDiffusionAlgorithm> filter :
    { vtkSmartPointer<vtkSurfaceDiffusionAlgorithm>(vtkSmartPointer<vtkFVMHeatFilter>::New()),
      vtkSmartPointer<vtkSurfaceDiffusionAlgorithm>(
        vtkSmartPointer<vtkTuringTextureFilter>::New()) })
  {
    filter->SetInputData(plane);
    SetInputArray(filter, 0, "f");
    filter->SetNumberOfTimeSteps(0);
    filter->SetOutputPrecisionToSingle();
    Messages messages(filter);
    filter->Update();
    ASSERT_EQ(messages.Errors.size(), 1U);
    EXPECT_NE(messages.Errors[0].find("OutputPrecision to Double"), std::string::npos);
    EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNumberOfArrays(), 1);

    filter->SetOutputPrecisionToDouble();
    filter->Update();
    EXPECT_EQ(messages.Errors.size(), 1U);
    EXPECT_GT(filter->GetOutput()->GetPointData()->GetNumberOfArrays(), 1);
  }
}

TEST(OutputArrays, ColorsOfAnyNumberOfComponentsCarryAlphaOver)
{
  auto sphere = Sphere(3);
  for (int components = 1; components <= 4; ++components)
  {
    vtkDataArray* colors = AddPointArray(sphere, "rgb", components, Color, VTK_UNSIGNED_CHAR);
    auto filter = MakeHeatFilter(sphere);
    SetInputArray(filter, 0, "rgb");
    filter->Update();
    vtkDataArray* result = Result(filter, "rgbDiffused");
    ASSERT_EQ(result->GetNumberOfComponents(), components);
    const int data = components % 2 ? components : components - 1;
    EXPECT_EQ(History(filter)->GetColumnByName(("Total_" + std::to_string(data)).c_str()), nullptr);
    EXPECT_NE(
      History(filter)->GetColumnByName(("Total_" + std::to_string(data - 1)).c_str()), nullptr);
    int changed = 0;
    for (vtkIdType i = 0; i < colors->GetNumberOfTuples(); ++i)
    {
      if (data < components)
      {
        EXPECT_EQ(result->GetComponent(i, data), colors->GetComponent(i, data));
      }
      changed += result->GetComponent(i, 0) != colors->GetComponent(i, 0);
    }
    EXPECT_GT(changed, colors->GetNumberOfTuples() / 2);
  }
}

TEST(OutputArrays, ColorsAreClampedIfTheStateLeavesTheirRange)
{
  auto sphere = Sphere(4);
  AddPointArray(
    sphere, "black", 1, [](vtkIdType i, int) { return i == 700 ? 255.0 : 0.0; }, VTK_UNSIGNED_CHAR);
  auto filter = MakeHeatFilter(sphere);
  SetInputArray(filter, 0, "black");
  filter->SetTimeStep(3.0); // second order overshoots at a large step
  filter->SetNumberOfTimeSteps(1);
  filter->SetOutputPrecisionToDouble();
  filter->Update();
  const auto exact = Copy(Result(filter, "blackDiffused"));
  double range[2];
  exact->GetRange(range);
  filter->SetOutputPrecisionToInput();
  filter->Update();
  vtkDataArray* clamped = Result(filter, "blackDiffused");
  for (vtkIdType i = 0; i < exact->GetNumberOfTuples(); ++i)
  {
    EXPECT_EQ(clamped->GetComponent(i, 0),
      std::min(255.0, std::max(0.0, std::round(exact->GetComponent(i, 0)))));
  }
  EXPECT_LT(range[0], -1.0);
}

TEST(OutputArrays, PointsWithoutTrianglesKeepTheirValueInEveryType)
{
  auto plane = Grid(6, 5);
  plane->GetPoints()->InsertNextPoint(9.0, 9.0, 9.0);
  for (const int type : { VTK_UNSIGNED_CHAR, VTK_FLOAT, VTK_DOUBLE, VTK_SHORT })
  {
    AddPointArray(
      plane, "f", 2, [](vtkIdType i, int k) { return i == 30 ? 101.0 + k : Color(i, k); }, type);
    auto filter = MakeHeatFilter(plane);
    SetInputArray(filter, 0, "f");
    Messages messages(filter);
    filter->Update();
    EXPECT_EQ(Result(filter)->GetComponent(30, 0), 101.0);
    EXPECT_EQ(Result(filter)->GetComponent(30, 1), 102.0);
    EXPECT_TRUE(messages.Warnings.empty());
  }
}

TEST(OutputArrays, PrecisionsHaveTheNumbersOfVTK)
{
  auto plane = Grid(6, 5);
  AddPointArray(plane, "f", 1, Rough, VTK_FLOAT);
  auto filter = MakeHeatFilter(plane);
  SetInputArray(filter, 0, "f");
  for (const auto& [precision, type] : { std::pair{ vtkAlgorithm::SINGLE_PRECISION, VTK_FLOAT },
         std::pair{ vtkAlgorithm::DOUBLE_PRECISION, VTK_DOUBLE },
         std::pair{ vtkAlgorithm::DEFAULT_PRECISION, VTK_FLOAT } })
  {
    filter->SetOutputPrecision(precision);
    filter->Update();
    EXPECT_EQ(Result(filter)->GetDataType(), type) << precision;
  }
}

/// Mappers read three components of active normals and two of texture coordinates.
TEST(OutputArrays, AResultDoesNotInheritTheRoleOfTheArrayThatItReplaces)
{
  for (const int role : { vtkDataSetAttributes::NORMALS, vtkDataSetAttributes::TCOORDS })
  {
    auto plane = Grid(6, 5);
    AddPointArray(plane, "former", role == vtkDataSetAttributes::NORMALS ? 3 : 2, Rough);
    plane->GetPointData()->SetActiveAttribute("former", role);
    AddRough(plane);
    auto filter = MakeHeatFilter(plane);
    filter->SetResultArrayName("former");
    Messages messages(filter);
    filter->Update();
    vtkPointData* const data = filter->GetOutput()->GetPointData();
    EXPECT_EQ(data->GetAttribute(role), nullptr);
    EXPECT_EQ(data->GetScalars(), Result(filter, "former"));
    EXPECT_EQ(data->GetNumberOfArrays(), 2);
    EXPECT_EQ(plane->GetPointData()->GetArray("former")->GetNumberOfComponents(),
      3 - (role == vtkDataSetAttributes::TCOORDS));
    ASSERT_EQ(messages.Warnings.size(), 1u);
    EXPECT_NE(messages.Warnings[0].find("\"former\""), std::string::npos);
    filter->SetTimeStep(2.0);
    filter->Update();
    EXPECT_EQ(messages.Warnings.size(), 1u);
  }
}

TEST(OutputArrays, ReplacingTheInputArrayItselfIsNoWarning)
{
  auto plane = Grid(6, 5);
  AddRough(plane);
  auto filter = MakeHeatFilter(plane);
  filter->SetResultArrayName("f");
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Warnings.empty());
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNumberOfArrays(), 1);
}

// Process 0 receives only the arrays that the filter reads.
TEST(OutputArrays, ReplacingAnArrayOfPiecesIsOneWarning)
{
  vtkNew<vtkPartitionedDataSet> pieces;
  for (unsigned int p = 0; p < 2; ++p)
  {
    auto piece = Grid(4, 5);
    for (vtkIdType i = 0; i < piece->GetNumberOfPoints(); ++i)
    {
      double x[3];
      piece->GetPoint(i, x);
      piece->GetPoints()->SetPoint(i, x[0] + 3.0 * p, x[1], x[2]);
    }
    AddRough(piece);
    AddPointArray(piece, "former", 2, Rough);
    piece->GetPointData()->SetActiveScalars("f");
    pieces->SetPartition(p, piece);
  }
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputDataObject(pieces);
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Warnings.empty());
  filter->SetResultArrayName("former");
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("\"former\""), std::string::npos);
  auto* output = vtkPartitionedDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  for (unsigned int p = 0; p < 2; ++p)
  {
    vtkPointData* const data = output->GetPartition(p)->GetPointData();
    EXPECT_EQ(data->GetNumberOfArrays(), 2);
    EXPECT_EQ(data->GetArray("former")->GetNumberOfComponents(), 1);
    EXPECT_EQ(data->GetArray("former")->GetNumberOfTuples(), 20);
  }
}

TEST(OutputArrays, ATextureOverOtherArraysIsOneWarning)
{
  auto plane = Grid(6, 5);
  AddPointArray(plane, "u1", 1, [](vtkIdType i, int) { return i == 3; });
  AddPointArray(plane, "Texture", 3, Rough);
  vtkNew<vtkTuringTextureFilter> filter;
  filter->SetInputData(plane);
  filter->SetNumberOfTimeSteps(1);
  SetInputArray(filter, 1, "u1");
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("\"Texture\", \"u1\""), std::string::npos)
    << messages.Warnings[0];
  EXPECT_EQ(Result(filter, "Texture")->GetNumberOfComponents(), 1);
}

namespace
{

/// The names of the arrays that the output has and the input has not.
std::set<std::string> NewNames(vtkPolyDataAlgorithm* filter, vtkPolyData* input)
{
  std::set<std::string> names;
  for (const int type : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    vtkDataSetAttributes* const after = filter->GetOutput()->GetAttributes(type);
    for (int a = 0; a < after->GetNumberOfArrays(); ++a)
    {
      const char* const name = after->GetArrayName(a);
      if (!input->GetAttributes(type)->HasArray(name))
      {
        names.insert(name);
      }
    }
  }
  return names;
}

} // namespace

TEST(OutputArrays, ResultArrayNameIsThePrefixOfTheOtherArrays)
{
  using Names = std::set<std::string>;
  const auto plane = Grid(8, 8);
  AddPointArray(plane, "f", 1, [](vtkIdType i, int) { return i % 8 < 4 ? 0.0 : 1.0; });
  plane->GetPointData()->SetActiveScalars("f");
  vtkNew<vtkMumfordShahFilter> shah;
  vtkNew<vtkSurfaceSegmentationFilter> segmentation;
  vtkNew<vtkTensorDiffusionFilter> tensor;
  tensor->SetModelToEdgeEnhancing();
  tensor->DiffusionAxesOn();
  const auto expect =
    [&](vtkSurfaceModelAlgorithm* filter, const Names& automatic, const Names& named)
  {
    filter->SetInputData(plane);
    filter->Update();
    EXPECT_EQ(NewNames(filter, plane), automatic);
    filter->SetResultArrayName("my");
    filter->Update();
    EXPECT_EQ(NewNames(filter, plane), named);
  };
  expect(shah, { "fMumfordShah", "Edges" }, { "my", "myEdges" });
  auto* curves = vtkPolyData::SafeDownCast(shah->GetOutputDataObject(2));
  EXPECT_TRUE(curves->GetPointData()->HasArray("myEdges"));
  expect(segmentation, { "fSegmented", "RegionId", "RegionProbability" },
    { "my", "myRegionId", "myRegionProbability" });
  EXPECT_STREQ(segmentation->GetOutput()->GetPointData()->GetScalars()->GetName(), "myRegionId");
  expect(tensor, { "fEdgeEnhanced", "DiffusionAxes" }, { "my", "myDiffusionAxes" });
  vtkNew<vtkTuringTextureFilter> texture;
  texture->SetNumberOfTimeSteps(1);
  texture->ColorOutputOn();
  expect(texture, { "u1", "u2", "Texture", "TextureColor" },
    { "myu1", "myu2", "myTexture", "myTextureColor" });
  EXPECT_EQ(Result(texture, "myTextureColor")->GetDataType(), VTK_UNSIGNED_CHAR);
  EXPECT_STREQ(texture->GetOutput()->GetPointData()->GetScalars()->GetName(), "myTextureColor");
}

/// The data are replaced on purpose only if ResultArrayName is their name.
TEST(OutputArrays, OtherResultsThatReplaceTheDataAreAWarning)
{
  const std::string sentence = "results replace arrays of the input: ";
  const auto plane = Grid(8, 8);
  AddPointArray(plane, "Edges", 1, [](vtkIdType i, int) { return i % 8 < 4 ? 0.0 : 1.0; });
  plane->GetPointData()->SetActiveScalars("Edges");
  vtkNew<vtkMumfordShahFilter> shah;
  shah->SetInputData(plane);
  Messages ofEdges(shah);
  shah->Update();
  ASSERT_EQ(ofEdges.Warnings.size(), 1u);
  EXPECT_NE(ofEdges.Warnings[0].find(sentence + "\"Edges\";"), std::string::npos)
    << ofEdges.Warnings[0];
  shah->SetResultArrayName("Edges"); // the result replaces the data, and the edges have a prefix
  shah->Update();
  EXPECT_EQ(ofEdges.Warnings.size(), 1u);
  EXPECT_EQ(NewNames(shah, plane), std::set<std::string>{ "EdgesEdges" });

  vtkNew<vtkSurfaceSegmentationFilter> first, second;
  first->SetInputData(plane);
  second->SetInputConnection(first->GetOutputPort());
  Messages ofRegions(second);
  second->Update();
  ASSERT_EQ(ofRegions.Warnings.size(), 1u);
  EXPECT_NE(ofRegions.Warnings[0].find(sentence + "\"RegionId\", \"RegionProbability\";"),
    std::string::npos)
    << ofRegions.Warnings[0];
  second->SetResultArrayName("again");
  second->Update();
  EXPECT_EQ(ofRegions.Warnings.size(), 1u);
  EXPECT_NE(Result(second, "RegionId"), nullptr);
  EXPECT_NE(Result(second, "againRegionId"), nullptr);
}
