// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/SimplexSplitting.h"

#include "Core/Models/TotalVariation/PenaltyRanges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The penalty on u - q, in units of 1/(vertex spacing) and of the typical cost.
constexpr double PenaltyOfDifferences = 4.0;
constexpr double PenaltyOfCosts = 0.1;

/// The minimum of a . v over S.
double SmallestCost(const double* costs, int columns)
{
  const double smallest = *std::min_element(costs, costs + columns);
  return columns == 1 ? std::min(0.0, smallest) : smallest;
}

} // namespace

void ProjectOntoSimplex(double* row, int columns)
{
  if (columns == 1)
  {
    row[0] = std::clamp(row[0], 0.0, 1.0);
    return;
  }
  // The projection ignores a common summand. Without it the values that stay above 0 are in [-1,
  // 0], and their sum keeps its digits even if the row is large.
  const double largest = *std::max_element(row, row + columns);
  for (int k = 0; k < columns; ++k)
  {
    row[k] -= largest;
  }
  // Every pass leaves out the values that are not above the shift of the others. The shift only
  // rises; if round-off let it fall, the loop might not end.
  double shift = -std::numeric_limits<double>::infinity();
  for (int former = 0, kept = -1; kept != former;)
  {
    former = kept;
    kept = 0;
    double sum = 0.0;
    for (int k = 0; k < columns; ++k)
    {
      if (row[k] > shift)
      {
        sum += row[k];
        ++kept;
      }
    }
    shift = kept > 0 ? std::max(shift, (sum - 1.0) / kept) : shift;
  }
  for (int k = 0; k < columns; ++k)
  {
    row[k] = std::max(0.0, row[k] - shift);
  }
}

SimplexSplitting::SimplexSplitting(std::shared_ptr<const TriangleMesh> mesh, Flags fixed,
  double typicalCost, const ParallelFor& parallel)
  : VertexTerms(std::move(mesh), std::move(fixed), parallel)
{
  const Vector squaredWidths = SquaredWidths(*this->Mesh, parallel);
  ForEach(parallel, this->NumberOfVertices(),
    [&](Index i)
    {
      this->Penalty[i] = PenaltyOfDifferences * std::sqrt(squaredWidths[i]) +
        PenaltyOfCosts * typicalCost * this->Areas[i];
    });
}

void SimplexSplitting::Start(
  const Values& costs, const Values&, const Values& u, bool keepMultipliers)
{
  this->Costs = &costs;
  this->Q = this->Admissible(u);
  if (!keepMultipliers || this->C.cols() != u.cols())
  {
    this->C.setZero(u.rows(), u.cols());
  }
}

void SimplexSplitting::Update(const Values& u, double relaxation)
{
  const int columns = static_cast<int>(u.cols());
  ForEach(this->Parallel, this->NumberOfVertices(),
    [&](Index i)
    {
      double* q = &this->Q(i, 0);
      double* c = &this->C(i, 0);
      const double* present = &u(i, 0);
      for (int k = 0; k < columns; ++k)
      {
        c[k] += relaxation * present[k] + (1.0 - relaxation) * q[k];
        q[k] = c[k];
      }
      ProjectOntoSimplex(q, columns);
      for (int k = 0; k < columns; ++k)
      {
        c[k] -= q[k];
      }
    });
}

void SimplexSplitting::AddRightHandSide(Index i, double* row) const
{
  const int columns = static_cast<int>(this->Q.cols());
  const double* q = &this->Q(i, 0);
  const double* c = &this->C(i, 0);
  const double* a = &(*this->Costs)(i, 0);
  for (int k = 0; k < columns; ++k)
  {
    row[k] += this->Penalty[i] * (q[k] - c[k]) - this->Areas[i] * a[k];
  }
}

const Values& SimplexSplitting::Admissible(const Values& u)
{
  this->Nearest.resize(u.rows(), u.cols());
  ForEach(this->Parallel, this->NumberOfVertices(),
    [&](Index i)
    {
      this->Nearest.row(i) = u.row(i);
      ProjectOntoSimplex(&this->Nearest(i, 0), static_cast<int>(u.cols()));
    });
  return this->Nearest;
}

double SimplexSplitting::Energy(const Values& u) const
{
  const int columns = static_cast<int>(u.cols());
  return this->OverProcesses.SumOverVertices(this->Parallel, this->NumberOfVertices(),
    [&](Index i)
    {
      return this->Areas[i] *
        (this->Costs->row(i).dot(u.row(i)) - SmallestCost(&(*this->Costs)(i, 0), columns));
    });
}

double SimplexSplitting::DualEnergy(const Values& d, const Values& u) const
{
  const int columns = static_cast<int>(d.cols());
  return this->OverProcesses.SumOverVertices(this->Parallel, this->NumberOfVertices(),
    [&](Index i)
    {
      const double area = this->Areas[i];
      const double* a = &(*this->Costs)(i, 0);
      double least = columns == 1 ? 0.0 : d(i, 0) + area * a[0];
      double fixed = 0.0;
      for (int k = 0; k < columns; ++k)
      {
        const double cost = d(i, k) + area * a[k];
        least = std::min(least, cost);
        fixed += cost * u(i, k);
      }
      return (this->Fixed[i] ? fixed : least) - area * SmallestCost(a, columns);
    });
}

} // namespace SurfaceDiffusion
