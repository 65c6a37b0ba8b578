// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/SparseSquare.h"

#include <vector>

namespace SurfaceDiffusion
{

SparseMatrix SparseSquare(const SparseMatrix& l, const Vector& masses, double s)
{
  constexpr Index widest = 100;
  constexpr Index few = 8; // children of a node, and neighbours in its part
  const auto n = static_cast<Index>(l.rows());
  std::vector<Eigen::Triplet<double, Index>> entries;
  std::vector<double> inverses; // of the masses of the rows
  Index unknowns = n;
  for (Index i = 0; i < n; ++i)
  {
    const Index neighbours = l.col(i).nonZeros() - 1;
    const Index nodes = neighbours > widest ? (neighbours + few - 1) / few : 1;
    const auto row = static_cast<Index>(inverses.size());
    Index number = 0;
    for (SparseMatrix::InnerIterator a(l, i); a; ++a)
    {
      if (a.index() != i)
      {
        const Index node = row + (nodes > 1 ? number++ / few : 0);
        entries.emplace_back(node, a.index(), a.value());
        entries.emplace_back(node, i, -a.value()); // no part has forces on constants
      }
    }
    for (Index node = 0; node < nodes; ++node)
    {
      inverses.push_back(nodes / masses[i]);
      entries.emplace_back(row + node, i, s * masses[i] / nodes);
      if (node > 0)
      {
        entries.emplace_back(row + node, unknowns, -1.0);
        entries.emplace_back(row + (node - 1) / few, unknowns++, 1.0);
      }
    }
  }
  if (unknowns == n)
  {
    return l * masses.cwiseInverse().asDiagonal() * l;
  }
  SparseMatrix rows(static_cast<Index>(inverses.size()), unknowns);
  rows.setFromTriplets(entries.begin(), entries.end());
  const SparseMatrix transposed = rows.transpose();
  return transposed * Eigen::Map<const Vector>(inverses.data(), rows.rows()).asDiagonal() * rows;
}

} // namespace SurfaceDiffusion
