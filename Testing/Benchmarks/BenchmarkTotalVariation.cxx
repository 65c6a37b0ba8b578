// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The cost of denoising by total variation, on icospheres of 10 4^s + 2 vertices with a pattern of
// 0 and 1 and 25 % noise, with lambda = 3 in natural units: the minimiser to a given duality gap,
// and a step of the paper's scheme compared with a step of the heat equation with a new factor. The
// counter Gap is the duality gap that was reached, Iterations the number of iterations. Deblurring
// removes a blur of 4 mean edge lengths. The segmentation has two labels with the means 0 and 1.
// MinimizeAllData minimises on all SphereData with lambda = 3 and 0.3; its counters are the largest
// and the median number of iterations.
// DenoiseColors minimises over three channels on opponent axes, or alternates brightness and
// chromaticity, to a tolerance of 1e-3.
// FlowOfSteps minimises in as many time steps of a flow without fidelity as its argument says.
// ChannelStep is a lagged step of all channels together, of total variation, of the Beltrami flow
// or of coherence-enhancing diffusion.

#include "HeatSystem.h"
#include "Meshes.h"
#include "SphereData.h"

#include "Core/Models/BeltramiFlow.h"
#include "Core/Models/ChromaticityBrightness.h"
#include "Core/Models/LinearDiffusion.h"
#include "Core/Models/NonlinearDiffusion.h"
#include "Core/Models/OpponentColors.h"
#include "Core/Models/Segmentation.h"
#include "Core/Models/StructureDiffusion.h"
#include "Core/Models/TikhonovDeblurring.h"
#include "Core/Models/TotalVariation/TotalVariationDeblurring.h"
#include "Core/Models/TotalVariation/TotalVariationFlow.h"
#include "Core/Operators/Assembler.h"
#include "Core/Operators/CotanWeights.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

struct NoisyPattern
{
  Surface Sphere;
  std::shared_ptr<const Assembler> Operators;
  double MeanEdge;
  PointData Data;

  NoisyPattern(int subdivisions, Eigen::Index channels)
    : Sphere(Icosphere(subdivisions))
    , Operators(std::make_shared<Assembler>(
        std::make_shared<TriangleMesh>(this->Sphere.Vertices, this->Sphere.Faces)))
  {
    const TriangleMesh& mesh = this->Operators->Mesh();
    this->MeanEdge = mesh.TotalEdgeLength() / mesh.NumberOfEdges();
    Values f(mesh.NumberOfVertices(), channels);
    for (Index i = 0; i < f.rows(); ++i)
    {
      const Index vertex = mesh.InputVertex()[i];
      const Eigen::RowVector3d x = this->Sphere.Vertices.row(vertex);
      const int cell = static_cast<int>((4.0 * x.array() + 10.0).floor().sum());
      for (Eigen::Index k = 0; k < channels; ++k)
      {
        const double a = UniformRandom(1, k, vertex);
        const double b = UniformRandom(2, k, vertex);
        const double gauss = std::sqrt(-2.0 * std::log(1.0 - a)) * std::cos(2.0 * Pi * b);
        f(i, k) = (cell + k) % 2 + 0.25 * gauss;
      }
    }
    this->Data = PointData::FromValues(f);
  }
};

void MinimizeToGap(benchmark::State& state)
{
  const NoisyPattern pattern(static_cast<int>(state.range(0)), state.range(2));
  TotalVariationFlow::Settings settings;
  settings.SteadyState = true;
  settings.Fidelity = 3.0 / pattern.MeanEdge;
  settings.StopTolerance = std::pow(10.0, -static_cast<double>(state.range(1)));
  StepReport report;
  for (auto _ : state)
  {
    TotalVariationFlow flow(pattern.Operators, TangentVectors(), pattern.Data, settings);
    report = flow.Advance(ProgressMonitor());
  }
  state.counters["Gap"] = report.Residual;
  state.counters["Iterations"] = report.Iterations;
}
BENCHMARK(MinimizeToGap)
  ->ArgNames({ "s", "digits", "channels" })
  ->ArgsProduct({ { 6, 7, 8 }, { 3, 5, 6 }, { 1 } })
  ->ArgsProduct({ { 6, 7 }, { 3, 5 }, { 3 } })
  ->Unit(benchmark::kMillisecond);

void MinimizeAllData(benchmark::State& state)
{
  std::vector<int> iterations;
  for (auto _ : state)
  {
    iterations.clear();
    for (const SphereData& data : AllSphereData())
    {
      state.PauseTiming();
      const Surface s = SphereOf(data, static_cast<int>(state.range(0)));
      const auto operators = MakeAssembler(s);
      const TriangleMesh& mesh = operators->Mesh();
      const PointData given = PointData::FromValues(NoisyValues(data, mesh, s));
      state.ResumeTiming();
      for (const double weight : { 3.0, 0.3 })
      {
        TotalVariationFlow::Settings settings;
        settings.SteadyState = true;
        settings.Fidelity = weight / MeanEdge(mesh);
        settings.StopTolerance = std::pow(10.0, -static_cast<double>(state.range(1)));
        TotalVariationFlow flow(operators, TangentVectors(), given, settings);
        iterations.push_back(flow.Advance(ProgressMonitor()).Iterations);
      }
    }
  }
  std::sort(iterations.begin(), iterations.end());
  state.counters["Worst"] = iterations.back();
  state.counters["Median"] = iterations[iterations.size() / 2];
}
BENCHMARK(MinimizeAllData)
  ->ArgNames({ "s", "digits" })
  ->ArgsProduct({ { 6, 7, 8 }, { 3, 5 } })
  ->Iterations(1)
  ->Unit(benchmark::kMillisecond);

/// The time 0.2 on a sphere with the radius 1, always in the same number of time steps: short steps
/// start near their minima.
void FlowOfSteps(benchmark::State& state)
{
  const NoisyPattern pattern(5, 1);
  const int steps = static_cast<int>(state.range(0));
  TotalVariationFlow::Settings settings;
  settings.TimeStep = 0.2 / steps / pattern.Operators->Mesh().LengthUnit();
  int iterations = 0;
  for (auto _ : state)
  {
    TotalVariationFlow flow(pattern.Operators, TangentVectors(), pattern.Data, settings);
    iterations = 0;
    for (int step = 0; step < steps; ++step)
    {
      iterations += flow.Advance(ProgressMonitor()).Iterations;
    }
  }
  state.counters["IterationsPerStep"] = static_cast<double>(iterations) / steps;
}
BENCHMARK(FlowOfSteps)->ArgName("steps")->Arg(4)->Arg(16)->Arg(64)->Unit(benchmark::kMillisecond);

/// Alternated steps of brightness and chromaticity, or the joint minimum on opponent axes.
void DenoiseColors(benchmark::State& state)
{
  const NoisyPattern pattern(static_cast<int>(state.range(0)), 3);
  const bool separates = state.range(1) != 0;
  const double h = pattern.MeanEdge;
  const double fidelity = 3.0 / h;
  TotalVariationFlow::Settings flow;
  flow.SteadyState = !separates;
  flow.TimeStep = 1e3 * h;
  flow.Fidelity = fidelity;
  flow.StopTolerance = 1e-3;
  flow.ConservesTotal = !separates;
  const auto makeFlow = [&](PointData data)
  {
    return std::make_unique<TotalVariationFlow>(
      pattern.Operators, TangentVectors(), std::move(data), flow);
  };
  const auto makeMap = [&](PointData data)
  {
    HarmonicMap::Settings map;
    map.TimeStep = flow.TimeStep;
    map.Fidelity = fidelity;
    map.Beta = 1e-6 / (h * h);
    map.Limits = { 1e-3, 1000 };
    return std::make_unique<HarmonicMap>(pattern.Operators, CotanWeights(pattern.Operators->Mesh()),
      std::move(data), map, MakeCholeskySolver());
  };
  StepReport report;
  for (auto _ : state)
  {
    std::unique_ptr<Model> model;
    if (separates)
    {
      ChromaticityBrightness::Settings settings;
      settings.Fidelity = fidelity;
      settings.SteadyState = true;
      settings.StopTolerance = 1e-3;
      model = std::make_unique<ChromaticityBrightness>(
        pattern.Operators, pattern.Data, settings, makeFlow, makeMap);
    }
    else
    {
      flow.ChannelWeights = { 1.0, 0.2, 0.2 };
      model = std::make_unique<OpponentColors>(pattern.Data, makeFlow);
    }
    report = model->Advance(ProgressMonitor());
  }
  state.counters["Iterations"] = report.Iterations;
}
BENCHMARK(DenoiseColors)
  ->ArgNames({ "s", "chromaticity" })
  ->ArgsProduct({ { 5, 6 }, { 0, 1 } })
  ->Unit(benchmark::kMillisecond);

void SegmentToGap(benchmark::State& state)
{
  const NoisyPattern pattern(static_cast<int>(state.range(0)), 1);
  Segmentation::Settings settings;
  settings.Fidelity = 3.0 / pattern.MeanEdge;
  settings.StopTolerance = 1e-3;
  Segmentation::Input input;
  input.Data = pattern.Data;
  input.Means = Eigen::Vector2d(0.0, 1.0);
  StepReport report;
  for (auto _ : state)
  {
    Segmentation model(pattern.Operators, input, settings);
    report = model.Advance(ProgressMonitor());
  }
  state.counters["Gap"] = report.Residual;
  state.counters["Iterations"] = report.Iterations;
}
BENCHMARK(SegmentToGap)->ArgName("s")->Arg(6)->Arg(7)->Unit(benchmark::kMillisecond);

/// The pattern, blurred by 4 mean edge lengths, with a tenth of the noise.
PointData Blurred(const NoisyPattern& pattern, HeatBlur& blur)
{
  NoisyPattern clean = pattern;
  const Values noise = clean.Data.Given - clean.Data.Given.array().round().matrix();
  Values f = clean.Data.Given - noise;
  StepReport report;
  blur.Apply(f, report);
  return PointData::FromValues(f + 0.1 * noise);
}

std::unique_ptr<HeatBlur> MakeBlur(const NoisyPattern& pattern)
{
  return std::make_unique<HeatBlur>(
    pattern.Operators, 4.0 * pattern.MeanEdge, 4, MakeCholeskySolver());
}

void DeblurByTotalVariation(benchmark::State& state)
{
  const NoisyPattern pattern(static_cast<int>(state.range(0)), 1);
  const PointData data = Blurred(pattern, *MakeBlur(pattern));
  TotalVariationDeblurring::Settings settings;
  settings.Fidelity = 20.0 / pattern.MeanEdge;
  settings.StopTolerance = std::pow(10.0, -static_cast<double>(state.range(1)));
  StepReport report;
  for (auto _ : state)
  {
    TotalVariationDeblurring model(
      pattern.Operators, TangentVectors(), data, settings, MakeBlur(pattern));
    report = model.Advance(ProgressMonitor());
  }
  state.counters["Iterations"] = report.Iterations;
}
BENCHMARK(DeblurByTotalVariation)
  ->ArgNames({ "s", "digits" })
  ->ArgsProduct({ { 5, 6 }, { 3, 4 } })
  ->Unit(benchmark::kMillisecond);

void DeblurByTikhonov(benchmark::State& state)
{
  const NoisyPattern pattern(static_cast<int>(state.range(0)), 1);
  const PointData data = Blurred(pattern, *MakeBlur(pattern));
  const double fidelity = 50.0 / (pattern.MeanEdge * pattern.MeanEdge);
  StepReport report;
  for (auto _ : state)
  {
    TikhonovDeblurring model(pattern.Operators, CotanWeights(pattern.Operators->Mesh()), data,
      fidelity, MakeBlur(pattern), MakeCholeskySolver(), IterationLimits());
    report = model.Advance(ProgressMonitor());
  }
  state.counters["Iterations"] = report.Iterations;
}
BENCHMARK(DeblurByTikhonov)->ArgNames({ "s" })->Arg(5)->Arg(6)->Unit(benchmark::kMillisecond);

/// Later steps, when most of the noise is removed and the systems are hardest.
void LaggedStep(benchmark::State& state)
{
  const NoisyPattern pattern(static_cast<int>(state.range(0)), 1);
  const bool direct = state.range(1) == 0;
  NonlinearDiffusion::Settings settings;
  settings.TimeStep = pattern.MeanEdge;
  settings.Fidelity = 3.0 / pattern.MeanEdge;
  settings.Along.Beta = 1e-6 / (pattern.MeanEdge * pattern.MeanEdge);
  const std::shared_ptr<LinearSolver> solver =
    direct ? MakeCholeskySolver() : MakeConjugateGradientSolver();
  solver->SetLimits(
    { direct ? 1e-10 : std::pow(10.0, -static_cast<double>(state.range(1))), 5000 });
  NonlinearDiffusion model(pattern.Operators, TangentVectors(), pattern.Data, settings, solver);
  for (int step = 0; step < 5; ++step)
  {
    model.Advance(ProgressMonitor());
  }
  StepReport report;
  for (auto _ : state)
  {
    report = model.Advance(ProgressMonitor());
  }
  state.counters["Iterations"] = report.Iterations;
}
BENCHMARK(LaggedStep)
  ->ArgNames({ "s", "digits (0: direct)" })
  ->ArgsProduct({ { 6, 7 }, { 0, 3, 10 } })
  ->Unit(benchmark::kMillisecond);

/// Ten steps on a scanned surface with stripes of 1 and -1 and 10 % noise, lambda = 8, dt = 1 and
/// beta = 1e-4 in mean edge lengths. The counter Error is the relative error against steps that are
/// solved to a residual of 1e-10.
void PaperSteps(benchmark::State& state)
{
  const Surface scan = ReadMeshFile("refined_elephant");
  const auto operators = MakeAssembler(scan);
  const TriangleMesh& mesh = operators->Mesh();
  const double h = mesh.TotalEdgeLength() / mesh.NumberOfEdges();
  const double width = scan.Vertices.col(0).maxCoeff() - scan.Vertices.col(0).minCoeff();
  Values f = Sample(mesh, scan,
    [&](const Eigen::RowVector3d& x)
    { return std::sin(4.0 * Pi * x[0] / width) > 0.0 ? 1.0 : -1.0; });
  for (Index i = 0; i < f.rows(); ++i)
  {
    f(i, 0) += 0.1 * std::sqrt(-2.0 * std::log(1.0 - UniformRandom(1, 0, i))) *
      std::cos(2.0 * Pi * UniformRandom(2, 0, i));
  }
  NonlinearDiffusion::Settings settings;
  settings.TimeStep = h;
  settings.Fidelity = 8.0 / h;
  settings.Along.Beta = 1e-4 / (h * h);
  int iterations = 0;
  const auto run = [&](double tolerance, const auto& pause)
  {
    const std::shared_ptr<LinearSolver> solver = MakeConjugateGradientSolver();
    solver->SetLimits({ tolerance, 20000 });
    NonlinearDiffusion model(
      operators, TangentVectors(), PointData::FromValues(f), settings, solver);
    pause();
    iterations = 0;
    for (int step = 0; step < 10; ++step)
    {
      iterations += model.Advance(ProgressMonitor()).Iterations;
    }
    return Values(model.State());
  };
  Values u;
  for (auto _ : state)
  {
    state.PauseTiming();
    u = run(std::pow(10.0, -static_cast<double>(state.range(0))), [&] { state.ResumeTiming(); });
  }
  state.counters["Iterations"] = iterations;
  const Values exact = run(1e-10, [] {});
  state.counters["Error"] = (u - exact).norm() / exact.norm();
}
BENCHMARK(PaperSteps)->ArgNames({ "digits" })->Arg(2)->Arg(3)->Unit(benchmark::kMillisecond);

/// Steps 6 and later with the defaults of both filters: 1 in natural units, to a residual of 1e-3.
void ChannelStep(benchmark::State& state)
{
  const NoisyPattern pattern(static_cast<int>(state.range(0)), state.range(1));
  const double h = pattern.MeanEdge;
  const std::shared_ptr<LinearSolver> solver = MakeConjugateGradientSolver();
  solver->SetLimits({ 1e-3, 5000 });
  std::unique_ptr<Model> model;
  if (state.range(2) == 0)
  {
    NonlinearDiffusion::Settings settings;
    settings.TimeStep = h;
    settings.Fidelity = 3.0 / h;
    settings.Along.Beta = 1e-6 / (h * h);
    model = std::make_unique<NonlinearDiffusion>(
      pattern.Operators, TangentVectors(), pattern.Data, settings, solver);
  }
  else if (state.range(2) == 1)
  {
    BeltramiFlow::Settings settings;
    settings.TimeStep = h * h;
    settings.ColorScale = 10.0 * h;
    model = std::make_unique<BeltramiFlow>(
      pattern.Operators, TangentVectors(), pattern.Data, settings, solver);
  }
  else
  {
    const auto iterative = [&solver]
    {
      std::shared_ptr<LinearSolver> other = MakeConjugateGradientSolver();
      other->SetLimits(solver->GetLimits());
      return other;
    };
    StructureDiffusion::Settings settings;
    settings.TimeStep = h * h;
    settings.Contrast = 0.05 / h;
    const auto mesh = pattern.Operators->SharedMesh();
    model = std::make_unique<StructureDiffusion>(pattern.Operators, TangentVectors(), pattern.Data,
      settings,
      std::make_unique<StructureTensor>(mesh,
        std::make_unique<HeatBlur>(pattern.Operators, h, 2, iterative()),
        std::make_unique<TensorSmoothing>(
          std::make_shared<LineFieldOperator>(mesh), 4.0 * h, 2, iterative())),
      solver);
  }
  for (int step = 0; step < 5; ++step)
  {
    model->Advance(ProgressMonitor());
  }
  StepReport report;
  for (auto _ : state)
  {
    report = model->Advance(ProgressMonitor());
  }
  state.counters["Iterations"] = report.Iterations;
}
BENCHMARK(ChannelStep)
  ->ArgNames({ "s", "channels", "Beltrami: 1, coherence: 2" })
  ->ArgsProduct({ { 6 }, { 1, 3 }, { 0, 1, 2 } })
  ->Unit(benchmark::kMillisecond);

void HeatStepWithANewFactor(benchmark::State& state)
{
  const NoisyPattern pattern(static_cast<int>(state.range(0)), 1);
  LinearDiffusion::Settings settings;
  settings.TimeStep = pattern.MeanEdge * pattern.MeanEdge;
  settings.TimeScheme = LinearDiffusion::Scheme::BackwardEuler;
  for (auto _ : state)
  {
    LinearDiffusion heat(pattern.Operators, CotanWeights(pattern.Operators->Mesh()), pattern.Data,
      settings, MakeCholeskySolver());
    heat.Advance(ProgressMonitor());
  }
}
BENCHMARK(HeatStepWithANewFactor)->ArgName("s")->Arg(6)->Arg(7)->Unit(benchmark::kMillisecond);

} // namespace
