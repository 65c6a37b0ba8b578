// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// SmoothInterpolation: of values that are smoothed.

#include "Core/Models/Interpolation/InfluenceSpectrum.h"
#include "Core/Models/Interpolation/SlopeSquares.h"
#include "Core/Models/Interpolation/SmoothInterpolationWork.h"
#include "Core/Statistics/StudentFactor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

void SmoothInterpolation::FitSmoothly(
  Work& work, Result& result, const ProgressMonitor& progress) const
{
  const RepeatedValues& rows = work.Rows;
  const Eigen::Index columns = rows.Given.cols();
  const bool isGiven = this->Options.Smoothing == Choice::Given;
  const double noise =
    this->Options.Smoothing == Choice::NoiseLevel ? this->Options.NoiseLevel : 0.0;
  const auto limited = [&](double mu) { return std::min(mu, work.LargestSmoothing()); };
  const double givenMu = limited(this->Options.Mu);
  const auto measure = [&](double mu, const InfluenceSpectrum::Determinant& other,
                         const RepeatedValues& data, const ProgressMonitor& part)
  {
    this->Prepare(work, result, mu, work.None, part.Part(0.0, 0.5));
    return InfluenceSpectrum(work.Fit, data, other, part.Part(0.5, 1.0));
  };
  const auto take =
    [&](const InfluenceSpectrum& spectrum, double mu, Eigen::Index column, Eigen::Index measured)
  {
    Column& found = result.Columns[static_cast<std::size_t>(column)];
    found.Mu = mu;
    found.Score = spectrum.Score(mu, measured);
    found.DegreesOfFreedom = spectrum.DegreesOfFreedom(mu);
  };
  constexpr double apart = 1.1; // between two mu whose determinants give the trace
  const double startMu = isGiven ? givenMu : limited(this->StartSmoothing(work));
  const auto changes = [&] { return std::pair(result.IsFlattest, result.DropsNegativeCurvature); };
  InfluenceSpectrum::Determinant none;
  if (isGiven && rows.Count() > InfluenceSpectrum::FewValues)
  {
    none = measure(givenMu / apart, none, rows, progress.Part(0.0, 0.2)).Known();
  }
  auto before = changes();
  const InfluenceSpectrum start = measure(startMu, none, rows, progress.Part(0.2, 0.4));
  const bool isIndefinite =
    start.IsIndefinite() && work.Energy.IsFree() && !result.DropsNegativeCurvature;
  if (isIndefinite)
  {
    DropNegativeCurvature(work, result);
  }
  if (isIndefinite || (none.Mu > 0.0 && changes() != before))
  {
    // Determinants of two energies do not compare.
    this->FitSmoothly(work, result, progress.Part(0.4, 1.0));
    return;
  }
  before = changes();
  work.Determined = std::max<Index>(1, start.NumberOfHeld());
  if (this->Options.Smoothing == Choice::Automatic && rows.Count() < work.Determined + 2)
  {
    result.PartsWithTooFewValues = 1;
    result.EnoughPlaces = work.Determined + 2;
    this->FitExactly(work, result, progress.Part(0.4, 1.0));
    return;
  }
  if (isGiven)
  {
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      take(start, givenMu, c, c);
    }
    this->FitColumns(work, result, 0, columns, givenMu, progress.Part(0.4, 1.0));
    return;
  }
  work.Spectrum = start.Eigenvectors().cols() > 0 ? &start : nullptr;
  // One factor serves all columns that need no other; those first, so that it is there still.
  const bool needsFactor =
    this->Options.ComputeError || this->Options.KeepRange || this->Options.ComputeLeverage;
  std::vector<Eigen::Index> others;
  double done = 0.0;
  const auto at = [&](double part)
  { return 0.4 + 0.6 * (done + part) / static_cast<double>(columns); };
  for (Eigen::Index c = 0; c < columns; ++c)
  {
    const double mu = limited(start.BestSmoothing(c, noise));
    take(start, mu, c, c);
    if (!needsFactor && start.Rescale(work.Fit, mu) &&
      this->FitColumns(work, result, c, 1, mu, progress.Part(at(0.0), at(1.0))))
    {
      ++done;
    }
    else
    {
      others.push_back(c);
    }
  }
  work.Fit.Restore(); // another column may have the mu of the last one, and need its own factor
  for (const Eigen::Index c : others)
  {
    double mu = limited(start.BestSmoothing(c, noise));
    take(start, mu, c, c);
    constexpr int most = 6;
    bool isResolved = start.Resolves(mu);
    InfluenceSpectrum::Determinant last = start.Known();
    RepeatedValues column = rows;
    // Moved in: an assignment that wants memory leaves Eigen's matrix with what it has freed.
    column.Given = Values(rows.Given.col(c));
    column.Scatter = Values(rows.Scatter.col(c));
    for (int again = 0; again < most && !isResolved; ++again)
    {
      const bool isNear = mu < apart * last.Mu && last.Mu < apart * mu;
      const InfluenceSpectrum nearer = measure(isNear ? last.Mu / apart : mu, last, column,
        progress.Part(at(0.5 * again / most), at(0.5 * (again + 1) / most)));
      last = nearer.Known();
      mu = limited(nearer.BestSmoothing(0, noise));
      take(nearer, mu, c, 0);
      isResolved = nearer.Resolves(mu);
    }
    this->FitColumns(work, result, c, 1, mu, progress.Part(at(0.5), at(1.0)));
    ++done;
  }
  if (changes() != before)
  {
    // Measures of two energies do not compare, and all columns have one energy, so that their results do
    // not depend on the order of the columns.
    this->FitSmoothly(work, result, progress.Part(1.0, 1.0));
  }
}

/// Of the fit that is prepared, per place.
Vector SmoothInterpolation::FindLeverage(const Work& work, const ProgressMonitor& progress)
{
  const RepeatedValues& rows = work.Rows;
  Vector leverage(rows.Count());
  if (work.Spectrum)
  {
    leverage = work.Spectrum->Eigenvectors().cwiseAbs2() *
      work.Spectrum->Eigenvalues(work.Fit.GetSmoothing());
  }
  else
  {
    leverage = rows.Weights.cwiseProduct(work.Fit.VarianceAtPoints(progress));
  }
  return leverage.cwiseMax(0.0).cwiseMin(1.0);
}

/// With the measures of the columns in place. Returns false, and gives nothing, if the factor of
/// another mu does not resolve this one.
bool SmoothInterpolation::FitColumns(Work& work, Result& result, Eigen::Index first,
  Eigen::Index count, double mu, const ProgressMonitor& progress) const
{
  const RepeatedValues& rows = work.Rows;
  // The factor may be that of the active set of the column before.
  const bool isOfBounds = this->Options.KeepRange && first > 0;
  if (work.Fit.GetSmoothing() != mu || isOfBounds)
  {
    this->Prepare(work, result, mu, work.None, progress.Part(0.0, 0.3));
  }
  Values all = work.Start.middleCols(first, count);
  const Values forces = work.Fit.Solve(rows.Given.middleCols(first, count), all);
  if (!work.Fit.IsResolved())
  {
    work.Fit.Restore();
    return false;
  }
  Vector deviations;
  Vector ofSlopes; // their deviations
  Flags isOpen;
  if (this->Options.ComputeError)
  {
    isOpen = this->FindOpen(work);
    result.HasInfiniteError = result.HasInfiniteError || isOpen.any();
  }
  if (this->Options.ComputeLeverage)
  {
    const Vector leverage = FindLeverage(work, progress.Part(0.3, 0.4));
    for (Eigen::Index c = first; c < first + count; ++c)
    {
      result.Leverage.col(c) = leverage;
    }
  }
  if (this->Options.ComputeError && work.Spectrum)
  {
    std::tie(deviations, ofSlopes) =
      this->ErrorOverSmoothing(work, result, first, progress.Part(0.4, 0.8));
  }
  else if (this->Options.ComputeError && this->Options.Smoothing != Choice::Given)
  {
    const double fitted = work.Fit.GetSmoothing();
    std::tie(deviations, ofSlopes) =
      this->ErrorOverFactors(work, first, all.col(0), progress.Part(0.4, 0.8));
    this->Prepare(work, result, fitted, work.None, progress.Part(0.8, 0.8));
  }
  const bool isOverSmoothing = deviations.size() > 0;
  if (this->Options.ComputeError && !isOverSmoothing)
  {
    const SlopeSquares slopes(this->Assembly->Mesh(), this->Parallel);
    std::vector<InverseEntry> edges = slopes.Edges();
    const Vector diagonal = work.Fit.InverseDiagonal(progress.Part(0.4, 0.7), &edges);
    ofSlopes = slopes.OfCovariance(diagonal, edges).cwiseSqrt();
    deviations = (diagonal.cwiseMax(0.0) +
      this->VarianceOfMean(work, work.None, false, progress.Part(0.7, 0.8)))
                   .cwiseSqrt();
  }
  for (Eigen::Index c = 0; c < count; ++c)
  {
    Column& found = result.Columns[static_cast<std::size_t>(first + c)];
    found.Mu = work.Fit.GetSmoothing();
    Values u = all.col(c);
    if (this->Options.KeepRange)
    {
      Values none = forces.col(c);
      this->KeepInRange(work, result, first + c, work.None, u, none, progress.Part(0.8, 1.0));
    }
    const Vector given = rows.Given.col(first + c);
    const Vector misfit = given - work.Fit.AtPoints(u).col(0);
    const double square = rows.Weights.dot(misfit.cwiseAbs2());
    const double left = rows.Count() + rows.Repeats.sum() - found.DegreesOfFreedom;
    const double fewest = 1e-6 * rows.Count();
    const double squares = square + rows.Scatter.col(first + c).sum();
    found.Residual = std::sqrt(square / rows.Weights.sum());
    found.NoiseLevel = this->Options.NoiseLevel > 0.0 ? this->Options.NoiseLevel
                                                      : std::sqrt(squares / std::max(fewest, left));
    if (this->Options.ComputeError)
    {
      // Nothing is left if the fit reaches all values, by its freedom or because they are alike.
      constexpr double resolved = 16.0 * std::numeric_limits<double>::epsilon();
      const bool isKnown = this->Options.NoiseLevel > 0.0 || work.Spectrum ||
        (left > fewest &&
          std::sqrt(squares / rows.Weights.sum()) >
            work.RoundOff(first + c, resolved, result.IsFlattest));
      const double factor = this->Options.NoiseLevel > 0.0 ? 1.0 : StudentFactor(left);
      const double scale = !isKnown ? std::numeric_limits<double>::quiet_NaN()
        : isOverSmoothing           ? 1.0
                                    : factor * found.NoiseLevel;
      result.Error.col(first + c) = isOpen.select(
        std::numeric_limits<double>::infinity(), scale * deviations.array()); // without bounds
      result.SlopeError.col(first + c) =
        isOpen.select(std::numeric_limits<double>::infinity(), scale * ofSlopes.array());
      result.HasUnknownError = result.HasUnknownError || result.Error.col(first + c).hasNaN();
    }
    result.U.col(first + c) = u;
  }
  return true;
}

} // namespace SurfaceDiffusion
