// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/IndexLists.h"
#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// Statistics of the displacements d_i of the vertices of a surface that is denoised.
///
/// Their whiteness is the variance of the sums s_i of d over a vertex and its neighbours, m_i
/// vertices together, over that of sums of independent numbers:
///
///   R = sum_i s_i^2 / m_i / sum_i d_i^2.
///
/// Independent noise has R = 1. While noise is left in the surface, R is smaller, since noise of
/// short wavelength, whose sums vanish, is removed first. Where details of the surface were removed,
/// too, R is larger. (That the residual of a good solution is as white as the noise is the residual
/// whiteness principle: A. Lanza, M. Pragliola, F. Sgallari, Residual Whiteness Principle for
/// Parameter-Free Image Restoration, ETNA 53, 2020.)
class DisplacementStatistics
{
public:
  /// fixed: per vertex, nonzero for those that take no part; may be empty.
  DisplacementStatistics(const TriangleMesh& mesh, const std::vector<char>& fixed,
    const ParallelFor& parallel = SerialFor());

  /// R of all vertices, with sums over those that are not fixed; 0 if none has moved.
  double Whiteness(const Vector& displacements) const;
  /// The standard deviation of R for independent noise: sums share terms, so that there are as many
  /// independent ones as sums without a common term.
  double WhitenessDeviation() const;
  /// Per vertex, R of the vertices around it, with weights that fall over about five edges; 0 where
  /// none has moved. Fixed ones count as neighbours that stay, so that steps beside them, which they
  /// guide, end later.
  Vector LocalWhiteness(const Vector& displacements) const;
  /// Per vertex, the mean of these numbers over those around it, about two edges.
  Vector LocalMeans(const Vector& values) const;

private:
  bool IsFixed(Index i) const { return !this->Fixed.empty() && this->Fixed[i] != 0; }
  double Count(Index i) const
  {
    return static_cast<double>(1 + this->Around.Begin[i + 1] - this->Around.Begin[i]);
  }
  double FreeCount(Index i) const; ///< of it and the neighbours that are not fixed
  /// Per vertex: s^2 / m and d^2, in single precision.
  using Squares = Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor>;
  Squares FindSquares(const Vector& displacements) const;
  template <typename Matrix>
  void Average(Matrix& values, int sweeps) const;

  const std::vector<char> Fixed;
  const ParallelFor& Parallel;
  IndexLists Around; ///< per vertex: its neighbours
};

} // namespace SurfaceDiffusion
