// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/SmoothInterpolation.h"

#include "Core/Foundation/Random.h"
#include "Core/Models/Interpolation/InfluenceSpectrum.h"
#include "Core/Models/Interpolation/RangeConstraint.h"
#include "Core/Models/Interpolation/SmoothInterpolationWork.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Solvers/NotPositiveDefinite.h"
#include "Core/Statistics/StudentFactor.h"
#include "Core/Surface/ComponentMeshes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

/// The values of each component, with its own numbers of vertices.
std::vector<RepeatedValues> ByComponent(const TriangleMesh& mesh, const RepeatedValues& all)
{
  const std::vector<Index>& begin = mesh.ComponentsBegin();
  std::vector<RepeatedValues> parts(static_cast<std::size_t>(mesh.NumberOfComponents()));
  std::vector<std::vector<Index>> rows(parts.size());
  for (Index i = 0; i < all.Count(); ++i)
  {
    SurfacePoint place = all.Places[i];
    std::size_t counting = 0;
    while (place.Coordinates[counting] == 0.0)
    {
      ++counting;
    }
    const Index vertex = place.Vertices[counting];
    const auto after = std::upper_bound(begin.begin(), begin.end(), vertex);
    const auto c = static_cast<std::size_t>(after - begin.begin()) - 1;
    for (std::size_t a = 0; a < 3; ++a)
    {
      place.Vertices[a] = (place.Coordinates[a] == 0.0 ? vertex : place.Vertices[a]) - begin[c];
    }
    parts[c].Places.push_back(place);
    rows[c].push_back(i);
  }
  for (std::size_t c = 0; c < rows.size(); ++c)
  {
    const Index count = parts[c].Count();
    parts[c].Given.resize(count, all.Given.cols());
    parts[c].Weights.resize(count);
    parts[c].Scatter.resize(count, all.Given.cols());
    parts[c].Repeats.resize(count);
    for (Index i = 0; i < count; ++i)
    {
      const Index row = rows[c][static_cast<std::size_t>(i)];
      parts[c].Given.row(i) = all.Given.row(row);
      parts[c].Weights[i] = all.Weights[row];
      parts[c].Scatter.row(i) = all.Scatter.row(row);
      parts[c].Repeats[i] = all.Repeats[row];
    }
  }
  return parts;
}

/// The numbers of a column over the components, from those of each with its values.
SmoothInterpolation::Column Together(const std::vector<SmoothInterpolation::Column>& parts,
  const std::vector<const RepeatedValues*>& values)
{
  if (parts.size() == 1)
  {
    return parts[0];
  }
  SmoothInterpolation::Column all;
  Index most = 0;
  double count = 0.0;
  double weight = 0.0;
  double free = 0.0;
  double noise = 0.0;
  for (std::size_t c = 0; c < parts.size(); ++c)
  {
    const SmoothInterpolation::Column& part = parts[c];
    const Index own = values[c]->Count();
    const double total = values[c]->Weights.sum();
    if (own > most)
    {
      most = own;
      all.Mu = part.Mu;
    }
    all.Score += own * part.Score;
    all.Residual += total * part.Residual * part.Residual;
    all.DegreesOfFreedom += part.DegreesOfFreedom;
    all.Energy += part.Energy;
    const double left =
      std::max(1e-6 * own, own + values[c]->Repeats.sum() - part.DegreesOfFreedom);
    free += part.NoiseLevel > 0.0 ? left : 0.0;
    noise += left * part.NoiseLevel * part.NoiseLevel;
    count += own;
    weight += total;
  }
  all.Score /= count;
  all.Residual = std::sqrt(all.Residual / weight);
  all.NoiseLevel = free > 0.0 ? std::sqrt(noise / free) : 0.0;
  return all;
}

} // namespace

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
  const MergedValues merged(data);
  Result result;
  result.RepeatedValues = merged.Repeated;
  result.ContradictingPlaces = merged.Contradicting;
  result.Columns.resize(static_cast<std::size_t>(columns));
  result.U = Values::Constant(n, columns, std::numeric_limits<double>::quiet_NaN());
  if (this->Options.ComputeError)
  {
    result.Error = result.U;
  }
  const Eigen::RowVectorXd lowest = merged.Rows.Given.colwise().minCoeff();
  const Eigen::RowVectorXd highest = merged.Rows.Given.colwise().maxCoeff();
  const std::vector<RepeatedValues> values = ByComponent(mesh, { data, merged });
  const ComponentMeshes meshes(mesh);
  std::vector<const RepeatedValues*> valuesOfParts;
  std::vector<std::vector<Column>> columnsOfParts(result.Columns.size());
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const RepeatedValues& rows = values[static_cast<std::size_t>(c)];
    if (rows.Count() == 0)
    {
      ++result.UndeterminedComponents;
      continue;
    }
    const Index begin = mesh.ComponentsBegin()[c];
    const Index size = mesh.ComponentsBegin()[c + 1] - begin;
    const ProgressMonitor own =
      progress.Part(static_cast<double>(begin) / n, static_cast<double>(begin + size) / n);
    const Result part = size == n
      ? this->FitPart(rows, lowest, highest, own)
      : this->OfComponent(meshes, c).FitPart(rows, lowest, highest, own);
    result.U.middleRows(begin, size) = part.U;
    if (this->Options.ComputeError)
    {
      result.Error.middleRows(begin, size) = part.Error;
    }
    for (std::size_t column = 0; column < result.Columns.size(); ++column)
    {
      columnsOfParts[column].push_back(part.Columns[column]);
    }
    valuesOfParts.push_back(&rows);
    ++result.Parts;
    result.PartsWithTooFewValues += part.PartsWithTooFewValues;
    result.EnoughPlaces = std::max(result.EnoughPlaces, part.EnoughPlaces);
    result.HasUnknownError = result.HasUnknownError || part.HasUnknownError;
    result.HasInfiniteError = result.HasInfiniteError || part.HasInfiniteError;
    result.IsFlattest = result.IsFlattest || part.IsFlattest;
    result.DropsNegativeCurvature = result.DropsNegativeCurvature || part.DropsNegativeCurvature;
    result.RangeIsOptimal = result.RangeIsOptimal && part.RangeIsOptimal;
  }
  for (std::size_t column = 0; column < result.Columns.size(); ++column)
  {
    result.Columns[column] = Together(columnsOfParts[column], valuesOfParts);
  }
  progress.Report(1.0);
  return result;
}

/// The same for a component of the surface.
SmoothInterpolation SmoothInterpolation::OfComponent(const ComponentMeshes& meshes, Index c) const
{
  const std::vector<Index> triangles = meshes.TrianglesOf(c);
  const auto count = static_cast<Index>(triangles.size());
  CornerWeights coefficients(count, 3);
  for (Index t = 0; t < count; ++t)
  {
    coefficients.row(t) = this->Coefficients.row(triangles[static_cast<std::size_t>(t)]);
  }
  // Loops over few triangles are not worth threads.
  const ParallelFor& parallel = count > BlockSize ? this->Parallel : SerialFor();
  return { std::make_shared<const Assembler>(meshes.Make(c), parallel), std::move(coefficients),
    this->Options, parallel };
}

SmoothInterpolation::Result SmoothInterpolation::FitPart(const RepeatedValues& rows,
  const Eigen::RowVectorXd& lowest, const Eigen::RowVectorXd& highest,
  const ProgressMonitor& progress) const
{
  const Index n = this->Assembly->Mesh().NumberOfVertices();
  const Eigen::Index columns = rows.Given.cols();
  Work work(*this->Assembly, this->Coefficients, this->Options, rows, this->Parallel);
  work.Lowest = lowest;
  work.Highest = highest;
  work.Start = Values::Zero(n, columns);
  Result result;
  result.Columns.resize(static_cast<std::size_t>(columns));
  result.Parts = 1;
  result.U.resize(n, columns);
  if (this->Options.ComputeError)
  {
    result.Error = Values::Zero(n, columns);
  }
  result.PartsWithTooFewValues =
    this->Options.Smoothing == Choice::Automatic && rows.Count() < result.EnoughPlaces ? 1 : 0;
  if (this->Options.Smoothing == Choice::Exact || result.PartsWithTooFewValues > 0)
  {
    this->FitExactly(work, result, progress);
  }
  else
  {
    this->FitSmoothly(work, result, progress);
  }
  for (Eigen::Index c = 0; c < columns; ++c)
  {
    Column& found = result.Columns[static_cast<std::size_t>(c)];
    found.Energy = 0.5 * found.Mu * work.Energy.Squares(result.U.col(c))[0] +
      0.5 * work.TotalWeight * found.Residual * found.Residual;
  }
  result.U.rowwise() += work.Origin;
  for (Eigen::Index c = 0; c < columns && this->Options.KeepRange; ++c)
  {
    // To the last bit, which the origin rounds
    result.U.col(c) = result.U.col(c).cwiseMax(lowest[c]).cwiseMin(highest[c]);
  }
  return result;
}

void SmoothInterpolation::KeepInRange(Work& work, Result& result, Eigen::Index column,
  const Flags& held, Values& u, Values& forces, const ProgressMonitor& progress) const
{
  const double mu = work.Fit.GetSmoothing();
  const auto n = static_cast<Index>(u.rows());
  const double origin = work.Origin[column];
  const RangeConstraint range(work.Rows, column, this->Options.Smoothing == Choice::Exact,
    Vector::Constant(n, work.Lowest[column] - origin),
    Vector::Constant(n, work.Highest[column] - origin));
  const auto prepare = [&](const Flags& all, const ProgressMonitor& part)
  { this->Prepare(work, result, mu, all, part); };
  const bool isOptimal = range.Impose(work.Fit, prepare, held, u, forces, progress);
  result.RangeIsOptimal = result.RangeIsOptimal && isOptimal;
}

/// mu at which the fit smooths over three times the distance of the values.
double SmoothInterpolation::StartSmoothing(const Work& work) const
{
  constexpr double reach = 3.0;
  const ScatteredValues& rows = work.Rows;
  const double diffusivity = work.Energy.IsFree()
    ? 1.0
    : this->Coefficients.sum() / CotanWeights(this->Assembly->Mesh(), this->Parallel).sum();
  const double square = reach * reach * work.Area / rows.Count();
  const double scale =
    this->Options.Kappa * this->Options.Kappa + std::max(diffusivity, 1e-300) / square;
  return rows.Weights.sum() / work.Area / (scale * scale);
}

void SmoothInterpolation::DropNegativeCurvature(Work& work, Result& result)
{
  work.Energy.DropNegativeCurvature();
  work.EnergyOfMean = -1.0;
  result.DropsNegativeCurvature = true;
}

void SmoothInterpolation::Prepare(
  Work& work, Result& result, double mu, const Flags& held, const ProgressMonitor& progress) const
{
  const bool isExact = this->Options.Smoothing == Choice::Exact || result.PartsWithTooFewValues > 0;
  PivotCounts pivots = work.Fit.Prepare(mu, held, isExact, progress);
  if (pivots.Negative > 0 && work.Energy.IsFree() && !result.DropsNegativeCurvature)
  {
    DropNegativeCurvature(work, result);
    pivots = work.Fit.Prepare(mu, held, isExact, progress);
  }
  if (pivots.Open > 0 && !isExact && !result.IsFlattest)
  {
    // mu may be so large that what the values determine is lost in round-off.
    const double moderate = std::min(mu, this->StartSmoothing(work));
    const bool isOpen =
      moderate == mu || work.Fit.Prepare(moderate, held, isExact, progress).Open > 0;
    while (!isOpen && pivots.Open > 0 && mu > moderate)
    {
      mu = std::max(moderate, 0.1 * mu);
      pivots = work.Fit.Prepare(mu, held, isExact, progress);
    }
  }
  if (pivots.Open > 0 && !result.IsFlattest)
  {
    // Enough to be resolved, and little beside the energy.
    const double n = static_cast<double>(held.size());
    work.Energy.AddTension(std::max(1e-6, 1e-12 * n * n) / work.Area);
    work.EnergyOfMean = -1.0;
    work.Open = pivots.Open;
    result.IsFlattest = true;
    pivots = work.Fit.Prepare(mu, held, isExact, progress);
  }
  if (pivots.Open > 0)
  {
    throw NotPositiveDefinite();
  }
}

/// The vertices that functions reach which have neither values nor, but for the tension, an energy: of
/// all functions the inverse keeps these when it is applied again and again.
Flags SmoothInterpolation::FindOpen(const Work& work) const
{
  constexpr Index samples = 8; // one of them may vanish where others do not
  constexpr double resolved = 1e-6;
  if (work.Open == 0)
  {
    return work.None;
  }
  Values v(work.None.size(), samples);
  for (Index i = 0; i < static_cast<Index>(v.rows()); ++i)
  {
    for (Index c = 0; c < samples; ++c)
    {
      v(i, c) = UniformRandom(0, c, i);
    }
  }
  for (int round = 0; round < 6; ++round)
  {
    Values forces;
    work.Energy.MultiplyStiffness(v, forces);
    work.Fit.ApplyInverse(forces);
    v = forces / forces.cwiseAbs().maxCoeff();
  }
  return v.array().abs().rowwise().maxCoeff() > resolved;
}

/// What the error of the mean adds to the variance of the fit that is prepared, in units of s^2. The
/// variance of exact values is in units of s^2 / mu, with mu = 1. `held`: vertices that the data hold.
Vector SmoothInterpolation::VarianceOfMean(
  Work& work, const Flags& held, bool isExact, const ProgressMonitor& progress) const
{
  const ScatteredValues& rows = work.Rows;
  const auto n = static_cast<Index>(held.size());
  if (!(this->Options.Kappa > 0.0))
  {
    return Vector::Zero(n);
  }
  if (work.EnergyOfMean < 0.0)
  {
    ScatteredValues weightless = rows;
    weightless.Weights.setZero();
    SmoothFit prior(work.Energy, weightless, Work::IsRegularMesh(*this->Assembly), this->Parallel);
    const PivotCounts pivots = prior.Prepare(1.0, work.None, false, progress);
    const Values weights = rows.Weights / work.TotalWeight;
    // Constants that have no energy within round-off leave no error: all of it is in the fit.
    work.EnergyOfMean = 0.0;
    if (pivots.Open + pivots.Negative == 0)
    {
      work.EnergyOfMean = std::max(0.0, weights.cwiseProduct(prior.InverseAtPoints(weights)).sum());
    }
  }
  Values ones = held.select(Values::Ones(n, 1), 0.0);
  work.Fit.Solve(Values::Ones(rows.Count(), 1), ones);
  const double ofNoise = isExact ? 0.0 : 1.0 / work.TotalWeight;
  const double variance = ofNoise + work.EnergyOfMean / work.Fit.GetSmoothing();
  return variance * (1.0 - ones.col(0).array()).square();
}

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
  const bool needsFactor = this->Options.ComputeError || this->Options.KeepRange;
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
    column.Given = rows.Given.col(c);
    column.Scatter = rows.Scatter.col(c);
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
  Flags isOpen;
  if (this->Options.ComputeError)
  {
    isOpen = this->FindOpen(work);
    result.HasInfiniteError = result.HasInfiniteError || isOpen.any();
  }
  if (this->Options.ComputeError && work.Spectrum)
  {
    deviations = this->ErrorOverSmoothing(work, result, first, progress.Part(0.4, 0.8));
  }
  else if (this->Options.ComputeError)
  {
    deviations = (work.Fit.InverseDiagonal(progress.Part(0.4, 0.7)).cwiseMax(0.0) +
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
    if (this->Options.ComputeError && work.Spectrum)
    {
      result.Error.col(first + c) = isOpen.select(
        std::numeric_limits<double>::infinity(), deviations.array()); // without bounds
      result.HasUnknownError = result.HasUnknownError || deviations.hasNaN();
    }
    else if (this->Options.ComputeError)
    {
      // Nothing is left if the fit reaches all values, by its freedom or because they are alike.
      constexpr double resolved = 16.0 * std::numeric_limits<double>::epsilon();
      const bool isKnown = this->Options.NoiseLevel > 0.0 ||
        (left > fewest &&
          std::sqrt(squares / rows.Weights.sum()) >
            work.RoundOff(first + c, resolved, result.IsFlattest));
      const double factor = this->Options.NoiseLevel > 0.0 ? 1.0 : StudentFactor(left);
      result.Error.col(first + c) = isOpen.select(std::numeric_limits<double>::infinity(),
        (isKnown ? factor * found.NoiseLevel : std::numeric_limits<double>::quiet_NaN()) *
          deviations.array()); // without bounds
      result.HasUnknownError = result.HasUnknownError || !isKnown;
    }
    result.U.col(first + c) = u;
  }
  return true;
}

} // namespace SurfaceDiffusion
