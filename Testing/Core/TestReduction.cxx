// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/ProgressMonitor.h"
#include "Core/Foundation/Reduction.h"
#include "Core/Models/InitialState.h"
#include "Core/Models/Textures/TextureColors.h"
#include "Core/Operators/MeanCorrection.h"
#include "Meshes.h"
#include "Run/SolverStore.h"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// As if another process had just the same, and elsewhere joined the first two
/// components.
class Twin : public Reduction
{
public:
  explicit Twin(Index vertices)
    : Reduction(Reduction::Kind::Distributed)
  {
    this->NumberOfComponents = 2;
    this->SurfaceComponent = { 0, 0, 1 };
    this->OwnedVertices.assign(vertices, true);
    this->OwnedVertices[0] = false; // the other counts it
  }
  using Reduction::Sum;
  void Sum(double* numbers, Index count) const override
  {
    for (Index i = 0; i < count; ++i)
    {
      numbers[i] *= 2.0;
    }
  }
  void Max(double*, Index) const override {}
};

/// As if all vertices were on the interface with a process that has the same
/// values.
class Equal : public Twin
{
public:
  explicit Equal(Index vertices)
    : Twin(vertices)
  {
    this->VerticesOnInterface.resize(vertices);
    std::iota(this->VerticesOnInterface.begin(), this->VerticesOnInterface.end(), 0);
  }
  void AccumulateInterface(double* rows, Index columns) const override
  {
    for (Index i = 0; i < static_cast<Index>(this->OwnedVertices.size()) * columns; ++i)
    {
      rows[i] *= 2.0;
    }
  }
};

std::shared_ptr<TriangleMesh> ThreeSpheres(bool inPieces)
{
  const Surface spheres = Joined(Joined(Icosphere(1), Icosphere(1)), Icosphere(1));
  auto mesh = std::make_shared<TriangleMesh>(spheres.Vertices, spheres.Faces);
  if (inPieces)
  {
    mesh->SetReduction(std::make_shared<Twin>(mesh->NumberOfVertices()));
  }
  return mesh;
}

/// As if one of the processes was asked to stop.
class Stopping : public Twin
{
public:
  using Twin::Twin;
  void Sum(double*, Index) const override { throw Aborted(); }
};

} // namespace

TEST(Reduction, AccumulatedVectorsBecomeConsistentBeforeTheyAreUsed)
{
  const Equal equal(3000);
  for (const Reduction* reduction : { &Reduction::Serial(), static_cast<const Reduction*>(&equal) })
  {
    Values here(3000, 2);
    double sum = 0.0;
    reduction->AccumulateEach(
      SerialFor(), here, [&](Index i) { here.row(i) << i, 1.0; },
      [&](Index i) { sum += here(i, 0) + here(i, 1); });
    const double factor = reduction->IsSerial() ? 1.0 : 2.0;
    EXPECT_EQ(sum, factor * (3000 * 2999 / 2 + 3000));
    Vector storage;
    const Vector ones = Vector::Ones(3000);
    EXPECT_EQ(reduction->Accumulated(ones, storage), factor * ones);
    EXPECT_EQ(reduction->OwnedPart(ones, storage).sum(), reduction->IsSerial() ? 3000.0 : 2999.0);
  }
}

TEST(Reduction, TotalsAreThoseOfAllProcesses)
{
  const auto mesh = ThreeSpheres(true);
  const Values u = Noise(*mesh, 2);
  EXPECT_NEAR(Total(*mesh, u, 1), 2.0 * mesh->ControlAreas().dot(u.col(1)), 1e-13);
}

TEST(Reduction, VerticesOnInterfacesCountOnce)
{
  const Twin twin(5);
  const auto one = [](Index) { return 1.0; };
  EXPECT_EQ(twin.SumOverVertices(SerialFor(), 5, one), 8.0);
  EXPECT_EQ(Reduction::Serial().SumOverVertices(SerialFor(), 5, one), 5.0);
}

TEST(Reduction, PercentilesAreThoseOfAllProcesses)
{
  Vector here = Vector::Random(201);
  here[0] = 5.0; // not owned
  Vector all(400);
  all << here.tail(200), here.tail(200);
  const Twin twin(201);
  EXPECT_EQ(ContrastLimits(here, twin), ContrastLimits(all));
}

TEST(Reduction, ComponentsThatMeetElsewhereAreFilledWithOneMean)
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

TEST(Reduction, ComponentsThatMeetElsewhereConserveTheirSumTogether)
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

/// The surface is kept for the next update, and its processes with it.
TEST(SolverStore, KeepsProcessesThatAreAskedToStop)
{
  SolverStore solvers;
  EXPECT_NO_THROW(solvers.SetProcesses(std::make_shared<const Stopping>(3), 3));
}
