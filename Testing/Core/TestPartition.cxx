// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/Partition.h"
#include "Core/Models/InitialState.h"
#include "Core/Models/TextureColors.h"
#include "Core/Operators/MeanCorrection.h"
#include "Meshes.h"

#include <gtest/gtest.h>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// As if another process had just the same, and elsewhere joined the first two components.
class Twin : public Partition
{
public:
  explicit Twin(Index vertices)
  {
    this->Components = 2;
    this->WholeComponents = { 0, 0, 1 };
    this->OwnedVertices.assign(vertices, true);
    this->OwnedVertices[0] = false; // the other counts it
  }
  void Sum(double* numbers, Index count) const override
  {
    for (Index i = 0; i < count; ++i)
    {
      numbers[i] *= 2.0;
    }
  }
  void Max(double*, Index) const override {}
  void TakeFromOwners(Values&) const override {}
  void AddOverSeams(double*, Index) const override {}
  void AddOverSeamEdges(double*) const override {}
};

std::shared_ptr<TriangleMesh> ThreeSpheres(bool inPieces)
{
  const Surface spheres = Joined(Joined(Icosphere(1), Icosphere(1)), Icosphere(1));
  auto mesh = std::make_shared<TriangleMesh>(spheres.Vertices, spheres.Faces);
  if (inPieces)
  {
    mesh->SetPartition(std::make_shared<Twin>(mesh->NumberOfVertices()));
  }
  return mesh;
}

} // namespace

TEST(Partition, TotalsAreThoseOfAllProcesses)
{
  const auto mesh = ThreeSpheres(true);
  const Values u = Noise(*mesh, 2);
  EXPECT_NEAR(Total(*mesh, u, 1), 2.0 * mesh->ControlAreas().dot(u.col(1)), 1e-13);
}

TEST(Partition, VerticesOnSeamsCountOnce)
{
  const Twin twin(5);
  const auto one = [](Index) { return 1.0; };
  EXPECT_EQ(SumOverVertices(&twin, SerialFor(), 5, one), 8.0);
  EXPECT_EQ(SumOverVertices(nullptr, SerialFor(), 5, one), 5.0);
}

TEST(Partition, PercentilesAreThoseOfAllProcesses)
{
  Vector here = Vector::Random(201);
  here[0] = 5.0; // not owned
  Vector all(400);
  all << here.tail(200), here.tail(200);
  const Twin twin(201);
  EXPECT_EQ(ContrastLimits(here, &twin), ContrastLimits(all));
}

TEST(Partition, ComponentsThatMeetElsewhereAreFilledWithOneMean)
{
  for (const bool inPieces : { false, true })
  {
    const auto mesh = ThreeSpheres(inPieces);
    Values f = Values::Constant(mesh->NumberOfVertices(), 1, 1.0);
    const Index second = mesh->ComponentsBegin()[1];
    const Index third = mesh->ComponentsBegin()[2];
    f.bottomRows(mesh->NumberOfVertices() - third).setConstant(5.0);
    PointData data = PointData::FromValues(f);
    data.Missing.segment(second, third - second) = true;
    FillMissing(*mesh, data, InitialFill::Mean, 0, {});
    EXPECT_NEAR(data.Start(second, 0), inPieces ? 1.0 : 3.0, 1e-13);
  }
}

TEST(Partition, ComponentsThatMeetElsewhereConserveTheirSumTogether)
{
  for (const bool inPieces : { false, true })
  {
    const auto mesh = ThreeSpheres(inPieces);
    const PointData data = PointData::FromValues(Noise(*mesh, 1));
    TotalCorrection conserved(*mesh, data, false);
    Values u = data.Start;
    const Index second = mesh->ComponentsBegin()[1];
    u.topRows(second).array() += 1.0; // a third of the surface, half of the first two components
    conserved.Restore(*mesh, u, SerialFor());
    EXPECT_NEAR(u(0, 0) - data.Start(0, 0), inPieces ? 0.5 : 0.0, 1e-12);
    EXPECT_NEAR(u(second, 0) - data.Start(second, 0), inPieces ? -0.5 : 0.0, 1e-12);
    const Index last = mesh->NumberOfVertices() - 1;
    EXPECT_NEAR(u(last, 0), data.Start(last, 0), 1e-12);
  }
}
