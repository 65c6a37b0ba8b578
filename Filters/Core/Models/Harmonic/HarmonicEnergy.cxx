// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Harmonic/HarmonicEnergy.h"

#include "Core/Foundation/Columns.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

HarmonicEnergy::HarmonicEnergy(std::shared_ptr<const TriangleMesh> mesh, CornerWeights coefficients,
  const Settings& settings, const ParallelFor& parallel)
  : Mesh(std::move(mesh))
  , Coefficients(std::move(coefficients))
  , Options(settings)
  , Parallel(parallel)
  , Weights(this->Coefficients.rows())
  , Squares(this->Coefficients.rows())
{
  if (settings.LineField)
  {
    this->Signs.resize(this->Coefficients.rows(), 3);
  }
}

double HarmonicEnergy::operator()(const Values& u) const
{
  return ForColumns(u.cols(),
    [&](auto k)
    {
      return this->Options.LargestDiffusivity *
        Sum(this->Parallel, this->Mesh->NumberOfTriangles(),
          [&](Index t)
          {
            const double square = this->GradientSquare<decltype(k)::value>(u, t, nullptr);
            return this->Mesh->Shapes()[t].Area() * this->Density(square);
          });
    });
}

double HarmonicEnergy::Evaluate(const Values& u)
{
  return ForColumns(u.cols(),
    [&](auto k)
    {
      return this->Options.LargestDiffusivity *
        Sum(this->Parallel, this->Mesh->NumberOfTriangles(),
          [&](Index t)
          {
            double signs[3];
            this->Squares[t] = this->GradientSquare<decltype(k)::value>(u, t, signs);
            this->Weights[t] = this->Diffusivity(this->Squares[t]);
            if (this->Options.LineField)
            {
              this->Signs.row(t) << signs[0], signs[1], signs[2];
            }
            return this->Mesh->Shapes()[t].Area() * this->Density(this->Squares[t]);
          });
    });
}

/// |grad u|^2 on a triangle, from c_ij = -area grad(phi_i) . D grad(phi_j): the sum over its edges
/// of c_ij |u_i - u_j|^2 is area grad u . D grad u. For line fields also the signs that make it
/// smallest, unless `signs` is null. u has K columns, or any number of them if K is 0.
template <int K>
double HarmonicEnergy::GradientSquare(const Values& u, Index t, double* signs) const
{
  const auto c = this->Coefficients.row(t);
  const auto v = this->Mesh->TriangleVertices().row(t);
  const ColumnCount<K> columns(u.cols());
  const auto term = [&](int edge, double sign)
  {
    const double* a = u.data() + static_cast<std::ptrdiff_t>(v[(edge + 1) % 3]) * columns;
    const double* b = u.data() + static_cast<std::ptrdiff_t>(v[(edge + 2) % 3]) * columns;
    double square = 0.0;
    for (int k = 0; k < columns; ++k)
    {
      const double difference = a[k] - sign * b[k];
      square += difference * difference;
    }
    return c[edge] * square;
  };
  double smallest = 0.0;
  if (!this->Options.LineField)
  {
    smallest = term(0, 1.0) + term(1, 1.0) + term(2, 1.0);
  }
  else
  {
    const double same[3] = { term(0, 1.0), term(1, 1.0), term(2, 1.0) };
    const double opposite[3] = { term(0, -1.0), term(1, -1.0), term(2, -1.0) };
    smallest = same[0] + same[1] + same[2];
    int flipped = -1;
    for (int corner = 0; corner < 3; ++corner) // the two edges at this corner change
    {
      const int next = (corner + 1) % 3, last = (corner + 2) % 3;
      const double sum = same[corner] + opposite[next] + opposite[last];
      if (sum < smallest)
      {
        smallest = sum;
        flipped = corner;
      }
    }
    for (int edge = 0; signs && edge < 3; ++edge)
    {
      signs[edge] = flipped < 0 || edge == flipped ? 1.0 : -1.0;
    }
  }
  const double square =
    smallest / (this->Mesh->Shapes()[t].Area() * this->Options.LargestDiffusivity);
  return std::max(square, 0.0); // round-off on slivers
}

double HarmonicEnergy::Diffusivity(double square) const
{
  const double p = this->Options.Exponent;
  if (p == 2.0)
  {
    return 1.0;
  }
  const double s = square + this->Options.Beta;
  return p == 1.0 ? 1.0 / std::sqrt(s) : std::pow(s, 0.5 * (p - 2.0));
}

/// ((s + beta)^(p/2) - beta^(p/2)) / p, free of cancellation for small s.
double HarmonicEnergy::Density(double square) const
{
  const double p = this->Options.Exponent;
  const double beta = this->Options.Beta;
  if (p == 2.0)
  {
    return 0.5 * square;
  }
  if (p == 1.0)
  {
    return square / (std::sqrt(square + beta) + std::sqrt(beta));
  }
  return std::pow(beta, 0.5 * p) * std::expm1(0.5 * p * std::log1p(square / beta)) / p;
}

} // namespace SurfaceDiffusion
