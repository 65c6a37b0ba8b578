// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/SmoothInterpolation.h"

#include "Core/Models/Interpolation/InfluenceSpectrum.h"
#include "Core/Models/Interpolation/RangeConstraint.h"
#include "Core/Models/Interpolation/SmoothInterpolationWork.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/NotPositiveDefinite.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

SmoothInterpolation::SmoothInterpolation(std::shared_ptr<const Assembler> assembler,
  CornerWeights coefficients, const Settings& settings, const ParallelFor& parallel)
  : Assembly(std::move(assembler))
  , Coefficients(std::move(coefficients))
  , Options(settings)
  , Parallel(parallel)
{
}

SmoothInterpolation::Result SmoothInterpolation::Fit(
  const ScatteredValues& data, const ProgressMonitor& progress) const
{
  const TriangleMesh& mesh = this->Assembly->Mesh();
  const Index n = mesh.NumberOfVertices();
  const Eigen::Index columns = data.Given.cols();
  if (n == 0) // no triangle has an area
  {
    Result nothing;
    nothing.U.resize(0, columns);
    nothing.Columns.resize(static_cast<std::size_t>(columns));
    return nothing;
  }
  if (data.Count() == 0)
  {
    throw std::runtime_error("no value is known; allowed: one or more");
  }
  if (this->Options.Smoothing == Choice::Given && !(this->Options.Mu > 0.0))
  {
    throw std::invalid_argument("the given mu is not above 0");
  }
  if (this->Options.Smoothing == Choice::NoiseLevel && !(this->Options.NoiseLevel > 0.0))
  {
    throw std::invalid_argument("the given noise level is not above 0");
  }
  Work work(*this->Assembly, this->Coefficients, this->Options, data, this->Parallel);
  ScatteredValues& rows = work.Data.Rows;
  Result result;
  result.RepeatedValues = work.Data.Repeated;
  result.ContradictingPlaces = work.Data.Contradicting;
  result.Columns.resize(static_cast<std::size_t>(columns));

  // Values are measured from the mean of their component: the errors of a solve are relative to the
  // contrast then.
  work.Component.resize(n);
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    std::fill(work.Component.begin() + mesh.ComponentsBegin()[c],
      work.Component.begin() + mesh.ComponentsBegin()[c + 1], c);
  }
  work.Weights = Vector::Zero(mesh.NumberOfComponents());
  for (Index i = 0; i < rows.Count(); ++i)
  {
    work.Weights[work.ComponentOf(i)] += rows.Weights[i];
  }
  work.Lowest = rows.Given.colwise().minCoeff();
  work.Highest = rows.Given.colwise().maxCoeff();
  work.Origin = Values::Zero(mesh.NumberOfComponents(), columns);
  for (Index i = 0; i < rows.Count(); ++i)
  {
    const Index c = work.ComponentOf(i);
    work.Origin.row(c) += rows.Weights[i] / work.Weights[c] * rows.Given.row(i);
  }
  for (Index i = 0; i < rows.Count(); ++i)
  {
    rows.Given.row(i) -= work.Origin.row(work.ComponentOf(i));
  }
  work.Open = Flags::Constant(n, false);
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index size = mesh.ComponentsBegin()[c + 1] - begin;
    if (work.Weights[c] > 0.0)
    {
      ++work.Parts;
      work.Area += mesh.ControlAreas().segment(begin, size).sum();
      continue;
    }
    work.Open.segment(begin, size) = true;
    ++result.UndeterminedComponents;
  }
  work.Start = Values::Zero(n, columns);

  constexpr Index fewest = 3;
  result.U.resize(n, columns);
  if (this->Options.ComputeError)
  {
    result.Error = Values::Zero(n, columns);
  }
  result.HasTooFewValues = this->Options.Smoothing == Choice::Automatic && rows.Count() < fewest;
  if (this->Options.Smoothing == Choice::Exact || result.HasTooFewValues)
  {
    this->FitExactly(work, result, progress);
  }
  else
  {
    this->FitSmoothly(work, result, progress);
  }
  for (Index i = 0; i < n; ++i)
  {
    result.U.row(i) += work.Origin.row(work.Component[i]);
  }
  for (Eigen::Index c = 0; c < columns && this->Options.KeepRange; ++c)
  {
    // To the last bit, which the origin rounds
    result.U.col(c) =
      result.U.col(c).cwiseMax(data.Given.col(c).minCoeff()).cwiseMin(data.Given.col(c).maxCoeff());
  }
  for (Index i = 0; i < n; ++i)
  {
    if (work.Open[i])
    {
      result.U.row(i).setConstant(std::numeric_limits<double>::quiet_NaN());
      if (this->Options.ComputeError)
      {
        result.Error.row(i).setConstant(std::numeric_limits<double>::quiet_NaN());
      }
    }
  }
  progress.Report(1.0);
  return result;
}

void SmoothInterpolation::KeepInRange(Work& work, Result& result, Eigen::Index column,
  const Flags& held, Values& u, Values& forces, const ProgressMonitor& progress) const
{
  const double mu = work.Fit.GetSmoothing();
  const auto n = static_cast<Index>(u.rows());
  Vector low(n), high(n);
  for (Index i = 0; i < n; ++i)
  {
    const double origin = work.Origin(work.Component[i], column);
    low[i] = work.Lowest[column] - origin;
    high[i] = work.Highest[column] - origin;
  }
  const RangeConstraint range(work.Data.Rows, column, this->Options.Smoothing == Choice::Exact,
    std::move(low), std::move(high));
  const auto prepare = [&](const Flags& all, const ProgressMonitor& part)
  { this->Prepare(work, result, mu, all, part); };
  const bool isOptimal = range.Impose(work.Fit, prepare, held, u, forces, progress);
  result.RangeIsOptimal = result.RangeIsOptimal && isOptimal;
}

/// mu at which the fit smooths over three times the distance of the values.
double SmoothInterpolation::StartSmoothing(const Work& work) const
{
  constexpr double reach = 3.0;
  const ScatteredValues& rows = work.Data.Rows;
  const double diffusivity = this->Options.Rim == RimCondition::Free
    ? 1.0
    : this->Coefficients.sum() / CotanWeights(this->Assembly->Mesh(), this->Parallel).sum();
  const double square = reach * reach * work.Area / rows.Count();
  const double scale =
    this->Options.Kappa * this->Options.Kappa + std::max(diffusivity, 1e-300) / square;
  return rows.Weights.sum() / work.Area / (scale * scale);
}

void SmoothInterpolation::Prepare(
  Work& work, Result& result, double mu, const Flags& held, const ProgressMonitor& progress) const
{
  const bool isExact = this->Options.Smoothing == Choice::Exact || result.HasTooFewValues;
  PivotCounts pivots = work.Fit.Prepare(mu, held, isExact, progress);
  const bool isFree = this->Options.Rim == RimCondition::Free;
  if (pivots.Negative > 0 && isFree && !result.DropsNegativeCurvature)
  {
    work.Energy.DropNegativeCurvature();
    work.EnergyOfMean.resize(0);
    result.DropsNegativeCurvature = true;
    pivots = work.Fit.Prepare(mu, held, isExact, progress);
  }
  if (pivots.Open > 0 && !result.IsFlattest)
  {
    // Enough to be resolved, and little beside the energy.
    const double n = static_cast<double>(held.size());
    work.Energy.AddTension(std::max(1e-6, 1e-12 * n * n) / work.Area);
    work.EnergyOfMean.resize(0);
    result.IsFlattest = true;
    pivots = work.Fit.Prepare(mu, held, isExact, progress);
  }
  if (pivots.Open > 0)
  {
    throw NotPositiveDefinite();
  }
}

/// What the error of the mean adds to the variance of the fit that is prepared, in units of s^2. The
/// variance of exact values is in units of s^2 / mu, with mu = 1. `held`: vertices that the data hold.
Vector SmoothInterpolation::VarianceOfMean(
  Work& work, const Flags& held, bool isExact, const ProgressMonitor& progress) const
{
  const ScatteredValues& rows = work.Data.Rows;
  const auto n = static_cast<Index>(held.size());
  if (!(this->Options.Kappa > 0.0))
  {
    return Vector::Zero(n);
  }
  const Index parts = this->Assembly->Mesh().NumberOfComponents();
  if (work.EnergyOfMean.size() == 0)
  {
    ScatteredValues weightless = rows;
    weightless.Weights.setZero();
    SmoothFit prior(work.Energy, weightless, Work::IsRegularMesh(*this->Assembly), this->Parallel);
    const PivotCounts pivots = prior.Prepare(1.0, work.Open, false, progress);
    Values weights = rows.Weights;
    for (Index i = 0; i < rows.Count(); ++i)
    {
      weights(i, 0) /= work.Weights[work.ComponentOf(i)];
    }
    // Constants that have no energy within round-off leave no error: all of it is in the fit.
    work.EnergyOfMean = Vector::Zero(parts);
    if (pivots.Open + pivots.Negative == 0)
    {
      const Values covariances = prior.InverseAtPoints(weights);
      for (Index i = 0; i < rows.Count(); ++i)
      {
        work.EnergyOfMean[work.ComponentOf(i)] += weights(i, 0) * covariances(i, 0);
      }
    }
  }
  Values ones = held.select(Values::Ones(n, 1), 0.0);
  work.Fit.Solve(Values::Ones(rows.Count(), 1), ones);
  Vector variances(n);
  for (Index i = 0; i < n; ++i)
  {
    const Index c = work.Component[i];
    const double ofNoise = isExact ? 0.0 : 1.0 / work.Weights[c];
    const double variance = ofNoise + work.EnergyOfMean[c] / work.Fit.GetSmoothing();
    variances[i] = variance * std::pow(1.0 - ones(i, 0), 2);
  }
  return variances;
}

void SmoothInterpolation::FitSmoothly(
  Work& work, Result& result, const ProgressMonitor& progress) const
{
  const ScatteredValues& rows = work.Data.Rows;
  const Eigen::Index columns = rows.Given.cols();
  const bool isGiven = this->Options.Smoothing == Choice::Given;
  const double noise =
    this->Options.Smoothing == Choice::NoiseLevel ? this->Options.NoiseLevel : 0.0;
  const double largest = work.LargestSmoothing();
  const double givenMu = std::min(largest, this->Options.Mu);
  const auto measure = [&](double mu, const ProgressMonitor& part)
  {
    this->Prepare(work, result, mu, work.Open, part.Part(0.0, 0.5));
    return InfluenceSpectrum(work.Fit, rows, this->Options.Seed, isGiven, part.Part(0.5, 1.0));
  };
  const auto take = [&](const InfluenceSpectrum& spectrum, double mu, Eigen::Index column)
  {
    Column& found = result.Columns[static_cast<std::size_t>(column)];
    found.Mu = mu;
    found.Score = spectrum.Score(mu, column);
    found.DegreesOfFreedom = spectrum.DegreesOfFreedom(mu);
  };
  const InfluenceSpectrum start = measure(
    isGiven ? givenMu : std::min(largest, this->StartSmoothing(work)), progress.Part(0.0, 0.4));
  if (isGiven)
  {
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      take(start, givenMu, c);
    }
    this->FitColumns(work, result, 0, columns, givenMu, progress.Part(0.4, 1.0));
    return;
  }
  const bool wasFlattest = result.IsFlattest;
  const bool didDrop = result.DropsNegativeCurvature;
  // One factor serves all columns that need no other; those first, so that it is there still.
  const bool needsFactor = this->Options.ComputeError || this->Options.KeepRange;
  std::vector<Eigen::Index> others;
  double done = 0.0;
  const auto at = [&](double part)
  { return 0.4 + 0.6 * (done + part) / static_cast<double>(columns); };
  for (Eigen::Index c = 0; c < columns; ++c)
  {
    const double mu = std::min(largest, start.BestSmoothing(c, noise));
    take(start, mu, c);
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
    double mu = std::min(largest, start.BestSmoothing(c, noise));
    take(start, mu, c);
    constexpr int most = 3;
    bool isResolved = start.Resolves(mu);
    for (int again = 0; again < most && !isResolved; ++again)
    {
      const InfluenceSpectrum nearer = measure(mu, progress.Part(at(0.0), at(0.5)));
      mu = std::min(largest, nearer.BestSmoothing(c, noise));
      take(nearer, mu, c);
      isResolved = nearer.Resolves(mu);
    }
    this->FitColumns(work, result, c, 1, mu, progress.Part(at(0.5), at(1.0)));
    ++done;
  }
  if (columns > 1 && (result.IsFlattest != wasFlattest || result.DropsNegativeCurvature != didDrop))
  {
    // All columns have one energy, so that their results do not depend on the order of the columns.
    this->FitSmoothly(work, result, progress.Part(1.0, 1.0));
  }
}

/// With the measures of the columns in place. Returns false, and gives nothing, if the factor of
/// another mu does not resolve this one.
bool SmoothInterpolation::FitColumns(Work& work, Result& result, Eigen::Index first,
  Eigen::Index count, double mu, const ProgressMonitor& progress) const
{
  const ScatteredValues& rows = work.Data.Rows;
  // The factor may be that of the active set of the column before.
  const bool isOfBounds = this->Options.KeepRange && first > 0;
  if (work.Fit.GetSmoothing() != mu || isOfBounds)
  {
    this->Prepare(work, result, mu, work.Open, progress.Part(0.0, 0.3));
  }
  Values all = work.Start.middleCols(first, count);
  const Values forces = work.Fit.Solve(rows.Given.middleCols(first, count), all);
  if (!work.Fit.IsResolved())
  {
    work.Fit.Restore();
    return false;
  }
  Vector deviations;
  if (this->Options.ComputeError)
  {
    deviations = (work.Fit.InverseDiagonal(progress.Part(0.4, 0.7)).cwiseMax(0.0) +
      this->VarianceOfMean(work, work.Open, false, progress.Part(0.7, 0.8)))
                   .cwiseSqrt();
  }
  for (Eigen::Index c = 0; c < count; ++c)
  {
    Column& found = result.Columns[static_cast<std::size_t>(first + c)];
    Values u = all.col(c);
    if (this->Options.KeepRange)
    {
      Values none = forces.col(c);
      this->KeepInRange(work, result, first + c, work.Open, u, none, progress.Part(0.8, 1.0));
    }
    const Vector given = rows.Given.col(first + c);
    const Vector misfit = given - work.Fit.AtPoints(u).col(0);
    const double square = rows.Weights.dot(misfit.cwiseAbs2());
    const double left = rows.Count() - found.DegreesOfFreedom;
    const double fewest = 1e-6 * rows.Count();
    const double free = std::max(fewest, left);
    found.Residual = std::sqrt(square / rows.Weights.sum());
    found.NoiseLevel =
      this->Options.NoiseLevel > 0.0 ? this->Options.NoiseLevel : std::sqrt(square / free);
    if (this->Options.ComputeError)
    {
      // Nothing is left if the fit reaches all values, by its freedom or because they are alike.
      constexpr double resolved = 16.0 * std::numeric_limits<double>::epsilon();
      const bool isKnown = this->Options.NoiseLevel > 0.0 ||
        (left > fewest && found.Residual > resolved * work.SizeOf(first + c));
      result.Error.col(first + c) = // without bounds
        (isKnown ? found.NoiseLevel : std::numeric_limits<double>::quiet_NaN()) * deviations;
      result.HasUnknownError = result.HasUnknownError || !isKnown;
    }
    found.Roughness = work.Energy.Squares(u)[0];
    result.U.col(first + c) = u;
  }
  return true;
}

} // namespace SurfaceDiffusion
