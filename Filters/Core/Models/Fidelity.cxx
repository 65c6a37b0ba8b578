// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Fidelity.h"

#include <cmath>

namespace SurfaceDiffusion
{

double Fidelity::Weight(Index i, const Values& u, Eigen::Index first, Eigen::Index last) const
{
  const double weight = this->Weight(i);
  if (weight == 0.0 || this->Options.Norm == FidelityNorm::L2)
  {
    return weight;
  }
  const double squared =
    (u.row(i) - this->Data.Given.row(i)).segment(first, last - first).squaredNorm();
  return weight / std::sqrt(squared + this->Options.Rounding * this->Options.Rounding);
}

double Fidelity::Density(double squaredDistance) const
{
  if (this->Options.Norm == FidelityNorm::L2)
  {
    return 0.5 * squaredDistance;
  }
  // Free of cancellation if the distance is small.
  const double delta = this->Options.Rounding;
  return squaredDistance > 0.0
    ? squaredDistance / (std::sqrt(squaredDistance + delta * delta) + delta)
    : 0.0;
}

/// |u - f|^2 at vertex i in channels first .. last - 1, with their factors.
double Fidelity::SquaredDistance(Index i, const Values& u, int first, int last) const
{
  const double sign = this->Sign(i, u);
  double squared = 0.0;
  for (int k = first; k < last; ++k)
  {
    const double distance = u(i, k) - sign * this->Data.Given(i, k);
    squared += this->ChannelWeight(k) * distance * distance;
  }
  return squared;
}

double Fidelity::Energy(
  const TriangleMesh& mesh, const Values& u, const ParallelFor& parallel) const
{
  if (!this->IsPresent())
  {
    return 0.0;
  }
  const ChannelCoupling coupling =
    this->Options.Norm == FidelityNorm::L2 ? ChannelCoupling::Joint : this->Options.Coupling;
  return Sum(parallel, mesh.NumberOfVertices(),
    [&](Index i)
    {
      if (this->Weight(i) == 0.0) // the data are not read where they are missing
      {
        return 0.0;
      }
      double density = 0.0;
      ForEachNorm(coupling, static_cast<int>(u.cols()),
        [&](int first, int last)
        { density += this->Density(this->SquaredDistance(i, u, first, last)); });
      return mesh.ControlAreas()[i] * this->Weight(i) * density;
    });
}

} // namespace SurfaceDiffusion
