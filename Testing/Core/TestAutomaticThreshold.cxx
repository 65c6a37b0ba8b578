// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "CellRun.h"
#include "EveryMeshFile.h"
#include "RunInput.h"
#include "ThreadedFor.h"

#include "Core/Models/MumfordShah.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Statistics/EdgeScales.h"
#include "Heat.h"
#include "Run/MumfordShahSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

// The threshold and the length that the edge model finds from its data.

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using Shape = SurfaceDiffusion::Testing::Surface;
using Data = std::function<double(const Eigen::RowVector3d&)>;

/// A sphere of diameter 1 with n meridians and n parallels, the poles among them.
Shape Globe(Index n)
{
  std::vector<Eigen::RowVector3d> vertices = { { 0, 0, 0.5 }, { 0, 0, -0.5 } };
  const auto vertex = [&](Index i, Index j) {
    return j == 0 ? 0 : j == n - 1 ? 1 : 2 + (i % n) * (n - 2) + j - 1;
  };
  std::vector<std::array<Index, 3>> faces;
  for (Index i = 0; i < n; ++i)
  {
    for (Index j = 0; j < n - 1; ++j)
    {
      if (j > 0)
      {
        const double p = 2.0 * Pi * i / n, q = Pi * j / (n - 1);
        vertices.emplace_back(
          0.5 * std::sin(q) * std::cos(p), 0.5 * std::sin(q) * std::sin(p), 0.5 * std::cos(q));
        faces.push_back({ vertex(i, j), vertex(i, j + 1), vertex(i + 1, j) });
      }
      if (j < n - 2)
      {
        faces.push_back({ vertex(i + 1, j), vertex(i, j + 1), vertex(i + 1, j + 1) });
      }
    }
  }
  return MakeSurface(vertices, faces);
}

/// Normally distributed, of deviation 1.
double Gauss(std::int64_t seed, Index i, int channel = 0)
{
  const double a = UniformRandom(seed, 2 * channel, i);
  const double b = UniformRandom(seed, 2 * channel + 1, i);
  return std::sqrt(-2.0 * std::log(1.0 - a)) * std::cos(2.0 * Pi * b);
}

RunInput MakeInput(const Shape& surface, const Data& f, double noise = 0.0)
{
  RunInput input(surface);
  for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
  {
    input.Data.Data.Values(i, 0) =
      f(input.Vertices.row(i)) + noise * Gauss(7, static_cast<Index>(i));
  }
  return input;
}

/// The results at the last step, per point of the input.
struct Found
{
  Values U;
  Vector Edges;
  std::vector<Output> Outputs;
  double MeanEdgeLength = 0.0;
  std::vector<std::string> Warnings;

  const Curves& EdgeCurves() const
  {
    return *FindOutput(this->Outputs, "Curves", Place::PerCurve)->Lines;
  }
};

Found FindEdges(const RunInput& input, const MumfordShahSettings& settings = {},
  const ParallelFor& parallel = SerialFor())
{
  SurfaceDiffusion::Run run(parallel);
  Found found;
  const Values state = StateOf(run, { input.Block() }, settings);
  const auto& block = run.GetBlock(0);
  const TriangleMesh& mesh = block.Surface->Mesh();
  const auto points = static_cast<Index>(input.Vertices.rows());
  found.Outputs = block.Outputs;
  found.U = ToInput(mesh, state, points);
  found.Edges =
    ToInput(mesh, FindOutput(block.Outputs, "Edges", Place::PerVertex)->Rows, points).col(0);
  found.MeanEdgeLength = run.Units().MeanEdgeLength;
  for (const Warning& warning : run.FindWarnings(Alone))
  {
    found.Warnings.push_back(warning.Sentence.Text());
  }
  return found;
}

double RootMeanSquare(const Values& u)
{
  return std::sqrt(u.squaredNorm() / static_cast<double>(u.size()));
}

void ExpectNoEdges(const RunInput& input, const char* name)
{
  const Found found = FindEdges(input);
  std::printf("%s, %d points: threshold %.3f, length %.1f, edges up to %.2f\n", name,
    static_cast<int>(input.Vertices.rows()), FindNumber(found.Outputs, "EffectiveEdgeThreshold"),
    FindNumber(found.Outputs, "EffectiveSmoothingLength"), found.Edges.maxCoeff());
  EXPECT_LT(found.Edges.maxCoeff(), 0.5) << name << " of " << input.Vertices.rows() << " points";
  EXPECT_EQ(found.EdgeCurves().NumberOfCurves(), 0);
  EXPECT_TRUE(found.Warnings.empty());
}

double Height(const Eigen::RowVector3d& x)
{
  return x[2];
}

/// Patches of the values 0, 0.25, ... 1.
Data Paint(const Shape& surface, int patches, std::int64_t seed)
{
  std::vector<Eigen::RowVector3d> centres;
  std::vector<double> values;
  for (int p = 0; p < patches; ++p)
  {
    centres.emplace_back(surface.Vertices.row(
      static_cast<Index>(UniformRandom(seed, 7, p) * surface.NumberOfVertices())));
    values.push_back(0.25 * std::floor(5.0 * UniformRandom(seed, 8, p)));
  }
  return [=](const Eigen::RowVector3d& x)
  {
    std::size_t nearest = 0;
    for (std::size_t p = 1; p < centres.size(); ++p)
    {
      nearest = (x - centres[p]).norm() < (x - centres[nearest]).norm() ? p : nearest;
    }
    return values[nearest];
  };
}

struct Score
{
  double Recall = 0.0; ///< the part of the true edges within 1 h of Edges > 0.5
  double False = 0.0; ///< the length of curves more than 4 h from true edges, over the true length
};

Score Judge(const Shape& surface, const Data& truth, const Found& found)
{
  std::vector<double> values(static_cast<std::size_t>(surface.NumberOfVertices()));
  Vector near = found.Edges; // the largest among neighbours
  for (Index i = 0; i < surface.NumberOfVertices(); ++i)
  {
    values[static_cast<std::size_t>(i)] = truth(surface.Vertices.row(i));
  }
  for (Index t = 0; t < surface.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      const Index i = surface.Faces(t, a), j = surface.Faces(t, (a + 1) % 3);
      near[i] = std::max(near[i], found.Edges[j]);
      near[j] = std::max(near[j], found.Edges[i]);
    }
  }
  double length = 0.0, hit = 0.0, wrong = 0.0;
  std::vector<Eigen::RowVector3d> middles;
  for (Index t = 0; t < surface.NumberOfTriangles(); ++t)
  {
    std::vector<Eigen::RowVector3d> cut;
    double strongest = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      const Index i = surface.Faces(t, a), j = surface.Faces(t, (a + 1) % 3);
      strongest = std::max(strongest, near[i]);
      if (values[static_cast<std::size_t>(i)] != values[static_cast<std::size_t>(j)])
      {
        cut.emplace_back(0.5 * (surface.Vertices.row(i) + surface.Vertices.row(j)));
        middles.push_back(cut.back());
      }
    }
    if (cut.size() > 1)
    {
      length += (cut[0] - cut[1]).norm();
      hit += strongest > 0.5 ? (cut[0] - cut[1]).norm() : 0.0;
    }
  }
  const Curves& curves = found.EdgeCurves();
  for (Index l = 0; l < curves.NumberOfCurves(); ++l)
  {
    for (Index k = curves.Begin[l]; k + 1 < curves.Begin[l + 1]; ++k)
    {
      const Eigen::RowVector3d x = curves.Points.row(curves.Corners[k]);
      const bool isNear = std::any_of(middles.begin(), middles.end(),
        [&](const Eigen::RowVector3d& m) { return (m - x).norm() < 4.0 * found.MeanEdgeLength; });
      wrong += isNear
        ? 0.0
        : (curves.Points.row(curves.Corners[k + 1]) - curves.Points.row(curves.Corners[k])).norm();
    }
  }
  return { hit / length, wrong / length };
}

double UnitStep(const Eigen::RowVector3d& x)
{
  return x[2] > 0.3 ? 1.0 : 0.0;
}

} // namespace

/// 3.2 sigma sqrt(8 h / L) of one channel, in the Euclidean norm over the channels.
TEST(AutomaticThreshold, OfStrongNoiseGrowsAsTheRootOfTheNumberOfChannels)
{
  const Shape plate = Plate(24, 1.0);
  const auto assembler = MakeAssembler(plate);
  const TriangleMesh& mesh = assembler->Mesh();
  EdgeScalesInput input;
  input.NoiseLevel = 10.0;
  input.EdgeWidth = 1e-6 * MeanEdge(mesh);
  for (const Eigen::Index channels : { 1, 4, 9 })
  {
    // A checkerboard has no slope.
    const Values f = Noise(mesh).array().sign().replicate(1, channels);
    const EdgeScales found =
      FindEdgeScales(*assembler, plate.Vertices, PointData::FromValues(f), input).front();
    EXPECT_NEAR(found.SmoothingLength, 24.0 * MeanEdge(mesh), 0.2 * MeanEdge(mesh));
    const double expected =
      3.2 * 10.0 * std::sqrt(channels * 8.0 * MeanEdge(mesh) / found.SmoothingLength);
    EXPECT_NEAR(found.Threshold, expected, 0.01 * expected) << channels << " channels";
  }
}

TEST(AutomaticThreshold, RampsHaveNoEdgesAtAnyResolution)
{
  for (const Index n : { 20, 30, 50, 80, 120, 200 })
  {
    ExpectNoEdges(MakeInput(Globe(n), Height), "globe");
  }
  for (const Index n : { 20, 60, 120, 200 })
  {
    ExpectNoEdges(
      MakeInput(Strip(n, n), [](const auto& x) { return x[0] + 0.3 * x[1]; }), "square");
  }
  if (HaveMeshFiles())
  {
    for (const char* name : { "elephant", "dino", "femur" })
    {
      ExpectNoEdges(MakeInput(ReadMeshFile(name), Height), name);
    }
  }
}

TEST(AutomaticThreshold, NoisyRampsAndSmoothDataHaveNoEdges)
{
  for (const double noise : { 0.02, 0.05, 0.1, 0.2 })
  {
    ExpectNoEdges(MakeInput(Globe(50), Height, noise), "noisy globe");
    ExpectNoEdges(MakeInput(Globe(120), Height, noise), "noisy globe");
  }
  ExpectNoEdges(MakeInput(
                  Icosphere(5), [](const auto&) { return 0.7; }, 1.0),
    "noise");
  ExpectNoEdges(
    MakeInput(Icosphere(5), [](const auto& x) { return std::sin(6.0 * x[0]); }), "waves");
  ExpectNoEdges(MakeInput(Icosphere(5),
                  [](const auto& x) { return std::exp(-3.0 * (x[0] - 1.0) * (x[0] - 1.0)); }),
    "bump");
}

TEST(AutomaticThreshold, PaintKeepsItsEdgesUnderNoise)
{
  std::vector<std::pair<std::string, Shape>> surfaces = { { "sphere", Icosphere(5) },
    { "globe", Globe(80) } };
  if (HaveMeshFiles())
  {
    surfaces.emplace_back("dragon", ReadMeshFile("ChineseDragon-10kv"));
  }
  for (const auto& [name, surface] : surfaces)
  {
    for (const std::int64_t seed : { 1, 2 })
    {
      const int patches = 8 + surface.NumberOfVertices() / 1000; // wider than 4 EdgeWidth
      const Data paint = Paint(surface, patches, seed);
      for (const double noise : { 0.0, 0.02, 0.05, 0.1 })
      {
        const Score score = Judge(surface, paint, FindEdges(MakeInput(surface, paint, noise)));
        std::printf("%s, noise %.2f: recall %.3f, false %.3f\n", name.c_str(), noise, score.Recall,
          score.False);
        EXPECT_GE(score.Recall, noise < 0.1 ? 0.95 : 0.85) << name << " " << noise;
        EXPECT_LE(score.False, 0.05) << name << " " << noise;
      }
    }
  }
}

TEST(AutomaticThreshold, LeavesOutValuesOfWeightZero)
{
  const Shape surface = Icosphere(4);
  std::vector<std::vector<Output>> found;
  for (const double others : { 0.0, 5.0 })
  {
    RunInput input = MakeInput(
      surface, [](const Eigen::RowVector3d& x) { return x[2] > 0.6 ? 1.0 : 0.0; }, 0.1);
    for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
    {
      const bool counts = input.Vertices(i, 2) >= 0.2;
      input.Data.FidelityFactors.Values.push_back(counts ? 1.0 : 0.0);
      input.Data.Data.Values(i, 0) += counts ? 0.0 : others * UniformRandom(9, 0, i);
    }
    found.push_back(FindEdges(input).Outputs);
  }
  for (const char* const name :
    { "EstimatedNoiseLevel", "EffectiveEdgeThreshold", "EffectiveSmoothingLength" })
  {
    const double alone = FindNumber(found[0], name);
    EXPECT_GT(alone, 0.0) << name;
    EXPECT_NEAR(FindNumber(found[1], name), alone, 1e-9 * alone) << name;
  }
}

TEST(AutomaticThreshold, NoiseOfAStepIsRemovedAsByTotalVariation)
{
  for (const Shape& surface : { Globe(60), Icosphere(4) })
  {
    const Data step = [](const Eigen::RowVector3d& x) { return x[2] > 0.01 ? 1.0 : 0.0; };
    const Values truth = MakeInput(surface, step).Data.Data.Values;
    for (const double noise : { 0.15, 0.2, 0.3 })
    {
      const RunInput input = MakeInput(surface, step, noise);
      const Found found = FindEdges(input);
      TotalVariationSettings tv;
      tv.Mode = TotalVariationMode::SteadyState;
      tv.AutomaticFidelity = true;
      SurfaceDiffusion::Run run(SerialFor());
      const Values ofTV = StateOf(run, { input.Block() }, tv);
      const double error = RootMeanSquare(found.U - truth);
      const double errorOfTV = RootMeanSquare(
        ToInput(run.GetBlock(0).Surface->Mesh(), ofTV, surface.NumberOfVertices()) - truth);
      std::printf("noise %.2f: error %.4f, of total variation %.4f\n", noise, error, errorOfTV);
      EXPECT_LE(error, 1.2 * errorOfTV);
      EXPECT_NEAR(FindNumber(found.Outputs, "EstimatedNoiseLevel"), noise, 0.1 * noise);
    }
  }
}

TEST(AutomaticThreshold, OneOutlierChangesNothingElsewhere)
{
  const Shape surface = Icosphere(5);
  RunInput input = MakeInput(surface, UnitStep, 0.05);
  RunInput damaged = input;
  const Index outlier = 3000;
  damaged.Data.Data.Values(outlier, 0) = 50.0;
  const Found without = FindEdges(input);
  const Found with = FindEdges(damaged);
  double edges = 0.0, values = 0.0;
  for (Index i = 0; i < surface.NumberOfVertices(); ++i)
  {
    const double distance = (surface.Vertices.row(i) - surface.Vertices.row(outlier)).norm();
    if (distance > 20.0 * with.MeanEdgeLength) // 1 - v falls by exp(-5)
    {
      edges = std::max(edges, std::abs(with.Edges[i] - without.Edges[i]));
      values = std::max(values, std::abs(with.U(i, 0) - without.U(i, 0)));
    }
  }
  std::printf("outlier: edges change by %.2e, values by %.2e\n", edges, values);
  EXPECT_LT(edges, 0.01);
  EXPECT_LT(values, 0.001);
}

TEST(AutomaticThreshold, ComponentsAndBlocksHaveTheirOwn)
{
  const Shape sphere = Icosphere(4);
  const Index n = sphere.NumberOfVertices();
  const RunInput alone = MakeInput(sphere, UnitStep, 0.05);
  RunInput large = alone;
  large.Data.Data.Values *= 100.0;
  RunInput both(Joined(sphere, Moved(Scaled(sphere, 2.0), { 5.0, 0.0, 0.0 })));
  both.Data.Data.Values << alone.Data.Data.Values, large.Data.Data.Values;
  const Found one = FindEdges(alone);
  const Found two = FindEdges(both);
  EXPECT_GT(Judge(sphere, UnitStep, one).Recall, 0.99);
  EXPECT_GT(two.Edges.head(n).maxCoeff(), 0.9);
  EXPECT_GT(two.Edges.tail(n).maxCoeff(), 0.9);

  RunInput twins(Joined(sphere, Moved(sphere, { 5.0, 0.0, 0.0 })));
  twins.Data.Data.Values << alone.Data.Data.Values, large.Data.Data.Values;
  MumfordShahSettings settings;
  settings.Tolerance = 1e-8;
  settings.StopTolerance = 1e-7;
  const Found exact = FindEdges(alone, settings);
  const Found twin = FindEdges(twins, settings);
  EXPECT_LT((twin.Edges.head(n) - exact.Edges).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((twin.Edges.tail(n) - exact.Edges).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((twin.U.bottomRows(n) / 100.0 - exact.U).cwiseAbs().maxCoeff(), 1e-3);

  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { alone.Block(), large.Block() }, settings);
  for (const std::size_t block : { 0, 1 })
  {
    const auto& found = run.GetBlock(block);
    EXPECT_LT(
      (ToInput(found.Surface->Mesh(), FindOutput(found.Outputs, "Edges", Place::PerVertex)->Rows, n)
          .col(0) -
        exact.Edges)
        .cwiseAbs()
        .maxCoeff(),
      1e-6);
  }
  EXPECT_NEAR(FindNumber(run.GetBlock(1).Outputs, "EffectiveEdgeThreshold"),
    100.0 * FindNumber(run.GetBlock(0).Outputs, "EffectiveEdgeThreshold"), 1e-9);
}

TEST(AutomaticThreshold, UnitsOffsetsAndNumberingDoNotMatter)
{
  const Shape sphere = Icosphere(4);
  const RunInput input = MakeInput(sphere, UnitStep, 0.08);
  MumfordShahSettings settings;
  settings.Tolerance = 1e-9;
  const Found found = FindEdges(input, settings);
  for (const auto& [factor, offset] :
    std::vector<std::pair<double, double>>{ { 1e-6, 0.0 }, { 1.0, 1e4 }, { -3e8, 1.0 } })
  {
    RunInput other = input;
    other.Data.Data.Values = (other.Data.Data.Values.array() * factor + offset).matrix();
    const Found result = FindEdges(other, settings);
    EXPECT_LT((result.Edges - found.Edges).cwiseAbs().maxCoeff(), 1e-6) << factor << " " << offset;
    EXPECT_NEAR(FindNumber(result.Outputs, "EffectiveEdgeThreshold"),
      FindNumber(found.Outputs, "EffectiveEdgeThreshold"), 1e-8);
    EXPECT_NEAR(FindNumber(result.Outputs, "EstimatedNoiseLevel") / std::abs(factor),
      FindNumber(found.Outputs, "EstimatedNoiseLevel"), 1e-8);
  }
  const std::vector<Index> numbers = Permutation(sphere.NumberOfVertices(), 3);
  RunInput renumbered(Renumbered(sphere, numbers));
  for (Index i = 0; i < sphere.NumberOfVertices(); ++i)
  {
    renumbered.Data.Data.Values.row(numbers[static_cast<std::size_t>(i)]) =
      input.Data.Data.Values.row(i);
  }
  const Found again = FindEdges(renumbered, settings);
  for (Index i = 0; i < sphere.NumberOfVertices(); ++i)
  {
    ASSERT_NEAR(again.Edges[numbers[static_cast<std::size_t>(i)]], found.Edges[i], 1e-5);
  }
}

TEST(AutomaticThreshold, ColorsCellsAndCorrelatedNoiseHaveTheirEdges)
{
  const Shape sphere = Icosphere(5);
  RunInput colors(sphere);
  colors.Data.Data.Values.resize(sphere.NumberOfVertices(), 3);
  for (Index i = 0; i < sphere.NumberOfVertices(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      colors.Data.Data.Values(i, k) =
        UnitStep(sphere.Vertices.row(i)) * (k == 1 ? 0.0 : 200.0) + 20.0 * Gauss(3, i, k);
    }
  }
  const Score ofColors = Judge(sphere, UnitStep, FindEdges(colors));
  EXPECT_GT(ofColors.Recall, 0.99);
  EXPECT_LT(ofColors.False, 0.01);

  RunInput blurred = MakeInput(sphere, UnitStep, 0.3);
  const auto mesh = MakeMesh(sphere);
  const double h = MeanEdge(*mesh);
  Values data(mesh->NumberOfVertices(), 1);
  for (Index v = 0; v < mesh->NumberOfVertices(); ++v)
  {
    data.row(v) = blurred.Data.Data.Values.row(mesh->InputVertex()[static_cast<std::size_t>(v)]);
  }
  data = Diffuse(std::make_shared<Assembler>(mesh), PointData::FromValues(data), h * h, 1, 0.0,
    Scheme::BackwardEuler);
  blurred.Data.Data.Values = ToInput(*mesh, data, sphere.NumberOfVertices());
  const Score ofBlurred = Judge(sphere, UnitStep, FindEdges(blurred));
  EXPECT_GT(ofBlurred.Recall, 0.99);
  EXPECT_LT(ofBlurred.False, 0.05);

  CellInput cells(Icosphere(4));
  cells.SetData(
    [](Index c, const Eigen::RowVector3d& x) { return UnitStep(x) + 0.1 * Gauss(5, c); });
  const Found ofCells = FindEdges(cells);
  EXPECT_GT(ofCells.Edges.maxCoeff(), 0.9);
  EXPECT_EQ(ofCells.EdgeCurves().NumberOfCurves(), 1);
  EXPECT_NEAR(FindNumber(ofCells.Outputs, "EstimatedNoiseLevel"), 0.1, 0.02);
  CellInput ramp(Icosphere(4));
  ramp.SetData([](Index c, const Eigen::RowVector3d& x) { return x[2] + 0.1 * Gauss(5, c); });
  EXPECT_LT(FindEdges(ramp).Edges.maxCoeff(), 0.5);
}

TEST(AutomaticThreshold, OffGivesTheModelWithTheGivenOnes)
{
  const Shape sphere = Icosphere(4);
  const RunInput input = MakeInput(sphere, UnitStep, 0.05);
  MumfordShahSettings settings;
  settings.AutomaticThreshold = false;
  settings.NoiseLevel = 3.0; // has no effect
  const Found found = FindEdges(input, settings);
  EXPECT_EQ(FindNumber(found.Outputs, "EffectiveEdgeThreshold"), 0.2);
  EXPECT_EQ(FindNumber(found.Outputs, "EffectiveSmoothingLength"), 8.0);
  EXPECT_EQ(FindNumber(found.Outputs, "EstimatedNoiseLevel"), 0.0);

  const auto assembler = MakeAssembler(sphere);
  const TriangleMesh& mesh = assembler->Mesh();
  Values data(mesh.NumberOfVertices(), 1);
  for (Index v = 0; v < mesh.NumberOfVertices(); ++v)
  {
    data.row(v) = input.Data.Data.Values.row(mesh.InputVertex()[static_cast<std::size_t>(v)]);
  }
  const double h = MeanEdge(mesh);
  const double jump = 0.2 * (data.maxCoeff() - data.minCoeff());
  MumfordShah::Settings core;
  core.Fidelity = 1.0 / (64.0 * h * h);
  core.EdgeWidth = 2.0 * h;
  core.EdgeCost = jump * jump / (32.0 * h) / 1.125;
  const auto solver = [&]
  {
    std::shared_ptr<LinearSolver> made = MakeConjugateGradientSolver(SerialFor());
    made->SetLimits({ settings.Tolerance, settings.MaximumNumberOfIterations });
    return made;
  };
  MumfordShah model(
    assembler, CotanWeights(mesh), PointData::FromValues(data), core, solver(), solver());
  while (!model.Finished())
  {
    model.Advance(ProgressMonitor());
  }
  EXPECT_LT(
    (ToInput(mesh, model.State(), sphere.NumberOfVertices()) - found.U).cwiseAbs().maxCoeff(),
    1e-12);

  const ThreadedFor threads(3);
  EXPECT_EQ(FindEdges(input, {}, threads).U, FindEdges(input).U);
}

TEST(AutomaticThreshold, NoiseLevelReplacesTheEstimate)
{
  const RunInput input = MakeInput(Icosphere(4), UnitStep, 0.1);
  MumfordShahSettings settings;
  settings.NoiseLevel = 0.6; // larger than every jump shows
  const Found found = FindEdges(input, settings);
  EXPECT_EQ(FindNumber(found.Outputs, "EstimatedNoiseLevel"), 0.6);
  EXPECT_LT(found.Edges.maxCoeff(), 0.5);
  EXPECT_GT(FindEdges(input).Edges.maxCoeff(), 0.9);
}

TEST(AutomaticThreshold, ManyEdgesAreReportedWithTheirReason)
{
  const auto warningOf = [](const RunInput& input, const MumfordShahSettings& settings)
  {
    const std::vector<std::string> warnings = FindEdges(input, settings).Warnings;
    return warnings.size() == 1 ? warnings[0] : std::to_string(warnings.size()) + " warnings";
  };
  const auto expect = [](const std::string& text, const char* part)
  { EXPECT_NE(text.find(part), std::string::npos) << text; };
  MumfordShahSettings given;
  given.AutomaticThreshold = false;
  const Shape sphere = Icosphere(4);
  expect(warningOf(MakeInput(Globe(50), Height), given), "slopes above EdgeThreshold");
  expect(warningOf(MakeInput(sphere, UnitStep, 0.4), given), "standard deviation of the noise");
  const auto fine = [](const Eigen::RowVector3d& x)
  { return std::sin(5.0 * x[0]) * std::sin(5.0 * x[1]) > 0.0 ? 1.0 : 0.0; };
  MumfordShahSettings wide;
  wide.EdgeWidth = 5.0;
  expect(warningOf(MakeInput(sphere, fine), wide), "with AutomaticThreshold off");
  wide.AutomaticThreshold = false;
  expect(warningOf(MakeInput(sphere, fine), wide), "edges are 3 EdgeWidth wide");
  EXPECT_TRUE(FindEdges(MakeInput(sphere, UnitStep, 0.05)).Warnings.empty());
  MumfordShahSettings unused;
  unused.EdgeThreshold = 0.3;
  expect(warningOf(MakeInput(sphere, UnitStep), unused), "EdgeThreshold is 0.3 but");
}

TEST(AutomaticThreshold, ConstantsAndTinySurfacesAreLeft)
{
  for (const double value : { 0.0, 1e4 / 3.0 })
  {
    const RunInput input = MakeInput(Icosphere(3), [&](const auto&) { return value; });
    const Found found = FindEdges(input);
    EXPECT_EQ(found.U, input.Data.Data.Values);
    EXPECT_EQ(found.Edges.maxCoeff(), 0.0);
  }
  for (const Shape& surface : { Tetrahedron(), Strip(1, 1) })
  {
    EXPECT_TRUE(FindEdges(MakeInput(surface, Height)).U.allFinite());
  }
}
