// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The promises of Promises.h are broken by histories that break them.

#include "Promises.h"

#include "vtkDataSetAttributes.h"
#include "vtkExecutive.h"

#include <gtest/gtest-spi.h>

#include <cmath>
#include <limits>

using namespace FilterTest;

namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/// A filter whose history has the given column, without an update.
vtkSmartPointer<vtkFVMHeatFilter> WithHistory(const char* column, const std::vector<double>& values)
{
  auto filter = vtkSmartPointer<vtkFVMHeatFilter>::New();
  vtkNew<vtkDoubleArray> array;
  array->SetName(column);
  for (const double value : values)
  {
    array->InsertNextValue(value);
  }
  vtkNew<vtkTable> table;
  table->GetRowData()->AddArray(array);
  filter->GetExecutive()->SetOutputData(1, table);
  return filter;
}

/// The failures that a check of a history adds.
template <typename Check>
int Failures(const Check& check, const char* column, const std::vector<double>& values)
{
  testing::TestPartResultArray failures;
  {
    const testing::ScopedFakeTestPartResultReporter reporter(
      testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &failures);
    check(WithHistory(column, values));
  }
  return failures.size();
}

int FailuresOfTotals(const std::vector<double>& totals)
{
  return Failures(ExpectTotalIsConserved, "Total_0", totals);
}

int FailuresOfEnergies(const std::vector<double>& energies)
{
  return Failures(ExpectEnergyFalls, "Energy", energies);
}

} // namespace

TEST(Promises, TotalsThatAreKeptAreKept)
{
  EXPECT_EQ(FailuresOfTotals({ 3.0, 3.0, 3.0 * (1.0 + 5e-13) }), 0);
  EXPECT_EQ(FailuresOfTotals({ -3.0, -3.0 }), 0);
  EXPECT_EQ(FailuresOfTotals({ 0.0, 0.0, -1e-13 }), 0);
}

TEST(Promises, TotalsThatChangeAreNotKept)
{
  EXPECT_GT(FailuresOfTotals({ 3.0, 3.0 * (1.0 + 2e-12) }), 0);
  EXPECT_GT(FailuresOfTotals({ 3.0, 3.0 * (1.0 - 2e-12), 3.0 }), 0);
  EXPECT_GT(FailuresOfTotals({ -3.0, 3.0 }), 0);
  EXPECT_GT(FailuresOfTotals({ -3.0, -3.0 * (1.0 + 2e-12) }), 0);
  EXPECT_GT(FailuresOfTotals({ 0.0, -1.0 }), 0);
  EXPECT_GT(FailuresOfTotals({ 0.0, 1.0 }), 0);
}

TEST(Promises, TotalsThatAreNoNumbersAreNotKept)
{
  for (const std::vector<double>& totals : { std::vector<double>{ NaN, NaN }, { 3.0, NaN },
         { 3.0, NaN, 3.0 }, { NaN, 3.0 }, { 3.0, INFINITY }, { INFINITY, INFINITY } })
  {
    EXPECT_GT(FailuresOfTotals(totals), 0) << testing::PrintToString(totals);
    EXPECT_FALSE(LargestChange(totals) <= 1e-12) << testing::PrintToString(totals);
  }
}

TEST(Promises, EmptyHistoriesKeepNothing)
{
  for (const std::vector<double>& few : { std::vector<double>{}, { 3.0 } })
  {
    EXPECT_GT(FailuresOfTotals(few), 0);
    EXPECT_GT(FailuresOfEnergies(few), 0);
    EXPECT_GT(Failures(ExpectEnergyFallsInStages, "Energy", few), 0);
  }
}

TEST(Promises, EnergiesFallOrDoNot)
{
  EXPECT_EQ(FailuresOfEnergies({ 3.0, 2.0, 2.0, 1.0 }), 0);
  EXPECT_GT(FailuresOfEnergies({ 3.0, 2.0, 2.1 }), 0);
  EXPECT_GT(FailuresOfEnergies({ 3.0, NaN, 2.0 }), 0);
  EXPECT_GT(FailuresOfEnergies({ NaN, 2.0, 1.0 }), 0);
  EXPECT_EQ(Failures(ExpectEnergyFallsInStages, "Energy", { 3.0, 2.0, 2.5, 1.0, 1.5, 1.0 }), 0);
  EXPECT_GT(Failures(ExpectEnergyFallsInStages, "Energy", { 3.0, 3.1, 3.2, 3.3 }), 0);
  EXPECT_GT(Failures(ExpectEnergyFallsInStages, "Energy", { 3.0, 2.0, NaN }), 0);
}
