// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Operators/Assembler.h"

namespace SurfaceDiffusion
{

/// The curvature at the vertices of a surface, in 1/LengthUnit(). It is positive where the surface
/// bends away from its normals, as on a sphere with its normals outward.
struct Curvatures
{
  Vector Mean; ///< H, half the sum of the principal curvatures
  Vector Gaussian; ///< K, their product
  Values Principal; ///< n x 2: the larger one, the smaller one
  double MissedResidual = 0.0; ///< as returned by SmoothByHeat()
  /// Triangles that count as turned, so that neighbours have the same orientation.
  Index TurnedTriangles = 0;

  /// 2/pi atan((k_1 + k_2)/(k_1 - k_2)), from 1 on caps to -1 in cups, 0 on saddles and planes.
  double ShapeIndex(Index i) const;
  /// The root mean square of the principal curvatures.
  double Curvedness(Index i) const;
};

/// The eigenvalues of the shape operator S = dn/dx, made symmetric, in the tangent plane.
///
/// fwhm = 0: from the polynomial that fits the vertices of at most two edges from each vertex, its own
/// position held, as a function over the plane orthogonal to its normal: see QuadraticFits. Where the
/// normals of neighbours are at 60 degrees or more, and all neighbours lie on one side of this plane,
/// a polynomial that is flat or bends to the other side gives way to the paraboloid of revolution
/// that fits the neighbours: convex corners are positive. The error is of second order in the length
/// of the edges on meshes that look alike in opposite directions, and of first order on others and
/// at boundaries.
///
/// fwhm > 0, in LengthUnit(): S is the slope of the normals of these polynomials over the positions
/// by FitByHeat(), weighted with the Gaussian of this full width at half maximum on the surface. It
/// is exact on spheres, and has an error of order fwhm^2 elsewhere, of order fwhm at boundaries.
///
/// Curvatures that the rounding of the coordinates may cause are 0.
///
/// On surfaces with one side, such as a Moebius strip, H has no sign, and is positive.
///
/// positions: per vertex, in LengthUnit(). operators: of the heat equation, of a mesh with the same
/// vertices; not used if fwhm is 0. Those of an intrinsic Delaunay triangulation have no negative
/// weights, which fits need on narrow Gaussians. Throws Aborted, NotConverged.
Curvatures EstimateCurvature(const TriangleMesh& mesh, const Points& positions, double fwhm,
  const Assembler* operators, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
