// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/TotalVariation/GradientSplitting.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// The penalty on S grad u - p, in units of g at the steepest gradient of one range on the
/// triangle: small triangles and slivers then have no larger share in the equations than others. It
/// shifts work between finding edges and settling values and changes no result. Measured with the
/// factor sqrt(triangles per unknown) on meshes and medial meshes: 14 to 28 is best for noise to a
/// gap of 1e-3, 28 to 50 to 1e-5, the more so the more vertices.
constexpr double PenaltyFactor = 28.0;

/// No penalty suits both directions of a needle. That of the steepest gradient, which is across it,
/// is too small along it, where a multiplier then needs thousands of iterations to become 1. On
/// triangles where the square of this gradient is more than this many times that of the geometric
/// mean of both directions, the penalty is that of the mean. Measured on segmentations of fans of
/// 20,000 triangles: with SquaredWidths() of vertices, a tenth of the iterations.
constexpr double LargestRatio = 16.0;

/// The largest |S grad phi|^2 of the basis functions.
double SquaredSteepest(const GradientMap& map)
{
  return std::max({ map.OfCorner(0).squaredNorm(), map.OfCorner(1).squaredNorm(),
    map.OfCorner(2).squaredNorm() });
}

/// That of the penalty. plain: without S, lest strong directions count as needles. It stands for S where
/// this is 0, in triangles without a direction.
double SquaredTypical(const GradientMap& map, const GradientMap& plain)
{
  const double area = std::abs(plain.First[0] * plain.Second[1] - plain.First[1] * plain.Second[0]);
  const double mean = 2.0 / std::sqrt(3.0) * area; // that of equilateral triangles
  const double ofTriangle = SquaredSteepest(plain);
  const double share = ofTriangle > LargestRatio * mean ? mean / ofTriangle : 1.0;
  const double steepest = SquaredSteepest(map);
  return (steepest > 0.0 ? steepest : ofTriangle) * share;
}

} // namespace

GradientSplitting::GradientSplitting(std::shared_ptr<const TriangleMesh> mesh,
  std::shared_ptr<const GradientMaps> gradients, const EdgeFunction& function,
  ChannelCoupling coupling, const Vector& ranges, double unknowns, const ParallelFor& parallel)
  : Mesh(std::move(mesh))
  , Gradients(std::move(gradients))
  , Function(function)
  , Coupling(coupling)
  , Parallel(parallel)
  , Penalty(this->Mesh->NumberOfTriangles())
  , Scales(Vector::Ones(this->Mesh->NumberOfTriangles()))
  , Single(function, coupling, parallel)
  , Double(function, coupling, parallel)
{
  const double triangles = this->Mesh->GetReduction().Sum(this->Mesh->NumberOfTriangles());
  const double perUnknown = std::sqrt(triangles / unknowns);
  ForEach(parallel, this->Mesh->NumberOfTriangles(),
    [&](Index t)
    {
      const TriangleMesh::Shape s = this->Mesh->Shapes()[t];
      const double square = SquaredTypical((*this->Gradients)[t], PlainGradientMap(s));
      const double g = function(ranges[t] * ranges[t] * square);
      this->Penalty[t] = PenaltyFactor * perUnknown * g * s.Area();
    });
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
