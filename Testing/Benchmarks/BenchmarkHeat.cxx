// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The cost of each stage of linear diffusion, on one scanned surface with sizes that grow by a
// factor of four. ns/vertex shows the scaling of a stage. GB/s counts the minimum memory traffic
// and is to be compared with Triad. The last benchmarks run the whole filter and the same steps in
// the core, both with the history. BenchmarkSolver.cxx has the linear solvers.

#include "Core/Models/Trajectory.h"
#include "Core/Solvers/SolverChoice.h"
#include "Heat.h"
#include "HeatSystem.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFVMHeatFilter.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <string>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

constexpr int NumberOfSteps = 100; // steps of a whole run

const Surface& SurfaceOf(const benchmark::State& state)
{
  return SurfaceOfLevel(static_cast<int>(state.range(0)));
}

/// Memory bandwidth: a = b + s c.
void Triad(benchmark::State& state)
{
  const Eigen::Index n = state.range(0) * 1024 * 1024 / 24;
  const Vector b = Vector::Constant(n, 1.0), c = Vector::Constant(n, 2.0);
  Vector a = Vector::Zero(n);
  double s = 3.0;
  for (auto _ : state)
  {
    a.noalias() = b + s * c;
    benchmark::DoNotOptimize(a.data());
    s += 1.0;
  }
  CountBytes(state, 24.0 * static_cast<double>(n));
}

void MeshAndOrder(benchmark::State& state)
{
  const Surface& s = SurfaceOf(state);
  for (auto _ : state)
  {
    TriangleMesh mesh(s.Vertices, s.Faces);
    benchmark::DoNotOptimize(mesh.ControlAreas().data());
  }
  CountVertices(state, s.NumberOfVertices());
}

void PatternAndSlots(benchmark::State& state)
{
  const HeatSystem system(SurfaceOf(state), 1.0);
  for (auto _ : state)
  {
    const Assembler assembler(system.Mesh);
    SparseMatrix matrix;
    assembler.TakePattern(matrix, SerialFor());
    benchmark::DoNotOptimize(matrix.innerIndexPtr());
  }
  CountVertices(state, system.Mesh->NumberOfVertices());
}

/// Cotan weights and assembly of M + dt K, for a given mesh and pattern.
void CoefficientsAndFill(benchmark::State& state)
{
  HeatSystem system(SurfaceOf(state), 1.0);
  for (auto _ : state)
  {
    const CornerWeights c = CotanWeights(*system.Mesh);
    system.Operators->Fill(system.Matrix, system.Mesh->ControlAreas(), 1.0, c);
    benchmark::DoNotOptimize(system.Matrix.valuePtr());
  }
  CountVertices(state, system.Mesh->NumberOfVertices());
}

/// Reassembly of the matrix with given weights, as for another time step.
void Refill(benchmark::State& state)
{
  HeatSystem system(SurfaceOf(state), 1.0);
  for (auto _ : state)
  {
    system.Operators->Fill(system.Matrix, system.Mesh->ControlAreas(), 1.0, system.Coefficients);
    benchmark::DoNotOptimize(system.Matrix.valuePtr());
  }
  CountVertices(state, system.Mesh->NumberOfVertices());
  // cotan weights; lists of corners and slots; areas and diagonal slots; the values of the matrix
  CountBytes(state,
    24.0 * system.Mesh->NumberOfTriangles() + 36.0 * system.Mesh->NumberOfTriangles() +
      12.0 * system.Mesh->NumberOfVertices() + 8.0 * static_cast<double>(system.Matrix.nonZeros()));
}

void Product(benchmark::State& state)
{
  const HeatSystem system(SurfaceOf(state), 1.0);
  const Values x = Noise(*system.Mesh, state.range(1));
  Values y = x;
  for (auto _ : state)
  {
    Multiply(system.Matrix, x, y);
    benchmark::DoNotOptimize(y.data());
  }
  CountVertices(state, system.Mesh->NumberOfVertices());
  CountBytes(state, BytesOfProduct(system.Matrix, static_cast<double>(x.cols())));
}

std::unique_ptr<LinearDiffusion> MakeRun(
  std::shared_ptr<const Assembler> assembler, double number, Scheme scheme)
{
  const TriangleMesh& mesh = assembler->Mesh();
  const double h = mesh.TotalEdgeLength() / mesh.NumberOfEdges();
  SolverTask task;
  task.NumberOfVertices = mesh.NumberOfVertices();
  task.DiffusionNumber = number;
  task.NumberOfSolves = NumberOfSteps * (scheme == Scheme::SDIRK2 ? 2 : 1);
  const PointData data = PointData::FromValues(Noise(mesh));
  return MakeHeat(std::move(assembler), data, { number * h * h, 0.0, scheme },
    MakeSolver(SolverMethod::Automatic, task));
}

/// A step of 1 h^2 after the first one.
void Step(benchmark::State& state, Scheme scheme)
{
  const Surface& s = SurfaceOf(state);
  const auto heat = MakeRun(MakeAssembler(s), 1.0, scheme);
  heat->Advance(ProgressMonitor());
  for (auto _ : state)
  {
    heat->Advance(ProgressMonitor());
  }
  CountVertices(state, s.NumberOfVertices());
}

/// The steps to time 140 h^2, without the factorisation, with the smallest number of steps for
/// which the relative error is at most 1e-3. The initial state is a wave with noise.
void ToAThousandth(benchmark::State& state, Scheme scheme)
{
  const auto assembler = MakeAssembler(SurfaceOf(state));
  const TriangleMesh& mesh = assembler->Mesh();
  const double h = mesh.TotalEdgeLength() / mesh.NumberOfEdges();
  const Surface& s = SurfaceOf(state);
  const double width = s.Vertices.col(0).maxCoeff() - s.Vertices.col(0).minCoeff();
  Values start = 0.1 * Noise(mesh);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    start(i) += std::sin(4.0 * Pi * s.Vertices(mesh.InputVertex()[i], 0) / width);
  }
  const auto after = [&](Scheme with, int steps)
  {
    auto heat =
      MakeHeat(assembler, PointData::FromValues(start), { 140.0 * h * h / steps, 0.0, with });
    Advance(*heat, steps);
    return heat;
  };
  const Values exact = after(Scheme::SDIRK2, 64)->State();
  const auto norm = [&](const Values& u)
  { return std::sqrt(u.col(0).cwiseAbs2().dot(mesh.ControlAreas())); };
  const double order = scheme == Scheme::SDIRK2 ? 2.0 : 1.0;
  int steps = 1;
  double error;
  while ((error = norm(after(scheme, steps)->State() - exact) / norm(exact)) > 1e-3)
  {
    steps =
      static_cast<int>(std::ceil(steps * std::max(1.01, std::pow(error / 1e-3, 1.0 / order))));
  }
  const auto heat = after(scheme, steps);
  for (auto _ : state)
  {
    Advance(*heat, steps);
  }
  CountVertices(state, mesh.NumberOfVertices());
  state.counters["steps"] = steps;
  state.counters["error"] = error;
}

/// Three SDIRK2 steps to time 140 h^2 for many columns, such as the volumes of a time series,
/// with the factorisation.
void SmoothColumns(benchmark::State& state)
{
  const auto assembler = MakeAssembler(SurfaceOf(state));
  const TriangleMesh& mesh = assembler->Mesh();
  const double h = mesh.TotalEdgeLength() / mesh.NumberOfEdges();
  const auto columns = static_cast<Index>(state.range(1));
  const PointData data = PointData::FromValues(Noise(mesh, columns));
  for (auto _ : state)
  {
    const auto heat = MakeHeat(assembler, data, { 140.0 * h * h / 3, 0.0, Scheme::SDIRK2 });
    Advance(*heat, 3);
    benchmark::DoNotOptimize(heat->State().data());
  }
  CountVertices(state, mesh.NumberOfVertices() * columns);
}

vtkSmartPointer<vtkPolyData> MakePolyData(const Surface& s)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(s.Vertices.rows());
  vtkNew<vtkDoubleArray> values;
  values->SetName("f");
  values->SetNumberOfTuples(s.Vertices.rows());
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    points->SetPoint(i, s.Vertices.row(i).data());
    values->SetValue(i, 2.0 * UniformRandom(7, 0, i) - 1.0);
  }
  vtkNew<vtkCellArray> polys;
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    const vtkIdType ids[3] = { s.Faces(t, 0), s.Faces(t, 1), s.Faces(t, 2) };
    polys->InsertNextCell(3, ids);
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(polys);
  surface->GetPointData()->SetScalars(values);
  return surface;
}

/// The whole filter, from polydata to polydata.
void Filter100Steps(benchmark::State& state)
{
  const Surface& s = SurfaceOf(state);
  const auto surface = MakePolyData(s);
  for (auto _ : state)
  {
    vtkNew<vtkFVMHeatFilter> filter;
    filter->SetInputData(surface);
    filter->SetNumberOfTimeSteps(NumberOfSteps);
    filter->Update();
  }
  CountVertices(state, s.NumberOfVertices());
}

/// The same steps in the core, from points and triangles to values and history.
void Core100Steps(benchmark::State& state)
{
  const Surface& s = SurfaceOf(state);
  for (auto _ : state)
  {
    const auto assembler = MakeAssembler(s);
    Trajectory run(assembler->SharedMesh(), MakeRun(assembler, 1.0, Scheme::SDIRK2), 0);
    run.Seek(NumberOfSteps);
    benchmark::DoNotOptimize(run.State().data());
  }
  CountVertices(state, s.NumberOfVertices());
}

/// A seek to another time of a completed run.
void TimeSeek(benchmark::State& state)
{
  const Surface& s = SurfaceOf(state);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(MakePolyData(s));
  filter->SetNumberOfTimeSteps(NumberOfSteps);
  filter->GenerateTimeStepsOn();
  filter->UpdateTimeStep(NumberOfSteps);
  int step = 0;
  for (auto _ : state)
  {
    step = (step + 37) % NumberOfSteps;
    filter->UpdateTimeStep(step);
  }
  CountVertices(state, s.NumberOfVertices());
}

// CPU time of the process, since part of the work is done on other threads.
void OnLevels(benchmark::internal::Benchmark* b)
{
  b->ArgName("level")->DenseRange(0, 3)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
}

void OnAllLevels(benchmark::internal::Benchmark* b) // the largest is too large for a factorisation
{
  OnLevels(b);
  b->Arg(4);
}

} // namespace

BENCHMARK(Triad)->ArgName("MiB")->RangeMultiplier(4)->Range(1, 1024)->MeasureProcessCPUTime();
BENCHMARK(MeshAndOrder)->Apply(OnAllLevels);
BENCHMARK(PatternAndSlots)->Apply(OnAllLevels);
BENCHMARK(CoefficientsAndFill)->Apply(OnAllLevels);
BENCHMARK(Refill)->Apply(OnAllLevels);
BENCHMARK(Product)
  ->ArgNames({ "level", "columns" })
  ->ArgsProduct({ { 0, 1, 2, 3, 4 }, { 1, 3 } })
  ->Unit(benchmark::kMillisecond)
  ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(Step, BackwardEuler, Scheme::BackwardEuler)->Apply(OnAllLevels);
BENCHMARK_CAPTURE(Step, SDIRK2, Scheme::SDIRK2)->Apply(OnAllLevels);
BENCHMARK_CAPTURE(ToAThousandth, BackwardEuler, Scheme::BackwardEuler)->Apply(OnLevels);
BENCHMARK_CAPTURE(ToAThousandth, SDIRK2, Scheme::SDIRK2)->Apply(OnLevels);
BENCHMARK(SmoothColumns)
  ->ArgNames({ "level", "columns" })
  ->Args({ 1, 1 })
  ->Args({ 1, 8 })
  ->Args({ 1, 64 })
  ->Args({ 1, 200 })
  ->MeasureProcessCPUTime(); // a factorisation may be on another thread
BENCHMARK(Core100Steps)->Apply(OnLevels)->Iterations(1);
BENCHMARK(Filter100Steps)->Apply(OnLevels)->Iterations(1);
BENCHMARK(TimeSeek)->Apply(OnLevels);
