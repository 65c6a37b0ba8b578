// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Interpolation on surfaces of several connected components.
#include "Interpolation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// A smooth field with noise, known at `share` of the vertices, by input number.
ScatteredValues NoisyValues(const TriangleMesh& mesh, const Surface& s, double share)
{
  Values field = Sample(mesh, s, SeaTemperature);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    field(i, 0) += Gaussian(2, 0, mesh.InputVertex()[i]);
  }
  return ValuesAt(mesh, field, [&](Index i) { return UniformRandom(5, 0, i) < share; });
}

Values InInputOrder(const Surface& s, const std::shared_ptr<const Assembler>& assembler,
  const ScatteredValues& data, const Interpolation::Settings& settings, double size = 1.0)
{
  Interpolation::Settings scaled = settings;
  scaled.Kappa *= assembler->Mesh().LengthUnit() / size;
  scaled.Mu *= std::pow(size / assembler->Mesh().LengthUnit(), 2);
  return ToInput(assembler->Mesh(), Interpolate(assembler, data, scaled).U, s.NumberOfVertices());
}

Values Fitted(const Surface& s, const Interpolation::Settings& settings, double size = 1.0)
{
  const Surface drawn = Scaled(s, size);
  const auto assembler = MakeAssembler(drawn);
  return InInputOrder(s, assembler, NoisyValues(assembler->Mesh(), s, 0.5), settings, size);
}

} // namespace

TEST(InterpolationParts, HaveTheFitsThatTheyHaveAlone)
{
  const Surface large = Icosphere(2);
  const Surface small = Scaled(Disk(5), 0.003);
  const Surface both = Joined(large, Moved(small, { 2.0, 0.0, 0.0 }));
  const auto n = static_cast<Eigen::Index>(large.NumberOfVertices());
  for (const Choice choice : { Choice::Automatic, Choice::Exact, Choice::Given })
  {
    for (const double kappa : { 0.0, 3.0 })
    {
      Interpolation::Settings settings = InterpolationSettings(choice, 1e-4);
      settings.Kappa = kappa;
      const Values together = Fitted(both, settings);
      EXPECT_LT((together.topRows(n) - Fitted(large, settings)).cwiseAbs().maxCoeff(), 1e-9);
      for (const double size : { 1e-3, 1e3 })
      {
        EXPECT_LT((Fitted(both, settings, size) - together).cwiseAbs().maxCoeff(), 1e-7) << size;
      }
    }
  }
}

TEST(InterpolationParts, HaveTheLeastScoreEachWhateverTheirSizes)
{
  // An octahedron, and seven points of .003 of its size beside it.
  Surface s;
  s.Vertices.resize(13, 3);
  s.Vertices << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, //
    Eigen::Matrix<double, 7, 3>::Zero();
  s.Faces.resize(14, 3);
  for (int k = 0; k < 6; ++k)
  {
    s.Vertices.row(7 + k) << 0.003 * std::cos(k * Pi / 3.0), 0.003 * std::sin(k * Pi / 3.0), 0.0;
    s.Faces.row(8 + k) << 6, 7 + k, 7 + (k + 1) % 6;
  }
  s.Vertices.bottomRows(7).col(0).array() += 2.0;
  s.Faces.topRows(8) << 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5;
  const std::vector<double> given = { 8, 3, NAN, NAN, 7, 2, 3, 0, NAN, 8, 6, 5, 5 };
  const auto fit = [&](const Surface& drawn, Index begin)
  {
    const auto assembler = MakeAssembler(drawn);
    const TriangleMesh& mesh = assembler->Mesh();
    Values field(mesh.NumberOfVertices(), 1);
    for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
    {
      field(i, 0) = given[static_cast<std::size_t>(begin + mesh.InputVertex()[i])];
    }
    const auto data = ValuesAt(mesh, field, [&](Index i) { return !std::isnan(given[begin + i]); });
    return Interpolate(assembler, data, InterpolationSettings(Choice::Automatic));
  };
  Surface octahedron = s;
  octahedron.Vertices.conservativeResize(6, 3);
  octahedron.Faces.conservativeResize(8, 3);
  Surface disk;
  disk.Vertices = s.Vertices.bottomRows(7);
  disk.Faces = s.Faces.bottomRows(6).array() - 6;
  const double least =
    (4.0 * fit(octahedron, 0).Columns[0].Score + 6.0 * fit(disk, 6).Columns[0].Score) / 10.0;
  for (const double size : { 1.0, 10.0, 0.1 })
  {
    const double score = fit(Scaled(s, size), 0).Columns[0].Score;
    std::printf("size %g: score %.6f, of the parts alone %.6f\n", size, score, least);
    EXPECT_NEAR(score, least, 1e-6 * least);
  }
}

TEST(InterpolationParts, AreFreeAtBoundariesAndNaturalWithoutThem)
{
  const Surface both = Joined(Icosphere(2), Moved(Disk(6), { 3.0, 0.0, 0.0 }));
  Interpolation::Settings settings = InterpolationSettings(Choice::Automatic);
  const auto fitted = [&](RimCondition rim)
  {
    settings.Rim = rim;
    return Fitted(both, settings);
  };
  const Eigen::Index ofBall = Icosphere(2).NumberOfVertices();
  const Values found = fitted(RimCondition::Automatic);
  const Values natural = fitted(RimCondition::Natural);
  EXPECT_EQ(found.topRows(ofBall), natural.topRows(ofBall));
  const Eigen::Index ofDisk = found.rows() - ofBall;
  EXPECT_EQ(found.bottomRows(ofDisk), fitted(RimCondition::Free).bottomRows(ofDisk));
  EXPECT_GT((found - natural).bottomRows(ofDisk).cwiseAbs().maxCoeff(), 0.1);
}

TEST(InterpolationParts, MayBeThousands)
{
  constexpr int parts = 2000;
  const Surface ball = Icosphere(1);
  const auto n = ball.Vertices.rows();
  Surface s;
  s.Vertices.resize(parts * n, 3);
  s.Faces.resize(parts * ball.Faces.rows(), 3);
  for (int p = 0; p < parts; ++p)
  {
    s.Vertices.middleRows(p * n, n) = ball.Vertices;
    s.Vertices.middleRows(p * n, n).rowwise() +=
      3.0 * Eigen::RowVector3d(p % 13, p / 13 % 13, p / 169);
    s.Faces.middleRows(p * ball.Faces.rows(), ball.Faces.rows()) =
      ball.Faces.array() + static_cast<Index>(p * n);
  }
  const auto assembler = MakeAssembler(s);
  const TriangleMesh& mesh = assembler->Mesh();
  Values field(mesh.NumberOfVertices(), 1);
  for (Index i = 0; i < mesh.NumberOfVertices(); ++i)
  {
    const Index point = mesh.InputVertex()[i];
    field(i, 0) = (ball.Vertices(point % n, 2) > 0.3 ? 1.0 : 0.0) + 0.1 * Gaussian(1, 0, point);
  }
  const auto data = ValuesAt(mesh, field, [](Index i) { return UniformRandom(5, 0, i) < 0.5; });
  const Interpolation::Result result =
    Interpolate(assembler, data, InterpolationSettings(Choice::Automatic));
  EXPECT_EQ(result.Parts, parts);
  EXPECT_TRUE(result.U.allFinite());
  EXPECT_LT((result.U - field).norm() / std::sqrt(static_cast<double>(field.size())), 0.5);
}
