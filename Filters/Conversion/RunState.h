// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceDiffusionAlgorithm.h"

#include "Conversion/BlockInputs.h"
#include "Conversion/SMPParallelFor.h"
#include "Run/Run.h"

#include <memory>
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

  // Of one update:
  std::shared_ptr<SurfaceDiffusion::RunSettings> Settings;
  std::vector<std::string> SettingProblems;
  std::vector<std::string> InputWarnings; ///< about arrays that some blocks do not have
  std::vector<std::string> ReplacedArrays; ///< of the input, by results
  int Step = 0; ///< the requested step
  SurfaceDiffusion::History History;
  bool Succeeded = false;
};
