// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SupernodalFactor.h"

#include <algorithm>
#include <cstring>

namespace SurfaceDiffusion
{

std::vector<char> SupernodalFactor::Needed(const std::vector<Index>& rows) const
{
  const Supernodes& nodes = this->Nodes;
  std::vector<char> needed(static_cast<std::size_t>(nodes.Count()), 0);
  for (const Index row : rows)
  {
    const auto above = std::upper_bound(nodes.First.begin(), nodes.First.end(), nodes.Place[row]);
    for (auto s = static_cast<Index>(above - nodes.First.begin()) - 1; s >= 0 && !needed[s];
         s = nodes.Parent[s])
    {
      needed[s] = 1;
    }
  }
  return needed;
}

void SupernodalFactor::Solve(
  Values& x, const std::vector<char>& needed, const ParallelFor& parallel) const
{
  const auto columns = static_cast<Index>(x.cols());
  ForEachTask(parallel, NumberOfTiles(columns),
    [&](Index panel)
    {
      const Index first = panel * TileRows;
      this->SolvePanel(x, first, std::min(TileRows, columns - first), needed);
    });
}

/// Rows of TileRows columns are tiles too: zeros fill up a panel of fewer columns.
void SupernodalFactor::SolvePanel(
  Values& x, Index firstColumn, Index count, const std::vector<char>& needed) const
{
  const Supernodes& nodes = this->Nodes;
  const auto n = static_cast<Index>(x.rows());
  Buffer<double> w((static_cast<std::size_t>(n) + TileRows) * TileRows);
  const auto row = [&](Index place)
  { return w.data() + static_cast<std::ptrdiff_t>(place) * TileRows; };
  std::fill_n(row(n), TileSize, 0.0); // read with factors 0
  for (Index i = 0; i < n; ++i)
  {
    double* const to = row(nodes.Place[i]);
    std::fill_n(to, TileRows, 0.0);
    std::copy_n(&x(i, firstColumn), count, to);
  }
  std::vector<double> below;
  constexpr std::size_t rowSize = TileRows * sizeof(double);
  for (Index s = 0; s < nodes.Count(); ++s)
  {
    const Index k = nodes.Pivots(s);
    const Index r = nodes.RowsBelow(s);
    const Index* const rows = nodes.Below(s);
    const std::ptrdiff_t tile = this->TileStride(s);
    const double* l = this->Panel(s);
    double* const known = row(nodes.First[s]);
    if (std::all_of(known, row(nodes.First[s + 1]), [](double number) { return number == 0.0; }))
    {
      continue;
    }
    for (Index j = 0; j < k; j += TileRows, l += tile)
    {
      const Index width = std::min(TileRows, k - j);
      double* const own = known + j * TileRows;
      SubtractTileProducts(known, 0, l, j, own, 0, 1, width);
      SolveTriangle(l + j * TileRows, width, false, own);
    }
    below.resize(static_cast<std::size_t>(this->TilesBelow(s)) * TileSize);
    for (Index i = 0; i < r; ++i)
    {
      std::memcpy(below.data() + static_cast<std::ptrdiff_t>(i) * TileRows, row(rows[i]), rowSize);
    }
    for (Index t = 0; t < this->TilesBelow(s); ++t, l += tile)
    {
      SubtractTileProducts(known, 0, l, k, &below[static_cast<std::size_t>(t * TileSize)], 0, 1);
    }
    for (Index i = 0; i < r; ++i)
    {
      std::memcpy(row(rows[i]), below.data() + static_cast<std::ptrdiff_t>(i) * TileRows, rowSize);
    }
  }
  for (Index s = nodes.Count() - 1; s >= 0; --s)
  {
    if (!needed.empty() && !needed[s])
    {
      continue;
    }
    const Index k = nodes.Pivots(s);
    const Index r = nodes.RowsBelow(s);
    const Index* const rows = nodes.Below(s);
    const std::ptrdiff_t tile = this->TileStride(s);
    const Index diagonal = this->DiagonalTiles(s);
    const double* const panel = this->Panel(s);
    double* const unknown = row(nodes.First[s]);
    below.assign(static_cast<std::size_t>(this->TilesBelow(s)) * TileSize, 0.0);
    for (Index i = 0; i < r; ++i)
    {
      std::memcpy(below.data() + static_cast<std::ptrdiff_t>(i) * TileRows, row(rows[i]), rowSize);
    }
    for (Index t = 0; t < this->TilesBelow(s); ++t)
    {
      SubtractTransposedProduct(
        panel + (diagonal + t) * tile, k, &below[static_cast<std::size_t>(t * TileSize)], unknown);
    }
    for (Index t = diagonal - 1; t >= 0; --t)
    {
      const Index j = t * TileRows;
      SolveTriangle(
        panel + t * tile + j * TileRows, std::min(TileRows, k - j), true, unknown + j * TileRows);
      SubtractTransposedProduct(panel + t * tile, j, unknown + j * TileRows, unknown);
    }
  }
  for (Index i = 0; i < n; ++i)
  {
    std::copy_n(row(nodes.Place[i]), count, &x(i, firstColumn));
  }
}

} // namespace SurfaceDiffusion
