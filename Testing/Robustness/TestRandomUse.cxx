// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Random use of the filters: arrays of any type and content, allowed and other values of every
// property, inputs and properties that change between updates, times requested in any order. After
// any such sequence a filter gives the same bits as a new one with the same settings, or the same
// errors and the unchanged input. A filter that keeps an old result although a property has changed
// fails here.
// SURFACEDIFFUSION_LONG=n in the environment selects the n-th of many sets of many more uses, and
// SURFACEDIFFUSION_SEED=n the use of that seed alone.

#include "BadMeshes.h"
#include "Twins.h"

#include "vtkCellArray.h"
#include "vtkInformation.h"

#include <cstdio>
#include <cstdlib>

using namespace FilterTest;

namespace
{

vtkSmartPointer<vtkPolyData> RandomSurface(Dice& dice)
{
  static const auto bad = SurfaceDiffusion::Testing::BadMeshes();
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  switch (dice.Below(3))
  {
    case 0:
      surface = Sphere(1 + dice.Below(2));
      break;
    case 1:
      surface = Grid(2 + dice.Below(6), 2 + dice.Below(6), 0.5 + dice.Unit());
      break;
    default:
    {
      const auto& shape = bad[dice.Below(static_cast<int>(bad.size()))].Shape;
      vtkNew<vtkPoints> points;
      points->SetDataType(dice.Flip() ? VTK_DOUBLE : VTK_FLOAT);
      for (const auto& v : shape.Vertices.rowwise())
      {
        points->InsertNextPoint(v.data());
      }
      vtkNew<vtkCellArray> cells;
      for (const auto& f : shape.Faces.rowwise())
      {
        cells->InsertNextCell({ f[0], f[1], f[2] });
      }
      surface->SetPoints(points);
      surface->SetPolys(cells);
    }
  }
  return surface;
}

/// Adds arrays of the names that SetRandomArray() chooses: of any type, sometimes with NaN or with
/// a wrong number of components.
void AddRandomArrays(Dice& dice, vtkPolyData* surface)
{
  const int types[] = { VTK_DOUBLE, VTK_FLOAT, VTK_UNSIGNED_CHAR, VTK_INT, VTK_SHORT };
  const auto add = [&](const char* name, int components, const auto& value)
  {
    if (!dice.Flip(8))
    {
      AddPointArray(
        surface, name, dice.Flip(16) ? components + 1 : components, value, types[dice.Below(5)]);
    }
  };
  const double size = dice.Flip(4) ? std::pow(10.0, dice.Below(300) - 150) : 100.0;
  const bool holes = dice.Flip(3);
  add("f", 1 + dice.Below(4),
    [&](vtkIdType i, int k)
    { return holes && dice.Flip(5) ? vtkMath::Nan() : std::abs(size * Rough(i, k)); });
  add("mask", 1, [&](vtkIdType, int) { return dice.Flip(6); });
  add("fixed", 1, [&](vtkIdType, int) { return dice.Flip(9); });
  add("e1", 3, [&](vtkIdType i, int k) { return dice.Flip(20) ? 0.0 : Rough(i, k); });
  add("rates", 4, [&](vtkIdType i, int k) { return 3.0 + Rough(i, k); });
  add("fidelity", 1, [&](vtkIdType i, int k) { return dice.Flip(9) ? 0.0 : 2.0 + Rough(i, k); });
  add("seeds", 1, [&](vtkIdType, int) { return dice.Flip(9) ? 1 + dice.Below(2) : 0; });
  add("terms", 2 + dice.Below(2), [&](vtkIdType i, int k) { return size * Rough(i, k); });
  const auto addToCells = [&](const char* name, int components, const auto& value)
  {
    if (!dice.Flip(8))
    {
      surface->GetCellData()->AddArray(
        MakeArray(types[dice.Below(5)], name, surface->GetNumberOfCells(), components, value));
    }
  };
  addToCells("f", 1 + dice.Below(4),
    [&](vtkIdType i, int k)
    { return holes && dice.Flip(5) ? vtkMath::Nan() : std::abs(size * Rough(i, k)); });
  addToCells("mask", 1, [&](vtkIdType, int) { return dice.Flip(6); });
  addToCells("fixed", 1, [&](vtkIdType, int) { return dice.Flip(9); });
  addToCells("e1", 3, [&](vtkIdType i, int k) { return dice.Flip(20) ? 0.0 : Rough(i, k); });
  addToCells("rates", 4, [&](vtkIdType i, int k) { return 3.0 + Rough(i, k); });
  addToCells(
    "fidelity", 1, [&](vtkIdType i, int k) { return dice.Flip(9) ? 0.0 : 2.0 + Rough(i, k); });
  addToCells("seeds", 1, [&](vtkIdType, int) { return dice.Flip(9) ? 1 + dice.Below(2) : 0; });
  surface->GetPointData()->SetActiveScalars("f");
}

/// Per index of an input array.
const char* const ArrayNames[] = { "f", "mask", "e1", "fixed", "rates", "fidelity", "seeds",
  "terms" };
constexpr int NumberOfArrays = 8;
/// Those of distances, at 8 and 9: speeds and start times.
const char* const ArraysOfDistances[] = { "fidelity", "fixed" };
constexpr int Rates = 4; ///< which are on cells
constexpr int Terms = 7; ///< which may be those of index 0

void SetRandomArray(Dice& dice, vtkPolyDataAlgorithm* filter)
{
  if (filter->IsA("vtkSurfaceDistanceFilter") && dice.Flip(4))
  {
    const int which = dice.Below(2);
    const char* const name = dice.Flip(3) ? "" : ArraysOfDistances[which];
    SetInputArray(filter, 8 + which, name, which == 0 && dice.Flip());
    return;
  }
  if (filter->IsA("vtkSurfaceDerivativesFilter") && dice.Flip(4))
  {
    SetInputArray(filter, 10, dice.Flip(3) ? "" : "fidelity"); // errors of slopes
    return;
  }
  const int index = dice.Below(NumberOfArrays);
  const char* const name = ArrayNames[index == Terms && dice.Flip() ? 0 : index];
  const bool onCells = index == Rates ? !dice.Flip(8) : dice.Flip(3);
  SetInputArray(filter, index, dice.Flip(3) ? "" : name, onCells);
}

/// Changes one value of an array or one coordinate and marks nothing as modified, as numpy does.
void EditInPlace(Dice& dice, vtkPolyData* surface)
{
  const char* const name = ArrayNames[dice.Below(NumberOfArrays)];
  vtkDataArray* array = surface->GetPoints()->GetData();
  if (!dice.Flip(4))
  {
    vtkDataSetAttributes* const ofCells = surface->GetCellData();
    array = (dice.Flip() ? surface->GetPointData() : ofCells)->GetArray(name);
  }
  if (array && array->GetNumberOfTuples() > 0)
  {
    const int tuple = dice.Below(static_cast<int>(array->GetNumberOfTuples()));
    const int component = dice.Below(array->GetNumberOfComponents());
    const double before = array->GetComponent(tuple, component);
    array->SetComponent(tuple, component, before == 0.0 ? 1.0 : 0.0);
  }
}

bool IsFinite(vtkDataArray* array, vtkIdType point)
{
  bool finite = true;
  for (int k = 0; k < array->GetNumberOfComponents(); ++k)
  {
    finite = finite && std::isfinite(array->GetComponent(point, k));
  }
  return finite;
}

/// Whether fronts meet or begin at a point or cell, in one component at least: their speed is missing there.
bool FrontTurns(vtkDataSetAttributes* arrays, const std::string& speed, vtkIdType i)
{
  const std::string base = speed.substr(0, speed.find("Speed"));
  bool found = false;
  for (const char* const suffix : { "Collision", "Focus" })
  {
    vtkDataArray* const turns = arrays->GetArray((base + suffix).c_str());
    for (int c = 0; turns && c < turns->GetNumberOfComponents(); ++c)
    {
      found = found || turns->GetComponent(i, c) != 0.0;
    }
  }
  return found;
}

/// Whether the added arrays are finite; unused points keep their value, even NaN, derivatives are
/// missing beside missing data and Laplacians at boundaries that do not determine them, and distances
/// are infinite where no source is near.
bool AddedIsFinite(vtkPolyDataAlgorithm* filter, vtkPolyData* input)
{
  vtkPolyData* const output = filter->GetOutput();
  bool spreads = false;
  if (auto* const derivatives = vtkSurfaceDerivativesFilter::SafeDownCast(filter))
  {
    spreads = derivatives->GetQuantity() == vtkSurfaceDerivativesFilter::QUANTITY_LAPLACIAN;
    vtkInformation* const chosen = filter->GetInputArrayInformation(0);
    const char* const name = chosen->Get(vtkDataObject::FIELD_NAME());
    vtkDataSetAttributes* arrays = input->GetCellData();
    if (chosen->Get(vtkDataObject::FIELD_ASSOCIATION()) != vtkDataObject::FIELD_ASSOCIATION_CELLS)
    {
      arrays = input->GetPointData();
    }
    vtkDataArray* const data = name && *name ? arrays->GetArray(name) : arrays->GetScalars();
    for (vtkIdType i = 0; data && i < data->GetNumberOfTuples(); ++i)
    {
      spreads = spreads || !IsFinite(data, i);
    }
  }
  const bool isDistance = filter->IsA("vtkSurfaceDistanceFilter") != 0;
  const bool hasErrors = filter->IsA("vtkSurfaceInterpolationFilter") != 0;
  const bool isField = filter->IsA("vtkSurfaceRandomFieldFilter") != 0;
  const auto isMissing = [&](vtkDataArray* given, vtkIdType i)
  { return spreads || (given && !IsFinite(given, i)); };
  bool finite = true;
  const auto check = [&](vtkDataSetAttributes* added, vtkDataSetAttributes* before)
  {
    vtkDataArray* const given = added->GetArray("f"); // of the refined surface
    for (int a = 0; a < added->GetNumberOfArrays(); ++a)
    {
      vtkDataArray* const array = added->GetArray(a);
      const std::string name = array->GetName();
      // Bounds are as unknown as the errors, and infinite where waves may be everywhere at once.
      if (name.find("SpeedLower") != std::string::npos ||
        name.find("SpeedUpper") != std::string::npos)
      {
        continue;
      }
      // Where no value counts there is nothing to compare, and values that hold have no slopes with an error.
      if (hasErrors &&
        (name.find("Residuals") != std::string::npos ||
          name.find("LeaveOneOut") != std::string::npos ||
          name.find("SlopeError") != std::string::npos))
      {
        continue;
      }
      for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
      {
        const bool isNew = !before->HasArray(array->GetName());
        const bool turns = name.find("Speed") != std::string::npos && FrontTurns(added, name, i);
        const bool mayBeInfinite = isDistance && array == added->GetScalars();
        // Points that no triangle uses keep their values, and have no standard error.
        const bool keepsValue = hasErrors && given && added->GetScalars() &&
          added->GetScalars()->GetComponent(i, 0) == given->GetComponent(i, 0);
        finite = finite &&
          (!isNew || IsFinite(array, i) || isMissing(given, i) || keepsValue || turns ||
            (mayBeInfinite && array->GetComponent(i, 0) > 0.0) ||
            (isField && std::isnan(array->GetComponent(i, 0)))); // no triangle has the point
      }
    }
  };
  check(output->GetPointData(), input->GetPointData());
  check(output->GetCellData(), input->GetCellData());
  return finite;
}

/// Of the uses of one class.
struct Uses
{
  int Updates = 0;
  int Results = 0; ///< updates without an error, which add an array or move points
};

/// Updates a filter of one class many times.
void UseAtRandom(
  const std::vector<FilterClass>& classes, unsigned int seed, std::vector<Uses>& uses)
{
  Dice dice(seed);
  const FilterClass& kind = classes[seed % classes.size()];
  const auto filter = kind.Make();
  const auto untouched = kind.Make();
  for (vtkPolyDataAlgorithm* either : { filter.Get(), untouched.Get() })
  {
    // Refinement makes millions of triangles otherwise.
    vtkSurfaceFilter::SafeDownCast(either)->SetMaximumNumberOfTriangles(20000);
    if (auto* const relief = vtkSurfaceReliefFilter::SafeDownCast(either))
    {
      // The default height is larger than these surfaces, and relief takes one component.
      relief->SetHeight(0.02);
      SetInputArray(relief, 0, "fidelity");
    }
    if (auto* const distance = vtkSurfaceDistanceFilter::SafeDownCast(either))
    {
      distance->SetMethodToEikonal(); // which takes all other settings
      SetInputArray(distance, 0, "seeds");
      SetInputArray(distance, 2, "e1");
    }
  }
  Messages messages(filter);
  vtkSmartPointer<vtkPolyData> surface = RandomSurface(dice);
  AddRandomArrays(dice, surface);
  std::vector<std::string> lastErrors;
  vtkSmartPointer<vtkPolyData> lastSurface;
  vtkMTimeType lastChange = 0;
  for (int update = 0; update < 6; ++update)
  {
    for (int change = dice.Below(4); change > 0; --change)
    {
      kind.Properties[dice.Below(static_cast<int>(kind.Properties.size()))].Set(filter, dice);
    }
    if (dice.Flip())
    {
      SetRandomArray(dice, filter);
    }
    if (dice.Flip(4))
    {
      surface = RandomSurface(dice);
      AddRandomArrays(dice, surface);
    }
    else if (dice.Flip(4))
    {
      AddRandomArrays(dice, surface);
    }
    else if (dice.Flip(3))
    {
      EditInPlace(dice, surface);
      filter->Modified();
    }
    messages.Errors.clear();
    const bool isTheSame = surface == lastSurface && filter->vtkAlgorithm::GetMTime() == lastChange;
    const auto twin = Twin(kind, filter);
    Messages ofTwin(twin);
    const double time = dice.Logarithmic(1e-2, 1e2);
    for (vtkPolyDataAlgorithm* either : { filter.Get(), twin.Get() })
    {
      either->SetInputData(surface);
      UpdateAt(either, time);
    }
    std::string name = kind.Name + ", update " + std::to_string(update);
    if (std::getenv("SURFACEDIFFUSION_SEED"))
    {
      std::ostringstream properties;
      filter->Print(properties);
      name += "\n" + properties.str();
    }
    // A failed update is reported once, until something changes.
    const bool isReported = isTheSame && !lastErrors.empty() && messages.Errors.empty();
    ASSERT_EQ(isReported ? lastErrors : Sentences(messages), Sentences(ofTwin)) << name;
    lastErrors = Sentences(ofTwin);
    const bool failed = !lastErrors.empty();
    lastSurface = surface;
    lastChange = filter->vtkAlgorithm::GetMTime();
    ASSERT_EQ(Difference(filter, twin), "") << name;
    ASSERT_TRUE(failed || AddedIsFinite(filter, surface)) << name;
    ASSERT_TRUE(!failed || IsUnchanged(filter, surface)) << lastErrors[0];
    ++uses[seed % classes.size()].Updates;
    uses[seed % classes.size()].Results += !failed && !IsUnchanged(filter, surface);
    // After an error about half of the properties and arrays return to their defaults, to make results
    // likely.
    for (const RandomProperty& property : kind.Properties)
    {
      if (failed && dice.Flip())
      {
        property.Copy(untouched, filter);
      }
    }
    for (int index = 0; index < NumberOfArrays; ++index)
    {
      if (failed && dice.Flip())
      {
        CopyInputArray(untouched, filter, index);
      }
    }
  }
}

} // namespace

TEST(RandomUse, GivesWhatANewFilterGives)
{
  const auto classes = AllFilterClasses();
  const char* const part = std::getenv("SURFACEDIFFUSION_LONG");
  const char* const only = std::getenv("SURFACEDIFFUSION_SEED");
  const unsigned int uses = only ? 1 : part ? 30000 : 150;
  const unsigned int first = only ? std::strtoul(only, nullptr, 10)
    : part                        ? uses * (std::strtoul(part, nullptr, 10) - 1)
                                  : 0;
  std::vector<Uses> found(classes.size());
  for (unsigned int seed = first; seed < first + uses && !HasFatalFailure(); ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    UseAtRandom(classes, seed, found);
  }
  // A comparison of errors alone would hold nothing.
  for (std::size_t c = 0; c < classes.size() && !only; ++c)
  {
    std::printf("%-32s %5d results of %5d updates\n", classes[c].Name.c_str(), found[c].Results,
      found[c].Updates);
    EXPECT_GE(5 * found[c].Results, 2 * found[c].Updates) << classes[c].Name;
  }
}
