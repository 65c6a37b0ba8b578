// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Models/Model.h"
#include "Core/Surface/TriangleMesh.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// States kept at every Stride()-th step within a memory limit. When it is full, every other one
/// is dropped and the stride doubles.
class CheckpointStore
{
public:
  /// size: numbers per checkpoint; limit: bytes, but one checkpoint is always kept.
  CheckpointStore(std::size_t size, std::size_t limit);

  /// Make room for the checkpoints of steps 0 .. steps, as far as the limit allows, so that Offer()
  /// does not allocate.
  void Reserve(Index steps);
  void Offer(Index step, const Model& model);
  /// The last step at or before `step` that is kept; step 0 must have been offered.
  Index LatestAtOrBefore(Index step) const;
  const double* At(Index step) const;
  Index Stride() const { return this->StepStride; }

private:
  double* Slot(std::size_t slot) { return this->Memory.get() + slot * this->Size; }

  std::size_t Size;
  std::size_t Limit; ///< in checkpoints
  std::size_t Capacity = 0;
  std::size_t Count = 0;
  Index StepStride = 1;
  std::unique_ptr<double[]> Memory; ///< left uninitialised: pages not yet used cost nothing
};

/// One row of the history.
struct StepRecord
{
  double Energy = 0.0;
  int Iterations = 0;
  double Residual = 0.0;
  double Seconds = 0.0;
  Index Clamped = 0;
  double MissedResidual = 0.0; ///< as in StepReport
  double UnsettledDecrease = 0.0; ///< as in StepReport
  double ErrorBound = 0.0;
};

/// A model that can be moved to any step, forwards and backwards, with the same bits in any order.
class Trajectory
{
public:
  /// memoryLimit: bytes for checkpoints; 0 if only forward steps are expected. keepsHistory:
  /// whether energy and totals of each state are recorded; without, they are 0.
  Trajectory(std::shared_ptr<const TriangleMesh> mesh, std::unique_ptr<Model> model,
    std::size_t memoryLimit, const ParallelFor& parallel = SerialFor(), bool keepsHistory = true);

  /// Announce that steps up to this one may be asked for.
  void Reserve(Index steps);

  /// The number of steps that Seek() would compute.
  Index NumberOfStepsTo(Index step) const;

  /// Move to `step`, or to the last one if the model finishes before. Throws Aborted or
  /// std::runtime_error, after which any Seek() still works.
  void Seek(Index step, const ProgressMonitor& progress = ProgressMonitor());

  /// The last step of the model, at most `limit`. Moves there if it is not known yet.
  Index FindLastStep(Index limit, const ProgressMonitor& progress = ProgressMonitor());

  Index Step() const { return this->Current; }
  const Values& State() const { return this->Stepper->State(); }
  /// The model in that state, for what it has beside it.
  const Model& CurrentModel() const { return this->Stepper->Innermost(); }
  const TriangleMesh& Mesh() const { return *this->Surface; }
  bool KeepsHistory() const { return this->IsHistoryKept; }

  /// Records of steps 0 .. the furthest computed, and sum A u of each: row step, column component.
  const std::vector<StepRecord>& Records() const { return this->History; }
  double TotalAt(Index step, Index component) const
  {
    return this->Totals[static_cast<std::size_t>(step) * this->NumberOfColumns +
      static_cast<std::size_t>(component)];
  }

  /// The number of steps computed in all: a measure of the cost of seeking.
  Index NumberOfAdvances() const { return this->Advances; }

private:
  void Record(const StepReport& report, double seconds);

  std::shared_ptr<const TriangleMesh> Surface;
  std::unique_ptr<Model> Stepper;
  std::size_t NumberOfColumns; ///< of the state
  const ParallelFor& Parallel;
  CheckpointStore Checkpoints;
  std::vector<StepRecord> History;
  std::vector<double> Totals;
  std::vector<double> StateTotals; ///< of the last row of Totals
  Index Current = 0;
  Index Advances = 0;
  bool IsHistoryKept = true;
  bool HasEnded = false; ///< the model has finished at the last row of History
};

} // namespace SurfaceDiffusion
