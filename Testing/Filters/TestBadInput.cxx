// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkCellData.h"
#include "vtkFVMHeatFilter.h"
#include "vtkStringArray.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

using namespace FilterTest;

namespace
{

const double NaN = std::numeric_limits<double>::quiet_NaN();
const double Infinity = std::numeric_limits<double>::infinity();

vtkSmartPointer<vtkPolyData> GoodInput()
{
  auto plane = Grid(6, 6);
  AddRough(plane);
  return plane;
}

using Change = std::function<void(vtkFVMHeatFilter*, vtkPolyData*)>;

/**
 * Expects one error that has all of `words` in it and an output that is the unchanged input; then
 * that the same filter works on good input.
 */
void ExpectError(const std::vector<std::string>& words, const Change& change)
{
  SCOPED_TRACE(words.front());
  auto input = GoodInput();
  vtkNew<vtkFVMHeatFilter> filter;
  change(filter, input);
  filter->SetInputData(input);
  const int arrays = input->GetPointData()->GetNumberOfArrays();
  {
    Messages messages(filter);
    filter->Update();
    EXPECT_EQ(messages.Errors.size(), 1u);
    for (const std::string& word : words)
    {
      if (!messages.Errors.empty())
      {
        EXPECT_NE(messages.Errors[0].find(word), std::string::npos)
          << word << " is not in: " << messages.Errors[0];
      }
    }
    vtkPolyData* output = filter->GetOutput();
    EXPECT_EQ(output->GetPoints(), input->GetPoints());
    EXPECT_EQ(output->GetNumberOfCells(), input->GetNumberOfCells());
    EXPECT_EQ(output->GetPointData()->GetNumberOfArrays(), arrays);
    EXPECT_EQ(output->GetPointData()->GetScalars(), input->GetPointData()->GetScalars());
    EXPECT_EQ(History(filter)->GetNumberOfRows(), 0);
  }
  // The same filter, with all of its state, after the error is corrected.
  vtkNew<vtkFVMHeatFilter> fresh;
  filter->SetTimeStep(fresh->GetTimeStep());
  filter->SetNumberOfTimeSteps(fresh->GetNumberOfTimeSteps());
  filter->SetGenerateTimeSteps(false);
  filter->SetOutputInterval(1);
  filter->SetFidelityWeight(0.0);
  filter->SetAlongDiffusivity(1.0);
  filter->SetAcrossDiffusivity(1.0);
  filter->SetTolerance(fresh->GetTolerance());
  filter->SetMaximumNumberOfIterations(1000);
  filter->SetMergeTolerance(0.0);
  filter->SetCheckpointMemoryLimit(512);
  filter->SetHoldKnownValues(false);
  filter->SetUnitsToNatural();
  filter->SetMaskModeToInpaint();
  filter->SetInitialFillToMean();
  filter->SetSolverToAutomatic();
  filter->SetOutputPrecisionToInput();
  filter->SetTimeIntegratorToSecondOrder();
  filter->SetModeToTimeSteps();
  filter->SetFWHM(0.0);
  filter->SetAutomaticFidelity(false);
  filter->SetNoiseLevel(0.0);
  for (int index = 0; index < 6; ++index)
  {
    SetInputArray(filter, index, index == 0 ? "f" : "");
  }
  auto good = GoodInput();
  filter->SetInputData(good);
  Messages messages(filter);
  filter->Update();
  EXPECT_TRUE(messages.Errors.empty());
  fresh->SetInputData(good);
  fresh->Update();
  EXPECT_TRUE(Identical(Result(filter), Result(fresh)));
}

template <typename Value>
void ExpectPropertyError(const char* property, void (vtkFVMHeatFilter::*set)(Value),
  const std::vector<std::pair<Value, const char*>>& bad)
{
  for (const auto& [value, text] : bad)
  {
    ExpectError({ std::string(property) + " is " + text, "allowed: " },
      [&, v = value](vtkFVMHeatFilter* filter, vtkPolyData*) { (filter->*set)(v); });
  }
}

} // namespace

TEST(BadInput, ArraysThatCannotBeUsedAreErrors)
{
  ExpectError({ "InputArray", "\"nosuch\"" },
    [](vtkFVMHeatFilter* filter, vtkPolyData*) { SetInputArray(filter, 0, "nosuch"); });
  ExpectError({ "InputArray", "not set" },
    [](vtkFVMHeatFilter*, vtkPolyData* input)
    { input->GetPointData()->SetActiveScalars(nullptr); });
  ExpectError({ "InputArray", "\"f\"", "cell arrays", "association 0" },
    [](vtkFVMHeatFilter* filter, vtkPolyData*) { SetInputArray(filter, 0, "f", true); });
  ExpectError({ "InputArray", "\"names\"", "vtkStringArray", "numeric" },
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      vtkNew<vtkStringArray> names;
      names->SetName("names");
      names->SetNumberOfValues(36);
      input->GetPointData()->AddArray(names);
      SetInputArray(filter, 0, "names");
    });
  ExpectError({ "InputArray", "\"short\"", "35", "36" },
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      input->GetPointData()->AddArray(MakeArray(VTK_DOUBLE, "short", 35, 1, Rough));
      SetInputArray(filter, 0, "short");
    });
  ExpectError({ "MaskArray", "\"nosuch\"" },
    [](vtkFVMHeatFilter* filter, vtkPolyData*) { SetInputArray(filter, 1, "nosuch"); });
  ExpectError({ "MaskArray", "\"mask\"", "2 components", "1" },
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      AddPointArray(input, "mask", 2, Rough);
      SetInputArray(filter, 1, "mask");
    });
  ExpectError({ "MaskArray", "\"mask\"", "36", "50" },
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      input->GetCellData()->AddArray(MakeArray(VTK_INT, "mask", 36, 1, Rough));
      SetInputArray(filter, 1, "mask", true);
    });
  ExpectError({ "MaskArray", "\"mask\"", "association" },
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      AddPointArray(input, "mask", 1, Rough);
      filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_NONE, "mask");
    });
  ExpectError({ "InputArray", "\"ofCells\"", "cell 7", "finite" },
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      input->GetCellData()->AddArray(MakeArray(
        VTK_DOUBLE, "ofCells", 50, 1, [](vtkIdType i, int) { return i == 7 ? Infinity : 1.0; }));
      SetInputArray(filter, 0, "ofCells", true);
    });
  ExpectError({ "FidelityArray", "\"w\"", "2 components", "1" },
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      AddPointArray(input, "w", 2, Rough);
      SetInputArray(filter, 5, "w");
    });
  for (const double bad : { -1.0, std::nan("") })
  {
    ExpectError({ "FidelityArray", "point 7", "0 or more" },
      [bad](vtkFVMHeatFilter* filter, vtkPolyData* input)
      {
        AddPointArray(input, "w", 1, [bad](vtkIdType i, int) { return i == 7 ? bad : 1.0; });
        SetInputArray(filter, 5, "w");
        filter->SetFidelityWeight(1.0);
      });
  }
  ExpectError({ "DirectionArray", "\"e1\"", "2 components", "3" },
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      AddPointArray(input, "e1", 2, Rough);
      SetInputArray(filter, 2, "e1");
    });
  ExpectError({ "DirectionArray", "\"e1\"", "36", "50" },
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      input->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "e1", 36, 3, Rough));
      SetInputArray(filter, 2, "e1", true);
    });
  ExpectError({ "FixedArray", "\"nosuch\"" },
    [](vtkFVMHeatFilter* filter, vtkPolyData*) { SetInputArray(filter, 3, "nosuch"); });
}

TEST(BadInput, NumbersThatAreNotFiniteAreErrors)
{
  for (const double bad : { NaN, Infinity, -Infinity })
  {
    ExpectError({ "coordinates", "point 7", "vtkCleanPolyData" },
      [&](vtkFVMHeatFilter*, vtkPolyData* input)
      { input->GetPoints()->SetPoint(7, 0.0, bad, 0.0); });
  }
  for (const double bad : { Infinity, -Infinity })
  {
    ExpectError({ "InputArray", "\"f\"", "infinite", "point 7" },
      [&](vtkFVMHeatFilter*, vtkPolyData* input)
      { input->GetPointData()->GetScalars()->SetComponent(7, 0, bad); });
  }
  ExpectError({ "InputArray", "\"f\"", "infinite", "point 36" }, // a point that no triangle uses
    [&](vtkFVMHeatFilter*, vtkPolyData* input)
    {
      input->GetPoints()->InsertNextPoint(0.0, 0.0, 1.0);
      AddPointArray(
        input, "f", 1, [](vtkIdType i, int k) { return i == 36 ? Infinity : Rough(i, k); });
      input->GetPointData()->SetActiveScalars("f");
    });
  ExpectError({ "FixedArray", "NaN", "point 7", "finite" },
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      input->GetPointData()->GetScalars()->SetComponent(7, 0, NaN);
      AddPointArray(input, "fixed", 1, [](vtkIdType i, int) { return i == 7; });
      SetInputArray(filter, 3, "fixed");
    });
  ExpectError({ "double" },
    [](vtkFVMHeatFilter*, vtkPolyData* input)
    {
      input->GetPointData()->GetScalars()->SetComponent(7, 0, 1.5e308);
      input->GetPointData()->GetScalars()->SetComponent(8, 0, -1.5e308);
    });
}

TEST(BadInput, InfiniteDirectionsAreErrors)
{
  ExpectError({ "DirectionArray", "\"e1\"", "infinite" },
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      AddPointArray(input, "e1", 3,
        [](vtkIdType i, int k) { return i == 7 && k == 0 ? Infinity : Rough(i, k); });
      SetInputArray(filter, 2, "e1");
      filter->SetAlongDiffusivity(5.0);
    });
}

TEST(BadInput, CellsThatReferToNoPointAreErrors)
{
  ExpectError({ "cell", "36" },
    [](vtkFVMHeatFilter*, vtkPolyData* input) {
      input->GetPolys()->InsertNextCell({ vtkIdType(0), vtkIdType(1), vtkIdType(36) });
    });
}

TEST(BadInput, GhostsAndIdsOfTheWrongSizeAreErrors)
{
  ExpectError({ "vtkGhostType", "3 tuples", "50" },
    [](vtkFVMHeatFilter*, vtkPolyData* input)
    {
      input->GetCellData()->AddArray(MakeArray(VTK_UNSIGNED_CHAR,
        vtkDataSetAttributes::GhostArrayName(), 3, 1, [](vtkIdType, int) { return 0; }));
    });
  ExpectError({ "Ids", "3 tuples", "36" },
    [](vtkFVMHeatFilter*, vtkPolyData* input)
    {
      input->GetPointData()->SetGlobalIds(
        MakeArray(VTK_ID_TYPE, "Ids", 3, 1, [](vtkIdType i, int) { return i; }));
    });
}

TEST(BadInput, AllProblemsAreReportedTogether)
{
  ExpectError({ "TimeStep is -1", "Tolerance is 2", "nosuch" },
    [](vtkFVMHeatFilter* filter, vtkPolyData*)
    {
      filter->SetTimeStep(-1.0);
      filter->SetTolerance(2.0);
      SetInputArray(filter, 1, "nosuch");
    });
}

TEST(BadInput, ContradictorySettingsAreErrors)
{
  ExpectError({ "AlongDiffusivity", "5", "AcrossDiffusivity", "1", "DirectionArray", "allowed" },
    [](vtkFVMHeatFilter* filter, vtkPolyData*) { filter->SetAlongDiffusivity(5.0); });
  ExpectError({ "HoldKnownValues", "on", "allowed" },
    [](vtkFVMHeatFilter* filter, vtkPolyData*) { filter->HoldKnownValuesOn(); });
  ExpectError({ "HoldKnownValues", "on", "allowed" }, // an excluded region is not missing
    [](vtkFVMHeatFilter* filter, vtkPolyData* input)
    {
      AddPointArray(input, "mask", 1, [](vtkIdType i, int) { return i == 7; });
      SetInputArray(filter, 1, "mask");
      filter->SetMaskModeToExclude();
      filter->HoldKnownValuesOn();
    });
}

TEST(BadInput, HugeNumbersOfStepsAreErrorsOrCanBeAborted)
{
  ExpectError({ "NumberOfTimeSteps / OutputInterval is 2000000", "OutputInterval" },
    [](vtkFVMHeatFilter* filter, vtkPolyData*)
    {
      filter->SetNumberOfTimeSteps(2000000);
      filter->GenerateTimeStepsOn();
    });
  ExpectPropertyError<int>("NumberOfTimeSteps", &vtkFVMHeatFilter::SetNumberOfTimeSteps,
    { { std::numeric_limits<int>::max(), "2147483647" } });
  auto input = GoodInput();
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(input);
  filter->SetNumberOfTimeSteps(1000000000);
  int reports = 0;
  Listen(filter, [&](double) { filter->SetAbortExecute(++reports > 100); });
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetPointData()->GetNumberOfArrays(), 1);
}

TEST(BadInput, HugeAndTinyTimesAndValuesGiveFiniteAnswersOrErrors)
{
  for (const double step : { 1e-300, 1e-30, 1e30, 1e300 })
  {
    for (const double scale : { 1e-300, 1e-150, 1e150, 1e300 })
    {
      for (const int units : { 0, 1 })
      {
        auto input = GoodInput();
        for (vtkIdType i = 0; i < 36; ++i)
        {
          input->GetPointData()->GetScalars()->SetComponent(i, 0, scale * Rough(i, 0));
        }
        vtkNew<vtkFVMHeatFilter> filter;
        filter->SetInputData(input);
        filter->SetTimeStep(step);
        filter->SetUnits(units);
        Messages messages(filter);
        filter->Update();
        if (messages.Errors.empty())
        {
          EXPECT_TRUE(AllFinite(Result(filter))) << step << ' ' << scale;
          EXPECT_NEAR(HistoryAt(filter, 10, "Total_0") / scale,
            HistoryAt(filter, 0, "Total_0") / scale, 1e-11);
        }
        else
        {
          EXPECT_EQ(Result(filter), nullptr);
        }
      }
    }
  }
}
