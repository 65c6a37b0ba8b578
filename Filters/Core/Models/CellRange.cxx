// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/CellRange.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

/// (P* u)_c of a column.
double MeanOver(const CellTransfer& cells, Index cell, const Values& state, Eigen::Index column)
{
  return cells.MeanOver(cell, [&](Index i) { return state(i, column); });
}

} // namespace

CellRange::CellRange(const TriangleMesh& mesh, const CellTransfer& cells, const Values& firstState,
  const Values& firstDetail, const ParallelFor& parallel)
  : Mesh(&mesh)
  , Cells(&cells)
  , Parallel(&parallel)
{
  for (Eigen::Index k = 0; k < firstDetail.cols(); ++k)
  {
    this->OfData.push_back(this->FindRange(
      [&](Index cell) { return MeanOver(cells, cell, firstState, k) + firstDetail(cell, k); }));
  }
}

/// The least and the largest f(cell) of the cells that take part.
template <typename F>
std::array<double, 2> CellRange::FindRange(const F& f)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Index count = this->Cells->NumberOfCells();
  this->OfBlocks.resize(static_cast<std::size_t>(NumberOfBlocks(count)));
  ForEachBlock(*this->Parallel, count,
    [&](Index block, Index begin, Index end)
    {
      std::array<double, 2> range{ infinity, -infinity };
      for (Index c = begin; c < end; ++c)
      {
        if (this->Cells->Participates(c))
        {
          const double value = f(c);
          range = { std::min(range[0], value), std::max(range[1], value) };
        }
      }
      this->OfBlocks[static_cast<std::size_t>(block)] = range;
    });
  double ends[2] = { -infinity, -infinity };
  for (const std::array<double, 2>& range : this->OfBlocks)
  {
    ends[0] = std::max(ends[0], -range[0]);
    ends[1] = std::max(ends[1], range[1]);
  }
  this->Mesh->GetReduction().Max(ends, 2);
  return { -ends[0], ends[1] };
}

void CellRange::Keep(
  const Values& state, const std::vector<char>& held, CellComponents& components, Values& detail)
{
  for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(this->OfData.size()); ++k)
  {
    this->KeepColumn(k, state, held, components, detail);
  }
}

void CellRange::KeepColumn(Eigen::Index column, const Values& state, const std::vector<char>& held,
  CellComponents& components, Values& detail)
{
  const std::array<double, 2>& ofData = this->OfData[static_cast<std::size_t>(column)];
  const std::array<double, 2> ofMeans =
    this->FindRange([&](Index cell) { return MeanOver(*this->Cells, cell, state, column); });
  const double low = std::min(ofData[0], ofMeans[0]);
  const double high = std::max(ofData[1], ofMeans[1]);
  const auto result = [&](Index cell)
  { return MeanOver(*this->Cells, cell, state, column) + detail(cell, column); };
  // What the cells have outside the range, with its sign and without, and the room within it.
  components.Sum(4,
    [&](Index cell, Eigen::Index k)
    {
      if (held[static_cast<std::size_t>(cell)] != 0)
      {
        return 0.0;
      }
      const double value = result(cell);
      const double within = std::clamp(value, low, high);
      const double parts[] = { value - within, std::abs(value - within), within - low,
        high - within };
      return this->Cells->CellAreas()[cell] * parts[k];
    });
  for (Index c = 0; c < components.Count(); ++c)
  {
    const double excess = components.SumOf(c, 0);
    const double room = components.SumOf(c, excess > 0.0 ? 3 : 2);
    if (!(components.SumOf(c, 1) > 0.0 && room > 0.0))
    {
      continue;
    }
    const double share = excess / room; // of its room that every cell takes
    const Index begin = components.Begin(c);
    ForEach(*this->Parallel, components.End(c) - begin,
      [&](Index k)
      {
        const Index cell = components.Cell(begin + k);
        if (held[static_cast<std::size_t>(cell)] == 0)
        {
          const double value = result(cell);
          const double within = std::clamp(value, low, high);
          detail(cell, column) +=
            within - value + share * (share > 0.0 ? high - within : within - low);
        }
      });
  }
}

} // namespace SurfaceDiffusion
