// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "HarmonicMaps.h"
#include "MeshFiles.h"

#include <gtest/gtest.h>

#include <cstdio>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

// The promise of TangentPlane and MinimizingMovement: the energy never grows.

namespace
{

/// A few steps from `f` at time steps over eight decades, 1e-4 to 1e4 of h^p.
void ExpectFallingEnergy(std::shared_ptr<const Assembler> assembler, const PointData& data,
  double exponent, MapScheme scheme, bool lineField = false, double fidelity = 0.0,
  double factor = 10.0)
{
  const TriangleMesh& mesh = assembler->Mesh();
  const double h = MeanEdge(mesh);
  for (double step = 1e-4; step < 2e4; step *= factor)
  {
    HarmonicMap::Settings settings;
    settings.Exponent = exponent;
    settings.Beta = 1e-6 / (h * h);
    settings.TimeStep = step * std::pow(h, exponent);
    settings.Fidelity = fidelity / std::pow(h, exponent);
    settings.TimeScheme = scheme;
    settings.LineField = lineField;
    const auto map = MakeMap(assembler, data, settings);
    double energy = map->Energy();
    const double start = energy;
    for (int k = 0; k < 2; ++k)
    {
      map->Advance(ProgressMonitor());
      const double next = map->Energy();
      EXPECT_LE(next, energy) << "p = " << exponent << ", step " << step << ", number " << k;
      energy = next;
    }
    EXPECT_LT(energy, start); // and it does fall
    EXPECT_LT(LargestLengthError(map->State()), 1e-12);
  }
}

/// A grid of needles: angles down to a hundredth of a degree and up to 179.9.
Surface Needles(int cells, double flatness, std::int64_t seed)
{
  Surface s = Jittered(Strip(cells, cells), 0.45 / cells, -1.0, 2.0, -1.0, 2.0, seed);
  s.Vertices.col(1) *= flatness;
  return s;
}

} // namespace

TEST(HarmonicMapEnergy, NeverGrowsAtAnyTimeStepForAnyExponentAndDimension)
{
  const auto assembler = MakeAssembler(Icosphere(2));
  for (const double exponent : { 1.0, 1.5, 2.0 })
  {
    for (const Eigen::Index m : { 2, 3, 5 })
    {
      const auto data = PointData::FromValues(RandomUnitVectors(assembler->Mesh(), m));
      ExpectFallingEnergy(assembler, data, exponent, MapScheme::TangentPlane);
    }
    const auto data = PointData::FromValues(RandomUnitVectors(assembler->Mesh(), 3));
    ExpectFallingEnergy(assembler, data, exponent, MapScheme::MinimizingMovement);
  }
}

TEST(HarmonicMapEnergy, NeverGrowsOnNeedles)
{
  for (const double flatness : { 1.0, 0.1, 1e-3 })
  {
    const auto assembler = MakeAssembler(Needles(8, flatness, 3));
    const auto data = PointData::FromValues(RandomUnitVectors(assembler->Mesh(), 3));
    for (const double exponent : { 1.0, 2.0 })
    {
      ExpectFallingEnergy(assembler, data, exponent, MapScheme::TangentPlane);
      ExpectFallingEnergy(assembler, data, exponent, MapScheme::MinimizingMovement);
    }
  }
}

// Found by search: the plain step raises the energy here, at obtuse triangles and huge time steps.
// Without damping the map would have to stay as it is.
TEST(HarmonicMapEnergy, FallsWhereTheStepWithoutDampingWouldRaiseIt)
{
  const auto assembler = MakeAssembler(Needles(4, 0.1, 82));
  const TriangleMesh& mesh = assembler->Mesh();
  const double h = MeanEdge(mesh);
  HarmonicMap::Settings settings;
  settings.Exponent = 2.0;
  settings.TimeStep = 1e4 * h * h;
  const auto map =
    MakeMap(assembler, PointData::FromValues(RandomUnitVectors(mesh, 2, 1082)), settings);
  for (int k = 0; k < 8; ++k)
  {
    const double energy = map->Energy();
    map->Advance(ProgressMonitor());
    EXPECT_LT(map->Energy(), energy) << "step " << k;
  }
}

TEST(HarmonicMapEnergy, NeverGrowsWithFidelityMissingAndFixedVertices)
{
  const auto assembler = MakeAssembler(Needles(10, 0.05, 5));
  const TriangleMesh& mesh = assembler->Mesh();
  auto data = PointData::FromValues(RandomUnitVectors(mesh, 3));
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    data.Missing[i] = i % 3 == 0;
    data.Fixed[i] = i % 7 == 0;
  }
  data.Start = RandomUnitVectors(mesh, 3, 8);
  for (const double exponent : { 1.0, 2.0 })
  {
    ExpectFallingEnergy(assembler, data, exponent, MapScheme::TangentPlane, false, 0.3);
    ExpectFallingEnergy(assembler, data, exponent, MapScheme::MinimizingMovement, false, 0.3);
  }
}

TEST(HarmonicMapEnergy, NeverGrowsForLineFields)
{
  for (const double flatness : { 1.0, 0.05 })
  {
    const auto assembler = MakeAssembler(Needles(10, flatness, 5));
    const auto data = PointData::FromValues(RandomUnitVectors(assembler->Mesh(), 3));
    for (const double exponent : { 1.0, 2.0 })
    {
      ExpectFallingEnergy(assembler, data, exponent, MapScheme::TangentPlane, true);
      ExpectFallingEnergy(assembler, data, exponent, MapScheme::MinimizingMovement, true, 0.3);
    }
  }
}

TEST(HarmonicMapEnergy, NeverGrowsWithAnisotropicDiffusion)
{
  const Surface s = Needles(10, 0.2, 5);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  TangentVectors frames(mesh.NumberOfTriangles(), 2);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    frames.row(t) << std::cos(0.7 * t), std::sin(0.7 * t);
  }
  const CornerWeights coefficients = AnisotropicWeights(mesh, CotanWeights(mesh), frames, 5.0, 0.1);
  for (double step = 1e-4; step < 2e4; step *= 10.0)
  {
    HarmonicMap::Settings settings;
    settings.TimeStep = step * MeanEdge(mesh);
    settings.LargestDiffusivity = 5.0;
    HarmonicMap map(assembler, coefficients, PointData::FromValues(RandomUnitVectors(mesh, 3)),
      settings, MakeCholeskySolver());
    double energy = map.Energy();
    for (int k = 0; k < 3; ++k)
    {
      map.Advance(ProgressMonitor());
      EXPECT_LT(map.Energy(), energy);
      energy = map.Energy();
    }
  }
}

namespace
{

class HarmonicMapEnergyOnRealMesh : public testing::TestWithParam<const char*>
{
};

} // namespace

TEST_P(HarmonicMapEnergyOnRealMesh, NeverGrows)
{
  if (!HaveMeshFiles())
  {
    GTEST_SKIP() << "SURFACEDIFFUSION_MESH_DIR is not set";
  }
  const auto assembler = MakeAssembler(ReadMeshFile(GetParam()));
  const auto data = PointData::FromValues(RandomUnitVectors(assembler->Mesh(), 3));
  for (const double exponent : { 1.0, 2.0 })
  {
    ExpectFallingEnergy(assembler, data, exponent, MapScheme::TangentPlane, false, 0.0, 1e4);
  }
}

// Of libcgal-demo's, those with the smallest angles, from 7e-6 to 0.07 degrees; the largest are
// from 177.7 to 180.
INSTANTIATE_TEST_SUITE_P(TenWorst, HarmonicMapEnergyOnRealMesh,
  testing::Values("mpi", "triceratops", "anchor_dense", "oblong", "anchor", "ALSTOM_TEST4", "man",
    "mannequin-devil", "ChineseDragon-10kv", "u"),
  [](const testing::TestParamInfo<const char*>& mesh)
  {
    std::string name = mesh.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
  });

TEST(HarmonicMapEnergy, OfThePapersSplittingCanGrow)
{
  // The reason for the other schemes: from noise, the explicit reaction at a large time step.
  const auto assembler = MakeAssembler(Icosphere(3));
  const TriangleMesh& mesh = assembler->Mesh();
  const double h = MeanEdge(mesh);
  bool grew = false;
  for (double step = 1e-2; step < 2e4; step *= 10.0)
  {
    HarmonicMap::Settings settings;
    settings.Exponent = 2.0;
    settings.TimeStep = step * h * h;
    settings.TimeScheme = MapScheme::ExplicitReaction;
    const auto map =
      MakeMap(assembler, PointData::FromValues(RandomUnitVectors(mesh, 3)), settings);
    double energy = map->Energy();
    for (int k = 0; k < 20; ++k)
    {
      map->Advance(ProgressMonitor());
      grew = grew || map->Energy() > 1.001 * energy;
      energy = map->Energy();
      EXPECT_LT(LargestLengthError(map->State()), 1e-12);
    }
  }
  EXPECT_TRUE(grew);
}
