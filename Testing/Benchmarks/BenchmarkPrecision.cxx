// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What single precision gains: the same work in double precision on compressed rows, and in single
// precision on slices of 16 rows or triangles. Solve is a backward Euler step of 100 h^2 from noise
// to a residual of 1e-10 in double precision, Update one update of the gradients of total variation
// with what it gives to the equation for u.

#include "HeatSystem.h"

#include "Core/Models/TotalVariation/SlicedSplitting.h"
#include "Core/Solvers/ConjugateGradients.h"
#include "Core/Solvers/LinearSolver.h"
#include "Core/Solvers/SlicedMatrix.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr double DiffusionNumber = 100.0; ///< dt/h^2

Vector InverseDiagonal(const SparseMatrix& matrix)
{
  return matrix.diagonal().cwiseInverse();
}

void ProductIn(benchmark::State& state, bool single)
{
  const HeatSystem system(SurfaceOfLevel(static_cast<int>(state.range(0))), DiffusionNumber);
  const Values x = Noise(*system.Mesh);
  if (single)
  {
    SlicedMatrix matrix(SerialFor());
    const Vector roots = InverseDiagonal(system.Matrix).cwiseSqrt();
    matrix.Set(system.Matrix, roots);
    std::vector<float> p(matrix.PaddedRows(), 0.5F);
    std::vector<float> q(matrix.PaddedRows());
    double sum = 0.0;
    for (auto _ : state)
    {
      matrix.Multiply(1, p.data(), q.data(), &sum);
      benchmark::DoNotOptimize(sum);
    }
  }
  else
  {
    Values y(x.rows(), 1);
    for (auto _ : state)
    {
      Multiply(system.Matrix, x, y);
      benchmark::DoNotOptimize(y.col(0).dot(x.col(0)));
    }
  }
  CountVertices(state, system.Mesh->NumberOfVertices());
}

void SolveIn(benchmark::State& state, bool single)
{
  const HeatSystem system(SurfaceOfLevel(static_cast<int>(state.range(0))), DiffusionNumber);
  const Values b = system.RightHandSide(Noise(*system.Mesh));
  const IterationLimits limits{ 1e-10, 100000 };
  const auto solver = MakeConjugateGradientSolver();
  solver->SetLimits(limits);
  solver->SetMatrix(system.Matrix);
  const Vector inverse = InverseDiagonal(system.Matrix);
  ConjugateGradientWork work;
  SolveReport report;
  Values x(b.rows(), 1);
  for (auto _ : state)
  {
    x.setZero();
    if (single)
    {
      report = solver->Solve(b, x);
      continue;
    }
    Values residual = b;
    const MatrixSystem matrix(system.Matrix, inverse);
    ConjugateGradients<1, MatrixSystem> iterations(matrix, residual, work, SerialFor());
    work.Unit[0] = 1.0;
    work.Reference[0] = b.col(0).dot(inverse.cwiseProduct(b.col(0)));
    report = iterations.Solve(x, limits, ProgressMonitor());
  }
  state.counters["Iterations"] = report.Iterations;
  CountVertices(state, system.Mesh->NumberOfVertices());
}

template <typename Number>
void UpdateIn(benchmark::State& state)
{
  const HeatSystem system(SurfaceOfLevel(static_cast<int>(state.range(0))));
  const TriangleMesh& mesh = *system.Mesh;
  const Values u = Noise(mesh);
  EdgeFunction function;
  function.Kind = EdgeFunctionKind::TotalVariation;
  SlicedSplitting<Number> splitting(function, ChannelCoupling::Joint, SerialFor());
  Vector penalty(mesh.NumberOfTriangles());
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    penalty[t] = mesh.Shapes()[t].Area();
  }
  splitting.SetMesh(mesh, GradientMaps(system.Mesh), penalty);
  splitting.Start(1, false);
  Values side(u.rows(), 1);
  for (auto _ : state)
  {
    splitting.Update(u, 1.6);
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      splitting.template Gather<1>(i, &side(i, 0));
    }
    benchmark::DoNotOptimize(side.data());
  }
  CountVertices(state, mesh.NumberOfVertices());
}

void Register(benchmark::internal::Benchmark* benchmark)
{
  benchmark->ArgName("level")->Arg(1)->Arg(2)->Arg(3)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(ProductIn, double, false)->Apply(Register);
BENCHMARK_CAPTURE(ProductIn, single, true)->Apply(Register);
BENCHMARK_CAPTURE(SolveIn, double, false)->Apply(Register);
BENCHMARK_CAPTURE(SolveIn, single, true)->Apply(Register);
BENCHMARK(UpdateIn<double>)->Apply(Register);
BENCHMARK(UpdateIn<float>)->Apply(Register);

} // namespace
