// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/Columns.h"
#include "Core/Foundation/Parallel.h"
#include "Core/Models/EdgeFunctions.h"
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
public:
  /// function: of a convex psi, without beta. ranges: typical range of the values on each triangle.
  /// unknowns: number of vertices of the surface.
  GradientSplitting(std::shared_ptr<const TriangleMesh> mesh,
    std::shared_ptr<const std::vector<GradientMap>> gradients, const EdgeFunction& function,
    ChannelCoupling coupling, const Vector& ranges, double unknowns, const ParallelFor& parallel);

  /// The coefficients of int r/2 |S grad u|^2 for Assembler, at the first penalty.
  CornerWeights MakeCoefficients() const;

  /// Sum over the triangles of the surface of r A |grad phi|^2, at the first penalty and for the
  /// steepest basis function phi of each.
  double Stiffness() const;

  /// Multiplies the first penalty of all triangles by `growth`. The multipliers y = r b stay.
  void SetGrowth(double growth);
  double Growth() const { return this->PenaltyGrowth; }

  /// p = S grad u, and b = 0 unless there are multipliers to start from.
  void Start(const Values& u, bool keepMultipliers);

  /// b at the first penalty, one row per triangle; to be changed only when the growth is 1.
  Values& Multipliers() { return this->B; }
  const Values& Multipliers() const { return this->B; }

  /// p and b from the present u, over-relaxed, and what they give to the equation for u.
  void Update(const Values& u, double relaxation);

  /// row: what Update() gave to the equation at vertex i, accumulated over the triangles of this
  /// process; K columns, or any number of them for K = 0.
  template <int K>
  void GatherRightHandSide(Index i, double* row) const
  {
    const Index* begin = this->Mesh->VertexCornersBegin().data();
    const Index* corners = this->Mesh->VertexCorners().data();
    for (int k = 0; k < ColumnCount<K>(this->Corners.cols()); ++k)
    {
      double sum = 0.0;
      for (Index c = begin[i]; c < begin[i + 1]; ++c)
      {
        sum += this->Corners(corners[c], k);
      }
      row[k] = sum;
    }
  }

  /// divergence: per vertex i the integral of y . S grad phi_i, accumulated over the triangles of
  /// this process.
  void GatherMultipliers(Values& divergence) const;

  /// int psi(|S grad u|), summed over the triangles of this process.
  double Energy(const Values& u) const;

  /// int psi*(|y|), likewise.
  double ConjugateEnergy() const;

private:
  template <int K>
  void UpdateColumns(const Values& u, double relaxation);
  Eigen::Vector2d GradientOf(const Values& u, Index t, Eigen::Index k) const;

  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const std::vector<GradientMap>> Gradients;
  EdgeFunction Function;
  ChannelCoupling Coupling;
  const ParallelFor& Parallel;
  Vector Penalty; ///< r per triangle at the start, times its area
  double PenaltyGrowth = 1.0; ///< r over that of the start
  Values P, B; ///< per triangle: x and y of the first column, x and y of the second, ...
  Values Corners; ///< per triangle corner: what the triangle gives to the equation of a vertex
};

} // namespace SurfaceDiffusion
