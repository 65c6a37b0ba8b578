// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/TotalVariation/VertexTerms.h"

#include <memory>

namespace SurfaceDiffusion
{

/// The nearest point of the convex set S of a row of `columns` values: of [0, 1] for one column, of
/// the unit simplex {u_k >= 0, sum u_k = 1} for more (C. Michelot, J. Optim. Theory Appl. 50,
/// 1986).
void ProjectOntoSimplex(double* row, int columns);

/// The terms sum_i A_i (a_i . u_i - m_i) of an energy, linear costs a with every u_i in S, which is
/// [0, 1] for one column and the unit simplex for more. m_i is the minimum of a_i . v over v in S:
/// with it the terms are not negative and do not depend on a constant that is added to all costs of
/// a vertex. They act on q = u.
class SimplexSplitting : public VertexTerms
{
public:
  /// typicalCost: of the differences between the a of one vertex, for the size of the penalty.
  SimplexSplitting(std::shared_ptr<const TriangleMesh> mesh, Flags fixed, double typicalCost,
    const ParallelFor& parallel);

  /// A rho
  Vector MakeDiagonal() const override { return this->Penalty; }
  bool IsSplit() const override { return true; }
  /// costs: a. The second argument is not used.
  void Start(const Values& costs, const Values&, const Values& u, bool keepMultipliers) override;
  void Update(const Values& u, double relaxation) override;
  void AddRightHandSide(Index i, double* row) const override;
  /// The nearest state in S.
  const Values& Admissible(const Values& u) override;
  double Energy(const Values& u) const override;
  /// S is bounded: it is the minimum over all u.
  double DualEnergy(const Values& d, const Values& u) const override;

private:
  const Values* Costs = nullptr; ///< a
  Values Nearest; ///< storage of Admissible()
};

} // namespace SurfaceDiffusion
