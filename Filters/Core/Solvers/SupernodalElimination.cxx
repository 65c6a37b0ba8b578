// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/DenseTiles.h"
#include "Core/Solvers/SupernodalFactor.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// The tile of row I and column J <= I of a symmetric matrix.
std::ptrdiff_t TileOf(Index row, Index column)
{
  return (static_cast<std::ptrdiff_t>(row) * (row + 1) / 2 + column) * TileSize;
}

std::size_t UpdateSize(Index rows)
{
  const Index tiles = NumberOfTiles(rows);
  return static_cast<std::size_t>(TileOf(tiles, 0));
}

/// Call body(first, last) for parts of [0, count) on all threads, if `operations` are worth it.
template <typename Body>
void ForParts(const ParallelFor& parallel, Index count, double operations, const Body& body)
{
  constexpr double few = 1e6;
  if (operations < few)
  {
    body(0, count);
    return;
  }
  const Index parts = std::min<Index>(count, 16);
  ForEachTask(parallel, parts,
    [&](Index part)
    {
      const auto at = [&](Index p)
      { return static_cast<Index>(static_cast<std::ptrdiff_t>(count) * p / parts); };
      body(at(part), at(part + 1));
    });
}

} // namespace

void SupernodalFactor::FactorizeNode(const SparseMatrix& matrix, const Vector& smallest, Index s,
  std::vector<Update>& updates, PivotCounts& pivots, const ParallelFor& parallel)
{
  const Supernodes& nodes = this->Nodes;
  const Index first = nodes.First[s];
  const Index k = nodes.Pivots(s);
  const Index r = nodes.RowsBelow(s);
  const Index* const rows = nodes.Below(s);
  double* const panel = this->Panel(s);
  std::fill(panel, this->Panel(s + 1), 0.0);
  const std::ptrdiff_t tile = this->TileStride(s);
  double* const panelBelow = panel + this->DiagonalTiles(s) * tile;
  for (Index p = 0; p < k; ++p)
  {
    for (SparseMatrix::InnerIterator a(matrix, nodes.RowAt[first + p]); a; ++a)
    {
      const Index place = nodes.Place[a.index()];
      if (place >= first + k)
      {
        const auto row = static_cast<Index>(std::lower_bound(rows, rows + r, place) - rows);
        panelBelow[row / TileRows * tile + p * TileRows + row % TileRows] = a.value();
      }
      else if (place >= first + p)
      {
        const Index row = place - first;
        panel[row / TileRows * tile + p * TileRows + row % TileRows] = a.value();
      }
    }
  }
  double* own = nullptr;
  if (r > 0)
  {
    const std::size_t size = UpdateSize(r);
    updates[s] = Update(new double[size]);
    own = updates[s].get();
    std::fill_n(own, size, 0.0);
  }
  for (Index c = nodes.ChildrenBegin[s]; c < nodes.ChildrenBegin[s + 1]; ++c)
  {
    const Index child = nodes.Children[c];
    if (updates[child])
    {
      this->AddChild(s, child, updates[child].get(), own);
      updates[child].reset();
    }
  }
  pivots = this->EliminatePivots(s, smallest.data() + first, parallel);

  // Tiles (I, J) of the update, in blocks that stay in the cache.
  constexpr Index depthBlock = 256;
  constexpr Index tileBlock = 12;
  const Index tiles = this->TilesBelow(s);
  const auto update = [&](Index firstTile, Index lastTile)
  {
    for (Index p = 0; p < k; p += depthBlock)
    {
      const Index depth = std::min(depthBlock, k - p);
      for (Index block = 0; block < lastTile; block += tileBlock)
      {
        for (Index i = std::max(block, firstTile); i < lastTile; ++i)
        {
          const double* const left = panelBelow + i * tile + p * TileRows;
          for (Index j = block; j < std::min(block + tileBlock, i + 1); ++j)
          {
            SubtractTileProducts(
              left, 0, panelBelow + j * tile + p * TileRows, depth, own + TileOf(i, j), 0, 1);
          }
        }
      }
    }
  };
  // Equal work: the tiles of row I are I + 1.
  constexpr Index parts = 12;
  if (static_cast<double>(k) * r * r < 4e6)
  {
    update(0, tiles);
    return;
  }
  ForEachTask(parallel, parts,
    [&](Index part)
    {
      const auto at = [&](Index p)
      { return static_cast<Index>(tiles * std::sqrt(static_cast<double>(p) / parts)); };
      update(at(part), part + 1 == parts ? tiles : at(part + 1));
    });
}

/// Add the update of a child to the panel and the update of s.
void SupernodalFactor::AddChild(Index s, Index child, const double* update, double* own) const
{
  const Supernodes& nodes = this->Nodes;
  const Index first = nodes.First[s];
  const Index k = nodes.Pivots(s);
  const Index count = nodes.RowsBelow(child);
  const Index* const childRows = nodes.Below(child);
  const Index* const rows = nodes.Below(s);
  std::vector<Index> place(static_cast<std::size_t>(count)); // in the front of s
  Index inPivots = 0;
  for (Index i = 0, at = 0; i < count; ++i)
  {
    if (childRows[i] < first + k)
    {
      place[i] = childRows[i] - first;
      inPivots = i + 1;
      continue;
    }
    while (rows[at] < childRows[i])
    {
      ++at;
    }
    place[i] = at;
  }
  auto* const panel = const_cast<double*>(this->Panel(s));
  const std::ptrdiff_t tile = this->TileStride(s);
  double* const panelBelow = panel + this->DiagonalTiles(s) * tile;
  for (Index i = 0; i < count; ++i)
  {
    const double* const from = update + TileOf(i / TileRows, 0) + i % TileRows;
    const Index row = place[i];
    double* const to = (i < inPivots ? panel : panelBelow) + row / TileRows * tile + row % TileRows;
    const Index ofPivots = std::min(i + 1, inPivots);
    // Entry (i, j) of a row of tiles is at TileRows * j: tiles follow each other.
    for (Index j = 0; j < ofPivots; ++j)
    {
      to[place[j] * TileRows] += from[static_cast<std::ptrdiff_t>(j) * TileRows];
    }
    if (i >= inPivots)
    {
      double* const toUpdate = own + TileOf(row / TileRows, 0) + row % TileRows;
      for (Index j = inPivots; j <= i; ++j)
      {
        toUpdate[static_cast<std::ptrdiff_t>(place[j]) * TileRows] +=
          from[static_cast<std::ptrdiff_t>(j) * TileRows];
      }
    }
  }
}

/// The panel of s becomes that of L.
PivotCounts SupernodalFactor::EliminatePivots(
  Index s, const double* smallest, const ParallelFor& parallel)
{
  constexpr Index blockTiles = 8;
  const Index k = this->Nodes.Pivots(s);
  const Index diagonal = this->DiagonalTiles(s);
  const Index tiles = diagonal + this->TilesBelow(s);
  const std::ptrdiff_t tile = this->TileStride(s);
  double* const panel = this->Panel(s);
  PivotCounts pivots;
  const auto width = [&](Index j) { return std::min(TileRows, k - j * TileRows); };
  for (Index block = 0; block < diagonal; block += blockTiles)
  {
    const Index end = std::min(diagonal, block + blockTiles);
    const std::ptrdiff_t columns = block * TileSize; // of the blocks before, in a tile
    // The columns of the blocks before act on all rows of this block at once,
    const auto apply = [&](Index from, Index to)
    {
      for (Index i = from; i < to; ++i)
      {
        for (Index j = block; j < std::min(end, i + 1); ++j)
        {
          SubtractTileProducts(panel + i * tile, 0, panel + j * tile, block * TileRows,
            panel + i * tile + j * TileSize, 0, 1, width(j));
        }
      }
    };
    // and those of the block one tile after the other.
    const auto eliminate = [&](Index from, Index to)
    {
      for (Index j = block; j < end; ++j)
      {
        const std::ptrdiff_t at = j * TileSize;
        const Index begin = std::max(from, j + 1);
        if (begin >= to)
        {
          continue;
        }
        SubtractTileProducts(panel + begin * tile + columns, tile, panel + j * tile + columns,
          (j - block) * TileRows, panel + begin * tile + at, tile, to - begin, width(j));
        SolveTiles(panel + j * tile + at, width(j), panel + begin * tile + at, tile, to - begin);
      }
    };
    apply(block, end);
    for (Index j = block; j < end; ++j)
    {
      // The row of tiles j: its columns before j, and its own tile.
      const std::ptrdiff_t at = j * TileSize;
      for (Index q = block; q < j; ++q)
      {
        SubtractTileProducts(panel + j * tile + columns, 0, panel + q * tile + columns,
          (q - block) * TileRows, panel + j * tile + q * TileSize, 0, 1, width(q));
        SolveTiles(
          panel + q * tile + q * TileSize, width(q), panel + j * tile + q * TileSize, 0, 1);
      }
      SubtractTileProducts(panel + j * tile + columns, 0, panel + j * tile + columns,
        (j - block) * TileRows, panel + j * tile + at, 0, 1, width(j));
      pivots.Add(FactorizeTile(panel + j * tile + at, width(j), smallest + j * TileRows));
    }
    ForParts(parallel, tiles - end,
      static_cast<double>(tiles - end) * TileSize * (end - block) * block * TileRows,
      [&](Index from, Index to)
      {
        apply(end + from, end + to);
        eliminate(end + from, end + to);
      });
  }
  return pivots;
}

} // namespace SurfaceDiffusion
