// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/GradientSplitting.h"

#include "Core/Models/TotalVariation/PenaltyRanges.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

GradientSplitting::GradientSplitting(std::shared_ptr<const TriangleMesh> mesh,
  std::shared_ptr<const GradientMaps> gradients, const EdgeFunction& function,
  ChannelCoupling coupling, const Vector& ranges, double unknowns, const ParallelFor& parallel)
  : Mesh(std::move(mesh))
  , Gradients(std::move(gradients))
  , Function(function)
  , Coupling(coupling)
  , Parallel(parallel)
  , Penalty(
      PenaltiesOfTriangles(*this->Mesh, *this->Gradients, function, ranges, unknowns, parallel))
  , Scales(Vector::Ones(this->Mesh->NumberOfTriangles()))
  , Single(function, coupling, parallel)
  , Double(function, coupling, parallel)
{
}

CornerWeights GradientSplitting::MakeCoefficients() const
{
  CornerWeights coefficients(this->Mesh->NumberOfTriangles(), 3);
  ForEach(this->Parallel, this->Mesh->NumberOfTriangles(),
    [&](Index t)
    {
      const GradientMap map = (*this->Gradients)[t];
      for (int a = 0; a < 3; ++a)
      {
        coefficients(t, a) =
          -this->Penalty[t] * map.OfCorner((a + 1) % 3).dot(map.OfCorner((a + 2) % 3));
      }
    });
  return coefficients;
}

/// S grad u of column k on triangle t.
Eigen::Vector2d GradientSplitting::GradientOf(const Values& u, Index t, Eigen::Index k) const
{
  const Triangles& corners = this->Mesh->TriangleVertices();
  const GradientMap map = (*this->Gradients)[t];
  const double u0 = u(corners(t, 0), k);
  return (u(corners(t, 1), k) - u0) * map.First + (u(corners(t, 2), k) - u0) * map.Second;
}

double GradientSplitting::Stiffness() const
{
  return this->Mesh->GetReduction().Sum(Sum(this->Parallel, this->Mesh->NumberOfTriangles(),
    [&](Index t) { return this->Penalty[t] * SquaredSteepest((*this->Gradients)[t]); }));
}

void GradientSplitting::Start(int columns, bool keepMultipliers, bool inSinglePrecision)
{
  if (this->CanBalance())
  {
    this->Visit(
      [this](auto& splitting)
      {
        if (splitting.HasMesh())
        {
          splitting.Unbalance(this->Scales);
        }
      });
  }
  const bool isSingle = inSinglePrecision && this->CanBeSingle();
  if (keepMultipliers && isSingle != this->IsSingle && this->Kept.empty())
  {
    this->KeptColumns = this->NumberOfColumns();
    std::vector<double> multipliers(this->NumberOfMultipliers(this->KeptColumns));
    this->GetMultipliers(multipliers.data());
    this->Kept.swap(multipliers);
  }
  const bool startsFromKept = keepMultipliers && !this->Kept.empty();
  this->IsSingle = isSingle;
  this->Visit(
    [&](auto& splitting)
    {
      if (!splitting.HasMesh())
      {
        splitting.SetMesh(*this->Mesh, *this->Gradients, this->Penalty);
      }
      splitting.Start(columns, keepMultipliers && !startsFromKept);
      if (startsFromKept && this->KeptColumns == columns)
      {
        splitting.SetMultipliers(this->Kept.data());
      }
    });
  this->Kept = std::vector<double>();
}

/// Only for total variation, whose multipliers are at most 1 for data in any unit.
bool GradientSplitting::CanBeSingle()
{
  if (this->Function.Kind != EdgeFunctionKind::TotalVariation)
  {
    return false;
  }
  if (!this->Single.HasMesh())
  {
    this->Single.SetMesh(*this->Mesh, *this->Gradients, this->Penalty);
  }
  return this->Single.IsInRange();
}

void GradientSplitting::GetMultipliers(double* multipliers) const
{
  if (!this->Kept.empty())
  {
    std::copy(this->Kept.begin(), this->Kept.end(), multipliers);
    return;
  }
  if (this->NumberOfColumns() > 0)
  {
    this->Visit([multipliers](const auto& splitting) { splitting.GetMultipliers(multipliers); });
  }
}

void GradientSplitting::SetMultipliers(const double* multipliers, int columns)
{
  this->KeptColumns = columns;
  this->Kept.assign(multipliers, multipliers + this->NumberOfMultipliers(columns));
}

void GradientSplitting::GatherMultipliers(Values& divergence)
{
  this->Visit(
    [&](auto& splitting)
    {
      splitting.SpreadMultipliers();
      ForEach(this->Parallel, this->Mesh->NumberOfVertices(),
        [&](Index i) { splitting.template Gather<0>(i, &divergence(i, 0)); });
    });
}

double GradientSplitting::Energy(const Values& u) const
{
  return Sum(this->Parallel, this->Mesh->NumberOfTriangles(),
    [&](Index t)
    {
      double density = 0.0;
      ForEachNorm(this->Coupling, static_cast<int>(u.cols()),
        [&](int first, int last)
        {
          double squared = 0.0;
          for (int k = first; k < last; ++k)
          {
            squared += this->GradientOf(u, t, k).squaredNorm();
          }
          density += this->Function.Potential(squared);
        });
      return this->Mesh->Shapes()[t].Area() * density;
    });
}

} // namespace SurfaceDiffusion
