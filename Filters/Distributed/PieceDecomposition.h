// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Distributed/DomainDecomposition.h"
#include "Distributed/PointIdentity.h"
#include "Distributed/Processes.h"
#include "Run/Run.h"
#include "vtkSurfaceDiffusionNamespace.h"

#include <cstdint>
#include <memory>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataSetAttributes;
class vtkMultiProcessController;
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace SurfaceDiffusion
{

/// The decomposition of a surface of which every process has one vtkPolyData.
class PieceDecomposition : public Decomposition
{
public:
  /// abortRequested: whether this process is to stop; all processes then stop together.
  PieceDecomposition(
    vtkMultiProcessController* controller, std::shared_ptr<const bool> abortRequested);

  /// The piece of the next call of FindLengthUnit(). tolerance: see PointIdentity.
  void SetPiece(vtkPolyData* piece, double tolerance);

  double FindLengthUnit() override;
  void Attach(Surface& surface, SolverStore& solvers) override;
  Index NumberOfCopies() const override
  {
    return static_cast<Index>(this->Domain->NumberOfCopies());
  }

  bool HasIds() const { return this->Identity.IsById; } ///< all processes have global ids of points
  /// Per point its global id.
  std::vector<std::int64_t> PointIds() const { return this->Identity.MakeIds(this->Piece); }

  /// Give copies of points that other processes own what was written there: the arrays of `after`
  /// that `before` has not.
  void UpdateCopies(vtkDataSetAttributes* before, vtkDataSetAttributes* after) const;

private:
  const Processes Members;
  const std::shared_ptr<const bool> AbortRequested;
  vtkPolyData* Piece = nullptr;
  double Tolerance = -1.0;
  PointIdentity Identity;
  std::shared_ptr<DomainDecomposition> Domain;
};

} // namespace SurfaceDiffusion
