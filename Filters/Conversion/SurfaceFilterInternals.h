// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceFilter.h"

#include "Conversion/SMPParallelFor.h"
#include "Distributed/GatheredSurfaces.h"
#include "Distributed/SharedProcessGroup.h"
#include "Distributed/SurfacePieces.h"
#include "Run/WarningLog.h"

#include "vtkCallbackCommand.h"
#include "vtkExecutive.h"
#include "vtkNew.h"
#include "vtkOutputWindow.h"
#include "vtkTimeStamp.h"
#include "vtkWeakPointer.h"

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

  bool HasFailed = false; ///< the last update, with an error that was reported
  vtkTimeStamp FailureTime;

  ~Internals()
  {
    if (this->Executive)
    {
      this->Executive->RemoveObserver(this->Quiet);
    }
  }

  /// Leave out the next error of the executive, that the filter has failed, with all entries of the
  /// request: the filter has said why. Other errors are displayed as before.
  void QuietExecutive(vtkExecutive* executive)
  {
    if (!executive->HasObserver(vtkCommand::ErrorEvent))
    {
      this->Executive = executive;
      this->Quiet->SetClientData(&this->IsQuiet);
      this->Quiet->SetCallback(
        [](vtkObject*, unsigned long, void* isQuiet, void* text)
        {
          const auto* const sentence = static_cast<const char*>(text);
          if (!*static_cast<bool*>(isQuiet) && sentence)
          {
            vtkOutputWindowDisplayErrorText(sentence);
          }
          *static_cast<bool*>(isQuiet) = false;
        });
      executive->AddObserver(vtkCommand::ErrorEvent, this->Quiet);
    }
    this->IsQuiet = true;
  }

private:
  vtkNew<vtkCallbackCommand> Quiet;
  vtkWeakPointer<vtkExecutive> Executive; ///< that the command observes
  bool IsQuiet = false;
};
