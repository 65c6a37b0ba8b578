// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SupernodalFactor.h"

#include <algorithm>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

/// Subtrees that are small parts of all run beside each other, in tasks of several if they are very
/// small, and what is above them in order.
struct Schedule
{
  struct Task
  {
    std::vector<Index> Roots;
    double Operations = 0.0;
  };
  std::vector<Task> Tasks;
  std::vector<Index> Top; ///< supernodes
  double Operations; ///< of all

  explicit Schedule(const Supernodes& nodes)
    : Operations(std::accumulate(nodes.Operations.begin(), nodes.Operations.end(), 0.0))
  {
    const double largestSubtree = this->Operations / 24.0;
    const double smallestTask = this->Operations / 384.0;
    std::vector<double> below = nodes.Operations;
    for (Index s = 0; s < nodes.Count(); ++s)
    {
      if (nodes.Parent[s] >= 0)
      {
        below[nodes.Parent[s]] += below[s];
      }
    }
    for (Index s = 0; s < nodes.Count(); ++s)
    {
      const Index parent = nodes.Parent[s];
      if (below[s] > largestSubtree)
      {
        this->Top.push_back(s);
      }
      else if (parent < 0 || below[parent] > largestSubtree)
      {
        if (this->Tasks.empty() || this->Tasks.back().Operations > smallestTask)
        {
          this->Tasks.emplace_back();
        }
        this->Tasks.back().Roots.push_back(s);
        this->Tasks.back().Operations += below[s];
      }
    }
  }
};

/// An order cannot be stopped: it is found with data of its own, and an abort drops it.
Supernodes Order(const SparseMatrix& matrix, bool isRegular, const ProgressMonitor& progress)
{
  constexpr Eigen::Index quick = 5000; // rows, whose order is not worth a thread
  if (matrix.rows() == 0)
  {
    return {};
  }
  if (matrix.rows() < quick)
  {
    return OrderedSupernodes(matrix, isRegular);
  }
  struct Task
  {
    SparseMatrix Matrix;
    Supernodes Nodes;
  };
  const auto task = std::make_shared<Task>(Task{ matrix, {} });
  RunInBackground(
    [task, isRegular] { task->Nodes = OrderedSupernodes(task->Matrix, isRegular); }, progress);
  return std::move(task->Nodes);
}

} // namespace

PivotCounts SupernodalFactor::Compute(const SparseMatrix& matrix, bool isRegular, double resolved,
  const ParallelFor& parallel, const ProgressMonitor& progress)
{
  const auto n = static_cast<Index>(matrix.rows());
  const Index* const outer = matrix.outerIndexPtr();
  const Index* const inner = matrix.innerIndexPtr();
  const std::vector<Index> outerNow(outer, outer + n + 1);
  const bool isKnown = outerNow == this->Outer &&
    std::equal(this->Inner.begin(), this->Inner.end(), inner, inner + outer[n]);
  if (!isKnown)
  {
    this->Outer.clear(); // until the order is complete
    this->Entries = Buffer<double>();
    this->Nodes = Order(matrix, isRegular, progress.Part(0.0, 0.5));
    this->Begin.assign(1, 0);
    for (Index s = 0; s < this->Nodes.Count(); ++s)
    {
      const auto tiles = static_cast<std::size_t>(this->DiagonalTiles(s) + this->TilesBelow(s));
      this->Begin.push_back(this->Begin.back() +
        tiles * static_cast<std::size_t>(TileRows) *
          static_cast<std::size_t>(this->Nodes.Pivots(s)));
    }
    this->Inner.assign(inner, inner + outer[n]);
    this->Outer = outerNow;
  }
  if (this->Entries.size() != this->Begin.back())
  {
    this->Entries = Buffer<double>(this->Begin.back());
  }
  const Supernodes& nodes = this->Nodes;
  Vector smallest(n);
  for (Index i = 0; i < n; ++i)
  {
    smallest[nodes.Place[i]] = resolved * matrix.coeff(i, i);
  }

  const Schedule schedule(nodes);
  const Index count = nodes.Count();
  std::vector<Update> updates(count);
  std::vector<PivotCounts> pivots(count);
  double done = 0.0;
  const ProgressMonitor ofFactor = progress.Part(isKnown ? 0.0 : 0.5, 1.0);
  const double all = schedule.Operations;
  const auto report = [&] { ofFactor.Report(all > 0.0 ? std::min(1.0, done / all) : 1.0); };
  constexpr Index batch = 16;
  const auto numberOfTasks = static_cast<Index>(schedule.Tasks.size());
  for (Index begin = 0; begin < numberOfTasks; begin += batch)
  {
    report();
    const Index size = std::min(batch, numberOfTasks - begin);
    ForEachTask(parallel, size,
      [&](Index number)
      {
        for (const Index root : schedule.Tasks[begin + number].Roots)
        {
          for (Index s = nodes.FirstDescendant[root]; s <= root; ++s)
          {
            this->FactorizeNode(matrix, smallest, s, updates, pivots[s], SerialFor());
          }
        }
      });
    for (Index number = begin; number < begin + size; ++number)
    {
      done += schedule.Tasks[number].Operations;
    }
  }
  for (const Index s : schedule.Top)
  {
    report();
    this->FactorizeNode(matrix, smallest, s, updates, pivots[s], parallel);
    done += nodes.Operations[s];
  }
  progress.Report(1.0);
  PivotCounts total;
  for (const PivotCounts& ofNode : pivots)
  {
    total.Add(ofNode);
  }
  return total;
}

void SupernodalFactor::CopyColumn(Index s, Index p, double* entries) const
{
  const std::ptrdiff_t stride = this->TileStride(s);
  const double* tile = this->Panel(s) + static_cast<std::ptrdiff_t>(p) * TileRows;
  const auto copy = [&](Index count)
  {
    for (Index i = 0; i < count; i += TileRows, tile += stride)
    {
      entries = std::copy_n(tile, std::min(TileRows, count - i), entries);
    }
  };
  copy(this->Nodes.Pivots(s));
  copy(this->Nodes.RowsBelow(s));
}

} // namespace SurfaceDiffusion
