// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bounds of the work of models and filters, which are counted, not timed: factorisations, solves
// and iterations. Those of iterative solvers are in Testing/Robustness/TestWork.cxx.

#include "Core/Geometry/SmoothLineField.h"
#include "Core/Geometry/SurfaceDenoising.h"
#include "Hubs.h"
#include "NoisySurfaces.h"
#include "RunInput.h"
#include "SphereData.h"
#include "TotalVariation.h"

#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/SegmentationSettings.h"
#include "Run/TensorDiffusionSettings.h"
#include "Run/TextureSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace SurfaceDiffusion
{

using namespace Testing;

namespace
{

constexpr int NumberOfSteps = 5;

/// The number of factorisations for each purpose after a run with direct solvers.
template <typename ModelSettings>
std::map<SolverPurpose, long> FactorizationsOf(ModelSettings settings)
{
  RunInput input(Icosphere(3));
  for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
  {
    input.Data.Data.Values(i, 0) = (input.Vertices(i, 2) > 0.2) + 0.1 * std::cos(7.0 * i);
  }
  if (std::is_same_v<ModelSettings, TextureSettings>) // whose data are both chemicals
  {
    input.Data.Data.Values = input.Data.Data.Values.col(0).replicate(1, 2).eval();
  }
  settings.Solver = SolverMethod::Direct;
  settings.NumberOfTimeSteps = NumberOfSteps;
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, settings);
  EXPECT_EQ(run.NumberOfStepsComputed(), NumberOfSteps);
  std::map<SolverPurpose, long> found;
  for (const SolverPurpose purpose : { SolverPurpose::Step, SolverPurpose::SecondChemical,
         SolverPurpose::Blur, SolverPurpose::Edges, SolverPurpose::Structure })
  {
    const LinearSolver* const solver = run.GetBlock(0).Solvers.Get(purpose);
    if (solver)
    {
      found[purpose] = solver->NumberOfFactorizations();
    }
  }
  return found;
}

/// The number of iterations of a run on the triangles around a vertex, from two levels or from unit
/// vectors under noise.
template <typename ModelSettings>
int IterationsAroundAVertex(ModelSettings settings)
{
  RunInput input(TrianglesAtAVertex(6000));
  const bool takesVectors = std::is_same_v<ModelSettings, HarmonicMapSettings>;
  Values& values = input.Data.Data.Values;
  values.resize(input.Vertices.rows(), takesVectors ? 2 : 1);
  for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
  {
    const double noise = 0.4 * (UniformRandom(7, 0, static_cast<Index>(i)) - 0.5);
    const double x = input.Vertices(i, 0);
    values(i, 0) = takesVectors ? std::cos(x + noise) : (x > 0.1) + noise;
    values(i, takesVectors ? 1 : 0) = takesVectors ? std::sin(x + noise) : values(i, 0);
  }
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, settings);
  int sum = 0;
  for (const StepRecord& record : run.GetBlock(0).Path->Records())
  {
    sum += record.Iterations;
  }
  return sum;
}

using Counts = std::map<SolverPurpose, long>;

/// Counts the solves of another solver.
class CountingSolver : public LinearSolver
{
public:
  void SetMatrix(const SparseMatrix& matrix, const ProgressMonitor& progress) override
  {
    this->Solver->SetMatrix(matrix, progress);
  }
  SolveReport Solve(const Values& b, Values& x, const ProgressMonitor& progress) override
  {
    ++this->NumberOfSolves;
    return this->Solver->Solve(b, x, progress);
  }
  void Precondition(const Values& r, Values& z) override { this->Solver->Precondition(r, z); }
  long NumberOfFactorizations() const override { return this->Solver->NumberOfFactorizations(); }

  int NumberOfSolves = 0;

private:
  std::unique_ptr<LinearSolver> Solver = MakeCholeskySolver();
};

} // namespace

/// The matrix of a linear equation is the same in all steps and stages.
TEST(Work, OfLinearModelsIsOneFactorisation)
{
  EXPECT_EQ(FactorizationsOf(HeatSettings()), (Counts{ { SolverPurpose::Step, 1 } }));
  EXPECT_EQ(FactorizationsOf(TextureSettings()),
    (Counts{ { SolverPurpose::Step, 1 }, { SolverPurpose::SecondChemical, 1 } }));
}

/// The matrix of the old level is another in every step.
TEST(Work, OfLaggedModelsIsOneFactorisationPerStep)
{
  TotalVariationSettings variation;
  variation.TimeIntegrator = TimeIntegrator::FirstOrder;
  variation.AutomaticFidelity = false;
  EXPECT_EQ(FactorizationsOf(variation), (Counts{ { SolverPurpose::Step, NumberOfSteps } }));
  EXPECT_EQ(FactorizationsOf(TensorDiffusionSettings()),
    (Counts{ { SolverPurpose::Step, NumberOfSteps } }));
  TensorDiffusionSettings coherent;
  coherent.Model = TensorModel::CoherenceEnhancing;
  EXPECT_EQ(FactorizationsOf(coherent),
    (Counts{ { SolverPurpose::Step, NumberOfSteps }, { SolverPurpose::Blur, 1 },
      { SolverPurpose::Structure, 1 } }));
}

/// A step is one for u and one for v.
TEST(Work, OfTheMumfordShahModelIsTwoFactorisationsPerStep)
{
  EXPECT_EQ(FactorizationsOf(MumfordShahSettings()),
    (Counts{ { SolverPurpose::Step, NumberOfSteps }, { SolverPurpose::Edges, NumberOfSteps } }));
}

/// A factor has few entries there, while iterations on needles are many.
TEST(Work, AroundAVertexOfAllTrianglesIsFewIterations)
{
  EXPECT_EQ(IterationsAroundAVertex(MumfordShahSettings()), 0);
  EXPECT_EQ(IterationsAroundAVertex(TensorDiffusionSettings()), 0);
  EXPECT_EQ(IterationsAroundAVertex(TotalVariationSettings()), 0);
  EXPECT_LE(IterationsAroundAVertex(HarmonicMapSettings()), 80);
  EXPECT_LE(IterationsAroundAVertex(SegmentationSettings()), 200);
}

/// Lanczos' method reaches 1e-9 in few steps, also where the next eigenvalue is 10 % larger.
TEST(Work, OfSmoothestLineFieldsIsOneFactorisationAndFewSolves)
{
  for (const Testing::Surface& s : { Icosphere(3), Icosphere(4), Torus(40, 20), Strip(30, 20) })
  {
    const auto mesh = MakeMesh(s);
    const LineFieldOperator lines(mesh);
    CountingSolver solver;
    SmoothestLineField(lines, TangentVectors::Ones(s.NumberOfTriangles(), 2),
      Vector::Ones(s.NumberOfTriangles()), solver);
    EXPECT_EQ(solver.NumberOfFactorizations(), 1);
    EXPECT_GE(solver.NumberOfSolves, 1);
    EXPECT_LE(solver.NumberOfSolves, 25); // 4 to 16
  }
}

/// To a duality gap of 1e-3 and of 1e-5, for data of all kinds with strong and weak fidelity, and
/// for those with the most iterations also on 163,842 vertices, where the inner ones matter.
TEST(Work, OfTotalVariationIsFewIterationsForAllKindsOfData)
{
  std::vector<std::pair<SphereData, int>> subdivided;
  for (const SphereData& data : AllSphereData())
  {
    subdivided.emplace_back(data, 5);
  }
  subdivided.emplace_back(AllSphereData().back(), 7);
  for (const auto& [data, subdivisions] : subdivided)
  {
    const Testing::Surface s = SphereOf(data, subdivisions);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const PointData given = PointData::FromValues(NoisyValues(data, mesh, s));
    for (const double weight : { 3.0, 0.3 })
    {
      for (const auto& [tolerance, most] : { std::pair(1e-3, 60), std::pair(1e-5, 150) })
      {
        const double fidelity = weight / (MeanEdge(mesh) * mesh.LengthUnit());
        const StepReport report =
          MakeExact(assembler, given, ExactSettings(mesh, 0.0, fidelity, tolerance))
            ->Advance(ProgressMonitor());
        EXPECT_LE(report.Residual, tolerance);
        EXPECT_LE(report.Iterations, most)
          << data.Name << ", " << subdivisions << ", " << weight << ", " << tolerance;
      }
    }
  }
}

/// Of a hole that is filled, for weak and strong fidelity: the penalty does not grow as far as without one.
TEST(Work, OfTotalVariationInAHoleIsSomeHundredIterations)
{
  for (const int subdivisions : { 4, 5 })
  {
    const Testing::Surface s = Icosphere(subdivisions);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    PointData data = PointData::FromValues(Sample(mesh, s,
      [](const Eigen::RowVector3d& x) { return (x[0] > 0.1) + (x[2] > 0.3 ? 1.0 : 0.0); }));
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      if (s.Vertices(mesh.InputVertex()[i], 2) > std::cos(0.5))
      {
        data.Missing[i] = true;
        data.Start(i, 0) = 0.9;
      }
    }
    for (const double weight : { 0.5, 3.0, 12.0 })
    {
      const double fidelity = weight / (MeanEdge(mesh) * mesh.LengthUnit());
      const StepReport report = MakeExact(assembler, data, ExactSettings(mesh, 0.0, fidelity, 1e-4))
                                  ->Advance(ProgressMonitor());
      EXPECT_LE(report.Residual, 1e-4);
      EXPECT_LE(report.Iterations, 180) << subdivisions << ", " << weight;
    }
  }
}

/// To gaps of 1e-2, those of searches for a weight, and of 1e-3; the first guesses and the pace of the
/// penalties are measured.
TEST(Work, OfTotalGeneralizedVariationIsSomeHundredIterations)
{
  for (const SphereData& data : AllSphereData())
  {
    const Testing::Surface s = SphereOf(data, 4);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const PointData given = PointData::FromValues(NoisyValues(data, mesh, s));
    const double h = MeanEdge(mesh);
    for (const double weight : { 10.0, 3.0 })
    {
      for (const auto& [tolerance, most] : { std::pair(1e-2, 120), std::pair(1e-3, 300) })
      {
        TotalVariationFlow::Settings settings = ExactSettings(mesh, 0.0, weight / h, tolerance);
        settings.GeneralizedLength = 2.0 * h / mesh.LengthUnit();
        const StepReport report = MakeExact(assembler, given, settings)->Advance(ProgressMonitor());
        EXPECT_LE(report.Residual, tolerance);
        EXPECT_LE(report.Iterations, most) << data.Name << ", " << weight << ", " << tolerance;
      }
    }
  }
}

/// For surfaces of any size: 45 steps towards a fit at most, each with one report and those of one step
/// of conjugate gradients; and eight minimisations of the variation of normals of 13 steps, each
/// with a fit of six.
TEST(Work, OfMeshDenoisingIsFewStepsAndEightMinimisations)
{
  for (const Index cells : { 8, 16, 24 })
  {
    for (const double noise : { 0.1, 0.3 })
    {
      const Testing::Surface s = NoisyAlongNormals(LBlock(cells), noise);
      const TriangleMesh mesh(s.Vertices, s.Faces);
      int reports = 0;
      const ProgressMonitor::Callback count = [&](double)
      {
        ++reports;
        return true;
      };
      DenoiseSurface(mesh, GatherVertices(mesh, s.Vertices) / mesh.LengthUnit(), {},
        DenoisingSettings(), nullptr, SerialFor(), ProgressMonitor(count));
      EXPECT_GE(reports, 30);
      EXPECT_LE(reports, 45 * (1 + 2) + 8 * (13 + 6 + 3));
    }
  }
}

} // namespace SurfaceDiffusion
