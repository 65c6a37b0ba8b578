// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/FactorPanels.h"

#include <algorithm>
#include <utility>

namespace SurfaceDiffusion
{

void FactorPanels::Clear(std::size_t entries)
{
  *this = FactorPanels();
  this->First.assign(1, 0);
  this->EntriesBegin.assign(1, 0);
  this->RowsBegin.assign(1, 0);
  this->Entries.reserve(entries);
}

void FactorPanels::Append(Column& column)
{
  if (this->OpenWidth == Widest || (this->OpenWidth > 0 && !this->IsNested(column)))
  {
    this->WritePanel();
  }
  std::swap(this->Open[this->OpenWidth++], column);
  ++this->Columns;
}

void FactorPanels::Finish()
{
  if (this->OpenWidth > 0)
  {
    this->WritePanel();
  }
}

/// Whether the column, the next one, continues the open panel.
bool FactorPanels::IsNested(const Column& column) const
{
  const std::vector<Index>& last = this->Open[this->OpenWidth - 1].Rows;
  return last.size() == column.Rows.size() + 1 && last[0] == this->Columns &&
    std::equal(column.Rows.begin(), column.Rows.end(), last.begin() + 1);
}

void FactorPanels::WritePanel()
{
  const auto width = static_cast<std::size_t>(this->OpenWidth);
  const Column& last = this->Open[width - 1];
  const std::size_t begin = this->Entries.size();
  this->Entries.resize(begin + width * (width - 1) / 2 + width * last.Rows.size());
  double* next = this->Entries.data() + begin;
  for (std::size_t row = 1; row < width; ++row)
  {
    for (std::size_t a = 0; a < row; ++a)
    {
      *next++ = this->Open[a].Entries[row - a - 1];
    }
  }
  for (std::size_t a = 0; a < width; ++a)
  {
    const double* const entries = this->Open[a].Entries.data() + (width - 1 - a);
    for (std::size_t row = 0; row < last.Rows.size(); ++row)
    {
      next[row * width + a] = entries[row];
    }
  }
  this->Rows.insert(this->Rows.end(), last.Rows.begin(), last.Rows.end());
  this->First.push_back(this->Columns);
  this->EntriesBegin.push_back(this->Entries.size());
  this->RowsBegin.push_back(this->Rows.size());
  this->OpenWidth = 0;
}

} // namespace SurfaceDiffusion
