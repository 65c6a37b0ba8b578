// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Solvers/LinearSolver.h"
#include "Core/Surface/PointData.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// The cost of a time step and the accuracy it reached.
struct StepReport
{
  int Iterations = 0; ///< linear (or outer) iterations of the step
  double Residual = 0.0; ///< largest relative residual of its solves
  double ErrorBound = 0.0; ///< of a minimisation: bound of the root mean square error of u
  Index Clamped = 0; ///< number of values clamped at zero (reaction-diffusion)
  /// The largest relative residual of the solves that missed the tolerance of the linear solver; 0
  /// if none did.
  double MissedResidual = 0.0;
  /// If repetitions of a step ended at their largest number: the decrease by the last one, relative
  /// to that by all. Otherwise 0.
  double UnsettledDecrease = 0.0;

  void Add(const SolveReport& solve)
  {
    this->Iterations += solve.Iterations;
    this->Residual = std::max(this->Residual, solve.Residual);
    if (!solve.Converged)
    {
      this->MissedResidual = std::max(this->MissedResidual, solve.Residual);
    }
  }
};

/// A time step that reaches the steady state.
constexpr double InfiniteTime = std::numeric_limits<double>::infinity();

/// The diffusion of the last step of a model, m u_t = div(D grad u) + lambda w chi (f - u), for
/// what diffuses beside its state: see CellDetail.
struct DiffusionStep
{
  double TimeStep = 0.0; ///< infinite: the steady state; 0: nothing diffuses
  double Fidelity = 0.0; ///< lambda
  bool IsL1 = false; ///< the fidelity is lambda w chi (f - u) / |f - u|
  bool SharesTensor = true; ///< all columns have one D
  bool IsConstant = false; ///< D is the same in all steps
  bool IsExponential = false; ///< the step is an ExponentialSeries
};

/// The time stepper of an evolution equation on one surface: a state that moves in time step by
/// step. All that later steps depend on can be saved and restored, and then gives the same bits.
class Model
{
public:
  virtual ~Model() = default;

  /// u, n x k, at the current step.
  virtual const Values& State() const = 0;

  /// True if the model knows the integrals of State() over the surface, per column, without making
  /// State(), which may cost more than a step.
  virtual bool SumState(std::vector<double>& /*totals*/) const { return false; }

  /// One time step. On an exception the state is not defined until Restore().
  virtual StepReport Advance(const ProgressMonitor& progress) = 0;

  /// True if the model's stopping rule says that further steps change nothing.
  virtual bool Finished() const { return false; }

  /// The model's energy of the current state, in the units of the data and the mesh's lengths.
  virtual double Energy() const = 0;

  /// Whether and how the state diffuses. Counts after a step.
  virtual DiffusionStep Diffusion() const { return {}; }
  /// The weights (12) of D in a column of the state, per triangle, valid until the next call; no
  /// row: D = 1.
  virtual const CornerWeights& DiffusionWeights(Eigen::Index /*column*/)
  {
    static const CornerWeights one;
    return one;
  }

  /// Results beside the state at the current step, in the units of the model: one row per vertex,
  /// or numbers.
  virtual std::map<std::string, Values> Results() const { return {}; }

  /// The direction of the strongest diffusion per triangle, zero where diffusion is isotropic; no
  /// row if it is so everywhere. It may take as long as a step.
  virtual TangentVectors Axes(const ProgressMonitor& /*progress*/) const
  {
    return TangentVectors(0, 2);
  }

  /// The data that the model was made from; null if it does not keep them.
  virtual const PointData* GivenData() const { return nullptr; }

  /// The model in it, if it is one with something beside its state; otherwise itself.
  virtual const Model& Innermost() const { return *this; }

  /// A checkpoint of CheckpointSize() numbers: the state, and more if later steps depend on it.
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

/// A model whose later steps depend on its state alone.
class StateModel : public Model
{
public:
  const Values& State() const override { return this->U; }
  void Restore(const double* checkpoint) override
  {
    std::copy(checkpoint, checkpoint + this->U.size(), this->U.data());
  }

protected:
  explicit StateModel(Values start)
    : U(std::move(start))
  {
  }

  Values U; ///< n x k
};

/// A StateModel of given data f. A model made of models may replace the data and the state between
/// steps.
class DataModel : public StateModel
{
public:
  /// Not read where data are missing, but finite there.
  void SetGiven(const Values& f) { this->Data.Given = f; }
  const Values& Given() const { return this->Data.Given; }
  void SetState(const Values& u) { this->U = u; }

protected:
  explicit DataModel(PointData data)
    : StateModel(data.Start)
    , Data(std::move(data))
  {
  }

  PointData Data;
};

} // namespace SurfaceDiffusion
