// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/SparsePattern.h"
#include "Core/Vectors/TangentPlanes.h"

namespace SurfaceDiffusion
{

/// Laplacians of tangent vector fields. With the projector P of a triangle's plane the field there is
/// sum phi_j u_j, and its covariant derivative G = P (sum u_j grad(phi_j)^T) P is constant. On the unit
/// sphere gradients and curls of degree l decay at the rates given, with l(l+1) = d.
enum class VectorLaplacian
{
  Connection, ///< 1/2 int G:G; d - 1 both: for smoothing
  Hodge, ///< 1/2 int (tr G)^2 + (G12 - G21)^2; d both: commutes with divergence and curl
  Viscous ///< int sym G : sym G; 2 d - 2 and d - 2: of a viscous flow, keeps rigid rotations
};

/// The stiffness matrix K of 1/2 w.K w = the energy of one of them, for the coordinates w of vectors in
/// TangentPlanes, two rows a vertex.
class VectorStiffness
{
public:
  /// planes: must outlive it. coefficients: of the diffusion tensor D of Connection, 1/2 int
  /// tr(G D G^T), see CotanWeights.h, or of MixedMassWeights(), which make it that of B - M; no row:
  /// D = 1, which Hodge and Viscous require.
  VectorStiffness(
    const TangentPlanes& planes, VectorLaplacian laplacian, CornerWeights coefficients)
    : Planes(planes)
    , Laplacian(laplacian)
    , Coefficients(std::move(coefficients))
  {
  }

  const CornerWeights& GetCoefficients() const { return this->Coefficients; }

  /// diag(diagonal) + scale K. diagonal: one number per row. pattern: of the vertices.
  SparseMatrix Assemble(const SparsePattern& pattern, const Vector& diagonal, double scale,
    const ParallelFor& parallel = SerialFor()) const;

  /// 1/2 w.K w, summed over the columns.
  double Energy(const Values& w, const ParallelFor& parallel = SerialFor()) const;

private:
  using Element = Eigen::Matrix<double, 6, 6>;
  Element ElementOf(Index t) const;

  const TangentPlanes& Planes;
  VectorLaplacian Laplacian;
  CornerWeights Coefficients;
};

} // namespace SurfaceDiffusion
