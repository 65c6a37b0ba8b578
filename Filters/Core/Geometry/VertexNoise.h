// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

#include <vector>

namespace SurfaceDiffusion
{

/// The value below which this fraction of them, below 1, is; 0 without values. Reorders them.
double QuantileOf(std::vector<double>& values, double fraction);

/// The deviation of normally distributed numbers whose absolute values these are by their 0.95 quantile,
/// over that by their 0.3 quantile; infinite if the latter is 0. Reorders them.
double TailOfNormal(std::vector<double>& values);

/// An estimate of the noise of the vertices of a surface: the standard deviation of their
/// displacement along the normal, in the unit of the points.
///
/// A quadric z = a + b s + c t + d s^2 + e s t + f t^2 is fitted to the neighbours of each vertex
/// and their neighbours, without the vertex itself. The distance of the vertex from it has the
/// variance sigma^2 (1 + l), where l is the leverage of the fit. sigma_2 is the 0.3 quantile of the
/// absolute standardised distances over 0.3853, so that edges and corners of the surface, and
/// outliers, hardly matter as long as they are near to less than 70 % of the vertices. Vertices
/// with fewer than nine such neighbours, or with l > 2, are left out, and so are all but 20,000 to
/// 40,000 vertices of larger surfaces.
///
/// sigma_3 is the same with one more ring of neighbours. White noise has the same distances in
/// both. The details of a surface that a quadric does not follow have larger ones, by the factor
/// g = (3/2)^3 in the variance for details with a little more than a continuous gradient, and by
/// less for rougher ones. With the growth R = sigma_3^2 / sigma_2^2 - 1 and R0 = 1.6, the growth on
/// scanned and contoured surfaces without noise, the variance of the noise is
///
///   sigma_2^2 (1 - R / (g - 1) - (1 - R0 / (g - 1)) (R / R0)^3),
///
/// not below 0. For small R this extrapolates the variance to a neighbourhood of no size. It is 0
/// from R0 on, and NaN if less than 30 % of the vertices are left.
///
/// Where edges are short under the noise, the neighbours have no plane, and the quadric follows the noise.
/// Each vertex takes so many rings, up to eight, that the deviation of the neighbours along their second
/// axis is 2.2 of the sigma that is found with them. If that needs more than two rings at 30 % of the
/// vertices and more, as on uneven tessellations, the larger of the two estimates is taken, unless the
/// second is mostly details.
///
/// points: per vertex of the mesh.
double EstimateVertexNoise(
  const TriangleMesh& mesh, const Points& points, const ParallelFor& parallel = SerialFor());

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

} // namespace SurfaceDiffusion
