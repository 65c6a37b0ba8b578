// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Parallel.h"

#include "vtkSMPTools.h"

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
    const auto loop = [&body](vtkIdType begin, vtkIdType end)
    { body(static_cast<Index>(begin), static_cast<Index>(end)); };
    vtkSMPTools::For(0, count, loop);
  }

  /// The core keeps references: one object for all.
  static const SMPParallelFor& Instance()
  {
    static const SMPParallelFor instance;
    return instance;
  }
};
