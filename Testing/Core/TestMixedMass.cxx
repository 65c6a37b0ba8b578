// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Foundation/SymmetricModes.h"
#include "Core/Geometry/HeatRegression.h"
#include "Core/Operators/MixedMass.h"
#include "Heat.h"
#include "NoiseWidth.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <utility>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

double TimeOfWidth(double width)
{
  return width * width / (16.0 * std::log(2.0));
}

/// The state after `time` in the unit of the mesh, in one step.
Values DiffuseMixed(const std::shared_ptr<const Assembler>& assembler, const Values& start,
  double time, Scheme scheme, bool mixed = true)
{
  LinearDiffusion::Settings settings;
  settings.TimeStep = time;
  settings.TimeScheme = scheme;
  settings.HasMixedMass = mixed;
  const auto heat = MakeHeat(assembler, PointData::FromValues(start), settings);
  Advance(*heat, 1);
  return heat->State();
}

/// Half of the consistent mass matrix, a sixth and a twelfth of triangles, and half of the lumped one.
Eigen::MatrixXd DenseMixedMass(const TriangleMesh& mesh)
{
  const Index n = mesh.NumberOfVertices();
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
  for (Index t = 0; t < mesh.NumberOfTriangles(); ++t)
  {
    for (int a = 0; a < 3; ++a)
    {
      for (int b = 0; b < 3; ++b)
      {
        mass(mesh.TriangleVertices()(t, a), mesh.TriangleVertices()(t, b)) +=
          0.5 * mesh.Shapes()[t].Area() / (a == b ? 6.0 : 12.0);
      }
    }
  }
  mass.diagonal() += 0.5 * mesh.ControlAreas();
  return mass;
}

/// Even triangles with edges 1/cells in a rhomb with sides of 4 about the origin.
Surface EvenLattice(Index cells)
{
  std::vector<Eigen::RowVector3d> vertices;
  std::vector<std::array<Index, 3>> faces;
  const Index side = 4 * cells;
  for (Index j = 0; j <= side; ++j)
  {
    for (Index i = 0; i <= side; ++i)
    {
      const double x = static_cast<double>(i) / cells - 2.0;
      const double y = static_cast<double>(j) / cells - 2.0;
      vertices.emplace_back(x - 0.5 * y, std::sqrt(0.75) * y, 0.0);
      if (i < side && j < side)
      {
        const Index a = j * (side + 1) + i;
        const Index d = a + side + 2;
        faces.insert(faces.end(), { { a, a + 1, d }, { a, d, d - 1 } });
      }
    }
  }
  return MakeSurface(vertices, faces);
}

Eigen::MatrixXd Mixed(const Assembler& assembler)
{
  Eigen::MatrixXd mass =
    Eigen::MatrixXd(MixedMinusLumped(assembler, MixedMassWeights(assembler.Mesh())));
  mass.diagonal() += assembler.Mesh().ControlAreas();
  return mass;
}

} // namespace

TEST(MixedMass, IsTheMeanOfTheLumpedAndTheConsistentMassMatrix)
{
  for (const Surface& s :
    { Jittered(Strip(9, 9), 0.03, 0, 1, 0, 1), ThreeFins(3), Joined(Disk(3), Icosphere(1)) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Eigen::MatrixXd mass = Mixed(*assembler);
    EXPECT_LT(
      (mass - DenseMixedMass(mesh)).cwiseAbs().maxCoeff(), 1e-14 * mesh.ControlAreas().maxCoeff());
    EXPECT_LT((mass.rowwise().sum() - mesh.ControlAreas()).cwiseAbs().maxCoeff(),
      1e-14 * mesh.ControlAreas().maxCoeff());
  }
}

// For any given areas.
TEST(MixedMass, IsBetweenFiveEighthsOfTheLumpedOneAndItself)
{
  const Surface s = JitteredSphere(2, 0.45);
  auto mesh = std::make_shared<TriangleMesh>(s.Vertices, s.Faces);
  std::vector<double> factors(static_cast<std::size_t>(s.Vertices.rows()));
  for (std::size_t i = 0; i < factors.size(); ++i)
  {
    factors[i] = std::pow(10.0, 4.0 * UniformRandom(1, 0, static_cast<std::int64_t>(i)) - 2.0);
  }
  for (const bool isScaled : { false, true })
  {
    if (isScaled)
    {
      mesh->ScaleControlAreas(factors);
    }
    const Assembler assembler(mesh);
    const Vector roots = mesh->ControlAreas().cwiseSqrt().cwiseInverse();
    const Vector modes =
      SymmetricEigenvalues(roots.asDiagonal() * Mixed(assembler) * roots.asDiagonal());
    EXPECT_GT(modes[0], 0.625 - 1e-12);
    EXPECT_LT(modes.maxCoeff() - 1.0, 1e-12);
  }
}

// The mode of LinearDiffusion.OneStepMultipliesAnEigenvectorByTheSchemesFactor, of the eigenvalue 9
// of M^-1 K: here it is one of M^-1 B, too, of 5/8.
TEST(MixedMass, OneStepMultipliesAnEigenvectorByTheSchemesFactor)
{
  const Surface s = Strip(1, 1);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  const Values start =
    Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[0] == p[1] ? 1.0 : -2.0; });
  const double dt = 0.17;
  const double z = 9.0 / 0.625 * dt;
  const double g = 1.0 - std::sqrt(0.5);
  const std::pair<Scheme, double> factors[] = { { Scheme::BackwardEuler, 1.0 / (1.0 + z) },
    { Scheme::SDIRK2, (1.0 - (1.0 - 2.0 * g) * z) / ((1.0 + g * z) * (1.0 + g * z)) },
    { Scheme::Exponential, SeriesAt(z) } };
  const double square = mesh.LengthUnit() * mesh.LengthUnit();
  for (const auto& [scheme, factor] : factors)
  {
    const Values u = DiffuseMixed(assembler, start, dt / square, scheme);
    EXPECT_LT((u - factor * start).cwiseAbs().maxCoeff(), 1e-14);
  }
}

// On an even lattice of edges h a wave of the wave number k has the eigenvalue k^2 (1 - k^2 h^2/16) of
// M^-1 K but for terms of fourth order, and that of B^-1 K has only these: here across the rows.
TEST(MixedMass, EigenvaluesOfWavesOnAnEvenLatticeAreRightToFourthOrder)
{
  const double z = 0.2;
  double coarser = 0.0;
  for (const Index cells : { 6, 12 })
  {
    const Surface s = EvenLattice(cells);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const double wave = 2.0 * Pi / std::sqrt(0.75);
    const Values start =
      Sample(mesh, s, [&](const Eigen::RowVector3d& p) { return std::cos(wave * p[1]); });
    const double time = z / std::pow(wave * mesh.LengthUnit(), 2);
    const double difference = 1.0 - std::cos(2.0 * Pi / cells); // of neighbouring rows
    const double lumped = 8.0 / 3.0 * cells * cells * difference / (wave * wave);
    const double mixed = lumped / (1.0 - difference / 6.0);
    for (const double eigenvalue : { lumped, mixed })
    {
      const Values u =
        DiffuseMixed(assembler, start, time, Scheme::Exponential, eigenvalue == mixed);
      for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
      {
        if (s.Vertices.row(mesh.InputVertex()[i]).norm() < 1e-9) // far from the boundary
        {
          EXPECT_NEAR(u(i, 0), SeriesAt(z * eigenvalue), 1e-9);
        }
      }
    }
    EXPECT_NEAR(lumped, 1.0 - std::pow(wave / cells, 2) / 16.0, 0.05 * (1.0 - lumped));
    if (coarser > 0.0)
    {
      EXPECT_NEAR(ObservedOrder(coarser, 1.0 - mixed), 4.0, 0.1);
    }
    coarser = 1.0 - mixed;
  }
}

TEST(MixedMass, WhiteNoiseGetsTheWidthThatIsAskedFor)
{
  for (const Surface& s : { Icosphere(4), JitteredSphere(4, 0.35) })
  {
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values noise = WhiteNoise(mesh, 48);
    for (const double edges : { 1.5, 2.0, 3.0, 4.0, 6.0 })
    {
      const double width = edges * mesh.MeanEdgeLength();
      const auto realised = [&](bool mixed)
      {
        return WidthOfNoise(mesh,
                 DiffuseMixed(assembler, noise, TimeOfWidth(width), Scheme::Exponential, mixed)) /
          width;
      };
      const double found = realised(true);
      std::printf("%.1f edges: %.3f (lumped %.3f)\n", edges, found, realised(false));
      EXPECT_NEAR(found, 1.0, edges < 2.0 ? 0.1 : 0.05) << edges;
    }
  }
}

TEST(MixedMass, KeepsTotalsOfComponentsAndConstantsAndTheVarianceOfTheKernel)
{
  const Surface s = Joined(Torus(40, 20), Moved(Icosphere(3), { 9.0, 0.0, 0.0 }));
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Values start(mesh.NumberOfVertices(), 2);
  start << Vector::Constant(mesh.NumberOfVertices(), 0.1), Noise(mesh).array() + 100.0;
  for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::Exponential })
  {
    const Values u =
      DiffuseMixed(assembler, start, TimeOfWidth(3.0 * mesh.MeanEdgeLength()), scheme);
    EXPECT_EQ(u.col(0), start.col(0));
    EXPECT_LT(std::abs(Total(mesh, u, 1) - Total(mesh, start, 1)), 1e-13 * Total(mesh, start, 1));
  }
  const Surface plate = EvenLattice(15);
  const auto even = MakeAssembler(plate);
  const TriangleMesh& flat = even->Mesh();
  const Values spike =
    Sample(flat, plate, [](const Eigen::RowVector3d& p) { return p.norm() < 1e-9 ? 1.0 : 0.0; });
  const double time = TimeOfWidth(6.0 * flat.MeanEdgeLength());
  const Values kernel = DiffuseMixed(even, spike, time, Scheme::Exponential);
  for (const int axis : { 0, 1 })
  {
    double moment = 0.0;
    for (Index i = 0; i < flat.NumberOfVertices(); ++i)
    {
      const double x = plate.Vertices(flat.InputVertex()[i], axis) / flat.LengthUnit();
      moment += flat.ControlAreas()[i] * kernel(i, 0) * x * x;
    }
    EXPECT_NEAR(moment / Total(flat, kernel, 0) / (2.0 * time), 1.0, 1e-4);
  }
  EXPECT_GT(kernel.minCoeff(), -1e-3 * kernel.maxCoeff());
}

TEST(MixedMass, ColumnsTogetherHaveTheBitsThatTheyHaveAloneWithAnyScheme)
{
  const auto assembler = MakeAssembler(JitteredSphere(3, 0.35));
  const TriangleMesh& mesh = assembler->Mesh();
  const Values start = Noise(mesh, 19);
  for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::Exponential })
  {
    const Values together = DiffuseMixed(assembler, start, 0.01, scheme);
    for (const Eigen::Index k : { 0, 16, 18 })
    {
      EXPECT_EQ(together.col(k), DiffuseMixed(assembler, start.col(k), 0.01, scheme).col(0));
    }
  }
}

TEST(MixedMass, HeldVerticesKeepTheirValuesAndTheLimitIsTheHarmonicFunction)
{
  const Surface s = Strip(12, 4, 3.0, 1.0);
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  PointData data = PointData::FromValues(
    Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[0] == 3.0 ? 1.0 : 0.0; }));
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const double x = s.Vertices(mesh.InputVertex()[i], 0);
    data.Fixed[i] = x == 0.0 || x == 3.0;
  }
  for (const Scheme scheme : { Scheme::BackwardEuler, Scheme::SDIRK2, Scheme::Exponential })
  {
    auto settings = HeatSettings(mesh, 1e4, 0.0, scheme);
    settings.HasMixedMass = true;
    const auto heat = MakeHeat(assembler, data, settings);
    Advance(*heat, 2);
    const Values line = Sample(mesh, s, [](const Eigen::RowVector3d& p) { return p[0] / 3.0; });
    EXPECT_LT((heat->State() - line).cwiseAbs().maxCoeff(), 1e-3);
  }
}

/// What fits of derivatives and curvatures weight with.
TEST(MixedMass, SmoothsDerivativesAsTheHeatFilterOfTheirWidth)
{
  for (const Testing::Surface& s : { Icosphere(3), Disk(8), ThreeFins(6) })
  {
    const auto assembler = MakeAssembler(s);
    const double width = 3.0 * assembler->Mesh().MeanEdgeLength();
    const Values f = Noise(assembler->Mesh(), 2);
    Values found = f;
    const auto solver = MakeCholeskySolver();
    EXPECT_EQ(SmoothByHeat(*assembler, width, found, *solver), 0.0);
    const Values expected = DiffuseMixed(assembler, f, TimeOfWidth(width), Scheme::Exponential);
    EXPECT_LT((found - expected).norm(), 1e-12 * f.norm());
  }
}
