// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The cost of finding edges, with the default settings, on a scanned surface with patches of 0 and
// 1 on a slope and 5 % noise: the whole run to StopTolerance 1e-5, and the extraction of the
// curves.

#include "HeatSystem.h"

#include "Core/Geometry/RidgeCurves.h"
#include "Core/Models/MumfordShah.h"
#include "Core/Operators/CotanWeights.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// refined_elephant, its edges halved `times` times, with its patches.
struct NoisyPatches
{
  Surface Scan;
  std::shared_ptr<const Assembler> Operators;
  double MeanEdge;
  PointData Data;

  explicit NoisyPatches(int times)
    : Scan(Subdivided(ReadMeshFile("refined_elephant"), times))
    , Operators(MakeAssembler(this->Scan))
  {
    const TriangleMesh& mesh = this->Operators->Mesh();
    this->MeanEdge = mesh.TotalEdgeLength() / mesh.NumberOfEdges();
    const Points& points = this->Scan.Vertices;
    const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
    Values f = Sample(mesh, this->Scan,
      [&](const Eigen::RowVector3d& x)
      {
        const Eigen::Array3d wave = (6.0 / size * x.transpose().array()).sin();
        return (wave.prod() > 0.0 ? 1.0 : 0.0) + 0.3 * x[0] / size;
      });
    f += std::sqrt(3.0) * 0.05 * Noise(mesh); // uniform, of standard deviation 0.05
    this->Data = PointData::FromValues(f);
  }

  std::unique_ptr<MumfordShah> MakeModel() const
  {
    const double length = 8.0 * this->MeanEdge;
    MumfordShah::Settings settings;
    settings.Fidelity = 1.0 / (length * length);
    settings.EdgeWidth = 2.0 * this->MeanEdge;
    settings.EdgeCost = 0.2 * 0.2 / (4.0 * length) / 1.125;
    const auto solver = []
    {
      std::shared_ptr<LinearSolver> made = MakeConjugateGradientSolver();
      made->SetLimits({ 0.1, 1000 });
      return made;
    };
    return std::make_unique<MumfordShah>(this->Operators, CotanWeights(this->Operators->Mesh()),
      this->Data, settings, solver(), solver());
  }
};

int RunToTheEnd(MumfordShah& model)
{
  int steps = 0;
  for (; !model.Finished(); ++steps)
  {
    model.Advance(ProgressMonitor());
  }
  return steps;
}

void FindEdges(benchmark::State& state)
{
  const NoisyPatches patches(static_cast<int>(state.range(0)));
  int steps = 0;
  for (auto _ : state)
  {
    const auto model = patches.MakeModel();
    steps = RunToTheEnd(*model);
  }
  state.counters["Steps"] = steps;
  state.counters["Vertices"] = patches.Operators->Mesh().NumberOfVertices();
}
BENCHMARK(FindEdges)->ArgName("halved")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void ExtractCurves(benchmark::State& state)
{
  const NoisyPatches patches(static_cast<int>(state.range(0)));
  const TriangleMesh& mesh = patches.Operators->Mesh();
  const auto model = patches.MakeModel();
  RunToTheEnd(*model);
  const Vector edges = model->Edges();
  Polylines curves;
  for (auto _ : state)
  {
    curves =
      FindRidges(mesh, patches.Scan.Vertices, edges, 8.0 * patches.MeanEdge * mesh.LengthUnit());
  }
  state.counters["Curves"] = curves.NumberOfLines();
}
BENCHMARK(ExtractCurves)->ArgName("halved")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

} // namespace
