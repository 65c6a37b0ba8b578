// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Heat.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

Values SteadyState(
  std::shared_ptr<const Assembler> assembler, const PointData& data, double fidelity = 0.0)
{
  const auto heat = MakeHeat(std::move(assembler), data, { 1.0, fidelity, Scheme::SteadyState });
  Advance(*heat, 1);
  return heat->State();
}

} // namespace

TEST(SteadyState, ComponentsHeldAndNotHeldStandSideBySide)
{
  const auto assembler = MakeAssembler(Joined(Disk(4), Icosphere(2)));
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Noise(mesh));
  const Index second = mesh.ComponentsBegin()[1];
  data.Fixed[second] = true;
  data.Start(second, 0) = 5.0;
  const Values u = SteadyState(assembler, data);
  EXPECT_LT((u.bottomRows(u.rows() - second).array() - 5.0).abs().maxCoeff(), 1e-12);
  const auto areas = mesh.ControlAreas().head(second);
  const double mean = areas.dot(data.Start.col(0).head(second)) / areas.sum();
  EXPECT_LT((u.topRows(second).array() - mean).abs().maxCoeff(), 1e-14);
}

TEST(SteadyState, IsWhatLongTimesLeadTo)
{
  const auto assembler = MakeAssembler(Jittered(Strip(15, 15), 0.02, 0, 1, 0, 1));
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(Noise(mesh, 2));
  data.Fixed.head(5) = true;
  data.Missing.segment(40, 60) = true;
  for (const double lambda : { 0.0, 4.0 })
  {
    const Values limit = SteadyState(assembler, data, lambda);
    const auto heat = MakeHeat(assembler, data, { 1.0, lambda, Scheme::SDIRK2 });
    Advance(*heat, 100);
    EXPECT_LT((heat->State() - limit).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(SteadyState, FurtherStepsChangeNothing)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  PointData data = PointData::FromValues(Noise(assembler->Mesh()));
  data.Fixed.head(3) = true;
  const auto heat = MakeHeat(assembler, data, { 1.0, 2.0, Scheme::SteadyState });
  Advance(*heat, 1);
  const Values once = heat->State();
  Advance(*heat, 2);
  EXPECT_LT((heat->State() - once).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(SteadyState, MinimisesTheEnergy)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  const TriangleMesh& mesh = assembler->Mesh();
  const Values f = Noise(mesh);
  const auto heat =
    MakeHeat(assembler, PointData::FromValues(f), { 1.0, 3.0, Scheme::SteadyState });
  Advance(*heat, 1);
  const double least = heat->Energy();
  const Values minimiser = heat->State();
  for (int trial = 0; trial < 5; ++trial)
  {
    const Values other = minimiser + 0.01 * Noise(mesh, 1, 100 + trial);
    heat->Restore(other.data());
    EXPECT_GT(heat->Energy(), least);
  }
}
