// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/RangeConstraint.h"

#include <utility>

namespace SurfaceDiffusion
{

RangeConstraint::RangeConstraint(
  const ScatteredValues& data, Eigen::Index column, bool isExact, Vector low, Vector high)
  : Data(data)
  , Column(column)
  , IsExact(isExact)
  , Low(std::move(low))
  , High(std::move(high))
{
}

/// An extreme value inside a triangle is that of all its vertices: its multiplier has no bound, and
/// the set would not settle. Returns whether no vertex is forced to both bounds.
bool RangeConstraint::Force(
  const Flags& held, std::vector<Side>& active, std::vector<char>& isForced) const
{
  bool isPossible = true;
  for (Index i = 0; i < this->Data.Count() && this->IsExact; ++i)
  {
    const double value = this->Data.Given(i, this->Column);
    const Index first = this->Data.Places[i].Vertices[0];
    if (value > this->Low[first] && value < this->High[first])
    {
      continue;
    }
    const Side bound = value == this->Low[first] ? Below : Above;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const Index vertex = this->Data.Places[i].Vertices[a];
      if (this->Data.Places[i].Coordinates[a] > 0.0 && !held[vertex])
      {
        isPossible = isPossible && (!isForced[vertex] || active[vertex] == bound);
        active[vertex] = bound;
        isForced[vertex] = 1;
      }
    }
  }
  return isPossible;
}

bool RangeConstraint::Impose(SmoothFit& fit, const Prepare& prepare, const Flags& held, Values& u,
  Values& forces, const ProgressMonitor& progress) const
{
  // The rim of the active set moves by about a row of triangles per step. The set may cycle: it grows
  // only, after so many steps.
  constexpr int mostWithRelease = 300;
  constexpr int most = 350;
  const double resolved = 1e-13 * (this->High[0] - this->Low[0]);
  const auto n = static_cast<Index>(u.rows());
  std::vector<Side> active(static_cast<std::size_t>(n), Inside);
  std::vector<char> isForced(static_cast<std::size_t>(n), 0);
  const bool isPossible = this->Force(held, active, isForced);
  const Values given = this->Data.Given.col(this->Column);
  Values derivative;
  for (int iteration = 0; iteration < most; ++iteration)
  {
    progress.Report(static_cast<double>(iteration) / most);
    fit.Derivative(given, u, forces, derivative);
    bool isSettled = true;
    bool isFeasible = true;
    for (Index i = 0; i < n; ++i)
    {
      if (held[i])
      {
        continue;
      }
      if (isForced[i])
      {
        isSettled = isSettled && iteration > 0;
        continue;
      }
      Side next = active[i];
      if (next == Inside)
      {
        next = u(i, 0) < this->Low[i] - resolved ? Below
          : u(i, 0) > this->High[i] + resolved   ? Above
                                                 : Inside;
        isFeasible = isFeasible && next == Inside;
      }
      else if (iteration < mostWithRelease && next * derivative(i, 0) > 0.0)
      {
        next = Inside; // downhill is inwards
      }
      isSettled = isSettled && next == active[i];
      active[i] = next;
    }
    if (isSettled)
    {
      return isPossible && iteration < mostWithRelease;
    }
    if (isFeasible && iteration >= mostWithRelease)
    {
      break;
    }
    Flags all = held;
    for (Index i = 0; i < n; ++i)
    {
      if (active[i] != Inside)
      {
        all[i] = true;
        u(i, 0) = active[i] == Below ? this->Low[i] : this->High[i];
      }
    }
    const double done = static_cast<double>(iteration) / most;
    prepare(all, progress.Part(done, done));
    forces = fit.Solve(given, u);
  }
  u = u.cwiseMax(this->Low).cwiseMin(this->High).eval();
  return false;
}

} // namespace SurfaceDiffusion
