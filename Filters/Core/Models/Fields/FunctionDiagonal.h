// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Operators/Assembler.h"

#include <functional>

namespace SurfaceDiffusion
{

/// A sum of simple poles, sum_j c_j / (q_j + x), that is near to a function on x >= 0.
struct PoleSum
{
  Vector Poles; ///< q > 0
  Vector Residues; ///< c
};

/// The residues minimise the squared error of the sum, weighted by x + 0.03, over log x: the number
/// of eigenvalues of a surface below x grows as x does. g falls faster than 1 / x. The poles are
/// `count` numbers from first to last with equal ratios.
PoleSum FitPoles(const std::function<double(double)>& g, double first, double last, int count);

/// The diagonal of f(s L) M^-1 with L = M^-1 K and f the sum of poles: per vertex. It is
///   sum_j c_j diag (q_j M + s K)^-1,
/// by selected inversion of one factor after another. Throws Aborted, std::bad_alloc.
Vector FunctionDiagonal(const Assembler& assembler, const CornerWeights& coefficients, double s,
  const PoleSum& f, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
