// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "TotalVariation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// Steady states of total generalised variation on one surface, with lengths and weights in units
/// of the coordinates.
struct Problem
{
  explicit Problem(Surface surface)
    : Shape(std::move(surface))
    , Operators(MakeAssembler(Shape))
  {
  }

  TotalVariationFlow::Settings Settings(double fidelity, double length, double tolerance) const
  {
    TotalVariationFlow::Settings settings = ExactSettings(this->Mesh(), 0.0, fidelity, tolerance);
    settings.GeneralizedLength = length / this->Mesh().LengthUnit();
    return settings;
  }
  Values Solve(const PointData& data, const TotalVariationFlow::Settings& settings) const
  {
    const auto flow = MakeExact(this->Operators, data, settings);
    this->Report = flow->Advance(ProgressMonitor());
    this->Energy = flow->Energy();
    return flow->State();
  }
  template <typename F>
  Values Of(const F& f) const
  {
    return Sample(this->Mesh(), this->Shape, f);
  }
  const TriangleMesh& Mesh() const { return this->Operators->Mesh(); }
  double h() const { return MeanEdge(this->Mesh()); }

  Surface Shape;
  std::shared_ptr<const Assembler> Operators;
  mutable StepReport Report;
  mutable double Energy = 0.0;
};

Surface JitteredPlate(Index cells)
{
  return Jittered(Plate(cells, 1.0), 0.25 / cells, -0.99, 0.99, -0.99, 0.99);
}

double Affine(const Eigen::RowVector3d& x)
{
  return 0.3 + 2.0 * x[0] - 1.5 * x[1];
}

/// The plate bent along its columns into a spiral of flat strips, with `affine` of the flat one.
Surface BentPlate(Index cells)
{
  Surface s = Plate(cells, 1.0);
  const double width = 2.0 / static_cast<double>(cells);
  std::vector<Eigen::RowVector2d> profile(1, Eigen::RowVector2d::Zero());
  for (Index i = 0; i < cells; ++i)
  {
    const double angle = 2.5 * i * width * width;
    profile.push_back(
      profile.back() + width * Eigen::RowVector2d(std::cos(angle), std::sin(angle)));
  }
  for (Index i = 0; i < s.NumberOfVertices(); ++i)
  {
    const Eigen::RowVector2d p =
      profile[static_cast<std::size_t>(std::lround((s.Vertices(i, 0) + 1.0) / width))];
    s.Vertices.row(i) << p[0], s.Vertices(i, 1), p[1];
  }
  return s;
}

double LargestDifference(const Values& a, const Values& b)
{
  return (a - b).cwiseAbs().maxCoeff();
}

} // namespace

TEST(GeneralizedVariation, OfAffineFunctionsOnFlatSurfacesIsZero)
{
  const Problem plate(JitteredPlate(12));
  const Values f = plate.Of(Affine);
  const auto settings = plate.Settings(0.5, 2.0 * plate.h(), 1e-8);
  EXPECT_LT(LargestDifference(plate.Solve(PointData::FromValues(f), settings), f), 1e-6);
  EXPECT_LT(plate.Energy, 1e-6);
  auto tv = settings;
  tv.GeneralizedLength = 0.0;
  EXPECT_GT(LargestDifference(plate.Solve(PointData::FromValues(f), tv), f), 0.5);
}

TEST(GeneralizedVariation, TurnsVectorsWithSurfacesThatCanBeLaidFlat)
{
  const Problem flat(Plate(12, 1.0));
  const Problem bent(BentPlate(12));
  const Values f = ToInput(flat.Mesh(), flat.Of(Affine), flat.Shape.NumberOfVertices());
  const Values onBent = GatherVertices(bent.Mesh(), f);
  const auto settings = bent.Settings(0.5, 2.0 * bent.h(), 1e-8);
  EXPECT_LT(LargestDifference(bent.Solve(PointData::FromValues(onBent), settings), onBent), 1e-6);

  // Triangles of the other orientation turn them likewise.
  Surface mixed = bent.Shape;
  for (Index t = 0; t < mixed.NumberOfTriangles(); t += 3)
  {
    std::swap(mixed.Faces(t, 0), mixed.Faces(t, 1));
  }
  const Problem turned(mixed);
  const Values onTurned = GatherVertices(turned.Mesh(), f);
  EXPECT_LT(
    LargestDifference(turned.Solve(PointData::FromValues(onTurned), settings), onTurned), 1e-6);
}

TEST(GeneralizedVariation, ContinuesRampsIntoHoles)
{
  const Problem plate(JitteredPlate(12));
  const Values f = plate.Of(Affine);
  PointData data = PointData::FromValues(f);
  for (Index i = 0; i < plate.Mesh().NumberOfVertices(); ++i)
  {
    const auto x = plate.Shape.Vertices.row(plate.Mesh().InputVertex()[i]);
    if (x.head<2>().norm() < 0.4)
    {
      data.Missing[i] = true;
      data.Start(i, 0) = 0.0;
    }
  }
  ASSERT_GT(data.Missing.count(), 10);
  const Values u = plate.Solve(data, plate.Settings(3.0, 2.0 * plate.h(), 1e-13));
  EXPECT_LT(LargestDifference(u, f), 1e-9);
}

TEST(GeneralizedVariation, OfALongLengthIsTotalVariationButForAnAffineFunction)
{
  // On the sphere no field is parallel, so that w = 0.
  const Problem sphere(Icosphere(3));
  const PointData noisy =
    PointData::FromValues(Cap(sphere.Mesh(), sphere.Shape, 1.0) + 0.2 * Noise(sphere.Mesh()));
  auto settings = sphere.Settings(10.0, 1e3, 1e-6);
  const Values generalized = sphere.Solve(noisy, settings);
  settings.GeneralizedLength = 0.0;
  EXPECT_LT(LargestDifference(generalized, sphere.Solve(noisy, settings)), 2e-2);

  // On the plate an affine function of the data is one of the result.
  const Problem plate(JitteredPlate(10));
  const Values f =
    plate.Of([](const auto& x) { return x[0] > 0.1 ? 1.0 : 0.0; }) + 0.2 * Noise(plate.Mesh());
  settings = plate.Settings(10.0, 2.0 * plate.h(), 1e-7);
  const Values ofSum = plate.Solve(PointData::FromValues(f + plate.Of(Affine)), settings);
  EXPECT_LT(
    LargestDifference(ofSum, plate.Solve(PointData::FromValues(f), settings) + plate.Of(Affine)),
    5e-3);
}

TEST(GeneralizedVariation, IsWithinItsGapOfTheMinimum)
{
  const Problem sphere(Icosphere(3));
  const Values clean = sphere.Of([](const auto& x) { return std::abs(x[2]); });
  const PointData data = PointData::FromValues(clean + 0.1 * Noise(sphere.Mesh()));
  const Values exact = sphere.Solve(data, sphere.Settings(8.0, 2.0 * sphere.h(), 1e-8));
  EXPECT_LE(sphere.Report.Residual, 1e-8);
  const double least = sphere.Energy;
  const double exactBound = sphere.Report.ErrorBound;
  for (const double tolerance : { 1e-1, 1e-2, 1e-3, 1e-4 })
  {
    const Values u = sphere.Solve(data, sphere.Settings(8.0, 2.0 * sphere.h(), tolerance));
    EXPECT_LE(sphere.Report.Residual, tolerance);
    EXPECT_GE(sphere.Energy, least * (1.0 - 1e-8));
    EXPECT_LE(sphere.Energy - least, 1.0001 * sphere.Report.Residual * sphere.Energy);
    EXPECT_LE(RootMeanSquare(sphere.Mesh(), u - exact), sphere.Report.ErrorBound + exactBound);
  }
}

TEST(GeneralizedVariation, MixesChannelsAsARotationOfThemDoes)
{
  const Problem sphere(Icosphere(2));
  const Values f = sphere.Of([](const auto& x) { return std::abs(x[2]); }).replicate(1, 3) +
    0.2 * Noise(sphere.Mesh(), 3);
  Eigen::Matrix3d turn;
  turn << 0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, 1.0;
  auto settings = sphere.Settings(8.0, 2.0 * sphere.h(), 1e-7);
  const Values turned = sphere.Solve(PointData::FromValues(f * turn), settings);
  const Values u = sphere.Solve(PointData::FromValues(f), settings);
  EXPECT_LT(LargestDifference(turned, u * turn), 1e-3);

  settings.Coupling = ChannelCoupling::PerChannel;
  const Values apart = sphere.Solve(PointData::FromValues(f), settings);
  EXPECT_EQ(apart.col(1), sphere.Solve(PointData::FromValues(f.col(1)), settings).col(0));
  EXPECT_GT(LargestDifference(apart, u), 1e-2);
}

TEST(GeneralizedVariation, WithL1TakesOutliersOutOfRamps)
{
  const Problem plate(JitteredPlate(12));
  const Values clean = plate.Of(Affine);
  Values f = clean;
  for (Index i = 0; i < plate.Mesh().NumberOfVertices(); i += 17)
  {
    f(i, 0) += i % 2 == 0 ? 3.0 : -3.0;
  }
  auto settings = plate.Settings(0.7 / plate.h(), 2.0 * plate.h(), 1e-6);
  settings.Norm = FidelityNorm::L1;
  EXPECT_LT(LargestDifference(plate.Solve(PointData::FromValues(f), settings), clean), 1e-3);
}

TEST(GeneralizedVariation, OfRampsAndRoofsHasAFractionOfTheError)
{
  const Problem sphere(Rotated(Icosphere(4)));
  const auto angle = [](const Eigen::RowVector3d& x)
  { return std::acos(std::clamp(x[2] / x.norm(), -1.0, 1.0)); };
  const Values noise = 0.17 * Noise(sphere.Mesh());
  const auto errorOf = [&](const Values& clean, double length)
  {
    const double range = clean.maxCoeff() - clean.minCoeff();
    double best = range;
    for (const double weight : { 1.0, 2.0, 4.0, 8.0, 16.0 })
    {
      const auto settings = sphere.Settings(weight / (range * sphere.h()), length, 1e-3);
      const Values u = sphere.Solve(PointData::FromValues(clean + range * noise), settings);
      best = std::min(best, RootMeanSquare(sphere.Mesh(), u - clean));
    }
    return best;
  };
  const auto ratioOf = [&](const auto& f)
  {
    const Values clean = sphere.Of(f);
    return errorOf(clean, 0.0) / errorOf(clean, 2.0 * sphere.h());
  };
  EXPECT_GT(ratioOf([&](const auto& x) { return std::abs(angle(x) - 0.5 * Pi); }), 2.1);
  EXPECT_GT(ratioOf([&](const auto& x) { return angle(x) / Pi + (x[0] > 0.0 ? 1.0 : 0.0); }), 1.1);
  EXPECT_GT(ratioOf([](const auto& x) { return x[2] > 0.5 ? 1.0 : 0.0; }), 0.85);
}
