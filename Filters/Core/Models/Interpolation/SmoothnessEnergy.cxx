// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/SmoothnessEnergy.h"

#include "Core/Models/Interpolation/HessianEnergy.h"
#include "Core/Models/Interpolation/ResolvedShare.h"
#include "Core/Models/Interpolation/SparseSquare.h"
#include "Core/Operators/CotanWeights.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The coefficients, with those of needles reduced to the size of ResolvedShare().
CornerWeights Resolved(const TriangleMesh& mesh, CornerWeights coefficients)
{
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    coefficients.row(t) *= ResolvedShare(mesh.Shapes()[t]);
  }
  return coefficients;
}

RimCondition RimOf(const TriangleMesh& mesh, RimCondition rim)
{
  if (rim != RimCondition::Automatic)
  {
    return rim;
  }
  const bool isFree =
    !mesh.BoundaryVertices().empty() && HessianEnergy::TooManyTriangles(mesh, 0.0) == 0;
  return isFree ? RimCondition::Free : RimCondition::Natural;
}

} // namespace

SmoothnessEnergy::SmoothnessEnergy(const Assembler& assembler, const CornerWeights& coefficients,
  double kappa, RimCondition rim, const ParallelFor& parallel)
  : Mesh(assembler.Mesh())
  , Parallel(parallel)
  , Kappa(kappa)
  , Rim(RimOf(assembler.Mesh(), rim))
{
  const Vector& areas = this->Mesh.ControlAreas();
  const Vector none = Vector::Zero(areas.size());
  const double square = kappa * kappa;
  const CornerWeights resolved =
    Resolved(this->Mesh, this->IsFree() ? CotanWeights(this->Mesh, parallel) : coefficients);
  assembler.TakePattern(this->K, parallel);
  SparseMatrix first = this->K;
  assembler.Fill(this->K, none, 1.0, resolved, nullptr, parallel);
  if (!this->IsFree())
  {
    assembler.Fill(first, square * areas, 1.0, resolved, nullptr, parallel);
    this->Q = SparseSquare(first, areas, square);
    return;
  }
  constexpr double most = 3e7; // entries, of 32 bytes with those of the system and its factor
  if (const Index many = HessianEnergy::TooManyTriangles(this->Mesh, most))
  {
    throw std::runtime_error("an edge of the surface has " + std::to_string(many) +
      " triangles; allowed with a free boundary: about 5000 (take the natural one, or remesh the "
      "surface there)");
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
  // No function bends in triangles that share no edge with others: what their vertices have is round-off.
  const Vector least = 1e-12 * this->Sizes();
  const Flags isOpen = this->Q.diagonal().array() <= least.array();
  for (Index j = 0; j < static_cast<Index>(isOpen.size()); ++j)
  {
    for (SparseMatrix::InnerIterator a(this->Q, j); a; ++a)
    {
      a.valueRef() = isOpen[j] || isOpen[a.index()] ? 0.0 : a.value();
    }
  }
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
  SparseMatrix stiffness = this->K;
  stiffness.conservativeResize(this->Q.rows(), this->Q.cols());
  this->Q += tension * stiffness;
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
  if (!this->IsFree())
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
  Vector squares = u.cwiseProduct(product).colwise().sum();
  if (this->Tension > 0.0)
  {
    this->MultiplyStiffness(u, product);
    squares -= this->Tension * u.cwiseProduct(product).colwise().sum().transpose();
  }
  return squares;
}

} // namespace SurfaceDiffusion
