// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Operators/Assembler.h"

#include <array>
#include <memory>
#include <optional>

namespace SurfaceDiffusion
{

/// A coarse discretisation of the diffusion of two chemicals on a surface: the Galerkin projection
/// to the space that smoothed aggregation (Aggregation.h) spans. With the prolongation P, whose
/// rows sum to 1, the stiffness matrices are P^T K P times a correction of the wavelength, and the
/// areas P^T A, so that integrals are those of the prolonged functions.
struct CoarseSpace
{
  std::shared_ptr<const Assembler> Assembly; ///< its mesh has vertices with areas, no triangles
  SparseMatrix Restriction; ///< P^T: column i holds the weights of the coarse vertices in vertex i
  std::array<SparseMatrix, 2> Stiffness; ///< per chemical

  Index NumberOfVertices() const { return this->Assembly->Mesh().NumberOfVertices(); }

  /// A^-1 P^T A_fine u.
  Values Restrict(const TriangleMesh& fine, const Values& u) const;
  /// u = P coarse, all columns.
  void Prolong(const Values& coarse, Values& u, const ParallelFor& parallel) const;
};

/// The coarsest space that resolves waves with this squared wave number, in LengthUnit()^-2, by 3.4
/// vertices per wavelength on the first level, or 6 on further levels; empty if the first level is
/// too coarse. The second chemical, whose diffusion gives the pattern its width, determines the
/// aggregates.
///
/// coefficients: of the diffusion tensors (CotanWeights.h). The stiffness matrices are corrected so
/// that waves of this wave number keep it within a few percent. A projected long wave is too stiff,
/// by 1.1 to 1.5 per level; the factor is measured with smoothed noise. Short waves are too soft,
/// since the mass matrix is lumped.
std::optional<CoarseSpace> MakeCoarseSpace(const Assembler& fine,
  const std::array<CornerWeights, 2>& coefficients, double squaredWaveNumber,
  const ParallelFor& parallel = SerialFor());

} // namespace SurfaceDiffusion
