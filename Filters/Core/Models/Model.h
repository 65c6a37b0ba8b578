// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Surface/PointData.h"

#include <algorithm>
#include <cstddef>

namespace SurfaceDiffusion
{

struct StepReport
{
  int Iterations = 0; ///< of linear (or outer) iterations in the step
  double Residual = 0.0; ///< largest relative residual of its solves
  Index Clamped = 0; ///< values that had to be clamped (reaction-diffusion)
};

/// A model on one surface with its data: a state that moves step by step in time. What a later
/// step depends on can be saved and restored, and gives the same bits again.
class Model
{
public:
  virtual ~Model() = default;

  /// u, n x k, at the current step.
  virtual const Values& State() const = 0;

  /// One time step. On an exception the state is not defined until Restore().
  virtual StepReport Advance(const ProgressMonitor& progress) = 0;

  /// True once further steps change nothing, by a stopping rule of the model's.
  virtual bool Finished() const { return false; }

  /// The model's energy of the current state, in the units of the data and the mesh's lengths.
  virtual double Energy() const = 0;

  /// What later steps depend on, as CheckpointSize() numbers: the state, unless a model says more.
  virtual std::size_t CheckpointSize() const
  {
    return static_cast<std::size_t>(this->State().size());
  }
  virtual void Save(double* checkpoint) const
  {
    std::copy(this->State().data(), this->State().data() + this->State().size(), checkpoint);
  }
  virtual void Restore(const double* checkpoint) = 0;
};

} // namespace SurfaceDiffusion
