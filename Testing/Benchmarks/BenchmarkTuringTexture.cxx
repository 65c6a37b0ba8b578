// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Textures of (24) with the default rates, on icospheres of 10 4^s + 2 vertices and, if the build
// has their folder, on scanned meshes that are subdivided s times.
//
// Step: one time step compared with the triangular solves in it (two per stage); step_over_solves
// is their ratio. Stands: from noise until the pattern is stationary, with time steps of 1/n and
// concurrent solves for u1 and u2; explicit_steps is the number of steps that an explicit scheme
// would need for the same time on that mesh.

#include "MeshFiles.h"
#include "Meshes.h"

#include "Core/Models/Textures/ReactionDiffusion.h"
#include "Core/Operators/CotanWeights.h"

#include <benchmark/benchmark.h>

#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Settings = ReactionDiffusion::Settings;

const char* const Meshes[] = { "", "refined_elephant", "bunny00",
  "armadillo" }; // the first: spheres

/// The surface with every triangle split into four.
Surface Refined(const Surface& s)
{
  std::map<std::pair<Index, Index>, Index> middles;
  std::vector<Eigen::RowVector3d> vertices;
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    vertices.emplace_back(s.Vertices.row(i));
  }
  const auto middle = [&](Index a, Index b)
  {
    const auto found = middles.emplace(std::minmax(a, b), static_cast<Index>(vertices.size()));
    if (found.second)
    {
      vertices.emplace_back(0.5 * (vertices[a] + vertices[b]));
    }
    return found.first->second;
  };
  std::vector<std::array<Index, 3>> faces;
  for (Index t = 0; t < s.NumberOfTriangles(); ++t)
  {
    const Index a = s.Faces(t, 0), b = s.Faces(t, 1), c = s.Faces(t, 2);
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    faces.insert(faces.end(), { { a, ab, ca }, { ab, b, bc }, { ca, bc, c }, { ab, bc, ca } });
  }
  return MakeSurface(vertices, faces);
}

struct Texture
{
  std::shared_ptr<const Assembler> Operators;
  CornerWeights Coefficients;
  double Square; ///< square of the mean edge length

  Texture(int mesh, int subdivisions)
  {
    Surface s = mesh == 0 ? Icosphere(subdivisions) : ReadMeshFile(Meshes[mesh]);
    for (int i = 0; mesh > 0 && i < subdivisions; ++i)
    {
      s = Refined(s);
    }
    this->Operators = MakeAssembler(s);
    const TriangleMesh& surface = this->Operators->Mesh();
    this->Coefficients = CotanWeights(surface);
    this->Square = std::pow(surface.TotalEdgeLength() / surface.NumberOfEdges(), 2);
  }

  std::unique_ptr<ReactionDiffusion> MakeModel(
    const Settings& settings, std::array<std::shared_ptr<LinearSolver>, 2> solvers) const
  {
    const auto& numbers = this->Operators->Mesh().InputVertex();
    const std::vector<std::int64_t> ids(numbers.begin(), numbers.end());
    return std::make_unique<ReactionDiffusion>(this->Operators, Reaction(),
      std::array<ReactionDiffusion::Chemical, 2>{
        { { 21.0 * this->Square * this->Coefficients, solvers[0] },
          { 2.6 * this->Square * this->Coefficients, solvers[1] } } },
      PointData::FromValues(NoisySteadyState(Reaction(), 0.1, 0, ids)), settings);
  }

  /// The largest eigenvalue of M^-1 K, by power iteration. Explicit time steps must be smaller than
  /// 2 over the product of this eigenvalue and the larger rate.
  double LargestEigenvalue() const
  {
    const TriangleMesh& mesh = this->Operators->Mesh();
    SparseMatrix matrix = ZeroMatrix(this->Operators->Pattern());
    this->Operators->Fill(matrix, mesh.ControlAreas(), 1.0, this->Coefficients);
    Values x = Noise(mesh);
    Values y = x;
    double eigenvalue = 0.0;
    for (int iteration = 0; iteration < 200; ++iteration)
    {
      Multiply(matrix, x, y);
      y = (y.array().colwise() / mesh.ControlAreas().array()).matrix() - x;
      eigenvalue = y.norm() / x.norm();
      x = y / y.norm();
    }
    return eigenvalue;
  }
};

/// A solver that measures the time of its solves.
class TimedSolver : public LinearSolver
{
public:
  explicit TimedSolver(std::unique_ptr<LinearSolver> solver)
    : Inner(std::move(solver))
  {
  }
  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress) override
  {
    this->Inner->SetMatrix(matrix, progress);
  }
  SolveReport Solve(const Values& b, Values& x, const ProgressMonitor& progress) override
  {
    const auto start = std::chrono::steady_clock::now();
    const SolveReport report = this->Inner->Solve(b, x, progress);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    this->Seconds += seconds.count();
    this->Iterations += report.Iterations;
    return report;
  }
  void Precondition(const Values& r, Values& z) override { this->Inner->Precondition(r, z); }

  double Seconds = 0.0;
  int Iterations = 0;

private:
  std::unique_ptr<LinearSolver> Inner;
};

bool Skipped(benchmark::State& state)
{
  const bool skipped = state.range(0) > 0 && !HaveMeshFiles();
  if (skipped)
  {
    state.SkipWithError("no folder of meshes");
  }
  return skipped;
}

/// Arguments: mesh, subdivisions, scheme, direct.
void Step(benchmark::State& state)
{
  if (Skipped(state))
  {
    return;
  }
  const Texture texture(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  std::array<std::shared_ptr<TimedSolver>, 2> solvers;
  for (auto& solver : solvers)
  {
    solver = std::make_shared<TimedSolver>(
      state.range(3) != 0 ? MakeCholeskySolver() : MakeConjugateGradientSolver());
  }
  Settings settings;
  settings.TimeScheme = static_cast<ReactionDiffusion::Scheme>(state.range(2));
  const auto model = texture.MakeModel(settings, { solvers[0], solvers[1] });
  for (int step = 0; step < 48; ++step) // until the pattern appears
  {
    model->Advance(ProgressMonitor());
  }
  solvers[0]->Seconds = solvers[1]->Seconds = 0.0;
  solvers[0]->Iterations = solvers[1]->Iterations = 0;
  double steps = 0.0;
  const auto start = std::chrono::steady_clock::now();
  for (auto _ : state)
  {
    model->Advance(ProgressMonitor());
    ++steps;
  }
  const std::chrono::duration<double> all = std::chrono::steady_clock::now() - start;
  const double solves = solvers[0]->Seconds + solvers[1]->Seconds;
  state.counters["vertices"] = texture.Operators->Mesh().NumberOfVertices();
  state.counters["solves_ms"] = 1e3 * solves / steps;
  state.counters["step_over_solves"] = all.count() / solves;
  state.counters["iterations"] = (solvers[0]->Iterations + solvers[1]->Iterations) / steps;
}

/// Arguments: mesh, subdivisions, n: time steps of 1/n.
void Stands(benchmark::State& state)
{
  if (Skipped(state))
  {
    return;
  }
  const Texture texture(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  Settings settings;
  settings.TimeStep = 1.0 / static_cast<double>(state.range(2));
  settings.StopTolerance = 0.03;
  double steps = 0.0;
  for (auto _ : state)
  {
    const auto model = texture.MakeModel(settings, { MakeCholeskySolver(), MakeCholeskySolver() });
    for (steps = 0.0; !model->Finished() && steps < 1e4; ++steps)
    {
      model->Advance(ProgressMonitor());
    }
  }
  const double time = steps * settings.TimeStep;
  state.counters["vertices"] = texture.Operators->Mesh().NumberOfVertices();
  state.counters["steps"] = steps;
  state.counters["time"] = time;
  state.counters["explicit_steps"] =
    time * 0.5 * 21.0 * texture.Square * texture.LargestEigenvalue();
}

} // namespace

BENCHMARK(Step)
  ->ArgNames({ "mesh", "subdivisions", "scheme", "direct" })
  ->ArgsProduct({ { 0 }, { 5, 6, 7 }, { 0, 1 }, { 0, 1 } })
  ->Args({ 1, 0, 1, 0 })
  ->Args({ 1, 0, 1, 1 })
  ->Args({ 3, 1, 1, 0 })
  ->Args({ 3, 1, 1, 1 })
  ->Unit(benchmark::kMillisecond);
BENCHMARK(Stands)
  ->ArgNames({ "mesh", "subdivisions", "n" })
  ->ArgsProduct({ { 0 }, { 5, 6 }, { 8, 16 } })
  ->ArgsProduct({ { 1, 2 }, { 0 }, { 8, 16 } })
  ->Args({ 3, 1, 16 })
  ->Iterations(1)
  ->UseRealTime()
  ->MeasureProcessCPUTime()
  ->Unit(benchmark::kSecond);
