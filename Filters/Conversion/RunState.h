// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceDiffusionAlgorithm.h"

#include "Conversion/BlockInputs.h"
#include "Conversion/SMPParallelFor.h"
#include "Run/Outputs.h"
#include "Run/OwnedSettings.h"
#include "Run/Run.h"

#include "vtkDataArray.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkTable.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// The state of vtkSurfaceDiffusionAlgorithm that its header hides.
struct vtkSurfaceDiffusionAlgorithm::RunState
{
  SurfaceDiffusion::Run Run{ SurfaceDiffusion::SMPParallelFor::Instance() };
  SurfaceDiffusion::BlockInputs Inputs;

  /// Normals computed for blocks without any, by the surface that they belong to.
  struct ComputedNormals
  {
    SurfaceDiffusion::Fingerprint SurfaceVersion;
    vtkSmartPointer<vtkDataArray> Array;
    bool Used = true; ///< in the current update
  };
  std::vector<ComputedNormals> Normals;
  /// At the end of an update.
  void ForgetUnusedNormals()
  {
    this->Normals.erase(std::remove_if(this->Normals.begin(), this->Normals.end(),
                          [](const ComputedNormals& computed) { return !computed.Used; }),
      this->Normals.end());
    for (ComputedNormals& computed : this->Normals)
    {
      computed.Used = false; // until the next update
    }
  }

  /// The last step of a run, which may have ended early, and the settings of that run.
  struct Length
  {
    SurfaceDiffusion::SettingsSnapshot Surface, Model;
    int NumberOfSteps = -1;
    int LastStep = -1;

    /// The last step of a run with these settings, as far as it is known.
    int Find(SurfaceDiffusion::TimeSettings& settings) const;
    /// Remember the last step. Returns whether it was another one.
    bool Set(SurfaceDiffusion::TimeSettings& settings, int last);
  } KnownLength;

  // Of one update:
  std::shared_ptr<SurfaceDiffusion::TimeSettings> Settings;
  SurfaceDiffusion::Problems SettingProblems;
  std::vector<SurfaceDiffusion::Sentence>
    InputWarnings; ///< about arrays that some blocks do not have
  std::vector<std::string> ReplacedArrays; ///< of the input, by results
  std::optional<double> Time; ///< the requested time
  int Step = 0; ///< the requested step
  int LastStep = -1; ///< of the run; -1 if it is not known
  SurfaceDiffusion::History History;
  vtkSmartPointer<vtkTable> Table; ///< null until the update has succeeded, in process 0
  vtkSmartPointer<vtkPolyData> Curves;
};
