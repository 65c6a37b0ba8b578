// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// MeasureSerialShare [<level>] measures which part of each stage no number of threads makes faster
// (Amdahl's law). It runs the stages on one thread, on the surface of SurfaceOfLevel(), by default
// level 3 (711,420 vertices), and prints a line of JSON per stage: CPU milliseconds, and the share
// of them that is outside of parallel loops. Loops over few long tasks count with the longest task.

#include "HarmonicMaps.h"
#include "HeatSystem.h"
#include "ProcessTime.h"

#include "Core/Geometry/SurfaceDenoising.h"
#include "Core/Models/TotalVariation/TotalVariationFlow.h"
#include "Core/Solvers/SolverChoice.h"
#include "Core/Surface/IntrinsicDelaunay.h"

#include <cstdio>
#include <cstdlib>
#include <functional>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Runs loops on one thread and sums the time that more threads would save. Loops inside of loops
/// count as parts of the outer ones.
class WatchedFor : public ParallelFor
{
public:
  void Run(Index count, LoopBody body) const override
  {
    const Level level(*this);
    const double start = Now();
    body(0, count);
    this->Add(Now() - start);
  }

  void RunTasks(Index count, LoopBody body) const override
  {
    const Level level(*this);
    double longest = 0.0;
    double sum = 0.0;
    for (Index task = 0; task < count; ++task)
    {
      const double start = Now();
      body(task, task + 1);
      const double seconds = Now() - start;
      longest = std::max(longest, seconds);
      sum += seconds;
    }
    this->Add(sum - longest);
  }

  /// Seconds that infinitely many threads would save, since the last call.
  double TakeSaved()
  {
    const double saved = this->Saved;
    this->Saved = 0.0;
    return saved;
  }

private:
  struct Level
  {
    explicit Level(const WatchedFor& loops)
      : Loops(loops)
    {
      ++loops.Depth;
    }
    ~Level() { --this->Loops.Depth; }
    const WatchedFor& Loops;
  };

  void Add(double seconds) const { this->Saved += this->Depth == 1 ? seconds : 0.0; }

  mutable int Depth = 0;
  mutable double Saved = 0.0;
};

void Measure(
  const char* name, double vertices, WatchedFor& loops, const std::function<void()>& stage)
{
  loops.TakeSaved();
  const double start = Now();
  stage();
  const double seconds = Now() - start;
  std::printf("{\"vertices\": %.0f, \"stage\": \"%s\", \"ms\": %.4g, \"serial\": %.4f}\n", vertices,
    name, 1e3 * seconds, 1.0 - loops.TakeSaved() / seconds);
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv)
{
  const Surface& surface = SurfaceOfLevel(argc > 1 ? std::atoi(argv[1]) : 3);
  const double n = surface.NumberOfVertices();
  WatchedFor loops;
  std::shared_ptr<const TriangleMesh> mesh;
  std::shared_ptr<const Assembler> operators;
  CornerWeights weights;
  SparseMatrix matrix;
  const auto measure = [&](const char* name, const std::function<void()>& stage)
  { Measure(name, n, loops, stage); };

  measure(
    "mesh", [&] { mesh = std::make_shared<TriangleMesh>(surface.Vertices, surface.Faces, loops); });
  measure("intrinsic Delaunay triangulation", [&] { IntrinsicDelaunay(mesh, loops); });
  measure("pattern", [&] { operators = std::make_shared<Assembler>(mesh, loops); });
  measure("cotan weights", [&] { weights = CotanWeights(*mesh, loops); });
  const double h = mesh->TotalEdgeLength() / mesh->NumberOfEdges();
  matrix = ZeroMatrix(operators->Pattern());
  measure("assembly",
    [&] { operators->Fill(matrix, mesh->ControlAreas(), 100.0 * h * h, weights, nullptr, loops); });

  const Values u = Noise(*mesh);
  const Values b = mesh->ControlAreas().asDiagonal() * u;
  const auto solve = [&](SolverMethod method, const char* setUp, const char* solution)
  {
    const auto solver = MakeSolver(method, SolverTask(), loops);
    solver->SetLimits({ 1e-10, 100000 });
    measure(setUp, [&] { solver->SetMatrix(matrix); });
    Values x = u;
    measure(solution, [&] { solver->Solve(b, x); });
  };
  solve(SolverMethod::ConjugateGradient, "conjugate gradients: set-up",
    "conjugate gradients: solve, 100 h²");
  solve(SolverMethod::Multigrid, "multigrid: set-up", "multigrid: solve, 100 h²");
  solve(SolverMethod::Direct, "Cholesky: ordering and factorisation", "Cholesky: solve");

  TotalVariationFlow::Settings flow;
  flow.SteadyState = true;
  flow.Fidelity = 3.0 / h;
  flow.StopTolerance = 1e-3;
  measure("total variation to a gap of 1e-3",
    [&]
    {
      TotalVariationFlow(operators, TangentVectors(), PointData::FromValues(u), flow, loops)
        .Advance(ProgressMonitor());
    });

  Values normals = Noise(*mesh, 3);
  normals.rowwise().normalize();
  HarmonicMap::Settings map;
  map.TimeStep = 0.03 * h;
  map.Beta = 1e-6 / (h * h);
  measure("harmonic map, one step",
    [&]
    {
      MakeMap(operators, PointData::FromValues(normals), map,
        MakeSolver(SolverMethod::Automatic, SolverTask(), loops), loops)
        ->Advance(ProgressMonitor());
    });

  Points points(mesh->NumberOfVertices(), 3);
  for (Index i = 0; i < mesh->NumberOfVertices(); ++i)
  {
    points.row(i) = surface.Vertices.row(mesh->InputVertex()[i]) / mesh->LengthUnit();
  }
  DenoisingSettings denoising;
  denoising.NoiseLevel = 0.1 * h;
  measure("mesh denoising", [&] { DenoiseSurface(*mesh, points, {}, denoising, nullptr, loops); });
  return 0;
}
