// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Solvers/Aggregation.h"

#include "Core/Solvers/SparseColumns.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace SurfaceDiffusion
{

namespace
{

constexpr Index None = -1;

/// 4/3 over the largest eigenvalue of D^-1 A, which is 3/2 on a regular triangulation.
constexpr double Omega = 8.0 / 9.0;

/// Per slot of the matrix, whether its entry is strong.
std::vector<char> FindStrong(
  const SparseMatrix& matrix, double strength, const ParallelFor& parallel)
{
  const Vector root = matrix.diagonal().cwiseSqrt();
  std::vector<char> strong(matrix.nonZeros());
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  ForEach(parallel, static_cast<Index>(matrix.rows()),
    [&](Index i)
    {
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        const Index j = inner[slot];
        strong[slot] = j != i && -matrix.valuePtr()[slot] > strength * root[i] * root[j];
      }
    });
  return strong;
}

struct Aggregates
{
  std::vector<Index> Of; ///< per vertex, or None
  Index Count = 0;
};

Aggregates Aggregate(const SparseMatrix& matrix, const std::vector<char>& strong)
{
  const Index n = static_cast<Index>(matrix.rows());
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  Aggregates result;
  std::vector<Index>& of = result.Of;
  of.assign(n, None);

  for (Index i = 0; i < n; ++i)
  {
    bool any = false;
    bool free = of[i] == None;
    for (Index slot = outer[i]; slot < outer[i + 1] && free; ++slot)
    {
      any = any || strong[slot];
      free = !strong[slot] || of[inner[slot]] == None;
    }
    if (free && any)
    {
      of[i] = result.Count;
      for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
      {
        if (strong[slot])
        {
          of[inner[slot]] = result.Count;
        }
      }
      ++result.Count;
    }
  }

  // A vertex that joins an aggregate here does not bring its own neighbours along.
  std::vector<Index> joins(n, None);
  for (Index i = 0; i < n; ++i)
  {
    double strongest = 0.0;
    for (Index slot = outer[i]; slot < outer[i + 1] && of[i] == None; ++slot)
    {
      if (strong[slot] && of[inner[slot]] != None && -matrix.valuePtr()[slot] > strongest)
      {
        strongest = -matrix.valuePtr()[slot];
        joins[i] = of[inner[slot]];
      }
    }
  }
  for (Index i = 0; i < n; ++i)
  {
    of[i] = of[i] == None ? joins[i] : of[i];
  }
  return result;
}

} // namespace

SparseMatrix SmoothedAggregation(
  const SparseMatrix& matrix, double strength, Vector& kernel, const ParallelFor& parallel)
{
  const Index* outer = matrix.outerIndexPtr();
  const Index* inner = matrix.innerIndexPtr();
  const double* a = matrix.valuePtr();
  const std::vector<char> strong = FindStrong(matrix, strength, parallel);
  const Aggregates aggregates = Aggregate(matrix, strong);
  const std::vector<Index>& of = aggregates.Of;

  Vector coarse = Vector::Zero(aggregates.Count);
  for (Index i = 0; i < matrix.rows(); ++i)
  {
    if (of[i] != None)
    {
      coarse[of[i]] += kernel[i] * kernel[i];
    }
  }
  coarse = coarse.cwiseSqrt();
  const auto tentative = [&](Index i) { return kernel[i] / coarse[of[i]]; };

  SparseMatrix restriction =
    CollectColumns(aggregates.Count, static_cast<Index>(matrix.rows()), parallel,
      [&](Index i, SparseColumn& column)
      {
        if (of[i] == None)
        {
          return;
        }
        double diagonal = 0.0;
        for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
        {
          diagonal += strong[slot] ? 0.0 : a[slot] * kernel[inner[slot]] / kernel[i];
        }
        column.Add(of[i], (1.0 - Omega) * tentative(i));
        for (Index slot = outer[i]; slot < outer[i + 1]; ++slot)
        {
          if (strong[slot])
          {
            column.Add(of[inner[slot]], -Omega * a[slot] / diagonal * tentative(inner[slot]));
          }
        }
      });
  kernel = std::move(coarse);
  return restriction;
}

SparseMatrix GalerkinProduct(const SparseMatrix& matrix, const SparseMatrix& restriction,
  const SparseMatrix& prolongation, const ParallelFor& parallel)
{
  // Two products with short columns are faster than one with long columns: in a short column a row
  // is found by comparing with all of them (IndexSet).
  const Index coarse = static_cast<Index>(restriction.rows());
  const SparseMatrix half = CollectColumns(coarse, static_cast<Index>(matrix.rows()), parallel,
    [&](Index i, SparseColumn& column)
    {
      for (SparseMatrix::InnerIterator a(matrix, i); a; ++a)
      {
        for (SparseMatrix::InnerIterator r(restriction, a.index()); r; ++r)
        {
          column.Add(r.index(), a.value() * r.value());
        }
      }
    });
  return CollectColumns(coarse, coarse, parallel,
    [&](Index c, SparseColumn& column)
    {
      for (SparseMatrix::InnerIterator p(prolongation, c); p; ++p)
      {
        for (SparseMatrix::InnerIterator h(half, p.index()); h; ++h)
        {
          column.Add(h.index(), h.value() * p.value());
        }
      }
    });
}

} // namespace SurfaceDiffusion
