// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SupernodalFactor.h"

#include <algorithm>
#include <cstring>

namespace SurfaceDiffusion
{

void SupernodalFactor::Solve(Values& x, const ParallelFor& parallel) const
{
  const auto columns = static_cast<Index>(x.cols());
  ForEachTask(parallel, NumberOfTiles(columns),
    [&](Index panel)
    {
      const Index first = panel * TileRows;
      this->SolvePanel(x, first, std::min(TileRows, columns - first));
    });
}

/// Rows of TileRows columns are tiles too: zeros fill up a panel of fewer columns.
void SupernodalFactor::SolvePanel(Values& x, Index firstColumn, Index count) const
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
    const std::ptrdiff_t tile = static_cast<std::ptrdiff_t>(TileRows) * k;
    const double* l = this->Panel(s);
    double* const known = row(nodes.First[s]);
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
    const Index k = nodes.Pivots(s);
    const Index r = nodes.RowsBelow(s);
    const Index* const rows = nodes.Below(s);
    const std::ptrdiff_t tile = static_cast<std::ptrdiff_t>(TileRows) * k;
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
