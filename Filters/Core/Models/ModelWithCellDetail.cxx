// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/ModelWithCellDetail.h"

namespace SurfaceDiffusion
{

StepReport ModelWithCellDetail::Advance(const ProgressMonitor& progress)
{
  StepReport report = this->OfVertices->Advance(progress.Part(0.0, 0.6));
  this->Detail->Advance(*this->OfVertices, report, progress.Part(0.6, 1.0));
  return report;
}

void ModelWithCellDetail::Save(double* checkpoint) const
{
  this->OfVertices->Save(checkpoint);
  this->Detail->Save(checkpoint + this->OfVertices->CheckpointSize());
}

void ModelWithCellDetail::Restore(const double* checkpoint)
{
  this->OfVertices->Restore(checkpoint);
  this->Detail->Restore(checkpoint + this->OfVertices->CheckpointSize());
}

} // namespace SurfaceDiffusion
