// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Models/Interpolation/SparseSquare.h"

#include "Interpolation.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

using namespace SurfaceDiffusion;
using namespace SurfaceDiffusion::Testing;

namespace
{

/// `count` triangles around a point, or around an edge.
Surface Around(Index count, bool isEdge)
{
  Surface s;
  s.Vertices = Points::Zero(count + 2, 3);
  s.Vertices(count + 1, 2) = 1.0;
  s.Faces.resize(count, 3);
  for (Index i = 0; i < count; ++i)
  {
    const double angle = 2.0 * Pi * i / count;
    s.Vertices.row(i) << std::cos(angle), std::sin(angle), isEdge ? 0.5 : 0.0;
    s.Faces.row(i) << i, count, isEdge ? count + 1 : (i + 1) % count;
  }
  s.Vertices.conservativeResize(isEdge ? count + 2 : count + 1, Eigen::NoChange);
  return s;
}

Values FieldOn(const TriangleMesh& mesh, const Surface& s)
{
  return Sample(
    mesh, s, [](const Eigen::RowVector3d& x) { return std::sin(3.0 * x[0]) + x[1] * x[1] + x[2]; });
}

} // namespace

TEST(SparseSquare, HasTheFitsOfTheFullSquareAroundPointsAndEdges)
{
  constexpr double mu = 1e-3;
  for (const bool isEdge : { false, true })
  {
    const Surface s = Around(300, isEdge);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Index n = mesh.NumberOfVertices();
    const auto data = ValuesAt(mesh, FieldOn(mesh, s), [](Index i) { return i % 7 == 3; });
    for (const double kappa : { 0.0, 2.0 })
    {
      SparseMatrix l;
      assembler->TakePattern(l, SerialFor());
      assembler->Fill(l, kappa * kappa * mesh.ControlAreas(), 1.0, CotanWeights(mesh));
      const SparseMatrix square = SparseSquare(l, mesh.ControlAreas(), kappa * kappa);
      EXPECT_GT(square.rows(), n);
      EXPECT_LT(square.nonZeros(), 60 * n);

      Eigen::MatrixXd h = mu * Eigen::MatrixXd(l) *
        mesh.ControlAreas().cwiseInverse().asDiagonal() * Eigen::MatrixXd(l);
      Vector forces = Vector::Zero(n);
      const double mean = kappa > 0.0 ? data.Given.mean() : 0.0;
      for (Index i = 0; i < data.Count(); ++i)
      {
        const Index vertex = data.Places[i].Vertex();
        h(vertex, vertex) += 1.0;
        forces[vertex] = data.Given(i, 0) - mean;
      }
      const Eigen::MatrixXd inverse = h.inverse();
      const Vector u = (inverse * forces).array() + mean;
      Interpolation::Settings settings = InterpolationSettings(Choice::Given, mu);
      settings.Kappa = kappa;
      settings.ComputeError = kappa == 0.0; // the error of the mean is another matter
      settings.NoiseLevel = 1.0;
      const Interpolation::Result result = Interpolate(assembler, data, settings);
      double freedom = 0.0;
      for (const SurfacePoint& place : data.Places)
      {
        freedom += inverse(place.Vertex(), place.Vertex());
      }
      EXPECT_LT((result.U.col(0) - u).cwiseAbs().maxCoeff(), 1e-8);
      EXPECT_NEAR(result.Columns[0].DegreesOfFreedom, freedom, 1e-6);
      if (settings.ComputeError)
      {
        const Vector errors = inverse.diagonal().cwiseSqrt();
        EXPECT_LT((result.Error.col(0) - errors).cwiseAbs().maxCoeff(), 1e-6 * errors.maxCoeff());
      }
    }
  }
}

TEST(SparseSquare, LetsPointsAndEdgesHaveTwentyThousandTriangles)
{
  for (const bool isEdge : { false, true })
  {
    const Surface s = Around(20000, isEdge);
    const auto assembler = MakeAssembler(s);
    const TriangleMesh& mesh = assembler->Mesh();
    const Values field = FieldOn(mesh, s);
    const auto data = ValuesAt(mesh, field, [](Index i) { return i % 97 == 0; });
    Interpolation::Settings settings = InterpolationSettings(Choice::Exact);
    for (const RimCondition rim : { RimCondition::Natural, RimCondition::Automatic })
    {
      settings.Rim = rim;
      const Interpolation::Result result = Interpolate(assembler, data, settings);
      EXPECT_LT(result.Columns[0].Residual, 1e-9);
      EXPECT_LT(result.U.cwiseAbs().maxCoeff(), 3.0);
    }
    settings.Rim = RimCondition::Free;
    if (isEdge)
    {
      EXPECT_THROW(Interpolate(assembler, data, settings), std::runtime_error);
    }
  }
}
