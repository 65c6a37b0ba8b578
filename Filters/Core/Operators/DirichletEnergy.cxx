// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/DirichletEnergy.h"

#include "Core/Foundation/Columns.h"
#include "Core/Operators/CotanWeights.h"

#include <algorithm>
#include <numeric>

namespace SurfaceDiffusion
{

namespace
{

/// sums[k] = the part of the triangles [begin, end) in twice the energy of column k of u, of the K
/// columns that begin at u. coefficients: three for each of these triangles.
template <int K>
void SumTriangles(const Triangles& corners, const double* coefficients, const double* u,
  Eigen::Index stride, Index begin, Index end, double* sums)
{
  double total[K] = {};
  for (Index t = begin; t < end; ++t)
  {
    const double* const u0 = u + corners(t, 0) * stride;
    const double* const u1 = u + corners(t, 1) * stride;
    const double* const u2 = u + corners(t, 2) * stride;
    const double* const c = coefficients + static_cast<std::ptrdiff_t>(t - begin) * 3;
    const double c0 = c[0];
    const double c1 = c[1];
    const double c2 = c[2];
    for (int k = 0; k < K; ++k)
    {
      const double d0 = u1[k] - u2[k];
      const double d1 = u2[k] - u0[k];
      const double d2 = u0[k] - u1[k];
      total[k] += c0 * (d0 * d0) + c1 * (d1 * d1) + c2 * (d2 * d2);
    }
  }
  std::copy_n(total, K, sums);
}

// An attribute of a template is not portable: a function of its own.
SURFACEDIFFUSION_ANY_VECTORS void SumTrianglesOfPanel(const Triangles& corners,
  const double* coefficients, const double* u, Eigen::Index stride, Index begin, Index end,
  double* sums)
{
  SumTriangles<ColumnPanel>(corners, coefficients, u, stride, begin, end, sums);
}

/// The sum over the columns from `first` on, of which there are K.
template <int K>
double SumColumnsOf(const TriangleMesh& mesh, const CornerWeights& coefficients, const Values& u,
  Eigen::Index first, const ParallelFor& parallel)
{
  const Triangles& corners = mesh.TriangleVertices();
  const double* const start = u.data() + first;
  constexpr Index blocks = 256; // partial sums on the stack, so that time steps do not allocate
  double total[K] = {};
  for (Index from = 0; from < mesh.NumberOfTriangles(); from += blocks * BlockSize)
  {
    double partial[blocks * K];
    const Index count = std::min(mesh.NumberOfTriangles() - from, blocks * BlockSize);
    ForEachBlock(parallel, count,
      [&](Index block, Index begin, Index end)
      {
        double* const sums = partial + block * K;
        double cotans[3 * BlockSize];
        const double* c = cotans;
        if (coefficients.rows() > 0)
        {
          c = &coefficients(from + begin, 0);
        }
        else
        {
          for (Index t = from + begin; t < from + end; ++t)
          {
            Eigen::Map<Eigen::RowVector3d>(cotans +
              static_cast<std::ptrdiff_t>(t - from - begin) * 3) = CotanWeights(mesh.Shapes()[t]);
          }
        }
        if constexpr (K == ColumnPanel)
        {
          SumTrianglesOfPanel(corners, c, start, u.cols(), from + begin, from + end, sums);
        }
        else
        {
          SumTriangles<K>(corners, c, start, u.cols(), from + begin, from + end, sums);
        }
      });
    for (Index s = 0; s < NumberOfBlocks(count) * K; ++s)
    {
      total[s % K] += partial[s];
    }
  }
  return std::accumulate(total, total + K, 0.0);
}

} // namespace

double DirichletEnergy(const TriangleMesh& mesh, const CornerWeights& coefficients, const Values& u,
  const ParallelFor& parallel)
{
  double sum = 0.0;
  for (Eigen::Index first = 0; first < u.cols();)
  {
    constexpr Eigen::Index few = 3;
    const Eigen::Index left = u.cols() - first;
    const Eigen::Index width = left >= ColumnPanel ? ColumnPanel
      : left >= HalfPanel                          ? HalfPanel
                                                   : std::min(left, few);
    ForColumns(width,
      [&](auto number)
      {
        constexpr int columns = decltype(number)::value;
        if constexpr (columns > 0)
        {
          sum += SumColumnsOf<columns>(mesh, coefficients, u, first, parallel);
        }
      });
    first += width;
  }
  return 0.5 * sum;
}

double DirichletEnergy(const SparseMatrix& stiffness, const Values& u, const ParallelFor& parallel)
{
  return 0.5 *
    Sum(parallel, static_cast<Index>(u.rows()),
      [&](Index i)
      {
        double sum = 0.0;
        for (Eigen::Index k = 0; k < u.cols(); ++k)
        {
          double product = 0.0;
          for (SparseMatrix::InnerIterator entry(stiffness, i); entry; ++entry)
          {
            product += entry.value() * u(entry.index(), k);
          }
          sum += u(i, k) * product;
        }
        return sum;
      });
}

} // namespace SurfaceDiffusion
