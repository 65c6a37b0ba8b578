// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Surface/TriangleMesh.h"

#include <memory>
#include <utility>

namespace SurfaceDiffusion
{

/// The terms of an energy at the vertices in the alternating direction method of multipliers (see
/// TotalVariationMinimizer): a sum over the vertices of convex functions of u_i. Those that are not
/// quadratic act on q, split from u, with a penalty rho and the scaled multiplier c. Some u_i may
/// be fixed.
class VertexTerms
{
public:
  virtual ~VertexTerms() = default;

  const Flags& GetFixed() const { return this->Fixed; }

  /// What the quadratic terms and the penalties add to the diagonal of the equation for u,
  /// consistent.
  virtual Vector MakeDiagonal() const = 0;

  /// How much more they add in each column, n x k and consistent; without columns: nothing.
  virtual Values MakeColumnShifts() const { return Values(); }

  /// Sum over the vertices of the surface of the second derivatives of the quadratic terms.
  virtual double QuadraticWeight() const { return 0.0; }
  /// The share of the area of vertices that are not fixed and have no such term.
  virtual double ShareWithoutData() const { return 0.0; }

  /// Whether there are multipliers c.
  virtual bool IsSplit() const = 0;

  /// Take the data g and f, which must stay as they are until the next start, and q from u; c = 0
  /// unless there are multipliers to start from.
  virtual void Start(const Values& g, const Values& f, const Values& u, bool keepMultipliers) = 0;

  /// c, one row per vertex; no row without multipliers.
  Values& Multipliers() { return this->C; }
  const Values& Multipliers() const { return this->C; }

  /// q and c from the present u, over-relaxed.
  virtual void Update(const Values& u, double relaxation) = 0;

  /// Add what the terms give to the equation for u at vertex i, consistent.
  virtual void AddRightHandSide(Index i, double* row) const = 0;

  /// A state near u at which all terms are finite: u itself, unless a subclass has constraints.
  virtual const Values& Admissible(const Values& u) { return u; }

  /// The terms at an admissible u, summed over the vertices of the surface.
  virtual double Energy(const Values& u) const = 0;

  /// Their part of the dual function, likewise: the minimum over u of d . u and the terms, for
  /// given d, consistent. u: of fixed vertices, and the centre of a ball in which the minimum is
  /// sought if it would be minus infinity.
  virtual double DualEnergy(const Values& d, const Values& u) const = 0;

  /// The largest s <= 1 for which DualEnergy() of s d is the minimum over all u, not only over a
  /// ball.
  virtual double FeasibleShare(const Values& /*d*/) const { return 1.0; }

protected:
  VertexTerms(std::shared_ptr<const TriangleMesh> mesh, Flags fixed, const ParallelFor& parallel)
    : Mesh(std::move(mesh))
    , OverProcesses(this->Mesh->GetReduction())
    , Parallel(parallel)
    , Areas(this->OverProcesses.Accumulated(this->Mesh->ControlAreas(), this->AccumulatedAreas))
    , Fixed(std::move(fixed))
    , Penalty(this->Areas.size())
  {
  }

  Index NumberOfVertices() const { return this->Mesh->NumberOfVertices(); }

  const std::shared_ptr<const TriangleMesh> Mesh;
  const Reduction& OverProcesses;
  const ParallelFor& Parallel;

private:
  Vector AccumulatedAreas;

protected:
  const Vector& Areas; ///< of the control cells, consistent
  const Flags Fixed;
  Vector Penalty; ///< rho per vertex, times its area
  Values Q, C;
};

} // namespace SurfaceDiffusion
