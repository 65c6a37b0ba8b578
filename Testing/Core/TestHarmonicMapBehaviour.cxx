// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Harmonic/UnitVectors.h"
#include "HarmonicMaps.h"
#include "Heat.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

const MapScheme AllSchemes[] = { MapScheme::ExplicitReaction, MapScheme::TangentPlane,
  MapScheme::MinimizingMovement };

/// A map into the plane's circle that turns `turns` times around the origin of a disk; the origin
/// itself has no direction.
PointData Hedgehog(const TriangleMesh& mesh, const Surface& s, double turns)
{
  Values f(mesh.NumberOfVertices(), 2);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector3d x = s.Vertices.row(mesh.InputVertex()[i]);
    const double angle = turns * std::atan2(x[1], x[0]);
    f.row(i) << std::cos(angle), std::sin(angle);
    f.row(i) *= x.norm() > 0.0 ? 1.0 : 0.0;
  }
  PointData data = PointData::FromValues(f);
  FillMissingUnitVectors(mesh, data, turns != std::round(turns), InitialFill::Mean, 0,
    std::vector<std::int64_t>(mesh.NumberOfVertices(), 0));
  return data;
}

} // namespace

TEST(HarmonicMap, MultigridIsChosenWhereDiffusionDominates)
{
  const Surface sphere = Icosphere(4);
  const auto assembler = MakeAssembler(sphere);
  const TriangleMesh& mesh = assembler->Mesh();
  Values normals = sphere.Vertices + 0.1 * RandomUnitVectors(mesh, 3);
  normals.rowwise().normalize();
  for (const bool dominates : { false, true })
  {
    const double h = mesh.TotalEdgeLength() / (3.0 * mesh.NumberOfVertices());
    auto settings = MapSettings(mesh, 1.0, dominates ? 10.0 * h : 0.1 * h, 1e-6);
    int iterations[2];
    for (const bool automatic : { false, true })
    {
      settings.Method =
        automatic ? HarmonicMap::Preconditioner::Automatic : HarmonicMap::Preconditioner::Jacobi;
      const auto map = MakeMap(assembler, PointData::FromValues(normals), settings);
      Advance(*map, 2); // the noise is gone
      iterations[automatic] = map->Advance(ProgressMonitor()).Iterations;
    }
    if (dominates)
    {
      EXPECT_LT(4 * iterations[1], iterations[0]);
    }
    else
    {
      EXPECT_EQ(iterations[1], iterations[0]);
    }
  }
}

TEST(HarmonicMap, JacobiAloneTellsThatItDidNotConverge)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  auto settings = MapSettings(mesh, 2.0, 10.0);
  settings.Limits.MaximumNumberOfIterations = 3;
  settings.Method = HarmonicMap::Preconditioner::Jacobi;
  const auto map = MakeMap(assembler, PointData::FromValues(RandomUnitVectors(mesh, 3)), settings);
  EXPECT_THROW(map->Advance(ProgressMonitor()), NotConverged);
}

/// Multigrid with the aggregates of the surface and with its own, Jacobi, and the factor.
TEST(HarmonicMap, IterationsOfAllMethodsThatWereTriedAreReported)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  auto settings = MapSettings(mesh, 1.0, 10.0);
  settings.Limits = { 1e-15, 2 };
  settings.Method = HarmonicMap::Preconditioner::Multigrid;
  const auto map = MakeMap(assembler, PointData::FromValues(RandomUnitVectors(mesh, 3)), settings);
  EXPECT_GE(map->Advance(ProgressMonitor()).Iterations, 7);
}

// An unfinished solution is a step downhill too: the proof does not need the solver's tolerance.
TEST(HarmonicMap, EnergyFallsWithUnfinishedSolutions)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  auto settings = MapSettings(mesh, 1.0, 10.0);
  settings.Limits.MaximumNumberOfIterations = 2;
  const auto map = MakeMap(assembler, PointData::FromValues(RandomUnitVectors(mesh, 3)), settings);
  for (int k = 0; k < 5; ++k)
  {
    const double energy = map->Energy();
    const StepReport report = map->Advance(ProgressMonitor());
    EXPECT_LT(map->Energy(), energy);
    EXPECT_GT(report.Residual, settings.Limits.Tolerance); // and the report says so
  }
}

TEST(HarmonicMap, StrongFidelityReturnsTheDataAndFixedVerticesStay)
{
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  auto data = PointData::FromValues(RandomUnitVectors(mesh, 3));
  data.Start = RandomUnitVectors(mesh, 3, 9);
  for (Index i = 0; i < mesh.NumberOfVertices(); i += 5)
  {
    data.Fixed[i] = true;
  }
  for (const MapScheme scheme : AllSchemes)
  {
    auto settings = MapSettings(mesh, 1.5, 1e-2, 1e-2, scheme);
    settings.Fidelity = 1e8;
    const auto map = MakeMap(assembler, data, settings);
    Advance(*map, 30);
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      if (data.Fixed[i])
      {
        EXPECT_EQ((map->State().row(i) - data.Start.row(i)).norm(), 0.0);
      }
      else
      {
        EXPECT_LT((map->State().row(i) - data.Given.row(i)).norm(), 1e-5);
      }
    }
  }
}

TEST(HarmonicMap, HolesFillWithTheStraightPathBetweenTheirRims)
{
  // On a strip with held ends the map turns evenly along the great circle between them.
  const Surface s = Strip(24, 4, 2.0, 0.3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const auto psi = [](const Eigen::RowVector3d& x) { return 0.7 * x[0]; };
  Values f = SampleGreatCircle(mesh, s, psi);
  auto data = PointData::FromValues(f);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const double x = s.Vertices(mesh.InputVertex()[i], 0);
    data.Fixed[i] = x < 1e-9 || x > 2.0 - 1e-9;
    data.Missing[i] = !data.Fixed[i];
    if (data.Missing[i])
    {
      data.Given.row(i).setZero();
    }
  }
  FillMissingUnitVectors(
    mesh, data, false, InitialFill::Mean, 0, std::vector<std::int64_t>(mesh.NumberOfVertices(), 0));
  for (const MapScheme scheme : { MapScheme::TangentPlane, MapScheme::MinimizingMovement })
  {
    const auto map = MakeMap(assembler, data, MapSettings(mesh, 2.0, 100.0, 1e-8, scheme));
    Advance(*map, 20);
    EXPECT_LT((Angles(map->State()) - Sample(mesh, s, psi)).cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST(HarmonicMap, SingularitiesAreHandled)
{
  const Surface s = Disk(12);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  for (const double turns : { 1.0, -1.0, 2.0, 0.5, -0.5 })
  {
    const PointData data = Hedgehog(mesh, s, turns);
    for (const MapScheme scheme : AllSchemes)
    {
      for (const double exponent : { 1.0, 1.5, 2.0 })
      {
        auto settings = MapSettings(mesh, exponent, 0.01, 1e-8, scheme);
        settings.LineField = turns != std::round(turns);
        const auto map = MakeMap(assembler, data, settings);
        Advance(*map, 5);
        ASSERT_TRUE(map->State().allFinite());
        EXPECT_LT(LargestLengthError(map->State()), 1e-12);
        EXPECT_TRUE(std::isfinite(map->Energy()));
      }
    }
  }
}

TEST(HarmonicMap, LineFieldsDoNotSeeTheSign)
{
  const Surface s = Icosphere(3);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Values f = SampleUnit(mesh, s, 3,
    [](const Eigen::RowVector3d& x)
    { return Eigen::RowVector3d(std::cos(x[2]), std::sin(2.0 * x[0]), 0.3 * x[1]); });
  Values flipped = f;
  for (Index i = 0; i < f.rows(); ++i)
  {
    flipped.row(i) *= UniformRandom(1, 0, i) < 0.5 ? -1.0 : 1.0;
  }
  for (const MapScheme scheme : AllSchemes)
  {
    for (const double exponent : { 1.0, 2.0 })
    {
      auto settings = MapSettings(mesh, exponent, 1e-2, 1e-4, scheme);
      settings.Fidelity = 0.5;
      const auto map = MakeMap(assembler, PointData::FromValues(f), settings);
      settings.LineField = true;
      const auto lines = MakeMap(assembler, PointData::FromValues(flipped), settings);
      EXPECT_NEAR(lines->Energy(), map->Energy(), 1e-12 * map->Energy());
      Advance(*map, 5);
      Advance(*lines, 5);
      for (Index i = 0; i < f.rows(); ++i)
      {
        EXPECT_NEAR(std::abs(map->State().row(i).dot(lines->State().row(i))), 1.0, 1e-9);
      }
    }
  }
}

// Half a turn around the origin is no vector field: the vectors would jump along some line. As
// lines it is smooth, with the energy of a quarter of the full turn's.
TEST(HarmonicMap, HalfTurnsAreSmoothAsLines)
{
  const Surface s = Disk(24);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  auto settings = MapSettings(mesh, 2.0, 1e-2);
  const auto full = MakeMap(assembler, Hedgehog(mesh, s, 1.0), settings);
  settings.LineField = true;
  const auto half = MakeMap(assembler, Hedgehog(mesh, s, 0.5), settings);
  settings.LineField = false;
  const auto vectors = MakeMap(assembler, Hedgehog(mesh, s, 0.5), settings);
  EXPECT_NEAR(half->Energy() / full->Energy(), 0.25, 0.05);
  EXPECT_GT(vectors->Energy(), 2.0 * half->Energy());
}
