// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Operators/Assembler.h"

#include <functional>
#include <map>

namespace SurfaceDiffusion
{

/// A sum of simple poles, c + sum_j c_j / (q_j + x), that is near to a function on x >= 0.
struct PoleSum
{
  Vector Poles; ///< q > 0
  Vector Residues; ///< c_j
  double Constant = 0.0; ///< c
};

/// x + 0.03: the number of eigenvalues of a surface below x grows as x does.
double WeightOfEigenvalue(double x);

/// The residues minimise the squared error of the sum, times `weight`, over log x. The poles are
/// `count` numbers from first to last with equal ratios. Without a constant g falls faster than 1 / x.
PoleSum FitPoles(const std::function<double(double)>& g, double first, double last, int count,
  const std::function<double(double)>& weight = &WeightOfEigenvalue, bool hasConstant = false);

/// Diagonals of (p M + K)^-1 at poles p that have equal ratios, which functions of several scales s
/// share: their poles q over s are some of these.
struct SharedPoles
{
  double First = 0.0; ///< p of number 0: the first one that is asked for
  double Ratio = 1.0;
  std::map<int, Vector> Diagonals; ///< by the number of p

  int NumberOf(double p) const;
  /// The nearest one.
  double Near(double p);
};

/// The diagonal of f(s L + e) M^-1 with L = M^-1 K and f the sum of poles without a constant: per vertex.
/// It is
///   sum_j c_j diag ((q_j + e) M + s K)^-1,
/// by selected inversion of one factor after another. extra: e; no row: 0. shared: of functions of growing scales; those that
/// no larger one needs are forgotten. Throws Aborted, std::bad_alloc.
Vector FunctionDiagonal(const Assembler& assembler, const CornerWeights& coefficients, double s,
  const PoleSum& f, const Vector& extra, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor(), SharedPoles* shared = nullptr);

} // namespace SurfaceDiffusion
