// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Conversion/FieldReader.h"
#include "Conversion/SurfaceReader.h"
#include "Distributed/PieceDecomposition.h"
#include "Run/Run.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// Describes the surfaces of an update to a Run: hashes of their contents, and functions that read
/// them. The contents are hashed in every update, because arrays that were edited in place need not
/// be marked as modified; that takes a fraction of the time of reading them.
class BlockInputs
{
public:
  /// The inputs of surfaces that this process has as a whole, which must live until the run has read
  /// them.
  std::vector<BlockInput> Make(const std::vector<InputFields>& surfaces, bool excludeMasked);

  /// The same for surfaces of which every process has a piece. seamTolerance: see PointIdentity.
  std::vector<BlockInput> MakeOfPieces(const std::vector<InputFields>& surfaces, bool excludeMasked,
    double seamTolerance, vtkMultiProcessController* controller,
    const std::shared_ptr<const bool>& abortRequested);

  /// Null unless the last inputs were pieces.
  const PieceDecomposition* GetDecomposition() const { return this->Decomposition.get(); }

  /// The cell of each triangle of a surface of the last inputs that were read.
  const TriangleCells& CellsOf(std::size_t surface) const { return this->Cells[surface]; }

private:
  std::vector<BlockInput> Describe(const std::vector<InputFields>& surfaces, bool excludeMasked);

  std::vector<TriangleCells> Cells; ///< per surface
  std::unique_ptr<PieceDecomposition> Decomposition;
};

} // namespace SurfaceDiffusion
