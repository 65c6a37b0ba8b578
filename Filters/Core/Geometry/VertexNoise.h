// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

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

} // namespace SurfaceDiffusion
