// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Distances from a vertex of a sphere with bumps, with 10,000, 41,000 and 164,000 vertices: exact by
// windows, whose number grows with the power 1.5 of that of triangles, and by fast marching.

#include "Core/Geodesics/ExactDistance.h"
#include "Meshes.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

std::shared_ptr<const TriangleMesh> SphereWithBumps(benchmark::State& state)
{
  Surface s = Icosphere(static_cast<int>(state.range(0)));
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d x = s.Vertices.row(i);
    s.Vertices.row(i) *=
      1.0 + 0.15 * std::sin(6.5 * x[0]) * std::sin(6.0 * x[1] + 1.0) * std::cos(4.0 * x[2]);
  }
  state.counters["vertices"] = static_cast<double>(s.NumberOfVertices());
  return std::make_shared<TriangleMesh>(s.Vertices, s.Faces);
}

void FindExactDistances(benchmark::State& state)
{
  const auto mesh = SphereWithBumps(state);
  SourcePiece source;
  source.From = source.To = { 1.0, 0.0, 0.0 };
  for (auto _ : state)
  {
    const ExactDistance exact(mesh);
    benchmark::DoNotOptimize(
      exact.Find({ source }, std::numeric_limits<double>::infinity()).Times.data());
  }
}

void MarchDistances(benchmark::State& state)
{
  const auto mesh = SphereWithBumps(state);
  for (auto _ : state)
  {
    const GeodesicDistance fronts(mesh);
    benchmark::DoNotOptimize(
      fronts.Find({ FrontSource() }, std::numeric_limits<double>::infinity()).Times.data());
  }
}

BENCHMARK(FindExactDistances)->DenseRange(5, 7)->Unit(benchmark::kMillisecond);
BENCHMARK(MarchDistances)->DenseRange(5, 7)->Unit(benchmark::kMillisecond);

} // namespace
