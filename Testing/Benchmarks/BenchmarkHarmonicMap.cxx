// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Ten steps of harmonic map flow from noisy normals (about 14 degrees), on icospheres of
// 10 4^s + 2 vertices, for both exponents of the paper and each scheme. The counters are the mean
// angle to the clean normals before and after, the iterations, and the remaining energy. Another
// benchmark measures vertex updating from normals.

#include "HarmonicMaps.h"
#include "Meshes.h"

#include "Core/Geometry/VertexUpdating.h"

#include <benchmark/benchmark.h>

#include <cmath>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

struct NoisyNormals
{
  Surface Sphere;
  std::shared_ptr<const Assembler> Operators;
  Values Clean, Noisy;

  explicit NoisyNormals(int subdivisions)
    : Sphere(Icosphere(subdivisions))
    , Operators(MakeAssembler(this->Sphere))
    , Clean(SampleUnit(
        this->Operators->Mesh(), this->Sphere, 3, [](const Eigen::RowVector3d& x) { return x; }))
    , Noisy(this->Clean + 0.35 * Noise(this->Operators->Mesh(), 3))
  {
    this->Noisy.rowwise().normalize();
  }

  double MeanAngle(const Values& u) const
  {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < u.rows(); ++i)
    {
      sum += std::acos(std::min(1.0, u.row(i).dot(this->Clean.row(i))));
    }
    return sum / static_cast<double>(u.rows()) * 180.0 / Pi;
  }
};

/// Arguments: subdivisions, exponent, scheme.
void TenSteps(benchmark::State& state)
{
  const NoisyNormals normals(static_cast<int>(state.range(0)));
  const TriangleMesh& mesh = normals.Operators->Mesh();
  const double h = MeanEdge(mesh);
  HarmonicMap::Settings settings;
  settings.Exponent = static_cast<double>(state.range(1));
  settings.TimeStep = 0.03 * std::pow(h, settings.Exponent);
  settings.Beta = 1e-6 / (h * h);
  settings.TimeScheme = static_cast<MapScheme>(state.range(2));
  const bool explicitReaction = settings.TimeScheme == MapScheme::ExplicitReaction;
  for (auto _ : state)
  {
    const auto map = MakeMap(normals.Operators, PointData::FromValues(normals.Noisy), settings,
      explicitReaction ? MakeConjugateGradientSolver() : MakeCholeskySolver());
    const double energy = map->Energy();
    int iterations = 0;
    for (int step = 0; step < 10; ++step)
    {
      iterations += map->Advance(ProgressMonitor()).Iterations;
    }
    state.counters["iterations"] = iterations;
    state.counters["degrees_before"] = normals.MeanAngle(normals.Noisy);
    state.counters["degrees_after"] = normals.MeanAngle(map->State());
    state.counters["energy_left"] = map->Energy() / energy;
  }
}

void FitVertices(benchmark::State& state)
{
  const NoisyNormals normals(static_cast<int>(state.range(0)));
  const TriangleMesh& mesh = normals.Operators->Mesh();
  Points noisy = normals.Sphere.Vertices;
  const double h = MeanEdge(mesh) * mesh.LengthUnit();
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      noisy(i, k) += 0.2 * h * (2.0 * UniformRandom(5, k, i) - 1.0);
    }
  }
  for (auto _ : state)
  {
    VertexMotion motion;
    benchmark::DoNotOptimize(
      UpdateVerticesFromNormals(mesh, noisy, normals.Clean, 5.0 * h, motion).data());
    state.counters["volume_after"] = motion.VolumeAfter / (4.0 / 3.0 * Pi);
  }
}

} // namespace

BENCHMARK(TenSteps)
  ->ArgsProduct({ { 5, 6 }, { 1, 2 }, { 0, 1, 2 } })
  ->Unit(benchmark::kMillisecond);
BENCHMARK(FitVertices)->Arg(5)->Arg(6)->Unit(benchmark::kMillisecond);
