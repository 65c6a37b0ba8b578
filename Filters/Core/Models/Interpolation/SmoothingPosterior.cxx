// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/SmoothingPosterior.h"

#include "Core/Foundation/SymmetricModes.h"
#include "Core/Statistics/StudentFactor.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace SurfaceDiffusion
{

namespace
{

constexpr double CutOffExponent = 0.25; ///< of mu^-1/4, the wave number that the fit cuts off

} // namespace

SmoothingPosterior::SmoothingPosterior(
  const InfluenceSpectrum& spectrum, const RepeatedValues& data, Eigen::Index column, double noise)
  : Spectrum(spectrum)
  , Data(data)
  , Parts(spectrum.Eigenvectors().transpose() *
      data.Weights.cwiseSqrt().cwiseProduct(data.Given.col(column)))
  , Middle(spectrum.Start())
{
  constexpr double resolved = 1e-8; // difference of an eigenvalue from 1
  const Vector eigenvalues = spectrum.Eigenvalues(this->Middle);
  Flags hasEnergy = eigenvalues.array() < 1.0 - resolved;
  Eigen::Index flattest = 0; // the constants, which needles give an energy of round-off
  eigenvalues.maxCoeff(&flattest);
  hasEnergy[flattest] = false;
  const auto count = static_cast<double>(hasEnergy.count());
  const double square = hasEnergy.select(this->Parts.cwiseAbs2(), 0.0).sum();
  this->RootMeanSquare = std::sqrt(square / data.Weights.sum());
  const double freedom = count + data.Repeats.sum();
  if (!(noise > 0.0) && (freedom < 1.0 || !(square + data.Scatter.col(column).sum() > 0.0)))
  {
    return;
  }
  const auto left = [&](double mu) // without functions that have no energy
  {
    const Vector shares = spectrum.Eigenvalues(mu);
    return Vector(hasEnergy.select((1.0 - shares.array()).matrix(), 0.0));
  };
  double low = std::log(this->Middle) - 40.0;
  double high = low + 80.0;
  for (int i = 0; i < 60 && count > 0.0; ++i)
  {
    const double middle = 0.5 * (low + high);
    (left(std::exp(middle)).sum() > 0.5 * count ? high : low) = middle;
  }
  this->Middle = std::exp(0.5 * (low + high));
  constexpr double step = 0.5; // beside deviations of 0.3 or more
  double most = -std::numeric_limits<double>::infinity();
  for (double t = -Farthest; t <= Farthest; t += step)
  {
    const double mu = this->Middle * std::exp(t);
    const Vector shares = left(mu);
    const double misfit = shares.dot(this->Parts.cwiseAbs2()) + data.Scatter.col(column).sum();
    double logarithm = LogPrior(std::exp(t));
    logarithm += 0.5 * hasEnergy.select(shares.array().max(1e-300).log().matrix(), 0.0).sum();
    logarithm -= noise > 0.0 ? 0.5 * misfit / (noise * noise) : 0.5 * freedom * std::log(misfit);
    const double factor = StudentFactor(freedom);
    const double variance = noise > 0.0 ? noise * noise : factor * factor * misfit / freedom;
    this->Nodes.push_back({ mu, logarithm, variance });
    most = std::max(most, logarithm);
  }
  double sum = 0.0;
  for (Node& node : this->Nodes)
  {
    node.Weight = std::exp(node.Weight - most);
    sum += node.Weight;
  }
  constexpr double least = 1e-4; // weight
  std::vector<Node> all;
  all.swap(this->Nodes);
  for (Node& node : all)
  {
    node.Weight /= sum;
    if (node.Weight > least)
    {
      this->Nodes.push_back(node);
    }
  }
}

double SmoothingPosterior::LogPrior(double ratio)
{
  return -std::log(std::cosh(CutOffExponent * std::log(ratio)));
}

double SmoothingPosterior::Resolving(double mu) const
{
  constexpr double farthest = 1e3;
  return std::min(std::max(mu, this->Middle / farthest), this->Middle * farthest);
}

double SmoothingPosterior::MeanOf(double ofNoise, double ofField) const
{
  double mean = 0.0;
  for (const Node& node : this->Nodes)
  {
    mean += node.Weight * node.Variance * (ofNoise + ofField / node.Mu);
  }
  return mean;
}

/// With x_j = H_0^-1 B^T W^(1/2) v_j of the factor's mu_0, the eigenvectors v and the eigenvalues s at
/// mu_0, and with r = mu/mu_0,
///   u(mu) = sum_j x_j z_j / (s_j + r (1 - s_j))
/// and, as in SmoothFit::Rescale(),
///   H^-1 = (H_0^-1 - sum_j x_j x_j^T (1 - r) / (s_j + r (1 - s_j))) / r.
Vector SmoothingPosterior::SquareOfError(const SmoothFit& fit, double mu,
  const SlopeSquares& slopes, Vector& ofSlopes, const ProgressMonitor& progress) const
{
  const Eigen::ArrayXd shares = this->Spectrum.Eigenvalues(fit.GetSmoothing()).array();
  const auto sizes = [&](double ratio) -> Eigen::ArrayXd
  { return shares + ratio * (1.0 - shares); };
  const Eigen::ArrayXd ofFit = sizes(mu / fit.GetSmoothing());
  const Eigen::Index count = shares.size();
  const auto number = static_cast<Eigen::Index>(this->Nodes.size());
  double ofDiagonal = 0.0;
  Vector ofSquares = Vector::Zero(count);
  Eigen::MatrixXd steps(count, number); // of u, from that of mu
  for (Eigen::Index k = 0; k < number; ++k)
  {
    const Node& node = this->Nodes[static_cast<std::size_t>(k)];
    const double ratio = node.Mu / fit.GetSmoothing();
    const Eigen::ArrayXd ofNode = sizes(ratio);
    const double weight = node.Weight * node.Variance / ratio;
    ofDiagonal += weight;
    ofSquares.array() += weight * (1.0 - ratio) / ofNode;
    steps.col(k) =
      std::sqrt(node.Weight) * this->Parts.array() * (ofNode.inverse() - ofFit.inverse());
  }
  // They are along few directions.
  constexpr double resolved = 1e-8;
  const SymmetricModes modes(steps.transpose() * steps);
  const Vector& lengths = modes.Eigenvalues;
  const Eigen::Index few = (lengths.array() > resolved * lengths[number - 1]).count();
  steps = (steps * modes.Vectors.rightCols(few)).eval();
  std::vector<InverseEntry> edges = slopes.Edges();
  const Vector diagonal = fit.InverseDiagonal(progress.Part(0.0, 0.3), &edges);
  Vector squares = ofDiagonal * diagonal.cwiseMax(0.0);
  ofSlopes = ofDiagonal * slopes.OfCovariance(diagonal, edges);
  Values distances = Values::Zero(squares.size(), few);
  const Vector roots = this->Data.Weights.cwiseSqrt();
  constexpr Eigen::Index panel = 32;
  for (Eigen::Index first = 0; first < count; first += panel)
  {
    progress.Report(0.3 + 0.7 * static_cast<double>(first) / static_cast<double>(count));
    const Eigen::Index columns = std::min(panel, count - first);
    Values x =
      fit.ToVertices(roots.asDiagonal() * this->Spectrum.Eigenvectors().middleCols(first, columns));
    fit.ApplyInverse(x);
    squares -= x.cwiseAbs2() * ofSquares.segment(first, columns);
    ofSlopes -= slopes.Of(x, ofSquares.segment(first, columns).cwiseMax(0.0));
    ofSlopes += slopes.Of(x, (-ofSquares.segment(first, columns)).cwiseMax(0.0));
    distances += x * steps.middleRows(first, columns);
  }
  ofSlopes = ofSlopes.cwiseMax(0.0) + slopes.Of(distances, Vector::Ones(few));
  return squares.cwiseMax(0.0) + distances.rowwise().squaredNorm();
}

} // namespace SurfaceDiffusion
