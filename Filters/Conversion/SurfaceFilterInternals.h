// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceFilter.h"

#include "Conversion/SMPParallelFor.h"
#include "Distributed/GatheredSurfaces.h"
#include "Distributed/SharedProcessGroup.h"
#include "Distributed/SurfacePieces.h"
#include "Run/WarningLog.h"

#include <memory>

/// The state of vtkSurfaceFilter that its header hides.
struct vtkSurfaceFilter::Internals
{
  std::unique_ptr<SurfaceDiffusion::GatheredSurfaces> Gathered;
  SurfaceDiffusion::WarningLog Reported;

  /// During an update: what messages say about the input.
  SurfaceDiffusion::InputDescription Input;

  /// During an update: the processes, if each works on its piece.
  std::unique_ptr<SurfaceDiffusion::SharedProcessGroup> Group;
  SurfaceDiffusion::LoopWatch* Watch = nullptr;
  /// Whether an abort was requested. Processes that work together stop together.
  const std::shared_ptr<bool> AbortRequested = std::make_shared<bool>(false);
};
