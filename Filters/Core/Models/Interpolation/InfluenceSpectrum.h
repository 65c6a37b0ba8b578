// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/RepeatedValues.h"
#include "Core/Models/Interpolation/SmoothFit.h"

#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

/// How a fit depends on mu: the eigenvalues of the influence matrix
///   S = W^(1/2) B H^-1 B^T W^(1/2),
/// which takes the data to the fit at their points, at one mu_0. Those at mu are
///   s mu_0 / (s mu_0 + (1 - s) mu),
/// so that sums of squares of residuals and degrees of freedom are known at every mu from one
/// factorisation. With few values the matrix is computed and decomposed. With many, the measures of the
/// data follow by Lanczos' method (G. Golub, U. von Matt, J. Comput. Graph. Statist. 6, 1997). What
/// repeats at one place leave of their mean has eigenvalues 0: pure error. The trace
/// is the derivative of n log(mu) - log(det(H)) by log(mu), so that two factors give its mean between
/// their mu exactly. Elsewhere it is that of eigenvalues in the proportions of an energy of fourth order
/// with this mean, which holds near mu_0.
class InfluenceSpectrum
{
public:
  /// What a factor of H at one mu says of the trace at others, if there are many values.
  struct Determinant
  {
    double Mu = 0.0; ///< 0: not known
    double Logarithm = 0.0;
  };

  /// data: those of the fit, which is prepared with mu_0. other: of another mu near mu_0. Without it the
  /// trace at mu_0 is guessed: mu_0 has to smooth over three times the distance of the values then.
  /// Throws Aborted.
  InfluenceSpectrum(const SmoothFit& fit, const RepeatedValues& data, const Determinant& other,
    const ProgressMonitor& progress = ProgressMonitor());

  /// Of mu_0.
  const Determinant& Known() const { return this->Own; }

  /// The trace of S at mu: the degrees of freedom of the fit.
  double DegreesOfFreedom(double mu) const;

  /// The eigenvalues near 1, of few values: functions without energy that the values determine.
  Index NumberOfHeld() const;

  /// Whether an eigenvalue is above 1, which shows that a function has a negative energy.
  bool IsIndefinite() const { return this->Largest > 1.0 + 1e-4; }

  /// sum w (u(p) - d)^2 at mu, of a column of the data.
  double Residual(double mu, Eigen::Index column) const;

  /// Craven and Wahba's score of generalised cross-validation (Numer. Math. 31, 1979),
  ///   d Residual / (d - DegreesOfFreedom)^2
  /// with the number d of values: up to a constant the mean square error of predictions of values
  /// that were left out.
  double Score(double mu, Eigen::Index column) const;

  /// The mu with the least score or, with the standard deviation `noise` > 0 of the values at weight
  /// 1, the least unbiased estimate of the risk (C. Mallows, Technometrics 15, 1973),
  ///   Residual + 2 noise^2 DegreesOfFreedom.
  /// Of few values the score often takes noise for signal and has its minimum where the fit all but
  /// reaches them. If it leaves less than a tenth of the degrees of freedom and the eigenvalues are
  /// exact, mu is not below the one with the greatest restricted likelihood (generalised maximum
  /// likelihood, G. Wahba, Ann. Statist. 13, 1985), the least
  ///   log(d^T W^(1/2) (I - S) W^(1/2) d) - (log(det+(I - S)) + a log(mu)) / m
  /// with the m eigenvalues s < 1 of S. a = 0.1 is a weak prior that avoids the boundary mu = 0 (Y.
  /// Chung et al., Psychometrika 78, 2013): without it one sample in ten is taken for exact still.
  double BestSmoothing(Eigen::Index column, double noise) const;

  /// Whether mu is so near to mu_0 that the measures resolve it.
  bool Resolves(double mu) const
  {
    return this->IsExact || (this->KnowsTrace && mu < 1.2 * this->Mu && this->Mu < 1.2 * mu);
  }

  /// Let the fit, which is prepared with mu_0, take mu without another factorisation. Returns false,
  /// and does nothing, if the eigenvectors are not known, or if mu is so far from mu_0 that round-off
  /// counts. The fit must have the factor of mu_0 still.
  bool Rescale(SmoothFit& fit, double mu) const;

  /// Of S, one per column, and its eigenvalues at mu; none of more than FewValues places.
  const Eigen::MatrixXd& Eigenvectors() const { return this->Vectors; }
  Vector Eigenvalues(double mu) const;
  double Start() const { return this->Mu; } ///< mu_0

  static constexpr Index FewValues = 300; ///< places, whose matrix is decomposed

private:
  /// Eigenvalues with weights.
  using Measure = std::vector<std::pair<double, double>>;

  enum class Criterion
  {
    Score,
    Risk,
    Likelihood
  };

  /// The share of the data that the residual keeps at mu = ratio mu_0.
  static double Left(double s, double ratio);
  double CostOf(Criterion criterion, double mu, Eigen::Index column, double noise) const;
  double SlopeOf(Criterion criterion, double mu, Eigen::Index column, double noise) const;
  double Minimiser(Criterion criterion, Eigen::Index column, double noise) const;
  std::vector<Measure> MeasuresOf(const SmoothFit& fit, const Vector& roots, Values v, int steps,
    const ProgressMonitor& progress);
  void ModelTrace(const SmoothFit& fit, const Determinant& other);
  void Decompose(
    const SmoothFit& fit, const ScatteredValues& data, const ProgressMonitor& progress);
  void Sample(const SmoothFit& fit, const ScatteredValues& data, const ProgressMonitor& progress);

  bool IsExact = false;
  bool KnowsTrace;
  double Largest = 0.0; ///< eigenvalue
  Determinant Own;
  double Mu;
  Index Count; ///< of values, repeats at one place included
  Eigen::MatrixXd Vectors; ///< of S, and its eigenvalues, if they are exact
  Vector Shares;
  Measure Trace;
  std::vector<Measure> Columns; ///< of the data
};

} // namespace SurfaceDiffusion
