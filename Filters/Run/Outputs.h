// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Run/ConvertValue.h"
#include "Run/Output.h"
#include "Run/Run.h"
#include "Run/Sentinels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

/// What outputs that are arrays are made from, besides their rows: the surface, and the data that
/// the result replaces.
struct OutputSource
{
  const SurfaceDiffusion::Surface& Surface;
  const ParallelFor& Parallel;
  /// The cell that a triangle of the surface's input was cut from, of NumberOfCells.
  std::int64_t NumberOfCells = 0;
  std::function<std::int64_t(Index)> CellOf = {};
  /// The data in array units, without alpha; empty: there are none.
  std::function<Values()> ReadData = {};
  bool DataAreFloats = false; ///< what nothing determines is NaN, not the data
  bool AsBytes = false; ///< the type of the result of the data is unsigned char
  const Run::Block* Block = nullptr; ///< of a model; otherwise null
  ModelTraits Traits = {};
};

/// Whether an output is written at the cells. block: of a model; null if there is none.
bool IsOnCells(const Output& output, const Run::Block* block, const ModelTraits& traits);

/// The number of columns of an output. block: likewise.
Eigen::Index CountColumns(const Output& output, const Run::Block* block);

/// The rows of an output at the points or cells of the input, ready to be written in any numeric
/// type. It refers to the output and its source.
class OutputRows
{
public:
  /// Moves the output to its place, with the detail of cells, the encoding of colours, and the
  /// brightness of colours whose directions are the state. output.Where is PerVertex, PerPoint,
  /// PerCell or PerTriangle.
  OutputRows(const Output& output, const OutputSource& source);

  bool OnCells() const { return this->IsOnCells; }
  Index Count() const { return this->NumberOfRows; }
  Eigen::Index Columns() const { return this->NumberOfColumns; }
  /// Whether Write() reads the data.
  bool TakesGiven() const { return this->GivenColumn >= 0; }

  /// Write an array of `stride` components per tuple. given(i, k): component k of the data. first:
  /// the column from which on those of this output are written, and no others; -1: all are
  /// written, those beyond Columns() as alpha. Throws std::runtime_error if T cannot hold a value.
  template <typename T, typename Given>
  void Write(T* to, Eigen::Index stride, Eigen::Index first, const Given& given,
    const ParallelFor& parallel) const
  {
    const Values& from = this->From();
    const Eigen::Index columns = first < 0 ? stride : this->NumberOfColumns;
    const Eigen::Index start = std::max<Eigen::Index>(first, 0);
    ForEach(parallel, this->NumberOfRows,
      [&](Index i)
      {
        const Index row = this->RowOf(i);
        T* const tuple = to + i * stride + start;
        const Eigen::Index known = row >= 0 ? std::min(this->NumberOfColumns, columns) : 0;
        for (Eigen::Index k = 0; k < known; ++k)
        {
          tuple[k] = this->Convert<T>(from(row, this->FirstColumn + k) * this->Unit);
        }
        for (Eigen::Index k = known; k < columns; ++k)
        {
          tuple[k] = this->Convert<T>(this->Other(i, k, given));
        }
      });
  }

private:
  void MoveToCells(const Output& output, const OutputSource& source);
  void TakeState(const Output& output, const OutputSource& source);

  template <typename T>
  T Convert(double value) const
  {
    const bool isResult = !std::numeric_limits<T>::is_integer && this->MayBeInfinite;
    return isResult && std::isinf(value) ? static_cast<T>(value) : ConvertValue<T>(value);
  }

  const Values& From() const { return this->Shared ? *this->Shared : this->Own; }

  /// The row of a point or cell; negative if it takes no part.
  Index RowOf(Index i) const
  {
    if (this->Vertices)
    {
      return this->Vertices->VertexOf(i);
    }
    return !this->Cells || this->Cells->Transfer.Participates(i) ? i : -1;
  }

  /// Where the output has no value.
  template <typename Given>
  double Other(Index i, Eigen::Index k, const Given& given) const
  {
    constexpr double Opaque = 255.0;
    if (this->HoldsNaN &&
      (this->IsOnCells ? this->Cells->IsUndetermined(i) : this->Domain->IsUndetermined(i)))
    {
      return std::numeric_limits<double>::quiet_NaN();
    }
    if (this->GivenColumn >= 0)
    {
      const double value = given(i, this->GivenColumn + k);
      return this->HoldsNaN && StandsForNoValue(value, this->MissingValues)
        ? std::numeric_limits<double>::quiet_NaN()
        : value;
    }
    if (k >= this->NumberOfColumns)
    {
      return Opaque;
    }
    return this->Elsewhere && this->Elsewhere->size() > 0 ? (*this->Elsewhere)(0, k) : 0.0;
  }

  const Values* Shared = nullptr; ///< null: Own
  Values Own;
  const Surface* Domain = nullptr;
  const Surface* Vertices = nullptr; ///< null: rows are not of vertices
  const CellState* Cells = nullptr;
  const Values* Elsewhere = nullptr;
  Index NumberOfRows = 0;
  Eigen::Index NumberOfColumns = 0;
  Eigen::Index FirstColumn = 0;
  double Unit = 1.0;
  Eigen::Index GivenColumn = -1;
  std::vector<double> MissingValues; ///< of the data
  bool IsOnCells = false;
  bool HoldsNaN = false;
  bool MayBeInfinite = false;
};

/// The outputs of one surface of a run.
using OutputList = std::vector<Output>;

/// The numbers of several surfaces, each as a matrix. reported: the surface whose numbers stand for
/// those of all, unless they are combined.
std::map<std::string, Values> CombineNumbers(
  const std::vector<const OutputList*>& surfaces, std::size_t reported);

/// The numbers of a run on all its surfaces, with TimeUnit, MeanEdgeLength and ValueRange.
std::map<std::string, Values> FindNumbers(const Run& run);

/// The same with those of the way there: NumberOfIterations, Residual, NumberOfUnusedPoints and
/// NumberOfStepsComputed. processes: those that share the run.
std::map<std::string, Values> FindNumbers(
  const Run& run, const History& history, const Reduction& processes);

} // namespace SurfaceDiffusion
