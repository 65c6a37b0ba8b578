// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceModelAlgorithm.h"

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
#include <functional>
#include <memory>
#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
/// The state of vtkSurfaceModelAlgorithm that its header hides.
struct vtkSurfaceModelAlgorithm::UpdateState
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

  // Of one update:
  std::shared_ptr<SurfaceDiffusion::RunSettings> Settings;
  SurfaceDiffusion::Problems SettingProblems;
  std::vector<SurfaceDiffusion::Sentence>
    InputWarnings; ///< about arrays that some blocks do not have
  std::vector<SurfaceDiffusion::Sentence> TimeWarnings; ///< about the times of the input
  std::vector<std::string> ReplacedArrays; ///< of the input, by results
  /// The step of the output in a run that ends at step `last`; null: the last one.
  std::function<int(int last)> ChooseStep;
  int Step = 0; ///< of the output
  SurfaceDiffusion::History History;
  vtkSmartPointer<vtkTable> Table; ///< null until the update has succeeded, in process 0
  vtkSmartPointer<vtkPolyData> Curves;
};
VTK_ABI_NAMESPACE_END
