// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/KrylovBasis.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index Halves = KrylovBasis::BlockColumns / TileRows;
constexpr std::ptrdiff_t BlockTile =
  static_cast<std::ptrdiff_t>(KrylovBasis::BlockColumns) * TileRows;

/// Partial sums of fixed rows, whose order of addition does not depend on the threads.
constexpr Index MostTasks = 32;

} // namespace

Index KrylovBasis::NumberOfTasks() const
{
  return std::clamp((this->Rows + ChunkRows - 1) / ChunkRows, Index{ 1 }, MostTasks);
}

/// work(task, first row, end row) on chunks of whole tiles, those of a task in order.
template <typename Work>
void KrylovBasis::ForEachChunk(const Work& work) const
{
  const Index chunks = (this->Rows + ChunkRows - 1) / ChunkRows;
  const Index tasks = this->NumberOfTasks();
  ForEachTask(this->Parallel, tasks,
    [&](Index task)
    {
      const auto bound = [&](Index t)
      { return static_cast<Index>(static_cast<std::int64_t>(chunks) * t / tasks); };
      for (Index chunk = bound(task); chunk < bound(task + 1); ++chunk)
      {
        work(task, chunk * ChunkRows, std::min(this->Rows, (chunk + 1) * ChunkRows));
      }
    });
}

KrylovBasis::Coefficients KrylovBasis::Project(Values& w, Index first) const
{
  const auto count = static_cast<Index>(this->Blocks.size());
  const Index firstBlock = first / BlockColumns;
  const Index rows = (count - firstBlock) * BlockColumns;
  Coefficients sum = Coefficients::Zero(rows, BlockColumns);
  if (rows == 0)
  {
    return sum;
  }
  using Chunk = std::array<double, static_cast<std::size_t>(ChunkRows * BlockColumns)>;
  // The rows of a chunk in halves of TileRows columns: rows of tiles, one after another.
  const auto load = [&](Index begin, Index end, Chunk& chunk)
  {
    chunk.fill(0.0);
    for (Index i = begin; i < end; ++i)
    {
      for (Index h = 0; h < Halves; ++h)
      {
        std::copy_n(&w(i, h * TileRows), TileRows, &chunk[(h * ChunkRows + i - begin) * TileRows]);
      }
    }
  };
  const auto size = static_cast<std::size_t>(rows) * BlockColumns;
  const Index tasks = this->NumberOfTasks();
  // Per task: -V^T W, for each block and each half of the columns of W
  std::vector<double> partial(size * static_cast<std::size_t>(tasks), 0.0);
  this->ForEachChunk(
    [&](Index task, Index begin, Index end)
    {
      Chunk chunk;
      load(begin, end, chunk);
      double* const c = partial.data() + static_cast<std::size_t>(task) * size;
      for (Index q = firstBlock; q < count; ++q)
      {
        double* const ofBlock = c + (q - firstBlock) * Halves * BlockTile;
        for (Index i = begin; i < end; i += TileRows)
        {
          const double* const v =
            this->Blocks[q].data() + static_cast<std::size_t>(i / TileRows) * BlockTile;
          for (Index h = 0; h < Halves; ++h)
          {
            SubtractTransposedProduct(v, BlockColumns,
              &chunk[(h * ChunkRows + i - begin) * TileRows], ofBlock + h * BlockTile);
          }
        }
      }
    });
  std::vector<double> products(size, 0.0); // V^T W
  for (Index task = 0; task < tasks; ++task)
  {
    const double* const c = partial.data() + static_cast<std::size_t>(task) * size;
    for (std::size_t k = 0; k < size; ++k)
    {
      products[k] -= c[k];
    }
  }
  this->ForEachChunk(
    [&](Index, Index begin, Index end)
    {
      Chunk chunk;
      load(begin, end, chunk);
      for (Index q = firstBlock; q < count; ++q)
      {
        const double* const c =
          products.data() + static_cast<std::size_t>(q - firstBlock) * Halves * BlockTile;
        for (Index i = begin; i < end; i += TileRows)
        {
          const double* const v =
            this->Blocks[q].data() + static_cast<std::size_t>(i / TileRows) * BlockTile;
          for (Index h = 0; h < Halves; ++h)
          {
            SubtractTileProducts(c + h * BlockTile, 0, v, BlockColumns,
              &chunk[(h * ChunkRows + i - begin) * TileRows], 0, 1);
          }
        }
      }
      for (Index i = begin; i < end; ++i)
      {
        for (Index h = 0; h < Halves; ++h)
        {
          std::copy_n(
            &chunk[(h * ChunkRows + i - begin) * TileRows], TileRows, &w(i, h * TileRows));
        }
      }
    });
  for (Index q = 0; q < count - firstBlock; ++q)
  {
    for (Index p = 0; p < BlockColumns; ++p)
    {
      for (Index h = 0; h < Halves; ++h)
      {
        const double* const from =
          products.data() + static_cast<std::size_t>((q * Halves + h) * BlockTile + p * TileRows);
        std::copy_n(from, TileRows, &sum(q * BlockColumns + p, h * TileRows));
      }
    }
  }
  return sum;
}

void KrylovBasis::Append(const Values& w)
{
  Buffer<double> block(static_cast<std::size_t>(NumberOfTiles(this->Rows)) * BlockTile);
  this->ForEachChunk(
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; i += TileRows)
      {
        double* const tile = block.data() + static_cast<std::size_t>(i / TileRows) * BlockTile;
        for (Index p = 0; p < BlockColumns; ++p)
        {
          for (Index row = 0; row < TileRows; ++row)
          {
            tile[p * TileRows + row] = i + row < end ? w(i + row, p) : 0.0;
          }
        }
      }
    });
  this->Blocks.push_back(std::move(block));
}

Values KrylovBasis::Combine(const Eigen::Ref<const Eigen::MatrixXd>& c) const
{
  const auto columns = static_cast<Index>(c.cols());
  const Index panels = NumberOfTiles(columns);
  const auto count = static_cast<Index>(this->Blocks.size());
  // -C in panels of TileRows columns: row p of a panel has TileRows numbers.
  const auto size = static_cast<std::size_t>(this->NumberOfColumns()) * TileRows;
  std::vector<double> negative(size * static_cast<std::size_t>(panels), 0.0);
  for (Index k = 0; k < columns; ++k)
  {
    double* const to = negative.data() + static_cast<std::size_t>(k / TileRows) * size;
    for (Index p = 0; p < this->NumberOfColumns(); ++p)
    {
      to[p * TileRows + k % TileRows] = -c(p, k);
    }
  }
  Values result(this->Rows, columns);
  this->ForEachChunk(
    [&](Index, Index begin, Index end)
    {
      std::array<double, static_cast<std::size_t>(ChunkRows * TileRows)> chunk;
      for (Index panel = 0; panel < panels; ++panel)
      {
        chunk.fill(0.0);
        const double* const ofPanel = negative.data() + static_cast<std::size_t>(panel) * size;
        for (Index q = 0; q < count; ++q)
        {
          for (Index i = begin; i < end; i += TileRows)
          {
            SubtractTileProducts(ofPanel + q * BlockTile, 0,
              this->Blocks[q].data() + static_cast<std::size_t>(i / TileRows) * BlockTile,
              BlockColumns, &chunk[(i - begin) * TileRows], 0, 1);
          }
        }
        const Index width = std::min(TileRows, columns - panel * TileRows);
        for (Index i = begin; i < end; ++i)
        {
          std::copy_n(&chunk[(i - begin) * TileRows], width, &result(i, panel * TileRows));
        }
      }
    });
  return result;
}

} // namespace SurfaceDiffusion
