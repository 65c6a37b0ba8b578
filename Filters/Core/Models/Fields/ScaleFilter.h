// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/Fields/ResolventPolynomial.h"
#include "Core/Models/Fields/SquareResolvent.h"

#include <functional>
#include <memory>

namespace SurfaceDiffusion
{

/// The implicit filter of data by scale (K. Nowak, S. Danilov, V. Mueller, C. Liu, Geosci. Model Dev.
/// 18, 2025),
///   (1 + 2 (-Laplace / k^2)^order) u = f,  k = 2 pi / wavelength,
/// which leaves a third of a wave of this wavelength, more of longer ones and less of shorter ones.
/// The wavelength may differ from place to place: -div(k^-2 grad) then stands in place of
/// -Laplace / k^2. Constants and the integral over each connected component stay.
///
/// Order 1 is one step of backward Euler. Order 2 is a SquareResolvent, to 1e-10, or where that would need
/// many iterations, for wavelengths of more than some 50 edges and on needles, a polynomial in such a step,
/// to 2e-10.
class ScaleFilter
{
public:
  /// wavelengths: per vertex, in the units of the mesh, above 0. order: 1 or 2.
  ScaleFilter(std::shared_ptr<const Assembler> assembler, const Vector& wavelengths, int order,
    const ParallelFor& parallel = SerialFor());

  /// See ResolventPolynomial.
  void Apply(Values& u, const ProgressMonitor& progress = ProgressMonitor());
  double MissedResidual() const
  {
    return this->Polynomial ? this->Polynomial->MissedResidual() : 0.0;
  }

private:
  std::unique_ptr<SquareResolvent> Square; ///< null: the polynomial
  std::unique_ptr<ResolventPolynomial> Polynomial; ///< made when it is needed
  std::function<std::unique_ptr<ResolventPolynomial>()> MakePolynomial;
};

/// The parts of the polynomial: the filter is p(Y) with Y = (1 + L)^-1, the diffusivities of L, per triangle, and the
/// Chebyshev series of p. The arguments are the same.
std::vector<double> ScaleFilterSeries(int order);
Vector ScaleFilterDiffusivities(const TriangleMesh& mesh, const Vector& wavelengths, int order,
  const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
