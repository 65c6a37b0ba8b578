// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Fields/ScaleFilter.h"

#include "Core/Operators/CotanWeights.h"

#include <cmath>
#include <utility>

namespace SurfaceDiffusion
{

namespace
{

/// With s = sqrt(2) / k^2 and y = 1 / (1 + s lambda), 1 / (1 + 2 lambda^2 / k^4) is y^2 over
/// 1 - 2 y + 2 y^2, whose poles (1 +- i) / 2 are as far from [0, 1] as they can be: a digit in
/// 2.6 solves.
constexpr int DegreeOfSecondOrder = 26;

/// Of the recurrence, which takes the time of the polynomial with so many.
constexpr double MostIterations = 500.0;

double SecondOrder(double y)
{
  return y * y / (1.0 - 2.0 * y + 2.0 * y * y);
}

} // namespace

std::vector<double> ScaleFilterSeries(int order)
{
  return order == 1 ? std::vector<double>{ 0.5, 0.5 }
                    : ChebyshevSeries(&SecondOrder, DegreeOfSecondOrder);
}

Vector ScaleFilterDiffusivities(
  const TriangleMesh& mesh, const Vector& wavelengths, int order, const ParallelFor& parallel)
{
  const double pi = std::acos(-1.0);
  const double factor = (order == 1 ? 2.0 : std::sqrt(2.0)) / (4.0 * pi * pi);
  Vector ofTriangles(mesh.NumberOfTriangles());
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const auto corners = mesh.TriangleVertices().row(t);
      const auto square = [&](int a)
      { return factor * wavelengths[corners[a]] * wavelengths[corners[a]]; };
      ofTriangles[t] = (square(0) + square(1) + square(2)) / 3.0;
    });
  return ofTriangles;
}

ScaleFilter::ScaleFilter(std::shared_ptr<const Assembler> assembler, const Vector& wavelengths,
  int order, const ParallelFor& parallel)
{
  const TriangleMesh& mesh = assembler->Mesh();
  const Vector diffusivities = ScaleFilterDiffusivities(mesh, wavelengths, order, parallel);
  CornerWeights coefficients = CotanWeights(mesh, parallel);
  ForEach(
    parallel, mesh.NumberOfTriangles(), [&](Index t) { coefficients.row(t) *= diffusivities[t]; });
  if (order == 2)
  {
    this->Square = std::make_unique<SquareResolvent>(assembler, coefficients, parallel);
    if (!(this->Square->ExpectedIterations() <= MostIterations))
    {
      this->Square.reset();
    }
  }
  const double largestStep = diffusivities.size() > 0 ? diffusivities.maxCoeff() : 1.0;
  this->MakePolynomial = [=, &parallel]
  {
    std::vector<double> series = ScaleFilterSeries(order);
    auto solver = MakeResolventSolver(assembler->Mesh(), largestStep, series, parallel);
    return std::make_unique<ResolventPolynomial>(
      assembler, coefficients, 1.0, std::move(series), std::move(solver), parallel);
  };
}

void ScaleFilter::Apply(Values& u, const ProgressMonitor& progress)
{
  if (this->Square && this->Square->Apply(u, progress))
  {
    return;
  }
  this->Square.reset();
  if (!this->Polynomial)
  {
    this->Polynomial = this->MakePolynomial();
    this->MakePolynomial = nullptr; // it keeps the coefficients
  }
  this->Polynomial->Apply(u, progress);
}

} // namespace SurfaceDiffusion
