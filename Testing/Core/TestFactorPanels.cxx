// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/FactorPanels.h"

#include <gtest/gtest.h>

#include <vector>

using namespace SurfaceDiffusion;

namespace
{

/// The entry in row i of column j is 10 j + i.
FactorPanels PanelsOf(const std::vector<std::vector<Index>>& columns)
{
  FactorPanels panels;
  panels.Clear(0);
  Index j = 0;
  for (const std::vector<Index>& rows : columns)
  {
    FactorPanels::Column column;
    for (const Index row : rows)
    {
      column.Rows.push_back(row);
      column.Entries.push_back(10.0 * j + row);
    }
    panels.Append(column);
    ++j;
  }
  panels.Finish();
  return panels;
}

std::vector<Index> Widths(const FactorPanels& panels)
{
  std::vector<Index> widths;
  for (Index p = 0; p < panels.Count(); ++p)
  {
    widths.push_back(panels.Width(p));
  }
  return widths;
}

} // namespace

TEST(FactorPanels, JoinColumnsWhoseRowsAreNested)
{
  const FactorPanels panels = PanelsOf({ { 1, 2, 5 }, { 2, 5 }, { 5 }, { 4 }, { 5 }, {} });
  EXPECT_EQ(Widths(panels), std::vector<Index>({ 3, 1, 2 }));
  const double* const entries = panels.EntriesOf(0);
  EXPECT_EQ(std::vector<double>(entries, entries + 6),
    std::vector<double>({ 1.0, 2.0, 12.0, 5.0, 15.0, 25.0 }));
  EXPECT_EQ(panels.NumberOfRows(0), 1);
  EXPECT_EQ(panels.RowsOf(0)[0], 5);
  EXPECT_EQ(panels.FirstColumn(2), 4);
  EXPECT_EQ(panels.EntriesOf(2)[0], 45.0);
  EXPECT_EQ(panels.NumberOfRows(2), 0);
}

TEST(FactorPanels, HaveAtMostTheWidestNumberOfColumns)
{
  const FactorPanels panels =
    PanelsOf({ { 1, 2, 3, 4, 5 }, { 2, 3, 4, 5 }, { 3, 4, 5 }, { 4, 5 }, { 5 }, {} });
  EXPECT_EQ(Widths(panels), std::vector<Index>({ 4, 2 }));
  EXPECT_EQ(panels.NumberOfEntries(), 15U);
}

TEST(FactorPanels, OfNoColumnsAreNone)
{
  EXPECT_EQ(PanelsOf({}).Count(), 0);
}
