// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

/// The entries of a unit lower triangular matrix below its diagonal as one stream, in the order in
/// which substitution needs them. A panel is up to Widest columns that follow each other, each of
/// which has the rows of the next one and the next one itself below its diagonal: substitution
/// reads the rows, and the right-hand side in them, once for all columns.
class FactorPanels
{
public:
  static constexpr int Widest = 4;

  Index Count() const { return static_cast<Index>(this->First.size()) - 1; }
  Index Width(Index panel) const { return this->First[panel + 1] - this->First[panel]; }
  Index FirstColumn(Index panel) const { return this->First[panel]; }
  /// First the entries in the panel's own rows below the diagonal, row by row, then those in the
  /// rows below the panel, row by row.
  const double* EntriesOf(Index panel) const
  {
    return this->Entries.data() + this->EntriesBegin[panel];
  }
  /// Below the panel, ascending.
  const Index* RowsOf(Index panel) const { return this->Rows.data() + this->RowsBegin[panel]; }
  Index NumberOfRows(Index panel) const
  {
    return static_cast<Index>(this->RowsBegin[panel + 1] - this->RowsBegin[panel]);
  }
  std::size_t NumberOfEntries() const { return this->Entries.size(); }

  /// A column of the matrix: rows, ascending, and the entries in them.
  struct Column
  {
    std::vector<Index> Rows;
    std::vector<double> Entries;
  };

  /// Remove all columns. entries: as many as there will be, for which memory is taken.
  void Clear(std::size_t entries);
  /// Append a column, whose contents are taken: it is left with others.
  void Append(Column& column);
  /// Call this after the last column.
  void Finish();

private:
  bool IsNested(const Column& column) const;
  void WritePanel();

  std::vector<Index> First; ///< columns, and the number of columns at the end
  std::vector<std::size_t> EntriesBegin, RowsBegin;
  std::vector<double> Entries;
  std::vector<Index> Rows;
  // The panel that is not written yet
  Column Open[Widest];
  int OpenWidth = 0;
  Index Columns = 0; ///< appended
};

} // namespace SurfaceDiffusion
