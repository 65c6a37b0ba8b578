// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Properties that every exact step of a convex model has, for any data.

#include "Heat.h"
#include "TotalVariation.h"

#include <gtest/gtest.h>

#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Noise with missing and fixed vertices: the same ones for every seed, and the same fixed values.
PointData MaskedNoise(const TriangleMesh& mesh, std::int64_t seed)
{
  PointData data = PointData::FromValues(Noise(mesh, 2, seed));
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    data.Missing[i] = i % 5 == 0;
    data.Fixed[i] = i % 7 == 3;
    if (data.Fixed[i])
    {
      data.Start.row(i).setConstant(0.1 * (i % 11));
      data.Given.row(i) = data.Start.row(i);
    }
    else if (data.Missing[i])
    {
      data.Start.row(i).setConstant(0.25);
    }
  }
  return data;
}

/// The root of sum A |u|^2 over all vertices, or over the known ones.
double Norm(const TriangleMesh& mesh, const Values& u, const Flags& missing, bool known)
{
  double sum = 0.0;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    sum += known && missing[i] ? 0.0 : mesh.ControlAreas()[i] * u.row(i).squaredNorm();
  }
  return std::sqrt(sum);
}

} // namespace

TEST(ConvexSteps, MinimisersAreNoFartherApartThanTheirData)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData one = MaskedNoise(mesh, 1);
  const PointData other = MaskedNoise(mesh, 2);
  for (const ChannelCoupling coupling : { ChannelCoupling::Joint, ChannelCoupling::PerChannel })
  {
    for (const EdgeFunctionKind kind : { EdgeFunctionKind::TotalVariation,
           EdgeFunctionKind::Charbonnier, EdgeFunctionKind::Constant })
    {
      for (const double timeStep : { 0.0, 0.1 })
      {
        for (const double weight : { 1.0, 100.0 })
        {
          // A steady state depends on f, a step without fidelity on the start.
          const bool steady = timeStep == 0.0;
          auto settings = ExactSettings(mesh, timeStep, steady ? weight : 0.0, 1e-8);
          settings.Coupling = coupling;
          settings.Function.Kind = kind;
          const auto u = MakeExact(assembler, one, settings);
          const auto v = MakeExact(assembler, other, settings);
          const double errors =
            u->Advance(ProgressMonitor()).ErrorBound + v->Advance(ProgressMonitor()).ErrorBound;
          const Values data = steady ? one.Given - other.Given : one.Start - other.Start;
          EXPECT_LE(Norm(mesh, u->State() - v->State(), one.Missing, steady),
            Norm(mesh, data, one.Missing, steady) + errors * std::sqrt(mesh.ControlAreas().sum()))
            << static_cast<int>(kind) << ' ' << timeStep;
        }
      }
    }
  }
}

TEST(ConvexSteps, LinearDiffusionBringsStatesNoFartherApart)
{
  const auto assembler = MakeAssembler(Jittered(Strip(12, 12), 0.02, 0, 1, 0, 1));
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData one = MaskedNoise(mesh, 1);
  PointData other = MaskedNoise(mesh, 2);
  other.Given = one.Given; // fidelity pulls both to the same data
  for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::Exponential })
  {
    for (const double timeStep : { 1e-4, 1e-2, 1.0, 100.0 })
    {
      for (const double fidelity : { 0.0, 10.0 })
      {
        const Values u = Diffuse(assembler, one, timeStep, 1, fidelity, scheme);
        const Values v = Diffuse(assembler, other, timeStep, 1, fidelity, scheme);
        const double before = Norm(mesh, one.Start - other.Start, one.Missing, false);
        EXPECT_LE(Norm(mesh, u - v, one.Missing, false) - before, 1e-12 * before);
      }
    }
  }
}

TEST(ConvexSteps, LargerDataGiveLargerStatesOnAcuteMeshes)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  const PointData low = MaskedNoise(mesh, 1);
  PointData high = low;
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const double more = std::max(0.0, Noise(mesh, 1, 3)(i, 0));
    high.Given.row(i).array() += more;
    high.Start.row(i).array() += more;
  }
  for (const double timeStep : { 1e-3, 1.0 })
  {
    for (const double fidelity : { 0.0, 10.0 })
    {
      const Values u = Diffuse(assembler, low, timeStep, 2, fidelity, Scheme::BackwardEuler);
      const Values v = Diffuse(assembler, high, timeStep, 2, fidelity, Scheme::BackwardEuler);
      EXPECT_LT((u - v).maxCoeff(), 1e-12);
    }
  }
}

TEST(ConvexSteps, L1FidelityDoesNotDependOnTheContrast)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Values f = Cap(mesh, s, 1.0);
  for (Index i = 0; i < mesh.NumberOfVertices(); i += 13)
  {
    f(i, 0) = 1.0 - f(i, 0);
  }
  const auto solve = [&](double factor, double offset)
  {
    auto settings = ExactSettings(mesh, 0.0, 8.0, 1e-6);
    settings.Norm = FidelityNorm::L1;
    const auto flow =
      MakeExact(assembler, PointData::FromValues((factor * f.array() + offset).matrix()), settings);
    flow->Advance(ProgressMonitor());
    return std::make_pair(flow->State(), flow->Energy());
  };
  const auto [u, energy] = solve(1.0, 0.0);
  EXPECT_LT(RootMeanSquare(mesh, u - Cap(mesh, s, 1.0)), 0.1); // impulses are removed
  for (const double factor : { 3.0, 0.01, -1.0 })
  {
    for (const double offset : { 0.0, 5.0 })
    {
      const auto [v, scaled] = solve(factor, offset);
      EXPECT_NEAR(scaled, std::abs(factor) * energy, 1e-5 * std::abs(factor) * energy);
      EXPECT_LT((v - (factor * u.array() + offset).matrix()).cwiseAbs().maxCoeff(),
        1e-3 * std::abs(factor));
    }
  }
}
