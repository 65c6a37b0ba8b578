// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/InfluenceSpectrum.h"
#include "Core/Models/Interpolation/SlopeSquares.h"

#include <vector>

namespace SurfaceDiffusion
{

/// What few values say of mu: its posterior distribution. The Gaussian field of SmoothInterpolation
/// gives the parts z of the values along the m eigenvectors of S with eigenvalues s < 1 the variances
/// sigma^2/(1 - s). With a prior 1/sigma for the deviation sigma of values of weight 1, with what q
/// repeats of places leave of their means, and with the prior p of mu,
///   p(mu | d) ~ p(log mu) prod (1 - s)^(1/2) (sum z^2 (1 - s) + scatter)^(-(m + q)/2),
/// and with a given sigma exp(-sum z^2 (1 - s)/(2 sigma^2)) in place of the last factor. p is the half-Cauchy
/// distribution (A. Gelman, Bayesian Anal. 1, 2006) of mu^(-1/4), the wave number beyond which the fit
/// smooths, so that p(log mu) ~ 1/cosh(log(mu/mu_h)/4), where the mean of the m eigenvalues is 1/2 at mu_h.
class SmoothingPosterior
{
public:
  /// spectrum: with eigenvectors. data: of which the column counts. noise: sigma, 0: not known.
  SmoothingPosterior(const InfluenceSpectrum& spectrum, const RepeatedValues& data,
    Eigen::Index column, double noise);

  /// The root of the weighted mean square of the parts of the values that have an energy.
  double Contrast() const { return this->RootMeanSquare; }
  /// False: the values leave nothing to estimate sigma from.
  bool IsKnown() const { return !this->Nodes.empty(); }

  static constexpr double Farthest = 16.0; ///< |log(mu/mu_h)|
  /// log(p(log mu)) of mu/mu_h, up to a constant.
  static double LogPrior(double ratio);

  /// The mu nearest to this one from which the factor resolves the distribution.
  double Resolving(double mu) const;

  /// The mean over mu of the square of the error of the fit u of mu, at each vertex:
  ///   t^2 sigma^2(mu') H^-1(mu') + (u(mu') - u(mu))^2,  sigma^2(mu') = (..)/(m + q) of above,
  /// where t is StudentFactor(m + q), or 1 with a given sigma. fit: prepared with a mu of Resolving().
  /// ofSlopes: becomes the same of slopes.
  Vector SquareOfError(const SmoothFit& fit, double mu, const SlopeSquares& slopes,
    Vector& ofSlopes, const ProgressMonitor& progress) const;

  /// The mean over mu of t^2 sigma^2(mu) (ofNoise + ofField/mu).
  double MeanOf(double ofNoise, double ofField) const;

private:
  struct Node
  {
    double Mu = 0.0;
    double Weight = 0.0;
    double Variance = 0.0; ///< t^2 sigma^2
  };

  const InfluenceSpectrum& Spectrum;
  const RepeatedValues& Data;
  Vector Parts; ///< z
  double RootMeanSquare = 0.0;
  double Middle; ///< mu_h
  std::vector<Node> Nodes;
};

} // namespace SurfaceDiffusion
