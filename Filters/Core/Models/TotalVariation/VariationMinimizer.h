// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Models/EdgeFunctions.h"
#include "Core/Operators/GradientMap.h"

#include <cstddef>

namespace SurfaceDiffusion
{

/// Finds the minimum over u of a convex functional of grad u plus terms at the vertices, by ADMM up
/// to a duality gap: TotalVariationMinimizer, GeneralizedVariationMinimizer.
class VariationMinimizer
{
public:
  struct Settings
  {
    EdgeFunction Function; ///< of a convex energy; its beta is not used
    ChannelCoupling Coupling = ChannelCoupling::Joint;
    double Range = 1.0; ///< largest max - min of the data over the channels
    double StopTolerance = 1e-4; ///< on the duality gap / E
    int MaximumNumberOfIterations = 10000;
  };

  struct Report
  {
    int Iterations = 0;
    /// Duality gap relative to E, or, if that is larger, to a thousandth of E of the start or a
    /// millionth of the energy of noise of the whole Range: below it data are constant up to
    /// round-off.
    double Gap = 0.0;
    /// Upper bound of E(u) - min E, the duality gap itself.
    double AbsoluteGap = 0.0;
  };

  virtual ~VariationMinimizer() = default;

  /// g, f: the data of the terms at the vertices, as VertexTerms::Start() takes them. u: the start
  /// on entry, the minimiser on return, and never of more energy than the start. The result depends
  /// on the arguments alone, and on the multipliers of the last call if they are kept: near the
  /// last minimum they save most of the iterations.
  virtual Report Minimize(const Values& g, const Values& f, Values& u,
    const ProgressMonitor& progress = ProgressMonitor(), bool keepMultipliers = false) = 0;

  /// The multipliers after Minimize() for u with `columns` columns, which restore its next call:
  /// NumberOfMultipliers() numbers. None unless a subclass keeps them.
  virtual std::size_t NumberOfMultipliers(Eigen::Index /*columns*/) const { return 0; }
  virtual void SaveMultipliers(double* /*numbers*/, Eigen::Index /*columns*/) const {}
  virtual void RestoreMultipliers(const double* /*numbers*/, Eigen::Index /*columns*/) {}

  /// The functional of grad u, for u of the last Minimize().
  virtual double GradientEnergy(const Values& u) const = 0;

  /// What that functional leaves out of grad u of column k on triangle t, in the triangle's axes.
  virtual Eigen::Vector2d FreeGradient(Index /*t*/, Eigen::Index /*k*/) const
  {
    return Eigen::Vector2d::Zero();
  }

  /// The tolerance and the largest number of iterations of later calls of Minimize().
  void SetLimits(double stopTolerance, int maximumNumberOfIterations)
  {
    this->Options.StopTolerance = stopTolerance;
    this->Options.MaximumNumberOfIterations = maximumNumberOfIterations;
  }

protected:
  explicit VariationMinimizer(const Settings& settings)
    : Options(settings)
  {
  }

  /// int psi for gradients of one Range per vertex spacing, on a surface of this area.
  double NoiseEnergy(double area, double numberOfVertices) const
  {
    EdgeFunction function = this->Options.Function;
    function.Beta = 0.0;
    const double squared = numberOfVertices * this->Options.Range * this->Options.Range;
    return numberOfVertices > 0.0 ? area * function.Potential(squared / area) : 0.0;
  }

  Settings Options;
};

} // namespace SurfaceDiffusion
