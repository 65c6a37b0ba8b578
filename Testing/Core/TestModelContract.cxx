// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// A run that was aborted within any loop is kept, and the next update continues it. It gives the
// bits of a run that was never aborted: nothing that was half filled is taken for complete, and no
// data are left changed. SURFACEDIFFUSION_LONG in the environment selects every loop.
#include "Meshes.h"
#include "RunInput.h"

#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/SegmentationSettings.h"
#include "Run/TensorDiffusionSettings.h"
#include "Run/TextureSettings.h"
#include "Run/TotalVariationSettings.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <string>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Serial loops, one of which is aborted in its middle.
class AbortedFor : public ParallelFor
{
public:
  void Run(Index count, LoopBody body) const override
  {
    if (--this->Left == 0)
    {
      body(0, count / 2);
      throw Aborted();
    }
    body(0, count);
  }
  void RunTasks(Index count, LoopBody body) const override { this->Run(count, body); }

  mutable long Left = 0; ///< the number of the loop that is aborted, or 0
};

struct Kind
{
  const char* Name;
  std::function<std::shared_ptr<RunSettings>()> Make;
};

template <typename Settings>
Kind MakeKind(const char* name, int steps, const std::function<void(Settings&)>& set)
{
  return { name,
    [=]() -> std::shared_ptr<RunSettings>
    {
      auto settings = std::make_shared<Settings>();
      settings->NumberOfTimeSteps = steps;
      set(*settings);
      return settings;
    } };
}

std::vector<Kind> AllKinds()
{
  using Heat = HeatSettings;
  using TV = TotalVariationSettings;
  using Harmonic = HarmonicMapSettings;
  using Shah = MumfordShahSettings;
  using Tensor = TensorDiffusionSettings;
  return {
    MakeKind<Heat>("Heat", 3, [](Heat&) {}),
    MakeKind<Heat>("HeatMultigrid", 2, [](Heat& s) { s.Solver = SolverMethod::Multigrid; }),
    MakeKind<Heat>("HeatDelaunay", 1, [](Heat& s) { s.IntrinsicDelaunay = true; }),
    MakeKind<Heat>("HeatDeblurring", 1,
      [](Heat& s)
      {
        s.Mode = HeatMode::SteadyState;
        s.FidelityWeight = 2.0;
        s.Blur.FWHM = 0.15;
      }),
    MakeKind<Heat>("HeatAutomaticFidelity", 2, [](Heat& s) { s.AutomaticFidelity = true; }),
    MakeKind<TV>("TV", 2, [](TV&) {}),
    MakeKind<TV>("TVImplicit", 1,
      [](TV& s) { s.TimeIntegrator = SurfaceDiffusion::TimeIntegrator::Implicit; }),
    MakeKind<TV>("TVAbsolute", 1,
      [](TV& s)
      {
        s.TimeIntegrator = SurfaceDiffusion::TimeIntegrator::Implicit;
        s.FidelityNorm = FidelityNorm::L1;
      }),
    MakeKind<TV>("TVDeblurring", 1,
      [](TV& s)
      {
        s.Mode = TotalVariationMode::SteadyState;
        s.Blur.FWHM = 0.15;
        s.StopTolerance = 1e-2;
      }),
    MakeKind<TV>(
      "CrouzeixRaviart", 2, [](TV& s) { s.Discretization = Discretization::CrouzeixRaviart; }),
    MakeKind<Harmonic>("Harmonic", 2, [](Harmonic&) {}),
    MakeKind<Harmonic>("HarmonicMinimizing", 1,
      [](Harmonic& s) { s.Scheme = HarmonicMap::Scheme::MinimizingMovement; }),
    MakeKind<Harmonic>("HarmonicLines", 2, [](Harmonic& s) { s.LineField = true; }),
    MakeKind<Shah>("MumfordShah", 40, [](Shah&) {}),
    MakeKind<Tensor>("Beltrami", 2, [](Tensor&) {}),
    MakeKind<Tensor>(
      "CoherenceEnhancing", 2, [](Tensor& s) { s.Model = TensorModel::CoherenceEnhancing; }),
    MakeKind<TextureSettings>("Texture", 3, [](TextureSettings&) {}),
    MakeKind<TextureSettings>(
      "TextureCoarseStart", 40, [](TextureSettings& s) { s.CoarseStartSize = 2000; }),
    MakeKind<SegmentationSettings>(
      "Segmentation", 1, [](SegmentationSettings& s) { s.StopTolerance = 0.1; }),
  };
}

/// A noisy step around 100, and the position's direction for maps to the sphere.
RunInput MakeInput(const RunSettings& settings)
{
  RunInput input(Plate(70, 1.0)); // loops over vertices have several blocks
  const auto n = input.Vertices.rows();
  if (dynamic_cast<const TextureSettings*>(&settings))
  {
    input.Data.Data.resize(0, 0);
    return input;
  }
  const bool isMap = dynamic_cast<const HarmonicMapSettings*>(&settings) != nullptr;
  input.Data.Data.resize(n, isMap ? 3 : 1);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    for (Eigen::Index k = 0; k < input.Data.Data.cols(); ++k)
    {
      input.Data.Data(i, k) = (isMap ? (k == 2 ? 3.0 : 0.0) : 100.0) +
        (input.Vertices(i, 0) > 0.1 ? 1.0 : 0.0) + UniformRandom(3, k, i);
    }
  }
  for (Eigen::Index i = 0; i < 30; ++i)
  {
    input.Data.Data.row(i + n / 2).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return input;
}

Values Compute(
  SurfaceDiffusion::Run& run, const BlockInput& input, const std::shared_ptr<RunSettings>& settings)
{
  run.Update({ input }, settings, Alone, ProgressMonitor());
  run.Seek(settings->DescribeModel().NumberOfSteps, ProgressMonitor());
  return run.GetBlock(0).Path->State();
}

class AbortedRuns : public testing::TestWithParam<Kind>
{
};

void PrintTo(const Kind& kind, std::ostream* os)
{
  *os << kind.Name;
}

} // namespace

TEST_P(AbortedRuns, ContinueAfterAnAbortInAnyLoop)
{
  const std::shared_ptr<RunSettings> settings = this->GetParam().Make();
  const RunInput input = MakeInput(*settings);
  AbortedFor loops;
  SurfaceDiffusion::Run reference(loops);
  const Values expected = Compute(reference, input.Block(), settings);
  ASSERT_TRUE(expected.allFinite());
  const long all = -loops.Left;
  const bool isLong = std::getenv("SURFACEDIFFUSION_LONG") != nullptr;
  for (long place = 1; place <= all; place += isLong ? 1 + place / 100 : 1 + all / 25)
  {
    SurfaceDiffusion::Run run(loops);
    loops.Left = place;
    ASSERT_THROW(Compute(run, input.Block(), settings), Aborted) << place;
    loops.Left = 0;
    ASSERT_TRUE(Compute(run, input.Block(), settings) == expected)
      << "loop " << place << " of " << all;
  }
}

INSTANTIATE_TEST_SUITE_P(Core, AbortedRuns, testing::ValuesIn(AllKinds()),
  [](const auto& kind) { return std::string(kind.param.Name); });
