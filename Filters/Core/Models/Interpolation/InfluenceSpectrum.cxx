// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/InfluenceSpectrum.h"

#include "Core/Foundation/SymmetricModes.h"

#include <algorithm>
#include <cmath>

namespace SurfaceDiffusion
{

namespace
{

/// W^(1/2) B H^-1 B^T W^(1/2) v.
Values ApplyInfluence(const SmoothFit& fit, const Vector& roots, const Values& v)
{
  return roots.asDiagonal() * fit.InverseAtPoints(roots.asDiagonal() * v);
}

} // namespace

double InfluenceSpectrum::Left(double s, double ratio)
{
  const double left = ratio * (1.0 - s);
  return left / (s + left);
}

InfluenceSpectrum::InfluenceSpectrum(const SmoothFit& fit, const RepeatedValues& data,
  const Determinant& other, const ProgressMonitor& progress)
  : IsExact(data.Count() <= FewValues)
  , KnowsTrace(other.Mu > 0.0)
  , Mu(fit.GetSmoothing())
  , Count(data.Count())
{
  if (this->IsExact)
  {
    this->Decompose(fit, data, progress);
  }
  else
  {
    this->Own = { this->Mu, fit.LogDeterminant() };
    this->ModelTrace(fit, other);
    this->Sample(fit, data, progress);
  }
  // No fit reaches what repeats leave of their mean.
  const double repeats = data.Repeats.sum();
  this->Trace.emplace_back(0.0, repeats);
  this->Count += static_cast<Index>(repeats);
  for (std::size_t c = 0; c < this->Columns.size(); ++c)
  {
    this->Columns[c].emplace_back(0.0, data.Scatter.col(static_cast<Eigen::Index>(c)).sum());
  }
}

/// The trace as that of eigenvalues a/(1 + a), a = (1/j^2 + 3/count^2)/c, j = 1, 2, .., of the energy of
/// fourth order on a surface (H. Weyl, Math. Ann. 71, 1912), with what frequencies that the values do not
/// resolve add to them, and a 1 of constants. c follows from the mean of the trace between this mu and
/// the other one.
void InfluenceSpectrum::ModelTrace(const SmoothFit& fit, const Determinant& other)
{
  constexpr double unresolved = 3.0;
  const double width = this->KnowsTrace ? std::log(other.Mu / this->Mu) : 0.0;
  // Values at the distance d of each other smooth over 3 d if c = (36 pi / count)^2, and the sum of
  // 1/(1 + c j^2) is near pi/2 / sqrt(c).
  const double found = this->KnowsTrace
    ? fit.NumberOfRows() - (other.Logarithm - this->Own.Logarithm) / width
    : 1.0 + this->Count / 72.0;
  const double mean =
    std::min(0.999 * this->Count, std::max(0.0, found)); // whatever round-off does
  std::vector<std::pair<double, double>> groups; // c a, and how many there are
  for (Index begin = 1, end = 1; begin < this->Count; begin = end)
  {
    end = std::min(this->Count, begin + 1 + begin / 32);
    const double middle = 0.5 * (begin + end - 1);
    groups.emplace_back(
      1.0 / (middle * middle) + unresolved / (static_cast<double>(this->Count) * this->Count),
      end - begin);
  }
  const double constants = std::min(1.0, mean);
  const auto excess = [&](double c)
  {
    double sum = constants - mean;
    for (const auto& [size, number] : groups)
    {
      const double a = size / c;
      sum += number *
        (this->KnowsTrace ? 1.0 - std::log((a + std::exp(width)) / (a + 1.0)) / width
                          : a / (1.0 + a));
    }
    return sum;
  };
  double low = -60.0; // of the logarithm of c
  double high = 60.0;
  for (int i = 0; i < 80; ++i)
  {
    const double middle = 0.5 * (low + high);
    (excess(std::exp(middle)) > 0.0 ? low : high) = middle;
  }
  for (const auto& [size, number] : groups)
  {
    const double a = size / std::exp(low);
    this->Trace.emplace_back(a / (1.0 + a), number);
  }
  this->Trace.emplace_back(constants, 1.0);
}

void InfluenceSpectrum::Decompose(
  const SmoothFit& fit, const ScatteredValues& data, const ProgressMonitor& progress)
{
  const Vector roots = data.Weights.cwiseSqrt();
  Eigen::MatrixXd influence(this->Count, this->Count);
  constexpr Index panel = 32;
  for (Index first = 0; first < this->Count; first += panel)
  {
    progress.Report(static_cast<double>(first) / this->Count);
    const Index columns = std::min(panel, this->Count - first);
    Values unit = Values::Zero(this->Count, columns);
    unit.middleRows(first, columns).setIdentity();
    influence.middleCols(first, columns) = ApplyInfluence(fit, roots, unit);
  }
  const SymmetricModes modes(0.5 * (influence + influence.transpose()));
  this->Largest = modes.Eigenvalues.maxCoeff();
  this->Shares = modes.Eigenvalues.cwiseMax(0.0).cwiseMin(1.0);
  this->Vectors = modes.Vectors;
  for (Index i = 0; i < this->Count; ++i)
  {
    this->Trace.emplace_back(this->Shares[i], 1.0);
  }
  for (Eigen::Index c = 0; c < data.Given.cols(); ++c)
  {
    Measure measure;
    const Vector values = roots.cwiseProduct(data.Given.col(c));
    const Vector parts = this->Vectors.transpose() * values;
    for (Index i = 0; i < this->Count; ++i)
    {
      measure.emplace_back(this->Shares[i], parts[i] * parts[i]);
    }
    this->Columns.push_back(std::move(measure));
  }
}

/// The measures of the columns of v by `steps` steps of Lanczos' method.
std::vector<InfluenceSpectrum::Measure> InfluenceSpectrum::MeasuresOf(
  const SmoothFit& fit, const Vector& roots, Values v, int steps, const ProgressMonitor& progress)
{
  const Eigen::Index columns = v.cols();
  std::vector<std::vector<double>> diagonal(columns), beside(columns);
  std::vector<double> squares(columns);
  for (Eigen::Index c = 0; c < columns; ++c)
  {
    squares[c] = v.col(c).squaredNorm();
    v.col(c) /= squares[c] > 0.0 ? std::sqrt(squares[c]) : 1.0;
  }
  std::vector<Values> basis;
  for (int step = 0; step < std::min<int>(steps, static_cast<int>(v.rows())); ++step)
  {
    progress.Report(static_cast<double>(step) / steps);
    basis.push_back(v);
    Values w = ApplyInfluence(fit, roots, v);
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      diagonal[c].push_back(v.col(c).dot(w.col(c)));
    }
    for (int pass = 0; pass < 2; ++pass) // orthogonal to all before
    {
      for (const Values& known : basis)
      {
        for (Eigen::Index c = 0; c < columns; ++c)
        {
          w.col(c) -= known.col(c).dot(w.col(c)) * known.col(c);
        }
      }
    }
    for (Eigen::Index c = 0; c < columns; ++c)
    {
      constexpr double resolved = 1e-13; // of the eigenvalue 1
      const double norm = w.col(c).norm();
      beside[c].push_back(norm > resolved ? norm : 0.0);
      w.col(c) *= norm > resolved ? 1.0 / norm : 0.0;
    }
    v = std::move(w);
  }
  std::vector<Measure> measures;
  for (Eigen::Index c = 0; c < columns; ++c)
  {
    const auto size = static_cast<Eigen::Index>(diagonal[c].size());
    const Vector main = Eigen::Map<const Vector>(diagonal[c].data(), size);
    const Vector next = Eigen::Map<const Vector>(beside[c].data(), size - 1);
    const SymmetricModes modes(main, next);
    Measure measure;
    for (Eigen::Index j = 0; j < size; ++j)
    {
      this->Largest = std::max(this->Largest, modes.Eigenvalues[j]);
      const double share = std::min(1.0, std::max(0.0, modes.Eigenvalues[j]));
      const double first = modes.Vectors(0, j);
      measure.emplace_back(share, squares[c] * first * first);
    }
    measures.push_back(std::move(measure));
  }
  return measures;
}

void InfluenceSpectrum::Sample(
  const SmoothFit& fit, const ScatteredValues& data, const ProgressMonitor& progress)
{
  constexpr int steps = 8;
  constexpr Eigen::Index panel = 16;
  const auto all = static_cast<double>(data.Given.cols());
  const Vector roots = data.Weights.cwiseSqrt();
  for (Eigen::Index c = 0; c < data.Given.cols(); c += panel)
  {
    const Eigen::Index columns = std::min(panel, data.Given.cols() - c);
    const Values given = roots.asDiagonal() * data.Given.middleCols(c, columns);
    const ProgressMonitor part = progress.Part(
      0.5 + 0.5 * static_cast<double>(c) / all, 0.5 + 0.5 * static_cast<double>(c + columns) / all);
    for (Measure& measure : MeasuresOf(fit, roots, given, steps, part))
    {
      this->Columns.push_back(std::move(measure));
    }
  }
}

Vector InfluenceSpectrum::Eigenvalues(double mu) const
{
  return this->Shares.array() * this->Mu /
    (this->Shares.array() * this->Mu + (1.0 - this->Shares.array()) * mu);
}

bool InfluenceSpectrum::Rescale(SmoothFit& fit, double mu) const
{
  constexpr double most = 1e6;
  if (!this->IsExact || mu > most * this->Mu || this->Mu > most * mu)
  {
    return false;
  }
  fit.Rescale(mu, this->Vectors, this->Shares);
  return true;
}

double InfluenceSpectrum::DegreesOfFreedom(double mu) const
{
  double sum = 0.0;
  for (const auto& [share, weight] : this->Trace)
  {
    sum += weight * (1.0 - Left(share, mu / this->Mu));
  }
  return sum;
}

Index InfluenceSpectrum::NumberOfHeld() const
{
  constexpr double least = 1.0 - 1e-4;
  return static_cast<Index>((this->Shares.array() > least).count());
}

double InfluenceSpectrum::Residual(double mu, Eigen::Index column) const
{
  double sum = 0.0;
  for (const auto& [share, weight] : this->Columns[static_cast<std::size_t>(column)])
  {
    const double left = Left(share, mu / this->Mu);
    sum += weight * left * left;
  }
  return sum;
}

double InfluenceSpectrum::Score(double mu, Eigen::Index column) const
{
  const double free = this->Count - this->DegreesOfFreedom(mu);
  return free > 0.0 ? this->Count * this->Residual(mu, column) / (free * free) : 0.0;
}

} // namespace SurfaceDiffusion
