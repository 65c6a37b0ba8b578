// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Operators/Assembler.h"

#include <functional>

namespace SurfaceDiffusion
{

class LinearSolver;

/// Smooth u, a row per vertex, by the heat equation with the mixed mass matrix (MixedMass) and the
/// ExponentialSeries, to the time at which the full width at half maximum of the Gaussian is `fwhm`,
/// in LengthUnit(): as vtkFVMHeatFilter smooths where a width is given. Returns the
/// largest relative residual of the solves that missed the tolerance, otherwise 0. Throws Aborted,
/// NotConverged.
double SmoothByHeat(const Assembler& assembler, double fwhm, Values& u, LinearSolver& solver,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

/// Linear functions that fit values near each vertex.
struct LinearFits
{
  Values Constants; ///< n x k: the value at the vertex
  Values Slopes; ///< n x 3k: the gradient in the tangent plane of each column
  double MissedResidual = 0.0; ///< as returned by SmoothByHeat()
};

/// At each vertex i the linear function a + b (x - x_i), b perpendicular to the normal n_i, that
/// minimises
///
///     sum over j of w_ij |u_j - a - b (x_j - x_i)|^2,
///
/// where w_i is the kernel of SmoothByHeat(), the Gaussian of this width on the surface. With the
/// means E of this kernel, b = C(u, x) C(x, x)^-1 in the tangent plane, C(u, x) = E[u x] - E[u]
/// E[x], and a = E[u] + b (x_i - E[x]): a few more columns of the same solves. It is exact for
/// functions that are linear in space and tangential, one-sided at boundaries, and for the normals
/// of a sphere, which are a multiple of x.
///
/// positions: per vertex, in LengthUnit(). u: n x k. normalOf(i, E[u]): n_i, of any length and sign,
/// from its number and the k means. Throws Aborted, NotConverged, bad_alloc.
LinearFits FitByHeat(const Assembler& assembler, const Points& positions,
  const std::function<Eigen::Vector3d(Index, const Eigen::RowVectorXd&)>& normalOf, const Values& u,
  double fwhm, const ParallelFor& parallel = SerialFor(),
  const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
