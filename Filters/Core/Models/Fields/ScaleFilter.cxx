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

double SecondOrder(double y)
{
  return y * y / (1.0 - 2.0 * y + 2.0 * y * y);
}

} // namespace

ResolventPolynomial MakeScaleFilter(std::shared_ptr<const Assembler> assembler,
  const Vector& wavelengths, int order, const ParallelFor& parallel)
{
  const TriangleMesh& mesh = assembler->Mesh();
  const double pi = std::acos(-1.0);
  const double factor = (order == 1 ? 2.0 : std::sqrt(2.0)) / (4.0 * pi * pi);
  const Vector squares = factor * wavelengths.cwiseAbs2();
  CornerWeights coefficients = CotanWeights(mesh, parallel);
  ForEach(parallel, mesh.NumberOfTriangles(),
    [&](Index t)
    {
      const auto corners = mesh.TriangleVertices().row(t);
      coefficients.row(t) *=
        (squares[corners[0]] + squares[corners[1]] + squares[corners[2]]) / 3.0;
    });
  std::vector<double> series = order == 1 ? std::vector<double>{ 0.5, 0.5 }
                                          : ChebyshevSeries(&SecondOrder, DegreeOfSecondOrder);
  const double largestStep = squares.size() > 0 ? squares.maxCoeff() : 1.0;
  auto solver = MakeResolventSolver(mesh, largestStep, series, parallel);
  return { std::move(assembler), coefficients, 1.0, std::move(series), std::move(solver),
    parallel };
}

} // namespace SurfaceDiffusion
