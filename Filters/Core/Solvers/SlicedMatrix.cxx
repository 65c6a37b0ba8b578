// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SlicedMatrix.h"

#include "Core/Foundation/Columns.h"

#include <algorithm>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index Lanes = SlicedMatrix::Lanes;

struct Slices
{
  const std::size_t* Begin;
  const Index* Columns;
  const float* Entries;
};

double AddLanes(const float (&lanes)[Lanes])
{
  double sum = 0.0;
  for (const float lane : lanes)
  {
    sum += lane;
  }
  return sum;
}

// The passes over rows [begin, end) of one column.

SURFACEDIFFUSION_ANY_VECTORS double MultiplyRows(const Slices& slices, std::size_t begin,
  std::size_t end, const float* __restrict p, float* __restrict q)
{
  float dots[Lanes] = {};
  for (std::size_t row = begin; row < end; row += Lanes)
  {
    float products[Lanes];
    for (Index l = 0; l < Lanes; ++l)
    {
      products[l] = p[row + l];
    }
    const std::size_t last = slices.Begin[row / Lanes + 1];
    for (std::size_t slot = slices.Begin[row / Lanes]; slot < last; slot += Lanes)
    {
      for (Index l = 0; l < Lanes; ++l)
      {
        products[l] += slices.Entries[slot + l] * p[slices.Columns[slot + l]];
      }
    }
    for (Index l = 0; l < Lanes; ++l)
    {
      q[row + l] = products[l];
      dots[l] += products[l] * p[row + l];
    }
  }
  return AddLanes(dots);
}

SURFACEDIFFUSION_ANY_VECTORS double SubtractRows(
  std::size_t begin, std::size_t end, float alpha, const float* __restrict q, float* __restrict r)
{
  float squares[Lanes] = {};
  for (std::size_t row = begin; row < end; row += Lanes)
  {
    for (Index l = 0; l < Lanes; ++l)
    {
      const float left = r[row + l] - alpha * q[row + l];
      r[row + l] = left;
      squares[l] += left * left;
    }
  }
  return AddLanes(squares);
}

SURFACEDIFFUSION_ANY_VECTORS void TurnRows(std::size_t begin, std::size_t end, float alpha,
  float beta, const float* __restrict r, float* __restrict y, float* __restrict p)
{
  for (std::size_t i = begin; i < end; ++i)
  {
    const float last = p[i];
    y[i] += alpha * last;
    p[i] = r[i] + beta * last;
  }
}

SURFACEDIFFUSION_ANY_VECTORS void StepRows(
  std::size_t begin, std::size_t end, float alpha, const float* __restrict p, float* __restrict y)
{
  for (std::size_t i = begin; i < end; ++i)
  {
    y[i] += alpha * p[i];
  }
}

} // namespace

void SlicedMatrix::SortRows(const SparseMatrix& matrix)
{
  const Index n = static_cast<Index>(matrix.rows());
  const Index* const outer = matrix.outerIndexPtr();
  if (this->Outer.size() == static_cast<std::size_t>(n) + 1 &&
    std::equal(this->Outer.begin(), this->Outer.end(), outer))
  {
    return;
  }
  this->Outer.clear(); // until all is sorted: an abort must not look like the end
  const std::size_t slices = (static_cast<std::size_t>(n) + Lanes - 1) / Lanes;
  this->Rows.assign(slices * Lanes, -1);
  this->Places.resize(n);
  this->Begin.assign(slices + 1, 0);
  static_assert(BlockSize % Lanes == 0, "a slice is in one block");
  ForEachBlock(this->Parallel, n,
    [&](Index, Index begin, Index end)
    {
      const auto length = [outer](Index i) { return outer[i + 1] - outer[i]; };
      const auto first = this->Rows.begin() + begin;
      std::iota(first, first + (end - begin), begin);
      std::sort(first, first + (end - begin),
        [&](Index a, Index b) { return length(a) != length(b) ? length(a) > length(b) : a < b; });
      for (Index place = begin; place < end; ++place)
      {
        this->Places[this->Rows[place]] = place;
        if (place % Lanes == 0) // the longest row of its slice, without the diagonal
        {
          this->Begin[place / Lanes + 1] =
            static_cast<std::size_t>(std::max(length(this->Rows[place]) - 1, 0)) * Lanes;
        }
      }
    });
  std::partial_sum(this->Begin.begin(), this->Begin.end(), this->Begin.begin());
  this->Columns = Buffer<Index>(this->Begin.back());
  this->Entries = Buffer<float>(this->Begin.back());
  this->Outer.assign(outer, outer + n + 1);
}

void SlicedMatrix::Set(const SparseMatrix& matrix, const Vector& roots)
{
  this->SortRows(matrix);
  const Index* const inner = matrix.innerIndexPtr();
  const double* const values = matrix.valuePtr();
  ForEachBlock(this->Parallel, static_cast<Index>(this->Rows.size()),
    [&](Index, Index begin, Index end)
    {
      for (Index place = begin; place < end; ++place)
      {
        const std::size_t lane = place % Lanes;
        const std::size_t last = this->Begin[place / Lanes + 1] + lane;
        std::size_t at = this->Begin[place / Lanes] + lane;
        const Index row = this->Rows[place];
        const Index first = row < 0 ? 0 : this->Outer[row];
        const Index size = row < 0 ? 0 : this->Outer[row + 1] - first;
        Index below = 0; // entries before the diagonal, which are left out without a branch
        for (Index k = 0; k < size; ++k)
        {
          below += inner[first + k] < row;
        }
        for (Index k = 0; k + 1 < size; ++k)
        {
          const Index slot = first + k + (k >= below);
          const Index column = inner[slot];
          this->Columns[at] = this->Places[column];
          this->Entries[at] = static_cast<float>(values[slot] * roots[row] * roots[column]);
          at += Lanes;
        }
        for (; at < last; at += Lanes)
        {
          this->Columns[at] = place;
          this->Entries[at] = 0.0F;
        }
      }
    });
}

template <typename Part>
void SlicedMatrix::Sum(int columns, const Part& part, double* sums)
{
  const Index rows = static_cast<Index>(this->Rows.size());
  this->Partial.resize(static_cast<std::size_t>(NumberOfBlocks(rows)) * columns);
  ForEachBlock(this->Parallel, rows,
    [&](Index block, Index begin, Index end)
    {
      for (int c = 0; c < columns; ++c)
      {
        const std::size_t at = static_cast<std::size_t>(block) * columns + c;
        this->Partial[at] = part(c, c * this->Rows.size(), begin, end);
      }
    });
  std::fill_n(sums, columns, 0.0);
  for (Index block = 0; block < NumberOfBlocks(rows); ++block)
  {
    for (int c = 0; c < columns; ++c)
    {
      sums[c] += this->Partial[static_cast<std::size_t>(block) * columns + c];
    }
  }
}

void SlicedMatrix::Multiply(int columns, const float* p, float* q, double* sums)
{
  const Slices slices{ this->Begin.data(), this->Columns.data(), this->Entries.data() };
  this->Sum(
    columns,
    [&](int, std::size_t column, Index begin, Index end)
    { return MultiplyRows(slices, begin, end, p + column, q + column); },
    sums);
}

void SlicedMatrix::Subtract(int columns, const float* alpha, const float* q, float* r, double* sums)
{
  this->Sum(
    columns,
    [&](int c, std::size_t column, Index begin, Index end)
    { return SubtractRows(begin, end, alpha[c], q + column, r + column); },
    sums);
}

void SlicedMatrix::Turn(int columns, const float* alpha, const float* beta, const bool* goesOn,
  const float* r, float* y, float* p)
{
  ForEachBlock(this->Parallel, static_cast<Index>(this->Rows.size()),
    [&](Index, Index begin, Index end)
    {
      for (int c = 0; c < columns; ++c)
      {
        const std::size_t column = c * this->Rows.size();
        if (goesOn[c])
        {
          TurnRows(begin, end, alpha[c], beta[c], r + column, y + column, p + column);
        }
        else if (alpha[c] != 0.0F)
        {
          StepRows(begin, end, alpha[c], p + column, y + column);
        }
      }
    });
}

} // namespace SurfaceDiffusion
