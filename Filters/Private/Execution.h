// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceDiffusionAlgorithm.h"

#include "Core/Monitor.h"
#include "SurfacePieces.h"
#include "SurfaceRun.h"

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkTable;

/// One update of the filter: checks, makes what has changed, moves to the step wanted, writes.
class vtkSurfaceDiffusionAlgorithm::Execution
{
public:
  /// The outputs are copies of the inputs, which they stay until all has succeeded.
  Execution(vtkSurfaceDiffusionAlgorithm& filter, const std::vector<SurfacePiece>& surfaces);

  /// False, after error messages, where properties or arrays are wrong.
  bool Check();

  /// Write the state after `step` steps and the history. An error or an abort leaves the output.
  void Run(int step, vtkTable* history);

private:
  struct Block
  {
    vtkPolyData* Input;
    vtkPolyData* Output;
    BlockArrays Arrays;
    SurfaceRun* Run = nullptr;
  };

  /// Find the arrays, and what is wrong with them and with the properties.
  void FindProblems(Problems& problems);
  void MakeSurfaces(const SurfaceDiffusion::Monitor& monitor);
  void MeasureUnits();
  void MakeRuns(const SurfaceDiffusion::Monitor& monitor);
  void MakeRun(Block& block, const SurfaceDiffusion::Monitor& monitor);
  std::shared_ptr<SurfaceDiffusion::LinearSolver> FindSolver(
    SurfaceRun& run, const std::string& name, SurfaceDiffusion::SolverTask task);
  /// Tell the error and take back what was done.
  void Fail(const std::string& what, vtkTable* history);
  bool IsAborted();
  /// How many steps have to be computed to be there.
  SurfaceDiffusion::Index NumberOfStepsTo(int step) const;
  void Seek(int step, const SurfaceDiffusion::Monitor& monitor);
  void WriteHistory(int step, vtkTable* history);
  bool MaskChangesNothing() const;
  void Warn();

  vtkSurfaceDiffusionAlgorithm& Filter;
  std::vector<Block> Blocks; ///< those that take part
  bool AnyPoint = false;
  bool AnyPolygon = false;
  bool MadeAnything = false; ///< false where only the time has changed
};
