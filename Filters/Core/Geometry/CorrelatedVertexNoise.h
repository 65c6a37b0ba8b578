// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// Noise that vertices share with those near them, as that of depth cameras, in the unit of the
/// points. All 0: none was found.
struct CorrelatedNoise
{
  double Level = 0.0; ///< the standard deviation along the normal
  double Length = 0.0; ///< over which it is correlated
  /// Relief may have the same sigma_r: noise has displacements that are normally distributed, too.
  bool MayBeRelief = false;
};

/// Find correlated noise by the growth of sigma_r, the deviation of vertices from a quadric through
/// r rings of neighbours (see EstimateVertexNoise()). A quadric follows noise of the correlation
/// length L (covariance exp(-d^2 / (2 L^2))) as long as r is less than about 3 L / h, and from
/// there on sigma_r stays at the level of the noise. White noise has one sigma_r for all r, and
/// under white noise the details of a surface make it grow from more rings on. The details of a
/// surface make sigma_r grow with r all the way, by a factor of 2 and more from r = 8 to r = 16.
///
/// Noise is correlated if sigma_4 > 1.3 sigma_2, sigma_16 < 1.6 sigma_8, and sigma_16 is between
/// 0.1 h and h, on surfaces of at least 3,200 vertices, of which sixteen rings are a small part.
/// And it is normally distributed: the 0.95 quantile of distances with 4, 6 and 8 rings is at least
/// 0.8 of that of such numbers. Sine waves in one or two directions along the mesh are bounded, and
/// have 0.3 to 0.7; sums of waves in several directions and waves with cusps may have 1, and
/// resemble noise. The level is sigma_16, and 3 L the radius at which sigma_r^2 is half of that of
/// the level. Noise with L > 3 h does not reach its level within sixteen rings and is not found.
///
/// If this does not hold since the shape adds to sigma_r before the noise has its level, the sum
///
///   sigma_r^2 = S^2 f(r h/s)^2 + a r^8 + b r^6 + c,  f(x) = (1 + (4.1/x)^2.83)^(-1.06),
///
/// is fitted up to twelve rings, without negative terms and with least relative errors. The powers are those of
/// curved surfaces, and of edges. f is measured on planes: S is the
/// level, and s = L/sqrt(2) the deviation of the kernel that correlates the noise. It may be noise, or
/// relief, if its term is 0.7 of sigma_r^2 and more up to eight rings, and S is between 0.1 h and h/2.
///
/// given: the level, if it is known, otherwise 0. Then noise of these surfaces is correlated, too,
/// if sigma_2^2 is less than half of its square and sigma_4 > 1.8 sigma_2, up to L = 16/3 h:
/// details have as large a growth, but are below the level that is to be removed.
CorrelatedNoise EstimateCorrelatedNoise(const TriangleMesh& mesh, const Points& points,
  double given = 0.0, const ParallelFor& parallel = SerialFor());

/// Noise that is correlated by a kernel of this deviation s, in mean edge lengths: L = sqrt(2) s h. Its
/// level, unless it is given, is S of the sum above with this s. 0: no noise was found.
CorrelatedNoise NoiseOfLength(const TriangleMesh& mesh, const Points& points, double deviation,
  double given = 0.0, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
