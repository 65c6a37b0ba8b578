// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"
#include "vtkHarmonicMapFilter.h"
#include "vtkIdTypeArray.h"
#include "vtkPartitionedDataSet.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkSurfaceDirectionFieldFilter.h"
#include "vtkTuringTextureFilter.h"

#include <gtest/gtest.h>

#include <set>

using namespace FilterTest;

namespace
{

const std::vector<int> NumericTypes{ VTK_BIT, VTK_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR,
  VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_INT, VTK_UNSIGNED_INT, VTK_LONG, VTK_UNSIGNED_LONG,
  VTK_LONG_LONG, VTK_UNSIGNED_LONG_LONG, VTK_ID_TYPE, VTK_FLOAT, VTK_DOUBLE };

vtkSmartPointer<vtkFVMHeatFilter> MakeFilter(vtkPolyData* surface)
{
  auto filter = vtkSmartPointer<vtkFVMHeatFilter>::New();
  filter->SetInputData(surface);
  return filter;
}

bool InHole(vtkIdType i)
{
  return i % 10 > 5 && i % 10 < 9 && i / 10 > 3 && i / 10 < 7;
}

} // namespace

TEST(InputArrays, DataOfAnyNumericTypeGiveTheSameResult)
{
  auto plane = Grid(10, 10);
  const auto value = [](vtkIdType i, int) { return i % 3 == 0; };
  AddPointArray(plane, "f", 1, value);
  auto reference = MakeFilter(plane);
  SetInputArray(reference, 0, "f");
  reference->Update();
  for (const int type : NumericTypes)
  {
    AddPointArray(plane, "typed", 1, value, type);
    auto filter = MakeFilter(plane);
    SetInputArray(filter, 0, "typed");
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
  auto filter = MakeFilter(plane);
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
    auto reference = MakeFilter(plane);
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
      auto filter = MakeFilter(plane);
      SetInputArray(filter, 1, "typed");
      filter->SetMaskMode(mode);
      filter->SetFidelityWeight(1.0);
      filter->Update();
      EXPECT_TRUE(Identical(Result(filter), Result(reference))) << type;
    }
  }
}

TEST(InputArrays, FidelityIsMultipliedPointByPoint)
{
  auto plane = Grid(10, 10);
  AddRough(plane);
  AddPointArray(plane, "mask", 1, [](vtkIdType i, int) { return InHole(i); });
  AddPointArray(
    plane, "two", 1, [](vtkIdType, int) { return 2.0; }, VTK_INT);
  AddPointArray(
    plane, "known", 1, [](vtkIdType i, int) { return InHole(i) ? 0.0 : 1.0; }, VTK_FLOAT);
  const auto run = [&](const char* mask, const char* fidelity, double weight)
  {
    auto filter = MakeFilter(plane);
    SetInputArray(filter, 1, mask);
    SetInputArray(filter, 5, fidelity);
    filter->SetInitialFillToInput();
    filter->SetFidelityWeight(weight);
    filter->Update();
    return Copy(Result(filter));
  };
  const auto twice = run("", "", 2.0);
  EXPECT_TRUE(Identical(run("", "two", 1.0), twice));
  EXPECT_FALSE(Identical(run("", "", 1.0), twice));
  EXPECT_TRUE(Identical(run("", "known", 2.0), run("mask", "", 2.0)));
}

TEST(InputArrays, NaNInAnyComponentIsMissing)
{
  auto plane = Grid(10, 10);
  AddRough(plane, 2);
  AddPointArray(plane, "mask", 1, [](vtkIdType i, int) { return InHole(i); });
  AddPointArray(plane, "holed", 2,
    [](vtkIdType i, int k)
    { return InHole(i) && k == static_cast<int>(i % 2) ? std::nan("") : Rough(i, k); });
  for (const int fill :
    { vtkFVMHeatFilter::INITIAL_FILL_MEAN, vtkFVMHeatFilter::INITIAL_FILL_NOISE })
  {
    auto masked = MakeFilter(plane);
    SetInputArray(masked, 1, "mask");
    auto holed = MakeFilter(plane);
    SetInputArray(holed, 0, "holed");
    for (vtkFVMHeatFilter* filter : { masked.Get(), holed.Get() })
    {
      filter->SetInitialFill(fill);
      filter->SetFidelityWeight(1.0);
      filter->Update();
    }
    EXPECT_TRUE(Identical(Result(masked), Result(holed, "holedDiffused")));
  }
}

TEST(InputArrays, EveryInitialFillStartsFromItsDocumentedValues)
{
  auto plane = Grid(10, 10);
  AddPointArray(plane, "f", 1,
    [](vtkIdType i, int k) { return i == 67 ? std::nan("")
                               : InHole(i)  ? 50.0
                                            : Rough(i, k); });
  AddPointArray(plane, "mask", 1, [](vtkIdType i, int) { return InHole(i); });
  const std::vector<double> areas = ControlAreas(plane);
  double sum = 0.0;
  double area = 0.0;
  double low = 1.0;
  double high = -1.0;
  for (vtkIdType i = 0; i < 100; ++i)
  {
    if (!InHole(i))
    {
      sum += areas[i] * Rough(i, 0);
      area += areas[i];
      low = std::min(low, Rough(i, 0));
      high = std::max(high, Rough(i, 0));
    }
  }
  auto filter = MakeFilter(plane);
  SetInputArray(filter, 0, "f");
  SetInputArray(filter, 1, "mask");
  filter->SetNumberOfTimeSteps(0); // 0 steps: the initial state
  const auto at = [&](vtkIdType i) { return Result(filter)->GetComponent(i, 0); };

  filter->SetInitialFillToMean();
  filter->Update();
  EXPECT_NEAR(at(66), sum / area, 1e-14);
  EXPECT_NEAR(at(67), sum / area, 1e-14);
  EXPECT_EQ(at(0), Rough(0, 0));

  filter->SetInitialFillToInput();
  filter->Update();
  EXPECT_EQ(at(66), 50.0);
  EXPECT_NEAR(at(67), sum / area, 1e-14); // NaN falls back to the mean

  filter->SetInitialFillToNoise();
  filter->Update();
  const auto first = Copy(Result(filter));
  std::set<double> values;
  for (vtkIdType i = 0; i < 100; ++i)
  {
    if (InHole(i))
    {
      values.insert(at(i));
      EXPECT_GE(at(i), low);
      EXPECT_LE(at(i), high);
    }
    else
    {
      EXPECT_EQ(at(i), Rough(i, 0));
    }
  }
  EXPECT_EQ(values.size(), 9u); // all different
  filter->SetRandomSeed(1);
  filter->Update();
  EXPECT_GT(std::abs(at(66) - first->GetComponent(66, 0)), 1e-6);
  filter->SetRandomSeed(0);
  filter->Update();
  EXPECT_TRUE(Identical(first, Result(filter)));
}

TEST(InputArrays, MeanFillIsTheMeanOfTheConnectedComponent)
{
  auto plane = Grid(10, 10);
  vtkNew<vtkCellArray> halves; // disconnected between columns 4 and 5
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < plane->GetNumberOfCells(); ++c)
  {
    if (c / 2 % 9 != 4)
    {
      plane->GetCellPoints(c, corners);
      halves->InsertNextCell(corners);
    }
  }
  plane->SetPolys(halves);
  AddPointArray(plane, "f", 1,
    [](vtkIdType i, int) { return i == 11 || i == 18 ? std::nan("")
                             : i % 10 < 5            ? 2.0
                                                     : 8.0; });
  auto filter = MakeFilter(plane);
  SetInputArray(filter, 0, "f");
  filter->SetNumberOfTimeSteps(0);
  filter->Update();
  EXPECT_NEAR(Result(filter)->GetComponent(11, 0), 2.0, 1e-14);
  EXPECT_NEAR(Result(filter)->GetComponent(18, 0), 8.0, 1e-14);
}

TEST(InputArrays, NoiseDependsOnTheGlobalIds)
{
  auto plane = Grid(10, 10);
  AddPointArray(
    plane, "f", 2, [](vtkIdType i, int k) { return InHole(i) ? std::nan("") : Rough(i, k); });
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("ids");
  for (vtkIdType i = 0; i < 100; ++i)
  {
    ids->InsertNextValue(i == 66 ? 57 : i == 57 ? 66 : i); // two missing points exchange their ids
  }
  vtkNew<vtkIdTypeArray> indices;
  indices->SetName("indices");
  for (vtkIdType i = 0; i < 100; ++i)
  {
    indices->InsertNextValue(i);
  }
  plane->GetPointData()->SetGlobalIds(indices);
  auto filter = MakeFilter(plane);
  SetInputArray(filter, 0, "f");
  filter->SetNumberOfTimeSteps(0);
  filter->SetInitialFillToNoise();
  filter->Update();
  const auto byIndex = Copy(Result(filter));
  plane->GetPointData()->SetGlobalIds(ids);
  filter->Update();
  for (int k = 0; k < 2; ++k)
  {
    EXPECT_EQ(Result(filter)->GetComponent(66, k), byIndex->GetComponent(57, k));
    EXPECT_EQ(Result(filter)->GetComponent(57, k), byIndex->GetComponent(66, k));
    EXPECT_EQ(Result(filter)->GetComponent(67, k), byIndex->GetComponent(67, k));
  }
  EXPECT_NE(byIndex->GetComponent(66, 0), byIndex->GetComponent(66, 1));
}

TEST(InputArrays, FixedTakesPrecedenceOverMissing)
{
  auto plane = Grid(10, 10);
  AddRough(plane);
  AddPointArray(plane, "mask", 1, [](vtkIdType i, int) { return InHole(i); });
  AddPointArray(plane, "fixed", 1, [](vtkIdType i, int) { return i == 66; });
  auto filter = MakeFilter(plane);
  SetInputArray(filter, 1, "mask");
  SetInputArray(filter, 3, "fixed");
  filter->Update();
  EXPECT_EQ(Result(filter)->GetComponent(66, 0), Rough(66, 0));
  EXPECT_NE(Result(filter)->GetComponent(67, 0), Rough(67, 0));
}

TEST(InputArrays, NothingFlowsIntoOrOutOfAnExcludedRegion)
{
  auto plane = Grid(10, 10);
  vtkDataArray* f = AddRough(plane);
  // The two middle columns are excluded: two halves of four columns remain.
  const auto excluded = [](vtkIdType i) { return i % 10 == 4 || i % 10 == 5; };
  AddPointArray(plane, "mask", 1, [&](vtkIdType i, int) { return excluded(i); });
  auto filter = MakeFilter(plane);
  SetInputArray(filter, 1, "mask");
  filter->SetMaskModeToExclude();
  filter->SetUnitsToAbsolute();
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Warnings.empty());

  auto half = Grid(4, 10);
  AddPointArray(
    half, "f", 1, [&](vtkIdType i, int) { return f->GetComponent(10 * (i / 4) + i % 4, 0); });
  auto alone = MakeFilter(half);
  SetInputArray(alone, 0, "f");
  alone->SetUnitsToAbsolute();
  alone->Update();
  for (vtkIdType i = 0; i < 100; ++i)
  {
    if (excluded(i))
    {
      EXPECT_EQ(Result(filter)->GetComponent(i, 0), f->GetComponent(i, 0));
    }
    else if (i % 10 < 4)
    {
      EXPECT_NEAR(Result(filter)->GetComponent(i, 0),
        Result(alone)->GetComponent(4 * (i / 10) + i % 10, 0), 1e-12);
    }
  }
  // The total over the region is conserved, with the areas of its own triangles.
  const std::vector<double> areas = ControlAreas(half);
  EXPECT_NEAR(Total(areas, Result(alone)), Total(areas, half->GetPointData()->GetArray("f")),
    1e-12 * TotalMagnitude(areas, Result(alone)));
}

TEST(InputArrays, AMaskWithoutEffectIsOneWarning)
{
  auto plane = Grid(10, 10);
  AddRough(plane);
  AddPointArray(plane, "empty", 1, [](vtkIdType, int) { return 0.0; });
  AddPointArray(plane, "mask", 1, [](vtkIdType i, int) { return InHole(i); });
  auto filter = MakeFilter(plane);
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
    auto filter = MakeFilter(plane);
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
  auto filter = MakeFilter(plane);
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
  auto filter = MakeFilter(plane);
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

/// The other filters need no array at all.
TEST(InputArrays, AreNotNeededByTexturesHarmonicMapsAndDirectionFields)
{
  const auto sphere = Sphere(3);
  const auto run = [&](vtkPolyDataAlgorithm* filter)
  {
    filter->SetInputData(sphere);
    Messages messages(filter);
    filter->Update();
    EXPECT_TRUE(messages.Errors.empty() && messages.Warnings.empty()) << filter->GetClassName();
  };
  vtkNew<vtkTuringTextureFilter> texture;
  texture->SetNumberOfTimeSteps(3);
  texture->SetFeatureSize(2.0); // that the mesh resolves
  vtkNew<vtkHarmonicMapFilter> map;
  vtkNew<vtkSurfaceDirectionFieldFilter> field;
  field->SetMethodToSmooth(); // spheres have no direction of curvature
  run(texture);
  run(map);
  run(field);
  EXPECT_TRUE(AllFinite(Result(texture, "u1")));
  EXPECT_TRUE(AllFinite(Result(map, "NormalsHarmonic")));
  EXPECT_TRUE(AllFinite(field->GetOutput()->GetCellData()->GetArray("Direction")));
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

/// As for a surface in one piece: numpy edits an array, and the user marks the polydata only.
TEST(InputArrays, OfPiecesThatAreEditedInPlaceAreReadAgain)
{
  vtkNew<vtkPartitionedDataSet> partitions;
  for (unsigned int p = 0; p < 2; ++p)
  {
    auto part = Grid(4, 5);
    for (vtkIdType i = 0; i < 20; ++i)
    {
      const double* point = part->GetPoint(i);
      part->GetPoints()->SetPoint(i, point[0] + 3.0 * p, point[1], 0.0);
    }
    AddRough(part);
    partitions->SetPartition(p, part);
  }
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputDataObject(partitions);
  const auto resultAt = [&](unsigned int p)
  {
    filter->Update();
    return vtkPartitionedDataSet::SafeDownCast(filter->GetOutputDataObject(0))
      ->GetPartition(p)
      ->GetPointData()
      ->GetArray("fDiffused");
  };
  const auto before = Copy(resultAt(1));
  vtkDataSet* const second = partitions->GetPartition(1);
  second->GetPointData()->GetScalars()->SetComponent(10, 0, 7.0);
  second->vtkObject::Modified();
  partitions->vtkObject::Modified();
  EXPECT_FALSE(Identical(resultAt(1), before));
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
