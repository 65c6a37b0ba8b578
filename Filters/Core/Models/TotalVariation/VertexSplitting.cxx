// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/VertexSplitting.h"

#include "Core/Models/TotalVariation/PenaltyRanges.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The penalty on u - f - q, in units of g at a gradient of one range over the vertex spacing and
/// of nu over the range: 1 to 10 is best for the first. Very large nu need some more.
constexpr double PenaltyOfGradients = 4.0;
constexpr double PenaltyOfFidelity = 0.1;

} // namespace

VertexSplitting::VertexSplitting(std::shared_ptr<const TriangleMesh> mesh, Values quadratic,
  Vector absolute, Flags fixed, const Vector& ranges, const Settings& settings,
  const ParallelFor& parallel)
  : VertexTerms(std::move(mesh), std::move(fixed), parallel)
  , Quadratic(std::move(quadratic))
  , Absolute(std::move(absolute))
  , Options(settings)
  , HasAbsolute((this->Absolute.array() > 0.0).any())
{
  if (!this->OverProcesses.Any(this->HasAbsolute))
  {
    this->Penalty.setZero();
    return;
  }
  const Vector squaredWidths = SquaredWidths(*this->Mesh, parallel);
  ForEach(parallel, this->NumberOfVertices(),
    [&](Index i)
    {
      const double nu = this->Absolute[i] * this->Areas[i];
      this->Penalty[i] = nu > 0.0
        ? PenaltyOfGradients * settings.Function(ranges[i] * ranges[i] / squaredWidths[i]) +
          PenaltyOfFidelity * nu / ranges[i]
        : 0.0;
    });
}

Vector VertexSplitting::MakeDiagonal() const
{
  return this->Areas.cwiseProduct(this->Quadratic.col(0)) + this->Penalty;
}

Values VertexSplitting::MakeColumnShifts() const
{
  Values shifts;
  if (this->Quadratic.cols() > 1)
  {
    shifts = this->Quadratic.colwise() - this->Quadratic.col(0);
    shifts.array().colwise() *= this->Areas.array();
  }
  return shifts;
}

double VertexSplitting::QuadraticWeight() const
{
  return this->OverProcesses.SumOverVertices(this->Parallel, this->NumberOfVertices(),
    [&](Index i) { return this->Areas[i] * this->Quadratic.row(i).minCoeff(); });
}

double VertexSplitting::ShareWithoutData() const
{
  const double area = this->OverProcesses.SumOverVertices(
    this->Parallel, this->NumberOfVertices(), [&](Index i) { return this->Areas[i]; });
  const double without =
    this->OverProcesses.SumOverVertices(this->Parallel, this->NumberOfVertices(),
      [&](Index i) {
        return !this->Fixed[i] && !(this->Quadratic.row(i).minCoeff() > 0.0) ? this->Areas[i] : 0.0;
      });
  return area > 0.0 ? without / area : 0.0;
}

void VertexSplitting::Start(const Values& g, const Values& f, const Values& u, bool keepMultipliers)
{
  this->G = &g;
  this->F = &f;
  if (this->HasAbsolute)
  {
    this->Q = u - f;
    if (!keepMultipliers || this->C.cols() != u.cols())
    {
      this->C.setZero(u.rows(), u.cols());
    }
  }
}

void VertexSplitting::Update(const Values& u, double relaxation)
{
  if (!this->HasAbsolute)
  {
    return;
  }
  ForEach(this->Parallel, static_cast<Index>(u.rows()),
    [&](Index i)
    {
      const double nu = this->Absolute[i] * this->Areas[i];
      if (nu == 0.0)
      {
        return;
      }
      const double threshold = nu / this->Penalty[i];
      auto q = this->Q.row(i);
      auto c = this->C.row(i);
      c += relaxation * (u.row(i) - this->F->row(i)) + (1.0 - relaxation) * q;
      ForEachNorm(this->Options.Coupling, static_cast<int>(u.cols()),
        [&](int first, int last)
        {
          const double norm = c.segment(first, last - first).norm();
          const double factor = norm > threshold ? 1.0 - threshold / norm : 0.0;
          q.segment(first, last - first) = factor * c.segment(first, last - first);
          c.segment(first, last - first) -= q.segment(first, last - first);
        });
    });
}

double VertexSplitting::Energy(const Values& u) const
{
  return this->OverProcesses.SumOverVertices(this->Parallel, this->NumberOfVertices(),
    [&](Index i)
    {
      double density = 0.0;
      for (int k = 0; k < static_cast<int>(u.cols()); ++k)
      {
        density += 0.5 * this->Mu(i, k) * std::pow(u(i, k) - (*this->G)(i, k), 2);
      }
      if (this->Absolute[i] > 0.0)
      {
        ForEachNorm(this->Options.Coupling, static_cast<int>(u.cols()),
          [&](int first, int last)
          {
            density +=
              this->Absolute[i] * (u.row(i) - this->F->row(i)).segment(first, last - first).norm();
          });
      }
      return this->Areas[i] * density;
    });
}

double VertexSplitting::DualEnergy(const Values& d, const Values& u) const
{
  return this->OverProcesses.SumOverVertices(this->Parallel, this->NumberOfVertices(),
    [&](Index i)
    {
      double value = 0.0;
      ForEachNorm(this->Options.Coupling, static_cast<int>(u.cols()),
        [&](int first, int last) { value += this->DualAt(i, d, u, first, last); });
      return value;
    });
}

double VertexSplitting::FeasibleShare(const Values& d) const
{
  double excess = Max(this->Parallel, static_cast<Index>(d.rows()),
    [&](Index i)
    {
      const double nu = this->Areas[i] * this->Absolute[i];
      double largest = 0.0;
      if (nu > 0.0 && this->Quadratic(i, 0) == 0.0 && !this->Fixed[i])
      {
        ForEachNorm(this->Options.Coupling, static_cast<int>(d.cols()),
          [&](int first, int last)
          { largest = std::max(largest, d.row(i).segment(first, last - first).norm() / nu); });
      }
      return largest;
    });
  this->OverProcesses.Max(&excess, 1);
  return excess > 1.0 ? 1.0 / excess : 1.0;
}

/// The part of vertex i: the minimum over u_i of d . u_i + mu A/2 |u_i - g|^2 + nu A |u_i - f|.
double VertexSplitting::DualAt(
  Index i, const Values& dual, const Values& present, int first, int last) const
{
  const double* d = &dual(i, 0);
  double mu = this->Areas[i] * this->Mu(i, first); // positive in all columns or in none
  const double nu = this->Areas[i] * this->Absolute[i];
  const bool fixed = this->Fixed[i];
  const double range = this->Options.Range * std::sqrt(static_cast<double>(last - first));
  double squared = 0.0; // of d, or of u_i - f without the pull of nu
  double value = 0.0;
  if (fixed || mu == 0.0)
  {
    // Unless fixed, u_i stays at f while |d| < nu, and else goes as far as Range allows.
    double pull = 0.0;
    for (int k = first; k < last; ++k)
    {
      mu = this->Areas[i] * this->Mu(i, k);
      const double u = nu > 0.0 && !fixed ? (*this->F)(i, k) : present(i, k);
      value += d[k] * u + 0.5 * mu * std::pow(u - (*this->G)(i, k), 2);
      squared += d[k] * d[k];
      pull += std::pow(u - (*this->F)(i, k), 2);
    }
    const double beyond = fixed ? 0.0 : std::max(0.0, std::sqrt(squared) - nu);
    return value - beyond * range + (nu > 0.0 ? nu * std::sqrt(pull) : 0.0);
  }
  // Without nu, u_i = g - d/mu; it is drawn to f by up to nu/mu.
  double drawn = 0.0;
  if (nu > 0.0)
  {
    for (int k = first; k < last; ++k)
    {
      squared += std::pow((*this->G)(i, k) - d[k] / mu - (*this->F)(i, k), 2);
    }
    drawn = mu * std::sqrt(squared) > nu ? nu / (mu * std::sqrt(squared)) : 1.0;
  }
  for (int k = first; k < last; ++k)
  {
    mu = this->Areas[i] * this->Mu(i, k);
    const double free = (*this->G)(i, k) - d[k] / mu;
    const double u = drawn > 0.0 ? free + drawn * ((*this->F)(i, k) - free) : free;
    value += d[k] * u + 0.5 * mu * std::pow(u - (*this->G)(i, k), 2);
  }
  return value + nu * (1.0 - drawn) * std::sqrt(squared);
}

} // namespace SurfaceDiffusion
