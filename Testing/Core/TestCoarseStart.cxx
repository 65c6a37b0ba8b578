// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Textures/CoarseStart.h"
#include "Core/Models/Textures/DispersionRelation.h"
#include "Core/Models/Trajectory.h"
#include "Core/Operators/CotanWeights.h"
#include "Core/Operators/DirichletEnergy.h"
#include "Meshes.h"
#include "Run/TextureSettings.h"
#include "RunInput.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdio>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// A coarse space for waves of this many mean edge lengths.
std::optional<CoarseSpace> MakeSpace(
  const Assembler& fine, double edgesPerWavelength, const ParallelFor& parallel = SerialFor())
{
  const TriangleMesh& mesh = fine.Mesh();
  const double h = mesh.TotalEdgeLength() / mesh.NumberOfEdges();
  const double k = 2.0 * Pi / (edgesPerWavelength * h);
  const CornerWeights c = CotanWeights(mesh);
  return MakeCoarseSpace(fine, { c, c }, k * k, parallel);
}

/// A texture that starts coarse on a surface of any size, or does not.
TextureSettings Texture(bool coarse)
{
  TextureSettings settings;
  settings.CoarseStartSize = coarse ? 1 : 0;
  return settings;
}

RunInput WithoutData(const Testing::Surface& surface)
{
  RunInput input(surface);
  input.Data.Data.Values.resize(0, 0);
  return input;
}

/// The root mean square wave number of a column of the state.
double WaveNumber(const Trajectory& path, Eigen::Index column)
{
  const TriangleMesh& mesh = path.Mesh();
  const Vector& areas = mesh.ControlAreas();
  Vector u = path.State().col(column);
  u.array() -= areas.dot(u) / areas.sum();
  return std::sqrt(2.0 * DirichletEnergy(mesh, CotanWeights(mesh), u) / areas.dot(u.cwiseAbs2()));
}

} // namespace

TEST(CoarseSpace, KeepsConstantsBoundsAndIntegrals)
{
  for (const Testing::Surface& surface : { Icosphere(4), ThreeFins(40),
         Joined(Plate(40, 1.0), Moved(Scaled(Tetrahedron(), 0.4), { 9.0, 0.0, 0.0 })) })
  {
    const auto fine = MakeAssembler(surface);
    const auto space = MakeSpace(*fine, 16.0);
    ASSERT_TRUE(space);
    const Index n = fine->Mesh().NumberOfVertices();
    EXPECT_LT(2 * space->NumberOfVertices(), n);
    Values u(n, 2);
    space->Prolong(Values::Ones(space->NumberOfVertices(), 2), u, SerialFor());
    EXPECT_LT((u.array() - 1.0).abs().maxCoeff(), 1e-12);
    EXPECT_GE(space->Restriction.coeffs().minCoeff(), 0.0);

    const Values noise = Values::Random(n, 2);
    const Values coarse = space->Restrict(fine->Mesh(), noise);
    const Vector& areas = fine->Mesh().ControlAreas();
    const Vector& coarseAreas = space->Assembly->Mesh().ControlAreas();
    space->Prolong(coarse, u, SerialFor());
    for (int c = 0; c < 2; ++c)
    {
      EXPECT_NEAR(coarseAreas.dot(coarse.col(c)), areas.dot(noise.col(c)), 1e-12 * areas.sum());
      EXPECT_NEAR(areas.dot(u.col(c)), areas.dot(noise.col(c)), 1e-12 * areas.sum());
    }
    const Vector flat = space->Stiffness[0] * Vector::Ones(space->NumberOfVertices());
    EXPECT_LT(flat.cwiseAbs().maxCoeff(), 1e-10 * space->Stiffness[0].coeffs().maxCoeff());
  }
}

TEST(CoarseSpace, IsEmptyIfTheMeshHardlyResolvesTheWave)
{
  const auto fine = MakeAssembler(Icosphere(4));
  EXPECT_FALSE(MakeSpace(*fine, 6.0));
  const auto one = MakeSpace(*fine, 12.0);
  const auto two = MakeSpace(*fine, 80.0);
  ASSERT_TRUE(one && two);
  EXPECT_LT(4 * two->NumberOfVertices(), one->NumberOfVertices());
}

// Spherical harmonics of degree l have the squared wave number l (l + 1).
TEST(CoarseSpace, WavesKeepTheirWaveNumber)
{
  const Testing::Surface surface = Icosphere(5);
  const auto fine = MakeAssembler(surface);
  const TriangleMesh& mesh = fine->Mesh();
  const double unit = mesh.LengthUnit() * mesh.LengthUnit();
  const double h = mesh.TotalEdgeLength() / mesh.NumberOfEdges() * mesh.LengthUnit();
  for (const int degree : { 2, 10, 15 }) // on two levels, one and one
  {
    const double exact = degree * (degree + 1.0);
    const auto space = MakeSpace(*fine, 2.0 * Pi / std::sqrt(exact) / h);
    ASSERT_TRUE(space);
    // Re (x + i y)^l
    const Values y = Sample(mesh, surface,
      [&](const Eigen::RowVector3d& p)
      { return std::pow(std::complex<double>(p[0], p[1]), degree).real(); });
    const Vector wave = space->Restrict(mesh, y).col(0);
    const double squared = wave.dot(space->Stiffness[0] * wave) /
      wave.dot(space->Assembly->Mesh().ControlAreas().cwiseProduct(wave)) / unit;
    std::printf("degree %d on %d of %d vertices: wave number %.4f of the exact one\n", degree,
      space->NumberOfVertices(), mesh.NumberOfVertices(), std::sqrt(squared / exact));
    EXPECT_NEAR(std::sqrt(squared / exact), 1.0, 0.05);
  }
}

TEST(CoarseStart, PatternsHaveTheWavelengthOfARunOnTheSurface)
{
  const RunInput input = WithoutData(Icosphere(5));
  double waveNumber[2];
  for (const bool coarse : { false, true })
  {
    SurfaceDiffusion::Run run(SerialFor());
    TextureSettings settings = Texture(coarse);
    settings.FeatureSize = 0.7; // 6 coarse vertices
    StateOf(run, { input.Block() }, settings);
    waveNumber[coarse] = WaveNumber(*run.GetBlock(0).Path, 0);
    EXPECT_TRUE(run.GetBlock(0).Result.Warnings.empty());
    EXPECT_EQ(FindNumber(run.GetBlock(0).Outputs, "CoarseStartVertices") > 0, coarse);
    EXPECT_LT(run.GetBlock(0).Path->Step(), 640); // stationary
  }
  std::printf("wave number %.4f of that on the surface\n", waveNumber[1] / waveNumber[0]);
  EXPECT_NEAR(waveNumber[1] / waveNumber[0], 1.0, 0.05);
}

TEST(CoarseStart, HistoryHasTheIntegralsAndEnergiesOfTheStates)
{
  const RunInput input = WithoutData(Icosphere(4));
  TextureSettings settings = Texture(true);
  settings.GenerateTimeSteps = true;
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, settings);
  const Trajectory& path = *run.GetBlock(0).Path;
  const Vector& areas = path.Mesh().ControlAreas();
  const int last = path.Step();
  for (const int step : { last, last - 1, last - 2, last / 2, 1, 0 })
  {
    run.Seek(step, ProgressMonitor());
    for (Index c = 0; c < 2; ++c)
    {
      const double total = areas.dot(path.State().col(c));
      EXPECT_NEAR(path.TotalAt(step, c), total, 1e-12 * total) << step;
    }
    EXPECT_GT(path.Records()[static_cast<std::size_t>(step)].Energy, 0.0);
  }
}

TEST(CoarseStart, HasTheNoiseOnTheSurfaceAsItsInitialState)
{
  const RunInput input = WithoutData(Icosphere(4));
  TextureSettings settings = Texture(true);
  settings.GenerateTimeSteps = true;
  SurfaceDiffusion::Run run(SerialFor());
  StateOf(run, { input.Block() }, settings);
  run.Seek(0, ProgressMonitor());
  TextureSettings none = Texture(false);
  none.NumberOfTimeSteps = 0;
  SurfaceDiffusion::Run never(SerialFor());
  EXPECT_EQ(StateOf(never, { input.Block() }, none), run.GetBlock(0).Path->State());
}

TEST(CoarseStart, OnlyPatternsFromNoiseUntilStationaryStartCoarse)
{
  const Testing::Surface surface = Icosphere(5);
  const auto starts = [&](const TextureSettings& settings, const RunInput& input)
  {
    SurfaceDiffusion::Run run(SerialFor());
    run.Update(
      { input.Block() }, std::make_shared<TextureSettings>(settings), Alone, ProgressMonitor());
    EXPECT_TRUE(run.GetBlock(0).Result.Warnings.empty());
    return FindNumber(run.GetBlock(0).Result.Numbers, "CoarseStartVertices") > 0;
  };
  TextureSettings settings = Texture(true);
  EXPECT_TRUE(starts(settings, WithoutData(surface)));
  settings.CoarseStartSize = surface.NumberOfVertices();
  EXPECT_FALSE(starts(settings, WithoutData(surface)));
  settings = Texture(true);
  settings.StopTolerance = 0.0;
  EXPECT_FALSE(starts(settings, WithoutData(surface)));
  settings = Texture(true);
  RunInput given(surface);
  given.Data.Data.Values = Values::Constant(given.Vertices.rows(), 2, 4.0);
  EXPECT_FALSE(starts(settings, given));
}
