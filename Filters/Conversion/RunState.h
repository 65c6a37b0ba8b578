// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceDiffusionAlgorithm.h"

#include "Conversion/FieldReader.h"
#include "Conversion/SMPParallelFor.h"
#include "Conversion/SurfaceReader.h"
#include "Distributed/PieceDecomposition.h"
#include "Run/Run.h"

#include <memory>
#include <vector>

/// The state of vtkSurfaceDiffusionAlgorithm that its header hides.
struct vtkSurfaceDiffusionAlgorithm::RunState
{
  SurfaceDiffusion::Run Run{ SurfaceDiffusion::SMPParallelFor::Instance() };
  /// Per block of the run: the cell of each triangle of its input.
  std::vector<std::vector<vtkIdType>> Cells;
  /// The decomposition of the surface over processes, if each works on its piece.
  std::unique_ptr<SurfaceDiffusion::PieceDecomposition> Decomposition;

  /// Per block: the hashes of the last update, and what they were computed from. Requests of other
  /// times need not hash the input again.
  struct Version
  {
    SurfaceDiffusion::InputStamp Stamp;
    bool Excludes = false;
    SurfaceDiffusion::Fingerprint Surface, Fields;
  };
  std::vector<Version> Versions;

  /// Normals computed for blocks without any, by the surface that they belong to.
  struct ComputedNormals
  {
    SurfaceDiffusion::Fingerprint SurfaceVersion;
    vtkSmartPointer<vtkDataArray> Array;
    bool Used = true; ///< in the current update
  };
  std::vector<ComputedNormals> Normals;

  // Of one update:
  int Step = 0; ///< the requested step
  SurfaceDiffusion::History History;
  bool Succeeded = false;
};
