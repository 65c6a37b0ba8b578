// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/ColumnModels.h"

#include <algorithm>
#include <utility>

namespace SurfaceDiffusion
{

ColumnModels::ColumnModels(std::vector<std::unique_ptr<Model>> columns)
  : Columns(std::move(columns))
  , U(this->Columns.front()->State().rows(), static_cast<Eigen::Index>(this->Columns.size()))
{
  this->UpdateState();
}

void ColumnModels::UpdateState()
{
  for (std::size_t k = 0; k < this->Columns.size(); ++k)
  {
    this->U.col(static_cast<Eigen::Index>(k)) = this->Columns[k]->State();
  }
}

StepReport ColumnModels::Advance(const ProgressMonitor& progress)
{
  StepReport all;
  const auto count = static_cast<double>(this->Columns.size());
  for (std::size_t k = 0; k < this->Columns.size(); ++k)
  {
    const auto done = static_cast<double>(k);
    const StepReport report =
      this->Columns[k]->Advance(progress.Part(done / count, (done + 1.0) / count));
    all.Iterations += report.Iterations;
    all.Clamped += report.Clamped;
    all.Residual = std::max(all.Residual, report.Residual);
    all.ErrorBound = std::max(all.ErrorBound, report.ErrorBound);
    all.MissedResidual = std::max(all.MissedResidual, report.MissedResidual);
    all.UnsettledDecrease = std::max(all.UnsettledDecrease, report.UnsettledDecrease);
  }
  this->UpdateState();
  return all;
}

bool ColumnModels::Finished() const
{
  return std::all_of(this->Columns.begin(), this->Columns.end(),
    [](const auto& column) { return column->Finished(); });
}

double ColumnModels::Energy() const
{
  double sum = 0.0;
  for (const auto& column : this->Columns)
  {
    sum += column->Energy();
  }
  return sum;
}

DiffusionStep ColumnModels::Diffusion() const
{
  DiffusionStep step = this->Columns[this->Asked]->Diffusion();
  step.SharesTensor = false; // nor lambda
  return step;
}

const CornerWeights& ColumnModels::DiffusionWeights(Eigen::Index column)
{
  this->Asked = static_cast<std::size_t>(column);
  return this->Columns[this->Asked]->DiffusionWeights(0);
}

std::size_t ColumnModels::CheckpointSize() const
{
  std::size_t size = 0;
  for (const auto& column : this->Columns)
  {
    size += column->CheckpointSize();
  }
  return size;
}

void ColumnModels::Save(double* checkpoint) const
{
  for (const auto& column : this->Columns)
  {
    column->Save(checkpoint);
    checkpoint += column->CheckpointSize();
  }
}

void ColumnModels::Restore(const double* checkpoint)
{
  for (const auto& column : this->Columns)
  {
    column->Restore(checkpoint);
    checkpoint += column->CheckpointSize();
  }
  this->UpdateState();
}

} // namespace SurfaceDiffusion
