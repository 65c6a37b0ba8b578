// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/WeightSearch.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

void DiscrepancySearch::Take(const NoiseResponse& trial)
{
  const double f = std::sqrt(trial.MeanSquare) - this->Noise;
  switch (this->Phase)
  {
    case Start:
      this->FA = f;
      this->A = this->X;
      this->Stride = f > 0.0 ? std::log(4.0) : -std::log(4.0);
      this->Phase = Bracketing;
      break;
    case Inside:
      if (f * this->FB <= 0.0)
      {
        this->A = this->B;
        this->FA = this->FB;
      }
      else
      {
        this->FA *= 0.5; // the same end twice: pull the other one in
      }
      this->IsClose = std::abs(this->X - this->B) < 0.01 || f == 0.0;
      break;
    default:
      break;
  }
  this->B = this->X;
  this->FB = f;
  this->FindNext();
}

void DiscrepancySearch::FindNext()
{
  if (this->Phase == Bracketing && this->FA * this->FB > 0.0)
  {
    this->HasRoot = std::abs(this->B) <= std::log(1e8);
    this->A = this->B;
    this->FA = this->FB;
    if (this->HasRoot)
    {
      this->X = this->B + this->Stride;
      return;
    }
  }
  else if (!this->IsClose && std::abs(this->B - this->A) > 0.01 && this->FA != this->FB)
  {
    this->Phase = Inside;
    this->X = (this->A * this->FB - this->B * this->FA) / (this->FB - this->FA);
    return;
  }
  this->Done = true;
  this->X = this->B;
}

namespace
{

constexpr int LargestExponent = 14; ///< 4^14 is more than 1e8
constexpr double MostFreedom = 0.98;
constexpr double LargestExcess = 1.3; ///< of the mean square over that of the level of the noise
constexpr double SmallestGain = 1e-3; ///< of a factor of 4, of the mean square of the noise

} // namespace

void RiskSearch::Take(const NoiseResponse& trial)
{
  this->Trials[this->Next] = trial;
  this->LargestVariance = std::min(this->LargestVariance, trial.LargestVariance());
  for (const auto& [exponent, tried] : this->Trials)
  {
    this->Best = this->RiskAt(exponent) < this->RiskAt(this->Best) ? exponent : this->Best;
  }
  const double gain = SmallestGain * this->Noise * this->Noise;
  const int first = this->Trials.begin()->first;
  const int last = this->Trials.rbegin()->first;
  // Far below the best weights the estimate is flat: it has to rise before the end is upwards.
  if (last < LargestExponent && this->Trials.at(last).Freedom < MostFreedom &&
    (last == 0 || this->RiskAt(last) - this->RiskAt(this->Best) < gain))
  {
    return this->Try(last + 1);
  }
  if (this->Best == first && first > -LargestExponent &&
    (first == 0 || this->RiskAt(first + 1) - this->RiskAt(first) > gain))
  {
    return this->Try(first - 1);
  }
  this->Done = true;
  this->HasMinimum = this->Best > first && this->Best < last;
  double shift = 0.0;
  if (this->HasMinimum)
  {
    const double left = this->RiskAt(this->Best - 1) - this->RiskAt(this->Best);
    const double right = this->RiskAt(this->Best + 1) - this->RiskAt(this->Best);
    shift = left + right > 0.0 ? 0.5 * (left - right) / (left + right) : 0.0;
  }
  this->Try(this->Best + shift);
}

void RiskSearch::Try(double exponent)
{
  this->Next = static_cast<int>(exponent);
  this->X = exponent * std::log(4.0);
}

double RiskSearch::RiskAt(int exponent) const
{
  const NoiseResponse& trial = this->Trials.at(exponent);
  return this->IsGiven || this->LargestVariance <= LargestExcess * this->Noise * this->Noise
    ? trial.Risk(this->Noise)
    : trial.CrossValidation();
}

FidelityChoice RiskSearch::Found() const
{
  const double discrepancy = std::sqrt(this->Trials.at(this->Best).MeanSquare);
  return { this->Trial(), discrepancy,
    this->HasMinimum || std::abs(discrepancy - this->Noise) <= 0.1 * this->Noise };
}

FidelityChoice FindFidelityByDiscrepancy(
  const std::function<double(double)>& discrepancy, double noiseLevel, double start)
{
  DiscrepancySearch search(noiseLevel, start);
  while (!search.IsDone())
  {
    search.Take({ std::pow(discrepancy(search.Trial()), 2) });
  }
  return search.Found();
}

} // namespace SurfaceDiffusion
