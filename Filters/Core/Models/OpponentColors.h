// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Models/Model.h"

#include <functional>
#include <memory>

namespace SurfaceDiffusion
{

/// A model of colours in the opponent basis: its unknowns are the components of u along the
/// orthonormal axes
///   (1, 1, 1)/sqrt(3), (1, -1, 0)/sqrt(2), (1, 1, -2)/sqrt(6),
/// brightness, red against green, and yellow against blue (J. van de Weijer, T. Gevers, A.
/// Bagdanov, IEEE PAMI 28(1), 2006). The basis is a rotation: a model whose terms treat all
/// channels alike has the same states in it. Models with other weights for the two axes of colour
/// use it.
class OpponentColors : public Model
{
public:
  using ModelMaker = std::function<std::unique_ptr<Model>(PointData opponents)>;

  /// data: with three columns.
  OpponentColors(
    PointData data, const ModelMaker& makeModel, const ParallelFor& parallel = SerialFor());

  const Values& State() const override { return this->U; }
  StepReport Advance(const ProgressMonitor& progress) override;
  bool Finished() const override { return this->Opponents->Finished(); }
  double Energy() const override { return this->Opponents->Energy(); }

  /// Those of brightness.
  DiffusionStep Diffusion() const override;
  const CornerWeights& DiffusionWeights(Eigen::Index /*column*/) override
  {
    return this->Opponents->DiffusionWeights(0);
  }

  std::size_t CheckpointSize() const override { return this->Opponents->CheckpointSize() + 1; }
  void Save(double* checkpoint) const override;
  void Restore(const double* checkpoint) override;

private:
  void UpdateState();

  const ParallelFor& Parallel;
  Values Start;
  Flags Fixed;
  std::unique_ptr<Model> Opponents;
  bool Started = false; ///< before, the state is the start to the last bit
  Values U;
};

} // namespace SurfaceDiffusion
