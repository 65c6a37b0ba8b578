// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Types.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <type_traits>
#include <utility>

namespace SurfaceDiffusion
{

/// A reference to a callable, which must outlive it. Unlike std::function it never allocates.
class LoopBody
{
public:
  template <typename F,
    typename = std::enable_if_t<!std::is_same<std::decay_t<F>, LoopBody>::value>>
  LoopBody(const F& f) // NOLINT(google-explicit-constructor): call sites pass lambdas
    : Callable(&f)
    , Call([](const void* c, Index begin, Index end) { (*static_cast<const F*>(c))(begin, end); })
  {
  }
  void operator()(Index begin, Index end) const { this->Call(this->Callable, begin, end); }

private:
  const void* Callable;
  void (*Call)(const void*, Index, Index);
};

/// The loop over which the numerics are parallel. This one is serial; the filters pass one that
/// runs on vtkSMPTools.
class ParallelFor
{
public:
  virtual ~ParallelFor() = default;

  /// Call body(begin, end) on ranges that together cover [0, count) once, in any order and on any
  /// threads.
  virtual void Run(Index count, LoopBody body) const { body(0, count); }

  /// The same for a few long tasks. Run() may take a short loop to be not worth its threads.
  virtual void RunTasks(Index count, LoopBody body) const { body(0, count); }

  /// The same task for another thread: its loops run there on as many threads as loops that start
  /// here.
  virtual std::function<void()> ForOtherThread(std::function<void()> task) const { return task; }
};

/// The serial loop: the default argument everywhere, which may be kept by reference.
inline const ParallelFor& SerialFor()
{
  static const ParallelFor serial;
  return serial;
}

/// Rows per block. Loops and sums are cut into these blocks for any number of threads, so that no
/// bit of a result depends on that number.
constexpr Index BlockSize = 2048;

inline Index NumberOfBlocks(Index count)
{
  return (count + BlockSize - 1) / BlockSize;
}

/// Call body(block, begin, end) for every block of [0, count).
template <typename Body>
void ForEachBlock(const ParallelFor& parallel, Index count, const Body& body)
{
  const auto blocks = [&](Index first, Index last)
  {
    for (Index block = first; block < last; ++block)
    {
      body(block, block * BlockSize, std::min(count, (block + 1) * BlockSize));
    }
  };
  const Index numberOfBlocks = NumberOfBlocks(count);
  constexpr Index fewBlocks = 2; // waking threads costs more than such a loop
  if (numberOfBlocks <= fewBlocks)
  {
    blocks(0, numberOfBlocks);
    return;
  }
  parallel.Run(numberOfBlocks, blocks);
}

/// Call body(i) for every i of [0, count).
template <typename Body>
void ForEach(const ParallelFor& parallel, Index count, const Body& body)
{
  ForEachBlock(parallel, count,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        body(i);
      }
    });
}

/// Call task(i) for every i of [0, count), where each call is worth a thread.
template <typename Task>
void ForEachTask(const ParallelFor& parallel, Index count, const Task& task)
{
  parallel.RunTasks(count,
    [&](Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        task(i);
      }
    });
}

/// The largest f(i) over [0, count) for f >= 0; 0 if count is 0.
template <typename F>
double Max(const ParallelFor& parallel, Index count, const F& f)
{
  std::atomic<double> largest{ 0.0 };
  ForEachBlock(parallel, count,
    [&](Index, Index begin, Index end)
    {
      double blockMax = 0.0;
      for (Index i = begin; i < end; ++i)
      {
        blockMax = std::max(blockMax, f(i));
      }
      double known = largest;
      while (blockMax > known && !largest.compare_exchange_weak(known, blockMax))
      {
      }
    });
  return largest;
}

/// The sum of f(i) over [0, count), block by block.
template <typename F>
double Sum(const ParallelFor& parallel, Index count, const F& f)
{
  // A fixed number of partial sums on the stack, so that time steps do not allocate.
  constexpr Index maxPartialSums = 1024;
  double total = 0.0;
  for (Index first = 0; first < count; first += maxPartialSums * BlockSize)
  {
    double partial[maxPartialSums];
    const Index chunk = std::min(count - first, maxPartialSums * BlockSize);
    ForEachBlock(parallel, chunk,
      [&](Index block, Index begin, Index end)
      {
        double sum = 0.0;
        for (Index i = begin; i < end; ++i)
        {
          sum += f(first + i);
        }
        partial[block] = sum;
      });
    for (Index block = 0; block < NumberOfBlocks(chunk); ++block)
    {
      total += partial[block];
    }
  }
  return total;
}

} // namespace SurfaceDiffusion
