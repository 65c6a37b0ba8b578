// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Parallel.h"
#include "Core/Models/EdgeFunctions.h"
#include "Core/Models/TotalVariation/SlicedSplitting.h"
#include "Core/Operators/GradientMap.h"
#include "Core/Surface/TriangleMesh.h"

#include <memory>
#include <vector>

namespace SurfaceDiffusion
{

/// The gradient term int psi(|S grad u|) of an energy in the alternating direction method of
/// multipliers (see TotalVariationMinimizer): p = S grad u on each triangle, split from u, with a
/// penalty r and the scaled multiplier b. The multiplier y = r b is feasible for the dual problem
/// at every iteration.
class GradientSplitting
{
  // Their types are deduced: they come before their uses.
  template <typename Act>
  decltype(auto) Visit(const Act& act)
  {
    return this->IsSingle ? act(this->Single) : act(this->Double);
  }
  template <typename Act>
  decltype(auto) Visit(const Act& act) const
  {
    return this->IsSingle ? act(this->Single) : act(this->Double);
  }

public:
  /// function: of a convex psi, without beta. ranges: typical range of the values on each triangle.
  /// unknowns: number of vertices of the surface.
  GradientSplitting(std::shared_ptr<const TriangleMesh> mesh,
    std::shared_ptr<const GradientMaps> gradients, const EdgeFunction& function,
    ChannelCoupling coupling, const Vector& ranges, double unknowns, const ParallelFor& parallel);

  /// The coefficients of int r/2 |S grad u|^2 for Assembler, at the first penalty.
  CornerWeights MakeCoefficients() const;

  /// Sum over the triangles of the surface of r A |grad phi|^2, at the first penalty and for the
  /// steepest basis function phi of each.
  double Stiffness() const;

  /// Multiplies the first penalty of all triangles by `growth`. The multipliers y = r b stay.
  void SetGrowth(double growth)
  {
    this->Visit([growth](auto& splitting) { splitting.SetGrowth(growth); });
  }
  double Growth() const
  {
    return this->Visit([](const auto& splitting) { return splitting.Growth(); });
  }

  /// Whether Balance() does anything: for total variation, where |y| is at most 1.
  bool CanBalance() const { return this->Function.Kind == EdgeFunctionKind::TotalVariation; }

  /// Adapts the penalty of each triangle to p: in flat regions, where p = 0, values settle the
  /// faster the larger r is, and at edges the faster the smaller it is. Both are fast where r |p| is
  /// near 1, since the multiplier, a direction, and p then change alike: residual balancing (Boyd
  /// et al. 2011, section 3.4.1) on each triangle. It may be called between updates; convergence is
  /// that of a method with a penalty that stays, since it changes within bounds only.
  void Balance()
  {
    if (this->CanBalance())
    {
      this->Visit([this](auto& splitting) { splitting.Balance(this->Scales); });
    }
  }

  /// r over the first penalty times growth, per triangle, after Balance().
  const Vector& GetScales() const { return this->Scales; }

  /// p = S grad u in the next Update(), the first penalty, and y = 0 unless there are multipliers
  /// to start from. inSinglePrecision: if the function and the numbers of the surface allow it.
  void Start(int columns, bool keepMultipliers, bool inSinglePrecision);

  /// y, in row t of 2 columns numbers that of triangle t. Those that are set are kept for Start().
  std::size_t NumberOfMultipliers(int columns) const
  {
    return static_cast<std::size_t>(this->Mesh->NumberOfTriangles()) * 2 * columns;
  }
  int NumberOfColumns() const ///< 0 before the first Start()
  {
    return this->Kept.empty()
      ? this->Visit([](const auto& splitting) { return splitting.NumberOfColumns(); })
      : this->KeptColumns;
  }
  void GetMultipliers(double* multipliers) const;
  void SetMultipliers(const double* multipliers, int columns);

  /// p and b from the present u, over-relaxed, and what they give to the equation for u.
  void Update(const Values& u, double relaxation)
  {
    this->Visit([&](auto& splitting) { splitting.Update(u, relaxation); });
  }

  /// row: what Update() gave to the equation at vertex i, accumulated over the triangles of this
  /// process; K columns, or any number of them for K = 0.
  template <int K>
  void GatherRightHandSide(Index i, double* row) const
  {
    this->Visit([=](const auto& splitting) { splitting.template Gather<K>(i, row); });
  }

  /// divergence: per vertex i the integral of y . S grad phi_i, accumulated over the triangles of
  /// this process.
  void GatherMultipliers(Values& divergence);

  /// int psi(|S grad u|), summed over the triangles of this process.
  double Energy(const Values& u) const;

  /// int psi*(|y|), likewise.
  double ConjugateEnergy() const
  {
    return this->Visit([](const auto& splitting) { return splitting.ConjugateEnergy(); });
  }

private:
  bool CanBeSingle();
  Eigen::Vector2d GradientOf(const Values& u, Index t, Eigen::Index k) const;

  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const GradientMaps> Gradients;
  EdgeFunction Function;
  ChannelCoupling Coupling;
  const ParallelFor& Parallel;
  Vector Penalty; ///< r per triangle at the start, times its area
  Vector Scales; ///< of the penalty in that of Single and Double which has the state
  SlicedSplitting<float> Single;
  SlicedSplitting<double> Double;
  bool IsSingle = false; ///< which one has the state
  std::vector<double> Kept; ///< multipliers for the next Start()
  int KeptColumns = 0;
};

} // namespace SurfaceDiffusion
