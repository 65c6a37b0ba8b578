// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Filters used at random: arrays of any type and content, properties right and wrong, inputs and
// properties changed between updates, times asked for in any order. Whatever came before, a filter
// gives what a new one with the same settings gives, or the same error and the unchanged input.
// SURFACEDIFFUSION_LONG=n in the environment makes it the n-th of many times as many uses.

#include "AllFilters.h"
#include "BadMeshes.h"

#include "vtkCellArray.h"
#include "vtkVariant.h"

#include <cstdlib>
#include <random>

using namespace FilterTest;

namespace
{

class Dice
{
public:
  explicit Dice(unsigned int seed)
    : Random(seed)
  {
  }
  int Below(int limit) { return static_cast<int>(this->Random() % limit); }
  bool Flip(int oneIn = 2) { return this->Below(oneIn) == 0; }
  double Unit() { return this->Random() / 4294967296.0; }

private:
  std::mt19937 Random; // the same numbers everywhere
};

vtkSmartPointer<vtkPolyData> ThrowSurface(Dice& dice)
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

/// Arrays with the names that filters are told: of any type, sometimes with NaN, of wrong sizes.
void ThrowArrays(Dice& dice, vtkPolyData* surface)
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
  surface->GetPointData()->SetActiveScalars("f");
}

/// A property from what is allowed, seldom from what is not.
void ThrowProperty(Dice& dice, vtkSurfaceDiffusionAlgorithm* filter)
{
  const auto size = [&] { return dice.Flip(12) ? -1.0 : std::pow(10.0, 6.0 * dice.Unit() - 3.0); };
  switch (dice.Below(16))
  {
    case 0:
      return filter->SetTimeStep(size());
    case 1:
      return filter->SetNumberOfTimeSteps(dice.Below(7) - (dice.Flip(12) ? 7 : 0));
    case 2:
      return filter->SetUnits(dice.Below(2));
    case 3:
      return filter->SetGenerateTimeSteps(!dice.Flip(3));
    case 4:
      return filter->SetOutputInterval(1 + dice.Below(3));
    case 5:
      return filter->SetFidelityWeight(dice.Flip() ? 0.0 : size());
    case 6:
      return filter->SetMaskMode(dice.Below(2));
    case 7:
      return filter->SetInitialFill(dice.Below(3));
    case 8:
      return filter->SetHoldKnownValues(dice.Flip(3));
    case 9:
      return filter->SetAlongDiffusivity(size());
    case 10:
      return filter->SetTimeIntegrator(dice.Below(3));
    case 11:
      return filter->SetSolver(dice.Below(4));
    case 12:
      return filter->SetIntrinsicDelaunay(dice.Flip());
    case 13:
      return filter->SetMergeCoincidentPoints(dice.Flip());
    case 14:
      return filter->SetOutputPrecision(dice.Below(3));
    default:
      return filter->SetCheckpointMemoryLimit(dice.Below(2));
  }
}

void ThrowArrayChoice(Dice& dice, vtkSurfaceDiffusionAlgorithm* filter)
{
  const int index = dice.Below(4);
  const char* const names[] = { "f", "mask", "e1", "fixed" };
  SetInputArray(filter, index, dice.Flip(3) ? "" : names[index]);
}

vtkSmartPointer<vtkSurfaceDiffusionAlgorithm> ThrowFilter(Dice& dice)
{
  switch (dice.Below(4))
  {
    case 0:
      return vtkSmartPointer<vtkFVMHeatFilter>::New();
    case 1:
      return vtkSmartPointer<vtkIntrinsicTVFilter>::New();
    case 2:
      return vtkSmartPointer<vtkHarmonicMapFilter>::New();
    default:
      return vtkSmartPointer<vtkTuringTextureFilter>::New();
  }
}

/// A new filter with the same properties and arrays.
vtkSmartPointer<vtkSurfaceDiffusionAlgorithm> Twin(vtkSurfaceDiffusionAlgorithm* filter)
{
  auto twin = vtkSmartPointer<vtkSurfaceDiffusionAlgorithm>::Take(filter->NewInstance());
  twin->SetTimeStep(filter->GetTimeStep());
  twin->SetNumberOfTimeSteps(filter->GetNumberOfTimeSteps());
  twin->SetUnits(filter->GetUnits());
  twin->SetGenerateTimeSteps(filter->GetGenerateTimeSteps());
  twin->SetOutputInterval(filter->GetOutputInterval());
  twin->SetFidelityWeight(filter->GetFidelityWeight());
  twin->SetMaskMode(filter->GetMaskMode());
  twin->SetInitialFill(filter->GetInitialFill());
  twin->SetHoldKnownValues(filter->GetHoldKnownValues());
  twin->SetAlongDiffusivity(filter->GetAlongDiffusivity());
  twin->SetTimeIntegrator(filter->GetTimeIntegrator());
  twin->SetSolver(filter->GetSolver());
  twin->SetIntrinsicDelaunay(filter->GetIntrinsicDelaunay());
  twin->SetMergeCoincidentPoints(filter->GetMergeCoincidentPoints());
  twin->SetOutputPrecision(filter->GetOutputPrecision());
  twin->SetCheckpointMemoryLimit(filter->GetCheckpointMemoryLimit());
  for (int index = 0; index < 4; ++index)
  {
    vtkNew<vtkInformation> copy;
    copy->Copy(filter->GetInputArrayInformation(index), 1);
    twin->SetInputArrayToProcess(index, copy);
  }
  return twin;
}

/// The same bits, or both not a number.
bool SameValues(vtkDataArray* a, vtkDataArray* b)
{
  bool same = a && b && a->GetDataType() == b->GetDataType() &&
    a->GetNumberOfComponents() == b->GetNumberOfComponents() &&
    a->GetNumberOfTuples() == b->GetNumberOfTuples();
  for (vtkIdType i = 0; same && i < a->GetNumberOfValues(); ++i)
  {
    const double x = a->GetVariantValue(i).ToDouble();
    const double y = b->GetVariantValue(i).ToDouble();
    same = x == y || (std::isnan(x) && std::isnan(y));
  }
  return same;
}

bool SameArrays(vtkPolyData* a, vtkPolyData* b)
{
  bool same = a->GetPointData()->GetNumberOfArrays() == b->GetPointData()->GetNumberOfArrays();
  for (int i = 0; same && i < a->GetPointData()->GetNumberOfArrays(); ++i)
  {
    same = SameValues(a->GetPointData()->GetArray(i), b->GetPointData()->GetArray(i));
  }
  return same;
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

/// Whether what the filter has added is finite; points that no triangle uses keep even a NaN.
bool AddedIsFinite(vtkPolyData* output, vtkPolyData* input)
{
  vtkDataArray* given = input->GetPointData()->GetArray("f");
  bool finite = true;
  for (int a = 0; a < output->GetPointData()->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = output->GetPointData()->GetArray(a);
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      const bool isNew = !input->GetPointData()->HasArray(array->GetName());
      finite = finite && (!isNew || (given && !IsFinite(given, i)) || IsFinite(array, i));
    }
  }
  return finite;
}

void UseAtRandom(unsigned int seed)
{
  Dice dice(seed);
  auto filter = ThrowFilter(dice);
  Messages messages(filter);
  filter->SetNumberOfTimeSteps(3);
  vtkSmartPointer<vtkPolyData> surface = ThrowSurface(dice);
  ThrowArrays(dice, surface);
  for (int update = 0; update < 6; ++update)
  {
    for (int change = dice.Below(4); change > 0; --change)
    {
      ThrowProperty(dice, filter);
    }
    if (dice.Flip())
    {
      ThrowArrayChoice(dice, filter);
    }
    if (dice.Flip(4))
    {
      surface = ThrowSurface(dice);
      ThrowArrays(dice, surface);
    }
    else if (dice.Flip(4))
    {
      ThrowArrays(dice, surface);
    }
    const double time = 4.0 * dice.Unit() * std::abs(filter->GetTimeStep());
    auto twin = Twin(filter);
    Messages ofTwin(twin);
    messages.Errors.clear();
    for (vtkSurfaceDiffusionAlgorithm* either : { filter.Get(), twin.Get() })
    {
      either->SetInputData(surface);
      either->Modified(); // or an error is not told again where nothing has changed
      UpdateAt(either, time);
    }
    ASSERT_EQ(messages.Errors.empty(), ofTwin.Errors.empty())
      << (messages.Errors.empty() ? ofTwin.Errors[0] : messages.Errors[0]);
    ASSERT_TRUE(SameArrays(filter->GetOutput(), twin->GetOutput())) << filter->GetClassName();
    ASSERT_TRUE(!messages.Errors.empty() || AddedIsFinite(filter->GetOutput(), surface))
      << filter->GetClassName();
    ASSERT_TRUE(messages.Errors.empty() || IsUnchanged(filter, surface)) << messages.Errors[0];
  }
}

} // namespace

TEST(RandomUse, GivesWhatANewFilterGives)
{
  const char* const part = std::getenv("SURFACEDIFFUSION_LONG");
  const unsigned int uses = part ? 30000 : 300;
  const unsigned int first = part ? uses * (std::strtoul(part, nullptr, 10) - 1) : 0;
  for (unsigned int seed = first; seed < first + uses && !HasFatalFailure(); ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    UseAtRandom(seed);
  }
}
