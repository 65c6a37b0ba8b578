// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/SmoothFit.h"

#include "Core/Solvers/NotPositiveDefinite.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace SurfaceDiffusion
{

SmoothFit::SmoothFit(const SmoothnessEnergy& energy, const ScatteredValues& data, bool regular,
  const ParallelFor& parallel)
  : Energy(energy)
  , Data(data)
  , IsRegular(regular)
  , Parallel(parallel)
{
}

PivotCounts SmoothFit::Prepare(
  double mu, const Flags& held, bool exact, const ProgressMonitor& progress)
{
  this->Mu = mu;
  this->FactorMu = mu;
  this->Vectors.resize(0, 0);
  this->Held = held;
  this->IsExact = exact;
  this->Weights = this->Data.Weights;
  if (exact)
  {
    // A penalty as stiff as the energy's own rows: the multipliers are known within a few solves, and
    // H stays as well conditioned as the energy.
    constexpr double stiffness = 1e3;
    constexpr double least = 1e-6; // in triangles alone, in which no function has an energy
    const Vector diagonal =
      this->Energy.Matrix().diagonal().head(held.size()).cwiseMax(least * this->Energy.Sizes());
    for (Index i = 0; i < this->Data.Count(); ++i)
    {
      const SurfacePoint& place = this->Data.Places[i];
      this->Weights[i] = stiffness * mu * diagonal[place.Vertices[0]];
    }
  }
  this->H = mu * this->Energy.Matrix();
  for (Index i = 0; i < this->Data.Count(); ++i)
  {
    const SurfacePoint& place = this->Data.Places[i];
    for (std::size_t a = 0; a < 3; ++a)
    {
      for (std::size_t b = 0; b < 3; ++b)
      {
        const double product = place.Coordinates[a] * place.Coordinates[b];
        if (product != 0.0)
        {
          this->H.coeffRef(place.Vertices[a], place.Vertices[b]) += this->Weights[i] * product;
        }
      }
    }
  }
  const auto isHeld = [&](Index i) { return i < held.size() && held[i]; };
  ForEach(this->Parallel, static_cast<Index>(this->H.rows()),
    [&](Index j)
    {
      for (SparseMatrix::InnerIterator a(this->H, j); a; ++a)
      {
        if (isHeld(static_cast<Index>(a.index())) || isHeld(j))
        {
          a.valueRef() = a.index() == j ? 1.0 : 0.0;
        }
      }
    });
  // Without a value the pivot of a constant is round-off; with one it is about a share 1/(20 n).
  const double resolved = 1e-15 * static_cast<double>(this->H.rows());
  const PivotCounts pivots =
    this->Factor.Compute(this->H, this->IsRegular, resolved, this->Parallel, progress);
  std::vector<Index> vertices;
  for (const SurfacePoint& place : this->Data.Places)
  {
    vertices.insert(vertices.end(), place.Vertices.begin(), place.Vertices.end());
  }
  this->NeededAtPoints = this->Factor.Needed(vertices);
  return pivots;
}

void SmoothFit::Rescale(double mu, const Eigen::MatrixXd& vectors, const Vector& shares)
{
  const double ratio = mu / this->FactorMu;
  this->Mu = mu;
  this->Vectors = vectors;
  this->Scales = (1.0 - ratio) / (shares.array() + ratio * (1.0 - shares.array()));
}

void SmoothFit::Restore()
{
  this->Mu = this->FactorMu;
  this->Vectors.resize(0, 0);
}

Values SmoothFit::AtPoints(const Values& u) const
{
  return this->Data.AtPlaces(u);
}

Values SmoothFit::ToVertices(const Values& v) const
{
  Values u = Values::Zero(this->Held.size(), v.cols());
  for (Index i = 0; i < this->Data.Count(); ++i)
  {
    const SurfacePoint& place = this->Data.Places[i];
    for (std::size_t a = 0; a < 3; ++a)
    {
      if (place.Coordinates[a] != 0.0)
      {
        u.row(place.Vertices[a]) += place.Coordinates[a] * v.row(i);
      }
    }
  }
  return u;
}

void SmoothFit::Derivative(
  const Values& given, const Values& u, const Values& forces, Values& derivative) const
{
  this->Energy.Multiply(u, derivative);
  const Values misfit = given - this->AtPoints(u);
  derivative =
    this->Mu * derivative - this->ToVertices(this->Weights.asDiagonal() * misfit + forces);
}

void SmoothFit::ReleaseHeld(Values& x) const
{
  ForEach(this->Parallel, static_cast<Index>(x.rows()),
    [&](Index i)
    {
      if (this->Held[i])
      {
        x.row(i).setZero();
      }
    });
}

/// x becomes the solution for the forces x, without forces on the held vertices and on what unknowns the
/// energy has beside the vertices.
void SmoothFit::SolveSystem(Values& x, const std::vector<char>& needed) const
{
  this->ReleaseHeld(x);
  const Eigen::Index n = x.rows();
  x.conservativeResize(this->H.rows(), Eigen::NoChange);
  x.bottomRows(x.rows() - n).setZero();
  this->Factor.Solve(x, needed, this->Parallel);
  x.conservativeResize(n, Eigen::NoChange);
}

void SmoothFit::ApplyInverse(Values& x) const
{
  this->SolveSystem(x, {});
  if (this->Vectors.size() == 0)
  {
    return;
  }
  const Vector roots = this->Weights.cwiseSqrt();
  const Eigen::MatrixXd parts =
    this->Vectors.transpose() * (roots.asDiagonal() * this->AtPoints(x));
  Values change =
    this->ToVertices(roots.asDiagonal() * (this->Vectors * (this->Scales.asDiagonal() * parts)));
  this->SolveSystem(change, {});
  x = (x - change) * (this->FactorMu / this->Mu);
}

Values SmoothFit::InverseAtPoints(const Values& v) const
{
  Values x = this->ToVertices(v);
  this->SolveSystem(x, this->NeededAtPoints);
  return this->AtPoints(x);
}

double SmoothFit::LogDeterminant() const
{
  const Supernodes& nodes = this->Factor.Structure();
  double sum = 0.0;
  for (Index s = 0; s < nodes.Count(); ++s)
  {
    for (Index p = 0; p < nodes.Pivots(s); ++p)
    {
      sum += 2.0 * std::log(this->Factor.Pivot(s, p));
    }
  }
  return sum;
}

Values SmoothFit::Solve(const Values& given, Values& u)
{
  constexpr int most = 4;
  constexpr double resolved = 1e-14; // of the values
  Values forces = Values::Zero(this->Data.Count(), u.cols());
  this->Refine(given, forces, u);
  for (Eigen::Index c = 0; c < u.cols() && this->IsExact; ++c)
  {
    const Values values = given.col(c);
    Values column = u.col(c);
    Values own = forces.col(c);
    Vector misfit = values - this->AtPoints(column);
    double last = std::numeric_limits<double>::infinity();
    for (int round = 0; round < most; ++round)
    {
      const double size = misfit.cwiseAbs().maxCoeff();
      if (!(size < 0.5 * last) || size <= resolved * values.cwiseAbs().maxCoeff())
      {
        break;
      }
      last = size;
      own += this->FindForces(misfit);
      this->Refine(values, own, column);
      misfit = values - this->AtPoints(column);
    }
    u.col(c) = column;
    forces.col(c) = own;
  }
  return forces;
}

/// The multipliers f that take a misfit r away, B H^-1 B^T f = r, by conjugate residuals (E. Stiefel,
/// Comment. Math. Helv. 29, 1955) with unknowns that are scaled by the roots of the weights. Nearly all
/// eigenvalues are near 1 then, and a few are small where values are near to each other. The residual
/// becomes the least if values contradict each other.
Vector SmoothFit::FindForces(const Vector& misfit) const
{
  constexpr int most = 200;
  constexpr double resolved = 1e-14;
  constexpr double smallest = 1e-12; // eigenvalue, below which values contradict each other
  const Vector roots = this->Weights.cwiseSqrt();
  Vector r = roots.cwiseProduct(misfit);
  Vector forces = Vector::Zero(r.size());
  Vector direction = forces;
  Vector image = forces;
  const double enough = resolved * r.norm();
  double last = 0.0;
  for (int iteration = 0; iteration < most && r.norm() > enough; ++iteration)
  {
    const Vector imageOfResidual =
      roots.cwiseProduct(this->InverseAtPoints(roots.cwiseProduct(r)).col(0));
    const double product = r.dot(imageOfResidual);
    if (!(product > smallest * r.squaredNorm()))
    {
      break;
    }
    const double share = iteration > 0 ? product / last : 0.0;
    last = product;
    direction = r + share * direction;
    image = imageOfResidual + share * image;
    const double length = product / image.squaredNorm();
    forces += length * direction;
    r -= length * image;
  }
  return roots.cwiseProduct(forces);
}

/// Let u have the derivative zero for these multipliers.
void SmoothFit::Refine(const Values& given, const Values& forces, Values& u)
{
  constexpr int most = 30;
  constexpr double resolved = 1e-14; // of the values
  Values step;
  std::vector<double> last(static_cast<std::size_t>(u.cols()), 0.0);
  std::vector<char> isDone(last.size(), 0);
  for (int iteration = 0; iteration < most; ++iteration)
  {
    this->Derivative(given, u, forces, step);
    this->ApplyInverse(step);
    // Each column ends by itself, so that it has the bits that it has alone.
    for (Eigen::Index c = 0; c < u.cols(); ++c)
    {
      const auto column = static_cast<std::size_t>(c);
      const double size = step.col(c).cwiseAbs().maxCoeff();
      if (!std::isfinite(size))
      {
        throw NotPositiveDefinite();
      }
      const bool isRoundOff = iteration > 1 && size > 0.5 * last[column];
      last[column] = size;
      if (isDone[column] || isRoundOff)
      {
        isDone[column] = 1;
        continue;
      }
      u.col(c) -= step.col(c);
      isDone[column] = size <= resolved * u.col(c).cwiseAbs().maxCoeff();
    }
    if (std::all_of(isDone.begin(), isDone.end(), [](char done) { return done != 0; }))
    {
      break;
    }
  }
  this->LastStep = 0.0;
  for (Eigen::Index c = 0; c < u.cols(); ++c)
  {
    const double size =
      std::max(u.col(c).cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    this->LastStep = std::max(this->LastStep, last[static_cast<std::size_t>(c)] / size);
  }
}

Vector SmoothFit::VarianceAtPoints(const ProgressMonitor& progress) const
{
  std::vector<InverseEntry> entries; // three of each place: its vertices in pairs
  constexpr std::size_t next[] = { 1, 2, 0 };
  for (const SurfacePoint& place : this->Data.Places)
  {
    for (std::size_t a = 0; a < 3; ++a)
    {
      const bool counts = place.Coordinates[a] != 0.0 && place.Coordinates[next[a]] != 0.0;
      const Index first = place.Vertices[counts ? a : 0];
      entries.push_back({ first, counts ? place.Vertices[next[a]] : first, 0.0 });
    }
  }
  const Vector diagonal = this->Factor.InverseDiagonal(this->Parallel, progress, &entries);
  Vector variances(this->Data.Count());
  for (Index i = 0; i < this->Data.Count(); ++i)
  {
    const SurfacePoint& place = this->Data.Places[static_cast<std::size_t>(i)];
    double sum = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const double b = place.Coordinates[a];
      sum += b == 0.0 ? 0.0 : b * b * diagonal[place.Vertices[a]];
      sum +=
        2.0 * b * place.Coordinates[next[a]] * entries[3 * static_cast<std::size_t>(i) + a].Value;
    }
    variances[i] = sum;
  }
  return variances;
}

} // namespace SurfaceDiffusion
