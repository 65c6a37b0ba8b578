// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/EdgeFunctions.h"
#include "Core/Models/TotalVariation/VertexTerms.h"

#include <memory>

namespace SurfaceDiffusion
{

/// The terms sum_i A_i (mu_i/2 |u_i - g_i|^2 + nu_i |u_i - f_i|) of an energy. The second one acts
/// on q = u - f. Without it, mu may differ from column to column.
class VertexSplitting : public VertexTerms
{
public:
  struct Settings
  {
    EdgeFunction Function; ///< of the gradient term, for the size of the penalty
    ChannelCoupling Coupling;
    double Range; ///< largest max - min of the data over the channels
  };

  /// quadratic, absolute: mu, nu; mu with one column, or with as many as u. ranges: typical range
  /// of the values around each vertex, consistent.
  VertexSplitting(std::shared_ptr<const TriangleMesh> mesh, Values quadratic, Vector absolute,
    Flags fixed, const Vector& ranges, const Settings& settings, const ParallelFor& parallel);

  /// A (mu + rho), of the first column
  Vector MakeDiagonal() const override;
  Values MakeColumnShifts() const override;
  /// Of the column with the least.
  double QuadraticWeight() const override;
  double ShareWithoutData() const override;
  bool IsSplit() const override { return this->HasAbsolute; }
  void Start(const Values& g, const Values& f, const Values& u, bool keepMultipliers) override;
  void Update(const Values& u, double relaxation) override;
  void AddRightHandSide(Index i, double* row) const override
  {
    const double rho = this->Penalty[i];
    const int columns = static_cast<int>(this->G->cols());
    for (int k = 0; k < columns; ++k)
    {
      const double side = this->Areas[i] * this->Mu(i, k) * (*this->G)(i, k);
      row[k] += rho > 0.0 ? side + rho * ((*this->F)(i, k) + this->Q(i, k) - this->C(i, k)) : side;
    }
  }
  double Energy(const Values& u) const override;

  /// The ball has the radius Range, and is used at vertices with mu = 0.
  double DualEnergy(const Values& d, const Values& u) const override;

  /// The largest s <= 1 for which |s d| <= nu A at all vertices with mu = 0 < nu that are not
  /// fixed.
  double FeasibleShare(const Values& d) const override;

private:
  double Mu(Index i, int k) const { return this->Quadratic(i, this->Quadratic.cols() > 1 ? k : 0); }
  double DualAt(Index i, const Values& d, const Values& u, int first, int last) const;

  Values Quadratic; ///< with a row per vertex, and one column for all columns of u or one for each
  Vector Absolute;
  Settings Options;
  bool HasAbsolute;
  const Values* G = nullptr;
  const Values* F = nullptr;
};

} // namespace SurfaceDiffusion
