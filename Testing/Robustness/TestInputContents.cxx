// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Results belong to the contents of the inputs at the time of the update, not to what was marked as
// modified: arrays and points that numpy has edited in place, and one array of many.

#include "AllFilters.h"

#include "vtkPartitionedDataSet.h"

#include <map>
#include <tuple>

using namespace FilterTest;

namespace
{

class InputContents : public testing::TestWithParam<FilterKind>
{
protected:
  InputContents()
  {
    AddRough(this->Surface);
    AddArraysOfAllFilters(this->Surface);
    this->Filter = this->GetParam().Make();
    this->Filter->SetInputData(this->Surface);
    this->Filter->Update();
    this->First = Copy(this->Result());
  }

  vtkDataArray* Result() { return ResultOf(this->Filter, this->GetParam().Result); }

  vtkSmartPointer<vtkDataArray> FreshResult()
  {
    const auto fresh = this->GetParam().Make();
    fresh->SetInputData(this->Surface);
    fresh->Update();
    return ResultOf(fresh, this->GetParam().Result);
  }

  /// Exchanges two values of each array, in place and unmarked.
  void Edit()
  {
    vtkPointData* const data = this->Surface->GetPointData();
    for (vtkDataArray* array : { data->GetArray("f"), data->GetArray("rgb"), data->GetArray("e1"),
           this->Surface->GetCellData()->GetArray("c") })
    {
      const double other = array->GetComponent(41, 0);
      array->SetComponent(41, 0, array->GetComponent(40, 0));
      array->SetComponent(40, 0, other);
    }
  }
  void Stretch(double factor)
  {
    vtkDataArray* const points = this->Surface->GetPoints()->GetData();
    for (vtkIdType i = 0; i < points->GetNumberOfTuples(); ++i)
    {
      points->SetComponent(i, 2, factor * points->GetComponent(i, 2));
    }
  }

  vtkSmartPointer<vtkPolyData> Surface = Sphere(this->GetParam().Levels(4));
  vtkSmartPointer<vtkPolyDataAlgorithm> Filter;
  vtkSmartPointer<vtkDataArray> First;
};

} // namespace

TEST_P(InputContents, AreReadAfterEditsInPlaceAndModifiedOfTheFilter)
{
  this->Edit();
  this->Filter->Modified();
  this->Filter->Update();
  EXPECT_TRUE(Identical(this->Result(), this->FreshResult()));
  this->Edit();
  this->Filter->Modified();
  this->Filter->Update();
  EXPECT_TRUE(Identical(this->Result(), this->First));
}

TEST_P(InputContents, OfAnEditThatWasReadWithAChangedPropertyAreNotThoseBefore)
{
  this->Edit();
  auto* const filter = vtkSurfaceFilter::SafeDownCast(this->Filter);
  filter->SetMergeCoincidentPoints(true); // nothing coincides
  this->Filter->Update();
  EXPECT_TRUE(Identical(this->Result(), this->FreshResult()));
  this->Edit();
  this->Surface->GetPointData()->GetArray("f")->Modified();
  this->Surface->Modified();
  this->Filter->Update();
  EXPECT_TRUE(Identical(this->Result(), this->First));
}

TEST_P(InputContents, IncludePointsThatWereMovedInPlaceAndTriangles)
{
  this->Stretch(2.0);
  this->Filter->Modified();
  this->Filter->Update();
  EXPECT_TRUE(Identical(this->Result(), this->FreshResult()));
  this->Surface->GetPolys()->ReplaceCellAtId(3, { vtkIdType(0), vtkIdType(1), vtkIdType(2) });
  this->Surface->vtkObject::Modified();
  this->Filter->Update();
  EXPECT_TRUE(Identical(this->Result(), this->FreshResult()));
}

INSTANTIATE_TEST_SUITE_P(Inputs, InputContents, testing::ValuesIn(AllFilters()), KindName);

TEST(InputContents, OfPiecesAreReadAfterEditsInPlace)
{
  vtkNew<vtkPartitionedDataSet> pieces;
  for (unsigned int p = 0; p < 2; ++p)
  {
    const auto half = Grid(12, 12);
    for (vtkIdType i = 0; i < half->GetNumberOfPoints(); ++i)
    {
      double x[3];
      half->GetPoint(i, x);
      half->GetPoints()->SetPoint(i, x[0] + 11.0 * p, x[1], x[2]);
    }
    AddRough(half);
    pieces->SetPartition(p, half);
  }
  const auto resultOf = [](vtkAlgorithm* filter)
  {
    return vtkPolyData::SafeDownCast(
      vtkPartitionedDataSet::SafeDownCast(filter->GetOutputDataObject(0))->GetPartition(1))
      ->GetPointData()
      ->GetArray("fDiffused");
  };
  vtkNew<vtkFVMHeatFilter> kept;
  kept->SetInputData(pieces);
  kept->Update();
  const auto before = Copy(resultOf(kept));
  vtkPolyData* const piece = vtkPolyData::SafeDownCast(pieces->GetPartition(1));
  for (vtkDataArray* edited :
    { piece->GetPointData()->GetArray("f"), piece->GetPoints()->GetData() })
  {
    edited->SetComponent(50, 0, edited->GetComponent(50, 0) + 0.3);
    kept->Modified();
    kept->Update();
    vtkNew<vtkFVMHeatFilter> fresh;
    fresh->SetInputData(pieces);
    fresh->Update();
    EXPECT_TRUE(Identical(resultOf(kept), resultOf(fresh)));
    EXPECT_FALSE(Identical(resultOf(kept), before));
  }
}

namespace
{

/// Reverses one array of a kept filter and compares with a new filter.
void ExpectReadAlone(const std::function<vtkSmartPointer<vtkPolyDataAlgorithm>()>& make,
  vtkPolyData* surface, vtkDataArray* array, const char* result)
{
  const auto kept = make();
  kept->SetInputData(surface);
  kept->Update();
  ASSERT_NE(ResultOf(kept, result), nullptr);
  const auto before = Copy(ResultOf(kept, result));
  for (vtkIdType i = 0; i < array->GetNumberOfTuples() / 2; ++i)
  {
    for (int k = 0; k < array->GetNumberOfComponents(); ++k)
    {
      const double other = array->GetComponent(array->GetNumberOfTuples() - 1 - i, k);
      array->SetComponent(array->GetNumberOfTuples() - 1 - i, k, array->GetComponent(i, k));
      array->SetComponent(i, k, other);
    }
  }
  surface->vtkObject::Modified(); // not the array, as scripts with numpy do
  kept->Update();
  const auto fresh = make();
  fresh->SetInputData(surface);
  fresh->Update();
  EXPECT_TRUE(Identical(ResultOf(kept, result), ResultOf(fresh, result))) << array->GetName();
  EXPECT_FALSE(Identical(ResultOf(kept, result), before)) << array->GetName();
}

/// A hemisphere at 1, another at 0, and noise.
vtkSmartPointer<vtkPolyData> TwoRegions()
{
  const auto surface = Sphere(3);
  AddPointArray(surface, "f", 1,
    [&](vtkIdType i, int k) { return (surface->GetPoint(i)[2] > 0.1) + 0.3 * Rough(i, k); });
  surface->GetPointData()->SetActiveScalars("f");
  return surface;
}

} // namespace

TEST(InputContents, OfEachArrayAloneAreReadAgain)
{
  using Change = std::function<void(vtkFVMHeatFilter*)>;
  const auto some = [](vtkIdType i, int) { return i < 40; };
  const auto surface = TwoRegions();
  AddPointArray(surface, "mask", 1, some);
  AddPointArray(surface, "fixed", 1, some);
  AddPointArray(surface, "e1", 3, [](vtkIdType i, int k) { return k + 0.9 * Rough(i, k); });
  AddPointArray(surface, "fidelity", 1, [](vtkIdType i, int k) { return 2.0 + 1.9 * Rough(i, k); });
  const std::tuple<int, const char*, Change> cases[] = {
    { 0, "f", [](auto*) {} },
    { 1, "mask", [](auto* f) { f->SetMaskModeToInpaint(); } },
    { 1, "mask", [](auto* f) { f->SetMaskModeToExclude(); } },
    { 2, "e1", [](auto* f) { f->SetAcrossDiffusivity(0.1); } },
    { 3, "fixed", [](auto*) {} },
    { 5, "fidelity", [](auto* f) { f->SetFidelityWeight(0.5); } },
  };
  for (const auto& [index, name, change] : cases)
  {
    ExpectReadAlone(
      [index = index, name = name, change = change]
      {
        auto filter = vtkSmartPointer<vtkFVMHeatFilter>::New();
        SetInputArray(filter, index, name);
        change(filter);
        return filter;
      },
      surface, surface->GetPointData()->GetArray(name), "fDiffused");
  }
}

/// The noise of a texture belongs to the ids.
TEST(InputContents, OfGlobalIdsAloneAreReadAgain)
{
  const auto surface = Sphere(3);
  vtkDataArray* const ids = AddPointArray(
    surface, "ids", 1, [](vtkIdType i, int) { return i; }, VTK_ID_TYPE);
  surface->GetPointData()->SetActiveAttribute("ids", vtkDataSetAttributes::GLOBALIDS);
  ExpectReadAlone(
    []
    {
      auto filter = vtkSmartPointer<vtkTuringTextureFilter>::New();
      filter->SetNumberOfTimeSteps(2);
      return filter;
    },
    surface, ids, "u1");
}

/// There are as many points as cells, and the arrays of both have the same contents.
TEST(InputContents, OfCellsInPlaceOfPointsAreReadAgain)
{
  const auto surface = Sphere(3);
  while (surface->GetNumberOfPoints() < surface->GetNumberOfCells())
  {
    surface->GetPoints()->InsertNextPoint(0.0, 0.0, 0.0); // unused
  }
  ASSERT_EQ(surface->GetNumberOfPoints(), surface->GetNumberOfCells());
  AddRough(surface);
  const std::map<int, const char*> names = { { 1, "mask" }, { 3, "fixed" }, { 5, "fidelity" } };
  const auto value = [](vtkIdType i, int) { return i < 40; };
  for (const auto& [index, name] : names)
  {
    AddPointArray(surface, name, 1, value);
    surface->GetCellData()->AddArray(
      MakeArray(VTK_DOUBLE, name, surface->GetNumberOfCells(), 1, value));
    vtkNew<vtkFVMHeatFilter> kept;
    kept->SetFidelityWeight(0.5);
    kept->SetInputData(surface);
    SetInputArray(kept, index, name);
    kept->Update();
    const auto before = Copy(ResultOf(kept, "fDiffused"));
    SetInputArray(kept, index, name, true);
    kept->Update();
    vtkNew<vtkFVMHeatFilter> fresh;
    fresh->SetFidelityWeight(0.5);
    fresh->SetInputData(surface);
    SetInputArray(fresh, index, name, true);
    fresh->Update();
    EXPECT_TRUE(Identical(ResultOf(kept, "fDiffused"), ResultOf(fresh, "fDiffused"))) << name;
    EXPECT_FALSE(Identical(ResultOf(kept, "fDiffused"), before)) << name;
  }
}

TEST(InputContents, OfSeedsAloneAreReadAgain)
{
  const auto surface = TwoRegions();
  vtkDataArray* const seeds = AddPointArray(
    surface, "seeds", 1, [&](vtkIdType i, int) { return i < 9 ? 1 : (i < 30 ? 2 : 0); }, VTK_INT);
  ExpectReadAlone(
    []
    {
      auto filter = vtkSmartPointer<vtkSurfaceSegmentationFilter>::New();
      SetInputArray(filter, 6, "seeds");
      return filter;
    },
    surface, seeds, "RegionProbability");
}

TEST(InputContents, OfDataTermsAloneAreReadAgain)
{
  const auto surface = TwoRegions();
  vtkDataArray* const terms = AddPointArray(surface, "terms", 2, Rough);
  ExpectReadAlone(
    []
    {
      auto filter = vtkSmartPointer<vtkSurfaceSegmentationFilter>::New();
      filter->AutomaticFidelityOff();
      SetInputArray(filter, 7, "terms");
      return filter;
    },
    surface, terms, "RegionProbability");
}

TEST(InputContents, OfRatesAloneAreReadAgain)
{
  const auto surface = Sphere(3);
  const double rates[] = { 21.0, 21.0, 2.6, 2.6 };
  surface->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "rates", surface->GetNumberOfCells(), 4,
    [&](vtkIdType i, int k) { return rates[k] * (1.0 + 0.3 * Rough(i, 0)); }));
  ExpectReadAlone(
    []
    {
      auto filter = vtkSmartPointer<vtkTuringTextureFilter>::New();
      filter->SetNumberOfTimeSteps(10);
      SetInputArray(filter, 4, "rates", true);
      return filter;
    },
    surface, surface->GetCellData()->GetArray("rates"), "u1");
}

TEST(InputContents, OfTheDataChosenAsDataTermsAreDataTerms)
{
  const auto surface = TwoRegions();
  AddPointArray(surface, "two", 2, [&](vtkIdType i, int k) { return Rough(i, k); });
  const auto make = []
  {
    vtkNew<vtkSurfaceSegmentationFilter> filter;
    filter->AutomaticFidelityOff();
    return vtkSmartPointer<vtkSurfaceSegmentationFilter>(filter);
  };
  const auto kept = make();
  kept->SetInputData(surface);
  SetInputArray(kept, 0, "two");
  kept->Update();
  for (const char* terms : { "two", "", "two" })
  {
    const auto before = Copy(ResultOf(kept, "RegionProbability"));
    SetInputArray(kept, 7, terms);
    kept->Update();
    const auto fresh = make();
    fresh->SetInputData(surface);
    SetInputArray(fresh, 0, "two");
    SetInputArray(fresh, 7, terms);
    fresh->Update();
    EXPECT_TRUE(
      Identical(ResultOf(kept, "RegionProbability"), ResultOf(fresh, "RegionProbability")));
    EXPECT_FALSE(Identical(ResultOf(kept, "RegionProbability"), before));
  }
}
