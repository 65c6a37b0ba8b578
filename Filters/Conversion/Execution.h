// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSurfaceDiffusionAlgorithm.h"

#include "Conversion/SurfaceRun.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Distributed/Processes.h"
#include "Distributed/SurfacePieces.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <string>
#include <vector>

class vtkTable;

/// One update of the filter: checks, makes what has changed, moves to the step wanted, writes.
class vtkSurfaceDiffusionAlgorithm::Execution
{
public:
  /// The outputs are copies of the inputs, which they stay until all has succeeded.
  /// processes: null where the surfaces are whole, otherwise those that have a piece each of the
  /// one surface; all calls are collective then.
  Execution(vtkSurfaceDiffusionAlgorithm& filter,
    const std::vector<SurfaceDiffusion::SurfacePiece>& surfaces,
    const SurfaceDiffusion::Processes* processes = nullptr);

  /// False, after error messages, where properties or arrays are wrong.
  bool Check();

  /// Write the state after `step` steps and the history. An error or an abort leaves the output.
  void Run(int step, vtkTable* history);

private:
  struct Block
  {
    vtkPolyData* Input;
    vtkPolyData* Output;
    SurfaceDiffusion::BlockArrays Arrays;
    SurfaceDiffusion::SurfaceRun* Run = nullptr;
  };

  bool Any(bool here) const { return this->Group ? this->Group->Any(here) : here; }
  double Sum(double here) const;
  /// Do what may throw in one process; then it throws in all.
  template <typename Work>
  void Agree(const Work& work);

  /// Find the arrays, and what is wrong with them and with the properties.
  void FindProblems(Problems& problems);
  void MakeSurfaces(const SurfaceDiffusion::ProgressMonitor& progress);
  void MeasureUnits();
  void MakeRuns(const SurfaceDiffusion::ProgressMonitor& progress);
  void MakeSurface(Block& block, SurfaceDiffusion::PolyDataSurface::Options options,
    const SurfaceDiffusion::ProgressMonitor& progress);
  SurfaceDiffusion::PointData ReadData(const Block& block);
  std::size_t CheckpointMemory(const SurfaceDiffusion::Model& model) const;
  void MakeRun(Block& block, const SurfaceDiffusion::ProgressMonitor& progress);
  std::shared_ptr<SurfaceDiffusion::LinearSolver> FindSolver(
    SurfaceDiffusion::SurfaceRun& run, const std::string& name, SurfaceDiffusion::SolverTask task);
  std::string SurfaceKey(
    const Block& block, const SurfaceDiffusion::PolyDataSurface::Options& options) const;
  void Tell(const std::string& what);
  void FillCopies();
  /// Tell the error and take back what was done.
  void Fail(const std::string& what, vtkTable* history);
  bool IsAborted();
  /// How many steps have to be computed to be there.
  SurfaceDiffusion::Index NumberOfStepsTo(int step) const;
  void Seek(int step, const SurfaceDiffusion::ProgressMonitor& progress);
  void WriteHistory(int step, vtkTable* history);
  bool MaskChangesNothing() const;
  void Warn();

  vtkSurfaceDiffusionAlgorithm& Filter;
  const SurfaceDiffusion::Processes* Group;
  std::vector<Block> Blocks; ///< those that take part
  bool AnyPoint = false;
  bool AnyPolygon = false;
  /// Of a process that has to stop together with the others.
  const std::shared_ptr<bool> AbortAsked = std::make_shared<bool>(false);
  bool MadeAnything = false; ///< false where only the time has changed
};
