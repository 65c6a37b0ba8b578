// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Interpolation/ScatteredValues.h"
#include "Core/Models/Interpolation/SmoothnessEnergy.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

class ComponentMeshes;
struct RepeatedValues;

/// Interpolation and smoothing of values at a few points of a surface: the minimiser of
///   E(u) = 1/2 sum_i w_i (u(p_i) - d_i)^2 + mu/2 int (kappa^2 u - div(D grad u))^2,
/// a thin-plate spline on the surface (G. Wahba, Spline Models for Observational Data, SIAM 1990).
/// Harmonic interpolation, whose energy is int |grad u|^2, is no method for values at points: a
/// point has no capacity in two dimensions, and the solution tends to a constant with a spike at
/// every value as the mesh becomes finer. The energy of second derivatives bounds values at points,
/// so that this interpolant converges.
///
/// Each connected component has a fit of its own, with its own mu, noise and score, so that neither
/// its size nor its values matter to another one.
///
/// With kappa = 0 constants have no energy. With kappa > 0 the values of a component are measured from
/// their weighted mean, to which u returns beyond the distance 1/kappa from them.
///
/// u is also the mean of a Gaussian field with the precision (mu Q + B^T W B) / s^2, where s is the
/// standard deviation of values with weight 1: from it follow standard errors. With kappa > 0 the
/// mean m = w^T d of a component, from which its values are measured, adds
///   (1 - (A 1)_i)^2 Var(m),  Var(m) / s^2 = w^T (W^-1 + B (mu Q)^-1 B^T) w,
/// with the fit A 1 of values that are all 1. The errors of both parts do not correlate, since the
/// fit is the best linear predictor. A band of 1.645 standard errors holds 90 %: they are longer than
/// the deviation by StudentFactor() if s is estimated, and a mu that is found has a distribution, over
/// which the mean square of the error is taken; see SmoothingPosterior.
class SmoothInterpolation
{
public:
  enum class Choice
  {
    Exact, ///< the values hold
    Automatic, ///< mu by generalised cross-validation; see InfluenceSpectrum::BestSmoothing()
    NoiseLevel, ///< mu by the noise level
    Given ///< mu
  };

  struct Settings
  {
    double Kappa = 0.0; ///< 1/length, >= 0, in units of the mesh, as mu
    RimCondition Rim = RimCondition::Natural;
    Choice Smoothing = Choice::Automatic;
    double Mu = 0.0; ///< of Given: > 0, in units of w length^2
    /// s, the standard deviation of values with weight 1; 0: estimated from what the fit leaves.
    /// NoiseLevel needs it, and standard errors take it if it is given.
    double NoiseLevel = 0.0;
    bool KeepRange = false; ///< min d <= u <= max d in each column
    bool ComputeError = false;
    bool ComputeLeverage = false;
  };

  /// What was found for a column of the data, over all components.
  struct Column
  {
    /// Of the component with the most values, the first one of these. 0: the values hold. At most what
    /// the mean of the values resolves.
    double Mu = 0.0;
    double Score = 0.0; ///< of cross-validation, the mean over the values; 0 if the values hold
    /// Root of the weighted mean square of u(p) - d. Exact: it is round-off unless values at more
    /// than three places of one triangle contradict each other.
    double Residual = 0.0;
    double DegreesOfFreedom = 0.0;
    /// s, given or estimated, the root of its mean square over the residual degrees of freedom, those
    /// of repeats at one place included; 0 if the values hold.
    double NoiseLevel = 0.0;
    double Energy = 0.0; ///< E(u)
  };

  struct Result
  {
    Values U; ///< n x k; NaN in components without values
    /// The standard error, n x k; no rows unless asked for. NaN in components without values, and in
    /// those whose values do not show a deviation: one, all on a function without energy, or all
    /// reached by the fit. Infinite where the values leave a slope open.
    Values Error;
    /// With Error, the standard error of the derivative of u in any direction, the root of the mean over
    /// directions and the triangles around the vertex; without that of the mean from which values are
    /// measured. NaN where values hold, infinite where they leave the slope open.
    Values SlopeError;
    /// How far the fit follows each given value, 0 to 1, d x k: the derivative of u(p_i) by d_i. Without
    /// the value i, u(p_i) differs from d_i by the residual over 1 less the leverage, at the same mu. No
    /// rows unless asked for.
    Values Leverage;
    bool HasUnknownError = false; ///< of values that do not show a deviation
    bool HasInfiniteError = false;
    std::vector<Column> Columns;
    Index UndeterminedComponents = 0; ///< without values
    Index RepeatedValues = 0; ///< at a place that another value has, too
    Index ContradictingPlaces = 0; ///< whose values differ: their weighted mean counts
    Index Parts = 0; ///< components with values
    /// Automatic: those with fewer than two places more than functions without energy, too few for a
    /// choice of mu: their values hold.
    Index PartsWithTooFewValues = 0;
    Index EnoughPlaces = 3; ///< for the choice; up to 5 on flat pieces with Free
    /// Free, on surfaces on which the values leave a slope open: the flattest function is taken.
    bool IsFlattest = false;
    /// Free, on coarse meshes of surfaces with saddles: the energy was indefinite and is taken without
    /// negative curvature.
    bool DropsNegativeCurvature = false;
    /// Whether the active set of KeepRange settled. If not, u is within the range nevertheless.
    bool RangeIsOptimal = true;
  };

  /// coefficients: of K, as in CotanWeights.h.
  SmoothInterpolation(std::shared_ptr<const Assembler> assembler, CornerWeights coefficients,
    const Settings& settings, const ParallelFor& parallel = SerialFor());

  /// Throws Aborted, std::runtime_error if there is no value or no factor, and std::invalid_argument
  /// on a mu or a noise level that is needed and not above 0.
  Result Fit(
    const ScatteredValues& data, const ProgressMonitor& progress = ProgressMonitor()) const;

private:
  struct Work;

  SmoothInterpolation OfComponent(const ComponentMeshes& meshes, Index c) const;
  /// Of a connected surface, the bounds of KeepRange being those of all values.
  Result FitPart(const RepeatedValues& rows, const Eigen::RowVectorXd& lowest,
    const Eigen::RowVectorXd& highest, const ProgressMonitor& progress) const;
  void FitExactly(Work& work, Result& result, const ProgressMonitor& progress) const;
  void FitSmoothly(Work& work, Result& result, const ProgressMonitor& progress) const;
  bool FitColumns(Work& work, Result& result, Eigen::Index first, Eigen::Index count, double mu,
    const ProgressMonitor& progress) const;
  void KeepInRange(Work& work, Result& result, Eigen::Index column, const Flags& held, Values& u,
    Values& forces, const ProgressMonitor& progress) const;
  void Prepare(Work& work, Result& result, double mu, const Flags& held,
    const ProgressMonitor& progress) const;
  static void DropNegativeCurvature(Work& work, Result& result);
  Flags FindOpen(const Work& work) const;
  Vector VarianceOfMean(
    Work& work, const Flags& held, bool isExact, const ProgressMonitor& progress) const;
  /// The standard error and that of slopes.
  std::pair<Vector, Vector> ErrorOverSmoothing(
    Work& work, Result& result, Eigen::Index column, const ProgressMonitor& progress) const;
  std::pair<Vector, Vector> ErrorOverFactors(
    Work& work, Eigen::Index column, const Values& u, const ProgressMonitor& progress) const;
  static Vector FindLeverage(const Work& work, const ProgressMonitor& progress);
  double StartSmoothing(const Work& work) const;

  std::shared_ptr<const Assembler> Assembly;
  CornerWeights Coefficients;
  Settings Options;
  const ParallelFor& Parallel;
};

} // namespace SurfaceDiffusion
