// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/DenseTiles.h"

#include "Core/Foundation/Columns.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace SurfaceDiffusion
{

namespace
{

#if defined(__GNUC__)
/// A column of a tile, in the widest registers that there are.
using Lanes = double __attribute__((vector_size(TileRows * sizeof(double))));
#else
struct Lanes
{
  double Numbers[TileRows];
  Lanes& operator-=(const Lanes& other)
  {
    for (Index i = 0; i < TileRows; ++i)
    {
      this->Numbers[i] -= other.Numbers[i];
    }
    return *this;
  }
  friend Lanes operator*(Lanes a, double factor)
  {
    for (double& number : a.Numbers)
    {
      number *= factor;
    }
    return a;
  }
};
#endif

// The choice of a width is a symbol that -fvisibility does not hide: it would be that of the program
// where a library and the program that loads it both contain the function, so these have none.
namespace ForWidth
{

// The tiles stay in registers over all of the depth.
SURFACEDIFFUSION_ANY_VECTORS void SubtractTileProducts(const double* a, std::ptrdiff_t strideA,
  const double* b, Index depth, double* c, std::ptrdiff_t strideC, Index count, Index width)
{
  const std::size_t bytes =
    static_cast<std::size_t>(std::min(width, TileRows)) * TileRows * sizeof(double);
  for (Index tile = 0; tile < count; ++tile)
  {
    const double* const left = a + tile * strideA;
    double* const result = c + tile * strideC;
    Lanes sums[TileRows] = {};
    std::memcpy(sums, result, bytes);
    for (Index p = 0; p < depth; ++p)
    {
      Lanes column;
      std::memcpy(&column, left + static_cast<std::ptrdiff_t>(p) * TileRows, sizeof(Lanes));
      const double* const factors = b + static_cast<std::ptrdiff_t>(p) * TileRows;
      for (Index j = 0; j < TileRows; ++j)
      {
        sums[j] -= column * factors[j];
      }
    }
    std::memcpy(result, sums, bytes);
  }
}

SURFACEDIFFUSION_ANY_VECTORS void SolveTiles(
  const double* l, Index width, double* c, std::ptrdiff_t stride, Index count)
{
  for (Index tile = 0; tile < count; ++tile)
  {
    double* const x = c + tile * stride;
    for (Index j = 0; j < width; ++j)
    {
      Lanes column;
      std::memcpy(&column, x + j * TileRows, sizeof(Lanes));
      for (Index q = 0; q < j; ++q)
      {
        Lanes known;
        std::memcpy(&known, x + q * TileRows, sizeof(Lanes));
        column -= known * l[q * TileRows + j];
      }
      column = column * (1.0 / l[j * TileRows + j]);
      std::memcpy(x + j * TileRows, &column, sizeof(Lanes));
    }
  }
}

SURFACEDIFFUSION_ANY_VECTORS void SubtractTransposedProduct(
  const double* a, Index depth, const double* b, double* c)
{
  Lanes rows[TileRows];
  std::memcpy(rows, b, sizeof(rows));
  for (Index p = 0; p < depth; ++p)
  {
    Lanes sum;
    std::memcpy(&sum, c + static_cast<std::ptrdiff_t>(p) * TileRows, sizeof(Lanes));
    const double* const factors = a + static_cast<std::ptrdiff_t>(p) * TileRows;
    for (Index i = 0; i < TileRows; ++i)
    {
      sum -= rows[i] * factors[i];
    }
    std::memcpy(c + static_cast<std::ptrdiff_t>(p) * TileRows, &sum, sizeof(Lanes));
  }
}

SURFACEDIFFUSION_ANY_VECTORS void SolveTriangle(
  const double* l, Index width, bool transposed, double* w)
{
  for (Index step = 0; step < width; ++step)
  {
    const Index j = transposed ? width - 1 - step : step;
    Lanes row;
    std::memcpy(&row, w + j * TileRows, sizeof(Lanes));
    for (Index q = transposed ? j + 1 : 0; q < (transposed ? width : j); ++q)
    {
      Lanes known;
      std::memcpy(&known, w + q * TileRows, sizeof(Lanes));
      row -= known * (transposed ? l[j * TileRows + q] : l[q * TileRows + j]);
    }
    row = row * (1.0 / l[j * TileRows + j]);
    std::memcpy(w + j * TileRows, &row, sizeof(Lanes));
  }
}

} // namespace ForWidth

} // namespace

void SubtractTileProducts(const double* a, std::ptrdiff_t strideA, const double* b, Index depth,
  double* c, std::ptrdiff_t strideC, Index count, Index width)
{
  ForWidth::SubtractTileProducts(a, strideA, b, depth, c, strideC, count, width);
}

void SolveTiles(const double* l, Index width, double* c, std::ptrdiff_t stride, Index count)
{
  ForWidth::SolveTiles(l, width, c, stride, count);
}

void SubtractTransposedProduct(const double* a, Index depth, const double* b, double* c)
{
  ForWidth::SubtractTransposedProduct(a, depth, b, c);
}

void SolveTriangle(const double* l, Index width, bool transposed, double* w)
{
  ForWidth::SolveTriangle(l, width, transposed, w);
}

PivotCounts FactorizeTile(double* l, Index width, const double* smallest)
{
  constexpr double huge = 1e100;
  PivotCounts counts;
  for (Index j = 0; j < width; ++j)
  {
    double pivot = l[j * TileRows + j];
    for (Index q = 0; q < j; ++q)
    {
      pivot -= l[q * TileRows + j] * l[q * TileRows + j];
    }
    if (!(pivot > smallest[j]))
    {
      counts.Negative += pivot < -smallest[j] ? 1 : 0;
      ++counts.Open;
      pivot = huge;
    }
    const double root = std::sqrt(pivot);
    l[j * TileRows + j] = root;
    for (Index i = 0; i < j; ++i)
    {
      l[j * TileRows + i] = 0.0;
    }
    for (Index i = j + 1; i < TileRows; ++i)
    {
      double entry = l[j * TileRows + i];
      for (Index q = 0; q < j; ++q)
      {
        entry -= l[q * TileRows + i] * l[q * TileRows + j];
      }
      l[j * TileRows + i] = entry / root;
    }
  }
  return counts;
}

} // namespace SurfaceDiffusion
