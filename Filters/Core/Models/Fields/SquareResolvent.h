// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ColumnSums.h"
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/MeanCorrection.h"

#include <complex>
#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// (1 + L^2)^-1 u with L = M^-1 K, the real part of (1 + i L)^-1 u, which needs no solves but one
/// recurrence of Lanczos with L: conjugate gradients for the complex symmetric matrix M + i K, whose
/// residuals are real up to factors (R. Freund, SIAM J. Sci. Stat. Comput. 13, 1992). The error in the
/// norm of M is at most the residual in that of M^-1, 1e-10 of u without its mean.
///
/// Constants stay, and so does the integral over each connected component.
class SquareResolvent
{
public:
  /// coefficients: of K, see CotanWeights.h.
  SquareResolvent(std::shared_ptr<const Assembler> assembler, const CornerWeights& coefficients,
    const ParallelFor& parallel = SerialFor());

  /// The number of iterations at most, by Gershgorin's bound of L; not finite if that has none.
  double ExpectedIterations() const { return this->Expected; }

  /// u becomes (1 + L^2)^-1 u. No bit of a column depends on the others. False, and u is as before, if
  /// this takes more than twice the expected number of iterations. Throws Aborted.
  bool Apply(Values& u, const ProgressMonitor& progress = ProgressMonitor());

private:
  /// What the recurrence knows of a column.
  struct Column
  {
    double Unit = 1.0; ///< 1 / |w|: the vectors of Lanczos are unit times w
    double LastUnit = 0.0;
    double Beta = 0.0; ///< the entry of Lanczos' matrix for the last vector and this one
    double Start = 0.0; ///< the norm of the right-hand side
    std::complex<double> Pivot = 1.0, Rest = 0.0, Step = 0.0;
    bool IsFinished = false;
  };

  template <int K>
  bool Iterate(Values& u, const ProgressMonitor& progress);

  std::shared_ptr<const Assembler> Assembly;
  const ParallelFor& Parallel;
  SparseMatrix Matrix; ///< M^-1/2 K M^-1/2
  Vector Roots; ///< M^1/2
  MeanCorrection Balanced;
  double Expected = 0.0;
  ColumnSums Sums;
  std::vector<Column> Columns;
  Values W, LastW, Product, P, Q; ///< the direction is P + i Q
};

} // namespace SurfaceDiffusion
