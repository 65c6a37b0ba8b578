// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Models/LinearDiffusion.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/ExponentialSeries.h"
#include "Core/Solvers/LinearSolver.h"

#include <cmath>
#include <memory>
#include <utility>

namespace SurfaceDiffusion::Testing
{

using Scheme = LinearDiffusion::Scheme;

/// Settings whose time step and fidelity are in coordinate units, as the exact solutions are.
inline LinearDiffusion::Settings HeatSettings(
  const TriangleMesh& mesh, double timeStep, double fidelity = 0.0, Scheme scheme = Scheme::SDIRK2)
{
  const double square = mesh.LengthUnit() * mesh.LengthUnit();
  return { timeStep / square, fidelity * square, scheme };
}

/// Linear diffusion (1), (16), (18) of `data`.
inline std::unique_ptr<LinearDiffusion> MakeHeat(std::shared_ptr<const Assembler> assembler,
  PointData data, const LinearDiffusion::Settings& settings,
  std::shared_ptr<LinearSolver> solver = MakeCholeskySolver(),
  const ParallelFor& parallel = SerialFor())
{
  CornerWeights coefficients = CotanWeights(assembler->Mesh(), parallel);
  return std::make_unique<LinearDiffusion>(std::move(assembler), std::move(coefficients),
    std::move(data), settings, std::move(solver), parallel);
}

inline void Advance(Model& evolution, int steps)
{
  for (int step = 0; step < steps; ++step)
  {
    evolution.Advance(ProgressMonitor());
  }
}

/// The state after `steps` steps over the time `time` in all, in coordinate units.
inline Values Diffuse(std::shared_ptr<const Assembler> assembler, PointData data, double time,
  int steps, double fidelity = 0.0, Scheme scheme = Scheme::SDIRK2)
{
  const auto settings = HeatSettings(assembler->Mesh(), time / steps, fidelity, scheme);
  const auto heat = MakeHeat(std::move(assembler), std::move(data), settings);
  Advance(*heat, steps);
  return heat->State();
}

/// Conjugate gradients up to this tolerance, however many iterations it takes.
inline std::shared_ptr<LinearSolver> Iterative(
  double tolerance, const ParallelFor& parallel = SerialFor())
{
  std::shared_ptr<LinearSolver> solver = MakeConjugateGradientSolver(parallel);
  solver->SetLimits({ tolerance, 100000 });
  return solver;
}

/// p(1/(1 + s z)) of ExponentialSeries.
inline double SeriesAt(double z)
{
  const double y = 1.0 / (1.0 + ExponentialSeries::Step * z);
  double sum = 0.0;
  for (int k = 0; k <= ExponentialSeries::Degree; ++k)
  {
    // Continued beyond [-1, 1], for derivatives at z = 0.
    const double w = 2.0 * y - 1.0;
    const double term = w <= 1.0 ? std::cos(k * std::acos(w)) : std::cosh(k * std::acosh(w));
    sum += ExponentialSeries::Coefficients[static_cast<std::size_t>(k)] * term;
  }
  return sum;
}

} // namespace SurfaceDiffusion::Testing
