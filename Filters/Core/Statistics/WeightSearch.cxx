// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Statistics/WeightSearch.h"

namespace SurfaceDiffusion
{

void DiscrepancySearch::Take(const WeightTrial& trial)
{
  const double f = trial.Discrepancy - this->Noise;
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
    this->HasRoot = std::abs(this->B - this->Origin) <= std::log(1e8);
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

constexpr int LargestExponent = 28; ///< 2^28 is more than 1e8
constexpr double SmallestGain = 1e-3; ///< of a factor of 4, of the mean square of the noise

} // namespace

void RiskSearch::Take(const WeightTrial& trial)
{
  this->Trials[this->Next] = trial;
  for (const auto& [exponent, tried] : this->Trials)
  {
    this->Best = tried.Risk < this->RiskAt(this->Best) ? exponent : this->Best;
  }
  for (const int side : { 2, -2, 1, -1 })
  {
    const bool isOuter = std::abs(side) == 2;
    if (!this->IsKnown(this->Best + side) && !(isOuter && this->HasMinimum))
    {
      this->Done = isOuter && this->IsEnd(side);
      this->Next = this->Best + (this->Done ? 0 : side);
      this->X = this->Origin + this->Next * std::log(2.0);
      return;
    }
    this->HasMinimum = this->HasMinimum || side == -2;
  }
  const double left = this->RiskAt(this->Best - 1) - this->RiskAt(this->Best);
  const double right = this->RiskAt(this->Best + 1) - this->RiskAt(this->Best);
  const double shift = left + right > 0.0 ? 0.5 * (left - right) / (left + right) : 0.0;
  this->Done = true;
  this->X = this->Origin + (this->Best + shift) * std::log(2.0);
}

/// Whether nothing is sought farther on the side of the best weight. The risk is flat far below the
/// best weights, too, so that upwards only a minimum is an end.
bool RiskSearch::IsEnd(int side) const
{
  const int before = this->Best - side;
  return std::abs(this->Best) >= LargestExponent ||
    (side < 0 && this->IsKnown(before) &&
      this->RiskAt(before) - this->RiskAt(this->Best) < SmallestGain * this->Noise * this->Noise);
}

FidelityChoice RiskSearch::Found() const
{
  const double discrepancy = this->Trials.at(this->Best).Discrepancy;
  return { this->Trial(), discrepancy,
    this->HasMinimum || std::abs(discrepancy - this->Noise) <= 0.1 * this->Noise };
}

FidelityChoice FindFidelityByDiscrepancy(
  const std::function<double(double)>& discrepancy, double noiseLevel, double start)
{
  DiscrepancySearch search(noiseLevel, start);
  while (!search.IsDone())
  {
    search.Take({ discrepancy(search.Trial()) });
  }
  return search.Found();
}

} // namespace SurfaceDiffusion
