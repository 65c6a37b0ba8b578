// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Parallel.h"

#include "vtkSMPTools.h"

#include <exception>
#include <mutex>

/// The core's loops on VTK's threads.
class SMPParallelFor : public SurfaceDiffusion::ParallelFor
{
public:
  using Index = SurfaceDiffusion::Index;
  using LoopBody = SurfaceDiffusion::LoopBody;

  void Run(Index count, LoopBody body) const override
  {
    // The std::thread backend starts its threads anew for every loop: short loops are faster alone.
    constexpr Index few = 24;
    if (count < few)
    {
      body(0, count);
      return;
    }
    // An exception that left a thread of VTK's would end the program (want of memory).
    std::exception_ptr failure;
    std::mutex ofFailure;
    const auto loop = [&](vtkIdType begin, vtkIdType end)
    {
      try
      {
        body(static_cast<Index>(begin), static_cast<Index>(end));
      }
      catch (...)
      {
        const std::lock_guard<std::mutex> lock(ofFailure);
        failure = std::current_exception();
      }
    };
    vtkSMPTools::For(0, count, loop);
    if (failure)
    {
      std::rethrow_exception(failure);
    }
  }

  /// The core keeps references: one object for all.
  static const SMPParallelFor& Instance()
  {
    static const SMPParallelFor instance;
    return instance;
  }
};
