// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What each stage of linear diffusion costs, on icospheres of 10 4^s + 2 vertices. The counter
// ns/vertex shows how a stage grows; the last benchmarks run the whole filter, whose time minus
// the core's is what copying in and out costs.

#include "Meshes.h"

#include "Assembler.h"
#include "Coefficients.h"
#include "LinearSolver.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFVMHeatFilter.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <benchmark/benchmark.h>

#include <map>

using namespace SurfaceDiffusion;
using SurfaceDiffusion::Testing::Icosphere;
using SurfaceDiffusion::Testing::Surface;

namespace
{

const Surface& Sphere(int subdivisions)
{
  static std::map<int, Surface> spheres;
  auto found = spheres.find(subdivisions);
  if (found == spheres.end())
  {
    found = spheres.emplace(subdivisions, Icosphere(subdivisions)).first;
  }
  return found->second;
}

/// Everything a time step of dt = number h^2 needs, made once per size.
struct System
{
  std::shared_ptr<const TriangleMesh> Mesh;
  std::shared_ptr<const Assembler> Operators;
  EdgeValues Coefficients;
  SparseMatrix Matrix;

  System(int subdivisions, double number)
    : Mesh(std::make_shared<TriangleMesh>(
        Sphere(subdivisions).Vertices, Sphere(subdivisions).Faces))
    , Operators(std::make_shared<Assembler>(Mesh))
    , Coefficients(IsotropicCoefficients(*Mesh))
    , Matrix(Operators->Pattern())
  {
    const double h = this->Mesh->TotalEdgeLength() / this->Mesh->NumberOfEdges();
    this->Operators->Fill(
      this->Matrix, this->Mesh->ControlAreas(), number * h * h, this->Coefficients);
  }

  Values RightHandSide(Index columns) const
  {
    Values b(this->Mesh->NumberOfVertices(), columns);
    for (Index i = 0; i < b.rows(); ++i)
    {
      for (Index k = 0; k < columns; ++k)
      {
        b(i, k) = this->Mesh->ControlAreas()[i] * UniformRandom(0, k, i);
      }
    }
    return b;
  }
};

void CountPerVertex(benchmark::State& state, double vertices)
{
  state.counters["vertices"] = vertices;
  state.counters["ns/vertex"] = benchmark::Counter(vertices * 1e-9,
    benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void MeshAndOrder(benchmark::State& state)
{
  const Surface& sphere = Sphere(static_cast<int>(state.range(0)));
  for (auto _ : state)
  {
    TriangleMesh mesh(sphere.Vertices, sphere.Faces);
    benchmark::DoNotOptimize(mesh.ControlAreas().data());
  }
  CountPerVertex(state, static_cast<double>(sphere.Vertices.rows()));
}

void PatternAndSlots(benchmark::State& state)
{
  const System system(static_cast<int>(state.range(0)), 1.0);
  for (auto _ : state)
  {
    Assembler assembler(system.Mesh);
    benchmark::DoNotOptimize(assembler.Pattern().valuePtr());
  }
  CountPerVertex(state, system.Mesh->NumberOfVertices());
}

void CoefficientsAndFill(benchmark::State& state)
{
  System system(static_cast<int>(state.range(0)), 1.0);
  for (auto _ : state)
  {
    const EdgeValues c = IsotropicCoefficients(*system.Mesh);
    system.Operators->Fill(system.Matrix, system.Mesh->ControlAreas(), 1.0, c);
    benchmark::DoNotOptimize(system.Matrix.valuePtr());
  }
  CountPerVertex(state, system.Mesh->NumberOfVertices());
}

void Refill(benchmark::State& state)
{
  System system(static_cast<int>(state.range(0)), 1.0);
  for (auto _ : state)
  {
    system.Operators->Fill(
      system.Matrix, system.Mesh->ControlAreas(), 1.0, system.Coefficients);
    benchmark::DoNotOptimize(system.Matrix.valuePtr());
  }
  CountPerVertex(state, system.Mesh->NumberOfVertices());
}

void Product(benchmark::State& state)
{
  const System system(static_cast<int>(state.range(0)), 1.0);
  const Values x = system.RightHandSide(static_cast<Index>(state.range(1)));
  Values y = x;
  for (auto _ : state)
  {
    Multiply(system.Matrix, x, y);
    benchmark::DoNotOptimize(y.data());
  }
  CountPerVertex(state, system.Mesh->NumberOfVertices());
}

void OrderAndFactorize(benchmark::State& state)
{
  const System system(static_cast<int>(state.range(0)), 1.0);
  for (auto _ : state)
  {
    const auto solver = MakeCholeskySolver();
    solver->SetMatrix(system.Matrix);
  }
  CountPerVertex(state, system.Mesh->NumberOfVertices());
}

void Solve(benchmark::State& state, LinearSolver& solver, double number)
{
  const System system(static_cast<int>(state.range(0)), number);
  const Values b = system.RightHandSide(static_cast<Index>(state.range(1)));
  Values x = Values::Zero(b.rows(), b.cols());
  IterationLimits limits;
  limits.MaximumNumberOfIterations = 100000;
  solver.SetLimits(limits);
  solver.SetMatrix(system.Matrix);
  int iterations = 0;
  for (auto _ : state)
  {
    x.setZero();
    iterations = solver.Solve(b, x).Iterations;
  }
  CountPerVertex(state, system.Mesh->NumberOfVertices());
  state.counters["iterations"] = iterations;
}

void CholeskySolve(benchmark::State& state)
{
  Solve(state, *MakeCholeskySolver(), 1.0);
}

void ConjugateGradients(benchmark::State& state)
{
  Solve(state, *MakeConjugateGradientSolver(), static_cast<double>(state.range(2)));
}

/// 100 steps of the whole filter, from polydata to polydata.
void HeatFilter100Steps(benchmark::State& state)
{
  const Surface& sphere = Sphere(static_cast<int>(state.range(0)));
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(sphere.Vertices.rows());
  vtkNew<vtkDoubleArray> values;
  values->SetName("f");
  values->SetNumberOfTuples(sphere.Vertices.rows());
  for (Index i = 0; i < sphere.Vertices.rows(); ++i)
  {
    points->SetPoint(i, sphere.Vertices.row(i).data());
    values->SetValue(i, UniformRandom(0, 0, i));
  }
  vtkNew<vtkCellArray> polys;
  for (Index t = 0; t < sphere.Faces.rows(); ++t)
  {
    const vtkIdType ids[3] = { sphere.Faces(t, 0), sphere.Faces(t, 1), sphere.Faces(t, 2) };
    polys->InsertNextCell(3, ids);
  }
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(points);
  surface->SetPolys(polys);
  surface->GetPointData()->SetScalars(values);
  double steps = 0.0;
  double firstStep = 0.0;
  for (auto _ : state)
  {
    vtkNew<vtkFVMHeatFilter> filter;
    filter->SetInputData(surface);
    filter->SetNumberOfTimeSteps(100);
    filter->Update();
    const auto* seconds = vtkDoubleArray::SafeDownCast(
      vtkTable::SafeDownCast(filter->GetOutputDataObject(1))->GetColumnByName("Seconds"));
    firstStep = seconds->GetValue(1);
    steps = 0.0;
    for (vtkIdType row = 2; row <= 100; ++row)
    {
      steps += seconds->GetValue(row);
    }
  }
  CountPerVertex(state, static_cast<double>(sphere.Vertices.rows()));
  state.counters["first_step_s"] = firstStep; // with ordering and factor
  state.counters["other_99_steps_s"] = steps;
}

} // namespace

// 10,242; 40,962; 163,842; 655,362 vertices
BENCHMARK(MeshAndOrder)->DenseRange(5, 8)->Unit(benchmark::kMillisecond);
BENCHMARK(PatternAndSlots)->DenseRange(5, 8)->Unit(benchmark::kMillisecond);
BENCHMARK(CoefficientsAndFill)->DenseRange(5, 8)->Unit(benchmark::kMillisecond);
BENCHMARK(Refill)->DenseRange(5, 8)->Unit(benchmark::kMillisecond);
BENCHMARK(Product)->ArgsProduct({ { 5, 6, 7, 8 }, { 1, 3 } })->Unit(benchmark::kMillisecond);
BENCHMARK(OrderAndFactorize)->DenseRange(5, 8)->Unit(benchmark::kMillisecond);
BENCHMARK(CholeskySolve)->ArgsProduct({ { 5, 6, 7, 8 }, { 1, 3 } })->Unit(benchmark::kMillisecond);
BENCHMARK(ConjugateGradients)
  ->ArgsProduct({ { 5, 6, 7, 8 }, { 1, 3 }, { 1, 100, 10000 } })
  ->Unit(benchmark::kMillisecond);
BENCHMARK(HeatFilter100Steps)->DenseRange(6, 8)->Unit(benchmark::kMillisecond);
