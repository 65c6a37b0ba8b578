// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Surface/TriangleMesh.h"

namespace SurfaceDiffusion
{

/// Coefficients of the finite volume scheme, per triangle, from its shape alone. By Theorem 1 (15)
/// the normal integrates over the part of the boundary of C_i inside a triangle to
/// -area grad(phi_i); so every coefficient is c_ij = -area grad(phi_i) . D grad(phi_j), symmetric,
/// and entry (t, a) of an CornerWeights is that of the two corners other than a.

/// Gradient of the linear function with these corner values, in the triangle's own axes.
inline Eigen::Vector2d Gradient(const TriangleMesh::Shape& s, double u0, double u1, double u2)
{
  const double x = (u1 - u0) / s.Length;
  return { x, (u2 - u0 - x * s.X) / s.Y };
}

/// (10) c_ij = 1/2 cot(angle at v_k): D = 1.
CornerWeights CotanWeights(const TriangleMesh& mesh, const ParallelFor& parallel = SerialFor());

/// (13) c1_ij = -area (grad(phi_i) . e1)(grad(phi_j) . e1): D = e1 e1^T. Zero where the frame is
/// zero. Those of e2 are c2 = c - c1.
CornerWeights DirectionalWeights(const TriangleMesh& mesh,
  const Eigen::Ref<const TangentVectors>& frames, const ParallelFor& parallel = SerialFor());

/// (12) g1 c1 + g2 c2 with constant g1, g2 >= 0; sqrt(g1 g2) c where the frame is zero.
CornerWeights AnisotropicWeights(const TriangleMesh& mesh, const CornerWeights& isotropic,
  const Eigen::Ref<const TangentVectors>& frames, double g1, double g2,
  const ParallelFor& parallel = SerialFor());

/// The same with g1, g2 of each triangle, m values each.
CornerWeights AnisotropicWeights(const TriangleMesh& mesh, const CornerWeights& isotropic,
  const Eigen::Ref<const TangentVectors>& frames, const Eigen::Ref<const Vector>& g1,
  const Eigen::Ref<const Vector>& g2, const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
