// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"
#include "vtkPartitionedDataSet.h"
#include "vtkSOADataArrayTemplate.h"

#include <gtest/gtest.h>

using namespace FilterTest;

namespace
{

const std::vector<int> NumericTypes{ VTK_BIT, VTK_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR,
  VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_INT, VTK_UNSIGNED_INT, VTK_LONG, VTK_UNSIGNED_LONG,
  VTK_LONG_LONG, VTK_UNSIGNED_LONG_LONG, VTK_ID_TYPE, VTK_FLOAT, VTK_DOUBLE };

bool InHole(vtkIdType i)
{
  return i % 10 > 5 && i % 10 < 9 && i / 10 > 3 && i / 10 < 7;
}

} // namespace

TEST(InputArrays, DataAndWeightsOfAnyNumericTypeGiveTheSameResult)
{
  auto plane = Grid(10, 10);
  const auto value = [](vtkIdType i, int) { return i % 3 == 0; };
  AddPointArray(plane, "f", 1, value);
  auto reference = MakeHeatFilter(plane);
  SetInputArray(reference, 0, "f");
  SetInputArray(reference, 5, "f");
  reference->SetFidelityWeight(0.5);
  reference->Update();
  for (const int type : NumericTypes)
  {
    AddPointArray(plane, "typed", 1, value, type);
    auto filter = MakeHeatFilter(plane);
    SetInputArray(filter, 0, "typed");
    SetInputArray(filter, 5, "typed"); // weights
    filter->SetFidelityWeight(0.5);
    filter->SetOutputPrecisionToDouble();
    filter->Update();
    EXPECT_TRUE(Identical(Result(filter, "typedDiffused"), Result(reference))) << type;
  }
}

TEST(InputArrays, DataMayBeStoredByComponent)
{
  auto plane = Grid(10, 10);
  AddRough(plane, 3);
  vtkNew<vtkSOADataArrayTemplate<double>> byComponent;
  byComponent->SetNumberOfComponents(3);
  byComponent->SetNumberOfTuples(100);
  byComponent->SetName("soa");
  for (vtkIdType i = 0; i < 100; ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      byComponent->SetComponent(i, k, Rough(i, k));
    }
  }
  plane->GetPointData()->AddArray(byComponent);
  auto filter = MakeHeatFilter(plane);
  filter->Update();
  const auto reference = Copy(Result(filter));
  SetInputArray(filter, 0, "soa");
  filter->Update();
  EXPECT_TRUE(Identical(Result(filter, "soaDiffused"), reference));
}

TEST(InputArrays, MasksOfAnyNumericTypeHaveTheSameEffect)
{
  auto plane = Grid(10, 10);
  AddRough(plane);
  AddPointArray(plane, "mask", 1, [](vtkIdType i, int) { return InHole(i); });
  for (const int mode :
    { vtkFVMHeatFilter::MASK_MODE_INPAINT, vtkFVMHeatFilter::MASK_MODE_EXCLUDE })
  {
    auto reference = MakeHeatFilter(plane);
    SetInputArray(reference, 1, "mask");
    reference->SetMaskMode(mode);
    reference->SetFidelityWeight(1.0);
    reference->Update();
    for (const int type : NumericTypes)
    {
      // Any nonzero value means missing.
      const double missing = type == VTK_FLOAT || type == VTK_DOUBLE ? 0.01
        : type == VTK_BIT                                            ? 1.0
                                                                     : 77.0;
      AddPointArray(
        plane, "typed", 1, [&](vtkIdType i, int) { return InHole(i) ? missing : 0.0; }, type);
      auto filter = MakeHeatFilter(plane);
      SetInputArray(filter, 1, "typed");
      filter->SetMaskMode(mode);
      filter->SetFidelityWeight(1.0);
      filter->Update();
      EXPECT_TRUE(Identical(Result(filter), Result(reference))) << type;
    }
  }
}

TEST(InputArrays, FixedTakesPrecedenceOverMissing)
{
  auto plane = Grid(10, 10);
  AddRough(plane);
  AddPointArray(plane, "mask", 1, [](vtkIdType i, int) { return InHole(i); });
  AddPointArray(plane, "fixed", 1, [](vtkIdType i, int) { return i == 66; });
  auto filter = MakeHeatFilter(plane);
  SetInputArray(filter, 1, "mask");
  SetInputArray(filter, 3, "fixed");
  filter->Update();
  EXPECT_EQ(Result(filter)->GetComponent(66, 0), Rough(66, 0));
  EXPECT_NE(Result(filter)->GetComponent(67, 0), Rough(67, 0));
}

TEST(InputArrays, AMaskWithoutEffectIsOneWarning)
{
  auto plane = Grid(10, 10);
  AddRough(plane);
  AddPointArray(plane, "empty", 1, [](vtkIdType, int) { return 0.0; });
  AddPointArray(plane, "mask", 1, [](vtkIdType i, int) { return InHole(i); });
  auto filter = MakeHeatFilter(plane);
  Messages messages(filter);
  SetInputArray(filter, 1, "mask");
  filter->Update(); // missing points start from the mean
  EXPECT_TRUE(messages.Warnings.empty());
  filter->SetInitialFillToInput(); // without fidelity, missing and known points are equivalent
  filter->Update();
  ASSERT_EQ(messages.Warnings.size(), 1u);
  EXPECT_NE(messages.Warnings[0].find("mask"), std::string::npos);
  filter->SetFidelityWeight(1.0);
  filter->Update();
  EXPECT_EQ(messages.Warnings.size(), 1u);
  SetInputArray(filter, 1, "empty");
  filter->Update();
  EXPECT_EQ(messages.Warnings.size(), 2u);
  filter->SetMaskModeToExclude();
  filter->Update();
  EXPECT_EQ(messages.Warnings.size(), 3u);
  EXPECT_TRUE(messages.Errors.empty());
}

TEST(InputArrays, MayBeOnPointsOrOtherwiseOnCells)
{
  const int either = vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS;
  auto plane = Grid(10, 10);
  AddRough(plane);
  const auto east = [](vtkIdType, int k) { return k == 0; };
  plane->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "east", plane->GetNumberOfCells(), 3, east));
  const auto run = [&](int association)
  {
    auto filter = MakeHeatFilter(plane);
    filter->SetAcrossDiffusivity(0.0);
    filter->SetInputArrayToProcess(0, 0, 0, either, "f");
    filter->SetInputArrayToProcess(2, 0, 0, association, "east");
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty()) << association;
    return vtkSmartPointer<vtkDataArray>(Result(filter));
  };
  const auto onCells = run(vtkDataObject::FIELD_ASSOCIATION_CELLS);
  EXPECT_TRUE(Identical(run(either), onCells));
  AddPointArray(plane, "east", 3, [](vtkIdType, int k) { return k == 1; }); // points come first
  EXPECT_FALSE(Identical(run(either), onCells));
}

TEST(InputArrays, AMissingArrayIsReportedOnce)
{
  auto plane = Grid(10, 10);
  AddRough(plane);
  auto filter = MakeHeatFilter(plane);
  filter->SetAlongDiffusivity(2.0);
  SetInputArray(filter, 2, "nosuch");
  Messages messages(filter);
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(messages.Errors[0].find("DirectionArray \"nosuch\" is not among"), std::string::npos);
  EXPECT_EQ(messages.Errors[0].find("not set"), std::string::npos) << messages.Errors[0];
}

/// A first Apply on a mesh without point arrays.
TEST(InputArrays, OfCellsAreTheDefaultWithoutPointScalarsAndNamedIfTheAssociationIsWrong)
{
  auto plane = Grid(10, 10);
  const auto errorOf = [](vtkFVMHeatFilter* filter)
  {
    Messages messages(filter);
    filter->Update();
    EXPECT_EQ(messages.Errors.size(), 1u);
    return messages.Errors.empty() ? std::string() : messages.Errors[0];
  };
  auto filter = MakeHeatFilter(plane);
  EXPECT_NE(errorOf(filter).find("no active point or cell Scalars"), std::string::npos);
  const auto array = MakeArray(VTK_DOUBLE, "ofCells", plane->GetNumberOfCells(), 1, Rough);
  plane->GetCellData()->SetScalars(array);
  filter->Modified();
  filter->Update();
  EXPECT_NE(filter->GetOutput()->GetCellData()->GetArray("ofCellsDiffused"), nullptr);
  SetInputArray(filter, 0, "ofCells");
  EXPECT_NE(
    errorOf(filter).find("association 1 for the cell array of this name"), std::string::npos);
  AddPointArray(plane, "ofPoints", 1, Rough);
  SetInputArray(filter, 0, "ofPoints", true);
  EXPECT_NE(
    errorOf(filter).find("association 0 for the point array of this name"), std::string::npos);
}

TEST(InputArrays, AreFoundByAnyAttributeInPieces)
{
  for (const int role : { vtkDataSetAttributes::TCOORDS, vtkDataSetAttributes::TENSORS })
  {
    const int components = role == vtkDataSetAttributes::TCOORDS ? 2 : 9;
    const auto makePart = [&](double x)
    {
      auto part = Grid(4, 5);
      vtkPoints* const points = part->GetPoints();
      for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
      {
        const double* p = points->GetPoint(i);
        points->SetPoint(i, p[0] + x, p[1], p[2]);
      }
      AddPointArray(part, "role", components,
        [&](vtkIdType i, int k) { return std::sin(points->GetPoint(i)[0] * (k + 1)); });
      part->GetPointData()->SetActiveAttribute("role", role);
      return part;
    };
    vtkNew<vtkPartitionedDataSet> partitions;
    partitions->SetPartition(0, makePart(0.0));
    partitions->SetPartition(1, makePart(3.0));
    vtkNew<vtkFVMHeatFilter> filter;
    filter->SetInputDataObject(partitions);
    filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, role);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty()) << role;
    auto* const output = vtkPartitionedDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    for (int p = 0; p < 2; ++p)
    {
      vtkDataArray* const result =
        output->GetPartition(p)->GetPointData()->GetArray("roleDiffused");
      ASSERT_NE(result, nullptr) << role;
      EXPECT_EQ(result->GetNumberOfComponents(), components);
    }
  }
}

/// A tetrahedron has as many points as cells.
TEST(InputArrays, DirectionsAreChosenByTheirAssociationEvenWhereTheirNumberTellsNothing)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->InsertNextPoint(0.0, 0.0, 0.0);
  points->InsertNextPoint(1.0, 0.0, 0.0);
  points->InsertNextPoint(0.0, 1.2, 0.0);
  points->InsertNextPoint(0.0, 0.0, 1.4);
  vtkNew<vtkCellArray> faces;
  faces->InsertNextCell({ 0, 2, 1 });
  faces->InsertNextCell({ 0, 1, 3 });
  faces->InsertNextCell({ 0, 3, 2 });
  faces->InsertNextCell({ 1, 2, 3 });
  vtkSmartPointer<vtkDataArray> results[2];
  for (const bool onCells : { false, true })
  {
    for (const bool both : { false, true })
    {
      vtkNew<vtkPolyData> tetrahedron;
      tetrahedron->SetPoints(points);
      tetrahedron->SetPolys(faces);
      AddPointArray(tetrahedron, "f", 1, [](vtkIdType i, int) { return i == 1 ? 1.0 : 0.0; });
      const auto directions = [](int axis)
      { return MakeArray(VTK_DOUBLE, "d", 4, 3, [=](vtkIdType, int k) { return k == axis; }); };
      if (both || !onCells)
      {
        tetrahedron->GetPointData()->AddArray(directions(0));
      }
      if (both || onCells)
      {
        tetrahedron->GetCellData()->AddArray(directions(1));
      }
      vtkNew<vtkFVMHeatFilter> filter;
      filter->SetInputData(tetrahedron);
      SetInputArray(filter, 0, "f");
      SetInputArray(filter, 2, "d", onCells);
      filter->SetAlongDiffusivity(20.0);
      filter->SetNumberOfTimeSteps(1);
      filter->SetTimeStep(0.1);
      filter->Update();
      ASSERT_NE(Result(filter), nullptr);
      if (both)
      {
        EXPECT_TRUE(Identical(Result(filter), results[onCells])) << onCells;
      }
      results[onCells] = Result(filter);
    }
  }
  EXPECT_GT(LargestDifference(results[0], results[1]), 0.01);
}
