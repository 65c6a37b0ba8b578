// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/CellDetail.h"
#include "Core/Models/Model.h"

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// A model of data on cells, with their detail.
class ModelWithCellDetail : public Model
{
public:
  ModelWithCellDetail(std::unique_ptr<Model> model, std::shared_ptr<CellDetail> detail)
    : OfVertices(std::move(model))
    , Detail(std::move(detail))
  {
  }

  const Values& State() const override { return this->OfVertices->State(); }
  bool SumState(std::vector<double>& totals) const override
  {
    return this->OfVertices->SumState(totals);
  }
  /// Reports the step of the model, and solves of the detail that missed their tolerance.
  StepReport Advance(const ProgressMonitor& progress) override;
  bool Finished() const override { return this->OfVertices->Finished(); }
  double Energy() const override { return this->OfVertices->Energy(); }
  const Model& Innermost() const override { return this->OfVertices->Innermost(); }

  std::size_t CheckpointSize() const override
  {
    return this->OfVertices->CheckpointSize() + this->Detail->CheckpointSize();
  }
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

private:
  std::unique_ptr<Model> OfVertices;
  std::shared_ptr<CellDetail> Detail;
};

} // namespace SurfaceDiffusion
