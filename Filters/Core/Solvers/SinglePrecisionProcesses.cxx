// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/SinglePrecisionSolver.h"

#include <algorithm>

namespace SurfaceDiffusion
{

/// Q = A p, p . Q and the squares on lines over all processes, from those of the process. Matrix
/// has added the unit diagonal in each of them; it is meant once.
void SinglePrecisionSolver::Accumulate(int columns, const float* p, double* sums, double* onLines)
{
  if (this->OverProcesses.IsSerial())
  {
    return;
  }
  const std::vector<Index>& vertices = this->OverProcesses.InterfaceVertices();
  const std::vector<Index>& places = this->Matrix.PlacesOfRows();
  const std::size_t rows = this->Matrix.PaddedRows();
  this->OnInterfaces.resize(vertices.size() * columns);
  double* number = this->OnInterfaces.data();
  for (const Index vertex : vertices)
  {
    for (int c = 0; c < columns; ++c, ++number)
    {
      const std::size_t at = c * rows + places[vertex];
      *number = this->Q[at];
      if (!this->OverProcesses.Owns(vertex))
      {
        const double entry = p[at];
        *number -= entry;
        sums[c] -= entry * entry;
      }
    }
  }
  this->OverProcesses.AccumulateInterface(this->OnInterfaces.data(), columns);
  number = this->OnInterfaces.data();
  for (const Index vertex : vertices)
  {
    for (int c = 0; c < columns; ++c, ++number)
    {
      this->Q[c * rows + places[vertex]] = static_cast<float>(*number);
    }
  }
  this->SumBoth(columns, sums, onLines);
}

void SinglePrecisionSolver::SumBoth(int columns, double* sums, double* others)
{
  double both[2 * Group::Most];
  std::copy_n(others, columns, std::copy_n(sums, columns, both));
  this->OverProcesses.Sum(both, 2 * columns);
  std::copy_n(both, columns, sums);
  std::copy_n(both + columns, columns, others);
}

/// sums[c] = r . r and products[c] over all processes, from those of the process.
void SinglePrecisionSolver::CountOnce(int columns, const float* r, double* sums, double* products)
{
  if (this->OverProcesses.IsSerial())
  {
    return;
  }
  const std::vector<Index>& places = this->Matrix.PlacesOfRows();
  for (const Index vertex : this->OverProcesses.InterfaceVertices())
  {
    for (int c = 0; c < columns && !this->OverProcesses.Owns(vertex); ++c)
    {
      const double entry = r[c * this->Matrix.PaddedRows() + places[vertex]];
      sums[c] -= entry * entry;
    }
  }
  this->SumBoth(columns, sums, products);
}

} // namespace SurfaceDiffusion
