// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceFilter.h"

#include "Conversion/PieceRefinement.h"
#include "Conversion/RunNumbers.h"
#include "Conversion/SMPParallelFor.h"
#include "Distributed/GatheredSurfaces.h"
#include "Distributed/ProcessReduction.h"
#include "Distributed/SurfacePieces.h"
#include "Run/Fingerprint.h"
#include "Run/OwnedSettings.h"
#include "Run/WarningLog.h"

#include "vtkCallbackCommand.h"
#include "vtkExecutive.h"
#include "vtkNew.h"
#include "vtkOutputWindow.h"
#include "vtkWeakPointer.h"

#include <cstring>
#include <memory>
#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
/// The state of vtkSurfaceFilter that its header hides.
struct vtkSurfaceFilter::Internals
{
  SurfaceDiffusion::OwnedSettings Properties;

  SurfaceDiffusion::RunNumbers Numbers;

  std::unique_ptr<SurfaceDiffusion::GatheredSurfaces> Gathered;
  SurfaceDiffusion::WarningLog Reported;

  /// During an update: what messages say about the input.
  SurfaceDiffusion::InputDescription Input;

  /// During an update: the processes, if each works on its piece; otherwise null.
  std::unique_ptr<SurfaceDiffusion::ProcessReduction> Processes;
  SurfaceDiffusion::LoopWatch* Watch = nullptr;
  /// Whether an abort was requested. Processes that work together stop together.
  const std::shared_ptr<bool> AbortRequested = std::make_shared<bool>(false);

  SurfaceDiffusion::PieceRefinement Refinement;
  std::vector<SurfaceDiffusion::Sentence> RefinementWarnings; ///< of the present update
  std::vector<SurfaceDiffusion::Sentence> HiddenWarnings; ///< likewise, of surfaces without cells
  bool IsComplete = true; ///< the present update, neither failed nor aborted

  bool HasFailed = false; ///< the last update, with an error that was reported
  SurfaceDiffusion::Fingerprint FailedWith; ///< what the filter read then

  ~Internals()
  {
    if (this->Observed)
    {
      this->Observed->RemoveObserver(this->Quiet);
    }
  }

  /// Leave out the next error of the executive, that the filter has failed, with all entries of the
  /// request: the filter has said why.
  void QuietExecutive(vtkExecutive* executive)
  {
    this->Observed = executive;
    this->Quiet->SetCallback(
      [](vtkObject* caller, unsigned long, void* command, void* text)
      {
        auto* const quiet = static_cast<vtkCallbackCommand*>(command);
        caller->RemoveObserver(quiet);
        const auto* const sentence = static_cast<const char*>(text);
        if (sentence && std::strstr(sentence, "returned failure for request"))
        {
          quiet->SetAbortFlag(1); // for observers after this one
        }
        else if (sentence)
        {
          vtkOutputWindowDisplayErrorText(sentence);
        }
      });
    this->Quiet->SetClientData(this->Quiet);
    executive->RemoveObserver(this->Quiet);
    executive->AddObserver(vtkCommand::ErrorEvent, this->Quiet, VTK_FLOAT_MAX);
  }

private:
  vtkNew<vtkCallbackCommand> Quiet;
  vtkWeakPointer<vtkExecutive> Observed;
};
VTK_ABI_NAMESPACE_END
