// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Heat.h"
#include "Meshes.h"
#include "RunInput.h"

#include "Run/DirectionFieldRun.h"
#include "Run/HeatSettings.h"
#include "Run/OwnedSettings.h"
#include "Run/Run.h"
#include "Run/TextureSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace SurfaceDiffusion
{

using Testing::Alone;
using Testing::RunInput;
using Testing::StateOf;

namespace
{

RunInput NoisyCap(int level)
{
  RunInput input(Testing::Icosphere(level));
  for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
  {
    input.Data.Data.Values(i, 0) =
      (input.Vertices(i, 2) > 0.5 ? 1.0 : 0.0) + 0.2 * (2.0 * UniformRandom(3, 0, i) - 1.0);
  }
  return input;
}

} // namespace

TEST(Run, AutomaticFidelityIsNearlyTheBestWeightOfTheModelThatRuns)
{
  RunInput input = NoisyCap(3);
  TotalVariationSettings settings;
  const auto errorOf = [&](double& weight)
  {
    SurfaceDiffusion::Run run(SerialFor());
    Values difference = StateOf(run, { input.Block() }, settings);
    EXPECT_TRUE(run.FindWarnings(Alone).empty());
    weight = FindNumber(run.GetBlock(0).Outputs, "EffectiveFidelityWeight");
    const TriangleMesh& mesh = run.GetBlock(0).Surface->Mesh();
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      difference(i, 0) -= input.Vertices(mesh.InputVertex()[i], 2) > 0.5 ? 1.0 : 0.0;
    }
    return Testing::RootMeanSquare(mesh, difference);
  };
  for (const EdgeFunctionKind edge :
    { EdgeFunctionKind::TotalVariation, EdgeFunctionKind::Charbonnier })
  {
    settings.EdgeFunction = edge;
    for (const TotalVariationMode mode :
      { TotalVariationMode::TimeSteps, TotalVariationMode::SteadyState })
    {
      for (const Discretization discretization :
        { Discretization::Linear, Discretization::CrouzeixRaviart })
      {
        settings.Mode = mode;
        settings.Discretization = discretization;
        settings.AutomaticFidelity = true;
        settings.FidelityWeight = TotalVariationSettings::DefaultFidelityWeight;
        double found = 0.0;
        const double error = errorOf(found);
        settings.AutomaticFidelity = false;
        double best = error;
        for (int k = -5; k <= 5; ++k)
        {
          settings.FidelityWeight = found * std::exp2(0.7 * k);
          double unused = 0.0;
          best = std::min(best, errorOf(unused));
        }
        EXPECT_LT(error, 1.25 * best)
          << static_cast<int>(edge) << static_cast<int>(mode) << static_cast<int>(discretization);
      }
    }
  }
}

// The best weight after 4 steps is not that of 8.
TEST(Run, AutomaticFidelityIsFoundAgainForAnotherNumberOfSteps)
{
  RunInput input = NoisyCap(2);
  TotalVariationSettings settings;
  settings.AutomaticFidelity = true;
  settings.NoiseLevel = 0.1;
  SurfaceDiffusion::Run kept(SerialFor());
  for (const int steps : { 8, 4, 8 })
  {
    settings.NumberOfTimeSteps = steps;
    SurfaceDiffusion::Run fresh(SerialFor());
    const Values expected = StateOf(fresh, { input.Block() }, settings);
    EXPECT_EQ(StateOf(kept, { input.Block() }, settings), expected) << steps;
  }
}

TEST(Run, AutomaticFidelityWarnsOfNoiseThatItCannotLeave)
{
  RunInput input(Testing::Icosphere(3));
  HeatSettings settings;
  settings.Mode = HeatMode::SteadyState;
  settings.AutomaticFidelity = true;
  settings.NoiseLevel = 100.0;
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, settings);
  WarningLog log;
  const std::vector<Sentence> warnings = log.Report(run.FindWarnings(Alone));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].Text().find("AutomaticFidelity found no weight"), std::string::npos);
  EXPECT_NE(warnings[0].Text().find("100"), std::string::npos);
}

// Most values are of weight 0: they are starts of the steps, and no data, however noisy they are.
TEST(Run, AutomaticFidelityTakesTheNoiseFromValuesWithAWeight)
{
  TotalVariationSettings settings;
  settings.AutomaticFidelity = true;
  for (const TotalVariationMode mode :
    { TotalVariationMode::TimeSteps, TotalVariationMode::SteadyState })
  {
    settings.Mode = mode;
    std::vector<double> differences;
    for (const double others : { 0.0, 4.0 })
    {
      RunInput input = NoisyCap(4);
      std::vector<double>& weights = input.Data.FidelityFactors.Values;
      for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
      {
        weights.push_back(input.Vertices(i, 2) < 0.3 ? 0.0 : 1.0);
        input.Data.Data.Values(i, 0) += (1.0 - weights.back()) * others * UniformRandom(5, 0, i);
      }
      SurfaceDiffusion::Run run(SerialFor());
      const Values state = StateOf(run, { input.Block() }, settings);
      const TriangleMesh& mesh = run.GetBlock(0).Surface->Mesh();
      double squares = 0.0;
      double area = 0.0;
      for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
      {
        const double w = mesh.ControlAreas()[i] * weights[mesh.InputVertex()[i]];
        const double difference = state(i, 0) - input.Data.Data.Values(mesh.InputVertex()[i], 0);
        squares += w * difference * difference;
        area += w;
      }
      differences.push_back(std::sqrt(squares / area));
    }
    EXPECT_GT(differences[0], 0.1);
    // Around the smallest risk the difference varies more than the error does.
    EXPECT_NEAR(differences[1], differences[0], 0.05 * differences[0]) << static_cast<int>(mode);
  }
}

TEST(Run, AutomaticFidelityWarnsOfTooFewValues)
{
  for (const Eigen::Index every : { 0, 100 })
  {
    RunInput input = NoisyCap(3);
    for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
    {
      input.Data.FidelityFactors.Values.push_back(every > 0 && i % every == 0 ? 1.0 : 0.0);
    }
    TotalVariationSettings settings;
    settings.AutomaticFidelity = true;
    SurfaceDiffusion::Run run(SerialFor());
    StateOf(run, { input.Block() }, settings);
    WarningLog log;
    const std::vector<Sentence> warnings = log.Report(run.FindWarnings(Alone));
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].Text().find("AutomaticFidelity finds too few known values, of a weight "
                                      "other than 0, to estimate the noise from"),
      std::string::npos)
      << warnings[0].Text();
  }
}

TEST(Run, AutomaticFidelityWarnsOfCorrelatedNoise)
{
  RunInput input(Testing::Icosphere(4));
  const auto mesh = Testing::MakeMesh(Testing::Icosphere(4));
  Values noise = Testing::Noise(*mesh);
  const double h = mesh->TotalEdgeLength() / mesh->NumberOfEdges() * mesh->LengthUnit();
  noise = Testing::Diffuse(std::make_shared<Assembler>(mesh), PointData::FromValues(noise), h * h,
    1, 0.0, Testing::Scheme::BackwardEuler);
  input.Data.Data.Values =
    Testing::ToInput(*mesh, noise, static_cast<Index>(input.Vertices.rows()));
  TotalVariationSettings settings;
  settings.Mode = TotalVariationMode::SteadyState;
  settings.AutomaticFidelity = true;
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, settings);
  WarningLog log;
  const std::vector<Sentence> warnings = log.Report(run.FindWarnings(Alone));
  ASSERT_FALSE(warnings.empty());
  EXPECT_NE(warnings[0].Text().find("the noise is correlated"), std::string::npos);
}

namespace
{

/// Counts the sums over processes, of which there is one.
class CountingReduction : public Reduction
{
public:
  CountingReduction()
    : Reduction(Reduction::Kind::Distributed)
  {
  }
  using Reduction::Sum;
  void Sum(double*, Index) const override { ++this->Sums; }
  mutable int Sums = 0;
};

class WholeSurface : public Decomposition
{
public:
  double FindLengthUnit() override { return 1.0; }
  void Attach(SurfaceDiffusion::Surface&, SolverStore&) override {}
  Index NumberOfCopies() const override { return 0; }
};

} // namespace

TEST(Run, MeasuresTheEdgesOfASurfaceOnce)
{
  const RunInput input(Testing::Icosphere(2));
  BlockInput block = input.Block();
  WholeSurface whole;
  block.Decomposition = &whole;
  const CountingReduction processes;
  SurfaceDiffusion::Run run(SerialFor());
  const auto update = [&]
  { run.Update({ block }, std::make_shared<HeatSettings>(), processes, ProgressMonitor()); };
  update();
  const int sums = processes.Sums;
  EXPECT_GT(sums, 0);
  update();
  EXPECT_EQ(processes.Sums, sums);
}

TEST(Run, FactorisesAgainOnlyIfTheMatrixChanges)
{
  RunInput input(Testing::Icosphere(4));
  HeatSettings settings;
  settings.Solver = SolverMethod::Direct;
  SurfaceDiffusion::Run run(SerialFor());
  const auto factorizationsAfterARun = [&]
  {
    StateOf(run, { input.Block() }, settings);
    return run.GetBlock(0).Solvers.Get(SolverPurpose::Step)->NumberOfFactorizations();
  };
  EXPECT_EQ(factorizationsAfterARun(), 1);
  input.Data.Data.Values(7, 0) += 1.0;
  EXPECT_EQ(factorizationsAfterARun(), 1);
  settings.NumberOfTimeSteps += 2;
  EXPECT_EQ(factorizationsAfterARun(), 1);
  settings.TimeStep *= 2.0;
  EXPECT_EQ(factorizationsAfterARun(), 2);
  input.Data.Data.Values(8, 0) += 1.0;
  EXPECT_EQ(factorizationsAfterARun(), 2);
}

template <typename ModelSettings>
void ExpectLongerRunsContinueShorterOnes(
  const RunInput& input, ModelSettings settings, std::initializer_list<int> lengths)
{
  SurfaceDiffusion::Run run(SerialFor());
  for (const int length : lengths)
  {
    settings.NumberOfTimeSteps = length;
    const Values state = StateOf(run, { input.Block() }, settings);
    SurfaceDiffusion::Run fresh(SerialFor());
    EXPECT_TRUE((state.array() == StateOf(fresh, { input.Block() }, settings).array()).all())
      << length << " steps, solver " << static_cast<int>(settings.Solver);
    EXPECT_EQ(run.MakeHistory(length).Records.size(), static_cast<std::size_t>(length) + 1);
  }
}

TEST(Run, ALongerRunComputesOnlyTheNewSteps)
{
  const RunInput input(Testing::Icosphere(3));
  SurfaceDiffusion::Run run(SerialFor());
  HeatSettings settings;
  settings.NumberOfTimeSteps = 20;
  StateOf(run, { input.Block() }, settings);
  settings.NumberOfTimeSteps = 22;
  StateOf(run, { input.Block() }, settings);
  EXPECT_EQ(run.NumberOfStepsComputed(), 22);
  settings.NumberOfTimeSteps = 5;
  settings.FWHM = 0.3;
  StateOf(run, { input.Block() }, settings);
  settings.NumberOfTimeSteps = 8; // other steps
  StateOf(run, { input.Block() }, settings);
  EXPECT_EQ(run.NumberOfStepsComputed(), 22 + 5 + 8);
}

/// Automatic chooses by the number of steps, too, and the result is still that of a fresh run.
TEST(Run, ALongerRunGivesTheBitsOfAFreshOne)
{
  const RunInput input(Testing::Icosphere(3));
  RunInput nothing(Testing::Icosphere(3));
  nothing.Data.Data.Values.resize(0, 0);
  for (const SolverMethod solver : { SolverMethod::Automatic, SolverMethod::Direct,
         SolverMethod::ConjugateGradient, SolverMethod::Multigrid })
  {
    HeatSettings heat;
    heat.Solver = solver;
    heat.TimeStep = 3.0;
    ExpectLongerRunsContinueShorterOnes(input, heat, { 0, 1, 3, 40, 42, 2, 300 });
    heat.FWHM = 0.3;
    ExpectLongerRunsContinueShorterOnes(input, heat, { 1, 3, 2 });
    TextureSettings texture;
    texture.Solver = solver;
    ExpectLongerRunsContinueShorterOnes(nothing, texture, { 2, 40, 10 });
  }
  TotalVariationSettings flow;
  ExpectLongerRunsContinueShorterOnes(input, flow, { 1, 4, 2 });
}

TEST(Run, EachWarningIsReportedOncePerCause)
{
  RunInput input(Testing::Icosphere(2));
  input.Faces.conservativeResize(input.Faces.rows() + 1, 3);
  input.Faces.bottomRows(1) << 0, 0, 6;
  input.Data.Data.Values = Values::Ones(input.Vertices.rows(), 1);
  SurfaceDiffusion::Run run(SerialFor());
  HeatSettings settings;
  WarningLog log;
  const auto update = [&]
  {
    StateOf(run, { input.Block() }, settings);
    return log.Report(run.FindWarnings(Alone));
  };
  EXPECT_EQ(update().size(), 1u); // a triangle of zero area
  run.Seek(3, ProgressMonitor());
  EXPECT_TRUE(log.Report(run.FindWarnings(Alone)).empty());
  settings.TimeStep = 0.5;
  EXPECT_TRUE(update().empty());
  input.Data.Data.Values(3, 0) = 2.0;
  EXPECT_TRUE(update().empty());
  input.Data.Mask.Values.assign(static_cast<std::size_t>(input.Vertices.rows()), 0);
  EXPECT_EQ(update().size(), 1u); // a mask without effect
  settings.TimeStep = 0.25;
  EXPECT_TRUE(update().empty());
  input.Data.Mask.Values[5] = 1;
  EXPECT_TRUE(update().empty());
  input.Data.Mask.Values[5] = 0;
  EXPECT_EQ(update().size(), 1u); // the mask had an effect in between
  input.Vertices.row(7) *= 1.1;
  EXPECT_EQ(update().size(), 1u); // another surface with such a triangle
}

TEST(Run, WithoutHistoryTheStatesAreTheSameAndTheHistoryComesWhenItIsWanted)
{
  const RunInput input(Testing::Icosphere(2));
  HeatSettings settings;
  SurfaceDiffusion::Run with(SerialFor());
  const Values state = StateOf(with, { input.Block() }, settings);
  SurfaceDiffusion::Run without(SerialFor());
  without.SetKeepsHistory(false);
  EXPECT_EQ(StateOf(without, { input.Block() }, settings), state);
  EXPECT_EQ(without.MakeHistory(10).Records.back().Energy, 0.0);

  without.SetKeepsHistory(true);
  EXPECT_EQ(StateOf(without, { input.Block() }, settings), state);
  EXPECT_EQ(
    without.MakeHistory(10).Records.back().Energy, with.MakeHistory(10).Records.back().Energy);
  EXPECT_GT(with.MakeHistory(10).Records.back().Energy, 0.0);

  const long long computed = without.NumberOfStepsComputed();
  without.SetKeepsHistory(false); // what is known stays
  EXPECT_EQ(StateOf(without, { input.Block() }, settings), state);
  EXPECT_EQ(without.NumberOfStepsComputed(), computed);
}

TEST(Run, ATextureThatGrewWithoutBoundsIsAsNewAfterTheCorrection)
{
  RunInput input(Testing::Icosphere(3));
  input.Data.Data.Values.resize(0, 0);
  for (const SolverMethod method : { SolverMethod::Automatic, SolverMethod::Direct,
         SolverMethod::ConjugateGradient, SolverMethod::Multigrid })
  {
    TextureSettings settings;
    settings.NumberOfTimeSteps = 40;
    settings.Solver = method;
    SurfaceDiffusion::Run fresh(SerialFor());
    const Values expected = StateOf(fresh, { input.Block() }, settings);
    TextureSettings wild = settings;
    wild.ClampToNonNegative = false;
    wild.TimeStep = 1e4;
    wild.StopTolerance = 0.0; // it would stop before the concentrations overflow
    SurfaceDiffusion::Run run(SerialFor());
    EXPECT_THROW(StateOf(run, { input.Block() }, wild), std::runtime_error);
    EXPECT_TRUE(StateOf(run, { input.Block() }, settings) == expected)
      << "solver " << static_cast<int>(method);
  }
}

TEST(Run, ATextureWithoutSteadyStateNeedsData)
{
  RunInput input(Testing::Icosphere(2));
  input.Data.Data.Values.resize(0, 0);
  for (const bool automatic : { false, true })
  {
    TextureSettings settings;
    settings.AutomaticTimeStep = automatic;
    WriteSetting(settings, "DecayRate", 17.0);
    SurfaceDiffusion::Run run(SerialFor());
    try
    {
      StateOf(run, { input.Block() }, settings);
      FAIL();
    }
    catch (const std::runtime_error& error)
    {
      EXPECT_NE(std::string(error.what()).find("no steady state"), std::string::npos);
    }
  }
}

TEST(Run, SmoothingOfAMapWithHolesIsNotBiased)
{
  // A smooth map with 20 % missing in patches: started from the harmonic function of the known
  // values, the result is near that of the full data.
  RunInput input(Testing::Icosphere(5));
  HeatSettings settings;
  settings.FWHM = 0.15;
  const auto patch = [&](Eigen::Index i)
  {
    const auto x = input.Vertices.row(i);
    return std::cos(9.0 * x[0]) * std::cos(9.0 * x[1]) * std::cos(9.0 * x[2]) > 0.3;
  };
  input.Data.Mask.Values.resize(static_cast<std::size_t>(input.Vertices.rows()));
  double missing = 0.0;
  for (Eigen::Index i = 0; i < input.Vertices.rows(); ++i)
  {
    input.Data.Data.Values(i, 0) =
      input.Vertices(i, 2) + 0.3 * std::sin(3.0 * input.Vertices(i, 0));
    input.Data.Mask.Values[static_cast<std::size_t>(i)] = patch(i);
    missing += patch(i);
  }
  EXPECT_NEAR(missing / static_cast<double>(input.Vertices.rows()), 0.2, 0.1);
  RunInput whole = input;
  whole.Data.Mask.Values.clear();
  const auto errorOf = [&](InitialFill fill)
  {
    SurfaceDiffusion::Run reference(SerialFor()), run(SerialFor());
    const Values u = StateOf(reference, { whole.Block() }, settings);
    settings.InitialFill = fill;
    const Values v = StateOf(run, { input.Block() }, settings);
    return Testing::RootMeanSquare(run.GetBlock(0).Surface->Mesh(), v - u);
  };
  const double mean = errorOf(InitialFill::Mean);
  const double harmonic = errorOf(InitialFill::Harmonic);
  std::printf("RMS to the full data: mean %.4f, harmonic %.4f\n", mean, harmonic);
  EXPECT_LT(harmonic, 0.03 * mean);
  EXPECT_EQ(HeatSettings().InitialFill, InitialFill::Harmonic);
  EXPECT_EQ(TotalVariationSettings().InitialFill, InitialFill::Mean);
}

TEST(Run, SteadyStateDoesNotDependOnTheInitialFillNorOnMissingData)
{
  RunInput input(Testing::Icosphere(3));
  input.Data.Mask.Values.assign(static_cast<std::size_t>(input.Vertices.rows()), 0);
  std::fill_n(input.Data.Mask.Values.begin(), 60, 1);
  HeatSettings settings;
  settings.Mode = HeatMode::SteadyState;
  settings.FidelityWeight = 0.5;
  std::vector<Values> states;
  for (const InitialFill fill :
    { InitialFill::Mean, InitialFill::Input, InitialFill::Noise, InitialFill::Harmonic })
  {
    settings.InitialFill = fill;
    SurfaceDiffusion::Run run(SerialFor());
    states.push_back(StateOf(run, { input.Block() }, settings));
    EXPECT_LT((states.back() - states.front()).cwiseAbs().maxCoeff(), 1e-9);
    input.Data.Data.Values(7, 0) += 0.3; // within the range of the data
  }
}

TEST(Run, NoiseOfTexturesHasTheWidthOfItsSettingAroundTheSteadyState)
{
  RunInput input(Testing::Icosphere(5));
  input.Data.Data.Values.resize(0, 0);
  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    TextureSettings settings;
    settings.Kinetics = static_cast<KineticsName>(k);
    settings.NumberOfTimeSteps = 0;
    const auto start = [&](double noise)
    {
      settings.InitialNoise = noise;
      SurfaceDiffusion::Run run(SerialFor());
      return StateOf(run, { input.Block() }, settings);
    };
    const Values steady = start(0.0);
    const bool isRelative = settings.Kinetics != KineticsName::FitzHughNagumo;
    const Values scale = isRelative ? steady : Values(Values::Ones(steady.rows(), 2));
    const Values noise = (start(0.2) - steady).cwiseQuotient(scale);
    EXPECT_LE(noise.cwiseAbs().maxCoeff() - 0.2, 1e-12) << k;
    EXPECT_NEAR(std::sqrt(noise.cwiseAbs2().mean()), 0.2 / std::sqrt(3.0), 1e-3) << k;
  }
}

TEST(Run, CoincidentPointsHaveRandomNumbersOfTheirOwn)
{
  const Testing::Surface sphere = Testing::Icosphere(2);
  RunInput input(Testing::Joined(sphere, sphere));
  input.Data.Data.Values.resize(0, 0);
  TextureSettings settings;
  settings.NumberOfTimeSteps = 0;
  SurfaceDiffusion::Run run(SerialFor());
  const Values u = StateOf(run, { input.Block() }, settings);
  const Surface& surface = *run.GetBlock(0).Surface;
  for (Index i = 0; i < sphere.NumberOfVertices(); ++i)
  {
    EXPECT_NE(u(surface.VertexOf(i), 0), u(surface.VertexOf(i + sphere.NumberOfVertices()), 0));
  }
}

TEST(DirectionFieldRun, IsKeptUntilInputsOrSettingsChange)
{
  const RunInput input(Testing::Cylinder(24, 24));
  DirectionFieldRun run(SerialFor());
  DirectionFieldSettings settings;
  int reads = 0;
  BlockInput block = input.Block();
  block.ReadFields = [&]
  {
    ++reads;
    return Fields();
  };
  run.Update(block, settings, ProgressMonitor());
  const auto directions = [&]() -> const Values& { return run.Outputs().front().Rows; };
  const Values first = directions();
  run.Update(block, settings, ProgressMonitor());
  EXPECT_EQ(reads, 1);
  settings.Angle = 90.0;
  run.Update(block, settings, ProgressMonitor());
  EXPECT_EQ(reads, 1); // the field is turned, not computed again
  double largest = 0.0; // the field is turned by a right angle
  for (Eigen::Index t = 0; t < first.rows(); ++t)
  {
    largest = std::max(largest, std::abs(first.row(t).dot(directions().row(t))));
  }
  EXPECT_LT(largest, 1e-12);
  settings.Angle = 0.0;
  run.Update(block, settings, ProgressMonitor());
  EXPECT_EQ(directions(), first);
  settings.PrincipalDirection = 1;
  run.Update(block, settings, ProgressMonitor());
  EXPECT_EQ(reads, 2);
}

/// Results beside the state may take half of a run, such as the curves of edges.
TEST(Run, ResultsAreFinishedAgainOnlyIfTheirStepOrSettingsChange)
{
  struct Counted : HeatSettings
  {
    int* Count = nullptr;
    std::vector<Output> Finish(const RunState& state, RunResult& result) const override
    {
      ++*this->Count;
      return this->HeatSettings::Finish(state, result);
    }
  };
  RunInput input(Testing::Icosphere(2));
  SurfaceDiffusion::Run run(SerialFor());
  int count = 0;
  Counted settings;
  settings.Count = &count;
  settings.NumberOfTimeSteps = 4;
  StateOf(run, { input.Block() }, settings);
  StateOf(run, { input.Block() }, settings);
  EXPECT_EQ(count, 1);
  run.Seek(2, ProgressMonitor());
  EXPECT_EQ(count, 2);
  StateOf(run, { input.Block() }, settings);
  EXPECT_EQ(count, 3);
  settings.OutputInterval = 2; // any setting that results may depend on
  StateOf(run, { input.Block() }, settings);
  EXPECT_EQ(count, 4);
  settings.TimeStep = 0.5;
  StateOf(run, { input.Block() }, settings);
  EXPECT_EQ(count, 5);
  input.Data.Data.Values(3, 0) += 1.0;
  StateOf(run, { input.Block() }, settings);
  EXPECT_EQ(count, 6);
}

} // namespace SurfaceDiffusion
