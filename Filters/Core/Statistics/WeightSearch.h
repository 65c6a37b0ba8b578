// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Statistics/UnbiasedRisk.h"

#include <cmath>
#include <functional>
#include <limits>
#include <map>

namespace SurfaceDiffusion
{

/// A fidelity weight, and the root mean square of u - f that it leaves.
struct FidelityChoice
{
  double Weight = 0.0;
  double Discrepancy = 0.0;
  bool IsFound = true; ///< false: Weight is the end of the search
};

/// A search for a fidelity weight. Take() receives the response at Trial(), until IsDone().
class WeightSearch
{
public:
  virtual ~WeightSearch() = default;

  bool IsDone() const { return this->Done; }
  /// The weight to try, or the found one.
  double Trial() const { return this->First * std::exp(this->X); }
  /// Whether it needs more than the mean square.
  virtual bool NeedsRisk() const { return false; }
  virtual void Take(const NoiseResponse& trial) = 0;
  virtual FidelityChoice Found() const = 0;

protected:
  explicit WeightSearch(double start)
    : First(start)
  {
  }
  bool Done = false;
  double First;
  double X = 0.0; ///< the logarithm of the trial over the first one, which has no unit
};

/// A search that has found its weight.
class KnownWeight : public WeightSearch
{
public:
  explicit KnownWeight(double weight)
    : WeightSearch(weight)
  {
    this->Done = true;
  }
  void Take(const NoiseResponse& /*trial*/) override {}
  FidelityChoice Found() const override { return { this->Trial(), 0.0, true }; }
};

/// The weight at which the mean square of u - f equals the noise: discrepancy principle (Morozov
/// 1966). The root mean square of u - f must not increase with the weight. Stops at 1 % in the
/// weight. If even 1e-8 of the first guess leaves less than the noise, that weight is returned as
/// not found; likewise 1e8 of it. Brackets the root by factors of 4, then regula falsi (Illinois)
/// in its logarithm.
class DiscrepancySearch : public WeightSearch
{
public:
  /// start: the first guess, of the right units.
  DiscrepancySearch(double noiseLevel, double start)
    : WeightSearch(start)
    , Noise(noiseLevel)
  {
  }
  void Take(const NoiseResponse& trial) override;
  FidelityChoice Found() const override
  {
    return { this->Trial(), this->FB + this->Noise, this->HasRoot };
  }

private:
  void FindNext();

  enum
  {
    Start,
    Bracketing,
    Inside
  } Phase = Start;
  double Noise;
  double Stride = 0.0;
  double A = 0.0, B = 0.0; ///< the X of two weights
  double FA = 0.0, FB = 0.0; ///< their discrepancies above the noise
  bool IsClose = false, HasRoot = true;
};

/// The weight of the smallest estimate of the error. This is the unbiased risk where the level of
/// the noise is that of the data's root mean square, too, or given; otherwise the noise has outliers
/// or differs from place to place, or the data have jumps: then it is that of generalised
/// cross-validation. Both are flat around the minimum: a factor
/// of 1.4 costs 1 % of the error. So the weights start * 4^j are tried until the smallest estimate has
/// a larger one on both sides; the weight found is the minimum of the parabola through the three, in
/// the logarithm, which depends smoothly on the estimates. (With two more weights between, the errors
/// are the same.) Downwards the search ends where a factor of 4 gains less than 1e-3 of the mean
/// square of the noise, upwards where hardly anything changes, and both ways near 1e8 of the first
/// guess. Such an end is found if the difference that it leaves is within 10 % of the noise, as that
/// of noise without a signal.
class RiskSearch : public WeightSearch
{
public:
  RiskSearch(double noiseLevel, double start, bool isGiven = false)
    : WeightSearch(start)
    , Noise(noiseLevel)
    , IsGiven(isGiven)
  {
  }
  bool NeedsRisk() const override { return true; }
  void Take(const NoiseResponse& trial) override;
  FidelityChoice Found() const override;

private:
  double RiskAt(int exponent) const;
  void Try(double exponent);

  double Noise;
  bool IsGiven;
  double LargestVariance = std::numeric_limits<double>::infinity(); ///< the least of the trials
  std::map<int, NoiseResponse> Trials; ///< by the exponent j
  int Next = 0;
  int Best = 0; ///< the exponent of the smallest risk
  bool HasMinimum = false;
};

/// The weight that a DiscrepancySearch finds. discrepancy(lambda): the root mean square of u - f.
FidelityChoice FindFidelityByDiscrepancy(
  const std::function<double(double)>& discrepancy, double noiseLevel, double start);

} // namespace SurfaceDiffusion
