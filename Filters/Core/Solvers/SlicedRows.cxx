// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SlicedRows.h"

#include "Core/Foundation/Columns.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index Lanes = SlicedRows::Lanes;
static_assert(BlockSize % Lanes == 0, "a slice is in one block");

struct Slices
{
  const std::size_t* Begin;
  const Index* Columns;
  const float* Entries;
};

/// y = b + sign rows x of whole slices, in the order of Multigrid's products with several columns.
SURFACEDIFFUSION_ANY_VECTORS void AddProducts(const Slices& slices, Index begin, Index end,
  float sign, const float* x, const float* b, float* y)
{
  for (std::ptrdiff_t row = begin; row < end; row += Lanes)
  {
    float sums[Lanes];
    for (Index l = 0; l < Lanes; ++l)
    {
      sums[l] = b[row + l];
    }
    const std::size_t last = slices.Begin[row / Lanes + 1];
    for (std::size_t slot = slices.Begin[row / Lanes]; slot < last; slot += Lanes)
    {
      for (Index l = 0; l < Lanes; ++l)
      {
        sums[l] += sign * slices.Entries[slot + l] * x[slices.Columns[slot + l]];
      }
    }
    for (Index l = 0; l < Lanes; ++l)
    {
      y[row + l] = sums[l];
    }
  }
}

/// The same, where the last slice may be incomplete.
void AddAnyProducts(const Slices& slices, Index begin, Index end, float sign, const float* x,
  const float* b, float* y)
{
  const Index whole = begin + (end - begin) / Lanes * Lanes;
  AddProducts(slices, begin, whole, sign, x, b, y);
  if (whole < end)
  {
    float last[Lanes] = {};
    std::copy(b + whole, b + end, last);
    const Slices rest{ slices.Begin + whole / Lanes, slices.Columns, slices.Entries };
    AddProducts(rest, 0, Lanes, sign, x, last, last);
    std::copy_n(last, end - whole, y + whole);
  }
}

} // namespace

void SlicedRows::Set(
  const Eigen::SparseMatrix<float, Eigen::ColMajor, Index>& columns, const ParallelFor& parallel)
{
  const Index* const outer = columns.outerIndexPtr();
  const Index* const inner = columns.innerIndexPtr();
  const float* const values = columns.valuePtr();
  this->Count = static_cast<Index>(columns.cols());
  const Index slices = (this->Count + Lanes - 1) / Lanes;
  this->Begin.assign(static_cast<std::size_t>(slices) + 1, 0);
  const auto lengthOf = [&](Index row)
  { return row < this->Count ? outer[row + 1] - outer[row] : 0; };
  ForEach(parallel, slices,
    [&](Index s)
    {
      Index longest = 0;
      for (Index row = s * Lanes; row < (s + 1) * Lanes; ++row)
      {
        longest = std::max(longest, lengthOf(row));
      }
      this->Begin[s + 1] = static_cast<std::size_t>(longest) * Lanes;
    });
  std::partial_sum(this->Begin.begin(), this->Begin.end(), this->Begin.begin());
  if (this->Entries.size() != this->Begin.back())
  {
    // Memory may run out: both buffers have the same size at any time.
    Buffer<Index> numbers(this->Begin.back());
    Buffer<float> entries(this->Begin.back());
    this->Columns = std::move(numbers);
    this->Entries = std::move(entries);
  }
  ForEach(parallel, slices,
    [&](Index s)
    {
      for (Index l = 0; l < Lanes; ++l)
      {
        const Index row = s * Lanes + l;
        const Index length = lengthOf(row);
        std::size_t at = this->Begin[s] + l;
        for (Index k = 0; k < length; ++k, at += Lanes)
        {
          this->Columns[at] = inner[outer[row] + k];
          this->Entries[at] = values[outer[row] + k];
        }
        const Index filler = length > 0 ? inner[outer[row]] : 0; // a number that is in the cache
        for (; at < this->Begin[s + 1]; at += Lanes)
        {
          this->Columns[at] = filler;
          this->Entries[at] = 0.0F;
        }
      }
    });
}

void SlicedRows::Multiply(Index begin, Index end, const float* x, float* y) const
{
  std::fill(y + begin, y + end, 0.0F);
  this->Add(begin, end, x, y);
}

void SlicedRows::Subtract(Index begin, Index end, const float* b, const float* x, float* y) const
{
  AddAnyProducts(
    { this->Begin.data(), this->Columns.data(), this->Entries.data() }, begin, end, -1.0F, x, b, y);
}

void SlicedRows::Add(Index begin, Index end, const float* x, float* y) const
{
  AddAnyProducts(
    { this->Begin.data(), this->Columns.data(), this->Entries.data() }, begin, end, 1.0F, x, y, y);
}

} // namespace SurfaceDiffusion
