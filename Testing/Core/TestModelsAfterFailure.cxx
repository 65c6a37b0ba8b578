// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HarmonicMaps.h"
#include "Heat.h"
#include "RunInput.h"

#include "Core/Models/NonlinearDiffusion.h"
#include "Core/Solvers/SolverChoice.h"
#include "Run/TextureSettings.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

// A solver is kept from model to model. After a model that failed, the next one with the same
// solver has the bits that it has with a new solver.

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

using MakeModel =
  std::function<std::unique_ptr<Model>(PointData data, std::shared_ptr<LinearSolver> solver)>;

std::vector<std::shared_ptr<LinearSolver>> AllSolvers()
{
  return { MakeCholeskySolver(), MakeConjugateGradientSolver(), MakeMultigridSolver(),
    MakeSolver(SolverChoice{ SolverMethod::ConjugateGradient, true }),
    MakeSolver(SolverChoice{ SolverMethod::Direct, true }) };
}

void ExpectSameBitsAfterFailure(const Values& start, const MakeModel& make)
{
  for (const double wrong :
    { std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity() })
  {
    const auto kept = AllSolvers();
    const auto fresh = AllSolvers();
    for (std::size_t s = 0; s < kept.size(); ++s)
    {
      Values bad = start;
      bad(5, 0) = wrong;
      EXPECT_THROW(Advance(*make(PointData::FromValues(bad), kept[s]), 1), std::runtime_error)
        << "solver " << s;
      const auto after = make(PointData::FromValues(start), kept[s]);
      const auto expected = make(PointData::FromValues(start), fresh[s]);
      Advance(*after, 2);
      Advance(*expected, 2);
      EXPECT_TRUE(after->State().allFinite()) << "solver " << s;
      EXPECT_TRUE(after->State() == expected->State()) << "solver " << s << ", " << wrong;
    }
  }
}

} // namespace

TEST(ModelsAfterFailure, LinearDiffusionIsAsNew)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  ExpectSameBitsAfterFailure(Noise(assembler->Mesh(), 2),
    [&](PointData data, std::shared_ptr<LinearSolver> solver)
    {
      return MakeHeat(
        assembler, std::move(data), HeatSettings(assembler->Mesh(), 0.01), std::move(solver));
    });
}

TEST(ModelsAfterFailure, NonlinearDiffusionIsAsNew)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  ExpectSameBitsAfterFailure(Noise(assembler->Mesh()),
    [&](PointData data, std::shared_ptr<LinearSolver> solver)
    {
      NonlinearDiffusion::Settings settings;
      settings.TimeStep = 0.01;
      return std::make_unique<NonlinearDiffusion>(
        assembler, TangentVectors(), std::move(data), settings, std::move(solver), SerialFor());
    });
}

TEST(ModelsAfterFailure, HarmonicMapsAreAsNew)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  for (const auto scheme :
    { HarmonicMap::Scheme::ExplicitReaction, HarmonicMap::Scheme::TangentPlane })
  {
    auto settings = MapSettings(assembler->Mesh(), 2.0, 0.1);
    settings.TimeScheme = scheme;
    ExpectSameBitsAfterFailure(RandomUnitVectors(assembler->Mesh(), 3),
      [&](PointData data, std::shared_ptr<LinearSolver> solver)
      { return MakeMap(assembler, std::move(data), settings, std::move(solver)); });
  }
}

TEST(ModelsAfterFailure, ATextureThatGrewWithoutBoundsIsAsNewAfterTheCorrection)
{
  RunInput input(Icosphere(3));
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
