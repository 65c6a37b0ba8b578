// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Geometry/Derivatives.h"

#include <memory>

namespace SurfaceDiffusion
{

/// Vector fields u on the triangles as sums grad(phi) + n x grad(psi) + h, k of them. The potentials are
/// linear on each triangle and minimise |u - grad(phi)| and |u - n x grad(psi)|:
///
///     (K phi)_i = sum over triangles of a_t u_t . grad(phi_i)
///     (K psi)_i = sum over triangles of a_t u_t . (n x grad(phi_i)),   psi = 0 on boundaries,
///
/// with the stiffness matrix K of cotan weights, so that the three parts are orthogonal in the sum over
/// the triangles of a_t u_t . v_t. Phi has the mean 0 on each connected component, psi on each without a
/// boundary. h has neither divergence nor curl; it is 0 on spheres, up to the difference between the
/// field and its linear potentials. (K. Polthier, E. Preuss, Identifying Vector Field Singularities using
/// a Discrete Hodge Decomposition, Visualization and Mathematics III, 2003.) On surfaces with one side
/// psi is 0.
struct HelmholtzParts
{
  Values GradientPotential, CurlPotential; ///< phi and psi, n x k, in units of u times LengthUnit()
  Values GradientPart, CurlPart, HarmonicPart; ///< m x 3k
  double MissedResidual = 0.0; ///< of the solves, see StepReport
};

/// ofTriangles: u, m x 3k, whose parts in the planes of the triangles count. operators: of the mesh.
HelmholtzParts DecomposeVectors(std::shared_ptr<const TriangleMesh> mesh,
  const Derivatives& operators, const Values& ofTriangles,
  const ParallelFor& parallel = SerialFor(), const ProgressMonitor& progress = ProgressMonitor());

} // namespace SurfaceDiffusion
