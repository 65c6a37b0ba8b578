// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Fidelity.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Distances of 3 and 4 in two channels at every vertex of a sphere, the first
/// vertex missing.
struct Problem
{
  std::shared_ptr<const TriangleMesh> Mesh = MakeMesh(Icosphere(1));
  PointData Data = PointData::FromValues(Noise(*Mesh, 2));
  Values U = Data.Given;
  double KnownArea;

  Problem()
  {
    this->U.col(0).array() += 3.0;
    this->U.col(1).array() -= 4.0;
    this->Data.Missing[0] = true;
    this->KnownArea = this->Mesh->ControlAreas().sum() - this->Mesh->ControlAreas()[0];
  }

  double Energy(const Fidelity::Settings& settings) const
  {
    return Fidelity(this->Data, settings).Energy(*this->Mesh, this->U, SerialFor());
  }
};

} // namespace

TEST(Fidelity, EnergyIsThatOfTheNormOverTheKnownPart)
{
  const Problem p;
  const double area = p.KnownArea;
  EXPECT_EQ(p.Energy({}), 0.0);
  EXPECT_NEAR(p.Energy({ 2.0 }), 2.0 * 0.5 * 25.0 * area, 1e-12);
  EXPECT_NEAR(p.Energy({ 2.0, FidelityNorm::L1 }), 2.0 * 5.0 * area, 1e-12);
  EXPECT_NEAR(
    p.Energy({ 2.0, FidelityNorm::L1, ChannelCoupling::PerChannel }), 2.0 * 7.0 * area, 1e-12);
  EXPECT_NEAR(p.Energy({ 2.0, FidelityNorm::L1, ChannelCoupling::Joint, 12.0 }), 2.0 * area,
    1e-12); // sqrt(25 + 144) - 12
}

TEST(Fidelity, WeightIsTheSlopeOfTheEnergyOverTheDistance)
{
  Problem p;
  for (const double delta : { 0.0, 12.0 })
  {
    for (const FidelityNorm norm : { FidelityNorm::L2, FidelityNorm::L1 })
    {
      const Fidelity fidelity(p.Data, { 2.0, norm, ChannelCoupling::Joint, delta });
      const double h = 1e-5;
      double energies[2];
      for (const int side : { 0, 1 })
      {
        Values u = p.U;
        u(3, 0) += (2 * side - 1) * h;
        energies[side] = fidelity.Energy(*p.Mesh, u, SerialFor());
      }
      const double slope = (energies[1] - energies[0]) / (2.0 * h * p.Mesh->ControlAreas()[3]);
      EXPECT_NEAR(fidelity.Weight(3, p.U, 0, 2) * 3.0, slope, 1e-5);
      EXPECT_EQ(fidelity.Weight(0, p.U, 0, 2), 0.0);
    }
  }
}

TEST(Fidelity, LinesTakeTheNearerOfBothSigns)
{
  Problem p;
  Fidelity::Settings settings;
  settings.Weight = 1.0;
  settings.LineField = true;
  const Fidelity fidelity(p.Data, settings);
  const Values opposite = -p.Data.Given;
  EXPECT_EQ(fidelity.Energy(*p.Mesh, opposite, SerialFor()), 0.0);
  EXPECT_EQ(fidelity.Sign(1, opposite), -1.0);
  EXPECT_EQ(fidelity.Sign(1, p.Data.Given), 1.0);
}

TEST(Fidelity, OnlySquaresConserve)
{
  const Problem p;
  EXPECT_TRUE(Fidelity(p.Data, { 1.0 }).CanConserve());
  EXPECT_FALSE(Fidelity(p.Data, { 1.0, FidelityNorm::L1 }).CanConserve());
  EXPECT_TRUE(Fidelity(p.Data, { 0.0, FidelityNorm::L1 }).CanConserve());
}
