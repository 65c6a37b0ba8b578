// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The cost of a smooth function through values at random vertices of icospheres of 10 4^s + 2
// vertices, with all that it needs but the mesh and the pattern: with exact values, a given mu, and
// mu by generalised cross-validation, the last with standard errors, too.

#include "Meshes.h"

#include "Core/Foundation/Random.h"
#include "Core/Models/Interpolation/SmoothInterpolation.h"
#include "Core/Operators/CotanWeights.h"

#include <benchmark/benchmark.h>

#include <memory>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Arguments: subdivisions, number of values, the choice of mu, and whether errors are computed.
void Interpolate(benchmark::State& state)
{
  const Surface sphere = Icosphere(static_cast<int>(state.range(0)));
  const auto assembler = std::make_shared<const Assembler>(
    std::make_shared<TriangleMesh>(sphere.Vertices, sphere.Faces));
  const TriangleMesh& mesh = assembler->Mesh();
  const double share =
    static_cast<double>(state.range(1)) / static_cast<double>(mesh.NumberOfVertices());
  Flags known(mesh.NumberOfVertices());
  Values f(mesh.NumberOfVertices(), 1);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const double z = sphere.Vertices(mesh.InputVertex()[i], 2);
    known[i] = UniformRandom(1, 0, i) < share;
    f(i, 0) = z * z + 0.1 * (UniformRandom(1, 1, i) - 0.5);
  }
  const ScatteredValues data = ScatteredValues::AtVertices(f, known);
  SmoothInterpolation::Settings settings;
  settings.Smoothing = static_cast<SmoothInterpolation::Choice>(state.range(2));
  settings.Mu = 1.0;
  settings.ComputeError = state.range(3) != 0;
  for (auto _ : state)
  {
    const SmoothInterpolation method(assembler, CotanWeights(mesh), settings);
    benchmark::DoNotOptimize(method.Fit(data).U.sum());
  }
}

constexpr auto Exact = static_cast<int>(SmoothInterpolation::Choice::Exact);
constexpr auto Automatic = static_cast<int>(SmoothInterpolation::Choice::Automatic);
constexpr auto Given = static_cast<int>(SmoothInterpolation::Choice::Given);

} // namespace

BENCHMARK(Interpolate)
  ->Args({ 6, 200, Exact, 0 })
  ->Args({ 6, 200, Given, 0 })
  ->Args({ 6, 200, Automatic, 0 })
  ->Args({ 6, 200, Automatic, 1 })
  ->Args({ 6, 10000, Automatic, 0 })
  ->Unit(benchmark::kMillisecond);
