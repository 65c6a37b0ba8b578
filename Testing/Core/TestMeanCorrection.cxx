// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Operators/MeanCorrection.h"
#include "Heat.h"
#include "Meshes.h"

#include <gtest/gtest.h>

#include <functional>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

struct Kind
{
  const char* Name;
  std::function<std::unique_ptr<LinearSolver>()> Make;
};

void PrintTo(const Kind& kind, std::ostream* out)
{
  *out << kind.Name;
}

std::unique_ptr<LinearSolver> LooseConjugateGradients()
{
  auto solver = MakeConjugateGradientSolver();
  solver->SetLimits({ 1e-3, 1000 });
  return solver;
}

class WithSolver : public ::testing::TestWithParam<Kind>
{
};

/// Largest over components and columns of the change of sum A u, relative to sum A |u0|.
double Drift(const TriangleMesh& mesh, const Values& start, const Values& u)
{
  double drift = 0.0;
  for (Index c = 0; c < mesh.NumberOfComponents(); ++c)
  {
    const Index begin = mesh.ComponentsBegin()[c];
    const Index size = mesh.ComponentsBegin()[c + 1] - begin;
    const auto areas = mesh.ControlAreas().segment(begin, size);
    for (Eigen::Index k = 0; k < u.cols(); ++k)
    {
      const double before = areas.dot(start.col(k).segment(begin, size));
      const double after = areas.dot(u.col(k).segment(begin, size));
      const double scale = areas.dot(start.col(k).segment(begin, size).cwiseAbs());
      drift = std::max(drift, std::abs(after - before) / scale);
    }
  }
  return drift;
}

} // namespace

TEST_P(WithSolver, SumIsKeptOnEveryComponentByEveryScheme)
{
  for (const Surface& s : { Icosphere(3), Moebius(41, 4), ThreeFins(6),
         Jittered(Strip(20, 20), 0.015, 0, 1, 0, 1), Joined(Disk(5), Icosphere(2)) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values start = Noise(mesh, 3);
    for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::SteadyState })
    {
      for (const double lambda : { 0.0, 2.0 }) // (16) conserves too when it starts from f
      {
        const auto heat = MakeHeat(assembler, PointData::FromValues(start),
          HeatSettings(mesh, 0.05, lambda, scheme), GetParam().Make());
        for (int step = 0; step < 20; ++step)
        {
          heat->Advance(ProgressMonitor());
          EXPECT_LT(Drift(mesh, start, heat->State()), 1e-12);
        }
      }
    }
  }
}

TEST_P(WithSolver, SumIsKeptAtAnyOffsetOfTheData)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const Values start = (Noise(assembler->Mesh()).array() + 1e6).matrix();
  const auto heat = MakeHeat(assembler, PointData::FromValues(start),
    HeatSettings(assembler->Mesh(), 0.05), GetParam().Make());
  Advance(*heat, 20);
  EXPECT_LT(Drift(assembler->Mesh(), start, heat->State()), 1e-12);
}

TEST_P(WithSolver, SumIsKeptOverManySteps)
{
  const auto assembler = MakeAssembler(Icosphere(1));
  const Values start = Noise(assembler->Mesh());
  const auto heat = MakeHeat(assembler, PointData::FromValues(start),
    HeatSettings(assembler->Mesh(), 1e-5), GetParam().Make());
  Advance(*heat, 20000);
  EXPECT_LT(Drift(assembler->Mesh(), start, heat->State()), 1e-14);
}

TEST_P(WithSolver, InpaintingWithoutFidelityKeepsTheSum)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  PointData data = PointData::FromValues(Noise(assembler->Mesh()));
  data.Missing.head(100) = true;
  data.Start.topRows(100).setConstant(0.5);
  const auto heat =
    MakeHeat(assembler, data, HeatSettings(assembler->Mesh(), 0.05), GetParam().Make());
  Advance(*heat, 10);
  EXPECT_LT(Drift(assembler->Mesh(), data.Start, heat->State()), 1e-12);
}

/// Columns are solved sixteen at a time.
TEST(TotalCorrection, EveryColumnOfManyKeepsItsOwnTotal)
{
  const auto assembler = MakeAssembler(Joined(Icosphere(2), Disk(6)));
  const TriangleMesh& mesh = assembler->Mesh();
  Values start = Noise(mesh, 37);
  for (Eigen::Index k = 0; k < start.cols(); ++k)
  {
    start.col(k).array() += 0.3 * static_cast<double>(k);
  }
  for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2 })
  {
    const auto heat = MakeHeat(assembler, PointData::FromValues(start),
      HeatSettings(mesh, 0.02, 0.0, scheme), LooseConjugateGradients());
    Advance(*heat, 3);
    EXPECT_GT((heat->State() - start).cwiseAbs().maxCoeff(), 0.1);
    EXPECT_LT(Drift(mesh, start, heat->State()), 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(TotalCorrection, WithSolver,
  ::testing::Values(Kind{ "Cholesky", [] { return MakeCholeskySolver(); } },
    Kind{ "ConjugateGradient", [] { return MakeConjugateGradientSolver(); } },
    Kind{ "LooseConjugateGradient", LooseConjugateGradients }),
  [](const auto& parameter) { return parameter.param.Name; });

TEST(TotalCorrection, TotalIsTheWeightedSum)
{
  const auto mesh = MakeMesh(Icosphere(2));
  const Values u = Noise(*mesh, 2);
  EXPECT_NEAR(Total(*mesh, u, 1), mesh->ControlAreas().dot(u.col(1)), 1e-14);
}

TEST(MeanCorrection, SolutionsSatisfyTheSumOfTheEquations)
{
  const auto mesh = MakeMesh(Joined(Disk(3), Icosphere(1)));
  const Index n = mesh->NumberOfVertices();
  const Vector weights = mesh->ControlAreas() * 3.0;
  Flags fixed = Flags::Constant(n, false);
  fixed[mesh->ComponentsBegin()[1]] = true; // the second component is left alone
  MeanCorrection balance(*mesh, weights, fixed);
  const Values b = Noise(*mesh, 2);
  const Values before = Noise(*mesh, 2, 5);
  Values x = before;
  balance.Restore(*mesh, b, x, SerialFor());
  const Index first = mesh->ComponentsBegin()[1];
  for (const Eigen::Index k : { 0, 1 })
  {
    EXPECT_NEAR(weights.head(first).dot(x.col(k).head(first)), b.col(k).head(first).sum(), 1e-14);
    const Vector change = (x - before).col(k);
    EXPECT_NEAR(change.head(first).maxCoeff(), change.head(first).minCoeff(), 1e-14);
    EXPECT_TRUE(change.tail(n - first).isZero(0.0));
  }
}
