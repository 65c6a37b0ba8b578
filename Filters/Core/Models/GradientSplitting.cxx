// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/GradientSplitting.h"

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

/// The largest |S grad phi|^2 of the basis functions.
double SquaredSteepest(const GradientMap& map)
{
  return std::max({ map.OfCorner(0).squaredNorm(), map.OfCorner(1).squaredNorm(),
    map.OfCorner(2).squaredNorm() });
}

} // namespace

GradientSplitting::GradientSplitting(std::shared_ptr<const TriangleMesh> mesh,
  std::shared_ptr<const std::vector<GradientMap>> gradients, const EdgeFunction& function,
  ChannelCoupling coupling, const Vector& ranges, double unknowns, const ParallelFor& parallel)
  : Mesh(std::move(mesh))
  , Gradients(std::move(gradients))
  , Function(function)
  , Coupling(coupling)
  , Parallel(parallel)
  , Penalty(this->Mesh->NumberOfTriangles())
{
  const double triangles = this->Mesh->GetReduction().Sum(this->Mesh->NumberOfTriangles());
  const double perUnknown = std::sqrt(triangles / unknowns);
  ForEach(parallel, this->Mesh->NumberOfTriangles(),
    [&](Index t)
    {
      const double g = function(ranges[t] * ranges[t] * SquaredSteepest((*this->Gradients)[t]));
      this->Penalty[t] = PenaltyFactor * perUnknown * g * this->Mesh->Shapes()[t].Area();
    });
}

CornerWeights GradientSplitting::MakeCoefficients() const
{
  CornerWeights coefficients(this->Mesh->NumberOfTriangles(), 3);
  ForEach(this->Parallel, this->Mesh->NumberOfTriangles(),
    [&](Index t)
    {
      const GradientMap& map = (*this->Gradients)[t];
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
  const GradientMap& map = (*this->Gradients)[t];
  const double u0 = u(corners(t, 0), k);
  return (u(corners(t, 1), k) - u0) * map.First + (u(corners(t, 2), k) - u0) * map.Second;
}

double GradientSplitting::Stiffness() const
{
  return this->Mesh->GetReduction().Sum(Sum(this->Parallel, this->Mesh->NumberOfTriangles(),
    [&](Index t) { return this->Penalty[t] * SquaredSteepest((*this->Gradients)[t]); }));
}

void GradientSplitting::SetGrowth(double growth)
{
  if (growth != this->PenaltyGrowth)
  {
    const double factor = this->PenaltyGrowth / growth;
    ForEach(this->Parallel, static_cast<Index>(this->B.rows()),
      [&](Index t) { this->B.row(t) *= factor; });
    this->PenaltyGrowth = growth;
  }
}

void GradientSplitting::Start(const Values& u, bool keepMultipliers)
{
  const Eigen::Index triangles = this->Mesh->NumberOfTriangles();
  this->PenaltyGrowth = 1.0; // an abort may have left another
  this->P.resize(triangles, 2 * u.cols());
  if (!keepMultipliers || this->B.cols() != 2 * u.cols())
  {
    this->B.setZero(triangles, 2 * u.cols());
  }
  this->Corners.resize(3 * triangles, u.cols());
  ForEach(this->Parallel, this->Mesh->NumberOfTriangles(),
    [&](Index t)
    {
      for (Eigen::Index k = 0; k < u.cols(); ++k)
      {
        const Eigen::Vector2d gradient = this->GradientOf(u, t, k);
        this->P(t, 2 * k) = gradient[0];
        this->P(t, 2 * k + 1) = gradient[1];
      }
    });
}

void GradientSplitting::Update(const Values& u, double relaxation)
{
  ForColumns(u.cols(), [&](auto columns) { this->UpdateColumns<columns()>(u, relaxation); });
}

template <int K>
void GradientSplitting::UpdateColumns(const Values& values, double relaxation)
{
  const EdgeFunction& function = this->Function;
  const Index* vertices = this->Mesh->TriangleVertices().data();
  const double* u = values.data();
  ForEach(this->Parallel, this->Mesh->NumberOfTriangles(),
    [&](Index t)
    {
      const ColumnCount<K> count(values.cols());
      const GradientMap map = (*this->Gradients)[t];
      const double* u0 = u + static_cast<std::ptrdiff_t>(vertices[3 * t]) * count;
      const double* u1 = u + static_cast<std::ptrdiff_t>(vertices[3 * t + 1]) * count;
      const double* u2 = u + static_cast<std::ptrdiff_t>(vertices[3 * t + 2]) * count;
      double* p = &this->P(t, 0);
      double* b = &this->B(t, 0);
      for (int k = 0; k < count; ++k)
      {
        const Eigen::Vector2d gradient =
          (relaxation * (u1[k] - u0[k])) * map.First + (relaxation * (u2[k] - u0[k])) * map.Second;
        b[2 * k] += gradient[0] + (1.0 - relaxation) * p[2 * k];
        b[2 * k + 1] += gradient[1] + (1.0 - relaxation) * p[2 * k + 1];
      }
      const double scale = this->PenaltyGrowth * this->Penalty[t];
      const double r = scale / this->Mesh->Shapes()[t].Area();
      ForEachNorm(this->Coupling, count,
        [&](int first, int last)
        {
          double squared = 0.0;
          for (int c = 2 * first; c < 2 * last; ++c)
          {
            squared += b[c] * b[c];
          }
          const double factor = function.Shrinkage(r, std::sqrt(squared));
          for (int c = 2 * first; c < 2 * last; ++c)
          {
            p[c] = factor * b[c];
            b[c] -= p[c];
          }
        });
      double* corner = &this->Corners(3 * t, 0);
      for (int k = 0; k < count; ++k)
      {
        const double x = scale * (p[2 * k] - b[2 * k]);
        const double y = scale * (p[2 * k + 1] - b[2 * k + 1]);
        const double first = map.First[0] * x + map.First[1] * y;
        const double second = map.Second[0] * x + map.Second[1] * y;
        corner[k] = -first - second;
        corner[count + k] = first;
        corner[2 * count + k] = second;
      }
    });
}

void GradientSplitting::GatherMultipliers(Values& divergence) const
{
  const auto& begin = this->Mesh->VertexCornersBegin();
  const auto& corners = this->Mesh->VertexCorners();
  const Eigen::Index columns = divergence.cols();
  const double growth = this->PenaltyGrowth;
  ForEach(this->Parallel, this->Mesh->NumberOfVertices(),
    [&](Index i)
    {
      double* d = &divergence(i, 0);
      std::fill(d, d + columns, 0.0);
      for (Index c = begin[i]; c < begin[i + 1]; ++c)
      {
        const Index t = corners[c] / 3;
        const Eigen::Vector2d v =
          growth * this->Penalty[t] * (*this->Gradients)[t].OfCorner(corners[c] % 3);
        const double* b = &this->B(t, 0);
        for (Eigen::Index k = 0; k < columns; ++k)
        {
          d[k] += v[0] * b[2 * k] + v[1] * b[2 * k + 1];
        }
      }
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

double GradientSplitting::ConjugateEnergy() const
{
  return Sum(this->Parallel, this->Mesh->NumberOfTriangles(),
    [&](Index t)
    {
      const double area = this->Mesh->Shapes()[t].Area();
      const double r = this->PenaltyGrowth * this->Penalty[t] / area;
      double density = 0.0;
      ForEachNorm(this->Coupling, static_cast<int>(this->Corners.cols()),
        [&](int first, int last)
        {
          const double squared =
            this->B.row(t).segment(2 * first, 2 * (last - first)).squaredNorm();
          density += this->Function.Conjugate(r * r * squared);
        });
      return area * density;
    });
}

} // namespace SurfaceDiffusion
