// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Rings.h"
#include "Core/Surface/PointData.h"
#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// How a state u = J(f) of noisy data f passes noise on. Means are over the area and the columns,
/// weighted by the fidelity factors w; s p is a random direction of independent entries, whose
/// variances are those of the noise: s^2/w, more at outliers. J' p is the derivative of u along p.
struct NoiseResponse
{
  double MeanSquare = 0.0; ///< of (u - f)^2
  double Freedom = 0.0; ///< of p J' p
  double Removed = 0.0; ///< of (p - J' p)^2
  double Direction = 0.0; ///< of p^2

  void Scale(double factor)
  {
    for (double* const mean :
      { &this->MeanSquare, &this->Freedom, &this->Removed, &this->Direction })
    {
      *mean *= factor;
    }
  }

  /// The unbiased estimate of the mean square error of u, but for a constant: the expectation of
  /// s^2 p J' p is that of the noise times u, sum_i A_i w_i var_i du_i/df_i over the area (C. Stein,
  /// Annals of Statistics 9, 1981).
  double Risk(double noise) const { return this->MeanSquare + 2.0 * noise * noise * this->Freedom; }
  /// The estimate that needs no s: generalised cross-validation (P. Craven, G. Wahba, Numerische
  /// Mathematik 31, 1979).
  double CrossValidation() const
  {
    const double removed = 1.0 - this->Freedom / this->Direction;
    return this->MeanSquare / (removed * removed);
  }
  /// The s^2 of noise of which u takes as much away as of f. It is larger than that of the noise
  /// where u takes away some of the signal, too.
  double LargestVariance() const { return this->MeanSquare / this->Removed; }
};

/// From states u of f and changed[d] of f + step directions[d], for the first `count` of these.
/// `data`: those that count, see Discrepancy().
NoiseResponse MeasureNoiseResponse(const TriangleMesh& mesh, const PointData& data, const Values& u,
  const std::vector<Values>& changed, const std::vector<Values>& directions, int count, double step,
  VertexRange range);

} // namespace SurfaceDiffusion
