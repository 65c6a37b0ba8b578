// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/SmoothnessEnergy.h"

#include "Core/Models/Interpolation/HessianEnergy.h"
#include "Core/Models/Interpolation/NeedleShare.h"
#include "Core/Operators/CotanWeights.h"

#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The coefficients, with those of needles reduced to the size of NeedleShare().
CornerWeights Resolved(const TriangleMesh& mesh, CornerWeights coefficients)
{
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    coefficients.row(t) *= NeedleShare(mesh.Shapes()[t]);
  }
  return coefficients;
}

} // namespace

SmoothnessEnergy::SmoothnessEnergy(const Assembler& assembler, const CornerWeights& coefficients,
  double kappa, RimCondition rim, const ParallelFor& parallel)
  : Mesh(assembler.Mesh())
  , Parallel(parallel)
  , Kappa(kappa)
  , Rim(rim)
{
  const Vector& areas = this->Mesh.ControlAreas();
  const Vector none = Vector::Zero(areas.size());
  const double square = kappa * kappa;
  const CornerWeights resolved = Resolved(
    this->Mesh, rim == RimCondition::Natural ? coefficients : CotanWeights(this->Mesh, parallel));
  assembler.TakePattern(this->K, parallel);
  SparseMatrix first = this->K;
  assembler.Fill(this->K, none, 1.0, resolved, nullptr, parallel);
  if (rim == RimCondition::Natural)
  {
    assembler.Fill(first, square * areas, 1.0, resolved, nullptr, parallel);
    this->Q = first * areas.cwiseInverse().asDiagonal() * first;
    return;
  }
  assembler.Fill(first, (square * square) * areas, 2.0 * square, resolved, nullptr, parallel);
  this->First = std::move(first);
  this->TakeHessian(true);
}

void SmoothnessEnergy::TakeHessian(bool withNegativeCurvature)
{
  HessianEnergy hessian(this->Mesh, withNegativeCurvature);
  this->Gradient = std::move(hessian.Gradient);
  this->Second = std::move(hessian.Energy);
  const SparseMatrix product = this->Second * this->Gradient;
  const SparseMatrix transposed = this->Gradient.transpose();
  this->Q = transposed * product;
  this->Q += this->First;
}

void SmoothnessEnergy::DropNegativeCurvature()
{
  this->TakeHessian(false);
  this->Q += this->Tension * this->K;
}

Vector SmoothnessEnergy::Sizes() const
{
  const Vector diagonal = this->K.diagonal();
  return diagonal.cwiseAbs2().cwiseQuotient(this->Mesh.ControlAreas());
}

void SmoothnessEnergy::AddTension(double tension)
{
  this->Tension += tension;
  this->Q += tension * this->K;
}

void SmoothnessEnergy::MultiplyStiffness(const Values& u, Values& y) const
{
  y.resize(u.rows(), u.cols());
  ForEach(this->Parallel, static_cast<Index>(u.rows()),
    [&](Index i)
    {
      y.row(i).setZero();
      for (SparseMatrix::InnerIterator a(this->K, i); a; ++a)
      {
        y.row(i) += a.value() * (u.row(a.index()) - u.row(i));
      }
    });
}

void SmoothnessEnergy::Multiply(const Values& u, Values& y) const
{
  const Vector& areas = this->Mesh.ControlAreas();
  const double square = this->Kappa * this->Kappa;
  if (this->Rim == RimCondition::Natural)
  {
    Values second; // M^-1 (kappa^2 M + K) u
    this->MultiplyStiffness(u, second);
    second = (areas.cwiseInverse().asDiagonal() * second).eval() + square * u;
    this->MultiplyStiffness(second, y);
    y += square * (areas.asDiagonal() * second);
    if (this->Tension > 0.0)
    {
      this->MultiplyStiffness(u, second);
      y += this->Tension * second;
    }
    return;
  }
  // Constants have no gradient to the last bit: the entries of a row that belong to one triangle add
  // up to zero but for round-off, which acts on the differences alone.
  const Eigen::RowVectorXd origin = u.row(0);
  const Values differences = u.rowwise() - origin;
  Values stiff;
  this->MultiplyStiffness(u, stiff);
  y = this->Gradient.transpose() * (this->Second * (this->Gradient * differences)) +
    (2.0 * square + this->Tension) * stiff + square * square * (areas.asDiagonal() * u);
}

Vector SmoothnessEnergy::Squares(const Values& u) const
{
  Values product;
  this->Multiply(u, product);
  return u.cwiseProduct(product).colwise().sum();
}

} // namespace SurfaceDiffusion
