// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Model.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// A model whose columns are models of one column each, with settings of their own. Each comes out
/// as if it were alone.
class ColumnModels : public Model
{
public:
  explicit ColumnModels(std::vector<std::unique_ptr<Model>> columns);

  const Values& State() const override { return this->U; }
  StepReport Advance(const ProgressMonitor& progress) override;
  bool Finished() const override;
  double Energy() const override;

  /// That of the column that DiffusionWeights() was asked for last.
  DiffusionStep Diffusion() const override;
  const CornerWeights& DiffusionWeights(Eigen::Index column) override;

  std::size_t CheckpointSize() const override;
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

private:
  void UpdateState();

  std::vector<std::unique_ptr<Model>> Columns;
  std::size_t Asked = 0;
  Values U;
};

} // namespace SurfaceDiffusion
