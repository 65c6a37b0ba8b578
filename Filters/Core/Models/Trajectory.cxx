// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Trajectory.h"

#include "Core/Operators/MeanCorrection.h"

#include <algorithm>
#include <chrono>

namespace SurfaceDiffusion
{

CheckpointStore::CheckpointStore(std::size_t size, std::size_t limit)
  : Size(std::max<std::size_t>(size, 1))
  , Limit(std::max<std::size_t>(limit / (this->Size * sizeof(double)), 1))
{
}

void CheckpointStore::Reserve(Index steps)
{
  const std::size_t capacity = std::min(this->Limit, static_cast<std::size_t>(steps) + 1);
  if (capacity > this->Capacity)
  {
    std::unique_ptr<double[]> memory(new double[capacity * this->Size]);
    std::copy(this->Memory.get(), this->Memory.get() + this->Count * this->Size, memory.get());
    this->Memory = std::move(memory);
    this->Capacity = capacity;
  }
}

void CheckpointStore::Offer(Index step, const Model& model)
{
  if (step != static_cast<Index>(this->Count) * this->StepStride)
  {
    return; // kept already, or between two that are kept
  }
  while (this->Count == this->Capacity)
  {
    if (this->Capacity < this->Limit)
    {
      this->Reserve(step);
      break;
    }
    if (this->Capacity == 1)
    {
      return;
    }
    this->Count = (this->Count + 1) / 2;
    for (std::size_t slot = 1; slot < this->Count; ++slot)
    {
      std::copy(this->Slot(2 * slot), this->Slot(2 * slot) + this->Size, this->Slot(slot));
    }
    this->StepStride *= 2;
    if (step != static_cast<Index>(this->Count) * this->StepStride)
    {
      return;
    }
  }
  model.Save(this->Slot(this->Count++));
}

Index CheckpointStore::LatestAtOrBefore(Index step) const
{
  return std::min(static_cast<Index>(this->Count) - 1, step / this->StepStride) * this->StepStride;
}

const double* CheckpointStore::At(Index step) const
{
  return this->Memory.get() + static_cast<std::size_t>(step / this->StepStride) * this->Size;
}

Trajectory::Trajectory(std::shared_ptr<const TriangleMesh> mesh, std::unique_ptr<Model> model,
  std::size_t memoryLimit, const ParallelFor& parallel, bool keepsHistory)
  : Surface(std::move(mesh))
  , Stepper(std::move(model))
  , NumberOfColumns(static_cast<std::size_t>(this->Stepper->State().cols()))
  , Parallel(parallel)
  , Checkpoints(this->Stepper->CheckpointSize(), memoryLimit)
  , IsHistoryKept(keepsHistory)
{
  this->Checkpoints.Reserve(0);
  this->Checkpoints.Offer(0, *this->Stepper);
  this->Record(StepReport(), 0.0);
}

void Trajectory::Reserve(Index steps)
{
  this->Checkpoints.Reserve(steps);
  // A run of unknown or enormous length grows its history as it goes.
  const std::size_t rows = static_cast<std::size_t>(std::min(steps, Index(1000000))) + 1;
  this->History.reserve(rows);
  this->Totals.reserve(rows * this->NumberOfColumns);
}

Index Trajectory::NumberOfStepsTo(Index step) const
{
  const Index kept = this->Checkpoints.LatestAtOrBefore(step);
  return step - (this->Current > step ? kept : std::max(kept, this->Current));
}

void Trajectory::Seek(Index step, const ProgressMonitor& progress)
{
  const Index from = step - this->NumberOfStepsTo(step);
  if (this->Current != from)
  {
    this->Stepper->Restore(this->Checkpoints.At(from));
    this->Current = from;
  }
  const Index first = this->Current;
  const double count = std::max(1, step - first);
  while (this->Current < step && !this->Stepper->Finished())
  {
    const ProgressMonitor part =
      progress.Part((this->Current - first) / count, (this->Current + 1 - first) / count);
    const auto start = std::chrono::steady_clock::now();
    try
    {
      const StepReport report = this->Stepper->Advance(part);
      if (this->Current + 1 == static_cast<Index>(this->History.size()))
      {
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        this->Record(report, seconds.count());
      }
    }
    catch (...)
    {
      // The state may be half a step on: go back to one that is known.
      const Index safe = this->Checkpoints.LatestAtOrBefore(this->Current);
      this->Stepper->Restore(this->Checkpoints.At(safe));
      this->Current = safe;
      throw;
    }
    ++this->Current;
    ++this->Advances;
    this->Checkpoints.Offer(this->Current, *this->Stepper);
    part.Report(1.0);
  }
  this->HasEnded = this->HasEnded || this->Current < step;
}

Index Trajectory::FindLastStep(Index limit, const ProgressMonitor& progress)
{
  if (!this->HasEnded && static_cast<Index>(this->History.size()) <= limit)
  {
    this->Seek(limit, progress);
  }
  return std::min(limit, static_cast<Index>(this->History.size()) - 1);
}

void Trajectory::Record(const StepReport& report, double seconds)
{
  const std::size_t columns = this->NumberOfColumns;
  this->Totals.resize(this->History.size() * columns); // an abort may have left some
  double energy = 0.0;
  this->StateTotals.assign(columns, 0.0);
  if (this->IsHistoryKept)
  {
    energy = this->Stepper->Energy();
    if (!this->Stepper->SumState(this->StateTotals))
    {
      Total(*this->Surface, this->State(), this->StateTotals, this->Parallel);
    }
  }
  this->Totals.insert(this->Totals.end(), this->StateTotals.begin(), this->StateTotals.end());
  this->History.push_back({ energy, report.Iterations, report.Residual, seconds, report.Clamped,
    report.MissedResidual, report.UnsettledDecrease, report.ErrorBound });
}

} // namespace SurfaceDiffusion
