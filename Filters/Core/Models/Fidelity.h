// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Models/EdgeFunctions.h"
#include "Core/Surface/PointData.h"
#include "Core/Surface/TriangleMesh.h"

#include <cstddef>
#include <vector>

namespace SurfaceDiffusion
{

enum class FidelityNorm
{
  L2, ///< for Gaussian noise
  L1 ///< for impulse noise
};

/// The fidelity term lambda w chi (f - u) of (16) to (19), and its energy,
///   L2: lambda/2 int w chi |u - f|^2,
///   L1: lambda int w chi (sqrt(|u - f|^2 + delta^2) - delta), whose term is
///       lambda w chi (f - u) / sqrt(|u - f|^2 + delta^2),
/// with the factors w of the data, and the indicator chi of the known part of the surface: chi = 0
/// where data are missing. With L2, the channels may have different lambda.
class Fidelity
{
public:
  struct Settings
  {
    double Weight = 0.0; ///< lambda
    FidelityNorm Norm = FidelityNorm::L2;
    ChannelCoupling Coupling = ChannelCoupling::Joint; ///< of |u - f| of L1
    double Rounding = 0.0; ///< delta of L1
    bool LineField = false; ///< f and -f are the same: the nearer one counts
    /// Of L2: > 0, by which lambda is multiplied in each channel; empty: 1 everywhere.
    std::vector<double> ChannelWeights = {};
  };

  /// data: must outlive it.
  Fidelity(const PointData& data, const Settings& settings)
    : Data(data)
    , Options(settings)
  {
  }

  const Settings& GetSettings() const { return this->Options; }
  bool IsPresent() const { return this->Options.Weight > 0.0; }

  /// False for L1, which does not conserve the total of u.
  bool CanConserve() const { return this->Options.Norm == FidelityNorm::L2 || !this->IsPresent(); }

  /// The factor of lambda in channel k.
  double ChannelWeight(Eigen::Index k) const
  {
    return this->Options.ChannelWeights.empty()
      ? 1.0
      : this->Options.ChannelWeights[static_cast<std::size_t>(k)];
  }

  /// lambda w chi at vertex i, without the factor of a channel.
  double Weight(Index i) const { return this->Options.Weight * this->Data.FidelityFactor(i); }

  /// The factor of f - u in channels first .. last - 1 at vertex i, without that of a channel:
  /// Weight(i), with L1 over the rounded distance.
  double Weight(Index i, const Values& u, Eigen::Index first, Eigen::Index last) const;

  /// -1 if -f is the nearer one of a line field, else 1.
  double Sign(Index i, const Values& u) const
  {
    return this->Options.LineField && this->Data.Given.row(i).dot(u.row(i)) < 0.0 ? -1.0 : 1.0;
  }

  /// The energy, summed over the vertices of this process.
  double Energy(const TriangleMesh& mesh, const Values& u, const ParallelFor& parallel) const;

private:
  double Density(double squaredDistance) const;
  double SquaredDistance(Index i, const Values& u, int first, int last) const;

  const PointData& Data;
  Settings Options;
};

} // namespace SurfaceDiffusion
